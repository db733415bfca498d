"""Frama-C's EVA on the C of a block, function by function: an induction over arbitrary calls.

The memory is anything within its ranges, the parameters anything within theirs, the inputs any bit pattern. After the
call the memory must be finite and within its ranges again, so that what held before one call holds before the next.

Each function is analysed as it ships against what it promises, with what it calls replaced by stubs that do all that their
own promises allow, and assert what those require. Every promise that a stub stands for is proved in the same run.
"""

from __future__ import annotations

import csv
import os
import re
import subprocess
import tempfile
import time
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..symbolic.block import Block
from ..symbolic.program import Call, Entry, HoldFactors, HoldVariances, walk
from ..symbolic.signals import Kind, Signal, Status
from .emit import CText
from .exported import run_tool, tool
from .findings import CheckResult, Findings
from .style import Precision

OPTIONS = [
    "-eva", "-eva-precision", "4", "-warn-special-float", "none", "-eva-split-return", "full",
    "-machdep", "gcc_x86_64",
]  # fmt: skip
"""NaN and infinity may arise on the way: they are judged, and must not be stored."""

EFFORTS = {"judgement": (2000, 20000), "straight": (100, 1000), "sequence": (3000,)}
"""States that the analyser keeps apart, by what kind of function it is: tried in this order while something stays open."""

HELD = (Status.NOT_POSITIVE, Status.OVERFLOW, Status.OK, Status.CLAMPED)
"""What the function that holds a matrix within its limits may return."""


@dataclass(frozen=True)
class Property:
    """What the analyser says of one property: an assertion of the harness, an alarm, or a precondition."""

    function: str
    kind: str
    status: str
    text: str

    @property
    def is_proved(self) -> bool:
        """Whether it is proved, and was reached."""
        return self.status == "Valid"


class ProofError(ValueError):
    """C that cannot be proved this way. The message says what was found."""


@dataclass(frozen=True)
class Task:
    """One function to be proved.

    Attributes
    ----------
    name : str
        The entry, or the core or helper without the block's prefix, that of a part behind its name.
    source : str
        The C, with callees replaced by stubs.
    harness : str
        The C of the function ``prove``.
    effort : str
        Key of `EFFORTS`.
    assertions : int
        How many assertions of the harness must be reached and valid.
    """

    name: str
    source: str
    harness: str
    effort: str
    assertions: int


def _fields(signals: Sequence[Signal], path: str = "") -> Iterator[tuple[Signal, int, str]]:
    for signal in signals:
        if signal.kind is Kind.GROUP:
            yield from _fields(signal.members, f"{path}{signal.name}.")
        else:
            for k in range(signal.size):
                yield signal, k, path + signal.name + (f"[{k}]" if signal.size > 1 else "")


def _fill(target: str, signals: Sequence[Signal], precision: Precision, *, anything: bool) -> list[str]:
    """Return assignments: numbers within their ranges, or any bit pattern."""
    lines = []
    for signal, k, name in _fields(signals):
        value = _ANYTHING[signal.kind]
        if signal.kind is Kind.REAL and not anything:
            value = _interval(signal, k, precision)
        lines.append(f"    {target}.{name} = {value};")
    return lines


_ANYTHING = {
    Kind.REAL: "any_real",
    Kind.COUNT: "any_count",
    Kind.FLAG: "(any_count != 0U)",
    Kind.STATUS: "any_status",
}


def _interval(signal: Signal, k: int, precision: Precision) -> str:
    """Return any number within a range; one that begins at zero has a negative zero, which compares as equal."""
    low, high = (precision.literal(end + 0.0) for end in (signal.low[k], signal.high[k]))
    return f"Frama_C_{precision.name}_interval({f'-{low}' if signal.low[k] == 0.0 else low}, {high})"


def _exact(value: float, precision: Precision) -> str:
    """Return the number that the C compares with, exactly: in an annotation a decimal is a real number."""
    return float(precision.dtype(value)).hex()


def _holds(target: str, signals: Sequence[Signal], precision: Precision) -> list[str]:
    """Return assertions: every number within its range, every count and flag written."""
    lines = []
    for signal, k, name in _fields(signals):
        item = f"{target}.{name}"
        if signal.kind is Kind.REAL:
            low, high = _exact(signal.low[k], precision), _exact(signal.high[k], precision)
            lines.append(f"    //@ assert \\is_finite({item}) && {low} <= {item} <= {high};")
        else:  # a copied struct tells nobody that a field of it was never written
            lines.append(f"    //@ assert \\initialized(&{item});")
    return lines


