"""Operating points, linearisation, and the Hautus test, beside python-control, finite differences and the paper."""

import math

import casadi as ca
import control
import numpy as np
import pytest
from plantc.symbolic import analysis
from plantc.symbolic.analysis import OperatingPoint, TrimError, linearise, linearised_plant, trim
from plantc.symbolic.discretisation import transition
from plantc.symbolic.errors import ModelError
from plantc.symbolic.plant import Plant

STATES = ["x1", "x2", "x3", "x4", "x5", "x6", "x7", "x8", "x9", "x10", "x11", "x12"]
HOVER = 212.718305490559


def ravel(value):
    return np.asarray(value, dtype=float).ravel()


def quadrotor():
    """The plant of Meda-Campana 2018, (26)-(30)."""
    plant = Plant("quadrotor")
    x = [plant.state(name) for name in STATES]
    u1, u2, u3, u4 = u = [plant.input(f"u{index}") for index in range(1, 5)]
    kb, kd, g, arm, inertia, inertia_z, rotor = 54.2e-6, 1.1e-6, 9.81, 0.24, 8.1e-3, 14.2e-3, 104e-6
    m = plant.parameter("m", 1.0)
    b1 = kb * (u1**2 + u2**2 + u3**2 + u4**2)
    b2 = kb * (-(u1**2) - u2**2 + u3**2 + u4**2)
    b3 = kb * (-(u1**2) + u2**2 + u3**2 - u4**2)
    b4 = kd * (u1**2 - u2**2 + u3**2 - u4**2)
    whirl = u1 - u2 + u3 - u4
    s, c = ca.sin, ca.cos
    rates = [
        x[1],
        (s(x[10]) * s(x[6]) + c(x[10]) * s(x[8])) * c(x[6]) * b1 / m,
        x[3],
        (-c(x[10]) * s(x[6]) + s(x[10]) * s(x[8])) * c(x[6]) * b1 / m,
        x[5],
        -g + c(x[8]) * c(x[6]) * b1 / m,
        x[7],
        x[9] * x[11] * (inertia - inertia_z) / inertia - rotor / inertia * x[9] * whirl + arm * b2 / inertia,
        x[9],
        x[7] * x[11] * (inertia_z - inertia) / inertia + rotor / inertia * x[7] * whirl + arm * b3 / inertia,
        x[11],
        b4 / inertia_z,
    ]
    plant.dynamics(dict(zip(x, rates, strict=True)))
    for index, name in enumerate(STATES):
        plant.sensor(f"s_{name}", x[index], variance=0.01)
    assert len(u) == 4
    return plant


def pendulum():
    plant = Plant("pendulum")
    theta = plant.state("theta", unit="rad", angle=True, doc="angle")
    omega = plant.state("omega", unit="rad/s", range=(-100, 100))
    torque = plant.input("torque", unit="N m", range=(-10, 10))
    mass = plant.parameter("mass", 0.2, range=(1e-3, 1e3))
    length = plant.constant("length", 0.5)
    draught = plant.noise("draught", density=1e-3, unit="N m")
    plant.dynamics(
        {theta: omega, omega: (torque + draught - mass * 9.81 * length * ca.sin(theta)) / (mass * length**2)}
    )
    plant.sensor("encoder", theta, variance=1e-4, angle=True)
    plant.sensor("accelerometer", ca.vertcat(9.81 * ca.sin(theta), length * omega**2), variance=[0.1, 0.2])
    return plant


def body():
    """A rigid body with an attitude, a rate that depends on the attitude, and torques."""
    plant = Plant("body")
    q = plant.attitude("q")
    rate = plant.state("rate", size=3)
    torque = plant.input("torque", size=3)
    twist = plant.input("twist")
    wind = plant.noise("wind", size=3, density=0.1)
    pull = q.to_body([0.3, -0.2, 1.0])
    turn = rate + 0.3 * pull * (1 + twist)
    gyroscopic = ca.cross(rate, rate * ca.DM([1, 2, 3]))
    plant.dynamics({q: turn, rate: torque - gyroscopic + ca.cross(pull, [0, 0, 0.1]) + wind})
    plant.sensor("gravity", q.to_body([0, 0, 9.81]) + 0.1 * rate, variance=0.1)
    return plant


