"""Plant, rotors, filter and Jacobian of specs/ekf_fsmc.md: the one-step values of section 11.1, on what is generated."""

import re

import casadi as ca
import numpy as np
import pytest
from plantc.examples import fsmc_jacobian, fsmc_quadrotor
from plantc.examples.fsmc_quadrotor import COMMANDS, DT, SET_A, SETS, STATES, ekf, mixer, sampled, tuned, vehicle
from plantc.reference import fsmc
from plantc.symbolic.discretisation import transition
from plantc.symbolic.estimators import extended_kalman_filter
from plantc.symbolic.simulated import simulated_plant

from plantc import NativeView

X = np.array((0.1, 0.2, -0.15, 0.3, 0.7, -0.4, 1, 0.5, -1, 0.6, 2, -0.7))
U = {"u1": 4.2, "u2": 0.1, "u3": -0.05, "u4": 0.01}
OM = 12.0
A = (5.42670725, -2.74217958, 1.38739029, -0.558816849, -1.85553872, 0.604229081)


@pytest.mark.parametrize("which", SETS)
def test_the_coefficients_are_those_of_the_page(which):
    a, b = fsmc_quadrotor.coefficients(SETS[which])
    np.testing.assert_allclose(a, fsmc.SETS[which].a, rtol=1e-15)
    np.testing.assert_allclose(b, fsmc.SETS[which].b, rtol=1e-15)


@pytest.fixture(scope="module")
def truth():
    return NativeView(simulated_plant(sampled(vehicle(disturbed=True))))


def moved(view, x, d=(0.0,) * 6, v=0.0):
    memory = view.memory(**dict(zip(STATES, x, strict=True)))
    inputs = {**U, "Om": OM, "angular_disturbance": d[:3], "linear_disturbance": d[3:], "pose_noise": np.full(6, v)}
    answer = view.call("step", memory, view.inputs("step", inputs), view.params())
    assert answer.status == 0
    return np.array([float(answer.memory[name]) for name in STATES]), answer.outputs["pose"]


def test_the_plant_in_c_moves_by_the_printed_accelerations_from_the_old_values(truth):
    after, pose = moved(truth, X)
    np.testing.assert_allclose((after[1::2] - X[1::2]) / DT, A, rtol=1e-7)
    np.testing.assert_array_equal(after[::2], X[::2] + DT * X[1::2])  # not with the new velocities
    np.testing.assert_array_equal(pose, after[::2])


def test_disturbances_are_accelerations_and_noise_is_added_to_the_reading(truth):
    d = np.array((0.1, -0.2, 0.3, -0.4, 0.5, -0.6))
    (free, _), (driven, pose) = moved(truth, X), moved(truth, X, d, 0.25)
    np.testing.assert_allclose((driven - free)[1::2], DT * d, rtol=1e-9)
    np.testing.assert_allclose(pose, driven[::2] + 0.25, rtol=1e-15)


def test_the_derived_jacobian_is_that_of_section_11_1_and_of_the_reference():
    plant = sampled(vehicle())
    F = ca.Function("F", [plant.x, plant.u], [ca.densify(transition(plant)[1])])
    ours = np.array(F(X, [*U.values(), OM]))
    np.testing.assert_allclose(ours, fsmc.jacobian(fsmc.SET_A, X, np.array([*U.values()]), OM), rtol=1e-14, atol=1e-18)
    np.testing.assert_allclose(ours[1, [1, 3, 5]], (0.999941826, 2.56559904e-4, -2.59159308e-4), rtol=1e-7)
    np.testing.assert_allclose(ours[9, [0, 2, 4]], (-7.88980637e-3, 6.65491629e-3, -5.18816849e-4), rtol=1e-7)


def test_which_printed_entries_are_wrong():
    """Of F12,1 the page (erratum 9) says that 1/m is missing; in the text at hand it is there, and the entry is right."""
    wrong = {(item.row, item.column): item for item in fsmc_jacobian.wrong()}
    assert set(wrong) == {(8, 1), (8, 5), (10, 1), (12, 3)}
    assert all(item.difference > 0.9 * item.size for item in wrong.values())
    right = [item for item in fsmc_jacobian.compare() if item.right]
    assert len(right) == 13 and all(item.size > 0 for item in right)  # none is right because it vanishes


