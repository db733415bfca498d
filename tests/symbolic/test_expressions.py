"""Expressions read back as a tape, as NumPy code and as text, beside CasADi's own evaluation."""

import os
import subprocess
import sys

import casadi as ca
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from plantc.symbolic import ModelError
from plantc.symbolic.expressions import _NUMPY, constants_of, equation_text, expand, numpy_callable, tape

ONE = {
    "neg": lambda a: -a,
    "inv": lambda a: 1 / a,
    "sq": lambda a: a**2,
    "twice": lambda a: a + a,
    "sqrt": ca.sqrt,
    "sin": ca.sin,
    "cos": ca.cos,
    "tan": ca.tan,
    "asin": ca.asin,
    "acos": ca.acos,
    "atan": ca.atan,
    "sinh": ca.sinh,
    "cosh": ca.cosh,
    "tanh": ca.tanh,
    "exp": ca.exp,
    "log": ca.log,
    "fabs": ca.fabs,
    "sign": ca.sign,
    "floor": ca.floor,
    "ceil": ca.ceil,
    "not": ca.logic_not,
}
TWO = {
    "add": lambda a, b: a + b,
    "sub": lambda a, b: a - b,
    "mul": lambda a, b: a * b,
    "div": lambda a, b: a / b,
    "atan2": ca.atan2,
    "pow": lambda a, b: a**b,
    "fmin": ca.fmin,
    "fmax": ca.fmax,
    "lt": lambda a, b: a < b,
    "le": lambda a, b: a <= b,
    "eq": lambda a, b: a == b,
    "ne": lambda a, b: a != b,
    "and": ca.logic_and,
    "or": ca.logic_or,
    "if_else_zero": ca.if_else_zero if hasattr(ca, "if_else_zero") else lambda a, b: ca.if_else(a, b, 0),
}
SMOOTH_ONE = ["neg", "sq", "twice", "sin", "cos", "atan", "tanh", "exp"]
SMOOTH_TWO = ["add", "sub", "mul"]

X = ca.SX.sym("x", 3)
NUMBERS = st.floats(-3, 3).map(lambda value: round(value, 3))
LEAVES = st.one_of(st.integers(0, 2).map(lambda i: X[i]), NUMBERS.map(ca.SX))


def trees(one, two, leaves=12):
    def grow(children):
        return st.one_of(
            st.tuples(st.sampled_from(one), children).map(lambda t: ONE[t[0]](t[1])),
            st.tuples(st.sampled_from(two), children, children).map(lambda t: TWO[t[0]](t[1], t[2])),
        )

    return st.recursive(LEAVES, grow, max_leaves=leaves)


POINTS = st.lists(NUMBERS, min_size=3, max_size=3).map(np.array)


def function_of(*expressions):
    return ca.Function("f", [X], [ca.densify(ca.SX(item)) for item in expressions])


def by_casadi(function, point):
    return [np.array(item, dtype=float).ravel() for item in function.call([ca.DM(point)])]


@settings(max_examples=300, deadline=None, derandomize=True)
@given(tree=trees(sorted(ONE), sorted(TWO)), point=POINTS)
def test_numpy_beside_casadi_on_random_trees(tree, point):
    function = function_of(tree)
    expected = by_casadi(function, point)[0]
    found = numpy_callable(function)(point)[0]
    if np.all(np.isfinite(expected)) and np.max(np.abs(expected)) < 1e100:
        # rounding of a library function may be amplified; an error of meaning is not small
        np.testing.assert_allclose(found, expected, rtol=1e-6, atol=1e-9)


@pytest.mark.parametrize("name", [*ONE, *TWO])
@settings(max_examples=40, deadline=None, derandomize=True)
@given(a=NUMBERS, b=st.one_of(NUMBERS, st.just(0.0)))
def test_each_operation_beside_casadi(name, a, b):
    expression = ONE[name](X[0]) if name in ONE else TWO[name](X[0], X[1])
    function = function_of(3 * expression - expression / 7)
    expected = by_casadi(function, [a, b, 0])[0]
    found = numpy_callable(function)(np.array([a, b, 0.0]))[0]
    np.testing.assert_allclose(found, expected, rtol=1e-14, atol=1e-300, equal_nan=True)


