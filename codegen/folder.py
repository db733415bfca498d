"""The folder of an export: whose it is, and replacing it whole or not at all."""

from __future__ import annotations

import ctypes
import hashlib
import json
import os
import re
import shutil
import sys
import tempfile
from collections.abc import Iterable, Mapping
from pathlib import Path, PurePosixPath
from typing import Any

MANIFEST = "manifest.json"

MEASURED = frozenset({"evidence.json", "report.html", "audit.json"})
"""Files that hold what was measured on a machine; all others are the same bytes anywhere."""

Content = str | bytes


class FolderError(OSError):
    """A folder that cannot be written, or that holds someone else's files. The message says which, and the mend."""


def read_manifest(folder: Path) -> dict[str, Any]:
    """Return a folder's manifest.

    Raises
    ------
    FolderError
        If there is none, in a sentence.
    """
    path = folder / MANIFEST
    try:
        manifest = json.loads(path.read_text(encoding="utf-8"))
    except (FileNotFoundError, NotADirectoryError):
        raise FolderError(f"{folder}: there is no manifest.json; give a folder that plantc export wrote") from None
    except ValueError as error:
        raise FolderError(f"{path}: not readable as JSON ({error}); export again") from None
    except OSError as error:
        raise FolderError(f"{path}: cannot be read ({error.strerror}); make it readable") from None
    if not isinstance(manifest, dict) or not {"name", "model", "precision", "files", "generator"} <= manifest.keys():
        raise FolderError(f"{path}: not a manifest of plantc; export again")
    if not str(manifest["generator"]).startswith("plantc "):
        raise FolderError(f"{path}: not a manifest of plantc; export again")
    files = manifest["files"]
    if not isinstance(files, dict) or not all(map(_is_inside, files)) or not all(map(_is_hash, files.values())):
        raise FolderError(f"{path}: not a manifest of plantc; export again")
    return manifest


def _is_hash(value: object) -> bool:
    return isinstance(value, str) and re.fullmatch("[0-9a-f]{64}", value) is not None


def _is_inside(file: str) -> bool:
    path = PurePosixPath(file)
    return bool(path.parts) and not path.is_absolute() and ".." not in path.parts and "\\" not in file


def files_in(folder: Path) -> list[str]:
    """Return the path inside the folder of everything in it (files, links, folders with nothing in them), sorted."""
    return sorted(
        path.relative_to(folder).as_posix()
        for path in folder.rglob("*")
        if path.is_symlink() or not path.is_dir() or not any(path.iterdir())
    )


def earlier_files(folder: Path) -> set[str]:
    """Return what an earlier export wrote into a folder; nothing where there was none.

    Raises
    ------
    FolderError
        If the folder holds files, but no manifest of plantc.
    """
    if not os.path.lexists(folder):
        return set()
    if not folder.is_dir():
        raise FolderError(f"{folder}: a file of this name is in the way; move it, or give another --out")
    try:
        manifest = read_manifest(folder)
    except FolderError:
        lying = sorted(os.listdir(folder))
        if not lying:
            return set()
        shown = ", ".join(lying[:3]) + (", ..." if len(lying) > 3 else "")
        raise FolderError(
            f"{folder}: it holds files that plantc did not write ({shown}) and no manifest of an export; "
            "move them, or give another --out"
        ) from None
    return {*manifest["files"], MANIFEST, *MEASURED, f"{manifest['name']}.fmu"}


def changed_files(folder: Path) -> list[str]:
    """Return which files of an earlier export are no longer what it wrote, by the hashes of its manifest.

    Line ends are not looked at, since version control turns them; a file that is gone is not told.
    """
    if not (folder / MANIFEST).is_file():
        return []
    changed = []
    for file, wanted in read_manifest(folder)["files"].items():
        path = folder / file
        if path.is_file():
            content = path.read_bytes()
            both = {hashlib.sha256(each).hexdigest() for each in (content, content.replace(b"\r\n", b"\n"))}
            if wanted not in both:
                changed.append(file)
        elif os.path.lexists(path):
            changed.append(file)
    return changed


def check_folder_is_free(folder: Path, files: Iterable[str] = (), *, force: bool = False) -> set[str]:
    """See that a folder may be replaced, before work is put into it.

    Parameters
    ----------
    folder : Path
        Where an export goes.
    files : iterable of str
        What it will write, as far as that is known.
    force : bool
        Whether files of an earlier export may be replaced that someone changed since.

    Returns
    -------
    set of str
        What an earlier export wrote there.

    Raises
    ------
    FolderError
        If the folder holds someone else's files under a name that is to be written, or no manifest, or files of an
        earlier export that were changed since, or cannot be written, or leads elsewhere by a link.
    """
    ours = earlier_files(folder)
    changed = [] if force else changed_files(folder)
    if changed:
        more = f" (and {len(changed) - 1} more)" if len(changed) > 1 else ""
        raise FolderError(
            f"{folder / changed[0]}: it was changed since plantc wrote it{more}; keep your change elsewhere, or export with "
            "--force, which writes over it"
        )
    for file in sorted({*ours, *files}):
        for above_it in list(PurePosixPath(file).parents)[:-1]:
            if (folder / above_it).is_symlink():
                raise FolderError(
                    f"{folder / above_it}: it is a link, so the C would be written outside {folder}; remove it, or give another "
                    "--out"
                )
    for file in files:
        for path in [file, *(parent.as_posix() for parent in list(PurePosixPath(file).parents)[:-1])]:
            lies = folder / path
            if path not in ours and os.path.lexists(lies) and (path == file or not lies.is_dir()):
                raise FolderError(f"{lies}: plantc did not write it; move it, or give another --out")
    above = next(path for path in [folder, *folder.absolute().parents] if os.path.lexists(path))
    if not above.is_dir():
        raise FolderError(f"{above}: it is a file, not a folder; give another --out")
    parent = folder.parent if above == folder else above
    for place in {above, parent}:
        if not os.access(place, os.W_OK | os.X_OK):
            raise FolderError(f"{place}: no permission to write there; give another --out")
    return ours


