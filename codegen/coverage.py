"""Which statements of the C the shipped vectors run, and which branches vectors and corpus take together: counted by gcov.

A statement that no vector runs fails the export, unless no call of the corpus ran it either, and it is none of those that
some call always reaches. What nothing reached is listed with the reason, where one follows from the program: proved by its
ranges, implied by what was done just before, or left to rounding alone. Else it says that no reason is known, and the
check's note counts these.
"""

from __future__ import annotations

import ctypes
import json
import os
import re
import shutil
import subprocess
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from ..symbolic.block import Block
from ..symbolic.program import Call, Entry, judgements, walk
from ..symbolic.ranges import idle_judgements
from ..symbolic.signals import Kind, Signal
from .crosscheck import FrozenStream, Probe, default_scenario
from .findings import CheckResult, Findings
from .layout import fill, flatten
from .provenance import Genealogy, Parent, Provenance
from .selection import crafted, is_off, is_packed, reachable
from .views import NativeView

FUZZED_CALLS = 20000
NAME = "vectors reach every statement"
NO_REASON = "no reason known"
PROVED = "proved by the ranges: what is judged here was copied from what was judged to be within these bounds"
ONLY_CORPUS = "calls of the corpus run it; no rule found one among them that is a vector on every machine"
LARGEST_SHARE_LEFT_OUT = 0.05
"""Share of the statements that only the corpus may run, all of them rare: judgements, statuses, bookkeeping."""

_MAY_BE_RARE = frozenset({"judgement", "helper", "status", "assignment", "bookkeeping"})
RANDOM_CALLS = 400
_FLAGS = ("-std=c99", "-O0", "-fPIC", "--coverage", "-ffp-contract=off")
_DUMP = (
    "void __gcov_dump(void);\nvoid plantc_dump_counts(void);\nvoid plantc_dump_counts(void)\n{\n    __gcov_dump();\n}\n"
)


class CountingError(RuntimeError):
    """The compiler or gcov cannot count here: another version, or a compiler that only has the name."""


@dataclass
class Counts:
    """What gcov counted in one file.

    Attributes
    ----------
    lines : dict
        Line number -> how often it ran, for every line with a statement.
    branches : dict
        Line number -> how often each of its branches was taken.
    """

    lines: dict[int, int] = field(default_factory=dict)
    branches: dict[int, list[int]] = field(default_factory=dict)

    def missed(self) -> list[int]:
        """Return the lines that never ran."""
        return sorted(number for number, count in self.lines.items() if count == 0)

    def untaken(self) -> dict[int, int]:
        """Return line -> number of branches never taken, on lines that ran."""
        found = {
            number: sum(1 for count in counts if count == 0)
            for number, counts in self.branches.items()
            if self.lines.get(number, 0) > 0
        }
        return {number: count for number, count in sorted(found.items()) if count}

    def as_numbers(self) -> tuple[dict[str, int], dict[str, int]]:
        """Return how many statements (by line) and branches were reached, of how many."""
        taken = [count for counts in self.branches.values() for count in counts]
        ran = sum(1 for count in self.lines.values() if count)
        return (
            {"reached": ran, "all": len(self.lines)},
            {"reached": sum(1 for count in taken if count), "all": len(taken)},
        )


def missing_tool() -> str:
    """Return a sentence if the compiler that counts is not here, else nothing."""
    absent = [tool for tool in ("gcc", "gcov") if shutil.which(tool) is None]
    return f"not measured: {' and '.join(absent)} not found; install gcc, which brings gcov" if absent else ""


