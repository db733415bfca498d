"""Kernels on the factors of a covariance, P = U D U': U unit upper triangular, D diagonal.

The factors are packed as one upper triangle by rows: D on the diagonal, U beside it. G. J. Bierman, "Factorization methods
for discrete sequential estimation", 1977: measurement update ch. V; the time update triangularises the array of Thornton's
(C. L. Thornton, 1976; Bierman ch. VI) by rotations. The scalar forms are those algorithms; the dense forms are array
algorithms by orthogonal triangularisation (Kailath, Sayed, Hassibi, "Linear estimation", 2000, ch. 12), so that one checks
the other.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.linalg import rq

from .kernels import SMALLEST_VARIANCE, Packed, Pattern, _full, _product, _total
from .program import Array, Packing, Place

Sparse = dict[int, Any]
"""Column -> value of one row, structural zeros left out."""


def factor_names(packing: Packing) -> tuple[str, ...]:
    """Return names of the packed factors."""
    return tuple(f"d_{i}" if i == j else f"u_{i}_{j}" for i, j in packing.pairs)


def root_of(packed: Array, packing: Packing | int) -> Array:
    """Return U sqrt(D), upper triangular, of packed factors; a number stands for a whole triangle of that size."""
    packing = Packing(packing) if isinstance(packing, int) else packing
    table = packing.upper(packed)
    weights = np.sqrt(np.maximum(np.diag(table), 0.0))
    return np.asarray((np.triu(table, 1) + np.eye(packing.size)) * weights)


def covariance_of(packed: Array, packing: Packing | int) -> Array:
    """Return P = U D U' (size, size) of packed factors."""
    root = root_of(np.asarray(packed, dtype=float), packing)
    return root @ root.T


def factors_of_root(root: Array, packing: Packing | None = None) -> Array:
    """Return the packed factors of P = root root', for a root with as many columns as rows or more.

    An element of D that is zero gives a column of zeros in U.
    """
    size = len(root)
    packing = packing or Packing(size)
    if not np.all(np.isfinite(root)):
        return np.full(packing.count, np.nan)
    upper = rq(root, mode="economic", check_finite=False)[0][:, -size:]
    diagonal = np.diag(upper).copy()
    scale = np.where(diagonal == 0.0, 1.0, diagonal)
    table = upper / scale
    table[np.diag_indices(size)] = diagonal**2
    return packing.pack(table)


def _factors_of_matrix(matrix: Array) -> tuple[Array, Array]:
    """Return (U, d) of a positive semidefinite matrix = U diag(d) U'; what rounding makes negative is zero."""
    size = len(matrix)
    rest, upper, weights = matrix.copy(), np.eye(size), np.zeros(size)
    for j in reversed(range(size)):
        weights[j] = rest[j, j] if rest[j, j] > 0.0 else 0.0
        if weights[j] > SMALLEST_DIVISOR:
            upper[:j, j] = rest[:j, j] / weights[j]
            rest[:j, :j] -= weights[j] * np.outer(upper[:j, j], upper[:j, j])
    return upper, weights


SMALLEST_DIVISOR = 1.0e-30
"""Least element of D that is divided by; below it the column of U is taken to be zero."""


def _upper_rows(packing: Packing, packed: list[Any]) -> tuple[list[Sparse], list[Any]]:
    """Return the rows of U beside its diagonal, and D."""
    rows: list[Sparse] = [{} for _ in range(packing.size)]
    for (i, j), value in zip(packing.pairs, packed, strict=True):
        if i != j:
            rows[i][j] = value
    return rows, [packed[place] for place in packing.diagonal]


