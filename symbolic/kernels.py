"""Kernels on packed symmetric matrices: congruence, scalar measurement update, decorrelation.

Each gives its scalar form, exploiting the sparsity it is told of, and its dense form. The two are written separately,
so that one checks the other.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from .program import Array, Kernel, Packing, Place

Pattern = tuple[tuple[int, int], ...]
"""(row, column) of each structural nonzero, in the order in which the values come."""

SMALLEST_VARIANCE = 1.0e-20
"""Least innovation variance that is divided by."""


def _total(terms: list[Any]) -> Any:
    """Return the sum of terms, those that are structurally zero (None) left out; None if none is left."""
    answer = None
    for term in terms:
        if term is not None:
            answer = term if answer is None else answer + term
    return answer


def _product(first: Any, second: Any) -> Any:
    return None if first is None or second is None else first * second


def _packed_names(packing: Packing) -> tuple[str, ...]:
    return tuple(f"p_{i}_{j}" for i, j in packing.pairs)


class Packed(Kernel):
    """A kernel on a packed symmetric matrix."""

    size: int
    packing: Packing | None

    @property
    def layout(self) -> Packing:
        """Where its elements are stored."""
        return self.packing or Packing(self.size)


def _full(pattern: Pattern, values: Array, shape: tuple[int, int]) -> Array:
    matrix = np.zeros(shape)
    for (i, j), value in zip(pattern, values, strict=True):
        matrix[i, j] = value
    return matrix


@dataclass(frozen=True)
class Congruence(Packed):
    """P -> F P F' + Q, F sparse, P and the result packed, Q given on a pattern of its upper triangle."""

    size: int
    f: Place
    f_pattern: Pattern
    p: Place
    q: Place | None
    q_pattern: Pattern
    target: Place
    f_names: tuple[str, ...] = ()
    q_names: tuple[str, ...] = ()
    comment: tuple[str, ...] = ("P = F P F' + Q",)
    packing: Packing | None = None

    @property
    def reads(self) -> tuple[tuple[Place, int], ...]:  # type: ignore[override]
        """F, P and Q."""
        own = ((self.f, len(self.f_pattern)), (self.p, self.layout.count))
        return own + (((self.q, len(self.q_pattern)),) if self.q else ())

    @property
    def writes(self) -> tuple[tuple[Place, int], ...]:  # type: ignore[override]
        """The new P."""
        return ((self.target, self.layout.count),)

    def names(self) -> tuple[tuple[str, ...], ...]:
        """Names of F's, P's and Q's elements."""
        return (self.f_names, _packed_names(self.layout)) + ((self.q_names,) if self.q else ())

    def scalar(self, *values: list[Any]) -> list[list[Any]]:
        """Sparse rows of F; each element of F P is formed once, and only where needed."""
        f, p = values[0], values[1]
        noise = dict(zip(self.q_pattern, values[2], strict=True)) if self.q else {}
        rows: list[list[tuple[int, Any]]] = [[] for _ in range(self.size)]
        for (i, j), value in zip(self.f_pattern, f, strict=True):
            rows[i].append((j, value))
        # the diagonal term first: it is the large one
        rows = [
            [term for term in row if term[0] == i] + [term for term in row if term[0] != i]
            for i, row in enumerate(rows)
        ]
        product: dict[tuple[int, int], Any] = {}

        def half(i: int, k: int) -> Any:
            if (i, k) not in product:
                product[i, k] = _total([_product(value, self.layout.pick(p, j, k)) for j, value in rows[i]])
            return product[i, k]  # None where it is zero by structure

        answer = []
        for i, j in self.layout.pairs:
            value = _total([_product(coefficient, half(i, k)) for k, coefficient in rows[j]])
            value = _total([value, noise.get((i, j))])
            answer.append(0.0 if value is None else value)
        return [answer]

    def dense(self, *values: Array) -> list[Array]:
        """The textbook product."""
        F = _full(self.f_pattern, values[0], (self.size, self.size))
        P = self.layout.unpack(values[1])
        result = F @ P @ F.T
        if self.q:
            upper = _full(self.q_pattern, values[2], (self.size, self.size))
            result = result + upper + np.triu(upper, 1).T
        return [self.layout.pack(0.5 * (result + result.T))]


