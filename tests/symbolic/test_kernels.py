"""The scalar form of every kernel, run on plain numbers, beside its dense form; and the batch update beside both."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from plantc.symbolic.kernels import (
    Congruence,
    Decorrelate,
    InnovationVariance,
    Pivots,
    RowUpdate,
    Scale,
)
from plantc.symbolic.program import Place, pack_symmetric, packed_index, packed_size, unpack_symmetric


class Number:
    """A plain number with just what a kernel's scalar form may use of the emitter's graph nodes."""

    def __init__(self, value):
        self.value = float(value)

    def __add__(self, other):
        return Number(self.value + other.value)

    def __sub__(self, other):
        return Number(self.value - other.value)

    def __mul__(self, other):
        return Number(self.value * other.value)

    def __neg__(self):
        return Number(-self.value)

    def named(self, hint):
        assert isinstance(hint, str)
        return self

    def reciprocal_above(self, limit):
        return Number(1.0 / (self.value if self.value >= limit else 1.0))


def scalar(kernel, *values):
    """Run the scalar form on arrays; elements that it leaves alone are NaN."""
    answers = kernel.scalar(*[[Number(item) for item in value] for value in values])
    return [np.array([np.nan if item is None else item.value for item in answer]) for answer in answers]


def place(name):
    return Place("local", name)


SIZES = st.integers(1, 6)
SEEDS = st.integers(0, 10_000)
FEW = settings(max_examples=80, deadline=None, derandomize=True)


def covariance(random, n, condition=3.0):
    root = random.normal(size=(n, n)) * 10 ** random.uniform(-condition / 2, condition / 2, size=(n, 1))
    return root @ root.T + 1e-6 * np.eye(n)


def sparse(random, rows, columns):
    """Return a random pattern with no empty row, in row order, and its values."""
    mask = random.random((rows, columns)) < 0.4
    mask[np.arange(rows), random.integers(0, columns, size=rows)] = True
    pattern = tuple((int(i), int(j)) for i, j in np.argwhere(mask))
    values = random.normal(size=len(pattern))
    full = np.zeros((rows, columns))
    for (i, j), value in zip(pattern, values, strict=True):
        full[i, j] = value
    return pattern, values, full


def upper(random, n):
    """Return a random pattern of an upper triangle and its values."""
    pattern = tuple((i, j) for i in range(n) for j in range(i, n) if random.random() < 0.5)
    values = random.normal(size=len(pattern))
    full = np.zeros((n, n))
    for (i, j), value in zip(pattern, values, strict=True):
        full[i, j] = full[j, i] = value
    return pattern, values, full


def noise_of(random, rows, *, full=True):
    """Return a definite noise matrix with random zeros beside its diagonal, as (pattern, values, matrix)."""
    R = np.zeros((rows, rows))
    for i in range(rows):
        for j in range(i):
            if full and random.random() < 0.6:
                R[i, j] = R[j, i] = random.normal()
    R += np.diag(np.sum(np.abs(R), axis=1) + random.uniform(0.1, 2, size=rows))
    pattern = tuple((i, j) for i in range(rows) for j in range(i, rows) if i == j or R[i, j] != 0)
    return pattern, np.array([R[i, j] for i, j in pattern]), R


def close(found, expected, scale=None, tolerance=1e-9):
    for a, b in zip(found, expected, strict=True):
        known = np.isfinite(a)
        size = np.max(np.abs(np.asarray(b)[known]), initial=1e-300) if scale is None else scale
        np.testing.assert_allclose(np.asarray(a)[known], np.asarray(b)[known], rtol=0, atol=tolerance * size)


# -- packed matrices --------------------------------------------------------------------------------------------------


@given(n=SIZES)
def test_packing(n):
    full = np.arange(n * n, dtype=float).reshape(n, n)
    full = full + full.T
    packed = pack_symmetric(full)
    assert packed.size == packed_size(n)
    np.testing.assert_array_equal(unpack_symmetric(packed, n), full)
    for i in range(n):
        for j in range(n):
            assert packed[packed_index(n, i, j)] == full[i, j]


# -- congruence -------------------------------------------------------------------------------------------------------


@FEW
@given(n=SIZES, seed=SEEDS, with_noise=st.booleans())
def test_congruence(n, seed, with_noise):
    random = np.random.default_rng(seed)
    pattern, values, F = sparse(random, n, n)
    q_pattern, q_values, Q = upper(random, n) if with_noise else ((), np.zeros(0), np.zeros((n, n)))
    P = covariance(random, n)
    kernel = Congruence(n, place("f"), pattern, place("p"), place("q") if with_noise else None, q_pattern, place("t"))
    given_ = [values, pack_symmetric(P), *([q_values] if with_noise else [])]
    assert [size for _, size in kernel.reads] == [len(item) for item in given_]
    close(scalar(kernel, *given_), kernel.dense(*given_))
    close(kernel.dense(*given_), [pack_symmetric(F @ P @ F.T + Q)], tolerance=1e-12)


def test_a_wrong_sign_beside_the_diagonal_is_seen():
    random = np.random.default_rng(1)
    pattern, values, _ = sparse(random, 4, 4)
    kernel = Congruence(4, place("f"), pattern, place("p"), None, (), place("t"))
    packed = pack_symmetric(covariance(random, 4))
    found = scalar(kernel, values, packed)
    found[0][packed_index(4, 1, 2)] *= -1
    with pytest.raises(AssertionError):
        close(found, kernel.dense(values, packed))


class Flipped(RowUpdate):
    """A planted fault: one element beside the diagonal has the wrong sign."""

    def scalar(self, *values):
        answers = super().scalar(*values)
        answers[0][packed_index(self.size, 0, 1)] = -answers[0][packed_index(self.size, 0, 1)]
        return answers


# -- measurement rows -------------------------------------------------------------------------------------------------


def rows_of(kind, n, m, h_pattern, single=()):
    return [
        kind(n, i, place("e"), m, place("h"), h_pattern, place("r"), m, place("p"), place("t"), i in single)
        for i in range(m)
    ]


def chain(kernels, residual, h, r, packed, run):
    """Run rows one after another; return P, d, NIS and the variances of the rows."""
    state, scales = (packed,), np.full(len(residual), np.nan)
    for kernel in kernels:
        more = [] if kernel.row == 0 else [state[1], state[2], np.nan_to_num(scales, nan=1.0)]
        answers = run(kernel, residual, h, r, state[0], *more)
        scales[kernel.row] = answers[3][kernel.row]
        state = tuple(answers[:3])
    return [*state, scales]


def batch(P, H, R, residual):
    S = H @ P @ H.T + R
    K = P @ H.T @ np.linalg.inv(S)
    keep = np.eye(len(P)) - K @ H
    P_after = keep @ P @ keep.T + K @ R @ K.T
    return [pack_symmetric(P_after), K @ residual, np.array([residual @ np.linalg.solve(S, residual)])]


def run_dense(kernel, *values):
    return kernel.dense(*values)


@FEW
@given(n=SIZES, m=st.integers(1, 5), seed=SEEDS)
def test_rows_one_after_another_are_the_batch_update(n, m, seed):
    random = np.random.default_rng(seed)
    pattern, h, H = sparse(random, m, n)
    r, residual, P = random.uniform(0.1, 2, size=m), random.normal(size=m), covariance(random, n, 1.0)
    kernels = rows_of(RowUpdate, n, m, pattern)
    dense = chain(kernels, residual, h, r, pack_symmetric(P), run_dense)
    close(chain(kernels, residual, h, r, pack_symmetric(P), scalar), dense)
    close(dense[:3], batch(P, H, np.diag(r), residual), tolerance=1e-8)


@FEW
@given(n=SIZES, m=st.integers(1, 5), seed=SEEDS)
def test_rows_that_measure_one_state(n, m, seed):
    random = np.random.default_rng(seed)
    pattern = tuple((i, int(random.integers(0, n))) for i in range(m))
    h, H = np.ones(m), np.zeros((m, n))
    for i, j in pattern:
        H[i, j] = 1
    r, residual, P = random.uniform(0.1, 2, size=m), random.normal(size=m), covariance(random, n, 1.0)
    kernels = rows_of(RowUpdate, n, m, pattern, single=range(m))
    found = chain(kernels, residual, h, r, pack_symmetric(P), scalar)
    close(found, chain(kernels, residual, h, r, pack_symmetric(P), run_dense))
    close(found[:3], batch(P, H, np.diag(r), residual), tolerance=1e-8)


def test_the_measured_row_is_exact_where_the_difference_cancels():
    kernel = rows_of(RowUpdate, 2, 1, ((0, 0),), single=(0,))[0]
    P = np.array([[1e8, 3.0], [3.0, 1.0]])
    after = unpack_symmetric(scalar(kernel, [0.5], [1.0], [1e-10], pack_symmetric(P))[0], 2)
    assert after[0, 0] == pytest.approx(1e-10, rel=1e-14)
    assert after[0, 1] == pytest.approx(3e-18, rel=1e-12)


def test_the_single_form_where_it_does_not_hold_is_seen():
    """Row 0 measures 2 x0: r K is not the measured row of P."""
    P = covariance(np.random.default_rng(3), 3, 1.0)
    kernel = rows_of(RowUpdate, 3, 1, ((0, 0),), single=(0,))[0]
    with pytest.raises(AssertionError):
        close(
            scalar(kernel, [0.5], [2.0], [0.3], pack_symmetric(P)), kernel.dense([0.5], [2.0], [0.3], pack_symmetric(P))
        )


def test_a_planted_fault_in_a_row_update_is_seen():
    random = np.random.default_rng(5)
    pattern, h, _ = sparse(random, 2, 3)
    packed = pack_symmetric(covariance(random, 3, 1.0))
    for kind, fails in ((RowUpdate, False), (Flipped, True)):
        found = chain(rows_of(kind, 3, 2, pattern), [0.3, -1], h, [1.0, 0.5], packed, scalar)
        expected = chain(
            rows_of(RowUpdate, 3, 2, pattern), np.array([0.3, -1]), h, np.array([1.0, 0.5]), packed, run_dense
        )
        if fails:
            with pytest.raises(AssertionError):
                close(found, expected)
        else:
            close(found, expected)


def test_a_vanishing_innovation_variance_is_not_divided_by():
    kernel = rows_of(RowUpdate, 1, 1, ((0, 0),))[0]
    values = [np.array([2.0]), np.array([1.0]), np.array([-1.0]), np.array([1.0])]
    for answers in (scalar(kernel, *values), kernel.dense(*values)):
        assert answers[3][0] == 0.0
        assert all(np.all(np.isfinite(item)) for item in answers)


# -- innovation variance, factorisation -------------------------------------------------------------------------------


@FEW
@given(n=SIZES, m=st.integers(1, 5), seed=SEEDS)
def test_innovation_variance(n, m, seed):
    random = np.random.default_rng(seed)
    pattern, h, H = sparse(random, m, n)
    r_pattern, r, R = noise_of(random, m)
    P = covariance(random, n)
    kernel = InnovationVariance(n, m, place("h"), pattern, place("r"), r_pattern, place("p"), place("t"))
    values = [h, r, pack_symmetric(P)]
    close(scalar(kernel, *values), kernel.dense(*values))
    close(kernel.dense(*values), [np.diag(H @ P @ H.T + R)], tolerance=1e-12)


@FEW
@given(m=st.integers(1, 6), seed=SEEDS)
def test_pivots(m, seed):
    random = np.random.default_rng(seed)
    pattern, values, R = noise_of(random, m)
    kernel = Pivots(m, place("r"), pattern, place("t"))
    close(scalar(kernel, values), kernel.dense(values))
    assert np.prod(kernel.dense(values)[0]) == pytest.approx(np.linalg.det(R), rel=1e-9)


@FEW
@given(m=st.integers(2, 5), seed=SEEDS)
def test_both_forms_find_a_matrix_indefinite(m, seed):
    random = np.random.default_rng(seed)
    R = random.normal(size=(m, m))
    R = R + R.T
    R -= np.eye(m) * (np.linalg.eigvalsh(R)[0] + 0.1)  # lowest eigenvalue -0.1
    pattern = tuple((i, j) for i in range(m) for j in range(i, m))
    values = pack_symmetric(R)
    kernel = Pivots(m, place("r"), pattern, place("t"))
    assert np.min(scalar(kernel, values)[0]) < 0
    assert np.min(kernel.dense(values)[0]) < 0


@FEW
@given(n=SIZES, m=st.integers(1, 5), seed=SEEDS)
def test_decorrelate_then_rows_are_the_batch_update(n, m, seed):
    random = np.random.default_rng(seed)
    h_pattern, h, H = sparse(random, m, n)
    r_pattern, r, R = noise_of(random, m)
    residual, P = random.normal(size=m), covariance(random, n, 1.0)
    white = Decorrelate(
        m, n, place("e"), place("h"), h_pattern, place("r"), r_pattern, place("we"), place("wh"), place("wr")
    )
    dense = white.dense(residual, h, r)
    close(scalar(white, residual, h, r), dense)
    assert [size for _, size in white.writes] == [item.size for item in dense]
    full = np.zeros((m, n))
    for (i, j), value in zip(white.new_pattern, dense[1], strict=True):
        full[i, j] = value
    L = np.linalg.cholesky(R)
    L = L / np.diag(L)
    np.testing.assert_allclose(L @ full, H, atol=1e-9)  # the pattern has room for every element
    kernels = rows_of(RowUpdate, n, m, white.new_pattern)
    found = chain(kernels, *[scalar(white, residual, h, r)[k] for k in (0, 1, 2)], pack_symmetric(P), scalar)
    close(found[:3], batch(P, H, R, residual), tolerance=1e-7)


@FEW
@given(size=SIZES, seed=SEEDS)
def test_scale(size, seed):
    random = np.random.default_rng(seed)
    kernel = Scale(size, place("k"), place("s"), place("t"))
    values = [random.normal(size=1), random.normal(size=size)]
    close(scalar(kernel, *values), kernel.dense(*values))
    np.testing.assert_array_equal(kernel.dense(*values)[0], values[0] * values[1])


def test_there_is_a_name_for_every_element_that_is_read():
    pattern = ((0, 0), (1, 1), (1, 0))
    names = ("a", "b", "c")
    kernels = [
        Congruence(2, place("f"), pattern, place("p"), place("q"), ((0, 0),), place("t"), names, ("q_0_0",)),
        *[
            RowUpdate(2, i, place("e"), 2, place("h"), pattern, place("r"), 2, place("p"), place("t"), False, names, ("r", "s"),
                      ("e", "f"))
            for i in (0, 1)
        ],
        InnovationVariance(2, 2, place("h"), pattern, place("r"), ((0, 0), (1, 1)), place("p"), place("t"), names, ("r", "s")),
        Pivots(2, place("r"), ((0, 0), (0, 1), (1, 1)), place("t"), names),
        Scale(3, place("k"), place("s"), place("t"), symmetric=2),
        Scale(3, place("k"), place("s"), place("t")),
    ]  # fmt: skip
    for kernel in kernels:
        assert [len(group) for group in kernel.names()] == [size for _, size in kernel.reads]
