"""Roll and pitch that point the thrust where it is wanted, and the guards."""

import math
from dataclasses import replace

import numpy as np
import pytest
from plantc.codegen.crosscheck import make_views
from plantc.symbolic.tilt import tilt_allocation

from plantc import ModelError, NativeView, cross_check, emit


def rotation(roll, pitch, yaw):
    c, s = math.cos, math.sin
    about_x = np.array([[1, 0, 0], [0, c(roll), -s(roll)], [0, s(roll), c(roll)]])
    about_y = np.array([[c(pitch), 0, s(pitch)], [0, 1, 0], [-s(pitch), 0, c(pitch)]])
    about_z = np.array([[c(yaw), -s(yaw), 0], [s(yaw), c(yaw), 0], [0, 0, 1]])
    return about_z @ about_y @ about_x


@pytest.fixture(scope="module", params=["double", "float"])
def view(request):
    made = NativeView(tilt_allocation(), request.param)
    made.near = 1e-6 if request.param == "float" else 1e-14
    return made


def ask(view, ux, uy, wanted=0.4, yaw=0.0, **params):
    given = {"ux": ux, "uy": uy, "reference_yaw": wanted, "yaw": yaw}
    return view.call("step", view.init(), view.inputs("step", given), view.params(**params))


def test_the_thrust_points_where_it_is_wanted(view):
    rng = np.random.default_rng(3)
    for _ in range(20):
        wanted = rng.uniform(-3, 3)
        ux, uy = 0.3 * rng.uniform(-1, 1, 2)
        answer = ask(view, ux, uy, wanted)
        assert answer.status == 0
        thrust = rotation(float(answer.outputs["roll"]), float(answer.outputs["pitch"]), wanted)[:, 2]
        np.testing.assert_allclose(thrust[:2], (ux, uy), rtol=0, atol=view.near)


@pytest.mark.parametrize("direction", [(3.0, 0.0), (0.0, -1e5), (-1.0, 0.9), (1e6, 1e6)])
def test_a_sine_beyond_its_limit_is_held_and_no_angle_is_undefined(view, direction):
    answer = ask(view, *direction)
    assert answer.status.name == "CLAMPED"
    angles = np.array([float(answer.outputs[name]) for name in ("roll", "pitch")])
    sines = np.array([float(answer.outputs[f"sine_{name}"]) for name in ("roll", "pitch")])
    assert np.all(np.isfinite(angles)) and np.max(np.abs(sines)) == 0.5
    np.testing.assert_allclose(np.sin(angles), sines, atol=1e-6)
    tight = ask(view, *direction, limit=0.2)
    assert abs(float(tight.outputs["roll"])) <= math.asin(0.2) + 1e-6


@pytest.mark.parametrize("bad", [math.nan, math.inf])
@pytest.mark.parametrize("name", ["ux", "uy", "reference_yaw", "yaw"])
def test_what_is_no_number_is_refused(view, name, bad):
    given = {"ux": 0.1, "uy": 0.1, "reference_yaw": 0.1, "yaw": 0.1} | {name: bad}
    assert view.call("step", view.init(), view.inputs("step", given), view.params()).status.name == "BAD_INPUT"


def test_the_wanted_yaw_is_in_the_turn_that_is_nearest(view):
    for yaw in (-20.0, -3.0, 0.0, 3.0, 3.6, 20.0):
        near = float(ask(view, 0, 0, math.pi / 4, yaw).outputs["yaw"])
        assert abs(yaw - near) <= math.pi + 1e-5
        assert math.remainder(near - math.pi / 4, 2 * math.pi) == pytest.approx(0, abs=1e-5)


def test_the_views_agree():
    check = cross_check(tilt_allocation(), "float", steps=40)
    assert check.passed, [(item.name, str(item.mismatch), item.note) for item in check.failures]


def test_a_sign_that_is_wrong_is_seen():
    block, text = tilt_allocation(), emit(tilt_allocation())
    line = next(item for item in text.source.splitlines() if "out->roll =" in item)
    wrong = replace(text, source=text.source.replace(line, line.replace("= ", "= -", 1)))
    found = cross_check(block, views=make_views(block, "double", NativeView(block, text=wrong)), steps=40)
    assert "native = reference" in {result.name for result in found.failures}


@pytest.mark.parametrize("limit", [0, 1.0, -0.5, math.nan, "steep"])
def test_a_limit_that_leaves_angles_undefined_is_a_sentence(limit):
    with pytest.raises(ModelError, match="up to 0.95"):
        tilt_allocation(limit)
