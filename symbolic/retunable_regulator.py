"""The law of a regulator that follows the parameters of its plant: u*, Pi and Gamma are computed where it starts."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from ..reference.controllers import Range
from ..reference.regulation import RegulatorFeedback, RetunedRegulator
from .block import Block, Scenario
from .components import matrix_of
from .controllers import deviation_from
from .design import Gain
from .discretisation import increment
from .errors import ModelError
from .expressions import numpy_callable
from .output_regulator import Places, _acting, _reach
from .parametric_regulator import ParametricRegulator
from .plant import Plant, Symbol
from .program import AllOf, Compare, Element, Entry, Evaluate, Place, Refuse, Statement, Within
from .regulator_equations import closed_loop
from .signal_generators import signal_groups
from .signals import WIDE, Signal, Status

Array = NDArray[Any]

LEAST_PIVOT = 0.01
"""A pivot below this share of its nominal value refuses the parameters (BAD_PARAM)."""

LARGEST_RESIDUAL = 1.0e-3
"""Rates that Newton's steps may leave of an equilibrium; beyond, the parameters are refused (BAD_PARAM)."""


def retunable_feedback(
    plant: Plant,
    gain: Gain | Any,
    regulator: ParametricRegulator,
    *,
    saturate: bool = False,
    accept_unstable: bool = False,
    name: str = "",
    doc: str = "",
    dt: float | None = None,
) -> Block:
    """Return the law u = u*(p) + Gamma(p) w - K (x - x* - Pi(p) w), p being run-time parameters.

    Parameters
    ----------
    plant : Plant
        What is controlled; its parameters become those of the block. The set point x* is folded into the C, since u*(p) holds
        that one and no other: a set point that moves is a reference of the exosystem.
    gain : Gain, or (acting inputs, n) array
        K, folded into the C; A - B K has to be stable at the nominal parameters. It does not follow the parameters.
    regulator : ParametricRegulator
        Of `parametric_francis`.
    saturate, accept_unstable, name, doc
        As for `output_regulator`.
    dt : float, optional
        Seconds between steps, of a continuous plant.

    Returns
    -------
    Block
        `init` computes u*, Pi and Gamma into the memory, and refuses parameters (BAD_PARAM) at which a pivot of the elimination
        is below 0.01 of its nominal value; call it again after a change of parameters. `step` as `regulator_feedback`.

    Raises
    ------
    RegulatorError
        If the gain does not stabilise the plant.
    ModelError
        If the plant has no parameters, or shapes do not match.
    """
    name, solution = name or f"{plant.name}_feedback", regulator.nominal
    if not plant.parameters:
        raise ModelError(f"{name}: the plant {plant.name!r} has no parameters to follow; use regulator_feedback")
    acting = _acting(plant, solution)
    K = gain.rounded() if isinstance(gain, Gain) else matrix_of(name, "gain", gain)
    shape = (sum(item.size for item in acting), plant.error_size)
    if K.shape != shape:
        raise ModelError(f"{name}: the gain has shape {K.shape}; give {shape[0]} x {shape[1]}")
    rate = plant.dt if isinstance(plant.dt, float) else dt or solution.exosystem.dt
    model = solution.model
    closed_loop(
        model.sampled(rate) if model.dt is None and rate is not None else model, K, accept_unstable=accept_unstable
    )
    block = Block(name, doc=doc or "u = u*(p) + Gamma(p) w - K (x - x* - Pi(p) w)")
    order = [k for _, columns in signal_groups(solution.exosystem) for k in columns]
    maps = {"state_map": regulator.state_map[:, order], "input_map": regulator.input_map[:, order]}
    places = {what: _places(matrix) for what, matrix in maps.items()}
    taken, generated, stored = _declare(block, plant, regulator, places, acting)
    hold = _held(plant, regulator, acting)
    init = _init(block, plant, regulator, maps, places, hold)
    # x* is folded: u*(p) is that of this set point, and of no other
    at = np.asarray(ca.DM(regulator.states), dtype=float).ravel()
    set_point: dict[str, Any] = {state.signal.name: ca.SX(ca.DM(at[state.at])) for state in plant.states}
    w, n = ca.vertcat(ca.SX(0, 1), *generated), plant.error_size
    filled = {}
    for what, rows in (("state_map", n), ("input_map", shape[0])):
        filled[what] = ca.SX(rows, w.numel())
        for k, (i, j) in enumerate(places[what]):
            filled[what][i, j] = ca.SX(stored[what])[k]
    change = filled["input_map"] @ w - ca.SX(ca.sparsify(ca.DM(K))) @ (
        deviation_from(plant, taken, set_point) - filled["state_map"] @ w
    )
    outputs, start = {}, 0
    for signal in acting:
        outputs[signal.name] = ca.SX(stored["hold"])[start : start + signal.size] + change[start : start + signal.size]
        start += signal.size
    block.entries["init"] = init
    block.entry(
        "step",
        inputs=[*taken.values(), *generated],
        outputs=outputs,
        output_units={item.name: item.unit for item in acting},
        output_ranges={item.name: (item.low, item.high) for item in acting},
        limits={item.name: (item.low, item.high) for item in acting} if saturate else {},
        doc="The command for a state of the plant and of the exosystem.",
    )
    block.sample_time = rate
    block.source_hash = plant.fingerprint() + repr((K.tolist(), at.tolist()))
    block.oracle = _oracle(block, plant, regulator, K, places, acting, generated, saturate)
    block.scenario = _scenario(plant, regulator, K, places, acting, generated)
    return block


