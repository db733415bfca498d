"""The cross-check passes on what is right, and each planted fault is caught by a named check."""

import dataclasses

import numpy as np
import pytest
from plantc.codegen import crosscheck
from plantc.codegen.crosscheck import cross_check, make_views
from plantc.codegen.emit import emit
from plantc.codegen.package import ExportError, export
from plantc.codegen.views import NativeView, ReferenceView
from plantc.symbolic import Block, sin
from plantc.symbolic import estimators as estimators_module
from plantc.symbolic.kernels import Congruence, RowUpdate

from plantc import Plant, extended_kalman_filter


def small_filter():
    """A pendulum with two sensors, one a vector with correlated noise: every kernel is in it."""
    plant = Plant("swing")
    angle = plant.state("angle", unit="rad", angle=True)
    rate = plant.state("rate", unit="rad/s", range=(-100, 100))
    push = plant.input("push", unit="N m", range=(-5, 5))
    gust = plant.noise("gust", density=0.01, unit="N m")
    plant.dynamics({angle: rate, rate: push + gust - 4 * sin(angle)})
    plant.sensor("encoder", angle, unit="rad", angle=True, variance=1e-3)
    plant.sensor("pair", [2 * rate, rate + sin(angle)], variance=[[0.02, 0.005], [0.005, 0.01]], range=(-1000, 1000))
    return extended_kalman_filter(
        plant.discretise("rk4", dt=(1e-3, 0.05)), initial_variance={angle: 0.3, rate: 0.5}, gate={"encoder": 9.0}
    )


@pytest.fixture(scope="module")
def block():
    return small_filter()


def failed(check):
    return {result.name for result in check.failures}


def test_all_views_agree_in_double(block):
    check = cross_check(block, "double", steps=60)
    assert check.passed, [str(item) for item in check.failures]
    names = {result.name for result in check.results}
    assert {
        "interpret = reference",
        "native = reference",
        "native = interpret",
        "a refused call changes nothing",
    } <= names
    assert {
        "OK",
        "GATED",
        "BAD_INPUT",
        "BAD_PARAM",
        "SKIPPED",
        "RECOVERED",
        "CLAMPED",
        "NOT_POSITIVE",
        "OVERFLOW",
    } == set(check.statuses)


def test_float_agrees_with_double_within_its_bound(block):
    check = cross_check(block, "float", steps=60)
    assert check.passed, [str(item) for item in check.failures]
    result = next(item for item in check.results if item.name == "float = double")
    assert 1e-8 < result.worst < 0.05  # it is float indeed, and near enough


# -- planted faults -----------------------------------------------------------------------------------------------------


def with_c(block, change, precision="double"):
    text = emit(block, precision)
    source = change(text.source)
    assert source != text.source, "the fault was not planted"
    return make_views(block, precision, NativeView(block, precision, text=dataclasses.replace(text, source=source)))


def sign_flipped(source):
    """Flip a sign in the first row of the measurement update."""
    head, tail = source.split("static swing_ekf_status_t swing_ekf_update_pair_core", 1)
    row = tail.index("/* row 0")
    return (
        head
        + "static swing_ekf_status_t swing_ekf_update_pair_core"
        + tail[:row]
        + tail[row:].replace(" + (", " - (", 1)
    )


def test_a_fault_in_the_emitter_is_caught(block):
    views = with_c(block, sign_flipped)
    check = cross_check(block, views=views, steps=40)
    assert "native = reference" in failed(check)
    mismatch = next(item for item in check.failures if item.name == "native = reference").mismatch
    assert mismatch.left == "native"
    assert mismatch.left_value != mismatch.right_value
    assert mismatch.signal


