"""Whose a folder is, and that it is replaced whole or not at all."""

import hashlib
import json
import os

import pytest
from plantc.codegen import folder as module
from plantc.codegen.folder import FolderError, check_folder_is_free, files_in, read_manifest, write_folder


def package(version, **more):
    """Files of an export, with a manifest that lists them."""
    files = {
        "src/x.c": f"source {version}",
        "src/x.h": f"header {version}",
        "CMakeLists.txt": f"build {version}",
        **more,
    }
    hashes = {file: hashlib.sha256(text.encode()).hexdigest() for file, text in files.items()}
    manifest = {"name": "x", "model": version, "precision": "double", "generator": "plantc 1", "files": hashes}
    return {**files, "manifest.json": json.dumps(manifest), "evidence.json": f"{{}} {version}"}


def contents(folder):
    return {file: (folder / file).read_text() for file in files_in(folder)}


@pytest.fixture(params=["ours alone", "with the user's files"])
def written(request, tmp_path):
    """A folder that an export wrote, and what of it belongs to the user."""
    folder = tmp_path / "x"
    write_folder(folder, package("1", **{"test/old.c": "goes"}))
    theirs = {}
    if request.param != "ours alone":
        (folder / "src/notes.txt").write_text("mine")
        (folder / "build").mkdir()
        (folder / "build/a.o").write_text("object")
        theirs = {"src/notes.txt": "mine", "build/a.o": "object"}
    return folder, theirs


def test_replacing_removes_what_is_no_longer_written_and_keeps_the_users_files(written):
    folder, theirs = written
    write_folder(folder, package("2", **{"cmake/new.in": "comes"}))
    assert contents(folder) == {**package("2", **{"cmake/new.in": "comes"}), **theirs}
    assert not (folder / "test").exists()
    assert [path.name for path in folder.parent.iterdir()] == ["x"]


@pytest.mark.parametrize("at", range(5))
def test_a_crash_half_way_leaves_what_was_there(written, monkeypatch, at):
    folder, _ = written
    before = contents(folder)
    rename, calls = os.rename, []

    def crashing(source, target):
        calls.append(target)
        if len(calls) == at + 1:
            raise KeyboardInterrupt
        rename(source, target)

    monkeypatch.setattr(module.os, "rename", crashing)
    monkeypatch.setattr(module, "_exchanged_at_once", lambda first, second: False)
    try:
        write_folder(folder, package("2"))
    except KeyboardInterrupt:
        assert contents(folder) == before
    else:
        assert len(calls) <= at  # it took fewer steps
        assert folder.joinpath("src/x.c").read_text() == "source 2"
    assert [path.name for path in folder.parent.iterdir()] == ["x"]


def test_a_file_that_cannot_be_written_leaves_what_was_there(written, monkeypatch):
    folder, _ = written
    before = contents(folder)

    def full(folder, files):
        raise OSError(28, "No space left on device", str(folder))

    monkeypatch.setattr(module, "write_files", full)
    with pytest.raises(FolderError, match=r"x: cannot be written \(No space left on device\); make room"):
        write_folder(folder, package("2"))
    assert contents(folder) == before


def test_where_the_system_can_the_folder_is_exchanged_in_one_step(tmp_path, monkeypatch):
    if os.uname().sysname != "Linux":
        pytest.skip("not Linux")
    folder = tmp_path / "x"
    write_folder(folder, package("1"))

    def never(source, target):
        raise AssertionError("renamed in two steps")

    monkeypatch.setattr(module.os, "rename", never)
    write_folder(folder, package("2"))
    assert contents(folder) == package("2")


def test_a_folder_that_holds_someone_elses_files(tmp_path):
    folder = tmp_path / "x"
    folder.mkdir()
    write_folder(folder, package("1"))  # an empty folder is nobody's
    (folder / "manifest.json").unlink()
    with pytest.raises(
        FolderError, match=r"x: it holds files that plantc did not write \(CMakeLists.txt, .*\) and no man"
    ):
        write_folder(folder, package("2"))
    (folder / "manifest.json").write_text('{"name": "a web page"}')
    before = contents(folder)
    with pytest.raises(FolderError, match="no manifest of an export; move them, or give another --out"):
        check_folder_is_free(folder)
    (folder / "data.csv").write_text("mine")  # someone's own manifest has these words too
    own = {"name": "page", "model": "T", "precision": "high", "files": {"data.csv": ""}}
    for manifest in (own, {**own, "generator": "a web page"}, {**own, "generator": "plantc 1"}):
        (folder / "manifest.json").write_text(json.dumps(manifest))
        with pytest.raises(FolderError, match="no manifest of an export; move them, or give another --out"):
            write_folder(folder, package("2"), force=True)
    assert contents(folder) == {**before, "manifest.json": json.dumps(manifest), "data.csv": "mine"}


