"""A covariance by its factors U D U': the textbook filter seen through them.

G. J. Bierman, "Factorization methods for discrete sequential estimation", 1977, ch. III. The filter itself is that of
`kalman`: nothing of Bierman's updates is used, so that they are checked by another road.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from .kalman import Answer, Filter, KalmanOracle, Refused, Status
from .model import Array, Blocks, Model, packed, unpacked

TINY = 1.0e-30
"""Least pivot of Q that is divided by."""


def factorised(covariance: Array, blocks: Blocks = ()) -> Array:
    """Return the packed factors of a packed covariance: D on the diagonal, U beside it (Bierman 1977, eq. III.2).

    Returns
    -------
    array (n (n + 1) / 2,)
        With an element of D that is not positive where the matrix is not positive definite.
    """
    rest = unpacked(np.asarray(covariance, dtype=float), blocks).copy()
    n = len(rest)
    table = np.zeros((n, n))
    with np.errstate(all="ignore"):
        for j in range(n - 1, -1, -1):
            table[j, j] = rest[j, j]
            table[:j, j] = rest[:j, j] / rest[j, j] if rest[j, j] != 0 else 0.0
            rest[:j, :j] -= rest[j, j] * np.outer(table[:j, j], table[:j, j])
    return _stored(table, blocks)


def multiplied(factors: Array, blocks: Blocks = ()) -> Array:
    """Return the packed covariance U D U' of packed factors."""
    table = unpacked(np.asarray(factors, dtype=float), blocks)
    upper = np.triu(table, 1) + np.eye(len(table))
    return packed((upper * np.diag(table)) @ upper.T, blocks)


def _stored(table: Array, blocks: Blocks) -> Array:
    """Return packed factors: those of a block-diagonal matrix have its blocks."""
    if not blocks:
        return packed(table)
    return np.concatenate([packed(table[np.ix_(block, block)]) for block in blocks])


def _with_rounded_ends(model: Model, precision: type) -> Model:
    """Return the model with the ends of its ranges rounded to a precision: they are compared in it."""

    def ends(item: Any) -> Any:
        low, high = (np.asarray(value).astype(precision).astype(float) for value in (item.low, item.high))
        return replace(item, low=low, high=high)

    return replace(
        model,
        states=tuple(map(ends, model.states)),
        inputs=tuple(map(ends, model.inputs)),
        params=tuple(map(ends, model.params)),
        sensors=tuple(map(ends, model.sensors)),
        dt=(float(precision(model.dt[0])), float(precision(model.dt[1]))) if isinstance(model.dt, tuple) else model.dt,
        floor=model.floor.astype(precision).astype(float),
        ceiling=model.ceiling.astype(precision).astype(float),
    )


def _diagonal(model: Model) -> Array:
    """Return where each element of D is packed."""
    n = len(model.floor)
    answer, start = np.zeros(n, dtype=int), 0
    for block in model.blocks or (tuple(range(n)),):
        size = len(block)
        answer[list(block)] = start + np.cumsum([0, *range(size, 1, -1)])
        start += size * (size + 1) // 2
    return answer


class FactoredFilter(Filter):
    """The filter of the textbook, told of noise by its factors: what makes Q indefinite is left out."""

    def judge_variance(self, variance: Array) -> None:
        """Refuse a variance beyond 1e30, which factors within their ranges may make."""
        if not np.all((variance >= 0) & (variance <= 1e30)):
            raise Refused(Status.OVERFLOW)

    def accepted_noise(self, Q: Array) -> Array:
        """Return U max(D, 0) U' of Q; a negative variance is refused."""
        if not np.all(np.diag(Q) >= 0):
            raise Refused(Status.NOT_POSITIVE)
        rest, total = Q.copy(), np.zeros_like(Q)
        for j in range(len(Q) - 1, -1, -1):
            if rest[j, j] > TINY:
                column = rest[:, j] / rest[j, j]
                column[j + 1 :] = 0
                part = rest[j, j] * np.outer(column, column)
                rest -= part
                total += part
        return total


class FactoredOracle:
    """The filter of `KalmanOracle` with the factors of its covariance as memory.

    Everything is computed in double precision, in which the factors of an ill-conditioned covariance can be found again;
    `precision` is that of inputs, parameters and the ends of ranges. An element of D below its floor is raised to it, which
    adds to the covariance.

    Parameters
    ----------
    model : Model
        f and h, names, sizes and ranges.
    """

    def __init__(self, model: Model):
        self.model = model
        self._inside = {kind: KalmanOracle(_with_rounded_ends(model, kind)) for kind in (np.float64, np.float32)}
        for oracle in self._inside.values():
            oracle.filter_type = FactoredFilter

    def call(
        self,
        entry: str,
        memory: Mapping[str, Any],
        inputs: Mapping[str, Any],
        params: Mapping[str, Any],
        precision: type = np.float64,
    ) -> Answer:
        """Run an entry; see `KalmanOracle.call`."""
        given = dict(memory)
        if entry != "init":
            given["covariance"] = multiplied(given.pop("factors"), self.model.blocks)
        inside = self._inside[np.float32 if precision is np.float32 else np.float64]
        status, after, outputs = inside.call(entry, given, inputs, params)
        if status < 0:
            return status, after, outputs
        factors = factorised(after.pop("covariance"), self.model.blocks)
        places = _diagonal(self.model)
        if not np.all(factors[places] >= 0):
            return int(Status.NOT_POSITIVE), {}, {}
        raised = np.maximum(factors[places], inside.model.floor)
        if np.any(raised != factors[places]):
            status = max(status, int(Status.CLAMPED))
        factors[places] = raised
        return status, {**after, "factors": factors}, outputs
