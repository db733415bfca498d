"""Four estimators in the loop of a quadrotor, done again: Meda-Campana (IEEE Access 2018), section IV, its Figs. 2-4 and Table 1.

`plantc study meda2018` runs it. What the paper leaves open is fixed in specs/meda2018.md: the order of the loop (section 7),
the protocols A, B, C and M (section 8) and the metrics (section 9). What does not come out as printed is said on the page,
with the cause.
"""

from __future__ import annotations

import hashlib
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, partial
from itertools import pairwise
from math import exp, nan, pi
from typing import TYPE_CHECKING, Any

import casadi as ca
import numpy as np
from plantc.codegen.batch import Batch, batch_text
from plantc.examples.quadrotor_controllers import printed_gain
from plantc.examples.quadrotor_ekf import hover, quadrotor
from plantc.simulation import (
    ClosedLoop,
    Comparison,
    History,
    Picture,
    Result,
    Start,
    StudyResult,
    StudyTable,
    closed_loop,
    compared,
    connected,
    each,
    judge,
    monte_carlo,
    replay,
    stream,
)
from plantc.simulation.monte_carlo import cores
from plantc.symbolic import Block, Plant, vertcat
from plantc.symbolic.analysis import linearise
from plantc.symbolic.composition import connect, wires
from plantc.symbolic.controllers import state_feedback
from plantc.symbolic.design import Gain, closed_loop_eigenvalues, place, place_chains
from plantc.symbolic.estimators import extended_kalman_filter, kalman_filter
from plantc.symbolic.james_stein import james_stein_estimator
from plantc.symbolic.plant import LOWEST_VARIANCE, Symbol

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Progress = Callable[[str, int, int], None]

NAME = "meda2018"
TITLE = "Kalman and James-Stein estimators in the loop of a quadrotor"
SOURCE = (
    "J. A. Meda-Campana, On the Estimation and Control of Nonlinear Systems With Parametric Uncertainties and Noisy "
    "Outputs, IEEE Access 2018, doi 10.1109/ACCESS.2018.2846483"
)

STEPS, GAMMA = 2000, 0.15
ESTIMATORS = ("KF", "EKF", "JSSE", "JSSE-M")
NOISES = (0.01, 0.02, 0.05, 0.08, 0.1, 0.12, 0.15, 0.2, 0.3, 0.5, 1.0)
GAMMAS = (0.0, 0.005, 0.01, 0.015, 0.02, 0.03, 0.04, 0.06, 0.1, 0.15)
LIMITS = {"x": 10.0, "y": 10.0, "z": 10.0, "roll": pi / 2, "pitch": pi / 2}
TINY = (0.01, 0.05, 0.1)
POLES = np.arange(84, 96) / 100
TABLE_1 = {"KF": 0.15871633, "EKF": 0.86501887, "JSSE": 0.26077425, "JSSE-M": 0.2632239}
MIX = np.array([[1, 1, 1, 1], [-1, -1, 1, 1], [-1, 1, 1, -1], [1, -1, 1, -1]])
PROTOCOLS = {
    "A": "x_0 = x_o + U(-0.1, 0.1) in all states; the estimate starts at x_o with P_0 = (0.1^2/3) I",
    "B": f"as A, but the estimate starts at x_0 with P_0 = 0 (here {LOWEST_VARIANCE:g} I, the least that a filter "
    "takes)",
    "C": "as B, and the process noise has standard deviation q^2 = 1e-6 (the paper's eqs. 36, 37 taken literally: it is "
    "scaled twice), while the filters believe q = 0.001",
    "M": "as A, but the mass is 1.05 kg, and estimators, controller and hover speed are made for 1 kg",
}
CERTAIN = LOWEST_VARIANCE
"""Variance of an initial error that is zero: the smallest that a filter takes, a millionth of one step's noise."""

# ---------------------------------------------------------------------------------------------------------------------
# The loops


def _value(constant: Symbol) -> float:
    (value,) = constant.signal.default or ()
    return value


def _quadrotor(name: str, *, weighed: bool) -> Plant:
    """Return the sampled quadrotor with ranges wide enough for runs that are lost by kilometres.

    Parameters
    ----------
    name : str
        Of the plant.
    weighed : bool
        Whether the mass is a parameter (the truth), or the constant 1 kg (what an estimator believes).
    """
    plant = Plant(name, doc=quadrotor.doc)
    far = 2.0e6  # a run counts as diverged from 1e6 on
    states = [
        plant.state(state.signal.name, unit=state.signal.unit, range=(-far, far), doc=state.signal.doc)
        for state in quadrotor.states
    ]
    rotors = [plant.input(rotor.signal.name, unit=rotor.signal.unit, range=(-1e9, 1e9)) for rotor in quadrotor.inputs]
    before, after = [quadrotor.x, quadrotor.u], [vertcat(*states), vertcat(*rotors)]
    for constant in quadrotor.constants:
        signal = constant.signal
        before.append(constant)
        if weighed and signal.name == "mass":
            after.append(plant.parameter("mass", _value(constant), unit=signal.unit, range=(0.5, 2.0)))
        else:
            after.append(plant.constant(signal.name, _value(constant), unit=signal.unit))
    rates = ca.substitute(quadrotor.dynamics_expression(fold=False), vertcat(*before), vertcat(*after))
    plant.dynamics({state: rates[i] for i, state in enumerate(states)})
    plant.sensor("pose", vertcat(*states), variance=0.1**2)
    return plant.discretise("euler", dt=1 / 40).step_noise({state: 1e-6 for state in states})


