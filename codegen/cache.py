"""What an export found, kept so that the same export again does no work twice.

An entry is found by a hash over all that could change the answer: the emitted C, everything the block holds, the choices,
plantc's own sources, and the compilers, C libraries, emulators and Python packages on this machine. What is kept is
handed out only where it is whole and its C is the C that was emitted just now.
"""

from __future__ import annotations

import hashlib
import importlib.metadata
import json
import os
import platform
import re
import shutil
import subprocess
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

from ..symbolic.block import Block
from .compiler import cache_folder
from .emit import CText
from .findings import CheckResult
from .fingerprint import fingerprint
from .folder import MANIFEST, MEASURED
from .options import Options
from .targets import find_toolchain, target_named

TOOLS = (
    "gcc", "g++", "clang", "clang++", "gcov", "arm-none-eabi-gcc", "riscv64-unknown-elf-gcc", "qemu-system-arm",
    "qemu-system-riscv32",
)  # fmt: skip
"""Programs that an export may call; another one of the same name is another machine."""

PACKAGES = ("casadi", "numpy", "scipy", "jinja2", "pyelftools", "capstone", "ziglang", "control")
"""Python packages whose version may change an answer."""

VARIABLES = (
    "CC", "PATH", "CPATH", "C_INCLUDE_PATH", "LIBRARY_PATH", "LD_LIBRARY_PATH", "LD_PRELOAD", "GCC_EXEC_PREFIX",
    "COMPILER_PATH", "OMP_NUM_THREADS", "ASAN_OPTIONS", "UBSAN_OPTIONS",
)  # fmt: skip
"""Variables of the environment that compilers and loaders follow."""


@dataclass
class Kept:
    """A finished export: its files, its checks (all passed), its statuses and its evidence."""

    files: dict[str, str]
    results: list[CheckResult]
    statuses: dict[str, int]
    evidence: dict[str, Any]


def key_of(block: Block, text: CText, options: Options, steps: int) -> str:
    """Return the hash under which an export is kept; empty where no hash tells two such blocks apart.

    Parameters
    ----------
    block : Block
        What is exported. If its oracle or its scenario is code of the user's own, it is never kept.
    text : CText
        Its C.
    options : Options
        The choices.
    steps : int
        Length of the nominal trace.
    """
    held = fingerprint(block)
    if held is None:
        return ""
    digest = hashlib.sha256()
    for part in (text.header, text.source, held, repr(options), str(steps), _sources(), _machine(options)):
        digest.update(part.encode())
        digest.update(b"\0")
    return digest.hexdigest()[:32]


@lru_cache
def _sources() -> str:
    """Return a hash of plantc's own sources."""
    digest = hashlib.sha256()
    root = Path(__file__).resolve().parent.parent
    paths = list((root / "plantc").rglob("*")) if (root / "plantc").is_dir() else list(root.glob("*.py"))
    for package in ("codegen", "symbolic", "reference", "simulation", "examples"):
        paths += (root / package).rglob("*")
    for path in sorted(paths):
        if path.is_file() and path.suffix in (".py", ".j2", ".c", ".h", ".in", ".ld"):
            digest.update(f"{path.relative_to(root).as_posix()}\0".encode() + path.read_bytes())
    return digest.hexdigest()


def _machine(options: Options) -> str:
    """Return what stands for the machine and its tools."""
    found = [platform.platform(), platform.python_version(), *(f"{name}={os.environ.get(name)}" for name in VARIABLES)]
    for name in PACKAGES:
        try:
            found.append(f"{name} {importlib.metadata.version(name)}")
        except importlib.metadata.PackageNotFoundError:
            found.append(f"no {name}")
    for tool in TOOLS:
        path = shutil.which(tool)
        if path:
            found.append(f"{tool} {_file(path)} {_said([path, '--version'])}")
    for name in dict.fromkeys(("host", *options.targets)):
        toolchain = find_toolchain(target_named(name))
        command = [*toolchain.compiler.command, *toolchain.target.flags]
        found.append(f"{toolchain.compiler.command} {_said([*toolchain.compiler.command, '--version'])}")
        found += [_file(part) for part in toolchain.compiler.command if os.path.isabs(part)]
        if toolchain.kind != "zig" and toolchain.compiler.label != "zig":
            found += _files_used_by(command)
    return "\n".join(found)


def _files_used_by(command: Sequence[str]) -> list[str]:
    """Return what stands for the assembler, the linker, and the libraries that a program is linked from."""
    programs = [_said([*command, f"-print-prog-name={name}"]) for name in ("as", "ld", "cc1")]
    link = [*command, "-x", "c", "-", "-o", os.devnull, "-lm", "-Wl,--verbose"]
    opened = re.findall(r"attempt to open (\S+) succeeded", _said(link, "int main(void) { return 0; }\n"))
    paths = [shutil.which(path) or path for path in [*programs, *opened]]
    return [_file(path) for path in dict.fromkeys(paths) if os.path.exists(path)]  # the object between them is gone


def _said(command: Sequence[str], typed: str = "") -> str:
    """Return what a program answers, errors behind; why not, where it cannot be started."""
    try:
        done = subprocess.run(command, input=typed, capture_output=True, text=True, check=False, timeout=60)
    except (OSError, subprocess.SubprocessError) as error:
        return str(error)
    return (done.stdout.strip() + "\n" + done.stderr.strip()).strip()


def _file(path: str) -> str:
    """Return what tells two states of a file apart, without reading it."""
    try:
        about = os.stat(path)
    except OSError:
        return f"{path} is not there"
    return f"{os.path.realpath(path)} {about.st_size} {about.st_mtime_ns}"


def _place(key: str) -> Path:
    return cache_folder() / f"export-{key}.json"


def kept(key: str, block: Block, text: CText) -> Kept | None:
    """Return what is kept under a key, or None if there is nothing, or nothing that can be handed out.

    Parameters
    ----------
    key : str
        See `key_of`.
    block : Block
        What is exported.
    text : CText
        Its C as it was emitted just now: another is never handed out.
    """
    try:
        stored = json.loads(_place(key).read_text())
        whole = stored.pop("digest")
        results = [CheckResult(**row) for row in stored["results"]]
        answer = Kept(stored["files"], results, stored["statuses"], stored["evidence"])
        sound = whole == _digest(stored) and _belongs(answer.files, block, text)
    except (OSError, ValueError, TypeError, KeyError, AttributeError):
        return None
    return answer if sound and answer.results and all(result.passed for result in answer.results) else None


def _belongs(files: dict[str, str], block: Block, text: CText) -> bool:
    """Whether files are those of this C: header and source to the byte, the others as their manifest lists them."""
    manifest = json.loads(files[MANIFEST])
    listed = manifest["files"]
    return (
        files[f"src/{block.name}.h"] == text.header
        and files[f"src/{block.name}.c"] == text.source
        and manifest["model"] == block.model_hash()
        and files.keys() - {MANIFEST, *MEASURED} == listed.keys()
        and all(hashlib.sha256(files[file].encode()).hexdigest() == value for file, value in listed.items())
    )


def _digest(stored: dict[str, Any]) -> str:
    return hashlib.sha256(json.dumps(stored, sort_keys=True).encode()).hexdigest()


def keep(key: str, found: Kept) -> None:
    """Keep a finished export; where that cannot be written it is done again next time."""
    place = _place(key)
    partial = place.with_suffix(f".{os.getpid()}.tmp")
    try:
        stored = json.loads(json.dumps(asdict(found)))
        partial.write_text(json.dumps({**stored, "digest": _digest(stored)}))
        os.replace(partial, place)
    except OSError:
        partial.unlink(missing_ok=True)
