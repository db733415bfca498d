"""Steps of a closed loop per second: compiled whole and run in one C call, beside the NumPy reference, call by call.

The loop is that of Meda-Campana (IEEE Access 2018): quadrotor, extended Kalman filter, state feedback. Both ways run in this
process, on the same noise, and end in the same state; the ratio is what does not depend much on the machine. Where Octave is
installed the same loop, written in it (closed_loop.m), is run as well.
"""

from __future__ import annotations

import argparse
import json
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from plantc.codegen.batch import Batch
from plantc.examples.quadrotor_ekf import quadrotor_ekf, sampled, set_point
from plantc.simulation import channels, closed_loop, draw, run_batch, simulate
from plantc.symbolic.composition import connect, wires
from plantc.symbolic.controllers import state_feedback
from plantc.symbolic.design import place

from plantc import ReferenceView, linearise

STEPS, REFERENCE_STEPS, OCTAVE_STEPS, REPEATS = 2000, 40, 400, 5


def quickest(call: Callable[[], Any]) -> tuple[float, Any]:
    """Return the seconds of the quickest of some calls, and what it gave."""
    times, answer = [], None
    for _ in range(REPEATS):
        started = time.perf_counter()
        answer = call()
        times.append(time.perf_counter() - started)
    return min(times), answer


def in_octave(noise: Mapping[str, Any], gain: Any, x_o: Any, u_o: Any) -> tuple[float, Any] | None:
    """Return the seconds of the loop in Octave for OCTAVE_STEPS steps, and the last true state; None where there is none.

    Parameters
    ----------
    noise : dict
        Noise -> its values, one row a step.
    gain, x_o, u_o : array
        The state feedback and the set point.
    """
    from scipy.io import savemat

    program = shutil.which("octave-cli") or shutil.which("octave")
    if program is None:
        return None
    process = np.column_stack([noise[f"{state.signal.name}_noise"][:OCTAVE_STEPS] for state in sampled.states])
    given = {"w": process, "v": noise["pose_noise"][:OCTAVE_STEPS], "K": gain, "x_o": x_o, "u_o": u_o}
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "given.mat"
        savemat(file, given)
        script = Path(__file__).with_suffix(".m")
        command = [program, "--no-gui", "--norc", "--quiet", str(script), str(file)]
        said = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    numbers = np.array(said.split(), dtype=float)
    return float(numbers[0]), numbers[1:]


def measure() -> dict[str, float]:
    """Return the figures."""
    states = [state.symbol for state in sampled.states]
    gain = place(linearise(sampled, set_point), np.arange(84, 96) / 100)
    controller = connect(
        {"estimator": quadrotor_ekf, "feedback": state_feedback(sampled, set_point, gain)},
        wires("estimator", "feedback", states) | wires("feedback", "estimator", sampled.inputs, initial=set_point),
        "controller",
    )
    loop = closed_loop(sampled, controller, set_point)
    noise = {channel.name: draw(channel, 1, 0, STEPS) for channel in channels(loop.noises)}
    batch = Batch(loop.text)
    plant, reference = ReferenceView(loop.truth), ReferenceView(loop.controller)
    params = loop.estimate_parameters(loop.point.x)

    fast, whole = quickest(lambda: run_batch(batch, loop.layout, noise, STEPS, params=params, held=loop.held))
    slow, parts = quickest(lambda: simulate(loop, plant, reference, REFERENCE_STEPS, noise=noise, params=params))
    difference = float(np.max(np.abs(whole.truth[:REFERENCE_STEPS] - parts.truth)))
    rates = STEPS / fast, REFERENCE_STEPS / slow
    figures = {
        "steps_per_second_compiled": rates[0],
        "steps_per_second_numpy": rates[1],
        "ratio": rates[0] / rates[1],
        "largest_difference": difference,
    }
    told = in_octave(noise, gain.rounded(), loop.point.x, loop.point.u)
    if told is not None:
        seconds, last = told
        figures["steps_per_second_octave"] = OCTAVE_STEPS / seconds
        figures["ratio_to_octave"] = rates[0] / figures["steps_per_second_octave"]
        figures["largest_difference_octave"] = float(np.max(np.abs(whole.truth[OCTAVE_STEPS - 1] - last)))
    return figures


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    given = parser.parse_args()
    figures = measure()
    if given.json:
        json.dump(figures, sys.stdout)
        return
    print(f"closed loop, quadrotor with extended Kalman filter, {STEPS} steps in one C call, quickest of {REPEATS}")
    print(f"  compiled whole        {figures['steps_per_second_compiled']:12,.0f} steps/s")
    print(f"  NumPy reference       {figures['steps_per_second_numpy']:12,.0f} steps/s")
    print(f"  ratio                 {figures['ratio']:12,.0f}")
    print(f"  largest difference    {figures['largest_difference']:12.1e}  after {REFERENCE_STEPS} steps")
    if "ratio_to_octave" in figures:
        print(f"  Octave                {figures['steps_per_second_octave']:12,.0f} steps/s")
        print(f"  ratio                 {figures['ratio_to_octave']:12,.0f}")
        print(f"  largest difference    {figures['largest_difference_octave']:12.1e}  after {OCTAVE_STEPS} steps")
    else:
        print("  Octave is not installed here, so it is not compared")


if __name__ == "__main__":
    main()
