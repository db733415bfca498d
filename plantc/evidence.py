"""What an export measured, and what went wrong, as lines for a terminal."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from decimal import ROUND_CEILING, Decimal, localcontext
from typing import Any

import numpy as np

from .codegen.audit import AuditError
from .codegen.compiler import CompilerError
from .codegen.costs import Cost, read
from .codegen.exported import MissingTool
from .codegen.findings import CheckResult
from .codegen.package import DesignError, Export
from .codegen.proof import ProofError
from .codegen.rounding import Bound
from .codegen.style import Precision
from .models import UsageError
from .symbolic import ModelError


def sentence(error: BaseException) -> str:
    """Return what the user reads of an error that stops a command."""
    if isinstance(error, (UsageError, ModelError, DesignError, CompilerError, AuditError, MissingTool, ProofError)):
        return str(error)
    if isinstance(error, OSError):
        return f"{error.filename}: {error.strerror}" if error.filename and error.strerror else str(error)
    return f"plantc itself failed ({type(error).__name__}: {error}); run again with --debug and report it"


def export_json(item: Export) -> dict[str, Any]:
    """Return what an export measured, for JSON."""
    return {"folder": str(item.folder), "from_cache": item.from_cache, **item.evidence}


def evidence_text(item: Export, seconds: float) -> list[str]:
    """Return what an export measured, for a terminal."""
    evidence = item.evidence
    lines = [
        f"{item.block.name}: model {evidence['model']}, {item.precision}, compiled by {evidence['compiler']['label']} "
        f"({evidence['compiler']['contraction']}), {evidence['memory_bytes']} bytes of memory, {seconds:.1f} s"
    ]
    if item.from_cache:
        lines.append("  from the cache: the same export was done before on this machine (--no-cache does it again)")
    lines += checks_text(item.check.results)
    reached = ", ".join(
        f"{name} {count}" for name, count in sorted(item.check.statuses.items(), key=lambda row: -row[1])
    )
    lines.append(f"  statuses reached: {reached}")
    lines += coverage_text(evidence.get("coverage", ""))
    lines += operations_text(json.loads(item.files["manifest.json"])["entries"])
    lines += targets_text(evidence.get("targets", {}))
    return [*lines, *(f"  {table['title']}: {table['caption']} (report.html)" for table in evidence.get("tables", []))]


def coverage_text(coverage: Any) -> list[str]:
    """Return a line on what the shipped vectors reach."""
    if not isinstance(coverage, dict):
        return [f"  coverage: {coverage}"] if coverage else []
    ran, taken = coverage["statements"], coverage["branches"]
    return [
        f"  coverage: the shipped vectors run {ran['reached']} of {ran['all']} statements; with {coverage['corpus_calls']} "
        f"more calls {taken['reached']} of {taken['all']} branches are taken (the rest with reasons in report.html)"
    ]


def operations_text(entries: dict[str, Any]) -> list[str]:
    """Return the operations by kind of each entry that has any."""
    words = ("addition", "multiplication", "division", "negation", "selection")
    lines = []
    for name, entry in entries.items():
        counted = entry["operations"]
        parts = [f"{counted[word]} {word}{'' if counted[word] == 1 else 's'}" for word in words if counted.get(word)]
        parts += [f"{count} {word}" for word, count in counted.items() if word not in words]
        if parts:
            lines.append(f"  operations of {name}: {', '.join(parts)}")
    return lines


def targets_text(targets: dict[str, Any]) -> list[str]:
    """Return a table of what the code costs on each target."""
    lines = [
        f"  {'target':<10} {'text':>7} {'data':>6} {'bss':>6} {'stack':>6}  instructions per call, the most seen (<= a bound)"
    ]
    for name, facts in targets.items():
        sizes, stack, counts = facts["object"], read("stack", facts), read("instructions", facts)
        columns = [f"{sizes[key]:>{width}}" if isinstance(sizes, dict) else "-".rjust(width)
                   for key, width in (("text", 7), ("data", 6), ("bss", 6))]  # fmt: skip
        deepest = max((item.seen for item in stack.values() if isinstance(item.seen, int)), default="-")
        if deepest == "-" and stack and all(isinstance(item.bound, int) for item in stack.values()):
            deepest = f"<={max(int(item.bound) for item in stack.values())}"
        lines.append(f"  {name:<10} {' '.join(columns)} {deepest:>6}  {', '.join(map(_cost_text, counts.items()))}")
    return lines if targets else []


def _cost_text(item: tuple[str, Cost]) -> str:
    entry, cost = item
    words = [str(cost.seen)] if isinstance(cost.seen, int) else []
    words += [f"(<= {cost.bound})"] if isinstance(cost.bound, int) else []
    return f"{entry} {' '.join(words) or 'not known'}"


MARKS = {"passed": "ok  ", "failed": "FAIL", "not judged": "--  "}
"""What stands before a check, by its verdict."""


def checks_text(results: list[CheckResult]) -> list[str]:
    """Return one line for each check."""
    lines = []
    for result in results:
        calls = f"{result.calls:>5} calls" if result.calls else " " * 11
        text = f"  {MARKS[result.verdict]} {result.name:<38} {calls}".rstrip()
        if result.limit:
            text += f"  worst {result.worst:8.1e}  limit {result.limit:.0e}"
        if result.at_switches:
            text += f"  ({result.at_switches} at a switch)"
        if result.ill_conditioned:
            text += f"  ({result.ill_conditioned} ill-conditioned)"
        if result.remark:
            text += f"  {result.remark}"
        lines.append(text)
        if result.mismatch is not None:
            lines.append(f"       {result.mismatch}")
    return lines


def rounding_text(bounds: Sequence[Bound], precision: Precision) -> list[str]:
    """Return a table of what one call can lose to rounding, and of what has no bound.

    Numbers of one name are on one line, which has the worst of them.
    """
    groups: dict[tuple[str, str, str], list[Bound]] = {}
    for bound in bounds:
        stem = re.sub(r"(\[\d+\]|(_\d+)+)$", "", bound.name) if bound.role == "local" else bound.name.split("[")[0]
        why = "" if bound.error is not None else bound.reason
        groups.setdefault((bound.entry, stem, re.sub(r"[\d.]+e[+-]\d+|\[\d+\]", "", why)), []).append(bound)
    own = [bound for bound in bounds if not bound.is_of_kernel]
    anywhere, usual = sum(bound.error is not None for bound in own), sum(bound.is_bounded for bound in own)
    lines = [
        f"  rounding errors of one call, bounded by Gappa: {anywhere} of {len(own)} numbers where all is anywhere in its range, "
        f"{usual} with the parameters at their defaults; none of what kernels give"
    ]
    width = max((len(f"{entry}: {stem}") for entry, stem, _ in groups), default=0) + 5
    for (entry, stem, _), group in groups.items():
        name = f"{entry}: {group[0].name}" if len(group) == 1 else f"{entry}: {stem} ({len(group)})"
        lines.append(f"    {name:<{width}}  {_rounding_of(group, precision)}")
    return lines


def _rounding_of(group: Sequence[Bound], precision: Precision) -> str:
    """Return the worst bound of numbers that belong together, or why there is none."""
    unit = f" {group[0].unit}" if group[0].unit else ""

    def said(error: float, reaches: float) -> str:
        last = float(np.spacing(precision.dtype(reaches)))
        return f"{_at_least(error)}{unit} of {reaches:.3g}, {_at_least(error / last)} ulp of it"

    worst = max(group, key=lambda bound: bound.error or 0.0)
    usual = max(group, key=lambda bound: bound.error_at_defaults or 0.0)
    parts = [f"none: {worst.reason}"]
    if worst.error is not None and worst.low is not None and worst.high is not None:
        parts = [said(worst.error, max(abs(worst.low), abs(worst.high)))]
    if usual.error_at_defaults is not None and usual.reaches_at_defaults is not None:
        parts.append(f"at the defaults {said(usual.error_at_defaults, usual.reaches_at_defaults)}")
    return "; ".join([*parts, *worst.notes])


def _at_least(value: float) -> str:
    """Return two digits of a number, rounded up."""
    with localcontext() as context:
        context.prec, context.rounding = 2, ROUND_CEILING
        return f"{float(+Decimal(value)):.2g}"
