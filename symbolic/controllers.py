"""Controllers and the small blocks of every loop: functions that return a Block with an oracle of its own."""

from __future__ import annotations

import copy
import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from ..reference import controllers as reference
from ..reference.controllers import ControllerOracle, Formula, Range
from . import quaternions
from .analysis import OperatingPoint
from .block import Block, Design, Scenario
from .design import Gain
from .errors import ModelError
from .plant import Plant, Symbol, wrap
from .program import Compare, Element, Place, Refuse
from .signals import WIDE, Signal, Status, make_range

Array = NDArray[Any]
Calls = Callable[[Any, int], Iterator[tuple[str, dict[str, Any]]]]

Ends = tuple[float, float]

HIGHEST_FREQUENCY = 0.45
"""Of a filter's parameters, in units of 1 / dt: just below half of it, where a tangent has a pole."""

LARGEST_GAIN = 1.0e6
"""Range of the elements of a gain; wider where the gain itself is."""


# -- state feedback ---------------------------------------------------------------------------------------------------


def state_feedback(
    plant: Plant,
    point: Mapping[Any, Any],
    gain: Gain | Any,
    *,
    name: str = "",
    saturate: bool = False,
    doc: str = "",
) -> Block:
    """Return the controller u = u* - K (x - x*).

    Parameters
    ----------
    plant : Plant
        What is controlled; its states become inputs, its inputs outputs, with their names, units and ranges.
    point : OperatingPoint or dict
        x* and u*: state or input -> value, the rest as in `OperatingPoint.at`. They become run-time parameters of the
        same names, so that the set point can be moved.
    gain : Gain, or (inputs, n) array
        K, by rows; n counts three for an attitude. It becomes the run-time parameter `gain`, rounded to 9 digits; that of
        a `Gain` goes through `design.json`, numbers of your own do not.
    name : str
        Name of the block; default ``<plant>_feedback``.
    saturate : bool
        Whether u is held within the ranges of the plant's inputs (status CLAMPED). Otherwise a call whose u would leave
        them is refused (OVERFLOW).
    doc : str
        Its meaning.

    Returns
    -------
    Block
        Entries `init` and `step`, no memory. The deviation of an angle is wrapped; that of an attitude is twice the vector
        part of q*^-1 q, the shorter way round: to first order the error for which the plant is linearised.

    Raises
    ------
    ModelError
        If the gain has another shape, the point is outside a range, or the plant has no input.

    Examples
    --------
    >>> from plantc.symbolic import Plant
    >>> from plantc.symbolic.controllers import state_feedback
    >>> tank = Plant("tank", dt=0.1)
    >>> level = tank.state("level", unit="m", range=(0, 5))
    >>> flow = tank.input("flow", unit="m/s", range=(0, 2))
    >>> tank.dynamics({level: 0.9 * level + 0.1 * flow})
    >>> feedback = state_feedback(tank, {level: 1, flow: 1}, [[2.0]], saturate=True)
    >>> [signal.name for signal in feedback.entries["step"].outputs]
    ['flow']
    """
    name = name or f"{plant.name}_feedback"
    where = OperatingPoint.at(plant, point)
    if not plant.inputs:
        raise ModelError(f"{name}: the plant {plant.name!r} has no input to act on; declare one with input()")
    K = gain.rounded() if isinstance(gain, Gain) else _matrix(name, "gain", gain)
    shape = (plant.u.numel(), plant.error_size)
    if K.shape != shape:
        raise ModelError(
            f"{name}: the gain has shape {K.shape}; give {shape[0]} x {shape[1]}, a row for each input of {plant.name!r} "
            "(u = u* - K (x - x*))"
        )
    block = Block(name, doc=doc or f'state feedback of the plant "{plant.name}": u = u* - K (x - x*)')
    taken = _declare_feedback(block, plant, where, K)
    free, signals = _feedback_law(block, plant, taken)
    block.entry(
        "step",
        inputs=[taken[state.signal.name] for state in plant.states],
        outputs=free,
        output_units={item.name: item.unit for item in signals},
        output_ranges={item.name: (item.low, item.high) for item in signals},
        output_docs={
            item.name: f"{item.doc or 'command'}; keeps its last value when a call is refused" for item in signals
        },
        limits={item.name: (item.low, item.high) for item in signals} if saturate else {},
        doc="The command for a state.",
    )
    block.sample_time = plant.dt if isinstance(plant.dt, float) else None
    kinds = tuple(
        (state.signal.name, "attitude" if state.attitude else "angle" if state.signal.angle else "plain")
        for state in plant.states
    )
    outputs = tuple((item.name, item.size, np.array(item.low), np.array(item.high)) for item in signals)
    _finish(block, {"step": reference.StateFeedback(kinds, outputs, saturate)}, _around(plant, where, K, saturate))
    if isinstance(gain, Gain):
        block.design = _design(block, gain)
    return block


