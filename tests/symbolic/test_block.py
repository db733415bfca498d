"""A user's own Block: what it computes, what it refuses, and a hash that is the same everywhere."""

import os
import subprocess
import sys

import casadi as ca
import numpy as np
import pytest
from plantc.codegen.crosscheck import cross_check
from plantc.codegen.emit import emit
from plantc.codegen.layout import flatten
from plantc.codegen.views import InterpretView, NativeView
from plantc.symbolic import Block, ModelError, Status, fmin, vertcat


def low_pass(weight=0.25, doc="a filter", status=Status.BAD_INPUT):
    block = Block("low_pass", doc=doc)
    raw = block.input("raw", unit="V", range=(-10, 10))
    share = block.parameter("weight", weight, range=(0, 1))
    smooth = block.memory("smooth", initial=1.0, unit="V", range=(-5, 5))
    following = smooth + share * (raw - smooth)
    block.entry(
        "step",
        inputs=[raw],
        following={smooth: following},
        outputs={"filtered": following, "both": [raw, smooth]},
        output_units={"filtered": "V"},
        guards=[(raw > -9, status), (following < 4, Status.NOT_POSITIVE)],
        doc="One step.",
    )
    return block


def bits(record):
    """Return the fields of a record as bytes; the padding between them is nobody's."""
    return {name: value.tobytes() for name, value in flatten(record).items()}


def call(view, memory, params=None, entry="step", **inputs):
    return view.call(entry, memory, view.inputs(entry, inputs), view.params() if params is None else params)


def test_what_it_computes():
    view = InterpretView(low_pass())
    memory = view.init()
    assert float(memory["smooth"]) == 1.0
    answer = call(view, memory, raw=5.0)
    assert answer.status == Status.OK
    assert float(answer.memory["smooth"]) == 2.0
    assert float(answer.outputs["filtered"]) == 2.0
    np.testing.assert_array_equal(answer.outputs["both"], [5.0, 1.0])
    assert float(memory["smooth"]) == 1.0  # a call leaves its arguments alone


@pytest.mark.parametrize(
    ("raw", "smooth", "status"),
    [
        (10.5, 0.0, Status.BAD_INPUT),
        (float("nan"), 0.0, Status.BAD_INPUT),
        (-9.5, 0.0, Status.BAD_INPUT),
        (-9.5, 1e9, Status.BAD_INPUT),  # the first guard is judged first
        (10.0, 4.9, Status.NOT_POSITIVE),
        (-8.9, -4.0, Status.OVERFLOW),
        (1.0, 1.0, Status.OK),
    ],
)
def test_what_it_refuses_leaves_memory_and_outputs_alone(raw, smooth, status):
    view = InterpretView(low_pass())
    memory = view.memory(smooth=smooth)
    answer = call(view, memory, raw=raw)
    assert answer.status == status
    if status < 0:
        assert bits(answer.memory) == bits(memory)
        assert bits(answer.outputs) == bits(view.outputs("step"))


def test_the_first_guard_that_fails_gives_the_status():
    for guards in ([Status.BAD_INPUT, Status.NOT_POSITIVE], [Status.NOT_POSITIVE, Status.BAD_INPUT]):
        block = Block("picky")
        u = block.input("u")
        block.entry("step", inputs=[u], outputs={"y": u}, guards=[(u > 0, guards[0]), (u > 1, guards[1])])
        view = InterpretView(block)
        for value, status in ((-1.0, guards[0]), (0.5, guards[1]), (2.0, Status.OK)):
            assert call(view, view.init(), u=value).status == status


def test_a_parameter_outside_its_range():
    view = InterpretView(low_pass())
    for value in (1.5, -0.1, float("nan")):
        answer = view.call("init", view.memory(), view.inputs("init", {}), view.params(weight=value))
        assert answer.status == Status.BAD_PARAM
    with pytest.raises(ValueError, match="low_pass: init refused the parameters"):
        view.init(view.params(smooth_0=7.0))


def test_an_output_outside_its_range():
    block = Block("drive")
    u = block.input("u")
    block.entry("step", inputs=[u], outputs={"y": 2 * u}, output_ranges={"y": (-1, 1)})
    view = InterpretView(block)
    assert call(view, view.init(), u=0.5).status == Status.OK
    assert call(view, view.init(), u=0.6).status == Status.OVERFLOW


