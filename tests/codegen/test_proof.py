"""Frama-C's EVA on the C of every example: what it proves, and that planted faults are alarms."""

import re
from dataclasses import replace

import pytest
from plantc.codegen import proof
from plantc.codegen.proof import ProofError, proof_tasks, prove, replaced
from plantc.examples.pendulum import pendulum, pendulum_ekf
from plantc.symbolic.james_stein import james_stein_estimator
from plantc.symbolic.simulated import simulated_plant

from plantc import Block, connect, emit, state_feedback, wires

FLOAT = emit(pendulum_ekf, "float")


def controlled():
    """The pendulum's filter and a feedback whose command comes back to it one step late."""
    feedback = state_feedback(SAMPLED, {}, [[2.0, 0.5]], saturate=True, name="feedback")
    lines = {
        **wires("estimator", "feedback", SAMPLED.states),
        **wires("feedback", "estimator", SAMPLED.inputs, initial={"torque": 0.0}),
    }
    return connect({"estimator": pendulum_ekf, "feedback": feedback}, lines, "pendulum_control")


SAMPLED = pendulum.discretise("euler", dt=(1e-5, 0.1))
CONTROL = controlled()
CONTROL_FLOAT = emit(CONTROL, "float")


def test_every_entry_and_every_judgement_is_a_task():
    tasks = {task.name: task for task in proof_tasks(pendulum_ekf, FLOAT)}
    assert set(tasks) == {"is_held", "is_bounded", "hold_variances", *pendulum_ekf.entries} | {
        "predict_core", "update_encoder_core", "inflate_core"
    }  # fmt: skip
    low, high = (-100.0).hex(), (100.0).hex()  # a decimal would be a real number there
    assert f"{low} <= state.omega <= {high}" in tasks["predict"].harness
    # what a stub stands for is proved in the same run
    assert "assert before != after" in tasks["step"].source
    for name in ("predict_core", "update_encoder_core", "inflate_core"):
        assert "Frama_C_float_interval" not in tasks[name].source.split(f"pendulum_ekf_{name}(")[1].split("\n}\n")[0]


def test_only_the_bodies_of_the_callees_are_replaced():
    changed = replaced(FLOAT.source, {"pendulum_ekf_is_held": ["    return false;"]})
    kept = [line for line in FLOAT.source.split("\n") if line in changed]
    assert len(FLOAT.source.split("\n")) - len(kept) < 15
    with pytest.raises(ProofError, match="no static function pendulum_ekf_absent"):
        replaced(FLOAT.source, {"pendulum_ekf_absent": []})


def test_every_core_of_a_part_is_a_task():
    tasks = {task.name: task for task in proof_tasks(CONTROL, CONTROL_FLOAT)}
    judged = ("is_held", "is_bounded", "hold_variances")
    cores = ("init_core", "predict_core", "update_encoder_core", "inflate_core", "step_core")
    expected = {"init", "step", "feedback.init_core", "feedback.step_core"}
    assert set(tasks) == expected | {f"estimator.{name}" for name in (*judged, *cores)}
    stubbed = tasks["step"].source
    for part in ("estimator", "feedback"):  # what a stub requires, and what it leaves where it refuses
        body = stubbed.split(f"pendulum_control_{part}_step_core(")[1].split("\n}\n")[0]
        assert "assert before != after" in body
        assert "assert \\is_finite((*params)." in body
        assert f"leave_pendulum_control_{part}_step_out_t(out)" in body


def smoothing():
    block = Block("low_pass")
    raw = block.input("raw", range=(-10, 10))
    weight = block.parameter("weight", 0.1, range=(0, 1))
    smooth = block.memory("smooth", range=(-10, 10))
    following = smooth + weight * (raw - smooth)
    block.entry("step", inputs=[raw], following={smooth: following}, outputs={"filtered": following})
    return block


def test_a_composition_in_a_composition_has_the_tasks_of_both():
    smooth = smoothing()
    inner = connect({"a": smooth, "b": smooth}, {"b.raw": "a.filtered"}, "inner")
    outer = connect({"inner": inner}, {}, "outer")
    names = [task.name for task in proof_tasks(outer, emit(outer))]
    assert "inner.a.step_core" in names
    assert "inner.step_core" in names
    assert names[-2:] == ["init", "step"]