def linear(A, B, C=None):
    plant = Plant("linear")
    x = plant.state("x", size=len(A))
    u = plant.input("u", size=np.shape(B)[1])
    plant.dynamics({x: ca.DM(A) @ x + ca.DM(B) @ u})
    if C is not None:
        plant.sensor("z", ca.DM(C) @ x, variance=1.0)
    return linearise(plant)


def numeric(plant, expression):
    return ca.Function("f", [plant.x, plant.u, plant.p], [ca.densify(expression)])


# -- operating points -------------------------------------------------------------------------------------------------


def test_hover_of_the_paper():
    point = trim(quadrotor(), hold={"x5": 30.0})
    for name in ("u1", "u2", "u3", "u4"):
        assert point[name] == pytest.approx(HOVER, abs=1e-9)
    assert point["x5"] == 30.0
    assert np.max(np.abs(point.residual)) < 1e-12
    assert trim(quadrotor(), hold={"x5": 30, "m": 4.0})["u1"] == pytest.approx(2 * HOVER, abs=1e-9)


def test_trim_solves_for_a_parameter():
    plant = quadrotor()
    point = trim(plant, hold={name: HOVER for name in ("u1", "u2", "u3", "u4")}, free=["m"], guess={"m": 3.0})
    assert point.parameters["m"] == pytest.approx(1.0, abs=1e-12)


def test_no_equilibrium_is_named():
    plant = quadrotor()
    hold = {name: 100.0 for name in ("u1", "u2", "u3", "u4")}
    with pytest.raises(
        TrimError, match=r"quadrotor: no equilibrium was found: the rate of x6 is off by -7\.64"
    ) as caught:
        trim(plant, hold=hold, free=["x1", "x5"])
    assert "\n" not in str(caught.value)
    with pytest.raises(TrimError, match="x6"):
        trim(plant, hold=hold)
    with pytest.raises(TrimError, match=r"u1 at its bound 150"):
        trim(plant, free=["u1"], bounds={"u1": (0, 150)})


def test_trim_within_bounds_and_with_rates():
    plant = pendulum()
    low = trim(plant, hold={"torque": 0.4905}, bounds={"theta": (0, 1.5)}, guess={"theta": 0.1})
    high = trim(plant, hold={"torque": 0.4905}, bounds={"theta": (1.6, 3.1)}, guess={"theta": 3})
    assert low["theta"] == pytest.approx(math.pi / 6, abs=1e-9)
    assert high["theta"] == pytest.approx(math.pi * 5 / 6, abs=1e-9)
    car = Plant("car")
    way, speed = car.state("way"), car.state("speed")
    gas = car.input("gas", range=(0, 100))
    car.dynamics({way: speed, speed: gas - 0.1 * speed**2})
    assert trim(car, rates={"way": 20})["gas"] == pytest.approx(40, abs=1e-9)
    assert trim(car, hold={speed: 10}, rates={way: None})["gas"] == pytest.approx(10, abs=1e-9)
    with pytest.raises(TrimError, match="way is off by 10"):
        trim(car, hold={speed: 10})


def test_trim_of_a_discrete_plant_is_a_fixed_point():
    plant = Plant("map", dt=0.1)
    x = plant.state("x")
    u = plant.input("u")
    plant.dynamics({x: 0.5 * x + ca.cos(x) + u})
    point = trim(plant, hold={u: 0.25})
    assert 0.5 * point["x"] + math.cos(point["x"]) + 0.25 == pytest.approx(point["x"], abs=1e-14)
    made = pendulum().discretise("rk4", dt=(0.01, 0.1))
    at = trim(made, hold={"torque": 0.4905}, guess={"theta": 0.3})
    following = ca.Function("n", [made.x, made.u, made.p, made.dt_symbol], [transition(made)[0]])
    assert np.allclose(ravel(following(at.x, at.u, at.p, 0.07)), at.x, atol=1e-14)


