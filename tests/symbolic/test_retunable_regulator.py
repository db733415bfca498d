"""A regulator that is retuned without being exported again: u*, Pi and Gamma follow the parameters of the plant."""

from dataclasses import replace

import numpy as np
import pytest
from plantc.symbolic import retunable_regulator
from plantc.symbolic.exosystems import compose, constant, polynomial
from plantc.symbolic.output_regulator import output_regulator
from plantc.symbolic.parametric_regulator import parametric_francis
from plantc.symbolic.regulator_equations import RegulatorError, francis
from plantc.symbolic.retunable_regulator import retunable_feedback
from plantc.symbolic.signal_generators import kalman_exosystem

from plantc import InterpretView, ModelError, Plant, ReferenceView, cross_check, linearise, lqr, trim


def lift(gravity=9.81, of_drag=1.0):
    """A rotor that carries a weight; the slope it stands on is measured."""
    plant = Plant("lift")
    height, climb = plant.state("height", unit="m", range=(-100, 100)), plant.state("climb", range=(-100, 100))
    rotor, wind = plant.input("rotor", unit="rad/s", range=(0, 1000)), plant.input("wind", range=(-10, 10))
    mass, drag = plant.parameter("mass", 1.0, range=(1e-6, 4)), plant.parameter("drag", 0.3, range=(0, 2))
    plant.dynamics(
        {height: climb, climb: 2e-4 * rotor**2 / mass - gravity - of_drag * drag * climb / mass + wind / mass}
    )
    return plant.discretise("euler", dt=0.02)


@pytest.fixture(scope="module")
def parts():
    plant = lift()
    generator = compose([polynomial("height", 2), constant("wind")]).sampled(0.02, "euler")
    point = trim(plant, hold={"height": 0, "wind": 0})
    regulator = parametric_francis(plant, point, generator)
    model = regulator.nominal.model
    gain = lqr((model.A, model.B, 0.02), Q=[1e4, 1e3], R=1)
    return plant, generator, regulator, gain


@pytest.mark.parametrize("view", [InterpretView, ReferenceView])
def test_init_solves_the_equations_for_the_parameters(parts, view):
    plant, generator, regulator, gain = parts
    block = retunable_feedback(plant, gain, regulator)
    here = view(block)
    for mass, drag in ((1.0, 0.3), (2.5, 0.1)):
        memory = here.init(here.params(mass=mass, drag=drag))
        at = trim(plant, hold={"height": 0, "wind": 0, "mass": mass, "drag": drag})
        expected = francis(linearise(plant, at), generator)
        assert float(memory["hold"]) == pytest.approx(at["rotor"], rel=1e-9)
        assert float(memory["hold"]) == pytest.approx(np.sqrt(mass * 9.81 / 2e-4), rel=1e-9)
        law = block.oracle.law
        for what, places, matrix in (
            ("state_map", law.state_places, expected.state_map), ("input_map", law.input_places, expected.input_map),
        ):  # fmt: skip
            np.testing.assert_allclose(np.ravel(memory[what]), [matrix[i, j] for i, j in places], rtol=1e-8, atol=1e-9)


def test_parameters_too_far_away_are_a_status(parts):
    plant, _, regulator, gain = parts
    block = retunable_feedback(plant, gain, regulator)
    for kind in (InterpretView, ReferenceView):
        view = kind(block)
        for mass, status in ((0.5, 0), (1e-5, -2)):
            params = view.params(mass=mass)
            assert view.call("init", view.memory(), view.inputs("init", {}), params).status == status, (kind, mass)


@pytest.mark.slow
@pytest.mark.parametrize("saturate", [True, False])
def test_the_c_of_it(parts, saturate):
    plant, _, regulator, gain = parts
    assert cross_check(retunable_feedback(plant, gain, regulator, saturate=saturate), "double", steps=60).passed


def test_what_is_refused(parts):
    plant, _, regulator, gain = parts
    with pytest.raises(RegulatorError, match="A - B K has spectral radius"):
        retunable_feedback(plant, -gain.gain, regulator)
    with pytest.raises(ModelError, match=r"the gain has shape \(1, 3\); give 1 x 2"):
        retunable_feedback(plant, np.ones((1, 3)), regulator)


def test_a_wrong_map_is_seen_by_the_oracle(parts, monkeypatch):
    """The planted fault: Gamma is off by a thousandth; it is refused, and the oracle solves the equations by another road."""
    plant, _, regulator, gain = parts
    wrong = replace(regulator, input_map=1.001 * regulator.input_map)
    with pytest.raises(ModelError, match="in the regulator equations"):
        retunable_feedback(plant, gain, wrong)
    monkeypatch.setattr(retunable_regulator, "_check_plant", lambda *given: None)
    block = retunable_feedback(plant, gain, wrong)
    first, second = (view(block) for view in (InterpretView, ReferenceView))
    ours, theirs = (view.init(view.params()) for view in (first, second))
    assert np.max(np.abs(np.ravel(ours["input_map"]) / np.ravel(theirs["input_map"]) - 1)) == pytest.approx(
        1e-3, rel=1e-6
    )


