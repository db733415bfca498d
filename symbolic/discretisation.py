"""From continuous dynamics to the map over one step.

Euler and RK4 work in local coordinates (the error of the state), in which an attitude is a rotation vector; so one
rule serves vectors and quaternions: RK4 on a rotation is the Munthe-Kaas form (Hairer, Lubich, Wanner, "Geometric
Numerical Integration", IV.8).
"""

from __future__ import annotations

import copy
import math
from typing import Any

import casadi as ca
import numpy as np
from scipy.linalg import expm

from .affinity import kink_in
from .errors import ModelError
from .plant import Discretisation, Plant

METHODS = ("euler", "rk4", "tustin", "exact")


def discretise(plant: Plant, method: str, dt: Any, substeps: int) -> Plant:
    """Return the discrete plant; see `Plant.discretise`."""
    if plant.is_discrete:
        raise ModelError(f"{plant.name}: it is discrete already (dt = {plant.dt}); discretise the continuous plant")
    if method not in METHODS:
        raise ModelError(f"{plant.name}: the discretisation {method!r} is not known; take one of {', '.join(METHODS)}")
    if not isinstance(substeps, int) or not 1 <= substeps <= 100:
        raise ModelError(f"{plant.name}: substeps is {substeps!r}; give an integer from 1 to 100")
    if method in ("tustin", "exact") and substeps != 1:
        raise ModelError(f"{plant.name}: {method} takes no substeps; leave them out")
    plant.dynamics_expression()
    step = _checked_dt(plant.name, dt)
    discrete = copy.copy(plant)
    discrete.dt = step
    discrete.dt_symbol = ca.SX(step) if isinstance(step, float) else ca.SX.sym("dt")
    discrete.discretisation = Discretisation(method, substeps, plant)
    discrete.step_variances = {}
    if method in ("tustin", "exact"):
        linear_map(discrete)  # refuses here what it cannot do
    return discrete


def _checked_dt(name: str, dt: Any) -> float | tuple[float, float]:
    try:
        ends = [float(item) for item in (dt if isinstance(dt, (tuple, list)) else (dt,))]
    except (TypeError, ValueError):
        ends = []
    if (
        len(ends) not in (1, 2)
        or not all(math.isfinite(item) and item > 0 for item in ends)
        or ends != sorted(set(ends))
    ):
        raise ModelError(f"{name}: dt is {dt!r}; give a positive number of seconds, or (lowest, highest)")
    return ends[0] if len(ends) == 1 else (ends[0], ends[1])


def increment(plant: Plant) -> ca.SX:
    """Return the change of the state over one step, without noise, in error coordinates (error_size, 1)."""
    made = plant.discretisation
    assert made is not None and plant.dt_symbol is not None
    if made.method in ("tustin", "exact"):
        transition, drive = linear_map(plant)
        return (transition - ca.SX.eye(plant.error_size)) @ plant.x + drive
    h = plant.dt_symbol / made.substeps if made.substeps > 1 else plant.dt_symbol
    rates = plant.without_noise(made.continuous.dynamics_expression())
    total = ca.SX.zeros(plant.error_size)
    for index in range(made.substeps):
        first = index == 0
        if made.method == "euler":
            total = (0 if first else total) + h * _rate_at(plant, rates, total, first)
            continue
        k1 = _rate_at(plant, rates, total, first)
        k2 = _rate_at(plant, rates, total + (0.5 * h) * k1)
        k3 = _rate_at(plant, rates, total + (0.5 * h) * k2)
        k4 = _rate_at(plant, rates, total + h * k3)
        total = (0 if first else total) + (h / 6) * (k1 + 2 * k2 + 2 * k3 + k4)
    return total


def _rate_at(plant: Plant, rates: ca.SX, local: ca.SX, at_start: bool = False) -> ca.SX:
    """Return the rate of the local coordinates at the state turned by `local`."""
    if at_start:
        return rates
    moved = ca.substitute(rates, plant.x, plant.retract(plant.x, local))
    pieces = []
    for state in plant.states:
        rate = moved[state.error_at]
        if state.attitude:
            turn = local[state.error_at]
            once = ca.cross(turn, rate)
            rate = rate + 0.5 * once + ca.cross(turn, once) / 12
        pieces.append(rate)
    return ca.vertcat(*pieces)


