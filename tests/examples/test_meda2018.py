"""The study of Meda-Campana (2018) beside the verified numbers of specs/meda2018.md, sections 4 and 10, and its page.

The specification accepts a mean within 5 % or 5 standard errors, whichever is larger, and counts of kept runs within 12 of 100.
"""

import functools
import json
import re
from dataclasses import replace

import casadi as ca
import numpy as np
import pytest
from plantc.codegen.batch import Batch
from plantc.examples import meda2018
from plantc.examples.meda2018 import ESTIMATORS, GAMMAS, NOISES, Case, Row, evaluate
from plantc.examples.quadrotor_controllers import printed_gain
from plantc.examples.quadrotor_ekf import sampled
from plantc.simulation import channels, draw, each, judge, replay, study_page
from plantc.symbolic.discretisation import transition

SEED = 2018


@functools.cache
def result_of(case, runs=100):
    return evaluate(case, runs, SEED)


def accept(result, metric, value, error=None, of="kept"):
    """Hold a mean to the tolerance of the specification; where it gives no standard error it is taken as large as ours."""
    found = result.mean(metric, of)
    allowed = max(0.05 * value, 5 * np.hypot(error or found.standard_error, found.standard_error))
    assert abs(found.value - value) <= allowed, (metric, str(found), value)


def accept_kept(result, of_100):
    share = 100 * result.count("kept") / result.runs
    assert abs(share - of_100) <= 12, (share, of_100)


MSE, ERR, REG = "estimate_to_set_point", "error", "regulation"

# section 10.2, protocol A with the printed gain: kept of 100, then metric -> (mean, standard error)
PRINTED = {
    ("KF", 0.05): (100, {MSE: (0.0210, 3e-4), ERR: (1.375e-3, 1.3e-5), "nees": (17.1, 0.14)}),
    ("EKF", 0.05): (100, {MSE: (0.01655, 2e-4), ERR: (1.047e-3, 6e-6), "nees": (11.98, 0.06)}),
    ("JSSE", 0.05): (100, {MSE: (0.1344, 7e-4), ERR: (1.016e-2, 3e-5)}),
    ("JSSE-M", 0.05): (0, {}),
    ("KF", 0.1): (99, {MSE: (0.1206, 0.0017), ERR: (8.42e-3, 1e-4), "nees": (46.6, 0.5)}),
    ("EKF", 0.1): (100, {MSE: (0.0354, 3e-4), ERR: (2.98e-3, 2e-5), "nees": (12.01, 0.08)}),
    ("JSSE", 0.1): (81, {MSE: (0.635, 0.007), ERR: (4.07e-2, 1e-4)}),
    ("JSSE-M", 0.1): (0, {}),
    ("KF", 0.12): (72, {}),
    ("EKF", 0.12): (100, {MSE: (0.0442, None), ERR: (3.97e-3, None), "nees": (12.03, None)}),
    ("JSSE", 0.12): (11, {}),
    ("JSSE-M", 0.12): (0, {}),
    ("KF", 0.15): (1, {}),
    ("EKF", 0.15): (100, {MSE: (0.0585, None), ERR: (5.67e-3, None), "nees": (12.04, None)}),
    ("JSSE", 0.15): (0, {}),
    ("JSSE-M", 0.15): (0, {}),
    ("KF", 0.2): (0, {}),
    ("EKF", 0.2): (100, {MSE: (0.0853, None), ERR: (9.02e-3, None), "nees": (12.07, None)}),
    ("JSSE", 0.2): (0, {}),
    ("JSSE-M", 0.2): (92, {MSE: (1.13, 0.03), ERR: (0.681, 0.012)}),
    ("KF", 0.3): (0, {}),
    ("EKF", 0.3): (100, {MSE: (0.149, None), ERR: (0.0175, None), "nees": (12.14, None)}),
    ("JSSE", 0.3): (0, {}),
    ("JSSE-M", 0.3): (60, {MSE: (1.49, 0.03), ERR: (0.116, 0.001)}),
    ("KF", 0.5): (0, {}),
    ("EKF", 0.5): (100, {MSE: (0.313, None), ERR: (0.0410, None), "nees": (12.38, None)}),
    ("JSSE", 0.5): (0, {}),
    ("JSSE-M", 0.5): (0, {}),
    ("KF", 1.0): (0, {}),
    ("EKF", 1.0): (81, {MSE: (0.948, None), ERR: (0.136, None), "nees": (13.9, None)}),
    ("JSSE", 1.0): (0, {}),
    ("JSSE-M", 1.0): (0, {}),
}

