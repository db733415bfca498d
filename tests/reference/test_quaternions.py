"""Quaternions beside SciPy's rotations."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from plantc.reference import quaternions
from scipy.spatial.transform import Rotation

vectors = st.tuples(*[st.floats(-3, 3)] * 3).map(np.array)


def as_rotation(q: np.ndarray) -> Rotation:
    return Rotation.from_quat(np.roll(q, -1))  # SciPy puts the scalar last


@given(vectors)
def test_exponential_is_scipys(rotation):
    q = quaternions.exponential(rotation)
    assert np.isclose(q @ q, 1, atol=1e-12)
    np.testing.assert_allclose(as_rotation(q).as_matrix(), Rotation.from_rotvec(rotation).as_matrix(), atol=1e-10)


@given(vectors, vectors)
def test_product_composes(a, b):
    p, q = quaternions.exponential(a), quaternions.exponential(b)
    both = as_rotation(quaternions.product(p, q)).as_matrix()
    np.testing.assert_allclose(both, as_rotation(p).as_matrix() @ as_rotation(q).as_matrix(), atol=1e-12)
    np.testing.assert_allclose(quaternions.product(p, quaternions.conjugate(p)), [1, 0, 0, 0], atol=1e-12)


@given(vectors, vectors)
def test_cross_matrix(a, b):
    np.testing.assert_allclose(quaternions.cross_matrix(a) @ b, np.cross(a, b), atol=1e-12)


def test_exponential_at_zero_has_the_derivative_of_a_small_rotation():
    step = 1e-20
    q = quaternions.exponential(1j * step * np.eye(3))
    np.testing.assert_allclose(np.imag(q) / step, np.vstack([np.zeros(3), 0.5 * np.eye(3)]), atol=1e-12)


def test_renormalised_comes_nearer():
    q = 1.001 * quaternions.exponential(np.array([0.3, -0.2, 0.9]))
    assert abs(np.linalg.norm(quaternions.renormalised(q)) - 1) < 2e-6
