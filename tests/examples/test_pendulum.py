"""Recovery: after a disturbance the model does not know, with a gate, the filter finds back; without a limit it does not."""

import numpy as np
import pytest
from plantc.codegen import TraceCall
from plantc.examples.pendulum import pendulum_ekf
from scipy.stats import chi2

from plantc import NativeView, Trace

DT = 0.01
GATE = 9.0
KICK = (10.0, 11.0)  # s: an unmodelled torque of 0.5 N m, half as much as gravity can give
END = 30.0
BACK_WITHIN = 1.0  # s after the disturbance


def trace(seed=3):
    """Simulate the pendulum with fine steps, kicked for one second, and return the calls."""
    rng = np.random.default_rng(seed)
    x = np.array([0.3, 0.0])
    calls = []
    for k in range(int(END / DT)):
        t = k * DT
        unknown = 0.5 if KICK[0] <= t < KICK[1] else 0.0
        gust = rng.normal() * np.sqrt(1e-3 / DT)
        for _ in range(10):
            rate = (unknown + gust - 0.2 * 9.81 * 0.5 * np.sin(x[0])) / (0.2 * 0.5**2)
            x = x + DT / 10 * np.array([x[1], rate])
        reading = (x[0] + 0.01 * rng.normal() + np.pi) % (2 * np.pi) - np.pi
        inputs = {"torque": 0.0, "dt": DT, "has_encoder": True, "encoder": reading}
        calls.append(TraceCall("step", inputs, time=t + DT))
    return Trace("kicked", calls)


def nis_after(answer, start, stop):
    """Return the NIS of all readings in a time span."""
    inside = (answer.times > start) & (answer.times <= stop)
    return answer.column("encoder.nis")[inside].astype(float)


def is_consistent(nis):
    """Whether the mean NIS lies within its 99 % bounds."""
    low, high = chi2.ppf([0.005, 0.995], len(nis)) / len(nis)
    return low <= nis.mean() <= high


@pytest.mark.parametrize("precision", ["double", "float"])
def test_with_a_limit_it_is_consistent_again_in_time(precision):
    view = NativeView(pendulum_ekf, precision)
    answer = view.run(trace(), view.params(gate_encoder=GATE, reject_limit=10))
    assert is_consistent(nis_after(answer, 5.0, KICK[0]))
    after = nis_after(answer, KICK[1] + BACK_WITHIN, END)
    assert is_consistent(after), after.mean()
    assert 4 in answer.statuses  # RECOVERED
    errors = [abs(item.memory["theta"][0] - item.inputs["encoder"]) for item in answer.calls[-500:]]
    assert np.median(errors) < 0.03


@pytest.mark.parametrize("precision", ["double", "float"])
def test_without_a_limit_it_is_not(precision):
    view = NativeView(pendulum_ekf, precision)
    answer = view.run(trace(), view.params(gate_encoder=GATE, reject_limit=0))
    assert is_consistent(nis_after(answer, 5.0, KICK[0]))
    assert not is_consistent(nis_after(answer, KICK[1] + BACK_WITHIN, END))
    assert 4 not in answer.statuses
