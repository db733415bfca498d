"""The weights of a James-Stein estimator: as numbers at export, and as expressions where they change every step.

J. A. Meda-Campana, "On the Estimation and Control of Nonlinear Systems With Parametric Uncertainties and Noisy Outputs",
IEEE Access 2018, eqs. 20-25; J. H. Manton, V. Krishnamurthy, H. V. Poor, "James-Stein state filtering algorithms", IEEE
Trans. Signal Processing 46(9), 1998. A reading y = C x + Pi v, v ~ N(0, r^2 I), gives x_ML = L y, L = I_y^-1 C' W, with
W = (Pi Pi')^-1 and I_y = C' W C; the correction is s (x_ML - x-), s = (1 - r^2 c / D2)^+, c = (min(n - 2, 2 (n* - 2)))^+,
n* = tr(I_y^-1) / lambda_max(I_y^-1).
"""

from __future__ import annotations

import decimal
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from .errors import ModelError

Array = NDArray[Any]
Rows = list[list[Decimal]]

DIGITS = 100
"""Decimal digits in which constant weights are computed: after rounding to double they are the same on any machine."""

HIGHEST_CONDITION = 1.0e12
"""Condition of Pi^-1 C above which export warns."""

LEAST_PIVOT = 1.0e-12
"""Least squared part of a column of Pi^-1 C that its predecessors do not span, relative to the whole column; and least
pivot of the noise's shape. Below it a reading is refused where the weights are computed in C."""

SMALLEST_SQUARE = 1.0e-30
"""Least r^2, and least squared length of a column, that is divided by."""

BISECTIONS = 44
"""Trips of the bisection for the largest eigenvalue, relative to the trace: it is met to 2^-45."""


@dataclass(frozen=True)
class Weights:
    """Constant weights of a sensor with m rows, for n states, of rank k.

    Attributes
    ----------
    whiten : array (k, m)
        b = whiten (y - h(x-)); D2 = b' b.
    solve : array (n, k)
        x_ML - x- = solve b.
    effective_dimension : float
        n*.
    shrink : float
        c.
    """

    whiten: Array
    solve: Array
    effective_dimension: float
    shrink: float


def constant_weights(owner: str, sensor: str, C: Array, shape: Rows, *, reduce: bool = False) -> Weights:
    """Return the weights for a constant C (m, n) and a constant shape Pi Pi' (m, m) of the noise.

    Parameters
    ----------
    owner, sensor : str
        Names, for errors.
    C : array (m, n)
        Derivative of the reading by the state.
    shape : list of list of Decimal
        Pi Pi'.
    reduce : bool
        Whether a C of lower rank corrects in the subspace that it sees (no method of the paper).

    Raises
    ------
    ModelError
        If Pi Pi' is singular, or the rank of C is lower than n and `reduce` is false.
    """
    n = C.shape[1]
    with decimal.localcontext(decimal.Context(prec=DIGITS)):
        numbers = [[Decimal(float(item)) for item in row] for row in C]
        root = _cholesky(shape)
        if root is None:
            raise ModelError(
                f"{owner}: the noise of the sensor {sensor!r} has a singular shape Pi Pi'; give every row noise of its own"
            )
        whitened = _forward(root, numbers)
        rank, condition = _rank_and_condition(np.array([[float(item) for item in row] for row in whitened]))
        if rank < n and not reduce:
            raise ModelError(
                f"{owner}: the sensor {sensor!r} has rank {rank} and the state n = {n} elements, so that no state of maximum "
                "likelihood exists; let one sensor measure them all, or say rank_deficient='reduce'"
            )
        if rank == 0:
            raise ModelError(f"{owner}: the sensor {sensor!r} does not depend on the state; leave it out")
        if condition > HIGHEST_CONDITION:
            warnings.warn(
                f"{owner}: the sensor {sensor!r} hardly tells some states apart (condition {condition:.1e} of Pi^-1 C); "
                "scale the states or measure more",
                stacklevel=2,
            )
        information = _product(_transposed(whitened), whitened)
        columns = _independent(information, rank)
        own = [[information[i][j] for j in columns] for i in columns]
        basis = _cholesky(own)  # of the independent columns F: F'F = K K'
        assert basis is not None
        # Pi^-1 C = F G; G is the identity where the rank is full
        G = _solve(own, [information[i] for i in columns])
        chosen = [[row[j] for j in columns] for row in whitened]
        to_basis = _forward(basis, _transposed(chosen))  # K^-1 F'
        whiten = _transposed(_backward(root, _transposed(to_basis)))  # times Pi^-1
        inner = _product(G, _transposed(G))
        inverse_basis = _inverse(basis)
        solve = _product(_product(_transposed(G), _inverse(inner)), _transposed(inverse_basis))
        reduced = _product(_product(_transposed(basis), inner), basis)
        inverse = _inverse(reduced)
        trace = sum((inverse[i][i] for i in range(rank)), Decimal(0))
        largest = _largest([[item / trace for item in row] for row in inverse])
        effective = _rounded(min(1 / largest, Decimal(rank)))
        shrink = _rounded(max(Decimal(0), min(Decimal(rank - 2), 2 * (effective - 2))))
        return Weights(_floats(whiten), _floats(solve), float(effective), float(shrink))


