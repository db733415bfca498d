"""Where an expression can be, for ranges of its symbols: interval arithmetic over its operations."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import casadi as ca
import numpy as np

from .expressions import Step, tape

Interval = tuple[float, float]
ANYWHERE: Interval = (-math.inf, math.inf)

_RISING = {
    "exp": math.exp, "sinh": math.sinh, "tanh": math.tanh, "atan": math.atan, "floor": math.floor, "ceil": math.ceil,
    "sign": lambda x: float((x > 0) - (x < 0)), "twice": lambda x: 2 * x,
}  # fmt: skip
_WITHIN: dict[str, Interval] = {"atan2": (-math.pi, math.pi), "tanh": (-1, 1), "atan": (-math.pi / 2, math.pi / 2)}
_RELATIONS = {"lt", "le", "eq", "ne", "and", "or", "not"}


def bounds(expression: ca.SX, symbols: Sequence[ca.SX], ranges: Sequence[Sequence[Interval]]) -> list[Interval]:
    """Return bounds of each element of an expression: never too tight but for rounding, often too wide.

    Parameters
    ----------
    expression : casadi.SX
        A column vector.
    symbols : sequence of casadi.SX
        Every symbol that it uses.
    ranges : sequence of sequence of (low, high)
        Of each element of each symbol.

    Examples
    --------
    >>> import casadi as ca
    >>> from plantc.symbolic.intervals import bounds
    >>> x = ca.SX.sym("x")
    >>> bounds(2 + x**2, [x], [[(-1, 3)]])
    [(2.0, 11.0)]
    """
    record = tape(ca.Function("bounded", list(symbols), [ca.densify(expression)]))
    known: list[Interval] = []
    for step in record.steps:
        if step.operation == "input":
            known.append(ranges[step.place[0]][step.place[1]])
        elif step.operation == "const":
            known.append((step.value, step.value))
        else:
            known.append(_apply(step, [known[item] for item in step.arguments]))
    return [known[item] for item in record.outputs[0]]


def _apply(step: Step, given: list[Interval]) -> Interval:
    try:
        low, high = _bounded(step, given)
    except (ValueError, OverflowError, ZeroDivisionError):
        return ANYWHERE
    return (low, high) if low <= high else ANYWHERE  # NaN, too


def _bounded(step: Step, given: list[Interval]) -> Interval:
    a = given[0]
    b = given[1] if len(given) > 1 else a
    match step.operation:
        case "add":
            return a[0] + b[0], a[1] + b[1]
        case "sub":
            return a[0] - b[1], a[1] - b[0]
        case "neg":
            return -a[1], -a[0]
        case "mul":
            return _product(a, b)
        case "div":
            return _product(a, _inverse(b))
        case "inv":
            return _inverse(a)
        case "sq":
            ends = a[0] * a[0], a[1] * a[1]
            return (0.0 if a[0] <= 0 <= a[1] else min(ends)), max(ends)
        case "fabs":
            return (0.0 if a[0] <= 0 <= a[1] else min(abs(a[0]), abs(a[1]))), max(abs(a[0]), abs(a[1]))
        case "sqrt":
            return math.sqrt(a[0]), math.sqrt(a[1])
        case "log":
            return math.log(a[0]), math.log(a[1])
        case "sin":
            return _cosine(a[0] - math.pi / 2, a[1] - math.pi / 2)
        case "cos":
            return _cosine(*a)
        case "fmin" | "minimum":
            return min(a[0], b[0]), min(a[1], b[1])
        case "fmax" | "maximum":
            return max(a[0], b[0]), max(a[1], b[1])
        case "saturation":
            lower, upper = given[1:]
            return min(max(a[0], lower[0]), upper[0]), min(max(a[1], lower[1]), upper[1])
        case "look_up" | "look_up_slope":
            return _looked_up(step.operation, a, [low for low, _ in given[1:]])
        case "if_else_zero":
            return min(b[0], 0.0), max(b[1], 0.0)
        case operation if operation in _RISING:
            least, most = _WITHIN.get(operation, ANYWHERE)
            return (
                max(least, _RISING[operation](a[0])) if math.isfinite(a[0]) else least,
                min(most, _RISING[operation](a[1])) if math.isfinite(a[1]) else most,
            )
        case operation if operation in _RELATIONS:
            return 0.0, 1.0
        case operation:
            return _WITHIN.get(operation, ANYWHERE)


def _looked_up(operation: str, x: Interval, numbers: list[float]) -> Interval:
    """Return bounds of a table, or of its slope, over an interval; the numbers are its breakpoints and values."""
    at, of = np.reshape(numbers, (2, -1))
    if operation == "look_up":
        met: list[Any] = [*np.interp(x, at, of), *of[(at >= x[0]) & (at <= x[1])]]
    else:  # a slope that is met, or a mean of two
        slopes = np.concatenate([[0.0], np.diff(of) / np.diff(at), [0.0]])
        met = [*slopes[np.searchsorted(at, x[0], side="left") : np.searchsorted(at, x[1], side="right") + 1]]
    return float(min(met)), float(max(met))


def _product(a: Interval, b: Interval) -> Interval:
    ends = [0.0 if x == 0 or y == 0 else x * y for x in a for y in b]  # an end that is infinite is never reached
    return min(ends), max(ends)


def _inverse(a: Interval) -> Interval:
    return ANYWHERE if a[0] <= 0 <= a[1] else (1 / a[1], 1 / a[0])


def _cosine(low: float, high: float) -> Interval:
    """Return bounds of a cosine: its ends, and the crests and troughs in between."""
    if not high - low < 2 * math.pi:
        return -1.0, 1.0
    ends = math.cos(low), math.cos(high)
    crest = math.floor(high / (2 * math.pi)) >= math.ceil(low / (2 * math.pi))
    trough = math.floor(high / (2 * math.pi) - 0.5) >= math.ceil(low / (2 * math.pi) - 0.5)
    return (-1.0 if trough else min(ends)), (1.0 if crest else max(ends))
