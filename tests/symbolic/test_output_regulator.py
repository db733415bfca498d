"""The output regulator as one Block: specs/output_regulation.md, section 11, and what it refuses."""

from dataclasses import replace

import numpy as np
import pytest
from plantc.reference import regulation as oracle
from plantc.symbolic import sin
from plantc.symbolic.exosystems import compose, constant, harmonic, polynomial
from plantc.symbolic.output_regulator import output_regulator, regulator_feedback
from plantc.symbolic.regulator_equations import RegulatorError, francis, linear_model
from plantc.symbolic.signal_generators import high_gain_exosystem, kalman_exosystem

from plantc import (
    InterpretView,
    ModelError,
    NativeView,
    Plant,
    ReferenceView,
    cross_check,
    emit,
    kalman_filter,
    linearise,
    lqr,
)

T = 0.02


def small():
    """The plant of section 11: the disturbance enters by a path that the input does not reach, too."""
    plant = Plant("spring")
    position, speed = plant.state("position", unit="m", range=(-1e3, 1e3)), plant.state("speed", range=(-1e3, 1e3))
    force, wind = plant.input("force", unit="N", range=(-1e4, 1e4)), plant.input("wind", range=(-1e3, 1e3))
    plant.dynamics({position: speed + 0.5 * wind, speed: -position - 0.4 * speed + force + wind})
    plant.sensor("encoder", position, unit="m", variance=1e-8)
    return plant.discretise("euler", dt=T)


@pytest.fixture(scope="module")
def parts():
    plant = small()
    at = linearise(plant)
    tracks = compose([polynomial("position", 2, unit="m"), polynomial("wind", 2)]).sampled(T, "euler")
    solution = francis(at, tracks)
    gain = lqr((solution.model.A, solution.model.B, T), Q=[100, 10], R=1)
    generator = kalman_exosystem(tracks, process_variance=1e-4, measurement_variance=0.01)
    return plant, gain, solution, generator


def signals(k):
    t = T * k
    return 1 + 0.2 * t - 0.01 * t * t, 0.5 + 0.1 * t


def error_of(block, solution, steps=3001, **params):
    """Errors of the position in a closed loop with the linear plant, from rest."""
    view = NativeView(block)
    given = view.params(**params)
    memory, x, found = view.init(given), np.zeros(2), []
    A, B, E = solution.model.A, solution.model.B, np.array([0.5, 1.0]) * T
    for k in range(steps):
        reference, wind = signals(k)
        inputs = {
            "generator_position": reference, "generator_has_position": True, "generator_wind": wind,
            "generator_has_wind": True, "feedback_position": x[0], "feedback_speed": x[1],
        }  # fmt: skip
        answer = view.call("step", memory, view.inputs("step", inputs), given)
        assert answer.status == 0
        memory, u = answer.memory, float(answer.outputs["feedback"]["force"])
        found.append(x[0] - reference)
        x = A @ x + B[:, 0] * u + E * wind
    return np.abs(found)


def test_references_are_followed_and_disturbances_undone(parts):
    plant, gain, solution, generator = parts
    np.testing.assert_allclose(gain.gain, [[8.5648021, 4.8456776]], atol=1e-7)
    assert np.max(np.abs(gain.eigenvalues)) == pytest.approx(0.94810989, abs=1e-8)
    block = output_regulator(plant, {}, gain, solution, generator)
    # maps of 9 digits, then all digits that there are
    assert np.max(error_of(block, solution)[2000:]) < 2e-8
    exact = {what: picked(solution, block, what) for what in ("state_map", "input_map")}
    assert (
        np.max(error_of(block, solution, **{f"feedback__{what}": item for what, item in exact.items()})[2000:]) < 1e-11
    )
    # the planted fault: the disturbance is read, and left out of the maps
    blind = {}
    for what, item in exact.items():
        known = [j < 3 for _, j in places(block, what)]
        blind[f"feedback__{what}"] = np.where(known, item, 0.0)
    assert np.max(error_of(block, solution, **blind)[2000:]) == pytest.approx(2.446, rel=1e-3)


def picked(solution, block, what):
    return np.array([getattr(solution, what)[i, j] for i, j in places(block, what)])


def default(block, what):
    return next(s.default for s in block.parts["feedback"].param_signals if s.name == what)


