"""Linear systems as Blocks: state space, and rational filters as sections of second order."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from ..reference import controllers as reference
from .analysis import eigenvalues_of
from .block import Block
from .components import Ends, ends_of, finish, matrix_of, rounded_up, seconds, uniform, wandering
from .errors import ModelError
from .plant import identifier
from .signals import WIDE

Array = NDArray[Any]
Matrices = tuple[Array, Array, Array, Array]
Section = tuple[tuple[float, ...], tuple[float, ...]]

METHODS = {"zoh": "zoh", "foh": "foh", "tustin": "bilinear", "euler": "euler", "backward": "backward_diff"}
"""How a continuous system is made discrete -> what SciPy calls it."""

DIGITS = 12
"""Significant digits of numbers that come out of a matrix factorisation: they differ beyond, between machines."""

RESPONSE = 1.0e-6
"""Accepted error of the frequency response of a filter in sections, relative to its peak."""

LONGEST = 100_000
"""Steps after which an impulse response that has not decayed is taken for one that does not."""


# -- state space ------------------------------------------------------------------------------------------------------


def state_space(
    system: Any,
    *,
    dt: float | None = None,
    method: str | None = None,
    prewarp: float | None = None,
    name: str = "state_space",
    ranges: Mapping[str, Ends] | None = None,
    units: Mapping[str, str] | None = None,
    doc: str = "",
) -> Block:
    """Return a linear system x+ = A x + B u, y = C x + D u as a Block; the matrices are folded into the C.

    Parameters
    ----------
    system : control.StateSpace, or (A, B, C, D)
        Its signal names are kept, made C identifiers (``u[0]`` is `u_0`); an output named like a state gets ``_out``. A
        tuple has the names `x_0`, `u_0`, `y_0` ...
    dt : float, optional
        Seconds per step. A discrete `control.StateSpace` has its own.
    method : {"zoh", "foh", "tustin", "euler", "backward"}, optional
        How a continuous system is made discrete: it has to be said. A tuple without it is discrete.
    prewarp : float, optional
        With "tustin": the frequency, in Hz, at which the discrete system is as the continuous one.
    name, doc : str
        Name and meaning of the block.
    ranges : dict, optional
        Name -> (low, high). Default: inputs -1e6 .. 1e6; states and outputs as far as such inputs can take them, or
        -1e6 .. 1e6 where the system is not stable.
    units : dict, optional
        Name -> unit.

    Returns
    -------
    Block
        Entry `step`; a field of the memory for each state, and its initial value a run-time parameter (default 0).

    Raises
    ------
    ModelError
        If shapes do not match, the method is missing, superfluous or not known, or a name is not in the system.

    Notes
    -----
    `scipy.signal.cont2discrete`; what it gives is rounded to 12 digits, so that the C is the same on any machine.
    """
    matrices, labels, own = _read_state_space(name, system, dt, method)
    matrices, step = _discrete(name, matrices, own, dt, method, prewarp)
    A, B, C, D = matrices
    states, inputs = (tuple(identifier(item) for item in group) for group in labels[:2])
    outputs = tuple(f"{item}_out" if item in states else item for item in map(identifier, labels[2]))
    known = {*states, *inputs, *outputs}
    for what, given in (("ranges=", ranges or {}), ("units=", units or {})):
        unknown = sorted(set(given) - known)
        if unknown:
            raise ModelError(f"{name}: {what} names {', '.join(unknown)}; the system has {', '.join(sorted(known))}")
    bounds, told = dict(ranges or {}), dict(units or {})
    block = Block(name, doc=doc or f"linear system with {len(A)} state(s)")
    taken = [block.input(item, unit=told.get(item, ""), range=ends_of(name, bounds.get(item))) for item in inputs]
    sizes = np.array([max(abs(symbol.signal.low[0]), abs(symbol.signal.high[0])) for symbol in taken])
    of_states, of_outputs = _reach(matrices, sizes)
    memory = [
        block.memory(item, unit=told.get(item, ""), range=bounds.get(item, (-far, far)))
        for item, far in zip(states, of_states, strict=True)
    ]
    x, u = ca.vertcat(ca.SX(0, 1), *memory), ca.vertcat(*taken)
    after, y = _sparse(A) @ x + _sparse(B) @ u, _sparse(C) @ x + _sparse(D) @ u
    block.entry(
        "step",
        inputs=taken,
        following={symbol: after[k] for k, symbol in enumerate(memory)},
        outputs={item: y[k] for k, item in enumerate(outputs)},
        output_units={item: told.get(item, "") for item in outputs},
        output_ranges={item: bounds.get(item, (-far, far)) for item, far in zip(outputs, of_outputs, strict=True)},
    )
    block.sample_time = step
    wide = {symbol.signal.name: (symbol.signal.low[0], symbol.signal.high[0]) for symbol in taken}
    law = reference.StateSpace(A, B, C, D, states, inputs, outputs)
    return finish(block, {"step": law}, wandering(wide), memory=uniform(_tenth(block)))


def _read_state_space(
    name: str, system: Any, dt: float | None, method: str | None
) -> tuple[Matrices, tuple[Sequence[str], Sequence[str], Sequence[str]], Any]:
    """Return matrices, labels, and the system's own time step: None continuous, True discrete with none of its own."""
    if all(hasattr(system, item) for item in ("A", "B", "C", "D", "dt", "state_labels")):
        given = system.A, system.B, system.C, system.D
        own = None if system.dt in (0, None) and system.dt is not True else system.dt
        labels: Any = (system.state_labels, system.input_labels, system.output_labels)
    elif isinstance(system, tuple) and len(system) == 4:
        given, own, labels = system, None if method is not None else True, None
    else:
        raise ModelError(f"{name}: the system is {type(system).__name__}; give a control.StateSpace, or (A, B, C, D)")
    A, B, C, D = (matrix_of(name, letter, item) for letter, item in zip("ABCD", given, strict=True))
    n = len(A) if A.size else 0
    A = A.reshape(n, n) if n == 0 else A
    p, m = D.shape
    B, C = (B.reshape(n, m) if B.size == n * m else B), (C.reshape(p, n) if C.size == p * n else C)
    if A.shape != (n, n) or B.shape != (n, m) or C.shape != (p, n) or not D.size:
        shapes = ", ".join(f"{letter} {item.shape}" for letter, item in zip("ABCD", (A, B, C, D), strict=True))
        raise ModelError(f"{name}: the shapes do not match ({shapes}); give A n x n, B n x m, C p x n, D p x m")
    if labels is None:
        labels = tuple([f"{letter}_{k}" for k in range(size)] for letter, size in (("x", n), ("u", m), ("y", p)))
    return (A, B, C, D), labels, own


