"""Piecewise-linear functions with defined values and derivatives at kinks: saturation, dead zone, relay, tables.

Each is a scalar CasADi call node with a derivative of its own, so that CasADi, the generated C and the NumPy of the oracle
take the same branch everywhere. At a kink the derivative is the mean of the slopes on both sides. NaN is passed on, where
`fmin` and `fmax` would give the other operand.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import Any

import casadi as ca
import numpy as np

from .errors import ModelError
from .expressions import TABLES

MOST_BREAKPOINTS = 4096
"""Of one table: beyond it, the expression takes CasADi longer than a model is worth."""


def _call_node(
    name: str, arguments: Sequence[ca.SX], value: ca.SX, slopes: Sequence[ca.SX], names: Sequence[str]
) -> ca.Function:
    """Return a function that stays one node of an expression, and is differentiated by the slopes given.

    Its CasADi name is the reserved one (`expressions.CALL_NODES`), by which a tape knows it.
    """
    name = f"plantc_{name}"
    result = ca.SX.sym("result")  # CasADi hands it to a derivative, which does not need it
    derivative = ca.Function(
        f"jac_{name}",
        [*arguments, result],
        [ca.sparsify(item) for item in slopes],
        [*names, "out_result"],
        [f"jac_result_{item}" for item in names],
    )
    options: dict[str, Any] = {
        "never_inline": True, "custom_jacobian": derivative, "jac_penalty": 0, "enable_forward": False,
        "enable_reverse": False,
    }  # fmt: skip
    return ca.Function(name, list(arguments), [value], list(names), ["result"], options)


@lru_cache
def _saturation_node(ordered: bool) -> ca.Function:
    """Return the saturation; `ordered` says that the lower limit is known to be the lower, which makes the slopes shorter."""
    x, low, high = ca.SX.sym("x"), ca.SX.sym("low"), ca.SX.sym("high")
    raised = ca.if_else(x < low, low, x)
    value = ca.if_else(high < raised, high, raised)
    half, under, at_low = ca.logic_and(low <= x, x <= high), x < low, x <= low
    over, at_high = high < x, high <= x
    if not ordered:  # where the limits meet or cross, the value is `high`, and the slopes are its
        half = ca.logic_or(ca.logic_and(low <= x, x < high), ca.logic_and(low < x, x <= high))
        under, at_low, over = (
            ca.logic_and(under, low < high),
            ca.logic_and(at_low, low < high),
            ca.logic_or(over, high <= low),
        )
    inside = ca.if_else(ca.logic_and(low < x, x < high), 1.0, ca.if_else(half, 0.5, 0.0))
    below = ca.if_else(under, 1.0, ca.if_else(at_low, 0.5, 0.0))
    above = ca.if_else(over, 1.0, ca.if_else(at_high, 0.5, 0.0))
    return _call_node("saturation", [x, low, high], value, [inside, below, above], ["x", "low", "high"])


@lru_cache
def _extreme_node(name: str) -> ca.Function:
    a, b = ca.SX.sym("a"), ca.SX.sym("b")
    first, second = (a, b) if name == "minimum" else (b, a)  # the first is taken where it is below the second
    value = ca.if_else(first < second, a, ca.if_else(second <= first, b, a + b))
    of_a = ca.if_else(first < second, 1.0, ca.if_else(first <= second, 0.5, 0.0))
    of_b = ca.if_else(second < first, 1.0, ca.if_else(second <= first, 0.5, 0.0))
    return _call_node(name, [a, b], value, [of_a, of_b], ["a", "b"])


@lru_cache
def _look_up_node(count: int) -> ca.Function:
    """Return the table of so many breakpoints; it takes them and the values as arguments, which are always numbers."""
    x, at, of = ca.SX.sym("x"), ca.SX.sym("at", count), ca.SX.sym("of", count)
    steepness = [(of[k + 1] - of[k]) / (at[k + 1] - at[k]) for k in range(count - 1)]
    held = ca.if_else(x < at[0], at[0], ca.if_else(at[count - 1] < x, at[count - 1], x))
    value = of[0] + steepness[0] * (held - at[0])
    for k in range(1, count):
        piece = of[k] + steepness[k] * (held - at[k]) if k < count - 1 else of[k]
        value = ca.if_else(held >= at[k], piece, value)
    slope_node = _look_up_slope_node(count)
    slopes = [slope_node(x, at, of), ca.SX(1, count), ca.SX(1, count)]
    return _call_node("look_up", [x, at, of], value, slopes, ["x", "at", "of"])


@lru_cache
def _look_up_slope_node(count: int) -> ca.Function:
    x, at, of = ca.SX.sym("x"), ca.SX.sym("at", count), ca.SX.sym("of", count)
    steepness = [ca.SX(0), *[(of[k + 1] - of[k]) / (at[k + 1] - at[k]) for k in range(count - 1)], ca.SX(0)]
    value = ca.SX(0)
    for k in range(count):
        # from breakpoint k on; on it, the mean of the slopes on both sides
        on_it = 0.5 * (steepness[k] + steepness[k + 1])
        value = ca.if_else(x >= at[k], ca.if_else(x <= at[k], on_it, steepness[k + 1]), value)
    flat = [ca.SX(1, 1), ca.SX(1, count), ca.SX(1, count)]
    return _call_node("look_up_slope", [x, at, of], value, flat, ["x", "at", "of"])


def called(operation: str, arguments: Sequence[ca.SX]) -> ca.SX:
    """Return the call of a piecewise function of a tape, its arguments as they stand there.

    Parameters
    ----------
    operation : str
        One of `expressions.PIECEWISE`.
    arguments : sequence of casadi.SX
        Scalars; of a table x, the breakpoints, and the values.
    """
    if operation in TABLES:
        x, *rest = arguments
        count = len(rest) // 2
        node = _look_up_node(count) if operation == "look_up" else _look_up_slope_node(count)
        return ca.SX(node(x, ca.vertcat(*rest[:count]), ca.vertcat(*rest[count:])))
    node = _saturation_node(_are_ordered(*arguments[1:])) if operation == "saturation" else _extreme_node(operation)
    return ca.SX(node(*arguments))


def _are_ordered(low: ca.SX, high: ca.SX) -> bool:
    """Whether two limits are numbers, the first below the second."""
    return low.is_constant() and high.is_constant() and float(low) < float(high)


# ---------------------------------------------------------------------------------------------------------------------
# What a model calls


def saturated(x: Any, low: Any, high: Any) -> ca.SX:
    """Hold a signal between two limits: `low` below, x between, `high` above.

    The derivative is 1 between the limits, 0 outside, 1/2 on a limit; that of a limit is 1 where it holds, 1/2 on it. NaN
    gives NaN.

    Parameters
    ----------
    x : casadi.SX or number
        Scalar, or a vector, of which each element is held.
    low, high : casadi.SX or number
        The limits, scalar or of the size of x; numbers, parameters or expressions. That low < high is the model's business
        where they are no numbers: where it does not hold (low >= high), `high` wins: it is the value, the derivative by it is
        1, and that by x and by `low` is 0.

    Returns
    -------
    casadi.SX
        Of the shape of x.

    Raises
    ------
    ModelError
        If the limits are numbers of which the first is not the smaller, or an argument is no expression or of another size.

    Examples
    --------
    >>> from casadi import SX, Function, jacobian
    >>> x = SX.sym("x")
    >>> y = saturated(10 * x, -1, 1)
    >>> Function("both", [x], [y, jacobian(y, x)])(0.1)
    (DM(1), DM(5))
    """
    ends = [as_expression("saturated", item) for item in (low, high)]
    if all(item.is_constant() for item in ends):
        pairs = zip(*np.broadcast_arrays(*[np.array(ca.DM(item)).ravel() for item in ends]), strict=True)
        for first, second in pairs:
            if not first < second:
                raise ModelError(f"saturated: the limits are {first:g} and {second:g}; give the lower one first")
    return _elementwise("saturated", lambda *own: called("saturation", own), x, low, high)


def dead_zone(x: Any, low: Any, high: Any) -> ca.SX:
    """Return what of a signal lies beyond two limits: x - low below, 0 between, x - high above.

    The derivative is 0 between the limits, 1 outside, 1/2 on a limit. NaN gives NaN.

    Parameters
    ----------
    x : casadi.SX or number
        Scalar or vector.
    low, high : casadi.SX or number
        Ends of the zone.

    Raises
    ------
    ModelError
        As `saturated`.
    """
    return as_expression("dead_zone", x) - saturated(x, low, high)


def relay(x: Any, amplitude: Any = 1.0, *, at_zero: Any = 0.0) -> ca.SX:
    """Return `amplitude` where x > 0, -`amplitude` where x < 0, and at x = 0 what is given (0 by default).

    The derivative by x is 0 everywhere, at the jump too: what a jump does to an estimate no derivative tells. NaN gives NaN.

    Parameters
    ----------
    x : casadi.SX or number
        Scalar or vector.
    amplitude : casadi.SX or number
        Half of the jump.
    at_zero : casadi.SX or number
        Value at x = 0.

    Raises
    ------
    ModelError
        If an argument is no expression.
    """
    signal, size, middle = (as_expression("relay", item) for item in (x, amplitude, at_zero))
    answer = size * ca.sign(signal)
    if middle.is_constant() and not np.any(np.array(ca.DM(middle))):
        return answer
    return answer + ca.if_else(ca.logic_and(signal <= 0, signal >= 0), middle, 0)


def minimum(a: Any, b: Any) -> ca.SX:
    """Return the smaller of two; NaN if one of them is NaN, like `numpy.minimum` and unlike `fmin`.

    The derivative is 1 by the smaller and 0 by the other; 1/2 by each where they are equal.

    Parameters
    ----------
    a, b : casadi.SX or number
        Scalars, or vectors of one size.

    Raises
    ------
    ModelError
        If an argument is no expression, or of another size.
    """
    return _elementwise("minimum", _extreme_node("minimum"), a, b)


def maximum(a: Any, b: Any) -> ca.SX:
    """Return the larger of two; NaN if one of them is NaN, like `numpy.maximum` and unlike `fmax`.

    The derivative is 1 by the larger and 0 by the other; 1/2 by each where they are equal.

    Parameters
    ----------
    a, b : casadi.SX or number
        Scalars, or vectors of one size.

    Raises
    ------
    ModelError
        If an argument is no expression, or of another size.
    """
    return _elementwise("maximum", _extreme_node("maximum"), a, b)


def look_up(x: Any, breakpoints: Any, values: Any) -> ca.SX:
    """Return the piecewise-linear function through points, held at the first and the last value beyond them.

    Exact at the breakpoints. The derivative is the slope of the piece, 0 beyond the ends, and at a breakpoint the mean of
    the slopes on both sides (at an end, half the slope of its piece). NaN gives NaN.

    Parameters
    ----------
    x : casadi.SX or number
        Scalar or vector.
    breakpoints : sequence of float, shape (n,)
        Strictly increasing, two at least; equally spaced or not.
    values : sequence of float, shape (n,)
        What the function is there.

    Raises
    ------
    ModelError
        If they are no numbers, not as many values as breakpoints, too few or too many, or not in order.

    Examples
    --------
    >>> from casadi import SX, Function, jacobian
    >>> x = SX.sym("x")
    >>> drag = look_up(x, [0, 1, 3], [0.0, 0.4, 2.0])
    >>> Function("both", [x], [drag, jacobian(drag, x)])(1)
    (DM(0.4), DM(0.6))
    """
    at, of = _numbers("breakpoints", breakpoints), _numbers("values", values)
    if len(at) != len(of):
        raise ModelError(f"look_up: {len(at)} breakpoints and {len(of)} values; give one value for each breakpoint")
    if not 2 <= len(at) <= MOST_BREAKPOINTS:
        raise ModelError(f"look_up: {len(at)} breakpoints; give 2 to {MOST_BREAKPOINTS}")
    for k in range(len(at) - 1):
        if not at[k] < at[k + 1]:
            raise ModelError(
                f"look_up: breakpoint {k + 1} is {at[k + 1]:g}, and the one before it {at[k]:g}; give them strictly "
                "increasing"
            )
        with np.errstate(over="ignore"):
            steepness = (of[k + 1] - of[k]) / (at[k + 1] - at[k])
        if not np.isfinite(steepness):
            raise ModelError(
                f"look_up: the slope between the breakpoints {at[k]:g} and {at[k + 1]:g} is not finite; move them apart"
            )
    node = _look_up_node(len(at))
    return _mapped(lambda item: ca.SX(node(item, ca.SX(ca.DM(at)), ca.SX(ca.DM(of)))), as_expression("look_up", x))


def _numbers(what: str, given: Any) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Return finite numbers, or say that they are none."""
    try:
        numbers = np.asarray(given, dtype=float)
    except (TypeError, ValueError, RuntimeError, NotImplementedError):
        numbers = np.zeros((0, 0))
    if numbers.ndim != 1 or not np.all(np.isfinite(numbers)):
        raise ModelError(f"look_up: the {what} are {given!r}; give a sequence of finite numbers")
    return numbers


def as_expression(owner: str, item: Any) -> ca.SX:
    """Return an argument as a dense SX expression.

    Raises
    ------
    ModelError
        If it is none.
    """
    try:
        return ca.densify(ca.SX(item))
    except (NotImplementedError, TypeError, RuntimeError):
        raise ModelError(f"{owner}: {item!r} is no SX expression and no number") from None


def _mapped(function: Callable[..., ca.SX], *arguments: ca.SX) -> ca.SX:
    """Return a scalar function of each element; scalars go with every element."""
    shape = next((item.shape for item in arguments if not item.is_scalar()), (1, 1))
    count = shape[0] * shape[1]
    parts = [function(*[item if item.is_scalar() else item[k] for item in arguments]) for k in range(count)]
    return ca.reshape(ca.vertcat(ca.SX(0, 1), *parts), *shape)


def _elementwise(owner: str, node: Callable[..., ca.SX], *given: Any) -> ca.SX:
    arguments = [as_expression(owner, item) for item in given]
    shapes = {item.shape for item in arguments if not item.is_scalar()}
    if len(shapes) > 1:
        raise ModelError(f"{owner}: the arguments have the shapes {sorted(shapes)}; give scalars, or one shape")
    return _mapped(node, *arguments)
