"""A Kalman filter and a high-gain observer as exosystems: specs/output_regulation.md, sections 5, 6, 10 and 14."""

import numpy as np
import pytest
from plantc.reference import regulation as oracle
from plantc.symbolic.exosystems import compose, constant, exosystem, harmonic, polynomial, superpose
from plantc.symbolic.forms import packing_of
from plantc.symbolic.regulator_equations import RegulatorError
from plantc.symbolic.signal_generators import (
    bandwidth,
    exosystem_plant,
    high_gain_exosystem,
    high_gain_matrices,
    is_nilpotent,
    kalman_exosystem,
    noise_gain,
    peaking,
)

from plantc import InterpretView, ModelError, ReferenceView, cross_check, emit, linearise

T, D, M = 0.02, 1e-12, 0.01
SIGNALS = ("x", "y", "z", "yaw")


def chains(degree, names=SIGNALS):
    return compose([polynomial(name, degree) for name in names]).sampled(T, "euler")


def psi(t):
    """The references of section 7."""
    return np.stack(
        [np.sin(np.pi * t / 20) + np.sin((np.pi / 20 + 0.1) * t), np.cos(np.pi * t / 20), 5 + 0 * t, 0 * t], axis=-1
    )


def run(block, readings, present=None, *, at_zero=False):
    """Memories' estimates (steps, r) of `step`; `at_zero`: the first readings correct without a prediction."""
    view = InterpretView(block)
    params = view.params()
    memory, found = view.init(params), []
    names = [entry.removeprefix("update_") for entry in block.entries if entry.startswith("update_")]
    for k, row in enumerate(readings):
        there = np.ones(len(names), dtype=bool) if present is None else present[k]
        if at_zero and k == 0:
            for name, value in zip(names, row, strict=True):
                memory = view.call(
                    f"update_{name}", memory, view.inputs(f"update_{name}", {name: value}), params
                ).memory
        else:
            inputs = dict(zip(names, np.where(there, row, np.nan), strict=True))  # what is missing is never read
            inputs |= {f"has_{name}": bool(flag) for name, flag in zip(names, there, strict=True)}
            answer = view.call("step", memory, view.inputs("step", inputs), params)
            assert answer.status == 0, answer.status
            memory = answer.memory
        found.append(np.concatenate([np.ravel(memory[f"w_{name}"]) for name in names]))
    return np.array(found), memory


# -- Kalman -----------------------------------------------------------------------------------------------------------

STEADY = {
    2: [3.17145e-3, 2.51949e-4, 9.98413e-6],
    6: [2.99796e-2, 2.29246e-2, 1.12359e-2, 3.8016e-3, 8.87537e-4, 1.32687e-4, 9.84896e-6],
}
RESPONSE = {
    2: [(1.0101, -59.01, 0.99000), (0.6178, -71.81, 0.99795)],
    6: [(1.00381, -0.146, 0.004590), (0.92550, -7.052, 0.13984)],
}
NOISE = {2: 0.005141, 6: 0.016690}


@pytest.mark.parametrize("degree", [2, 6])
def test_the_steady_state_of_the_table(degree):
    from plantc.symbolic.steady_state import _design, _matrices

    plant = exosystem_plant(chains(degree, ("x",)), process_variance=D, measurement_variance=M)
    A, C, Q, R = _matrices(plant)
    G = _design(plant, A, C, Q, R)[:, 0]
    np.testing.assert_allclose(G, STEADY[degree], rtol=2e-5)
    closed = (np.eye(len(A)) - np.outer(G, C)) @ A
    radii = np.abs(np.log(np.linalg.eigvals(closed)) / T)
    np.testing.assert_allclose(radii, bandwidth(T, degree, D, M), rtol=0.01)
    for w, (size, phase, missed) in zip((np.pi / 20, np.pi / 20 + 0.1), RESPONSE[degree], strict=True):
        z = np.exp(1j * w * T)
        H = (C @ np.linalg.solve(z * np.eye(len(A)) - closed, z * G))[0]
        assert abs(H) == pytest.approx(size, rel=1e-4)
        assert np.degrees(np.angle(H)) == pytest.approx(phase, abs=0.01)
        assert abs(1 - H) == pytest.approx(missed, rel=1e-3)
    # the estimate after a reading: w+ = (I - G Q) S w + G nu
    assert noise_gain(closed, G)[0] * 0.1 == pytest.approx(NOISE[degree], rel=1e-3)


