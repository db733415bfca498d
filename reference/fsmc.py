"""A quadrotor, an extended Kalman filter and a fuzzy sliding mode law as plain NumPy: the whole loop, step by step.

F. Ghanai, A. Medjghou, K. Chafaa, "Extended Kalman filter based fuzzy sliding mode control of a quadrotor", Advances in
Electrical and Electronic Engineering 16(4), 2018. What the paper leaves open, and its misprints, are settled in
specs/ekf_fsmc.md; section numbers are those of that page. It shares no code with what is generated.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .controllers import Fields

Array = NDArray[np.float64]
Law = Callable[[float], float]

DT = 1e-3
"""Seconds per step."""

POSITIONS, VELOCITIES = np.arange(0, 12, 2), np.arange(1, 12, 2)
ANGLE_LIMIT, LEAST_COSINE, LEAST_THRUST = 0.5, 0.2, 0.2
"""Of the sines of roll and pitch asked for; of cos(roll) cos(pitch) divided by; of the weight, the least thrust."""

FAR = 1e3
"""A run is over when a state is beyond it."""


@dataclass(frozen=True)
class Vehicle:
    """The physical values of section 2; the defaults are set A.

    Attributes
    ----------
    mass, arm, gravity : float
        kg, m, m/s^2.
    inertia, rotational_drag, translational_drag : tuple of 3 float
        kg m^2, N m s^2/rad^2, N s/m; about or along x, y, z.
    rotor_inertia, thrust, drag, fastest : float
        kg m^2; N s^2/rad^2; N m s^2/rad^2; largest speed of a rotor in rad/s.
    """

    mass: float = 0.4
    arm: float = 0.205
    inertia: tuple[float, float, float] = (3.8278e-3, 3.8278e-3, 7.1345e-3)
    rotational_drag: tuple[float, float, float] = (5.567e-4, 5.567e-4, 6.354e-4)
    translational_drag: tuple[float, float, float] = (0.032, 0.032, 0.048)
    rotor_inertia: float = 2.8385e-5
    thrust: float = 2.9842e-5
    drag: float = 3.2320e-7
    gravity: float = 9.81
    fastest: float = 400.0

    @cached_property
    def a(self) -> tuple[float, ...]:
        """The coefficients a1 .. a11, at 1 .. 11."""
        Ix, Iy, Iz = self.inertia
        fx, fy, fz = self.rotational_drag
        tx, ty, tz = (item / self.mass for item in self.translational_drag)
        roll = ((Iy - Iz) / Ix, -fx / Ix, -self.rotor_inertia / Ix)
        pitch = ((Iz - Ix) / Iy, -fy / Iy, self.rotor_inertia / Iy)
        return (0.0, *roll, *pitch, (Ix - Iy) / Iz, -fz / Iz, -tx, -ty, -tz)

    @cached_property
    def b(self) -> tuple[float, ...]:
        """The coefficients b1 .. b3, at 1 .. 3."""
        Ix, Iy, Iz = self.inertia
        return (0.0, self.arm / Ix, self.arm / Iy, 1.0 / Iz)


SET_A = Vehicle()
SET_B = Vehicle(
    mass=0.486,
    arm=0.25,
    inertia=(3.8278e-3, 3.8288e-3, 7.6566e-3),
    translational_drag=(5.567e-4, 5.567e-4, 6.354e-4),
)
SETS = {"A": SET_A, "B": SET_B}


# -- the vehicle ------------------------------------------------------------------------------------------------------


def accelerations(vehicle: Vehicle, X: Array, u: Array, Om: float) -> Array:
    """Return the six accelerations A(X, u, Om) of (phi, theta, psi, x, y, z), section 3.

    Parameters
    ----------
    vehicle : Vehicle
        Its values.
    X : array (12,)
        State (phi, phi', theta, theta', psi, psi', x, x', y, y', z, z').
    u : array (4,)
        Thrust (N), differential thrusts for roll and pitch (N), yaw torque (N m).
    Om : float
        Residual speed of the rotors, rad/s.
    """
    a, b = vehicle.a, vehicle.b
    x1, x2, x3, x4, x5, x6, _, x8, _, x10, _, x12 = X.tolist()
    u1, u2, u3, u4 = map(float, u)
    C1, S1, C3, S3, C5, S5 = math.cos(x1), math.sin(x1), math.cos(x3), math.sin(x3), math.cos(x5), math.sin(x5)
    lift = u1 / vehicle.mass
    return np.array(
        [
            a[1] * x4 * x6 + a[2] * x2**2 + a[3] * Om * x4 + b[1] * u2,
            a[4] * x2 * x6 + a[5] * x4**2 + a[6] * Om * x2 + b[2] * u3,
            a[7] * x2 * x4 + a[8] * x6**2 + b[3] * u4,
            lift * (C1 * S3 * C5 + S1 * S5) + a[9] * x8,
            lift * (C1 * S3 * S5 - S1 * C5) + a[10] * x10,
            lift * C1 * C3 + a[11] * x12 - vehicle.gravity,
        ]
    )


def rates(vehicle: Vehicle, X: Array, u: Array, Om: float, d: Array | float = 0.0) -> Array:
    """Return X', with the accelerations d (6,) of the disturbance."""
    answer = np.empty(12)
    answer[POSITIONS] = X[VELOCITIES]
    answer[VELOCITIES] = accelerations(vehicle, X, u, Om) + d
    return answer


