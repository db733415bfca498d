"""gcov counts what the vectors reach; a vector that is missing is caught."""

import re

import pytest
from plantc.codegen import coverage
from plantc.codegen.coverage import measure_coverage
from plantc.codegen.emit import emit
from plantc.codegen.package import _rare_calls, build_files, export
from plantc.examples.pendulum import pendulum_ekf
from plantc.symbolic import Block
from plantc.symbolic.composition import connect


@pytest.fixture(scope="module")
def drafted():
    calls = _rare_calls(pendulum_ekf, "float").calls
    return build_files(pendulum_ekf, "float"), emit(pendulum_ekf, "float").provenance, calls


def test_the_vectors_reach_every_statement_and_the_rest_has_reasons(drafted, needs):
    needs("gcc", "gcov")
    files, provenance, calls = drafted
    found = measure_coverage(pendulum_ekf, "float", files, provenance, calls)
    (check,) = found.checks
    assert check.passed, check.note
    facts = found.facts["coverage"]
    assert facts["statements"]["all"] > 200
    # the initial variances that init accepts are within floor and ceiling
    missed = [item for item in facts["unreachable"] if item["what"] == "statement"]
    assert facts["statements"]["all"] - facts["statements"]["reached"] == len(missed)
    for item in (item for item in missed if "mathematical" not in item["reason"]):
        assert provenance.of_line(item["line"]).entry == "init"
        assert "hold_variances" in item["text"]
    # hold_variances has brought each variance to its floor before is_held looks at it
    assert all("covariance[" in item["text"] and ">=" in item["text"] for item in unexplained(facts))
    assert facts["branches"]["reached"] > 0.9 * facts["branches"]["all"]
    assert all(item["reason"] for item in facts["unreachable"])
    assert all(item["reason"] != coverage.ONLY_CORPUS for item in facts["unreachable"])
    executable = set(range(1, len(files["src/pendulum_ekf.c"].split("\n")) + 1))
    assert {item["line"] for item in facts["unreachable"]} <= executable


def test_every_line_that_gcov_counts_has_a_parent(drafted, needs, tmp_path):
    needs("gcc", "gcov")
    files, provenance, _ = drafted
    bench = coverage._Bench(tmp_path, pendulum_ekf, "float", files)
    counts = bench.after_vectors()
    assert counts.lines
    assert [number for number in counts.lines if provenance.of_line(number) is None] == []


@pytest.mark.parametrize("entry", ["INFLATE", "INIT", "UPDATE_ENCODER"])
def test_vectors_that_are_missing_fail_the_export(drafted, needs, entry):
    needs("gcc", "gcov")
    files, provenance, calls = drafted
    runner = files["test/test_vectors.c"]
    fewer = re.sub(rf"    {{ ENTRY_{entry}, .*\n", "", runner)
    assert fewer != runner
    found = measure_coverage(pendulum_ekf, "float", {**files, "test/test_vectors.c": fewer}, provenance, calls)
    assert not found.checks[0].passed
    assert "that no shipped vector runs; first line" in found.checks[0].note


def test_a_single_status_that_is_missing_fails_the_export(drafted, needs):
    needs("gcc", "gcov")
    files, provenance, calls = drafted
    runner = files["test/test_vectors.c"]
    fewer = re.sub(r"    { ENTRY_\w+, .*RECOVERED },?\n", "", runner)
    assert fewer != runner
    found = measure_coverage(pendulum_ekf, "float", {**files, "test/test_vectors.c": fewer}, provenance, calls)
    assert not found.checks[0].passed


def test_without_gcov_the_evidence_says_so(drafted, monkeypatch):
    monkeypatch.setattr(coverage.shutil, "which", lambda tool: None)
    files, provenance, calls = drafted
    found = measure_coverage(pendulum_ekf, "float", files, provenance, calls)
    assert found.checks == []
    assert found.facts["coverage"] == "not measured: gcc and gcov not found; install gcc, which brings gcov"


def unexplained(facts):
    """Branches that no call took and that are neither a defence nor a case of a mathematical function."""
    return [
        item
        for item in facts["unreachable"]
        if "branch" in item["what"] and "defence" not in item["reason"] and "mathematical" not in item["reason"]
    ]


def test_shapes_pass_the_gate(small_shape, needs):
    needs("gcc", "gcov")
    files, text = build_files(small_shape, "double"), emit(small_shape, "double")
    calls = _rare_calls(small_shape, "double").calls
    found = measure_coverage(small_shape, "double", files, text.provenance, calls)
    assert found.checks[0].passed, found.checks[0].note
    facts = found.facts["coverage"]
    assert all(item["reason"] != coverage.ONLY_CORPUS for item in facts["unreachable"])
    assert len(unexplained(facts)) <= 0.05 * facts["branches"]["all"]


@pytest.mark.slow
@pytest.mark.parametrize(("name", "precision"), [("quadrotor_ekf", "double"), ("attitude_ekf", "float")])
def test_the_large_examples_leave_nothing_to_the_corpus(shape_named, needs, name, precision):
    needs("gcc", "gcov")
    block = shape_named(name)
    calls = _rare_calls(block, precision).calls
    found = measure_coverage(block, precision, build_files(block, precision), emit(block, precision).provenance, calls)
    assert found.checks[0].passed, found.checks[0].note
    assert all(item["reason"] != coverage.ONLY_CORPUS for item in found.facts["coverage"]["unreachable"])
    assert len(unexplained(found.facts["coverage"])) <= 16


def filtered_encoder():
    """A low-pass filter before an estimator, whose own entries a user can no longer call one by one."""
    block = Block("low_pass", doc="first-order low-pass filter")
    raw = block.input("raw", unit="rad", range=(-10, 10))
    weight = block.parameter("weight", 0.1, range=(0, 1))
    smooth = block.memory("smooth", initial=0.0, unit="rad", range=(-10, 10))
    following = smooth + weight * (raw - smooth)
    block.entry("step", inputs=[raw], following={smooth: following}, outputs={"filtered": following})
    return connect({"low_pass": block, "ekf": pendulum_ekf}, {"ekf.encoder": "low_pass.filtered"}, "filtered_encoder")


COMPOSITIONS = {
    "filter and estimator": filtered_encoder,
    "two estimators": lambda: connect({"left": pendulum_ekf, "right": pendulum_ekf}, {}, "two_pendulums"),
}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "precision"),
    [("filter and estimator", "double"), ("filter and estimator", "float"), ("two estimators", "double")],
)
def test_compositions_of_estimators_export_in_full(name, precision, tmp_path, needs):
    needs("gcc", "gcov")
    done = export(COMPOSITIONS[name](), tmp_path, precision=precision, steps=50)
    (check,) = [item for item in done.check.results if item.name == "vectors reach every statement"]
    assert check.passed
    counted = done.evidence["coverage"]["statements"]
    assert counted["reached"] >= 0.93 * counted["all"]