# section 10.2, protocol A with the decoupled gain, 50 runs: r -> MSE and ERR of KF, EKF, JSSE, JSSE-M
DECOUPLED = {
    0.1: ((0.0197, 2.92e-3), (0.0196, 2.89e-3), (0.336, 0.0404), (0.0025, None)),
    0.2: ((0.0464, 9.27e-3), (0.0455, 8.66e-3), (1.34, 0.161), (0.598, 0.689)),
    0.3: ((0.0814, 0.0206), (0.0775, 0.0168), (3.05, 0.363), (0.728, 0.119)),
    0.5: ((0.184, 0.0786), (0.156, 0.0392), (8.89, 1.013), (5.35, 0.484)),
}

# section 10.2, protocol M, 50 runs: r -> ERR of KF, EKF, JSSE
BIASED = {0.02: (0.0544, 0.0562, 0.00210), 0.05: (0.336, 0.351, 0.0109), 0.1: (1.29, 1.37, 0.0413)}

# section 10.2, JSSE-M over gamma, r = 0.1, 50 runs: gamma -> ERR, MSE
SWEPT = {
    0.0: (0.0405, 0.614),
    0.005: (0.0214, 0.396),
    0.01: (0.0143, 0.254),
    0.015: (0.0130, 0.163),
    0.02: (0.0168, 0.127),
    0.03: (0.057, 0.174),
    0.04: (0.39, 0.59),
}


# -- the model --------------------------------------------------------------------------------------------------------


def test_the_flown_quadrotor_is_the_published_one_and_its_mass_moves_translation_only():
    x = np.array([1, -2, 3, 0.5, 29, -0.3, 0.2, -0.4, -0.3, 0.6, 0.7, -0.8])
    u = np.array([200.0, 210, 220, 230])
    reference = ca.Function("f", [sampled.x, sampled.u], [transition(sampled)[0]])
    believed, flown = meda2018.believed(), meda2018.truth()
    same = ca.Function("f", [believed.x, believed.u], [transition(believed)[0]])
    heavy = ca.Function("f", [flown.x, flown.u, flown.p], [transition(flown)[0]])
    expected = np.array(reference(x, u)).ravel()
    np.testing.assert_allclose(np.array(same(x, u)).ravel(), expected, rtol=1e-14)
    np.testing.assert_allclose(np.array(heavy(x, u, 1.0)).ravel(), expected, rtol=1e-14)
    moved = np.array(heavy(x, u, 1.05)).ravel() - expected
    assert set(np.flatnonzero(np.abs(moved) > 1e-12)) == {1, 3, 5}


def test_the_facts_of_section_4_about_the_gains():
    facts = meda2018.gain_facts()
    assert facts["radius of the printed gain"] == pytest.approx(0.9804001439, abs=1e-9)
    assert facts["norm of the printed gain"] == pytest.approx(1921.778778, abs=1e-6)
    assert facts["norm of the decoupled gain"] == pytest.approx(498.9933806, abs=1e-6)
    assert facts["radius of the decoupled gain"] == pytest.approx(0.95, abs=1e-9)
    assert facts["radius of a robust placement"] == pytest.approx(0.95, abs=1e-9)
    assert facts["thrust of the printed gain"] == pytest.approx(200.2, abs=0.05)
    assert facts["thrust of the decoupled gain"] == pytest.approx(13.5, abs=0.05)
    assert facts["least radius within its rounding"] == pytest.approx(0.977, abs=0.0015)
    assert facts["largest radius within its rounding"] == pytest.approx(0.983, abs=0.0015)


def test_the_printed_gain_is_that_of_the_loop():
    loop = meda2018.loop("KF")
    default = {signal.name: signal.default for signal in loop.block.param_signals_flat()}["controller.feedback.gain"]
    np.testing.assert_array_equal(default, printed_gain.ravel())


# -- Monte-Carlo ------------------------------------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.parametrize("r", sorted({r for _, r in PRINTED}))
def test_protocol_a_with_the_printed_gain(r):
    for which in ESTIMATORS:
        kept, expected = PRINTED[which, r]
        result = result_of(Case(which, r))
        accept_kept(result, kept)
        for metric, (value, error) in expected.items():
            accept(result, metric, value, error)