@cache
def believed() -> Plant:
    """Return the quadrotor that estimators and controller are made for."""
    return _quadrotor("quadrotor", weighed=False)


@cache
def truth() -> Plant:
    """Return the quadrotor that is flown; its mass is a parameter."""
    return _quadrotor("quadrotor", weighed=True)


SET_POINT = {"z": 30.0, **{f"rotor_{k}": hover for k in (1, 2, 3, 4)}}
STATES = tuple(state.signal.name for state in quadrotor.states)


@cache
def estimator(which: str) -> Block:
    """Return "KF", "EKF", "JSSE" or "JSSE-M"; there is no gate."""
    plant, certain = believed(), dict.fromkeys(STATES, 0.1**2 / 3)
    if which == "KF":
        return kalman_filter(plant, at=SET_POINT, initial_variance=certain)
    if which == "EKF":
        return extended_kalman_filter(plant, around=SET_POINT, initial_variance=certain)
    return james_stein_estimator(plant, around=SET_POINT, gamma=GAMMA if which == "JSSE-M" else None)


@cache
def decoupled_gain() -> Gain:
    """Return the one gain that places the paper's eigenvalues on four chains: altitude, roll, pitch, yaw."""
    chains = {
        "thrust": (("z", "vz"), (0.86, 0.93)),
        "roll": (("y", "vy", "roll", "roll_rate"), (0.85, 0.87, 0.91, 0.94)),
        "pitch": (("x", "vx", "pitch", "pitch_rate"), (0.84, 0.88, 0.92, 0.95)),
        "yaw": (("yaw", "yaw_rate"), (0.89, 0.90)),
    }
    return place_chains(linearise(believed(), SET_POINT), chains, mix=MIX)


@cache
def loop(which: str) -> ClosedLoop:
    """Return the quadrotor with an estimator and the printed state feedback; noise, gain and mass are parameters."""
    plant = believed()
    controller = connect(
        {"estimator": estimator(which), "feedback": state_feedback(plant, SET_POINT, printed_gain)},
        wires("estimator", "feedback", plant.states) | wires("feedback", "estimator", plant.inputs, initial=SET_POINT),
        "controller",
    )
    return closed_loop(truth(), controller, SET_POINT, name=f"loop_{which.lower().replace('-', '')}")


# ---------------------------------------------------------------------------------------------------------------------
# Cases


@dataclass(frozen=True)
class Case:
    """One set of runs.

    Attributes
    ----------
    estimator : str
        One of `ESTIMATORS`, or "none": the reading itself is fed back.
    r : float
        Standard deviation of the measurement noise of each state.
    protocol : str
        A key of `PROTOCOLS`.
    gain : str
        "printed" (eq. 44) or "decoupled".
    gamma : float
        Of JSSE-M.
    """

    estimator: str
    r: float
    protocol: str = "A"
    gain: str = "printed"
    gamma: float = GAMMA

    def loop(self) -> ClosedLoop:
        """Return the closed loop; without an estimator it is that of JSSE for r = 0, whose weight on the reading is 1."""
        return loop("JSSE" if self.estimator == "none" else self.estimator)

    def settings(self) -> dict[str, Any]:
        """Return what `monte_carlo` is told beside the loop, the runs and the seed."""
        params: dict[str, Any] = {}
        if self.estimator in ("KF", "EKF"):
            params["controller.estimator.variance_pose"] = np.full(len(STATES), self.r**2)
            if self.protocol in "BC":
                params |= {f"controller.estimator.variance_{name}_0": CERTAIN for name in STATES}
        else:
            params["controller.estimator.std_pose"] = 0.0 if self.estimator == "none" else self.r
        if self.estimator == "JSSE-M":
            params["controller.estimator.gamma_pose"] = self.gamma
        if self.gain == "decoupled":
            params["controller.feedback.gain"] = decoupled_gain().rounded().ravel()
        if self.protocol == "M":
            params["plant.mass"] = 1.05
        std = {"pose_noise": self.r}
        if self.protocol == "C":
            std |= {f"{name}_noise": 1e-6 for name in STATES}
        return {"start": Start(0.1, known=self.protocol in "BC"), "std": std, "params": params}


def evaluate(case: Case, runs: int, seed: int, *, on: str | None = None, jobs: int | None = None) -> Result:
    """Run a case.

    Parameters
    ----------
    case : Case
        What is run; cases of one seed meet the same noise, but for its strength.
    runs, seed, on, jobs
        As for `plantc.simulation.monte_carlo`.
    """
    settings = case.settings()
    return monte_carlo(case.loop(), runs=runs, steps=STEPS, seed=seed, limits=LIMITS, on=on, jobs=jobs, **settings)


def without_noise(deviation: float, runs: int, seed: int, *, on: str | None = None, jobs: int | None = None) -> Result:
    """Run the loop with the printed gain, the true state fed back and no noise, 400 steps, from x_o + U(-deviation, "
    "deviation).
    """
    case = Case("none", 0.0)
    still = {"pose_noise": 0.0} | {f"{name}_noise": 0.0 for name in STATES}
    settings = case.settings() | {"start": Start(deviation, known=True), "std": still}
    return monte_carlo(case.loop(), runs=runs, steps=400, seed=seed, limits=LIMITS, on=on, jobs=jobs, **settings)


