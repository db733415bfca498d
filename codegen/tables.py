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

    numbers: dict[Table, int] = field(default_factory=dict)
    functions: set[str] = field(default_factory=set)

    def call(self, root: str, operation: str, table: Table, x: str, precision: Precision) -> str:
        """Return the C of a look-up, or of the slope there."""
        number = self.numbers.setdefault(table, len(self.numbers) + 1)
        function = f"{operation}_even" if table.per_unit else operation
        self.functions.add(function)
        even = f"{precision.literal(table.per_unit)}, " if table.per_unit else ""
        return f"{root}_math_{function}({root}_table_{number}, {table.last}U, {even}{x})"

    def text(self, root: str, precision: Precision) -> str:
        """Return the C: arrays and functions; nothing where there is no table.

        Raises
        ------
        ModelError
            If two breakpoints are one number in the precision.
        """
        from .emit import templates

        if not self.numbers:
            return ""
        for table in self.numbers:
            rounded = [precision.dtype(item) for item in table.at]
            for k in range(table.last):
                if not rounded[k] < rounded[k + 1]:
                    raise ModelError(
                        f"{root}: the breakpoints {table.at[k]!r} and {table.at[k + 1]!r} of a table are one number in "
                        f"{precision.name}; move them apart, or export in double"
                    )
        made = [
            (
                f"{root}_table_{number}",
                f"Table {number}: {len(table.at)} points over {table.at[0]:.12g} .. {table.at[-1]:.12g}.",
                list(zip(table.at, table.values, table.slopes, strict=True)),
            )
            for table, number in self.numbers.items()
        ]
        uneven = [table for table in self.numbers if not table.per_unit]
        context: dict[str, Any] = {
            "p": root,
            "real": precision.name,
            "c": precision.literal,
            "tables": made,
            "even": len(uneven) < len(self.numbers),
            "uneven": bool(uneven),
            "turns": max((table.last for table in uneven), default=1).bit_length(),
            "needed": self.functions.__contains__,
        }
        text = templates().get_template("look_up.c.j2").render(**context)
        return "\n".join(line for long in text.split("\n") for line in _narrow(long))


def _narrow(line: str) -> list[str]:
    """Break a line that a long prefix made too wide."""
    indent = line[: len(line) - len(line.lstrip())]
    return [line] if len(line) <= WIDTH else wrap_line(line.strip(), indent)
