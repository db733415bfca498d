"""A pendulum with an encoder: the smallest whole example."""

from plantc.symbolic import Plant, sin
from plantc.symbolic.estimators import extended_kalman_filter

pendulum = Plant("pendulum")
theta = pendulum.state("theta", unit="rad", angle=True, doc="angle from the lower rest")
omega = pendulum.state("omega", unit="rad/s", range=(-100, 100), doc="its rate")
torque = pendulum.input("torque", unit="N m", range=(-10, 10), doc="torque at the pivot")
mass = pendulum.parameter("mass", 0.2, unit="kg", range=(1e-3, 1e3), doc="mass")
length = pendulum.parameter("length", 0.5, unit="m", range=(1e-3, 1e2), doc="length")
gravity = pendulum.parameter("gravity", 9.81, unit="m/s^2", range=(0, 100), doc="gravity")
draught = pendulum.noise("draught", density=1e-3, unit="N m", doc="torque of moving air")

pendulum.dynamics(
    {
        theta: omega,
        omega: (torque + draught - mass * gravity * length * sin(theta)) / (mass * length**2),
    }
)
pendulum.sensor("encoder", theta, unit="rad", angle=True, variance=1e-4, doc="measured angle")

pendulum_ekf = extended_kalman_filter(
    pendulum.discretise("euler", dt=(1e-5, 0.1)),  # dt is an input of predict, within these bounds
    initial_variance={theta: 1.0, omega: 1.0},
)
