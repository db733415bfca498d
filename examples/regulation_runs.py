"""The loops of the study regulation2023: a generator's estimates first, then many closed loops side by side, in plain NumPy.

Numbers and conventions are those of specs/output_regulation.md, sections 5 to 12: at k = 0 the Kalman filter corrects without a
prediction and the loop uses what it knows after the reading; the high-gain observer's what it knew before; x_0 = 0.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray
from plantc.examples.quadrotor_regulator import (
    T,
    hover,
    measurement_variance,
    near,
    process_variance,
    quadrotor,
    references,
    set_point,
    tracks,
)
from plantc.symbolic import Plant, cos, sin
from plantc.symbolic.analysis import linearise
from plantc.symbolic.design import lqr
from plantc.symbolic.exosystems import Exosystem, compose, constant, exosystem, harmonic, polynomial, superpose
from plantc.symbolic.power_series import regulator_series
from plantc.symbolic.regulator_equations import RegulatorSolution, francis, linear_model
from plantc.symbolic.signal_generators import high_gain_matrices

Array = NDArray[Any]

STEPS = 5000
OUTPUTS = (0, 2, 4, 10)  # x, y, z and yaw in the state
FAST, SLOW = np.pi / 20 + 0.1, np.pi / 20  # rad/s, of the two sinusoids of psi_1
LOST = 1e4


def psi(t: Array) -> Array:
    """Return the references of the paper at times t (s), shape (times, 4): x, y, z in metres and yaw in radians."""
    return np.stack([np.sin(SLOW * t) + np.sin(FAST * t), np.cos(SLOW * t), 5 + 0 * t, 0 * t], axis=-1)


TIMES = T * np.arange(STEPS + 1)
WANTED = psi(TIMES)


def readings(noise: float = 0.0, seed: int = 0, steps: int = STEPS) -> Array:
    """Return what is measured of the references, shape (steps + 1, 4): white noise of a standard deviation is added."""
    drawn = np.random.default_rng(seed).standard_normal((steps + 1, 4))
    return psi(T * np.arange(steps + 1)) + noise * drawn


# ---------------------------------------------------------------------------------------------------------------------
# Generators


def kalman_gains(degree: int, D: float, M: float, steps: int, P_0: float = 1.0) -> Array:
    """Return the gains of the Kalman filter of one polynomial, sampled by Euler, shape (steps + 1, degree + 1)."""
    S = np.eye(degree + 1) + T * np.eye(degree + 1, k=1)
    P, gains = P_0 * np.eye(degree + 1), []
    for k in range(steps + 1):
        if k:
            P = S @ P @ S.T + D * np.eye(degree + 1)
        G = P[:, 0] / (P[0, 0] + M)
        P = P - np.outer(G, P[0])
        P = (P + P.T) / 2
        gains.append(G)
    return np.array(gains)


def kalman_estimates(
    degree: int, given: Array, D: float = process_variance, M: float = measurement_variance, P_0: float = 1.0
) -> Array:
    """Return what Kalman filters of polynomials of a degree know after the reading of each step.

    Parameters
    ----------
    degree : int
    given : (steps, cases, channels) array
        Readings.
    D, M, P_0 : float
        Variances of process, readings, and of the state before the first reading.

    Returns
    -------
    array (steps, cases, channels * (degree + 1))
    """
    steps, cases, channels = given.shape
    S, z = np.eye(degree + 1) + T * np.eye(degree + 1, k=1), given.reshape(steps, -1)
    w = np.zeros((z.shape[1], degree + 1))
    found = np.empty((steps, *w.shape))
    for k, G in enumerate(kalman_gains(degree, D, M, steps - 1, P_0)):
        if k:
            w = w @ S.T
        w = w + (z[k] - w[:, 0])[:, None] * G
        found[k] = w
    return found.reshape(steps, cases, channels * (degree + 1))


def high_gain_estimates(given: Array, *, warm: bool) -> Array:
    """Return what the paper's high-gain observers know before the reading of each step, shape (steps, cases, 2 channels)."""
    steps, cases, channels = given.shape
    S, gains = high_gain_matrices(2, (2.0, 1.0), T, T)
    z = given.reshape(steps, -1)
    w = np.zeros((z.shape[1], 2))
    if warm:
        start = np.stack([psi(np.zeros(1))[0], [SLOW + FAST, 0.0, 0.0, 0.0]], axis=1)
        w = np.tile(start, (cases, 1))
    found = np.empty((steps, *w.shape))
    for k in range(steps):
        found[k] = w
        w = w @ S.T + z[k][:, None] * gains
    return found.reshape(steps, cases, 2 * channels)