def test_the_operations_above_are_all_that_are_supported():
    from plantc.symbolic import expressions

    assert {*ONE, *TWO} == set(expressions._OPERATIONS.values())
    met = set()
    for name, operation in {**ONE, **TWO}.items():
        expression = operation(X[0]) if name in ONE else operation(X[0], X[1])
        met |= {step.operation for step in tape(function_of(expression)).steps}
    assert met == {"input", "const", *ONE, *TWO} - ({"const"} if "const" not in met else set())


def test_a_wrong_operation_is_seen(monkeypatch):
    monkeypatch.setitem(_NUMPY, "_sin", np.cos)
    function = function_of(ca.sin(X[0]))
    with pytest.raises(AssertionError):
        np.testing.assert_allclose(
            numpy_callable(function)(np.ones(3))[0], by_casadi(function, np.ones(3))[0], rtol=1e-6
        )


def test_truth_values_are_numbers():
    a, b, c = (X[i] for i in range(3))
    function = function_of(ca.vertcat((a < b) + (b < c), -(a < b), (a < b) - (b < c), 2 * (a < b), (a < b) / 4))
    np.testing.assert_array_equal(numpy_callable(function)(np.array([1.0, 2.0, 3.0]))[0], [2, -1, 0, 2, 0.25])


def complex_step(call, point, h=1e-30):
    columns = []
    for k in range(point.size):
        moved = point.astype(complex)
        moved[k] += 1j * h
        columns.append(np.imag(call(moved)[0]) / h)
    return np.array(columns).T


@settings(max_examples=200, deadline=None, derandomize=True)
@given(tree=trees(SMOOTH_ONE, SMOOTH_TWO), point=POINTS)
def test_the_complex_step_is_the_jacobian(tree, point):
    function = function_of(tree)
    expected = np.array(ca.Function("J", [X], [ca.densify(ca.jacobian(ca.SX(tree), X))])(point))
    if not np.all(np.isfinite(expected)) or np.max(np.abs(expected)) > 1e50:
        return
    found = complex_step(numpy_callable(function), point)
    np.testing.assert_allclose(found, expected, rtol=1e-7, atol=1e-9)


@pytest.mark.parametrize(
    "expression",
    [
        ca.atan2(X[0], X[1]), ca.asin(X[0]), ca.acos(X[0]), ca.sqrt(X[2]), ca.log(X[2]), ca.tan(X[0]), X[2] ** 2.5,
        X[0] ** 3, X[2] ** X[0], 1 / X[0], ca.sinh(X[0]), ca.cosh(X[0]), ca.fabs(X[0]), ca.fmin(X[0], X[1]),
        ca.fmax(X[0], 2 * X[1]), ca.if_else(X[0] < X[1], X[0] ** 2, X[1] * X[2]), ca.floor(X[0]) * X[1],
        X[0] - 2 * ca.floor(0.5 * X[0] + 0.5), ca.sign(X[0]) * X[1],
    ],
    ids=str,
)  # fmt: skip
@pytest.mark.parametrize("point", [(0.3, -0.7, 1.3), (-0.4, 0.2, 0.1), (-0.9, -0.8, 2.0)])
def test_the_complex_step_of_the_other_operations(expression, point):
    point = np.array(point)
    expected = np.array(ca.Function("J", [X], [ca.densify(ca.jacobian(expression, X))])(point))
    np.testing.assert_allclose(
        complex_step(numpy_callable(function_of(expression)), point), expected, rtol=1e-12, atol=1e-15
    )


@settings(max_examples=150, deadline=None, derandomize=True)
@given(tree=trees(sorted(ONE), sorted(TWO)), point=POINTS)
def test_single_precision_is_kept(tree, point):
    function = function_of(tree)
    seen = []

    def watch(name, operation):
        def watched(*arguments):
            value = operation(*arguments)
            seen.append((name, np.result_type(value)))
            return value

        return watched

    import plantc.symbolic.expressions as module

    original = dict(module._NUMPY)
    try:
        module._NUMPY.update({key: watch(key, value) for key, value in original.items() if key != "_re"})
        (value,) = numpy_callable(function)(point.astype(np.float32))
    finally:
        module._NUMPY.update(original)
    assert value.dtype == np.float32
    inputs = any(step.operation == "input" for step in tape(function).steps)
    if inputs:
        wide = {name for name, kind in seen if kind == np.float64}
        constants = all(step.operation != "const" for step in tape(function).steps)
        assert not wide or not constants


