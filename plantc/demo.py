"""The picture of the demo: the compiled filter following a simulated quadrotor."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from .codegen import NativeView, Trace, TraceCall
from .symbolic import Block

# Decoupled pole placement for the hover (specs of the paper: the gain of rotor 1; the others differ in signs)
_GAIN_1 = np.array(
    [-7.3335, -8.6322, 10.0549, 10.5921, 170.0012, 91.0721, -39.1675, -6.2937, -34.8936, -6.0010, 133.5099, 63.7206]
)
_FLIP_2 = np.array([-1, -1, 1, 1, 1, 1, 1, 1, -1, -1, -1, -1])
_FLIP_3 = np.array([-1, -1, -1, -1, 1, 1, -1, -1, -1, -1, 1, 1])
_GAIN = np.stack([_GAIN_1, _GAIN_1 * _FLIP_2, _GAIN_1 * _FLIP_3, _GAIN_1 * _FLIP_2 * _FLIP_3])


def follow(block: Block, steps: int = 400, seed: int = 7) -> tuple[Trace, Any]:
    """Run the compiled quadrotor filter on a simulated flight and return (what it answered, the true altitude).

    The quadrotor holds 30 m, from 5 s on 30.4 m. The sensor's noise is 0.1 m; it is missing between 4 and 5 s, and every
    fiftieth reading is far off.
    """
    rng = np.random.default_rng(seed)
    view = NativeView(block)
    oracle: Any = block.oracle
    f = oracle.model.dynamics
    hover = float(np.sqrt(9.81 / (4 * 54.2e-6)))
    x = np.zeros(12)
    x[4] = 30.2
    goal = np.zeros(12)
    calls, truth = [], []
    for k in range(steps):
        goal[4] = 30.4 if k >= 200 else 30.0
        u = hover - _GAIN @ (x - goal)
        x = x + f(x, u, np.zeros(0), np.zeros(0))[0] / 40 + 1e-3 * rng.normal(size=12)
        reading = x + 0.1 * rng.normal(size=12)
        if k % 50 == 49:
            reading[4] += 0.9
        inputs = {f"rotor_{i + 1}": u[i] for i in range(4)}
        calls.append(TraceCall("step", {**inputs, "has_pose": not 160 <= k < 200, "pose": reading}, time=k / 40))
        truth.append(x[4])
    return view.run(Trace("demo", calls)), np.array(truth)


def picture(block: Block, path: Path) -> Path:
    """Draw altitude, estimate and readings into an SVG file and return its path."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    trace, truth = follow(block)
    time = trace.times
    estimate = trace.column("z")
    sigma = np.sqrt(trace.column("covariance")[:, 12 * 4 - 6])  # element (4, 4) of the packed triangle
    readings = np.array([item.inputs["pose"][4] if item.inputs["has_pose"] else np.nan for item in trace.calls])
    gated = np.array([item.status == 1 for item in trace.calls])
    with matplotlib.rc_context({"svg.hashsalt": "plantc"}):
        figure, axes = plt.subplots(figsize=(8, 3.2), layout="constrained")
        axes.plot(time, readings, ".", color="0.75", markersize=3, label="readings")
        axes.plot(time[gated], readings[gated], "x", color="C3", markersize=6, label="gated")
        axes.fill_between(
            time, estimate - 3 * sigma, estimate + 3 * sigma, color="C0", alpha=0.2, linewidth=0, label="3 sigma"
        )
        axes.plot(time, estimate, color="C0", linewidth=1.2, label="compiled filter")
        axes.plot(time, truth, color="k", linewidth=0.8, linestyle="--", label="truth")
        axes.set_xlabel("time, s")
        axes.set_ylabel("altitude, m")
        axes.set_ylim(29.5, 31.7)
        axes.legend(loc="upper right", ncols=5, fontsize=8)
        path.parent.mkdir(parents=True, exist_ok=True)
        figure.savefig(path, metadata={"Date": None, "Creator": "plantc"})
        plt.close(figure)
    return path