@pytest.mark.slow
def test_the_documentation_shows_what_comes_out(checkout):
    text = (checkout / "docs" / "studies.md").read_text().split("<!-- meda2018 -->")[1]
    lines = [[cell.strip() for cell in line.strip("|").split("|")] for line in text.strip().splitlines()[2:]]
    assert len(lines) == 10
    for r, which, kept, mse, err in lines:
        row = Row.of_result(result_of(Case(which, float(r))))
        assert row.kept == int(kept)
        assert f"{row.mse:.3g}" == mse
        assert f"{row.err:.3g}" == err


@pytest.mark.slow
def test_another_reading_of_the_noise_would_be_seen():
    """The companion: the process noise is scaled twice, as the paper's eqs. 36 and 37 have it (erratum E16)."""
    wrong = result_of(Case("EKF", 0.1, "C"))
    for metric, (value, error) in PRINTED["EKF", 0.1][1].items():
        with pytest.raises(AssertionError):
            accept(wrong, metric, value, error)


@pytest.mark.slow
def test_the_paper_s_estimator_loses_every_vehicle_and_scores_best():
    small, middle = result_of(Case("JSSE-M", 0.05)), result_of(Case("JSSE-M", 0.1))
    assert middle.count("finite") == 100
    accept(middle, MSE, 0.0035, 2e-4, of="finite")
    assert 3e6 < middle.median(ERR, "finite") < 3e7
    assert small.median(ERR, "finite") == pytest.approx(1.1e7, rel=0.3)
    # the beginning, contracted 2000 times by the printed gain: the specification's 3.8e-39 is for its own draws
    assert 1e-39 < small.mean(MSE, "finite").value < 1e-38


@pytest.mark.slow
@pytest.mark.parametrize("r", DECOUPLED)
def test_protocol_a_with_the_decoupled_gain(r):
    for which, (mse, err) in zip(ESTIMATORS, DECOUPLED[r], strict=True):
        result = result_of(Case(which, r, gain="decoupled"), 50)
        assert result.count("finite") == 50
        accept_kept(result, 0 if err is None else 100)
        accept(result, MSE, mse, of="finite")
        if err is not None:
            accept(result, ERR, err)


@pytest.mark.slow
@pytest.mark.parametrize("r", BIASED)
def test_protocol_m_is_where_the_james_stein_estimator_is_of_use(r):
    for which, err in zip(("KF", "EKF", "JSSE"), BIASED[r], strict=True):
        result = result_of(Case(which, r, "M"), 50)
        assert 2 * result.count("kept") >= 96 - 12
        accept(result, ERR, err)
        if which != "JSSE":
            assert 2.7e3 * 0.95 < result.mean("nees").value < 1.0e4 * 1.05
    assert result_of(Case("JSSE-M", r, "M"), 50).count("kept") == 0


@pytest.mark.slow
def test_the_sweep_over_gamma():
    results = {gamma: result_of(Case("JSSE-M", 0.1, gamma=gamma), 50) for gamma in GAMMAS}
    for gamma, (err, mse) in SWEPT.items():
        accept(results[gamma], ERR, err)
        accept(results[gamma], MSE, mse)
    accept_kept(results[0.0], 2 * 46)
    assert [results[gamma].count("kept") for gamma in (0.06, 0.1, 0.15)] == [0, 0, 0]
    assert results[0.06].count("finite") == 0
    assert results[0.15].mean(MSE, "finite").value == pytest.approx(0.003, abs=0.001)
    best = min(SWEPT, key=lambda gamma: results[gamma].mean(ERR).value)
    assert 0.01 <= best <= 0.02


@pytest.mark.slow
def test_the_reading_itself_fed_back():
    """At r = 0.08 this plantc keeps 77 +- 1 of 100, by three seeds; the 66 of the specification are of 100 runs only."""
    for r, kept, runs in ((0.05, 100, 100), (0.08, 66, 400), (0.1, 0, 100)):
        accept_kept(result_of(Case("none", r), runs), kept)


