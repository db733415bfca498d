"""How numbers, names and long lines are written in the generated C."""

from __future__ import annotations

import math
import textwrap
import unicodedata
from dataclasses import dataclass

import numpy as np

from ..symbolic.errors import ModelError

WIDTH = 120

LOSS = 1e-4
"""Relative error of a literal beyond which it is refused: below 1.2e-38 single precision runs out of digits."""

_BIDIRECTIONAL = frozenset("\u061c\u200e\u200f\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069")
"""Characters that change the order in which text is shown: what a reviewer reads is not what a compiler reads."""


@dataclass(frozen=True)
class Precision:
    """Single or double: the C type, literals and the functions of <math.h>."""

    name: str

    def __post_init__(self) -> None:
        if self.name not in ("float", "double"):
            raise ValueError(f"the precision {self.name!r} is not known; take 'float' or 'double'")

    @property
    def is_float(self) -> bool:
        """Whether it is single."""
        return self.name == "float"

    @property
    def dtype(self) -> type[np.floating]:
        """The NumPy scalar type."""
        return np.float32 if self.is_float else np.float64

    def literal(self, value: float) -> str:
        """Return the shortest literal that reads back as `value` in this precision."""
        if self.is_float:
            with np.errstate(over="ignore"):
                single = np.float32(value)
            if not np.isfinite(single):
                raise OverflowError(f"the number {value!r} does not fit into single precision")
            if abs(float(single) - value) > LOSS * abs(value):
                raise OverflowError(
                    f"the number {value!r} is too small for single precision, where it would become {float(single):.2g}"
                )
            text = np.format_float_scientific(single, unique=True, trim="0")
            text = _plain(text, float(single))
            return f"{text}f"
        if not math.isfinite(value):
            raise OverflowError(f"the number {value!r} cannot be written as a literal")
        return _plain(np.format_float_scientific(value, unique=True, trim="0"), value)

    def function(self, name: str) -> str:
        """Return the <math.h> function of this precision."""
        return f"{name}f" if self.is_float else name


def _plain(scientific: str, value: float) -> str:
    """Turn 1.25e+02 into 125.0 where that is short."""
    mantissa, _, exponent = scientific.partition("e")
    power = int(exponent)
    if value == 0:
        return "0.0" if math.copysign(1.0, value) > 0 else "-0.0"
    digits = mantissa.lstrip("-").replace(".", "").rstrip("0") or "0"
    sign = "-" if mantissa.startswith("-") else ""
    if -5 <= power < 0:
        return f"{sign}0.{'0' * (-power - 1)}{digits}"
    if 0 <= power < 7:
        whole = digits[: power + 1].ljust(power + 1, "0")
        rest = digits[power + 1 :] or "0"
        return f"{sign}{whole}.{rest}"
    return f"{sign}{digits[0]}.{digits[1:] or '0'}e{power}"


def wrap_line(text: str, indent: str, joint: str = " ", hanging: str = "    ") -> list[str]:
    """Break a long line of C at spaces, outside strings, continuing with a deeper indent."""
    lines: list[str] = []
    current = indent
    for word in text.split(joint):
        candidate = current + ("" if current.isspace() or not current else joint) + word
        if len(candidate) > WIDTH and not current.isspace() and current:
            lines.append(current.rstrip())
            current = indent + hanging + word
        else:
            current = candidate
    lines.append(current.rstrip())
    return lines


def comment_safe(text: str) -> str:
    """Return text that neither ends a comment nor starts another, on one line.

    Raises
    ------
    ModelError
        If it holds a character that hides or reorders text.
    """
    line = " ".join(text.replace("*/", "* /").replace("/*", "/ *").split())
    for character in line:
        if character in _BIDIRECTIONAL or unicodedata.category(character) in ("Cc", "Cs"):
            raise ModelError(
                f"the text {line[:60]!r} holds the control character U+{ord(character):04X}, which shows other text than a "
                "compiler reads; take it out of the doc or the unit"
            )
    return line


def comment_lines(text: str, indent: str) -> list[str]:
    """Return a comment, broken into lines of its own where it is long."""
    clean = comment_safe(text)
    whole = f"{indent}/* {clean} */"
    if len(whole) <= WIDTH:
        return [whole]
    lines = textwrap.wrap(clean, WIDTH - len(indent) - 6)
    lines = [f"{indent} * {line}" for line in lines]
    lines[0] = indent + "/* " + lines[0].strip().removeprefix("* ")
    lines[-1] += " */"
    return lines
