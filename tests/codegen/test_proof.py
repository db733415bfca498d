"""Frama-C's EVA on the C of every example: what it proves, and that planted faults are alarms."""

from dataclasses import replace

import pytest
from plantc.codegen.proof import ProofError, proof_tasks, prove, replaced
from plantc.examples.pendulum import pendulum_ekf

from plantc import Block, connect, emit
from plantc.regenerate import EXAMPLES

FLOAT = emit(pendulum_ekf, "float")


def test_every_entry_and_every_judgement_is_a_task():
    tasks = {task.name: task for task in proof_tasks(pendulum_ekf, FLOAT)}
    assert set(tasks) == {"is_held", "is_bounded", "hold_variances", *pendulum_ekf.entries}
    low, high = (-100.0).hex(), (100.0).hex()  # a decimal would be a real number there
    assert f"{low} <= state.omega <= {high}" in tasks["predict"].harness
    # what a stub stands for is proved in the same run
    assert "assert before != after" in tasks["step"].source
    for name in ("predict", "update_encoder", "inflate"):
        assert name in tasks


def test_only_the_bodies_of_the_callees_are_replaced():
    changed = replaced(FLOAT.source, {"pendulum_ekf_is_held": ["    return false;"]})
    kept = [line for line in FLOAT.source.split("\n") if line in changed]
    assert len(FLOAT.source.split("\n")) - len(kept) < 15
    with pytest.raises(ProofError, match="no static function pendulum_ekf_absent"):
        replaced(FLOAT.source, {"pendulum_ekf_absent": []})


def test_a_composition_is_refused_in_a_sentence():
    gain = Block("gain")
    u = gain.input("u")
    gain.entry("step", inputs=[u], outputs={"y": 2 * u})
    both = connect({"gain": gain}, {}, "both")
    with pytest.raises(ProofError, match="composition"):
        proof_tasks(both, emit(both))


@pytest.mark.slow
@pytest.mark.parametrize(("block", "precision"), EXAMPLES, ids=[block.name for block, _ in EXAMPLES])
def test_no_sequence_of_calls_takes_the_memory_out_of_its_ranges(needs, block, precision):
    needs("frama-c")
    found = prove(block, emit(block, precision))
    assert [(check.name, check.note) for check in found.checks if not check.passed] == []
    assert set(block.entries) <= set(found.facts["proof"])


FAULTS = {
    "a range check removed": ("predict", "((after->omega <= 100.0f) == true)", "true"),
    "an element not judged": ("is_bounded", "&& ((covariance[1] <= ", "&& ((covariance[0] <= "),
    "an element of the exact test": ("is_held", "(i < 3U) && held", "(i < 2U) && held"),
    "commit before judge": (
        "predict",
        "    if (status >= PENDULUM_EKF_OK)\n    {\n        *state = after;\n    }",
        "    *state = after;",
    ),
    "a refused update is kept": ("step", "if (own >= PENDULUM_EKF_OK)", "if (own >= PENDULUM_EKF_OVERFLOW)"),
    "a counter never written": (
        "predict",
        "    after->rejected_encoder = before->rejected_encoder;\n",
        "",
    ),
    "a counter never reset": ("update_encoder", "                    after->rejected_encoder = 0U;\n", ""),
    "a status never written": ("step", "            out->status_encoder = PENDULUM_EKF_OK;\n", ""),
    "a status that the stub does not return": (
        "hold_variances",
        "status = PENDULUM_EKF_CLAMPED;",
        "status = PENDULUM_EKF_RECOVERED;",
    ),
    "held without the exact test": ("hold_variances", "(!pendulum_ekf_is_held(covariance))", "(covariance[0] < 0.0f)"),
}


@pytest.mark.slow
@pytest.mark.parametrize("fault", FAULTS)
def test_a_planted_fault_is_seen(needs, fault):
    needs("frama-c")
    where, before, after = FAULTS[fault]
    assert before in FLOAT.source
    broken = replace(FLOAT, source=FLOAT.source.replace(before, after))
    (check,) = prove(pendulum_ekf, broken, [where]).checks
    assert not check.passed


def test_an_analysis_that_does_not_end_is_a_failed_proof(needs):
    needs("frama-c")
    (check,) = prove(pendulum_ekf, FLOAT, ["is_held"], seconds=0.05).checks
    assert not check.passed
    assert "not done after" in check.note


def test_c_that_cannot_be_read_is_told_in_a_sentence(needs):
    needs("frama-c")
    with pytest.raises(ProofError, match="no report; mend the C"):
        prove(pendulum_ekf, replace(FLOAT, source=FLOAT.source + "\nint;;= x\n"), ["is_held"])
