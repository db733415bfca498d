"""The body of an entry: a short bounded program over named places, and its execution in Python.

A statement is an open unit. It says what it reads and writes, runs itself on NumPy arrays (`run`), and, where it is
arithmetic, gives its scalar operations, from which the emitter prints C.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Any, Literal, Protocol

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from .expressions import Pieces
from .origins import Origin
from .signals import Signal, Status

if TYPE_CHECKING:
    from .block import Block

Array = NDArray[Any]
Space = Literal["memory", "next", "param", "in", "out", "local"]


@dataclass(frozen=True)
class Place:
    """Where a value lives: the memory before the call, its candidate after, a parameter, an input, an output, a local.

    A name with dots goes into nested structs.
    """

    space: Space
    name: str


@dataclass(frozen=True)
class Element:
    """One element of a place."""

    place: Place
    index: int = 0


Operand = Element | float


class Refused(Exception):  # noqa: N818 - it is an outcome, not an error
    """A negative status: nothing changes."""

    def __init__(self, status: Status):
        super().__init__(status.name)
        self.status = status


Trail = tuple[str | int, ...]
"""Where a statement stands in a body: branch, position, branch, position ..."""


@dataclass(frozen=True)
class Visit:
    """A statement that a call executed, or what came of it.

    Attributes
    ----------
    entry : str
        Name of the entry, after those of the parts that lead to it.
    trail : tuple
        Where the statement stands in the entry's body.
    statement : Statement
        It.
    outcome : str
        Empty, or the name of the status with which it refused, or what it had to do.
    """

    entry: str
    trail: Trail
    statement: Statement
    outcome: str = ""


@dataclass
class Frame:
    """The places of one running entry, and how near it came to a switch.

    Attributes
    ----------
    values : dict
        Place -> array.
    status : Status
        Highest positive status so far.
    margin : float
        Smallest distance of a compared value from its limit, relative to the larger of them; a map is discontinuous
        there, and rounding may take either branch.
    entry : str
        Name of the running entry, after those of the parts that lead to it.
    trail : tuple
        Where the running statement stands in the entry's body.
    visits : list of Visit or None
        What was executed so far, if it is asked for.
    real : type
        Floating type in which the C holds the numbers that are compared with; values stay double.
    computed : frozenset of str
        Inputs that a calling entry computed; all others are the caller's own, and are compared exactly.
    """

    block: Block
    values: dict[Place, Array]
    params: dict[str, Array]
    status: Status = Status.OK
    margin: float = math.inf
    patches: dict[str, Any] = field(default_factory=dict)
    entry: str = ""
    trail: Trail = ()
    visits: list[Visit] | None = None
    real: type = float
    computed: frozenset[str] = frozenset()

    def visited(self, statement: Statement, outcome: str = "") -> None:
        """Record that a statement ran, or what came of it."""
        if self.visits is not None:
            self.visits.append(Visit(self.entry, self.trail, statement, outcome))

    def read(self, operand: Operand) -> float:
        """Return the value of an operand."""
        if isinstance(operand, Element):
            return float(self.values[operand.place].ravel()[operand.index])
        return operand

    def bound(self, operand: Operand) -> float:
        """Return the value of an operand of a comparison; a number as the C has it."""
        return self.read(operand) if isinstance(operand, Element) else float(self.real(operand))

    def is_exact(self, operand: Operand) -> bool:
        """Whether every view has the same value: a number, an integer, or what the caller gave."""
        if not isinstance(operand, Element):
            return True
        place = operand.place
        given = place.space == "param" or (place.space == "in" and place.name not in self.computed)
        return given or self.values[place].dtype.kind in "biu"

    def raise_to(self, status: Status) -> None:
        """Keep the highest positive status."""
        self.status = max(self.status, status)

    def near(self, value: float, limit: float, scale: float | None = None) -> None:
        """Record a comparison."""
        size = max(abs(value), abs(limit)) if scale is None else max(abs(scale), abs(limit))
        if math.isfinite(value) and math.isfinite(limit) and size > 0:
            self.margin = min(self.margin, abs(value - limit) / size)

    def memory_spaces(self, space: Space) -> dict[str, Array]:
        """Return name -> array of all places in a space."""
        return {place.name: value for place, value in self.values.items() if place.space == space}


# ---------------------------------------------------------------------------------------------------------------------
# Conditions


class Condition(Protocol):
    """Something that holds or does not."""

    def holds(self, frame: Frame) -> bool:
        """Evaluate it, recording how near the comparison was."""
        ...


@dataclass(frozen=True)
class Within:
    """Every element of a place lies in its range; false for NaN. Single precision compares with rounded ends."""

    place: Place
    low: tuple[float, ...]
    high: tuple[float, ...]
    first: int = 0

    def holds(self, frame: Frame) -> bool:
        value = frame.values[self.place].ravel()[self.first : self.first + len(self.low)]
        ok = True
        exact = frame.is_exact(Element(self.place))
        ends = zip(map(frame.bound, self.low), map(frame.bound, self.high), strict=True)
        for item, (low, high) in zip(value, ends, strict=True):
            if not exact:
                frame.near(float(item), low)
                frame.near(float(item), high)
            ok = ok and bool(low <= item <= high)
        return ok


@dataclass(frozen=True)
class Compare:
    """left (relation) right; `scale` is the natural size of the compared value, for the margin."""

    left: Operand
    relation: Literal["<", "<=", ">", ">="]
    right: Operand
    scale: Operand | None = None

    def holds(self, frame: Frame) -> bool:
        a, b = frame.bound(self.left), frame.bound(self.right)
        if not (frame.is_exact(self.left) and frame.is_exact(self.right)):
            frame.near(a, b, None if self.scale is None else frame.read(self.scale))
        return {"<": a < b, "<=": a <= b, ">": a > b, ">=": a >= b}[self.relation]


@dataclass(frozen=True)
class IsSet:
    """A flag is up."""

    flag: Element

    def holds(self, frame: Frame) -> bool:
        return bool(frame.read(self.flag))


@dataclass(frozen=True)
class AllOf:
    """All conditions hold; the first that does not ends the evaluation."""

    conditions: tuple[Condition, ...]

    def holds(self, frame: Frame) -> bool:
        return all(condition.holds(frame) for condition in self.conditions)


@dataclass(frozen=True)
class AnyOf:
    """One of the conditions holds; the first that does ends the evaluation."""

    conditions: tuple[Condition, ...]

    def holds(self, frame: Frame) -> bool:
        return any(condition.holds(frame) for condition in self.conditions)


# ---------------------------------------------------------------------------------------------------------------------
# Statements


class Statement(Protocol):
    """One step of a program."""

    def run(self, frame: Frame) -> None:
        """Execute it on the frame's arrays."""
        ...


