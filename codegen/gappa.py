"""One question to Gappa: a value as the C computes it beside the same operations on real numbers.

Every operation has two names in a script: ``v7`` as rounded, ``e7`` exact. Own functions enter with the error that
`mathematics` states of them and, by the mean value theorem, with a derivative ``d7`` of which only the range is known.
"""

from __future__ import annotations

import math
import re
import subprocess
from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from .exported import tool
from .graph import Node
from .mathematics import ERROR_BOUNDS, LIMITS
from .style import Precision
from .tables import table_of

if TYPE_CHECKING:
    from .rounding import Piece

Interval = tuple[float, float]
Choice = dict[Node, bool]

_ARITHMETIC = {"add": "+", "sub": "-", "mul": "*", "div": "/"}
_STEPS = {"floor": "dn", "ceil": "up"}
_MOST_BRANCHES = 16
_PASSED_ON = frozenset(
    "add sub mul neg sqrt floor ceil fabs sin cos tan asin acos log sinh".split()
)  # fmt: skip
"""Operations that give infinity or NaN wherever an operand is one of them; a quotient does so for its numerator."""


class NotBounded(ValueError):  # noqa: N818 - it is an answer, not an error
    """There is no bound. The message says why."""


def largest(interval: Interval) -> float:
    """Return the largest magnitude in an interval."""
    return max(abs(interval[0]), abs(interval[1]))


def _resolved(piece: Piece, node: Node) -> Node:
    while node in piece.aliases:
        node = piece.aliases[node]
    return node


# ---------------------------------------------------------------------------------------------------------------------
# Branches


def branches(piece: Piece) -> list[Choice]:
    """Return every combination of decisions under which a piece is computed: condition -> whether it holds.

    Raises
    ------
    NotBounded
        If there are more than sixteen.
    """
    found: list[Choice] = []
    waiting: list[Choice] = [{}]
    while waiting:
        choice = waiting.pop()
        undecided = _undecided(piece, choice)
        if undecided is None:
            found.append(choice)
        else:
            waiting += [{**choice, undecided: False}, {**choice, undecided: True}]
        if len(found) + len(waiting) > _MOST_BRANCHES:
            raise NotBounded(f"more than {_MOST_BRANCHES} ways through its branches")
    return found


def _undecided(piece: Piece, choice: Choice) -> Node | None:
    seen: set[Node] = set()
    stack = [piece.node]
    while stack:
        node = _resolved(piece, stack.pop())
        if node in seen:
            continue
        seen.add(node)
        if node.operation == "select":
            condition = node.arguments[0]
            if condition not in choice and not _is_number_test(condition):
                return condition
            stack.append(_taken(node, choice))
        else:
            stack += reversed(node.arguments)
    return None


def _is_number_test(condition: Node) -> bool:
    """Whether a condition asks if a value is a number: all are, where a result is accepted."""
    return condition.operation == "eq" and condition.arguments[0] is condition.arguments[1]


def _taken(node: Node, choice: Choice) -> Node:
    condition, first, second = node.arguments
    return first if _is_number_test(condition) or choice[condition] else second


def _is_an_extreme(piece: Piece, node: Node) -> bool:
    """Whether a selection is the smaller or larger of the compared values: then no error is made by a wrong choice."""
    condition, first, second = node.arguments
    if condition.operation not in ("lt", "le", "ge"):
        return False
    while second.operation == "select" and _is_number_test(second.arguments[0]):
        second = second.arguments[1]
    return {first, second} <= set(condition.arguments)


# ---------------------------------------------------------------------------------------------------------------------
# What own functions do


def _wider(low: float, high: float) -> Interval:
    """Return an interval that holds the true ends: those of the C library are right to an ulp or two."""
    return low - abs(low) * 1e-12 - 1e-300, high + abs(high) * 1e-12 + 1e-300


def _monotone(function: Callable[[float], float], at: Interval) -> Interval:
    first, second = function(at[0]), function(at[1])
    return _wider(min(first, second), max(first, second))


