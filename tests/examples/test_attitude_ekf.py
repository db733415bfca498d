"""The attitude filter's compiled C on a real inertial log (specs/attitude_ekf.md)."""

import os
from pathlib import Path

import numpy as np
import pytest
from plantc.examples.attitude_ekf import attitude_ekf, initial_parameters

from plantc import NativeView, Trace

COLUMNS = {
    "gyro": ["gyro_x_rad_s", "gyro_y_rad_s", "gyro_z_rad_s"],
    "accelerometer": ["accel_x_m_s2", "accel_y_m_s2", "accel_z_m_s2"],
    "magnetometer": ["mag_x_gauss", "mag_y_gauss", "mag_z_gauss"],
}


@pytest.fixture(scope="module")
def log():
    """Return the folder of the log: beside the checkout, or where PLANTC_IMU_LOG says."""
    here = Path(__file__).resolve().parents[2]
    places = [Path(os.environ.get("PLANTC_IMU_LOG", "")), here.parent / "shared" / "data" / "imu_log"]
    for place in places:
        if (place / "imu_first_40s.csv").is_file():
            return place
    if os.environ.get("CI"):
        pytest.fail("the IMU log is missing in CI: ../shared/data/imu_log")
    pytest.skip(
        "the IMU log is not here (it is not committed): set PLANTC_IMU_LOG to the folder with imu_first_40s.csv"
    )


def world_down(q):
    """Third rows of R(q): the world's z axis as the body sees it."""
    w, x, y, z = q.T
    return np.stack([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)], axis=1)


def yaw(q):
    w, x, y, z = q.T
    return np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))


def angle_between(a, b):
    return np.degrees(np.arctan2(np.linalg.norm(np.cross(a, b), axis=1), np.sum(a * b, axis=1)))


def figures(log, precision, params=None):
    """Run the compiled filter on the log and compare it with the autopilot's own estimate, from 5 s on."""
    trace = Trace.from_csv(
        log / "imu_first_40s.csv",
        attitude_ekf,
        columns=COLUMNS,
        time="t_s",
        new_only=["magnetometer"],
        unit_length=["magnetometer"],
    )
    raw = np.loadtxt(log / "imu_first_40s.csv", delimiter=",", skiprows=1)
    autopilot = np.loadtxt(log / "attitude_first_40s.csv", delimiter=",", skiprows=1)
    autopilot = autopilot[autopilot[:, 0] >= 5]
    view = NativeView(attitude_ekf, precision)
    answer = view.run(trace, view.params(**initial_parameters(raw[0, 4:7], raw[0, 7:10]), **(params or {})))
    assert set(answer.statuses) == {0}
    ours = answer.column("q").astype(float)
    q = np.stack([np.interp(autopilot[:, 0], answer.times, ours[:, k]) for k in range(4)], axis=1)
    q /= np.linalg.norm(q, axis=1)[:, None]
    theirs = autopilot[:, 1:5] / np.linalg.norm(autopilot[:, 1:5], axis=1)[:, None]
    tilt = angle_between(world_down(q), world_down(theirs))
    turn = np.degrees((yaw(q) - yaw(theirs) + np.pi) % (2 * np.pi) - np.pi)
    fresh = np.array([item.inputs["has_magnetometer"] for item in answer.calls])
    return {
        "tilt": float(np.sqrt(np.mean(tilt**2))),
        "tilt_max": float(np.max(tilt)),
        "yaw": float(np.sqrt(np.mean((turn - np.median(turn)) ** 2))),
        "yaw_median": float(np.median(turn)),
        "nis_accelerometer": float(np.mean(answer.column("accelerometer.nis"))),
        "nis_magnetometer": float(np.mean(answer.column("magnetometer.nis")[fresh])),
        "bias": answer.column("bias")[-1].astype(float),
    }


@pytest.fixture(scope="module")
def in_double(log):
    return figures(log, "double")


def test_in_double_it_meets_the_specification(in_double):
    assert in_double["tilt"] == pytest.approx(0.267, rel=0.02)
    assert in_double["tilt_max"] == pytest.approx(0.786, rel=0.02)
    assert in_double["yaw"] == pytest.approx(0.207, rel=0.02)
    assert in_double["yaw_median"] == pytest.approx(-0.148, rel=0.02)
    assert in_double["nis_accelerometer"] == pytest.approx(0.085, rel=0.02)
    assert in_double["nis_magnetometer"] == pytest.approx(0.220, rel=0.02)
    np.testing.assert_allclose(in_double["bias"], [-1.28e-3, -2.36e-3, -3.14e-3], rtol=0.02)


def test_in_float_it_stays_beside_double(log, in_double):
    single = figures(log, "float")
    assert abs(single["tilt"] - in_double["tilt"]) < 0.02
    assert abs(single["yaw"] - in_double["yaw"]) < 0.02


def test_a_wrong_gyroscope_noise_is_seen(log, in_double):
    """Planted: the figures are sensitive to the filter, not only to the log."""
    other = figures(log, "double", {"density_gyro_noise": np.full(3, 1e-2)})
    assert abs(other["tilt"] - in_double["tilt"]) > 0.02 * in_double["tilt"]


def test_the_start_is_computed_from_one_sample():
    params = initial_parameters([0, 0, -9.81], [0.3, 0.0, 0.5])
    np.testing.assert_allclose(params["q_0"], [1, 0, 0, 0], atol=1e-15)
    assert params["field_north"] ** 2 + params["field_down"] ** 2 == pytest.approx(1)
    tilted = initial_parameters([9.81 * np.sin(0.3), 0, -9.81 * np.cos(0.3)], [0.3, 0.1, 0.5])
    w, x, y, z = tilted["q_0"]
    assert np.arcsin(2 * (w * y - z * x)) == pytest.approx(0.3)
