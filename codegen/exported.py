"""A folder that an export wrote, as the audits look at it, and the tools they call."""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .folder import FolderError, read_manifest


class MissingTool(RuntimeError):  # noqa: N818 - it is an answer as much as an error
    """A tool that an audit needs is not there. One sentence, with the package to install."""


class AuditError(ValueError):
    """A request that cannot be met, or C that a compiler refuses. One sentence."""


@dataclass(frozen=True)
class ExportedFolder:
    """A folder that `plantc export` wrote, and how much work an audit may put into it.

    Attributes
    ----------
    path : Path
        The folder.
    manifest : dict
        Its manifest.json: name, model, precision, memory, parameters, entries, files.
    calls : int
        How many random calls each sanitizer sees.
    seconds : float
        How long a search for new paths may take.
    """

    path: Path
    manifest: dict[str, Any]
    calls: int = 3_000_000
    seconds: float = 5.0

    @property
    def name(self) -> str:
        """The block's name: prefix of everything."""
        return str(self.manifest["name"])

    @property
    def precision(self) -> str:
        """``float`` or ``double``."""
        return str(self.manifest["precision"])

    @property
    def library(self) -> list[str]:
        """The C files of the library, as paths inside the folder."""
        return [file for file in self.c_files if file.startswith("src/")]

    @property
    def programs(self) -> list[str]:
        """The C files that are not library code: example, vectors, harnesses."""
        return [file for file in self.c_files if not file.startswith("src/")]

    @property
    def c_files(self) -> list[str]:
        """All C files, as paths inside the folder."""
        return sorted(file for file in self.manifest["files"] if file.endswith(".c"))

    @property
    def hashes(self) -> dict[str, str]:
        """Path inside the folder -> SHA-256 of each C file and header as it lies there now."""
        return {
            file: hashlib.sha256((self.path / file).read_bytes()).hexdigest()
            for file in sorted(self.manifest["files"])
            if file.endswith((".c", ".h"))
        }

    @property
    def changed(self) -> list[str]:
        """The C files and headers that are no longer what the export wrote."""
        return [file for file, digest in self.hashes.items() if digest != self.manifest["files"][file]]


def open_folder(path: Path, *, calls: int = 3_000_000, seconds: float = 5.0) -> ExportedFolder:
    """Return an exported folder.

    Raises
    ------
    FolderError
        If it is none, or a C file of its manifest is missing.
    """
    folder = ExportedFolder(path, read_manifest(path), calls, seconds)
    missing = [file for file in folder.c_files if not (path / file).is_file()]
    if missing or not folder.library:
        what = ", ".join(missing) or f"src/{folder.name}.c"
        raise FolderError(f"{path}: {what} is missing; export again")
    return folder


def tool(name: str, package: str = "") -> str:
    """Return the path of a program.

    Raises
    ------
    MissingTool
        If it is not on the PATH.
    """
    found = shutil.which(name)
    if found is None:
        raise MissingTool(f"{name} is not installed; install it (Debian: apt install {package or name})")
    return found


def run_tool(
    command: Sequence[str | Path], folder: Path, *, seconds: float = 600.0
) -> subprocess.CompletedProcess[str]:
    """Run a program in a folder, in plain English, and return what it said."""
    environment = {**os.environ, "LC_ALL": "C"}
    return subprocess.run(
        [str(item) for item in command],
        cwd=folder,
        capture_output=True,
        text=True,
        errors="replace",
        check=False,
        timeout=seconds,
        env=environment,
    )


def version_of(name: str) -> str:
    """Return the first line of what a program says of itself, or that it is not installed."""
    path = shutil.which(name)
    if path is None:
        return "not installed"
    done = run_tool([path, "--version"], Path.cwd())
    return (done.stdout or done.stderr).strip().split("\n")[0]
