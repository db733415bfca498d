"""The command line, as people and scripts meet it."""

import json
import os
import re
import subprocess
import sys

import pytest
from plantc.codegen.folder import FolderError
from plantc.codegen.package import with_design

from plantc.models import blocks_of

PENDULUM = """\
from plantc import Plant, extended_kalman_filter, trim
from plantc.symbolic import sin

pendulum = Plant("pendulum")
theta = pendulum.state("theta", unit="rad", angle=True)
omega = pendulum.state("omega", unit="rad/s", range=(-100, 100))
torque = pendulum.input("torque", unit="N m", range=(-10, 10))
draught = pendulum.noise("draught", density=1e-3, unit="N m")
pendulum.dynamics({theta: omega, omega: (torque + draught - 0.981 * sin(theta)) / 0.05})
pendulum.sensor("encoder", theta, variance=1e-4, unit="rad", angle=True)
sampled = pendulum.discretise("euler", dt=(1e-5, 0.1))
pendulum_ekf = extended_kalman_filter(sampled, initial_variance={theta: 1.0, omega: 1.0})
aside = {theta: 0.5, torque: 0.25}
by_trim = trim(pendulum, hold={theta: 0.5})
"""

LOW_PASS = """\
from plantc import Block

low_pass = Block("low_pass", doc="first-order low-pass filter")
raw = low_pass.input("raw", unit="V", range=(-10, 10))
weight = low_pass.parameter("weight", 0.1, range=(0, 1))
smooth = low_pass.memory("smooth", unit="V", range=(-10, 10))
following = smooth + weight * (raw - smooth)
low_pass.entry("step", inputs=[raw], following={smooth: following}, outputs={"filtered": following})
"""

CART = """\
from plantc import Plant, steady_state_kalman_filter

cart = Plant("cart")
position, speed = cart.state("position"), cart.state("speed")
push = cart.input("push", range=(-10, 10))
cart.dynamics({position: speed, speed: push + cart.noise("gust", density=0.01)})
cart.sensor("gps", position, variance=4.0)
cart_sskf = steady_state_kalman_filter(cart.discretise("exact", dt=0.1))
"""

FAST = ("--steps", 20)
"""Short traces."""
ANEW = ("--no-cache",)
"""A fault planted in this process is none of what the cache looks at."""


@pytest.fixture
def model(tmp_path, monkeypatch):
    """Write a model into the empty current folder and return its name."""
    monkeypatch.chdir(tmp_path)

    def write(text, name="model.py"):
        (tmp_path / name).write_text(text)
        return name

    return write


def one_object(said):
    """The one JSON object on standard output, which agrees with status and summary."""
    answer = json.loads(said.out)  # fails if anything else is there
    assert answer["status"] == said.status
    assert answer["summary"].splitlines()[-1] == said.summary
    return answer


def fails(said, status, *words):
    """A failure told in a sentence, without a traceback."""
    assert said.status == status, said.err
    assert "Traceback" not in said.err
    for word in words:
        assert word in said.err, said.err


# -- as a program -----------------------------------------------------------------------------------------------------


def program(*arguments, **options):
    command = [sys.executable, "-m", "plantc", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False, **options)


def test_as_a_program_streams_and_status(model):
    done = program("derive", model(PENDULUM + "print('I talk')\n"), "--dt", 0.01, "--json")
    assert done.returncode == 0
    assert json.loads(done.stdout)["plants"][0]["plant"] == "pendulum"
    assert done.stderr.splitlines()[0] == "I talk"
    assert "\x1b" not in done.stderr  # no colours, no progress bar
    assert done.stderr.splitlines()[-1] == "model.py: 2 plant(s) derived"


TALKATIVE = """
import ctypes, os, subprocess
print("by Python")
os.write(1, b"by descriptor\\n")
subprocess.run(["echo", "by a program"], check=True)
ctypes.CDLL(None).printf(b"by C\\n")
"""


