"""The jump matrix technique as plain NumPy: exact linear projection, nonlinear jump, and its estimator.

A plant whose rates are affine once each memoryless nonlinearity n_i = phi_i is held over the sample T,

    dx/dt = A x + B u + L w,    x = (s, n),    the rows of A, B and L that belong to n zero,

is moved by x- = Phi x+ + Gam u + Psi w, then x+ = J(x-), where J leaves s and sets n to phi. The estimator is a Kalman filter
whose covariance passes the jump by a matrix a. Equations in brackets are those of the thesis that the technique is from
(specs/jump_matrix.md). It is the zero-order hold of every nonlinearity: a first-order exponential integrator (ETD1).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

import numpy as np
from scipy.linalg import expm

from .discretisation import complex_step, evaluated
from .model import Array, Lowered

SMALLEST_DIFFERENCE = 1.0e-12
"""The online gain is zero where true and estimated held value differ by less: 0/0 at the start of a known state."""

Choice = Literal["jacobian", "identity", "online"]


def discrete_parts(A: Array, B: Array, L: Array, T: float) -> tuple[Array, Array, Array]:
    """Return (Phi, Gam, Psi) of x' = A x + B u + L w, u and w held over T (2.5), by one block exponential (Van Loan 1978)."""
    n, m, q = len(A), B.shape[1], L.shape[1]
    block = np.zeros((n + m + q, n + m + q))
    block[:n] = np.hstack([A, B, L])
    power = expm(block * T)
    return power[:n, :n], power[:n, n : n + m], power[:n, n + m :]


@dataclass(frozen=True, eq=False)
class JumpSystem:
    """A system of the technique, written by hand.

    Attributes
    ----------
    A, B, L : array (N, N), (N, m), (N, q)
        Of the continuous linear part.
    T : float
        Seconds per sample.
    clamped : tuple of int
        Where the nonlinearities are in x.
    jump : callable
        J: (x, w) -> x+; w stands inside a nonlinearity, where it does at all.
    derivative : callable
        DJ: x -> (N, N), dJ/dx at w = 0.
    noise_derivative : callable
        x -> (N, q), dJ/dw at w = 0.
    H : array (N,)
        z = H x+ + v.
    Q : array (q, q)
        Variance of the held noise w.
    R : float
        Variance of v.
    """

    A: Array
    B: Array
    L: Array
    T: float
    clamped: tuple[int, ...]
    jump: Callable[[Array, Array], Array]
    derivative: Callable[[Array], Array]
    noise_derivative: Callable[[Array], Array]
    H: Array
    Q: Array
    R: float

    @cached_property
    def parts(self) -> tuple[Array, Array, Array]:
        """Phi, Gam and Psi."""
        return discrete_parts(self.A, self.B, self.L, self.T)


def simulate(system: JumpSystem, x0: Array, u: Array, w: Array, inside: Array) -> Array:
    """Return x_0+ .. x_N+ (N + 1, n): x- = Phi x+ + Gam u + Psi w, x+ = J(x-) (2.6, 2.7).

    Parameters
    ----------
    x0 : array (n,)
        x_0+; its clamped elements are used as they are.
    u, w : array (N, m), (N, q)
        Held from k to k + 1.
    inside : array (N, q)
        The noise inside the nonlinearities at k + 1.
    """
    Phi, Gam, Psi = system.parts
    states = [np.asarray(x0, dtype=float)]
    for k in range(len(w)):
        states.append(system.jump(Phi @ states[-1] + Gam @ u[k] + Psi @ w[k], inside[k]))
    return np.array(states)


