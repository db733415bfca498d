"""The nonlinear regulator equations by power series, against specs/output_regulation.md, section 12 (S-0 to S-4)."""

import math
from dataclasses import replace
from math import comb

import casadi as ca
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from plantc.symbolic import cos, fabs, if_else, sin, sqrt
from plantc.symbolic.exosystems import compose, constant, exosystem, harmonic
from plantc.symbolic.expressions import tape
from plantc.symbolic.nonlinear_equations import monomial_matrices
from plantc.symbolic.power_series import regulator_series, series_solvability
from plantc.symbolic.regulator_equations import RegulatorError, francis
from plantc.symbolic.taylor import Monomials
from scipy.linalg import expm

from plantc import ModelError, Plant, linearise, lqr, trim

DIRECTION = (0.6, 0.8)
G, LENGTH = 9.81, 0.5


def plant_of(name, count, dynamics, inputs=("u",), dt=None):
    """A plant with states x1, x2, ..."""
    plant = Plant(name, dt=dt)
    states = [plant.state(f"x{k + 1}") for k in range(count)]
    plant.dynamics(dict(zip(states, dynamics(*states, *[plant.input(item) for item in inputs]), strict=True)))
    return plant


def cubic():  # S-0
    return plant_of("cubic", 1, lambda x, u: [x + x**3 + u])


def coupled():  # S-1
    return plant_of("coupled", 2, lambda a, b, u: [a * b + u, -b + a**2])


def cart_pole():  # S-2
    plant = Plant("cart_pole")
    p, v = plant.state("p", unit="m"), plant.state("v", unit="m/s")
    tilt, rate = plant.state("tilt", unit="rad"), plant.state("rate", unit="rad/s")
    push = plant.input("push", unit="m/s^2")
    plant.dynamics({p: v, v: push, tilt: rate, rate: (G * sin(tilt) - push * cos(tilt)) / LENGTH})
    return plant


def resonant():  # S-3
    return plant_of("resonant", 3, lambda a, b, c, u: [u, c + a**2, -4 * b])


@pytest.fixture(scope="module")
def pole():
    return regulator_series(cart_pole(), {}, harmonic("p", 2.0), 5)


def coefficient(maps, row, *exponents):
    """That of one monomial."""
    return maps[sum(exponents) - 1][row, Monomials(len(exponents), sum(exponents)).place(exponents)]


# -- S-0 to S-2 and S-4 -----------------------------------------------------------------------------------------------


def test_s0_the_cubic_is_exact():
    series = regulator_series(cubic(), {}, harmonic("x1", 1.0), 5)
    assert series.terms()[0] == [[((1, 0), pytest.approx(1))]]
    assert series.terms()[1] == [[((1, 0), pytest.approx(-1)), ((0, 1), pytest.approx(1)), ((3, 0), pytest.approx(-1))]]
    assert np.max(np.abs(series.residual([0.9, -1.7]))) < 1e-14


@pytest.mark.parametrize("omega", [1.0, 0.3, 4.0])
def test_s1_the_closed_form(omega):
    series = regulator_series(coupled(), {}, harmonic("x1", omega), 3)
    below = 1 + 4 * omega**2
    curve = [(1 + 2 * omega**2) / below, -2 * omega / below, 2 * omega**2 / below]
    np.testing.assert_allclose(series.state_maps[1], [[0, 0, 0], curve], atol=1e-14)
    np.testing.assert_allclose(series.input_maps[0], [[0, omega]], atol=1e-14)
    np.testing.assert_allclose(series.input_maps[2], [[*[-item for item in curve], 0]], atol=1e-14)
    assert not np.any(series.state_maps[2]) and not np.any(series.input_maps[1])


