"""Output regulation with an observer as exosystem, done again: Meda-Campana et al. (IEEE Access 2023), section IV.

`plantc study regulation2023` runs it. What the paper leaves open is fixed in specs/output_regulation.md: the gain, which stands on
a page that is missing, where the filter starts, and what the high-gain observer knows when. The loops are in `regulation_runs`.
"""

from __future__ import annotations

import hashlib
import tempfile
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import nan
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from plantc.codegen.batch import Batch, batch_text
from plantc.codegen.emit import emit
from plantc.examples import quadrotor_regulator as blocks
from plantc.examples.quadrotor_regulator import T, hover, process_variance, references, sampled, tracks
from plantc.examples.regulation_runs import (
    OUTPUTS,
    STEPS,
    TIMES,
    WANTED,
    Array,
    Flight,
    aim,
    cart_pole_errors,
    disturbance_cases,
    estimate_responses,
    fly,
    gain,
    high_gain_estimates,
    kalman_estimates,
    known_maps,
    known_states,
    maps,
    predicted_amplitudes,
    readings,
    references_text,
    rms,
    wind_errors,
)
from plantc.simulation import Comparison, Picture, StudyResult, StudyTable, compared
from plantc.symbolic import Block, Plant
from plantc.symbolic.composition import connect, wires
from plantc.symbolic.design import closed_loop_eigenvalues
from plantc.symbolic.errors import ModelError
from plantc.symbolic.exosystems import polynomial
from plantc.symbolic.signal_generators import bandwidth, high_gain_matrices, peaking
from plantc.symbolic.simulated import simulated_plant

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Progress = Callable[[str, int, int], None]

NAME = "regulation2023"
TITLE = "Output regulation with a Kalman filter, or a high-gain observer, as the exosystem"
SOURCE = "J. A. Meda-Campana et al., The Output Regulation and the Kalman Filter as the Signal Generator, IEEE Access 11, 2023"

DEGREES = (2, 6)
NOISE = 0.1
VARIANCES = tuple(10.0**k for k in range(-14, -5))
"""D of the sweep."""
WEIGHTS = (1.0, 100.0, 1000.0)
"""q of the gains with which the high-gain observer is flown."""
SEEDS = 3
"""Noisy runs of each case of the high-gain observer, and of each D."""
AMPLITUDES, ORDERS = (0.4, 0.8), (1, 3, 5)


# ---------------------------------------------------------------------------------------------------------------------
# Cases


@dataclass(frozen=True)
class Case:
    """One closed loop.

    Attributes
    ----------
    plant : str
        "euler", "rk4" or "linear"; see `plantc.examples.regulation_runs.moves`.
    generator : str
        "kalman", "high gain", or "known": the exosystem that generates the references exactly.
    degree : int
        Of the Kalman filter's polynomials.
    D : float
        Its process variance.
    q : float
        Weight of the states for the gain.
    warm : bool
        Whether the high-gain observer starts at the true signals and slopes.
    seed : int or None
        Of the noise; None without.
    method : str
        How Pi and Gamma of the known exosystem were made: "euler", "exact" or "continuous".
    """

    plant: str
    generator: str = "kalman"
    degree: int = 6
    D: float = process_variance
    q: float = 100.0
    warm: bool = False
    seed: int | None = None
    method: str = "euler"


@dataclass(frozen=True)
class Run:
    """A case that was run: the flight, and what the generator said the references are (steps, 4)."""

    flight: Flight
    estimate: Array


def cases(runs: int, seed: int) -> list[Case]:
    """Return every case of the study, each once."""
    made = [Case(plant, degree=degree) for plant in ("euler", "rk4", "linear") for degree in DEGREES]
    made += [Case("euler", degree=degree, seed=seed + k) for degree in DEGREES for k in range(runs)]
    drawn = (None, *(seed + k for k in range(SEEDS)))
    made += [Case("euler", degree=degree, D=D, seed=own) for degree in DEGREES for D in VARIANCES for own in drawn]
    made += [
        Case(plant, "high gain", q=q, warm=warm, seed=own)
        for plant in ("linear", "euler") for q in WEIGHTS for warm in (True, False) for own in drawn
    ]  # fmt: skip
    made += [Case("rk4", "high gain", q=100.0), Case("linear", "known"), Case("euler", "known")]
    made += [Case("rk4", "known", method=method) for method in ("euler", "exact", "continuous")]
    return list(dict.fromkeys(made))


def run(wanted: Sequence[Case], progress: Callable[[str], None] = lambda what: None) -> dict[Case, Run]:
    """Run cases: those that share a generator have their estimates together, those of one plant fly together."""
    states: dict[Case, Array] = {}
    for kind in dict.fromkeys((case.generator, case.degree, case.D, case.warm) for case in wanted):
        own = [case for case in wanted if (case.generator, case.degree, case.D, case.warm) == kind]
        if kind[0] == "known":
            states |= dict.fromkeys(own, known_states())
            continue
        seeds = list(dict.fromkeys(case.seed for case in own))
        given = np.stack([readings(0.0 if seed is None else NOISE, seed or 0) for seed in seeds], axis=1)
        found = (
            kalman_estimates(kind[1], given, kind[2])
            if kind[0] == "kalman"
            else high_gain_estimates(given, warm=kind[3])
        )
        states |= {case: found[:, seeds.index(case.seed)] for case in own}
    answer: dict[Case, Run] = {}
    for plant in dict.fromkeys(case.plant for case in wanted):
        progress(f"loops of the plant {plant!r}")
        own = [case for case in wanted if case.plant == plant]
        aims = []
        for case in own:
            if case.generator == "known":
                solution = known_maps(case.method)
                start = solution.state_map @ states[case][0]
            else:
                solution, start = maps(case.degree if case.generator == "kalman" else 1), np.zeros(12)
            aims.append(aim(solution, states[case], gain(case.q), start))
        for case, flight in zip(own, fly(plant, aims), strict=True):
            Q = (known_maps(case.method) if case.generator == "known" else maps(
                case.degree if case.generator == "kalman" else 1)).reference  # fmt: skip
            answer[case] = Run(flight, states[case] @ Q.T)
    return answer


