"""The regulator equations of Francis: where a plant has to be, and what has to drive it, to follow an exosystem.

Pi S = A Pi + B Gamma + P_d and C Pi + D Gamma = Q, continuous and discrete alike (Francis, "The linear multivariable
regulator problem", SIAM J. Control Optim. 15, 1977). On x = Pi w, driven by u = Gamma w, the error is zero.
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigvals, expm, lu_factor, lu_solve, matrix_balance, schur
from scipy.sparse import csr_matrix

from .analysis import Linearisation
from .components import matrix_of, seconds
from .design import Gain, closed_loop_eigenvalues, digits_of
from .errors import ModelError
from .exosystems import Exosystem, parts_of, time_text

Array = NDArray[Any]

SOLVABLE = 1.0e-9
"""Relative residual below which equations that have no unique solution, or none for all right-hand sides, are solved."""

LARGEST_DENSE = 2000
"""Rows of the Kronecker matrix beyond which it is not formed."""

NEAR = 0.02
"""A transmission zero within this share of the rate of an exosystem's mode (at least 1 rad/s) is a near-failure."""

NEAR_RANK = 1.0e-3
"""The same of the least singular value of the pencil, where the plant is not square and has no such distance."""

DUST = 1.0e-13
"""Elements of Pi and Gamma that move the equations by less than this share of their largest term are zero."""


class RegulatorError(ModelError):
    """Regulator equations without a solution, or a gain that does not stabilise: the sentence has the numbers."""


@dataclass(frozen=True, eq=False)
class LinearModel:
    """A linear plant with measured disturbances: x+ = A x + B u + E d, y = C x + D u + F d, y being regulated.

    Attributes
    ----------
    A, B, C, D : ndarray
        (n, n), (n, p), (m, n) and (m, p).
    E, F : ndarray
        (n, disturbances) and (m, disturbances).
    dt : float or None
        Seconds per step; None for a continuous plant.
    states, inputs, outputs, disturbances : tuple of str
        Labels.
    name : str
        To complain about.
    """

    A: Array
    B: Array
    C: Array
    D: Array
    E: Array
    F: Array
    dt: float | None
    states: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    disturbances: tuple[str, ...]
    name: str = "the plant"

    def sampled(self, dt: float, method: str = "exact") -> LinearModel:
        """Return the discrete model of a continuous one, inputs and disturbances held: exactly, or I + dt A ("euler")."""
        if self.dt is not None or method not in ("exact", "euler"):
            raise ModelError(
                f"{self.name}: it is {time_text(self.dt)} and the method is {method!r}; sample a continuous model by "
                "'exact' or 'euler'"
            )
        step, n, p = seconds(self.name, dt), len(self.A), self.B.shape[1]
        driven = np.hstack([self.B, self.E])
        if method == "euler":
            A, driven = np.eye(n) + step * self.A, step * driven
        else:
            whole = np.zeros((n + driven.shape[1],) * 2)
            whole[:n, :n], whole[:n, n:] = self.A, driven
            power = expm(step * whole)
            A, driven = power[:n, :n], power[:n, n:]
        labels = self.states, self.inputs, self.outputs, self.disturbances
        return LinearModel(A, driven[:, :p], self.C, self.D, driven[:, p:], self.F, step, *labels, self.name)


def linear_model(
    A: Any, B: Any, C: Any, D: Any = None, *, E: Any = None, F: Any = None, dt: float | None = None, name: str = ""
) -> LinearModel:
    """Return a `LinearModel` of matrices; labels are x_0 .., u_0 .., y_0 .. and d_0 ...

    Raises
    ------
    ModelError
        If shapes do not match (the sentence names them), or a number is not finite.
    """
    owner = name or "the plant"
    a = matrix_of(owner, "A", A)
    n = len(a) if a.size else 0
    a = a.reshape(n, n) if n == 0 else a
    b = _shaped(owner, "B", B, (n, None))
    c = _shaped(owner, "C", C, (None, n))
    p, m = b.shape[1], len(c)
    d = np.zeros((m, p)) if D is None else _shaped(owner, "D", D, (m, p))
    e = np.zeros((n, 0)) if E is None else _shaped(owner, "E", E, (n, None))
    f = np.zeros((m, e.shape[1])) if F is None else _shaped(owner, "F", F, (m, e.shape[1]))
    if a.shape != (n, n):
        raise ModelError(f"{owner}: A has shape {a.shape}; give a square matrix")
    x, u, y, w = (tuple(f"{letter}_{k}" for k in range(size)) for letter, size in zip("xuyd", (n, p, m, e.shape[1])))
    return LinearModel(a, b, c, d, e, f, None if dt is None else seconds(owner, dt), x, u, y, w, owner)


