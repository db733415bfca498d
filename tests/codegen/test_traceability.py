"""trace.json leads from a line of the model to the C and to the vectors, and back."""

import json
from dataclasses import replace

import pytest
from plantc.codegen.emit import emit
from plantc.codegen.package import build_files
from plantc.codegen.provenance import orphans
from plantc.codegen.traceability import trace_text
from plantc.examples.pendulum import pendulum_ekf


@pytest.fixture(scope="module")
def files():
    return build_files(pendulum_ekf, "float")


@pytest.fixture(scope="module")
def trace(files):
    return json.loads(files["trace.json"])


def lines_of(trace, parent):
    return [run[:2] for run in trace["lines"]["src/pendulum_ekf.c"] if run[2] == parent]


def without_parent(trace, source):
    """Return the lines with code that the trace gives no parent (a lexical scan of its own)."""
    covered = {k for first, last, _ in trace["lines"]["src/pendulum_ekf.c"] for k in range(first, last + 1)}
    lost, comment = [], False
    for number, line in enumerate(source.split("\n"), start=1):
        text = line.strip()
        comment = comment or text.startswith("/*")
        if text and not comment and not text.startswith("#") and number not in covered:
            lost.append(number)
        if text.endswith("*/"):
            comment = False
    return lost


def test_a_line_of_the_model_leads_to_c_and_to_vectors(files, trace):
    at = trace["sources"]["pendulum.py:18"]
    parents = [trace["parents"][k] for k in at]
    equation = next(item for item in parents if item["kind"] == "dynamics")
    assert equation["text"].startswith("omega' = (torque + draught")
    source = files["src/pendulum_ekf.c"].split("\n")
    code = "\n".join(line for first, last in lines_of(trace, equation["id"]) for line in source[first - 1 : last])
    assert "after->omega = omega + " in code
    assert equation["vectors"]
    for index in equation["vectors"]:
        assert trace["vectors"][index]["entry"] in ("predict", "step")
        assert equation["id"] in trace["vectors"][index]["parents"]


def test_no_statement_lacks_a_parent_and_one_that_does_is_found(files, trace):
    source = files["src/pendulum_ekf.c"]
    assert without_parent(trace, source) == []
    kernel = next(item["id"] for item in trace["parents"] if item["kind"] == "kernel")
    first = lines_of(trace, kernel)[0]
    less = {**trace, "lines": {name: [r for r in runs if r[2] != kernel] for name, runs in trace["lines"].items()}}
    assert first[0] in without_parent(less, source)
    text = emit(pendulum_ekf, "float")
    at = next(k for k, item in enumerate(text.provenance.lines) if item is not None)
    lines = [None if item == text.provenance.lines[at] else item for item in text.provenance.lines]
    assert at + 1 in orphans(text.source, replace(text.provenance, lines=lines))


def test_every_parent_but_a_helper_has_a_line_of_the_model_and_a_vector(trace):
    for parent in trace["parents"]:
        if parent["kind"] != "helper":
            assert parent["sources"], parent
            assert parent["vectors"], parent
    assert all("/" not in source for source in trace["sources"])


def test_the_vectors_are_those_that_ship(files, trace):
    shipped = files["test/test_vectors.c"].count("{ ENTRY_")
    assert len(trace["vectors"]) == shipped
    assert json.loads(files["manifest.json"])["vectors"] == shipped


def test_the_trace_of_every_shape_is_complete(small_shape):
    text = emit(small_shape, "double")
    trace = json.loads(trace_text(small_shape, text, []))
    assert all(parent["sources"] for parent in trace["parents"] if parent["kind"] != "helper")
    assert {run[2] for runs in trace["lines"].values() for run in runs} == set(range(len(trace["parents"])))
