"""Bounds of expressions: nothing that a symbol can do leaves them, and where nothing is known they say so."""

import math

import casadi as ca
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from plantc.symbolic.intervals import bounds
from plantc.symbolic.piecewise import look_up, maximum, minimum, saturated

X, Y = ca.SX.sym("x"), ca.SX.sym("y")
EXPRESSIONS = {
    "trigonometric": ca.cos(X) * ca.sin(Y) + ca.sin(2 * X),
    "rational": (X - Y) / (1 + Y**2) - 1 / (3 + ca.fabs(X)),
    "roots": ca.sqrt(X**2 + 1) - ca.log(2 + ca.cos(Y)) + ca.exp(-Y),
    "pieces": ca.fmin(X, Y) + ca.fmax(X, 0.5) + ca.if_else(X < Y, X, Y) + ca.sign(X) + ca.floor(Y),
    "tables": look_up(X, [-2, 0, 1, 3], [5, -1, 2, 2]) + ca.jacobian(look_up(X + Y, [-2, 0, 1], [5, -1, 2]), X),
    "saturations": saturated(X, -1, 2) - saturated(3 * X, Y, Y + 1) + minimum(X, Y) * maximum(Y, 1),
    "bounded": ca.tanh(X) + ca.atan(Y) + ca.atan2(X, Y) + ca.sinh(Y),
}
ENDS = st.floats(-7, 7, allow_subnormal=False)


@pytest.mark.parametrize("name", EXPRESSIONS)
@given(ends=st.tuples(ENDS, ENDS, ENDS, ENDS), at=st.tuples(st.floats(0, 1), st.floats(0, 1)))
def test_no_value_is_out_of_bounds(name, ends, at):
    ranges = [tuple(sorted(ends[:2])), tuple(sorted(ends[2:]))]
    (low, high) = bounds(EXPRESSIONS[name], [X, Y], [[item] for item in ranges])[0]
    point = [a + share * (b - a) for (a, b), share in zip(ranges, at, strict=True)]
    value = float(ca.Function("f", [X, Y], [EXPRESSIONS[name]])(*point))
    slack = 1e-12 * (1 + abs(value))
    assert low - slack <= value <= high + slack


@pytest.mark.parametrize(
    ("expression", "ends", "found"),
    [
        (ca.cos(X), (-3.15, 3.15), (-1, 1)),
        (ca.cos(X), (-1.0, 0.5), (math.cos(1), 1)),
        (ca.sin(X), (1, 2), (math.sin(1), 1)),
        (X**2, (-2, 1), (0, 4)),
        (1 / X, (0.5, 4), (0.25, 2)),
        (1 / X, (-1, 1), (-math.inf, math.inf)),
        (ca.sqrt(X), (-1, 1), (-math.inf, math.inf)),
        (X**1.5, (1, 2), (-math.inf, math.inf)),
        (look_up(X, [0, 1, 2, 3], [0, 5, -5, 1]), (0.5, 2.5), (-5, 5)),
        (look_up(X, [0, 1, 2, 3], [0, 5, -5, 1]), (1.5, 1.75), (-2.5, 0)),
        (ca.jacobian(look_up(X, [0, 1, 2], [0, 5, -5]), X), (-1, 0.5), (0, 5)),
        (saturated(X, -1, 2), (-0.5, 9), (-0.5, 2)),
        (X - X + 0 * X + ca.tanh(1e9 * X), (-1, 1), (-1, 1)),
    ],
)
def test_what_the_bounds_are(expression, ends, found):
    np.testing.assert_allclose(bounds(expression, [X], [[ends]])[0], found, rtol=1e-15)