def _shaped(owner: str, what: str, given: Any, shape: tuple[int | None, int | None]) -> Array:
    """Return a matrix of the shape that A, B or C ask for; an empty one may be of any shape."""
    matrix = matrix_of(owner, what, given)
    wanted = tuple(0 if matrix.size == 0 and item is None else item for item in shape)
    if matrix.size == 0:
        matrix = matrix.reshape(tuple(item or 0 for item in wanted))
    told = " x ".join("any" if item is None else str(item) for item in shape)
    if any(item is not None and item != size for item, size in zip(wanted, matrix.shape, strict=True)):
        raise ModelError(f"{owner}: {what} has shape {matrix.shape}, and the other matrices ask for {told}")
    return matrix


def regulated(model: Any, exosystem: Exosystem) -> tuple[LinearModel, Array, Array]:
    """Return (the plant as its exosystem meets it, Q, P_d): outputs with a reference, inputs that are disturbances.

    A signal of the exosystem that is named like an output of the plant, or like a state, is its reference; one that is
    named like an input of the plant is a measured disturbance, and no longer an input to act with.

    Parameters
    ----------
    model : Linearisation, LinearModel or control.StateSpace
        The plant near an operating point.
    exosystem : Exosystem
        Of the same time base.

    Returns
    -------
    LinearModel
        Its outputs in the order of the exosystem's signals.
    ndarray, shape (m, r)
        Q, less what disturbances do to the outputs.
    ndarray, shape (n, r)
        P_d.

    Raises
    ------
    ModelError
        If a name is not known to the plant, or the time bases differ.
    """
    plant = model if isinstance(model, LinearModel) else model_of(model)
    if plant.dt != exosystem.dt:
        raise ModelError(
            f"{plant.name} is {time_text(plant.dt)} and the exosystem of {', '.join(exosystem.signals) or 'nothing'} is "
            f"{time_text(exosystem.dt)}; sample both with one dt"
        )
    references = [name for name in exosystem.signals if name in plant.outputs or name in plant.states]
    acting = {*plant.inputs, *plant.disturbances} - set(references)
    unknown = [name for name in exosystem.signals if name not in references and name not in acting]
    if unknown:
        raise ModelError(
            f"{plant.name}: the exosystem generates {', '.join(unknown)}, neither an output nor an input of the plant; it has "
            f"{', '.join((*plant.outputs, *plant.states, *plant.inputs, *plant.disturbances))}"
        )
    n, r = len(plant.A), exosystem.order
    rows, drives = list(plant.outputs), [*plant.inputs, *plant.disturbances]
    C = np.vstack([np.zeros((0, n)), *[_row(plant.C, rows, plant.states, name) for name in references]])
    through, nothing = np.hstack([plant.D, plant.F]), np.zeros(len(drives))
    direct = [through[rows.index(name)] if name in rows else nothing for name in references]
    thrust = np.vstack([np.zeros((0, len(drives))), *direct])
    disturbing = [name for name in exosystem.signals if name not in references]
    away = [drives.index(name) for name in disturbing]
    kept = [k for k in range(len(plant.inputs)) if k not in away]
    driven = np.hstack([plant.B, plant.E])
    Q_dis = exosystem.output[[exosystem.signals.index(name) for name in disturbing]].reshape(len(disturbing), r)
    Q = exosystem.output[[exosystem.signals.index(name) for name in references]].reshape(len(references), r)
    E, F = driven[:, away], thrust[:, away]
    view = LinearModel(
        plant.A, driven[:, kept], C, thrust[:, kept], E, F, plant.dt, plant.states,
        tuple(plant.inputs[k] for k in kept), tuple(references), tuple(disturbing), plant.name,
    )  # fmt: skip
    return view, Q - F @ Q_dis, E @ Q_dis


def _row(C: Array, outputs: Sequence[str], states: Sequence[str], name: str) -> Array:
    return np.asarray(C[outputs.index(name)] if name in outputs else np.eye(len(states))[states.index(name)])


def model_of(given: Any) -> LinearModel:
    """Return the `LinearModel` of a Linearisation or a control.StateSpace, with its labels."""
    if isinstance(given, Linearisation):
        dt, name, labels = given.dt, given.plant.name, (given.states, given.inputs, given.outputs)
    elif all(hasattr(given, item) for item in ("A", "B", "C", "D", "dt", "state_labels")):
        if given.dt is True:
            raise ModelError(f"{given.name}: the discrete system has no numeric time step; give it one")
        dt, name = None if given.dt in (0, None) else float(given.dt), str(given.name)
        labels = tuple(given.state_labels), tuple(given.input_labels), tuple(given.output_labels)
    else:
        raise ModelError(
            f"the regulator equations are for a linear plant, and {type(given).__name__} is given; give linearise(plant, "
            "point), linear_model(A, B, C) or a control.StateSpace"
        )
    made = linear_model(given.A, given.B, given.C, given.D, dt=dt, name=name)
    return LinearModel(made.A, made.B, made.C, made.D, made.E, made.F, dt, *labels, (), name)


