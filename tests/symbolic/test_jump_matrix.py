"""The jump matrix technique: what it makes of a plant, what it refuses, and the edges of its estimators."""

import copy
from dataclasses import replace

import casadi as ca
import numpy as np
import pytest
from plantc.examples import jump_systems
from plantc.simulation import Start, closed_loop, replay
from plantc.symbolic import ModelError, Plant, Status, sin
from plantc.symbolic.jump_matrix import jump_matrix_estimator, jump_model, jump_simulation
from plantc.symbolic.program import unpack_symmetric
from plantc.symbolic.simulated import simulated_plant
from scipy.integrate import solve_ivp

from plantc import NativeView, cross_check, emit, export, extended_kalman_filter


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


def test_an_input_inside_a_nonlinearity_has_one_step_of_dead_time_and_in_the_one_step_map_none():
    plant, _, _ = pendulum(rate=lambda angle, rate, torque, w: -0.2 * rate + sin(torque) + w)
    model = jump_model(plant, {"push": sin(plant.inputs[0])}, 0.01)
    moved = [0.0, 0.0, 0.0]
    moved = evaluated(model, model.plant.dynamics_expression(), moved, [1.0], [0.0]).ravel()
    assert moved.tolist() == [0, 0, np.sin(1.0)]
    moved = evaluated(model, model.plant.dynamics_expression(), moved, [1.0], [0.0]).ravel()
    one = model.one_step
    at_once = ca.Function("one", [one.x, one.u], [one.without_noise(one.dynamics_expression())])([0, 0], [1])
    assert moved[:2] == pytest.approx(np.array(at_once).ravel(), rel=1e-12)
    assert moved[1] == pytest.approx(0.01 * np.sin(1.0), rel=0.01)


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
    assert cross_check(jump_matrix_estimator(model, initial_variance=0.1), steps=20).passed


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
    says("the nonlinearities are given as list; give a dictionary", named=lambda a, r: [sin(a)])
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
    says("order is 'angle', of type str; give a list of states", order="angle")
    says("None stands where a symbol of the plant or its name is needed", order=[None])
    says("units is ['m'], of type list; give a dictionary", units=["m"])
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
    with pytest.raises(ModelError, match="jump_model: the plant is None, of type NoneType; give a continuous Plant"):
        jump_model(None, {}, 0.01)
    with pytest.raises(ModelError, match="covariance_transition is 'Phi'; give a matrix of numbers"):
        jump_matrix_estimator(model, covariance_transition="Phi", initial_variance=1.0)
    with pytest.raises(ModelError, match="the gain is 'a'; give a matrix of numbers"):
        model.closed_transition("a")
    with pytest.raises(ModelError, match="a is 'both'; take one of 'jacobian', 'identity', 'online'"):
        jump_matrix_estimator(model, "both", initial_variance=1.0)
    with pytest.raises(ModelError, match="covariance_transition has shape"):
        jump_matrix_estimator(model, covariance_transition=np.eye(2), initial_variance=1.0)
    for make in (jump_simulation, lambda plant: jump_matrix_estimator(plant, initial_variance=1.0)):
        with pytest.raises(ModelError, match="a Plant is given where a jump model is needed; give what jump_model"):
            make(model.plant)
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


# -- the edges of section 10, on the compiled C -----------------------------------------------------------------------


class Compiled:
    """A filter in compiled C, with its memory, to be called like an object."""

    def __init__(self, block, precision="double", **params):
        self.view = NativeView(block, precision)
        self.params = self.view.params(**params)
        self.memory = self.view.init(self.params)

    def __call__(self, entry, **inputs):
        answer = self.view.call(entry, self.memory, self.view.inputs(entry, inputs), self.params)
        self.memory, self.outputs = answer.memory, answer.outputs
        return answer.status

    def set(self, **values):
        for name, value in values.items():
            self.memory[name] = value

    def x(self, *names):
        return np.array([float(self.memory[name]) for name in names])

    def P(self):  # noqa: N802
        return unpack_symmetric(np.array(self.memory["covariance"], dtype=float).ravel(), 3)


