"""The jump matrix technique, done again: a master's thesis that simulates and estimates nonlinear stochastic systems by it.

`plantc study jump_matrix` runs it. Most of the printed equations are lost; specs/jump_matrix.md rebuilds them, and fixes what the
thesis leaves open. The printed tables, the cases and the loops are in `jump_matrix_runs`.
"""

from __future__ import annotations

import hashlib
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from plantc.examples.jump_matrix_runs import (
    BATCHES,
    BY_CLOSED,
    BY_OPEN,
    BY_STATE,
    CONTROL_NOISES,
    CONTROLLED,
    EKF,
    FIGURE_NOISES,
    JACOBIAN,
    ONLINE,
    OPEN_LOOP,
    OTHERS,
    RELAYS,
    STARTS,
    STEPS,
    TABLES,
    Case,
    Found,
    OtherTruth,
    Printed,
    Runs,
    by_loop,
    cases,
    open_loop,
    other_case,
    other_truth,
    runs_of_loop,
)
from plantc.examples.jump_systems import T
from plantc.simulation import Comparison, Picture, StudyResult, StudyTable, compared, each
from plantc.simulation.monte_carlo import cores
from plantc.symbolic.errors import ModelError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Array = NDArray[np.float64]
Progress = Callable[[str, int, int], None]

NAME = "jump_matrix"
TITLE = "The jump matrix technique: simulation and estimation of nonlinear stochastic systems"
SOURCE = "Master's thesis on the jump matrix technique, Tables 1 to 9, Figs. 6 to 35; equations rebuilt in specs/jump_matrix.md"


# ---------------------------------------------------------------------------------------------------------------------
# Running


def _part(given: tuple[Any, ...]) -> dict[Case, Runs] | OtherTruth:
    """Do one part of the study, in whichever process: the runs of a loop, or the truth by another integrator."""
    if given[0] == "other truth":
        return other_truth(given[1], given[2])
    return runs_of_loop(given[1:])


def run(
    wanted: Sequence[Case], runs: int, seed: int, processes: int, progress: Callable[[str], None] = lambda what: None
) -> tuple[Found, OtherTruth]:
    """Run cases in some processes, each loop derived and compiled by the one that runs it; and the other truth."""
    groups = by_loop(wanted)
    items: list[tuple[Any, ...]] = [("other truth", runs, seed), *[("runs", own, runs, seed) for own in groups]]
    found: dict[Case, Runs] = {}
    other: OtherTruth | None = None
    names = ["truth by another integrator", *[", ".join(map(str, own[0].loop[:3])) for own in groups]]
    for name, part in zip(names, each(_part, items, processes), strict=True):
        if isinstance(part, OtherTruth):
            other = part
        else:
            found |= part
        progress(name)
    assert other is not None
    return found, other


# ---------------------------------------------------------------------------------------------------------------------
# What was printed, and what came out: the spring


def _own(found: Found, number: int, rows: Sequence[float] | None = None, columns: Sequence[int] | None = None) -> Array:
    """Return the medians of a table by rows and columns."""
    table = TABLES[number]
    taken = range(len(table.systems)) if columns is None else columns
    return np.array([[found[table.case(row, column)].median for column in taken] for row in rows or table.rows])


def _span(values: Any) -> str:
    own = np.asarray(values, dtype=float).ravel()
    low, high = float(np.min(own)), float(np.max(own))
    return f"{low:.2g}" if f"{low:.2g}" == f"{high:.2g}" else f"{low:.2g} to {high:.2g}"


def _printed_ratios(found: Found, numbers: Sequence[int], columns: Sequence[int]) -> list[float]:
    return [
        value / found[TABLES[number].case(row, column)].median
        for number in numbers
        for row, column, value in TABLES[number].cells()
        if column in columns and value is not None
    ]


def _quotients(number: int, row: float, other: float, columns: Sequence[int]) -> Array:
    """Return what is printed in one row of a table over what is printed in another."""
    rows = TABLES[number].rows
    return np.array([(rows[row][k] or np.nan) / (rows[other][k] or np.nan) for k in columns])


def _proportional(found: Found) -> Comparison:
    table = TABLES[3]
    still = [found[open_loop(table.case(row, 1))].mse for row in table.rows]
    ratios = np.array([b / a for a, b in pairwise(still)])
    online = _own(found, 3, columns=[1]).ravel()
    printed = [float(_quotients(3, b, a, [1])[0]) for a, b in pairwise(table.rows)]
    return compared(
        f"Table 3, linear spring: the error is proportional to sigma_w^2, by {printed[0]:.4g} and {printed[1]:.4g}",
        f"open loop {_span(ratios)} in every run; the online gain, P_0 = 0: {online[1] / online[0]:.2g} and "
        f"{online[2] / online[1]:.2g}",
        bool(np.max(np.abs(ratios / 10 - 1)) < 5e-3),
        [*ratios.ravel(), *online],
        "By the open loop, to half a percent. Printed is the error of an estimate that nothing corrects; a Kalman filter corrects "
        "it where noise is large.",
    )


def _rising(found: Found) -> Comparison:
    spring, oscillator = _own(found, 2), _own(found, 6)
    rows = list(TABLES[6].rows)
    later = oscillator[[k for k, row in enumerate(rows) if row >= 10]]
    growth = spring[3] / spring[1], oscillator[1] / oscillator[0]
    rises = all(bool(np.all(np.diff(table, axis=0) > 0)) for table in (spring, oscillator))
    return compared(
        f"Tables 2 and 6, Jacobian: the error rises with sigma_v^2; from 1 to 10 by {_span(_quotients(2, 10.0, 1.0, range(3)))} "
        f"(spring), {_span(_quotients(6, 10.0, 1.0, range(3)))} (Van der Pol)",
        f"from 1 to 10 by {_span(growth[0])} (spring), {_span(growth[1])} (Van der Pol)",
        rises and bool(np.all(np.diff(later, axis=1) > 0)),
        [*spring.ravel(), *oscillator.ravel()],
        "In each column, and with eps in the rows from sigma_v^2 = 10 on, which is what counts.",
    )


