"""connect: order, delays, units, loops, and the composed oracle."""

import copy
from dataclasses import replace

import numpy as np
import pytest

from plantc import (
    Block,
    ModelError,
    NativeView,
    Plant,
    connect,
    cross_check,
    delay,
    emit,
    extended_kalman_filter,
    state_feedback,
    steady_state_kalman_filter,
    wires,
)


def low_pass(name="low_pass", unit="m"):
    block = Block(name)
    raw = block.input("raw", unit=unit, range=(-100, 100))
    weight = block.parameter("weight", 0.25, range=(0, 1))
    smooth = block.memory("smooth", unit=unit, range=(-100, 100))
    following = smooth + weight * (raw - smooth)
    block.entry(
        "step", inputs=[raw], following={smooth: following}, outputs={"value": following}, output_units={"value": unit}
    )
    return block


def cart():
    plant = Plant("cart")
    position = plant.state("position", unit="m", range=(-90, 90))
    speed = plant.state("speed", unit="m/s", range=(-100, 100))
    push = plant.input("push", unit="m/s^2", range=(-5, 5))
    gust = plant.noise("gust", density=0.01, unit="m/s^2")
    plant.dynamics({position: speed, speed: push + gust - speed})
    plant.sensor("gps", position, unit="m", variance=0.5, range=(-95, 95))
    return plant.discretise("exact", dt=0.1)


def test_two_in_a_row_are_called_in_order_whatever_the_order_given():
    block = connect({"second": low_pass(), "first": low_pass()}, {"second.raw": "first.value"}, "chain")
    view = NativeView(block)
    memory, params = view.init(), view.params()
    answer = view.call("step", memory, view.inputs("step", {"first_raw": 8.0}), params)
    assert answer.memory["first"]["smooth"] == 2.0
    assert answer.memory["second"]["smooth"] == 0.5
    assert answer.outputs["second"]["value"] == 0.5


def test_parameters_are_nested_by_part():
    block = connect({"a": low_pass(), "b": low_pass()}, {"b.raw": "a.value"}, "chain")
    view = NativeView(block)
    params = view.params(**{"b__weight": 1.0})
    answer = view.call("step", view.init(params), view.inputs("step", {"a_raw": 8.0}), params)
    assert answer.memory["b"]["smooth"] == 2.0


def test_a_delay_hands_on_the_step_before():
    block = connect({"a": low_pass(), "b": low_pass()}, {"b.raw": delay("a.value", initial=4.0)}, "late")
    view = NativeView(block)
    params = view.params()
    memory = view.init(params)
    seen = []
    for _ in range(2):
        answer = view.call("step", memory, view.inputs("step", {"a_raw": 8.0}), params)
        memory = answer.memory
        seen.append(float(memory["b"]["smooth"]))
    assert seen == [1.0, 1.0 + 0.25 * (2.0 - 1.0)]


def test_a_loop_without_a_delay_is_named():
    with pytest.raises(
        ModelError, match=r"loop: (a -> b -> a|b -> a -> b) feed each other within one step; put a delay"
    ):
        connect({"a": low_pass(), "b": low_pass()}, {"a.raw": "b.value", "b.raw": "a.value"}, "loop")


@pytest.mark.parametrize(
    ("wires", "says"),
    [
        ({"b.raw": "a.nothing"}, "part 'a' has no signal 'nothing'; it has value, smooth"),
        ({"b.row": "a.value"}, "part 'b' has no input 'row'; it has raw"),
        ({"c.raw": "a.value"}, "the wire end 'c.raw' is not part.signal; the parts are a, b"),
    ],
)
def test_a_wire_to_nowhere(wires, says):
    with pytest.raises(ModelError, match=says):
        connect({"a": low_pass(), "b": low_pass()}, wires, "chain")


def test_units_must_match():
    with pytest.raises(ModelError, match=r"joins \[m\] to \[V\]; convert the unit, or mend the wire"):
        connect({"a": low_pass(), "b": low_pass(unit="V")}, {"b.raw": "a.value"}, "chain")


def test_a_filter_feeds_another_and_all_views_agree():
    ekf = extended_kalman_filter(cart(), initial_variance={"position": 10, "speed": 1})
    steady = steady_state_kalman_filter(cart())
    block = connect({"ekf": ekf, "steady": steady}, {"steady.gps": "ekf.position"}, "pair")
    check = cross_check(block, steps=40)
    assert check.passed, [str(item) for item in check.failures]
    assert any(result.name == "native = reference" and result.calls > 50 for result in check.results)


def test_a_refused_part_refuses_the_whole_and_changes_nothing():
    block = connect({"a": low_pass(), "b": low_pass()}, {"b.raw": "a.value"}, "chain")
    view = NativeView(block)
    params = view.params()
    memory = view.init(params)
    memory["b"]["smooth"] = 7.0
    answer = view.call("step", memory, view.inputs("step", {"a_raw": np.nan}), params)
    assert answer.status < 0
    assert answer.memory.tobytes() == memory.tobytes()


def test_without_every_oracle_there_is_none():
    ekf = extended_kalman_filter(cart(), initial_variance={"position": 10, "speed": 1})
    assert connect({"ekf": ekf, "low": low_pass()}, {"low.raw": "ekf.position"}, "half").oracle is None
    assert connect({"ekf": ekf}, {}, "alone").oracle is not None