def _triangularised(
    rows: list[Sparse], weights: dict[int, Any], positive: frozenset[int], packing: Packing
) -> list[Any]:
    """Return the packed factors of W diag(weights) W' by rotations of weighted columns; structural zeros are used.

    For each row, from the last to the first, one column keeps an element in it and clears that of every other column; it
    is then a column of U and left alone. Weighted Gram-Schmidt (Bierman 1977, sec. VI.4), which it replaces, goes on
    working with the columns that are done: it takes twice the operations. The rotations are those of Agee and Turner
    (Bierman 1977, sec. III.3), without square roots (W. M. Gentleman, "Least squares computations by Givens
    transformations without square roots", 1973); what they add is not negative, so that D stays positive.

    Parameters
    ----------
    rows : list of dict
        W, row by row: column -> value.
    weights : dict
        Column -> its weight, not negative.
    positive : frozenset of int
        Columns whose weight is at least a floor of D: by a multiple of it may be divided.
    packing : Packing
        Which elements are stored.
    """
    size = len(rows)
    answer: list[Any] = [0.0] * packing.count
    for j in reversed(range(size)):
        active = [k for k in weights if k in rows[j]]
        answer[packing.at(j, j)] = 0.0
        if not active:
            continue
        pivot = min(active, key=lambda k: (not rows[j][k].is_const(1.0), k not in positive, abs(k - j), k))
        certain = pivot in positive
        if not rows[j][pivot].is_const(1.0):
            _scaled_to_one(rows, weights, pivot, j)
            certain = False
        for k in active:
            if k != pivot:
                _cleared(rows, weights, pivot, k, j, certain)
        answer[packing.at(j, j)] = weights.pop(pivot).named(f"d_{j}")
        for i in range(j):
            if pivot in rows[i]:
                answer[packing.at(i, j)] = rows[i].pop(pivot).named(f"u_{i}_{j}")
    return answer


def _scaled_to_one(rows: list[Sparse], weights: dict[int, Any], pivot: int, j: int) -> None:
    """Scale a column so that its element in row j is one; one that is zero becomes a column of weight zero."""
    element, weight = rows[j][pivot], weights[pivot]
    weighted = weight * element
    total = (weighted * element).named(f"scaled_d_{j}")
    per_element = (weighted * total.reciprocal_above(SMALLEST_DIVISOR)).named(f"per_f_{j}")
    weights[pivot] = total
    for i in range(j):
        if pivot in rows[i]:
            rows[i][pivot] = rows[i][pivot] * per_element
    rows[j][pivot] = element.graph.const(1.0)


def _cleared(rows: list[Sparse], weights: dict[int, Any], pivot: int, other: int, j: int, certain: bool) -> None:
    """Rotate two weighted columns so that `pivot` keeps one in row j and `other` nothing; above, both change."""
    v = rows[j].pop(other)
    weighted = weights[other] * v
    total = weights[pivot] + weighted * v
    per_total = (total.reciprocal() if certain else total.reciprocal_above(SMALLEST_DIVISOR)).named("per_t")
    kept = (weights[pivot] * per_total).named("kept")
    gain = (weighted * per_total).named("gain")
    weights[pivot] = total.named("t")
    weights[other] = (weights[other] * kept).named("w")
    for i in range(j):
        u, w = rows[i].get(pivot), rows[i].get(other)
        if u is None and w is None:
            continue
        if u is None:
            rows[i][other], rows[i][pivot] = -w, gain * w  # type: ignore[operator]
            continue
        moved = u * v if w is None else u * v - w
        # what is left of u where nothing stood beside it: 1 - gain v, without the difference
        rows[i][pivot] = u * kept if w is None else u - gain * moved
        rows[i][other] = moved


