"""What an export found, kept so that the same export again does no work twice.

An entry is found by a hash over all that could change the answer: the emitted C, the model, the choices, plantc's own
sources, and the compilers, emulators and analysers on this machine.
"""

from __future__ import annotations

import hashlib
import json
import os
import platform
import shutil
from dataclasses import asdict, dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

from ..symbolic.block import Block
from .compiler import cache_folder, find_compiler
from .emit import CText
from .findings import CheckResult
from .options import Options

TOOLS = (
    "gcc", "g++", "clang", "clang++", "gcov", "arm-none-eabi-gcc", "riscv64-unknown-elf-gcc", "qemu-system-arm",
    "qemu-system-riscv32",
)  # fmt: skip
"""Programs that an export may call; another one of the same name is another machine."""


@dataclass
class Kept:
    """A finished export: its files, its checks (all passed), its statuses and its evidence."""

    files: dict[str, str]
    results: list[CheckResult]
    statuses: dict[str, int]
    evidence: dict[str, Any]


def is_cacheable(block: Block) -> bool:
    """Whether a hash tells two such blocks apart: an oracle that is the user's own code it does not."""
    own = block.oracle is None or type(block.oracle).__module__.startswith("plantc.")
    return own and all(is_cacheable(part) for part in block.parts.values())


def key_of(block: Block, text: CText, options: Options, steps: int) -> str:
    """Return the hash under which an export is kept.

    Parameters
    ----------
    block : Block
        What is exported.
    text : CText
        Its C.
    options : Options
        The choices.
    steps : int
        Length of the nominal trace.
    """
    digest = hashlib.sha256()
    for part in (text.header, text.source, block.model_hash(), repr(options), str(steps), _sources(), _machine()):
        digest.update(part.encode())
        digest.update(b"\0")
    return digest.hexdigest()[:32]


@lru_cache
def _sources() -> str:
    """Return a hash of plantc's own sources."""
    digest = hashlib.sha256()
    root = Path(__file__).resolve().parent.parent
    for package in ("codegen", "symbolic", "reference"):
        for path in sorted((root / package).rglob("*")):
            if path.is_file() and path.suffix in (".py", ".j2", ".c", ".h", ".in"):
                digest.update(f"{package}/{path.name}\0".encode() + path.read_bytes())
    return digest.hexdigest()


def _machine() -> str:
    """Return what stands for the machine and its tools."""
    found = [platform.platform(), repr(find_compiler().command)]
    for tool in TOOLS:
        path = shutil.which(tool)
        if path:
            about = os.stat(os.path.realpath(path))
            found.append(f"{tool} {path} {about.st_size} {about.st_mtime_ns}")
    return "\n".join(found)


def _place(key: str) -> Path:
    return cache_folder() / f"export-{key}.json"


def kept(key: str) -> Kept | None:
    """Return what is kept under a key, or None if there is nothing, or nothing that can be read."""
    try:
        stored = json.loads(_place(key).read_text())
        results = [CheckResult(**row) for row in stored["results"]]
        answer = Kept(stored["files"], results, stored["statuses"], stored["evidence"])
    except (OSError, ValueError, TypeError, KeyError):
        return None
    return answer if answer.results and all(result.passed for result in answer.results) else None


def keep(key: str, found: Kept) -> None:
    """Keep a finished export; where that cannot be written it is done again next time."""
    place = _place(key)
    partial = place.with_suffix(f".{os.getpid()}.tmp")
    try:
        partial.write_text(json.dumps(asdict(found)))
        os.replace(partial, place)
    except OSError:
        partial.unlink(missing_ok=True)
