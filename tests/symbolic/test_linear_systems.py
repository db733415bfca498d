"""State space and rational filters: SciPy and python-control are the peers; what cannot be built is a sentence."""

import control
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from plantc.symbolic import linear_systems
from scipy import signal

from plantc import ModelError, ReferenceView, cross_check, state_space, transfer_function

DT = 0.05
RNG = np.random.default_rng(2)
NOISE = RNG.uniform(-1, 1, size=(150, 2))
SWING = control.ss(
    [[0, 1], [-4, -0.5]], [[0, 0], [1, 2]], [[1, 0], [0, 1]], [[0, 0.1], [0, 0]],
    states=["angle", "rate"], inputs=["push[0]", "push[1]"], outputs=["angle", "speed"],
)  # fmt: skip
SLOW = control.tf([1, 0.2], [1, 1.4, 1])
BLOCKS = {
    "state_space": lambda: state_space(SWING, dt=DT, method="zoh", ranges={"push_0": (-1, 1), "push_1": (-1, 1)}),
    "second_order": lambda: transfer_function(SLOW, dt=DT, method="tustin", range=(-1, 1)),
    "fifth_order": lambda: transfer_function(signal.butter(5, 1.0, fs=1 / DT), dt=DT, range=(-1, 1)),
    "integrator": lambda: transfer_function(([DT], [1, -1]), dt=DT, range=(-1, 1), output_range=(-100, 100)),
    "gain": lambda: transfer_function(([3.0], [2.0]), dt=DT, range=(-1, 1)),
    "delay": lambda: transfer_function(([1], [1, 0, 0, 0]), dt=DT, range=(-1, 1)),
}


def run(block, raw):
    """Return the outputs of a block, (steps, outputs), for inputs (steps, inputs)."""
    view = ReferenceView(block)
    params = view.params()
    memory, answer = view.init(params), []
    step = block.entries["step"]
    for row in np.atleast_2d(raw.T).T:
        inputs = dict(zip([item.name for item in step.inputs], row, strict=True))
        told = view.call("step", memory, view.inputs("step", inputs), params)
        assert told.status == 0
        memory = told.memory
        answer.append([float(told.outputs[item.name]) for item in step.outputs])
    return np.array(answer)


@pytest.mark.parametrize("precision", ["double", "float"])
@pytest.mark.parametrize("name", BLOCKS)
def test_all_views_agree(name, precision):
    check = cross_check(BLOCKS[name](), precision, steps=40)
    assert check.passed, [(item.name, str(item.mismatch), item.note) for item in check.failures]
    assert check.statuses["OK"] > 60


# -- state space ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("method", ["zoh", "foh", "tustin", "euler", "backward"])
def test_a_state_space_is_that_of_python_control(method):
    block = state_space(SWING, dt=DT, method=method)
    assert [item.name for item in block.memory_signals] == ["angle", "rate"]
    assert [item.name for item in block.entries["step"].inputs] == ["push_0", "push_1"]
    assert [item.name for item in block.entries["step"].outputs] == ["angle_out", "speed"]
    assert block.sample_time == DT
    sampled = control.sample_system(SWING, DT, {"tustin": "bilinear", "backward": "backward_diff"}.get(method, method))
    expected = control.forced_response(sampled, inputs=NOISE.T).outputs.T
    np.testing.assert_allclose(run(block, NOISE), expected, rtol=0, atol=1e-9)
    np.testing.assert_allclose(run(state_space(sampled), NOISE), expected, rtol=0, atol=1e-9)


def test_a_state_space_by_matrices():
    A, B, C, D = [[0.9, 0.1], [0.0, 0.8]], [[0.0], [1.0]], [[1.0, 0.0]], [[0.5]]
    block = state_space((A, B, C, D), dt=DT)
    expected = control.forced_response(control.ss(A, B, C, D, DT), inputs=NOISE[:, 0]).outputs
    np.testing.assert_allclose(run(block, NOISE[:, 0])[:, 0], expected, rtol=0, atol=1e-12)
    assert run(state_space(([], [], [], [[2.0]]), dt=DT), NOISE[:, 0]).shape == (150, 1)


def test_prewarping_keeps_a_frequency_in_its_place():
    for make, value in (
        (lambda **more: transfer_function(SLOW, dt=DT, method="tustin", **more), SLOW),
        (lambda **more: state_space(control.ss(SLOW), dt=DT, method="tustin", **more), SLOW),
    ):
        block = make(prewarp=4.0)
        time = DT * np.arange(2000)
        ours = run(block, np.exp(2j * np.pi * 4.0 * time).real)[:, 0]
        other = run(block, np.exp(2j * np.pi * 4.0 * time).imag)[:, 0]
        response = (ours[-1] + 1j * other[-1]) / np.exp(2j * np.pi * 4.0 * time[-1])
        assert response == pytest.approx(complex(value(2j * np.pi * 4.0)), abs=1e-9)