# -- solvability ------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class ModeSolvability:
    """What the plant can do at one eigenvalue of an exosystem.

    Attributes
    ----------
    eigenvalue : complex
        Of S.
    rank, needed : int
        Rank of the Rosenbrock pencil [A - s I, B; C, D], and its n + m rows: with less, it is solvable for some
        references and disturbances only. It is that of the pencil with rows and columns brought to one size, so that it does
        not depend on units.
    sigma : float
        The (n + m)-th singular value of the pencil as it stands, in its units; zero where p < m.
    distance : float
        To the nearest transmission zero of a square plant; infinite if there is none. The gains grow like its inverse. NaN
        where the plant is not square.
    """

    eigenvalue: complex
    rank: int
    needed: int
    sigma: float
    distance: float


def solvability(model: Any, exosystem: Exosystem) -> tuple[ModeSolvability, ...]:
    """Return, for each distinct eigenvalue of an exosystem, whether the equations are solvable for all right-hand sides.

    Parameters
    ----------
    model : Linearisation, LinearModel or control.StateSpace
        The plant.
    exosystem : Exosystem
        Of the same time base.

    Returns
    -------
    tuple of ModeSolvability
        Full rank at every one of them: no transmission zero of the plant is an eigenvalue of the exosystem (Hautus
        1983; Huang, "Nonlinear Output Regulation", 2004, theorem 1.9).
    """
    view, _, _ = regulated(model, exosystem)
    return _modes(view, exosystem.eigenvalues)


def _modes(plant: LinearModel, eigenvalues: Array) -> tuple[ModeSolvability, ...]:
    needed, zeros = len(plant.A) + len(plant.C), transmission_zeros(plant)
    answer = []
    for value in _distinct(eigenvalues):
        pencil = _pencil(plant, value)
        sizes = np.linalg.svd(pencil, compute_uv=False)
        sigma = float(sizes[needed - 1]) if 0 < needed <= len(sizes) else 0.0
        near = math.nan if zeros is None else float(np.min(np.abs(zeros - value), initial=math.inf))
        answer.append(ModeSolvability(complex(value), _rank(pencil), needed, sigma, near))
    return tuple(answer)


def _rank(matrix: Array) -> int:
    """Return the numeric rank, which depends on no unit of a row or a column."""
    rows, columns = _scales(matrix)
    sizes = np.linalg.svd(rows[:, None] * matrix * columns, compute_uv=False)
    return int(np.sum(sizes > max(matrix.shape) * np.finfo(float).eps * np.max(sizes, initial=0.0)))


def _scales(matrix: Array) -> tuple[Array, Array]:
    """Return factors of rows and columns, powers of two, that bring the largest element of each near one (Ruiz 2001)."""
    size, rows, columns = np.abs(matrix), np.ones(matrix.shape[0]), np.ones(matrix.shape[1])
    for _ in range(12):  # by the square root each time: the error of the exponent halves
        now = rows[:, None] * size * columns
        for factors, axis in ((rows, 1), (columns, 0)):
            top = np.max(now, axis=axis, initial=0.0)
            factors /= np.sqrt(np.where(top > 0, top, 1.0))
    return np.exp2(np.round(np.log2(rows))), np.exp2(np.round(np.log2(columns)))


def transmission_zeros(plant: LinearModel) -> Array | None:
    """Return the finite transmission zeros of a square plant, or None where it is not square (or has too few inputs).

    Generalised eigenvalues of the Rosenbrock pencil (Laub and Moore 1978). Those at infinity come out large, as rounding
    leaves them; they are dropped where they are beyond 1e3 times the size of A.
    """
    n, m = len(plant.A), len(plant.C)
    if m != plant.B.shape[1]:
        return None
    if not n + m:
        return np.zeros(0, dtype=complex)
    right = np.zeros((n + m, n + m))
    right[:n, :n] = np.eye(n)
    pencil = np.block([[plant.A, plant.B], [plant.C, plant.D]])
    rows, columns = _scales(np.abs(pencil) + right)  # which moves no eigenvalue of the pair
    scaled = [rows[:, None] * item * columns for item in (pencil, right)]
    above, below = eigvals(*scaled, homogeneous_eigvals=True)
    small = np.abs(below) <= 1e-8 * np.maximum(np.abs(above), np.abs(below))
    values = above[~small] / below[~small]
    largest = float(np.linalg.norm(matrix_balance(plant.A)[0], 2)) if n else 1.0
    return np.asarray(values[np.abs(values) < 1e3 * max(1.0, largest)])