@dataclass(frozen=True)
class Evaluate:
    """Evaluate a CasADi SX function.

    Attributes
    ----------
    function : casadi.Function
        Scalar (SX) function.
    reads : tuple of tuple of Place
        For each argument the places whose elements, in order, fill it.
    writes : tuple of tuple of (Place, size)
        For each output the places that take its structural nonzeros, in order.
    names : tuple of tuple of str
        For each output the C names of its nonzeros, where they go into locals.
    comment : tuple of str
        The equations, one a line.
    origins : tuple of tuple of Origin
        For each output what its nonzeros come from; empty if it is not known.
    """

    function: ca.Function
    reads: tuple[tuple[tuple[Place, int], ...], ...]
    writes: tuple[tuple[tuple[Place, int], ...], ...]
    names: tuple[tuple[str, ...], ...]
    comment: tuple[str, ...] = ()
    origins: tuple[tuple[Origin, ...], ...] = ()

    @cached_property
    def pieces(self) -> Pieces:
        """The piecewise functions that it evaluates."""
        return Pieces(self.function)

    def run(self, frame: Frame) -> None:
        arguments = []
        for places in self.reads:
            parts = [np.asarray(frame.values[place], dtype=float).ravel() for place, _ in places]
            arguments.append(ca.DM(np.concatenate(parts) if parts else np.zeros(0)))
        if frame.visits is not None and self.pieces.steps:
            for met in self.pieces.met(*[np.array(item).ravel() for item in arguments]):
                frame.visited(self, met)
        function = frame.patches.get(self.function.name(), self.function)
        outputs = function.call(arguments)
        for output, places in zip(outputs, self.writes, strict=True):
            flat = np.array(output.nonzeros(), dtype=float)
            start = 0
            for place, size in places:
                frame.values[place] = flat[start : start + size]
                start += size


