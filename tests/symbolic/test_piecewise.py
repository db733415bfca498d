"""Piecewise-linear functions: values and derivatives, away from kinks and on them, in CasADi's VM and in NumPy."""

import casadi as ca
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from plantc.codegen.crosscheck import cross_check
from plantc.symbolic import ModelError, Plant, sign
from plantc.symbolic.estimators import extended_kalman_filter
from plantc.symbolic.expressions import PIECEWISE, Pieces, equation_text, expand, numpy_callable, tape
from plantc.symbolic.jump_matrix import jump_model
from plantc.symbolic.piecewise import dead_zone, look_up, maximum, minimum, relay, saturated

STEP = 1e-20
X = ca.SX.sym("x")
Y = ca.SX.sym("y")
AT = [-2.0, -1.0, 0.5, 0.75, 3.0]
OF = [1.0, 4.0, 4.0, -1.0, 0.5]
FUNCTIONS = {
    "saturated": (saturated(X, -1, 2), [-1.0, 2.0]),
    "saturated between expressions": (saturated(X, -Y, Y * Y), [-1.5, 2.25]),
    "dead zone": (dead_zone(X, -1, 2), [-1.0, 2.0]),
    "absolute value": (ca.fabs(X - 1), [1.0]),
    "minimum": (minimum(3 * X, Y), [0.5]),
    "maximum": (maximum(X, 0.25), [0.25]),
    "casadi's fmin and fmax": (ca.fmin(ca.fmax(X, -1), 2), [-1.0, 2.0]),
    "look-up": (look_up(X, AT, OF), AT),
    "look-up, evenly spaced": (look_up(2 * X, [-1, 0, 1, 2], [0, 3, -1, 5]), [-0.5, 0.0, 0.5, 1.0]),
}
"""Expression of x and y = 1.5, and where in x its kinks are."""
Y_VALUE = 1.5


def both(expression):
    """The value and both derivatives, by CasADi and by NumPy with the derivative from the complex step."""
    names = [X, Y]
    value = ca.Function("value", names, [expression])
    slopes = ca.Function("slopes", names, [ca.jacobian(expression, ca.vertcat(X, Y))])
    lowered, lowered_slopes = numpy_callable(value), numpy_callable(slopes)

    def at(x, y=Y_VALUE):
        arguments = np.array([x]), np.array([y])
        by_casadi = float(value(x, y)), np.array(ca.DM(slopes(x, y))).ravel()
        steps = [lowered(arguments[0] + 1j * STEP * (k == 0), arguments[1] + 1j * STEP * (k == 1)) for k in range(2)]
        complex_step = np.array([np.imag(step[0][0]) / STEP for step in steps])
        by_numpy = float(lowered(*arguments)[0][0]), complex_step
        return by_casadi, by_numpy, np.ravel(lowered_slopes(*arguments)[0])

    return at


AT_POINTS = {name: (both(expression), kinks) for name, (expression, kinks) in FUNCTIONS.items()}


@pytest.mark.parametrize("name", FUNCTIONS)
@given(x=st.floats(-10, 10))
def test_all_views_agree_anywhere(name, x):
    at, _ = AT_POINTS[name]
    (value, slopes), (other, complex_step), lowered = at(x)
    assert value == pytest.approx(other, rel=1e-14, abs=1e-14)
    np.testing.assert_allclose(slopes, complex_step, rtol=1e-14, atol=1e-14)
    np.testing.assert_allclose(slopes, lowered, rtol=1e-14, atol=1e-14)


@pytest.mark.parametrize("name", FUNCTIONS)
@given(x=st.floats(-10, 10))
def test_the_derivative_is_that_of_differences_away_from_kinks(name, x):
    at, kinks = AT_POINTS[name]
    h = 1e-4
    if min(abs(x - kink) for kink in kinks) <= 2 * h:
        return
    (_, slopes), _, _ = at(x)
    difference = (at(x + h)[0][0] - at(x - h)[0][0]) / (2 * h)
    assert slopes[0] == pytest.approx(difference, abs=1e-9)


@pytest.mark.parametrize("name", FUNCTIONS)
def test_at_a_kink_the_derivative_is_the_mean_of_both_sides_and_beside_it_that_of_one(name):
    at, kinks = AT_POINTS[name]
    for kink in kinks:
        h = 1e-3
        here = at(kink)[0][0]
        left, right = (here - at(kink - h)[0][0]) / h, (at(kink + h)[0][0] - here) / h
        assert left != pytest.approx(right, abs=1e-3)  # it is one
        for x, expected in (
            (kink, 0.5 * (left + right)),
            (np.nextafter(kink, -9), left),
            (np.nextafter(kink, 9), right),
        ):
            (_, slopes), (_, complex_step), lowered = at(x)
            assert slopes[0] == pytest.approx(expected, abs=1e-9)
            assert complex_step[0] == pytest.approx(expected, abs=1e-9)
            assert lowered[0] == pytest.approx(expected, abs=1e-9)


