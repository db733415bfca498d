"""The audits of an exported folder: clean on what is exported, and each finds what is planted for it."""

import json
import re
import shutil

import pytest
from plantc.codegen import analysers, audit, misra
from plantc.codegen.audit import AUDITS, AuditError, audit_folder
from plantc.codegen.exported import ExportedFolder, MissingTool, open_folder, tool
from plantc.codegen.findings import CheckResult, Findings
from plantc.codegen.folder import FolderError, write_folder
from plantc.codegen.package import build_files
from plantc.codegen.report import report_html
from plantc.codegen.sanitizers import audit_sanitizers, audit_uninitialised
from plantc.examples.pendulum import pendulum_ekf
from plantc.symbolic import if_else, vertcat
from plantc.symbolic.james_stein import james_stein_estimator

from plantc import Block, Plant, connect
from plantc.regenerate import PARTS

OWN = ["misra", "gcc-analyzer", "clang-analyzer", "sanitizers", "uninitialised", "libfuzzer"]
"""The audits that are tested here; those of proofs have tests of their own."""

FORBIDDEN = re.compile("compl" + "ian", re.IGNORECASE)


@pytest.fixture(scope="module")
def files():
    return build_files(pendulum_ekf, "float")


@pytest.fixture
def folder(files, tmp_path):
    write_folder(tmp_path / "pendulum_ekf", files)
    return tmp_path / "pendulum_ekf"


def plant(folder, old, new, file="src/pendulum_ekf.c"):
    source = folder / file
    text = source.read_text()
    assert old in text, old
    source.write_text(text.replace(old, new, 1))


def failed(found):
    return [check.name for check in found.checks if not check.passed]


# -- MISRA ------------------------------------------------------------------------------------------------------------


def test_the_library_has_no_finding_and_every_deviation_around_it_a_reason(folder, needs):
    needs("cppcheck")
    found = misra.audit_misra(open_folder(folder))
    assert failed(found) == []
    rows = found.facts["deviations"]
    assert {row["file"] for row in rows} >= {"test/test_vectors.c", "examples/example_main.c", "verify/fuzz_main.c"}
    assert not any(row["file"].startswith("src/") for row in rows)
    assert all(row["count"] > 0 and row["reason"] == misra.DEVIATIONS[row["rule"]] for row in rows)
    assert not FORBIDDEN.search(json.dumps(found.facts))


def low_pass():
    """One entry, and one number in memory; its slope is a product in a branch."""
    block = Block("low_pass")
    raw = block.input("raw", range=(-10, 10))
    weight = block.parameter("weight", 0.1, range=(0, 1))
    smooth = block.memory("smooth", range=(-10, 10))
    following = smooth + if_else(raw > 0, weight * raw, 0) - weight * smooth
    block.entry("step", inputs=[raw], following={smooth: following}, outputs={"filtered": following})
    return block


def tracker():
    """A modified James-Stein estimator, of whose entries a composition calls `step` only, and two low passes of one kind.

    The estimator's weight vanishes, and is 1 where nothing is lost.
    """
    plane = Plant("plane")
    states = [plane.state(name, range=(-1e3, 1e3)) for name in ("a", "b", "c")]
    plane.dynamics({state: -state for state in states})
    plane.sensor("all", vertcat(*states), variance=1.0)
    estimator = james_stein_estimator(plane.discretise("euler", dt=0.1), gamma=0.15)
    parts = {"estimator": estimator, "first": low_pass(), "second": low_pass()}
    return connect(parts, {"second.raw": "first.filtered"}, "tracker")


@pytest.mark.slow
@pytest.mark.parametrize(("make", "value_flow"), [(low_pass, False), (tracker, True)])
def test_a_block_of_one_entry_and_a_composition_have_no_finding(make, value_flow, tmp_path, needs):
    needs("cppcheck")
    block = make()
    write_folder(tmp_path / block.name, build_files(block, "float"))
    found = misra.audit_misra(open_folder(tmp_path / block.name), value_flow=value_flow)
    assert [(check.name, check.note) for check in found.checks if not check.passed] == []


def test_a_violation_in_the_library_is_found(folder, needs):
    needs("cppcheck")
    plant(folder, "theta + (omega * dt)", "theta + omega * dt")
    found = misra.audit_misra(open_folder(folder))
    assert failed(found) == ["cppcheck with the MISRA addon: the library"]
    assert re.fullmatch(r"src/pendulum_ekf.c:\d+: rule 12.1", found.facts["library_findings"][0])


