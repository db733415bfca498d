"""Truncated Taylor arithmetic in several variables, against mpmath along lines through the origin."""

import casadi as ca
import mpmath as mp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from plantc.symbolic import taylor
from plantc.symbolic.expressions import _OPERATIONS, PIECEWISE, tape
from plantc.symbolic.taylor import NOT_ANALYTIC, Monomials, NotAnalyticError, Series, apply, compose

from plantc import ModelError

ORDER = 5
SPACE = Monomials(2, ORDER)
SMALL = st.floats(-1, 1).map(lambda value: round(value, 3))
AWAY = st.floats(0.4, 2).map(lambda value: round(value, 3))
ANY = st.floats(-2, 2).map(lambda value: round(value, 3))
INSIDE = st.floats(-0.7, 0.7).map(lambda value: round(value, 3))
SLANTED = st.floats(-1.1, 1.1).map(lambda value: round(value, 3))

CASES = {
    "add": ((ANY, ANY), lambda a, b: a + b),
    "sub": ((ANY, ANY), lambda a, b: a - b),
    "mul": ((ANY, ANY), lambda a, b: a * b),
    "div": ((ANY, AWAY), lambda a, b: a / b),
    "neg": ((ANY,), lambda a: -a),
    "inv": ((AWAY.map(lambda value: -value),), lambda a: 1 / a),
    "sq": ((ANY,), lambda a: a**2),
    "twice": ((ANY,), lambda a: 2 * a),
    "sqrt": ((AWAY,), mp.sqrt),
    "sin": ((ANY,), mp.sin),
    "cos": ((ANY,), mp.cos),
    "tan": ((SLANTED,), mp.tan),
    "asin": ((INSIDE,), mp.asin),
    "acos": ((INSIDE,), mp.acos),
    "atan": ((ANY,), mp.atan),
    "atan2": ((AWAY, ANY), mp.atan2),
    "sinh": ((ANY,), mp.sinh),
    "cosh": ((ANY,), mp.cosh),
    "tanh": ((ANY,), mp.tanh),
    "exp": ((ANY,), mp.exp),
    "log": ((AWAY,), mp.log),
    "pow": ((AWAY, ANY), lambda a, b: a**b),
}


def series_of(value, numbers, space=SPACE):
    """A series whose coefficients are the numbers given, in turn, falling with the degree."""
    parts, start = [np.array([value])], 0
    for degree in range(1, space.order + 1):
        count = space.count(degree)
        parts.append(np.array([numbers[(start + k) % len(numbers)] for k in range(count)]) / degree)
        start += count
    return Series(space, parts)


def along(series, direction):
    """Coefficients of t -> series(t direction)."""
    return [float(series.part(k) @ SPACE.values(k, direction)) for k in range(series.order + 1)]


def polynomial(coefficients, t):
    return sum((mp.mpf(value) * t**degree for degree, value in enumerate(coefficients)), mp.mpf(0))


def taylor_of(function, series, direction):
    """The same of a function of series, by mpmath with 40 digits."""
    lines = [along(item, direction) for item in series]
    with mp.workdps(40):
        return [float(item) for item in mp.taylor(lambda t: function(*[polynomial(a, t) for a in lines]), 0, ORDER)]


def agree(ours, theirs, bound=1e-11):
    assert np.max(np.abs(np.array(ours) - theirs)) <= bound * max(1.0, np.max(np.abs(theirs)))


@pytest.mark.parametrize("operation", CASES)
@given(data=st.data())
def test_every_operation_is_that_of_mpmath(operation, data):
    values, function = CASES[operation]
    numbers = data.draw(st.lists(SMALL, min_size=7, max_size=7))
    inputs = [series_of(data.draw(value), [*numbers[index:], 0.3]) for index, value in enumerate(values)]
    direction = np.array([data.draw(SMALL), 0.7])
    agree(along(apply(operation, *inputs), direction), taylor_of(function, inputs, direction))


def test_every_operation_of_a_tape_is_either_tested_here_or_refused():
    assert set(CASES) | NOT_ANALYTIC == set(_OPERATIONS.values()) | PIECEWISE
    assert not set(CASES) & NOT_ANALYTIC


@pytest.mark.parametrize("exponent", [0.0, 1.0, 2.0, 3.0, 7.0, -1.0, -3.0, 0.5, 1.5, -0.25])
@pytest.mark.parametrize("value", [1.3, -0.8, 0.0])
def test_constant_powers(exponent, value):
    base = series_of(value, [0.4, -0.3, 0.9])
    power = Series.constant(SPACE, exponent, ORDER)
    if value > 0 or (exponent == int(exponent) and (value or exponent >= 0)):
        direction = np.array([0.6, -0.8])
        agree(along(apply("pow", base, power), direction), taylor_of(lambda a: a**exponent, [base], direction))
    else:
        with pytest.raises(NotAnalyticError, match="takes the power"):
            apply("pow", base, power)


