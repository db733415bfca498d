"""Time of the regulator equations, and the cost on a Cortex-M4 of a regulator with a generator of 28 states."""

from __future__ import annotations

import argparse
import json
import os
import tempfile
import time
from pathlib import Path
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


def regulators() -> dict[str, Any]:
    """Return kind of generator -> bytes of text, and the most instructions of a step, over 60 with all readings.

    The quadrotor, references of degree 6 (28 states; 8 for the high-gain observer, of degree 1); each signal has an observer of
    its own, all four the same Block, unless they are read together; and K, Pi and Gamma are folded into the C.
    """
    from plantc.codegen import TargetView
    from plantc.codegen.emulator import Call
    from plantc.codegen.targets import TARGETS
    from plantc.examples.quadrotor_ekf import quadrotor as model
    from plantc.symbolic.output_regulator import output_regulator
    from plantc.symbolic.signal_generators import high_gain_exosystem, kalman_exosystem

    from plantc import NativeView, linearise, lqr, trim

    plant, outputs = model.discretise("euler", dt=DT), ("x", "y", "z", "yaw")
    point = trim(plant, hold=dict.fromkeys(outputs, 0.0))
    linear = linearise(plant, point)
    gain = lqr(linear, Q=100 * np.ones(12), R=1)
    chain, straight = (polynomial("reading", degree).sampled(DT, "euler") for degree in (6, 1))
    noise: dict[str, Any] = {"process_variance": 1e-12, "measurement_variance": 0.01}
    together = kalman_exosystem(
        compose([polynomial(item, 6) for item in outputs]).sampled(DT, "euler"),
        name="generator",
        together=True,
        **noise,
    )
    kinds = {
        "Kalman filter, read together": (6, together),
        "Kalman filter": (6, kalman_exosystem(chain, name="generator", **noise)),
        "Kalman filter in steady state": (6, kalman_exosystem(chain, name="generator", steady=True, **noise)),
        "high-gain observer": (1, high_gain_exosystem(straight, coefficients=(2, 1), epsilon=0.1, name="generator")),
    }
    answer: dict[str, Any] = {}
    for kind, (degree, one) in kinds.items():
        tracks = compose([polynomial(name, degree) for name in outputs]).sampled(DT, "euler")
        solution = francis(linear, tracks)
        generator = one if one is together else dict.fromkeys(outputs, one)
        block = output_regulator(
            plant, point, gain, solution, generator, saturate=True, tunable=False, name="regulator"
        )
        view = TargetView(block, "float", TARGETS["cortex-m4"])
        native, rng, calls = NativeView(block, "float"), np.random.default_rng(0), []
        params = native.params()
        memory = native.init(params)
        for _ in range(60):
            given: dict[str, Any] = {}
            for signal in block.entries["step"].inputs:
                flag = signal.kind.value == "flag"
                given[signal.name] = (
                    True if flag else 0.1 * rng.normal(size=signal.size) if signal.name.startswith("generator") else 0.0
                )
            inputs = native.inputs("step", given)
            calls.append(Call("step", inputs, memory, params))
            result = native.call("step", memory, inputs, params)
            assert result.status >= 0
            memory = result.memory
        view.calls(calls)
        answer[kind] = {"instructions": view.most["step"].instructions, "text": text_of(view), "states": tracks.order}
    return answer


def one_filter() -> dict[str, int]:
    """Return the most instructions of each entry of one filter of 7 states, over 60 steps: where those of the regulator go."""
    from plantc.codegen import TargetView
    from plantc.codegen.emulator import Call
    from plantc.codegen.targets import TARGETS
    from plantc.symbolic.signal_generators import kalman_exosystem

    from plantc import NativeView

    chain = polynomial("reading", 6).sampled(DT, "euler")
    block = kalman_exosystem(chain, name="generator", process_variance=1e-12, measurement_variance=0.01)
    view, native, rng = (
        TargetView(block, "float", TARGETS["cortex-m4"]),
        NativeView(block, "float"),
        np.random.default_rng(0),
    )
    params = native.params()
    memory, calls = native.init(params), []
    for _ in range(60):
        reading = {"reading": 0.1 * rng.normal()}
        for entry, given in (
            ("predict", {}), ("update_reading", reading), ("step", {**reading, "has_reading": True}),
        ):  # fmt: skip
            calls.append(Call(entry, native.inputs(entry, given), memory, params))
        memory = native.call("step", memory, native.inputs("step", {**reading, "has_reading": True}), params).memory
    view.calls(calls)
    return {entry: view.most[entry].instructions for entry in ("predict", "update_reading", "step")}


def text_of(view: Any) -> int:
    """Return the bytes of text of the library that a view runs, with the functions it calls."""

    from plantc.codegen.targets import Sizes, linked_library

    with tempfile.TemporaryDirectory() as name:
        sizes = Sizes.of(linked_library(view.toolchain, view.text, list(view.block.entries), Path(name)))
    assert sizes is not None
    return int(sizes.text)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", action="store_true")
    parser.add_argument(
        "--target", action="store_true", help="regulators on a Cortex-M4, too: arm-none-eabi-gcc and QEMU"
    )
    arguments = parser.parse_args()
    found = measure()
    if arguments.target:
        found["regulators"] = regulators()
        found["one filter"] = one_filter()
    if arguments.json:
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
    for kind, cost in found.get("regulators", {}).items():
        print(
            f"{kind}: {cost['states']} states, {cost['text']} bytes of text, at most {cost['instructions']} instructions a step"
        )
    for entry, instructions in found.get("one filter", {}).items():
        print(f"one filter of 7 states, {entry}: at most {instructions} instructions")


if __name__ == "__main__":
    main()