def _pencil(plant: LinearModel, value: complex) -> Array:
    shifted = plant.A - value * np.eye(len(plant.A))
    own = np.diag(shifted)
    dust = np.abs(own) <= 4 * np.finfo(float).eps * abs(value)  # what scaling would take for an element
    shifted[dust, dust] = 0.0
    pencil = np.block([[shifted, plant.B], [plant.C, plant.D]])
    return np.asarray(pencil.real if value.imag == 0 else pencil)


def _distinct(values: Array) -> list[complex]:
    """Return values that differ beyond rounding, in the order in which they come; of a conjugate pair the upper one."""
    answer: list[complex] = []
    for value in values:
        value = complex(value.real, abs(value.imag))
        value = value if abs(value.imag) > 1e-15 * abs(value) else complex(value.real, 0.0)
        if all(abs(value - other) > 1e-14 * max(1.0, abs(other)) for other in answer):
            answer.append(value)
    return answer


# -- the equations ----------------------------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class RegulatorSolution:
    """Pi and Gamma, and how good they are.

    Attributes
    ----------
    state_map : ndarray, shape (n, r)
        Pi: on x = x* + Pi w the error is zero.
    input_map : ndarray, shape (p, r)
        Gamma: u = u* + Gamma w keeps it there.
    rank, rows : int
        Rank of the equations, and how many there are: (n + m) r.
    singular_ratio : float
        Smallest over largest singular value of the matrix of the equations; with the triangular solver of the pencils on
        its diagonal.
    residual : float
        norm(M z - rhs) / norm(rhs), the largest over the parts of the exosystem that have nothing to do with each other; where a
        part has full rank, and so a solution, / max(1, norm(rhs)). What is below 1e-13 of the whole right-hand side is of that;
        and where units differ so much that the norm is that of one row, it is that of rows brought to one size. Beside this no
        single equation may be left with more than 1e-9 of its own terms, however large the others are.
    modes : tuple of ModeSolvability
        For each distinct eigenvalue of the exosystem.
    warnings : tuple of str
        Sentences: modes that decay or grow, a transmission zero nearby, a solution that is not unique.
    solver : str
        "kronecker" or "schur".
    model : LinearModel
        The plant as the exosystem meets it.
    exosystem : Exosystem
    reference, disturbance : ndarray
        Q (m, r) and P_d (n, r).
    """

    state_map: Array
    input_map: Array
    rank: int
    rows: int
    singular_ratio: float
    residual: float
    modes: tuple[ModeSolvability, ...]
    warnings: tuple[str, ...]
    solver: str
    model: LinearModel = field(repr=False)
    exosystem: Exosystem = field(repr=False)
    reference: Array = field(repr=False)
    disturbance: Array = field(repr=False)

    def rounded(self) -> dict[str, Array]:
        """Return Pi and Gamma rounded to 9 digits, as they go into `design.json`, without what is but rounding.

        What that is depends on no unit: it is judged by what an element moves in the equations of its part of the exosystem.
        """
        view, S, n = self.model, self.exosystem.matrix, len(self.state_map)
        pencil, rows = np.abs(_pencil(view, 0.0)), _scales(_pencil(view, 0.0))[0]
        z, right = np.vstack([self.state_map, self.input_map]), np.abs(np.vstack([self.disturbance, self.reference]))
        right = rows[:, None] * right
        for part in parts_of(S):
            moved = np.linalg.norm(rows[:, None] * pencil, axis=0)
            moved[:n] += rows[:n] * float(np.max(np.abs(S[np.ix_(part, part)]), initial=0.0))
            terms = moved[:, None] * np.abs(z[:, part])
            largest = max(float(np.max(item, initial=0.0)) for item in (terms, right[:, part]))
            z[:, part] = np.where(terms < DUST * largest, 0.0, z[:, part])
        return {"state_map": _rounded(z[:n]), "input_map": _rounded(z[n:])}

    def source(self) -> str:
        """Return a hash of what was asked for: same question, same hash, on any machine."""
        view = self.model
        parts = [view.dt, *[digits_of(item) for item in (view.A, view.B, view.C, view.D)]]
        parts += [digits_of(item) for item in (self.exosystem.matrix, self.reference, self.disturbance)]
        return hashlib.sha256(repr(parts).encode()).hexdigest()[:16]

    def properties(self, values: Mapping[str, Any] | None = None) -> dict[str, tuple[float, float]]:
        """Return what Pi and Gamma have to fulfil: name -> (measured, largest accepted).

        Parameters
        ----------
        values : dict, optional
            Other maps for the same question, such as those of a `design.json`. Default: these, rounded to 9 digits, which
            moves the equations by 5e-9 of their own terms; four times that is accepted.
        """
        given = self.rounded() if values is None else values
        Pi = np.asarray(given["state_map"], dtype=float).reshape(self.state_map.shape)
        Gamma = np.asarray(given["input_map"], dtype=float).reshape(self.input_map.shape)
        view, S, shares = self.model, self.exosystem.matrix, [0.0]
        for part in parts_of(S):  # each by itself: a large disturbance hides nothing of a small reference
            own = S[np.ix_(part, part)], self.reference[:, part], self.disturbance[:, part]
            shares.append(worst_share(view, *own, Pi[:, part], Gamma[:, part]))
        share = float(np.max(shares))  # NaN where one is
        return {"residual of the regulator equations, of their terms": (share, 2e-8)}


