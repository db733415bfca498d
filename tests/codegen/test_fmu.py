"""The FMI unit: what it describes, and that it gives the bits of the direct call."""

import io
import re
import subprocess
import sys
import zipfile

import numpy as np
import pytest
from plantc.codegen import emit, fmu
from plantc.codegen.fmu import FmuError, FmuRunner, build_fmu, check_fmu
from plantc.codegen.layout import flatten
from plantc.codegen.options import Options
from plantc.codegen.style import Precision
from plantc.codegen.views import NativeView
from plantc.examples.pendulum import pendulum_ekf
from plantc.examples.quadrotor_ekf import quadrotor_ekf

from plantc import Block

FLOAT, DOUBLE = Options(Precision("float")), Options(Precision("double"))
READING = {"torque": 0.1, "has_encoder": True, "encoder": 0.2}


@pytest.fixture(scope="module")
def native():
    return NativeView(pendulum_ekf, "float")


@pytest.fixture(scope="module")
def unit(native):
    pytest.importorskip("fmpy")
    return build_fmu(pendulum_ekf, FLOAT, native.text)


@pytest.fixture
def runner(unit, tmp_path):
    path = tmp_path / "pendulum_ekf.fmu"
    path.write_bytes(unit)
    made = FmuRunner(pendulum_ekf, path)
    yield made
    made.close()


def memory_of(record):
    return np.concatenate([piece.astype(float) for piece in flatten(record).values()])


def test_validated_and_bit_for_bit_the_direct_call(unit, native):
    result = check_fmu(pendulum_ekf, unit, native)
    assert result.passed, result.note
    assert result.calls == 100


def test_the_quadrotor_too_in_double(needs):
    needs("python:fmpy")
    native = NativeView(quadrotor_ekf, "double")
    result = check_fmu(quadrotor_ekf, build_fmu(quadrotor_ekf, DOUBLE, native.text), native, steps=30)
    assert result.passed, result.note
    assert result.calls == 30


def test_a_planted_difference_is_seen(native):
    text = native.text
    planted = type(text)(
        text.name, text.precision, text.header, text.source.replace("delta[0] = ", "delta[0] = 1.1f * ", 1), {}
    )
    assert planted.source != text.source
    result = check_fmu(pendulum_ekf, build_fmu(pendulum_ekf, FLOAT, planted), native)
    assert not result.passed
    assert "other bits" in result.note


def test_a_description_that_fmpy_refuses_is_seen(unit, native):
    stream = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(unit)) as old, zipfile.ZipFile(stream, "w") as new:
        for name in old.namelist():
            data = old.read(name)
            new.writestr(name, data.replace(b'valueReference="0"', b'valueReference="x"'))
    result = check_fmu(pendulum_ekf, stream.getvalue(), native)
    assert not result.passed
    assert result.note.startswith("fmpy: ")


def test_same_bytes_again(unit, native):
    assert build_fmu(pendulum_ekf, FLOAT, native.text) == unit


def test_a_refused_step_leaves_the_state_and_the_simulation_goes_on(runner, native):
    runner.start()
    before = runner.values("state.")
    runner.set_inputs({**READING, "torque": 1e5})
    assert runner.step(0.0, 0.01) == -1
    assert np.array_equal(runner.values("state."), before)
    runner.set_inputs(READING)
    assert runner.step(0.01, 7.0) == -1, "the communication step is dt, which has a range"
    assert np.array_equal(runner.values("state."), before)
    assert runner.step(0.01, 0.01) == 0
    inputs = native.inputs("step", {**READING, "dt": 0.01})
    wanted = native.call("step", native.init(), inputs, native.params())
    assert np.array_equal(runner.values("state."), memory_of(wanted.memory))


def test_a_parameter_out_of_range_is_not_taken_and_the_old_one_stays(runner):
    runner.start()
    runner.set_inputs(READING)
    mass, length = runner.references["params.mass"], runner.references["params.length"]
    for bad in (-1.0, float("nan"), 1e300):
        with pytest.raises(Exception, match="fmi2SetReal"):
            runner.slave.setReal([length, mass], [0.7, bad])
    assert runner.slave.getReal([mass, length]) == [float(np.float32(0.2)), 0.5]
    assert runner.step(0.0, 0.01) == 0
    runner.slave.setReal([mass], [0.3])
    assert runner.step(0.01, 0.01) == 0


def test_a_parameter_that_only_starts_the_state_is_fixed(runner, unit):
    text = zipfile.ZipFile(io.BytesIO(unit)).read("modelDescription.xml").decode()
    for name, variability in (("params.theta_0", "fixed"), ("params.mass", "tunable"), ("in.torque", "discrete")):
        assert re.search(rf'name="{name}"[^>]*variability="{variability}"', text)
    start = [runner.references["params.theta_0"]]
    runner.slave.setReal(start, [0.5])
    runner.start()
    assert runner.slave.getReal([runner.references["state.theta"]]) == [0.5]
    with pytest.raises(Exception, match="fmi2SetReal"):
        runner.slave.setReal(start, [0.25])
    assert runner.slave.getReal(start) == [0.5]


def test_nothing_is_set_after_the_end(runner):
    runner.start()
    torque, flag = [runner.references["in.torque"]], [runner.references["in.has_encoder"]]
    runner.slave.terminate()
    with pytest.raises(Exception, match="fmi2SetReal"):
        runner.slave.setReal(torque, [1.0])
    with pytest.raises(Exception, match="fmi2SetBoolean"):
        runner.slave.setBoolean(flag, [True])
    assert runner.slave.getReal(torque) == [0.0]


