"""James-Stein estimators as compiled C: numbers of specs/meda2018.md, edge cases, weights that change, planted faults."""

import dataclasses

import casadi as ca
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from plantc.codegen import emit
from plantc.codegen.crosscheck import make_views
from plantc.codegen.layout import flatten
from plantc.reference.james_stein import effective_dimension, james_stein, shrink_constant, weight
from plantc.symbolic import ModelError, Plant, Status, cos, sin, sqrt, vertcat
from plantc.symbolic.james_stein import james_stein_estimator
from scipy.optimize import least_squares

from plantc import InterpretView, NativeView, ReferenceView, cross_check

PI = np.diag([1, 1.1, 1.2, 1.3, 1.4]) + 0.1 * np.tril(np.ones((5, 5)), -1)
Y = np.array([0.5, -1, 1.5, -2, 2.5])
PREDICTION = np.array([0.1, -0.2, 0.3, -0.4])
ROWS, COLUMNS = np.mgrid[1:6, 1:5]
C1 = np.eye(5, 4) + 0.2 * np.cos(ROWS * COLUMNS)
C1[4] += [0.5, -0.5, 0.5, -0.5]
C2 = np.cos(ROWS * COLUMNS)
KINDS = [NativeView, InterpretView, ReferenceView]


def still(C, name="still", *, noise="shaping", **options):
    """A state that does not move, read through C with noise of the shape PI."""
    m, n = C.shape
    plant = Plant(name, dt=1.0)
    x = plant.state("x", size=n, range=(-1e3, 1e3))
    plant.dynamics({x: x})
    if noise == "entering":
        v = plant.noise("v", size=m, variance=1.0)
        plant.sensor("y", ca.DM(C) @ x + ca.DM(PI) @ v)
    else:
        plant.sensor("y", ca.DM(C) @ x, variance=1.0)
        if noise == "shaping":
            options = {"shaping": PI, "std": 1.0} | options
    return james_stein_estimator(plant, **options)


def update(view, x, y, **params):
    """Call the update; return status, state and outputs."""
    given = view.params(**params)
    memory = view.init(given)
    memory["x"] = x
    answer = view.call("update_y", memory, view.inputs("update_y", {"y": y}), given)
    out = {name: float(value[0]) if value.size == 1 else value for name, value in flatten(answer.outputs).items()}
    return answer.status, np.array(answer.memory["x"]), out


AT = {
    0.3: (0.9831338865, [0.3925722102, -1.347000842, 2.401564347, -2.52085087],
          0.5640764304, [0.2678643064, -0.8580956564, 1.505779733, -1.616845441]),
    1.0: (0.8125987389, [0.3418224133, -1.148041208, 2.037025406, -2.152966474],
          0.7729678308, [0.330028595, -1.101804693, 1.952309677, -2.06747329]),
    3.0: (0.0, PREDICTION, 0.0, PREDICTION),
}  # fmt: skip


@pytest.mark.parametrize("noise", ["shaping", "entering"])
@pytest.mark.parametrize("kind", KINDS)
def test_the_core_of_section_10_1a(kind, noise):
    plain, modified = kind(still(C1, noise=noise)), kind(still(C1, "modified", noise=noise, gamma=0.05))
    for r, (expected, state, expected_modified, state_modified) in AT.items():
        status, x, out = update(plain, PREDICTION, Y, std_y=r)
        assert status == 0
        np.testing.assert_allclose(x, state, rtol=2e-9, atol=1e-10)
        assert out["weight"] == pytest.approx(expected, rel=1e-9, abs=1e-10)
        c = 2 * (2.567140061 - 2)
        assert c / out["distance_squared"] == pytest.approx(0.1874012611, rel=2e-9)
        np.testing.assert_allclose(out["innovation"], Y - C1 @ PREDICTION, rtol=1e-14)
        _, x, out = update(modified, PREDICTION, Y, std_y=r)
        np.testing.assert_allclose(x, state_modified, rtol=2e-9, atol=1e-10)
        assert out["weight"] == pytest.approx(expected_modified, rel=1e-9, abs=1e-10)