def measure_coverage(
    block: Block,
    precision: str,
    files: Mapping[str, str],
    provenance: Provenance,
    calls: Sequence[Probe],
) -> Findings:
    """Count what the shipped vectors reach, then what vectors and corpus reach together.

    Parameters
    ----------
    block : Block
        The exported block.
    precision : {"double", "float"}
        Of the C.
    files : dict
        Path in the folder -> text.
    provenance : Provenance
        What each line of the C is there for.
    calls : sequence of Probe
        The calls of the cross-check; with what is crafted, random calls, and the fuzzer's driver where it is shipped, they
        are the corpus.

    Returns
    -------
    Findings
        The check "vectors reach every statement", and the facts ``coverage``.
    """
    absent = missing_tool()
    if absent:
        return _not_judged(absent)
    try:
        with tempfile.TemporaryDirectory(prefix="plantc-coverage-") as name:
            bench = _Bench(Path(name), block, precision, files)
            by_vectors = bench.after_vectors()
            together, corpus = bench.after_corpus(calls)
    except (CountingError, json.JSONDecodeError) as error:
        return _not_judged(f"not measured: {error}")
    return _findings(block, files[f"src/{block.name}.c"], provenance, by_vectors, together, corpus)


def _not_judged(reason: str) -> Findings:
    """Return what is found where nothing can be counted: a check that says so."""
    return Findings([CheckResult(NAME, True, not_judged=reason.removeprefix("not measured: "))], {"coverage": reason})


class _Bench:
    """Builds the C once, with counters, and runs it in two ways that count together."""

    def __init__(self, folder: Path, block: Block, precision: str, files: Mapping[str, str]):
        self.folder, self.block, self.precision, self.files = folder, block, precision, files
        for path, text in files.items():
            if path.endswith((".c", ".h")):
                target = folder / path
                target.parent.mkdir(parents=True, exist_ok=True)
                target.write_text(text)
        (folder / "dump.c").write_text(_DUMP)
        self._run("gcc", *_FLAGS, "-Isrc", "-c", f"src/{block.name}.c", "-o", "counted.o")

    def _run(self, *command: str) -> str:
        environment = {**os.environ, "LC_ALL": "C"}
        done = subprocess.run(
            command, cwd=self.folder, capture_output=True, text=True, check=False, timeout=600, env=environment
        )
        if done.returncode != 0:
            raise CountingError(f"{command[0]} failed while coverage was counted: {(done.stderr or done.stdout)[:500]}")
        return done.stdout

    def _program(self, source: str, *arguments: str) -> int:
        self._run("gcc", "-std=c99", "-O0", "--coverage", "-Isrc", "counted.o", source, "-o", "program", "-lm")
        # a vector that differs is the business of another check
        done = subprocess.run(["./program", *arguments], cwd=self.folder, capture_output=True, check=False, timeout=300)
        return done.returncode

    def after_vectors(self) -> Counts:
        """Return the counts after the runner of the shipped vectors."""
        self._program("test/test_vectors.c")
        return self._counts()

    def after_corpus(self, calls: Sequence[Probe]) -> tuple[Counts, int]:
        """Return the counts after vectors and corpus, and how many calls the corpus has."""
        self._run("gcc", "--coverage", "-shared", "-fPIC", "counted.o", "dump.c", "-o", "counted.so", "-lm")
        view = NativeView(self.block, self.precision, library=self.folder / "counted.so")
        total = 0
        with np.errstate(all="ignore"):
            for probe in corpus_of(self.block, view, calls):
                view.call(probe.entry, probe.memory, probe.inputs, probe.params)
                total += 1
        ctypes.CDLL(str(self.folder / "counted.so")).plantc_dump_counts()
        if "verify/fuzz_main.c" in self.files:
            total += FUZZED_CALLS if self._program("verify/fuzz_main.c", str(FUZZED_CALLS)) == 0 else 0
        return self._counts(), total

    def _counts(self) -> Counts:
        said = self._run("gcov", "--json-format", "--branch-probabilities", "--stdout", "counted.o")
        counts = Counts()
        for file in json.loads(said.strip().split("\n")[0])["files"]:
            if not file["file"].endswith(f"src/{self.block.name}.c"):
                continue
            for line in file["lines"]:
                number = line["line_number"]
                counts.lines[number] = counts.lines.get(number, 0) + line["count"]
                taken = [branch["count"] for branch in line["branches"]]
                if taken:
                    counts.branches.setdefault(number, []).extend(taken)
        return counts