def kink(filter_, names, x, **inputs):
    """Return the slope of the third state by the first that the covariance sees at x: P31 / P11 after a predict."""
    filter_.set(**dict(zip(names, x, strict=True)))
    filter_.memory["covariance"] = np.eye(3)[np.triu_indices(3)]
    assert filter_("predict", **inputs) == Status.OK
    return filter_.P()[2, 0] / filter_.P()[0, 0]


@pytest.mark.parametrize("precision", ["double", "float"])
def test_slopes_at_a_kink_and_at_the_numbers_beside_it(precision):
    """Section 10, kinks: half the slope at |a| = 1/m, 1.5 at |x1| = 1 of the saturated cubic; beside it the slope of the side."""
    kind = np.float64 if precision == "double" else np.float32
    names = ("x1", "x2", "amplified")
    relay = Compiled(jump_matrix_estimator(jump_systems.relay().model, initial_variance=1.0), precision, slope=8.0)
    for at, outside, inside in ((0.875, 0.0, 2.0), (1.125, 2.0, 0.0)):
        here = kind(at)
        assert kink(relay, names, (here, 0, 0)) == pytest.approx(-4.0, rel=1e-6)
        assert kink(relay, names, (np.nextafter(here, kind(outside)), 0, 0)) == 0.0
        assert kink(relay, names, (np.nextafter(here, kind(inside)), 0, 0)) == pytest.approx(-8.0, rel=1e-6)
    spring = Compiled(jump_matrix_estimator(jump_systems.saturated_spring().model, initial_variance=1.0), precision)
    names = ("x1", "x2", "force")
    for side in (1.0, -1.0):
        here = kind(side)
        assert kink(spring, names, (here, 0, 0), u=0.0) == pytest.approx(1.5, rel=1e-6)
        assert kink(spring, names, (np.nextafter(here, kind(0)), 0, 0), u=0.0) == pytest.approx(3.0, rel=1e-6)
        assert kink(spring, names, (np.nextafter(here, kind(2 * side)), 0, 0), u=0.0) == 0.0


def test_a_known_start_of_an_online_gain():
    """Section 10, x == xh: a is zero for the nonlinearity and one for the rest; nothing is NaN."""
    system = jump_systems.spring()
    filter_ = Compiled(jump_matrix_estimator(system.model, "online", initial_variance=1.0, around=system.start))
    assert filter_("predict", true_cubic=3.0) == Status.OK
    Phi, Psi = system.model.Phi, system.model.Psi
    expected = np.diag([1, 1, 0]) @ (Phi @ Phi.T + Psi @ Psi.T) @ np.diag([1, 1, 0])
    np.testing.assert_allclose(filter_.P(), expected, rtol=1e-14, atol=0)
    assert not np.any(filter_.P()[2])
    # from then on the differences are there
    assert filter_("predict", true_cubic=2.9) == Status.OK
    assert np.all(np.isfinite(filter_.P()))
    assert filter_.memory["true_cubic"] == 2.9


def test_a_relay_that_is_saturated_for_a_long_time():
    """Section 10: DJ = 0, K of the nonlinearity is zero; K stays finite, nothing is refused or held at a floor."""
    system = jump_systems.modified_relay()
    filter_ = Compiled(jump_matrix_estimator(system.model, initial_variance=1.0, around={"x1": -400.0, "x2": -400.0}))
    truth = np.array([-400.0, -400.0, 1.0])
    for _ in range(3000):
        truth = system.model.Phi @ truth
        assert filter_("step", has_z=True, z=truth[0]) == Status.OK
        assert not np.any(filter_.P()[2])
    assert np.all(np.isfinite(filter_.P()))
    np.testing.assert_allclose(filter_.x("x1", "x2", "amplified"), truth, rtol=1e-9)


