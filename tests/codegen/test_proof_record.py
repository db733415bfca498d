"""Every example is proved, as the record says, and a record of other C says nothing."""

from dataclasses import replace
from pathlib import Path

import pytest
from plantc.codegen import proof, proof_record
from plantc.codegen.proof import prove
from plantc.codegen.proof_record import not_on_record, read_record, record_proof, record_text
from plantc.examples.pendulum import pendulum_ekf

from plantc import emit
from plantc.regenerate import CONTROLLERS, EXAMPLES, REGULATORS

FILE = Path(__file__).resolve().parents[2] / "generated_c" / "proofs.json"
RECORD = read_record(FILE)
PENDULUM = emit(pendulum_ekf, "float")

AGAIN = {"pendulum_ekf": 100} | {block.name: 0 for block, _ in CONTROLLERS + REGULATORS}
"""How many functions are proved again here, the quickest first, so that the analyser is seen to give what is on record."""


@pytest.mark.slow
@pytest.mark.parametrize(("block", "precision"), EXAMPLES, ids=[block.name for block, _ in EXAMPLES])
def test_no_sequence_of_calls_takes_the_memory_out_of_its_ranges(needs, block, precision):
    needs("frama-c")
    text = emit(block, precision)
    assert not_on_record(block, text, RECORD) == [], "run python -m plantc.regenerate --prove"
    assert set(block.entries) <= set(RECORD[block.name])
    quickest = sorted(RECORD[block.name], key=lambda name: RECORD[block.name][name].seconds)
    again = quickest[: AGAIN.get(block.name, 3)]
    if not again:
        return
    found = prove(block, text, again)
    assert [(check.name, check.note) for check in found.checks if not check.passed] == []
    assert {name: RECORD[block.name][name].properties for name in again} == found.facts["proof"]


def test_nothing_but_the_examples_is_on_record():
    assert set(RECORD) == {block.name for block, _ in EXAMPLES}


@pytest.mark.parametrize("part", ["source", "header"])
def test_other_c_is_not_on_record(needs, part):
    needs("frama-c")
    assert not_on_record(pendulum_ekf, PENDULUM, RECORD) == []
    changed = replace(PENDULUM, **{part: getattr(PENDULUM, part).replace("78", "79").replace("1.0f", "1.5f") + "\n"})
    assert set(not_on_record(pendulum_ekf, changed, RECORD)) == set(RECORD["pendulum_ekf"])


@pytest.mark.parametrize(
    ("name", "other"),
    [("analyser", lambda: "24.0"), ("OPTIONS", ["-eva"]), ("JUDGES", proof_record.JUDGES[1:])],
)
def test_what_another_analyser_proved_is_not_on_record(needs, monkeypatch, name, other):
    needs("frama-c")
    monkeypatch.setattr(proof_record, name, other)
    assert set(not_on_record(pendulum_ekf, PENDULUM, RECORD)) == set(RECORD["pendulum_ekf"])


def test_a_proof_is_on_record_with_the_effort_it_took(needs, monkeypatch):
    """Not with another, and whatever would be tried today."""
    needs("frama-c")
    known = dict(RECORD["pendulum_ekf"])
    known["hold_variances"] = replace(known["hold_variances"], efforts=[20000])
    assert not_on_record(pendulum_ekf, PENDULUM, {"pendulum_ekf": known}) == ["hold_variances"]
    monkeypatch.setattr(proof, "EFFORTS", {})
    assert not_on_record(pendulum_ekf, PENDULUM, RECORD) == []


def test_what_is_not_on_record_is_proved_and_what_is_not_proved_is_told(needs, tmp_path):
    needs("frama-c")
    before, after = "((after->omega <= 100.0f) == true)", "true"
    assert before in PENDULUM.source
    broken = replace(PENDULUM, source=PENDULUM.source.replace(before, after))
    proved, faults = record_proof(pendulum_ekf, broken, RECORD)
    assert "predict_core" not in proved
    assert "predict_core" in " ".join(faults)
    assert proved["init"].digest != RECORD["pendulum_ekf"]["init"].digest
    (tmp_path / "proofs.json").write_text(record_text({"pendulum_ekf": proved}))
    assert read_record(tmp_path / "proofs.json") == {"pendulum_ekf": proved}
    assert not_on_record(pendulum_ekf, broken, {"pendulum_ekf": proved}) == [fault.split(":")[0] for fault in faults]
