"""From an entry's program to the text of a C function: straight-line form.

Every kernel becomes a block of constants that ends in stores to the candidate memory. An entry's core reads the memory
`before` and writes the candidate `after`, which nobody uses unless the status is good: compute, judge, commit.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from ..symbolic.block import Block
from ..symbolic.expressions import TABLES, tape
from ..symbolic.kernels import AllStatesUpdate, Scale
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
    walk,
)
from ..symbolic.signals import Kind, Signal, Status
from .graph import Graph, Node
from .mathematics import EXACT, mathematics_name
from .provenance import Genealogy, Parent, TracedLines
from .rows import pair_operations
from .style import WIDTH, Precision, comment_lines, wrap_line
from .tables import Tables, table_of

_INFIX = {
    "add": "+", "sub": "-", "mul": "*", "div": "/", "lt": "<", "le": "<=", "eq": "==", "ne": "!=", "ge": ">=",
    "and": "&&", "or": "||",
}  # fmt: skip
_COUNTED = {"add": "addition", "sub": "addition", "mul": "multiplication", "div": "division", "neg": "negation"}
_LONGEST_INLINE = 84
_LONGEST_SCALE = 8
_SHORTEST_COPY = 6
_LARGEST_GUARDED = 8000
_PLAIN = re.compile(r"[-\w.]+( [-+*/] [-\w.]+)+")
"""Between `?` and `:` cppcheck (2.10) drops the parentheses around such a text, and then misses them (MISRA 12.1)."""

Slot = tuple[Place, int]


@dataclass
class Style:
    """Choices of the emitter that a target makes.

    `rows_per_scope` measurement rows share a scope before the covariance is stored: 1 is best without fused
    multiply-add, 4 with it (research/codegen_performance.md, section 9). `mathematics` says whose `sin`, `exp` ... are
    called: plantc's ``own``, or those of the C library (``libm``).
    """

    precision: Precision
    rows_per_scope: int
    mathematics: str = "own"


def style_for(precision: Precision, mathematics: str = "own") -> Style:
    """Return the emitter's choices for a precision: single is for FPUs with fused multiply-add."""
    return Style(precision, 4 if precision.is_float else 1, mathematics)


@dataclass
class CoreText:
    """A core function and what it needs."""

    lines: TracedLines
    operations: Counter[str]
    functions: set[str]
    own: set[str] = field(default_factory=set)


def core_name(prefix: str, entry: Entry) -> str:
    """Return the name of an entry's core."""
    return f"{prefix}_{entry.name}_core"


def is_sequenced(entry: Entry) -> bool:
    """Whether an entry calls other entries of its own block."""
    return any(isinstance(item, Call) and not item.part for item in walk(entry.body))


def has_outputs(entry: Entry) -> bool:
    """Whether an entry has an output struct."""
    return bool(entry.outputs)


