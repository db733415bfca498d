"""The output regulator as one Block: a signal generator that is observed, and the law that follows it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from ..reference.regulation import RegulatorFeedback
from .analysis import OperatingPoint, linearise
from .block import Block, Design
from .components import Calls, finish
from .composition import Delay, connect, wires
from .controllers import gain_range
from .design import Gain
from .errors import ModelError
from .exosystems import Exosystem, time_text
from .feedback_law import (
    FeedbackLaw,
    Places,
    columns_of,
    elements_of,
    linear_aim,
    read_generators,
    told_places,
)
from .origins import place_of_call
from .parametric_regulator import ParametricRegulator
from .plant import Plant, Symbol
from .regulator_equations import LinearModel, RegulatorSolution, closed_loop, model_of, regulated
from .signal_generators import observed_exosystem, signal_groups
from .signals import Signal

Array = NDArray[Any]

MAPS = ("state_map", "input_map")

SAME_MODEL = 1.0e-6
"""Share of its largest element by which a matrix of the regulator equations may differ from that of the plant."""


def output_regulator(
    plant: Plant,
    point: Mapping[Any, Any],
    gain: Gain | Any,
    solution: RegulatorSolution | ParametricRegulator,
    generator: Block | Mapping[str, Block],
    *,
    estimator: Block | None = None,
    saturate: bool = False,
    tunable: bool = True,
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
        x* and u*, where the plant was linearised; of a `ParametricRegulator` x* has to be that of its equations.
    gain : Gain, or (acting inputs, n) array
        K; A - B K has to be stable.
    solution : RegulatorSolution or ParametricRegulator
        Of `francis`: Pi and Gamma; or of `parametric_francis`, with which `init` computes them, and u*, from the parameters of
        the plant (K is then folded into the C; see `retunable_feedback`). Measured disturbances are in it; they are inputs of
        the plant that do not act.
    generator : Block, or dict
        Of `kalman_exosystem` or `high_gain_exosystem`: the observer of w, one vector ``w_<signal>`` for each signal. Or signal
        -> an observer of that signal alone; signals of one kind may have the very same Block, which then is in the C once. It
        has to be an observer of the exosystem of the solution (of another Block only the time step is known).
    estimator : Block, optional
        An estimator of the plant's own state, such as `extended_kalman_filter` of it. Without one the states are inputs.
    saturate : bool
        Whether u is held within the ranges of the plant's inputs (status CLAMPED); else such a call is refused.
    tunable : bool
        Whether K, Pi and Gamma are run-time parameters; else they are folded into the C, which is smaller.
    accept_unstable : bool
        Whether a gain that does not stabilise is accepted.
    name, doc : str
        Name of the block, default ``<plant>_regulator``, and its meaning.

    Returns
    -------
    Block
        Parts "generator" (or ``generator_<signal>``), "estimator" (if given) and "feedback". Pi, Gamma and K go through
        `design.json` (K if it is that of a `Gain`); they are run-time parameters, the maps by their elements that are not zero,
        unless `tunable` is false.

    Raises
    ------
    RegulatorError
        If the gain does not stabilise the plant, linearised at the point, at the rate at which the law runs.
    ModelError
        If shapes or names do not match, the time bases differ, the generator observes another exosystem, or the solution is
        that of another plant or point.
    """
    name = name or f"{plant.name}_regulator"
    nominal = _nominal(name, solution, generator)
    parts, joined = _generators(name, generator, nominal)
    rate = _common_rate(name, plant, nominal, parts)
    options: dict[str, Any] = {
        "saturate": saturate, "accept_unstable": accept_unstable, "name": f"{plant.name}_feedback", "dt": rate,
    }  # fmt: skip
    if isinstance(solution, ParametricRegulator):
        feedback = _retunable(name, plant, point, gain, solution, options)
    else:
        feedback = regulator_feedback(plant, point, gain, solution, tunable=tunable, **options)
    if estimator is not None:
        where = solution.point if isinstance(solution, ParametricRegulator) else OperatingPoint.at(plant, point)
        parts["estimator"] = estimator
        joined |= wires("estimator", "feedback", plant.states)
        acting = [item.name for item in _acting(plant, nominal)]
        joined |= wires("feedback", "estimator", acting, initial={item: where.inputs[item] for item in acting})
    parts["feedback"] = feedback
    text = doc or f'output regulator of the plant "{plant.name}": follows {", ".join(nominal.model.outputs)}'
    return connect(parts, joined, name, settled=True, doc=text)