def test_the_filter_is_that_of_the_paper():
    """Section 14, item 12: a missing reading is a flag for its channel, whose state is predicted; what is behind it is not read."""
    generator = chains(2)
    block = kalman_exosystem(generator, process_variance=D, measurement_variance=M)
    k = np.arange(301)
    readings = psi(T * k) + 0.1 * np.random.default_rng(0).standard_normal((301, 4))
    present = np.random.default_rng(1).uniform(size=(301, 4)) < 0.8
    present[0] = True
    found, memory = run(block, readings, present, at_zero=True)
    S, Q, r = generator.matrix, generator.output, generator.order
    expected, P = oracle.kalman_exosystem(S, Q, D * np.eye(r), M * np.eye(4), readings, present)
    np.testing.assert_allclose(found, expected, atol=1e-9)
    packing = packing_of(block, "covariance")
    assert packing.blocks == ((0, 1, 2), (3, 4, 5), (6, 7, 8), (9, 10, 11))
    np.testing.assert_allclose(packing.unpack(np.array(memory["covariance"])), P[-1], rtol=1e-6, atol=1e-12)
    # with a prediction first the prior is S S' + D, not the identity: what that does is gone soon
    early, _ = run(block, readings[:150])
    late = oracle.kalman_exosystem(S, Q, D * np.eye(r), M * np.eye(4), readings[:150])[0]
    assert 1e-6 < np.max(np.abs(early - late)[-1]) < 1e-3


@pytest.mark.parametrize("P_0", [1e-2, 1e3])
def test_the_first_covariance_is_what_is_given(P_0):
    """Section 14, item 11: P_0 is a number of the block, and the filter is that of the oracle from there."""
    generator, readings = chains(2), psi(T * np.arange(101))
    block = kalman_exosystem(generator, process_variance=D, measurement_variance=M, initial_variance=P_0)
    found, _ = run(block, readings, at_zero=True)
    arguments = generator.matrix, generator.output, D * np.eye(12), M * np.eye(4), readings
    expected, _ = oracle.kalman_exosystem(*arguments, P=P_0 * np.eye(12))
    np.testing.assert_allclose(found, expected, atol=1e-8)
    assert np.max(np.abs(found - oracle.kalman_exosystem(*arguments)[0])) > 1e-3  # with P_0 = 1 it is another


def test_the_error_of_the_spec_on_noise_free_signals():
    generator = chains(6)
    readings = psi(T * np.arange(1001))
    S, Q, r = generator.matrix, generator.output, generator.order
    w, _ = oracle.kalman_exosystem(S, Q, D * np.eye(r), M * np.eye(4), readings)
    error = np.sqrt(np.mean((w @ Q.T - readings) ** 2, axis=0))
    np.testing.assert_allclose(error[:2], [0.0014423, 4.0598e-4], rtol=1e-3)


def test_only_the_blocks_are_kept():
    block = kalman_exosystem(chains(6), process_variance=D, measurement_variance=M)
    sizes = {signal.name: signal.size for signal in block.memory_signals}
    assert sizes["covariance"] == 112  # 4 x 28 of the 406 of the whole triangle
    assert sizes["w_x"] == 7
    assert "P is zero by structure outside blocks of 7, 7, 7, 7" in " ".join(block.notes)
    one = kalman_exosystem(chains(6, ("x",)), process_variance=D, measurement_variance=M)
    whole, part = emit(block).operations, emit(one).operations
    assert whole["predict"] == {name: 4 * count for name, count in part["predict"].items()}  # nothing is done for zeros
    assert whole["update_x"] == part["update_x"]  # a reading touches its own block