def corpus_of(block: Block, view: NativeView, calls: Sequence[Probe]) -> Iterator[Probe]:
    """Yield the calls of the cross-check, those crafted, each element of each field made bad, and random ones."""
    yield from calls
    yield from crafted(block, view, calls, reachable(block))
    for name, entry in block.entries.items():
        own = [probe for probe in calls if probe.entry == name and probe.trace == "nominal"]
        own = (own or [probe for probe in calls if probe.entry == name])[:1]
        for probe in own:
            yield from _one_bad_element(block, entry, probe)
            if not entry.checks_params:
                yield from _one_bad_element(block, entry, _without_doubt(block, probe))
                yield from _one_bad_element(block, entry, _at_limits(block, entry, probe, 3))
                yield _at_limits(block, entry, probe, 2**32 - 1)
    yield from _random(block, view)


def _one_bad_element(block: Block, entry: Entry, probe: Probe) -> Iterator[Probe]:
    memory = [] if entry.checks_params else block.memory_signals_flat()
    for changed in _each_element(memory, probe.memory):
        yield Probe("corpus", 0, entry.name, changed, probe.inputs, probe.params)
    for changed in _each_element(entry.inputs, probe.inputs):
        yield Probe("corpus", 0, entry.name, probe.memory, changed, probe.params)
    for changed in _each_element(block.param_signals_flat(), probe.params):
        yield Probe("corpus", 0, entry.name, probe.memory, probe.inputs, changed)


def _without_doubt(block: Block, probe: Probe) -> Probe:
    """Return a call whose memory has no variance: nothing measured brings a state back into its range."""
    values = {signal.name: np.zeros(signal.size) for signal in block.memory_signals_flat() if is_packed(signal)}
    open_ = {name: 0.0 for name in _gates(block)}
    return Probe(
        "corpus", 0, probe.entry, fill(probe.memory.copy(), values), probe.inputs, fill(probe.params.copy(), open_)
    )


def _gates(block: Block) -> set[str]:
    """Return the parameters that an entry reads unless a caller inside sets the number: gates, zero for none."""
    return {place.name for entry in block.entries.values() for _, place in entry.hidden}


def _at_limits(block: Block, entry: Entry, probe: Probe, count: int) -> Probe:
    """Return a call with all flags up, counters high, and gates and limits that are not off."""
    signals = block.param_signals_flat()
    given: dict[str, Any] = {signal.name: 2 for signal in signals if signal.kind is Kind.COUNT and count < 10}
    gates = _gates(block)
    given |= {item.name: np.full(item.size, 1e-9) for item in signals if is_off(item) or item.name in gates}
    memory = {signal.name: count for signal in block.memory_signals_flat() if signal.kind is Kind.COUNT}
    flags = {signal.name: 1 for signal in entry.inputs if signal.kind is Kind.FLAG}
    return Probe(
        "corpus",
        0,
        entry.name,
        fill(probe.memory.copy(), memory),
        fill(probe.inputs.copy(), flags),
        fill(probe.params.copy(), given),
    )


def _each_element(signals: Sequence[Signal], record: Any) -> Iterator[Any]:
    values = flatten(record)
    for signal in signals:
        if signal.kind is Kind.COUNT:
            for number in (0, 1, 2**32 - 1):
                yield fill(record.copy(), {signal.name: np.full(signal.size, number)})
        if signal.kind is not Kind.REAL or signal.name not in values:
            continue
        for i in range(signal.size):
            low, high = signal.low[i], signal.high[i]
            span = high - low
            for bad in (high + 0.1 * span, low - 0.1 * span, np.nan, low, high, 0.0):
                changed = values[signal.name].astype(float)
                changed[i] = bad
                yield fill(record.copy(), {signal.name: changed})


