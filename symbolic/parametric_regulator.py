"""The regulator equations with the parameters of the plant left symbolic: x*(p), u*(p), Pi(p), Gamma(p)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components

from .analysis import OperatingPoint, SymbolicLinearisation, Values, linearise, symbolic_linearisation
from .elimination import Elimination, Row, Value, values_of
from .errors import ModelError
from .exosystems import Exosystem
from .plant import Plant, Symbol
from .regulator_equations import RegulatorSolution, francis

Array = NDArray[Any]

NEWTON_STEPS = 6
"""Steps from the nominal inputs where the equilibrium is linear neither in them nor in their squares."""


@dataclass(frozen=True, eq=False)
class ParametricRegulator:
    """Expressions of the parameters of a plant; each holds as long as no pivot gets small.

    Attributes
    ----------
    parameters : casadi.SX
        p, as in `Plant.p`.
    states, inputs : casadi.SX
        x* (a constant: the set point) and u*(p), which holds it.
    state_map, input_map : casadi.SX
        Pi (n, r) and Gamma (p, r), sparse.
    pivots : casadi.SX
        What is divided by (and what a square root is taken of), each divided by its nominal value, so that all are one
        there; a pivot that is near zero or negative says that these parameters are too far away.
    residual : casadi.SX
        What is left of the equilibrium where Newton's steps found it; empty where it was solved exactly.
    nominal : RegulatorSolution
        The numeric solution at the point.
    point : OperatingPoint
        Where that is.
    """

    parameters: ca.SX
    states: ca.SX
    inputs: ca.SX
    state_map: ca.SX
    input_map: ca.SX
    pivots: ca.SX
    residual: ca.SX
    nominal: RegulatorSolution = field(repr=False)
    point: OperatingPoint = field(repr=False)

    def at(self, p: Any) -> dict[str, Array]:
        """Return everything as numbers, for a parameter vector."""
        names = ("states", "inputs", "state_map", "input_map", "pivots", "residual")
        items = [getattr(self, name) for name in names]
        found = ca.Function("at", [self.parameters], [ca.densify(item) for item in items]).call([np.asarray(p)])
        return {name: np.asarray(value).reshape(item.shape) for name, value, item in zip(names, found, items)}


def parametric_francis(
    plant: Plant, point: Values, exosystem: Exosystem, *, free: Sequence[Symbol | str] | None = None
) -> ParametricRegulator:
    """Solve the regulator equations for every value of the plant's parameters, near those of the point.

    Parameters
    ----------
    plant : Plant
        Continuous or discrete, without attitudes; with as many inputs that act as references.
    point : OperatingPoint or dict
        An equilibrium at the nominal parameters, as `trim` finds it. Its states are the set point and stay.
    exosystem : Exosystem
        Of the same time base; its signals named as for `francis`.
    free : sequence, optional
        The inputs that hold the set point; default all that are no measured disturbance.

    Returns
    -------
    ParametricRegulator
        Computed in the C where parameters are checked, the controller follows a changed parameter.

    Raises
    ------
    RegulatorError
        If there is no solution at the point.
    ModelError
        If the plant is not square, has attitudes, or the set point is no equilibrium.

    Notes
    -----
    The exosystem is taken apart into its strongly connected groups, which leaves a triangular form: one column at a time,
    or two for a harmonic, with the factors of one pencil for all groups that are alike.
    """
    if plant.has_attitude:
        raise ModelError(f"{plant.name}: an attitude has no deviation that is symbolic; use angles, or numeric francis")
    where = point if isinstance(point, OperatingPoint) and point.plant is plant else OperatingPoint.at(plant, point)
    nominal = francis(linearise(plant, where), exosystem)
    view = nominal.model
    if view.B.shape[1] != len(view.C):
        raise ModelError(
            f"{plant.name}: {view.B.shape[1]} input(s) act on {len(view.C)} reference(s); symbolic equations need as many"
        )
    linear = symbolic_linearisation(plant)
    if isinstance(plant.dt, tuple):
        raise ModelError(f"{plant.name}: its dt is an input; discretise it with a constant dt")
    acting = [name.signal.name if isinstance(name, Symbol) else name for name in free or []] or _acting(
        plant, exosystem
    )
    u, pivots, residual = _equilibrium(plant, where, linear, acting)
    x = ca.SX(ca.DM(where.x))
    at = [ca.substitute(item, ca.vertcat(plant.x, plant.u), ca.vertcat(x, u)) for item in linear_matrices(linear)]
    Pi, Gamma, more = _solved(plant, where, nominal, *at)
    guards = ca.vertcat(ca.SX(0, 1), pivots, more)
    return ParametricRegulator(plant.p, x, u, Pi, Gamma, guards, residual, nominal, where)


def linear_matrices(linear: SymbolicLinearisation) -> tuple[ca.SX, ca.SX, ca.SX, ca.SX]:
    """Return A, B, C, D."""
    return linear.A, linear.B, linear.C, linear.D


def _acting(plant: Plant, exosystem: Exosystem) -> list[str]:
    return [symbol.signal.name for symbol in plant.inputs if symbol.signal.name not in exosystem.signals]


# -- the equilibrium --------------------------------------------------------------------------------------------------


def _equilibrium(
    plant: Plant, where: OperatingPoint, linear: SymbolicLinearisation, free: list[str]
) -> tuple[ca.SX, ca.SX, ca.SX]:
    """Return u*(p), the pivots of its equations, and what Newton's steps left of them."""
    source = plant.discretisation.continuous if plant.discretisation else plant
    rates = plant.without_noise(source.dynamics_expression())
    if source.is_discrete:
        rates = rates - plant.x
    rates = plant.folded(rates)
    pieces, unknown, start, k = [], [], [], 0
    for symbol in plant.inputs:
        size, name = symbol.signal.size, symbol.signal.name
        pieces.append(ca.SX(symbol) if name in free else ca.SX(ca.DM(where.u[k : k + size])))
        if name in free:
            unknown.append(ca.SX(symbol))
            start += list(where.u[k : k + size])
        k += size
    z, u, z0 = ca.vertcat(ca.SX(0, 1), *unknown), ca.vertcat(ca.SX(0, 1), *pieces), np.array(start)
    left = ca.substitute(rates, ca.vertcat(plant.x, plant.u), ca.vertcat(ca.SX(ca.DM(where.x)), u))
    left = ca.vertcat(ca.SX(0, 1), *[row for row in ca.vertsplit(ca.densify(left)) if not _vanishes(row, z, plant.p)])
    if not left.numel():
        return ca.substitute(u, z, ca.SX(ca.DM(z0))) if z0.size else u, ca.SX(0, 1), ca.SX(0, 1)
    slope = ca.jacobian(left, z)
    if slope.shape[0] != slope.shape[1]:
        raise ModelError(
            f"{plant.name}: {slope.shape[1]} free input(s) are to hold the set point in {slope.shape[0]} equation(s); say "
            "which inputs are free"
        )
    residual, zero = ca.SX(0, 1), ca.SX.zeros(z.numel())

    def step(slope: ca.SX, value: ca.SX) -> tuple[ca.SX, ca.SX]:
        return _linear_step(slope, value, plant.p, where.p, f"{plant.name}, its equilibrium")

    if not ca.depends_on(ca.vec(slope), z):
        found, guards = step(slope, ca.substitute(left, z, zero))
    elif _only_squares(left, z):
        of_squares = ca.substitute(slope @ ca.diag(0.5 / z), z, ca.SX(ca.DM(z0)))
        squares, guards = step(of_squares, ca.substitute(left, z, zero))
        guards = ca.vertcat(guards, squares / ca.SX(ca.DM(z0**2)))
        found = ca.SX(ca.DM(np.sign(z0))) * ca.sqrt(squares)
    else:
        found = ca.SX(ca.DM(z0))
        for _ in range(NEWTON_STEPS):
            change, guards = step(ca.substitute(slope, z, found), ca.substitute(left, z, found))
            found = found + change
        residual = ca.substitute(left, z, found)
    _check_equilibrium(plant, where, left, z, z0)
    return ca.substitute(u, z, found), guards, residual