@dataclass(eq=False)
class JumpEstimator:
    """The estimator (2.25), in its order: (a), (c), (d), (b), (e).

    Attributes
    ----------
    system : JumpSystem
        What it is for.
    choice : {"jacobian", "identity", "online"}
        a_k: DJ at the projected estimate; the unit matrix; or the ratio of the true to the estimated difference (2.30).
    x, P : array (n,), (n, n)
        xh+ and its covariance.
    K : array (n,)
        The last gain.
    transition : array (n, n), optional
        Used in (c) in place of Phi (chapter IV).
    """

    system: JumpSystem
    choice: Choice
    x: Array
    P: Array
    K: Array | None = None
    transition: Array | None = None

    def step(self, z: float, u: Array, before: Array, after: Array) -> None:
        """Take one sample.

        Parameters
        ----------
        z : float
            Reading at k + 1.
        u : array (m,)
            Known input held from k to k + 1.
        before, after : array (n,)
            True x+ at k and at k + 1; only the online gain looks at them.
        """
        system = self.system
        Phi, Gam, Psi = system.parts
        projected = Phi @ self.x + Gam @ u
        jumped = system.jump(projected, np.zeros(len(system.Q)))
        if self.choice == "online":
            a = online_gain(system.clamped, before, after, projected, jumped)
        else:
            a = system.derivative(projected) if self.choice == "jacobian" else np.eye(len(self.x))
        F = Phi if self.transition is None else self.transition
        G = system.noise_derivative(projected)
        M = a @ (F @ self.P @ F.T + Psi @ system.Q @ Psi.T) @ a.T + G @ system.Q @ G.T
        S = system.H @ M @ system.H + system.R
        K = M @ system.H / S if S > 0 else np.zeros(len(M))
        self.x = jumped + K * (z - system.H @ jumped)
        keep = np.eye(len(M)) - np.outer(K, system.H)
        self.P = keep @ M @ keep.T + system.R * np.outer(K, K)
        self.K = K


def online_gain(clamped: tuple[int, ...], before: Array, after: Array, projected: Array, jumped: Array) -> Array:
    """Return a = diag(a_ii) (2.30): one, and for a clamped element (J(x-) - J(xh-)) / (x- - xh-).

    Between samples a clamped element does not move, so that the true x- is its x+ of the sample before. Where the differences
    in the denominator is at most 1e-12 the element is zero.
    """
    a = np.eye(len(projected), dtype=projected.dtype)
    for i in clamped:
        difference = before[i] - projected[i]
        small = abs(difference) <= SMALLEST_DIFFERENCE
        a[i, i] = 0.0 if small else (after[i] - jumped[i]) / difference
    return a


