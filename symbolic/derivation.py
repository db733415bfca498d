"""What every estimator derives from a Plant: its checks, the step ahead, and f and h lowered for the oracle."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from ..reference import estimators as textbook
from .block import Block
from .errors import ModelError, expect
from .expressions import equation_text, number_text, numpy_callable
from .names import name_of
from .origins import Origin
from .plant import Noise, Plant, Sensor, State, Symbol
from .program import AllOf, Assign, Compare, Element, Evaluate, Place, Refuse, Statement
from .signals import Kind, Signal, Status, spread

Array = NDArray[Any]
Targets = tuple[tuple[Place, int], ...]
Reads = tuple[Sequence[ca.SX], Sequence[Any]]


class Derivation:
    """A plant that an estimator is derived from, and the Block that is being made.

    Parameters
    ----------
    plant : Plant
        Discrete, with at least one sensor.
    name, doc : str
        Of the block.
    around : dict
        State or input (or its name) -> nominal value.

    estimates : bool
        Whether it is an estimator that is made; that needs a sensor.

    Raises
    ------
    ModelError
        If the plant is continuous, has no dynamics, no sensor, or a noise that nothing uses.
    """

    def __init__(self, plant: Plant, name: str, doc: str, around: Mapping[Any, Any], *, estimates: bool = True):
        self.plant, self.name, self.around = plant, name, around
        what = "an estimator" if estimates else "a simulated plant"
        expect(plant, Plant, f"{what}: its plant", "a discrete Plant")
        if not plant.is_discrete:
            raise ModelError(
                f"{plant.name}: {what} runs in discrete time, and this plant is continuous; give it "
                f"{plant.name}.discretise('rk4', dt=...)"
            )
        plant.dynamics_expression()
        if estimates and not plant.sensors:
            raise ModelError(f"{plant.name}: an estimator needs a sensor, and this plant has none; add sensor(...)")
        used = plant.process_noises + [noise for sensor in plant.sensors for noise in plant.sensor_noises(sensor)]
        for noise in plant.noises:
            if all(noise is not item for item in used):
                raise ModelError(
                    f"{plant.name}: the noise {noise.signal.name!r} enters neither dynamics nor sensors; use it or leave it out"
                )
        self.block = Block(name, doc=doc)
        self.block.sample_time = plant.dt if isinstance(plant.dt, float) else None
        self.noise_symbols: list[tuple[Signal, ca.SX]] = []

    def nominal(self) -> tuple[Array, Array]:
        """Return nominal state and input vectors."""
        given = {name_of(key): value for key, value in dict(self.around).items()}
        known = [*[state.symbol for state in self.plant.states], *self.plant.inputs]
        unknown = set(given) - {symbol.signal.name for symbol in known}
        if unknown:
            raise ModelError(f"{self.name}: around= names {sorted(unknown)}, which are neither states nor inputs")
        vectors = []
        for symbols in ([state.symbol for state in self.plant.states], self.plant.inputs):
            parts: list[float] = []
            for symbol in symbols:
                signal = symbol.signal
                attitude = any(state.symbol is symbol and state.attitude for state in self.plant.states)
                default = (1.0, 0.0, 0.0, 0.0) if attitude else np.clip(0.0, signal.low, signal.high)
                value = np.asarray(spread(given.get(signal.name, default), signal.size))
                if value.size != signal.size or not np.all((value >= signal.low) & (value <= signal.high)):
                    raise ModelError(
                        f"{self.name}: around= gives {value.tolist()} for {signal.name!r}, outside its range or of "
                        f"another size; its range is {signal.low[0]:g} .. {signal.high[0]:g}"
                    )
                parts += value.tolist()
            vectors.append(np.array(parts))
        return vectors[0], vectors[1]

    def declare_states(self) -> None:
        """Declare a field of the memory for each state, and the parameter it starts from."""
        plant, block = self.plant, self.block
        x0, _ = self.nominal()
        for state in plant.states:
            signal = state.signal
            doc = signal.doc or ("attitude, body to world (w, x, y, z)" if state.attitude else "")
            suffix = " (wrapped)" if signal.angle else ""
            block.memory_signals.append(Signal(**{**signal.__dict__, "doc": doc + suffix}))
            low, high = ((-math.pi,), (math.pi,)) if signal.angle else (signal.low, signal.high)
            low, high = low * (signal.size // len(low)), high * (signal.size // len(high))
            default = tuple(float(item) for item in x0[state.at])
            block.param_signals.append(
                Signal(
                    f"{signal.name}_0",
                    signal.size,
                    signal.unit,
                    low,
                    high,
                    f"initial {signal.name}",
                    default=default,
                    source=signal.source,
                )
            )

    def step_inputs(self) -> list[Signal]:
        """Return the inputs of `predict`: the plant's, and dt where it is one."""
        inputs = [symbol.signal for symbol in self.plant.inputs]
        if isinstance(self.plant.dt, tuple):
            low, high = self.plant.dt
            inputs.append(Signal("dt", 1, "s", (low,), (high,), "time since the last predict"))
        return inputs

    def step_reads(self) -> list[Reads]:
        """Return what the map over one step takes: states, inputs, parameters, and dt where it is an input."""
        dt = [self.plant.dt_symbol] if isinstance(self.plant.dt, tuple) else []
        return [
            self.state_reads(),
            self.input_reads(tuple(self.plant.inputs)),
            self.param_reads(),
            (dt, [((Place("in", "dt"), 1),)] if dt else []),  # type: ignore[list-item]
        ]

    def state_reads(self, space: str = "memory") -> tuple[list[ca.SX], list[tuple[tuple[Place, int], ...]]]:
        """Return the states as arguments of a function, and where they are read."""
        symbols = [ca.SX(state.symbol) for state in self.plant.states]
        places: list[Targets] = [
            ((Place(space, state.signal.name), state.signal.size),)  # type: ignore[arg-type]
            for state in self.plant.states
        ]
        return symbols, places

    def param_reads(self) -> tuple[list[ca.SX], list[Targets]]:
        """Return the parameters, those of noises too."""
        pairs = [(symbol.signal, ca.SX(symbol)) for symbol in self.plant.parameters] + self.noise_symbols
        return [symbol for _, symbol in pairs], [((Place("param", signal.name), signal.size),) for signal, _ in pairs]

    def input_reads(self, symbols: tuple[Symbol, ...]) -> tuple[list[ca.SX], list[Targets]]:
        """Return inputs of the plant."""
        return (
            [ca.SX(symbol) for symbol in symbols],
            [((Place("in", symbol.signal.name), symbol.signal.size),) for symbol in symbols],
        )

    def evaluate(
        self,
        name: str,
        reads: Sequence[tuple[Sequence[ca.SX], Sequence[Any]]],
        outputs: Sequence[tuple[ca.SX, Targets, tuple[str, ...]]],
        comment: list[str],
        origins: Sequence[Sequence[Origin]] = (),
    ) -> Evaluate:
        """Return the statement that evaluates (expression, where it goes, C names), refusing symbols it does not take."""
        arguments = [symbol for symbols, _ in reads for symbol in symbols]
        places = [place for _, group in reads for place in group]
        function = ca.Function(
            f"{self.block.name}_{name}", arguments, [ca.densify(value) for value, _, _ in outputs], {"allow_free": True}
        )
        if function.get_free():
            raise ModelError(f"{self.plant.name}: {name} uses {function.get_free()}, which it does not take")
        return Evaluate(
            function,
            tuple(places),
            tuple(targets for _, targets, _ in outputs),
            tuple(names for _, _, names in outputs),
            tuple(comment),
            tuple(tuple(group) for group in origins),
        )

    def next_states(self, only: Sequence[State] | None = None) -> tuple[Targets, tuple[str, ...]]:
        """Return where the next states (or some of them) go, and their names in the C."""
        states = self.plant.states if only is None else only
        targets = tuple((Place("next", state.signal.name), state.signal.size) for state in states)
        names = tuple(
            f"next_{state.signal.name}" + (f"_{i}" if state.signal.size > 1 else "")
            for state in states
            for i in range(state.signal.size)
        )
        return targets, names

    def start_states(self) -> list[Statement]:
        """Return what `init` does with the states: take them from the parameters, attitudes scaled to unit length."""
        body: list[Statement] = []
        for state in self.plant.states:
            name = state.signal.name
            if state.attitude:
                symbol = ca.SX.sym("q", 4)
                square = ca.dot(symbol, symbol)
                function = ca.Function(
                    f"{self.block.name}_normalise_{name}", [symbol], [symbol / ca.sqrt(square + 1e-20), square]
                )
                at = Place("local", f"square_{name}")
                body.append(
                    Evaluate(
                        function,
                        (((Place("param", f"{name}_0"), 4),),),
                        (((Place("next", name), 4),), ((at, 1),)),
                        (tuple(f"next_{name}_{i}" for i in range(4)), (at.name,)),
                        (f"{name} = {name}_0 scaled to unit length, from which it may be 1 % away",),
                    )
                )
                near = AllOf((Compare(Element(at), ">=", 0.98), Compare(Element(at), "<=", 1.02)))
                body.append(Refuse(Status.BAD_PARAM, near))
            else:
                body.append(Assign(Place("next", name), Place("param", f"{name}_0"), state.signal.size))
        return body

    def judge(self, only: Sequence[State] | None = None) -> Refuse:
        """Return the refusal of a state (or of some of them) outside its range."""
        states = self.plant.states if only is None else only
        return Refuse(Status.OVERFLOW, self.block.judge_memory([state.signal.name for state in states]))

    def notes(self) -> list[str]:
        """Return what the header says of constants, time step and discretisation."""
        made = self.plant.discretisation
        lines = []
        if self.plant.constants:
            named = [
                f"{c.signal.name} = {', '.join(number_text(item) for item in c.signal.default or ())}"
                + (f" {c.signal.unit}" if c.signal.unit else "")
                for c in self.plant.constants
            ]
            lines.append(f"Constants: {'; '.join(named)}.")
        if isinstance(self.plant.dt, float):
            lines.append(f"dt = {number_text(self.plant.dt)} s.")
        if made is not None:
            lines.append(
                f"Discretised by {made.method}" + (f" in {made.substeps} substeps." if made.substeps > 1 else ".")
            )
        return lines

    def textbook_model(
        self,
        readings: Sequence[tuple[Sensor, tuple[Symbol, ...]]],
        floor: Sequence[float],
        ceiling: Sequence[float],
        blocks: tuple[tuple[int, ...], ...] = (),
    ) -> textbook.Model:
        """Lower f and h, never a derivative of ours, to NumPy callables.

        Parameters
        ----------
        readings : sequence of (Sensor, inputs)
            The sensors that are used, and the inputs of the plant that each needs.
        floor, ceiling : sequence of float
            Bounds of the variances, for each component of the error.
        blocks : tuple of tuple of int
            Components of the error that the covariance correlates; empty if all.
        """
        plant = self.plant
        made = plant.discretisation
        source = made.continuous if made else plant
        x, u, p = plant.x, plant.u, plant.p
        process = ca.vertcat(ca.SX(0, 1), *[noise.symbol for noise in plant.process_noises])
        rates = plant.folded(source.dynamics_expression())
        rest = [noise.symbol for noise in plant.noises if not ca.depends_on(process, noise.symbol)]
        if rest:
            rates = ca.substitute(rates, ca.vertcat(*rest), ca.DM.zeros(ca.vertcat(*rest).numel()))
        dynamics = numpy_callable(ca.Function("dynamics", [x, u, p, process], [ca.densify(rates)]))
        if plant.independent is not None:
            dynamics = plant.independent
        sensors = [self._sensor_model(sensor, inputs) for sensor, inputs in readings]
        return textbook.Model(
            states=tuple(
                textbook.StateModel(
                    state.signal.name,
                    state.signal.size,
                    "attitude" if state.attitude else "angle" if state.signal.angle else "plain",
                    np.array(state.signal.low),
                    np.array(state.signal.high),
                )
                for state in plant.states
            ),
            inputs=tuple(
                textbook.InputModel(s.signal.name, s.signal.size, np.array(s.signal.low), np.array(s.signal.high))
                for s in plant.inputs
            ),
            params=tuple(
                textbook.InputModel(s.name, s.size, np.array(s.low), np.array(s.high))
                for s in self.block.param_signals
                if s.kind is Kind.REAL
            ),
            plant_params=tuple(symbol.signal.name for symbol in plant.parameters),
            dynamics=dynamics,
            method=made.method if made else "none",
            substeps=made.substeps if made else 1,
            dt=plant.dt if plant.dt is not None else 1.0,
            noises=tuple(noise_description(noise) for noise in plant.process_noises),
            step_variances=tuple(plant.step_variances),
            sensors=tuple(sensors),
            floor=np.array(floor),
            ceiling=np.array(ceiling),
            blocks=blocks,
        )

    def _sensor_model(self, sensor: Sensor, inputs: tuple[Symbol, ...]) -> textbook.SensorModel:
        plant = self.plant
        x, u, p = plant.x, plant.u, plant.p
        noises = plant.sensor_noises(sensor)
        v = ca.vertcat(ca.SX(0, 1), *[noise.symbol for noise in noises])
        z = ca.SX(sensor.measurement)
        h = plant.folded(sensor.expression)
        extra = sensor.variance_expression
        extra = ca.SX(sensor.signal.size, sensor.signal.size) if extra is None else plant.folded(extra)
        return textbook.SensorModel(
            name=sensor.signal.name,
            size=sensor.signal.size,
            angle=sensor.signal.angle,
            low=np.array(sensor.signal.low),
            high=np.array(sensor.signal.high),
            inputs=tuple(symbol.signal.name for symbol in inputs),
            measure=numpy_callable(ca.Function("measure", [x, u, p, v], [ca.densify(h)])),
            noises=tuple(noise_description(noise) for noise in noises),
            variance=f"variance_{sensor.signal.name}" if sensor.strength is not None else "",
            full=sensor.full,
            extra_variance=numpy_callable(ca.Function("extra", [x, z, u, p], [ca.densify(plant.without_noise(extra))])),
        )