def compiled(
    block: Block, noise: float = 0.0, seed: int = 0, pose: float = 0.0, plant: Plant = sampled, steps: int = STEPS
) -> tuple[Array, str]:
    """Return the outputs (steps, 4) of a regulator and the plant compiled as one loop, and the status that ended it, if one did.

    Parameters
    ----------
    block : Block
        Of `plantc.examples.quadrotor_regulator`.
    noise, seed
        Of the readings.
    pose : float
        Standard deviation of the noise of the vehicle's own position (m) and angles (rad), where they are read.
    plant : Plant
        The vehicle, with the names of the quadrotor's states and inputs, at rest in the same set point.
    steps : int
        How many.
    """
    around = {item.signal.name: hover for item in sampled.inputs}
    truth = simulated_plant(plant, around=around, name="truth")
    states, rotors = [state.signal.name for state in sampled.states], [item.signal.name for item in sampled.inputs]
    own = "estimator" in block.parts
    joined: dict[str, Any] = {f"regulator.feedback_{name}": f"plant.{name}" for name in states if not own}
    joined |= {"regulator.estimator_pose": "plant.pose"} if own else {}
    back = wires("regulator", "plant", rotors, initial={name: hover for name in rotors})
    joined |= {
        target: type(late)(late.source.replace("regulator.", "regulator.feedback."), late.initial)
        for target, late in back.items()
        if not isinstance(late, str)
    }
    loop = connect({"plant": truth, "regulator": block}, joined, "loop")
    batch = Batch(batch_text(loop))
    inputs, given = batch.inputs(steps + 1), readings(noise, seed, steps)
    for k, name in enumerate(references):
        for field in inputs.dtype.names or ():
            if field.startswith(f"regulator_generator_{name}_"):
                inputs[field] = True if "_has_" in field else given[:, k]
    inputs["plant_pose_noise"] = pose * np.random.default_rng([seed, 1]).standard_normal((steps + 1, 6))
    if own:
        inputs["regulator_estimator_has_pose"] = True
    answer = batch.run(inputs)
    found = np.stack([answer.memory["plant"][name] for name in (states[k] for k in OUTPUTS)], axis=1)
    return found, answer.status.name if answer.steps < steps + 1 else ""


# ---------------------------------------------------------------------------------------------------------------------
# What was printed

PRINTED: dict[int, tuple[dict[str, float], dict[str, float]]] = {
    2: (
        {"1,1": 1, "2,2": 1, "3,4": 1, "4,5": 1, "5,7": 1, "6,8": 1, "11,10": 1, "12,11": 1, "9,3": 0.1019,
         "7,6": -0.1019},
        {"1,9": 10.8419, "2,9": 10.8419, "3,9": 10.8419, "4,9": 10.8419, "1,12": 7.5858, "2,12": -7.5858, "3,12": 7.5858,
         "4,12": -7.5858},
    ),
    6: (
        {"1,1": 1, "2,2": 1, "3,8": 1, "4,9": 1, "5,15": 1, "6,16": 1, "11,22": 1, "12,23": 1, "9,3": 0.1019,
         "10,4": 0.1019, "7,10": -0.1019, "8,11": -0.1019},
        {"1,5": -0.0373, "2,5": 0.0373, "3,5": 0.0373, "4,5": -0.0373, "1,12": 0.0373, "2,12": 0.0373, "3,12": -0.0373,
         "4,12": -0.0373, "1,17": 10.8419, "2,17": 10.8419, "3,17": 10.8419, "4,17": 10.8419, "1,24": 7.5858, "2,24": -7.5858,
         "3,24": 7.5858, "4,24": -7.5858},
    ),
    1: ({f"{k},{k}": 1.0 for k in range(1, 7)} | {"11,7": 1.0, "12,8": 1.0}, {}),
}  # fmt: skip
"""Degree -> elements (row,column, from 1) of Pi and Gamma that are not zero, as (112), (113), appendix B and
(104), (105) print them."""


def printed(degree: int) -> tuple[Array, Array]:
    """Return Pi (12, r) and Gamma (4, r) as printed, repaired as the specification says."""
    size = 4 * (degree + 1)
    made = np.zeros((12, size)), np.zeros((4, size))
    for matrix, elements in zip(made, PRINTED[degree], strict=True):
        for place, value in elements.items():
            row, column = map(int, place.split(","))
            matrix[row - 1, column - 1] = value
    return made


def of_maps(degree: int) -> tuple[float, float]:
    """Return the largest difference of our Pi and Gamma from what is printed."""
    Pi, Gamma = printed(degree)
    own = maps(degree)
    return float(np.max(np.abs(own.state_map - Pi))), float(np.max(np.abs(own.input_map - Gamma)))


def _maps_table() -> StudyTable:
    rows: list[tuple[Any, ...]] = []
    for degree in (2, 6, 1):
        own = maps(degree)
        for letter, matrix, elements in zip(
            ("Pi", "Gamma"), (own.state_map, own.input_map), PRINTED[degree], strict=True
        ):
            for place, value in elements.items():
                if abs(value) == 1:
                    continue
                row, column = map(int, place.split(","))
                rows.append((degree, f"{letter}({place})", value, f"{float(matrix[row - 1, column - 1]):.8g}"))
            rest = matrix.copy()
            for place in elements:
                row, column = map(int, place.split(","))
                rest[row - 1, column - 1] = 0
            rows.append(
                (degree, f"{letter}: largest of the others", 0, f"{float(np.max(np.abs(rest), initial=0)):.1e}")
            )
    return StudyTable(
        "maps",
        "The regulator equations: what is printed, and ours",
        ("degree", "element", "printed", "ours"),
        tuple(rows),
        "Elements that are 1 are left out; they are 1. Degree 1 is the high-gain observer's, with the modified equations.",
    )