@dataclass(frozen=True)
class FactoredCongruence(Packed):
    """Factors of P -> those of F P F' + Q, by weighted rotations; F sparse, Q given on a pattern of its upper triangle."""

    size: int
    f: Place
    f_pattern: Pattern
    p: Place
    q: Place | None
    q_pattern: Pattern
    target: Place
    f_names: tuple[str, ...] = ()
    q_names: tuple[str, ...] = ()
    comment: tuple[str, ...] = ("U D U' = F U D U' F' + Q, by rotations of columns weighted with D and Q",)
    packing: Packing | None = None

    @property
    def reads(self) -> tuple[tuple[Place, int], ...]:  # type: ignore[override]
        """F, the factors, and Q."""
        own = ((self.f, len(self.f_pattern)), (self.p, self.layout.count))
        return own + (((self.q, len(self.q_pattern)),) if self.q else ())

    @property
    def writes(self) -> tuple[tuple[Place, int], ...]:  # type: ignore[override]
        """The new factors."""
        return ((self.target, self.layout.count),)

    def names(self) -> tuple[tuple[str, ...], ...]:
        """Names of the elements it reads."""
        return (self.f_names, factor_names(self.layout)) + ((self.q_names,) if self.q else ())

    def order(self, output: int) -> list[int]:
        """Column by column, the last first: so U is found."""
        every = [(i, j) for j in reversed(range(self.size)) for i in [j, *range(j)]]
        return [place for i, j in every if (place := self.layout.index(i, j)) is not None]

    def scalar(self, *values: list[Any]) -> list[list[Any]]:
        """Rows [F U, B] with weights [D, noise], Q = B diag(noise) B'."""
        n = self.size
        upper, diagonal = _upper_rows(self.layout, values[1])
        rows: list[Sparse] = [{} for _ in range(n)]
        for (i, j), value in zip(self.f_pattern, values[0], strict=True):
            terms = {j: value, **{k: value * u for k, u in upper[j].items()}}
            for k, term in terms.items():
                rows[i][k] = rows[i][k] + term if k in rows[i] else term
        weights: dict[int, Any] = dict(enumerate(diagonal))
        if self.q:
            for k, (weight, column) in enumerate(self._noise(values[2])):
                weights[n + k] = weight
                for i, value in column.items():
                    rows[i][n + k] = value
        # D in the memory is held above its floor, a candidate's is not yet
        return [_triangularised(rows, weights, frozenset(range(n) if self.p.space == "memory" else ()), self.layout)]

    def _noise(self, values: list[Any]) -> list[tuple[Any, Sparse]]:
        """Return (weight, column of B) for each independent noise of Q, positive semidefinite; zero where rounding is negative."""
        rest = dict(zip(self.q_pattern, values, strict=True))
        touched: set[int] = set()
        answer: list[tuple[Any, Sparse]] = []
        for j in reversed(range(self.size)):
            if (j, j) not in rest:
                continue
            above = [i for i in range(j) if (i, j) in rest]
            pivot = rest[j, j].positive_part() if above or j in touched else rest[j, j]
            column: Sparse = {j: pivot.graph.const(1.0)}
            if above:
                per_pivot = pivot.reciprocal_above(SMALLEST_DIVISOR)
                column |= {i: rest[i, j] * per_pivot for i in above}
            for i in above:
                for k in above[above.index(i) :]:
                    step = column[i] * rest[k, j]
                    rest[i, k] = rest[i, k] - step if (i, k) in rest else -step
                    touched.add(k)
            answer.append((pivot, column))
        return answer

    def dense(self, *values: Array) -> list[Array]:
        """Triangularise [F U sqrt(D), B sqrt(noise)]."""
        n = self.size
        F = _full(self.f_pattern, values[0], (n, n))
        root = F @ root_of(values[1], self.layout)
        if self.q:
            upper = _full(self.q_pattern, values[2], (n, n))
            if not np.all(np.isfinite(upper)):
                return [np.full(self.layout.count, np.nan)]
            factor, weights = _factors_of_matrix(upper + np.triu(upper, 1).T)
            root = np.hstack([root, factor * np.sqrt(weights)])
        return [factors_of_root(root, self.layout)]


