"""An exported folder as others build it: by CMake and pkg-config, as a PlatformIO, Arduino and Zephyr package."""

import re
import subprocess

import pytest
from plantc.codegen import package
from plantc.codegen.compiler import WARNINGS
from plantc.codegen.folder import write_files
from plantc.codegen.package import build_files, export
from plantc.symbolic import Block

# -- blocks that lack something ---------------------------------------------------------------------------------------

LACKING = {
    "gain": "memory",
    "plain_gain": "memory parameter",
    "source": "memory input",
    "sink": "output",
    "ticker": "parameter input output",
    "nothing": "memory parameter input output",
}


def bare(name):
    """A block without what `LACKING` says."""
    without = LACKING[name].split()
    block = Block(name, doc="a block that lacks something")
    raw = block.input("raw", unit="V", range=(-10, 10)) if "input" not in without else None
    weight = block.parameter("weight", 0.1, range=(0, 1)) if "parameter" not in without else 0.5
    smooth = block.memory("smooth", initial=0.0, unit="V", range=(-10, 10)) if "memory" not in without else 0.0
    value = weight * (1.0 if raw is None else raw) + 0.5 * smooth
    following = {smooth: value} if "memory" not in without else {}
    outputs = {"level": value} if "output" not in without else {}
    block.entry("step", inputs=[] if raw is None else [raw], following=following, outputs=outputs)
    return block


@pytest.mark.parametrize("precision", ["double", "float"])
@pytest.mark.parametrize("name", LACKING)
def test_a_block_that_lacks_something_is_exported_and_its_vectors_can_fail(name, precision, tmp_path):
    done = export(bare(name), tmp_path, precision=precision, steps=20)
    assert done.passed
    files = dict(done.files)
    result = package.run_vectors(name, files)
    assert result.passed
    assert result.calls > 0
    files[f"src/{name}.c"] = files[f"src/{name}.c"].replace(done.block.model_hash() + '"', '00000000"')
    assert not package.run_vectors(name, files).passed
    if "output" not in LACKING[name]:
        half = "0.5f" if precision == "float" else "0.5"
        broken = dict(done.files)
        source = broken[f"src/{name}.c"]
        changed = re.sub(r"level = (.*);", rf"level = {half} + (\1);", source)
        assert changed != source
        broken[f"src/{name}.c"] = changed
        assert "differ" in package.run_vectors(name, broken).note


@pytest.mark.parametrize("compiler", ["gcc", "clang"])
@pytest.mark.parametrize("precision", ["double", "float"])
def test_every_c_file_of_such_a_block_compiles_without_a_warning(compiler, precision, tmp_path, needs):
    needs(compiler)
    for name in LACKING:
        folder = tmp_path / name
        write_files(folder, build_files(bare(name), precision))
        files = [str(path) for path in sorted(folder.rglob("*.c"))]
        assert len(files) == 4
        command = [compiler, "-std=c99", "-O2", *WARNINGS, f"-I{folder / 'src'}", "-fsyntax-only", *files]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