def _places(matrix: ca.SX) -> Places:
    pattern = matrix.sparsity()
    return tuple(sorted(zip(pattern.row(), pattern.get_col(), strict=True)))


def _held(plant: Plant, regulator: ParametricRegulator, acting: list[Signal]) -> ca.SX:
    """Return u*(p) of the acting inputs."""
    names, pieces, start = {item.name for item in acting}, [], 0
    for symbol in plant.inputs:
        size = symbol.signal.size
        if symbol.signal.name in names:
            pieces.append(regulator.inputs[start : start + size])
        start += size
    return ca.vertcat(*pieces)


def _declare(
    block: Block, plant: Plant, regulator: ParametricRegulator, places: dict[str, Places], acting: list[Signal]
) -> tuple[dict[str, Symbol], list[Symbol], dict[str, Symbol]]:
    """Declare inputs, parameters and memory; return states, w, and what is stored."""
    taken = {}
    for state in plant.states:
        signal = state.signal
        ends = (signal.low, signal.high)
        taken[signal.name] = block.input(signal.name, size=signal.size, unit=signal.unit, range=ends, doc=signal.doc)
    generated = [
        block.input(f"w_{signal}", size=len(columns), doc=f"state of the generator of {signal}")
        for signal, columns in signal_groups(regulator.nominal.exosystem)
    ]
    for symbol in plant.parameters:
        block.param_signals.append(symbol.signal)
    low, high = (tuple(item for signal in acting for item in getattr(signal, end)) for end in ("low", "high"))
    told = ", ".join(signal.name for signal in acting)
    fields = [Signal("hold", len(low), "", low, high, f"what holds the set point: {told}")]
    found = regulator.at(_defaults(plant))
    for what, letter in (("state_map", "Pi"), ("input_map", "Gamma")):
        own = places[what]
        if own:
            reach = _reach(found[what])[1]
            listed = " ".join(f"({i} {j})" for i, j in own)
            size = len(own)
            fields.append(Signal(what, size, "", (-reach,) * size, (reach,) * size, f"{letter}, its elements {listed}"))
    block.memory_signals += fields
    return taken, generated, {signal.name: block._own(signal) for signal in fields}


def _defaults(plant: Plant) -> Array:
    return np.array([item for symbol in plant.parameters for item in symbol.signal.default or ()])