class CoreWriter:
    """Writes the core of one entry."""

    def __init__(self, block: Block, entry: Entry, prefix: str, style: Style, root: str, tables: Tables | None = None):
        self.block, self.entry, self.prefix, self.style, self.root = block, entry, prefix, style, root
        self.tables = Tables() if tables is None else tables
        self.precision = style.precision
        self.upper = root.upper()
        self.graph = Graph()
        path = prefix.removeprefix(root).removeprefix("_")
        self.genealogy = Genealogy(block, entry, f"{path}." if path else "")
        self.lines = TracedLines()
        self.opened: list[Parent | None] = []
        self.indent = "    "
        self.names: list[set[str]] = [set(_RESERVED) | {signal.name for signal in self._arguments()}]
        self.bound: dict[Node, str] = {}
        self.fixed: dict[Place, list[Node]] = {}
        self.arrays: dict[Place, int] = {}
        self.declared: list[str] = []
        self.guarding = False
        self.inside: dict[Place, str] = {}
        self.arrays_inside: dict[Place, int] = {}
        self.versions: Counter[Place] = Counter()
        self.operations: Counter[str] = Counter()
        self.functions: set[str] = set()
        self.own: set[str] = set()
        self.sizes = {signal.name: signal for signal in block.memory_signals_flat()}

    # -- the function -------------------------------------------------------------------------------------------------

    def _arguments(self) -> list[Signal]:
        return [*self.entry.inputs, *[signal for signal, _ in self.entry.hidden]]

    def signature(self) -> str:
        """Return the C declaration of the core, without semicolon."""
        p, real = self.prefix, self.precision.name
        parts = []
        if not self.entry.checks_params:
            parts.append(f"const {p}_state_t *before")
        parts += [f"{p}_state_t *after"]
        if self._needs_params():
            parts.append(f"const {p}_params_t *params")
        for signal in self._arguments():
            kind = {Kind.REAL: real, Kind.FLAG: "bool", Kind.COUNT: "uint32_t"}[signal.kind]
            parts.append(f"const {kind} {signal.name}" + (f"[{signal.size}]" if signal.size > 1 else ""))
        if has_outputs(self.entry):
            parts.append(f"{p}_{self.entry.name}_out_t *out")
        return f"static {self.root}_status_t {core_name(p, self.entry)}({', '.join(parts)})"

    def _needs_params(self) -> bool:
        return needs_params(self.block, self.entry)

    def write(self) -> CoreText:
        """Return the text of the core."""
        if is_sequenced(self.entry):
            self._sequence()
        else:
            self._plain(self._judged_inputs())
            if len(self.lines) * self._comparisons() > _LARGEST_GUARDED:
                return self._judged_apart()
        head = wrap_signature(self.signature())
        frame = self.genealogy.parent("entry", self.entry.doc or f"the entry {self.entry.name}")
        return CoreText(TracedLines([*head, "{", *self.lines, "}"], frame), self.operations, self.functions, self.own)

    def _judged_inputs(self) -> list[Refuse]:
        """Return the judgement of the entry's inputs, if it has any."""
        judged = self.block.judge_inputs(self.entry)
        return [Refuse(Status.BAD_INPUT, judged)] if isinstance(judged, AllOf) and judged.conditions else []

    def _comparisons(self) -> int:
        """Return how many comparisons the judgement of the inputs takes."""
        return sum(len(self._clauses(item.unless)) for item in self._judged_inputs())

    def _judged_apart(self) -> CoreText:
        """Return the core in two functions: one judges the inputs and calls the other, which does the rest.

        cppcheck (2.10) goes through all that a condition guards once for each of its comparisons: over a long body that
        takes it minutes.
        """
        inner, outer = (
            CoreWriter(self.block, self.entry, self.prefix, self.style, self.root, self.tables) for _ in range(2)
        )
        name = f"{self.prefix}_{self.entry.name}_judged"
        inner._plain([])
        frame = self.genealogy.parent("entry", self.entry.doc or f"the entry {self.entry.name}")
        signature = self.signature()
        own = signature.replace(f"{core_name(self.prefix, self.entry)}(", f"{name}(", 1)
        first = [*wrap_signature(own), "{", *inner.lines, "}", ""]
        names = [
            re.split(r"\W+", item.split("[")[0])[-1] for item in signature.partition("(")[2].rstrip(")").split(", ")
        ]
        outer._bookkeeping("the status to be returned")
        outer._line(f"{self.root}_status_t status = {self.upper}_OK;")
        (judgement,) = outer._judged_inputs()
        outer.lines.parent = outer.genealogy.of(judgement)
        outer._refuse(judgement, [])
        outer._open("else")
        outer._line(f"status = {name}({', '.join(names)});")
        outer._close()
        outer._bookkeeping("the status to be returned")
        outer._line("return status;")
        second = [*wrap_signature(signature), "{", *outer.lines, "}"]
        return CoreText(TracedLines([*first, *second], frame), inner.operations, inner.functions, inner.own)

    def _plain(self, judged: Sequence[Refuse]) -> None:
        entry = self.entry
        u = self.upper
        body: list[Statement] = list(entry.body)
        if entry.checks_params and (self.block.param_signals):
            body.insert(0, Refuse(Status.BAD_PARAM, self.block.judge_params()))
        body = [*judged, *body]
        untouched = self._untouched(body)
        self._statements(body)
        text = self.lines
        self.lines = TracedLines(parent=self._bookkeeping("numbers that stages hand on"))
        for place, size in self.arrays.items():
            self._line(f"{self.precision.name} {place.name}[{size}];")
        for text_of in self.declared:
            self._line(text_of)
        self._bookkeeping("the status to be returned")
        self._line(f"{self.root}_status_t status = {u}_OK;")
        self._line("")
        self._bookkeeping("fields that the entry leaves alone are carried over")
        for signal in untouched:
            self._copy_field(signal)
        if untouched:
            self._line("")
        if not self.block.memory_group().members:
            self._line("after->unused = 0U;")
        if not self.entry.checks_params and not any(map(_reads_before, (*self.lines, *text))):
            self._line("(void)before;")
        self.lines += text
        self._bookkeeping("the status to be returned")
        self._line("return status;")

    def _untouched(self, body: Sequence[Statement]) -> list[Signal]:
        """Return the memory fields that no path but a full restore writes; they are carried over first."""
        if self.entry.checks_params:
            return []
        written: set[str] = set()
        for statement in walk(body):
            for place in _targets(statement):
                if place.space == "next":
                    written.add(place.name)
            if isinstance(statement, Call) and statement.part:
                written.add(statement.part)
        parts = set(self.block.parts)
        return [
            signal for signal in self.block.memory_group().members if signal.name not in written | (parts & written)
        ]

    def _copy_field(self, signal: Signal) -> None:
        if signal.size == 1 or signal.kind is Kind.GROUP:
            self._line(f"after->{signal.name} = before->{signal.name};")
        elif signal.size <= 4:
            for i in range(signal.size):
                self._line(f"after->{signal.name}[{i}] = before->{signal.name}[{i}];")
        else:
            self._loop(signal.size, f"after->{signal.name}[i] = before->{signal.name}[i];")

    def _loop(self, size: int, inner: str) -> None:
        self._open(f"for (uint32_t i = 0U; i < {size}U; i++)")
        self._line(inner)
        self._close()

    # -- text helpers -------------------------------------------------------------------------------------------------

    def _bookkeeping(self, what: str) -> Parent:
        """Have the lines that follow belong to bookkeeping of a named kind."""
        self.lines.parent = self.genealogy.parent("bookkeeping", what)
        return self.lines.parent

    def _line(self, text: str) -> None:
        if not text:
            if self.lines and self.lines[-1] and not self.lines[-1].strip().endswith("{"):
                self.lines.append("")
            return
        self.lines += wrap_line(text, self.indent)

    def _open(self, head: str = "") -> None:
        if head:
            self._line(head)
        self._line("{")
        self.opened.append(self.lines.parent)
        self.indent += "    "
        self.names.append(set())

    def _close(self) -> None:
        self.names.pop()
        self.indent = self.indent[:-4]
        if self.lines and not self.lines[-1]:
            self.lines.pop()
        self.lines.parent = self.opened.pop()
        self._line("}")

    def _comment(self, text: str) -> None:
        if text:
            self.lines += comment_lines(text, self.indent)

    def _fresh(self, stem: str) -> str:
        taken = set().union(*self.names)
        name, k = stem, 2
        while name in taken:
            name, k = f"{stem}_{k}", k + 1
        self.names[-1].add(name)
        return name

    # -- statements ---------------------------------------------------------------------------------------------------

    def _statements(self, body: Sequence[Statement]) -> None:
        """Write statements; what follows one that may refuse goes into its else branch."""
        index = 0
        while index < len(body):
            statement = body[index]
            rest = body[index + 1 :]
            self.lines.parent = self.genealogy.of(statement)
            if isinstance(statement, AllStatesUpdate):
                self._all_states(statement)
                index += 1
                continue
            if isinstance(statement, Scale) and statement.size > _LONGEST_SCALE:
                self._scale(statement)
                index += 1
                continue
            if isinstance(statement, Kernel):
                group = [statement]
                while index + len(group) < len(body) and len(group) < self.style.rows_per_scope:
                    following = body[index + len(group)]
                    if type(following) is not type(statement):
                        break
                    group.append(following)
                self._kernels(group)
                index += len(group)
                continue
            if isinstance(statement, Refuse):
                if _is_trivial(statement.unless):
                    index += 1
                    continue
                self._refuse(statement, rest)
                return
            if isinstance(statement, HoldVariances):
                self._hold(statement)
                self._rest(rest)
                return
            self._one(statement)
            if isinstance(statement, (When, Call)) and may_refuse(statement):
                self._rest(rest)
                return
            index += 1

    def _rest(self, rest: Sequence[Statement]) -> None:
        if rest:
            self._open(f"if (status >= {self.upper}_OK)")
            self._statements(rest)
            self._close()

    def _one(self, statement: Statement) -> None:
        u = self.upper
        match statement:
            case Evaluate():
                self._evaluate(statement)
            case When():
                self._line("")
                self._comment(statement.comment)
                self._condition_head("if ", statement.condition, "")
                outer = dict(self.bound)  # a name that one branch gives is not known to the other
                self._open()
                self._statements(statement.then)
                self._close()
                self.bound = dict(outer)
                if statement.otherwise:
                    self._open("else")
                    self._statements(statement.otherwise)
                    self._close()
                    self.bound = outer
            case Raise():
                self._line(f"status = {self.root}_higher(status, {u}_{statement.status.name});")
                self.functions.add("higher")
            case Restore():
                self._line("*after = *before;")
                for name in self.sizes:
                    self.versions[Place("next", name)] += 1
            case Assign():
                self._assign(statement)
            case AssignElement():
                self._line(f"{self._slot(statement.target)} = {self._operand(statement.source)};")
                self.versions[statement.target.place] += 1
            case CountUp():
                slot = self._slot(Element(statement.target))
                self._open(f"if ({slot} < UINT32_MAX)")
                self._line(f"{slot} = {slot} + 1U;")
                self._close()
            case Call():
                self._part_call(statement)
            case _:
                raise NotImplementedError(type(statement).__name__)

    def _assign(self, statement: Assign) -> None:
        target = statement.target
        if isinstance(statement.source, Place):
            for i in range(statement.size):
                value = self._operand(Element(statement.source, i))
                self._line(f"{self._slot(Element(target, i))} = {value};")
        else:
            number = self._number_for(target, float(statement.source))
            if target.space == "local":
                self.fixed[target] = [self.graph.const(float(statement.source))] * statement.size
                return
            if statement.size > 4:
                self._loop(statement.size, f"{self._base(target)}[i] = {number};")
            else:
                for i in range(statement.size):
                    self._line(f"{self._slot(Element(target, i))} = {number};")
        self.versions[target] += 1

    def _number_for(self, place: Place, value: float) -> str:
        signal = self._signal(place)
        if signal is not None and signal.kind is Kind.COUNT:
            return f"{int(value)}U"
        if signal is not None and signal.kind is Kind.STATUS:
            return f"{self.upper}_OK"
        return self.precision.literal(value)

    def _signal(self, place: Place) -> Signal | None:
        if place.space in ("memory", "next"):
            return self.sizes.get(place.name)
        groups = {"in": self._arguments(), "out": list(self.entry.outputs), "param": self.block.param_signals_flat()}
        found: Signal | None = None
        members = groups.get(place.space, [])
        pieces = [place.name] if place.space == "param" else place.name.split(".")
        for piece in pieces:
            found = next((item for item in members if item.name == piece), None)
            members = list(found.members) if found else []
        return found

    def _base(self, place: Place) -> str:
        if isinstance(place, _LatestPlace):
            return f"latest->{place.name}"
        where = {"memory": "before->", "next": "after->", "param": "params->", "out": "out->", "in": "", "local": ""}
        return where[place.space] + place.name

    def _slot(self, element: Element) -> str:
        place = element.place
        if place.space == "local":
            # single numbers are plain names where a call wrote them, arrays otherwise
            if place in self.inside:
                return self.inside[place] + (f"[{element.index}]" if self.arrays_inside[place] > 1 else "")
            return f"{place.name}[{element.index}]" if place in self.arrays else place.name
        signal = self._signal(place)
        size = 1 if signal is None else signal.size
        return self._base(place) + (f"[{element.index}]" if size > 1 else "")

    def _operand(self, operand: Element | float) -> str:
        if not isinstance(operand, Element):
            return self.precision.literal(operand)
        if operand.place in self.fixed:
            return self._expression(self.fixed[operand.place][operand.index], Counter())
        return self._slot(operand)

    # -- conditions ---------------------------------------------------------------------------------------------------

    def _condition_head(self, before: str, condition: Condition, after: str) -> None:
        clauses = self._clauses(condition)
        joined = (" && " if not isinstance(condition, AnyOf) else " || ").join(clauses)
        if len(clauses) > 1 or not joined.startswith("("):
            joined = f"({joined})"
        self.lines += _wrap_condition(before + joined + after, self.indent)

    def _clauses(self, condition: Condition) -> list[str]:
        """Return the conjuncts (or, of AnyOf, the disjuncts) of a condition, each in parentheses."""
        match condition:
            case AllOf():
                clauses = []
                for item in condition.conditions:
                    inner = self._clauses(item)
                    clauses += [f"({' || '.join(inner)})"] if isinstance(item, AnyOf) and len(inner) > 1 else inner
                return clauses
            case AnyOf():
                clauses = []
                for item in condition.conditions:
                    inner = self._clauses(item)
                    clauses += inner if len(inner) == 1 or isinstance(item, AnyOf) else [f"({' && '.join(inner)})"]
                return clauses
            case Within():
                return self._within(condition)
            case Compare():
                left, right = self._comparable(condition.left, condition.right)
                return [self._compared(f"{left} {condition.relation} {right}")]
            case IsSet():
                signal = self._signal(condition.flag.place)
                slot = self._operand(condition.flag)
                if signal is not None and signal.kind is Kind.FLAG:
                    return [slot]
                return [f"({slot} != {self.precision.literal(0.0)})"]
            case _:
                raise NotImplementedError(type(condition).__name__)

    def _comparable(self, left: Element | float, right: Element | float) -> tuple[str, str]:
        kinds = [self._signal(item.place) for item in (left, right) if isinstance(item, Element)]
        if any(signal is not None and signal.kind is Kind.COUNT for signal in kinds):
            return tuple(  # type: ignore[return-value]
                self._operand(item) if isinstance(item, Element) else f"{int(item)}U" for item in (left, right)
            )
        return self._operand(left), self._operand(right)

    def _within(self, condition: Within) -> list[str]:
        clauses = []
        for k, (low, high) in enumerate(zip(condition.low, condition.high, strict=True)):
            slot = self._operand(Element(condition.place, condition.first + k))
            clauses.append(self._compared(f"{slot} >= {self.precision.literal(low)}"))
            clauses.append(self._compared(f"{slot} <= {self.precision.literal(high)}"))
        return clauses

    def _compared(self, text: str) -> str:
        """Return a comparison as a clause; one that guards a commit also tells the analyser that it is false for NaN."""
        return f"(({text}) == true)" if self.guarding else f"({text})"

    def _call(self, name: str, *arguments: str) -> str:
        function = self.precision.function(name)
        self.functions.add(function)
        if self.style.mathematics == "own" and name not in EXACT:
            self.own.add(name)
            function = mathematics_name(self.root, name)
        return f"{function}({', '.join(arguments)})"

    def _refuse(self, statement: Refuse, rest: Sequence[Statement]) -> None:
        if self.lines and self.lines[-1]:
            self._line("")
        self._comment(statement.comment)
        self.guarding = True
        self._condition_head("if (!", statement.unless, ")")
        self.guarding = False
        self._open()
        self._line(f"status = {self.upper}_{statement.status.name};")
        self._close()
        if rest and any(not (isinstance(item, Refuse) and _is_trivial(item.unless)) for item in rest):
            self._open("else")
            self._statements(rest)
            self._close()

    def _hold(self, statement: HoldVariances) -> None:
        # a matrix of one element is a plain number in the struct
        base = ("&" if statement.size == 1 else "") + self._base(statement.target)
        self._line("")
        self._comment("judge, then commit")
        holder = "hold_factors" if isinstance(statement, HoldFactors) else "hold_variances"
        self._open(f"if (!{self.prefix}_is_bounded({base}))")
        self._line(f"status = {self.prefix}_{holder}({base});")
        self.functions.add("hold_variances")
        self._close()
        self.versions[statement.target] += 1

    def _all_states(self, kernel: AllStatesUpdate) -> None:
        """Write the update by a sensor of all states: calls that take two rows each, from one buffer to the other."""
        first = kernel.rows[0]
        size, packed = first.size, first.size * (first.size + 1) // 2
        zero = self.precision.literal(0.0)
        self.declared += [f"{self.prefix}_rows_t work;", f"{self.precision.name} spare_covariance[{packed}];"]
        for place, count in ((first.delta, size), (first.scales, size), (first.nis, 1)):
            self.inside[place], self.arrays_inside[place] = f"work.{place.name}", count
        noise = self._noise_of(first.r, size)
        self._line("")
        for line in kernel.comment:
            self._comment(line)
        for i in range(size):  # no loop: gcc's analyzer takes it to leave elements unset
            self._line(f"work.{first.delta.name}[{i}] = {zero};")
        self._line(f"work.{first.nis.name} = {zero};")
        spare, target = "spare_covariance", self._base(first.target)
        source = self._base(first.p)
        turns = size // 2
        for turn in range(turns):
            after = target if (turns - turn) % 2 else spare
            row = 2 * turn
            self._comment(f"rows {row} and {row + 1}")
            residual = f"&{self._base(first.residual)}[{row}]"
            variance = f"&work.{first.scales.name}[{row}]"
            self._line(f"{self.prefix}_gain({source}, {after}, &work, {residual}, &{noise}[{row}], {variance});")
            self._line(f"{self.prefix}_place({after}, &work);")
            self._line(f"{self.prefix}_downdate({source}, {after}, &work);")
            source = after
        self.operations += pair_operations(size)
        for place, _ in kernel.writes:
            self.versions[place] += 1

    def _noise_of(self, place: Place, size: int) -> str:
        """Return an array that holds the variances of the rows: the parameter itself, or a copy."""
        nodes = self._read(place, size)
        elements = [node.element for node in nodes if node.operation == "load"]
        if len(elements) == size and elements == [(elements[0][0], k, elements[0][2]) for k in range(size)]:
            return self._base(elements[0][0])
        self.declared.append(f"{self.precision.name} row_noise[{size}];")
        copy = Place("local", "row_noise")
        self.inside[copy], self.arrays_inside[copy] = "row_noise", size
        self._emit([((copy, k), node) for k, node in enumerate(nodes)])
        return "row_noise"

    def _scale(self, kernel: Scale) -> None:
        """Write a multiplication of a long vector as a loop."""
        self._line("")
        for line in kernel.comment:
            self._comment(line)
        factor = self._operand(Element(kernel.factor))
        self._loop(kernel.size, f"{self._base(kernel.target)}[i] = {factor} * {self._base(kernel.source)}[i];")
        self.operations["multiplication"] += kernel.size
        self.versions[kernel.target] += 1

    # -- arithmetic ---------------------------------------------------------------------------------------------------

    def _read(self, place: Place, size: int) -> list[Node]:
        if place in self.fixed:
            return self.fixed[place]
        return [self.graph.load(place, i, self.versions[place]) for i in range(size)]

    def _evaluate(self, statement: Evaluate) -> None:
        inputs = [[node for place, size in places for node in self._read(place, size)] for places in statement.reads]
        outputs = self.graph.from_tape(tape(statement.function), inputs)
        stores: list[tuple[Slot | None, Node]] = []
        parents: list[Parent] = []
        for k, (values, places, names) in enumerate(zip(outputs, statement.writes, statement.names, strict=True)):
            parents += [self.genealogy.of_output(statement, k, i) for i in range(len(values))]
            start = 0
            for place, size in places:
                own = values[start : start + size]
                for i, node in enumerate(own):
                    if place.space == "local":
                        node.named(names[start + i])
                        stores.append((None, node))
                    else:
                        stores.append(((place, i), node.named(names[start + i])))
                if place.space == "local":
                    self.fixed[place] = own
                start += size
        if self.lines and self.lines[-1]:
            self._line("")
        for line in statement.comment:
            self._comment(line)
        self._emit(stores, parents)
        for places in statement.writes:
            for place, _ in places:
                self.versions[place] += 1

    def _kernels(self, group: Sequence[Kernel]) -> None:
        """Write kernels in one scope; what one writes the next reads without a detour through memory."""
        pending: dict[Slot, Node] = {}
        comments: list[str] = []
        for kernel in group:
            values = []
            for (place, size), stems in zip(kernel.reads, kernel.names(), strict=True):
                nodes = self._read(place, size)
                current = [pending.get((place, i), node) for i, node in enumerate(nodes)]
                for node, stem in zip(current, stems, strict=True):
                    if node.operation == "load" and not node.hint:
                        node.hint = stem
                values.append(current)
            answers = kernel.scalar(*values)
            for k, ((place, size), answer) in enumerate(zip(kernel.writes, answers, strict=True)):
                if place.space == "local":
                    self.arrays.setdefault(place, size)
                    self.names[0].add(place.name)
                for i in kernel.order(k):
                    node = answer[i]
                    if node is not None:
                        pending[place, i] = self.graph.const(node) if isinstance(node, float) else node
            comments += kernel.comment
        self._line("")
        self.lines.parent = self.genealogy.of_kernels(group)
        for line in comments:
            self._comment(line)
        outer = dict(self.bound)
        self._open()
        # where a matrix has blocks, those that a kernel leaves alone are long runs
        self._emit(list(pending.items()), loops=any(getattr(kernel, "packing", None) for kernel in group))
        self._close()
        self.bound = outer
        for place, _ in pending:
            self.versions[place] += 1

    def _emit(
        self, stores: Sequence[tuple[Slot | None, Node]], parents: Sequence[Parent] = (), *, loops: bool = False
    ) -> None:
        """Print values in order: constants on lines of their own, then the stores.

        An element that is both read and overwritten is read first. A line that several values need belongs to the parent
        of the first.
        """
        uses: Counter[Node] = Counter()
        seen: set[Node] = set()
        stack = [node for _, node in stores]
        for node in stack:
            uses[node] += 1
        while stack:
            node = stack.pop()
            if node in seen or node in self.bound:
                continue
            seen.add(node)
            for argument in node.arguments:
                uses[argument] += 1
                stack.append(argument)
        loads = {node.element[:2]: node for node in seen if node.operation == "load"}
        copied = self._copies(stores, uses, loads) if loops else set()
        for k, (slot, node) in enumerate(stores):
            if k in copied:
                continue
            if parents:
                self.lines.parent = parents[k]
            if slot is None:
                if node.operation not in ("const", "load"):
                    self._bind(node, uses)
                continue
            if node.operation == "load" and node.element == (*slot, self.versions[slot[0]]):
                continue  # it is there already
            text = self._expression(node, uses, top=True)
            shadowed = loads.get((slot[0], slot[1]))
            if shadowed is not None and shadowed not in self.bound and uses[shadowed] > 0:
                self._bind(shadowed, uses)
                text = self._expression(node, uses, top=True) if node is shadowed else text
            self._line(f"{self._slot(Element(slot[0], slot[1]))} = {text};")

    def _copies(
        self, stores: Sequence[tuple[Slot | None, Node]], uses: Counter[Node], loads: Mapping[Slot, Node]
    ) -> set[int]:
        """Write long runs of elements that are handed on as they are as loops; return which stores these were."""
        found: set[int] = set()
        run: list[int] = []

        def close() -> None:
            if len(run) >= _SHORTEST_COPY:
                (target, first), (source, _, _) = stores[run[0]][0], stores[run[0]][1].element  # type: ignore[misc]
                at = f"{first}U + i" if first else "i"
                self._loop(len(run), f"{self._base(target)}[{at}] = {self._base(source)}[{at}];")
                found.update(run)
            run.clear()

        for k, (slot, node) in enumerate(stores):
            plain = slot is not None and node.operation == "load" and uses[node] == 1 and node not in self.bound
            plain = plain and slot is not None and node.element[0] != slot[0] and node.element[1] == slot[1]
            plain = plain and slot not in loads
            if not plain:
                close()
                continue
            assert slot is not None
            if run:
                before, last = stores[run[-1]]
                assert before is not None
                if (slot[0], slot[1], node.element[0]) != (before[0], before[1] + 1, last.element[0]):
                    close()
            run.append(k)
        close()
        return found

    def _bind(self, node: Node, uses: Counter[Node]) -> str:
        """Give a node a line and a name of its own."""
        if node in self.bound:
            return self.bound[node]
        text = self._text(node, uses)
        stem = node.hint or "v"
        if node.operation == "load" and not node.hint:
            place, index, _ = node.element
            signal = self._signal(place)
            single = signal is not None and signal.size == 1
            stem = place.name.replace(".", "_") + ("" if single else f"_{index}")
        name = self._fresh(stem)
        kind = "bool" if node.is_boolean else self.precision.name
        self._line(f"const {kind} {name} = {text};")
        self.bound[node] = name
        return name

    def _expression(self, node: Node, uses: Counter[Node], *, top: bool = False) -> str:
        """Return the text of a node, binding it first where it is used again, named, or long."""
        if node in self.bound:
            return self.bound[node]
        if node.operation == "const":
            return self.precision.literal(node.value)
        if node.operation == "load":
            place, index, _ = node.element
            if uses[node] > 1 and place.space != "in":
                return self._bind(node, uses)
            uses[node] -= 1
            return self._slot(Element(place, index))
        if not top and (uses[node] > 1 or node.hint):
            return self._bind(node, uses)
        if top and uses[node] > 1:
            return self._bind(node, uses)
        text = self._text(node, uses)
        return text if top or len(text) <= _LONGEST_INLINE else self._bind_text(node, text)

    def _bind_text(self, node: Node, text: str) -> str:
        """Give a node whose text is known a line and a name of its own."""
        name = self._fresh(node.hint or "v")
        self._line(f"const {'bool' if node.is_boolean else self.precision.name} {name} = {text};")
        self.bound[node] = name
        return name

    def _text(self, node: Node, uses: Counter[Node]) -> str:
        if node.operation == "load":
            place, index, _ = node.element
            uses[node] -= 1
            return self._slot(Element(place, index))
        if node.operation == "const":
            return self.precision.literal(node.value)
        if node.operation in TABLES:
            self.operations[node.operation] += 1
            x = self._expression(node.arguments[0], uses)
            return self.tables.call(self.root, node.operation, table_of(node.arguments), x)
        parts = [self._expression(item, uses) for item in node.arguments]
        if node.operation == "select" and _PLAIN.fullmatch(parts[1]):
            parts[1] = self._bind_text(node.arguments[1], parts[1])
        wrapped = [f"({text})" if _is_compound(text) else text for text in parts]
        operation = node.operation
        if operation in _COUNTED:
            self.operations[_COUNTED[operation]] += 1
        if operation in _INFIX:
            return f"{wrapped[0]} {_INFIX[operation]} {wrapped[1]}"
        if operation == "neg":
            return f"-{wrapped[0]}"
        if operation == "not":
            return f"!{wrapped[0]}"
        if operation == "select":
            self.operations["selection"] += 1
            return f"{wrapped[0]} ? {wrapped[1]} : {wrapped[2]}"
        self.operations[self.precision.function(operation)] += 1
        return self._call(operation, *parts)

    # -- calls --------------------------------------------------------------------------------------------------------

    def _argument(self, argument: Place | float, signal: Signal) -> str:
        if not isinstance(argument, Place):
            return f"{int(argument)}U" if signal.kind is Kind.COUNT else self.precision.literal(argument)
        return self._base(argument)

    def call_text(self, call: Call, before: str, after: str) -> str:
        """Return the C of a call to another core."""
        block = self.block.parts[call.part] if call.part else self.block
        prefix = f"{self.prefix}_{self.block.twin(call.part)}" if call.part else self.prefix
        entry = block.entries[call.entry]
        given = dict(call.arguments)
        parts = []
        if not entry.checks_params:
            parts.append(before)
        parts.append(after)
        if needs_params(block, entry):
            parts.append(f"&params->{call.part}" if call.part else "params")
        for signal in entry.inputs:
            parts.append(self._argument(given[signal.name], signal))
        for signal, place in entry.hidden:
            default = Place(place.space, f"{call.part}.{place.name}" if call.part else place.name)
            parts.append(self._argument(given.get(signal.name, default), signal))
        if has_outputs(entry):
            assert call.outputs is not None
            parts.append(f"&{self._base(call.outputs)}")
        return f"{core_name(prefix, entry)}({', '.join(parts)})"

    def _part_call(self, call: Call) -> None:
        """A call to a part of a composition: it works on the part's own memory."""
        block = self.block.parts[call.part]
        text = self.call_text(call, f"&before->{call.part}", f"&after->{call.part}")
        self._line("")
        self._comment(f"{call.part}: {block.name}, {call.entry}")
        own = self._fresh(f"status_{call.part}")
        self._line(f"const {self.root}_status_t {own} = {text};")
        self._line(f"status = ({own} < {self.upper}_OK) ? {own} : {self.root}_higher(status, {own});")
        self.functions.add("higher")

    def _sequence(self) -> None:
        """Write an entry that calls others of its block: each call goes from the latest memory to a spare one."""
        p, u = self.prefix, self.upper
        attempts = [item for item in walk(self.entry.body) if isinstance(item, Attempt)]
        depth = max((len(item.calls) for item in attempts), default=1)
        self._bookkeeping("the latest memory, and spare ones for what may be refused")
        self._line(f"{p}_state_t work[{max(1, depth)}];")
        self._line(f"{p}_state_t *latest = &work[0];")
        if attempts:
            self._line(f"{p}_state_t *spare = after;")
        first, *rest = self.entry.body
        assert isinstance(first, Call)
        self.lines.parent = self.genealogy.of(first)
        self._line(f"{self.root}_status_t status = {self.call_text(first, 'before', 'latest')};")
        self._line("")
        self._open(f"if (status >= {u}_OK)")
        self._all_sequenced(rest, more=False)
        self.lines.parent = self.genealogy.parent("commit", "the latest memory is the answer")
        if attempts:
            self._open("if (latest != after)")
        self._line("*after = *latest;")
        if attempts:
            self._close()
        self._close()
        self._bookkeeping("the status to be returned")
        self._line("return status;")

    def _all_sequenced(self, statements: Sequence[Statement], *, more: bool) -> None:
        """Write statements one after the other; `more`: whether attempts follow after them."""
        for k, statement in enumerate(statements):
            later = any(isinstance(item, Attempt) for item in walk(statements[k + 1 :]))
            self._sequenced(statement, more=more or later)

    def _sequenced(self, statement: Statement, *, more: bool) -> None:
        self.lines.parent = self.genealogy.of(statement)
        if isinstance(statement, When):
            self._comment(statement.comment)
            self._condition_head("if ", _on_latest(statement.condition), "")
            self._open()
            self._all_sequenced(statement.then, more=more)
            self._close()
            if statement.otherwise:
                self._open("else")
                self._all_sequenced(statement.otherwise, more=more)
                self._close()
        elif isinstance(statement, Attempt):
            self._attempt(statement, more=more)
        else:
            self._one(statement)

    def _attempt(self, statement: Attempt, *, more: bool) -> None:
        p, u = self.prefix, self.upper
        calls = statement.calls
        self._line(
            f"{self.root}_status_t own = {self.call_text(calls[0], 'latest', 'spare' if len(calls) == 1 else '&work[1]')};"
        )
        if len(calls) > 1:
            self._line(f"{self.root}_status_t highest = status;")
        self._line("")
        for k, call in enumerate(calls[1:], start=1):
            last = k == len(calls) - 1
            source, target = f"&work[{k}]", "spare" if last else f"&work[{k + 1}]"
            self._open(f"if (own >= {u}_OK)")
            self._line(f"highest = {self.root}_higher(highest, own);")
            self._line(f"own = {self.call_text(call, source, target)};")
            self._close()
        self._line(f"out->{statement.status.name} = own;")
        self._open(f"if (own >= {u}_OK)")
        if more:
            self._line(f"{p}_state_t *const taken = spare;")
            self._line("")
            self._line("spare = latest;")
            self._line("latest = taken;")
        else:
            self._line("latest = spare;")
        self._line(f"status = {self.root}_higher({'highest' if len(calls) > 1 else 'status'}, own);")
        self.functions.add("higher")
        self._all_sequenced(statement.accepted, more=more)
        self._close()
        self._open("else")
        self._all_sequenced(statement.on_refused, more=more)
        self._close()