# ---------------------------------------------------------------------------------------------------------------------
# Maps and gains


@cache
def maps(degree: int) -> RegulatorSolution:
    """Return Pi and Gamma for polynomials of a degree, plant and exosystem sampled by Euler."""
    return francis(near, tracks(degree))


@cache
def gain(q: float) -> Array:
    """Return K of u = u* - K (x - x*) that minimises q |x|^2 + |u|^2 on the sampled linearisation."""
    return lqr(near, q * np.eye(12), np.eye(4)).gain


def harmonics() -> Exosystem:
    """Return the exosystem that generates the paper's references exactly, continuous, of 8 states."""
    first = superpose([harmonic("x", SLOW), harmonic("x", FAST)])
    return compose([first, harmonic("y", SLOW), constant("z"), constant("yaw")])


@cache
def known_maps(kind: str) -> RegulatorSolution:
    """Return Pi and Gamma for it: "euler" or "exact" for the sampled plant, the exosystem sampled exactly; or "continuous"."""
    continuous = francis(linearise(quadrotor, set_point), harmonics())
    if kind == "continuous":
        return continuous
    return francis(continuous.model.sampled(T, kind), harmonics().sampled(T))


def known_states() -> Array:
    """Return its states at k = 0 .. STEPS, shape (STEPS + 1, 8)."""
    own = harmonics()
    sampled = own.sampled(T)
    w, found = own.initial({"x": [[0, 1], [0, 1]], "y": [1, 0], "z": 5, "yaw": 0}), []
    for _ in range(STEPS + 1):
        found.append(w)
        w = sampled.matrix @ w
    return np.array(found)


# ---------------------------------------------------------------------------------------------------------------------
# Loops


@dataclass(frozen=True)
class Aim:
    """What a loop is told at every step: where the plant should be, and what should keep it there.

    Attributes
    ----------
    state, command : (steps, n) and (steps, p) array
        Pi w and Gamma w, deviations from the operating point.
    gain : (p, n) array
        K of u = u* + Gamma w - K (x - x* - Pi w).
    start : (n,) array
        x_0.
    """

    state: Array
    command: Array
    gain: Array
    start: Array


def aim(solution: RegulatorSolution, w: Array, K: Array, start: Array | None = None) -> Aim:
    """Return the aim of a generator's states (steps, r)."""
    state, command = w @ solution.state_map.T, w @ solution.input_map.T
    return Aim(state, command, K, np.zeros(state.shape[1]) if start is None else start)


@dataclass(frozen=True)
class Flight:
    """What one loop did.

    Attributes
    ----------
    states, commands : (steps, n) and (steps, p) array
        Up to where it ended.
    ended : float or None
        Time (s) at which a state was beyond 1e4 or no number; None if that never happened.
    """

    states: Array
    commands: Array
    ended: float | None

    def rms(self, wanted: Array, start: float, stop: float = 100.0) -> Array:
        """Return the root mean square of outputs less what is wanted (steps, 4), between two times; NaN if it ended."""
        if self.ended is not None:
            return np.full(wanted.shape[1], np.nan)
        return rms(self.states[:, OUTPUTS] - wanted, start, stop)

    def energy(self, start: float = 20.0) -> float:
        """Return the control energy: the integral of |u - u*|^2 from some time on, in rad^2/s."""
        if self.ended is not None:
            return float("nan")
        return float(T * np.sum((self.commands[round(start / T) :] - hover) ** 2))


