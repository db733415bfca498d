"""A study: a published result done again, and the page that puts what was printed beside what came out."""

from __future__ import annotations

import hashlib
import json
import math
import multiprocessing
import platform
import signal
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import jinja2

from ..codegen.emit import generator_version
from ..codegen.folder import MANIFEST, check_folder_is_free, write_folder

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Verdict = Literal["reproduces", "does not reproduce", "shown wrong", "cannot be compared"]
Progress = Callable[[str, int, int], None]
Cell = str | int | float | None

PAGE, RESULTS, EVIDENCE = "index.html", "results.json", "evidence.json"
FILES = (PAGE, RESULTS, EVIDENCE, MANIFEST)

_CLASSES = {"reproduces": "ok", "does not reproduce": "fail", "shown wrong": "fail", "cannot be compared": "open"}


@dataclass(frozen=True)
class Comparison:
    """One published statement beside what this run gave.

    Attributes
    ----------
    published : str
        What the paper says, with where it says it.
    ours : str
        What came out, with its uncertainty.
    verdict : str
        "reproduces", "does not reproduce", "shown wrong" (it cannot be so, whoever computes it), or "cannot be compared".
    why : str
        The cause, where it does not.
    measured : bool
        Whether it is of times on this machine, which are others in each run.
    """

    published: str
    ours: str
    verdict: Verdict
    why: str = ""
    measured: bool = False


NO_DATA = "The numbers that this would rest on are missing: no run, or none that was kept, gives them."


def compared(
    published: str,
    ours: str,
    holds: bool,
    numbers: Iterable[float],
    why: str = "",
    *,
    otherwise: Verdict = "does not reproduce",
    measured: bool = False,
) -> Comparison:
    """Return a comparison with its verdict; without the numbers that it rests on it is "cannot be compared".

    Parameters
    ----------
    published, ours, why, measured
        See `Comparison`.
    holds : bool
        Whether what was printed came out.
    numbers : iterable of float
        What `holds` rests on; where there are none, or one is no number, nothing is said of the paper.
    otherwise : str
        The verdict where it does not hold.
    """
    rests_on = list(numbers)
    if not rests_on or any(math.isnan(number) for number in rests_on):
        return Comparison(published, ours, "cannot be compared", NO_DATA, measured)
    return Comparison(published, ours, "reproduces" if holds else otherwise, why, measured)


@dataclass(frozen=True)
class StudyTable:
    """Numbers by row, with what they are.

    Attributes
    ----------
    name, title : str
        Name for programs, title for people.
    columns : tuple of str
        Heads.
    rows : tuple of tuple
        Cells: numbers, text, or None where there is none.
    note : str
        How to read it.
    measured : bool
        Whether it is of times on this machine.
    """

    name: str
    title: str
    columns: tuple[str, ...]
    rows: tuple[tuple[Cell, ...], ...]
    note: str = ""
    measured: bool = False

    def __post_init__(self) -> None:
        for row in self.rows:
            if len(row) != len(self.columns):
                raise ValueError(
                    f"table {self.name!r}: a row has {len(row)} cells, there are {len(self.columns)} columns"
                )


@dataclass(frozen=True)
class Picture:
    """A figure, with what it shows for those who do not see it."""

    name: str
    title: str
    description: str
    figure: Figure


@dataclass
class StudyResult:
    """What a study gave.

    Attributes
    ----------
    name, title, source : str
        The study, and what it does again.
    model : str
        Hash of the models that were run.
    summary : str
        What came out, in a few sentences.
    conditions : dict
        What the numbers were made with: runs, steps, seed, conventions.
    comparisons, tables, pictures : list
        What the page shows.
    seconds : dict
        How long each part took, on this machine; it is no part of the result.
    """

    name: str
    title: str
    source: str
    model: str
    summary: str = ""
    conditions: dict[str, Any] = field(default_factory=dict)
    comparisons: list[Comparison] = field(default_factory=list)
    tables: list[StudyTable] = field(default_factory=list)
    pictures: list[Picture] = field(default_factory=list)
    seconds: dict[str, float] = field(default_factory=dict)

    def table(self, name: str) -> list[dict[str, Cell]]:
        """Return the rows of a table as column -> cell.

        Raises
        ------
        KeyError
            If there is no such table.
        """
        for table in self.tables:
            if table.name == name:
                return [dict(zip(table.columns, row, strict=True)) for row in table.rows]
        raise KeyError(f"{self.name}: there is no table {name!r}; there are {', '.join(t.name for t in self.tables)}")

    def counts(self) -> dict[str, int]:
        """Return how many comparisons have each verdict."""
        return {verdict: sum(item.verdict == verdict for item in self.comparisons) for verdict in _CLASSES}

    def verdicts(self) -> str:
        """Return the same in words."""
        counts = self.counts()
        words = {
            "reproduces": "reproduce",
            "does not reproduce": "do not reproduce",
            "shown wrong": "are shown wrong",
            "cannot be compared": "cannot be compared",
        }
        said = ", ".join(f"{count} {words[verdict]}" for verdict, count in counts.items() if count)
        return f"of {len(self.comparisons)} printed statements {said}"

    def results(self) -> dict[str, Any]:
        """Return all that is the same in each run on machines of one kind, for JSON: no number that is not finite."""
        return {
            "name": self.name,
            "title": self.title,
            "source": self.source,
            "summary": self.summary,
            "generator": f"plantc {generator_version()}",
            "model": self.model,
            "conditions": self.conditions,
            **self._shown(measured=False),
        }

    def evidence(self) -> dict[str, Any]:
        """Return what was measured on this machine, for JSON."""
        seconds = {key: round(value, 3) for key, value in self.seconds.items()}
        return {"machine": platform.machine(), "seconds": seconds, **self._shown(measured=True)}

    def _shown(self, *, measured: bool) -> dict[str, Any]:
        tables = [table for table in self.tables if table.measured is measured]
        return {
            "comparisons": [asdict(item) for item in self.comparisons if item.measured is measured],
            "tables": {
                table.name: {
                    "title": table.title,
                    "note": table.note,
                    "columns": list(table.columns),
                    "rows": [[_finite(cell) for cell in row] for row in table.rows],
                }
                for table in tables
            },
        }