def test_fields_left_out_stay_and_entries_share_the_memory():
    block = Block("counter")
    amount = block.input("amount")
    total, last = block.memory("total", range=(0, 10)), block.memory("last", initial=[1.0, 2.0])
    block.entry("add", inputs=[amount], following={total: total + amount})
    block.entry("reset", following={total: 0, last: [total, fmin(total, 3)]})
    view = InterpretView(block)
    memory = call(view, view.init(), entry="add", amount=4.0).memory
    np.testing.assert_array_equal(memory["last"], [1.0, 2.0])
    memory = call(view, memory, entry="reset").memory
    assert float(memory["total"]) == 0
    np.testing.assert_array_equal(memory["last"], [4.0, 3.0])
    assert list(block.entries) == ["init", "add", "reset"]


def test_mistakes():
    block = Block("mine")
    u, x = block.input("u"), block.memory("x")
    stranger = Block("other").input("w")
    cases = [
        ("'w' is not an input of this block; declare it with input()", {"inputs": [stranger]}),
        ("no memory fields; declare them with memory()", {"inputs": [u], "following": {u: x}}),
        ("an expression has 2 elements where 1 are needed", {"following": {x: [x, x]}}),
        ("a guard of 'step' has the status OK; give a negative one", {"guards": [(x > 0, Status.OK)]}),
        ("a guard of 'step' has the status GATED", {"guards": [(x > 0, Status.GATED)]}),
        ("the output name 'PI' is a macro", {"outputs": {"PI": x}}),
        ("the range of output 'y' is 1 .. 0", {"outputs": {"y": x}, "output_ranges": {"y": (1, 0)}}),
    ]
    for sentence, keywords in cases:
        with pytest.raises(ModelError, match=f"mine: .*{sentence}".replace("()", r"\(\)")):
            block.entry("step", **keywords)
    with pytest.raises(ModelError, match="the entry name 'for' is a keyword"):
        block.entry("for")
    block.entry("step", following={x: x})
    with pytest.raises(ModelError, match="the entry 'step' is defined twice"):
        block.entry("step")
    with pytest.raises(ModelError, match="outside its range"):
        block.memory("y", initial=2.0, range=(0, 1))


def test_a_symbol_that_an_entry_does_not_take():
    block = Block("mine")
    u, x = block.input("u"), block.memory("x")
    for stranger in (u, Block("other").input("w")):
        with pytest.raises(ModelError, match="the entry 'step' uses .*, which it does not take; list them"):
            block.entry("step", following={x: stranger})


def test_names_that_meet():
    block = Block("mine")
    block.parameter("x_0", 1.0)
    x = block.memory("x")
    with pytest.raises(ModelError, match="both be called 'x_0' in the generated C; rename one of them"):
        block.entry("step", following={x: x})
    block = Block("mine")
    block.input("x")
    block.memory("x")
    with pytest.raises(ModelError, match="an input and a memory field share a name"):
        block.entry("step")


# -- the hash ---------------------------------------------------------------------------------------------------------


def sample_hashes():
    from plantc.examples.pendulum import pendulum_ekf

    return f"{low_pass().model_hash()} {pendulum_ekf.model_hash()}"


def test_the_hash_is_the_same_again_and_in_another_process():
    here = sample_hashes()
    for k in range(20):
        ca.SX.sym(f"other{k}")
    assert low_pass().model_hash() == here.split()[0]
    code = f"import sys; sys.path.insert(0, {os.path.dirname(__file__)!r}); import test_block as t; print(t.sample_hashes())"
    for seed in ("1", "77"):
        environment = {**os.environ, "PYTHONHASHSEED": seed}
        run = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True)
        assert run.stdout.strip() == here
    assert len(low_pass().model_hash()) == 8


def test_the_hash_says_what_changed():
    assert low_pass().model_hash() == low_pass().model_hash()
    assert low_pass(weight=0.5).model_hash() != low_pass().model_hash()
    assert low_pass(doc="other").model_hash() != low_pass().model_hash()


def test_the_hash_knows_the_status_of_a_guard():
    assert low_pass(status=Status.OVERFLOW).model_hash() != low_pass().model_hash()


def test_the_hash_knows_which_output_is_which():
    def block(swapped):
        made = Block("two")
        a, b = made.input("a"), made.input("b")
        x, y = made.memory("x"), made.memory("y")
        made.entry("step", inputs=[a, b], following={x: a + b, y: b if swapped else a})
        made.equations = []
        return made

    assert block(True).model_hash() != block(False).model_hash()