def _discrete(
    name: str, matrices: Matrices, own: Any, dt: float | None, method: str | None, prewarp: float | None
) -> tuple[Matrices, float]:
    """Return the matrices of the discrete system, and its time step."""
    step = _time_step(name, own, dt, method, prewarp)
    if own is not None:
        return matrices, step
    if not len(matrices[0]):
        return matrices, step
    from scipy.signal import cont2discrete  # here, since scipy.signal takes longer to import than all the rest

    assert method is not None
    made = cont2discrete(matrices, _warped(name, step, prewarp), METHODS[method])[:4]
    A, B, C, D = (_tidied(np.asarray(item, dtype=float)) for item in made)
    return (A, B, C, D), step


def _time_step(name: str, own: Any, dt: float | None, method: str | None, prewarp: float | None) -> float:
    """Return the time step, and complain where dt, method and prewarp do not fit the system."""
    if own is None and method not in METHODS:
        found = "no method is given" if method is None else f"the method is {method!r}"
        raise ModelError(
            f"{name}: the system is continuous and {found}; say how it is made discrete: {', '.join(map(repr, METHODS))}"
        )
    if own is not None and method is not None:
        raise ModelError(f"{name}: the system is discrete and method={method!r} is given; leave method= out")
    if prewarp is not None and method != "tustin":
        raise ModelError(f"{name}: prewarp= goes with method='tustin'; leave it out")
    if own is None or own is True:
        if dt is None:
            raise ModelError(f"{name}: there is no time step; give dt=, the seconds per step")
        return seconds(name, dt)
    if dt is not None and dt != own:
        raise ModelError(f"{name}: dt={dt!r} is given, but the system has {own!r}; leave dt= out")
    return seconds(name, own)


def _warped(name: str, dt: float, prewarp: float | None) -> float:
    """Return the time step with which the bilinear transform keeps a frequency in its place."""
    if prewarp is None:
        return dt
    if not 0 < prewarp < 0.5 / dt:
        raise ModelError(
            f"{name}: prewarp is {prewarp:g} Hz; give more than 0 and less than {0.5 / dt:g} Hz (0.5 / dt)"
        )
    turn = math.pi * prewarp * dt
    return float(f"{dt * math.tan(turn) / turn:.14e}")


