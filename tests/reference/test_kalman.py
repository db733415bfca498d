"""The filter: its numbers, its statuses, its precision, and faults that it would show."""

from dataclasses import replace

import numpy as np
import pytest
import reference_plants as plants
from hypothesis import given
from hypothesis import strategies as st
from plantc.reference import Exercise, KalmanOracle, Status, derivative
from plantc.reference.discretisation import van_loan
from plantc.reference.kalman import ldl
from plantc.reference.model import packed, unpacked
from scipy.linalg import expm, solve_discrete_are

R_FULL = np.array([[0.2, 0.05], [0.05, 0.3]])


def started(model, precision=np.float64, **given):
    params = plants.params_of(model, **given)
    oracle = KalmanOracle(model)
    status, memory, _ = oracle.call("init", {}, {}, params, precision)
    assert status == Status.OK
    return oracle, memory, params


def oscillator(**given):
    given = {"variance_both": packed(R_FULL), "x_0": [0.1, 0.2], "variance_x_0": [2.0, 3.0]} | given
    return started(plants.oscillator(method="exact"), **given)


def random_definite(seed, size=2):
    factor = np.random.default_rng(seed).normal(size=(size, size))
    return factor @ factor.T + 1e-3 * np.eye(size)


# -- numbers ----------------------------------------------------------------------------------------------------------


def test_predict_by_hand():
    oracle, memory, params = oscillator()
    status, after, outputs = oracle.call("predict", memory, {"u": [1.5]}, params)
    F = expm(plants.OSCILLATOR * 0.1)
    Q = van_loan(plants.OSCILLATOR, plants.PUSH @ plants.PUSH.T, 0.1)
    assert (status, outputs) == (Status.OK, {})
    np.testing.assert_allclose(unpacked(after["covariance"]), F @ np.diag([2.0, 3.0]) @ F.T + Q, atol=1e-11)


@given(st.integers(0, 10**6))
def test_batch_update_is_the_information_form(seed):
    oracle, memory, params = oscillator()
    P = random_definite(seed)
    rng = np.random.default_rng(seed)
    z, H = rng.normal(size=2), np.array([[1.0, 0.0], [1.0, 1.0]])
    status, after, outputs = oracle.call("update_both", memory | {"covariance": packed(P)}, {"both": z}, params)
    information = np.linalg.inv(P) + H.T @ np.linalg.inv(R_FULL) @ H
    np.testing.assert_allclose(unpacked(after["covariance"]), np.linalg.inv(information), atol=1e-10)
    x = memory["x"]
    expected = x + np.linalg.solve(information, H.T @ np.linalg.solve(R_FULL, z - H @ x))
    np.testing.assert_allclose(after["x"], expected, atol=1e-9)
    S = H @ P @ H.T + R_FULL
    nu = z - H @ x
    assert status == Status.OK
    np.testing.assert_allclose(outputs["nis"], [nu @ np.linalg.solve(S, nu)], rtol=1e-8)
    np.testing.assert_allclose(outputs["variance"], np.diag(S))
    np.testing.assert_allclose(outputs["innovation"], nu)


def test_steady_state_solves_the_riccati_equation():
    oracle, memory, params = oscillator()
    inputs = {"u": [0.0], "has_both": [1], "both": [0.0, 0.0], "has_one": [0], "one": [np.nan]}
    for _ in range(400):
        _, memory, _ = oracle.call("step", memory, inputs, params)
    _, prior, _ = oracle.call("predict", memory, {"u": [0.0]}, params)
    F, H = expm(plants.OSCILLATOR * 0.1), np.array([[1.0, 0.0], [1.0, 1.0]])
    Q = van_loan(plants.OSCILLATOR, plants.PUSH @ plants.PUSH.T, 0.1)
    np.testing.assert_allclose(unpacked(prior["covariance"]), solve_discrete_are(F.T, H.T, Q, R_FULL), rtol=1e-8)


def test_step_is_predict_then_updates():
    oracle, memory, params = oscillator()
    inputs = {"u": [1.0], "has_both": [1], "both": [0.3, -0.1], "has_one": [1], "one": [0.2]}
    status, after, outputs = oracle.call("step", memory, inputs, params)
    _, expected, _ = oracle.call("predict", memory, inputs, params)
    _, expected, both = oracle.call("update_both", expected, inputs, params)
    _, expected, one = oracle.call("update_one", expected, inputs, params)
    assert status == Status.OK
    for name, value in expected.items():
        np.testing.assert_array_equal(after[name], value)
    np.testing.assert_array_equal(outputs["both.innovation"], both["innovation"])
    np.testing.assert_array_equal(outputs["one.nis"], one["nis"])


