"""The text of the C: deterministic, narrow, warnings-clean, float to the last operation."""

import os
import re
import subprocess
import sys

import pytest
from plantc.codegen.compiler import BASE_FLAGS, WARNINGS
from plantc.codegen.emit import emit
from plantc.examples.attitude_ekf import attitude_ekf
from plantc.examples.pendulum import pendulum_ekf
from plantc.examples.quadrotor_ekf import quadrotor_ekf, quadrotor_kf
from plantc.symbolic import if_else

from plantc import Block, connect

BLOCKS = {block.name: block for block in (pendulum_ekf, attitude_ekf, quadrotor_ekf, quadrotor_kf)}
PRECISIONS = ("double", "float")


@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("name", BLOCKS)
def test_lines_are_narrow_and_names_carry_the_prefix(name, precision):
    text = emit(BLOCKS[name], precision)
    for line in (text.header + text.source).split("\n"):
        assert len(line) <= 120, line
        assert line == line.rstrip()
    functions = re.findall(r"^(?:static )?[a-z_0-9]+_t (\w+)\(|^static \w+ (\w+)\(", text.source, re.MULTILINE)
    assert functions
    assert all((first or second).startswith(f"{name}_") for first, second in functions)


@pytest.mark.parametrize("name", BLOCKS)
def test_float_text_holds_no_double(name):
    source = re.sub(r"/\*.*?\*/", "", emit(BLOCKS[name], "float").source, flags=re.DOTALL)
    assert "double" not in source
    numbers = re.findall(r"(?<![\w.])\d+\.\d+(?:e-?\d+)?(\w?)", source)
    assert numbers
    assert set(numbers) == {"f"}
    assert not re.findall(r"\b(?:sin|cos|sqrt|floor|fabs|tan|atan2|exp|log|pow)\(", source)


def test_the_same_model_gives_the_same_bytes_in_any_process(tmp_path):
    script = (
        "import hashlib, sys\n"
        "from plantc.codegen.emit import emit\n"
        "from plantc.examples.attitude_ekf import attitude_ekf\n"
        "from plantc.examples.quadrotor_ekf import quadrotor_ekf\n"
        "if sys.argv[1] == '2':\n"
        "    import casadi; junk = [casadi.SX.sym('junk') * k for k in range(1000)]\n"
        "for block in (attitude_ekf, quadrotor_ekf) if sys.argv[1] != '3' else (quadrotor_ekf, attitude_ekf):\n"
        "    text = emit(block, 'float')\n"
        "    print(block.name, hashlib.sha256((text.header + text.source).encode()).hexdigest())\n"
    )
    answers = []
    for seed in ("0", "1", "2", "3"):
        folder = tmp_path / f"somewhere {seed}"
        folder.mkdir()
        environment = {**os.environ, "PYTHONHASHSEED": seed}
        done = subprocess.run(
            [sys.executable, "-c", script, seed],
            capture_output=True,
            text=True,
            check=True,
            cwd=folder,
            env=environment,
        )
        answers.append(sorted(done.stdout.split("\n")))
    assert answers[0] == answers[1] == answers[2] == answers[3]


def test_the_text_names_no_path_user_or_time():
    text = emit(pendulum_ekf)
    everything = text.header + text.source
    assert os.path.expanduser("~") not in everything
    assert not re.search(r"\b20\d\d-\d\d", everything)


@pytest.mark.parametrize("compiler", ["gcc", "clang"])
@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("name", ["pendulum_ekf", "attitude_ekf"])
def test_it_compiles_without_a_warning_as_c_and_the_header_as_cpp(name, precision, compiler, tmp_path, needs):
    needs(compiler, "g++")
    text = emit(BLOCKS[name], precision)
    (tmp_path / f"{name}.h").write_text(text.header)
    (tmp_path / f"{name}.c").write_text(text.source)
    flags = [*BASE_FLAGS, *WARNINGS, "-ffp-contract=off", "-Wstrict-prototypes", "-Wmissing-prototypes", "-c"]
    done = subprocess.run([compiler, *flags, f"{name}.c"], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    (tmp_path / "header.cpp").write_text(
        f'#include "{name}.h"\nint main() {{ {name}_state_t s; (void)s; return 0; }}\n'
    )
    cpp = ["-x", "c++", "-std=c++11", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-fsyntax-only", "header.cpp"]
    done = subprocess.run(
        [compiler if compiler == "clang" else "g++", *cpp], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr


def test_the_quadrotor_step_has_twelve_divisions():
    operations = emit(quadrotor_ekf).operations
    assert operations["update_pose"]["division"] == 12
    assert operations["predict"].get("division", 0) == 0


def test_every_gain_of_a_row_shares_one_division():
    """With one division for each gain, as CasADi prints them, there would be 144."""
    source = re.sub(r"/\*.*?\*/", "", emit(quadrotor_ekf).source, flags=re.DOTALL)
    calls = source.count("quadrotor_ekf_gain(") - 1
    body = source[source.index("static void quadrotor_ekf_gain(") :]
    assert calls * body[: body.index("\n}\n")].count(" / ") == 12


def test_a_composition_has_no_type_that_nothing_uses():
    """Cores of parts take single arguments, and only `step` of a part can be called."""
    text = emit(connect({"a": pendulum_ekf, "b": pendulum_ekf, "c": quadrotor_kf}, {}, "three"))
    types = re.findall(r"^(?:} |typedef \w+ )(three_\w+_t);", text.header, re.MULTILINE)
    assert {"three_step_in_t", "three_a_update_encoder_out_t", "three_b_step_out_t"} <= set(types)
    assert not [name for name in types if name.startswith(("three_a_", "three_b_", "three_c_")) and "_in_t" in name]
    for name in set(types) - {"three_step_in_t", "three_step_out_t"}:
        assert len(re.findall(rf"\b{name}\b", text.header + text.source)) > 1, name


def test_what_a_branch_gives_is_no_plain_arithmetic():
    """cppcheck drops the parentheses around it, and then misses them."""
    block = Block("mixer")
    u, v = block.input("u", range=(-1, 1)), block.input("v", range=(-1, 1))
    block.entry("step", inputs=[u, v], outputs={"y": 1 + if_else(u > 0, u * v, v)})
    source = emit(block, "float").source
    assert re.search(r"const float (\w+) = u \* v;\n +out->y = .*\? \1 : ", source), source
    assert not re.search(r"\? \([\w.]+ [-+*/] [\w.]+\) :", source)
