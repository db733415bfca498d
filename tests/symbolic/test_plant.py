"""Every mistake of a user is caught where it is made, by a sentence that names the signal and the mend."""

import casadi as ca
import control
import numpy as np
import pytest
from plantc.symbolic import ModelError, Plant, Symbol, sin, vertcat
from plantc.symbolic.estimators import extended_kalman_filter


@pytest.fixture
def cart():
    plant = Plant("cart")
    plant.pos = plant.state("pos", unit="m")
    plant.vel = plant.state("vel", unit="m/s")
    return plant


def refuse(match):
    return pytest.raises(ModelError, match=match)


@pytest.fixture
def moving():
    plant = Plant("cart")
    pos, vel = plant.state("pos"), plant.state("vel")
    push = plant.noise("push", density=1.0)
    plant.dynamics({pos: vel, vel: push})
    return plant


def symbol(plant, name):
    return next(state.symbol for state in plant.states if state.signal.name == name)


# -- declarations -----------------------------------------------------------------------------------------------------


def test_a_name_twice():
    plant = Plant("cart")
    plant.state("x")
    for again in (plant.state, plant.input, plant.attitude):
        with refuse(r"cart: the name 'x' is used twice; give this \w+ another"):
            again("x")
    with refuse("the name 'x' is used twice"):
        plant.parameter("x", 1.0)
    with refuse("the name 'x' is used twice"):
        plant.constant("x", 1.0)
    with refuse("the name 'x' is used twice"):
        plant.noise("x", density=1.0)


def test_the_name_of_the_time_step_is_taken():
    with refuse(r"'dt' is the time step's; call this input something else"):
        Plant("cart").input("dt")


@pytest.mark.parametrize("size", [0, -1, 2.0, "3", None])
def test_a_size_that_is_no_positive_integer(size):
    with refuse(r"the state 'x' has size .*; give a positive integer"):
        Plant("cart").state("x", size=size)


def test_an_angle_has_its_own_range():
    with refuse(r"the state 'theta' is an angle, wrapped to -pi .. pi; leave its range out"):
        Plant("cart").state("theta", angle=True, range=(-1, 1))


@pytest.mark.parametrize("dt", [0, -1, float("nan"), float("inf"), "0.1"])
def test_a_time_step_that_is_no_positive_number(dt):
    with refuse("cart: dt is .*; give the seconds per step as a positive number"):
        Plant("cart", dt=dt)


def test_a_default_outside_its_range():
    with refuse(r"the value 5 of parameter 'p' is outside its range 0 .. 1; change the value or the range"):
        Plant("cart").parameter("p", 5, range=(0, 1))


@pytest.mark.parametrize("value", ["a", [[1, 2], [3]], None, object()])
def test_values_that_are_no_numbers(value):
    with refuse("parameter 'p'"):
        Plant("cart").parameter("p", value)
    with refuse("constant 'c'"):
        Plant("cart").constant("c", value)


@pytest.mark.parametrize("value", [float("nan"), float("inf"), [1.0, float("nan")]])
def test_a_constant_that_is_not_finite(value):
    with refuse(r"the constant 'c' is .*; give finite numbers"):
        Plant("cart").constant("c", value)


def test_what_was_refused_leaves_no_trace():
    plant = Plant("cart")
    x = plant.state("x")
    with refuse("outside its range"):
        plant.parameter("p", 5, range=(0, 1))
    with refuse("negative"):
        plant.noise("w", density=-1)
    w = plant.noise("w", density=1.0)
    plant.dynamics({x: plant.parameter("p", 0.5, range=(0, 1)) + w})
    with refuse("negative"):
        plant.sensor("s", x, variance=-1)
    with refuse("enters the dynamics and the sensor 's'"):
        plant.sensor("s", x + w)
    assert plant.sensors == []
    plant.sensor("s", x, variance=1)
    assert [sensor.signal.name for sensor in plant.sensors] == ["s"]


# -- noise ------------------------------------------------------------------------------------------------------------


def test_a_noise_has_just_one_strength():
    plant = Plant("cart")
    with refuse(r"the noise 'w' has 0 strengths; give exactly one of density= .* variance= or std="):
        plant.noise("w")
    with refuse("the noise 'w' has 2 strengths"):
        plant.noise("w", density=1, std=1)


