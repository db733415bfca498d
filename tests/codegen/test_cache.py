"""The cache of exports: the same again does no work; whatever could change the answer is another key."""

import dataclasses

import pytest
from plantc.codegen import cache, emit, export, package
from plantc.codegen.options import Options
from plantc.codegen.style import Precision
from plantc.examples.pendulum import pendulum_ekf
from plantc.symbolic import Block

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
    cache._place("damaged").write_text(damage)
    assert cache.kept("damaged") is None
    assert cache.kept("absent") is None


def test_an_entry_that_tells_of_a_failed_check_is_no_entry(first):
    key = cache.key_of(pendulum_ekf, emit(pendulum_ekf, "float"), OPTIONS, STEPS)
    whole = cache.kept(key)
    assert whole is not None
    whole.results[0].passed = False
    cache.keep("failed", whole)
    assert cache.kept("failed") is None


def test_a_block_with_an_oracle_of_the_users_own_is_never_kept():
    class Oracle:
        def call(self, *given):
            raise NotImplementedError

    block = Block("gain")
    u = block.input("u")
    block.entry("step", inputs=[u], outputs={"y": 2 * u})
    assert cache.is_cacheable(block)
    block.oracle = Oracle()
    assert not cache.is_cacheable(block)
    assert cache.is_cacheable(pendulum_ekf)