def test_s1_residuals_and_slopes():
    series = regulator_series(coupled(), {}, harmonic("x1", 1.0), 3)
    for order, sizes, slope in ((1, (0.0144, 0.0036, 0.0009), 2), (2, (1.344e-3, 1.68e-4, 2.1e-5), 3)):
        rows = series.truncated(order).slopes(DIRECTION, (0.2, 0.1, 0.05))
        assert [row[1] for row in rows] == pytest.approx(sizes, rel=1e-9)
        assert [row[2] for row in rows[:2]] == pytest.approx([slope, slope], abs=1e-6) and math.isnan(rows[2][2])
    exact = series.slopes(DIRECTION, (0.2, 0.1, 0.05))
    assert all(size < 1e-15 and math.isnan(slope) for _, size, slope in exact)


def test_s2_the_cart_pole(pole):
    assert pole.states == ("p", "v", "tilt", "rate") and pole.exosystem_states == ("p_0", "p_1")
    one, three = pole.state_maps[0], pole.state_maps[2]
    np.testing.assert_allclose(one[:2], [[1, 0], [0, 2]], atol=1e-14)
    np.testing.assert_allclose(pole.input_maps[0], [[-4, 0]], atol=1e-14)
    assert coefficient(pole.state_maps, 2, 1, 0) == pytest.approx(-4 / (G + LENGTH * 4), rel=1e-13)
    assert coefficient(pole.state_maps, 2, 1, 0) == pytest.approx(-0.33869602, abs=5e-9)
    assert coefficient(pole.state_maps, 3, 0, 1) == pytest.approx(-0.677392041, abs=5e-10)
    np.testing.assert_allclose(three[2], [0.012027259, 0, 0.00606161733, 0], atol=5e-10)
    np.testing.assert_allclose(three[3], [0, 0.047917085, 0, 0.0121232347], atol=5e-10)
    ratio = coefficient(pole.state_maps, 2, 1, 2) / coefficient(pole.state_maps, 2, 3, 0)
    assert ratio == pytest.approx(24 / 47.62, rel=1e-12)
    assert not np.any(three[:2]) and not any(np.any(item) for item in pole.input_maps[1:])
    assert not np.any(pole.state_maps[1]) and not np.any(pole.state_maps[3])  # the plant is odd


def test_s2_residuals_and_slopes(pole):
    for order, sizes, slope in (
        (1, (4.584e-3, 5.733e-4, 7.167e-5), 3),
        (2, (4.584e-3, 5.733e-4, 7.167e-5), 3),
        (3, (3.162e-5, 9.895e-7, 3.093e-8), 5),
        (5, (3.217e-7, 2.518e-9, 1.968e-11), 7),  # sizes of order 5 are measured, not of the spec
    ):
        rows = pole.truncated(order).slopes(DIRECTION, (0.4, 0.2, 0.1))
        assert [row[1] for row in rows] == pytest.approx(sizes, rel=2e-4)
        assert [row[2] for row in rows[:2]] == pytest.approx([slope, slope], abs=5e-3)


def test_s4_discrete_coupled():
    plant = coupled().discretise("euler", dt=0.1)
    series = regulator_series(plant, {}, harmonic("x1", 1.0).sampled(0.1), 3)
    for order, slope in ((1, 2), (2, 3)):
        rows = series.truncated(order).slopes(DIRECTION, (0.2, 0.1, 0.05))
        assert [row[2] for row in rows[:2]] == pytest.approx([slope, slope], abs=1e-6)
    assert np.linalg.norm(series.residual(0.2 * np.array(DIRECTION))) < 1e-15


