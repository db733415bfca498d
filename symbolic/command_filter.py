"""A command filter: a command that jumps in, a smooth one and its first two derivatives out."""

from __future__ import annotations

import math

from ..reference import sliding_mode as reference
from .block import Block
from .components import (
    Ends,
    ends_of,
    finish,
    is_number,
    middle_of,
    rounded_up,
    seconds,
    spread_range,
    uniform,
    wandering,
)
from .errors import ModelError

LEAST_DAMPING, MOST_DAMPING = 0.5, 2.0
"""Range of the parameter `damping`; wider where the default is outside."""

SLOWEST = 0.1
"""Least value of the parameter `frequency` over its default: at 0 a filter that moves would drift out of its range."""

OVERSHOOT = 10.0
"""How much farther than the command what the filter stores may be from the centre of its range."""


def command_filter(
    frequency: float,
    damping: float = 1.0,
    *,
    dt: float,
    name: str = "command_filter",
    unit: str = "",
    range: Ends | None = None,
    initial: float = 0.0,
    doc: str = "",
) -> Block:
    """Return a second-order filter that gives a command, its rate and its acceleration.

    q'' = omega^2 (r - q) - 2 zeta omega q'. The outputs are q, q', q'' before the update, which is explicit Euler: q += dt q',
    then q' += dt q'', both from the values before.

    Parameters
    ----------
    frequency : float
        omega, in rad/s: a run-time parameter, from a tenth of this on.
    damping : float
        zeta: a run-time parameter. At 1 or more the filter does not overshoot (but for what Euler adds).
    dt : float
        Seconds per step.
    name, doc : str
        Name and meaning of the block.
    unit : str
        Of the command.
    range : (low, high), optional
        Of the input `raw`. Default -1e6 .. 1e6.
    initial : float
        The command before the first step, at rest: run-time parameter `value_0`.

    Returns
    -------
    Block
        Input `raw`; outputs `value`, `rate`, `acceleration`; memory q and q' (`filtered`, `filtered_rate`).

    Raises
    ------
    ModelError
        If frequency and damping are not positive, or so large that the steps of Euler diverge. The ranges of both
        parameters are such that none of their combinations does.

    Notes
    -----
    Command filtering: Farrell, Polycarpou, Sharma and Dong, IEEE TAC 54(6), 2009. Used by the quadrotor of Ghanai et al.,
    AEEE 16(4), 2018, where the derivatives of the commanded angles are needed.

    Examples
    --------
    >>> from plantc.symbolic.command_filter import command_filter
    >>> smooth = command_filter(20.0, dt=0.001, unit="rad", range=(-0.5, 0.5))
    >>> [(item.name, item.unit) for item in smooth.entries["step"].outputs]
    [('value', 'rad'), ('rate', 'rad/s'), ('acceleration', 'rad/s^2')]
    """
    ends, step = ends_of(name, range), seconds(name, dt)
    for what, value in (("frequency", frequency), ("damping", damping)):
        if not (is_number(value) and value > 0):
            raise ModelError(f"{name}: the {what} is {value!r}; give a positive number")
    limit = highest_frequency(step, damping)
    if frequency >= limit:
        raise ModelError(
            f"{name}: at damping {damping:g} the steps of {step:g} s diverge from {limit:g} rad/s on, and the frequency is "
            f"{frequency:g}; lower it, or dt"
        )
    dampings = min(LEAST_DAMPING, damping), max(MOST_DAMPING, damping)
    while frequency >= (shared := min(highest_frequency(step, item) for item in dampings)):  # it is least at an end
        dampings = 0.5 * (dampings[0] + damping), 0.5 * (dampings[1] + damping)
    highest = max(float(frequency), float(f"{0.999 * shared:.6g}"))
    per, per_square = (f"{unit}/s", f"{unit}/s^2") if unit else ("", "")
    block = Block(name, doc=doc or "command filter: a command and its first two derivatives")
    raw = block.input("raw", unit=unit, range=ends, doc="command, which may jump")
    omega = block.parameter(
        "frequency", frequency, unit="rad/s", range=(SLOWEST * frequency, highest), doc="natural frequency"
    )
    zeta = block.parameter("damping", damping, range=dampings, doc="damping ratio")
    _, half = middle_of(ends)
    inner = spread_range(ends, OVERSHOOT)
    fastest = rounded_up(OVERSHOOT * highest * half)
    strongest = rounded_up(2 * highest * (OVERSHOOT * highest * half + dampings[1] * fastest))
    q = block.memory("filtered", initial=initial, unit=unit, range=inner, doc="filtered command")
    rate = block.memory("filtered_rate", unit=per, range=(-fastest, fastest), doc="its rate")
    acceleration = omega**2 * (raw - q) - 2 * zeta * omega * rate
    block.entry(
        "step", inputs=[raw], following={q: q + step * rate, rate: rate + step * acceleration},
        outputs={"value": q, "rate": rate, "acceleration": acceleration},
        output_units={"value": unit, "rate": per, "acceleration": per_square},
        output_ranges={"value": inner, "rate": (-fastest, fastest), "acceleration": (-strongest, strongest)},
        doc="The filtered command and its derivatives now, then a step ahead.",
    )  # fmt: skip
    block.sample_time = step
    return finish(
        block, {"step": reference.CommandFilter(step)}, wandering({"raw": ends}),
        memory=uniform({"filtered": ends, "filtered_rate": (-frequency * half, frequency * half)}),
    )  # fmt: skip


def highest_frequency(dt: float, damping: float) -> float:
    """Return the frequency, in rad/s, from which on explicit Euler diverges: |1 + dt lambda| = 1 for a root lambda."""
    if damping <= 1:
        return 2 * damping / dt
    return 2 / (dt * (damping + math.sqrt(damping**2 - 1)))