def _on_latest(condition: Condition) -> Condition:
    """Read candidate memory through the pointer to the latest one."""
    match condition:
        case AllOf():
            return AllOf(tuple(_on_latest(item) for item in condition.conditions))
        case Compare():
            return Compare(_latest(condition.left), condition.relation, _latest(condition.right), condition.scale)
        case _:
            return condition


def _latest(operand: Any) -> Any:
    if isinstance(operand, Element) and operand.place.space == "next":
        return Element(_LatestPlace("next", operand.place.name), operand.index)
    return operand


class _LatestPlace(Place):
    """A place of the candidate memory that C reads through `latest`."""


def needs_params(block: Block, entry: Entry) -> bool:
    """Whether the core of an entry reads parameters."""
    if entry.checks_params:
        return bool(block.param_signals_flat())
    for statement in walk(entry.body):
        if isinstance(statement, Call):
            callee = block.parts[statement.part] if statement.part else block
            if needs_params(callee, callee.entries[statement.entry]):
                return True
            callee_entry = callee.entries[statement.entry]
            if any(place.space == "param" for _, place in callee_entry.hidden):
                return True
            if any(isinstance(item, Place) and item.space == "param" for _, item in statement.arguments):
                return True
        elif isinstance(statement, Evaluate):
            used = inputs_used(statement)
            if any(place.space == "param" for place in used):
                return True
        elif any(_mentions_param(item) for item in vars(statement).values()):
            return True
    return False


