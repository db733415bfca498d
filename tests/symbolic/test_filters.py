"""Limits and filters: SciPy's filters are the peers; what they store stays within its range; retuning does not jump."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from plantc.codegen.layout import flatten
from scipy import signal

from plantc import (
    InterpretView,
    ModelError,
    NativeView,
    ReferenceView,
    Status,
    cross_check,
    low_pass,
    notch,
    rate_limiter,
    saturation,
)

DT = 0.01
BLOCKS = {
    "saturation": lambda **more: saturation(-1, 1, unit="V", **more),
    "rate_limiter": lambda **more: rate_limiter(2.0, -3.0, dt=DT, unit="m", **more),
    "low_pass_1": lambda **more: low_pass(3.0, dt=DT, unit="V", **more),
    "low_pass_2": lambda **more: low_pass(3.0, dt=DT, order=2, initial=0.5, **more),
    "notch": lambda **more: notch(20.0, 4.0, dt=DT, depth=0.9, **more),
}


def run(block, raw, view=ReferenceView, **params):
    """Return the output of a block for a sequence of inputs, and the memory at the end."""
    view = view(block)
    given = view.params(**params)
    memory, answer = view.init(given), []
    name = block.entries["step"].outputs[0].name
    for value in raw:
        told = view.call("step", memory, view.inputs("step", {"raw": value}), given)
        assert told.status >= 0
        memory = told.memory
        answer.append(float(told.outputs[name]))
    return np.array(answer), memory


@pytest.mark.parametrize("precision", ["double", "float"])
@pytest.mark.parametrize("name", BLOCKS)
def test_all_views_agree(name, precision):
    for more in ({}, {"range": (-10, 10)}):
        block = BLOCKS[name](**more)
        check = cross_check(block, precision, steps=40)
        assert check.passed, [(item.name, str(item.mismatch), item.note) for item in check.failures]
        assert any("reference" in item.name for item in check.results)
        assert check.statuses["OK"] > 3


# -- limits -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("view", [NativeView, InterpretView, ReferenceView])
def test_saturation(view):
    view = view(saturation(-1, 2))
    params = view.params()
    memory = view.init(params)
    for raw, status, limited in ((0.5, 0, 0.5), (2.0, 0, 2.0), (2.5, 2, 2.0), (-7.0, 2, -1.0)):
        answer = view.call("step", memory, view.inputs("step", {"raw": raw}), params)
        assert (answer.status, answer.outputs["limited"]) == (status, limited)
    with pytest.raises(ValueError, match="BAD_PARAM"):
        view.init(view.params(minimum=3.0))
    view.init(view.params(minimum=2.0))  # one value only is allowed


def test_a_limiter_of_rates_follows_when_it_may():
    view = NativeView(rate_limiter(1.0, -2.0, dt=0.5, initial=1.0))
    params, seen = view.params(), []
    memory = view.init(params)
    for raw in (1.25, 9.0, 9.0, 2.0, 2.0, 0.3, -5.0):
        answer = view.call("step", memory, view.inputs("step", {"raw": raw}), params)
        memory = answer.memory
        seen.append((float(answer.outputs["limited"]), answer.status == Status.CLAMPED))
    up, down = 0.5, 1.0
    expected = [
        (1.25, False),
        (1.25 + up, True),
        (1.25 + 2 * up, True),
        (2.0, False),
        (2.0, False),
        (1.0, True),
        (0.0, True),
    ]
    assert seen[:5] == expected[:5]
    assert seen[5:] == [(2.0 - down, True), (2.0 - 2 * down, True)]


# -- filters ----------------------------------------------------------------------------------------------------------

NOISE = np.random.default_rng(5).normal(size=200)


@given(st.floats(0.001, 0.449), st.sampled_from([1, 2]))
def test_a_low_pass_is_that_of_scipy(cutoff, order):
    ours, _ = run(low_pass(cutoff / DT, dt=DT, order=order), NOISE)
    b, a = signal.butter(order, cutoff / DT, fs=1 / DT)
    np.testing.assert_allclose(ours, signal.lfilter(b, a, NOISE), rtol=0, atol=1e-9)


@given(st.floats(0.01, 0.44), st.floats(0.01, 2.0))
def test_a_notch_is_that_of_scipy(frequency, share):
    width = min(share * frequency, 0.4)
    ours, _ = run(notch(frequency / DT, width / DT, dt=DT), NOISE)
    b, a = signal.iirnotch(frequency / DT, frequency / width, fs=1 / DT)
    np.testing.assert_allclose(ours, signal.lfilter(b, a, NOISE), rtol=0, atol=1e-9)


def test_a_notch_takes_out_the_share_it_is_told():
    time = DT * np.arange(1500)
    for depth in (1.0, 0.75, 0.0):
        block = notch(20.0, 4.0, dt=DT, depth=depth)
        ours, _ = run(block, np.sin(2 * np.pi * 20.0 * time), InterpretView)
        peak = np.sqrt(2 * np.mean(ours[-500:] ** 2))
        assert peak == pytest.approx(1 - depth, abs=1e-6)


@pytest.mark.parametrize("make", [lambda: low_pass(3.0, dt=DT), lambda: low_pass(3.0, dt=DT, order=2)])
def test_the_cutoff_may_be_changed_at_run_time(make):
    b, a = signal.butter(1 if len(make().memory_signals) == 1 else 2, 12.0, fs=1 / DT)
    ours, _ = run(make(), NOISE, NativeView, cutoff=12.0)
    np.testing.assert_allclose(ours, signal.lfilter(b, a, NOISE), rtol=0, atol=1e-12)
    view = NativeView(make())
    memory = view.init(view.params())
    for k in range(4000):  # at rest, a change of the cutoff is not seen
        params = view.params(cutoff=3.0 if k < 3000 else 12.0)
        answer = view.call("step", memory, view.inputs("step", {"raw": 5.0}), params)
        memory = answer.memory
        if k >= 2990:
            assert answer.outputs["filtered"] == pytest.approx(5.0, abs=1e-12)


def test_a_filter_starts_where_it_is_told():
    for block in (
        low_pass(3.0, dt=DT, initial=5.0),
        low_pass(3.0, dt=DT, order=2, initial=5.0),
        notch(20, 4, dt=DT, initial=5),
    ):
        ours, _ = run(block, np.full(50, 5.0))
        np.testing.assert_allclose(ours, 5.0, rtol=1e-12)


@pytest.mark.parametrize(
    ("make", "tunings"),
    [
        (lambda: low_pass(3.0, dt=DT, range=(-1, 1)), [{"cutoff": value} for value in (0.1, 3.0, 45.0)]),
        (lambda: low_pass(3.0, dt=DT, order=2, range=(-1, 1)), [{"cutoff": value} for value in (0.1, 3.0, 45.0)]),
        (
            lambda: notch(10.0, 2.0, dt=DT, range=(-1, 1)),
            [{"frequency": f, "width": w} for f in (1.0, 10.0, 45.0) for w in (0.2, 2.0, 20.0)],
        ),
    ],
)
def test_no_input_takes_what_a_filter_stores_out_of_its_range(make, tunings):
    """The largest value that inputs within -1 .. 1 reach is the sum of the magnitudes of the impulse response."""
    block = make()
    view = ReferenceView(block)
    formula = block.oracle.formulas["step"]
    for tuning in tunings:
        params = {name: np.atleast_1d(value) for name, value in flatten(view.params(**tuning)).items()}
        memory = {item.name: np.zeros(1) for item in block.memory_signals}
        total = dict.fromkeys(memory, 0.0)
        for k in range(6000):
            _, memory, _ = formula(memory, {"raw": np.array([1.0 if k == 0 else 0.0])}, params)
            total = {name: value + abs(float(memory[name][0])) for name, value in total.items()}
        for item in block.memory_signals:
            assert total[item.name] <= item.high[0], (tuning, item.name)


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: low_pass(60.0, dt=DT), r"the cutoff is 60 Hz; give more than 0 and at most 45 Hz \(0.45 / dt\)"),
        (lambda: low_pass(0.0, dt=DT), "the cutoff is 0 Hz"),
        (lambda: low_pass(3.0, dt=0.0), "dt is 0.0; give the seconds per step as a positive number"),
        (lambda: low_pass(3.0, dt=DT, order=3), "the order is 3; give 1 or 2, or use transfer_function for more"),
        (lambda: low_pass(3.0, dt=DT, range=(1, 0)), "the range of the signal is 1 .. 0"),
        (lambda: notch(20.0, 50.0, dt=DT), "the width is 50 Hz"),
        (lambda: notch(20.0, 5.0, dt=DT, depth=1.5), "the value 1.5 of parameter 'depth' is outside its range 0 .. 1"),
        (lambda: saturation(1, 1), "the limits are 1 and 1; give the lower one first"),
        (lambda: saturation(-1, 20, range=(-10, 10)), "the value 20 of parameter 'maximum' is outside its range"),
        (lambda: rate_limiter(-1, dt=DT), "rise is -1 and fall 1; give rise as zero or more, fall as zero or less"),
    ],
)
def test_mistakes(make, says):
    with pytest.raises(ModelError, match=says):
        make()
