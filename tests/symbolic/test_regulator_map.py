"""The block of a power series: polynomial C against NumPy."""

from dataclasses import replace

import casadi as ca
import numpy as np
import pytest
from plantc.codegen import InterpretView
from plantc.reference.power_series import Polynomial, RegulatorMap
from plantc.symbolic import cos, sin
from plantc.symbolic.exosystems import compose, constant, harmonic
from plantc.symbolic.power_series import regulator_series
from plantc.symbolic.regulator_equations import RegulatorError
from plantc.symbolic.regulator_map import regulator_feedback, regulator_map

from plantc import ModelError, Plant, cross_check, linearise, lqr, trim


def cart_pole():
    plant = Plant("cart_pole")
    p, v = plant.state("p", unit="m", range=(-3, 3)), plant.state("v", unit="m/s", range=(-9, 9))
    tilt, rate = plant.state("tilt", angle=True, unit="rad"), plant.state("rate", unit="rad/s", range=(-9, 9))
    push = plant.input("push", unit="m/s^2", range=(-20, 20))
    plant.dynamics({p: v, v: push, tilt: rate, rate: (9.81 * sin(tilt) - push * cos(tilt)) / 0.5})
    return plant


@pytest.fixture(scope="module")
def series():
    return regulator_series(cart_pole(), {}, harmonic("p", 2.0), 5)


@pytest.fixture(scope="module")
def block(series):
    return regulator_map(series, amplitude=0.8)


def run(block, **inputs):
    view = InterpretView(block)
    params = view.params()
    return view.call("step", view.init(params), view.inputs("step", inputs), params)


def test_its_signals(block):
    step = block.entries["step"]
    assert [(item.name, item.size) for item in step.inputs] == [("w", 2)] and step.inputs[0].high == (0.8, 0.8)
    assert [(item.name, item.unit) for item in step.outputs][-2:] == [("rate", "rad/s"), ("push", "m/s^2")]
    sizes = {signal.name: signal.size for signal in block.param_signals}
    assert sizes["state_coefficients"] == 14 and sizes["input_coefficients"] == 1


@pytest.mark.parametrize("precision", ["double", "float"])
def test_the_c_is_what_numpy_says(needs, block, precision):
    needs("gcc")
    assert cross_check(block, precision).passed


def test_a_wrong_coefficient_or_exponent_is_seen(needs, block):
    needs("gcc")
    oracle = block.oracle
    formula = oracle.formulas["step"]
    name, rows, angle = formula.outputs[2]
    bent = replace(rows[0], exponents=(*rows[0].exponents[:-1], (0, 5)))
    faulty = RegulatorMap(formula.inputs, (*formula.outputs[:2], (name, (bent,), angle), *formula.outputs[3:]))
    block.oracle = replace(oracle, formulas={"step": faulty})
    try:
        assert not cross_check(block, "double").passed
    finally:
        block.oracle = oracle


def test_about_a_set_point_outputs_are_absolute():
    plant = Plant("rotor")
    height, climb = plant.state("height", range=(-9, 9)), plant.state("climb", range=(-9, 9))
    speed, wind = plant.input("speed", range=(0, 1000)), plant.input("wind", range=(-9, 9))
    plant.dynamics({height: climb, climb: 2e-4 * speed**2 - 9.81 + wind})
    point = trim(plant, hold={height: 3.0, wind: 0.5})
    series = regulator_series(plant, point, compose([harmonic("height", 1.5), constant("wind")]), 7)
    w = np.array([0.4, 0.1, 0.2])
    out = run(regulator_map(series, amplitude=[0.5, 0.5, 0.3]), w=w).outputs
    assert float(out["height"]) == pytest.approx(3.4, abs=1e-8) and float(out["climb"]) == pytest.approx(0.15, abs=1e-8)
    assert float(out["speed"]) == pytest.approx(np.sqrt((9.81 - 0.7 - 2.25 * 0.4) / 2e-4), rel=1e-6)
    assert "wind" not in out.dtype.names


def test_an_angle_is_wrapped(series):
    plant = series.plant
    far = regulator_map(regulator_series(plant, {"tilt": np.pi}, harmonic("p", 2.0), 3), amplitude=0.8)
    for w in ([0.5, 0.0], [-0.5, 0.0]):
        assert abs(float(run(far, w=w).outputs["tilt"])) <= np.pi


