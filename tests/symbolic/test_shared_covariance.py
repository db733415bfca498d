"""Signals of one kind that are read together: one covariance for all, beside the filter that keeps one for each."""

from dataclasses import replace

import numpy as np
import pytest
from plantc.codegen import TargetView
from plantc.codegen.emulator import Call
from plantc.codegen.proof import prove
from plantc.codegen.targets import TARGETS, Sizes, linked_library
from plantc.examples.quadrotor_ekf import quadrotor
from plantc.reference.shared_covariance import SharedCovarianceOracle
from plantc.symbolic.exosystems import compose, harmonic, polynomial
from plantc.symbolic.output_regulator import output_regulator
from plantc.symbolic.program import AllOf, HoldVariances, Refuse, When
from plantc.symbolic.regulator_equations import francis
from plantc.symbolic.signal_generators import kalman_exosystem

from plantc import InterpretView, ModelError, NativeView, ReferenceView, Status, cross_check, emit, linearise, lqr, trim

T, M = 0.02, 0.01
NOISE = {"process_variance": 1e-6, "measurement_variance": M}


def chains(degree=1, names=("x", "y")):
    return compose([polynomial(name, degree) for name in names]).sampled(T, "euler")


def together(degree=1, names=("x", "y"), **options):
    return kalman_exosystem(chains(degree, names), together=True, **NOISE, **options)


@pytest.mark.parametrize("kind", [InterpretView, ReferenceView])
def test_it_is_the_filter_that_keeps_a_covariance_for_each(kind):
    names = ("x", "y", "z", "yaw")
    one, each = kind(together(6, names)), InterpretView(kalman_exosystem(chains(6, names), **NOISE))
    first, second, p, q = one.init(), each.init(), one.params(), each.params()
    rng = np.random.default_rng(1)
    for k in range(30):
        readings, there = rng.normal(size=4), k % 5 != 2
        given = {"readings": readings, "has_readings": there}
        apart = {name: value for name, value in zip(names, readings, strict=True)}
        apart |= {f"has_{name}": there for name in names}
        found = one.call("step", first, one.inputs("step", given), p)
        known = each.call("step", second, each.inputs("step", apart), q)
        assert found.status == known.status == 0
        first, second = found.memory, known.memory
        for name in names:
            np.testing.assert_allclose(first[f"w_{name}"], second[f"w_{name}"], rtol=1e-7, atol=1e-10)
        np.testing.assert_allclose(np.tile(first["covariance"], 4), second["covariance"], rtol=1e-7, atol=1e-12)
        if there:
            nis = sum(float(known.outputs[name]["nis"]) for name in names)
            assert float(found.outputs["readings"]["nis"]) == pytest.approx(nis, rel=1e-7)


def test_what_is_kept():
    block = together(6, ("x", "y", "z", "yaw"))
    sizes = {signal.name: signal.size for signal in block.memory_signals}
    assert sizes == {"w_x": 7, "w_y": 7, "w_z": 7, "w_yaw": 7, "covariance": 28, "rejected_readings": 1}
    own, one = emit(block).operations, emit(kalman_exosystem(chains(6, ("x",)), **NOISE)).operations
    # P moves once; each of the other three signals adds its own states, S being I + dt N: 6 additions, 6 products
    assert own["predict"]["addition"] == one["predict"]["addition"] + 3 * 6
    assert own["predict"]["multiplication"] == one["predict"]["multiplication"] + 3 * 6


def test_readings_are_taken_or_refused_at_once():
    block = together(ranges={"y": (-1, 1)}, gate=20)
    for kind in (InterpretView, ReferenceView):
        view = kind(block)
        params = view.params()
        memory = view.init(params)
        coasting = view.call("predict", memory, view.inputs("predict", {}), params).memory
        for readings, status, own in (
            ((0.1, 0.2), Status.OK, Status.OK),
            ((0.1, 1.5), Status.SKIPPED, Status.BAD_INPUT),
            ((np.nan, 0.2), Status.SKIPPED, Status.BAD_INPUT),
            ((30.0, 0.0), Status.GATED, Status.GATED),  # one far away gates them all
        ):
            answer = view.call(
                "step", memory, view.inputs("step", {"readings": readings, "has_readings": True}), params
            )
            assert answer.status == status
            assert int(answer.outputs["status_readings"]) == own
            for name in ("w_x", "w_y", "covariance"):
                same = np.array_equal(answer.memory[name], coasting[name])
                assert same == (status != Status.OK)
            assert int(answer.memory["rejected_readings"]) == int(status == Status.GATED)


@pytest.mark.parametrize("precision", ["double", "float"])
def test_the_c_agrees(needs, precision):
    needs("gcc")
    check = cross_check(together(), precision, steps=60)
    assert check.passed, [str(item) for item in check.failures]
    independent = "native = reference" if precision == "double" else "float statuses = reference in float"
    assert any(result.name == independent and result.calls > 50 for result in check.results)