def test_whatever_a_model_writes_the_output_is_one_object(model):
    done = program("derive", model(PENDULUM + TALKATIVE), "--dt", 0.01, "--json")
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["status"] == 0
    for way in ("by Python", "by descriptor", "by a program", "by C"):
        assert way in done.stderr


@pytest.mark.parametrize("raised", ["Own('boo')", "SystemExit(0)", "GeneratorExit('boo')"])
def test_whatever_a_model_raises_is_a_sentence(raised, model, plantc):
    text = f"class Own(BaseException):\n    pass\n\nraise {raised}\n"
    said = plantc("export", model(text), "--json")
    fails(said, 2, "model.py, line 4: ", raised.split("(")[0])
    assert one_object(said)


@pytest.mark.parametrize("raised", ["SystemExit(0)", "GeneratorExit()"])
def test_whatever_is_raised_while_a_model_is_worked_on_is_a_sentence(raised, model, plantc):
    call = f"def call(*given):\n    raise {raised}\n\nlow_pass.oracle = type('Own', (), {{'call': call}})()\n"
    said = plantc("export", model(LOW_PASS + call), *FAST, "--json")
    fails(said, 2, raised.split("(")[0])
    assert one_object(said)


def test_as_a_program_a_mistake(model):
    done = program("derive", "nowhere.py", "--json")
    assert done.returncode == 2
    assert json.loads(done.stdout)["error"] in done.stderr
    assert "Traceback" not in done.stderr


# -- wrong command lines ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "arguments",
    [
        ("derive",),
        ("derive", "--nonsense", "a.py"),
        ("nonsense",),
        ("export", "a.py", "--steps", "2"),
        ("export", "a.py", "--precision", "half"),
        ("check", "folder"),
    ],
)
def test_a_wrong_command_line_is_told_as_json_too(plantc, arguments):
    fails(plantc(*arguments), 2, "error:")
    assert one_object(plantc(*arguments, "--json"))["error"]


@pytest.mark.parametrize("arguments", [(), ("--help",), ("-h",), ("export", "--help"), ("--version",)])
def test_help_is_no_failure(plantc, arguments):
    said = plantc(*arguments)
    assert said.status == 0
    assert "plantc" in said.out


# -- models that are not ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("x = 1\nfrom plantc import Plant\n\nPlant('p').noise('w')\n", ("model.py, line 4", "'w'", "density")),
        ("x = 1\ny = x / 0\n", ("model.py, line 2", "ZeroDivisionError")),
        ("x = 1\nif x\n", ("model.py, line 2", "SyntaxError")),
        ("import no_such_module\n", ("model.py, line 1", "ModuleNotFoundError")),
        ("import sys\nsys.exit(0)\n", ("model.py, line 2", "SystemExit")),
        ("x = 1\n", ("model.py", "no block at its top level")),
        ("", ("model.py", "no block at its top level")),
    ],
)
def test_a_model_with_a_mistake_is_told_with_file_and_line(model, plantc, text, words):
    name = model(text)
    fails(plantc("export", name), 2, *words)
    said = plantc("export", name, "--json")
    assert one_object(said)["status"] == 2
    assert not os.path.exists("generated_c")


def test_the_line_is_that_of_the_model_where_plantc_has_a_file_of_the_same_name(model, plantc):
    text = "from plantc import Plant\np = Plant('p')\np.noise('w', density=-1)\n"
    fails(plantc("derive", model(text, "plant.py")), 2, "plant.py, line 3:")


@pytest.mark.parametrize("command", ["derive", "export"])
@pytest.mark.parametrize("name", ["nowhere.py", "nowhere.py:x", "nowhere", ".", "folder/nowhere.py"])
def test_no_such_file(model, plantc, command, name):
    model(PENDULUM)
    fails(plantc(command, name), 2, "there is no such file")