@dataclass(frozen=True)
class Row:
    """What became of a case.

    Attributes
    ----------
    kept, lost, frozen : int
        Runs: within the limits at every step; finite, but not kept; diverged.
    of : str
        What the numbers are of: "kept" (means over the kept runs), "finite" (medians over the finite ones, where none was
        kept), or "" where there is none.
    mse, mse_se, err, err_se, reg, nees : float
        MSE of eq. 45; error to the truth; regulation; NEES: see `plantc.simulation.metrics_of`. NaN where there is none.
    """

    kept: int
    lost: int
    frozen: int
    of: str
    mse: float
    mse_se: float
    err: float
    err_se: float
    reg: float
    nees: float

    @classmethod
    def of_result(cls, result: Result) -> Row:
        """Return the numbers of a result."""
        kept, finite = result.count("kept"), result.count("finite")
        counts = (kept, finite - kept, result.count("frozen"))
        has_nees = "nees" in result.metrics()
        if kept:
            mse, err = result.mean("estimate_to_set_point"), result.mean("error")
            nees = result.mean("nees").value if has_nees else nan
            regulation = result.mean("regulation").value
            return cls(*counts, "kept", mse.value, mse.standard_error, err.value, err.standard_error, regulation, nees)
        if finite:
            names = ("estimate_to_set_point", "error", "regulation")
            mse_, err_, reg_ = (result.median(name, "finite") for name in names)
            return cls(
                *counts, "finite", mse_, nan, err_, nan, reg_, result.median("nees", "finite") if has_nees else nan
            )
        return cls(*counts, "", nan, nan, nan, nan, nan, nan)


Rows = Mapping[Case, Row]


def sweep(protocol: str, gain: str = "printed") -> list[Case]:
    """Return the cases of a sweep over r."""
    return [Case(which, r, protocol, gain) for r in NOISES for which in ESTIMATORS]


SWEEPS = {
    ("A", "printed"): "Protocol A, the printed gain",
    ("A", "decoupled"): "Protocol A, the decoupled gain",
    ("B", "printed"): "Protocol B",
    ("C", "printed"): "Protocol C",
    ("M", "printed"): "Protocol M: the mass is 5 % more than believed",
}
GAMMA_CASES = tuple(Case("JSSE-M", 0.1, gamma=gamma) for gamma in GAMMAS)
RAW_CASES = tuple(Case("none", r) for r in NOISES[:6])
DEVIATIONS = (0.1, 0.2, 0.3, 0.5, 1.0)


def cases() -> list[Case]:
    """Return every case of the study, each once."""
    all_of_them = [case for protocol, gain in SWEEPS for case in sweep(protocol, gain)]
    return list(dict.fromkeys([*all_of_them, *GAMMA_CASES, *RAW_CASES]))


# ---------------------------------------------------------------------------------------------------------------------
# Times


def times(repeats: int = 9) -> dict[str, float]:
    """Return the seconds of each estimator for 2000 steps in compiled C: the quickest of some calls, taken in turn."""
    batches = {which: Batch(batch_text(estimator(which))) for which in ESTIMATORS}
    inputs = {}
    for which, batch in batches.items():
        given = batch.inputs(STEPS)
        given["has_pose"] = True
        given["pose"] = SET_POINT["z"] * (np.arange(len(STATES)) == STATES.index("z"))
        given["pose"] += 0.1 * stream(0, 0, "times").standard_normal((STEPS, len(STATES)))
        for k in (1, 2, 3, 4):
            given[f"rotor_{k}"] = hover
        inputs[which] = given
    found: dict[str, list[float]] = {which: [] for which in ESTIMATORS}
    for _ in range(repeats):
        for which, batch in batches.items():
            found[which] += batch.seconds(inputs[which], repeats=1)
    return {which: min(values) for which, values in found.items()}


# ---------------------------------------------------------------------------------------------------------------------
# What was printed


PRINTED_B = {"vz": (0, 5.76e-4), "roll_rate": (2, 0.0171), "pitch_rate": (2, 0.0171), "yaw_rate": (0, 8.24e-4)}
"""Row of B -> (column, size) of an element that eq. 41 prints."""


def gain_facts(draws: int = 400) -> dict[str, float]:
    """Return the facts about the printed gain and others: spectral radii, norms, and what rounding the print may do.

    Parameters
    ----------
    draws : int
        Gains within half a unit of the last printed digit that are tried.
    """
    system = linearise(believed(), SET_POINT)

    def radius(gain: Any) -> float:
        return float(np.max(np.abs(closed_loop_eigenvalues(system.A, system.B, gain))))

    half_unit = np.where(np.abs(printed_gain) < 10, 0.05, 0.5)
    rng = stream(0, 0, "rounding")
    near = [radius(printed_gain + half_unit * rng.uniform(-1, 1, printed_gain.shape)) for _ in range(draws)]
    robust = place(system, POLES)
    # mean thrust that an error of unit variance in every state adds, (k_b / m) tr(K K') (specs/meda2018.md, section 4)
    thrust = {constant.signal.name: _value(constant) for constant in quadrotor.constants}["thrust_factor"]
    return {
        "radius of the printed gain": radius(printed_gain),
        "least radius within its rounding": min(near),
        "largest radius within its rounding": max(near),
        "norm of the printed gain": float(np.linalg.norm(printed_gain)),
        "norm of a robust placement": float(np.linalg.norm(robust.gain)),
        "radius of a robust placement": radius(robust.gain),
        "norm of the decoupled gain": float(np.linalg.norm(decoupled_gain().gain)),
        "radius of the decoupled gain": radius(decoupled_gain().gain),
        "thrust of the printed gain": thrust * float(np.sum(printed_gain**2)),
        "thrust of the decoupled gain": thrust * float(np.sum(decoupled_gain().gain ** 2)),
    }