def francis(model: Any, exosystem: Exosystem, *, solver: str | None = None) -> RegulatorSolution:
    """Solve the regulator equations Pi S = A Pi + B Gamma + P_d, C Pi + D Gamma = Q.

    Parameters
    ----------
    model : Linearisation, LinearModel or control.StateSpace
        The plant; signals of the exosystem named like one of its outputs (or states) are references, those named like
        one of its inputs measured disturbances.
    exosystem : Exosystem
        Of the same time base, which is part of both.
    solver : {"kronecker", "schur"}, optional
        The Kronecker matrix of each part of S that has nothing to do with the others; or the columns of such a part one
        after another, S being triangular, or made so by a Schur decomposition: r solves with the (n + m) x (n + m) pencil.
        Default: the latter where the plant is square and every pencil has full rank.

    Returns
    -------
    RegulatorSolution
        With more inputs than references the one of least norm.

    Raises
    ------
    RegulatorError
        If there is no solution: the eigenvalue at which the pencil has too small a rank, that rank, and the residual that
        least squares leaves.
    ModelError
        If names, shapes or time bases do not match, or the Kronecker matrix of a part would have more than 2000 rows.

    Examples
    --------
    >>> from plantc.symbolic.exosystems import harmonic
    >>> from plantc.symbolic.regulator_equations import francis, linear_model
    >>> cart = linear_model([[0, 1], [0, 0]], [[0], [1]], [[1, 0]])
    >>> francis(cart, harmonic("y_0", 2.0)).input_map.round(9)
    array([[-4.,  0.]])
    """
    view, Q, P = regulated(model, exosystem)
    S, n, p = exosystem.matrix, len(view.A), view.B.shape[1]
    modes = _modes(view, exosystem.eigenvalues)
    full = p == len(view.C) and all(mode.rank == mode.needed for mode in modes)
    chosen = solver or ("schur" if full else "kronecker")
    if chosen not in ("kronecker", "schur"):
        raise ModelError(f"{view.name}: the solver {chosen!r} is not known; take 'kronecker' or 'schur'")
    if chosen == "schur" and not full:
        raise ModelError(
            f"{view.name}: the triangular solver needs as many inputs as references ({p} and {len(view.C)}) and full rank "
            f"at every eigenvalue ({_worst_text(modes)}); take solver='kronecker'"
        )
    Pi, Gamma, rank, ratios = np.zeros((n, exosystem.order)), np.zeros((p, exosystem.order)), 0, []
    residuals, rows = [0.0], n + len(view.C)
    largest = float(np.linalg.norm(np.vstack([P, Q])))
    factors: dict[complex, Any] = {}
    for part in parts_of(S):
        own = S[np.ix_(part, part)], Q[:, part], P[:, part]
        if chosen == "schur":
            z, found, sizes = _by_columns(view, *own, factors)
        else:
            z, found, sizes = _by_kronecker(view, *own)
        Pi[:, part], Gamma[:, part] = z[:n], z[n:]
        rank += found
        ratios.append(sizes)
        residuals.append(_judged(view, *own, z, found == rows * len(part), largest))
    rows, residual = rows * exosystem.order, float(np.max(residuals))  # NaN where one is
    if not residual < SOLVABLE:
        raise RegulatorError(_unsolvable(view, modes, rank, rows, residual))
    least = min((item[0] for item in ratios), default=0.0)
    most = max((item[1] for item in ratios), default=0.0)
    return RegulatorSolution(
        _frozen(Pi), _frozen(Gamma), rank, rows, least / most if most else math.nan, residual, modes,
        _warnings(view, exosystem, modes, rank, (n + p) * exosystem.order), chosen, view, exosystem, Q, P,
    )  # fmt: skip


