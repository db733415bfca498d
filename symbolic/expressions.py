"""CasADi expressions read back: as a tape of scalar operations, as NumPy code, as text.

CasADi's instruction stream reuses work registers and folds divisions; `Tape` undoes the first (single assignment, in
the order of a depth-first walk from the outputs, so that CasADi's own numbering leaves no trace).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from .errors import ModelError

_OPERATIONS = {
    ca.OP_ADD: "add",
    ca.OP_SUB: "sub",
    ca.OP_MUL: "mul",
    ca.OP_DIV: "div",
    ca.OP_NEG: "neg",
    ca.OP_INV: "inv",
    ca.OP_SQ: "sq",
    ca.OP_TWICE: "twice",
    ca.OP_SQRT: "sqrt",
    ca.OP_SIN: "sin",
    ca.OP_COS: "cos",
    ca.OP_TAN: "tan",
    ca.OP_ASIN: "asin",
    ca.OP_ACOS: "acos",
    ca.OP_ATAN: "atan",
    ca.OP_ATAN2: "atan2",
    ca.OP_SINH: "sinh",
    ca.OP_COSH: "cosh",
    ca.OP_TANH: "tanh",
    ca.OP_EXP: "exp",
    ca.OP_LOG: "log",
    ca.OP_POW: "pow",
    ca.OP_CONSTPOW: "pow",
    ca.OP_FABS: "fabs",
    ca.OP_SIGN: "sign",
    ca.OP_FLOOR: "floor",
    ca.OP_CEIL: "ceil",
    ca.OP_FMIN: "fmin",
    ca.OP_FMAX: "fmax",
    ca.OP_LT: "lt",
    ca.OP_LE: "le",
    ca.OP_EQ: "eq",
    ca.OP_NE: "ne",
    ca.OP_AND: "and",
    ca.OP_OR: "or",
    ca.OP_NOT: "not",
    ca.OP_IF_ELSE_ZERO: "if_else_zero",
}
_CODES = {name: code for code, name in reversed(_OPERATIONS.items())}  # of two codes for pow the first
_OPERATION_NAMES = {getattr(ca, word): word[3:].lower() for word in dir(ca) if word.startswith("OP_")}

PIECEWISE = frozenset({"saturation", "minimum", "maximum", "look_up", "look_up_slope"})
"""Functions of `piecewise` that are called in an expression and stay one step of a tape."""

CALL_NODES = {f"plantc_{name}": name for name in sorted(PIECEWISE)}
"""Name of the CasADi function that is called -> the operation on the tape. The names are reserved: a model's own function may
be called "minimum", and is then seen through like any other."""

TABLES = frozenset({"look_up", "look_up_slope"})
"""Those of a table: their arguments are x, the breakpoints, and as many values."""

KINKS = PIECEWISE | {"fabs", "sign", "floor", "ceil", "fmin", "fmax", "lt", "le", "eq", "ne", "if_else_zero"}
"""Operations whose derivative jumps: there, complex step and differences may differ from each other."""


@dataclass(frozen=True)
class Step:
    """One operation of a tape.

    `arguments` are positions of earlier steps; an ``input`` step has (argument, element) in `place`, a ``const`` its
    number in `value`.
    """

    operation: str
    arguments: tuple[int, ...] = ()
    value: float = 0.0
    place: tuple[int, int] = (0, 0)


@dataclass(frozen=True)
class Tape:
    """The scalar operations of a CasADi Function, each assigned once.

    Attributes
    ----------
    steps : list of Step
        In an order in which every step comes after its arguments.
    outputs : list of list of int
        For each output of the function, the step that gives each of its structural nonzeros (column-major).
    """

    steps: list[Step]
    outputs: list[list[int]]

    @property
    def kinks(self) -> list[str]:
        """Names of operations on the tape whose derivative jumps."""
        return sorted({step.operation for step in self.steps} & KINKS)


def expand(function: ca.Function, owner: str) -> ca.Function:
    """Return `function` as an SX function, or raise a ModelError that names it."""
    if not isinstance(function, ca.Function):
        raise ModelError(f"{owner}: {function!r} is not a CasADi function; give a casadi.Function")
    try:
        expanded = function if function.is_a("SXFunction") else function.expand()
    except RuntimeError as error:
        reason = str(error).strip().splitlines()[-1]
        raise ModelError(_not_expanded(owner, function, reason)) from None
    for called in _called(expanded):
        if called.name() not in CALL_NODES and _inside(called) is None:
            raise ModelError(_not_expanded(owner, function, "it calls a function whose inside is not seen"))
    return expanded


def _not_expanded(owner: str, function: ca.Function, reason: str) -> str:
    return (
        f"{owner}: the CasADi function {function.name()!r} cannot be expanded into scalar operations ({reason}); "
        "write it with SX operations, without external, interpolant, integrator or solver nodes"
    )


def operation_code(operation: str) -> int:
    """Return CasADi's number of an operation of a tape."""
    return _CODES[operation]