def shape_of(shaping: Array) -> Rows:
    """Return Pi Pi' of a matrix of numbers, without rounding."""
    with decimal.localcontext(decimal.Context(prec=DIGITS)):
        rows = exact(shaping)
        return _product(rows, _transposed(rows))


def exact(matrix: Array) -> Rows:
    """Return a matrix of floats as decimal numbers, without rounding."""
    return [[Decimal(float(item)) for item in row] for row in np.atleast_2d(matrix)]


# -- decimal matrices -------------------------------------------------------------------------------------------------


def _rank_and_condition(matrix: Array) -> tuple[int, float]:
    """Return rank and condition, columns scaled to unit length first: units of states must not matter."""
    lengths = np.linalg.norm(matrix, axis=0)
    singular = np.linalg.svd(matrix / np.where(lengths > 0, lengths, 1.0), compute_uv=False)
    rank = int(np.sum(singular > max(matrix.shape) * np.finfo(float).eps * singular[0])) if singular[0] > 0 else 0
    plain = np.linalg.svd(matrix, compute_uv=False)[:rank]
    return rank, float(plain[0] / plain[-1]) if rank and plain[-1] > 0 else np.inf


def _transposed(matrix: Rows) -> Rows:
    return [list(column) for column in zip(*matrix, strict=True)]


def _product(first: Rows, second: Rows) -> Rows:
    columns = _transposed(second)
    return [[sum((a * b for a, b in zip(row, column, strict=True)), Decimal(0)) for column in columns] for row in first]


def _cholesky(matrix: Rows) -> Rows | None:
    """Return the lower factor, or None if a pivot is not positive beyond rounding."""
    n = len(matrix)
    factor = [[Decimal(0)] * n for _ in range(n)]
    for i in range(n):
        for j in range(i + 1):
            value = matrix[i][j] - sum((factor[i][k] * factor[j][k] for k in range(j)), Decimal(0))
            if i > j:
                factor[i][j] = value / factor[j][j]
            elif value <= abs(matrix[i][i]) * Decimal("1e-40"):
                return None
            else:
                factor[i][i] = value.sqrt()
    return factor


def _forward(factor: Rows, right: Rows) -> Rows:
    """Return factor^-1 right, the factor lower triangular."""
    answer: Rows = []
    for i, row in enumerate(right):
        value = [item - sum((factor[i][k] * answer[k][c] for k in range(i)), Decimal(0)) for c, item in enumerate(row)]
        answer.append([item / factor[i][i] for item in value])
    return answer


def _backward(factor: Rows, right: Rows) -> Rows:
    """Return factor'^-1 right, the factor lower triangular."""
    flipped = [list(reversed(row)) for row in reversed(_transposed(factor))]
    return list(reversed(_forward(flipped, list(reversed(right)))))


def _solve(matrix: Rows, right: Rows) -> Rows:
    factor = _cholesky(matrix)
    assert factor is not None
    return _backward(factor, _forward(factor, right))


def _inverse(matrix: Rows) -> Rows:
    """Return the inverse of a lower triangular or a symmetric definite matrix."""
    n = len(matrix)
    identity = [[Decimal(int(i == j)) for j in range(n)] for i in range(n)]
    if all(matrix[i][j] == 0 for i in range(n) for j in range(i + 1, n)):
        return _forward(matrix, identity)
    return _solve(matrix, identity)


def _independent(information: Rows, rank: int) -> list[int]:
    """Return `rank` columns that span what all span: greedily, the longest remainder first, relative to its column."""
    n = len(information)
    if rank == n:
        return list(range(n))
    left = [row[:] for row in information]
    chosen: list[int] = []
    for _ in range(rank):
        share = {j: left[j][j] / information[j][j] for j in range(n) if j not in chosen and information[j][j] > 0}
        pivot = max(share, key=lambda j: (share[j], -j))
        chosen.append(pivot)
        row = left[pivot]
        left = [[left[i][j] - left[i][pivot] * row[j] / row[pivot] for j in range(n)] for i in range(n)]
    return sorted(chosen)


def _largest(matrix: Rows) -> Decimal:
    """Return the largest eigenvalue of a symmetric positive matrix of trace 1, by bisection on definiteness."""
    n = len(matrix)
    low, high = 1 / Decimal(n), Decimal(1)
    for _ in range(100):
        middle = (low + high) / 2
        shifted = [[(middle if i == j else Decimal(0)) - matrix[i][j] for j in range(n)] for i in range(n)]
        if _is_definite(shifted):
            high = middle
        else:
            low = middle
    return (low + high) / 2


