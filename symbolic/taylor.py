"""Truncated Taylor arithmetic in several variables: what a function of power series is, exactly, degree by degree.

Every rule of automatic differentiation in one variable (Griewank and Walther, "Evaluating Derivatives", 2008, section 13.2)
holds for homogeneous parts in several variables too, once d/dt is replaced by the radial derivative sum_i w_i d/dw_i, which
is a derivation and multiplies a part of degree d by d. No difference quotient is taken anywhere.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from itertools import combinations_with_replacement

import numpy as np
from numpy.typing import NDArray

from .errors import ModelError
from .expressions import KINKS, Tape

Array = NDArray[np.float64]
Part = Array | None
"""Coefficients of a homogeneous polynomial; None where it is zero."""

NOT_ANALYTIC = KINKS | {"and", "or", "not"}
"""Operations that no power series describes."""


class NotAnalyticError(Exception):
    """A function has no power series where it is looked at; the text says why."""


class Monomials:
    """The monomials w^a in r variables, degree by degree, in graded lexicographic order: w1^k, w1^(k-1) w2, ...

    Parameters
    ----------
    variables : int
        r.
    order : int
        Highest degree.

    Examples
    --------
    >>> from plantc.symbolic.taylor import Monomials
    >>> Monomials(2, 2).exponents[2].tolist()
    [[2, 0], [1, 1], [0, 2]]
    """

    def __init__(self, variables: int, order: int):
        self.variables, self.order = variables, order
        self.exponents: list[NDArray[np.int64]] = []
        self._index: list[dict[tuple[int, ...], int]] = []
        self._tables: dict[tuple[int, int], NDArray[np.int64]] = {}
        for degree in range(order + 1):
            chosen = list(combinations_with_replacement(range(variables), degree))
            table = np.zeros((len(chosen), variables), dtype=np.int64)
            for row, factors in enumerate(chosen):
                for factor in factors:
                    table[row, factor] += 1
            self.exponents.append(table)
            self._index.append({tuple(item): row for row, item in enumerate(table.tolist())})

    def count(self, degree: int) -> int:
        """Return how many monomials of a degree there are: C(r + k - 1, k)."""
        return len(self.exponents[degree])

    def place(self, exponents: Sequence[int]) -> int:
        """Return the position of a monomial among those of its degree."""
        return self._index[sum(exponents)][tuple(exponents)]

    def product(self, i: int, a: Array, j: int, b: Array) -> Array:
        """Return the coefficients, of degree i + j, of the product of two homogeneous polynomials of degrees i and j."""
        if (i, j) not in self._tables:
            own = self._index[i + j]
            sums = self.exponents[i][:, None, :] + self.exponents[j][None, :, :]
            flat = [own[tuple(item)] for item in sums.reshape(-1, self.variables).tolist()]
            self._tables[i, j] = np.array(flat, dtype=np.int64)
        weights = (a[:, None] * b[None, :]).ravel()
        return np.asarray(np.bincount(self._tables[i, j], weights, self.count(i + j)), dtype=np.float64)

    def slopes(self, degree: int, coefficients: Array) -> Array:
        """Return the partial derivatives of homogeneous polynomials.

        Parameters
        ----------
        degree : int
            Of the polynomials, at least 1.
        coefficients : ndarray, shape (n, monomials of that degree)
            A polynomial in each row.

        Returns
        -------
        ndarray, shape (n, r, monomials of the degree below)
        """
        answer = np.zeros((len(coefficients), self.variables, self.count(degree - 1)))
        for column, own in enumerate(self.exponents[degree].tolist()):
            for i, power in enumerate(own):
                if power:
                    own[i] -= 1
                    answer[:, i, self.place(own)] += power * coefficients[:, column]
                    own[i] += 1
        return answer

    def values(self, degree: int, w: Array) -> Array:
        """Return each monomial of a degree at a point w (r,)."""
        return np.asarray(np.prod(np.asarray(w, dtype=float)[None, :] ** self.exponents[degree], axis=1))


class Series:
    """A power series cut off after a degree: one `Part` for each degree from 0.

    Parameters
    ----------
    monomials : Monomials
        Of at least that degree.
    parts : list of Part
        Coefficients; the last entry is of the highest degree kept.
    """

    def __init__(self, monomials: Monomials, parts: Sequence[Part]):
        self.monomials = monomials
        self.parts: list[Part] = [None if part is None or not np.any(part) else part for part in parts]

    @classmethod
    def constant(cls, monomials: Monomials, value: float, order: int) -> Series:
        """Return a number as a series."""
        return cls(monomials, [np.array([float(value)]), *[None] * order])

    @property
    def value(self) -> float:
        """The part of degree zero."""
        return 0.0 if self.parts[0] is None else float(self.parts[0][0])

    @property
    def order(self) -> int:
        """The highest degree kept."""
        return len(self.parts) - 1

    @property
    def is_constant(self) -> bool:
        """Whether nothing but the part of degree zero is there."""
        return all(part is None for part in self.parts[1:])

    def part(self, degree: int) -> Array:
        """Return the coefficients of a degree, zeros included."""
        own = self.parts[degree]
        return np.zeros(self.monomials.count(degree)) if own is None else own

    def _made(self, parts: Sequence[Part]) -> Series:
        return Series(self.monomials, parts)

    def _number(self, value: float) -> Series:
        return Series.constant(self.monomials, value, self.order)

    def scaled(self, factor: float) -> Series:
        """Return the series times a number."""
        return self._made([None if part is None else factor * part for part in self.parts])

    def __neg__(self) -> Series:
        return self.scaled(-1.0)

    def __add__(self, other: Series) -> Series:
        return self._made([_sum([a, b]) for a, b in zip(self.parts, other.parts, strict=True)])

    def __sub__(self, other: Series) -> Series:
        return self + (-other)

    def __mul__(self, other: Series) -> Series:
        return self._made([_convolved(self, other, degree) for degree in range(self.order + 1)])

    def __truediv__(self, other: Series) -> Series:
        if other.value == 0:
            raise NotAnalyticError("divides by zero")
        answer = self._made([None] * (self.order + 1))
        for degree in range(self.order + 1):
            known = _convolved(other, answer, degree, 1)
            answer.parts[degree] = _scaled(_sum([self.parts[degree], _scaled(known, -1.0)]), 1.0 / other.value)
        return answer

    def radial(self) -> Series:
        """Return sum_i w_i d/dw_i of the series: each part times its degree."""
        return self._made([None if part is None else degree * part for degree, part in enumerate(self.parts)])

    def primitive(self, value: float, factor: Callable[[Series, int], Part]) -> Series:
        """Return z with z(0) = value and radial(z) = q radial(self).

        Parameters
        ----------
        value : float
            z(0).
        factor : callable
            (z as far as it is known, degree) -> the part of q of that degree.
        """
        z = self._number(value)
        slope, q = self.radial(), self._made([None] * (self.order + 1))
        for degree in range(1, self.order + 1):
            q.parts[degree - 1] = factor(z, degree - 1)
            z.parts[degree] = _scaled(_convolved(slope, q, degree, 1), 1.0 / degree)
        return z

    def power(self, exponent: float) -> Series:
        """Return the series to a constant power; a whole power from 0 on of any series, others of what is not zero."""
        if exponent == int(exponent) and 0 <= exponent <= 64:
            return self._whole_power(int(exponent))
        a = self.value
        if a == 0 or (a < 0 and exponent != int(exponent)):
            raise NotAnalyticError(f"takes the power {exponent:g} of {a:g}")
        z = self._number(a**exponent)
        for degree in range(1, self.order + 1):
            terms: list[Part] = []
            for j in range(1, degree + 1):
                product = _times(self.monomials, j, self.parts[j], degree - j, z.parts[degree - j])
                terms.append(_scaled(product, exponent * j - (degree - j)))
            z.parts[degree] = _scaled(_sum(terms), 1.0 / (degree * a))
        return z

    def _whole_power(self, exponent: int) -> Series:
        answer, square = self._number(1.0), self
        while exponent:
            if exponent & 1:
                answer = answer * square
            exponent >>= 1
            square = square * square if exponent else square
        return answer


def _times(monomials: Monomials, i: int, a: Part, j: int, b: Part) -> Part:
    return None if a is None or b is None else monomials.product(i, a, j, b)


def _scaled(part: Part, factor: float) -> Part:
    return None if part is None or factor == 0 else factor * part


def _sum(parts: Sequence[Part]) -> Part:
    """Return the sum of parts of one degree; exactly zero is None."""
    present = [part for part in parts if part is not None]
    if not present:
        return None
    total = sum(present[1:], present[0])
    return total if np.any(total) else None


def _convolved(a: Series, b: Series, degree: int, first: int = 0) -> Part:
    """Return the sum over j, from `first` on, of a_j b_(degree - j)."""
    return _sum([_times(a.monomials, j, a.parts[j], degree - j, b.parts[degree - j]) for j in range(first, degree + 1)])


# -- elementary functions ---------------------------------------------------------------------------------------------


def _known(q: Series) -> Callable[[Series, int], Part]:
    return lambda z, degree: q.parts[degree]


def _exp(a: Series) -> Series:
    return a.primitive(math.exp(a.value), lambda z, degree: z.parts[degree])


def _log(a: Series) -> Series:
    if a.value <= 0:
        raise NotAnalyticError(f"takes the logarithm of {a.value:g}")
    return a.primitive(math.log(a.value), _known(a.power(-1.0)))


def _sqrt(a: Series) -> Series:
    if a.value <= 0:
        raise NotAnalyticError(f"takes the square root of {a.value:g}, where it has no derivative")
    return a.power(0.5)


def _pair(a: Series, odd: float, even: float, sign: float) -> tuple[Series, Series]:
    """Return (sin, cos), or with sign 1 (sinh, cosh): s' = c a', c' = sign s a'."""
    s, c = a._number(odd), a._number(even)
    slope = a.radial()
    for degree in range(1, a.order + 1):
        s.parts[degree] = _scaled(_convolved(slope, c, degree, 1), 1.0 / degree)
        c.parts[degree] = _scaled(_convolved(slope, s, degree, 1), sign / degree)
    return s, c


def _circular(a: Series) -> tuple[Series, Series]:
    return _pair(a, math.sin(a.value), math.cos(a.value), -1.0)


def _hyperbolic(a: Series) -> tuple[Series, Series]:
    return _pair(a, math.sinh(a.value), math.cosh(a.value), 1.0)


def _with_square(sign: float) -> Callable[[Series, int], Part]:
    """Return the part of 1 + sign z^2: the derivative of tan (1) and tanh (-1)."""

    def factor(z: Series, degree: int) -> Part:
        square = _scaled(_convolved(z, z, degree), sign)
        return _sum([np.array([1.0]), square]) if degree == 0 else square

    return factor


def _arc(a: Series, name: str, value: Callable[[float], float], sign: float) -> Series:
    if not abs(a.value) < 1:
        raise NotAnalyticError(f"takes {name} of {a.value:g}, where it has no derivative")
    return a.primitive(value(a.value), _known((a._number(1.0) - a * a).power(-0.5).scaled(sign)))


def _atan2(y: Series, x: Series) -> Series:
    if x.value == 0 and y.value == 0:
        raise NotAnalyticError("takes atan2 of (0, 0)")
    if y.value == 0 and x.value < 0:
        raise NotAnalyticError(f"takes atan2 of (0, {x.value:g}), where it jumps")
    slope = (x * y.radial() - y * x.radial()) / (x * x + y * y)
    parts = [None if part is None or degree == 0 else part / degree for degree, part in enumerate(slope.parts)]
    return y._made([np.array([math.atan2(y.value, x.value)]), *parts[1:]])


def _pow(a: Series, b: Series) -> Series:
    if b.is_constant:
        return a.power(b.value)
    if a.value <= 0:
        raise NotAnalyticError(f"takes {a.value:g} to a power that varies")
    return _exp(b * _log(a))


_RULES: dict[str, Callable[..., Series]] = {
    "add": lambda a, b: a + b,
    "sub": lambda a, b: a - b,
    "mul": lambda a, b: a * b,
    "div": lambda a, b: a / b,
    "neg": lambda a: -a,
    "inv": lambda a: a._number(1.0) / a,
    "sq": lambda a: a * a,
    "twice": lambda a: a.scaled(2.0),
    "sqrt": _sqrt,
    "sin": lambda a: _circular(a)[0],
    "cos": lambda a: _circular(a)[1],
    "tan": lambda a: a.primitive(math.tan(a.value), _with_square(1.0)),
    "asin": lambda a: _arc(a, "asin", math.asin, 1.0),
    "acos": lambda a: _arc(a, "acos", math.acos, -1.0),
    "atan": lambda a: a.primitive(math.atan(a.value), _known((a._number(1.0) + a * a).power(-1.0))),
    "atan2": _atan2,
    "sinh": lambda a: _hyperbolic(a)[0],
    "cosh": lambda a: _hyperbolic(a)[1],
    "tanh": lambda a: a.primitive(math.tanh(a.value), _with_square(-1.0)),
    "exp": _exp,
    "log": _log,
    "pow": _pow,
}


def apply(operation: str, *arguments: Series) -> Series:
    """Return what an operation of a tape makes of series.

    Raises
    ------
    NotAnalyticError
        If it has no power series there; the text says what it does, as in "divides by zero".
    """
    if operation not in _RULES:
        raise NotAnalyticError(f"uses {'if_else' if operation == 'if_else_zero' else operation}")
    try:
        answer = _RULES[operation](*arguments)
    except OverflowError:
        raise NotAnalyticError(f"overflows in {operation}") from None
    if not all(part is None or np.all(np.isfinite(part)) for part in answer.parts):
        raise NotAnalyticError(f"overflows in {operation}")
    return answer


def compose(record: Tape, inputs: Sequence[Sequence[Series]], owner: str, equations: Sequence[str]) -> list[Series]:
    """Return the series of the first output of a tape whose inputs are series.

    Parameters
    ----------
    record : Tape
        Operations; its first output dense.
    inputs : sequence of sequence of Series
        For each argument, one for each element; all of one order.
    owner : str
        To complain about.
    equations : sequence of str
        What each element of the output is, as in "the rate of theta".

    Raises
    ------
    ModelError
        If an operation has no power series there; the sentence names it and the equation.
    """
    order = next(item.order for group in inputs for item in group)
    monomials = next(item.monomials for group in inputs for item in group)
    values: list[Series] = []
    for place, step in enumerate(record.steps):
        if step.operation == "input":
            values.append(inputs[step.place[0]][step.place[1]])
        elif step.operation == "const":
            values.append(Series.constant(monomials, step.value, order))
        else:
            try:
                values.append(apply(step.operation, *[values[item] for item in step.arguments]))
            except NotAnalyticError as error:
                advice = (
                    "write it with what is smooth there (a tanh for a switch)"
                    if step.operation in NOT_ANALYTIC
                    else "move the operating point"
                )
                raise ModelError(
                    f"{owner}: {_user(record, place, equations)} {error} at the operating point, where it has no power "
                    f"series; {advice}"
                ) from None
    return [values[item] for item in record.outputs[0]]


def _user(record: Tape, place: int, equations: Sequence[str]) -> str:
    """Return the first equation that needs a step."""
    for root, equation in zip(record.outputs[0], equations, strict=True):
        reached, stack = set(), [root]
        while stack:
            item = stack.pop()
            if item not in reached:
                reached.add(item)
                stack.extend(record.steps[item].arguments)
        if place in reached:
            return equation
    raise AssertionError("a step that no output needs")
