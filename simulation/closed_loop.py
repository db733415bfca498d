"""The closed loop of a plant and a controller: as one Block that is compiled, and step by step over any two Views."""

from __future__ import annotations

import ctypes
import threading
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..codegen.batch import Batch, BatchText, Room, batch_text
from ..codegen.layout import flatten
from ..codegen.views import View
from ..symbolic.analysis import OperatingPoint
from ..symbolic.block import Block
from ..symbolic.composition import Delay, connect, delay
from ..symbolic.errors import ModelError, expect
from ..symbolic.forms import packing_of
from ..symbolic.plant import Plant
from ..symbolic.program import Packing
from ..symbolic.signals import Kind, Signal
from ..symbolic.simulated import NoiseInput, noise_inputs, simulated_plant
from .metrics import History, StatePlace

Array = NDArray[np.float64]
Columns = Callable[[str], NDArray[Any]]


@dataclass(frozen=True)
class Layout:
    """Where the quantities of a run lie in the loop's memory and outputs, by dotted names.

    Attributes
    ----------
    states : tuple of StatePlace
        The plant's.
    point : tuple of float
        The set point x*.
    truth, estimate : tuple of str
        Memory fields, one for each state; `estimate` is empty if the controller keeps none.
    spread : str
        Memory field of the covariance, or of its factors; empty if there is none.
    packing : Packing or None
        Which elements that field holds.
    nis : dict of str to str
        Sensor -> output.
    commands : tuple of str
        Outputs, one for each input of the plant.
    """

    states: tuple[StatePlace, ...]
    point: tuple[float, ...]
    truth: tuple[str, ...]
    estimate: tuple[str, ...]
    spread: str
    packing: Packing | None
    nis: dict[str, str]
    commands: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class ClosedLoop:
    """A plant and a controller, connected; made by `closed_loop`.

    Attributes
    ----------
    block : Block
        The whole loop, with the parts "plant" and "controller".
    truth, controller : Block
        Its parts.
    noises : tuple of NoiseInput
        Noises of the plant; in the loop the input is called ``plant_<name>``.
    point : OperatingPoint
        The set point.
    held : dict of str to float
        Inputs of the loop that are the same in every step, such as the flags of the readings.
    layout : Layout
        Where everything lies.
    readings : dict of str to str
        Input of the controller -> the sensor that it reads.
    """

    block: Block
    truth: Block
    controller: Block
    noises: tuple[NoiseInput, ...]
    point: OperatingPoint
    held: dict[str, float]
    layout: Layout
    readings: dict[str, str]

    @cached_property
    def text(self) -> BatchText:
        """The C of the loop, with the driver that runs it."""
        return batch_text(self.block)

    def estimate_parameters(self, x: Array) -> dict[str, Array]:
        """Return the parameters with which the estimator starts at the state x."""
        starts = [f"{name}_0" for name in self.layout.estimate]
        return dict(zip(starts, self.pieces(x), strict=True)) if starts else {}

    def truth_parameters(self, x: Array) -> dict[str, Array]:
        """Return the parameters with which the plant starts at the state x."""
        return dict(zip([f"{name}_0" for name in self.layout.truth], self.pieces(x), strict=True))

    def command_parameters(self, u: Array) -> dict[str, Array]:
        """Return the parameters with which the first command is u: of every delay of a command."""
        answer, start = {}, 0
        known = {signal.name for signal in self.block.param_signals_flat()}
        for symbol in self.point.plant.inputs:
            name, value = symbol.signal.name, u[start : start + symbol.signal.size]
            start += symbol.signal.size
            answer[f"delay_plant_{name}_0"] = value
            for part in self.controller.parts:
                inner = f"controller.delay_{part}_{name}_0"
                if inner in known:
                    answer[inner] = value
        return answer

    def pieces(self, x: Array) -> list[Array]:
        """Return a state vector by states."""
        ends = np.cumsum([state.size for state in self.layout.states])
        return [x[end - state.size : end] for state, end in zip(self.layout.states, ends, strict=True)]