def test_an_indefinite_matrix_that_init_lets_pass_is_caught(block):
    views = with_c(
        block, lambda source: source.replace("params->variance_pair[2] - (", "params->variance_pair[2] + (", 1)
    )
    check = cross_check(block, views=views, steps=30)
    mismatch = next(item for item in check.failures if item.name == "native = reference").mismatch
    assert (mismatch.entry, mismatch.left_value, mismatch.right_value) == ("init", "OK", "BAD_PARAM")


def test_a_commit_before_the_judgement_is_caught(block):
    def early(source):
        marker = "static swing_ekf_status_t swing_ekf_step_core"
        head, tail = source.split(marker, 1)
        old = "    if (status >= SWING_EKF_OK)\n    {\n        *state = after;\n    }"
        assert old in tail
        return head + marker + tail.replace(old, "    *state = after;")

    views = with_c(block, early)
    assert "a refused call changes nothing" in failed(cross_check(block, views=views, steps=30))


def test_a_range_check_left_out_is_caught(block):
    views = with_c(
        block, lambda source: source.replace("((push >= -5.0) == true) && ((push <= 5.0) == true) && ", "", 1)
    )
    assert "native = reference" in failed(cross_check(block, views=views, steps=30))


def test_a_fault_in_a_jacobian_is_caught(monkeypatch):
    original = estimators_module.transition

    def wrong(plant):
        following, F = original(plant)
        return following, F * 1.0001

    monkeypatch.setattr(estimators_module, "transition", wrong)
    check = cross_check(small_filter(), steps=40)
    assert {"F = complex step", "interpret = reference", "native = reference"} <= failed(check)


def test_a_fault_in_a_kernel_is_caught(block, monkeypatch):
    original = RowUpdate.scalar

    def wrong(self, *values):
        updated, *rest = original(self, *values)
        updated[1] = -updated[1]
        return [updated, *rest]

    monkeypatch.setattr(RowUpdate, "scalar", wrong)
    check = cross_check(block, views=make_views(block, "double"), steps=40)
    assert {"native = reference", "native = interpret"} <= failed(check)
    assert "interpret = reference" not in failed(check)


def test_a_fault_in_the_dense_form_of_a_kernel_is_caught(block, monkeypatch):
    monkeypatch.setattr(
        Congruence, "dense", lambda self, *values: [np.asarray(values[1]).copy()]
    )  # P stays as it was: no F, no Q
    assert "interpret = reference" in failed(cross_check(block, steps=40))


def test_a_fault_in_the_reference_is_caught(block, monkeypatch):
    original = ReferenceView.call

    def wrong(self, entry, memory, inputs, params):
        answer = original(self, entry, memory, inputs, params)
        if entry == "predict" and answer.status >= 0:
            answer.memory["rate"] += 1e-6
        return answer

    monkeypatch.setattr(ReferenceView, "call", wrong)
    check = cross_check(block, steps=60)
    assert {"interpret = reference", "native = reference"} <= failed(check)
    assert "native = interpret" not in failed(check)


def test_a_float_that_is_too_coarse_is_caught(block):
    views = with_c(block, lambda source: source.replace("delta[0] = ", "delta[0] = 1.3f * ", 1), "float")
    assert "float = double" in failed(cross_check(block, "float", views=views, steps=60))


def test_a_mismatch_fails_the_export_and_writes_nothing(block, tmp_path):
    text = emit(block)
    faulty = dataclasses.replace(text, source=sign_flipped(text.source))
    with pytest.raises(ExportError, match=r"native = \w+.*step \d+, entry \w+, (memory|outputs|status)"):
        export(block, tmp_path, steps=30, native=NativeView(block, text=faulty))
    assert list(tmp_path.iterdir()) == []


# -- what is counted, not judged ----------------------------------------------------------------------------------------


def test_a_block_without_an_oracle_says_so():
    low_pass = Block("low_pass")
    raw = low_pass.input("raw", range=(-10, 10))
    smooth = low_pass.memory("smooth", range=(-20, 20))
    low_pass.entry("step", inputs=[raw], following={smooth: 0.9 * smooth + 0.1 * raw}, outputs={"value": smooth})
    check = cross_check(low_pass, steps=30)
    assert check.passed
    assert any("no independent reference" in result.not_judged for result in check.results)