def test_the_states_of_a_plant_as_exosystem_are_its_inputs():
    generator = Plant("clock")
    a, b = generator.state("a", unit="m"), generator.state("b", unit="m/s")
    generator.dynamics({a: b, b: -a + 0.1 * (1 - a**2) * b})
    generator.sensor("p", a, std=1e-2)
    block = regulator_map(regulator_series(cart_pole(), {}, generator, 3), amplitude=0.5, name="where")
    assert [(item.name, item.unit) for item in block.entries["step"].inputs] == [("a", "m"), ("b", "m/s")]
    assert float(run(block, a=0.3, b=0.1).outputs["p"]) == pytest.approx(0.3)


def test_beyond_the_amplitude_it_is_refused(block):
    assert run(block, w=[0.3, 0.81]).status.name == "BAD_INPUT"
    assert run(block, w=[0.3, 0.79]).status.name == "OK"


def test_its_record_brings_other_coefficients(block, series):
    values = {name: 2 * item for name, item in block.design.values.items()}
    again = block.design.rebuild(values)
    once, twice = (run(item, w=[0.3, 0.2]).outputs for item in (block, again))
    assert float(twice["push"]) == 2 * float(once["push"])
    assert all(measured <= limit for measured, limit in block.design.properties(block.design.values).values())
    assert any(measured > limit for measured, limit in again.design.properties(values).values())
    assert block.design.source == series.source() == again.design.source
    with pytest.raises(ModelError, match="2 input coefficients are given"):
        block.design.rebuild({**values, "input_coefficients": [1.0, 2.0]})


def test_its_table_says_how_far_it_holds(block):
    table = next(iter(block.tables.values()))()
    sizes = [row[1] for row in table.rows]
    assert [row[0] for row in table.rows] == [1.0, 0.5, 0.25]
    assert 100 < sizes[0] / sizes[1] < 150 and 100 < sizes[1] / sizes[2] < 150  # 2^7: the series ends at degree 5


@pytest.mark.parametrize("amplitude", [0, -1, [0.1, 0.2, 0.3], "wide", float("nan")])
def test_the_amplitude_is_positive(series, amplitude):
    with pytest.raises(ModelError, match="the amplitude is"):
        regulator_map(series, amplitude=amplitude)


def test_other_sizes_are_sentences(series, regulator):
    values = regulator.design.values
    for make, says in (
        (lambda: series.at([1.0, 2.0, 3.0]), r"w has shape \(3,\); give 2 finite numbers"),
        (lambda: series.at("here"), "w is 'here'; give 2"),
        (lambda: series.slopes([1.0], [0.2, 0.1]), r"the direction of w has shape \(1,\); give 2"),
        (lambda: series.expressions(ca.SX.sym("w", 3)), r"w has 3 element\(s\); give 2"),
        (lambda: series.truncated("low"), "cut it off at 1 to 5"),
        (
            lambda: regulator.design.rebuild({**values, "gain": ["much"] * 4}),
            "the gain of design.json is .*; give a matrix",
        ),
        (lambda: regulator.design.properties({**values, "gain": np.ones((3, 1))}), r"has shape \(3, 1\); give 1 x 4"),
    ):
        with pytest.raises(ModelError, match=says):
            make()


def test_a_vector_input_acts_as_a_whole():
    plant = Plant("pair")
    x, u = plant.state("x"), plant.input("u", size=2)
    plant.dynamics({x: u[0] + u[1]})
    series = regulator_series(plant, {}, compose([harmonic("x", 1.0), constant("u_1")]), 1)
    with pytest.raises(ModelError, match="of the input 'u' only u_0 act"):
        regulator_map(series, amplitude=1.0)


def test_the_oracle_keeps_single_precision():
    row = Polynomial(("x", 0), ("c", 1), ((2, 0), (0, 1)))
    params = {"x": np.array([1], np.float32), "c": np.array([9, 2, 3], np.float32)}
    value = row.value(np.array([0.5, 0.25], np.float32), params)
    assert value.dtype == np.float32 and float(value) == 1 + 2 * 0.25 + 3 * 0.25


# -- with feedback ----------------------------------------------------------------------------------------------------


def gain_of(plant):
    return lqr(linearise(plant), np.diag([10.0, 1, 10, 1]), np.eye(1))


@pytest.fixture(scope="module")
def regulator(series):
    return regulator_feedback(series, gain_of(series.plant), amplitude=0.8, saturate=True)


@pytest.mark.parametrize("precision", ["double", "float"])
def test_the_c_of_a_regulator_is_what_numpy_says(needs, regulator, precision):
    needs("gcc")
    found = cross_check(regulator, precision)
    assert found.passed and {"OK", "CLAMPED", "BAD_INPUT"} <= set(found.statuses)


