"""A recorded sequence of calls: inputs, and what a view answered."""

from __future__ import annotations

import csv
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..symbolic.signals import Kind, Status

if TYPE_CHECKING:
    from ..symbolic.block import Block


class TraceError(ValueError):
    """A log that cannot be replayed. The message names the file, the line or column, and the mend."""


@dataclass
class TraceCall:
    """One call: entry and inputs, and, once a view ran it, status, memory and outputs by field name.

    `time` is the log's own, in seconds, where there is one.
    """

    entry: str
    inputs: dict[str, Any]
    status: Status | None = None
    memory: dict[str, Any] = field(default_factory=dict)
    outputs: dict[str, Any] = field(default_factory=dict)
    time: float = float("nan")


@dataclass
class Trace:
    """A named sequence of calls."""

    name: str
    calls: list[TraceCall]

    def __len__(self) -> int:
        return len(self.calls)

    def column(self, name: str) -> Any:
        """Return a field of memory or outputs over the calls that have it, as an array (calls, elements).

        Raises
        ------
        KeyError
            If no call has it.
        """
        rows = [
            item.memory[name] if name in item.memory else item.outputs[name]
            for item in self.calls
            if name in item.memory or name in item.outputs
        ]
        if not rows:
            known = sorted({key for item in self.calls for key in (*item.memory, *item.outputs)})
            raise KeyError(f"the trace {self.name!r} has no field {name!r}; it has {', '.join(known) or 'none yet'}")
        array = np.array(rows)
        return array[:, 0] if array.ndim == 2 and array.shape[1] == 1 else array

    @property
    def statuses(self) -> list[Status | None]:
        """The status of each call."""
        return [item.status for item in self.calls]

    @property
    def times(self) -> Any:
        """The log's time of each call, in seconds."""
        return np.array([item.time for item in self.calls])

    @classmethod
    def from_csv(
        cls,
        path: str | Path,
        block: Block,
        *,
        columns: Mapping[str, str | Sequence[str]],
        entry: str = "step",
        time: str = "",
        new_only: Sequence[str] = (),
        scaled: Mapping[str, float] | None = None,
        unit_length: Sequence[str] = (),
    ) -> Trace:
        """Read a log with one row for each call.

        Parameters
        ----------
        path : path
            A CSV file with a header line.
        block : Block
            Whose entry is called.
        columns : dict
            Input name -> column, or a sequence of columns for a vector.
        entry : str
            The entry to call for each row.
        time : str, optional
            Column of time in seconds: gives `dt` (the first row, which has none, is left out).
        new_only : sequence of str
            Inputs whose flag is up only where their columns changed from the row before.
        scaled : dict, optional
            Input name -> factor, for units.
        unit_length : sequence of str
            Vectors to be scaled to length one.

        Returns
        -------
        Trace
            An input that is empty or NaN in a row is missing there: its ``has_<name>`` flag is down.

        Raises
        ------
        TraceError
            If the file, a column or an input does not exist, or a cell is no number.
        """
        if entry not in block.entries:
            raise TraceError(f"{block.name} has no entry {entry!r}; it has {', '.join(block.entries)}")
        signals = {signal.name: signal for signal in block.entries[entry].inputs}
        header, rows = _read(Path(path))
        wanted: dict[str, list[int]] = {}
        for name, given in columns.items():
            if name not in signals:
                raise TraceError(f"{block.name}_{entry} has no input {name!r}; it has {', '.join(signals)}")
            labels = [given] if isinstance(given, str) else list(given)
            if len(labels) != signals[name].size:
                raise TraceError(
                    f"the input {name!r} has {signals[name].size} elements, {len(labels)} columns are named"
                )
            wanted[name] = [_column(header, label, path) for label in labels]
        clock = _column(header, time, path) if time else -1
        flags = {name for name, signal in signals.items() if signal.kind is Kind.FLAG}
        missing = [
            name
            for name, signal in signals.items()
            if signal.kind is Kind.REAL
            and name not in wanted
            and f"has_{name}" not in flags
            and not (name == "dt" and time)
        ]
        if missing:
            raise TraceError(f"{path}: no column is named for the input(s) {', '.join(missing)}; add them to columns=")
        calls: list[TraceCall] = []
        for k, row in enumerate(rows):
            if clock >= 0 and k == 0:
                continue
            inputs: dict[str, Any] = {}
            for name, places in wanted.items():
                value = row[places] * (scaled or {}).get(name, 1.0)
                present = bool(np.all(np.isfinite(value)))
                if name in unit_length and present and np.linalg.norm(value) > 0:
                    value = value / np.linalg.norm(value)
                if f"has_{name}" in flags:
                    fresh = name not in new_only or bool(np.any(row[places] != rows[k - 1][places]))
                    inputs[f"has_{name}"] = present and fresh
                    value = value if present else np.zeros(len(places))
                inputs[name] = value if len(places) > 1 else float(value[0])
            if clock >= 0 and "dt" in signals:
                inputs["dt"] = float(row[clock] - rows[k - 1][clock])
            calls.append(TraceCall(entry, inputs, time=float(row[clock]) if clock >= 0 else float("nan")))
        return cls(Path(path).stem, calls)


def _column(header: list[str], label: str, path: str | Path) -> int:
    if label not in header:
        raise TraceError(f"{path}: there is no column {label!r}; it has {', '.join(header)}")
    return header.index(label)


def _read(path: Path) -> tuple[list[str], Any]:
    try:
        with path.open(newline="") as stream:
            reader = csv.reader(stream)
            header = [item.strip() for item in next(reader, [])]
            table = []
            for number, row in enumerate(reader, start=2):
                if not row:
                    continue
                if len(row) != len(header):
                    raise TraceError(
                        f"{path}, line {number}: {len(row)} cells for {len(header)} columns; mend the line"
                    )
                try:
                    table.append([float(cell) if cell.strip() else float("nan") for cell in row])
                except ValueError as error:
                    raise TraceError(f"{path}, line {number}: {error}; every cell must be a number or empty") from None
    except OSError as error:
        raise TraceError(f"{path}: cannot be read ({error.strerror}); give the path of a CSV file") from None
    if not header or not table:
        raise TraceError(f"{path}: it has no rows; give a CSV file with a header line and data")
    return header, np.array(table)