def _retunable(
    owner: str,
    plant: Plant,
    point: Mapping[Any, Any],
    gain: Any,
    solution: ParametricRegulator,
    options: dict[str, Any],
) -> Block:
    """Return the law that follows the parameters, at the set point of its equations."""
    from .retunable_regulator import retunable_feedback

    _check_set_point(owner, plant, point, solution)
    return retunable_feedback(plant, gain, solution, **options)


def _nominal(owner: str, solution: Any, generator: Any) -> RegulatorSolution:
    """Return the numeric solution; refuse what stands in the wrong place."""
    hints = {
        "solution": "francis(linearise(plant, point), exosystem)",
        "generator": "an observer of the exosystem, kalman_exosystem(exosystem, ...) or high_gain_exosystem(...)",
    }
    nominal = solution.nominal if isinstance(solution, ParametricRegulator) else solution
    observers = list(generator.values()) if isinstance(generator, Mapping) else [generator]
    for what, items, kind in (("solution", [nominal], RegulatorSolution), ("generator", observers, Block)):
        for item in items:
            if not isinstance(item, kind):
                raise ModelError(f"{owner}: the {what} is of type {type(item).__name__}; give {hints[what]}")
    assert isinstance(nominal, RegulatorSolution)
    return nominal


def _check_set_point(owner: str, plant: Plant, point: Mapping[Any, Any], solution: ParametricRegulator) -> None:
    """Refuse a set point that is not the one that u*(p) holds."""
    mine, theirs = OperatingPoint.at(plant, point).states, solution.point.states
    for name, value in mine.items():
        if name in theirs and not np.allclose(value, theirs[name], rtol=1e-9, atol=1e-12):
            raise ModelError(
                f"{owner}: the point has {name} = {value}, and the regulator equations were solved for the set point {theirs[name]}"
                "; give the point that parametric_francis was given"
            )


def _generators(
    name: str, generator: Block | Mapping[str, Block], solution: RegulatorSolution
) -> tuple[dict[str, Block], dict[str, str | Delay]]:
    """Return the parts that observe w, and the wires from them to the law."""
    signals = [signal for signal, _ in signal_groups(solution.exosystem)]
    if isinstance(generator, Block):
        _check_observer(name, "the generator", generator, solution.exosystem, list(solution.exosystem.signals))
        return {"generator": generator}, {f"feedback.w_{signal}": f"generator.w_{signal}" for signal in signals}
    if sorted(generator) != sorted(signals):
        raise ModelError(
            f"{name}: generators are given for {', '.join(generator) or 'nothing'}; give one for each of {', '.join(signals)}"
        )
    joined: dict[str, str | Delay] = {}
    for signal in signals:
        block = generator[signal]
        found = [
            item.name for item in (*block.memory_signals, *block.entries["step"].outputs) if item.name.startswith("w_")
        ]
        if len(found) != 1:
            raise ModelError(
                f"{name}: the generator of {signal!r} observes {', '.join(found) or 'nothing'}; give it one signal"
            )
        _check_observer(name, f"the generator of {signal!r}", block, solution.exosystem, [signal])
        joined[f"feedback.w_{signal}"] = f"generator_{signal}.{found[0]}"
    return {f"generator_{signal}": generator[signal] for signal in signals}, joined


def _check_observer(owner: str, what: str, block: Block, exosystem: Exosystem, signals: list[str]) -> None:
    """Refuse an observer of something else than the exosystem, or this signal of it, for which the maps are."""
    observed = observed_exosystem(block)
    dt = block.sample_time if observed is None else observed.dt
    if exosystem.dt is not None and dt is not None and dt != exosystem.dt:
        raise ModelError(
            f"{owner}: {what} is {time_text(dt)}, and the regulator equations were solved for an exosystem that is "
            f"{time_text(exosystem.dt)}; sample both with one dt"
        )
    if observed is None:
        return
    if exosystem.dt is None and observed.dt is not None:  # maps of the continuous plant, held over a step
        exosystem = exosystem.sampled(observed.dt, observed.method or "exact")
    theirs = list(observed.signals) if len(signals) == 1 else signals
    missing = sorted(set(theirs) - set(observed.signals))
    if missing:
        raise ModelError(
            f"{owner}: {what} does not observe {', '.join(missing)}; give an observer of the whole exosystem"
        )
    found, wanted = _seen(observed, theirs), _seen(exosystem, signals)
    if found is None or wanted is None or not all(_alike(a, b) for a, b in zip(found, wanted, strict=True)):
        raise ModelError(
            f"{owner}: {what} observes another exosystem (S or Q differ, {observed.kind} {observed.method}) than that of the "
            f"regulator equations ({exosystem.kind} {exosystem.method}); make both from one exosystem, sampled in one way"
        )


