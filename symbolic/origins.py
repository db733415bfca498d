"""Where something was said: the line of the user's file, for the trace from model to C."""

from __future__ import annotations

import ast
import linecache
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from types import FrameType

_INSIDE = tuple(f"plantc.{name}" for name in ("symbolic", "codegen", "reference", "simulation"))


@dataclass(frozen=True)
class Origin:
    """What a piece of a program comes from.

    Attributes
    ----------
    kind : str
        ``dynamics``, ``sensor``, ``derivative``, ``noise``, ``equation`` ...
    text : str
        The equation, or what it is, in a line.
    sources : tuple of str
        Lines of the user's file, ``file.py:12``: a base name, never a path.
    """

    kind: str
    text: str
    sources: tuple[str, ...] = ()


_inherited: ContextVar[str | None] = ContextVar("_inherited", default=None)


@contextmanager
def said_at(source: str) -> Iterator[None]:
    """Have what is declared inside belong to this line: a copy belongs where the original was declared."""
    token = _inherited.set(source)
    try:
        yield
    finally:
        _inherited.reset(token)


def place_of_call() -> str:
    """Return ``file.py:line`` of the innermost call from outside plantc; empty where there is no file."""
    given = _inherited.get()
    if given is not None:
        return given
    frame = _outside()
    if frame is None or frame.f_code.co_filename.startswith("<"):
        return ""
    return f"{Path(frame.f_code.co_filename).name}:{frame.f_lineno}"


def places_of_items(count: int) -> list[str]:
    """Return ``file.py:line`` of each item of the dictionary that the call from outside plantc was given.

    Where it was not written as a literal in that call, every item has the line of the call.
    """
    whole = place_of_call()
    frame = _outside()
    if frame is None or not whole:
        return [whole] * count
    file = frame.f_code.co_filename
    for keys in _dictionaries(file).get(frame.f_lineno, []):
        if len(keys) == count:
            return [f"{Path(file).name}:{line}" for line in keys]
    return [whole] * count


def _outside() -> FrameType | None:
    frame: FrameType | None = sys._getframe(1)
    while frame is not None and str(frame.f_globals.get("__name__", "")).startswith(_INSIDE):
        frame = frame.f_back
    return frame


@lru_cache
def _dictionaries(file: str) -> dict[int, list[list[int]]]:
    """Return the lines of the keys of each dictionary that is an argument of a call, by the line of that call."""
    try:
        tree = ast.parse("".join(linecache.getlines(file)))
    except (SyntaxError, ValueError):
        return {}
    found: dict[int, list[list[int]]] = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.Call):
            # a call of an attribute in a chain has the line of the attribute's name
            name = node.func.end_lineno if isinstance(node.func, ast.Attribute) else None
            for argument in node.args:
                if isinstance(argument, ast.Dict) and all(key is not None for key in argument.keys):
                    lines = [key.lineno for key in argument.keys if key is not None]
                    for line in {node.lineno, name or node.lineno}:
                        found.setdefault(line, []).append(lines)
    return found