class JumpMap:
    """The step x+ = J(Phi x + Gam u + Psi w) of a plant that is given by its rates and its jump.

    Phi, Gam and Psi are made here, of the derivatives of the rates by the complex step: the independent form of what
    `plantc.symbolic.jump_matrix` makes.

    Parameters
    ----------
    rates : callable
        (x, u, p, w) -> rates of x with the nonlinearities held: affine in x, u and w.
    jump : callable
        (x, u, p, w) -> J(x).
    sizes : (n, m, q)
        Numbers of states, inputs and noises.
    p : array
        Any parameters: A, B and L do not depend on them.
    T : float
        Seconds per sample.

    Raises
    ------
    ValueError
        If the rates are not affine: a derivative does not tell, for that of a jump is zero.
    """

    def __init__(self, rates: Lowered, jump: Lowered, sizes: tuple[int, int, int], p: Array, T: float):
        n, m, q = sizes
        x, u, w = np.zeros(n), np.zeros(m), np.zeros(q)
        A = complex_step(lambda value: evaluated(rates, value, u, p, w), x)
        B = complex_step(lambda value: evaluated(rates, x, value, p, w), u)
        L = complex_step(lambda value: evaluated(rates, x, u, p, value), w)
        x, u, w = (np.cos(np.arange(1, size + 1) * step) for size, step in ((n, 1.3), (m, 1.7), (q, 2.1)))
        for scale in (1.0, -1.0, 1e3):
            parts = [
                A * (scale * x),
                B * (scale * u),
                L * (scale * w),
                evaluated(rates, 0 * x, 0 * u, p, 0 * w)[:, None],
            ]
            terms = np.hstack(parts)
            found = evaluated(rates, scale * x, scale * u, p, scale * w)
            if np.any(np.abs(found - terms.sum(axis=1)) > 1e-9 * np.abs(terms).sum(axis=1)):
                raise ValueError("the rates are not affine in x, u and w with the nonlinearities held")
        self.Phi, driven, self.Psi = discrete_parts(A, np.hstack([B, np.eye(n)]), L, T)
        self.Gam, self.held = driven[:, :m], driven[:, m:]
        self.rates, self.jump, self.sizes = rates, jump, sizes

    def projected(self, x: Array, u: Array, p: Array, w: Array) -> Array:
        """Return Phi x + Gam u + Psi w, and what a constant in the rates adds; each argument (size,), or all (size, k)."""
        parts = [self.Phi, self.Gam, self.Psi, self.held]
        Phi, Gam, Psi, held = (part.astype(np.real(x).dtype) for part in parts)
        constant = evaluated(self.rates, np.zeros_like(x), np.zeros_like(u), p, np.zeros_like(w))
        return np.asarray(Phi @ x + Gam @ u + Psi @ w + held @ constant)

    def __call__(self, x: Array, u: Array, p: Array, w: Array) -> tuple[Array, ...]:
        """Return the state after the step, as a tuple of one: a model's `dynamics`."""
        batch = max((item.shape[1] for item in (x, u, p, w) if item.ndim == 2), default=None)
        if batch is not None:
            columns = [item if item.ndim == 2 else item[:, None] for item in (x, u, p, w)]
            x, u, p, w = (np.broadcast_to(item, (len(item), batch)) for item in columns)
        return (evaluated(self.jump, self.projected(x, u, p, w), u, p, w),)

    def driven(self, places: list[int]) -> Lowered:
        """Return the step with the noises among the inputs, behind those of the plant: w is at `places` of these."""
        m = self.sizes[1]
        return lambda x, u, p, w: self(x, u[:m], p, u[m:][places])


class ErrorStep:
    """What the covariance of the estimator is propagated by, P- = F P F' + G Q G', F = a Phi, G = a Psi + dJ/dw.

    Parameters
    ----------
    step : JumpMap
        The plant.
    clamped : tuple of int
        Where the nonlinearities are in x.
    choice : {"jacobian", "identity", "online"}
        a_k.
    transition : array (n, n), optional
        In place of Phi.
    carried : tuple of str
        Names of the true values of the nonlinearities, in the order of `clamped`: in memory those of the sample before.
    """

    def __init__(
        self,
        step: JumpMap,
        clamped: tuple[int, ...],
        choice: Choice,
        transition: Array | None = None,
        carried: tuple[str, ...] = (),
    ):
        self.step, self.clamped, self.choice, self.carried = step, clamped, choice, carried
        self.F = step.Phi if transition is None else transition

    def __call__(
        self, x: Array, u: Array, p: Array, memory: Mapping[str, Any], inputs: Mapping[str, Any]
    ) -> tuple[Array, Array]:
        """Return (F, G) at an estimate."""
        step, kind = self.step, x.dtype
        n, _, q = step.sizes
        w = np.zeros(q, dtype=kind)
        projected = step.projected(x, u, p, w)
        if self.choice == "jacobian":
            a = complex_step(lambda value: evaluated(step.jump, value, u, p, w), projected)
        elif self.choice == "online":
            before, after = np.zeros(n, dtype=kind), np.zeros(n, dtype=kind)
            places = list(self.clamped)
            before[places] = np.concatenate([np.zeros(0), *[np.ravel(memory[name]) for name in self.carried]])
            after[places] = np.concatenate([np.zeros(0), *[np.ravel(inputs[name]) for name in self.carried]])
            a = online_gain(self.clamped, before, after, projected, evaluated(step.jump, projected, u, p, w))
        else:
            a = np.eye(n, dtype=kind)
        inside = complex_step(lambda value: evaluated(step.jump, projected, u, p, value), w)
        return (a @ self.F).astype(kind), (a @ step.Psi + inside).astype(kind)
