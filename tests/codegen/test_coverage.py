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
        assert item["reason"] == coverage.PROVED
    # hold_variances has brought each variance to its floor before is_held looks at it
    again = [item for item in facts["unreachable"] if "covariance[" in item["text"] and ">=" in item["text"]]
    assert [item["reason"].split(":")[0] for item in again] == ["implied"] * 2
    # a square over what is positive is never negative, which ranges alone do not prove
    assert [item["text"].split(" >=")[0] for item in unexplained(facts)] == ["if (!(((nis[0]"]
    assert f"no reason is known for {facts['no_reason_known']} of them" in check.note
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
    (check,) = found.checks
    assert (check.name, check.verdict) == ("vectors reach every statement", "not judged")
    assert check.remark == "not judged: gcc and gcov not found; install gcc, which brings gcov"
    assert found.facts["coverage"] == "not measured: gcc and gcov not found; install gcc, which brings gcov"


def test_a_gcov_that_fails_is_not_judged(drafted, needs, monkeypatch):
    needs("gcc", "gcov")

    def broken(self):
        raise coverage.CountingError("gcov failed while coverage was counted")

    monkeypatch.setattr(coverage._Bench, "after_vectors", broken)
    files, provenance, calls = drafted
    found = measure_coverage(pendulum_ekf, "float", files, provenance, calls)
    assert [item.verdict for item in found.checks] == ["not judged"]
    assert found.facts["coverage"].startswith("not measured: gcov failed")


@pytest.mark.parametrize("range_", ["(encoder <= 1000.0f)", "(params->length <= 100.0f)"])
def test_a_verdict_that_never_fires_is_a_fault(drafted, needs, range_):
    """Planted: what refuses an input or a parameter is there, but nothing gets it to."""
    needs("gcc", "gcov")
    files, provenance, calls = drafted
    source = files["src/pendulum_ekf.c"]
    status = "BAD_INPUT" if "encoder" in range_ else "BAD_PARAM"
    lines = source.split("\n")
    at = next(k for k, line in enumerate(lines) if range_ in line)
    start = next(k for k in range(at, 0, -1) if lines[k].lstrip().startswith("if (!"))
    stop = next(k for k in range(at, len(lines)) if f"status = PENDULUM_EKF_{status};" in lines[k])
    assert stop - start < 20
    value = range_[1:].split(" ")[0]  # equal to two numbers at once: what the compiler does not see
    lines[start] = lines[start].replace("if (!", f"if (({value} == 0.0f) && ({value} == 1.0f) && !", 1)
    planted = {**files, "src/pendulum_ekf.c": "\n".join(lines)}
    (check,) = measure_coverage(pendulum_ekf, "float", planted, provenance, calls).checks
    assert check.verdict == "failed"
    assert re.search(rf"first line \d+: .*(status = PENDULUM_EKF_{status};|{re.escape(range_)})", check.note)


def unexplained(facts):
    """What no call reached for no known reason, cases of mathematical functions left out."""
    return [
        item
        for item in facts["unreachable"]
        if coverage.NO_REASON in item["reason"] and "mathematical" not in item["reason"]
    ]


def test_shapes_pass_the_gate(small_shape, needs):
    needs("gcc", "gcov")
    files, text = build_files(small_shape, "double"), emit(small_shape, "double")
    calls = _rare_calls(small_shape, "double").calls
    found = measure_coverage(small_shape, "double", files, text.provenance, calls)
    assert found.checks[0].passed, found.checks[0].note
    facts = found.facts["coverage"]
    assert all(item["reason"] != coverage.ONLY_CORPUS for item in facts["unreachable"])
    # judgements inside a part of what another part computed within their bounds are among these
    assert len(unexplained(facts)) <= 0.1 * facts["branches"]["all"]


@pytest.mark.slow
@pytest.mark.parametrize(("name", "precision"), [("quadrotor_ekf", "double"), ("attitude_ekf", "float")])
def test_the_large_examples_leave_nothing_to_the_corpus(shape_named, needs, name, precision):
    needs("gcc", "gcov")
    block = shape_named(name)
    calls = _rare_calls(block, precision).calls
    found = measure_coverage(block, precision, build_files(block, precision), emit(block, precision).provenance, calls)
    assert found.checks[0].passed, found.checks[0].note
    assert all(item["reason"] != coverage.ONLY_CORPUS for item in found.facts["coverage"]["unreachable"])
    assert len(unexplained(found.facts["coverage"])) <= 20  # bounds of a unit quaternion, most of them


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
