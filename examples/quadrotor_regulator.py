"""The quadrotor of Meda-Campana et al. (IEEE Access 2023), regulated: its exosystem is an observer of the references.

Four references (x, y, z, yaw) are read, not known beforehand. A Kalman filter of four polynomials of degree 6 finds their
derivatives, or a high-gain observer the first of them, and the regulator equations say what has to be done with them. The model is
the paper's (specs/output_regulation.md, section 7): hover, explicit Euler at 50 Hz. Its gain is lost; this one is linear-quadratic.
"""

from math import sqrt
from typing import Any

import numpy as np
from plantc.symbolic import Block, Plant, cos, lqr, sin, vertcat
from plantc.symbolic.analysis import linearise
from plantc.symbolic.estimators import extended_kalman_filter
from plantc.symbolic.exosystems import Exosystem, compose, polynomial
from plantc.symbolic.output_regulator import output_regulator
from plantc.symbolic.regulator_equations import francis
from plantc.symbolic.signal_generators import high_gain_exosystem, kalman_exosystem

quadrotor = Plant("quadrotor", doc="quadrotor of Meda-Campana 2023")

x = quadrotor.state("x", unit="m", range=(-1e4, 1e4), doc="position")
vx = quadrotor.state("vx", unit="m/s", range=(-1e4, 1e4), doc="velocity along x")
y = quadrotor.state("y", unit="m", range=(-1e4, 1e4), doc="position")
vy = quadrotor.state("vy", unit="m/s", range=(-1e4, 1e4), doc="velocity along y")
z = quadrotor.state("z", unit="m", range=(-1e4, 1e4), doc="altitude, upwards")
vz = quadrotor.state("vz", unit="m/s", range=(-1e4, 1e4), doc="velocity along z")
roll = quadrotor.state("roll", unit="rad", range=(-30, 30), doc="roll angle, not wrapped")
roll_rate = quadrotor.state("roll_rate", unit="rad/s", range=(-1e3, 1e3), doc="its rate")
pitch = quadrotor.state("pitch", unit="rad", range=(-30, 30), doc="pitch angle, not wrapped")
pitch_rate = quadrotor.state("pitch_rate", unit="rad/s", range=(-1e3, 1e3), doc="its rate")
yaw = quadrotor.state("yaw", unit="rad", range=(-30, 30), doc="yaw angle, not wrapped")
yaw_rate = quadrotor.state("yaw_rate", unit="rad/s", range=(-1e3, 1e3), doc="its rate")

u1, u2, u3, u4 = (
    quadrotor.input(f"rotor_{k}", unit="rad/s", range=(-1e4, 1e4), doc=f"speed of rotor {k}") for k in (1, 2, 3, 4)
)

thrust_factor = quadrotor.constant("thrust_factor", 54.2e-6, unit="N s^2")
drag_factor = quadrotor.constant("drag_factor", 1.1e-6, unit="N m s^2")
arm = quadrotor.constant("arm_length", 0.24, unit="m")
mass = quadrotor.constant("mass", 1.0, unit="kg")
gravity = quadrotor.constant("gravity", 9.81, unit="m/s^2")
inertia_x = quadrotor.constant("inertia_x", 8.1e-3, unit="kg m^2")
inertia_y = quadrotor.constant("inertia_y", 8.1e-3, unit="kg m^2")
inertia_z = quadrotor.constant("inertia_z", 14.2e-3, unit="kg m^2")
inertia_rotor = quadrotor.constant("inertia_rotor", 104e-6, unit="kg m^2")

b1 = thrust_factor * (u1**2 + u2**2 + u3**2 + u4**2)
b2 = thrust_factor * (-(u1**2) - u2**2 + u3**2 + u4**2)
b3 = thrust_factor * (-(u1**2) + u2**2 + u3**2 - u4**2)
b4 = drag_factor * (u1**2 - u2**2 + u3**2 - u4**2)
rotors = u1 - u2 + u3 - u4
lift = b1 / mass