def test_the_saturating_loop_settles_on_the_saturated_branch():
    """Section 5.5: x1 = 0.99995 after 10 s, where f' = 0 and K is below 1e-9."""
    system = jump_systems.saturating_amplifier()
    estimator = jump_matrix_estimator(system.model, initial_variance=1.0, around=system.start)
    loop = closed_loop(system.plant, jump_systems.controller(system, estimator), system.start)
    quiet = {"w": 0.0, "z_noise": 0.0}
    history = replay(loop, 0, steps=2000, start=Start(known=True), std=quiet)
    assert history.truth[999, 0] == pytest.approx(0.99995, abs=5e-6)
    gain = np.abs(history.spread[:, :3]) / 0.01
    assert gain[999, 0] < 1e-9
    assert np.all(gain[1999] < 1e-9)  # that of x3 dies out as slowly as x1 settles
    assert np.max(gain[:, 0]) > 1e-3
    assert not np.any(gain[999:, 1])


def test_without_noise_and_initial_variance_the_estimate_is_the_simulation():
    """Section 10, sigma_w = 0 and P_0 = 0: M = 0, K = 0, whatever the readings are; bit for bit."""
    system = jump_systems.spring()
    filter_ = Compiled(jump_matrix_estimator(system.model, initial_variance=0.0, around=system.start), variance_w=0.0)
    truth = Compiled(jump_simulation(system.model, around=system.start))
    names = ("x1", "x2", "cubic")
    for k in range(200):
        assert truth("step") == Status.OK
        assert filter_("step", has_z=True, z=float(np.sin(k))) == Status.OK
        assert not np.any(filter_.P())
        assert filter_.x(*names).tobytes() == truth.x(*names).tobytes()


def exact_sensor(p0, **options):
    """The spring with a reading whose noise may be zero: it stands in the expression."""
    plant = Plant("exactly_read")
    x1, x2 = plant.state("x1", range=(-50, 50)), plant.state("x2", range=(-500, 500))
    cubic = x1**3
    plant.dynamics({x1: x2, x2: -2 * x1 - 0.1 * x2 - cubic + plant.noise("w", density=0.01)})
    plant.sensor("z", x1 + plant.noise("v", variance=0.0), range=(-100, 100))
    model = jump_model(plant, {"cubic": cubic}, 0.01)
    return jump_matrix_estimator(model, initial_variance=p0, around={x1: 1.5}, **options)


def test_a_reading_without_noise():
    """Section 10, sigma_v = 0: K1 = 1; where M_11 = 0 too the reading is skipped, which is K = 0, and the status says so.

    P is singular after each reading, since the cubic is known with x1: that is what the factored form is for.
    """
    filter_ = Compiled(exact_sensor(1.0, form="ud"))
    for k in range(20):
        assert filter_("step", has_z=True, z=1.25 + 0.01 * k) in (Status.OK, Status.CLAMPED)
        assert filter_.x("x1")[0] == pytest.approx(1.25 + 0.01 * k, rel=1e-15)
    certain = Compiled(exact_sensor(0.0), variance_w=0.0)
    alone = Compiled(exact_sensor(0.0), variance_w=0.0)
    assert alone("predict") == Status.OK
    assert certain("step", has_z=True, z=1.25) == Status.SKIPPED
    assert certain.outputs["status_z"] == Status.NOT_POSITIVE
    assert certain.x("x1", "x2", "cubic").tobytes() == alone.x("x1", "x2", "cubic").tobytes()
    assert certain("update_z", z=1.25) == Status.NOT_POSITIVE  # asked for by itself it is refused
    # in the other forms rounding may make the singular P indefinite: then the reading is skipped, and that is said
    assert Compiled(exact_sensor(1.0))("step", has_z=True, z=1.25) == Status.SKIPPED


def test_a_sensor_that_is_declared_exact_is_refused():
    """sigma_v = 0 as a number: a sentence at the declaration."""
    plant = Plant("exact")
    x = plant.state("x")
    with pytest.raises(ModelError, match="gives a variance outside 1e-12 .. 1e\\+06"):
        plant.sensor("z", x, std=0.0)


def simulated(model, around, steps):
    """Return x1 .. of the compiled simulation without noise until a call is refused, and the status of that."""
    truth = Compiled(jump_simulation(model, around=around))
    names = [state.signal.name for state in model.plant.states]
    rows = [truth.x(*names)]
    for _ in range(steps):
        status = truth("step")
        if status < 0:
            return np.array(rows), status
        rows.append(truth.x(*names))
    return np.array(rows), Status.OK