@pytest.mark.parametrize(
    ("value", "sentence"),
    [
        (-1, r"negative \(-1\); give it as zero or more"),
        ([1, -2], r"negative \(-2\)"),
        (float("nan"), "give finite numbers"),
        (float("inf"), "give finite numbers"),
        ([[1, 0], [0, float("nan")]], "give finite numbers"),
        ([1, 2, 3], "has 3 elements; give 1 or 2"),
        (np.ones((2, 3)), r"has shape \(2, 3\); give a 2 x 2 matrix"),
        (np.eye(3), r"has shape \(3, 3\); give a 2 x 2 matrix"),
        ([[1, 2], [2, 1]], r"not positive definite \(smallest eigenvalue -1\); mend the matrix"),
        ([[1, 1], [1, 1]], "not positive definite"),
        ([[1, 0.5], [0.4, 1]], "not symmetric; give a symmetric matrix"),
        ("a", "give numbers"),
        (1e9, "outside 0 .. 1e\\+06; rescale the signal"),
    ],
)
@pytest.mark.parametrize("keyword", ["density", "variance"])
def test_a_noise_that_is_none(keyword, value, sentence):
    with refuse(f"cart: the {keyword} of noise 'w' .*{sentence}"):
        Plant("cart").noise("w", size=2, **{keyword: value})


def test_a_standard_deviation_is_squared_and_never_a_matrix():
    plant = Plant("cart")
    plant.noise("w", size=2, std=[2, 3])
    assert plant.noises[0].strength.tolist() == [[4, 0], [0, 9]]
    with refuse("the std of noise 'v' is a matrix; give variance= instead"):
        plant.noise("v", size=2, std=np.eye(2))


def test_the_bare_keyword_noise_is_not_known():
    plant = Plant("cart")
    x = plant.state("x")
    with pytest.raises(TypeError, match="noise"):
        plant.sensor("s", x, noise=1.0)
    with pytest.raises(TypeError, match="noise"):
        plant.noise("w", noise=1.0)


@pytest.mark.parametrize("keyword", ["variance", "std"])
def test_noise_per_step_on_a_continuous_plant(keyword):
    plant = Plant("cart")
    x, w = plant.state("x"), plant.noise("w", **{keyword: 1.0})
    with refuse(r"the noise 'w' has a variance per step, but the dynamics are continuous; give density= .* step_noise"):
        plant.dynamics({x: w})


def test_a_density_on_a_discrete_plant():
    plant = Plant("cart", dt=0.1)
    x, w = plant.state("x"), plant.noise("w", density=1.0)
    with refuse("the noise 'w' has a density, but the dynamics are per step; give variance= or std="):
        plant.dynamics({x: x + w})


def test_the_right_kinds_are_accepted():
    plant = Plant("cart", dt=0.1)
    x, w = plant.state("x"), plant.noise("w", variance=1.0)
    plant.dynamics({x: x + w})
    assert [noise.signal.name for noise in plant.process_noises] == ["w"]
    plant = Plant("cart")
    x, w = plant.state("x"), plant.noise("w", density=1.0)
    plant.dynamics({x: sin(w)})
    assert [noise.signal.name for noise in plant.process_noises] == ["w"]


def test_noise_in_dynamics_and_sensor(moving):
    with refuse("the noise 'push' enters the dynamics and the sensor 's'; correlated noise .* use two noises"):
        moving.sensor("s", symbol(moving, "pos") + moving.noises[0].symbol)


def test_noise_in_dynamics_and_sensor_in_the_other_order():
    plant = Plant("cart", dt=1.0)
    x, w = plant.state("x"), plant.noise("w", variance=1.0)
    plant.sensor("s", x + w)
    with refuse("enters the dynamics and the sensor 's'"):
        plant.dynamics({x: x + w})


def test_a_density_in_a_sensor(moving):
    v = moving.noise("v", density=1.0)
    with refuse(r"the noise 'v' of the sensor 's' has a density; a reading is a sample, give variance= or std="):
        moving.sensor("s", symbol(moving, "pos") + v)


# -- dynamics ---------------------------------------------------------------------------------------------------------


def test_a_state_without_dynamics(cart):
    with refuse(r"cart: no dynamics for the state\(s\) 'vel'; add them to dynamics\(\{...\}\)"):
        cart.dynamics({cart.pos: cart.vel})


