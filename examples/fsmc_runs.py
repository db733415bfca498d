"""The runs of the study `plantc.examples.fsmc2018`: cases, how each is flown, and the numbers that are kept of it.

All fly in compiled C (`fsmc_autopilot.fly`), but those of a `variant`: laws and Jacobians as they are misprinted, which nobody
would export, by the NumPy reference.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray
from plantc.examples.fsmc_autopilot import GAIN, LAWS, WIDTH, Flight, fly
from plantc.examples.fsmc_quadrotor import DT, READ, SET_A, STATES, TUNINGS, coefficients
from plantc.reference import fsmc
from plantc.reference.fsmc import Run, Scenario, disturbances, simulate
from plantc.simulation import each

Array = NDArray[np.float64]

STEPS = 10000
AGITATION = 1e-2
"""q of the paper, whatever it is the variance of."""
PART = {"roll": "attitude", "pitch": "attitude", "yaw": "attitude", "x": "position", "y": "position", "z": "altitude"}
"""Channel -> the law that it belongs to."""
FOUR = ("yaw", "x", "y", "z")
"""What section 5 of the paper says is read."""

STARTS: dict[str, tuple[tuple[float, ...], tuple[float, ...]]] = {
    "at rest": ((0.0,) * 12, (0.0,) * 12),
    "far": ((0,) * 6 + (4.0, 0, -4.0, 0, 0, 0), (0,) * 6 + (4.0, 0, -4.0, 0, 0, 0)),
    "tilted": ((0.1, 0, -0.1) + (0.0,) * 9, (0.0,) * 12),
    "wrong estimate": ((0.0,) * 12, (0,) * 6 + (0.2, 0.3, 0, 0, -0.2, 0.5)),
}
"""State and estimate at t = 0."""


@dataclass(frozen=True)
class Case:
    """One run.

    Attributes
    ----------
    law, which, believed, estimated, read, tuning
        See `fsmc_autopilot.Flight`.
    seed : int or None
        Of the noise; None without.
    onset : float
        Since when sine and noise are there, s.
    sine, push, turn : float
        Amplitude of the sine; a constant acceleration along z, m/s^2.
    q_of : str
        What q is the variance of: "d" (section 8); or, erratum 8, "all states", "velocities", "density", "forces".
    start : str
        A key of `STARTS`.
    ramp : bool
        Whether the altitude is 5 t.
    steps : int
        How many.
    params : tuple of (str, float)
        See `Flight`.
    variant : str
        "literal", "divided", "printed Jacobian", "Runge-Kutta" or "plain": by the NumPy reference.
    """

    law: str = "FSMC"
    which: str = "A"
    believed: str = ""
    estimated: bool = True
    read: tuple[str, ...] = READ
    tuning: str = "printed"
    seed: int | None = None
    onset: float = 5.0
    sine: float = 0.01
    push: float = 0.0
    turn: float = 0.0
    q_of: str = "d"
    start: str = "at rest"
    ramp: bool = False
    steps: int = STEPS
    params: tuple[tuple[str, float], ...] = ()
    variant: str = ""

    @property
    def loop(self) -> tuple[Any, ...]:
        """What the cases of one compiled loop have in common; each variant is on its own."""
        if self.variant:
            return (self.variant, self.seed)
        return (self.law, self.which, self.believed, self.estimated, self.read, self.q_of == "all states")


@dataclass(frozen=True)
class Outcome:
    """The numbers of a run. Windows are (from, to) in s; there is no number (NaN) where the run was over before its end.

    Attributes
    ----------
    tracking, estimation : dict of window to array (12,)
        Root mean square errors, truth less reference and truth less estimate.
    chattering : dict of window to array (4,)
        Chattering index of the commands.
    saturated : dict of window to float
        Share of the steps in which a rotor was clipped.
    clipped : float
        Of the first 5 s, in which the sine of an angle was.
    largest_d : float
        Of the accelerations that disturb.
    last, seen, wanted, deviation : array (12,)
        State, estimate, reference and the filter's own standard deviations in the last step.
    first : array (4,)
        The first command.
    diverged : float or None
        When the run was over early.
    along_z : array (steps / 10, 2)
        Every tenth step: z less its reference, and vz less its estimate.
    run : Run or None
        All of it, of those cases that were to be kept.
    """

    tracking: dict[tuple[float, float], Array]
    estimation: dict[tuple[float, float], Array]
    chattering: dict[tuple[float, float], Array]
    saturated: dict[tuple[float, float], float]
    clipped: float
    largest_d: float
    last: Array
    seen: Array
    wanted: Array
    deviation: Array
    first: Array
    diverged: float | None
    along_z: Array
    run: Run | None = field(default=None, repr=False)


Found = dict[Case, Outcome]

PRINTED = {
    "a1": -1, "a2": -0.1454, "a3": -0.0074, "a4": 1, "a5": -0.1454, "a6": 0.0074, "a7": -1.3061e-4, "a8": -0.0830, "a9": -0.0011,
    "a10": -0.001, "a11": -0.0013, "b1": 65.3117, "b2": 65.294, "b3": 130.6063,
}  # fmt: skip
"""The coefficients of Table 2."""

WINDOWS = ((0.0, 5.0), (2.0, 5.0), (5.0, 10.0), (9.0, 10.0), (10.0, 20.0), (15.0, 20.0))


def scaled(gain: float = 1.0, width: float = 1.0, frequency: float = 20.0) -> tuple[tuple[str, float], ...]:
    """Return the parameters with K and Phi times a factor, and another frequency of the command filters (rad/s)."""
    made = [(f"law.{PART[axis]}.gain_{axis}", gain * value) for axis, value in GAIN.items()]
    made += [(f"law.{PART[axis]}.width_{axis}", width * value) for axis, value in WIDTH.items()] if width != 1 else []
    return (*made, *((f"law.{axis}_filter.frequency", frequency) for axis in ("roll", "pitch")))


def heavier(share: float) -> tuple[tuple[str, float], ...]:
    """Return the parameters of a vehicle that weighs so many times what filter and law believe."""
    return (("plant.mass", share * SET_A["mass"]),)


def drawn(case: Case) -> tuple[Array, Array, Array | None]:
    """Return d and v (steps, 6) of a case, and what is added to the states (steps, 12) where q is taken for that."""
    constant = np.array([case.turn, 0, 0, 0, 0, case.push])
    d, v = disturbances(case.steps, onset=case.onset, sine=case.sine, constant=constant, seed=case.seed)
    if case.q_of == "d":
        return d, v, None
    still = disturbances(case.steps, onset=case.onset, sine=case.sine)[0]
    noise = (d - still) / np.sqrt(AGITATION)  # of unit variance
    if case.q_of == "all states":
        rng, on = np.random.default_rng([case.seed or 0, 12]), (DT * np.arange(case.steps) >= case.onset)[:, None]
        return still, v, np.asarray(np.sqrt(AGITATION) * on * rng.standard_normal((case.steps, 12)))
    inertia = [SET_A[f"inertia_{axis}"] for axis in "xyz"]
    share: Any = {
        "velocities": np.sqrt(AGITATION) / DT,
        "density": np.sqrt(AGITATION / DT),
        "forces": np.sqrt(AGITATION) / np.array([*inertia, *[SET_A["mass"]] * 3]),
    }[case.q_of]
    return still + share * noise, v, None


def flown(case: Case) -> Run:
    """Fly a case in compiled C."""
    X, estimate = STARTS[case.start]
    d, v, w = drawn(case)
    own = (("trajectory.altitude", 0.0), ("trajectory.climb", 5.0)) if case.ramp else ()
    return fly(
        Flight(
            case.steps, case.law, case.which, case.estimated, tuning=case.tuning, X=X, estimate=estimate, d=d, v=v,
            params=dict((*own, *case.params)), believed=case.believed, read=case.read, w=w,
        )
    )  # fmt: skip


def computed(case: Case) -> Run:
    """Run a variant by the NumPy reference."""
    d, v, _ = drawn(case)
    return simulate(
        Scenario(
            case.steps, case.law, tuning=case.tuning, d=d, v=v, literal=case.variant == "literal",
            divided=case.variant == "divided", printed_jacobian=case.variant == "printed Jacobian",
            exact=case.variant == "Runge-Kutta",
        )
    )  # fmt: skip


def outcome(case: Case, *, keep: bool = False) -> Outcome:
    """Run a case and return its numbers."""
    run = computed(case) if case.variant else flown(case)

    def by_window(measure: Callable[[float, float], Any], size: int) -> dict[tuple[float, float], Any]:
        return {
            (start, end): measure(start, end)
            if len(run.X) >= round(end / DT)
            else np.full(size, np.nan)
            if size > 1
            else np.nan
            for start, end in WINDOWS
            if end <= case.steps * DT
        }

    def saturated(start: float, end: float) -> float:
        return float(np.mean(run.saturated[run.window(start, end)]))

    largest = float(np.max(np.abs(drawn(case)[0][: len(run.X)])))
    return Outcome(
        by_window(run.tracking, 12), by_window(run.estimation, 12), by_window(run.chattering, 4),
        {key: float(value) for key, value in by_window(saturated, 1).items()}, float(np.mean(run.clipped[:5000])), largest,
        run.X[-1], run.estimate[-1], run.reference[-1], run.deviation[-1], run.u[0], run.diverged,
        np.column_stack([run.X[::10, 10] - run.reference[::10, 10], (run.X - run.estimate)[::10, 11]]), run if keep else None,
    )  # fmt: skip


def _part(given: tuple[Sequence[Case], frozenset[Case]]) -> Found:
    """Run the cases of one loop, in whichever process."""
    wanted, kept = given
    return {case: outcome(case, keep=case in kept) for case in wanted}


def run(
    wanted: Sequence[Case], kept: Sequence[Case] = (), processes: int = 1, progress: Callable[[str], None] = lambda what: None
) -> Found:  # fmt: skip
    """Run cases in some processes; each loop is derived and compiled by the one that runs it.

    Parameters
    ----------
    wanted : sequence of Case
        What to run.
    kept : sequence of Case
        Those of them of which all steps are kept.
    processes : int
        How many.
    progress : callable
        Called when the cases of a loop are done.
    """
    groups = by_loop(wanted)
    items = [(own, frozenset(case for case in own if case in set(kept))) for own in groups]
    found: Found = {}
    for own, part in zip(groups, each(_part, items, processes), strict=True):
        found |= part
        progress(own[0].variant or f"{own[0].law}, set {own[0].which}")
    return {case: found[case] for case in wanted}


def by_loop(wanted: Sequence[Case]) -> list[list[Case]]:
    """Return cases by the compiled loop that they share, the largest groups first."""
    groups: dict[tuple[Any, ...], list[Case]] = {}
    for case in dict.fromkeys(wanted):
        groups.setdefault(case.loop, []).append(case)
    return sorted(groups.values(), key=lambda own: -len(own))


def place(state: str) -> int:
    """Return where a state lies among the twelve."""
    return STATES.index(state)


def poles(tuning: str) -> tuple[float, float, float, float]:
    """Return the steady gains of position and velocity of the filter, and how fast its two modes decay, 1/s, slow one first.

    Of a channel whose velocity is not damped (section 11.2).
    """
    position, velocity = fsmc.steady_gain(fsmc.TUNINGS[tuning])
    F, H = np.array([[1.0, DT], [0.0, 1.0]]), np.array([[1.0, 0.0]])
    error = (np.eye(2) - np.array([[position], [velocity]]) @ H) @ F
    rates = sorted(-np.log(np.linalg.eigvals(error).astype(complex)).real / DT)
    return position, velocity, float(rates[0]), float(rates[1])


LATE = (5.0, 10.0)
"""The window in which the disturbances are there, s."""
PUSH = 0.5
"""Constant acceleration along z of scenario C, m/s^2; half the D that the paper allows."""
SHARES = (0.9, 1.05, 1.1)
RAISED = (1.0, 2.0, 4.0)
"""Factors of K_z with which scenario C is flown again."""

GAIN_SCALES, WIDTH_SCALES, FREQUENCIES = (0.25, 1.0, 2.0, 4.0, 8.0), (0.1, 0.5, 2.0, 4.0), (8.0, 15.0, 30.0, 40.0, 60.0)


# ---------------------------------------------------------------------------------------------------------------------
# Cases


def streams(law: str, runs: int, seed: int, **other: Any) -> list[Case]:
    """Return one case for each stream of noise."""
    return [Case(law, seed=seed + k, **other) for k in range(runs)]


def pushed(law: str = "FSMC", tuning: str = "printed", share: float = 1.0) -> Case:
    """Return scenario C; without a tuning the law is given the true state."""
    params = (("law.altitude.gain_z", share * GAIN["z"]),)
    return Case(law, tuning=tuning or "printed", estimated=bool(tuning), sine=0.0, push=PUSH, params=params)


def wrong(tuning: str) -> Case:
    """Return scenario E: no disturbance, and an estimate that starts wrong."""
    return Case(tuning=tuning, start="wrong estimate", sine=0.0)


def heavy(share: float, tuning: str, law: str, seed: int) -> Case:
    """Return a vehicle that weighs more or less than filter and law believe."""
    return Case(law, tuning=tuning, seed=seed, params=heavier(share))


READINGS = ("all states", "velocities", "density", "forces")
VARIANTS = ("plain", "printed Jacobian", "divided", "literal", "Runge-Kutta")


def turned(read: tuple[str, ...], tuning: str = "printed") -> Case:
    """Return a constant acceleration of roll of 0.5 rad/s^2."""
    return Case(read=read, tuning=tuning, turn=0.5, sine=0.0)


def kept(seed: int) -> list[Case]:
    """Return the cases of which all steps are kept."""
    return [Case(seed=seed), Case("SMC", seed=seed), Case("SMC"), ramp(seed), Case(seed=seed, q_of="all states")]


PUSHES = tuple((law, tuning) for tuning in (*TUNINGS, "") for law in ("SMC", "FSMC"))


def ramp(seed: int) -> Case:
    """Return the run of Fig. 13."""
    return Case(seed=seed, ramp=True, steps=2 * STEPS)


def cases(runs: int, seed: int) -> list[Case]:
    """Return every case of the study, each once."""
    made = [case for law in LAWS for case in streams(law, runs, seed)] + [Case(law) for law in LAWS]
    made += [case for tuning in TUNINGS for case in streams("FSMC", runs, seed, tuning=tuning)]
    made += [case for tuning in TUNINGS for case in streams("FSMC", runs, seed, tuning=tuning, read=FOUR)]
    made += [turned(read, tuning) for read in (Case().read, FOUR) for tuning in TUNINGS]
    made += [Case(law, seed=seed, estimated=False) for law in ("SMC", "FSMC")]
    made += [pushed(law, tuning, share) for law, tuning in PUSHES for share in RAISED]
    made += [heavy(share, tuning, law, seed) for share in SHARES for tuning in TUNINGS for law in ("SMC", "FSMC")]
    made += [
        Case(law, seed=seed, estimated=False, params=heavier(share)) for share in SHARES for law in ("SMC", "FSMC")
    ]
    made += [wrong(tuning) for tuning in TUNINGS]
    made += [Case(seed=seed, which=which, believed=believed) for which, believed in BELIEFS]
    made += [Case(seed=seed, q_of=q_of) for q_of in READINGS]
    made += [ramp(seed + k) for k in range(runs)] + [Case(seed=seed, start="far", steps=2 * STEPS)]
    made += streams("SMC", runs, seed, params=scaled(0.25))
    for law in ("SMC", "FSMC"):
        made += [Case(law, seed=seed, params=scaled(gain)) for gain in GAIN_SCALES]
        made += [Case(law, seed=seed, params=scaled(frequency=value)) for value in FREQUENCIES]
    made += [Case(seed=seed, params=scaled(width=width)) for width in WIDTH_SCALES]
    made += [Case(seed=seed, variant=variant) for variant in VARIANTS]
    return list(dict.fromkeys(made))


BELIEFS = (("A", ""), ("B", ""), ("A", "printed"), ("A", "B"))
"""Vehicle, and what filter and law believe where it is something else."""


def chattering_of(found: Found, law: str, runs: int, seed: int) -> Array:
    """Return the chattering index (4,) with noise, mean over the streams."""
    return np.asarray(np.mean([found[case].chattering[LATE] for case in streams(law, runs, seed)], axis=0))


def consistency(found: Found, tuning: str, runs: int, seed: int) -> tuple[float, float]:
    """Return the filter's own standard deviation over the error that there is, of positions and of velocities, mean of six."""
    own = [found[case] for case in streams("FSMC", runs, seed, tuning=tuning)]
    actual = np.sqrt(np.mean([item.estimation[LATE] ** 2 for item in own], axis=0))
    ratio = own[0].deviation / actual
    return float(np.mean(ratio[::2])), float(np.mean(ratio[1::2]))


def remaining(found: Found, tuning: str) -> float:
    """Return what is left after 1 s of a wrong start of the velocity of z (scenario E)."""
    error = np.abs(found[wrong(tuning)].along_z[:, 1])
    return float(error[100] / error[0])


def coefficients_of(values: Mapping[str, float]) -> dict[str, float]:
    """Return a1 .. a11 and b1 .. b3 of a vehicle by name."""
    a, b = coefficients(values)
    named = {f"a{k}": float(a[k]) for k in range(1, 12)}
    return named | {f"b{k}": float(b[k]) for k in range(1, 4)}