def places(block, what):
    oracle_ = block.parts["feedback"].oracle.formulas["step"]
    return oracle_.state_places if what == "state_map" else oracle_.input_places


def test_the_law_is_that_of_the_oracle_loop(parts):
    plant, gain, solution, _ = parts
    law = regulator_feedback(plant, {"position": 0.3, "force": 0.3}, gain, solution)
    view = InterpretView(law)
    rng = np.random.default_rng(0)
    for _ in range(5):
        x, w = rng.normal(size=2), rng.normal(size=6)
        inputs = {"position": x[0], "speed": x[1], "w_position": w[:3], "w_wind": w[3:]}
        answer = view.call("step", view.init(), view.inputs("step", inputs), view.params())
        _, u = oracle.closed_loop(
            lambda x, u: x,
            x,
            w[None, :],
            gain.gain,
            solution.state_map,
            solution.input_map,
            (np.array([0.3, 0]), np.array([0.3])),
        )
        assert float(answer.outputs["force"]) == pytest.approx(u[0, 0], rel=1e-7)


def test_the_maps_are_kept_by_their_elements_that_are_not_zero(parts):
    plant, gain, solution, _ = parts
    law = regulator_feedback(plant, {}, gain, solution)
    sizes = {signal.name: signal.size for signal in law.param_signals}
    assert sizes["state_map"] == np.count_nonzero(solution.rounded()["state_map"]) == 3
    assert sizes["input_map"] == np.count_nonzero(solution.rounded()["input_map"]) == 5


def test_designed_numbers_are_recorded(parts):
    plant, gain, solution, generator = parts
    block = output_regulator(plant, {}, gain, solution, generator)
    assert set(block.design.values) == {"feedback.state_map", "feedback.input_map", "feedback.gain"}
    good = block.design.properties(block.design.values)
    assert all(value <= limit for value, limit in good.values()), good
    wrong = {**block.design.values, "feedback.input_map": 1.001 * block.design.values["feedback.input_map"]}
    assert any(value > limit for value, limit in block.design.properties(wrong).values())
    again = block.design.rebuild(wrong)
    assert default(again, "input_map") == pytest.approx(1.001 * np.array(default(block, "input_map")))
    with pytest.raises(ModelError, match="input_map of design.json has other zeros than the model"):
        block.design.rebuild({**wrong, "feedback.input_map": np.ones((1, 6))})
    with pytest.raises(ModelError, match=r"state_map of design.json has shape \(1, 6\); give 2 x 6"):
        block.design.rebuild({**wrong, "feedback.state_map": np.ones((1, 6))})


def test_what_is_refused(parts):
    plant, gain, solution, generator = parts
    with pytest.raises(RegulatorError, match=r"A - B K has spectral radius 1\.\d+, not below 1\); -K would"):
        output_regulator(plant, {}, -gain.gain, solution, generator)
    output_regulator(plant, {}, -gain.gain, solution, generator, accept_unstable=True)
    with pytest.raises(
        ModelError, match=r"the gain has shape \(1, 3\); give 1 x 2, a row for each input that acts \(force\)"
    ):
        output_regulator(plant, {}, np.ones((1, 3)), solution, generator)
    with pytest.raises(
        ModelError, match=r"Pi has shape \(2, 6\) and Gamma \(2, 6\), and the plant 'spring' 2 states and 1"
    ):
        regulator_feedback(plant, {}, gain, replace(solution, input_map=np.ones((2, 6))))


def test_an_exosystem_in_the_wrong_place_is_a_sentence(parts):
    plant, gain, solution, generator = parts
    tracks = solution.exosystem
    with pytest.raises(
        ModelError, match="spring_regulator: the generator is of type Exosystem; give an observer of the exosystem"
    ):
        output_regulator(plant, {}, gain, solution, tracks)
    with pytest.raises(ModelError, match="the generator is of type Exosystem"):
        output_regulator(plant, {}, gain, solution, {"position": tracks, "wind": tracks})
    with pytest.raises(
        ModelError, match=r"the solution is of type Exosystem; give francis\(linearise\(plant, point\), exosystem\)"
    ):
        output_regulator(plant, {}, gain, tracks, generator)


def with_estimator(parts):
    plant, gain, solution, generator = parts
    variances = {"position": 1e-2, "speed": 1e-2}
    noisy = small().step_noise({"speed": 1e-8})
    estimator = kalman_filter(noisy, initial_variance=variances, name="spring_kf")
    return output_regulator(plant, {}, gain, solution, generator, estimator=estimator)