def test_no_dynamics_at_all(cart):
    for use in (cart.dynamics_expression, cart.fingerprint, lambda: cart.discretise("rk4", dt=0.1)):
        with refuse(r"cart: it has no dynamics yet; call cart.dynamics"):
            use()


def test_dynamics_of_the_wrong_size(cart):
    with refuse("the dynamics of 'pos' have 2 elements, 1 are needed"):
        cart.dynamics({cart.pos: [cart.vel, 0], cart.vel: 0})
    with refuse("the dynamics of 'q' have 4 elements, 3 are needed"):
        plant = Plant("body")
        q = plant.attitude("q")
        plant.dynamics({q: q})


def test_dynamics_of_what_is_no_state(cart):
    other = Plant("other").state("pos")
    force = cart.input("force")
    for key in (other, force, "speed"):
        with refuse("dynamics are given for '.*', which is not a state of this plant"):
            cart.dynamics({cart.pos: cart.vel, cart.vel: 0, key: 0})
    for key in (3, cart.pos + 1):
        with refuse("dynamics are given for .*, which is not a state; give states or their names"):
            cart.dynamics({key: 0})


def test_states_may_be_named_by_words(cart):
    cart.dynamics({"pos": cart.vel, "vel": 0})
    assert str(cart.dynamics_expression()) == "[vel, 0]"


def test_a_symbol_of_another_plant(cart):
    stranger = Plant("other").state("drag")
    with refuse(r"the dynamics of 'vel' uses 'drag', a symbol of another plant; declare it on cart"):
        cart.dynamics({cart.pos: cart.vel, cart.vel: -stranger})
    with refuse(r"the sensor 's' uses 'pos', a symbol of another plant"):
        cart.sensor("s", Plant("twin").state("pos"), variance=1)
    with refuse(r"the noise of the sensor 's' uses 'drag', a symbol of another plant"):
        cart.sensor("s", cart.pos, variance=stranger**2)
    with refuse("uses 'free', a symbol of another plant"):
        cart.dynamics({cart.pos: ca.SX.sym("free"), cart.vel: 0})


@pytest.mark.parametrize("bad", [float("nan"), float("inf"), -float("inf")])
def test_numbers_in_expressions_are_finite(cart, bad):
    for expression in (ca.SX(bad), bad * cart.pos, sin(cart.pos) + bad, cart.pos * (cart.vel - bad) ** 2):
        with refuse("the dynamics of 'vel' holds the number (nan|-?inf); every number must be finite"):
            cart.dynamics({cart.pos: cart.vel, cart.vel: expression})
        with refuse("the sensor 's' holds the number"):
            cart.sensor("s", expression, variance=1)
        with refuse("the noise of the sensor 's' holds the number"):
            cart.sensor("s", cart.pos, variance=expression)


def test_a_finite_expression_is_accepted(cart):
    cart.dynamics({cart.pos: 1e30 * cart.vel, cart.vel: sin(cart.pos) / 3})


@pytest.mark.parametrize("value", [None, "v", object(), lambda: 0, ca.MX.sym("m")])
def test_what_is_no_expression(cart, value):
    with refuse("the dynamics of 'vel' is .*; give a CasADi SX expression"):
        cart.dynamics({cart.pos: cart.vel, cart.vel: value})


def test_a_state_after_dynamics(moving):
    with refuse(r"the state 'late' comes after dynamics\(\); declare it before"):
        moving.state("late")
    with refuse("the state 'late' comes after"):
        moving.attitude("late")


# -- sensors ----------------------------------------------------------------------------------------------------------


def test_a_sensor_without_noise(cart):
    with refuse(r"the sensor 's' has no noise; give variance= or std=, or use a noise in its expression"):
        cart.sensor("s", cart.pos)


def test_a_sensor_with_two_noises(cart):
    with refuse(r"the sensor 's' has variance= and std=; give one of them"):
        cart.sensor("s", cart.pos, variance=1, std=1)


def test_a_sensor_of_nothing(cart):
    with refuse("the sensor 's' measures nothing"):
        cart.sensor("s", [], variance=1)


