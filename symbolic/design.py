"""State feedback by design: gains that place the eigenvalues of A - B K, or minimise a quadratic cost.

Every function checks what it made before it hands it out: a gain that does not do what was asked is a sentence.
"""

from __future__ import annotations

import hashlib
import math
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import (
    hessenberg,
    solve_continuous_are,
    solve_continuous_lyapunov,
    solve_discrete_are,
    solve_discrete_lyapunov,
)
from scipy.optimize import linear_sum_assignment

from .analysis import HAUTUS_TOLERANCE, Linearisation, eigenvalues_of, hautus
from .components import matrix_of
from .errors import ModelError

Array = NDArray[Any]

POLE_TOLERANCE = 1.0e-6
"""Accepted distance of an eigenvalue from the pole asked for, relative to the largest pole (at least 1)."""

RESIDUAL = 1.0e-6
"""Accepted residual of the equation of a linear-quadratic gain, relative."""


@dataclass(frozen=True, eq=False)
class Gain:
    """A state feedback u = u* - K (x - x*), and what it achieves.

    Attributes
    ----------
    gain : ndarray, shape (inputs, n)
        K, in units of input per unit of state. Not rounded; a Block holds it rounded to 9 digits.
    eigenvalues : ndarray, shape (n,)
        Of A - B K, complex: in the order of the poles asked for, else by real and then imaginary part.
    condition : float
        Condition number (2-norm) of the eigenvectors of A - B K, each of unit length: how far a change of K, as by
        rounding, moves the eigenvalues (Bauer and Fike). Infinite, or very large, if there is no basis of them.
    method : str
        How it was found.
    A, B : ndarray
        What it was designed for.
    dt : float or None
        Seconds per step; None for a continuous plant.
    poles : ndarray or None
        Those asked for.
    cost : tuple or None
        (Q, R, N) of a linear-quadratic gain.
    solution : ndarray or None
        P, the solution of its Riccati equation: x' P x is the cost to go.
    """

    gain: Array
    eigenvalues: Array
    condition: float
    method: str
    A: Array = field(repr=False)
    B: Array = field(repr=False)
    dt: float | None
    poles: Array | None = None
    cost: tuple[Array, Array, Array] | None = field(default=None, repr=False)
    solution: Array | None = field(default=None, repr=False)

    def rounded(self) -> Array:
        """Return K rounded to 9 digits, as it goes into a Block and into `design.json`."""
        return np.array([[float(f"{item:.8e}") + 0.0 for item in row] for row in self.gain])

    def source(self) -> str:
        """Return a hash of what was asked for: same question, same hash, on any machine."""
        parts: list[Any] = [self.method, self.dt, digits_of(self.A), digits_of(self.B)]
        if self.poles is not None:
            parts.append(digits_of(np.vstack([self.poles.real, self.poles.imag])))
        if self.cost is not None:
            parts += [digits_of(item) for item in self.cost]
        return hashlib.sha256(repr(parts).encode()).hexdigest()[:16]

    def checked(self, owner: str, given: Any) -> Array:
        """Return another K for the same question, such as that of a `design.json`; refuse one of another size."""
        K = matrix_of(owner, "the gain of design.json", given)
        if K.size != self.gain.size:
            raise ModelError(
                f"{owner}: the gain of design.json has shape {K.shape}; give {self.gain.shape[0]} x {self.gain.shape[1]} "
                "finite numbers, or export with --redesign"
            )
        return K.reshape(self.gain.shape)

    def properties(self, gain: Any = None) -> dict[str, tuple[float, float]]:
        """Return what a gain has to fulfil: name -> (measured, largest accepted).

        Parameters
        ----------
        gain : array, optional
            Another K for the same question, such as that of a `design.json`. Default: this one, rounded.

        Returns
        -------
        dict
            For placed poles the largest distance of an eigenvalue from its pole. What rounding K to 9 digits can do is
            accepted: condition * norm(B) * norm(dK) (Bauer and Fike 1960). For a cost the stability of A - B K and the
            residual of the equation of the gain.
        """
        K = self.rounded() if gain is None else np.asarray(gain, dtype=float).reshape(self.gain.shape)
        values = closed_loop_eigenvalues(self.A, self.B, K)
        answer: dict[str, tuple[float, float]] = {}
        if self.poles is not None:
            moved = _condition(self.A - self.B @ K) * float(np.linalg.norm(self.B, 2)) * 0.5e-8 * np.linalg.norm(K)
            share, _ = _distance(self.poles, values, POLE_TOLERANCE * _scale(self.poles) + float(moved))
            answer["distance of eigenvalues from the poles asked for, of what is accepted"] = (share, 1.0)
        if self.cost is not None:
            answer["residual of the gain equation"] = (_gain_residual(self, K), RESIDUAL)
        measured, limit, what = _stability(values, self.dt)
        answer[f"{what} of A - B K"] = (measured, limit)
        return answer