def _start_dominates(found: Found) -> Comparison:
    low, middle, high = _own(found, 4, columns=[1]).ravel()
    first, second = (float(_quotients(4, b, a, [1])[0]) for a, b in pairwise(TABLES[4].rows))
    return compared(
        f"Table 4, linear spring: over sigma_w^2 = 0.1, 1, 10 the error grows by {first:.2f} and {second:.2f}",
        f"by {middle / low:.2f} and {high / middle:.2f}",
        bool(middle / low < 1.5 and 1.5 <= high / middle <= 2.2),
        [low, middle, high],
        "The start from P_0 = I dominates where the noise is small.",
    )


Cell = tuple[int, int, float, int]
"""Table of the online gain, that of the Jacobian, row, column."""


def compared_cells() -> tuple[list[Cell], list[Cell], list[Cell]]:
    """Return the cells of Tables 1 to 4 where the online gain is printed with less error, with more, and where one is lost."""
    less: list[Cell] = []
    more: list[Cell] = []
    lost: list[Cell] = []
    for online, jacobian in ((1, 2), (3, 4)):
        for row, column, value in TABLES[online].cells():
            other = TABLES[jacobian].rows[row][column]
            own = lost if value is None or other is None else less if value < other else more
            own.append((online, jacobian, row, column))
    return less, more, lost


def _cheaper(found: Found) -> Comparison:
    less, more, lost = compared_cells()
    ratios = [found[TABLES[a].case(row, c)].median / found[TABLES[b].case(row, c)].median for a, b, row, c in less]
    still = [found[TABLES[1].case(row, c)].median / found[open_loop(TABLES[1].case(row, c))].median
             for row, c, _ in TABLES[1].cells()]  # fmt: skip
    other = ", ".join(f"{TABLES[a].varied} = {row:g} with h = {TABLES[a].values[c]:g}" for a, _, row, c in more)
    return compared(
        f"Tables 1 to 4, spring: in {len(less)} of the {len(less) + len(more)} cells that both have, the online gain errs less "
        "than the Jacobian",
        f"online, P_0 = 0, over Jacobian, P_0 = I, in those {len(less)}: {_span(ratios)}; over open loop {_span(still)}",
        max(ratios) < 1,
        ratios,
        f"Left out: {other}, where the print has it the other way, and {len(lost)} cells whose number is lost. By its start: the "
        "0/0 at k = 1 takes the clamp out of P, and P_0 = I makes the Jacobian correct what is right already.",
    )


def _flat(found: Found) -> Comparison:
    own = _own(found, 1, columns=[1]).ravel()
    printed = [numbers[1] for numbers in TABLES[1].rows.values()]
    return compared(
        f"Table 1, linear spring: from sigma_v^2 = 0.1 to 100 the error grows by {(printed[-1] or 0) / (printed[0] or 1) - 1:.0%}",
        f"by a factor {own[-1] / own[0]:.2g}",
        abs(own[-1] / own[0] - 1) < 0.1,
        own,
        "A Kalman filter uses good readings. The printed column is what an open loop gives, as if the gain were zero.",
    )


def _same_for_linear(found: Found) -> Comparison:
    off = []
    for number in (1, 3):
        for row in TABLES[number].rows:
            for known in (True, False):
                a, b = (found[TABLES[number].case(row, 1, approach, known)].mse for approach in (ONLINE, JACOBIAN))
                off.append(float(np.max(np.abs(a / b - 1))))
    return compared(
        'Tables 1 and 2 differ for the linear spring too, "since h is in the transition matrix"',
        "with one start the errors are equal" + (f" to {max(off):.0e}" if max(off) else ", bit for bit"),
        max(off) > 1e-6,
        off,
        "For h = 0 the held cube enters nothing: Phi_13 = Phi_23 = 0. What differs in print is the start.",
        otherwise="shown wrong",
    )


def _sizes(found: Found) -> Comparison:
    spring = [_printed_ratios(found, (2, 4), [c]) for c in range(3)]
    oscillator = [_printed_ratios(found, (6, 8), [c]) for c in range(3)]
    said = "; ".join(f"{name} {_span(own)}" for name, own in zip(
        ("h = -0.5", "h = 0", "h = 1", "eps = 0.5", "eps = 2", "eps = 5"), (*spring, *oscillator), strict=True))  # fmt: skip
    every = [item for own in (*spring, *oscillator) for item in own]
    inside = sum(0.5 <= item <= 2 for item in every)
    return compared(
        "Tables 2, 4, 6, 8, Jacobian: the sizes of the errors",
        f"printed over median: {said}; {inside} of {len(every)} cells within a factor 2",
        inside == len(every),
        every,
        "The most economical reading is that the programs lost most of Psi Q Psi' in the filter; that is inferred, and not "
        "done here.",
    )


# ---------------------------------------------------------------------------------------------------------------------
# Van der Pol, and all approaches with one start


def _insensitive(found: Found) -> Comparison:
    change = []
    for column in (1, 2):
        quiet, noisy = (found[TABLES[8].case(row, column)].mse for row in (1.0, 25.0))
        both = np.isfinite(quiet) & np.isfinite(noisy)
        change.append(float(np.median(noisy[both] / quiet[both])) - 1 if np.any(both) else np.nan)
    printed = _quotients(8, 25.0, 1.0, (1, 2)) - 1
    return compared(
        f"Table 8, eps = 2 and 5: from sigma_w^2 = 1 to 25 the error changes by {printed[0]:+.2%} and {printed[1]:+.2%}",
        f"by {change[0]:+.0%} and {change[1]:+.0%}, the median change of a run",
        max(map(abs, change)) < 0.2,
        change,
        "The start dominates. All cases meet the same noise, so that runs are compared one by one; less than 20 % counts.",
    )


