"""The loop of specs/meda2018.md, section 10.1(e): over views and compiled whole, to 1e-7; and what cannot be connected."""

from dataclasses import replace

import numpy as np
import pytest
from plantc.codegen.batch import Batch
from plantc.examples.quadrotor_ekf import sampled, set_point
from plantc.simulation import closed_loop, metrics_of, run_batch, simulate
from plantc.symbolic.composition import connect, delay

from plantc import Block, InterpretView, ModelError, NativeView, Plant, ReferenceView

R, STEPS = 0.05, 100
EXPECTED = {
    "kf": (
        "0.03573159475 0.005047293446 -0.05498450452 0.003694519054 29.96447733 -0.02958716735 -0.0008668377581 "
        "-0.03895169246 -0.001542361076 -0.0008286091748 0.01552325863 -0.03811895492",
        "0.03717780521 -0.003088560355 -0.05503635026 0.001174588742 29.96315985 -0.03856543114 -0.002337576424 "
        "-0.04863366172 -0.005614954358 -0.01162184703 0.02496398231 -0.04533404974",
        {"estimate_to_set_point": 0.05302368568, "error": 0.002895278082, "regulation": 0.05690928144, "nees": 24.32898926},
    ),
    "ekf": (
        "-0.008536532986 0.008827556118 -0.001937207118 -0.005258865354 30.00221336 -0.02966842987 0.001202832832 "
        "-0.04391605094 -0.0009526354312 -0.004087654359 -0.003315852952 -0.04368804805",
        "-0.006927110381 0.006894876945 -0.002241272904 -0.0161568893 30.00387817 -0.03246977553 0.003734578313 "
        "-0.04255812147 -0.001719929443 -0.004867032974 0.009323277675 -0.04415204267",
        {"estimate_to_set_point": 0.04287550965, "error": 0.001183703239, "regulation": 0.0449243778, "nees": 5.976205286},
    ),
    "jsse": (
        "0.004798951027 -0.007386420423 -0.007622697829 -0.02491372572 30.0015105 -0.1430212219 0.01227751616 "
        "-0.3362319007 0.006435722226 0.1488539086 -0.0009163177882 -0.4496944095",
        "0.03107905555 -0.02802782561 0.01940308387 -0.04803161965 30.02171602 -0.1205978182 0.006502505353 "
        "-0.3497035376 -0.01766559741 0.1232372934 0.05949926951 -0.4815145956",
        {"estimate_to_set_point": 0.137665014, "error": 0.007973619903, "regulation": 0.1286553669},
    ),
    "jssem": (
        "-0.1094386909 0.1722806229 0.1999737376 -0.1468004384 30.06126002 -0.008333339109 0.01984895191 "
        "-0.01680691703 0.01840083195 -0.007917896753 -0.001081704538 -0.0006399699397",
        "-0.06347313282 0.05867323231 0.08781805847 -0.08773402624 30.05114351 -0.01820656058 -0.0005505666065 "
        "-0.03083935733 -0.004595804298 -0.02277263901 -0.01321904014 -0.01690503143",
        {"estimate_to_set_point": 0.01447442438, "error": 0.05081140717, "regulation": 0.0969069035},
    ),
}  # fmt: skip


def pseudo_noise():
    k, i = np.arange(1, STEPS + 1)[:, None], np.arange(1, 13)
    w = 1e-3 * np.sqrt(2) * np.sin(1.1 * k * i + 2.3 * i + 0.5)
    v = R * np.sqrt(2) * np.sin(1.7 * k * i + 0.7 * i**2 + 0.2)
    names = [f"{state.signal.name}_noise" for state in sampled.states]
    return {name: w[:, j] for j, name in enumerate(names)} | {"pose_noise": v}


def begin(made, which, tuned):
    x_0 = np.array(made.point.x) + 0.05 * (-1.0) ** np.arange(1, 13)
    return made.truth_parameters(x_0) | tuned(which, R, gamma=0.01)