@dataclass(frozen=True)
class RowUpdate(Packed):
    """One row of a measurement: correct the error vector and the covariance by a scalar update.

    The row corrects with residual - H_i d, d being the correction of the rows before it; that is the batch update
    (Bierman 1977, ch. V). Where the row measures one state alone, its row of P becomes r K, which cancels nothing.
    """

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
    single: bool
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
        """Residuals, H, r, P, and the correction and NIS so far."""
        own = (
            (self.residual, self.rows),
            (self.h, len(self.h_pattern)),
            (self.r, self.r_count),
            (self.p, self.layout.count),
        )
        return own if self.row == 0 else (*own, (self.delta, self.size), (self.nis, 1), (self.scales, self.rows))

    @property
    def writes(self) -> tuple[tuple[Place, int], ...]:  # type: ignore[override]
        """P, the correction, NIS, and the variances of the rows."""
        return (
            (self.target, self.layout.count),
            (self.delta, self.size),
            (self.nis, 1),
            (self.scales, self.rows),
        )

    def names(self) -> tuple[tuple[str, ...], ...]:
        """Names of the elements it reads."""
        own = (self.residual_names, self.h_names, self.r_names, _packed_names(self.layout))
        delta = tuple(f"delta_{i}" for i in range(self.size))
        scales = tuple(f"row_variance_{i}" for i in range(self.rows))
        return own if self.row == 0 else (*own, delta, ("nis_before",), scales)

    def scalar(self, *values: list[Any]) -> list[list[Any]]:
        """The update element by element."""
        residual, h, r, p = values[:4]
        first = self.row == 0
        n, r_i = self.size, r[self.row]
        terms = [(j, value) for (i, j), value in zip(self.h_pattern, h, strict=True) if i == self.row]
        cross = [_total([_product(value, self.layout.pick(p, k, j)) for j, value in terms]) for k in range(n)]
        variance = _total([value * cross[j] for j, value in terms]) + r_i
        per_variance = variance.named("s").reciprocal_above(SMALLEST_VARIANCE).named("per_s")
        innovation = residual[self.row]
        if not first:
            innovation = innovation - _total([value * values[4][j] for j, value in terms])
        innovation = innovation.named("e")
        # n = -K: each element is then a product and a sum, one instruction less than with a difference
        minus = (-per_variance).named("minus_per_s")
        loss: list[Any] = [None if item is None else (item * minus).named(f"n_{k}") for k, item in enumerate(cross)]
        minus_innovation = (-innovation).named("minus_e")
        nis = innovation * (innovation * per_variance)
        delta = self._corrected(values, [_product(item, minus_innovation) for item in loss])
        scales = [variance if k == self.row else None for k in range(self.rows)]
        if not first:
            nis = values[5][0] + nis
        measured = terms[0][0] if self.single else -1
        minus_r = (-r_i).named("minus_r")
        updated = []
        for i, j in self.layout.pairs:
            if loss[i] is None or loss[j] is None:
                updated.append(self.layout.pick(p, i, j))
            elif measured in (i, j):
                updated.append(minus_r * loss[i + j - measured])
            else:
                updated.append(self.layout.pick(p, i, j) + loss[i] * cross[j])
        return [updated, delta, [nis], scales]

    def _corrected(self, values: tuple[list[Any], ...], step: list[Any]) -> list[Any]:
        """Return the correction of the rows so far; what a row does not correlate with it leaves."""
        if self.row > 0:
            return [
                _total([old, item]) if item is not None else None for old, item in zip(values[4], step, strict=True)
            ]
        read = {j for _, j in self.h_pattern}  # what no row of the sensor touches is not looked at afterwards
        touched = {j for block in self.layout.parts if read & set(block) for j in block}
        return [0.0 if item is None and j in touched else item for j, item in enumerate(step)]

    def dense(self, *values: Array) -> list[Array]:
        """The same update with matrices, in Joseph's form."""
        residual, h, r, p = values[:4]
        first = self.row == 0
        H = _full(self.h_pattern, h, (self.rows, self.size))[self.row]
        P = self.layout.unpack(p)
        delta = np.zeros(self.size) if first else values[4]
        nis = 0.0 if first else float(values[5][0])
        scales = np.ones(self.rows) if first else values[6].copy()
        variance = float(H @ P @ H + r[self.row])
        gain = P @ H / (variance if variance >= SMALLEST_VARIANCE else 1.0)
        innovation = float(residual[self.row] - H @ delta)
        scales[self.row] = variance
        keep = np.eye(self.size) - np.outer(gain, H)
        updated = keep @ P @ keep.T + r[self.row] * np.outer(gain, gain)
        nis += innovation * innovation / (variance if variance >= SMALLEST_VARIANCE else 1.0)
        return [self.layout.pack(updated), delta + gain * innovation, np.array([nis]), scales]