def linear_map(plant: Plant) -> tuple[ca.SX, ca.SX]:
    """Return (transition matrix, driven part) of a linear plant over one step, the input held.

    Raises
    ------
    ModelError
        If the plant is not linear; for "exact", if dt is an input and A is not nilpotent, or A holds parameters and is
        not nilpotent.
    """
    made = plant.discretisation
    assert made is not None and plant.dt_symbol is not None
    method = made.method
    if plant.has_attitude:
        raise ModelError(
            f"{plant.name}: {method} is for linear plants, and an attitude is not linear; use 'euler' or 'rk4'"
        )
    rates = plant.without_noise(made.continuous.dynamics_expression())
    A = ca.jacobian(rates, plant.x)
    if ca.depends_on(ca.vec(A), ca.vertcat(plant.x, plant.u)) or kink_in(rates, plant.x, but_turns=True):
        raise ModelError(
            f"{plant.name}: {method} is for linear plants, and these dynamics are not; use 'euler' or 'rk4'"
        )
    rest = ca.substitute(rates, plant.x, ca.DM.zeros(plant.x.numel()))
    n = plant.error_size
    constant = A.is_constant() and isinstance(plant.dt, float)
    if method == "tustin":
        half = 0.5 * plant.dt_symbol * A
        left = ca.SX.eye(n) - half
        if constant:
            inverse = ca.SX(ca.sparsify(ca.DM(np.linalg.inv(np.asarray(ca.evalf(left))))))
        else:
            inverse = ca.inv(left)
        return inverse @ (ca.SX.eye(n) + half), inverse @ (plant.dt_symbol * rest)
    if constant:
        numbers = np.asarray(ca.evalf(ca.densify(A)), dtype=float)
        block = np.zeros((2 * n, 2 * n))
        block[:n, :n] = numbers
        block[:n, n:] = np.eye(n)
        power = expm(block * float(plant.dt))  # type: ignore[arg-type]
        return _cleaned(power[:n, :n]), _cleaned(power[:n, n:]) @ rest
    powers = [ca.SX.eye(n)]
    while len(powers) <= n:
        following = ca.sparsify(powers[-1] @ A)
        if following.nnz() == 0:
            break
        powers.append(following)
    else:
        cause = "dt is an input" if not isinstance(plant.dt, float) else "A holds parameters"
        raise ModelError(
            f"{plant.name}: exact discretisation needs a constant dt and a constant A, or a nilpotent A, but {cause}; give a "
            "constant dt, or use 'rk4'"
        )
    dt = plant.dt_symbol
    transition = sum((powers[k] * (dt**k / math.factorial(k)) for k in range(1, len(powers))), ca.SX.eye(n))
    integral = sum((powers[k] * (dt ** (k + 1) / math.factorial(k + 1)) for k in range(len(powers))), ca.SX(n, n))
    return transition, integral @ rest


def _cleaned(matrix: np.ndarray[Any, np.dtype[np.float64]]) -> ca.SX:
    """Return a numeric matrix as sparse SX, entries that are rounding dust removed, the rest rounded to 15 digits.

    The matrix exponential is LAPACK's in its last bits; rounding keeps the generated C the same on any machine.
    """
    scale = np.max(np.abs(matrix))
    kept = np.where(np.abs(matrix) < 1e-15 * scale, 0.0, matrix)
    return _rounded(kept)


def _rounded(matrix: np.ndarray[Any, np.dtype[np.float64]]) -> ca.SX:
    """Return a numeric matrix as sparse SX, rounded to 13 digits."""
    rounded = np.array([[float(f"{item:.13g}") for item in row] for row in matrix])
    return ca.SX(ca.sparsify(ca.DM(rounded)))


def transition(plant: Plant) -> tuple[ca.SX, ca.SX]:
    """Return (next state (n, 1), F (error_size, error_size)) of a discrete plant, without noise.

    F is d(error after)/d(error before) at zero error; for an attitude the error is the small rotation in the body
    frame, so F does not depend on the quaternion unless the rates do.
    """
    if plant.discretisation is None:
        following = plant.without_noise(plant.dynamics_expression())
        if plant.has_attitude:
            raise ModelError(f"{plant.name}: an attitude needs a continuous plant, discretised by 'euler' or 'rk4'")
        return plant.wrapped(following), ca.jacobian(following, plant.x)
    change = increment(plant)
    spread = ca.jacobian(change, plant.x) @ plant.retraction_jacobian()
    rows, pieces = [], []
    from . import quaternions as quaternion

    for state in plant.states:
        part = change[state.error_at]
        row = spread[state.error_at, :]
        value = state.symbol
        if state.attitude:
            symbol, error = ca.SX.sym("turn", 3), ca.SX.sym("error", 3)
            turn = quaternion.exponential(symbol)
            back = quaternion.conjugate(turn)
            after = quaternion.rotation_of(
                quaternion.product(back, quaternion.product(quaternion.first_order(error), turn))
            )
            carried = ca.substitute(ca.jacobian(after, error), symbol, part)
            fixed = ca.SX.sym("fixed", 4)
            moved = quaternion.rotation_of(quaternion.product(fixed, turn))
            followed = ca.substitute(ca.jacobian(moved, symbol), fixed, back)
            followed = ca.substitute(followed, symbol, part)
            own = ca.SX(3, plant.error_size)
            own[:, state.error_at] = carried
            rows.append(own + followed @ row)
            pieces.append(quaternion.product(value, quaternion.exponential(part)))
        else:
            own = ca.SX(state.signal.size, plant.error_size)
            own[:, state.error_at] = ca.SX.eye(state.signal.size)
            rows.append(own + row)
            pieces.append(value + part)
    return plant.wrapped(ca.vertcat(*pieces)), ca.sparsify(ca.vertcat(*rows))


