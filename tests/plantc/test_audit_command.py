"""``plantc audit``: what it prints, how it ends, and what it says when something is missing."""

import json

import pytest
from plantc.codegen import audit
from plantc.codegen.exported import MissingTool
from plantc.codegen.findings import CheckResult, Findings
from plantc.codegen.folder import write_folder
from plantc.codegen.package import build_files
from plantc.examples.pendulum import pendulum_ekf


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_folder(tmp_path / "pendulum_ekf", build_files(pendulum_ekf, "float"))
    return tmp_path / "pendulum_ekf"


def one_object(said):
    answer = json.loads(said.out)
    assert answer["status"] == said.status
    assert answer["summary"] == said.summary
    return answer


@pytest.mark.slow
def test_a_good_folder(folder, plantc, needs):
    needs("cppcheck", "gcc")
    said = plantc("audit", "pendulum_ekf", "--only", "misra", "--only", "sanitizers", "--calls", 20000, "--json")
    assert said.status == 0, said.err
    assert said.summary == "pendulum_ekf: no finding in misra, sanitizers"
    assert "ok   cppcheck with the MISRA addon: the library  no finding" in said.err
    assert "verify/fuzz_main.c: rule 21.16, 2 times: memory before and after" in said.err
    answer = one_object(said)
    assert answer["passed"] is True
    written = json.loads((folder / "audit.json").read_text())
    assert written["audits"] == answer["audits"]
    assert written["audits"]["sanitizers"]["random_calls"]["lost"] == 0
    assert written["tools"]["cppcheck"].startswith("Cppcheck ")


def test_a_finding_ends_with_one(folder, plantc, needs):
    needs("gcc")
    source = folder / "src/pendulum_ekf.c"
    source.write_text(
        source.read_text().replace("if (status >= PENDULUM_EKF_OK)\n    {\n        *state", "{\n        *state", 1)
    )
    said = plantc("audit", folder, "--only", "sanitizers", "--calls", 20000, "--json")
    assert said.status == 1
    assert said.summary == f"failed: {folder}: an audit has a finding"
    assert "FAIL address and undefined behaviour: nothing lost" in said.err
    assert "refused, but the memory changed" in said.err
    assert "changed since the export: src/pendulum_ekf.c" in said.err
    assert one_object(said)["changed_since_export"] == ["src/pendulum_ekf.c"]


def test_a_missing_tool_ends_with_two_and_names_the_package(folder, plantc, monkeypatch):
    def wanting(folder):
        raise MissingTool("frobnicate is not installed; install it (Debian: apt install frob)")

    def fine(folder):
        return Findings([CheckResult("looked", True)])

    monkeypatch.setattr(audit, "AUDITS", [("one", wanting), ("two", fine)])
    said = plantc("audit", folder, "--json")
    assert said.status == 2
    assert said.summary == "error: frobnicate is not installed; install it (Debian: apt install frob)"
    assert "ok   looked" in said.err
    assert "not run: one" in said.err
    assert one_object(said)["not_run"] == {"one": "frobnicate is not installed; install it (Debian: apt install frob)"}


def test_no_cppcheck_on_the_path(folder, plantc, monkeypatch):
    monkeypatch.setenv("PATH", "/nowhere")
    said = plantc("audit", folder, "--only", "misra")
    assert said.status == 2
    assert said.summary == "error: cppcheck is not installed; install it (Debian: apt install cppcheck)"


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["nowhere"], "there is no manifest.json; give a folder that plantc export wrote"),
        (["pendulum_ekf", "--only", "taste"], "there is no audit 'taste'; there are misra, gcc-analyzer"),
        (["pendulum_ekf", "--calls", "0"], "--calls"),
        (["pendulum_ekf", "--seconds", "0"], "--seconds"),
        ([], "FOLDER"),
    ],
)
def test_what_cannot_be_done(folder, plantc, arguments, words):
    said = plantc("audit", *arguments, "--json")
    assert said.status == 2
    assert words in said.summary
    assert one_object(said)["error"]


def test_check_does_not_look_at_the_audit(folder, plantc, needs):
    needs("gcc")
    assert plantc("audit", folder, "--only", "gcc-analyzer").status == 0
    (folder / "model.py").write_text("from plantc.examples.pendulum import pendulum_ekf\n")
    said = plantc("check", folder, "--model", folder / "model.py", "--steps", 20)
    assert said.status == 0, said.err
