"""A simulated plant as plain NumPy: the map over one step with its noise, then the readings."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from .discretisation import evaluated, expected, increment, rates, retract, wrapped
from .kalman import Status
from .model import Array, InputModel, Model, Precision, SensorModel, split_state, stack, stack_inputs

Answer = tuple[int, dict[str, Any], dict[str, Any]]


class SimulatedOracle:
    """x+ = f(x, u) + noise per step; z = h(x+, u) + noise per sample.

    Parameters
    ----------
    model : Model
        f and h; noises inside them are among its inputs.
    added : tuple of (name, size)
        Inputs that are added: ``<state>_noise`` to the error of a state, ``<sensor>_noise`` to a reading.
    """

    def __init__(self, model: Model, added: tuple[tuple[str, int], ...]):
        self.model = model
        self.added = dict(added)

    def call(
        self,
        entry: str,
        memory: Mapping[str, Any],
        inputs: Mapping[str, Any],
        params: Mapping[str, Any],
        precision: type = np.float64,
    ) -> Answer:
        """Run "init" or "step" in the given precision; returns (status, memory, outputs), empty where refused."""
        with np.errstate(all="ignore"):
            return self._init(params, precision) if entry == "init" else self._step(memory, inputs, params, precision)

    def _init(self, params: Mapping[str, Any], precision: Precision) -> Answer:
        model = self.model
        if any(_outside(params[item.name], item.low, item.high, precision) for item in model.params):
            return Status.BAD_PARAM, {}, {}
        x = stack([f"{state.name}_0" for state in model.states], params, precision)
        for state, at, _ in model.places:
            if state.kind == "attitude":
                square = np.sum(x[at] * x[at])
                if not precision(0.98) <= square <= precision(1.02):
                    return Status.BAD_PARAM, {}, {}
                x[at] = x[at] / np.sqrt(square)
        return Status.OK, split_state(model, x), {}

    def _step(
        self, memory: Mapping[str, Any], inputs: Mapping[str, Any], params: Mapping[str, Any], precision: Precision
    ) -> Answer:
        model = self.model
        limits = [*model.inputs, *(_wide(name, size) for name, size in self.added.items())]
        if isinstance(model.dt, tuple):
            limits.append(InputModel("dt", 1, np.array([model.dt[0]]), np.array([model.dt[1]])))
        if any(_outside(inputs[item.name], item.low, item.high, precision) for item in limits):
            return Status.BAD_INPUT, {}, {}
        dt = precision(np.ravel(inputs["dt"])[0] if isinstance(model.dt, tuple) else model.dt)
        x = stack([state.name for state in model.states], memory, precision)
        u, p = stack_inputs(model, inputs, precision), stack(model.plant_params, params, precision)
        if model.method == "none":
            x = rates(model, x, u, p)
        else:
            x = retract(model, x, increment(model, x, u, p, dt))
        x = wrapped(model, retract(model, wrapped(model, x), self._step_noise(inputs, precision)))
        readings = {sensor.name: self._reading(sensor, x, u, p, inputs, precision) for sensor in model.sensors}
        fields = split_state(model, x)
        judged = [(readings[sensor.name], sensor.low, sensor.high) for sensor in model.sensors]
        judged += [(fields[state.name], state.low, state.high) for state in model.states]
        if any(_outside(value, low, high, precision) for value, low, high in judged):
            return Status.OVERFLOW, {}, {}
        return Status.OK, fields, readings

    def _step_noise(self, inputs: Mapping[str, Any], precision: Precision) -> Array:
        pieces = []
        for state in self.model.states:
            name = f"{state.name}_noise"
            given = inputs[name] if state.name in self.model.step_variances else np.zeros(state.error_size)
            pieces.append(np.ravel(np.asarray(given, dtype=precision)))
        return np.concatenate(pieces)

    def _reading(
        self, sensor: SensorModel, x: Array, u: Array, p: Array, inputs: Mapping[str, Any], precision: Precision
    ) -> Array:
        value = expected(sensor, x, u, p)
        name = f"{sensor.name}_noise"
        if name not in self.added:
            return value
        noise = np.ravel(np.asarray(inputs[name], dtype=precision))
        if not sensor.variance:  # of unit variance: scaled by the variance at the state
            unread = np.zeros(sensor.size, dtype=precision)
            variance = evaluated(sensor.extra_variance, x, unread, u, p).reshape(sensor.size, sensor.size)
            if not np.all(np.isfinite(variance)) or np.any(np.linalg.eigvalsh(variance) <= 0):
                return np.full(sensor.size, np.nan, dtype=precision)
            noise = np.linalg.cholesky(variance) @ noise
        return np.asarray(value + noise)

    # -- exercise -----------------------------------------------------------------------------------------------------

    def near(self, rng: np.random.Generator, x0: Array) -> dict[str, Array]:
        """Return a state near x0, within its range."""
        model = self.model
        low = np.concatenate([state.low for state in model.states])
        high = np.concatenate([state.high for state in model.states])
        error = 0.05 * np.clip(rng.normal(size=model.error_size), -3, 3)
        return split_state(model, np.clip(wrapped(model, retract(model, x0, error)), low, high))

    def exercise(
        self, rng: np.random.Generator, steps: int, u0: Array, params: Mapping[str, Array]
    ) -> Iterator[tuple[str, dict[str, Any]]]:
        """Yield calls in which the plant moves near its start; where it is about to leave its range, it starts anew."""
        model = self.model
        nominal, start = {}, 0
        for item in model.inputs:
            nominal[item.name] = u0[start : start + item.size]
            start += item.size
        for name, size in self.added.items():
            nominal[name] = np.zeros(size)
        memory: dict[str, Any] | None = None
        for k in range(steps):
            inputs = {
                name: value + 0.01 * (1 + np.abs(value)) * np.clip(rng.normal(size=len(value)), -3, 3)
                for name, value in nominal.items()
            }
            if isinstance(model.dt, tuple):
                inputs["dt"] = np.array([rng.uniform(*model.dt)])
            if memory is None or k % 50 == 0:
                _, memory, _ = self.call("init", {}, {}, params)
                yield "init", {}
                continue
            status, memory, _ = self.call("step", memory, inputs, params)
            if status < 0:
                memory = None
            else:
                yield "step", inputs


def _wide(name: str, size: int) -> InputModel:
    return InputModel(name, size, np.full(size, -1.0e6), np.full(size, 1.0e6))


def _outside(value: Any, low: Array, high: Array, precision: Precision) -> bool:
    given = np.ravel(np.asarray(value, dtype=precision))
    return not bool(np.all((given >= low.astype(precision)) & (given <= high.astype(precision))))
