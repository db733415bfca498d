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
    return bool(np.any((value > high) | (value < low))), np.minimum(np.maximum(value, low), high)


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


# -- small blocks of one signal ---------------------------------------------------------------------------------------


def saturation(memory: Fields, inputs: Fields, params: Fields) -> tuple[bool, Fields, Fields]:
    """Hold a signal between two limits."""
    was_held, limited = held(inputs["raw"], params["minimum"], params["maximum"])
    return was_held, {}, {"limited": limited}


@dataclass(frozen=True)
class RateLimiter:
    """Follow a signal no faster than `rise` and `fall` (at most zero), per second."""

    dt: float

    def __call__(self, memory: Fields, inputs: Fields, params: Fields) -> tuple[bool, Fields, Fields]:
        """Evaluate it; see `Formula`."""
        raw, last = inputs["raw"], memory["last"]
        dt = raw.dtype.type(self.dt)
        was_held, limited = held(raw, last + dt * params["fall"], last + dt * params["rise"])
        return was_held, {"last": limited}, {"limited": limited}


def trapezoid(A: Array, B: Array, stored: Array, u: Array) -> tuple[Array, Array]:
    """Return (x, following store) of x' = A x + B u by the trapezoidal rule.

    A and B are in units of half a step. What is stored is s = x + (A x + B u) of the step before; then x solves
    (I - A) x = s + B u, and the following store is 2 x - s (Zavalishin, "The Art of VA Filter Design", 2012, ch. 3).
    """
    x = np.linalg.solve(np.eye(len(A), dtype=A.dtype) - A, stored + B * u)
    return x, 2 * x - stored


@dataclass(frozen=True)
class LowPass:
    """Butterworth low-pass of first or second order, by the trapezoidal rule, its cutoff in its place (prewarped)."""

    dt: float
    order: int

    def __call__(self, memory: Fields, inputs: Fields, params: Fields) -> tuple[bool, Fields, Fields]:
        """Evaluate it; see `Formula`."""
        raw = inputs["raw"]
        real = raw.dtype.type
        g = np.tan(real(np.pi * self.dt) * params["cutoff"][0])
        if self.order == 1:
            x, after = trapezoid(np.array([[-g]]), np.array([g]), memory["smooth"], raw)
            return False, {"smooth": after}, {"filtered": x}
        damping = real(np.sqrt(2.0))
        A, B = np.array([[-damping * g, -g], [g, real(0)]]), np.array([g, real(0)])
        x, after = trapezoid(A, B, np.concatenate([memory["band"], memory["smooth"]]), raw)
        return False, {"band": after[:1], "smooth": after[1:]}, {"filtered": x[1:]}


@dataclass(frozen=True)
class Notch:
    """Band-stop (s^2 + (1 - depth) b s + 1) / (s^2 + b s + 1), s in units of the prewarped frequency.

    b is such that the band in which less than half the power passes (at depth 1) is as wide as asked for, after the
    bilinear transform: b g / (1 + g^2) = tan(pi width dt), g = tan(pi frequency dt).
    """

    dt: float

    def __call__(self, memory: Fields, inputs: Fields, params: Fields) -> tuple[bool, Fields, Fields]:
        """Evaluate it; see `Formula`."""
        raw = inputs["raw"]
        turn = raw.dtype.type(np.pi * self.dt)
        g, beta = np.tan(turn * params["frequency"][0]), np.tan(turn * params["width"][0])
        b = beta * (1 + g * g) / g
        A, B = np.array([[-b * g, -g], [g, 0 * g]]), np.array([g, 0 * g])
        x, after = trapezoid(A, B, np.concatenate([memory["band"], memory["smooth"]]), raw)
        return False, {"band": after[:1], "smooth": after[1:]}, {"filtered": raw - params["depth"] * b * x[:1]}


