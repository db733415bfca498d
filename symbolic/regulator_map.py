"""The Block of a regulator's power series: from the state of an exosystem to where the plant has to be."""

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
from .block import Block, Design, Table
from .components import Calls, finish, rounded_up
from .errors import ModelError
from .plant import Plant, Symbol, wrap
from .power_series import RegulatorSeries
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
    name = name or f"{plant.name}_map"
    reach = _amplitude(name, amplitude, len(series.exosystem_states))
    block = Block(
        name,
        doc=doc or f'where the plant "{plant.name}" has to be for the state of its exosystem, to degree {series.order}',
    )
    taken = _declare_generator(block, series, reach)
    signals = [*[state.signal for state in plant.states], *_acting(series)]
    values = {**series.point.states, **series.point.inputs}
    wanted = {}
    for signal in signals:
        wanted[signal.name] = block.parameter(
            signal.name, values[signal.name], unit=signal.unit, range=(signal.low, signal.high),
            doc=f"{signal.name} where w is zero",
        )  # fmt: skip
    groups = _declare_coefficients(block, series)
    pi, gamma = series.expressions(ca.vertcat(*taken), *groups)
    outputs, rows, start = {}, ca.vertcat(pi, gamma), 0
    for signal in signals:
        value = wanted[signal.name] + rows[start : start + signal.size]
        outputs[signal.name] = wrap(value) if signal.angle else value
        start += signal.size
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
    formula = reference.RegulatorMap(tuple(item.signal.name for item in taken), _rows(series, signals))
    finish(block, {"step": formula}, _calls(taken, reach))
    block.design = _design(block, series)
    block.tables["what is left of the regulator equations"] = lambda: _table(series, reach)
    return block


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


def _declare_generator(block: Block, series: RegulatorSeries, reach: Array) -> list[Symbol]:
    """Declare what w comes as."""
    own = series.exosystem
    if not isinstance(own, Plant):
        said = ", ".join(series.exosystem_states)
        return [block.input("w", size=own.order, range=(-reach, reach), doc=f"state of the exosystem: {said}")]
    answer, start = [], 0
    for state in own.states:
        signal = state.signal
        ends = reach[start : start + signal.size]
        answer.append(block.input(signal.name, size=signal.size, unit=signal.unit, range=(-ends, ends), doc=signal.doc))
        start += signal.size
    return answer


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
        reach = 10.0 ** (math.ceil(math.log10(max(rounded_up(float(np.max(np.abs(numbers)))), 1.0))) + 2)
        said = f"coefficients that are not zero, of {', '.join(labels)}; of each by degree, monomials in graded lexicographic order"
        answer.append(ca.SX(block.parameter(group, numbers, range=(-reach, reach), doc=said)))
    return answer


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


def _calls(taken: list[Symbol], reach: Array) -> Calls:
    """Return steps in which w wanders over its range, smoothly."""

    def calls(rng: Any, steps: int) -> Iterator[tuple[str, dict[str, Any]]]:
        yield "init", {}
        drive = np.zeros(len(reach))
        for _ in range(steps):
            drive = 0.8 * drive + 0.6 * rng.normal(size=len(drive))
            w, inputs, start = reach * np.tanh(drive), {}, 0
            for symbol in taken:
                inputs[symbol.signal.name] = w[start : start + symbol.signal.size]
                start += symbol.signal.size
            yield "step", inputs

    return calls


def _design(block: Block, series: RegulatorSeries) -> Design:
    """Return the record of the coefficients."""

    def rebuild(values: dict[str, Any]) -> Block:
        series.with_coefficients(values)  # refuses what does not fit
        made = copy.copy(block)
        defaults = {group: tuple(float(item) for item in np.ravel(values[group])) for group in GROUPS}
        made.param_signals = [
            replace(signal, default=defaults[signal.name]) if signal.name in GROUPS else signal
            for signal in block.param_signals
        ]
        made.design = Design({group: np.ravel(values[group]) for group in GROUPS}, series.source(), rebuild, properties)
        return made

    def properties(values: dict[str, Any]) -> dict[str, tuple[float, float]]:
        return series.properties(values)

    return Design(dict(series.rounded()), series.source(), rebuild, properties)


def _table(series: RegulatorSeries, reach: Array) -> Table:
    """Measure what is left of the nonlinear equations over the range of w."""
    held = series.with_coefficients(series.rounded())
    draws = np.random.default_rng(0).uniform(-1, 1, (POINTS, len(reach)))
    draws = reach * draws / np.max(np.abs(draws), axis=1, keepdims=True)  # on the faces of the box
    worst = {share: max(float(np.linalg.norm(held.residual(share * w))) for w in draws) for share in (1.0, 0.5, 0.25)}
    rows: list[tuple[str | int | float, ...]] = [(share, value) for share, value in worst.items()]
    return Table(
        f"What is left of the regulator equations, to degree {series.order}",
        ("share of the amplitude", "largest residual"),
        rows,
        f"norm over states and outputs, the largest at {POINTS} points on the faces of the box of w, coefficients of 9 digits",
    )