def closed_loop(
    plant: Plant,
    controller: Block,
    point: Mapping[Any, Any],
    *,
    readings: Mapping[str, str] | None = None,
    commands: Mapping[str, str] | None = None,
    held: Mapping[str, float] | None = None,
    name: str = "loop",
) -> ClosedLoop:
    """Connect a plant, simulated, with a controller.

    In each step the plant moves with the command of the step before, and is read; then the controller takes the readings
    and commands: x(k) = f(x(k-1), u(k-1)) + noise, z(k) = h(x(k)) + noise, u(k) = controller(z(k)).

    Parameters
    ----------
    plant : Plant
        Discrete: the truth. It need not be the plant that the controller was made for.
    controller : Block
        Has an entry `step`. An output named like an input of the plant commands it; an input named like a sensor, alone or
        behind the name of a part, gets its reading (if only one of them does, and no other input has the very name of the
        sensor or gets it by `readings`); ``has_<sensor>`` is held at true.
    point : OperatingPoint or dict
        The set point x*, u*: state or input -> value. Plant, estimate and commands start there.
    readings : dict, optional
        Input of the controller -> the sensor whose reading it gets, where the names do not say it, or say it of two.
    commands : dict, optional
        Input of the plant -> the output of the controller (dotted) that commands it, where two have its name: a law's wish, and
        what a mixer of rotors made of it.
    held : dict, optional
        Other inputs of the controller -> a constant value.
    name : str
        Name of the Block.

    Raises
    ------
    ModelError
        If an input of the plant is not commanded or is by two outputs, if two inputs of the controller are named after one
        sensor, or an input of the controller is neither wired nor held.
    """
    expect(plant, Plant, f"closed_loop {name!r}: the plant", "a discrete Plant, the truth")
    expect(controller, Block, f"closed_loop {name!r}: the controller", "a Block with an entry 'step'")
    where = OperatingPoint.at(plant, point)
    truth = simulated_plant(plant, around={**where.states, **where.inputs}, name=f"{plant.name}_truth")
    moved = _commands(controller, plant, commands or {})
    wires: dict[str, str | Delay] = {}
    for symbol, command in zip(plant.inputs, moved, strict=True):
        wires[f"plant.{symbol.signal.name}"] = delay(f"controller.{command}", where.inputs[symbol.signal.name])
    constants: dict[str, float] = {}
    given = dict(held or {})
    sensors = {sensor.signal.name: sensor.signal.size for sensor in plant.sensors}
    read = _readings(controller, sensors, readings or {}, given)
    for signal in controller.entries["step"].inputs:
        sensor = read.get(signal.name, "")
        if signal.name in given:
            constants[f"controller_{signal.name}"] = float(given.pop(signal.name))
        elif sensor:
            wires[f"controller.{signal.name}"] = f"plant.{sensor}"
        elif signal.kind is Kind.FLAG and (signal.name.startswith("has_") or "_has_" in signal.name):
            constants[f"controller_{signal.name}"] = 1.0
        else:
            raise ModelError(
                f"{controller.name}: its input {signal.name!r} is no sensor of {plant.name} ({', '.join(sensors) or 'none'}); "
                f"give it a value: held={{{signal.name!r}: ...}}"
            )
    if given:
        raise ModelError(f"{controller.name}: held= names {sorted(given)}, which are no inputs of it")
    block = connect({"plant": truth, "controller": controller}, wires, name)
    estimate = _estimate(controller, plant)
    spread, packing = _spread(controller, estimate, plant.error_size) if estimate is not None else ("", None)
    layout = Layout(
        tuple(
            StatePlace(s.signal.name, s.signal.size, "attitude" if s.attitude else "angle" if s.signal.angle else "plain")
            for s in plant.states
        ),
        tuple(float(item) for item in where.x),
        tuple(f"plant.{state.signal.name}" for state in plant.states),
        tuple(f"controller.{estimate}{state.signal.name}" for state in plant.states) if estimate is not None else (),
        spread,
        packing,
        _nis(controller, sensors),
        tuple(f"controller.{command}" for command in moved),
    )  # fmt: skip
    used = {name: sensor for name, sensor in read.items() if f"controller.{name}" in wires}
    return ClosedLoop(block, truth, controller, noise_inputs(plant), where, constants, layout, used)


