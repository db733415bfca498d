"""The jump matrix technique: what it makes of a plant, what it refuses, and the edges of its estimators."""

import casadi as ca
import numpy as np
import pytest
from plantc.symbolic import ModelError, Plant, sin
from plantc.symbolic.jump_matrix import jump_matrix_estimator, jump_model

from plantc import cross_check, export


def pendulum(**changed):
    plant = Plant("pendulum")
    angle, rate = plant.state("angle", range=(-20, 20)), plant.state("rate", range=(-100, 100))
    torque = plant.input("torque", range=(-50, 50))
    w = plant.noise("w", density=0.01)
    rates = {angle: rate, rate: -9.81 * sin(angle) - 0.2 * rate + torque + w} | {
        {"angle": angle, "rate": rate}[key]: value(angle, rate, torque, w) for key, value in changed.items()
    }
    plant.dynamics(rates)
    plant.sensor("encoder", angle, std=0.01)
    return plant, angle, rate


def evaluated(model, expression, x, u=(), w=()):
    plant = model.plant
    noises = ca.vertcat(ca.SX(0, 1), *[noise.symbol for noise in plant.process_noises])
    function = ca.Function("value", [plant.x, plant.u, noises, plant.p], [expression])
    defaults = [item for symbol in plant.parameters for item in symbol.signal.default]
    return np.array(function(x, list(u), list(w), defaults), dtype=float)


def test_the_parts_of_a_model():
    plant, angle, _ = pendulum()
    model = jump_model(plant, {"gravity": sin(angle)}, 0.01, units={"gravity": ""}, ranges={"gravity": (-1.5, 1.5)})
    assert model.clamps == ("gravity",)
    assert [state.signal.name for state in model.plant.states] == ["angle", "rate", "gravity"]
    assert np.array_equal(model.A, [[0, 1, 0], [0, -0.2, -9.81], [0, 0, 0]])
    assert np.array_equal(model.B, [[0], [1], [0]])
    assert np.array_equal(model.L, [[0], [1], [0]])
    assert model.plant.dt == 0.01
    assert not model.plant.noises[0].is_density
    assert model.plant.noises[0].strength == pytest.approx(1.0)  # density / dt
    assert plant.noises[0].is_density  # the plant that was given is as it was
    assert len(plant.states) == 2


def test_the_jump_does_not_use_old_values():
    """J(J(x)) = J(x); DJ has zero columns for the nonlinearities and unit rows for the rest (section 1)."""
    model = made()
    x = np.array([0.7, -2.0, 99.0])
    once = evaluated(model, model.J, x).ravel()
    assert once.tolist() == [0.7, -2.0, np.sin(0.7)]
    assert evaluated(model, model.J, once).ravel().tolist() == once.tolist()
    assert evaluated(model, model.DJ, x).tolist() == [[1, 0, 0], [0, 1, 0], [np.cos(0.7), 0, 0]]


def made(**options):
    plant, angle, _ = pendulum()
    return jump_model(plant, {"gravity": sin(angle)}, 0.01, **options)


def test_the_step_is_the_projection_and_the_jump():
    model = made()
    plant = model.plant
    step = evaluated(model, plant.dynamics_expression(), [0.7, -2.0, 0.3], [1.5], [0.4]).ravel()
    before = model.Phi @ [0.7, -2.0, 0.3] + model.Gam @ [1.5] + model.Psi @ [0.4]
    assert step == pytest.approx([before[0], before[1], np.sin(before[0])], rel=1e-14)


def test_a_constant_in_the_rates_may_be_a_parameter():
    """It is driven like an input: exactly."""
    plant = Plant("faller")
    height, speed = plant.state("height"), plant.state("speed")
    gravity = plant.parameter("gravity", 9.81, range=(0, 20))
    plant.dynamics({height: speed, speed: -gravity - 0.5 * speed * ca.fabs(speed)})
    plant.sensor("z", height, std=0.1)
    model = jump_model(plant, {"drag": speed * ca.fabs(speed)}, 0.1)
    step = evaluated(model, model.plant.dynamics_expression(), [3.0, 2.0, 4.0]).ravel()
    rate = -9.81 - 2.0
    assert step[:2] == pytest.approx([3 + 0.2 + rate * 0.005, 2 + 0.1 * rate], rel=1e-14)


