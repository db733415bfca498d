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
from . import quaternions
from .analysis import HAUTUS_TOLERANCE, OperatingPoint, linearise
from .block import Block, Design
from .components import (
    Calls,
    Ends,
    check_rising,
    declare_limits,
    ends_of,
    finish,
    matrix_of,
    middle_of,
    rounded_up,
    seconds,
)
from .design import Gain, closed_loop_eigenvalues
from .errors import ModelError, yes_or_no
from .filters import low_pass, notch, rate_limiter, saturation
from .linear_systems import state_space, transfer_function
from .plant import Plant, Symbol, wrap
from .regulator_equations import closed_loop, model_of
from .signals import Signal

__all__ = [
    "low_pass",
    "notch",
    "pid",
    "rate_limiter",
    "saturation",
    "state_feedback",
    "state_space",
    "transfer_function",
]

Array = NDArray[Any]

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
    accept_unstable: bool = False,
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
    accept_unstable : bool
        Whether a gain is accepted that makes the linearisation at the point unstable, in modes that the inputs reach.
    doc : str
        Its meaning.

    Returns
    -------
    Block
        Entries `init` and `step`, no memory. The deviation of an angle is wrapped; that of an attitude is twice the vector
        part of q*^-1 q, the shorter way round: to first order the error for which the plant is linearised.

    Raises
    ------
    RegulatorError
        If A - B K is unstable in a mode that the inputs reach; the sentence has the spectral radius, or the largest real part.
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
    K = gain.rounded() if isinstance(gain, Gain) else matrix_of(name, "gain", gain)
    shape = (plant.u.numel(), plant.error_size)
    if K.shape != shape:
        raise ModelError(
            f"{name}: the gain has shape {K.shape}; give {shape[0]} x {shape[1]}, a row for each input of {plant.name!r} "
            "(u = u* - K (x - x*))"
        )
    if not accept_unstable:
        _check_stable(plant, where, gain.dt if isinstance(gain, Gain) else None, K)
    block = Block(name, doc=doc or f'state feedback of the plant "{plant.name}": u = u* - K (x - x*)')
    saturate = yes_or_no(saturate, f"{block.name}: saturate=")
    formula = _give_law(block, plant, _declare_feedback(block, plant, where, K), saturate)
    finish(block, {"step": formula}, _around(plant, where, K, saturate))
    if isinstance(gain, Gain):
        block.design = _design(block, gain)
    return block


def _give_law(block: Block, plant: Plant, taken: dict[str, Symbol], saturate: bool) -> reference.StateFeedback:
    """Give a block the entry `step`; return its oracle."""
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
    return reference.StateFeedback(kinds, outputs, saturate)


UNSTABLE = 1.0e-6
"""How far beyond the limit of stability an eigenvalue is refused: one on it is for who leaves an integrator alone."""


def _check_stable(plant: Plant, where: OperatingPoint, dt: float | None, K: Array) -> None:
    """Refuse a gain that makes unstable what it acts on; what the inputs do not reach is no fault of the gain."""
    steps = plant.dt if isinstance(plant.dt, tuple) else (None,)
    for step in steps:
        model = model_of(linearise(plant, where, dt=step))
        if model.dt is None and dt is not None:
            model = model.sampled(dt)  # the gain was designed for commands that are held
        values = closed_loop_eigenvalues(model.A, model.B, K)
        beyond = values.real if model.dt is None else np.abs(values) - 1
        if any(_reached(model.A, model.B, value) for value in values[beyond > UNSTABLE]):
            closed_loop(model, K)


def _reached(A: Array, B: Array, value: complex) -> bool:
    """Whether a mode can be moved by an input: [A - s I, B] has full rank (Hautus 1969)."""
    sizes = np.linalg.svd(np.hstack([A - value * np.eye(len(A)), B]), compute_uv=False)
    return bool(sizes[len(A) - 1] > HAUTUS_TOLERANCE * sizes[0])


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
    rows = ", ".join(symbol.signal.name for symbol in plant.inputs)
    block.parameter(
        "gain", K.ravel(), range=gain_range(K), doc=f"K by rows ({rows}), columns in the order of the states"
    )
    return taken


