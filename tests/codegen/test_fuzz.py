"""The fuzz harness: what it emits, what it reaches, and that it finds planted faults within a bounded number of calls."""

import re
import subprocess

import pytest
from plantc.codegen.compiler import WARNINGS
from plantc.codegen.exported import open_folder, run_tool
from plantc.codegen.folder import write_folder
from plantc.codegen.package import build_files
from plantc.codegen.sanitizers import (
    BASE,
    HARNESS,
    UNDEFINED,
    UNINITIALISED,
    FuzzResult,
    both_ways,
    build,
    fuzz,
    search,
)
from plantc.examples.pendulum import pendulum_ekf

from plantc import Block

CALLS = 100_000


@pytest.fixture(scope="module")
def files():
    return build_files(pendulum_ekf, "float")


@pytest.fixture
def folder(files, tmp_path):
    write_folder(tmp_path / "pendulum_ekf", files)
    return tmp_path / "pendulum_ekf"


def plant(folder, old, new, count=1):
    source = folder / "src/pendulum_ekf.c"
    text = source.read_text()
    assert old in text, old
    source.write_text(text.replace(old, new, count))


def block_of_one_flag():
    """A block of the user's own, with fields of other shapes: a vector with ranges by element, an output."""
    made = Block("mixer", doc="two numbers mixed")
    raw = made.input("raw", size=2, unit="V", range=((-1, -2), (1, 2)))
    weight = made.parameter("weight", 0.5, range=(0, 1))
    kept = made.memory("kept", initial=(0.0, 0.0), range=((-3, -6), (3, 6)))
    following = kept + weight * (raw - kept)
    made.entry("step", inputs=[raw], following={kept: following}, outputs={"sum": following[0] + following[1]})
    return made


@pytest.mark.parametrize("compiler", ["gcc", "clang"])
@pytest.mark.parametrize("precision", ["float", "double"])
def test_the_harness_compiles_without_a_warning(precision, compiler, tmp_path, needs):
    needs(compiler)
    for block in (pendulum_ekf, block_of_one_flag()):
        write_folder(tmp_path / block.name, build_files(block, precision))
        for define in ("-DSTANDS_ALONE", "-DWITH_LIBFUZZER"):
            command = [compiler, "-std=c99", *WARNINGS, define, "-I", "src", "-c", HARNESS, "-o", "/dev/null"]
            done = run_tool(command, tmp_path / block.name)
            assert done.returncode == 0, done.stderr


def test_every_entry_is_accepted_and_refused_and_every_status_reached(folder, needs):
    needs("gcc")
    found = fuzz(folder, "pendulum_ekf", calls=CALLS)
    assert found.good, found.complaints
    assert CALLS <= found.calls <= CALLS + 65
    assert 0.1 * found.calls < found.refused < 0.5 * found.calls
    assert both_ways(found, open_folder(folder).manifest) == []
    assert found.statuses["step"].keys() == {
        "OK", "GATED", "CLAMPED", "SKIPPED", "RECOVERED", "BAD_INPUT", "NOT_POSITIVE", "OVERFLOW",
    }  # fmt: skip
    assert found.statuses["init"].keys() == {"OK", "BAD_PARAM"}


def test_the_random_calls_are_the_same_each_time_and_others_with_another_seed(folder, needs):
    needs("gcc")
    first, second, third = (fuzz(folder, "pendulum_ekf", calls=5000, flags=(), seed=seed) for seed in (1, 1, 2))
    assert first == second
    assert first.statuses != third.statuses


def test_a_block_of_the_users_own(tmp_path, needs):
    needs("gcc")
    write_folder(tmp_path / "mixer", build_files(block_of_one_flag(), "double"))
    found = fuzz(tmp_path / "mixer", "mixer", calls=CALLS)
    assert found.good, found.complaints
    assert found.statuses["step"].keys() == {"OK", "BAD_INPUT", "OVERFLOW"}  # the last from a bad parameter
    harness = (tmp_path / "mixer" / HARNESS).read_text()
    assert "{ -6.0, 6.0 }" in harness


JUDGED = "if (status >= PENDULUM_EKF_OK)\n    {\n        *state = after;\n"

