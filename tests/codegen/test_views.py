"""Calls through the compiled C: statuses, and memory that a refused call leaves alone."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from plantc.codegen.layout import flatten
from plantc.examples.pendulum import pendulum_ekf
from plantc.examples.quadrotor_ekf import quadrotor_ekf

from plantc import Block, InterpretView, ModelError, NativeView, ReferenceView, Status

VIEWS = {precision: NativeView(pendulum_ekf, precision) for precision in ("double", "float")}
anything = st.floats(allow_nan=True, allow_infinity=True, width=32)


@pytest.mark.parametrize("precision", ["double", "float"])
@given(data=st.data())
@settings(max_examples=60)
def test_no_input_whatever_breaks_the_memory(precision, data):
    """Every stored value stays in its range, and a refused call changes nothing, bit for bit."""
    view = VIEWS[precision]
    params = view.params(reject_limit=2, gate_encoder=9.0)
    memory = view.init(params)
    for _ in range(6):
        entry = data.draw(st.sampled_from(["predict", "update_encoder", "step", "inflate"]))
        inputs = view.inputs(entry, {})
        for name in inputs.dtype.names:
            inputs[name] = data.draw(
                st.booleans() if name.startswith("has_") else anything | st.floats(2**-10, 1.5, width=32)
            )
        before = memory.copy()
        answer = view.call(entry, memory, inputs, params)
        if answer.status < 0:
            after = flatten(answer.memory)
            assert all(after[name].tobytes() == value.tobytes() for name, value in flatten(before).items())
        memory = answer.memory
        fields = flatten(memory)
        for signal in pendulum_ekf.memory_signals:
            value = fields[signal.name]
            if value.dtype.kind == "f":
                real = value.dtype.type
                assert np.all((value >= np.array(signal.low, real)) & (value <= np.array(signal.high, real))), (
                    signal.name
                )


def test_the_library_knows_its_model():
    assert VIEWS["double"].model() == pendulum_ekf.model_hash()


def test_a_refused_init_is_a_sentence():
    view = VIEWS["double"]
    said = "pendulum_ekf: init refused the parameters .BAD_PARAM.: mass is -1, outside its range"
    with pytest.raises(ValueError, match=said):
        view.init(view.params(mass=-1.0))


def test_what_has_another_name_or_size_is_said():
    view = VIEWS["double"]
    with pytest.raises(ModelError, match="there is no field 'mas'; the fields are .*mass"):
        view.params(mas=1.0)
    with pytest.raises(ModelError, match="'mass' has 1 elements, and 2 are given"):
        view.params(mass=[1.0, 2.0])
    with pytest.raises(ModelError, match="NativeView: what is to be run is 3, of type int; give a Block"):
        NativeView(3)


def test_nested_fields_and_defaults():
    view = NativeView(quadrotor_ekf)
    params = view.params(variance_pose=np.full(12, 0.04))
    assert params["variance_pose"].tolist() == [0.04] * 12
    assert params["gate_pose"] == 60
    answer = view.call("step", view.init(params), view.inputs("step", {"has_pose": False}), params)
    assert answer.status == Status.OK
    assert answer.outputs["pose"]["nis"] == 0


def test_a_block_without_an_oracle_has_no_reference_view():
    block = Block("bare")
    x = block.memory("x")
    block.entry("step", following={x: x})
    with pytest.raises(ValueError, match="bare: it has no oracle"):
        ReferenceView(block)
    view = NativeView(block)
    assert view.call("step", view.init(), view.inputs("step", {}), view.params()).status == 0
    assert InterpretView(block).init()["x"] == 0
