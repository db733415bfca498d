"""Designed gains: the published quadrotor, peers (SciPy, python-control), and what cannot be designed is a sentence."""

import control
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from plantc.examples.quadrotor_controllers import printed_gain
from plantc.examples.quadrotor_ekf import sampled, set_point
from scipy.signal import place_poles

from plantc import ModelError, ackermann, linearise, lqr, place, place_chains

POLES = np.arange(84, 96) / 100  # meda2018, section 4
DT = 0.025
MIX = [[1, 1, 1, 1], [-1, -1, 1, 1], [-1, 1, 1, -1], [1, -1, 1, -1]]
CHAINS = {
    "thrust": (["z", "vz"], [0.86, 0.93]),
    "roll": (["y", "vy", "roll", "roll_rate"], [0.85, 0.87, 0.91, 0.94]),
    "pitch": (["x", "vx", "pitch", "pitch_rate"], [0.84, 0.88, 0.92, 0.95]),
    "yaw": (["yaw", "yaw_rate"], [0.89, 0.90]),
}
F44 = printed_gain.T  # 12 x 4, as eq. 44 prints it
U1 = [
    -7.333508790, -8.632150971, 10.054928067, 10.592050293, 170.001173807, 91.072057397, -39.167489827, -6.293729681,
    -34.893608277, -6.000998068, 133.509901438, 63.720634777,
]  # fmt: skip


@pytest.fixture(scope="module")
def hover():
    return linearise(sampled, {getattr(key, "signal", key).name: value for key, value in set_point.items()})


# -- the published quadrotor ------------------------------------------------------------------------------------------


def test_the_printed_gain_has_the_eigenvalues_of_the_spec(hover):
    assert np.linalg.norm(F44) == pytest.approx(1921.778778, abs=5e-7)
    values = np.linalg.eigvals(hover.A - hover.B @ F44.T)
    pairs = [0.980366 + 0.008131j, 0.940244 + 0.090338j, 0.905754 + 0.084572j, 0.774806 + 0.042048j]
    expected = np.array([*pairs, *np.conj(pairs), 0.905837, 0.894680, 0.874618, 0.860941])
    gaps = np.abs(np.sort_complex(values) - np.sort_complex(expected))
    assert np.max(gaps) < 2e-6, gaps
    assert np.max(np.abs(values)) == pytest.approx(0.9804001439, abs=1e-9)
    far = np.abs(np.sort(values.real) - POLES)
    assert np.max(far) > 0.03  # so it does not place the poles that it is printed for (erratum E15)


@pytest.mark.parametrize("method", ["YT", "KNV0"])
def test_robust_placement_of_the_quadrotor(hover, method):
    gain = place(hover, POLES, method=method)
    assert np.max(np.abs(gain.eigenvalues - POLES)) < 1e-9
    values = np.sort(np.linalg.eigvals(hover.A - hover.B @ gain.gain).real)
    assert np.max(np.abs(values - POLES)) < 1e-9
    assert gain.condition <= 1500
    if method == "YT":  # the value of the spec
        assert gain.condition == pytest.approx(949.494, abs=0.01)
    assert gain.dt == DT


def test_the_decoupled_gain_of_the_quadrotor(hover):
    gain = place_chains(hover, CHAINS, mix=MIX)
    assert np.max(np.abs(np.sort(gain.eigenvalues.real) - POLES)) < 1e-12
    assert np.linalg.norm(gain.gain) == pytest.approx(498.9933806, abs=5e-8)
    u1, u2, u3, u4 = gain.gain
    np.testing.assert_allclose(u1, U1, rtol=0, atol=2e-9)
    flip = np.ones(12)
    flip[[0, 1, 8, 9, 10, 11]] = -1
    other = np.ones(12)
    other[[0, 1, 2, 3, 6, 7, 8, 9]] = -1
    np.testing.assert_allclose(u2, u1 * flip, rtol=1e-12)
    np.testing.assert_allclose(u3, u1 * other, rtol=1e-12)
    np.testing.assert_allclose(u4, u2 * other, rtol=1e-12)


# -- peers ------------------------------------------------------------------------------------------------------------


