"""The table of conditioning: measured, true to what is known, and in the report of the filter that brings it."""

import json

import pytest
from plantc.codegen.package import measure_tables
from plantc.codegen.report import report_html
from plantc.examples import conditioning
from plantc.examples.quadrotor_ud import quadrotor_ud


@pytest.mark.slow
def test_the_report_of_the_factored_filter_shows_it(monkeypatch, checkout, needs):
    """A few steps of the hardest case; tests/test_benchmarks.py runs all."""
    needs("gcc")
    whole = conditioning.table
    monkeypatch.setattr(conditioning, "table", lambda: whole(conditioning.CASES[-1:], 6))
    (table,) = measure_tables(quadrotor_ud).facts["tables"]
    assert json.loads(json.dumps(table, allow_nan=False))["title"] == "Conditioning"
    rows = {row[1]: row for row in table["rows"]}
    assert list(rows) == [*conditioning.FORMS, conditioning.TEXTBOOK]
    assert rows["ud"][2:4] == ("never in 6", 0)
    assert rows["ud"][4] < 2.0
    assert rows["conventional"][2:4] == (1, 5)  # it can tell a loss
    assert rows[conditioning.TEXTBOOK][3] > 0
    manifest = json.loads((checkout / "generated_c/quadrotor_ud/manifest.json").read_text())
    evidence = {"name": "quadrotor_ud", "precision": "float", "checks": [], "tables": [table]}
    page = report_html(quadrotor_ud, manifest, evidence, [])
    assert '<a href="#table-1">Conditioning</a>' in page
    assert "<caption>Steps until the covariance is lost, by form, of 6</caption>" in page
    for form, row in rows.items():
        assert f"<td>{form}</td>\n<td>{row[2]}</td>\n<td>{row[3]}</td>" in page


def test_a_matrix_is_judged_exactly():
    assert conditioning.is_definite([[1.0, 1.0], [1.0, 1.0 + 2**-52]])
    assert not conditioning.is_definite([[1.0, 1.0], [1.0, 1.0]])
    assert not conditioning.is_definite([[1.0, float("nan")], [float("nan"), 1.0]])