def _declare_feedback(block: Block, plant: Plant, where: OperatingPoint, K: Array) -> dict[str, Symbol]:
    """Declare inputs and parameters; return the inputs by name."""
    taken = {}
    for state in plant.states:
        signal = state.signal
        taken[signal.name] = block.input(
            signal.name, size=signal.size, unit=signal.unit, range=(signal.low, signal.high), doc=signal.doc
        )
    signals = [*[state.signal for state in plant.states], *[symbol.signal for symbol in plant.inputs]]
    values = {**where.states, **where.inputs}
    for signal in signals:
        block.parameter(
            signal.name,
            values[signal.name],
            unit=signal.unit,
            range=(signal.low, signal.high),
            doc=f"set point of {signal.name}" if signal.name in taken else f"{signal.name} that holds the set point",
        )
    size = float(np.max(np.abs(K), initial=0.0))
    reach = LARGEST_GAIN if size <= 0.1 * LARGEST_GAIN else 10.0 ** (math.ceil(math.log10(size)) + 1)
    rows = ", ".join(symbol.signal.name for symbol in plant.inputs)
    block.parameter(
        "gain", K.ravel(), range=(-reach, reach), doc=f"K by rows ({rows}), columns in the order of the states"
    )
    return taken


def _feedback_law(block: Block, plant: Plant, taken: dict[str, Symbol]) -> tuple[dict[str, ca.SX], list[Signal]]:
    """Return the commands as expressions, and the signals of the plant's inputs."""
    wanted = {symbol.signal.name: symbol for symbol in block.param_symbols()}
    pieces = []
    for state in plant.states:
        value, aim = ca.SX(taken[state.signal.name]), ca.SX(wanted[state.signal.name])
        if state.attitude:
            turned = quaternions.product(quaternions.conjugate(aim), value)
            pieces.append(ca.if_else(turned[0] >= 0, 1, -1) * quaternions.rotation_of(turned))
        elif state.signal.angle:
            pieces.append(wrap(value - aim))
        else:
            pieces.append(value - aim)
    deviation = ca.vertcat(*pieces)
    K = ca.reshape(ca.SX(wanted["gain"]), plant.error_size, plant.u.numel()).T
    command, start = K @ deviation, 0
    answer = {}
    for symbol in plant.inputs:
        signal = symbol.signal
        answer[signal.name] = ca.SX(wanted[signal.name]) - command[start : start + signal.size]
        start += signal.size
    return answer, [symbol.signal for symbol in plant.inputs]


def _around(plant: Plant, where: OperatingPoint, K: Array, saturate: bool) -> Calls:
    """Return calls near the set point: so near that u stays within its range, or leaves it now and then if it is held."""
    low = np.concatenate([np.zeros(0), *[symbol.signal.low for symbol in plant.inputs]])
    high = np.concatenate([np.zeros(0), *[symbol.signal.high for symbol in plant.inputs]])
    spread = np.concatenate(
        [
            np.full(3, 0.3) if state.attitude
            else np.minimum(1 + np.abs(where.x[state.at]), 0.1 * (np.array(state.signal.high) - np.array(state.signal.low)))
            for state in plant.states
        ]
    )  # fmt: skip
    reach = np.sqrt((K**2) @ spread**2)
    room = np.maximum(np.minimum(high - where.u, where.u - low), 1e-3 * (high - low))
    factor = min(1.0, float(np.min(room / np.maximum(reach, 1e-300), initial=1.0)) * (1.0 if saturate else 0.4))
    retract = ca.Function(
        "retract", [plant.x, error := ca.SX.sym("error", plant.error_size)], [plant.retract(plant.x, error)]
    )

    def calls(rng: Any, steps: int) -> Iterator[tuple[str, dict[str, Any]]]:
        yield "init", {}
        for _ in range(steps):
            moved = factor * spread * np.clip(rng.normal(size=len(spread)), -3, 3)
            x = np.asarray(retract(where.x, moved), dtype=float).ravel()
            inputs = {}
            for state in plant.states:
                inputs[state.signal.name] = np.clip(x[state.at], state.signal.low, state.signal.high)
            yield "step", inputs

    return calls