def _readings_lead(found: Found) -> Comparison:
    five, seven = _own(found, 5, columns=[2]).ravel(), _own(found, 7, columns=[2]).ravel()
    rows = list(TABLES[5].rows)[:3]
    slope = float(np.polyfit(np.log(rows), np.log(five[:3]), 1)[0])
    change = seven[-1] / seven[0] - 1
    said = float(np.polyfit(np.log(rows), np.log([TABLES[5].rows[row][2] or np.nan for row in rows]), 1)[0])
    return compared(
        f"Tables 5 and 7, eps = 5, online: the error goes with sigma_v^2 (exponent {said:.2f}), and sigma_w^2 from 1 to 25 changes "
        f"it by {_quotients(7, 25.0, 1.0, [2])[0] - 1:+.1%}",
        f"exponent {slope:.2f}; from sigma_w^2 = 1 to 25 {change:+.0%}",
        abs(slope - 1) <= 0.1 and abs(change) < 0.12,
        [*five[:3], *seven],
        "The held linear part is unstable, so that the gain does not go down with R, and passes on the noise of the readings.",
    )


def _reversed(found: Found) -> Comparison:
    ratios = [
        found[TABLES[a].case(row, c)].median / found[TABLES[b].case(row, c)].median
        for a, b in ((5, 6), (7, 8)) for row, c, _ in TABLES[a].cells() if c > 0
    ]  # fmt: skip
    printed = [
        (TABLES[b].rows[row][c] or np.nan) / value
        for a, b in ((5, 6), (7, 8)) for row, c, value in TABLES[a].cells() if c > 0 and value
    ]  # fmt: skip
    return compared(
        f"Tables 5 to 8, eps = 2 and 5: the online gain errs less than the Jacobian, by {_span(printed)}",
        f"online over Jacobian: {_span(ratios)}",
        max(ratios) < 1,
        ratios,
        "With this start the online gain ignores the nonlinearity, which is what keeps the oscillator bounded.",
    )


def _equal_starts(found: Found) -> Comparison:
    better: dict[bool, list[float]] = {True: [], False: []}
    for case in found:
        if case.approach == ONLINE and case.system in ("spring", "van_der_pol") and case.value:
            other = Case(case.system, case.value, case.noise, case.reading, JACOBIAN, case.known)
            better[case.known].append(found[case].median / found[other].median)
    counts = {known: sum(ratio < 1 for ratio in own) for known, own in better.items()}
    every = [ratio for own in better.values() for ratio in own]
    holds = bool(every) and 2 * sum(counts.values()) > len(every)
    return compared(
        "Conclusion: the online gain, which knows the truth, is less noisy than the Jacobian",
        f"with one start it errs less in {counts[True]} of {len(better[True])} cells (P_0 = 0) and {counts[False]} of "
        f"{len(better[False])} (P_0 = I), h = 0 left out, where both are the same",
        holds,
        every,
        "In most cells counts." + ("" if holds else " What is printed is an effect of two starts."),
    )


def ekf_ratios(found: Found, known: bool) -> list[float]:
    """Return the ratio of medians, EKF over Jacobian, in the cells of Tables 2, 4, 6 and 8."""
    cells = dict.fromkeys(
        (TABLES[n].case(row, c, EKF, known), TABLES[n].case(row, c, JACOBIAN, known))
        for n in (2, 4, 6, 8) for row, c, _ in TABLES[n].cells()
    )  # fmt: skip
    return [found[a].median / found[b].median for a, b in cells]


def _ekf(found: Found) -> Comparison:
    unknown, known = ekf_ratios(found, False), ekf_ratios(found, True)
    return Comparison(
        "No other filter is run for comparison",
        f"extended Kalman filter over Jacobian, medians: {_span(unknown)} with P_0 = I, {_span(known)} with P_0 = 0",
        "cannot be compared",
        "The Jacobian estimator is an extended Kalman filter whose nonlinearity is linearised at the prediction. The truth "
        "is the jump model: with P_0 = 0 and little noise the other filter pays for being of another integrator.",
    )


# ---------------------------------------------------------------------------------------------------------------------
# The relays


def _slopes(found: Found) -> Comparison:
    table, own = TABLES[9], _own(found, 9, columns=[0]).ravel()
    ratios = [(numbers[0] or np.nan) / value for numbers, value in zip(table.rows.values(), own, strict=True)]
    close = all(
        1 / bound <= ratio <= bound
        for slope, ratio in zip(table.rows, ratios, strict=True)
        for bound in [2 if slope >= 10 else 3]
    )
    return compared(
        f"Table 9, original relay: {_span([numbers[0] for numbers in table.rows.values()])} over all slopes",
        f"{_span(own)}; printed over median {_span(ratios)}",
        close and float(np.min(own)) >= 6e-4 and float(np.max(own)) <= 3.5e-3,
        ratios,
        "Within a factor 2 for slopes from 10 on, and 3 below, counts. Ours falls with the slope, print hardly does.",
    )


def _modified(found: Found) -> list[Comparison]:
    table = TABLES[9]
    own, original = _own(found, 9, columns=[1]).ravel(), _own(found, 9, columns=[0]).ravel()
    known = [found[table.case(row, 1, JACOBIAN, True)].median for row in table.rows]
    ratios = [(numbers[1] or np.nan) / value for numbers, value in zip(table.rows.values(), own, strict=True)]
    return [
        compared(
            f"Table 9, modified relay: {_span([numbers[1] for numbers in table.rows.values()])}",
            f"{_span(own)} with P_0 = I, {_span(known)} with P_0 = 0; printed over median {_span(ratios)}",
            all(0.5 <= ratio <= 2 for ratio in ratios),
            ratios,
            "More than sigma_v^2 = 0.1: the printed estimate is worse than the reading itself.",
            otherwise="shown wrong",
        ),
        compared(
            "Section 3.4: the modified relay errs more by two orders of magnitude, since the amplifier clips the noise",
            f"it errs by a factor {_span(own / original)}",
            bool(np.all(own / original > 30)),
            [*own, *original],
            "At a slope of 10 or more the amplifier multiplies the noise in front of it before it clips.",
        ),
    ]