def test_a_warning_of_cppcheck_itself_is_found(folder, needs):
    needs("cppcheck")
    plant(folder, "    return status;\n", "    status = status;\n    return status;\n")
    found = misra.audit_misra(open_folder(folder))
    assert any("[selfAssignment]" in item for item in found.facts["library_findings"])


def test_a_deviation_without_a_reason_is_found(folder, needs):
    needs("cppcheck")
    plant(folder, "int main(void)\n{\n", "int main(void)\n{\n    goto end;\nend:\n", "examples/example_main.c")
    found = misra.audit_misra(open_folder(folder))
    assert failed(found) == ["cppcheck: every deviation around it has a reason"]
    assert {"rule": "15.1", "file": "examples/example_main.c", "count": 1, "reason": "none is known"} in found.facts[
        "deviations"
    ]


def test_an_addon_that_finds_nothing_is_no_addon(folder, monkeypatch):
    monkeypatch.setattr(misra, "cppcheck", lambda *arguments, **options: [])
    with pytest.raises(MissingTool, match="finds nothing in a planted violation"):
        misra.audit_misra(open_folder(folder))


def test_the_word_is_nowhere(checkout):
    where = [
        "README.md",
        "CHANGELOG.md",
        "docs",
        "codegen",
        "symbolic",
        "plantc",
        "reference",
        "examples",
        "generated_c",
    ]
    for top in where:
        paths = [checkout / top] if (checkout / top).is_file() else (checkout / top).rglob("*")
        for path in paths:
            if path.suffix in (".py", ".md", ".j2", ".c", ".h", ".json", ".html", ".txt"):
                assert not FORBIDDEN.search(path.read_text()), path


# -- analysers --------------------------------------------------------------------------------------------------------

UNSET = ("    bool held = true;\n", "    bool held;\n")


@pytest.mark.parametrize(
    ("name", "run", "analyse"),
    [("gcc", analysers.audit_gcc, analysers._gcc), ("clang", analysers.audit_clang, analysers._clang)],
)
def test_analysers_find_nothing_but_what_is_planted(name, run, analyse, folder, needs):
    needs(name)
    found = run(open_folder(folder))
    assert failed(found) == []
    assert found.facts["files"] == open_folder(folder).c_files
    assert name != "gcc" or found.facts["program_points_given_up"] > 0  # said, not hidden
    plant(folder, *UNSET)
    findings, _ = analyse(folder, "src/pendulum_ekf.c")
    assert re.search(r"src/pendulum_ekf.c:?\d*: .*(uninitialized|garbage)", findings[0])


def test_a_finding_of_an_analyser_fails_the_audit(folder, monkeypatch):
    found = analysers._run("gcc -fanalyzer", lambda folder, file: ([f"{file}: leak"], 2), open_folder(folder))
    assert failed(found) == ["gcc -fanalyzer"]
    assert found.facts["program_points_given_up"] == 2 * len(open_folder(folder).c_files)


def test_an_analyser_that_finds_nothing_is_none(folder):
    with pytest.raises(MissingTool, match="does not find a planted uninitialised value"):
        analysers._run("gcc -fanalyzer", lambda folder, file: ([], 0), open_folder(folder))


# -- sanitizers -------------------------------------------------------------------------------------------------------


def test_sanitizers_look_at_vectors_and_random_calls(folder, needs):
    needs("gcc")
    found = audit_sanitizers(open_folder(folder, calls=20_000))
    assert failed(found) == []
    assert found.checks[0].calls == open_folder(folder).manifest["vectors"]
    assert found.facts["random_calls"]["calls"] >= 20_000
    plant(folder, "after->covariance[2] = factor * ", "after->covariance[3] = factor * ")
    names = failed(audit_sanitizers(open_folder(folder, calls=20_000)))
    assert "address and undefined behaviour: shipped vectors" in names
    assert "address and undefined behaviour: nothing lost" in names


def test_memory_left_unset_is_found(folder, needs):
    needs("clang")
    assert failed(audit_uninitialised(open_folder(folder, calls=20_000))) == []
    plant(folder, "    after->rejected_encoder = before->rejected_encoder;\n", "")
    assert "uninitialised memory: nothing lost" in failed(audit_uninitialised(open_folder(folder, calls=20_000)))


def test_c_that_does_not_compile_is_told(folder, needs):
    needs("gcc")
    plant(folder, "return status;", "return nothing;")
    with pytest.raises(AuditError, match=r"gcc refused src/pendulum_ekf.c:\d+:\d+: error: .nothing. undeclared"):
        audit_sanitizers(open_folder(folder, calls=1000))


# -- all of them ------------------------------------------------------------------------------------------------------


