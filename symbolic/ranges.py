"""What follows from ranges alone: statements of an entry that judge, and can never refuse or change anything."""

from __future__ import annotations

from collections.abc import Iterator

from .block import Block, places_written
from .program import (
    AllOf,
    Assign,
    AssignElement,
    Condition,
    Element,
    Entry,
    Evaluate,
    HoldFactors,
    HoldVariances,
    Kernel,
    Place,
    Refuse,
    Statement,
    Within,
)

Interval = tuple[float, float]


def idle_judgements(block: Block, entry: Entry) -> Iterator[Statement]:
    """Yield the judgements of an entry that its ranges prove idle, whatever it is called with.

    Known is what was judged before the body (inputs; parameters, where the entry checks them) and what is copied from there.
    What is computed is not known, and the proof ends at the first statement that branches or calls.

    Parameters
    ----------
    block : Block
        Owner of the entry.
    entry : Entry
        Whose body is looked at.
    """
    known = _judged(block, entry)
    for statement in entry.body:
        match statement:
            case Assign(target=target, source=source):
                for k in range(statement.size):
                    given = known.get(Element(source, k)) if isinstance(source, Place) else (source, source)
                    _learn(known, Element(target, k), given)
            case AssignElement():
                _learn(known, statement.target, known.get(statement.source))
            case HoldVariances():
                if not isinstance(statement, HoldFactors) and _is_held(known, statement):
                    yield statement
            case Refuse():
                if _is_met(known, statement.unless):
                    yield statement
            case Evaluate() | Kernel():
                written = places_written(statement)
                known = {element: value for element, value in known.items() if element.place not in written}
            case _:
                return


def _judged(block: Block, entry: Entry) -> dict[Element, Interval]:
    """Return what is known of inputs and parameters once they were judged."""
    conditions = [block.judge_inputs(entry)] + ([block.judge_params()] if entry.checks_params else [])
    known: dict[Element, Interval] = {}
    for condition in conditions:
        for item in condition.conditions if isinstance(condition, AllOf) else ():
            if isinstance(item, Within):
                for k, ends in enumerate(zip(item.low, item.high, strict=True)):
                    known[Element(item.place, item.first + k)] = ends
    return known


def _learn(known: dict[Element, Interval], target: Element, value: Interval | None) -> None:
    if value is None:
        known.pop(target, None)
    else:
        known[target] = value


def _is_within(known: dict[Element, Interval], element: Element, low: float, high: float) -> bool:
    found = known.get(element)
    return found is not None and low <= found[0] and found[1] <= high


def _is_met(known: dict[Element, Interval], condition: Condition) -> bool:
    if isinstance(condition, AllOf):
        return all(_is_met(known, item) for item in condition.conditions)
    if isinstance(condition, Within):
        ends = enumerate(zip(condition.low, condition.high, strict=True), condition.first)
        return all(_is_within(known, Element(condition.place, k), low, high) for k, (low, high) in ends)
    return False


def _is_held(known: dict[Element, Interval], statement: HoldVariances) -> bool:
    """Whether every variance is between floor and ceiling, and what lies beside them within its bounds."""
    limits = statement.limits()
    diagonal = {place: i for i, place in enumerate(statement.layout.diagonal)}
    return all(
        _is_within(
            known, Element(statement.target, k), statement.floor[diagonal[k]] if k in diagonal else -limit, limit
        )
        for k, limit in enumerate(limits)
    )
