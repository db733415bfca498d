"""From continuous dynamics to one step: beside SciPy, python-control and the published numbers."""

import itertools

import casadi as ca
import control
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from plantc.symbolic import ModelError, Plant, cos, sin, vertcat
from plantc.symbolic.discretisation import process_covariance, transition
from scipy.integrate import quad_vec, solve_ivp
from scipy.linalg import expm
from scipy.spatial.transform import Rotation


def evaluate(plant, x, u=(), dt=None, *, what=None):
    """Return next state and F as numbers."""
    expressions = transition(plant) if what is None else what
    names = [plant.x, plant.u, plant.p, ca.SX.sym("none") if dt is None else plant.dt_symbol]
    p = [value for item in plant.parameters for value in item.signal.default]
    function = ca.Function("f", names, [ca.densify(item) for item in expressions])
    return [np.array(item) for item in function.call([ca.DM(x), ca.DM(list(u)), ca.DM(p), ca.DM(dt or 0)])]


def following(plant, x, u=(), dt=None):
    return evaluate(plant, x, u, dt)[0].ravel()


def matrix(expression):
    return np.array(ca.evalf(ca.densify(expression)), dtype=float)


def linear(A, B):
    plant = Plant("linear")
    x, u = plant.state("x", size=len(A)), plant.input("u", size=B.shape[1])
    plant.dynamics({x: ca.DM(A) @ x + ca.DM(B) @ u})
    return plant


def swing():
    """A pendulum with an input and a parameter; not linear."""
    plant = Plant("swing")
    angle, rate = plant.state("angle"), plant.state("rate")
    push, length = plant.input("push"), plant.parameter("length", 0.7)
    plant.dynamics({angle: rate, rate: push * cos(angle) - 9.81 / length * sin(angle) - 0.1 * rate**2})
    return plant


def swing_rates(t, s, push=0.4):
    return [s[1], push * np.cos(s[0]) - 9.81 / 0.7 * np.sin(s[0]) - 0.1 * s[1] ** 2]


A2 = np.array([[0.0, 1.0], [-4.0, -0.5]])
B2 = np.array([[0.0, 0.3], [2.0, 1.0]])
MATRICES = st.integers(1, 4).flatmap(
    lambda n: st.lists(st.floats(-3, 3), min_size=n * n, max_size=n * n).map(
        lambda v: np.round(np.array(v).reshape(n, n), 3)
    )
)


# -- linear plants ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("method", "theirs"), [("exact", "zoh"), ("tustin", "bilinear"), ("euler", "euler")])
@pytest.mark.parametrize("dt", [1e-3, 0.1, 1.0])
def test_linear_plants_beside_python_control(method, theirs, dt):
    plant = linear(A2, B2).discretise(method, dt=dt)
    x, u = np.array([0.7, -0.3]), np.array([0.5, 0.2])
    after, F = evaluate(plant, x, u)
    other = control.ss(A2, B2, np.eye(2), 0).sample(dt, method=theirs)
    np.testing.assert_allclose(F, other.A, rtol=1e-12, atol=1e-14)
    if method == "tustin":  # the trapezoidal rule with the input held; python-control changes the state's coordinates
        half = 0.5 * dt * A2
        expected = np.linalg.solve(np.eye(2) - half, (np.eye(2) + half) @ x + dt * B2 @ u)
    else:
        expected = other.A @ x + other.B @ u
    np.testing.assert_allclose(after.ravel(), expected, rtol=1e-12, atol=1e-14)


@settings(max_examples=40, deadline=None, derandomize=True)
@given(A=MATRICES, dt=st.floats(1e-4, 1.0))
def test_exact_is_the_matrix_exponential(A, dt):
    _, F = evaluate(linear(A, np.ones((len(A), 1))).discretise("exact", dt=dt), np.zeros(len(A)), [0])
    scale = np.max(np.abs(expm(A * dt)))
    np.testing.assert_allclose(F, expm(A * dt), rtol=1e-10, atol=1e-12 * scale)