def good(name, **facts):
    return lambda folder: Findings([CheckResult(f"{name} looked", True)], facts)


def test_what_was_found_is_written_and_kept_while_the_files_are_the_same(folder, monkeypatch):
    monkeypatch.setattr(audit, "AUDITS", [("one", good("one", seen=1)), ("two", good("two"))])
    found = audit_folder(folder, only=["two"])
    assert found.passed
    written = json.loads((folder / "audit.json").read_text())
    assert list(written["audits"]) == ["two"]
    assert written["changed_since_export"] == []
    assert set(written["files"]) >= {"src/pendulum_ekf.c", "src/pendulum_ekf.h", "verify/fuzz_main.c"}
    audit_folder(folder, only=["one"])
    written = json.loads((folder / "audit.json").read_text())
    assert list(written["audits"]) == ["one", "two"]
    assert written["audits"]["one"]["seen"] == 1
    plant(folder, "0.5f", "0.25f")
    audit_folder(folder, only=["two"])
    written = json.loads((folder / "audit.json").read_text())
    assert list(written["audits"]) == ["two"]
    assert written["changed_since_export"] == ["src/pendulum_ekf.c"]


def test_the_page_of_the_folder_shows_what_was_found(folder, monkeypatch):
    monkeypatch.setattr(audit, "AUDITS", [("one", good("one"))])
    manifest = json.loads((folder / "manifest.json").read_text())
    evidence = {"name": "pendulum_ekf", "model": manifest["model"], "precision": "float", "checks": []}
    (folder / "report.html").write_text(report_html(pendulum_ekf, manifest, evidence, []))
    audit_folder(folder)
    page = (folder / "report.html").read_text()
    assert page == report_html(pendulum_ekf, manifest, evidence, [], json.loads((folder / "audit.json").read_text()))
    assert "one looked" in page


def test_a_missing_tool_keeps_one_audit_from_running_not_the_others(folder, monkeypatch):
    def wanting(folder: ExportedFolder) -> Findings:
        tool("no-such-tool", "no-such-package")
        raise AssertionError

    monkeypatch.setattr(audit, "AUDITS", [("one", wanting), ("two", good("two"))])
    found = audit_folder(folder)
    assert found.passed
    assert found.missing == {"one": "no-such-tool is not installed; install it (Debian: apt install no-such-package)"}
    assert json.loads((folder / "audit.json").read_text())["not_run"].keys() == {"one"}


def test_what_is_no_exported_folder_is_refused(folder, tmp_path):
    with pytest.raises(FolderError, match=r"there is no manifest.json"):
        audit_folder(tmp_path)
    with pytest.raises(AuditError, match="there is no audit 'taste'; there are misra, "):
        audit_folder(folder, only=["taste"])
    (folder / "verify/fuzz_main.c").unlink()
    with pytest.raises(FolderError, match=r"verify/fuzz_main.c is missing; export again"):
        audit_folder(folder)


@pytest.mark.slow
def test_the_examples_pass_every_audit_with_ten_million_calls(tmp_path, needs, checkout):
    needs("cppcheck", "gcc", "clang")
    calls = 0
    for block, _ in PARTS:
        if block.name == "quadrotor_kf":  # it has the kernels of quadrotor_ekf
            continue
        shutil.copytree(checkout / "generated_c" / block.name, tmp_path / block.name)
        # cppcheck takes a minute to follow values through any but the pendulum, gcc's analyser minutes over the UD form, and
        # of the twelve-state filters one is looked at: the rest is left to `plantc audit`
        left = [] if block.name == "pendulum_ekf" else ["misra"]
        left += ["gcc-analyzer"] if block.name == "quadrotor_ud" else []
        if "misra" in left:
            rules = misra.audit_misra(open_folder(tmp_path / block.name), value_flow=False)
            assert [(check.name, check.note) for check in rules.checks if not check.passed] == []
        found = audit_folder(
            tmp_path / block.name,
            only=[name for name in OWN if name not in left],
            calls={"pendulum_ekf": 4_500_000, "attitude_ekf": 700_000}.get(block.name, 200_000),
            seconds=2,
        )
        assert found.missing == {}
        assert found.passed, [(check.name, check.note) for check in found.checks if not check.passed]
        for name, key in (("sanitizers", "random_calls"), ("uninitialised", "random_calls"), ("libfuzzer", "search")):
            calls += found.findings[name].facts[key]["calls"]
            assert found.findings[name].facts[key]["lost"] == 0
    assert set(OWN) <= {name for name, _ in AUDITS}
    assert calls >= 10_000_000