def test_single_precision_differs_from_double():
    function = function_of(ca.if_else(X[0] < X[1], 3, 5) * X[2] / 3 + ca.fmin(X[0], 2) * 0.1)
    point = np.array([0.1, 0.2, 0.3])
    single = numpy_callable(function)(point.astype(np.float32))[0]
    double = numpy_callable(function)(point)[0]
    assert single.dtype == np.float32
    assert double.dtype == np.float64
    assert single[0] != double[0]
    assert abs(single[0] - double[0]) < 1e-6


def test_shapes_and_batches():
    matrix = ca.SX(2, 3)
    matrix[0, 1], matrix[1, 2] = X[0], X[1] * X[2]
    function = ca.Function("f", [X], [matrix, X[0]])
    call = numpy_callable(function)
    point = np.array([2.0, 3.0, 5.0])
    full, single = call(point)
    np.testing.assert_array_equal(full, [[0, 2, 0], [0, 0, 15]])
    assert single.shape == (1,)
    batch = np.stack([point, 2 * point], axis=1)
    full, single = call(batch)
    assert full.shape == (2, 3, 2)
    np.testing.assert_array_equal(full[1, 2], [15, 60])
    np.testing.assert_array_equal(single, [[2, 4]])
    two = ca.Function("g", [X, ca.SX.sym("u")], [X])
    assert numpy_callable(two)(batch, np.array([1.0]))[0].shape == (3, 2)


REFUSED = {
    "erf": ca.erf,
    "hypot": lambda a: ca.hypot(a, 2),
    "fmod": lambda a: ca.fmod(a, 2),
    "copysign": lambda a: ca.copysign(a, 2),
    "asinh": ca.asinh,
    "log1p": ca.log1p,
    "expm1": ca.expm1,
}


@pytest.mark.parametrize("name", REFUSED)
def test_an_operation_without_counterpart_is_named(name):
    with pytest.raises(
        ModelError, match=rf"the operation '{name}' in 'wing' has no counterpart .* rewrite it with .*atan2"
    ):
        tape(ca.Function("wing", [X], [REFUSED[name](X[0])]))


def test_a_function_that_cannot_be_expanded_is_named():
    z, p = ca.SX.sym("z"), ca.MX.sym("p")
    flow = ca.integrator("flow", "rk", {"x": z, "ode": -z}, 0, 1)
    with pytest.raises(ModelError, match="cart: the CasADi function 'wing' cannot be expanded into scalar operations"):
        expand(ca.Function("wing", [p], [flow(x0=p)["xf"]]), "cart")
    with pytest.raises(ModelError, match="cart: 3 is not a CasADi function"):
        expand(3, "cart")
    assert expand(ca.Function("f", [p], [ca.sin(p)]), "cart").is_a("SXFunction")


@settings(max_examples=100, deadline=None, derandomize=True)
@given(tree=trees(sorted(ONE), sorted(TWO)))
def test_every_step_comes_after_its_arguments_and_is_used(tree):
    record = tape(function_of(tree, X[1]))
    used = {item for output in record.outputs for item in output}
    for index, step in enumerate(record.steps):
        assert all(argument < index for argument in step.arguments)
        used |= set(step.arguments)
    assert used == set(range(len(record.steps)))
    assert len(set(record.steps)) == len(record.steps)


def sample_tape():
    a, b, c = (X[i] for i in range(3))
    shared = ca.sin(a) * b + ca.if_else(a < c, a, b * c)
    return repr(tape(function_of(ca.vertcat(shared**2, shared + a / b, ca.atan2(shared, c)))))


def test_the_tape_is_the_same_again_and_in_another_process():
    here = sample_tape()
    for k in range(50):  # CasADi numbers its nodes by address
        ca.SX.sym(f"noise{k}") ** k
    assert sample_tape() == here
    code = f"import sys; sys.path.insert(0, {os.path.dirname(__file__)!r}); import test_expressions as t; print(t.sample_tape())"
    for seed in ("1", "2"):
        run = subprocess.run(
            [sys.executable, "-c", code],
            env={**os.environ, "PYTHONHASHSEED": seed},
            capture_output=True,
            text=True,
            check=True,
        )
        assert run.stdout.strip() == here