def _answers(target: str, signals: Sequence[Signal]) -> list[str]:
    """Return assertions: every number finite, every status one of the enum, all else written."""
    lines = []
    for signal, _, name in _fields(signals):
        item = f"{target}.{name}"
        if signal.kind is Kind.REAL:
            lines.append(f"    //@ assert \\is_finite({item});")
        elif signal.kind is Kind.STATUS:
            lines.append(
                f"    //@ assert \\initialized(&{item}) && {int(min(Status))} <= {item} <= {int(max(Status))};"
            )
        else:
            lines.append(f"    //@ assert \\initialized(&{item});")
    return lines


_STATUS = f"{int(min(Status))} <= status <= {int(max(Status))}"

_TOLD = ["    if (status >= 0) { Frama_C_show_each_accepted(1); } else { Frama_C_show_each_refused(1); }"]
"""Both ways must be reached: a harness whose calls never return would prove anything."""


def _accepted(lines: Sequence[str]) -> list[str]:
    return ["    if (status >= 0)", "    {", *lines, "    }"] if lines else []


class _Prover:
    """Makes the tasks of one block, or of a part at its place in a composition."""

    def __init__(self, block: Block, text: CText, path: tuple[str, ...] = ()):
        self.block, self.text, self.path, self.precision = block, text, path, text.precision
        self.name, self.prefix = text.name, "_".join((text.name, *path))
        self.status = f"{text.name}_status_t"
        self.memory, self.params = block.memory_group().members, block.param_group().members
        first = {
            name: _Prover(part, text, (*path, name)) for name, part in block.parts.items() if block.twin(name) == name
        }
        self.parts = {name: first[block.twin(name)] for name in block.parts}
        self.hold = next(
            (item for entry in block.entries.values() for item in walk(entry.body) if isinstance(item, HoldVariances)),
            None,
        )
        self.called = {
            item.entry
            for entry in block.entries.values()
            for item in walk(entry.body)
            if isinstance(item, Call) and not item.part
        }

    def tasks(self) -> list[Task]:
        """Return every function that must be proved: those of parts, what judges, cores, then what callers see."""
        found = [task for name, part in self.parts.items() if self.block.twin(name) == name for task in part.tasks()]
        found += self._judgements() if self.hold is not None else []
        for entry in self.block.entries.values():
            if entry.name in self.called or (self.path and self._has(f"{entry.name}_core")):
                found.append(self._core(entry))
        return found + ([] if self.path else [self._public(entry) for entry in self.block.entries.values()])

    def _label(self, name: str) -> str:
        return ".".join((*self.path, name))

    # -- what judges --------------------------------------------------------------------------------------------------

    def _matrix(self) -> tuple[Signal, str, str]:
        """Return the field that is held, the parameter of the functions that judge it, and the name of the main one."""
        assert self.hold is not None
        field = next(signal for signal in self.memory if signal.name == self.hold.target.name)
        factored = isinstance(self.hold, HoldFactors)
        return (
            field,
            "factors" if factored else "covariance",
            f"{self.prefix}_hold_{'factors' if factored else 'variances'}",
        )

    def _judgements(self) -> list[Task]:
        field, _, holder = self._matrix()
        size, real = field.size, self.precision.name
        anything = [f"    {real} c[{size}];", *[f"    c[{k}] = any_real;" for k in range(size)]]
        within = [f"        //@ assert {self._within(f'c[{k}]', field, k)};" for k in range(size)]
        tasks = []
        for helper in ("is_held", "is_bounded"):
            if self._has(helper):
                body = [*anything, f"    if ({self.prefix}_{helper}(c))", "    {", *within, "    }"]
                tasks.append(Task(self._label(helper), self.text.source, _function(body), "judgement", size))
        stubs = {f"{self.prefix}_is_held": self._passing_stub()} if self._has("is_held") else {}
        body = [*anything, f"    const {self.status} status = {holder}({'c' if size > 1 else '&c[0]'});"]
        # what the stub may return, and nothing else
        body.append(f"    //@ assert {' || '.join(f'status == {int(item)}' for item in HELD)};")
        body += [*_accepted(within), *_TOLD]
        name = self._label(holder.removeprefix(f"{self.prefix}_"))
        return [*tasks, Task(name, replaced(self.text.source, stubs), _function(body), "judgement", size + 1)]

    def _has(self, helper: str) -> bool:
        pattern = rf"^static (bool|{self.status}) {self.prefix}_{helper}\("
        return re.search(pattern, self.text.source, re.MULTILINE) is not None

    def _within(self, item: str, field: Signal, k: int) -> str:
        low, high = _exact(field.low[k], self.precision), _exact(field.high[k], self.precision)
        return f"\\is_finite({item}) && {low} <= {item} <= {high}"

    def _passing_stub(self) -> list[str]:
        """A test that may fail for any reason; if it passes, every element is within its range."""
        field, array, _ = self._matrix()
        admitted = [f"    //@ admit {self._within(f'{array}[{k}]', field, k)};" for k in range(field.size)]
        return ["    if (any_count != 0U)", "    {", "        return false;", "    }", *admitted, "    return true;"]

    def _holding_stub(self) -> list[str]:
        """It refuses and leaves anything, or leaves every element within its range."""
        field, array, _ = self._matrix()
        upper, lines = self.name.upper(), ["    if (any_count != 0U)", "    {"]
        lines += [f"        {array}[{k}] = any_real;" for k in range(field.size)]
        refused, held = ([f"{upper}_{item.name}" for item in HELD if (item < 0) is bad] for bad in (True, False))
        lines += [f"        return (any_count != 0U) ? {' : '.join(refused)};", "    }"]
        lines += [f"    {array}[{k}] = {_interval(field, k, self.precision)};" for k in range(field.size)]
        return [*lines, f"    return (any_count != 0U) ? {' : '.join(held)};"]

    # -- entries ------------------------------------------------------------------------------------------------------

    def _public(self, entry: Entry) -> Task:
        """Return the task of an entry as callers see it."""
        name, arguments = self.prefix, ["&state"]
        lines = [f"    {name}_state_t state;"]
        for has, kind, variable in (
            (self.params, f"{name}_params_t", "params"),
            (entry.inputs, f"{name}_{entry.name}_in_t", "in"),
            (entry.outputs, f"{name}_{entry.name}_out_t", "out"),
        ):
            if has:
                lines.append(f"    {kind} {variable};")
                arguments.append(f"&{variable}")
        lines += [f"    {self.status} status;", *self._given(entry)]
        lines += [f"    status = {name}_{entry.name}({', '.join(arguments)});", f"    //@ assert {_STATUS};"]
        holds, answers = _holds("state", self.memory, self.precision), _answers("out", entry.outputs)
        lines += _accepted(holds + self._judged(entry)) if entry.checks_params else holds
        stubs = self._core_stubs([(self, entry)]) if entry.name in self.called else self._stubs(entry)
        return self._task(entry, entry.name, [*lines, *_accepted(answers)], stubs)

    def _core(self, entry: Entry) -> Task:
        """Return the task of an entry's core: what the stub stands for where others call it."""
        name, head = self.prefix, self._head(entry)
        lines, arguments = [f"    {name}_state_t after;"], ["&after"]
        if not entry.checks_params:
            lines.append(f"    {name}_state_t state;")
            arguments = ["&state", *arguments]
        lines += [f"    {name}_params_t params;"] if self.params else []
        if entry.inputs:
            lines += self._own_struct(entry.inputs) if self.path else [f"    {name}_{entry.name}_in_t in;"]
        lines += [f"    {name}_{entry.name}_out_t out;"] if entry.outputs else []
        arguments += ["&params"] if "*params" in head else []
        arguments += [f"in.{signal.name}" for signal in entry.inputs]
        for signal, _ in entry.hidden:
            if signal.kind is not Kind.REAL or signal.size != 1:
                raise ProofError(f"{self._label(entry.name)}: {signal.name} is no number; only numbers are passed on")
            arguments.append(_interval(signal, 0, self.precision))
        arguments += ["&out"] if entry.outputs else []
        lines += [f"    {self.status} status;", *self._given(entry)]
        lines += [f"    status = {name}_{entry.name}_core({', '.join(arguments)});", f"    //@ assert {_STATUS};"]
        promised = [*_holds("after", self.memory, self.precision), *self._judged(entry)]
        lines += _accepted([*promised, *_answers("out", entry.outputs)])
        return self._task(entry, self._label(f"{entry.name}_core"), lines, self._stubs(entry))

    def _own_struct(self, signals: Sequence[Signal]) -> list[str]:
        """Return a struct of the harness's own: the header has none for what the core of a part is given."""
        kinds = {Kind.REAL: self.precision.name, Kind.FLAG: "bool", Kind.COUNT: "uint32_t", Kind.STATUS: self.status}
        members = [
            f"        {kinds[signal.kind]} {signal.name}" + (f"[{signal.size}];" if signal.size > 1 else ";")
            for signal in signals
        ]
        return ["    struct", "    {", *members, "    } in;"]

    def _given(self, entry: Entry) -> list[str]:
        """Return assignments to what a call is given."""
        lines = [] if entry.checks_params else _fill("state", self.memory, self.precision, anything=False)
        lines += _fill("params", self.params, self.precision, anything=entry.checks_params)
        return lines + _fill("in", entry.inputs, self.precision, anything=True)

    def _judged(self, entry: Entry) -> list[str]:
        """Return assertions: parameters that were accepted are within their ranges."""
        return _holds("params", self.params, self.precision) if entry.checks_params else []

    def _task(self, entry: Entry, name: str, lines: list[str], stubs: dict[str, list[str]]) -> Task:
        told = _TOLD if self._may_be_refused(entry) else []
        effort = "sequence" if any(isinstance(item, Call) for item in walk(entry.body)) else "straight"
        source = replaced(self.text.source, stubs)
        return Task(name, source, _function([*lines, *told]), effort, sum("//@ assert" in line for line in lines))

    def _may_be_refused(self, entry: Entry) -> bool:
        judged = self.params if entry.checks_params else entry.inputs
        return any(signal.kind is Kind.REAL for signal, _, _ in _fields(judged))

    # -- stubs --------------------------------------------------------------------------------------------------------

    def _stubs(self, entry: Entry) -> dict[str, list[str]]:
        """Return stubs for all that the core of an entry calls."""
        calls = dict.fromkeys((item.part, item.entry) for item in walk(entry.body) if isinstance(item, Call))
        owners = [(self.parts[part] if part else self, name) for part, name in calls]
        stubs = self._core_stubs([(owner, owner.block.entries[name]) for owner, name in owners])
        if self.hold is not None:
            _, _, holder = self._matrix()
            stubs[holder] = self._holding_stub()
            if self._has("is_bounded"):
                stubs[f"{self.prefix}_is_bounded"] = self._passing_stub()
        return stubs

    @staticmethod
    def _core_stubs(called: Sequence[tuple[_Prover, Entry]]) -> dict[str, list[str]]:
        return {f"{owner.prefix}_{entry.name}_core": owner._core_stub(entry) for owner, entry in called}

    def _head(self, entry: Entry) -> str:
        return _definition(self.text.source, f"{self.prefix}_{entry.name}_core")[2]

    def _core_stub(self, entry: Entry) -> list[str]:
        """What an entry's core promises: refused and anything, or memory within its ranges and finite outputs."""
        lines: list[str] = []
        if not entry.checks_params:
            lines += ["    //@ assert before != after;", *_holds("(*before)", self.memory, self.precision)]
            if "*params" in self._head(entry):
                lines += _holds("(*params)", self.params, self.precision)
        for signal, _ in entry.hidden:
            lines.append(f"    //@ assert {self._within(signal.name, signal, 0)};")
        lines += ["    if (any_count != 0U)", "    {", f"        {_leaves(f'{self.prefix}_state_t')}(after);"]
        lines += [f"        {_leaves(f'{self.prefix}_{entry.name}_out_t')}(out);"] if entry.outputs else []
        lines += [f"        return ({self.status})Frama_C_interval({int(min(Status))}, -1);", "    }"]
        lines += _fill("(*after)", self.memory, self.precision, anything=False)
        most = float(np.finfo(self.precision.dtype).max).hex() + ("f" if self.precision.is_float else "")
        worth = {
            **_ANYTHING,
            Kind.REAL: f"Frama_C_{self.precision.name}_interval(-{most}, {most})",
            Kind.STATUS: f"({self.status})Frama_C_interval({int(min(Status))}, {int(max(Status))})",
        }
        lines += [f"    out->{name} = {worth[signal.kind]};" for signal, _, name in _fields(entry.outputs)]
        if entry.checks_params:
            lines += [line.replace("assert", "admit") for line in _holds("(*params)", self.params, self.precision)]
        return [*lines, f"    return ({self.status})Frama_C_interval(0, {int(max(Status))});"]

    def leavings(self) -> dict[str, str]:
        """Return functions that leave anything, or what was there, in each field of a struct, by name."""
        found = {name: text for part in self.parts.values() for name, text in part.leavings().items()}
        structs = {f"{self.prefix}_state_t": self.memory}
        for entry in self.block.entries.values():
            if entry.outputs:
                structs[f"{self.prefix}_{entry.name}_out_t"] = entry.outputs
        for struct, signals in structs.items():
            lines = [
                f"    if (any_count != 0U) {{ {line.strip()} }}"
                for line in _fill("(*item)", signals, self.precision, anything=True)
            ]
            name = _leaves(struct)
            found[name] = "\n".join([f"static void {name}({struct} *item)", "{", "    (void)item;", *lines, "}", ""])
        return found


