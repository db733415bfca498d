"""What of a covariance is zero by structure: found, never stored, and seen by the oracle where it was found wrongly."""

import re

import numpy as np
import pytest
from plantc.reference.model import CorrelatedError, packed, unpacked
from plantc.symbolic import sin, vertcat
from plantc.symbolic.estimators import _Builder, extended_kalman_filter
from plantc.symbolic.forms import FORMS, packing_of
from plantc.symbolic.program import Packing, packed_index

from plantc import InterpretView, Plant, ReferenceView, cross_check, emit, kalman_filter

T = 0.1


def two_chains(*, sensor="apart", noise="apart", order="ab", driven=False, correlated_noise=False):
    """Two chains of two states, linked or not by one thing."""
    plant = Plant("chains", dt=T)
    names = ["a0", "a1", "b0", "b1"] if order == "ab" else ["a0", "b0", "a1", "b1"]
    made = {name: plant.state(name, range=(-1e3, 1e3)) for name in names}
    a0, a1, b0, b1 = (made[name] for name in ("a0", "a1", "b0", "b1"))
    gust = plant.noise(
        "gust", size=2 if noise != "common" else 1, variance=[[2e-4, 1e-4], [1e-4, 2e-4]] if noise == "full" else 1e-4
    )
    first, second = (gust[0], gust[1]) if noise != "common" else (gust, gust)
    plant.dynamics(
        {a0: a0 + T * a1, a1: a1 + first, b0: b0 + T * b1 + (0.01 * sin(a0) if driven else 0), b1: b1 + second}
    )
    if sensor == "apart":
        plant.sensor("ya", a0, variance=0.01)
        plant.sensor("yb", b0, variance=0.02)
    elif sensor == "vector":
        variance = [[0.02, 0.01], [0.01, 0.03]] if correlated_noise else [0.02, 0.03]
        plant.sensor("y", vertcat(a0, b0), variance=variance)
    else:
        plant.sensor("y", a0 + b0, variance=0.01)
        plant.sensor("ya", a0, variance=0.01)
    return plant


def filter_of(plant, **options):
    names = [state.signal.name for state in plant.states]
    return extended_kalman_filter(plant, initial_variance=dict.fromkeys(names, 0.5), **options)


APART = ((0, 1), (2, 3))
FIELDS = ("covariance", "factors")


@pytest.mark.parametrize(
    ("changes", "blocks"),
    [
        ({}, APART),
        ({"order": "mixed"}, ((0, 2), (1, 3))),
        ({"sensor": "vector"}, APART),
        ({"sensor": "sum"}, ()),
        ({"sensor": "vector", "correlated_noise": True}, ()),
        ({"noise": "common"}, ()),
        ({"noise": "full"}, ()),
        ({"driven": True}, ()),
    ],
)
def test_states_are_linked_by_dynamics_noise_and_sensors(changes, blocks):
    block = filter_of(two_chains(**changes))
    packing = packing_of(block, "covariance")
    assert packing.blocks == blocks
    field = next(signal for signal in block.memory_signals if signal.name == "covariance")
    assert field.size == (6 if blocks else 10) == packing.count
    assert ("zero by structure" in field.doc) == bool(blocks)


def test_all_of_it_on_request():
    assert packing_of(filter_of(two_chains(), correlated="all"), "covariance").blocks == ()
    with pytest.raises(ValueError, match="correlated is 'some'; take 'structural' or 'all'"):
        filter_of(two_chains(), correlated="some")


def run(block, steps=40):
    """A filter's memories on a fixed sequence of readings, now and then without them."""
    view, rng = InterpretView(block), np.random.default_rng(2)
    field = next(signal.name for signal in block.memory_signals if signal.name in FIELDS)
    sensors = [entry.removeprefix("update_") for entry in block.entries if entry.startswith("update_")]
    params, found = view.params(), []
    memory = view.init(params)
    for k in range(steps):
        inputs = {}
        for name in sensors:
            size = block.entries[f"update_{name}"].inputs[0].size
            inputs |= {name: np.sin(0.1 * k + np.arange(size)) + 0.1 * rng.normal(size=size), f"has_{name}": k % 3 != 1}
        answer = view.call("step", memory, view.inputs("step", inputs), params)
        assert answer.status >= 0
        memory = answer.memory
        x = np.concatenate([np.ravel(memory[name]) for name in ("a0", "a1", "b0", "b1")])
        found.append((x, packing_of(block, field), np.array(memory[field])))
    return found


