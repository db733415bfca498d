"""The simulated plant: what a step does, the conventions of its noises, and its oracle."""

import numpy as np
import pytest
from plantc.examples.quadrotor_ekf import hover, quadrotor_ekf, sampled, set_point
from plantc.symbolic.simulated import noise_inputs, simulated_plant

from plantc import InterpretView, ModelError, NativeView, Plant, ReferenceView, cross_check


def pendulum(method="rk4", dt=0.02):
    plant = Plant("pendulum")
    angle = plant.state("angle", unit="rad", angle=True)
    rate = plant.state("rate", unit="rad/s", range=(-50, 50))
    torque = plant.input("torque", unit="N m", range=(-5, 5))
    gravity = plant.parameter("gravity", 9.81, unit="m/s^2", range=(0, 20))
    gust = plant.noise("gust", density=0.02, unit="N m")
    jitter = plant.noise("jitter", std=0.01, unit="rad")
    from plantc.symbolic import sin

    plant.dynamics({angle: rate, rate: torque + gust - gravity * sin(angle)})
    plant.sensor("encoder", angle + jitter, unit="rad", angle=True)
    plant.sensor("gyro", rate, unit="rad/s", variance=1e-4 + 1e-3 * rate**2)
    return plant.discretise(method, dt=dt)


def cart(method):
    plant = Plant("cart")
    position = plant.state("position", unit="m", range=(-90, 90))
    speed = plant.state("speed", unit="m/s", range=(-100, 100))
    push = plant.input("push", unit="m/s^2", range=(-5, 5))
    gust = plant.noise("gust", density=0.01, unit="m/s^2")
    plant.dynamics({position: speed, speed: push + gust})
    plant.sensor("gps", position, unit="m", variance=0.5)
    return plant.discretise(method, dt=0.1)


def body():
    plant = Plant("body")
    attitude = plant.attitude("attitude")
    gyro = plant.input("gyro", size=3, unit="rad/s", range=(-10, 10))
    drift = plant.noise("drift", size=3, density=1e-4, unit="rad/s")
    plant.dynamics({attitude: gyro + drift})
    slope = 0.01 * np.eye(3) + 0.002
    plant.sensor("gravity", attitude.to_body([0, 0, 9.81]), unit="m/s^2", variance=slope)
    return plant.discretise("rk4", dt=0.01).step_noise({attitude: 1e-6})


@pytest.mark.parametrize(
    "plant",
    [
        pendulum(),
        pendulum("euler", (0.01, 0.05)),
        cart("exact"),
        cart("tustin"),
        body(),
        pytest.param(sampled, marks=pytest.mark.slow),
    ],
    ids=["rk4", "dt is an input", "exact", "tustin", "attitude", "quadrotor"],
)
def test_the_views_agree(plant):
    around = set_point if plant is sampled else {}
    check = cross_check(simulated_plant(plant, around=around), steps=40)
    assert check.passed, [(item.name, str(item.mismatch), item.note) for item in check.failures]


def one_step(block, memory, params=None, view=InterpretView, **inputs):
    runner = view(block)
    given = runner.params(**(params or {}))
    return runner.call("step", runner.memory(**memory), runner.inputs("step", inputs), given)


def test_a_step_is_runge_kutta_with_the_noise_held_then_a_reading_at_the_new_state():
    inputs = {"torque": 0.3, "gust": 0.7, "jitter": 0.05, "gyro_noise": 2.0}
    answer = one_step(simulated_plant(pendulum()), {"angle": 3.1, "rate": 4.0}, {"gravity": 9.0}, **inputs)

    def f(x):
        return np.array([x[1], 0.3 + 0.7 - 9.0 * np.sin(x[0])])

    x, h = np.array([3.1, 4.0]), 0.02
    k1 = f(x)
    k2 = f(x + h / 2 * k1)
    k3 = f(x + h / 2 * k2)
    k4 = f(x + h * k3)
    x = x + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    assert x[0] > np.pi  # it went over the top, and is wrapped
    np.testing.assert_allclose(answer.memory["angle"], x[0] - 2 * np.pi, rtol=1e-13)
    np.testing.assert_allclose(answer.memory["rate"], x[1], rtol=1e-13)
    np.testing.assert_allclose(answer.outputs["encoder"], x[0] - 2 * np.pi + 0.05, rtol=1e-13)
    expected = x[1] + 2.0 * np.sqrt(1e-4 + 1e-3 * x[1] ** 2)
    np.testing.assert_allclose(answer.outputs["gyro"], expected, rtol=1e-13)


