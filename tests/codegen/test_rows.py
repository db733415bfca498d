"""The update by a sensor of all states, two rows at a time: against the rows one after another, and a planted fault."""

import dataclasses

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from plantc.codegen.crosscheck import make_views
from plantc.codegen.emit import emit
from plantc.codegen.rows import pair_operations
from plantc.symbolic import sin, vertcat
from plantc.symbolic.kernels import AllStatesUpdate
from plantc.symbolic.program import walk

from plantc import NativeView, Plant, cross_check, extended_kalman_filter


def chain(n, order=None):
    """A chain of n states of which all are measured at once."""
    plant = Plant("chain")
    states = [plant.state(f"x{k}", range=(-100, 100)) for k in range(n)]
    push = plant.input("push", range=(-1, 1))
    plant.dynamics({x: (states[k + 1] if k + 1 < n else push - sin(states[0])) for k, x in enumerate(states)})
    measured = [states[k] for k in (order or range(n))]
    plant.sensor("all", vertcat(*measured), variance=[0.01 * (k + 1) for k in range(n)], range=(-200, 200))
    discrete = plant.discretise("euler", dt=0.02).step_noise({x: 1e-4 for x in states})
    return extended_kalman_filter(discrete, initial_variance={x: 0.1 for x in states})


def uses_pairs(block):
    return any(isinstance(item, AllStatesUpdate) for item in walk(block.entries["update_all"].body))


@pytest.mark.slow
@pytest.mark.parametrize("precision", ["double", "float"])
@pytest.mark.parametrize("n", [4, 6, 8])
def test_all_views_agree(n, precision):
    block = chain(n)
    assert uses_pairs(block)
    check = cross_check(block, precision, steps=40)
    assert check.passed, [str(item) for item in check.failures]


@pytest.mark.parametrize(("n", "order"), [(2, None), (3, None), (5, None), (4, [1, 0, 2, 3])])
def test_other_sensors_take_their_rows_one_by_one(n, order):
    block = chain(n, order)
    assert not uses_pairs(block)
    assert cross_check(block, steps=30).passed


@given(seed=st.integers(0, 10**6))
@settings(max_examples=30)
def test_it_is_the_batch_update(seed):
    rng = np.random.default_rng(seed)
    view = VIEW
    params = view.params()
    factor = rng.normal(size=(6, 8))
    P = factor @ factor.T
    x, z = rng.normal(size=6), rng.normal(size=6)
    memory = view.memory(covariance=P[np.triu_indices(6)], **{f"x{k}": x[k] for k in range(6)})
    answer = view.call("update_all", memory, view.inputs("update_all", {"all": z}), params)
    S = P + np.diag(np.asarray(params["variance_all"]))
    expected = P - P @ np.linalg.solve(S, P)
    np.testing.assert_allclose(answer.memory["covariance"], expected[np.triu_indices(6)], rtol=1e-7, atol=1e-10)
    moved = x + P @ np.linalg.solve(S, z - x)
    np.testing.assert_allclose([float(answer.memory[f"x{k}"]) for k in range(6)], moved, rtol=1e-8, atol=1e-10)
    assert answer.outputs["nis"] == pytest.approx((z - x) @ np.linalg.solve(S, z - x), rel=1e-8)


VIEW = NativeView(chain(6))


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("work->row_a[1] = (n_3 * minus_r_a) + (b_3 * k_0);", "work->row_a[1] = (n_3 * minus_r_a) - (b_3 * k_0);"),
        ("= work->row_a[2];", "= work->row_a[1];"),
        ("work->nis = nis - (", "work->nis = nis + ("),
    ],
)
def test_a_fault_in_the_helpers_is_caught(right, wrong):
    block = chain(6)
    text = emit(block)
    assert right in text.source
    faulty = dataclasses.replace(text, source=text.source.replace(right, wrong))
    views = make_views(block, "double", NativeView(block, text=faulty))
    check = cross_check(block, views=views, steps=40)
    assert "native = reference" in {item.name for item in check.failures}


def test_the_operations_are_counted_in_the_text():
    assert pair_operations(12)["division"] == 12
    assert pair_operations(12)["multiplication"] == 1254