@pytest.mark.parametrize("form", list(FORMS))
@pytest.mark.parametrize("changes", [{}, {"order": "mixed"}, {"sensor": "vector"}])
def test_the_blocks_hold_what_the_whole_triangle_holds(form, changes):
    whole, parts = (run(filter_of(two_chains(**changes), form=form, correlated=how)) for how in ("all", "structural"))
    for (x, full, stored), (y, packing, kept) in zip(whole, parts, strict=True):
        np.testing.assert_allclose(y, x, rtol=0, atol=1e-12)
        np.testing.assert_allclose(packing.upper(kept), full.upper(stored), rtol=1e-9, atol=1e-14)
        assert packing.count == 6


def test_packing():
    packing = Packing(5, ((0, 3), (1, 2, 4)))
    matrix = np.arange(25.0).reshape(5, 5)
    matrix = matrix + matrix.T
    stored = packing.pack(matrix)
    assert packing.pairs == ((0, 0), (0, 3), (3, 3), (1, 1), (1, 2), (1, 4), (2, 2), (2, 4), (4, 4))
    np.testing.assert_array_equal(stored, [matrix[i, j] for i, j in packing.pairs])
    full = packing.unpack(stored)
    np.testing.assert_array_equal(full, full.T)
    assert full[0, 1] == 0 and full[3, 0] == matrix[0, 3] and packing.index(0, 1) is None
    np.testing.assert_array_equal(unpacked(stored, packing.blocks), full)  # the oracle's own
    np.testing.assert_array_equal(packed(full, packing.blocks), stored)
    assert [Packing(4).at(i, j) for i in range(4) for j in range(4)] == [
        packed_index(4, i, j) for i in range(4) for j in range(4)
    ]
    with pytest.raises(ValueError, match="are no partition of 3 rows"):
        Packing(3, ((0,), (1,)))


def test_the_oracle_sees_a_link_that_was_overlooked(monkeypatch):
    """The planted fault: the derivation takes two chains for unlinked that one sensor reads the sum of."""
    monkeypatch.setattr(_Builder, "_blocks", lambda self: APART)
    wrong = ReferenceView(filter_of(two_chains(sensor="sum")))
    monkeypatch.undo()
    right = ReferenceView(filter_of(two_chains(sensor="sum")))

    def take(view):
        inputs, params = view.inputs("update_y", {"y": 0.3}), view.params()
        return view.call("update_y", view.init(params), inputs, params)

    assert take(right).status == 0
    with pytest.raises(
        CorrelatedError, match="components 0 and 2 of the error are in different blocks, and correlated"
    ):
        take(wrong)


@pytest.mark.slow
@pytest.mark.parametrize("changes", [{"order": "mixed"}, {"sensor": "vector"}])
def test_the_c_of_blocks(changes):
    block = filter_of(
        two_chains(**changes), form="ud" if changes.get("sensor") else "conventional", variance_ceiling=2.0
    )
    assert cross_check(block, "double", steps=60).passed
    assert f"[{6}]" in emit(block).header


@pytest.mark.slow
def test_alone_and_uneven():
    plant = Plant("alone", dt=T)
    a, b, c = (plant.state(name, size=size, range=(-1e3, 1e3)) for name, size in (("a", 1), ("b", 1), ("c", 2)))
    plant.dynamics({a: 0.9 * a, b: 0.8 * b, c: vertcat(0.9 * c[0] + 0.1 * c[1], 0.9 * c[1])})
    for name, read in (("ya", a), ("yb", b), ("yc", c[0])):
        plant.sensor(name, read, variance=0.1)
    plant.step_noise({a: 1e-3, b: 1e-3, c: 1e-3})
    block = kalman_filter(plant, initial_variance={"a": 1, "b": 1, "c": 1})
    assert packing_of(block, "covariance").blocks == ((0,), (1,), (2, 3))
    assert cross_check(block, "double", steps=60).passed


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("read", ["one", "both"])
def test_elements_of_one_state_may_lie_in_different_blocks(form, read):
    # of a state that a reading touches, what lies in other blocks stays: its correction was never computed
    plant = Plant("split", dt=T)
    a = plant.state("a", size=2, range=(-1e3, 1e3))
    plant.dynamics({a: vertcat(0.9 * a[0], 0.8 * a[1])})
    plant.step_noise({"a": [1e-3, 2e-3]})
    for k in range(1 if read == "one" else 2):
        plant.sensor(f"y{k}", a[k], variance=0.01)
    block = filter_of(plant, form=form)
    bodies = re.findall(r"update_y\d_core\([^;]*?\n\{\n(.*?)\n\}\n", emit(block).source, re.DOTALL)
    assert len(bodies) == (1 if read == "one" else 2)
    for k, body in enumerate(bodies):
        used = set(re.findall(r"\bdelta\[(\d)\]", body.replace("delta[2];", "")))
        assert used == {str(k)}
    assert cross_check(block, steps=30).passed  # compiled with warnings as errors, by gcc one of what was never written
