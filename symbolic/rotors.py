"""Mixing commands to rotors: any linear allocation of squared speeds, held at their limits."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from ..reference.rotors import Mixer
from .block import Block
from .components import finish, is_number, matrix_of, rounded_up, vector_of
from .errors import ModelError, expect

Array = NDArray[Any]

BITS = 40
"""To which the effect of a rotor is rounded, of the largest in its row: twelve digits."""

WORST_CONDITION = 1.0e8
"""Of a mixer whose rows are scaled to equal length; beyond it two commands are one in single precision."""


def rotor_mixer(
    effect: Any,
    commands: Mapping[str, str],
    *,
    fastest: float,
    slowest: float = 0.0,
    spins: Sequence[float] | None = None,
    residual: str = "residual_speed",
    ranges: Mapping[str, tuple[float, float]] | None = None,
    name: str = "mixer",
    doc: str = "",
) -> Block:
    """Return the block that turns commands u = E w^2 into speeds w of rotors, and says what those apply.

    The squared speeds are E^+ u, the least in norm that apply u; each is held within its limits (status CLAMPED), and the
    input that is applied is computed anew from what was held. That one, not the command, is what an estimator has to be told.

    Parameters
    ----------
    effect : array (commands, rotors)
        E: a row for each command, per squared speed of each rotor; rounded to 12 digits of the largest in its row.
    commands : dict
        Name of each command -> its unit: inputs of the block, and outputs with the same names, what is applied.
    fastest, slowest : float
        Limits of a speed, rad/s.
    spins : sequence of float, optional
        A sign for each rotor: their sum of signed speeds is the residual speed, of which the gyroscopic torque is made.
        Default alternating, the first positive.
    residual : str
        Name of that output.
    ranges : dict, optional
        Command -> (low, high); outside it a call is refused (BAD_INPUT). Default: ten times what the rotors can apply.
    name, doc : str
        Name and meaning of the block.

    Returns
    -------
    Block
        Entries `init` and `step`, no memory. Outputs: `squared_speed`, `speed`, what is applied, and the residual speed.

    Raises
    ------
    ModelError
        If E does not fit the names, is not of full rank (some command would be beyond the rotors), or the limits are in the
        wrong order.

    Notes
    -----
    The rotors follow at once: their own dynamics are no part of it.
    """
    expect(commands, Mapping, f"{name}: commands", "a dictionary, name -> unit")
    expect(ranges or {}, Mapping, f"{name}: ranges", "a dictionary, command -> (low, high)")
    E = _checked_effect(name, effect, commands)
    rotors = E.shape[1]
    if not (is_number(slowest) and is_number(fastest) and 0 <= slowest < fastest < 1e9):
        raise ModelError(
            f"{name}: the speeds are {slowest!r} to {fastest!r}; give them in rad/s, zero or more, the slowest first"
        )
    signs = vector_of(name, "spins", spins if spins is not None else (-1.0) ** np.arange(rotors), rotors)
    if not np.all(np.abs(signs) == 1):
        raise ModelError(f"{name}: spins is {spins!r}; give 1 or -1 for each of the {rotors} rotors")
    unknown = sorted(set(ranges or {}) - set(commands))
    if unknown:
        raise ModelError(f"{name}: ranges= names {unknown[0]!r}, which is no command; they are {', '.join(commands)}")
    most = rounded_up(fastest * rotors)
    block = Block(name, doc=doc or f"squared speeds of {rotors} rotors for {', '.join(commands)}, held within limits")
    taken, applied_ranges = [], {}
    for k, (command, unit) in enumerate(commands.items()):
        reach = rounded_up(float(np.sum(np.abs(E[k]))) * fastest**2)
        own = (ranges or {}).get(command, (-10 * reach, 10 * reach))
        taken.append(block.input(command, unit=unit, range=own, doc="commanded"))
        applied_ranges[command] = (-reach, reach)
    low, high = slowest**2, fastest**2
    wanted = ca.sparsify(ca.DM(exact_pseudoinverse(E))) @ ca.vertcat(*taken)
    squares = ca.fmin(ca.fmax(wanted, low), high)
    applied = ca.sparsify(ca.DM(E)) @ squares
    speeds = ca.sqrt(squares)
    block.entry(
        "step",
        inputs=taken,
        outputs={
            "squared_speed": wanted,
            "speed": speeds,
            **{command: applied[k] for k, command in enumerate(commands)},
            residual: ca.dot(ca.DM(signs), speeds),
        },
        output_units={"squared_speed": "rad^2/s^2", "speed": "rad/s", **commands, residual: "rad/s"},
        output_ranges={
            "squared_speed": (0.0, 2 * high),
            "speed": (0.0, 2 * fastest),
            **applied_ranges,
            residual: (-most, most),
        },
        output_docs={
            "squared_speed": "of each rotor; keeps its last value when a call is refused",
            "speed": "of each rotor",
            **{command: "applied: that of the speeds that were held" for command in commands},
            residual: "sum of the speeds, each with the sign of its spin",
        },
        limits={"squared_speed": (low, high)},
        doc="Squared speeds for a command, held within their limits, and what they apply.",
    )
    block.float_bound = 0.05
    oracle = Mixer(E, tuple(commands), slowest, fastest, signs, residual)
    return finish(block, {"step": oracle}, _around(E, tuple(commands), low, high, block))


def _checked_effect(name: str, effect: Any, commands: Mapping[str, str]) -> Array:
    """Return E as numbers, or raise a ModelError."""
    E = matrix_of(name, "the effect of the rotors", effect)
    if len(E) != len(commands) or not commands:
        raise ModelError(
            f"{name}: the effect of the rotors has {len(E)} row(s) and there are {len(commands)} commands; give a row for each"
        )
    lengths = np.linalg.norm(E, axis=1)
    idle = [command for command, length in zip(commands, lengths, strict=True) if length == 0]
    if idle:
        raise ModelError(f"{name}: no rotor moves the command {idle[0]!r}; mend its row, or leave it out")
    values = np.linalg.svd(E / lengths[:, None], compute_uv=False)
    rank = int(np.sum(values > values[0] / WORST_CONDITION))
    if rank < len(E):
        raise ModelError(
            f"{name}: the mixer is singular: its {E.shape[1]} rotors apply {rank} independent command(s) of the {len(E)} that are "
            "asked for; mend the matrix, add rotors, or leave commands out"
        )
    return np.array([_rounded(row) for row in E])


def _rounded(row: Array) -> Array:
    """Return a row with 40 bits of its largest element: what a sine of pi leaves is zero, and limits cancel exactly."""
    _, exponent = np.frexp(np.max(np.abs(row)))
    return np.asarray(np.ldexp(np.round(np.ldexp(row, BITS - exponent)), exponent - BITS))


def exact_pseudoinverse(E: Array) -> Array:
    """Return E' (E E')^-1, each element rounded once, from rational arithmetic: the same bits on any machine.

    Parameters
    ----------
    E : array (commands, rotors)
        Of full row rank.
    """
    rows = [[Fraction(float(item)) for item in row] for row in E]
    left = [[sum((a * b for a, b in zip(one, two, strict=True)), Fraction(0)) for two in rows] for one in rows]
    work = [[*own, *row] for own, row in zip(left, rows, strict=True)]  # (E E') Z = E, and the answer is Z'
    for k in range(len(work)):
        best = max(range(k, len(work)), key=lambda i: abs(work[i][k]))
        work[k], work[best] = work[best], work[k]
        work[k] = [item / work[k][k] for item in work[k]]
        for i in range(len(work)):
            if i != k and work[i][k]:
                factor = work[i][k]
                work[i] = [item - factor * pivot for item, pivot in zip(work[i], work[k], strict=True)]
    return np.array([[float(item) for item in row[len(work) :]] for row in work]).T


def _around(E: Array, commands: tuple[str, ...], low: float, high: float, block: Block) -> Any:
    """Return calls whose squared speeds are within their limits, and now and then beyond."""
    ends = {signal.name: (signal.low[0], signal.high[0]) for signal in block.entries["step"].inputs}

    def calls(rng: Any, steps: int) -> Iterator[tuple[str, dict[str, Any]]]:
        yield "init", {}
        for k in range(steps):
            beyond = 0.25 * (high - low) if k % 4 == 3 else -0.01 * (high - low)
            u = E @ rng.uniform(low - beyond, high + beyond, E.shape[1])
            yield "step", {name: float(np.clip(u[i], *ends[name])) for i, name in enumerate(commands)}

    return calls
