"""Test vectors that ship with the C: a nominal sequence, and calls that reach every other statement and status."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..symbolic.block import Block
from ..symbolic.program import Visit
from ..symbolic.signals import Kind, Signal, Status
from .crosscheck import CrossCheck, FrozenStream, Lockstep, Probe, default_scenario, make_views
from .emit import generator_version, templates
from .findings import CheckResult
from .layout import fill, flatten
from .selection import Feature, added, chosen, crafted, features, reachable
from .style import Precision
from .views import Answer, InterpretView, NativeView, Record, View

LONGEST = 24
DIGITS = {"double": 9, "float": 6}
AGREEMENT = "candidates for vectors = model"
TOLERANCE = {"double": 1e-6, "float": 2e-3}


@dataclass
class Vector:
    """One call with what it must give, and what ran in it. Memories are positions in a table."""

    entry: str
    start: int
    inputs: int
    params: int
    expected: int
    outputs: int
    status: str
    visits: tuple[Visit, ...] = ()


class VectorTable:
    """Collects calls and writes them as C.

    Attributes
    ----------
    agreement : CheckResult
        Whether C and model agreed on every candidate that was tried: one that differs is no vector, and is a fault.
    """

    def __init__(self, block: Block, precision: Precision):
        self.block, self.precision = block, precision
        self.digits = DIGITS[precision.name]
        self.memories: list[str] = []
        self.params: list[str] = []
        self.inputs: dict[str, list[str]] = {name: [] for name in block.entries}
        self.outputs: dict[str, list[str]] = {name: [] for name in block.entries}
        self.vectors: list[Vector] = []
        self.agreement = CheckResult(AGREEMENT, True)
        self._rounded: dict[tuple[Any, bytes], Record] = {}

    def rounded(self, record: Record) -> Record:
        """Return a record with every real rounded to the digits that are shipped."""
        key = (record.dtype, record.tobytes())  # thousands of candidates share a few memories and parameters
        if key not in self._rounded:
            values = {}
            for name, value in flatten(record).items():
                if value.dtype.kind == "f":
                    values[name] = np.array([float(f"{item:.{self.digits - 1}e}") for item in value.astype(float)])
            self._rounded[key] = fill(record.copy(), values)
        return self._rounded[key].copy()

    def _position(self, table: list[str], text: str) -> int:
        if text not in table:
            table.append(text)
        return table.index(text)

    def add(self, probe: Probe, after: Record, outputs: Record, answer: Answer) -> None:
        """Add a call; the records are rounded already."""
        entry = self.block.entries[probe.entry]
        memory = self.block.memory_group().members
        self.vectors.append(
            Vector(
                probe.entry,
                self._position(self.memories, self.text(memory, probe.memory)),
                self._position(self.inputs[probe.entry], self.text(entry.inputs, probe.inputs)) if entry.inputs else 0,
                self._position(self.params, self.text(self.block.param_group().members, probe.params)),
                self._position(self.memories, self.text(memory, after)),
                self._position(self.outputs[probe.entry], self.text(entry.outputs, outputs)) if entry.outputs else 0,
                answer.status.name,
                answer.visits,
            )
        )

    def text(self, signals: tuple[Signal, ...], record: Any) -> str:
        """Return a C initialiser."""
        items = []
        for signal in signals:
            value = record[signal.name]
            if signal.kind is Kind.GROUP:
                items.append(self.text(signal.members, value))
                continue
            numbers = [self._number(signal, item) for item in np.atleast_1d(value).ravel()]
            items.append(numbers[0] if signal.size == 1 else "{" + ", ".join(numbers) + "}")
        return "{" + (", ".join(items) or "0U") + "}"

    def _number(self, signal: Signal, value: Any) -> str:
        if signal.kind is Kind.FLAG:
            return "true" if value else "false"
        if signal.kind is Kind.COUNT:
            return f"{int(value)}U"
        if signal.kind is Kind.STATUS:
            return f"({self.block.name}_status_t){int(value)}"
        number = float(value)
        if np.isnan(number):
            return f"({self.precision.name})NAN"
        if np.isinf(number):
            return f"({self.precision.name}){'' if number > 0 else '-'}INFINITY"
        return self.precision.literal(float(f"{number:.{self.digits - 1}e}"))


def choose_vectors(block: Block, precision: str, check: CrossCheck, native: NativeView | None = None) -> VectorTable:
    """Return the vectors: a nominal sequence, then calls that reach every other statement and every other status.

    Parameters
    ----------
    block : Block
        The block.
    precision : {"double", "float"}
        Of the C.
    check : CrossCheck
        Whose calls are candidates; what none of them reaches, calls crafted for it may.
    native : NativeView, optional
        The model's own C, where it is compiled already.
    """
    table = VectorTable(block, Precision(precision))
    view = InterpretView(block)
    shape = native or NativeView(block, precision)
    scenario = block.scenario or default_scenario(block)
    stream: Any = FrozenStream(1)
    params = shape.params()
    sizes = _sizes(block, shape, view, params)
    memory = shape.memory()
    seen: frozenset[Feature] = frozenset()
    for k, (entry, values) in enumerate(scenario.calls(stream, LONGEST)):
        inputs = table.rounded(shape.inputs(entry, values))
        memory = _add(table, view, shape, Probe("vectors", k, entry, memory, inputs, params))
        vector = table.vectors[-1]
        seen |= features(entry, Status[vector.status], vector.visits)

    def shipped(probe: Probe) -> Probe:
        memory, inputs, given = (table.rounded(item) for item in (probe.memory, probe.inputs, probe.params))
        trace = probe.trace if probe.trace == "crafted" else "vectors"
        return Probe(trace, 0, probe.entry, memory, inputs, given)

    def run(probe: Probe) -> Answer:
        return _answer(view, probe, 0.0)

    lock = Lockstep(block, precision, make_views(block, precision, shape))

    def usable(probe: Probe) -> bool:
        if block.entries[probe.entry].checks_params or _is_possible(block, probe.memory):
            lock.compare(probe)
        return _is_sturdy((view, shape), probe, run(probe).status, sizes, precision)

    # the nominal sequence shows what good nominal calls reach
    calls = [
        probe
        for probe in check.calls
        if probe.answer is not None and (probe.trace != "nominal" or probe.answer.status != Status.OK)
    ]
    picked, seen = chosen((shipped(probe) for probe in calls), seen, run, usable)
    missing = reachable(block) - seen
    picked += added(block, crafted(block, shape, check.calls, missing), missing, shipped, run, usable)
    for probe in picked:
        _add(table, view, shape, probe)
    table.agreement = lock.agreement(AGREEMENT)
    return table


def vectors_source(block: Block, precision: str, table: VectorTable, native: NativeView | None = None) -> str:
    """Return the C text of vectors with their runner.

    Parameters
    ----------
    block : Block
        The block.
    precision : {"double", "float"}
        Of the C.
    table : VectorTable
        What `choose_vectors` chose.
    native : NativeView, optional
        The model's own C, where it is compiled already.
    """
    kind = Precision(precision)
    shape = native or NativeView(block, precision)
    sizes = _sizes(block, shape, InterpretView(block), shape.params())
    memory = _comparisons(block.memory_group().members, "state", "wanted")
    called = {vector.entry for vector in table.vectors}
    outputs = {entry.name: _comparisons(entry.outputs, "answer", "expected") for entry in block.entries.values()}
    compared = memory + [item for name in called for item in outputs[name]]
    text = (
        templates()
        .get_template("test_vectors.c.j2")
        .render(
            name=block.name,
            upper=block.name.upper(),
            version=generator_version(),
            hash=block.model_hash(),
            real=kind.name,
            fabs=kind.function("fabs"),
            tolerance=kind.literal(TOLERANCE[precision]),
            zero=kind.literal(0.0),
            two_pi=kind.literal(2 * np.pi),
            memories=table.memories,
            params=table.params if block.param_group().members else [],
            entries=[
                (
                    entry.name,
                    table.inputs[entry.name],
                    table.outputs[entry.name],
                    outputs[entry.name],
                )
                for entry in block.entries.values()
            ],
            memory_comparisons=memory,
            compares_reals=any(kind not in ("status", "count") for kind, _, _, _ in compared),
            scales=table.text(block.memory_group().members, table.rounded(sizes)),
            vectors=table.vectors,
            statuses=[(status.name, int(status)) for status in Status],
        )
    )
    return wrapped(text)


def _add(table: VectorTable, view: View, shape: View, probe: Probe) -> Record:
    """Run a call in double precision, add it, and return the memory after it as it is shipped."""
    answer = _answer(view, probe, 0.0)
    after = table.rounded(fill(shape.memory(), flatten(answer.memory)))
    outputs = table.rounded(fill(shape.outputs(probe.entry), flatten(answer.outputs)))
    if answer.status < 0:
        after = probe.memory
    table.add(probe, after, outputs, answer)
    return after


def _is_sturdy(views: tuple[View, View], probe: Probe, status: Any, sizes: Record, precision: str) -> bool:
    """Whether a call keeps its status, and its numbers within the tolerance, where its memory is rounded anew.

    In Python and in the C: a call that is near a switch, or ill-conditioned, is no vector for other machines.
    """
    first = _answer(views[0], probe, 0.0)
    if first.status != status or first.margin < 1e-4:
        return False
    wanted = flatten(first.memory)
    for view in views:
        for shift in (0.0, -(10.0 ** -DIGITS[precision]), 10.0 ** -DIGITS[precision]):
            other = _answer(view, probe, shift)
            if other.status != status:
                return False
            for name, value in wanted.items():
                if value.dtype.kind == "f" and first.status >= 0:
                    allowed = 0.05 * TOLERANCE[precision] * (np.abs(value) + flatten(sizes)[name].astype(float))
                    if not np.all(np.abs(flatten(other.memory)[name].astype(float) - value) <= allowed):
                        return False
    return True


def _is_possible(block: Block, memory: Record) -> bool:
    """Whether every field lies within its range, as it does after any sequence of calls."""
    values = flatten(memory)
    for signal in block.memory_signals_flat():
        if signal.kind is Kind.REAL:
            value = np.ravel(values[signal.name])
            low, high = (np.asarray(end, dtype=value.dtype) for end in (signal.low, signal.high))
            if not np.all((value >= low) & (value <= high)):
                return False
    return True


def _answer(view: View, probe: Probe, shift: float) -> Answer:
    """Call a view from a memory whose elements are shifted up and down by a relative amount."""
    memory = fill(view.memory(), flatten(probe.memory))
    for k, (name, value) in enumerate(flatten(memory).items()):
        if value.dtype.kind == "f" and shift:
            signs = np.where((np.arange(value.size) + k) % 2 == 0, shift, -shift)
            fill(memory, {name: value * (1 + signs)})
    return view.call(
        probe.entry,
        memory,
        fill(view.inputs(probe.entry, {}), flatten(probe.inputs)),
        fill(view.params(), flatten(probe.params)),
    )


def _sizes(block: Block, shape: View, view: View, params: Record) -> Record:
    """Return a memory whose fields are the natural size of an error in them: sigma after init, else 1."""
    start = view.call("init", view.memory(), view.inputs("init", {}), fill(view.params(), flatten(params))).memory
    scenario = block.scenario
    sizes = {} if scenario is None or scenario.scales is None else scenario.scales(flatten(start))
    record = shape.memory()
    for name, value in flatten(record).items():
        if value.dtype.kind == "f":
            fill(record, {name: np.broadcast_to(np.asarray(sizes.get(name, 1.0)), value.shape)})
    return record


def _comparisons(signals: tuple[Signal, ...], left: str, right: str, path: str = "") -> list[tuple[str, str, str, int]]:
    """Return (kind, field, scale field, size) for every field to be compared."""
    answer = []
    for signal in signals:
        if signal.kind is Kind.GROUP:
            answer += _comparisons(signal.members, left, right, f"{path}{signal.name}.")
        else:
            kind = "angle" if signal.angle else signal.kind.value
            answer.append((kind, path + signal.name, path + signal.name, signal.size))
    return answer


def wrapped(text: str) -> str:
    """Break long initialiser lines."""
    lines = []
    for line in text.split("\n"):
        while len(line) > 120:
            cut = line.rfind(", ", 0, 114)
            if cut < 20:
                break
            lines.append(line[: cut + 1])
            line = "     " + line[cut + 2 :]
        lines.append(line.rstrip())
    return "\n".join(lines).rstrip("\n") + "\n"
