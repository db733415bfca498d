"""Subexpressions found by structure, whatever order they were written in."""

import casadi as ca
import numpy as np
import pytest
from plantc.symbolic import sin
from plantc.symbolic.piecewise import saturated
from plantc.symbolic.subexpressions import Subexpressions

x, y, n = ca.SX.sym("x"), ca.SX.sym("y"), ca.SX.sym("n")


def replaced(expression, part, **options):
    """Return an expression with a part of it replaced by n, and whether it was found."""
    table = Subexpressions([x, y], [expression, part])
    answer = table.rebuilt(0, {table.node(1, 0): n}, **options)
    return answer, ca.depends_on(answer, n)


FOUND = [
    (3 * x**2 * y, x**2 * y, 3 * n),
    (-0.5 * x * ca.fabs(x), x * ca.fabs(x), -0.5 * n),
    (y * 2 * x * x - y, x**2 * y, 2 * n - y),
    (x + sin(y + x), sin(x + y), x + n),
    (x**3 / 7, x**3, n / 7),
    (x**2 * y**2, x * y, n * n),
    (-(x * y) + 2 * (y * x), x * y, n),
    (2 * saturated(3 * x, -1, 1), saturated(x * 3, -1, 1), 2 * n),
    (ca.fmin(x, y) + 1, ca.fmin(y, x), n + 1),
]


@pytest.mark.parametrize(("expression", "part", "expected"), FOUND)
def test_what_is_found(expression, part, expected):
    answer, found = replaced(expression, part)
    assert found
    both = ca.Function("both", [x, y, n], [answer, expected])
    for point in np.random.default_rng(0).normal(size=(5, 3)):
        first, second = both(*point)
        assert float(first) == pytest.approx(float(second), rel=1e-14)


@pytest.mark.parametrize(
    ("expression", "part"),
    [
        (x**2, x**3),
        (sin(x), sin(y)),
        (x - y, y - x),
        (x + y + 1, x + 1),
        (x / y, x * y),
        (saturated(x, -1, 1), saturated(x, -1, 2)),
    ],
)
def test_what_is_not_there_is_not_found(expression, part):
    answer, found = replaced(expression, part)
    assert not found
    both = ca.Function("both", [x, y], [answer, expression])
    first, second = both(0.3, -0.7)
    assert float(first) == pytest.approx(float(second), rel=1e-15)


def test_what_is_rebuilt_has_the_value_it_had():
    """Every operation of a model comes back: nothing is replaced here."""
    some = (
        ca.if_else(ca.logic_and(x < y, x != 0), ca.atan2(x, y) ** 2 / (1 + ca.exp(-x)), -ca.sqrt(y * y + 2 * x * x))
        + x**y
    )
    table = Subexpressions([x, y], [some])
    both = ca.Function("both", [x, y], [table.rebuilt(0, {}), some])
    for point in ((0.3, 0.7), (0.7, 0.3)):
        first, second = both(*point)
        assert float(first) == pytest.approx(float(second), rel=1e-15)


def test_the_element_itself_may_be_left():
    inner = sin(x)
    table = Subexpressions([x, y], [inner**2 + inner, inner])
    values = {table.node(0, 0): y, table.node(1, 0): n}
    assert ca.is_equal(table.rebuilt(0, values), y, 5)
    inside = ca.Function("inside", [x, y, n], [table.rebuilt(0, values, inside=True)])
    assert float(inside(0, 0, 3.0)) == 12.0