def test_an_effective_dimension_below_two_shrinks_nothing():
    view = NativeView(still(C2))
    for r in (0.0, 0.3, 1.0, 100.0):
        status, x, out = update(view, PREDICTION, Y, std_y=r)
        assert (status, out["weight"]) == (0, 1.0)
        np.testing.assert_allclose(x, [-0.08692736751, -0.8876645601, -1.242991973, 1.416238218], rtol=2e-9)
    _, _, out = update(NativeView(still(C2, "modified", gamma=0.09)), PREDICTION, Y, std_y=0.3)
    assert out["weight"] == pytest.approx(np.exp(-1), rel=1e-14)  # exp(-gamma / r^2) alone


def twelve():
    return still(np.eye(12), "twelve", noise="plain")


def test_twelve_states_measured_directly():
    _, x, out = update(NativeView(twelve()), np.zeros(12), np.sin(np.arange(1, 13)), std_y=0.5)
    assert 10 / out["distance_squared"] == pytest.approx(1.589996621, rel=1e-9)
    assert out["weight"] == pytest.approx(0.6025008448, rel=1e-9)
    assert np.linalg.norm(x) == pytest.approx(1.510982935, rel=1e-9)


def test_the_risk_at_a_perfect_prediction_in_compiled_code():
    """Section 10.1(b) on 4000 draws, within four standard errors of what they leave; the reference draws 1e5."""
    view, rng, r = NativeView(twelve()), np.random.default_rng(2), 0.3
    params = view.params(std_y=r)
    memory = view.init(params)
    inputs = view.inputs("update_y", {"y": np.zeros(12)})
    losses, weights = [], []
    for noise in r * rng.normal(size=(4000, 12)):
        inputs["y"] = noise
        answer = view.call("update_y", memory, inputs, params)
        losses.append(np.sum(np.array(answer.memory["x"]) ** 2) / r**2)
        weights.append(float(answer.outputs["weight"]))
    for values, expected in ((losses, 1.23192131), (weights, 0.1754673698)):
        assert np.mean(values) == pytest.approx(expected, abs=4 * np.std(values) / np.sqrt(len(values)))


def test_a_general_reading_beside_the_reference():
    view, rng = NativeView(still(C1, gamma=0.02)), np.random.default_rng(5)
    for _ in range(200):
        prediction, y, r = rng.normal(size=4), 3 * rng.normal(size=5), 10.0 ** rng.uniform(-2, 0.5)
        expected = james_stein(prediction, y, C1, PI, r, 0.02)
        _, x, out = update(view, prediction, y, std_y=r)
        np.testing.assert_allclose(x, expected.state, rtol=1e-12, atol=1e-12)
        assert out["weight"] == pytest.approx(float(expected.weight), rel=1e-12, abs=1e-15)


# -- properties -------------------------------------------------------------------------------------------------------

TURN = np.linalg.qr(np.random.default_rng(7).normal(size=(4, 4)))[0]
TURNED = NativeView(still(TURN, "turned", noise="plain"))
PLAIN = NativeView(still(np.eye(4), "plain", noise="plain"))
SCALED = NativeView(still(C1, "scaled", shaping=3.0 * PI, std=1.0))
UNSCALED = NativeView(still(C1, "unscaled"))
numbers = st.floats(-100, 100)


@settings(max_examples=60)
@given(st.lists(numbers, min_size=4, max_size=4), st.lists(numbers, min_size=4, max_size=4), st.floats(0, 50))
def test_an_orthogonal_reading_turned_back_gives_the_same(x, y, r):
    _, first, _ = update(TURNED, x, y, std_y=r)
    _, second, _ = update(PLAIN, x, TURN.T @ np.array(y), std_y=r)
    np.testing.assert_allclose(first, second, atol=1e-9)


@settings(max_examples=60)
@given(st.lists(numbers, min_size=4, max_size=4), st.lists(numbers, min_size=5, max_size=5), st.floats(0, 50))
def test_the_same_noise_said_otherwise_gives_the_same(x, y, r):
    """(r, Pi) -> (r / a, a Pi)."""
    _, first, one = update(UNSCALED, x, y, std_y=3 * r)
    _, second, other = update(SCALED, x, y, std_y=r)
    np.testing.assert_allclose(first, second, atol=1e-9)
    assert one["weight"] == pytest.approx(other["weight"], abs=1e-9)


