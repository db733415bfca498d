"""Logs: what is read, what is missing, and what is said of a bad one."""

import numpy as np
import pytest
from plantc.codegen import TraceError
from plantc.examples.pendulum import pendulum_ekf

from plantc import InterpretView, NativeView, Trace

COLUMNS = {"encoder": "angle", "torque": "motor"}


def write(tmp_path, text):
    path = tmp_path / "log.csv"
    path.write_text(text)
    return path


GOOD = "t,angle,motor\n0,0.1,0\n0.01,0.11,0.5\n0.03,,0.5\n0.04,0.12,0.5\n0.05,0.12,0.5\n"


def test_a_log_becomes_calls(tmp_path):
    trace = Trace.from_csv(write(tmp_path, GOOD), pendulum_ekf, columns=COLUMNS, time="t", new_only=["encoder"])
    assert len(trace) == 4
    assert [item.inputs["dt"] for item in trace.calls] == pytest.approx([0.01, 0.02, 0.01, 0.01])
    # the second reading is missing, the last is the one before again
    assert [item.inputs["has_encoder"] for item in trace.calls] == [True, False, True, False]
    assert trace.times == pytest.approx([0.01, 0.03, 0.04, 0.05])


def test_a_missing_reading_never_becomes_nan(tmp_path):
    trace = Trace.from_csv(write(tmp_path, GOOD), pendulum_ekf, columns=COLUMNS, time="t")
    assert all(np.isfinite(item.inputs["encoder"]) for item in trace.calls)
    answer = NativeView(pendulum_ekf).run(trace)
    assert set(answer.statuses) == {0}
    assert answer.column("encoder.nis")[1] == 0


def test_views_replay_alike(tmp_path):
    trace = Trace.from_csv(write(tmp_path, GOOD), pendulum_ekf, columns=COLUMNS, time="t")
    ours, theirs = InterpretView(pendulum_ekf).run(trace), NativeView(pendulum_ekf).run(trace)
    np.testing.assert_allclose(ours.column("theta"), theirs.column("theta"), rtol=1e-12)
    np.testing.assert_allclose(ours.column("covariance"), theirs.column("covariance"), rtol=1e-9)


def test_units_are_scaled(tmp_path):
    trace = Trace.from_csv(
        write(tmp_path, GOOD), pendulum_ekf, columns=COLUMNS, time="t", scaled={"encoder": np.pi / 180}
    )
    assert trace.calls[0].inputs["encoder"] == pytest.approx(0.11 * np.pi / 180)


@pytest.mark.parametrize(
    ("text", "columns", "says"),
    [
        (GOOD, {"encoder": "angel", "torque": "motor"}, "no column 'angel'; it has t, angle, motor"),
        (GOOD, {"encodr": "angle", "torque": "motor"}, "no input 'encodr'; it has torque, dt, has_encoder, encoder"),
        (GOOD, {"encoder": "angle"}, "no column is named for the input.s. torque"),
        (GOOD, {"encoder": ["angle", "t"], "torque": "motor"}, "has 1 elements, 2 columns are named"),
        ("t,angle,motor\n0,0.1\n", COLUMNS, "line 2: 2 cells for 3 columns"),
        ("t,angle,motor\n0,x,1\n", COLUMNS, "line 2: could not convert string to float: 'x'"),
        ("t,angle,motor\n", COLUMNS, "it has no rows"),
    ],
)
def test_a_bad_log_is_a_sentence(tmp_path, text, columns, says):
    with pytest.raises(TraceError, match=says):
        Trace.from_csv(write(tmp_path, text), pendulum_ekf, columns=columns, time="t")


def test_no_file_and_no_entry(tmp_path):
    with pytest.raises(TraceError, match="cannot be read"):
        Trace.from_csv(tmp_path / "none.csv", pendulum_ekf, columns=COLUMNS)
    with pytest.raises(TraceError, match="no entry 'stepp'; it has init, predict"):
        Trace.from_csv(write(tmp_path, GOOD), pendulum_ekf, columns=COLUMNS, entry="stepp")


def test_an_unknown_column_of_a_trace_is_named(tmp_path):
    trace = Trace.from_csv(write(tmp_path, GOOD), pendulum_ekf, columns=COLUMNS, time="t")
    with pytest.raises(KeyError, match="no field 'theta'"):
        trace.column("theta")