# ---------------------------------------------------------------------------------------------------------------------
# Tables


def _free_table(found: Mapping[Case, Run]) -> StudyTable:
    rows: list[tuple[Any, ...]] = []
    for degree in DEGREES:
        for plant in ("euler", "rk4", "linear"):
            case = Case(plant, degree=degree)
            flight, estimate = found[case].flight, found[case].estimate
            y, off = flight.rms(WANTED, 60), flight.rms(estimate, 60)
            early, late = rms(estimate - WANTED, 0, 20), rms(estimate - WANTED, 60, 100)
            rows.append((degree, plant, *map(float, (*y[:3], *off[:2], *early[:2], *late[:2]))))
    columns = (
        "degree",
        "plant",
        "x",
        "y",
        "z",
        "x - estimate",
        "y - estimate",
        "KF x, 0-20 s",
        "KF y, 0-20 s",
        "KF x, 60-100 s",
        "KF y, 60-100 s",
    )
    return StudyTable(
        "noise-free",
        "Without noise: root mean square errors (m), 60 to 100 s",
        columns,
        tuple(rows),
        "x, y, z: output less reference; KF: estimated less true reference. rk4 is the truth: commands held, Runge-Kutta.",
    )


def _noisy(found: Mapping[Case, Run], degree: int, seeds: Sequence[int]) -> tuple[Array, Array, Array]:
    """Return (mean, standard deviation over the seeds) of the errors from 20 s on, and the mean of the filter's."""
    own = [found[Case("euler", degree=degree, seed=seed)] for seed in seeds]
    errors = np.array([item.flight.rms(WANTED, 20) for item in own])
    estimates = np.array([rms(item.estimate - WANTED, 20, 100) for item in own])
    return errors.mean(axis=0), errors.std(axis=0, ddof=1 if len(own) > 1 else 0), estimates.mean(axis=0)


def _noisy_table(found: Mapping[Case, Run], seeds: Sequence[int]) -> StudyTable:
    rows: list[tuple[Any, ...]] = []
    for degree in DEGREES:
        mean, spread, estimates = _noisy(found, degree, seeds)
        for k, name in enumerate(references):
            rows.append((degree, name, float(mean[k]), float(spread[k]), float(estimates[k])))
    return StudyTable(
        "noisy",
        f"Readings with noise of standard deviation {NOISE}: root mean square errors, 20 to 100 s",
        ("degree", "output", "error", "spread over the runs", "error of the estimate"),
        tuple(rows),
        f"Means over {len(seeds)} runs; metres, yaw in radians.",
    )


def _sweep(found: Mapping[Case, Run], degree: int, D: float, seed: int) -> tuple[Array, Array]:
    """Return the errors without noise (60 to 100 s), and with (20 to 100 s, mean over some seeds)."""
    free = found[Case("euler", degree=degree, D=D)].flight.rms(WANTED, 60)
    noisy = [found[Case("euler", degree=degree, D=D, seed=seed + k)].flight.rms(WANTED, 20) for k in range(SEEDS)]
    return free, np.mean(noisy, axis=0)


def _sweep_table(found: Mapping[Case, Run], seed: int) -> StudyTable:
    rows: list[tuple[Any, ...]] = []
    for degree in DEGREES:
        for D in VARIANCES:
            free, noisy = _sweep(found, degree, D, seed)
            rows.append((degree, D, bandwidth(T, degree, D, 0.01), *map(float, (free[0], free[1], *noisy))))
    return StudyTable(
        "sweep",
        "The process variance D is a bandwidth",
        ("degree", "D", "bandwidth rad/s", "x, no noise", "y, no noise", "x", "y", "z", "yaw"),
        tuple(rows),
        f"Root mean square errors; with noise means over {SEEDS} runs. The signals are at {np.pi / 20:.3f} and "
        f"{np.pi / 20 + 0.1:.3f} "
        "rad/s.",
    )


def _high_gain_table(found: Mapping[Case, Run], seed: int) -> StudyTable:
    rows: list[tuple[Any, ...]] = []
    for q in WEIGHTS:
        for warm in (True, False):
            for own in (None, *(seed + k for k in range(SEEDS))):
                linear, bent = (
                    found[Case(plant, "high gain", q=q, warm=warm, seed=own)].flight for plant in ("linear", "euler")
                )
                end = "keeps flying" if bent.ended is None else f"lost after {bent.ended:.2f} s"
                errors = map(float, (*linear.rms(WANTED, 20)[:3], *bent.rms(WANTED, 20)[:3]))
                rows.append(
                    (
                        q,
                        "warm" if warm else "cold",
                        "no" if own is None else str(own),
                        *errors,
                        float(np.min(linear.commands)),
                        float(np.max(linear.commands)),
                        end,
                    )
                )
    columns = (
        "q",
        "start",
        "noise",
        "linear x",
        "linear y",
        "linear z",
        "nonlinear x",
        "nonlinear y",
        "nonlinear z",
        "least rotor speed, linear",
        "largest",
        "nonlinear",
    )
    return StudyTable(
        "high-gain",
        "The high-gain observer as exosystem: linear and nonlinear plant",
        columns,
        tuple(rows),
        "Root mean square errors, 20 to 100 s. Noise: its seed. How long a vehicle lives in noise is chaotic; that "
        "it is lost is not.",
    )


def _known_table(found: Mapping[Case, Run]) -> StudyTable:
    rows: list[tuple[Any, ...]] = []
    for plant, method in (
        ("linear", "euler"),
        ("euler", "euler"),
        ("rk4", "euler"),
        ("rk4", "exact"),
        ("rk4", "continuous"),
    ):
        errors = found[Case(plant, "known", method=method)].flight.rms(WANTED, 60)
        rows.append((plant, method, *map(float, errors[:3])))
    return StudyTable(
        "known",
        "Where the exosystem is known: two harmonics, one, and two constants",
        ("plant", "Pi and Gamma of", "x", "y", "z"),
        tuple(rows),
        "Root mean square errors, 60 to 100 s. What is left of z is the tilt, which the linear equations do not "
        "have. For a real plant (rk4) "
        "take the maps of the plant sampled exactly, or the continuous ones.",
    )


