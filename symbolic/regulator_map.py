"""The Blocks of a regulator's power series: where the plant has to be for the state of an exosystem, and what follows it."""

from __future__ import annotations

import copy
import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from ..reference import power_series as reference
from ..reference.controllers import StateFeedback
from .block import Block, Design, Table
from .components import Calls, finish, rounded_up
from .design import Gain
from .errors import ModelError
from .feedback_law import Aim, FeedbackLaw
from .plant import Plant, Symbol, wrap
from .power_series import RegulatorSeries
from .regulator_equations import closed_loop
from .signals import Signal, spread

Array = NDArray[Any]

GROUPS = ("state_coefficients", "input_coefficients")

POINTS = 200
"""Points at which the residual over the range of w is looked at."""


def regulator_map(series: RegulatorSeries, *, amplitude: Any, name: str = "", doc: str = "") -> Block:
    """Return the block that computes x* + pi(w) and u* + gamma(w).

    Parameters
    ----------
    series : RegulatorSeries
        pi and gamma. Their coefficients that are not zero become run-time parameters, through `design.json`, and so do x* and
        u*, under the names of states and inputs.
    amplitude : float or sequence, shape (r,)
        How large each element of w may be; beyond it a call is refused (BAD_INPUT). The series holds near zero: the table
        of this block says what is left of the equations up to there.
    name : str
        Name of the block; default ``<plant>_map``.
    doc : str
        Its meaning.

    Returns
    -------
    Block
        Entries `init` and `step`, no memory. Inputs: `w`, or the states of an exosystem that is a Plant; outputs: states and
        acting inputs of the plant, with their names, units and ranges.

    Raises
    ------
    ModelError
        If the amplitude is not positive, or of another size.

    Examples
    --------
    >>> from plantc.symbolic import Plant
    >>> from plantc.symbolic.exosystems import harmonic
    >>> from plantc.symbolic.power_series import regulator_series
    >>> from plantc.symbolic.regulator_map import regulator_map
    >>> spring = Plant("spring")
    >>> position, push = spring.state("position"), spring.input("push")
    >>> spring.dynamics({position: position + position**3 + push})
    >>> where = regulator_map(regulator_series(spring, {}, harmonic("position", 1.0), 3), amplitude=2.0)
    >>> [signal.name for signal in where.entries["step"].outputs]
    ['position', 'push']
    """
    plant = series.plant
    block = Block(name or f"{plant.name}_map", doc=doc or f"where the plant {_said(series)}")
    taken, reach = _declare_generator(block, series, amplitude)
    outputs, signals = _declare_maps(block, series, taken)
    block.entry(
        "step",
        inputs=taken,
        outputs=outputs,
        output_units={item.name: item.unit for item in signals},
        output_ranges={item.name: (item.low, item.high) for item in signals},
        output_docs={item.name: f"{item.doc or item.name} that the exosystem asks for" for item in signals},
        doc="Where the plant has to be, and what keeps it there.",
    )
    block.sample_time = plant.dt if isinstance(plant.dt, float) else None
    finish(block, {"step": _oracle(series, taken, signals)}, _calls(taken, reach))
    return _recorded(block, series, reach, None)


def regulator_feedback(
    series: RegulatorSeries,
    gain: Gain | Any,
    *,
    amplitude: Any,
    saturate: bool = False,
    accept_unstable: bool = False,
    name: str = "",
    doc: str = "",
) -> Block:
    """Return the controller u = u* + gamma(w) - K (x - x* - pi(w)).

    Parameters
    ----------
    series : RegulatorSeries
        pi and gamma; see `regulator_map`.
    gain : Gain, or (acting inputs, n) array
        K, by rows; the run-time parameter `gain`. That of a `Gain` goes through `design.json`, numbers of your own do not.
    amplitude : float or sequence, shape (r,)
        How large each element of w may be.
    saturate : bool
        Whether u is held within the ranges of the plant's inputs (status CLAMPED), or a call that leaves them refused (OVERFLOW).
    accept_unstable : bool
        Whether a K that does not stabilise the linearisation is accepted.
    name, doc : str
        Name of the block, default ``<plant>_regulator``, and its meaning.

    Returns
    -------
    Block
        Entries `init` and `step`, no memory. Inputs: `w` (or the states of an exosystem that is a Plant) and the states of the
        plant; outputs: its acting inputs.

    Raises
    ------
    RegulatorError
        If the gain does not stabilise; the sentence has the largest real part, or the spectral radius.
    ModelError
        If the gain has another shape, or the amplitude is not positive.
    """
    plant = series.plant
    block = Block(
        name or f"{plant.name}_regulator",
        doc=doc or f"follows the exosystem: u = u* + gamma(w) - K (x - x* - pi(w)), of the plant {_said(series)}",
    )
    law = FeedbackLaw(plant, tuple(_acting(series)), saturate)
    K = law.checked(block.name, gain)
    closed_loop(series.degrees[0].model, K, accept_unstable=accept_unstable)
    taken, reach = _declare_generator(block, series, amplitude)
    states = law.read_states(block)
    wanted = _declare_set_point(block, series)
    moved, driven = series.expressions(ca.vertcat(*taken), *_declare_coefficients(block, series))
    rows = ca.reshape(law.declare_gain(block, K), K.shape[1], K.shape[0]).T
    aim = Aim(wanted, wanted, moved, driven)
    meaning = "The command for a state, and a state of the exosystem."
    law.step(block, [*taken, *states.values()], states, rows, aim, meaning)
    block.sample_time = plant.dt if isinstance(plant.dt, float) else None
    signals = [*[state.signal for state in plant.states], *law.acting]
    about = StateFeedback(law.kinds, law.ends, saturate)
    feedback = reference.RegulatorFeedback(_oracle(series, taken, signals), about)
    finish(block, {"step": feedback}, _calls(taken, reach, series, K))
    return _recorded(block, series, reach, gain if isinstance(gain, Gain) else None)