@st.composite
def pairs(draw):
    """A controllable pair (A, b), away from those that are not, and stable poles that are apart."""
    n = draw(st.integers(1, 5))
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    A = rng.normal(size=(n, n)) - 0.5 * np.eye(n)
    b = rng.normal(size=(n, 1))
    poles = -0.5 - 0.4 * np.arange(n) - 0.2 * rng.uniform(size=n)
    if n >= 2 and draw(st.booleans()):
        poles = np.array([*poles[2:], poles[0] + 0.7j, poles[0] - 0.7j])
    return A, b, poles


@given(pairs())
def test_ackermann_is_the_placement_of_one_input(pair):
    A, b, poles = pair
    if np.linalg.cond(control.ctrb(A, b)) > 1e6:
        return
    gain = ackermann((A, b), poles)
    # the characteristic polynomial is that of the poles
    np.testing.assert_allclose(np.poly(A - b @ gain.gain), np.real(np.poly(poles)), rtol=1e-6, atol=1e-6)
    if len(A) > 1:
        expected = place_poles(A, b, poles).gain_matrix
        np.testing.assert_allclose(gain.gain, expected, rtol=1e-5, atol=1e-6 * np.max(np.abs(expected)))


@given(st.lists(st.floats(-3, 3), min_size=1, max_size=5), st.integers(0, 99))
def test_ackermann_of_a_companion_form_is_a_difference_of_coefficients(coefficients, seed):
    n = len(coefficients)
    A = np.zeros((n, n))
    A[:-1, 1:] = np.eye(n - 1)
    A[-1] = -np.array(coefficients)
    poles = -np.random.default_rng(seed).uniform(0.3, 2.0, n)
    expected = np.poly(poles)[:0:-1] - coefficients
    gain = ackermann((A, np.eye(n)[:, -1:]), poles)
    np.testing.assert_allclose(gain.gain[0], expected, rtol=1e-9, atol=1e-9)


def test_ackermann_places_a_pole_many_times():
    A = np.eye(4) + np.diag([0.1] * 3, 1)
    b = np.array([[0.0], [0.0], [0.0], [0.1]])
    gain = ackermann((A, b, 0.1), np.zeros(4))  # deadbeat
    assert np.max(np.abs(np.linalg.matrix_power(A - b @ gain.gain, 4))) < 1e-9
    control_says = control.acker(A, b, np.zeros(4))
    np.testing.assert_allclose(gain.gain[0], np.ravel(control_says), rtol=1e-8)


@pytest.mark.parametrize("dt", [None, 0.05])
@pytest.mark.parametrize("cross", [False, True])
def test_lqr_is_that_of_python_control(dt, cross):
    rng = np.random.default_rng(3)
    A, B = rng.normal(size=(5, 5)), rng.normal(size=(5, 2))
    if dt is not None:
        A = np.eye(5) + dt * A
        B = dt * B
    root = rng.normal(size=(7, 7))
    weight = root @ root.T
    Q, R, N = weight[:5, :5], weight[5:, 5:], weight[:5, 5:] if cross else np.zeros((5, 2))
    gain = lqr((A, B) if dt is None else (A, B, dt), Q, R, N=N if cross else None)
    K, S, E = (control.lqr if dt is None else control.dlqr)(A, B, Q, R, N)
    np.testing.assert_allclose(gain.gain, K, rtol=1e-8, atol=1e-10)
    np.testing.assert_allclose(gain.solution, S, rtol=1e-8, atol=1e-10)
    np.testing.assert_allclose(np.sort_complex(gain.eigenvalues), np.sort_complex(E), rtol=1e-7)
    assert all(value <= limit for value, limit in gain.properties().values())


def test_weights_by_name_of_a_linearisation(hover):
    named = lqr(hover, Q={"x": 1, "y": 1, "z": 2, "yaw": 3}, R={"rotor_1": 1, "rotor_2": 1, "rotor_3": 1, "rotor_4": 1})
    plain = lqr(hover.to_state_space(), Q=[1, 0, 1, 0, 2, 0, 0, 0, 0, 0, 3, 0], R=1)
    np.testing.assert_array_equal(named.gain, plain.gain)
    assert named.source() == plain.source()


# -- what is recorded -------------------------------------------------------------------------------------------------


def test_a_wrong_gain_is_seen(hover):
    for gain in (place(hover, POLES), lqr(hover, Q=np.ones(12), R=1e-4), place_chains(hover, CHAINS, mix=MIX)):
        good = gain.properties()
        assert all(value <= limit for value, limit in good.values()), good
        for factor in (1.01, 0.99):
            wrong = gain.properties(gain.gain * factor)
            assert any(value > limit for value, limit in wrong.values()), wrong