def test_in_a_whole_regulator(parts):
    plant, _, regulator, gain = parts
    signals = compose([polynomial("height", 2), constant("wind")]).sampled(0.02, "euler")
    generator = kalman_exosystem(signals, process_variance=1e-6, measurement_variance=1e-4)
    whole = output_regulator(plant, {}, gain, regulator, generator, saturate=True)
    view = InterpretView(whole)
    light, heavy = (view.init(view.params(feedback__mass=mass))["feedback"]["hold"] for mass in (1.0, 2.0))
    assert float(heavy / light) == pytest.approx(np.sqrt(2), rel=1e-9)


def test_the_set_point_is_that_of_the_equations_and_no_parameter(parts):
    """u*(p) holds one set point: one that could be moved by itself would leave an error."""
    plant, _, regulator, gain = parts
    block = retunable_feedback(plant, gain, regulator)
    assert {signal.name for signal in block.param_signals} == {"mass", "drag"}
    at = trim(plant, hold={"height": 5, "wind": 0})
    moved = parametric_francis(plant, at, regulator.nominal.exosystem)
    for kind in (InterpretView, ReferenceView):
        view = kind(retunable_feedback(plant, gain, moved))
        params = view.params()
        inputs = {"height": 5.0, "climb": 0.0, "w_height": [0.0, 0.0, 0.0], "w_wind": [0.0]}
        answer = view.call("step", view.init(params), view.inputs("step", inputs), params)
        assert float(answer.outputs["rotor"]) == pytest.approx(at["rotor"], rel=1e-9)
        inputs["height"] = 4.0
        answer = view.call("step", view.init(params), view.inputs("step", inputs), params)
        assert float(answer.outputs["rotor"]) == pytest.approx(at["rotor"] + gain.rounded()[0, 0], rel=1e-9)


def test_the_gain_is_judged_at_the_rate_of_a_continuous_plant():
    plant = Plant("cart")
    x, v = plant.state("x", range=(-100, 100)), plant.state("v", range=(-100, 100))
    u, mass = plant.input("u", range=(-1e4, 1e4)), plant.parameter("mass", 1.0, range=(0.5, 2))
    plant.dynamics({x: v, v: u / mass - 0.3 * v})
    regulator = parametric_francis(plant, trim(plant, hold={"x": 0}), constant("x"))
    gain = lqr(linearise(plant), Q=[1e4, 10], R=1)
    assert retunable_feedback(plant, gain, regulator, dt=0.02).sample_time == 0.02
    with pytest.raises(RegulatorError, match="A - B K has spectral radius"):
        retunable_feedback(plant, gain, regulator, dt=0.5)


@pytest.mark.parametrize(
    ("other", "says"),
    [
        (lift(gravity=1.62), "in the equations of the set point"),
        (lift(of_drag=1.5), "in the regulator equations"),
    ],
)
def test_a_solution_of_another_plant_is_refused(parts, other, says):
    plant, _, regulator, gain = parts
    with pytest.raises(
        ModelError, match=rf"solved for another plant than 'lift' \(what they give leaves \S+ of its terms {says}"
    ):
        retunable_feedback(other, gain.gain, regulator)
    retunable_feedback(lift(), gain.gain, regulator)  # the same plant, made again
    small = Plant("little")
    x, u, k = small.state("x"), small.input("u"), small.parameter("k", 1.0, range=(0.5, 2))
    small.dynamics({x: k * u - x})
    wide = parametric_francis(small, trim(small, hold={"x": 0}), constant("x"))
    with pytest.raises(
        ModelError, match="states, inputs and parameters x, u, k, and 'lift' has height, climb, rotor, wind"
    ):
        retunable_feedback(plant, gain.gain, wide)


def test_a_solution_that_differs_only_at_other_parameters_is_refused(parts):
    """Alike at the nominal parameters, and nowhere else."""
    _, _, regulator, gain = parts
    other = Plant("lift")
    height, climb = other.state("height", unit="m", range=(-100, 100)), other.state("climb", range=(-100, 100))
    rotor, wind = other.input("rotor", unit="rad/s", range=(0, 1000)), other.input("wind", range=(-10, 10))
    mass, drag = other.parameter("mass", 1.0, range=(1e-6, 4)), other.parameter("drag", 0.3, range=(0, 2))
    other.dynamics({height: climb, climb: 2e-4 * rotor**2 / mass**2 - 9.81 - drag * climb / mass + wind / mass})
    with pytest.raises(ModelError, match="in the equations of the set point"):
        retunable_feedback(other.discretise("euler", dt=0.02), gain.gain, regulator)


def test_another_set_point_is_refused(parts):
    plant, generator, regulator, gain = parts
    observer = kalman_exosystem(generator, process_variance=1e-6, measurement_variance=1e-4)
    says = r"the point has height = 5\.0, and the regulator equations were solved for the set point 0\.0"
    with pytest.raises(ModelError, match=says):
        output_regulator(plant, {"height": 5.0}, gain, regulator, observer)
