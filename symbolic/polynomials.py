"""Polynomials of several variables as CasADi expressions with few operations."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import casadi as ca
import numpy as np

Exponents = tuple[int, ...]


def polynomials(rows: Sequence[Mapping[Exponents, ca.SX]], variables: ca.SX) -> ca.SX:
    """Return polynomials, nested in the manner of Horner or as sums of shared monomials, whichever takes less.

    Parameters
    ----------
    rows : sequence of dict
        For each polynomial, exponents of the variables -> coefficient.
    variables : casadi.SX, shape (r, 1)

    Returns
    -------
    casadi.SX, shape (len(rows), 1)

    Notes
    -----
    A greedy nesting (Ceberio and Kreinovich, "Greedy algorithms for optimizing multivariate Horner schemes", 2004): what all
    terms share comes out, then the terms with the variable that most of them have are nested by themselves. Powers are
    formed once for all rows.
    """
    candidates = []
    for nested in (True, False):
        powers = _Powers(variables)
        made = [_nested(dict(row), powers) if nested else _summed(row, powers) for row in rows]
        whole = ca.vertcat(ca.SX(0, 1), *made)
        symbols = ca.symvar(whole)
        candidates.append((ca.Function("cost", symbols, [whole]).n_instructions(), whole))
    return min(candidates, key=lambda item: item[0])[1]


class _Powers:
    """Monomials of the variables, each made of two that are there already."""

    def __init__(self, variables: ca.SX):
        size = variables.numel()
        self._known: dict[Exponents, ca.SX] = {
            tuple(map(int, np.eye(size, dtype=int)[i])): variables[i] for i in range(size)
        }

    def of(self, exponents: Exponents) -> ca.SX:
        """Return a monomial; one where all exponents are zero."""
        if not any(exponents):
            return ca.SX(1)
        if exponents not in self._known:
            first, second = self._split(exponents)
            self._known[exponents] = self.of(first) * self.of(second)
        return self._known[exponents]

    def _split(self, exponents: Exponents) -> tuple[Exponents, Exponents]:
        """Return the two factors of a monomial: the largest known one and the rest, or halves of a power."""
        single = [i for i, power in enumerate(exponents) if power]
        if len(single) == 1:
            half = exponents[single[0]] // 2
            part = tuple(half if i == single[0] else 0 for i in range(len(exponents)))
        else:
            inside = [item for item in self._known if all(a <= b for a, b in zip(item, exponents, strict=True))]
            part = max(inside, key=lambda item: (sum(item), item))
        return part, tuple(b - a for a, b in zip(part, exponents, strict=True))


def _summed(row: Mapping[Exponents, ca.SX], powers: _Powers) -> ca.SX:
    total = ca.SX(0)
    for exponents, value in sorted(row.items(), key=lambda item: (sum(item[0]), item[0])):
        total = total + value * powers.of(exponents)
    return total


def _nested(terms: dict[Exponents, ca.SX], powers: _Powers) -> ca.SX:
    if not terms:
        return ca.SX(0)
    shared = tuple(min(column) for column in zip(*terms, strict=True))
    rest = {tuple(a - b for a, b in zip(key, shared, strict=True)): value for key, value in terms.items()}
    if len(rest) == 1:
        return next(iter(rest.values())) * powers.of(shared)
    counts = [sum(1 for key in rest if key[i]) for i in range(len(shared))]
    chosen = counts.index(max(counts))
    inside = {key: value for key, value in rest.items() if key[chosen]}
    outside = {key: value for key, value in rest.items() if not key[chosen]}
    whole = _nested(outside, powers) + _nested(inside, powers)
    return powers.of(shared) * whole if any(shared) else whole
