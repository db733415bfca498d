"""What the analysers inside gcc and clang find in an exported folder, on paths that nobody runs."""

from __future__ import annotations

import re
import tempfile
from collections.abc import Callable
from pathlib import Path

from .exported import ExportedFolder, MissingTool, run_tool, tool
from .findings import CheckResult, Findings

_PLANTED = """int planted(int a);
int planted(int a)
{
    int b;
    if (a > 0)
    {
        b = a;
    }
    return b;
}
"""
_GCC_LINE = re.compile(r"^(\S+?):(\d+:)*\s*warning: (.*) \[-W(analyzer-[\w-]+)\]$", re.MULTILINE)
_CLANG_LINE = re.compile(r"^(\S+?:\d+):\d+: (?:warning|error): (.*)$", re.MULTILINE)
_GIVEN_UP = "analyzer-too-complex"


def _gcc(folder: Path, file: str) -> tuple[list[str], int]:
    command = [tool("gcc"), "-std=c99", "-O1", "-fanalyzer", "-Wanalyzer-too-complex", "-fdiagnostics-plain-output"]
    done = run_tool([*command, "-I", "src", "-c", file, "-o", "/dev/null"], folder)
    if done.returncode != 0:
        return [f"{file}: gcc refused it: {done.stderr.strip()[:300]}"], 0
    rows = [(row[1], row[3], row[4]) for row in _GCC_LINE.finditer(done.stderr)]
    findings = [f"{where}: {text} [{option}]" for where, text, option in rows if option != _GIVEN_UP]
    return findings, sum(option == _GIVEN_UP for _, _, option in rows)


def _clang(folder: Path, file: str) -> tuple[list[str], int]:
    command = [tool("clang"), "--analyze", "-std=c99", "-Xclang", "-analyzer-output=text"]
    done = run_tool([*command, "-I", "src", file], folder)
    findings = [f"{where}: {text}" for where, text in _CLANG_LINE.findall(done.stderr)]
    if done.returncode != 0 and not findings:
        findings = [f"{file}: clang refused it: {done.stderr.strip()[:300]}"]
    return findings, 0


def _run(label: str, analyse: Callable[[Path, str], tuple[list[str], int]], folder: ExportedFolder) -> Findings:
    with tempfile.TemporaryDirectory(prefix="plantc-") as name:
        (Path(name) / "planted.c").write_text(_PLANTED)
        if not analyse(Path(name), "planted.c")[0]:
            raise MissingTool(f"{label} does not find a planted uninitialised value; install a newer one")
    findings: list[str] = []
    given_up = 0
    for file in folder.c_files:
        found, incomplete = analyse(folder.path, file)
        findings += found
        given_up += incomplete
    check = CheckResult(
        label, not findings, note="; ".join(findings[:3]) or f"no finding in {len(folder.c_files)} files"
    )
    facts = {"files": folder.c_files, "findings": findings}
    return Findings([check], facts | ({"program_points_given_up": given_up} if label.startswith("gcc") else {}))


def audit_gcc(folder: ExportedFolder) -> Findings:
    """Run gcc's analyser over every C file; where it gave up a path as too complex is counted."""
    return _run("gcc -fanalyzer", _gcc, folder)


def audit_clang(folder: ExportedFolder) -> Findings:
    """Run clang's analyser over every C file."""
    return _run("clang --analyze", _clang, folder)
