"""trace.json: from a line of the model to its equation, from there to lines of the C, and to the vectors that run them."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from typing import Any

from ..symbolic.block import Block
from ..symbolic.program import Evaluate, Kernel
from ..symbolic.signals import Status
from .emit import CText, generator_version
from .provenance import Genealogy, Parent, Provenance
from .vectors import Vector

ABOUT = (
    "parents: what lines of the C are there for. lines: [first, last, parent]. vectors: what each ran of the model's "
    "program; coverage of the C by lines is measured, and is in evidence.json."
)


def trace_text(block: Block, text: CText, vectors: Sequence[Vector]) -> str:
    """Return the JSON of the trace: the same bytes for the same model file, on any machine.

    Parameters
    ----------
    block : Block
        The block.
    text : CText
        Its C.
    vectors : sequence of Vector
        The shipped vectors.
    """
    made = text.provenance
    file = f"src/{block.name}.c"
    runs = made.runs()
    reached = [sorted(_reached(block, made, vector)) for vector in vectors]
    by_parent: list[list[int]] = [[] for _ in made.parents]
    for index, found in enumerate(reached):
        for at in found:
            by_parent[at].append(index)
    model: dict[str, list[int]] = {}
    for at, parent in enumerate(made.parents):
        for source in parent.sources:
            model.setdefault(source, []).append(at)
    parents = [
        {
            "id": at,
            "kind": parent.kind,
            "text": parent.text,
            "entry": parent.entry,
            "sources": list(parent.sources),
            "vectors": by_parent[at],
        }
        for at, parent in enumerate(made.parents)
    ]
    calls = [
        {"index": index, "entry": vector.entry, "status": vector.status, "parents": reached[index]}
        for index, vector in enumerate(vectors)
    ]
    return _json(
        {
            "name": block.name,
            "model": block.model_hash(),
            "generator": f"plantc {generator_version()}",
            "about": ABOUT,
            "sources": {source: model[source] for source in sorted(model, key=_by_number)},
            "parents": parents,
            "functions": {file: [list(item) for item in made.functions]},
            "lines": {file: [list(run) for run in runs]},
            "vectors": calls,
        }
    )


def _by_number(source: str) -> tuple[str, int]:
    file, _, line = source.rpartition(":")
    return file, int(line) if line.isdigit() else 0


def _json(content: dict[str, Any]) -> str:
    """Write one record a line: short, and good to compare."""
    rows = []
    for key, value in content.items():
        if isinstance(value, list):
            inner = ",\n".join(f"    {json.dumps(item)}" for item in value)
            rows.append(f"  {json.dumps(key)}: [\n{inner}\n  ]")
        elif isinstance(value, dict):
            inner = ",\n".join(f"    {json.dumps(name)}: {json.dumps(item)}" for name, item in value.items())
            rows.append(f"  {json.dumps(key)}: {{\n{inner}\n  }}")
        else:
            rows.append(f"  {json.dumps(key)}: {json.dumps(value)}")
    return "{\n" + ",\n".join(rows) + "\n}\n"


def _reached(block: Block, made: Provenance, vector: Vector) -> set[int]:
    """Return the positions of the parents that a vector ran."""
    found: set[int] = set()
    entries = {visit.entry for visit in vector.visits} | {vector.entry}
    for at, parent in enumerate(made.parents):
        if parent.entry not in entries:
            continue
        always = parent.kind in ("entry", "bookkeeping") and not _of_a_statement(parent)
        # only the function that a user calls commits
        commits = parent.kind == "commit" and parent.entry == vector.entry and Status[vector.status] >= 0
        if always or commits:
            found.add(at)
    position = {parent: at for at, parent in enumerate(made.parents)}
    for visit in vector.visits:
        for parent in _parents_of(block, made, visit.entry, visit.statement):
            if parent in position:
                found.add(position[parent])
    return found


def _of_a_statement(parent: Parent) -> bool:
    """Whether bookkeeping belongs to a statement of its own, which not every call runs."""
    return parent.kind == "bookkeeping" and ("counts up" in parent.text or parent.text == "memory as before the call")


def _parents_of(block: Block, made: Provenance, label: str, statement: Any) -> Iterator[Parent]:
    *parts, entry = label.split(".")
    owner = block
    for part in parts:
        owner = owner.parts[part]
    genealogy = Genealogy(owner, owner.entries[entry], "".join(f"{part}." for part in parts))
    if isinstance(statement, Evaluate):
        yield from genealogy.of_evaluation(statement)
    elif isinstance(statement, Kernel):
        own = genealogy.of(statement).text
        for parent in made.parents:  # kernels that share a scope share a parent
            if parent.kind == "kernel" and parent.entry == label and own in parent.text:
                yield parent
    else:
        yield genealogy.of(statement)
