"""`plantc export --target`: the table, the evidence, and mistakes."""

import json
import shutil

import pytest
from plantc.codegen import targets

LOW_PASS = """\
from plantc import Block

low_pass = Block("low_pass", doc="first-order low-pass filter")
raw = low_pass.input("raw", unit="V", range=(-10, 10))
weight = low_pass.parameter("weight", 0.1, range=(0, 1))
smooth = low_pass.memory("smooth", unit="V", range=(-10, 10))
following = smooth + weight * (raw - smooth)
low_pass.entry("step", inputs=[raw], following={smooth: following}, outputs={"filtered": following})
"""


@pytest.fixture
def export(tmp_path, monkeypatch, plantc):
    """Export the low-pass filter in an empty folder."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "model.py").write_text(LOW_PASS)
    return lambda *arguments: plantc("export", "model.py", "--steps", 20, *arguments)


def refused(said, *words):
    assert said.status == 2, said.err
    assert "Traceback" not in said.err
    for word in words:
        assert word in said.summary, said.err


@pytest.mark.parametrize("precision", ["float", "double"])
def test_figures_of_several_targets(export, needs, tmp_path, precision):
    needs("arm-none-eabi-gcc", "riscv64-unknown-elf-gcc", "qemu-system-arm", "qemu-system-riscv32")
    names = ("cortex-m4", "cortex-m7", "rv32")
    said = export("--precision", precision, "--json", *(word for name in names for word in ("--target", name)))
    assert said.status == 0, said.err
    told = json.loads(said.out)["blocks"][0]
    assert set(told["targets"]) == {"host", *names}
    checks = {item["name"]: item for item in told["checks"]}
    for name in names:
        facts = told["targets"][name]
        row = next(line for line in said.err.splitlines() if line.split()[:1] == [name])
        assert f"step {facts['instructions']['step']}" in row
        assert row.split()[1] == str(facts["object"]["text"])
        assert checks[f"{name} = native"]["note"] == "bit for bit"
        assert facts["free_run"]["equal_to_host"]
    assert json.loads((tmp_path / "generated_c/low_pass/evidence.json").read_text())["targets"] == told["targets"]


def test_contraction_is_in_the_evidence_and_the_manifest(export, needs, tmp_path, plantc):
    needs("arm-none-eabi-gcc", "qemu-system-arm")
    said = export("--target", "cortex-m7", "--contract", "on", "--json")
    assert said.status == 0, said.err
    told = json.loads(said.out)["blocks"][0]
    assert told["compiler"]["contraction"] == "-ffp-contract=fast"
    assert "-ffp-contract=fast" in told["targets"]["cortex-m7"]["toolchain"]["flags"]
    folder = tmp_path / "generated_c/low_pass"
    assert json.loads((folder / "manifest.json").read_text())["contract"] == "on"
    checked = plantc("check", folder, "--model", "model.py", "--steps", 20)
    assert checked.status == 0, checked.err


def test_the_host_alone_is_the_default(export):
    said = export("--json")
    assert said.status == 0, said.err
    facts = json.loads(said.out)["blocks"][0]["targets"]
    assert list(facts) == ["host"]
    assert facts["host"]["instructions"].startswith("not counted")


def test_an_unknown_target(export):
    refused(export("--target", "cortex-m5"), "cortex-m5", "cortex-m4", "rv32")


@pytest.mark.parametrize("size", ["0", "-1", "many", "1.5M", "64KB"])
def test_a_size_that_is_none(export, size):
    refused(export("--target", "cortex-m4", "--flash", size), size, "128K")


def test_a_size_without_a_target(export):
    refused(export("--flash", "64K"), "--flash", "--target")


@pytest.mark.parametrize(("option", "what"), [("--flash", "flash"), ("--ram", "RAM")])
def test_code_that_does_not_fit_leaves_nothing(export, needs, tmp_path, option, what):
    needs("arm-none-eabi-gcc", "qemu-system-arm")
    refused(export("--target", "cortex-m4", option, 64), "low_pass does not fit cortex-m4", f"bytes of {what}", option)
    assert not (tmp_path / "generated_c/low_pass").exists()
    assert export("--target", "cortex-m4", option, "4K").status == 0


@pytest.mark.parametrize(
    ("name", "tool", "package"),
    [
        ("cortex-m4", "qemu-system-arm", "qemu-system-arm"),
        ("rv32", "qemu-system-riscv32", "qemu-system-misc"),
        ("rv32", "riscv64-unknown-elf-gcc", "gcc-riscv64-unknown-elf"),
    ],
)
def test_a_missing_tool_is_a_sentence_with_its_package(export, needs, monkeypatch, tmp_path, name, tool, package):
    needs("gcc")
    which = shutil.which
    monkeypatch.setattr(targets.shutil, "which", lambda program: None if program == tool else which(program))
    monkeypatch.setattr(targets.importlib.util, "find_spec", lambda module: None)
    refused(export("--target", name), f"apt install {package}")
    assert not (tmp_path / "generated_c").exists()


def test_check_runs_what_lies_there_on_a_target(export, needs, tmp_path, plantc):
    needs("arm-none-eabi-gcc", "qemu-system-arm")
    assert export("--precision", "float").status == 0
    folder = tmp_path / "generated_c/low_pass"
    arguments = ("check", folder, "--model", "model.py", "--steps", 20, "--target", "cortex-m4")
    good = plantc(*arguments, "--json")
    assert good.status == 0, good.err
    names = [item["name"] for item in json.loads(good.out)["checks"]]
    assert {"cortex-m4 = native", "cortex-m4 = native, free run"} <= set(names)
    source = folder / "src/low_pass.c"
    whole = source.read_text()
    spoilt = whole.replace(" smooth_0;\n", " smooth_0\n#ifdef __arm__\n + 0.5f\n#endif\n;\n", 1)
    assert spoilt != whole
    source.write_text(spoilt)
    bad = plantc(*arguments)
    assert bad.status == 1
    assert "cortex-m4 gives" in bad.err