@settings(max_examples=60)
@given(st.lists(numbers, min_size=4, max_size=4), st.lists(numbers, min_size=4, max_size=4), st.floats(0, 50))
def test_the_estimate_lies_between_prediction_and_reading(x, y, r):
    status, after, out = update(PLAIN, x, y, std_y=r)
    assert status == 0
    assert 0 <= out["weight"] <= 1
    low, high = np.minimum(x, y), np.maximum(x, y)
    assert np.all((after >= low - 1e-12) & (after <= high + 1e-12))


# -- edge cases of section 12 -----------------------------------------------------------------------------------------


def test_a_reading_where_the_prediction_is_leaves_it_bit_for_bit():
    for kind in KINDS:
        for r in (0.0, 1e-20, 0.1, 1e6):
            status, x, out = update(kind(still(np.eye(4), "same", noise="plain")), PREDICTION, PREDICTION, std_y=r)
            assert status == 0
            assert x.tobytes() == PREDICTION.tobytes()
            assert out["weight"] == (1.0 if r == 0 else 0.0)


def test_no_noise_takes_the_reading():
    for kind in KINDS:
        _, x, out = update(kind(still(C1)), PREDICTION, Y, std_y=0.0)
        assert out["weight"] == 1.0
        np.testing.assert_allclose(x, [0.3975914208, -1.366678168, 2.437617649, -2.557235041], rtol=2e-9)
        modified = kind(still(C1, "modified", gamma=0.05))
        for r in (0.0, 1e-160, 1e-3):  # the limit, without overflow
            _, x, out = update(modified, PREDICTION, Y, std_y=r)
            assert out["weight"] == 0.0
            assert x.tobytes() == PREDICTION.tobytes()
        _, _, out = update(modified, PREDICTION, Y, std_y=0.0, gamma_y=0.0)
        assert out["weight"] == 1.0


def test_two_states_are_never_shrunk():
    view = NativeView(still(np.eye(2), "two", noise="plain"))
    _, x, out = update(view, [1.0, 2.0], [1.5, 1.75], std_y=100.0)
    assert out["weight"] == 1.0
    assert list(x) == [1.5, 1.75]


@pytest.mark.parametrize("kind", KINDS)
def test_numbers_that_are_none_are_refused(kind):
    view = kind(still(C1, gamma=0.05))
    for bad in ({"std_y": -1.0}, {"gamma_y": -1e-9}, {"std_y": np.nan}, {"gamma_y": np.nan}, {"x_0": [np.nan] * 4}):
        params = view.params(**bad)
        memory = view.init(view.params())
        assert view.call("init", memory, view.inputs("init", {}), params).status == Status.BAD_PARAM
    before = view.init(view.params())
    reading = np.array(Y)
    reading[2] = np.nan
    answer = view.call("update_y", before, view.inputs("update_y", {"y": reading}), view.params())
    assert answer.status == Status.BAD_INPUT
    assert flatten(answer.memory)["x"].tobytes() == flatten(before)["x"].tobytes()
    far = view.call("update_y", before, view.inputs("update_y", {"y": [1e6] * 5}), view.params(std_y=0.1, gamma_y=0.0))
    assert far.status == Status.OVERFLOW
    answer = view.call("step", before, view.inputs("step", {"has_y": True, "y": reading}), view.params())
    assert answer.status == Status.SKIPPED
    assert flatten(answer.outputs)["status_y"] == Status.BAD_INPUT
    missing = view.call("step", before, view.inputs("step", {"has_y": False, "y": reading}), view.params())
    assert missing.status == Status.OK
    assert flatten(missing.memory)["x"].tobytes() == flatten(before)["x"].tobytes()


def test_the_same_model_gives_the_same_bytes():
    first, second = (emit(still(C1, gamma=0.05), "float") for _ in range(2))
    assert first.source == second.source
    assert first.header == second.header


def sensor_of(C, **sensor):
    plant = Plant("some", dt=1.0)
    x = plant.state("x", size=C.shape[1])
    plant.dynamics({x: x})
    plant.sensor("y", ca.DM(C) @ x, **({"variance": 1.0} | sensor))
    return plant


def attitude():
    plant = Plant("turning", dt=1.0)
    q = plant.attitude("q")
    plant.dynamics({q: ca.DM.zeros(3)})
    plant.sensor("y", q, variance=1.0)
    return plant


