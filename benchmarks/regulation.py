"""Time of the regulator equations: the 28-dimensional ones, and how the triangular solver grows beside r (n + m)^3."""

from __future__ import annotations

import argparse
import json
import os
import time
from typing import Any

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # one thread: the time is not that of a busy machine's scheduler

import numpy as np
from plantc.symbolic.exosystems import compose, polynomial
from plantc.symbolic.regulator_equations import LinearModel, francis, linear_model

DT = 0.02


def fastest(model: LinearModel, exosystem: Any, solver: str) -> float:
    """Return the least of several times, in seconds."""
    times = []
    for _ in range(5):
        start = time.perf_counter()
        francis(model, exosystem, solver=solver)
        times.append(time.perf_counter() - start)
    return min(times)


def plant(pairs: int) -> LinearModel:
    """Return `pairs` double integrators, coupled at random: n = 2 pairs, m = pairs, no transmission zero."""
    rng = np.random.default_rng(0)
    A = np.kron(np.eye(pairs), np.eye(2, k=1))
    B = np.kron(np.eye(pairs) + 0.1 * rng.normal(size=(pairs, pairs)) / pairs, [[0.0], [1.0]])
    return linear_model(A, B, np.kron(np.eye(pairs), [[1.0, 0.0]])).sampled(DT, "euler")


def chains(model: LinearModel, count: int) -> Any:
    """Return `count` chains of degree 6 that drive as many outputs of a plant, the rest of them constant."""
    degrees = [6 if k < count else 0 for k in range(len(model.outputs))]
    return compose([polynomial(name, degree) for name, degree in zip(model.outputs, degrees)]).sampled(DT, "euler")


def quadrotor() -> LinearModel:
    """Return the hovering quadrotor of Meda-Campana (IEEE Access 2023), by Euler."""
    k, A, B = 0.0230586643, np.kron(np.eye(6), np.eye(2, k=1)), np.zeros((12, 4))
    A[1, 8], A[3, 6] = 9.81, -9.81
    B[5], B[7] = k, k * 0.24 / 8.1e-3 * np.array([-1, -1, 1, 1])
    B[9] = k * 0.24 / 8.1e-3 * np.array([-1, 1, 1, -1])
    B[11] = 0.0329563572 * np.array([1, -1, 1, -1])
    return linear_model(A, B, np.eye(12)[[0, 2, 4, 10]]).sampled(DT, "euler")


def measure() -> dict[str, Any]:
    """Return milliseconds for 28 dimensions by solver, and times beside r (n + m)^3 as sizes grow."""
    model = quadrotor()
    answer: dict[str, Any] = {
        "milliseconds_28": {name: 1e3 * fastest(model, chains(model, 4), name) for name in ("schur", "kronecker")}
    }
    for what, sizes in (
        ("more exosystem states", [(16, 1), (16, 4), (16, 16)]),
        ("a larger plant", [(16, 8), (32, 8), (64, 8)]),
    ):
        rows = []
        for pairs, count in sizes:
            model = plant(pairs)
            exosystem = chains(model, count)
            size, r = 3 * pairs, exosystem.order
            seconds = fastest(model, exosystem, "schur")
            rows.append({"n+m": size, "r": r, "milliseconds": 1e3 * seconds, "bound": r * size**3})
        first = rows[0]
        for row in rows:
            row["growth of the bound"] = row["bound"] / first["bound"]
            row["growth of the time"] = row["milliseconds"] / first["milliseconds"]
        answer[what] = rows
    return answer


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", action="store_true")
    found = measure()
    if parser.parse_args().json:
        print(json.dumps(found))
        return
    for name, value in found["milliseconds_28"].items():
        print(f"28 dimensions, {name}: {value:.2f} ms")
    for what in ("more exosystem states", "a larger plant"):
        for row in found[what]:
            print(
                f"{what}: n + m = {row['n+m']}, r = {row['r']}: {row['milliseconds']:.2f} ms; time grew "
                f"{row['growth of the time']:.2f} times, r (n + m)^3 {row['growth of the bound']:.1f} times"
            )


if __name__ == "__main__":
    main()