def _relay_figures(found: Found) -> list[Comparison]:
    made = []
    for system, figures in zip(
        RELAYS, ("Figs. 19 and 20, original relay", "Figs. 21 and 22, modified relay"), strict=True
    ):
        case = Case(system, 10.0, *FIGURE_NOISES)
        own = {
            (a, k): found[Case(system, 10.0, *FIGURE_NOISES, a, k)].median
            for a in (ONLINE, JACOBIAN)
            for k in (True, False)
        }
        ratios = [own[ONLINE, known] / own[JACOBIAN, known] for known in (True, False)]
        unequal = own[ONLINE, True] / own[JACOBIAN, False]
        still = found[open_loop(case)].median
        made.append(
            compared(
                f"{figures}: the online gain errs less than the Jacobian",
                f"online over Jacobian {ratios[0]:.2g} (P_0 = 0), {ratios[1]:.2g} (P_0 = I), {unequal:.2g} with the starts of the "
                f"thesis; open loop {still:.2g}",
                max(ratios) < 0.95,
                [*ratios, unequal, still],
                "Less by 5 % or more with one start counts. " + (
                    "It errs less only because it starts with P_0 = 0." if unequal < 1 else "It errs more with any start."
                ),
            )
        )  # fmt: skip
    return made


def _still_case(system: str) -> Case:
    return Case(system, 10.0, 0.0, 0.0)


def _same_relays(found: Found) -> Comparison:
    first, second = (found[_still_case(system)].first[1] for system in RELAYS)
    off = float(np.max(np.abs(first - second)))
    return compared(
        "Section 3.4: without noise both relays respond alike",
        f"x1 differs by {off:.0e} over 10 s, and settles at {first[-1]:.4f}",
        off < 1e-9,
        [off],
    )


def _normal_case(known: bool) -> Case:
    return Case("modified_relay", 10.0, *FIGURE_NOISES, JACOBIAN, known)


def _normal(found: Found) -> list[Comparison]:
    own = {known: float(np.median(found[_normal_case(known)].more["kurtosis"])) for known in (True, False)}
    added = float(np.median(found[_normal_case(False)].more["kurtosis_added"]))
    return [
        compared(
            "Fig. 23: the error is nearly normal",
            f"kurtosis {own[True]:.1f} with P_0 = 0, {own[False]:.1f} with P_0 = I; 3 of a normal one",
            all(2.5 <= value <= 3.5 for value in own.values()),
            own.values(),
            "2.5 to 3.5 with both starts counts. With P_0 = I the first seconds are the tails. Errors of neighbouring steps are "
            "correlated, so that no test of independent samples says more.",
        ),
        compared(
            "Fig. 24: normal numbers added to the error leave it nearly normal, which confirms it",
            f"they bring a kurtosis of {own[False]:.1f} down to {added:.1f}",
            added - 3 > 0.5 * (own[False] - 3),
            [own[False], added],
            "Added normal numbers of the same variance leave a quarter of any excess: the check calls nearly normal what is not.",
            otherwise="shown wrong",
        ),
    ]


# ---------------------------------------------------------------------------------------------------------------------
# Chapter IV, and the other truth


def control_case(system: str, transition: str) -> Case:
    """Return a case of chapter IV."""
    return Case(system, 0.0, *CONTROL_NOISES[system], transition=transition)


def transition_ratios(found: Found, measure: str) -> tuple[list[float], list[float]]:
    """Return, for each case of chapter IV, Phi_OL over Phi_CL: of medians, and the fraction of seeds where it is larger."""
    pairs = [[found[control_case(name, way)].more[measure] for way in (BY_OPEN, BY_CLOSED)] for name in CONTROLLED]
    return [float(np.median(a) / np.median(b)) for a, b in pairs], [float(np.mean(a > b)) for a, b in pairs]


def _control(found: Found) -> Iterator[Comparison]:
    rough, more = transition_ratios(found, "roughness")
    gain, _ = transition_ratios(found, "gain")
    yield compared(
        "Chapter IV: with Phi_OL the estimates are noisier than with Phi_CL",
        f"squared increments {_span(rough)} times as large, in {min(more):.0%} of the runs or more; K1 {_span(gain)} times",
        min(rough) >= 1.05 and min(more) >= 0.85 and min(gain) >= 1.1,
        [*rough, *more, *gain],
        "Phi_CL believes that the error decays as the loop does, and so takes a smaller gain.",
    )
    mse = {(name, way): found[control_case(name, way)].mse for name in CONTROLLED for way in (BY_OPEN, BY_CLOSED)}
    over = {name: float(np.median(mse[name, BY_CLOSED]) / np.median(mse[name, BY_OPEN])) for name in CONTROLLED}
    better = {name: float(np.mean(mse[name, BY_OPEN] < mse[name, BY_CLOSED])) for name in CONTROLLED}
    said = "; ".join(f"{name} {over[name]:.2f} ({better[name]:.0%})" for name in CONTROLLED)
    yield compared(
        "Section 4.2: where the loop is designed closed, Phi_CL should be used",
        f"error with Phi_CL over error with Phi_OL, and runs in which Phi_OL is better: {said}",
        over["linear_amplifier"] <= 1,
        over.values(),
        "The command is known, so the error goes by Phi_OL whatever is fed back. On the linear plant that is a theorem; with a "
        "nonlinearity the difference may be less than that between runs.",
        otherwise="shown wrong",
    )
    pairs = [[float(np.median(found[control_case(name, way)].more["deviation"])) for way in (BY_OPEN, BY_CLOSED)]
             for name in CONTROLLED[:2]]  # fmt: skip
    yield compared(
        "Section 4.2: with the saturating amplifier the output is less noisy than with the linear one",
        f"mean square about the response without noise {_span(pairs[1])} against {_span(pairs[0])}",
        all(a < b for a, b in zip(pairs[1], pairs[0], strict=True)),
        [*pairs[0], *pairs[1]],
    )
    ways = (BY_STATE, BY_OPEN)
    rise = {
        name: [float(np.median(found[control_case(name, way)].more["rise"])) for way in ways] for name in CONTROLLED[:2]
    }
    never = sum(int(np.sum(np.isposinf(found[control_case(name, way)].more["rise"]))) for name in rise for way in ways)
    said = "; ".join(f"{name} {a:.2f} s, {b:.2f} s" for name, (a, b) in rise.items())
    yield compared(
        "Section 4.2: with the true state fed back the rise is slightly faster than with the estimated one",
        f"to nine tenths, true state, then estimate: {said}; {never} runs that never get there count as infinite",
        0.8 * rise["saturating_amplifier"][1] <= rise["saturating_amplifier"][0] < rise["saturating_amplifier"][1],
        rise["saturating_amplifier"],
        "Medians, and the saturating one counts, of which it is said; up to a fifth is slightly.",
    )


