"""Subexpressions that are equal by structure, found and replaced."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import casadi as ca

from .expressions import PIECEWISE, Step, operation_code, tape
from .piecewise import called

_COMMUTE = frozenset({"add", "fmin", "fmax", "eq", "ne", "and", "or", "minimum", "maximum"})


@dataclass(frozen=True)
class _Node:
    """An operation on earlier nodes; a product has all its factors, in whatever order and brackets they were written."""

    operation: str
    arguments: tuple[int, ...] = ()
    value: float = 0.0
    place: tuple[int, int] = (0, 0)


class Subexpressions:
    """Column vectors of expressions, taken apart into operations; those that are equal are one node.

    The terms of a sum may be exchanged, the factors of a product also bracketed otherwise: 2 x y has the factors of x y.

    Parameters
    ----------
    symbols : sequence of casadi.SX
        Every symbol that occurs.
    expressions : sequence of casadi.SX
        Column vectors.
    """

    def __init__(self, symbols: Sequence[ca.SX], expressions: Sequence[ca.SX]):
        record = tape(ca.Function("subexpressions", list(symbols), [ca.densify(item) for item in expressions]))
        self.symbols = symbols
        self.nodes: list[_Node] = []
        self.known: dict[_Node, int] = {}
        places: list[int] = []
        for step in record.steps:
            places.append(self._numbered(step, [places[item] for item in step.arguments]))
        self.outputs = [[places[item] for item in output] for output in record.outputs]

    def node(self, expression: int, element: int) -> int:
        """Return the node that an element of an expression is."""
        return self.outputs[expression][element]

    def rebuilt(self, expression: int, values: Mapping[int, ca.SX], *, inside: bool = False) -> ca.SX:
        """Return an expression with nodes replaced by their values; of a product also some of its factors.

        Parameters
        ----------
        expression : int
            Which.
        values : dict
            Node -> what to put there.
        inside : bool
            Whether an element that is itself such a node is left: only what is inside of it is replaced.
        """
        answer = []
        for root in self.outputs[expression]:
            used = {node: value for node, value in values.items() if not (inside and node == root)}
            made: dict[int, ca.SX] = {}
            for k in sorted(self._needed(root)):
                made[k] = used[k] if k in used else self._made(self.nodes[k], made, used)
            answer.append(made[root])
        return ca.vertcat(ca.SX(0, 1), *answer)

    def _numbered(self, step: Step, arguments: list[int]) -> int:
        match step.operation:
            case "mul":
                return self._product([*self._factors(arguments[0]), *self._factors(arguments[1])])
            case "sq":
                return self._product([*self._factors(arguments[0])] * 2)
            case "neg" | "twice":
                number = self._add(_Node("const", value=-1.0 if step.operation == "neg" else 2.0))
                return self._product([number, *self._factors(arguments[0])])
            case "div":
                return self._product([*self._factors(arguments[0]), self._add(_Node("inv", (arguments[1],)))])
        if step.operation in _COMMUTE:
            arguments = sorted(arguments)
        return self._add(_Node(step.operation, tuple(arguments), step.value, step.place))

    def _add(self, node: _Node) -> int:
        if node not in self.known:
            self.known[node] = len(self.nodes)
            self.nodes.append(node)
        return self.known[node]

    def _factors(self, node: int) -> tuple[int, ...]:
        return self.nodes[node].arguments if self.nodes[node].operation == "product" else (node,)

    def _product(self, factors: Sequence[int]) -> int:
        return self._add(_Node("product", tuple(sorted(factors))))

    def _made(self, node: _Node, made: Mapping[int, ca.SX], values: Mapping[int, ca.SX]) -> ca.SX:
        """Return the expression of a node that is not itself replaced."""
        if node.operation == "input":
            return ca.SX(self.symbols[node.place[0]])[node.place[1]]
        if node.operation == "const":
            return ca.SX(node.value)
        if node.operation == "product":
            return self._product_of(node, made, values)
        arguments = [made[item] for item in node.arguments]
        if node.operation in PIECEWISE:
            return called(node.operation, arguments)
        code = operation_code(node.operation)
        return ca.SX.unary(code, arguments[0]) if len(arguments) == 1 else ca.SX.binary(code, *arguments)

    def _product_of(self, node: _Node, made: Mapping[int, ca.SX], values: Mapping[int, ca.SX]) -> ca.SX:
        """Return a product, in which the factors of products that are replaced were found, the longest first."""
        rest = Counter(node.arguments)
        answer = ca.SX(1)
        parts = [(k, Counter(self._factors(k))) for k in values if self.nodes[k].operation == "product"]
        for k, factors in sorted(parts, key=lambda item: (-item[1].total(), item[0])):
            while factors <= rest:
                rest -= factors
                answer *= values[k]
        for factor, count in sorted(rest.items()):
            for _ in range(count):
                answer *= made[factor]
        return answer

    def _needed(self, root: int) -> set[int]:
        waiting, seen = [root], {root}
        while waiting:
            for item in self.nodes[waiting.pop()].arguments:
                if item not in seen:
                    seen.add(item)
                    waiting.append(item)
        return seen
