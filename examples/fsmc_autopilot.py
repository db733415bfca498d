"""The autopilot of Ghanai, Medjghou and Chafaa (AEEE 16(4), 2018) in one block: filter, three sliding mode laws, rotors.

One `step` a millisecond: the filter predicts with the input that was applied and takes the reading; the altitude law gives
the thrust, the position law where it is to point, the allocation roll and pitch; filtered, with their derivatives, they and
the yaw are what the attitude law follows; the mixer turns thrust and torques into rotor speeds and says what is applied.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from math import pi
from typing import Any

import numpy as np
from numpy.typing import NDArray
from plantc.codegen.batch import Batch
from plantc.codegen.layout import flatten
from plantc.codegen.views import NativeView
from plantc.examples.fsmc_quadrotor import (
    DT,
    FAR,
    FASTEST,
    READ,
    SET_A,
    STATES,
    THRUST_FACTOR,
    VEHICLES,
    ekf,
    hover,
    mixer,
    sampled,
    tuned,
    vehicle,
)
from plantc.reference.fsmc import Run, course
from plantc.simulation import ClosedLoop, closed_loop
from plantc.symbolic import Block, Plant, cos, sin
from plantc.symbolic.command_filter import command_filter
from plantc.symbolic.components import finish
from plantc.symbolic.composition import Delay, connect, delay, wires
from plantc.symbolic.fuzzy import FuzzyInput, FuzzyOutput, FuzzySet, FuzzySystem
from plantc.symbolic.sliding_mode import Switching, fuzzy, sign, sliding_mode, tanh
from plantc.symbolic.tilt import tilt_allocation

Array = NDArray[np.float64]

CHANNELS = ("roll", "pitch", "yaw", "x", "y", "z")
SLOPE = dict(zip(CHANNELS, (10.0, 10.0, 3.0, 1.0, 1.0, 1.0), strict=True))
RATE = dict(zip(CHANNELS, (3.0, 3.0, 2.0, 2.0, 2.0, 4.0), strict=True))
GAIN = dict(zip(CHANNELS, (4.0, 4.0, 2.0, 0.5, 0.5, 1.0), strict=True))
WIDTH = dict(zip(CHANNELS, (0.5, 0.5, 0.3, 0.3, 0.3, 0.3), strict=True))
"""lambda and mu (1/s) are the paper's; K (rad/s^2, m/s^2) and Phi (rad/s, m/s), of which it says nothing, those of section 6."""

FREQUENCY, DAMPING = 20.0, 1.0
"""Of the filters of roll and pitch, rad/s."""

LEAST_COSINE, LEAST_THRUST, STEEPEST = 0.2, 0.2, 0.5
"""Where cos(roll) cos(pitch) is held; the least thrust, as a share of the weight; the largest sine of roll and pitch."""

LAWS = ("SMC", "tanh", "FSMC")


def five_rules() -> FuzzySystem:
    """Return the fuzzy system of section 7: one input, five rules, the centres of symmetric triangles as singletons."""
    peaks = {"NB": -1.0, "NM": -0.5, "Z": 0.0, "PM": 0.5, "PB": 1.0}
    centres = {"NB": -1.0, "NM": -0.4, "Z": 0.0, "PM": 0.4, "PB": 1.0}
    surface = FuzzyInput("surface", (-1, 1), FuzzySet.partition(peaks))
    return FuzzySystem(surface, FuzzyOutput("share", centres), [(label, label) for label in peaks])


def switching(law: str, channel: str) -> Switching:
    """Return the switching term of a channel in one of `LAWS`."""
    if law == "SMC":
        return sign()
    return tanh(WIDTH[channel]) if law == "tanh" else fuzzy(five_rules(), WIDTH[channel])