def test_an_unknown_name_lists_the_known_ones(model, plantc):
    name = model(PENDULUM)
    fails(plantc("export", f"{name}:ekf"), 2, "'ekf'", "pendulum_ekf")
    fails(plantc("export", f"{name}:pendulum"), 2, "'pendulum' is not a block")
    fails(plantc("derive", f"{name}:pendulum_ekf"), 2, "is not a plant", "sampled")


def test_a_file_without_plants(model, plantc):
    fails(plantc("derive", model(LOW_PASS)), 2, "there is no plant at its top level")


def test_debug_adds_a_traceback_and_nothing_else(model, plantc):
    said = plantc("derive", model("x = 1 / 0\n"), "--debug", "--json")
    assert one_object(said)["status"] == 2
    assert "Traceback" in said.err


def test_what_goes_wrong_inside_is_a_sentence(model, plantc, monkeypatch):
    import plantc.__main__ as command_line

    def broken(*_):
        raise RuntimeError("of no importance")

    monkeypatch.setattr(command_line, "_derived", broken)
    name = model(PENDULUM)
    fails(plantc("derive", name), 2, "plantc itself failed", "RuntimeError: of no importance", "--debug")


def test_an_interruption_is_not_a_traceback(model, plantc, monkeypatch):
    import plantc.__main__ as command_line

    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(command_line, "_derived", interrupted)
    said = plantc("derive", model(PENDULUM), "--json")
    fails(said, 2, "interrupted")
    assert one_object(said)


# -- derive -----------------------------------------------------------------------------------------------------------


def derived(plantc, name, *arguments):
    said = plantc("derive", f"{name}:pendulum", *arguments, "--json")
    assert said.status == 0, said.err
    return one_object(said)["plants"][0]


def test_derive_at_the_origin(model, plantc):
    made = derived(plantc, model(PENDULUM))
    assert made["A"] == [[0.0, 1.0], [pytest.approx(-0.981 / 0.05), 0.0]]
    assert made["B"] == [[0.0], [pytest.approx(20.0)]]
    assert made["C"] == [[1.0, 0.0]]
    assert (made["controllability_rank"], made["observability_rank"]) == (2, 2)
    assert made["states"] == ["theta", "omega"]
    assert not made["discrete"]


@pytest.mark.parametrize(
    "point", ["aside", "by_trim", "theta=0.5", "theta=0.5,torque=0.25", " theta = 5e-1 , torque=0"]
)
def test_derive_at_a_point(model, plantc, point):
    import math

    made = derived(plantc, model(PENDULUM), "--at", point)
    assert made["at"]["theta"] == 0.5
    assert made["A"][1][0] == pytest.approx(-0.981 / 0.05 * math.cos(0.5))


@pytest.mark.parametrize(
    ("point", "words"),
    [
        ("nowhere", ("nowhere", "no operating point of that name")),
        ("theta", ("no operating point",)),
        ("phi=1", ("'phi'", "omega, theta, torque")),
        ("theta=much", ("'much' is not a number",)),
        ("theta=", ("is not a number",)),
        ("theta=1,", ("''",)),
        ("torque=11", ("torque", "range")),
        ("theta=nan", ("theta",)),
        ("omega=inf", ("omega",)),
    ],
)
def test_derive_at_no_point(model, plantc, point, words):
    fails(plantc("derive", f"{model(PENDULUM)}:pendulum", "--at", point), 2, *words)


def test_derive_of_a_plant_with_dt_as_an_input_needs_dt(model, plantc):
    name = f"{model(PENDULUM)}:sampled"
    fails(plantc("derive", name), 2, "--dt", "1e-05 .. 0.1", "model.py:sampled")
    said = plantc("derive", name, "--dt", 0.01, "--json")
    made = one_object(said)["plants"][0]
    assert made["discrete"]
    assert made["A"][0] == [1.0, 0.01]
    fails(plantc("derive", name, "--dt", 1.0), 2, "dt")
    fails(plantc("derive", "model.py:pendulum", "--dt", 0.01), 2, "--dt", "leave it out")


# -- export -----------------------------------------------------------------------------------------------------------


