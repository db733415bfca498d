"""Observers as exosystems: a Kalman filter, or a high-gain observer, that finds the state of a signal generator."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from ..reference.controllers import Range
from ..reference.regulation import HighGainOracle
from . import shared_covariance
from .block import Block, Scenario
from .errors import ModelError
from .estimators import kalman_filter, steady_state_kalman_filter
from .exosystems import Exosystem
from .plant import Plant
from .program import Assign, Element, Entry, Evaluate, IsSet, Place, Refuse, Statement, When, Within
from .regulator_equations import RegulatorError
from .signals import WIDE, Kind, Signal, Status

Array = NDArray[Any]


# -- a Kalman filter --------------------------------------------------------------------------------------------------


def exosystem_plant(
    exosystem: Exosystem,
    *,
    process_variance: Any,
    measurement_variance: Any,
    ranges: Mapping[str, tuple[float, float]] | None = None,
    together: bool = False,
    name: str = "exosystem",
) -> Plant:
    """Return a discrete exosystem as a Plant without inputs: w+ = S w + noise, and a sensor for each signal.

    Parameters
    ----------
    exosystem : Exosystem
        Discrete. States that belong to one signal become the vector state ``w_<signal>``.
    process_variance : number or dict
        D, per step, of every state; or signal -> a number, or one for each of its states.
    measurement_variance : number or dict
        M, positive, of every reading; or signal -> number.
    ranges : dict, optional
        Signal -> (low, high) of its readings. Default -1e6 .. 1e6.
    together : bool
        Whether all signals are one vector sensor, ``readings``.
    name : str
        Of the plant.

    Returns
    -------
    Plant
        For `kalman_filter`, `simulated_plant`, or whatever else takes a plant. All signals are sensors, disturbances too:
        the references alone would leave the others unobservable.

    Raises
    ------
    ModelError
        If the exosystem is continuous, a dictionary names no signal, or a variance of a reading is not positive.
    """
    if exosystem.dt is None:
        raise ModelError(f"{name}: the exosystem of {', '.join(exosystem.signals)} is continuous; give it sampled(dt)")
    _check_named(
        name, exosystem, process_variance=process_variance, measurement_variance=measurement_variance, ranges=ranges
    )
    plant = Plant(name, dt=exosystem.dt, doc=f"signal generator of {', '.join(exosystem.signals)}")
    groups = signal_groups(exosystem)
    states = [plant.state(f"w_{signal}", size=len(columns), doc=f"generates {signal}") for signal, columns in groups]
    w = ca.vertcat(*states)
    order = [k for _, columns in groups for k in columns]
    S = ca.SX(ca.sparsify(ca.DM(exosystem.matrix[np.ix_(order, order)])))
    following, start = S @ w, 0
    rates, noises = {}, {}
    for state, (signal, columns) in zip(states, groups, strict=True):
        rates[state] = following[start : start + len(columns)]
        start += len(columns)
        noises[state] = _of_signal(name, "process_variance", process_variance, signal, len(columns))
    plant.dynamics(rates)
    values = ca.SX(ca.sparsify(ca.DM(exosystem.output[:, order]))) @ w
    _declare_readings(plant, exosystem, values, measurement_variance, ranges or {}, together)
    return plant.step_noise(noises)


def _check_named(name: str, exosystem: Exosystem, **given: Any) -> None:
    """Refuse a dictionary that names what is no signal."""
    for what, value in given.items():
        unknown = sorted(set(value) - set(exosystem.signals)) if isinstance(value, Mapping) else []
        if unknown:
            raise ModelError(
                f"{name}: {what} names {', '.join(unknown)}, and the signals are {', '.join(exosystem.signals)}"
            )


def _declare_readings(
    plant: Plant,
    exosystem: Exosystem,
    values: ca.SX,
    measurement_variance: Any,
    ranges: Mapping[str, tuple[float, float]],
    together: bool,
) -> None:
    """Declare a sensor for each signal, or one for all."""
    variances = [
        _of_signal(plant.name, "measurement_variance", measurement_variance, signal, 1)[0]
        for signal in exosystem.signals
    ]
    if together:
        ends = [ranges.get(signal, (-WIDE, WIDE)) for signal in exosystem.signals]
        ends_of_all = tuple(low for low, _ in ends), tuple(high for _, high in ends)
        told = f"readings of {', '.join(exosystem.signals)}"
        plant.sensor("readings", values, variance=variances, range=ends_of_all, doc=told)
        return
    for row, (signal, variance) in enumerate(zip(exosystem.signals, variances, strict=True)):
        plant.sensor(
            signal, values[row], variance=variance, unit=exosystem.units[row], range=ranges.get(signal),
            doc=f"reading of {signal}",
        )  # fmt: skip


def signal_groups(exosystem: Exosystem) -> list[tuple[str, list[int]]]:
    """Return (signal, columns of S) for the states that belong to one signal; those of several go by the first."""
    answer: dict[str, list[int]] = {}

    def visit(part: Exosystem, start: int) -> None:
        if part.parts and len(part.signals) > 1:
            for inner in part.parts:
                visit(inner, start)
                start += inner.order
            return
        answer.setdefault(part.signals[0], []).extend(range(start, start + part.order))

    if exosystem.order:
        visit(exosystem, 0)
    return list(answer.items())


def _observes(block: Block, exosystem: Exosystem) -> Block:
    """Keep with an observer what it is an observer of."""
    vars(block)["_exosystem"] = exosystem
    return block


def observed_exosystem(block: Block) -> Exosystem | None:
    """Return the exosystem of a Block made by `kalman_exosystem` or `high_gain_exosystem`; None of any other Block."""
    found = vars(block).get("_exosystem")
    return found if isinstance(found, Exosystem) else None


def _of_signal(owner: str, what: str, given: Any, signal: str, size: int) -> list[float]:
    """Return the numbers that are given for a signal."""
    value = given.get(signal) if isinstance(given, Mapping) else given
    try:
        numbers = [float(item) for item in np.broadcast_to(np.asarray(value, dtype=float).ravel(), (size,))]
    except (TypeError, ValueError):
        numbers = [math.nan]
    low = what == "process_variance"
    if not all(math.isfinite(item) and (item >= 0 if low else item > 0) for item in numbers):
        raise ModelError(
            f"{owner}: {what} of {signal!r} is {value!r}; give {size} {'' if low else 'positive '}number(s)"
            + (", not negative" if low else "")
        )
    return numbers


def kalman_exosystem(
    exosystem: Exosystem,
    *,
    process_variance: Any,
    measurement_variance: Any,
    initial_variance: float = 1.0,
    steady: bool = False,
    together: bool = False,
    ranges: Mapping[str, tuple[float, float]] | None = None,
    name: str = "exosystem",
    doc: str = "",
    **options: Any,
) -> Block:
    """Return the Kalman filter of a signal generator: an exosystem that finds its state from noisy readings of its signals.

    Parameters
    ----------
    exosystem, process_variance, measurement_variance, ranges, name
        As for `exosystem_plant`. The variance of the process sets the bandwidth, see `bandwidth`; zero makes a fit to all
        of the past, whose gain decays.
    initial_variance : float
        Of every state, one step before the first reading of `step`.
    steady : bool
        Whether the gain is that of the steady state: no covariance is kept, at a small part of the cost. All readings then
        have one flag, ``has_readings``; for flags of their own give each signal a Block of its own. The process needs noise.
    together : bool
        Whether all signals are read at once, as one vector ``readings`` with one flag, one gate and one status, and refused at
        once: signals of one kind and one noise then have the same covariance for ever, which is kept and computed once.
    doc : str
        Its meaning.
    **options
        As for `kalman_filter`: form, gate, ...; with `together` gate (a number), reject_limit, inflation, variance_floor,
        variance_ceiling.

    Returns
    -------
    Block
        Entries `init`, `predict`, ``update_<signal>``, `step` (with a flag ``has_<signal>`` for each reading), `inflate`; memory
        ``w_<signal>``. P is a block for each part of the exosystem, and only these blocks are kept.
    """
    plant = exosystem_plant(
        exosystem,
        process_variance=process_variance,
        measurement_variance=measurement_variance,
        ranges=ranges,
        together=together,
        name=name,
    )
    told = f"the generator of {', '.join(exosystem.signals)}"
    if together:
        if steady:
            raise ModelError(f"{name}: with steady=True all readings come together anyway; leave out together=True")
        _one_noise(name, exosystem, process_variance, measurement_variance)
        text = doc or f"Kalman filter as {told}, read together"
        made = shared_covariance.build(plant, exosystem, initial_variance, name, text, options)
    elif steady:
        if options:
            raise ModelError(
                f"{name}: {', '.join(options)} is for a filter with a covariance; leave it out, or steady=True"
            )
        made = steady_state_kalman_filter(plant, name=name, doc=doc or f"Kalman filter in steady state as {told}")
    else:
        variances = {state.signal.name: float(initial_variance) for state in plant.states}
        text = doc or f"Kalman filter as {told}"
        made = kalman_filter(plant, initial_variance=variances, name=name, doc=text, **options)
    made.notes += _without_noise(exosystem, process_variance)
    return _observes(made, exosystem)


def _without_noise(exosystem: Exosystem, process_variance: Any) -> list[str]:
    """Return what has to be said of signals whose process has no noise."""
    still = [
        signal
        for signal, columns in signal_groups(exosystem)
        if not any(_of_signal("", "process_variance", process_variance, signal, len(columns)))
    ]
    if not still:
        return []
    return [
        f"No process noise for {', '.join(still)}: the gain decays like 1/k, and a reading moves the estimate less and less; a "
        "reference that is changed one day is then not followed. Give process_variance where it may be, see bandwidth."
    ]


def _one_noise(name: str, exosystem: Exosystem, process_variance: Any, measurement_variance: Any) -> None:
    """Refuse signals that differ in their noise."""
    sizes = {signal: len(columns) for signal, columns in signal_groups(exosystem)}
    for what, given, vector in (
        ("process_variance", process_variance, True),
        ("measurement_variance", measurement_variance, False),
    ):
        numbers = {
            tuple(_of_signal(name, what, given, signal, size if vector else 1)) for signal, size in sizes.items()
        }
        if len(numbers) > 1:
            raise ModelError(
                f"{name}: {what} differs between the signals, which then have no covariance in common; leave out together=True"
            )


def bandwidth(dt: float, degree: int, process_variance: float, measurement_variance: float) -> float:
    """Return up to which frequency (rad/s) the Kalman filter of a polynomial of a degree follows its signal, in steady state.

    (D / (dt^2 M))^(1 / (2 (degree + 1))): its poles are a Butterworth pattern of that radius, to within a per cent.
    """
    return float((process_variance / (dt * dt * measurement_variance)) ** (1.0 / (2 * (degree + 1))))


# -- a high-gain observer ---------------------------------------------------------------------------------------------


def high_gain_matrices(order: int, coefficients: Sequence[float], epsilon: float, dt: float) -> tuple[Array, Array]:
    """Return S (q, q) and S_H (q,) of a high-gain observer by Euler: w+ = S w + S_H psi, w_1 following psi.

    S = I + dt (N - [a_i / epsilon^i] Q), S_H = dt [a_i / epsilon^i]; where it has converged, w+ = (S + S_H Q) w, which is
    the polynomial exosystem sampled by Euler: the regulator equations are to be solved with that one.
    """
    numbers = np.asarray(coefficients, dtype=float).ravel()
    gains = dt * numbers / epsilon ** np.arange(1, order + 1)
    S = np.eye(order) + dt * np.eye(order, k=1)
    S[:, 0] -= gains
    return S, gains


def high_gain_exosystem(
    exosystem: Exosystem,
    *,
    coefficients: Sequence[float],
    epsilon: float,
    initial: Mapping[str, Sequence[float]] | None = None,
    ranges: Mapping[str, tuple[float, float]] | None = None,
    accept_unstable: bool = False,
    name: str = "exosystem",
    doc: str = "",
) -> Block:
    """Return a high-gain observer for each signal: w_i' = w_(i+1) + (a_i / epsilon^i) (psi - w_1), by Euler.

    Parameters
    ----------
    exosystem : Exosystem
        Polynomials of one degree, sampled by Euler, side by side: what the observer is an observer of.
    coefficients : sequence of float
        a_1 .. a_q of the Hurwitz polynomial s^q + a_1 s^(q-1) + ... + a_q, q being the degree and one.
    epsilon : float
        How fast, in seconds.
    initial : dict, optional
        Signal -> w_0: a warm start. Default zero; from there the observer peaks, see the notes of the block.
    ranges : dict, optional
        Signal -> (low, high) of its readings. Default -1e6 .. 1e6.
    accept_unstable : bool
        Whether an observer that does not converge is accepted.
    name, doc : str
        Name of the block, and its meaning.

    Returns
    -------
    Block
        Entries `init` and `step`: a reading and its flag ``has_<signal>`` for each signal; outputs ``w_<signal>``, what was known
        before the readings of this step. Without a reading a channel coasts. The gains are run-time parameters.

    Raises
    ------
    RegulatorError
        If the sampled observer does not converge; the sentence has the spectral radius.
    ModelError
        If the exosystem is something else, or the coefficients are too few.
    """
    channels = _channels(name, exosystem, coefficients)
    assert exosystem.dt is not None
    if not (isinstance(epsilon, (int, float)) and math.isfinite(epsilon) and epsilon > 0):
        raise ModelError(f"{name}: epsilon is {epsilon!r}; give a positive number of seconds")
    _check_given(name, exosystem, initial or {}, ranges or {}, channels[0][1])
    S, gains = high_gain_matrices(channels[0][1], coefficients, epsilon, exosystem.dt)
    deadbeat = is_nilpotent(S)
    radius = 0.0 if deadbeat else float(np.max(np.abs(np.linalg.eigvals(S))))
    if not radius < 1 - 1e-12 and not accept_unstable:
        raise RegulatorError(
            f"{name}: the observer does not converge: its spectral radius is {radius:.8g}, not below 1; take a larger "
            "epsilon, or other coefficients"
        )
    block = Block(name, doc=doc or f"high-gain observer as the generator of {', '.join(exosystem.signals)}")
    block.sample_time = exosystem.dt
    body, inputs, outputs = _declare_channels(block, exosystem, channels, S, gains, initial or {}, ranges or {})
    names = [signal.name for signal in block.memory_signals]
    body.append(Refuse(Status.OVERFLOW, block.judge_memory(names)))
    start = [Assign(Place("next", item), Place("param", f"{item}_0"), len(S)) for item in names]
    init = Entry(
        "init", (), (), tuple(start), "Start (or start again) from the parameters; every parameter is checked here.",
        checks_params=True,
    )  # fmt: skip
    step = Entry("step", tuple(inputs), tuple(outputs), tuple(body), "Hand out what is known, then take the readings.")
    block.entries = {"init": init, "step": step}
    block.notes = _high_gain_notes(S, gains, deadbeat, radius)
    block.source_hash = repr((S.tolist(), gains.tolist(), exosystem.signals))
    block.check()
    coasting = S.copy()
    coasting[:, 0] += gains
    _finish_high_gain(block, [(signal, coasting, gains) for signal, _ in channels], ranges or {})
    return _observes(block, exosystem)


def _check_given(
    name: str,
    exosystem: Exosystem,
    initial: Mapping[str, Sequence[float]],
    ranges: Mapping[str, tuple[float, float]],
    order: int,
) -> None:
    """Refuse what is given for a signal that there is not, or of another size."""
    for what, given, size in (("initial", initial, order), ("ranges", ranges, 2)):
        unknown = sorted(set(given) - set(exosystem.signals))
        if unknown:
            raise ModelError(
                f"{name}: {what} names {', '.join(unknown)}, and the signals are {', '.join(exosystem.signals)}"
            )
        for signal, values in given.items():
            if np.shape(values) != (size,):
                raise ModelError(f"{name}: {what} of {signal!r} is {values!r}; give {size} numbers")


def _channels(name: str, exosystem: Exosystem, coefficients: Sequence[float]) -> list[tuple[str, int]]:
    parts = exosystem.parts or (exosystem,)
    kinds = {(part.kind, part.order) for part in parts if len(part.signals) == 1}
    order = parts[0].order
    fits = all(
        part.kind in ("polynomial", "constant") and (part.method == "euler" or part.order == 1) for part in parts
    )
    if exosystem.dt is None or not fits or len({size for _, size in kinds}) != 1:
        raise ModelError(
            f"{name}: a high-gain observer is for polynomials of one degree, sampled by Euler; give "
            "compose([polynomial(...), ...]).sampled(dt, 'euler')"
        )
    if len(np.ravel(coefficients)) != order or not np.all(np.isfinite(np.asarray(coefficients, dtype=float))):
        raise ModelError(f"{name}: {len(np.ravel(coefficients))} coefficient(s) are given; give {order} finite numbers")
    return [(part.signals[0], order) for part in parts]


def _declare_channels(
    block: Block,
    exosystem: Exosystem,
    channels: list[tuple[str, int]],
    S: Array,
    gains: Array,
    initial: Mapping[str, Sequence[float]],
    ranges: Mapping[str, tuple[float, float]],
) -> tuple[list[Statement], list[Signal], list[Signal]]:
    """Declare memory and parameters; return the body of `step`, its inputs and its outputs."""
    body: list[Statement] = []
    inputs, outputs = [], []
    units = dict(zip(exosystem.signals, exosystem.units, strict=True))
    chain = S.copy()
    chain[:, 0] += gains
    for signal, q in channels:
        w = block.memory(
            f"observer_{signal}",
            initial=tuple(initial.get(signal, (0.0,) * q)),
            doc=f"{signal} and its derivatives, predicted",
        )
        gain = block.parameter(
            f"gain_{signal}",
            tuple(float(f"{item:.8e}") for item in gains),
            range=(-1e12, 1e12),
            doc="of the innovation",
        )
        low, high = ranges.get(signal, (-WIDE, WIDE))
        reading = Signal(signal, 1, units[signal], (float(low),), (float(high),), f"reading of {signal}")
        flag = Signal(
            f"has_{signal}", kind=Kind.FLAG, low=(0.0,), high=(1.0,), doc=f"whether there is a reading of {signal}"
        )
        inputs += [flag, reading]
        outputs.append(
            Signal(f"w_{signal}", q, "", (-WIDE,) * q, (WIDE,) * q, f"{signal} and its derivatives, before the reading")
        )
        psi, memory = ca.SX.sym("psi"), Place("memory", f"observer_{signal}")
        target = Place("next", f"observer_{signal}")
        coasting = ca.SX(ca.sparsify(ca.DM(chain))) @ w
        observed = coasting + ca.SX(gain) * (psi - w[0])
        names = (tuple(f"next_{signal}_{i}" for i in range(q)),)
        own, away = ((memory, q),), ((Place("in", signal), 1),)
        observe = ca.Function(f"{block.name}_observe_{signal}", [ca.SX(w), ca.SX(gain), psi], [ca.densify(observed)])
        coast = ca.Function(f"{block.name}_coast_{signal}", [ca.SX(w)], [ca.densify(coasting)])
        body.append(Assign(Place("out", f"w_{signal}"), memory, q))
        body.append(
            When(
                IsSet(Element(Place("in", f"has_{signal}"))),
                (
                    Refuse(Status.BAD_INPUT, Within(Place("in", signal), reading.low, reading.high)),
                    Evaluate(
                        observe, (own, ((Place("param", f"gain_{signal}"), q),), away), (((target, q),),), names,
                        (f"w = F w + gain ({signal} - w[0])",),
                    ),
                ),
                (Evaluate(coast, (own,), (((target, q),),), names, ("w = F w",)),),
                signal,
            )
        )  # fmt: skip
    return body, inputs, outputs


def is_nilpotent(S: Array) -> bool:
    """Whether S^q = 0, to rounding of its own terms: an observer that then has converged after q steps (deadbeat)."""
    size = np.abs(S)
    return bool(np.all(np.abs(np.linalg.matrix_power(S, len(S))) <= 1e-12 * np.linalg.matrix_power(size, len(S))))


def peaking(S: Array, gains: Array, steps: int = 1000) -> Array:
    """Return how far each state of an observer that starts at zero swings, for a signal that is one from the start.

    Returns
    -------
    array (q,)
        Largest magnitudes within some steps.
    """
    w, most = np.zeros(len(S)), np.zeros(len(S))
    for _ in range(steps):
        w = S @ w + gains
        most = np.maximum(most, np.abs(w))
    return most


def noise_gain(S: Array, gains: Array) -> Array:
    """Return the standard deviation of each state of a stable observer, for readings that are white noise of one.

    Returns
    -------
    array (q,)
        Root of the diagonal of X = S X S' + S_H S_H'.
    """
    total, power = np.zeros((len(S), len(S))), np.array(gains, dtype=float)
    for _ in range(100000):
        total += np.outer(power, power)
        power = S @ power
        if float(np.max(np.abs(power))) < 1e-12 * float(np.max(np.abs(gains))):
            break
    return np.asarray(np.sqrt(np.diag(total)))


def _high_gain_notes(S: Array, gains: Array, deadbeat: bool, radius: float) -> list[str]:
    most = ", ".join(f"{item:.4g}" for item in peaking(S, gains))
    notes = [
        f"From a cold start (w = 0) a signal that is 1 makes the states swing up to {most}: start warm where that matters."
    ]
    if deadbeat:
        notes.append(f"Deadbeat: S is nilpotent, and after {len(S)} readings w is that of the polynomial through them.")
    else:
        notes.append(f"Spectral radius of the observer: {radius:.6g}.")
    return notes


def _finish_high_gain(
    block: Block, channels: list[tuple[str, Array, Array]], ranges: Mapping[str, tuple[float, float]]
) -> None:
    def of(signal: Signal) -> Range:
        return Range(signal.name, signal.low, signal.high)

    readings = [signal for signal in block.entries["step"].inputs if signal.kind is Kind.REAL]
    block.oracle = HighGainOracle(
        tuple(channels),
        tuple(of(signal) for signal in block.memory_signals),
        tuple(of(signal) for signal in block.param_signals),
        tuple(of(signal) for signal in readings),
    )

    def calls(rng: Any, steps: int) -> Iterator[tuple[str, dict[str, Any]]]:
        yield "init", {}
        phase = rng.uniform(0, 6, len(channels))
        for k in range(steps):
            inputs: dict[str, Any] = {}
            for (signal, _, _), start in zip(channels, phase, strict=True):
                low, high = ranges.get(signal, (-10.0, 10.0))
                value = 0.5 * (low + high) + 0.4 * (high - low) * math.sin(0.05 * k + start) + 1e-3 * rng.normal()
                inputs |= {signal: float(np.clip(value, low, high)), f"has_{signal}": float(rng.uniform() < 0.85)}
            yield "step", inputs

    def memory(rng: Any) -> dict[str, Any]:
        return {signal.name: rng.uniform(-5, 5, signal.size) for signal in block.memory_signals}

    block.scenario = Scenario(calls, memory)