def _leaves(signals: tuple[Signal, ...], prefix: str = "") -> list[Signal]:
    answer: list[Signal] = []
    for signal in signals:
        if signal.kind is Kind.GROUP:
            answer += _leaves(signal.members, f"{prefix}{signal.name}.")
        else:
            answer.append(replace(signal, name=prefix + signal.name))
    return answer


def _commands(controller: Block, plant: Plant, given: Mapping[str, str]) -> list[str]:
    """Return for each input of the plant the output of the controller that commands it."""
    if "step" not in controller.entries:
        raise ModelError(f"{controller.name}: it has no entry 'step'; a controller is called by it")
    outputs = [signal.name for signal in _leaves(controller.entries["step"].outputs)]
    names = [symbol.signal.name for symbol in plant.inputs]
    strange = sorted(set(given) - set(names))
    if strange:
        raise ModelError(
            f"{controller.name}: commands= names {strange[0]!r}, which is no input of {plant.name}; it has {', '.join(names)}"
        )
    answer = []
    for name in names:
        fits = [item for item in outputs if item.split(".")[-1] == name]
        found = [given[name]] if given.get(name) in outputs else [] if name in given else fits
        if len(found) != 1:
            wrong = f"commands= gives {given[name]!r} for it; " if name in given else ""
            raise ModelError(
                f"{controller.name}: {len(fits)} of its outputs are named {name!r}, an input of the plant; {wrong}exactly one has "
                f"to command it, and where names do not say which, commands={{{name!r}: ...}} does; the outputs are "
                f"{', '.join(outputs) or 'none'}"
            )
        answer += found
    return answer


def _readings(
    controller: Block, sensors: Mapping[str, int], readings: Mapping[str, str], held: Mapping[str, float]
) -> dict[str, str]:
    """Return input of the controller -> the sensor that it reads."""
    inputs = {signal.name: signal for signal in controller.entries["step"].inputs}
    for name, sensor in readings.items():
        if name not in inputs:
            raise ModelError(
                f"{controller.name}: readings= names {name!r}, which is no input of it; it has {', '.join(inputs)}"
            )
        if sensors.get(sensor) != inputs[name].size:
            has = ", ".join(f"{key} ({size})" for key, size in sensors.items()) or "none"
            raise ModelError(
                f"{controller.name}: readings= gives its input {name!r}, of size {inputs[name].size}, the sensor "
                f"{sensor!r}; the plant has {has}"
            )
    answer = dict(readings)
    given = {sensor: name for name, sensor in readings.items()}
    # an input with the very name of a sensor means that one, also where it is held or reads another
    taken = {name: name for name, signal in inputs.items() if _sensor_of(signal, sensors) == name}
    for name, signal in inputs.items():
        sensor = "" if name in held or name in readings else _sensor_of(signal, sensors)
        if sensor in given and sensor != name:
            raise ModelError(
                f"{controller.name}: its input {name!r} is named after the sensor {sensor!r}, which readings= gives to "
                f"{given[sensor]!r}, and may mean something else; say what it is: held={{{name!r}: ...}}, or "
                f"readings={{{name!r}: {sensor!r}}} if it is the same"
            )
        if taken.get(sensor, name) != name:
            raise ModelError(
                f"{controller.name}: its inputs {taken[sensor]!r} and {name!r} are both named after the sensor {sensor!r}, "
                f"and may mean different things; say what each reads: readings={{{taken[sensor]!r}: ..., {name!r}: {sensor!r}}}"
            )
        if sensor:
            taken[sensor], answer[name] = name, sensor
    return answer


def _sensor_of(signal: Signal, sensors: Mapping[str, int]) -> str:
    """Return the sensor that an input of a controller reads, or an empty string."""
    if signal.kind is not Kind.REAL:
        return ""
    fits = [name for name, size in sensors.items() if size == signal.size and f"_{signal.name}".endswith(f"_{name}")]
    return max(fits, key=len, default="")


def _estimate(controller: Block, plant: Plant) -> str | None:
    """Return the prefix of the memory fields of a controller that are an estimate of the plant's state, or None."""
    sizes = {signal.name: signal.size for signal in controller.memory_signals_flat()}
    first = plant.states[0].signal.name
    for name in sizes:
        prefix = name.removesuffix(first)
        if (
            f"{prefix}{first}" == name
            and (not prefix or prefix.endswith("."))
            and all(sizes.get(prefix + state.signal.name) == state.signal.size for state in plant.states)
        ):
            return prefix
    return None


