"""Results of a Monte-Carlo: one file that says what made it, one line a run."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from .metrics import Judgement

FORMAT = "plantc Monte-Carlo 1"
SUBSETS = {"kept": ("kept",), "finite": ("kept", "lost")}
OUTCOMES = ("kept", "lost", "frozen")


class ResultError(ValueError):
    """A file is no result, or belongs to other settings. The message says what to do."""


@dataclass(frozen=True)
class Mean:
    """A mean over runs.

    Attributes
    ----------
    value, standard_error : float
        NaN if there are no runs (fewer than two for the error).
    runs : int
        How many runs it is of.
    """

    value: float
    standard_error: float
    runs: int

    def __str__(self) -> str:
        return f"{self.value:.4g} +- {self.standard_error:.2g} ({self.runs} runs)"


@dataclass
class Result:
    """What a Monte-Carlo gave.

    Attributes
    ----------
    header : dict
        What made it: plantc's version, hash of the model, seed, steps, parameters, strengths and conventions.
    judgements : dict of int to Judgement
        Run -> what became of it; runs that are not done are missing.
    """

    header: dict[str, Any]
    judgements: dict[int, Judgement] = field(default_factory=dict)

    @property
    def runs(self) -> int:
        """Runs that were asked for."""
        return int(self.header["runs"])

    @property
    def missing(self) -> list[int]:
        """Runs that are not done."""
        return [run for run in range(self.runs) if run not in self.judgements]

    def count(self, outcome: str) -> int:
        """Return the number of runs with an outcome: "kept", "lost", "frozen"; or "finite", the first two together.

        Raises
        ------
        ResultError
            If there is no such outcome.
        """
        if outcome not in (*SUBSETS, *OUTCOMES):
            raise ResultError(
                f"there is no outcome {outcome!r}; there are {', '.join(dict.fromkeys((*OUTCOMES, *SUBSETS)))}"
            )
        wanted = SUBSETS.get(outcome, (outcome,))
        return sum(item.outcome in wanted for item in self.judgements.values())

    def metrics(self) -> list[str]:
        """Return the names of the metrics."""
        return sorted({name for item in self.judgements.values() for name in item.metrics})

    def values(self, metric: str, of: str = "kept") -> NDArray[np.float64]:
        """Return a metric of each run of a subset, in the order of the runs.

        Parameters
        ----------
        metric : str
            See `plantc.simulation.metrics_of`.
        of : {"kept", "finite"}
            The subset.

        Raises
        ------
        ResultError
            If there is no such metric or subset.
        """
        if of not in SUBSETS:
            raise ResultError(f"the subset {of!r} is not known; take one of {', '.join(SUBSETS)}")
        if metric not in self.metrics():
            raise ResultError(f"the metric {metric!r} is not known; take one of {', '.join(self.metrics())}")
        chosen = [self.judgements[run] for run in sorted(self.judgements)]
        return np.array([item.metrics[metric] for item in chosen if item.outcome in SUBSETS[of]])

    def every(self, metric: str, *, above: float = math.inf) -> NDArray[np.float64]:
        """Return a metric of every run that is done, in the order of the runs; infinite where the run diverged.

        So a quantile over all runs tells how many were lost, which a mean over survivors does not.

        Parameters
        ----------
        metric : str
            See `plantc.simulation.metrics_of`.
        above : float
            A run whose metric is greater counts as diverged, as does one that was frozen.
        """
        if metric not in self.metrics():
            raise ResultError(f"the metric {metric!r} is not known; take one of {', '.join(self.metrics())}")
        chosen = [self.judgements[run] for run in sorted(self.judgements)]
        values = np.array([item.metrics.get(metric, math.inf) for item in chosen], dtype=float)
        # a frozen run has NaN, which no comparison lets through
        return np.where(values <= above, values, math.inf)

    def mean(self, metric: str, of: str = "kept") -> Mean:
        """Return the mean of a metric over a subset, with its standard error; sums are in the order of the runs.

        Parameters
        ----------
        metric, of : str
            As for `values`.
        """
        values = self.values(metric, of).tolist()
        count = len(values)
        if not count:
            return Mean(math.nan, math.nan, 0)
        value = math.fsum(values) / count
        if count < 2 or not math.isfinite(value):
            return Mean(value, math.nan, count)
        square = math.fsum((item - value) ** 2 for item in values) / (count - 1)
        return Mean(value, math.sqrt(square / count), count)

    def median(self, metric: str, of: str = "kept") -> float:
        """Return the median of a metric over a subset."""
        values = self.values(metric, of)
        return float(np.median(values)) if len(values) else math.nan

    def save(self, path: Path | str) -> Path:
        """Write the file, whole or not at all; the same result gives the same bytes.

        Parameters
        ----------
        path : Path or str
            The file: JSON lines, first what made it, then each run.
        """
        target = Path(path)
        lines = [header_line(self.header), *[row_line(run, self.judgements[run]) for run in sorted(self.judgements)]]
        partial = target.with_name(f".{target.name}.{os.getpid()}")
        partial.write_text("".join(lines))
        os.replace(partial, target)
        return target

    @classmethod
    def load(cls, path: Path | str) -> Self:
        """Read a file; runs whose line was cut off are missing.

        Raises
        ------
        ResultError
            If it is no such file, or a line of it is damaged.
        """
        try:
            lines = Path(path).read_text().splitlines(keepends=True)
            header = json.loads(lines[0])
            if header["format"] != FORMAT:
                raise ValueError(header["format"])
        except (OSError, ValueError, KeyError, IndexError, TypeError) as error:
            raise ResultError(f"{path} is no result of a Monte-Carlo ({error!r}); give another file") from None
        rows = {}
        for number, line in enumerate(lines[1:], start=2):
            if number == len(lines) and not line.endswith("\n"):
                break  # cut off while it was written
            try:
                run, judgement = _row(line)
            except (ValueError, KeyError, TypeError, AttributeError):
                raise ResultError(
                    f"{path}, line {number}: this is not what became of a run; remove the line, and the run is done again"
                ) from None
            rows[run] = judgement
        return cls(header, rows)

    def same_settings(self, header: Mapping[str, Any]) -> str:
        """Return the name of a setting that differs from another header's, the number of runs aside; empty if none does."""
        names = sorted((set(self.header) | set(header)) - {"runs"})
        plain = json.loads(header_line(header))
        mine = json.loads(header_line(self.header))
        return next((name for name in names if mine.get(name) != plain.get(name)), "")


def header_line(header: Mapping[str, Any]) -> str:
    """Return the first line of a file."""
    return json.dumps(dict(header), sort_keys=True) + "\n"


def row_line(run: int, judgement: Judgement) -> str:
    """Return the line of a run."""
    numbers = {name: value if math.isfinite(value) else None for name, value in sorted(judgement.metrics.items())}
    row = {"run": run, **judgement.__dict__, "metrics": numbers}
    return json.dumps(row) + "\n"


def _row(line: str) -> tuple[int, Judgement]:
    row = json.loads(line)
    numbers = {name: math.nan if value is None else float(value) for name, value in row.pop("metrics").items()}
    run = row.pop("run")
    if not isinstance(run, int) or row.get("outcome") not in OUTCOMES:
        raise ValueError(line)
    return run, Judgement(**row, metrics=numbers)