@dataclass(frozen=True)
class FactoredRowUpdate(Packed):
    """One row of a measurement on the factors (Bierman 1977, sec. V.3): they stay positive whatever rounding does."""

    size: int
    row: int
    residual: Place
    rows: int
    h: Place
    h_pattern: Pattern
    r: Place
    r_count: int
    p: Place
    target: Place
    h_names: tuple[str, ...] = ()
    r_names: tuple[str, ...] = ()
    residual_names: tuple[str, ...] = ()
    comment: tuple[str, ...] = ()
    delta: Place = Place("local", "delta")
    scales: Place = Place("local", "row_variance")
    nis: Place = Place("local", "nis")
    packing: Packing | None = None

    @property
    def reads(self) -> tuple[tuple[Place, int], ...]:  # type: ignore[override]
        """Residuals, H, r, the factors, and the correction and NIS so far."""
        own = (
            (self.residual, self.rows),
            (self.h, len(self.h_pattern)),
            (self.r, self.r_count),
            (self.p, self.layout.count),
        )
        return own if self.row == 0 else (*own, (self.delta, self.size), (self.nis, 1), (self.scales, self.rows))

    @property
    def writes(self) -> tuple[tuple[Place, int], ...]:  # type: ignore[override]
        """The factors, the correction, NIS, and the variances of the rows."""
        return (
            (self.target, self.layout.count),
            (self.delta, self.size),
            (self.nis, 1),
            (self.scales, self.rows),
        )

    def names(self) -> tuple[tuple[str, ...], ...]:
        """Names of the elements it reads."""
        own = (self.residual_names, self.h_names, self.r_names, factor_names(self.layout))
        delta = tuple(f"delta_{i}" for i in range(self.size))
        scales = tuple(f"row_variance_{i}" for i in range(self.rows))
        return own if self.row == 0 else (*own, delta, ("nis_before",), scales)

    def scalar(self, *values: list[Any]) -> list[list[Any]]:
        """The update element by element."""
        residual, h, r, packed = values[:4]
        n = self.size
        terms = {j: value for (i, j), value in zip(self.h_pattern, h, strict=True) if i == self.row}
        upper, diagonal = _upper_rows(self.layout, packed)
        answer = list(packed)
        # f = U' h, g = D f; a is the variance of the innovation as far as the states up to j make it
        f = [_total([terms.get(j), *[_product(upper[i].get(j), terms[i]) for i in terms if i < j]]) for j in range(n)]
        a: Any = r[self.row]
        per_a: Any = None
        gain: list[Any] = [None] * n
        single = next(iter(terms)) if len(terms) == 1 and next(iter(terms.values())).is_const(1.0) else None
        for j in range(n):
            if f[j] is None:
                continue
            g = diagonal[j] * f[j]
            before: Any = a
            per_before: Any = per_a
            a = before + f[j] * g
            # of a state measured alone a begins with r + d, and no later one is smaller
            far = per_before is not None and single is not None
            per_a = (a.reciprocal() if far else a.reciprocal_above(SMALLEST_VARIANCE)).named(f"per_a_{j}")
            answer[self.layout.at(j, j)] = (diagonal[j] * (before * per_a)).named(f"new_d_{j}")
            loss: Any = None if per_before is None else (f[j] * per_before).named(f"loss_{j}")
            for i in [i for i in range(j) if j in upper[i]]:
                u = upper[i][j]
                if gain[i] is not None and loss is not None:
                    # u - gain loss; in the measured row that is u r / a, which cancels nothing
                    answer[self.layout.at(i, j)] = r[self.row] * loss if i == single else u - gain[i] * loss
                gain[i] = _total([gain[i], u * g])
            gain[j] = g
        variance = a.named("s")
        innovation = residual[self.row]
        if self.row > 0:
            innovation = innovation - _total([value * values[4][j] for j, value in terms.items()])
        innovation = innovation.named("e")
        weighted = (innovation * per_a).named("weighted_e")
        nis = innovation * weighted
        scales = [variance if k == self.row else None for k in range(self.rows)]
        read = {j for _, j in self.h_pattern}  # what no row of the sensor touches is not looked at afterwards
        touched = {j for block in self.layout.parts if read & set(block) for j in block}
        moved = [item * weighted if item is not None else 0.0 if j in touched else None for j, item in enumerate(gain)]
        if self.row > 0:
            moved = [old if item is None else old + item * weighted for old, item in zip(values[4], gain, strict=True)]
            nis = values[5][0] + nis
        return [answer, moved, [nis], scales]

    def dense(self, *values: Array) -> list[Array]:
        """Triangularise the array [[root, 0], [h root, sqrt(r)]]."""
        residual, h, r, packed = values[:4]
        n, first = self.size, self.row == 0
        H = _full(self.h_pattern, h, (self.rows, n))[self.row]
        root, own = root_of(packed, self.layout), float(r[self.row])
        delta = np.zeros(n) if first else values[4]
        nis = 0.0 if first else float(values[5][0])
        scales = np.ones(self.rows) if first else values[6].copy()
        seen = H @ root
        variance = float(seen @ seen) + own
        scales[self.row] = variance
        divisor = variance if variance >= SMALLEST_VARIANCE else 1.0
        gain = root @ seen / divisor
        innovation = float(residual[self.row] - H @ delta)
        factors = np.full(self.layout.count, np.nan)
        array = np.block([[root, np.zeros((n, 1))], [seen[None, :], np.sqrt(np.maximum(own, 0.0)) * np.ones((1, 1))]])
        if np.all(np.isfinite(array)):
            # an orthogonal transformation that clears all but the last element of the last row
            triangle = rq(array, check_finite=False)[0]
            factors = factors_of_root(triangle[:n, :n], self.layout)
        return [factors, delta + gain * innovation, np.array([nis + innovation**2 / divisor]), scales]


