"""Calls that put arguments of piecewise functions where they are wanted."""

from collections import Counter

import casadi as ca
from plantc.codegen.crosscheck import ON_KINKS, cross_check
from plantc.codegen.kinks import on_every_piece
from plantc.codegen.layout import flatten
from plantc.codegen.vectors import choose_vectors
from plantc.codegen.views import InterpretView
from plantc.examples.pendulum import pendulum_ekf
from plantc.symbolic.piecewise import look_up, saturated

from plantc import Block, connect


def valve(name="valve"):
    block = Block(name)
    command = block.input("command", range=(-20, 20))
    lift = block.memory("lift", range=(-20, 20))
    block.entry(
        "step",
        inputs=[command],
        following={lift: saturated(2 * command - 1, -3, 5)},
        outputs={"flow": look_up(lift, [0, 1, 4], [0, 2, 3]), "odd": look_up(ca.sin(lift), [0.1, 0.7], [1, 2])},
    )
    return block


def moves(block, entry="step"):
    view = InterpretView(block)
    given = flatten(view.init()), flatten(view.inputs(entry, {})), flatten(view.params())
    return on_every_piece(block, block.entries[entry], *given)


def test_every_kink_and_every_piece_is_met():
    found = moves(valve())
    commands = {item.number: item.on_kink for item in found if item.element.place.name == "command"}
    assert commands.keys() >= {-1.0, 3.0, 1.0}  # 2 u - 1 = -3, 5, and 1 between
    assert min(commands) < -1.0
    assert max(commands) > 3.0
    assert commands[-1.0]
    assert commands[3.0]
    assert not commands[1.0]
    lifts = {item.number for item in found if item.on_kink and item.element.place.name == "lift"}
    assert {0.0, 1.0, 4.0} <= lifts


def test_a_kink_that_single_precision_misses_is_left_out():
    block = Block("rounded")
    x = block.input("x", range=(-20, 20))
    block.entry("step", inputs=[x], following={}, outputs={"y": saturated(x, -0.1, 0.5)})
    assert {item.number for item in moves(block) if item.on_kink} == {0.5}


def test_parts_of_a_composition_are_moved_too():
    block = connect({"first": valve(), "second": valve()}, {"second.command": "first.flow"}, "two_valves")
    names = {item.element.place.name for item in moves(block)}
    assert {"first.lift", "second.lift"} <= names


def test_a_block_without_them_is_called_as_before():
    assert not moves(pendulum_ekf, "predict")
    assert all(probe.trace != ON_KINKS for probe in cross_check(pendulum_ekf, "double", steps=20).calls)


def test_vectors_meet_every_piece_and_every_kink():
    block = valve()
    check = cross_check(block, "float", steps=40)
    assert check.passed
    assert any(probe.trace == ON_KINKS for probe in check.calls)
    table = choose_vectors(block, "float", check)
    met = {
        visit.outcome for vector in table.vectors if vector.status == "OK" for visit in vector.visits if visit.outcome
    }
    pieces = {f"saturation 1: {where}" for where in ("piece 0", "kink 0", "piece 1", "kink 1", "piece 2")}
    pieces |= {f"look_up 2: {where} {k}" for where, count in (("piece", 4), ("kink", 3)) for k in range(count)}
    assert pieces <= met
    statuses = Counter(vector.status for vector in table.vectors)
    assert statuses.pop("OK") > len(table.vectors) / 2
    assert statuses == dict.fromkeys(
        ("BAD_INPUT", "BAD_PARAM", "OVERFLOW"), 1
    )  # one call for each way of being refused
