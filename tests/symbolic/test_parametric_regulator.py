"""Pi(p), Gamma(p), u*(p) as expressions agree with the numeric solution at other parameters, and pivots say when not."""

import casadi as ca
import numpy as np
import pytest
from plantc.symbolic import cos, sin
from plantc.symbolic.elimination import Elimination, Value, values_of
from plantc.symbolic.exosystems import compose, constant, harmonic, polynomial
from plantc.symbolic.parametric_regulator import parametric_francis
from plantc.symbolic.regulator_equations import RegulatorError, francis

from plantc import ModelError, Plant, linearise, trim

NOMINAL = {"mass": 1.0, "thrust": 54.2e-6, "drag": 1.1e-6, "reach": 0.24, "ixx": 8.1e-3, "iyy": 8.1e-3, "izz": 14.2e-3}
OTHER = {"mass": 1.4, "thrust": 61e-6, "drag": 0.9e-6, "reach": 0.2, "ixx": 7e-3, "iyy": 9.3e-3, "izz": 11e-3}


def quadrotor():
    """The quadrotor of section 7 with its numbers as parameters."""
    plant = Plant("quadrotor")
    names = ("x", "vx", "y", "vy", "z", "vz", "roll", "p", "pitch", "q", "yaw", "r")
    x, vx, y, vy, z, vz, roll, p, pitch, q, yaw, r = (plant.state(name, range=(-1e3, 1e3)) for name in names)
    u = [plant.input(f"u{k}", range=(0, 1e3)) for k in (1, 2, 3, 4)]
    m, b, d, reach, ixx, iyy, izz = (plant.parameter(name, value, range=(1e-9, 10)) for name, value in NOMINAL.items())
    squares = [item**2 for item in u]
    lift = b * (squares[0] + squares[1] + squares[2] + squares[3]) / m
    turning = u[0] - u[1] + u[2] - u[3]
    plant.dynamics(
        {
            x: vx, y: vy, z: vz, roll: p, pitch: q, yaw: r,
            vx: (sin(yaw) * sin(roll) + cos(yaw) * sin(pitch) * cos(roll)) * lift,
            vy: (-cos(yaw) * sin(roll) + sin(yaw) * sin(pitch) * cos(roll)) * lift,
            vz: -9.81 + cos(pitch) * cos(roll) * lift,
            p: q * r * (iyy - izz) / ixx - 104e-6 / ixx * q * turning
            + reach * b * (squares[3] + squares[2] - squares[0] - squares[1]) / ixx,
            q: p * r * (izz - ixx) / iyy + 104e-6 / iyy * p * turning
            + reach * b * (squares[1] + squares[2] - squares[0] - squares[3]) / iyy,
            r: p * q * (ixx - iyy) / izz + d * (squares[0] + squares[2] - squares[1] - squares[3]) / izz,
        }
    )  # fmt: skip
    return plant


OUTPUTS = ("x", "y", "z", "yaw")
chains = compose([polynomial(name, 6) for name in OUTPUTS])


@pytest.fixture(scope="module")
def plant():
    return quadrotor()


@pytest.fixture(scope="module")
def hover(plant):
    return trim(plant, hold={name: 0.0 for name in ("x", "y", "z", "yaw")})


@pytest.fixture(scope="module")
def solved(plant, hover):
    return parametric_francis(plant, hover, chains)


def numeric(plant, parameters, exosystem=chains):
    speed = np.sqrt(parameters["mass"] * 9.81 / (4 * parameters["thrust"]))
    point = {**parameters, **{f"u{k}": speed for k in (1, 2, 3, 4)}}
    return speed, francis(linearise(plant, point), exosystem)


@pytest.mark.parametrize("parameters", [NOMINAL, OTHER])
def test_the_quadrotor_at_other_parameters(plant, solved, parameters):
    speed, expected = numeric(plant, parameters)
    found = solved.at(list(parameters.values()))
    np.testing.assert_allclose(found["inputs"].ravel(), speed, rtol=1e-12)  # exactly, by a square root
    assert found["residual"].size == 0
    np.testing.assert_allclose(found["state_map"], expected.state_map, atol=1e-12)
    np.testing.assert_allclose(found["input_map"], expected.input_map, atol=1e-11)
    if parameters is NOMINAL:
        np.testing.assert_allclose(found["pivots"], 1, rtol=1e-9)


def test_the_expressions_are_small(solved):
    whole = ca.vertcat(ca.vec(solved.state_map), ca.vec(solved.input_map), solved.inputs)
    count = ca.Function("all", [solved.parameters], [whole]).n_instructions()
    assert solved.state_map.nnz() == 12 and solved.input_map.nnz() == 16
    assert count < 400, count