# -- the system -------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class _System:
    """A pair (A, B), its labels, and the name to complain about."""

    name: str
    A: Array
    B: Array
    dt: float | None
    states: tuple[str, ...]
    inputs: tuple[str, ...]

    @property
    def variable(self) -> str:
        return "s" if self.dt is None else "z"


def _system(given: Any) -> _System:
    """Return (A, B) and labels of a Linearisation, a control.StateSpace, or a tuple (A, B) or (A, B, dt)."""
    if isinstance(given, Linearisation):
        found = given.plant.name, given.A, given.B, given.dt, given.states, given.inputs
    elif all(hasattr(given, item) for item in ("A", "B", "dt", "state_labels", "input_labels")):
        dt = given.dt
        if dt is True:
            raise ModelError(
                f"{given.name}: the discrete system has no numeric time step; give it one: control.ss(A, B, C, D, 0.01)"
            )
        dt = None if dt in (0, None) else float(dt)
        found = str(given.name), given.A, given.B, dt, tuple(given.state_labels), tuple(given.input_labels)
    elif isinstance(given, tuple) and len(given) in (2, 3):
        A, B = (np.atleast_2d(np.asarray(item, dtype=float)) for item in given[:2])
        B = B.T if B.shape[0] == 1 and len(A) > 1 and np.ndim(given[1]) == 1 else B
        dt = given[2] if len(given) == 3 else None
        names = tuple(f"x{k}" for k in range(len(A))), tuple(f"u{k}" for k in range(B.shape[1]))
        found = "(A, B)", A, B, dt, *names
    else:
        raise ModelError(
            f"a design is for a linearisation, and {type(given).__name__} is given; give linearise(plant, point), a "
            "control.StateSpace, (A, B) or (A, B, dt)"
        )
    name, A, B = found[0], np.asarray(found[1], dtype=float), np.asarray(found[2], dtype=float)
    if A.ndim != 2 or A.shape[0] != A.shape[1] or B.ndim != 2 or len(B) != len(A) or 0 in B.shape:
        raise ModelError(f"{name}: A has shape {A.shape} and B {B.shape}; give A n x n and B n x inputs, neither empty")
    if not (np.all(np.isfinite(A)) and np.all(np.isfinite(B))):
        raise ModelError(f"{name}: A or B holds what is no finite number; look at the operating point")
    return _System(name, A, B, found[3], tuple(found[4]), tuple(found[5]))


def _check_reached(system: _System, advice: str) -> None:
    """Refuse a pair with modes that the inputs do not move."""
    rank, needed, _, _, missing = hautus(system.A, system.B, HAUTUS_TOLERANCE)
    if rank < needed:
        raise ModelError(
            f"{system.name}: the inputs do not move the mode(s) at {system.variable} = {_listed(missing)} (rank {rank} of "
            f"{needed}), whose poles cannot be placed; leave those states out, add an input, or {advice}"
        )