@pytest.mark.parametrize(
    ("plant", "options", "said"),
    [
        (sensor_of(np.ones((3, 3))), {}, "rank 1 and the state n = 3"),
        (sensor_of(np.eye(2, 3)), {}, "rank 2 and the state n = 3"),
        (sensor_of(np.eye(2)), {"shaping": np.ones((2, 2)), "std": 1}, "singular shape"),
        (sensor_of(np.eye(2)), {"shaping": np.eye(3), "std": 1}, "give a 2 x 2 matrix"),
        (sensor_of(np.eye(2)), {"shaping": np.diag([1.0, 2.0])}, "give std="),
        (sensor_of(np.eye(2)), {"std": -1}, "std of 'y' is -1; give a number from 0"),
        (sensor_of(np.eye(2)), {"gamma": float("nan")}, "gamma of 'y' is nan"),
        (sensor_of(np.eye(2)), {"sensors": ["z"]}, "sensors= names"),
        (sensor_of(np.eye(2)), {"gamma": {"z": 1}}, "which are no sensors"),
        (sensor_of(np.eye(2)), {"iterations": 0}, "iterations is 0"),
        (sensor_of(np.eye(2)), {"rank_deficient": "pinv"}, "give 'refuse' or 'reduce'"),
        (attitude(), {}, "has an attitude"),
    ],
)
def test_what_cannot_be_is_a_sentence(plant, options, said):
    with pytest.raises(ModelError, match=said):
        james_stein_estimator(plant, **options)


def test_the_plants_own_noise_gives_r_and_shape():
    block = james_stein_estimator(sensor_of(np.eye(3), variance=0.04))
    assert next(s for s in block.param_signals if s.name == "std_y").default == (0.2,)
    full = np.array([[2.0, 0.5, 0.0], [0.5, 1.0, 0.0], [0.0, 0.0, 3.0]])
    block = james_stein_estimator(sensor_of(np.eye(3), variance=full))
    assert next(s for s in block.param_signals if s.name == "std_y").default == (1.0,)
    expected = james_stein(np.zeros(3), np.array([1.0, 2, 3]), np.eye(3), np.linalg.cholesky(full), 1.0)
    _, x, _ = update(NativeView(block), np.zeros(3), [1.0, 2, 3])
    np.testing.assert_allclose(x, expected.state, rtol=1e-12)
    block = james_stein_estimator(sensor_of(np.eye(2), variance=[4.0, 36.0]), shaping=np.diag([1.0, 3.0]))
    assert next(s for s in block.param_signals if s.name == "std_y").default == (2.0,)


def test_a_low_rank_corrects_where_it_sees_if_asked():
    C = np.array([[1.0, 1, 0, 0, 0], [0, 1, 1, 0, 0], [0, 0, 1, 1, 0], [1, 0, 0, 1, 0], [1, 2, 1, 0, 0]])
    block = james_stein_estimator(sensor_of(C), rank_deficient="reduce")
    x0, y = np.arange(1.0, 6), np.array([1.0, -1, 2, -2, 0.5])
    residual = y - C @ x0
    U, singular, Vt = np.linalg.svd(C)
    rank = int(np.sum(singular > 1e-12))
    assert rank == 3
    kept = singular[:rank]
    z = Vt[:rank] @ x0
    moved = james_stein(z, z + (U[:, :rank].T @ residual) / kept, np.eye(rank), np.diag(1 / kept), 0.5)
    expected = x0 + Vt[:rank].T @ (moved.state - z)
    for kind in KINDS:
        status, x, out = update(kind(block), x0, y, std_y=0.5)
        assert status == 0
        np.testing.assert_allclose(x, expected, rtol=1e-12, atol=1e-12)
        assert out["weight"] == pytest.approx(float(moved.weight), rel=1e-12)
    assert cross_check(block, steps=40).passed