def closed_loop_errors(pole, cases, gain):
    """Largest |e| over the last three periods of 30 s, for pairs (order, amplitude): RK4, 0.005 s, from rest."""
    rows = [[] for _ in range(5)]
    for item, terms in zip(rows, [*pole.terms()[0], *pole.terms()[1]], strict=True):
        item += [
            (value, exponents, [float(order >= sum(exponents)) for order, _ in cases]) for exponents, value in terms
        ]
    size = np.array([amplitude for _, amplitude in cases])

    def maps(t):
        w = size * np.sin(2 * t), size * np.cos(2 * t)
        return np.array(
            [sum(np.array(used) * value * w[0] ** e[0] * w[1] ** e[1] for value, e, used in item) for item in rows]
        )

    def rate(x, held):
        u = held[4] - gain @ (x - held[:4])
        return np.array([x[1], u, x[3], (G * np.sin(x[2]) - u * np.cos(x[2])) / LENGTH])

    h, x, worst = 0.005, np.zeros((4, len(cases))), np.zeros(len(cases))
    before = maps(0.0)
    for k in range(6000):
        middle, after = maps((k + 0.5) * h), maps((k + 1) * h)
        k1 = rate(x, before)
        k2 = rate(x + h / 2 * k1, middle)
        k3 = rate(x + h / 2 * k2, middle)
        k4 = rate(x + h * k3, after)
        x, before = x + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4), after
        if (k + 1) * h >= 30 - 3 * np.pi:
            worst = np.maximum(worst, np.abs(x[0] - size * np.sin(2 * (k + 1) * h)))
    return worst


def test_s2_the_closed_loop(pole):
    plant = cart_pole()
    gain = lqr(linearise(plant), np.diag([10.0, 1, 10, 1]), np.eye(1)).gain[0]
    np.testing.assert_allclose(np.abs(gain), [3.1622777, 4.176126, 35.310081, 8.0023628], rtol=1e-7)
    cases = [(order, amplitude) for amplitude in (0.4, 0.8) for order in (1, 3, 5)]
    errors = closed_loop_errors(pole, cases, gain)
    assert errors == pytest.approx([4.558e-3, 4.47e-5, 5.5e-7, 3.775e-2, 1.469e-3, 7.16e-5], rel=1e-2)


# -- what no solution has ---------------------------------------------------------------------------------------------


def test_s3_fails_at_degree_two():
    generator = harmonic("x1", 1.0)
    one, two = series_solvability(resonant(), {}, generator, 2)
    assert [(mode.eigenvalue, mode.rank, mode.needed) for mode in one] == [(1j, 4, 4)]
    assert {mode.eigenvalue: (mode.rank, mode.needed) for mode in two} == {0j: (4, 4), 2j: (3, 4)}
    assert regulator_series(resonant(), {}, generator, 1).order == 1
    with pytest.raises(RegulatorError) as caught:
        regulator_series(resonant(), {}, generator, 3)
    for part in ("resonant, degree 2", "at 0+-2j the rank is 3 of 4", "10 of 12", "residual 0.66666667", "sums of 2"):
        assert part in str(caught.value)


def test_s3_in_discrete_time_the_eigenvalue_is_a_product():
    turn = harmonic("x1", 1.0).sampled(0.1)
    c, s = math.cos(0.2), math.sin(0.2)
    plant = plant_of("resonant", 3, lambda a, b, q, u: [u, c * b + s * q + a**2, -s * b + c * q], dt=0.1)
    with pytest.raises(RegulatorError, match=r"degree 2 \(whose eigenvalues are products of 2.*0\.980067\+-0\.198669j"):
        regulator_series(plant, {}, turn, 2)


def test_a_near_failure_of_a_degree_is_said_and_the_coefficients_grow():
    for away in (1e-1, 1e-2, 1e-3):
        square = (2 + away) ** 2
        plant = plant_of("nearly", 3, lambda a, b, c, u, s=square: [u, c + a**2, -s * b])
        series = regulator_series(plant, {}, harmonic("x1", 1.0), 2)
        assert series.state_maps[1][1] == pytest.approx([0, 2 / (square - 4), 0], rel=1e-9, abs=1e-9)
    assert any("degree 2: a transmission zero is 0.001 from the eigenvalue 0+-2j" in text for text in series.warnings)


def test_too_few_inputs_may_fail_at_a_degree():
    plant = plant_of("two", 2, lambda a, b, u: [b, u + a**2])  # x2 = d/dt x1 at every degree
    generator = exosystem([[0, 1], [-1, 0]], np.eye(2), ["x1", "x2"])
    series = regulator_series(plant, {}, generator, 2)
    np.testing.assert_allclose(series.input_maps[1], [[-1, 0, 0]], atol=1e-12)
    bent = plant_of("two", 2, lambda a, b, u: [b + a**2, u])
    with pytest.raises(RegulatorError, match=r"two, degree 2 .*1 input\(s\) act on 2 regulated output\(s\)"):
        regulator_series(bent, {}, generator, 2)


