"""The whole scheme of specs/ekf_fsmc.md in NumPy: its one-step values and its deterministic scenarios, section 11."""

import dataclasses
import runpy
from pathlib import Path

import numpy as np
import pytest
from plantc.reference import fsmc
from plantc.reference.fsmc import (
    SET_A,
    SET_B,
    TUNINGS,
    Controller,
    Filter,
    Scenario,
    disturbances,
    simulate,
    trajectory,
)

GOLDEN = runpy.run_path(str(Path(__file__).with_name("fsmc_goldens.py")))
X, U, OM, ACCELERATIONS, TABLE = (GOLDEN[name] for name in ("X", "U", "OM", "ACCELERATIONS", "TABLE"))
ESTIMATE, ONE_STEP, C, D, E, WRONG = (GOLDEN[name] for name in ("ESTIMATE", "ONE_STEP", "C", "D", "E", "WRONG"))
VEHICLES = {"A": SET_A, "B": SET_B}


@pytest.mark.parametrize("which", TABLE)
def test_the_coefficients_of_section_2(which):
    vehicle, text = VEHICLES[which], TABLE[which]
    np.testing.assert_allclose([*vehicle.a[1:], *vehicle.b[1:]], [float(item) for item in text.split()], rtol=6e-6)


def test_the_accelerations_of_section_11_1():
    np.testing.assert_allclose(fsmc.accelerations(SET_A, X, U, OM), ACCELERATIONS, rtol=1e-8)


def test_the_jacobian_of_section_11_1_and_central_differences():
    F = fsmc.jacobian(SET_A, X, U, OM)
    np.testing.assert_allclose(F[1, [1, 3, 5]], (0.999941826, 2.56559904e-4, -2.59159308e-4), rtol=1e-8)
    assert F[5, 5] == pytest.approx(1.00007125, rel=1e-8)
    np.testing.assert_allclose(F[7, [0, 2, 4, 7]], (6.85030396e-3, 7.90099501e-3, 1.80753872e-3, 0.99992), rtol=1e-8)
    np.testing.assert_allclose(F[9, [0, 2, 4]], (-7.88980637e-3, 6.65491629e-3, -5.18816849e-4), rtol=1e-8)
    np.testing.assert_allclose(F[11, [0, 2, 11]], (-1.03648015e-3, 1.56126142e-3, 0.99988), rtol=1e-8)
    moved = [(fsmc.euler(SET_A, X + h, U, OM) - fsmc.euler(SET_A, X - h, U, OM)) / 2e-6 for h in 1e-6 * np.eye(12)]
    np.testing.assert_allclose(F, np.array(moved).T, rtol=0, atol=1e-9)
    printed = fsmc.printed_jacobian(SET_A, X, U, OM)  # the companion: the same differences see the misprints
    assert np.max(np.abs(printed - np.array(moved).T)) > 1e-3


def test_the_mixer_of_section_11_1():
    w, applied, Om, clipped = fsmc.mix(SET_A, np.array((5, 0.3, -0.2, 0.01)))
    np.testing.assert_allclose(w, (230.159517, 170.662391, 215.107972, 197.935841), rtol=1e-8)
    np.testing.assert_allclose(applied, (5, 0.3, -0.2, 0.01), rtol=1e-12)
    assert Om == pytest.approx(76.6692571, rel=1e-8) and not clipped
    w, applied, Om, clipped = fsmc.mix(SET_A, np.array((1, 2, 0, 0.05)))
    np.testing.assert_allclose(w, (216.917489, 0, 216.917489, 56.6703661), rtol=1e-8)
    np.testing.assert_allclose(applied, (2.90416151, 0.0958384901, 0, 0.02937722), rtol=1e-8, atol=1e-15)
    assert Om == pytest.approx(377.164612, rel=1e-8) and clipped


def test_the_fuzzy_system_of_section_7():
    points = (-1.3, -0.75, -0.2, 0, 0.1, 0.5, 0.6, 0.95, 2)
    values = (-1, -0.7, -0.16, 0, 0.08, 0.4, 0.52, 0.94, 1)
    np.testing.assert_allclose([fsmc.fuzzy(v) for v in points], values, rtol=1e-13)


