"""Estimator and printed state feedback in one block: the closed loop of specs/meda2018.md, section 10.1(e), in C."""

from dataclasses import replace

import casadi as ca
import numpy as np
import pytest
from plantc.codegen.crosscheck import make_views
from plantc.codegen.layout import flatten
from plantc.examples import quadrotor_controllers as controllers
from plantc.examples.quadrotor_controllers import feedback, printed_gain
from plantc.examples.quadrotor_ekf import hover, sampled
from plantc.examples.quadrotor_james_stein import quadrotor_jsse
from plantc.symbolic.discretisation import transition

from plantc import NativeView, ReferenceView, connect, cross_check, emit, wires

NAMES = [state.signal.name for state in sampled.states]
ROTORS = [symbol.signal.name for symbol in sampled.inputs]
X_O = np.eye(12)[4] * 30
TRUTH = ca.Function("f", [sampled.x, sampled.u], [transition(sampled)[0]])

# x_N, x+_N, and MSE45, ERR, REG, as section 10.1(e) prints them
ENDS = {
    "kf": (
        "0.03573159475 0.005047293446 -0.05498450452 0.003694519054 29.96447733 -0.02958716735 -0.0008668377581 "
        "-0.03895169246 -0.001542361076 -0.0008286091748 0.01552325863 -0.03811895492",
        "0.03717780521 -0.003088560355 -0.05503635026 0.001174588742 29.96315985 -0.03856543114 -0.002337576424 "
        "-0.04863366172 -0.005614954358 -0.01162184703 0.02496398231 -0.04533404974",
        (0.05302368568, 0.002895278082, 0.05690928144),
    ),
    "ekf": (
        "-0.008536532986 0.008827556118 -0.001937207118 -0.005258865354 30.00221336 -0.02966842987 0.001202832832 "
        "-0.04391605094 -0.0009526354312 -0.004087654359 -0.003315852952 -0.04368804805",
        "-0.006927110381 0.006894876945 -0.002241272904 -0.0161568893 30.00387817 -0.03246977553 0.003734578313 "
        "-0.04255812147 -0.001719929443 -0.004867032974 0.009323277675 -0.04415204267",
        (0.04287550965, 0.001183703239, 0.0449243778),
    ),
    "jsse": (
        "0.004798951027 -0.007386420423 -0.007622697829 -0.02491372572 30.0015105 -0.1430212219 0.01227751616 "
        "-0.3362319007 0.006435722226 0.1488539086 -0.0009163177882 -0.4496944095",
        "0.03107905555 -0.02802782561 0.01940308387 -0.04803161965 30.02171602 -0.1205978182 0.006502505353 "
        "-0.3497035376 -0.01766559741 0.1232372934 0.05949926951 -0.4815145956",
        (0.137665014, 0.007973619903, 0.1286553669),
    ),
    "jssem": (
        "-0.1094386909 0.1722806229 0.1999737376 -0.1468004384 30.06126002 -0.008333339109 0.01984895191 -0.01680691703 "
        "0.01840083195 -0.007917896753 -0.001081704538 -0.0006399699397",
        "-0.06347313282 0.05867323231 0.08781805847 -0.08773402624 30.05114351 -0.01820656058 -0.0005505666065 "
        "-0.03083935733 -0.004595804298 -0.02277263901 -0.01321904014 -0.01690503143",
        (0.01447442438, 0.05081140717, 0.0969069035),
    ),
}  # fmt: skip
NEAR = {"double": 1e-7, "float": 5e-5}
"""What section 10.1(e) asks for; and a hundred steps in single precision, 12 states of up to 30."""

OWN = {
    "kf": {"estimator__variance_pose": np.full(12, 0.05**2)},
    "ekf": {"estimator__variance_pose": np.full(12, 0.05**2), "estimator__gate_pose": 0.0},
    "jsse": {"estimator__std_pose": 0.05},
    "jssem": {"estimator__std_pose": 0.05, "estimator__gamma_pose": 0.01},
}


def controller(which):
    return getattr(controllers, f"quadrotor_{which}_controller")