def test_all_signals_are_read_or_disturbances_are_not_seen():
    generator = chains(2, ("ref", "dis"))
    assert linearise(exosystem_plant(generator, process_variance=D, measurement_variance=M)).observability().rank == 6
    half = exosystem(generator.matrix, generator.output[:1], ("ref",), dt=T)
    assert linearise(exosystem_plant(half, process_variance=D, measurement_variance=M)).observability().rank == 3


def test_no_process_noise_is_a_fit_to_all_of_the_past():
    """Section 14, item 9: D = 0 has gains that decay like 1/k, and no steady state is needed."""
    block = kalman_exosystem(constant("x").sampled(0.1), process_variance=0.0, measurement_variance=1.0)
    readings = np.random.default_rng(3).normal(size=(50, 1))
    found, _ = run(block, readings)
    np.testing.assert_allclose(found[:, 0], np.cumsum(readings) / (np.arange(1, 51) + 1), rtol=1e-12)
    assert any("No process noise for x: the gain decays like 1/k" in note for note in block.notes)


@pytest.mark.parametrize("together", [False, True])
def test_without_process_noise_it_is_said_of_whom(together):
    moving, still = (
        kalman_exosystem(chains(1, ("x", "y")), process_variance=D, measurement_variance=M, together=together)
        for D in (1e-6, 0.0)
    )
    said = [note for note in still.notes if "No process noise for x, y:" in note]
    assert len(said) == 1 and not any("No process noise" in note for note in moving.notes)
    half = {"x": [0.0, 1e-6], "y": [0.0, 0.0]}  # of x the slope has noise, which is enough
    if not together:
        notes = kalman_exosystem(chains(1, ("x", "y")), process_variance=half, measurement_variance=M).notes
        assert any("No process noise for y:" in note for note in notes)


def test_a_constant_gain():
    chain = polynomial("x", 6).sampled(T, "euler")
    block = kalman_exosystem(chain, process_variance=D, measurement_variance=M, steady=True)
    assert [signal.name for signal in block.memory_signals] == ["w_x"]
    G, view, w = np.array(block.design.values["gain"])[:, 0], InterpretView(block), np.zeros(7)
    np.testing.assert_allclose(G, STEADY[6], rtol=2e-5)
    params, memory = view.params(), view.init()
    for k in range(50):
        there, z = k % 5 > 0, float(psi(T * k)[0])
        inputs = {"x": z if there else np.nan, "has_readings": there}
        memory = view.call("step", memory, view.inputs("step", inputs), params).memory
        w = chain.matrix @ w
        w = w + G * (z - w[0]) if there else w
        np.testing.assert_allclose(np.ravel(memory["w_x"]), w, rtol=1e-9, atol=1e-15)
    with pytest.raises(ModelError, match="form is for a filter with a covariance"):
        kalman_exosystem(chain, process_variance=D, measurement_variance=M, steady=True, form="ud")
    with pytest.raises(ModelError, match="no stabilising gain exists"):
        kalman_exosystem(chain, process_variance=0.0, measurement_variance=M, steady=True)


def test_superposed_and_general_exosystems():
    whole = compose([superpose([harmonic("x", 0.3), harmonic("x", 0.7)]), constant("y", unit="m")]).sampled(0.1)
    block = kalman_exosystem(whole, process_variance={"x": 1e-6, "y": 1e-8}, measurement_variance={"x": 0.1, "y": 0.2})
    assert {s.name: s.size for s in block.memory_signals}["w_x"] == 4
    assert packing_of(block, "covariance").blocks == ((0, 1, 2, 3), (4,))
    assert block.entries["update_y"].inputs[0].unit == "m"


# -- high gain --------------------------------------------------------------------------------------------------------


