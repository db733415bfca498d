"""Audits of an exported folder, on demand: what takes longer than an export may, or needs tools that few have."""

from __future__ import annotations

import json
import platform
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from .analysers import audit_clang, audit_gcc
from .exported import AuditError, ExportedFolder, MissingTool, open_folder, version_of
from .findings import CheckResult, Findings
from .misra import audit_misra
from .report import with_audit
from .sanitizers import audit_libfuzzer, audit_sanitizers, audit_uninitialised

AUDIT = "audit.json"

Audit = Callable[[ExportedFolder], Findings]

AUDITS: list[tuple[str, Audit]] = [
    ("misra", audit_misra),
    ("gcc-analyzer", audit_gcc),
    ("clang-analyzer", audit_clang),
    ("sanitizers", audit_sanitizers),
    ("uninitialised", audit_uninitialised),
    ("libfuzzer", audit_libfuzzer),
]
"""Name and function of every audit, in the order they run. One whose tools are missing raises `MissingTool`."""

TOOLS = ["gcc", "clang", "cppcheck"]
"""Programs whose versions are recorded."""


@dataclass
class AuditResult:
    """What the audits of a folder found.

    Attributes
    ----------
    folder : ExportedFolder
        What was looked at.
    findings : dict
        Audit -> what it found.
    missing : dict
        Audit that could not run -> the tool to install, in a sentence.
    """

    folder: ExportedFolder
    findings: dict[str, Findings] = field(default_factory=dict)
    missing: dict[str, str] = field(default_factory=dict)

    @property
    def checks(self) -> list[CheckResult]:
        """The checks of all audits."""
        return [check for found in self.findings.values() for check in found.checks]

    @property
    def passed(self) -> bool:
        """Whether no audit that ran has a finding."""
        return all(check.passed for check in self.checks)

    def as_dict(self) -> dict[str, Any]:
        """Return it for JSON."""
        return {
            "name": self.folder.name,
            "model": self.folder.manifest["model"],
            "precision": self.folder.precision,
            "machine": platform.machine(),
            "tools": {name: version_of(name) for name in TOOLS},
            "files": self.folder.hashes,
            "changed_since_export": self.folder.changed,
            "passed": self.passed,
            "not_run": self.missing,
            "audits": {
                name: {
                    "passed": all(check.passed for check in found.checks),
                    "checks": [
                        {
                            "name": check.name,
                            "verdict": check.verdict,
                            "passed": check.passed,
                            "calls": check.calls,
                            "note": check.remark,
                        }
                        for check in found.checks
                    ],
                    **found.facts,
                }
                for name, found in self.findings.items()
            },
        }


def audit_folder(
    path: Path,
    *,
    only: Sequence[str] = (),
    calls: int = 3_000_000,
    seconds: float = 5.0,
    progress: Callable[[str, int, int], None] | None = None,
) -> AuditResult:
    """Run audits on a folder that an export wrote, and write what they found to its audit.json.

    Parameters
    ----------
    path : Path
        The folder.
    only : sequence of str
        Names of audits; all of them if empty.
    calls : int
        How many random calls the sanitizers see.
    seconds : float
        How long libFuzzer searches.
    progress : callable, optional
        Called with (what is being done, done, in all).

    Returns
    -------
    AuditResult
        Findings, and the audits whose tools are missing.

    Raises
    ------
    AuditError
        If an audit is not known, or the C does not compile.
    FolderError
        If it is no exported folder.
    """
    known = dict(AUDITS)
    for name in only:
        if name not in known:
            raise AuditError(f"there is no audit {name!r}; there are {', '.join(known)}")
    folder = open_folder(path, calls=calls, seconds=seconds)
    chosen = [(name, run) for name, run in AUDITS if not only or name in only]
    result = AuditResult(folder)
    for done, (name, run) in enumerate(chosen):
        if progress is not None:
            progress(name, done, len(chosen))
        try:
            result.findings[name] = run(folder)
        except MissingTool as missing:
            result.missing[name] = str(missing)
    write_audit(result)
    return result


def write_audit(result: AuditResult) -> None:
    """Write a folder's audit.json, and show it in its report.html; results of other audits of the very same files are kept."""
    path = result.folder.path / AUDIT
    fresh = result.as_dict()
    try:
        earlier = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        earlier = {}
    if isinstance(earlier, dict) and earlier.get("files") == fresh["files"] and earlier.get("tools") == fresh["tools"]:
        kept = {**earlier.get("audits", {}), **fresh["audits"]}
        order = [name for name, _ in AUDITS]
        fresh["audits"] = {name: kept[name] for name in order if name in kept}
        fresh["passed"] = all(item["passed"] for item in fresh["audits"].values())
        fresh["not_run"] = {
            name: text
            for name, text in {**earlier.get("not_run", {}), **fresh["not_run"]}.items()
            if name not in fresh["audits"]
        }
    path.write_text(json.dumps(fresh, indent=2) + "\n", encoding="utf-8")
    page = result.folder.path / "report.html"
    if page.is_file():
        page.write_text(with_audit(page.read_text(encoding="utf-8"), result.folder.name, fresh), encoding="utf-8")


__all__ = ["AUDIT", "AUDITS", "AuditError", "AuditResult", "audit_folder", "write_audit"]