def constants_of(expression: ca.SX) -> list[float]:
    """Return every number that an expression holds, those inside its operations too."""
    function = ca.Function("numbers", ca.symvar(expression), [expression])
    steps = range(function.n_instructions())
    return [float(function.instruction_constant(k)) for k in steps if function.instruction_id(k) == ca.OP_CONST]


def tape(function: ca.Function) -> Tape:
    """Read the instruction stream of an SX function.

    Raises
    ------
    ModelError
        If an operation has no counterpart in the generated C; it is named.
    """
    reader = _Reader()
    outputs = reader.read(function, None)
    return _ordered(reader.raw, outputs)


def _called(function: ca.Function) -> list[ca.Function]:
    """Return the functions that an SX function calls, those that they call too."""
    found: list[ca.Function] = []
    if not any(function.instruction_id(k) == ca.OP_CALL for k in range(function.n_instructions())):
        return found
    values = function.instructions_sx()
    for k in range(function.n_instructions()):
        if function.instruction_id(k) == ca.OP_CALL:
            called = values[k].which_function()
            found.append(called)
            inside = None if called.name() in CALL_NODES else _inside(called)
            found += [] if inside is None else _called(inside)
    return found


def _inside(called: ca.Function) -> ca.Function | None:
    """Return a called function as scalar operations, or None if they are not seen."""
    if called.is_a("SXFunction"):
        return called
    try:  # any other kind would be expanded to a call of itself
        return called.expand() if called.is_a("MXFunction") else None
    except RuntimeError:
        return None


class _Reader:
    """Records the operations of functions, those of what they call in the place of the call."""

    def __init__(self) -> None:
        self.raw: list[Step] = []
        self.known: dict[Step, int] = {}

    def record(self, step: Step) -> int:
        """Return the position of a step, the same for the same one."""
        if step not in self.known:
            self.known[step] = len(self.raw)
            self.raw.append(step)
        return self.known[step]

    def read(self, function: ca.Function, given: list[list[int]] | None) -> list[list[int]]:
        """Return the steps of the outputs; `given` are those of the arguments, or None for inputs."""
        register: dict[int, int] = {}
        outputs = [[-1] * function.nnz_out(index) for index in range(function.n_out())]
        values: Any = None
        for k in range(function.n_instructions()):
            code = function.instruction_id(k)
            inputs = function.instruction_input(k)
            target = function.instruction_output(k)
            if code == ca.OP_OUTPUT:
                outputs[target[0]][target[1]] = register[inputs[0]]
            elif code == ca.OP_INPUT and given is not None:
                register[target[0]] = given[inputs[0]][inputs[1]]
            elif code == ca.OP_INPUT:
                register[target[0]] = self.record(Step("input", place=(inputs[0], inputs[1])))
            elif code == ca.OP_CONST:
                number = float(function.instruction_constant(k))
                register[target[0]] = self.record(Step("const", value=number))
            elif code == ca.OP_ASSIGN:
                register[target[0]] = register[inputs[0]]
            elif code == ca.OP_CALL:
                values = function.instructions_sx() if values is None else values
                answers = self.call(values[k].which_function(), [register[item] for item in inputs], function)
                register |= {item: answer for item, answer in zip(target, answers, strict=True) if item >= 0}
            elif code in _OPERATIONS:
                arguments = tuple(register[item] for item in inputs)
                register[target[0]] = self.record(Step(_OPERATIONS[code], arguments))
            else:
                raise ModelError(
                    f"the operation {_OPERATION_NAMES.get(code, code)!r} in {function.name()!r} has no counterpart in "
                    "the generated C; rewrite it with " + ", ".join(sorted(set(_OPERATIONS.values())))
                )
        return outputs

    def call(self, called: ca.Function, arguments: list[int], caller: ca.Function) -> list[int]:
        """Return the steps that a call gives, one for each structural nonzero of its outputs."""
        if called.name() in CALL_NODES:
            return [self.record(Step(CALL_NODES[called.name()], tuple(arguments)))]
        inside = _inside(called)
        if inside is None:
            raise ModelError(_not_expanded(caller.name(), called, "its inside is not seen"))
        given, start = [], 0
        for index in range(called.n_in()):
            stop = start + called.nnz_in(index)
            given.append(arguments[start:stop])
            start = stop
        return [item for output in self.read(inside, given) for item in output]