def _init(
    block: Block,
    plant: Plant,
    regulator: ParametricRegulator,
    maps: dict[str, ca.SX],
    places: dict[str, Places],
    hold: ca.SX,
) -> Entry:
    """Return `init`: it solves the equations, and judges the pivots."""
    outputs: list[tuple[str, ca.SX, Place]] = [("hold", hold, Place("next", "hold"))]
    for what, own in places.items():
        if own:
            outputs.append((what, ca.vertcat(*[maps[what][i, j] for i, j in own]), Place("next", what)))
    body: list[Statement] = []
    count = regulator.pivots.numel()
    if count:
        outputs.append(("pivot", regulator.pivots, Place("local", "pivot")))
    if regulator.residual.numel():
        outputs.append(("residual", regulator.residual, Place("local", "residual")))
    function = ca.Function(
        f"{block.name}_solve",
        [ca.SX(symbol) for symbol in plant.parameters],
        [ca.densify(item) for _, item, _ in outputs],
    )
    reads = tuple(((Place("param", symbol.signal.name), symbol.signal.size),) for symbol in plant.parameters)
    body.append(
        Evaluate(
            function,
            reads,
            tuple(((place, item.numel()),) for _, item, place in outputs),
            tuple(tuple(f"{what}_{k}" for k in range(item.numel())) for what, item, _ in outputs),
            ("u*, Pi and Gamma from the parameters, by elimination in a fixed order",),
        )
    )
    if count:
        least = tuple(Compare(Element(Place("local", "pivot"), k), ">=", LEAST_PIVOT) for k in range(count))
        body.append(Refuse(Status.BAD_PARAM, AllOf(least)))
    if regulator.residual.numel():
        ends = (LARGEST_RESIDUAL,) * regulator.residual.numel()
        body.append(Refuse(Status.BAD_PARAM, Within(Place("local", "residual"), tuple(-item for item in ends), ends)))
    body.append(Refuse(Status.OVERFLOW, block.judge_memory([signal.name for signal in block.memory_signals])))
    doc = "Solve the regulator equations for the parameters; every parameter is checked here."
    return Entry("init", (), (), tuple(body), doc, checks_params=True)


def _oracle(
    block: Block,
    plant: Plant,
    regulator: ParametricRegulator,
    K: Array,
    places: dict[str, Places],
    acting: list[Signal],
    generated: list[Symbol],
    saturate: bool,
) -> RetunedRegulator:
    """Return the oracle: f and h lowered to NumPy, the set point, and the exosystem."""
    solution, x, u, p = regulator.nominal, plant.x, plant.u, plant.p
    if plant.discretisation is not None:
        following = plant.x + increment(plant)
    else:
        following = plant.without_noise(plant.folded(plant.dynamics_expression()))
    rows = {sensor.signal.name: plant.without_noise(plant.folded(sensor.expression)) for sensor in plant.sensors}
    rows |= {state.signal.name: ca.SX(state.symbol) for state in plant.states if state.signal.name not in rows}
    outputs = ca.vertcat(*[rows[name] for name in solution.model.outputs])
    judged = ca.vertcat(regulator.pivots, regulator.residual)
    order = [k for _, columns in signal_groups(solution.exosystem) for k in columns]
    S = solution.exosystem.matrix[np.ix_(order, order)]
    picked = {
        kind: solution.exosystem.output[[solution.exosystem.signals.index(name) for name in names]][:, order]
        for kind, names in (("out", solution.model.outputs), ("dis", solution.model.disturbances))
    }
    at = np.asarray(ca.DM(regulator.states), dtype=float).ravel()
    names = [symbol.signal.name for symbol in plant.inputs for _ in range(symbol.signal.size)]
    away = {*solution.model.disturbances}
    nominal_u = np.asarray(ca.Function("u", [p], [ca.densify(regulator.inputs)])(_defaults(plant)), dtype=float).ravel()

    def of(signal: Signal) -> Range:
        return Range(signal.name, signal.low, signal.high)

    kinds = tuple((state.signal.name, "angle" if state.signal.angle else "plain") for state in plant.states)
    law = RegulatorFeedback(
        kinds,
        tuple((item.name, item.size, np.array(item.low), np.array(item.high)) for item in acting),
        tuple(symbol.signal.name for symbol in generated),
        places["state_map"],
        places["input_map"],
        saturate,
        {"gain": K.ravel(), **{state.signal.name: at[state.at] for state in plant.states}},
    )
    return RetunedRegulator(
        law=law,
        step=numpy_callable(ca.Function("step", [x, u, p], [ca.densify(following)])),
        discrete=plant.is_discrete,
        outputs=numpy_callable(ca.Function("outputs", [x, u, p], [ca.densify(outputs)])),
        pivots=numpy_callable(ca.Function("pivots", [p], [ca.densify(judged)])),
        x=at,
        u=nominal_u,
        acting=tuple(k for k, name in enumerate(names) if name not in away),
        away=tuple(k for k, name in enumerate(names) if name in away),
        generator=(S, picked["out"], picked["dis"]),
        plant_params=tuple(symbol.signal.name for symbol in plant.parameters),
        limits=(LEAST_PIVOT, LARGEST_RESIDUAL, regulator.pivots.numel()),
        memory=tuple(of(signal) for signal in block.memory_signals),
        params=tuple(of(signal) for signal in block.param_signals),
        inputs=tuple(of(signal) for signal in block.entries["step"].inputs),
        outputs_in=tuple(of(signal) for signal in acting),
    )


