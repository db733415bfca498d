"""Unit quaternions (w, x, y, z), body to world, and small rotations, as CasADi expressions."""

from __future__ import annotations

import casadi as ca

TINY_SQUARE = 1.0e-20
"""Added to a squared angle before its root: keeps sin(a/2)/a defined at zero, changes no digit elsewhere."""


def product(p: ca.SX, q: ca.SX) -> ca.SX:
    """Return the Hamilton product p q of two quaternions, each (4,)."""
    return ca.vertcat(
        p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
        p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
        p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
        p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0],
    )


def conjugate(q: ca.SX) -> ca.SX:
    """Return the inverse of a unit quaternion."""
    return ca.vertcat(q[0], -q[1], -q[2], -q[3])


def exponential(rotation: ca.SX) -> ca.SX:
    """Return the quaternion of a rotation vector (3,), in rad."""
    angle = ca.sqrt(ca.dot(rotation, rotation) + TINY_SQUARE)
    return ca.vertcat(ca.cos(0.5 * angle), (ca.sin(0.5 * angle) / angle) * rotation)


def first_order(rotation: ca.SX) -> ca.SX:
    """Return the quaternion (1, rotation / 2), whose derivative at zero is that of the exponential."""
    return ca.vertcat(1, 0.5 * rotation)


def rotation_of(q: ca.SX) -> ca.SX:
    """Return the rotation vector of a quaternion near (1, 0, 0, 0), to first order."""
    return 2 * q[1:4]


def renormalised(q: ca.SX) -> ca.SX:
    """Return q scaled to unit length by one Newton step: no root, no division; for |q| already near 1."""
    return (1.5 - 0.5 * ca.dot(q, q)) * q


def matrix(q: ca.SX) -> ca.SX:
    """Return the rotation matrix (3, 3) from body to world of a unit quaternion."""
    w, x, y, z = q[0], q[1], q[2], q[3]
    return ca.vertcat(
        ca.horzcat(1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
        ca.horzcat(2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
        ca.horzcat(2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
    )
