"""One step: the map, F, Q."""

import numpy as np
import pytest
import reference_plants as plants
from hypothesis import given
from hypothesis import strategies as st
from plantc.reference import derivative
from plantc.reference.discretisation import increment, process_covariance, retract, transition, van_loan
from scipy.integrate import solve_ivp
from scipy.linalg import expm
from scipy.spatial.transform import Rotation

NOTHING = np.zeros(0)


def test_exact_is_the_matrix_exponential():
    model = plants.oscillator(method="exact", dt=0.3)
    x, u = np.array([0.4, -1.0]), np.array([2.0])
    following, F = transition(model, x, u, NOTHING, 0.3)
    augmented = expm(np.block([[plants.OSCILLATOR, plants.PUSH], [np.zeros((1, 3))]]) * 0.3)
    np.testing.assert_allclose(following, augmented[:2, :2] @ x + augmented[:2, 2:] @ u, atol=1e-11)
    np.testing.assert_allclose(F, augmented[:2, :2], atol=1e-11)


def test_exact_with_dt_as_input_is_the_series_of_a_nilpotent_matrix():
    A = np.array([[0.0, 1, 0], [0, 0, 1], [0, 0, 0]])
    state = plants.StateModel("x", 3, "plain", np.full(3, -1e6), np.full(3, 1e6))
    model = plants.model_of([state], lambda x, u, p, w: (A @ x,), [], method="exact", dt=(0.01, 1.0))
    _, F = transition(model, np.ones(3), NOTHING, NOTHING, np.float64(0.7))
    np.testing.assert_allclose(F, expm(A * 0.7), atol=1e-14)


def test_tustin_is_the_bilinear_transform():
    model = plants.oscillator(method="tustin", dt=0.3)
    x = np.array([0.4, -1.0])
    _, F = transition(model, x, np.zeros(1), NOTHING, 0.3)
    half = plants.OSCILLATOR * 0.15
    np.testing.assert_allclose((np.eye(2) - half) @ F, np.eye(2) + half, atol=1e-12)


@pytest.mark.parametrize(("method", "order"), [("euler", 1), ("rk4", 4)])
def test_order_of_convergence(method, order):
    x, u = np.array([1.0, 0.5]), np.array([0.3])
    model = plants.pendulum()
    exact = solve_ivp(lambda t, y: model.dynamics(y, u, NOTHING, np.zeros(1))[0], (0, 0.2), x, rtol=1e-12, atol=1e-13)
    errors = []
    for substeps in (4, 8):
        model = plants.pendulum(method=method, substeps=substeps)
        errors.append(np.linalg.norm(x + increment(model, x, u, NOTHING, np.float64(0.2)) - exact.y[:, -1]))
    assert errors[0] / errors[1] > 0.8 * 2**order


def test_attitude_with_constant_rate_is_a_screw():
    model = plants.attitude(dt=0.5)
    omega = np.array([0.3, -1.0, 0.8])
    x = np.array([1.0, 0, 0, 0, 0, 0, 0])
    following, F = transition(model, x, omega, NOTHING, 0.5)
    turned = Rotation.from_quat(np.roll(following[:4], -1)).as_matrix()
    np.testing.assert_allclose(turned, Rotation.from_rotvec(omega * 0.5).as_matrix(), atol=1e-12)
    # an error in the body frame turns back (Markley 2003)
    np.testing.assert_allclose(F[:3, :3], Rotation.from_rotvec(omega * 0.5).as_matrix().T, atol=1e-12)


@given(st.floats(1e-3, 2), st.floats(1e-6, 10))
def test_constant_density_is_van_loan(dt, density):
    model = plants.oscillator(dt=dt)
    params = {"density_w": np.array([density])}
    Q = process_covariance(model, np.ones(2), np.zeros(1), NOTHING, dt, params)
    np.testing.assert_allclose(Q, van_loan(plants.OSCILLATOR, density * plants.PUSH @ plants.PUSH.T, dt), rtol=1e-9)


def test_van_loan_is_the_integral():
    W = np.array([[0.2, 0.1], [0.1, 1.0]])
    times, weights = np.polynomial.legendre.leggauss(20)
    total = sum(
        0.35 * weight * expm(plants.OSCILLATOR * s) @ W @ expm(plants.OSCILLATOR * s).T
        for s, weight in zip(0.35 * (times + 1), weights, strict=True)
    )
    np.testing.assert_allclose(van_loan(plants.OSCILLATOR, W, 0.7), total, atol=1e-13)


@given(st.floats(1e-3, 1e3), st.floats(-3, 3), st.floats(-20, 20))
def test_q_is_positive_semidefinite_for_any_dt(dt, angle, speed):
    model = plants.pendulum()
    x, params = np.array([angle, speed]), {"density_w": np.array([0.3])}
    values = np.linalg.eigvalsh(process_covariance(model, x, np.zeros(1), NOTHING, np.float64(dt), params))
    assert values[0] >= -1e-12 * values[1]


def test_q_with_dt_as_input_is_near_van_loan_for_a_short_step():
    params = {"density_w": np.array([2.0])}
    args = (np.ones(2), np.zeros(1), NOTHING, np.float64(1e-3), params)
    exact = process_covariance(plants.oscillator(dt=1e-3), *args)
    np.testing.assert_allclose(process_covariance(plants.oscillator(dt=(1e-4, 1.0)), *args), exact, rtol=1e-2)


@pytest.mark.parametrize("method", ["euler", "rk4"])
@pytest.mark.parametrize("make", ["pendulum", "attitude", "oscillator"])
def test_complex_step_agrees_with_differences(make, method):
    model = getattr(plants, make)(method=method, substeps=2)
    rng = np.random.default_rng(1)
    x = np.concatenate([rng.uniform(-0.9, 0.9, state.size) for state in model.states])
    if make == "attitude":
        x[:4] /= np.linalg.norm(x[:4])
    values = {"dt": np.array([0.2]), **{item.name: rng.normal(size=item.size) for item in model.inputs}}
    start = 0
    for state in model.states:
        values[state.name] = x[start : start + state.size]
        start += state.size
    for name in ["F", *(f"H_{sensor.name}" for sensor in model.sensors)]:
        one, other = (derivative(model, name, how)(values) for how in ("complex step", "central differences"))
        np.testing.assert_allclose(one, other, atol=1e-8)


def test_retract_is_inverse_free_of_scale():
    model = plants.attitude()
    x = np.array([0.6, 0.8, 0, 0, 1, 2, 3])
    np.testing.assert_allclose(retract(model, x, np.zeros(6)), x, atol=1e-15)


def test_unknown_names_are_refused():
    with pytest.raises(ValueError, match="complex step"):
        derivative(plants.pendulum(), "F", "guess")
    with pytest.raises(ValueError, match="heun"):
        increment(plants.pendulum(method="heun"), np.ones(2), np.ones(1), NOTHING, 0.1)