def _vanishes(row: ca.SX, z: ca.SX, p: ca.SX) -> bool:
    """Whether an equation holds whatever inputs and parameters are."""
    return bool(ca.sparsify(row).nnz() == 0) or (not ca.depends_on(row, ca.vertcat(z, p)) and abs(float(row)) < 1e-12)


def _only_squares(left: ca.SX, z: ca.SX) -> bool:
    """Whether equations are linear in the squares of their unknowns."""
    slope = ca.jacobian(left, z)
    at_zero = ca.sparsify(ca.substitute(slope, z, ca.SX.zeros(z.numel())))
    curved = ca.jacobian(ca.vec(slope), z)
    size = left.numel()
    mixed = [k for k in range(size * z.numel()) for j in range(z.numel()) if k // size != j and curved[k, j].nnz()]
    return at_zero.nnz() == 0 and not ca.depends_on(ca.vec(curved), z) and not mixed


def _linear_step(slope: ca.SX, value: ca.SX, p: ca.SX, p0: Array, owner: str) -> tuple[ca.SX, ca.SX]:
    """Return -slope^-1 value, and the pivots."""
    factors = Elimination(values_of(ca.sparsify(slope), p, p0), owner)
    rows = values_of(ca.densify(value), p, p0)
    moved = factors.solve({i: row[0] for i, row in enumerate(rows) if row and not row[0].is_zero})
    change = ca.vertcat(*[-moved[k].expression if k in moved else ca.SX(0) for k in range(len(rows))])
    return change, ca.vertcat(ca.SX(0, 1), *[item.expression for item in factors.pivots()])


def _check_equilibrium(plant: Plant, where: OperatingPoint, left: ca.SX, z: ca.SX, z0: Array) -> None:
    """Refuse a point that is no equilibrium at its own parameters."""
    slope = ca.jacobian(left, z)
    function = ca.Function("equilibrium", [z, plant.p], [ca.densify(left), ca.densify(slope)])
    value, terms = (np.asarray(item, dtype=float) for item in function.call([z0, where.p]))
    size = np.abs(terms) @ np.maximum(np.abs(z0), 1e-12)
    if np.any(np.abs(value.ravel()) > 1e-6 * np.maximum(size, 1e-9)):
        raise ModelError(
            f"{plant.name}: the point is no equilibrium (rates up to {np.max(np.abs(value)):.3g}); take that of trim"
        )


# -- the equations ----------------------------------------------------------------------------------------------------


def _solved(
    plant: Plant, where: OperatingPoint, nominal: RegulatorSolution, A: ca.SX, B: ca.SX, C: ca.SX, D: ca.SX
) -> tuple[ca.SX, ca.SX, ca.SX]:
    """Return Pi, Gamma and the pivots."""
    view, exosystem = nominal.model, nominal.exosystem
    labels = linearise(plant, where)
    drive, rows = list(labels.inputs), list(labels.outputs)
    acting, away = ([drive.index(name) for name in group] for group in (view.inputs, view.disturbances))
    eye = ca.SX.eye(plant.error_size)
    picks = [
        (C[rows.index(name), :], D[rows.index(name), :])
        if name in rows
        else (eye[labels.states.index(name), :], ca.SX(1, D.shape[1]))
        for name in view.outputs
    ]
    outputs = ca.vertcat(ca.SX(0, A.shape[1]), *[item[0] for item in picks])
    through = ca.vertcat(ca.SX(0, D.shape[1]), *[item[1] for item in picks])
    Q_dis = exosystem.output[[exosystem.signals.index(name) for name in view.disturbances]]
    Q_ref = exosystem.output[[exosystem.signals.index(name) for name in view.outputs]]
    P = B[:, away] @ _sparse(Q_dis) if away else ca.SX(A.shape[0], exosystem.order)
    Q = _sparse(Q_ref) - (through[:, away] @ _sparse(Q_dis) if away else ca.SX(*Q_ref.shape))
    pencil = ca.vertcat(ca.horzcat(A, B[:, acting]), ca.horzcat(outputs, through[:, acting]))
    right = ca.vertcat(-P, Q)
    return _by_groups(plant, where.p, exosystem.matrix, pencil, right)


def _by_groups(plant: Plant, p0: Array, S: Array, pencil: ca.SX, right: ca.SX) -> tuple[ca.SX, ca.SX, ca.SX]:
    """Solve group by group of S: Pi_J S_JJ = A Pi_J + B Gamma_J + P_J - (what the groups before it give)."""
    n, size, r = plant.error_size, pencil.shape[0], len(S)
    base = values_of(ca.sparsify(pencil), plant.p, p0)
    wanted = values_of(ca.sparsify(right), plant.p, p0)
    columns: list[Row] = [{} for _ in range(r)]
    kept: dict[bytes, Elimination] = {}
    pivots: list[Value] = []
    for group in _groups(S):
        own = S[np.ix_(group, group)]
        if own.tobytes() not in kept:
            kept[own.tobytes()] = Elimination(_pencil_of(base, own, n), f"{plant.name}, its regulator equations")
            pivots += kept[own.tobytes()].pivots()
        stacked: Row = {}
        for a, j in enumerate(group):
            column = {i: row[j] for i, row in enumerate(wanted) if j in row}
            for k in np.flatnonzero(S[:, j]):
                if k not in group:
                    before = {i: value for i, value in columns[k].items() if i < n}
                    factor = Value(ca.SX(-float(S[k, j])), -float(S[k, j]))
                    for i, value in before.items():
                        moved = factor * value
                        now = column[i] - moved if i in column else Value(-moved.expression, -moved.number)
                        column[i] = now
            stacked |= {a * size + i: value for i, value in column.items() if not value.is_zero}
        for place, value in kept[own.tobytes()].solve(stacked).items():
            columns[group[place // size]][place % size] = value
    whole = ca.SX(size, r)
    for j, column in enumerate(columns):
        for i, value in column.items():
            whole[i, j] = value.expression
    guards = ca.vertcat(ca.SX(0, 1), *[item.expression for item in pivots])
    whole = _without_zeros(whole, plant.p, p0)
    return whole[:n, :], whole[n:, :], guards


def _without_zeros(matrix: ca.SX, p: ca.SX, p0: Array) -> ca.SX:
    """Drop elements whose terms cancel whatever the parameters are, which no simplification sees.

    An identity between analytic expressions that holds at random parameters holds everywhere, but for a set of measure zero
    (Schwartz 1980; Zippel 1979); four of them are looked at.
    """
    function, rng = ca.Function("look", [p], [ca.densify(matrix)]), np.random.default_rng(0)
    largest = np.zeros(matrix.shape)
    for _ in range(4):
        look = p0 * (1 + 0.1 * rng.uniform(-1, 1, len(p0))) + 1e-3 * (p0 == 0) * rng.uniform(-1, 1, len(p0))
        value = np.abs(np.asarray(function(look), dtype=float)).reshape(matrix.shape)
        largest = np.maximum(largest, np.where(np.isfinite(value), value, np.inf))
    top = np.max(np.where(np.isfinite(largest), largest, 0.0), axis=1, initial=0.0)  # of each row, in one unit
    answer = ca.SX(*matrix.shape)
    for i, j in zip(matrix.sparsity().row(), matrix.sparsity().get_col(), strict=True):
        if not largest[i, j] <= 1e-12 * top[i]:
            answer[i, j] = matrix[i, j]
    return answer


def _pencil_of(base: list[Row], own: Array, n: int) -> list[Row]:
    """Return the equations of one group: I x [A, B; C, D] less S_JJ' x [I, 0; 0, 0]."""
    size, rows = len(base), []
    for a in range(len(own)):
        for i in range(size):
            row = {a * size + j: value for j, value in base[i].items()}
            if i < n:
                for b in range(len(own)):
                    if own[b, a]:
                        shift, place = Value(ca.SX(float(own[b, a])), float(own[b, a])), b * size + i
                        value = row[place] - shift if place in row else Value(-shift.expression, -shift.number)
                        row[place] = value
                        if value.is_zero:
                            del row[place]
            rows.append(row)
    return rows


def _groups(S: Array) -> list[list[int]]:
    """Return the strongly connected groups of states, each after those that its columns need."""
    if not len(S):
        return []
    count, label = connected_components(csr_matrix(S != 0), directed=True, connection="strong")
    members = [np.flatnonzero(label == index).tolist() for index in range(count)]
    needs = [
        {int(label[i]) for j in group for i in np.flatnonzero(S[:, j])} - {index} for index, group in enumerate(members)
    ]
    order: list[int] = []
    while len(order) < count:
        order.append(next(k for k in range(count) if k not in order and needs[k] <= set(order)))
    return [members[k] for k in order]


def _sparse(matrix: Array) -> ca.SX:
    return ca.SX(ca.sparsify(ca.DM(matrix))) if matrix.size else ca.SX(*matrix.shape)
