"""Gaussian elimination of sparse symbolic equations, the order of the pivots fixed at nominal values of the parameters."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from .errors import ModelError

Array = NDArray[Any]

THRESHOLD = 0.01
"""A pivot is at least this share of the largest element left in its row, at the nominal values (Duff, Erisman, Reid 1986)."""

SINGULAR = 1.0e-10
"""Below this share of the largest element of the matrix, at the nominal values, nothing is left to be a pivot."""


@dataclass(frozen=True)
class Value:
    """A scalar expression, and its number at the nominal parameters."""

    expression: ca.SX
    number: float

    def __mul__(self, other: Value) -> Value:
        return Value(self.expression * other.expression, self.number * other.number)

    def __sub__(self, other: Value) -> Value:
        return Value(self.expression - other.expression, self.number - other.number)

    @property
    def is_zero(self) -> bool:
        """Whether it is zero whatever the parameters are."""
        return bool(self.expression.is_zero())


Row = dict[int, Value]


def values_of(matrix: ca.SX, parameters: ca.SX, nominal: Array) -> list[Row]:
    """Return the rows of a sparse expression, structural zeros left out."""
    numbers = np.asarray(ca.Function("numbers", [parameters], [ca.densify(matrix)])(nominal), dtype=float)
    numbers = numbers.reshape(matrix.shape)
    rows: list[Row] = [{} for _ in range(matrix.shape[0])]
    sparse = ca.sparsify(matrix)
    for i, j in zip(sparse.sparsity().row(), sparse.sparsity().get_col(), strict=True):
        rows[i][j] = Value(sparse[i, j], float(numbers[i, j]))
    return rows


def _less(row: Row, factor: Value, other: Row) -> None:
    """Subtract a multiple of another row; what becomes zero by structure is dropped."""
    for j, value in other.items():
        product = factor * value
        changed = row[j] - product if j in row else Value(-product.expression, -product.number)
        if changed.is_zero:
            row.pop(j, None)
        else:
            row[j] = changed


class Elimination:
    """The factors of a square sparse matrix of expressions.

    Pivots are chosen once, at the nominal values: of the elements that are large enough in their row the one that fills in
    least (Markowitz 1957), constants first. The expressions then hold for other parameters as long as no pivot gets small.

    Parameters
    ----------
    rows : list of dict
        Column -> value, for each row; they are used up.
    owner : str
        To complain about.

    Raises
    ------
    ModelError
        If the matrix is singular at the nominal values.
    """

    def __init__(self, rows: list[Row], owner: str):
        self.size = len(rows)
        largest = max((abs(value.number) for row in rows for value in row.values()), default=0.0)
        left = set(range(self.size))
        self.steps: list[tuple[int, int, Value, list[tuple[int, Value]], Row]] = []
        while left:
            i, j = self._pivot(rows, left, largest, owner)
            pivot = rows[i].pop(j)
            inverse = Value(1 / pivot.expression, 1 / pivot.number)
            left.remove(i)
            factors = []
            for k in sorted(left):
                if j in rows[k]:
                    factor = rows[k].pop(j) * inverse
                    factors.append((k, factor))
                    _less(rows[k], factor, rows[i])
            self.steps.append((i, j, inverse, factors, rows[i]))

    def _pivot(self, rows: list[Row], left: set[int], largest: float, owner: str) -> tuple[int, int]:
        counts: dict[int, int] = {}
        for i in left:
            for j in rows[i]:
                counts[j] = counts.get(j, 0) + 1
        best: tuple[Any, ...] | None = None
        for i in sorted(left):
            most = max((abs(value.number) for value in rows[i].values()), default=0.0)
            for j, value in rows[i].items():
                if abs(value.number) < THRESHOLD * most or abs(value.number) <= SINGULAR * largest:
                    continue
                cost = (len(rows[i]) - 1) * (counts[j] - 1)
                key = (cost, not value.expression.is_constant(), -abs(value.number), i, j)
                if best is None or key < best:
                    best = key
        if best is None:
            raise ModelError(
                f"{owner}: the equations are singular at the nominal parameters ({self.size - len(left)} of {self.size} "
                "pivots found); choose another operating point, or other unknowns"
            )
        return best[-2], best[-1]

    def pivots(self) -> list[Value]:
        """Return the pivots that depend on parameters, each divided by its nominal value: they are one at those."""
        answer = []
        for _, _, inverse, _, _ in self.steps:
            if not inverse.expression.is_constant():
                answer.append(Value(1 / (inverse.expression / inverse.number), 1.0))
        return answer

    def solve(self, right: Row) -> Row:
        """Return the solution for one right-hand side, row -> value; structural zeros are left out."""
        right = dict(right)
        for i, _, _, factors, _ in self.steps:
            if i in right:
                for k, factor in factors:
                    _less(right, factor, {k: right[i]})
        answer: Row = {}
        for i, j, inverse, _, row in reversed(self.steps):
            rest: Row = {0: right[i]} if i in right else {}
            for k, value in row.items():
                if k in answer:
                    _less(rest, value, {0: answer[k]})
            if rest:
                answer[j] = rest[0] * inverse
        return answer