def dynamics_equations(plant: Plant) -> list[str]:
    """Return the dynamics as text, one equation a line."""
    source = plant.discretisation.continuous if plant.discretisation else plant
    texts = equation_text(source.dynamics_expression(fold=False), plant.symbol_names())
    mark = "+" if source.is_discrete else "'"
    lines = []
    for state in plant.states:
        size = state.error_at.stop - state.error_at.start
        for i in range(size):
            name = state.signal.name if size == 1 else f"{state.signal.name}[{i}]"
            left = f"rate of {name}" if state.attitude else f"{name}{mark}"
            lines.append(f"{left} = {texts[state.error_at.start + i]}")
    return lines


def plant_equations(plant: Plant) -> list[str]:
    """Return dynamics and sensors as text, one equation a line, for the header."""
    lines = dynamics_equations(plant)
    for sensor in plant.sensors:
        size = sensor.signal.size
        for i, text in enumerate(equation_text(sensor.expression, plant.symbol_names())):
            noise = " + noise" if sensor.strength is not None or sensor.variance_expression is not None else ""
            lines.append(f"{sensor.signal.name}{'' if size == 1 else f'[{i}]'} = {text}{noise}")
    return lines


def known_sources(*sources: str) -> tuple[str, ...]:
    """Return the lines that are known, each once."""
    return tuple(dict.fromkeys(item for item in sources if item))


def noise_description(noise: Noise) -> textbook.NoiseModel:
    """Return what the oracle is told of a noise."""
    kind = "density" if noise.is_density else "variance"
    return textbook.NoiseModel(f"{kind}_{noise.signal.name}", noise.signal.size, noise.is_density, noise.full)