class Scalars(Protocol):
    """What a kernel's scalar form computes with: graph nodes of the emitter, or plain numbers."""

    def __add__(self, other: Any) -> Any: ...
    def __sub__(self, other: Any) -> Any: ...
    def __mul__(self, other: Any) -> Any: ...
    def __neg__(self) -> Any: ...


class Kernel:
    """Arithmetic on symmetric matrices and vectors, in two independent forms.

    `scalar` is the algorithm element by element: what the C does. `dense` is the same map as NumPy matrix algebra.
    """

    reads: tuple[tuple[Place, int], ...]
    writes: tuple[tuple[Place, int], ...]
    comment: tuple[str, ...] = ()

    def scalar(self, *values: list[Any]) -> list[list[Any]]:
        """Return the written values from the read ones, as lists of scalars."""
        raise NotImplementedError

    def dense(self, *values: Array) -> list[Array]:
        """Return the written values from the read ones, as arrays."""
        raise NotImplementedError

    def names(self) -> tuple[tuple[str, ...], ...]:
        """Return C name stems for the elements of what it reads."""
        return tuple(tuple(f"{place.name}_{index}" for index in range(size)) for place, size in self.reads)

    def order(self, output: int) -> Sequence[int]:
        """Return in which order the elements of an output are best computed, so that few numbers are kept at a time."""
        return range(self.writes[output][1])

    def run(self, frame: Frame) -> None:
        """Execute the dense form."""
        values = [np.asarray(frame.values[place], dtype=float).ravel() for place, _ in self.reads]
        with np.errstate(all="ignore"):
            answers = self.dense(*values)
        for (place, _), answer in zip(self.writes, answers, strict=True):
            frame.values[place] = answer


@dataclass(frozen=True)
class Refuse:
    """Return a negative status, unless a condition holds."""

    status: Status
    unless: Condition
    comment: str = ""

    def run(self, frame: Frame) -> None:
        if not self.unless.holds(frame):
            raise Refused(self.status)


@dataclass(frozen=True)
class Raise:
    """Return at least this positive status."""

    status: Status

    def run(self, frame: Frame) -> None:
        frame.raise_to(self.status)


@dataclass(frozen=True)
class When:
    """Run one of two lists of statements."""

    condition: Condition
    then: tuple[Statement, ...]
    otherwise: tuple[Statement, ...] = ()
    comment: str = ""

    def run(self, frame: Frame) -> None:
        if self.condition.holds(frame):
            run_body(self.then, frame, "then")
        else:
            run_body(self.otherwise, frame, "otherwise")


@dataclass(frozen=True)
class Restore:
    """Make the candidate memory what the memory was before the call."""

    def run(self, frame: Frame) -> None:
        for name, value in frame.memory_spaces("memory").items():
            frame.values[Place("next", name)] = value.copy()


@dataclass(frozen=True)
class Assign:
    """Copy a place (or a number into every element of it)."""

    target: Place
    source: Place | float
    size: int = 1

    def run(self, frame: Frame) -> None:
        old = frame.values.get(self.target)
        value = frame.values[self.source] if isinstance(self.source, Place) else np.full(self.size, self.source)
        frame.values[self.target] = np.array(value, dtype=old.dtype if old is not None else float).reshape(self.size)