def contents(folder):
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


FILES = {
    "CMakeLists.txt",
    "cmake/low_pass.pc.in",
    "cmake/low_passConfig.cmake.in",
    "evidence.json",
    "examples/example_main.c",
    "examples/low_pass/low_pass.ino",
    "library.json",
    "library.properties",
    "verify/fuzz_main.c",
    "manifest.json",
    "report.html",
    "src/low_pass.c",
    "src/low_pass.h",
    "test/test_vectors.c",
    "trace.json",
    "zephyr/CMakeLists.txt",
    "zephyr/Kconfig",
    "zephyr/module.yml",
}


def test_export_writes_a_folder_and_says_so(model, plantc, tmp_path):
    said = plantc("export", model(LOW_PASS), *FAST, "--json")
    assert said.status == 0, said.err
    answer = one_object(said)
    assert re.fullmatch(r"exported, no check failed, 1 of \d+ could not judge: generated_c/low_pass", said.summary)
    assert set(contents(tmp_path / "generated_c/low_pass")) == FILES
    assert {path.name for path in (tmp_path / "generated_c").iterdir()} == {"low_pass"}  # nothing temporary is left
    (block,) = answer["blocks"]
    assert block["folder"] == "generated_c/low_pass"
    assert block["passed"] is True
    unjudged = [check["name"] for check in block["checks"] if not check["passed"]]
    assert unjudged == ["independent reference"]
    assert json.loads((tmp_path / "generated_c/low_pass/evidence.json").read_text()).items() <= block.items()


def test_export_says_that_there_is_no_independent_reference(model, plantc):
    said = plantc("export", model(LOW_PASS), *FAST)
    assert "--   independent reference" in said.err
    assert "not judged: the block brings no independent reference" in said.err
    assert "\x1b" not in said.err


@pytest.mark.slow
def test_export_of_a_filter_in_float(model, plantc, tmp_path):
    said = plantc("export", f"{model(PENDULUM)}:pendulum_ekf", *FAST, "--precision", "float", "--out", "deep/down")
    assert said.status == 0, said.err
    assert json.loads((tmp_path / "deep/down/pendulum_ekf/manifest.json").read_text())["precision"] == "float"
    assert "double" not in re.sub(
        r"/\*.*?\*/", "", (tmp_path / "deep/down/pendulum_ekf/src/pendulum_ekf.c").read_text(), flags=re.S
    )


def test_export_twice_gives_the_same_bytes_and_leaves_other_files(model, plantc, tmp_path):
    name, folder = model(LOW_PASS), tmp_path / "generated_c/low_pass"
    assert plantc("export", name, *FAST).status == 0
    (folder / "notes.txt").write_text("mine")
    before = contents(folder)
    assert plantc("export", name, *FAST).status == 0
    assert contents(folder) == before


@pytest.mark.parametrize("out", ["a file", "a file/below"])
def test_export_to_where_it_cannot_write(model, plantc, tmp_path, out):
    (tmp_path / "a file").write_text("mine")
    said = plantc("export", model(LOW_PASS), *FAST, "--out", out, "--json")
    fails(said, 2, "a file")
    assert "itself failed" not in said.err
    assert one_object(said)
    assert (tmp_path / "a file").read_text() == "mine"


def test_export_where_a_file_has_the_name_of_the_folder(model, plantc, tmp_path):
    (tmp_path / "generated_c").mkdir()
    (tmp_path / "generated_c/low_pass").write_text("mine")
    said = plantc("export", model(LOW_PASS), *FAST)
    fails(said, 2, "low_pass")
    assert "itself failed" not in said.err


def test_export_to_a_folder_with_an_odd_name(model, plantc, tmp_path):
    odd = "sp ace é [bold] :x: %s"
    said = plantc("export", model(LOW_PASS), *FAST, "--out", odd)
    assert said.status == 0, said.err
    assert (tmp_path / odd / "low_pass/src/low_pass.c").is_file()
    assert said.summary.endswith(f"{odd}/low_pass")