def euler(vehicle: Vehicle, X: Array, u: Array, Om: float, d: Array | float = 0.0) -> Array:
    """Return the state one step later, positions and velocities advanced from the old values."""
    return X + DT * rates(vehicle, X, u, Om, d)


def runge_kutta(vehicle: Vehicle, X: Array, u: Array, Om: float, d: Array | float = 0.0) -> Array:
    """Return the state one step later by the classical method of fourth order, all inputs held."""
    k1 = rates(vehicle, X, u, Om, d)
    k2 = rates(vehicle, X + DT / 2 * k1, u, Om, d)
    k3 = rates(vehicle, X + DT / 2 * k2, u, Om, d)
    k4 = rates(vehicle, X + DT * k3, u, Om, d)
    return X + DT / 6 * (k1 + 2 * k2 + 2 * k3 + k4)


def jacobian(vehicle: Vehicle, X: Array, u: Array, Om: float) -> Array:
    """Return F (12, 12), the derivative of `euler` with respect to the state, by hand (section 9)."""
    a = vehicle.a
    x1, x2, x3, x4, x5, x6, *_ = X.tolist()
    C1, S1, C3, S3, C5, S5 = math.cos(x1), math.sin(x1), math.cos(x3), math.sin(x3), math.cos(x5), math.sin(x5)
    T = DT * float(u[0]) / vehicle.mass
    F = np.eye(12)
    F[0, 1] = F[2, 3] = F[4, 5] = F[6, 7] = F[8, 9] = F[10, 11] = DT
    F[1, 1], F[1, 3], F[1, 5] = 1 + DT * 2 * a[2] * x2, DT * (a[1] * x6 + a[3] * Om), DT * a[1] * x4
    F[3, 1], F[3, 3], F[3, 5] = DT * (a[4] * x6 + a[6] * Om), 1 + DT * 2 * a[5] * x4, DT * a[4] * x2
    F[5, 1], F[5, 3], F[5, 5] = DT * a[7] * x4, DT * a[7] * x2, 1 + DT * 2 * a[8] * x6
    F[7, 0], F[7, 2], F[7, 4] = T * (-S1 * S3 * C5 + C1 * S5), T * C1 * C3 * C5, T * (-C1 * S3 * S5 + S1 * C5)
    F[9, 0], F[9, 2], F[9, 4] = T * (-S1 * S3 * S5 - C1 * C5), T * C1 * C3 * S5, T * (C1 * S3 * C5 + S1 * S5)
    F[11, 0], F[11, 2] = -T * S1 * C3, -T * C1 * S3
    F[7, 7], F[9, 9], F[11, 11] = 1 + DT * a[9], 1 + DT * a[10], 1 + DT * a[11]
    return F


