"""Polynomials of an exosystem's state as plain NumPy: every monomial by itself, from its exponents."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .controllers import Array, Fields, StateFeedback, wrapped


@dataclass(frozen=True)
class Polynomial:
    """One number: an offset and a sum of coefficients times monomials.

    Attributes
    ----------
    offset, coefficients : (str, int)
        Parameter that holds it, and the place of the (first) element.
    exponents : tuple of tuple of int
        A row for each monomial.
    """

    offset: tuple[str, int]
    coefficients: tuple[str, int]
    exponents: tuple[tuple[int, ...], ...]

    def value(self, w: Array, params: Fields) -> Array:
        """Return it at a point, in the precision of that point."""
        name, place = self.offset
        total, (group, first) = params[name][place], self.coefficients
        for k, exponents in enumerate(self.exponents):
            total = total + params[group][first + k] * np.prod(np.repeat(w, exponents))
        return np.asarray(total)


@dataclass(frozen=True)
class RegulatorMap:
    """x* + pi(w) and u* + gamma(w): where a plant has to be, and what keeps it there.

    Attributes
    ----------
    inputs : tuple of str
        What w consists of.
    outputs : tuple of (name, polynomials, whether it is an angle)
        A polynomial for each element.
    """

    inputs: tuple[str, ...]
    outputs: tuple[tuple[str, tuple[Polynomial, ...], bool], ...]

    def __call__(self, memory: Fields, inputs: Fields, params: Fields) -> tuple[bool, Fields, Fields]:
        """Evaluate it; see `plantc.reference.controllers.Formula`."""
        w = np.concatenate([inputs[name] for name in self.inputs])
        answer: Fields = {}
        for name, rows, angle in self.outputs:
            own = np.array([row.value(w, params) for row in rows], dtype=w.dtype)
            answer[name] = wrapped(own) if angle else own
        return False, {}, answer


@dataclass(frozen=True)
class RegulatorFeedback:
    """u = u* + gamma(w) - K (x - x* - pi(w)): state feedback whose set point moves.

    Attributes
    ----------
    maps : RegulatorMap
        The set point.
    feedback : StateFeedback
        The feedback about it.
    """

    maps: RegulatorMap
    feedback: StateFeedback

    def __call__(self, memory: Fields, inputs: Fields, params: Fields) -> tuple[bool, Fields, Fields]:
        """Evaluate it; see `plantc.reference.controllers.Formula`."""
        _, _, wanted = self.maps(memory, inputs, params)
        return self.feedback(memory, inputs, {**params, **wanted})