# -- rational filters -------------------------------------------------------------------------------------------------


def transfer_function(
    system: Any,
    *,
    dt: float | None = None,
    method: str | None = None,
    prewarp: float | None = None,
    name: str = "transfer_function",
    unit: str = "",
    output_unit: str | None = None,
    range: Ends | None = None,
    output_range: Ends | None = None,
    doc: str = "",
) -> Block:
    """Return a rational filter as a Block; its coefficients are folded into the C.

    Parameters
    ----------
    system : control.TransferFunction, or (numerator, denominator)
        One input, one output; polynomials by falling powers of s or z.
    dt : float, optional
        Seconds per step. A discrete `control.TransferFunction` has its own.
    method : {"zoh", "foh", "tustin", "euler", "backward"}, optional
        How a continuous filter is made discrete: it has to be said. A tuple without it is discrete.
    prewarp : float, optional
        With "tustin": the frequency, in Hz, at which the discrete filter is as the continuous one.
    name, doc : str
        Name and meaning of the block.
    unit, output_unit : str
        Of input and output; the output's is by default the input's.
    range, output_range : (low, high), optional
        Of input and output. Default: -1e6 .. 1e6, and as far as such an input can take the output (-1e6 .. 1e6 where the
        filter is not stable).

    Returns
    -------
    Block
        Input `raw`, output `filtered`, memory `delays`.

    Raises
    ------
    ModelError
        If the filter is improper (it would need readings of the future), is no quotient of polynomials, has more than
        one input or output, the method is missing, superfluous or not known, or rounding spoils its frequency response.

    Notes
    -----
    Transposed direct form II. Up to second order the coefficients are those given, divided by the first of the
    denominator; a continuous filter by "tustin" is computed in rational numbers and then rounded once. A filter of higher
    order becomes a row of sections of second order (`scipy.signal.zpk2sos`), since the roots of a polynomial of high order
    are lost when its coefficients are rounded; theirs are rounded to 12 digits, so that the C is the same on any machine,
    and the frequency response is compared with the one asked for (1e-6 of its peak).
    """
    numerator, denominator, own = _read_transfer_function(name, system, method)
    step = _time_step(name, own, dt, method, prewarp)
    sections = _sections(name, numerator, denominator, step, method, prewarp)
    matrices = cascade(sections)
    ends = ends_of(name, range)
    of_states, of_outputs = _reach(matrices, np.array([max(abs(ends[0]), abs(ends[1]))]))
    order = len(of_states)
    block = Block(name, doc=doc or f"filter of order {order}, transposed direct form II")
    raw = block.input("raw", unit=unit, range=ends)
    stored = ca.SX(0, 1)
    if order:
        delays = block.memory("delays", initial=np.zeros(order), range=(-of_states, of_states), doc="by sections")
        stored = ca.SX(delays)
    filtered, after = _direct_form(sections, ca.SX(raw), stored)
    far = float(of_outputs[0])
    block.entry(
        "step",
        inputs=[raw],
        following={delays: after} if order else {},
        outputs={"filtered": filtered},
        output_units={"filtered": unit if output_unit is None else output_unit},
        output_ranges={"filtered": output_range or (-far, far)},
    )
    block.sample_time = step
    return finish(
        block, {"step": reference.Sections(sections)}, wandering({"raw": ends}), memory=uniform(_tenth(block))
    )


def _direct_form(sections: tuple[Section, ...], signal: ca.SX, stored: ca.SX) -> tuple[ca.SX, ca.SX]:
    """Return (output, following store) of sections in a row, each in transposed direct form II."""
    after, start = ca.SX(0, 1), 0
    for b, a in sections:
        size = len(a) - 1
        own = ca.vertcat(stored[start : start + size], 0)
        start += size
        output = b[0] * signal + own[0]
        for k in range(1, size + 1):
            after = ca.vertcat(after, b[k] * signal - a[k] * output + own[k])
        signal = output
    return signal, after


