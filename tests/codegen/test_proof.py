"""Frama-C's EVA on the pendulum's filter: what it proves, and that planted faults are alarms."""

from dataclasses import replace

import pytest
from plantc.codegen.proof import proof_source, prove
from plantc.codegen.style import Precision
from plantc.examples.pendulum import pendulum_ekf

from plantc import emit

PROVED = ["init", "predict", "update_encoder", "inflate"]


def test_the_harness_asserts_every_element_of_the_memory():
    text = proof_source(pendulum_ekf, Precision("float"))
    assert text.count("is_finite(state.covariance[1])") == len(pendulum_ekf.entries)
    low, high = (-100.0).hex(), (100.0).hex()  # a decimal would be a real number there
    assert f"{low} <= state.omega <= {high}" in text


@pytest.mark.slow
def test_no_call_takes_the_memory_out_of_its_ranges(needs):
    needs("frama-c")
    found = prove(pendulum_ekf, emit(pendulum_ekf, "float"), PROVED)
    assert [check.note for check in found.checks if not check.passed] == []
    assert all(found.facts["proof"][entry]["assertions"] >= 6 for entry in PROVED)


FAULTS = {
    "a range check removed": ("((after->omega <= 100.0f) == true)", "true"),
    "an element not judged": ("&& ((covariance[1] <= ", "&& ((covariance[0] <= "),
    "commit before judge": (
        "    if (status >= PENDULUM_EKF_OK)\n    {\n        *state = after;\n    }",
        "    *state = after;",
    ),
}


@pytest.mark.slow
@pytest.mark.parametrize("fault", FAULTS)
def test_a_planted_fault_is_seen(needs, fault):
    needs("frama-c")
    text = emit(pendulum_ekf, "float")
    before, after = FAULTS[fault]
    assert before in text.source
    broken = replace(text, source=text.source.replace(before, after))
    assert not all(check.passed for check in prove(pendulum_ekf, broken, ["predict"]).checks)