def test_a_constant_drive_is_held_too():
    plant = Plant("fall")
    z, v = plant.state("z"), plant.state("v")
    plant.dynamics({z: v, v: -9.81})
    np.testing.assert_allclose(
        following(plant.discretise("exact", dt=0.5), [10, 1]), [10 + 0.5 - 9.81 / 8, 1 - 9.81 / 2]
    )


def test_exact_with_dt_as_input_for_a_chain():
    plant = Plant("chain")
    p, v, a, u = plant.state("p"), plant.state("v"), plant.state("a"), plant.input("u")
    gain = plant.parameter("gain", 2.0)
    plant.dynamics({p: v, v: gain * a, a: u})
    d = plant.discretise("exact", dt=(1e-3, 2.0))
    A = np.array([[0, 1, 0], [0, 0, 2.0], [0, 0, 0]])
    reference = control.ss(A, [[0], [0], [1]], np.eye(3), 0)
    for dt in (1e-3, 0.3, 2.0):
        other = reference.sample(dt, method="zoh")
        after, F = evaluate(d, [1, 2, 3], [0.5], dt)
        np.testing.assert_allclose(F, other.A, rtol=1e-13)
        np.testing.assert_allclose(after.ravel(), other.A @ [1, 2, 3] + other.B @ [0.5], rtol=1e-13)


def test_tustin_with_dt_as_input():
    d = linear(A2, B2).discretise("tustin", dt=(1e-3, 1.0))
    for dt in (1e-3, 0.4):
        _, F = evaluate(d, [1, 2], [0, 0], dt)
        np.testing.assert_allclose(F, np.linalg.solve(np.eye(2) - dt / 2 * A2, np.eye(2) + dt / 2 * A2), rtol=1e-12)


def test_what_exact_and_tustin_cannot_do():
    oscillator = linear(A2, B2)
    sentence = "exact discretisation needs a constant dt and a constant A, or a nilpotent A, but dt is an input; give a constant dt"
    with pytest.raises(ModelError, match=sentence):
        oscillator.discretise("exact", dt=(0.01, 0.1))
    plant = Plant("decay")
    x, rate = plant.state("x"), plant.parameter("rate", 1.0)
    plant.dynamics({x: -rate * x})
    with pytest.raises(ModelError, match=r"but A holds parameters; give a constant dt, or use 'rk4'"):
        plant.discretise("exact", dt=0.1)
    for method in ("exact", "tustin"):
        with pytest.raises(ModelError, match=f"swing: {method} is for linear plants, and these dynamics are not"):
            swing().discretise(method, dt=0.1)
        body = Plant("body")
        q = body.attitude("q")
        body.dynamics({q: [1, 0, 0]})
        with pytest.raises(ModelError, match=f"body: {method} is for linear plants, and an attitude is not linear"):
            body.discretise(method, dt=0.1)
    discrete = Plant("body", dt=0.1)
    q = discrete.attitude("q")
    discrete.dynamics({q: [1, 0, 0]})
    with pytest.raises(ModelError, match="an attitude needs a continuous plant, discretised by 'euler' or 'rk4'"):
        transition(discrete)


# -- nonlinear plants -------------------------------------------------------------------------------------------------


def slope_of(errors):
    """Order of convergence from errors at halved steps."""
    return float(np.log2(errors[-2] / errors[-1]))


@pytest.mark.parametrize(("method", "order"), [("euler", 1), ("rk4", 4)])
def test_order_of_convergence_over_substeps(method, order):
    start, span = [0.8, -0.5], 1.0
    exact = solve_ivp(swing_rates, (0, span), start, rtol=1e-13, atol=1e-13, method="DOP853").y[:, -1]
    errors = [
        np.max(np.abs(following(swing().discretise(method, dt=span, substeps=n), start, [0.4]) - exact))
        for n in (20, 40)
    ]
    assert slope_of(errors) == pytest.approx(order, abs=0.25)