def _random(block: Block, view: NativeView) -> Iterator[Probe]:
    """Yield random calls: a memory a filter might have, or anywhere in its ranges, and inputs anywhere in theirs."""
    rng: Any = FrozenStream(7)
    plain = default_scenario(block)
    scenario = block.scenario or plain
    params = view.params()
    counting = {signal.name: 2 for signal in block.param_signals_flat() if signal.kind is Kind.COUNT}
    limited = fill(params.copy(), counting)
    for k, (entry, values) in enumerate(plain.calls(rng, RANDOM_CALLS)):
        source = (scenario if k % 3 else plain).memory(rng)
        memory = view.memory() if block.entries[entry].checks_params else fill(view.memory(), source)
        yield Probe("random", k, entry, memory, view.inputs(entry, values), limited if k % 2 else params)


class _Reasons:
    """Says why a line of the C, or a branch on it, is reached by nothing."""

    def __init__(self, block: Block, source: str, provenance: Provenance, corpus: int):
        self.block, self.provenance, self.corpus = block, provenance, corpus
        self.lines = source.split("\n")
        self.proved: set[Parent] = set()
        self.owed: set[Parent] = set()
        for entry in block.entries.values():
            family = Genealogy(block, entry)
            self.owed |= {family.of(statement) for statement in judgements(block, entry)}
        for owner, entry, path in _all_entries(block):
            family = Genealogy(owner, entry, path)
            self.proved |= {family.of(statement) for statement in idle_judgements(owner, entry)}

    def statement(self, number: int, by_corpus: bool) -> str:
        """Return why a statement need not be reached by a vector; empty if it must be."""
        parent = self.provenance.of_line(number)
        if self._is_mathematical(number):
            ran = "calls of the corpus run it" if by_corpus else f"{NO_REASON}: none of {self.corpus} calls runs it"
            return f"a branch of a mathematical function for arguments that no vector has; {ran}"
        if parent is None:
            return ""
        if by_corpus:
            return ONLY_CORPUS if parent.kind in _MAY_BE_RARE else ""
        if parent.kind != "judgement" or parent in self.owed:
            return ""  # a value outside its range is always there to be given
        if parent in self.proved:
            return PROVED
        return f"{NO_REASON}: none of {self.corpus} calls made this judgement fail"

    def branch(self, number: int) -> str:
        """Return why nothing took a branch on a line."""
        parent = self.provenance.of_line(number)
        if parent is not None and parent in self.proved:
            return PROVED
        if self._is_mathematical(number):
            return (
                f"{NO_REASON}: a branch of a mathematical function, for arguments none of {self.corpus} calls gave it"
            )
        if self._is_looked_at_again(number):
            return "implied: the function that alone calls this one has raised each of these to its floor"
        if self._is_wrapped(number):
            return "implied, but for rounding: each of these angles was wrapped to -pi .. pi just before"
        return f"{NO_REASON}: none of {self.corpus} calls took it"

    def _function(self, number: int) -> tuple[str, int, int]:
        return next((item for item in self.provenance.functions if item[1] <= number <= item[2]), ("", 0, -1))

    def _is_mathematical(self, number: int) -> bool:
        """Whether a line is in a function of the emitted mathematics, which stands in for that of <math.h>."""
        return self._function(number)[0].startswith(f"{self.block.name}_math_")

    def _is_looked_at_again(self, number: int) -> bool:
        """Whether a line compares with a floor what its only caller has raised to that floor."""
        name, first, last = self._function(number)
        if not name.endswith("_is_held") or ">=" not in self.lines[number - 1] or "<=" in self.lines[number - 1]:
            return False
        calls = [k for k, line in enumerate(self.lines, 1) if f"{name}(" in line and not first <= k <= last]
        callers = {self._function(k) for k in calls}
        return len(callers) == 1 and all(
            any("= floor_i;" in line for line in self.lines[start - 1 : calls[0]]) for _, start, _ in callers
        )

    def _is_wrapped(self, number: int) -> bool:
        """Whether a line judges nothing but angles that were wrapped in the same function before."""
        names = set(re.findall(r"after->(\w+)", self.lines[number - 1]))
        wide = {item.name for item in self.block.memory_signals if item.angle and item.high[0] > 3.1416}
        _, first, _ = self._function(number)
        before = self.lines[first - 1 : number - 1]
        return bool(names) and names <= wide and all(_last_store(before, name) for name in names)


