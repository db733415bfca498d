"""Attitude and gyroscope bias from an inertial sensor: an error-state Kalman filter, run on a real log.

World axes: magnetic north, east, down. Body axes: forward, right, down. The caller gives the initial attitude and the
magnetic field in world axes as parameters (`initial_parameters` computes them from the first sample), and the
magnetometer's reading scaled to unit length, only when the sensor had a new sample.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from plantc.symbolic import Plant, sqrt, vertcat
from plantc.symbolic.estimators import extended_kalman_filter

GRAVITY = 9.80665

imu = Plant("attitude", doc="attitude of a body that moves little, with the bias of its gyroscope")
q = imu.attitude("q", doc="attitude, body to world (w, x, y, z)")
bias = imu.state("bias", size=3, unit="rad/s", range=(-1, 1), doc="bias of the gyroscope")
gyro = imu.input("gyro", size=3, unit="rad/s", range=(-40, 40), doc="angular velocity as the gyroscope measures it")
north = imu.parameter("field_north", 0.5, range=(0, 1), doc="magnetic field, unit length: horizontal part")
down = imu.parameter("field_down", 0.8, range=(-1, 1), doc="magnetic field, unit length: part pointing down")
gyro_noise = imu.noise("gyro_noise", size=3, density=9.5e-4**2, unit="rad/s", doc="noise of the gyroscope")
bias_walk = imu.noise("bias_walk", size=3, density=1e-5**2, unit="rad/s^2", doc="drift of the bias")

imu.dynamics({q: gyro - bias + gyro_noise, bias: bias_walk})
imu.sensor(
    "accelerometer",
    q.to_body([0, 0, -GRAVITY]),
    # a reading that is not gravity alone is trusted less
    variance=lambda a: 0.5**2 + (2 * (sqrt(a[0] ** 2 + a[1] ** 2 + a[2] ** 2) - GRAVITY)) ** 2,
    unit="m/s^2",
    range=(-200, 200),
    doc="specific force",
)
imu.sensor(
    "magnetometer",
    q.to_body(vertcat(north, 0, down)),
    variance=0.05**2,
    range=(-2, 2),
    doc="field, scaled to unit length",
)

attitude_ekf = extended_kalman_filter(
    imu.discretise("euler", dt=(1e-4, 0.1)),
    initial_variance={q: 0.04, bias: 1e-4},
    variance_ceiling={bias: 1.0},
    name="attitude_ekf",
)


def initial_parameters(accelerometer: Any, magnetometer: Any) -> dict[str, Any]:
    """Return the initial attitude and the field's direction from one sample at rest.

    Parameters
    ----------
    accelerometer : array (3,)
        Specific force in body axes, m/s^2.
    magnetometer : array (3,)
        Magnetic field in body axes, any unit.

    Returns
    -------
    dict
        Parameters ``q_0``, ``field_north``, ``field_down`` of `attitude_ekf`.
    """
    a = np.asarray(accelerometer, dtype=float)
    m = np.asarray(magnetometer, dtype=float)
    m = m / np.linalg.norm(m)
    roll = np.arctan2(-a[1], -a[2])
    pitch = np.arctan2(a[0], np.hypot(a[1], a[2]))
    level = _turn_y(pitch) @ _turn_x(roll) @ m
    yaw = -np.arctan2(level[1], level[0])
    halves = np.array([yaw, pitch, roll]) / 2
    (cy, cp, cr), (sy, sp, sr) = np.cos(halves), np.sin(halves)
    attitude = [
        cy * cp * cr + sy * sp * sr,
        cy * cp * sr - sy * sp * cr,
        cy * sp * cr + sy * cp * sr,
        sy * cp * cr - cy * sp * sr,
    ]
    return {"q_0": attitude, "field_north": float(np.hypot(level[0], level[1])), "field_down": float(level[2])}


def _turn_x(angle: float) -> Any:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[1, 0, 0], [0, c, -s], [0, s, c]])


def _turn_y(angle: float) -> Any:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