def test_a_faulty_rule_is_seen(monkeypatch):
    base = series_of(0.5, [0.4, -0.3, 0.9])
    direction = np.array([0.6, -0.8])
    monkeypatch.setitem(taylor._RULES, "sin", lambda a: taylor._circular(a.scaled(1 + 1e-9))[0])
    with pytest.raises(AssertionError):
        agree(along(apply("sin", base), direction), taylor_of(mp.sin, [base], direction))


@pytest.mark.parametrize(
    ("operation", "values", "text"),
    [
        ("div", (1.0, 0.0), "divides by zero"),
        ("inv", (0.0,), "divides by zero"),
        ("sqrt", (0.0,), "square root of 0"),
        ("sqrt", (-1.0,), "square root of -1"),
        ("log", (0.0,), "logarithm of 0"),
        ("asin", (1.0,), "asin of 1"),
        ("acos", (-2.0,), "acos of -2"),
        ("atan2", (0.0, 0.0), "atan2 of"),
        ("atan2", (0.0, -1.0), "where it jumps"),
        ("exp", (1e3,), "overflows in exp"),
        ("fabs", (1.0,), "uses fabs"),
        ("if_else_zero", (1.0, 1.0), "uses if_else"),
    ],
)
def test_singular_points_are_named(operation, values, text):
    numbers = [0.4, -0.3, 0.9] if operation != "atan2" else [0.0]
    with pytest.raises(NotAnalyticError, match=text):
        apply(operation, *[series_of(value, numbers) for value in values])


def test_a_varying_power_needs_a_positive_base():
    with pytest.raises(NotAnalyticError, match="to a power that varies"):
        apply("pow", series_of(-1.0, [0.1]), series_of(2.0, [0.1]))


# -- whole expressions ------------------------------------------------------------------------------------------------


def test_an_expression_is_what_casadi_differentiates():
    x = ca.SX.sym("x", 3)
    whole = ca.vertcat(
        ca.sqrt(2 + x[0] * ca.sin(x[1])) / (1 + ca.exp(x[2]) ** 2),
        ca.atan2(ca.cosh(x[0]) + x[1], 1 + ca.tanh(x[2] - x[0])) - ca.log(3 + x[1] ** 3),
        (2 + ca.tan(x[0])) ** (x[1] / 2) + 2 * x[2] ** 2 - 1.5,
    )
    space, t = Monomials(3, 4), ca.SX.sym("t")
    at, direction = np.array([0.3, -0.2, 0.4]), np.array([0.5, -0.7, 0.2])
    inputs = [Series(space, [np.array([at[i]]), np.eye(3)[i], None, None, None]) for i in range(3)]
    found = compose(tape(ca.Function("f", [x], [whole])), [inputs], "it", ["a", "b", "c"])
    line = ca.substitute(whole, x, ca.DM(at) + t * ca.DM(direction))
    for degree in range(5):
        wanted = np.array(ca.Function("d", [t], [line])(0)).ravel()
        ours = [item.part(degree) @ space.values(degree, direction) for item in found]
        agree(ours, wanted, 1e-13)
        line = ca.jacobian(line, t) / (degree + 1)


@pytest.mark.parametrize("operation", ["fabs", "sign", "floor", "ceil", "fmin", "fmax"])
def test_what_is_not_analytic_is_refused_with_its_equation(operation):
    x = ca.SX.sym("x", 2)
    made = getattr(ca, operation)
    kinked = made(x[0], x[1]) if operation in ("fmin", "fmax") else made(x[0])
    record = tape(ca.Function("f", [x], [ca.vertcat(x[0] * x[1], x[1] + ca.sin(kinked))]))
    inputs = [Series(SPACE, [np.array([0.5]), np.eye(2)[i], *[None] * 4]) for i in range(2)]
    with pytest.raises(ModelError, match=rf"cart: the rate of b uses {operation} at the operating point.*smooth"):
        compose(record, [inputs], "cart", ["the rate of a", "the rate of b"])


# -- monomials --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("variables", "order"), [(1, 4), (2, 5), (4, 3)])
def test_monomials_are_counted_and_ordered(variables, order):
    space = Monomials(variables, order)
    for degree in range(order + 1):
        table = space.exponents[degree].tolist()
        assert table == sorted(table, reverse=True)
        assert all(sum(item) == degree for item in table)
        assert len(table) == space.count(degree) == len({tuple(item) for item in table})
        assert [space.place(item) for item in table] == list(range(len(table)))
    assert space.count(order) == mp.binomial(variables + order - 1, order)


def test_products_and_slopes_of_polynomials():
    rng = np.random.default_rng(1)
    space, w = Monomials(3, 5), rng.normal(size=3)
    a, b = rng.normal(size=space.count(2)), rng.normal(size=space.count(3))
    whole = space.product(2, a, 3, b) @ space.values(5, w)
    assert whole == pytest.approx((a @ space.values(2, w)) * (b @ space.values(3, w)), rel=1e-13)
    step = 1e-30j * np.eye(3)
    moved = [np.prod((w + step[i])[None, :] ** space.exponents[3], axis=1) @ b for i in range(3)]
    np.testing.assert_allclose(space.slopes(3, b[None])[0] @ space.values(2, w), np.imag(moved) / 1e-30, rtol=1e-12)