@given(x=st.floats(-10, 10))
def test_a_look_up_is_that_of_numpy(x):
    (value, _), _, _ = AT_POINTS["look-up"][0](x)
    assert value == pytest.approx(np.interp(x, AT, OF), rel=1e-14, abs=1e-14)


@pytest.mark.parametrize(("x", "value"), list(zip(AT, OF, strict=True)))
def test_a_look_up_is_exact_on_its_points(x, value):
    (found, _), (other, _), _ = AT_POINTS["look-up"][0](x)
    assert found == other == value


@given(
    points=st.lists(
        st.tuples(st.integers(-1000, 1000), st.floats(-100, 100)), min_size=2, max_size=30, unique_by=lambda p: p[0]
    ),
    x=st.floats(-1100, 1100),
)
def test_any_table_is_that_of_numpy(points, x):
    at, of = np.array(sorted(points)).T
    function = ca.Function("f", [X], [look_up(X, at, of)])
    assert float(function(x)) == pytest.approx(np.interp(x, at, of), rel=1e-12, abs=1e-12)


@pytest.mark.parametrize("limit", [-1.0, 2.0])
def test_on_a_limit_half_of_its_own_change_comes_through(limit):
    slopes = ca.Function("s", [X, Y], [ca.jacobian(saturated(X, -3, Y), Y), ca.jacobian(saturated(X, Y, 9), Y)])
    assert [float(item) for item in slopes(limit, limit)] == [0.5, 0.5]
    assert [float(item) for item in slopes(limit + 1, limit)] == [1.0, 0.0]
    assert [float(item) for item in slopes(limit - 1, limit)] == [0.0, 1.0]


@pytest.mark.parametrize("low", [-1.0, 0.5, 2.0])
@pytest.mark.parametrize("high", [-1.0, 0.5, 2.0])
@pytest.mark.parametrize("x", [-3.0, -1.0, 0.0, 0.5, 1.0, 2.0, 3.0])
def test_where_limits_meet_or_cross_the_upper_one_wins_in_value_and_slopes(x, low, high):
    """By CasADi, by NumPy and its complex step; where they do neither, the slopes are those of the sides, as ever."""
    z = ca.SX.sym("z", 3)
    held = saturated(z[0], z[1], z[2])
    value, slopes = ca.Function("value", [z], [held]), ca.Function("slopes", [z], [ca.jacobian(held, z)])
    at = np.array([x, low, high])
    if low >= high:
        expected = high, [0.0, 0.0, 1.0]
    else:
        expected = np.clip(x, low, high), [
            1.0 * (low < x < high) + 0.5 * (x in (low, high)), 1.0 * (x < low) + 0.5 * (x == low),
            1.0 * (x > high) + 0.5 * (x == high),
        ]  # fmt: skip
    lowered = numpy_callable(value)
    complex_step = [np.imag(lowered(at + 1j * STEP * row)[0][0]) / STEP for row in np.eye(3)]
    for found in (
        (float(value(at)), np.array(ca.DM(slopes(at))).ravel()),
        (float(lowered(at)[0][0]), complex_step),
        (float(lowered(at)[0][0]), np.ravel(numpy_callable(slopes)(at)[0])),
    ):
        assert found[0] == expected[0]
        np.testing.assert_allclose(found[1], expected[1], rtol=1e-14, atol=1e-14)


def test_a_filter_whose_limits_cross_gives_the_same_in_c_and_in_the_oracle():
    plant = Plant("crossing")
    a, b, c = (plant.state(name, range=(-2, 2)) for name in "abc")
    w = plant.noise("w", size=3, density=0.1)
    plant.dynamics({a: saturated(a, b, c) - a + w[0], b: -b + w[1], c: -c + w[2]})
    plant.sensor("z", ca.vertcat(a, b, c), variance=0.1)
    block = extended_kalman_filter(
        plant.discretise("euler", dt=0.1), initial_variance={a: 1.0, b: 1.0, c: 1.0}, around={a: 0.5, b: 1.0, c: -1.0}
    )
    assert cross_check(block, "double", steps=20).passed