@dataclass(frozen=True)
class JosephRowUpdate(RowUpdate):
    """One row of a measurement in Joseph's form: P = (I - K H) P (I - K H)' + K r K'.

    Positive semidefinite whatever gain rounding leaves, at about twice the cost of `RowUpdate`.
    """

    def scalar(self, *values: list[Any]) -> list[list[Any]]:
        """A = (I - K H) P, then A (I - K H)' + K r K', upper triangle."""
        residual, h, r, p = values[:4]
        n, r_i = self.size, r[self.row]
        terms = [(j, value) for (i, j), value in zip(self.h_pattern, h, strict=True) if i == self.row]
        cross = [_total([_product(value, self.layout.pick(p, k, j)) for j, value in terms]) for k in range(n)]
        variance = (_total([value * cross[j] for j, value in terms]) + r_i).named("s")
        per_variance = variance.reciprocal_above(SMALLEST_VARIANCE).named("per_s")
        innovation = residual[self.row]
        if self.row > 0:
            innovation = innovation - _total([value * values[4][j] for j, value in terms])
        innovation = innovation.named("e")
        gain: list[Any] = [
            None if item is None else (item * per_variance).named(f"k_{k}") for k, item in enumerate(cross)
        ]
        # element (i, j) of A is p_ij - k_i (h P)_j; of A h', (P h')_i - k_i h P h'
        spread = variance - r_i
        kept: list[Any] = [None if item is None else item - gain[k] * spread for k, item in enumerate(cross)]
        noisy = [_product(item, r_i) for item in gain]
        updated = []
        for i, j in self.layout.pairs:
            if gain[i] is None or gain[j] is None:
                updated.append(self.layout.pick(p, i, j))
                continue
            half = self.layout.pick(p, i, j) - gain[i] * cross[j]
            updated.append((half - kept[i] * gain[j]) + noisy[i] * gain[j])
        nis = innovation * (innovation * per_variance)
        delta = self._corrected(values, [_product(item, innovation) for item in gain])
        if self.row > 0:
            nis = values[5][0] + nis
        scales = [variance if k == self.row else None for k in range(self.rows)]
        return [updated, delta, [nis], scales]


@dataclass(frozen=True)
class AllStatesUpdate(Kernel):
    """The rows of a sensor that measures every state, in their order: one after another, as `RowUpdate`.

    The C takes two rows at a time, with the same few functions for all of them.
    """

    rows: tuple[RowUpdate, ...]

    @staticmethod
    def serves(size: int, columns: list[list[int]], single: list[bool]) -> bool:
        """Whether it takes these rows: the states each of them reads, and whether it reads one with factor 1."""
        return size >= 4 and size % 2 == 0 and all(single) and columns == [[j] for j in range(size)]

    @property
    def reads(self) -> tuple[tuple[Place, int], ...]:  # type: ignore[override]
        """What the first row reads."""
        return self.rows[0].reads

    @property
    def writes(self) -> tuple[tuple[Place, int], ...]:  # type: ignore[override]
        """What each row writes."""
        return self.rows[0].writes

    @property
    def comment(self) -> tuple[str, ...]:  # type: ignore[override]
        """What the C says."""
        return ("d = d + K e, P = P - K s K', two rows at a time; measured rows as r K",)

    def names(self) -> tuple[tuple[str, ...], ...]:
        """Names of the elements it reads."""
        return self.rows[0].names()

    def scalar(self, *values: list[Any]) -> list[list[Any]]:
        """The rows in turn."""
        residual, h, r, _ = values
        answer = self.rows[0].scalar(*values)
        for row in self.rows[1:]:
            p, delta, nis, scales = answer
            answer = row.scalar(residual, h, r, p, delta, nis, scales)
            answer[3] = [old if new is None else new for old, new in zip(scales, answer[3], strict=True)]
        return answer

    def dense(self, *values: Array) -> list[Array]:
        """The rows in turn, with matrices."""
        residual, h, r, _ = values
        answer = self.rows[0].dense(*values)
        for row in self.rows[1:]:
            answer = row.dense(residual, h, r, *answer)
        return answer


