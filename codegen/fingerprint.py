"""A hash of a block with everything that its checks look at: expressions, ranges, bounds, oracle and scenario.

Code counts only where it is plantc's own (its sources are hashed elsewhere): then what it was made with, its closure, is
hashed. Code of a user's own could read a file or the clock, so no hash of it says what it will do.
"""

from __future__ import annotations

import enum
import functools
import hashlib
import types
from typing import Any

import casadi as ca
import numpy as np

from ..symbolic.block import Block

NOT_LOOKED_AT = ("design", "tables", "_owners")
"""Attributes on which no cached answer depends: an export with tables is never cached; owners are told by address."""

_PLAIN = (bool, int, float, complex, str, bytes, type(None), type(Ellipsis))


class UnknowableError(Exception):
    """Something of which no hash can be made."""


def fingerprint(block: Block) -> str | None:
    """Return a hash of all that a block holds, or None where it holds code or objects that are not plantc's own.

    Parameters
    ----------
    block : Block
        Any block; its parts, oracle and scenario are followed.
    """
    walk = _Walk()
    try:
        walk.add(block)
    except UnknowableError:
        return None
    return walk.digest.hexdigest()


class _Walk:
    """One walk through an object; the same object met again is told by its number."""

    def __init__(self) -> None:
        self.digest = hashlib.sha256()
        self.met: dict[int, int] = {}
        self.alive: list[Any] = []  # an identity is one only while its object lives
        self.symbols: dict[int, int] = {}

    def say(self, *words: Any) -> None:
        """Feed words, each with its length, so that no two sequences read alike."""
        for word in words:
            text = str(word).encode()
            self.digest.update(f"{len(text)}:".encode() + text)

    def add(self, item: Any) -> None:
        """Feed an object and what it holds."""
        kind = type(item)
        if isinstance(item, enum.Enum):
            self.say(_own_name(kind), item.name)
        elif kind in _PLAIN or isinstance(item, (np.generic, np.dtype)):
            self.say(kind.__name__, repr(item))
        elif id(item) in self.met:
            self.say("again", self.met[id(item)])
        else:
            self.met[id(item)] = len(self.met)
            self.alive.append(item)
            self._add_first(item, kind)

    def _add_first(self, item: Any, kind: type) -> None:
        if isinstance(item, np.ndarray) and item.dtype != object:
            self.say("array", item.dtype.descr, item.shape, item.tobytes().hex())
        elif kind in (list, tuple):
            self._add_all(kind.__name__, item)
        elif kind in (set, frozenset) and all(type(part) in _PLAIN for part in item):
            self.say("set", sorted(map(repr, item)))
        elif kind is slice:
            self._add_all("slice", (item.start, item.stop, item.step))
        elif kind in (dict, types.MappingProxyType):
            self._add_all("dict", [part for pair in item.items() for part in pair])
        elif isinstance(item, (ca.SX, ca.DM, ca.Function, ca.Sparsity)):
            self._add_casadi(item, kind)
        elif isinstance(item, type):
            self.say("class", _own_name(item))
        elif isinstance(item, types.FunctionType):
            self._add_function(item)
        elif isinstance(item, types.MethodType):
            self.say("method")
            self._add_all("bound", [item.__self__, item.__func__])
        elif isinstance(item, functools.partial):
            self._add_all("partial", [item.func, item.args, item.keywords])
        else:
            self._add_object(item, kind)

    def _add_all(self, word: str, items: Any) -> None:
        self.say(word, len(items))
        for part in items:
            self.add(part)

    def _add_casadi(self, item: Any, kind: type) -> None:
        self.say(kind.__name__, item.serialize())
        if isinstance(item, ca.SX):  # two symbols may have one name
            free = [self.symbols.setdefault(part.element_hash(), len(self.symbols)) for part in ca.symvar(item)]
            self.say(*free)
        if kind.__module__.startswith("plantc."):
            self._add_all(_own_name(kind), [getattr(item, "signal", None)])

    def _add_function(self, item: types.FunctionType) -> None:
        self.say("function", _own_name(item))
        self._add_code(item.__code__)
        cells = [cell.cell_contents for cell in item.__closure__ or ()]
        self._add_all("made with", [item.__defaults__, item.__kwdefaults__, *cells])

    def _add_code(self, code: types.CodeType) -> None:
        """Feed bytecode: functions written at run time have no source that is hashed elsewhere."""
        self.say("code", code.co_code.hex(), code.co_names, code.co_varnames, code.co_freevars)
        for part in code.co_consts:
            if isinstance(part, types.CodeType):
                self._add_code(part)
            else:
                self.say(sorted(map(repr, part)) if isinstance(part, frozenset) else repr(part))

    def _add_object(self, item: Any, kind: type) -> None:
        if not kind.__module__.startswith("plantc."):
            raise UnknowableError(f"an object of {kind.__module__}.{kind.__qualname__}")
        self.say("object", _own_name(kind))
        held = dict(getattr(item, "__dict__", {}))
        for base in kind.__mro__:
            held |= {name: getattr(item, name) for name in getattr(base, "__slots__", ()) if hasattr(item, name)}
        held = {
            name: value
            for name, value in held.items()
            if name not in NOT_LOOKED_AT and not isinstance(getattr(kind, name, None), functools.cached_property)
        }
        self._add_all("holds", [part for pair in sorted(held.items()) for part in pair])


def _own_name(thing: Any) -> str:
    """Return the full name of a class or a function of plantc.

    Raises
    ------
    UnknowableError
        If it is someone else's.
    """
    module = thing.__module__ or ""
    known = module.startswith("plantc.") or (
        isinstance(thing, type) and module in ("builtins", "numpy", "casadi.casadi")
    )
    if not known:
        raise UnknowableError(f"{module}.{thing.__qualname__}")
    return f"{module}.{thing.__qualname__}"