def _leaves(struct: str) -> str:
    return f"leave_{struct}"


def _function(body: Sequence[str]) -> str:
    return "\n".join(["void prove(void)", "{", *body, "}"])


def _definition(source: str, name: str) -> tuple[int, int, str]:
    """Return where the definition of a static function begins and ends, and its head."""
    found = re.search(rf"^static [^\n;=]*\b{re.escape(name)}\(", source, re.MULTILINE)
    if found is None:
        raise ProofError(f"the C has no static function {name}, whose promise was to be used; export again")
    opened = source.index("\n{\n", found.start())
    head = source[found.start() : opened]
    if ";" in head or "}" in head:
        raise ProofError(f"the definition of {name} is not where it was expected; export again")
    return found.start(), source.index("\n}\n", opened) + 3, head


def replaced(source: str, stubs: Mapping[str, Sequence[str]]) -> str:
    """Return C with the bodies of some static functions replaced; everything else stays as it is."""
    for name, body in stubs.items():
        start, end, head = _definition(source, name)
        source = "\n".join([source[:start] + head, "{", *body, "}", ""]) + source[end:]
    return source


def proof_tasks(block: Block, text: CText) -> list[Task]:
    """Return all that must be proved of a block.

    Raises
    ------
    ProofError
        If the C is not of the expected form.
    """
    return _Prover(block, text).tasks()


