"""The forms of a covariance: the same filter, kept otherwise, and faults that the cross-check sees."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from plantc.codegen import InterpretView, NativeView, Trace, TraceCall, cross_check
from plantc.codegen.crosscheck import make_views
from plantc.codegen.graph import Graph
from plantc.examples.attitude_ekf import bias, imu, q
from plantc.examples.pendulum import pendulum
from plantc.examples.quadrotor_ud import quadrotor_ud
from plantc.reference.factors import factorised, multiplied
from plantc.symbolic import ModelError, Plant, factors
from plantc.symbolic.program import Place, pack_symmetric, packed_index, packed_size

from plantc import extended_kalman_filter

FORMS = ("conventional", "joseph", "ud")
PRECISIONS = ("double", "float")


def chain(size, sensors, *, correlated=False, noise=1e-3):
    """A chain of integrators, of which some states are measured."""
    plant = Plant(f"chain_{size}")
    states = [plant.state(f"x_{i}", range=(-1e4, 1e4)) for i in range(size)]
    push = plant.input("push", range=(-10, 10))
    drift = plant.noise("drift", density=noise)
    plant.dynamics(
        {state: (states[i + 1] if i + 1 < size else push + drift) - 0.1 * state for i, state in enumerate(states)}
    )
    variance = 0.04 * np.eye(len(sensors)) + (0.01 if correlated else 0.0)
    from plantc.symbolic import vertcat

    rows = vertcat(*[states[i] + 0.5 * states[(i + 1) % size] for i in sensors])
    plant.sensor("seen", rows, variance=variance if correlated else 0.04)
    return plant.discretise("rk4", dt=0.05), states


def filter_of(form, size=3, sensors=(0, 2), **options):
    plant, states = chain(size, sensors, **options)
    return extended_kalman_filter(plant, initial_variance=dict.fromkeys(states, 1.0), form=form, name=f"chain_{form}")


def failed(check):
    return {result.name for result in check.failures}


# -- factors ----------------------------------------------------------------------------------------------------------


@st.composite
def definite(draw):
    size = draw(st.integers(1, 6))
    rng = np.random.default_rng(draw(st.integers(0, 10**6)))
    root = rng.normal(size=(size, size)) * 10.0 ** rng.uniform(-2, 2, size=size)
    return root @ root.T + 1e-6 * np.eye(size)


@given(definite())
def test_factors_give_the_matrix_again_by_either_road(matrix):
    size = len(matrix)
    root = np.linalg.cholesky(matrix)
    for packed in (factorised(pack_symmetric(matrix)), factors.factors_of_root(root)):
        again = factors.covariance_of(packed, size)
        scale = np.sqrt(np.outer(np.diag(matrix), np.diag(matrix)))
        np.testing.assert_allclose(again / scale, matrix / scale, atol=1e-9)
        np.testing.assert_allclose(multiplied(packed), pack_symmetric(again), rtol=1e-9, atol=1e-9)


def evaluated(kernel, values):
    """Run a kernel's scalar form as the emitter does, on a graph, and return numbers."""
    graph = Graph()
    nodes = [[graph.load(Place("local", f"v{k}"), i, 0) for i in range(len(array))] for k, array in enumerate(values)]
    table = {node: float(array[i]) for group, array in zip(nodes, values, strict=True) for i, node in enumerate(group)}

    def number(node):
        if isinstance(node, float):
            return node
        if node not in table:
            given = [number(item) for item in node.arguments]
            table[node] = {
                "const": lambda: node.value,
                "add": lambda: given[0] + given[1],
                "sub": lambda: given[0] - given[1],
                "mul": lambda: given[0] * given[1],
                "div": lambda: given[0] / given[1],
                "neg": lambda: -given[0],
                "ge": lambda: given[0] >= given[1],
                "lt": lambda: given[0] < given[1],
                "select": lambda: given[1] if given[0] else given[2],
            }[node.operation]()
        return table[node]

    return [[None if item is None else number(item) for item in group] for group in kernel.scalar(*nodes)]


@given(st.integers(1, 5), st.integers(0, 10**6))
def test_the_time_update_is_the_congruence(size, seed):
    rng = np.random.default_rng(seed)
    pattern = tuple((i, j) for i in range(size) for j in range(size) if i == j or rng.random() < 0.5)
    noisy = tuple((i, j) for i in range(size) for j in range(i, size))
    f = rng.normal(size=len(pattern))
    root = rng.normal(size=(size, size))
    half = rng.normal(size=(size, max(1, size - 1)))  # Q is singular where size > 1
    Q = half @ half.T
    kernel = factors.FactoredCongruence(
        size, Place("local", "f"), pattern, Place("memory", "p"), Place("local", "q"), noisy, Place("next", "p")
    )
    given_ = factors.factors_of_root(root)
    F = np.zeros((size, size))
    for (i, j), value in zip(pattern, f, strict=True):
        F[i, j] = value
    wanted = F @ factors.covariance_of(given_, size) @ F.T + Q
    values = [f, given_, np.array([Q[i, j] for i, j in noisy])]
    scale = 1 + np.max(np.abs(wanted))
    for answer in (evaluated(kernel, values)[0], kernel.dense(*values)[0]):
        np.testing.assert_allclose(factors.covariance_of(np.array(answer), size), wanted, atol=1e-8 * scale)


