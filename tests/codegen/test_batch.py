"""The batch: one C call for many steps gives what as many calls give, and stops where one is refused."""

import pickle

import numpy as np
import pytest
from plantc.codegen.batch import Batch, BatchText, batch_text
from plantc.codegen.layout import flatten

from plantc import NativeView


def random_inputs(block, batch, steps, seed=0):
    """Plausible inputs of `step`, from the block's own scenario or its ranges."""
    rng = np.random.default_rng(seed)
    inputs = batch.inputs(steps)
    for signal in block.entries["step"].inputs:
        if signal.name.startswith("has_"):
            inputs[signal.name] = rng.uniform(size=steps) < 0.8
        else:
            shape = inputs[signal.name].shape
            inputs[signal.name] = np.clip(rng.normal(scale=0.1, size=shape), signal.low[0], signal.high[0])
    return inputs


def bits(record):
    """The bytes of every field; what lies between them is nobody's."""
    return {name: value.tobytes() for name, value in flatten(record).items()}


@pytest.mark.parametrize("precision", ["double", "float"])
def test_a_batch_is_as_many_calls_bit_for_bit(small_shape, precision):
    batch = Batch(batch_text(small_shape, precision=precision))
    inputs = random_inputs(small_shape, batch, 30)
    answer = batch.run(inputs)
    view = NativeView(small_shape, precision)
    memory = view.init()
    assert answer.steps == 30
    for k in range(30):
        single = view.call("step", memory, inputs[k : k + 1].reshape(()), view.params())
        memory = single.memory
        assert single.status == answer.statuses[k]
        assert bits(memory) == bits(answer.memory[k])
        assert bits(single.outputs) == bits(answer.outputs[k])


def stopped(batch):
    inputs = batch.inputs(20)
    inputs["raw"] = np.linspace(0, 1, 20)
    inputs["raw"][7] = np.nan
    answer = batch.run(inputs)
    return answer.steps == 7 and answer.status.name == "BAD_INPUT" and np.isfinite(answer.memory["smooth"]).all()


def test_a_refused_call_stops_the_run_and_says_where(shape_named):
    text = batch_text(shape_named("low_pass"))
    assert stopped(Batch(text))
    # planted: a driver that goes on after a refusal
    sources = dict(text.sources)
    sources["low_pass_batch.c"] = sources["low_pass_batch.c"].replace("break;", "continue;")
    assert not stopped(Batch(BatchText(**{**text.__dict__, "sources": sources})))


def test_a_run_starts_from_the_memory_it_is_given_and_leaves_it(shape_named):
    batch = Batch(batch_text(shape_named("low_pass")))
    inputs = random_inputs(shape_named("low_pass"), batch, 10)
    whole = batch.run(inputs)
    middle = whole.memory[4:5].reshape(()).copy()
    rest = batch.run(inputs[5:].copy(), memory=middle)
    assert bits(rest.memory) == bits(whole.memory[5:])
    assert bits(middle) == bits(whole.memory[4])


def test_parameters_are_given_by_dotted_names_and_judged(shape_named):
    batch = Batch(batch_text(shape_named("two_filters")))
    params = batch.params({"second.weight": 0.5, "delay_first_raw_0": 3.0})
    inputs = batch.inputs(1)
    answer = batch.run(inputs, params)
    assert answer.memory["second"]["smooth"][0] == pytest.approx(0.5 * 0.1 * 3.0)
    with pytest.raises(ValueError, match=r"init refused the parameters \(BAD_PARAM\)"):
        batch.run(inputs, batch.params({"second.weight": 7.0}))


def test_records_of_another_layout_are_refused(shape_named):
    batch = Batch(batch_text(shape_named("low_pass")))
    with pytest.raises(ValueError, match="not laid out as the C takes them"):
        batch.run(np.zeros(5))
    with pytest.raises(ValueError, match="not laid out as the C takes them"):
        batch.run(np.zeros(10, dtype=batch.text.inputs)[::2])


def test_the_text_survives_pickling_and_needs_no_block(shape_named):
    text = batch_text(shape_named("pendulum_ekf"))
    again = Batch(pickle.loads(pickle.dumps(text)))
    inputs = random_inputs(shape_named("pendulum_ekf"), again, 10)
    assert bits(again.run(inputs).memory) == bits(Batch(text).run(inputs).memory)


def test_an_entry_that_is_not_there_is_named(shape_named):
    for entry in ("init", "walk"):
        with pytest.raises(ValueError, match="no entry that can be run in a batch; it has step"):
            batch_text(shape_named("low_pass"), entry)


def test_runs_in_one_room_are_as_runs_in_new_arrays(shape_named):
    batch = Batch(batch_text(shape_named("low_pass")))
    room = batch.room(10)
    for seed in (1, 2):
        inputs = random_inputs(shape_named("low_pass"), batch, 10, seed)
        apart, inside = batch.run(inputs), batch.run(inputs, room=room)
        assert bits(apart.memory) == bits(inside.memory)
        assert np.shares_memory(inside.memory, room.memory)
        assert not np.shares_memory(apart.memory, room.memory)
    with pytest.raises(ValueError, match="low_pass: the room is not for these steps of this batch"):
        batch.run(batch.inputs(11), room=room)
    other = Batch(batch_text(shape_named("two_filters")))
    with pytest.raises(ValueError, match="two_filters: the room is not for these steps of this batch"):
        other.run(other.inputs(10), room=room)


def test_a_call_is_timed_as_often_as_asked_and_only_where_it_is_accepted(shape_named):
    batch = Batch(batch_text(shape_named("low_pass")))
    inputs = random_inputs(shape_named("low_pass"), batch, 10)
    times = batch.seconds(inputs, repeats=3)
    assert len(times) == 3
    assert min(times) > 0
    inputs["raw"][4] = np.nan
    with pytest.raises(ValueError, match="low_pass: step 5 was refused"):
        batch.seconds(inputs)