def _disturbance_table(seed: int) -> StudyTable:
    rows: list[tuple[Any, ...]] = []
    for name, errors in disturbance_cases(seed).items():
        worst = [float(np.max(np.abs(error[round(40 / T) :]))) for error in errors.values()]
        spread = [float(np.sqrt(np.mean(error[round(20 / T) :] ** 2))) for error in errors.values()]
        rows.append((name, *worst, *spread))
    wind = wind_errors()
    rows.append(("quadrotor, wind of 1 m/s^2 along x", *map(abs, wind.values()), None, None))
    return StudyTable(
        "disturbance",
        "Measured disturbances: with P_d in the regulator equations, and without",
        ("case", "largest with", "largest without", "rms with", "rms without"),
        tuple(rows),
        "Small plant of two states, disturbance also where the input does not reach; largest error after 40 s, rms "
        "from 20 s on; of "
        "the wind the error of x after 40 s, linear plant.",
    )


def _cart_pole_table() -> StudyTable:
    errors = cart_pole_errors(AMPLITUDES, ORDERS)
    rows = tuple((size, *map(float, row)) for size, row in zip(AMPLITUDES, errors, strict=True))
    return StudyTable(
        "cart-pole",
        "The nonlinear regulator equations by power series: a pole on a cart",
        ("amplitude m", "order 1", "order 3", "order 5"),
        rows,
        "Largest error of the position (m) over the last three periods of 30 s; the reference is A sin(2 t).",
    )


def _energy_table(found: Mapping[Case, Run], seed: int) -> StudyTable:
    rows: list[tuple[Any, ...]] = []
    for name, case in (
        ("Kalman filter, degree 2", Case("euler", degree=2)),
        ("Kalman filter, degree 6", Case("euler", degree=6)),
        ("high-gain observer, warm", Case("euler", "high gain", warm=True)),
        ("high-gain observer, linear plant, warm", Case("linear", "high gain", warm=True)),
    ):
        noisy = Case(case.plant, case.generator, case.degree, warm=case.warm, seed=seed)
        flights = found[case].flight, found[noisy].flight
        rows.append(
            (
                name,
                *(item.energy() for item in flights),
                *(
                    float(np.max(np.abs(item.commands[1000:] - hover), initial=0.0)) if item.ended is None else nan
                    for item in flights
                ),
            )
        )
    return StudyTable(
        "energy",
        "Control energy and rotor speeds, q = 100",
        ("generator", "energy, no noise", "energy, noise", "largest |u - u*|, no noise", "largest |u - u*|, noise"),
        tuple(rows),
        "Energy: the integral of |u - u*|^2 from 20 to 100 s, rad^2/s; speeds rad/s, from 20 s on. No number where "
        "the vehicle is lost.",
    )


REGULATORS = {
    "Kalman filter, 28 states": blocks.quadrotor_regulator,
    "Kalman filter in steady state, 28 states": blocks.quadrotor_steady_regulator,
    "high-gain observer, 8 states": blocks.quadrotor_high_gain_regulator,
}


def operations(block: Block) -> dict[str, int]:
    """Return operations of one step of a regulator in which every reading comes, counted in the emitted C, by kind."""
    text, total = emit(block, "float"), dict.fromkeys(("addition", "multiplication", "division"), 0)
    for entry, counts in text.operations.items():
        last = entry.split(".")[-1]
        if last in ("init", "inflate"):
            continue
        for kind in total:
            total[kind] += counts.get(kind, 0)
    return total


def _cost_table() -> StudyTable:
    rows: list[tuple[Any, ...]] = []
    for name, block in REGULATORS.items():
        counts = operations(block)
        memory = sum(signal.size for signal in block.memory_signals_flat())
        rows.append((name, memory, *counts.values()))
    return StudyTable(
        "cost",
        "What one step costs: numbers in memory, and operations in the emitted C",
        ("exosystem", "memory", "additions", "multiplications", "divisions"),
        tuple(rows),
        "Float, all numbers of the design folded into the C; comparisons, loads and stores are not counted.",
    )


def _target_table() -> StudyTable | None:
    """Count on a Cortex-M4 in the emulator, if compiler and emulator are there."""
    from plantc.codegen.emulator import Call, TargetView
    from plantc.codegen.targets import TARGETS, Sizes, TargetError, linked_library

    rows: list[tuple[Any, ...]] = []
    for name, block in REGULATORS.items():
        try:
            view = TargetView(block, "float", TARGETS["cortex-m4"])
        except TargetError:
            return None
        params, calls = view.params(), []
        given = readings()[:20]
        calls.append(Call("init", view.inputs("init", {}), view.memory(), params))
        for row in given:
            inputs = dict.fromkeys((item.name for item in block.entries["step"].inputs), 0.0)
            for field in inputs:
                for k, signal in enumerate(references):
                    if field.startswith(f"generator_{signal}_"):
                        inputs[field] = 1.0 if "_has_" in field else float(np.clip(0.1 * row[k], -1, 1))
            calls.append(Call("step", view.inputs("step", inputs)))
        answers = view.calls(calls)
        if any(answer.status < 0 for answer in answers):
            raise ValueError(f"{block.name}: the target refused a step of the study")
        with tempfile.TemporaryDirectory() as folder:
            sizes = Sizes.of(linked_library(view.toolchain, view.text, list(block.entries), Path(folder)))
        assert sizes is not None
        rows.append((name, max(item.instructions for item in view.last[1:]), sizes.text))
    return StudyTable(
        "target",
        "The same on a Cortex-M4, float, gcc -O2",
        ("exosystem", "instructions of a step", "bytes of text"),
        tuple(rows),
        "In the emulator, with this machine's compiler, the most of 20 steps in which every reading comes; text "
        "with the functions it calls.",
        measured=True,
    )


