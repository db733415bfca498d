"""The cache of exports: the same again does no work; whatever could change the answer is another key."""

import copy
import dataclasses
import os

import pytest
from plantc.codegen import cache, emit, export, package
from plantc.codegen.fingerprint import fingerprint
from plantc.codegen.options import Options
from plantc.codegen.style import Precision
from plantc.examples.pendulum import pendulum_ekf
from plantc.symbolic import Block, Scenario

OPTIONS = Options(Precision("float"))
STEPS = 20


@pytest.fixture(scope="module")
def own_cache(tmp_path_factory):
    with pytest.MonkeyPatch.context() as patch:
        folder = tmp_path_factory.mktemp("cache")
        patch.setenv("XDG_CACHE_HOME", str(folder))
        yield folder


@pytest.fixture(scope="module")
def first(own_cache, tmp_path_factory):
    return export(pendulum_ekf, tmp_path_factory.mktemp("out"), options=OPTIONS, steps=STEPS, cached=True)


def contents(folder):
    return {path.relative_to(folder): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_the_same_again_does_no_work_and_gives_the_same_files(first, tmp_path, monkeypatch):
    monkeypatch.setattr(package, "cross_check", lambda *given, **named: pytest.fail("it was checked again"))
    again = export(pendulum_ekf, tmp_path, options=OPTIONS, steps=STEPS, cached=True)
    assert (first.from_cache, again.from_cache) == (False, True)
    assert contents(again.folder) == contents(first.folder)
    assert [result.name for result in again.check.results] == [result.name for result in first.check.results]
    assert again.passed


def test_unless_asked_for_nothing_is_taken_from_it(first, tmp_path, monkeypatch):
    monkeypatch.setattr(package, "cross_check", lambda *given, **named: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        export(pendulum_ekf, tmp_path, options=OPTIONS, steps=STEPS)


def test_whatever_could_change_the_answer_is_another_key(monkeypatch):
    text = emit(pendulum_ekf, "float")
    key = cache.key_of(pendulum_ekf, text, OPTIONS, STEPS)
    assert key == cache.key_of(pendulum_ekf, emit(pendulum_ekf, "float"), Options(Precision("float")), STEPS)
    others = [
        cache.key_of(pendulum_ekf, dataclasses.replace(text, source=text.source + " "), OPTIONS, STEPS),
        cache.key_of(pendulum_ekf, text, dataclasses.replace(OPTIONS, contract=True), STEPS),
        cache.key_of(pendulum_ekf, text, dataclasses.replace(OPTIONS, targets=("host", "rv32")), STEPS),
        cache.key_of(pendulum_ekf, text, OPTIONS, STEPS + 1),
    ]
    monkeypatch.setattr(cache, "_sources", lambda: "another plantc")
    others.append(cache.key_of(pendulum_ekf, text, OPTIONS, STEPS))
    monkeypatch.undo()
    monkeypatch.setattr(cache, "TOOLS", ("python3", "sh"))
    others.append(cache.key_of(pendulum_ekf, text, OPTIONS, STEPS))
    assert len({key, *others}) == 7


@pytest.mark.parametrize("damage", ["", "{", "[]", '{"files": {}, "results": [], "statuses": {}, "evidence": {}}'])
def test_an_entry_that_cannot_be_read_is_no_entry(own_cache, damage):
    text = emit(pendulum_ekf, "float")
    cache._place("damaged").write_text(damage)
    assert cache.kept("damaged", pendulum_ekf, text) is None
    assert cache.kept("absent", pendulum_ekf, text) is None


def spoilt(kept, file, old, new):
    """Change a kept file, and the digest of the entry with it."""
    assert old in kept.files[file]
    kept.files[file] = kept.files[file].replace(old, new, 1)


def test_c_that_nobody_checked_is_never_handed_out(first):
    text = emit(pendulum_ekf, "float")
    key = cache.key_of(pendulum_ekf, text, OPTIONS, STEPS)

    def kept():
        answer = cache.kept(key, pendulum_ekf, text)
        assert answer is not None
        return answer

    kept().results[0].passed = False  # a copy: what is kept stays
    damages = [
        lambda whole: spoilt(whole, "src/pendulum_ekf.c", " + ", " - "),
        lambda whole: spoilt(whole, "src/pendulum_ekf.h", "F", "G"),
        lambda whole: spoilt(whole, "CMakeLists.txt", "off", "fast"),
        lambda whole: spoilt(whole, "manifest.json", pendulum_ekf.model_hash(), "00000000"),
        lambda whole: whole.files.pop("test/test_vectors.c"),
        lambda whole: whole.files.update({"src/more.c": "int more;"}),
        lambda whole: setattr(whole.results[0], "passed", False),
    ]
    for damage in damages:
        whole = kept()
        damage(whole)
        cache.keep("spoilt", whole)
        assert cache.kept("spoilt", pendulum_ekf, text) is None
    place = cache._place(key)
    before = place.read_text()
    place.write_text(before.replace('"passed": true', '"passed": true ', 1).replace("evidence", "evidense", 1))
    assert cache.kept(key, pendulum_ekf, text) is None
    place.write_text(before)
    kept()


# -- what tells two exports apart --------------------------------------------------------------------------------------


def gain():
    block = Block("gain")
    u = block.input("u")
    block.entry("step", inputs=[u], outputs={"y": 2 * u})
    return block


def test_everything_that_a_block_is_checked_by_is_in_its_fingerprint():
    def changed(**what):
        block = copy.copy(pendulum_ekf)
        vars(block).update(what)
        return fingerprint(block)

    plain, scenario = changed(), pendulum_ekf.scenario
    assert plain == changed()
    others = [
        changed(float_bound=0.5),
        changed(scenario=None),
        changed(scenario=dataclasses.replace(scenario, gaps="torque")),
        changed(scenario=dataclasses.replace(scenario, scales=None)),
        changed(derivative_checks=[]),
        changed(oracle=None),
    ]
    assert None not in (plain, *others)
    assert len({plain, *others}) == 7


def test_code_of_the_users_own_is_never_kept(monkeypatch):
    class Oracle:
        def call(self, *given):
            raise NotImplementedError

    def calls(rng, steps):
        yield "step", {"u": 0.0}

    text = emit(gain(), "double")
    for name, value in (("oracle", Oracle()), ("scenario", Scenario(calls, lambda rng: {}))):
        block = gain()
        assert cache.key_of(block, text, OPTIONS, STEPS)
        setattr(block, name, value)
        assert cache.key_of(block, text, OPTIONS, STEPS) == ""


def test_another_compiler_behind_the_same_command_is_another_key(tmp_path, monkeypatch):
    text = emit(gain(), "double")
    wrapper = tmp_path / "mycc"
    keys = []
    for version in ("1", "2"):
        wrapper.write_text(f"#!/bin/sh\necho compiler {version}\n")
        wrapper.chmod(0o755)
        os.utime(wrapper, (0, 0))
        monkeypatch.setenv("CC", str(wrapper))
        keys.append(cache.key_of(gain(), text, OPTIONS, STEPS))
    monkeypatch.setattr(cache.importlib.metadata, "version", lambda name: "another")
    keys.append(cache.key_of(gain(), text, OPTIONS, STEPS))
    assert len(set(keys)) == 3


def test_another_c_library_of_a_target_is_another_key(tmp_path, monkeypatch):
    """A cross compiler of the same version that would link another libm."""
    compiler, library = tmp_path / "arm-none-eabi-gcc", tmp_path / "libm.a"
    compiler.write_text(f'#!/bin/sh\ncase "$*" in *verbose) echo attempt to open {library} succeeded;; esac\n')
    compiler.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:{os.environ['PATH']}")
    text, options = emit(gain(), "double"), dataclasses.replace(OPTIONS, targets=("cortex-m4",))
    keys = []
    for content in ("newlib 4.1", "newlib 4.10"):
        library.write_text(content)
        keys.append(cache.key_of(gain(), text, options, STEPS))
    assert keys[0] != keys[1]