def printed_entries(vehicle: Vehicle, X: Array, u: Array, Om: float) -> dict[tuple[int, int], float]:
    """Return the entries of F as the paper prints them (section 5), by (row, column) from 1.

    Those that its text has lost, F8,3, F10,3 and F10,5, are not among them.
    """
    a, m = vehicle.a, vehicle.mass
    x1, x2, x3, x4, x5, x6, *_ = X.tolist()
    C1, S1, C3, C5, S5 = math.cos(x1), math.sin(x1), math.cos(x3), math.cos(x5), math.sin(x5)
    u1 = float(u[0])
    return {
        (2, 2): 2 * x2 * a[2] * DT + 1,
        (2, 4): DT * (x6 * a[1] + a[3] * Om),
        (2, 6): x4 * a[1] * DT,
        (4, 2): DT * (x6 * a[4] + a[6] * Om),
        (4, 4): 2 * x4 * a[5] * DT + 1,
        (4, 6): x2 * a[4] * DT,
        (6, 2): x4 * a[7] * DT,
        (6, 4): x2 * a[7] * DT,
        (6, 6): 2 * x6 * a[8] * DT + 1,
        (8, 1): DT * u1 * (C1 * C3 * C5 / m) / m,
        (8, 5): DT * u1 * (C1 * C3 * C5 / m) / m,
        (8, 8): a[9] * DT + 1,
        (10, 1): -DT * u1 * C1 * C3 * S5 / m,
        (10, 10): a[10] * DT + 1,
        (12, 1): -DT * u1 * C3 * S1 / m,
        (12, 3): -DT * u1 * C3 * S1 / m,
        (12, 12): a[11] * DT + 1,
    }


def printed_jacobian(vehicle: Vehicle, X: Array, u: Array, Om: float) -> Array:
    """Return F with the printed entries in their places, the others as they should be."""
    F = jacobian(vehicle, X, u, Om)
    for (row, column), value in printed_entries(vehicle, X, u, Om).items():
        F[row - 1, column - 1] = value
    return F


# -- rotors -----------------------------------------------------------------------------------------------------------


def forces(vehicle: Vehicle, squares: Array) -> Array:
    """Return u (4,) of the squared speeds (4,), section 4."""
    w1, w2, w3, w4 = squares.tolist()
    Cp, Cd = vehicle.thrust, vehicle.drag
    return np.array([Cp * (w1 + w2 + w3 + w4), Cp * (w4 - w2), Cp * (w3 - w1), Cd * (w1 - w2 + w3 - w4)])


def mix(vehicle: Vehicle, u: Array) -> tuple[Array, Array, float, bool]:
    """Return the speeds (4,), the input that they apply (4,), their residual speed, and whether one was clipped."""
    A, B = u[0] / (4 * vehicle.thrust), u[1] / (2 * vehicle.thrust)
    C, D = u[2] / (2 * vehicle.thrust), u[3] / (4 * vehicle.drag)
    wanted = np.array([A - C + D, A - B - D, A + C + D, A + B - D])
    squares = np.clip(wanted, 0.0, vehicle.fastest**2)
    w = np.sqrt(squares)
    return w, forces(vehicle, squares), float(w[0] - w[1] + w[2] - w[3]), bool(np.any(squares != wanted))


# -- the law ----------------------------------------------------------------------------------------------------------


def fuzzy(v: float) -> float:
    """Return the output of the five rules for a normalised surface (eq. 23), weighted mean of centres, section 7."""
    v = min(max(v, -1.0), 1.0)
    above = below = 0.0
    for peak, centre in ((-1.0, -1.0), (-0.5, -0.4), (0.0, 0.0), (0.5, 0.4), (1.0, 1.0)):
        weight = max(0.0, 1.0 - abs(v - peak) / 0.5)
        above, below = above + centre * weight, below + weight
    return above / below