def horizontal(values: Mapping[str, float] = SET_A) -> Plant:
    """Return the motion along x and y: what moves it is the direction of the thrust, ux and uy, the thrust is known."""
    plant = Plant("horizontal", doc="the horizontal motion of a quadrotor, moved by the direction of its thrust")
    x, y = (plant.state(axis, unit="m", range=(-FAR, FAR), doc="position") for axis in "xy")
    vx, vy = (plant.state(f"v{axis}", unit="m/s", range=(-FAR, FAR), doc=f"velocity along {axis}") for axis in "xy")
    ux, uy = (plant.input(f"u{axis}", doc=f"share of the thrust along {axis}") for axis in "xy")
    u1 = plant.input("u1", unit="N", range=thrusts(values), doc="thrust")
    m = values["mass"]
    drags = values["drag_x"] / m, values["drag_y"] / m
    plant.dynamics({x: vx, y: vy, vx: u1 / m * ux - drags[0] * vx, vy: u1 / m * uy - drags[1] * vy})
    return plant


def thrusts(values: Mapping[str, float] = SET_A) -> tuple[float, float]:
    """Return the least and the largest thrust that the altitude law may ask for, N (section 6, step 1)."""
    return LEAST_THRUST * values["mass"] * values["gravity"], 4 * THRUST_FACTOR * FASTEST**2


def laws(law: str, values: Mapping[str, float] = SET_A) -> dict[str, Block]:
    """Return the laws of altitude, position and attitude: three sliding mode controllers found in the model."""
    plant = vehicle(values=values, commanded=True)

    def numbers(*channels: str) -> dict[str, Any]:
        return {
            "surface": {item: SLOPE[item] for item in channels},
            "mu": {item: RATE[item] for item in channels},
            "gain": {item: GAIN[item] for item in channels},
            "switching": {item: switching(law, item) for item in channels},
        }

    return {
        "altitude": sliding_mode(
            plant, {"z": "u1"}, least={"z": LEAST_COSINE / values["mass"]}, saturate={"u1": thrusts(values)},
            name="altitude", **numbers("z"),
        ),
        "position": sliding_mode(horizontal(values), {"x": "ux", "y": "uy"}, name="position", **numbers("x", "y")),
        "attitude": sliding_mode(
            plant, {"roll": "u2", "pitch": "u3", "yaw": "u4"}, wrapped=["yaw"], name="attitude", **numbers("roll", "pitch", "yaw")
        ),
    }  # fmt: skip


def control_law(law: str = "FSMC", values: Mapping[str, float] = SET_A, *, name: str = "law") -> Block:
    """Return the law of section 6 with the mixer of section 4: states and what they are to follow in, rotor speeds out.

    Parameters
    ----------
    law : str
        One of `LAWS`.
    values : dict
        What it believes of the vehicle.
    name : str
        Of the block.

    Returns
    -------
    Block
        Inputs: what each part needs of the states, under the name of the part, and the references. Outputs by part; those
        of `mixer` are the rotor speeds, and what is applied.
    """
    parts = laws(law, values) | {"allocation": tilt_allocation(STEEPEST), "mixer": mixer()}
    for axis in ("roll", "pitch"):
        parts[f"{axis}_filter"] = command_filter(
            FREQUENCY, DAMPING, dt=DT, unit="rad", range=(-1.5, 1.5), name=f"{axis}_filter"
        )
    joined: dict[str, str | Delay] = {
        "position.u1": "altitude.u1",
        **wires("position", "allocation", ["ux", "uy"]),
        "roll_filter.raw": "allocation.roll",
        "pitch_filter.raw": "allocation.pitch",
        "attitude.reference_yaw": "allocation.yaw",
        "attitude.Om": delay("mixer.Om", 0.0),
        "mixer.u1": "altitude.u1",
        **wires("attitude", "mixer", ["u2", "u3", "u4"]),
    }
    for axis in ("roll", "pitch"):
        joined[f"attitude.reference_{axis}"] = f"{axis}_filter.value"
        joined[f"attitude.reference_rate_{axis}"] = f"{axis}_filter.rate"
        joined[f"attitude.reference_acceleration_{axis}"] = f"{axis}_filter.acceleration"
    return connect(parts, joined, name, doc=f"position and attitude control of a quadrotor, {law}")