@pytest.mark.parametrize(
    ("variance", "sentence"),
    [
        (0.0, "variance outside 1e-12 .. 1e\\+06; rescale"),
        (-1, "negative"),
        (np.array([[1, 2], [2, 1]]), "not positive definite"),
        ([1, 2, 3], "has 3 elements; give 1 or 2"),
        (lambda z: vertcat(z, 1), r"has shape \(3, 1\); give 1, 2 or 2 x 2 elements"),
        (lambda z: ca.SX(3, 3), r"has shape \(3, 3\)"),
    ],
)
def test_the_noise_of_a_sensor(cart, variance, sentence):
    with refuse(f"the (variance|noise) of the sensor 's' .*{sentence}"):
        cart.sensor("s", [cart.pos, cart.vel], variance=variance)
    with refuse("the std of the sensor 's' has 3 elements; give 1 or 2"):
        cart.sensor("s", [cart.pos, cart.vel], std=vertcat(cart.pos, cart.pos, 1))


def test_what_a_sensor_keeps(cart):
    cart.sensor("one", cart.pos, std=3.0, unit="m", range=(0, 5))
    cart.sensor("full", [cart.pos, cart.vel], variance=[[2, 1], [1, 2]])
    cart.sensor("scaled", [cart.pos, cart.vel], variance=lambda z: z[0] ** 2 + 1)
    one, full, own = cart.sensors
    assert one.strength.tolist() == [[9.0]]
    assert (one.signal.low, one.signal.high, one.signal.unit) == ((0.0,), (5.0,), "m")
    assert full.full
    assert not one.full
    assert own.variance_expression.shape == (2, 2)


# -- names that meet in the generated C -------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["variance_encoder", "gate_encoder", "pos_0", "variance_pos_0", "reject_limit"])
def test_a_parameter_whose_name_is_generated_too(name):
    plant = Plant("cart")
    pos, p = plant.state("pos"), plant.parameter(name, 1.0)
    plant.dynamics({pos: p})
    plant.sensor("encoder", pos, variance=1.0)
    with refuse(f"would both be called '{name}' in the generated C; rename one of them"):
        extended_kalman_filter(plant.discretise("euler", dt=0.1), initial_variance={pos: 1})


@pytest.mark.parametrize(
    ("state", "input_", "sensor", "second"),
    [
        ("rejected_s", "u", "s", "t"),
        ("x", "has_s", "s", "t"),
        ("x", "u", "s", "status_s"),
        ("x", "u", "s", "x_0"),
    ],
)
def test_other_collisions_of_generated_names(state, input_, sensor, second):
    plant = Plant("cart")
    x, u = plant.state(state), plant.input(input_)
    plant.dynamics({x: u})
    plant.sensor(sensor, x, variance=1.0)
    plant.sensor(second, x, variance=1.0)
    with refuse("would both be called '.*' in the generated C; rename one of them"):
        extended_kalman_filter(plant.discretise("euler", dt=0.1), initial_variance={x: 1})


# -- discrete ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("dt", [0, -0.1, "abc", None, (0.2, 0.1), (0.1, 0.1), (0.1, 0.2, 0.3), (0, 1), float("nan")])
def test_a_bad_time_step(moving, dt):
    with refuse(r"cart: dt is .*; give a positive number of seconds, or \(lowest, highest\)"):
        moving.discretise("rk4", dt=dt)


def test_a_bad_discretisation(moving):
    with refuse("the discretisation 'zoh' is not known; take one of euler, rk4, tustin, exact"):
        moving.discretise("zoh", dt=0.1)
    for substeps in (0, -1, 1.5, 1000):
        with refuse("substeps is .*; give an integer from 1 to 100"):
            moving.discretise("rk4", dt=0.1, substeps=substeps)
    with refuse("exact takes no substeps; leave them out"):
        moving.discretise("exact", dt=0.1, substeps=2)
    with refuse(r"it is discrete already \(dt = 0.1\); discretise the continuous plant"):
        moving.discretise("rk4", dt=0.1).discretise("rk4", dt=0.1)
    with refuse("made by discretise.*call dynamics.. on the continuous plant"):
        moving.discretise("rk4", dt=0.1).dynamics({"pos": 0, "vel": 0})


def test_noise_per_step(moving):
    with refuse("step_noise is noise per step, and this plant is continuous; discretise it first"):
        moving.step_noise({"pos": 1.0})
    discrete = moving.discretise("rk4", dt=0.1)
    stranger = Plant("other").state("pos")
    for key in ("speed", stranger, 3):
        with refuse("step_noise is given for .*, which is not a state"):
            discrete.step_noise({key: 1.0})
    with refuse("variance of step noise of 'pos' is negative"):
        discrete.step_noise({"pos": -1.0})
    discrete.step_noise({symbol(moving, "pos"): 2.0})
    assert discrete.step_variances == {"pos": (2.0,)}
    assert moving.step_variances == {}