@dataclass(frozen=True)
class InnovationVariance(Packed):
    """Diagonal of H P H' + R at the prior."""

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
    comment: tuple[str, ...] = ("variance of the innovation: diagonal of H P H' + R",)
    packing: Packing | None = None

    @property
    def reads(self) -> tuple[tuple[Place, int], ...]:  # type: ignore[override]
        """H, R and P."""
        return (
            (self.h, len(self.h_pattern)),
            (self.r, len(self.r_pattern)),
            (self.p, self.layout.count),
        )

    @property
    def writes(self) -> tuple[tuple[Place, int], ...]:  # type: ignore[override]
        """The diagonal."""
        return ((self.target, self.rows),)

    def names(self) -> tuple[tuple[str, ...], ...]:
        """Names of the elements it reads."""
        return (self.h_names, self.r_names, _packed_names(self.layout))

    def scalar(self, *values: list[Any]) -> list[list[Any]]:
        """Sparse quadratic forms."""
        h, r, p = values
        noise = dict(zip(self.r_pattern, r, strict=True))
        answer = []
        for row in range(self.rows):
            terms = [(j, value) for (i, j), value in zip(self.h_pattern, h, strict=True) if i == row]
            cross = [_total([_product(a, self.layout.pick(p, j, k)) for k, a in terms]) for j, _ in terms]
            answer.append(_total([a * item for (_, a), item in zip(terms, cross, strict=True)]) + noise[row, row])
        return [answer]

    def dense(self, *values: Array) -> list[Array]:
        """The same with matrices."""
        h, r, p = values
        H = _full(self.h_pattern, h, (self.rows, self.size))
        noise = dict(zip(self.r_pattern, r, strict=True))
        spread = np.diag(H @ self.layout.unpack(p) @ H.T)
        return [np.array([spread[i] + noise[i, i] for i in range(self.rows)])]


def _factorised(rows: int, pattern: Pattern, values: list[Any]) -> tuple[dict[tuple[int, int], Any], list[Any]]:
    """Return the elements of L below its diagonal, and D, of R = L D L', element by element."""
    noise = {(max(i, j), min(i, j)): value for (i, j), value in zip(pattern, values, strict=True)}
    lower: dict[tuple[int, int], Any] = {}
    weighted: dict[tuple[int, int], Any] = {}
    diagonal: list[Any] = []
    for i in range(rows):
        pivot = noise[i, i]
        for k in range(i):
            terms = [weighted[i, m] * lower[k, m] for m in range(k) if (i, m) in weighted and (k, m) in lower]
            value = noise.get((i, k))
            if value is None and not terms:
                continue
            if value is None:
                total = -_total(terms)
            else:
                total = value - _total(terms) if terms else value
            weighted[i, k] = total
            lower[i, k] = total * diagonal[k].reciprocal_above(SMALLEST_VARIANCE)
            pivot = pivot - total * lower[i, k]
        diagonal.append(pivot)
    return lower, diagonal


def _dense_factors(R: Array) -> tuple[Array, Array]:
    """Return L and D of a definite matrix; of any other, D with a negative element."""
    if np.all(np.isfinite(R)) and np.all(np.linalg.eigvalsh(R) > 0):
        root = np.linalg.cholesky(R)
        return root / np.diag(root), np.diag(root) ** 2
    return np.eye(len(R)), np.full(len(R), -1.0)


@dataclass(frozen=True)
class Pivots(Kernel):
    """D of R = L D L', for a packed symmetric R: all positive where R is positive definite."""

    rows: int
    r: Place
    r_pattern: Pattern
    target: Place
    r_names: tuple[str, ...] = ()

    @property
    def comment(self) -> tuple[str, ...]:  # type: ignore[override]
        """What the C says."""
        return (f"{self.r.name} must be positive definite: pivots of its factorisation",)

    @property
    def reads(self) -> tuple[tuple[Place, int], ...]:  # type: ignore[override]
        """R."""
        return ((self.r, len(self.r_pattern)),)

    @property
    def writes(self) -> tuple[tuple[Place, int], ...]:  # type: ignore[override]
        """D."""
        return ((self.target, self.rows),)

    def names(self) -> tuple[tuple[str, ...], ...]:
        """Names of the elements it reads."""
        return (self.r_names,)

    def scalar(self, *values: list[Any]) -> list[list[Any]]:
        """Factorise element by element."""
        return [_factorised(self.rows, self.r_pattern, values[0])[1]]

    def dense(self, *values: Array) -> list[Array]:
        """The same by Cholesky."""
        upper = _full(self.r_pattern, values[0], (self.rows, self.rows))
        return [_dense_factors(np.triu(upper) + np.triu(upper, 1).T)[1]]