def autopilot(
    law: str = "FSMC", values: Mapping[str, float] = SET_A, tuning: str = "printed", *, name: str = "fsmc_autopilot",
    read: tuple[str, ...] = READ,
) -> Block:  # fmt: skip
    """Return the whole autopilot: the filter, then the law; the applied input goes back to the filter one step late.

    Parameters
    ----------
    law, values
        As for `control_law`.
    tuning : str
        Of the filter; run-time parameters, see `fsmc_quadrotor.tuned`.
    name : str
        Of the block.
    read : tuple of str
        The states that are read.

    Returns
    -------
    Block
        Inputs `estimator_has_pose`, `estimator_pose`, and the references as ``law_<part>_reference_...``. The first step is
        that of the first reading: its prediction is with the input that was applied before, by default hover.
    """
    parts = {"estimator": ekf(values, tuning, read=read), "law": control_law(law, values)}
    joined: dict[str, str | Delay] = {}
    for signal in parts["law"].entries["step"].inputs:
        state = seen_by(signal.name)
        if state:
            joined[f"law.{signal.name}"] = f"estimator.{state}"
    start = hover(values)
    for key in ("u1", "u2", "u3", "u4", "Om"):
        joined[f"estimator.{key}"] = delay(f"law.mixer.{key}", start.get(key, 0.0))
    doc = f"autopilot of a quadrotor of which positions and angles are read: extended Kalman filter, {law}, mixer"
    return connect(parts, joined, name, doc=doc)


def seen_by(name: str) -> str:
    """Return the state that an input of the law reads, or an empty string."""
    part, _, own = name.partition("_")
    return own if part in ("altitude", "position", "attitude", "allocation") and own in STATES else ""


# -- what it follows --------------------------------------------------------------------------------------------------


def trajectory(*, ramp: bool = False, name: str = "trajectory") -> Block:
    """Return the reference of section 5 as a block that counts its steps: circle, altitude and yaw with their derivatives.

    Parameters
    ----------
    ramp : bool
        Whether the altitude is 5 t instead of 5; `altitude` and `climb` are run-time parameters.
    name : str
        Of the block.
    """
    block = Block(name, doc="a circle at an altitude that may climb, and a yaw, with first and second derivatives")
    w = block.parameter("frequency", pi / 4, unit="rad/s", range=(0, 10), doc="of the circle")
    radius = block.parameter("radius", 0.5, unit="m", range=(0, 10))
    altitude = block.parameter("altitude", 0.0 if ramp else 5.0, unit="m", range=(-100, 100), doc="at the start")
    climb = block.parameter("climb", 5.0 if ramp else 0.0, unit="m/s", range=(-10, 10))
    yaw = block.parameter("yaw", pi / 4, unit="rad", range=(-3.2, 3.2))
    # the first step of a loop is that of the first reading, one step after the start
    count = block.memory("count", initial=1.0, range=(0, 1e7), doc="steps since the start")
    t = DT * count
    x, y = radius * cos(w * t), radius * sin(w * t)
    outputs = {
        "x": x, "rate_x": -w * y, "acceleration_x": -(w**2) * x, "y": y, "rate_y": w * x, "acceleration_y": -(w**2) * y,
        "z": altitude + climb * t, "rate_z": climb, "acceleration_z": 0, "yaw": yaw, "rate_yaw": 0, "acceleration_yaw": 0,
    }  # fmt: skip
    units = {"": "m", "rate": "m/s", "acceleration": "m/s^2"}
    turns = {"": "rad", "rate": "rad/s", "acceleration": "rad/s^2"}
    said = {
        key: (turns if key.endswith("yaw") else units)[key.partition("_")[0] if "_" in key else ""] for key in outputs
    }
    block.entry("step", following={count: count + 1}, outputs=outputs, output_units=said)
    block.sample_time = DT

    def calls(rng: Any, steps: int) -> Iterator[tuple[str, dict[str, Any]]]:
        yield "init", {}
        yield from (("step", {}) for _ in range(steps))

    return finish(block, {"step": course}, calls)


