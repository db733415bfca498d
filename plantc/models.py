"""Loading what a user wrote: the plants, blocks and operating points at the top level of a file."""

from __future__ import annotations

import linecache
import runpy
import sys
import traceback
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from .symbolic import Block, ModelError, Plant


class UsageError(Exception):
    """Something the user must mend; exit status 2."""


def load(model: str) -> tuple[dict[str, Any], str, Path]:
    """Run a model file and return its names, the name asked for (or an empty string), and the path.

    Parameters
    ----------
    model : str
        ``file.py`` or ``file.py:name``.

    Raises
    ------
    UsageError
        If there is no such file, or it fails: with file and line.
    """
    text, _, name = model.partition(".py:")
    path = Path(f"{text}.py" if name else model)
    if not path.is_file():
        raise UsageError(f"{path}: there is no such file; give MODEL as file.py or file.py:name")
    linecache.checkcache()
    sys.path.insert(0, str(path.resolve().parent))
    try:
        names = runpy.run_path(str(path))
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # a model may raise anything
        raise UsageError(_where(path, error)) from error
    finally:
        sys.path.pop(0)
    return names, name, path


def _where(path: Path, error: BaseException) -> str:
    """Return file and line of an exception in a model, and what it says."""
    line = 0
    for frame in traceback.extract_tb(error.__traceback__):
        if Path(frame.filename).resolve() == path.resolve():
            line = frame.lineno or 0
    if isinstance(error, SyntaxError):
        line = error.lineno or 0
    if "truth value" in str(error):
        what = "a symbolic expression was asked whether it is true (by if, and, or, max() ...)"
        return f"{path}, line {line}: {what}; use if_else, fmin or fmax of plantc.symbolic"
    kind = "" if isinstance(error, ModelError) else f"{type(error).__name__}: "
    return f"{path}, line {line}: {kind}{error}"


def blocks_of(model: str) -> tuple[list[Block], Path]:
    """Return the blocks of a model, or the one asked for."""
    names, name, path = load(model)
    blocks = _of_kind(names, Block)
    if name:
        if not isinstance(names.get(name), Block):
            raise UsageError(f"{path}: {name!r} is not a block; it has {_listed(blocks)}")
        return [names[name]], path
    if not blocks:
        raise UsageError(
            f"{path}: there is no block at its top level; make one, say ekf = extended_kalman_filter(plant.discretise(...), ...)"
        )
    return list(blocks.values()), path


def plants_of(model: str) -> tuple[list[tuple[str, Plant]], dict[str, Any], Path]:
    """Return the plants of a model (or the one asked for), and all names of the file."""
    names, name, path = load(model)
    plants = _of_kind(names, Plant)
    if name:
        if not isinstance(names.get(name), Plant):
            raise UsageError(f"{path}: {name!r} is not a plant; it has {_listed(plants)}")
        return [(name, names[name])], names, path
    if not plants:
        raise UsageError(f"{path}: there is no plant at its top level; make one with Plant(...)")
    return list(plants.items()), names, path


def operating_point(text: str, plant: Plant, names: Mapping[str, Any], path: Path) -> dict[str, Any]:
    """Return state or input -> value for ``--at``: a name in the file, or ``x=1,u=2``."""
    if "=" not in text:
        found = names.get(text)
        if not isinstance(found, Mapping):
            raise UsageError(f"{path}: --at {text}: the file has no operating point of that name; give one, or x=1,u=2")
        return {key if isinstance(key, str) else key.signal.name: value for key, value in found.items()}
    known = {s.signal.name for s in plant.states} | {s.signal.name for s in (*plant.inputs, *plant.parameters)}
    values: dict[str, Any] = {}
    for part in text.split(","):
        key, _, value = part.partition("=")
        key = key.strip()
        if key not in known:
            raise UsageError(
                f"--at: {plant.name} has no state, input or parameter {key!r}; it has {', '.join(sorted(known))}"
            )
        try:
            values[key] = float(value)
        except ValueError:
            raise UsageError(f"--at: {value!r} is not a number; write {key}=1.5") from None
    return values


def _of_kind(names: Mapping[str, Any], kind: type) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for key, value in names.items():
        if isinstance(value, kind) and not any(value is other for other in found.values()):
            found[key] = value
    return found


def _listed(found: Mapping[str, Any]) -> str:
    return ", ".join(found) or "none"