def noise_gain(plant: Plant) -> ca.SX:
    """Return G = d(dynamics)/d(process noise) at zero noise, (error_size, number of process noise elements)."""
    source = plant.discretisation.continuous if plant.discretisation else plant
    rates = source.dynamics_expression()
    process = ca.vertcat(ca.SX(0, 1), *[noise.symbol for noise in source.process_noises])
    return plant.without_noise(ca.jacobian(rates, process))


def process_covariance(plant: Plant, strength: ca.SX) -> ca.SX:
    """Return Q (error_size, error_size) of a discrete plant for a noise matrix `strength` of its process noises.

    Noise per step enters as G S G'. A density is integrated over the step: where the continuous A and G are constant
    and dt is too, exactly (Van Loan 1978); else as the integral of (I + A s) G S G' (I + A s)' from 0 to dt, which is
    positive semidefinite for every dt.
    """
    gain = noise_gain(plant)
    if plant.discretisation is None:
        return gain @ strength @ gain.T
    assert plant.dt_symbol is not None
    A = error_rate_jacobian(plant)
    dt = plant.dt_symbol
    if A.is_constant() and gain.is_constant() and isinstance(plant.dt, float):
        return _van_loan(A, gain, strength, plant.dt)
    W = gain @ strength @ gain.T
    AW = A @ W
    return W * dt + (AW + AW.T) * (dt * dt * 0.5) + (AW @ A.T) * (dt * dt * dt / 3)


def error_rate_jacobian(plant: Plant) -> ca.SX:
    """Return A of the continuous error dynamics e' = A e, (error_size, error_size)."""
    assert plant.discretisation is not None
    rates = plant.without_noise(plant.discretisation.continuous.dynamics_expression())
    A = ca.jacobian(rates, plant.x) @ plant.retraction_jacobian()
    for state in plant.states:
        if state.attitude:
            A[state.error_at, state.error_at] += -ca.skew(rates[state.error_at])
    return ca.sparsify(A)


def _van_loan(A: ca.SX, gain: ca.SX, strength: ca.SX, dt: float) -> ca.SX:
    """Return the exact integral, linear in the elements of `strength`, which stay symbols.

    Van Loan's block exponential is accurate beside its largest element only, and of a chain of integrators the
    variances differ by dt^2 from link to link. So the integral is a series over a short step, exact in each element,
    then doubled: Q(2h) = Q(h) + Phi(h) Q(h) Phi(h)'.
    """
    n = A.shape[0]
    a = np.asarray(ca.evalf(ca.densify(A)), dtype=float)
    g = np.asarray(ca.evalf(ca.densify(gain)), dtype=float)
    columns = [_noise_columns(a, g[:, i], dt) for i in range(strength.shape[0])]
    doublings, h = _short_step(a, dt)
    phi = expm(a * h)
    made: dict[tuple[int, int], Any] = {}
    for i, j in [(i, j) for i in range(len(columns)) for j in range(len(columns))]:
        if i == j or strength.sparsity().has_nz(i, j):
            left, right = columns[i], columns[j]
            weights = h / (np.arange(len(left))[:, None] + np.arange(len(right))[None, :] + 1.0)
            part, power = left.T @ weights @ right, phi
            for _ in range(doublings):
                part, power = part + power @ part @ power.T, power @ power
            made[i, j] = part
    total = ca.SX(n, n)
    for (i, j), part in made.items():
        if strength.sparsity().has_nz(i, j):
            scale = np.sqrt(np.outer(np.diag(made[i, i]), np.diag(made[j, j])))
            kept = np.where(np.abs(part) < 1e-15 * scale, 0.0, part)
            total += _rounded(kept) * strength[i, j]
    return ca.sparsify(total)


def _short_step(a: np.ndarray[Any, np.dtype[np.float64]], dt: float) -> tuple[int, float]:
    """Return how often dt is halved, and the short step, over which a series of 20 terms has converged."""
    size = float(np.max(np.sum(np.abs(a), axis=0), initial=0.0)) * dt
    halvings = max(0, math.ceil(math.log2(size / 0.5))) if size > 0.5 else 0
    return halvings, dt / 2**halvings


def _noise_columns(
    a: np.ndarray[Any, np.dtype[np.float64]], g: np.ndarray[Any, np.dtype[np.float64]], dt: float
) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Return the terms (A h)^k g / k!, one a row, of the series of Phi(h) g over the short step h."""
    _, h = _short_step(a, dt)
    terms = [g]
    for k in range(1, 20):
        terms.append(a @ terms[-1] * (h / k))
    return np.array(terms)