def rms(values: Array, start: float, stop: float) -> Array:
    """Return the root mean square of rows between two times, both included."""
    return np.asarray(np.sqrt(np.mean(values[round(start / T) : round(stop / T) + 1] ** 2, axis=0)))


@cache
def moves(kind: str, cases: int) -> Callable[[Array, Array], Array]:
    """Return one step of many quadrotors, (cases, 12) and (cases, 4) -> (cases, 12).

    `kind`: "euler"; "rk4", two Runge-Kutta steps with the command held, the truth; or "linear".
    """
    x, u = quadrotor.x, quadrotor.u
    if kind == "linear":
        A, B = near.A, near.B
        return lambda states, commands: states @ A.T + (commands - hover) @ B.T
    rate = ca.Function("rate", [x, u], [quadrotor.dynamics_expression()])
    if kind == "euler":
        following = x + T * rate(x, u)
    else:
        following, h = x, T / 2
        for _ in range(2):
            k1 = rate(following, u)
            k2 = rate(following + h / 2 * k1, u)
            k3 = rate(following + h / 2 * k2, u)
            k4 = rate(following + h * k3, u)
            following = following + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    together = ca.Function("step", [x, u], [following]).map(cases)
    return lambda states, commands: np.asarray(together(states.T, commands.T).full()).T


def fly(kind: str, aims: Sequence[Aim]) -> list[Flight]:
    """Run closed loops side by side.

    Parameters
    ----------
    kind : {"euler", "rk4", "linear"}
        Plant; see `moves`.
    aims : sequence of Aim
        One for each loop, of as many steps.
    """
    steps, cases = len(aims[0].state), len(aims)
    step = moves(kind, cases)
    wanted = np.stack([item.state for item in aims], axis=1)
    command = np.stack([item.command for item in aims], axis=1) + hover
    K = np.stack([item.gain for item in aims])
    x = np.stack([item.start for item in aims])
    states, commands = np.empty((steps, cases, 12)), np.empty((steps, cases, 4))
    ended = np.full(cases, steps)
    for k in range(steps):
        flying = ended == steps
        gone = flying & ~np.all(np.abs(x) <= LOST, axis=1)
        if np.any(gone):
            ended[gone] = k
            flying = ended == steps
        x = np.where(flying[:, None], x, 0.0)
        u = command[k] - np.einsum("bij,bj->bi", K, x - wanted[k])
        u = np.where(flying[:, None], u, hover)
        states[k], commands[k] = x, u
        x = step(x, u)
    return [
        Flight(states[:end, b], commands[:end, b], None if end == steps else float(T * end))
        for b, end in enumerate(ended)
    ]


# ---------------------------------------------------------------------------------------------------------------------
# What the linear theory says


def estimate_responses(degree: int, D: float = process_variance) -> Array:
    """Return H(e^(jwT)) of the filter in steady state, from a signal to its estimate, at the two frequencies, shape (2,)."""
    S, G = np.eye(degree + 1) + T * np.eye(degree + 1, k=1), kalman_gains(degree, D, measurement_variance, 20000)[-1]
    left = (np.eye(degree + 1) - np.outer(G, np.eye(degree + 1)[0])) @ S
    turns = [np.exp(1j * w * T) for w in (SLOW, FAST)]
    return np.array([np.linalg.solve(z * np.eye(degree + 1) - left, z * G)[0] for z in turns])


def predicted_amplitudes(degree: int, D: float = process_variance) -> Array:
    """Return the amplitude (m) of the error of x for each of the two sinusoids of psi_1, in steady state, shape (2,)."""
    solution, q = maps(degree), degree + 1
    G = kalman_gains(degree, D, measurement_variance, 20000)[-1]
    S = np.eye(q) + T * np.eye(q, k=1)
    Pi, closed = solution.state_map[:, :q], near.A - near.B @ gain(100.0)
    found = []
    for w in (SLOW, FAST):
        z = np.exp(1j * w * T)
        after = np.linalg.solve(z * np.eye(q) - (np.eye(q) - np.outer(G, np.eye(q)[0])) @ S, z * G)
        innovation = 1 - (S @ after)[0] / z
        away = np.linalg.solve(z * np.eye(12) - closed, -z * (Pi @ G) * innovation)
        found.append(abs(away[0] + after[0] - 1))
    return np.array(found)