def test_where_the_time_step_is_not_known_all_steps_have_the_size_of_the_first(tmp_path, needs):
    needs("python:fmpy")
    block = Block("counter")
    count = block.memory("count", range=(0, 100))
    block.entry("step", following={count: count + 1})
    path = tmp_path / "counter.fmu"
    path.write_bytes(build_fmu(block, DOUBLE, emit(block)))
    assert b'canHandleVariableCommunicationStepSize="false"' in zipfile.ZipFile(path).read("modelDescription.xml")
    made = FmuRunner(block, path)
    made.start()
    made.step(0.0, 0.5)
    made.step(0.5, 0.5 * (1 + 1e-9))
    with pytest.raises(Exception, match="fmi2DoStep"):
        made.step(1.0, 0.25)
    assert made.values("state.").tolist() == [2.0]
    made.slave.reset()
    made.start()
    made.step(0.0, 0.25)
    made.close()


def test_a_saved_state_replays_the_same_also_as_bytes(runner):
    runner.start()
    runner.set_inputs(READING)
    runner.step(0.0, 0.01)
    saved = runner.slave.getFMUstate()
    stored = runner.slave.serializeFMUstate(saved)
    runner.step(0.01, 0.02)
    first = runner.values("")
    runner.slave.setFMUstate(saved)
    runner.step(0.01, 0.02)
    assert np.array_equal(runner.values(""), first)
    again = runner.slave.deSerializeFMUstate(stored)
    runner.slave.setFMUstate(again)
    runner.step(0.01, 0.02)
    assert np.array_equal(runner.values(""), first)
    with pytest.raises(Exception, match="fmi2DeSerializeFMUstate"):
        runner.slave.deSerializeFMUstate(b"x" * len(stored))
    runner.slave.freeFMUstate(saved)
    runner.slave.freeFMUstate(again)


def test_reset_starts_again_and_instances_are_apart(runner, unit, tmp_path):
    runner.start()
    fresh = runner.values("")
    other_path = tmp_path / "other.fmu"
    other_path.write_bytes(unit)
    other = FmuRunner(pendulum_ekf, other_path)
    other.start()
    runner.set_inputs(READING)
    runner.step(0.0, 0.01)
    assert not np.array_equal(runner.values("state."), other.values("state."))
    assert np.array_equal(other.values(""), fresh)
    other.close()
    runner.slave.reset()
    runner.start()
    assert np.array_equal(runner.values(""), fresh)


def test_a_constant_time_step_is_the_communication_step(native, tmp_path, needs):
    needs("python:fmpy")
    assert fmu.sample_time(quadrotor_ekf) is not None
    text = NativeView(quadrotor_ekf, "double").text
    path = tmp_path / "quadrotor_ekf.fmu"
    path.write_bytes(build_fmu(quadrotor_ekf, DOUBLE, text))
    made = FmuRunner(quadrotor_ekf, path)
    made.start()
    with pytest.raises(Exception, match="fmi2DoStep"):
        made.step(0.0, 2.0 * fmu.sample_time(quadrotor_ekf))
    made.close()


@pytest.mark.slow
def test_the_sources_compiled_by_fmpy_give_the_same(unit, native, tmp_path, needs):
    needs("cmake")
    path = tmp_path / "pendulum_ekf.fmu"
    with zipfile.ZipFile(io.BytesIO(unit)) as old, zipfile.ZipFile(path, "w") as new:
        for name in old.namelist():
            if not name.startswith("binaries/"):
                new.writestr(name, old.read(name))
    subprocess.run([sys.executable, "-m", "fmpy", "compile", str(path)], check=True, capture_output=True, timeout=120)
    assert check_fmu(pendulum_ekf, path.read_bytes(), native).passed


def test_what_makes_no_unit_is_told(monkeypatch):
    bare = Block("bare")
    raw = bare.input("raw", range=(-1, 1))
    bare.entry("take", inputs=[raw], outputs={"twice": raw + raw})
    with pytest.raises(FmuError, match="no entry step"):
        fmu.check_fmu_is_possible(bare)
    monkeypatch.setattr(fmu.importlib.util, "find_spec", lambda name: None)
    with pytest.raises(FmuError, match=r"pip install 'plantc\[fmu\]'"):
        fmu.check_fmu_is_possible(pendulum_ekf)


def test_on_the_command_line(plantc, tmp_path, needs):
    needs("python:fmpy")
    model = tmp_path / "low_pass.py"
    model.write_text(
        "from plantc import Block\n"
        'low_pass = Block("low_pass", doc="first-order low-pass filter")\n'
        'raw = low_pass.input("raw", unit="V", range=(-10, 10))\n'
        'weight = low_pass.parameter("weight", 0.1, range=(0, 1))\n'
        'smooth = low_pass.memory("smooth", initial=0.0, unit="V", range=(-10, 10))\n'
        "following = smooth + weight * (raw - smooth)\n"
        'low_pass.entry("step", inputs=[raw], following={smooth: following}, outputs={"filtered": following})\n'
    )
    said = plantc("export", model, "--fmu", "--out", tmp_path / "out", "--steps", 20)
    assert said.status == 0, said.err
    assert "FMU = direct call" in said.err
    assert (tmp_path / "out/low_pass/low_pass.fmu").is_file()
    assert plantc("check", tmp_path / "out/low_pass", "--model", model, "--steps", 20).status == 0
    said = plantc("export", model, "--out", tmp_path / "out", "--steps", 20)
    assert said.status == 0
    assert not (tmp_path / "out/low_pass/low_pass.fmu").exists(), "an FMU of an earlier export would be stale"
