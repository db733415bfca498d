"""The James-Stein estimators of the quadrotor, compiled: the closed loop of specs/meda2018.md, section 10.1(e)."""

import casadi as ca
import numpy as np
import pytest
from plantc.codegen import TraceCall
from plantc.codegen.layout import flatten
from plantc.examples.quadrotor_ekf import hover, sampled
from plantc.examples.quadrotor_james_stein import quadrotor_jsse, quadrotor_jssem
from plantc.symbolic.discretisation import transition

from plantc import NativeView, ReferenceView, Trace, cross_check

NAMES = [state.signal.name for state in sampled.states]
X_O = np.eye(12)[4] * 30
# (44), printed row by row: states 1, 5, 9; 2, 6, 10; 3, 7, 11; 4, 8, 12
F44 = np.array(
    """
    -25.0 411.0 -8.9 399.0 199.0 200.0 199.0 200.0 28.0 844.0 97.0 766.0
    -4.3 333.0 13.0 311.0 93.0 95.0 93.0 95.0 3.4 71.0 15.0 58.0
    -311.0 -20.0 -322.0 -32.0 711.0 59.0 766.0 122.0 177.0 -188.0 177.0 -188.0
    -277.0 -22.0 -299.0 -37.0 56.0 2.9 67.0 14.0 74.0 -76.0 74.0 -76.0
    """.split(),
    dtype=float,
).reshape(4, 3, 4).transpose(1, 0, 2).reshape(12, 4)  # fmt: skip
TRUTH = ca.Function("f", [sampled.x, sampled.u], [transition(sampled)[0]])

ENDS = {
    "jsse": (
        quadrotor_jsse,
        "0.004798951027 -0.007386420423 -0.007622697829 -0.02491372572 30.0015105 -0.1430212219 0.01227751616 "
        "-0.3362319007 0.006435722226 0.1488539086 -0.0009163177882 -0.4496944095",
        "0.03107905555 -0.02802782561 0.01940308387 -0.04803161965 30.02171602 -0.1205978182 0.006502505353 "
        "-0.3497035376 -0.01766559741 0.1232372934 0.05949926951 -0.4815145956",
        (0.137665014, 0.007973619903, 0.1286553669),
    ),
    "jssem": (
        quadrotor_jssem,
        "-0.1094386909 0.1722806229 0.1999737376 -0.1468004384 30.06126002 -0.008333339109 0.01984895191 -0.01680691703 "
        "0.01840083195 -0.007917896753 -0.001081704538 -0.0006399699397",
        "-0.06347313282 0.05867323231 0.08781805847 -0.08773402624 30.05114351 -0.01820656058 -0.0005505666065 "
        "-0.03083935733 -0.004595804298 -0.02277263901 -0.01321904014 -0.01690503143",
        (0.01447442438, 0.05081140717, 0.0969069035),
    ),
}


def closed_loop(view, r, steps=100, **params):
    """Return the last truth and estimate, and MSE45, ERR, REG."""
    params = view.params(std_pose=r, **params)
    memory = view.init(params)
    x, estimate, i = X_O + 0.05 * (-1.0) ** np.arange(1, 13), X_O.copy(), np.arange(1, 13)
    sums = np.zeros(3)
    for k in range(1, steps + 1):
        u = hover - F44.T @ (estimate - X_O)
        w = 1e-3 * np.sqrt(2) * np.sin(1.1 * k * i + 2.3 * i + 0.5)
        v = r * np.sqrt(2) * np.sin(1.7 * k * i + 0.7 * i**2 + 0.2)
        x = np.array(TRUTH(x, u)).ravel() + w
        inputs = {f"rotor_{j + 1}": u[j] for j in range(4)} | {"has_pose": True, "pose": x + v}
        answer = view.call("step", memory, view.inputs("step", inputs), params)
        assert answer.status == 0
        memory = answer.memory
        estimate = np.array([memory[name] for name in NAMES])
        sums += [np.sum((X_O - estimate) ** 2), np.sum((x - estimate) ** 2), np.sum((x - X_O) ** 2)]
    return x, estimate, sums / steps