def test_a_trace_that_is_refused_throughout_is_a_failure():
    never = Block("never")
    raw = never.input("raw", range=(0, 10))
    kept = never.memory("kept", range=(-1, 1))
    never.entry("step", inputs=[raw], following={kept: raw + 5})
    assert "nominal calls are accepted" in failed(cross_check(never, steps=30))


def test_too_many_calls_at_switches_are_a_failure(block, monkeypatch):
    """Planted: were every status difference excused, a wrong gate would pass; the count stops it."""
    monkeypatch.setitem(crosscheck.SWITCH_MARGIN, "double", 1e9)
    views = with_c(block, lambda source: source.replace("(nis[0] <= gate)", "(nis[0] > gate)"))
    check = cross_check(block, views=views, steps=100)
    assert not check.passed


def test_the_stream_of_the_traces_is_frozen():
    stream = crosscheck.FrozenStream(0)
    assert stream.normal() == pytest.approx(1.764052345967664, abs=0)
    again = crosscheck.FrozenStream(0)
    assert again.normal(size=3).tolist() == pytest.approx(
        [1.764052345967664, 0.4001572083672233, 0.9787379841057392], abs=0
    )


# -- faults that an earlier cross-check let pass ------------------------------------------------------------------------

REVIEWED = [
    ("nis[0] <= gate", "nis[0] > gate"),
    ("SWING_EKF_GATED)", "SWING_EKF_CLAMPED)"),
    ("after->rejected_encoder + 1U", "after->rejected_encoder + 7U"),
    ("                *after = *before;\n", ""),
    ("params->inflation", "(50.0 + (0.5 * params->inflation))"),
    ("(push <= 5.0)", "(push <= 25.0)"),
    ("(dt <= 0.05)", "(dt <= 0.45)"),
    ("(dt >= 0.001)", "(dt >= 0.000001)"),
    ("(encoder <= 1000.0)", "(encoder <= 5000.0)"),
    ("latest->rejected_encoder >= params->reject_limit", "latest->rejected_encoder > params->reject_limit"),
]


@pytest.mark.parametrize(("right", "wrong"), REVIEWED, ids=[right.strip() for right, _ in REVIEWED])
def test_a_fault_that_was_once_missed_is_caught(block, right, wrong):
    check = cross_check(block, views=with_c(block, lambda source: source.replace(right, wrong)), steps=60)
    assert "native = reference" in failed(check)


def test_a_parameter_frozen_at_its_default_is_caught():
    plant = Plant("cart")
    speed = plant.state("speed", range=(-100, 100))
    mass = plant.parameter("mass", 2.0, range=(0.1, 10))
    gust = plant.noise("gust", density=0.1)
    plant.dynamics({speed: (gust - speed) / mass})
    plant.sensor("wheel", speed, variance=0.1)
    cart = extended_kalman_filter(plant.discretise("euler", dt=0.1), initial_variance={speed: 1.0})
    assert cross_check(cart, steps=40).passed
    views = with_c(
        cart, lambda source: source.replace("params->mass", "2.0").replace("(2.0 >= 0.1) && (2.0 <= 10.0) && ", "")
    )
    assert "native = reference" in failed(cross_check(cart, views=views, steps=40))


