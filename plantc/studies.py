"""The studies that `plantc study` knows. One more is a line here, and a module in `examples/` with a function `study`."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from typing import TYPE_CHECKING

from .models import UsageError

if TYPE_CHECKING:
    from .simulation import StudyResult

STUDIES = {
    "meda2018": "plantc.examples.meda2018",
    "regulation2023": "plantc.examples.regulation2023",
    "jump_matrix": "plantc.examples.jump_matrix",
    "fsmc2018": "plantc.examples.fsmc2018",
}
"""Name -> module; its ``study(runs=..., seed=..., *, on, progress)`` returns a `plantc.simulation.StudyResult` of that name."""


def find(name: str) -> Callable[..., StudyResult]:
    """Return the function that does a study.

    Raises
    ------
    UsageError
        If there is no such study.
    """
    if name not in STUDIES:
        raise UsageError(f"there is no study {name!r}; give one of {', '.join(STUDIES)}")
    made: Callable[..., StudyResult] = importlib.import_module(STUDIES[name]).study
    return made
