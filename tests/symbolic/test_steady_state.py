"""The steady-state filter: its gain against SciPy and the time-varying filter, its errors, its design record."""

import control
import numpy as np
import pytest
from scipy.linalg import expm

from plantc import ModelError, NativeView, Plant, cross_check, kalman_filter, steady_state_kalman_filter


def spring(**changes):
    plant = Plant("spring")
    position, speed = plant.state("position", unit="m"), plant.state("speed", unit="m/s")
    push = plant.noise("push", density=0.5, unit="m/s^2")
    plant.dynamics({position: speed, speed: push - 4 * position - 0.1 * speed})
    plant.sensor("ruler", position, variance=changes.get("variance", 0.01), unit="m")
    return plant.discretise("exact", dt=changes.get("dt", 0.05))


def test_the_gain_is_that_of_python_control():
    block = steady_state_kalman_filter(spring())
    A = np.array([[0, 1], [-4, -0.1]])
    system = control.c2d(control.ss(A, [[0], [1]], [[1, 0]], 0), 0.05)
    times = np.linspace(0, 0.05, 2001)
    spread = np.array([expm(A * t) @ [0, 1] for t in times])
    Q = 0.5 * np.trapezoid(np.einsum("ti,tj->ijt", spread, spread), times)
    L, _, _ = control.dlqe(system.A, np.eye(2), system.C, Q, [[0.01]])
    # python-control's is the gain of the predictor, A times that of the filter
    np.testing.assert_allclose(system.A @ block.design.values["gain"], L, rtol=1e-6)


def test_the_time_varying_filter_settles_on_it():
    steady = steady_state_kalman_filter(spring())
    varying = NativeView(kalman_filter(spring(), initial_variance={"position": 1, "speed": 1}))
    params = varying.params()
    memory = varying.init(params)
    for _ in range(400):
        memory = varying.call("step", memory, varying.inputs("step", {"has_ruler": True, "ruler": 0.0}), params).memory
    before = memory.copy()
    # one more reading of 1: the correction is the gain
    answer = varying.call("step", before, varying.inputs("step", {"has_ruler": True, "ruler": 1.0}), params)
    gain = [float(answer.memory["position"]), float(answer.memory["speed"])]
    np.testing.assert_allclose(np.ravel(steady.design.values["gain"]), gain, rtol=1e-7)


@pytest.mark.parametrize("precision", ["double", "float"])
def test_all_views_agree(precision):
    check = cross_check(steady_state_kalman_filter(spring()), precision, steps=40)
    assert check.passed, [str(item) for item in check.failures]


def test_what_cannot_be_designed_is_a_sentence():
    plant = Plant("cart")
    place = plant.state("place")
    push = plant.noise("push", density=1.0)
    plant.dynamics({place: push})
    plant.sensor("s", place, variance=1.0)
    cart = plant.discretise("euler", dt=(0.01, 0.1))
    with pytest.raises(ModelError, match="a steady state needs a constant time step"):
        steady_state_kalman_filter(cart)
    blind = Plant("blind")
    seen, unseen = blind.state("seen"), blind.state("unseen")
    w = blind.noise("w", density=1.0)
    blind.dynamics({seen: w, unseen: unseen})
    blind.sensor("s", seen, variance=1.0)
    with pytest.raises(ModelError, match="no stabilising gain exists"):
        steady_state_kalman_filter(blind.discretise("exact", dt=0.1))
    bent = Plant("bent")
    x = bent.state("x")
    v = bent.noise("v", density=1.0)
    bent.dynamics({x: -(x**3) + v})
    bent.sensor("s", x, variance=1.0)
    with pytest.raises(ModelError, match="needs a linear plant"):
        steady_state_kalman_filter(bent.discretise("euler", dt=0.1))


def test_the_design_says_how_good_it_is_and_a_wrong_gain_is_seen():
    block = steady_state_kalman_filter(spring())
    good = block.design.properties(block.design.values)
    assert all(value <= limit for value, limit in good.values())
    wrong = block.design.properties({"gain": block.design.values["gain"] * 1.01})
    assert any(value > limit for value, limit in wrong.values())
    again = block.design.rebuild({"gain": [[0.5], [0.25]]})
    assert again.model_hash() != block.model_hash()
