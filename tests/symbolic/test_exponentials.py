"""The exact step: beside mpmath, to the last bit."""

import mpmath
import numpy as np
import pytest
from plantc.symbolic.exponentials import held_exponential
from scipy.linalg import expm


def rounded(A, drive, dt):
    """Return the same by mpmath in 60 digits, rounded once."""
    n, m = len(A), drive.shape[1]
    with mpmath.workdps(60):
        block = mpmath.zeros(n + m)
        for i in range(n):
            for j in range(n):
                block[i, j] = mpmath.mpf(float(A[i, j])) * mpmath.mpf(dt)
            for j in range(m):
                block[i, n + j] = mpmath.mpf(float(drive[i, j])) * mpmath.mpf(dt)
        power = mpmath.expm(block, method="taylor")
        return np.array([[float(power[i, j]) for j in range(n + m)] for i in range(n)])


@pytest.mark.parametrize("scale", [0.01, 1.0, 30.0])
def test_every_element_is_rounded_once(scale):
    rng = np.random.default_rng(1)
    A, drive = rng.normal(size=(4, 4)) * scale, rng.normal(size=(4, 2))
    A[2] = 0.0
    Phi, driven = held_exponential(A, drive, 0.1)
    assert np.hstack([Phi, driven]).tolist() == rounded(A, drive, 0.1).tolist()
    assert Phi[2].tolist() == [0, 0, 1, 0]
    # what LAPACK gives is near, and not the same: the companion
    other = expm(A * 0.1)
    np.testing.assert_allclose(Phi, other, rtol=1e-9, atol=1e-13 * np.max(np.abs(other)))
    assert Phi.tolist() != other.tolist()


def test_a_chain_of_integrators_is_exact():
    """dt^2/2 and dt^3/6 beside 1: no digit is lost to the largest element, and no element appears that is none."""
    A = np.diag([1.0, 1.0], 1)
    Phi, driven = held_exponential(A, np.array([[0.0], [0.0], [1.0]]), 2.0**-20)
    h = 2.0**-20
    assert Phi.tolist() == [[1, h, h * h / 2], [0, 1, h], [0, 0, 1]]
    assert driven.ravel().tolist() == [pytest.approx(h**3 / 6, rel=1e-16), h * h / 2, h]


def test_nothing_driven_and_beyond_all_numbers():
    Phi, driven = held_exponential(np.array([[1.0]]), np.zeros((1, 0)), 1000.0)
    assert np.isinf(Phi[0, 0])
    assert driven.shape == (1, 0)
