"""Filters made from plants, run as programs in Python: numbers, statuses, recovery, and every kind of sensor noise."""

import math

import casadi as ca
import numpy as np
import pytest
from plantc.codegen.layout import flatten
from plantc.codegen.views import InterpretView, ReferenceView
from plantc.symbolic import ModelError, Plant, Status, cos, sin, vertcat
from plantc.symbolic.estimators import extended_kalman_filter, kalman_filter
from plantc.symbolic.program import unpack_symmetric
from scipy.linalg import solve_discrete_are

P0 = np.array([[2.0, 0.5], [0.5, 1.0]])


def cart(name="cart", *, dt=0.1, **sensor):
    plant = Plant(name)
    x, v = plant.state("x"), plant.state("v")
    u, w = plant.input("u"), plant.noise("w", density=0.2)
    plant.dynamics({x: v, v: u - 0.3 * v + w})
    plant.sensor("gps", x, **({"variance": 0.5} | sensor))
    return plant.discretise("exact", dt=dt)


def bits(record):
    """Return the fields of a record as bytes; the padding between them is nobody's."""
    return {name: value.tobytes() for name, value in flatten(record).items()}


class Runner:
    """A filter with its memory, to be called like an object."""

    def __init__(self, block, view=InterpretView, **params):
        self.view = view(block)
        self.params = self.view.params(**params)
        self.memory = self.view.init(self.params)
        self.n = next(s for s in block.memory_signals if s.name == "covariance").size
        self.n = int((math.isqrt(8 * self.n + 1) - 1) // 2)

    def __call__(self, entry, **inputs):
        answer = self.view.call(entry, self.memory, self.view.inputs(entry, inputs), self.params)
        if answer.status < 0:
            assert bits(answer.memory) == bits(self.memory)
            assert bits(answer.outputs) == bits(self.view.outputs(entry))
        self.memory, self.out = answer.memory, answer.outputs
        return answer.status

    @property
    def P(self):  # noqa: N802
        return unpack_symmetric(np.array(self.memory["covariance"], dtype=float).ravel(), self.n)

    def set(self, **values):
        for name, value in values.items():
            self.memory[name] = value

    def set_covariance(self, P):
        self.memory["covariance"] = np.asarray(P)[np.triu_indices(len(P))]

    def vector(self, *names):
        return np.concatenate([np.ravel(self.memory[name]) for name in names])


def one(gate=0.0, **options):
    """A single state that does not move, measured directly."""
    plant = Plant("still", dt=1.0)
    x = plant.state("x", range=(-50, 50))
    plant.dynamics({x: x + plant.noise("w", variance=1e-4)})
    plant.sensor("s", x, variance=1.0, range=(-100, 100))
    return extended_kalman_filter(plant, initial_variance={x: options.pop("p0", 4.0)}, gate={"s": gate}, **options)


# -- linear: beside the textbook --------------------------------------------------------------------------------------


def test_ekf_on_a_linear_plant_is_the_kalman_filter():
    rng = np.random.default_rng(0)
    plant = cart()
    both = [Runner(make(plant, initial_variance={"x": 2, "v": 1})) for make in (extended_kalman_filter, kalman_filter)]
    for _ in range(100):
        u, z = rng.normal(), rng.normal(scale=3)
        for filter_ in both:
            assert filter_("predict", u=u) == 0
            assert filter_("update_gps", gps=z) == 0
        np.testing.assert_allclose(both[0].vector("x", "v"), both[1].vector("x", "v"), rtol=0, atol=1e-10)
        np.testing.assert_allclose(both[0].P, both[1].P, rtol=0, atol=1e-10)


def test_the_kalman_filter_beside_matrices_written_out():
    from scipy.signal import cont2discrete

    rng = np.random.default_rng(1)
    A, B = np.array([[0, 1], [0, -0.3]]), np.array([[0.0], [1.0]])
    F, G, *_ = cont2discrete((A, B, np.eye(2), np.zeros((2, 1))), 0.1)
    nodes, weights = np.polynomial.legendre.leggauss(20)
    from scipy.linalg import expm

    Q = (
        sum(w * expm(A * s) @ B @ B.T @ expm(A * s).T for s, w in zip(0.05 * (nodes + 1), 0.05 * weights, strict=True))
        * 0.2
    )
    x, P, H = np.zeros(2), np.diag([2.0, 1.0]), np.array([[1.0, 0.0]])
    filter_ = Runner(kalman_filter(cart(), initial_variance={"x": 2, "v": 1}))
    for _ in range(50):
        u, z = rng.normal(), rng.normal(scale=3)
        filter_("predict", u=u)
        x, P = F @ x + G[:, 0] * u, F @ P @ F.T + Q
        filter_("update_gps", gps=z)
        S = float((H @ P @ H.T).item() + 0.5)
        K = P @ H.T / S
        innovation = z - x[0]
        assert float(filter_.out["innovation"]) == pytest.approx(innovation, abs=1e-10)
        assert float(filter_.out["variance"]) == pytest.approx(S, rel=1e-10)
        assert float(filter_.out["nis"]) == pytest.approx(innovation**2 / S, rel=1e-9)
        x, P = x + K[:, 0] * innovation, P - S * K @ K.T
        np.testing.assert_allclose(filter_.vector("x", "v"), x, atol=1e-10)
        np.testing.assert_allclose(filter_.P, P, atol=1e-10)


def steady_quadrotor(r, patches=None):
    """Run the linear filter of the quadrotor; return its trace before and after a reading, and P before."""
    from plantc.examples.quadrotor_ekf import hover, quadrotor_kf

    view = InterpretView(quadrotor_kf, patches)
    params = view.params(variance_pose=[r * r] * 12)
    memory = view.init(params)
    inputs = {f"rotor_{k}": hover for k in (1, 2, 3, 4)}
    pose = np.zeros(12)
    pose[4] = 30.0
    diagonal = [i * 12 - i * (i - 1) // 2 for i in range(12)]
    traces = [0.0, 0.0]
    for _ in range(900):
        memory = view.call("predict", memory, view.inputs("predict", inputs), params).memory
        prior = np.array(memory["covariance"])
        memory = view.call("update_pose", memory, view.inputs("update_pose", {"pose": pose}), params).memory
        before, traces = traces, [float(np.sum(prior[diagonal])), float(np.sum(memory["covariance"][diagonal]))]
        if np.allclose(before, traces, rtol=1e-12, atol=0):
            break
    return traces, memory


@pytest.mark.parametrize(
    ("r", "prior", "posterior"),
    [(0.1, 0.002992508137, 0.002806169613), (0.05, 0.001076309493, 0.0009981623637)],
)
def test_steady_state_of_the_published_quadrotor(r, prior, posterior):
    traces, memory = steady_quadrotor(r)
    assert traces == pytest.approx([prior, posterior], rel=1e-9)
    assert float(memory["z"]) == pytest.approx(30.0, abs=1e-9)


def test_steady_state_is_the_riccati_equation():
    filter_ = Runner(kalman_filter(cart(), initial_variance={"x": 2, "v": 1}))
    for _ in range(400):
        filter_("predict", u=0)
        prior = filter_.P
        filter_("update_gps", gps=0)
    from scipy.linalg import expm

    A = np.array([[0, 1], [0, -0.3]])
    block = np.zeros((4, 4))
    block[:2, :2], block[:2, 2:], block[2:, 2:] = -A, np.diag([0, 0.2]), A.T
    power = expm(block * 0.1)
    F = power[2:, 2:].T
    expected = solve_discrete_are(F.T, np.array([[1.0], [0.0]]), F @ power[:2, 2:], np.array([[0.5]]))
    np.testing.assert_allclose(prior, expected, rtol=1e-9)


def test_a_wrong_sign_in_f_is_seen_in_the_steady_state():
    block = kalman_filter(cart(), initial_variance={"x": 2, "v": 1})
    evaluate = block.entries["predict"].body[0]
    function = evaluate.function
    symbols = function.sx_in()
    outputs = function.call(symbols)
    outputs[1][1] = -outputs[1][1]  # f_0_1
    faulty = ca.Function(function.name(), symbols, outputs)
    good = Runner(block)
    bad = Runner(block)
    bad.view = InterpretView(block, {function.name(): faulty})
    for filter_ in (good, bad):
        filter_("predict", u=0)
        filter_("predict", u=0)
    assert np.max(np.abs(good.P - bad.P)) > 0.1


# -- gates, counters, recovery ----------------------------------------------------------------------------------------


def test_a_gated_reading_is_counted_and_nothing_else():
    filter_ = Runner(one(gate=9.0))
    before, P = float(filter_.memory["x"]), filter_.P
    for count in (1, 2, 3):
        assert filter_("update_s", s=20.0) == Status.GATED
        assert int(filter_.memory["rejected_s"]) == count
        assert float(filter_.memory["x"]) == before
        assert filter_.P == P
        assert float(filter_.out["nis"]) == pytest.approx(20**2 / 5.0)
        assert float(filter_.out["innovation"]) == 20.0
    assert filter_("update_s", s=1.0) == Status.OK
    assert int(filter_.memory["rejected_s"]) == 0
    assert float(filter_.memory["x"]) == pytest.approx(0.8)
    assert filter_.P.item() == pytest.approx(0.8)


def test_the_gate_is_the_largest_nis_accepted_and_zero_accepts_all():
    limit = 9.0
    z = math.sqrt(limit * 5.0)
    assert Runner(one(gate=limit))("update_s", s=z * (1 - 1e-9)) == Status.OK
    assert Runner(one(gate=limit))("update_s", s=z * (1 + 1e-9)) == Status.GATED
    assert Runner(one(gate=0.0))("update_s", s=50.0) == Status.OK
    assert Runner(one(gate=9.0), gate_s=0.0)("update_s", s=50.0) == Status.OK
    assert Runner(one(gate=0.0), gate_s=9.0)("update_s", s=50.0) == Status.GATED


def test_a_counter_stays_at_its_largest_value():
    filter_ = Runner(one(gate=9.0))
    filter_.set(rejected_s=2**32 - 2)
    for _ in range(3):
        assert filter_("update_s", s=20.0) == Status.GATED
    assert int(filter_.memory["rejected_s"]) == 2**32 - 1


@pytest.mark.parametrize("view", [InterpretView, ReferenceView])
def test_recovery(view):
    filter_ = Runner(one(gate=9.0, reject_limit=3, inflation=100.0), view)
    for _ in range(3):
        assert filter_("step", has_s=True, s=30.0) == Status.GATED
        assert filter_.out["status_s"] == Status.GATED
    P = filter_.P.item() + 1e-4
    assert filter_("step", has_s=True, s=30.0) == Status.RECOVERED
    assert filter_.out["status_s"] == Status.OK
    gain = 100 * P / (100 * P + 1)
    assert float(filter_.memory["x"]) == pytest.approx(30 * gain)
    assert filter_.P.item() == pytest.approx(gain)
    assert float(filter_.out["s"]["variance"]) == pytest.approx(100 * P + 1)
    assert int(filter_.memory["rejected_s"]) == 0
    assert filter_("step", has_s=True, s=30.0) == Status.OK


def test_recovery_waits_for_a_flagged_reading_that_is_not_refused():
    filter_ = Runner(one(gate=9.0, reject_limit=2))
    for _ in range(2):
        filter_("step", has_s=True, s=30.0)
    P = filter_.P.item()
    assert filter_("step", has_s=False, s=30.0) == Status.OK
    assert int(filter_.memory["rejected_s"]) == 2
    assert filter_("step", has_s=True, s=math.nan) == Status.SKIPPED  # the inflation before it is undone
    assert filter_.P.item() == pytest.approx(P + 2e-4, rel=1e-12)
    assert int(filter_.memory["rejected_s"]) == 2
    assert filter_("step", has_s=True, s=30.0) == Status.RECOVERED


def test_a_reject_limit_of_zero_never_recovers_and_it_is_a_parameter():
    filter_ = Runner(one(gate=9.0))
    assert {filter_("step", has_s=True, s=30.0) for _ in range(20)} == {Status.GATED}
    filter_ = Runner(one(gate=9.0), reject_limit=1, inflation=10.0)
    assert [filter_("step", has_s=True, s=30.0) for _ in range(2)] == [Status.GATED, Status.RECOVERED]


# -- step: flags, skipped sensors -------------------------------------------------------------------------------------


def two():
    plant = Plant("pair")
    x, v = plant.state("x"), plant.state("v", range=(-100, 100))
    plant.dynamics({x: v, v: plant.input("u", range=(-5, 5)) + plant.noise("w", density=0.1)})
    plant.sensor("gps", x, variance=0.5, range=(-1000, 1000))
    plant.sensor("speed", v, variance=0.1)
    d = plant.discretise("rk4", dt=(0.01, 1.0))
    return extended_kalman_filter(d, initial_variance={"x": 1, "v": 1}, gate={"speed": 16.0})


@pytest.mark.parametrize("view", [InterpretView, ReferenceView])
def test_step_is_predict_then_each_flagged_sensor_in_order(view):
    whole, parts = Runner(two(), view), Runner(two(), view)
    for gps, speed in ((True, True), (True, False), (False, True), (False, False)):
        assert whole("step", u=1, dt=0.1, has_gps=gps, gps=0.7, has_speed=speed, speed=0.2) == 0
        parts("predict", u=1, dt=0.1)
        for flag, name, value in ((gps, "gps", 0.7), (speed, "speed", 0.2)):
            if flag:
                parts(f"update_{name}", **{name: value})
                assert bits(whole.out[name]) == bits(parts.out)
            else:
                assert not any(float(whole.out[name][key]) for key in ("innovation", "variance", "nis"))
        assert bits(whole.memory) == bits(parts.memory)


@pytest.mark.parametrize("bad", [math.nan, math.inf, 1001.0])
def test_a_value_whose_flag_is_down_is_not_read(bad):
    a, b = Runner(two()), Runner(two())
    a("step", u=1, dt=0.1, has_gps=False, gps=bad)
    b("step", u=1, dt=0.1, has_gps=False, gps=0.0)
    assert bits(a.memory) == bits(b.memory)


@pytest.mark.parametrize("view", [InterpretView, ReferenceView])
@pytest.mark.parametrize("bad", [math.nan, 1001.0])
def test_a_refused_sensor_is_skipped_and_the_others_are_used(bad, view):
    a, b = Runner(two(), view), Runner(two(), view)
    assert a("step", u=1, dt=0.1, has_gps=True, gps=bad, has_speed=True, speed=0.2) == Status.SKIPPED
    assert a.out["status_gps"] == Status.BAD_INPUT
    assert a.out["status_speed"] == Status.OK
    b("step", u=1, dt=0.1, has_speed=True, speed=0.2)
    assert bits(a.memory) == bits(b.memory)


def test_the_highest_positive_status_is_returned():
    filter_ = Runner(two())
    assert filter_("step", u=1, dt=0.1, has_gps=True, gps=math.nan, has_speed=True, speed=50) == Status.SKIPPED
    assert filter_.out["status_speed"] == Status.GATED
    assert filter_("step", u=1, dt=0.1, has_gps=True, gps=0, has_speed=True, speed=50) == Status.GATED


@pytest.mark.parametrize(
    ("change", "status"),
    [
        ({"u": 6.0}, Status.BAD_INPUT),
        ({"u": math.nan}, Status.BAD_INPUT),
        ({"dt": 2.0}, Status.BAD_INPUT),
        ({"dt": 0.0}, Status.BAD_INPUT),
    ],
)
def test_a_refused_predict_refuses_the_whole_step(change, status):
    filter_ = Runner(two())
    assert filter_("step", **({"u": 1.0, "dt": 0.1, "has_gps": True, "gps": 0.0} | change)) == status
    assert filter_("predict", **({"u": 1.0, "dt": 0.1} | change)) == status


def test_a_result_outside_its_range_is_refused():
    filter_ = Runner(two())
    filter_.set(v=99.9)
    assert filter_("predict", u=5, dt=1.0) == Status.OVERFLOW
    filter_ = Runner(one())
    filter_.set_covariance(np.array([[1e4]]))
    assert filter_("update_s", s=100.0) == Status.OVERFLOW
    assert filter_("update_s", s=101.0) == Status.BAD_INPUT


@pytest.mark.parametrize("name", ["variance_s", "x_0", "variance_x_0", "gate_s", "inflation", "variance_w"])
@pytest.mark.parametrize("value", [-1e12, math.nan, 1e12])
def test_init_checks_every_parameter(name, value):
    view = InterpretView(one())
    answer = view.call("init", view.memory(), view.inputs("init", {}), view.params(**{name: value}))
    assert answer.status == Status.BAD_PARAM


# -- variances --------------------------------------------------------------------------------------------------------


def test_inflate():
    filter_ = Runner(extended_kalman_filter(cart(), initial_variance={"x": 2, "v": 1}))
    filter_("predict", u=1)
    x, P = filter_.vector("x", "v"), filter_.P
    assert filter_("inflate", factor=7.0) == Status.OK
    np.testing.assert_allclose(filter_.P, 7 * P, rtol=1e-14)
    np.testing.assert_array_equal(filter_.vector("x", "v"), x)
    for factor in (0.999, 1.1e6, math.nan, -1):
        assert filter_("inflate", factor=factor) == Status.BAD_INPUT


@pytest.mark.parametrize("view", [InterpretView, ReferenceView])
def test_a_variance_above_its_ceiling_is_scaled_with_its_row(view):
    block = extended_kalman_filter(cart(), initial_variance={"x": 2, "v": 1}, variance_ceiling={"x": 10.0})
    filter_ = Runner(block, view)
    P = np.array([[5.0, 3.0], [3.0, 4.0]])
    filter_.set_covariance(P)
    assert filter_("inflate", factor=8.0) == Status.CLAMPED
    factor = np.sqrt(10.0 / 40.0)
    np.testing.assert_allclose(filter_.P, [[10.0, 24 * factor], [24 * factor, 32.0]], rtol=1e-14)
    assert np.linalg.eigvalsh(filter_.P)[0] > 0
    correlation = 3 / np.sqrt(20)
    assert filter_.P[0, 1] / np.sqrt(np.prod(np.diag(filter_.P))) == pytest.approx(correlation)


@pytest.mark.parametrize("view", [InterpretView, ReferenceView])
def test_a_variance_below_its_floor_is_the_floor(view):
    filter_ = Runner(one(variance_floor=0.7), view)
    assert filter_("update_s", s=0.0) == Status.OK
    assert filter_.P.item() == pytest.approx(0.8)
    assert filter_("update_s", s=0.0) == Status.CLAMPED
    assert filter_.P.item() == 0.7


def test_a_variance_that_is_not_positive_is_refused():
    filter_ = Runner(one())
    filter_.set_covariance(np.array([[-0.5]]))
    assert filter_("predict") == Status.NOT_POSITIVE
    filter_.set_covariance(np.array([[-2.0]]))
    assert filter_("update_s", s=0.0) == Status.NOT_POSITIVE  # of the innovation


# -- kinds of sensor noise --------------------------------------------------------------------------------------------


def still(*sensors, n=2, **options):
    plant = Plant("still", dt=1.0)
    x = plant.state("x", size=n)
    plant.dynamics({x: x + plant.noise("w", size=n, variance=1e-3)})
    for sensor in sensors:
        sensor(plant, x)
    return extended_kalman_filter(plant, initial_variance={x: 1.0}, correlated="all", **options)


def batch(filter_, x, P, z, h, H, R):
    """Compare the filter's last correction with the batch update."""
    S = H @ P @ H.T + R
    K = P @ H.T @ np.linalg.inv(S)
    e = z - h
    np.testing.assert_allclose(filter_.vector("x"), x + K @ e, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(filter_.P, P - K @ S @ K.T, rtol=1e-8, atol=1e-12)
    np.testing.assert_allclose(np.ravel(filter_.out["variance"]), np.diag(S), rtol=1e-10)
    np.testing.assert_allclose(np.ravel(filter_.out["innovation"]), e, rtol=1e-10, atol=1e-12)
    assert float(filter_.out["nis"]) == pytest.approx(float(e @ np.linalg.solve(S, e)), rel=1e-9)


R3 = np.array([[1.0, 0.4, 0.0], [0.4, 2.0, -0.3], [0.0, -0.3, 0.5]])
H3 = np.array([[1.0, 0.0], [0.5, 1.0], [0.0, 2.0]])


def started(block, **params):
    filter_ = Runner(block, **params)
    filter_.set(x=[0.3, -0.8])
    filter_.set_covariance(P0)
    return filter_, np.array([0.3, -0.8])


def test_a_full_noise_matrix():
    block = still(lambda plant, x: plant.sensor("s", ca.DM(H3) @ x, variance=R3))
    filter_, x = started(block)
    z = np.array([1.0, -2.0, 0.7])
    assert filter_("update_s", s=z) == Status.OK
    batch(filter_, x, P0, z, H3 @ x, H3, R3)


def test_a_full_noise_matrix_is_a_parameter_and_an_indefinite_one_is_refused():
    block = still(lambda plant, x: plant.sensor("s", ca.DM(H3) @ x, variance=R3))
    other = R3 + np.diag([1.0, 0.0, 3.0]) + 0.1
    filter_, x = started(block, variance_s=other[np.triu_indices(3)])
    z = np.array([1.0, -2.0, 0.7])
    filter_("update_s", s=z)
    batch(filter_, x, P0, z, H3 @ x, H3, other)
    bad = R3.copy()
    bad[0, 1] = bad[1, 0] = 2.0
    view = InterpretView(block)
    params = view.params(variance_s=bad[np.triu_indices(3)])
    assert view.call("init", view.memory(), view.inputs("init", {}), params).status == Status.BAD_PARAM
    filter_.params = params
    assert filter_("update_s", s=z) == Status.NOT_POSITIVE


def test_a_wrong_noise_matrix_is_seen():
    block = still(lambda plant, x: plant.sensor("s", ca.DM(H3) @ x, variance=R3))
    filter_, x = started(block)
    z = np.array([1.0, -2.0, 0.7])
    filter_("update_s", s=z)
    with pytest.raises(AssertionError):
        batch(filter_, x, P0, z, H3 @ x, H3, np.diag(np.diag(R3)))


def test_noises_inside_a_sensor():
    """h = (x0 (1 + scale) + hiss, x1 exp-like in the noise): N = dh/dv at zero noise, shared by two rows."""

    def sensor(plant, x):
        scale, hiss = plant.noise("scale", std=0.1), plant.noise("hiss", size=2, variance=[[0.4, 0.1], [0.1, 0.3]])
        plant.sensor("s", vertcat(x[0] * (1 + scale) + hiss[0], x[1] ** 2 + sin(x[0] * scale) + hiss[1]))

    filter_, x = started(still(sensor))
    z = np.array([0.5, 1.0])
    assert filter_("update_s", s=z) == Status.OK
    N = np.array([[x[0], 1, 0], [x[0], 0, 1]])
    V = np.zeros((3, 3))
    V[0, 0], V[1:, 1:] = 0.01, [[0.4, 0.1], [0.1, 0.3]]
    H = np.array([[1, 0], [0, 2 * x[1]]])
    batch(filter_, x, P0, z, np.array([x[0], x[1] ** 2]), H, N @ V @ N.T)


def test_a_row_without_any_noise_is_refused():
    def sensor(plant, x):
        plant.sensor("s", vertcat(x[0] + plant.noise("v", std=0.1), x[1]))

    with pytest.raises(ModelError, match="a row of the sensor 's' has no noise at all; give variance="):
        still(sensor)


def test_a_variance_of_the_prediction():
    filter_, x = started(still(lambda plant, x: plant.sensor("s", x, variance=0.1 + x[0] ** 2)))
    z = np.array([1.0, 2.0])
    filter_("update_s", s=z)
    batch(filter_, x, P0, z, x, np.eye(2), (0.1 + x[0] ** 2) * np.eye(2))


def test_a_standard_deviation_as_an_expression():
    filter_, x = started(still(lambda plant, x: plant.sensor("s", x, std=vertcat(0.2, 1 + x[1] ** 2))))
    z = np.array([1.0, 2.0])
    filter_("update_s", s=z)
    batch(filter_, x, P0, z, x, np.eye(2), np.diag([0.2, 1 + x[1] ** 2]) ** 2)


def test_a_variance_of_the_measurement():
    filter_, x = started(still(lambda plant, x: plant.sensor("s", x, variance=lambda z: vertcat(0.1 + z[1] ** 2, 0.3))))
    z = np.array([1.0, 2.0])
    filter_("update_s", s=z)
    batch(filter_, x, P0, z, x, np.eye(2), np.diag([4.1, 0.3]))


def test_a_variance_that_turns_negative_at_run_time_is_refused():
    filter_, _ = started(still(lambda plant, x: plant.sensor("s", x[0], variance=lambda z: 1 - z)))
    assert filter_("update_s", s=0.5) == Status.OK
    assert filter_("update_s", s=50.0) == Status.NOT_POSITIVE


@pytest.mark.parametrize("z", [3.0, -3.0, 3.0 + 2 * math.pi, -3.0 - 4 * math.pi])
def test_an_angle_is_wrapped(z):
    plant = Plant("wheel", dt=1.0)
    x = plant.state("x", angle=True)
    plant.dynamics({x: x + plant.noise("w", variance=1e-3)})
    plant.sensor("s", x, angle=True, variance=1.0)
    filter_ = Runner(extended_kalman_filter(plant, initial_variance={x: 1.0}, around={x: 3.1}))
    e = np.angle(np.exp(1j * (z - 3.1)))
    assert filter_("update_s", s=z) == Status.OK
    assert float(filter_.out["innovation"]) == pytest.approx(e, abs=1e-12)
    assert float(filter_.memory["x"]) == pytest.approx(np.angle(np.exp(1j * (3.1 + e / 2))), abs=1e-12)
    assert filter_("update_s", s=1001.0) == Status.BAD_INPUT


def test_a_sensor_that_needs_an_input_takes_it():
    plant = Plant("cart", dt=0.1)
    x, u = plant.state("x"), plant.input("u", range=(-1, 1))
    plant.dynamics({x: x + plant.noise("w", variance=0.1)})
    plant.sensor("s", x + 2 * u, variance=1.0)
    block = extended_kalman_filter(plant, initial_variance={x: 1})
    assert [signal.name for signal in block.entries["update_s"].inputs] == ["s", "u"]
    assert [signal.name for signal in block.entries["step"].inputs] == ["u", "has_s", "s"]
    filter_ = Runner(block)
    assert filter_("update_s", s=3.0, u=0.5) == Status.OK
    assert float(filter_.out["innovation"]) == 2.0
    assert filter_("update_s", s=3.0, u=1.5) == Status.BAD_INPUT


# -- noise of the process ---------------------------------------------------------------------------------------------


def test_step_noise_is_a_parameter_added_to_the_integrated_density():
    plant = cart().step_noise({"x": 0.25})
    block = extended_kalman_filter(plant, initial_variance={"x": 2, "v": 1})
    with_, without, none = (
        Runner(block),
        Runner(block, variance_step_x=0.0),
        Runner(block, variance_step_x=0.0, density_w=0.0),
    )
    for filter_ in (with_, without, none):
        filter_("predict", u=0)
    np.testing.assert_allclose(with_.P - without.P, [[0.25, 0], [0, 0]], atol=1e-15)
    F = np.array([[1, (1 - math.exp(-0.03)) / 0.3], [0, math.exp(-0.03)]])
    np.testing.assert_allclose(none.P, F @ np.diag([2, 1]) @ F.T, rtol=1e-12)
    assert without.P[1, 1] - none.P[1, 1] == pytest.approx(0.2 * (1 - math.exp(-0.06)) / 0.6, rel=1e-10)


def test_noise_inside_a_nonlinearity():
    plant = Plant("cart", dt=1.0)
    x, w = plant.state("x"), plant.noise("w", variance=0.04)
    plant.dynamics({x: x * cos(w) + sin(x * w) * 3})
    plant.sensor("s", x, variance=1)
    filter_ = Runner(extended_kalman_filter(plant, initial_variance={x: 1}, around={x: 2.0}))
    filter_("predict")
    assert filter_.P.item() == pytest.approx(1 + 36 * 0.04)


# -- attitudes --------------------------------------------------------------------------------------------------------


def attitude_filter():
    body = Plant("body")
    q, bias = body.attitude("q"), body.state("bias", size=3)
    rate = body.input("rate", size=3)
    n, d = body.noise("n", size=3, density=1e-4), body.noise("d", size=3, density=1e-6)
    body.dynamics({q: rate - bias + n, bias: d})
    body.sensor("down", q.to_body([0, 0, 1]), variance=1e-3)
    body.sensor("north", q.to_body([1, 0, 0]), variance=1e-3)
    return extended_kalman_filter(body.discretise("rk4", dt=0.02), initial_variance={q: 0.3, bias: 0.01})


def test_an_attitude_and_a_bias_are_found():
    from scipy.spatial.transform import Rotation

    rng = np.random.default_rng(4)
    filter_ = Runner(attitude_filter())
    truth, bias = Rotation.from_rotvec([0.3, -0.4, 0.5]), np.array([0.05, -0.03, 0.02])
    for k in range(300):
        rate = np.array([np.sin(0.02 * k), np.cos(0.03 * k), 0.5])
        truth = truth * Rotation.from_rotvec(rate * 0.02)
        down, north = (truth.inv().apply(v) + 0.01 * rng.normal(size=3) for v in ([0, 0, 1], [1, 0, 0]))
        status = filter_("step", rate=rate + bias, has_down=True, down=down, has_north=True, north=north)
        assert status == Status.OK
        q = filter_.vector("q")
        assert np.linalg.norm(q) == pytest.approx(1, abs=1e-9)
    error = (Rotation.from_quat([*q[1:], q[0]]).inv() * truth).as_rotvec()
    sigma = np.sqrt(np.diag(filter_.P))
    assert np.all(np.abs(error) < 5 * sigma[:3])
    assert np.all(np.abs(filter_.vector("bias") - bias) < 5 * sigma[3:])
    assert np.all(sigma[:3] < 0.02)
    assert np.all(sigma[3:] < 0.02)
    assert np.linalg.eigvalsh(filter_.P)[0] > 0


def test_an_attitude_far_from_unit_length_is_refused_at_the_start():
    view = InterpretView(attitude_filter())
    for scale, status in ((1.0, Status.OK), (1.005, Status.OK), (1.02, Status.BAD_PARAM), (0.5, Status.BAD_PARAM)):
        params = view.params(q_0=np.array([0.5, 0.5, -0.5, 0.5]) * scale)
        answer = view.call("init", view.memory(), view.inputs("init", {}), params)
        assert answer.status == status
        if status == Status.OK:
            np.testing.assert_allclose(answer.memory["q"], [0.5, 0.5, -0.5, 0.5], rtol=1e-12)


def test_the_whole_attitude_filter_beside_its_oracle():
    rng = np.random.default_rng(7)
    block = attitude_filter()
    views = [Runner(block), Runner(block, ReferenceView)]
    for _ in range(30):
        inputs = {
            "rate": rng.normal(size=3), "has_down": True, "down": rng.normal(size=3) * 0.3 + [0, 0, 1],
            "has_north": bool(rng.random() < 0.5), "north": rng.normal(size=3) * 0.3 + [1, 0, 0],
        }  # fmt: skip
        statuses = [filter_("step", **inputs) for filter_ in views]
        assert statuses[0] == statuses[1]
        np.testing.assert_allclose(views[0].P, views[1].P, atol=1e-10)
        np.testing.assert_allclose(views[0].vector("q", "bias"), views[1].vector("q", "bias"), atol=1e-10)
        views[1].memory = views[0].memory.copy()


# -- mistakes ---------------------------------------------------------------------------------------------------------


def build(**changes):
    options = {"initial_variance": {"x": 2, "v": 1}} | changes
    return extended_kalman_filter(cart(), **options)


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"initial_variance": {"x": 1}}, "no initial variance for the state 'v'; add it to initial_variance"),
        ({"initial_variance": {"x": 1, "v": 0}}, "initial_variance of 'v' is 0; give 1 number"),
        ({"initial_variance": {"x": 1, "v": -1}}, "initial_variance of 'v' is -1"),
        ({"initial_variance": {"x": 1, "v": math.nan}}, "initial_variance of 'v' is nan"),
        ({"initial_variance": {"x": 1, "v": [1, 2]}}, "initial_variance of 'v' is .*; give 1 number"),
        ({"initial_variance": {"x": 1, "v": 1, "q": 1}}, r"initial_variance names \['q'\], which are no states"),
        ({"gate": {"gpz": 9}}, r"gate= names \['gpz'\], which are no sensors"),
        ({"gate": {"gps": -1}}, "the gate of 'gps' is -1; give a NIS from 0"),
        ({"reject_limit": -1}, "reject_limit is -1; give a whole number, 0 for never"),
        ({"reject_limit": 2.5}, "reject_limit is 2.5"),
        ({"inflation": 0.5}, "inflation is 0.5; give a factor from 1 to 1e6"),
        ({"inflation": math.nan}, "inflation is nan"),
        ({"around": {"z": 1}}, r"around= names \['z'\], which are neither states nor inputs"),
        ({"around": {"x": 1e9}}, "around= gives .* for 'x', outside its range"),
        ({"variance_floor": 1e10}, "a variance floor is not below its ceiling; lower variance_floor"),
        ({"variance_ceiling": {"y": 1}}, "variance_ceiling names"),
        ({"name": "int"}, "the block name 'int' is a keyword"),
    ],
)
def test_options_that_make_no_sense(changes, sentence):
    with pytest.raises(ModelError, match=sentence):
        build(**changes)


def test_plants_that_make_no_filter():
    plant = Plant("cart")
    x = plant.state("x")
    plant.dynamics({x: -(x**3)})
    with pytest.raises(ModelError, match=r"this plant is continuous; give it cart\.discretise"):
        extended_kalman_filter(plant, initial_variance={x: 1})
    d = plant.discretise("euler", dt=0.1)
    with pytest.raises(ModelError, match=r"an estimator needs a sensor, and this plant has none; add sensor\(...\)"):
        extended_kalman_filter(d, initial_variance={x: 1})
    plant.sensor("s", x, variance=1)
    with pytest.raises(ModelError, match="a Kalman filter needs linear dynamics and sensors; give at= "):
        kalman_filter(d, initial_variance={x: 1})
    assert kalman_filter(d, initial_variance={x: 1}, at={"x": 0.5}).name == "cart_kf"
    assert extended_kalman_filter(d, initial_variance={x: 1}).name == "cart_ekf"
