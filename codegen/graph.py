"""A hash-consed graph of scalar operations: what CasADi tapes and kernels become before they are printed.

Simplifications are those exact in floating point. Sums are never re-ordered and quotients never cancelled, so that a
numerically stable form stays as it was written.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from ..symbolic.expressions import Tape

Key = tuple[Any, ...]

_FOLD: dict[str, Callable[..., float]] = {
    "add": lambda a, b: a + b,
    "sub": lambda a, b: a - b,
    "mul": lambda a, b: a * b,
    "neg": lambda a: -a,
    "sqrt": math.sqrt,
    "fabs": abs,
}

BOOLEAN = frozenset({"lt", "le", "eq", "ne", "and", "or", "not", "ge"})
_COMMUTATIVE = frozenset({"add", "mul"})


class Node:
    """One value. Build nodes with arithmetic on other nodes; equal nodes are the same object.

    Attributes
    ----------
    operation : str
        ``const``, ``load``, or an arithmetic operation.
    arguments : tuple of Node
        Operands.
    value : float
        Of a constant.
    element : tuple
        Of a load: (place, index, version).
    hint : str
        Name it should have in the C; empty if any will do.
    """

    __slots__ = ("arguments", "element", "graph", "hint", "number", "operation", "value")

    def __init__(
        self,
        graph: Graph,
        operation: str,
        arguments: tuple[Node, ...],
        value: float,
        element: tuple[Any, ...],
        number: int,
    ):
        self.graph, self.operation, self.arguments = graph, operation, arguments
        self.value, self.element, self.number = value, element, number
        self.hint = ""

    @property
    def is_boolean(self) -> bool:
        """Whether its C type is bool."""
        return self.operation in BOOLEAN

    def is_const(self, value: float) -> bool:
        """Whether it is this constant."""
        return self.operation == "const" and self.value == value

    def named(self, hint: str) -> Node:
        """Ask for a name in the C."""
        if self.operation not in ("const", "load") and not self.hint:
            self.hint = hint
        return self

    def reciprocal_above(self, limit: float) -> Node:
        """Return 1 / self, or 1 where self is below the limit (such a result is refused later)."""
        graph = self.graph
        enough = graph.make("ge", self, graph.const(limit))
        return graph.make("div", graph.const(1.0), graph.make("select", enough, self, graph.const(1.0)))

    def reciprocal(self) -> Node:
        """Return 1 / self, infinite of zero."""
        return self.graph.make("div", self.graph.const(1.0), self)

    def positive_part(self) -> Node:
        """Return self, or 0 where it is negative; NaN stays."""
        return self.at_least(0.0)

    def at_least(self, low: float) -> Node:
        """Return self, or a number where self is below it; NaN stays."""
        graph = self.graph
        return graph.make("select", graph.make("lt", self, graph.const(low)), graph.const(low), self)

    def __add__(self, other: Node) -> Node:
        return self.graph.make("add", self, other)

    def __sub__(self, other: Node) -> Node:
        return self.graph.make("sub", self, other)

    def __mul__(self, other: Node) -> Node:
        return self.graph.make("mul", self, other)

    def __neg__(self) -> Node:
        return self.graph.make("neg", self)


@dataclass
class Graph:
    """The nodes of one C function."""

    def __post_init__(self) -> None:
        self._known: dict[Key, Node] = {}

    def _node(self, operation: str, arguments: tuple[Node, ...] = (), value: float = 0.0, element: Key = ()) -> Node:
        key = (operation, tuple(item.number for item in arguments), value, math.copysign(1.0, value), element)
        found = self._known.get(key)
        if found is None:
            found = Node(self, operation, arguments, value, element, len(self._known))
            self._known[key] = found
        return found

    def const(self, value: float) -> Node:
        """Return a constant."""
        return self._node("const", value=float(value))

    def load(self, place: Any, index: int, version: int) -> Node:
        """Return the value an element of a place has at a version of that place."""
        return self._node("load", element=(place, index, version))

    def make(self, operation: str, *arguments: Node) -> Node:
        """Return an operation on nodes, simplified where that is exact."""
        if operation in _FOLD and all(item.operation == "const" for item in arguments):
            folded = _FOLD[operation](*[item.value for item in arguments])
            if math.isfinite(folded):
                return self.const(folded)
        simple = getattr(self, f"_simple_{operation}", None)
        answer = simple(*arguments) if simple else None
        if answer is not None:
            return answer  # type: ignore[no-any-return]
        if operation in _COMMUTATIVE and arguments[0].number > arguments[1].number:
            arguments = (arguments[1], arguments[0])
        return self._node(operation, arguments)

    def _simple_add(self, a: Node, b: Node) -> Node | None:
        if a.is_const(0.0):
            return b
        if b.is_const(0.0):
            return a
        if b.operation == "neg" and not b.hint:  # one with a name of its own is used by that name
            return self.make("sub", a, b.arguments[0])
        if a.operation == "neg" and not a.hint:
            return self.make("sub", b, a.arguments[0])
        if a is b:
            return self.make("mul", self.const(2.0), a)
        return self._merged_branches(a, b)

    def _merged_branches(self, a: Node, b: Node) -> Node | None:
        """Join the two halves that CasADi makes of an if-else."""
        zero = self.const(0.0)
        if a.operation == b.operation == "select" and a.arguments[2] is zero and b.arguments[2] is zero:
            if b.arguments[0] is self.make("not", a.arguments[0]):
                return self._node("select", (a.arguments[0], a.arguments[1], b.arguments[1]))
            if a.arguments[0] is self.make("not", b.arguments[0]):
                return self._node("select", (b.arguments[0], b.arguments[1], a.arguments[1]))
        return None

    def _simple_sub(self, a: Node, b: Node) -> Node | None:
        if b.is_const(0.0):
            return a
        if a.is_const(0.0):
            return self.make("neg", b)
        if b.operation == "neg" and not b.hint:
            return self.make("add", a, b.arguments[0])
        return None

    def _simple_mul(self, a: Node, b: Node) -> Node | None:
        for one, other in ((a, b), (b, a)):
            if one.is_const(1.0):
                return other
            if one.is_const(-1.0):
                return self.make("neg", other)
            if one.is_const(0.0):
                return one
            if one.operation == "const" and one.value < 0:
                return self.make("neg", self.make("mul", self.const(-one.value), other))
        return None

    def _simple_neg(self, a: Node) -> Node | None:
        return a.arguments[0] if a.operation == "neg" else None

    def _simple_not(self, a: Node) -> Node | None:
        return a.arguments[0] if a.operation == "not" else None

    def _simple_div(self, a: Node, b: Node) -> Node | None:
        slope = self._slope_of_extreme(a, b)
        if slope is not None:
            return slope
        if b.operation == "const" and b.value != 0.0 and math.isfinite(1.0 / b.value):
            return self.make("mul", self.const(1.0 / b.value), a)
        if a.operation == "neg":
            return self.make("neg", self.make("div", a.arguments[0], b))
        return None

    def _slope_of_extreme(self, a: Node, b: Node) -> Node | None:
        """Return, without a division, CasADi's derivative of fmin and fmax: t / (t + u) with t = (p <= q), u = (q <= p)."""
        if b.operation != "add" or a not in b.arguments:
            return None
        other = b.arguments[0] if b.arguments[1] is a else b.arguments[1]
        one, zero = self.const(1.0), self.const(0.0)
        if any(item.operation != "select" or item.arguments[1:] != (one, zero) for item in (a, other)):
            return None
        this, that = a.arguments[0], other.arguments[0]
        if this.operation != "le" or that.operation != "le" or this.arguments != that.arguments[::-1]:
            return None
        neither = self.make("add", *this.arguments)  # where one of them is NaN, and the quotient is 0 / 0
        tied = self.make("select", that, self.const(0.5), one)
        return self.make("select", this, tied, self.make("select", that, zero, neither))

    def from_tape(self, tape: Tape, inputs: Sequence[Sequence[Node]]) -> list[list[Node]]:
        """Return the output nodes of a tape.

        A denominator that more than one quotient shares is inverted once (CasADi folds a * (1/b) into a / b).
        """
        divisors: dict[int, int] = {}
        for step in tape.steps:
            if step.operation in ("div", "inv"):
                divisor = step.arguments[-1]
                divisors[divisor] = divisors.get(divisor, 0) + 1
        nodes: list[Node] = []
        for step in tape.steps:
            items = [nodes[item] for item in step.arguments]
            match step.operation:
                case "input":
                    node = inputs[step.place[0]][step.place[1]]
                case "const":
                    node = self.const(step.value)
                case "sq":
                    node = items[0] * items[0]
                case "twice":
                    node = self.const(2.0) * items[0]
                case "inv":
                    node = self.make("div", self.const(1.0), items[0])
                case "div" if divisors[step.arguments[1]] > 1 and items[1].operation != "const":
                    node = items[0] * self.make("div", self.const(1.0), items[1])
                case "pow" if items[1].operation == "const" and items[1].value in (2.0, 3.0, 4.0):
                    node = items[0]
                    for _ in range(int(items[1].value) - 1):
                        node = node * items[0]
                case "if_else_zero":
                    condition = items[0] if items[0].is_boolean else self.make("ne", items[0], self.const(0.0))
                    node = self.make("select", condition, items[1], self.const(0.0))
                case "sign":
                    zero = self.const(0.0)
                    below = self.make("select", self.make("lt", items[0], zero), self.const(-1.0), items[0])
                    node = self.make("select", self.make("lt", zero, items[0]), self.const(1.0), below)
                case "saturation":
                    x, low, high = [self.as_number(item) for item in items]
                    above = self.make("select", self.make("lt", x, low), low, x)
                    node = self.make("select", self.make("lt", high, above), high, above)
                case "minimum" | "maximum":
                    node = self._strict_extreme(step.operation, *[self.as_number(item) for item in items])
                case "fmin" | "fmax":
                    node = self._extreme(step.operation, *[self.as_number(item) for item in items])
                case "and" | "or" | "not":
                    truths = [item if item.is_boolean else self.make("ne", item, self.const(0.0)) for item in items]
                    node = self.make(step.operation, *truths)
                case operation:
                    node = self.make(operation, *[self.as_number(item) for item in items])
            nodes.append(node)
        return [[self.as_number(nodes[item]) for item in output] for output in tape.outputs]

    def _extreme(self, operation: str, a: Node, b: Node) -> Node:
        """Return fmin or fmax as comparisons, like CasADi's: NaN gives the other operand, a tie (of zeros, too) the first."""
        if a.operation == "const":
            better = (b, a) if operation == "fmin" else (a, b)
            return self.make("select", self.make("lt", *better), b, a)
        not_worse = (a, b) if operation == "fmin" else (b, a)
        other = b if b.operation == "const" else self.make("select", self.make("eq", b, b), b, a)
        return self.make("select", self.make("le", *not_worse), a, other)

    def _strict_extreme(self, operation: str, a: Node, b: Node) -> Node:
        """Return the smaller or larger as comparisons that pass NaN on."""
        if a.operation == "const":
            a, b = b, a
        b_below_a, a_below_b = (self.make("lt", *pair) for pair in ((b, a), (a, b)))
        if b.operation == "const":
            return self.make("select", b_below_a if operation == "minimum" else a_below_b, b, a)
        first, second = (a_below_b, (b, a)) if operation == "minimum" else (b_below_a, (a, b))
        other = self.make("select", self.make("le", *second), b, self.make("add", a, b))
        return self.make("select", first, a, other)

    def as_number(self, node: Node) -> Node:
        """Return 1 or 0 for a truth value."""
        if not node.is_boolean:
            return node
        return self.make("select", node, self.const(1.0), self.const(0.0))