def _slopes(name: str, at: Interval) -> tuple[Interval, Interval]:
    """Return the range of a function of one argument, and that of its derivative, over an interval.

    Raises
    ------
    NotBounded
        If the derivative has no bound there.
    """
    low, high = at
    match name:
        case "sin" | "cos":
            return (-1.0, 1.0), (-1.0, 1.0)
        case "tanh":
            return (-1.0, 1.0), (0.0, 1.0)
        case "atan":
            return _monotone(math.atan, at), (0.0, 1.0)
        case "exp" if high < 700:
            values = _monotone(math.exp, at)
            return values, values
        case "sinh" if largest(at) < 700:
            return _monotone(math.sinh, at), _wider(1.0, math.cosh(largest(at)))
        case "cosh" if largest(at) < 700:
            return _wider(1.0, math.cosh(largest(at))), _monotone(math.sinh, at)
        case "log" if low > 0:
            return _monotone(math.log, at), _wider(1.0 / high, 1.0 / low)
        case "tan" if largest(at) < 1.57:
            values = _monotone(math.tan, at)
            return values, _wider(1.0, 1.0 + largest(values) ** 2)
        case "asin" | "acos" if largest(at) < 1.0:
            steep = 1.0 / math.sqrt((1.0 - largest(at)) * (1.0 + largest(at)))
            rises = _wider(1.0, steep)
            return _monotone(getattr(math, name), at), rises if name == "asin" else (-rises[1], -rises[0])
    raise NotBounded(f"{name} of something between {low:.3g} and {high:.3g}")


def _product(first: Interval, second: Interval) -> Interval:
    ends = [a * b for a in first for b in second]
    return _wider(min(ends), max(ends))


def _slopes_of_pow(base: Interval, exponent: Interval) -> tuple[Interval, Interval, Interval]:
    """Return the range of a power of a positive base, and those of its derivatives by base and exponent."""
    said = f"pow of a base between {base[0]:.3g} and {base[1]:.3g}"
    if base[0] <= 0:
        raise NotBounded(said)
    try:
        powers = [x**y for x in base for y in exponent]  # monotone in each, so that the corners are the ends
        lower = [x ** (y - 1.0) for x in base for y in exponent]
    except OverflowError:
        raise NotBounded(said) from None
    values = _wider(min(powers), max(powers))
    by_exponent = _product(values, _monotone(math.log, base))
    return values, _product(exponent, _wider(min(lower), max(lower))), by_exponent


def _slopes_of_atan2(y: Interval, x: Interval) -> tuple[Interval, Interval, Interval]:
    """Return the range of atan2 right of the origin, and those of its derivatives by y and by x."""
    if x[0] <= 0:
        raise NotBounded(f"atan2 where the second argument is between {x[0]:.3g} and {x[1]:.3g}")
    steep = _wider(0.0, 1.0 / x[0])
    return _wider(-1.5707963267948968, 1.5707963267948968), (0.0, steep[1]), (-steep[1] / 2.0, steep[1] / 2.0)


# ---------------------------------------------------------------------------------------------------------------------
# The script