def write_files(folder: Path, files: Mapping[str, Content]) -> None:
    """Write files into a folder; their names are paths inside it. Text is UTF-8 with plain line ends anywhere."""
    for file, content in files.items():
        path = folder / file
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content.encode() if isinstance(content, str) else content)


def write_file(path: Path, text: str) -> None:
    """Write a file aside and put it in its place in one step: never half of it.

    Raises
    ------
    FolderError
        If it cannot be written, in a sentence.
    """
    place = path.resolve()
    partial = place.with_name(f".{place.name}.{os.getpid()}.tmp")
    try:
        partial.write_bytes(text.encode())
        os.replace(partial, place)
    except OSError as error:
        raise FolderError(f"{path}: cannot be written ({error.strerror or error}); make its folder writable") from error
    finally:
        partial.unlink(missing_ok=True)


def write_folder(folder: Path, files: Mapping[str, Content], *, force: bool = False) -> None:
    """Replace what an earlier export wrote by these files, whole or not at all.

    All is written aside first. Where the folder holds nothing of the user's it is then exchanged in one step, as far as
    the system can; where it does, file by file, and back if one of them fails. The user's own files stay; files of an
    earlier export that are no longer written go. `force`: see `check_folder_is_free`.

    Raises
    ------
    FolderError
        See `check_folder_is_free`; or the disk is full, or the like. What was there stays.
    """
    ours = check_folder_is_free(folder, files, force=force)
    real = folder.resolve()
    try:
        real.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=real.parent, prefix=f".{real.name}-") as name:
            fresh, aside = Path(name) / "new", Path(name) / "old"
            fresh.mkdir()
            write_files(fresh, files)
            if not real.exists():
                os.rename(fresh, real)
            elif set(files_in(real)) <= ours:
                _exchange(fresh, real, aside)
            else:
                _replace_each(fresh, real, aside, list(files), sorted(ours - files.keys()))
    except FolderError:
        raise
    except OSError as error:
        raise FolderError(
            f"{folder}: cannot be written ({error.strerror or error}); make room for it, or give another --out"
        ) from error


def _exchange(fresh: Path, folder: Path, aside: Path) -> None:
    """Put one folder in another's place."""
    shutil.copymode(folder, fresh)
    if _exchanged_at_once(fresh, folder):
        return
    os.rename(folder, aside)
    try:
        os.rename(fresh, folder)
    except BaseException:
        os.rename(aside, folder)
        raise


def _exchanged_at_once(first: Path, second: Path) -> bool:
    """Let two folders change names in one step, where the system has a call for it (Linux)."""
    if not sys.platform.startswith("linux"):
        return False
    call = getattr(ctypes.CDLL(None, use_errno=True), "renameat2", None)
    at_working_folder, exchange = -100, 2
    if call is None:
        return False
    done = call(at_working_folder, os.fsencode(first), at_working_folder, os.fsencode(second), ctypes.c_uint(exchange))
    return int(done) == 0


def _replace_each(fresh: Path, folder: Path, aside: Path, files: list[str], stale: list[str]) -> None:
    """Move files into a folder that holds others too; if one fails all go back. The manifest comes last."""
    moved: list[str] = []
    written: list[str] = []
    try:
        for file in [
            *stale,
            *(name for name in files if name != MANIFEST),
            *(name for name in files if name == MANIFEST),
        ]:
            if os.path.lexists(folder / file):
                (aside / file).parent.mkdir(parents=True, exist_ok=True)
                moved.append(file)
                os.rename(folder / file, aside / file)
            if file in files:
                (folder / file).parent.mkdir(parents=True, exist_ok=True)
                written.append(file)
                os.rename(fresh / file, folder / file)
    except BaseException:
        for file in written:
            if not os.path.lexists(fresh / file):
                (folder / file).unlink()
        for file in moved:
            if os.path.lexists(aside / file):
                (folder / file).parent.mkdir(parents=True, exist_ok=True)
                os.rename(aside / file, folder / file)
        _remove_empty(folder, written)
        raise
    _remove_empty(folder, stale)


def _remove_empty(folder: Path, files: Iterable[str]) -> None:
    """Remove the folders of files that are gone, where nothing is left in them."""
    for file in files:
        for parent in list(PurePosixPath(file).parents)[:-1]:
            path = folder / parent
            if path.is_dir() and not path.is_symlink() and not any(path.iterdir()):
                path.rmdir()
