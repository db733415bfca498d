"""The regulator equations of a nonlinear plant (Francis, Byrnes, Isidori), solved by power series of the exosystem's state.

On x = x* + pi(w), driven by u = u* + gamma(w), the outputs are exactly what the exosystem generates:

    (d pi/d w) s(w) = f(x* + pi(w), u* + gamma(w)),    h(x* + pi(w), u* + gamma(w)) = h* + q(w)

and pi(s(w)) in place of the left-hand side in discrete time (Isidori and Byrnes, "Output regulation of nonlinear systems",
IEEE TAC 35, 1990). The coefficients of degree k solve linear regulator equations in which the monomials of degree k are
the exosystem (Huang and Rugh, "An approximation method for the nonlinear servomechanism problem", IEEE TAC 37, 1992;
Krener, "The construction of optimal linear and nonlinear regulators", 1992).
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from .analysis import OperatingPoint, Values
from .components import vector_of
from .design import digits_of
from .errors import ModelError
from .exosystems import Exosystem
from .nonlinear_equations import NonlinearEquations, terms_of
from .plant import Plant
from .polynomials import polynomials
from .regulator_equations import ModeSolvability, RegulatorSolution, francis, solvability

Array = NDArray[Any]

DUST = 1.0e-13
"""Coefficients below this fraction of the largest may be rounding; they go where the equations allow it."""

EXACT = 1.0e-12
"""A residual below this fraction of the rates is rounding, and has no slope."""


@dataclass(frozen=True, eq=False)
class RegulatorSeries:
    """pi(w) and gamma(w) up to a degree, as deviations from the operating point, and how good they are.

    Attributes
    ----------
    plant : Plant
    point : OperatingPoint
        x*, u*; w = 0 there.
    exosystem : Exosystem or Plant
        What was given.
    order : int
        Highest degree.
    states, inputs : tuple of str
        Labels of the rows of pi and gamma; measured disturbances are no inputs.
    exosystem_states : tuple of str
        Labels of w.
    exponents : tuple of ndarray, (monomials of degree k, r)
        The monomials of degree k = 1, 2, .. in graded lexicographic order.
    state_maps, input_maps : tuple of ndarray
        Pi_k (n, monomials) and Gamma_k (p, monomials) for k = 1, 2, ..
    degrees : tuple of RegulatorSolution
        The linear equations of each degree: rank, residual, solvability at each of its eigenvalues.
    warnings : tuple of str
        Sentences of all degrees.
    """

    plant: Plant
    point: OperatingPoint
    exosystem: Exosystem | Plant
    order: int
    states: tuple[str, ...]
    inputs: tuple[str, ...]
    exosystem_states: tuple[str, ...]
    exponents: tuple[Array, ...]
    state_maps: tuple[Array, ...]
    input_maps: tuple[Array, ...]
    degrees: tuple[RegulatorSolution, ...]
    warnings: tuple[str, ...]
    _equations: NonlinearEquations = field(repr=False)

    def truncated(self, order: int) -> RegulatorSeries:
        """Return the same series cut off after a lower degree."""
        if not isinstance(order, int) or not 1 <= order <= self.order:
            raise ModelError(f"{self.plant.name}: the series has order {self.order}; cut it off at 1 to {self.order}")
        cut = {name: getattr(self, name)[:order] for name in ("exponents", "state_maps", "input_maps", "degrees")}
        return replace(self, order=order, **cut)

    def at(self, w: Any) -> tuple[Array, Array]:
        """Return pi(w) (n,) and gamma(w) (p,) at a point w (r,), as numbers."""
        point = self._vector("w", w)
        return self._equations.values(self.state_maps, point), self._equations.values(self.input_maps, point)

    def terms(self) -> tuple[list[list[tuple[tuple[int, ...], float]]], list[list[tuple[tuple[int, ...], float]]]]:
        """Return (exponents, coefficient) of what is not zero, for each row of pi and of gamma, by rising degree."""

        def of(maps: Sequence[Array]) -> list[list[tuple[tuple[int, ...], float]]]:
            pairs = list(zip(self.exponents, maps, strict=True))
            return [
                [
                    (tuple(exponents.tolist()), float(value))
                    for table, own in pairs
                    for exponents, value in zip(table, own[row], strict=True)
                    if value
                ]
                for row in range(len(maps[0]))
            ]

        return of(self.state_maps), of(self.input_maps)

    def expressions(
        self, w: ca.SX, state_coefficients: ca.SX | None = None, input_coefficients: ca.SX | None = None
    ) -> tuple[ca.SX, ca.SX]:
        """Return pi(w) and gamma(w) as CasADi expressions with few operations.

        Parameters
        ----------
        w : casadi.SX, shape (r, 1)
            State of the exosystem.
        state_coefficients, input_coefficients : casadi.SX, optional
            In the order of `terms`, rows one after another, such as run-time parameters. Default: the numbers,
            rounded to 9 digits.
        """
        if ca.SX(w).numel() != len(self.exosystem_states):
            raise ModelError(
                f"{self.plant.name}: w has {ca.SX(w).numel()} element(s); give {len(self.exosystem_states)}"
            )
        answers = []
        given_all = (state_coefficients, input_coefficients)
        for rows, given, own in zip(self.terms(), given_all, self.rounded().values(), strict=True):
            numbers = ca.SX(ca.DM(own)) if given is None else given
            starts = np.cumsum([0, *[len(row) for row in rows]])
            answers.append(
                [
                    {exponents: numbers[int(start) + k] for k, (exponents, _) in enumerate(row)}
                    for row, start in zip(rows, starts, strict=False)
                ]
            )
        whole = polynomials([*answers[0], *answers[1]], w)
        return whole[: len(self.states)], whole[len(self.states) :]

    def residual(self, w: Any) -> Array:
        """Return what is left of the nonlinear equations at a point w (r,): of each state, then of each output.

        The equations are evaluated as they stand, by CasADi: nothing of the Taylor arithmetic takes part but the slopes of the
        polynomials.
        """
        return self._left(self._vector("w", w))[0]

    def _vector(self, what: str, given: Any) -> Array:
        return vector_of(self.plant.name, what, given, len(self.exosystem_states))

    def _left(self, w: Array) -> tuple[Array, float]:
        return self._equations.residual(self.state_maps, self.input_maps, w)

    def slopes(self, direction: Any, amplitudes: Sequence[float]) -> list[tuple[float, float, float]]:
        """Return (amplitude, size of the residual, slope to the next amplitude) along a direction of w.

        Parameters
        ----------
        direction : array, shape (r,)
            w is amplitude times this.
        amplitudes : sequence of float
            Falling; the slope is log(residual / next residual) / log(amplitude / next amplitude). It tends to order + 1, or to
            the next degree that does not vanish. NaN for the last one, and where a residual is rounding.
        """
        line = self._vector("the direction of w", direction)
        found = [self._left(amplitude * line) for amplitude in amplitudes]
        sizes = [float(np.linalg.norm(left)) for left, _ in found]
        sound = [size > EXACT * scale for size, (_, scale) in zip(sizes, found, strict=True)]
        rows = []
        for k, (amplitude, size) in enumerate(zip(amplitudes, sizes, strict=True)):
            slope = math.nan
            if k + 1 < len(sizes) and sound[k] and sound[k + 1]:
                slope = math.log(size / sizes[k + 1]) / math.log(amplitude / amplitudes[k + 1])
            rows.append((float(amplitude), size, slope))
        return rows

    def rounded(self) -> dict[str, Array]:
        """Return the coefficients of `terms`, rounded to 9 digits, as they go into `design.json`."""
        names = ("state_coefficients", "input_coefficients")
        return {
            name: np.array([float(f"{value:.8e}") for row in rows for _, value in row])
            for name, rows in zip(names, self.terms(), strict=True)
        }

    def source(self) -> str:
        """Return a hash of what was asked for: same question, same hash, on any machine."""
        own = self.exosystem
        if isinstance(own, Plant):
            asked: list[Any] = [own.fingerprint()]
        else:
            asked = [own.dt, own.signals, digits_of(own.matrix), digits_of(own.output)]
        point = [digits_of(item) for item in (self.point.x, self.point.u, self.point.p)]
        parts = [self.plant.fingerprint(), self.order, *asked, *point]
        return hashlib.sha256(repr(parts).encode()).hexdigest()[:16]

    def with_coefficients(self, values: Mapping[str, Any]) -> RegulatorSeries:
        """Return the series with other coefficients for the same `terms`, such as those of a `design.json`."""
        answer = []
        for name, maps in (("state_coefficients", self.state_maps), ("input_coefficients", self.input_maps)):
            given, start = np.asarray(values[name], dtype=float).ravel(), 0
            kept = sum(int(np.count_nonzero(item)) for item in maps)
            if given.size != kept or not np.all(np.isfinite(given)):
                raise ModelError(
                    f"{self.plant.name}: {given.size} {name.replace('_', ' ')} are given; the series has {kept}, all finite"
                )
            made = [np.array(item) for item in maps]
            for row in range(len(maps[0])):
                for item in made:
                    columns = np.flatnonzero(item[row])
                    item[row, columns] = given[start : start + len(columns)]
                    start += len(columns)
            answer.append(tuple(made))
        return replace(self, state_maps=answer[0], input_maps=answer[1])

    def properties(self, values: Mapping[str, Any] | None = None) -> dict[str, tuple[float, float]]:
        """Return what the coefficients have to fulfil: name -> (measured, largest accepted).

        Parameters
        ----------
        values : dict, optional
            Other coefficients for the same question. Default: these, rounded to 9 digits, which moves a product of k of them
            by k 5e-9 of its terms; four times that is accepted of the equations of degree k.
        """
        other = self.with_coefficients(self.rounded() if values is None else values)
        answer = {}
        for degree in range(1, self.order + 1):
            share = self._equations.share(other.state_maps, other.input_maps, degree)
            answer[f"residual of degree {degree}, of its terms"] = (share, 2e-8 * degree)
        return answer


def regulator_series(plant: Plant, point: Values, generator: Exosystem | Plant, order: int) -> RegulatorSeries:
    """Solve the nonlinear regulator equations by power series.

    Parameters
    ----------
    plant : Plant
        Continuous or discrete, without attitudes; its dynamics and the outputs with a reference analytic at the point.
    point : OperatingPoint or dict
        An equilibrium, as `trim` finds it: w = 0 there, and what the exosystem generates are deviations from it.
    generator : Exosystem or Plant
        Of the same time base. A signal named like a sensor or a state of the plant is its reference, one named like an input
        a measured disturbance. A nonlinear exosystem is a Plant without inputs, at rest at zero; its sensors are the signals.
    order : int
        Highest degree, 1 (the linear regulator equations) to 15.

    Returns
    -------
    RegulatorSeries
        It holds near w = 0; `residual` and `slopes` say how near.

    Raises
    ------
    RegulatorError
        If a degree has no solution: that degree, the sum (or product) of eigenvalues at which the plant's pencil has too small
        a rank, that rank, and the residual that least squares leaves.
    ModelError
        If an operation has no power series at the point (it is named, and the equation), the point is no equilibrium, names or
        time bases do not match, or there are too many monomials.

    Examples
    --------
    >>> from plantc.symbolic import Plant
    >>> from plantc.symbolic.exosystems import harmonic
    >>> from plantc.symbolic.power_series import regulator_series
    >>> spring = Plant("spring")
    >>> position, push = spring.state("position"), spring.input("push")
    >>> spring.dynamics({position: position + position**3 + push})
    >>> series = regulator_series(spring, {}, harmonic("position", 1.0), 3)
    >>> [item.round(9).tolist() for item in series.input_maps]
    [[[-1.0, 1.0]], [[0.0, 0.0, 0.0]], [[-1.0, 0.0, 0.0, 0.0]]]
    """
    equations = NonlinearEquations(plant, point, generator, order)
    states: list[Array] = []
    inputs: list[Array] = []
    solved, said = [], []
    for degree in range(1, order + 1):
        disturbance, reference = equations.right_hand_sides(states, inputs, degree)
        model, own = equations.linear(degree, disturbance, reference)
        found = francis(model, own)
        Pi, Gamma = _without_dust(found, list(zip(states, inputs, strict=True)))
        states.append(Pi)
        inputs.append(Gamma)
        solved.append(found)
        said += [f"degree {degree}: {text}" for text in found.warnings]
    tables = tuple(equations.monomials.exponents[degree] for degree in range(1, order + 1))
    return RegulatorSeries(
        plant, equations.where, generator, order, equations.view.states, equations.view.inputs, equations.labels,
        tables, tuple(states), tuple(inputs), tuple(solved), tuple(said), equations,
    )  # fmt: skip


def series_solvability(
    plant: Plant, point: Values, generator: Exosystem | Plant, order: int
) -> tuple[tuple[ModeSolvability, ...], ...]:
    """Return, for each degree from 1 and each of its eigenvalues, whether the equations are solvable for all right-hand sides.

    Parameters
    ----------
    plant, point, generator, order
        As for `regulator_series`.

    Returns
    -------
    tuple of tuple of ModeSolvability
        The eigenvalues of degree k are the sums (continuous) or products (discrete) of k of the exosystem's.
    """
    equations = NonlinearEquations(plant, point, generator, order)
    answer = []
    for degree in range(1, order + 1):
        count = equations.monomials.count(degree)
        model, own = equations.linear(
            degree, np.zeros((len(equations.view.A), count)), np.zeros((len(equations.view.C), count))
        )
        answer.append(solvability(model, own))
    return tuple(answer)


# -- numbers ----------------------------------------------------------------------------------------------------------


def _without_dust(found: RegulatorSolution, before: Sequence[tuple[Array, Array]]) -> tuple[Array, Array]:
    """Return Pi_k and Gamma_k without what is rounding: small, and of no account in any equation.

    Small is beside the largest coefficient of all degrees, or, where an equation objects, beside the largest of the row.
    """
    view, M, P, Q = found.model, found.exosystem.matrix, found.disturbance, found.reference

    def left(Pi: Array, Gamma: Array) -> Array:
        return np.vstack([view.A @ Pi + view.B @ Gamma + P - Pi @ M, view.C @ Pi + view.D @ Gamma - Q])

    whole = [(found.state_map, found.input_map), *before]
    tops = [np.max(np.hstack([np.abs(item[k]) for item in whole]), axis=1, keepdims=True, initial=0.0) for k in (0, 1)]
    own = found.state_map, found.input_map
    allowed = np.maximum(2 * np.abs(left(*own)), 1e-15 * terms_of(view, M, P, Q, *own))
    for scales in ([np.max(np.vstack(tops), initial=0.0)] * 2, tops):
        clean = [np.where(np.abs(item) <= DUST * top, 0.0, item) for item, top in zip(own, scales, strict=True)]
        if np.all(np.abs(left(*clean)) <= allowed):
            return clean[0], clean[1]
    return own
