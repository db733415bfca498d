"""Calls that put the argument of a piecewise function on each of its pieces, and on its kinks."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import islice, pairwise
from typing import Any

import numpy as np

from ..symbolic.block import Block
from ..symbolic.expressions import MOST_PIECES, PieceStep
from ..symbolic.program import Call, Element, Entry, Evaluate, Place, walk
from ..symbolic.signals import Kind, Signal

Fields = Mapping[str, Any]
Given = dict[Place, Any]


MOST_MOVES = 60
"""Of one entry."""

NEAR = 1e-4
"""Relative distance from a kink within which single precision may be on the other side of it."""


@dataclass(frozen=True)
class Move:
    """An element of the memory or of the inputs, and the number it is to have.

    Attributes
    ----------
    element : Element
        Which; of a part with its name before it.
    number : float
        A number of single precision.
    on_kink : bool
        An argument is on a kink in either precision, and none is so near to one that rounding would decide: every view takes
        the same branch.
    """

    element: Element
    number: float
    on_kink: bool


def on_every_piece(block: Block, entry: Entry, memory: Fields, inputs: Fields, params: Fields) -> list[Move]:
    """Return, for an entry, which element to change, and to what.

    An element of the memory or an input is moved until the argument of a saturation, a table ... is where it is wanted: on
    each kink, between kinks, and beyond. Where the argument is not affine in any element, there is nothing; nor is there a
    kink that rounding to single precision would miss.

    Parameters
    ----------
    block : Block
        Owner of the entry.
    entry : Entry
        Which.
    memory, inputs, params : mapping
        Field -> array: from where to start. Fields of parts have their names before them.
    """
    found = dict.fromkeys(_of_entry(block, entry, "", memory, inputs, params))
    return list(islice(found, MOST_MOVES))


def _of_entry(block: Block, entry: Entry, path: str, memory: Fields, inputs: Fields, params: Fields) -> Iterator[Move]:
    values: Given = {}
    signals: dict[Place, Signal] = {}
    for space, group, fields in (
        ("memory", block.memory_signals_flat(), memory),
        ("param", block.param_signals_flat(), params),
        ("in", entry.inputs, inputs),
    ):
        for signal in group:
            name = signal.name if space == "in" else path + signal.name
            place = Place(space, signal.name)  # type: ignore[arg-type]
            given = fields.get(name) if space != "in" or not path else None
            if given is None:  # what a wire brings to a part, or a function of the memory does not read
                given = np.clip(0.0, signal.low, signal.high)
            values[place], signals[place] = np.ravel(given).astype(float), signal
    for statement in walk(entry.body):
        if isinstance(statement, Evaluate) and statement.pieces.steps:
            yield from _of_evaluation(statement, path, values, signals)
        elif isinstance(statement, Call) and statement.part:
            part = block.parts[statement.part]
            below = f"{path}{statement.part}."
            yield from _of_entry(part, part.entries[statement.entry], below, memory, inputs, params)


def _of_evaluation(statement: Evaluate, path: str, values: Given, signals: Mapping[Place, Signal]) -> Iterator[Move]:
    if any(place not in values for places in statement.reads for place, _ in places):
        return  # something that a statement before it computes
    base = _arguments(statement, values, float)
    for k, step in enumerate(statement.pieces.steps):
        if not np.all(np.isfinite(base[k])):
            continue
        for target in _targets(step, base[k]):
            found = _moved(statement, path, k, target, values, signals, base[k][0])
            if found is not None:
                place = found.element.place
                yield replace(found, element=Element(Place(place.space, path + place.name), found.element.index))


def _arguments(statement: Evaluate, values: Given, real: type) -> list[list[float]]:
    given: list[Any] = [
        np.concatenate([np.zeros(0), *[values[place] for place, _ in places]]).astype(real)
        for places in statement.reads
    ]
    return statement.pieces.arguments(*given)


def _targets(step: PieceStep, arguments: list[float]) -> list[float]:
    """Return each kink, a point between two, and one beyond either end; of a long table, some."""
    kinks = step.kinks(arguments)
    kinks = kinks[:: -(-len(kinks) // MOST_PIECES)]
    width = max(kinks[-1] - kinks[0], 0.1 * abs(kinks[0]), 1e-3)
    middles = [0.5 * (a + b) for a, b in pairwise(kinks)]
    return [kinks[0] - 0.1 * width, *kinks, *middles, kinks[-1] + 0.1 * width]


def _moved(
    statement: Evaluate, path: str, k: int, target: float, values: Given, signals: Mapping[Place, Signal], now: float
) -> Move | None:
    """Return an element and the number with which a piecewise function's argument is a target."""
    step = statement.pieces.steps[k]
    is_kink = target in step.kinks(_arguments(statement, values, float)[k])
    for argument, position in step.depends:
        place, index = _element(statement, argument, position)
        signal = signals[place]
        if place.space == "param" or (path and place.space == "in") or signal.kind is not Kind.REAL:
            continue
        old = values[place][index]
        for move in (1.0, 1e-3):  # the second where the first leads over a kink of something inside
            slope = (_with(statement, k, values, place, index, old + move, float)[0] - now) / move
            number = float(np.float32(old + (target - now) / slope)) if slope else np.nan
            if not signal.low[index] <= number <= signal.high[index]:
                continue
            reached = _with(statement, k, values, place, index, number, float)[0]
            if is_kink:
                single = _with(statement, k, values, place, index, number, np.float32)
                if reached == target and single[0] == np.float32(target) == target:
                    changed = _changed(values, place, index, number)
                    return Move(Element(place, index), number, _is_decided(statement, changed))
            elif abs(reached - target) <= 1e-3 * max(abs(target - now), abs(target)):
                return Move(Element(place, index), number, False)
    return None


def _is_decided(statement: Evaluate, values: Given) -> bool:
    """Whether rounding decides no branch: what is near a kink is the same number in either precision."""
    exact, single = (_arguments(statement, values, real) for real in (float, np.float32))
    for step, arguments, rounded in zip(statement.pieces.steps, exact, single, strict=True):
        kinks = step.kinks(arguments)
        scale = max(1e-3, *map(abs, kinks))
        if min(abs(arguments[0] - kink) for kink in kinks) <= NEAR * scale and arguments[0] != rounded[0]:
            return False
    return True


def _changed(values: Given, place: Place, index: int, number: float) -> Given:
    elements = values[place].copy()
    elements[index] = number
    return {**values, place: elements}


def _with(
    statement: Evaluate, k: int, values: Given, place: Place, index: int, number: float, real: type
) -> list[float]:
    return _arguments(statement, _changed(values, place, index, number), real)[k]


def _element(statement: Evaluate, argument: int, position: int) -> tuple[Place, int]:
    """Return which element of which place fills an element of an argument."""
    for place, size in statement.reads[argument]:
        if position < size:
            return place, position
        position -= size
    raise IndexError(f"{statement.function.name()} reads no element {position} of argument {argument}")