def _judged(view: LinearModel, S: Array, Q: Array, P: Array, z: Array, full: bool, largest: float) -> float:
    """Return the relative residual of one part, at least `SOLVABLE` where an equation is not solved."""
    n, right = len(view.A), np.vstack([P, Q])
    left = np.vstack(_residuals(view, S, Q, P, z[:n], z[n:]))
    size, asked = float(np.linalg.norm(left)), float(np.linalg.norm(right))
    if full:
        asked = max(1.0, asked)
    elif asked < DUST * largest:  # a right-hand side that is rounding next to the others is none
        return size / largest
    relative = size / asked if asked else size
    if not relative < SOLVABLE:
        rows = _scales(_pencil(view, 0.0))[0][:, None]
        other = float(np.linalg.norm(rows * left)) / max(float(np.linalg.norm(rows * right)), 1e-300)
        if not other < SOLVABLE:
            return relative
        relative = other  # it was rounding, in a row of large numbers
    share = worst_share(view, S, Q, P, z[:n], z[n:])
    return relative if share < SOLVABLE else share


def worst_share(view: LinearModel, S: Array, Q: Array, P: Array, Pi: Array, Gamma: Array) -> float:
    """Return what is left of an equation (a row, over the states of one part), of its own terms; the worst of all.

    A row is an equation in one unit. Those whose terms are below 1e-13 of the largest, rows brought to one size, are rounding.
    """
    left = np.vstack(_residuals(view, S, Q, P, Pi, Gamma))
    upper = np.abs(Pi) @ np.abs(S) + np.abs(view.A) @ np.abs(Pi) + np.abs(view.B) @ np.abs(Gamma)
    lower = np.abs(view.C) @ np.abs(Pi) + np.abs(view.D) @ np.abs(Gamma)
    terms = np.linalg.norm(np.vstack([upper + np.abs(P), lower + np.abs(Q)]), axis=1)
    scaled = _scales(_pencil(view, 0.0))[0] * terms
    judged = ~(scaled <= DUST * np.max(scaled, initial=0.0))
    shares = np.linalg.norm(left, axis=1)[judged] / terms[judged]
    return float(np.max(shares, initial=0.0))  # NaN where one is


def _by_kronecker(view: LinearModel, S: Array, Q: Array, P: Array) -> tuple[Array, int, tuple[float, float]]:
    """Return ([Pi; Gamma], rank, (least, largest singular value)) of one part: of least norm, or least squares."""
    (n, p), m, r = view.B.shape, len(view.C), len(S)
    if (n + m) * r > LARGEST_DENSE or (n + p) * r > LARGEST_DENSE:
        raise ModelError(
            f"{view.name}: the Kronecker matrix of a part with {r} exosystem states has {(n + m) * r} rows, more than "
            f"{LARGEST_DENSE}; take solver='schur', or an exosystem of smaller parts"
        )
    eye = np.eye(r)
    M = np.block(
        [
            [np.kron(eye, view.A) - np.kron(S.T, np.eye(n)), np.kron(eye, view.B)],
            [np.kron(eye, view.C), np.kron(eye, view.D)],
        ]
    )
    right = np.concatenate([-P.ravel(order="F"), Q.ravel(order="F")])
    z, rank = _least_norm(M, right)
    scales = _scales(M)[0]
    left, asked = (float(np.linalg.norm(scales * item)) for item in (M @ z - right, right))
    if rank < len(M) and not left < SOLVABLE * asked:
        z = np.linalg.lstsq(M, right, rcond=max(M.shape) * np.finfo(float).eps)[0]  # in the units as they are
    sizes = np.linalg.svd(M, compute_uv=False)
    answer = np.vstack([z[: n * r].reshape(r, n).T, z[n * r :].reshape(r, p).T])
    # with fewer columns than rows the least singular value of interest is still the last there is
    return answer, rank, (float(np.min(sizes, initial=math.inf)), float(np.max(sizes, initial=0.0)))


def _least_norm(M: Array, right: Array) -> tuple[Array, int]:
    """Return the solution of least norm of M z = right, if there is one, and the rank of M, which depends on no unit."""
    rows, columns = _scales(M)
    left, sizes, across = np.linalg.svd(rows[:, None] * M * columns)
    kept = sizes > max(M.shape) * np.finfo(float).eps * np.max(sizes, initial=0.0)
    rank = int(np.sum(kept))
    z = np.zeros(M.shape[1])
    for _ in range(2):  # once more on what is left: small rows are then solved as well as large ones
        parts = left[:, :rank].T @ (rows * (right - M @ z)) / sizes[:rank]
        z = z + columns * (across[:rank].T @ parts)
    if rank < M.shape[1]:  # the scales have moved what is least
        free = np.linalg.qr(columns[:, None] * across[rank:].T)[0]
        z = z - free @ (free.T @ z)
    return z, rank