def _ordered(raw: list[Step], outputs: list[list[int]]) -> Tape:
    """Renumber the steps in the order of a depth-first walk from the outputs."""
    position: dict[int, int] = {}
    steps: list[Step] = []
    for root in (item for output in outputs for item in output):
        stack = [root]
        while stack:
            item = stack[-1]
            if item in position:
                stack.pop()
                continue
            waiting = [argument for argument in raw[item].arguments if argument not in position]
            if waiting:
                stack.extend(reversed(waiting))
                continue
            stack.pop()
            old = raw[item]
            position[item] = len(steps)
            arguments = tuple(position[argument] for argument in old.arguments)
            steps.append(Step(old.operation, arguments, old.value, old.place))
    return Tape(steps, [[position[item] for item in output] for output in outputs])


# ---------------------------------------------------------------------------------------------------------------------
# NumPy


def _complex_atan2(y: Any, x: Any) -> Any:
    value = np.arctan2(np.real(y), np.real(x))
    if np.iscomplexobj(y) or np.iscomplexobj(x):
        square = np.real(x) ** 2 + np.real(y) ** 2
        return value + 1j * ((np.real(x) * np.imag(y) - np.real(y) * np.imag(x)) / square)
    return value


def _with_derivative(value: Callable[[Any], Any], derivative: Callable[[Any], Any]) -> Callable[[Any], Any]:
    """Extend a real function to the complex step, where NumPy's own complex version has branch cuts."""

    def extended(x: Any) -> Any:
        if np.iscomplexobj(x):
            real = np.real(x)
            return value(real) + 1j * (derivative(real) * np.imag(x))
        return value(x)

    return extended


def _truth(condition: Any, *compared: Any) -> Any:
    """Return 1 or 0, as a number of the precision of what was compared: NumPy's own truth values cannot be summed."""
    kind = np.result_type(*[np.real(item) for item in compared], np.float32)
    return np.asarray(condition).astype(kind)[()]


def _if_else_zero(condition: Any, value: Any) -> Any:
    kind = np.result_type(np.real(condition), value, np.float32)
    return np.where(np.real(condition) != 0, np.asarray(value, dtype=kind), kind.type(0))


def _extreme(a: Any, b: Any, is_first: Any) -> Any:
    """Return the first or the second, in the manner of CasADi: NaN gives the other one, a tie (of zeros, too) the first."""
    value = np.where(is_first | np.isnan(np.real(b)), a, b)
    if np.iscomplexobj(value):
        # at a tie the derivative is the mean of both sides
        tie = np.real(a) == np.real(b)
        return np.where(tie, np.real(value) + 0.5j * (np.imag(a) + np.imag(b)), value)
    return value


def _saturation(x: Any, low: Any, high: Any) -> Any:
    """Hold x between two limits; on one of them the derivative is the mean of both sides. Where they meet or cross: high."""
    r, a, b = np.real(x), np.real(low), np.real(high)
    value = np.where(r < a, low, x)
    value = np.where(b < np.real(value), high, value)
    if np.iscomplexobj(value):
        value = np.where(r == a, np.real(value) + 0.5j * (np.imag(x) + np.imag(low)), value)
        value = np.where(r == b, np.real(value) + 0.5j * (np.imag(x) + np.imag(high)), value)
        value = np.where(b <= a, np.real(value) + 1j * np.imag(high), value)
    return value


def _smaller(a: Any, b: Any, sign: int) -> Any:
    """Return the smaller (sign 1) or larger (-1) of two, NaN where one is NaN."""
    left, right = sign * np.real(a), sign * np.real(b)
    value = np.where(left < right, a, np.where(right <= left, b, a + b))
    if np.iscomplexobj(value):
        value = np.where(left == right, np.real(value) + 0.5j * (np.imag(a) + np.imag(b)), value)
    return value


