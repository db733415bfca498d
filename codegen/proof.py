"""Frama-C's EVA on the C of a block: one step of an induction over arbitrary calls, an entry at a time.

The memory is anything within its ranges, the parameters anything within theirs, the inputs any bit pattern. After the
call the memory must be finite and within its ranges again, so that what held before one call holds before the next.
"""

from __future__ import annotations

import csv
import tempfile
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from ..symbolic.block import Block
from ..symbolic.program import Entry
from ..symbolic.signals import Kind, Signal, Status
from .emit import CText
from .exported import run_tool, tool
from .findings import CheckResult, Findings
from .style import Precision

OPTIONS = [
    "-eva", "-eva-precision", "4", "-warn-special-float", "none", "-eva-split-return", "full", "-eva-slevel", "1000",
    "-machdep", "gcc_x86_64",
]  # fmt: skip
"""NaN and infinity may arise on the way: they are judged, and must not be stored."""


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
        value = {Kind.COUNT: "any_count", Kind.FLAG: "(any_count != 0U)"}.get(signal.kind, "any_real")
        if signal.kind is Kind.REAL and not anything:
            low, high = precision.literal(signal.low[k]), precision.literal(signal.high[k])
            value = f"Frama_C_{precision.name}_interval({low}, {high})"
        lines.append(f"    {target}.{name} = {value};")
    return lines


def _exact(value: float, precision: Precision) -> str:
    """Return the number that the C compares with, exactly: in an annotation a decimal is a real number."""
    return float(precision.dtype(value)).hex()


def _holds(target: str, signals: Sequence[Signal], precision: Precision) -> list[str]:
    lines = []
    for signal, k, name in _fields(signals):
        if signal.kind is Kind.REAL:
            item, low, high = f"{target}.{name}", _exact(signal.low[k], precision), _exact(signal.high[k], precision)
            lines.append(f"    //@ assert \\is_finite({item}) && {low} <= {item} <= {high};")
    return lines


def proof_source(block: Block, precision: Precision) -> str:
    """Return the C text of the harness: a function ``prove_<entry>`` for each entry.

    Parameters
    ----------
    block : Block
        Whose entries are called.
    precision : Precision
        Of the C.
    """
    real = precision.name
    lines = [
        f'#include "{block.name}.h"', '#include "__fc_builtin.h"', "",
        f"static volatile {real} any_real;", "static volatile uint32_t any_count;",
    ]  # fmt: skip
    for entry in block.entries.values():
        lines += ["", f"void prove_{entry.name}(void)", "{", *_proof_of(block, entry, precision), "}"]
    return "\n".join(lines) + "\n"


def _proof_of(block: Block, entry: Entry, precision: Precision) -> list[str]:
    name = block.name
    memory, params = block.memory_group().members, block.param_group().members
    lines, arguments = [f"    {name}_state_t state;"], ["&state"]
    for has, kind, variable in (
        (params, f"{name}_params_t", "params"),
        (entry.inputs, f"{name}_{entry.name}_in_t", "in"),
        (entry.outputs, f"{name}_{entry.name}_out_t", "out"),
    ):
        if has:
            lines.append(f"    {kind} {variable};")
            arguments.append(f"&{variable}")
    lines.append(f"    {name}_status_t status;")
    if not entry.checks_params:
        lines += _fill("state", memory, precision, anything=False)
    lines += _fill("params", params, precision, anything=entry.checks_params)
    lines += _fill("in", entry.inputs, precision, anything=True)
    lines.append(f"    status = {name}_{entry.name}({', '.join(arguments)});")
    lines.append(f"    //@ assert {int(min(Status))} <= status <= {int(max(Status))};")
    holds = _holds("state", memory, precision)
    lines += ["    if (status >= 0)", "    {", *holds, "    }"] if entry.checks_params else holds
    finite = [
        f"    //@ assert \\is_finite(out.{field});"
        for signal, _, field in _fields(entry.outputs)
        if signal.kind is Kind.REAL
    ]
    return lines + (["    if (status >= 0)", "    {", *finite, "    }"] if finite else [])


def analyse(block: Block, text: CText, entry: str, *, seconds: float = 300.0) -> list[Property]:
    """Return every property of one entry that Frama-C looked at.

    Parameters
    ----------
    block : Block
        Whose entry it is.
    text : CText
        Its C.
    entry : str
        Name of the entry.
    seconds : float
        How long the analysis may take; beyond it subprocess.TimeoutExpired is raised.

    Raises
    ------
    MissingTool
        If frama-c is not installed.
    RuntimeError
        If it ended without a report.
    """
    program = tool("frama-c", "frama-c-base")
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        (folder / f"{block.name}.h").write_text(text.header)
        (folder / f"{block.name}.c").write_text(text.source)
        (folder / "proof_main.c").write_text(proof_source(block, text.precision))
        helpers = sorted({word.split("(")[0] for word in text.source.split() if word.startswith(f"{block.name}_math_")})
        # what computes and stores nothing needs no case distinction
        bounded = ",".join(f"{helper}:0" for helper in helpers)
        command = [program, *OPTIONS, *(["-eva-slevel-function", bounded] if bounded else [])]
        report = folder / "report.csv"
        # whole paths: frama-c resolves others by the variable PWD, not by where it runs
        command += [f"-main=prove_{entry}", str(folder / "proof_main.c"), str(folder / f"{block.name}.c")]
        done = run_tool([*command, "-then", "-report-csv", str(report)], folder, seconds=seconds)
        if done.returncode != 0 or not report.is_file():
            raise RuntimeError(f"frama-c ended with {done.returncode}: {(done.stdout + done.stderr)[-1000:]}")
        with report.open() as rows:
            found = [
                Property(row["function"], row["property kind"], row["status"], row["property"])
                for row in csv.DictReader(rows, delimiter="\t")
            ]
    # other entries' harnesses are not run; what Frama-C's own library promises of itself is taken on trust
    return [
        item
        for item in found
        if item.status != "Considered valid"
        and (not item.function.startswith("prove_") or item.function == f"prove_{entry}")
        and not (item.status == "Dead" and item.function != f"prove_{entry}")
    ]


def prove(block: Block, text: CText, entries: Sequence[str], *, seconds: float = 300.0) -> Findings:
    """Prove that no call of these entries takes the memory out of its ranges, whatever the inputs.

    Parameters
    ----------
    block : Block
        Whose entries they are.
    text : CText
        Its C.
    entries : sequence of str
        Names of entries.
    seconds : float
        How long each analysis may take.
    """
    found = Findings()
    facts = {}
    for name in entries:
        started = time.perf_counter()
        properties = analyse(block, text, name, seconds=seconds)
        own = [item for item in properties if item.function == f"prove_{name}" and item.kind == "user assertion"]
        open_ones = [item for item in properties if not item.is_proved]
        least = sum(signal.kind is Kind.REAL for signal, _, _ in _fields(block.memory_group().members))
        # a harness whose calls never return would leave its assertions unreached
        passed = not open_ones and len(own) > least
        note = "; ".join(f"{item.function}: {item.text} ({item.status})" for item in open_ones[:3])
        found.checks.append(CheckResult(f"proof of {name}", passed, calls=len(properties), note=note))
        facts[name] = {
            "properties": len(properties),
            "assertions": len(own),
            "open": len(open_ones),
            "seconds": round(time.perf_counter() - started, 1),
        }
    found.facts["proof"] = facts
    return found
