"""Fuzzy systems (Mamdani) as expressions: usable in a plant, a law or a Block, and exported as a Block of their own."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from ..reference.fuzzy import Corners, Fuzzy
from .block import Block
from .components import Ends, finish, is_number, wandering
from .errors import ModelError, expect, whole
from .names import check_name, check_unique
from .piecewise import as_expression, maximum, minimum, saturated
from .signals import WIDE, make_range

Array = NDArray[Any]

LEAST_STRENGTH = 1.0e-6
"""Sum of the rules' strengths below which a corner of the inputs counts as not covered: float divides by it."""

MOST_CORNERS = 2_000_000
"""Of the grid of the inputs' corners, at which the rules are looked at."""


@dataclass(frozen=True)
class FuzzySet:
    """A labelled trapezoid: membership rises from the first corner to the second, and falls from the third to the fourth.

    Attributes
    ----------
    label : str
    corners : tuple of four floats
        Not falling. Infinite ones make a shoulder, two equal ones in the middle a triangle.

    Examples
    --------
    >>> from plantc.symbolic.fuzzy import FuzzySet
    >>> FuzzySet.triangle("Z", -0.5, 0, 0.5).corners
    (-0.5, 0.0, 0.0, 0.5)
    >>> [item.label for item in FuzzySet.partition({"N": -1, "Z": 0, "P": 1})]
    ['N', 'Z', 'P']
    """

    label: str
    corners: Corners

    def __post_init__(self) -> None:
        try:
            corners = tuple(float(item) for item in self.corners)
        except (TypeError, ValueError):
            corners = ()
        if len(corners) != 4 or any(math.isnan(item) for item in corners) or list(corners) != sorted(corners):
            raise ModelError(
                f"the fuzzy set {self.label!r} has the corners {self.corners!r}; give four numbers that do not fall"
            )
        if not (
            math.isfinite(corners[0]) == math.isfinite(corners[1])
            and math.isfinite(corners[2]) == math.isfinite(corners[3])
        ):
            raise ModelError(
                f"the fuzzy set {self.label!r} rises or falls from infinity; give two infinite corners, or none"
            )
        if not isinstance(self.label, str) or not self.label:
            raise ModelError(f"the label of a fuzzy set is {self.label!r}; give a word")
        object.__setattr__(self, "corners", corners)

    @classmethod
    def triangle(cls, label: str, left: float, peak: float, right: float) -> FuzzySet:
        """Return a triangle: 0 at `left` and `right`, 1 at `peak`."""
        return cls(label, (left, peak, peak, right))

    @classmethod
    def trapezoid(cls, label: str, left: float, from_: float, to: float, right: float) -> FuzzySet:
        """Return a trapezoid: 1 between `from_` and `to`."""
        return cls(label, (left, from_, to, right))

    @classmethod
    def left_shoulder(cls, label: str, to: float, right: float) -> FuzzySet:
        """Return a set that is 1 up to `to`, and falls to 0 at `right`."""
        return cls(label, (-math.inf, -math.inf, to, right))

    @classmethod
    def right_shoulder(cls, label: str, left: float, from_: float) -> FuzzySet:
        """Return a set that is 0 up to `left`, and 1 from `from_` on."""
        return cls(label, (left, from_, math.inf, math.inf))

    @classmethod
    def partition(cls, peaks: Mapping[str, float]) -> tuple[FuzzySet, ...]:
        """Return triangles that reach to their neighbours' peaks, the outer ones shoulders: they sum to one everywhere.

        Parameters
        ----------
        peaks : dict
            Label -> peak, rising.
        """
        expect(peaks, Mapping, "FuzzySet.partition: peaks", "a dictionary, label -> peak")
        labels, at = list(peaks), list(peaks.values())
        if not all(map(is_number, at)):
            raise ModelError(f"the peaks of a partition are {at}; give finite numbers")
        if len(at) < 2 or not all(a < b for a, b in itertools.pairwise(at)):
            raise ModelError(f"the peaks of a partition are {at}; give two or more that rise")
        inner = [cls.triangle(labels[k], *at[k - 1 : k + 2]) for k in range(1, len(at) - 1)]
        return cls.left_shoulder(labels[0], *at[:2]), *inner, cls.right_shoulder(labels[-1], *at[-2:])


