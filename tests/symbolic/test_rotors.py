"""Mixing commands to rotors: the inverse, what is held, what is then applied, and what is refused."""

import math
from dataclasses import replace

import numpy as np
import pytest
from plantc.codegen.crosscheck import make_views
from plantc.symbolic.rotors import exact_pseudoinverse, rotor_mixer

from plantc import ModelError, NativeView, cross_check, emit

LIFT, TURN, FASTEST = 3e-5, 4e-7, 400.0
QUAD = np.array([[LIFT] * 4, [0, -LIFT, 0, LIFT], [-LIFT, 0, LIFT, 0], [TURN, -TURN, TURN, -TURN]])
UNITS = {"thrust": "N", "roll": "N", "pitch": "N", "yaw": "N m"}


def hexacopter():
    at = 2 * np.pi * np.arange(6) / 6
    rows = [np.ones(6) * LIFT, 0.2 * LIFT * np.sin(at), -0.2 * LIFT * np.cos(at), TURN * (-1.0) ** np.arange(6)]
    return rotor_mixer(np.array(rows), UNITS, fastest=FASTEST, slowest=50.0)


def quad():
    return rotor_mixer(QUAD, UNITS, fastest=FASTEST)


def call(view, u):
    return view.call("step", view.init(), view.inputs("step", dict(zip(UNITS, u, strict=True))), view.params())


@pytest.mark.parametrize(("make", "precision"), [(quad, "float"), (hexacopter, "double")])
def test_the_views_agree(make, precision):
    check = cross_check(make(), precision, steps=40)
    assert check.passed, [(item.name, str(item.mismatch), item.note) for item in check.failures]


def test_what_can_be_applied_is_applied_with_the_least_speeds():
    view, E = NativeView(hexacopter()), np.array(hexacopter().oracle.formulas["step"].effect)
    u = E @ (200.0**2 + 50.0**2 * np.array((1, -2, 0.5, 1, 2, -1)))
    answer = call(view, u)
    assert answer.status == 0
    squares = answer.outputs["squared_speed"]
    np.testing.assert_allclose(squares, np.linalg.lstsq(E, u, rcond=None)[0], rtol=1e-10)
    np.testing.assert_allclose([float(answer.outputs[name]) for name in UNITS], u, rtol=1e-9, atol=1e-15)
    np.testing.assert_allclose(answer.outputs["speed"] ** 2, squares, rtol=1e-14)
    assert float(answer.outputs["residual_speed"]) == pytest.approx(np.sum((-1.0) ** np.arange(6) * np.sqrt(squares)))


@pytest.mark.parametrize(
    ("u", "low", "high"),
    [((1.0, 2.0, 0.0, 0.05), [1], []), ((40.0, 0, 0, 0), [], [0, 1, 2, 3]), ((-5.0, 0, 0, 0), [0, 1, 2, 3], [])],
    ids=["one backwards", "all too fast", "all backwards"],
)
def test_a_squared_speed_beyond_a_limit_is_held_and_the_applied_input_says_so(u, low, high):
    answer = call(NativeView(quad()), u)
    squares = answer.outputs["squared_speed"]
    assert answer.status.name == "CLAMPED"
    assert np.all(squares[low] == 0) and np.all(squares[high] == FASTEST**2)
    applied = [float(answer.outputs[name]) for name in UNITS]
    np.testing.assert_allclose(applied, QUAD @ squares, rtol=1e-12, atol=1e-18)
    assert not np.allclose(applied, u)


@pytest.mark.parametrize("precision", ["double", "float"])
@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_what_is_no_number_is_refused_not_held(bad, precision):
    view = NativeView(quad(), precision)
    for k in range(4):
        u = [4.0, 0.0, 0.0, 0.0]
        u[k] = bad
        assert call(view, u).status.name == "BAD_INPUT"


def test_an_applied_input_that_is_the_command_is_seen():
    """The planted fault: u goes out as it came in."""
    block, text = quad(), emit(quad())
    line = next(item for item in text.source.splitlines() if item.strip().startswith("out->roll ="))
    wrong = replace(text, source=text.source.replace(line, "        out->roll = roll;"))
    found = cross_check(block, views=make_views(block, "double", NativeView(block, text=wrong)), steps=40)
    assert "native = reference" in {result.name for result in found.failures}


def test_the_inverse_is_exact():
    """1 / (4 c) of a power of two times c, to the last bit, and zeros are zeros: no LAPACK between."""
    inverse = exact_pseudoinverse(QUAD)
    np.testing.assert_array_equal(inverse[:, 0], np.full(4, float(1 / (4 * LIFT))))
    assert np.count_nonzero(inverse[:, 1]) == 2
    np.testing.assert_allclose(QUAD @ inverse, np.eye(4), atol=1e-15)
    np.testing.assert_allclose(exact_pseudoinverse(QUAD[:2]), np.linalg.pinv(QUAD[:2]), rtol=1e-12, atol=1e-9)


def says(*arguments, **options):
    with pytest.raises(ModelError) as caught:
        rotor_mixer(*arguments, **{"fastest": FASTEST, **options})
    assert "\n" not in str(caught.value)
    return str(caught.value)


def test_what_cannot_be_mixed_is_a_sentence():
    singular = np.vstack([QUAD[:3], QUAD[0] + 2 * QUAD[1]])
    assert "apply 3 independent command(s) of the 4" in says(singular, UNITS)
    assert "apply 3 independent command(s) of the 4" in says(QUAD[:, :3], UNITS)
    assert "no rotor moves the command 'yaw'" in says(np.vstack([QUAD[:3], 0 * QUAD[3]]), UNITS)
    assert "give a row for each" in says(QUAD[:3], UNITS)
    assert "the slowest first" in says(QUAD, UNITS, slowest=500.0)
    assert "give 1 or -1 for each of the 4 rotors" in says(QUAD, UNITS, spins=(1, 0, 1, -1))
    assert "which is no command" in says(QUAD, UNITS, ranges={"lift": (0, 1)})
    assert "no matrix of finite numbers" in says(QUAD * math.nan, UNITS)
    assert "commands is ['lift'], of type list; give a dictionary" in says(QUAD[:1], ["lift"])
    assert "spins is 'ab'; give 4 finite numbers" in says(QUAD, UNITS, spins="ab")
    assert "the speeds are 0.0 to '100'; give them in rad/s" in says(QUAD, UNITS, fastest="100")
    assert "ranges is 5, of type int; give a dictionary" in says(QUAD, UNITS, ranges=5)