def test_with_an_estimator_in_front(parts):
    block = with_estimator(parts)
    names = {signal.name for signal in block.entries["step"].inputs}
    assert {"estimator_encoder", "estimator_has_encoder", "estimator_wind", "generator_position"} <= names
    assert not any(name.startswith("feedback_") for name in names)


@pytest.mark.slow
@pytest.mark.parametrize("what", ["bare", "estimator", "high gain", "twins"])
def test_the_c_of_the_regulator(parts, what):
    plant, gain, solution, generator = parts
    if what == "estimator":
        block = with_estimator(parts)
    elif what == "twins":
        block = of_twins(parts, tunable=False)
    elif what == "bare":
        block = output_regulator(plant, {}, gain, solution, generator, saturate=True)
    else:
        tracks = compose([polynomial("position", 1, unit="m"), polynomial("wind", 1)]).sampled(T, "euler")
        observer = high_gain_exosystem(tracks, coefficients=(2, 1), epsilon=0.1)
        block = output_regulator(plant, {}, gain, francis(linearise(plant), tracks), observer)
    assert cross_check(block, "double", steps=60).passed


def test_the_oracle_of_the_whole(parts):
    plant, gain, solution, generator = parts
    block = output_regulator(plant, {}, gain, solution, generator)
    first, second = InterpretView(block), ReferenceView(block)
    memory, params = first.init(), first.params()
    for k in range(20):
        reference, wind = signals(k)
        inputs = first.inputs("step", {
            "generator_position": reference, "generator_has_position": k % 4 > 0, "generator_wind": wind,
            "generator_has_wind": True, "feedback_position": 0.1 * k, "feedback_speed": 0.3,
        })  # fmt: skip
        one, two = (view.call("step", memory, inputs, params) for view in (first, second))
        assert one.status == two.status == 0
        assert float(one.outputs["feedback"]["force"]) == pytest.approx(
            float(two.outputs["feedback"]["force"]), rel=1e-9
        )
        memory = one.memory


def of_twins(parts, **options):
    """Both signals observed by the very same Block."""
    plant, gain, solution, _ = parts
    one = kalman_exosystem(
        polynomial("reading", 2).sampled(T, "euler"), process_variance=1e-4, measurement_variance=0.01, name="one"
    )
    return output_regulator(plant, {}, gain, solution, {"position": one, "wind": one}, **options)


def test_one_generator_for_signals_of_one_kind(parts):
    plant, gain, solution, generator = parts
    whole, twins = InterpretView(output_regulator(plant, {}, gain, solution, generator)), InterpretView(of_twins(parts))
    first, second, p, q = whole.init(), twins.init(), whole.params(), twins.params()
    for k in range(20):
        reference, wind = signals(k)
        one = whole.call("step", first, whole.inputs("step", {
            "generator_position": reference, "generator_has_position": k % 3 > 0, "generator_wind": wind,
            "generator_has_wind": k % 4 > 0, "feedback_position": 0.1 * k, "feedback_speed": 0.3,
        }), p)  # fmt: skip
        two = twins.call("step", second, twins.inputs("step", {
            "generator_position_reading": reference, "generator_position_has_reading": k % 3 > 0,
            "generator_wind_reading": wind, "generator_wind_has_reading": k % 4 > 0,
            "feedback_position": 0.1 * k, "feedback_speed": 0.3,
        }), q)  # fmt: skip
        assert float(one.outputs["feedback"]["force"]) == pytest.approx(
            float(two.outputs["feedback"]["force"]), rel=1e-9
        )
        first, second = one.memory, two.memory
    plant, gain, solution, _ = parts
    with pytest.raises(ModelError, match="generators are given for position; give one for each of position, wind"):
        output_regulator(plant, {}, gain, solution, {"position": generator})
    with pytest.raises(ModelError, match="the generator of 'position' observes w_position, w_wind; give it one signal"):
        output_regulator(plant, {}, gain, solution, {"position": generator, "wind": generator})


def test_twins_share_their_c(parts):
    text = emit(of_twins(parts))
    assert "regulator_generator_position_step_core(" in text.source
    assert "spring_regulator_generator_wind_step_core(" not in text.source
    assert "typedef spring_regulator_generator_position_state_t spring_regulator_generator_wind_state_t;" in text.header
    assert text.operations["generator_wind.predict"] == text.operations["generator_position.predict"]