def test_export_to_a_folder_that_cannot_be_made(model, plantc, tmp_path):
    (tmp_path / "locked").write_text("a file, not a folder")
    fails(plantc("export", model(LOW_PASS), *FAST, "--out", "locked/inside"), 2, "locked")


def test_without_a_compiler_it_says_what_to_install(model, plantc, monkeypatch):
    monkeypatch.setenv("CC", "no-such-compiler")
    fails(plantc("export", model(LOW_PASS), *FAST), 2, "$CC", "no-such-compiler")


def test_an_fmu_of_a_block_without_a_step_is_refused_before_the_work(model, plantc, tmp_path):
    path = model(LOW_PASS.replace('entry("step"', 'entry("filter"'))
    fails(plantc("export", path, "--fmu", *FAST), 2, "--fmu", "low_pass has no entry step", "filter", "add one")
    assert not (tmp_path / "generated_c").exists()


def test_an_fmu_without_fmpy_says_what_to_install(model, plantc, tmp_path, monkeypatch):
    from plantc.codegen import fmu

    monkeypatch.setattr(fmu.importlib.util, "find_spec", lambda name: None)
    fails(plantc("export", model(LOW_PASS), "--fmu", *FAST), 2, "fmpy", "pip install 'plantc[fmu]'")
    assert not (tmp_path / "generated_c").exists()


def plant_a_fault(monkeypatch):
    """From now on the C of the low-pass weighs a little wrong."""
    from dataclasses import replace

    from plantc.codegen import package
    from plantc.codegen.crosscheck import make_views
    from plantc.codegen.emit import emit
    from plantc.codegen.views import NativeView

    def with_fault(block, precision, native=None):
        text = emit(block, precision)
        wrong = text.source.replace("(raw - smooth)", "(1.0000001 * (raw - smooth))")
        assert wrong != text.source
        return make_views(block, precision, NativeView(block, precision, text=replace(text, source=wrong)))

    monkeypatch.setattr(package, "make_views", with_fault)


def test_a_failing_check_writes_nothing_and_leaves_what_was_there(model, plantc, tmp_path, monkeypatch):
    name, folder = model(LOW_PASS), tmp_path / "generated_c/low_pass"
    assert plantc("export", name, *FAST).status == 0
    before = contents(folder)
    plant_a_fault(monkeypatch)
    said = plantc("export", name, *FAST, *ANEW, "--json")
    fails(said, 1, "failed: low_pass", "native = interpret", "entry step", "step 1,")
    answer = one_object(said)
    assert any(not check["passed"] and check["mismatch"] for check in answer["checks"])
    assert contents(folder) == before
    assert {path.name for path in (tmp_path / "generated_c").iterdir()} == {"low_pass"}


def test_a_failing_check_does_not_even_make_the_folder(model, plantc, tmp_path, monkeypatch):
    name = model(LOW_PASS)
    plant_a_fault(monkeypatch)
    fails(plantc("export", name, *FAST, *ANEW), 1)
    assert not (tmp_path / "generated_c").exists()


# -- check ------------------------------------------------------------------------------------------------------------


@pytest.fixture
def exported(model, plantc, tmp_path):
    """A model, and the folder that was exported from it."""
    name = model(LOW_PASS)
    said = plantc("export", name, *FAST)
    assert said.status == 0, said.err
    return name, tmp_path / "generated_c/low_pass"


def checked(plantc, exported):
    return plantc("check", exported[1], "--model", exported[0], *FAST, "--json")


def test_check_of_what_was_just_exported(exported, plantc):
    before = contents(exported[1])
    said = checked(plantc, exported)
    assert said.status == 0, said.err
    answer = one_object(said)
    assert answer["changed"] == answer["missing"] == []
    assert "as the model gives it, no check failed, 1 of 6 could not judge" in said.summary
    assert contents(exported[1]) == before


