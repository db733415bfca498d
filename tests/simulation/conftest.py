"""The closed loops of specs/meda2018.md: the quadrotor with the printed gain and each of the four estimators."""

import functools

import numpy as np
import pytest
from plantc.examples.quadrotor_ekf import quadrotor_ekf, quadrotor_kf, sampled, set_point
from plantc.examples.quadrotor_james_stein import quadrotor_jsse, quadrotor_jssem
from plantc.simulation import closed_loop
from plantc.symbolic.composition import connect, wires
from plantc.symbolic.controllers import state_feedback

F44 = np.array(
    [
        [-25.0, 411.0, -8.9, 399.0], [-4.3, 333.0, 13.0, 311.0], [-311.0, -20.0, -322.0, -32.0],
        [-277.0, -22.0, -299.0, -37.0], [199.0, 200.0, 199.0, 200.0], [93.0, 95.0, 93.0, 95.0],
        [711.0, 59.0, 766.0, 122.0], [56.0, 2.9, 67.0, 14.0], [28.0, 844.0, 97.0, 766.0],
        [3.4, 71.0, 15.0, 58.0], [177.0, -188.0, 177.0, -188.0], [74.0, -76.0, 74.0, -76.0],
    ]
)  # fmt: skip
ESTIMATORS = {"kf": quadrotor_kf, "ekf": quadrotor_ekf, "jsse": quadrotor_jsse, "jssem": quadrotor_jssem}
X_O = np.array([0.0, 0, 0, 0, 30, 0, 0, 0, 0, 0, 0, 0])


def parameters(which, r, gamma=0.15):
    """Parameters of the estimator for measurement noise of std r; no gate."""
    if which in ("kf", "ekf"):
        return {"controller.estimator.variance_pose": np.full(12, r**2), "controller.estimator.gate_pose": 0.0}
    values = {"controller.estimator.std_pose": r}
    return values | ({"controller.estimator.gamma_pose": gamma} if which == "jssem" else {})


@functools.cache
def quadrotor_loop(which):
    feedback = state_feedback(sampled, set_point, F44.T)
    controller = connect(
        {"estimator": ESTIMATORS[which], "feedback": feedback},
        wires("estimator", "feedback", [s.symbol for s in sampled.states])
        | wires("feedback", "estimator", sampled.inputs, initial=set_point),
        f"quadrotor_{which}_controller",
    )
    return closed_loop(sampled, controller, set_point, name=f"loop_{which}")


@pytest.fixture(scope="session")
def loop():
    """A function that gives the loop of an estimator: "kf", "ekf", "jsse" or "jssem"."""
    return quadrotor_loop


@pytest.fixture(scope="session")
def tuned():
    """A function that gives the parameters of an estimator for a std of the measurement noise."""
    return parameters