def test_no_equilibrium_where_a_derivative_is_infinite():
    """At zero the slope of the root is infinite, which must not make every residual look small."""
    plant = Plant("tank")
    level = plant.state("level")
    plant.dynamics({level: ca.sqrt(level) - 2})
    assert trim(plant)["level"] == pytest.approx(4, abs=1e-9)


def test_trim_of_an_attitude():
    """Thrust must balance gravity and wind; the quaternion that does it is found from a tilted guess."""
    plant = Plant("craft")
    q, v = plant.attitude("q"), plant.state("v", size=3)
    thrust = plant.input("thrust", range=(0, 30))
    wind = plant.input("wind", range=(-5, 5))
    rate = plant.input("rate", size=3, range=(-1, 1))
    plant.dynamics({q: rate, v: q.to_world(ca.vertcat(0, 0, thrust)) - [0, 0, 9.81] + ca.vertcat(wind, 0, 0)})
    tilt = np.array([math.cos(0.2), math.sin(0.2), 0, 0])
    point = trim(plant, hold={wind: 2.0}, guess={q: tilt})
    assert point["thrust"] == pytest.approx(math.hypot(9.81, 2), abs=1e-9)
    assert np.linalg.norm(point["q"]) == pytest.approx(1, abs=1e-14)
    assert np.max(np.abs(point.residual)) < 1e-9
    turning = trim(plant, rates={q: [0, 0, 0.5]})
    assert turning["rate"] == pytest.approx([0, 0, 0.5], abs=1e-9)


def test_operating_point_is_a_mapping():
    plant = body()
    point = OperatingPoint.at(plant, {"rate": [1, 2, 3]})
    assert dict(point).keys() == {"q", "rate", "torque", "twist"}
    assert point["q"].tolist() == [1, 0, 0, 0]
    assert point["rate"].tolist() == [1, 2, 3]
    assert isinstance(point["twist"], float)
    assert point == OperatingPoint.at(plant, point)
    assert len(point) == 4
    assert "nothing" not in point
    with pytest.raises(ValueError, match="read-only"):
        point.x[0] = 2.0
    shifted = Plant("shifted")
    shifted.dynamics({shifted.state("x", range=(2, 5)): 0})
    assert OperatingPoint.at(shifted)["x"] == 2.0


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"thetta": 1}, "names 'thetta'"),
        ({"omega": 200}, "outside its range"),
        ({"omega": [1, 2]}, "give 1 finite"),
        ({"omega": math.nan}, "finite"),
        ({"mass": -1}, "outside its range"),
    ],
)
def test_wrong_values_are_refused(values, message):
    with pytest.raises(ModelError, match=message):
        OperatingPoint.at(pendulum(), values)


def test_wrong_trims_are_refused():
    plant = pendulum()
    for options, message in (
        ({"hold": {"a": 1}}, "hold= names 'a'"),
        ({"hold": {"theta": 1}, "free": ["theta"]}, "in hold= and in free="),
        ({"bounds": {"omega": (300, 400)}}, "leave no room"),
        ({"rates": {"torque": 1}}, "not a state"),
    ):
        with pytest.raises(ModelError, match=message):
            trim(plant, **options)
    with pytest.raises(ModelError, match=r"length 1\.41"):
        OperatingPoint.at(body(), {"q": [1, 1, 0, 0]})


# -- linearisation ----------------------------------------------------------------------------------------------------


def test_linear_model_of_the_paper():
    plant = quadrotor().discretise("euler", dt=1 / 40)
    found = linearise(plant, trim(plant, hold={"x5": 30}))
    A = np.eye(12)
    for row in range(0, 12, 2):
        A[row, row + 1] = 1 / 40
    A[1, 8], A[3, 6] = 0.24525, -0.24525
    assert np.allclose(found.A, A, atol=1e-15)
    B = np.zeros((12, 4))
    B[5] = 5.764666079e-4
    B[7] = 0.01708049209 * np.array([-1, -1, 1, 1])
    B[9] = 0.01708049209 * np.array([-1, 1, 1, -1])
    B[11] = 8.239089297e-4 * np.array([1, -1, 1, -1])
    assert np.allclose(found.B, B, rtol=1e-9, atol=0)
    assert np.array_equal(found.eigenvalues(), np.ones(12))
    answer = found.controllability()
    assert answer.is_controllable
    assert answer.rank == answer.needed == 12
    assert found.observability().is_observable
    assert found.symbolic.A.nnz() < 40  # sparse


