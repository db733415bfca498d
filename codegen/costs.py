"""What a call of an entry costs: the most that was seen, and a bound on it, in the form in which evidence.json has them.

For each target evidence.json holds ``instructions`` and ``stack`` (what was seen of each entry, or why nothing was seen),
and beside them ``instruction_bound`` and ``stack_bound`` (for each entry a number, or why there is none). Only this module
knows these keys: whoever writes or reads them calls it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from .bounds import Bound
from .findings import CheckResult

QUANTITIES = {"instructions": ("instructions", "instruction_bound"), "stack": ("stack", "stack_bound")}
"""What is counted -> the keys of what was seen and of the bound."""


@dataclass(frozen=True)
class Cost:
    """What calls of one entry cost.

    Attributes
    ----------
    seen : int or str
        The most that was seen; a sentence where nothing was.
    bound : int or str
        No call costs more; a sentence where there is no such number.
    """

    seen: int | str
    bound: int | str

    @classmethod
    def of(cls, seen: int | str, bound: Bound) -> Cost:
        """Return a cost from what was seen and what the analysis of the machine code says."""
        return cls(seen, bound if isinstance(bound, int) else str(bound))


def written(quantity: str, costs: Mapping[str, Cost]) -> dict[str, Any]:
    """Return the facts of a target that state a cost of each entry.

    Parameters
    ----------
    quantity : {"instructions", "stack"}
        What was counted.
    costs : dict
        Entry -> its cost. If nothing was seen of any, one sentence says so.
    """
    seen_key, bound_key = QUANTITIES[quantity]
    unseen = {cost.seen for cost in costs.values() if isinstance(cost.seen, str)}
    is_unseen = len(unseen) == 1 and all(isinstance(cost.seen, str) for cost in costs.values())
    return {
        seen_key: unseen.pop() if is_unseen else {entry: cost.seen for entry, cost in costs.items()},
        bound_key: {entry: cost.bound for entry, cost in costs.items()},
    }


def read(quantity: str, facts: Mapping[str, Any]) -> dict[str, Cost]:
    """Return entry -> cost from the facts of a target, as `written` made them; nothing where they are not there."""
    seen_key, bound_key = QUANTITIES[quantity]
    seen, bound = facts.get(seen_key, {}), facts.get(bound_key, {})
    entries = list(seen) if isinstance(seen, Mapping) else list(bound) if isinstance(bound, Mapping) else []
    return {
        entry: Cost(
            seen[entry] if isinstance(seen, Mapping) else str(seen),
            bound.get(entry, "not stated") if isinstance(bound, Mapping) else str(bound),
        )
        for entry in entries
    }


def reasons(costs: Mapping[str, Cost]) -> list[str]:
    """Return why entries have no bound, each reason once with the entries it is true of."""
    grouped: dict[str, list[str]] = {}
    for entry, cost in costs.items():
        if isinstance(cost.bound, str):
            grouped.setdefault(cost.bound, []).append(entry)
    return [f"{', '.join(entries)}: {reason}" for reason, entries in grouped.items()]


def deepest(costs: Mapping[str, Cost]) -> int:
    """Return the most that any entry is known to need: its bound, or what was seen where that is more or all there is."""
    return max(
        (number for cost in costs.values() for number in (cost.seen, cost.bound) if isinstance(number, int)), default=0
    )


def within(quantity: str, target: str, costs: Mapping[str, Cost], resolution: int = 0) -> CheckResult:
    """Check that what was seen of each entry is not above its bound.

    An entry without a bound is not judged, and if none has one the check has judged nothing and says so.

    Parameters
    ----------
    quantity : {"instructions", "stack"}
        What was counted.
    target : str
        Where.
    costs : dict
        Entry -> its cost.
    resolution : int
        By how much what was seen may be too large.
    """
    judged = {
        entry: (cost.seen, cost.bound)
        for entry, cost in costs.items()
        if isinstance(cost.seen, int) and isinstance(cost.bound, int)
    }
    above = [
        f"{entry}: {seen} seen, the bound is {bound}"
        for entry, (seen, bound) in judged.items()
        if seen > bound + resolution
    ]
    result = CheckResult(f"{target}: {quantity} within the bound", not above, calls=len(judged))
    why = "; ".join(reasons(costs))
    if judged or above:
        note = f"{len(judged)} of {len(costs)} entries have a bound" + (f" ({why})" if why else "")
        result.note = "; ".join(above) or note
    else:
        result.not_judged = f"no entry has a bound ({why})" if why else "there is no entry"
    return result