def _check_poles(system: _System, poles: Any, size: int, what: str = "states") -> Array:
    """Return the poles asked for as a complex vector, or say what is wrong with them."""
    try:
        asked = np.atleast_1d(np.asarray(poles, dtype=complex)).ravel()
    except (TypeError, ValueError):
        raise ModelError(f"{system.name}: the poles are {poles!r}; give {size} numbers") from None
    if len(asked) != size:
        raise ModelError(f"{system.name}: {len(asked)} pole(s) are given for {size} {what}; give one for each")
    if not np.all(np.isfinite(asked)):
        raise ModelError(f"{system.name}: the poles {_listed(asked)} are not all finite; give finite numbers")
    left = list(asked[asked.imag != 0])
    while left:
        pole = left.pop()
        gaps = [abs(other - pole.conjugate()) for other in left]
        if not gaps or min(gaps) > 1e-12 * max(1.0, abs(pole)):
            raise ModelError(
                f"{system.name}: the pole {_text(pole)} has no conjugate among those given; give both, since a gain is real"
            )
        left.pop(int(np.argmin(gaps)))
    _, limit, _ = _stability(asked, system.dt)
    bad = asked[(np.abs(asked) if system.dt is not None else asked.real) >= limit]
    if len(bad):
        where = "inside the unit circle" if system.dt is not None else "left of the imaginary axis"
        kind = "discrete" if system.dt is not None else "continuous"
        other = "exp(s dt) of a continuous pole s" if system.dt is not None else "log(z) / dt of a discrete pole z"
        raise ModelError(
            f"{system.name}: the pole(s) {_listed(bad)} are not {where}, and the plant is {kind}; give stable poles "
            f"({other}; a pair of arrays is discrete only as (A, B, dt))"
        )
    return asked


def _accepted(system: _System, K: Array, method: str, poles: Array) -> Gain:
    """Return the gain if its eigenvalues are the poles asked for."""
    values = closed_loop_eigenvalues(system.A, system.B, K) if np.all(np.isfinite(K)) else np.full(len(poles), np.nan)
    share, order = _distance(poles, values, POLE_TOLERANCE * _scale(poles))
    condition = _condition(system.A - system.B @ K)
    if not share <= 1.0:
        raise ModelError(
            f"{system.name}: the poles {_listed(poles)} came out as {_listed(values)} (condition of the eigenvectors "
            f"{condition:.3g}), too far off; spread them, ask for less haste, or scale the states"
        )
    return Gain(_frozen(K), _frozen(values[order]), condition, method, system.A, system.B, system.dt, _frozen(poles))


# -- placement --------------------------------------------------------------------------------------------------------


def place(system: Any, poles: Any, *, method: str = "YT") -> Gain:
    """Return a gain that places the eigenvalues of A - B K, robustly.

    With more than one input the gain is not unique; the eigenvectors are chosen near to orthogonal, so that the
    eigenvalues move little when A, B or K do.

    Parameters
    ----------
    system : Linearisation, control.StateSpace, (A, B) or (A, B, dt)
        What is controlled; a pair without dt is continuous.
    poles : sequence of n numbers
        Stable, complex ones in conjugate pairs, each at most as often as B has independent columns.
    method : {"YT", "KNV0"}
        Tits and Yang; or method 0 of Kautsky, Nichols and Van Dooren (real poles).

    Returns
    -------
    Gain
        Its eigenvalues are within 1e-6 of the poles (relative to the largest, at least 1).

    Raises
    ------
    ModelError
        If the inputs do not move every mode, the poles are too few, too many, unstable, lack a conjugate or are repeated
        too often, or if what came out is not what was asked.

    Notes
    -----
    `scipy.signal.place_poles`: Kautsky, Nichols, Van Dooren, "Robust pole assignment in linear state feedback", Int. J.
    Control 41, 1985; Tits, Yang, "Globally convergent algorithms for robust pole assignment", IEEE TAC 41, 1996.

    Examples
    --------
    >>> from plantc.symbolic.design import place
    >>> gain = place(([[1, 0.1], [0, 1]], [[0], [0.1]], 0.1), [0.8, 0.7])
    >>> gain.gain.round(6)
    array([[6., 5.]])
    """
    from scipy.signal import place_poles  # here, since scipy.signal takes longer to import than all the rest

    found = _system(system)
    if method not in ("YT", "KNV0"):
        raise ModelError(f"{found.name}: the method is {method!r}; give 'YT' or 'KNV0'")
    asked = _check_poles(found, poles, len(found.A))
    _check_reached(found, "use lqr, which leaves a stable mode where it is")
    if method == "KNV0" and np.any(asked.imag != 0):
        raise ModelError(f"{found.name}: KNV0 places real poles, and {_listed(asked)} are given; use method='YT'")
    left, sizes, right = np.linalg.svd(found.B, full_matrices=False)
    rank = int(np.sum(sizes > 1e-12 * sizes[0]))
    for pole in asked:
        times = int(np.sum(asked == pole))
        if times > rank:
            raise ModelError(
                f"{found.name}: the pole {_text(pole)} is asked for {times} times, and {rank} independent input(s) place a "
                f"pole at most {rank} time(s) with a basis of eigenvectors; spread them, or use ackermann for one input"
            )
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # robustness stopped improving: the poles are looked at below all the same
            if rank == found.B.shape[1]:
                K = place_poles(found.A, found.B, asked, method=method).gain_matrix
            else:  # columns that depend on one another are too much for SciPy: as many inputs as there are directions
                inner = place_poles(found.A, left[:, :rank] * sizes[:rank], asked, method=method).gain_matrix
                K = right[:rank].T @ inner
    except (ValueError, np.linalg.LinAlgError) as error:
        raise ModelError(f"{found.name}: SciPy could not place {_listed(asked)} ({error}); move the poles") from None
    return _accepted(found, np.asarray(K).real, f"place {method}", asked)


