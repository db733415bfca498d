"""What functions that make small Blocks share: ranges, limits, oracles, and traces of signals that wander."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from numbers import Real
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..reference.controllers import ControllerOracle, Formula, Range
from .block import Block, Scenario
from .errors import ModelError
from .program import Compare, Element, Place, Refuse
from .signals import WIDE, Signal, Status, make_range

Array = NDArray[Any]
Calls = Callable[[Any, int], Iterator[tuple[str, dict[str, Any]]]]
Ends = tuple[float, float]


def range_of(signal: Signal) -> Range:
    """Return the range of a signal, for an oracle."""
    return Range(signal.name, signal.low, signal.high)


def finish(
    block: Block,
    formulas: Mapping[str, Formula],
    calls: Calls,
    *,
    rising: tuple[tuple[str, str], ...] = (),
    memory: Callable[[Any], dict[str, Any]] | None = None,
) -> Block:
    """Give a block its oracle and its scenario."""
    entries = {name: entry for name, entry in block.entries.items() if name != "init"}
    block.oracle = ControllerOracle(
        dict(formulas),
        tuple(range_of(signal) for signal in block.memory_signals),
        tuple(range_of(signal) for signal in block.param_signals),
        {name: tuple(range_of(signal) for signal in entry.inputs) for name, entry in entries.items()},
        {name: tuple(range_of(signal) for signal in entry.outputs) for name, entry in entries.items()},
        rising,
    )
    block.scenario = Scenario(calls, memory or (lambda rng: {}))
    return block


def matrix_of(owner: str, what: str, given: Any) -> Array:
    """Return what a user gave as a matrix of finite numbers."""
    try:
        matrix = np.atleast_2d(np.asarray(given, dtype=float))
    except (TypeError, ValueError):
        raise ModelError(f"{owner}: {what} is {given!r}; give a matrix of numbers") from None
    if matrix.ndim != 2 or not np.all(np.isfinite(matrix)):
        raise ModelError(f"{owner}: {what} is no matrix of finite numbers; mend it")
    return matrix


def vector_of(owner: str, what: str, given: Any, size: int) -> Array:
    """Return what a user gave as a vector of a size, of finite numbers."""
    try:
        vector = np.atleast_1d(np.asarray(given, dtype=float))
    except (TypeError, ValueError):
        vector = np.zeros((0, 0))
    if vector.shape != (size,) or not np.all(np.isfinite(vector)):
        found = f"has shape {vector.shape}" if vector.ndim == 1 or vector.size else f"is {given!r}"
        raise ModelError(f"{owner}: {what} {found}; give {size} finite numbers")
    return vector


def ends_of(owner: str, given: Any) -> Ends:
    """Return a range as two floats; the default is that of every signal."""
    low, high = make_range(owner, "the signal", given, (-WIDE, WIDE), 1)
    return low[0], high[0]


def is_number(value: object) -> bool:
    """Whether a value is one finite real number, Python's or NumPy's."""
    return isinstance(value, Real) and math.isfinite(value)


def seconds(owner: str, dt: Any) -> float:
    """Return a time step as a positive number of seconds."""
    if not (isinstance(dt, (int, float)) and math.isfinite(dt) and dt > 0):
        raise ModelError(f"{owner}: dt is {dt!r}; give the seconds per step as a positive number")
    return float(dt)


def declare_limits(block: Block, low: float, high: float, unit: str, ends: Ends) -> None:
    """Declare the parameters `minimum` and `maximum`."""
    if not low < high:
        raise ModelError(f"{block.name}: the limits are {low:g} and {high:g}; give the lower one first")
    block.parameter("minimum", low, unit=unit, range=ends, doc="lower limit")
    block.parameter("maximum", high, unit=unit, range=ends, doc="upper limit, not below the lower one")


def check_rising(block: Block) -> None:
    """Let `init` refuse limits in the wrong order."""
    init = block.entries["init"]
    rising = Compare(Element(Place("param", "minimum")), "<=", Element(Place("param", "maximum")))
    block.entries["init"] = replace(init, body=(*init.body, Refuse(Status.BAD_PARAM, rising)))


def middle_of(ends: Ends, widest: float = math.inf) -> Ends:
    """Return centre and half width of a range, of that part of it that is not absurdly wide."""
    low, high = (max(ends[0], -widest), min(ends[1], widest)) if ends[0] < widest and ends[1] > -widest else ends
    return 0.5 * (low + high), 0.5 * (high - low)


def spread_range(ends: Ends, factor: float) -> Ends:
    """Return a range about the same centre, wider by a factor."""
    centre, half = middle_of(ends)
    reach = rounded_up(factor * half)
    return centre - reach, centre + reach


def rounded_up(value: float) -> float:
    """Return the next number of one digit: the same on any machine, whatever its last bits."""
    if value <= 0:
        return 1.0
    power = 10.0 ** math.floor(math.log10(value))
    return float(f"{math.ceil(value / power * (1 - 1e-9)) * power:.6g}")


def wandering(ranges: Mapping[str, Ends]) -> Calls:
    """Return steps in which every input wanders over its range, smoothly."""

    def calls(rng: Any, steps: int) -> Iterator[tuple[str, dict[str, Any]]]:
        yield "init", {}
        drive = np.zeros(len(ranges))
        for _ in range(steps):
            drive = 0.8 * drive + 0.6 * rng.normal(size=len(drive))
            inputs = {}
            for (name, ends), value in zip(ranges.items(), drive, strict=True):
                centre, half = middle_of(ends)
                inputs[name] = float(np.clip(centre + half * math.tanh(value), *ends))
            yield "step", inputs

    return calls


def uniform(ranges: Mapping[str, Any]) -> Callable[[Any], dict[str, Any]]:
    """Return a memory whose fields are drawn from these ranges."""
    return lambda rng: {name: rng.uniform(*ends) for name, ends in ranges.items()}
