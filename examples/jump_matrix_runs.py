"""What the study of the jump matrix technique runs: its printed tables as data, its cases, and the compiled loops.

All follows specs/jump_matrix.md: the protocol of section 6, the baseline of section 8. The systems are in `jump_systems`.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray
from plantc.codegen.batch import Batch, batch_text
from plantc.examples import jump_systems
from plantc.examples.jump_systems import JumpSystem, T
from plantc.simulation import ClosedLoop, History, channels, closed_loop, draw, run_batch, stream
from plantc.symbolic import Block, Plant
from plantc.symbolic.controllers import state_feedback
from plantc.symbolic.jump_matrix import jump_matrix_estimator, jump_model
from scipy.integrate import solve_ivp

Array = NDArray[np.float64]

STEPS = 1000
DIVERGED = 1e3
"""A run counts as diverged if its mean square error is beyond this, or its loop refused a call: no finite numbers."""
OPEN_LOOP, ONLINE, JACOBIAN, IDENTITY, EKF = "open loop", "online", "Jacobian", "identity", "EKF"
BATCHES = 6
"""Chapter IV is run this many times as often: what is said of it rests on fractions of runs, and on a median with wide tails."""
CONTROLLED = ("linear_amplifier", "saturating_amplifier", "controlled_spring", "saturated_spring")
BY_OPEN, BY_CLOSED, BY_STATE = "Phi_OL", "Phi_CL", "true state"


# ---------------------------------------------------------------------------------------------------------------------
# What is printed


@dataclass(frozen=True)
class Printed:
    """A printed table: mean square errors of single runs.

    Attributes
    ----------
    number : int
        Of the table.
    systems : tuple of str
        Of each column.
    values : tuple of float or None
        h or eps of each column; None where the row says the slope.
    varied : str
        What the rows vary: "sigma_v^2", "sigma_w^2" or "slope".
    fixed : tuple of float
        The other variance; both where the slope is varied, sigma_w^2 first.
    approach : str
        Of the estimator.
    rows : dict
        What is varied -> printed numbers, None where lost.
    """

    number: int
    systems: tuple[str, ...]
    values: tuple[float | None, ...]
    varied: str
    fixed: tuple[float, ...]
    approach: str
    rows: Mapping[float, tuple[float | None, ...]]

    def case(self, row: float, column: int, approach: str = "", known: bool | None = None) -> Case:
        """Return the case of a cell, by the table's approach and its start, or by others."""
        taken = approach or self.approach
        start = taken in (ONLINE, OPEN_LOOP) if known is None else known
        value = self.values[column]
        if self.varied == "slope":
            return Case(self.systems[column], row, self.fixed[0], self.fixed[1], taken, start)
        noise, reading = (self.fixed[0], row) if self.varied == "sigma_v^2" else (row, self.fixed[0])
        return Case(self.systems[column], value or 0.0, noise, reading, taken, start)

    def cells(self) -> Iterator[tuple[float, int, float | None]]:
        """Yield row, column and what is printed there."""
        for row, numbers in self.rows.items():
            for column, number in enumerate(numbers):
                yield row, column, number


H, EPS = (-0.5, 0.0, 1.0), (0.5, 2.0, 5.0)
_SPRING, _VDP = ("spring",) * 3, ("van_der_pol",) * 3
_READING, _NOISE = "sigma_v^2", "sigma_w^2"