def test_attitude_update_resets_the_error():
    oracle, memory, params = started(plants.attitude())
    P = random_definite(3, 6)
    memory = memory | {"covariance": packed(P)}
    _, after, _ = oracle.call("update_compass", memory, {"compass": [0.8, 0.2, 0.6]}, params)
    assert np.isclose(np.linalg.norm(after["q"]), 1, atol=1e-6)
    H = derivative(oracle.model, "H_compass", "complex step")(memory)
    K = P @ H.T @ np.linalg.inv(H @ P @ H.T + np.eye(3))
    d = K @ (np.array([0.8, 0.2, 0.6]) - np.array([0.8, 0.0, 0.6]))
    G = np.eye(6)
    G[:3, :3] -= 0.5 * np.array([[0, -d[2], d[1]], [d[2], 0, -d[0]], [-d[1], d[0], 0]])
    np.testing.assert_allclose(unpacked(after["covariance"]), G @ (P - K @ H @ P) @ G.T, atol=1e-10)


def test_angles_are_wrapped_in_memory_and_innovation():
    oracle, memory, params = started(plants.pendulum(), variance_encoder=1e-6)
    memory = memory | {"angle": np.array([3.1])}
    _, after, outputs = oracle.call("update_encoder", memory, {"encoder": [-3.1]}, params)
    np.testing.assert_allclose(outputs["innovation"], [2 * np.pi - 6.2])
    np.testing.assert_allclose(after["angle"], [-3.1], atol=1e-5)


def test_noise_of_a_sensor_from_every_source():
    oracle, memory, params = started(plants.pendulum(), variance_v=0.5)
    memory = memory | {"angle": np.array([1.0])}
    _, _, outputs = oracle.call("update_sine", memory, {"sine": [2.0]}, params)
    expected = np.cos(1.0) ** 2 + 0.01 + 0.1 * 4 + 0.5 * np.sin(1.0) ** 2
    np.testing.assert_allclose(outputs["variance"], [expected])


@given(st.integers(0, 10**6))
def test_ldl(seed):
    matrix = random_definite(seed, 4)
    L, d = ldl(matrix)
    np.testing.assert_allclose(L @ np.diag(d) @ L.T, matrix, atol=1e-12)
    np.testing.assert_allclose(L * np.sqrt(d), np.linalg.cholesky(matrix), atol=1e-9)


# -- statuses ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("entry", "inputs"),
    [
        ("predict", {"u": [np.nan]}),
        ("predict", {"u": [10.1]}),
        ("update_one", {"one": [np.inf]}),
        ("inflate", {"factor": [0.5]}),
    ],
)
def test_bad_input(entry, inputs):
    oracle, memory, params = oscillator()
    assert oracle.call(entry, memory, inputs, params) == (Status.BAD_INPUT, {}, {})


@pytest.mark.parametrize(
    ("name", "value"), [("x_0", [2e6, 0]), ("gate_one", [np.nan]), ("variance_both", [1.0, 2.0, 1.0])]
)
def test_bad_param(name, value):
    oracle, _, params = oscillator()
    assert oracle.call("init", {}, {}, params | {name: np.array(value)})[0] == Status.BAD_PARAM


def test_attitude_must_be_near_unit_length():
    oracle, _, params = started(plants.attitude())
    assert oracle.call("init", {}, {}, params | {"q_0": np.array([0.98, 0, 0, 0])})[0] == Status.BAD_PARAM
    status, memory, _ = oracle.call("init", {}, {}, params | {"q_0": np.array([0.995, 0, 0, 0])})
    assert status == Status.OK
    np.testing.assert_allclose(memory["q"], [1, 0, 0, 0])


def test_gate_counts_and_leaves_the_estimate():
    oracle, memory, params = oscillator(gate_one=4.0)
    status, after, outputs = oracle.call("update_one", memory, {"one": [50.0]}, params)
    assert status == Status.GATED
    assert outputs["nis"][0] > 4
    assert after["rejected_one"].dtype == np.uint32
    assert after["rejected_one"][0] == 1
    np.testing.assert_array_equal(after["x"], memory["x"])
    full = memory | {"rejected_one": np.array([2**32 - 1], dtype=np.uint32)}
    assert oracle.call("update_one", full, {"one": [50.0]}, params)[1]["rejected_one"][0] == 2**32 - 1
    status, after, _ = oracle.call("update_one", after, {"one": [0.1]}, params)
    assert (status, after["rejected_one"][0]) == (Status.OK, 0)