def ackermann(system: Any, poles: Any) -> Gain:
    """Return the gain of one input that places the eigenvalues of A - b K; it is unique.

    Parameters
    ----------
    system : Linearisation, control.StateSpace, (A, B) or (A, B, dt)
        With one input; a pair without dt is continuous.
    poles : sequence of n numbers
        Stable, complex ones in conjugate pairs; repeated as often as you like (all zero is a deadbeat controller).

    Returns
    -------
    Gain
        Its eigenvalues are within 1e-6 of the poles (relative to the largest, at least 1); those of a pole asked for k
        times, which rounding scatters, within the k-th root, and so is their mean.

    Raises
    ------
    ModelError
        As in `place`, and if there is more than one input.

    Notes
    -----
    Ackermann's formula K = e_n' C^-1 p(A) (Ackermann, Regelungstechnik 20, 1972), evaluated where C, the controllability
    matrix, is triangular: A is shifted, scaled, and brought to Hessenberg form by an orthogonal transformation that takes
    b to a multiple of e_1, so that e_n' C^-1 is e_n' over a product of subdiagonal elements and C is never formed; the
    polynomial is evaluated by its roots.

    Examples
    --------
    >>> from plantc.symbolic.design import ackermann
    >>> ackermann(([[0, 1], [0, 0]], [[0], [1]]), [-1, -2]).gain
    array([[2., 3.]])
    """
    found = _system(system)
    if found.B.shape[1] != 1:
        raise ModelError(
            f"{found.name}: ackermann is for one input, and there are {found.B.shape[1]}; use place, or place_chains"
        )
    asked = _check_poles(found, poles, len(found.A))
    _check_reached(found, "use lqr, which leaves a stable mode where it is")
    return _accepted(found, _ackermann(found.A, found.B[:, 0], asked), "ackermann", asked)


