"""The MISRA addon of cppcheck, and cppcheck's own warnings, on an exported folder.

The library has to be free of findings. Programs around it (example, vectors, harnesses) print, read arguments and look
at bytes; what the addon finds in them is listed as deviations: rule, file, count, and why.
"""

from __future__ import annotations

import re
import tempfile
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .exported import ExportedFolder, MissingTool, run_tool, tool
from .findings import CheckResult, Findings

SUPPRESSED = {
    "missingIncludeSystem": "headers of the C library are not given to cppcheck",
    "unusedFunction": "the functions of a library are called by its user",
    "variableScope": "variables are declared at the head of the function on purpose",
    "unmatchedSuppression": "not every folder has something to suppress",
}
"""Messages of cppcheck that are switched off, with the reason."""

DEVIATIONS = {
    "8.6": "the programs of a folder are built one at a time; each has its own main",
    "8.9": "tables stand at the top of the file, where a reader looks for them",
    "9.3": "a struct is initialised from another of its type, which the addon takes for a list with elements left out",
    "10.3": "the counters of differing values are plain integers",
    "10.8": "a length in elements, small by construction, becomes a plain integer",
    "11.5": "the harness looks at the bytes of any struct through one function",
    "11.8": "the arguments of main are handed on as they come",
    "21.6": "the programs report to a terminal; the library does not include stdio.h",
    "21.8": "the harness stops at a finding, so that libFuzzer keeps the input; the library does not",
    "21.15": "the harness moves numbers into and out of structs byte by byte, whatever their type",
    "21.16": "memory before and after a refused call is compared bit for bit, padding included",
    "22.8": "a malformed number in an argument is seen from where the conversion stopped, not from errno",
}
"""Rule -> why a program around the library deviates from it. A rule that is not listed here is a finding."""

_LINE = re.compile(r"^(?P<file>[^|\n]*)\|(?P<line>\d+)\|(?P<id>[\w.-]+)\|(?P<text>.*)$", re.MULTILINE)
_PLANTED = "int planted(int a, int b, int c);\nint planted(int a, int b, int c)\n{\n    return a + b * c;\n}\n"
_PLANTED_RULE = "misra-c2012-12.1"


@dataclass(frozen=True)
class Message:
    """A message of cppcheck; `rule` is empty for its own."""

    file: str
    line: int
    identifier: str
    text: str

    @property
    def rule(self) -> str:
        """The number of the rule, or an empty string."""
        return self.identifier.removeprefix("misra-c2012-") if self.identifier.startswith("misra-") else ""

    def __str__(self) -> str:
        what = f"rule {self.rule}" if self.rule else f"{self.text} [{self.identifier}]"
        return f"{self.file}:{self.line}: {what}"


def cppcheck(folder: Path, files: list[str], include: str = "src", *, value_flow: bool = True) -> list[Message]:
    """Return what cppcheck and its MISRA addon find in C files.

    The files are analysed as one program, since some rules are about a whole program.

    Parameters
    ----------
    folder : Path
        Where it runs.
    files : list of str
        The C files, as seen from there.
    include : str
        The folder of headers.
    value_flow : bool
        Whether cppcheck follows values through functions: for twelve states that is a minute, and all else seconds.

    Raises
    ------
    MissingTool
        If cppcheck or its addon is not installed.
    """
    command = [
        tool("cppcheck"),
        "--quiet",
        "--std=c99",
        "--enable=all",
        "--addon=misra",
        "--template={file}|{line}|{id}|{message}",
        *[f"--suppress={name}" for name in SUPPRESSED],
        *([] if value_flow else ["--valueflow-max-iterations=0"]),
        "-I",
        include,
        *files,
    ]
    done = run_tool(command, folder)
    messages = [
        Message(row["file"], int(row["line"]), row["id"], row["text"])
        for row in _LINE.finditer(done.stdout + done.stderr)
    ]
    if done.returncode != 0:
        said = (done.stdout + done.stderr).strip().split("\n")[0]
        raise MissingTool(f"cppcheck ended with {done.returncode} ({said}); install it with its addons")
    return list(dict.fromkeys(messages))


def _addon_works() -> None:
    """See that the addon finds a planted violation: one that finds nothing at all would pass anything."""
    with tempfile.TemporaryDirectory(prefix="plantc-") as name:
        (Path(name) / "planted.c").write_text(_PLANTED)
        found = cppcheck(Path(name), ["planted.c"], ".")
    if not any(message.identifier == _PLANTED_RULE for message in found):
        raise MissingTool(
            "the MISRA addon of cppcheck finds nothing in a planted violation; install cppcheck with addons"
        )


def audit_misra(folder: ExportedFolder, *, value_flow: bool = True) -> Findings:
    """Run cppcheck with its MISRA addon: nothing in the library; deviations, with reasons, around it."""
    _addon_works()
    found = cppcheck(folder.path, folder.c_files, value_flow=value_flow)
    inside = [message for message in found if message.file.startswith("src/") or not message.file]
    around = [message for message in found if message not in inside]
    rows = deviations(around)
    unknown = [message for message in around if message.rule not in DEVIATIONS]
    return Findings(
        [
            CheckResult(
                "cppcheck with the MISRA addon: the library",
                not inside,
                note="; ".join(map(str, inside[:5])) or "no finding",
            ),
            CheckResult(
                "cppcheck: every deviation around it has a reason",
                not unknown,
                note="; ".join(map(str, unknown[:5]))
                or f"{len(around)} deviations from {len({r['rule'] for r in rows})} rules",
            ),
        ],
        {
            "library_findings": [str(message) for message in inside],
            "deviations": rows,
            "suppressed": SUPPRESSED,
            "scope": "what the addon of cppcheck checks, without rule texts; not a statement about all rules",
        },
    )


def deviations(messages: list[Message]) -> list[dict[str, Any]]:
    """Return the table of deviations: rule, file, count, reason."""
    counted = Counter((message.rule or message.identifier, message.file) for message in messages)

    def order(row: tuple[str, str]) -> tuple[list[int], str, str]:
        numbers = [int(item) for item in row[0].split(".")] if re.fullmatch(r"\d+\.\d+", row[0]) else [99, 0]
        return numbers, row[0], row[1]

    return [
        {"rule": rule, "file": file, "count": counted[rule, file], "reason": DEVIATIONS.get(rule, "none is known")}
        for rule, file in sorted(counted, key=order)
    ]
