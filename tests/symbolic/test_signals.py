"""Ranges, defaults and units of signals."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from plantc.symbolic import ModelError, Status
from plantc.symbolic.signals import (
    STATUS_TEXT,
    Signal,
    check_default,
    make_range,
    power_of_unit,
    product_of_units,
    same_unit,
    spread,
)


def test_the_status_codes_are_the_ones_of_the_design():
    assert {item.name: int(item) for item in Status} == {
        "OK": 0, "GATED": 1, "CLAMPED": 2, "SKIPPED": 3, "RECOVERED": 4,
        "BAD_INPUT": -1, "BAD_PARAM": -2, "NOT_POSITIVE": -3, "OVERFLOW": -4,
    }  # fmt: skip
    assert set(STATUS_TEXT) == set(Status)


@pytest.mark.parametrize("given_", [(1, -1), (0, 0), (math.nan, 1), (0, math.inf), (-math.inf, 0), ([0, 2], [1, 1])])
def test_a_range_that_does_not_rise_is_refused(given_):
    with pytest.raises(ModelError, match=r"cart: the range of input 'u' .* finite and rising"):
        make_range("cart", "input 'u'", given_, (-1, 1), 2)


@pytest.mark.parametrize("given_", [5, (1,), (1, 2, 3), ("a", "b"), "ab", {"low": 1}])
def test_a_range_that_is_no_pair_is_refused(given_):
    with pytest.raises(ModelError, match=r"cart: the range of input 'u'"):
        make_range("cart", "input 'u'", given_, (-1, 1), 2)


def test_a_range_of_another_size_or_too_wide_is_refused():
    with pytest.raises(ModelError, match="3 and 2 ends for 2 elements"):
        make_range("cart", "input 'u'", ([0, 0, 0], [1, 1]), (-1, 1), 2)
    with pytest.raises(ModelError, match="within 1e30"):
        make_range("cart", "input 'u'", (0, 1e31), (-1, 1), 1)


def test_a_range_is_spread_over_the_elements():
    assert make_range("cart", "u", None, (-1, 2), 2) == ((-1, -1), (2, 2))
    assert make_range("cart", "u", (0, [1, 2]), (-1, 2), 2) == ((0, 0), (1, 2))


@pytest.mark.parametrize("value", [2.0, -0.1, math.nan, math.inf])
def test_a_default_outside_its_range_is_refused(value):
    with pytest.raises(ModelError, match=r"value .* of parameter 'p' is outside its range 0 .. 1; change"):
        check_default("cart", "parameter 'p'", value, (0.0,), (1.0,))


def test_a_default_of_the_wrong_kind_or_size_is_refused():
    with pytest.raises(ModelError, match=r"'a'; give 1 number"):
        check_default("cart", "parameter 'p'", "a", (0.0,), (1.0,))
    with pytest.raises(ModelError, match="has 3 elements, 2 are needed"):
        check_default("cart", "parameter 'p'", [0, 0, 0], (0.0, 0.0), (1.0, 1.0))
    assert check_default("cart", "p", [0, 1], (0.0, 0.0), (1.0, 1.0)) == (0.0, 1.0)
    assert spread(3, 2) == (3.0, 3.0)


@pytest.mark.parametrize(
    ("unit", "squared"),
    [("", ""), ("m", "m^2"), ("m/s", "m^2/s^2"), ("m/s^2", "m^2/s^4"), ("N m", "(N m)^2"), ("1/s", "(1/s)^2")],
)
def test_squares_of_units(unit, squared):
    assert power_of_unit(unit, 2) == squared


@settings(max_examples=50, deadline=None, derandomize=True)
@given(unit=st.sampled_from(["m", "m/s", "N m", "rad/s^2", ""]))
def test_a_first_power_is_the_unit_itself(unit):
    assert power_of_unit(unit, 1) == unit
    assert same_unit(unit, unit)
    assert same_unit(unit, "")
    assert product_of_units(unit, unit) == power_of_unit(unit, 2)


def test_units_that_differ():
    assert not same_unit("m", "s")
    assert same_unit("N m", "Nm")
    assert product_of_units("N", "m") == "N m"
    assert product_of_units("N", "") == ""


def test_uniform_range_and_renaming():
    assert Signal("a", 2, low=(0.0, 0.0), high=(1.0, 1.0)).uniform_range == (0.0, 1.0)
    assert Signal("a", 2, low=(0.0, 0.5), high=(1.0, 1.0)).uniform_range is None
    assert Signal("a", doc="d").renamed("b") == Signal("b", doc="d")