@dataclass(frozen=True)
class AssignElement:
    """Copy one element."""

    target: Element
    source: Element

    def run(self, frame: Frame) -> None:
        frame.values[self.target.place].ravel()[self.target.index] = frame.read(self.source)


@dataclass(frozen=True)
class CountUp:
    """Add one to a counter of the candidate memory; it stays at its largest value."""

    target: Place

    def run(self, frame: Frame) -> None:
        value = int(frame.values[self.target].ravel()[0])
        frame.values[self.target] = np.array([min(value + 1, 2**32 - 1)], dtype=np.uint32)


@dataclass(frozen=True)
class HoldVariances:
    """Keep the diagonal of a packed symmetric matrix between floors and ceilings.

    A negative element, or NaN, is refused (NOT_POSITIVE). Above its ceiling c, row and column are scaled by
    sqrt(c / P_ii), which keeps the matrix definite; below its floor the floor is stored (CLAMPED). Any other element
    beyond sqrt(c_i c_j), or NaN, is refused (OVERFLOW).
    """

    target: Place
    size: int
    floor: tuple[float, ...]
    ceiling: tuple[float, ...]
    packing: Packing | None = None

    @property
    def layout(self) -> Packing:
        """Where the elements of the matrix are stored."""
        return self.packing or Packing(self.size)

    def limits(self) -> tuple[float, ...]:
        """Return the largest magnitude of each packed element: sqrt(c_i c_j)."""
        return tuple(
            self.ceiling[i] if i == j else math.sqrt(self.ceiling[i] * self.ceiling[j]) for i, j in self.layout.pairs
        )

    def run(self, frame: Frame) -> None:
        packed = np.array(frame.values[self.target], dtype=float)
        diagonal = self.layout.diagonal
        before = frame.values.get(Place("memory", self.target.name))
        for i, (low, high) in enumerate(zip(self.floor, self.ceiling, strict=True)):
            natural = float(before[diagonal[i]]) if before is not None else None
            frame.near(float(packed[diagonal[i]]), 0.0, natural)
            frame.near(float(packed[diagonal[i]]), low)
            frame.near(float(packed[diagonal[i]]), high)
        limits = self.limits()
        certain = float(np.sum(np.abs(packed))) <= min(limits)
        if not (certain and all(packed[at] >= low for at, low in zip(diagonal, self.floor, strict=True))):
            frame.visited(self, "looked at closely")  # what a fast test of the sum of magnitudes does not pass
        if not all(packed[item] >= 0 for item in diagonal):
            raise Refused(Status.NOT_POSITIVE)
        with np.errstate(all="ignore"):
            for i, (low, high) in enumerate(zip(self.floor, self.ceiling, strict=True)):
                value = packed[diagonal[i]]
                if value > high:
                    factor = np.sqrt(high / value)
                    block = next(rows for rows in self.layout.parts if i in rows)
                    for j in block:
                        if j != i:
                            packed[self.layout.at(i, j)] *= factor
                    packed[diagonal[i]] = high
                    frame.visited(self, "above the ceiling")
                    if i > block[0]:
                        frame.visited(self, "above the ceiling, not the first")
                    if i < block[-1]:
                        frame.visited(self, "above the ceiling, not the last")
                    frame.raise_to(Status.CLAMPED)
                elif value < low:
                    packed[diagonal[i]] = low
                    frame.visited(self, "below the floor")
                    frame.raise_to(Status.CLAMPED)
        for k, (value, limit) in enumerate(zip(packed, limits, strict=True)):
            if k not in diagonal:  # the diagonal was compared before it was held, and is within its limit since
                frame.near(abs(float(value)), limit)
        frame.values[self.target] = packed
        if not np.all(np.abs(packed) <= limits):
            raise Refused(Status.OVERFLOW)