quadrotor.dynamics(
    {
        x: vx,
        vx: (sin(yaw) * sin(roll) + cos(yaw) * sin(pitch) * cos(roll)) * lift,
        y: vy,
        vy: (-cos(yaw) * sin(roll) + sin(yaw) * sin(pitch) * cos(roll)) * lift,
        z: vz,
        vz: -gravity + cos(pitch) * cos(roll) * lift,
        roll: roll_rate,
        roll_rate: pitch_rate * yaw_rate * ((inertia_y - inertia_z) / inertia_x)
        - (inertia_rotor / inertia_x) * pitch_rate * rotors
        + (arm / inertia_x) * b2,
        pitch: pitch_rate,
        pitch_rate: roll_rate * yaw_rate * ((inertia_z - inertia_x) / inertia_y)
        + (inertia_rotor / inertia_y) * roll_rate * rotors
        + (arm / inertia_y) * b3,
        yaw: yaw_rate,
        yaw_rate: roll_rate * pitch_rate * ((inertia_x - inertia_y) / inertia_z) + b4 / inertia_z,
    }
)

quadrotor.sensor("pose", vertcat(x, y, z, roll, pitch, yaw), variance=0.01**2, doc="position and angles")

T = 0.02
sampled = quadrotor.discretise("euler", dt=T)

hover = sqrt(9.81 / (4 * 54.2e-6))  # rotor speed that carries the weight
set_point = {u1: hover, u2: hover, u3: hover, u4: hover}
near = linearise(sampled, set_point)
gain = lqr(near, 100 * np.eye(12), np.eye(4))

references = ("x", "y", "z", "yaw")
reach = (-10.0, 10.0)
process_variance, measurement_variance = 1e-12, 0.01


def tracks(degree: int) -> Exosystem:
    """Return the exosystem of four polynomials of a degree, sampled by Euler as the paper does."""
    return compose([polynomial(name, degree) for name in references]).sampled(T, "euler")


def regulator(degree: int, name: str, *, steady: bool = False, together: bool = False, **options: Any) -> Block:
    """Return the regulator whose exosystem is a Kalman filter of a polynomial of a degree for each reference.

    Parameters
    ----------
    degree : int
        Of the polynomials: 2 or 6 in the paper.
    name : str
        Of the Block.
    steady : bool
        Whether the filter has the gain at which it arrives from the start, and no covariance.
    together : bool
        Whether the four readings come or are missing together: the covariance of one is that of all. Else each has a flag.
    **options
        As for `plantc.symbolic.output_regulator.output_regulator`.
    """
    observed = tracks(degree) if together else polynomial("reading", degree).sampled(T, "euler")
    observer = kalman_exosystem(
        observed,
        process_variance=process_variance,
        measurement_variance=measurement_variance,
        ranges=dict.fromkeys(observed.signals, reach),
        steady=steady,
        together=together,
        name="generator",
    )
    return output_regulator(
        sampled,
        set_point,
        gain,
        francis(near, tracks(degree)),
        observer if together else dict.fromkeys(references, observer),
        name=name,
        **options,
    )


def high_gain_regulator(name: str, **options: Any) -> Block:
    """Return the regulator whose exosystem is the paper's high-gain observer of a straight line for each reference."""
    observer = high_gain_exosystem(
        polynomial("reading", 1).sampled(T, "euler"), coefficients=(2, 1), epsilon=T, ranges={"reading": reach},
        name="generator",
    )  # fmt: skip
    return output_regulator(
        sampled, set_point, gain, francis(near, tracks(1)), dict.fromkeys(references, observer), name=name, **options
    )


def estimated_regulator(degree: int, name: str) -> Block:
    """Return the first regulator with an extended Kalman filter of the vehicle's own state in front (the paper's Remark 1)."""
    believed = quadrotor.discretise("euler", dt=T).step_noise({state.signal.name: 1e-6 for state in quadrotor.states})
    estimator = extended_kalman_filter(
        believed,
        initial_variance={state.signal.name: 1e-4 for state in believed.states},
        around=set_point,
        name="estimator",
    )
    return regulator(degree, name, estimator=estimator, tunable=False)


# the exosystem of the first three has 28 states
quadrotor_regulator = regulator(6, "quadrotor_regulator", tunable=False)
quadrotor_together_regulator = regulator(6, "quadrotor_together_regulator", together=True, tunable=False)
quadrotor_steady_regulator = regulator(6, "quadrotor_steady_regulator", steady=True, tunable=False)
quadrotor_high_gain_regulator = high_gain_regulator("quadrotor_high_gain_regulator", tunable=False)
