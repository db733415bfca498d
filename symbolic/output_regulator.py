"""The output regulator as one Block: a signal generator that is observed, and the law that follows it."""

from __future__ import annotations

import copy
import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from ..reference.regulation import RegulatorFeedback
from .analysis import OperatingPoint
from .block import Block, Design
from .components import Calls, finish, matrix_of
from .composition import Delay, connect, wires
from .controllers import LARGEST_GAIN, deviation_from
from .design import Gain
from .errors import ModelError
from .plant import Plant, Symbol
from .regulator_equations import RegulatorSolution, closed_loop, linear_model
from .signal_generators import signal_groups
from .signals import Signal

Array = NDArray[Any]
Places = tuple[tuple[int, int], ...]


def output_regulator(
    plant: Plant,
    point: Mapping[Any, Any],
    gain: Gain | Any,
    solution: RegulatorSolution,
    generator: Block,
    *,
    estimator: Block | None = None,
    saturate: bool = False,
    accept_unstable: bool = False,
    name: str = "",
    doc: str = "",
) -> Block:
    """Return the regulator u = u* + Gamma w - K (x - x* - Pi w), with the observer of w, and maybe of x, in front.

    Parameters
    ----------
    plant : Plant
        What is controlled.
    point : OperatingPoint or dict
        x* and u*, where the plant was linearised.
    gain : Gain, or (acting inputs, n) array
        K; A - B K has to be stable.
    solution : RegulatorSolution
        Of `francis`: Pi and Gamma. Measured disturbances are in it; they are inputs of the plant that do not act.
    generator : Block
        Of `kalman_exosystem` or `high_gain_exosystem`: the observer of w, one vector ``w_<signal>`` for each signal.
    estimator : Block, optional
        An estimator of the plant's own state, such as `extended_kalman_filter` of it. Without one the states are inputs.
    saturate : bool
        Whether u is held within the ranges of the plant's inputs (status CLAMPED); else such a call is refused.
    accept_unstable : bool
        Whether a gain that does not stabilise is accepted.
    name, doc : str
        Name of the block, default ``<plant>_regulator``, and its meaning.

    Returns
    -------
    Block
        Parts "generator", "estimator" (if given) and "feedback". Pi, Gamma and K go through `design.json` (those of a `Gain`)
        and are run-time parameters, the maps by their elements that are not zero.

    Raises
    ------
    RegulatorError
        If the gain does not stabilise the plant.
    ModelError
        If shapes or names do not match.
    """
    name = name or f"{plant.name}_regulator"
    feedback = regulator_feedback(
        plant, point, gain, solution, saturate=saturate, accept_unstable=accept_unstable, name=f"{plant.name}_feedback"
    )
    if generator.sample_time is not None:
        feedback.sample_time = generator.sample_time
    parts, joined = {"generator": generator}, dict[str, str | Delay]()
    for signal, _ in signal_groups(solution.exosystem):
        joined[f"feedback.w_{signal}"] = f"generator.w_{signal}"
    if estimator is not None:
        where = OperatingPoint.at(plant, point)
        parts["estimator"] = estimator
        joined |= wires("estimator", "feedback", plant.states)
        acting = [item.name for item in _acting(plant, solution)]
        joined |= wires("feedback", "estimator", acting, initial={item: where.inputs[item] for item in acting})
    parts["feedback"] = feedback
    text = doc or f'output regulator of the plant "{plant.name}": follows {", ".join(solution.model.outputs)}'
    return connect(parts, joined, name, doc=text)


