"""Arguments of another kind than is wanted: a sentence wherever a user may give one."""

import numpy as np
import pytest
from plantc.symbolic.errors import expect, whole, yes_or_no

from plantc import (
    ModelError,
    OperatingPoint,
    Plant,
    extended_kalman_filter,
    kalman_filter,
    linearise,
    state_feedback,
    steady_state_kalman_filter,
)


def tank():
    plant = Plant("tank", dt=0.1)
    level = plant.state("level", range=(-10, 10))
    flow = plant.input("flow", range=(-5, 5))
    plant.dynamics({level: 0.9 * level + flow})
    plant.sensor("gauge", level, variance=0.1)
    return plant


@pytest.mark.parametrize("made", [extended_kalman_filter, kalman_filter])
def test_a_filter_of_what_is_no_plant(made):
    with pytest.raises(
        ModelError, match="the plant is of type .*Linearisation.*; give a discrete Plant|the plant is .*Linearisation"
    ):
        made(linearise(tank()), initial_variance={})
    with pytest.raises(ModelError, match="the plant is 3, of type int; give a discrete Plant"):
        steady_state_kalman_filter(3)


def test_a_point_is_a_dictionary():
    with pytest.raises(
        ModelError, match=r"tank: the operating point is \[0, 0\], of type list; give {state or input: value}"
    ):
        linearise(tank(), [0, 0])
    with pytest.raises(ModelError, match="its plant is 'tank', of type str; give a Plant"):
        OperatingPoint.at("tank", {})
    with pytest.raises(ModelError, match="the operating point is"):
        state_feedback(tank(), [[0.4]], {})


@pytest.mark.parametrize("given", [(-1, 1), 1, "yes", {"flow": (-1, 1)}])
def test_limits_are_no_truth_value(given):
    with pytest.raises(ModelError, match="tank_feedback: saturate= is .*; give True or False"):
        state_feedback(tank(), {}, [[0.4]], saturate=given)
    assert (
        state_feedback(tank(), {}, [[0.4]], saturate=np.True_).notes
        == state_feedback(tank(), {}, [[0.4]], saturate=True).notes
    )


def test_dynamics_are_given_once():
    plant = tank()
    with pytest.raises(ModelError, match="tank: its dynamics are given already; give the rates of all states in one"):
        plant.dynamics({"level": 0.0})


def test_what_the_helpers_say():
    expect(1, int, "x", "y")
    assert whole(np.int8(3), "n", 1) == 3
    assert yes_or_no(np.False_, "b") is False
    with pytest.raises(ModelError, match="n is 2.0; give a whole number from 1 to 3"):
        whole(2.0, "n", 1, 3)
    with pytest.raises(ModelError, match="x is of type list; give y"):
        expect(list(range(100)), int, "x", "y")