def _design(block: Block, gain: Gain) -> Design:
    """Return the record of a designed gain."""

    def rebuild(values: dict[str, Any]) -> Block:
        given = np.asarray(values["gain"], dtype=float)
        if given.shape != gain.gain.shape or not np.all(np.isfinite(given)):
            raise ModelError(
                f"{block.name}: the gain of design.json has shape {given.shape}; give {gain.gain.shape[0]} x "
                f"{gain.gain.shape[1]} finite numbers, or export with --redesign"
            )
        made = copy.copy(block)
        default = tuple(float(item) for item in given.ravel())
        made.param_signals = [
            replace(signal, default=default) if signal.name == "gain" else signal for signal in block.param_signals
        ]
        made.design = Design({"gain": given}, gain.source(), rebuild, properties)
        return made

    def properties(values: dict[str, Any]) -> dict[str, tuple[float, float]]:
        return gain.properties(values["gain"])

    return Design({"gain": gain.rounded()}, gain.source(), rebuild, properties)


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
    ends = _ends(name, range)
    block = Block(name, doc=doc or "holds a signal between two limits")
    raw = block.input("raw", unit=unit, range=ends)
    _limits(block, low, high, unit, ends)
    bottom, top = block.param_symbols()
    block.entry(
        "step", inputs=[raw], outputs={"limited": raw}, output_units={"limited": unit},
        output_ranges={"limited": ends}, limits={"limited": (bottom, top)},
    )  # fmt: skip
    _check_rising(block)
    reach = 2 * (np.abs(low) + np.abs(high)) + high - low
    wide = max(ends[0], low - reach), min(ends[1], high + reach)
    return _finish(block, {"step": reference.saturation}, _wandering({"raw": wide}), rising=(("minimum", "maximum"),))


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
    ends = _ends(name, range)
    step = _seconds(name, dt)
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
    return _finish(
        block, {"step": reference.RateLimiter(step)}, _wandering({"raw": wide}), memory=_uniform({"last": wide})
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
    ends, step = _ends(name, range), _seconds(name, dt)
    block = Block(name, doc=doc or f"low-pass filter, Butterworth of order {order}")
    raw = block.input("raw", unit=unit, range=ends)
    frequency = _frequency(block, "cutoff", cutoff, step, "where half the power passes")
    g = ca.tan((math.pi * step) * frequency)
    inner = _spread_range(ends, 10.0)
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
    ends, step = _ends(name, range), _seconds(name, dt)
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
    inner = _spread_range(ends, 10.0 + 2.0 / narrowest)
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


# -- PID --------------------------------------------------------------------------------------------------------------


def pid(
    proportional: float,
    integral: float = 0.0,
    derivative: float = 0.0,
    *,
    dt: float,
    command_range: Ends,
    filter_time: float | None = None,
    set_point_weight: float = 1.0,
    derivative_weight: float = 0.0,
    tracking_time: float | None = None,
    name: str = "pid",
    unit: str = "",
    command_unit: str = "",
    range: Ends | None = None,
    doc: str = "",
) -> Block:
    """Return a PID controller whose integral does not wind up.

    u = Kp (b r - y) + I + D, held within limits (status CLAMPED); I grows by Ki dt (r - y) + dt/Tt (u - unlimited u) and D
    is Kd times the slope of c r - y behind a low-pass filter. Every number is a run-time parameter; gains may be negative.

    Parameters
    ----------
    proportional, integral, derivative : float
        Kp, Ki (per second) and Kd (seconds), in units of command per unit of the reading. With Ki = 0 there is no I.
    dt : float
        Seconds per step.
    command_range : (low, high)
        Where the command may be: also the defaults of its limits, `minimum` and `maximum`, which `init` refuses in the
        wrong order.
    filter_time : float, optional
        Time constant of the filter of D, in seconds. Default: a tenth of Kd / Kp, at least dt.
    set_point_weight, derivative_weight : float
        b and c: how much of the set point acts on P and on D.
    tracking_time : float, optional
        Tt, in seconds, at least dt: how fast I yields where the command is held. Default sqrt(Ti Td) of Ti = Kp / Ki and
        Td = Kd / Kp; without D it is Ti, without P dt.
    name, doc : str
        Name and meaning of the block.
    unit, command_unit : str
        Of set point and reading, and of the command.
    range : (low, high), optional
        Of set point and reading. Default -1e6 .. 1e6.

    Returns
    -------
    Block
        Entries `init`; `step` (inputs `set_point` and `measured`, output `command`); `track` (and `applied`), which sets
        the memory so that the next `step` goes on from the command that somebody else applied: call it as long as that
        is so, or after a change of gains, and nothing jumps. The first `step` has no slope to go by and takes D as zero.

    Notes
    -----
    Astrom and Hagglund, "Advanced PID Control", 2006, section 13.4: backward difference for D, forward for I,
    anti-windup by back-calculation (section 3.5).

    Examples
    --------
    >>> from plantc.symbolic.controllers import pid
    >>> heater = pid(2.0, 0.5, dt=0.1, command_range=(0, 10), unit="K", command_unit="W")
    >>> list(heater.entries)
    ['init', 'step', 'track']
    """
    step, ends = _seconds(name, dt), _ends(name, range)
    low, high = _ends(name, command_range)
    block = Block(name, doc=doc or "PID controller with anti-windup")
    r = block.input("set_point", unit=unit, range=ends)
    y = block.input("measured", unit=unit, range=ends)
    applied = block.input("applied", unit=command_unit, range=(low, high), doc="command that was applied in its place")
    times = _pid_times(name, step, proportional, integral, derivative, filter_time, tracking_time)
    kp, ki, kd, tf, b, c, tt = _pid_parameters(
        block,
        step,
        (proportional, integral, derivative),
        times,
        (set_point_weight, derivative_weight),
        command_unit,
        unit,
    )
    _limits(block, low, high, command_unit, (low, high))
    bottom, top = block.param_symbols()[-2:]
    size = max(abs(ends[0]), abs(ends[1]))
    slopes = abs(derivative) / (times[0] + step) * 2 * (1 + abs(derivative_weight))
    reach = _rounded_up(
        100 * (max(abs(low), abs(high)) + size * (abs(proportional) * (1 + abs(set_point_weight)) + slopes))
    )
    I = block.memory("integral_part", unit=command_unit, range=(-reach, reach))  # noqa: E741 - the field's letter
    D = block.memory("derivative_part", unit=command_unit, range=(-reach, reach))
    r_before = block.memory("set_point_before", unit=unit, range=ends)
    y_before = block.memory("measured_before", unit=unit, range=ends)
    running = block.memory("running", range=(0, 1), doc="0 until the first step")
    slope = tf / (tf + step) * D + kd / (tf + step) * running * (c * (r - r_before) - (y - y_before))
    wanted = kp * (b * r - y) + I + slope
    command = ca.fmin(ca.fmax(wanted, bottom), top)
    integrates = ca.fabs(ki) > 0
    total = I + (step * ki) * (r - y) + ca.if_else(integrates, (step / tt) * (command - wanted), 0)
    before = {r_before: r, y_before: y, running: 1}
    block.entry(
        "step", inputs=[r, y], following={I: total, D: slope, **before}, outputs={"command": wanted},
        output_units={"command": command_unit}, output_ranges={"command": (low, high)},
        output_docs={"command": "keeps its last value when a call is refused"}, limits={"command": (bottom, top)},
        doc="The command for a set point and a reading.",
    )  # fmt: skip
    kept = ca.fmin(ca.fmax(applied, bottom), top) - kp * (b * r - y)
    block.entry(
        "track", inputs=[r, y, applied], following={I: ca.if_else(integrates, kept, 0), D: 0, **before},
        doc="Take over without a jump: the next step goes on from the command that was applied.",
    )  # fmt: skip
    block.sample_time = step
    _check_rising(block)
    law = reference.Pid(step)
    return _finish(
        block, {"step": law.step, "track": law.track}, _regulating(proportional, ends, (low, high)),
        rising=(("minimum", "maximum"),), memory=_pid_memory(ends, (low, high)),
    )  # fmt: skip


def _pid_times(
    name: str, dt: float, kp: float, ki: float, kd: float, filter_time: float | None, tracking_time: float | None
) -> tuple[float, float]:
    """Return (filter time, tracking time), the defaults where none is given."""
    tf = filter_time if filter_time is not None else max(dt, 0.1 * abs(kd / kp)) if kp else dt
    if tracking_time is not None:
        tt = tracking_time
    elif ki == 0 or kp == 0:
        tt = dt
    else:
        ti, td = abs(kp / ki), abs(kd / kp)
        tt = max(dt, math.sqrt(ti * td) if kd else ti)
    for what, value, least in (("filter_time", tf, 0.0), ("tracking_time", tt, dt)):
        if not (math.isfinite(value) and value >= least):
            raise ModelError(f"{name}: {what} is {value:g} s; give at least {least:g} s")
    return tf, tt


def _pid_parameters(
    block: Block,
    dt: float,
    gains: tuple[float, float, float],
    times: tuple[float, float],
    weights: tuple[float, float],
    command_unit: str,
    unit: str,
) -> list[Symbol]:
    """Declare gains, times and weights."""
    per = f"{command_unit}/({unit})" if command_unit and unit else ""
    largest = _rounded_up(1e3 * max(1.0, *map(abs, gains)))
    made = [
        block.parameter("proportional", gains[0], unit=per, range=(-largest, largest), doc="gain of the error"),
        block.parameter(
            "integral", gains[1], unit=per and f"{per}/s", range=(-largest, largest), doc="gain of its integral"
        ),
        block.parameter(
            "derivative", gains[2], unit=per and f"{per} s", range=(-largest, largest), doc="gain of its slope"
        ),
    ]
    longest = _rounded_up(1e3 * max(1.0, dt, *times))
    made.append(block.parameter("filter_time", times[0], unit="s", range=(0, longest), doc="of the slope"))
    made.append(block.parameter("set_point_weight", weights[0], range=(-10, 10), doc="of the set point in the error"))
    made.append(block.parameter("derivative_weight", weights[1], range=(-10, 10), doc="of the set point in the slope"))
    meaning = "how fast the integral yields where the command is held"
    made.append(block.parameter("tracking_time", times[1], unit="s", range=(dt, longest), doc=meaning))
    return made


def _regulating(kp: float, ends: Ends, command: Ends) -> Calls:
    """Return steps with readings about a wandering set point, at times a hand that takes over."""
    centre, half = _middle(ends, 10.0)
    error = min(half, (command[1] - command[0]) / abs(kp) if kp else half)

    def calls(rng: Any, steps: int) -> Iterator[tuple[str, dict[str, Any]]]:
        yield "init", {}
        r = e = 0.0
        for k in range(steps):
            r, e = (0.95 * r + 0.3 * rng.normal(), 0.9 * e + 0.4 * rng.normal())
            wanted = centre + half * math.tanh(r)
            given = {"set_point": wanted, "measured": float(np.clip(wanted + error * math.tanh(e), *ends))}
            if k % 10 < 8:
                yield "step", given
            else:
                yield "track", {**given, "applied": rng.uniform(*command)}

    return calls


def _pid_memory(ends: Ends, command: Ends) -> Callable[[Any], dict[str, Any]]:
    centre, half = _middle(ends, 10.0)

    def memory(rng: Any) -> dict[str, Any]:
        middle, span = 0.5 * (command[0] + command[1]), command[1] - command[0]
        return {
            "integral_part": middle + span * rng.uniform(-1, 1),
            "derivative_part": 0.1 * span * rng.uniform(-1, 1),
            "set_point_before": centre + half * rng.uniform(-1, 1),
            "measured_before": centre + half * rng.uniform(-1, 1),
            "running": float(rng.integers(2)),
        }

    return memory


# -- what they share --------------------------------------------------------------------------------------------------


def _range(signal: Signal) -> Range:
    return Range(signal.name, signal.low, signal.high)


def _finish(
    block: Block,
    formulas: Mapping[str, Formula],
    calls: Calls,
    *,
    rising: tuple[tuple[str, str], ...] = (),
    memory: Callable[[Any], dict[str, Any]] | None = None,
) -> Block:
    """Give a block its oracle and its scenario."""
    entries = {name: entry for name, entry in block.entries.items() if name != "init"}
    block.oracle = ControllerOracle(
        dict(formulas),
        tuple(_range(signal) for signal in block.memory_signals),
        tuple(_range(signal) for signal in block.param_signals),
        {name: tuple(_range(signal) for signal in entry.inputs) for name, entry in entries.items()},
        {name: tuple(_range(signal) for signal in entry.outputs) for name, entry in entries.items()},
        rising,
    )
    block.scenario = Scenario(calls, memory or (lambda rng: {}))
    return block


def _matrix(owner: str, what: str, given: Any) -> Array:
    """Return what a user gave as a matrix of finite numbers."""
    try:
        matrix = np.atleast_2d(np.asarray(given, dtype=float))
    except (TypeError, ValueError):
        raise ModelError(f"{owner}: {what} is {given!r}; give a matrix of numbers") from None
    if matrix.ndim != 2 or not np.all(np.isfinite(matrix)):
        raise ModelError(f"{owner}: {what} is no matrix of finite numbers; mend it")
    return matrix


def _ends(owner: str, given: Any) -> Ends:
    """Return a range as two floats; the default is that of every signal."""
    low, high = make_range(owner, "the signal", given, (-WIDE, WIDE), 1)
    return low[0], high[0]


def _seconds(owner: str, dt: Any) -> float:
    if not (isinstance(dt, (int, float)) and math.isfinite(dt) and dt > 0):
        raise ModelError(f"{owner}: dt is {dt!r}; give the seconds per step as a positive number")
    return float(dt)


def _limits(block: Block, low: float, high: float, unit: str, ends: Ends) -> None:
    """Declare the parameters `minimum` and `maximum`."""
    if not low < high:
        raise ModelError(f"{block.name}: the limits are {low:g} and {high:g}; give the lower one first")
    block.parameter("minimum", low, unit=unit, range=ends, doc="lower limit")
    block.parameter("maximum", high, unit=unit, range=ends, doc="upper limit, not below the lower one")


def _check_rising(block: Block) -> None:
    """Let `init` refuse limits in the wrong order."""
    init = block.entries["init"]
    rising = Compare(Element(Place("param", "minimum")), "<=", Element(Place("param", "maximum")))
    block.entries["init"] = replace(init, body=(*init.body, Refuse(Status.BAD_PARAM, rising)))


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


def _middle(ends: Ends, widest: float = math.inf) -> Ends:
    """Return centre and half width of a range, of that part of it that is not absurdly wide."""
    low, high = (max(ends[0], -widest), min(ends[1], widest)) if ends[0] < widest and ends[1] > -widest else ends
    return 0.5 * (low + high), 0.5 * (high - low)


def _spread_range(ends: Ends, factor: float) -> Ends:
    """Return a range about the same centre, wider by a factor."""
    centre, half = _middle(ends)
    reach = _rounded_up(factor * half)
    return centre - reach, centre + reach


def _rounded_up(value: float) -> float:
    """Return the next number of one digit: the same on any machine, whatever its last bits."""
    if value <= 0:
        return 1.0
    power = 10.0 ** math.floor(math.log10(value))
    return float(f"{math.ceil(value / power * (1 - 1e-9)) * power:.6g}")


def _wandering(ranges: Mapping[str, Ends]) -> Calls:
    """Return steps in which every input wanders over its range, smoothly."""

    def calls(rng: Any, steps: int) -> Iterator[tuple[str, dict[str, Any]]]:
        yield "init", {}
        drive = np.zeros(len(ranges))
        for _ in range(steps):
            drive = 0.8 * drive + 0.6 * rng.normal(size=len(drive))
            inputs = {}
            for (name, ends), value in zip(ranges.items(), drive, strict=True):
                centre, half = _middle(ends)
                inputs[name] = float(np.clip(centre + half * math.tanh(value), *ends))
            yield "step", inputs

    return calls


def _uniform(ranges: Mapping[str, Ends]) -> Callable[[Any], dict[str, Any]]:
    """Return a memory whose fields are drawn from these ranges."""
    return lambda rng: {name: rng.uniform(*ends) for name, ends in ranges.items()}


def _finish_filter(block: Block, formula: Formula, ends: Ends) -> Block:
    """Give a filter its oracle, and a scenario in which what it stores is of the size of its input."""
    half = _middle(ends)[1]
    stores = {signal.name: ends if signal.name == "smooth" else (-half, half) for signal in block.memory_signals}
    return _finish(block, {"step": formula}, _wandering({"raw": ends}), memory=_uniform(stores))