def _spread(controller: Block, prefix: str, size: int) -> tuple[str, Packing | None]:
    """Return the memory field of the covariance, or of its factors, and which elements it holds."""
    for field in ("covariance", "factors"):
        packing = packing_of(controller, prefix + field)
        if packing is not None and packing.size == size:
            return f"controller.{prefix}{field}", packing
    return "", None


def _nis(controller: Block, sensors: Mapping[str, int]) -> dict[str, str]:
    found = {}
    for signal in _leaves(controller.entries["step"].outputs):
        *_, group, leaf = ["", *signal.name.split(".")]
        if leaf == "nis" and group in sensors:
            found[group] = f"controller.{signal.name}"
    return found


# ---------------------------------------------------------------------------------------------------------------------
# Running


def history_of(
    layout: Layout, memory: Columns, outputs: Columns, statuses: NDArray[np.int32], asked: int, refused: str
) -> History:
    """Return the history of a run from what recorded it.

    Parameters
    ----------
    layout : Layout
        Where everything lies.
    memory, outputs : callable
        Dotted name -> array (steps,) or (steps, size).
    statuses : int array (steps,)
        Of each step.
    asked : int
        Steps that were to be run.
    refused : str
        Status that ended the run, or empty.
    """
    steps = len(statuses)

    def stacked(columns: Columns, names: tuple[str, ...]) -> Array:
        pieces = [columns(name).reshape(steps, -1) for name in names]
        answer = np.empty((steps, sum(piece.shape[1] for piece in pieces)))
        start = 0
        for piece in pieces:
            answer[:, start : start + piece.shape[1]] = piece
            start += piece.shape[1]
        return answer

    return History(
        layout.states,
        np.array(layout.point),
        stacked(memory, layout.truth),
        stacked(memory, layout.estimate) if layout.estimate else None,
        _triangles(stacked(memory, (layout.spread,)), layout.packing) if layout.packing else None,
        layout.spread.endswith("factors"),
        {name: np.array(outputs(field), dtype=float).ravel() for name, field in layout.nis.items()},
        stacked(outputs, layout.commands),
        statuses.copy(),
        asked,
        refused,
    )


def _triangles(stored: Array, packing: Packing) -> Array:
    """Return whole upper triangles by rows, what is zero by structure included."""
    if not packing.blocks:
        return stored
    whole = Packing(packing.size)
    answer = np.zeros((len(stored), whole.count))
    answer[:, [whole.at(i, j) for i, j in packing.pairs]] = stored
    return answer


_rooms = threading.local()


def _room(batch: Batch, steps: int) -> Room:
    """Return arrays for a run, its inputs zero; each thread keeps those of its last batch."""
    kept: tuple[Batch, int, Room] | None = getattr(_rooms, "last", None)
    if kept is None or kept[0] is not batch or kept[1] != steps:
        kept = (batch, steps, batch.room(steps))
        _rooms.last = kept
    ctypes.memset(kept[2].inputs.ctypes.data, 0, kept[2].inputs.nbytes)
    return kept[2]


def run_batch(
    batch: Batch,
    layout: Layout,
    noise: Mapping[str, Array],
    steps: int,
    *,
    params: Mapping[str, Any] | None = None,
    held: Mapping[str, float] | None = None,
) -> History:
    """Run the compiled loop: one C call.

    Parameters
    ----------
    batch : Batch
        Of ``loop.text``.
    layout : Layout
        Of the loop.
    noise : dict
        Noise -> values that are added as they are, (steps, size); noises left out are zero.
    steps : int
        How many.
    params : dict, optional
        Dotted parameter of the loop -> value.
    held : dict, optional
        `ClosedLoop.held`.
    """
    room = _room(batch, steps)
    inputs = room.inputs
    for name, value in (held or {}).items():
        inputs[name] = value
    for name, values in noise.items():
        target = inputs[f"plant_{name}"]
        target[...] = np.reshape(values, target.shape)
    answer = batch.run(inputs, batch.params(dict(params or {})), room=room)
    refused = answer.status.name if answer.steps < steps else ""

    def column(records: NDArray[Any]) -> Columns:
        def at(name: str) -> NDArray[Any]:
            value = records
            for piece in name.split("."):
                value = value[piece]
            return value

        return at

    return history_of(layout, column(answer.memory), column(answer.outputs), answer.statuses, steps, refused)