def _ackermann(A: Array, b: Array, poles: Array) -> Array:
    """Return the row K (1, n) with det(s I - A + b K) = prod(s - poles)."""
    n = len(A)
    centre = float(np.trace(A)) / n
    shifted = A - centre * np.eye(n)
    norm = float(np.linalg.norm(shifted, 2)) or 1.0
    shifted = shifted / norm
    size = float(np.linalg.norm(b))
    first = np.linalg.qr(np.column_stack([b, np.eye(n)]))[0]  # its first column is b / |b|, up to sign
    hess, turn = hessenberg(first.T @ shifted @ first, calc_q=True)
    basis = first @ turn  # turn leaves e_1 alone
    scale = float(basis[:, 0] @ b) * float(np.prod(np.diag(hess, -1)))
    row = np.zeros(n)
    row[-1] = 1.0
    left = list((poles - centre) / norm)
    while left:
        pole = left.pop()
        if pole.imag == 0:
            row = row @ hess - pole.real * row
        else:
            left.pop(int(np.argmin([abs(other - pole.conjugate()) for other in left])))
            once = row @ hess
            row = once @ hess - 2 * pole.real * once + abs(pole) ** 2 * row
    with np.errstate(all="ignore"):
        return np.asarray(norm * (row / scale) @ basis.T).reshape(1, n) if size and scale else np.full((1, n), np.nan)


def place_chains(system: Any, chains: Mapping[str, tuple[Sequence[Any], Any]], *, mix: Any = None) -> Gain:
    """Return the gain of a plant that splits into chains of one (virtual) input each; it is unique.

    Parameters
    ----------
    system : Linearisation, control.StateSpace, (A, B) or (A, B, dt)
        What is controlled; a pair without dt is continuous.
    chains : dict
        Name of the chain -> (its states, their poles), in the order of the rows of `mix`. States are labels or symbols;
        together they are all the states, each once. The poles of each chain are placed as in `ackermann`.
    mix : array, shape (chains, inputs), optional
        Virtual inputs v = mix (u - u*), such as thrust, roll, pitch and yaw of four rotors; its rows are independent, and
        u - u* = mix' (mix mix')^-1 v. Default: each chain has an input of its own.

    Returns
    -------
    Gain
        K = mix' (mix mix')^-1 K_v, where K_v holds the row of each chain.

    Raises
    ------
    ModelError
        If the states of the chains are not all states, each once; if one chain moves another, or an input moves two;
        and as in `ackermann`.
    """
    found = _system(system)
    n, m = found.B.shape
    M = np.eye(len(chains), m) if mix is None else np.atleast_2d(np.asarray(mix, dtype=float))
    if M.shape != (len(chains), m) or np.linalg.matrix_rank(M) < len(chains):
        raise ModelError(
            f"{found.name}: mix has shape {M.shape} and rank {np.linalg.matrix_rank(M)} for {len(chains)} chains and {m} "
            "inputs; give a row for each chain, independent of the others"
        )
    spread = M.T @ np.linalg.inv(M @ M.T)
    virtual = found.B @ spread
    places = _places(found, {name: states for name, (states, _) in chains.items()})
    labels = list(chains)
    for k, name in enumerate(labels):
        for other in labels:
            if other == name:
                continue
            rows = places[other]
            through_a, through_b = found.A[np.ix_(rows, places[name])], virtual[rows, k]
            if np.max(np.abs(through_a)) > _dust(found.A) or np.max(np.abs(through_b)) > _dust(virtual):
                what = "states" if np.max(np.abs(through_a)) > _dust(found.A) else "virtual input"
                raise ModelError(
                    f"{found.name}: the chain {name!r} moves the chain {other!r} by its {what}, so that they are not "
                    "decoupled; mend mix or the chains, or use place"
                )
    K = np.zeros((len(chains), n))
    asked = np.zeros(0, dtype=complex)
    for k, (name, (_, poles)) in enumerate(chains.items()):
        rows = places[name]
        own = _System(
            f"{found.name}: chain {name!r}", found.A[np.ix_(rows, rows)], virtual[rows, k : k + 1], found.dt,
            tuple(found.states[row] for row in rows), (name,),
        )  # fmt: skip
        given = _check_poles(own, poles, len(rows))
        _check_reached(own, "use lqr")
        K[k, rows] = _ackermann(own.A, own.B[:, 0], given)[0]
        _accepted(own, K[k : k + 1, rows], "ackermann", given)
        asked = np.concatenate([asked, given])
    return _accepted(found, spread @ K, "place_chains", asked)


