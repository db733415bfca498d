"""Fuzzy systems: the values of a published one, what holds of all, NaN, refusals, and the C of each kind."""

from functools import cache

import casadi as ca
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from plantc.reference import fuzzy as reference
from plantc.reference.fuzzy import membership
from plantc.symbolic import fuzzy as symbolic
from plantc.symbolic.fuzzy import area_and_moment as ours
from plantc.symbolic.fuzzy import midpoints

from plantc import (
    Block,
    FuzzyInput,
    FuzzyOutput,
    FuzzySet,
    FuzzySystem,
    ModelError,
    NativeView,
    Plant,
    Status,
    cross_check,
    export,
    linearise,
)

CENTRES = {"NB": -1.0, "NM": -0.4, "Z": 0.0, "PM": 0.4, "PB": 1.0}
PEAKS = {"NB": -1.0, "NM": -0.5, "Z": 0.0, "PM": 0.5, "PB": 1.0}


@cache
def five_rules():
    """The system of Ghanai et al. (AEEE 16(4), 2018): Tab. 1, eq. 23."""
    surface = FuzzyInput("v", (-1, 1), FuzzySet.partition(PEAKS))
    return FuzzySystem(surface, FuzzyOutput("k", CENTRES), [(label, label) for label in CENTRES])


@cache
def two_inputs(**options):
    """A PD-like table of two inputs; a weight, and a rule that does not ask for the rate."""
    error = FuzzyInput("error", (-2, 1), FuzzySet.partition({"N": -2, "Z": 0, "P": 1}))
    rate = FuzzyInput(
        "rate",
        (0, 10),
        [
            FuzzySet.left_shoulder("slow", 2, 6),
            FuzzySet.trapezoid("brisk", 2, 4, 7, 9),
            FuzzySet.right_shoulder("fast", 6, 9),
        ],
    )
    sets = [
        FuzzySet.triangle("low", -3, -2, 0),
        FuzzySet.trapezoid("middle", -1, 0, 0.5, 2),
        FuzzySet.trapezoid("high", 1, 3, 3, 3),
    ]
    rules = [
        (("N", None), "low"),
        (("Z", "slow"), "middle"),
        (("Z", "brisk"), "high", 0.5),
        (("Z", "fast"), "high"),
        (("P", "slow"), "middle"),
        (("P", "brisk"), "high"),
        (("P", "fast"), "low"),
    ]
    return FuzzySystem([error, rate], FuzzyOutput("push", sets, unit="N"), rules, **options)


KINDS = {
    "centres": {},
    "least": {"join": "min"},
    "union": {"defuzzify": "centroid", "points": 41},
    "scaled_union": {"defuzzify": "centroid", "implication": "product", "join": "min"},
    "sum": {"defuzzify": "centroid", "aggregation": "sum"},
    "scaled_sum": {"defuzzify": "centroid", "aggregation": "sum", "implication": "product"},
}


@cache
def evaluated(system):
    """The expression of a system as a function of numbers."""
    symbols = [ca.SX.sym(item.name) for item in system.inputs]
    function = ca.Function("system", symbols, [system(*symbols)])
    return lambda *values: float(function(*values))


# -- a published system -----------------------------------------------------------------------------------------------


def test_the_values_of_the_published_system():
    value = evaluated(five_rules())
    given = (-1.3, -0.75, -0.2, 0, 0.1, 0.5, 0.6, 0.95, 2)
    expected = (-1, -0.7, -0.16, 0, 0.08, 0.4, 0.52, 0.94, 1)
    np.testing.assert_allclose([value(v) for v in given], expected, rtol=1e-14, atol=1e-15)
    np.testing.assert_allclose(five_rules().reference()(np.array(given))[0], expected, rtol=1e-14, atol=1e-15)
    assert five_rules().least_strength == 1.0


@given(st.floats(-3, 3))
def test_it_is_odd_and_piecewise_linear(v):
    value = evaluated(five_rules())
    assert value(-v) == -value(v)
    a = abs(v)
    expected = np.sign(v) * (0.8 * a if a <= 0.5 else 0.4 + 1.2 * (a - 0.5) if a <= 1 else 1.0)
    assert value(v) == pytest.approx(expected, abs=1e-14)


def test_its_slopes_are_derived():
    v = ca.SX.sym("v")
    slope = ca.Function("slope", [v], [ca.jacobian(five_rules()(v), v)])
    np.testing.assert_allclose(
        [float(slope(x)) for x in (0.2, -0.3, 0.7, -0.9, 1.5)], [0.8, 0.8, 1.2, 1.2, 0], rtol=1e-13
    )


