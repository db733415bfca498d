"""The matrix exponential of numbers, in so many digits that the rounded result is the same on any machine."""

from __future__ import annotations

import decimal
from decimal import Decimal
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]
Rows = list[list[Decimal]]

DIGITS = 100
"""Decimal digits of the work; squaring loses a few, double precision keeps sixteen."""

NEGLIGIBLE = Decimal("1e-95")
"""A term of the series below it changes no digit that is kept: the sum is near the identity."""


def held_exponential(A: Array, drive: Array, dt: float) -> tuple[Array, Array]:
    """Return e^(A dt) and the integral of e^(A s) over s from 0 to dt, times `drive`: the exact step with a held drive.

    The blocks of the exponential of [[A, drive], [0, 0]] dt (Van Loan, "Computing integrals involving the matrix
    exponential", IEEE TAC 23(3), 1978), by scaling, series and squaring in 100 decimal digits, rounded once.

    Parameters
    ----------
    A : array (n, n)
        Finite numbers, per second.
    drive : array (n, m)
        What is held over the step enters by it.
    dt : float
        Seconds.

    Returns
    -------
    transition : array (n, n)
    driven : array (n, m)
        Elements that are zero by structure are exactly zero. An element beyond double precision is infinite.
    """
    n, m = len(A), drive.shape[1]
    size = n + m
    with decimal.localcontext(decimal.Context(prec=DIGITS, Emax=decimal.MAX_EMAX, Emin=decimal.MIN_EMIN)):
        span = Decimal(dt)
        block = [[Decimal(0)] * size for _ in range(size)]
        for i in range(n):
            for j in range(n):
                block[i][j] = Decimal(float(A[i, j])) * span
            for j in range(m):
                block[i][n + j] = Decimal(float(drive[i, j])) * span
        norm = max((sum((abs(item) for item in row), Decimal(0)) for row in block), default=Decimal(0))
        halvings = 0
        while norm > Decimal("0.5"):
            norm, halvings = norm / 2, halvings + 1
        scaled = [[item / 2**halvings for item in row] for row in block]
        power = _series(scaled)
        for _ in range(halvings):
            power = _product(power, power)
        numbers = np.array([[float(item) for item in row] for row in power])
    return numbers[:n, :n], numbers[:n, n:]


def _series(matrix: Rows) -> Rows:
    size = len(matrix)
    term = [[Decimal(int(i == j)) for j in range(size)] for i in range(size)]
    total, k = [row[:] for row in term], 0
    while any(abs(item) > NEGLIGIBLE for row in term for item in row):
        k += 1
        term = [[item / k for item in row] for row in _product(term, matrix)]
        total = [[a + b for a, b in zip(row, more, strict=True)] for row, more in zip(total, term, strict=True)]
    return total


def _product(first: Rows, second: Rows) -> Rows:
    answer = []
    for row in first:
        used = [(k, item) for k, item in enumerate(row) if item]
        answer.append([sum((item * second[k][j] for k, item in used), Decimal(0)) for j in range(len(second[0]))])
    return answer