def _of_model(facts: Mapping[str, float]) -> list[Comparison]:
    """Compare eqs. 40, 41 and 44."""
    system = linearise(believed(), SET_POINT)
    index = {name: k for k, name in enumerate(STATES)}
    ours = {row: float(system.B[index[row], column]) for row, (column, _) in PRINTED_B.items()}
    agrees = all(f"{ours[row]:.2e}" == f"{value:.2e}" for row, (_, value) in PRINTED_B.items())
    a = float(system.A[index["vx"], index["pitch"]])
    radius, wanted = facts["radius of the printed gain"], float(POLES[-1])
    within = facts["least radius within its rounding"], facts["largest radius within its rounding"]
    return [
        compared(
            "Section III: the rotors' frequency in hover is 212.718305490559 rad/s",
            f"{hover:.12f}",
            abs(hover - 212.718305490559) < 1e-11,
            [hover],
        ),
        compared(
            "eq. 40: A has 981/4000 from pitch to vx, 1/40 from each rate to its state",
            f"{a:.6g} and {float(system.A[0, 1]):.6g}",
            abs(a - 981 / 4000) < 1e-12,
            [a],
            "Eq. 40 prints 11 rows of 12: that of the pitch rate is missing.",
        ),
        compared(
            "eq. 41: elements of B are 5.76e-4, 0.0171 and 8.24e-4",
            ", ".join(f"{value:.3g}" for value in dict.fromkeys(ours.values())),
            agrees,
            ours.values(),
        ),
        compared(
            "eq. 44: the eigenvalues of A - B F' are 0.84, 0.85 ... 0.95",
            f"the largest has modulus {radius:.4f}; with any other rounding of the printed digits that was tried "
            f"{within[0]:.4f} to {within[1]:.4f}",
            abs(radius - wanted) < 5e-3,
            [radius, *within],
            "The stiffness of each axis is a difference of large elements (roll: 766 + 122 - 711 - 59 = 118), so "
            "that two or three printed digits move the eigenvalues. The printed F is stable, but slower and "
            "oscillating.",
            otherwise="shown wrong",
        ),
        Comparison(
            "eq. 44: F by robust pole placement [13]",
            "robust placement of the same eigenvalues gives a gain of norm "
            f"{facts['norm of a robust placement']:.4g}; the printed one has {facts['norm of the printed gain']:.4g}, "
            f"the decoupled one {facts['norm of the decoupled gain']:.4g}",
            "cannot be compared",
            "With four inputs the gain for a set of eigenvalues is not unique. It matters: an error of variance r^2 "
            f"in each fed-back state adds a mean thrust of {facts['thrust of the printed gain']:.4g} r^2 m/s^2 with "
            f"the printed gain, and of {facts['thrust of the decoupled gain']:.3g} r^2 with the decoupled one. That, "
            "not a filter, ends the loops at large r.",
        ),
    ]  # fmt: skip


def _best(rows: Rows, protocol: str, r: float, quantity: str) -> str:
    """Return the estimator with the least of a quantity among those that have it."""
    found = {which: getattr(rows[Case(which, r, protocol)], quantity) for which in ESTIMATORS}
    return min((which for which in found if np.isfinite(found[which])), key=lambda which: found[which], default="none")


def _kept(rows: Rows, which: str, r: float, protocol: str = "A") -> str:
    row = rows[Case(which, r, protocol)]
    return f"{row.kept} of {row.kept + row.lost + row.frozen}"


def _share(rows: Rows, which: str, r: float, protocol: str = "A") -> float:
    row = rows[Case(which, r, protocol)]
    return row.kept / (row.kept + row.lost + row.frozen)


def _alive(rows: Rows, r: float) -> float:
    """Return the larger share of runs that JSSE-M and EKF keep under protocol A; NaN if neither keeps half of them.

    Where both lose the vehicle it is the loop that fails, and says nothing of an estimator.
    """
    best = max(_share(rows, "JSSE-M", r), _share(rows, "EKF", r))
    return best if best >= 0.5 else nan


def _rivals(rows: Rows, r: float) -> tuple[float, float]:
    """Return the MSE of JSSE-M, and the least of the others that have one (NaN if none has), under protocol A."""
    others = [rows[Case(which, r)].mse for which in ESTIMATORS if which != "JSSE-M"]
    return rows[Case("JSSE-M", r)].mse, min((mse for mse in others if np.isfinite(mse)), default=nan)


