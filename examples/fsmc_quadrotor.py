"""The quadrotor of Ghanai, Medjghou and Chafaa (AEEE 16(4), 2018): plant, rotors, and its extended Kalman filter.

Only positions and angles are read. The paper mixes two vehicles (specs/ekf_fsmc.md, erratum 1): set A is that of its
table, set B reproduces the coefficients that it prints. Everything is computed from the physical values.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import Any

import numpy as np
from plantc.symbolic import Block, Plant, cos, sin, vertcat
from plantc.symbolic.estimators import extended_kalman_filter
from plantc.symbolic.plant import Symbol
from plantc.symbolic.rotors import rotor_mixer

DT = 1e-3
"""Seconds per step."""

FAR = 1e3
"""Range of every state: a run that leaves it counts as diverged."""

UNITS = {
    "mass": "kg",
    "arm_length": "m",
    "inertia_x": "kg m^2",
    "inertia_y": "kg m^2",
    "inertia_z": "kg m^2",
    "drag_roll": "N m s^2/rad^2",
    "drag_pitch": "N m s^2/rad^2",
    "drag_yaw": "N m s^2/rad^2",
    "drag_x": "N s/m",
    "drag_y": "N s/m",
    "drag_z": "N s/m",
    "rotor_inertia": "kg m^2",
    "gravity": "m/s^2",
}
"""What the plant is made of, with units."""

SET_A = {
    "mass": 0.4,
    "arm_length": 0.205,
    "inertia_x": 3.8278e-3,
    "inertia_y": 3.8278e-3,
    "inertia_z": 7.1345e-3,
    "drag_roll": 5.567e-4,
    "drag_pitch": 5.567e-4,
    "drag_yaw": 6.354e-4,
    "drag_x": 0.032,
    "drag_y": 0.032,
    "drag_z": 0.048,
    "rotor_inertia": 2.8385e-5,
    "gravity": 9.81,
}
SET_B = SET_A | {
    "mass": 0.486,
    "arm_length": 0.25,
    "inertia_y": 3.8288e-3,
    "inertia_z": 7.6566e-3,
    "drag_x": 5.567e-4,
    "drag_y": 5.567e-4,
    "drag_z": 6.354e-4,
}
SET_PRINTED = SET_B | {"mass": 0.4, **{f"drag_{axis}": SET_B[f"drag_{axis}"] * 0.4 / 0.486 for axis in "xyz"}}
"""The mass of the table with the coefficients that are printed under it: those of set B, to the digits given."""
SETS = {"A": SET_A, "B": SET_B}
VEHICLES = SETS | {"printed": SET_PRINTED}

THRUST_FACTOR, DRAG_FACTOR, FASTEST = 2.9842e-5, 3.2320e-7, 400.0
"""N s^2/rad^2, N m s^2/rad^2, and the largest speed of a rotor in rad/s: the same in both sets."""

EFFECT = np.array(
    [
        [THRUST_FACTOR, THRUST_FACTOR, THRUST_FACTOR, THRUST_FACTOR],
        [0.0, -THRUST_FACTOR, 0.0, THRUST_FACTOR],
        [-THRUST_FACTOR, 0.0, THRUST_FACTOR, 0.0],
        [DRAG_FACTOR, -DRAG_FACTOR, DRAG_FACTOR, -DRAG_FACTOR],
    ]
)
"""u of the squared speeds of the rotors, section 4."""

COMMANDS = {"u1": "N", "u2": "N", "u3": "N", "u4": "N m"}
ASKED = {"u1": (0.0, 20.0), "u2": (-1e4, 1e4), "u3": (-1e4, 1e4), "u4": (-1e3, 1e3)}
"""What may be asked of the rotors; what they apply is less."""

STATES = ("roll", "roll_rate", "pitch", "pitch_rate", "yaw", "yaw_rate", "x", "vx", "y", "vy", "z", "vz")
READ = ("roll", "pitch", "yaw", "x", "y", "z")

TUNINGS = {"printed": (1e-2, 1e-2, 1e-1), "robust": (1e-10, 1.6e-5, 1e-4), "matched": (1e-12, 1e-8, 1e-4)}
"""Variances per step of positions (and angles) and of velocities, and of a reading: section 9."""


def coefficients(values: Mapping[str, Any]) -> tuple[list[Any], list[Any]]:
    """Return a1 .. a11 and b1 .. b3, both from index 1, of physical values: numbers or symbols (section 2)."""
    Ix, Iy, Iz = (values[f"inertia_{axis}"] for axis in "xyz")
    m, Jr = values["mass"], values["rotor_inertia"]
    a = [
        0,
        (Iy - Iz) / Ix,
        -values["drag_roll"] / Ix,
        -Jr / Ix,
        (Iz - Ix) / Iy,
        -values["drag_pitch"] / Iy,
        Jr / Iy,
        (Ix - Iy) / Iz,
        -values["drag_yaw"] / Iz,
        -values["drag_x"] / m,
        -values["drag_y"] / m,
        -values["drag_z"] / m,
    ]
    return a, [0, values["arm_length"] / Ix, values["arm_length"] / Iy, 1 / Iz]


def vehicle(
    name: str = "fsmc_quadrotor",
    values: Mapping[str, float] = SET_A,
    *,
    tunable: Collection[str] = (),
    disturbed: bool = False,
    read: Sequence[str] = READ,
    variance: float = 1e-4,
    commanded: bool = False,
    seen: bool = False,
) -> Plant:
    """Return the continuous plant (eqs. 1 to 4).

    Parameters
    ----------
    name : str
        Its name.
    values : dict
        The physical values, such as `SET_A`.
    tunable : collection of str
        Which of them are run-time parameters, within 0.1 to 10 times their value; the rest is folded.
    disturbed : bool
        Whether the accelerations d of section 8 are inputs, `angular_disturbance` and `linear_disturbance`: the truth. Their
        declared density is that of n.
    read : sequence of str
        The states that the sensor `pose` reads.
    variance : float
        Of each reading, m^2 or rad^2.
    commanded : bool
        Whether the inputs have the ranges of what a law may ask for, instead of what rotors apply.
    seen : bool
        Whether each state has a sensor of its own, ``seen_<state>``, that reads it without noise worth the name.

    Returns
    -------
    Plant
        States in the paper's order, inputs u1 .. u4 and the residual speed of the rotors `Om`.
    """
    plant = Plant(name, doc="quadrotor of Ghanai, Medjghou and Chafaa 2018")
    symbols: dict[str, Symbol] = {}
    for axis in ("roll", "pitch", "yaw"):
        symbols[axis] = plant.state(axis, unit="rad", range=(-FAR, FAR), doc=f"{axis} angle, not wrapped")
        symbols[f"{axis}_rate"] = plant.state(f"{axis}_rate", unit="rad/s", range=(-FAR, FAR), doc="its rate")
    for axis in "xyz":
        doc = "altitude, upwards" if axis == "z" else "position"
        symbols[axis] = plant.state(axis, unit="m", range=(-FAR, FAR), doc=doc)
        symbols[f"v{axis}"] = plant.state(f"v{axis}", unit="m/s", range=(-FAR, FAR), doc=f"velocity along {axis}")
    most, turning = 4 * THRUST_FACTOR * FASTEST**2, 4 * DRAG_FACTOR * FASTEST**2
    ranges = {"u1": (-most, 2 * most), "u2": (-most, most), "u3": (-most, most), "u4": (-turning, turning)}
    meanings = ("thrust", "differential thrust that rolls", "differential thrust that pitches", "yaw torque")
    u1, u2, u3, u4 = (
        plant.input(key, unit=unit, range=(ASKED if commanded else ranges)[key], doc=meaning)
        for (key, unit), meaning in zip(COMMANDS.items(), meanings, strict=True)
    )
    Om = plant.input("Om", unit="rad/s", range=(-4 * FASTEST, 4 * FASTEST), doc="residual speed of the rotors")
    own: dict[str, Any] = {}
    for key, unit in UNITS.items():
        value = values[key]
        if key in tunable:
            own[key] = plant.parameter(key, value, unit=unit, range=(0.1 * value, 10 * value))
        else:
            own[key] = plant.constant(key, value, unit=unit)
    turned: list[Any] = [0.0] * 3
    moved: list[Any] = [0.0] * 3
    if disturbed:  # a density q / dt is held over a step with variance q
        angular = plant.noise("angular_disturbance", size=3, density=1e-2 * DT, unit="rad/s^2")
        linear = plant.noise("linear_disturbance", size=3, density=1e-2 * DT, unit="m/s^2")
        turned, moved = [angular[k] for k in range(3)], [linear[k] for k in range(3)]
    a, b = coefficients(own)
    phi, x2, theta, x4, psi, x6, _, x8, _, x10, _, x12 = symbols.values()
    lift = u1 / own["mass"]
    plant.dynamics(
        {
            **{symbols[axis]: symbols[f"{axis}_rate"] for axis in ("roll", "pitch", "yaw")},
            **{symbols[axis]: symbols[f"v{axis}"] for axis in "xyz"},
            # the drag is the unsigned square of the rate, as printed (erratum 3)
            x2: a[1] * x4 * x6 + a[2] * x2**2 + a[3] * Om * x4 + b[1] * u2 + turned[0],
            x4: a[4] * x2 * x6 + a[5] * x4**2 + a[6] * Om * x2 + b[2] * u3 + turned[1],
            x6: a[7] * x2 * x4 + a[8] * x6**2 + b[3] * u4 + turned[2],
            x8: lift * (cos(phi) * sin(theta) * cos(psi) + sin(phi) * sin(psi)) + a[9] * x8 + moved[0],
            x10: lift * (cos(phi) * sin(theta) * sin(psi) - sin(phi) * cos(psi)) + a[10] * x10 + moved[1],
            x12: lift * cos(phi) * cos(theta) + a[11] * x12 - own["gravity"] + moved[2],
        }
    )
    pose = vertcat(*[symbols[item] for item in read])
    plant.sensor("pose", pose, variance=variance, range=(-2 * FAR, 2 * FAR), doc=", ".join(read))
    for state in STATES if seen else ():
        plant.sensor(f"seen_{state}", symbols[state], unit=symbols[state].signal.unit, variance=1e-12)
    return plant


def sampled(plant: Plant) -> Plant:
    """Return the plant at 1 kHz by explicit Euler: positions and velocities are both advanced from the old values."""
    return plant.discretise("euler", dt=DT)


def hover(values: Mapping[str, float] = SET_A) -> dict[str, float]:
    """Return the point at which thrust carries the weight, at the origin."""
    return {"u1": values["mass"] * values["gravity"]}


def tuned(tuning: str, read: Sequence[str] = READ) -> dict[str, Any]:
    """Return the parameters with which the filter has one of `TUNINGS`."""
    position, velocity, reading = TUNINGS[tuning]
    answer: dict[str, Any] = {}
    for k, state in enumerate(STATES):
        answer[f"variance_step_{state}"] = velocity if k % 2 else position
    return answer | {"variance_pose": np.full(len(read), reading)}


def ekf(
    values: Mapping[str, float] = SET_A,
    tuning: str = "printed",
    *,
    read: Sequence[str] = READ,
    name: str = "fsmc_quadrotor_ekf",
) -> Block:
    """Return the filter of section 9: P_0 = I, the estimate at rest at the origin.

    Parameters
    ----------
    values : dict
        What it believes of the vehicle.
    tuning : str
        A key of `TUNINGS`; they are run-time parameters, see `tuned`.
    read : sequence of str
        The states that are read.
    name : str
        Of the block.
    """
    plant = vehicle(values=values, read=read, variance=TUNINGS[tuning][2])
    given = tuned(tuning, read)
    noisy = sampled(plant).step_noise({state: given[f"variance_step_{state}"] for state in STATES})
    return extended_kalman_filter(
        noisy, initial_variance=dict.fromkeys(STATES, 1.0), around=hover(values), name=name, doc="filter of a quadrotor"
    )


def mixer(name: str = "mixer") -> Block:
    """Return the mixer of section 4: commands u1 .. u4, the same applied, and `Om`."""
    return rotor_mixer(EFFECT, COMMANDS, fastest=FASTEST, spins=(1, -1, 1, -1), residual="Om", ranges=ASKED, name=name)
