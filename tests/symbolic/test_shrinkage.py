"""Weights as numbers (the same doubles on any machine) and as expressions, beside NumPy's eigenvalues."""

import casadi as ca
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from plantc.symbolic import ModelError
from plantc.symbolic.shrinkage import (
    cholesky,
    constant_weights,
    largest_eigenvalue,
    reduced,
    shape_of,
    weight_of,
    whitened,
)


def textbook(C, Pi):
    """n*, c, and x_ML - x- by NumPy."""
    white = np.linalg.solve(Pi, C)
    inverse = np.linalg.svd(white, compute_uv=False) ** -2.0
    effective = np.sum(inverse) / np.max(inverse)
    c = max(0.0, min(C.shape[1] - 2, 2 * (effective - 2)))
    return effective, c, np.linalg.pinv(white) @ np.linalg.inv(Pi), white


@given(st.integers(0, 10**6))
def test_constant_weights_beside_numpy(seed):
    rng = np.random.default_rng(seed)
    m = int(rng.integers(1, 8))
    n = int(rng.integers(1, m + 1))
    C, Pi = rng.normal(size=(m, n)), np.eye(m) + 0.2 * rng.normal(size=(m, m))
    made = constant_weights("block", "sensor", C, shape_of(Pi))
    effective, c, L, white = textbook(C, Pi)
    scale = np.linalg.cond(white)
    assert made.effective_dimension == pytest.approx(effective, rel=1e-13 * scale)
    assert made.shrink == pytest.approx(c, rel=1e-13 * scale, abs=1e-13 * scale)
    np.testing.assert_allclose(made.solve @ made.whiten, L, atol=1e-13 * scale * np.abs(L).max())
    residual = rng.normal(size=m)
    b = made.whiten @ residual
    assert b @ b == pytest.approx(np.sum((white @ L @ residual) ** 2), rel=1e-12 * scale)


def test_weights_of_a_state_measured_directly_are_exact():
    made = constant_weights("block", "sensor", np.eye(12), shape_of(np.eye(12)))
    assert (made.effective_dimension, made.shrink) == (12.0, 10.0)
    np.testing.assert_array_equal(made.whiten, np.eye(12))
    np.testing.assert_array_equal(made.solve, np.eye(12))


def test_weights_are_the_doubles_nearest_to_the_truth():
    """C = [[3]], Pi = [[7]]: D2 = (3/7 e)^2, e = y / 3, correctly rounded though neither is a short decimal."""
    made = constant_weights("block", "sensor", np.array([[3.0]]), shape_of(np.array([[7.0]])))
    assert made.whiten[0, 0] == 1 / 7
    assert made.solve[0, 0] == 7 / 3


@pytest.mark.parametrize(("C", "rank"), [(np.ones((3, 3)), 1), (np.ones((1, 2)), 1), (np.zeros((2, 2)), 0)])
def test_a_low_rank_is_refused_with_both_numbers(C, rank):
    with pytest.raises(ModelError, match=rf"rank {rank} and the state n = {C.shape[1]}"):
        constant_weights("block", "sensor", C, shape_of(np.eye(len(C))))


def test_a_low_rank_may_correct_where_it_sees():
    rng = np.random.default_rng(3)
    C = rng.normal(size=(7, 4)) @ rng.normal(size=(4, 6))
    Pi = np.eye(7) + 0.2 * rng.normal(size=(7, 7))
    made = constant_weights("block", "sensor", C, shape_of(Pi), reduce=True)
    U, singular, Vt = np.linalg.svd(np.linalg.solve(Pi, C))
    singular = singular[:4]
    assert made.effective_dimension == pytest.approx(np.sum(singular**-2) / np.max(singular**-2), rel=1e-9)
    residual = rng.normal(size=7)
    seen = U[:, :4].T @ np.linalg.solve(Pi, residual)
    b = made.whiten @ residual
    assert b @ b == pytest.approx(seen @ seen, rel=1e-10)
    np.testing.assert_allclose(made.solve @ b, Vt[:4].T @ (seen / singular), rtol=1e-9, atol=1e-12)
    assert Vt[4:] @ (made.solve @ b) == pytest.approx(0, abs=1e-12)


def test_a_singular_shape_is_refused():
    with pytest.raises(ModelError, match="singular shape"):
        constant_weights("block", "sensor", np.eye(2), shape_of(np.ones((2, 2))))