@dataclass(frozen=True)
class FuzzyInput:
    """An input of a fuzzy system.

    Attributes
    ----------
    name : str
    range : (low, high)
        The input is held within it before the rules see it; the sets have to cover it.
    sets : sequence of FuzzySet
    unit : str
    """

    name: str
    range: Ends
    sets: Sequence[FuzzySet]
    unit: str = ""

    def __post_init__(self) -> None:
        low, high = make_range(self.name, f"the fuzzy input {self.name!r}", self.range, (-WIDE, WIDE), 1)
        object.__setattr__(self, "range", (low[0], high[0]))
        object.__setattr__(self, "sets", _as_sets(self.name, self.sets, "a list of FuzzySet"))
        _check_labels(self.name, self.sets)
        for item in self.sets:
            a, b, c, d = item.corners
            if (a == b and low[0] < b) or (c == d and c < high[0]):
                raise ModelError(
                    f"{self.name}: the fuzzy set {item.label!r} has a vertical edge within {low[0]:g} .. {high[0]:g}, where the "
                    "output would jump; give the edge a width"
                )

    def corners(self) -> list[float]:
        """Return where memberships bend, within the range."""
        low, high = self.range
        return sorted({low, high, *[x for item in self.sets for x in item.corners if low < x < high]})


@dataclass(frozen=True)
class FuzzyOutput:
    """An output of a fuzzy system.

    Attributes
    ----------
    name : str
    sets : dict of label -> number, or sequence of FuzzySet
        Singletons, or sets with finite corners.
    unit : str
    """

    name: str
    sets: Any
    unit: str = ""

    def __post_init__(self) -> None:
        given = self.sets
        if isinstance(given, Mapping):
            given = [FuzzySet(label, (value,) * 4) for label, value in given.items()]
        wanted = "a dictionary, label -> number, or a list of FuzzySet"
        object.__setattr__(self, "sets", _as_sets(self.name, given, wanted))
        _check_labels(self.name, self.sets)
        for item in self.sets:
            if not all(math.isfinite(x) for x in item.corners):
                raise ModelError(
                    f"{self.name}: the set {item.label!r} of an output reaches to infinity, where no centre of gravity is; "
                    "give finite corners"
                )

    @property
    def ends(self) -> Ends:
        """The least and the greatest corner."""
        return min(item.corners[0] for item in self.sets), max(item.corners[3] for item in self.sets)


