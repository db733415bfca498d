"""Faults that a reviewer planted in the pendulum's C and that once passed every check: each has a check that names it."""

import dataclasses

import pytest
from plantc.codegen.crosscheck import cross_check, make_views
from plantc.codegen.emit import emit
from plantc.codegen.views import NativeView
from plantc.examples.pendulum import pendulum_ekf
from plantc.symbolic import Block


def checked(block, precision, right, wrong, steps=60):
    """Cross-check the C of a block with one thing in it replaced."""
    text = emit(block, precision)
    assert right in text.source, "the fault was not planted"
    native = NativeView(block, precision, text=dataclasses.replace(text, source=text.source.replace(right, wrong)))
    return cross_check(block, precision, views=make_views(block, precision, native), steps=steps)


def failed(check):
    return {result.name for result in check.failures}


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
