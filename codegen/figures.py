"""Figures of a report as SVG inside the page: the same text for the same numbers, colours left to the page's style.

Matplotlib takes a second to be imported, and most commands draw nothing: it is imported by the first figure.
"""

from __future__ import annotations

import io
import re
from collections.abc import Mapping, Sequence
from contextlib import AbstractContextManager
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

INK, RULE, MUTED = "#000001", "#000002", "#000003"
SERIES = ("#0000a1", "#0000a2", "#0000a3", "#0000a4", "#0000a5", "#0000a6")
_VARIABLES = {INK: "--ink", RULE: "--rule", MUTED: "--muted"} | {c: f"--c{k + 1}" for k, c in enumerate(SERIES)}
_WIDTH = 7.2
_STYLE: Any = {
    "svg.fonttype": "none",
    "svg.hashsalt": "plantc",
    "font.family": "sans-serif",
    "font.size": 8.0,
    "text.color": INK,
    "axes.edgecolor": RULE,
    "axes.labelcolor": MUTED,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.linewidth": 0.7,
    "axes.axisbelow": True,
    "xtick.color": MUTED,
    "ytick.color": MUTED,
    "xtick.labelcolor": MUTED,
    "ytick.labelcolor": INK,
    "grid.color": RULE,
    "grid.linewidth": 0.5,
    "legend.frameon": False,
    "figure.facecolor": "none",
    "axes.facecolor": "none",
    "savefig.facecolor": "none",
    "path.simplify_threshold": 0.5,
}

OPERATION_KINDS = ("addition", "multiplication", "division", "negation", "selection")


def svg_of(figure: Figure, name: str, title: str, description: str) -> str:
    """Return the SVG of a figure, for use inside a page.

    Parameters
    ----------
    figure : Figure
        What to write.
    name : str
        Prefix of every identifier, so that figures of one page do not share any.
    title, description : str
        What it is, and what it shows, for those who do not see it.
    """
    stream = io.StringIO()
    with styled({"svg.hashsalt": name}):
        figure.savefig(stream, format="svg", metadata={"Date": None, "Creator": None})
    text = stream.getvalue()
    text = text[text.index("<svg") :]
    text = re.sub(r"<metadata>.*?</metadata>\s*", "", text, flags=re.DOTALL)
    text = re.sub(r"<!--.*?-->\s*", "", text, flags=re.DOTALL)
    text = re.sub(r'\bid="([^"]+)"', rf'id="{name}-\1"', text)
    text = re.sub(r'(xlink:href=")#', rf"\1#{name}-", text).replace("xlink:href", "href")
    text = re.sub(r"url\(#", f"url(#{name}-", text)
    used = set(re.findall(r'(?:href="|url\()#([^")]+)', text))
    text = re.sub(r' id="([^"]+)"', lambda found: found.group(0) if found.group(1) in used else "", text)
    text = re.sub(r"\n\s*", "\n", text).replace("; ", ";")
    for colour, variable in _VARIABLES.items():
        text = text.replace(colour, f"var({variable})")
    text = re.sub(r"font-family:[^;\"]*;?", "", text)  # the page's own
    head = text.index(">") + 1
    box = re.search(r'viewBox="([^"]+)"', text[:head])
    assert box is not None
    labels = f'aria-labelledby="{name}-title {name}-description"'
    return (
        f'<svg id="{name}" class="figure" xmlns="http://www.w3.org/2000/svg" viewBox="{box.group(1)}" role="img" {labels}>'
        f'<title id="{name}-title">{_escaped(title)}</title><desc id="{name}-description">{_escaped(description)}</desc>'
        + re.sub(r"(\d+\.\d)\d+", r"\1", text[head:]).strip()
    )


def _escaped(text: str) -> str:
    return text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")


def styled(more: Mapping[str, Any] | None = None) -> AbstractContextManager[None]:
    """Return a context in which Matplotlib draws as the page has it."""
    import matplotlib as mpl

    return mpl.rc_context(_STYLE | dict(more or {}))