@pytest.mark.parametrize("precision", ["double", "float"])
def test_models_at_the_edge_pass(precision):
    """One state; a rate that depends on nothing; kinks where the states start; a sensor that leaves P singular."""
    from plantc.symbolic import fabs, fmax

    tank = Plant("tank")
    level = tank.state("level", unit="m")
    rain = tank.noise("rain", density=0.1)
    tank.dynamics({level: -fabs(level) + fmax(level, 0) + rain})
    tank.sensor("gauge", level, unit="m", std=0.1)
    body = Plant("body")
    q = body.attitude("q")
    rate = body.input("rate", size=3, unit="rad/s", range=(-40, 40))
    noise = body.noise("rate_noise", size=3, density=1e-6, unit="rad/s")
    body.dynamics({q: rate + noise})
    body.sensor("accelerometer", q.to_body([0, 0, -9.81]), std=0.5, unit="m/s^2")
    for plant, start in ((tank, {level: 1.0}), (body, {q: 0.04})):
        made = extended_kalman_filter(plant.discretise("euler", dt=0.01), initial_variance=start)
        check = cross_check(made, precision, steps=40)
        assert check.passed, [(item.name, str(item.mismatch), item.note) for item in check.failures]


def test_an_innovation_that_is_no_number_is_refused_and_not_counted():
    from plantc.symbolic import log

    plant = Plant("odd")
    x = plant.state("x", range=(-10, 10))
    w = plant.noise("w", density=0.1)
    plant.dynamics({x: w - x})
    plant.sensor("y", log(x), variance=0.1)
    made = extended_kalman_filter(
        plant.discretise("euler", dt=0.1), initial_variance={x: 1.0}, around={x: 2.0}, gate={"y": 4.0}
    )
    for view in (NativeView(made), ReferenceView(made)):
        memory = view.memory(x=-1.0, covariance=1.0)
        answer = view.call("update_y", memory, view.inputs("update_y", {"y": 0.0}), view.params())
        assert answer.status.name in ("OVERFLOW", "NOT_POSITIVE")
        assert answer.memory["rejected_y"] == 0


def test_a_block_with_nothing_to_remember():
    square = Block("square")
    raw = square.input("raw", range=(-10, 10))
    square.entry("step", inputs=[raw], outputs={"value": raw * raw})
    assert cross_check(square, steps=20).passed


class Answering:
    """A view that gives one number for another wherever a call is accepted."""

    def __init__(self, inner, number):
        self.inner, self.number = inner, number

    def __getattr__(self, name):
        return getattr(self.inner, name)

    def call(self, entry, memory, inputs, params):
        answer = self.inner.call(entry, memory, inputs, params)
        if entry != "step" or answer.status < 0:
            return answer
        outputs = answer.outputs.copy()
        outputs["plain"] = self.number
        return dataclasses.replace(answer, outputs=outputs)


@pytest.mark.parametrize("trace", ["nominal", *crosscheck.IMPLAUSIBLE])
@pytest.mark.parametrize("number", [np.nan, -555.0])
def test_where_every_neighbour_is_refused_a_wrong_number_is_still_wrong(trace, number):
    # at the very point every rounding away has the call refused: that excuses a last bit, not a NaN
    block = Block("cancelling")
    x = block.input("x", size=40, range=(-100, 100))
    weights = [1 + 0.3717 * k for k in range(20)]
    cancelled = 1e18 * sum(weights[k] * (x[2 * k] - x[2 * k + 1]) for k in range(20))
    outputs, ranges = {"cancelled": cancelled, "plain": x[0] + 1}, {"cancelled": (-1, 1), "plain": (-1e3, 1e3)}
    block.entry("step", inputs=[x], outputs=outputs, output_ranges=ranges)
    views = make_views(block, "double")
    params = views.native.params()
    memory, inputs = views.native.init(params), views.native.inputs("step", {"x": np.full(40, 0.7)})
    probe = crosscheck.Probe(trace, 0, "step", memory, inputs, params)
    whole = crosscheck.Lockstep(block, "double", views)
    whole.compare(probe)
    assert whole.agreement("agreement").passed
    assert np.isinf(whole._explained(probe, "outputs", "plain", {}))
    broken = crosscheck.Lockstep(block, "double", dataclasses.replace(views, native=Answering(views.native, number)))
    broken.compare(probe)
    assert not broken.agreement("agreement").passed