def _of_figures(rows: Rows) -> list[Comparison]:
    """Compare Figs. 2-4 and eq. 45."""
    small = [r for r in NOISES if r <= 0.1]
    large = [r for r in NOISES if r > 0.1]
    first, second = ([r for r in some if _best(rows, "A", r, "mse") == "JSSE-M"] for some in (small, large))
    here, ekf = rows[Case("JSSE-M", 0.1)], rows[Case("EKF", 0.1)]
    literal, ekf_c = rows[Case("JSSE-M", 0.1, "C")], rows[Case("EKF", 0.1, "C")]
    tiny = [f"r = {r:g}: weight at most {exp(-GAMMA / r**2):.2g}, kept {_kept(rows, 'JSSE-M', r)}" for r in TINY]
    weight, blind = exp(-GAMMA / 0.1**2), _share(rows, "JSSE-M", 0.1) < 0.5 <= _share(rows, "EKF", 0.1)
    return [
        Comparison(
            "Figs. 2 and 3: it is not easy to determine which estimator provides a better performance (r = 0.1)",
            f"kept: KF {_kept(rows, 'KF', 0.1)}, EKF {_kept(rows, 'EKF', 0.1)}, JSSE {_kept(rows, 'JSSE', 0.1)}, "
            f"JSSE-M {_kept(rows, 'JSSE-M', 0.1)} runs under protocol A; JSSE-M {_kept(rows, 'JSSE-M', 0.1, 'C')} "
            "under protocol C",
            "cannot be compared",
            "The curves of the figures are not readable from the text that is available; whether they could look alike "
            "depends on the beginning and the process noise, which the paper leaves open.",
        ),
        compared(
            "Fig. 4, as the text tells it: by the MSE of eq. 45 JSSE-M is a good choice",
            f"its MSE is the least at {len(first)} of {len(small)} values of r up to 0.1, at {len(second)} of {len(large)} above; "
            f"at r = 0.1 JSSE-M {here.mse:.3g}, EKF {ekf.mse:.3g}",
            len(first) == len(small),
            [number for r in small for number in _rivals(rows, r)],
            "Eq. 45 compares the estimate with the set point. At these r JSSE-M gives the reading no weight, so that "
            "its estimate runs to the set point by itself, whatever the vehicle does.",
        ),
        compared(
            "eq. 45 is the error of the estimates",
            f"JSSE-M at r = 0.1: MSE {here.mse:.3g}, mean square of true state less estimate {here.err:.3g}; EKF: "
            f"{ekf.mse:.3g} and {ekf.err:.3g}",
            not (here.mse < ekf.mse and here.err > ekf.err),
            [here.mse, ekf.mse, here.err, ekf.err],
            "x_o - x+ holds no true state. An estimator that answers x_o and ignores every reading has MSE 0.",
            otherwise="shown wrong",
        ),
        compared(
            "Section IV: JSSE-M is a good choice to estimate the states for control",
            f"r = 0.1, protocol A: JSSE-M keeps {_kept(rows, 'JSSE-M', 0.1)} runs, EKF {_kept(rows, 'EKF', 0.1)}; "
            f"protocol C: REG {literal.reg:.3g} against {ekf_c.reg:.3g}",
            not blind,
            [_alive(rows, 0.1)],
            f"The weight on a reading is at most exp(-gamma / r^2) = {weight:.3g}: the loop is open. Under protocol "
            "C, the only reading of the paper in which JSSE-M keeps the vehicle, it has nearly no process noise and "
            "starts at the truth, and drifts.",
            otherwise="shown wrong",
        ),
        compared(
            "eq. 25: where r is small the stability that the controller provides helps to tolerate big changes in JSSE-M",
            "; ".join(tiny),
            any(_share(rows, "JSSE-M", r) >= 0.5 for r in TINY),
            [_alive(rows, r) for r in TINY],
            "It is the other way round: the smaller r, and so the better the reading, the less of it is used; then "
            "the controller stabilises the estimate, not the vehicle. gamma has the unit of r^2.",
            otherwise="shown wrong",
        ),
    ]  # fmt: skip


def _of_claims(rows: Rows) -> list[Comparison]:
    """Compare what the text says of each estimator."""
    lost = {which: [r for r in NOISES if _share(rows, which, r) < 0.9] for which in ("KF", "EKF", "JSSE")}
    first = {which: f"{values[0]:g}" if values else "no value" for which, values in lost.items()}
    kf, kf_small, ekf = rows[Case("KF", 0.1)], rows[Case("KF", 0.01)], rows[Case("EKF", 0.1)]
    ekf_large, far = rows[Case("EKF", 0.3)], rows[Case("EKF", 1.0)]
    steady = _share(rows, "EKF", 0.3) == 1 and abs(ekf_large.nees - 12) < 1
    swept = {case.gamma: rows[case] for case in GAMMA_CASES}
    best = min((gamma for gamma in swept if swept[gamma].kept), key=lambda gamma: swept[gamma].err, default=nan)
    looks = min((gamma for gamma in swept if swept[gamma].of), key=lambda gamma: swept[gamma].mse, default=nan)
    jsse, jssem, ekf_m = (rows[Case(which, 0.05, "M")] for which in ("JSSE", "JSSE-M", "EKF"))
    both = _share(rows, "JSSE", 1.0), _share(rows, "JSSE-M", 1.0)
    living = {r: rows[Case("JSSE", r)] for r in NOISES if rows[Case("JSSE", r)].of == "kept"}
    grows, ratios = [row.mse for row in living.values()], [row.err / r**2 for r, row in living.items()]
    return [
        compared(
            "Section I: the MSE of JSSE grows with the standard deviation of the measurement noise",
            "MSE of eq. 45 at each r that it survives: " + ", ".join(f"{value:.2g}" for value in grows),
            grows == sorted(grows),
            grows if len(grows) > 1 else [],
        ),
        compared(
            "Section V: JSSE only where the measurement noise is small",
            f"from r = {first['JSSE']} on it keeps less than 90 % of the runs (KF from {first['KF']}, EKF from "
            f"{first['EKF']})",
            bool(lost["JSSE"]) and lost["JSSE"][0] <= 0.12,
            [] if NOISES[0] in lost["JSSE"] else [_share(rows, "JSSE", r) for r in NOISES],
            "Its weight on the reading hardly changes with r while the loop lives, so that its error grows as r^2: it is "
            f"{min(ratios, default=nan):.3g} to {max(ratios, default=nan):.3g} r^2 where runs are kept.",
        ),
        compared(
            "Section V: the KF degrades as the noise makes the behaviour less linear",
            f"NEES {kf_small.nees:.3g} at r = 0.01 and {kf.nees:.3g} at r = 0.1 (12 is consistent)",
            kf.nees > 2 * kf_small.nees,
            [kf.nees, kf_small.nees],
        ),
        compared(
            "Section V: so does the EKF",
            f"NEES {ekf.nees:.4g} at r = 0.1 and {ekf_large.nees:.4g} at r = 0.3, where it keeps "
            f"{_kept(rows, 'EKF', 0.3)} runs; {far.nees:.4g} at r = 1, where it keeps {_kept(rows, 'EKF', 1.0)}",
            not steady,
            [ekf.nees, ekf_large.nees],
            "Its error grows with r, as any must; up to r = 0.3 it stays consistent while the model is exact."
            if steady else "",
        ),
        compared(
            "Section II-D: for large r the performance of JSSE-M tends to that of JSSE",
            f"the ratio of their weights is {exp(-GAMMA):.3g} at r = 1; kept: JSSE {_kept(rows, 'JSSE', 1.0)}, JSSE-M "
            f"{_kept(rows, 'JSSE-M', 1.0)}",
            abs(both[0] - both[1]) < 0.1,
            both if max(both) > 0 else [],
        ),
        compared(
            "Section IV: gamma = 0.15",
            f"at r = 0.1 the error to the truth is least at gamma = {best:g} ({swept[best].err:.3g} over kept runs)"
            if np.isfinite(best) else "no gamma keeps a run at r = 0.1",
            best >= 0.1,
            [best, looks],
            f"By eq. 45 gamma = {looks:g} looks best; by the true state gamma / r^2 is best at {best / 0.1**2:.3g} of "
            f"those tried, not at {GAMMA / 0.1**2:.3g}.",
        ),
        Comparison(
            "Title and abstract: estimation under parametric uncertainties",
            f"with 5 % more mass, r = 0.05: error to the truth JSSE {jsse.err:.3g}, EKF {ekf_m.err:.3g}; JSSE-M keeps "
            f"{jssem.kept} of {jssem.kept + jssem.lost + jssem.frozen} runs",
            "cannot be compared",
            "The paper simulates no uncertainty; protocol M is this study's own. Here the plain James-Stein "
            "estimator is of use: a wrong model makes D2 large, and the weight of the reading with it. The modified "
            "form undoes that.",
        ),
    ]  # fmt: skip


