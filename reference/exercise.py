"""Plausible calls of a filter: a simulated truth, its readings, and memories that a filter might have."""

from __future__ import annotations

from collections.abc import Generator, Mapping
from typing import Any

import numpy as np

from .discretisation import expected, increment, measurement_noise, process_covariance, rates, retract, wrapped
from .model import Array, Model, SensorModel, packed, split_state, stack, unpacked

Call = tuple[str, dict[str, Any]]
Calls = Generator[Call, Mapping[str, Any] | None, None]


class Exercise:
    """Sequences of calls in which a filter follows a simulated truth.

    Parameters
    ----------
    model : Model
        The plant.
    x0, u0 : array
        State and input around which everything stays.
    u_spread : array
        How far the inputs vary.
    variances : array
        Of the initial error, for each component of it.
    params : dict
        Name -> array, every parameter.
    """

    def __init__(
        self,
        model: Model,
        x0: Array,
        u0: Array,
        u_spread: Array,
        variances: Array,
        params: Mapping[str, Any],
    ):
        self.model = model
        self.x0, self.u0 = np.asarray(x0, dtype=float), np.asarray(u0, dtype=float)
        self.u_spread, self.variances = np.asarray(u_spread, dtype=float), np.asarray(variances, dtype=float)
        self.params = {name: np.asarray(value, dtype=float).ravel() for name, value in params.items()}
        self.p = stack(model.plant_params, self.params, np.float64)
        self.low = np.concatenate([state.low for state in model.states])
        self.high = np.concatenate([state.high for state in model.states])
        # an unstable plant is not followed to where the last digit of a state is as large as its sigma
        self.reach = 100 * (1 + np.abs(self.x0)) + 10 * self.per_state(np.sqrt(self.variances))

    def calls(self, rng: np.random.Generator, steps: int) -> Calls:
        """Yield `steps` calls, (entry, inputs); the first is "init", as is any after which the truth starts anew.

        Whoever closes a loop around the filter sends the inputs that the truth is moved by next, as name -> array; from
        then on every call is a step.
        """
        truth, drive, started = self.near(rng), rng.normal(size=len(self.u0)), False
        told: Mapping[str, Any] | None = None
        for _ in range(steps):
            if not started:
                told = yield "init", {}
                started = True
                continue
            drive = 0.9 * drive + np.sqrt(1 - 0.9**2) * rng.normal(size=len(drive))
            u = self.input(drive)
            kind = rng.uniform()
            if told is not None:
                applied = self.named_inputs(u)
                applied |= {name: np.ravel(told[name]) for name in applied if name in told}
                u, kind = np.concatenate([np.zeros(0), *applied.values()]), 1.0
            if kind < 0.05:
                told = yield "inflate", {"factor": np.array([rng.uniform(1.2, 1.8)])}
                continue
            inputs = self.named_inputs(u)
            readings = {sensor.name: self.reading(rng, sensor, truth, u) for sensor in self.model.sensors}
            if kind < 0.15 and readings:
                sensor = self.model.sensors[int(rng.integers(len(self.model.sensors)))]
                needed = {name: inputs[name] for name in sensor.inputs}
                told = yield f"update_{sensor.name}", {sensor.name: readings[sensor.name], **needed}
                continue
            dt = self.time_step(rng)
            following = self.moved(rng, truth, u, dt)
            if following is None:
                truth, started = self.near(rng), True
                told = yield "init", {}
                continue
            truth = following
            if isinstance(self.model.dt, tuple):
                inputs["dt"] = np.array([dt])
            inputs |= self.carried(truth)
            if kind < 0.25:
                told = yield "predict", inputs
                continue
            for sensor in self.model.sensors:
                inputs[f"has_{sensor.name}"] = np.array([1 if rng.uniform() < 0.85 else 0])
                inputs[sensor.name] = self.reading(rng, sensor, truth, u)
            told = yield "step", inputs

    def memory(self, rng: np.random.Generator) -> dict[str, Array]:
        """Return a random memory: a state near x0, any covariance up to the initial one, small counters."""
        n = self.model.error_size
        variances = np.clip(self.variances * 10 ** rng.uniform(-3, 0, n), self.model.floor, self.model.ceiling)
        factor = rng.normal(size=(n, n + 2))
        P = factor @ factor.T
        P *= np.sqrt(np.outer(variances, variances) / np.outer(np.diag(P), np.diag(P)))
        P[np.diag_indices(n)] = variances
        counters = {
            f"rejected_{sensor.name}": np.array([rng.integers(0, 3)], dtype=np.uint32) for sensor in self.model.sensors
        }
        if self.model.blocks:
            P = unpacked(
                np.concatenate([packed(P[np.ix_(block, block)]) for block in self.model.blocks]), self.model.blocks
            )
        fields = {**split_state(self.model, self.near(rng)), "covariance": packed(P, self.model.blocks), **counters}
        return fields | self.carried(self.near(rng)) if self.model.carried else fields

    def carried(self, truth: Array) -> dict[str, Array]:
        """Return what memory carries from one step to the next, of a true state."""
        return {item.name: truth[at].copy() for item in self.model.carried for at in [self.at(item.of)]}

    def at(self, name: str) -> slice:
        """Return the place of a state in the state vector."""
        return next(at for state, at, _ in self.model.places if state.name == name)

    # -- parts --------------------------------------------------------------------------------------------------------

    def per_state(self, of_error: Array) -> Array:
        """Return a number for each element of the state from one for each component of the error."""
        pieces = []
        for state, _, at in self.model.places:
            pieces.append(np.full(4, np.max(of_error[at])) if state.kind == "attitude" else of_error[at])
        return np.concatenate(pieces)

    def near(self, rng: np.random.Generator) -> Array:
        """Return a state near x0, drawn from the initial variances, at most three sigma away."""
        error = np.sqrt(self.variances) * np.clip(rng.normal(size=self.model.error_size), -3, 3)
        x = wrapped(self.model, retract(self.model, self.x0, error))
        for state, at, _ in self.model.places:
            if state.kind == "attitude":
                x[at] /= np.linalg.norm(x[at])
        return np.asarray(np.clip(x, self.low, self.high))

    def input(self, drive: Array) -> Array:
        """Return the input for a smooth random number."""
        low = np.concatenate([np.zeros(0), *[item.low for item in self.model.inputs]])
        high = np.concatenate([np.zeros(0), *[item.high for item in self.model.inputs]])
        return np.asarray(np.clip(self.u0 + self.u_spread * np.tanh(drive), low, high))

    def named_inputs(self, u: Array) -> dict[str, Any]:
        """Return the input vector by names."""
        answer, start = {}, 0
        for item in self.model.inputs:
            answer[item.name] = u[start : start + item.size].copy()
            start += item.size
        return answer

    def time_step(self, rng: np.random.Generator) -> float:
        """Return seconds to the next step."""
        if not isinstance(self.model.dt, tuple):
            return self.model.dt
        low, high = self.model.dt
        low = max(low, high / 10)
        return float(np.clip(np.exp(rng.uniform(np.log(low), np.log(high))), low, high))

    def moved(self, rng: np.random.Generator, x: Array, u: Array, dt: float) -> Array | None:
        """Return the truth one step later, or None if it left its range."""
        model = self.model
        with np.errstate(all="ignore"):
            step = np.float64(dt)
            noise = _sampled(rng, process_covariance(model, x, u, self.p, step, self.params))
            if model.method == "none":
                x = retract(model, rates(model, x, u, self.p), noise)
            else:
                x = retract(model, retract(model, x, increment(model, x, u, self.p, step)), noise)
            x = wrapped(model, x)
        inside = np.all((x >= self.low) & (x <= self.high) & (np.abs(x - self.x0) <= self.reach))
        return x if inside else None

    def reading(self, rng: np.random.Generator, sensor: SensorModel, x: Array, u: Array) -> Array:
        """Return a noisy reading; where the sensor has a gate, now and then one that is far off."""
        with np.errstate(all="ignore"):
            z = expected(sensor, x, u, self.p)
            R, _ = measurement_noise(sensor, x, z, u, self.p, self.params)
            z = z + _sampled(rng, R)
            if self.params[f"gate_{sensor.name}"][0] > 0 and rng.uniform() < 0.05:
                z = z + 30 * np.sqrt(np.abs(np.diag(R)))
        middle = np.clip(np.zeros(sensor.size), sensor.low, sensor.high)
        return np.asarray(np.clip(np.where(np.isfinite(z), z, middle), sensor.low, sensor.high))


def _sampled(rng: np.random.Generator, covariance: Array) -> Array:
    """Return a draw from N(0, covariance); the covariance may be singular.

    By the symmetric root, which is unique: eigenvectors come with a sign that differs between machines.
    """
    if not np.all(np.isfinite(covariance)):
        return np.full(len(covariance), np.nan)
    values, vectors = np.linalg.eigh(covariance)
    root = (vectors * np.sqrt(np.maximum(values, 0))) @ vectors.T
    return np.asarray(root @ rng.normal(size=len(values)))