@pytest.mark.parametrize("file", sorted(FILES - {"evidence.json", "report.html"}))
def test_check_finds_a_changed_file(exported, plantc, file):
    path = exported[1] / file
    path.write_text(path.read_text() + "\n")
    said = checked(plantc, exported)
    fails(said, 1, file, "export again")
    assert one_object(said)["changed"] == [file]


@pytest.mark.parametrize("file", ["src/low_pass.c", "src/low_pass.h", "test/test_vectors.c", "CMakeLists.txt"])
def test_check_finds_a_missing_file(exported, plantc, file):
    (exported[1] / file).unlink()
    said = checked(plantc, exported)
    fails(said, 1, f"{file} is missing")
    assert one_object(said)["missing"] == [file]


def test_check_runs_the_c_that_lies_there(exported, plantc):
    path = exported[1] / "src/low_pass.c"
    wrong = path.read_text().replace("(raw - smooth)", "(1.0000001 * (raw - smooth))")
    assert wrong != path.read_text()
    path.write_text(wrong)
    said = checked(plantc, exported)
    fails(said, 1, "a check failed", "native = interpret")
    answer = one_object(said)
    assert answer["changed"] == ["src/low_pass.c"]
    assert any(not check["passed"] for check in answer["checks"])


def test_check_finds_c_that_was_broken_by_hand(exported, plantc):
    path = exported[1] / "src/low_pass.c"
    path.write_text(path.read_text() + "hello\n")
    said = checked(plantc, exported)
    fails(said, 1, "the C that lies there compiles", "changed by hand")
    assert "fault of plantc" not in said.err
    assert one_object(said)["changed"] == ["src/low_pass.c"]


def test_check_finds_a_changed_model(exported, plantc, model):
    model(LOW_PASS.replace("0.1", "0.2"))
    said = checked(plantc, exported)
    fails(said, 1, "export again")
    assert {"src/low_pass.c", "src/low_pass.h", "manifest.json"} <= set(one_object(said)["changed"])


def test_check_finds_that_the_block_is_gone(exported, plantc, model):
    model(LOW_PASS.replace('Block("low_pass"', 'Block("other"'))
    fails(checked(plantc, exported), 2, "'low_pass'", "it has other")


@pytest.mark.parametrize("text", [None, "", "{", "[]", "{}", '{"name": "low_pass"}'])
def test_check_of_a_folder_without_a_good_manifest(exported, plantc, text):
    path = exported[1] / "manifest.json"
    path.unlink()
    if text is not None:
        path.write_text(text)
    said = checked(plantc, exported)
    fails(said, 2, "manifest")
    assert "itself failed" not in said.err
    assert one_object(said)


def test_check_of_no_folder(exported, plantc, tmp_path):
    fails(plantc("check", tmp_path / "nowhere", "--model", exported[0]), 2, "nowhere", "plantc export")
    fails(plantc("check", exported[1], "--model", "nowhere.py"), 2, "nowhere.py")


# -- designed numbers -------------------------------------------------------------------------------------------------


@pytest.mark.slow
def test_designed_numbers_are_written_once_then_read(model, plantc, tmp_path):
    name, design = model(CART), tmp_path / "design.json"
    said = plantc("export", name, *FAST)
    assert said.status == 0, said.err
    assert "designed numbers written to design.json" in said.err
    stored = json.loads(design.read_text())
    gain = stored["cart_sskf"]["values"]["gain"]
    assert all(float(f"{value:.8e}") == value for row in gain for value in row)

    written = design.read_bytes()
    said = plantc("export", name, *FAST)
    assert said.status == 0, said.err
    assert "designed numbers" not in said.err
    assert design.read_bytes() == written

    stored["cart_sskf"]["values"]["gain"][0][0] = 0.0625  # what the file says is what the C gets
    design.write_text(json.dumps(stored))
    assert plantc("export", name, *FAST).status == 0
    assert "0.0625" in (tmp_path / "generated_c/cart_sskf/src/cart_sskf.c").read_text()
    said = plantc("check", "generated_c/cart_sskf", "--model", name, *FAST)
    fails(said, 1, "design: residual of the gain equation")