def _of_times(seconds: Mapping[str, float]) -> list[Comparison]:
    """Compare Table 1, as ratios: the machine is another."""
    pairs = (("EKF", "KF"), ("JSSE", "KF"), ("JSSE-M", "KF"), ("JSSE-M", "JSSE"))
    why = {
        "EKF": "",
        "JSSE": "In this C eqs. 23 and 24 are constants, found at the export, and no covariance is propagated. For a "
        "JSSE to be slower than the KF they have to be computed in every step, as they may have been for Table 1.",
    }
    made = []
    for over, under in pairs:
        printed, ours = TABLE_1[over] / TABLE_1[under], seconds[over] / seconds[under]
        alike = 0.8 <= ours / printed <= 1.5
        cause = why.get(over, why["JSSE"]) if under == "KF" else "The modified form adds one exponential."
        if over == "EKF" and ours > 1:
            cause = (
                "The order is the same. In C both propagate the same covariance, and the EKF adds sines and a Jacobian."
            )
        made.append(
            compared(
                f"Table 1: {over} / {under} = {printed:.4g}",
                f"{ours:.3g}",
                alike,
                [ours, printed],
                cause,
                measured=True,
            )
        )
    return made


# ---------------------------------------------------------------------------------------------------------------------
# Tables and figures


def _sweep_table(rows: Rows, protocol: str, gain: str) -> StudyTable:
    name = f"{protocol.lower()}-{gain}"
    columns = ("r", "estimator", "kept", "lost", "diverged", "of", "MSE (45)", "+-", "ERR", "+- ", "REG", "NEES")
    lines = []
    for case in sweep(protocol, gain):
        row = rows[case]
        counts = (row.kept, row.lost, row.frozen, row.of or "-")
        lines.append(
            (case.r, case.estimator, *counts, row.mse, row.mse_se, row.err, row.err_se, row.reg, row.nees)
        )  # fmt: skip
    note = (
        f"{PROTOCOLS[protocol]}. MSE (45): set point less estimate, which ranks nothing by itself; ERR: true state "
        "less estimate; REG: true state less set point; sums over the states of squares, mean over the steps. Means "
        "over the kept runs with their standard errors; medians over the finite runs where none was kept. NEES: 12 "
        "is consistent."
    )
    return StudyTable(name, SWEEPS[protocol, gain], columns, tuple(lines), note)


def _small_tables(rows: Rows, free: Mapping[float, Result], facts: Mapping[str, float]) -> list[StudyTable]:
    def line(case: Case, first: float) -> tuple[Any, ...]:
        row = rows[case]
        return (first, row.kept, row.lost, row.frozen, row.mse, row.err)

    columns = ("kept", "lost", "diverged", "MSE (45)", "ERR")
    return [
        StudyTable(
            "gamma", "JSSE-M over gamma", ("gamma", *columns), tuple(line(case, case.gamma) for case in GAMMA_CASES),
            "r = 0.1, protocol A, the printed gain; gamma = 0 is JSSE.",
        ),
        StudyTable(
            "raw", "The reading itself fed back", ("r", *columns), tuple(line(case, case.r) for case in RAW_CASES),
            "No estimator: protocol A, the printed gain.",
        ),
        StudyTable(
            "noise-free", "The true state fed back, without noise", ("deviation at the start", "kept", "lost", "diverged"),
            tuple((d, r.count("kept"), r.count("lost"), r.count("frozen")) for d, r in free.items()),
            "400 steps, the printed gain, all twelve states start within the deviation: how far the linear design reaches.",
        ),
        StudyTable(
            "gain", "The gains", ("fact", "value"), tuple(facts.items()),
            "Radius: largest modulus of an eigenvalue of A - B K. Thrust: mean acceleration that an error of unit "
            "variance in every state adds.",
        ),
    ]  # fmt: skip


