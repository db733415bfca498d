"""The C structs of a block: as text for the header, and as NumPy dtypes for the views."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from typing import Any

import numpy as np

from ..symbolic.block import Block
from ..symbolic.errors import ModelError
from ..symbolic.program import Entry
from ..symbolic.signals import Kind, Signal
from .style import WIDTH, Precision, comment_lines, comment_safe


def dtype_of(signals: tuple[Signal, ...] | list[Signal], precision: Precision) -> np.dtype[Any]:
    """Return the aligned dtype of a struct with these fields; an empty struct has one unused byte."""
    fields: list[Any] = []
    for signal in signals:
        if signal.kind is Kind.GROUP:
            fields.append((signal.name, dtype_of(signal.members, precision)))
            continue
        base = {
            Kind.REAL: np.dtype(precision.dtype),
            Kind.FLAG: np.dtype(np.bool_),
            Kind.COUNT: np.dtype(np.uint32),
            Kind.STATUS: np.dtype(np.int32),
        }[signal.kind]
        fields.append((signal.name, base, (signal.size,)) if signal.size > 1 else (signal.name, base))
    return np.dtype(fields or [("unused", np.uint8)], align=True)


def memory_dtype(block: Block, precision: Precision) -> np.dtype[Any]:
    """Return the dtype of a block's memory struct."""
    return dtype_of(block.memory_group().members, precision)


def params_dtype(block: Block, precision: Precision) -> np.dtype[Any]:
    """Return the dtype of a block's parameter struct."""
    return dtype_of(block.param_group().members, precision)


def inputs_dtype(entry: Entry, precision: Precision) -> np.dtype[Any]:
    """Return the dtype of an entry's input struct."""
    return dtype_of(entry.inputs, precision)


def outputs_dtype(entry: Entry, precision: Precision) -> np.dtype[Any]:
    """Return the dtype of an entry's output struct."""
    return dtype_of(entry.outputs, precision)


def flatten(record: Any, prefix: str = "") -> dict[str, np.ndarray[Any, Any]]:
    """Return the fields of a record as name -> one-dimensional array; nested fields get dotted names."""
    answer: dict[str, np.ndarray[Any, Any]] = {}
    for name in record.dtype.names or ():
        value = record[name]
        if value.dtype.names:
            answer.update(flatten(value, f"{prefix}{name}."))
        elif not (name == "unused" and value.dtype == np.uint8):
            answer[prefix + name] = np.atleast_1d(np.asarray(value)).ravel()
    return answer


def fill(record: np.ndarray[Any, Any], values: Mapping[str, Any]) -> np.ndarray[Any, Any]:
    """Write (dotted) name -> value into a record and return it; conversions may overflow to infinity on purpose.

    Raises
    ------
    ModelError
        If there is no such field, or it is of another size.
    """
    with np.errstate(all="ignore"):
        for name, value in values.items():
            target = record
            *path, last = name.split(".")
            try:
                for piece in path:
                    target = target[piece]
                shape = target.dtype[last].shape
            except (KeyError, ValueError, IndexError, TypeError):
                has = ", ".join(_field_names(record.dtype)) or "none"
                raise ModelError(f"there is no field {name!r}; the fields are {has}") from None
            given = np.asarray(value)
            if given.size != math.prod(shape):
                raise ModelError(
                    f"{name!r} has {math.prod(shape)} elements, and {given.size} are given; give {math.prod(shape)}"
                )
            target[last] = given.reshape(shape)
    return record


def _field_names(dtype: np.dtype[Any]) -> list[str]:
    names = []
    for name in dtype.names or ():
        inner = _field_names(dtype[name])
        names += [f"{name}.{item}" for item in inner] if inner else [name]
    return names