def sign(s: float) -> float:
    """Return sgn s, zero at zero."""
    return float(np.sign(s))


@dataclass(frozen=True)
class Gains:
    """The constants of section 6, by channel (phi, theta, psi, x, y, z).

    Attributes
    ----------
    slope, rate, gain, width : tuple of 6 float
        lambda (1/s), mu (1/s), K (rad/s^2 or m/s^2), Phi (rad/s or m/s).
    frequency, damping : float
        Of the command filter: rad/s, 1.
    """

    slope: tuple[float, ...] = (10.0, 10.0, 3.0, 1.0, 1.0, 1.0)
    rate: tuple[float, ...] = (3.0, 3.0, 2.0, 2.0, 2.0, 4.0)
    gain: tuple[float, ...] = (4.0, 4.0, 2.0, 0.5, 0.5, 1.0)
    width: tuple[float, ...] = (0.5, 0.5, 0.3, 0.3, 0.3, 0.3)
    frequency: float = 20.0
    damping: float = 1.0

    def scaled(self, gain: float = 1.0, width: float = 1.0) -> Gains:
        """Return the same with K and Phi times a factor."""
        return replace(
            self, gain=tuple(gain * item for item in self.gain), width=tuple(width * item for item in self.width)
        )


LAWS: dict[str, Law] = {"SMC": sign, "tanh": math.tanh, "FSMC": fuzzy}
"""Switching functions; the argument is s for SMC and s / Phi for the others, which for a sign is the same."""