TABLES = {table.number: table for table in (
    Printed(1, _SPRING, H, _READING, (1.0,), ONLINE, {
        0.1: (0.0690064, 0.0106900, 0.0092802),
        1.0: (0.0727319, 0.0109177, 0.0104527),
        4.0: (0.0730655, 0.0109309, 0.0106106),
        10.0: (0.0731314, 0.0109314, 0.0106549),
        100.0: (0.0731694, 0.0109389, 0.0106970),
    }),
    Printed(2, _SPRING, H, _READING, (1.0,), JACOBIAN, {
        0.1: (0.0647215, 0.0103383, 0.1010077),
        1.0: (0.1075495, 0.0332378, 0.3021388),
        4.0: (0.1648555, 0.0619046, 0.5951792),
        10.0: (0.1982963, 0.0796488, 1.1655544),
        100.0: (0.6054380, 0.1735884, 4.5283955),
    }),
    Printed(3, _SPRING, H, _NOISE, (4.0,), ONLINE, {
        0.1: (0.0063701, 0.0010937, 0.0010566),
        1.0: (0.0730655, 0.0109309, 0.0106106),
        10.0: (3.3030772, 0.1091218, 0.1017887),
    }),
    Printed(4, _SPRING, H, _NOISE, (4.0,), JACOBIAN, {
        0.1: (0.0904251, 0.0638663, None),
        1.0: (0.1648555, 0.0619046, None),
        10.0: (0.5619093, 0.1197612, None),
    }),
    Printed(5, _VDP, EPS, _READING, (10.0,), ONLINE, {
        1.0: (0.0047758, 0.0030296, 0.0090176),
        10.0: (0.0048009, 0.0104871, 0.1021448),
        25.0: (0.0048131, 0.0204461, 0.2755777),
        100.0: (0.0048159, 0.0572452, 1.0297842),
    }),
    Printed(6, _VDP, EPS, _READING, (10.0,), JACOBIAN, {
        1.0: (0.0247902, 0.1028206, 0.1925998),
        10.0: (0.0878251, 0.4383502, 0.8300945),
        25.0: (0.1611247, 1.0085481, 1.7858306),
        100.0: (0.4390831, 2.9658808, 4.0496443),
    }),
    Printed(7, _VDP, EPS, _NOISE, (25.0,), ONLINE, {
        1.0: (0.0004780, 0.0146168, 0.2772748),
        10.0: (0.0048131, 0.0204461, 0.2755777),
        25.0: (0.0121194, 0.0249862, 0.2776340),
    }),
    Printed(8, _VDP, EPS, _NOISE, (25.0,), JACOBIAN, {
        1.0: (0.1514495, 1.0061652, 1.8455638),
        10.0: (0.1611247, 1.0085481, 1.7858306),
        25.0: (0.1729297, 1.0060306, 1.7301761),
    }),
    Printed(9, ("relay", "modified_relay"), (None, None), "slope", (0.01, 0.1), JACOBIAN, {
        200.0: (0.0022999, 0.1206731),
        100.0: (0.0021383, 0.1206731),
        20.0: (0.0017647, 0.1206861),
        10.0: (0.0021493, 0.1207784),
        5.0: (0.0020572, 0.1208955),
        3.0: (0.0020138, 0.1209236),
        2.0: (0.0020205, 0.1209290),
        1.0: (0.0018697, 0.1207281),
        0.5: (0.0017565, 0.1203282),
        0.1: (0.0016322, 0.1106010),
    }),
)}  # fmt: skip
"""Table number -> what is printed."""


# ---------------------------------------------------------------------------------------------------------------------
# Cases


@dataclass(frozen=True)
class Case:
    """What is run with each seed.

    Attributes
    ----------
    system : str
        A name of `jump_systems.SYSTEMS`.
    value : float
        h, eps or the slope; zero where there is none.
    noise, reading : float
        sigma_w^2 and sigma_v^2, in the truth and to the estimator. Zero noise without any: the estimator then believes what it
        is made with.
    approach : str
        "open loop" (a gain of zero), "online", "Jacobian", "identity" or "EKF".
    known : bool
        P_0 = 0 instead of the unit matrix.
    transition : str
        In the controlled systems "Phi_OL", "Phi_CL", or "true state", which is fed back without an estimator.
    """

    system: str
    value: float
    noise: float
    reading: float
    approach: str = JACOBIAN
    known: bool = False
    transition: str = BY_OPEN

    @property
    def loop(self) -> tuple[str, float, str, str]:
        """What has to be compiled: system, value, approach, transition."""
        value = 0.0 if "relay" in self.system else self.value
        return self.system, value, JACOBIAN if self.approach == OPEN_LOOP else self.approach, self.transition


CONTROL_NOISES = {name: (0.1, 0.01) if "amplifier" in name else (1.0, 4.0) for name in CONTROLLED}
"""sigma_w^2 and sigma_v^2 of chapter IV."""
RELAYS = ("relay", "modified_relay")
FIGURE_NOISES = (0.1, 1.0)
"""sigma_w^2 and sigma_v^2 of Figs. 19 to 22."""
STARTS = (
    (ONLINE, True),
    (JACOBIAN, True),
    (EKF, True),
    (IDENTITY, False),
    (ONLINE, False),
    (JACOBIAN, False),
    (EKF, False),
)
"""Approach and P_0 = 0, of the comparison with equal starts; the identity with P_0 = 0 is the online gain with P_0 = 0."""