def _read_transfer_function(name: str, system: Any, method: str | None) -> tuple[Array, Array, Any]:
    """Return numerator, denominator, and the system's own time step as in `_read_state_space`."""
    if all(hasattr(system, item) for item in ("num", "den", "dt", "ninputs", "noutputs")):
        if (system.ninputs, system.noutputs) != (1, 1):
            raise ModelError(
                f"{name}: the system has {system.ninputs} input(s) and {system.noutputs} output(s); take one of each, or "
                "use state_space"
            )
        given = system.num[0][0], system.den[0][0]
        own = None if system.dt in (0, None) and system.dt is not True else system.dt
    elif isinstance(system, tuple) and len(system) == 2:
        given, own = system, None if method is not None else True
    else:
        raise ModelError(
            f"{name}: the system is {type(system).__name__}; give a control.TransferFunction, or (numerator, denominator)"
        )
    polynomials = []
    for what, item in zip(("numerator", "denominator"), given, strict=True):
        row = matrix_of(name, f"the {what}", item)
        if len(row) != 1:
            raise ModelError(f"{name}: the {what} has shape {row.shape}; give one polynomial, by falling powers")
        polynomials.append(np.trim_zeros(row[0], "f"))
    numerator, denominator = polynomials
    if not len(denominator):
        raise ModelError(f"{name}: the denominator is zero; give a polynomial, by falling powers")
    if len(numerator) > len(denominator):
        raise ModelError(
            f"{name}: the filter is improper (numerator of order {len(numerator) - 1}, denominator of order "
            f"{len(denominator) - 1}), and would need readings of the future; add poles, such as a low-pass of the slope"
        )
    return (numerator if len(numerator) else np.zeros(1)), denominator, own


def _sections(
    name: str, numerator: Array, denominator: Array, dt: float, method: str | None, prewarp: float | None
) -> tuple[Section, ...]:
    """Return a discrete filter in sections."""
    step = _warped(name, dt, prewarp)
    order = len(denominator) - 1
    if order <= 2:
        if method is None:
            return (_section(numerator, denominator),)
        if method == "tustin":
            return (_section(*_tustin(numerator, denominator, step)),)
    from scipy.signal import bilinear_zpk, cont2discrete, tf2zpk, zpk2sos

    wanted = _frequencies(dt)
    if method == "tustin":
        z, p, k = bilinear_zpk(*tf2zpk(numerator, denominator), 1.0 / step)
        s = 2j / step * np.tan(np.angle(wanted) / 2)
        asked = np.polyval(numerator, s) / np.polyval(denominator, s)
    else:
        b, a = numerator, denominator
        if method is not None:
            b, a = (np.ravel(item) for item in cont2discrete((numerator, denominator), step, METHODS[method])[:2])
            b = np.where(np.abs(b) < 1e-13 * np.max(np.abs(b)), 0.0, b)  # what SciPy leaves of zeros at infinity
        b = np.trim_zeros(b, "f")
        asked = np.polyval(b, wanted) / np.polyval(a, wanted)
        if order <= 2:
            made = (_section(_tidied(b), _tidied(a)),)
            return _as_asked(name, made, wanted, asked)
        z, p, k = tf2zpk(b, a)
    late = len(p) - len(z)
    rows = []
    for row in zpk2sos(z, p, k):
        b, a = _tidied(row[:3]), _tidied(row[3:])
        size = int(np.max(np.flatnonzero(np.abs(b) + np.abs(a)), initial=0))
        b, a = b[: size + 1], a[: size + 1]
        while late and size and b[-1] == 0 and np.any(b):  # SciPy gives zeros at the origin for those that are missing
            b, late = np.concatenate([[0.0], b[:-1]]), late - 1
        rows.append(_section(b, a))
    rows += [((0.0, 1.0), (1.0, 0.0))] * late
    return _as_asked(name, tuple(rows), wanted, asked)


def _section(numerator: Array, denominator: Array) -> Section:
    """Return a section, its denominator beginning with one, its numerator as long."""
    padded = np.concatenate([np.zeros(len(denominator) - len(numerator)), numerator])
    first = float(denominator[0])
    return tuple(float(item) / first for item in padded), tuple(float(item) / first for item in denominator)