@pytest.mark.parametrize("method", ["euler", "rk4"])
def test_substeps_are_shorter_steps_one_after_another(method):
    short, long = swing().discretise(method, dt=0.05), swing().discretise(method, dt=0.15, substeps=3)
    x, F = np.array([0.3, 1.0]), np.eye(2)
    for _ in range(3):
        step, one = evaluate(short, x, [0.2])
        x, F = step.ravel(), one @ F
    after, whole = evaluate(long, [0.3, 1.0], [0.2])
    np.testing.assert_allclose(after.ravel(), x, rtol=1e-13)
    np.testing.assert_allclose(whole, F, rtol=1e-12)


def test_dt_as_input_is_the_constant_dt():
    loose, fixed = swing().discretise("rk4", dt=(1e-3, 0.5)), swing().discretise("rk4", dt=0.2)
    for a, b in zip(evaluate(loose, [0.3, 1], [0.2], 0.2), evaluate(fixed, [0.3, 1], [0.2]), strict=True):
        np.testing.assert_allclose(a, b, rtol=1e-13)


def test_angles_are_wrapped():
    plant = Plant("wheel")
    angle = plant.state("angle", angle=True)
    plant.dynamics({angle: plant.input("rate")})
    d = plant.discretise("euler", dt=1.0)
    for rate in (0.5, 3.0, 7.0, -9.0):
        assert following(d, [3.0], [rate])[0] == pytest.approx(np.angle(np.exp(1j * (3.0 + rate))), abs=1e-14)
    assert evaluate(d, [3.0], [3.0])[1].item() == 1.0


# -- attitudes --------------------------------------------------------------------------------------------------------


def tumbling():
    """A body whose angular velocity is a state, and depends on its attitude."""
    body = Plant("body")
    q, w = body.attitude("q"), body.state("w", size=3)
    pull = body.input("pull", size=3)
    torque = q.to_body([0.3, -0.2, 1.0])
    body.dynamics({q: w + 0.1 * pull, w: ca.cross(w, ca.DM([1.0, 2.0, 3.0]) * w) + torque})
    return body


def rotation_of(q):
    return Rotation.from_quat([q[1], q[2], q[3], q[0]])


def tumbling_rates(t, s, pull):
    q = s[:4] / np.linalg.norm(s[:4])
    w = s[4:] + 0.1 * pull
    x, y, z = w
    omega = np.array([[0, -x, -y, -z], [x, 0, z, -y], [y, -z, 0, x], [z, y, -x, 0]])
    torque = rotation_of(q).inv().apply([0.3, -0.2, 1.0])
    return np.concatenate([0.5 * omega @ s[:4], np.cross(s[4:], [1, 2, 3] * s[4:]) + torque])


START = np.concatenate([np.array([0.5, -0.5, 0.1, 0.7]) / np.sqrt(1.0), [0.9, -0.6, 0.4]])
PULL = np.array([0.5, 1.0, -2.0])


@pytest.mark.parametrize(("method", "order"), [("euler", 1), ("rk4", 4)])
def test_order_of_convergence_on_rotations(method, order):
    start = START / np.concatenate([np.full(4, np.linalg.norm(START[:4])), np.ones(3)])
    span = 0.8
    exact = solve_ivp(tumbling_rates, (0, span), start, args=(PULL,), rtol=1e-13, atol=1e-13, method="DOP853").y[:, -1]
    errors = []
    for n in (4, 8, 16):
        x = start
        plant = tumbling().discretise(method, dt=span / n)
        step = ca.Function("f", [plant.x, plant.u], [transition(plant)[0]])
        for _ in range(n):
            x = np.array(step(x, PULL)).ravel()
        turn = (rotation_of(exact[:4]).inv() * rotation_of(x[:4])).magnitude()
        errors.append(max(turn, np.max(np.abs(x[4:] - exact[4:]))))
    assert slope_of(errors) == pytest.approx(order, abs=0.35)