def blank(height: float) -> Figure:
    """Return an empty figure as wide as the page, of a height in inches."""
    from matplotlib.figure import Figure

    return Figure(figsize=(_WIDTH, height), layout="constrained")


def _bars(axes: Axes, labels: Sequence[str], parts: Mapping[str, Sequence[float]], unit: str) -> None:
    """Draw stacked horizontal bars, the first label on top, with totals."""
    at = np.arange(len(labels))
    left = np.zeros(len(labels))
    for k, (name, values) in enumerate(parts.items()):
        axes.barh(at, values, left=left, height=0.62, color=SERIES[k % len(SERIES)], label=name)
        left = left + np.asarray(values, dtype=float)
    for y, total in zip(at, left, strict=True):
        axes.annotate(f"{total:,.0f}", (total, y), xytext=(4, 0), textcoords="offset points", va="center")
    axes.set_yticks(at, labels)
    axes.invert_yaxis()
    axes.set_xlabel(unit)
    axes.margins(x=0.1)
    axes.tick_params(length=0)
    axes.grid(axis="x")


def operations(counts: Mapping[str, Mapping[str, int]]) -> Figure:
    """Draw operations by kind for each entry."""
    with styled():
        entries = [name for name, row in counts.items() if sum(row.values())]
        figure = blank(0.8 + 0.28 * len(entries))
        axes = figure.subplots()
        parts = {word: [counts[name].get(word, 0) for name in entries] for word in OPERATION_KINDS}
        parts["function"] = [
            sum(n for key, n in counts[name].items() if key not in OPERATION_KINDS) for name in entries
        ]
        parts = {word: values for word, values in parts.items() if any(values)}
        _bars(axes, entries, parts, "operations in the text of one call")
        figure.legend(loc="outside upper left", ncols=len(parts), handlelength=1.0, columnspacing=1.2)
        return figure


def grouped(rows: Mapping[str, Mapping[str, float]], bounds: Mapping[str, Mapping[str, float]], unit: str) -> Figure:
    """Draw a number for each entry on each target, and a bound as a tick where there is one; either may be missing."""
    with styled():
        given = [*rows.values(), *bounds.values()]
        entries = list(dict.fromkeys(entry for row in given for entry in row))
        figure = blank(0.8 + len(entries) * (0.16 + 0.15 * len(rows)))
        axes = figure.subplots()
        step = 0.8 / max(1, len(rows))
        for k, (target, row) in enumerate(rows.items()):
            at = np.arange(len(entries)) - 0.4 + step * (k + 0.5)
            values = [row.get(entry, 0) for entry in entries]
            axes.barh(at, values, height=0.85 * step, color=SERIES[k % len(SERIES)], label=target)
            limits = bounds.get(target, {})
            known = [(limits[entry], y) for entry, y in zip(entries, at, strict=True) if entry in limits]
            if known:
                axes.scatter([v for v, _ in known], [y for _, y in known], marker="|", s=40, color=INK, zorder=3)
            for entry, y in zip(entries, at, strict=True):
                words = [f"{row[entry]:,.0f}"] if entry in row else []
                words += [f"\N{LESS-THAN OR EQUAL TO} {limits[entry]:,.0f}"] if entry in limits else []
                far = max(row.get(entry, 0), limits.get(entry, 0))
                text = ", ".join(words)
                axes.annotate(text, (far, y), xytext=(5, 0), textcoords="offset points", va="center", fontsize=6.5)
        if any(bounds.values()):
            axes.scatter([], [], marker="|", s=40, color=INK, label="bound")
        axes.set_yticks(np.arange(len(entries)), entries)
        axes.invert_yaxis()
        axes.set_xlabel(unit)
        axes.margins(x=0.2)
        axes.tick_params(length=0)
        axes.grid(axis="x")
        figure.legend(loc="outside upper left", ncols=6, handlelength=1.0, columnspacing=1.2)
        return figure