def _said(series: RegulatorSeries) -> str:
    return f'"{series.plant.name}" has to be for the state of its exosystem, to degree {series.order}'


def _amplitude(name: str, given: Any, size: int) -> Array:
    try:
        reach = np.array(spread(given, size), dtype=float)
    except (TypeError, ValueError):
        reach = np.zeros(0)
    if reach.shape != (size,) or not np.all(np.isfinite(reach)) or not np.all(reach > 0):
        raise ModelError(
            f"{name}: the amplitude is {given!r}; give 1 or {size} positive number(s), the most of each |w_i|"
        )
    return reach


def _declare_generator(block: Block, series: RegulatorSeries, amplitude: Any) -> tuple[list[Symbol], Array]:
    """Declare what w comes as; return it, and how large each element may be."""
    reach, own = _amplitude(block.name, amplitude, len(series.exosystem_states)), series.exosystem
    if not isinstance(own, Plant):
        said = ", ".join(series.exosystem_states)
        return [block.input("w", size=own.order, range=(-reach, reach), doc=f"state of the exosystem: {said}")], reach
    answer, start = [], 0
    for state in own.states:
        signal = state.signal
        ends = reach[start : start + signal.size]
        answer.append(block.input(signal.name, size=signal.size, unit=signal.unit, range=(-ends, ends), doc=signal.doc))
        start += signal.size
    return answer, reach


def _declare_set_point(block: Block, series: RegulatorSeries) -> dict[str, Symbol]:
    """Declare x* and u* as parameters."""
    values = {**series.point.states, **series.point.inputs}
    return {
        item.name: block.parameter(
            item.name, values[item.name], unit=item.unit, range=(item.low, item.high),
            doc=f"{item.name} where w is zero",
        )
        for item in [*[state.signal for state in series.plant.states], *_acting(series)]
    }  # fmt: skip


def _declare_maps(block: Block, series: RegulatorSeries, taken: list[Symbol]) -> tuple[dict[str, ca.SX], list[Signal]]:
    """Declare x*, u* and the coefficients; return x* + pi(w) and u* + gamma(w) by name, and their signals."""
    signals = [*[state.signal for state in series.plant.states], *_acting(series)]
    wanted = _declare_set_point(block, series)
    rows, start = ca.vertcat(*series.expressions(ca.vertcat(*taken), *_declare_coefficients(block, series))), 0
    answer = {}
    for signal in signals:
        value = wanted[signal.name] + rows[start : start + signal.size]
        answer[signal.name] = wrap(value) if signal.angle else value
        start += signal.size
    return answer, signals


def _acting(series: RegulatorSeries) -> list[Signal]:
    """Return the plant's inputs that act; one of which only some elements do is refused."""
    answer = []
    for symbol in series.plant.inputs:
        signal = symbol.signal
        labels = [signal.name] if signal.size == 1 else [f"{signal.name}_{k}" for k in range(signal.size)]
        kept = [label for label in labels if label in series.inputs]
        if kept and len(kept) < len(labels):
            raise ModelError(
                f"{series.plant.name}: of the input {signal.name!r} only {', '.join(kept)} act(s); declare what is measured as an "
                "input of its own"
            )
        answer += [signal] if kept else []
    return answer


def _declare_coefficients(block: Block, series: RegulatorSeries) -> list[ca.SX]:
    """Declare the coefficients as parameters, in the order of `RegulatorSeries.terms`."""
    answer = []
    for group, labels, numbers in zip(GROUPS, (series.states, series.inputs), series.rounded().values(), strict=True):
        if not numbers.size:
            answer.append(ca.SX(0, 1))
            continue
        reach = _range_of(numbers)
        said = f"coefficients that are not zero, of {', '.join(labels)}; of each by degree, monomials in graded lexicographic order"
        answer.append(ca.SX(block.parameter(group, numbers, range=(-reach, reach), doc=said)))
    return answer


def _range_of(numbers: Array) -> float:
    """Return how large designed numbers may be: a hundred times the largest, at least a hundred."""
    return 10.0 ** (math.ceil(math.log10(max(rounded_up(float(np.max(np.abs(numbers)))), 1.0))) + 2)