# ---------------------------------------------------------------------------------------------------------------------
# Comparisons


def _of_equations() -> list[Comparison]:
    names = {2: "eqs. (112), (113)", 6: "appendix B", 1: "eqs. (104), (105), of the high-gain observer"}
    made = [
        compared(
            "the quadrotor hovers at 212.72 rad/s",
            f"{hover:.10g}",
            round(hover, 2) == 212.72,
            [hover],
            "Rounded: 10.8419 and 7.5858 in Gamma need all digits.",
        )
    ]
    for degree, where in names.items():
        Pi, Gamma = of_maps(degree)
        made.append(
            compared(
                f"{where}: Pi and Gamma for degree {degree}",
                f"largest difference {Pi:.1e} in Pi, {Gamma:.1e} in Gamma",
                max(Pi, Gamma) < 1e-4,
                [Pi, Gamma],
                "Where the print has lost a row or broken a matrix in two, that is repaired; "
                + (
                    "it needs the modified equations, Pi (S + S_H Q)."
                    if degree == 1
                    else "all other elements are zero."
                ),
            )
        )
    made.append(
        Comparison(
            "appendix A: the gain K",
            f"ours: linear-quadratic, radius {radius(100.0):.8f}",
            "cannot be compared",
            "The page with A, B, C and K is missing from the source. A and B follow from the model, K does not.",
        )
    )
    return made


def radius(q: float) -> float:
    """Return the spectral radius of the loop with the gain of weight q."""
    from plantc.examples.quadrotor_regulator import near

    return float(np.max(np.abs(closed_loop_eigenvalues(near.A, near.B, gain(q)))))


def _of_signals() -> list[Comparison]:
    """Compare what is said of exosystems and of the filter's set-up."""
    coefficients, steps = (0.7, -1.2, 0.5, 0.3), np.arange(400)
    euler = polynomial("x", 3).sampled(T, "euler")
    true = np.polynomial.polynomial.polyval(T * steps, coefficients)
    derivatives = np.array([0.7, -1.2, 1.0, 1.8])
    missed = float(np.max(np.abs(euler.run(derivatives, 399)[:, 0] - true)))
    repaired = float(np.max(np.abs(euler.run(euler.initial(coefficients), 399)[:, 0] - true)))
    half = tracks(2).matrix[:6, :6], np.eye(6)[:1], np.eye(6)[[0, 3]]
    ranks = [
        int(np.linalg.matrix_rank(np.vstack([Q @ np.linalg.matrix_power(half[0], k) for k in range(6)])))
        for Q in half[1:]
    ]
    S, _ = high_gain_matrices(2, (1.0, 1.0), T, T)
    size = float(np.max(np.abs(np.linalg.eigvals(S))))

    return [
        compared(
            "theorem 2.3 with eqs. (27) and (46): the polynomial is described exactly",
            f"a cubic, 8 s: largest error {missed:.3f} with w(0) of (27), {repaired:.0e} with forward differences",
            missed < 1e-6,
            [missed],
            "Euler generates the same sampled polynomials, but its states are forward differences, not derivatives.",
            otherwise="shown wrong",
        ),
        compared(
            "after eq. (62): the filter measures with Q = [Q_ref, 0]",
            f"of two signals of degree 2 {ranks[0]} of 6 states are observable, {ranks[1]} with all rows",
            ranks[0] == 6,
            ranks,
            "Disturbances have to be rows of the filter's Q; zero columns belong into the regulator equations only.",
            otherwise="shown wrong",
        ),
        compared(
            "section IV: the observer has a_1 = a_2 = 1",
            f"its eigenvalues then have modulus {size:.6f}",
            size < 1 - 1e-9,
            [size],
            "The printed matrices (101), (102) are those of a_1 = 2, a_2 = 1: deadbeat after two readings.",
            otherwise="shown wrong",
        ),
    ]


def _of_kalman(found: Mapping[Case, Run], seeds: Sequence[int]) -> list[Comparison]:
    """Compare what is said of the Kalman filter as exosystem."""
    two, six = (found[Case("euler", degree=degree)] for degree in DEGREES)
    noisy = [_noisy(found, degree, seeds)[0] for degree in DEGREES]
    ratio = noisy[0] / noisy[1]
    late, middle = rms(two.estimate - WANTED, 60, 100), rms(two.estimate - WANTED, 20, 40)
    share = rms(six.estimate - WANTED, 60, 100)[:2] / rms(WANTED, 60, 100)[:2]
    low, high = six.flight.rms(WANTED, 60), found[Case("euler", degree=6, D=1e-8)].flight.rms(WANTED, 60)
    few, many = (_sweep(found, 6, D, seeds[0])[1] for D in (1e-12, 1e-8))
    early, lag = rms(two.estimate - WANTED, 0, 20), -np.degrees(np.angle(estimate_responses(2)))
    off, (slow, fast) = abs(1 - estimate_responses(6)), predicted_amplitudes(6)
    return [
        compared(
            "section IV: regulation with filters of degree 6 is better than with degree 2",
            f"errors {ratio[0]:.3g} (x) and {ratio[1]:.3g} (y) times smaller, with noise",
            bool(np.all(ratio[:2] > 1)),
            ratio[:2],
        ),
        compared(
            "Fig. 3: for degree 2 the estimates diverge from the signals",
            f"error of x {early[0]:.3g} m up to 20 s, {middle[0]:.3g} m up to 40 s, {late[0]:.3g} m from 60 to 100 s",
            middle[0] > 2 * early[0],
            [middle[0], early[0]],
            "They depart, and do not run away: both frequencies lie beyond the filter's bandwidth, "
            f"{bandwidth(T, 2, process_variance, 0.01):.2g} "
            f"rad/s, so that the estimates lag by {lag[0]:.0f} and {lag[1]:.0f} degrees, for good. The cause is D as "
            "much as the degree.",
        ),
        compared(
            "Fig. 10: for degree 6 the estimate of psi_2 is very close",
            f"rms of the error {share[1]:.2%} of the signal",
            share[1] < 0.01,
            [share[1]],
        ),
        compared(
            "Fig. 10: for degree 6 the estimate of psi_1 is very close",
            f"rms of the error {share[0]:.1%} of the signal; that of the output {low[0]:.3g} m",
            share[0] < 0.01,
            [share[0]],
            f"Its faster part is {off[1]:.0%} off, which the loop makes an error of {fast:.3g} m (of the slower, "
            f"{slow:.2g} m): Pi and "
            "Gamma pass derivatives on, which jump with every innovation.",
        ),
        compared(
            "eq. (98): the process noise is neglected, D = 1e-12",
            f"D = 1e-8: the error of x falls from {low[0]:.3g} to {high[0]:.3g} m without noise, from {few[0]:.3g} to "
            f"{many[0]:.3g} m with",
            high[0] > 0.5 * low[0],
            [high[0], low[0]],
            "D is no noise here: it sets the bandwidth, (D/(T^2 M))^(1/(2 (degree + 1))).",
            otherwise="shown wrong",
        ),
    ]


