"""Controllers as Blocks: what they compute, their statuses, their oracles, and the C of each in float and double."""

import json
from dataclasses import replace

import control
import numpy as np
import pytest
from plantc.codegen.package import design_residuals, with_design
from plantc.symbolic.regulator_equations import RegulatorError
from scipy import signal
from scipy.spatial.transform import Rotation

from plantc import (
    InterpretView,
    ModelError,
    NativeView,
    Plant,
    ReferenceView,
    Status,
    connect,
    cross_check,
    delay,
    export,
    extended_kalman_filter,
    linearise,
    low_pass,
    lqr,
    notch,
    pid,
    place,
    rate_limiter,
    saturation,
    state_feedback,
    state_space,
    transfer_function,
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
    law = state_feedback(pendulum(), {"angle": 0.1, "torque": 0.5}, [[3.0, 0.2]], accept_unstable=True)  # round numbers
    view = InterpretView(law)
    _, _, out = step(view, angle=0.2, rate=-1.0)
    assert out["torque"] == pytest.approx(0.5 - 3.0 * 0.1 + 0.2)
    # the shorter way round: from -3.1 to the set point 3.1 is -0.083 rad
    moved = view.params(angle=3.1)
    _, _, out = step(view, params=moved, angle=-3.1, rate=0.0)
    assert out["torque"] == pytest.approx(0.5 - 3.0 * (2 * np.pi - 6.2))


def test_a_gain_that_makes_the_plant_unstable_is_refused():
    gain = place(linearise(pendulum()), [0.8, 0.85])
    for turned in (-gain.gain, replace(gain, gain=-gain.gain)):
        with pytest.raises(
            RegulatorError, match=r"A - B K has spectral radius 1\.\d+, not below 1\); -K would, so look"
        ):
            state_feedback(pendulum(), {}, turned)
        assert "step" in state_feedback(pendulum(), {}, turned, accept_unstable=True).entries
    assert "step" in state_feedback(pendulum(), {}, gain).entries


@pytest.mark.parametrize("dt", [None, 0.02, (0.01, 0.05)])
def test_what_the_inputs_do_not_reach_is_no_fault_of_the_gain(dt):
    """An integrator that is left alone, and a mode that no input moves; but not one that it could move."""
    plant = Plant("cart")
    x, v, far = plant.state("x"), plant.state("v"), plant.state("drift")
    u = plant.input("u")
    plant.dynamics({x: v, v: u, far: 0.1 * far})
    plant = plant if dt is None else plant.discretise("euler", dt=dt)
    assert "step" in state_feedback(plant, {}, [[0.0, 2.0, 0.0]]).entries
    with pytest.raises(RegulatorError, match="the gain does not stabilise the plant"):
        state_feedback(plant, {}, [[0.0, -2.0, 0.0]])


def test_a_gain_for_held_commands_is_judged_with_them():
    plant = Plant("cart")
    x, v, u = plant.state("x"), plant.state("v"), plant.input("u", range=(-1e4, 1e4))
    plant.dynamics({x: v, v: u})
    linear = linearise(plant.discretise("exact", dt=0.5))
    gain = lqr(linear, np.diag([1.0, 1.0]), np.eye(1))
    assert "step" in state_feedback(plant, {}, gain).entries
    fast = lqr(linearise(plant), np.diag([1e4, 10.0]), np.eye(1))
    assert "step" in state_feedback(plant, {}, fast).entries
    with pytest.raises(
        RegulatorError, match="spectral radius"
    ):  # fast enough to be unstable where it is held for half a second
        state_feedback(plant, {}, replace(gain, gain=fast.gain))


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
    point = {"q": Rotation.from_rotvec([0.4, 0, 0]).as_quat(scalar_first=True)}
    block = state_feedback(body(), point, np.eye(3, 6), accept_unstable=True)  # without damping
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


def controller(gain=None, plant=None, variance=0.01):
    plant = plant or pendulum()
    gain = place(linearise(plant), [0.8, 0.85]) if gain is None else gain
    ekf = extended_kalman_filter(plant, initial_variance={"angle": variance, "rate": 10 * variance})
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


def test_the_nominal_calls_of_a_controller_are_those_of_its_loop():
    """Planted: without an oracle nobody knows its commands, and what it reads falls over as if there were none."""
    block = controller(variance=1e-4)  # so upright at first that the motor can hold it
    assert linearise(pendulum()).eigenvalues().real.max() > 1
    farthest, restarts = {}, {}
    for name in ("closed", "open"):
        calls = list(block.scenario.calls(np.random.default_rng(1), 300))
        assert calls[0][0] == "init"
        readings = [abs(float(np.ravel(inputs["estimator_encoder"])[0])) for entry, inputs in calls if entry == "step"]
        farthest[name], restarts[name] = max(readings), sum(entry == "init" for entry, _ in calls)
        block.oracle = None
    assert farthest["closed"] < 0.5 < 1.5 < farthest["open"]
    assert restarts["closed"] == 2  # a part's scenario has 200 calls


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
    assert wrote is not None
    assert made is block
    stored = json.loads(file.read_text())
    values = stored["pendulum_controller"]["values"]["feedback.gain"]
    assert values == block.parts["feedback"].design.values["gain"].tolist()
    assert all(result.passed for result in design_residuals(block))

    again, wrote = with_design(controller(), file)
    assert wrote is None
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


# -- PID --------------------------------------------------------------------------------------------------------------

H = 0.1
PIDS = {
    "pid": lambda: pid(2.0, 0.5, 0.3, dt=H, command_range=(0, 10), range=(-50, 50), unit="K", command_unit="W"),
    "pi_negative": lambda: pid(-2.0, -0.5, dt=H, command_range=(-3, 3), range=(-50, 50)),
    "pd": lambda: pid(2.0, 0.0, 0.3, dt=H, command_range=(-3, 3), range=(-50, 50), derivative_weight=1.0),
    "integral_only": lambda: pid(0.0, 2.0, dt=H, command_range=(-3, 3)),
}


@pytest.mark.parametrize("precision", ["double", "float"])
@pytest.mark.parametrize("name", PIDS)
def test_all_views_of_a_pid_agree(name, precision):
    check = cross_check(PIDS[name](), precision, steps=60)
    assert check.passed, failures(check)
    assert check.statuses["OK"] > 30
    assert check.statuses["CLAMPED"] > 5


def driven(block, errors, params=None):
    """Return the commands of a PID with set point 0 for a sequence of errors."""
    view, answer = ReferenceView(block), []
    params, memory = view.params(**(params or {})), None
    for error in errors:
        _, memory, out = step(view, memory, params, set_point=0.0, measured=-error)
        answer.append(float(out["command"]))
    return np.array(answer)


@pytest.mark.parametrize("kd", [0.0, 0.7])
def test_a_pid_within_its_limits_is_a_linear_filter(kd):
    kp, ki, tf = 1.5, 0.8, 0.25
    block = pid(kp, ki, kd, dt=H, filter_time=tf, command_range=(-1e6, 1e6))
    errors = np.concatenate([[0.0], np.random.default_rng(0).normal(size=60)])
    a = tf / (tf + H)
    # P + forward Euler I + backward difference of a filtered slope, over (1 - 1/z)(1 - a/z)
    numerator = np.polymul([1, -1], [1, -a]) * kp
    numerator = numerator + np.convolve([0, ki * H], [1, -a]) + kd / (tf + H) * np.polymul([1, -1], [1, -1])
    expected = signal.lfilter(numerator, np.polymul([1, -1], [1, -a]), errors)
    np.testing.assert_allclose(driven(block, errors), expected, rtol=1e-9, atol=1e-9)


def test_the_integral_does_not_wind_up():
    kp, ki, tt, e = 1.0, 2.0, 0.5, 3.0
    block = pid(kp, ki, dt=H, tracking_time=tt, command_range=(-2, 2))
    view = InterpretView(block)
    memory, params = None, view.params()
    for k in range(200):
        status, memory, out = step(view, memory, params, set_point=e, measured=0.0)
        if k == 0:
            first = float(memory["integral_part"])
    assert (status, out["command"]) == (Status.CLAMPED, 2.0)
    # at rest ki e = (unlimited - limited) / tt, reached by a factor 1 - dt/tt a step
    settled = 2.0 - kp * e + tt * ki * e
    assert memory["integral_part"] == pytest.approx(settled, abs=1e-9)
    assert first == pytest.approx(settled * H / tt, abs=1e-12)
    # and so the command leaves its limit within steps of the error changing sign, where a plain integral takes as long
    # as it was held

    def steps_at_limit(tracking_time):
        commands = driven(block, [e] * 200 + [-0.5] * 400, {"tracking_time": tracking_time})
        return int(np.argmax([*(commands[200:] < 2.0), True]))  # all of them, if it never leaves

    assert steps_at_limit(tt) <= 6
    assert steps_at_limit(100.0) > 300


def test_no_jump_when_the_controller_takes_over_or_is_retuned():
    view = NativeView(pid(2.0, 0.5, 0.3, dt=H, command_range=(0, 10), set_point_weight=0.6))
    params, memory = view.params(), None
    for _ in range(5):
        _, memory, _ = step(view, memory, params, "track", set_point=5.0, measured=4.0, applied=3.25)
    status, memory, out = step(view, memory, params, set_point=5.0, measured=4.0)
    assert (status, float(out["command"])) == (Status.OK, pytest.approx(3.25, abs=1e-12))
    retuned = view.params(proportional=6.0, integral=0.1, derivative=0.0)
    for _ in range(3):
        _, memory, out = step(view, memory, params, set_point=5.0, measured=4.0)
    last = float(out["command"])
    assert last > 3.25 + 2 * 0.5 * H * 0.9
    _, memory, _ = step(view, memory, retuned, "track", set_point=5.0, measured=4.0, applied=last)
    _, memory, out = step(view, memory, retuned, set_point=5.0, measured=4.0)
    assert out["command"] == pytest.approx(last, abs=1e-12)


def test_set_point_weights_and_no_kick_at_the_start():
    block = pid(2.0, 0.0, 1.0, dt=H, filter_time=0.2, command_range=(-1e3, 1e3), set_point_weight=0.5)
    view = InterpretView(block)
    _, memory, out = step(view, set_point=4.0, measured=1.0)
    assert out["command"] == pytest.approx(2.0 * (0.5 * 4.0 - 1.0))  # the first reading has no slope
    _, memory, out = step(view, memory, set_point=8.0, measured=1.0)
    assert out["command"] == pytest.approx(2.0 * (0.5 * 8.0 - 1.0))  # D does not see the set point
    _, _, out = step(view, memory, set_point=8.0, measured=1.3)
    assert out["command"] == pytest.approx(2.0 * (0.5 * 8.0 - 1.3) - 1.0 / (0.2 + H) * 0.3)
    weighted = view.params(derivative_weight=1.0)
    _, _, out = step(view, memory, weighted, set_point=9.0, measured=1.0)
    assert out["command"] == pytest.approx(2.0 * (0.5 * 9.0 - 1.0) + 1.0 / (0.2 + H))


def test_without_integral_gain_nothing_is_integrated():
    view = NativeView(PIDS["pd"]())
    params, memory = view.params(), None
    for _ in range(20):
        status, memory, _ = step(view, memory, params, set_point=40.0, measured=0.0)
    assert (status, memory["integral_part"]) == (Status.CLAMPED, 0.0)
    _, memory, _ = step(view, memory, params, "track", set_point=40.0, measured=0.0, applied=1.0)
    assert memory["integral_part"] == 0.0


def test_a_pid_closes_a_loop_of_blocks():
    """Heater and controller as one block: the temperature settles on the set point, the command is held on the way."""
    heater = transfer_function(
        control.tf([2.0], [5.0, 1.0]), dt=H, method="zoh", range=(0, 10), unit="W", output_unit="K"
    )
    loop = connect(
        {"pid": pid(3.0, 0.8, dt=H, command_range=(0, 10), unit="K", command_unit="W"), "heater": heater},
        {"pid.measured": delay("heater.filtered", 0.0), "heater.raw": "pid.command"},
        "oven",
    )
    assert loop.sample_time == H
    check = cross_check(loop, steps=30)
    assert check.passed, failures(check)
    view = NativeView(loop)
    memory, statuses, values = None, [], []
    for _ in range(600):
        status, memory, out = step(view, memory, pid_set_point=15.0)
        statuses.append(status)
        values.append(float(out["heater"]["filtered"]))
    assert statuses[0] == Status.CLAMPED
    assert statuses[-1] == Status.OK
    assert values[-1] == pytest.approx(15.0, abs=1e-6)
    assert max(values) < 15.0 * 1.05


@pytest.mark.parametrize("limits", [{"minimum": 6.0, "maximum": 4.0}, {"tracking_time": 0.01}, {"filter_time": -1.0}])
def test_init_refuses_parameters_that_make_no_sense(limits):
    for view in (NativeView, InterpretView, ReferenceView):
        made = view(PIDS["pid"]())
        with pytest.raises(ValueError, match="BAD_PARAM"):
            made.init(made.params(**limits))


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: pid(1.0, dt=H, command_range=(1, -1)), "the range of the signal is 1 .. -1"),
        (lambda: pid(1.0, dt=0, command_range=(-1, 1)), "dt is 0; give the seconds per step"),
        (
            lambda: pid(1.0, 1.0, dt=H, command_range=(-1, 1), tracking_time=0.05),
            "tracking_time is 0.05 s; give at least 0.1",
        ),
        (lambda: pid(1.0, 1.0, dt=H, command_range=(-1, 1), filter_time=-1), "filter_time is -1 s; give at least 0 s"),
    ],
)
def test_what_is_no_pid(make, says):
    with pytest.raises(ModelError, match=says):
        make()