def compare(history, which):
    true_end, estimate_end, numbers = EXPECTED[which]
    np.testing.assert_allclose(history.truth[-1], [float(item) for item in true_end.split()], atol=1e-7, rtol=0)
    np.testing.assert_allclose(history.estimate[-1], [float(item) for item in estimate_end.split()], atol=1e-7, rtol=0)
    found = metrics_of(history)
    assert {name: found[name] for name in numbers} == pytest.approx(numbers, rel=1e-6)


@pytest.mark.parametrize("which", EXPECTED)
def test_the_trace_of_section_10_1e_in_one_c_call(which, loop, tuned):
    made = loop(which)
    batch = Batch(made.text)
    noise, params = pseudo_noise(), begin(made, which, tuned)
    history = run_batch(batch, made.layout, noise, STEPS, params=params, held=made.held)
    assert history.statuses.max() == 0
    compare(history, which)


@pytest.mark.parametrize(
    ("which", "kinds"),
    [
        ("ekf", (NativeView, NativeView)),
        ("kf", (NativeView, NativeView)),
        pytest.param("ekf", (ReferenceView, ReferenceView), marks=pytest.mark.slow),
        pytest.param("kf", (InterpretView, ReferenceView), marks=pytest.mark.slow),
    ],
)
def test_the_trace_of_section_10_1e_over_views(which, kinds, loop, tuned):
    made = loop(which)
    plant, controller = kinds[0](made.truth), kinds[1](made.controller)
    params = begin(made, which, tuned)
    history = simulate(made, plant, controller, STEPS, noise=pseudo_noise(), params=params)
    compare(history, which)
    if kinds == (NativeView, NativeView):  # the whole loop in C is its parts in C, bit for bit
        whole = run_batch(Batch(made.text), made.layout, pseudo_noise(), STEPS, params=params, held=made.held)
        for name in ("truth", "estimate", "spread", "commands"):
            assert getattr(whole, name).tobytes() == getattr(history, name).tobytes()


def test_another_order_of_the_loop_is_seen(loop, tuned):
    """The companion: the reading, in place of the command, is one step late."""
    made = loop("ekf")
    rotors = {f"plant.rotor_{k}": f"controller.feedback.rotor_{k}" for k in (1, 2, 3, 4)}
    late = {"controller.estimator_pose": delay("plant.pose", made.point.x)}
    wrong = replace(made, block=connect({"plant": made.truth, "controller": made.controller}, rotors | late, "wrong"))
    params = begin(made, "ekf", tuned)
    history = run_batch(Batch(wrong.text), made.layout, pseudo_noise(), STEPS, params=params, held=made.held)
    with pytest.raises(AssertionError, match="Not equal to tolerance"):
        compare(history, "ekf")


def test_a_refused_call_ends_a_run_in_both_ways_alike(loop, tuned):
    made = loop("kf")
    noise = {"pose_noise": np.zeros((20, 12)), "vx_noise": np.zeros(20)}
    noise["vx_noise"][9] = 2000.0  # beyond the range of vx
    params = tuned("kf", R)
    whole = run_batch(Batch(made.text), made.layout, noise, 20, params=params, held=made.held)
    parts = simulate(made, NativeView(made.truth), NativeView(made.controller), 20, noise=noise, params=params)
    for history in (whole, parts):
        assert len(history.truth) == 9
        assert history.refused == "OVERFLOW"
    assert whole.truth.tobytes() == parts.truth.tobytes()


def test_a_history_stays_what_it_is_when_another_run_follows(loop, tuned):
    made = loop("kf")
    batch, params = Batch(made.text), tuned("kf", R)
    arguments = {"params": params, "held": made.held}
    first = run_batch(batch, made.layout, pseudo_noise(), STEPS, **arguments)
    before = {name: getattr(first, name).copy() for name in ("truth", "estimate", "spread", "commands", "statuses")}
    nis = first.nis["pose"].copy()
    second = run_batch(batch, made.layout, {}, STEPS, **arguments)  # no noise: nothing is left of that before
    assert np.max(np.abs(second.truth - made.point.x)) < 1e-9
    assert {name: getattr(first, name).tobytes() for name in before} == {k: v.tobytes() for k, v in before.items()}
    np.testing.assert_array_equal(first.nis["pose"], nis)