def test_a_product_is_found_in_any_order():
    plant = Plant("vdp")
    x, v = plant.state("x"), plant.state("v")
    plant.dynamics({x: v, v: 2 * v - 2 * (v * x**2) - 9 * x})
    plant.sensor("z", x, std=0.1)
    model = jump_model(plant, {"braking": x**2 * v}, 0.01)
    assert np.array_equal(model.A[:2], [[0, 1, 0], [-9, 2, -2]])


def test_several_nonlinearities_one_inside_another():
    """Item of section 10: the inner one is found inside the outer one, whichever is named first, and comes first."""
    plant = Plant("chain")
    s = plant.state("s", range=(-5, 5))
    inner = sin(s)
    outer = inner**3 + s
    plant.dynamics({s: -s + inner - 2 * outer + plant.noise("w", density=0.1)})
    plant.sensor("z", s, std=0.1)
    for named in ({"outer": outer, "inner": inner}, {"inner": inner, "outer": outer}):
        model = jump_model(plant, named, 0.05)
        assert model.clamps == ("inner", "outer")
        at = {state.signal.name: state.at.start for state in model.plant.states}
        assert model.A[0, [at["s"], at["inner"], at["outer"]]].tolist() == [-1, 1, -2]
        x = np.full(3, 7.0)
        x[at["s"]] = 0.4
        J, DJ = evaluated(model, model.J, x).ravel(), evaluated(model, model.DJ, x)
        assert J[at["outer"]] == pytest.approx(np.sin(0.4) ** 3 + 0.4)
        # the chain rule through the inner one; nothing by the held values
        assert DJ[at["outer"], at["s"]] == pytest.approx(3 * np.sin(0.4) ** 2 * np.cos(0.4) + 1)
        assert not np.any(DJ[:, [at["inner"], at["outer"]]])
    assert cross_check(jump_matrix_estimator(model, initial_variance=0.1)).passed


def test_the_order_of_the_state_is_free():
    """Item of section 10: a nonlinearity that is not last."""
    plant, angle, rate = pendulum()
    model = jump_model(plant, {"gravity": sin(angle)}, 0.01, order=["gravity", rate, angle])
    last = made()
    turned = np.ix_([2, 1, 0], [2, 1, 0])
    assert np.array_equal(model.Phi, last.Phi[turned])
    assert model.clamped == (0,)
    assert np.array_equal(model.Gam, last.Gam[[2, 1, 0]])


def test_a_vector_of_nonlinearities():
    plant = Plant("two")
    x = plant.state("x", size=2, range=(-3, 3))
    both = x**3
    plant.dynamics({x: -x - both + plant.noise("w", size=2, density=0.01)})
    plant.sensor("z", x, std=0.1)
    model = jump_model(plant, {"cubes": both}, 0.01)
    assert model.clamped == (2, 3)
    assert np.array_equal(model.A[:2], [[-1, 0, -1, 0], [0, -1, 0, -1]])
    point = model.point({"x": [1.0, 2.0]})
    assert point["cubes"].tolist() == [1.0, 8.0]


# -- what is refused --------------------------------------------------------------------------------------------------


def says(what, **options):
    plant, angle, rate = pendulum(**options.pop("changed", {}))
    with pytest.raises(ModelError) as said:
        jump_model(
            plant,
            options.pop("named", lambda a, r: {"gravity": sin(a)})(angle, rate),
            options.pop("dt", 0.01),
            **options,
        )
    assert what in str(said.value)
    assert "\n" not in str(said.value)


