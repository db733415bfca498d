"""From f and h to one step: the discrete map, its derivative F, the process noise Q, and H, R of a sensor.

Attitudes are treated by their error, a rotation vector e in the body frame: q exp(e) (Markley, "Attitude error
representations for Kalman filtering", JGCD 26(2), 2003). Derivatives are by complex step (Squire & Trapp, "Using
complex variables to estimate derivatives of real functions", SIAM Review 40(1), 1998).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple
from weakref import WeakKeyDictionary

import numpy as np
from scipy.linalg import expm

from . import quaternions
from .model import Array, Lowered, Model, SensorModel, correlation_pattern, strength, unpacked

STEP = 1.0e-20
"""Of the complex step: nothing is subtracted, so it may be as small as single precision has numbers."""

DESIGN_DIGITS = 13
"""Digits to which a constant transition matrix is kept: its last bits are those of a LAPACK, not of the method."""


def evaluated(function: Lowered, *arguments: Array) -> Array:
    """Return the only result of a lowered function, all arguments given as many columns as the widest."""
    batch = max((item.shape[1] for item in arguments if item.ndim == 2), default=None)
    if batch is not None:
        columns = [item if item.ndim == 2 else item[:, None] for item in arguments]
        arguments = tuple(np.broadcast_to(item, (len(item), batch)) for item in columns)
    return function(*arguments)[0]


def complex_step(function: Callable[[Array], Array], point: Array) -> Array:
    """Return the Jacobian of an analytic function at a real point: Im f(x + i h) / h (Squire & Trapp 1998)."""
    step = point.dtype.type(STEP)
    moved = point[:, None] + 1j * step * np.eye(len(point), dtype=point.dtype)
    return np.asarray(np.imag(function(moved)) / step)


def central_differences(function: Callable[[Array], Array], point: Array, steps: Array) -> Array:
    """Return the Jacobian of a function by (f(x + h) - f(x - h)) / 2 h, h given for each element of x."""
    moves = np.diag(steps)
    return np.asarray((function(point[:, None] + moves) - function(point[:, None] - moves)) / (2 * steps))


def wrapped_angle(angle: Array) -> Array:
    """Return an angle in [-pi, pi]."""
    return np.asarray(angle - (2 * math.pi) * np.floor(np.real(angle) * (0.5 / math.pi) + 0.5))


def retract(model: Model, x: Array, error: Array) -> Array:
    """Return the state x moved by an error: x + e, for an attitude q exp(e)."""
    if error.ndim == 2 and x.ndim == 1:
        x = np.broadcast_to(x[:, None], (len(x), error.shape[1]))
    pieces = []
    for state, at, error_at in model.places:
        if state.kind == "attitude":
            pieces.append(quaternions.product(x[at], quaternions.exponential(error[error_at])))
        else:
            pieces.append(x[at] + error[error_at])
    return np.concatenate(pieces)


def wrapped(model: Model, x: Array) -> Array:
    """Return the state with its angles in [-pi, pi] and its quaternions of unit length."""
    answer = x.copy()
    for state, at, _ in model.places:
        if state.kind == "angle":
            answer[at] = wrapped_angle(x[at])
        elif state.kind == "attitude":
            answer[at] = quaternions.renormalised(x[at])
    return answer


def rates(model: Model, x: Array, u: Array, p: Array, w: Array | None = None) -> Array:
    """Return f(x, u, p, w), w zero if not given."""
    zero = np.zeros(sum(noise.size for noise in model.noises), dtype=p.dtype)
    return evaluated(model.dynamics, x, u, p, zero if w is None else w)


# ---------------------------------------------------------------------------------------------------------------------
# The map over one step


def increment(model: Model, x: Array, u: Array, p: Array, dt: Any) -> Array:
    """Return the change of the state over one step, in error coordinates, without noise.

    Euler and RK4 are taken in the coordinates e of x exp(e), in which the rate of an attitude is dexp^-1(e) omega:
    Runge-Kutta-Munthe-Kaas (Hairer, Lubich, Wanner, "Geometric Numerical Integration", sec. IV.8).
    """
    if model.method in ("exact", "tustin"):
        transition_matrix, input_matrix = linear_map(model, u, p, dt)
        offset = input_matrix @ rates(model, np.zeros(len(x), dtype=p.dtype), u, p)
        identity = np.eye(len(x), dtype=p.dtype)
        moved = (transition_matrix - identity) @ x
        return np.asarray(moved + (offset[:, None] if x.ndim == 2 else offset))
    if model.method not in ("euler", "rk4"):
        raise ValueError(f"the discretisation {model.method!r} is not known")

    def rate(local: Array) -> Array:
        value = rates(model, retract(model, x, local), u, p)
        for state, _, at in model.places:
            if state.kind == "attitude":
                value[at] = _inverse_differential(local[at], value[at])
        return value

    h = dt / p.dtype.type(model.substeps)
    total = np.zeros((model.error_size, *x.shape[1:]), dtype=x.dtype)
    for _ in range(model.substeps):
        k1 = rate(total)
        if model.method == "euler":
            total = total + h * k1
            continue
        k2 = rate(total + 0.5 * h * k1)
        k3 = rate(total + 0.5 * h * k2)
        k4 = rate(total + h * k3)
        total = total + (h / 6) * (k1 + 2 * k2 + 2 * k3 + k4)
    return total


def _inverse_differential(turn: Array, omega: Array) -> Array:
    """Return dexp^-1(turn) omega to second order, for body-frame angular velocity (Hairer et al., eq. III.4.5)."""
    once = np.cross(turn, omega, axis=0)
    return np.asarray(omega + 0.5 * once + np.cross(turn, once, axis=0) / 12)


def linear_map(model: Model, u: Array, p: Array, dt: Any) -> tuple[Array, Array]:
    """Return (Phi, Gamma) of x' = A x + b over one step, b held: x+ = Phi x + Gamma b.

    "exact": Phi = e^(A dt), Gamma its integral (Franklin, Powell, Workman, "Digital Control of Dynamic Systems", sec.
    4.3), for a nilpotent A by its finite series. "tustin": the trapezoidal rule.
    """
    precision = p.dtype.type
    A = constant_parts(model).A
    if A is not None and not isinstance(model.dt, tuple):
        # numbers of the design: in double precision, then rounded
        phi, gamma = _exact(A, model.dt) if model.method == "exact" else _tustin(A, model.dt)
        return phi.astype(precision), gamma.astype(precision)
    zero = np.zeros(model.error_size, dtype=p.dtype)
    A = complex_step(lambda x: rates(model, x, u, p), zero)
    return _series(A, dt) if model.method == "exact" else _tustin(A, dt)


def _exact(A: Array, dt: Any) -> tuple[Array, Array]:
    n = len(A)
    block = np.block([[A, np.eye(n)], [np.zeros((n, 2 * n))]])
    power = expm(block * dt)
    return _to_digits(power[:n, :n]), _to_digits(power[:n, n:])


def _series(A: Array, dt: Any) -> tuple[Array, Array]:
    """e^(A dt) and its integral for a nilpotent A, which ends after at most n terms."""
    n = len(A)
    phi, gamma = np.eye(n, dtype=A.dtype), np.zeros((n, n), dtype=A.dtype)
    term = np.eye(n, dtype=A.dtype)
    for k in range(n):
        gamma = gamma + term * (dt ** (k + 1) / math.factorial(k + 1))
        term = term @ A
        phi = phi + term * (dt ** (k + 1) / math.factorial(k + 1))
    return phi, gamma


def _tustin(A: Array, dt: Any) -> tuple[Array, Array]:
    identity = np.eye(len(A), dtype=A.dtype)
    half = A * (dt / 2)
    try:
        inverse = np.asarray(np.linalg.inv(identity - half))
    except np.linalg.LinAlgError:
        inverse = np.full_like(identity, np.nan)
    return inverse @ (identity + half), inverse * dt


def _to_digits(matrix: Array) -> Array:
    scale = np.max(np.abs(matrix))
    kept = np.where(np.abs(matrix) < 1e-15 * scale, 0.0, matrix)
    return np.array([[float(f"{item:.{DESIGN_DIGITS}g}") for item in row] for row in kept])


def transition(model: Model, x: Array, u: Array, p: Array, dt: Any) -> tuple[Array, Array]:
    """Return (next state, F): F is the derivative of the error after the step by the error before, at zero error.

    The error of an attitude after the step is that between the moved and the unmoved solution, q+^-1 (q exp(e))+.
    """
    if model.method == "none":
        after = rates(model, x, u, p)
    else:
        change = increment(model, x, u, p, dt)
        after = retract(model, x, change)
    F = complex_step(error_map(model, x, u, p, dt), np.zeros(model.error_size, dtype=x.dtype))
    return wrapped(model, after), F


def error_map(model: Model, x: Array, u: Array, p: Array, dt: Any) -> Callable[[Array], Array]:
    """Return the map from errors (n, k) before the step to errors after it, to first order."""
    if model.method == "none":
        unmoved = rates(model, x, u, p)
        return lambda error: rates(model, x[:, None] + error, u, p) - unmoved[:, None]
    change = increment(model, x, u, p, dt)

    def error_after(error: Array) -> Array:
        moved = increment(model, retract(model, x, error), u, p, dt)
        pieces = []
        for state, _, at in model.places:
            if state.kind == "attitude":
                # q exp(e) exp(moved) seen from q exp(change); q itself cancels
                back = quaternions.conjugate(quaternions.exponential(change[at]))
                turn = quaternions.product(quaternions.exponential(error[at]), quaternions.exponential(moved[at]))
                pieces.append(quaternions.small_rotation(quaternions.product(back[:, None], turn)))
            else:
                pieces.append(error[at] + moved[at] - change[at][:, None])
        return np.concatenate(pieces)

    return error_after


# ---------------------------------------------------------------------------------------------------------------------
# Process noise


class ErrorDynamics(NamedTuple):
    """A and G of the error dynamics e' = A e + G w; where they depend on the point, None."""

    A: Array | None
    G: Array | None