def _by_columns(
    view: LinearModel, S: Array, Q: Array, P: Array, factors: dict[complex, Any]
) -> tuple[Array, int, tuple[float, float]]:
    """Return the same of a part by columns of its triangular form; `factors` keeps pencils that were factorised."""
    n, r = len(view.A), len(S)
    right = np.vstack([-P, Q])
    order = _triangular_order(S)
    if order is not None:
        T, V = S[np.ix_(order, order)], np.eye(r)[:, order]
    else:
        T, V = schur(S, output="complex")
    right = right @ V
    z = np.zeros(right.shape, dtype=T.dtype)
    ends = []
    for j in range(r):
        value = complex(T[j, j])
        if value not in factors:
            factors[value] = _Factors.of(_pencil(view, value))
        column = right[:, j].astype(z.dtype)
        column[:n] += z[:n, :j] @ T[:j, j]
        z[:, j] = factors[value].solve(column) if len(column) else column
        ends.append(factors[value].sizes)
    answer = z @ V.conj().T
    return answer.real, len(right) * r, (min(item[0] for item in ends), max(item[1] for item in ends))


@dataclass(frozen=True, eq=False)
class _Factors:
    """A pencil that was factorised, rows and columns brought to one size."""

    matrix: Array
    rows: Array
    columns: Array
    lu: Any
    sizes: tuple[float, float]

    @classmethod
    def of(cls, pencil: Array) -> _Factors:
        """Factorise a square matrix of full rank."""
        (rows, columns), sizes = _scales(pencil), np.linalg.svd(pencil, compute_uv=False)
        ends = (float(sizes[-1]), float(sizes[0])) if len(sizes) else (math.inf, 0.0)
        return cls(pencil, rows, columns, lu_factor(rows[:, None] * pencil * columns), ends)

    def solve(self, right: Array) -> Array:
        """Solve, and once more for what is left: small rows are then solved as well as large ones (Skeel 1980)."""
        first = self.columns * lu_solve(self.lu, self.rows * right)
        return np.asarray(first + self.columns * lu_solve(self.lu, self.rows * (right - self.matrix @ first)))


def _triangular_order(S: Array) -> list[int] | None:
    """Return an order of the states in which S is upper triangular, or None."""
    left, order = list(range(len(S))), []
    while left:
        free = next((j for j in left if not any(S[i, j] for i in left if i != j)), None)
        if free is None:
            return None
        order.append(free)
        left.remove(free)
    return order


def _residuals(view: LinearModel, S: Array, Q: Array, P: Array, Pi: Array, Gamma: Array) -> tuple[Array, Array]:
    moved = (csr_matrix(S.T) @ Pi.T).T if len(S) else Pi @ S  # S has many zeros
    return view.A @ Pi + view.B @ Gamma + P - moved, view.C @ Pi + view.D @ Gamma - Q


def _worst_text(modes: Sequence[ModeSolvability]) -> str:
    """Return the eigenvalue at which most rank is missing, in words."""
    if not modes:
        return "it has none"
    worst = min(modes, key=lambda mode: (mode.rank - mode.needed, mode.sigma))
    return f"at {_number(worst.eigenvalue)} the rank is {worst.rank} of {worst.needed}"


def _unsolvable(view: LinearModel, modes: Sequence[ModeSolvability], rank: int, rows: int, residual: float) -> str:
    if all(mode.rank == mode.needed for mode in modes):  # a solution, which is lost in rounding
        least = min((mode.sigma for mode in modes), default=math.nan)
        return (
            f"{view.name}: the regulator equations have a solution that is too large to be computed: the exosystem is so near "
            f"a transmission zero of the plant (least singular value {least:.3g}, {_worst_text(modes)}) that rounding leaves a "
            f"relative residual of {residual:.8g}; regulate another output, or take another exosystem"
        )
    few = view.B.shape[1] < len(view.C)
    cause = (
        f"{view.B.shape[1]} input(s) act on {len(view.C)} regulated output(s)"
        if few
        else "a transmission zero of the plant is an eigenvalue of the exosystem"
    )
    advice = "add an input, or regulate less" if few else "regulate another output, or take another exosystem"
    return (
        f"{view.name}: the regulator equations have no solution: {cause} ({_worst_text(modes)}; rank of the equations {rank} "
        f"of {rows}, relative residual {residual:.8g}); {advice}"
    )