def _tustin(numerator: Array, denominator: Array, dt: float) -> tuple[Array, Array]:
    """Return the bilinear transform of a filter, s = (2/dt) (z - 1)/(z + 1), in rational numbers."""
    order, rate = len(denominator) - 1, 2 / Fraction(dt)

    def product(first: list[Fraction], second: list[int]) -> list[Fraction]:
        answer = [Fraction(0)] * (len(first) + len(second) - 1)
        for i, a in enumerate(first):
            for j, b in enumerate(second):
                answer[i + j] += a * b
        return answer

    def moved(polynomial: Array) -> list[Fraction]:
        total = [Fraction(0)] * (order + 1)
        for power, coefficient in enumerate(reversed(polynomial.tolist())):
            term = [Fraction(coefficient) * rate**power]
            for factor in [[1, -1]] * power + [[1, 1]] * (order - power):
                term = product(term, factor)
            total = [a + b for a, b in zip(total, term, strict=True)]
        return total

    b, a = moved(numerator), moved(denominator)
    if a[0] == 0:
        return np.array([float(item) for item in b]), np.zeros(order + 1)
    return np.array([float(item / a[0]) for item in b]), np.array([float(item / a[0]) for item in a])


def _frequencies(dt: float) -> Array:
    """Return points of the unit circle, from slow to fast."""
    return np.asarray(np.exp(2j * np.pi * np.geomspace(1e-4, 0.49, 200)))


def _as_asked(name: str, sections: tuple[Section, ...], points: Array, asked: Array) -> tuple[Section, ...]:
    """Return the sections if their frequency response is the one asked for."""
    found = np.ones_like(points)
    for b, a in sections:
        found = found * np.polyval(b, points) / np.polyval(a, points)
    error = float(np.max(np.abs(found - asked)) / np.max(np.abs(asked), initial=1e-300))
    if not error <= RESPONSE:
        raise ModelError(
            f"{name}: rounding to {DIGITS} digits and sections of second order move the frequency response by {error:.2g} of "
            "its peak; give the filter as factors of its own (connect several), or a slower time step"
        )
    return sections


def cascade(sections: tuple[Section, ...]) -> Matrices:
    """Return A, B, C, D of sections in a row, the state as in the memory of a `transfer_function`."""
    A, B, C, D = np.zeros((0, 0)), np.zeros((0, 1)), np.zeros((1, 0)), np.ones((1, 1))
    for b, a in sections:
        size = len(a) - 1
        numerator, poles = np.array(b), np.array(a)
        own = np.eye(size, k=1)
        own[:, :1] -= poles[1:, None]
        gain = (numerator[1:] - poles[1:] * numerator[0])[:, None]
        first = np.eye(1, size)
        A = np.block([[A, np.zeros((len(A), size))], [gain @ C, own]])
        B = np.vstack([B, gain @ D])
        C, D = np.hstack([numerator[0] * C, first]), numerator[0] * D
    return A, B, C, D


# -- numbers ----------------------------------------------------------------------------------------------------------


def _reach(matrices: Matrices, sizes: Array) -> tuple[Array, Array]:
    """Return how far inputs of these sizes take states and outputs from rest: sums of magnitudes of impulse responses.

    A tenth more, up to one digit; 1e6 where the responses do not decay.
    """
    A, B, C, D = matrices
    wide = np.full(len(A), WIDE), np.full(len(C), WIDE)
    if len(A) and np.max(np.abs(eigenvalues_of(A))) >= 1 - 1e-9:
        return wide
    states, outputs = np.zeros(len(A)), np.abs(D) @ sizes
    response = B * sizes
    for k in range(LONGEST):
        states += np.sum(np.abs(response), axis=1)
        outputs += np.sum(np.abs(C @ response), axis=1)
        response = A @ response
        if k % 16 == 0 and np.all(np.abs(response) <= 1e-6 * np.max(states, initial=1e-300)):
            break
    else:
        return wide
    return tuple(np.array([rounded_up(1.1 * item) for item in group]) for group in (states, outputs))  # type: ignore


def _tenth(block: Block) -> dict[str, Any]:
    """Return a tenth of each memory field's range about its middle: where random memories are drawn from."""
    answer = {}
    for signal in block.memory_signals:
        low, high = np.array(signal.low), np.array(signal.high)
        answer[signal.name] = (0.5 * (low + high) - 0.05 * (high - low), 0.5 * (low + high) + 0.05 * (high - low))
    return answer


def _tidied(matrix: Array) -> Array:
    """Return numbers rounded to 12 digits, what is rounding beside the largest dropped."""
    size = float(np.max(np.abs(matrix), initial=0.0))
    kept = np.where(np.abs(matrix) < 1e-15 * size, 0.0, matrix)
    return np.array([float(f"{item:.{DIGITS - 1}e}") + 0.0 for item in kept.ravel()]).reshape(matrix.shape)


def _sparse(matrix: Array) -> ca.SX:
    return ca.SX(ca.sparsify(ca.DM(matrix)))