def test_the_source_tells_questions_apart_and_no_last_bit(hover):
    gain = place(hover, POLES)
    assert gain.source() != place(hover, POLES - 0.01).source()
    assert gain.source() != place(hover, POLES, method="KNV0").source()
    A, B = np.array([[1.0, 1 / 1024], [0, 1]]), np.array([[0.0], [1 / 1024]])
    near = A * (1 + 2e-16), B * (1 - 1e-16)
    assert ackermann((A, B, 1 / 1024), [0.9, 0.8]).source() == ackermann((*near, 1 / 1024), [0.9, 0.8]).source()
    assert ackermann((A, B, 1 / 1024), [0.9, 0.8]).source() != ackermann((A, B * 1.001, 1 / 1024), [0.9, 0.8]).source()


# -- sentences --------------------------------------------------------------------------------------------------------

DOUBLE = (np.array([[0.0, 1.0], [0.0, 0.0]]), np.array([[0.0], [1.0]]))
STUCK = (np.diag([0.5, 0.7, 1.2]), np.array([[1.0], [1.0], [0.0]]), 0.1)
TWICE = (np.zeros((3, 3)), np.eye(3)[:, :2] + 0.0)
WIDE = (np.diag([0.5, 0.7, 1.2]), np.eye(3)[:, :2], 0.1)


@pytest.mark.parametrize("design", [place, ackermann])
@pytest.mark.parametrize(
    ("system", "poles", "says"),
    [
        (DOUBLE, [-1], r"1 pole\(s\) are given for 2 states; give one for each"),
        (DOUBLE, [-1, -2, -3], r"3 pole\(s\) are given for 2 states"),
        (DOUBLE, [-1 + 1j, -2], r"the pole -1\+1j has no conjugate among those given"),
        (DOUBLE, [-1 + 1j, -1 + 1j], r"the pole -1\+1j has no conjugate among those given"),
        (DOUBLE, [-1, np.nan], "are not all finite"),
        (DOUBLE, [0.8, -2], r"the pole\(s\) 0.8 are not left of the imaginary axis, and the plant is continuous"),
        ((*DOUBLE, 0.1), [-1, 0.2], r"the pole\(s\) -1 are not inside the unit circle, and the plant is discrete"),
        (STUCK, [0.1, 0.2, 0.3], r"do not move the mode\(s\) at z = 1.2 \(rank 2 of 3\), whose poles cannot be placed"),
        (STUCK, [0.1, 0.2, 0.999], r"do not move the mode\(s\) at z = 1.2"),
        ((np.eye(2), np.zeros((2, 1))), [-1, -2], r"do not move the mode\(s\) at s = 1, 1 \(rank 0 of 2\)"),
        (DOUBLE, "fast", "the poles are 'fast'; give 2 numbers"),
        ("cart", [-1, -2], "a design is for a linearisation, and str is given"),
        ((np.eye(2), np.ones((3, 1))), [-1, -2], r"A has shape \(2, 2\) and B \(3, 1\)"),
        ((np.full((2, 2), np.inf), np.ones((2, 1))), [-1, -2], "A or B holds what is no finite number"),
    ],
)
def test_what_cannot_be_placed(design, system, poles, says):
    with pytest.raises(ModelError, match=says):
        design(system, poles)


def test_what_robust_placement_cannot_do():
    with pytest.raises(ModelError, match=r"the pole -1 is asked for 2 times, and 1 independent input\(s\)"):
        place(DOUBLE, [-1, -1])
    three = (np.diag([1.0] * 3, 1), np.eye(4)[:, [1, 3]])
    with pytest.raises(ModelError, match=r"the pole -1 is asked for 3 times, and 2 independent input\(s\) place"):
        place(three, [-1, -1, -1, -2])
    assert np.max(np.abs(place(three, [-1, -1, -2, -2]).eigenvalues - [-1, -1, -2, -2])) < 1e-6
    doubled = (three[0], three[1] @ [[1.0, 2.0, 1.0], [0.0, 0.0, 1.0]])  # three inputs, two of them alike
    assert np.max(np.abs(place(doubled, [-1, -1, -2, -2]).eigenvalues - [-1, -1, -2, -2])) < 1e-6
    with pytest.raises(ModelError, match=r"KNV0 places real poles, and -1\+1j, -1-1j are given"):
        place(DOUBLE, [-1 + 1j, -1 - 1j], method="KNV0")
    with pytest.raises(ModelError, match="the method is 'fast'; give 'YT' or 'KNV0'"):
        place(DOUBLE, [-1, -2], method="fast")
    with pytest.raises(ModelError, match="ackermann is for one input, and there are 2"):
        ackermann(TWICE, [-1, -2, -3])