def _is_definite(matrix: Rows) -> bool:
    left, n = [row[:] for row in matrix], len(matrix)
    for k in range(n):
        if left[k][k] <= 0:
            return False
        for i in range(k + 1, n):
            factor = left[i][k] / left[k][k]
            for j in range(k + 1, i + 1):
                left[i][j] -= factor * left[j][k]
    return True


def _rounded(value: Decimal) -> Decimal:
    """Return a number without what bisection leaves: 12, not 11.99999999999999999999999."""
    return value.quantize(Decimal("1e-25"))


def _floats(matrix: Rows) -> Array:
    """Return the nearest doubles; what is nothing but rounding beside the largest element is zero."""
    largest = max(abs(item) for row in matrix for item in row)
    least = largest * Decimal("1e-40")
    return np.array([[float(item) if abs(item) > least else 0.0 for item in row] for row in matrix])


# -- expressions ------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Reduced:
    """A whitened C as orthogonal columns times R, with the whitened residual seen in them.

    Attributes
    ----------
    R : list of list of casadi.SX
        Upper triangular (n, n).
    seen : casadi.SX
        Q' b (n, 1).
    pivot : casadi.SX
        Least squared part of a column that is its own, relative to the column.
    """

    R: list[list[ca.SX]]
    seen: ca.SX
    pivot: ca.SX

    def solution(self) -> ca.SX:
        """Return R^-1 Q' b: the step to the state of least squares (n, 1)."""
        n = len(self.R)
        x: list[ca.SX] = [ca.SX(0)] * n
        for i in reversed(range(n)):
            rest = sum((self.R[i][j] * x[j] for j in range(i + 1, n)), ca.SX(0))
            x[i] = (self.seen[i] - rest) / self.R[i][i]
        return ca.vertcat(*x)

    def image(self, change: ca.SX) -> ca.SX:
        """Return R times a change of the state."""
        n = len(self.R)
        return ca.vertcat(*[sum((self.R[i][j] * change[j] for j in range(i, n)), ca.SX(0)) for i in range(n)])

    def effective_dimension(self) -> ca.SX:
        """Return n* = tr(M) / lambda_max(M), M = (R'R)^-1."""
        n = len(self.R)
        inverse = [[ca.SX(0)] * n for _ in range(n)]
        for j in range(n):
            inverse[j][j] = 1 / self.R[j][j]
            for i in reversed(range(j)):
                rest = sum((self.R[i][k] * inverse[k][j] for k in range(i + 1, j + 1)), ca.SX(0))
                inverse[i][j] = -rest * inverse[i][i]
        product = [
            [sum((inverse[i][k] * inverse[j][k] for k in range(max(i, j), n)), ca.SX(0)) for j in range(n)]
            for i in range(n)
        ]
        trace = sum((product[i][i] for i in range(n)), ca.SX(0))
        return 1 / largest_eigenvalue([[item / trace for item in row] for row in product])


def _at_least(value: ca.SX, limit: float) -> ca.SX:
    """Return the larger of a value and a limit; NaN stays, so that the result is refused."""
    return ca.if_else(value < limit, limit, value)


def whitened(root: list[list[ca.SX]], right: ca.SX) -> ca.SX:
    """Return root^-1 right for a lower triangular root."""
    rows: list[ca.SX] = []
    for i, row in enumerate(root):
        value = right[i, :]
        for k in range(i):
            if not row[k].is_zero():
                value = value - row[k] * rows[k]
        rows.append(ca.sparsify(value / row[i]))
    return ca.vertcat(*rows)


def cholesky(matrix: ca.SX) -> tuple[list[list[ca.SX]], ca.SX]:
    """Return the lower factor of an expression, and its least pivot."""
    m = matrix.shape[0]
    factor = [[ca.SX(0)] * m for _ in range(m)]
    least: ca.SX | None = None
    for i in range(m):
        for j in range(i + 1):
            value = matrix[i, j]
            for k in range(j):
                if not (factor[i][k].is_zero() or factor[j][k].is_zero()):
                    value = value - factor[i][k] * factor[j][k]
            if i > j:
                factor[i][j] = ca.SX(0) if ca.SX(value).is_zero() else value / factor[j][j]
            else:
                value = ca.SX(value)
                least = value if least is None else ca.fmin(least, value)
                factor[i][i] = ca.sqrt(_at_least(value, SMALLEST_SQUARE))
    assert least is not None
    return factor, least


