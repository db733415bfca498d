"""Noise: streams that depend on seed, run and name alone, and strengths that are what they say."""

import numpy as np
import pytest
from plantc.examples.quadrotor_ekf import sampled
from plantc.simulation import Channel, channels, draw, stream
from plantc.simulation import noise as module
from plantc.symbolic.simulated import noise_inputs

from plantc import ModelError

CORRELATED = np.array([[4.0, 1.2, 0.0], [1.2, 1.0, -0.3], [0.0, -0.3, 2.0]])


def keyed_well():
    """Whether a draw depends on seed, run and name, and on nothing that was drawn before."""
    one, other = Channel("w", np.eye(2), ""), Channel("v", np.eye(2), "")
    first = draw(one, 1, 5, 50)
    draw(other, 1, 5, 7)
    again = draw(one, 1, 5, 50)
    different = [draw(one, 2, 5, 50), draw(one, 1, 6, 50), draw(other, 1, 5, 50), draw(one, 5, 1, 50)]
    return np.array_equal(first, again) and not any(np.array_equal(first, item) for item in different)


def test_a_stream_is_keyed_by_seed_run_and_name(monkeypatch):
    assert keyed_well()
    right = stream
    monkeypatch.setattr(module, "_recent", module._Recent(0))  # which would hide what is planted
    shared = np.random.Generator(np.random.Philox(1))
    planted = [
        lambda seed, run, name: shared,  # one stream, in the order of the calls
        lambda seed, run, name: right(0, run, name),
        lambda seed, run, name: right(seed, 0, name),
        lambda seed, run, name: right(seed, run, ""),
        lambda seed, run, name: right(0, seed + run, name),
    ]
    for fault in planted:
        monkeypatch.setattr(module, "stream", fault)
        assert not keyed_well()


def test_what_is_kept_of_earlier_draws_changes_no_number_and_is_bounded(monkeypatch):
    channel = Channel("w", np.eye(2), "")
    fresh = draw(channel, 1, 5, 50)
    recent = module._Recent(3 * fresh.nbytes)
    monkeypatch.setattr(module, "_recent", recent)
    for run in (5, 6, 7, 8, 5, 8, 8):
        np.testing.assert_array_equal(draw(channel, 1, run, 50), stream(1, run, "w").standard_normal((50, 2)))
        assert recent.bytes == sum(array.nbytes for array in recent.arrays.values()) <= 3 * fresh.nbytes
    assert [key[1] for key in recent.arrays] == [7, 5, 8]
    draw(channel, 1, 8, 50)[:] = 0.0  # what is handed out is the caller's own
    np.testing.assert_array_equal(draw(channel, 1, 5, 50), fresh)


def test_the_numbers_of_a_stream_do_not_change_with_a_release_of_plantc():
    assert stream(3, 4, "gust").standard_normal(2).tolist() == [
        -0.4580473193902388,
        -1.1648115222734305,
    ]


def test_a_shorter_run_is_the_beginning_of_a_longer_one():
    channel = Channel("w", np.diag([1.0, 2.0]), "")
    np.testing.assert_array_equal(draw(channel, 1, 2, 10), draw(channel, 1, 2, 30)[:10])


def test_the_covariance_of_the_draws_is_what_was_asked_for():
    inputs = noise_inputs(sampled)
    made = {item.name: item for item in channels(inputs, {"pose_noise": 0.05})}
    steps = 40_000
    assert np.std(draw(made["pose_noise"], 0, 0, steps)) == pytest.approx(0.05, rel=4 / np.sqrt(2 * 12 * steps))
    assert np.std(draw(made["roll_noise"], 0, 0, steps)) == pytest.approx(1e-3, rel=4 / np.sqrt(2 * steps))
    correlated = Channel("w", np.linalg.cholesky(CORRELATED), "")
    found = np.cov(draw(correlated, 0, 0, steps).T)
    sigma = np.sqrt((np.outer(np.diag(CORRELATED), np.diag(CORRELATED)) + CORRELATED**2) / steps)
    assert np.all(np.abs(found - CORRELATED) < 4.5 * sigma)
    assert np.any(np.abs(found - np.diag(np.diag(CORRELATED))) > 4.5 * sigma)  # the check can fail


@pytest.mark.parametrize(
    ("std", "covariance", "message"),
    [
        ({"gust": 1.0}, None, r"'gust' is no noise of this plant; it has x_noise"),
        ({"x_noise": -1.0}, None, "zero or more"),
        ({"pose_noise": [1.0, 2.0]}, None, "give 1 or 12 numbers"),
        ({"x_noise": 1.0}, {"x_noise": [[1.0]]}, "has std= and covariance=; give one"),
        (None, {"pose_noise": np.eye(3)}, "give a symmetric 12 x 12 matrix"),
        (None, {"pose_noise": np.ones((12, 12))}, "not positive definite"),
    ],
)
def test_a_strength_that_cannot_be_is_said(std, covariance, message):
    with pytest.raises(ModelError, match=message):
        channels(noise_inputs(sampled), std, covariance)


def test_a_key_that_does_not_fit_is_refused():
    with pytest.raises(ValueError, match="the seed is -1; give a whole number"):
        stream(-1, 0, "w")
