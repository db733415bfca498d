"""What a check or a measurement found: named results that pass or fail, and facts for the evidence."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class Mismatch:
    """The first place where two views differ."""

    trace: str
    step: int
    entry: str
    signal: str
    left: str
    left_value: str
    right: str
    right_value: str
    difference: float

    def __str__(self) -> str:
        return (
            f"{self.trace} trace, step {self.step}, entry {self.entry}, {self.signal}: {self.left} gives {self.left_value}, "
            f"{self.right} gives {self.right_value} (difference {self.difference:.3g})"
        )


@dataclass
class CheckResult:
    """One named check: what was compared, how far apart it was, whether that is accepted.

    Attributes
    ----------
    passed : bool
        False where something wrong was found; such a check fails an export.
    not_judged : str
        Why the check could not judge anything, where it could not: then it has neither passed nor failed.
    """

    name: str
    passed: bool
    worst: float = 0.0
    limit: float = 0.0
    calls: int = 0
    at_switches: int = 0
    ill_conditioned: int = 0
    mismatch: Mismatch | None = None
    note: str = ""
    not_judged: str = ""

    @property
    def verdict(self) -> str:
        """Either ``passed``, ``failed``, or ``not judged``."""
        return "failed" if not self.passed else "not judged" if self.not_judged else "passed"

    @property
    def remark(self) -> str:
        """What is to be said beside the verdict: why nothing was judged, and the note."""
        reason = f"not judged: {self.not_judged}" if self.verdict == "not judged" else ""
        return "; ".join(item for item in (reason, self.note) if item)

    def as_dict(self) -> dict[str, Any]:
        """Return it for JSON; ``passed`` is null where nothing was judged."""
        return {
            "name": self.name,
            "verdict": self.verdict,
            "passed": None if self.verdict == "not judged" else self.passed,
            "worst": float(f"{self.worst:.3g}") if math.isfinite(self.worst) else str(self.worst),
            "limit": self.limit,
            "calls": self.calls,
            "at_switches": self.at_switches,
            "ill_conditioned": self.ill_conditioned,
            "mismatch": None if self.mismatch is None else str(self.mismatch),
            "note": self.remark,
        }


def verdict_text(verdicts: Iterable[str]) -> str:
    """Return what a summary says of checks, given the verdict of each."""
    counted = Counter(verdicts)
    if counted["failed"]:
        return f"{counted['failed']} of {counted.total()} checks failed"
    if counted["not judged"]:
        return f"no check failed, {counted['not judged']} of {counted.total()} could not judge"
    return "all checks passed"


@dataclass
class Findings:
    """What one measurement of an export found.

    Attributes
    ----------
    checks : list of CheckResult
        Gates: one that did not pass fails the export.
    facts : dict
        What goes into evidence.json, under keys of its own.
    """

    checks: list[CheckResult] = field(default_factory=list)
    facts: dict[str, Any] = field(default_factory=dict)
