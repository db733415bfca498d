"""Small blocks of every loop: limits, filters, and linear systems."""

from __future__ import annotations

import math
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from ..reference import controllers as reference
from ..reference.controllers import Formula
from .block import Block
from .components import (
    Ends,
    check_rising,
    declare_limits,
    ends_of,
    finish,
    middle_of,
    seconds,
    spread_range,
    uniform,
    wandering,
)
from .errors import ModelError
from .plant import Symbol

Array = NDArray[Any]

HIGHEST_FREQUENCY = 0.45
"""Of a filter's parameters, in units of 1 / dt: just below half of it, where a tangent has a pole."""


# -- small blocks of one signal ---------------------------------------------------------------------------------------


def saturation(
    low: float, high: float, *, name: str = "saturation", unit: str = "", range: Ends | None = None, doc: str = ""
) -> Block:
    """Return a block that holds a signal between two limits; where that changes it the status is CLAMPED.

    Parameters
    ----------
    low, high : float
        The limits: run-time parameters `minimum` and `maximum`; `init` refuses them in the wrong order (BAD_PARAM).
    name, doc : str
        Name and meaning of the block.
    unit : str
        Of the signal.
    range : (low, high), optional
        Of the input `raw`, and of the limits. Default -1e6 .. 1e6.

    Returns
    -------
    Block
        Input `raw`, output `limited`, no memory.
    """
    ends = ends_of(name, range)
    block = Block(name, doc=doc or "holds a signal between two limits")
    raw = block.input("raw", unit=unit, range=ends)
    declare_limits(block, low, high, unit, ends)
    bottom, top = block.param_symbols()
    block.entry(
        "step", inputs=[raw], outputs={"limited": raw}, output_units={"limited": unit},
        output_ranges={"limited": ends}, limits={"limited": (bottom, top)},
    )  # fmt: skip
    check_rising(block)
    reach = 2 * (np.abs(low) + np.abs(high)) + high - low
    wide = max(ends[0], low - reach), min(ends[1], high + reach)
    return finish(block, {"step": reference.saturation}, wandering({"raw": wide}), rising=(("minimum", "maximum"),))


def rate_limiter(
    rise: float,
    fall: float | None = None,
    *,
    dt: float,
    name: str = "rate_limiter",
    unit: str = "",
    range: Ends | None = None,
    initial: float = 0.0,
    doc: str = "",
) -> Block:
    """Return a block that follows a signal no faster than allowed; where it lags the status is CLAMPED.

    Parameters
    ----------
    rise, fall : float
        Largest rate upwards (at least 0) and downwards (at most 0; default -rise), per second: run-time parameters.
    dt : float
        Seconds per step.
    name, doc : str
        Name and meaning of the block.
    unit : str
        Of the signal.
    range : (low, high), optional
        Of the input `raw` and of the output. Default -1e6 .. 1e6.
    initial : float
        Where it starts; the run-time parameter `last_0`.

    Returns
    -------
    Block
        Input `raw`, output `limited`.
    """
    down = -rise if fall is None else fall
    if not (rise >= 0 and down <= 0):
        raise ModelError(f"{name}: rise is {rise:g} and fall {down:g}; give rise as zero or more, fall as zero or less")
    ends = ends_of(name, range)
    step = seconds(name, dt)
    rate = f"{unit}/s" if unit else ""
    fastest = 2 * (ends[1] - ends[0]) / step
    block = Block(name, doc=doc or "follows a signal no faster than allowed")
    raw = block.input("raw", unit=unit, range=ends)
    up = block.parameter("rise", rise, unit=rate, range=(0, fastest), doc="largest rate upwards")
    fallen = block.parameter("fall", down, unit=rate, range=(-fastest, 0), doc="largest rate downwards")
    last = block.memory("last", initial=initial, unit=unit, range=ends, doc="last output")
    least, most = last + step * fallen, last + step * up
    block.entry(
        "step", inputs=[raw], following={last: ca.fmin(ca.fmax(raw, least), most)}, outputs={"limited": raw},
        output_units={"limited": unit}, output_ranges={"limited": ends}, limits={"limited": (least, most)},
    )  # fmt: skip
    block.sample_time = step
    near = step * max(rise, -down)
    wide = max(ends[0], initial - 40 * near - 1e-3), min(ends[1], initial + 40 * near + 1e-3)
    return finish(
        block, {"step": reference.RateLimiter(step)}, wandering({"raw": wide}), memory=uniform({"last": wide})
    )


