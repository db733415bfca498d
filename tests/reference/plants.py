"""Small plants written by hand in NumPy, as f and h would be lowered."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from plantc.reference import InputModel, Model, NoiseModel, SensorModel, StateModel

WIDE = 1e6


def signal(name: str, size: int = 1, low: float = -WIDE, high: float = WIDE) -> InputModel:
    return InputModel(name, size, np.full(size, low), np.full(size, high))


def no_extra(size: int) -> Any:
    return lambda x, z, u, p: (np.zeros((size, size), dtype=np.result_type(x, z)),)


def sensor(name: str, size: int, measure: Any, **changes: Any) -> SensorModel:
    made = SensorModel(
        name, size, False, np.full(size, -WIDE), np.full(size, WIDE), (), measure, (), f"variance_{name}", False,
        no_extra(size),
    )  # fmt: skip
    return replace(made, **changes)


def model_of(states: list[StateModel], dynamics: Any, sensors: list[SensorModel], **changes: Any) -> Model:
    n = sum(state.error_size for state in states)
    plant = {
        "states": tuple(states), "inputs": (), "params": (), "plant_params": (), "dynamics": dynamics,
        "method": "rk4", "substeps": 1, "dt": 0.1, "noises": (), "step_variances": (), "sensors": tuple(sensors),
        "floor": np.full(n, 1e-20), "ceiling": np.full(n, 1e9),
    }  # fmt: skip
    plant |= changes
    params = list(plant["params"])
    for noise in plant["noises"]:
        params.append(signal(noise.parameter, noise.size * (noise.size + 1) // 2 if noise.full else noise.size))
    for item in sensors:
        if item.variance:
            size = item.size * (item.size + 1) // 2 if item.full else item.size
            params.append(signal(item.variance, size, -1e6 if item.full else 1e-12))
        params.append(signal(f"gate_{item.name}", 1, 0))
    params.append(signal("inflation", 1, 1))
    for state in states:
        params.append(InputModel(f"{state.name}_0", state.size, state.low, state.high))
        params.append(signal(f"variance_{state.name}_0", state.error_size, 1e-12))
    plant["params"] = tuple(params)
    return Model(**plant)


def params_of(model: Model, **given: Any) -> dict[str, Any]:
    """Every parameter: ones for variances, zeros for gates and initial states, unit attitudes."""
    values: dict[str, Any] = {"reject_limit": np.array([0]), "inflation": np.array([100.0])}
    for item in model.params:
        values.setdefault(item.name, np.full(item.size, 1.0 if item.name.startswith(("variance", "density")) else 0.0))
    for state in model.states:
        if state.kind == "attitude":
            values[f"{state.name}_0"] = np.array([1.0, 0, 0, 0])
    return values | {name: np.atleast_1d(np.asarray(value, dtype=float)) for name, value in given.items()}


OSCILLATOR = np.array([[0.0, 1.0], [-2.0, -0.3]])
PUSH = np.array([[0.0], [1.0]])


def oscillator(**changes: Any) -> Model:
    """x' = A x + B (u + w): linear, one full sensor of position and of sum."""
    state = StateModel("x", 2, "plain", np.full(2, -WIDE), np.full(2, WIDE))
    rows = np.array([[1.0, 0.0], [1.0, 1.0]])
    both = sensor("both", 2, lambda x, u, p, v: (rows.astype(np.real(x).dtype) @ x,), full=True)
    one = sensor("one", 1, lambda x, u, p, v: (x[:1] * 1,))

    def dynamics(x: Any, u: Any, p: Any, w: Any) -> Any:
        kind = np.real(x).dtype
        return (OSCILLATOR.astype(kind) @ x + PUSH.astype(kind) @ (u + w),)

    options = {"inputs": (signal("u", 1, -10, 10),), "noises": (NoiseModel("density_w", 1, True, False),)}
    return model_of([state], dynamics, [both, one], **(options | changes))


def pendulum(**changes: Any) -> Model:
    """An angle and its rate, driven; the angle is measured, wrapped, and so is its sine."""
    angle = StateModel("angle", 1, "angle", np.array([-3.15]), np.array([3.15]))
    speed = StateModel("speed", 1, "plain", np.array([-20.0]), np.array([20.0]))

    def dynamics(x: Any, u: Any, p: Any, w: Any) -> Any:
        return (np.stack([x[1] + 0 * x[0], -9.81 * np.sin(x[0]) + u[0] + w[0] * np.cos(x[0])]),)

    sensors = [
        sensor("encoder", 1, lambda x, u, p, v: (x[:1] * 1,), angle=True),
        sensor("sine", 1, lambda x, u, p, v: (np.sin(x[:1]) * (1 + v),), variance="",
               noises=(NoiseModel("variance_v", 1, False, False),), extra_variance=lambda x, z, u, p: (
                   np.reshape(0.01 + 0.1 * z * z, (1, 1)),)),
    ]  # fmt: skip
    options = {
        "inputs": (signal("u", 1, -10, 10),), "noises": (NoiseModel("density_w", 1, True, False),),
        "params": (signal("variance_v", 1, 0),), "dt": (0.001, 0.5),
    }  # fmt: skip
    return model_of([angle, speed], dynamics, sensors, **(options | changes))


def attitude(**changes: Any) -> Model:
    """A quaternion turned by a gyroscope with a bias; a direction is seen from the body."""
    q = StateModel("q", 4, "attitude", np.full(4, -1.01), np.full(4, 1.01))
    bias = StateModel("bias", 3, "plain", np.full(3, -10.0), np.full(3, 10.0))
    north = (0.8, 0.0, 0.6)

    def dynamics(x: Any, u: Any, p: Any, w: Any) -> Any:
        return (np.concatenate([u - x[4:] + w[:3], w[3:] + 0 * x[4:]]),)

    def to_body(x: Any, u: Any, p: Any, v: Any) -> Any:
        w, a, b, c = x[0], x[1], x[2], x[3]
        return (
            np.stack([
                (1 - 2 * (b * b + c * c)) * north[0] + 2 * (a * b + w * c) * north[1] + 2 * (a * c - w * b) * north[2],
                2 * (a * b - w * c) * north[0] + (1 - 2 * (a * a + c * c)) * north[1] + 2 * (b * c + w * a) * north[2],
                2 * (a * c + w * b) * north[0] + 2 * (b * c - w * a) * north[1] + (1 - 2 * (a * a + b * b)) * north[2],
            ]),
        )  # fmt: skip

    options = {"inputs": (signal("gyro", 3, -10, 10),), "noises": (NoiseModel("density_w", 6, True, False),)}
    return model_of([q, bias], dynamics, [sensor("compass", 3, to_body)], **(options | changes))
