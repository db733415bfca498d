"""Controllers as plain NumPy: one formula for each entry, in the precision of the numbers it is given."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]
Fields = dict[str, Array]
Formula = Callable[[Fields, Fields, Fields], tuple[bool, Fields, Fields]]
"""(memory, inputs, parameters) -> (whether an output was held at a limit, following memory, outputs)."""

CLAMPED, BAD_INPUT, BAD_PARAM, OVERFLOW = 2, -1, -2, -4


@dataclass(frozen=True)
class Range:
    """Where a field may be."""

    name: str
    low: tuple[float, ...]
    high: tuple[float, ...]

    def holds(self, values: Mapping[str, Any], precision: Any) -> bool:
        """Whether a value is inside; the ends are rounded to the precision of the numbers. NaN is not."""
        value = np.ravel(np.asarray(values[self.name], dtype=precision))
        return bool(np.all((value >= np.asarray(self.low, precision)) & (value <= np.asarray(self.high, precision))))


@dataclass(frozen=True)
class ControllerOracle:
    """A block whose entries are formulas: judged like every other, computed by NumPy.

    Attributes
    ----------
    formulas : dict
        Entry -> formula.
    memory, params : tuple of Range
        Fields of the memory, and the parameters that `init` judges.
    inputs, outputs : dict
        Entry -> ranges.
    rising : tuple of (str, str)
        Parameters of which the first may not be above the second.
    """

    formulas: Mapping[str, Formula]
    memory: tuple[Range, ...] = ()
    params: tuple[Range, ...] = ()
    inputs: Mapping[str, tuple[Range, ...]] = field(default_factory=dict)
    outputs: Mapping[str, tuple[Range, ...]] = field(default_factory=dict)
    rising: tuple[tuple[str, str], ...] = ()

    def call(
        self,
        entry: str,
        memory: Mapping[str, Any],
        inputs: Mapping[str, Any],
        params: Mapping[str, Any],
        precision: Any,
    ) -> tuple[int, dict[str, Any], dict[str, Any]]:
        """Run an entry; see `plantc.symbolic.block.Oracle`."""
        p = {name: np.ravel(np.asarray(value, precision)) for name, value in params.items()}
        if entry == "init":
            sound = all(item.holds(p, precision) for item in self.params)
            sound = sound and all(bool(np.all(p[first] <= p[second])) for first, second in self.rising)
            return (0, {item.name: p[f"{item.name}_0"] for item in self.memory}, {}) if sound else (BAD_PARAM, {}, {})
        if not all(item.holds(inputs, precision) for item in self.inputs[entry]):
            return BAD_INPUT, {}, {}
        x = {name: np.ravel(np.asarray(value, precision)) for name, value in memory.items()}
        u = {name: np.ravel(np.asarray(value, precision)) for name, value in inputs.items()}
        with np.errstate(all="ignore"):
            held, after, outputs = self.formulas[entry](x, u, p)
        after = {**x, **after}
        sound = all(item.holds(outputs, precision) for item in self.outputs[entry])
        if not sound or not all(item.holds(after, precision) for item in self.memory):
            return OVERFLOW, {}, {}
        return CLAMPED if held else 0, after, outputs


def held(value: Array, low: Array, high: Array) -> tuple[bool, Array]:
    """Return (whether a value was beyond a limit, the value within them); NaN stays, and leaves every range."""
    limited = np.where(value > high, high, np.where(value < low, low, value))
    return bool(np.any((value > high) | (value < low))), limited


def wrapped(angle: Array) -> Array:
    """Return an angle in [-pi, pi)."""
    turn = angle.dtype.type(2 * np.pi)
    return np.asarray(np.remainder(angle + turn / 2, turn) - turn / 2)


# -- state feedback ---------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class StateFeedback:
    """u = u* - K (x - x*), an angle's deviation wrapped, that of an attitude a rotation vector.

    Attributes
    ----------
    states : tuple of (name, kind)
        Kind is "plain", "angle" or "attitude".
    inputs : tuple of (name, size, low, high)
        Of the plant: what comes out.
    saturate : bool
        Whether u is held within its range.
    """

    states: tuple[tuple[str, str], ...]
    inputs: tuple[tuple[str, int, Array, Array], ...]
    saturate: bool

    def __call__(self, memory: Fields, inputs: Fields, params: Fields) -> tuple[bool, Fields, Fields]:
        """Evaluate it; see `Formula`."""
        deviation = np.concatenate([self._deviation(kind, inputs[name], params[name]) for name, kind in self.states])
        rows = params["gain"].reshape(-1, len(deviation))
        commands: Fields = {}
        any_held, start = False, 0
        for name, size, low, high in self.inputs:
            own = params[name] - np.array([np.sum(row * deviation) for row in rows[start : start + size]])
            start += size
            if self.saturate:
                was_held, own = held(own, low.astype(own.dtype), high.astype(own.dtype))
                any_held = any_held or was_held
            commands[name] = own
        return any_held, {}, commands

    @staticmethod
    def _deviation(kind: str, value: Array, wanted: Array) -> Array:
        if kind == "angle":
            return wrapped(value - wanted)
        if kind == "attitude":
            # e with q = q* (1, e/2) to first order: twice the vector part of q*^-1 q, of the shorter way round
            scalar = np.dot(wanted, value)
            vector = wanted[0] * value[1:] - value[0] * wanted[1:] - np.cross(wanted[1:], value[1:])
            return np.asarray(2 * vector if scalar >= 0 else -2 * vector)
        return value - wanted