def proof_source(block: Block, text: CText, task: Task) -> str:
    """Return the C that the analyser reads: the library with stubs, and the harness behind it."""
    include = f'#include "{block.name}.h"\n'
    at = task.source.index(include) + len(include)
    own = [
        '#include "__fc_builtin.h"',
        f"static volatile {text.precision.name} any_real;",
        "static volatile uint32_t any_count;",
        f"static volatile {block.name}_status_t any_status;",
        *[leaving for name, leaving in _Prover(block, text).leavings().items() if name in task.source],
    ]
    return task.source[:at] + "\n".join(own) + "\n" + task.source[at:] + "\n" + task.harness + "\n"


def analyse(
    block: Block, text: CText, task: Task, effort: int, *, seconds: float = 900.0
) -> tuple[list[Property], frozenset[str]]:
    """Return every property of one task that Frama-C looked at, and which ways of returning it reached.

    Parameters
    ----------
    block : Block
        Whose function it is.
    text : CText
        Its C.
    task : Task
        What is proved.
    effort : int
        States that are kept apart.
    seconds : float
        How long the analysis may take; beyond it subprocess.TimeoutExpired is raised.

    Raises
    ------
    MissingTool
        If frama-c is not installed.
    ProofError
        If it ended without a report: it could not read the C.
    """
    program = tool("frama-c", "frama-c-base")
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        (folder / f"{block.name}.h").write_text(text.header)
        source = proof_source(block, text, task)
        (folder / "proof_main.c").write_text(source)
        # neither what computes and stores nothing nor what leaves anything needs a case distinction
        plain = rf"^static \w+ ({block.name}_math_\w+|{_leaves(block.name)}\w+)\("
        bounded = ",".join(f"{helper}:0" for helper in sorted(set(re.findall(plain, source, re.MULTILINE))))
        command = [program, *OPTIONS, "-eva-slevel", str(effort)]
        command += ["-eva-slevel-function", bounded] if bounded else []
        report = folder / "report.csv"
        # whole paths: frama-c resolves others by the variable PWD, not by where it runs
        command += ["-main=prove", str(folder / "proof_main.c"), "-then", "-report-csv", str(report)]
        done = run_tool(command, folder, seconds=seconds)
        if done.returncode != 0 or not report.is_file():
            said = " ".join((done.stdout + done.stderr).split())[-400:]
            raise ProofError(
                f"{block.name}: frama-c ended with {done.returncode} and no report; mend the C, or export again: {said}"
            )
        with report.open() as rows:
            found = [
                Property(row["function"], row["property kind"], row["status"], row["property"])
                for row in csv.DictReader(rows, delimiter="\t")
            ]
    ways = frozenset(way for way in ("accepted", "refused") if f"Frama_C_show_each_{way}" in done.stdout)
    # what Frama-C's own library promises of itself is taken on trust; a stub or helper that is not called here is dead
    kept = [
        item
        for item in found
        if item.status != "Considered valid"
        and not (item.status == "Dead" and item.function != "prove")
        and not item.function.startswith("Frama_C_show_each_")
    ]
    return kept, ways