# -- rational filters -------------------------------------------------------------------------------------------------


@given(st.integers(0, 2**32 - 1), st.integers(1, 2), st.booleans())
def test_a_filter_of_low_order_is_lfilter(seed, order, late):
    rng = np.random.default_rng(seed)
    poles = rng.uniform(0.1, 0.95, 2)
    turn = rng.uniform(0.1, 3.0)
    denominator = np.real(
        np.poly(poles[:1] if order == 1 else [poles[0] * np.exp(1j * turn), poles[0] * np.exp(-1j * turn)])
    )
    numerator = rng.normal(size=order if late else order + 1)
    scale = rng.uniform(0.5, 3.0)
    block = transfer_function((numerator * scale, denominator * scale), dt=DT)
    shifted = np.concatenate([np.zeros(order + 1 - len(numerator)), numerator])
    expected = signal.lfilter(shifted, denominator, NOISE[:, 0])
    np.testing.assert_allclose(run(block, NOISE[:, 0])[:, 0], expected, rtol=0, atol=1e-9)


@given(st.integers(3, 9), st.floats(0.02, 0.4))
def test_a_filter_of_high_order_is_sosfilt(order, cutoff):
    sections = signal.butter(order, 2 * cutoff, output="sos")
    block = transfer_function(signal.butter(order, 2 * cutoff), dt=DT) if cutoff > 0.1 or order < 5 else None
    if block is not None:
        # SciPy makes an odd order even by a pole and a zero at the origin, which may end up in two sections
        assert block.memory_signals[0].size in (order, order + order % 2)
        ours = run(block, NOISE[:, 0])[:, 0]
        np.testing.assert_allclose(ours, signal.sosfilt(sections, NOISE[:, 0]), rtol=0, atol=2e-6)
    analog = signal.butter(order, 2 * np.pi * cutoff / DT, analog=True)
    ours = run(transfer_function(analog, dt=DT, method="tustin", prewarp=cutoff / DT), NOISE[:, 0])[:, 0]
    np.testing.assert_allclose(ours, signal.sosfilt(sections, NOISE[:, 0]), rtol=0, atol=1e-8)


@pytest.mark.parametrize("method", ["zoh", "foh", "tustin", "euler", "backward"])
@pytest.mark.parametrize("system", [([1, 0.2], [1, 1.4, 1]), ([2, 0, 1], [1, 3, 3, 1]), ([3], [0.5, 1])])
def test_a_continuous_filter_is_made_discrete_as_python_control_does(system, method):
    block = transfer_function(control.tf(*system), dt=DT, method=method)
    sampled = control.sample_system(
        control.ss(control.tf(*system)), DT, {"tustin": "bilinear", "backward": "backward_diff"}.get(method, method)
    )
    expected = control.forced_response(sampled, inputs=NOISE[:, 0]).outputs
    np.testing.assert_allclose(run(block, NOISE[:, 0])[:, 0], expected, rtol=0, atol=2e-8)


def test_a_discrete_filter_of_python_control_has_its_own_time_step():
    block = transfer_function(control.tf([1], [1, -0.5], 0.25))
    assert block.sample_time == 0.25
    np.testing.assert_allclose(run(block, np.eye(4)[0])[:, 0], [0, 1, 0.5, 0.25])


def test_delays_are_kept_in_sections():
    for numerator, denominator in (
        ([1], [1, 0, 0, 0]),
        ([1, 0.3], [1, -0.5, 0.06, 0, 0]),
        ([1.0], np.poly([0.1, 0.2, 0.3])),
    ):
        block = transfer_function((numerator, denominator), dt=DT)
        padded = np.concatenate([np.zeros(len(denominator) - len(numerator)), numerator])
        expected = signal.lfilter(padded, denominator, NOISE[:, 0])
        np.testing.assert_allclose(run(block, NOISE[:, 0])[:, 0], expected, rtol=0, atol=1e-9)
        assert block.memory_signals[0].size == len(denominator) - 1