def test_refusals():
    says("does not occur in the dynamics as it is written there", named=lambda a, r: {"cubic": a**3})
    says("is the constant 2", named=lambda a, r: {"two": ca.SX(2)})
    says(
        "the dynamics of 'rate' are not affine besides gravity: their derivative by 'rate' is -(2 rate)",
        changed={"rate": lambda a, r, u, w: sin(a) - r**2},
    )
    says("their derivative by 'angle' is torque", changed={"rate": lambda a, r, u, w: sin(a) + a * u})
    says("are not affine: their derivative by 'angle'", named=lambda a, r: {})
    says("two nonlinearities are the same", named=lambda a, r: {"one": sin(a), "other": sin(a)})
    says("seconds per step", dt=-1.0)
    says("give each state and nonlinearity once", order=["angle", "rate"])
    says("ranges= names 'friction'", ranges={"friction": (0, 1)})
    says("is used twice", named=lambda a, r: {"rate": sin(a)})
    says("grows beyond all numbers", dt=1e6, changed={"angle": lambda a, r, u, w: a + r})


def test_a_noise_at_two_instants_is_refused():
    plant = Plant("both")
    x, w = plant.state("x"), plant.noise("w", density=1e-3)
    bent = sin(x + w)
    plant.dynamics({x: -x + bent + w})
    plant.sensor("z", x, std=0.1)
    with pytest.raises(ModelError, match="'w' stands inside a nonlinearity, .* use two noises"):
        jump_model(plant, {"bent": bent}, 0.01)


def test_a_parameter_in_the_linear_part_is_refused_and_in_a_nonlinearity_is_not():
    plant = Plant("tuned")
    x, k = plant.state("x"), plant.parameter("k", 2.0, range=(0, 10))
    bent = sin(k * x)
    plant.dynamics({x: -k * x + bent})
    plant.sensor("z", x, std=0.1)
    with pytest.raises(
        ModelError, match="the coefficient -k of 'x' in the dynamics of 'x' depends on a run-time parameter"
    ):
        jump_model(plant, {"bent": bent}, 0.01)
    assert jump_model(plant, {"bent": bent, "pull": k * x}, 0.01).A[0].tolist() == [0, 1, -1]


def test_a_discrete_plant_and_an_attitude_are_refused():
    plant, angle, _ = pendulum()
    with pytest.raises(ModelError, match="this one is discrete; give it the continuous plant"):
        jump_model(plant.discretise("euler", dt=0.01), {"gravity": sin(angle)}, 0.01)
    body = Plant("body")
    q, rate = body.attitude("q"), body.input("rate", size=3)
    body.dynamics({q: rate})
    with pytest.raises(ModelError, match="an attitude is not affine"):
        jump_model(body, {}, 0.01)


def test_refusals_of_the_estimator():
    model = made()
    with pytest.raises(ModelError, match="a is 'both'; take one of 'jacobian', 'identity', 'online'"):
        jump_matrix_estimator(model, "both", initial_variance=1.0)
    with pytest.raises(ModelError, match="covariance_transition has shape"):
        jump_matrix_estimator(model, covariance_transition=np.eye(2), initial_variance=1.0)
    with pytest.raises(ModelError, match="the gain has shape .*; give one row for each of the 1 inputs"):
        model.closed_transition([1.0, 2.0])


# -- for simulation only ----------------------------------------------------------------------------------------------


def test_an_online_gain_is_not_exported(tmp_path):
    block = jump_matrix_estimator(made(), "online", initial_variance=1.0)
    with pytest.raises(
        ModelError, match="it is for simulation only and is not exported: its online gain needs the true"
    ):
        export(block, tmp_path)
    assert not list(tmp_path.iterdir())


def test_the_command_line_refuses_it_too(plantc, tmp_path):
    model = tmp_path / "model.py"
    model.write_text(
        "from plantc.examples.jump_systems import spring\n"
        "from plantc import jump_matrix_estimator\n"
        "estimator = jump_matrix_estimator(spring().model, 'online', initial_variance=1.0)\n"
    )
    said = plantc("export", model, "--out", tmp_path / "out")
    assert said.status == 2
    assert "for simulation only" in said.summary
    assert not (tmp_path / "out" / "spring_jump_estimator").exists()