@dataclass(frozen=True)
class HoldFactors(HoldVariances):
    """Keep the variances of U D U' below ceilings and D above floors; the target packs D on the diagonal, U beside it.

    An element of D that is negative, or NaN, is refused (NOT_POSITIVE). A variance above its ceiling c has its row and
    column scaled by sqrt(c / P_ii); an element of D below its floor is raised to it (CLAMPED). Any element of U beyond
    sqrt(c_i / floor_j), or NaN, is refused (OVERFLOW).
    """

    def limits(self) -> tuple[float, ...]:
        """Return the largest magnitude of each packed element."""
        return tuple(
            self.ceiling[i] if i == j else math.sqrt(self.ceiling[i] / self.floor[j]) for i, j in self.layout.pairs
        )

    def certain(self) -> tuple[float, float]:
        """Return a magnitude of U's elements and a sum of D with which no variance is above any ceiling.

        With |u_ij| <= m, m >= 1, a variance sum_j u_ij^2 d_j is at most m^2 sum_j d_j.
        """
        ceiling = min(self.ceiling)
        most = max(1.0, ceiling ** (1.0 / 3.0))
        return most, ceiling / most**2

    def run(self, frame: Frame) -> None:
        packed = np.array(frame.values[self.target], dtype=float)
        n, diagonal = self.size, list(self.layout.diagonal)
        floor, ceiling = np.array(self.floor), np.array(self.ceiling)
        before = frame.values.get(Place("memory", self.target.name))
        most, total = self.certain()
        beside = np.delete(packed, diagonal)
        if not (
            np.all(np.abs(beside) <= most) and np.sum(packed[diagonal]) <= total and np.all(packed[diagonal] >= floor)
        ):
            frame.visited(self, "looked at closely")  # what a fast test does not pass
        for at, low in zip(diagonal, floor, strict=True):
            frame.near(float(packed[at]), 0.0, None if before is None else float(before[at]))
            frame.near(float(packed[at]), float(low))
        if not np.all(packed[diagonal] >= 0):
            raise Refused(Status.NOT_POSITIVE)
        with np.errstate(all="ignore"):
            table = self.layout.upper(packed)
            upper, weights = np.triu(table, 1) + np.eye(n), np.diag(table).copy()
            variances = (upper * upper) @ weights
            scale = np.where(variances > ceiling, np.sqrt(ceiling / variances), 1.0)
            for variance, high in zip(variances, ceiling, strict=True):
                frame.near(float(variance), float(high))
            if np.any(variances > ceiling):
                for outcome in ("", ", not the first", ", not the last"):
                    frame.visited(self, f"above the ceiling{outcome}")
                frame.raise_to(Status.CLAMPED)
                upper, weights = upper * np.outer(scale, 1.0 / scale), weights * scale**2
            if np.any(weights < floor):
                frame.visited(self, "below the floor")
                frame.raise_to(Status.CLAMPED)
            table = np.triu(upper, 1)
            table[np.diag_indices(n)] = np.maximum(weights, floor)
            packed = self.layout.pack(table)
        for value, limit in zip(packed, self.limits(), strict=True):
            frame.near(abs(float(value)), limit)
        frame.values[self.target] = packed
        if not np.all(np.abs(packed) <= self.limits()):
            raise Refused(Status.OVERFLOW)


