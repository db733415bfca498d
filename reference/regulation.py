"""Output regulation as plain NumPy: a Kalman filter and a high-gain observer as exosystems, the Francis equations, the loop.

J. A. Meda-Campana et al., "The output regulation and the Kalman filter as the signal generator", IEEE Access 11, 2023.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .controllers import BAD_INPUT, BAD_PARAM, OVERFLOW, Array, Fields, Range, StateFeedback, held


def kalman_exosystem(
    S: Array, Q: Array, D: Array, M: Array, readings: Array, present: Array | None = None, P: Array | None = None
) -> tuple[Array, Array]:
    """Return the corrected estimates and covariances of a signal generator's state (eqs. 50-61), w = 0 before the first reading.

    Parameters
    ----------
    S : (r, r) array
        Exosystem.
    Q : (m, r) array
        All signals, disturbances too.
    D, M : (r, r) and (m, m) array
        Covariances of process and readings.
    readings : (steps, m) array
        At k = 0, 1, ...; at k = 0 they correct without a prediction.
    present : (steps, m) array of bool, optional
        Which readings there are.
    P : (r, r) array, optional
        Covariance before the first reading; default the identity.

    Returns
    -------
    array (steps, r), array (steps, r, r)
        What the controller uses, and its covariance.
    """
    w, P = np.zeros(len(S)), np.eye(len(S)) if P is None else np.array(P, dtype=float)
    estimates, covariances = [], []
    for k, z in enumerate(readings):
        if k:
            w, P = S @ w, S @ P @ S.T + D
        rows = np.flatnonzero(present[k]) if present is not None else np.arange(len(Q))
        if len(rows):
            H = Q[rows]
            G = np.linalg.solve(H @ P @ H.T + M[np.ix_(rows, rows)], H @ P).T
            w, P = w + G @ (z[rows] - H @ w), (np.eye(len(S)) - G @ H) @ P
            P = (P + P.T) / 2
        estimates.append(w)
        covariances.append(P)
    return np.array(estimates), np.array(covariances)


def high_gain_exosystem(S: Array, gain: Array, readings: Array, initial: Array) -> Array:
    """Return w_k = S w_(k-1) + gain psi_(k-1), what is known before the reading of step k, shape (steps, r)."""
    w, found = np.array(initial, dtype=float), []
    for z in readings:
        found.append(w)
        w = S @ w + gain @ np.atleast_1d(z)
    return np.array(found)


def francis(A: Array, B: Array, C: Array, S: Array, Q: Array, P: Array) -> tuple[Array, Array]:
    """Return Pi and Gamma of Pi S = A Pi + B Gamma + P, C Pi = Q, by the whole Kronecker matrix and least squares."""
    (n, p), m, r = B.shape, len(C), len(S)
    eye = np.eye(r)
    M = np.block(
        [[np.kron(eye, A) - np.kron(S.T, np.eye(n)), np.kron(eye, B)], [np.kron(eye, C), np.zeros((m * r, p * r))]]
    )
    z = np.linalg.lstsq(M, np.concatenate([-P.ravel("F"), Q.ravel("F")]), rcond=None)[0]
    return z[: n * r].reshape(r, n).T, z[n * r :].reshape(r, p).T


def closed_loop(
    f: Callable[[Array, Array], Array],
    x: Array,
    estimates: Array,
    K: Array,
    Pi: Array,
    Gamma: Array,
    equilibrium: tuple[Array, Array],
) -> tuple[Array, Array]:
    """Return states and inputs of x+ = f(x, u), u = u* + Gamma w - K (x - x* - Pi w), w being what a generator estimates.

    Parameters
    ----------
    f : callable
        One step of the plant.
    x : array (n,)
        Where it starts.
    estimates : array (steps, r)
        w at every step.
    K, Pi, Gamma : array
        Gain (A - B K stable) and the solution of the regulator equations.
    equilibrium : (x*, u*)
        Where the plant was linearised.

    Returns
    -------
    array (steps, n), array (steps, p)
        Ends early where a state is beyond 1e4, or no number.
    """
    states, inputs = [], []
    x_o, u_o = equilibrium
    for w in estimates:
        if not np.all(np.abs(x) <= 1e4):
            break
        u = u_o + Gamma @ w - K @ (x - x_o - Pi @ w)
        states.append(x)
        inputs.append(u)
        x = f(x, u)
    return np.array(states), np.array(inputs)


@dataclass(frozen=True)
class HighGainOracle:
    """The high-gain observer as an exosystem, entry by entry; see `plantc.symbolic.signal_generators`.

    Attributes
    ----------
    channels : tuple of (signal, S, gain)
        Of each channel: w+ = S w + gain psi; without a reading it coasts, as if that were what is expected.
    memory, params, inputs : tuple of Range
    """

    channels: tuple[tuple[str, Array, Array], ...]
    memory: tuple[Range, ...]
    params: tuple[Range, ...]
    inputs: tuple[Range, ...]

    def call(
        self, entry: str, memory: Any, inputs: Any, params: Any, precision: Any
    ) -> tuple[int, dict[str, Any], dict[str, Any]]:
        """Run an entry; see `plantc.symbolic.block.Oracle`."""
        p = {name: np.ravel(np.asarray(value, precision)) for name, value in params.items()}
        if entry == "init":
            sound = all(item.holds(p, precision) for item in self.params)
            return (0, {item.name: p[f"{item.name}_0"] for item in self.memory}, {}) if sound else (BAD_PARAM, {}, {})
        after, outputs = {}, {}
        ranges = {item.name: item for item in self.inputs}
        for signal, S, _ in self.channels:
            w = np.ravel(np.asarray(memory[f"observer_{signal}"], precision))
            gain = p[f"gain_{signal}"]
            expected = w[0]
            if bool(np.ravel(inputs[f"has_{signal}"])[0]):
                if not ranges[signal].holds(inputs, precision):
                    return BAD_INPUT, {}, {}
                expected = np.ravel(np.asarray(inputs[signal], precision))[0]
            coasting = S.astype(precision) @ w
            after[f"observer_{signal}"] = coasting + gain * (expected - w[0])
            outputs[f"w_{signal}"] = w
        if not all(item.holds(after, precision) for item in self.memory):
            return OVERFLOW, {}, {}
        return 0, after, outputs


@dataclass(frozen=True)
class RegulatorFeedback:
    """u = u* + Gamma w - K (x - x* - Pi w), Pi and Gamma given by their elements that are not zero.

    Attributes
    ----------
    states : tuple of (name, kind)
        As in `StateFeedback`.
    inputs : tuple of (name, size, low, high)
        What comes out.
    generated : tuple of str
        Inputs that w consists of.
    state_places, input_places : tuple of (row, column)
        Of Pi and Gamma.
    saturate : bool
        Whether u is held within its range.
    fixed : dict
        Of "gain", "state_map" and "input_map" those that are no parameters.
    """

    states: tuple[tuple[str, str], ...]
    inputs: tuple[tuple[str, int, Array, Array], ...]
    generated: tuple[str, ...]
    state_places: tuple[tuple[int, int], ...]
    input_places: tuple[tuple[int, int], ...]
    saturate: bool
    fixed: Fields = field(default_factory=dict)

    def __call__(self, memory: Fields, inputs: Fields, params: Fields) -> tuple[bool, Fields, Fields]:
        """Evaluate it; see `plantc.reference.controllers.Formula`."""
        w = np.concatenate([inputs[name] for name in self.generated])
        params = {**params, **{name: np.asarray(value, dtype=w.dtype) for name, value in self.fixed.items()}}
        sizes = [3 if kind == "attitude" else len(inputs[name]) for name, kind in self.states]
        Pi = self._matrix(params.get("state_map"), self.state_places, (sum(sizes), len(w)), w.dtype)
        ahead, parts = np.split(Pi @ w, np.cumsum(sizes)[:-1]), []
        for (name, kind), moved in zip(self.states, ahead, strict=True):
            if kind == "attitude":  # by a rotation vector, to first order
                parts.append(StateFeedback._deviation(kind, inputs[name], params[name]) - moved)
            else:  # the set point moves, and then an angle is wrapped
                parts.append(StateFeedback._deviation(kind, inputs[name], params[name] + moved))
        rows = params["gain"].reshape(-1, sum(sizes))
        Gamma = self._matrix(params.get("input_map"), self.input_places, (len(rows), len(w)), w.dtype)
        change = Gamma @ w - rows @ np.concatenate(parts)
        commands: Fields = {}
        any_held, start = False, 0
        for name, size, low, high in self.inputs:
            own = params[name] + change[start : start + size]
            start += size
            if self.saturate:
                was_held, own = held(own, low.astype(own.dtype), high.astype(own.dtype))
                any_held = any_held or was_held
            commands[name] = own
        return any_held, {}, commands

    @staticmethod
    def _matrix(values: Any, places: tuple[tuple[int, int], ...], shape: tuple[int, int], kind: Any) -> Array:
        matrix = np.zeros(shape, dtype=kind)
        for (i, j), value in zip(places, values if values is not None else (), strict=True):
            matrix[i, j] = value
        return matrix


@dataclass(frozen=True)
class RetunedRegulator:
    """A regulator that solves its equations anew from the plant's parameters, when it starts.

    By another road than elimination: u* by Newton's method, the plant's matrices by complex step, Pi and Gamma by the whole
    Kronecker matrix. Everything in double precision; what is stored is rounded.

    Attributes
    ----------
    law : RegulatorFeedback
        Of `step`; its maps and u* are memory.
    step : callable
        (x, u, p) -> the rates, or the next state of a discrete plant; takes complex numbers.
    discrete : bool
        Which of these.
    outputs : callable
        (x, u, p) -> the regulated outputs.
    pivots : callable
        (p) -> what the elimination divides by, of its nominal values, and what is left of the equilibrium: a property of the
        compiled algorithm, which says how far parameters may be from those it was made for.
    x, u : array
        The set point at the nominal parameters.
    acting, away : tuple of int
        Inputs that act, and measured disturbances.
    generator : (S, Q, Q_dis)
        The exosystem: references and disturbances.
    plant_params : tuple of str
    limits : (least pivot, largest residual, number of pivots)
    memory, params, inputs, outputs_in : tuple of Range
    """

    law: RegulatorFeedback
    step: Callable[..., Any]
    discrete: bool
    outputs: Callable[..., Any]
    pivots: Callable[..., Any]
    x: Array
    u: Array
    acting: tuple[int, ...]
    away: tuple[int, ...]
    generator: tuple[Array, Array, Array]
    plant_params: tuple[str, ...]
    limits: tuple[float, float, int]
    memory: tuple[Range, ...]
    params: tuple[Range, ...]
    inputs: tuple[Range, ...]
    outputs_in: tuple[Range, ...]

    def solve(self, p: Array) -> tuple[Array, Array, Array]:
        """Return u* of the acting inputs, Pi and Gamma for a parameter vector."""
        n, acting = len(self.x), list(self.acting)

        def rates(x: Array, u: Array) -> Array:
            answer = np.ravel(self.step(x, u, p)[0])
            return answer - x if self.discrete else answer

        u = self.u.astype(float)
        for _ in range(50):
            slope = _complex_step(lambda v: rates(self.x, v), u)[:, acting]
            u[acting] -= np.linalg.lstsq(slope, rates(self.x, u), rcond=None)[0]
        A = _complex_step(lambda x: np.ravel(self.step(x, u, p)[0]), self.x)
        B = _complex_step(lambda v: np.ravel(self.step(self.x, v, p)[0]), u)
        C = _complex_step(lambda x: np.ravel(self.outputs(x, u, p)[0]), self.x)
        F = _complex_step(lambda v: np.ravel(self.outputs(self.x, v, p)[0]), u)
        S, Q, Q_dis = self.generator
        eye, r, away, m = np.eye(len(S)), len(S), list(self.away), len(C)
        M = np.block([[np.kron(eye, A) - np.kron(S.T, np.eye(n)), np.kron(eye, B[:, acting])],
                      [np.kron(eye, C), np.kron(eye, F[:, acting])]])  # fmt: skip
        right = np.concatenate([-(B[:, away] @ Q_dis).ravel("F"), (Q - F[:, away] @ Q_dis).ravel("F")])
        z = np.linalg.lstsq(M, right, rcond=None)[0]
        assert len(right) == (n + m) * r
        return u[acting], z[: n * r].reshape(r, n).T, z[n * r :].reshape(r, len(acting)).T

    def call(
        self, entry: str, memory: Any, inputs: Any, params: Any, precision: Any
    ) -> tuple[int, dict[str, Any], dict[str, Any]]:
        """Run an entry; see `plantc.symbolic.block.Oracle`."""
        given = {name: np.ravel(np.asarray(value, precision)) for name, value in params.items()}
        if entry == "init":
            return self._init(given)
        if not all(item.holds(inputs, precision) for item in self.inputs):
            return BAD_INPUT, {}, {}
        stored = {name: np.ravel(np.asarray(value, precision)) for name, value in memory.items()}
        known, start = {**given, "state_map": stored["state_map"], "input_map": stored["input_map"]}, 0
        for name, size, _, _ in self.law.inputs:
            known[name] = stored["hold"][start : start + size]
            start += size
        with np.errstate(all="ignore"):
            was_held, _, commands = self.law(
                {}, {k: np.ravel(np.asarray(v, precision)) for k, v in inputs.items()}, known
            )
        if not all(item.holds(commands, precision) for item in self.outputs_in):
            return OVERFLOW, {}, {}
        return 2 if was_held else 0, stored, commands

    def _init(self, given: Fields) -> tuple[int, dict[str, Any], dict[str, Any]]:
        if not all(item.holds(given, item_kind(given)) for item in self.params):
            return BAD_PARAM, {}, {}
        p = np.concatenate([np.zeros(0), *[given[name].astype(float) for name in self.plant_params]])
        least, most, count = self.limits
        with np.errstate(all="ignore"):
            judged = np.ravel(self.pivots(p)[0])
        if not (np.all(judged[:count] >= least) and np.all(np.abs(judged[count:]) <= most)):
            return BAD_PARAM, {}, {}
        hold, Pi, Gamma = self.solve(p)
        after = {"hold": hold}
        for name, matrix, places in (
            ("state_map", Pi, self.law.state_places),
            ("input_map", Gamma, self.law.input_places),
        ):
            after[name] = np.array([matrix[i, j] for i, j in places])
            rest = matrix.copy()
            for i, j in places:
                rest[i, j] = 0.0
            if np.max(np.abs(rest), initial=0.0) > 1e-6 * max(1.0, float(np.max(np.abs(matrix), initial=0.0))):
                raise ValueError(f"{name} has an element that is not kept, and not zero")
        after = {name: value.astype(item_kind(given)) for name, value in after.items()}
        return (
            (0, after, {}) if all(item.holds(after, item_kind(given)) for item in self.memory) else (OVERFLOW, {}, {})
        )


def item_kind(given: Fields) -> Any:
    """Return the precision of fields."""
    return next(iter(given.values())).dtype.type


def _complex_step(function: Callable[[Array], Array], at: Array) -> Array:
    """Return the Jacobian of a function of real numbers, without a difference (Squire and Trapp 1998)."""
    columns = []
    for k in range(len(at)):
        moved = at.astype(complex)
        moved[k] += 1e-30j
        columns.append(np.imag(function(moved)) / 1e-30)
    return np.stack(columns, axis=1) if columns else np.zeros((len(function(at)), 0))
