"""The jump matrix technique in NumPy: its own parts, beside what they are made of."""

import numpy as np
import pytest
from plantc.reference.jump_matrix import JumpMap, discrete_parts, online_gain

T = 0.01


def rates(x, u, p, w):
    """x1' = x2, x2' = -2 x1 - 0.1 x2 - x3 + u + w + p, x3 held."""
    zero = 0 * x[0]
    return (np.array([x[1], -2 * x[0] - 0.1 * x[1] - x[2] + u[0] + w[0] + p[0], zero]),)


def jump(x, u, p, w):
    return (np.array([x[0], x[1], x[0] ** 3]),)


def test_the_parts_are_found_by_the_complex_step():
    made = JumpMap(rates, jump, (3, 1, 1), np.array([5.0]), T)
    A = np.array([[0, 1, 0], [-2, -0.1, -1], [0, 0, 0]], dtype=float)
    Phi, Gam, Psi = discrete_parts(A, np.array([[0.0], [1], [0]]), np.array([[0.0], [1], [0]]), T)
    for ours, theirs in ((made.Phi, Phi), (made.Gam, Gam), (made.Psi, Psi)):
        np.testing.assert_allclose(ours, theirs, rtol=0, atol=1e-17)


def test_a_step_is_that_of_finely_integrated_rates():
    """With the nonlinearity held, by many steps of Euler's method extrapolated: the constant p drives like an input."""
    made = JumpMap(rates, jump, (3, 1, 1), np.zeros(1), T)
    x, u, p, w = np.array([1.5, -0.3, 2.0]), np.array([0.7]), np.array([-3.0]), np.array([0.2])

    def euler(count):
        value = x.copy()
        for _ in range(count):
            value = value + T / count * rates(value, u, p, w)[0]
        return value

    fine = 2 * euler(4000) - euler(2000)
    expected = jump(fine, u, p, w)[0]
    np.testing.assert_allclose(made(x, u, p, w)[0], expected, rtol=1e-9)
    columns = made(np.stack([x, 2 * x], axis=1), u, p, w)[0]
    np.testing.assert_allclose(columns[:, 0], made(x, u, p, w)[0], rtol=1e-14)
    driven = made.driven([1])(x, np.array([0.7, 9.0, 0.2]), p, np.zeros(0))[0]
    np.testing.assert_allclose(driven, made(x, u, p, w)[0], rtol=1e-14)


def test_the_online_gain_never_divides_by_nothing():
    """Section 4: one for what is not held, even where the difference is zero; zero where a held one does not differ."""
    before, after = np.array([1.0, 2.0, 3.0]), np.array([1.0, 5.0, 7.0])
    same = online_gain((2,), before, after, np.array([1.0, 2.0, 3.0]), np.array([1.0, 2.0, 6.0]))
    assert np.diag(same).tolist() == [1, 1, 0]
    apart = online_gain((2,), before, after, np.array([0.0, 0.0, 1.0]), np.array([0.0, 0.0, 6.0]))
    assert np.diag(apart).tolist() == [1, 1, 0.5]
    near = online_gain((2,), before, after, np.array([0, 0, 3.0 + 0.9e-12]), np.array([0.0, 0.0, 6.0]))
    assert near[2, 2] == 0.0
    beyond = online_gain((2,), before, after, np.array([0, 0, 3.0 + 1.1e-12]), np.array([0.0, 0.0, 6.0]))
    assert beyond[2, 2] == pytest.approx(-1 / 1.1e-12, rel=1e-3)
