"""The Block: a discrete-time component with memory, parameters and entries. The only thing that can be exported."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal, Protocol

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from .errors import ModelError
from .expressions import equation_text
from .names import check_name, check_unique
from .origins import Origin, place_of_call
from .plant import Symbol
from .program import (
    AllOf,
    AnyOf,
    Assign,
    Call,
    Compare,
    Condition,
    Element,
    Entry,
    Evaluate,
    IsSet,
    Operand,
    Place,
    Raise,
    Refuse,
    Statement,
    When,
    Within,
    walk,
)
from .signals import WIDE, Kind, Signal, Status, check_default, make_range, spread

Record = NDArray[np.void]

FREE = 1.0e30
"""Magnitude up to which an output may be before it is held at its limits."""


class Oracle(Protocol):
    """An independent NumPy implementation of a block; it works in the precision of the arrays it is given."""

    def call(
        self,
        entry: str,
        memory: Mapping[str, Any],
        inputs: Mapping[str, Any],
        params: Mapping[str, Any],
        precision: type,
    ) -> tuple[int, dict[str, Any], dict[str, Any]]:
        """Return (status, memory, outputs), keyed by (dotted) field name."""
        ...


@dataclass(frozen=True)
class DerivativeCheck:
    """A derivative of ours beside a function to differentiate: `ours(*points)` against d `function`/d argument."""

    name: str
    ours: Callable[[Mapping[str, Any]], NDArray[Any]]
    complex_step: Callable[[Mapping[str, Any]], NDArray[Any]]
    differences: Callable[[Mapping[str, Any]], NDArray[Any]]
    kinks: tuple[str, ...] = ()


@dataclass(frozen=True)
class Design:
    """Numbers that a solver designed (they differ in their last bits between machines).

    Attributes
    ----------
    values : dict
        Name -> array, rounded to 9 digits.
    source : str
        Hash of what they were made from.
    rebuild : callable
        Values -> the Block with these numbers.
    properties : callable
        Values -> residuals by name, each to be below its limit: what `check` compares instead of digits.
    """

    values: dict[str, Any]
    source: str
    rebuild: Callable[[dict[str, Any]], Block]
    properties: Callable[[dict[str, Any]], dict[str, tuple[float, float]]]


@dataclass(frozen=True)
class _Held:
    """Locals by name (outputs before they are held at their limits, limits), and the statements that say so."""

    free: dict[str, ca.SX]
    statements: list[Statement]


@dataclass
class Scenario:
    """How to exercise a block in a way that makes sense: calls, memories, and the natural size of each field.

    Attributes
    ----------
    calls : callable
        (random generator, number of steps) -> iterator of (entry, inputs), a plausible sequence.
    memory : callable
        Random generator -> a plausible memory, as field -> array.
    scales : callable
        Memory -> field -> natural size of an error (sigma), or None if it is not known.
    gaps : str
        Name of the input that is the time step, for traces with long gaps.
    scaled : callable
        (memory, factor) -> fields of a memory that is as uncertain times the factor, or None if it has no covariance.
    """

    calls: Callable[[np.random.Generator, int], Iterator[tuple[str, dict[str, Any]]]]
    memory: Callable[[np.random.Generator], dict[str, Any]]
    scales: Callable[[Mapping[str, Any]], dict[str, Any]] | None = None
    gaps: str = ""
    scaled: Callable[[Mapping[str, Any], float], dict[str, Any]] | None = None


@dataclass(frozen=True)
class Table:
    """What was measured of a block on demand, for the evidence and the report of its export.

    Attributes
    ----------
    caption : str
        What the table shows.
    columns : tuple of str
        Heads, with units.
    rows : list of tuple
        Cells: text, or finite numbers.
    note : str
        How it was measured.
    """

    caption: str
    columns: tuple[str, ...]
    rows: list[tuple[str | int | float, ...]]
    note: str = ""

    def __post_init__(self) -> None:
        for row in self.rows:
            if len(row) != len(self.columns):
                raise ModelError(
                    f"table {self.caption!r}: a row has {len(row)} cells, there are {len(self.columns)} columns; give one each"
                )
            if any(isinstance(cell, float) and not np.isfinite(cell) for cell in row):
                raise ModelError(f"table {self.caption!r}: a cell is not finite; say so in words")


class Block:
    """A discrete-time component: parameters, memory, and entries.

    Estimators and controllers are made by functions that return a Block; a user's own is built by names.

    Parameters
    ----------
    name : str
        C identifier; prefix of everything in the generated files.
    doc : str
        Its meaning; travels to the C header.

    Examples
    --------
    >>> from plantc.symbolic import Block
    >>> low_pass = Block("low_pass", doc="first-order low-pass filter")
    >>> raw = low_pass.input("raw", unit="V", range=(-10, 10))
    >>> weight = low_pass.parameter("weight", 0.1, range=(0, 1))
    >>> smooth = low_pass.memory("smooth", initial=0.0, unit="V", range=(-10, 10))
    >>> following = smooth + weight * (raw - smooth)
    >>> low_pass.entry("step", inputs=[raw], following={smooth: following}, outputs={"filtered": following})
    >>> [entry.name for entry in low_pass.entries.values()]
    ['init', 'step']
    """

    def __init__(self, name: str, *, doc: str = ""):
        self.name = check_name("block", name, "Block")
        self.doc = doc
        self.memory_signals: list[Signal] = []
        self.param_signals: list[Signal] = []
        self.entries: dict[str, Entry] = {}
        self.parts: dict[str, Block] = {}
        self.equations: list[str] = []
        self.notes: list[str] = []
        self.oracle: Oracle | None = None
        self.scenario: Scenario | None = None
        self.derivative_checks: list[DerivativeCheck] = []
        self.design: Design | None = None
        self.tables: dict[str, Callable[[], Table]] = {}  # title -> what an export measures where it is asked to
        self.float_bound = 0.05
        self.simulation_only = ""  # why it cannot be exported, if it cannot
        self.sample_time: float | None = None
        self.source_hash = ""
        self.source = place_of_call()
        self._inputs: dict[str, Symbol] = {}
        self._symbols: list[Symbol] = []

    # -- building one's own -------------------------------------------------------------------------------------------

    def parameter(
        self, name: str, default: Any, *, unit: str = "", range: tuple[Any, Any] | None = None, doc: str = ""
    ) -> Symbol:
        """Declare a run-time parameter, checked by `init` (BAD_PARAM outside its range)."""
        size = int(np.size(default))
        check_name("parameter", name, self.name)
        low, high = make_range(self.name, f"parameter {name!r}", range, (-WIDE, WIDE), size)
        values = check_default(self.name, f"parameter {name!r}", default, low, high)
        signal = Signal(name, size, unit, low, high, doc, default=values, source=place_of_call())
        self.param_signals.append(signal)
        return self._own(signal)

    def input(
        self, name: str, *, size: int = 1, unit: str = "", range: tuple[Any, Any] | None = None, doc: str = ""
    ) -> Symbol:
        """Declare an input; entries list the ones they take. Outside its range a call is refused (BAD_INPUT)."""
        check_name("input", name, self.name)
        low, high = make_range(self.name, f"input {name!r}", range, (-WIDE, WIDE), size)
        symbol = self._own(Signal(name, size, unit, low, high, doc, source=place_of_call()))
        self._inputs[name] = symbol
        return symbol

    def memory(
        self, name: str, *, initial: Any = 0.0, unit: str = "", range: tuple[Any, Any] | None = None, doc: str = ""
    ) -> Symbol:
        """Declare a field of the memory; its initial value is a parameter ``<name>_0``. Outside: OVERFLOW."""
        size = int(np.size(initial))
        check_name("memory field", name, self.name)
        low, high = make_range(self.name, f"memory field {name!r}", range, (-WIDE, WIDE), size)
        values = check_default(self.name, f"memory field {name!r}", initial, low, high)
        signal = Signal(name, size, unit, low, high, doc, source=place_of_call())
        self.memory_signals.append(signal)
        self.param_signals.append(replace(signal, name=f"{name}_0", default=values, doc=f"initial {name}"))
        return self._own(signal)

    def entry(
        self,
        name: str,
        *,
        inputs: Sequence[Symbol] = (),
        following: Mapping[Symbol, Any] | None = None,
        outputs: Mapping[str, Any] | None = None,
        output_units: Mapping[str, str] | None = None,
        output_ranges: Mapping[str, tuple[Any, Any]] | None = None,
        output_docs: Mapping[str, str] | None = None,
        limits: Mapping[str, tuple[Any, Any]] | None = None,
        guards: Sequence[tuple[Any, Status]] = (),
        doc: str = "",
    ) -> None:
        """Add an entry given by expressions.

        Parameters
        ----------
        name : str
            Its name; the C function is ``<block>_<name>``.
        inputs : sequence of Symbol
            Declared inputs that it takes.
        following : dict
            Memory field -> its next value; fields left out stay.
        outputs : dict
            Name -> expression.
        output_units : dict, optional
            Name -> unit.
        output_ranges : dict, optional
            Output name -> (low, high); outside it the call is refused (OVERFLOW). Default -1e6 .. 1e6.
        output_docs : dict, optional
            Output name -> its meaning.
        limits : dict, optional
            Output name -> (low, high), each a number (or one for each element), a parameter, an expression, or None for no
            limit on that side: the output is held between them, and where that changes it the status is CLAMPED. What is
            not a number is refused (OVERFLOW).
        guards : sequence of (expression, Status)
            Where an expression is zero (false), the call is refused with the (negative) status, in this order.
        doc : str
            Its meaning.
        """
        self._check_entry(name, inputs, guards)
        update = {
            symbol.signal.name: self._expression(value, symbol.signal.size)
            for symbol, value in (following or {}).items()
        }
        unknown = set(update) - {item.name for item in self.memory_signals}
        if unknown:
            raise ModelError(f"{self.name}: {sorted(unknown)} are no memory fields; declare them with memory()")
        answers = {
            check_name("output", key, self.name): self._expression(value) for key, value in (outputs or {}).items()
        }
        signals = []
        for key, value in answers.items():
            low, high = make_range(
                self.name, f"output {key!r}", (output_ranges or {}).get(key), (-WIDE, WIDE), value.numel()
            )
            unit, meaning = ((given or {}).get(key, "") for given in (output_units, output_docs))
            signals.append(Signal(key, value.numel(), unit, low, high, meaning))
        held = self._held(answers, limits or {})
        used = [*self.param_symbols(), *self.memory_symbols(), *inputs]
        conditions = [self._expression(value, 1) for value, _ in guards]
        function = ca.Function(
            f"{self.name}_{name}",
            used,
            [ca.densify(item) for item in [*conditions, *update.values(), *held.free.values(), *answers.values()]],
            {"allow_free": True},
        )
        if function.get_free():
            raise ModelError(
                f"{self.name}: the entry {name!r} uses {function.get_free()}, which it does not take; list them"
            )
        reads = tuple(((self._place(symbol), symbol.signal.size),) for symbol in used)
        guard_places = [Place("local", f"guard_{index}") for index in range(len(conditions))]
        targets = [
            *[(place, 1) for place in guard_places],
            *[(Place("next", key), value.numel()) for key, value in update.items()],
            *[(Place("local", key), value.numel()) for key, value in held.free.items()],
            *[(Place("out", key), value.numel()) for key, value in answers.items()],
        ]
        names = tuple(tuple(f"{place.name}_{i}" for i in range(size)) for place, size in targets)
        said = tuple(item for item in (place_of_call(),) if item)
        origins: list[tuple[Origin, ...]] = [
            (Origin("guard", f"guard: {status.name} where it is false", said),) for _, status in guards
        ]
        lines = self._lines(update, held.free, answers, used)
        origins += [tuple(Origin("equation", line, said) for line in own) for own in lines]
        text = [line for own in lines for line in own]
        self.equations += [f"{name}: {line}" for line in text]
        body: list[Statement] = [
            Evaluate(
                function, reads, tuple(((place, size),) for place, size in targets), names, tuple(text), tuple(origins)
            )
        ]
        for place, (_, status) in zip(guard_places, guards, strict=True):
            body.append(Refuse(status, IsSet(Element(place))))
        body += held.statements
        body += [
            Refuse(Status.OVERFLOW, Within(Place("out", signal.name), signal.low, signal.high)) for signal in signals
        ]
        body.append(Refuse(Status.OVERFLOW, self.judge_memory(list(update))))
        taken = tuple(symbol.signal for symbol in inputs)
        self.entries[name] = Entry(name, taken, tuple(signals), tuple(body), doc, sources=said)
        self.check()

    def _check_entry(self, name: str, inputs: Sequence[Symbol], guards: Sequence[tuple[Any, Status]]) -> None:
        """Raise a ModelError where an entry cannot be added; the first one brings `init`."""
        if self._inputs.keys() & {item.name for item in self.memory_signals}:
            raise ModelError(f"{self.name}: an input and a memory field share a name; rename one of them")
        if not self.entries:
            self.entries["init"] = self._plain_init()
        check_name("entry", name, self.name)
        if name in self.entries:
            raise ModelError(f"{self.name}: the entry {name!r} is defined twice; rename one of them")
        for symbol in inputs:
            if self._inputs.get(symbol.signal.name) is not symbol:
                raise ModelError(
                    f"{self.name}: {symbol.signal.name!r} is not an input of this block; declare it with input()"
                )
        for _, status in guards:
            if status >= 0:
                raise ModelError(f"{self.name}: a guard of {name!r} has the status {status.name}; give a negative one")

    def _lines(
        self, update: dict[str, ca.SX], free: dict[str, ca.SX], answers: dict[str, ca.SX], used: list[Symbol]
    ) -> list[list[str]]:
        """Return the equations of what an entry evaluates, as text: for each value a line for each element."""
        pairs = [(ca.SX(symbol), self._spoken(symbol)) for symbol in used]

        def lines(key: str, texts: list[str]) -> list[str]:
            return [f"{key}{'' if len(texts) == 1 else f'[{i}]'} = {text}" for i, text in enumerate(texts)]

        answer = [lines(key, equation_text(value, pairs)) for key, value in (*update.items(), *free.items())]
        for key, value in answers.items():
            if f"free_{key}" in free:
                size = value.numel()
                answer.append(lines(key, [f"free_{key}{f'[{k}]' if size > 1 else ''}, held" for k in range(size)]))
            else:
                answer.append(lines(key, equation_text(value, pairs)))
        return answer

    def _held(self, answers: dict[str, ca.SX], limits: Mapping[str, tuple[Any, Any]]) -> _Held:
        """Hold outputs between their limits, in `answers`; return what they were, and what says so."""
        free: dict[str, ca.SX] = {}
        statements: list[Statement] = []
        for key, ends in limits.items():
            if key not in answers:
                raise ModelError(f"{self.name}: limits= names {key!r}, which is not an output; it has {list(answers)}")
            size = answers[key].numel()
            place = Place("local", f"free_{key}")
            free[place.name] = answers[key]
            held = free[place.name]
            beyond: list[Statement] = []
            relations: tuple[Literal["<", ">"], ...] = ("<", ">")
            for word, relation, end in zip(("least", "most"), relations, ends, strict=True):
                if end is None:
                    continue
                expression, operands = self._limit(key, f"{word}_{key}", end, size)
                if isinstance(operands[0], Element) and operands[0].place.space == "local":
                    free[operands[0].place.name] = expression
                held = ca.fmax(held, expression) if relation == "<" else ca.fmin(held, expression)
                past = [Compare(Element(place, k), relation, item) for k, item in enumerate(operands)]
                beyond.append(When(AnyOf(tuple(past)), (Raise(Status.CLAMPED),), (), f"{key} was held at a limit"))
            answers[key] = held
            statements += [Refuse(Status.OVERFLOW, Within(place, (-FREE,) * size, (FREE,) * size)), *beyond]
        return _Held(free, statements)

    def _limit(self, key: str, local: str, given: Any, size: int) -> tuple[ca.SX, list[Operand]]:
        """Return a limit of an output as an expression, and each of its elements as an operand."""
        if isinstance(given, ca.SX):
            if given.numel() not in (1, size):
                raise ModelError(f"{self.name}: a limit of {key!r} has {given.numel()} elements; give 1 or {size}")
            known = isinstance(given, Symbol) and any(given is symbol for symbol in self.param_symbols())
            place = self._place(given) if known and isinstance(given, Symbol) else Place("local", local)
            at = [0 if given.numel() == 1 else k for k in range(size)]
            return ca.vertcat(*[given[k] for k in at]), [Element(place, k) for k in at]
        try:
            numbers = spread(given, size)
        except (TypeError, ValueError):
            numbers = ()
        if len(numbers) != size or not np.all(np.isfinite(numbers)):
            raise ModelError(f"{self.name}: the limit of {key!r} is {given!r}; give {size} finite number(s)")
        return ca.SX(ca.DM(list(numbers))), list(numbers)

    def _plain_init(self) -> Entry:
        body: list[Statement] = [
            Assign(Place("next", signal.name), Place("param", f"{signal.name}_0"), signal.size)
            for signal in self.memory_signals
        ]
        doc = "Start (or start again) from the parameters; every parameter is checked here."
        return Entry("init", (), (), tuple(body), doc, checks_params=True)

    def _own(self, signal: Signal) -> Symbol:
        symbol = Symbol(signal)
        self._symbols.append(symbol)
        return symbol

    def _spoken(self, symbol: Symbol) -> str:
        """Return what a symbol is called in the text of an equation."""
        name = symbol.signal.name
        return f"params.{name}" if name in self._inputs and self._inputs[name] is not symbol else name

    def _place(self, symbol: Symbol) -> Place:
        name = symbol.signal.name
        if self._inputs.get(name) is symbol:
            return Place("in", name)
        return Place("memory" if any(item.name == name for item in self.memory_signals) else "param", name)

    def param_symbols(self) -> list[Symbol]:
        """Symbols of the declared parameters."""
        names = {signal.name for signal in self.param_signals}
        return [symbol for symbol in self._not_inputs() if symbol.signal.name in names]

    def memory_symbols(self) -> list[Symbol]:
        """Symbols of the declared memory fields."""
        names = {signal.name for signal in self.memory_signals}
        return [symbol for symbol in self._not_inputs() if symbol.signal.name in names]

    def _not_inputs(self) -> list[Symbol]:
        return [symbol for symbol in self._symbols if self._inputs.get(symbol.signal.name) is not symbol]

    def _expression(self, value: Any, size: int | None = None) -> ca.SX:
        expression = ca.SX(value) if not isinstance(value, (list, tuple)) else ca.vertcat(*value)
        expression = ca.reshape(expression, expression.numel(), 1)
        if size is not None and expression.numel() != size:
            raise ModelError(f"{self.name}: an expression has {expression.numel()} elements where {size} are needed")
        return expression

    # -- reading ------------------------------------------------------------------------------------------------------

    def memory_signals_flat(self) -> list[Signal]:
        """Return the memory's fields, those of parts with dotted names."""
        return [*self.memory_signals, *self._of_parts(lambda part: part.memory_signals_flat())]

    def param_signals_flat(self) -> list[Signal]:
        """Return the parameters, those of parts with dotted names."""
        return [*self.param_signals, *self._of_parts(lambda part: part.param_signals_flat())]

    def _of_parts(self, signals: Callable[[Block], list[Signal]]) -> list[Signal]:
        return [
            signal.renamed(f"{name}.{signal.name}") for name, part in self.parts.items() for signal in signals(part)
        ]

    def memory_group(self) -> Signal:
        """Return the memory as one group signal, parts nested."""
        groups = [replace(part.memory_group(), name=name) for name, part in self.parts.items()]
        return Signal("state", kind=Kind.GROUP, members=(*self.memory_signals, *groups))

    def param_group(self) -> Signal:
        """Return the parameters as one group signal, parts nested; a part without parameters is no member."""
        groups = [replace(part.param_group(), name=name) for name, part in self.parts.items()]
        used = [group for group in groups if group.members]
        return Signal("params", kind=Kind.GROUP, members=(*self.param_signals, *used))

    def twin(self, part: str) -> str:
        """Return the first part that is the very same Block: parts that are share their C."""
        return next(name for name, block in self.parts.items() if block is self.parts[part])

    def judge_inputs(self, entry: Entry) -> Condition:
        """Return the condition that the inputs of an entry are within their ranges.

        Inputs inside a nested group belong to a Call, and are judged by the entry called; those that the body judges itself,
        such as a reading behind its flag, are left to it, and those that are settled to whoever calls it.
        """
        signals = [signal for signal in entry.inputs if signal.kind is Kind.REAL]
        signals += [signal for signal, _ in entry.hidden if signal.kind is Kind.REAL]
        hidden = {signal.name for signal, _ in entry.hidden} | set(entry.settled)
        passed_on = _arguments_of_calls(entry.body) | _judged_within(entry.body)
        return AllOf(
            tuple(
                Within(Place("in", signal.name), signal.low, signal.high)
                for signal in signals
                if signal.name not in passed_on and signal.name not in hidden
            )
        )

    def judge_params(self) -> Condition:
        """Return the condition that all parameters are within their ranges."""
        return AllOf(
            tuple(
                Within(Place("param", signal.name), signal.low, signal.high)
                for signal in self.param_signals
                if signal.kind is Kind.REAL
            )
        )

    def judge_memory(self, names: Sequence[str]) -> Condition:
        """Return the condition that fields of the candidate memory are within their ranges."""
        return AllOf(
            tuple(
                Within(Place("next", signal.name), signal.low, signal.high)
                for signal in self.memory_signals
                if signal.kind is Kind.REAL and signal.name in names
            )
        )

    def check(self) -> None:
        """Raise a ModelError if generated names collide, or nothing can be called."""
        if not self.entries:
            raise ModelError(f"{self.name}: it has no entry, so nothing could be called; declare one with entry(...)")
        for what, signals in (("parameter", self.param_signals), ("memory field", self.memory_signals)):
            check_unique([(signal.name, f"the {what} {signal.name!r}") for signal in signals], self.name)
        for entry in self.entries.values():
            check_unique(
                [(signal.name, f"the input {signal.name!r} of {entry.name}") for signal in entry.inputs], self.name
            )
            check_unique(
                [(signal.name, f"the output {signal.name!r} of {entry.name}") for signal in entry.outputs], self.name
            )

        check_unique(self._prefixed(), self.name)

    def _prefixed(self, prefix: str = "") -> Iterator[tuple[str, str]]:
        """Yield (name behind the block's own, what it is) of the functions and types of the generated C."""
        where = f" of part {prefix[:-1]!r}" if prefix else ""
        for word in ("state_t", "params_t", *(("status_t", "status_text", "model") if not prefix else ())):
            yield f"{prefix}{word}", f"{word}{where}"
        for name in self.entries:
            for end in ("", "_core", "_in_t", "_out_t"):
                yield f"{prefix}{name}{end}", f"the entry {name!r}{where}"
        for name, part in self.parts.items():
            yield from part._prefixed(f"{prefix}{name}_")

    def model_hash(self) -> str:
        """Return eight hexadecimal digits of a hash of the model: same model, same hash, on any machine."""
        from .expressions import tape

        digest = hashlib.sha256()

        def feed(block: Block) -> None:
            digest.update(f"{block.name}|{block.doc}|{block.source_hash}|{block.equations}".encode())
            for signal in (*block.memory_signals, *block.param_signals):
                digest.update(repr(signal).encode())
            for entry in block.entries.values():
                digest.update(f"{entry.name}{entry.inputs}{entry.outputs}{entry.doc}".encode())
                for statement in walk(entry.body):
                    digest.update(type(statement).__name__.encode())
                    if isinstance(statement, Evaluate):
                        record = tape(statement.function)
                        digest.update(f"{record.steps}{record.outputs}{statement.writes}".encode())
                    elif isinstance(statement, Refuse):
                        digest.update(f"{statement.status.name}{statement.unless}".encode())
            for name, part in block.parts.items():
                digest.update(name.encode())
                feed(part)

        feed(self)
        return digest.hexdigest()[:8]


def _judged_within(statements: Sequence[Statement]) -> set[str]:
    """Return the inputs that statements refuse themselves (BAD_INPUT) outside their ranges."""
    return {
        statement.unless.place.name
        for statement in walk(statements)
        if isinstance(statement, Refuse)
        and statement.status is Status.BAD_INPUT
        and isinstance(statement.unless, Within)
        and statement.unless.place.space == "in"
    }


def _arguments_of_calls(statements: Sequence[Statement]) -> set[str]:
    """Return the names of inputs that are only handed on to calls, which judge them."""
    handed = set()
    for statement in walk(statements):
        if isinstance(statement, Call):
            handed |= {item.name for _, item in statement.arguments if isinstance(item, Place) and item.space == "in"}
    return handed


def places_written(statement: Statement) -> set[Place]:
    """Return the places that a statement writes itself."""
    if isinstance(statement, Evaluate):
        return {place for places in statement.writes for place, _ in places}
    writes = getattr(statement, "writes", None)
    if writes is not None:
        return {place for place, _ in writes}
    target = getattr(statement, "target", None)
    return {target} if isinstance(target, Place) else set()