def _times_table(seconds: Mapping[str, float]) -> StudyTable:
    rows = tuple(
        (which, TABLE_1[which], TABLE_1[which] / TABLE_1["KF"], seconds[which], seconds[which] / seconds["KF"])
        for which in ESTIMATORS
    )
    columns = ("estimator", "printed, s", "ratio to KF", "here, s", "ratio to KF ")
    note = (
        "2000 steps of the estimator alone. Printed: MATLAB r2016b on an i7-4720HQ. Here: C in double precision, one "
        "call for all steps, the quickest of nine. Ratios count as alike from 0.8 to 1.5 times the printed one."
    )
    return StudyTable("times", "Table 1: processing time", columns, rows, note, measured=True)


def _states_figure(histories: Mapping[str, History], which: Sequence[int]) -> Figure:
    """Draw true states of a run with each estimator; what leaves the limits is cut off."""
    from plantc.codegen.figures import INK, MUTED, SERIES, blank, styled

    kept = {name for name, history in histories.items() if judge(history, LIMITS).outcome == "kept"}
    with styled():
        figure = blank(5.2)
        grid = figure.subplots(3, 2, sharex=True)
        for axes, k in zip(grid.ravel(), which, strict=True):
            signal = quadrotor.states[k].signal
            centre = SET_POINT.get(signal.name, 0.0)
            largest = 0.05
            for colour, (name, history) in zip(SERIES, histories.items(), strict=False):
                shown = history.truth[::10, k]
                axes.plot(
                    np.arange(len(shown)) * 10 / 40,
                    shown,
                    color=colour,
                    linewidth=0.8,
                    label=name if k == which[0] else None,
                )
                if name in kept:
                    largest = max(largest, float(np.quantile(np.abs(shown - centre), 0.98)))
            axes.set_ylim(centre - 1.3 * largest, centre + 1.3 * largest)
            axes.locator_params(nbins=4)
            axes.set_title(f"{signal.name} [{signal.unit}]", loc="left", fontsize=8, color=INK)
            axes.tick_params(length=0, labelcolor=MUTED)
            axes.grid(axis="y")
        for axes in grid[-1]:
            axes.set_xlabel("time [s]")
        figure.legend(loc="outside upper left", ncols=4, handlelength=1.2)
        return figure


def _noise_figure(rows: Rows, shown: Iterable[tuple[str, str]]) -> Figure:
    """Draw MSE, ERR and the kept share over r, one line of panels for each sweep."""
    from matplotlib.ticker import LogLocator
    from plantc.codegen.figures import INK, MUTED, SERIES, blank, styled

    sweeps = list(shown)
    with styled():
        figure = blank(0.5 + 1.9 * len(sweeps))
        grid = figure.subplots(len(sweeps), 3, squeeze=False, sharex=True)
        for number, (line, (protocol, gain)) in enumerate(zip(grid, sweeps, strict=True)):
            for colour, which in zip(SERIES, ESTIMATORS, strict=False):
                of_it = [rows[Case(which, r, protocol, gain)] for r in NOISES]
                kept = [row.kept / (row.kept + row.lost + row.frozen) for row in of_it]
                drawn = [
                    np.maximum([row.mse for row in of_it], 1e-5),
                    np.maximum([row.err for row in of_it], 1e-5),
                    kept,
                ]
                for column, values in enumerate(drawn):
                    label = which if number == column == 0 else None
                    line[column].plot(NOISES, values, ".-", color=colour, linewidth=0.9, markersize=4, label=label)
            for axes, title in zip(line, ("MSE of eq. 45", "ERR, to the truth", "share of runs kept"), strict=True):
                axes.set_xscale("log")
                axes.set_title(
                    f"{protocol}{', decoupled gain' if gain != 'printed' else ''}: {title}",
                    loc="left",
                    fontsize=8,
                    color=INK,
                )
                axes.tick_params(length=0, labelcolor=MUTED)
                axes.grid(axis="y")
                if axes is not line[2]:
                    axes.set_yscale("log")
                    axes.yaxis.set_major_locator(LogLocator(numticks=5))
                axes.minorticks_off()
            line[2].set_ylim(-0.05, 1.05)
            line[2].set_yticks([0, 0.5, 1])
        for axes in grid[-1]:
            axes.set_xlabel("r")
        figure.legend(loc="outside upper left", ncols=4, handlelength=1.2)
        return figure


def _pictures(rows: Rows, seed: int) -> list[Picture]:
    made = []
    for protocol in "AC":
        histories = {}
        for which in ESTIMATORS:
            case = Case(which, 0.1, protocol)
            histories[which] = replay(case.loop(), 0, steps=STEPS, seed=seed, **case.settings())
        ends = ", ".join(
            f"{which} {float(np.linalg.norm(history.truth[-1, [0, 2, 4]] - [0, 0, 30])):.3g} m"
            for which, history in histories.items()
        )
        for number, first, states in ((2, "first", range(6)), (3, "last", range(6, 12))):
            made.append(
                Picture(
                    f"states-{number}-{protocol.lower()}",
                    f"Fig. {number}, protocol {protocol}: the {first} six states, r = 0.1",
                    "True states of run 0 with each estimator; the axes are cut where a vehicle is lost. Distance "
                    f"from the set point after 50 s: {ends}.",
                    _states_figure(histories, states),
                )
            )  # fmt: skip
    cut = "Values below 1e-5 are drawn at 1e-5; points of diverged cases are missing; medians over finite runs where none was kept."
    made.append(
        Picture(
            "noise-a", "Fig. 4: MSE over r, protocol A",
            "Left what the paper plots, in the middle the error to the true state, right the share of runs that are "
            f"kept. {cut}",
            _noise_figure(rows, [("A", "printed")]),
        )
    )  # fmt: skip
    made.append(
        Picture(
            "noise-others", "The same for the decoupled gain and for protocols B, C and M", cut,
            _noise_figure(rows, [sweep_ for sweep_ in SWEEPS if sweep_ != ("A", "printed")]),
        )
    )  # fmt: skip
    return made