def simulate(
    loop: ClosedLoop,
    plant: View,
    controller: View,
    steps: int,
    *,
    noise: Mapping[str, Array] | None = None,
    params: Mapping[str, Any] | None = None,
) -> History:
    """Run the loop call by call over any two views.

    Parameters
    ----------
    loop : ClosedLoop
        The loop.
    plant, controller : View
        Of ``loop.truth`` and ``loop.controller``: interpret, reference, native or on a target.
    steps : int
        How many.
    noise : dict, optional
        Noise -> values that are added as they are, (steps, size); noises left out are zero.
    params : dict, optional
        Dotted parameter of the loop -> value, as for the compiled loop.

    Returns
    -------
    History
        As that of the compiled loop.

    Raises
    ------
    ValueError
        If a view runs another block, or `init` refuses a parameter.
    """
    for view, block in ((plant, loop.truth), (controller, loop.controller)):
        if view.block is not block:
            raise ValueError(
                f"the view runs {view.block.name!r}, the loop has {block.name!r} there; make it of the loop's"
            )
    given = _parameters(loop, params or {})
    settings = {part: _own(view, part, given) for part, view in (("plant", plant), ("controller", controller))}
    states = {"plant": plant.init(settings["plant"]), "controller": controller.init(settings["controller"])}
    names = [symbol.signal.name for symbol in loop.point.plant.inputs]
    command = {name: given[f"delay_plant_{name}_0"] for name in names}
    sources = dict(zip(names, [item.removeprefix("controller.") for item in loop.layout.commands], strict=True))
    held = {name.removeprefix("controller_"): value for name, value in loop.held.items()}
    wired = loop.readings
    memories: list[dict[str, Any]] = []
    outputs: list[dict[str, Any]] = []
    statuses: list[int] = []
    refused = ""
    for k in range(steps):
        drawn = {name: values[k] for name, values in (noise or {}).items()}
        moved = plant.call("step", states["plant"], plant.inputs("step", {**command, **drawn}), settings["plant"])
        if moved.status < 0:
            refused = moved.status.name
            break
        readings = {name: moved.outputs[sensor] for name, sensor in wired.items()}
        inputs = controller.inputs("step", {**held, **readings})
        acted = controller.call("step", states["controller"], inputs, settings["controller"])
        if acted.status < 0:
            refused = acted.status.name
            break
        states = {"plant": moved.memory, "controller": acted.memory}
        told = flatten(acted.outputs)
        command = {name: told[source] for name, source in sources.items()}
        memories.append(_prefixed("plant.", moved.memory) | _prefixed("controller.", acted.memory))
        outputs.append(_prefixed("controller.", acted.outputs))
        statuses.append(max(int(moved.status), int(acted.status)))

    def column(records: list[dict[str, Any]]) -> Columns:
        return lambda name: np.array([record[name] for record in records], dtype=float)

    return history_of(
        loop.layout, column(memories), column(outputs), np.array(statuses, dtype=np.int32), steps, refused
    )


def _parameters(loop: ClosedLoop, changed: Mapping[str, Any]) -> dict[str, Any]:
    given: dict[str, Any] = {signal.name: signal.default for signal in loop.block.param_signals_flat()}
    unknown = sorted(set(changed) - set(given))
    if unknown:
        raise ValueError(f"{unknown[0]!r} is no parameter of the loop; it has {', '.join(given)}")
    return {**given, **changed}


def _own(view: View, part: str, given: Mapping[str, Any]) -> Any:
    prefix = f"{part}."
    own = {key.removeprefix(prefix): value for key, value in given.items() if key.startswith(prefix)}
    return view.params(**{key.replace(".", "__"): value for key, value in own.items()})


def _prefixed(prefix: str, record: Any) -> dict[str, Any]:
    return {prefix + key: value for key, value in flatten(record).items()}
