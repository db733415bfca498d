"""What is read of object files, compared with binutils; and files that are none."""

import re
import subprocess

import pytest
from plantc.codegen.emit import emit
from plantc.codegen.objects import Image, ObjectError, read_image
from plantc.codegen.targets import TARGETS, find_toolchain
from plantc.examples.attitude_ekf import attitude_ekf

BINUTILS = {"host": "", "cortex-m4": "arm-none-eabi-", "cortex-m7": "arm-none-eabi-", "rv32": "riscv64-unknown-elf-"}


@pytest.fixture(params=BINUTILS)
def compiled(request, tmp_path, needs):
    prefix = BINUTILS[request.param]
    needs(f"{prefix}gcc", f"{prefix}nm", f"{prefix}size", f"{prefix}objdump")
    return find_toolchain(TARGETS[request.param]).library_object(emit(attitude_ekf, "float"), tmp_path), prefix


def said(tool, *arguments):
    return subprocess.run([tool, *map(str, arguments)], capture_output=True, text=True, check=True).stdout


def test_symbols_and_sizes_are_those_of_nm_and_size(compiled):
    path, prefix = compiled
    image = read_image(path)
    undefined = {line.split()[-1] for line in said(f"{prefix}nm", "-u", path).split("\n") if line.strip()}
    assert set(image.undefined) == undefined - {"_GLOBAL_OFFSET_TABLE_"}
    rows = [line.split() for line in said(f"{prefix}nm", path).split("\n")]
    functions = {row[2]: row[1] for row in rows if len(row) == 3 and row[1] in "tT" and not re.match(r"[.$]", row[2])}
    assert {item.name: "T" if item.is_global else "t" for item in image.functions.values()} == functions
    sizes = said(f"{prefix}size", path).split("\n")[1].split()
    assert [str(item) for item in (image.sizes.text, image.sizes.data, image.sizes.bss)] == sizes[:3]


def test_every_instruction_is_where_objdump_has_one(compiled):
    path, prefix = compiled
    ours = [item.size for item in read_image(path).instructions()]
    theirs = [
        line
        for line in said(f"{prefix}objdump", "-d", "-w", path).split("\n")
        if re.match(r" +[0-9a-f]+:\t", line) and not re.search(r"\t\.(word|short|byte|2byte|4byte)", line)
    ]
    assert len(ours) == len(theirs)


def test_the_call_graph_is_that_of_the_relocations(compiled):
    graph = read_image(compiled[0]).calls()
    assert graph["attitude_ekf_predict"] >= {"attitude_ekf_predict_core"}
    assert graph["attitude_ekf_model"] == set()
    assert not any(None in callees for callees in graph.values())
    assert "attitude_ekf_hold_variances" in set().union(*graph.values())


def test_what_is_no_object_is_told():
    with pytest.raises(ObjectError, match="x.o is not an ELF file; objects of other formats are not looked into"):
        Image(b"MZ" + bytes(100), "x.o")


def test_lines_are_those_of_the_c(tmp_path, needs):
    needs("arm-none-eabi-gcc")
    text = emit(attitude_ekf, "float")
    toolchain = find_toolchain(TARGETS["cortex-m4"])
    from plantc.codegen.targets import linked_library

    image = read_image(linked_library(toolchain, text, list(attitude_ekf.entries), tmp_path))
    function = image.function_named("attitude_ekf_step")
    name, line = image.line_of(function.address)
    assert name == "attitude_ekf.c"
    assert "attitude_ekf_step(" in "\n".join(text.source.split("\n")[line - 4 : line])