def _places(system: _System, chains: Mapping[str, Sequence[Any]]) -> dict[str, list[int]]:
    """Return the rows of the states of each chain."""
    answer: dict[str, list[int]] = {}
    taken: dict[str, str] = {}
    for name, states in chains.items():
        rows = []
        for item in [states] if isinstance(states, str) else states:
            label = item if isinstance(item, str) else str(item.signal.name)
            if label not in system.states or label in taken:
                found = (
                    f"also in {taken[label]!r}" if label in taken else f"no state; it has {', '.join(system.states)}"
                )
                raise ModelError(f"{system.name}: the state {label!r} of the chain {name!r} is {found}")
            taken[label] = name
            rows.append(system.states.index(label))
        if not rows:
            raise ModelError(f"{system.name}: the chain {name!r} has no states; give some, or leave it out")
        answer[name] = rows
    left = [label for label in system.states if label not in taken]
    if left:
        raise ModelError(f"{system.name}: {', '.join(left)} are in no chain; add them to one, or use place")
    return answer


# -- linear-quadratic -------------------------------------------------------------------------------------------------


def lqr(system: Any, Q: Any, R: Any, *, N: Any = None) -> Gain:
    """Return the gain that minimises a quadratic cost, continuous or discrete as the system is.

    The cost is the integral (the sum over the steps) of dx' Q dx + du' R du + 2 dx' N du.

    Parameters
    ----------
    system : Linearisation, control.StateSpace, (A, B) or (A, B, dt)
        What is controlled; a pair without dt is continuous.
    Q : (n, n) array, n numbers, or dict
        Weight of the states, positive semidefinite. Numbers are its diagonal; a dict gives it by state (or its label),
        those left out weigh nothing.
    R : (inputs, inputs) array, numbers, or dict
        Weight of the inputs, positive definite.
    N : (n, inputs) array, optional
        Weight of products.

    Returns
    -------
    Gain
        With `solution` P and `cost` (Q, R, N).

    Raises
    ------
    ModelError
        If a weight has another shape, is not symmetric or not definite, an unstable mode is not moved by the inputs, or a
        mode that does not decay is not seen by the cost.

    Notes
    -----
    `scipy.linalg.solve_continuous_are` and `solve_discrete_are` (Laub 1979; van Dooren 1981). Anderson and Moore, "Optimal
    Control: Linear Quadratic Methods", 1990, chapters 2 and 3.

    Examples
    --------
    >>> from plantc.symbolic.design import lqr
    >>> lqr(([[0, 1], [0, 0]], [[0], [1]]), Q=[1, 0], R=1).gain.round(6)
    array([[1.      , 1.414214]])
    """
    found = _system(system)
    n, m = found.B.shape
    q = _weight(found, "Q", Q, found.states)
    r = _weight(found, "R", R, found.inputs)
    cross = np.zeros((n, m)) if N is None else np.asarray(N, dtype=float)
    if cross.shape != (n, m) or not np.all(np.isfinite(cross)):
        raise ModelError(f"{found.name}: N has shape {cross.shape}; give {n} x {m} finite numbers")
    if not np.linalg.eigvalsh(r)[0] > 0:
        raise ModelError(
            f"{found.name}: R is not positive definite (smallest eigenvalue {np.linalg.eigvalsh(r)[0]:.3g}); give every "
            "input a weight"
        )
    rest = q - cross @ np.linalg.solve(r, cross.T)
    lowest = float(np.linalg.eigvalsh(rest)[0])
    if lowest < -1e-12 * float(np.max(np.abs(rest))):
        what = "Q" if N is None else "Q - N R^-1 N'"
        raise ModelError(
            f"{found.name}: {what} is not positive semidefinite (smallest eigenvalue {lowest:.3g}); mend it"
        )
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            solve = solve_continuous_are if found.dt is None else solve_discrete_are
            P = np.asarray(solve(found.A, found.B, q, r, s=cross if N is not None else None))
    except (np.linalg.LinAlgError, ValueError):
        P = np.full((n, n), np.nan)
    K = _gain_of(found.A, found.B, r, cross, P, found.dt)
    values = closed_loop_eigenvalues(found.A, found.B, K) if np.all(np.isfinite(K)) else np.full(n, np.nan + 0j)
    values = values[np.lexsort((values.imag, values.real))]
    gain = Gain(
        _frozen(K), _frozen(values), _condition(found.A - found.B @ K), "lqr", found.A, found.B, found.dt,
        cost=(q, r, cross), solution=_frozen(P),
    )  # fmt: skip
    measured, limit, _ = _stability(values, found.dt)
    if not measured < limit or not _gain_residual(gain, K) <= RESIDUAL:
        raise ModelError(_why_not(found, rest))
    return gain