def _last_store(lines: Sequence[str], name: str) -> bool:
    """Whether the last value that was stored in a field was wrapped, and by how many turns came from `floor`."""
    stores = [line for line in lines if re.search(rf"after->{name} = ", line)]
    return bool(stores) and re.search(r"\* floorf?\(", stores[-1]) is not None


def _all_entries(block: Block) -> Iterator[tuple[Block, Entry, str]]:
    """Yield the entries of a block and those of the parts that it calls, with the names that lead there."""
    open_ = [(block, entry, "") for entry in block.entries.values()]
    done = set()
    while open_:
        owner, entry, path = open_.pop()
        if path + entry.name in done:
            continue
        done.add(path + entry.name)
        yield owner, entry, path
        for statement in walk(entry.body):
            if isinstance(statement, Call):
                part = owner.parts[statement.part] if statement.part else owner
                below = f"{path}{statement.part}." if statement.part else path
                open_.append((part, part.entries[statement.entry], below))


def _findings(
    block: Block, source: str, provenance: Provenance, by_vectors: Counts, together: Counts, corpus: int
) -> Findings:
    reasons = _Reasons(block, source, provenance, corpus)
    unreachable: list[dict[str, Any]] = []
    faults: list[str] = []
    for number in by_vectors.missed():
        text = reasons.lines[number - 1].strip()
        reason = reasons.statement(number, together.lines.get(number, 0) > 0)
        if reason:
            unreachable.append({"line": number, "what": "statement", "text": text, "reason": reason})
        else:
            faults.append(f"line {number}: {text}")
    left_out = sum(item["reason"] == ONLY_CORPUS for item in unreachable)
    for number, count in together.untaken().items():
        what = "branch" if count == 1 else f"{count} branches"
        text = reasons.lines[number - 1].strip()
        unreachable.append({"line": number, "what": what, "text": text, "reason": reasons.branch(number)})
    statements, _ = by_vectors.as_numbers()
    all_statements, branches = together.as_numbers()
    too_many = left_out > LARGEST_SHARE_LEFT_OUT * statements["all"]
    check = CheckResult(NAME, not faults and not too_many, calls=statements["all"])
    check.note = _note(unreachable, left_out)
    if too_many:
        check.note = f"{left_out} statement(s) that only the corpus runs, and no shipped vector"
    if faults:
        check.note = f"{len(faults)} statement(s) that no shipped vector runs; first {faults[0]}"
    facts = {
        "by": "gcov",
        "statements": statements,
        "statements_with_corpus": all_statements,
        "branches": branches,
        "corpus_calls": corpus,
        "no_reason_known": sum(NO_REASON in item["reason"] for item in unreachable),
        "unreachable": unreachable,
    }
    return Findings([check], {"coverage": facts})


def _note(unreachable: Sequence[Mapping[str, Any]], left_out: int) -> str:
    """Return what a check that passed says of what was not reached."""
    missed = sum(item["what"] == "statement" for item in unreachable)
    unknown = sum(NO_REASON in item["reason"] for item in unreachable)
    notes = [f"but {missed}"] if missed else []
    if left_out:
        notes.append(f"{left_out} of them rare, which only the corpus runs")
    if unreachable:
        lines = f"{len(unreachable)} line(s) with a statement or a branch that was not reached"
        notes.append(f"{lines}, each listed; no reason is known for {unknown} of them")
    return "; ".join(notes)