def cases() -> list[Case]:
    """Return every case of the study, each once."""
    made = []
    for number in (1, 3, 5, 7):
        for row, column, _ in TABLES[number].cells():
            made += [TABLES[number].case(row, column, approach, known) for approach, known in STARTS]
            made.append(open_loop(TABLES[number].case(row, column)))
    nine = TABLES[9]
    made += [nine.case(row, column, JACOBIAN, known) for row, column, _ in nine.cells() for known in (True, False)]
    for system in RELAYS:
        for approach, known in STARTS:
            if approach != EKF:
                made.append(Case(system, 10.0, *FIGURE_NOISES, approach, known))
        made += [open_loop(made[-1]), Case(system, 10.0, 0.0, 0.0)]
    for system, (noise, reading) in CONTROL_NOISES.items():
        for transition in (BY_OPEN, BY_CLOSED, BY_STATE):
            made.append(Case(system, 0.0, noise, reading, transition=transition))
    return list(dict.fromkeys(made))


def open_loop(case: Case) -> Case:
    """Return the case without any correction; what the estimator believes of the reading then plays no part."""
    return replace(case, reading=1.0, approach=OPEN_LOOP, known=True)


@dataclass(frozen=True, eq=False)
class Runs:
    """What the runs of a case gave, by seed.

    Attributes
    ----------
    mse : array (runs,)
        Mean over k = 1 .. 1000 of the squared error of x1; infinite where a run diverged, NaN where nothing is estimated.
    more : dict of str to array (runs,)
        Other measures, see `measures`.
    first : array (3, 1000)
        z, x1 and its estimate in the first run.
    model : str
        Hash of the loop.
    """

    mse: Array
    more: Mapping[str, Array] = field(default_factory=dict)
    first: Array = field(default_factory=lambda: np.full((3, STEPS), np.nan))
    model: str = ""

    @property
    def median(self) -> float:
        """Median of `mse`."""
        return float(np.median(self.mse))

    @property
    def band(self) -> tuple[float, float]:
        """The 10 and the 90 % quantile."""
        low, high = np.quantile(self.mse, (0.1, 0.9), method="inverted_cdf")
        return float(low), float(high)

    @property
    def diverged(self) -> float:
        """The fraction of runs that diverged."""
        return float(np.mean(np.isinf(self.mse)))


Found = Mapping[Case, Runs]


# ---------------------------------------------------------------------------------------------------------------------
# Loops


def system_of(name: str, value: float = 0.0) -> JumpSystem:
    """Return a system; the slope of a relay is a parameter, h and eps are in its matrices."""
    made = jump_systems.SYSTEMS[name]
    return made(value) if name in ("spring", "van_der_pol") else made()


def rates(name: str, value: float, x1: Any, x2: Any, w: Any) -> tuple[Any, Any]:
    """Return x1' and x2' of the spring or of Van der Pol's oscillator, of numbers, arrays or symbols."""
    if name == "spring":
        return x2, -2.0 * x1 - 0.1 * x2 - value * x1 * x1 * x1 + w
    return x2, value * (1.0 - x1 * x1) * x2 - 9.0 * x1 + w


def runge_kutta(name: str, value: float) -> Plant:
    """Return the same system by a step of the Runge-Kutta method of fourth order, w held: of it the EKF of section 8 is made.

    The nonlinearity of the jump model follows as a third state, which nothing depends on, so that both have one state vector.
    """
    truth = system_of(name, value).plant
    plant = Plant(f"{name}_runge_kutta", dt=T)
    x1, x2, held = (plant.state(s.signal.name, range=(s.signal.low[0], s.signal.high[0])) for s in truth.states)
    w = plant.noise("w", variance=1.0)
    x = ca.vertcat(x1, x2)

    def slope(at: Any) -> Any:
        return ca.vertcat(*rates(name, value, at[0], at[1], w))

    k1 = slope(x)
    k2 = slope(x + T / 2 * k1)
    k3 = slope(x + T / 2 * k2)
    k4 = slope(x + T * k3)
    after = x + T / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    phi = after[0] ** 3 if name == "spring" else after[0] ** 2 * after[1]
    plant.dynamics({x1: after[0], x2: after[1], held: phi})
    sensor = truth.sensors[0].signal
    plant.sensor("z", x1, variance=1.0, range=(sensor.low[0], sensor.high[0]))
    return plant