def _gain_of(A: Array, B: Array, R: Array, N: Array, P: Array, dt: float | None) -> Array:
    """Return the gain that belongs to a solution of the Riccati equation."""
    if not np.all(np.isfinite(P)):
        return np.full((B.shape[1], len(A)), np.nan)
    if dt is None:
        return np.asarray(np.linalg.solve(R, B.T @ P + N.T))
    return np.asarray(np.linalg.solve(R + B.T @ P @ B, B.T @ P @ A + N.T))


def _gain_residual(gain: Gain, K: Array) -> float:
    """Return by how much K misses the equation of the gain, relative, P solved for anew from K by its own cost.

    P is that of the policy K: a Lyapunov (Stein) equation. At the optimum, and only there, the gain of that P is K.
    """
    assert gain.cost is not None
    Q, R, N = gain.cost
    closed = gain.A - gain.B @ K
    if not np.all(np.isfinite(closed)):
        return math.inf
    running = Q - N @ K - K.T @ N.T + K.T @ R @ K
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            if gain.dt is None:
                P = solve_continuous_lyapunov(closed.T, -running)
            else:
                P = solve_discrete_lyapunov(closed.T, running)
    except (np.linalg.LinAlgError, ValueError):
        return math.inf
    better = _gain_of(gain.A, gain.B, R, N, P, gain.dt)
    size = max(float(np.linalg.norm(K)), float(np.finfo(float).tiny))
    return float(np.linalg.norm(better - K)) / size if np.all(np.isfinite(better)) else math.inf


def _weight(system: _System, what: str, given: Any, labels: tuple[str, ...]) -> Array:
    """Return a weight as a symmetric matrix."""
    size = len(labels)
    if isinstance(given, Mapping):
        named = {key if isinstance(key, str) else str(key.signal.name): value for key, value in given.items()}
        unknown = sorted(set(named) - set(labels))
        if unknown:
            raise ModelError(f"{system.name}: {what} names {', '.join(unknown)}; there is {', '.join(labels)}")
        given = [named.get(label, 0.0) for label in labels]
    try:
        matrix = np.asarray(given, dtype=float)
    except (TypeError, ValueError):
        raise ModelError(f"{system.name}: {what} is {given!r}; give numbers") from None
    if matrix.ndim < 2 and matrix.size in (1, size):
        matrix = np.diag(np.broadcast_to(matrix.ravel(), (size,)))
    if matrix.shape != (size, size):
        raise ModelError(f"{system.name}: {what} has shape {matrix.shape}; give {size} numbers, or {size} x {size}")
    if not np.all(np.isfinite(matrix)) or not np.allclose(matrix, matrix.T, rtol=1e-9, atol=0):
        raise ModelError(f"{system.name}: {what} is not a symmetric matrix of finite numbers; mend it")
    return np.asarray(0.5 * (matrix + matrix.T))