def test_twins_stay_twins_with_designed_numbers(parts):
    plant, gain, solution, _ = parts
    one = kalman_exosystem(
        polynomial("reading", 2).sampled(T, "euler"),
        process_variance=1e-4,
        measurement_variance=0.01,
        steady=True,
        name="one",
    )
    block = output_regulator(plant, {}, gain, solution, {"position": one, "wind": one})
    again = block.design.rebuild(block.design.values)
    assert again.twin("generator_wind") == "generator_position"
    other = {**block.design.values, "generator_wind.gain": 1.5 * block.design.values["generator_wind.gain"]}
    assert block.design.rebuild(other).twin("generator_wind") == "generator_wind"


def test_numbers_that_are_folded(parts):
    plant, gain, solution, _ = parts
    laws = [
        regulator_feedback(plant, {"position": 0.3, "force": 0.3}, gain, solution, tunable=how) for how in (True, False)
    ]
    assert {signal.name for signal in laws[1].param_signals} == {"position", "speed", "force"}
    inputs = {"position": 0.2, "speed": -0.7, "w_position": [1.0, 2.0, 3.0], "w_wind": [0.1, 0.2, 0.3]}
    found = []
    for law in laws:
        for kind in (InterpretView, ReferenceView):
            view = kind(law)
            answer = view.call("step", view.init(), view.inputs("step", inputs), view.params())
            found.append(float(answer.outputs["force"]))
    np.testing.assert_allclose(found, found[0], rtol=1e-12)
    again = laws[1].design.rebuild({**laws[1].design.values, "gain": 2 * gain.rounded()})
    view = InterpretView(again)
    other = float(view.call("step", view.init(), view.inputs("step", inputs), view.params()).outputs["force"])
    assert abs(other - found[0]) > 0.1
    assert again.source == laws[1].source


@pytest.mark.parametrize("fault", ["sign of K", "P_d left out"])
def test_a_planted_fault_is_seen(needs, parts, fault):
    needs("gcc")
    plant, gain, solution, _ = parts
    law = regulator_feedback(plant, {}, gain, solution, tunable=False)
    formula = law.oracle.formulas["step"]
    fixed = dict(formula.fixed)
    if fault == "sign of K":
        fixed["gain"] = -fixed["gain"]
    else:
        fixed["input_map"] = np.where([j < 3 for _, j in formula.input_places], fixed["input_map"], 0.0)
    law.oracle = replace(law.oracle, formulas={"step": replace(formula, fixed=fixed)})
    assert not cross_check(law, "double", steps=20).passed


def test_without_an_exosystem_it_is_state_feedback(parts):
    plant, gain, _, _ = parts
    both = np.vstack([gain.gain, np.zeros((1, 2))])  # nothing says that the wind is measured
    law = regulator_feedback(plant, {}, both, francis(linearise(plant), compose([], dt=T)))
    view = InterpretView(law)
    answer = view.call("step", view.init(), view.inputs("step", {"position": 1.0, "speed": 0.0}), view.params())
    assert float(answer.outputs["force"]) == pytest.approx(-gain.gain[0, 0])


# -- what has to belong together --------------------------------------------------------------------------------------


def observer(*tracks, **options):
    return kalman_exosystem(compose(tracks), process_variance=1e-4, measurement_variance=0.01, **options)


@pytest.mark.parametrize(
    ("dt", "method", "says"),
    [
        (
            0.5,
            "euler",
            r"the generator is discrete with dt = 0.5 s, and .* an exosystem that is discrete with dt = 0.02 s",
        ),
        (T, "exact", r"the generator observes another exosystem \(S or Q differ, composition exact\)"),
    ],
)
def test_a_generator_of_another_time_base_or_sampling_is_refused(parts, dt, method, says):
    plant, gain, solution, _ = parts
    tracks = [polynomial(name, 2).sampled(dt, method) for name in ("position", "wind")]
    with pytest.raises(ModelError, match=says):
        output_regulator(plant, {}, gain, solution, observer(*tracks))
    each = {name: observer(one) for name, one in zip(("position", "wind"), tracks, strict=True)}
    with pytest.raises(
        ModelError, match=says.split(",")[0].split(" is")[0].replace("generator", "generator of 'position'")
    ):
        output_regulator(plant, {}, gain, solution, each)


