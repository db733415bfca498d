"""Everything that README and docs show runs as it stands."""

import doctest
import os
import re
import shlex
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
FENCE = re.compile(r"^```([a-z]*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


CROSS_TOOLS = ("arm-none-eabi-gcc", "riscv64-unknown-elf-gcc", "qemu-system-arm", "qemu-system-riscv32")


@dataclass
class Fence:
    """A fenced block of a page."""

    language: str
    text: str
    line: int
    marked: bool  # by an HTML comment: run by another test

    @property
    def commands(self):
        """(command, lines shown below it) of a block of a terminal."""
        found = []
        prompt = "$ " if self.language == "console" else ""
        for line in self.text.splitlines():
            if line.startswith(prompt or "plantc "):
                found.append((line.removeprefix(prompt), []))
            elif found and prompt:
                found[-1][1].append(line)
        return found


def fences(path):
    text = path.read_text()
    return [
        Fence(
            match[1],
            match[2],
            text.count("\n", 0, match.start()) + 2,
            text[: match.start()].rstrip("\n").endswith("command -->"),
        )
        for match in FENCE.finditer(text)
    ]


def shown(lines):
    """A pattern of the lines that a page shows: ``...`` stands for anything, runs of spaces for one."""
    words = " ".join(" ".join(lines).split())
    return re.compile(".*".join(re.escape(part) for part in words.split("...")), re.DOTALL)


def test_the_pages_are_there():
    names = {path.name for path in PAGES}
    assert {"README.md", "tour.md", "checks.md", "modelling.md", "c_interface.md", "command_line.md", "api.md"} <= names


@pytest.mark.slow
@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.name)
def test_what_a_page_shows_runs(path, tmp_path, monkeypatch, plantc, needs):
    monkeypatch.chdir(tmp_path)
    names = {"__name__": "page"}
    ran = 0
    for fence in fences(path):
        where = f"{path.name}, line {fence.line}"
        file = re.match(r"(?:#|/\*) (\w+\.\w+)(?: \*/)?$", fence.text.split("\n")[0])
        if file:
            (tmp_path / file[1]).write_text(fence.text)
        elif path.name == "README.md" and fence.language == "python" and not ran:
            (tmp_path / "pendulum.py").write_text(fence.text)
        if fence.language == "python":
            if "TargetView" in fence.text:
                needs(*CROSS_TOOLS)
            if "bound_rounding" in fence.text:
                needs("gappa")
            exec(compile("\n" * (fence.line - 1) + fence.text, str(path), "exec"), names)
            ran += 1
        elif fence.language == "pycon":
            test = doctest.DocTestParser().get_doctest(fence.text, names, path.name, str(path), fence.line - 1)
            said: list[str] = []
            runner = doctest.DocTestRunner(verbose=False)
            runner.run(test, out=said.append, clear_globs=False)
            names = test.globs
            assert runner.failures == 0, "".join(said)
            ran += 1
        elif fence.language in ("", "console") and not fence.marked:
            for command, lines in fence.commands:
                words = shlex.split(command, comments=True)
                if words[:2] == ["plantc", "audit"]:
                    needs("cppcheck", "gcc", "clang")
                if words[0] == "plantc":
                    if "--target" in words:
                        needs(*CROSS_TOOLS)
                    done = plantc(*words[1:])
                    status, text = done.status, done.err
                else:
                    if words[0] in ("cc", "cmake", "ctest"):
                        needs(words[0])
                    if "pkg-config" in command:
                        needs("pkg-config")
                    if "m4" in command:
                        needs("arm-none-eabi-gcc")
                    run = subprocess.run(command, shell=True, capture_output=True, text=True, check=False)
                    status, text = run.returncode, run.stdout + run.stderr
                assert status == 0, f"{where}: {command}: {text}"
                assert shown(lines).search(" ".join(text.split())), f"{where}: {command} says something else:\n{text}"
                ran += 1
    assert ran or path.name in ("index.md", "api.md", "checks.md", "c_interface.md", "fmu.md", "gates.md")


def test_links_between_pages_lead_somewhere():
    for path in PAGES:
        for target in re.findall(r"\]\(([^)#:]+)(?:#[^)]*)?\)", path.read_text()):
            assert (path.parent / target).exists(), f"{path.name}: {target}"


def test_the_statuses_of_the_page_are_the_statuses(checkout):
    from plantc import Status

    rows = re.findall(r"^\| `([A-Z_]+)` \| (-?\d) \|", (checkout / "docs/c_interface.md").read_text(), re.MULTILINE)
    assert {name: int(value) for name, value in rows} == {item.name: int(item) for item in Status}


def test_the_limits_of_the_page_are_the_limits(checkout):
    from plantc.codegen import crosscheck, vectors

    page = (checkout / "docs/checks.md").read_text()
    assert crosscheck.DOUBLE_BOUND == crosscheck.DERIVATIVE_BOUND == 1e-9
    assert crosscheck.DIFFERENCE_BOUND == 1e-4
    assert crosscheck.SWITCH_MARGIN == {"double": 1e-9, "float": 1e-3}
    assert crosscheck.LARGEST_SHARE_AT_SWITCHES == 0.05
    assert "5 %" in page
    assert crosscheck.ROUNDING_GROWTH == 100
    assert "at most 100 times" in page
    assert vectors.TOLERANCE == {"double": 1e-6, "float": 2e-3}


@pytest.mark.slow
def test_the_documentation_builds_without_a_warning(checkout, tmp_path, needs):
    needs("python:sphinx", "python:myst_parser")
    command = [sys.executable, "-m", "sphinx", "-q", "-W", "--keep-going", "-b", "html"]
    command += ["-d", str(tmp_path / "trees"), str(checkout / "docs"), str(tmp_path / "html")]
    environment = {**os.environ, "PYTHONWARNINGS": "default"}
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=tmp_path, env=environment)
    assert done.returncode == 0, done.stderr
    for page in ("index", "tour", "api"):
        assert (tmp_path / "html" / f"{page}.html").is_file()


@pytest.mark.slow
@pytest.mark.parametrize("precision", ["double", "float"])
@pytest.mark.parametrize("page", ["README.md", "docs/tour.md", "docs/modelling.md"])
def test_every_filter_of_the_docs_passes_the_cross_check(page, precision, tmp_path, monkeypatch):
    from plantc import Block, cross_check

    monkeypatch.chdir(tmp_path)
    names = {"__name__": "page"}
    for fence in fences(ROOT / page):
        if fence.language == "python" and "Trace" not in fence.text and "View" not in fence.text:
            exec(compile(fence.text, page, "exec"), names)
    blocks = {value.name: value for value in names.values() if isinstance(value, Block)}
    assert blocks
    for block in blocks.values():
        check = cross_check(block, precision, steps=40)
        assert check.passed, (block.name, [(item.name, str(item.mismatch), item.note) for item in check.failures])