def led(controller: Block, follows: Block, name: str = "led") -> Block:
    """Return a law or an autopilot that follows a `trajectory`."""
    joined: dict[str, str | Delay] = {}
    for signal in controller.entries["step"].inputs:
        _, mark, wanted = signal.name.partition("reference_")
        if mark:
            joined[f"pilot.{signal.name}"] = f"trajectory.{wanted}"
    return connect({"trajectory": follows, "pilot": controller}, joined, name)


@cache
def loop(
    law: str = "FSMC", which: str = "A", *, estimated: bool = True, ramp: bool = False, believed: str = "",
    read: tuple[str, ...] = READ, shaken: bool = False,
) -> ClosedLoop:  # fmt: skip
    """Return the whole scheme with a vehicle whose mass and inertias are parameters, as one block that is compiled.

    Parameters
    ----------
    law : str
        One of `LAWS`.
    which : str
        Of plant, filter and law: a key of `fsmc_quadrotor.VEHICLES`.
    estimated : bool
        Whether the law is given the estimate; else the true state.
    ramp : bool
        See `trajectory`.
    believed : str
        Of filter and law, where it is another than `which`.
    read : tuple of str
        The states that are read.
    shaken : bool
        Whether noise may be added to each state in each step, inputs ``plant_<state>_noise``.
    """
    values, own = VEHICLES[which], ("mass", "inertia_x", "inertia_y", "inertia_z")
    truth = sampled(vehicle(values=values, tunable=own, disturbed=True, seen=not estimated, read=read))
    if shaken:
        truth.step_noise(dict.fromkeys(STATES, 1e-2))
    model = VEHICLES[believed or which]
    pilot = autopilot(law, model, read=read) if estimated else control_law(law, model)
    controller = led(pilot, trajectory(ramp=ramp))
    readings: dict[str, str] = {}
    if not estimated:
        for signal in controller.entries["step"].inputs:
            state = seen_by(signal.name.removeprefix("pilot_"))
            readings |= {signal.name: f"seen_{state}"} if state else {}
    path = "pilot.law.mixer" if estimated else "pilot.mixer"
    commands = {key: f"{path}.{key}" for key in ("u1", "u2", "u3", "u4", "Om")}
    return closed_loop(
        truth, controller, hover(values), readings=readings, commands=commands, name=f"fsmc_{law.lower()}"
    )


# -- one run ----------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Flight:
    """One run of the compiled loop, in the words of `reference.fsmc.Scenario`.

    Attributes
    ----------
    steps : int
        How many, the first at t = 0.
    law, which, estimated, ramp, read
        See `loop`.
    tuning : str
        Of the filter.
    X, estimate : tuple of 12 float
        State and estimate at the start.
    d, v : array (steps, 6), optional
        Accelerations, and noise of the reading one step later; see `reference.fsmc.disturbances`. Of `v` those columns are
        taken that are read.
    params : dict
        Other parameters of the loop, such as ``plant.mass``.
    believed : str
        See `loop`.
    read : tuple of str
        The states that are read.
    w : array (steps, 12), optional
        What is added to the states in each step.
    """

    steps: int = 10000
    law: str = "FSMC"
    which: str = "A"
    estimated: bool = True
    ramp: bool = False
    tuning: str = "printed"
    X: tuple[float, ...] = (0.0,) * 12
    estimate: tuple[float, ...] = (0.0,) * 12
    d: Array | None = None
    v: Array | None = None
    params: Mapping[str, Any] | None = None
    believed: str = ""
    read: tuple[str, ...] = READ
    w: Array | None = None

    def loop(self) -> ClosedLoop:
        """Return the loop that is flown; the same one for all flights that differ in numbers only."""
        return loop(
            self.law, self.which, estimated=self.estimated, ramp=self.ramp, believed=self.believed, read=self.read,
            shaken=self.w is not None,
        )  # fmt: skip