def prove_task(block: Block, text: CText, task: Task, *, seconds: float = 900.0) -> tuple[CheckResult, list[int]]:
    """Prove one function, with more effort where less does not do; return also the efforts, in their order."""
    needed = {"accepted", "refused"} if "show_each" in task.harness else set()
    started, note, count = time.perf_counter(), "", 0
    tried: list[int] = []
    for effort in EFFORTS[task.effort]:
        tried.append(effort)
        try:
            properties, ways = analyse(block, text, task, effort, seconds=seconds)
        except subprocess.TimeoutExpired:
            note = f"frama-c was not done after {seconds:.0f} s, with {effort} states kept apart"
            break
        own = [item for item in properties if item.function == "prove" and item.kind == "user assertion"]
        open_ones = [item for item in properties if not item.is_proved]
        count = len(properties)
        note = "; ".join(f"{item.function}: {item.text} ({item.status})" for item in open_ones[:3])
        if not open_ones:
            if len(own) >= task.assertions and needed <= ways:
                took = time.perf_counter() - started
                return CheckResult(f"proof of {task.name}", True, calls=count, note=f"{took:.1f} s"), tried
            note = f"{len(own)} of {task.assertions} assertions were reached; of the ways to return only {sorted(ways)}"
    return CheckResult(f"proof of {task.name}", False, calls=count, note=note), tried