def _slope_at(x: Any, at: Any, of: Any) -> Any:
    """Return the mean of the slopes on both sides of x."""
    slopes = np.concatenate([[0], np.diff(of) / np.diff(at), [0]]).astype(at.dtype)
    before, after = np.searchsorted(at, x, side="left"), np.searchsorted(at, x, side="right")
    mean = (slopes[before] + slopes[after]) / at.dtype.type(2)
    return np.where(np.isnan(x), at.dtype.type(0), mean)


def _look_up(x: Any, *table: float) -> Any:
    real = np.asarray(np.real(x))
    at, of = np.asarray(table, dtype=real.dtype).reshape(2, -1)
    value = np.interp(real, at, of).astype(real.dtype)[()]
    return value + 1j * (_slope_at(real, at, of) * np.imag(x)) if np.iscomplexobj(x) else value


def _look_up_slope(x: Any, *table: float) -> Any:
    real = np.asarray(np.real(x))
    return _slope_at(real, *np.asarray(table, dtype=real.dtype).reshape(2, -1))


_NUMPY: dict[str, Any] = {
    "_truth": _truth,
    "_if_else_zero": _if_else_zero,
    "_re": np.real,
    "_sqrt": np.sqrt,
    "_sin": np.sin,
    "_cos": np.cos,
    "_tan": np.tan,
    "_asin": _with_derivative(np.arcsin, lambda x: 1.0 / np.sqrt(1.0 - x * x)),
    "_acos": _with_derivative(np.arccos, lambda x: -1.0 / np.sqrt(1.0 - x * x)),
    "_atan": _with_derivative(np.arctan, lambda x: 1.0 / (1.0 + x * x)),
    "_atan2": _complex_atan2,
    "_sinh": np.sinh,
    "_cosh": np.cosh,
    "_tanh": np.tanh,
    "_exp": np.exp,
    "_log": np.log,
    "_pow": np.power,
    "_fabs": lambda x: np.sign(np.real(x)) * x,
    "_sign": lambda x: np.sign(np.real(x)),
    "_floor": lambda x: np.floor(np.real(x)),
    "_ceil": lambda x: np.ceil(np.real(x)),
    "_saturation": _saturation,
    "_minimum": lambda a, b: _smaller(a, b, 1),
    "_maximum": lambda a, b: _smaller(a, b, -1),
    "_look_up": _look_up,
    "_look_up_slope": _look_up_slope,
    "_fmin": lambda a, b: _extreme(a, b, np.real(a) <= np.real(b)),
    "_fmax": lambda a, b: _extreme(a, b, np.real(a) >= np.real(b)),
}

_INFIX_NUMPY = {
    "add": "({0} + {1})",
    "sub": "({0} - {1})",
    "mul": "({0} * {1})",
    "div": "({0} / {1})",
    "neg": "(-{0})",
    "inv": "(1.0 / {0})",
    "sq": "({0} * {0})",
    "twice": "({0} + {0})",
    "lt": "_truth(_re({0}) < _re({1}), {0}, {1})",
    "le": "_truth(_re({0}) <= _re({1}), {0}, {1})",
    "eq": "_truth(_re({0}) == _re({1}), {0}, {1})",
    "ne": "_truth(_re({0}) != _re({1}), {0}, {1})",
    "and": "_truth((_re({0}) != 0) & (_re({1}) != 0), {0}, {1})",
    "or": "_truth((_re({0}) != 0) | (_re({1}) != 0), {0}, {1})",
    "not": "_truth(_re({0}) == 0, {0})",
}

Array = NDArray[Any]


def _lowered(steps: Sequence[Step], outputs: Sequence[Sequence[int]], name: str) -> Callable[..., Any]:
    """Return a function of arrays that gives tuples of steps, and computes only what these need."""
    lines = ["def lowered(*a):"]
    needed = _needed(steps, [item for output in outputs for item in output])
    for index, step in enumerate(steps):
        if index not in needed:
            continue
        if step.operation == "input":
            text = f"a[{step.place[0]}][{step.place[1]}]"
        elif step.operation == "const":
            text = repr(step.value) if np.isfinite(step.value) else f"float('{step.value}')"
        else:
            names = [f"t{item}" for item in step.arguments]
            pattern = _INFIX_NUMPY.get(step.operation)
            text = pattern.format(*names) if pattern else f"_{step.operation}({', '.join(names)})"
        lines.append(f"    t{index} = {text}")
    results = ", ".join("(" + "".join(f"t{item}, " for item in output) + ")" for output in outputs)
    lines.append(f"    return ({results},)")
    space: dict[str, Any] = {**_NUMPY, "__name__": __name__}
    exec(compile("\n".join(lines), f"<{name} in NumPy>", "exec"), space)
    return space["lowered"]  # type: ignore[no-any-return]


