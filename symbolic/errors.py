"""The one exception a user of the modelling layer meets, and how the kind of an argument is judged."""

from __future__ import annotations

import operator
from typing import Any

import numpy as np


class ModelError(ValueError):
    """A model that cannot be compiled as it stands.

    The message is one sentence: what was written, what was found, what to do.
    """


def expect(value: Any, kind: type | tuple[type, ...], what: str, wanted: str) -> None:
    """Refuse an argument of another kind than is wanted.

    Parameters
    ----------
    value : object
        What was given.
    kind : type or tuple of types
        What it has to be, or one of them.
    what : str
        The call and the argument, as the user wrote it.
    wanted : str
        What to give.

    Raises
    ------
    ModelError
        If it is of another kind.
    """
    if not isinstance(value, kind):
        raise ModelError(f"{what} is {_told(value)}; give {wanted}")


def whole(value: Any, what: str, lowest: int, highest: int | None = None) -> int:
    """Return a whole number, Python's or NumPy's.

    Raises
    ------
    ModelError
        If it is none, or out of its range.
    """
    try:
        number = operator.index(value)
    except TypeError:
        number = lowest - 1
    if number < lowest or (highest is not None and number > highest):
        upward = f"from {lowest} to {highest}" if highest is not None else f"of {lowest} or more"
        raise ModelError(f"{what} is {value!r}; give a whole number {upward}")
    return number


def yes_or_no(value: Any, what: str) -> bool:
    """Return a truth value, Python's or NumPy's.

    Raises
    ------
    ModelError
        If it is none: a pair of limits, say, would count as true.
    """
    if not isinstance(value, (bool, np.bool_)):
        raise ModelError(f"{what} is {value!r}; give True or False")
    return bool(value)


def _told(value: Any) -> str:
    kind, name, shown = type(value).__name__, getattr(value, "name", None), repr(value)
    if isinstance(name, str):
        return f"the {kind} {name!r}"
    return f"{shown}, of type {kind}" if len(shown) < 60 else f"of type {kind}"
