"""Controllers as Blocks: what they compute, their statuses, their oracles, and the C of each in float and double."""

import json

import numpy as np
import pytest
from plantc.codegen.package import design_residuals, with_design
from scipy.spatial.transform import Rotation

from plantc import (
    InterpretView,
    ModelError,
    NativeView,
    Plant,
    Status,
    connect,
    cross_check,
    export,
    extended_kalman_filter,
    linearise,
    lqr,
    place,
    state_feedback,
    wires,
)


def step(view, memory=None, params=None, entry="step", **inputs):
    """Call an entry of a view; return (status, memory, outputs)."""
    params = view.params() if params is None else params
    memory = view.init(params) if memory is None else memory
    answer = view.call(entry, memory, view.inputs(entry, inputs), params)
    return answer.status, answer.memory, answer.outputs


def failures(check):
    return [(item.name, str(item.mismatch), item.note) for item in check.failures]


def pendulum(**changes):
    """A pendulum on a motor, upright at zero, its angle wrapped."""
    plant = Plant("pendulum")
    angle = plant.state("angle", unit="rad", angle=True)
    rate = plant.state("rate", unit="rad/s", range=(-50, 50))
    torque = plant.input("torque", unit="N m", range=(-2, 2), doc="of the motor")
    kick = plant.noise("kick", density=1e-4, unit="rad/s^2")
    plant.dynamics({angle: rate, rate: 9.81 * angle + torque + kick})
    plant.sensor("encoder", angle, unit="rad", variance=changes.get("variance", 1e-4), angle=True)
    return plant.discretise("rk4", dt=0.02)


def body():
    plant = Plant("body")
    q = plant.attitude("q")
    spin = plant.state("spin", size=3, unit="rad/s", range=(-20, 20))
    torque = plant.input("torque", size=3, unit="rad/s^2", range=(-30, 30))
    plant.dynamics({q: spin, spin: torque})
    return plant.discretise("rk4", dt=0.01)


def body_gain():
    return lqr(linearise(body()), Q=[10, 10, 10, 1, 1, 1], R=[1, 1, 1])


PENDULUM = linearise(pendulum())

FEEDBACKS = {
    "angle": lambda: state_feedback(pendulum(), {"angle": 0.1}, [[30.0, 8.0]]),
    "held": lambda: state_feedback(pendulum(), {"angle": 0.1}, [[30.0, 8.0]], saturate=True),
    "attitude": lambda: state_feedback(body(), {}, body_gain(), saturate=True),
    "turned": lambda: state_feedback(body(), {"q": [0.5, 0.5, -0.5, 0.5]}, body_gain()),
}


# -- state feedback ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("precision", ["double", "float"])
@pytest.mark.parametrize("name", FEEDBACKS)
def test_all_views_of_a_state_feedback_agree(name, precision):
    check = cross_check(FEEDBACKS[name](), precision, steps=60)
    assert check.passed, failures(check)
    assert check.statuses["OK"] > 40
    assert ("CLAMPED" in check.statuses) == (name in ("held", "attitude"))


def test_the_law():
    view = InterpretView(state_feedback(pendulum(), {"angle": 0.1, "torque": 0.5}, [[3.0, 0.2]]))
    _, _, out = step(view, angle=0.2, rate=-1.0)
    assert out["torque"] == pytest.approx(0.5 - 3.0 * 0.1 + 0.2)
    # the shorter way round: from -3.1 to the set point 3.1 is -0.083 rad
    moved = view.params(angle=3.1)
    _, _, out = step(view, params=moved, angle=-3.1, rate=0.0)
    assert out["torque"] == pytest.approx(0.5 - 3.0 * (2 * np.pi - 6.2))


def test_a_command_beyond_its_range_is_held_or_refused():
    plant = pendulum()
    held = InterpretView(state_feedback(plant, {}, [[30.0, 8.0]], saturate=True))
    status, _, out = step(held, angle=0.1, rate=0.0)
    assert (status, out["torque"]) == (Status.CLAMPED, -2.0)
    status, _, out = step(held, angle=0.05, rate=0.0)
    assert (status, out["torque"]) == (Status.OK, pytest.approx(-1.5))
    refused = NativeView(state_feedback(plant, {}, [[30.0, 8.0]]))
    status, _, out = step(refused, angle=0.1, rate=0.0)
    assert (status, out["torque"]) == (Status.OVERFLOW, 0.0)  # as it was


def test_the_attitude_error_is_that_of_the_linearisation():
    block = state_feedback(body(), {"q": Rotation.from_rotvec([0.4, 0, 0]).as_quat(scalar_first=True)}, np.eye(3, 6))
    view = InterpretView(block)
    for sign in (1, -1):  # q and -q are one attitude
        turned = Rotation.from_rotvec([0.4, 0, 0]) * Rotation.from_rotvec([0, 1e-4, 2e-4])
        _, _, out = step(view, q=sign * turned.as_quat(scalar_first=True), spin=[0, 0, 0])
        np.testing.assert_allclose(out["torque"], [0, -1e-4, -2e-4], rtol=0, atol=1e-11)