def _scenario(
    plant: Plant,
    regulator: ParametricRegulator,
    K: Array,
    places: dict[str, Places],
    acting: list[Signal],
    generated: list[Symbol],
) -> Scenario:
    """Return calls so near the set point that commands stay within their ranges, and memories near the nominal one."""
    order = [k for _, columns in signal_groups(regulator.nominal.exosystem) for k in columns]
    found = regulator.at(_defaults(plant))
    numbers = {"hold": _numbers(plant, regulator, acting)}
    for what, own in places.items():
        matrix = found[what][:, order]
        numbers[what] = np.array([matrix[i, j] for i, j in own])
    at = np.asarray(ca.DM(regulator.states), dtype=float).ravel()
    low, high = (np.concatenate([getattr(item, end) for item in acting]) for end in ("low", "high"))
    room = np.minimum(high - numbers["hold"], numbers["hold"] - low)
    size = np.abs(K).sum(axis=1) * (1 + np.abs(found["state_map"]).sum(axis=1).max()) + np.abs(found["input_map"]).sum(
        axis=1
    )
    factor = float(min(1.0, 0.2 * np.min(room / np.maximum(size, 1e-300))))

    def calls(rng: Any, steps: int) -> Iterator[tuple[str, dict[str, Any]]]:
        yield "init", {}
        for _ in range(steps):
            inputs: dict[str, Any] = {}
            for state in plant.states:
                value = at[state.at] + factor * np.clip(rng.normal(size=state.signal.size), -3, 3)
                inputs[state.signal.name] = np.clip(value, state.signal.low, state.signal.high)
            for symbol in generated:
                wide = factor * np.clip(rng.normal(size=symbol.signal.size), -3, 3)
                inputs[symbol.signal.name] = np.clip(wide, -WIDE, WIDE)
            yield "step", inputs

    def memory(rng: Any) -> dict[str, Any]:
        return {name: item * rng.uniform(0.9, 1.1, len(item)) for name, item in numbers.items() if len(item)}

    return Scenario(calls, memory)


def _numbers(plant: Plant, regulator: ParametricRegulator, acting: list[Signal]) -> Array:
    held = ca.Function("hold", [plant.p], [ca.densify(_held(plant, regulator, acting))])
    return np.asarray(held(_defaults(plant)), dtype=float).ravel()