# -- as C -------------------------------------------------------------------------------------------------------------

EXPORTED = [  # a block of each shape; those of the same shape are cross-checked in both precisions beside their own tests
    (FEEDBACKS["attitude"], "double"),
    (PIDS["pid"], "float"),
    (lambda: notch(2.0, 0.5, dt=H, depth=0.9, range=(-10, 10)), "double"),
    (lambda: rate_limiter(2.0, -3.0, dt=H, range=(-10, 10)), "float"),
    (lambda: saturation(-1, 1), "float"),
    (lambda: transfer_function(signal.butter(5, 1.0, fs=1 / H), dt=H, range=(-10, 10)), "float"),
]


@pytest.mark.slow
@pytest.mark.parametrize(("make", "precision"), EXPORTED, ids=[f"{make().name}-{word}" for make, word in EXPORTED])
def test_a_block_passes_the_gates(make, precision, tmp_path):
    made = export(make(), tmp_path, precision=precision, steps=40)
    assert made.passed
    assert not any("no independent reference" in item.note for item in made.check.results)


def test_a_part_without_memory_and_parameters():
    twice = transfer_function(([2.0], [1.0]), dt=H, range=(-10, 10))
    states = state_space(control.ss([[0, 1], [-4, -0.5]], [[0], [1]], [[1, 0]], 0), dt=H, method="zoh")
    lines = {"states.u_0": "twice.filtered", "slow.raw": "states.y_0"}
    block = connect({"twice": twice, "states": states, "slow": low_pass(1.0, dt=H, order=2)}, lines, "chain")
    check = cross_check(block, "float", steps=20)
    assert check.passed, failures(check)