def test_sensors_are_taken_one_after_another():
    plant = Plant("two", dt=1.0)
    x = plant.state("x", size=3, range=(-100, 100))
    plant.dynamics({x: x})
    plant.sensor("close", x, std=0.1)
    plant.sensor("part", x[0], std=0.1)
    plant.sensor("remote", 2 * x, std=0.4)
    with pytest.raises(ModelError, match="the sensor 'part' has rank 1"):
        james_stein_estimator(plant)
    block = james_stein_estimator(plant, sensors=["remote", "close"], gamma={"remote": 0.01}, std={"remote": 0.5})
    names = [signal.name for signal in block.param_signals]
    assert names == ["std_close", "std_remote", "gamma_remote", "x_0"]
    view = NativeView(block)
    params = view.params()
    readings = {"close": np.array([1.0, 2, 3]), "remote": np.array([2.5, 3.5, 6.5])}
    first = james_stein(np.zeros(3), readings["close"], np.eye(3), np.eye(3), 0.1).state
    both = james_stein(first, readings["remote"], 2 * np.eye(3), np.eye(3), 0.5, 0.01).state
    for flags, expected in (((True, True), both), ((True, False), first), ((False, False), np.zeros(3))):
        inputs = readings | {"has_close": flags[0], "has_remote": flags[1]}
        answer = view.call("step", view.init(params), view.inputs("step", inputs), params)
        np.testing.assert_allclose(answer.memory["x"], expected, rtol=1e-13)
    assert cross_check(block, steps=40).passed


# -- faults -----------------------------------------------------------------------------------------------------------


def with_c(block, change):
    text = emit(block, "double")
    source = change(text.source)
    assert source != text.source
    return make_views(block, "double", NativeView(block, text=dataclasses.replace(text, source=source)))


def test_a_fault_in_the_weight_is_caught():
    block = still(C1)
    assert cross_check(block, steps=40).passed
    function = block.entries["update_y"].body[0].function
    constant = next(
        line for line in emit(block, "double").source.splitlines() if "1.1342801" in line and "/*" not in line
    )
    check = cross_check(
        block, views=with_c(block, lambda source: source.replace(constant, constant.replace("1.1342801", "1.1342811"))),
        steps=40,
    )  # fmt: skip
    assert not check.passed
    assert "native = reference" in [failure.name for failure in check.failures]
    # a fault on this side of the emitter: the weight of the reading taken twice
    symbols = function.sx_in()
    outputs = function.call(symbols)
    outputs[3] = symbols[0] + 2 * (outputs[3] - symbols[0])
    views = make_views(block, "double")
    views.interpret = InterpretView(block, {function.name(): ca.Function(function.name(), symbols, outputs)})
    assert not cross_check(block, views=views, steps=40).passed


def test_a_fault_in_the_reference_is_caught(monkeypatch):
    import plantc.reference.james_stein as textbook

    monkeypatch.setattr(textbook, "shrink_constant", lambda n, effective: max(0.0, n - 2.0))
    assert not cross_check(still(C1), steps=40).passed


# -- weights that change ----------------------------------------------------------------------------------------------


def curved(**options):
    """Three states seen through a nonlinear reading, with noise that depends on where one is."""
    plant = Plant("curved", dt=0.1)
    x, y, z = (plant.state(name, range=(-10, 10)) for name in "xyz")
    plant.dynamics({x: x, y: y, z: z})
    v = plant.noise("v", size=4, variance=0.01)
    spread = ca.diag(vertcat(1 + 0.1 * x**2, 1, 2, 1))
    plant.sensor("s", vertcat(2 * x + 0.1 * x * y, y + 0.2 * sin(z), z + 0.05 * x**2, x + y) + spread @ v)
    return james_stein_estimator(plant, **options)


def curved_by_hand(x0, reading, r, gamma):
    """The same by SciPy's least squares, run until it has converged."""
    noise = np.diag([1 + 0.1 * x0[0] ** 2, 1, 2, 1])

    def h(x):
        return np.array([2 * x[0] + 0.1 * x[0] * x[1], x[1] + 0.2 * np.sin(x[2]), x[2] + 0.05 * x[0] ** 2, x[0] + x[1]])

    def derivative(x):
        return np.array([[2 + 0.1 * x[1], 0.1 * x[0], 0], [0, 1, 0.2 * np.cos(x[2])], [0.1 * x[0], 0, 1], [1, 1, 0]])

    found = least_squares(
        lambda x: np.linalg.solve(noise, reading - h(x)), x0, jac=lambda x: -np.linalg.solve(noise, derivative(x)),
        xtol=1e-15, ftol=1e-15, gtol=1e-15, method="lm",
    )  # fmt: skip
    white = np.linalg.solve(noise, derivative(found.x))
    e = found.x - x0
    D2 = np.sum((white @ e) ** 2)
    s = float(weight(np.array(D2), r, shrink_constant(3, effective_dimension(derivative(found.x), noise)), gamma))
    return x0 + s * e, D2, s


