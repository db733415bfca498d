"""What a filter of the textbook has to be told of a plant: names, sizes, ranges, and f and h as NumPy callables.

No derivative is among it: those come from the complex step.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]
Blocks = tuple[tuple[int, ...], ...]
Precision = Any
"""numpy.float64 or numpy.float32."""

Lowered = Callable[..., tuple[Array, ...]]
"""A callable of arrays (n,) or (n, k), real or complex, that returns a tuple of arrays."""


@dataclass(frozen=True, eq=False)
class NoiseModel:
    """A white noise: the parameter that holds its strength.

    Attributes
    ----------
    parameter : str
        Name of the parameter: its diagonal, or if `full` its upper triangle packed by rows.
    size : int
        Number of elements of the noise.
    is_density : bool
        Strength per Hz (continuous), else per step or sample.
    full : bool
        Whether elements are correlated.
    """

    parameter: str
    size: int
    is_density: bool
    full: bool


@dataclass(frozen=True, eq=False)
class StateModel:
    """A state: its field in memory, and its range there. An attitude has four elements and an error of three."""

    name: str
    size: int
    kind: Literal["plain", "angle", "attitude"]
    low: Array
    high: Array

    @property
    def error_size(self) -> int:
        """Number of components of its estimation error."""
        return 3 if self.kind == "attitude" else self.size


@dataclass(frozen=True, eq=False)
class InputModel:
    """An input or a parameter, and its range."""

    name: str
    size: int
    low: Array
    high: Array


@dataclass(frozen=True, eq=False)
class CarriedModel(InputModel):
    """An input of `predict` that memory keeps until the next one, under its name; the parameter ``<name>_0`` starts it.

    Attributes
    ----------
    of : str
        The state whose true value it is.
    """

    of: str = ""


@dataclass(frozen=True, eq=False)
class SensorModel:
    """A sensor z = h(x, u, p, v) + noise.

    Attributes
    ----------
    name, size, low, high
        The reading, its number of elements and its range.
    angle : bool
        The innovation is wrapped.
    inputs : tuple of str
        Inputs of the plant that the sensor needs.
    measure : callable
        h(x, u, p, v).
    noises : tuple of NoiseModel
        What v is made of.
    variance : str
        Parameter that holds the variance of additive noise; empty if there is none.
    full : bool
        That parameter is a packed upper triangle, else a diagonal.
    extra_variance : callable
        (x, z, u, p) -> (m, m), the part of the variance that is an expression.
    """

    name: str
    size: int
    angle: bool
    low: Array
    high: Array
    inputs: tuple[str, ...]
    measure: Lowered
    noises: tuple[NoiseModel, ...]
    variance: str
    full: bool
    extra_variance: Lowered


@dataclass(frozen=True, eq=False)
class Model:
    """A plant as a Kalman filter sees it.

    Attributes
    ----------
    states, inputs, params : tuple
        Memory fields of the estimate, inputs of `predict`, and every real parameter, with ranges.
    plant_params : tuple of str
        The parameters that are arguments of f and h.
    dynamics : callable
        f(x, u, p, w): rate of the error coordinates (an attitude's is the body's angular velocity), or, if `method` is
        "none", the next state.
    method : str
        "none", "euler", "rk4", "exact" or "tustin".
    substeps : int
        Steps of Euler or RK4 in one step.
    dt : float or (lowest, highest)
        Seconds per step; a pair makes it an input.
    noises : tuple of NoiseModel
        What w is made of.
    step_variances : tuple of str
        States that have noise added per step.
    sensors : tuple of SensorModel
        In the order in which `step` takes them.
    floor, ceiling : array
        Bounds of the variances, for each component of the error.
    blocks : tuple of tuple of int
        Components of the error that the covariance correlates; empty if it correlates all. Only these blocks are kept in
        memory; that nothing is lost is checked here, call by call.
    error_step : callable or None
        (x, u, p, memory, inputs) -> (F, G): the covariance is propagated by F P F' + G S G', S the strength of the noises;
        None where F and G are the derivatives of the dynamics.
    carried : tuple of CarriedModel
        What `error_step` reads beside the state.
    """

    states: tuple[StateModel, ...]
    inputs: tuple[InputModel, ...]
    params: tuple[InputModel, ...]
    plant_params: tuple[str, ...]
    dynamics: Lowered
    method: str
    substeps: int
    dt: float | tuple[float, float]
    noises: tuple[NoiseModel, ...]
    step_variances: tuple[str, ...]
    sensors: tuple[SensorModel, ...]
    floor: Array
    ceiling: Array
    blocks: Blocks = ()
    error_step: Callable[..., tuple[Array, Array]] | None = None
    carried: tuple[CarriedModel, ...] = ()

    @cached_property
    def error_size(self) -> int:
        """Number of components of the estimation error."""
        return sum(state.error_size for state in self.states)

    @cached_property
    def places(self) -> tuple[tuple[StateModel, slice, slice], ...]:
        """Each state with its place in the state vector and in the error vector."""
        answer, start, error_start = [], 0, 0
        for state in self.states:
            stop, error_stop = start + state.size, error_start + state.error_size
            answer.append((state, slice(start, stop), slice(error_start, error_stop)))
            start, error_start = stop, error_stop
        return tuple(answer)

    def sensor(self, name: str) -> SensorModel:
        """Return a sensor by its name."""
        return next(sensor for sensor in self.sensors if sensor.name == name)


def stack(names: Sequence[str], values: Mapping[str, Any], precision: Precision) -> Array:
    """Return named values as one vector."""
    parts = [np.asarray(values[name], dtype=precision).ravel() for name in names]
    return np.concatenate(parts) if parts else np.zeros(0, dtype=precision)


def stack_inputs(model: Model, given: Mapping[str, Any], precision: Precision) -> Array:
    """Return the input vector; an input that is not given is not used, and zero."""
    filled = {item.name: given.get(item.name, np.zeros(item.size)) for item in model.inputs}
    return stack([item.name for item in model.inputs], filled, precision)


def split_state(model: Model, x: Array) -> dict[str, Array]:
    """Return the state vector as memory fields."""
    return {state.name: x[at].copy() for state, at, _ in model.places}


class CorrelatedError(ValueError):
    """A covariance correlates what its blocks say it does not."""


def unpacked(packed: Array, blocks: Blocks = ()) -> Array:
    """Return the symmetric matrix of an upper triangle packed by rows, or of one such triangle for each block."""
    size = sum(map(len, blocks)) if blocks else int((np.sqrt(8 * len(packed) + 1) - 1) // 2)
    full, start = np.zeros((size, size), dtype=packed.dtype), 0
    for block in blocks or (tuple(range(size)),):
        count = len(block) * (len(block) + 1) // 2
        own = np.zeros((len(block),) * 2, dtype=packed.dtype)
        own[np.triu_indices(len(block))] = packed[start : start + count]
        full[np.ix_(block, block)] = own + np.triu(own, 1).T
        start += count
    return full


def packed(full: Array, blocks: Blocks = ()) -> Array:
    """Return the upper triangle of a symmetric matrix, packed by rows, or that of each block.

    Raises
    ------
    CorrelatedError
        If an element outside the blocks is not zero to rounding.
    """
    if not blocks:
        return np.asarray(full[np.triu_indices(len(full))])
    label = np.zeros(len(full), dtype=int)
    for k, block in enumerate(blocks):
        label[list(block)] = k
    sigma = np.sqrt(np.abs(np.diag(full)))
    lost = (label[:, None] != label[None, :]) & (np.abs(full) > 1e-9 * np.outer(sigma, sigma))
    if np.any(lost):
        i, j = np.argwhere(lost)[0]
        raise CorrelatedError(
            f"components {i} and {j} of the error are in different blocks, and correlated by {full[i, j]:.6g}"
        )
    return np.concatenate([full[np.ix_(block, block)][np.triu_indices(len(block))] for block in blocks])


def strength(noises: Sequence[NoiseModel], params: Mapping[str, Array], precision: Precision) -> Array:
    """Return the (block-diagonal) strength matrix of stacked noises."""
    size = sum(noise.size for noise in noises)
    matrix = np.zeros((size, size), dtype=precision)
    start = 0
    for noise in noises:
        at = slice(start, start + noise.size)
        value = params[noise.parameter]
        matrix[at, at] = unpacked(value) if noise.full else np.diag(value)
        start += noise.size
    return matrix


def correlation_pattern(noises: Sequence[NoiseModel]) -> Array:
    """Return ones where the strength matrix of stacked noises may be nonzero."""
    sizes = {noise.parameter: noise.size * (noise.size + 1) // 2 if noise.full else noise.size for noise in noises}
    ones = {name: np.ones(size) for name, size in sizes.items()}
    return strength(noises, ones, np.float64)