def _seen(exosystem: Exosystem, signals: list[str]) -> tuple[Array, Array] | None:
    """Return (S, Q) of some signals, states in the order in which w comes; None if other states act on them."""
    groups = dict(signal_groups(exosystem))
    order = [k for signal in signals for k in groups.get(signal, [])]
    rest = [k for k in range(exosystem.order) if k not in order]
    rows = [exosystem.signals.index(signal) for signal in signals]
    S, Q = exosystem.matrix, exosystem.output
    if np.any(S[np.ix_(order, rest)]) or np.any(Q[np.ix_(rows, rest)]):
        return None
    return S[np.ix_(order, order)], Q[np.ix_(rows, order)]


def _alike(first: Array, second: Array) -> bool:
    """Whether matrices are the same, to the rounding of one exponential or another."""
    if first.shape != second.shape:
        return False
    return np.allclose(first, second, rtol=1e-9, atol=1e-14 * float(np.max(np.abs(first), initial=0.0)))


def _common_rate(owner: str, plant: Plant, solution: RegulatorSolution, parts: Mapping[str, Block]) -> float | None:
    """Return the time step at which the law runs: that of the generators, which has to be that of a discrete plant."""
    rates = {part.sample_time for part in parts.values() if part.sample_time is not None}
    own = plant.dt if isinstance(plant.dt, float) else solution.exosystem.dt
    if len(rates | ({own} if own is not None else set())) > 1:
        told = ", ".join(f"{part} {block.sample_time} s" for part, block in parts.items())
        raise ModelError(
            f"{owner}: the plant {plant.name!r} is {time_text(own)}, and of the generators {told}; sample all with one dt"
        )
    return next(iter(rates), own)


def regulator_feedback(
    plant: Plant,
    point: Mapping[Any, Any],
    gain: Gain | Any,
    solution: RegulatorSolution,
    *,
    saturate: bool = False,
    tunable: bool = True,
    accept_unstable: bool = False,
    name: str = "",
    doc: str = "",
    dt: float | None = None,
) -> Block:
    """Return the law alone: inputs are the states of the plant and ``w_<signal>``, outputs its acting inputs.

    Parameters
    ----------
    plant, point, gain, solution, saturate, tunable, accept_unstable, name, doc
        As for `output_regulator`.
    dt : float, optional
        Seconds between steps where the plant does not have a time step of its own. Default: that of the exosystem, or of a
        Gain.

    Returns
    -------
    Block
        Entries `init` and `step`, no memory.
    """
    name = name or f"{plant.name}_feedback"
    where, law = OperatingPoint.at(plant, point), FeedbackLaw(plant, tuple(_acting(plant, solution)), saturate)
    K = law.checked(name, gain)
    if (len(solution.input_map), len(solution.state_map)) != law.shape:
        raise ModelError(
            f"{name}: Pi has shape {solution.state_map.shape} and Gamma {solution.input_map.shape}, and the plant "
            f"{plant.name!r} {law.shape[1]} states and {law.shape[0]} inputs that act; give the solution for this plant"
        )
    rate = plant.dt if isinstance(plant.dt, float) else dt or solution.exosystem.dt
    if rate is None and isinstance(gain, Gain):
        rate = gain.dt
    _check_model(name, plant, where, solution, rate)
    closed_loop(_running(plant, where, solution, rate), K, accept_unstable=accept_unstable)
    text = doc or "u = u* + Gamma w - K (x - x* - Pi w)"
    made = _Regulator(law, where, solution, tunable, name, text, gain, rate)
    return made.block({"gain": K, **solution.rounded()})


def _near_point(plant: Plant, where: OperatingPoint, rate: float | None) -> LinearModel:
    """Return the plant, linearised at the point."""
    return model_of(linearise(plant, where, dt=rate if isinstance(plant.dt, tuple) else None))