def _of_high_gain(found: Mapping[Case, Run], seed: int) -> list[Comparison]:
    """Compare what is said of the high-gain observer as exosystem."""

    def of(plant: str, q: float, *, warm: bool, noisy: bool) -> list[Flight]:
        drawn = [seed + k for k in range(SEEDS)] if noisy else [None]
        return [found[Case(plant, "high gain", q=q, warm=warm, seed=own)].flight for own in drawn]

    linear = of("linear", 100.0, warm=False, noisy=True)
    lost = of("euler", 100.0, warm=False, noisy=True)
    still = of("euler", 100.0, warm=False, noisy=False)[0]
    gentle = of("euler", 1.0, warm=True, noisy=True)
    flying = [item for item in gentle if item.ended is None]
    bias = sum(float(item.states[1000:, 4].mean()) - 5 for item in flying) / max(1, len(flying))
    S, gains = high_gain_matrices(2, (2.0, 1.0), T, T)
    peak = peaking(S, gains)
    alive = all(item.ended is None for item in linear)
    energy = [found[Case("euler", seed=seed)].flight.energy(), linear[0].energy()]
    return [
        compared(
            "Figs. 17 to 23: with high-gain observers the linear plant is regulated, in noise too",
            f"{sum(item.ended is None for item in linear)} of {SEEDS} runs, error of x {linear[0].rms(WANTED, 20)[0]:.3g} m",
            alive,
            [len(linear)],
            f"At the price of rotor speeds from {min(float(item.commands.min()) for item in linear):.0f} to "
            f"{max(float(item.commands.max()) for item in linear):.0f} rad/s.",
        ),
        compared(
            "Remark 2: the nonlinear plant becomes unstable",
            f"q = 100, cold start: {sum(item.ended is not None for item in lost)} of {SEEDS} runs are lost",
            all(item.ended is not None for item in lost),
            [energy[0]],  # none where the Kalman filter loses the vehicle too: then it is not the high gain
            f"Not with a gentle gain: with q = 1 {len(flying)} of {SEEDS} keep flying, "
            f"{bias:+.1f} m too high, since the mean of u^2 grows with the noise of u."
            if flying
            else "",
        ),
        compared(
            "Remark 2: it becomes unstable because a significant part of the noise is transmitted",
            "without any noise: " + ("keeps flying" if still.ended is None else f"lost after {still.ended:.2f} s"),
            still.ended is None,
            [found[Case("euler")].flight.energy()],
            f"From a cold start it peaks: a signal of 1 makes a velocity of {peak[1]:.0f} in one step. From a warm one "
            "noise is the cause.",
            otherwise="shown wrong",
        ),
        compared(
            "section IV, end: a disadvantage may be the energy consumption",
            f"{energy[1] / energy[0]:.1e} times that of the Kalman filter of degree 6, in noise",
            energy[1] > energy[0],
            energy,
        ),
    ]


def _left_open(estimated: StudyTable) -> list[Comparison]:
    counts = {name: sum(operations(block).values()) for name, block in REGULATORS.items()}
    (_, kalman), (_, steady), (_, simple) = counts.items()
    x, y = ({row[0]: row[column] for row in estimated.rows} for column in (1, 2))
    undone = [float(np.max(np.abs(error[2000:]))) for error in disturbance_cases()["known harmonics"].values()]
    return [
        Comparison(
            "section IV, end: a comparison of the complexity of both is left for future work",
            f"operations of a step: {kalman} with the Kalman filter, {steady} with its steady state, {simple} with the "
            "high-gain observer",
            "cannot be compared",
            f"The covariance is {1 - steady / kalman:.0%} of what the Kalman filter costs.",
        ),
        Comparison(
            "Remark 1: the states are taken as available; an estimator would be needed",
            f"with one, readings of 0.01 m and rad: error of y {y[0.01]:.3g} m, {y[0.0]:.3g} m without noise",
            "cannot be compared",
            f"The paper shows no run with one. The error of x, which the exosystem misses, is {x[0.01]:.3g} m with the noise and "
            f"{x[0.0]:.3g} m without.",
        ),
        Comparison(
            "section III: measured disturbances are undone",
            f"small plant, known harmonics: error {undone[0]:.0e} with P_d, {undone[1]:.3g} without",
            "cannot be compared",
            "The paper formulates it and shows no run; P_d has to be E Q_dis, n x r, not n x d.",
        ),
    ]


# ---------------------------------------------------------------------------------------------------------------------
# Figures