def inputs_used(statement: Evaluate) -> set[Place]:
    """Return the places that an expression depends on, of all that it is given."""
    positions = {step.place for step in tape(statement.function).steps if step.operation == "input"}
    used = set()
    for argument, places in enumerate(statement.reads):
        start = 0
        for place, size in places:
            if any((argument, start + i) in positions for i in range(size)):
                used.add(place)
            start += size
    return used


def _mentions_param(item: Any) -> bool:
    match item:
        case Place():
            return item.space == "param"
        case Element():
            return item.place.space == "param"
        case Compare():
            return _mentions_param(item.left) or _mentions_param(item.right)
        case AllOf() | AnyOf():
            return any(_mentions_param(part) for part in item.conditions)
        case Within():
            return item.place.space == "param"
        case IsSet():
            return item.flag.place.space == "param"
        case _:
            return False


def _reads_before(line: str) -> bool:
    """Whether a line of C uses the argument `before`: not a field whose name ends so, nor a comment."""
    return re.search(r"\bbefore(?:->|,|\))", line) is not None and not line.lstrip().startswith(("/*", "*"))


def _targets(statement: Statement) -> set[Place]:
    from ..symbolic.block import places_written

    return places_written(statement)


def may_refuse(statement: Statement) -> bool:
    """Whether a statement may end the entry with a negative status."""
    if isinstance(statement, (Refuse, HoldVariances, Call)):
        return True
    if isinstance(statement, When):
        return any(may_refuse(item) for item in (*statement.then, *statement.otherwise))
    return False


