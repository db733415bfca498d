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

from ..reference.controllers import ControllerOracle, Formula, Range, StateFeedback
from . import quaternions
from .analysis import OperatingPoint
from .block import Block, Design, Scenario
from .design import Gain
from .errors import ModelError
from .plant import Plant, Symbol, wrap
from .signals import Signal

Array = NDArray[Any]
Calls = Callable[[Any, int], Iterator[tuple[str, dict[str, Any]]]]

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
    _finish(block, {"step": StateFeedback(kinds, outputs, saturate)}, _around(plant, where, K, saturate))
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