# -- from elsewhere ---------------------------------------------------------------------------------------------------


class Black(ca.Callback):
    """A function that only calls back: nothing can be seen inside."""

    def __init__(self):
        ca.Callback.__init__(self)
        self.construct("black_box")

    def get_n_in(self):
        return 1

    def get_n_out(self):
        return 1

    def eval(self, arguments):
        return [arguments[0]]


def test_from_casadi():
    X, U, P = ca.MX.sym("x", 2), ca.MX.sym("u"), ca.MX.sym("p")
    f = ca.Function("f", [X, U, P], [ca.vertcat(X[1], P * U)])
    h = ca.Function("h", [X], [X[0]])
    plant = Plant.from_casadi("cart", f, sensors={"gps": (h, 0.1)}, inputs=["push"], parameters={"gain": 2.0})
    assert str(plant.dynamics_expression()) == "[x1, (gain*push)]"
    assert [sensor.signal.name for sensor in plant.sensors] == ["gps"]


def test_from_casadi_with_a_function_that_cannot_be_expanded():
    X = ca.MX.sym("x")
    black = Black()
    f = ca.Function("wing", [X], [black(X)])
    with refuse(r"cart: the CasADi function 'wing' cannot be expanded into scalar operations"):
        Plant.from_casadi("cart", f)
    good = ca.Function("f", [X], [-X])
    with refuse(r"the CasADi function 'wing' cannot be expanded"):
        Plant.from_casadi("cart", good, sensors={"s": (f, 1.0)})


def test_from_casadi_with_wrong_sizes():
    X, U, P, Z = ca.MX.sym("x", 2), ca.MX.sym("u"), ca.MX.sym("p", 2), ca.MX.sym("z", 3)
    f = ca.Function("f", [X, U, P], [X * U])
    cases = [
        (dict(states=["a"], parameters={"c": 1, "d": 1}), "1 states are named, the function 'f' has 2"),
        (dict(inputs=["a", "b"], parameters={"c": 1, "d": 1}), "2 inputs are named, the function 'f' has 1"),
        (dict(), "0 parameters are named, the function 'f' has 2"),
    ]
    for keywords, sentence in cases:
        with refuse(sentence):
            Plant.from_casadi("cart", f, **keywords)
    with refuse("the function 'g' gives 1 values for 2 states"):
        Plant.from_casadi("cart", ca.Function("g", [X], [X[0]]))
    with refuse("the function 'g' has 4 arguments"):
        Plant.from_casadi("cart", ca.Function("g", [X, U, P, Z], [X]))
    with refuse(r"the function 'h' of the sensor 's' takes arguments of \[3\] elements"):
        Plant.from_casadi("cart", ca.Function("g", [X], [X]), sensors={"s": (ca.Function("h", [Z], [Z]), 1.0)})
    with refuse("is not a CasADi function"):
        Plant.from_casadi("cart", lambda x: x)


def system(dt=None):
    names = {"states": ["pos", "vel"], "inputs": ["push", "wind"], "outputs": ["gps"]}
    matrices = ([[0, 1], [-2, -0.3]], [[0, 0.1], [1, 0.5]], [[1, 0.2]], [[0, 0.7]])
    return control.ss(*matrices, *([dt] if dt else []), **names)


@pytest.mark.parametrize("dt", [None, 0.1])
def test_state_space_round_trip_keeps_names_and_matrices(dt):
    from plantc.symbolic.analysis import linearise

    given = system(dt)
    plant = Plant.from_state_space("cart", given, variance=0.5)
    assert [state.signal.name for state in plant.states] == ["pos", "vel"]
    assert [item.signal.name for item in plant.inputs] == ["push", "wind"]
    assert [sensor.signal.name for sensor in plant.sensors] == ["gps"]
    assert plant.dt == dt
    back = linearise(plant).to_state_space()
    for key in "ABCD":
        np.testing.assert_array_equal(getattr(back, key), getattr(given, key))
    assert (back.state_labels, back.input_labels, back.output_labels) == (["pos", "vel"], ["push", "wind"], ["gps"])
    assert back.dt == given.dt