@pytest.mark.parametrize("signal", ["x", "y"])
def test_each_signal_is_judged(signal):
    block = together()
    for kind in (InterpretView, ReferenceView):
        view = kind(block)
        params = view.params()
        memory = view.init(params)
        memory[f"w_{signal}"] = [1e6, 1.0]
        assert view.call("predict", memory, view.inputs("predict", {}), params).status == Status.OVERFLOW
        memory[f"w_{signal}"] = [1e6 - 1, 0.0]
        memory["covariance"] = [1e6, 0.0, 1.0]
        reading = {"readings": [1e6 if name == signal else 0.0 for name in ("x", "y")]}
        taken = view.call("update_readings", memory, view.inputs("update_readings", reading), params)
        assert taken.status == Status.OK
        memory["covariance"] = [1e6, 9e5, 1e6]  # the slope, at its end, would be corrected beyond it
        memory[f"w_{signal}"] = [1e6 - 1, 1e6]
        taken = view.call("update_readings", memory, view.inputs("update_readings", reading), params)
        assert taken.status == Status.OVERFLOW


@pytest.mark.parametrize("fault", ["P in predict", "P in update_readings", "w_y in update_readings"])
def test_what_is_not_judged_is_seen(needs, fault):
    needs("gcc")
    block = together()
    what, _, name = fault.partition(" in ")

    def blind(body):
        kept = []
        for item in body:
            if isinstance(item, When):
                item = replace(item, then=blind(item.then))
            if what == "P" and isinstance(item, HoldVariances):
                continue
            if what == "w_y" and isinstance(item, Refuse) and "w_y" in repr(item.unless):
                item = replace(item, unless=AllOf(item.unless.conditions[:1]))
            kept.append(item)
        return tuple(kept)

    entry = block.entries[name]
    block.entries[name] = replace(entry, body=blind(entry.body))
    assert block.entries[name].body != entry.body
    assert not cross_check(block, "double", steps=60).passed


def test_a_covariance_that_the_signals_do_not_share_is_seen():
    # the reference keeps a block for each signal: were their noises different, its blocks would not stay the same
    class Different(SharedCovarianceOracle):
        def of_all(self, params):
            return {**super().of_all(params), "variance_step_w_y": np.array([1.0, 1.0])}

    block = together()
    view = ReferenceView(block)
    params = view.params()
    memory = view.init(params)
    right = view.call("predict", memory, view.inputs("predict", {}), params).memory["covariance"]
    block.oracle = Different(block.oracle.whole, block.oracle.states, block.oracle.sensor)
    view = ReferenceView(block)
    wrong = view.call("predict", memory, view.inputs("predict", {}), params).memory["covariance"]
    assert np.max(np.abs(np.asarray(wrong) - right)) > 0.5


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (
            lambda: kalman_exosystem(
                compose([polynomial("x", 1), harmonic("y", 1.0)]).sampled(T), together=True, **NOISE
            ),
            "signals that share a covariance are of one kind, and y is not as x; leave out together=True",
        ),
        (lambda: together(steady=True), "with steady=True all readings come together anyway"),
        (lambda: together(form="ud"), "one number each; leave out or mend form"),
        (lambda: together(gate={"x": 9}), "one number each; leave out or mend gate"),
        (
            lambda: kalman_exosystem(
                chains(), together=True, process_variance={"x": 1e-6, "y": 1e-5}, measurement_variance=M
            ),
            "process_variance differs between the signals, which then have no covariance in common",
        ),
        (
            lambda: kalman_exosystem(
                chains(), together=True, process_variance=1e-6, measurement_variance={"x": 1.0, "y": 2.0}
            ),
            "measurement_variance differs between the signals",
        ),
    ],
)
def test_sentences(make, says):
    with pytest.raises(ModelError, match=says):
        make()


@pytest.mark.slow
def test_no_sequence_of_calls_takes_the_memory_out_of_its_ranges(needs):
    needs("frama-c")
    block = together()
    found = prove(block, emit(block, "float"))
    assert len(found.checks) > 8
    assert all(check.passed for check in found.checks), [str(item) for item in found.checks if not item.passed]


@pytest.mark.slow
def test_a_regulator_with_28_states_on_a_cortex_m4(needs, tmp_path):
    needs("gcc", "arm-none-eabi-gcc", "qemu-system-arm")
    plant, outputs = quadrotor.discretise("euler", dt=T), ("x", "y", "z", "yaw")
    point = trim(plant, hold=dict.fromkeys(outputs, 0.0))
    linear, tracks = linearise(plant, point), chains(6, outputs)
    block = output_regulator(
        plant, point, lqr(linear, Q=100 * np.ones(12), R=1), francis(linear, tracks), together(6, outputs),
        saturate=True, tunable=False, name="regulator",
    )  # fmt: skip
    assert cross_check(block, "float", steps=20).passed
    view, native = TargetView(block, "float", TARGETS["cortex-m4"]), NativeView(block, "float")
    params = native.params()
    memory, rng, calls = native.init(params), np.random.default_rng(0), []
    for _ in range(20):
        given = {signal.name: 0.0 for signal in block.entries["step"].inputs}
        given |= {"generator_readings": 0.1 * rng.normal(size=4), "generator_has_readings": True}
        calls.append(Call("step", native.inputs("step", given), memory, params))
        memory = native.call("step", memory, calls[-1].inputs, params).memory
    assert all(answer.status == 0 for answer in view.calls(calls))
    assert view.most["step"].instructions <= 2300
    assert Sizes.of(linked_library(view.toolchain, view.text, list(block.entries), tmp_path)).text <= 9000