@dataclass
class Controller:
    """The law of section 6 with its memory.

    Attributes
    ----------
    vehicle : Vehicle
        What it believes.
    law : callable
        Of s / Phi; or the name of one of `LAWS`.
    gains : Gains
        Its constants.
    literal : bool
        Whether eq. (19) is taken as it is printed: -K_fuzzy sgn(s), with a K_fuzzy that has the sign of s (erratum 5).
    divided : bool
        Whether the attitude loops have the printed factor m / b (erratum 6).
    Om : float
        Residual speed of the step before.
    q, dq : array (2,)
        Command filters of roll and pitch.
    said : dict
        Of the last call: "s" (6,), "switching" (6,) the size of each switching term, "raw" (2,) the attitude asked for,
        "clipped" whether a sine was, "reference" (12,).
    """

    vehicle: Vehicle = SET_A
    law: Law | str = "FSMC"
    gains: Gains = Gains()
    literal: bool = False
    divided: bool = False
    Om: float = 0.0
    q: Array = field(default_factory=lambda: np.zeros(2))
    dq: Array = field(default_factory=lambda: np.zeros(2))
    said: dict[str, Any] = field(default_factory=dict)

    def push(self, channel: int, s: float) -> float:
        """Return sigma of a channel, from 0."""
        law = LAWS[self.law] if isinstance(self.law, str) else self.law
        value = law(s / self.gains.width[channel])
        return self.gains.gain[channel] * (abs(value) if self.literal else value)

    def __call__(self, X: Array, wanted: Array) -> Array:
        """Return the commanded input u (4,) for an estimate X (12,).

        Parameters
        ----------
        X : array (12,)
            Estimate.
        wanted : array (12,)
            x_d, x_d', x_d'', then y, z and psi likewise.
        """
        xd, dxd, ddxd, yd, dyd, ddyd, zd, dzd, ddzd, psid, dpsid, ddpsid = map(float, wanted)
        car, g = self.vehicle, self.gains
        a, b, m = car.a, car.b, car.mass
        x1, x2, x3, x4, x5, x6, x7, x8, x9, x10, x11, x12 = X.tolist()
        # 1. altitude
        e11, e12 = x11 - zd, x12 - dzd
        sz = e12 + g.slope[5] * e11
        c = max(math.cos(x1) * math.cos(x3), LEAST_COSINE)
        u1 = m / c * (-self.push(5, sz) - g.rate[5] * sz - a[11] * x12 + car.gravity - g.slope[5] * e12 + ddzd)
        u1 = min(max(u1, LEAST_THRUST * m * car.gravity), 4 * car.thrust * car.fastest**2)
        # 2. position
        e7, e8, e9, e10 = x7 - xd, x8 - dxd, x9 - yd, x10 - dyd
        sx, sy = e8 + g.slope[3] * e7, e10 + g.slope[4] * e9
        ux = m / u1 * (-self.push(3, sx) - g.rate[3] * sx - a[9] * x8 - g.slope[3] * e8 + ddxd)
        uy = m / u1 * (-self.push(4, sy) - g.rate[4] * sy - a[10] * x10 - g.slope[4] * e10 + ddyd)
        # 3. attitude asked for
        C, S = math.cos(psid), math.sin(psid)
        alpha = ux * S - uy * C
        phi = math.asin(min(max(alpha, -ANGLE_LIMIT), ANGLE_LIMIT))
        beta = (ux * C + uy * S) / math.cos(phi)
        theta = math.asin(min(max(beta, -ANGLE_LIMIT), ANGLE_LIMIT))
        # 4. command filter
        q, dq, raw = self.q, self.dq, np.array([phi, theta])
        ddq = g.frequency**2 * (raw - q) - 2 * g.damping * g.frequency * dq
        self.q, self.dq = q + DT * dq, dq + DT * ddq
        # 5. attitude
        e1, e2, e3, e4 = x1 - q[0], x2 - dq[0], x3 - q[1], x4 - dq[1]
        e5, e6 = math.fmod(x5 - psid, 2 * math.pi), x6 - dpsid
        e5 = e5 - 2 * math.pi * math.floor((e5 + math.pi) / (2 * math.pi))
        s1, s2, s3 = e2 + g.slope[0] * e1, e4 + g.slope[1] * e3, e6 + g.slope[2] * e5
        factor = m if self.divided else 1.0
        f1 = a[1] * x4 * x6 + a[2] * x2**2 + a[3] * self.Om * x4
        f2 = a[4] * x2 * x6 + a[5] * x4**2 + a[6] * self.Om * x2
        f3 = a[7] * x2 * x4 + a[8] * x6**2
        u2 = factor / b[1] * (-self.push(0, s1) - g.rate[0] * s1 - f1 - g.slope[0] * e2 + ddq[0])
        u3 = factor / b[2] * (-self.push(1, s2) - g.rate[1] * s2 - f2 - g.slope[1] * e4 + ddq[1])
        u4 = factor / b[3] * (-self.push(2, s3) - g.rate[2] * s3 - f3 - g.slope[2] * e6 + ddpsid)
        surfaces = (s1, s2, s3, sx, sy, sz)
        self.said = {
            "s": np.array(surfaces),
            "switching": np.array([abs(self.push(channel, s)) for channel, s in enumerate(surfaces)]),
            "raw": raw,
            "clipped": abs(alpha) > ANGLE_LIMIT or abs(beta) > ANGLE_LIMIT,
            "reference": np.array([q[0], dq[0], q[1], dq[1], psid, dpsid, xd, dxd, yd, dyd, zd, dzd]),
        }
        return np.array([u1, u2, u3, u4])


# -- the filter -------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Tuning:
    """Variances of section 9: of position and velocity in each step, and of each reading."""

    position: float
    velocity: float
    reading: float


TUNINGS = {
    "printed": Tuning(1e-2, 1e-2, 1e-1),
    "robust": Tuning(1e-10, 1.6e-5, 1e-4),
    "matched": Tuning(1e-12, 1e-8, 1e-4),
}


