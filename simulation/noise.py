"""Noise of a simulation: streams keyed by (seed, run, name), and what the numbers mean.

Each noise of each run has a stream of its own, so that two estimators meet the same noise, a noise more changes no other,
and a run is the same whatever ran before it, in whichever thread, on whichever machine.
"""

from __future__ import annotations

import hashlib
from collections import OrderedDict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from threading import Lock
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..symbolic.errors import ModelError
from ..symbolic.simulated import NoiseInput

Array = NDArray[np.float64]

CONVENTION = (
    "Philox(key=(seed, run), counter=(0, 0, 0, first eight bytes of SHA-256 of the name)); standard normal numbers in the "
    "order step, component; times the lower Cholesky factor of the covariance per step"
)
"""How a draw is made; it is written into every file of results."""


@dataclass(frozen=True, eq=False)
class Channel:
    """A noise as it is drawn.

    Attributes
    ----------
    name : str
        The noise.
    factor : array (size, size)
        Lower triangular; the covariance of a draw is factor factor'.
    convention : str
        What the covariance is, in words.
    """

    name: str
    factor: Array
    convention: str

    @cached_property
    def scales(self) -> Array | None:
        """The diagonal of the factor, if it is diagonal."""
        diagonal = np.diag(self.factor)
        return None if np.any(self.factor - np.diag(diagonal)) else diagonal


def stream(seed: int, run: int, name: str) -> np.random.Generator:
    """Return the stream of random numbers of a noise in a run.

    Parameters
    ----------
    seed, run : int
        0 .. 2^64 - 1; the key of the generator (Salmon et al., "Parallel random numbers: as easy as 1, 2, 3", SC 2011).
    name : str
        The noise; it sets the counter from which the stream starts.

    Raises
    ------
    ValueError
        If seed or run is not such a number.
    """
    for what, value in (("seed", seed), ("run", run)):
        if not 0 <= value < 2**64:
            raise ValueError(f"the {what} is {value}; give a whole number from 0 to 2^64 - 1")
    word = int.from_bytes(hashlib.sha256(name.encode()).digest()[:8], "little")
    key, counter = np.array([seed, run], dtype=np.uint64), np.array([0, 0, 0, word], dtype=np.uint64)
    return np.random.Generator(np.random.Philox(key=key, counter=counter))


def channels(
    inputs: Sequence[NoiseInput],
    std: Mapping[str, Any] | None = None,
    covariance: Mapping[str, Any] | None = None,
) -> tuple[Channel, ...]:
    """Return how the noises of a simulated plant are drawn.

    Parameters
    ----------
    inputs : sequence of NoiseInput
        What `noise_inputs` gave, with the strengths of the plant.
    std : dict, optional
        Name -> standard deviation of a draw, one number or one for each component, instead of the plant's.
    covariance : dict, optional
        Name -> covariance of a draw, (size, size), instead of the plant's.

    Raises
    ------
    ModelError
        If a name is no noise, or a strength is negative, indefinite or of another size.
    """
    given = {**(std or {}), **(covariance or {})}
    known = [item.signal.name for item in inputs]
    unknown = sorted(set(given) - set(known))
    if unknown:
        raise ModelError(f"{unknown[0]!r} is no noise of this plant; it has {', '.join(known) or 'none'}")
    if len(given) < len(std or {}) + len(covariance or {}):
        raise ModelError(f"{sorted(set(std or {}) & set(covariance or {}))[0]!r} has std= and covariance=; give one")
    made = []
    for item in inputs:
        name, size, convention = item.signal.name, item.signal.size, item.convention
        matrix = np.asarray(item.covariance, dtype=float)
        if name in (std or {}):
            values = np.asarray((std or {})[name], dtype=float).ravel()
            if values.size not in (1, size) or not np.all(np.isfinite(values) & (values >= 0)):
                raise ModelError(f"the std of {name!r} is {values.tolist()}; give 1 or {size} numbers, zero or more")
            matrix, convention = np.diag(np.broadcast_to(values, (size,)) ** 2), f"{name}: std per step, as given"
        elif name in (covariance or {}):
            matrix, convention = (
                np.asarray((covariance or {})[name], dtype=float),
                f"{name}: covariance per step, as given",
            )
        made.append(Channel(name, _factor(name, matrix, size), convention))
    return tuple(made)


def _factor(name: str, matrix: Array, size: int) -> Array:
    if matrix.shape != (size, size) or not np.allclose(matrix, matrix.T, rtol=1e-12, atol=0):
        raise ModelError(
            f"the covariance of {name!r} has shape {matrix.shape}; give a symmetric {size} x {size} matrix"
        )
    diagonal = np.diag(matrix)
    if not np.any(matrix - np.diag(diagonal)) and np.all(diagonal >= 0):
        return np.diag(np.sqrt(diagonal))
    try:
        return np.asarray(np.linalg.cholesky(matrix))
    except np.linalg.LinAlgError:
        raise ModelError(f"the covariance of {name!r} is not positive definite; mend the matrix") from None


class _Recent:
    """The last standard normal numbers that were drawn, up to a number of bytes: many loops meet the same noise.

    What is drawn depends on the key alone, so whether it was drawn before changes no result.
    """

    def __init__(self, most: int):
        self.most, self.bytes = most, 0
        self.arrays: OrderedDict[tuple[Any, ...], Array] = OrderedDict()
        self.lock = Lock()

    def numbers(self, seed: int, run: int, name: str, shape: tuple[int, int]) -> Array:
        """Return the first numbers of a stream, read-only."""
        key = (seed, run, name, shape)
        with self.lock:
            if key in self.arrays:
                self.arrays.move_to_end(key)
                return self.arrays[key]
        drawn = stream(seed, run, name).standard_normal(shape)
        drawn.flags.writeable = False
        with self.lock:
            if key not in self.arrays:
                self.arrays[key] = drawn
                self.bytes += drawn.nbytes
            while self.bytes > self.most:
                self.bytes -= self.arrays.popitem(last=False)[1].nbytes
        return drawn


_recent = _Recent(64 * 1024 * 1024)


def draw(channel: Channel, seed: int, run: int, steps: int) -> Array:
    """Return the noise of a run, (steps, size); of a longer run it is the beginning."""
    size = len(channel.factor)
    numbers = _recent.numbers(seed, run, channel.name, (steps, size))
    if channel.scales is not None:
        return np.asarray(numbers * channel.scales)
    answer = np.zeros((steps, size))
    for i in range(size):  # in a fixed order: a matrix product's depends on the machine
        for j in range(i + 1):
            answer[:, i] += numbers[:, j] * channel.factor[i, j]
    return answer
