"""report.html: what the evidence of an export says, on one page that needs nothing else."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import Any

import jinja2
import numpy as np

from ..symbolic.block import Block
from ..symbolic.signals import STATUS_TEXT, Kind, Status
from . import figures
from .costs import Cost, read
from .crosscheck import Probe
from .layout import fill, flatten
from .views import InterpretView

FIELDS_SHOWN = 12
"""Fields of the memory that are drawn, at most: elements of vectors count."""

_SHOWN = frozenset(
    "name model precision passed compiler machine memory_bytes parameter_bytes checks statuses_reached targets coverage "
    "symbols gates tables mathematics".split()
)
"""Keys of the evidence that have a section of their own; any other is shown as it is."""

CLASSES = {"passed": "ok", "failed": "fail", "not judged": "open"}
"""Verdict -> class of its cell."""

Figure = dict[str, str]


@lru_cache
def _template(name: str) -> jinja2.Template:
    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("plantc.codegen", "templates"),
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=jinja2.StrictUndefined,
        autoescape=True,
    )
    environment.filters["number"] = _number
    return environment.get_template(name)


def report_html(
    block: Block,
    manifest: Mapping[str, Any],
    evidence: Mapping[str, Any],
    calls: Sequence[Probe],
    audit: Mapping[str, Any] | None = None,
) -> str:
    """Return the page.

    Parameters
    ----------
    block : Block
        What was exported.
    manifest, evidence : dict
        What lies beside it as manifest.json and evidence.json. A key that is absent leaves its section out.
    calls : sequence of Probe
        The calls of the cross-check, for the figures over the nominal trace.
    audit : dict, optional
        What lies beside it as audit.json.
    """
    checks = list(evidence["checks"])
    return _template("report.html.j2").render(
        manifest=manifest,
        evidence=evidence,
        checks=checks,
        failed=[item for item in checks if item["verdict"] == "failed"],
        classes=CLASSES,
        unjudged=[item for item in checks if item["verdict"] == "not judged"],
        calls=sum(int(item["calls"]) for item in checks),
        notes=block.notes,
        entries=_entries(manifest),
        targets=_targets(evidence),
        costs=_costs(evidence),
        figures=_figures(block, manifest, evidence, calls),
        coverage=evidence.get("coverage"),
        symbols=evidence.get("symbols"),
        gates=evidence.get("gates"),
        tables=evidence.get("tables", []),
        audit_section=audit_html(manifest["name"], audit),
        others={key: value for key, value in evidence.items() if key not in _SHOWN},
        statuses=[
            {"name": status.name, "value": int(status), "text": STATUS_TEXT[status]}
            for status in sorted(Status, key=lambda item: (item < 0, abs(int(item))))
        ],
        reached=evidence.get("statuses_reached", {}),
    )


AUDIT_BEGINS, AUDIT_ENDS = "<!-- what plantc audit found -->", "<!-- end of what plantc audit found -->"


def audit_html(name: str, audit: Mapping[str, Any] | None) -> str:
    """Return the section of a page that shows an audit.json, or says that there is none; marks are around it.

    Parameters
    ----------
    name : str
        Of the block.
    audit : dict, optional
        What lies beside the page as audit.json.
    """
    found = audit or {}
    fuzzed = []
    for key, facts in found.get("audits", {}).items():
        for what in ("random_calls", "search"):
            if isinstance(facts.get(what), Mapping):
                fuzzed.append({"audit": key, **facts[what]})
    section = _template("report_audit.html.j2").render(
        name=name,
        audit=found,
        classes=CLASSES,
        fuzzed=fuzzed,
        calls=sum(int(item.get("calls", 0)) for item in fuzzed),
        lost=sum(int(item.get("lost", 0)) for item in fuzzed),
        deviations=found.get("audits", {}).get("misra", {}).get("deviations", []),
    )
    return f"{AUDIT_BEGINS}\n{section}{AUDIT_ENDS}"


def with_audit(page: str, name: str, audit: Mapping[str, Any]) -> str:
    """Return a page with an audit in the place where it shows one; a page without that place as it is.

    Parameters
    ----------
    page : str
        A report.html.
    name : str
        Of the block.
    audit : dict
        What lies beside it as audit.json.
    """
    if page.count(AUDIT_BEGINS) != 1 or page.count(AUDIT_ENDS) != 1:
        return page
    before, _, rest = page.partition(AUDIT_BEGINS)
    return before + audit_html(name, audit) + rest.partition(AUDIT_ENDS)[2]


def _number(value: Any) -> str:
    """Write a number for people: thousands apart, small and large ones with an exponent."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return str(value)
    if isinstance(value, int):
        return f"{value:,}"
    if value == 0:
        return "0"
    return f"{value:.1e}" if abs(value) < 1e-3 or abs(value) >= 1e5 else f"{value:.3g}"