@dataclass(frozen=True)
class Call:
    """Run another entry on the current memory.

    Attributes
    ----------
    entry : str
        Its name.
    arguments : dict as tuple of (input name, place or number)
        What its inputs are.
    outputs : str
        Prefix in this entry's outputs or locals that takes its outputs; empty drops them.
    part : str
        Part of a composition; empty for an entry of the same block.
    """

    entry: str
    arguments: tuple[tuple[str, Place | float], ...]
    outputs: Place | None = None
    part: str = ""

    def run(self, frame: Frame) -> None:
        block = frame.block.parts[self.part] if self.part else frame.block
        entry = block.entries[self.entry]
        prefix = f"{self.part}." if self.part else ""
        values: dict[Place, Array] = {}
        source: Space = "memory" if self.part else "next"
        if not entry.checks_params:
            for signal in block.memory_signals_flat():
                values[Place("memory", signal.name)] = frame.values[Place(source, prefix + signal.name)]
        computed = []
        for name, argument in self.arguments:
            given = frame.values[argument] if isinstance(argument, Place) else np.array([argument])
            values[Place("in", name)] = given
            if isinstance(argument, Place) and not frame.is_exact(Element(argument)):
                computed.append(name)
        params = {name.removeprefix(prefix): value for name, value in frame.params.items() if name.startswith(prefix)}
        path = _path(frame.entry) + prefix
        outcome = run_entry(
            block, entry, values, params, frame.patches, frame.visits, path, frame.real, frozenset(computed)
        )
        frame.margin = min(frame.margin, outcome.margin)
        if outcome.status < 0:
            raise Refused(outcome.status)
        for place, value in outcome.values.items():
            if place.space == "next":
                frame.values[Place("next", prefix + place.name)] = value
            elif place.space == "out" and self.outputs is not None:
                frame.values[Place(self.outputs.space, f"{self.outputs.name}.{place.name}")] = value
        frame.raise_to(outcome.status)
        frame.values[Place("local", "last_status")] = np.array([outcome.status])


@dataclass(frozen=True)
class Attempt:
    """Run calls as one transaction: if one is refused, the memory is as before, and `on_refused` runs."""

    calls: tuple[Call, ...]
    status: Place
    accepted: tuple[Statement, ...]
    on_refused: tuple[Statement, ...]

    def run(self, frame: Frame) -> None:
        saved = frame.memory_spaces("next")
        status_before = frame.status
        try:
            run_body(self.calls, frame, "calls")
            own = frame.values[Place("local", "last_status")]
            frame.values[self.status] = np.array(own, dtype=np.int32)
            run_body(self.accepted, frame, "accepted")
        except Refused as refusal:
            for name, value in saved.items():
                frame.values[Place("next", name)] = value
            frame.status = status_before
            frame.values[self.status] = np.array([refusal.status], dtype=np.int32)
            run_body(self.on_refused, frame, "on_refused")


@dataclass(frozen=True)
class Entry:
    """A map (memory, inputs, parameters) -> (memory, outputs, status).

    Attributes
    ----------
    name : str
        Name of the C function, after the block's.
    inputs, outputs : tuple of Signal
        Fields of its structs; a group is a nested struct, filled by a Call.
    body : tuple of Statement
        The program. Input ranges are judged before it.
    hidden : tuple of (Signal, Place)
        Inputs that only callers inside the block set; elsewhere they are read from the place.
    checks_params : bool
        Whether it judges the parameters' ranges (`init` does).
    sources : tuple of str
        Lines of the user's file that it comes from, beside that of the block; no part of the model.
    settled : tuple of str
        Inputs that are not judged here: whoever calls it has judged them in the same call, against no wider a range.
    """

    name: str
    inputs: tuple[Signal, ...]
    outputs: tuple[Signal, ...]
    body: tuple[Statement, ...]
    doc: str = ""
    hidden: tuple[tuple[Signal, Place], ...] = ()
    checks_params: bool = False
    sources: tuple[str, ...] = ()
    settled: tuple[str, ...] = ()


@dataclass
class Outcome:
    """What running an entry gave; `values` holds the candidate memory and the outputs if it was not refused."""

    status: Status
    values: dict[Place, Array]
    margin: float