@dataclass(frozen=True)
class FuzzySystem:
    """A Mamdani fuzzy system: memberships of the inputs, rules, a centre of gravity for each output.

    Attributes
    ----------
    inputs : FuzzyInput or sequence of FuzzyInput
    outputs : FuzzyOutput or sequence of FuzzyOutput
    rules : sequence of (label or labels in, label or labels out) or (..., ..., weight)
        A label for each input (None for any) and for each output; the weight, default 1, is in (0, 1].
    join : {"product", "min"}
        How the memberships of several inputs make the strength of a rule.
    defuzzify : {"centres", "centroid"}
        "centres": mean of the centres of gravity of the rules' output sets, weighted by the strengths (eq. 23 of Ghanai
        et al., AEEE 16(4), 2018; with singletons it is zero-order Takagi-Sugeno). "centroid": centre of gravity of the
        output sets after `implication`, taken together by `aggregation`.
    implication : {"min", "product"}
        Whether a rule cuts its output set off at its strength, or scales it by it.
    aggregation : {"max", "sum"}
        Whether the sets make a union, which is integrated at the middles of `points` equal pieces, or are summed, which is exact.
    points : int

    Raises
    ------
    ModelError
        If a label is not known, a set is out of shape, or the rules leave a place of the inputs' ranges without an answer:
        the sum of strengths, by which the output is divided, is at its least on a corner of the sets, and is judged there.

    Examples
    --------
    >>> from plantc.symbolic.fuzzy import FuzzyInput, FuzzyOutput, FuzzySet, FuzzySystem
    >>> error = FuzzyInput("error", (-1, 1), FuzzySet.partition({"N": -1, "Z": 0, "P": 1}))
    >>> gain = FuzzyOutput("gain", {"low": 0.2, "high": 1.0})
    >>> system = FuzzySystem(error, gain, [("N", "high"), ("Z", "low"), ("P", "high")])
    >>> float(system(0.5)), float(system(-3))
    (0.6, 1.0)
    """

    inputs: Any
    outputs: Any
    rules: Any
    join: Literal["product", "min"] = "product"
    defuzzify: Literal["centres", "centroid"] = "centres"
    implication: Literal["min", "product"] = "min"
    aggregation: Literal["max", "sum"] = "max"
    points: int = 101
    least_strength: float = field(init=False, repr=False, default=0.0)

    def __post_init__(self) -> None:
        for what, kind in (("inputs", FuzzyInput), ("outputs", FuzzyOutput)):
            given = getattr(self, what)
            given = (given,) if isinstance(given, kind) else given
            wanted = f"a {kind.__name__}, or a list of them"
            expect(given, (list, tuple), f"FuzzySystem: {what}", wanted)
            for item in given:
                expect(item, kind, f"FuzzySystem: one of the {what}", wanted)
            object.__setattr__(self, what, tuple(given))
        check_unique(
            [(item.name, f"the signal {item.name!r}") for item in (*self.inputs, *self.outputs)], "FuzzySystem"
        )
        for item in (*self.inputs, *self.outputs):
            check_name("signal", item.name, "FuzzySystem")
        words = {
            "join": ("product", "min"), "defuzzify": ("centres", "centroid"), "implication": ("min", "product"),
            "aggregation": ("max", "sum"),
        }  # fmt: skip
        for what, known in words.items():
            if getattr(self, what) not in known:
                raise ModelError(f"FuzzySystem: {what} is {getattr(self, what)!r}; give one of {', '.join(known)}")
        whole(self.points, "FuzzySystem: points", 3, 10_001)
        expect(self.rules, (list, tuple), "FuzzySystem: rules", "a list of (labels in, labels out)")
        object.__setattr__(self, "rules", tuple(self._rule(item) for item in self.rules))
        self._check_rules()
        self._check_areas()
        object.__setattr__(self, "least_strength", self._check_cover())

    # -- judging ------------------------------------------------------------------------------------------------------

    def _rule(self, given: Any) -> tuple[tuple[str | None, ...], tuple[str, ...], float]:
        """Return a rule as labels in, labels out, weight."""
        if not isinstance(given, (tuple, list)) or len(given) not in (2, 3):
            raise ModelError(
                f"FuzzySystem: the rule {given!r} is no (labels in, labels out) with or without a weight; mend it"
            )
        sides = []
        for what, side, signals in (("input", given[0], self.inputs), ("output", given[1], self.outputs)):
            labels = tuple(side) if isinstance(side, (list, tuple)) else (side,)
            if len(labels) != len(signals):
                raise ModelError(
                    f"FuzzySystem: the rule {given!r} has {len(labels)} label(s) for {len(signals)} {what}(s); give one for each"
                )
            for label, signal in zip(labels, signals, strict=True):
                known = [item.label for item in signal.sets]
                if label not in known and (label is not None or what == "output"):
                    raise ModelError(
                        f"FuzzySystem: the rule {given!r} says {label!r} of {signal.name!r}, whose labels are {', '.join(known)}; "
                        "use one of them"
                    )
            sides.append(labels)
        weight = given[2] if len(given) == 3 else 1.0
        if not is_number(weight) or not 0 < weight <= 1:
            raise ModelError(
                f"FuzzySystem: the weight of the rule {given!r} is {weight!r}; give more than 0 and at most 1"
            )
        return sides[0], sides[1], float(weight)

    def _check_rules(self) -> None:
        if not self.inputs or not self.outputs or not self.rules:
            raise ModelError("FuzzySystem: it has no input, no output or no rule; give one of each at least")
        said: set[tuple[str | None, ...]] = set()
        for labels, _, _ in self.rules:
            if labels in said:
                raise ModelError(f"FuzzySystem: two rules are about {labels!r}; keep one of them")
            said.add(labels)
        for k, item in enumerate(self.inputs):
            if all(labels[k] is None for labels, _, _ in self.rules):
                raise ModelError(
                    f"FuzzySystem: no rule asks for {item.name!r}; leave that input out, or use it in a rule"
                )

    def _check_areas(self) -> None:
        """With centroids, every set has an area that is seen."""
        if self.defuzzify == "centres":
            return
        for output in self.outputs:
            samples = midpoints(output.ends, self.points)
            for item in output.sets:
                a, _, _, d = item.corners
                seen = self.aggregation == "sum" or np.any((samples > a) & (samples < d))
                if a == d or not seen:
                    raise ModelError(
                        f"FuzzySystem: the set {item.label!r} of {output.name!r} has no area (or none of the {self.points} points "
                        "is inside); widen it, give more points, or use defuzzify='centres'"
                    )

    def _check_cover(self) -> float:
        """Return the least sum of strengths: it is concave or multilinear between corners, so a corner has it."""
        axes = [item.corners() for item in self.inputs]
        if math.prod(map(len, axes)) > MOST_CORNERS:
            raise ModelError(
                f"FuzzySystem: {len(axes)} inputs have {math.prod(map(len, axes))} combinations of corners, too many to look at; "
                "split it into systems of fewer inputs"
            )
        grid = np.meshgrid(*axes, indexing="ij")
        total: Any = sum(self.reference().strengths(*grid))
        at = np.unravel_index(int(np.argmin(total)), total.shape)
        if not total[at] >= LEAST_STRENGTH:
            where = ", ".join(f"{item.name} = {own[at]:g}" for item, own in zip(self.inputs, grid, strict=True))
            raise ModelError(
                f"FuzzySystem: at {where} no rule answers (the strengths sum to {total[at]:g}, by which the output is divided); "
                "let the sets cover the range of each input, and the rules their combinations"
            )
        return float(total[at])

    # -- evaluating ---------------------------------------------------------------------------------------------------

    def __call__(self, *expressions: Any) -> ca.SX:
        """Return the outputs (one below the other) for expressions or numbers, one for each input; NaN gives NaN."""
        if len(expressions) != len(self.inputs):
            raise ModelError(
                f"FuzzySystem: it is called with {len(expressions)} expression(s) and has {len(self.inputs)} input(s); give one "
                "for each"
            )
        given = [
            as_expression(f"FuzzySystem: the input {item.name!r}", x)
            for x, item in zip(expressions, self.inputs, strict=True)
        ]
        given_numbers = all(x.is_constant() for x in given)
        degrees: list[dict[str, ca.SX]] = []
        for x, item in zip(given, self.inputs, strict=True):
            if x.numel() != 1:
                raise ModelError(
                    f"FuzzySystem: the expression for {item.name!r} has {x.numel()} elements; give a scalar"
                )
            low, high = item.range
            held = saturated(x, low, high)
            degrees.append({own.label: _membership(held, own.corners, item.range) for own in item.sets})
        strengths = []
        for labels, _, weight in self.rules:
            own = [degree[label] for degree, label in zip(degrees, labels, strict=True) if label is not None]
            together = own[0] if own else ca.SX(1)
            for other in own[1:]:
                together = together * other if self.join == "product" else minimum(together, other)
            strengths.append(weight * together)
        values = ca.vertcat(*[self._defuzzified(k, strengths) for k in range(len(self.outputs))])
        return ca.SX(ca.evalf(values)) if given_numbers else values

    def _defuzzified(self, index: int, strengths: list[ca.SX]) -> ca.SX:
        """Return an output."""
        sets = {item.label: item.corners for item in self.outputs[index].sets}
        said = [(strength, sets[labels[index]]) for strength, (_, labels, _) in zip(strengths, self.rules, strict=True)]
        if self.defuzzify == "centres":
            return _sum([w * centre_of(corners) for w, corners in said]) / _sum(strengths)
        if self.aggregation == "sum" and self.implication == "product":
            whole_sets = [(w, *area_and_moment(corners, 1.0)) for w, corners in said]
            return _sum([w * moment for w, _, moment in whole_sets]) / _sum([w * area for w, area, _ in whole_sets])
        if self.aggregation == "sum":
            cut = [area_and_moment(corners, w) for w, corners in said]
            return _sum([moment for _, moment in cut]) / _sum([area for area, _ in cut])
        highest: dict[Corners, ca.SX] = {}
        for w, corners in said:
            highest[corners] = maximum(highest[corners], w) if corners in highest else w
        moments, areas = [], []
        for y in midpoints(self.outputs[index].ends, self.points):
            union: ca.SX | None = None
            for corners, height in highest.items():
                degree = float(_degree(float(y), corners))
                if degree > 0:
                    own = height * degree if self.implication == "product" else minimum(height, ca.SX(degree))
                    union = own if union is None else maximum(union, own)
            if union is not None:
                areas.append(union)
                moments.append(float(y) * union)
        return _sum(moments) / _sum(areas)

    def reference(self) -> Fuzzy:
        """Return the same system as NumPy: a callable of numbers or arrays, one for each input."""
        return Fuzzy(
            tuple((item.name, *item.range, {own.label: own.corners for own in item.sets}) for item in self.inputs),
            tuple((item.name, {own.label: own.corners for own in item.sets}) for item in self.outputs),
            self.rules, self.join, self.defuzzify, self.implication, self.aggregation, self.points,
        )  # fmt: skip

    def _spoken(self) -> list[str]:
        """Return sets and rules as sentences, for the header."""
        lines = []
        for item in (*self.inputs, *self.outputs):
            lines += [f"{item.name} is {own.label}: {_shape(own.corners)}" for own in item.sets]
        for labels, then, weight in self.rules:
            asked = [
                f"{item.name} is {label}" for item, label in zip(self.inputs, labels, strict=True) if label is not None
            ]
            said = [f"{item.name} is {label}" for item, label in zip(self.outputs, then, strict=True)]
            more = f" (weight {weight:g})" if weight < 1 else ""
            lines.append(f"if {' and '.join(asked) or 'anything'} then {' and '.join(said)}{more}")
        return lines

    def block(self, name: str, *, ranges: Mapping[str, Ends] | None = None, doc: str = "") -> Block:
        """Return the system as a Block: entry `step`, no memory, no parameters (sets and rules are folded).

        Parameters
        ----------
        name : str
            Of the block.
        ranges : dict, optional
            Input -> where it may be; outside it, and at NaN, a call is refused (BAD_INPUT). Default -1e6 .. 1e6. Between
            this range and that of the sets the input is held at the end of the latter.
        doc : str
            Its meaning.
        """
        expect(ranges or {}, Mapping, f"{name}: ranges", "a dictionary, input -> (low, high)")
        wide = dict(ranges or {})
        unknown = set(wide) - {item.name for item in self.inputs}
        if unknown:
            known = ", ".join(item.name for item in self.inputs)
            raise ModelError(f"{name}: ranges= names {sorted(unknown)}, which are no inputs; it has {known}")
        block = Block(name, doc=doc or f"fuzzy system of {len(self.rules)} rules")
        taken = [block.input(item.name, unit=item.unit, range=wide.get(item.name)) for item in self.inputs]
        values = self(*taken)
        margins = {item.name: 0.01 * max(item.ends[1] - item.ends[0], *map(abs, item.ends)) for item in self.outputs}
        block.entry(
            "step", inputs=taken,
            outputs={item.name: values[k] for k, item in enumerate(self.outputs)},
            output_units={item.name: item.unit for item in self.outputs},
            output_ranges={
                item.name: (item.ends[0] - margins[item.name], item.ends[1] + margins[item.name]) for item in self.outputs
            },
            doc="The outputs that the rules give.",
        )  # fmt: skip
        block.notes = self._spoken()
        near = {}
        for item, symbol in zip(self.inputs, taken, strict=True):
            (low, high), signal = item.range, symbol.signal
            more = 0.2 * (high - low)
            near[item.name] = max(low - more, signal.low[0]), min(high + more, signal.high[0])
        return finish(block, {"step": self.reference().step}, wandering(near))


