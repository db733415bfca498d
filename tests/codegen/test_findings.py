"""A check passes, fails, or could not judge; the three are told apart wherever checks are shown."""

from plantc.codegen.findings import CheckResult, verdict_text

from plantc.evidence import checks_text

CHECKS = [CheckResult("a", True), CheckResult("b", False, note="3 > 2"), CheckResult("c", True, not_judged="no bound")]


def test_verdicts():
    assert [check.verdict for check in CHECKS] == ["passed", "failed", "not judged"]
    assert [check.as_dict()["passed"] for check in CHECKS] == [True, False, None]
    assert [check.remark for check in CHECKS] == ["", "3 > 2", "not judged: no bound"]
    assert CheckResult("d", False, not_judged="no bound").verdict == "failed"


def test_a_terminal_shows_them_apart():
    assert [line.split()[0] for line in checks_text(CHECKS)] == ["ok", "FAIL", "--"]
    assert checks_text(CHECKS)[2].endswith("not judged: no bound")


def test_a_summary_says_all_only_where_all_have_judged():
    assert verdict_text(["passed", "passed"]) == "all checks passed"
    assert verdict_text(["passed", "not judged"]) == "no check failed, 1 of 2 could not judge"
    assert verdict_text(check.verdict for check in CHECKS) == "1 of 3 checks failed"