FAULTS = {
    "commit before judging": (JUDGED, "if (true)\n    {\n        *state = after;\n", "the memory changed"),
    "a range check removed": (" && ((after->omega >= -100.0f) == true)", "", "memory field omega"),
    "an output written on refusal": (
        "const pendulum_ekf_status_t status = pendulum_ekf_update_encoder_core(",
        "out->nis = 0.0f;\n    const pendulum_ekf_status_t status = pendulum_ekf_update_encoder_core(",
        "the outputs changed",
    ),
    "an output that is not finite": (
        "out->nis = nis[0];", "out->nis = 1.0f / (nis[0] - nis[0]);", "output (encoder.)?nis"
    ),
    "an unknown status": ("status = PENDULUM_EKF_OVERFLOW;", "status = (pendulum_ekf_status_t)-9;", "nobody knows"),
    "an unguarded cast": (
        "after->rejected_encoder = before->rejected_encoder;",
        "after->rejected_encoder = (uint32_t)(before->omega * 1.0e9f);",
        "runtime error: .* outside the range",
    ),
    "an index beyond an array": (
        "after->covariance[0] = factor * before->covariance[0];",
        "after->covariance[0] = factor * before->covariance[(factor > 1.0f) ? 3 : 0];",
        "runtime error: index 3 out of bounds",
    ),
}  # fmt: skip


@pytest.mark.parametrize("fault", sorted(FAULTS))
def test_a_planted_fault_is_found(fault, folder, needs):
    needs("gcc")
    old, new, said = FAULTS[fault]
    plant(folder, old, new, 9)
    found = fuzz(folder, "pendulum_ekf", calls=CALLS)
    assert not found.good
    assert re.search(said, " ".join(found.complaints)), found.complaints


def test_comparisons_that_nan_passes_are_found(folder, needs):
    needs("gcc")
    plant(folder, "if (!((covariance[at] >= 0.0f) == true))", "if (covariance[at] < 0.0f)")
    plant(
        folder,
        "held = ((covariance[i] >= -1.0e9f) == true)\n               && ((covariance[i] <= 1.0e9f) == true);",
        "held = !(covariance[i] < -1.0e9f) && !(covariance[i] > 1.0e9f);",
    )
    found = fuzz(folder, "pendulum_ekf", calls=CALLS)
    assert "outside its range: memory field" in found.complaints[0]


def test_an_entry_that_refuses_nothing_is_noticed(folder, needs):
    needs("gcc")
    plant(folder, "if (!(((factor >= 1.0f) == true) && ((factor <= 1000000.0f) == true)))", "if (factor > 1.0e38f)")
    found = fuzz(folder, "pendulum_ekf", calls=CALLS, flags=())
    assert found.statuses["inflate"]
    silent = FuzzResult(statuses={**found.statuses, "inflate": {"OK": 5}, "predict": {"BAD_INPUT": 7}})
    manifest = open_folder(folder).manifest
    assert both_ways(silent, manifest) == ["predict was never accepted", "inflate was never refused"]


def test_memory_that_is_left_unset_is_found(folder, needs):
    needs("clang")
    assert fuzz(folder, "pendulum_ekf", calls=5000, compiler="clang", flags=UNINITIALISED).good
    plant(folder, "    after->rejected_encoder = before->rejected_encoder;\n", "")
    found = fuzz(folder, "pendulum_ekf", calls=5000, compiler="clang", flags=UNINITIALISED)
    assert "use-of-uninitialized-value" in found.complaints[0]


@pytest.mark.slow
def test_libfuzzer_keeps_a_corpus_and_finds_a_planted_fault(folder, tmp_path, needs):
    needs("clang")
    corpus = tmp_path / "corpus"
    found = search(folder, "pendulum_ekf", inputs=20_000, corpus=corpus)
    assert found.good, found.complaints
    kept = sorted(corpus.iterdir())
    assert 3 < len(kept) < 1000
    replayed = fuzz(folder, "pendulum_ekf", calls=0, inputs=kept)
    assert replayed.good
    assert set(replayed.statuses["step"]) >= {"OK", "GATED", "CLAMPED", "SKIPPED", "BAD_INPUT", "OVERFLOW"}
    plant(folder, *FAULTS["commit before judging"][:2])
    assert "the memory changed" in " ".join(search(folder, "pendulum_ekf", inputs=20_000).complaints)


def test_a_program_without_arguments_counts_a_million(folder, tmp_path, needs):
    needs("gcc")
    program = build("gcc", ("-O2",), folder, ["src/pendulum_ekf.c", HARNESS], tmp_path / "fuzz")
    done = subprocess.run([program], capture_output=True, text=True, check=True)
    assert re.search(r"^10000\d\d calls, \d+ refused, 0 lost$", done.stdout, re.MULTILINE)
    absent = subprocess.run([program, "nowhere"], capture_output=True, text=True, check=False)
    assert absent.returncode == 1
    assert "nowhere cannot be read" in absent.stdout


def test_what_is_built_is_stated():
    assert UNDEFINED[0] == "-fsanitize=address,undefined,float-cast-overflow"
    assert "-fno-sanitize-recover=all" in UNDEFINED
    assert "-ffp-contract=off" in BASE