def test_kinks_are_named():
    assert tape(function_of(ca.fabs(X[0]) + ca.floor(X[1]) + ca.sin(X[2]))).kinks == ["fabs", "floor"]
    assert tape(function_of(ca.sin(X[2]))).kinks == []


def test_all_numbers_of_an_expression_are_found():
    assert sorted(constants_of(ca.sin(2.5 * X[0]) + 7)) == [2.5, 7.0]
    assert any(np.isnan(item) for item in constants_of(ca.sin(X[0] * float("nan"))))


A, B, C = (ca.SX.sym(name) for name in "abc")
V = ca.SX.sym("v", 2)
NAMES = [(A, "a"), (B, "b"), (C, "c"), (V, "v")]


@pytest.mark.parametrize(
    ("expression", "text"),
    [
        (A + B * C, "a + b c"),
        ((A + B) * C, "(a + b) c"),
        (A - (B - C), "a - (b - c)"),
        (A / (B * C), "a / (b c)"),
        ((A / B) * C, "(a / b) c"),
        (A * B / C, "a b / c"),
        (-(A * B), "-(a b)"),
        (2 * (-A), "2 (-a)"),
        (A**2, "a^2"),
        ((A * B) ** 2, "(a b)^2"),
        ((A + 1) ** B, "(a + 1)^b"),
        (A**-1.5, "a^(-1.5)"),
        (A + A, "2 a"),
        (1 / (A + B), "1 / (a + b)"),
        (ca.sin(A) * 0.5, "0.5 sin(a)"),
        (ca.atan2(A, B), "atan2(a, b)"),
        (V[1] + V[0], "v[1] + v[0]"),
        (ca.if_else(A < B, A, 0), "(a if (a < b) else 0)"),
        (ca.SX(0), "0"),
        (9.81 * A, "9.81 a"),
    ],
)
def test_equations_read_like_equations(expression, text):
    assert equation_text(expression, NAMES) == [text]


def value_of(text, values):
    """Read an equation back as a person does: what stands side by side is multiplied, before a division."""
    import re

    tokens = re.findall(r"\d+\.?\d*(?:e[+-]?\d+)?|[a-z]+\d*|\S", text)
    position = 0

    def peek():
        return tokens[position] if position < len(tokens) else ""

    def take():
        nonlocal position
        position += 1
        return tokens[position - 1]

    def total():
        value = quotient()
        while peek() in ("+", "-"):
            value = value + quotient() if take() == "+" else value - quotient()
        return value

    def quotient():
        value = product()
        while peek() == "/":
            take()
            value = value / product()
        return value

    def product():
        value = signed()
        while peek() and peek() not in "+-/)^,":
            value = value * signed(allowed=False)
        return value

    def signed(*, allowed=True):
        if peek() == "-":
            assert allowed, text
            take()
            return -signed()
        return power()

    def power():
        value = atom()
        while peek() == "^":
            take()
            value = value ** atom()
        return value

    def atom():
        item = take()
        if item == "(":
            value = total()
            assert take() == ")"
            return value
        if item[0].isdigit():
            return float(item)
        if item in ("sin", "cos"):
            assert take() == "("
            value = total()
            assert take() == ")"
            return getattr(np, item)(value)
        return values[item]

    answer = total()
    assert position == len(tokens), text
    return answer


@settings(max_examples=150, deadline=None, derandomize=True)
@given(tree=trees(["neg", "inv", "sq", "twice", "sin", "cos"], ["add", "sub", "mul", "div"], 8), point=POINTS)
def test_an_equation_read_back_has_the_same_value(tree, point):
    names = [(X[i], f"x{i}") for i in range(3)]
    text = equation_text(ca.SX(tree), names)[0]
    expected = by_casadi(function_of(tree), point)[0][0]
    if not np.isfinite(expected) or abs(expected) > 1e6 or "inf" in text or "nan" in text:
        return
    with np.errstate(all="ignore"):
        found = value_of(text, {f"x{i}": np.float64(point[i]) for i in range(3)})
    np.testing.assert_allclose(found, expected, rtol=1e-6, atol=1e-6)


def test_a_long_equation_is_counted_instead():
    expression = A
    for _ in range(8):
        expression = expression * ca.sin(expression) + B
    assert equation_text(expression, NAMES, 100) == ["(an expression of 26 operations)"]
    assert len(equation_text(expression, NAMES, 10**7)[0]) > 1000