def test_a_view_of_another_block_and_a_wrong_parameter_are_refused(loop):
    made = loop("kf")
    other = NativeView(loop("ekf").controller)
    with pytest.raises(ValueError, match="the view runs 'quadrotor_ekf_controller', the loop has"):
        simulate(made, NativeView(made.truth), other, 1)
    with pytest.raises(ValueError, match="'plant.mass' is no parameter of the loop"):
        simulate(made, NativeView(made.truth), NativeView(made.controller), 1, params={"plant.mass": 2.0})


def controller_of(inputs, outputs):
    block = Block("pilot")
    taken = [block.input(name, range=(-1e6, 1e6)) for name in inputs]
    block.entry("step", inputs=taken, outputs={name: sum(taken, 0.0 * taken[0]) for name in outputs})
    return block


def test_what_cannot_be_connected_is_said():
    plant = Plant("tank", dt=1.0)
    level = plant.state("level")
    flow = plant.input("flow")
    plant.dynamics({level: 0.9 * level + flow})
    plant.sensor("gauge", level, variance=0.01)
    with pytest.raises(ModelError, match="0 of its outputs are named 'flow'"):
        closed_loop(plant, controller_of(["gauge"], ["valve"]), {})
    with pytest.raises(ModelError, match=r"its input 'wish' is no sensor of tank \(gauge\); give it a value"):
        closed_loop(plant, controller_of(["gauge", "wish"], ["flow"]), {})
    with pytest.raises(ModelError, match=r"held= names \['wihs'\]"):
        closed_loop(plant, controller_of(["gauge"], ["flow"]), {}, held={"wihs": 1.0})
    made = closed_loop(plant, controller_of(["gauge", "wish"], ["flow"]), {"level": 1.0}, held={"wish": -0.5})
    history = run_batch(Batch(made.text), made.layout, {}, 3, held=made.held)
    expected, x, u = [], 1.0, 0.0
    for _ in range(3):
        x = 0.9 * x + u
        u = x - 0.5
        expected.append(x)
    np.testing.assert_allclose(history.truth[:, 0], expected)
    assert history.estimate is None
    assert set(metrics_of(history)) == {"regulation"}


def test_a_reading_is_given_to_one_input_unless_it_is_said():
    plant = Plant("tank", dt=1.0)
    level = plant.state("level")
    flow = plant.input("flow")
    plant.dynamics({level: 0.9 * level + flow})
    plant.sensor("gauge", level, variance=0.01)
    plant.sensor("wish", -level, variance=0.01)
    both = controller_of(["estimator_gauge", "generator_gauge"], ["flow"])
    with pytest.raises(
        ModelError, match=r"'estimator_gauge' and 'generator_gauge' are both named after the sensor 'gauge'"
    ):
        closed_loop(plant, both, {})
    made = closed_loop(plant, both, {"level": 1.0}, readings={"generator_gauge": "wish"})
    assert run_batch(Batch(made.text), made.layout, {}, 1).commands[0, 0] == pytest.approx(0.0, abs=1e-12)
    made = closed_loop(plant, both, {"level": 1.0}, readings={"estimator_gauge": "gauge", "generator_gauge": "gauge"})
    assert run_batch(Batch(made.text), made.layout, {}, 1).commands[0, 0] == pytest.approx(1.8)
    with pytest.raises(
        ModelError, match=r"readings= names 'gage', which is no input of it; it has estimator_gauge, gen"
    ):
        closed_loop(plant, both, {}, readings={"gage": "wish"})
    with pytest.raises(ModelError, match=r"the sensor 'wihs'; the plant has gauge \(1\), wish \(1\)"):
        closed_loop(plant, both, {}, readings={"generator_gauge": "wihs"})