def _tidy(axes: Any, title: str) -> None:
    from plantc.codegen.figures import INK, MUTED

    axes.set_title(title, loc="left", fontsize=8, color=INK)
    axes.tick_params(length=0, labelcolor=MUTED)
    axes.grid(axis="y")
    axes.locator_params(axis="y", nbins=5) if axes.get_yscale() == "linear" else None


def _tracking_figure(found: Mapping[Case, Run], seed: int) -> Figure:
    from plantc.codegen.figures import SERIES, blank, styled

    with styled():
        figure = blank(4.0)
        grid = figure.subplots(2, 2, sharex=True)
        for row, degree in zip(grid, DEGREES, strict=True):
            own = found[Case("euler", degree=degree, seed=seed)]
            for k, axes in enumerate(row):
                drawn = (
                    ("reference", WANTED[:, k]),
                    ("estimate", own.estimate[:, k]),
                    ("output", own.flight.states[:, OUTPUTS[k]]),
                )
                for colour, (label, values) in zip(SERIES, drawn, strict=False):
                    first = label if degree == DEGREES[0] and k == 0 else None
                    axes.plot(TIMES[::20], values[::20], color=colour, linewidth=0.9, label=first)
                _tidy(axes, f"{references[k]} [m], degree {degree}")
        for axes in grid[-1]:
            axes.set_xlabel("time [s]")
        figure.legend(loc="outside upper left", ncols=3, handlelength=1.2)
        return figure


def _sweep_figure(found: Mapping[Case, Run], seed: int) -> Figure:
    from plantc.codegen.figures import SERIES, blank, styled

    with styled():
        figure = blank(2.3)
        grid = figure.subplots(1, 2, sharex=True)
        for k, axes in enumerate(grid):
            lines = [(degree, noisy) for degree in DEGREES for noisy in (0, 1)]
            for colour, (degree, noisy) in zip(SERIES, lines, strict=False):
                values = [_sweep(found, degree, D, seed)[noisy][k] for D in VARIANCES]
                label = f"degree {degree}{', noise' if noisy else ''}" if k == 0 else None
                axes.plot(VARIANCES, values, ".-", color=colour, linewidth=0.9, markersize=4, label=label)
            axes.set_xscale("log")
            axes.set_yscale("log")
            axes.minorticks_off()
            axes.set_xlabel("D")
            _tidy(axes, f"error of {references[k]} [m]")
        figure.legend(loc="outside upper left", ncols=4, handlelength=1.2)
        return figure


def _high_gain_figure(found: Mapping[Case, Run], seed: int) -> Figure:
    from plantc.codegen.figures import SERIES, blank, styled

    with styled():
        figure = blank(2.3)
        left, right = figure.subplots(1, 2)
        for colour, (label, case) in zip(
            SERIES,
            (
                ("Kalman filter", Case("euler", seed=seed)),
                ("high gain, q = 1", Case("euler", "high gain", q=1.0, warm=True, seed=seed)),
                ("high gain, q = 100", Case("euler", "high gain", warm=True, seed=seed)),
            ),
            strict=False,
        ):
            flight = found[case].flight
            t = T * np.arange(len(flight.states))
            left.plot(t[::10], flight.states[::10, 4], color=colour, linewidth=0.8, label=label)
            right.plot(t[:250], flight.commands[:250, 0], color=colour, linewidth=0.7)
        left.set_ylim(-5, 20)
        _tidy(left, "altitude [m], nonlinear plant; reference 5")
        _tidy(right, "first rotor [rad/s], first 5 s")
        for axes in (left, right):
            axes.set_xlabel("time [s]")
        figure.legend(loc="outside upper left", ncols=3, handlelength=1.2)
        return figure


def _disturbance_figure(seed: int) -> Figure:
    from plantc.codegen.figures import SERIES, blank, styled

    shown = disturbance_cases(seed)
    with styled():
        figure = blank(2.2)
        grid = figure.subplots(1, 2)
        for axes, name in zip(grid, ("known harmonics", "noisy sinusoids, degree 4, D = 1e-2"), strict=True):
            for colour, (label, error) in zip(SERIES, shown[name].items(), strict=False):
                first = label if axes is grid[0] else None
                axes.plot(T * np.arange(len(error))[::10], error[::10], color=colour, linewidth=0.8, label=first)
            _tidy(axes, f"error, {name}")
            axes.set_xlabel("time [s]")
        figure.legend(loc="outside upper left", ncols=2, handlelength=1.2)
        return figure


def _pictures(found: Mapping[Case, Run], seed: int) -> list[Picture]:
    return [
        Picture(
            "tracking",
            "Figs. 3 to 16: x and y with Kalman filters of degree 2 and 6",
            f"Reference, what the filter says of it, and the output, noise of run {seed}. With degree 2 both lag; with degree 6 y "
            "is followed, and the output swings beyond the estimate of x.",
            _tracking_figure(found, seed),
        ),
        Picture(
            "sweep",
            "The error over the process variance D",
            "Without noise the error falls with D until the tilt is left; with noise there is a best D.",
            _sweep_figure(found, seed),
        ),
        Picture(
            "high-gain",
            "The high-gain observer on the nonlinear plant, warm start, with noise",
            "Left: with a gentle gain the vehicle flies metres too high; with q = 100 it is lost sooner or later. "
            "Right: what the rotors are "
            "asked for.",
            _high_gain_figure(found, seed),
        ),
        Picture(
            "disturbance",
            "A measured disturbance, with P_d in the regulator equations and without",
            "The disturbance is in the exosystem in both; what differs are Pi and Gamma.",
            _disturbance_figure(0),
        ),
    ]


# ---------------------------------------------------------------------------------------------------------------------
# The study


POSES = (0.0, 0.003, 0.01, 0.03)
"""Standard deviations of what an estimator in front reads."""