def _why_not(system: _System, Q: Array) -> str:
    """Return the sentence for a Riccati equation without a stabilising solution."""
    discrete = system.dt is not None
    _, _, _, _, unmoved = hautus(system.A, system.B, HAUTUS_TOLERANCE)
    bad = [item for item in unmoved if (abs(item) >= 1 if discrete else item.real >= 0)]
    if bad:
        return (
            f"{system.name}: the inputs do not move the mode(s) at {system.variable} = {_listed(np.array(bad))}, which do "
            "not decay, so that no gain stabilises the plant; add an input, or leave those states out"
        )
    _, _, _, _, unseen = hautus(system.A.T, Q, HAUTUS_TOLERANCE)
    bad = [item for item in unseen if (abs(abs(item) - 1) < 1e-6 if discrete else abs(item.real) < 1e-6)]
    if bad:
        return (
            f"{system.name}: the cost does not see the mode(s) at {system.variable} = {_listed(np.array(bad))}, which "
            "neither grow nor decay, so that no optimal gain stabilises the plant; give those states a weight in Q"
        )
    return f"{system.name}: the Riccati equation gave no stabilising gain; scale states and inputs, or change Q and R"


# -- numbers ----------------------------------------------------------------------------------------------------------


def _stability(values: Array, dt: float | None) -> tuple[float, float, str]:
    """Return (measured, limit, its name): the spectral radius, or the largest real part."""
    if dt is None:
        return float(np.max(values.real, initial=-math.inf)), 0.0, "largest real part of an eigenvalue"
    return float(np.max(np.abs(values), initial=0.0)), 1.0, "spectral radius"


def _scale(poles: Array) -> float:
    return max(1.0, float(np.max(np.abs(poles), initial=0.0)))


def _distance(poles: Array, values: Array, tolerance: float) -> tuple[float, Array]:
    """Return (largest distance of a value from its pole as a share of what is accepted, order of the values).

    Poles and values are matched one to one. A pole asked for k times scatters like the k-th root of a disturbance while
    the mean of its values does not (Kato, "Perturbation theory for linear operators", II.2): the one is accepted within
    the k-th root of the tolerance, the other within the tolerance.
    """
    if not np.all(np.isfinite(values)):
        return math.inf, np.arange(len(values))
    rows, columns = linear_sum_assignment(np.abs(poles[:, None] - values[None, :]))
    order = columns[np.argsort(rows)]
    matched, scale, share = values[order], _scale(poles), 0.0
    for pole in np.unique(poles):
        group = poles == pole
        times = int(np.sum(group))
        each = scale * (tolerance / scale) ** (1.0 / times)
        share = max(share, float(np.max(np.abs(matched[group] - pole))) / each)
        share = max(share, abs(complex(np.mean(matched[group])) - complex(pole)) / tolerance)
    return share, order


def closed_loop_eigenvalues(A: Array, B: Array, K: Array) -> Array:
    """Return the eigenvalues of A - B K, complex (n,); elements that are rounding of their own terms are zero."""
    closed = A - B @ K
    terms = np.abs(A) + np.abs(B) @ np.abs(K)
    return eigenvalues_of(np.where(np.abs(closed) <= len(A) * np.finfo(float).eps * terms, 0.0, closed))


def _condition(closed: Array) -> float:
    """Return the condition number of the eigenvectors, each of unit length."""
    if not np.all(np.isfinite(closed)):
        return math.inf
    return float(np.linalg.cond(np.linalg.eig(closed)[1]))


def _dust(matrix: Array) -> float:
    return 1e-12 * float(np.max(np.abs(matrix), initial=0.0))


def digits_of(matrix: Array) -> list[Any]:
    """Return integers that tell matrices apart to 9 digits of their largest element, the same on any machine.

    The odd offsets keep numbers that people write (1, 1/1024) away from where the last bit decides the rounding.
    """
    size = float(np.max(np.abs(matrix), initial=0.0))
    exponent = math.floor(math.log2(size) + 0.2718) if size else 0
    return [exponent, np.floor(np.asarray(matrix) * 2.0**-exponent * 1e9 + 0.3718).astype(int).tolist()]


def _frozen(array: Array) -> Array:
    answer = np.array(array)
    answer.setflags(write=False)
    return answer


def _text(number: complex) -> str:
    return f"{number.real:.6g}" if abs(number.imag) <= 1e-9 * max(1.0, abs(number)) else f"{complex(number):.6g}"


def _listed(values: Array) -> str:
    return ", ".join(_text(item) for item in values[:8]) + (f" and {len(values) - 8} more" if len(values) > 8 else "")