def test_recovery_inflates_takes_the_reading_and_resets():
    oracle, memory, params = oscillator(gate_one=4.0, reject_limit=2, inflation=50.0)
    inputs = {"u": [0.0], "has_both": [0], "both": [0, 0], "has_one": [1], "one": [50.0]}
    statuses = []
    for _ in range(3):
        before = memory
        status, memory, outputs = oracle.call("step", memory, inputs, params)
        statuses.append(status)
    assert statuses == [Status.GATED, Status.GATED, Status.RECOVERED]
    assert (memory["rejected_one"][0], outputs["status_one"][0]) == (0, Status.OK)
    _, predicted, _ = oracle.call("predict", before, inputs, params)
    np.testing.assert_allclose(outputs["one.variance"], 50 * predicted["covariance"][:1] + 1.0)


def test_a_refused_sensor_is_skipped():
    oracle, memory, params = oscillator()
    inputs = {"u": [0.0], "has_both": [1], "both": [np.nan, 0], "has_one": [1], "one": [0.5]}
    status, after, outputs = oracle.call("step", memory, inputs, params)
    assert (status, outputs["status_both"][0]) == (Status.SKIPPED, Status.BAD_INPUT)
    assert not np.any(outputs["both.innovation"])
    _, alone, _ = oracle.call("step", memory, inputs | {"has_both": [0]}, params)
    np.testing.assert_array_equal(after["x"], alone["x"])
    assert oracle.call("step", memory, inputs | {"u": [11.0]}, params) == (Status.BAD_INPUT, {}, {})


def test_not_positive():
    oracle, memory, params = oscillator()
    worse = memory | {"covariance": np.array([-1.0, 0, 1.0])}
    assert oracle.call("predict", worse, {"u": [0.0]}, params)[0] == Status.NOT_POSITIVE
    assert oracle.call("update_one", worse, {"one": [0.0]}, params)[0] == Status.NOT_POSITIVE
    indefinite = params | {"variance_both": np.array([1.0, 2.0, 1.0])}
    assert oracle.call("update_both", memory, {"both": [0.0, 0.0]}, indefinite)[0] == Status.NOT_POSITIVE


def test_clamped_and_overflow():
    model = plants.oscillator(ceiling=np.array([3.0, 5.0]), floor=np.array([0.5, 1e-20]))
    oracle, memory, params = started(model, variance_both=packed(R_FULL))
    wide = memory | {"covariance": np.array([2.0, 1.0, 1.0])}
    status, after, _ = oracle.call("inflate", wide, {"factor": [6.0]}, params)
    assert status == Status.CLAMPED
    shrink = np.sqrt([3.0 / 12, 5.0 / 6])
    np.testing.assert_allclose(after["covariance"], [3.0, 6 * shrink[0] * shrink[1], 5.0])
    status, after, _ = oracle.call("update_one", memory, {"one": [0.0]}, params | {"variance_one": np.array([0.1])})
    assert (status, after["covariance"][0]) == (Status.CLAMPED, 0.5)
    far = memory | {"x": np.array([1e6, 1e6])}
    assert oracle.call("predict", far, {"u": [0.0]}, params)[0] == Status.OVERFLOW


# -- precision --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("make", ["oscillator", "pendulum", "attitude"])
def test_single_precision_stays_single(make):
    model = getattr(plants, make)()
    seen = set()

    def watched(function):
        def call(*arguments):
            seen.update(item.dtype for item in arguments)
            return function(*arguments)

        return call

    sensors = tuple(replace(item, measure=watched(item.measure)) for item in model.sensors)
    model = replace(model, dynamics=watched(model.dynamics), sensors=sensors)
    params = plants.params_of(model)
    if make == "oscillator":
        params["variance_both"] = packed(R_FULL)
    oracle, n = KalmanOracle(model), model.error_size
    size = sum(state.size for state in model.states)
    x0 = np.eye(1, size)[0] if make == "attitude" else np.zeros(size)
    exercise = Exercise(model, x0, np.zeros(sum(i.size for i in model.inputs)), np.ones(1), np.full(n, 0.1), params)
    calls = list(exercise.calls(np.random.default_rng(0), 30))
    _, memory, _ = oracle.call("init", {}, {}, params, np.float32)
    oracle.call("step", memory, next(inputs for entry, inputs in calls if entry == "step"), params, np.float32)
    seen.clear()  # the search for constants, once and in double, is over
    for entry, inputs in calls:
        status, after, outputs = oracle.call(entry, memory, inputs, params, np.float32)
        kinds = {value.dtype for value in (*after.values(), *outputs.values())}
        assert kinds <= {np.dtype(np.float32), np.dtype(np.uint32), np.dtype(np.int32)}
        memory = after if status >= 0 else memory
    assert seen <= {np.dtype(np.float32), np.dtype(np.complex64)}


