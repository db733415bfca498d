"""The quadrotor of specs/meda2018.md: check points, and the compiled filters."""

import casadi as ca
import numpy as np
import pytest
from plantc.codegen import TraceCall
from plantc.examples.quadrotor_ekf import (
    hover,
    initial_variance,
    quadrotor,
    quadrotor_ekf,
    quadrotor_kf,
    sampled,
    set_point,
)
from plantc.symbolic.discretisation import transition

from plantc import InterpretView, NativeView, Trace, kalman_filter, linearise, trim

X = np.array([1, -2, 3, 0.5, 29, -0.3, 0.2, -0.4, -0.3, 0.6, 0.7, -0.8])
U = np.array([200.0, 210, 220, 230])


def test_the_check_point_of_section_2():
    following, F = transition(sampled)
    f = ca.Function("f", [sampled.x, sampled.u], [following, ca.densify(F)])
    value, jacobian = (np.array(item) for item in f(X, U))
    expected = [
        0.95, -2.024138374, 3.0125, 0.4157151338, 28.9925, -0.3100371901,
        0.19, 0.303437037, -0.285, 0.5925333333, 0.68, -0.8166549296,
    ]  # fmt: skip
    np.testing.assert_allclose(value.ravel(), expected, rtol=2e-10, atol=5e-11)
    np.testing.assert_allclose(jacobian[1, [6, 8, 10]], [0.1603438428, 0.17990068, 0.08428486622], rtol=1e-9)
    np.testing.assert_allclose(jacobian[3, [6, 8, 10]], [-0.1674722476, 0.1515282524, -0.02413837417], rtol=1e-9)
    assert np.linalg.norm(jacobian) == pytest.approx(3.482699151, rel=1e-9)


def test_the_linear_model_of_section_3():
    made = linearise(sampled, set_point)
    expected = np.eye(12)
    for i in range(0, 12, 2):
        expected[i, i + 1] = 1 / 40
    expected[1, 8], expected[3, 6] = 0.24525, -0.24525
    np.testing.assert_allclose(made.A, expected, atol=1e-12)
    patterns = {
        5: (1, 1, 1, 1, 5.764666079e-4),
        7: (-1, -1, 1, 1, 0.01708049209),
        9: (-1, 1, 1, -1, 0.01708049209),
        11: (1, -1, 1, -1, 8.239089297e-4),
    }
    B = np.zeros((12, 4))
    for row, (*signs, size) in patterns.items():
        B[row] = np.array(signs) * size
    np.testing.assert_allclose(made.B, B, rtol=1e-9, atol=1e-15)
    assert made.controllability().is_controllable
    np.testing.assert_allclose(made.eigenvalues(), 1, atol=1e-9)


def test_hover_is_the_trim():
    free = [symbol for symbol in quadrotor.inputs]
    point = trim(
        quadrotor, hold={**{s.symbol: 0 for s in quadrotor.states}, "z": 30}, free=free, guess={f: 200 for f in free}
    )
    np.testing.assert_allclose(point.u, 212.718305490559, rtol=1e-12)
    assert hover == pytest.approx(212.718305490559, rel=1e-13)