def numpy_callable(function: ca.Function) -> Callable[..., tuple[Array, ...]]:
    """Lower an SX function to a NumPy callable, for an oracle that must not know CasADi.

    The callable takes one array for each argument, of shape (n,) or (n, k): k evaluations at once. It accepts complex
    numbers (for derivatives by complex step) and keeps single precision. It returns dense arrays of shape
    (rows, k), or (rows, columns, k) for matrix outputs; without the last axis if no argument had it.
    """
    record = tape(function)
    lowered = _lowered(record.steps, record.outputs, function.name())
    shapes = [function.size_out(index) for index in range(function.n_out())]
    places = [
        (function.sparsity_out(index).row(), function.sparsity_out(index).get_col())
        for index in range(function.n_out())
    ]

    def evaluate(*arguments: Array) -> tuple[Array, ...]:
        arrays = [np.asarray(item) for item in arguments]
        batch = max((item.shape[1] for item in arrays if item.ndim == 2), default=None)
        kind = np.result_type(*arrays, np.float32) if arrays else np.dtype(float)
        if batch is not None:
            arrays = [np.broadcast_to(item[:, None], (len(item), batch)) if item.ndim < 2 else item for item in arrays]
        answers = []
        with np.errstate(all="ignore"):
            values = lowered(*arrays)
        for value, (rows, columns), (row, column) in zip(values, shapes, places, strict=True):
            dense = np.zeros((rows, columns) + (() if batch is None else (batch,)), dtype=kind)
            for item, i, j in zip(value, row, column, strict=True):
                dense[i, j] = item
            answers.append(dense[:, 0] if columns == 1 else dense)
        return tuple(answers)

    return evaluate


# ---------------------------------------------------------------------------------------------------------------------
# Pieces

MOST_PIECES = 16
"""Pieces of one table that are told apart; of a longer one, neighbours count as one."""


