"""The 12-state quadrotor of Meda-Campana (IEEE Access 2018, eqs. 26-41): extended and linear Kalman filter.

The model is the paper's as printed, its quirks included (specs/meda2018.md, errata E11 and E12): explicit Euler at 40 Hz,
all twelve states measured at once, process noise of standard deviation 0.001 per step on each.
"""

from math import sqrt

from plantc.symbolic import Plant, cos, sin, vertcat
from plantc.symbolic.estimators import extended_kalman_filter, kalman_filter

quadrotor = Plant("quadrotor", doc="quadrotor of Meda-Campana 2018")

x = quadrotor.state("x", unit="m", range=(-1e4, 1e4), doc="position")
vx = quadrotor.state("vx", unit="m/s", range=(-1e3, 1e3), doc="velocity along x")
y = quadrotor.state("y", unit="m", range=(-1e4, 1e4), doc="position")
vy = quadrotor.state("vy", unit="m/s", range=(-1e3, 1e3), doc="velocity along y")
z = quadrotor.state("z", unit="m", range=(-1e4, 1e4), doc="altitude, upwards")
vz = quadrotor.state("vz", unit="m/s", range=(-1e3, 1e3), doc="velocity along z")
roll = quadrotor.state("roll", unit="rad", range=(-30, 30), doc="roll angle, not wrapped")
roll_rate = quadrotor.state("roll_rate", unit="rad/s", range=(-100, 100), doc="its rate")
pitch = quadrotor.state("pitch", unit="rad", range=(-30, 30), doc="pitch angle, not wrapped")
pitch_rate = quadrotor.state("pitch_rate", unit="rad/s", range=(-100, 100), doc="its rate")
yaw = quadrotor.state("yaw", unit="rad", range=(-30, 30), doc="yaw angle, not wrapped")
yaw_rate = quadrotor.state("yaw_rate", unit="rad/s", range=(-100, 100), doc="its rate")
states = [x, vx, y, vy, z, vz, roll, roll_rate, pitch, pitch_rate, yaw, yaw_rate]

u1, u2, u3, u4 = (
    quadrotor.input(f"rotor_{k}", unit="rad/s", range=(-1000, 1000), doc=f"speed of rotor {k}") for k in (1, 2, 3, 4)
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
        # cos(roll) on both terms of vx and vy is the paper's (erratum E11); the usual model has it on the second only
        x: vx,
        vx: (sin(yaw) * sin(roll) + cos(yaw) * sin(pitch)) * cos(roll) * lift,
        y: vy,
        vy: (-cos(yaw) * sin(roll) + sin(yaw) * sin(pitch)) * cos(roll) * lift,
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
quadrotor.sensor("pose", vertcat(*states), variance=0.1**2, doc="all twelve states, in their order")

sampled = quadrotor.discretise("euler", dt=1 / 40).step_noise({state: 1e-6 for state in states})

hover = sqrt(9.81 / (4 * 54.2e-6))  # rotor speed that carries the weight
set_point = {z: 30.0, u1: hover, u2: hover, u3: hover, u4: hover}
initial_variance = {state: 0.01 / 3 for state in states}

quadrotor_ekf = extended_kalman_filter(
    sampled, initial_variance=initial_variance, around=set_point, gate={"pose": 60.0}
)
# at hover the axes do not touch each other; the whole covariance is kept all the same, to be compared with that of the paper
quadrotor_kf = kalman_filter(sampled, at=set_point, initial_variance=initial_variance, correlated="all")