def _other_truth(other: OtherTruth, found: Found) -> list[Comparison]:
    ratios = {name: float(np.median(other.mse[name, v])) / found[other_case(name, v)].median for name, v in OTHERS}
    orders = [float(np.log2(a / b)) for own in other.errors.values() for a, b in pairwise(own)]
    hard = zip(other.errors["spring", 1.0], other.steps, strict=True)
    shares = ", ".join(f"{name} {ratio:.2f}" for name, ratio in ratios.items())
    return [
        compared(
            "Fig. 12: a truth from another integrator is tracked well once the gains have settled",
            f"error over that with the truth by jumps: {shares}",
            all(1 / 1.6 <= ratio <= 1.6 for ratio in ratios.values()),
            ratios.values(),
            "Medians; a factor 1.6 is what batches of 40 runs differ by.",
        ),
        compared(
            "Chapter II: the jumps simulate the system",
            "hard spring without noise, |error of x1| after 10 s: "
            + ", ".join(f"{error:.3g} (T = {step:g})" for error, step in hard)
            + f"; order {_span(orders)}",
            all(0.8 <= order <= 1.2 for order in orders),
            orders,
            "Each nonlinearity is held over a step: the technique is the exponential Euler method, of first order.",
        ),
    ]


def comparisons(found: Found, other: OtherTruth) -> list[Comparison]:
    """Return every printed statement beside what came out."""
    return [
        _proportional(found),
        _rising(found),
        _start_dominates(found),
        _insensitive(found),
        _readings_lead(found),
        _cheaper(found),
        _slopes(found),
        *_control(found),
        *_other_truth(other, found),
        _same_relays(found),
        _flat(found),
        _sizes(found),
        _reversed(found),
        *_modified(found),
        *_relay_figures(found),
        *_normal(found),
        _same_for_linear(found),
        _equal_starts(found),
        _ekf(found),
    ]


# ---------------------------------------------------------------------------------------------------------------------
# Tables


def _table(found: Found, table: Printed) -> StudyTable:
    title = {"spring": "nonlinear spring", "van_der_pol": "Van der Pol", "relay": "relays"}[table.systems[0]]
    fixed = {"sigma_v^2": "sigma_w^2", "sigma_w^2": "sigma_v^2"}.get(table.varied)
    given = (
        f"{fixed} = {table.fixed[0]:g}" if fixed else f"sigma_w^2 = {table.fixed[0]:g}, sigma_v^2 = {table.fixed[1]:g}"
    )
    rows = []
    for row, column, value in table.cells():
        own = found[table.case(row, column)]
        where = table.systems[column] if table.values[column] is None else table.values[column]
        rows.append((row, where, value, own.median, *own.band, own.diverged, value / own.median if value else None))
    head = {"spring": "h", "van_der_pol": "eps", "relay": "system"}[table.systems[0]]
    return StudyTable(
        f"table-{table.number}",
        f"Table {table.number}: {title}, {table.approach}, mean square error of x1, {given}",
        (table.varied, head, "printed", "median", "10 %", "90 %", "diverged", "printed / median"),
        tuple(rows),
        f"Printed: one run. {'P_0 = 0' if table.approach == ONLINE else 'P_0 = I'}; the estimate starts at the true state."
        + (" One column is lost." if table.number == 4 else ""),
    )


def _starts_table(found: Found) -> StudyTable:
    rows: dict[tuple[Any, ...], None] = {}
    for number in (1, 3, 5, 7):
        for row, column, _ in TABLES[number].cells():
            case = TABLES[number].case(row, column)
            own = [found[TABLES[number].case(row, column, approach, known)] for approach, known in STARTS]
            cells = (case.system, case.value, case.noise, case.reading, found[open_loop(case)].median)
            rows[*cells, *(item.median for item in own), max(item.diverged for item in own)] = None
    return StudyTable(
        "equal-starts",
        "Every approach with equal P_0: medians of the mean square error",
        (
            "system", "h, eps", "sigma_w^2", "sigma_v^2", OPEN_LOOP,
            *[f"{approach}, {'0' if known else 'I'}" for approach, known in STARTS], "most diverged",
        ),
        tuple(rows),
        "0: P_0 = 0, I: P_0 = I. The identity with P_0 = 0 is the online gain with P_0 = 0. An infinite median: more than half "
        "of the runs diverged.",
    )  # fmt: skip