@pytest.mark.slow
def test_designed_numbers_of_another_model_stop_the_export(model, plantc, tmp_path):
    assert plantc("export", model(CART), *FAST).status == 0
    before = (tmp_path / "design.json").read_bytes()
    name = model(CART.replace("variance=4.0", "variance=9.0"))
    said = plantc("export", name, *FAST, "--json")
    fails(said, 2, "design.json", "--redesign")
    assert one_object(said)
    assert (tmp_path / "design.json").read_bytes() == before

    said = plantc("export", name, *FAST, "--redesign")
    assert said.status == 0, said.err
    assert (tmp_path / "design.json").read_bytes() != before
    assert plantc("check", "generated_c/cart_sskf", "--model", name, *FAST).status == 0


@pytest.mark.parametrize(
    "text",
    [
        "{",
        "[]",
        '{"cart_sskf": 5}',
        '{"cart_sskf": {"source": "a"}}',
        '{"other": []}',
        '{"cart_sskf": {"source": SOURCE, "values": {}}}',
        '{"cart_sskf": {"source": SOURCE, "values": {"gain": "high"}}}',
        '{"cart_sskf": {"source": SOURCE, "values": {"gain": [[1], [2, 3]]}}}',
    ],
)
def test_designed_numbers_that_cannot_be_read(text, model, plantc, tmp_path):
    name, design = model(CART), tmp_path / "design.json"
    source = blocks_of(name)[0][0].design.source
    design.write_text(text.replace("SOURCE", json.dumps(source)))
    before = design.read_text()
    said = plantc("export", name, *FAST)
    fails(said, 2, "design.json", "--redesign")
    assert "itself failed" not in said.err
    assert design.read_text() == before
    with_design(blocks_of(name)[0][0], design, redesign=True)
    assert with_design(blocks_of(name)[0][0], design)[1] is None


def test_an_export_that_is_refused_leaves_no_designed_numbers(model, plantc, tmp_path):
    folder = tmp_path / "generated_c/cart_sskf"
    folder.mkdir(parents=True)
    (folder / "thesis.tex").write_text("mine")
    fails(plantc("export", model(CART), *FAST), 2, "thesis.tex")
    assert not (tmp_path / "design.json").exists()


def test_designed_numbers_are_written_whole_or_not_at_all(model, tmp_path, monkeypatch):
    name, design = model(CART), tmp_path / "design.json"
    design.write_text("{}")

    def full(source, target):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "replace", full)
    with pytest.raises(FolderError, match="design.json: cannot be written"):
        with_design(blocks_of(name)[0][0], design)
    assert design.read_text() == "{}"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["design.json", name]


def test_a_file_changed_by_hand_is_written_over_only_where_asked(model, plantc, tmp_path):
    name = model(LOW_PASS)
    assert plantc("export", name, *FAST).status == 0
    source = tmp_path / "generated_c/low_pass/src/low_pass.c"
    source.write_text(source.read_text() + "/* mine */\n")
    fails(plantc("export", name, *FAST), 2, "low_pass.c", "changed since plantc wrote it", "--force")
    assert "mine" in source.read_text()
    assert plantc("export", name, *FAST, "--force").status == 0
    assert "mine" not in source.read_text()


# -- progress, demo ---------------------------------------------------------------------------------------------------


def test_progress_is_shown_on_a_terminal_only():
    import io

    from rich.console import Console

    from plantc.__main__ import Session

    for terminal in (False, True):
        session = Session(False, False)
        session.console = Console(file=io.StringIO(), force_terminal=terminal)
        with session.progress() as display:
            display.add_task("compile", total=None)
        assert ("compile" in session.console.file.getvalue()) is terminal