@dataclass(frozen=True)
class FactoredInnovationVariance(Packed):
    """Diagonal of H P H' + R at the prior, from the factors."""

    size: int
    rows: int
    h: Place
    h_pattern: Pattern
    r: Place
    r_pattern: Pattern
    p: Place
    target: Place
    h_names: tuple[str, ...] = ()
    r_names: tuple[str, ...] = ()
    comment: tuple[str, ...] = ("variance of the innovation: diagonal of H U D U' H' + R",)
    packing: Packing | None = None

    @property
    def reads(self) -> tuple[tuple[Place, int], ...]:  # type: ignore[override]
        """H, R and the factors."""
        return ((self.h, len(self.h_pattern)), (self.r, len(self.r_pattern)), (self.p, self.layout.count))

    @property
    def writes(self) -> tuple[tuple[Place, int], ...]:  # type: ignore[override]
        """The diagonal."""
        return ((self.target, self.rows),)

    def names(self) -> tuple[tuple[str, ...], ...]:
        """Names of the elements it reads."""
        return (self.h_names, self.r_names, factor_names(self.layout))

    def scalar(self, *values: list[Any]) -> list[list[Any]]:
        """Sums of squares."""
        h, r, packed = values
        upper, diagonal = _upper_rows(self.layout, packed)
        noise = dict(zip(self.r_pattern, r, strict=True))
        answer = []
        for row in range(self.rows):
            terms = {j: value for (i, j), value in zip(self.h_pattern, h, strict=True) if i == row}
            f = [
                _total([terms.get(j), *[_product(upper[i].get(j), terms[i]) for i in terms if i < j]])
                for j in range(self.size)
            ]
            answer.append(
                noise[row, row] + _total([item * (item * d) for item, d in zip(f, diagonal) if item is not None])
            )
        return [answer]

    def dense(self, *values: Array) -> list[Array]:
        """The same with matrices."""
        h, r, packed = values
        seen = _full(self.h_pattern, h, (self.rows, self.size)) @ root_of(packed, self.layout)
        noise = dict(zip(self.r_pattern, r, strict=True))
        return [np.array([seen[i] @ seen[i] + noise[i, i] for i in range(self.rows)])]


@dataclass(frozen=True)
class ScaleFactors(Packed):
    """P -> factor P: D is multiplied, U stays."""

    size: int
    factor: Place
    p: Place
    target: Place
    comment: tuple[str, ...] = ("P = factor P: D is scaled",)
    packing: Packing | None = None

    @property
    def reads(self) -> tuple[tuple[Place, int], ...]:  # type: ignore[override]
        """Factor and factors."""
        return ((self.factor, 1), (self.p, self.layout.count))

    @property
    def writes(self) -> tuple[tuple[Place, int], ...]:  # type: ignore[override]
        """The factors."""
        return ((self.target, self.layout.count),)

    def names(self) -> tuple[tuple[str, ...], ...]:
        """Names of the elements it reads."""
        return (("factor",), factor_names(self.layout))

    def scalar(self, *values: list[Any]) -> list[list[Any]]:
        """Element by element."""
        diagonal = set(self.layout.diagonal)
        return [[values[0][0] * item if k in diagonal else item for k, item in enumerate(values[1])]]

    def dense(self, *values: Array) -> list[Array]:
        """Triangularise the scaled root."""
        return [factors_of_root(np.sqrt(values[0][0]) * root_of(values[1], self.layout), self.layout)]
