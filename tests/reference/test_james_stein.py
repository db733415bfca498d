"""The James-Stein estimator as NumPy: the numbers of specs/meda2018.md, section 10.1, and what has to hold for any."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from plantc.reference.james_stein import effective_dimension, james_stein, shrink_constant, weight

PI = np.diag([1, 1.1, 1.2, 1.3, 1.4]) + 0.1 * np.tril(np.ones((5, 5)), -1)
Y = np.array([0.5, -1, 1.5, -2, 2.5])
PREDICTION = np.array([0.1, -0.2, 0.3, -0.4])
ROWS, COLUMNS = np.mgrid[1:6, 1:5]
C1 = np.eye(5, 4) + 0.2 * np.cos(ROWS * COLUMNS)
C1[4] += [0.5, -0.5, 0.5, -0.5]
C2 = np.cos(ROWS * COLUMNS)
MOST_LIKELY = [0.3975914208, -1.366678168, 2.437617649, -2.557235041]
AT = {
    0.3: (0.9831338865, [0.3925722102, -1.347000842, 2.401564347, -2.52085087],
          0.5640764304, [0.2678643064, -0.8580956564, 1.505779733, -1.616845441]),
    1.0: (0.8125987389, [0.3418224133, -1.148041208, 2.037025406, -2.152966474],
          0.7729678308, [0.330028595, -1.101804693, 1.952309677, -2.06747329]),
    3.0: (0.0, PREDICTION, 0.0, PREDICTION),
}  # fmt: skip
DIGITS = {"rtol": 2e-9, "atol": 1e-10}


@pytest.mark.parametrize("r", AT)
def test_the_core_of_section_10_1a(r):
    plain = james_stein(PREDICTION, Y, C1, PI, r)
    modified = james_stein(PREDICTION, Y, C1, PI, r, 0.05)
    np.testing.assert_allclose(plain.most_likely, MOST_LIKELY, **DIGITS)
    assert plain.effective_dimension == pytest.approx(2.567140061, rel=1e-9)
    c = shrink_constant(4, plain.effective_dimension)
    assert c / plain.distance_squared == pytest.approx(0.1874012611, rel=1e-9)
    assert c == 2 * (plain.effective_dimension - 2) < 2
    expected, state, expected_modified, state_modified = AT[r]
    np.testing.assert_allclose([plain.weight, modified.weight], [expected, expected_modified], **DIGITS)
    np.testing.assert_allclose(plain.state, state, **DIGITS)
    np.testing.assert_allclose(modified.state, state_modified, **DIGITS)


def test_an_r_that_is_no_number_weighs_nothing():
    assert np.isnan(weight(np.float64(2.0), np.nan, 1.0))
    assert np.isnan(weight(np.float64(2.0), np.nan, 1.0, 0.1))
    assert weight(np.float64(2.0), np.nan, 0.0) == 1  # no shrinkage: r is not asked


@pytest.mark.parametrize("r", [0.0, 0.3, 1.0, 30.0])
def test_an_effective_dimension_below_two_shrinks_nothing(r):
    made = james_stein(PREDICTION, Y, C2, PI, r)
    assert made.effective_dimension == pytest.approx(1.666584992, rel=1e-9)
    assert made.weight == 1
    np.testing.assert_allclose(made.state, [-0.08692736751, -0.8876645601, -1.242991973, 1.416238218], **DIGITS)


def test_twelve_states_measured_directly():
    made = james_stein(np.zeros(12), np.sin(np.arange(1, 13)), np.eye(12), np.eye(12), 0.5)
    assert made.effective_dimension == pytest.approx(12, rel=1e-14)
    assert shrink_constant(12, 12.0) / made.distance_squared == pytest.approx(1.589996621, rel=1e-9)
    assert made.weight == pytest.approx(0.6025008448, rel=1e-9)
    assert np.linalg.norm(made.state) == pytest.approx(1.510982935, rel=1e-9)


def test_the_risk_at_a_perfect_prediction():
    """Section 10.1(b): 1e5 draws, within 2 %."""
    noise = 0.3 * np.random.default_rng(1).normal(size=(100_000, 12))
    zero = np.zeros_like(noise)

    def risk(**options):
        made = james_stein(zero, noise, np.eye(12), np.eye(12), 0.3, **options)
        return np.mean(np.sum(made.state**2, axis=1)) / 0.3**2, np.mean(made.weight)

    assert risk(positive_part=False)[0] == pytest.approx(2, rel=0.02)
    with_it, mean_weight = risk()
    assert with_it == pytest.approx(1.23192131, rel=0.02)
    assert mean_weight == pytest.approx(0.1754673698, rel=0.02)
    assert np.mean(np.sum(noise**2, axis=1)) / 0.3**2 == pytest.approx(12, rel=0.02)


def orthogonal(seed, n):
    return np.linalg.qr(np.random.default_rng(seed).normal(size=(n, n)))[0]


@given(st.integers(0, 10**6), st.integers(1, 8), st.floats(0.01, 10), st.floats(0.1, 10))
def test_an_orthogonal_reading_turned_back_gives_the_same(seed, n, r, a):
    rng = np.random.default_rng(seed)
    C, prediction, y = orthogonal(seed, n), rng.normal(size=n), rng.normal(size=n)
    first = james_stein(prediction, y, C, np.eye(n), r)
    second = james_stein(prediction, C.T @ y, np.eye(n), np.eye(n), r)
    np.testing.assert_allclose(first.state, second.state, rtol=1e-10, atol=1e-10)
    # (r, Pi) -> (r / a, a Pi) is the same noise
    scaled = james_stein(prediction, y, C, a * np.eye(n), r / a)
    np.testing.assert_allclose(scaled.state, first.state, rtol=1e-9, atol=1e-9)


@given(st.integers(0, 10**6), st.floats(0, 5), st.floats(0, 2))
def test_the_estimate_lies_between_the_prediction_and_the_reading(seed, r, gamma):
    rng = np.random.default_rng(seed)
    m = int(rng.integers(3, 7))
    n = int(rng.integers(1, m + 1))
    C, Pi = rng.normal(size=(m, n)), np.eye(m) + 0.3 * rng.normal(size=(m, m))
    plain = james_stein(rng.normal(size=n), rng.normal(size=m), C, Pi, r)
    modified = james_stein(np.zeros(n), rng.normal(size=m), C, Pi, r, gamma)
    assert 1 <= plain.effective_dimension <= n + 1e-9
    assert 0 <= plain.weight <= 1
    assert 0 <= modified.weight <= 1
    if n <= 2 or plain.effective_dimension <= 2:
        assert plain.weight == 1


def test_the_modified_form_breaks_the_invariance_of_scale():
    """Erratum E9: gamma carries the unit of r^2."""
    one = james_stein(PREDICTION, Y, C1, PI, 0.3, 0.05)
    same_noise = james_stein(PREDICTION, Y, C1, 0.5 * PI, 0.6, 0.05)
    assert abs(one.weight - same_noise.weight) > 0.1
    assert same_noise.effective_dimension == pytest.approx(one.effective_dimension)


@pytest.mark.parametrize(
    ("D2", "r", "c", "gamma", "expected"),
    [
        (0.0, 0.3, 5.0, None, 0.0),  # the reading is where the prediction is
        (0.0, 0.0, 5.0, None, 1.0),
        (2.0, 0.0, 5.0, None, 1.0),
        (2.0, 0.0, 5.0, 0.1, 0.0),  # the limit of exp(-gamma / r^2)
        (2.0, 0.0, 5.0, 0.0, 1.0),
        (2.0, 1e-160, 5.0, 0.1, 0.0),
        (2.0, 0.3, 0.0, None, 1.0),
        (0.0, 0.3, 0.0, 0.09, np.exp(-1)),
        (2.0, 0.01, 0.0, 0.15, 0.0),  # exp(-1500): underflows cleanly
    ],
)
def test_edges_of_the_weight(D2, r, c, gamma, expected):
    assert float(weight(np.array(D2), r, c, gamma)) == pytest.approx(expected, rel=1e-15)


def test_a_rank_that_is_too_low_is_refused():
    with pytest.raises(ValueError, match="rank 1 and n is 2"):
        james_stein(np.zeros(2), np.zeros(2), np.ones((2, 2)), np.eye(2), 1.0)


def test_a_wrong_power_in_the_effective_dimension_would_be_seen():
    """n* of the inverse, not of I_y itself: the numbers tell them apart."""
    singular = np.linalg.svd(np.linalg.solve(PI, C1), compute_uv=False)
    wrong = np.sum(singular**2) / np.max(singular**2)
    assert abs(wrong - effective_dimension(C1, PI)) > 0.1