@dataclass
class Filter:
    """The extended Kalman filter of section 9.

    Attributes
    ----------
    vehicle, tuning : Vehicle, Tuning
        What it believes.
    rows : tuple of int
        Which states are read, from 0.
    jacobian : callable
        (vehicle, X, u, Om) -> F.
    X, P : array (12,), (12, 12)
        Estimate and covariance.
    """

    vehicle: Vehicle = SET_A
    tuning: Tuning = TUNINGS["printed"]
    rows: tuple[int, ...] = (0, 2, 4, 6, 8, 10)
    jacobian: Callable[[Vehicle, Array, Array, float], Array] = jacobian
    X: Array = field(default_factory=lambda: np.zeros(12))
    P: Array = field(default_factory=lambda: np.eye(12))

    def __post_init__(self) -> None:
        self.Q = np.diag([self.tuning.position, self.tuning.velocity] * 6)
        self.H = np.eye(12)[list(self.rows)]
        self.R = self.tuning.reading * np.eye(len(self.rows))

    def predict(self, u: Array, Om: float) -> None:
        """Move one step ahead with the applied input."""
        F = self.jacobian(self.vehicle, self.X, u, Om)
        self.X = euler(self.vehicle, self.X, u, Om)
        self.P = F @ self.P @ F.T + self.Q

    def correct(self, z: Array) -> None:
        """Correct with a reading of the rows."""
        PH = self.P @ self.H.T
        K = np.linalg.solve(self.H @ PH + self.R, PH.T).T
        self.X = self.X + K @ (z - self.H @ self.X)
        P = self.P - K @ PH.T
        self.P = 0.5 * (P + P.T)


# -- the loop ---------------------------------------------------------------------------------------------------------


def trajectory(t: float, ramp: bool = False) -> Array:
    """Return x_d, x_d', x_d'', then y, z and psi likewise, at a time in s (section 5).

    Parameters
    ----------
    t : float
        Time.
    ramp : bool
        Whether the altitude is 5 t, as in Fig. 13, instead of 5.
    """
    w = math.pi / 4
    x, y = 0.5 * math.cos(w * t), 0.5 * math.sin(w * t)
    z = (5 * t, 5.0, 0.0) if ramp else (5.0, 0.0, 0.0)
    return np.array([x, -w * y, -(w**2) * x, y, w * x, -(w**2) * y, *z, math.pi / 4, 0.0, 0.0])


def course(memory: Fields, inputs: Fields, params: Fields) -> tuple[bool, Fields, Fields]:
    """Return the circle, the altitude and the yaw that are followed, by parameters; see `controllers.Formula`."""
    real = memory["count"].dtype.type
    t, w, r = real(DT) * memory["count"], params["frequency"], params["radius"]
    turn = r * np.exp(1j * w * t)  # x + i y; each derivative turns it by a quarter and scales it by w
    at, rate, acceleration = turn, 1j * w * turn, -(w**2) * turn
    outputs: Fields = {"x": np.real(at), "rate_x": np.real(rate), "acceleration_x": np.real(acceleration)}
    outputs |= {"y": np.imag(at), "rate_y": np.imag(rate), "acceleration_y": np.imag(acceleration)}
    outputs |= {"z": params["altitude"] + params["climb"] * t, "rate_z": params["climb"], "acceleration_z": 0 * t}
    outputs |= {"yaw": params["yaw"], "rate_yaw": 0 * t, "acceleration_yaw": 0 * t}
    return False, {"count": memory["count"] + 1}, outputs


def disturbances(
    steps: int,
    *,
    onset: float = 5.0,
    sine: float = 0.01,
    constant: Any = 0.0,
    seed: int | None = None,
    acceleration: float = 0.1,
    reading: float = 0.01,
) -> tuple[Array, Array]:
    """Return d (steps, 6), the accelerations of section 8, and v (steps, 6), the noise of the reading one step later.

    Parameters
    ----------
    steps : int
        How many.
    onset : float
        Time from which sine and noise are there, in s.
    sine : float
        Amplitude, 1 Hz, in all channels.
    constant : float or (6,) array
        An acceleration from the start.
    seed : int, optional
        Of the noise; without it there is none.
    acceleration, reading : float
        Standard deviations of the noise.
    """
    t = DT * np.arange(steps)
    on = (np.arange(steps) >= round(onset / DT)).astype(float)[:, None]
    d = on * sine * np.sin(2 * np.pi * t)[:, None] + np.zeros((steps, 6)) + constant
    v = np.zeros((steps, 6))
    if seed is not None:
        rng = np.random.default_rng(seed)
        d = d + on * acceleration * rng.standard_normal((steps, 6))
        v = on * reading * rng.standard_normal((steps, 6))
    return d, v


