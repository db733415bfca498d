"""A Mamdani fuzzy system as plain NumPy: memberships by interpolation, rules, centres of gravity."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .controllers import Fields

Array = NDArray[Any]
Corners = tuple[float, float, float, float]
"""Of a trapezoid: membership is 0 up to the first, 1 from the second to the third, 0 from the fourth on."""


def membership(x: Any, corners: Corners) -> Array:
    """Return the membership of x in a trapezoid; infinite corners make a shoulder, NaN stays NaN."""
    a, b, c, d = corners
    x = np.asarray(x, dtype=float)
    rising = np.interp(x, [a, b], [0.0, 1.0]) if np.isfinite(a) and a < b else np.where(x >= b, 1.0, 0.0)
    falling = np.interp(x, [c, d], [1.0, 0.0]) if np.isfinite(d) and c < d else np.where(x <= d, 1.0, 0.0)
    return np.where(np.isnan(x), np.nan, np.minimum(rising, falling))


def area_and_moment(corners: Corners, height: Any) -> tuple[Any, Any]:
    """Return the integrals of m(y) and y m(y) over a trapezoid cut off at a height.

    Level by level: at the level t the set reaches from L = a + t (b - a) to R = d - t (d - c), and R - L and (R^2 - L^2) / 2 are
    integrated over t.
    """
    a, b, c, d = corners
    rise, fall = b - a, d - c
    area = (d - a) * height - (rise + fall) * height**2 / 2
    moment = (d**2 - a**2) * height - (d * fall + a * rise) * height**2 + (fall**2 - rise**2) * height**3 / 3
    return area, moment / 2


def midpoints(ends: tuple[float, float], points: int) -> Array:
    """Return the middles of so many equal pieces, shape (points,)."""
    return np.linspace(*ends, 2 * points + 1)[1::2]


@dataclass(frozen=True, eq=False)
class Fuzzy:
    """What `plantc.symbolic.fuzzy.FuzzySystem` computes.

    Attributes
    ----------
    inputs : tuple of (name, low, high, sets)
        `sets` maps a label to its corners.
    outputs : tuple of (name, sets)
        `sets` maps a label to its corners, four equal ones for a singleton.
    rules : tuple of (labels in, labels out, weight)
        None among the labels in stands for any.
    join : {"product", "min"}
    defuzzify : {"centres", "centroid"}
    implication : {"min", "product"}
    aggregation : {"max", "sum"}
    points : int
        Middles of equal pieces, at which the union of the sets is integrated (`aggregation` "max").
    """

    inputs: tuple[tuple[str, float, float, Mapping[str, Corners]], ...]
    outputs: tuple[tuple[str, Mapping[str, Corners]], ...]
    rules: tuple[tuple[tuple[str | None, ...], tuple[str, ...], float], ...]
    join: str = "product"
    defuzzify: str = "centres"
    implication: str = "min"
    aggregation: str = "max"
    points: int = 101

    def strengths(self, *values: Any) -> list[Any]:
        """Return how strongly each rule fires."""
        degrees = [
            {label: membership(np.clip(value, low, high), corners) for label, corners in sets.items()}
            for value, (_, low, high, sets) in zip(values, self.inputs, strict=True)
        ]
        together = np.prod if self.join == "product" else np.min
        return [
            weight
            * together([own[label] for own, label in zip(degrees, labels, strict=True) if label is not None], axis=0)
            for labels, _, weight in self.rules
        ]

    def __call__(self, *values: Any) -> list[Array]:
        """Return the outputs for the inputs, numbers or arrays of one shape."""
        strengths = self.strengths(*values)
        answer = []
        for k, (_, sets) in enumerate(self.outputs):
            said = [(strength, sets[labels[k]]) for strength, (_, labels, _) in zip(strengths, self.rules, strict=True)]
            with np.errstate(invalid="ignore", divide="ignore"):
                if self.defuzzify == "centres":
                    answer.append(_mean([(w, w * _centre(corners)) for w, corners in said]))
                elif self.aggregation == "sum":
                    answer.append(_mean([self._cut(corners, w) for w, corners in said]))
                else:
                    answer.append(self._of_union(said, sets.values()))
        return answer

    def _cut(self, corners: Corners, strength: Any) -> tuple[Any, Any]:
        if self.implication == "product":
            area, moment = area_and_moment(corners, 1.0)
            return strength * area, strength * moment
        return area_and_moment(corners, strength)

    def _of_union(self, said: Sequence[tuple[Any, Corners]], sets: Any) -> Array:
        y = midpoints((min(item[0] for item in sets), max(item[3] for item in sets)), self.points)
        union: Any = 0.0
        for strength, corners in said:
            own, degree = np.asarray(strength)[..., None], membership(y, corners)
            union = np.maximum(union, own * degree if self.implication == "product" else np.minimum(own, degree))
        return np.asarray(np.sum(union * y, axis=-1) / np.sum(union, axis=-1))

    def step(self, memory: Fields, inputs: Fields, params: Fields) -> tuple[bool, Fields, Fields]:
        """Evaluate it as the entry of a block; see `plantc.reference.controllers.Formula`."""
        given = [inputs[name] for name, _, _, _ in self.inputs]
        outputs = self(*given)
        return False, {}, {name: y.astype(given[0].dtype) for (name, _), y in zip(self.outputs, outputs, strict=True)}


def _centre(corners: Corners) -> float:
    """Return the centre of gravity of a set."""
    area, moment = area_and_moment(corners, 1.0)
    return float(moment / area) if area > 0 else corners[0]


def _mean(pairs: Sequence[tuple[Any, Any]]) -> Array:
    return np.asarray(sum(moment for _, moment in pairs) / sum(weight for weight, _ in pairs))