def why_refused(block: Block, params: np.ndarray[Any, Any]) -> str:
    """Return which parameter `init` refuses, for a message.

    Parameters
    ----------
    block : Block
        Whose `init` refused.
    params : numpy record
        What it was given.
    """
    values = flatten(params)
    for signal in block.param_signals_flat():
        given = np.atleast_1d(values[signal.name])
        for k, (value, low, high) in enumerate(zip(given, signal.low, signal.high, strict=True)):
            if signal.kind is Kind.REAL and not low <= value <= high:
                name = signal.name if signal.size == 1 else f"{signal.name}[{k}]"
                return f"{name} is {value:.9g}, outside its range {low:.9g} .. {high:.9g}"
    return "each is within its range, but together they are not accepted"


def default_params(block: Block, precision: Precision) -> np.ndarray[Any, Any]:
    """Return a parameter record with every field at its default."""
    record = np.zeros((), dtype=params_dtype(block, precision))
    return fill(record, {signal.name: signal.default for signal in block.param_signals_flat()})


# ---------------------------------------------------------------------------------------------------------------------
# Text


def _number(value: float) -> str:
    if abs(abs(value) - math.pi) < 1e-12:
        return "pi" if value > 0 else "-pi"
    return re.sub(r"e([+-])0*", lambda match: "e" + match.group(1).replace("+", ""), f"{value:g}")


def range_text(signal: Signal) -> str:
    """Return a signal's range for a comment."""
    if signal.kind is not Kind.REAL or signal.high[0] >= 1e30:
        return ""
    if signal.angle and signal.uniform_range == (-3.15, 3.15):
        return "-pi .. pi"
    pairs = list(dict.fromkeys(zip(signal.low, signal.high, strict=True)))
    texts = [f"{_number(a)} .. {_number(b)}" for a, b in pairs[:3]]
    return "; ".join(texts) + ("; ..." if len(pairs) > 3 else "")


def struct_lines(
    signals: tuple[Signal, ...] | list[Signal], precision: Precision, types: Mapping[str, str]
) -> list[str]:
    """Return the fields of a struct, with unit, range and meaning in aligned comments.

    Parameters
    ----------
    signals : sequence of Signal
        The fields.
    precision : Precision
        Type of the real ones.
    types : dict
        Field name -> C type, for nested groups and statuses.
    """
    rows = []
    for signal in signals:
        base = {Kind.REAL: precision.name, Kind.FLAG: "bool", Kind.COUNT: "uint32_t"}.get(signal.kind)
        kind = base or types[signal.name]
        left = f"    {kind} {signal.name}" + (f"[{signal.size}];" if signal.size > 1 else ";")
        unit = f"[{signal.unit}]" if signal.unit else ""
        rows.append((left, comment_safe(signal.doc), comment_safe(unit), range_text(signal)))
    width = max((len(row[0]) for row in rows), default=0) + 2
    doc_width = min(max((len(row[1]) for row in rows), default=0), 50)
    unit_width = max((len(row[2]) for row in rows), default=0)
    lines = []
    for left, doc, unit, limits in rows:
        pieces = [doc.ljust(doc_width)]
        if unit_width:
            pieces.append(unit.ljust(unit_width))
        pieces.append(limits)
        note = "  ".join(pieces).rstrip()
        line = f"{left.ljust(width)}/* {note} */" if note else left
        if len(line) > WIDTH:
            short = "  ".join(item for item in (unit, limits) if item)
            lines += comment_lines(doc, "    ") if doc else []
            line = f"{left.ljust(width)}/* {short} */" if short else left
        lines.append(line)
    return lines


def default_text(signals: tuple[Signal, ...] | list[Signal], precision: Precision) -> str:
    """Return the initialiser of a parameter struct with every field at its default."""
    items = []
    for signal in signals:
        if signal.kind is Kind.GROUP:
            items.append(default_text(signal.members, precision))
            continue
        values = signal.default or (0.0,) * signal.size
        texts = [f"{int(v)}U" if signal.kind is Kind.COUNT else precision.literal(v) for v in values]
        items.append(texts[0] if signal.size == 1 else "{" + ", ".join(texts) + "}")
    return "{" + ", ".join(items) + "}"
