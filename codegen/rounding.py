"""What one call loses to rounding: bounds of scalar results, proved by Gappa.

A piece is one number that an entry computes from its inputs, parameters and memory: a field of the memory after the call,
an output, or what a kernel takes. Its script is written from the very graph that the C is printed from, operation by
operation, beside the same operations on real numbers, and Gappa is asked how far apart the two can be.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from typing import Any, Literal

from ..symbolic.block import Block, places_written
from ..symbolic.expressions import tape
from ..symbolic.program import (
    AllOf,
    Assign,
    Compare,
    Condition,
    Element,
    Entry,
    Evaluate,
    HoldVariances,
    Kernel,
    Place,
    Refuse,
    Statement,
    Trail,
    Within,
    numbered,
    walk,
)
from ..symbolic.signals import Kind, Signal
from .exported import tool
from .findings import Findings
from .gappa import Gappa, Interval, NotBounded, branches, largest
from .graph import Node
from .style import Precision
from .writer import CoreWriter, is_sequenced, style_for

Role = Literal["memory", "output", "local"]

_OF_KERNEL = "a kernel's result"

USEFUL = 0.1
"""A bound above this part of the largest value says nothing, and is not given."""


@dataclass(frozen=True)
class Leaf:
    """What a piece reads: a number taken as exact.

    Attributes
    ----------
    name : str
        Its name, with the element in brackets.
    interval : (float, float) or None
        Where it lies, in the precision of the C; None where nothing says.
    default : float or None
        Of a parameter, in the precision of the C.
    """

    name: str
    interval: Interval | None
    default: float | None = None


@dataclass(frozen=True, eq=False)
class Piece:
    """One scalar result of an entry, as the C computes it.

    Attributes
    ----------
    entry : str
        Name of the entry; of a part of a composition ``part.entry``.
    name : str
        Field of the memory or of the outputs, or the name in the C of what kernels take; the element in brackets.
    role : {"memory", "output", "local"}
        Which of these it is.
    unit : str
        Its unit, where one is known.
    node : Node
        The last operation.
    leaves : dict
        Node -> what is read there.
    aliases : dict
        Load of a field that was written before in the same call -> what was written.
    facts : tuple of (Node, float, float)
        Values that are judged in the same call: where one is outside, the call is refused.
    judged : bool
        Whether the result itself is.
    width : float or None
        Of the range of a field of the memory: a correction that a kernel computed for it is taken to be no larger, where
        there is no bound else.
    """

    entry: str
    name: str
    role: Role
    unit: str
    node: Node
    leaves: dict[Node, Leaf] = field(repr=False)
    aliases: dict[Node, Node] = field(default_factory=dict, repr=False)
    facts: tuple[tuple[Node, float, float], ...] = field(default=(), repr=False)
    judged: bool = False
    width: float | None = None


@dataclass(frozen=True)
class Bound:
    """How far a result can be from what exact arithmetic gives for the same inputs, or why nobody knows.

    Attributes
    ----------
    entry, name, role, unit : str
        Of the piece.
    error : float or None
        Largest absolute error, in the unit; parameters, memory and inputs anywhere within their ranges.
    low, high : float or None
        Where the value lies.
    error_at_defaults : float or None
        The same with the parameters at their defaults; None where the piece has none, or no bound was found.
    reaches_at_defaults : float or None
        Largest magnitude of the value then.
    notes : tuple of str
        What the bound takes for granted.
    reason : str
        Why there is no bound over the ranges; empty if there is one.
    """

    entry: str
    name: str
    role: Role
    unit: str
    error: float | None = None
    low: float | None = None
    high: float | None = None
    error_at_defaults: float | None = None
    reaches_at_defaults: float | None = None
    notes: tuple[str, ...] = ()
    reason: str = ""

    @property
    def is_bounded(self) -> bool:
        """Whether there is a bound, over the ranges or with the parameters at their defaults."""
        return self.error is not None or self.error_at_defaults is not None

    @property
    def is_of_kernel(self) -> bool:
        """Whether a kernel computed it: there is no bound then."""
        return self.reason.startswith(_OF_KERNEL)

    def as_dict(self) -> dict[str, Any]:
        """Return it for JSON."""
        return {
            "entry": self.entry,
            "name": self.name,
            "role": self.role,
            "unit": self.unit,
            "error": self.error,
            "range": None if self.low is None else [self.low, self.high],
            "error_at_defaults": self.error_at_defaults,
            "reaches_at_defaults": self.reaches_at_defaults,
            "notes": list(self.notes),
            "reason": self.reason,
        }


# ---------------------------------------------------------------------------------------------------------------------
# The pieces of a block


@dataclass(frozen=True)
class _Written:
    """An element that an evaluation wrote."""

    trail: Trail
    place: Place
    index: int
    name: str
    node: Node


class _Recorder(CoreWriter):
    """Writes a core, and keeps the nodes that it prints."""

    def __init__(self, block: Block, entry: Entry, precision: Precision, mathematics: str):
        super().__init__(block, entry, block.name, style_for(precision, mathematics), block.name)
        self.trails: dict[int, Trail] = {}
        for trail, statement in numbered(entry.body, "body"):
            # one that stands at two places is looked at as if it stood nowhere
            self.trails[id(statement)] = () if id(statement) in self.trails else trail
        self.written: list[_Written] = []
        self.stored: dict[Node, tuple[Trail, Node]] = {}
        self.judged: list[tuple[Trail, Node, float, float]] = []

    def _evaluate(self, statement: Evaluate) -> None:
        trail = self.trails.get(id(statement), ())
        inputs = [[node for place, size in places for node in self._read(place, size)] for places in statement.reads]
        outputs = self.graph.from_tape(tape(statement.function), inputs)
        found = [
            _Written(trail, place, i, names[k], values[k])
            for values, places, names in zip(outputs, statement.writes, statement.names, strict=True)
            for k, (place, i) in enumerate((place, i) for place, size in places for i in range(size))
        ]
        super()._evaluate(statement)
        self.written += found
        for item in found:
            if item.place.space != "local":
                self.stored[self.graph.load(item.place, item.index, self.versions[item.place])] = (trail, item.node)

    def _refuse(self, statement: Refuse, rest: Sequence[Statement]) -> None:
        trail = self.trails.get(id(statement), ())
        for place, index, low, high in _limits(statement.unless):
            node = self._read(place, index + 1)[index]
            where, value = self.stored.get(node, (trail, node))
            if trail and where[:-1] == trail[: len(where) - 1]:
                self.judged.append((trail, value, low, high))
        super()._refuse(statement, rest)

    def leaf(self, node: Node) -> Leaf:
        """Return what is known of a value that is read."""
        place, index, _ = node.element
        signal = self._signal(place)
        name = place.name + (f"[{index}]" if signal is None or signal.size > 1 else "")
        if place.space not in ("memory", "param", "in") or signal is None or signal.kind is not Kind.REAL:
            return Leaf(name, None)
        rounded = self.precision.dtype
        default = None
        if place.space == "param" and signal.default is not None:
            default = float(rounded(signal.default[index]))
        return Leaf(name, (float(rounded(signal.low[index])), float(rounded(signal.high[index]))), default)


def _limits(condition: Condition) -> Iterator[tuple[Place, int, float, float]]:
    """Yield (place, element, low, high) of what holds wherever a condition does."""
    match condition:
        case AllOf():
            for item in condition.conditions:
                yield from _limits(item)
        case Within():
            for k, (low, high) in enumerate(zip(condition.low, condition.high, strict=True)):
                yield condition.place, condition.first + k, low, high
        case Compare(left=left, right=right) if isinstance(left, Element) and not isinstance(right, Element):
            above = condition.relation in (">", ">=")
            low, high = (right, float("inf")) if above else (float("-inf"), right)
            yield left.place, left.index, low, high


def pieces(block: Block, precision: str | Precision, *, mathematics: str = "own") -> list[Piece]:
    """Return the scalar results of a block's entries that are computed, in the order of the C.

    Copies and constants are left out, and so is what kernels compute.

    Parameters
    ----------
    block : Block
        A block, or a composition: then those of its parts too.
    precision : {"float", "double"}
        Of the C.
    mathematics : {"own", "libm"}
        Whose `sin`, `exp` ... it calls.
    """
    kind = precision if isinstance(precision, Precision) else Precision(precision)
    found: list[Piece] = []
    for name, part in block.parts.items():
        found += [replace(item, entry=f"{name}.{item.entry}") for item in pieces(part, kind, mathematics=mathematics)]
    for entry in block.entries.values():
        if not is_sequenced(entry):
            found += _pieces_of(block, entry, kind, mathematics)
    return found


def _pieces_of(block: Block, entry: Entry, precision: Precision, mathematics: str) -> list[Piece]:
    recorder = _Recorder(block, entry, precision, mathematics)
    recorder.write()
    rounded = precision.dtype
    found = []
    for item in recorder.written:
        if item.node.operation in ("load", "const"):
            continue
        name, role, signal = _named(entry, item, recorder)
        aliases = {
            load: node
            for load, (where, node) in recorder.stored.items()
            if where and where[:-1] == item.trail[: len(where) - 1]
        }
        facts = tuple(
            (node, float(rounded(low)), float(rounded(high)))
            for trail, node, low, high in recorder.judged
            if trail[:-1] == item.trail[: len(trail) - 1]
        )
        judged = [(low, high) for node, low, high in facts if node is item.node]
        low, high = max((low for low, _ in judged), default=0.0), min((high for _, high in judged), default=0.0)
        leaves = {node: recorder.leaf(node) for node in _loads(item.node, aliases)}
        unit = "" if signal is None else signal.unit
        is_judged = bool(judged) and max(abs(low), abs(high)) < float("inf")
        width = signal.high[item.index] - signal.low[item.index] if role == "memory" and signal is not None else None
        found.append(Piece(entry.name, name, role, unit, item.node, leaves, aliases, facts, is_judged, width))
    return found


def _named(entry: Entry, item: _Written, recorder: _Recorder) -> tuple[str, Role, Signal | None]:
    """Return what a reader calls it: the output it is copied to, the field, or the name of the local."""
    place, role = item.place, {"next": "memory", "out": "output"}.get(item.place.space, "local")
    if role == "local":
        copied = [
            statement.target
            for statement in walk(entry.body)
            if isinstance(statement, Assign) and statement.source == item.place and statement.target.space == "out"
        ]
        if not copied:
            return item.name, "local", None
        place, role = copied[0], "output"
    signal = recorder._signal(place)
    name = place.name + (f"[{item.index}]" if signal is not None and signal.size > 1 else "")
    return name, "memory" if role == "memory" else "output", signal


def _loads(root: Node, aliases: dict[Node, Node]) -> list[Node]:
    """Return what a value reads, in the order of a walk."""
    found: dict[Node, None] = {}
    seen: set[Node] = set()
    stack = [root]
    while stack:
        node = stack.pop()
        if node in seen:
            continue
        seen.add(node)
        if node in aliases:
            stack.append(aliases[node])
        elif node.operation == "load":
            found[node] = None
        stack += reversed(node.arguments)
    return list(found)


def kernel_results(block: Block) -> list[Bound]:
    """Return what kernels give to the memory and to the outputs: numbers of which no bound is derived."""
    found: dict[tuple[str, str], Bound] = {}
    for part_name, part in block.parts.items():
        for item in kernel_results(part):
            found[f"{part_name}.{item.entry}", item.name] = replace(item, entry=f"{part_name}.{item.entry}")
    for entry in block.entries.values():
        sources: dict[Place, str] = {}
        for statement in walk(entry.body):
            kind = type(statement).__name__
            if isinstance(statement, Assign) and isinstance(statement.source, Place) and statement.source in sources:
                sources[statement.target] = sources[statement.source]
            elif isinstance(statement, (Kernel, HoldVariances)):
                for place in places_written(statement):
                    sources.setdefault(place, kind)
        for place, kind in sources.items():
            if place.space in ("next", "out") and (entry.name, place.name) not in found:
                role: Role = "memory" if place.space == "next" else "output"
                found[entry.name, place.name] = Bound(entry.name, place.name, role, "", reason=f"{_OF_KERNEL} ({kind})")
    return list(found.values())


# ---------------------------------------------------------------------------------------------------------------------
# The bounds


def script(piece: Piece, precision: str | Precision, *, defaults: bool = False, mathematics: str = "own") -> str:
    """Return the question that Gappa is asked of a piece, on the first of its branches.

    Raises
    ------
    NotBounded
        If it cannot be asked.
    """
    kind = precision if isinstance(precision, Precision) else Precision(precision)
    gappa = Gappa(piece, kind, branches(piece)[0], defaults=defaults, mathematics=mathematics)
    return gappa.text(gappa.goals())


def bound_piece(piece: Piece, precision: str | Precision, *, mathematics: str = "own", seconds: float = 20.0) -> Bound:
    """Ask Gappa how far a piece can be from what exact arithmetic gives.

    Parameters
    ----------
    piece : Piece
        Of `pieces`.
    precision : {"float", "double"}
        Of the C.
    mathematics : {"own", "libm"}
        Whose `sin`, `exp` ... it calls; no error of a C library's is known.
    seconds : float
        How long each question may take.

    Raises
    ------
    MissingTool
        If gappa is not installed.
    RuntimeError
        If it does not understand the question.
    """
    kind = precision if isinstance(precision, Precision) else Precision(precision)
    tool("gappa")
    answer = Bound(piece.entry, piece.name, piece.role, piece.unit)
    try:
        error, low, high, notes = _asked_or_assumed(piece, kind, mathematics, seconds, defaults=False)
        answer = replace(answer, error=error, low=low, high=high, notes=notes)
    except NotBounded as why:
        answer = replace(answer, reason=str(why))
    if any(leaf.default is not None for leaf in piece.leaves.values()) and piece.entry.rpartition(".")[2] != "init":
        try:
            error, low, high, notes = _asked_or_assumed(piece, kind, mathematics, seconds, defaults=True)
            answer = replace(answer, error_at_defaults=error, reaches_at_defaults=largest((low, high)), notes=notes)
        except NotBounded:
            pass
    return answer


_Asked = tuple[float, float, float, tuple[str, ...]]


def _asked_or_assumed(
    piece: Piece, precision: Precision, mathematics: str, seconds: float, *, defaults: bool
) -> _Asked:
    """Ask; where nothing says how large a correction is, take it to be no larger than the field it belongs to."""
    try:
        return _asked(piece, precision, mathematics, seconds, defaults=defaults)
    except NotBounded:
        free = [leaf.name for leaf in piece.leaves.values() if leaf.interval is None]
        if piece.width is None or not free:
            raise
    width = float(precision.dtype(piece.width))
    leaves = {
        node: replace(leaf, interval=(-width, width)) if leaf.interval is None else leaf
        for node, leaf in piece.leaves.items()
    }
    error, low, high, notes = _asked(replace(piece, leaves=leaves), precision, mathematics, seconds, defaults=defaults)
    return error, low, high, (*notes, f"{', '.join(sorted(free))} taken to be within {width:.4g}")


def _asked(piece: Piece, precision: Precision, mathematics: str, seconds: float, *, defaults: bool) -> _Asked:
    """Return the error, the range of the value, and what was taken for granted: the worst of all branches."""
    error, low, high = 0.0, float("inf"), float("-inf")
    notes: dict[str, None] = {}
    for choice in branches(piece):
        gappa = Gappa(piece, precision, choice, defaults=defaults, mathematics=mathematics, seconds=seconds)
        found = gappa.bounds()
        if found is None:  # no input takes this way
            continue
        error, low, high = max(error, found[0]), min(low, found[1]), max(high, found[2])
        notes |= dict.fromkeys(gappa.notes)
    if low > high:
        raise NotBounded("no input is accepted")
    if error > USEFUL * largest((low, high)) > 0.0:
        raise NotBounded(f"the bound that Gappa finds, {error:.1e}, is more than a tenth of the value")
    return error, low, high, tuple(notes)


def bound_rounding(
    block: Block, precision: str | Precision, *, mathematics: str = "own", seconds: float = 20.0
) -> list[Bound]:
    """Bound what one call of each entry can lose to rounding, number by number.

    The bound is of ``|C - exact|`` for the same memory, inputs and parameters, anywhere within their ranges, where the
    call is accepted. Exact is the same sequence of operations on real numbers, with the numbers of the model (in
    double). What a kernel gave is taken as it is.

    Parameters
    ----------
    block : Block
        Whose C it is.
    precision : {"float", "double"}
        Of the C, built without fused operations.
    mathematics : {"own", "libm"}
        Whose `sin`, `exp` ... it calls.
    seconds : float
        How long each question may take.

    Returns
    -------
    list of Bound
        In the order of the C; behind them what kernels give, of which there is none.

    Raises
    ------
    MissingTool
        If gappa is not installed.
    """
    tool("gappa")
    kind = precision if isinstance(precision, Precision) else Precision(precision)

    def ask(piece: Piece) -> Bound:
        return bound_piece(piece, kind, mathematics=mathematics, seconds=seconds)

    with ThreadPoolExecutor(max(1, os.cpu_count() or 1)) as pool:
        found = list(pool.map(ask, pieces(block, kind, mathematics=mathematics)))
    return found + kernel_results(block)


def rounding_findings(bounds: Sequence[Bound]) -> Findings:
    """Return bounds as facts; that something could not be bounded is no failure."""
    return Findings([], {"rounding": [item.as_dict() for item in bounds]})
