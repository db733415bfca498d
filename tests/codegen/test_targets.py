"""Targets: what is told when one is unknown or its tools are missing, sizes, and no soft-float call where there is an FPU."""

import importlib.util
import shutil
import subprocess
from dataclasses import replace

import pytest
from elftools.elf.elffile import ELFFile
from plantc.codegen.emit import emit
from plantc.codegen.targets import (
    TARGETS,
    Sizes,
    TargetError,
    Toolchain,
    find_emulator,
    find_toolchain,
    installed_targets,
    linked_library,
    target_named,
)
from plantc.examples.pendulum import pendulum_ekf
from plantc.examples.quadrotor_ekf import quadrotor_kf

COMPILERS = {"cortex-m4": "arm-none-eabi-gcc", "cortex-m7": "arm-none-eabi-gcc", "rv32": "riscv64-unknown-elf-gcc"}


def test_an_unknown_target_is_told_with_those_there_are():
    with pytest.raises(TargetError, match="no target 'cortex-m5'; take one of host, cortex-m4, cortex-m7, rv32"):
        target_named("cortex-m5")


@pytest.mark.parametrize(("name", "package"), [("cortex-m4", "gcc-arm-none-eabi"), ("rv32", "gcc-riscv64-unknown-elf")])
def test_a_missing_compiler_is_told_with_its_package(name, package, monkeypatch):
    monkeypatch.setattr(shutil, "which", lambda program: None)
    monkeypatch.setattr(importlib.util, "find_spec", lambda module: None)
    with pytest.raises(TargetError, match=f"no compiler for the target {name} .*apt install {package}"):
        find_toolchain(TARGETS[name])


@pytest.mark.parametrize(("name", "package"), [("cortex-m7", "qemu-system-arm"), ("rv32", "qemu-system-misc")])
def test_a_missing_emulator_is_told_with_its_package(name, package, monkeypatch):
    monkeypatch.setattr(shutil, "which", lambda program: None)
    with pytest.raises(TargetError, match=f"no emulator for the target {name} .*apt install {package}$"):
        find_emulator(TARGETS[name])


def test_the_zig_wheel_stands_in_for_a_missing_cross_compiler(monkeypatch, needs):
    needs("python:ziglang")
    monkeypatch.setattr(shutil, "which", lambda program: None)
    assert find_toolchain(TARGETS["cortex-m4"]).kind == "zig"


@pytest.mark.parametrize("name", COMPILERS)
def test_a_missing_c_library_is_told_with_its_package(name, tmp_path, needs):
    needs(COMPILERS[name])
    toolchain = find_toolchain(TARGETS[name], kind="gcc")
    own = subprocess.run([COMPILERS[name], "-print-file-name=include"], capture_output=True, text=True, check=True)
    flags = [item.replace("picolibc", "nowhere") for item in toolchain.target.flags]
    blind = replace(toolchain.target, flags=(*flags, "-nostdinc", "-isystem", own.stdout.strip()))
    with pytest.raises(TargetError, match=f"no C library for the target {name}; install it: apt install gcc-"):
        Toolchain(blind, toolchain.compiler, "gcc").library_object(emit(pendulum_ekf, "float"), tmp_path)


def test_installed_targets_are_those_whose_tools_are_there(monkeypatch, needs):
    needs("gcc", *COMPILERS.values(), "qemu-system-arm", "qemu-system-riscv32")
    assert installed_targets() == tuple(TARGETS)
    which = shutil.which
    monkeypatch.setattr(shutil, "which", lambda program: None if program == "qemu-system-arm" else which(program))
    assert installed_targets() == ("host", "rv32")


def symbols(path):
    """Names an object refers to and does not define."""
    with path.open("rb") as stream:
        table = ELFFile(stream).get_section_by_name(".symtab")
        return {item.name for item in table.iter_symbols() if item["st_shndx"] == "SHN_UNDEF" and item.name}


def soft_float(path):
    return {name for name in symbols(path) if name.startswith(("__aeabi_f", "__aeabi_d", "__addsf", "__mulsf"))}


@pytest.mark.parametrize("name", COMPILERS)
def test_float_code_calls_no_soft_float_function(name, tmp_path, needs):
    needs(COMPILERS[name])
    made = find_toolchain(TARGETS[name], kind="gcc").library_object(emit(quadrotor_kf, "float"), tmp_path)
    assert symbols(made) <= {"memcpy", "memset", "sqrtf"}


@pytest.mark.slow
def test_zig_uses_the_fpu_and_the_check_would_see_if_it_did_not(tmp_path, needs):
    needs("python:ziglang")
    toolchain = find_toolchain(TARGETS["cortex-m4"], kind="zig")
    text = emit(quadrotor_kf, "float")
    assert not soft_float(toolchain.library_object(text, tmp_path))
    trap = replace(toolchain.target, zig_flags=("-target", "thumb-freestanding-eabihf", "-mcpu=cortex_m4"))
    assert "__aeabi_fmul" in soft_float(Toolchain(trap, toolchain.compiler, "zig").library_object(text, tmp_path))


@pytest.mark.parametrize("name", COMPILERS)
def test_sizes_are_those_of_the_toolchains_own_tool(name, tmp_path, needs):
    size = TARGETS[name].prefix + "size"
    needs(COMPILERS[name], size)
    made = find_toolchain(TARGETS[name], kind="gcc").library_object(emit(quadrotor_kf, "double"), tmp_path)
    said = subprocess.run([size, str(made)], capture_output=True, text=True, check=True).stdout.split("\n")[1].split()
    ours = Sizes.of(made)
    assert (ours.text, ours.data, ours.bss) == tuple(map(int, said[:3]))


def test_a_file_that_is_no_elf_has_no_sizes(tmp_path):
    path = tmp_path / "object.o"
    path.write_bytes(b"\xcf\xfa\xed\xfe")
    assert Sizes.of(path) is None


def test_what_a_library_calls_counts_too(tmp_path, needs):
    """Double on a Cortex-M4 is computed by the compiler's own functions: they need flash as well."""
    needs(COMPILERS["cortex-m4"])
    toolchain = find_toolchain(TARGETS["cortex-m4"], kind="gcc")
    entries = list(quadrotor_kf.entries)
    alone = Sizes.of(toolchain.library_object(emit(quadrotor_kf, "double"), tmp_path))
    linked = Sizes.of(linked_library(toolchain, emit(quadrotor_kf, "double"), entries, tmp_path))
    assert linked.text > alone.text + 1000
    single = Sizes.of(linked_library(toolchain, emit(quadrotor_kf, "float"), entries, tmp_path))
    assert single.text < linked.text
    assert single.data == single.bss == 0