@pytest.mark.parametrize("n", [1, 3])
def test_substeps_on_rotations_are_accurate(n):
    start = START / np.concatenate([np.full(4, np.linalg.norm(START[:4])), np.ones(3)])
    exact = solve_ivp(tumbling_rates, (0, 0.3), start, args=(PULL,), rtol=1e-13, atol=1e-13, method="DOP853").y[:, -1]
    found = following(tumbling().discretise("rk4", dt=0.3, substeps=n), start, PULL)
    assert (rotation_of(exact[:4]).inv() * rotation_of(found[:4])).magnitude() < 2e-4 / n**4
    assert np.linalg.norm(found[:4]) == pytest.approx(1, abs=1e-14)


def test_a_constant_rate_is_turned_exactly():
    body = Plant("body")
    q, rate = body.attitude("q"), body.input("rate", size=3)
    body.dynamics({q: rate})
    for method in ("euler", "rk4"):
        found = following(body.discretise(method, dt=0.5), [1, 0, 0, 0], [0.3, -2.0, 1.0])
        np.testing.assert_allclose(rotation_of(found).as_rotvec(), [0.15, -1.0, 0.5], rtol=1e-13)
        _, F = evaluate(body.discretise(method, dt=0.5), [1, 0, 0, 0], [0.3, -2.0, 1.0])
        np.testing.assert_allclose(F, Rotation.from_rotvec([-0.15, 1.0, -0.5]).as_matrix(), atol=1e-13)


# -- Jacobians --------------------------------------------------------------------------------------------------------


def plus(plant, x, error):
    """Move a state by an error; attitudes by a rotation in the body frame."""
    moved = np.array(x, dtype=float)
    for state in plant.states:
        if state.attitude:
            turned = (rotation_of(x[state.at]) * Rotation.from_rotvec(error[state.error_at])).as_quat()
            turned = np.array([turned[3], *turned[:3]])
            moved[state.at] = turned * np.sign(turned @ x[state.at])
        else:
            moved[state.at] += error[state.error_at]
    return moved


def minus(plant, a, b):
    answer = np.zeros(plant.error_size)
    for state in plant.states:
        if state.attitude:
            answer[state.error_at] = (rotation_of(b[state.at]).inv() * rotation_of(a[state.at])).as_rotvec()
        else:
            answer[state.error_at] = a[state.at] - b[state.at]
    return answer


def differences(plant, x, u, h=1e-6):
    center = following(plant, x, u)
    columns = []
    for k in range(plant.error_size):
        error = np.zeros(plant.error_size)
        error[k] = h
        ahead, behind = (following(plant, plus(plant, x, sign * error), u) for sign in (1, -1))
        columns.append((minus(plant, ahead, center) - minus(plant, behind, center)) / (2 * h))
    return np.array(columns).T


@pytest.mark.parametrize(("method", "substeps"), [("euler", 1), ("euler", 3), ("rk4", 1), ("rk4", 2)])
def test_jacobians_beside_differences_in_error_coordinates(method, substeps):
    start = START / np.concatenate([np.full(4, np.linalg.norm(START[:4])), np.ones(3)])
    for plant, x, u in ((swing(), np.array([0.4, -1.0]), [0.3]), (tumbling(), start, PULL)):
        d = plant.discretise(method, dt=0.05, substeps=substeps)
        _, F = evaluate(d, x, u)
        np.testing.assert_allclose(F, differences(d, x, u), atol=3e-7 if d.has_attitude else 1e-8)


def test_a_wrong_jacobian_is_seen():
    d = tumbling().discretise("rk4", dt=0.05)
    start = START / np.concatenate([np.full(4, np.linalg.norm(START[:4])), np.ones(3)])
    after, F = transition(d)
    F[0, 1] = -F[0, 1]
    wrong = evaluate(d, start, PULL, what=(after, F))[1]
    assert np.max(np.abs(wrong - differences(d, start, PULL))) > 1e-3


# -- noise ------------------------------------------------------------------------------------------------------------


def noisy(A, G, S):
    plant = Plant("noisy")
    x, w = plant.state("x", size=len(A)), plant.noise("w", size=G.shape[1], density=S)
    plant.dynamics({x: ca.DM(A) @ x + ca.DM(G) @ w})
    return plant