def test_check_point_of_the_paper():
    plant = quadrotor().discretise("euler", dt=1 / 40)
    x = [1, -2, 3, 0.5, 29, -0.3, 0.2, -0.4, -0.3, 0.6, 0.7, -0.8]
    u = [200, 210, 220, 230]
    found = linearise(plant, {**dict(zip(STATES, x, strict=True)), **{f"u{k + 1}": u[k] for k in range(4)}})
    f = ravel(numeric(plant, found.symbolic.f)(x, u, 1.0))
    expected = [
        0.95, -2.024138374, 3.0125, 0.4157151338, 28.9925, -0.3100371901,
        0.19, 0.303437037, -0.285, 0.5925333333, 0.68, -0.8166549296,
    ]  # fmt: skip
    assert np.allclose(f, expected, atol=1e-9)
    assert np.allclose(found.A[1, [6, 8, 10]], [0.1603438428, 0.17990068, 0.08428486622], atol=1e-10)
    assert np.allclose(found.A[3, [6, 8, 10]], [-0.1674722476, 0.1515282524, -0.02413837417], atol=1e-10)
    assert np.linalg.norm(found.A) == pytest.approx(3.482699151, abs=1e-9)


def test_python_control_finds_the_same_matrices():
    plant = pendulum()
    values = {"theta": 0.4, "omega": 0.3, "torque": 0.1, "mass": 0.3}
    found = linearise(plant, values)
    f, h = numeric(plant, found.symbolic.f), numeric(plant, found.symbolic.h)
    model = control.nlsys(
        lambda t, x, u, params: ravel(f(x, u, 0.3)),
        lambda t, x, u, params: ravel(h(x, u, 0.3)),
        states=2,
        inputs=1,
        outputs=3,
    )
    peer = control.linearize(model, [0.4, 0.3], [0.1])
    own = found.to_state_space()
    for name in "ABCD":
        assert np.allclose(getattr(own, name), getattr(peer, name), atol=1e-4), name
    assert own.state_labels == ["theta", "omega"]
    assert own.input_labels == ["torque"]
    assert own.output_labels == ["encoder", "accelerometer_0", "accelerometer_1"]
    assert own.dt == 0
    assert np.allclose(np.sort_complex(own.poles()), np.sort_complex(found.eigenvalues()))
    assert np.allclose(found.G, [[0], [1 / (0.3 * 0.25)]])
    sampled = linearise(plant.discretise("rk4", dt=0.01), values).to_state_space()
    assert sampled.dt == 0.01


def _turned(plant, x, error):
    return ravel(ca.Function("r", [plant.x], [plant.retract(plant.x, ca.DM(error))])(x))


def _difference(plant, after, before):
    """Error of `after` seen from `before`."""
    pieces = []
    for state in plant.states:
        a, b = after[state.at], before[state.at]
        if state.attitude:
            w, v = b[0], b[1:]
            pieces.append(2 * (w * a[1:] - a[0] * v - np.cross(v, a[1:])))
        else:
            pieces.append(a - b)
    return np.concatenate(pieces)


BODY_AT = {"q": [0.5, 0.5, -0.5, 0.5], "rate": [0.3, -0.2, 0.4], "torque": [0.1, 0.2, -0.1], "twist": 0.2}