def low_pass(
    cutoff: float,
    *,
    dt: float,
    order: int = 1,
    name: str = "low_pass",
    unit: str = "",
    range: Ends | None = None,
    initial: float = 0.0,
    doc: str = "",
) -> Block:
    """Return a Butterworth low-pass filter of first or second order.

    Parameters
    ----------
    cutoff : float
        Frequency at which half the power passes, in Hz, up to 0.45 / dt: a run-time parameter.
    dt : float
        Seconds per step.
    order : {1, 2}
        More: see `transfer_function`.
    name, doc : str
        Name and meaning of the block.
    unit : str
        Of the signal.
    range : (low, high), optional
        Of the input `raw`. Default -1e6 .. 1e6.
    initial : float
        The signal before the first step: run-time parameter `smooth_0`.

    Returns
    -------
    Block
        Input `raw`, output `filtered`. It may be retuned while it runs.

    Notes
    -----
    The bilinear transform of the analogue filter with the cutoff prewarped, as trapezoidal integrators (Zavalishin, "The
    Art of VA Filter Design", 2012, ch. 3 and 4): what is stored does not depend on the coefficients, so that a change of
    the cutoff does not disturb the output.
    """
    if order not in (1, 2):
        raise ModelError(f"{name}: the order is {order!r}; give 1 or 2, or use transfer_function for more")
    ends, step = ends_of(name, range), seconds(name, dt)
    block = Block(name, doc=doc or f"low-pass filter, Butterworth of order {order}")
    raw = block.input("raw", unit=unit, range=ends)
    frequency = _frequency(block, "cutoff", cutoff, step, "where half the power passes")
    g = ca.tan((math.pi * step) * frequency)
    inner = spread_range(ends, 10.0)
    smooth = block.memory("smooth", initial=initial, unit=unit, range=inner, doc="what the last integrator stores")
    if order == 1:
        filtered = (smooth + g * raw) / (1 + g)
        following = {smooth: 2 * filtered - smooth}
    else:
        half = 0.5 * (inner[1] - inner[0])
        band = block.memory("band", unit=unit, range=(-half, half), doc="what the first integrator stores")
        damping = math.sqrt(2.0)
        middle = (band + g * (raw - smooth)) / (1 + g * (damping + g))
        filtered = smooth + g * middle
        following = {smooth: 2 * filtered - smooth, band: 2 * middle - band}
    block.entry(
        "step", inputs=[raw], following=following, outputs={"filtered": filtered}, output_units={"filtered": unit},
        output_ranges={"filtered": inner},
    )  # fmt: skip
    block.sample_time = step
    return _finish_filter(block, reference.LowPass(step, order), ends)


def notch(
    frequency: float,
    width: float,
    *,
    dt: float,
    depth: float = 1.0,
    name: str = "notch",
    unit: str = "",
    range: Ends | None = None,
    initial: float = 0.0,
    doc: str = "",
) -> Block:
    """Return a filter that takes out one frequency.

    Parameters
    ----------
    frequency : float
        Centre, in Hz: a run-time parameter, from a tenth of it to ten times (at most 0.45 / dt).
    width : float
        Of the band in which less than half the power passes (at depth 1), in Hz: a run-time parameter, likewise.
    dt : float
        Seconds per step.
    depth : float
        Of the signal at the centre, the share that is taken out, 0 .. 1: a run-time parameter.
    name, doc : str
        Name and meaning of the block.
    unit : str
        Of the signal.
    range : (low, high), optional
        Of the input `raw`. Default -1e6 .. 1e6.
    initial : float
        The signal before the first step: run-time parameter `smooth_0`.

    Returns
    -------
    Block
        Input `raw`, output `filtered`. It may be retuned while it runs.

    Notes
    -----
    At depth 1 the filter of `scipy.signal.iirnotch` with Q = frequency / width: the bilinear transform of the analogue
    filter, frequency and width in their place after it, as trapezoidal integrators (see `low_pass`).
    """
    ends, step = ends_of(name, range), seconds(name, dt)
    block = Block(name, doc=doc or "takes out one frequency")
    raw = block.input("raw", unit=unit, range=ends)
    centre = _frequency(block, "frequency", frequency, step, "centre", decade=True)
    across = _frequency(
        block, "width", width, step, "of the band in which less than half the power passes", decade=True
    )
    share = block.parameter("depth", depth, range=(0, 1), doc="share of the signal that is taken out at the centre")
    g, beta = ca.tan((math.pi * step) * centre), ca.tan((math.pi * step) * across)
    b = beta * (1 + g * g) / g
    # at the centre both integrators swing 1/b times as far as the signal
    narrowest = math.tan(math.pi * step * block.param_signals[1].low[0])
    inner = spread_range(ends, 10.0 + 2.0 / narrowest)
    half = 0.5 * (inner[1] - inner[0])
    smooth = block.memory("smooth", initial=initial, unit=unit, range=inner, doc="what the last integrator stores")
    band = block.memory("band", unit=unit, range=(-half, half), doc="what the first integrator stores")
    middle = (band + g * (raw - smooth)) / (1 + g * (b + g))
    low = smooth + g * middle
    block.entry(
        "step", inputs=[raw], following={smooth: 2 * low - smooth, band: 2 * middle - band},
        outputs={"filtered": raw - share * b * middle}, output_units={"filtered": unit},
        output_ranges={"filtered": inner},
    )  # fmt: skip
    block.sample_time = step
    return _finish_filter(block, reference.Notch(step), ends)


def _frequency(block: Block, name: str, value: float, dt: float, doc: str, *, decade: bool = False) -> Symbol:
    """Declare a frequency in Hz, below 0.45 / dt: there the bilinear transform still has digits."""
    highest = HIGHEST_FREQUENCY / dt
    if not 0 < value <= highest:
        raise ModelError(
            f"{block.name}: the {name} is {value:g} Hz; give more than 0 and at most {highest:g} Hz ({HIGHEST_FREQUENCY} / dt)"
        )
    low, high = (0.1 * value, min(10 * value, highest)) if decade else (1e-6 * highest, highest)
    low = min(low, value)
    return block.parameter(name, value, unit="Hz", range=(low, high), doc=doc)


def _finish_filter(block: Block, formula: Formula, ends: Ends) -> Block:
    """Give a filter its oracle, and a scenario in which what it stores is of the size of its input."""
    half = middle_of(ends)[1]
    stores = {signal.name: ends if signal.name == "smooth" else (-half, half) for signal in block.memory_signals}
    return finish(block, {"step": formula}, wandering({"raw": ends}), memory=uniform(stores))