@pytest.mark.parametrize("kind", KINDS)
def test_a_nonlinear_reading_beside_least_squares_of_scipy(kind):
    view, rng = kind(curved(gamma=0.02, iterations=14)), np.random.default_rng(4)
    for _ in range(25):
        x0 = rng.uniform(-2, 2, 3)
        reading = np.array([2 * x0[0] + 0.1 * x0[0] * x0[1], x0[1] + 0.2 * np.sin(x0[2]), x0[2] + 0.05 * x0[0] ** 2,
                            x0[0] + x0[1]]) + rng.normal(scale=0.3, size=4)  # fmt: skip
        params = view.params(std_s=0.3)
        memory = view.init(params)
        for name, value in zip("xyz", x0, strict=True):
            memory[name] = value
        answer = view.call("update_s", memory, view.inputs("update_s", {"s": reading}), params)
        state, D2, s = curved_by_hand(x0, reading, 0.3, 0.02)
        assert answer.status == 0
        np.testing.assert_allclose([float(answer.memory[name]) for name in "xyz"], state, rtol=1e-7, atol=1e-7)
        assert float(answer.outputs["distance_squared"]) == pytest.approx(D2, rel=1e-6)
        assert float(answer.outputs["weight"]) == pytest.approx(s, rel=1e-6)


def scaled_reading(**options):
    """The reading of section 10.1(a) times a parameter, so that its weights are computed in C."""
    plant = Plant("scaled", dt=1.0)
    x = plant.state("x", size=4, range=(-1e3, 1e3))
    plant.dynamics({x: x})
    gain = plant.parameter("gain", 1.0, range=(0.0, 10.0))
    plant.sensor("y", gain * (ca.DM(C1) @ x), variance=1.0)
    return james_stein_estimator(plant, shaping=PI, std=1.0, **options)


@pytest.mark.parametrize("kind", KINDS)
def test_weights_computed_in_c_give_the_numbers_of_section_10_1a(kind):
    plain, modified = kind(scaled_reading()), kind(scaled_reading(gamma=0.05))
    for r, (expected, state, expected_modified, state_modified) in AT.items():
        _, x, out = update(plain, PREDICTION, Y, std_y=r)
        np.testing.assert_allclose(x, state, rtol=2e-9, atol=1e-10)
        assert out["weight"] == pytest.approx(expected, rel=1e-9, abs=1e-10)
        _, x, out = update(modified, PREDICTION, Y, std_y=r)
        np.testing.assert_allclose(x, state_modified, rtol=2e-9, atol=1e-10)
        assert out["weight"] == pytest.approx(expected_modified, rel=1e-9, abs=1e-10)


def test_weights_follow_what_they_depend_on():
    view = NativeView(scaled_reading())
    for gain in (0.1, 1.0, 7.0):
        expected = james_stein(PREDICTION, Y, gain * C1, PI, 0.4)
        _, x, out = update(view, PREDICTION, Y, std_y=0.4, gain=gain)
        np.testing.assert_allclose(x, expected.state, rtol=1e-10, atol=1e-12)
        assert out["weight"] == pytest.approx(float(expected.weight), rel=1e-10)


@pytest.mark.parametrize("kind", KINDS)
def test_a_rank_lost_at_run_time_is_refused(kind):
    view = kind(scaled_reading())
    status, x, _ = update(view, PREDICTION, Y, gain=0.0)
    assert status == Status.NOT_POSITIVE
    assert x.tobytes() == PREDICTION.tobytes()


def squeezed():
    plant = Plant("squeezed", dt=1.0)
    x = plant.state("x", size=3, range=(-1e3, 1e3))
    angle = plant.input("angle", range=(-2, 2))
    plant.dynamics({x: x})
    plant.sensor("y", vertcat(x[0] + x[1], x[0] + cos(angle) * x[1], x[2]), variance=0.01)
    return james_stein_estimator(plant, around={"angle": 1.0})


def test_a_rank_lost_by_an_input_is_refused_where_it_is_nearly_lost():
    view = NativeView(squeezed())
    for angle, expected in ((1.0, 0), (1e-2, 0), (1e-3, Status.NOT_POSITIVE), (0.0, Status.NOT_POSITIVE)):
        memory = view.init(view.params())
        inputs = view.inputs("update_y", {"y": np.full(3, 1e-4), "angle": angle})
        assert view.call("update_y", memory, inputs, view.params()).status == expected