@dataclass(frozen=True)
class PieceStep:
    """A piecewise function on a tape.

    Attributes
    ----------
    operation : str
        Which.
    number : int
        Its number among those of the tape.
    depends : tuple of (argument, element)
        The inputs that its first argument depends on.
    """

    operation: str
    number: int
    depends: tuple[tuple[int, int], ...]

    def piece(self, arguments: Sequence[float]) -> str:
        """Return in words on which piece its arguments are; empty for NaN."""
        x = arguments[0]
        if any(math.isnan(item) for item in arguments):
            return ""
        kinks = self.kinks(arguments)
        if self.operation in TABLES and len(kinks) > MOST_PIECES:
            k = int(np.searchsorted(kinks, x, side="right"))
            return f"{self.operation} {self.number}: piece {-(-k * MOST_PIECES // len(kinks))}"
        k = int(np.searchsorted(kinks, x, side="left"))
        on_it = k < len(kinks) and kinks[k] == x
        return f"{self.operation} {self.number}: {'kink' if on_it else 'piece'} {k}"

    def kinks(self, arguments: Sequence[float]) -> list[float]:
        """Return where its first argument meets kinks, rising."""
        rest = arguments[1:]
        return list(rest[: len(rest) // 2] if self.operation in TABLES else rest)


class Pieces:
    """Tells on which pieces of its piecewise functions a function is evaluated.

    Parameters
    ----------
    function : casadi.Function
        An SX function.
    """

    def __init__(self, function: ca.Function):
        record = tape(function)
        found: dict[tuple[int, ...], int] = {}
        for k, step in enumerate(record.steps):
            if step.operation in PIECEWISE:
                found.setdefault(step.arguments, k)  # a table and its slope at one place count once
        self.steps = [
            PieceStep(record.steps[k].operation, number, _inputs_of(record.steps, record.steps[k].arguments[0]))
            for number, k in enumerate(found.values(), start=1)
        ]
        self._arguments = _lowered(record.steps, list(found), function.name()) if found else None

    def arguments(self, *given: Array) -> list[list[float]]:
        """Return what each piecewise function is called with, in the precision of what is given."""
        if self._arguments is None:
            return []
        with np.errstate(all="ignore"):
            return [[float(item) for item in one] for one in self._arguments(*given)]

    def met(self, *given: Array) -> list[str]:
        """Return the pieces in words."""
        answers = self.arguments(*given)
        return [text for step, one in zip(self.steps, answers, strict=True) if (text := step.piece(one))]


def _inputs_of(steps: Sequence[Step], root: int) -> tuple[tuple[int, int], ...]:
    needed = _needed(steps, [root])
    return tuple(sorted(steps[item].place for item in needed if steps[item].operation == "input"))


def _needed(steps: Sequence[Step], roots: Sequence[int]) -> set[int]:
    """Return the steps that some steps are computed from, and these."""
    waiting, seen = list(roots), set(roots)
    while waiting:
        for item in steps[waiting.pop()].arguments:
            if item not in seen:
                seen.add(item)
                waiting.append(item)
    return seen


# ---------------------------------------------------------------------------------------------------------------------
# Text

_BINDING = {"add": 1, "sub": 1, "div": 2, "inv": 2, "mul": 3, "twice": 3, "neg": 4, "sq": 5, "pow": 5}
_RELATIONS = {"lt": "<", "le": "<=", "eq": "==", "ne": "!=", "and": "and", "or": "or"}


def number_text(value: float) -> str:
    """Return a number as a person writes it."""
    return f"{value:.12g}"


def equation_text(expression: ca.SX, names: Sequence[tuple[ca.SX, str]], longest: int = 900) -> list[str]:
    """Return the text of each element of an expression, for comments.

    Parameters
    ----------
    expression : casadi.SX
        A column vector.
    names : sequence of (symbol vector, name)
        What the symbols are called; an element of a vector is printed as ``name[i]``.
    longest : int
        A longer text is replaced by a count of its operations.
    """
    function = ca.Function("text", [symbol for symbol, _ in names], [ca.densify(expression)])
    record = tape(function)
    sizes = [symbol.numel() for symbol, _ in names]
    texts: list[tuple[str, int]] = []
    for step in record.steps:
        texts.append(_text_of(step, texts, [name for _, name in names], sizes, longest))
    answer = []
    for item in record.outputs[0]:
        text = texts[item][0]
        answer.append(text if len(text) <= longest else f"(an expression of {len(record.steps)} operations)")
    return answer


def _text_of(
    step: Step, texts: list[tuple[str, int]], names: list[str], sizes: list[int], longest: int
) -> tuple[str, int]:
    """Return the text of a step and how tightly it binds."""
    if step.operation == "input":
        argument, element = step.place
        return (names[argument] if sizes[argument] == 1 else f"{names[argument]}[{element}]"), 9
    if step.operation == "const":
        return number_text(step.value), (9 if step.value >= 0 else 4)
    own = _BINDING.get(step.operation, 9)
    arguments = [texts[item] for item in step.arguments]

    def wrapped(index: int, at_least: int) -> str:
        text, binding = arguments[index]
        return text if binding >= at_least else f"({text})"

    if any(len(text) > longest for text, _ in arguments):
        return "." * (longest + 1), 9
    match step.operation:
        case "add":
            return f"{wrapped(0, 1)} + {wrapped(1, 1)}", own
        case "sub":
            return f"{wrapped(0, 1)} - {wrapped(1, 2)}", own
        case "mul":
            return f"{wrapped(0, 3)} {wrapped(1, 5)}", own
        case "div":
            return f"{wrapped(0, 2)} / {wrapped(1, 5)}", own
        case "inv":
            return f"1 / {wrapped(0, 5)}", own
        case "neg":
            return f"-{wrapped(0, 5)}", own
        case "sq":
            return f"{wrapped(0, 6)}^2", own
        case "pow":
            return f"{wrapped(0, 6)}^{wrapped(1, 6)}", own
        case "twice":
            return f"2 {wrapped(0, 5)}", own
        case "if_else_zero":
            return f"({arguments[1][0]} if {arguments[0][0]} else 0)", 9
        case operation if operation in _RELATIONS:
            return f"({arguments[0][0]} {_RELATIONS[operation]} {arguments[1][0]})", 9
        case operation if operation in TABLES:
            count = len(arguments) // 2
            ends = f"{arguments[1][0]} .. {arguments[count][0]}"
            return f"{operation}({arguments[0][0]}, {count} points over {ends})", 9
        case operation:
            return f"{operation}({', '.join(text for text, _ in arguments)})", 9