@cache
def compiled(ring: ClosedLoop) -> Batch:
    """Return the C of a loop, compiled once."""
    return Batch(ring.text)


@cache
def _first(law: str, which: str) -> NativeView:
    return NativeView(control_law(law, VEHICLES[which]))


@cache
def _reference(ramp: bool) -> NativeView:
    return NativeView(trajectory(ramp=ramp))


def _own(params: Mapping[str, Any], part: str) -> dict[str, Any]:
    """Return the parameters of a part, as a view takes them."""
    return {
        key.removeprefix(f"{part}.").replace(".", "__"): item
        for key, item in params.items()
        if key.startswith(f"{part}.")
    }


def _pilot(flight: Flight) -> str:
    """Return where the law lies in the loop."""
    return "controller.pilot.law" if flight.estimated else "controller.pilot"


def first_step(flight: Flight) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return what the law does at t = 0, where there is no reading yet: what follows of the loop's parameters, and its outputs.

    The loop begins with the plant moved and read. What is applied until then, and where the command filters are after it, are
    parameters of the loop.
    """
    view, follows = _first(flight.law, flight.believed or flight.which), _reference(flight.ramp)
    given = flight.params or {}
    seen = dict(zip(STATES, flight.estimate if flight.estimated else flight.X, strict=True))
    course = follows.params(**_own(given, "trajectory"), count_0=0.0)
    wanted = follows.call("step", follows.init(course), follows.inputs("step", {}), course).outputs
    inputs = {}
    for signal in view.block.entries["step"].inputs:
        state, (_, mark, own) = seen_by(signal.name), signal.name.partition("reference_")
        inputs[signal.name] = wanted[own].item() if mark else seen[state]
    params = view.params(**_own(given, "law"))
    answer = view.call("step", view.init(params), view.inputs("step", inputs), params)
    if answer.status < 0:
        raise ValueError(f"the law refuses the first step ({answer.status.name}); start nearer")
    outputs = flatten(answer.outputs) | {f"trajectory.{key}": item for key, item in flatten(wanted).items()}
    pilot, memory = _pilot(flight), flatten(answer.memory)
    after: dict[str, Any] = {
        f"{pilot}.{axis}_filter.{field}_0": memory[f"{axis}_filter.{field}"].item()
        for axis in ("roll", "pitch")
        for field in ("filtered", "filtered_rate")
    }
    for key in ("u1", "u2", "u3", "u4", "Om"):
        value = outputs[f"mixer.{key}"].item()
        after[f"delay_plant_{key}_0"] = value
        if flight.estimated:
            after[f"controller.pilot.delay_estimator_{key}_0"] = value
    after[f"{pilot}.delay_attitude_Om_0"] = outputs["mixer.Om"].item()
    return after, outputs


def settings(flight: Flight) -> dict[str, Any]:
    """Return all parameters of the loop that a flight changes."""
    answer, _ = first_step(flight)
    answer |= {f"plant.{state}_0": value for state, value in zip(STATES, flight.X, strict=True)}
    if flight.estimated:
        answer |= {
            f"controller.pilot.estimator.{key}": value for key, value in tuned(flight.tuning, flight.read).items()
        }
        for state, value in zip(STATES, flight.estimate, strict=True):
            answer[f"controller.pilot.estimator.{state}_0"] = value
    places = {
        "law": _pilot(flight),
        "estimator": "controller.pilot.estimator",
        "trajectory": "controller.trajectory",
        "plant": "plant",
    }
    for key, value in (flight.params or {}).items():
        part, _, own = key.partition(".")
        answer[f"{places[part]}.{own}"] = value
    return answer


REFERENCE = (
    "roll_filter.value", "roll_filter.rate", "pitch_filter.value", "pitch_filter.rate", "trajectory.yaw",
    "trajectory.rate_yaw", "trajectory.x", "trajectory.rate_x", "trajectory.y", "trajectory.rate_y", "trajectory.z",
    "trajectory.rate_z",
)  # fmt: skip
ASKED_OF = ("altitude.u1", "attitude.u2", "attitude.u3", "attitude.u4")
APPLIED = ("mixer.u1", "mixer.u2", "mixer.u3", "mixer.u4")
SURFACES = (
    "attitude.surface_roll", "attitude.surface_pitch", "attitude.surface_yaw", "position.surface_x", "position.surface_y",
    "altitude.surface_z",
)  # fmt: skip
SWITCHING = tuple(name.replace("surface", "switching_gain") for name in SURFACES)


def _inputs(flight: Flight, batch: Batch, held: Mapping[str, float]) -> Any:
    """Return the inputs of the loop: what is constant, and the disturbances."""
    inputs = batch.inputs(flight.steps - 1)
    for name, value in held.items():
        inputs[name] = value
    if flight.d is not None:
        inputs["plant_angular_disturbance"], inputs["plant_linear_disturbance"] = flight.d[:-1, :3], flight.d[:-1, 3:]
    if flight.v is not None:
        inputs["plant_pose_noise"] = flight.v[:-1, [READ.index(state) for state in flight.read]]
    for k, state in enumerate(STATES if flight.w is not None else ()):
        assert flight.w is not None
        inputs[f"plant_{state}_noise"] = flight.w[:-1, k]
    return inputs


def fly(flight: Flight) -> Run:
    """Run the compiled loop once: everything in one C call, in the order of section 10, logged like `reference.fsmc.simulate`.

    A run is over where a call is refused: a state beyond 1e3, or no number.

    Parameters
    ----------
    flight : Flight
        What is flown.

    Returns
    -------
    Run
        At t = k DT, k = 0 .. steps - 1.
    """
    ring = flight.loop()
    batch = compiled(ring)
    _, first = first_step(flight)
    answer = batch.run(_inputs(flight, batch, ring.held), batch.params(settings(flight)))

    def column(record: Any, path: str) -> Any:
        for piece in path.split("."):
            record = record[piece]
        return record

    pilot = _pilot(flight)

    def rows(names: tuple[str, ...]) -> Array:
        later = [
            column(answer.outputs, f"controller.{n}" if n.startswith("trajectory") else f"{pilot}.{n}") for n in names
        ]
        return np.vstack([[first[n].item() for n in names], np.column_stack(later)])

    def states(prefix: str, start: tuple[float, ...]) -> Array:
        return np.vstack([start, np.column_stack([column(answer.memory, f"{prefix}.{state}") for state in STATES])])

    X = states("plant", flight.X)
    deviation = np.full((len(X), 12), np.nan)
    if flight.estimated:
        packed = np.cumsum([0, *range(12, 1, -1)])  # where the diagonal lies in the upper triangle by rows
        deviation[0] = 1.0
        deviation[1:] = np.sqrt(answer.memory["controller"]["pilot"]["estimator"]["covariance"][:, packed])
    w = np.vstack([first["mixer.speed"], column(answer.outputs, f"{pilot}.mixer.speed")])
    sines = np.abs(rows(("allocation.sine_roll", "allocation.sine_pitch")))
    most = float((flight.params or {}).get("law.allocation.limit", STEEPEST))
    return Run(
        X,
        states("controller.pilot.estimator", flight.estimate) if flight.estimated else X,
        rows(REFERENCE),
        rows(ASKED_OF),
        rows(APPLIED),
        w,
        rows(("mixer.Om",))[:, 0],
        rows(SURFACES),
        rows(SWITCHING),
        deviation,
        np.any((w <= 0) | (w >= FASTEST), axis=1),
        np.any(sines >= most, axis=1),
        None if answer.steps == flight.steps - 1 else (answer.steps + 1) * DT,
    )


fsmc_autopilot = autopilot()
