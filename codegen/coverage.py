"""Which statements of the C the shipped vectors run, and which branches vectors and corpus take together: counted by gcov.

A statement that no vector runs fails the export, unless it belongs to a judgement that no call of the corpus made fail
either: then it is listed with that reason. Branches that nothing took are listed with a reason each.
"""

from __future__ import annotations

import ctypes
import json
import os
import shutil
import subprocess
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from ..symbolic.block import Block
from ..symbolic.program import Entry
from ..symbolic.signals import Kind, Signal
from .crosscheck import FrozenStream, Probe, default_scenario
from .findings import CheckResult, Findings
from .layout import fill, flatten
from .provenance import Parent, Provenance
from .selection import crafted, is_off, is_packed, reachable
from .views import NativeView

FUZZED_CALLS = 20000
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
        return Findings([], {"coverage": absent})
    try:
        with tempfile.TemporaryDirectory(prefix="plantc-coverage-") as name:
            bench = _Bench(Path(name), block, precision, files)
            by_vectors = bench.after_vectors()
            together, corpus = bench.after_corpus(calls)
    except (CountingError, json.JSONDecodeError) as error:
        return Findings([], {"coverage": f"not measured: {error}"})
    return _findings(block, files[f"src/{block.name}.c"], provenance, by_vectors, together, corpus)


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


def _is_mathematical(block: Block, provenance: Provenance, number: int) -> bool:
    """Whether a line is in a function of the emitted mathematics, which stands in for that of <math.h>."""
    for name, first, last in provenance.functions:
        if first <= number <= last:
            return name.startswith(f"{block.name}_math_")
    return False


def _findings(
    block: Block, source: str, provenance: Provenance, by_vectors: Counts, together: Counts, corpus: int
) -> Findings:
    lines = source.split("\n")
    unreachable: list[dict[str, Any]] = []
    faults: list[str] = []
    left_out = 0
    for number in by_vectors.missed():
        parent = provenance.of_line(number)
        text = lines[number - 1].strip()
        reason = _statement_reason(block, provenance, number, together.lines.get(number, 0) > 0, parent, corpus)
        left_out += reason == ONLY_CORPUS
        if reason:
            unreachable.append({"line": number, "what": "statement", "text": text, "reason": reason})
        else:
            faults.append(f"line {number}: {text}")
    for number, count in together.untaken().items():
        reason = _branch_reason(block, provenance, number, provenance.of_line(number), lines[number - 1], corpus)
        what = "branch" if count == 1 else f"{count} branches"
        unreachable.append({"line": number, "what": what, "text": lines[number - 1].strip(), "reason": reason})
    statements, _ = by_vectors.as_numbers()
    all_statements, branches = together.as_numbers()
    too_many = left_out > LARGEST_SHARE_LEFT_OUT * statements["all"]
    check = CheckResult("vectors reach every statement", not faults and not too_many, calls=statements["all"])
    if too_many:
        check.note = f"{left_out} statement(s) that only the corpus runs, and no shipped vector"
    elif by_vectors.missed():
        check.note = f"but {len(by_vectors.missed())}, each listed with its reason"
        check.note += f"; {left_out} of them rare, which only the corpus runs" if left_out else ""
    if faults:
        check.note = f"{len(faults)} statement(s) that no shipped vector runs; first {faults[0]}"
    facts = {
        "by": "gcov",
        "statements": statements,
        "statements_with_corpus": all_statements,
        "branches": branches,
        "corpus_calls": corpus,
        "unreachable": unreachable,
    }
    return Findings([check], {"coverage": facts})


def _statement_reason(
    block: Block, provenance: Provenance, number: int, by_corpus: bool, parent: Parent | None, corpus: int
) -> str:
    """Return why a statement need not be reached by a vector; empty if it must be."""
    if _is_mathematical(block, provenance, number):
        ran = "calls of the corpus run it" if by_corpus else f"none of {corpus} calls runs it"
        return f"a branch of a mathematical function for arguments that no vector has; {ran}"
    if not by_corpus and parent is not None and parent.kind == "judgement":
        return f"none of {corpus} calls made this judgement fail; it stays as a defence"
    if by_corpus and parent is not None and parent.kind in _MAY_BE_RARE:
        return ONLY_CORPUS
    return ""


def _branch_reason(
    block: Block, provenance: Provenance, number: int, parent: Parent | None, line: str, corpus: int
) -> str:
    """Return why nothing took a branch."""
    if _is_mathematical(block, provenance, number):
        return f"a branch of a mathematical function for arguments that none of {corpus} calls gave it"
    if parent is not None and parent.kind == "judgement":
        return f"none of {corpus} calls had this bound alone decide; it stays as a defence"
    if "?" in line:
        return f"none of {corpus} calls needed the value that keeps a quotient finite, or the other way of a choice"
    if "status >=" in line or "own >=" in line:
        return f"none of {corpus} calls was refused just before"
    return f"none of {corpus} calls took it"