def test_divergence_is_refused_and_capped_nowhere():
    """Section 10: held, van der Pol's oscillator is stable for |x1| < sqrt(1 + 2 / (eps T)) = 10.05 at eps = 2; T/10 mends it."""
    model = jump_systems.van_der_pol(2.0).model
    rows, status = simulated(model, {"x1": 9.0}, 1000)
    assert status == Status.OK
    assert np.max(np.abs(rows[:, 0])) == 9.0
    rows, status = simulated(model, {"x1": 30.0}, 1000)
    assert status == Status.OVERFLOW
    plant = model.continuous
    x1, x2 = (state.symbol for state in plant.states)
    shorter = jump_model(plant, {"braking": x1**2 * x2}, 0.001)
    rows, status = simulated(shorter, {"x1": 30.0}, 1000)
    assert status == Status.OK
    assert np.max(np.abs(rows[:, 0])) == 30.0
    # the escape of the soft spring is physics: a shorter step does not mend it
    soft = jump_systems.spring(h=-0.5).model
    x1 = soft.continuous.states[0].symbol
    assert simulated(soft, {"x1": 2.1}, 3000)[1] == Status.OVERFLOW
    assert simulated(jump_model(soft.continuous, {"cubic": x1**3}, 0.001), {"x1": 2.1}, 30000)[1] == Status.OVERFLOW


def test_the_clamp_takes_damping_away():
    """Section 10: by (T/2) d(force)/dx, so that the hard spring excites itself from about amplitude 5 on, at T = 0.01."""
    model = jump_systems.spring().model

    def energy(rows):
        return rows[:, 1] ** 2 / 2 + rows[:, 0] ** 2 + rows[:, 0] ** 4 / 4

    for amplitude, grows in ((4.0, False), (6.0, True)):
        rows, status = simulated(model, {"x1": amplitude}, 500)
        assert status == Status.OK
        assert bool(energy(rows)[-1] > energy(rows)[0]) is grows
    # the order of the method: 0.184, 0.0884, 0.0434 at 10 s for T = 0.02, 0.01, 0.005 (section 2)
    x1 = model.continuous.states[0].symbol
    exact = solve_ivp(
        lambda t, s: [s[1], -2 * s[0] - 0.1 * s[1] - s[0] ** 3], (0, 10), [1.5, 0], rtol=1e-11, atol=1e-12
    )
    for T, error in ((0.02, 0.184), (0.01, 0.0884), (0.005, 0.0434)):
        rows, _ = simulated(jump_model(model.continuous, {"cubic": x1**3}, T), {"x1": 1.5}, round(10 / T))
        assert abs(rows[-1, 0] - exact.y[0, -1]) == pytest.approx(error, rel=5e-3)


def textbook(Phi, Psi, H, Q, R, x, P, readings):
    """The Kalman filter of a linear plant, batch form."""
    for z in readings:
        x, P = Phi @ x, Phi @ P @ Phi.T + Psi @ Q @ Psi.T
        K = P @ H / (H @ P @ H + R)
        x, P = x + K * (z - H @ x), (np.eye(len(x)) - np.outer(K, H)) @ P
    return x, P


def test_without_a_nonlinearity_it_is_the_kalman_filter():
    """Section 10, d = 0; and with one that has no weight, h = 0, the filter of the two states."""
    readings = np.sin(0.1 * np.arange(50))
    linear = jump_systems.linear_amplifier().model
    filter_ = Compiled(jump_matrix_estimator(linear, initial_variance=1.0))
    for z in readings:
        assert filter_("step", has_z=True, z=z, u=0.0) == Status.OK
    args = (linear.Phi, linear.Psi, np.array([1.0, 0.0]), np.array([[0.1]]), 0.01)
    x, P = textbook(*args, np.zeros(2), np.eye(2), readings)
    np.testing.assert_allclose(filter_.x("x1", "x2"), x, rtol=1e-12)
    np.testing.assert_allclose(np.array(filter_.memory["covariance"]).ravel(), P[np.triu_indices(2)], rtol=1e-10)
    spring = jump_systems.spring(h=0.0)
    assert spring.model.Phi[0, 2] == spring.model.Phi[1, 2] == 0.0
    filter_ = Compiled(jump_matrix_estimator(spring.model, initial_variance=1.0, around=spring.start))
    for z in readings:
        assert filter_("step", has_z=True, z=z) == Status.OK
    args = (spring.model.Phi[:2, :2], spring.model.Psi[:2], np.array([1.0, 0.0]), np.array([[1.0]]), 4.0)
    x, P = textbook(*args, np.array([1.5, 0.0]), np.eye(2), readings)
    np.testing.assert_allclose(filter_.x("x1", "x2"), x, rtol=1e-12)
    np.testing.assert_allclose(filter_.P()[:2, :2], P, rtol=1e-10)