def test_the_printed_blocks_are_deadbeat():
    S, gains = high_gain_matrices(2, (2, 1), T, T)
    np.testing.assert_allclose(S, [[-1, 1 / 50], [-50, 1]])
    np.testing.assert_allclose(gains, [2, 50])
    assert is_nilpotent(S)
    np.testing.assert_allclose(noise_gain(S, gains) * 0.1, [0.2236, 7.071], rtol=1e-4)
    chain = S + np.outer(gains, [1, 0])
    np.testing.assert_allclose(chain, polynomial("x", 1).sampled(T, "euler").matrix)
    # a position that is 5 at once is a speed of 250 for one step
    np.testing.assert_allclose(peaking(S, 5 * gains), [10, 250])
    block = high_gain_exosystem(chains(1), coefficients=(2, 1), epsilon=T)
    assert any("Deadbeat" in note for note in block.notes) and any("swing up to 2, 50" in note for note in block.notes)
    # the text's a1 = a2 = 1 never converges
    with pytest.raises(RegulatorError, match="the observer does not converge: its spectral radius is 1, not below 1"):
        high_gain_exosystem(chains(1), coefficients=(1, 1), epsilon=T)
    slow = high_gain_exosystem(chains(1), coefficients=(1, 1), epsilon=T, accept_unstable=True)
    assert not any("Deadbeat" in note for note in slow.notes)


def observed(block, readings, present=None, view=InterpretView):
    view = view(block)
    params = view.params()
    memory, found = view.init(params), []
    for k, row in enumerate(readings):
        there = np.ones(4, dtype=bool) if present is None else present[k]
        inputs = dict(zip(SIGNALS, np.where(there, row, np.nan), strict=True))
        inputs |= {f"has_{name}": bool(flag) for name, flag in zip(SIGNALS, there, strict=True)}
        answer = view.call("step", memory, view.inputs("step", inputs), params)
        assert answer.status == 0
        memory = answer.memory
        found.append(np.concatenate([np.ravel(answer.outputs[f"w_{name}"]) for name in SIGNALS]))
    return np.array(found)


def test_the_observer_hands_out_what_it_knew_before_the_reading():
    readings = psi(T * np.arange(60)) + 0.1 * np.random.default_rng(4).standard_normal((60, 4))
    block = high_gain_exosystem(chains(1), coefficients=(2, 1), epsilon=T)
    found = observed(block, readings)
    S, gains = high_gain_matrices(2, (2, 1), T, T)
    expected = oracle.high_gain_exosystem(
        np.kron(np.eye(4), S), np.kron(np.eye(4), gains[:, None]), readings, np.zeros(8)
    )
    np.testing.assert_allclose(found, expected, atol=1e-9)
    before, earlier = readings[1:-1], readings[:-2]
    np.testing.assert_allclose(found[2:, 0::2], 2 * before - earlier, atol=1e-9)
    np.testing.assert_allclose(found[2:, 1::2], (before - earlier) / T, atol=1e-7)
    warm = {name: (float(p), float(v)) for name, p, v in zip(SIGNALS, (0, 1, 5, 0), (0.4, 0, 0, 0), strict=True)}
    started = observed(
        high_gain_exosystem(chains(1), coefficients=(2, 1), epsilon=T, initial=warm), psi(T * np.arange(5))
    )
    np.testing.assert_allclose(started[0], [0, 0.4, 1, 0, 5, 0, 0, 0])


def test_a_missing_sample_coasts_its_own_channel():
    """Section 14, item 12, of the high-gain observer."""
    k = np.arange(40)
    readings = np.stack([1 + 0.1 * k, 2 - 0.2 * k, 0 * k, 0 * k + 3], axis=-1)
    present = np.ones((40, 4), dtype=bool)
    present[10:20, 0] = False
    block = high_gain_exosystem(chains(1), coefficients=(2, 1), epsilon=T)
    for view in (InterpretView, ReferenceView):
        found = observed(block, readings, present, view)
        np.testing.assert_allclose(found[5:, 0::2], readings[5:], atol=1e-8)  # straight lines: coasting is exact