def test_a_relay_has_a_value_at_zero_and_no_derivative():
    f = ca.Function("f", [X], [relay(X, 2), relay(X, 2, at_zero=-2), ca.jacobian(relay(X, 2, at_zero=1), X), sign(X)])
    g = numpy_callable(f)
    for x, expected in ((-3.0, [-2, -2, 0, -1]), (0.0, [0, -2, 0, 0]), (1e-300, [2, 2, 0, 1])):
        assert [float(item) for item in f(x)] == expected
        assert [float(np.ravel(item)[0]) for item in g(np.array([x]))] == expected


STRICT = [
    saturated(X, -1, 1), dead_zone(X, -1, 1), relay(X), relay(X, at_zero=1), ca.fabs(X), minimum(X, 0), minimum(Y, X), maximum(0, X),
    maximum(X, Y), look_up(X, [0, 1], [2, 3]), look_up(X, [0, 1, 3], [2, 2, 2]),
]  # fmt: skip


@pytest.mark.parametrize("expression", STRICT)
def test_not_a_number_is_passed_on(expression):
    function = ca.Function("f", [X, Y], [expression])
    assert np.isnan(float(function(np.nan, 0.5)))
    assert np.isnan(numpy_callable(function)(np.array([np.nan]), np.array([0.5]))[0][0])


def test_casadis_own_extremes_hide_it():
    function = ca.Function("f", [X], [ca.fmin(ca.fmax(X, -1), 1)])
    assert float(function(np.nan)) == -1


@pytest.mark.parametrize("x", [np.inf, -np.inf])
def test_infinity_is_held(x):
    f = ca.Function(
        "f", [X], [saturated(X, -1, 1), look_up(X, [0, 1], [2, 3]), ca.jacobian(look_up(X, [0, 1], [2, 3]), X)]
    )
    wanted = [1.0, 3.0, 0.0] if x > 0 else [-1.0, 2.0, 0.0]
    assert [float(item) for item in f(x)] == wanted
    assert [float(np.ravel(item)[0]) for item in numpy_callable(f)(np.array([x]))] == wanted


def test_vectors_are_taken_element_by_element():
    x = ca.SX.sym("x", 3)
    f = ca.Function("f", [x], [saturated(x, [-1, -2, -3], 1), look_up(x, [0, 1], [0, 5]), minimum(x, 0)])
    held, looked, least = (np.array(item).ravel() for item in f([-5.0, 0.5, 9.0]))
    assert held.tolist() == [-1.0, 0.5, 1.0]
    assert looked.tolist() == [0.0, 2.5, 5.0]
    assert least.tolist() == [-5.0, 0.0, 0.0]


def test_single_precision_stays_single():
    lowered = numpy_callable(ca.Function("f", [X], [look_up(X, [0.1, 0.7], [0.3, 0.9]) + saturated(X, 0.1, 2)]))
    assert lowered(np.array([0.2], dtype=np.float32))[0].dtype == np.float32


def test_second_derivatives_are_those_of_the_pieces():
    y = look_up(X * X, [0, 1, 4], [0, 1, 7])
    second = ca.Function("second", [X], [ca.hessian(y, X)[0]])
    assert float(second(1.5)) == pytest.approx(4.0)  # slope 2 times the curvature of x^2
    assert tape(second).outputs


def test_equal_calls_are_one_step_of_a_tape():
    operations = [
        step.operation for step in tape(ca.Function("f", [X], [look_up(X, AT, OF) + look_up(X, AT, OF)])).steps
    ]
    assert operations.count("look_up") == 1


def test_they_survive_a_function_of_matrix_expressions():
    inner = ca.Function("inner", [X], [look_up(X, AT, OF) + saturated(X, -1, 1)])
    m = ca.MX.sym("m")
    outer = expand(ca.Function("outer", [m], [inner(2 * m)]), "outer")
    assert {"look_up", "saturation"} <= {step.operation for step in tape(outer).steps}
    assert float(outer(0.2)) == float(inner(0.4))


def test_a_called_function_is_seen_through():
    called = ca.Function("called", [X, Y], [X * Y, ca.sin(X)], {"never_inline": True})
    value = ca.Function("value", [X], [called(X, 2)[0] + called(X, 2)[1]])
    assert expand(value, "value") is value
    assert numpy_callable(value)(np.array([0.3]))[0][0] == pytest.approx(0.6 + np.sin(0.3))


