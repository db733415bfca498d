"""What an export writes, whole or not at all, and what `check` finds."""

import json
import shutil

import casadi as ca
import pytest
from plantc.codegen import package
from plantc.codegen.options import Options
from plantc.codegen.package import ExportError, check_folder, export, read_manifest
from plantc.codegen.style import Precision
from plantc.examples.pendulum import pendulum_ekf

from plantc import Block

STEPS = 25


@pytest.fixture(scope="module")
def exported(tmp_path_factory):
    return export(pendulum_ekf, tmp_path_factory.mktemp("out"), precision="float", steps=STEPS)


def test_the_files_are_those_promised(exported):
    names = {path.relative_to(exported.folder).as_posix() for path in exported.folder.rglob("*") if path.is_file()}
    assert names == {
        "src/pendulum_ekf.h", "src/pendulum_ekf.c", "test/test_vectors.c", "examples/example_main.c", "verify/fuzz_main.c",
        "CMakeLists.txt", "cmake/pendulum_ekfConfig.cmake.in", "cmake/pendulum_ekf.pc.in", "library.json",
        "library.properties", "examples/pendulum_ekf/pendulum_ekf.ino", "zephyr/module.yml", "zephyr/CMakeLists.txt",
        "zephyr/Kconfig", "manifest.json", "trace.json", "evidence.json", "report.html",
    }  # fmt: skip
    for path in exported.folder.rglob("*.c"):
        library = path.name == "pendulum_ekf.c"
        assert library != any(word in path.name for word in ("main", "test", "vectors"))
        assert library or "int main(" in path.read_text()
        assert all(len(line) <= 120 for line in path.read_text().split("\n")), path.name


def test_manifest_and_evidence_say_what_was_done(exported):
    manifest = read_manifest(exported.folder)
    assert manifest["model"] == pendulum_ekf.model_hash()
    assert manifest["reference"] == "independent NumPy reference"
    assert manifest["not_checked"]
    evidence = json.loads((exported.folder / "evidence.json").read_text())
    assert evidence["passed"] is True
    names = {item["name"] for item in evidence["checks"]}
    assert {"float = double", "shipped vectors", "F = complex step", "a refused call changes nothing"} <= names
    assert len(set(evidence["statuses_reached"])) >= 8


def test_the_vectors_reach_every_status_that_the_check_reached_and_can_fail(exported, tmp_path):
    text = (exported.folder / "test/test_vectors.c").read_text()
    for status in ("OK", "BAD_INPUT", "BAD_PARAM", "OVERFLOW", "RECOVERED", "SKIPPED"):
        assert f"PENDULUM_EKF_{status}" in text
    folder = tmp_path / "copy"
    shutil.copytree(exported.folder, folder)
    source = (folder / "src/pendulum_ekf.c").read_text()
    files = {path.relative_to(folder).as_posix(): path.read_text() for path in folder.rglob("*") if path.is_file()}
    assert package.run_vectors("pendulum_ekf", files).passed
    files["src/pendulum_ekf.c"] = source.replace("delta[0] = ", "delta[0] = 1.1f * ", 1)
    assert files["src/pendulum_ekf.c"] != source
    broken = package.run_vectors("pendulum_ekf", files)
    assert not broken.passed
    assert "differ" in broken.note


def test_check_finds_what_was_changed(exported, tmp_path):
    folder = tmp_path / "pendulum_ekf"
    shutil.copytree(exported.folder, folder)
    assert check_folder(folder, pendulum_ekf, steps=STEPS).passed
    source = folder / "src/pendulum_ekf.c"
    source.write_text(source.read_text().replace("0.5f", "0.51f", 1))
    (folder / "CMakeLists.txt").unlink()
    found = check_folder(folder, pendulum_ekf, steps=STEPS)
    assert not found.passed
    assert "src/pendulum_ekf.c" in found.changed
    assert found.missing == ["CMakeLists.txt"]


def test_a_failed_check_leaves_what_was_there(exported, tmp_path, monkeypatch):
    folder = tmp_path / "pendulum_ekf"
    shutil.copytree(exported.folder, folder)
    (folder / "src/pendulum_ekf.c").write_text("old")
    original = package.cross_check

    def failing(*args, **kwargs):
        check = original(*args, **kwargs)
        check.results[0].passed = False
        return check

    monkeypatch.setattr(package, "cross_check", failing)
    with pytest.raises(ExportError, match="pendulum_ekf: the check 'F = complex step' failed"):
        export(pendulum_ekf, tmp_path, steps=STEPS, force=True)
    assert [path.name for path in tmp_path.iterdir()] == ["pendulum_ekf"]
    assert (folder / "src/pendulum_ekf.c").read_text() == "old"


def test_check_rebuilds_with_the_options_in_the_manifest(tmp_path):
    turn = Block("turn")
    angle = turn.input("angle", unit="rad", range=(-3, 3))
    turn.entry("step", inputs=[angle], outputs={"height": ca.sin(angle * 1.1 + 0.1)})
    options = Options(Precision("float"), contract=True, mathematics="libm")
    folder = export(turn, tmp_path, options=options, steps=STEPS).folder
    assert "sinf(" in (folder / "src/turn.c").read_text()
    found = check_folder(folder, turn, steps=STEPS)
    assert found.passed
    manifest = read_manifest(folder)
    for name, other in (("mathematics", "own"), ("precision", "double")):
        (folder / "manifest.json").write_text(json.dumps({**manifest, name: other}, indent=2) + "\n")
        found = check_folder(folder, turn, steps=STEPS)
        assert "src/turn.c" in found.changed, name