def test_more_inputs_than_outputs_the_least_solution():
    plant = plant_of("wide", 1, lambda x, a, b: [x**2 + a + 2 * b], inputs=("a", "b"))
    series = regulator_series(plant, {}, harmonic("x1", 1.0), 2)
    np.testing.assert_allclose(series.input_maps[1], [[-0.2, 0, 0], [-0.4, 0, 0]], atol=1e-14)
    assert any("degree 2: 3 of 9 numbers are free" in text for text in series.warnings)


# -- against other ways -----------------------------------------------------------------------------------------------


def test_degree_one_is_francis(pole):
    found = francis(linearise(cart_pole()), harmonic("p", 2.0))
    np.testing.assert_allclose(pole.state_maps[0], found.state_map, atol=1e-14)
    np.testing.assert_allclose(pole.input_maps[0], found.input_map, atol=1e-14)


def test_about_a_set_point_the_root_is_expanded():
    plant = Plant("rotor")
    height, climb, speed = plant.state("height"), plant.state("climb"), plant.input("speed", range=(0, 1000))
    lift = plant.parameter("lift", 2e-4, range=(1e-5, 1e-3))
    plant.dynamics({height: climb, climb: lift * speed**2 - G})
    point = trim(plant, hold={height: 3.0})
    series = regulator_series(plant, point, harmonic("height", 1.5), 5)
    level = math.sqrt(G / 2e-4)
    for degree in range(1, 6):
        fraction = np.prod([0.5 - k for k in range(degree)]) / math.factorial(degree)
        wanted = level * fraction * (-(1.5**2) / G) ** degree
        assert series.input_maps[degree - 1][0] == pytest.approx([wanted, *[0] * degree], abs=1e-12)
    assert np.max(np.abs(series.at([0.2, 0.4])[1] - (math.sqrt((G - 2.25 * 0.2) / 2e-4) - level))) < 1e-5


def test_measured_disturbances_enter_as_they_are():
    plant = plant_of("windy", 1, lambda x, u, wind: [u + wind**2 * cos(x)], inputs=("u", "wind"))
    series = regulator_series(plant, {}, compose([harmonic("x1", 1.0), constant("wind")]), 4)
    gamma = [((0, 1, 0), 1.0), ((0, 0, 2), -1.0), ((2, 0, 2), 0.5)]  # w2 - d^2 (1 - w1^2 / 2)
    assert [(item, pytest.approx(value)) for item, value in series.terms()[1][0]] == gamma
    assert series.inputs == ("u",) and series.states == ("x1",)


def test_a_sensor_may_be_nonlinear_and_have_feedthrough():
    plant = plant_of("seen", 1, lambda x, u: [u - x])
    plant.sensor("height", sin(plant.states[0].symbol) + 0.5 * plant.inputs[0] ** 2 + 0.1 * plant.inputs[0], std=1e-2)
    series = regulator_series(plant, {}, harmonic("height", 0.7), 4)
    rows = series.slopes(DIRECTION, (0.02, 0.01, 0.005))
    assert [row[2] for row in rows[:2]] == pytest.approx([5, 5], abs=0.2)


def bent_generator(dt=None):
    """The harmonic in other coordinates, w = (v1, v2 + v1^2), as a plant."""
    plant = Plant("bent", dt=dt)
    a, b = plant.state("a"), plant.state("b")
    v = ca.vertcat(a, b - a**2)
    if dt is None:
        plant.dynamics({a: v[1], b: -a + 2 * a * v[1]})
    else:
        after = ca.DM(harmonic("a", 1.0).sampled(dt).matrix) @ v
        plant.dynamics({a: after[0], b: after[1] + after[0] ** 2})
    plant.sensor("x1", a, std=1e-2)
    return plant