@dataclass(frozen=True)
class Scenario:
    """One run.

    Attributes
    ----------
    steps : int
        How many.
    law, gains : str, Gains
        See `Controller`.
    tuning : str
        A key of `TUNINGS`; empty where the law is given the true state.
    believed, plant : Vehicle
        What filter and law are made for; what flies.
    X, estimate : tuple of 12 float
        State and estimate at the start.
    d, v : array (steps, 6), (steps, rows), optional
        See `disturbances`; default none. Of v the first columns are those of `rows`.
    ramp, literal, divided : bool
        See `trajectory` and `Controller`.
    printed_jacobian : bool
        Whether the filter has the printed entries.
    told : bool
        Whether the filter is told the applied input, not the commanded one.
    rows : tuple of int
        Which states are read.
    exact : bool
        Whether the plant moves by Runge-Kutta.
    """

    steps: int = 10000
    law: str = "FSMC"
    gains: Gains = Gains()
    tuning: str = "printed"
    believed: Vehicle = SET_A
    plant: Vehicle = SET_A
    X: tuple[float, ...] = (0.0,) * 12
    estimate: tuple[float, ...] = (0.0,) * 12
    d: Array | None = None
    v: Array | None = None
    ramp: bool = False
    literal: bool = False
    divided: bool = False
    printed_jacobian: bool = False
    told: bool = True
    rows: tuple[int, ...] = (0, 2, 4, 6, 8, 10)
    exact: bool = False


@dataclass(frozen=True)
class Run:
    """What happened in a run, at t_k = k DT, k = 0 .. steps - 1 (fewer where it diverged).

    Attributes
    ----------
    X, estimate, reference : array (steps, 12)
        Truth, estimate, and what was wanted; of roll and pitch that is the filtered command.
    u, applied : array (steps, 4)
        Commanded and applied inputs.
    w : array (steps, 4)
        Speeds of the rotors.
    Om : array (steps,)
        Residual speed.
    s, switching : array (steps, 6)
        Surfaces, and the size of the switching term of each: of the fuzzy law k_hat of eq. (24).
    deviation : array (steps, 12)
        What the filter says of its own standard deviations; NaN without one.
    saturated, clipped : bool array (steps,)
        Whether a rotor was clipped; whether the sine of an angle asked for was.
    diverged : float or None
        The time at which a state was beyond `FAR` or no number.
    """

    X: Array
    estimate: Array
    reference: Array
    u: Array
    applied: Array
    w: Array
    Om: Array
    s: Array
    switching: Array
    deviation: Array
    saturated: NDArray[np.bool_]
    clipped: NDArray[np.bool_]
    diverged: float | None

    def window(self, start: float, end: float) -> slice:
        """Return the steps from one time to another."""
        return slice(round(start / DT), round(end / DT))

    def tracking(self, start: float, end: float) -> Array:
        """Return the root mean squares (12,) of truth less reference over a window (section 10)."""
        at = self.window(start, end)
        return root_mean_square(self.X[at] - self.reference[at])

    def estimation(self, start: float, end: float) -> Array:
        """Return the root mean squares (12,) of truth less estimate over a window."""
        at = self.window(start, end)
        return root_mean_square(self.X[at] - self.estimate[at])

    def chattering(self, start: float, end: float) -> Array:
        """Return the chattering index (4,): the total variation of the commanded input over a window, by its length."""
        return np.asarray(np.sum(np.abs(np.diff(self.u[self.window(start, end)], axis=0)), axis=0) / (end - start))