def references_text() -> str:
    """Return the references in words."""
    return f"{', '.join(references)}: sin(pi t/20) + sin((pi/20 + 0.1) t), cos(pi t/20), 5, 0; sampled at {1 / T:g} Hz"


# ---------------------------------------------------------------------------------------------------------------------
# Disturbances (section 11), and a nonlinear exosystem map (section 12)

SMALL = linear_model([[0, 1], [-1, -0.4]], [[0], [1]], [[1, 0]], E=[[0.5], [1]], name="small plant")
"""Position is regulated; the disturbance d_0 also enters where the input does not reach."""


def rejected(generator: Exosystem, w: Array, wanted: Array, wind: Array, start: Sequence[float]) -> dict[str, Array]:
    """Return the error of the small plant, sampled by Euler, with P_d in the regulator equations and without.

    Parameters
    ----------
    generator : Exosystem
        Discrete, signals "y_0" and "d_0".
    w : (steps, r) array
        What the regulator knows of its state.
    wanted, wind : (steps,) array
        Reference, and disturbance.
    start : sequence
        x_0.
    """
    plant = SMALL.sampled(T, "euler")
    K = lqr((plant.A, plant.B, T), np.diag([100.0, 10.0]), np.eye(1)).gain
    answer = {}
    for name, model in (("with P_d", plant), ("without P_d", replace(plant, E=0 * plant.E))):
        solution, x, errors = francis(model, generator), np.array(start, dtype=float), []
        for k, known in enumerate(w):
            errors.append(x[0] - wanted[k])
            u = solution.input_map @ known - K @ (x - solution.state_map @ known)
            x = plant.A @ x + plant.B @ u + plant.E[:, 0] * wind[k]
        answer[name] = np.array(errors)
    return answer


@cache
def disturbance_cases(seed: int = 0) -> dict[str, dict[str, Array]]:
    """Return the errors of the small plant over 60 s: case -> with and without P_d."""
    t, answer = T * np.arange(3001), {}
    own = harmonics_of_disturbance().sampled(T)
    w = [np.array([0.0, 1.0, 1.0, 0.0, 0.3])]
    for _ in range(3000):
        w.append(own.matrix @ w[-1])
    signals = np.array(w) @ own.output.T
    answer["known harmonics"] = rejected(own, np.array(w), signals[:, 0], signals[:, 1], [1.0, 0.0])
    noise = 0.1 * np.random.default_rng(seed).standard_normal((3001, 2))
    line = np.stack([1 + 0.2 * t - 0.01 * t**2, 0.5 + 0.1 * t], axis=1)
    waves = np.stack([np.sin(0.5 * t), 0.8 * np.cos(0.9 * t) + 0.3], axis=1)
    for name, degree, D, signals, added in (
        ("polynomials, degree 2, D = 1e-4", 2, 1e-4, line, 0.0),
        ("noisy sinusoids, degree 2, D = 1e-4", 2, 1e-4, waves, 1.0),
        ("noisy sinusoids, degree 4, D = 1e-4", 4, 1e-4, waves, 1.0),
        ("noisy sinusoids, degree 4, D = 1e-2", 4, 1e-2, waves, 1.0),
    ):
        generator = compose([polynomial(item, degree) for item in ("y_0", "d_0")]).sampled(T, "euler")
        w_hat = kalman_estimates(degree, (signals + added * noise)[:, None, :], D)[:, 0]
        answer[name] = rejected(generator, w_hat, signals[:, 0], signals[:, 1], [0.0, 0.0])
    return answer