def run_entry(
    block: Block,
    entry: Entry,
    values: dict[Place, Array],
    params: dict[str, Array],
    patches: dict[str, Any] | None = None,
    visits: list[Visit] | None = None,
    path: str = "",
    real: type = float,
    computed: frozenset[str] = frozenset(),
) -> Outcome:
    """Run an entry: compute, judge; the caller commits.

    Parameters
    ----------
    block : Block
        Owner of the entry.
    entry : Entry
        What to run.
    values : dict
        Arrays of the places ``memory`` and ``in``.
    params : dict
        Parameter name -> array.
    patches : dict, optional
        CasADi functions to use instead of those of the same name: for tests that plant a fault.
    visits : list, optional
        Takes what was executed.
    path : str
        Names of the parts that lead to the block, a dot after each.
    real : type
        Floating type in which the C holds the numbers that values are compared with.
    computed : frozenset of str
        Inputs that a calling entry computed.
    """
    frame = Frame(
        block, dict(values), params, patches=patches or {}, entry=path + entry.name, visits=visits, real=real,
        computed=computed,
    )  # fmt: skip
    for name, value in params.items():
        frame.values[Place("param", name)] = value
    for signal, place in entry.hidden:
        frame.values.setdefault(Place("in", signal.name), frame.values[place])
    try:
        run_body(judgements(block, entry), frame, "judged")
        for signal in block.memory_signals_flat():
            place = Place("memory", signal.name)
            if place in frame.values:
                frame.values[Place("next", signal.name)] = frame.values[place].copy()
        run_body(entry.body, frame, "body")
    except Refused as refusal:
        return Outcome(refusal.status, {}, frame.margin)
    kept = {place: value for place, value in frame.values.items() if place.space in ("next", "out")}
    return Outcome(frame.status, kept, frame.margin)


def judgements(block: Block, entry: Entry) -> tuple[Refuse, ...]:
    """Return what is judged before the body of an entry: its inputs, and the parameters where it checks them."""
    answer = [Refuse(Status.BAD_INPUT, block.judge_inputs(entry))]
    if entry.checks_params:
        answer.append(Refuse(Status.BAD_PARAM, block.judge_params()))
    return tuple(answer)


def run_body(statements: Sequence[Statement], frame: Frame, branch: str) -> None:
    """Execute statements in order, recording each."""
    outer = frame.trail
    try:
        for k, statement in enumerate(statements):
            frame.trail = (*outer, branch, k)
            frame.visited(statement)
            statement.run(frame)
    except Refused as refusal:
        frame.visited(statement, refusal.status.name)
        raise
    finally:
        frame.trail = outer


def numbered(statements: Sequence[Statement], branch: str, outer: Trail = ()) -> Iterator[tuple[Trail, Statement]]:
    """Yield every statement with the trail that `run_body` records for it."""
    for k, statement in enumerate(statements):
        trail: Trail = (*outer, branch, k)
        yield trail, statement
        if isinstance(statement, When):
            yield from numbered(statement.then, "then", trail)
            yield from numbered(statement.otherwise, "otherwise", trail)
        elif isinstance(statement, Attempt):
            yield from numbered(statement.calls, "calls", trail)
            yield from numbered(statement.accepted, "accepted", trail)
            yield from numbered(statement.on_refused, "on_refused", trail)


def _path(entry: str) -> str:
    """Return what stands before the name of an entry."""
    return entry[: entry.rfind(".") + 1]


def walk(statements: Sequence[Statement]) -> Iterator[Statement]:
    """Yield every statement, those inside others too."""
    for statement in statements:
        yield statement
        if isinstance(statement, When):
            yield from walk(statement.then)
            yield from walk(statement.otherwise)
        elif isinstance(statement, Attempt):
            yield from statement.calls
            yield from walk(statement.accepted)
            yield from walk(statement.on_refused)


