"""Faults that a reviewer planted in the pendulum's C and that once passed every check: each has a check that names it."""

import dataclasses
import re

import pytest
from plantc.codegen import crosscheck
from plantc.codegen.crosscheck import cross_check, make_views
from plantc.codegen.emit import emit
from plantc.codegen.package import _rare_calls
from plantc.codegen.vectors import choose_vectors
from plantc.codegen.views import NativeView
from plantc.examples.pendulum import pendulum_ekf
from plantc.symbolic import Block
from plantc.symbolic.block import Scenario


def checked(block, precision, right, wrong, steps=60):
    """Cross-check the C of a block with one thing in it replaced."""
    text = emit(block, precision)
    assert right in text.source, "the fault was not planted"
    native = NativeView(block, precision, text=dataclasses.replace(text, source=text.source.replace(right, wrong)))
    return cross_check(block, precision, views=make_views(block, precision, native), steps=steps)


def failed(check):
    return {result.name for result in check.failures}


def named(results, name):
    return next(item for item in results if item.name == name)


def low_pass():
    block = Block("low_pass", doc="first-order low-pass filter")
    raw = block.input("raw", unit="V", range=(-10, 10))
    weight = block.parameter("weight", 0.1, range=(0, 1))
    smooth = block.memory("smooth", unit="V", range=(-10, 10))
    following = smooth + weight * (raw - smooth)
    block.entry("step", inputs=[raw], following={smooth: following}, outputs={"filtered": following})
    return block


STATUSES = {"double": "native = interpret", "float": "float statuses = interpret"}
NUMBERS = {"double": "native = interpret", "float": "float = double"}


@pytest.mark.parametrize("precision", ["double", "float"])
def test_an_integer_comparison_at_equality_is_no_switch(precision):
    recovery = "latest->rejected_encoder >= params->reject_limit"
    check = checked(pendulum_ekf, precision, recovery, recovery.replace(">=", ">"))
    assert STATUSES[precision] in failed(check)


@pytest.mark.parametrize("precision", ["double", "float"])
def test_a_counter_that_does_not_saturate_is_caught(precision):
    saturation = "after->rejected_encoder < UINT32_MAX"
    check = checked(pendulum_ekf, precision, saturation, saturation.replace("<", "<="))
    mismatch = next(item for item in check.failures if item.name == NUMBERS[precision]).mismatch
    assert (mismatch.signal, mismatch.left_value, mismatch.right_value) == (
        "memory rejected_encoder", "0", "4294967295",
    )  # fmt: skip


GIVEN = [
    ("raw <= 10.0f", "raw <= 1.0e30f"),
    ("raw <= 10.0f", "raw <= 5.0f"),
    ("params->weight <= 1.0f", "params->weight <= 1.0e30f"),
    ("raw >= -10.0f", "raw >= -9.999999f"),
]


@pytest.mark.parametrize(("right", "wrong"), GIVEN)
def test_a_verdict_on_what_was_given_is_exact_in_float_without_an_oracle(right, wrong):
    assert {"verdicts on inputs and parameters", "float statuses = interpret"} & failed(
        checked(low_pass(), "float", right, wrong)
    ) == {"verdicts on inputs and parameters", "float statuses = interpret"}


@pytest.mark.parametrize(
    ("precision", "right", "wrong"),
    [
        ("float", "encoder <= 1000.0f", "encoder <= 1.0e30f"),
        ("double", "params->length <= 100.0", "params->length <= 1.0e30"),
    ],
)
def test_a_wider_range_of_the_pendulum_is_caught_by_the_verdicts(precision, right, wrong):
    assert "verdicts on inputs and parameters" in failed(checked(pendulum_ekf, precision, right, wrong))


@pytest.mark.parametrize("precision", ["double", "float"])
def test_ends_that_single_precision_rounds_are_judged_as_the_c_has_them(precision):
    """0.1 and 0.7 are no floats: a value between the number and its rounding is accepted by one precision alone."""
    block = Block("thirds")
    raw = block.input("raw", range=(-0.1, 0.7))
    kept = block.memory("kept", range=(-0.1, 0.7))
    block.entry("step", inputs=[raw], following={kept: raw})
    check = cross_check(block, precision, steps=40)
    verdicts = next(item for item in check.results if item.name == "verdicts on inputs and parameters")
    assert verdicts.passed
    assert verdicts.calls > 5


def test_a_wrong_constant_is_no_rounding():
    """A wrap that turns by 6.283: far less than a sensor refused a rounding away causes, far more than rounding."""
    result = named(checked(pendulum_ekf, "float", "6.2831855f", "6.283f", steps=100).results, "float = double")
    assert not result.passed
    assert result.mismatch.difference > 0.05


def test_what_is_excused_is_bounded_and_shown(monkeypatch):
    """Planted: were every difference rounding's own, the wrong constant would pass; the largest excused one is shown."""
    monkeypatch.setattr(crosscheck, "LARGEST_GROWTH", 1e9)
    result = named(checked(pendulum_ekf, "float", "6.2831855f", "6.283f", steps=100).results, "float = double")
    assert result.passed
    assert re.search(
        r"ill-conditioned of \d+ calls; the largest differs by [\d.]+ at adversarial step \d+, step", result.note
    )
    assert "one unit in the last place causes" in result.note


def test_too_many_excused_differences_are_a_failure(monkeypatch):
    monkeypatch.setattr(crosscheck, "LARGEST_GROWTH", 1e9)
    gain = "const float per_s = 1.0f / ("
    result = named(checked(pendulum_ekf, "float", gain, gain.replace("1.0f", "1.5f")).results, "float = double")
    assert not result.passed
    assert "more than 5 % of the calls" in result.note


def test_a_gain_that_is_2_percent_off_is_no_rounding():
    check = checked(low_pass(), "float", "params->weight * ", "(1.02f * params->weight) * ")
    assert failed(check) == {"float = double"}


def test_a_candidate_on_which_c_and_model_differ_is_a_failure_not_a_drop():
    """The fault that the cross-check would see too is seen by the choice of vectors alone."""
    text = emit(pendulum_ekf, "float")
    right, wrong = "encoder <= 1000.0f", "encoder <= 1.0e30f"
    faulty = NativeView(pendulum_ekf, "float", text=dataclasses.replace(text, source=text.source.replace(right, wrong)))
    calls = _rare_calls(pendulum_ekf, "float", faulty)
    agreement = choose_vectors(pendulum_ekf, "float", calls, faulty).agreement
    assert (agreement.passed, agreement.mismatch.right_value) == (False, "BAD_INPUT")
    good = choose_vectors(pendulum_ekf, "float", _rare_calls(pendulum_ekf, "float")).agreement
    assert good.passed
    assert good.calls > 10


def test_nominal_calls_that_are_refused_are_counted_by_status():
    block = Block("narrow", doc="a memory that its own scenario leaves in one call of ten")
    raw = block.input("raw", range=(-10, 10))
    kept = block.memory("kept", range=(-1, 1))
    block.entry("step", inputs=[raw], following={kept: raw})

    def calls(rng, steps):
        yield "init", {}
        for k in range(steps):
            yield "step", {"raw": 5.0 if k % 10 == 0 else 0.5}

    block.scenario = Scenario(calls, lambda rng: {"kept": 0.0})
    result = named(cross_check(block, steps=100).results, "nominal calls are accepted")
    assert not result.passed
    assert result.note == (
        "10 of 101 nominal calls were refused (10 OVERFLOW), more than 5 %; widen the ranges of what is refused, "
        "or mend the scenario"
    )
