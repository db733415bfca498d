"""The law of a regulator that follows the parameters of its plant: u*, Pi and Gamma are computed where it starts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from ..reference.controllers import Range
from ..reference.regulation import RegulatorFeedback, RetunedRegulator
from .analysis import OperatingPoint, linearise
from .block import Block, Scenario
from .controllers import gain_range
from .design import Gain
from .discretisation import increment
from .errors import ModelError
from .expressions import numpy_callable
from .feedback_law import (
    FeedbackLaw,
    Places,
    columns_of,
    elements_of,
    linear_aim,
    read_generators,
    told_places,
)
from .output_regulator import _acting
from .parametric_regulator import ParametricRegulator
from .plant import Plant, Symbol
from .program import AllOf, Compare, Element, Entry, Evaluate, Place, Refuse, Statement, Within
from .regulator_equations import closed_loop, regulated, worst_share
from .signals import Signal, Status

Array = NDArray[Any]

LEAST_PIVOT = 0.01
"""A pivot below this share of its nominal value refuses the parameters (BAD_PARAM)."""

LARGEST_RESIDUAL = 1.0e-3
"""Rates that Newton's steps may leave of an equilibrium; beyond, the parameters are refused (BAD_PARAM)."""


SAME_PLANT = 1.0e-6
"""What expressions of another plant's equations may leave of this one's, of their terms."""


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
        If the plant has no parameters, shapes do not match, or the regulator is that of another plant.
    """
    name = name or f"{plant.name}_feedback"
    if not plant.parameters:
        raise ModelError(f"{name}: the plant {plant.name!r} has no parameters to follow; use regulator_feedback")
    regulator = _of_plant(name, plant, regulator)
    solution = regulator.nominal
    law = FeedbackLaw(plant, tuple(_acting(plant, solution)), saturate)
    K = law.checked(name, gain)
    rate = plant.dt if isinstance(plant.dt, float) else dt or solution.exosystem.dt
    model = solution.model
    closed_loop(
        model.sampled(rate) if model.dt is None and rate is not None else model, K, accept_unstable=accept_unstable
    )
    block = Block(name, doc=doc or "u = u*(p) + Gamma(p) w - K (x - x* - Pi(p) w)")
    order = columns_of(solution.exosystem)
    maps = {"state_map": regulator.state_map[:, order], "input_map": regulator.input_map[:, order]}
    places = {what: _places(matrix) for what, matrix in maps.items()}
    taken, generated = law.read_states(block), read_generators(block, solution.exosystem)
    for symbol in plant.parameters:
        block.param_signals.append(symbol.signal)
    stored = _declare_memory(block, regulator, places, law)
    block.entries["init"] = _init(block, plant, regulator, maps, places, _held(regulator, law))
    # x* is folded: u*(p) is that of this set point, and of no other
    at = _set_point(regulator)
    states = {state.signal.name: ca.SX(ca.DM(at[state.at])) for state in plant.states}
    aim = linear_aim(law, states, _by_signal(law.acting, ca.SX(stored["hold"])), generated, stored, places)
    meaning = "The command for a state of the plant and of the exosystem."
    law.step(block, [*taken.values(), *generated], taken, ca.SX(ca.sparsify(ca.DM(K))), aim, meaning)
    block.sample_time = rate
    block.source_hash = plant.fingerprint() + repr((K.tolist(), at.tolist()))
    block.oracle = _oracle(block, law, regulator, K, places, generated)
    block.scenario = _scenario(law, regulator, K, places, generated)
    return block


def _of_plant(owner: str, plant: Plant, regulator: ParametricRegulator) -> ParametricRegulator:
    """Return expressions in the parameters of this plant, which may be the same one made again; refuse another."""
    theirs = regulator.point.plant
    if _names(plant) != _names(theirs) or plant.p.numel() != theirs.p.numel():
        raise ModelError(
            f"{owner}: the regulator equations were solved for a plant with states, inputs and parameters "
            f"{', '.join(_names(theirs))}, and {plant.name!r} has {', '.join(_names(plant))}; solve them for this plant"
        )
    names = ("inputs", "state_map", "input_map", "pivots", "residual")
    moved: dict[str, Any] = {
        name: ca.substitute(getattr(regulator, name), regulator.parameters, plant.p) for name in names
    }
    made = replace(regulator, parameters=plant.p, **moved)
    _check_plant(owner, plant, made)
    return made


def _check_plant(owner: str, plant: Plant, regulator: ParametricRegulator) -> None:
    """Refuse expressions that do not solve the regulator equations of this plant, at the nominal parameters and near them."""
    own = plant
    if regulator.nominal.model.dt is None and plant.discretisation is not None:  # maps of the continuous plant
        own = plant.discretisation.continuous
    low, high = (np.concatenate([getattr(item.signal, end) for item in own.parameters]) for end in ("low", "high"))
    for factor in (1.0, 1.01):
        p = np.clip(factor * regulator.point.p, low, high)
        share, what = _left(own, regulator, p)
        if not share <= SAME_PLANT:
            raise ModelError(
                f"{owner}: the regulator equations were solved for another plant than {plant.name!r} (what they give leaves "
                f"{share:.3g} of its terms in {what}); solve them for this plant"
            )


def _names(plant: Plant) -> list[str]:
    return [state.signal.name for state in plant.states] + [
        symbol.signal.name for symbol in (*plant.inputs, *plant.parameters)
    ]


def _left(plant: Plant, regulator: ParametricRegulator, p: Array) -> tuple[float, str]:
    """Return what u*(p), Pi(p) and Gamma(p) leave of a plant's equations, of their terms, and of which."""
    found = regulator.at(p)
    values: dict[str, Any] = {}
    groups = [[state.signal for state in plant.states]]
    groups += [[symbol.signal for symbol in group] for group in (plant.inputs, plant.parameters)]
    for signals, vector in zip(groups, (found["states"], found["inputs"], p), strict=True):
        start = 0
        for signal in signals:
            within = np.clip(np.ravel(vector)[start : start + signal.size], signal.low, signal.high)
            values[signal.name], start = within, start + signal.size
    at = OperatingPoint.at(plant, values)
    source = linearise(plant.discretisation.continuous if plant.discretisation else plant, at)
    terms = np.abs(source.A) @ np.abs(at.x) + np.abs(source.B) @ np.abs(at.u)
    held = float(np.max(np.abs(at.residual) / np.maximum(terms, 1e-3), initial=0.0))
    view, Q, P = regulated(linearise(plant, at), regulator.nominal.exosystem)
    S = regulator.nominal.exosystem.matrix
    solved = worst_share(view, S, Q, P, found["state_map"], found["input_map"])
    return max((held, "the equations of the set point"), (solved, "the regulator equations"))