@pytest.mark.slow
def test_the_rule_of_thumb_of_the_james_stein_estimator():
    for r in (0.01, 0.02, 0.05, 0.08, 0.1):
        mean = result_of(Case("JSSE", r), 20 if r in (0.01, 0.02, 0.08) else 100).mean(ERR)
        low, high = (4.06 * r**2, 4.21 * r**2)
        assert low - 5 * mean.standard_error <= mean.value <= high + 5 * mean.standard_error
    case = Case("JSSE", 0.1)
    loop, settings = case.loop(), case.settings()
    batch, weights = Batch(loop.text), []
    for run in range(5):
        inputs = batch.inputs(2000)
        for name, value in loop.held.items():
            inputs[name] = value
        for channel in channels(loop.noises, settings["std"]):
            field = f"plant_{channel.name}"
            inputs[field] = draw(channel, SEED, run, 2000).reshape(inputs[field].shape)
        answer = batch.run(inputs, batch.params(settings["params"]))
        weights.append(float(np.mean(answer.outputs["controller"]["estimator"]["pose"]["weight"])))
    assert 0.318 * 0.98 < np.mean(weights) < 0.326 * 1.02


@pytest.mark.slow
def test_how_far_the_linear_design_reaches_without_noise():
    for deviation, kept in {0.1: 1.00, 0.2: 1.00, 0.3: 0.92, 0.5: 0.62, 1.0: 0.18}.items():
        found = meda2018.without_noise(deviation, 100, SEED).count("kept") / 100
        assert abs(found - kept) <= 0.1, (deviation, found)


@pytest.mark.slow
def test_protocol_c_is_the_reading_in_which_the_published_plots_could_look_fine():
    means = {which: result_of(Case(which, 0.1, "C"), 30) for which in ("KF", "JSSE-M")}
    accept(means["KF"], MSE, 0.12)
    accept(result_of(Case("JSSE", 0.1, "C"), 30), MSE, 0.60)
    accept(means["JSSE-M"], MSE, 0.0026)
    ekf = result_of(Case("EKF", 0.1, "C"))
    for metric, value in ((MSE, 0.026), (ERR, 0.0021), (REG, 0.028)):
        accept(ekf, metric, value)
    assert means["JSSE-M"].count("kept") == 30
    for metric in (ERR, REG):  # 3 +- 0.5
        accept(means["JSSE-M"], metric, 3.0, 0.5)
    flat = [result_of(Case("JSSE-M", r, "C"), 30) for r in NOISES if r <= 0.1]
    assert all(result.count("kept") == 30 for result in flat)
    values = [result.mean(MSE).value for result in flat]
    assert max(values) < 1.05 * min(values)


@pytest.mark.slow
@pytest.mark.parametrize("protocol", ["A", "B", "C"])
def test_by_the_paper_s_mean_square_the_order_is_the_paper_s_for_small_noise(protocol):
    for r in (0.05, 0.1):
        rows = {which: Row.of_result(result_of(Case(which, r, protocol), 20)) for which in ESTIMATORS}
        assert min(rows, key=lambda which: rows[which].mse) == "JSSE-M"
        assert max(rows, key=lambda which: rows[which].mse) == "JSSE"
        # and by the true state it is not
        alive = {which: row.err for which, row in rows.items() if row.of == "kept"}
        assert min(alive, key=alive.get) == "EKF"


# -- the page ---------------------------------------------------------------------------------------------------------


@pytest.mark.slow
def test_the_study_is_whole_and_its_page_shows_it():
    told = []
    result = meda2018.study(1, SEED, progress=lambda *what: told.append(what))
    assert [table.name for table in result.tables] == [
        "times", "a-printed", "a-decoupled", "b-printed", "c-printed", "m-printed", "gamma", "raw", "noise-free", "gain",
    ]  # fmt: skip
    for name in ("a-printed", "m-printed"):
        rows = result.table(name)
        assert [(row["r"], row["estimator"]) for row in rows] == [(r, which) for r in NOISES for which in ESTIMATORS]
        assert all(row["kept"] + row["lost"] + row["diverged"] == 1 for row in rows)
    assert all(float(row["here, s"]) > 0 for row in result.table("times"))
    assert result.conditions["Runs of each case"] == 1
    assert {item.verdict for item in result.comparisons} == {
        "reproduces", "does not reproduce", "shown wrong", "cannot be compared",
    }  # fmt: skip
    assert all(item.why for item in result.comparisons if item.verdict != "reproduces")
    done = [at for _, at, _ in told]
    assert done == sorted(done)
    assert told[-1][1] == told[-1][2]
    json.dumps(result.results(), allow_nan=False)
    # a row of the table is what the case gives
    row = next(row for row in result.table("a-printed") if (row["r"], row["estimator"]) == (0.1, "EKF"))
    assert row["ERR"] == evaluate(Case("EKF", 0.1), 1, SEED).mean(ERR).value
    page = study_page(result)
    assert page.count("<svg") == len(result.pictures) == 6
    for text in ("shown wrong", "3.06e-07", "Eq. 45 compares the estimate with the set point", "0.9804"):
        assert text in page
    assert set(re.findall(r'(?:href="|url\()#([^")]+)', page)) <= set(re.findall(r'\bid="([^"]+)"', page))