@pytest.mark.parametrize("law", ONE_STEP)
def test_the_law_of_section_11_1(law):
    def sign(v):  # s_y is zero up to rounding, which must not matter here
        return 0.0 if abs(v) < 1e-11 else float(np.sign(v))

    control = Controller(
        law=sign if law == "SMC" else law, Om=5.0, q=np.array((0.01, -0.02)), dq=np.array((0.05, 0.03))
    )
    u = control(np.array(ESTIMATE), trajectory(2.0))
    np.testing.assert_allclose([*u, *control.said["raw"]], ONE_STEP[law], rtol=1e-8)
    np.testing.assert_allclose(control.said["s"], (0.15, 0.07, -0.45619449, 0.492699082, 0, -0.2), atol=1e-9)
    if law == "FSMC":
        np.testing.assert_allclose(control.q, (0.01005, -0.01997), rtol=1e-9)
        np.testing.assert_allclose(control.dq, (0.0105545072, -0.0176444905), rtol=1e-8)


def test_the_gains_of_section_11_2():
    np.testing.assert_allclose(fsmc.steady_gain(TUNINGS["printed"]), (0.270885, 0.270021), rtol=1e-5)
    robust = fsmc.steady_gain(TUNINGS["robust"])
    np.testing.assert_allclose(robust, (0.0279057, 0.394379), rtol=1e-5)
    poles = {}
    for name, gains in (("printed", fsmc.steady_gain(TUNINGS["printed"])), ("robust", robust)):
        F = (np.eye(2) - np.outer(gains, (1, 0))) @ np.array([[1, fsmc.DT], [0, 1]])
        poles[name] = -np.log(np.linalg.eigvals(F).astype(complex)) / fsmc.DT
    np.testing.assert_allclose(sorted(poles["printed"].real), (1.00, 315), rtol=1e-3)
    # what the page calls a double pole of 14.15 is a pair, 14.15 +- 14.13 i
    np.testing.assert_allclose(poles["robust"].real, 14.15, rtol=1e-3)
    np.testing.assert_allclose(np.abs(poles["robust"].imag), 14.13, rtol=1e-3)


def test_the_filter_of_twelve_states_settles_to_those_gains_at_hover():
    observer = Filter(tuning=TUNINGS["robust"])
    hover = np.array((SET_A.mass * SET_A.gravity, 0, 0, 0))
    for _ in range(2000):
        observer.predict(hover, 0.0)
        observer.correct(np.zeros(6))
    F = fsmc.jacobian(SET_A, np.zeros(12), hover, 0.0)
    P = F @ observer.P @ F.T + observer.Q
    K = np.linalg.solve(observer.H @ P @ observer.H.T + observer.R, observer.H @ P).T
    np.testing.assert_allclose(K[4:6, 2], fsmc.steady_gain(TUNINGS["robust"]), rtol=1e-4)


def test_the_first_two_seconds_of_scenario_d():
    run = simulate(Scenario(steps=2001))
    np.testing.assert_allclose(run.u[0], (12.324, -0.083398938, 0.49229172, 0.047889539), rtol=1e-7)
    for t in (0.5, 2.0):
        np.testing.assert_allclose(run.X[round(t / fsmc.DT)], D[t], rtol=0, atol=1e-7)
    assert np.max(np.abs(run.X - run.estimate)) <= 1e-9


@pytest.mark.slow
def test_scenario_d():
    run = simulate(Scenario(steps=10001, d=disturbances(10001)[0]))
    np.testing.assert_allclose(run.X[10000], D[10.0], rtol=0, atol=1e-7)
    assert not run.saturated.any() and not run.clipped.any() and run.diverged is None
    assert run.w.max() == pytest.approx(385.4, abs=0.05)
    np.testing.assert_allclose(np.abs(run.X[:, [0, 2]]).max(0), (0.1145, 0.1085), atol=5e-5)
    np.testing.assert_allclose(run.estimation(5, 10)[1::2], 1.218e-3, atol=1e-5)
    error = np.abs(run.X - run.reference)
    for state, near, since in ((4, 0.02, 1.54), (6, 0.05, 2.56), (10, 0.05, 4.84)):
        assert np.max(np.flatnonzero(error[:5000, state] >= near)) * fsmc.DT == pytest.approx(since, abs=0.011)
    np.testing.assert_allclose(run.chattering(2, 5), (0.0952, 2.0e-4, 1.8e-4, 1.1e-4), rtol=0.05)
    exact = simulate(Scenario(steps=5000, exact=True))
    assert np.max(np.abs(exact.tracking(0, 5) - run.tracking(0, 5))[4:]) < 4e-4