def _set_point(regulator: ParametricRegulator) -> Array:
    return np.asarray(ca.DM(regulator.states), dtype=float).ravel()


def _by_signal(signals: Sequence[Signal], vector: ca.SX) -> dict[str, ca.SX]:
    """Return the pieces of a vector by the names of signals."""
    starts = np.cumsum([0, *[item.size for item in signals]]).tolist()
    return {item.name: vector[start : start + item.size] for item, start in zip(signals, starts, strict=False)}


def _places(matrix: ca.SX) -> Places:
    pattern = matrix.sparsity()
    return tuple(sorted(zip(pattern.row(), pattern.get_col(), strict=True)))


def _held(regulator: ParametricRegulator, law: FeedbackLaw) -> ca.SX:
    """Return u*(p) of the acting inputs."""
    whole = _by_signal([symbol.signal for symbol in law.plant.inputs], regulator.inputs)
    return ca.vertcat(*[whole[item.name] for item in law.acting])


def _declare_memory(
    block: Block, regulator: ParametricRegulator, places: dict[str, Places], law: FeedbackLaw
) -> dict[str, Symbol]:
    """Declare what `init` computes: u* and the elements of the maps."""
    low, high = (tuple(item for signal in law.acting for item in getattr(signal, end)) for end in ("low", "high"))
    told = ", ".join(signal.name for signal in law.acting)
    fields = [Signal("hold", len(low), "", low, high, f"what holds the set point: {told}")]
    found = regulator.at(_defaults(law.plant))
    for what, own in places.items():
        if own:
            size, reach = len(own), gain_range(found[what])[1]
            fields.append(Signal(what, size, "", (-reach,) * size, (reach,) * size, told_places(what, own)))
    block.memory_signals += fields
    return {signal.name: block._own(signal) for signal in fields}


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
    law: FeedbackLaw,
    regulator: ParametricRegulator,
    K: Array,
    places: dict[str, Places],
    generated: list[Symbol],
) -> RetunedRegulator:
    """Return the oracle: f and h lowered to NumPy, the set point, and the exosystem."""
    plant, solution = law.plant, regulator.nominal
    x, u, p = plant.x, plant.u, plant.p
    if plant.discretisation is not None:
        following = plant.x + increment(plant)
    else:
        following = plant.without_noise(plant.folded(plant.dynamics_expression()))
    rows = {sensor.signal.name: plant.without_noise(plant.folded(sensor.expression)) for sensor in plant.sensors}
    rows |= {state.signal.name: ca.SX(state.symbol) for state in plant.states if state.signal.name not in rows}
    outputs = ca.vertcat(*[rows[name] for name in solution.model.outputs])
    judged = ca.vertcat(regulator.pivots, regulator.residual)
    order = columns_of(solution.exosystem)
    S = solution.exosystem.matrix[np.ix_(order, order)]
    picked = {
        kind: solution.exosystem.output[[solution.exosystem.signals.index(name) for name in names]][:, order]
        for kind, names in (("out", solution.model.outputs), ("dis", solution.model.disturbances))
    }
    at = _set_point(regulator)
    names = [symbol.signal.name for symbol in plant.inputs for _ in range(symbol.signal.size)]
    away = {*solution.model.disturbances}
    nominal_u = np.asarray(ca.Function("u", [p], [ca.densify(regulator.inputs)])(_defaults(plant)), dtype=float).ravel()

    def of(signal: Signal) -> Range:
        return Range(signal.name, signal.low, signal.high)

    formula = RegulatorFeedback(
        law.kinds,
        law.ends,
        tuple(symbol.signal.name for symbol in generated),
        places["state_map"],
        places["input_map"],
        law.saturate,
        {"gain": K.ravel(), **{state.signal.name: at[state.at] for state in plant.states}},
    )
    return RetunedRegulator(
        law=formula,
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
        outputs_in=tuple(of(signal) for signal in law.acting),
    )


def _scenario(
    law: FeedbackLaw, regulator: ParametricRegulator, K: Array, places: dict[str, Places], generated: list[Symbol]
) -> Scenario:
    """Return calls near where the plant should be at the nominal parameters, and memories near the nominal one."""
    order, found = columns_of(regulator.nominal.exosystem), regulator.at(_defaults(law.plant))
    held = ca.Function("hold", [law.plant.p], [ca.densify(_held(regulator, law))])
    numbers = {"hold": np.asarray(held(_defaults(law.plant)), dtype=float).ravel()}
    for what, own in places.items():
        numbers[what] = elements_of(found[what][:, order], own)

    def memory(rng: Any) -> dict[str, Any]:
        return {name: item * rng.uniform(0.9, 1.1, len(item)) for name, item in numbers.items() if len(item)}

    Pi, Gamma = found["state_map"][:, order], found["input_map"][:, order]
    return Scenario(law.near(_set_point(regulator), numbers["hold"], K, Pi, Gamma, generated), memory)