def test_the_law(series, regulator):
    w, x = np.array([0.3, -0.2]), np.array([0.2, -0.3, 0.05, 0.1])
    pi, gamma = series.at(w)
    command = gamma - gain_of(series.plant).gain @ (x - pi)
    out = run(regulator, w=w, p=x[0], v=x[1], tilt=x[2], rate=x[3]).outputs
    assert out.dtype.names == ("push",) and float(out["push"]) == pytest.approx(command[0], rel=1e-7)
    turned = run(regulator, w=w, p=x[0], v=x[1], tilt=3.1, rate=0.0)
    assert turned.status.name == "CLAMPED" and abs(float(turned.outputs["push"])) == 20


@pytest.mark.parametrize(("order", "expected"), [(1, 4.5e-3), (3, 4.4e-5), (5, 5.4e-7)])
def test_the_block_holds_a_sampled_cart_pole_on_its_course(order, expected):
    """RK4 over 10 ms, the command held: the series of that very map leaves no error of sampling, only of truncation."""
    h = 0.01
    sampled = cart_pole().discretise("rk4", dt=h)
    series = regulator_series(sampled, {}, harmonic("p", 2.0).sampled(h), order)
    view = InterpretView(regulator_feedback(series, gain_of(sampled), amplitude=0.8))
    params = view.params()
    memory, worst = view.init(params), 0.0
    x = series.at([0.0, 0.4])[0]

    def rate(x, u):
        return np.array([x[1], u, x[3], (9.81 * np.sin(x[2]) - u * np.cos(x[2])) / 0.5])

    for k in range(700):
        t = k * h
        w = 0.4 * np.array([np.sin(2 * t), np.cos(2 * t)])
        given = view.inputs("step", {"w": w, "p": x[0], "v": x[1], "tilt": x[2], "rate": x[3]})
        answer = view.call("step", memory, given, params)
        assert answer.status >= 0
        u = float(answer.outputs["push"])
        k1 = rate(x, u)
        k2 = rate(x + h / 2 * k1, u)
        k3 = rate(x + h / 2 * k2, u)
        x = x + h / 6 * (k1 + 2 * k2 + 2 * k3 + rate(x + h * k3, u))
        worst = max(worst, abs(x[0] - 0.4 * np.sin(2 * (t + h)))) if t > 3.5 else worst
    assert worst == pytest.approx(expected, rel=0.1)


def test_the_record_of_a_regulator(series, regulator):
    values = regulator.design.values
    assert set(values) == {"state_coefficients", "input_coefficients", "gain"}
    measured = regulator.design.properties(values)
    assert all(value <= limit for value, limit in measured.values()) and len(measured) > series.order
    again = regulator.design.rebuild({**values, "gain": 1.5 * values["gain"]})
    assert again.design.source == regulator.design.source and list(again.tables) == list(regulator.tables)
    defaults = {signal.name: signal.default for signal in again.param_signals}
    assert defaults["gain"] == tuple(1.5 * values["gain"]) and defaults["push"] == (0.0,)
    with pytest.raises(ModelError, match=r"the gain of design.json has shape \(1, 3\); give 1 x 4"):
        regulator.design.rebuild({**values, "gain": [1.0, 2.0, 3.0]})
    own = regulator_feedback(series, gain_of(series.plant).gain, amplitude=0.8)
    assert set(own.design.values) == {"state_coefficients", "input_coefficients"}


def test_a_gain_that_does_not_stabilise_is_refused(series):
    K = -gain_of(series.plant).gain
    with pytest.raises(RegulatorError, match="largest real part .*; -K would, so look at its sign"):
        regulator_feedback(series, K, amplitude=0.8)
    assert "step" in regulator_feedback(series, K, amplitude=0.8, accept_unstable=True).entries
    with pytest.raises(ModelError, match="the gain has shape"):
        regulator_feedback(series, [[1.0, 2.0]], amplitude=0.8)


def test_inputs_that_need_nothing_have_no_coefficients():
    plant = Plant("still")
    x, u = plant.state("x", range=(-9, 9)), plant.input("u", range=(-9, 9))
    plant.dynamics({x: u})
    block = regulator_map(regulator_series(plant, {}, constant("x"), 2), amplitude=1.0)
    assert "input_coefficients" not in {signal.name for signal in block.param_signals}
    assert [float(run(block, w=[0.5]).outputs[name]) for name in ("x", "u")] == [0.5, 0.0]
    assert "step" in block.design.rebuild(block.design.values).entries