def gain_range(matrix: Array) -> Ends:
    """Return the range of the elements of a gain, or of other designed numbers that multiply signals."""
    size = float(np.max(np.abs(matrix), initial=0.0))
    reach = LARGEST_GAIN if size <= 0.1 * LARGEST_GAIN else 10.0 ** (math.ceil(math.log10(size)) + 1)
    return -reach, reach


def _feedback_law(block: Block, plant: Plant, taken: dict[str, Symbol]) -> tuple[dict[str, ca.SX], list[Signal]]:
    """Return the commands as expressions, and the signals of the plant's inputs."""
    wanted = {symbol.signal.name: symbol for symbol in block.param_symbols()}
    deviation = deviation_from(plant, taken, wanted)
    K = ca.reshape(ca.SX(wanted["gain"]), plant.error_size, plant.u.numel()).T
    command, start = K @ deviation, 0
    answer = {}
    for symbol in plant.inputs:
        signal = symbol.signal
        answer[signal.name] = ca.SX(wanted[signal.name]) - command[start : start + signal.size]
        start += signal.size
    return answer, [symbol.signal for symbol in plant.inputs]


def deviation_from(
    plant: Plant, taken: Mapping[str, Symbol], wanted: Mapping[str, Any], moved: ca.SX | None = None
) -> ca.SX:
    """Return the deviation of a state from a set point: angles wrapped, an attitude's the shorter way round.

    `moved` (error_size, 1) is by how much the state has to be elsewhere. An angle is wrapped after that is taken off: a heading
    that turns on and on is followed past half a turn. Of an attitude it is a rotation vector, taken off to first order.
    """
    pieces = []
    for state in plant.states:
        value, aim = ca.SX(taken[state.signal.name]), ca.SX(wanted[state.signal.name])
        ahead = ca.SX(state.error_at.stop - state.error_at.start, 1) if moved is None else moved[state.error_at]
        if state.attitude:
            turned = quaternions.product(quaternions.conjugate(aim), value)
            pieces.append(ca.if_else(turned[0] >= 0, 1, -1) * quaternions.rotation_of(turned) - ahead)
        elif state.signal.angle:
            pieces.append(wrap(value - aim - ahead))
        else:
            pieces.append(value - aim - ahead)
    return ca.vertcat(*pieces)


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
        given = gain.checked(block.name, values["gain"])
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
    step, ends = seconds(name, dt), ends_of(name, range)
    low, high = ends_of(name, command_range)
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
    declare_limits(block, low, high, command_unit, (low, high))
    bottom, top = block.param_symbols()[-2:]
    size = max(abs(ends[0]), abs(ends[1]))
    slopes = abs(derivative) / (times[0] + step) * 2 * (1 + abs(derivative_weight))
    reach = rounded_up(
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
    check_rising(block)
    law = reference.Pid(step)
    return finish(
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
    largest = rounded_up(1e3 * max(1.0, *map(abs, gains)))
    made = [
        block.parameter("proportional", gains[0], unit=per, range=(-largest, largest), doc="gain of the error"),
        block.parameter(
            "integral", gains[1], unit=per and f"{per}/s", range=(-largest, largest), doc="gain of its integral"
        ),
        block.parameter(
            "derivative", gains[2], unit=per and f"{per} s", range=(-largest, largest), doc="gain of its slope"
        ),
    ]
    longest = rounded_up(1e3 * max(1.0, dt, *times))
    made.append(block.parameter("filter_time", times[0], unit="s", range=(0, longest), doc="of the slope"))
    made.append(block.parameter("set_point_weight", weights[0], range=(-10, 10), doc="of the set point in the error"))
    made.append(block.parameter("derivative_weight", weights[1], range=(-10, 10), doc="of the set point in the slope"))
    meaning = "how fast the integral yields where the command is held"
    made.append(block.parameter("tracking_time", times[1], unit="s", range=(dt, longest), doc=meaning))
    return made


def _regulating(kp: float, ends: Ends, command: Ends) -> Calls:
    """Return steps with readings about a wandering set point, at times a hand that takes over."""
    centre, half = middle_of(ends, 10.0)
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
    centre, half = middle_of(ends, 10.0)

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