def estimator(system: JumpSystem, name: str, value: float, approach: str, transition: str = BY_OPEN) -> Block:
    """Return an estimator of a system; its start P_0 and the variances it believes are parameters."""
    if approach == EKF:
        from plantc.symbolic.estimators import extended_kalman_filter

        plant = runge_kutta(name, value)
        start = {state.signal.name: system.start[state.signal.name] for state in plant.states}
        one = dict.fromkeys(start, 1.0)
        return extended_kalman_filter(plant, initial_variance=one, around=start, variance_floor=0.0)
    given = system.model.closed_transition([system.gain]) if transition == BY_CLOSED else None
    choice: Any = approach.lower()
    return jump_matrix_estimator(
        system.model, choice, initial_variance=1.0, covariance_transition=given, around=system.start, variance_floor=0.0
    )


@cache
def loop_of(name: str, value: float, approach: str, transition: str) -> ClosedLoop:
    """Return the loop of a case, see `Case.loop`."""
    system = system_of(name, value)
    plant, readings = system.plant, {}
    if transition == BY_STATE:
        for state in plant.states:  # read as they are: the noise of these readings is drawn with a deviation of zero
            plant.sensor(f"seen_{state.signal.name}", state.symbol, variance=1.0)
            readings[state.signal.name] = f"seen_{state.signal.name}"
        control = state_feedback(plant, {"u": system.reference}, [list(system.gain)])
        return closed_loop(plant, control, system.start, readings=readings, name=f"{name}_by_state")
    block = estimator(system, name, value, approach, transition)
    if system.gain:
        block = jump_systems.controller(system, block)
    truth = system.model.truth if approach == ONLINE else plant
    return closed_loop(truth, block, system.start, name=f"{name}_{approach.lower()}_loop")


@cache
def batch_of(name: str, value: float, approach: str, transition: str) -> Batch:
    """Return the same, compiled."""
    return Batch(loop_of(name, value, approach, transition).text)


def settings(case: Case) -> dict[str, float]:
    """Return the parameters of the loop of a case: what the estimator believes, and the slope."""
    loop = loop_of(*case.loop)
    known = {signal.name for signal in loop.block.param_signals_flat()}
    given: dict[str, float] = {}
    if "plant.slope" in known and case.value:
        given |= {"plant.slope": case.value, "controller.slope": case.value}
    own = "controller.estimator." if case.system in CONTROLLED else "controller."
    if case.transition != BY_STATE:
        if case.noise or case.reading:
            given |= {
                f"{own}variance_w": 0.0 if case.approach == OPEN_LOOP else case.noise,
                f"{own}variance_z": case.reading,
            }
        for state in loop.point.plant.states:
            given[f"{own}variance_{state.signal.name}_0"] = 0.0 if case.known else 1.0
    return given


def history(case: Case, run: int, seed: int, *, noise: bool = True) -> History:
    """Run a case once: one call of C, the random numbers those of `plantc.simulation.monte_carlo`.

    Parameters
    ----------
    case : Case
        What is run.
    run, seed : int
        Key of the random numbers; the same for every case, which therefore meet the same noise.
    noise : bool
        Without any at all if false.
    """
    loop = loop_of(*case.loop)
    std = dict.fromkeys((item.signal.name for item in loop.noises), 0.0)
    if noise:
        std |= {"w": float(np.sqrt(case.noise)), "z_noise": float(np.sqrt(case.reading))}
    drawn = {item.name: draw(item, seed, run, STEPS) for item in channels(loop.noises, std)}
    return run_batch(batch_of(*case.loop), loop.layout, drawn, STEPS, params=settings(case), held=loop.held)


def errors(found: History) -> Array | None:
    """Return x1 less its estimate at k = 1 .. 1000, or None where the run diverged."""
    if found.refused or len(found.truth) < found.asked or found.estimate is None:
        return None
    error: Array = found.truth[:, 0] - found.estimate[:, 0]
    with np.errstate(all="ignore"):
        return error if np.mean(error * error) <= DIVERGED else None


def kurtosis(values: Array) -> float:
    """Return the fourth central moment over the squared variance: 3 of a normal distribution."""
    centred = values - np.mean(values)
    return float(np.mean(centred**4) / np.mean(centred**2) ** 2)