FAULTS = {
    "a range check removed": ("predict_core", "((after->omega <= 100.0f) == true)", "true"),
    "an element not judged": ("is_bounded", "&& ((covariance[1] <= ", "&& ((covariance[0] <= "),
    "an element of the exact test": ("is_held", "(i < 3U) && held", "(i < 2U) && held"),
    "commit before judge": (
        "predict",
        "    if (status >= PENDULUM_EKF_OK)\n    {\n        *state = after;\n    }",
        "    *state = after;",
    ),
    "a refused update is kept": ("step", "if (own >= PENDULUM_EKF_OK)", "if (own >= PENDULUM_EKF_OVERFLOW)"),
    "a counter never written": (
        "predict_core",
        "    after->rejected_encoder = before->rejected_encoder;\n",
        "",
    ),
    "a counter never reset": ("update_encoder_core", "                    after->rejected_encoder = 0U;\n", ""),
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


_PART = "(status_{0} < PENDULUM_CONTROL_OK) ? status_{0} : pendulum_control_higher(status, status_{0})"

FAULTS_OF_A_COMPOSITION = {
    "a refused part is committed": ("step", _PART.format("estimator"), "pendulum_control_higher(status, status_estimator)"),
    "a delayed command not judged": (
        "step",
        "((after->delay_estimator_torque <= 10.0f) == true)",
        "((after->delay_estimator_torque <= 1.0e30f) == true)",
    ),
    "a part called from its own result": ("step", "(&before->estimator, &after->estimator,", "(&after->estimator, &after->estimator,"),
    "a part never started": (
        "init",
        "status_feedback = pendulum_control_feedback_init_core(&after->feedback, &params->feedback);",
        "status_feedback = PENDULUM_CONTROL_OK;",
    ),
    "an output of a part not written": (
        "estimator.step_core",
        "out->encoder.nis = 0.0f; out->status_encoder",
        "out->status_encoder",
    ),
    "a memory of a part not written": (
        "estimator.predict_core",
        "after->rejected_encoder = before->rejected_encoder;",
        "",
    ),
    "a parameter of a part not judged": ("feedback.init_core", "&& ((params->gain[1] <= 1000000.0f) == true)", ""),
    "a gate outside its range": ("estimator.step_core", "encoder, 0.0f, &out->encoder", "encoder, -1.0f, &out->encoder"),
}  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("fault", FAULTS_OF_A_COMPOSITION)
def test_a_fault_planted_in_a_composition_is_seen(needs, fault):
    needs("frama-c")
    where, before, after = FAULTS_OF_A_COMPOSITION[fault]
    broken, count = re.subn(r"\s+".join(map(re.escape, before.split())), after, CONTROL_FLOAT.source)
    assert count > 0
    (check,) = prove(CONTROL, replace(CONTROL_FLOAT, source=broken), [where]).checks
    assert not check.passed
    assert "Unknown" in check.note or "Invalid" in check.note


@pytest.mark.slow
def test_a_filter_and_a_feedback_are_proved_together(needs):
    needs("frama-c")
    found = prove(CONTROL, CONTROL_FLOAT)
    assert [(check.name, check.note) for check in found.checks if not check.passed] == []
    assert {"init", "step", "estimator.step_core", "feedback.step_core"} <= set(found.facts["proof"])


SMALL = {
    "feedback": lambda: CONTROL.parts["feedback"],
    "low pass": smoothing,
    "simulated plant": lambda: simulated_plant(SAMPLED),
    "James-Stein": lambda: james_stein_estimator(SAMPLED, rank_deficient="reduce"),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", SMALL)
def test_a_block_without_a_covariance_is_proved(needs, name):
    needs("frama-c")
    block = SMALL[name]()
    found = prove(block, emit(block, "float"))
    assert [(check.name, check.note) for check in found.checks if not check.passed] == []
    assert {"init", "step"} <= set(found.facts["proof"])


@pytest.mark.parametrize(("enough", "tried"), [(2000, [2000]), (2001, [2000, 20000]), (20001, [2000, 20000])])
def test_more_states_are_kept_apart_only_where_fewer_do_not_do(monkeypatch, enough, tried):
    """And what was tried is told."""
    seen = []

    def analysed(block, text, task, effort, *, seconds):
        seen.append(effort)
        status = "Valid" if effort >= enough else "Unknown"
        return [proof.Property("prove", "user assertion", status, "c[0] <= 1.0")] * task.assertions, frozenset()

    monkeypatch.setattr(proof, "analyse", analysed)
    found = prove(pendulum_ekf, FLOAT, ["is_held"])
    assert seen == tried
    assert found.checks[0].passed == (enough <= 20000)
    assert found.facts["efforts"] == ({"is_held": tried} if enough <= 20000 else {})


def test_an_analysis_that_does_not_end_is_a_failed_proof(needs):
    needs("frama-c")
    (check,) = prove(pendulum_ekf, FLOAT, ["is_held"], seconds=0.05).checks
    assert not check.passed
    assert "not done after" in check.note


def test_c_that_cannot_be_read_is_told_in_a_sentence(needs):
    needs("frama-c")
    with pytest.raises(ProofError, match="no report; mend the C"):
        prove(pendulum_ekf, replace(FLOAT, source=FLOAT.source + "\nint;;= x\n"), ["is_held"])