def errors(checks: Sequence[Mapping[str, Any]]) -> Figure:
    """Draw the worst difference of each check beside its limit, on a logarithmic scale."""
    with styled():
        figure = blank(0.7 + 0.24 * len(checks))
        axes = figure.subplots()
        at = np.arange(len(checks))
        floor = 1e-18
        worst = [max(float(item["worst"]), floor) for item in checks]
        limit = [float(item["limit"]) for item in checks]
        axes.hlines(at, worst, limit, color=RULE, linewidth=1.2)
        axes.scatter(worst, at, color=SERIES[0], s=22, label="worst difference", zorder=3)
        axes.scatter(limit, at, color=SERIES[1], marker="|", s=90, label="limit", zorder=3)
        axes.set_xscale("log")
        axes.set_yticks(at, [str(item["name"]) for item in checks])
        axes.invert_yaxis()
        axes.set_xlabel("difference in units of each field's natural size (zero is drawn at 1e-18)")
        axes.tick_params(length=0)
        axes.grid(axis="x")
        figure.legend(loc="outside upper left", ncols=2, handlelength=1.0)
        return figure


def per_call(differences: Mapping[str, Sequence[float]], limit: float) -> Figure:
    """Draw the largest difference of each call along the nominal trace."""
    with styled():
        figure = blank(2.1)
        axes = figure.subplots()
        for k, (name, values) in enumerate(differences.items()):
            shown = np.maximum(np.asarray(values, dtype=float), 1e-18)
            axes.plot(np.arange(len(shown)), shown, ".", markersize=3.5, color=SERIES[k % len(SERIES)], label=name)
        axes.axhline(limit, color=SERIES[1], linewidth=0.9)
        axes.annotate(
            "limit", (0, limit), xytext=(2, -3), textcoords="offset points", va="top", color=SERIES[1], fontsize=7.5
        )
        axes.set_yscale("log")
        axes.set_xlabel("call of the nominal trace")
        axes.set_ylabel("largest difference")
        axes.grid(axis="y")
        figure.legend(loc="outside upper left", ncols=3, handlelength=1.0)
        return figure


def statuses(counts: Mapping[str, int]) -> Figure:
    """Draw how often each status was returned."""
    with styled():
        rows = sorted(counts.items(), key=lambda row: (-row[1], row[0]))
        figure = blank(0.5 + 0.22 * len(rows))
        axes = figure.subplots()
        _bars(axes, [name for name, _ in rows], {"calls": [count for _, count in rows]}, "calls of the cross-check")
        return figure


def memory(fields: Mapping[str, tuple[Any, Any | None, str]]) -> Figure:
    """Draw fields of the memory over the nominal trace, each with a band of three sigma where sigma is known."""
    with styled():
        columns = 2 if len(fields) > 1 else 1
        rows = (len(fields) + columns - 1) // columns
        figure = blank(0.3 + 1.25 * rows)
        grid = figure.subplots(rows, columns, squeeze=False)
        for axes in grid.ravel()[len(fields) :]:
            axes.set_visible(False)
        for axes, (name, (values, sigma, unit)) in zip(grid.ravel(), fields.items(), strict=False):
            calls = np.arange(len(values))
            if sigma is not None:
                axes.fill_between(
                    calls, values - 3 * sigma, values + 3 * sigma, color=SERIES[0], alpha=0.22, linewidth=0
                )
            axes.plot(calls, values, color=SERIES[0], linewidth=0.9)
            axes.locator_params(nbins=4)
            axes.set_title(f"{name}{f' [{unit}]' if unit else ''}", loc="left", fontsize=8, color=INK)
            axes.tick_params(length=0, labelcolor=MUTED)
            axes.grid(axis="y")
        for axes in grid[-1]:
            axes.set_xlabel("call")
        return figure