def test_the_texts_of_the_printed_entries_are_what_is_evaluated():
    entries = fsmc.printed_entries(fsmc.SET_B, X, np.array([*U.values()]), OM)
    assert set(entries) == set(fsmc_jacobian.TEXTS)
    known = {f"x{k + 1}": value for k, value in enumerate(X)} | {f"a{k}": a for k, a in enumerate(fsmc.SET_B.a)}
    known |= {f"C{k}": np.cos(X[k - 1]) for k in (1, 3, 5)} | {f"S{k}": np.sin(X[k - 1]) for k in (1, 3, 5)}
    known |= {"dt": DT, "m": fsmc.SET_B.mass, "Om": OM, "u1": U["u1"]}
    for place, text in fsmc_jacobian.TEXTS.items():
        product = re.sub(r"(?<=[\w)]) (?=[\w(])", "*", text)
        assert eval(product, {}, known) == pytest.approx(entries[place], rel=1e-13), place


def test_the_mixer_in_c():
    view = NativeView(mixer())

    def mixed(*u):
        return view.call("step", view.init(), view.inputs("step", dict(zip(COMMANDS, u, strict=True))), view.params())

    answer = mixed(5, 0.3, -0.2, 0.01)
    np.testing.assert_allclose(answer.outputs["speed"], (230.159517, 170.662391, 215.107972, 197.935841), rtol=1e-8)
    np.testing.assert_allclose(answer.outputs["Om"], 76.6692571, rtol=1e-8)
    np.testing.assert_allclose([float(answer.outputs[name]) for name in COMMANDS], (5, 0.3, -0.2, 0.01), rtol=1e-12)
    assert answer.status == 0
    answer = mixed(1, 2, 0, 0.05)
    np.testing.assert_allclose(answer.outputs["speed"], (216.917489, 0, 216.917489, 56.6703661), rtol=1e-8)
    np.testing.assert_allclose(answer.outputs["Om"], 377.164612, rtol=1e-8)
    applied = [float(answer.outputs[name]) for name in COMMANDS]
    np.testing.assert_allclose(applied, (2.90416151, 0.0958384901, 0, 0.02937722), rtol=1e-8, atol=1e-15)
    assert answer.status.name == "CLAMPED"


@pytest.mark.parametrize("tuning", fsmc_quadrotor.TUNINGS)
def test_the_filter_in_c_is_that_of_the_reference_with_each_tuning(tuning):
    """One Block; the tunings are run-time parameters. It flies after another from a wrong start."""
    view, told = NativeView(FILTER), fsmc.Filter(tuning=fsmc.TUNINGS[tuning])
    params = view.params(**tuned(tuning))
    memory, rng = view.init(params), np.random.default_rng(2)
    u, truth = np.array([*U.values()]), 0.1 * rng.standard_normal(12)
    for _ in range(60):
        truth = fsmc.euler(fsmc.SET_A, truth, u, OM)
        z = truth[::2] + 0.01 * rng.standard_normal(6)
        given = {**U, "Om": OM, "has_pose": True, "pose": z}
        answer = view.call("step", memory, view.inputs("step", given), params)
        assert answer.status == 0
        memory = answer.memory
        told.predict(u, OM)
        told.correct(z)
    np.testing.assert_allclose([float(memory[name]) for name in STATES], told.X, rtol=1e-9, atol=1e-11)
    P = np.zeros((12, 12))
    P[np.triu_indices(12)] = memory["covariance"]
    np.testing.assert_allclose(P[np.triu_indices(12)], told.P[np.triu_indices(12)], rtol=1e-8, atol=1e-12)


FILTER = ekf()


@pytest.mark.parametrize("tuning", [pytest.param("printed", marks=pytest.mark.slow), "robust"])
def test_the_steady_gains_of_section_11_2(tuning):
    """Of the channel psi at hover: the same filter, told nothing but the tuning, until it has settled."""
    position, velocity, reading = fsmc_quadrotor.TUNINGS[tuning]
    plant = vehicle(variance=reading)
    steps = sampled(plant).step_noise({name: velocity if k % 2 else position for k, name in enumerate(STATES)})
    view = NativeView(extended_kalman_filter(steps, initial_variance=dict.fromkeys(STATES, 1.0)))
    params, memory = view.params(), view.init()
    given = {"u1": SET_A["mass"] * SET_A["gravity"], "u2": 0, "u3": 0, "u4": 0, "Om": 0, "has_pose": True}
    count = 8000 if tuning == "printed" else 1500
    for k in range(count):
        pose = np.zeros(6)
        if k == count - 1:
            before = memory
            pose[2] = float(before["yaw"]) + 1e-3
        memory = view.call("step", memory, view.inputs("step", {**given, "pose": pose}), params).memory
    gains = [float(memory["yaw"] - before["yaw"]) / 1e-3, float(memory["yaw_rate"] - before["yaw_rate"]) / 1e-3]
    expected = (0.270885, 0.270021) if tuning == "printed" else (0.0279057, 0.394379)
    np.testing.assert_allclose(gains, expected, rtol=1e-4)