def each(function: Callable[[Any], Any], items: Sequence[Any], processes: int) -> Iterator[Any]:
    """Yield what a function gives for each item, in their order.

    Parameters
    ----------
    function : callable
        Of one item; it can be pickled, as the items and the answers.
    items : sequence
        What it is called with.
    processes : int
        In how many processes; with one it is called here.
    """
    if processes < 2:
        yield from map(function, items)
        return
    context = multiprocessing.get_context("spawn")
    pool = ProcessPoolExecutor(processes, mp_context=context, initializer=_leave_interrupts)
    try:
        yield from pool.map(function, items)
    finally:
        pool.shutdown(cancel_futures=True)


def _leave_interrupts() -> None:
    """Leave an interrupt to the process that started this one."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def study_page(result: StudyResult) -> str:
    """Return the page of a study: one HTML file that needs nothing else."""
    from ..codegen.figures import svg_of

    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("plantc.codegen", "templates"),
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=jinja2.StrictUndefined,
        autoescape=True,
    )
    environment.filters["cell"] = cell_text
    svgs = [
        {"svg": svg_of(item.figure, f"figure-{item.name}", item.title, item.description), "picture": item}
        for item in result.pictures
    ]
    return environment.get_template("study.html.j2").render(
        result=result, version=generator_version(), svgs=svgs, numeric=_numeric_columns, classes=_CLASSES
    )


def check_study_folder(name: str, out: Path, *, force: bool = False) -> Path:
    """See that a study may be written, before work is put into it; return its folder, ``out/name``.

    Raises
    ------
    FolderError
        See `plantc.codegen.folder.check_folder_is_free`.
    """
    folder = out / name
    check_folder_is_free(folder, FILES, force=force)
    return folder


def write_study(result: StudyResult, out: Path, *, force: bool = False) -> list[Path]:
    """Write the page and the numbers into ``out/<name>/``, whole or not at all.

    Parameters
    ----------
    result : StudyResult
        What the study gave.
    out : Path
        Where the folder of the study goes.
    force : bool
        Whether files of an earlier run may be replaced that someone changed since.

    Returns
    -------
    list of Path
        The files, the page first.

    Raises
    ------
    FolderError
        If the folder cannot be written, or holds what plantc did not write.
    """
    files = {PAGE: study_page(result), RESULTS: _json(result.results()), EVIDENCE: _json(result.evidence())}
    hashes = {name: hashlib.sha256(files[name].encode()).hexdigest() for name in (PAGE, RESULTS)}
    files[MANIFEST] = _json(
        {
            "name": result.name,
            "kind": "study",
            "model": result.model,
            "precision": "double",
            "generator": f"plantc {generator_version()}",
            "files": hashes,
        }
    )
    folder = out / result.name
    write_folder(folder, files, force=force)
    return [folder / name for name in files]


def _json(value: Mapping[str, Any]) -> str:
    return json.dumps(value, indent=2, allow_nan=False) + "\n"


def _finite(value: Cell) -> Cell:
    return None if isinstance(value, float) and not math.isfinite(value) else value


def cell_text(value: Any) -> str:
    """Write a cell for people: four digits, an exponent where a number is small or large, a dash where there is none."""
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return "-"
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return str(value)
    return f"{value:,}" if isinstance(value, int) else f"{value:.4g}"


def _numeric_columns(table: StudyTable) -> list[bool]:
    return [
        all(isinstance(row[k], (int, float, type(None))) and not isinstance(row[k], bool) for row in table.rows)
        for k in range(len(table.columns))
    ]