def _oracle(series: RegulatorSeries, taken: list[Symbol], signals: list[Signal]) -> reference.RegulatorMap:
    return reference.RegulatorMap(tuple(item.signal.name for item in taken), _rows(series, signals))


def _rows(
    series: RegulatorSeries, signals: list[Signal]
) -> tuple[tuple[str, tuple[reference.Polynomial, ...], bool], ...]:
    """Return what the oracle is told: of each output element its exponents, and where its coefficients lie."""
    terms = series.terms()
    rows: list[tuple[tuple[str, int], tuple[tuple[int, ...], ...]]] = []
    for group, own in zip(GROUPS, terms, strict=True):
        start = 0
        for row in own:
            rows.append(((group, start), tuple(exponents for exponents, _ in row)))
            start += len(row)
    answer, start = [], 0
    for signal in signals:
        mine = rows[start : start + signal.size]
        made = tuple(reference.Polynomial((signal.name, k), *item) for k, item in enumerate(mine))
        answer.append((signal.name, made, signal.angle))
        start += signal.size
    return tuple(answer)


def _calls(taken: list[Symbol], reach: Array, series: RegulatorSeries | None = None, K: Array | None = None) -> Calls:
    """Return steps in which w wanders over its range, smoothly, and where asked for a state about x* + pi(w).

    The state is so near that u does not leave its range for its sake.
    """

    def calls(rng: Any, steps: int) -> Iterator[tuple[str, dict[str, Any]]]:
        yield "init", {}
        drive = np.zeros(len(reach))
        for _ in range(steps):
            drive = 0.8 * drive + 0.6 * rng.normal(size=len(drive))
            w = reach * np.tanh(drive)
            inputs = _cut(w, [item.signal for item in taken])
            if series is not None and K is not None:
                inputs |= _near(series, K, w, rng)
            yield "step", inputs

    return calls


def _cut(vector: Array, signals: list[Signal]) -> dict[str, Any]:
    """Return a vector by the names of its pieces."""
    starts = np.cumsum([0, *[item.size for item in signals]])
    return {item.name: vector[start : start + item.size] for item, start in zip(signals, starts, strict=False)}


def _near(series: RegulatorSeries, K: Array, w: Array, rng: Any) -> dict[str, Any]:
    """Return a state near x* + pi(w), within the ranges."""
    signals = [state.signal for state in series.plant.states]
    low, high = (np.concatenate([getattr(item, end) for item in signals]) for end in ("low", "high"))
    room = min(
        (0.5 * (b - a) for item in _acting(series) for a, b in zip(item.low, item.high, strict=True)), default=1.0
    )
    spread_of = np.minimum(1.0, 0.05 * (high - low))
    factor = min(1.0, 0.1 * room / max(float(np.max(np.sqrt(K**2 @ spread_of**2))), 1e-300))
    x = series.point.x + series.at(w)[0] + factor * spread_of * rng.normal(size=len(low))
    return _cut(np.clip(x, low, high), signals)


def _recorded(block: Block, series: RegulatorSeries, reach: Array, gain: Gain | None) -> Block:
    """Give a block its record of designed numbers, and the table of what its series leaves."""

    def made_of(target: Block, values: dict[str, Any]) -> Block:
        other = series.with_coefficients(values)  # refuses what does not fit
        given = {name: np.ravel(np.asarray(values[name], dtype=float)) for name in GROUPS}
        if gain is not None:
            given["gain"] = gain.checked(block.name, values["gain"]).ravel()
        target.param_signals = [
            replace(signal, default=tuple(map(float, given[signal.name]))) if signal.name in given else signal
            for signal in block.param_signals
        ]
        target.tables = {"what is left of the regulator equations": lambda: _table(other, reach)}
        target.design = Design(given, source, lambda new: made_of(copy.copy(block), new), properties)
        return target

    def properties(values: dict[str, Any]) -> dict[str, tuple[float, float]]:
        return series.properties(values) | (
            {} if gain is None else gain.properties(gain.checked(block.name, values["gain"]))
        )

    source = series.source() if gain is None else f"{series.source()}-{gain.source()}"
    return made_of(block, series.rounded() if gain is None else {**series.rounded(), "gain": gain.rounded()})


def _table(series: RegulatorSeries, reach: Array) -> Table:
    """Measure what is left of the nonlinear equations over the range of w."""
    draws = np.random.default_rng(0).uniform(-1, 1, (POINTS, len(reach)))
    draws = reach * draws / np.max(np.abs(draws), axis=1, keepdims=True)  # on the faces of the box
    worst = {share: max(float(np.linalg.norm(series.residual(share * w))) for w in draws) for share in (1.0, 0.5, 0.25)}
    rows: list[tuple[str | int | float, ...]] = [(share, value) for share, value in worst.items()]
    return Table(
        f"What is left of the regulator equations, to degree {series.order}",
        ("share of the amplitude", "largest residual"),
        rows,
        f"norm over states and outputs, the largest at {POINTS} points on the faces of the box of w, coefficients of 9 digits",
    )