@given(st.integers(1, 5), st.integers(0, 10**6))
def test_the_measurement_update_is_that_of_a_textbook(size, seed):
    rng = np.random.default_rng(seed)
    row = rng.normal(size=size) * (rng.random(size) < 0.7)
    row[int(rng.integers(size))] = 1.0
    pattern = tuple((0, j) for j in range(size) if row[j] != 0)
    packed, r, e = factors.factors_of_root(rng.normal(size=(size, size))), 0.3, 0.7
    kernel = factors.FactoredRowUpdate(
        size, 0, Place("local", "residual"), 1, Place("local", "h"), pattern, Place("local", "r"), 1,
        Place("memory", "p"), Place("next", "p"),
    )  # fmt: skip
    P = factors.covariance_of(packed, size)
    s = row @ P @ row + r
    values = [np.array([e]), row[row != 0], np.array([r]), packed]
    for answer in (evaluated(kernel, values), kernel.dense(*values)):
        after, delta, nis, variance = (np.array(item, dtype=float) for item in answer)
        np.testing.assert_allclose(factors.covariance_of(after, size), P - np.outer(P @ row, P @ row) / s, atol=1e-9)
        np.testing.assert_allclose(delta, P @ row * e / s, atol=1e-9)
        assert nis[0] == pytest.approx(e * e / s)
        assert variance[0] == pytest.approx(s)


# -- filters ----------------------------------------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("form", ["joseph", "ud"])
@pytest.mark.parametrize(
    ("size", "sensors", "correlated"), [(1, (0,), False), (3, (0, 2), False), (4, (0, 1, 3), True)]
)
def test_all_views_agree(form, precision, size, sensors, correlated):
    check = cross_check(filter_of(form, size, sensors, correlated=correlated), precision, steps=40)
    assert check.passed, check.failures[0]


@pytest.mark.slow
@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("form", ["joseph", "ud"])
def test_an_attitude_in_each_form(form, precision):
    block = extended_kalman_filter(
        imu.discretise("euler", dt=(1e-4, 0.1)),
        initial_variance={q: 0.04, bias: 1e-4},
        variance_ceiling={bias: 1.0},
        form=form,
    )
    check = cross_check(block, precision, steps=40)
    assert check.passed, check.failures[0]


@pytest.mark.slow
def test_the_quadrotor_in_ud_form_passes_in_double_too():
    check = cross_check(quadrotor_ud, steps=40)
    assert check.passed, check.failures[0]


def run(form, calls):
    return NativeView(filter_of(form, 4, (0, 2))).run(Trace("noise", calls))


def test_the_forms_are_one_filter():
    rng = np.random.default_rng(3)
    calls = [
        TraceCall("step", {"push": rng.normal(), "has_seen": bool(k % 3), "seen": rng.normal(size=2)})
        for k in range(120)
    ]
    plain, joseph, ud = (run(form, calls) for form in FORMS)
    for name in ("x_0", "x_3"):
        np.testing.assert_allclose(joseph.column(name), plain.column(name), rtol=1e-9, atol=1e-9)
        np.testing.assert_allclose(ud.column(name), plain.column(name), rtol=1e-9, atol=1e-9)
    again = np.array([multiplied(item) for item in ud.column("factors")])
    np.testing.assert_allclose(again, plain.column("covariance"), rtol=1e-8, atol=1e-10)


def test_a_thousand_careless_steps_in_single_precision_leave_d_positive():
    plant, states = chain(4, (0, 1), noise=1e-9)
    block = extended_kalman_filter(plant, initial_variance=dict.fromkeys(states, 1e5), form="ud")
    view = NativeView(block, "float")
    params = view.params(variance_seen=np.full(2, 1e-9))
    rng = np.random.default_rng(0)
    memory = view.init(params)
    diagonal = [packed_index(4, i, i) for i in range(4)]
    for _ in range(1000):
        inputs = {"push": rng.uniform(-1, 1), "has_seen": rng.random() < 0.7, "seen": rng.uniform(-1, 1, size=2)}
        memory = view.call("step", memory, view.inputs("step", inputs), params).memory
        assert np.all(memory["factors"][diagonal] > 0)


def test_inflate_scales_d_and_leaves_u():
    view = InterpretView(filter_of("ud"))
    memory = view.memory(factors=factors.factors_of_root(np.array([[1.0, 0.5, 0.2], [0, 2.0, 0.3], [0, 0, 0.7]])))
    after = view.call("inflate", memory, view.inputs("inflate", {"factor": 9.0}), view.params()).memory
    again = factors.covariance_of(after["factors"], 3)
    np.testing.assert_allclose(again, 9 * factors.covariance_of(memory["factors"], 3))


def test_an_unknown_form_is_refused_in_a_sentence():
    with pytest.raises(
        ModelError, match="the form 'cholesky' is not known; take one of 'conventional', 'joseph', 'ud'"
    ):
        filter_of("cholesky")


def test_pendulum_keeps_its_name_and_memory_by_default():
    block = extended_kalman_filter(pendulum.discretise("euler", dt=0.01), initial_variance={"theta": 1.0, "omega": 1.0})
    assert [signal.name for signal in block.memory_signals][:3] == ["theta", "omega", "covariance"]
    assert len(block.memory_signals[2].low) == packed_size(2)


# -- planted faults ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("fault", ["gain", "loss", "time"])
def test_a_fault_in_a_factored_kernel_is_caught(monkeypatch, fault):
    if fault == "time":
        original = factors._triangularised

        def wrong(*arguments):
            answer = original(*arguments)
            answer[1] = -answer[1]
            return answer

        monkeypatch.setattr(factors, "_triangularised", wrong)
    else:
        original = factors.FactoredRowUpdate.scalar

        def wrong(self, *values):
            answer = original(self, *values)
            if fault == "gain":
                answer[1][0] = -answer[1][0]
            else:
                answer[0][1] = answer[0][1] + answer[0][1]
            return answer

        monkeypatch.setattr(factors.FactoredRowUpdate, "scalar", wrong)
    block = filter_of("ud")
    assert {"native = reference", "native = interpret"} <= failed(
        cross_check(block, steps=30, views=make_views(block, "double"))
    )