def prove(block: Block, text: CText, names: Sequence[str] = (), *, seconds: float = 900.0) -> Findings:
    """Prove that no sequence of calls takes the memory out of its ranges, whatever the inputs.

    Parameters
    ----------
    block : Block
        Whose C it is.
    text : CText
        The C.
    names : sequence of str, optional
        Entries and helpers to be proved; default all. The claim holds for all of them together.
    seconds : float
        How long each analysis may take.

    Returns
    -------
    Findings
        A check for each function; its calls are the properties that were looked at. Of those that are proved, the facts
        have the properties (`proof`) and the states that were kept apart (`efforts`), in the order in which they were tried.

    Raises
    ------
    MissingTool
        If frama-c is not installed.
    ProofError
        If the C is not of the expected form.
    """
    tasks = [task for task in proof_tasks(block, text) if not names or task.name in names]
    with ThreadPoolExecutor(max(1, os.cpu_count() or 1)) as pool:
        done = list(pool.map(lambda task: prove_task(block, text, task, seconds=seconds), tasks))
    proved = [(task.name, check, tried) for task, (check, tried) in zip(tasks, done, strict=True) if check.passed]
    return Findings(
        [check for check, _ in done],
        {
            "proof": {name: check.calls for name, check, _ in proved},
            "efforts": {name: tried for name, _, tried in proved},
        },
    )
