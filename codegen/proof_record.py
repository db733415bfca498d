"""What was proved, and of which C: a proof takes minutes, and holds for as long as nothing that it read has changed."""

from __future__ import annotations

import hashlib
import inspect
import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from ..symbolic.block import Block
from . import exported, proof
from .emit import CText
from .exported import run_tool, tool
from .findings import Findings
from .proof import OPTIONS, Task, proof_source, proof_tasks, prove


@dataclass(frozen=True)
class Proved:
    """One function that was proved.

    Attributes
    ----------
    digest : str
        Of all that the proof rests on: see `digest_of`.
    properties : int
        How many properties were looked at.
    efforts : list of int
        How many states the analyser kept apart: tried in this order while something stayed open.
    seconds : float
        How long it took, on the machine that did it.
    """

    digest: str
    properties: int
    efforts: list[int]
    seconds: float


JUDGES: tuple[Any, ...] = (proof.analyse, proof.prove_task, proof.Property, exported.run_tool)
"""What calls the analyser and judges its answer; what makes the harness is seen in the harness."""

LONGEST = 3600.0
"""Seconds that an analysis may take when it is recorded: it is done once, and the machine may be busy."""

Record = Mapping[str, Mapping[str, Proved]]
"""Block -> function -> proof."""


@cache
def analyser() -> str:
    """Return the version of Frama-C.

    Raises
    ------
    MissingTool
        If it is not installed.
    """
    return run_tool([tool("frama-c", "frama-c-base"), "-version"], Path("."), seconds=60.0).stdout.strip()


def digest_of(block: Block, text: CText, task: Task, efforts: list[int]) -> str:
    """Return the digest of all that the proof of a function rests on.

    That is the C and the harness that the analyser reads, what is asked of it, how many states it kept apart, its version,
    and the Python that calls it and judges its answer. What another function needed is no part of it.
    """
    parts = [
        *(text.header, proof_source(block, text, task), str(task.assertions), str(efforts)),
        *(str(OPTIONS), analyser(), *map(inspect.getsource, JUDGES)),
    ]
    return hashlib.sha256("\0".join(parts).encode()).hexdigest()


def not_on_record(block: Block, text: CText, record: Record) -> list[str]:
    """Return the functions of a block that no record covers as they are now.

    Raises
    ------
    MissingTool
        If frama-c is not installed.
    ProofError
        If the C is not of the expected form.
    """
    known = record.get(block.name, {})
    return [
        task.name
        for task in proof_tasks(block, text)
        if task.name not in known or known[task.name].digest != digest_of(block, text, task, known[task.name].efforts)
    ]


def record_proof(block: Block, text: CText, record: Record) -> tuple[dict[str, Proved], list[str]]:
    """Prove what is not on record.

    Returns
    -------
    dict
        Function -> proof, for all that are proved.
    list of str
        Of the others, the function and what was found.
    """
    missing = set(not_on_record(block, text, record))
    tasks = {task.name: task for task in proof_tasks(block, text)}
    found = {name: item for name, item in record.get(block.name, {}).items() if name in tasks and name not in missing}
    faults = []
    done = prove(block, text, sorted(missing), seconds=LONGEST) if missing else Findings([])
    for check in done.checks:
        name = check.name.removeprefix("proof of ")
        if check.passed:
            efforts = done.facts["efforts"][name]
            digest = digest_of(block, text, tasks[name], efforts)
            found[name] = Proved(digest, check.calls, efforts, float(check.note.removesuffix(" s")))
        else:
            faults.append(f"{name}: {check.note}")
    return {name: found[name] for name in tasks if name in found}, faults


def read_record(path: Path) -> Record:
    """Read a record; one that is not there is empty."""
    if not path.is_file():
        return {}
    content = json.loads(path.read_text())["proved"]
    return {block: {name: Proved(**item) for name, item in functions.items()} for block, functions in content.items()}


def record_text(record: Record) -> str:
    """Return a record as it is written."""
    proved: dict[str, Any] = {
        block: {name: vars(item) for name, item in functions.items()} for block, functions in sorted(record.items())
    }
    return json.dumps({"analyser": analyser(), "proved": proved}, indent=2) + "\n"