def regulator_feedback(
    plant: Plant,
    point: Mapping[Any, Any],
    gain: Gain | Any,
    solution: RegulatorSolution,
    *,
    saturate: bool = False,
    accept_unstable: bool = False,
    name: str = "",
    doc: str = "",
) -> Block:
    """Return the law alone: inputs are the states of the plant and ``w_<signal>``, outputs its acting inputs.

    Parameters
    ----------
    plant, point, gain, solution, saturate, accept_unstable, name, doc
        As for `output_regulator`.

    Returns
    -------
    Block
        Entries `init` and `step`, no memory.
    """
    name = name or f"{plant.name}_feedback"
    where, acting = OperatingPoint.at(plant, point), _acting(plant, solution)
    K = gain.rounded() if isinstance(gain, Gain) else matrix_of(name, "gain", gain)
    shape = (sum(item.size for item in acting), plant.error_size)
    if K.shape != shape or solution.state_map.shape[0] != shape[1] or solution.input_map.shape[0] != shape[0]:
        raise ModelError(
            f"{name}: the gain has shape {K.shape}, Pi {solution.state_map.shape} and Gamma {solution.input_map.shape}; give K "
            f"{shape[0]} x {shape[1]}, and the solution for this plant"
        )
    model = solution.model
    if isinstance(gain, Gain) and gain.dt != model.dt:  # a law for samples, maps of the continuous plant
        model = linear_model(gain.A, gain.B, np.zeros((0, len(gain.A))), dt=gain.dt, name=plant.name)
    closed_loop(model, K, accept_unstable=accept_unstable)
    block = Block(name, doc=doc or "u = u* + Gamma w - K (x - x* - Pi w)")
    maps = solution.rounded()
    taken, generated, places = _declare(block, plant, where, K, solution, maps, acting)
    outputs = _law(block, plant, taken, generated, places, acting)
    block.entry(
        "step",
        inputs=[*taken.values(), *generated],
        outputs=outputs,
        output_units={item.name: item.unit for item in acting},
        output_ranges={item.name: (item.low, item.high) for item in acting},
        output_docs={
            item.name: f"{item.doc or 'command'}; keeps its last value when a call is refused" for item in acting
        },
        limits={item.name: (item.low, item.high) for item in acting} if saturate else {},
        doc="The command for a state of the plant and of the exosystem.",
    )
    block.sample_time = plant.dt if isinstance(plant.dt, float) else solution.exosystem.dt
    kinds = tuple(
        (state.signal.name, "attitude" if state.attitude else "angle" if state.signal.angle else "plain")
        for state in plant.states
    )
    formula = RegulatorFeedback(
        kinds,
        tuple((item.name, item.size, np.array(item.low), np.array(item.high)) for item in acting),
        tuple(symbol.signal.name for symbol in generated), *places, saturate,
    )  # fmt: skip
    finish(block, {"step": formula}, _near(plant, where, K, solution, generated))
    block.design = _design(block, gain, solution, places)
    return block


def _acting(plant: Plant, solution: RegulatorSolution) -> list[Signal]:
    """Return the inputs of the plant that act: all but measured disturbances."""
    away = set(solution.model.disturbances)
    found = [symbol.signal for symbol in plant.inputs if symbol.signal.name not in away]
    if not found:
        raise ModelError(f"{plant.name}: it has no input to act with; declare one with input()")
    return found


def _declare(
    block: Block,
    plant: Plant,
    where: OperatingPoint,
    K: Array,
    solution: RegulatorSolution,
    maps: Mapping[str, Array],
    acting: list[Signal],
) -> tuple[dict[str, Symbol], list[Symbol], tuple[Places, Places]]:
    """Declare inputs and parameters; return states, w, and where the elements of the maps stand."""
    taken, states = {}, [state.signal for state in plant.states]
    for signal in states:
        ends = (signal.low, signal.high)
        taken[signal.name] = block.input(signal.name, size=signal.size, unit=signal.unit, range=ends, doc=signal.doc)
    generated = [
        block.input(f"w_{signal}", size=len(columns), doc=f"state of the generator of {signal}")
        for signal, columns in signal_groups(solution.exosystem)
    ]
    values = {**where.states, **where.inputs}
    for signal in [*states, *acting]:
        word = "set point of" if signal.name in taken else "what holds the set point:"
        block.parameter(
            signal.name,
            values[signal.name],
            unit=signal.unit,
            range=(signal.low, signal.high),
            doc=f"{word} {signal.name}",
        )
    rows = ", ".join(item.name for item in acting)
    block.parameter("gain", K.ravel(), range=_reach(K), doc=f"K by rows ({rows}), columns in the order of the states")
    order = [k for _, columns in signal_groups(solution.exosystem) for k in columns]
    places = []
    for what, letter in (("state_map", "Pi"), ("input_map", "Gamma")):
        matrix = maps[what][:, order]
        own = tuple((int(i), int(j)) for i, j in np.argwhere(matrix != 0))
        places.append(own)
        if own:
            told = " ".join(f"({i} {j})" for i, j in own)
            numbers = [float(matrix[i, j]) for i, j in own]
            block.parameter(
                what, numbers, range=_reach(np.array(numbers)), doc=f"{letter}, its elements {told}; the rest is zero"
            )
    return taken, generated, (places[0], places[1])


def _reach(matrix: Array) -> tuple[float, float]:
    size = float(np.max(np.abs(matrix), initial=0.0))
    far = LARGEST_GAIN if size <= 0.1 * LARGEST_GAIN else 10.0 ** (math.ceil(math.log10(size)) + 1)
    return -far, far


