"""Which part of a model each line of the C belongs to: recorded while the C is written, never guessed afterwards.

Every line of code has a parent: an equation of the model, a kernel, a judgement, a commit, bookkeeping of a named kind, or
a helper function with its purpose. A line that is written while no parent is set has none, and a test finds it.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import SupportsIndex

from ..symbolic.block import Block
from ..symbolic.origins import Origin
from ..symbolic.program import (
    AllOf,
    AnyOf,
    Assign,
    AssignElement,
    Attempt,
    Call,
    Compare,
    Condition,
    CountUp,
    Element,
    Entry,
    Evaluate,
    HoldFactors,
    HoldVariances,
    IsSet,
    Kernel,
    Place,
    Raise,
    Refuse,
    Restore,
    Statement,
    When,
    Within,
)
from ..symbolic.signals import Kind, Signal

_MARK = "\x00"


@dataclass(frozen=True)
class Parent:
    """What a line of C is there for.

    Attributes
    ----------
    kind : str
        ``dynamics``, ``sensor``, ``derivative``, ``noise``, ``equation``, ``kernel``, ``judgement``, ``commit``,
        ``bookkeeping``, ``helper`` ...
    text : str
        The equation, or its purpose.
    sources : tuple of str
        Lines of the user's file, ``file.py:12``.
    entry : str
        The entry it belongs to; empty for a helper.
    """

    kind: str
    text: str
    sources: tuple[str, ...] = ()
    entry: str = ""


class TracedLine(str):
    """A line of C that knows its parent."""

    parent: Parent | None

    def __new__(cls, text: str, parent: Parent | None) -> TracedLine:
        """Make one."""
        line = super().__new__(cls, text)
        line.parent = parent
        return line


class TracedLines(list[str]):
    """Lines of C, each with the parent that was current when it was added."""

    def __init__(self, lines: Iterable[str] = (), parent: Parent | None = None):
        super().__init__()
        self.parent = parent
        self.extend(lines)

    def _traced(self, line: str) -> str:
        return line if isinstance(line, TracedLine) else TracedLine(line, self.parent)

    def append(self, line: str) -> None:
        """Add a line."""
        super().append(self._traced(line))

    def extend(self, lines: Iterable[str]) -> None:
        """Add lines."""
        super().extend([self._traced(line) for line in lines])

    def insert(self, index: SupportsIndex, line: str) -> None:
        """Add a line somewhere."""
        super().insert(index, self._traced(line))

    def __iadd__(self, lines: Iterable[str]) -> TracedLines:  # type: ignore[misc,override]
        self.extend(lines)
        return self


@dataclass
class Provenance:
    """The parents of the lines of one C file.

    Attributes
    ----------
    parents : list of Parent
        In the order in which they first appear.
    lines : list of int or None
        For each line of the file the position of its parent; None for comments, blank lines and the preprocessor, and
        for code without a parent, which `orphans` finds.
    functions : list of (name, first line, last line)
        The functions defined in the file, lines counted from 1.
    """

    parents: list[Parent] = field(default_factory=list)
    lines: list[int | None] = field(default_factory=list)
    functions: list[tuple[str, int, int]] = field(default_factory=list)

    def of_line(self, number: int) -> Parent | None:
        """Return the parent of a line, counted from 1."""
        at = self.lines[number - 1] if 0 < number <= len(self.lines) else None
        return None if at is None else self.parents[at]

    def runs(self) -> list[tuple[int, int, int]]:
        """Return (first line, last line, position of the parent) of each run of lines with one parent."""
        answer: list[tuple[int, int, int]] = []
        for number, at in enumerate(self.lines, start=1):
            if at is None:
                continue
            if answer and answer[-1][2] == at and answer[-1][1] == number - 1:
                answer[-1] = (answer[-1][0], number, at)
            else:
                answer.append((number, number, at))
        return answer


def marked(lines: Sequence[str], table: list[Parent]) -> str:
    """Return lines as one text that keeps the parent of each through a template; `unmarked` takes it out again."""
    answer = []
    at = {parent: k for k, parent in enumerate(table)}
    for line in lines:
        parent = line.parent if isinstance(line, TracedLine) else None
        if parent is None or not line.strip():
            answer.append(str(line))
            continue
        if parent not in at:
            at[parent] = len(table)
            table.append(parent)
        answer.append(f"{line}{_MARK}{at[parent]}")
    return "\n".join(answer)


def unmarked(text: str, table: Sequence[Parent]) -> tuple[str, Provenance]:
    """Return the C as it is written, and where each of its lines comes from."""
    clean: list[str] = []
    found: list[Parent | None] = []
    for line in text.split("\n"):
        code, _, number = line.partition(_MARK)
        clean.append(code)
        found.append(table[int(number)] if number else None)
    code_lines = _code_lines(clean)
    functions = []
    for first, last in _items(clean, code_lines):
        name = _function_name(clean[first : last + 1])
        if name:
            functions.append((name, first + 1, last + 1))
        if all(found[k] is None for k in range(first, last + 1)):
            purpose = _comment_above(clean, first)
            if purpose:
                helper = Parent("helper", f"{name}: {purpose}" if name else purpose)
                for k in range(first, last + 1):
                    found[k] = helper
    at: dict[Parent, int] = {}
    positions: list[int | None] = []
    for k, parent in enumerate(found):
        if parent is None or not code_lines[k]:
            positions.append(None)
            continue
        positions.append(at.setdefault(parent, len(at)))
    return "\n".join(clean), Provenance(list(at), positions, functions)


def orphans(source: str, provenance: Provenance) -> list[int]:
    """Return the lines of code (counted from 1) that have no parent."""
    code = _code_lines(source.split("\n"))
    return [k + 1 for k, is_code in enumerate(code) if is_code and provenance.of_line(k + 1) is None]


def _code_lines(lines: Sequence[str]) -> list[bool]:
    """Tell lines with code from blank ones, comments and the preprocessor."""
    answer = []
    inside = continued = False
    for line in lines:
        rest, kept = line, ""
        while rest:
            if inside:
                before, end, rest = rest.partition("*/")
                inside = not end
            else:
                before, start, rest = rest.partition("/*")
                kept += before
                inside = bool(start)
        directive = continued or kept.lstrip().startswith("#")
        continued = directive and kept.rstrip().endswith("\\")
        answer.append(bool(kept.strip()) and not directive)
    return answer


def _items(lines: Sequence[str], code: Sequence[bool]) -> list[tuple[int, int]]:
    """Return (first, last) of each item at file scope: a function, a type, a table."""
    answer: list[tuple[int, int]] = []
    depth, first = 0, -1
    for k, line in enumerate(lines):
        if not code[k]:
            continue
        text = re.sub(r'/\*.*?\*/|"(?:[^"\\]|\\.)*"', "", line)
        if first < 0:
            first = k
        depth += text.count("{") - text.count("}")
        if depth == 0 and text.rstrip().endswith((";", "}")):
            answer.append((first, k))
            first = -1
    return answer


def _function_name(lines: Sequence[str]) -> str:
    head = " ".join(lines).partition("{")[0]
    found = re.search(r"(\w+)\s*\(", head)
    return found.group(1) if found and "=" not in head and "typedef" not in head else ""


def _comment_above(lines: Sequence[str], first: int) -> str:
    """Return the comment that ends on the line above, as one line."""
    last = first - 1
    if last < 0 or not lines[last].rstrip().endswith("*/"):
        return ""
    start = last
    while start > 0 and "/*" not in lines[start]:
        start -= 1
    words = " ".join(line.strip().removeprefix("* ") for line in lines[start : last + 1])
    return words.removeprefix("/*").removesuffix("*/").strip()


# ---------------------------------------------------------------------------------------------------------------------
# What statements are there for


class Genealogy:
    """Gives the parent of each statement of an entry.

    Parameters
    ----------
    block : Block
        Owner of the entry.
    entry : Entry
        The entry.
    path : str
        Names of the parts that lead to the block, with a dot after each; empty for the exported block itself.
    """

    def __init__(self, block: Block, entry: Entry, path: str = ""):
        self.block, self.entry = block, entry
        self.label = path + entry.name
        own = (*entry.sources, block.source)
        self.sources = tuple(dict.fromkeys(item for item in own if item))

    def parent(self, kind: str, text: str, sources: Iterable[str] = ()) -> Parent:
        """Return a parent in this entry; without sources of its own it has those of the entry."""
        own = tuple(dict.fromkeys(item for item in sources if item))
        return Parent(kind, text, own or self.sources, self.label)

    def of_origin(self, origin: Origin) -> Parent:
        """Return the parent of one result of an evaluation."""
        return self.parent(origin.kind, origin.text, origin.sources)

    def of_output(self, statement: Evaluate, output: int, element: int) -> Parent:
        """Return the parent of one element of an output of an evaluation."""
        if statement.origins:
            return self.of_origin(statement.origins[output][element])
        return self.of(statement)

    def of_evaluation(self, statement: Evaluate) -> list[Parent]:
        """Return all parents of an evaluation."""
        if not statement.origins:
            return [self.of(statement)]
        return list(dict.fromkeys(self.of_origin(item) for group in statement.origins for item in group))

    def of_kernels(self, group: Sequence[Kernel]) -> Parent:
        """Return the parent of kernels that share a scope."""
        text = "; ".join(line for kernel in group for line in kernel.comment)
        return self.parent("kernel", text or type(group[0]).__name__)

    def of(self, statement: Statement) -> Parent:
        """Return the parent of a statement as a whole."""
        match statement:
            case Evaluate():
                return self.parent("evaluation", "; ".join(statement.comment) or statement.function.name())
            case Kernel():
                return self.of_kernels([statement])
            case Refuse():
                return self._judgement(statement)
            case HoldFactors():
                return self.parent(
                    "judgement", f"{statement.target.name}: variances below ceilings, D above its floors"
                )
            case HoldVariances():
                return self.parent("judgement", f"{statement.target.name}: variances between floor and ceiling")
            case When():
                return self.parent("decision", statement.comment or "which of two ways")
            case Call():
                return self.parent("call", f"{statement.part}.{statement.entry}".removeprefix("."))
            case Attempt():
                calls = ", then ".join(call.entry for call in statement.calls)
                return self.parent("call", f"{calls}, as one transaction")
            case Raise():
                return self.parent("status", f"at least {statement.status.name}")
            case Restore():
                return self.parent("bookkeeping", "memory as before the call")
            case CountUp():
                return self.parent("bookkeeping", f"{statement.target.name} counts up, and stays at its largest value")
            case Assign():
                source = statement.source.name if isinstance(statement.source, Place) else f"{statement.source:g}"
                return self.parent("assignment", f"{statement.target.name} = {source}")
            case AssignElement():
                target = f"{statement.target.place.name}[{statement.target.index}]"
                return self.parent("assignment", f"{target} = {statement.source.place.name}[{statement.source.index}]")
            case _:
                return self.parent("statement", type(statement).__name__)

    def _judgement(self, statement: Refuse) -> Parent:
        places = list(dict.fromkeys(places_of(statement.unless)))
        signals = [self._signal(place) for place in places]
        if all(signal is not None for signal in signals) and not statement.comment:
            ranges = "; ".join(_range_text(signal) for signal in signals if signal is not None)
            sources = [signal.source or self.block.source for signal in signals if signal is not None]
            return self.parent("judgement", f"{statement.status.name} unless {ranges}", sources)
        names = statement.comment or ", ".join(place.name for place in places)
        return self.parent("judgement", f"{statement.status.name} unless within bounds: {names}")

    def _signal(self, place: Place) -> Signal | None:
        groups = {
            "in": [*self.entry.inputs, *[signal for signal, _ in self.entry.hidden]],
            "out": list(self.entry.outputs),
            "param": self.block.param_signals_flat(),
            "memory": self.block.memory_signals_flat(),
            "next": self.block.memory_signals_flat(),
        }
        return next((item for item in groups.get(place.space, []) if item.name == place.name), None)


def places_of(condition: Condition) -> list[Place]:
    """Return the places that a condition reads, in order."""
    match condition:
        case AllOf() | AnyOf():
            return [place for item in condition.conditions for place in places_of(item)]
        case Within():
            return [condition.place]
        case IsSet():
            return [condition.flag.place]
        case Compare():
            return [item.place for item in (condition.left, condition.right) if isinstance(item, Element)]
        case _:
            return []


def _range_text(signal: Signal) -> str:
    if signal.kind is not Kind.REAL or signal.uniform_range is None:
        return f"{signal.name} is within its range"
    low, high = signal.uniform_range
    return f"{low:g} <= {signal.name} <= {high:g}" + (f" {signal.unit}" if signal.unit else "")