@dataclass(frozen=True)
class Decorrelate(Kernel):
    """R = L D L'; H -> L^-1 H, residual -> L^-1 residual: rows with uncorrelated noise D."""

    rows: int
    size: int
    residual: Place
    h: Place
    h_pattern: Pattern
    r: Place
    r_pattern: Pattern
    new_residual: Place
    new_h: Place
    new_r: Place
    h_names: tuple[str, ...] = ()
    r_names: tuple[str, ...] = ()
    residual_names: tuple[str, ...] = ()
    comment: tuple[str, ...] = ("R = L D L'; rows of H and the innovation are made uncorrelated by L^-1",)

    @property
    def new_pattern(self) -> Pattern:
        """Pattern of L^-1 H: each row also has the columns of the rows above it that it is correlated with."""
        linked = {(max(i, j), min(i, j)) for i, j in self.r_pattern if i != j}
        columns: list[set[int]] = [{j for i, j in self.h_pattern if i == row} for row in range(self.rows)]
        # Cholesky fill-in: rows linked to a common earlier row become linked
        for k in range(self.rows):
            below = [i for i in range(k + 1, self.rows) if (i, k) in linked]
            linked |= {(max(a, b), min(a, b)) for a in below for b in below if a != b}
        for i in range(self.rows):
            for k in range(i):
                if (i, k) in linked:
                    columns[i] |= columns[k]
        return tuple((i, j) for i in range(self.rows) for j in sorted(columns[i]))

    @property
    def reads(self) -> tuple[tuple[Place, int], ...]:  # type: ignore[override]
        """Residual, H and R."""
        return (
            (self.residual, self.rows),
            (self.h, len(self.h_pattern)),
            (self.r, len(self.r_pattern)),
        )

    @property
    def writes(self) -> tuple[tuple[Place, int], ...]:  # type: ignore[override]
        """Residual, H and the diagonal D."""
        return (
            (self.new_residual, self.rows),
            (self.new_h, len(self.new_pattern)),
            (self.new_r, self.rows),
        )

    def names(self) -> tuple[tuple[str, ...], ...]:
        """Names of the elements it reads."""
        return (self.residual_names, self.h_names, self.r_names)

    def scalar(self, *values: list[Any]) -> list[list[Any]]:
        """Factorise and substitute, element by element."""
        residual, h, r = values
        lower, diagonal = _factorised(self.rows, self.r_pattern, r)
        table: list[dict[int, Any]] = [{} for _ in range(self.rows)]
        for (i, j), value in zip(self.h_pattern, h, strict=True):
            table[i][j] = value
        new_residual = list(residual)
        for i in range(self.rows):
            for k in range(i):
                if (i, k) not in lower:
                    continue
                new_residual[i] = new_residual[i] - lower[i, k] * new_residual[k]
                for j, value in table[k].items():
                    product = lower[i, k] * value
                    table[i][j] = table[i][j] - product if j in table[i] else -product
        return [new_residual, [table[i][j] for i, j in self.new_pattern], diagonal]

    def dense(self, *values: Array) -> list[Array]:
        """The same with SciPy's factorisation where R is definite, else by elimination."""
        residual, h, r = values
        upper = _full(self.r_pattern, r, (self.rows, self.rows))
        R = np.triu(upper) + np.triu(upper, 1).T
        H = _full(self.h_pattern, h, (self.rows, self.size))
        L, D = _dense_factors(R)
        H = np.linalg.solve(L, H)
        picked = np.array([H[i, j] for i, j in self.new_pattern])
        return [np.linalg.solve(L, residual), picked, D]


@dataclass(frozen=True)
class Scale(Kernel):
    """Multiply every element of a vector by a factor."""

    size: int
    factor: Place
    source: Place
    target: Place
    comment: tuple[str, ...] = ()
    symmetric: int = 0
    packing: Packing | None = None

    @property
    def reads(self) -> tuple[tuple[Place, int], ...]:  # type: ignore[override]
        """Factor and vector."""
        return ((self.factor, 1), (self.source, self.size))

    @property
    def writes(self) -> tuple[tuple[Place, int], ...]:  # type: ignore[override]
        """The scaled vector."""
        return ((self.target, self.size),)

    def names(self) -> tuple[tuple[str, ...], ...]:
        """Names of the elements it reads."""
        packing = self.packing or Packing(self.symmetric)
        elements = _packed_names(packing) if self.symmetric else tuple(f"v_{i}" for i in range(self.size))
        return (("factor",), elements)

    def scalar(self, *values: list[Any]) -> list[list[Any]]:
        """Element by element."""
        return [[values[0][0] * item for item in values[1]]]

    def dense(self, *values: Array) -> list[Array]:
        """The same as an array."""
        return [values[0][0] * values[1]]