def _law(
    block: Block,
    plant: Plant,
    taken: Mapping[str, Symbol],
    generated: list[Symbol],
    places: tuple[Places, Places],
    acting: list[Signal],
) -> dict[str, ca.SX]:
    """Return the commands as expressions."""
    wanted = {symbol.signal.name: symbol for symbol in block.param_symbols()}
    w = ca.vertcat(ca.SX(0, 1), *generated)
    size = sum(item.size for item in acting)
    maps = []
    for what, own, rows in (("state_map", places[0], plant.error_size), ("input_map", places[1], size)):
        matrix = ca.SX(rows, w.numel())
        for k, (i, j) in enumerate(own):
            matrix[i, j] = ca.SX(wanted[what])[k]
        maps.append(matrix)
    K = ca.reshape(ca.SX(wanted["gain"]), plant.error_size, size).T
    change = maps[1] @ w - K @ (deviation_from(plant, taken, wanted) - maps[0] @ w)
    answer, start = {}, 0
    for signal in acting:
        answer[signal.name] = ca.SX(wanted[signal.name]) + change[start : start + signal.size]
        start += signal.size
    return answer


def _near(plant: Plant, where: OperatingPoint, K: Array, solution: RegulatorSolution, generated: list[Symbol]) -> Calls:
    """Return calls near where the plant should be, so near that commands stay within their ranges."""
    order = [k for _, columns in signal_groups(solution.exosystem) for k in columns]
    Pi, Gamma = solution.state_map[:, order], solution.input_map[:, order]
    signals = _acting(plant, solution)
    low, high = (np.concatenate([getattr(item, end) for item in signals]) for end in ("low", "high"))
    hold = np.concatenate([np.ravel(where.inputs[item.name]) for item in signals])
    reach = np.abs(K).sum(axis=1) + np.abs(Gamma).sum(axis=1)
    room = np.maximum(np.minimum(high - hold, hold - low), 0.0)
    factor = min(1.0, 0.2 * float(np.min(room / np.maximum(reach, 1e-300), initial=math.inf)))
    retract = ca.Function(
        "retract", [plant.x, error := ca.SX.sym("error", plant.error_size)], [plant.retract(plant.x, error)]
    )

    def calls(rng: Any, steps: int) -> Iterator[tuple[str, dict[str, Any]]]:
        yield "init", {}
        for _ in range(steps):
            w = factor * np.clip(rng.normal(size=Pi.shape[1]), -3, 3)
            away = factor * np.clip(rng.normal(size=len(Pi)), -3, 3)
            x = np.asarray(retract(where.x, Pi @ w + away), dtype=float).ravel()
            inputs: dict[str, Any] = {}
            for state in plant.states:
                inputs[state.signal.name] = np.clip(x[state.at], state.signal.low, state.signal.high)
            start = 0
            for symbol in generated:
                inputs[symbol.signal.name] = w[start : start + symbol.signal.size]
                start += symbol.signal.size
            yield "step", inputs

    return calls


def _design(block: Block, gain: Gain | Any, solution: RegulatorSolution, places: tuple[Places, Places]) -> Design:
    """Return the record of Pi, Gamma and (of a Gain) K."""
    designed = isinstance(gain, Gain)
    first: dict[str, Any] = {**solution.rounded(), **({"gain": gain.rounded()} if designed else {})}
    source = solution.source() + (gain.source() if designed else "")
    order = [k for _, columns in signal_groups(solution.exosystem) for k in columns]

    def rebuild(values: dict[str, Any]) -> Block:
        given = {what: np.asarray(values[what], dtype=float) for what in first}
        for what, matrix in given.items():
            if matrix.shape != first[what].shape or not np.all(np.isfinite(matrix)):
                raise ModelError(
                    f"{block.name}: {what} of design.json has shape {matrix.shape}; give {first[what].shape[0]} x "
                    f"{first[what].shape[1]} finite numbers, or export with --redesign"
                )
        numbers = {"gain": given["gain"].ravel()} if designed else {}
        for what, own in zip(("state_map", "input_map"), places, strict=True):
            matrix = given[what][:, order]
            kept = np.array([matrix[i, j] for i, j in own])
            rest = matrix.copy()
            for i, j in own:
                rest[i, j] = 0.0
            if float(np.max(np.abs(rest), initial=0.0)) > 1e-9 * max(1.0, float(np.max(np.abs(matrix), initial=0.0))):
                raise ModelError(
                    f"{block.name}: {what} of design.json has other zeros than the model; export with --redesign"
                )
            numbers[what] = kept
        made = copy.copy(block)
        made.param_signals = [
            replace(signal, default=tuple(float(item) for item in numbers[signal.name]))
            if signal.name in numbers
            else signal
            for signal in block.param_signals
        ]
        made.design = Design({**values}, source, rebuild, properties)
        return made

    def properties(values: dict[str, Any]) -> dict[str, tuple[float, float]]:
        return {**solution.properties(values), **(gain.properties(values["gain"]) if designed else {})}

    return Design(first, source, rebuild, properties)