@pytest.mark.slow
@pytest.mark.parametrize(
    "block",
    [
        high_gain_exosystem(
            chains(2, ("x", "y")), coefficients=(3, 3, 1), epsilon=0.1, ranges={"x": (-5, 5), "y": (-5, 5)}
        ),
        kalman_exosystem(chains(1, ("x", "y")), process_variance=1e-6, measurement_variance=M),
    ],
    ids=["high gain", "Kalman"],
)
def test_the_c_of_both(block):
    assert cross_check(block, "double", steps=60).passed


def test_a_reading_behind_its_flag_is_judged_only_where_it_is_read():
    block = high_gain_exosystem(chains(1), coefficients=(2, 1), epsilon=T, ranges={"x": (-1, 1)})
    for kind in (InterpretView, ReferenceView):
        view = kind(block)
        params = view.params()
        memory = view.init(params)
        for flag, status in ((True, -1), (False, 0)):
            inputs = {"x": 2.0, "has_x": flag, "has_y": False, "has_z": False, "has_yaw": False}
            assert view.call("step", memory, view.inputs("step", inputs), params).status == status


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: kalman_exosystem(constant("x"), process_variance=D, measurement_variance=M), "is continuous; give it sampled"),
        (lambda: kalman_exosystem(chains(1), process_variance=D, measurement_variance=0.0), "measurement_variance of 'x' is 0.0; give 1 positive"),
        (lambda: kalman_exosystem(chains(1), process_variance=-D, measurement_variance=M), "process_variance of 'x' is -1e-12; give 2 number"),
        (lambda: kalman_exosystem(chains(1), process_variance={"q": D}, measurement_variance=M), "process_variance names q, and the signals are x"),
        (lambda: kalman_exosystem(chains(1), process_variance={"x": D}, measurement_variance=M), "process_variance of 'y' is None"),
        (lambda: high_gain_exosystem(chains(1), coefficients=(1,), epsilon=T), r"1 coefficient\(s\) are given; give 2"),
        (lambda: high_gain_exosystem(chains(1), coefficients=(2, 1), epsilon=0), "epsilon is 0; give a positive"),
        (lambda: high_gain_exosystem(chains(1), coefficients=(2, 1), epsilon=T, initial={"X": (1, 0)}), "initial names X, and the signals are x, y, z, yaw"),
        (lambda: high_gain_exosystem(chains(1), coefficients=(2, 1), epsilon=T, initial={"x": (1,)}), r"initial of 'x' is \(1,\); give 2 numbers"),
        (lambda: high_gain_exosystem(chains(1), coefficients=(2, 1), epsilon=T, ranges={"Y": (0, 1)}), "ranges names Y, and the signals are"),
        (lambda: high_gain_exosystem(harmonic("x", 1.0).sampled(T), coefficients=(2, 1), epsilon=T), "for polynomials of one degree"),
        (lambda: high_gain_exosystem(polynomial("x", 1).sampled(T), coefficients=(2, 1), epsilon=T), "sampled by Euler"),
    ],
)  # fmt: skip
def test_sentences(make, says):
    """Section 14, item 10 among them: M = 0 is refused."""
    with pytest.raises(ModelError, match=says):
        make()


def test_the_oracle_solves_the_regulator_equations_too():
    from plantc.symbolic.regulator_equations import francis, linear_model

    plant = linear_model([[0, 1], [-1, -0.4]], [[0], [1]], [[1, 0]], E=[[0.5], [1]]).sampled(T, "euler")
    generator = compose([polynomial("y_0", 2), polynomial("d_0", 2)]).sampled(T, "euler")
    found = francis(plant, generator)
    Pi, Gamma = oracle.francis(plant.A, plant.B, plant.C, generator.matrix, found.reference, found.disturbance)
    np.testing.assert_allclose(Pi, found.state_map, atol=1e-9)
    np.testing.assert_allclose(Gamma, found.input_map, atol=1e-9)