def test_without_noise_it_is_what_an_estimator_predicts():
    rng = np.random.default_rng(1)
    names = [state.signal.name for state in sampled.states]
    memory = dict(zip(names, rng.normal(size=12), strict=True))
    rotors = {f"rotor_{k}": hover + rng.normal() for k in (1, 2, 3, 4)}
    ekf = NativeView(quadrotor_ekf)
    covariance = np.zeros(78)
    covariance[[12 * i - i * (i - 1) // 2 for i in range(12)]] = 0.01
    given = ekf.memory(**memory, covariance=covariance)
    predicted = ekf.call("predict", given, ekf.inputs("predict", rotors), ekf.params()).memory
    moved = one_step(simulated_plant(sampled), memory, view=NativeView, **rotors)
    for name in names:
        np.testing.assert_allclose(moved.memory[name], predicted[name], rtol=1e-14, atol=1e-15)
    np.testing.assert_array_equal(moved.outputs["pose"], [moved.memory[name] for name in names])


def test_step_noise_and_sensor_noise_are_added_as_they_are_given():
    block = simulated_plant(sampled)
    rotors = {f"rotor_{k}": hover for k in (1, 2, 3, 4)}
    quiet = one_step(block, {"z": 30.0}, **rotors)
    noisy = one_step(block, {"z": 30.0}, **rotors, vx_noise=0.25, pose_noise=np.arange(12.0))
    assert noisy.memory["vx"] - quiet.memory["vx"] == 0.25
    expected = np.arange(12.0)
    expected[1] += 0.25
    np.testing.assert_allclose(noisy.outputs["pose"] - quiet.outputs["pose"], expected, atol=1e-14)


def test_the_strengths_are_the_plants_and_say_what_they_are():
    found = {item.signal.name: item for item in noise_inputs(pendulum())}
    assert list(found) == ["gust", "jitter", "gyro_noise"]
    assert found["gust"].covariance[0, 0] == pytest.approx(0.02 / 0.02)
    assert found["jitter"].covariance[0, 0] == pytest.approx(1e-4)
    assert found["gyro_noise"].covariance[0, 0] == 1.0
    assert "density / dt" in found["gust"].convention
    found = {item.signal.name: item for item in noise_inputs(sampled)}
    assert found["roll_noise"].covariance[0, 0] == 1e-6
    np.testing.assert_array_equal(found["pose_noise"].covariance, 0.01 * np.eye(12))


def test_a_state_or_a_reading_outside_its_range_is_refused():
    block = simulated_plant(cart("exact"))
    view = ReferenceView(block)
    for runner in (view, NativeView(block)):
        memory = runner.memory(position=89.9, speed=2.0)
        answer = runner.call("step", memory, runner.inputs("step", {}), runner.params())
        assert answer.status.name == "OVERFLOW"
        assert answer.memory["position"] == 89.9
        answer = runner.call("step", memory, runner.inputs("step", {"gust": np.nan}), runner.params())
        assert answer.status.name == "BAD_INPUT"


def test_what_cannot_be_simulated_is_said():
    plant = Plant("tank", dt=1.0)
    level = plant.state("level")
    plant.dynamics({level: level})
    plant.sensor("gauge", level, variance=lambda z: 1 + z**2)
    with pytest.raises(ModelError, match="depends on its reading"):
        simulated_plant(plant)
    with pytest.raises(ModelError, match="a simulated plant runs in discrete time"):
        simulated_plant(sampled.discretisation.continuous)
    with pytest.raises(ModelError, match="simulate the plant with a constant dt"):
        noise_inputs(pendulum("euler", (0.01, 0.05)))