def area_and_moment(corners: Corners, height: Any) -> tuple[Any, Any]:
    """Return the integrals of m(y) and y m(y) over a trapezoid cut off at a height, as that of the polygon that is left.

    The oracle has them by another integral (`reference.fuzzy`).
    """
    a, b, c, d = corners
    left, right = a + height * (b - a), d - height * (d - c)
    area = height * (d - a + right - left) / 2
    moment = height * (d * d + d * right + right * right - a * a - a * left - left * left) / 6
    return area, moment


def midpoints(ends: Ends, points: int) -> Array:
    """Return the middles of so many equal pieces, shape (points,)."""
    low, high = ends
    return low + (np.arange(points) + 0.5) * ((high - low) / points)


def centre_of(corners: Corners) -> float:
    """Return the centre of gravity of a set; of a singleton, where it is."""
    area, moment = area_and_moment(corners, 1.0)
    return float(moment / area) if area > 0 else corners[0]


def _shape(corners: Corners) -> str:
    """Return a set in words."""
    a, b, c, d = corners
    if a == d:
        return f"{a:g}"
    rises = "" if math.isinf(a) else f"rises from {a:g} to {b:g}"
    falls = "" if math.isinf(d) else f"falls from {c:g} to {d:g}"
    return ", ".join(item for item in (rises, falls) if item) or "everywhere"