def error_dynamics(model: Model, x: Array, u: Array, p: Array) -> tuple[Array, Array]:
    """Return A and G of the continuous error dynamics e' = A e + G w at a point.

    An attitude's error, seen from the turning body, turns back: e' = -omega x e + ... (Markley 2003, eq. 41).
    """
    zero = np.zeros(model.error_size, dtype=x.dtype)
    A = complex_step(lambda error: rates(model, retract(model, x, error), u, p), zero)
    omega = rates(model, x, u, p)
    for state, _, at in model.places:
        if state.kind == "attitude":
            A[at, at] -= quaternions.cross_matrix(omega[at])
    return A, noise_gain(model, x, u, p)


def noise_gain(model: Model, x: Array, u: Array, p: Array) -> Array:
    """Return G = df/dw at w = 0."""
    size = sum(noise.size for noise in model.noises)
    if size == 0:
        return np.zeros((model.error_size, 0), dtype=x.dtype)
    return complex_step(lambda w: rates(model, x, u, p, w), np.zeros(size, dtype=x.dtype))


_constant_parts: WeakKeyDictionary[Model, ErrorDynamics] = WeakKeyDictionary()
_unit_integrals: WeakKeyDictionary[Model, Array] = WeakKeyDictionary()


def constant_parts(model: Model) -> ErrorDynamics:
    """Return A and G where they are the same at any state, input and parameter, as far as random points can tell."""
    if model not in _constant_parts:
        rng = np.random.default_rng(0)
        points = [error_dynamics(model, *_random_point(model, rng)) for _ in range(12)]
        first = points[0]
        same = [
            all(
                np.allclose(point[k], first[k], rtol=1e-12, atol=1e-14 * np.max(np.abs(first[k]), initial=0))
                for point in points
            )
            for k in range(2)
        ]
        _constant_parts[model] = ErrorDynamics(first[0] if same[0] else None, first[1] if same[1] else None)
    return _constant_parts[model]