@dataclass(frozen=True)
class Pid:
    """The controller of Astrom and Hagglund, "Advanced PID Control", 2006, section 13.4 (back-calculation)."""

    dt: float

    def step(self, memory: Fields, inputs: Fields, params: Fields) -> tuple[bool, Fields, Fields]:
        """Give the command for a set point and a reading; see `Formula`."""
        r, y = inputs["set_point"], inputs["measured"]
        h = r.dtype.type(self.dt)
        kp, ki, kd, tf = (params[name] for name in ("proportional", "integral", "derivative", "filter_time"))
        b, c = params["set_point_weight"], params["derivative_weight"]
        change = c * (r - memory["set_point_before"]) - (y - memory["measured_before"])
        slope = tf / (tf + h) * memory["derivative_part"] + kd / (tf + h) * memory["running"] * change
        wanted = kp * (b * r - y) + memory["integral_part"] + slope
        was_held, command = held(wanted, params["minimum"], params["maximum"])
        total = memory["integral_part"] + ki * h * (r - y)
        if ki[0] != 0:
            total = total + h / params["tracking_time"] * (command - wanted)
        return was_held, self._after(r, y, total, slope), {"command": command}

    def track(self, memory: Fields, inputs: Fields, params: Fields) -> tuple[bool, Fields, Fields]:
        """Take over from somebody else: the next command will be the one applied now; see `Formula`."""
        r, y = inputs["set_point"], inputs["measured"]
        _, applied = held(inputs["applied"], params["minimum"], params["maximum"])
        total = applied - params["proportional"] * (params["set_point_weight"] * r - y)
        if params["integral"][0] == 0:
            total = 0 * total
        return False, self._after(r, y, total, 0 * total), {}

    @staticmethod
    def _after(r: Array, y: Array, total: Array, slope: Array) -> Fields:
        before = {"set_point_before": r, "measured_before": y, "running": np.ones_like(r)}
        return {**before, "integral_part": total, "derivative_part": slope}


# -- linear systems ---------------------------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class StateSpace:
    """x+ = A x + B u, y = C x + D u.

    Attributes
    ----------
    A, B, C, D : array
        Matrices.
    states, inputs, outputs : tuple of str
        Names of the elements.
    """

    A: Array
    B: Array
    C: Array
    D: Array
    states: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]

    def __call__(self, memory: Fields, inputs: Fields, params: Fields) -> tuple[bool, Fields, Fields]:
        """Evaluate it; see `Formula`."""
        u = np.concatenate([inputs[name] for name in self.inputs])
        x = np.concatenate([np.zeros(0, u.dtype), *[memory[name] for name in self.states]])
        after = self.A.astype(u.dtype) @ x + self.B.astype(u.dtype) @ u
        y = self.C.astype(u.dtype) @ x + self.D.astype(u.dtype) @ u
        following = {name: after[k : k + 1] for k, name in enumerate(self.states)}
        return False, following, {name: y[k : k + 1] for k, name in enumerate(self.outputs)}


@dataclass(frozen=True)
class Sections:
    """Rational filters of order two (or less) in a row, each as x+ = A x + B u, y = x_1 + b0 u in observer form.

    Attributes
    ----------
    sections : tuple of (numerator, denominator)
        By falling powers of z, of equal length, each denominator beginning with one.
    """

    sections: tuple[tuple[tuple[float, ...], tuple[float, ...]], ...]

    def __call__(self, memory: Fields, inputs: Fields, params: Fields) -> tuple[bool, Fields, Fields]:
        """Evaluate it; see `Formula`."""
        signal = inputs["raw"]
        real = signal.dtype.type
        following, start = [np.zeros(0, signal.dtype)], 0
        for numerator, denominator in self.sections:
            b, a = np.array(numerator, dtype=real), np.array(denominator, dtype=real)
            order = len(a) - 1
            x = memory["delays"][start : start + order] if order else np.zeros(0, signal.dtype)
            start += order
            shift = np.eye(order, k=1, dtype=real)
            y = b[0] * signal + (x[:1] if order else 0)
            following.append(shift @ x + b[1:] * signal - a[1:] * y)
            signal = y
        return False, {"delays": np.concatenate(following)} if start else {}, {"filtered": signal}