def _as_sets(name: str, given: Any, wanted: str) -> tuple[FuzzySet, ...]:
    """Return fuzzy sets, or say what is none."""
    expect(given, (list, tuple), f"{name}: sets", wanted)
    for item in given:
        expect(item, FuzzySet, f"{name}: one of the sets", wanted)
    return tuple(given)


def _check_labels(name: str, sets: Sequence[FuzzySet]) -> None:
    labels = [item.label for item in sets]
    if not labels:
        raise ModelError(f"{name}: it has no fuzzy sets; give one at least")
    if len(set(labels)) < len(labels):
        raise ModelError(f"{name}: a label stands twice among {', '.join(labels)}; give each set its own")


def _membership(x: ca.SX, corners: Corners, range: Ends) -> ca.SX:
    """Return the membership of a held input. NaN runs through the last branch of each chain, and stays."""
    a, b, c, d = corners
    rises, falls = b > range[0] and a < b, c < range[1] and c < d
    rising = (x - a) * (1 / (b - a)) if rises else ca.SX(1)
    falling = (d - x) * (1 / (d - c)) if falls else ca.SX(1)
    if not rises and not falls:
        return ca.SX(1)
    if not rises:
        return ca.if_else(x <= c, 1, ca.if_else(x >= d, 0, falling))
    if not falls:
        return ca.if_else(x >= b, 1, ca.if_else(x <= a, 0, rising))
    end = ca.if_else(x >= d, 0, falling)
    middle = ca.if_else(x <= c, 1, end) if b < c else end
    return ca.if_else(x <= a, 0, ca.if_else(x <= b, rising, middle))


def _degree(y: float, corners: Corners) -> float:
    """Return the membership of a number in a set with finite corners."""
    a, b, c, d = corners
    if y < a or y > d:
        return 0.0
    return (y - a) / (b - a) if y < b else (d - y) / (d - c) if y > c else 1.0


def _sum(items: Sequence[ca.SX]) -> ca.SX:
    total = items[0]
    for item in items[1:]:
        total = total + item
    return total