def test_a_placement_that_failed_is_not_handed_out(hover, monkeypatch):
    from plantc.symbolic import design

    exact = design._ackermann
    monkeypatch.setattr(design, "_ackermann", lambda *arguments: 1.001 * exact(*arguments))
    with pytest.raises(ModelError, match=r"the poles -1, -2 came out as .* too far off"):
        ackermann(DOUBLE, [-1, -2])
    with pytest.raises(ModelError, match=r"chain 'thrust': the poles 0.86, 0.93 came out as"):
        place_chains(hover, CHAINS, mix=MIX)


@pytest.mark.parametrize(
    ("change", "mix", "says"),
    [
        ({"yaw": (["yaw"], [0.9])}, MIX, "yaw_rate are in no chain"),
        ({"yaw": (["yaw", "vz"], [0.9, 0.8])}, MIX, "the state 'vz' of the chain 'yaw' is also in 'thrust'"),
        ({"yaw": (["yaw", "heading"], [0.9, 0.8])}, MIX, "the state 'heading' of the chain 'yaw' is no state"),
        ({"yaw": (["yaw", "yaw_rate"], [0.9])}, MIX, r"chain 'yaw': 1 pole\(s\) are given for 2 states"),
        ({"yaw": (["yaw", "yaw_rate"], [0.9, 1.1])}, MIX, r"the pole\(s\) 1.1 are not inside the unit circle"),
        ({}, None, r"the chain 'thrust' moves the chain 'roll' by its virtual input"),
        ({}, MIX[:3], r"mix has shape \(3, 4\) and rank 3 for 4 chains and 4 inputs"),
        ({}, [*MIX[:3], MIX[0]], "and rank 3 for 4 chains"),
        (
            {"roll": (["y", "vy"], [0.9, 0.8]), "thrust": (["z", "vz", "roll", "roll_rate"], [0.9, 0.8, 0.7, 0.6])},
            MIX,
            "the chain 'thrust' moves the chain 'roll' by its states",
        ),
    ],
)
def test_chains_that_are_none(hover, change, mix, says):
    with pytest.raises(ModelError, match=says):
        place_chains(hover, {**CHAINS, **change}, mix=mix)


@pytest.mark.parametrize(
    ("system", "weights", "says"),
    [
        (DOUBLE, ([1, 1], 0), r"R is not positive definite \(smallest eigenvalue 0\)"),
        (DOUBLE, ([1, -1], 1), r"Q is not positive semidefinite \(smallest eigenvalue -1\)"),
        (DOUBLE, ([1, 1, 1], 1), r"Q has shape \(3,\); give 2 numbers, or 2 x 2"),
        (DOUBLE, ([[1, 1], [0, 1]], 1), "Q is not a symmetric matrix"),
        (DOUBLE, ({"x7": 1}, 1), "Q names x7; there is x0, x1"),
        (DOUBLE, ("heavy", 1), "Q is 'heavy'; give numbers"),
        (DOUBLE, ([0, 1], 1), r"the cost does not see the mode\(s\) at s = 0, which neither grow nor decay"),
        (
            STUCK,
            ([1, 1, 1], 1),
            r"do not move the mode\(s\) at z = 1.2, which do not decay, so that no gain stabilises",
        ),
    ],
)
def test_what_lqr_cannot_do(system, weights, says):
    with pytest.raises(ModelError, match=says):
        lqr(system, *weights)


def test_lqr_leaves_a_stable_mode_that_nothing_moves():
    gain = lqr((np.diag([0.5, 1.2]), np.array([[0.0], [1.0]]), 0.1), Q=[1, 1], R=1)
    assert np.min(np.abs(gain.eigenvalues - 0.5)) < 1e-12
    assert np.max(np.abs(gain.eigenvalues)) < 1


def test_a_state_space_without_a_time_step():
    with pytest.raises(ModelError, match="has no numeric time step; give it one"):
        place(control.ss(*DOUBLE, np.eye(2), 0, True), [0.1, 0.2])