def _estimator_table() -> StudyTable:
    """Fly with an estimator of the vehicle's own state in front (Remark 1), compiled."""
    block = blocks.estimated_regulator(6, "estimated_regulator")
    rows: list[tuple[Any, ...]] = []
    for pose in POSES:
        outputs, refused = compiled(block, pose=pose)
        errors = [nan] * 4 if refused else map(float, rms(outputs - WANTED, 60, 100))
        rows.append((pose, *errors, f"refused: {refused}" if refused else ""))
    return StudyTable(
        "estimator",
        "Remark 1: an extended Kalman filter of the vehicle's own state in front",
        ("noise of the pose", *references, "end"),
        tuple(rows),
        "Degree 6, readings of the references without noise, position and angles of the vehicle read with noise (m, rad); "
        "the filter believes 0.01. Root mean square errors, 60 to 100 s; compiled.",
    )


def _compiled_table(found: Mapping[Case, Run]) -> StudyTable:
    rows: list[tuple[Any, ...]] = []
    for name, block, case in (
        ("Kalman filter", blocks.quadrotor_regulator, Case("euler")),
        ("high-gain observer, cold", blocks.quadrotor_high_gain_regulator, Case("euler", "high gain")),
    ):
        outputs, refused = compiled(block)
        flight = found[case].flight
        if refused:
            rows.append(
                (
                    name,
                    None,
                    None,
                    f"refused after {T * len(outputs):.2f} s: {refused}",
                    "keeps flying" if flight.ended is None else f"lost after {flight.ended:.2f} s",
                )
            )
            continue
        errors = rms(outputs - WANTED, 60, 100)
        rows.append(
            (
                name,
                float(errors[0]),
                float(errors[1]),
                "",
                f"{flight.rms(WANTED, 60)[0]:.4g}, {flight.rms(WANTED, 60)[1]:.4g}",
            )
        )
    return StudyTable(
        "compiled",
        "The exported regulator and the plant, compiled as one loop, without noise",
        ("exosystem", "x", "y", "end", "x, y of the plain loop"),
        tuple(rows),
        "Root mean square errors, 60 to 100 s. The Block predicts before its first reading; that is gone after "
        "seconds. It refuses a "
        "command beyond the range of the rotors where the plain loop, which has no ranges, goes on until a state is beyond 1e4.",
    )


def _summary(found: Mapping[Case, Run], seeds: Sequence[int]) -> str:
    two, six = (_noisy(found, degree, seeds)[0] for degree in DEGREES)
    still = found[Case("euler", "high gain")].flight.ended
    off = abs(1 - estimate_responses(6)[1])
    same = max(max(of_maps(degree)) for degree in (1, 2, 6)) < 1e-4
    return " ".join(
        (
            f"The printed Pi and Gamma {'come' if same else 'do not come'} out, repaired where the print is broken.",
            f"With noise, filters of degree 6 leave {six[0]:.3g} m (x) and {six[1]:.3g} m (y), those of degree 2 {two[0]:.3g} and "
            f"{two[1]:.3g} m.",
            f"The faster part of x is estimated {off:.0%} wrong, which the loop amplifies; the variance that the paper "
            "neglects sets the "
            "bandwidth.",
            "The high-gain observer "
            + (
                f"wrecks the nonlinear plant from a cold start even without noise, within {still:.2f} s."
                if still is not None
                else "keeps the nonlinear plant flying."
            ),
        )
    )


def study(runs: int = 20, seed: int = 2018, *, on: str | None = None, progress: Progress | None = None) -> StudyResult:
    """Do the whole study.

    Parameters
    ----------
    runs : int
        Noisy runs for each degree, with seeds ``seed``, ``seed + 1``, ...
    seed : int
        Of the first one.
    on : str, optional
        Refused: all loops fly side by side in this process.
    progress : callable, optional
        Called with what is done, and how many of how many parts are.

    Raises
    ------
    ModelError
        If a cluster is given.
    """
    if on is not None:
        raise ModelError(f"{NAME}: the cluster {on} is given, but this study runs in this process only; leave it out")
    tell = progress or (lambda what, done, total: None)
    clock, seeds = {"start": time.perf_counter()}, [seed + k for k in range(runs)]
    total = 6
    tell("estimates", 0, total)
    done = iter(range(1, total))
    found = run(cases(runs, seed), lambda what: tell(what, next(done), total))
    clock["loops"] = time.perf_counter()
    tell("compiled loops", 4, total)
    exported, estimated = _compiled_table(found), _estimator_table()
    clock["compiled loops"] = time.perf_counter()
    tell("figures", 5, total)
    digest = " ".join(block.model_hash() for block in REGULATORS.values())
    result = StudyResult(NAME, TITLE, SOURCE, hashlib.sha256(digest.encode()).hexdigest()[:16], _summary(found, seeds))
    result.conditions = {
        "References": references_text(),
        "Noisy runs of each degree": runs,
        "Seed": str(seed),
        "Steps of a run": f"{STEPS}, of {T:g} s",
        "Gain": f"linear-quadratic on the sampled linearisation, q = 100 unless said: radius {radius(100.0):.6f}",
        "Filter": "D = 1e-12, M = 0.01, w = 0 and P = I before the first reading, which corrects without a prediction",
        "High-gain observer": "a = (2, 1), epsilon = T; the loop uses what it knew before the reading",
        "Lost": "a state beyond 1e4",
    }
    result.comparisons = [
        *_of_equations(),
        *_of_signals(),
        *_of_kalman(found, seeds),
        *_of_high_gain(found, seed),
        *_left_open(estimated),
    ]
    target = _target_table()
    result.tables = [
        _maps_table(),
        _free_table(found),
        _noisy_table(found, seeds),
        _sweep_table(found, seed),
        _known_table(found),
        _high_gain_table(found, seed),
        _energy_table(found, seed),
        _disturbance_table(0),
        _cart_pole_table(),
        _cost_table(),
        *([target] if target else []),
        exported,
        estimated,
    ]
    result.pictures = _pictures(found, seed)
    clock["page"] = time.perf_counter()
    result.seconds = {b: clock[b] - clock[a] for a, b in pairwise(clock)}
    return result