def _running(plant: Plant, where: OperatingPoint, solution: RegulatorSolution, rate: float | None) -> LinearModel:
    """Return the plant as the law meets it, inputs that do not act left out: a continuous one held over a step."""
    acting = _acting_model(plant, _near_point(plant, where, rate), solution)
    return acting.sampled(rate) if acting.dt is None and rate is not None else acting


def _acting_model(plant: Plant, near: LinearModel, solution: RegulatorSolution) -> LinearModel:
    """Return a linearisation without the inputs that do not act."""
    names = {item.name for item in _acting(plant, solution)}
    kept = [symbol.signal.name in names for symbol in plant.inputs for _ in range(symbol.signal.size)]
    labels = tuple(label for label, acts in zip(near.inputs, kept, strict=True) if acts)
    return replace(near, B=near.B[:, kept], D=near.D[:, kept], inputs=labels)


def _check_model(
    owner: str, plant: Plant, where: OperatingPoint, solution: RegulatorSolution, rate: float | None
) -> None:
    """Refuse a solution of the regulator equations of another plant, or of this one at another point."""
    model, near = solution.model, _near_point(plant, where, rate)
    if model.dt is None and near.dt is not None and plant.discretisation is not None:
        near = model_of(linearise(plant.discretisation.continuous, where))
    if model.dt is not None and near.dt is None:
        found = [near.sampled(model.dt, method) for method in ("exact", "euler")]
    else:
        found = [near]
    if found[0].dt != model.dt:
        raise ModelError(
            f"{owner}: the plant {plant.name!r} is {time_text(near.dt)}, and the regulator equations were solved for one that "
            f"is {time_text(model.dt)}; solve them for linearise(plant, point)"
        )
    named = {*near.outputs, *near.states, *near.inputs}.issuperset(solution.exosystem.signals)
    if named:
        views = [regulated(item, solution.exosystem)[0] for item in found]
    else:  # a LinearModel with labels of its own
        views = [_acting_model(plant, item, solution) for item in found]
    share, what = min(_difference(item, model, "ABCDEF" if named else "AB") for item in views)
    if share > SAME_MODEL:
        raise ModelError(
            f"{owner}: the regulator equations were solved for another plant, or at another point ({what} differs by "
            f"{share:.3g} of its largest element from that of {plant.name!r} at the point); solve them for linearise(plant, point)"
        )


def _difference(mine: LinearModel, model: LinearModel, names: str) -> tuple[float, str]:
    """Return (largest difference of a matrix, of its largest element, which one it is)."""
    answer = [(0.0, "A")]
    for what in names:
        first, second = getattr(mine, what), getattr(model, what)
        if first.shape != second.shape:
            return math.inf, what
        size = max(float(np.max(np.abs(item), initial=0.0)) for item in (first, second))
        answer.append((float(np.max(np.abs(first - second), initial=0.0)) / size if size else 0.0, what))
    return max(answer)


