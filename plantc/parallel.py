"""Blocks of one model exported side by side, each in a process of its own: CasADi's graphs cannot be shared."""

from __future__ import annotations

import multiprocessing
import time
from concurrent.futures import Future, ProcessPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from . import models
from .codegen.options import Options
from .codegen.package import ExportError, export, with_design
from .evidence import evidence_text, export_json, sentence
from .symbolic import Block


@dataclass
class Outcome:
    """What became of one block: exit status, lines for the terminal, the object for JSON or the error, a new design."""

    status: int
    lines: list[str] = field(default_factory=list)
    result: dict[str, Any] = field(default_factory=dict)
    error: str = ""
    designed: dict[str, Any] = field(default_factory=dict)


def export_all(
    path: Path, blocks: list[Block], out: Path, options: Options, redesign: bool, how: dict[str, Any], jobs: int
) -> list[Outcome]:
    """Export blocks of a model file, some at a time, and return what became of each, in their order.

    Parameters
    ----------
    path : Path
        The model; each process runs it again.
    blocks : list of Block
        What is exported.
    out : Path
        Folder of the blocks' folders.
    options : Options
        The choices.
    redesign : bool
        Whether designed numbers are designed anew; what is to be written of them is in the outcomes.
    how : dict
        More for `codegen.package.export`: steps, fmu, cached, force.
    jobs : int
        Processes at a time.
    """
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(min(jobs, len(blocks)), mp_context=context) as pool:
        waiting = [pool.submit(_export_one, path, block.name, out, options, redesign, how) for block in blocks]
        return [_outcome(item) for item in waiting]


def _outcome(future: Future[Outcome]) -> Outcome:
    try:
        return future.result()
    except Exception as error:  # the process died
        return Outcome(2, error=sentence(error))


def _export_one(path: Path, name: str, out: Path, options: Options, redesign: bool, how: dict[str, Any]) -> Outcome:
    """Run in a process of its own: load the model, export one block."""
    started = time.perf_counter()
    try:
        given = next(block for block in models.blocks_of(str(path))[0] if block.name == name)
        block, designed = with_design(given, path.parent / "design.json", redesign=redesign, write=False)
        done = export(block, out, options=options, **how)
    except ExportError as error:
        return Outcome(1, error=str(error))
    except BaseException as error:  # the user's own code runs here, and may raise anything
        return Outcome(2, error=sentence(error))
    lines = evidence_text(done, time.perf_counter() - started)
    return Outcome(0, lines, export_json(done), designed={} if designed is None else {block.name: designed})