class Gappa:
    """The definitions, hypotheses and hints of one piece on one branch.

    Parameters
    ----------
    piece : Piece
        What is asked about.
    precision : Precision
        Of the C.
    choice : dict
        Condition -> whether it holds, of every branch it depends on.
    defaults : bool
        Whether parameters are at their defaults.
    mathematics : {"own", "libm"}
        Whose functions are called.
    seconds : float
        How long each question may take.
    """

    def __init__(
        self,
        piece: Piece,
        precision: Precision,
        choice: Choice,
        *,
        defaults: bool = False,
        mathematics: str = "own",
        seconds: float = 20.0,
    ):
        self.piece, self.precision, self.choice = piece, precision, choice
        self.defaults, self.mathematics, self.seconds = defaults, mathematics, seconds
        self.info = np.finfo(precision.dtype)
        self.lines = [f"@rnd = float<{'ieee_32' if precision.is_float else 'ieee_64'},ne>;"]
        self.hypotheses: list[str] = []
        self.hints: list[str] = []
        self.notes: list[str] = []
        self.names: dict[Node, tuple[str, str]] = {}
        self.unknown: list[str] = []
        self.divisors: list[tuple[str, str]] = []
        self.limits: dict[str, float] = {}
        self.order = list(self._ordered())
        for node in self.order:
            self._define(node)
        self._judgements()

    # -- definitions --------------------------------------------------------------------------------------------------

    def _ordered(self) -> Iterator[Node]:
        """Yield all values that the piece is computed from, operands first."""
        done: set[Node] = set()
        stack = [self.piece.node]
        while stack:
            node = stack[-1]
            if node in done:
                stack.pop()
                continue
            waiting = [item for item in self._operands(node) if item not in done]
            if waiting:
                stack += reversed(waiting)
                continue
            stack.pop()
            done.add(node)
            yield node

    def _operands(self, node: Node) -> tuple[Node, ...]:
        if node in self.piece.aliases:
            return (self.piece.aliases[node],)
        if node.operation == "select":
            return (_taken(node, self.choice),)
        return node.arguments

    def _define(self, node: Node) -> None:
        operands = [self.names[item] for item in self._operands(node)]
        number = len(self.names)
        rounded, exact = f"v{number}", f"e{number}"
        operation = node.operation
        if node in self.piece.aliases or operation == "select":
            if operation == "select" and not _is_an_extreme(self.piece, node):
                self.notes.append("the branch as the C takes it")
            self.names[node] = operands[0]
            return
        if operation == "const":
            value = float(self.precision.dtype(node.value))
            self.names[node] = (value.hex(), float(node.value).hex())
            return
        self.names[node] = (rounded, exact)
        if operation == "load":
            self._read(node, rounded)
        elif operation in _ARITHMETIC:
            sign = _ARITHMETIC[operation]
            self.lines.append(f"{rounded} = rnd({operands[0][0]} {sign} {operands[1][0]});")
            self.lines.append(f"{exact} = {operands[0][1]} {sign} {operands[1][1]};")
            if operation == "div":
                self._quotient(operands, exact)
        elif operation == "neg":
            self.lines += [f"{rounded} = -{operands[0][0]};", f"{exact} = -{operands[0][1]};"]
        elif operation == "sqrt":
            self.lines += [f"{rounded} = rnd(sqrt({operands[0][0]}));", f"{exact} = sqrt({operands[0][1]});"]
        elif operation in _STEPS:
            self.lines.append(f"{rounded} = int<{_STEPS[operation]}>({operands[0][0]});")
            self.names[node] = (rounded, rounded)
            self.notes.append(f"{operation} as the C takes it")
        elif operation == "fabs":
            self.lines.append(f"{rounded} = |{operands[0][0]}|;")
            self._related(number, rounded, [(f"d{number}", *operands[0], (-1.0, 1.0))])
        else:
            self._function(node, number, operands)

    def _read(self, node: Node, rounded: str) -> None:
        leaf = self.piece.leaves[node]
        self.lines.append(f"{rounded} = rnd(x{rounded[1:]});  # {leaf.name}")
        self.names[node] = (rounded, rounded)
        if leaf.default is not None and self.defaults:
            self._within(rounded, (leaf.default, leaf.default))
        elif leaf.interval is not None:
            self._within(rounded, leaf.interval)
        else:
            self.unknown.append(leaf.name)

    def _quotient(self, operands: Sequence[tuple[str, str]], exact: str) -> None:
        """Say how the errors of both operands make that of a quotient; Gappa does not see it by itself."""
        (a, exact_a), (b, exact_b) = operands
        self.divisors.append((b, exact_b))
        if a != exact_a or b != exact_b:
            self.hints.append(
                f"{a} / {b} - {exact} -> ({a} - {exact_a}) / {b} - {exact} * (({b} - {exact_b}) / {b}) "
                f"{{ {b} <> 0, {exact_b} <> 0 }};"
            )

    def _within(self, name: str, interval: Interval) -> None:
        low, high = interval
        if math.isinf(high):
            self.hypotheses.append(f"{name} >= {low.hex()}")
        elif math.isinf(low):
            self.hypotheses.append(f"{name} <= {high.hex()}")
        else:
            self.hypotheses.append(f"{name} in [{low.hex()},{high.hex()}]")

    def _related(self, number: int, value: str, by: Sequence[tuple[str, str, str, Interval]]) -> None:
        """Define the exact result from that of the rounded arguments, by (derivative, rounded, exact, its range)."""
        change = " + ".join(f"{slope} * ({a} - {exact_a})" for slope, a, exact_a, _ in by)
        exact = f"e{number}"
        self.lines.append(f"{exact} = {value} - ({change});")
        for slope, _, _, interval in by:
            self._within(slope, interval)
        if value.startswith("t"):
            self.hints.append(f"v{number} - {exact} -> (v{number} - {value}) + ({change});")
        else:
            self.hints.append(f"v{number} - {exact} -> {change};")

    def _function(self, node: Node, number: int, operands: Sequence[tuple[str, str]]) -> None:
        name = node.operation
        if name == "look_up":
            self._table(node, number, operands[0])
            return
        if name == "look_up_slope":
            raise NotBounded("the slope of a table jumps at its breakpoints")
        if name not in ERROR_BOUNDS[self.precision.name]:
            raise NotBounded(f"{name} is not a number's operation")
        if self.mathematics != "own":
            raise NotBounded(f"{name} of the C library, whose error nobody states")
        rounded, true = f"v{number}", f"t{number}"
        if name in ("sin", "cos", "tan"):
            self.limits[operands[0][0]] = LIMITS[self.precision.name]
        hulls = [(-math.inf, math.inf)] if name in ("sin", "cos", "tanh") else self._hulls(name, operands)
        if name == "atan2":
            values, *slopes = _slopes_of_atan2(hulls[0], hulls[1])
        elif name == "pow":
            values, *slopes = _slopes_of_pow(hulls[0], hulls[1])
        else:
            values, slope = _slopes(name, hulls[0])
            slopes = [slope]
        self.lines.append(f"{rounded} = rnd(x{number});  # {name}")
        self._related(
            number,
            true,
            [(f"d{number}" if k == 0 else f"c{number}", *operands[k], slope) for k, slope in enumerate(slopes)],
        )
        self._within(true, values)
        self._within(f"e{number}", values)
        error = self._own_error(name, values)
        self._within(f"{rounded} - {true}", (-error, error))
        if min(abs(values[0]), abs(values[1])) > float(self.info.tiny) and values[0] * values[1] > 0:
            part = ERROR_BOUNDS[self.precision.name][name] * float(self.info.eps)
            self.hypotheses.append(f"{rounded} -/ {true} in [{(-part).hex()},{part.hex()}]")

    def _table(self, node: Node, number: int, x: tuple[str, str]) -> None:
        """Enter a look-up: values within those of the table, slopes too, and an error that the table states."""
        table = table_of(node.arguments)
        rounded, true = f"v{number}", f"t{number}"
        values = (min(table.values), max(table.values))
        self.lines.append(f"{rounded} = rnd(x{number});  # look_up")
        self._related(number, true, [(f"d{number}", *x, (min(table.slopes), max(0.0, *table.slopes)))])
        self._within(true, values)
        self._within(f"e{number}", values)
        error = table.rounding(float(self.info.epsneg))
        self._within(f"{rounded} - {true}", (-error, error))

    def _own_error(self, name: str, values: Interval) -> float:
        """Return the largest error of an own function, from its bound in units in the last place of the true value."""
        bound = ERROR_BOUNDS[self.precision.name][name]
        if name in ("sin", "cos", "tanh"):  # 1 is reached by the cosine of 0 only, which is exact
            return bound * float(self.info.epsneg)
        return bound * float(np.spacing(self.precision.dtype(largest(values))))

    def _hulls(self, name: str, operands: Sequence[tuple[str, str]]) -> list[Interval]:
        """Ask where arguments lie, as rounded and exact."""
        terms = [term for pair in operands for term in pair]
        found = self.ask([f"{term} in ?" for term in dict.fromkeys(terms) if not _is_number(term)])
        hulls = []
        for pair in operands:
            ends: list[Fraction] = []
            for term in pair:
                if _is_number(term):
                    ends.append(Fraction(float.fromhex(term)))
                elif found is None or term not in found:
                    raise NotBounded(f"{name} of something without a bound{self._because()}")
                else:
                    ends += found[term]
            hulls.append((_down(min(ends)), _up(max(ends))))
        return hulls

    def _judgements(self) -> None:
        """Add what is judged in the same call, and what the decisions say of constants."""
        for node, low, high in self.piece.facts:
            node = _resolved(self.piece, node)
            if node in self.names and node.operation != "const":
                self._within(self.names[node][0], (low, high))
        for condition, holds in self.choice.items():
            if condition.operation not in ("lt", "le", "ge"):
                continue
            if not all(item in self.names or item.operation == "const" for item in condition.arguments):
                continue
            left, right = [
                self.names[item][0] if item in self.names else float(self.precision.dtype(item.value)).hex()
                for item in condition.arguments
            ]
            below = holds != (condition.operation == "ge")
            self.hypotheses.append(f"{left} - {right} {'<=' if below else '>='} 0")

    # -- the question -------------------------------------------------------------------------------------------------

    @property
    def value(self) -> str:
        """The name of the result as rounded."""
        return self.names[self.piece.node][0]

    @property
    def error(self) -> str:
        """The term that is the error."""
        return " - ".join(self.names[self.piece.node])

    def goals(self) -> list[str]:
        """Return what is asked: the error, and the range of the value."""
        return [f"{self.error} in ?", f"{self.value} in ?"]

    def _stays_within_limits(self) -> bool:
        """Whether nothing on the way overflows, or is beyond what a function takes; true where no input comes here.

        Asked of the rounded values alone, which is quick.
        """
        limits = {self.names[node][0]: float(self.info.max) for node in self._may_overflow()}
        limits = {term: most for term, most in {**limits, **self.limits}.items() if not _is_number(term)}
        if not limits:
            return True
        lines = [line for line in self.lines if not line.startswith("e")]
        given = [item for item in self.hypotheses if not re.match(r"[cde]\d", item)]
        text = "\n".join([*lines, _question(given, [f"{term} in ?" for term in limits])]) + "\n"
        found = answers(text, self.seconds)
        if found is None:
            return True
        return all(term in found and max(-found[term][0], found[term][1]) <= most for term, most in limits.items())

    def _may_overflow(self) -> list[Node]:
        """Return results that could be infinite although the piece is accepted."""
        shown: set[Node] = set()
        if self.piece.judged:
            stack = [self.piece.node]
            while stack:
                node = stack.pop()
                if node in shown:
                    continue
                shown.add(node)
                if node.operation in _PASSED_ON or node in self.piece.aliases or node.operation == "select":
                    stack += self._operands(node)
                elif node.operation == "div":
                    stack.append(node.arguments[0])
        named: dict[str, Node] = {}
        for node in self.order:
            if node not in shown and node.operation not in ("const", "load", "neg", "select"):
                named.setdefault(self.names[node][0], node)
        return list(named.values())

    def text(self, goals: Sequence[str]) -> str:
        """Return the whole script for some goals."""
        return "\n".join([*self.lines, _question(self.hypotheses, goals), *self.hints]) + "\n"

    def ask(self, goals: Sequence[str]) -> dict[str, tuple[Fraction, Fraction]] | None:
        """Return what Gappa finds: term -> ends; nothing where the hypotheses exclude each other."""
        return answers(self.text(goals), self.seconds)

    def bounds(self) -> tuple[float, float, float] | None:
        """Return the largest error and the range of the value; nothing where no input takes this branch.

        Raises
        ------
        NotBounded
            If Gappa finds none.
        """
        if not self._stays_within_limits():
            beyond = "an intermediate value may overflow, or lie beyond what a function takes"
            raise NotBounded(self._reason() if self.unknown else beyond)
        found = self.ask(self.goals())
        if found is None:
            return None
        if self.error not in found or self.value not in found:
            raise NotBounded(self._reason())
        error, value = found[self.error], found[self.value]
        return _up(max(-error[0], error[1])), _down(value[0]), _up(value[1])

    def _because(self) -> str:
        return f": nothing says where {self.unknown[0]} lies" if self.unknown else ""

    def _reason(self) -> str:
        """Say why there is no bound."""
        if self.unknown:
            return f"nothing says where {', '.join(self.unknown)} lies"
        for pair in self.divisors:
            found = self.ask([f"{term} in ?" for term in dict.fromkeys(pair)]) or {}
            for term in pair:
                ends = found.get(term)
                if ends is None or ends[0] <= 0 <= ends[1]:
                    return "it divides by what may be zero"
        return "Gappa finds no bound"