# -- what holds of all ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", KINDS)
@settings(max_examples=10)
@given(error=st.floats(-3, 2), rate=st.floats(-1, 12))
def test_expression_and_numpy_agree_and_stay_within_the_sets(kind, error, rate):
    system = two_inputs(**KINDS[kind])
    value = evaluated(system)(error, rate)
    assert value == pytest.approx(float(system.reference()(error, rate)[0]), rel=1e-12, abs=1e-12)
    assert -3 < value < 3


@given(
    st.lists(st.floats(-5, 5), min_size=2, max_size=6, unique=True), st.floats(-2, 2), st.floats(-2, 2), st.floats(0, 1)
)
def test_a_partition_with_singletons_on_a_line_is_that_line(peaks, offset, slope, share):
    peaks = sorted(round(item, 3) for item in peaks)
    if min(np.diff(peaks)) < 1e-3:
        return
    sets = FuzzySet.partition({str(k): peak for k, peak in enumerate(peaks)})
    line = {item.label: offset + slope * peak for item, peak in zip(sets, peaks, strict=True)}
    made = FuzzySystem(FuzzyInput("x", (peaks[0], peaks[-1]), sets), FuzzyOutput("y", line), [(k, k) for k in line])
    x = peaks[0] + share * (peaks[-1] - peaks[0])
    assert evaluated(made)(x) == pytest.approx(offset + slope * x, abs=1e-10)


@pytest.mark.parametrize("kind", ["union", "scaled_union", "sum", "scaled_sum"])
def test_centroids_are_those_of_integrals(kind):
    """The sums, and areas in closed form, against the membership of the whole on a fine grid; a union at 41 points is near."""
    system = two_inputs(**KINDS[kind])
    sets = {item.label: item.corners for item in system.outputs[0].sets}
    y = -3 + 6 * (np.arange(60_000) + 0.5) / 60_000
    for point in ((-0.5, 3.0), (0.6, 6.5), (0.9, 5.0)):
        cut = []
        for strength, (_, then, _) in zip(system.reference().strengths(*point), system.rules, strict=True):
            degree = membership(y, sets[then[0]])
            cut.append(strength * degree if system.implication == "product" else np.minimum(strength, degree))
        whole = np.max(cut, axis=0) if system.aggregation == "max" else np.sum(cut, axis=0)
        exact = np.sum(y * whole) / np.sum(whole)
        assert evaluated(system)(*point) == pytest.approx(exact, abs=1e-8 if system.aggregation == "sum" else 5e-3)


