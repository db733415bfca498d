"""Metrics: against numpy.linalg and formulas written out; and what counts as kept, lost or frozen."""

import numpy as np
import pytest
from plantc.simulation import History, judge, metrics_of
from plantc.simulation.metrics import StatePlace, deviation, normalised_squares, normalised_squares_of_factors

N = 6
STATES = (StatePlace("a", 2, "plain"), StatePlace("b", 4, "plain"))


def covariances(rng, steps=40, n=N):
    factor = rng.normal(size=(steps, n, n + 2)) * 10.0 ** rng.uniform(-3, 1, (steps, n, 1))
    return factor @ factor.transpose(0, 2, 1)


def packed(matrices):
    i, j = np.triu_indices(matrices.shape[1])
    return matrices[:, i, j]


def factors(matrices):
    """U and D of P = U D U', from a Cholesky factor of the matrix turned around."""
    root = np.linalg.cholesky(matrices[:, ::-1, ::-1])[:, ::-1, ::-1]
    diagonal = np.diagonal(root, axis1=1, axis2=2)
    upper = root / diagonal[:, None, :]
    upper[:, np.arange(matrices.shape[1]), np.arange(matrices.shape[1])] = diagonal**2
    return packed(upper)


def test_the_squares_are_those_of_numpy():
    rng = np.random.default_rng(0)
    P, e = covariances(rng), rng.normal(size=(40, N))
    expected = np.einsum("ki,ki->k", e, np.linalg.solve(P, e[..., None])[..., 0])
    for array in (e, P):
        array.setflags(write=False)
    np.testing.assert_allclose(normalised_squares(e, packed(P)), expected, rtol=1e-7)
    np.testing.assert_allclose(normalised_squares_of_factors(e, factors(P)), expected, rtol=1e-7)
    # the companion: a triangle packed by columns is another matrix
    wrong = P.transpose(0, 2, 1)[:, *np.tril_indices(N)]
    assert not np.allclose(normalised_squares(e, wrong), expected, rtol=1e-3)


def test_a_covariance_that_is_not_definite_gives_no_number():
    P = np.stack([np.eye(3), np.diag([1.0, -1.0, 1.0]), np.array([[1.0, 2, 0], [2, 1, 0], [0, 0, 1]])])
    found = normalised_squares(np.ones((3, 3)), packed(P))
    assert found[0] == 3
    assert np.isnan(found[1:]).all()
    assert np.isnan(normalised_squares_of_factors(np.ones((3, 3)), packed(P))[1])


def history(rng, steps=30, **changes):
    P = covariances(rng, steps)
    spread = packed(P)
    spread.setflags(write=False)
    values = {
        "states": STATES,
        "point": rng.normal(size=N),
        "truth": rng.normal(size=(steps, N)),
        "estimate": rng.normal(size=(steps, N)),
        "spread": spread,
        "factored": False,
        "nis": {"gps": rng.uniform(size=steps)},
        "commands": np.zeros((steps, 1)),
        "statuses": np.zeros(steps, dtype=np.int32),
        "asked": steps,
    }
    return History(**(values | changes)), P


def test_the_numbers_are_the_formulas_of_the_specification():
    made, P = history(np.random.default_rng(1))
    found = metrics_of(made)
    total = dict.fromkeys(("estimate_to_set_point", "error", "regulation", "nees"), 0.0)
    for x, estimate, matrix in zip(made.truth, made.estimate, P, strict=True):
        total["estimate_to_set_point"] += np.linalg.norm(made.point - estimate) ** 2 / 30
        total["error"] += np.linalg.norm(x - estimate) ** 2 / 30
        total["regulation"] += np.linalg.norm(x - made.point) ** 2 / 30
        start = 0
        for state in made.states:
            at = slice(start, start + state.size)
            start += state.size
            name = f"error_{state.name}"
            total[name] = total.get(name, 0.0) + np.linalg.norm(x[at] - estimate[at]) ** 2 / 30
        total["nees"] += (x - estimate) @ np.linalg.solve(matrix, x - estimate) / 30
    total["nis_gps"] = float(np.mean(made.nis["gps"]))
    assert found == pytest.approx(total, rel=1e-9)


def test_angles_are_compared_modulo_a_turn_and_attitudes_by_their_rotation():
    states = (StatePlace("heading", 1, "angle"), StatePlace("q", 4, "attitude"))
    half = 0.01
    turned = -np.array([np.cos(half), 0, np.sin(half), 0])  # minus q is the same attitude
    value = np.concatenate([[3.1], turned])[None]
    origin = np.concatenate([[-3.1], [1.0, 0, 0, 0]])
    np.testing.assert_allclose(deviation(states, value, origin), [[6.2 - 2 * np.pi, 0, 0.02, 0]], atol=1e-6)


def test_a_run_is_kept_lost_or_frozen():
    rng = np.random.default_rng(2)
    made, _ = history(rng)
    assert judge(made).outcome == "kept"
    far = np.max(np.abs(made.truth - made.point)[:, 2:])
    assert judge(made, {"b": far}).outcome == "kept"
    assert judge(made, {"b": 0.999 * far}).outcome == "lost"
    assert judge(made, {"b": 0.999 * far}).metrics == metrics_of(made)
    statuses = np.zeros(30, dtype=np.int32)
    statuses[[3, 5]] = 1
    assert judge(history(rng, statuses=statuses)[0]).degraded == 2
    refused = judge(history(rng, asked=40, refused="OVERFLOW")[0])
    assert (refused.outcome, refused.refused, refused.steps) == ("frozen", "OVERFLOW", 30)
    assert np.isnan(list(refused.metrics.values())).all()
    for value in (1e6, np.nan, np.inf):
        for name in ("truth", "estimate"):
            array = np.array(getattr(made, name))
            array[4, 1] = made.point[1] + value
            assert judge(history(rng, point=made.point, **{name: array})[0]).outcome == "frozen"