def _question(given: Sequence[str], goals: Sequence[str]) -> str:
    hypotheses, asked = (" /\\\n  ".join(items) for items in (given, goals))
    return f"{{ {hypotheses}\n  ->\n  {asked} }}" if hypotheses else f"{{ {asked} }}"


def _is_number(term: str) -> bool:
    return term.startswith(("0x", "-0x"))


def _up(value: Fraction) -> float:
    """Return a float that is no smaller."""
    near = float(value)
    return near if Fraction(near) >= value else math.nextafter(near, math.inf)


def _down(value: Fraction) -> float:
    return -_up(-value)


_NUMBER = r"(-?\d+)(?:b(-?\d+))?(?: \{[^}]*\})?"
_RESULT = re.compile(rf"^  (\S.*) in \[{_NUMBER}, {_NUMBER}\]$", re.MULTILINE)


def answers(script: str, seconds: float) -> dict[str, tuple[Fraction, Fraction]] | None:
    """Run Gappa on a script.

    Returns
    -------
    dict or None
        Term -> both ends of what it lies in; terms without bounds are left out. None where the hypotheses exclude each
        other.

    Raises
    ------
    NotBounded
        If there is no answer in time.
    RuntimeError
        If it does not understand the script.
    """
    program = tool("gappa")
    try:
        done = subprocess.run([program], input=script, capture_output=True, text=True, check=False, timeout=seconds)
    except subprocess.TimeoutExpired:
        raise NotBounded(f"Gappa found none within {seconds:g} s") from None
    said = done.stdout + done.stderr
    if "anything can be proved" in said:
        return None
    if done.returncode and "properties were not satisfied" not in said:
        raise RuntimeError(f"gappa ended with {done.returncode}: {said.strip()[:500]}")
    return {match[1]: (_dyadic(match[2], match[3]), _dyadic(match[4], match[5])) for match in _RESULT.finditer(said)}


def _dyadic(mantissa: str, exponent: str | None) -> Fraction:
    return Fraction(int(mantissa)) * Fraction(2) ** int(exponent or 0)
