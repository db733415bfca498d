"""The shipped vectors reach every statement and status that can be reached, by rule."""

import pytest
from plantc.codegen.package import _rare_calls
from plantc.codegen.selection import CLOSELY, features, reachable
from plantc.codegen.vectors import choose_vectors
from plantc.examples.pendulum import pendulum_ekf
from plantc.symbolic.signals import Status


def reached(table):
    return frozenset().union(*[features(v.entry, Status[v.status], v.visits) for v in table.vectors])


def beyond_init(missing):
    """Leave out that init holds variances: those that it accepts are within floor and ceiling for most filters."""
    return frozenset(item for item in missing if item[-1] != CLOSELY or item[1] != "init")


def test_nothing_that_can_be_reached_is_left_out(small_shape):
    table = choose_vectors(small_shape, "double", _rare_calls(small_shape, "double"))
    missing = beyond_init(reachable(small_shape) - reached(table))
    if small_shape.name == "two_filters":  # what the first part gives is in range already
        assert {item[1:] for item in missing} == {
            ("second.step", ("judged", 0), "BAD_INPUT"), ("step", ("body", 3), "OVERFLOW"),
        }  # fmt: skip
    else:
        assert missing == frozenset()
    assert len(table.vectors) <= 60


@pytest.mark.slow
def test_nothing_is_left_out_of_a_large_one(shape_named):
    block = shape_named("attitude_ekf")
    table = choose_vectors(block, "float", _rare_calls(block, "float"))
    left = beyond_init(reachable(block) - reached(table))
    # init judges the attitude it has scaled to unit length, which cannot fail
    assert {(feature[0], feature[1], feature[-1]) for feature in left} <= {("ran", "init", "OVERFLOW")}


def test_without_crafted_calls_something_is_left_out(monkeypatch):
    monkeypatch.setattr("plantc.codegen.vectors.crafted", lambda *args: iter(()))
    table = choose_vectors(pendulum_ekf, "double", _rare_calls(pendulum_ekf, "double"))
    assert reachable(pendulum_ekf) - reached(table)


def test_the_choice_is_the_same_every_time():
    first, second = (choose_vectors(pendulum_ekf, "float", _rare_calls(pendulum_ekf, "float")) for _ in range(2))
    assert [(v.entry, v.status, v.start) for v in first.vectors] == [
        (v.entry, v.status, v.start) for v in second.vectors
    ]