def test_feedback_brings_the_plant_back():
    gain = place(linearise(pendulum()), [0.8, 0.85])
    view = NativeView(state_feedback(pendulum(), {}, gain, saturate=True))
    x = np.array([0.05, 0.0])
    for _ in range(200):
        _, _, out = step(view, angle=x[0], rate=x[1])
        x = PENDULUM.A @ x + PENDULUM.B[:, 0] * float(out["torque"])
    assert np.max(np.abs(x)) < 1e-6


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (
            lambda: state_feedback(pendulum(), {}, [[1.0]]),
            r"the gain has shape \(1, 1\); give 1 x 2, a row for each input",
        ),
        (lambda: state_feedback(pendulum(), {}, [[1.0, np.nan]]), "gain is no matrix of finite numbers"),
        (lambda: state_feedback(pendulum(), {}, "strong"), "gain is 'strong'; give a matrix of numbers"),
        (
            lambda: state_feedback(pendulum(), {"torque": 9}, [[1.0, 1.0]]),
            "gives .* for 'torque', outside its range -2 .. 2",
        ),
        (lambda: state_feedback(_coasting(), {}, [[1.0]]), "the plant 'coasting' has no input to act on"),
    ],
)
def test_what_is_no_feedback(make, says):
    with pytest.raises(ModelError, match=says):
        make()


def _coasting():
    plant = Plant("coasting")
    place_ = plant.state("place")
    plant.dynamics({place_: -place_})
    return plant


# -- with an estimator ------------------------------------------------------------------------------------------------


def controller(gain=None, plant=None):
    plant = plant or pendulum()
    gain = place(linearise(plant), [0.8, 0.85]) if gain is None else gain
    ekf = extended_kalman_filter(plant, initial_variance={"angle": 0.01, "rate": 0.1})
    feedback = state_feedback(plant, {}, gain, saturate=True, name="feedback")
    lines = {
        **wires("estimator", "feedback", plant.states),
        **wires("feedback", "estimator", plant.inputs, initial={"torque": 0.0}),
    }
    return connect({"estimator": ekf, "feedback": feedback}, lines, "pendulum_controller")


@pytest.mark.parametrize("precision", ["double", "float"])
def test_an_estimator_and_a_feedback_are_one_controller(precision):
    block = controller()
    assert [item.name for item in block.entries["step"].inputs] == ["estimator_has_encoder", "estimator_encoder"]
    assert block.sample_time == 0.02
    check = cross_check(block, precision, steps=60)
    assert check.passed, failures(check)
    assert check.statuses["OK"] + check.statuses["CLAMPED"] > 80


def test_the_applied_command_goes_back_to_the_estimator():
    block = controller()
    whole = NativeView(block)
    parts = {name: NativeView(part) for name, part in block.parts.items()}
    memory, last = None, 0.0
    ekf_memory = parts["estimator"].init()
    for k in range(20):
        reading = 0.1 * np.cos(0.3 * k)
        status, memory, out = step(whole, memory, estimator_has_encoder=True, estimator_encoder=reading)
        assert status >= 0
        _, ekf_memory, _ = step(parts["estimator"], ekf_memory, torque=last, has_encoder=True, encoder=reading)
        _, _, own = step(parts["feedback"], angle=float(ekf_memory["angle"]), rate=float(ekf_memory["rate"]))
        last = float(own["torque"])
        assert float(out["feedback"]["torque"]) == last
        assert float(memory["delay_estimator_torque"]) == last


def test_designed_numbers_of_a_part_are_those_of_the_whole(tmp_path):
    block, file = controller(), tmp_path / "design.json"
    made, wrote = with_design(block, file)
    assert wrote
    assert made is block
    stored = json.loads(file.read_text())
    values = stored["pendulum_controller"]["values"]["feedback.gain"]
    assert values == block.parts["feedback"].design.values["gain"].tolist()
    assert all(result.passed for result in design_residuals(block))

    again, wrote = with_design(controller(), file)
    assert not wrote
    assert again.model_hash() == block.model_hash()

    values[0][0] += 0.5  # what the file says is what the C gets
    file.write_text(json.dumps(stored))
    other, _ = with_design(controller(), file)
    assert other.model_hash() != block.model_hash()
    view = NativeView(other)
    assert view.params()["feedback"]["gain"][0] == values[0][0]
    check = cross_check(other, steps=20)
    assert check.passed, failures(check)
    assert [result.name for result in design_residuals(other) if not result.passed] == [
        "design: feedback: distance of eigenvalues from the poles asked for, of what is accepted"
    ]

    del stored["pendulum_controller"]["values"]["feedback.gain"]
    file.write_text(json.dumps(stored))
    with pytest.raises(ModelError, match=r"design.json has no feedback.gain; export with --redesign"):
        with_design(controller(), file)


def test_a_design_of_another_shape_is_a_sentence():
    design = state_feedback(pendulum(), {}, place(PENDULUM, [0.8, 0.85])).design
    with pytest.raises(ModelError, match=r"the gain of design.json has shape \(1, 1\); give 1 x 2 finite numbers"):
        design.rebuild({"gain": [[1.0]]})


def test_numbers_of_ones_own_are_no_design():
    assert state_feedback(pendulum(), {}, [[30.0, 8.0]]).design is None
    assert controller(gain=[[30.0, 8.0]]).design is None


# -- every block as C -------------------------------------------------------------------------------------------------

BLOCKS = {**FEEDBACKS}


@pytest.mark.slow
@pytest.mark.parametrize("precision", ["double", "float"])
@pytest.mark.parametrize("name", BLOCKS)
def test_every_block_passes_the_gates(name, precision, tmp_path):
    made = export(BLOCKS[name](), tmp_path, precision=precision, steps=60)
    assert made.passed
    assert not any("no independent reference" in item.note for item in made.check.results)