def harmonics_of_disturbance() -> Exosystem:
    """Return blkdiag(harm(0.5), harm(0.9), 0), continuous: the disturbance is 0.8 w_3 + w_5."""
    S = np.zeros((5, 5))
    S[0, 1], S[1, 0], S[2, 3], S[3, 2] = 0.5, -0.5, 0.9, -0.9
    Q = [[1, 0, 0, 0, 0], [0, 0, 0.8, 0, 1]]
    made = exosystem(S, Q, ["y_0", "d_0"])
    return replace(made, eigenvalues=np.array([0.5j, -0.5j, 0.9j, -0.9j, 0]))


def wind_errors() -> dict[str, float]:
    """Return the error (m) of x of the quadrotor, linear, after 40 s in a measured wind of 1 m/s^2, references zero."""
    plant = francis(near, tracks(2)).model
    E = np.zeros((12, 1))
    E[1] = T
    windy = replace(plant, E=E, F=np.zeros((4, 1)), disturbances=("wind",))
    generator = compose([tracks(2), polynomial("wind", 2).sampled(T, "euler")])
    given = np.zeros((2001, 1, 5))
    given[..., 4] = 1.0
    w, K, answer = kalman_estimates(2, given)[:, 0], gain(100.0), {}
    for name, model in (("with P_d", windy), ("without P_d", replace(windy, E=0 * E))):
        solution, x = francis(model, generator), np.zeros(12)
        for known in w[:-1]:
            u = solution.input_map @ known - K @ (x - solution.state_map @ known)
            x = plant.A @ x + plant.B @ u + E[:, 0]
        answer[name] = float(x[0])
    return answer


LENGTH, GRAVITY = 0.5, 9.81


def cart_pole() -> Plant:
    """Return a pole on a cart whose acceleration is the input; tilt is from upright."""
    plant = Plant("cart_pole", doc="pole on a cart whose acceleration is commanded")
    p, v = plant.state("p", unit="m"), plant.state("v", unit="m/s")
    tilt, rate = plant.state("tilt", unit="rad"), plant.state("rate", unit="rad/s")
    push = plant.input("push", unit="m/s^2")
    plant.dynamics({p: v, v: push, tilt: rate, rate: (GRAVITY * sin(tilt) - push * cos(tilt)) / LENGTH})
    return plant


def cart_pole_errors(amplitudes: Sequence[float] = (0.4, 0.8), orders: Sequence[int] = (1, 3, 5)) -> Array:
    """Return the largest error (m) over the last three periods of 30 s, shape (amplitudes, orders).

    The cart is to follow A sin(2 t), the pole upright; the map is the power series up to an order, the gain the linear-quadratic
    one of the linearisation, Runge-Kutta with 0.005 s, from rest.
    """
    plant = cart_pole()
    series = regulator_series(plant, {}, harmonic("p", 2.0), max(orders))
    K = lqr(linearise(plant), np.diag([10.0, 1, 10, 1]), np.eye(1)).gain[0]
    h, size = 0.005, np.repeat(amplitudes, len(orders))
    t = h / 2 * np.arange(12001)  # halves of a step
    w = size[:, None] * np.sin(2 * t), size[:, None] * np.cos(2 * t)
    order = np.tile(orders, len(amplitudes))
    held = np.zeros((5, len(size), len(t)))
    for row, terms in zip(held, [*series.terms()[0], *series.terms()[1]], strict=True):
        for (first, second), value in terms:
            row += (order >= first + second)[:, None] * value * w[0] ** first * w[1] ** second

    def rate(x: Array, k: int) -> Array:
        u = held[4, :, k] - K @ (x - held[:4, :, k])
        return np.array([x[1], u, x[3], (GRAVITY * np.sin(x[2]) - u * np.cos(x[2])) / LENGTH])

    x, worst = np.zeros((4, len(size))), np.zeros(len(size))
    for k in range(0, 12000, 2):
        k1 = rate(x, k)
        k2 = rate(x + h / 2 * k1, k + 1)
        k3 = rate(x + h / 2 * k2, k + 1)
        k4 = rate(x + h * k3, k + 2)
        x = x + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        if t[k + 2] >= 30 - 3 * np.pi:
            worst = np.maximum(worst, np.abs(x[0] - w[0][:, k + 2]))
    return worst.reshape(len(amplitudes), len(orders))