def closed_loop(view, own, told=None, steps=100, r=0.05):
    """Return the last truth and estimate, and MSE45, ERR, REG; a controller's answer is applied one step later.

    `told` takes all that was applied so far, and says what a controller without wires back is told of it.
    """
    params = view.params(**own)
    memory = view.init(params)
    x, i = X_O + 0.05 * (-1.0) ** np.arange(1, 13), np.arange(1, 13)
    applied = [np.full(4, hover)] * 2
    sums = np.zeros(3)
    for k in range(1, steps + 1):
        w = 1e-3 * np.sqrt(2) * np.sin(1.1 * k * i + 2.3 * i + 0.5)
        v = r * np.sqrt(2) * np.sin(1.7 * k * i + 0.7 * i**2 + 0.2)
        x = np.array(TRUTH(x, applied[-1])).ravel() + w
        inputs = {"estimator_has_pose": True, "estimator_pose": x + v}
        if told is not None:
            inputs |= {f"estimator_{name}": value for name, value in zip(ROTORS, told(applied), strict=True)}
        answer = view.call("step", memory, view.inputs("step", inputs), params)
        assert answer.status == 0
        memory, values = answer.memory, flatten(answer.memory)
        estimate = np.array([values[f"estimator.{name}"].item() for name in NAMES])
        applied.append(np.array([float(answer.outputs["feedback"][name]) for name in ROTORS]))
        sums += [np.sum((X_O - estimate) ** 2), np.sum((x - estimate) ** 2), np.sum((x - X_O) ** 2)]
    return x, estimate, sums / steps


def numbers(text):
    return np.array([float(item) for item in text.split()])


def test_the_printed_gain_is_that_of_section_4():
    assert printed_gain.shape == (4, 12)
    assert np.linalg.norm(printed_gain) == pytest.approx(1921.778778, rel=1e-9)


@pytest.mark.parametrize("precision", NEAR)
@pytest.mark.parametrize("which", ENDS)
def test_the_closed_loop_of_section_10_1e(which, precision):
    x, estimate, means = closed_loop(NativeView(controller(which), precision), OWN[which])
    true_end, estimate_end, metrics = ENDS[which]
    near = NEAR[precision]
    np.testing.assert_allclose(x, numbers(true_end), rtol=0, atol=near)
    np.testing.assert_allclose(estimate, numbers(estimate_end), rtol=0, atol=near)
    np.testing.assert_allclose(means, metrics, rtol=near)


def test_the_references_composed_along_the_wires_fly_it_too():
    x, _, means = closed_loop(ReferenceView(controller("jsse")), OWN["jsse"])
    np.testing.assert_allclose(x, numbers(ENDS["jsse"][0]), atol=1e-7)
    np.testing.assert_allclose(means, ENDS["jsse"][2], rtol=1e-7)


TOLD = {
    "what was applied": lambda applied: applied[-1],
    "a step later": lambda applied: applied[-2],
    "nothing, it goes on with hover": lambda applied: applied[0],
    "other rotors": lambda applied: applied[-1][::-1],
}


@pytest.mark.parametrize("told", TOLD)
def test_an_estimator_that_is_told_anything_but_what_was_applied_is_seen(told):
    """The planted faults of the wires that go back: a controller without them, told by hand."""
    block = connect(
        {"estimator": quadrotor_jsse, "feedback": feedback}, wires("estimator", "feedback", sampled.states), "untold"
    )
    x, _, _ = closed_loop(ReferenceView(block), OWN["jsse"], told=TOLD[told])
    assert np.allclose(x, numbers(ENDS["jsse"][0]), rtol=0, atol=1e-7) == (told == "what was applied")


def test_a_first_command_that_is_not_the_one_applied_is_seen():
    own = OWN["jsse"] | {f"delay_estimator_{name}_0": 0.9 * hover for name in ROTORS}
    x, _, _ = closed_loop(ReferenceView(controller("jsse")), own)
    assert not np.allclose(x, numbers(ENDS["jsse"][0]), rtol=0, atol=1e-7)


OLD, APPLIED = "before->delay_estimator_rotor_1,", "after->delay_estimator_rotor_1 = out->feedback.rotor_1;"
IN_C = {
    "the speed of another rotor comes back": (OLD, OLD.replace("rotor_1", "rotor_2")),
    "hover comes back": (OLD, "212.718305490559,"),
    "what comes back is never written": (APPLIED, APPLIED.replace("out->feedback.", "before->delay_estimator_")),
}


@pytest.mark.parametrize("fault", IN_C)
def test_a_wrong_wire_in_the_c_fails_the_cross_check(fault):
    block, text = controller("jsse"), emit(controller("jsse"))
    right, wrong = IN_C[fault]
    assert text.source.count(right) == 1
    native = NativeView(block, text=replace(text, source=text.source.replace(right, wrong)))
    found = cross_check(block, views=make_views(block, "double", native), steps=20)
    assert "native = reference" in {result.name for result in found.failures}