def _warnings(
    view: LinearModel, exosystem: Exosystem, modes: Sequence[ModeSolvability], rank: int, unknowns: int
) -> tuple[str, ...]:
    """Return what is worth knowing of a solution."""
    said = []
    if rank < unknowns:
        said.append(f"{unknowns - rank} of {unknowns} numbers are free; the solution of least norm is taken")
    decaying = [mode for mode in modes if _growth(mode.eigenvalue, view.dt) < -1e-9]
    growing = [mode for mode in modes if _growth(mode.eigenvalue, view.dt) > 1e-9]
    if decaying:
        said.append(
            f"the exosystem decays at {_numbers(decaying)}: what it generates goes to zero by itself, and following it is "
            "no achievement"
        )
    if growing:
        said.append(f"the exosystem grows at {_numbers(growing)}: what it generates leaves every range")
    for mode in modes:
        rate = mode.eigenvalue if view.dt is None else (mode.eigenvalue - 1) / view.dt
        far = mode.distance if view.dt is None else mode.distance / view.dt
        if mode.rank < mode.needed:
            said.append(
                f"at the eigenvalue {_number(mode.eigenvalue)} the rank is {mode.rank} of {mode.needed}: solved for these "
                "references and disturbances, not for all"
            )
        elif far < NEAR * max(1.0, abs(rate)):
            said.append(
                f"a transmission zero is {mode.distance:.3g} from the eigenvalue {_number(mode.eigenvalue)} (least singular "
                f"value {mode.sigma:.3g}): gains grow like the inverse of that distance"
            )
        elif math.isnan(far) and mode.sigma / (view.dt or 1.0) < NEAR_RANK * max(1.0, abs(rate)):
            said.append(
                f"at the eigenvalue {_number(mode.eigenvalue)} the least singular value is {mode.sigma:.3g}: the rank is nearly "
                "lost, and gains grow like the inverse of that"
            )
    return tuple(said)


def _growth(value: complex, dt: float | None) -> float:
    return value.real if dt is None else abs(value) - 1.0


# -- the closed loop --------------------------------------------------------------------------------------------------


def closed_loop(model: Any, gain: Gain | Any, *, accept_unstable: bool = False) -> Array:
    """Return the eigenvalues of A - B K, with which the error of a regulator decays; refuse a K that does not stabilise.

    Parameters
    ----------
    model : Linearisation, LinearModel or control.StateSpace
        The plant; of its inputs only those that act, so give what `francis` calls `solution.model` if some are measured
        disturbances.
    gain : Gain, or (inputs, n) array
        K of u = u* - K (x - x*). A paper that writes u = K (x - Pi w) has the other sign.
    accept_unstable : bool
        Whether it is accepted all the same.

    Raises
    ------
    RegulatorError
        If A - B K is not stable; the sentence has the spectral radius, or the largest real part.
    """
    plant = model if isinstance(model, LinearModel) else model_of(model)
    K = gain.gain if isinstance(gain, Gain) else matrix_of(plant.name, "the gain", gain)
    if K.shape != plant.B.T.shape:
        raise ModelError(f"{plant.name}: the gain has shape {K.shape}, and B {plant.B.shape}; give inputs x states")
    values = closed_loop_eigenvalues(plant.A, plant.B, K)
    if plant.dt is None:
        measured, limit, what = float(np.max(values.real, initial=-math.inf)), 0.0, "largest real part"
    else:
        measured, limit, what = float(np.max(np.abs(values), initial=0.0)), 1.0, "spectral radius"
    if not measured < limit and not accept_unstable:
        turned = closed_loop_eigenvalues(plant.A, plant.B, -K)
        other = np.max(turned.real if plant.dt is None else np.abs(turned))
        hint = "; -K would, so look at its sign" if other < limit else ""
        raise RegulatorError(
            f"{plant.name}: the gain does not stabilise the plant (A - B K has {what} {measured:.8g}, not below {limit:g})"
            f"{hint}; design another, or say accept_unstable=True"
        )
    return values


# -- text and numbers -------------------------------------------------------------------------------------------------


def _number(value: complex) -> str:
    return f"{value.real:.6g}" if value.imag == 0 else f"{value.real:.6g}+-{abs(value.imag):.6g}j"


def _numbers(modes: Sequence[ModeSolvability]) -> str:
    return ", ".join(_number(mode.eigenvalue) for mode in modes)


def _rounded(matrix: Array) -> Array:
    flat = [float(f"{item:.8e}") + 0.0 for item in matrix.ravel()]
    return np.array(flat, dtype=float).reshape(matrix.shape)


def _frozen(array: Array) -> Array:
    answer = np.array(array)
    answer.setflags(write=False)
    return answer
