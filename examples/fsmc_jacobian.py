"""The Jacobian that Ghanai, Medjghou and Chafaa print (AEEE 16(4), 2018, section 5), beside the one that is derived.

Both are evaluated at many points: an entry is right where they agree at all of them. The points are drawn at random, and the
vehicle is that of set B, of whose coefficients none is zero, so that nothing agrees by chance.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import casadi as ca
import numpy as np
from numpy.typing import NDArray
from plantc.examples.fsmc_quadrotor import SET_B, sampled, vehicle
from plantc.reference import fsmc
from plantc.symbolic import Plant
from plantc.symbolic.discretisation import transition
from plantc.symbolic.expressions import equation_text

Array = NDArray[np.float64]

LOST = ((8, 3), (10, 3), (10, 5))
"""Entries that do not survive in the text of the paper at hand."""

NEAR = 1e-9
"""Two entries are the same where they differ by less, relative to the largest value of the derived one."""


@dataclass(frozen=True)
class Comparison:
    """A printed entry beside the derived one.

    Attributes
    ----------
    row, column : int
        From 1.
    printed, derived : str
        As formulas; `derived` by the names of the plant.
    difference : float
        Largest difference over the points.
    size : float
        Largest magnitude of the derived entry over them.
    points : int
        How many there were.
    """

    row: int
    column: int
    printed: str
    derived: str
    difference: float
    size: float
    points: int

    @property
    def right(self) -> bool:
        """Whether the printed entry is the derivative."""
        return self.difference <= NEAR * self.size


TEXTS = {
    (2, 2): "2 x2 a2 dt + 1",
    (2, 4): "dt (x6 a1 + a3 Om)",
    (2, 6): "x4 a1 dt",
    (4, 2): "dt (x6 a4 + a6 Om)",
    (4, 4): "2 x4 a5 dt + 1",
    (4, 6): "x2 a4 dt",
    (6, 2): "x4 a7 dt",
    (6, 4): "x2 a7 dt",
    (6, 6): "2 x6 a8 dt + 1",
    (8, 1): "dt u1 (C1 C3 C5 / m) / m",
    (8, 5): "dt u1 (C1 C3 C5 / m) / m",
    (8, 8): "a9 dt + 1",
    (10, 1): "-dt u1 C1 C3 S5 / m",
    (10, 10): "a10 dt + 1",
    (12, 1): "-dt u1 C3 S1 / m",
    (12, 3): "-dt u1 C3 S1 / m",
    (12, 12): "a11 dt + 1",
}
"""The printed entries as they stand in the paper; `plantc.reference.fsmc.printed_entries` evaluates them."""


@cache
def _derived() -> tuple[Plant, ca.SX]:
    plant = sampled(vehicle(values=SET_B))
    return plant, transition(plant)[1]


def compare(points: int = 50, seed: int = 1) -> list[Comparison]:
    """Return every printed entry beside the derived one, compared at random points.

    Parameters
    ----------
    points : int
        How many: angles up to 1 rad, rates up to 2 rad/s, thrust 1 to 8 N, a residual speed up to 200 rad/s.
    seed : int
        Of the points.
    """
    plant, F = _derived()
    ours = ca.vertcat(*[F[row - 1, column - 1] for row, column in TEXTS])
    derived = ca.Function("derived", [plant.x, plant.u], [ours])
    rng = np.random.default_rng(seed)
    theirs_at, ours_at = np.empty((points, len(TEXTS))), np.empty((points, len(TEXTS)))
    for k in range(points):
        X = np.tile([1.0, 2.0], 6) * rng.uniform(-1, 1, 12)
        u = np.array([rng.uniform(1, 8), *rng.uniform(-0.3, 0.3, 3), rng.uniform(-200, 200)])
        entries = fsmc.printed_entries(fsmc.SET_B, X, u[:4], u[4])
        theirs_at[k] = [entries[place] for place in TEXTS]
        ours_at[k] = np.asarray(derived(X, u), dtype=float).ravel()
    texts = equation_text(ours, plant.symbol_names())
    answer = []
    for k, (row, column) in enumerate(TEXTS):
        difference = float(np.max(np.abs(theirs_at[:, k] - ours_at[:, k])))
        size = float(np.max(np.abs(ours_at[:, k])))
        answer.append(Comparison(row, column, TEXTS[row, column], texts[k], difference, size, points))
    return answer


def wrong() -> list[Comparison]:
    """Return the printed entries that are not the derivative: their difference, measured."""
    return [item for item in compare() if not item.right]