def test_the_bilinear_transform_is_exact():
    for b, a in (([1.0, 0.2], [1.0, 1.4, 1.0]), ([1.0], [1.0, 0.1]), ([1.0, 0.0, 4.0], [1.0, 0.4, 4.0])):
        ours = linear_systems._tustin(np.array(b), np.array(a), DT)
        for mine, theirs in zip(ours, signal.bilinear(b, a, 1 / DT), strict=True):
            np.testing.assert_allclose(mine[len(mine) - len(theirs) :], theirs, rtol=1e-12, atol=1e-15)


def test_a_stable_filter_stays_within_its_ranges():
    block = BLOCKS["fifth_order"]()
    A, B, C, _ = linear_systems.cascade(block.oracle.formulas["step"].sections)
    impulses = [B]
    for _ in range(2000):
        impulses.append(A @ impulses[-1])
    total = np.sum(np.abs(np.array(impulses)), axis=0)[:, 0]
    delays = block.memory_signals[0]
    assert np.all(total <= delays.high)
    assert np.all(total >= 0.1 * np.array(delays.high))  # and no wider than need be
    worst = np.sign((C @ np.array(impulses))[::-1, 0, 0])  # bang-bang: the input that takes the output furthest
    peak = np.max(np.abs(run(block, worst[-400:])))
    assert 1.0 < peak <= block.entries["step"].outputs[0].high[0]


# -- sentences --------------------------------------------------------------------------------------------------------

MATRICES = ([[0.5]], [[1.0]], [[1.0]], [[0.0]])


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (
            lambda: transfer_function(([1, 2, 3], [1, 1]), dt=DT),
            r"the filter is improper \(numerator of order 2, denominator of order 1\), and would need readings of the future",
        ),
        (lambda: transfer_function(([1, 0], [0, 1]), dt=DT, method="tustin"), "is improper"),
        (lambda: transfer_function(([1], [0, 0]), dt=DT), "the denominator is zero"),
        (lambda: transfer_function(([1], "one"), dt=DT), "the denominator is 'one'; give a matrix of numbers"),
        (lambda: transfer_function(([1], [1, np.inf]), dt=DT), "the denominator is no matrix of finite numbers"),
        (lambda: transfer_function(([1], [[1, 2], [3, 4]]), dt=DT), r"the denominator has shape \(2, 2\)"),
        (lambda: transfer_function("fast", dt=DT), "the system is str; give a control.TransferFunction"),
        (
            lambda: transfer_function(control.tf(SWING), dt=DT, method="zoh"),
            r"the system has 2 input\(s\) and 2 output",
        ),
        (lambda: transfer_function(SLOW, dt=DT), "the system is continuous and no method is given; say how"),
        (lambda: transfer_function(SLOW, dt=DT, method="magic"), "the system is continuous and the method is 'magic'"),
        (lambda: transfer_function(SLOW, method="zoh"), "there is no time step; give dt="),
        (
            lambda: transfer_function(SLOW, dt=-1, method="zoh"),
            "dt is -1; give the seconds per step as a positive number",
        ),
        (lambda: transfer_function(SLOW, dt=DT, method="zoh", prewarp=1), "prewarp= goes with method='tustin'"),
        (
            lambda: transfer_function(SLOW, dt=DT, method="tustin", prewarp=10.0),
            "prewarp is 10 Hz; give more than 0 and less",
        ),
        (lambda: transfer_function(control.tf([1], [1, 0.5], 0.1), dt=DT), "dt=0.05 is given, but the system has 0.1"),
        (
            lambda: transfer_function(control.tf([1], [1, 0.5], 0.1), method="zoh"),
            "the system is discrete and method='zoh'",
        ),
        (lambda: transfer_function(([1], [1, 0.5])), "there is no time step; give dt="),
        (
            lambda: transfer_function(([1.0], np.poly([0.9999] * 6)), dt=DT),
            "rounding to 12 digits and sections of second order move the frequency response by",
        ),
        (lambda: state_space("fast", dt=DT), r"the system is str; give a control.StateSpace, or \(A, B, C, D\)"),
        (lambda: state_space((*MATRICES[:3], [[0.0, 1.0]]), dt=DT), "the shapes do not match"),
        (lambda: state_space(MATRICES, dt=DT, ranges={"y": (0, 1)}), "ranges= names y; the system has u_0, x_0, y_0"),
        (lambda: state_space(MATRICES, dt=DT, units={"u": "V"}), "units= names u; the system has u_0, x_0, y_0"),
        (lambda: state_space(SWING, dt=DT), "the system is continuous and no method is given"),
    ],
)
def test_what_is_no_linear_system(make, says):
    with pytest.raises(ModelError, match=says):
        make()