def limited(**changes):
    block = Block("limited")
    raw = block.input("raw", size=2, range=(-1e3, 1e3))
    top = block.parameter("top", 1.0, range=(-10, 10))
    limits = changes.get("limits", {"command": (-2.0, top)})
    block.entry("step", inputs=[raw], outputs={"command": 1e28 * raw if "huge" in changes else raw}, limits=limits)
    return block


@pytest.mark.parametrize("view", [InterpretView, NativeView])
def test_an_output_held_at_a_limit_says_so(view):
    view = view(limited())
    params = view.params(top=3.0)
    memory = view.init(params)
    for raw, status, expected in (
        ([0.5, 3.0], Status.OK, [0.5, 3.0]),
        ([0.5, 3.5], Status.CLAMPED, [0.5, 3.0]),
        ([-2.5, 3.0], Status.CLAMPED, [-2.0, 3.0]),
    ):
        answer = view.call("step", memory, view.inputs("step", {"raw": raw}), params)
        assert answer.status == status
        assert answer.outputs["command"].tolist() == expected


def test_a_limit_may_be_an_expression():
    block = Block("pace")
    raw = block.input("raw")
    last = block.memory("last")
    following = fmin(raw, last + 1.0)
    block.entry(
        "step", inputs=[raw], following={last: following}, outputs={"slow": raw}, limits={"slow": (-1e6, last + 1.0)}
    )
    view = NativeView(block)
    answer = view.call("step", view.init(), view.inputs("step", {"raw": 5.0}), view.params())
    assert (answer.status, answer.outputs["slow"], answer.memory["last"]) == (Status.CLAMPED, 1.0, 1.0)
    assert cross_check(block, steps=40).passed


@pytest.mark.parametrize("side", [0, 1])
def test_an_output_may_be_held_on_one_side_only(side):
    block = limited(limits={"command": (-2.0, None) if side == 0 else (None, 2.0)})
    view = NativeView(block)
    low, high = (-2.0, 900.0) if side == 0 else (-900.0, 2.0)
    for raw in (-900.0, 1.0, 900.0):
        answer = view.call("step", view.init(), view.inputs("step", {"raw": [raw, 1.0]}), view.params())
        assert answer.outputs["command"][0] == min(max(raw, low), high)
        assert answer.status == (Status.OK if low <= raw <= high else Status.CLAMPED)
    assert emit(block).source.count("command was held at a limit") == 1


def test_a_limit_does_not_hide_what_is_no_command():
    view = NativeView(limited(huge=True))
    answer = view.call("step", view.init(), view.inputs("step", {"raw": [0.0, 900.0]}), view.params())
    assert answer.status == Status.OVERFLOW


def test_mistakes_of_limits():
    block = Block("other")
    stranger = block.parameter("stranger", 1.0)
    for limits, says in (
        ({"other": (0, 1)}, r"limits= names 'other', which is not an output; it has \['command'\]"),
        ({"command": (0, vertcat(stranger, stranger, stranger))}, r"a limit of 'command' has 3 elements; give 1 or 2"),
        ({"command": (0, stranger)}, r"the entry 'step' uses .*stranger.*, which it does not take"),
        ({"command": ([0, 0, 0], 1)}, r"the limit of 'command' is \[0, 0, 0\]; give 2 finite number"),
    ):
        with pytest.raises(ModelError, match=says):
            limited(limits=limits)


@pytest.mark.parametrize("precision", ["double", "float"])
def test_all_views_agree_on_a_limit(precision):
    check = cross_check(limited(), precision, steps=40)
    assert check.passed, [(item.name, str(item.mismatch)) for item in check.failures]
    assert check.statuses["CLAMPED"] > 10


def test_an_input_and_a_parameter_may_share_a_name():
    block = Block("shared")
    level = block.input("level")
    wanted = block.parameter("level", 2.0)
    block.entry("step", inputs=[level], outputs={"gap": level - wanted})
    assert block.equations == ["step: gap = level - params.level"]
    view = NativeView(block)
    answer = view.call("step", view.init(), view.inputs("step", {"level": 5.0}), view.params(level=1.0))
    assert answer.outputs["gap"] == 4.0


def test_a_block_without_an_entry_is_none():
    with pytest.raises(
        ModelError, match=r"blank: it has no entry, so nothing could be called; declare one with entry\(...\)"
    ):
        Block("blank").check()