def reduced(matrix: ca.SX, residual: ca.SX) -> Reduced:
    """Return a matrix (m, n) and a residual (m, 1) by modified Gram-Schmidt, the residual as one more column.

    So the solution is as good as Householder's (Bjorck, "Numerical Methods for Least Squares Problems", sec. 2.4.3).
    """
    n = matrix.shape[1]
    columns = [ca.sparsify(matrix[:, j]) for j in range(n)]
    R = [[ca.SX(0)] * n for _ in range(n)]
    seen, pivot = [], None
    for j in range(n):
        whole = ca.sumsqr(matrix[:, j])
        own = ca.sumsqr(columns[j])
        share = own / _at_least(whole, SMALLEST_SQUARE)
        pivot = share if pivot is None else ca.fmin(pivot, share)
        length = ca.sqrt(_at_least(own, SMALLEST_SQUARE))
        direction = columns[j] / length
        R[j][j] = length
        for k in range(j + 1, n):
            part = ca.dot(direction, columns[k])
            if not part.is_zero():
                R[j][k] = part
                columns[k] = columns[k] - part * direction
        part = ca.dot(direction, residual)
        seen.append(part)
        residual = residual - part * direction
    assert pivot is not None
    return Reduced(R, ca.vertcat(*seen), pivot)


def largest_eigenvalue(matrix: Sequence[Sequence[ca.SX]]) -> ca.SX:
    """Return the largest eigenvalue of a symmetric positive semidefinite matrix of trace 1, to 2^-45 beside rounding.

    Householder's tridiagonal form (Golub & Van Loan, "Matrix Computations", 4th ed., sec. 8.3.1), then a fixed number of
    bisections on whether t I - T is positive definite (Sturm; sec. 8.4.1).
    """
    diagonal, squares = _tridiagonal([list(row) for row in matrix])
    n = len(diagonal)
    low, width = ca.SX(1.0 / n), 1.0 - 1.0 / n
    for _ in range(BISECTIONS):
        width *= 0.5
        middle = low + width
        pivot = middle - diagonal[0]
        least = pivot
        for i in range(1, n):
            # a pivot that is not positive has decided already; the guard only keeps what follows finite
            pivot = (middle - diagonal[i]) - squares[i - 1] / ca.fmax(pivot, SMALLEST_SQUARE)
            least = ca.fmin(least, pivot)
        low = low + ca.if_else(least > 0, 0, width)
    return low + 0.5 * width


def _tridiagonal(m: list[list[ca.SX]]) -> tuple[list[ca.SX], list[ca.SX]]:
    """Return diagonal and squared off-diagonal of a similar tridiagonal matrix."""
    n, squares = len(m), []
    for k in range(n - 2):
        below = [m[i][k] for i in range(k + 1, n)]
        square = sum((item * item for item in below), ca.SX(0))
        squares.append(square)
        length = ca.sqrt(square)
        half = square + length * ca.fabs(below[0])  # v'v / 2
        usable = half > SMALLEST_SQUARE
        v = [ca.if_else(below[0] < 0, below[0] - length, below[0] + length), *below[1:]]
        per_half = ca.if_else(usable, 1 / ca.fmax(half, SMALLEST_SQUARE), 0)
        p = [per_half * sum((m[k + 1 + i][k + 1 + j] * v[j] for j in range(len(v))), ca.SX(0)) for i in range(len(v))]
        middle = 0.5 * per_half * sum((a * b for a, b in zip(v, p, strict=True)), ca.SX(0))
        q = [a - middle * b for a, b in zip(p, v, strict=True)]
        for i in range(len(v)):
            for j in range(i + 1):
                value = m[k + 1 + i][k + 1 + j] - (v[i] * q[j] + q[i] * v[j])
                m[k + 1 + i][k + 1 + j] = m[k + 1 + j][k + 1 + i] = value
    squares.append(m[n - 1][n - 2] * m[n - 1][n - 2])
    return [m[i][i] for i in range(n)], squares


def weight_of(distance_squared: ca.SX, r: ca.SX, shrink: ca.SX | float, gamma: ca.SX | None) -> ca.SX:
    """Return the weight of the reading: (1 - r^2 c / D2)^+, times exp(-gamma / r^2) in the modified form.

    D2 = 0 gives 0, or 1 if r^2 c is 0 as well. A vanishing r makes the factor 0 unless gamma is 0.
    """
    square = r * r
    if isinstance(shrink, float) and shrink == 0:
        weight = ca.SX(1)
    else:
        lost = square * shrink
        larger = ca.fmax(distance_squared, lost)
        weight = ca.if_else(larger > 0, (larger - lost) / larger, 1)
    if gamma is None:
        return weight
    vanishing = ca.logic_and(square < SMALLEST_SQUARE, gamma > 0)
    # beyond 1000 the exponential is 0 in either precision
    exponent = ca.fmin(gamma / ca.fmax(square, SMALLEST_SQUARE), 1000)
    return weight * ca.if_else(vanishing, 0, ca.exp(-exponent))
