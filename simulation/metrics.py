"""What a run is judged by: errors to truth and set point, consistency of the covariance, and whether the plant was kept.

All are vectorised over the steps of a run, and use no matrix product, whose order of summation is a library's.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ..reference import quaternions

Array = NDArray[np.float64]

FAR = 1.0e6
"""A state this far from the set point, or further, is not followed: the run counts as diverged."""


@dataclass(frozen=True)
class StatePlace:
    """A state in the state vector: its name, its size, and "plain", "angle" or "attitude"."""

    name: str
    size: int
    kind: str


@dataclass(frozen=True, eq=False)
class History:
    """What happened in a run; all arrays have one row for each accepted step, k = 1 .. N.

    Attributes
    ----------
    states : tuple of StatePlace
        What the columns of `truth` and `estimate` are.
    point : array (n,)
        The set point.
    truth : array (steps, n)
        State of the plant.
    estimate : array (steps, n) or None
        The controller's estimate of it after the reading of the step; None if it keeps none.
    spread : array (steps, n (n + 1) / 2) or None
        Covariance of the estimation error as it lies in memory: packed upper triangle by rows, of P, or of U and D.
    factored : bool
        Whether `spread` holds U and D (on the diagonal) of P = U D U'.
    nis : dict of str to array (steps,)
        Normalised innovation squared of each sensor.
    commands : array (steps, m)
        What the controller commanded at the end of the step, applied in the next.
    statuses : int array (steps,)
        Positive where a call was degraded.
    asked : int
        Steps that were to be run.
    refused : str
        Status of the call that ended the run early; empty where none did.
    """

    states: tuple[StatePlace, ...]
    point: Array
    truth: Array
    estimate: Array | None
    spread: Array | None
    factored: bool
    nis: Mapping[str, Array]
    commands: Array
    statuses: NDArray[np.int32]
    asked: int
    refused: str = ""


@dataclass(frozen=True)
class Judgement:
    """What became of a run.

    Attributes
    ----------
    outcome : str
        "kept": within the limits at every step; "lost": finite, but it left them; "frozen": a call was refused, or the state
        went beyond 1e6.
    refused : str
        Status of the refused call.
    steps, degraded : int
        Steps that were accepted, and those of them with a positive status.
    metrics : dict of str to float
        See `metrics_of`; NaN for a frozen run.
    """

    outcome: str
    refused: str
    steps: int
    degraded: int
    metrics: dict[str, float] = field(default_factory=dict)


def deviation(states: Sequence[StatePlace], value: Array, origin: Array) -> Array:
    """Return value less origin, (steps, errors): angles wrapped, an attitude as the small rotation between both.

    Parameters
    ----------
    states : sequence of StatePlace
        What the columns are.
    value : array (steps, n)
        States.
    origin : array (steps, n) or (n,)
        What they are compared with.
    """
    if all(state.kind == "plain" for state in states):
        return np.asarray(value - origin)
    origin = np.broadcast_to(origin, value.shape)
    pieces, start = [], 0
    for state in states:
        at = slice(start, start + state.size)
        start += state.size
        if state.kind == "attitude":
            turn = quaternions.product(quaternions.conjugate(origin[:, at].T), value[:, at].T)
            pieces.append(quaternions.small_rotation(np.where(turn[0] < 0, -turn, turn)).T)
            continue
        difference = value[:, at] - origin[:, at]
        if state.kind == "angle":
            difference = difference - 2 * np.pi * np.floor(difference / (2 * np.pi) + 0.5)
        pieces.append(difference)
    return np.concatenate(pieces, axis=1)


def normalised_squares(error: Array, packed: Array) -> Array:
    """Return e' P^-1 e for each step, P packed as its upper triangle by rows.

    By elimination without pivoting, P = L D L' (Golub & Van Loan, "Matrix Computations", 4th ed., alg. 4.1.2), all steps
    at once; NaN where a pivot is not positive, that is, where P is not positive definite.

    Parameters
    ----------
    error : array (steps, n)
        e.
    packed : array (steps, n (n + 1) / 2)
        P.
    """
    steps, n = error.shape
    rows, place = [], 0
    for i in range(n):
        rows.append(np.array(packed[:, place : place + n - i].T, order="C"))
        place += n - i
    e = np.array(error.T, order="C")
    total, definite = np.zeros(steps), np.ones(steps, dtype=bool)
    with np.errstate(all="ignore"):
        for j in range(n):
            pivot = rows[j][0]
            definite &= pivot > 0
            total += e[j] * (e[j] / pivot)
            for i in range(j + 1, n):
                weight = rows[j][i - j] / pivot
                e[i] -= weight * e[j]
                rows[i] -= weight * rows[j][i - j :]
    total[~definite] = np.nan
    return total


def normalised_squares_of_factors(error: Array, packed: Array) -> Array:
    """Return e' P^-1 e for each step, P = U D U', U and D packed by rows with D on the diagonal; see above."""
    n = error.shape[1]
    table = np.zeros((n, n), dtype=int)
    table[np.triu_indices(n)] = np.arange(packed.shape[1])
    e = np.array(error.T, order="C")
    total = np.zeros(len(error))
    with np.errstate(all="ignore"):
        for j in reversed(range(n)):  # U y = e from the last row up; then the sum of y^2 / d
            total += e[j] * (e[j] / packed[:, table[j, j]])
            for i in range(j):
                e[i] -= packed[:, table[i, j]] * e[j]
    total[~np.all(packed[:, np.diag(table)] > 0, axis=1)] = np.nan
    return total


def metrics_of(history: History) -> dict[str, float]:
    """Return the numbers of a run.

    Returns
    -------
    dict
        ``estimate_to_set_point``: mean over the steps of the sum over the states of (x* - x+)^2. By itself it ranks nothing:
        an estimator that ignores the readings and returns x* scores 0. ``error``: the same of x - x+, the estimation
        error; ``error_<state>``: the part of one state, where there are several. ``regulation``: of x - x*. ``nees``: mean of
        e' P^-1 e, for a consistent filter the number of states. ``nis_<sensor>``: mean NIS, for a consistent filter the size
        of the reading.
    """
    states, point = history.states, history.point
    answer: dict[str, float] = {}
    with np.errstate(all="ignore"):
        if history.estimate is not None:
            error = deviation(states, history.truth, history.estimate)
            answer["estimate_to_set_point"] = _mean_square(deviation(states, history.estimate, point))
            answer["error"] = _mean_square(error)
            if len(states) > 1:
                start = 0
                for state in states:
                    stop = start + (3 if state.kind == "attitude" else state.size)
                    answer[f"error_{state.name}"] = _mean_square(error[:, start:stop])
                    start = stop
        answer["regulation"] = _mean_square(deviation(states, history.truth, point))
        if history.estimate is not None and history.spread is not None:
            squares = normalised_squares_of_factors if history.factored else normalised_squares
            answer["nees"] = float(np.mean(squares(error, history.spread)))
        for name, values in history.nis.items():
            answer[f"nis_{name}"] = float(np.mean(values))
    return answer


def _mean_square(values: Array) -> float:
    return float(np.mean(np.sum(values * values, axis=1)))


def judge(history: History, limits: Mapping[str, float] | None = None) -> Judgement:
    """Return what became of a run.

    Parameters
    ----------
    history : History
        The run.
    limits : dict, optional
        State -> largest distance of the true state from the set point (each element of a vector; of an attitude the
        angle in rad) at which the plant counts as kept. Without any, every finite run is kept.
    """
    truth = deviation(history.states, history.truth, history.point)
    far = [truth]
    if history.estimate is not None:
        far.append(deviation(history.states, history.estimate, history.point))
    steps, degraded = len(history.truth), int(np.sum(history.statuses > 0))
    finite = all(bool(np.all(np.abs(item) < FAR)) for item in far)
    if steps < history.asked or history.refused or not finite:
        names = metrics_of(history) if steps else {}
        return Judgement("frozen", history.refused, steps, degraded, dict.fromkeys(names, float("nan")))
    kept, start = True, 0
    for state in history.states:
        stop = start + (3 if state.kind == "attitude" else state.size)
        if limits and state.name in limits:
            kept = kept and bool(np.all(np.abs(truth[:, start:stop]) <= limits[state.name]))
        start = stop
    return Judgement("kept" if kept else "lost", "", steps, degraded, metrics_of(history))