def test_ranges_are_compared_in_the_working_precision():
    model = plants.oscillator(inputs=(plants.signal("u", 1, -0.1, 0.1),))
    oracle, memory, params = started(model, variance_both=packed(R_FULL))
    edge = {"u": np.array([np.float32(0.1)], dtype=float)}  # a little above 0.1 in double
    assert oracle.call("predict", memory, edge, params, np.float32)[0] == Status.OK
    assert oracle.call("predict", memory, edge, params, np.float64)[0] == Status.BAD_INPUT


# -- exercise ---------------------------------------------------------------------------------------------------------


def exercise_of(model, params, x0, variance=0.05):
    inputs = sum(item.size for item in model.inputs)
    variances = np.full(model.error_size, variance)
    return Exercise(model, np.asarray(x0, float), np.zeros(inputs), np.ones(inputs), variances, params)


def test_a_filter_follows_the_exercise():
    model = plants.attitude(dt=(0.01, 0.1))
    params = plants.params_of(
        model, density_w=np.full(6, 1e-4), variance_compass=np.full(3, 1e-3), variance_q_0=np.full(3, 0.05),
        variance_bias_0=np.full(3, 0.05),
    )  # fmt: skip
    oracle = KalmanOracle(model)
    memory, nis, entries = {}, [], set()
    exercise = exercise_of(model, params, [1, 0, 0, 0, 0, 0, 0])
    for entry, inputs in exercise.calls(np.random.default_rng(4), 400):
        status, memory, outputs = oracle.call(entry, memory, inputs, params)
        assert status >= 0
        entries.add(entry)
        if outputs.get("compass.variance", np.zeros(1))[0] > 0:
            nis.append(outputs["compass.nis"][0])
    assert entries == {"init", "predict", "step", "inflate", "update_compass"}
    assert 2.0 < np.mean(nis) < 4.0  # three components: a consistent filter has mean NIS 3


@given(st.integers(0, 10**6))
def test_random_memories_are_memories(seed):
    model = plants.attitude()
    memory = exercise_of(model, plants.params_of(model), [1, 0, 0, 0, 0, 0, 0]).memory(np.random.default_rng(seed))
    P = unpacked(memory["covariance"])
    assert np.linalg.eigvalsh(P)[0] > 0
    assert np.all(np.diag(P) <= 0.05)
    assert np.isclose(np.linalg.norm(memory["q"]), 1)


def test_same_seed_same_calls():
    model = plants.pendulum()
    exercise = exercise_of(model, plants.params_of(model), [0, 0])
    one, other = (list(exercise.calls(np.random.default_rng(7), 50)) for _ in range(2))
    assert len(one) == 50
    assert str(one) == str(other)


# -- planted faults ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("fault", ["sign of gravity", "wrong noise", "no wrapping"])
def test_a_planted_fault_shows(fault):
    """What lockstep relies on: a filter with another f, Q or h answers differently, by far more than rounding."""
    good = plants.pendulum()
    if fault == "sign of gravity":

        def dynamics(x, u, p, w):
            return (good.dynamics(x, u, p, w)[0] + np.stack([0 * x[0], 2 * 9.81 * np.sin(x[0])]),)

        bad = replace(good, dynamics=dynamics)
    elif fault == "wrong noise":
        bad = replace(good, dynamics=lambda x, u, p, w: good.dynamics(x, u, p, 2 * w))
    else:
        bad = replace(good, sensors=tuple(replace(item, angle=False) for item in good.sensors))
    params = plants.params_of(good, angle_0=3.0)
    inputs = {"u": [1.0], "dt": [0.2], "has_encoder": [1], "encoder": [-3.0], "has_sine": [0], "sine": [0.0]}
    _, memory, _ = KalmanOracle(good).call("init", {}, {}, params)
    _, one, _ = KalmanOracle(good).call("step", memory, inputs, params)
    _, other, _ = KalmanOracle(bad).call("step", memory, inputs, params)
    difference = max(np.max(np.abs(one[name] - other[name])) for name in ("angle", "speed", "covariance"))
    assert difference > 1e-3


def test_a_function_that_drops_the_imaginary_part_shows():
    good = plants.pendulum()
    bad = replace(good, dynamics=lambda x, u, p, w: good.dynamics(np.real(x) + 0j * x, u, p, w))
    values = {"angle": [0.5], "speed": [0.1], "u": [0.0], "dt": [0.1]}
    one, other = (derivative(bad, "F", how)(values) for how in ("complex step", "central differences"))
    assert np.max(np.abs(one - other)) > 1e-2