def measures(case: Case, found: History, still: Array | None, run: int, seed: int) -> dict[str, float]:
    """Return what a run is judged by beside its mean square error.

    Returns
    -------
    dict
        In the relays ``kurtosis`` of the error, and ``kurtosis_added`` of the error to which normal random numbers of the same
        variance were added (Fig. 24); in the controlled systems ``roughness``, mean squared increment of xh1; ``gain``, mean of K1
        over the run (K1 = P11 / R after the reading); ``deviation``, mean square of x1 less the response without noise;
        ``rise``, seconds until x1 is at nine tenths of where it settles without noise, infinite where it never is. Nothing
        for a run that was refused before its end.
    """
    answer: dict[str, float] = {}
    if found.refused or len(found.truth) < found.asked:
        return answer
    error = errors(found)
    if error is not None and case.system in RELAYS and case.noise:
        added = np.std(error) * stream(seed, run, "figure 24").standard_normal(len(error))
        answer |= {"kurtosis": kurtosis(error), "kurtosis_added": kurtosis(error + added)}
    if still is None:
        return answer
    x1 = found.truth[:, 0]
    if found.estimate is not None and found.spread is not None:
        answer["roughness"] = float(np.mean(np.diff(found.estimate[:, 0]) ** 2))
        answer["gain"] = float(np.mean(found.spread[:, 0]) / case.reading)
    answer["deviation"] = float(np.mean((x1 - still) ** 2))
    if "amplifier" in case.system:
        there = np.flatnonzero(x1 >= 0.9 * still[-1])
        answer["rise"] = T * (1 + int(there[0])) if len(there) else float("inf")
    return answer


def runs_of(case: Case, runs: int, seed: int) -> Runs:
    """Run a case with every seed."""
    still = history(case, 0, seed, noise=False).truth[:, 0] if case.system in CONTROLLED else None
    mse, rows, first = np.full(runs, np.inf), [], np.full((3, STEPS), np.nan)
    for run in range(runs):
        found = history(case, run, seed)
        error = errors(found)
        if error is not None:
            mse[run] = float(np.mean(error * error))
        elif found.estimate is None:
            mse[run] = np.nan
        rows.append(measures(case, found, still, run, seed))
        if run == 0:
            steps = len(found.truth)
            reading = stream(seed, run, "z_noise").standard_normal(steps) * np.sqrt(case.reading)
            first[0, :steps], first[1, :steps] = found.truth[:, 0] + reading, found.truth[:, 0]
            first[2, :steps] = np.nan if found.estimate is None else found.estimate[:, 0]
    names = dict.fromkeys(name for row in rows for name in row)
    return Runs(
        mse,
        {name: np.array([row.get(name, np.nan) for row in rows]) for name in names},
        first,
        batch_of(*case.loop).text.model,
    )


def runs_of_loop(given: tuple[Sequence[Case], int, int]) -> dict[Case, Runs]:
    """Return the runs of cases that have one loop: (cases, runs, seed)."""
    own, runs, seed = given
    return {case: runs_of(case, runs * (BATCHES if case.system in CONTROLLED else 1), seed) for case in own}


def by_loop(wanted: Iterable[Case]) -> list[list[Case]]:
    """Return the cases by what has to be compiled, the most cases first."""
    groups: dict[tuple[str, float, str, str], list[Case]] = {}
    for case in wanted:
        groups.setdefault(case.loop, []).append(case)
    return sorted(groups.values(), key=len, reverse=True)


# ---------------------------------------------------------------------------------------------------------------------
# The truth by another integrator


def integrated(name: str, value: float, start: Sequence[float], w: Array, dt: float = T) -> Array:
    """Return x1, x2 at k = 1 .. N by an eighth-order Runge-Kutta method with tight tolerances, (N, 2, runs).

    Parameters
    ----------
    name, value : str, float
        The system, h or eps.
    start : sequence of float
        x1 and x2 at k = 0.
    w : array (N, runs)
        Held from k to k + 1.
    dt : float
        Seconds per step.
    """
    count = w.shape[1]
    x = np.repeat(np.asarray(start[:2], dtype=float)[:, None], count, axis=1)
    answer = np.empty((len(w), 2, count))
    for k, held in enumerate(w):

        def slope(t: float, at: Array, held: Array = held) -> Array:
            return np.concatenate(rates(name, value, at[:count], at[count:], held))

        x = solve_ivp(slope, (0.0, dt), x.ravel(), method="DOP853", rtol=1e-9, atol=1e-10).y[:, -1].reshape(2, count)
        answer[k] = x
    return answer