def test_a_parameter_that_takes_the_thrust_away_is_seen_in_the_pivots(plant, solved):
    parameters = {**NOMINAL, "thrust": 1e-9 * NOMINAL["thrust"]}
    assert np.min(np.abs(solved.at(list(parameters.values()))["pivots"])) < 1e-3
    good = solved.at(list(OTHER.values()))["pivots"]
    assert np.min(good) > 0.3 and np.max(good) < 3


def cart():
    """A cart with a pendulum's spring: one harmonic reference, one measured disturbance, an input that enters as a cubic."""
    plant = Plant("cart")
    position, speed = plant.state("position"), plant.state("speed")
    force, slope = plant.input("force"), plant.input("slope", range=(-1, 1))
    mass, spring = plant.parameter("mass", 2.0), plant.parameter("spring", 3.0)
    plant.dynamics({position: speed, speed: (force + 0.1 * force**3 - spring * position) / mass - 9.81 * sin(slope)})
    plant.sensor("track", position + 0.05 * speed, variance=1.0)
    return plant


@pytest.mark.parametrize("dt", [None, 0.05])
def test_a_harmonic_reference_a_disturbance_and_newton(dt):
    plant = cart()
    generator = compose([harmonic("track", 2.0), constant("slope")])
    if dt is not None:
        plant, generator = plant.discretise("euler", dt=dt), generator.sampled(dt)
    point = trim(plant, hold={"position": 0.5, "slope": 0.0})
    solved = parametric_francis(plant, point, generator)
    for p in ([2.0, 3.0], [2.6, 3.4], [1.5, 2.0]):
        at = trim(plant, hold={"position": 0.5, "slope": 0.0, "mass": p[0], "spring": p[1]})
        expected = francis(linearise(plant, at), generator)
        found = solved.at(p)
        np.testing.assert_allclose(found["inputs"].ravel(), at.u, atol=1e-9)
        assert np.max(np.abs(found["residual"])) < 1e-9
        np.testing.assert_allclose(found["state_map"], expected.state_map, atol=1e-9)
        np.testing.assert_allclose(found["input_map"], expected.input_map, atol=1e-8)
    far = solved.at([2.0, 4000.0])  # what Newton's steps leave is told
    assert np.max(np.abs(far["residual"])) > 1e-6


def test_elimination_on_random_sparse_matrices():
    rng = np.random.default_rng(5)
    for size in (1, 4, 9):
        p = ca.SX.sym("p", size)
        mask = (rng.uniform(size=(size, size)) < 0.4) | np.eye(size, dtype=bool)
        numbers = rng.normal(size=(size, size)) * mask
        symbolic = ca.sparsify(ca.SX(ca.sparsify(ca.DM(numbers))) + ca.diag(p))
        nominal = rng.normal(size=size)
        factors = Elimination(values_of(symbolic, p, nominal), "it")
        right = rng.normal(size=size)
        found = factors.solve({i: Value(ca.SX(item), item) for i, item in enumerate(right)})
        expression = ca.vertcat(*[found[j].expression for j in range(size)])
        for at in (nominal, nominal + 0.1 * rng.normal(size=size)):
            value = np.asarray(ca.Function("f", [p], [expression])(at)).ravel()
            np.testing.assert_allclose((numbers + np.diag(at)) @ value, right, atol=1e-8)
        assert [found[j].number for j in range(size)] == pytest.approx(
            np.asarray(ca.Function("f", [p], [expression])(nominal)).ravel(), rel=1e-9
        )
    with pytest.raises(ModelError, match=r"singular at the nominal parameters \(1 of 2 pivots found\)"):
        Elimination(values_of(ca.SX([[1, 2], [2, 4]]), p, nominal), "it")


def test_sentences(plant, hover):
    with pytest.raises(ModelError, match=r"4 input\(s\) act on 3 reference\(s\); symbolic equations need as many"):
        parametric_francis(plant, hover, compose([constant(name) for name in OUTPUTS[:3]]))
    with pytest.raises(ModelError, match="the point is no equilibrium"):
        parametric_francis(plant, {**hover.states, **hover.inputs, "u1": 200.0}, chains)
    with pytest.raises(ModelError, match=r"3 free input\(s\) are to hold the set point in 4 equation\(s\)"):
        parametric_francis(plant, hover, chains, free=["u1", "u2", "u3"])
    with pytest.raises(RegulatorError, match="no solution"):
        parametric_francis(cart(), trim(cart(), hold={"position": 0, "slope": 0}), polynomial("speed", 1))
