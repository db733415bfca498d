"""Unit quaternions (w, x, y, z), body to world, as NumPy arrays of shape (4,) or (4, k); complex numbers allowed.

Conventions: Hamilton product, as in J. Sola, "Quaternion kinematics for the error-state Kalman filter",
arXiv:1711.02508, ch. 1.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

TINY_SQUARE = 1.0e-20
"""Added to a squared angle before its root: keeps sin(a/2)/a defined at zero, changes no digit elsewhere."""


def product(p: Array, q: Array) -> Array:
    """Return the Hamilton product p q (Sola, eq. 12)."""
    return np.stack(
        [
            p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
            p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
            p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
            p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0],
        ]
    )


def conjugate(q: Array) -> Array:
    """Return the inverse of a unit quaternion."""
    return np.stack([q[0], -q[1], -q[2], -q[3]])


def exponential(rotation: Array) -> Array:
    """Return the quaternion of a rotation vector (3,) or (3, k), in rad (Sola, eq. 101)."""
    angle = np.sqrt(_square(rotation) + TINY_SQUARE)
    sine = np.sin(0.5 * angle) / angle
    return np.stack([np.cos(0.5 * angle), sine * rotation[0], sine * rotation[1], sine * rotation[2]])


def small_rotation(q: Array) -> Array:
    """Return the rotation vector of a quaternion near (1, 0, 0, 0), to first order: twice its vector part."""
    return 2 * q[1:4]


def renormalised(q: Array) -> Array:
    """Return q, already near unit length, after one Newton step towards it."""
    return (1.5 - 0.5 * _square(q)) * q


def cross_matrix(a: Array) -> Array:
    """Return [a]x, for which [a]x b = a x b."""
    zero = np.zeros_like(a[0])
    return np.array([[zero, -a[2], a[1]], [a[2], zero, -a[0]], [-a[1], a[0], zero]])


def _square(a: Array) -> Array:
    # a sum without conjugation: it has to stay an analytic function for the complex step
    return np.asarray(np.sum(a * a, axis=0))