def root_mean_square(errors: Array) -> Array:
    """Return the root mean squares of columns."""
    return np.asarray(np.sqrt(np.mean(errors**2, axis=0)))


def simulate(scenario: Scenario) -> Run:
    """Run a scenario in the order of section 10."""
    n = scenario.steps
    law = Controller(
        scenario.believed, scenario.law, scenario.gains, literal=scenario.literal, divided=scenario.divided
    )
    X, estimate = np.array(scenario.X, dtype=float), np.array(scenario.estimate, dtype=float)
    observer = None
    if scenario.tuning:
        F = printed_jacobian if scenario.printed_jacobian else jacobian
        observer = Filter(scenario.believed, TUNINGS[scenario.tuning], scenario.rows, F, estimate)
    d = np.zeros((n, 6)) if scenario.d is None else scenario.d
    v = np.zeros((n, 6)) if scenario.v is None else scenario.v
    rows = list(scenario.rows)
    move = runge_kutta if scenario.exact else euler
    wide, narrow = (np.full((n, 12), np.nan) for _ in range(4)), (np.full((n, 4), np.nan) for _ in range(3))
    (states, estimates, references, deviation), (u, applied, w) = wide, narrow
    Om, s, switching = np.full(n, np.nan), np.full((n, 6), np.nan), np.full((n, 6), np.nan)
    saturated, clipped = np.zeros(n, dtype=bool), np.zeros(n, dtype=bool)
    diverged, done = None, n
    for k in range(n):
        if not np.all(np.abs(X) <= FAR):
            diverged, done = k * DT, k
            break
        seen = X if observer is None else observer.X
        states[k], estimates[k] = X, seen
        u[k] = law(seen, trajectory(k * DT, scenario.ramp))
        references[k], s[k], clipped[k] = law.said["reference"], law.said["s"], law.said["clipped"]
        switching[k] = law.said["switching"]
        if observer is not None:
            deviation[k] = np.sqrt(np.diag(observer.P))
        w[k], applied[k], law.Om, saturated[k] = mix(scenario.believed, u[k])
        Om[k] = law.Om
        X = move(scenario.plant, X, applied[k], Om[k], d[k])
        if observer is not None:
            observer.predict(applied[k] if scenario.told else u[k], Om[k])
            observer.correct(X[rows] + v[k][: len(rows)])
    at = slice(done)
    return Run(
        states[at], estimates[at], references[at], u[at], applied[at], w[at], Om[at], s[at], switching[at], deviation[at],
        saturated[at], clipped[at], diverged,
    )  # fmt: skip


def steady_gain(tuning: Tuning, rate: float = 0.0) -> tuple[float, float]:
    """Return the gains of position and velocity to which the filter of one channel settles.

    Parameters
    ----------
    tuning : Tuning
        Its variances.
    rate : float
        Of the velocity by itself, 1/s: the channel is [[1, dt], [0, 1 + rate dt]].
    """
    F, H = np.array([[1.0, DT], [0.0, 1.0 + rate * DT]]), np.array([[1.0, 0.0]])
    Q, P = np.diag([tuning.position, tuning.velocity]), np.eye(2)
    K = np.zeros((2, 1))
    for _ in range(100000):
        P = F @ P @ F.T + Q
        before, K = K, P @ H.T / (P[0, 0] + tuning.reading)
        P = P - K @ (H @ P)
        P = 0.5 * (P + P.T)
        if np.max(np.abs(K - before)) < 1e-13:
            break
    return float(K[0, 0]), float(K[1, 0])


def velocity_bias(tuning: Tuning, rate: float, d: float) -> float:
    """Return what a constant acceleration d, which the filter does not know, adds to its velocity error (section 11.6)."""
    position, velocity = steady_gain(tuning, rate)
    rho = position / velocity
    return rho * d / (1 - rate * rho)