@pytest.mark.parametrize("dt", [None, 0.1])
def test_a_nonlinear_exosystem(dt):
    plant = coupled() if dt is None else coupled().discretise("euler", dt=dt)
    linear = harmonic("x1", 1.0) if dt is None else harmonic("x1", 1.0).sampled(dt)
    bent, straight = regulator_series(plant, {}, bent_generator(dt), 6), regulator_series(plant, {}, linear, 3)
    for v in ((0.3, -0.8), (0.9, 0.5)):  # both are polynomials: pi(w(v)) has degree 4 in w, gamma 5
        pairs = zip(bent.at([v[0], v[1] + v[0] ** 2]), straight.at(v), strict=True)
        for ours, wanted in pairs:
            np.testing.assert_allclose(ours, wanted, atol=1e-13)
    assert bent.exosystem_states == ("a", "b")
    without = replace(bent, state_maps=(bent.state_maps[0], *[0 * item for item in bent.state_maps[1:]]))
    assert np.linalg.norm(without.residual([0.3, 0.2])) > 1e-3 > 1e-13 > np.linalg.norm(bent.residual([0.3, 0.2]))


def test_van_der_pol_drives_a_pendulum():
    generator = Plant("van_der_pol")
    a, b = generator.state("a"), generator.state("b")
    generator.dynamics({a: b, b: -a + 0.5 * (1 - a**2) * b})
    generator.sensor("p", a, std=1e-2)
    series = regulator_series(cart_pole(), {}, generator, 3)
    rows = series.slopes(DIRECTION, (0.04, 0.02, 0.01))
    assert [row[2] for row in rows[:2]] == pytest.approx([5, 5], abs=0.05)
    assert any("grows" in text for text in series.warnings)


@given(
    S=st.lists(st.floats(-1, 1), min_size=9, max_size=9),
    w=st.lists(st.floats(-2, 2), min_size=3, max_size=3),
)
def test_monomials_go_on_with_their_matrices(S, w):
    matrix, point, space = np.reshape(S, (3, 3)), np.array(w), Monomials(3, 3)
    stepped = monomial_matrices(space, matrix, discrete=True)
    flowing = monomial_matrices(space, matrix, discrete=False)
    for degree in (1, 3):
        scale = 1e-13 * 50**degree
        now = space.values(degree, point)
        np.testing.assert_allclose(stepped[degree] @ now, space.values(degree, matrix @ point), atol=scale)
        np.testing.assert_allclose(
            expm(0.3 * flowing[degree]) @ now, space.values(degree, expm(0.3 * matrix) @ point), atol=scale
        )


def test_the_twelve_states_of_a_quadrotor_are_no_matter_of_size():
    """A quadrotor with small angles kept nonlinear, two harmonics and a constant: 5 exosystem states, degree 3."""
    plant = Plant("quadrotor")
    x = [plant.state(f"x{k + 1}") for k in range(12)]
    u = [plant.input(f"u{k + 1}") for k in range(4)]
    lift = G + u[0]
    rates = {x[k]: x[k + 1] for k in range(0, 12, 2)}
    rates |= {x[1]: (sin(x[10]) * sin(x[6]) + cos(x[10]) * sin(x[8]) * cos(x[6])) * lift}
    rates |= {x[3]: (-cos(x[10]) * sin(x[6]) + sin(x[10]) * sin(x[8]) * cos(x[6])) * lift}
    rates |= {x[5]: cos(x[8]) * cos(x[6]) * lift - G}
    rates |= {x[7]: u[1] - 0.75 * x[9] * x[11], x[9]: u[2] + 0.75 * x[7] * x[11], x[11]: u[3]}
    plant.dynamics(rates)
    generator = compose([harmonic("x1", 0.3), harmonic("x3", 0.5), constant("x11")])
    generator = compose([generator, exosystem(np.zeros((0, 0)), np.zeros((1, 0)), ["x5"])])
    series = regulator_series(plant, {}, generator, 3)
    direction = np.array([0.6, 0.8, 0.5, -0.3, 0.7])
    rows = series.slopes(direction, (0.4, 0.2, 0.1))
    assert [row[2] for row in rows[:2]] == pytest.approx([4, 4], abs=0.1)


