"""What has a jump or a kink is not affine, though its derivative is constant: seen by every user of the test."""

import casadi as ca
import numpy as np
import pytest
from plantc.reference.jump_matrix import JumpMap
from plantc.symbolic import if_else
from plantc.symbolic.affinity import kink_in
from plantc.symbolic.piecewise import relay
from plantc.symbolic.sliding_mode import boundary_layer

from plantc import ModelError, Plant, jump_model, kalman_filter, sliding_mode, steady_state_kalman_filter

JUMPS = {
    "relay": relay,
    "sign": ca.sign,
    "branch": lambda x: if_else(x > 1, -5, 0),
    "branch that turns": lambda x: if_else(x > 0, x, 2 * x),
    "floor": ca.floor,
    "limit": lambda x: ca.fmin(ca.sign(x), 0.5),
    "magnitude": ca.fabs,
}


@pytest.mark.parametrize("jump", JUMPS.values(), ids=JUMPS)
def test_an_operation_that_jumps_is_found(jump):
    x, p = ca.SX.sym("x"), ca.SX.sym("p")
    assert kink_in(3 * x + jump(x), x)
    assert not kink_in(3 * x + jump(p), x)
    assert not kink_in(p * x + 2, x)


def test_a_condition_on_something_else_lets_through_what_is_affine():
    x, p = ca.SX.sym("x"), ca.SX.sym("p")
    assert kink_in(if_else(p > 0, 3 * x, -x), x) == ""
    assert kink_in(if_else(p > 0, 3 * x, -x), p) == "a comparison"


def test_whole_turns_of_an_angle_may_be_left_out_and_nothing_else():
    x = ca.SX.sym("x")
    wrapped = x - 2 * ca.pi * ca.floor(x / (2 * ca.pi) + 0.5)
    assert kink_in(wrapped, x) == "floor"
    assert kink_in(wrapped, x, but_turns=True) == ""
    assert kink_in(wrapped + ca.floor(x / (2 * ca.pi) + 0.5), x, but_turns=True) == "floor"
    assert kink_in(x - 2 * ca.floor(x), x, but_turns=True) == "floor"
    assert kink_in(ca.floor(x), x, but_turns=True) == "floor"


def oscillator(more):
    plant = Plant("oscillator")
    x = plant.state("x", range=(-10, 10))
    v = plant.state("v", range=(-10, 10))
    u = plant.input("u", range=(-5, 5))
    plant.dynamics({x: v, v: more(x, u) - x**3 + u + plant.noise("w", density=1e-3)})
    plant.sensor("z", x, variance=0.1)
    return plant, x**3


@pytest.mark.parametrize("jump", JUMPS.values(), ids=JUMPS)
def test_the_jump_matrix_technique_refuses_what_was_not_named(jump):
    plant, cube = oscillator(lambda x, u: -5 * jump(x))
    with pytest.raises(ModelError, match="'v' are not affine besides n: .*name that nonlinear subexpression too"):
        jump_model(plant, {"n": cube}, 0.01)
    plant, cube = oscillator(lambda x, u: -5 * jump(u))
    with pytest.raises(ModelError, match="'v' are not affine besides n"):
        jump_model(plant, {"n": cube}, 0.01)


def test_named_it_is_taken():
    plant, cube = oscillator(lambda x, u: -5 * relay(x))
    model = jump_model(plant, {"n": cube, "push": relay(plant.states[0].symbol)}, 0.01)
    np.testing.assert_array_equal(model.A[1], [0.0, 0.0, -1.0, -5.0])


def test_the_oracle_sees_it_by_itself():
    def rates(x, u, p, w):
        return (np.array([x[1], -5 * np.sign(np.real(x[0])) + u[0] + w[0]]),)

    with pytest.raises(ValueError, match="the rates are not affine"):
        JumpMap(rates, lambda x, u, p, w: (x,), (2, 1, 1), np.zeros(0), 0.01)
    smooth = JumpMap(
        lambda x, u, p, w: (np.array([x[1], u[0] + w[0] + 3.0]),), lambda x, u, p, w: (x,), (2, 1, 1), np.zeros(0), 0.01
    )
    assert smooth.Phi[0, 1] == pytest.approx(0.01)


@pytest.mark.parametrize("jump", JUMPS.values(), ids=JUMPS)
@pytest.mark.parametrize("method", ["exact", "tustin"])
def test_what_is_for_linear_plants_refuses_it(method, jump):
    plant = Plant("brake")
    x, u = plant.state("x", range=(-10, 10)), plant.input("u", range=(-1, 1))
    plant.dynamics({x: -5 * jump(x) - x + u + plant.noise("w", density=0.1)})
    plant.sensor("z", x, variance=0.1)
    with pytest.raises(ModelError, match="for linear plants, and these dynamics are not|not linear"):
        kalman_filter(plant.discretise(method, dt=0.1), initial_variance={x: 1.0})
    with pytest.raises(ModelError, match="linear"):
        kalman_filter(plant.discretise("euler", dt=0.1), initial_variance={x: 1.0})
    with pytest.raises(ModelError, match="linear"):
        steady_state_kalman_filter(plant.discretise("euler", dt=0.1))


@pytest.mark.parametrize("jump", JUMPS.values(), ids=JUMPS)
def test_a_sliding_mode_law_refuses_a_command_that_jumps(jump):
    plant = Plant("cart")
    x, v = plant.state("x", range=(-10, 10)), plant.state("v", range=(-10, 10))
    u = plant.input("u", range=(-5, 5))
    plant.dynamics({x: v, v: u + 5 * jump(u)})
    plant.sensor("z", x, variance=0.1)
    with pytest.raises(ModelError, match="is not affine in 'u'"):
        sliding_mode(plant, {x: u}, surface=2.0, gain=0.5, switching=boundary_layer(0.1))
