"""Tables that a block looks up in: constant arrays and the functions that search them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..symbolic.errors import ModelError
from .style import WIDTH, Precision, wrap_line

MOST_UNEVEN = 0.01
"""How far a breakpoint may be from its place in an even spacing, in pieces: rounding leads at most one point astray."""


@dataclass(frozen=True)
class Table:
    """Breakpoints, strictly increasing, and the values there."""

    at: tuple[float, ...]
    values: tuple[float, ...]

    @property
    def last(self) -> int:
        """Position of the last point."""
        return len(self.at) - 1

    @property
    def slopes(self) -> tuple[float, ...]:
        """Slope from each point to the next; 0 from the last."""
        pieces = (np.diff(self.values) / np.diff(self.at)).tolist()
        return (*pieces, 0.0)

    @property
    def per_unit(self) -> float:
        """Points to a unit, where they are evenly spaced; else 0."""
        step = (self.at[-1] - self.at[0]) / self.last
        even = self.at[0] + step * np.arange(len(self.at))
        return 1.0 / step if np.all(np.abs(np.array(self.at) - even) <= MOST_UNEVEN * step) else 0.0

    def rounding(self, unit: float) -> float:
        """Return a bound of what looking up loses, in numbers whose unit roundoff is given.

        Rounded are breakpoints, values and slopes, the difference from the breakpoint, the product and the sum; and a
        rounded breakpoint may lead to the piece beside the right one.
        """
        reach, value = np.max(np.abs(self.at)), np.max(np.abs(self.values))
        slope, piece = np.max(np.abs(self.slopes)), np.max(np.diff(self.at))
        return float(1.01 * unit * (2 * value + 8 * slope * piece + 3 * slope * reach))


def table_of(arguments: Sequence[Any]) -> Table:
    """Return the table in the arguments of a look-up: x, the breakpoints, and the values, all constants but x."""
    numbers = [item.value for item in arguments[1:]]
    half = len(numbers) // 2
    return Table(tuple(numbers[:half]), tuple(numbers[half:]))


@dataclass
class Tables:
    """The tables of one C file, numbered as they are met, and which functions on them it calls."""

    uses: dict[Table, set[str]] = field(default_factory=dict)

    def call(self, root: str, operation: str, table: Table, x: str) -> str:
        """Return the C of a look-up, or of the slope there."""
        self.uses.setdefault(table, set()).add(operation)
        end = "_slope" if operation == "look_up_slope" else ""
        return f"{root}_math_table_{list(self.uses).index(table) + 1}{end}({x})"

    def text(self, root: str, precision: Precision) -> str:
        """Return the C: arrays and functions; nothing where there is no table.

        Raises
        ------
        ModelError
            If two breakpoints are one number in the precision.
        """
        from .emit import templates

        if not self.uses:
            return ""
        for table in self.uses:
            _check(root, table, precision)
        uneven = [table for table in self.uses if not table.per_unit]
        context: dict[str, Any] = {
            "p": root,
            "real": precision.name,
            "c": precision.literal,
            "tables": [
                {
                    "number": number,
                    "sentence": f"{len(table.at)} points over {table.at[0]:.12g} .. {table.at[-1]:.12g}",
                    "points": list(zip(table.at, table.values, table.slopes, strict=True)),
                    "per_unit": table.per_unit,
                    "uses": uses,
                }
                for number, (table, uses) in enumerate(self.uses.items(), start=1)
            ],
            "even": len(uneven) < len(self.uses),
            "uneven": bool(uneven),
            "turns": max((table.last for table in uneven), default=1).bit_length(),
            "needed": {
                use + ("_even" if table.per_unit else "") for table, uses in self.uses.items() for use in uses
            }.__contains__,
        }
        text = templates().get_template("look_up.c.j2").render(**context)
        return "\n".join(line for long in text.split("\n") for line in _narrow(long))


def _check(root: str, table: Table, precision: Precision) -> None:
    rounded = [precision.dtype(item) for item in table.at]
    for k in range(table.last):
        if not rounded[k] < rounded[k + 1]:
            raise ModelError(
                f"{root}: the breakpoints {table.at[k]!r} and {table.at[k + 1]!r} of a table are one number in "
                f"{precision.name}; move them apart, or export in double"
            )


def _narrow(line: str) -> list[str]:
    """Break a line that a long prefix made too wide."""
    indent = line[: len(line) - len(line.lstrip())]
    return [line] if len(line) <= WIDTH else wrap_line(line.strip(), indent)