# ---------------------------------------------------------------------------------------------------------------------
# The study


def _summary(rows: Rows) -> str:
    jssem, ekf = rows[Case("JSSE-M", 0.1)], rows[Case("EKF", 0.1)]
    biased, ekf_m = rows[Case("JSSE", 0.05, "M")], rows[Case("EKF", 0.05, "M")]
    if not np.isfinite([jssem.mse, jssem.err, ekf.mse, ekf.err, biased.err, ekf_m.err]).all():
        return (
            f"Too few runs are left to compare: at r = 0.1 JSSE-M keeps {_kept(rows, 'JSSE-M', 0.1)} runs, the EKF "
            f"{_kept(rows, 'EKF', 0.1)}; with 5 % more mass, r = 0.05, JSSE keeps {_kept(rows, 'JSSE', 0.05, 'M')}, the EKF "
            f"{_kept(rows, 'EKF', 0.05, 'M')}."
        )
    leads, useful = _best(rows, "A", 0.1, "mse") == "JSSE-M", biased.err < ekf_m.err
    return (
        f"By the paper's mean square (eq. 45) its modified James-Stein estimator is {'' if leads else 'not '}the best at r = 0.1: "
        f"{jssem.mse:.3g} against {ekf.mse:.3g} of the EKF. Against the true state its error is {jssem.err:.3g}, that "
        f"of the EKF {ekf.err:.3g}: it keeps {_kept(rows, 'JSSE-M', 0.1)} runs, the EKF {_kept(rows, 'EKF', 0.1)}. "
        f"The plain James-Stein estimator is {'' if useful else 'not '}of use where the model is wrong: with 5 % more mass its "
        f"error is {biased.err:.3g}, that of the EKF {ekf_m.err:.3g} (r = 0.05)."
    )  # fmt: skip


def _row(case: Case, *, runs: int, seed: int, on: str | None, jobs: int | None) -> Row:
    return Row.of_result(evaluate(case, runs, seed, on=on, jobs=jobs))


def study(
    runs: int = 20,
    seed: int = 2018,
    *,
    on: str | None = None,
    jobs: int | None = None,
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
    on, jobs
        As for `plantc.simulation.monte_carlo`.
    processes : int, optional
        In how many processes the cases are run; default here one for each core, from 10 runs on. It changes no number.
    progress : callable, optional
        Called with what is done, and how many of how many cases are.

    Raises
    ------
    ModelError, ClusterError
        As by `plantc.simulation.monte_carlo`.
    """
    tell = progress or (lambda what, done, total: None)
    if processes is None:  # each takes some seconds to start, which a few runs are not worth
        processes = cores() if on is None and runs >= 10 else 1
    if processes > 1:
        jobs = 1
    clock = {"start": time.perf_counter()}
    wanted = cases()
    total = len(wanted) + len(DEVIATIONS)
    with connected(on):
        tell("compiling", 0, total)
        models = hashlib.sha256(" ".join(loop(which).text.digest for which in ESTIMATORS).encode()).hexdigest()[:16]
        seconds = times()
        clock["compiling"] = time.perf_counter()
        rows: dict[Case, Row] = {}
        made = each(partial(_row, runs=runs, seed=seed, on=on, jobs=jobs), wanted, processes)
        for done, (case, row) in enumerate(zip(wanted, made, strict=True)):
            rows[case] = row
            tell(f"protocol {case.protocol}, r = {case.r:g}, {case.estimator}", done + 1, total)
        tell("without noise", len(wanted), total)
        free = {deviation: without_noise(deviation, runs, seed, on=on, jobs=jobs) for deviation in DEVIATIONS}
    clock["runs"] = time.perf_counter()
    tell("figures", total, total)
    facts = gain_facts()
    result = StudyResult(NAME, TITLE, SOURCE, models, _summary(rows))
    result.conditions = {
        "Runs of each case": runs,
        "Seed": str(seed),
        "Steps of a run": f"{STEPS}, of 1/40 s",
        "Kept": "at every step |x|, |y|, |z - 30| up to 10 m and |roll|, |pitch| up to pi/2",
        "Noise": "process noise of standard deviation 0.001 in each state and step; the same random numbers for all "
        "estimators",
        **{f"Protocol {key}": text for key, text in PROTOCOLS.items()},
    }
    result.comparisons = [*_of_model(facts), *_of_figures(rows), *_of_claims(rows), *_of_times(seconds)]
    result.tables = [
        _times_table(seconds),
        *[_sweep_table(rows, *key) for key in SWEEPS],
        *_small_tables(rows, free, facts),
    ]
    result.pictures = _pictures(rows, seed)
    clock["page"] = time.perf_counter()
    names = list(clock)
    result.seconds = {b: clock[b] - clock[a] for a, b in pairwise(names)}
    return result