def test_no_noise_at_all_and_an_input_that_does_nothing():
    """Section 10: q = 0, and a zero column of B."""
    plant = Plant("quiet")
    x, idle = plant.state("x", range=(-10, 10)), plant.input("idle", range=(-1, 1))
    plant.dynamics({x: -x - x**3})
    plant.sensor("z", x, std=0.1)
    model = jump_model(plant, {"cubic": x**3}, 0.01)
    assert model.Psi.shape == (2, 0)
    assert np.array_equal(model.Gam, [[0], [0]])
    assert idle.signal.name == "idle"
    assert cross_check(jump_matrix_estimator(model, initial_variance=0.1), steps=20).passed
    assert cross_check(jump_simulation(model), steps=20).passed


# -- the cross-check ---------------------------------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.parametrize("name", list(jump_systems.SYSTEMS))
def test_every_estimator_is_cross_checked(name):
    """In single precision beside double, the program in Python and NumPy."""
    system = jump_systems.SYSTEMS[name]()
    check = cross_check(
        jump_matrix_estimator(system.model, initial_variance=1.0, around=system.start), "float", steps=40
    )
    assert check.passed, [item for item in check.results if not item.passed]


@pytest.mark.slow
def test_the_other_blocks_are_cross_checked():
    """Simulations; the identity; a transition that is given; the other forms of the covariance."""
    spring, relay, loop = jump_systems.spring(), jump_systems.relay(), jump_systems.saturating_amplifier()
    closed = loop.model.closed_transition([loop.gain])
    common = {"initial_variance": 1.0, "around": spring.start}
    blocks = [
        jump_simulation(relay.model),
        jump_matrix_estimator(relay.model, "identity", initial_variance=1.0),
        jump_matrix_estimator(loop.model, initial_variance=1.0, covariance_transition=closed),
        jump_matrix_estimator(spring.model, "identity", form="ud", **common),
        jump_matrix_estimator(spring.model, form="conventional", **common),
    ]
    for block in blocks:
        check = cross_check(block, steps=20)
        assert check.passed, (block.name, [item for item in check.results if not item.passed])


def failed(block):
    return {item.name for item in cross_check(block, steps=20).results if not item.passed}


@pytest.mark.slow
def test_planted_faults_are_caught():
    """A row of DJ that is wrong; a clamp's row of Phi that is none of the unit matrix; an entry of Phi that is slightly off."""
    model = jump_systems.spring().model
    common = {"initial_variance": 1.0, "around": {"x1": 1.5}}
    given = {"covariance_transition": model.Phi, **common}
    assert not failed(jump_matrix_estimator(model, **given))
    row = ca.SX(model.DJ)
    row[2, 0] = 2 * model.plant.x[0] ** 2  # 2 x1^2 for 3 x1^2
    assert failed(jump_matrix_estimator(replace(model, DJ=row), **given))
    wrong = model.Phi.copy()
    wrong[2, 0] = 1e-3
    assert failed(jump_matrix_estimator(replace(model, Phi=wrong), "identity", **common))
    wrong = model.Phi.copy()
    wrong[0, 2] *= 1 + 1e-6
    plant = copy.copy(model.plant)
    plant._dynamics = dict(plant._dynamics)
    before = ca.SX(ca.DM(wrong)) @ plant.x
    plant._dynamics["x1"] = before[0]
    assert failed(jump_matrix_estimator(replace(model, plant=plant), **common))