def _entries(manifest: Mapping[str, Any]) -> list[dict[str, Any]]:
    rows = []
    for name, entry in manifest["entries"].items():
        counted = entry["operations"]
        words = [
            f"{n} {word}{'' if n == 1 else 's'}" for word in figures.OPERATION_KINDS if (n := counted.get(word, 0))
        ]
        words += [f"{n} {word}" for word, n in counted.items() if word not in figures.OPERATION_KINDS]
        rows.append(
            {
                "name": name,
                "doc": entry["doc"],
                "inputs": ", ".join(_field(item) for item in entry["inputs"]) or "none",
                "outputs": ", ".join(_field(item) for item in entry["outputs"]) or "none",
                "operations": ", ".join(words) or "none",
            }
        )
    return rows


def _field(item: Mapping[str, Any]) -> str:
    size = f"[{item['size']}]" if item["size"] > 1 else ""
    return f"{item['name']}{size}" + (f" ({item['unit']})" if item.get("unit") else "")


def _numbers(facts: Mapping[str, Any], quantity: str) -> tuple[dict[str, float], dict[str, float]]:
    """Return, each by entry, what was seen on a target and its bounds, as far as these are numbers."""
    costs = read(quantity, facts)
    seen = {entry: float(cost.seen) for entry, cost in costs.items() if isinstance(cost.seen, int)}
    bound = {entry: float(cost.bound) for entry, cost in costs.items() if isinstance(cost.bound, int)}
    return seen, bound