def test_an_input_is_not_taken_for_a_sensor_that_another_claims():
    """A law has inputs p and reference_p; only the first can mean the sensor p, however it was told."""
    plant = Plant("tank", dt=1.0)
    p, q = plant.state("tp"), plant.state("tq")
    flow = plant.input("flow")
    plant.dynamics({p: 0.9 * p + flow, q: q})
    plant.sensor("p", p, variance=0.01)
    plant.sensor("q", q, variance=0.01)
    for inputs in (["p", "reference_p"], ["reference_p", "p"]):
        law = controller_of(inputs, ["flow"])
        both = "'p' and 'reference_p' are both named after the sensor 'p'"
        for told in ({}, {"held": {"p": 1.0}}, {"readings": {"p": "q"}}):
            with pytest.raises(ModelError, match=both):
                closed_loop(plant, law, {}, **told)
        with pytest.raises(
            ModelError, match=r"its input 'reference_p' is .*'p', which readings= gives to 'p', .* held="
        ):
            closed_loop(plant, law, {}, readings={"p": "p"})
        assert closed_loop(plant, law, {}, held={"reference_p": 0.0}).readings == {"p": "p"}
        for given in ({"reference_p": "q"}, {"reference_p": "p"}):
            assert closed_loop(plant, law, {}, readings=given).readings == {"p": "p"} | given
    with pytest.raises(ModelError, match="'part_p' is named after the sensor 'p', which readings= gives to 'other'"):
        closed_loop(plant, controller_of(["other", "part_p"], ["flow"]), {}, readings={"other": "p"})


def test_what_is_of_another_kind_is_said():
    plant = Plant("tank", dt=1.0)
    level = plant.state("level")
    plant.dynamics({level: 0.9 * level})
    with pytest.raises(ModelError, match="the controller is the Plant 'tank'; give a Block"):
        closed_loop(plant, plant, {})
    with pytest.raises(ModelError, match="the plant is the Block 'pilot'; give a discrete Plant"):
        closed_loop(controller_of(["gauge"], ["flow"]), plant, {})


def test_the_loop_of_the_quadrotor_is_wired_as_the_specification_says(loop):
    made = loop("ekf")
    assert made.held == {"controller_estimator_has_pose": 1.0}
    assert made.layout.estimate[0] == "controller.estimator.x"
    assert made.layout.spread == "controller.estimator.covariance"
    assert made.layout.nis == {"pose": "controller.estimator.pose.nis"}
    first = made.command_parameters(np.array([1.0, 2, 3, 4]))
    assert first["delay_plant_rotor_3_0"] == first["controller.delay_estimator_rotor_3_0"] == [3.0]
    assert made.point["z"] == set_point[sampled.states[4].symbol]


def test_of_two_outputs_with_the_name_of_an_input_one_is_said_to_command_it():
    """A law asks, a valve gives: both by the name of what flows. Named readings are those of a loop over views, too."""
    plant = Plant("tank", dt=1.0)
    level = plant.state("level")
    flow = plant.input("flow")
    plant.dynamics({level: 0.9 * level + flow})
    plant.sensor("gauge", level, variance=0.01)
    law, valve = controller_of(["seen"], ["flow"]), Block("valve")
    asked = valve.input("asked")
    valve.entry("step", inputs=[asked], outputs={"flow": 0.5 * asked})
    both = connect({"law": law, "valve": valve}, {"valve.asked": "law.flow"}, "both")
    readings = {"law_seen": "gauge"}
    with pytest.raises(ModelError, match=r"2 of its outputs are named 'flow'.*commands=\{'flow': \.\.\.\} does"):
        closed_loop(plant, both, {}, readings=readings)
    with pytest.raises(ModelError, match="commands= gives 'valve.flwo' for it"):
        closed_loop(plant, both, {}, readings=readings, commands={"flow": "valve.flwo"})
    with pytest.raises(ModelError, match="commands= names 'folw', which is no input of tank; it has flow"):
        closed_loop(plant, both, {}, readings=readings, commands={"folw": "valve.flow"})
    for source, share in (("law.flow", 1.0), ("valve.flow", 0.5)):
        made = closed_loop(plant, both, {"level": 1.0}, readings=readings, commands={"flow": source})
        compiled = run_batch(Batch(made.text), made.layout, {}, 3)
        over_views = simulate(made, InterpretView(made.truth), InterpretView(made.controller), 3)
        expected, x, u = [], 1.0, 0.0
        for _ in range(3):
            x = 0.9 * x + u
            u = share * x
            expected.append(u)
        np.testing.assert_allclose(compiled.commands[:, 0], expected)
        np.testing.assert_allclose(over_views.commands[:, 0], expected)