@pytest.mark.parametrize(
    ("r", "prior", "posterior"), [(0.1, 0.002992508137, 0.002806169613), (0.05, 0.001076309493, 0.0009981623637)]
)
def test_the_steady_state_of_section_10_1c_in_compiled_code(r, prior, posterior):
    view = NativeView(quadrotor_kf)
    params = view.params(variance_pose=np.full(12, r**2))
    memory = view.init(params)
    rotors = {f"rotor_{k}": hover for k in (1, 2, 3, 4)}
    pose = np.zeros(12)
    pose[4] = 30
    diagonal = [12 * i - i * (i - 1) // 2 for i in range(12)]
    for _ in range(1500):
        memory = view.call("predict", memory, view.inputs("predict", rotors), params).memory
        before = memory["covariance"][diagonal].sum()
        memory = view.call("update_pose", memory, view.inputs("update_pose", {"pose": pose}), params).memory
    assert before == pytest.approx(prior, rel=1e-9)
    assert memory["covariance"][diagonal].sum() == pytest.approx(posterior, rel=1e-9)


def pseudo_trace(k, r):
    """The pseudo-noise of section 10.1(e)."""
    i = np.arange(1, 13)
    w = 1e-3 * np.sqrt(2) * np.sin(1.1 * k * i + 2.3 * i + 0.5)
    v = r * np.sqrt(2) * np.sin(1.7 * k * i + 0.7 * i**2 + 0.2)
    return w, v


F44 = np.array(
    [
        [-25.0, 411.0, -8.9, 399.0], [-4.3, 333.0, 13.0, 311.0], [-311.0, -20.0, -322.0, -32.0],
        [-277.0, -22.0, -299.0, -37.0], [199.0, 200.0, 199.0, 200.0], [93.0, 95.0, 93.0, 95.0],
        [711.0, 59.0, 766.0, 122.0], [56.0, 2.9, 67.0, 14.0], [28.0, 844.0, 97.0, 766.0],
        [3.4, 71.0, 15.0, 58.0], [177.0, -188.0, 177.0, -188.0], [74.0, -76.0, 74.0, -76.0],
    ]
)  # fmt: skip


@pytest.mark.parametrize(
    ("block", "true_end", "estimate_end", "nees"),
    [
        (
            quadrotor_ekf,
            "-0.008536532986 0.008827556118 -0.001937207118 -0.005258865354 30.00221336 -0.02966842987 0.001202832832 "
            "-0.04391605094 -0.0009526354312 -0.004087654359 -0.003315852952 -0.04368804805",
            "-0.006927110381 0.006894876945 -0.002241272904 -0.0161568893 30.00387817 -0.03246977553 0.003734578313 "
            "-0.04255812147 -0.001719929443 -0.004867032974 0.009323277675 -0.04415204267",
            5.976205286,
        ),
        (
            quadrotor_kf,
            "0.03573159475 0.005047293446 -0.05498450452 0.003694519054 29.96447733 -0.02958716735 -0.0008668377581 "
            "-0.03895169246 -0.001542361076 -0.0008286091748 0.01552325863 -0.03811895492",
            "0.03717780521 -0.003088560355 -0.05503635026 0.001174588742 29.96315985 -0.03856543114 -0.002337576424 "
            "-0.04863366172 -0.005614954358 -0.01162184703 0.02496398231 -0.04533404974",
            24.32898926,
        ),
    ],
)
def test_the_closed_loop_of_section_10_1e_with_the_compiled_filter(block, true_end, estimate_end, nees):
    view = NativeView(block)
    params = view.params(variance_pose=np.full(12, 0.05**2), gate_pose=0.0)
    memory = view.init(params)
    truth = ca.Function("f", [sampled.x, sampled.u], [transition(sampled)[0]])
    x_o = np.zeros(12)
    x_o[4] = 30
    x = x_o + 0.05 * (-1.0) ** np.arange(1, 13)
    names = [state.signal.name for state in sampled.states]
    estimate, total = x_o.copy(), 0.0
    for k in range(1, 101):
        u = hover - F44.T @ (estimate - x_o)
        w, v = pseudo_trace(k, 0.05)
        x = np.array(truth(x, u)).ravel() + w
        inputs = {f"rotor_{i + 1}": u[i] for i in range(4)} | {"has_pose": True, "pose": x + v}
        answer = view.call("step", memory, view.inputs("step", inputs), params)
        assert answer.status == 0
        memory = answer.memory
        estimate = np.array([memory[name] for name in names])
        P = np.zeros((12, 12))
        P[np.triu_indices(12)] = memory["covariance"]
        P = P + np.triu(P, 1).T
        total += (x - estimate) @ np.linalg.solve(P, x - estimate)
    np.testing.assert_allclose(x, [float(item) for item in true_end.split()], atol=1e-7)
    np.testing.assert_allclose(estimate, [float(item) for item in estimate_end.split()], atol=1e-7)
    assert total / 100 == pytest.approx(nees, rel=1e-6)


def test_the_ekf_of_a_linear_plant_is_the_kf():
    from plantc.symbolic.analysis import linearised_plant

    from plantc import extended_kalman_filter

    linear = linearised_plant(sampled, set_point)
    ekf = InterpretView(
        extended_kalman_filter(
            linear, initial_variance={s.signal.name: 0.01 / 3 for s in linear.states}, around=set_point
        )
    )
    kf = InterpretView(kalman_filter(sampled, at=set_point, initial_variance=initial_variance))
    rng = np.random.default_rng(0)
    calls = []
    for _ in range(40):
        inputs = {f"rotor_{i}": hover + rng.normal() for i in (1, 2, 3, 4)}
        calls.append(
            TraceCall("step", {**inputs, "has_pose": True, "pose": np.eye(12)[4] * 30 + 0.1 * rng.normal(size=12)})
        )
    answers = [view.run(Trace("noise", calls)) for view in (ekf, kf)]
    for name in ("x", "z", "yaw_rate", "covariance"):
        np.testing.assert_allclose(answers[0].column(name), answers[1].column(name), rtol=1e-10, atol=1e-10)