def _relay_table(found: Found) -> StudyTable:
    rows = []
    for case, own in found.items():
        if case.system in RELAYS and (case == open_loop(case) or (case.noise, case.reading) == FIGURE_NOISES):
            start = "" if case.approach == OPEN_LOOP else "0" if case.known else "I"
            rows.append(
                (case.system, case.approach, start, own.median, *own.band, float(np.median(own.more["kurtosis"])))
            )
    rows.sort(key=lambda row: (RELAYS.index(row[0]), row[1] != OPEN_LOOP, row[1], row[2]))
    return StudyTable(
        "relays",
        "Figs. 19 to 22: the relays with slope 10, sigma_w^2 = 0.1, sigma_v^2 = 1",
        ("system", "approach", "P_0", "median", "10 %", "90 %", "kurtosis"),
        tuple(rows),
        "Mean square error of x1; median of the kurtosis of its error.",
    )


def _control_table(found: Found) -> StudyTable:
    rows = []
    for name in CONTROLLED:
        for way in (BY_STATE, BY_OPEN, BY_CLOSED):
            own = found[control_case(name, way)]
            told = [float(np.median(own.more[key])) if key in own.more else None
                    for key in ("roughness", "gain", "deviation", "rise")]  # fmt: skip
            estimated = way != BY_STATE
            rows.append(
                (name, way, own.median if estimated else None, *(own.band if estimated else (None, None)), *told)
            )
    return StudyTable(
        "control",
        "Chapter IV: actual against estimated state feedback, with Phi_OL and Phi_CL in the covariance",
        ("system", "fed back, by", "median", "10 %", "90 %", "roughness", "K1", "deviation", "rise [s]"),
        tuple(rows),
        "Mean square error of x1; then medians of: squared increment of the estimate, mean K1, mean square of x1 less its response "
        "without noise, time to nine tenths.",
    )


def _order_table(other: OtherTruth) -> StudyTable:
    rows = []
    for (name, value), own in other.errors.items():
        orders = [None, *[float(np.log2(a / b)) for a, b in pairwise(own)]]
        rows += [(name, value, step, error, order) for step, error, order in zip(other.steps, own, orders, strict=True)]
    return StudyTable(
        "order",
        "The jump simulation against another integrator, without noise",
        ("system", "h, eps", "T [s]", "|error of x1| after 10 s", "order"),
        tuple(rows),
        "The other: Runge-Kutta of eighth order (DOP853) with tolerances of 1e-12.",
    )


ERRATA = (
    (
        "Tables 1, 3",
        "errors of the online estimator",
        "open-loop errors",
        "Proportional to sigma_w^2 to 0.2 %, flat in sigma_v^2 (E1).",
    ),
    (
        "Section 3.2",
        "w white noise of a density",
        "the value held over a step has the variance sigma_w^2",
        "A density gives 100 times, an impulse 10 000 times the error of the open loop (E2).",
    ),
    (
        "Table 7, text",
        "sigma_w^2 = 1, 2, 5",
        "1, 10, 25, as in the table",
        "Its eps = 0.5 column is proportional to those (E3).",
    ),
    (
        "Section 3.2",
        "x(0) of the spring not stated",
        "(1.5, 0)",
        "x(0) = 0 would give one error for h = -0.5 and 0, not a ratio of 6.7; at 2 the soft spring escapes (E4).",
    ),
    (
        "Tables 5 to 8",
        "columns headed h, in Table 8 -0.5, 0, 1",
        "eps = 0.5, 2, 5",
        "The middle row of Table 8 is a row of Table 6 (E5).",
    ),
    ("Table 4", "third column lost", "left out", "By Table 2 its middle is 0.5951792 (E5)."),
    (
        "Section 3.2",
        "the online ratios go to zero as the estimate converges",
        "they go to a derivative",
        "And the ratio of the clamp has no effect once its variance is zero (E6).",
    ),
    (
        "Section 3.4",
        "no noise matrix in the original relay",
        "w inside the amplifier, G Q G' in the covariance",
        "By the block diagram (E7).",
    ),
    (
        "Section 3.3",
        "'Figs. 13, 14 and 15 ... using the Jacobian approach'; equations (3.3) three times",
        "Figs. 16 to 18; 9 x the stiffness",
        "(E8)",
    ),
    ("Section 3.4", "the amplifier is linear below 0.1", "slope 10; for slope m below 1/m", "(E9)"),
    ("Section 2.1", "example with four states", "left out", "Its second nonlinearity is lost (E10)."),
    (
        "Chapter II",
        "a = I drops a cross relation",
        "agreed",
        "It is the whole effect of the nonlinearity on the gain (E11).",
    ),
    ("Section 4.2", "Phi_CL in the covariance", "both are run", "It contradicts eq. 2.16; see above (E12)."),
    (
        "Section 4.2",
        "sigma_w^2 = 0.1, sigma_v^2 = 0.01; r not stated",
        "in this order; r = 1",
        "A unit step, as in section 3.4 (E13).",
    ),
    (
        "All",
        "start of the estimate not stated",
        "at the true state",
        "An offset would add a constant to Tables 3 and 7 (E14).",
    ),
    ("Chapter V", "a lower bound on the gain", "not done", "A suggestion without numbers (E15)."),
)
"""Where, what is printed, how it is read here, why; (E1) to (E15) are of section 9 of the specification."""


def _tables(found: Found, other: OtherTruth) -> list[StudyTable]:
    errata = StudyTable(
        "errata", "How the thesis is read: errors, gaps and ambiguities", ("where", "printed", "read as", "why"), ERRATA
    )
    tables = [_table(found, table) for table in TABLES.values()]
    return [*tables, _starts_table(found), _relay_table(found), _control_table(found), _order_table(other), errata]


# ---------------------------------------------------------------------------------------------------------------------
# Figures

TIMES = T * np.arange(1, STEPS + 1)


def _tidy(axes: Any, title: str) -> None:
    from plantc.codegen.figures import INK, MUTED

    axes.set_title(title, loc="left", fontsize=8, color=INK)
    axes.tick_params(length=0, labelcolor=MUTED)
    axes.grid(axis="y")
    axes.locator_params(axis="y", nbins=5) if axes.get_yscale() == "linear" else None


