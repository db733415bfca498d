"""What a call costs: the form that is written is the form that is read, and a check that judges nothing has not passed."""

import json
from pathlib import Path

import pytest
from plantc.codegen.bounds import Unknown
from plantc.codegen.costs import QUANTITIES, Cost, deepest, read, reasons, within, written

COSTS = {"step": Cost.of(900, 1000), "init": Cost.of(12, Unknown("a loop in f")), "inflate": Cost.of(3, 3)}
UNSEEN = {"step": Cost("not counted: no emulator", 1000), "init": Cost("not counted: no emulator", "unknown")}


@pytest.mark.parametrize("quantity", QUANTITIES)
@pytest.mark.parametrize("costs", [COSTS, UNSEEN, {}], ids=["seen", "unseen", "none"])
def test_what_is_written_is_read_again(quantity, costs):
    assert read(quantity, json.loads(json.dumps(written(quantity, costs)))) == costs
    other = next(key for key in QUANTITIES if key != quantity)
    assert read(other, written(quantity, costs)) == {}


def test_what_is_unseen_of_all_is_one_sentence():
    assert written("stack", UNSEEN)["stack"] == "not counted: no emulator"
    assert read("stack", {"stack": {"step": 8}}) == {"step": Cost(8, "not stated")}


def test_the_committed_evidence_has_this_form(checkout):
    facts = json.loads((checkout / "generated_c/quadrotor_ekf/evidence.json").read_text())["targets"]["cortex-m7"]
    step = read("instructions", facts)["step"]
    assert 1000 < step.seen <= step.bound
    assert 100 < read("stack", facts)["step"].seen <= read("stack", facts)["step"].bound


def test_what_was_seen_must_not_be_above_its_bound():
    good = within("instructions", "cortex-m4", COSTS)
    assert (good.verdict, good.calls) == ("passed", 2)
    assert good.remark == "2 of 3 entries have a bound (init: unknown because of a loop in f)"
    bad = within("instructions", "cortex-m4", COSTS | {"inflate": Cost.of(4, 3)})
    assert (bad.verdict, bad.remark) == ("failed", "inflate: 4 seen, the bound is 3")
    assert within("stack", "cortex-m4", COSTS | {"inflate": Cost.of(7, 3)}, 4).verdict == "passed"


def test_no_bound_at_all_is_not_judged_and_never_a_pass():
    found = within("stack", "rv32", {name: Cost.of(1, Unknown("recursion")) for name in ("step", "init")})
    assert found.verdict == "not judged"
    assert found.as_dict()["passed"] is None
    assert found.as_dict()["note"] == "not judged: no entry has a bound (step, init: unknown because of recursion)"
    assert reasons(COSTS) == ["init: unknown because of a loop in f"]
    assert within("stack", "rv32", {}).verdict == "not judged"


def test_only_one_module_knows_the_keys(checkout):
    users = [
        path.name
        for folder in ("codegen", "plantc")
        for path in Path(checkout / folder).rglob("*.*")
        if path.suffix in (".py", ".j2")
        and ("instruction_bound" in (text := path.read_text()) or 'stack_bound"' in text)
    ]
    assert set(users) <= {"costs.py", "report.py", "report.html.j2"}


def test_what_is_needed_is_the_bound_not_what_was_seen():
    assert deepest({"step": Cost(184, 192), "init": Cost(8, 8)}) == 192
    assert deepest({"step": Cost(184, "unknown because of a loop"), "init": Cost(8, 16)}) == 184
    assert deepest({"step": Cost("not painted", "unknown")}) == 0