@dataclass(frozen=True)
class Packing:
    """Which elements of a symmetric matrix are stored, and in which order.

    Block after block, each its upper triangle by rows; what is in no block is zero and has no place. A matrix of one block
    is its upper triangle by rows.

    Attributes
    ----------
    size : int
        Rows of the matrix.
    blocks : tuple of tuple of int
        Rows of each block, rising; empty for one block of all of them.
    """

    size: int
    blocks: tuple[tuple[int, ...], ...] = ()

    def __post_init__(self) -> None:
        if self.blocks and sorted(row for block in self.blocks for row in block) != list(range(self.size)):
            raise ValueError(f"blocks {self.blocks} are no partition of {self.size} rows")
        if len(self.blocks) == 1:
            object.__setattr__(self, "blocks", ())

    @property
    def parts(self) -> tuple[tuple[int, ...], ...]:
        """Rows of each block, also where there is one."""
        return self.blocks or (tuple(range(self.size)),)

    @property
    def pairs(self) -> tuple[tuple[int, int], ...]:
        """(row, column) of each stored element, row <= column."""
        return _pairs(self)

    @property
    def count(self) -> int:
        """Number of stored elements."""
        return sum(packed_size(len(block)) for block in self.parts)

    @property
    def diagonal(self) -> tuple[int, ...]:
        """Where each element of the diagonal is stored, row by row."""
        table = _table(self)
        return tuple(table[i, i] for i in range(self.size))

    def index(self, i: int, j: int) -> int | None:
        """Return where element (i, j) is stored, or None if it is zero by structure."""
        return _table(self).get((i, j))

    def at(self, i: int, j: int) -> int:
        """Return where an element is stored that is."""
        return _table(self)[i, j]

    def pick(self, packed: Any, i: int, j: int) -> Any:
        """Return an element of what is packed, or None if it is zero by structure."""
        place = _table(self).get((i, j))
        return None if place is None else packed[place]

    def pack(self, full: Any) -> Array:
        """Return the stored elements of a matrix."""
        rows, columns = _stored(self)
        return np.asarray(np.asarray(full)[rows, columns])

    def unpack(self, packed: Array) -> Array:
        """Return the full symmetric matrix (size, size)."""
        if not self.blocks:
            return packed[_places(self.size)]
        answer = np.zeros((self.size, self.size), dtype=packed.dtype)
        rows, columns = _stored(self)
        answer[rows, columns] = packed
        answer[columns, rows] = packed
        return answer

    def upper(self, packed: Array) -> Array:
        """Return the upper triangle of it, zeros below: that of factors."""
        answer = np.zeros((self.size, self.size), dtype=packed.dtype)
        answer[_stored(self)] = packed
        return answer


@lru_cache
def _pairs(packing: Packing) -> tuple[tuple[int, int], ...]:
    return tuple((block[a], j) for block in packing.parts for a in range(len(block)) for j in block[a:])


@lru_cache
def _table(packing: Packing) -> dict[tuple[int, int], int]:
    table = {}
    for place, (i, j) in enumerate(_pairs(packing)):
        table[i, j] = table[j, i] = place
    return table


@lru_cache
def _stored(packing: Packing) -> tuple[Array, Array]:
    """Return rows and columns of the stored elements."""
    pairs = np.array(_pairs(packing), dtype=int).reshape(-1, 2)
    return pairs[:, 0], pairs[:, 1]


def packed_index(size: int, i: int, j: int) -> int:
    """Return where element (i, j) of a symmetric matrix stands in its upper triangle, packed by rows."""
    if i > j:
        i, j = j, i
    return i * size - i * (i - 1) // 2 + (j - i)


def packed_size(size: int) -> int:
    """Return the number of elements of a packed upper triangle."""
    return size * (size + 1) // 2


@lru_cache
def _upper(size: int) -> tuple[Array, Array]:
    """Return rows and columns of an upper triangle, in the order of its packing."""
    return np.triu_indices(size)


@lru_cache
def _places(size: int) -> Array:
    """Return, for each element of a symmetric matrix, where it stands in the packed triangle."""
    table = np.zeros((size, size), dtype=int)
    table[_upper(size)] = np.arange(packed_size(size))
    return table + np.triu(table, 1).T


def unpack_symmetric(packed: Array, size: int) -> Array:
    """Return the full symmetric matrix of a packed upper triangle."""
    return packed[_places(size)]


def pack_symmetric(full: Array) -> Array:
    """Return the upper triangle of a matrix, packed by rows."""
    return np.asarray(full)[_upper(len(full))]