@pytest.mark.parametrize("method", ["euler", "rk4"])
def test_attitude_over_a_step_beside_finite_differences(method):
    plant = body().discretise(method, dt=0.2)
    found = linearise(plant, BODY_AT)
    following = numeric(plant, found.symbolic.f)
    h = numeric(plant, found.symbolic.h)
    x, u = found.point.x, found.point.u
    base = ravel(following(x, u, []))

    def after(error, du):
        return _difference(plant, ravel(following(_turned(plant, x, error), u + du, [])), base)

    step = 1e-5
    for index, unit in enumerate(np.eye(6) * step):
        assert np.allclose((after(unit, 0) - after(-unit, 0)) / (2 * step), found.A[:, index], atol=1e-8)
        sensed = ravel(h(_turned(plant, x, unit), u, [])) - ravel(h(_turned(plant, x, -unit), u, []))
        assert np.allclose(sensed / (2 * step), found.C[:, index], atol=1e-8)
    for index, unit in enumerate(np.eye(4) * step):
        moved = after(np.zeros(6), unit) - after(np.zeros(6), -unit)
        assert np.allclose(moved / (2 * step), found.B[:, index], atol=1e-8)


def test_attitude_in_continuous_time_is_the_limit_of_a_short_step():
    plant = body()
    found = linearise(plant, BODY_AT)
    dt = 1e-6
    short = linearise(plant.discretise("rk4", dt=dt), BODY_AT)
    assert found.states == ("q_e0", "q_e1", "q_e2", "rate_0", "rate_1", "rate_2")
    assert np.allclose((short.A - np.eye(6)) / dt, found.A, atol=1e-5)
    assert np.allclose(short.B / dt, found.B, atol=1e-5)
    assert np.array_equal(short.C, found.C)
    assert np.allclose(found.G, np.vstack([np.zeros((3, 3)), np.eye(3)]))


def test_time_step_as_input():
    plant = pendulum().discretise("euler", dt=(0.001, 0.1))
    assert linearise(plant, dt=0.05).A[0, 1] == pytest.approx(0.05)
    for wrong in (None, 0.5):
        with pytest.raises(ModelError, match="dt is an input"):
            linearise(plant, dt=wrong)
    with pytest.raises(ModelError, match="leave dt= out"):
        linearise(pendulum(), dt=0.1)


def test_derivative_that_is_not_finite_is_named():
    plant = Plant("tank")
    level = plant.state("level", range=(0, 10))
    plant.dynamics({level: -ca.sqrt(level)})
    with pytest.raises(ModelError, match="tank: A is not finite in the row of level"):
        linearise(plant)


def test_labels_are_never_alike():
    plant = Plant("p")
    v, v0 = plant.state("v", size=2), plant.state("v_0")
    plant.dynamics({v: -v, v0: v[0]})
    found = linearise(plant)
    assert found.states == ("v_0_", "v_1", "v_0")
    assert found.to_state_space().nstates == 3  # no input, no sensor


# -- the Hautus test --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("seed", range(12))
def test_rank_of_a_plant_with_hidden_modes(seed):
    """Modes hidden by a random change of coordinates, some with the eigenvalue of a visible one."""
    generator = np.random.default_rng(seed)
    reached, hidden = 4, 1 + seed % 3
    n = reached + hidden
    A = np.zeros((n, n))
    A[:reached, :reached] = generator.standard_normal((reached, reached))
    own = np.diag(-np.arange(1.0, hidden + 1)) + np.triu(generator.standard_normal((hidden, hidden)), 1)
    A[reached:, reached:] = own
    A[:reached, reached:] = generator.standard_normal((reached, hidden))
    B = np.zeros((n, 2))
    B[:reached] = generator.standard_normal((reached, 2))
    T = generator.standard_normal((n, n))
    T, inverse = T, np.linalg.inv(T)
    found = linear(T @ A @ inverse, T @ B, np.eye(n))
    answer = found.controllability()
    peer = np.linalg.matrix_rank(control.ctrb(found.A, found.B), tol=1e-7)
    assert answer.rank == reached == peer
    assert not answer.is_controllable
    expected = -np.arange(1.0, hidden + 1)[::-1]
    assert np.allclose(np.sort(answer.uncontrollable_eigenvalues.real), expected, atol=1e-6)
    dual = linear((T @ A @ inverse).T, np.eye(n), (T @ B).T).observability()
    assert dual.rank == reached
    assert np.allclose(np.sort(dual.unobservable_eigenvalues.real), expected, atol=1e-6)


