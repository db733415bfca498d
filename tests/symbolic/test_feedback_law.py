"""One mechanism for all laws: linear maps, maps that are solved where they start, and power series."""

import numpy as np
import pytest
from plantc.symbolic import output_regulator, regulator_map
from plantc.symbolic.exosystems import polynomial
from plantc.symbolic.parametric_regulator import parametric_francis
from plantc.symbolic.power_series import regulator_series
from plantc.symbolic.regulator_equations import francis
from plantc.symbolic.retunable_regulator import retunable_feedback

from plantc import InterpretView, Plant, ReferenceView, linearise, lqr, trim

DT, RATE = 0.02, 0.5
TRACK = polynomial("heading", 1).sampled(DT)


@pytest.fixture(scope="module")
def laws():
    """The three laws for a ship whose heading is an angle."""
    ship = Plant("ship")
    heading, turn = ship.state("heading", angle=True, unit="rad"), ship.state("turn", range=(-9, 9))
    rudder, inertia = ship.input("rudder", range=(-50, 50)), ship.parameter("inertia", 2.0, range=(1, 4))
    ship.dynamics({heading: turn, turn: (rudder - 0.4 * turn) / inertia})
    plant = ship.discretise("euler", dt=DT)
    point, at = trim(plant, hold={"heading": 0}), linearise(plant)
    gain = lqr(at, Q=[10, 1], R=1)
    solved, series = francis(at, TRACK), regulator_series(plant, point, TRACK, 2)
    return gain.rounded(), {
        "linear": output_regulator.regulator_feedback(plant, point, gain, solved),
        "retunable": retunable_feedback(plant, gain, parametric_francis(plant, point, TRACK)),
        "series": regulator_map.regulator_feedback(series, gain, amplitude=20),
    }


def command(law, heading, turn, w, view=InterpretView):
    here = view(law)
    params = here.params()
    name = "w" if "w" in [item.name for item in law.entries["step"].inputs] else "w_heading"
    inputs = here.inputs("step", {"heading": heading, "turn": turn, name: w})
    answer = here.call("step", here.init(params), inputs, params)
    assert answer.status == 0
    return float(answer.outputs["rudder"])


@pytest.mark.parametrize("kind", ["linear", "retunable", "series"])
@pytest.mark.parametrize("view", [InterpretView, ReferenceView])
def test_all_laws_are_one(laws, kind, view):
    K, made = laws
    w = np.array([0.3, RATE])
    ahead = np.array([0.3, RATE])
    wanted = 0.4 * RATE - (K @ (np.array([0.5, 0.1]) - ahead))[0]
    assert command(made[kind], 0.5, 0.1, w, view) == pytest.approx(wanted, rel=1e-7)


@pytest.mark.parametrize("kind", ["linear", "retunable", "series"])
@pytest.mark.parametrize("view", [InterpretView, ReferenceView])
def test_a_heading_is_followed_past_half_a_turn(laws, kind, view):
    """The deviation is wrapped after the reference is taken off; before, it would be off by whole turns."""
    K, made = laws
    for turned in (3.0, 3.3, 9.0, -12.0):
        there = (turned + np.pi) % (2 * np.pi) - np.pi  # what the plant's state says
        assert command(made[kind], there, RATE, [turned, RATE], view) == pytest.approx(0.4 * RATE, abs=1e-6)
        late = command(made[kind], (there - 0.1 + np.pi) % (2 * np.pi) - np.pi, RATE, [turned, RATE], view)
        assert late == pytest.approx(0.4 * RATE + 0.1 * K[0, 0], abs=1e-6)