def _is_trivial(condition: Condition) -> bool:
    return isinstance(condition, AllOf) and not condition.conditions


def _is_compound(text: str) -> bool:
    """Whether an expression needs parentheses as an operand."""
    depth = 0
    for letter in text:
        if letter == "(":
            depth += 1
        elif letter == ")":
            depth -= 1
        elif letter == " " and depth == 0:
            return True
    return text.startswith("-") or text.startswith("!")


def _wrap_condition(text: str, indent: str) -> list[str]:
    """Break a condition before its operators."""
    lines: list[str] = []
    current = indent
    for word in text.replace(" && ", "\x00&& ").replace(" || ", "\x00|| ").split("\x00"):
        candidate = current + ("" if current == indent else " ") + word
        if len(candidate) > WIDTH and current != indent:
            lines.append(current)
            current = indent + "      " + word
        else:
            current = candidate
    lines.append(current)
    return lines


def wrap_signature(text: str) -> list[str]:
    """Break a function head after commas, aligned with its first parameter; with a long name, below the name."""
    if len(text) <= WIDTH:
        return [text]
    column = text.index("(") + 1
    parts = text[column:].split(", ")
    lines, current, indent = [], text[:column], " " * column
    if column + max(len(part) for part in parts) + 1 > WIDTH:
        lines, current, indent = [text[:column]], "    ", "    "
    start = current
    for part in parts:
        candidate = current + ("" if current in (start, indent) else ", ") + part
        if len(candidate) + 1 > WIDTH:
            lines.append(current + ",")
            current = indent + part
        else:
            current = candidate
    return [*lines, current]


_RESERVED = frozenset(
    "before after params out status work latest spare own highest taken i row_noise spare_covariance".split()
)