# -- planted faults ---------------------------------------------------------------------------------------------------


def test_a_dropped_term_is_seen_by_the_slope(pole):
    maps = [np.array(item) for item in pole.state_maps]
    maps[2][2, Monomials(2, 3).place((1, 2))] = 0.0
    faulty = replace(pole, state_maps=tuple(maps))
    sound, rows = (item.slopes(DIRECTION, (0.4, 0.2, 0.1)) for item in (pole, faulty))
    assert [row[2] for row in sound[:2]] == pytest.approx([7, 7], abs=0.05)
    assert [row[2] for row in rows[:2]] == pytest.approx([3, 3], abs=0.05)
    assert rows[2][1] > 1e4 * sound[2][1]


def test_a_forgotten_term_of_the_flow_is_seen(monkeypatch):
    from plantc.symbolic.nonlinear_equations import NonlinearEquations

    monkeypatch.setattr(NonlinearEquations, "_moved", lambda self, states, degree: 0.0)
    faulty = regulator_series(coupled(), {}, bent_generator(), 3)
    assert faulty.slopes(DIRECTION, (0.2, 0.1))[0][2] < 3.2  # 4 where it is not forgotten


# -- the record -------------------------------------------------------------------------------------------------------


def test_the_record_of_a_design(pole):
    values = pole.rounded()
    assert {name: item.size for name, item in values.items()} == {"state_coefficients": 14, "input_coefficients": 1}
    assert all(measured <= limit for measured, limit in pole.properties().values())
    again = pole.with_coefficients(values)
    np.testing.assert_allclose(again.state_maps[2], pole.state_maps[2], rtol=5e-9)
    assert pole.source() == regulator_series(cart_pole(), {}, harmonic("p", 2.0), 5).source()
    assert pole.source() != regulator_series(cart_pole(), {}, harmonic("p", 2.1), 5).source()
    assert pole.source() != regulator_series(cart_pole(), {}, harmonic("p", 2.0), 3).source()
    wrong = {**values, "state_coefficients": values["state_coefficients"] * (1 + 1e-6 * np.arange(14))}
    assert any(measured > limit for measured, limit in pole.properties(wrong).values())
    with pytest.raises(ModelError, match="3 state coefficients are given; the series has 14"):
        pole.with_coefficients({**values, "state_coefficients": [1, 2, 3]})


def operations(function):
    return sum(step.operation not in ("input", "const") for step in tape(function).steps)


def test_expressions_are_the_numbers(pole):
    w = ca.SX.sym("w", 2)
    states, inputs = pole.expressions(w)
    function = ca.Function("maps", [w], [states, inputs])
    for point in ((0.3, -0.7), (0.8, 0.1)):
        for ours, wanted in zip(function(point), pole.at(point), strict=True):
            np.testing.assert_allclose(np.array(ours).ravel(), wanted, rtol=1e-7, atol=1e-9)
    written_out = [sum(c * w[0] ** e[0] * w[1] ** e[1] for e, c in row) for row in (*pole.terms()[0], *pole.terms()[1])]
    long = ca.Function("long", [w], [ca.vertcat(*written_out)])
    assert operations(function) < 0.7 * operations(long)


# -- bad input --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("term", "word"),
    [
        (lambda x: fabs(x), "uses fabs"),
        (lambda x: if_else(x > 0, x, 0), "uses"),
        (lambda x: ca.floor(x), "uses floor"),
        (lambda x: ca.fmin(x, 1), "uses fmin"),
        (lambda x: sqrt(x + 0.0), "square root of 0"),
        (lambda x: 1 / x, "divides by zero"),
    ],
)
def test_what_has_no_power_series_is_named(term, word):
    plant = plant_of("kinked", 2, lambda a, b, u: [b, u + b + term(a)])
    with pytest.raises(ModelError, match=rf"kinked: .*{word}") as caught:
        regulator_series(plant, {}, harmonic("x1", 1.0), 2)
    assert "x2" in str(caught.value) and str(caught.value).count("\n") == 0


