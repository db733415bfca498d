"""The scalar graph: exact simplifications only, shared reciprocals, stable forms kept."""

import casadi as ca
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from plantc.codegen.graph import Graph
from plantc.symbolic.expressions import numpy_callable, tape


def evaluate(node, loads):
    """Evaluate a node in plain Python."""
    a = [evaluate(item, loads) for item in node.arguments]
    table = {
        "add": lambda: a[0] + a[1],
        "sub": lambda: a[0] - a[1],
        "mul": lambda: a[0] * a[1],
        "div": lambda: a[0] / a[1],
        "neg": lambda: -a[0],
        "select": lambda: a[1] if a[0] else a[2],
        "lt": lambda: a[0] < a[1],
        "le": lambda: a[0] <= a[1],
        "ge": lambda: a[0] >= a[1],
        "eq": lambda: a[0] == a[1],
        "ne": lambda: a[0] != a[1],
        "not": lambda: not a[0],
        "and": lambda: a[0] and a[1],
        "or": lambda: a[0] or a[1],
        "fabs": lambda: abs(a[0]),
        "sin": lambda: np.sin(a[0]),
    }
    if node.operation == "const":
        return node.value
    if node.operation == "load":
        return loads[node.element[1]]
    return table[node.operation]()


def through_graph(expression, symbol, values):
    function = ca.Function("f", [symbol], [ca.densify(expression)])
    graph = Graph()
    inputs = [[graph.load("x", i, 0) for i in range(symbol.numel())]]
    outputs = graph.from_tape(tape(function), inputs)[0]
    return graph, outputs, np.array([evaluate(node, values) for node in outputs]), np.array(function(values)).ravel()


@given(st.lists(st.floats(-3, 3), min_size=3, max_size=3))
def test_a_tape_means_the_same_as_casadi(values):
    x = ca.SX.sym("x", 3)
    expression = ca.vertcat(
        x[0] * x[1] - x[2] / (2.5 + x[1] ** 2),
        ca.if_else(x[0] > x[1], x[2], -x[2] * 3),
        ca.fmax(x[0], x[1]) + ca.fmin(x[1], x[2]) + ca.sign(x[2]),
        -(x[0] - 4) * 0.25 + ca.fabs(x[1]) + ca.sin(x[2]),
    )
    _, _, ours, theirs = through_graph(expression, x, values)
    np.testing.assert_allclose(ours, theirs, rtol=1e-14, atol=1e-14)


@pytest.mark.parametrize("first", [0.0, -0.0, 1.0, -2.0, np.nan, np.inf])
@pytest.mark.parametrize("second", [0.0, -0.0, 1.0, 3.0, np.nan, -np.inf])
def test_extremes_are_the_same_bits_in_every_view(first, second):
    """NaN gives the other operand, a tie the first: in CasADi's machine, in the graph that becomes C, and in NumPy."""
    x = ca.SX.sym("x", 2)
    expressions = [ca.fmin(x[0], x[1]), ca.fmax(x[0], x[1])]
    expressions += [g(x[0], k) for g in (ca.fmin, ca.fmax) for k in (0.5, 0.0)]
    expressions += [g(k, x[1]) for g in (ca.fmin, ca.fmax) for k in (0.5, 0.0)]
    _, _, ours, theirs = through_graph(ca.vertcat(*expressions), x, [first, second])
    numpy_view = numpy_callable(ca.Function("f", [x], [ca.vertcat(*expressions)]))(np.array([first, second]))[0]
    usual = ~np.isnan(theirs)
    for other in (ours, numpy_view):
        assert np.array_equal(np.isnan(other), np.isnan(theirs))
        assert other[usual].tobytes() == theirs[usual].tobytes()


def count(nodes, operation):
    seen, stack = set(), list(nodes)
    while stack:
        node = stack.pop()
        if node not in seen:
            seen.add(node)
            stack += node.arguments
    return sum(node.operation == operation for node in seen)


def test_a_shared_denominator_is_inverted_once():
    x = ca.SX.sym("x", 4)
    d = x[3] * x[3] + 1
    _, nodes, ours, theirs = through_graph(ca.vertcat(x[0] / d, x[1] / d, x[2] / d), x, [1.0, 2.0, 3.0, 0.5])
    assert count(nodes, "div") == 1
    np.testing.assert_allclose(ours, theirs, rtol=1e-15)


def test_a_denominator_used_once_stays_a_quotient():
    x = ca.SX.sym("x", 2)
    _, nodes, ours, theirs = through_graph(x[0] / x[1], x, [1.0, 3.0])
    assert ours[0] == theirs[0] == 1.0 / 3.0
    assert nodes[0].operation == "div"


def test_a_constant_denominator_costs_no_division():
    x = ca.SX.sym("x")
    _, nodes, *_ = through_graph(x / 3, x, [1.0])
    assert count(nodes, "div") == 0


def test_stable_forms_are_not_cancelled():
    """CasADi turns s * (w / s) into w; the graph, in which kernels are written, must not."""
    graph = Graph()
    s, w = graph.load("s", 0, 0), graph.load("w", 0, 0)
    product = s * graph.make("div", w, s)
    assert product.operation == "mul"
    assert (s - s).operation == "sub"
    assert ((w + s) - s).operation == "sub"


def test_equal_nodes_are_the_same_object_in_any_order():
    graph = Graph()
    a, b = graph.load("x", 0, 0), graph.load("x", 1, 0)
    assert a * b is b * a
    assert a + b is b + a
    assert (a - b) is not (b - a)
    assert graph.load("x", 0, 1) is not a  # another version of the place is another value


@pytest.mark.parametrize("zero", [0.0, -0.0])
def test_adding_zero_and_multiplying_by_one_vanish(zero):
    graph = Graph()
    a = graph.load("x", 0, 0)
    assert a + graph.const(zero) is a
    assert a * graph.const(1.0) is a
    assert (a * graph.const(-1.0)).operation == "neg"


@pytest.mark.parametrize("extreme", [ca.fmin, ca.fmax])
@pytest.mark.parametrize("p", [1.0, 2.0, 3.0, float("nan"), float("inf")])
def test_the_slope_of_an_extreme_takes_no_division(extreme, p):
    x, y = ca.SX.sym("x"), ca.SX.sym("y")
    function = ca.Function("slope", [x, y], [ca.jacobian(extreme(x, y), x), ca.jacobian(extreme(x, 2), x)])
    graph = Graph()
    loads = [graph.load("x", k, 0) for k in range(2)]
    outputs = graph.from_tape(tape(function), [[item] for item in loads])
    for (node,), wanted in zip(outputs, function(p, 2.0), strict=True):
        assert "div" not in operations_of(node)
        np.testing.assert_equal(evaluate(node, [p, 2.0]), float(wanted))


def operations_of(node):
    return {node.operation}.union(*(operations_of(item) for item in node.arguments))