def _costs(evidence: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Return one row for each entry on each target: instructions and stack, seen and bound."""
    given = evidence.get("targets")
    rows = []
    for name, facts in (given if isinstance(given, Mapping) else {}).items():
        if not isinstance(facts, Mapping):
            continue
        instructions, stack = read("instructions", facts), read("stack", facts)
        for entry in instructions.keys() | stack.keys():
            row: dict[str, Any] = {"target": name, "entry": entry}
            for quantity, costs in (("instructions", instructions), ("stack", stack)):
                cost = costs.get(entry, Cost("not measured", "not stated"))
                row |= {quantity: cost.seen, f"{quantity}_bound": cost.bound}
            rows.append(row)
    order = list(evidence.get("targets") or {})
    return sorted(rows, key=lambda row: (order.index(row["target"]), -_most(row), row["entry"]))


def _most(row: Mapping[str, Any]) -> int:
    return next((row[key] for key in ("instructions_bound", "instructions") if isinstance(row[key], int)), 0)


def _targets(evidence: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Return one row for each target: sizes, and the deepest stack."""
    given = evidence.get("targets")
    if not isinstance(given, Mapping):
        return []
    rows = []
    for name, facts in given.items():
        if not isinstance(facts, Mapping):
            rows.append(
                dict.fromkeys(("description", "toolchain", "flags"), "")
                | {"name": name, "note": str(facts), "equal": None}
            )
            continue
        sizes = facts.get("linked") or facts.get("object") or facts
        toolchain = facts.get("toolchain", {})
        label = toolchain.get("version", "") if isinstance(toolchain, Mapping) else str(toolchain)
        flags = toolchain.get("flags", facts.get("flags", ())) if isinstance(toolchain, Mapping) else ()
        painted, bound = _numbers(facts, "stack")
        run = facts.get("free_run", {})
        rows.append(
            {
                "name": name,
                "description": facts.get("description", ""),
                "toolchain": label,
                "flags": flags if isinstance(flags, str) else " ".join(flags),
                **{key: sizes.get(key) for key in ("text", "data", "bss")},
                "stack": max(painted.values(), default=None),
                "stack_bound": max(bound.values()) if bound and len(bound) == len(read("stack", facts)) else None,
                "equal": run.get("equal_to_host") if isinstance(run, Mapping) else None,
                "note": "",
            }
        )
    return rows


# ---------------------------------------------------------------------------------------------------------------------
# Figures


def _figures(
    block: Block, manifest: Mapping[str, Any], evidence: Mapping[str, Any], calls: Sequence[Probe]
) -> dict[str, Figure]:
    found: dict[str, Figure] = {}

    def add(name: str, figure: Any, title: str, description: str) -> None:
        found[name] = {"svg": figures.svg_of(figure, f"figure-{name}", title, description), "title": title}

    counts = {name: entry["operations"] for name, entry in manifest["entries"].items()}
    if any(sum(row.values()) for row in counts.values()):
        totals = ", ".join(f"{name} {sum(row.values())}" for name, row in counts.items())
        add("operations", figures.operations(counts), "Operations by kind, by entry", f"In all: {totals}.")
    given = evidence.get("targets")
    facts = {k: v for k, v in given.items() if isinstance(v, Mapping)} if isinstance(given, Mapping) else {}
    for key, unit, title in (
        (
            "instructions",
            "instructions per call (never cycles)",
            "Instructions per call: the most seen on the traces, and a bound",
        ),
        ("stack", "bytes, callees included", "Stack of each entry: the most painted on the traces, and a bound"),
    ):
        both = {name: _numbers(row, key) for name, row in facts.items()}
        both = {name: row for name, row in both.items() if any(row)}
        if both:
            seen, bound = ({name: row[k] for name, row in both.items()} for k in (0, 1))
            add(key, figures.grouped(seen, bound, unit), title, _told(seen, bound))
    limited = [item for item in evidence["checks"] if item["limit"] and isinstance(item["worst"], (int, float))]
    if limited:
        worst = "; ".join(f"{item['name']}: {item['worst']:.1e} of {item['limit']:.0e}" for item in limited)
        add("errors", figures.errors(limited), "Worst difference of each check, and its limit", worst + ".")
    if evidence.get("statuses_reached"):
        told = ", ".join(f"{name} {count}" for name, count in evidence["statuses_reached"].items())
        add("statuses", figures.statuses(evidence["statuses_reached"]), "Statuses returned", told + ".")
    nominal = [probe for probe in calls if probe.trace == "nominal" and probe.answer is not None]
    if nominal:
        _trace_figures(block, evidence, nominal, add)
    return found


def _told(seen: Mapping[str, Mapping[str, float]], bound: Mapping[str, Mapping[str, float]]) -> str:
    """Return the numbers of a figure of costs in words."""
    lines = []
    for name, row in seen.items():
        limits = bound[name]
        entries = list(dict.fromkeys([*row, *limits]))
        words = [
            f"{entry} {f'{row[entry]:.0f}' if entry in row else 'not seen'}"
            + (f" (bound {limits[entry]:.0f})" if entry in limits else " (no bound)")
            for entry in entries
        ]
        lines.append(f"{name}: {', '.join(words)}")
    return "; ".join(lines) + "."


def _trace_figures(block: Block, evidence: Mapping[str, Any], nominal: list[Probe], add: Any) -> None:
    single = evidence["precision"] == "float"
    limit = block.float_bound if single else 1e-9
    gaps = _differences(block, nominal)
    label = "C in float against Python in double" if single else "C in double against Python in double"
    title = f"{'Float against double' if single else 'C against Python'}, call by call from the same memory"
    largest = max(gaps, default=0.0)
    about = (
        f"{len(gaps)} calls; the largest difference is {largest:.1e} of a field's natural size, the limit {limit:.0e}."
    )
    add("trace", figures.per_call({label: gaps}, limit), title, about)
    fields = _memory_fields(block, nominal)
    if fields:
        band = any(sigma is not None for _, sigma, _ in fields.values())
        title = "Memory over the nominal trace" + (", with three sigma" if band else "")
        add("memory", figures.memory(fields), title, f"Fields {', '.join(fields)} over {len(nominal)} calls.")


def _differences(block: Block, nominal: Sequence[Probe]) -> list[float]:
    """Return the largest difference between the C and the program in Python of each call, in natural sizes."""
    view = InterpretView(block)
    scales = block.scenario.scales if block.scenario is not None else None
    angles = {signal.name for signal in block.memory_signals_flat() if signal.angle}
    answer = []
    for probe in nominal:
        other = view.call(
            probe.entry,
            fill(view.memory(), flatten(probe.memory)),
            fill(view.inputs(probe.entry, {}), flatten(probe.inputs)),
            fill(view.params(), flatten(probe.params)),
        )
        if probe.answer is None or probe.answer.status < 0 or other.status < 0:
            continue
        after = flatten(other.memory)
        sizes = dict(scales(after)) if scales is not None else {}
        worst = 0.0
        for name, value in after.items():
            if value.dtype.kind != "f":
                continue
            gap = np.abs(flatten(probe.answer.memory)[name].astype(float) - value)
            if name in angles:
                gap = np.abs(gap - 2 * np.pi * np.round(gap / (2 * np.pi)))
            size = np.maximum(sizes.get(name, max(1e-300, float(np.max(np.abs(value), initial=0.0)))), 1e-300)
            worst = max(worst, float(np.max(gap / size, initial=0.0)))
        answer.append(worst)
    return answer


def _memory_fields(block: Block, nominal: Sequence[Probe]) -> dict[str, tuple[Any, Any | None, str]]:
    """Return name -> (values, sigma or None, unit) of the elements that are drawn; matrices are not."""
    scales = block.scenario.scales if block.scenario is not None else None
    memories = [flatten(probe.answer.memory) for probe in nominal if probe.answer is not None]
    sizes = [dict(scales(item)) if scales is not None else {} for item in memories]
    fields: dict[str, tuple[Any, Any | None, str]] = {}
    for signal in block.memory_signals_flat():
        if signal.kind is not Kind.REAL or signal.uniform_range is None:
            continue
        for i in range(signal.size):
            if len(fields) == FIELDS_SHOWN:
                return fields
            values = np.array([float(item[signal.name][i]) for item in memories])
            own = [np.ravel(size[signal.name])[i] for size in sizes if signal.name in size]
            name = signal.name if signal.size == 1 else f"{signal.name}[{i}]"
            sigma = np.array(own, dtype=float) if len(own) == len(values) else None
            fields[name] = (values, sigma, signal.unit)
    return fields