def stands_for(case):
    """Rows like those of the study, so that verdicts are told from them."""
    alive = Row(20, 0, 0, "kept", case.r, 1e-4, case.r / 10, 1e-4, case.r, 12.0)
    blind = Row(0, 20, 0, "finite", 1e-3, float("nan"), 1e7, float("nan"), 1e7, float("nan"))
    return blind if case.estimator == "JSSE-M" and case.protocol == "A" and case.r <= 0.1 else alive


def test_a_verdict_follows_the_numbers():
    """Planted: the rows of EKF and JSSE-M change places, and each verdict about them turns round."""
    other = {"EKF": "JSSE-M", "JSSE-M": "EKF"}
    found, summaries = [], []
    for names in ({}, other):
        rows = {
            case: stands_for(replace(case, estimator=names.get(case.estimator, case.estimator)))
            for case in meda2018.cases()
        }
        found.append({item.published.split(":")[0]: item.verdict for item in meda2018._of_figures(rows)})
        summaries.append(meda2018._summary(rows))
    honest, planted = found
    assert "is the best at r = 0.1" in summaries[0] and "is not the best at r = 0.1" in summaries[1]
    for statement, right, turned in (
        ("Fig. 4, as the text tells it", "reproduces", "does not reproduce"),
        ("eq. 45 is the error of the estimates", "shown wrong", "reproduces"),
        ("Section IV", "shown wrong", "reproduces"),
        ("eq. 25", "shown wrong", "reproduces"),
    ):
        assert (honest[statement], planted[statement]) == (right, turned)


def test_without_data_nothing_is_said_of_the_paper():
    """Every run is lost, whatever the estimator: no row has a number."""
    dead = Row(0, 0, 20, "", *[float("nan")] * 6)
    rows = dict.fromkeys(meda2018.cases(), dead)
    items = [
        *meda2018._of_figures(rows),
        *meda2018._of_claims(rows),
        *meda2018._of_times(dict.fromkeys(ESTIMATORS, np.nan)),
    ]
    assert {item.verdict for item in items} == {"cannot be compared"}
    assert all(item.why for item in items)
    assert "Too few runs are left to compare" in meda2018._summary(rows)
    # half of it: the loops that are not JSSE-M live, and what needs no other is said
    rows = {case: dead if case.estimator == "JSSE-M" else stands_for(case) for case in meda2018.cases()}
    told = {item.published.split(":")[0]: item.verdict for item in meda2018._of_figures(rows)}
    assert told["eq. 45 is the error of the estimates"] == "cannot be compared"
    assert told["Section IV"] == "shown wrong"


def test_times_are_compared_as_ratios():
    items = meda2018._of_times({"KF": 2.0, "EKF": 10.0, "JSSE": 0.4, "JSSE-M": 0.4})
    assert [item.verdict for item in items] == [
        "reproduces", "does not reproduce", "does not reproduce", "reproduces",
    ]  # fmt: skip
    assert all(item.measured for item in items)


@pytest.mark.slow
def test_other_processes_give_the_same_numbers():
    some = [Case("EKF", 0.1), Case("KF", 0.05, "B")]
    row = functools.partial(meda2018._row, runs=2, seed=SEED, on=None, jobs=1)
    assert list(each(row, some, 2)) == [Row.of_result(evaluate(case, 2, SEED)) for case in some]


@pytest.mark.slow
def test_a_run_played_again_is_that_of_the_monte_carlo():
    case = Case("EKF", 0.1, "C")
    history = replay(case.loop(), 3, steps=2000, seed=SEED, **case.settings())
    assert judge(history, meda2018.LIMITS) == evaluate(case, 4, SEED).judgements[3]