def _tracks(found: Found, panels: Mapping[str, Mapping[str, Case]], height: float, *, columns: int = 1) -> Figure:
    """Draw x1 with its readings and estimates of the first run, one panel for each title."""
    from plantc.codegen.figures import MUTED, SERIES, blank, styled

    with styled():
        figure = blank(height)
        grid = figure.subplots(-(-len(panels) // columns), columns, sharex=True, squeeze=False)
        for at, (axes, (title, shown)) in enumerate(zip(grid.ravel(), panels.items(), strict=True)):
            reading, truth, _ = found[next(iter(shown.values()))].first
            label = (lambda text: text) if at == 0 else (lambda text: None)
            axes.plot(TIMES[::10], reading[::10], ".", color=MUTED, markersize=2, label=label("reading"))
            axes.plot(TIMES[::4], truth[::4], color=SERIES[0], linewidth=1.0, label=label("x1"))
            for colour, (name, case) in zip(SERIES[1:], shown.items(), strict=False):
                values = found[case].first[1 if case.transition == BY_STATE else 2]
                axes.plot(TIMES[::4], values[::4], color=colour, linewidth=0.8, label=label(name))
            low, high = float(np.nanmin(truth)), float(np.nanmax(truth))
            axes.set_ylim(low - 0.6 * (high - low), high + 0.6 * (high - low))
            _tidy(axes, title)
        for axes in grid[-1]:
            axes.set_xlabel("time [s]")
        figure.legend(loc="outside upper left", ncols=5, handlelength=1.2)
        return figure


def _compared_gains(system: str, value: float, noise: float, reading: float) -> dict[str, Case]:
    return {
        "online, P_0 = 0": Case(system, value, noise, reading, ONLINE, True),
        "Jacobian, P_0 = I": Case(system, value, noise, reading, JACOBIAN, False),
    }


def _sizes_figure(found: Found) -> Figure:
    from plantc.codegen.figures import MUTED, SERIES, blank, styled

    with styled():
        figure = blank(4.2)
        grid = figure.subplots(2, 2)
        for axes, number in zip(grid.ravel(), (1, 2, 5, 6), strict=True):
            table = TABLES[number]
            rows = list(table.rows)
            for colour, column in zip(SERIES, range(3), strict=False):
                own = [found[table.case(row, column)] for row in rows]
                low, high = zip(*[item.band for item in own], strict=True)
                ceiling = [min(value, 100.0) for value in high]
                axes.fill_between(rows, low, ceiling, color=colour, alpha=0.15, linewidth=0)
                axes.plot(rows, [item.median for item in own], color=colour, linewidth=1.0)
                printed = [table.rows[row][column] for row in rows]
                head = "h" if number < 5 else "eps"
                axes.plot(rows, printed, "x", color=colour, markersize=4, label=f"{head} = {table.values[column]:g}")
            axes.set_xscale("log")
            axes.set_yscale("log")
            axes.minorticks_off()
            axes.legend(fontsize=7, labelcolor=MUTED)
            _tidy(axes, f"Table {number}: {'spring' if number < 5 else 'Van der Pol'}, {table.approach}")
        for axes in grid[-1]:
            axes.set_xlabel("sigma_v^2")
        return figure


def _truth_figure(other: OtherTruth) -> Figure:
    from plantc.codegen.figures import MUTED, SERIES, blank, styled

    with styled():
        figure = blank(2.4)
        left, right = figure.subplots(1, 2, width_ratios=(2, 1))
        left.plot(TIMES[::10], other.readings[::10], ".", color=MUTED, markersize=2, label="reading")
        left.plot(TIMES[::4], other.truth[::4], color=SERIES[0], linewidth=1.0, label="x1, integrated")
        left.plot(TIMES[::4], other.estimate[::4], color=SERIES[1], linewidth=0.8, label="estimate")
        left.set_xlabel("time [s]")
        left.set_ylim(-4, 4)
        for colour, ((name, value), own) in zip(SERIES, other.errors.items(), strict=False):
            right.plot(1e3 * np.array(other.steps), own, ".-", color=colour, linewidth=0.9, label=f"{name}, {value:g}")
        right.set_xscale("log")
        right.set_yscale("log")
        right.set_xticks([1e3 * step for step in other.steps], [f"{1e3 * step:g}" for step in other.steps])
        right.minorticks_off()
        right.set_xlabel("T [ms]")
        _tidy(left, "hard spring, truth by DOP853")
        _tidy(right, "|error of x1| of the jumps after 10 s")
        right.legend(fontsize=7)
        left.legend(fontsize=7, ncols=3, loc="lower left")
        return figure


def _normal_figure(found: Found) -> Figure:
    from plantc.codegen.figures import INK, SERIES, blank, styled
    from scipy.stats import norm

    with styled():
        figure = blank(2.4)
        left, right = figure.subplots(1, 2)
        places = norm.ppf((np.arange(STEPS) + 0.5) / STEPS)
        for colour, known in zip(SERIES, (True, False), strict=False):
            _, truth, estimate = found[_normal_case(known)].first
            error = truth - estimate
            scaled = (error - np.mean(error)) / np.std(error)
            label = "P_0 = 0" if known else "P_0 = I"
            left.hist(scaled, bins=40, range=(-5, 5), density=True, histtype="step", color=colour, label=label)
            right.plot(places[::5], np.sort(scaled)[::5], ".", color=colour, markersize=2, label=label)
        line = np.linspace(-4, 4, 81)
        left.plot(line, norm.pdf(line), color=INK, linewidth=0.8, label="normal")
        right.plot(line, line, color=INK, linewidth=0.8)
        _tidy(left, "error over its deviation, first run")
        _tidy(right, "its quantiles over those of a normal one")
        left.legend(fontsize=7)
        return figure


def _pictures(found: Found, other: OtherTruth) -> list[Picture]:
    springs = {f"h = {h:g}": _compared_gains("spring", h, 1.0, 4.0) for h in TABLES[1].values if h is not None}
    oscillators = {
        f"eps = {e:g}": _compared_gains("van_der_pol", e, 10.0, 25.0) for e in TABLES[5].values if e is not None
    }
    relays = {name.replace("_", " "): _compared_gains(name, 10.0, *FIGURE_NOISES) for name in RELAYS}
    control = {
        name.replace("_", " "): {way: control_case(name, way) for way in (BY_OPEN, BY_CLOSED, BY_STATE)}
        for name in CONTROLLED
    }
    return [
        Picture("spring", "Figs. 6 to 11: the spring, soft, linear and hard",
                "State, readings and both estimates of the first run. The online gain starts right and corrects little; the "
                "Jacobian one is disturbed by its start from P_0 = I.", _tracks(found, springs, 5.0)),
        Picture("van-der-pol", "Figs. 13 to 18: Van der Pol's oscillator",
                "As above. For eps = 2 and 5 the online gain is the noisier one.", _tracks(found, oscillators, 5.0)),
        Picture("relays", "Figs. 19 to 22: both relays",
                "As above, slope 10.", _tracks(found, relays, 2.6, columns=2)),
        Picture("sizes", "Tables 1, 2, 5 and 6: printed and ours",
                "Crosses: printed. Lines and bands: medians, and 10 to 90 % of the runs.", _sizes_figure(found)),
        Picture("truth", "Fig. 12: the truth by another integrator, and the order of the jump simulation",
                "Left: the estimator follows a truth that was not made by jumps. Right: the error of the jumps halves with T.",
                _truth_figure(other)),
        Picture("normality", "Figs. 23 and 24: how normal the error is",
                "With P_0 = 0 the quantiles lie on the line; with P_0 = I the start makes tails.", _normal_figure(found)),
        Picture("control", "Figs. 28 to 35: control by the estimated state",
                "Each estimate is of the loop that it controls; x1 and the readings are those with Phi_OL. Last, x1 of the loop "
                "in which the true state is fed back.",
                _tracks(found, control, 4.2, columns=2)),
    ]  # fmt: skip


# ---------------------------------------------------------------------------------------------------------------------
# The study


def _summary(found: Found, made: Sequence[Comparison]) -> str:
    """Return what the numbers and the verdicts say in short."""
    (headline,) = [item for item in made if item.published.startswith("Conclusion")]
    verdict = {
        "reproduces": "comes out with equal starts too",
        "does not reproduce": "does not come out with equal starts",
    }.get(headline.verdict, "cannot be compared")
    unknown = ekf_ratios(found, False)
    sizes = _printed_ratios(found, (2, 4, 6, 8), (0, 1, 2))
    came = sum(item.verdict == "reproduces" for item in made)
    judged = sum(item.verdict != "cannot be compared" for item in made)
    wrong = sum(item.verdict == "shown wrong" for item in made)
    return (
        f"{came} of {judged} statements come out, and {wrong} cannot be so. The printed errors of the Jacobian estimator are "
        f"{_span(sizes)} times the medians here. The headline, that the online gain, which knows the truth, beats the Jacobian, "
        f"{verdict}: {headline.ours}. The Jacobian estimator is an extended Kalman filter: the usual one's errors are "
        f"{_span(unknown)} times its own with P_0 = I."
    )


def study(
    runs: int = 40,
    seed: int = 2018,
    *,
    on: str | None = None,
    processes: int | None = None,
    progress: Progress | None = None,
) -> StudyResult:
    """Do the whole study.

    Parameters
    ----------
    runs : int
        Of each case.
    seed : int
        Key of the random streams.
    on : str, optional
        Refused: the loops are shared among processes of this machine.
    processes : int, optional
        In how many processes; default one for each core, from 10 runs on. It changes no number.
    progress : callable, optional
        Called with what is done, and how many of how many parts are.

    Raises
    ------
    ModelError
        If a cluster is given.
    """
    if on is not None:
        raise ModelError(f"{NAME}: the cluster {on} is given, but this study runs on this machine only; leave it out")
    tell = progress or (lambda what, done, total: None)
    if processes is None:  # each takes some seconds to start, which a few runs are not worth
        processes = cores() if runs >= 10 else 1
    clock, wanted = {"start": time.perf_counter()}, cases()
    total = len(by_loop(wanted)) + 2
    done = iter(range(1, total))
    tell("compiling", 0, total)
    found, other = run(wanted, runs, seed, processes, lambda what: tell(what, next(done), total))
    clock["derivation, compilation and runs"] = time.perf_counter()
    made = comparisons(found, other)
    models = " ".join(sorted({own.model for own in found.values()}))
    digest = hashlib.sha256(models.encode()).hexdigest()[:16]
    result = StudyResult(NAME, TITLE, SOURCE, digest, _summary(found, made))
    result.conditions = {
        "Runs of each case": runs,
        "Runs of chapter IV": BATCHES * runs,
        "Seed": str(seed),
        "Steps of a run": f"{STEPS}, of {T:g} s",
        "Start": "spring (1.5, 0), Van der Pol (5, 0), relays at rest; the estimate starts at the true state",
        "P_0": "zero for the online gain, the unit matrix for the Jacobian, unless said",
        "Noise": "sigma_w^2 is the variance of the value held over a step; the same random numbers in every case",
        "Diverged": "the loop refused a call, or the mean square error is beyond 1000; counted as infinite",
        "Extended Kalman filter": "Runge-Kutta of fourth order, its Jacobian, w held",
        "Numbers": "medians over the runs, with their 10 and 90 % quantiles; with fewer than 40 runs a verdict may turn by chance",
    }
    result.comparisons = made
    result.tables = _tables(found, other)
    result.pictures = _pictures(found, other)
    clock["page"] = time.perf_counter()
    result.seconds = {b: clock[b] - clock[a] for a, b in pairwise(clock)}
    return result
