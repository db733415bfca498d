"""Finding a C compiler and calling it, with floating-point contraction always stated."""

from __future__ import annotations

import hashlib
import importlib.util
import os
import platform
import shlex
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

BASE_FLAGS = ("-std=c99", "-O2")
WARNINGS = ("-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wdouble-promotion", "-Wshadow", "-Werror")


class CompilerError(RuntimeError):
    """There is no compiler, or it refused the code. The message says what to install, or what it said."""


@dataclass(frozen=True)
class Compiler:
    """A C compiler.

    Attributes
    ----------
    command : tuple of str
        How it is called.
    label : str
        What people call it: ``gcc``, ``clang``, ``zig``, or the content of ``$CC``.
    """

    command: tuple[str, ...]
    label: str

    def version(self) -> str:
        """Return the first line of what it says of itself."""
        try:
            done = subprocess.run(
                [*self.command, "--version"], capture_output=True, text=True, check=False, env=_environment()
            )
        except OSError:
            return "unknown"
        return (done.stdout or done.stderr).strip().split("\n")[0]

    def run(self, arguments: Sequence[str], folder: Path) -> None:
        """Call it in a folder.

        Raises
        ------
        CompilerError
            With the beginning of what it printed.
        """
        try:
            done = subprocess.run(
                [*self.command, *arguments], cwd=folder, capture_output=True, text=True, check=False, env=_environment()
            )
        except OSError as error:
            raise CompilerError(
                f"the compiler {' '.join(self.command)!r} cannot be started ({error}); check $CC"
            ) from None
        if done.returncode != 0:
            said = (done.stderr or done.stdout).strip()[:2000]
            raise CompilerError(f"{self.label} refused the generated C (a fault of plantc, please report it): {said}")

    def shared_library(self, sources: Sequence[Path], target: Path, *, contract: bool = False) -> Path:
        """Compile sources into a shared library.

        Parameters
        ----------
        sources : sequence of Path
            C files, in one folder.
        target : Path
            The library.
        contract : bool
            Whether a product and a sum may become one fused operation (``-ffp-contract=fast``).
        """
        flags = [*BASE_FLAGS, *WARNINGS, contraction_flag(contract), "-fPIC", "-shared"]
        folder = sources[0].parent
        self.run(
            [*flags, *[item.name for item in sources], "-o", str(target), *(["-lm"] if os.name == "posix" else [])],
            folder,
        )
        return target

    def program(self, sources: Sequence[Path], target: Path, *, contract: bool = False) -> Path:
        """Compile sources into a program; headers lie beside the first of them."""
        flags = [*BASE_FLAGS, *WARNINGS, contraction_flag(contract), f"-I{sources[0].parent}"]
        self.run([*flags, *[str(item) for item in sources], "-o", str(target), "-lm"], sources[0].parent)
        return target


def contraction_flag(contract: bool) -> str:
    """Return the flag that states whether products and sums may be fused."""
    return "-ffp-contract=fast" if contract else "-ffp-contract=off"


def _environment() -> dict[str, str]:
    """Return the environment for a compiler: zig keeps its cache where it can write."""
    environment = dict(os.environ)
    environment.setdefault("ZIG_GLOBAL_CACHE_DIR", str(cache_folder() / "zig"))
    return environment


def cache_folder() -> Path:
    """Return the folder for compiled libraries, made if need be; a temporary one where the home cannot be written."""
    for base in (os.environ.get("XDG_CACHE_HOME"), Path.home() / ".cache" if Path.home() != Path("/") else None):
        if base:
            folder = Path(base) / "plantc"
            try:
                folder.mkdir(parents=True, exist_ok=True)
            except OSError:
                continue
            if os.access(folder, os.W_OK):
                return folder
    folder = Path(tempfile.gettempdir()) / f"plantc-{os.getuid() if hasattr(os, 'getuid') else 'cache'}"
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def find_compiler() -> Compiler:
    """Return ``$CC``, else gcc, else clang, else the zig wheel.

    Raises
    ------
    CompilerError
        If there is none; it says what to install.
    """
    chosen = os.environ.get("CC", "").strip()
    if chosen:
        command = shlex.split(chosen)
        if shutil.which(command[0]) is None:
            raise CompilerError(f"$CC is {chosen!r}, which is not a program on the PATH; set it right, or unset it")
        return Compiler(tuple(command), chosen)
    for name in ("gcc", "clang"):
        path = shutil.which(name)
        if path:
            return Compiler((path,), name)
    if importlib.util.find_spec("ziglang") is not None:
        return Compiler((sys.executable, "-m", "ziglang", "cc"), "zig")
    raise CompilerError(
        "no C compiler found; install gcc or clang, set $CC, or install one by pip: pip install 'plantc[compiler]'"
    )


def library_for(sources: dict[str, str], *, contract: bool = False) -> Path:
    """Return the shared library of some C text, compiled once for each text and compiler.

    Parameters
    ----------
    sources : dict
        File name -> text; headers too.
    contract : bool
        See `Compiler.shared_library`.
    """
    compiler = find_compiler()
    digest = hashlib.sha256()
    for part in (*compiler.command, compiler.version(), str(contract), platform.machine(), sys.platform, *BASE_FLAGS):
        digest.update(part.encode())
    for name in sorted(sources):
        digest.update(f"{name}\0{sources[name]}\0".encode())
    target = cache_folder() / f"{digest.hexdigest()[:24]}.{'dll' if os.name == 'nt' else 'so'}"
    if target.exists():
        return target
    with tempfile.TemporaryDirectory(prefix="plantc-") as name:
        folder = Path(name)
        for file, text in sources.items():
            (folder / file).write_text(text)
        built = folder / "library.so"
        compiler.shared_library(
            [folder / file for file in sorted(sources) if file.endswith(".c")], built, contract=contract
        )
        # another process may build the same: the rename is atomic, and either result will do
        partial = target.with_suffix(f".{os.getpid()}.tmp")
        shutil.copy(built, partial)
        os.replace(partial, target)
    return target