def test_a_bad_condition_is_warned_of_and_still_accurate():
    C = np.array([[1.0, 1.0], [1.0, 1.0 + 2.0**-42]])
    with pytest.warns(UserWarning, match="hardly tells some states apart"):
        made = constant_weights("block", "sensor", C, shape_of(np.eye(2)))
    # the inverse in exact arithmetic
    exact = 2.0**42 * np.array([[1 + 2.0**-42, -1.0], [-1.0, 1.0]])
    np.testing.assert_allclose(made.solve @ made.whiten, exact, rtol=1e-3)
    b = made.whiten @ np.array([1.0, 2.0])
    assert b @ b == pytest.approx(5.0, rel=1e-12)


# -- expressions ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("n", [3, 5, 8])
def test_the_largest_eigenvalue_to_its_stated_accuracy(n):
    symbol = ca.SX.sym("M", n, n)
    function = ca.Function("f", [symbol], [largest_eigenvalue([[symbol[i, j] for j in range(n)] for i in range(n)])])
    rng = np.random.default_rng(n)
    for k in range(200):
        turn = np.linalg.qr(rng.normal(size=(n, n)))[0] if k % 4 else np.eye(n)
        values = 10.0 ** rng.uniform(-12, 0, n)
        if k % 3 == 0:
            values[: n // 2] = np.max(values)  # a cluster at the top: bisection does not care
        if k == 0:
            values[:] = 1.0
        matrix = turn @ np.diag(values) @ turn.T
        matrix /= np.trace(matrix)
        assert float(function(matrix)) == pytest.approx(np.linalg.eigvalsh(matrix)[-1], abs=2.0**-45 + 2e-15)


@given(st.integers(0, 10**6))
def test_expressions_beside_numbers(seed):
    rng = np.random.default_rng(seed)
    m, n = 5, 4
    C, Pi, residual = rng.normal(size=(m, n)), np.eye(m) + 0.2 * rng.normal(size=(m, m)), rng.normal(size=m)
    root, pivot = cholesky(ca.SX(ca.DM(Pi @ Pi.T)))
    made = reduced(whitened(root, ca.SX(ca.DM(C))), whitened(root, ca.SX(ca.DM(residual))))
    effective, _, L, white = textbook(C, Pi)
    scale = np.linalg.cond(white)
    np.testing.assert_allclose(np.array(ca.DM(made.solution())).ravel(), L @ residual, atol=1e-13 * scale**2)
    assert float(ca.sumsqr(made.seen)) == pytest.approx(np.sum((white @ L @ residual) ** 2), rel=1e-12 * scale)
    assert float(ca.sumsqr(made.image(made.solution()))) == pytest.approx(float(ca.sumsqr(made.seen)), rel=1e-12)
    assert float(made.effective_dimension()) == pytest.approx(effective, rel=1e-12 * scale)
    own = np.diag(np.linalg.qr(white, mode="r")) ** 2
    assert float(made.pivot) == pytest.approx(np.min(own / np.sum(white**2, axis=0)), rel=1e-9)
    assert float(pivot) > 0


def test_a_dependent_column_leaves_no_pivot():
    C = np.array([[1.0, 2, 3], [4, 5, 9], [7, 8, 15.0], [1, 0, 1]])
    made = reduced(ca.SX(ca.DM(C)), ca.SX.zeros(4))
    assert float(made.pivot) < 1e-12


@pytest.mark.parametrize(
    ("D2", "r", "c", "gamma", "expected"),
    [
        (0.0, 0.3, 5.0, None, 0.0),
        (0.0, 0.0, 5.0, None, 1.0),
        (2.0, 0.0, 5.0, None, 1.0),
        (2.0, 0.0, 5.0, 1e-30, 0.0),
        (2.0, 0.0, 5.0, 0.0, 1.0),
        (2.0, 0.5, 5.0, None, 0.375),
        (1.0, 0.5, 5.0, None, 0.0),
        (0.0, 0.3, 0.0, 0.09, np.exp(-1)),
        (2.0, 1e-20, 0.0, 0.15, 0.0),
        (2.0, 0.01, 0.0, 0.15, 0.0),
        (1e-300, 0.0, 3.0, None, 1.0),
    ],
)
def test_edges_of_the_weight(D2, r, c, gamma, expected):
    value = weight_of(ca.SX(D2), ca.SX(r), c, None if gamma is None else ca.SX(gamma))
    assert float(ca.DM(value)) == pytest.approx(expected, rel=1e-15)