def _random_point(model: Model, rng: np.random.Generator) -> tuple[Array, Array, Array]:
    """Return states, inputs and parameters of any magnitude within their ranges."""

    def drawn(low: Array, high: Array) -> Array:
        size = rng.choice([-1.0, 1.0], len(low)) * 10.0 ** rng.uniform(-3.0, 3.0, len(low))
        spread_out = rng.uniform(low, high)
        return np.where((size >= low) & (size <= high), size, spread_out)

    x = np.concatenate([drawn(state.low, state.high) for state in model.states])
    for state, at, _ in model.places:
        if state.kind == "attitude":
            direction = rng.normal(size=4)
            x[at] = direction / np.linalg.norm(direction)
    u = np.concatenate([np.zeros(0), *[drawn(item.low, item.high) for item in model.inputs]])
    ranges = {item.name: item for item in model.params}
    p = np.concatenate([np.zeros(0), *[drawn(ranges[name].low, ranges[name].high) for name in model.plant_params]])
    return x, u, p


def process_covariance(model: Model, x: Array, u: Array, p: Array, dt: Any, params: Mapping[str, Array]) -> Array:
    """Return Q of one step from the state x before it.

    Noise per step enters as G S G'. A density is integrated over the step: exactly where A, G and dt are constant (Van
    Loan, "Computing integrals involving the matrix exponential", IEEE TAC 23(3), 1978); else as the integral of
    (I + A s) G S G' (I + A s)', the first order of the exponential, which is positive semidefinite for every dt.
    """
    precision = p.dtype.type
    S = strength(model.noises, params, precision)
    n = model.error_size
    if not model.noises:
        Q = np.zeros((n, n), dtype=precision)
    elif model.method == "none":
        G = noise_gain(model, x, u, p)
        Q = G @ S @ G.T
    elif not isinstance(model.dt, tuple) and all(part is not None for part in constant_parts(model)):
        Q = np.tensordot(S, _van_loan_of_units(model).astype(precision), axes=2)
    else:
        A, G = error_dynamics(model, x, u, p)
        W = G @ S @ G.T
        AW = A @ W
        Q = W * dt + (AW + AW.T) * (dt * dt / 2) + (AW @ A.T) * (dt * dt * dt / 3)
    return with_step_noise(model, Q, params)


