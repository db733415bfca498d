"""Which calls become test vectors: those that reach every statement and every status, by rule and not by measurement.

What a call reaches is what the program in Python executed, so that the choice is the same where there is no compiler that
counts. `coverage` then measures whether it holds for the C.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import islice
from typing import Any

import numpy as np

from ..symbolic.block import Block
from ..symbolic.program import AllOf, Call, Entry, HoldVariances, Refuse, Statement, Visit, judgements, numbered, walk
from ..symbolic.signals import Kind, Signal, Status
from .crosscheck import Probe
from .layout import fill, flatten
from .views import Answer, Record, View

MOST_TRIED = 4000
"""Crafted calls that are tried, at most: what cannot be reached is looked for in vain."""

Feature = tuple[Any, ...]

CLOSELY = "looked at closely"
"""What `HoldVariances` does in each entry that has it, by a call of its own."""

HELD = ("above the ceiling", "above the ceiling, not the first", "above the ceiling, not the last", "below the floor")
"""What `HoldVariances` may have to do; the C does it in one function, whichever entry calls it."""


def features(entry: str, status: Status, visits: Sequence[Visit]) -> frozenset[Feature]:
    """Return what a call reached: its status, and every statement that ran with what came of it."""
    return frozenset([("status", entry, status.name), *[_feature(visit) for visit in visits]])


def _feature(visit: Visit) -> Feature:
    if isinstance(visit.statement, HoldVariances) and visit.outcome not in ("", CLOSELY):
        return ("held", visit.entry.rpartition(".")[0], visit.outcome)
    return ("ran", visit.entry, visit.trail, visit.outcome)


def reachable(block: Block) -> frozenset[Feature]:
    """Return everything that calls of a block might reach, statuses left out."""
    wanted: set[Feature] = set()
    open_: list[tuple[Block, Entry, str]] = [(block, entry, "") for entry in block.entries.values()]
    done: set[str] = set()
    while open_:
        owner, entry, path = open_.pop()
        label = path + entry.name
        if label in done:
            continue
        done.add(label)
        judged: tuple[Statement, ...] = judgements(owner, entry)
        for trail, statement in (*numbered(judged, "judged"), *numbered(entry.body, "body")):
            wanted.add(("ran", label, trail, ""))
            if isinstance(statement, Refuse) and statement.unless != AllOf(()):
                wanted.add(("ran", label, trail, statement.status.name))
            elif isinstance(statement, HoldVariances):
                wanted.add(("ran", label, trail, CLOSELY))
                outcomes = [HELD[0], Status.NOT_POSITIVE.name]
                if any(low > 0 for low in statement.floor):  # nothing that is not negative is below a floor of zero
                    outcomes.append(HELD[3])
                if statement.layout.count > statement.size:  # one variance alone has nothing beside it
                    outcomes += [HELD[1], HELD[2], Status.OVERFLOW.name]
                wanted |= {("held", label.rpartition(".")[0], outcome) for outcome in outcomes}
            elif isinstance(statement, Call):
                part = owner.parts[statement.part] if statement.part else owner
                inner = f"{path}{statement.part}." if statement.part else path
                open_.append((part, part.entries[statement.entry], inner))
    return frozenset(wanted)


def chosen(
    probes: Iterator[Probe],
    seen: frozenset[Feature],
    run: Callable[[Probe], Answer],
    usable: Callable[[Probe], bool],
) -> tuple[list[Probe], frozenset[Feature]]:
    """Return calls that reach what was not reached before, those that reach most first, and all that is reached then.

    Parameters
    ----------
    probes : iterator of Probe
        Candidates, as they would be shipped.
    seen : frozenset
        What is reached already.
    run : callable
        Probe -> what the program in Python answers.
    usable : callable
        Whether a call has the same answer on any machine.
    """
    groups: dict[frozenset[Feature], list[Probe]] = {}
    for probe in probes:
        answer = run(probe)
        groups.setdefault(features(probe.entry, answer.status, answer.visits), []).append(probe)
    answer_: list[Probe] = []
    while groups:
        best = max(groups, key=lambda reached: len(reached - seen))  # the first of those that reach most
        if not best - seen:
            break
        own = groups.pop(best)
        good = next((probe for probe in own if usable(probe)), None)
        if good is not None:
            answer_.append(good)
            seen |= best
    return answer_, seen


def within_reach(block: Block) -> dict[str, frozenset[str]]:
    """Return, for each entry, the labels of the features that a call of it may reach."""
    answer = {}
    for entry in block.entries.values():
        labels, open_ = set(), [(block, entry, "")]
        while open_:
            owner, inner, path = open_.pop()
            label = path + inner.name
            if label in labels:
                continue
            labels |= {label, path.rstrip(".")}  # what is held in one function of a part counts for the part
            for statement in walk(inner.body):
                if isinstance(statement, Call):
                    part = owner.parts[statement.part] if statement.part else owner
                    below = f"{path}{statement.part}." if statement.part else path
                    open_.append((part, part.entries[statement.entry], below))
        answer[entry.name] = frozenset(labels)
    return answer


def added(
    block: Block,
    probes: Iterator[Probe],
    missing: frozenset[Feature],
    shipped: Callable[[Probe], Probe],
    run: Callable[[Probe], Answer],
    usable: Callable[[Probe], bool],
) -> list[Probe]:
    """Return, of calls in their order, each, as it is shipped, that reaches something that is still missing."""
    answer: list[Probe] = []
    left = set(missing)
    reach = within_reach(block)
    hopeful = (probe for probe in probes if any(feature[1] in reach[probe.entry] for feature in left))
    for probe in map(shipped, islice(hopeful, MOST_TRIED)):
        if not left:
            break
        tried = run(probe)
        reached = features(probe.entry, tried.status, tried.visits)
        if left & reached and usable(probe):
            answer.append(probe)
            left -= reached
    return answer


def crafted(block: Block, view: View, probes: Sequence[Probe], missing: frozenset[Feature]) -> Iterator[Probe]:
    """Yield calls made to reach what plausible and adversarial traces seldom do.

    From a memory that a filter might have, with one thing changed: readings that are not numbers while all flags are up,
    counters at their limit, fields at and beyond the ends of their ranges, and as the last resort not a number.
    """
    wanted = {str(feature[1]) for feature in missing}
    reach = within_reach(block)
    for name, entry in block.entries.items():
        if not wanted & reach[name]:
            continue
        params = view.params()
        if entry.checks_params:
            for values in _bad_fields(block.param_signals_flat(), flatten(params)):
                yield Probe("crafted", 0, name, view.memory(), view.inputs(name, {}), fill(params.copy(), values))
            continue
        source = next((probe for probe in probes if probe.entry == name and probe.trace == "nominal"), None)
        memory = source.memory if source is not None else _after_init(block, view)
        inputs = source.inputs if source is not None else _middle(view, entry)
        up = fill(inputs.copy(), {signal.name: 1 for signal in entry.inputs if signal.kind is Kind.FLAG})
        down = fill(inputs.copy(), {signal.name: 0 for signal in entry.inputs if signal.kind is Kind.FLAG})
        counting = {signal.name: 2 for signal in block.param_signals_flat() if signal.kind is Kind.COUNT}
        counted = {signal.name: 3 for signal in block.memory_signals_flat() if signal.kind is Kind.COUNT}
        limited, late = fill(params.copy(), counting), fill(memory.copy(), counted)
        gates = {item.name: np.full(item.size, 1e-9) for item in block.param_signals_flat() if is_off(item)}
        gated = fill(params.copy(), gates)
        quiet = {
            item.name: np.zeros(item.size) for item in block.param_signals_flat() if is_real(item) and item.low[0] == 0
        }
        sure = {item.name: np.zeros(item.size) for item in block.memory_signals_flat() if is_packed(item)}

        def probe(memory: Record, inputs: Record, params: Record, name: str = name) -> Probe:
            return Probe("crafted", 0, name, memory, inputs, params)

        yield probe(memory, up, params)
        yield probe(memory, down, params)
        yield probe(late, up, limited)
        yield probe(memory, up, gated)
        yield probe(fill(memory.copy(), sure), up, fill(params.copy(), quiet))
        alone = [fill(down.copy(), {signal.name: 1}) for signal in entry.inputs if signal.kind is Kind.FLAG]
        for values in _bad_fields(entry.inputs, flatten(inputs)):
            for given in (up, *alone):
                yield probe(memory, fill(given.copy(), values), params)
                yield probe(late, fill(given.copy(), values), limited)
        for values in _all_at_an_end(block.memory_signals_flat()):
            for ends in _ends(entry.inputs):
                yield probe(fill(memory.copy(), values), fill(up.copy(), ends), params)
                yield probe(fill(memory.copy(), values), fill(up.copy(), ends), fill(params.copy(), quiet))
        for values in _far_and_certain(block.memory_signals_flat()):
            yield probe(fill(memory.copy(), values), up, params)
        for values in _bad_fields(block.memory_signals_flat(), flatten(memory)):
            yield probe(fill(memory.copy(), values), up, params)
            yield probe(fill(late.copy(), values), up, limited)
            for ends in _ends(entry.inputs):
                yield probe(fill(memory.copy(), values), fill(up.copy(), ends), params)
        # a variance that was held is at its limit, which a reading after it would see: too near for a vector
        for values in _bad_fields(block.memory_signals_flat(), flatten(memory)):
            for given in (down, *(alone if len(alone) > 1 else [])):
                yield probe(fill(memory.copy(), values), given, params)
                yield probe(fill(late.copy(), values), given, limited)
        for values in _bad_fields(block.param_signals_flat(), flatten(params)):
            yield probe(memory, up, fill(params.copy(), values))
            yield probe(late, up, fill(limited.copy(), values))


def _bad_fields(signals: Sequence[Signal], values: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """Yield one field at a time at the ends of its range, beyond them, and not a number."""
    for signal in signals:
        if signal.kind is not Kind.REAL or signal.name not in values:
            continue
        now = values[signal.name].astype(float)
        low, high = np.array(signal.low), np.array(signal.high)
        if is_packed(signal):  # what lies beside its diagonal, and the diagonal
            aside = low < 0
            yield {signal.name: np.where(aside, high, now)}
            yield {signal.name: np.where(aside, np.maximum(1e3 * np.max(np.abs(now)), np.abs(now)), now)}
            yield {signal.name: np.where(aside, now, -now)}
            yield {signal.name: np.where(aside, 0.0, high)}
            yield {signal.name: np.where(aside, 0.0, 0.0)}
            yield {signal.name: np.where(aside, 0.0, 2 * high)}
        yield {signal.name: high}
        yield {signal.name: low}
        yield {signal.name: high + 0.1 * (high - low)}
        yield {signal.name: low - 0.1 * (high - low)}
        yield {signal.name: np.full(signal.size, np.nan)}


def _far_and_certain(signals: Sequence[Signal]) -> Iterator[dict[str, Any]]:
    """Yield a memory far outside its ranges that holds no doubt (no variance): what is read differs beyond measure."""
    packed = [signal for signal in signals if is_packed(signal)]
    if packed:
        values = {
            signal.name: np.full(signal.size, 1e10)
            for signal in signals
            if signal.kind is Kind.REAL and signal not in packed
        }
        yield values | {signal.name: np.zeros(signal.size) for signal in packed}


def _all_at_an_end(signals: Sequence[Signal]) -> Iterator[dict[str, Any]]:
    """Yield a memory whose fields are all at the upper ends of their ranges, then the lower; matrices stay."""
    real = [signal for signal in signals if is_real(signal) and not is_packed(signal)]
    yield {signal.name: np.array(signal.high) for signal in real}
    yield {signal.name: np.array(signal.low) for signal in real}


def is_real(signal: Signal) -> bool:
    """Whether it is a number."""
    return signal.kind is Kind.REAL


def is_off(signal: Signal) -> bool:
    """Whether a parameter is a number that is zero by default, and may be more: a gate that is off."""
    at_zero = signal.default is not None and not any(signal.default) and signal.low[0] == 0
    return signal.kind is Kind.REAL and at_zero


def is_packed(signal: Signal) -> bool:
    """Whether a field is a symmetric matrix, packed: elements of either sign beside positive ones."""
    low = np.array(signal.low)
    return signal.kind is Kind.REAL and bool(np.any(low < 0) and np.any(low >= 0))


def _ends(signals: Sequence[Signal]) -> Iterator[dict[str, Any]]:
    """Yield all inputs at the upper ends of their ranges, then at the lower ones."""
    real = [signal for signal in signals if signal.kind is Kind.REAL]
    if real:
        yield {signal.name: np.array(signal.high) for signal in real}
        yield {signal.name: np.array(signal.low) for signal in real}


def _after_init(block: Block, view: View) -> Record:
    first = next((name for name, entry in block.entries.items() if entry.checks_params), None)
    if first is None:
        return view.memory()
    return view.call(first, view.memory(), view.inputs(first, {}), view.params()).memory


def _middle(view: View, entry: Entry) -> Record:
    values = {s.name: np.clip(np.zeros(s.size), s.low, s.high) for s in entry.inputs if s.kind is Kind.REAL}
    return view.inputs(entry.name, values)