@pytest.mark.parametrize(("make", "precision"), [(curved, "double"), (squeezed, "float"), (scaled_reading, "float")])
def test_views_agree_where_weights_change(make, precision):
    check = cross_check(make(), precision, steps=40)
    assert check.passed, check.failures


def test_a_fault_in_the_eigenvalue_is_caught(monkeypatch):
    """Bisection that stops after six trips: the weights are off by a percent."""
    import plantc.symbolic.shrinkage as shrinkage

    monkeypatch.setattr(shrinkage, "BISECTIONS", 6)
    check = cross_check(scaled_reading(), steps=40)
    assert {"interpret = reference", "native = reference"} & {failure.name for failure in check.failures}


def test_a_fault_in_gauss_newton_is_caught():
    assert not cross_check(block_with_fewer_steps(), steps=40).passed


def block_with_fewer_steps():
    block = curved(iterations=1)
    block.oracle = curved(iterations=5).oracle
    return block


NOWHERE = {
    "a derivative that is infinite": (lambda x, y: vertcat(1 / x, y), lambda x: 0.01, 0.0, Status.OVERFLOW),
    "a noise that is infinite": (lambda x, y: vertcat(x, y), lambda x: vertcat(1 / x**2, 1), 0.0, Status.NOT_POSITIVE),
    "a noise that is no number": (lambda x, y: vertcat(x, y), lambda x: vertcat(1, sqrt(x)), -1.0, Status.OVERFLOW),
    "a noise that is negative": (lambda x, y: vertcat(x, y), lambda x: vertcat(1, x), -1.0, Status.NOT_POSITIVE),
}


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("case", NOWHERE)
def test_what_is_no_number_is_refused(kind, case):
    reading, noise, bad, expected = NOWHERE[case]
    plant = Plant("pole", dt=1.0)
    x, y = plant.state("x", range=(-10, 10)), plant.state("y", range=(-10, 10))
    plant.dynamics({x: x, y: y})
    plant.sensor("s", reading(x, y), variance=noise(x))
    view = kind(james_stein_estimator(plant, around={"x": 1.0}))
    params = view.params()
    memory = view.init(params)
    inputs = view.inputs("update_s", {"s": [1.0, 1.0]})
    assert view.call("update_s", memory, inputs, params).status == Status.OK
    memory["x"] = bad
    assert view.call("update_s", memory, inputs, params).status == expected


def changing(n):
    plant = Plant("many", dt=1.0)
    x = plant.state("x", size=n)
    plant.dynamics({x: x})
    plant.sensor("y", plant.parameter("gain", 1.0) * x, variance=1.0)
    return plant


def test_what_cannot_change_is_a_sentence():
    with pytest.raises(ModelError, match="at most 8 states, and there are 9"):
        james_stein_estimator(changing(9))
    with pytest.raises(ModelError, match="'reduce' needs constant weights"):
        james_stein_estimator(changing(3), rank_deficient="reduce")
    plant = Plant("alike", dt=1.0)
    x = plant.state("x", size=2)
    plant.dynamics({x: x})
    plant.sensor("y", vertcat(x[0] ** 2 + x[1], 2 * (x[0] ** 2 + x[1])), variance=1.0)
    with pytest.raises(ModelError, match="rank 1 and the state n = 2"):
        james_stein_estimator(plant)


def test_wrapped_readings_and_dt_as_an_input():
    plant = Plant("compass")
    heading, rate = plant.state("heading", angle=True), plant.state("rate", range=(-10, 10))
    plant.dynamics({heading: rate, rate: -rate})
    plant.sensor("angles", vertcat(heading, heading + 0.1 * rate), angle=True, std=0.02)
    block = james_stein_estimator(plant.discretise("rk4", dt=(0.01, 0.5)))
    view = NativeView(block)
    params = view.params(heading_0=3.1)
    inputs = view.inputs("step", {"dt": 0.1, "has_angles": True, "angles": [-3.1, -3.1]})
    answer = view.call("step", view.init(params), inputs, params)
    assert answer.status == 0
    assert float(answer.memory["heading"]) == pytest.approx(-3.1)
    assert cross_check(block, steps=40).passed
