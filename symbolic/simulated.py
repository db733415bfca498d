"""The discrete plant itself as a Block: the truth of a closed loop, every noise an input."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from ..reference.simulated import SimulatedOracle
from .block import Block, Scenario
from .derivation import Derivation, Reads, Targets, plant_equations
from .discretisation import transition
from .errors import ModelError
from .plant import Plant
from .program import Entry, Place, Refuse, Statement, Within
from .signals import WIDE, Signal, Status

Array = NDArray[Any]


@dataclass(frozen=True, eq=False)
class NoiseInput:
    """An input of a simulated plant that is noise, and how a draw of it is made.

    Attributes
    ----------
    signal : Signal
        The input: its name, its size, its unit.
    covariance : array (size, size)
        Of one draw; the draws of different steps are independent. A density q enters as a value held over the step, of
        variance q/dt.
    convention : str
        In words, what the covariance is.
    """

    signal: Signal
    covariance: Array
    convention: str


def noise_inputs(plant: Plant) -> tuple[NoiseInput, ...]:
    """Return the noise inputs of `simulated_plant(plant)`, with the strengths that the plant declares.

    Parameters
    ----------
    plant : Plant
        Discrete.

    Returns
    -------
    tuple of NoiseInput
        First the plant's noises under their own names, then ``<state>_noise`` for noise per step, then
        ``<sensor>_noise`` for the noise added to a reading.

    Raises
    ------
    ModelError
        If a noise has a density and dt is an input.
    """
    made = []
    for noise in plant.noises:
        covariance, convention = noise.strength, f"{noise.signal.name}: variance per step"
        if noise.is_density:
            if not isinstance(plant.dt, float):
                raise ModelError(
                    f"{plant.name}: the noise {noise.signal.name!r} has a density, and dt is an input, so that no variance per "
                    "step is known; simulate the plant with a constant dt"
                )
            covariance = covariance / plant.dt
            convention = f"{noise.signal.name}: density / dt, held over the step"
        made.append(NoiseInput(noise.signal, covariance, convention))
    for signal in _step_noises(plant):
        variances = plant.step_variances[signal.name.removesuffix("_noise")]
        said = f"{signal.name}: variance per step, added to the state"
        made.append(NoiseInput(signal, np.diag(variances), said))
    strengths = {f"{sensor.signal.name}_noise": sensor.strength for sensor in plant.sensors}
    for signal in _reading_noises(plant):
        strength = strengths[signal.name]
        if strength is None:
            made.append(NoiseInput(signal, np.eye(signal.size), f"{signal.name}: unit variance, scaled in the plant"))
        else:
            made.append(NoiseInput(signal, strength, f"{signal.name}: variance per sample, added to the reading"))
    return tuple(made)


def _step_noises(plant: Plant) -> list[Signal]:
    signals = []
    for state in plant.states:
        name = state.signal.name
        if name in plant.step_variances:
            unit = "rad" if state.attitude else state.signal.unit
            doc = f"noise added to {name} in this step"
            signals.append(_input(f"{name}_noise", len(plant.step_variances[name]), unit, doc))
    return signals


def _reading_noises(plant: Plant) -> list[Signal]:
    signals = []
    for sensor in plant.sensors:
        name, size = sensor.signal.name, sensor.signal.size
        if sensor.strength is not None:
            signals.append(_input(f"{name}_noise", size, sensor.signal.unit, f"noise added to {name}"))
        elif sensor.variance_expression is not None:
            doc = f"noise of {name}, of unit variance: the plant scales it by the variance at its state"
            signals.append(_input(f"{name}_noise", size, "", doc))
    return signals


def _input(name: str, size: int, unit: str, doc: str) -> Signal:
    return Signal(name, size, unit, (-WIDE,) * size, (WIDE,) * size, doc)


def simulated_plant(
    plant: Plant, *, around: Mapping[Any, Any] | None = None, name: str | None = None, doc: str = ""
) -> Block:
    """Return the discrete plant as a Block: the truth of a simulation.

    `step` moves the state with the inputs of the step, x(k) = f(x(k-1), u(k), w(k)), then reads the sensors at the new
    state, z(k) = h(x(k), u(k), v(k)) + noise. Noise comes in as values that are scaled already; see `noise_inputs`.

    Parameters
    ----------
    plant : Plant
        Discrete.
    around : dict, optional
        State or input -> nominal value: default of the initial state, and where the test traces stay. Default 0.
    name : str, optional
        Name of the block; default ``<plant>_truth``.
    doc : str
        Its meaning.

    Returns
    -------
    Block
        Memory: the states. Entries `init` and `step`; inputs: the plant's, then one for each noise; outputs: a reading of
        each sensor.

    Raises
    ------
    ModelError
        If the plant is continuous, or the variance of a sensor depends on the reading.
    """
    title = doc or f'The plant "{plant.name}", simulated: every noise is an input'
    return _Simulation(plant, name or f"{plant.name}_truth", title, around or {}).build()


class _Simulation(Derivation):
    """Derives the map over one step with noise, then assembles the Block."""

    def __init__(self, plant: Plant, name: str, doc: str, around: Mapping[Any, Any]):
        Derivation(plant, name, doc, around, estimates=False)  # refuses what it refuses, in the words of the plant
        super().__init__(plant.driven_by_noise(), name, doc, around, estimates=False)
        signals = [*_step_noises(plant), *_reading_noises(plant)]
        self.added = {signal.name: ca.SX.sym(signal.name, signal.size) for signal in signals}
        self.signals = [*self.step_inputs(), *signals]

    def after(self) -> ca.SX:
        """Return the state after the step."""
        plant = self.plant
        following, _ = transition(plant)
        if not plant.step_variances:
            return following
        pieces = [
            self.added[f"{state.signal.name}_noise"]
            if state.signal.name in plant.step_variances
            else ca.SX.zeros(state.error_at.stop - state.error_at.start)
            for state in plant.states
        ]
        return plant.wrapped(plant.retract(following, ca.vertcat(*pieces)))

    def reading(self, name: str, after: ca.SX) -> ca.SX:
        """Return what a sensor reads at the state after the step."""
        plant = self.plant
        sensor = next(item for item in plant.sensors if item.signal.name == name)
        value = plant.folded(sensor.expression)
        if sensor.variance_expression is not None:
            variance = plant.folded(sensor.variance_expression)
            if ca.depends_on(variance, sensor.measurement):
                raise ModelError(
                    f"{plant.name}: the variance of the sensor {name!r} depends on its reading, so it cannot be drawn before; "
                    "simulate with a variance that depends on the state"
                )
            value = value + ca.chol(ca.densify(variance)).T @ self.added[f"{name}_noise"]
        elif sensor.strength is not None:
            value = value + self.added[f"{name}_noise"]
        return ca.SX(ca.substitute(value, plant.x, after))

    def build(self) -> Block:
        """Derive and assemble."""
        plant, block = self.plant, self.block
        block.param_signals += [symbol.signal for symbol in plant.parameters]
        self.declare_states()
        after = self.after()
        targets, names = self.next_states()
        outputs: list[tuple[ca.SX, Targets, tuple[str, ...]]] = [(after, targets, names)]
        readings = []
        for sensor in plant.sensors:
            name, size = sensor.signal.name, sensor.signal.size
            readings.append(sensor.signal)
            labels = tuple(f"read_{name}_{i}" for i in range(size))
            outputs.append((self.reading(name, after), ((Place("out", name), size),), labels))
        added = [(symbol, ((Place("in", name), symbol.numel()),)) for name, symbol in self.added.items()]
        reads: list[Reads] = [*self.step_reads(), ([s for s, _ in added], [p for _, p in added])]
        comment = ["x = f(x, u, w), then z = h(x, u, v) + noise"]
        body: list[Statement] = [self.evaluate("step", reads, outputs, comment)]
        body += [Refuse(Status.OVERFLOW, Within(Place("out", s.name), s.low, s.high)) for s in readings]
        body.append(self.judge())
        start = [*self.start_states(), *([self.judge()] if plant.has_attitude else [])]
        checked = "Start (or start again) from the parameters; every parameter is checked here."
        block.entries = {
            "init": Entry("init", (), (), tuple(start), checked, checks_params=True),
            "step": Entry(
                "step",
                tuple(self.signals),
                tuple(readings),
                tuple(body),
                "Move one step ahead, then read every sensor.",
            ),
        }
        block.equations = plant_equations(plant)
        block.notes = [*self.notes(), "Noise comes in as values scaled already."]
        block.source_hash = plant.fingerprint()
        block.check()
        self.give_oracle()
        return block

    def give_oracle(self) -> None:
        """Set the oracle and the scenario."""
        plant, block = self.plant, self.block
        used = [(sensor, tuple(plant.inputs)) for sensor in plant.sensors]
        ones = [1.0] * plant.error_size
        added = tuple((name, symbol.numel()) for name, symbol in self.added.items())
        oracle = SimulatedOracle(self.textbook_model(used, ones, ones), added)
        block.oracle = oracle
        x0, u0 = self.nominal()
        params = {signal.name: np.array(signal.default) for signal in block.param_signals}

        def calls(rng: np.random.Generator, steps: int) -> Any:
            return oracle.exercise(rng, steps, u0, params)

        def memory(rng: np.random.Generator) -> dict[str, Any]:
            return oracle.near(rng, x0)

        block.scenario = Scenario(calls, memory, gaps="dt" if isinstance(plant.dt, tuple) else "")