def test_wires_join_what_has_the_same_name():
    plant = cart()
    assert wires("ekf", "other", plant.states) == {"other.position": "ekf.position", "other.speed": "ekf.speed"}
    assert wires("a", "b", ["push"], initial={plant.inputs[0]: 2.0}) == {"b.push": delay("a.push", 2.0)}
    with pytest.raises(ModelError, match=r"the wires a -> b: initial= has no value for 'push'; it has pull"):
        wires("a", "b", ["push"], initial={"pull": 2.0})


def test_parts_share_one_time_step():
    ekf = extended_kalman_filter(cart(), initial_variance={"position": 10, "speed": 1})
    assert connect({"ekf": ekf, "low": low_pass()}, {"low.raw": "ekf.position"}, "one").sample_time == 0.1
    slow = low_pass()
    slow.sample_time = 0.5
    with pytest.raises(ModelError, match=r"different time steps \(ekf 0.1 s, low 0.5 s\); a composition has one"):
        connect({"ekf": ekf, "low": slow}, {"low.raw": "ekf.position"}, "two")


def test_designed_numbers_reach_a_composition_of_compositions():
    steady = steady_state_kalman_filter(cart())
    inner = connect({"steady": steady}, {}, "inner")
    outer = connect({"inner": inner, "low": low_pass()}, {"low.raw": "inner.steady.position"}, "outer")
    assert list(outer.design.values) == ["inner.steady.gain"]
    assert all(value <= limit for value, limit in outer.design.properties(outer.design.values).values())
    changed = outer.design.rebuild({"inner.steady.gain": [[0.5], [0.25]]})
    assert changed.model_hash() != outer.model_hash()
    assert changed.parts["inner"].parts["steady"].design.values["gain"].tolist() == [[0.5], [0.25]]
    assert outer.parts["inner"].parts["steady"] is steady
    check = cross_check(changed.parts["inner"], steps=20)  # the oracle has the new gain, too
    assert check.passed, [str(item) for item in check.failures]
    assert any(result.name == "native = reference" for result in check.results)


def test_a_part_without_parameters_and_memory_can_be_composed():
    twice = Block("twice")
    raw = twice.input("raw", unit="m", range=(-50, 50))
    twice.entry("step", inputs=[raw], outputs={"value": 2 * raw})
    block = connect({"twice": twice, "smooth": low_pass()}, {"smooth.raw": "twice.value"}, "chain")
    view = NativeView(block)
    answer = view.call("step", view.init(), view.inputs("step", {"twice_raw": 8.0}), view.params())
    assert answer.memory["smooth"]["smooth"] == 4.0
    alone = NativeView(connect({"twice": twice}, {}, "alone"))
    assert (
        alone.call("step", alone.init(), alone.inputs("step", {"twice_raw": 8.0}), alone.params()).outputs["twice"][
            "value"
        ]
        == 16
    )


def law_of(reach):
    """A law of a cart whose track is so long."""
    plant = Plant("short_cart")
    position = plant.state("position", unit="m", range=(-reach, reach))
    push = plant.input("push", unit="m/s^2", range=(-1000, 1000))
    plant.dynamics({position: push})
    return state_feedback(plant, {}, [[0.5]], name="law")


def with_law(law, source="ekf.position", **options):
    ekf = extended_kalman_filter(cart(), initial_variance={"position": 10, "speed": 1})
    return connect({"ekf": ekf, "law": law}, {"law.position": source}, "pair", **options)


def test_what_a_part_has_judged_is_not_judged_again(needs):
    needs("gcc")
    law = law_of(90)
    once, twice = with_law(law, settled=True), with_law(law)
    assert once.parts["law"].entries["step"].settled == ("position",)
    assert twice.parts["law"].entries["step"].settled == law.entries["step"].settled == ()
    assert "status = PAIR_BAD_INPUT" in emit(twice).source.split("pair_law_step_core")[1].split("\n}\n")[0]
    assert "status = PAIR_BAD_INPUT" not in emit(once).source.split("pair_law_step_core")[1].split("\n}\n")[0]
    assert cross_check(once, steps=20).passed
    # a wider source and what comes a step late are judged by whoever takes them
    assert with_law(law_of(80), settled=True).parts["law"].entries["step"].settled == ()
    assert with_law(law, delay("ekf.position"), settled=True).parts["law"].entries["step"].settled == ()


def test_a_judgement_left_out_where_it_was_needed_is_seen(needs):
    needs("gcc")
    block = with_law(law_of(40), settled=True)
    assert cross_check(block, steps=20).passed
    law = copy.copy(block.parts["law"])
    law.entries = {**law.entries, "step": replace(law.entries["step"], settled=("position",))}
    block.parts["law"] = law
    assert not cross_check(block, steps=20).passed


def test_a_part_that_is_no_block_is_said():
    plant = Plant("tank", dt=1.0)
    with pytest.raises(
        ModelError, match="whole: the part 'tank' is the Plant 'tank'; give a Block, such as an estimator"
    ):
        connect({"tank": plant}, {}, "whole")
    with pytest.raises(ModelError, match="whole: part 0 is 5, of type int; give a Block"):
        connect([5], {}, "whole")