@pytest.mark.parametrize("which", ENDS)
@pytest.mark.parametrize("kind", [NativeView, ReferenceView])
def test_the_closed_loop_of_section_10_1e(which, kind):
    block, true_end, estimate_end, metrics = ENDS[which]
    params = {"gamma_pose": 0.01} if which == "jssem" else {}
    x, estimate, means = closed_loop(kind(block), 0.05, **params)
    np.testing.assert_allclose(x, [float(item) for item in true_end.split()], atol=1e-7)
    np.testing.assert_allclose(estimate, [float(item) for item in estimate_end.split()], atol=1e-7)
    np.testing.assert_allclose(means, metrics, rtol=1e-7)


def test_without_gamma_the_modified_form_is_the_plain_one_bit_for_bit():
    views = [NativeView(quadrotor_jsse), NativeView(quadrotor_jssem)]
    rng = np.random.default_rng(0)
    for r in (0.0, 1e-20, 0.05, 0.1, 3.0):
        params = [views[0].params(std_pose=r), views[1].params(std_pose=r, gamma_pose=0.0)]
        memories = [view.init(own) for view, own in zip(views, params, strict=True)]
        for k in range(40):
            inputs = {f"rotor_{i}": hover + rng.normal() for i in (1, 2, 3, 4)}
            inputs |= {"has_pose": k % 7 > 0, "pose": X_O + max(r, 0.01) * rng.normal(size=12)}
            answers = [
                view.call("step", memory, view.inputs("step", inputs), own)
                for view, memory, own in zip(views, memories, params, strict=True)
            ]
            memories = [answer.memory for answer in answers]
            first, second = (flatten(answer.memory) | flatten(answer.outputs) for answer in answers)
            assert {k: np.asarray(v).tobytes() for k, v in first.items()} == {
                k: np.asarray(v).tobytes() for k, v in second.items()
            }


@pytest.mark.parametrize(("block", "precision"), [(quadrotor_jsse, "float"), (quadrotor_jssem, "double")])
def test_the_views_agree(block, precision):
    check = cross_check(block, precision, steps=60)
    assert check.passed, check.failures


def test_without_noise_the_estimate_is_the_reading():
    """C = I, r = 0: whatever the prediction was."""
    view = NativeView(quadrotor_jsse)
    params = view.params(std_pose=0.0)
    pose = X_O + 0.3
    memory = view.init(params)
    inputs = {f"rotor_{i}": hover for i in (1, 2, 3, 4)} | {"has_pose": True, "pose": pose}
    answer = view.call("step", memory, view.inputs("step", inputs), params)
    np.testing.assert_allclose([answer.memory[name] for name in NAMES], pose, rtol=1e-15, atol=1e-15)


def test_the_published_gamma_ignores_the_reading():
    """Erratum E9: at r = 0.1 and gamma = 0.15 the weight is 3e-7 at most, which is an open loop."""
    view = NativeView(quadrotor_jssem)
    params = view.params()
    calls = [
        TraceCall("step", {f"rotor_{i}": hover for i in (1, 2, 3, 4)} | {"has_pose": True, "pose": X_O + 5.0})
        for _ in range(3)
    ]
    weights = view.run(Trace("far", calls)).column("pose.weight")
    assert float(params["gamma_pose"]) == 0.15
    assert np.max(weights) == pytest.approx(np.exp(-15), rel=0.01)


def test_the_modified_form_tends_to_the_plain_one_with_much_noise():
    weights = []
    for r in (0.1, 1.0, 5.0):
        pair = []
        for block in (quadrotor_jsse, quadrotor_jssem):
            view = NativeView(block)
            params = view.params(std_pose=r)
            inputs = view.inputs("update_pose", {"pose": X_O + 5 * r})
            pair.append(float(view.call("update_pose", view.init(params), inputs, params).outputs["weight"]))
        weights.append(pair[1] / pair[0])
    np.testing.assert_allclose(weights, np.exp([-15, -0.15, -0.006]), rtol=1e-12)