def test_state_space_with_default_labels():
    plant = Plant.from_state_space(
        "cart", control.ss(np.eye(2), np.eye(2), np.eye(2), 0), variance={"y[0]": 1, "y[1]": 2}
    )
    assert [state.signal.name for state in plant.states] == ["x_0", "x_1"]
    assert [float(sensor.strength[0, 0]) for sensor in plant.sensors] == [1.0, 2.0]


def test_state_space_mistakes():
    with refuse("the discrete system has no numeric time step; give it one"):
        Plant.from_state_space("cart", control.ss([[1]], [[1]], [[1]], 0, True))
    with refuse("2 variances are given for 1 outputs"):
        Plant.from_state_space("cart", system(), variance=[1, 2])
    with refuse(r"the variances name \['imu'\], the outputs are \['gps'\]"):
        Plant.from_state_space("cart", system(), variance={"imu": 1})
    with refuse("TransferFunction is not a control.StateSpace; convert it"):
        Plant.from_state_space("cart", control.tf([1], [1, 1]))


# -- identity ---------------------------------------------------------------------------------------------------------


def described(**changes):
    values = {
        "gain": 2.0,
        "variance": lambda z: z**2 + 1,
        "doc": "",
        "noise": 1.0,
        "unit": "m",
        "constant": 3.0,
    } | changes
    plant = Plant("cart")
    x = plant.state("x", unit=values["unit"])
    c = plant.constant("c", values["constant"])
    plant.dynamics({x: -values["gain"] * x + c * plant.noise("w", density=values["noise"])})
    plant.sensor("s", x, variance=values["variance"], doc=values["doc"])
    return plant.fingerprint()


def test_the_fingerprint_says_everything():
    same = described()
    assert described() == same
    changes = [
        {"gain": 2.5},
        {"variance": lambda z: z**2 + 2},
        {"variance": 1.0},
        {"doc": "other"},
        {"noise": 2.0},
        {"unit": "mm"},
        {"constant": 4.0},
    ]
    prints = [described(**change) for change in changes]
    assert len({same, *prints}) == len(changes) + 1


def test_symbols_may_be_keys():
    x = Plant("cart").state("x")
    assert isinstance(x, Symbol)
    assert {x: 1}[x] == 1


@pytest.mark.parametrize(
    "name", ["covariance", "delta", "nis", "row_variance", "own", "taken", "fabsf", "UINT32_MAX", "i"]
)
def test_words_of_the_generated_c_are_refused_where_they_are_given(name):
    with refuse(f"the state name '{name}' is a"):
        Plant("cart").state(name)


def test_one_noise_in_two_sensors_is_refused(cart):
    shared = cart.noise("shared", variance=0.1)
    cart.sensor("first", cart.pos + shared)
    with refuse("the noise 'shared' enters the sensors 'first' and 'second'"):
        cart.sensor("second", cart.pos + shared)


def test_a_noise_that_is_used_nowhere_is_refused(cart):
    cart.noise("idle", variance=0.1)
    cart.sensor("gps", cart.pos, variance=1.0)
    cart.dynamics({cart.pos: cart.vel, cart.vel: 0 * cart.vel})
    with refuse("the noise 'idle' enters neither dynamics nor sensors"):
        extended_kalman_filter(cart.discretise("euler", dt=0.1), initial_variance={"pos": 1, "vel": 1})


def test_a_sensor_in_another_unit_than_the_state_it_reads(cart):
    with refuse(r"the sensor 'gps' is in \[mm\], but reads 'pos', which is in \[m\]; convert the expression"):
        cart.sensor("gps", cart.pos, variance=1.0, unit="mm")


def test_a_unit_that_is_no_text():
    with refuse("the unit of the state 'x' is 5; give it as text"):
        Plant("cart").state("x", unit=5)


@pytest.mark.parametrize("what", ["initial_variance", "around", "gate"])
def test_options_that_are_no_dictionary(moving, what):
    options = {"initial_variance": {"pos": 1, "vel": 1}, what: 5}
    with refuse(f"{what} is 5; give a dictionary, name -> number"):
        extended_kalman_filter(moving.discretise("euler", dt=0.1), **options)


def test_dynamics_that_are_no_dictionary(cart):
    with refuse("dynamics are given as list; give a dictionary, state -> expression"):
        cart.dynamics([cart.vel, 0])