@dataclass(frozen=True, eq=False)
class _Regulator:
    """All that a law of linear maps is made of, but for its numbers."""

    law: FeedbackLaw
    where: OperatingPoint
    solution: RegulatorSolution
    tunable: bool
    name: str
    doc: str
    gain: Gain | Any
    rate: float | None

    @property
    def order(self) -> list[int]:
        """Return the columns of Pi and Gamma in the order in which w comes."""
        return columns_of(self.solution.exosystem)

    def places(self) -> dict[str, Places]:
        """Return where the elements of the maps that are not zero stand."""
        maps = self.solution.rounded()
        return {what: tuple((int(i), int(j)) for i, j in np.argwhere(maps[what][:, self.order] != 0)) for what in MAPS}

    def numbers(self, values: Mapping[str, Any]) -> dict[str, Array]:
        """Return K by rows, and the elements of the maps."""
        maps = {what: np.asarray(values[what], dtype=float)[:, self.order] for what in MAPS}
        elements = {what: elements_of(maps[what], own) for what, own in self.places().items()}
        return {"gain": np.asarray(values["gain"], dtype=float).ravel(), **elements}

    def block(self, values: Mapping[str, Any]) -> Block:
        """Return the Block with these numbers."""
        law, block = self.law, Block(self.name, doc=self.doc)
        numbers, places = self.numbers(values), self.places()
        K = np.asarray(values["gain"], dtype=float)
        taken = law.read_states(block)
        generated = read_generators(block, self.solution.exosystem)
        wanted = self._declare_set_point(block)
        if self.tunable:
            gain, elements = law.declare_gain(block, K), {}
            for what, own in places.items():
                elements[what] = ca.SX(0, 1)
                if own:
                    ends, said = gain_range(numbers[what]), told_places(what, own)
                    elements[what] = ca.SX(block.parameter(what, numbers[what], range=ends, doc=said))
            gain = ca.reshape(gain, law.shape[1], law.shape[0]).T
        else:
            gain, elements = ca.SX(ca.sparsify(ca.DM(K))), {what: ca.SX(ca.DM(numbers[what])) for what in MAPS}
        aim = linear_aim(law, wanted, wanted, generated, elements, places)
        meaning = "The command for a state of the plant and of the exosystem."
        law.step(block, [*taken.values(), *generated], taken, gain, aim, meaning)
        block.sample_time = self.rate
        formula = RegulatorFeedback(
            law.kinds,
            law.ends,
            tuple(symbol.signal.name for symbol in generated),
            places["state_map"],
            places["input_map"],
            law.saturate,
            {} if self.tunable else numbers,
        )
        finish(block, {"step": formula}, self._near(K, generated))
        block.design = self._design(values)
        return block

    def _declare_set_point(self, block: Block) -> dict[str, Symbol]:
        """Declare x* and u* as parameters."""
        answer, values = {}, {**self.where.states, **self.where.inputs}
        states = [state.signal for state in self.law.plant.states]
        for signal in [*states, *self.law.acting]:
            word = "set point of" if signal in states else "what holds the set point:"
            ends = (signal.low, signal.high)
            answer[signal.name] = block.parameter(
                signal.name, values[signal.name], unit=signal.unit, range=ends, doc=f"{word} {signal.name}"
            )
        return answer

    def _near(self, K: Array, generated: list[Symbol]) -> Calls:
        """Return calls near where the plant should be."""
        hold = np.concatenate([np.ravel(self.where.inputs[item.name]) for item in self.law.acting])
        Pi, Gamma = self.solution.state_map[:, self.order], self.solution.input_map[:, self.order]
        return self.law.near(self.where.x, hold, K, Pi, Gamma, generated)

    def _design(self, values: Mapping[str, Any]) -> Design:
        """Return the record of Pi, Gamma and (of a Gain) K."""
        designed, solution = isinstance(self.gain, Gain), self.solution
        names = (*MAPS, *(["gain"] if designed else []))
        shapes = {what: np.shape(values[what]) for what in names}

        def rebuild(given: dict[str, Any]) -> Block:
            for what in names:
                matrix = np.asarray(given[what], dtype=float)
                if matrix.shape != shapes[what] or not np.all(np.isfinite(matrix)):
                    raise ModelError(
                        f"{self.name}: {what} of design.json has shape {matrix.shape}; give {shapes[what][0]} x "
                        f"{shapes[what][1]} finite numbers, or export with --redesign"
                    )
            for what, own in self.places().items():
                rest = np.array(given[what], dtype=float)[:, self.order]
                most = max(1.0, float(np.max(np.abs(rest), initial=0.0)))
                for i, j in own:
                    rest[i, j] = 0.0
                if float(np.max(np.abs(rest), initial=0.0)) > 1e-9 * most:
                    raise ModelError(
                        f"{self.name}: {what} of design.json has other zeros than the model; export with --redesign"
                    )
            made = self.block({**values, **given})
            made.source = source_line
            return made

        def properties(given: dict[str, Any]) -> dict[str, tuple[float, float]]:
            return {**solution.properties(given), **(self.gain.properties(given["gain"]) if designed else {})}

        source_line = place_of_call()
        source = solution.source() + (self.gain.source() if designed else "")
        return Design({what: values[what] for what in names}, source, rebuild, properties)


def _acting(plant: Plant, solution: RegulatorSolution) -> list[Signal]:
    """Return the inputs of the plant that act: all but measured disturbances."""
    away = set(solution.model.disturbances)
    found = [symbol.signal for symbol in plant.inputs if symbol.signal.name not in away]
    if not found:
        raise ModelError(f"{plant.name}: it has no input to act with; declare one with input()")
    return found