def test_a_generator_of_signals_of_another_kind_is_refused(parts):
    plant, gain, _, _ = parts
    line = compose([polynomial("position", 1), polynomial("wind", 1)]).sampled(T)
    solution = francis(linearise(plant), line)
    waves = observer(harmonic("position", 3.0).sampled(T), polynomial("wind", 1).sampled(T))
    with pytest.raises(ModelError, match="observes another exosystem"):
        output_regulator(plant, {}, gain, solution, waves)
    with pytest.raises(ModelError, match="does not observe wind"):
        output_regulator(plant, {}, gain, solution, observer(polynomial("position", 1).sampled(T)))
    # the order of the signals is nothing that matters
    turned = observer(polynomial("wind", 1).sampled(T), polynomial("position", 1).sampled(T))
    assert output_regulator(plant, {}, gain, solution, turned).sample_time == T


def cart(stiffness=0.0):
    plant = Plant("cart")
    x, v = plant.state("x", range=(-1e3, 1e3)), plant.state("v", range=(-1e3, 1e3))
    u = plant.input("u", range=(-1e4, 1e4))
    plant.dynamics({x: v, v: -stiffness * x - 0.3 * v + u})
    return plant


def test_the_gain_is_judged_with_the_plant_at_the_rate_of_the_law():
    plant = cart()
    slow = plant.discretise("euler", dt=0.5)
    fast = lqr(linearise(plant), Q=[1e4, 10], R=1)  # stabilises the continuous plant, and the one sampled at 20 ms
    solution = francis(linearise(slow), constant("x").sampled(0.5))
    for gain in (fast, fast.gain):
        with pytest.raises(RegulatorError, match=r"A - B K has spectral radius 4\.3\d+, not below 1"):
            regulator_feedback(slow, {}, gain, solution)
    maps = francis(linearise(plant), constant("x"))
    assert regulator_feedback(plant, {}, fast, maps).sample_time is None
    generators = {dt: observer(constant("x").sampled(dt)) for dt in (T, 0.5)}
    assert output_regulator(plant, {}, fast, maps, generators[T]).sample_time == T
    with pytest.raises(RegulatorError, match="spectral radius"):  # the continuous plant, held for half a second
        output_regulator(plant, {}, fast, maps, generators[0.5])
    with pytest.raises(
        ModelError, match=r"the plant 'cart' is discrete with dt = 0.02 s, and of the generators generator 0.5"
    ):
        output_regulator(plant.discretise("euler", dt=T), {}, fast, maps, generators[0.5])


def test_a_solution_of_another_plant_or_point_is_refused():
    plant, other = (cart(stiffness).discretise("euler", dt=T) for stiffness in (0.0, 50.0))
    gain = lqr(linearise(plant), Q=[100, 10], R=1)
    says = r"for another plant, or at another point \(A differs by \S+ of its largest element from that of 'cart'"
    with pytest.raises(ModelError, match=says):
        regulator_feedback(plant, {}, gain, francis(linearise(other), constant("x").sampled(T)))
    swing = Plant("swing")
    angle, rate = swing.state("angle", range=(-10, 10)), swing.state("rate", range=(-100, 100))
    torque = swing.input("torque", range=(-100, 100))
    swing.dynamics({angle: rate, rate: -9.81 * sin(angle) - 0.1 * rate + torque})
    sampled = swing.discretise("euler", dt=T)
    gain, solution = lqr(linearise(sampled), Q=[1, 1], R=10), francis(linearise(sampled), constant("angle").sampled(T))
    regulator_feedback(sampled, {}, gain, solution)
    with pytest.raises(ModelError, match=r"at another point \(A differs"):
        regulator_feedback(sampled, {"angle": 2.5, "torque": 9.81 * np.sin(2.5)}, gain, solution)


def test_maps_of_matrices_with_labels_of_their_own():
    plant = cart().discretise("euler", dt=T)
    at = linearise(plant)
    gain, signal = lqr(at, Q=[100, 10], R=1), constant("y_0").sampled(T)
    regulator_feedback(plant, {}, gain, francis(linear_model(at.A, at.B, [[1, 0]], dt=T), signal))
    with pytest.raises(ModelError, match=r"B differs by 0\.5 "):
        regulator_feedback(plant, {}, gain, francis(linear_model(at.A, 2 * at.B, [[1, 0]], dt=T), signal))
