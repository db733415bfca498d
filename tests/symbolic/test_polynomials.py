"""Polynomials as expressions with few operations."""

import casadi as ca
import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from plantc.symbolic.expressions import tape
from plantc.symbolic.polynomials import polynomials

EXPONENTS = st.tuples(st.integers(0, 4), st.integers(0, 3), st.integers(0, 2))


def operations(expression):
    record = tape(ca.Function("count", ca.symvar(expression), [expression]))
    return sum(step.operation not in ("input", "const") for step in record.steps)


@given(rows=st.lists(st.dictionaries(EXPONENTS, st.floats(-2, 2), max_size=8), min_size=1, max_size=3))
def test_they_are_the_sums_of_their_terms(rows):
    w, point = ca.SX.sym("w", 3), np.array([0.7, -1.3, 0.4])
    made = polynomials([{key: ca.SX(value) for key, value in row.items()} for row in rows], w)
    wanted = [sum(value * np.prod(point ** np.array(key)) for key, value in row.items()) for row in rows]
    assert made.shape == (len(rows), 1)
    np.testing.assert_allclose(np.array(ca.Function("f", [w], [made])(point)).ravel(), wanted, atol=1e-12)


def test_the_shorter_form_is_taken():
    w, c = ca.SX.sym("w", 2), ca.SX.sym("c", 40)
    line = {(k, 0): c[k] for k in range(8)}
    assert operations(polynomials([line], w)) == 14  # Horner: a product and a sum for each degree
    rows = [{(i, j): c[8 * k + 3 * i + j] for i in range(3) for j in range(3) if i + j} for k in range(4)]
    assert operations(polynomials(rows, w)) <= 4 * 15 + 7  # seven monomials, shared by all rows


def test_nothing_and_a_constant():
    w = ca.SX.sym("w", 2)
    assert polynomials([], w).shape == (0, 1)
    found = ca.Function("f", [w], [polynomials([{}, {(0, 0): ca.SX(3.0)}], w)])([1.0, 2.0])
    np.testing.assert_array_equal(np.array(found).ravel(), [0, 3])