def test_defective_modes():
    """Computed eigenvalues of -1 twice are off by 1e-8; the test must still see the mode that is not reached."""
    A = np.array([[0.0, 1.0], [-1.0, -2.0]])
    answer = linear(A, [[1.0], [-1.0]]).controllability()
    assert answer.rank == 1
    assert answer.uncontrollable_eigenvalues == pytest.approx([-1.0])
    assert linear(A, [[0.0], [1.0]]).controllability().is_controllable
    jordan = np.diag(np.full(6, -0.5)) + np.diag(np.ones(5), 1)
    T = np.linalg.qr(np.random.default_rng(1).standard_normal((6, 6)))[0]
    for position, rank in ((5, 6), (3, 4), (0, 1)):
        B = np.eye(6)[:, [position]]
        assert linear(T @ jordan @ T.T, T @ B).controllability().rank == rank
        assert linear(jordan, B).controllability().rank == rank
    assert linear(np.eye(3), np.zeros((3, 1))).controllability().rank == 0
    assert linear(np.eye(3), np.ones((3, 2))).controllability().rank == 1


def test_the_kalman_matrix_misjudges_and_the_test_does_not():
    """A chain in mixed units and many modes, both controllable: the rank of (B, AB, ...) is lost in rounding."""
    modes = np.diag(-np.linspace(1, 20, 20))
    found = linear(modes, np.ones((20, 1)))
    assert np.linalg.matrix_rank(control.ctrb(found.A, found.B)) < 20
    assert found.controllability().is_controllable
    chain = np.diag([1e-3, 1e5, 1e-4, 1e3, 1e-6], 1)
    found = linear(chain, 1e-5 * np.eye(6)[:, [5]], np.eye(6)[[0]])
    assert found.controllability().is_controllable
    assert found.observability().is_observable
    cut = chain.copy()
    cut[2, 3] = 0.0
    assert linear(cut, 1e-5 * np.eye(6)[:, [5]]).controllability().rank == 3


def test_a_planted_fault_loses_the_rank():
    """A rotor that no longer answers, and an altitude that is no longer measured."""
    plant = quadrotor()
    found = linearise(plant, trim(plant))
    assert found.controllability().rank == 12
    B = found.B @ np.diag([1, 0, 0, 0])
    assert analysis.hautus(found.A, B, 1e-10)[0] == np.linalg.matrix_rank(control.ctrb(found.A, B), tol=1e-9) < 12
    blind = found.C.copy()
    blind[4] = 0.0  # altitude
    assert analysis.hautus(found.A.T, blind.T, 1e-10)[0] == 11


# -- the linearised plant ---------------------------------------------------------------------------------------------


def test_linearised_quadrotor():
    plant = quadrotor().discretise("euler", dt=1 / 40).step_noise({name: 1e-6 for name in STATES})
    point = trim(plant, hold={"x5": 30})
    flat = linearised_plant(plant, point)
    assert flat.dt == 1 / 40
    assert flat.discretisation is None
    assert flat.step_variances == plant.step_variances
    assert not flat.parameters
    again = linearise(flat, dict(point))
    original = linearise(plant, point)
    for name in "ABCD":
        assert np.allclose(getattr(again, name), getattr(original, name), rtol=1e-11, atol=0), name
    f = numeric(flat, flat.dynamics_expression())
    assert np.allclose(ravel(f(point.x, np.full(4, HOVER), [])), point.x, atol=1e-10)
    away = point.x + 0.1
    assert np.allclose(ravel(f(away, point.u, [])), point.x + original.A @ (away - point.x), atol=1e-10)
    assert flat.fingerprint() == linearised_plant(plant, point).fingerprint()


def test_linearised_numbers_do_not_hold_the_last_bits():
    plant = quadrotor().discretise("euler", dt=1 / 40)
    point = trim(plant, hold={"x5": 30})
    shaken = {name: value * (1 + 3e-16) if name.startswith("u") else value for name, value in point.items()}
    assert shaken["u1"] != point["u1"]
    assert linearised_plant(plant, shaken).fingerprint() == linearised_plant(plant, point).fingerprint()
    shaken["u1"] *= 1 + 1e-9  # the check can fail
    assert linearised_plant(plant, shaken).fingerprint() != linearised_plant(plant, point).fingerprint()