@pytest.mark.parametrize("file", ["src/x.c", "test/old.c"])
def test_a_file_that_was_changed_by_hand_is_the_users(tmp_path, file):
    folder = tmp_path / "x"
    write_folder(folder, package("1", **{"test/old.c": "goes"}))
    (folder / "src/x.h").write_bytes(b"header 1\r\n".rstrip())  # its line ends are nobody's change
    (folder / file).write_text("mine")
    (folder / "CMakeLists.txt").unlink()  # nor is a file that is gone
    before = contents(folder)
    with pytest.raises(FolderError, match=rf"x/{file}: it was changed since plantc wrote it; .* --force"):
        write_folder(folder, package("2"))
    assert contents(folder) == before
    write_folder(folder, package("2"), force=True)
    assert contents(folder) == package("2")


@pytest.mark.parametrize("exists", [True, False])
def test_nothing_is_written_through_a_link(tmp_path, exists):
    folder, outside = tmp_path / "x", tmp_path / "outside"
    write_folder(folder, package("1"))
    outside.mkdir()
    for file in ("x.c", "x.h"):
        os.rename(folder / "src" / file, outside / file)
    (folder / "src").rmdir()
    (folder / "src").symlink_to(outside if exists else tmp_path / "nowhere")
    with pytest.raises(FolderError, match="x/src: it is a link, so the C would be written outside"):
        write_folder(folder, package("2"))
    assert (outside / "x.c").read_text() == "source 1"
    assert not (tmp_path / "nowhere").exists()


@pytest.mark.parametrize("file", ["library.json", "zephyr"])
def test_a_file_of_the_user_that_would_be_written_over(tmp_path, file):
    folder = tmp_path / "x"
    write_folder(folder, package("1"))
    (folder / file).write_text("mine")
    before = contents(folder)
    with pytest.raises(FolderError, match=rf"x/{file}: plantc did not write it; move it, or give another --out"):
        write_folder(folder, package("2", **{"library.json": "{}", "zephyr/Kconfig": ""}))
    assert contents(folder) == before


def test_a_folder_that_cannot_be_written(tmp_path, monkeypatch):
    (tmp_path / "file").write_text("mine")
    with pytest.raises(FolderError, match=r"file: it is a file, not a folder"):
        check_folder_is_free(tmp_path / "file/x")
    with pytest.raises(FolderError, match=r"file: a file of this name is in the way"):
        check_folder_is_free(tmp_path / "file")
    monkeypatch.setattr(module.os, "access", lambda path, mode: False)
    with pytest.raises(FolderError, match=r"no permission to write there; give another --out"):
        check_folder_is_free(tmp_path / "deep/x")


def test_a_place_that_no_one_can_write():
    if not os.path.isdir("/proc/self"):
        pytest.skip("no /proc")
    with pytest.raises(FolderError, match="give another --out"):
        write_folder(module.Path("/proc/plantc/x"), package("1"))


def test_a_link_to_a_folder_stays_a_link(tmp_path):
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "x").symlink_to("elsewhere")
    write_folder(tmp_path / "x", package("1"))
    write_folder(tmp_path / "x", package("2"))
    assert (tmp_path / "x").is_symlink()
    assert contents(tmp_path / "elsewhere") == package("2")


def test_a_manifest_never_names_files_outside(tmp_path):
    (tmp_path / "victim").write_text("mine")
    folder = tmp_path / "x"
    files = package("1")
    write_folder(folder, files)
    for path in ("../victim", "/etc/passwd", "a/../../victim", ""):
        manifest = {**json.loads(files["manifest.json"]), "files": {path: "0" * 64}}
        (folder / "manifest.json").write_text(json.dumps(manifest))
        with pytest.raises(FolderError, match="not a manifest of plantc"):
            read_manifest(folder)


def test_a_folder_without_a_manifest(tmp_path):
    with pytest.raises(FolderError, match=r"there is no manifest.json; give a folder that plantc export wrote"):
        read_manifest(tmp_path)
    (tmp_path / "manifest.json").write_text("{")
    with pytest.raises(FolderError, match="not readable as JSON"):
        read_manifest(tmp_path)
