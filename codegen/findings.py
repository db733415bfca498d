"""What a check or a measurement found: named results that pass or fail, and facts for the evidence."""

from __future__ import annotations

import math
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
    """One named check: what was compared, how far apart it was, whether that is accepted."""

    name: str
    passed: bool
    worst: float = 0.0
    limit: float = 0.0
    calls: int = 0
    at_switches: int = 0
    ill_conditioned: int = 0
    mismatch: Mismatch | None = None
    note: str = ""

    def as_dict(self) -> dict[str, Any]:
        """Return it for JSON."""
        return {
            "name": self.name,
            "passed": self.passed,
            "worst": float(f"{self.worst:.3g}") if math.isfinite(self.worst) else str(self.worst),
            "limit": self.limit,
            "calls": self.calls,
            "at_switches": self.at_switches,
            "ill_conditioned": self.ill_conditioned,
            "mismatch": None if self.mismatch is None else str(self.mismatch),
            "note": self.note,
        }


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