def gauss(inside, dt, points=50):
    """Integrate from 0 to dt by Gauss-Legendre."""
    nodes, weights = np.polynomial.legendre.leggauss(points)
    return sum(weight * inside(0.5 * dt * (node + 1)) for node, weight in zip(nodes, weights, strict=True)) * dt / 2


def by_quadrature(A, G, S, dt):
    def inside(s):
        phi = expm(A * s) @ G
        return phi @ S @ phi.T

    return gauss(inside, dt)


def spread_of(Q):
    return np.sqrt(np.outer(np.diag(Q), np.diag(Q)))


@settings(max_examples=30, deadline=None, derandomize=True)
@given(A=MATRICES, dt=st.floats(1e-3, 1.0), seed=st.integers(0, 1000))
def test_van_loan_beside_quadrature(A, dt, seed):
    random = np.random.default_rng(seed)
    G = random.normal(size=(len(A), 2))
    root = random.normal(size=(2, 2))
    S = root @ root.T + 0.1 * np.eye(2)
    Q = matrix(process_covariance(noisy(A, G, S).discretise("exact", dt=dt), ca.SX(ca.DM(S))))
    expected = by_quadrature(A, G, S, dt)
    assert np.max(np.abs(Q - expected) / spread_of(expected)) < 1e-9
    assert np.linalg.eigvalsh(Q / spread_of(expected))[0] > -1e-11


def test_a_stiff_plant():
    A = np.array([[-1000.0, 300.0], [0.0, -0.5]])
    Q = matrix(process_covariance(noisy(A, np.eye(2), np.eye(2)).discretise("exact", dt=1.0), ca.SX.eye(2)))
    expected = quad_vec(lambda s: expm(A * s) @ expm(A * s).T, 0, 1.0, epsabs=0, epsrel=1e-12)[0]
    assert np.max(np.abs(Q - expected) / spread_of(expected)) < 1e-9


@pytest.mark.parametrize("n", [2, 3, 4, 5])
@pytest.mark.parametrize("dt", [1e-5, 1e-3, 0.1, 10.0])
def test_a_chain_of_integrators_keeps_its_smallest_variance(n, dt):
    from math import factorial

    plant = Plant("chain")
    states = [plant.state(f"s{i}") for i in range(n)]
    noise = plant.noise("w", density=1.0)
    plant.dynamics({states[i]: states[i + 1] if i < n - 1 else noise for i in range(n)})
    Q = matrix(process_covariance(plant.discretise("exact", dt=dt), ca.SX(1.0)))
    power = 2 * n - 1 - np.add.outer(np.arange(n), np.arange(n))
    links = np.array([factorial(n - 1 - i) for i in range(n)], dtype=float)
    expected = dt ** power.astype(float) / (power * np.outer(links, links))
    np.testing.assert_allclose(Q, expected, rtol=1e-12)
    assert np.linalg.eigvalsh(Q / spread_of(Q))[0] > 0


@settings(max_examples=60, deadline=None, derandomize=True)
@given(dt=st.floats(1e-6, 1e3), angle=st.floats(-3, 3), rate=st.floats(-50, 50))
def test_q_of_a_nonlinear_plant_is_semidefinite_for_every_dt(dt, angle, rate):
    plant = Plant("swing")
    a, r = plant.state("a"), plant.state("r")
    w = plant.noise("w", size=2, density=[[1.0, 0.3], [0.3, 0.5]])
    plant.dynamics({a: r + 0.1 * w[0], r: -9.81 * sin(a) + w[1] * cos(a)})
    d = plant.discretise("euler", dt=(1e-6, 1e3))
    Q = evaluate(d, [angle, rate], (), dt, what=(process_covariance(d, ca.SX(ca.DM([[1, 0.3], [0.3, 0.5]]))),))[0]
    assert np.all(np.diag(Q) > 0)
    assert np.linalg.eigvalsh(Q / spread_of(Q))[0] > -1e-12
    A = np.array([[0, 1], [-9.81 * np.cos(angle), 0]])
    G = np.array([[0.1, 0], [0, np.cos(angle)]])
    S = np.array([[1, 0.3], [0.3, 0.5]])
    expected = gauss(lambda s: (np.eye(2) + A * s) @ G @ S @ G.T @ (np.eye(2) + A * s).T, dt, 2)
    np.testing.assert_allclose(Q, expected, rtol=1e-9, atol=1e-9 * np.max(expected))