@pytest.mark.parametrize("told", [True, False])
def test_scenario_e_and_a_filter_that_is_told_another_input(told):
    """The companion: told the commanded input where it was clipped, it answers something else."""
    run = simulate(Scenario(steps=1001 if told else 101, estimate=tuple(WRONG), told=told))
    error = (run.X - run.estimate)[:, [6, 7, 10, 11]]
    if told:
        for t, expected in E.items():
            np.testing.assert_allclose(error[round(t / fsmc.DT)], expected, rtol=0, atol=1e-6)
    steps, applied = np.flatnonzero(run.saturated), np.abs(run.u - run.applied).max(axis=1)
    assert (len(steps) > 0) == bool(np.any(applied > 1e-9))


def test_what_was_applied_is_what_the_filter_has_to_be_told():
    """Far from where it is sent, rotors are clipped: section 13."""
    # a yaw of 3 rad asks for more torque than there is
    start = tuple(3.0 if k == 4 else 0.0 for k in range(12))
    told, untold = (simulate(Scenario(steps=300, X=start, estimate=start, told=item, gains=fsmc.Gains().scaled(8)))
                    for item in (True, False))  # fmt: skip
    assert told.saturated.any() and np.max(np.abs(told.X - told.estimate)) <= 1e-9
    assert np.max(np.abs(untold.X - untold.estimate)) > 1e-4


@pytest.mark.slow
@pytest.mark.parametrize(("tuning", "law"), [("robust", "SMC")])  # all of them: the compiled C
def test_scenario_c(tuning, law):
    d, _ = disturbances(10000, sine=0, constant=np.eye(6)[5] * 0.5)
    run = simulate(Scenario(tuning=tuning, law=law, d=d))
    z, vz, near = C[tuning, law]
    assert run.X[9999, 10] - 5 == pytest.approx(z, rel=near)
    assert run.X[9999, 11] - run.estimate[9999, 11] == pytest.approx(vz, rel=near)
    bias = fsmc.velocity_bias(TUNINGS[tuning], SET_A.a[11], 0.5)
    assert run.X[9999, 11] - run.estimate[9999, 11] == pytest.approx(bias, rel=1e-3)


def test_the_disturbances_are_within_the_bound_of_the_paper():
    d, v = disturbances(10000, seed=1)
    assert 0.35 < np.max(np.abs(d)) < 0.5  # the paper's bound is 1 (erratum 8)
    assert not np.any(d[:5000]) and not np.any(v[:5000]) and np.std(v[5000:]) == pytest.approx(0.01, rel=0.02)


def test_a_run_that_diverges_stops_and_says_when():
    run = simulate(Scenario(steps=200, X=tuple(float(item) for item in 999.9 * np.eye(12)[6] + 500 * np.eye(12)[7])))
    assert run.diverged == pytest.approx(0.001) and len(run.X) == 1


def test_the_two_misprints_that_change_the_loop_are_at_hand():
    literal = simulate(Scenario(steps=1500, literal=True))
    plain = simulate(Scenario(steps=1500))
    assert np.max(np.abs(literal.X - plain.X)) > 0.05  # erratum 5
    control = Controller(divided=True)
    u = control(np.array(ESTIMATE), trajectory(2.0))
    np.testing.assert_allclose(u[1:], 0.4 * Controller()(np.array(ESTIMATE), trajectory(2.0))[1:])  # erratum 6
    assert dataclasses.replace(Scenario(), printed_jacobian=True).printed_jacobian