def test_an_operation_without_counterpart_names_its_equation():
    plant = plant_of("odd", 2, lambda a, b, u: [b, u + ca.asinh(a)])
    with pytest.raises(ModelError, match=r"odd: in the rate of x2, the operation 'asinh'"):
        regulator_series(plant, {}, harmonic("x1", 1.0), 2)


@pytest.mark.parametrize("order", [0, 16, 2.0, "3"])
def test_the_order_is_a_whole_number(order):
    with pytest.raises(ModelError, match="the order of the series"):
        regulator_series(cubic(), {}, harmonic("x1", 1.0), order)


def test_refusals():
    plant = coupled()
    with pytest.raises(ModelError, match="coupled is continuous and the exosystem .* is discrete with dt = 0.1 s"):
        regulator_series(plant, {}, harmonic("x1", 1.0).sampled(0.1), 2)
    with pytest.raises(ModelError, match=r"no equilibrium \(x2 has the rate 0.25\); take that of trim"):
        regulator_series(plant, {"x1": 0.5}, harmonic("x1", 1.0), 2)
    moved = coupled().discretise("euler", dt=0.1)
    with pytest.raises(ModelError, match="no equilibrium .x2 changes in a step by 0.025"):
        regulator_series(moved, {"x1": 0.5, "u": 0.0}, harmonic("x1", 1.0).sampled(0.1), 2)
    with pytest.raises(ModelError, match="has no state"):
        regulator_series(plant, {}, compose([]), 2)
    many = compose([constant(f"x{k + 1}") for k in range(12)])
    wide = plant_of("wide", 12, lambda *x: list(x[12:]), inputs=[f"u{k}" for k in range(12)])
    with pytest.raises(ModelError, match="12 exosystem states have 1365 monomials of degree 4, more than 1000"):
        regulator_series(wide, {}, many, 4)
    assert comb(15, 4) == 1365
    spinning = Plant("spinning")
    attitude = spinning.attitude("q")
    spinning.dynamics({attitude: spinning.input("rate", size=3)})
    with pytest.raises(ModelError, match="an attitude has no deviation that is a power series"):
        regulator_series(spinning, {}, harmonic("q", 1.0), 2)
    with pytest.raises(ModelError, match="its dt is an input"):
        regulator_series(coupled().discretise("rk4", dt=(0.01, 0.1)), {}, harmonic("x1", 1.0), 2)
    with pytest.raises(ModelError, match="the series has order 2; cut it off at 1 to 2"):
        regulator_series(plant, {}, harmonic("x1", 1.0), 2).truncated(3)
    with pytest.raises(ModelError, match=r"w has shape \(3,\); give 2 finite numbers"):
        regulator_series(plant, {}, harmonic("x1", 1.0), 2).residual([1, 2, 3])


def test_what_is_no_exosystem():
    with pytest.raises(ModelError, match="the exosystem is ndarray; give an Exosystem, or a Plant"):
        regulator_series(coupled(), {}, np.eye(2), 2)
    with pytest.raises(ModelError, match=r"coupled: as an exosystem it has 1 input\(s\), 0 sensor\(s\)"):
        regulator_series(coupled(), {}, coupled(), 2)
    with pytest.raises(ModelError, match="bent: the exosystem is discrete with dt = 0.1 s and the plant continuous"):
        regulator_series(coupled(), {}, bent_generator(0.1), 2)
    restless = Plant("restless")
    a = restless.state("a")
    restless.dynamics({a: 1 - a})
    restless.sensor("x1", a, std=1e-2)
    with pytest.raises(ModelError, match="restless: at w = 0 .* 'a' is 1"):
        regulator_series(coupled(), {}, restless, 2)
