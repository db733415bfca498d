"""Sliding mode control as plain NumPy: the law, its switching terms, the command filter.

Ghanai, Medjghou and Chafaa, "Extended Kalman filter based states estimation of unmanned quadrotors for altitude-attitude
tracking control", AEEE 16(4), 2018; Slotine and Li, "Applied Nonlinear Control", 1991, chapter 7.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .controllers import Array, Fields, held, wrapped
from .fuzzy import Fuzzy

STEP = 1.0e-20
"""Of derivatives by complex step; its square is no number, its product with a number is one in float, too."""


@dataclass(frozen=True)
class CommandFilter:
    """q'' = omega^2 (r - q) - 2 zeta omega q' by explicit Euler; what comes out is from before the step."""

    dt: float

    def __call__(self, memory: Fields, inputs: Fields, params: Fields) -> tuple[bool, Fields, Fields]:
        """Evaluate it; see `plantc.reference.controllers.Formula`."""
        q, rate = memory["filtered"], memory["filtered_rate"]
        omega, zeta, dt = params["frequency"], params["damping"], q.dtype.type(self.dt)
        acceleration = omega * (omega * (inputs["raw"] - q) - 2 * zeta * rate)
        after = {"filtered": q + dt * rate, "filtered_rate": rate + dt * acceleration}
        return False, after, {"value": q, "rate": rate, "acceleration": acceleration}


def switching(kind: str, v: Array, system: Fuzzy | None = None) -> Array:
    """Return what takes the place of sgn(s), at v = s / width (at v = s for the sign itself)."""
    if kind == "sign":
        return np.sign(v)
    if kind == "boundary_layer":
        return np.clip(v, -1, 1)
    if kind == "tanh":
        return np.tanh(v)
    assert system is not None
    return system(v)[0].astype(v.dtype)


@dataclass(frozen=True, eq=False)
class Channel:
    """One output and the command that moves it.

    Attributes
    ----------
    name : str
        Of the state q that is the output.
    row : int
        Its place in the vector of rates; `column` that of the command among the inputs.
    angle : bool
        Whether its error is wrapped.
    kind : str
        Of `switching`; `system` is that of "fuzzy".
    floor : (low, high) or None
        What g is held within.
    limits : (low, high) or None
        What the command is held within.
    """

    name: str
    row: int
    command: str
    column: int
    angle: bool
    kind: str
    system: Fuzzy | None
    floor: tuple[float, float] | None
    limits: tuple[float, float] | None


@dataclass(frozen=True, eq=False)
class SlidingMode:
    """u = (-K sigma(s/width) - mu s - f - lambda e' + q_d'') / g, s = e' + lambda e, of q'' = f + g u.

    Attributes
    ----------
    rates : callable
        (x, u, p) -> rate of each component of the state's error; f and g come from it by complex step.
    states : tuple of (name, size, size of its error)
        Of the plant; the error of an attitude is smaller, and its rate moves no element.
    inputs : tuple of (name, size)
    params : tuple of (name, size)
    channels : tuple of Channel
        In order: a command that was found is what a later channel reckons with.
    """

    rates: Callable[..., tuple[Array, ...]]
    states: tuple[tuple[str, int, int], ...]
    inputs: tuple[tuple[str, int], ...]
    params: tuple[tuple[str, int], ...]
    channels: tuple[Channel, ...]

    def __call__(self, memory: Fields, inputs: Fields, params: Fields) -> tuple[bool, Fields, Fields]:
        """Evaluate it; see `plantc.reference.controllers.Formula`."""
        real = next(iter(inputs.values())).dtype
        x = np.concatenate([inputs.get(name, np.zeros(size, real)) for name, size, _ in self.states])
        known = [inputs.get(name, np.zeros(size, real)) for name, size in self.inputs]
        u = np.concatenate([np.zeros(0, real), *known])
        kept = [params.get(name, np.zeros(size, real)) for name, size in self.params]
        p = np.concatenate([np.zeros(0, real), *kept])
        outputs: Fields = {}
        any_held = False
        for own in self.channels:
            rate, f, g = self.split(x, u, p, own)
            if own.floor is not None:
                was_held, g = held(g, *map(real.type, own.floor))
                outputs[f"input_gain_{own.name}"] = g
                any_held = any_held or was_held
            e = inputs[own.name] - inputs[f"reference_{own.name}"]
            e = wrapped(e) if own.angle else e
            slope = rate - inputs[f"reference_rate_{own.name}"]
            coefficient, mu, K = (params[f"{word}_{own.name}"] for word in ("lambda", "mu", "gain"))
            s = slope + coefficient * e
            term = K * switching(own.kind, s if own.kind == "sign" else s / params[f"width_{own.name}"], own.system)
            command = (-term - mu * s - f - coefficient * slope + inputs[f"reference_acceleration_{own.name}"]) / g
            if own.limits is not None:
                was_held, command = held(command, *map(real.type, own.limits))
                any_held = any_held or was_held
            u[own.column] = command[0]
            outputs |= {own.command: command, f"surface_{own.name}": s, f"switching_gain_{own.name}": np.abs(term)}
        return any_held, {}, outputs

    def split(self, x: Array, u: Array, p: Array, own: Channel) -> tuple[Array, Array, Array]:
        """Return q', f and g of a channel, shape (1,): the chain rule along the rates, without and with the command."""
        complex_type = np.result_type(x.dtype, np.complex64)
        without = u.copy()
        without[own.column] = 0
        moved = without.astype(complex_type)
        moved[own.column] += 1j * STEP
        rates = self.rates(x, without, p)[0]
        per_command = np.imag(self.rates(x.astype(complex_type), moved, p)[0]) / x.dtype.type(STEP)
        f, g = (self._along(x, without, p, own.row, self._of_elements(way)) for way in (rates, per_command))
        return rates[own.row : own.row + 1], f, g

    def _of_elements(self, rates: Array) -> Array:
        """Return the rates of the state's elements; nought for an attitude, of which no output's rate may depend."""
        pieces, start = [], 0
        for _, size, of_error in self.states:
            own = rates[start : start + of_error]
            pieces.append(own if size == of_error else np.zeros(size, rates.dtype))
            start += of_error
        return np.concatenate(pieces)

    def _along(self, x: Array, u: Array, p: Array, row: int, way: Array) -> Array:
        moved = x + 1j * x.dtype.type(STEP) * way
        return np.asarray(np.imag(self.rates(moved, u, p)[0][row : row + 1]) / x.dtype.type(STEP))