@pytest.mark.parametrize("name", sorted(PIECEWISE))
def test_a_function_of_ones_own_may_have_the_name_of_one_of_ours(name):
    soft = ca.Function(name, [X, Y], [-ca.log(ca.exp(-X) + ca.exp(-Y))], {"never_inline": True})
    value = ca.Function("value", [X, Y], [soft(X, Y)])
    assert expand(value, "value") is value
    assert numpy_callable(value)(np.zeros(1), np.zeros(1))[0][0] == pytest.approx(-np.log(2))
    assert {step.operation for step in tape(value).steps}.isdisjoint(PIECEWISE)


def test_their_text_is_short():
    assert equation_text(look_up(X, AT, OF), [(X, "x")]) == ["look_up(x, 5 points over -2 .. 3)"]
    assert equation_text(saturated(10 * X, -1, 1), [(X, "x")]) == ["saturation(10 x, -1, 1)"]


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: look_up(X, [0, 0], [1, 2]), "look_up: breakpoint 1 is 0, and the one before it 0; give them strictly increasing"),
        (lambda: look_up(X, [1], [2]), "look_up: 1 breakpoints; give 2 to 4096"),
        (lambda: look_up(X, [0, 1], [2]), "look_up: 2 breakpoints and 1 values; give one value for each breakpoint"),
        (lambda: look_up(X, [0, np.nan], [1, 2]), "give a sequence of finite numbers"),
        (lambda: look_up(X, [0, 1], [1, Y]), "look_up: the values are .*; give a sequence of finite numbers"),
        (lambda: look_up(X, [0, 5e-324], [1, 2]), "the slope between the breakpoints 0 and .* is not finite; move them apart"),
        (lambda: saturated(X, 1, 1), "saturated: the limits are 1 and 1; give the lower one first"),
        (lambda: saturated("x", 0, 1), "saturated: 'x' is no SX expression and no number"),
        (lambda: saturated(ca.MX.sym("m"), 0, 1), "is no SX expression and no number"),
        (lambda: minimum(ca.SX.sym("a", 2), ca.SX.sym("b", 3)), "give scalars, or one shape"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_a_sentence(make, said):
    with pytest.raises(ModelError, match=said):
        make()


def test_pieces_are_told_apart():
    pieces = Pieces(ca.Function("f", [X, Y], [saturated(X + Y, -1, 1) + look_up(X, [0, 1], [2, 3])]))
    assert [step.depends for step in pieces.steps] == [((0, 0), (1, 0)), ((0, 0),)]
    seen = [pieces.met(np.array([x]), np.array([0.0])) for x in (-2.0, -1.0, 0.5, 1.0, 2.0, np.nan)]
    assert seen == [
        ["saturation 1: piece 0", "look_up 2: piece 0"],
        ["saturation 1: kink 0", "look_up 2: piece 0"],
        ["saturation 1: piece 1", "look_up 2: piece 1"],
        ["saturation 1: kink 1", "look_up 2: kink 1"],
        ["saturation 1: piece 2", "look_up 2: piece 2"],
        [],
    ]


def test_the_table_is_part_of_the_model():
    def block(values):
        plant = Plant("tank", dt=0.1)
        level = plant.state("level")
        plant.dynamics({level: level - 0.01 * look_up(level, [0, 1, 2], values)})
        plant.sensor("gauge", level, variance=1.0)
        return plant

    from plantc import extended_kalman_filter

    hashes = {
        extended_kalman_filter(block(values), initial_variance={"level": 1.0}).model_hash()
        for values in ([0, 1, 4], [0, 1, 5], [0, 1, 4])
    }
    assert len(hashes) == 2


def test_they_are_found_and_held_by_the_jump_matrix_technique():
    plant = Plant("servo")
    x1, x2 = plant.state("x1", range=(-100, 100)), plant.state("x2", range=(-100, 100))
    w = plant.noise("w", density=0.1)
    plant.dynamics({x1: x2, x2: -x2 + saturated(10 * (1 - x1), -1, 1) - look_up(x2, [-1, 0, 2], [-3, 0, 1]) + w})
    plant.sensor("z", x1, variance=1.0)
    drag = look_up(x2, [-1, 0, 2], [-3, 0, 1])  # built anew: equal by structure
    model = jump_model(plant, {"amplified": saturated(10 * (1 - x1), -1, 1), "drag": drag}, dt=0.01)
    symbols = model.plant.x
    jump = ca.Function("jump", [symbols], [model.J, model.DJ])
    values, slopes = jump([0.9, 0.0, 7.0, 7.0])
    np.testing.assert_allclose(np.array(values).ravel(), [0.9, 0.0, 1.0, 0.0], atol=1e-12)
    assert float(slopes[3, 1]) == pytest.approx(1.75)  # on a breakpoint: the mean of 3 and 0.5