# -- beside an extended Kalman filter ---------------------------------------------------------------------------------


def test_the_map_of_the_states_alone_moves_as_the_jump_model_does():
    model = jump_systems.van_der_pol().model
    both, alone = (
        Compiled(jump_simulation(model, around={"x1": 5.0})),
        Compiled(simulated_plant(model.one_step, around={"x1": 5.0})),
    )
    for k in range(100):
        assert both("step", w=np.sin(k)) == alone("step", w=np.sin(k)) == Status.OK
        np.testing.assert_allclose(both.x("x1", "x2"), alone.x("x1", "x2"), rtol=1e-12)


def test_the_jacobian_estimator_is_an_extended_kalman_filter():
    """Section 8: beside that of the map of the states alone it differs to second order in the correction, and only so."""
    model = jump_systems.spring().model
    names = ("x1", "x2")
    slope = np.array([[1, 0], [0, 1], [3 * 1.5**2, 0]])
    by_jump = Compiled(jump_matrix_estimator(model, initial_variance=1.0))
    plain = Compiled(extended_kalman_filter(model.one_step, initial_variance={"x1": 1.0, "x2": 1.0}))

    def difference(correction):
        """Return the difference of both estimates a step after a reading that is off by so much, from the same estimate."""
        by_jump.set(x1=1.5, x2=0.0, cubic=1.5**3, covariance=(slope @ slope.T)[np.triu_indices(3)])
        plain.set(x1=1.5, x2=0.0, covariance=np.eye(2)[np.triu_indices(2)])
        ends = []
        for filter_ in (by_jump, plain):
            assert filter_("predict") == Status.OK
            assert filter_("update_z", z=filter_.x("x1")[0] + correction) == Status.OK
            assert filter_("predict") == Status.OK
            ends.append(filter_.x(*names))
        return ends[1] - ends[0]

    assert np.max(np.abs(difference(0.0))) < 1e-15
    small, twice = difference(0.1), difference(0.2)
    np.testing.assert_allclose(twice / small, 4.0, rtol=0.02)
    # phi(s+) less its tangent at s-, over the step: 3 x1 d^2 with d = K1 0.1, by Phi_sn
    by_jump.set(x1=1.5, x2=0.0, cubic=1.5**3, covariance=(slope @ slope.T)[np.triu_indices(3)])
    by_jump("predict")
    gain = by_jump.P()[0, 0] / (by_jump.P()[0, 0] + 4.0)
    np.testing.assert_allclose(small, model.Phi[:2, 2] * 3 * 1.5 * (0.1 * gain) ** 2, rtol=0.02)


def test_noise_per_step_may_be_added():
    """As to any discrete plant; the filter adds it behind a, and so does the oracle."""
    model = made()
    model.plant.step_noise({"angle": 1e-6, "gravity": 1e-4})
    assert not model.continuous.step_variances
    assert list(model.one_step.step_variances) == ["angle"]
    block = jump_matrix_estimator(model, "identity", initial_variance=0.0)
    filter_ = Compiled(block)
    assert filter_("predict", torque=0.0) == Status.OK
    expected = model.Psi @ model.Psi.T + np.diag([1e-6, 0, 1e-4])
    np.testing.assert_allclose(filter_.P(), expected, rtol=1e-14)
    check = cross_check(block, steps=20)
    assert check.passed, [item for item in check.results if not item.passed]


@pytest.mark.slow
def test_an_estimator_without_any_floor_is_exported(tmp_path):
    """A variance of zero is no fault; that there is nothing below it to be raised is no statement that nothing reaches."""
    system = jump_systems.spring()
    block = jump_matrix_estimator(system.model, initial_variance=0.0, around=system.start)
    done = export(block, tmp_path, precision="float", steps=40)
    assert "floor_i" not in done.files["src/spring_jump_estimator.c"]
    floored = jump_matrix_estimator(system.model, initial_variance=1.0, around=system.start)
    assert "floor_i" in emit(floored, "float").source
