"""The nonlinear equations of a plant and its exosystem: as tapes for power series, and as functions for numbers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import combinations_with_replacement
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from .analysis import OperatingPoint, Values, linearise
from .discretisation import increment
from .errors import ModelError
from .exosystems import Exosystem, exosystem, time_text
from .expressions import Tape, tape
from .plant import Plant
from .regulator_equations import LinearModel, regulated
from .taylor import Monomials, Series, compose

Array = NDArray[Any]

HIGHEST_ORDER = 15
"""Highest order of a series."""

MOST_MONOMIALS = 1000
"""Most monomials of one degree: their equations are solved as one exosystem of as many states."""

EQUILIBRIUM = 1.0e-9
"""Largest rate at the operating point, relative to the terms of its equation."""


class NonlinearEquations:
    """The nonlinear equations of a plant and its exosystem: as tapes for series, and as functions for numbers."""

    def __init__(self, plant: Plant, point: Values, generator: Exosystem | Plant, order: int):
        if not isinstance(order, int) or not 1 <= order <= HIGHEST_ORDER:
            raise ModelError(
                f"{plant.name}: the order of the series is {order!r}; give a whole number from 1 to {HIGHEST_ORDER}"
            )
        if plant.has_attitude:
            raise ModelError(f"{plant.name}: an attitude has no deviation that is a power series; use angles")
        self.dt = _time_of(plant)
        where = point if isinstance(point, OperatingPoint) and point.plant is plant else OperatingPoint.at(plant, point)
        self.plant, self.where = plant, where
        flow, signals, w, self.linear_exosystem, self.labels = _generator(generator, self.dt)
        r, self.names = self.linear_exosystem.order, self.linear_exosystem.signals
        if r == 0:
            raise ModelError(f"{plant.name}: the exosystem has no state; a series needs one to be in powers of")
        if math.comb(r + order - 1, order) > MOST_MONOMIALS:
            raise ModelError(
                f"{plant.name}: {r} exosystem states have {math.comb(r + order - 1, order)} monomials of degree {order}, more "
                f"than {MOST_MONOMIALS}; lower the order, or take an exosystem with fewer states"
            )
        self.monomials = Monomials(r, order)
        what = "the next" if plant.is_discrete else "the rate of"
        labels = [f"{what} {name}" for name in _state_labels(plant)]
        symbols, rates = [plant.x, plant.u], _folded(plant, _dynamics(plant), where.p)
        numbers = [[Series.constant(self.monomials, value, order) for value in item] for item in (where.x, where.u)]
        _Composed(plant.name, symbols, rates, labels).series(
            numbers
        )  # names what has no derivative, before linearise does
        linear = linearise(plant, where)
        self.view, _, _ = regulated(linear, self.linear_exosystem)
        labels += [f"the output {name}" for name in self.view.outputs]
        outputs = _folded(plant, _outputs(plant, linear.outputs, self.view.outputs), where.p)
        self._plant_equations = _Composed(plant.name, symbols, ca.vertcat(rates, outputs), labels)
        owner = generator.name if isinstance(generator, Plant) else "the exosystem"
        labels = [f"{what} {name}" for name in self.labels] + [f"the signal {name}" for name in self.names]
        self._generator_equations = _Composed(owner, [w], ca.vertcat(flow, signals), labels)
        own = [Series(self.monomials, [None, np.eye(r)[i], *[None] * (order - 1)]) for i in range(r)]
        moved = self._generator_equations.series([own])
        self.flow, self.signals = moved[:r], moved[r:]
        self._flow_powers = {1: self.flow}
        self._check_generator(owner)
        S, discrete = self.linear_exosystem.matrix, self.dt is not None
        self._matrices = monomial_matrices(self.monomials, S, discrete=discrete)
        self._inputs = [self.names.index(name) if name in self.view.disturbances else -1 for name in linear.inputs]
        self._check_equilibrium()

    # -- series

    def series_of_plant(self, states: Sequence[Array], inputs: Sequence[Array], order: int) -> list[Series]:
        """Return dynamics and outputs as series, cut off after a degree, pi and gamma being known to some degree."""

        def known(maps: Sequence[Array], row: int, value: float) -> Series:
            parts = [item[row] for item in maps[:order]] + [None] * (order - min(order, len(maps)))
            return Series(self.monomials, [np.array([value]), *parts])

        x = [known(states, row, value) for row, value in enumerate(self.where.x)]
        u, acting = [], 0
        for signal, value in zip(self._inputs, self.where.u, strict=True):
            if signal < 0:
                u.append(known(inputs, acting, value))
                acting += 1
            else:
                u.append(Series(self.monomials, [np.array([value]), *self.signals[signal].parts[1 : order + 1]]))
        return self._plant_equations.series([x, u])

    def right_hand_sides(self, states: Sequence[Array], inputs: Sequence[Array], degree: int) -> tuple[Array, Array]:
        """Return (R_k less what lower degrees do through a nonlinear flow, Q_k) for pi and gamma below a degree."""
        n = len(self.where.x)
        parts = [item.part(degree) for item in self.series_of_plant(states, inputs, degree)]
        disturbance = np.array(parts[:n]) - self._moved(states, degree)
        wanted = [self.signals[self.names.index(name)].part(degree) for name in self.view.outputs]
        reference = [q - h for q, h in zip(wanted, parts[n:], strict=True)]
        return disturbance, np.array(reference).reshape(len(wanted), self.monomials.count(degree))

    def _moved(self, states: Sequence[Array], degree: int) -> Array:
        """Return the part of a degree of what the flow makes of pi below that degree."""
        monomials = self.monomials
        total = np.zeros((len(self.where.x), monomials.count(degree)))
        if self.dt is not None:
            for j in range(1, degree):
                total += states[j - 1] @ np.array([item.part(degree) for item in self._powers(j)])
            return total
        for j in range(1, degree):
            slopes = None
            for i, own in enumerate(self.flow):
                part = own.parts[degree - j + 1]
                if part is None:
                    continue
                slopes = monomials.slopes(j, states[j - 1]) if slopes is None else slopes
                for row in range(len(total)):
                    total[row] += monomials.product(j - 1, slopes[row, i], degree - j + 1, part)
        return total

    def _powers(self, degree: int) -> list[Series]:
        """Return the monomials of a degree of the flow of a discrete exosystem, as series."""
        if degree not in self._flow_powers:
            lower, answer = self._powers(degree - 1), []
            for exponents in self.monomials.exponents[degree].tolist():
                i = next(k for k, power in enumerate(exponents) if power)
                exponents[i] -= 1
                answer.append(self.flow[i] * lower[self.monomials.place(exponents)])
            self._flow_powers[degree] = answer
        return self._flow_powers[degree]

    def linear(self, degree: int, disturbance: Array, reference: Array) -> tuple[LinearModel, Exosystem]:
        """Return the linear equations of a degree: the plant with a disturbance on each state, the monomials as exosystem."""
        view, n, m = self.view, len(self.view.A), len(self.view.C)
        kind = "sums" if self.dt is None else "products"
        note = "" if degree == 1 else f" (whose eigenvalues are {kind} of {degree} of the exosystem's)"
        outputs, pushes = tuple(f"reference {k}" for k in range(m)), tuple(f"part {k}" for k in range(n))
        model = LinearModel(
            view.A, view.B, view.C, view.D, np.eye(n), np.zeros((m, n)), view.dt, view.states, view.inputs, outputs,
            pushes, f"{self.plant.name}, degree {degree}{note}",
        )  # fmt: skip
        values = self.linear_exosystem.eigenvalues
        chosen = combinations_with_replacement(values, degree)
        together = [sum(item) if view.dt is None else np.prod(item) for item in chosen]
        signals = outputs + pushes
        own = Exosystem(
            self._matrices[degree], np.vstack([reference, disturbance]), signals, ("",) * len(signals), view.dt,
            np.array(together, dtype=complex), "matrix",
        )  # fmt: skip
        return model, own

    def share(self, states: Sequence[Array], inputs: Sequence[Array], degree: int) -> float:
        """Return the residual of the equations of a degree, relative to its terms."""
        view, M = self.view, self._matrices[degree]
        Pi, Gamma = states[degree - 1], inputs[degree - 1]
        P, Q = self.right_hand_sides(states[: degree - 1], inputs[: degree - 1], degree)
        left = np.vstack([view.A @ Pi + view.B @ Gamma + P - Pi @ M, view.C @ Pi + view.D @ Gamma - Q])
        terms = terms_of(view, M, P, Q, Pi, Gamma)
        return float(np.linalg.norm(left)) / max(float(np.linalg.norm(terms)), np.finfo(float).tiny)

    # -- numbers

    def values(self, maps: Sequence[Array], w: Array) -> Array:
        """Return the sum of polynomials of degrees 1, 2, .. at a point."""
        pairs = enumerate(maps, 1)
        return sum((own @ self.monomials.values(k, w) for k, own in pairs), np.zeros(len(maps[0])))

    def residual(self, states: Sequence[Array], inputs: Sequence[Array], w: Array) -> tuple[Array, float]:
        """Return what is left of the equations at w, of each state and then of each output, and the size of their terms."""
        r = self.monomials.variables
        if w.shape != (r,) or not np.all(np.isfinite(w)):
            raise ModelError(f"{self.plant.name}: w has {w.size} element(s); give {r} finite numbers")
        generated = self._generator_equations.numbers([w])
        flow, signals = generated[:r], generated[r:]
        pi, gamma = self.values(states, w), self.values(inputs, w)
        u, acting = np.array(self.where.u), 0
        for k, signal in enumerate(self._inputs):
            u[k] += gamma[acting] if signal < 0 else signals[signal]
            acting += signal < 0
        n = len(self.where.x)
        values = self._plant_equations.numbers([self.where.x + pi, u])
        rest = self._plant_equations.numbers([self.where.x, self.where.u])
        if self.dt is None:
            moved = self._slope(states, w) @ flow
        else:
            moved = self.values(states, flow) + self.where.x
        wanted = np.array([signals[self.names.index(name)] for name in self.view.outputs])
        left = np.concatenate([moved - values[:n], rest[n:] + wanted - values[n:]])
        terms = np.concatenate([moved, values[:n], values[n:], wanted])
        return left, max(1.0, float(np.linalg.norm(terms)))

    def _slope(self, states: Sequence[Array], w: Array) -> Array:
        """Return d pi/d w at a point, (n, r)."""
        total = np.zeros((len(self.where.x), self.monomials.variables))
        for degree, own in enumerate(states, 1):
            total += self.monomials.slopes(degree, own) @ self.monomials.values(degree - 1, w)
        return total

    # -- checks

    def _check_generator(self, owner: str) -> None:
        for label, item in zip((*self.labels, *self.names), (*self.flow, *self.signals), strict=True):
            if item.value != 0:
                raise ModelError(
                    f"{owner}: at w = 0 {'the rate or next value' if label in self.labels else 'the signal'} of {label!r} is "
                    f"{item.value:g}; w = 0 is the operating point, where an exosystem rests and its signals are zero"
                )

    def _check_equilibrium(self) -> None:
        plant, where, n = self.plant, self.where, len(self.where.x)
        values = self._plant_equations.numbers([where.x, where.u])[:n]
        left = values - where.x if plant.is_discrete else values
        linear = linearise(plant, where)
        terms = np.abs(linear.A) @ np.maximum(np.abs(where.x), 1e-3) + np.abs(linear.B) @ np.maximum(
            np.abs(where.u), 1e-3
        )
        worst = int(np.argmax(np.abs(left) / np.maximum(terms, 1e-9))) if n else 0
        if n and not abs(left[worst]) <= EQUILIBRIUM * max(terms[worst], 1e-9):
            what = "changes in a step by" if plant.is_discrete else "has the rate"
            raise ModelError(
                f"{plant.name}: the point is no equilibrium ({linear.states[worst]} {what} {left[worst]:.3g}); take that of trim"
            )


def monomial_matrices(monomials: Monomials, S: Array, *, discrete: bool) -> list[Array]:
    """Return M_0, M_1, ..: how the monomials of each degree go on where w goes on with S.

    Parameters
    ----------
    monomials : Monomials
        In as many variables as S has rows.
    S : ndarray, shape (r, r)
    discrete : bool
        Whether (S w)^[k] = M_k w^[k]; otherwise d/dt w^[k] = M_k w^[k] with w' = S w.

    Returns
    -------
    list of ndarray
        Square, of as many rows as there are monomials of the degree.
    """
    answer: list[Array] = [np.eye(1) if discrete else np.zeros((1, 1))]
    for degree in range(1, monomials.order + 1):
        matrix = np.zeros((monomials.count(degree),) * 2)
        for row, exponents in enumerate(monomials.exponents[degree].tolist()):
            for i in range(len(S)) if not discrete else [next(k for k, power in enumerate(exponents) if power)]:
                if not exponents[i]:
                    continue
                lower = list(exponents)
                lower[i] -= 1
                place = monomials.place(lower)
                if discrete:
                    matrix[row] = monomials.product(1, S[i], degree - 1, answer[-1][place])
                else:
                    unit = np.eye(1, monomials.count(degree - 1), place)[0]
                    matrix[row] += exponents[i] * monomials.product(1, S[i], degree - 1, unit)
        answer.append(matrix)
    return answer


class _Composed:
    """Expressions of some symbols: a tape for series, a function for numbers."""

    def __init__(self, owner: str, symbols: Sequence[ca.SX], whole: ca.SX, labels: Sequence[str]):
        self.owner, self.labels = owner, labels
        self._function = ca.Function("equations", list(symbols), [ca.densify(whole)])
        self._tape = self._read(symbols, whole)

    def _read(self, symbols: Sequence[ca.SX], whole: ca.SX) -> Tape:
        try:
            return tape(self._function)
        except ModelError:
            for label, row in zip(self.labels, ca.vertsplit(ca.densify(whole)), strict=True):
                try:
                    tape(ca.Function("equation", list(symbols), [row]))
                except ModelError as error:
                    raise ModelError(f"{self.owner}: in {label}, {error}") from None
            raise

    def series(self, inputs: Sequence[Sequence[Series]]) -> list[Series]:
        """Return each equation as a series."""
        return compose(self._tape, inputs, self.owner, self.labels)

    def numbers(self, inputs: Sequence[Array]) -> Array:
        """Return each equation as a number."""
        return np.asarray(self._function.call(list(inputs))[0], dtype=float).ravel()


def _time_of(plant: Plant) -> float | None:
    """Return the seconds per step of a plant, None for a continuous one."""
    if isinstance(plant.dt, tuple):
        raise ModelError(f"{plant.name}: its dt is an input; discretise it with a constant dt")
    return plant.dt


def _dynamics(plant: Plant) -> ca.SX:
    """Return the rates, or the next state; angles as they are, not wrapped: near the point that is the same."""
    if plant.discretisation is not None:
        return plant.x + plant.without_noise(increment(plant))
    return plant.without_noise(plant.dynamics_expression())


def _outputs(plant: Plant, labels: Sequence[str], wanted: Sequence[str]) -> ca.SX:
    """Return the outputs that have a reference: elements of sensors, or of the state."""
    sensors = ca.vertcat(ca.SX(0, 1), *[plant.without_noise(plant.folded(item.expression)) for item in plant.sensors])
    x, names = plant.x, _state_labels(plant)
    rows = [sensors[labels.index(name)] if name in labels else x[names.index(name)] for name in wanted]
    return ca.vertcat(ca.SX(0, 1), *rows)


def _state_labels(plant: Plant) -> list[str]:
    """Return the labels of the states of a plant without attitudes, as `linearise` names them."""
    pairs = [(state.signal.name, state.signal.size) for state in plant.states]
    return [name if size == 1 else f"{name}_{k}" for name, size in pairs for k in range(size)]


def _folded(plant: Plant, expression: ca.SX, p: Array) -> ca.SX:
    """Return an expression with constants and parameters replaced by their numbers."""
    folded = plant.folded(expression)
    return ca.substitute(folded, plant.p, ca.DM(p)) if len(p) else folded


def _generator(given: Exosystem | Plant, dt: float | None) -> tuple[ca.SX, ca.SX, ca.SX, Exosystem, tuple[str, ...]]:
    """Return (rate or next value, signals, w, the linear exosystem near zero, labels of w)."""
    if isinstance(given, Exosystem):
        w = ca.SX.sym("w", given.order)
        flow, signals = (ca.SX(ca.sparsify(ca.DM(item))) @ w for item in (given.matrix, given.output))
        return flow, signals, w, given, given.states
    if not isinstance(given, Plant):
        raise ModelError(
            f"the exosystem is {type(given).__name__}; give an Exosystem, or a Plant without inputs for a nonlinear one"
        )
    if given.inputs or given.has_attitude or not given.sensors:
        raise ModelError(
            f"{given.name}: as an exosystem it has {len(given.inputs)} input(s), {len(given.sensors)} sensor(s)"
            f"{' and an attitude' if given.has_attitude else ''}; give a plant without inputs and attitudes, its signals sensors"
        )
    if _time_of(given) != dt:
        raise ModelError(
            f"{given.name}: the exosystem is {time_text(_time_of(given))} and the plant {time_text(dt)}; give both one time base"
        )
    zero = OperatingPoint.at(given, {state.symbol: np.zeros(state.signal.size) for state in given.states})
    linear = linearise(given, zero)
    signals = _outputs(given, linear.outputs, linear.outputs)
    flow, signals = (_folded(given, item, zero.p) for item in (_dynamics(given), signals))
    made = exosystem(linear.A, linear.C, linear.outputs, dt=linear.dt)
    return flow, signals, given.x, made, linear.states


def terms_of(view: LinearModel, M: Array, P: Array, Q: Array, Pi: Array, Gamma: Array) -> Array:
    """Return the size of the terms of each equation of a degree."""
    upper = np.abs(Pi) @ np.abs(M) + np.abs(view.A) @ np.abs(Pi) + np.abs(view.B) @ np.abs(Gamma) + np.abs(P)
    return np.vstack([upper, np.abs(view.C) @ np.abs(Pi) + np.abs(view.D) @ np.abs(Gamma) + np.abs(Q)])