@given(
    corners=st.lists(st.floats(-5, 5).map(lambda x: round(x, 3)), min_size=4, max_size=4).map(sorted),
    height=st.floats(0.01, 1),
)
def test_model_and_oracle_have_areas_of_their_own_and_both_are_integrals(corners, height):
    """Two derivations: a slip in one is seen by the cross-check. Both against a sum over levels, exact for these degrees."""
    assert ours is not reference.area_and_moment
    assert midpoints is not reference.midpoints
    a, b, c, d = corners
    nodes, weights = np.polynomial.legendre.leggauss(3)
    t, w = height * (nodes + 1) / 2, height * weights / 2
    left, right = a + t * (b - a), d - t * (d - c)
    exact = [np.sum(w * (right - left)), np.sum(w * (right**2 - left**2) / 2)]
    for found in (ours(tuple(corners), height), reference.area_and_moment(tuple(corners), height)):
        np.testing.assert_allclose(found, exact, rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(midpoints((a, d + 1), 41), reference.midpoints((a, d + 1), 41), rtol=1e-13, atol=1e-13)


@pytest.mark.parametrize("kind", ["sum", "union"])
def test_the_check_sees_a_slip_in_an_integral(kind, monkeypatch):
    """Planted in the model's own helpers, which the oracle does not share."""
    area, middles = ours, midpoints
    monkeypatch.setattr(symbolic, "area_and_moment", lambda *own: (area(*own)[0], 1.01 * area(*own)[1]))
    monkeypatch.setattr(symbolic, "midpoints", lambda *own: middles(*own) + 0.05)
    assert not cross_check(two_inputs(**KINDS[kind]).block("pusher"), steps=40).passed


def test_more_points_bring_a_union_nearer():
    few, many, exact = (
        float(two_inputs(defuzzify="centroid", points=n).reference()(0.6, 6.5)[0]) for n in (11, 501, 10_001)
    )
    assert abs(many - exact) < 1e-4 < abs(few - exact)


def test_the_least_strength_is_that_of_a_fine_grid():
    for join in ("product", "min"):
        system = two_inputs(join=join)
        grid = np.meshgrid(np.linspace(-2, 1, 301), np.linspace(0, 10, 301))
        least = float(np.min(sum(system.reference().strengths(*grid))))
        assert system.least_strength == pytest.approx(least, abs=1e-12)


def test_several_outputs():
    x = FuzzyInput("x", (0, 1), FuzzySet.partition({"low": 0, "high": 1}))
    outputs = [FuzzyOutput("gain", {"s": 1, "b": 3}), FuzzyOutput("limit", {"s": 10, "b": 20})]
    system = FuzzySystem(x, outputs, [("low", ("b", "s")), ("high", ("s", "b"))])
    assert [float(item) for item in ca.vertsplit(system(0.25))] == pytest.approx([2.5, 12.5])
    assert [item.name for item in system.block("scheduler").entries["step"].outputs] == ["gain", "limit"]


def test_a_fuzzy_system_stands_in_a_plant():
    tank = Plant("tank")
    level = tank.state("level", range=(-5, 5))
    tank.dynamics({level: -five_rules()(level)})
    assert linearise(tank, {level: 0.7}).A.item() == pytest.approx(-1.2)


# -- what is no number ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", KINDS)
def test_not_a_number_is_not_made_one(kind):
    system = two_inputs(**KINDS[kind])
    value = evaluated(system)
    for point in (
        (np.nan, 3.0),
        (0.5, np.nan),
        (-2.0, np.nan),
        (np.nan, np.nan),
    ):  # at -2 the rate is not asked for, almost
        assert np.isnan(value(*point))
        assert np.isnan(system.reference()(*point)[0])
    assert np.isfinite(value(np.inf, -np.inf))


def test_what_c_does_with_what_is_no_number():
    """As an input it is refused; as what an expression gives, the output is no number, and is refused where it is judged."""
    view = NativeView(five_rules().block("five_rules"))
    for bad in (np.nan, np.inf, -np.inf):
        assert view.call("step", view.init(), view.inputs("step", {"v": bad}), view.params()).status == Status.BAD_INPUT
    answer = view.call("step", view.init(), view.inputs("step", {"v": 1e5}), view.params())
    assert (answer.status, float(answer.outputs["k"])) == (Status.OK, 1.0)
    block = Block("rooted")
    x = block.input("x", range=(-10, 10))
    block.entry("step", inputs=[x], outputs={"k": five_rules()(ca.sqrt(x))})
    view = NativeView(block, "float")
    for number, status in ((0.25, Status.OK), (9.0, Status.OK), (-1.0, Status.OVERFLOW)):
        assert view.call("step", view.init(), view.inputs("step", {"x": number}), view.params()).status == status


# -- refusals ---------------------------------------------------------------------------------------------------------

SETS = FuzzySet.partition({"N": -1, "P": 1})
IN, OUT = FuzzyInput("x", (-1, 1), SETS), FuzzyOutput("y", {"N": -1, "P": 1})
BOTH = [("N", "N"), ("P", "P")]
SAME = ("N",)


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: FuzzySet.triangle("Z", 0, -1, 1), r"corners \(0, -1, -1, 1\); give four numbers that do not fall"),
        (lambda: FuzzySet("Z", (0, float("nan"), 1, 2)), "give four numbers that do not fall"),
        (lambda: FuzzySet("Z", (-float("inf"), 0, 1, 2)), "rises or falls from infinity"),
        (lambda: FuzzySet.partition({"Z": 0}), "give two or more that rise"),
        (lambda: FuzzyInput("x", (-1, 1), [*SETS, SETS[0]]), "a label stands twice among N, P, N"),
        (lambda: FuzzyInput("x", (-1, 1), []), "has no fuzzy sets"),
        (lambda: FuzzyInput("x", (-1, 1), [FuzzySet.trapezoid("Z", 0, 0, 1, 2)]), "a vertical edge within -1 .. 1"),
        (lambda: FuzzyInput("x", (1, 0), SETS), "the range of the fuzzy input 'x' is 1 .. 0"),
        (lambda: FuzzyOutput("y", [FuzzySet.left_shoulder("Z", 0, 1)]), "reaches to infinity"),
        (lambda: FuzzySystem(IN, OUT, [("N", "N"), ("Q", "P")]), r"says 'Q' of 'x', whose labels are N, P"),
        (lambda: FuzzySystem(IN, OUT, [("N", None), ("P", "P")]), "says None of 'y'"),
        (lambda: FuzzySystem(IN, OUT, [(("N", "P"), "N")]), r"has 2 label\(s\) for 1 input\(s\)"),
        (lambda: FuzzySystem(IN, OUT, [("N", "N", 0.0), ("P", "P")]), "give more than 0 and at most 1"),
        (lambda: FuzzySystem(IN, OUT, ["N"]), "is no \\(labels in, labels out\\)"),
        (lambda: FuzzySystem(IN, OUT, [*BOTH, ("N", "P")]), r"two rules are about \('N',\)"),
        (lambda: FuzzySet.partition([-1, 0, 1]), r"peaks is \[-1, 0, 1\], of type list; give a dictionary"),
        (lambda: FuzzySet.partition({"N": "a", "P": 0}), r"the peaks of a partition are \['a', 0\]; give finite numbers"),
        (lambda: FuzzyInput("x", (-1, 1), None), "x: sets is None, of type NoneType; give a list of FuzzySet"),
        (lambda: FuzzyInput("x", (-1, 1), ["N"]), "x: one of the sets is 'N', of type str; give a list of FuzzySet"),
        (lambda: FuzzyOutput("y", 5), "y: sets is 5, of type int; give a dictionary, label -> number"),
        (lambda: FuzzySystem(5, OUT, BOTH), "inputs is 5, of type int; give a FuzzyInput, or a list of them"),
        (lambda: FuzzySystem(OUT, OUT, BOTH), "inputs is the FuzzyOutput 'y'; give a FuzzyInput, or a list of them"),
        (lambda: FuzzySystem(IN, ["y"], BOTH), "one of the outputs is 'y', of type str; give a FuzzyOutput"),
        (lambda: FuzzySystem(IN, OUT, None), r"rules is None, of type NoneType; give a list of \(labels in, labels out\)"),
        (lambda: FuzzySystem(IN, OUT, [(1, "N")]), "says 1 of 'x', whose labels are N, P"),
        (lambda: FuzzySystem(IN, OUT, BOTH)("a"), "the input 'x': 'a' is no SX expression and no number"),
        (lambda: FuzzySystem(IN, OUT, BOTH).block("b", ranges=[1]), r"b: ranges is \[1\], of type list; give a dictionary"),
        (lambda: FuzzySystem(IN, OUT, [*BOTH, BOTH[1]]), r"two rules are about \('P',\)"),
        (lambda: FuzzySystem(IN, OUT, [("N", SAME), ("N", SAME), ("P", "P")]), r"two rules are about \('N',\)"),
        (lambda: FuzzySystem(IN, OUT, []), "no input, no output or no rule"),
        (lambda: FuzzySystem(IN, OUT, [(None, "N")]), "no rule asks for 'x'"),
        (lambda: FuzzySystem(IN, OUT, [("N", "N")]), "at x = 1 no rule answers"),
        (lambda: FuzzySystem(IN, OUT, BOTH, join="sum"), "join is 'sum'; give one of product, min"),
        (lambda: FuzzySystem(IN, OUT, BOTH, defuzzify="centroid"), "the set 'N' of 'y' has no area"),
        (lambda: FuzzySystem(IN, OUT, BOTH)(1, 2), r"called with 2 expression\(s\) and has 1 input\(s\)"),
        (lambda: FuzzySystem(IN, OUT, BOTH)(ca.SX.sym("x", 2)), "has 2 elements; give a scalar"),
        (lambda: FuzzySystem(IN, OUT, BOTH).block("b", ranges={"z": (0, 1)}), r"names \['z'\], which are no inputs; it has x"),
        (
            lambda: FuzzySystem(FuzzyInput("x", (-1, 3), [*SETS[:1], FuzzySet.triangle("P", -1, 1, 2)]), OUT, BOTH),
            "at x = 2 no rule answers",
        ),
    ],
)  # fmt: skip
def test_what_is_no_fuzzy_system(make, says):
    with pytest.raises(ModelError, match=says):
        make()


def test_a_combination_without_a_rule_is_found():
    """Planted: each input is covered by its sets, the table has a hole."""
    full = two_inputs()
    with pytest.raises(ModelError, match=r"at error = 1, rate = 9 no rule answers"):
        FuzzySystem(full.inputs, full.outputs, full.rules[:-1])


# -- as C -------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("kind", "precision"), [("centres", "double"), ("least", "float")])
def test_all_views_agree(kind, precision):
    check = cross_check(two_inputs(**KINDS[kind]).block("pusher"), precision, steps=40)
    assert check.passed, [(item.name, str(item.mismatch), item.note) for item in check.failures]
    assert check.statuses["OK"] > 60


def test_the_check_sees_another_rule():
    """Planted: the oracle has one output set elsewhere."""
    block = two_inputs().block("pusher")
    other = two_inputs(join="min").block("pusher")
    block.oracle = other.oracle
    assert not cross_check(block, steps=40).passed


@pytest.mark.slow
def test_a_fuzzy_block_passes_the_gates(tmp_path):
    assert export(two_inputs(**KINDS["union"]).block("pusher"), tmp_path, precision="float", steps=40).passed
