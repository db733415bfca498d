"""Exosystems: linear systems without inputs, w+ = S w, that generate references and disturbances."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import block_diag, expm
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components

from .analysis import eigenvalues_of
from .components import matrix_of, seconds, vector_of
from .errors import ModelError

Array = NDArray[Any]


@dataclass(frozen=True, eq=False)
class Exosystem:
    """A generator of signals: w' = S w (continuous) or w+ = S w (discrete), its signals Q w.

    Attributes
    ----------
    matrix : ndarray, shape (r, r)
        S.
    output : ndarray, shape (signals, r)
        Q, a row for each signal.
    signals : tuple of str
        Their names. In the regulator equations a signal named like an output of the plant is its reference, one named
        like an input of the plant a measured disturbance that enters there.
    units : tuple of str
        Of the signals; empty where none was given.
    dt : float or None
        Seconds per step; None for a continuous exosystem.
    eigenvalues : ndarray, shape (r,)
        Of S, complex: known by construction, not computed, unless the matrix was given.
    kind : str
        "constant", "polynomial", "harmonic", "matrix", or "composition".
    method : str
        How it was made discrete: "exact", "euler", or empty.
    parts : tuple of Exosystem
        Of a composition, in the order of the diagonal blocks of S.
    """

    matrix: Array
    output: Array
    signals: tuple[str, ...]
    units: tuple[str, ...]
    dt: float | None
    eigenvalues: Array
    kind: str
    method: str = ""
    parts: tuple[Exosystem, ...] = field(default=(), repr=False)

    @property
    def time(self) -> str:
        """Either "continuous" or "discrete"."""
        return "continuous" if self.dt is None else "discrete"

    @property
    def order(self) -> int:
        """Number r of states."""
        return len(self.matrix)

    @property
    def blocks(self) -> tuple[int, ...]:
        """Sizes of the diagonal blocks of S; one for a part that is not a composition."""
        if not self.parts:
            return (self.order,) if self.order else ()
        return tuple(size for part in self.parts for size in part.blocks)

    @property
    def states(self) -> tuple[str, ...]:
        """A name for each state: that of its signal, and a number."""
        counts: dict[str, int] = {}
        names = []
        for column in range(self.order):
            seen = np.flatnonzero(self.output[:, self._block_of(column)].any(axis=1))
            name = self.signals[int(seen[0])] if len(seen) else "w"
            names.append(f"{name}_{counts.get(name, 0)}")
            counts[name] = counts.get(name, 0) + 1
        return tuple(names)

    def _block_of(self, column: int) -> slice:
        start = 0
        for size in self.blocks:
            if column < start + size:
                return slice(start, start + size)
            start += size
        return slice(0, self.order)

    def sampled(self, dt: float, method: str = "exact") -> Exosystem:
        """Return the discrete exosystem of a continuous one.

        Parameters
        ----------
        dt : float
            Seconds per step.
        method : {"exact", "euler"}
            The matrix exponential (a finite sum for a polynomial, cosine and sine for a harmonic), or I + dt S. Euler
            generates the same sampled polynomials, since (S - I)^(degree + 1) = 0; its states are then forward
            differences divided by powers of dt, not derivatives. A harmonic by Euler grows.

        Raises
        ------
        ModelError
            If it is discrete already, dt or method make no sense, or a frequency is at or beyond half the rate of sampling.
        """
        name = _listed(self.signals)
        if self.dt is not None:
            raise ModelError(
                f"exosystem of {name}: it is discrete already (dt = {self.dt:g} s); sample the continuous one"
            )
        if method not in ("exact", "euler"):
            raise ModelError(f"exosystem of {name}: the method {method!r} is not known; take 'exact' or 'euler'")
        step = seconds(f"exosystem of {name}", dt)
        fastest = float(np.max(np.abs(self.eigenvalues.imag), initial=0.0))
        if fastest * step >= math.pi * (1 - 1e-12):
            raise ModelError(
                f"exosystem of {name}: {fastest:.6g} rad/s sampled every {step:g} s is at or beyond half the rate of sampling "
                f"({math.pi / step:.6g} rad/s), where its samples are those of another signal; take a smaller dt"
            )
        if self.parts:
            parts = tuple(part.sampled(step, method) for part in self.parts)
            values = np.concatenate([part.eigenvalues for part in parts])
            matrix = block_diag(*[part.matrix for part in parts])
            return replace(
                self, matrix=_frozen(matrix), eigenvalues=_frozen(values), dt=step, method=method, parts=parts
            )
        if method == "euler":
            matrix, values = np.eye(self.order) + step * self.matrix, 1.0 + step * self.eigenvalues
        else:
            matrix, values = _exponential(self, step), np.exp(step * self.eigenvalues)
        return replace(self, matrix=_frozen(matrix), eigenvalues=_frozen(values), dt=step, method=method)

    def initial(self, of: Any) -> Array:
        """Return the state w_0 from which the exosystem generates a given signal.

        Parameters
        ----------
        of : number, sequence, or dict
            For a constant its value; for a polynomial its coefficients, lowest power first; for a harmonic (a, b) of
            a cos(wt) + b sin(wt). For a composition signal -> that, a list of them where a signal is a sum of parts;
            what is left out is zero.

        Returns
        -------
        ndarray, shape (r,)
            Derivatives at zero for a polynomial; where it was sampled by Euler, forward differences divided by powers of
            dt, with which its samples are those of the polynomial to rounding.

        Raises
        ------
        ModelError
            If a name is not a signal, there are too many coefficients, or S was given as a matrix.
        """
        if self.kind == "composition":
            return self._initial_of_parts(of)
        name = _listed(self.signals)
        if self.kind == "matrix":
            raise ModelError(f"exosystem of {name}: its matrix was given, so that w_0 is yours to choose")
        try:
            numbers = np.atleast_1d(np.asarray(of, dtype=float)).ravel()
        except (TypeError, ValueError):
            raise ModelError(f"exosystem of {name}: w_0 is {of!r}; give at most {self.order} finite numbers") from None
        if len(numbers) > self.order or not np.all(np.isfinite(numbers)):
            raise ModelError(
                f"exosystem of {name}: {len(numbers)} coefficient(s) are given; give at most {self.order} finite numbers"
            )
        numbers = np.concatenate([numbers, np.zeros(self.order - len(numbers))])
        if self.kind == "harmonic":
            return numbers
        if self.method == "euler":
            assert self.dt is not None
            return np.asarray(_differences(self.order, self.dt) @ numbers)
        return np.array([math.factorial(k) * numbers[k] for k in range(self.order)])

    def _initial_of_parts(self, of: Any) -> Array:
        if not isinstance(of, Mapping):
            raise ModelError(
                f"exosystem of {_listed(self.signals)}: w_0 is given as {of!r}; give signal -> coefficients"
            )
        unknown = sorted(set(of) - set(self.signals))
        if unknown:
            raise ModelError(
                f"exosystem of {_listed(self.signals)}: w_0 names {_listed(unknown)}, which it does not generate"
            )
        pieces = [np.zeros(0)]
        places = {name: [part for part in self.parts if name in part.signals] for name in self.signals}
        for part in self.parts:
            if part.kind == "composition":
                pieces.append(part.initial({name: of[name] for name in part.signals if name in of}))
                continue
            given = [of[name] for name in part.signals if name in of]
            together = places[part.signals[0]] if part.signals else []
            if given and len(together) > 1:
                if not isinstance(given[0], Sequence | np.ndarray) or len(given[0]) != len(together):
                    raise ModelError(
                        f"exosystem of {_listed(self.signals)}: w_0 of {part.signals[0]!r} is {given[0]!r}; the signal is a sum of "
                        f"{len(together)} parts, so give a list of coefficients for each of them"
                    )
                given = [given[0][[item is part for item in together].index(True)]]
            pieces.append(part.initial(given[0]) if given else np.zeros(part.order))
        return np.concatenate(pieces)

    def run(self, initial: Any, steps: int) -> Array:
        """Return the signals of a discrete exosystem at k = 0 .. steps, shape (steps + 1, signals).

        Parameters
        ----------
        initial : array, shape (r,)
            w_0.
        steps : int
            How many.

        Raises
        ------
        ModelError
            If it is continuous, w_0 has another size or is not finite, or `steps` is no whole number.
        """
        if self.dt is None:
            raise ModelError(
                f"exosystem of {_listed(self.signals)}: it is continuous; run sampled(dt), which has a time step"
            )
        if not isinstance(steps, int | np.integer) or steps < 0:
            raise ModelError(
                f"exosystem of {_listed(self.signals)}: steps is {steps!r}; give a whole number, at least 0"
            )
        w, rows = vector_of(f"exosystem of {_listed(self.signals)}", "w_0", initial, self.order), []
        for _ in range(steps + 1):
            rows.append(self.output @ w)
            w = self.matrix @ w
        return np.array(rows)


# -- constructors -----------------------------------------------------------------------------------------------------


def constant(name: str, *, unit: str = "") -> Exosystem:
    """Return the exosystem of a constant signal, continuous until `Exosystem.sampled`.

    Parameters
    ----------
    name, unit : str
        Of the signal.
    """
    return _made("constant", name, unit, np.zeros((1, 1)), np.zeros(1))


def polynomial(name: str, degree: int, *, unit: str = "") -> Exosystem:
    """Return the exosystem of polynomials up to a degree: a chain of degree + 1 integrators.

    Parameters
    ----------
    name, unit : str
        Of the signal.
    degree : int
        Highest power of time, 0 to 20.
    """
    if not isinstance(degree, int) or not 0 <= degree <= 20:
        raise ModelError(f"exosystem of {name!r}: the degree is {degree!r}; give a whole number from 0 to 20")
    return _made("polynomial", name, unit, np.eye(degree + 1, k=1), np.zeros(degree + 1))


def harmonic(name: str, frequency: float, *, unit: str = "") -> Exosystem:
    """Return the exosystem of a cos(wt) + b sin(wt).

    Parameters
    ----------
    name, unit : str
        Of the signal.
    frequency : float
        w in rad/s, positive.
    """
    if not (isinstance(frequency, (int, float)) and math.isfinite(frequency) and frequency > 0):
        raise ModelError(f"exosystem of {name!r}: the frequency is {frequency!r}; give rad/s, a positive number")
    w = float(frequency)
    return _made("harmonic", name, unit, np.array([[0.0, w], [-w, 0.0]]), np.array([1j * w, -1j * w]))


def exosystem(S: Any, Q: Any, signals: Sequence[str], *, dt: float | None = None) -> Exosystem:
    """Return an exosystem of given matrices; its eigenvalues are computed, those of each part of S by themselves.

    Parameters
    ----------
    S : (r, r) array
        How the state goes on: w' = S w, or w+ = S w with `dt`.
    Q : (signals, r) array
        The signals are Q w.
    signals : sequence of str
        Their names.
    dt : float, optional
        Seconds per step; without it the exosystem is continuous.

    Raises
    ------
    ModelError
        If shapes do not match, or a number is not finite.

    Notes
    -----
    The eigenvalues of a Jordan block of size k that is not triangular scatter by the k-th root of rounding; the
    constructors know theirs.
    """
    owner = f"exosystem of {_listed(signals)}"
    matrix, output = matrix_of(owner, "S", S), matrix_of(owner, "Q", Q)
    r = 0 if matrix.size == 0 else len(matrix)
    if matrix.size == 0:
        matrix, output = np.zeros((0, 0)), np.zeros((len(signals), 0))
    if matrix.shape != (r, r) or output.shape != (len(signals), r):
        raise ModelError(
            f"{owner}: S has shape {matrix.shape} and Q {output.shape}; give S square and Q with a row for each of the "
            f"{len(signals)} signal(s) and a column for each state"
        )
    _check_signals(owner, signals)
    step = None if dt is None else seconds(owner, dt)
    names = tuple(signals)
    return Exosystem(
        _frozen(matrix), _frozen(output), names, ("",) * len(names), step, _frozen(eigenvalues_of(matrix)), "matrix"
    )


def compose(parts: Sequence[Exosystem], *, dt: float | None = None) -> Exosystem:
    """Return exosystems side by side: S = blkdiag(S_1, S_2, ...), all their signals.

    Parameters
    ----------
    parts : sequence of Exosystem
        With signals of different names, and of one time base.
    dt : float, optional
        Time step where there is no part to have one.

    Raises
    ------
    ModelError
        If the time bases differ, or two parts generate the same signal: `superpose` is for a signal that is a sum.
    """
    names = [name for part in parts for name in part.signals]
    step = _common_time(parts, dt)
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise ModelError(f"exosystem: {_listed(twice)} is generated by two parts; superpose([...]) adds parts up")
    output = block_diag(*[part.output for part in parts]) if parts else np.zeros((0, 0))
    return _joined(parts, tuple(names), tuple(unit for part in parts for unit in part.units), output, step)


def superpose(parts: Sequence[Exosystem]) -> Exosystem:
    """Return the exosystem of one signal that is the sum of those of its parts, such as two harmonics.

    Parameters
    ----------
    parts : sequence of Exosystem
        Each with one signal, all of the same name, and of one time base.

    Raises
    ------
    ModelError
        If the names or the time bases differ.
    """
    parts = [item for part in parts for item in (part.parts or (part,))]
    names = {part.signals for part in parts}
    if len(names) != 1 or len(next(iter(names))) != 1:
        raise ModelError(
            f"exosystem: the parts of a sum generate {', '.join(_listed(item) for item in sorted(names))}; give parts "
            "with one signal each, all of the same name"
        )
    output = np.hstack([part.output for part in parts])
    return _joined(parts, parts[0].signals, parts[0].units, output, _common_time(parts, None))


def _joined(
    parts: Sequence[Exosystem], names: tuple[str, ...], units: tuple[str, ...], output: Array, dt: float | None
) -> Exosystem:
    matrix = block_diag(*[part.matrix for part in parts]) if parts else np.zeros((0, 0))
    values = np.concatenate([np.zeros(0, dtype=complex), *[part.eigenvalues for part in parts]])
    methods = {part.method for part in parts}
    return Exosystem(
        _frozen(matrix), _frozen(output), names, units, dt, _frozen(values), "composition",
        methods.pop() if len(methods) == 1 else "", tuple(parts),
    )  # fmt: skip


def _common_time(parts: Sequence[Exosystem], dt: float | None) -> float | None:
    """Return the time step that all parts share."""
    steps = {part.dt for part in parts}
    if len(steps) > 1:
        told = ", ".join(f"{_listed(part.signals)} {time_text(part.dt)}" for part in parts)
        raise ModelError(f"exosystem: its parts do not share a time base ({told}); sample all of them alike")
    own = steps.pop() if steps else None if dt is None else seconds("exosystem", dt)
    if dt is not None and own != dt:
        raise ModelError(f"exosystem: dt={dt!r} is given, but its parts are {time_text(own)}; leave dt= out")
    return own


def _made(kind: str, name: str, unit: str, S: Array, eigenvalues: Array) -> Exosystem:
    _check_signals("exosystem", (name,))
    output = np.eye(1, len(S))
    return Exosystem(_frozen(S), _frozen(output), (name,), (unit,), None, _frozen(eigenvalues.astype(complex)), kind)


def _check_signals(owner: str, names: Sequence[str]) -> None:
    bad = [name for name in names if not (isinstance(name, str) and name.isidentifier())]
    if bad or len(set(names)) < len(names):
        raise ModelError(f"{owner}: the signals are named {_listed(names)}; give identifiers, no two alike")


# -- helpers ----------------------------------------------------------------------------------------------------------


def _exponential(part: Exosystem, dt: float) -> Array:
    """Return exp(S dt): in closed form where the constructor is known."""
    if part.kind in ("constant", "polynomial"):
        size = part.order
        return sum((np.eye(size, k=k) * (dt**k / math.factorial(k)) for k in range(size)), np.zeros((size, size)))
    if part.kind == "harmonic":
        angle = part.matrix[0, 1] * dt
        return np.array([[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]])
    return np.asarray(expm(part.matrix * dt)) if part.order else part.matrix


def _differences(size: int, dt: float) -> Array:
    """Return the forward differences at zero of the samples of t^j (a column each), divided by powers of dt."""
    table = np.zeros((size, size))
    for i in range(size):
        for j in range(i, size):
            whole = sum((-1) ** (i - k) * math.comb(i, k) * k**j for k in range(i + 1))
            table[i, j] = whole * dt ** (j - i)
    return table


def parts_of(S: Array) -> list[Array]:
    """Return the states of each part of an exosystem that has nothing to do with the others, by their structure."""
    if not len(S):
        return []
    count, label = connected_components(csr_matrix(S != 0), directed=False)
    return [np.flatnonzero(label == index) for index in range(count)]


def time_text(dt: float | None) -> str:
    """Return a time base in words."""
    return "continuous" if dt is None else f"discrete with dt = {dt:g} s"


def _listed(names: Sequence[Any]) -> str:
    return ", ".join(map(repr, names)) or "nothing"


def _frozen(array: Array) -> Array:
    answer = np.array(array)
    answer.setflags(write=False)
    return answer