def test_linearised_with_density_keeps_method_and_noise():
    plant = pendulum()
    made = plant.discretise("rk4", dt=(0.001, 0.1), substeps=2)
    flat = linearised_plant(made, {"theta": 0.3, "mass": 0.4})
    assert flat.discretisation is not None
    assert (flat.discretisation.method, flat.discretisation.substeps, flat.dt) == ("rk4", 2, (0.001, 0.1))
    assert [noise.signal.name for noise in flat.process_noises] == ["draught"]
    assert flat.process_noises[0].is_density
    assert flat.process_noises[0].strength.tolist() == [[1e-3]]
    own = linearise(flat.discretisation.continuous, {"theta": 0.3})
    theirs = linearise(plant, {"theta": 0.3, "mass": 0.4})
    for name in "ABCDG":
        assert np.allclose(getattr(own, name), getattr(theirs, name), rtol=1e-11, atol=0), name
    assert own.point.residual == pytest.approx(theirs.point.residual, rel=1e-11)
    signals = [(state.signal, state.attitude) for state in flat.states]
    assert signals == [(state.signal, state.attitude) for state in plant.states]
    assert [symbol.signal for symbol in flat.inputs] == [symbol.signal for symbol in plant.inputs]
    for a, b in zip(flat.sensors, plant.sensors, strict=True):
        assert a.signal == b.signal
        assert np.array_equal(a.strength, b.strength)
    exact = linearised_plant(flat.discretisation.continuous.discretise("exact", dt=0.01), {"theta": 0.0})
    assert exact.discretisation.method == "exact"


def test_angles_are_seen_from_the_upright_pendulum():
    """Half a turn on either side is the same angle: -3.1 lies 0.08 beyond pi."""
    plant = pendulum()
    flat = linearised_plant(plant, {"theta": math.pi})
    f = numeric(flat, flat.without_noise(flat.dynamics_expression()))
    own = numeric(plant, plant.without_noise(plant.dynamics_expression()))
    for theta in (3.1, -3.1):
        assert np.allclose(ravel(f([theta, 0], 0, [])), ravel(own([theta, 0], 0, 0.2)), atol=1e-3)


def test_noises_of_sensors_carry_over():
    plant = Plant("ranger", dt=0.1)
    x, y = plant.state("x"), plant.state("y")
    w = plant.noise("w", variance=0.2)
    v = plant.noise("v", variance=0.1)
    k = plant.parameter("k", 2.0)
    plant.dynamics({x: x + k * y + x * w, y: 0.5 * ca.sin(y)})
    plant.sensor("range", ca.sqrt(x**2 + y**2) * (1 + v))
    plant.sensor("level", ca.vertcat(x * y, y), variance=lambda z: 0.1 + k * z[0] ** 2 + x**2)
    at = {"x": 3.0, "y": 4.0, "k": 3.0}
    flat = linearised_plant(plant, at)
    own, theirs = linearise(flat, {"x": 3, "y": 4}), linearise(plant, at)
    for name in "ABCDGN":
        assert np.allclose(getattr(own, name), getattr(theirs, name), rtol=1e-11, atol=0), name
    assert theirs.N[:, 0].tolist() == [5.0, 0.0, 0.0]
    assert theirs.sensor_noises == ("v",)
    sensor = flat.sensors[1]
    R = ca.Function("R", [flat.x, sensor.measurement], [ca.densify(sensor.variance_expression)])
    assert np.allclose(np.asarray(R([1, 0], [2, 0])), (0.1 + 3 * 4 + 1) * np.eye(2))
    with pytest.raises(ModelError, match=r"noise of the sensor 'range' vanishes|not finite"):
        linearised_plant(plant, {"x": 0.0, "y": 0.0})


def test_attitude_is_not_linearised_into_a_plant():
    with pytest.raises(ModelError, match="'q' is an attitude"):
        linearised_plant(body())
