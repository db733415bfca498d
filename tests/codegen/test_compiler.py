"""Which compiler is taken, and what is said when there is none."""

import importlib.util
import os
import sys

import pytest
from plantc.codegen import compiler
from plantc.codegen.compiler import CompilerError, contraction_flag, find_compiler, library_for


@pytest.fixture
def bare(monkeypatch, tmp_path):
    """A PATH with nothing on it."""
    monkeypatch.delenv("CC", raising=False)
    monkeypatch.setenv("PATH", str(tmp_path))
    return tmp_path


def program(folder, name):
    path = folder / name
    path.write_text("#!/bin/sh\nexit 0\n")
    path.chmod(0o755)
    return path


def test_the_order_is_cc_gcc_clang_zig(bare, monkeypatch):
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: object() if name == "ziglang" else None)
    assert find_compiler().label == "zig"
    program(bare, "clang")
    assert find_compiler().label == "clang"
    program(bare, "gcc")
    assert find_compiler().label == "gcc"
    program(bare, "mine")
    monkeypatch.setenv("CC", "mine -m32")
    assert find_compiler().command == ("mine", "-m32")


def test_zig_is_taken_where_its_wheel_is_installed(bare, monkeypatch):
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: object() if name == "ziglang" else None)
    assert find_compiler().command == (sys.executable, "-m", "ziglang", "cc")


def test_none_at_all_is_a_sentence_that_says_what_to_install(bare, monkeypatch):
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    with pytest.raises(CompilerError, match=r"install gcc or clang.*pip install 'plantc\[compiler\]'"):
        find_compiler()


def test_a_wrong_cc_is_named(bare, monkeypatch):
    monkeypatch.setenv("CC", "no-such-compiler")
    with pytest.raises(CompilerError, match=r"\$CC is 'no-such-compiler', which is not a program"):
        find_compiler()


def test_contraction_is_always_stated(monkeypatch):
    assert contraction_flag(False) == "-ffp-contract=off"
    assert contraction_flag(True) == "-ffp-contract=fast"
    called = []
    monkeypatch.setattr(compiler.Compiler, "run", lambda self, arguments, folder: called.append(list(arguments)))
    made = compiler.Compiler(("gcc",), "gcc")
    made.shared_library([compiler.Path("a.c")], compiler.Path("a.so"))
    made.program([compiler.Path("a.c")], compiler.Path("a"), contract=True)
    assert "-ffp-contract=off" in called[0]
    assert "-ffp-contract=fast" in called[1]


def test_what_the_compiler_says_is_passed_on():
    with pytest.raises(CompilerError, match="refused the generated C"):
        library_for({"broken.c": "int f( { return 0; }\n"})


def test_a_library_is_compiled_once(monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    text = {"once.c": "int once(void);\nint once(void) { return 41; }\n"}
    first = library_for(text)
    stamp = os.stat(first).st_mtime_ns
    assert library_for(text) == first
    assert os.stat(first).st_mtime_ns == stamp
    assert library_for(text, contract=True) != first
