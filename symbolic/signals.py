"""Named quantities with unit, range and meaning, and the Status a call returns."""

from __future__ import annotations

import enum
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any, cast

import numpy as np

from .errors import ModelError

WIDE = 1.0e6
"""Magnitude of the default range of a signal."""

WRAPPED = 3.15
"""Range of an angle in memory: a little more than pi, because wrapping rounds."""

Interval = tuple[float, float]


class Status(enum.IntEnum):
    """What a call returns: negative refused (nothing changed), zero good, positive degraded."""

    OK = 0
    GATED = 1
    CLAMPED = 2
    SKIPPED = 3
    RECOVERED = 4
    BAD_INPUT = -1
    BAD_PARAM = -2
    NOT_POSITIVE = -3
    OVERFLOW = -4


STATUS_TEXT = {
    Status.OK: "ok",
    Status.GATED: "innovation beyond the gate: reading not used",
    Status.CLAMPED: "a value (a variance, a command) was held at its limit",
    Status.SKIPPED: "a sensor was refused and skipped: see its own status",
    Status.RECOVERED: "gated too often in a row: P inflated, reading taken without gate",
    Status.BAD_INPUT: "an input is outside its range, or not a number",
    Status.BAD_PARAM: "a parameter is outside its range, or not a number",
    Status.NOT_POSITIVE: "a variance would not be positive",
    Status.OVERFLOW: "the result would leave its range",
}


class Kind(enum.Enum):
    """How a signal is stored."""

    REAL = "real"
    FLAG = "flag"
    COUNT = "count"
    STATUS = "status"
    GROUP = "group"


@dataclass(frozen=True)
class Signal:
    """A named quantity of fixed size, as it stands in a C struct.

    Attributes
    ----------
    name : str
        Its C identifier.
    size : int
        Number of elements; 1 is a scalar.
    unit : str
        Unit as the user wrote it, or an empty string.
    low, high : tuple of float
        Range of each element, ends included.
    doc : str
        Its meaning; travels to the C header.
    kind : Kind
        Real number, flag, counter, status, or a nested group of signals.
    angle : bool
        Equal modulo two pi.
    default : tuple of float or None
        Nominal value of a parameter, initial value of a memory field.
    members : tuple of Signal
        The signals of a group.
    source : str
        Where a user declared it, ``file.py:12``; no part of the model.
    """

    name: str
    size: int = 1
    unit: str = ""
    low: tuple[float, ...] = (-WIDE,)
    high: tuple[float, ...] = (WIDE,)
    doc: str = ""
    kind: Kind = Kind.REAL
    angle: bool = False
    default: tuple[float, ...] | None = None
    members: tuple[Signal, ...] = ()
    source: str = field(default="", repr=False, compare=False)

    @property
    def uniform_range(self) -> Interval | None:
        """The range, if it is the same for all elements."""
        ends = {(a, b) for a, b in zip(self.low, self.high, strict=True)}
        return ends.pop() if len(ends) == 1 else None

    def renamed(self, name: str, doc: str | None = None) -> Signal:
        """Return the same signal under another name."""
        return replace(self, name=name, doc=self.doc if doc is None else doc)


def spread(value: float | Sequence[float], size: int) -> tuple[float, ...]:
    """Return `value` as a tuple of `size` floats."""
    flat = np.asarray(value, dtype=float).ravel()
    if flat.size == 1:
        flat = np.repeat(flat, size)
    return tuple(float(item) for item in flat)


def make_range(owner: str, what: str, given: object, default: Interval, size: int) -> tuple[tuple[float, ...], ...]:
    """Return (low, high) tuples from what a user gave as ``range=``."""
    if given is None:
        return (default[0],) * size, (default[1],) * size
    try:
        low_given, high_given = cast(tuple[Any, Any], given)
        low, high = spread(low_given, size), spread(high_given, size)
    except (TypeError, ValueError):
        raise ModelError(f"{owner}: the range of {what} is {given!r}; give it as (lowest, highest)") from None
    if len(low) != size or len(high) != size:
        raise ModelError(f"{owner}: the range of {what} has {len(low)} and {len(high)} ends for {size} elements")
    for a, b in zip(low, high, strict=True):
        if not (math.isfinite(a) and math.isfinite(b) and a < b):
            raise ModelError(f"{owner}: the range of {what} is {a:g} .. {b:g}; both ends must be finite and rising")
        if max(abs(a), abs(b)) > 1e30:
            raise ModelError(f"{owner}: the range of {what} reaches {max(abs(a), abs(b)):g}; keep it within 1e30")
    return low, high


def check_default(
    owner: str, what: str, value: object, low: tuple[float, ...], high: tuple[float, ...]
) -> tuple[float, ...]:
    """Return a default as a tuple of floats, or raise a ModelError."""
    size = len(low)
    try:
        values = spread(value, size)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        raise ModelError(f"{owner}: the value of {what} is {value!r}; give {size} number(s)") from None
    if len(values) != size:
        raise ModelError(f"{owner}: the value of {what} has {len(values)} elements, {size} are needed")
    for item, a, b in zip(values, low, high, strict=True):
        if not a <= item <= b:
            raise ModelError(
                f"{owner}: the value {item:g} of {what} is outside its range {a:g} .. {b:g}; change the value or the range"
            )
    return values


def power_of_unit(unit: str, exponent: int) -> str:
    """Return the unit raised to a power: ``rad/s`` squared is ``rad^2/s^2``, ``N m`` squared ``(N m)^2``."""
    if not unit or exponent == 1:
        return unit
    pieces = unit.split("/")
    if any(not re.fullmatch(r"[A-Za-z%]+(\^\d+)?", piece.strip()) for piece in pieces):
        return f"({unit})^{exponent}"

    def raised(piece: str) -> str:
        base, _, power = piece.strip().partition("^")
        return f"{base}^{int(power or 1) * exponent}"

    return "/".join(raised(piece) for piece in pieces)


def product_of_units(first: str, second: str) -> str:
    """Return the unit of a product; empty if either is not given."""
    if not first or not second:
        return ""
    if first == second:
        return power_of_unit(first, 2)
    return f"{first} {second}"


def same_unit(first: str, second: str) -> bool:
    """Whether two units are written alike, spaces aside; a unit not given matches any."""
    return not first or not second or first.replace(" ", "") == second.replace(" ", "")