@pytest.mark.slow
def test_the_demo_exports_and_draws(model, plantc, tmp_path):
    said = plantc("demo", "--out", tmp_path / "shown", "--json")
    assert said.status == 0, said.err
    answer = one_object(said)
    assert said.summary == f"done: the C lies in {tmp_path}/shown/quadrotor_ekf"
    assert (tmp_path / "shown/quadrotor_ekf.svg").read_text().startswith("<?xml")
    assert answer["blocks"][0]["passed"]
    assert "native = reference" in said.err


@pytest.mark.slow
def test_check_proves_what_lies_there(model, plantc, needs, tmp_path):
    needs("frama-c", "gappa")
    name, folder = model(PENDULUM), tmp_path / "generated_c/pendulum_ekf"
    assert plantc("export", f"{name}:pendulum_ekf", *FAST, "--precision", "float").status == 0
    said = plantc("check", folder, "--model", f"{name}:pendulum_ekf", *FAST, "--prove", "--json")
    assert said.status == 0, said.err
    proved = [item for item in one_object(said)["checks"] if item["name"].startswith("proof of ")]
    assert {"proof of step", "proof of is_held"} <= {item["name"] for item in proved}
    bounds = {(item["entry"], item["name"]): item for item in one_object(said)["rounding"]}
    assert 0 < bounds["predict", "theta"]["error"] < 1e-5
    assert bounds["predict", "covariance"]["reason"] == "a kernel's result (Congruence)"
    assert "rounding errors of one call, bounded by Gappa" in said.err
    source = folder / "src/pendulum_ekf.c"
    whole = source.read_text()
    spoilt = whole.replace("(i < 3U) && held", "(i < 2U) && held")
    assert spoilt != whole
    source.write_text(spoilt)
    bad = plantc("check", folder, "--model", f"{name}:pendulum_ekf", *FAST, "--prove")
    assert bad.status == 1
    assert "FAIL proof of is_held" in bad.err


def test_what_may_be_fused_is_not_proved(model, plantc, needs, tmp_path):
    needs("frama-c", "gappa")
    name, folder = model(LOW_PASS), tmp_path / "generated_c/low_pass"
    assert plantc("export", name, *FAST, "--contract", "on").status == 0
    fails(plantc("check", folder, "--model", name, *FAST, "--prove"), 2, "--contract on", "--contract off")


# -- tables that a model brings ---------------------------------------------------------------------------------------

TABLE = (
    LOW_PASS
    + """
from plantc.symbolic import Table

low_pass.tables["Decay"] = lambda: Table("Calls until half is left", ("weight", "calls"), [(0.1, 7)], "Counted.")
"""
)


def test_a_table_of_the_model_is_measured_where_it_is_asked_for(model, plantc, tmp_path):
    name = model(TABLE)
    said = plantc("export", name, *FAST, "--tables", "--json")
    assert said.status == 0, said.err
    (table,) = one_object(said)["blocks"][0]["tables"]
    assert (table["title"], table["rows"]) == ("Decay", [[0.1, 7]])
    assert "Decay: Calls until half is left (report.html)" in said.err
    assert "<caption>Calls until half is left</caption>" in (tmp_path / "generated_c/low_pass/report.html").read_text()
    assert "tables" not in one_object(plantc("export", name, *FAST, "--json"))["blocks"][0]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (LOW_PASS, ["model.py: --tables is given, but no block brings a table; leave it out"]),
        (TABLE.replace("lambda: Table", "lambda: __import__('no_such') or Table"), ["'Decay'", "pip install no_such"]),
        (TABLE.replace("[(0.1, 7)]", "[(0.1,)]"), ["a row has 1 cells, there are 2 columns"]),
        (TABLE.replace("[(0.1, 7)]", "[(0.1, float('inf'))]"), ["a cell is not finite; say so in words"]),
    ],
)
def test_a_table_that_cannot_be_made_leaves_nothing(model, plantc, tmp_path, text, words):
    said = plantc("export", model(text), *FAST, "--tables")
    fails(said, 2, *words)
    assert not (tmp_path / "generated_c/low_pass").exists()