def test_a_longer_gap_is_never_more_certain():
    plant = noisy(np.array([[0.0, 1.0], [0.0, 0.0]]), np.array([[0.0], [1.0]]), np.eye(1))
    d = plant.discretise("euler", dt=(1e-3, 100))
    Q = [evaluate(d, [0, 0], (), dt, what=(process_covariance(d, ca.SX(1.0)),))[0] for dt in (0.1, 1.0, 10.0)]
    for short, long in itertools.pairwise(Q):
        assert np.linalg.eigvalsh(long - short)[0] > 0
    np.testing.assert_allclose(Q[1], [[1 / 3, 1 / 2], [1 / 2, 1]], rtol=1e-14)


def test_noise_per_step_is_not_integrated():
    plant = Plant("walk", dt=0.1)
    x = plant.state("x", size=2)
    w = plant.noise("w", variance=3.0)
    plant.dynamics({x: vertcat(x[0] + 2 * w, x[1] - w)})
    np.testing.assert_allclose(matrix(process_covariance(plant, ca.SX(3.0))), 3 * np.array([[4, -2], [-2, 1]]))


def test_the_error_of_an_attitude_turns_with_the_body():
    body = Plant("body")
    q, rate = body.attitude("q"), body.input("rate", size=3)
    noise = body.noise("n", size=3, density=1.0)
    body.dynamics({q: rate + noise})
    d = body.discretise("euler", dt=0.1)
    Q = evaluate(d, [1, 0, 0, 0], [1.0, -2.0, 3.0], what=(process_covariance(d, ca.SX.eye(3)),))[0]
    W = -np.array([[0, -3, -2], [3, 0, -1], [2, 1, 0]])
    expected = gauss(lambda s: (np.eye(3) + W * s) @ (np.eye(3) + W * s).T, 0.1, 2)
    np.testing.assert_allclose(Q, expected, rtol=1e-12)


# -- the published quadrotor ------------------------------------------------------------------------------------------


def test_the_check_point_of_the_quadrotor():
    from plantc.examples.quadrotor_ekf import sampled

    x = [1, -2, 3, 0.5, 29, -0.3, 0.2, -0.4, -0.3, 0.6, 0.7, -0.8]
    after, J = evaluate(sampled, x, [200, 210, 220, 230])
    expected = [0.95, -2.024138374, 3.0125, 0.4157151338, 28.9925, -0.3100371901, 0.19, 0.303437037, -0.285,
                0.5925333333, 0.68, -0.8166549296]  # fmt: skip
    np.testing.assert_allclose(after.ravel(), expected, rtol=2e-9)
    np.testing.assert_allclose(J[1, [6, 8, 10]], [0.1603438428, 0.17990068, 0.08428486622], rtol=1e-9)
    np.testing.assert_allclose(J[3, [6, 8, 10]], [-0.1674722476, 0.1515282524, -0.02413837417], rtol=1e-9)
    assert np.linalg.norm(J) == pytest.approx(3.482699151, rel=1e-9)


def test_the_quadrotor_hovers():
    from plantc.examples.quadrotor_ekf import hover, sampled

    x = np.zeros(12)
    x[4] = 30
    after, A = evaluate(sampled, x, [hover] * 4)
    assert hover == pytest.approx(212.718305490559, rel=1e-13)
    np.testing.assert_allclose(after.ravel(), x, atol=1e-14)
    expected = np.eye(12)
    for i in range(0, 12, 2):
        expected[i, i + 1] = 1 / 40
    expected[1, 8], expected[3, 6] = 0.24525, -0.24525
    np.testing.assert_allclose(A, expected, atol=1e-15)