def with_step_noise(model: Model, Q: Array, params: Mapping[str, Array]) -> Array:
    """Return Q, symmetric, with the noise added that states have per step."""
    total = np.array((Q + Q.T) / 2)
    for state, _, at in model.places:
        if state.name in model.step_variances:
            total[at, at] += np.diag(params[f"variance_step_{state.name}"])
    return total


def van_loan(A: Array, W: Array, dt: float) -> Array:
    """Return the integral over s in 0 .. dt of e^(A s) W e^(A' s) (Van Loan 1978, eq. 1.2).

    By Gauss-Legendre quadrature, 16 points on each of so many panels that the exponential is a polynomial to rounding on
    each: accurate in every element, which the block exponential is not beside its largest.
    """
    nodes, weights = np.polynomial.legendre.leggauss(16)
    panels = max(1, int(np.ceil(np.linalg.norm(A, 1) * dt)))
    width = dt / panels
    total = np.zeros_like(W, dtype=float)
    for panel in range(panels):
        for node, weight in zip(nodes, weights, strict=True):
            spread = expm(A * (width * (panel + 0.5 * (1 + node))))
            total += (0.5 * width * weight) * (spread @ W @ spread.T)
    return total


def _van_loan_of_units(model: Model) -> Array:
    """Return Q for each element of S alone, (noises, noises, n, n): Q is linear in S."""
    if model not in _unit_integrals:
        A, G = constant_parts(model)
        assert A is not None
        assert G is not None
        assert not isinstance(model.dt, tuple)
        answer = np.zeros((G.shape[1], G.shape[1], len(A), len(A)))
        for i, j in np.argwhere(correlation_pattern(model.noises)):
            answer[i, j] = van_loan(A, np.outer(G[:, i], G[:, j]), model.dt)
        _unit_integrals[model] = answer
    return _unit_integrals[model]


# ---------------------------------------------------------------------------------------------------------------------
# Measurements


class Measurement(NamedTuple):
    """What an update needs of a sensor at a state.

    Attributes
    ----------
    innovation : array
        z - h(x), wrapped for an angle.
    H : array
        dh/de.
    R : array
        Variance of the noise.
    correlated : bool
        Whether R may have elements beside its diagonal.
    """

    innovation: Array
    H: Array
    R: Array
    correlated: bool


def expected(sensor: SensorModel, x: Array, u: Array, p: Array, v: Array | None = None) -> Array:
    """Return h(x, u, p, v), v zero if not given."""
    zero = np.zeros(sum(noise.size for noise in sensor.noises), dtype=p.dtype)
    return evaluated(sensor.measure, x, u, p, zero if v is None else v)


def measurement_noise(
    sensor: SensorModel, x: Array, z: Array, u: Array, p: Array, params: Mapping[str, Array]
) -> tuple[Array, bool]:
    """Return R, and whether it may have elements beside its diagonal: R = R0 + R(x, z) + N S N', N = dh/dv."""
    precision = p.dtype.type
    R = np.array(evaluated(sensor.extra_variance, x, z, u, p), dtype=precision).reshape(sensor.size, sensor.size)
    pattern = (R != 0).astype(float)
    if sensor.variance:
        value = params[sensor.variance]
        R = R + (unpacked(value) if sensor.full else np.diag(value))
    if sensor.noises:
        size = sum(noise.size for noise in sensor.noises)
        N = complex_step(lambda v: expected(sensor, x, u, p, v), np.zeros(size, dtype=precision))
        R = R + N @ strength(sensor.noises, params, precision) @ N.T
        linked = np.abs(N) > 0
        pattern = pattern + linked @ correlation_pattern(sensor.noises) @ linked.T
    beside = pattern - np.diag(np.diag(pattern))
    return R, sensor.full or bool(np.any(beside))


def measurement(
    model: Model, sensor: SensorModel, x: Array, z: Array, u: Array, p: Array, params: Mapping[str, Array]
) -> Measurement:
    """Return innovation, H and R of a reading z at the state x."""
    innovation = z - expected(sensor, x, u, p)
    if sensor.angle:
        innovation = wrapped_angle(innovation)
    zero = np.zeros(model.error_size, dtype=x.dtype)
    H = complex_step(lambda error: expected(sensor, retract(model, x, error), u, p), zero)
    R, correlated = measurement_noise(sensor, x, z, u, p, params)
    return Measurement(innovation, H, R, correlated)
