"""A linear observer with a constant gain, as plain NumPy."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

BAD_INPUT, BAD_PARAM, OVERFLOW, SKIPPED = -1, -2, -4, 3


@dataclass(frozen=True, eq=False)
class SteadyStateOracle:
    """x- = f(x, u); x+ = x- + K (z - h(x-)) (Anderson & Moore 1979, "Optimal Filtering", ch. 4).

    Attributes
    ----------
    states, sensors : tuple of (name, size, angle, low, high)
        Fields of the memory, readings.
    inputs : tuple of (name, size, low, high)
        Known inputs.
    params : tuple of (name, low, high)
        Everything `init` checks.
    plant_params, used : tuple of str
        Parameters that are arguments of f and h; inputs that h uses.
    f, h : callable
        (x, u, p) -> (array,).
    gain : array (n, m)
        K.
    """

    states: tuple[tuple[str, int, bool, Array, Array], ...]
    inputs: tuple[tuple[str, int, Array, Array], ...]
    sensors: tuple[tuple[str, int, bool, Array, Array], ...]
    params: tuple[tuple[str, Array, Array], ...]
    plant_params: tuple[str, ...]
    used: tuple[str, ...]
    f: Callable[..., tuple[Array, ...]]
    h: Callable[..., tuple[Array, ...]]
    gain: Array

    def split(self, x: Array) -> dict[str, Array]:
        """Return a state vector by field."""
        answer, start = {}, 0
        for name, size, *_ in self.states:
            answer[name] = x[start : start + size]
            start += size
        return answer

    def call(
        self,
        entry: str,
        memory: Mapping[str, Any],
        inputs: Mapping[str, Any],
        params: Mapping[str, Any],
        precision: Any,
    ) -> tuple[int, dict[str, Any], dict[str, Any]]:
        """Run an entry in the given precision; see `plantc.symbolic.block.Oracle`."""
        with np.errstate(all="ignore"):
            if entry == "init":
                if any(_outside(params[name], low, high, precision) for name, low, high in self.params):
                    return BAD_PARAM, {}, {}
                return 0, {name: np.asarray(params[f"{name}_0"], precision) for name, *_ in self.states}, {}
            x = np.concatenate([np.ravel(np.asarray(memory[name], precision)) for name, *_ in self.states])
            p = np.concatenate(
                [np.zeros(0, precision), *[np.ravel(np.asarray(params[n], precision)) for n in self.plant_params]]
            )
            return {"predict": self._predict, "update": self._update, "step": self._step}[entry](
                x, inputs, p, precision
            )

    def _u(self, inputs: Mapping[str, Any], precision: Any) -> Array:
        pieces = [np.ravel(np.asarray(inputs.get(n, np.zeros(size)), precision)) for n, size, *_ in self.inputs]
        return np.concatenate([np.zeros(0, precision), *pieces])

    def _judged(self, x: Array, precision: Any) -> tuple[int, dict[str, Any]]:
        fields, start = {}, 0
        for name, size, angle, low, high in self.states:
            value = x[start : start + size]
            start += size
            if angle:
                value = _wrapped(value, precision)
            if _outside(value, low, high, precision):
                return OVERFLOW, {}
            fields[name] = value
        return 0, fields

    def _predict(
        self, x: Array, inputs: Mapping[str, Any], p: Array, precision: Any
    ) -> tuple[int, dict[str, Any], dict[str, Any]]:
        if any(_outside(inputs[name], low, high, precision) for name, _, low, high in self.inputs):
            return BAD_INPUT, {}, {}
        status, fields = self._judged(self.f(x, self._u(inputs, precision), p)[0], precision)
        return status, fields, {}

    def _update(
        self, x: Array, inputs: Mapping[str, Any], p: Array, precision: Any
    ) -> tuple[int, dict[str, Any], dict[str, Any]]:
        limits = [(n, low, high) for n, _, _, low, high in self.sensors]
        limits += [(n, low, high) for n, _, low, high in self.inputs if n in self.used]
        if any(_outside(inputs[name], low, high, precision) for name, low, high in limits):
            return BAD_INPUT, {}, {}
        z = np.concatenate([np.ravel(np.asarray(inputs[name], precision)) for name, *_ in self.sensors])
        residual = z - self.h(x, self._u(inputs, precision), p)[0]
        start = 0
        for _, size, angle, *_ in self.sensors:
            if angle:
                residual[start : start + size] = _wrapped(residual[start : start + size], precision)
            start += size
        status, fields = self._judged(x + self.gain.astype(precision) @ residual, precision)
        return status, fields, {"innovation": residual} if status >= 0 else {}

    def _step(
        self, x: Array, inputs: Mapping[str, Any], p: Array, precision: Any
    ) -> tuple[int, dict[str, Any], dict[str, Any]]:
        status, fields, _ = self._predict(x, inputs, p, precision)
        if status < 0:
            return status, {}, {}
        outputs: dict[str, Any] = {"status_update": 0, "update.innovation": np.zeros(self.gain.shape[1], precision)}
        if bool(np.ravel(inputs["has_readings"])[0]):
            moved = np.concatenate([np.ravel(fields[name]) for name, *_ in self.states])
            own, after, told = self._update(moved, inputs, p, precision)
            outputs["status_update"] = own
            if own < 0:
                return SKIPPED, fields, outputs
            fields, status = after, max(status, own)
            outputs["update.innovation"] = told["innovation"]
        return status, fields, outputs

    def exercise(
        self, rng: Any, steps: int, x0: Array, u0: Array, process_std: Array, sensor_root: Array
    ) -> Iterator[tuple[str, dict[str, Any]]]:
        """Yield a plausible sequence of calls around x0 and u0."""
        yield "init", {}
        truth = x0.copy()
        p = np.concatenate([np.zeros(0), *[np.zeros(0) for _ in self.plant_params]])
        for k in range(steps):
            u = u0 + 0.01 * (1 + np.abs(u0)) * np.sin(0.1 * k)
            truth = x0 + 0.99 * (truth - x0) + process_std * rng.normal(size=len(x0))
            z = self.h(truth, u, p if not self.plant_params else np.zeros(len(self.plant_params)))[0]
            z = z + sensor_root @ rng.normal(size=len(z))
            inputs: dict[str, Any] = {}
            start = 0
            for name, size, *_ in self.inputs:
                inputs[name] = u[start : start + size]
                start += size
            start = 0
            for name, size, *_ in self.sensors:
                inputs[name] = z[start : start + size]
                start += size
            chosen = "predict" if k % 10 == 3 else "update" if k % 10 == 7 else "step"
            if chosen == "predict":
                yield chosen, {name: inputs[name] for name, *_ in self.inputs}
            elif chosen == "update":
                yield chosen, {name: inputs[name] for name in (*[n for n, *_ in self.sensors], *self.used)}
            else:
                yield chosen, {**inputs, "has_readings": k % 5 != 4}


def _wrapped(angle: Array, precision: Any) -> Array:
    turn = precision(2 * np.pi)
    return np.asarray(angle - turn * np.floor(angle / turn + precision(0.5)))


def _outside(value: Any, low: Array, high: Array, precision: Any) -> bool:
    given = np.ravel(np.asarray(value, precision))
    return not bool(np.all((given >= low.astype(precision)) & (given <= high.astype(precision))))
