"""The command filter: its step, where it settles, where Euler would diverge, and its C."""

import math

import numpy as np
import pytest
from plantc.reference.sliding_mode import CommandFilter
from plantc.symbolic.command_filter import highest_frequency

from plantc import ModelError, NativeView, Status, command_filter, cross_check

H = 1e-3
RADIANS = {"unit": "rad", "range": (-0.5, 0.5)}


def run(view, commands, memory=None, params=None):
    """Return the last memory and (value, rate, acceleration) of each step."""
    params = view.params() if params is None else params
    memory, found = view.init(params) if memory is None else memory, []
    for raw in commands:
        answer = view.call("step", memory, view.inputs("step", {"raw": raw}), params)
        assert answer.status == Status.OK
        memory = answer.memory
        found.append([float(answer.outputs[name]) for name in ("value", "rate", "acceleration")])
    return memory, np.array(found)


@pytest.mark.parametrize(("axis", "at", "after"), [
    ((0.01, 0.05), -0.0836137321, (0.01005, 0.0105545072)),
    ((-0.02, 0.03), -0.136111226, (-0.01997, -0.0176444905)),
])  # fmt: skip
def test_one_step_of_the_published_filter(axis, at, after):
    """What comes out is from before the step, which is explicit: q with the old q', q' with the old q''."""
    view = NativeView(command_filter(20.0, dt=H, **RADIANS))
    start = view.init(view.params(filtered_0=axis[0], filtered_rate_0=axis[1]))
    memory, found = run(view, [at], start)
    acceleration = 400 * (at - axis[0]) - 40 * axis[1]
    np.testing.assert_allclose(found[0], [*axis, acceleration], rtol=1e-12)
    np.testing.assert_allclose([memory["filtered"], memory["filtered_rate"]], after, rtol=1e-7)


def test_it_settles_on_the_command_and_does_not_overshoot():
    """Fifty of them at once, by the formula of the oracle (which all views agree with)."""
    rng = np.random.default_rng(0)
    raw, frequency, damping = rng.uniform(-0.5, 0.5, 50), rng.uniform(10, 60, 50), rng.uniform(1, 2, 50)
    memory = {"filtered": np.zeros(50), "filtered_rate": np.zeros(50)}
    highest = np.zeros(50)
    for _ in range(5000):
        _, memory, outputs = CommandFilter(H)(memory, {"raw": raw}, {"frequency": frequency, "damping": damping})
        highest = np.maximum(highest, outputs["value"] / raw)
    assert np.all((highest > 0.999) & (highest < 1 + 1e-9))
    np.testing.assert_allclose(outputs["value"], raw, rtol=1e-4)
    assert np.max(np.abs(outputs["rate"])) + np.max(np.abs(outputs["acceleration"])) < 1e-2


def test_euler_diverges_where_it_says():
    """At damping 0.7 below and above the frequency from which on it does, with real roots too."""
    for damping in (0.7, 1.5):
        limit = highest_frequency(H, damping)
        for factor, grows in ((0.99, False), (1.01, True)):
            memory = {"filtered": np.ones(1), "filtered_rate": np.zeros(1)}
            for _ in range(3000):
                params = {"frequency": np.array(factor * limit), "damping": np.array(damping)}
                _, memory, _ = CommandFilter(H)(memory, {"raw": np.zeros(1)}, params)
            assert (abs(memory["filtered"][0]) > 10) == grows


def test_no_combination_of_its_parameters_diverges():
    for frequency, damping in ((20.0, 1.0), (900.0, 0.7), (1999.0, 1.0), (5.0, 0.1), (1.0, 8.0)):
        ranges = {s.name: (s.low[0], s.high[0]) for s in command_filter(frequency, damping, dt=H).param_signals}
        (low, high), highest = ranges["damping"], ranges["frequency"][1]
        assert low <= damping <= high
        assert frequency <= highest < min(highest_frequency(H, zeta) for zeta in np.linspace(low, high, 50))


def test_retuned_to_its_slowest_while_it_moves_it_stays_in_range():
    """Where it is fastest in a swing over the whole range, with the least damping; at 0 it would drift, and `init` refuses it."""
    block = command_filter(20.0, dt=H, **RADIANS)
    view = NativeView(block)
    slowest = view.params(**{s.name: s.low[0] for s in block.param_signals if s.name in ("frequency", "damping")})
    memory, _ = run(view, 1000 * [-0.5])
    memory, _ = run(view, 50 * [0.5], memory)
    _, found = run(view, 8000 * [0.5], memory, slowest)
    assert np.max(found[:, 0]) > 1.0  # beyond the range of the command by far
    assert found[-1, 0] == pytest.approx(0.5, abs=0.02)
    stopped = view.params(frequency=0.0)
    assert view.call("init", view.memory(), view.inputs("init", {}), stopped).status == Status.BAD_PARAM


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: command_filter(0.0, dt=H), "the frequency is 0.0; give a positive number"),
        (lambda: command_filter(20.0, -1, dt=H), "the damping is -1; give a positive number"),
        (lambda: command_filter(math.inf, dt=H), "the frequency is inf"),
        (lambda: command_filter(20.0, dt=0), "dt is 0; give the seconds per step"),
        (lambda: command_filter(500.0, 0.2, dt=H), "at damping 0.2 the steps of 0.001 s diverge from 400 rad/s on"),
        (
            lambda: command_filter(20.0, dt=H, initial=20, range=(-1, 1)),
            "the value 20 of memory field 'filtered' is outside",
        ),
    ],
)
def test_what_is_no_command_filter(make, says):
    with pytest.raises(ModelError, match=says):
        make()


@pytest.mark.parametrize("precision", ["float", "double"])
def test_all_views_agree(precision):
    check = cross_check(command_filter(20.0, 0.8, dt=H, **RADIANS), precision, steps=40)
    assert check.passed, [(item.name, str(item.mismatch), item.note) for item in check.failures]
    assert check.statuses["OK"] > 60