def smooth(name: str, value: float, start: Sequence[float], seconds: float) -> Array:
    """Return x1, x2 after some seconds without noise, integrated at one go."""
    found = solve_ivp(
        lambda t, x: np.array(rates(name, value, x[0], x[1], 0.0)),
        (0.0, seconds), np.asarray(start[:2], dtype=float), method="DOP853", rtol=1e-12, atol=1e-12,
    )  # fmt: skip
    return np.asarray(found.y[:, -1])


def order_errors(name: str, value: float, steps: Sequence[float], seconds: float = 10.0) -> list[float]:
    """Return |x1 by jumps - x1 integrated| after some seconds without noise, for each length of a step."""
    system = system_of(name, value)
    x1, x2 = (state.symbol for state in system.model.continuous.states)
    clamp = system.model.clamps[0]
    start = [system.start[state.signal.name] for state in system.plant.states]
    truth, answer = smooth(name, value, start, seconds)[0], []
    for dt in steps:
        model = jump_model(system.model.continuous, {clamp: x1**3 if name == "spring" else x1**2 * x2}, dt)
        jump = ca.Function("jump", [model.plant.x], [model.plant.without_noise(model.J)])
        step = ca.Function("step", [model.plant.x], [jump(ca.DM(model.Phi) @ model.plant.x)])
        at = step.mapaccum(round(seconds / dt))(start)
        answer.append(abs(float(at[0, -1]) - float(truth)))
    return answer


def estimates_of_readings(case: Case, readings: Array) -> Array:
    """Return xh1 at k = 1 .. N of a compiled estimator that is given readings, (N, runs).

    Parameters
    ----------
    case : Case
        System, variances, approach and start.
    readings : array (N, runs)
        z.
    """
    system = system_of(case.system, case.value)
    batch = Batch(batch_text(estimator(system, case.system, case.value, case.approach)))
    given = {name.removeprefix("controller."): value for name, value in settings(case).items()}
    params, inputs = batch.params(given), batch.inputs(len(readings))
    inputs["has_z"] = True
    answer = np.empty(readings.shape)
    for run in range(readings.shape[1]):
        inputs["z"] = readings[:, run]
        answer[:, run] = batch.run(inputs, params).memory["x1"].copy()
    return answer


@dataclass(frozen=True, eq=False)
class OtherTruth:
    """The estimator beside a truth that another integrator made (Fig. 12).

    Attributes
    ----------
    steps : tuple of float
        Lengths of a step for the errors of the jump simulation without noise.
    errors : dict
        (system, value) -> |error of x1| after 10 s, one for each of `steps`.
    mse : dict
        (system, value) -> mean square errors of the estimate, one for each run: of the integrated truth.
    truth, readings, estimate : array (N,)
        Of the first run of the hard spring.
    """

    steps: tuple[float, ...]
    errors: Mapping[tuple[str, float], Sequence[float]]
    mse: Mapping[tuple[str, float], Array]
    truth: Array
    readings: Array
    estimate: Array


OTHER_STEPS = (0.02, 0.01, 0.005)
OTHERS = (("spring", 1.0), ("van_der_pol", 2.0))


def other_case(name: str, value: float) -> Case:
    """Return the case that is run with the integrated truth: the variances of the figures, Jacobian, P_0 = I."""
    return Case(name, value, 1.0 if name == "spring" else 10.0, 4.0 if name == "spring" else 25.0)


def other_truth(runs: int, seed: int) -> OtherTruth:
    """Integrate the truth with the noises of the Monte-Carlo, and estimate it from its readings by the compiled estimator."""
    mse, shown = {}, []
    for name, value in OTHERS:
        case = other_case(name, value)
        loop = loop_of(*case.loop)
        std = {"w": float(np.sqrt(case.noise)), "z_noise": float(np.sqrt(case.reading))}
        drawn = {
            item.name: np.hstack([draw(item, seed, run, STEPS) for run in range(runs)])
            for item in channels(loop.noises, std)
        }
        truth = integrated(name, value, [float(loop.layout.point[i]) for i in (0, 1)], drawn["w"])[:, 0]
        readings = truth + drawn["z_noise"]
        found = estimates_of_readings(case, readings)
        mse[name, value] = np.mean((truth - found) ** 2, axis=0)
        shown.append((truth[:, 0], readings[:, 0], found[:, 0]))
    order = {(name, value): order_errors(name, value, OTHER_STEPS) for name, value in OTHERS}
    return OtherTruth(OTHER_STEPS, order, mse, *shown[0])
