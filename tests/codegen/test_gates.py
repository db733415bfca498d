"""Every gate on the examples, and a fault planted in the C for each, which that gate sees and no other."""

import shutil
from dataclasses import replace

import pytest
from plantc.codegen.bounds import source_loops
from plantc.codegen.compiler import BASE_FLAGS, Compiler
from plantc.codegen.crosscheck import CrossCheck
from plantc.codegen.emit import emit
from plantc.codegen.gates import (
    addresses_gate,
    allowed_symbols,
    build_plain,
    header_gate,
    loops_gate,
    object_gates,
    warnings_gate,
)
from plantc.codegen.host_gates import equal_bits_gate, measure_gates
from plantc.codegen.objects import read_image
from plantc.codegen.options import Options
from plantc.codegen.style import Precision
from plantc.codegen.targets import TARGETS, find_toolchain
from plantc.examples.attitude_ekf import attitude_ekf
from plantc.examples.pendulum import pendulum_ekf
from plantc.examples.quadrotor_ekf import quadrotor_kf

MACHINES = ("host", "cortex-m4", "cortex-m7", "rv32")
PREFIX = "pendulum_ekf"
COUNT = next(item.name for item in pendulum_ekf.memory_signals_flat() if item.kind.value == "count")
HEAD = f"{PREFIX}_status_t {PREFIX}_predict({PREFIX}_state_t *state"


def planted(text, declarations, statement):
    """The C with declarations ahead of the public functions, and a statement at the beginning of `predict`."""
    source = text.source
    at = source.index(f"\n{HEAD}")
    body = source.index("{\n", at) + 2
    changed = source[:at] + f"\n{declarations}\n" + source[at:body] + f"    {statement}\n" + source[body:]
    return replace(text, source=changed)


def found_in(text, machine, folder, needs, plainly=True):
    """Names of the gates that an object, built twice, does not pass, without the machine."""
    folder.mkdir(exist_ok=True)
    if machine == "host":
        needs("gcc")
        for file, content in ((f"{text.name}.h", text.header), (f"{text.name}.c", text.source)):
            (folder / file).write_text(content)
        run, flags = Compiler(("gcc",), "gcc").run, [*BASE_FLAGS, "-ffp-contract=off"]
        run([*flags, "-c", f"{text.name}.c"], folder)
        path = folder / f"{text.name}.o"
    else:
        needs(f"{TARGETS[machine].prefix}gcc")
        toolchain = find_toolchain(TARGETS[machine])
        path = toolchain.library_object(text, folder)
        run, flags = toolchain.run, toolchain.flags
    plain = build_plain(run, flags, text, folder) if plainly else None
    results = object_gates(read_image(path), text, machine, plain)
    assert all(item.note for item in results if not item.passed)
    return [item.name.removesuffix(f" ({machine})") for item in results if not item.passed]


@pytest.mark.slow
@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize("precision", ["double", "float"])
@pytest.mark.parametrize("block", [pendulum_ekf, attitude_ekf], ids=lambda block: block.name)
def test_the_examples_pass(block, precision, machine, tmp_path, needs):
    for mathematics in ("own", "libm") if block is pendulum_ekf else ("own",):
        text = emit(block, precision, mathematics=mathematics)
        assert found_in(text, machine, tmp_path / mathematics, needs) == []
        assert loops_gate(text).passed
        assert addresses_gate(text).passed
        assert source_loops(text.source)


FAULTS = {
    "no heap": (
        "#include <stdlib.h>",
        "void *volatile taken = malloc(state->{count} + 16U); free(taken);",
    ),
    "only listed symbols": ("extern int elsewhere(int value);", "(void)elsewhere((int)state->{count});"),
    "no recursion": (
        "static uint32_t down(uint32_t k);\nstatic uint32_t __attribute__((noinline)) up(uint32_t k)\n{{\n"
        "    volatile uint32_t kept = k;\n    return (kept > 3U) ? (down(kept / 2U) * kept) : kept;\n}}\n"
        "static uint32_t __attribute__((noinline)) down(uint32_t k)\n{{\n"
        "    volatile uint32_t kept = k;\n    return up(kept - 1U) + kept;\n}}\n",
        "if (up(state->{count}) == 7U) {{ return PENDULUM_EKF_OVERFLOW; }}",
    ),
    "no globals": ("", "static volatile uint32_t calls = 1U; calls = calls + 1U;"),
    "no double in float": (
        "",
        "volatile float scaled = (float)state->{count}; scaled = (float)((double)scaled * 1.1);",
    ),
    "no fixed address": ("", "*(volatile uint32_t *)0x20000000U = state->{count};"),
    "frames of fixed size": (
        "",
        "volatile uint8_t *room = (volatile uint8_t *)__builtin_alloca(state->{count} + 1U); room[0] = 1U;",
    ),
}


@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize("gate", FAULTS)
def test_a_planted_fault_is_seen_by_its_gate_and_no_other(gate, machine, tmp_path, needs):
    text = emit(pendulum_ekf, "float")
    declarations, statement = (item.format(count=COUNT) for item in FAULTS[gate])
    assert found_in(planted(text, declarations, statement), machine, tmp_path, needs) == [gate]


@pytest.mark.parametrize("machine", MACHINES)
def test_a_zeroed_static_and_an_indirect_call_are_seen(machine, tmp_path, needs):
    text = emit(pendulum_ekf, "double")
    zeroed = planted(text, "", "static volatile uint32_t calls; calls = calls + 1U;")
    assert found_in(zeroed, machine, tmp_path / "zeroed", needs) == ["no globals"]
    pointer = planted(text, "", "{ int (*volatile how)(int) = 0; if (how != 0) { (void)how(1); } }")
    assert found_in(pointer, machine, tmp_path / "pointer", needs) == ["no recursion"]


def test_a_function_of_mathematics_that_the_c_does_not_call_is_not_listed():
    own = emit(pendulum_ekf, "float")
    assert "sinf" not in allowed_symbols(own, "thumb")
    assert {"sinf", "cosf", "sincosf"} <= allowed_symbols(emit(pendulum_ekf, "float", mathematics="libm"), "thumb")
    assert "__aeabi_dadd" not in allowed_symbols(own, "thumb")
    assert "__aeabi_dadd" in allowed_symbols(emit(pendulum_ekf, "double"), "thumb")


ONLY_PLAINLY = {
    "no recursion": (
        "static uint32_t __attribute__((noinline)) down(uint32_t k, uint32_t n)\n{{\n"
        "    return (k == 0U) ? n : down(k - 1U, (n * 3U) + (k * k));\n}}\n",
        "if (down(state->{count}, 1U) == 7U) {{ return PENDULUM_EKF_OVERFLOW; }}",
    ),
    "no loop but those of the C": ("", "if (inputs == 0) {{ for (;;) {{ if (state->{count} > 0U) {{ break; }} }} }}"),
}


@pytest.mark.parametrize("machine", ["host", "cortex-m4", "rv32"])
@pytest.mark.parametrize("gate", ONLY_PLAINLY)
def test_what_the_optimiser_hides_is_seen_in_a_plain_build(gate, machine, tmp_path, needs):
    text = emit(pendulum_ekf, "float")
    declarations, statement = (item.format(count=COUNT) for item in ONLY_PLAINLY[gate])
    fault = planted(text, declarations, statement.replace("inputs == 0", f"state->{COUNT} > 5U"))
    assert found_in(fault, machine, tmp_path / "plain", needs) == [gate]
    assert found_in(fault, machine, tmp_path / "optimised", needs, plainly=False) == []


TABLE = """
static float one(float x) { return x + 1.0f; }
static float two(float x) { return x * 2.0f; }
static float three(float x) { return x * x; }
typedef float (*way_t)(float);
static const way_t ways[3] = { one, two, three };
float pick(float x, uint32_t k);
float pick(float x, uint32_t k)
{
    return ways[k](x);
}
uint32_t choose(uint32_t x, uint32_t y);
uint32_t choose(uint32_t x, uint32_t y)
{
    switch (x)
    {
        case 0U: return y * 3U;
        case 1U: return y / 7U;
        case 2U: return y ^ 5U;
        case 3U: return y << 2U;
        case 4U: return y % 11U;
        case 5U: return y | 9U;
        default: return y;
    }
}
"""


@pytest.mark.parametrize("machine", MACHINES)
def test_a_call_through_a_table_is_no_switch(machine, tmp_path, needs):
    text = planted(emit(pendulum_ekf, "float"), TABLE, "")
    assert found_in(text, machine, tmp_path, needs, plainly=False) == ["no recursion"]
    assert read_image(tmp_path / f"{text.name}.o").calls()["choose"] <= {"choose.cold"}
    assert None in read_image(tmp_path / f"{text.name}.o").calls()["pick"]


@pytest.mark.parametrize(
    "room", ["float room[state->{count} + 1U]; (void)room;", "(void)__builtin_alloca(state->{count});"]
)
@pytest.mark.parametrize("label", ["gcc", "clang"])
def test_stack_taken_at_run_time_is_warned_of(label, room, tmp_path, needs):
    needs(label)
    fault = planted(emit(pendulum_ekf, "float"), "", room.format(count=COUNT))
    result = warnings_gate(Compiler((shutil.which(label),), label), fault, tmp_path)
    assert not result.passed
    assert "vla" in result.note or "alloca" in result.note


@pytest.mark.parametrize(
    "statement",
    ["*(volatile float *)0x20000000 = 1.0f;", "(void)(uintptr_t)state;", "float *p = (float *)(4096U); (void)p;"],
)
def test_a_number_made_a_pointer_is_seen_in_the_c(statement):
    assert not addresses_gate(planted(emit(pendulum_ekf, "float"), "", statement)).passed
    assert not addresses_gate(planted(emit(pendulum_ekf, "float"), f"#define PLANTED {statement}", "")).passed


@pytest.mark.parametrize(
    "loop",
    [
        "while (state != 0) {{ }}",
        "for (uint32_t k = 0U; k < state->{count}; k++) {{ }}",
        "do {{ }} while (state != 0);",
        "if (state != 0) {{ for (;;) {{ }} }}",
        "int x = 0; for (;;) {{ x = 1; }}",
        "// /*\n    for (;;) {{ }}\n    // */",
        "for (uint32_t k = 3U; k >= 0U; k--) {{ }}",
    ],
)
def test_an_unbounded_loop_is_seen(loop):
    statement = loop.format(count=COUNT)
    result = loops_gate(planted(emit(pendulum_ekf, "float"), "", statement))
    assert not result.passed
    assert next(word for word in ("while", "do", "for") if word in loop) in result.note
    in_header = replace(emit(pendulum_ekf, "float"), header="#define FOREVER for (;;)\n")
    assert loops_gate(in_header).note == "line 1 of the header: for (;;)"


@pytest.mark.parametrize("label", ["gcc", "clang"])
def test_a_warning_is_seen(label, tmp_path, needs):
    needs(label)
    compiler = Compiler((shutil.which(label),), label)
    text = emit(pendulum_ekf, "float")
    assert warnings_gate(compiler, text, tmp_path).passed
    for fault in ("int8_t narrow = state->{count}; (void)narrow;", "int unused_one = 1;"):
        result = warnings_gate(compiler, planted(text, "", fault.format(count=COUNT)), tmp_path)
        assert not result.passed
        assert "-W" in result.note


@pytest.mark.parametrize("label", ["g++", "clang++"])
def test_a_header_that_is_no_cpp_is_seen(label, tmp_path, needs):
    needs(label)
    compiler = Compiler((shutil.which(label),), label)
    text = emit(pendulum_ekf, "float")
    assert header_gate(compiler, text, tmp_path).passed
    broken = replace(
        text, header=text.header.replace("(pendulum_ekf_state_t *state", "(pendulum_ekf_state_t *class", 1)
    )
    assert broken.header != text.header
    assert not header_gate(compiler, broken, tmp_path).passed


@pytest.mark.parametrize("precision", ["double", "float"])
def test_gcc_and_clang_give_the_same_bits_and_a_difference_is_seen(precision, tmp_path, needs):
    needs("gcc", "clang")
    text = emit(pendulum_ekf, precision)
    largest = max(pendulum_ekf.memory_signals_flat(), key=lambda item: item.size)
    one_and_a_bit = "1.000001f" if precision == "float" else "1.000000000001"
    slot = f"state->{largest.name}[0]"
    other = planted(text, "", f"{slot} = {slot} * {one_and_a_bit};")

    def gate(right, judged=True):
        libraries, texts = {}, {"gcc": text, "clang": right}
        for label, given in texts.items():
            folder = tmp_path / label
            folder.mkdir(exist_ok=True)
            (folder / f"{PREFIX}.h").write_text(given.header)
            (folder / f"{PREFIX}.c").write_text(given.source)
            flags = [*BASE_FLAGS, "-ffp-contract=off", "-fPIC", "-shared", f"{PREFIX}.c"]
            name = f"{'same' if right is text else 'other'}.so"
            Compiler((shutil.which(label),), label).run([*flags, "-o", name, "-lm"], folder)
            libraries[label] = folder / name
        return equal_bits_gate(pendulum_ekf, precision, libraries, texts, CrossCheck([], {}, []), judged=judged)

    assert gate(text).passed
    found = gate(other)
    assert not found.passed
    assert found.mismatch is not None
    reported = gate(other, judged=False)
    assert reported.passed
    assert reported.verdict == "not judged"
    assert reported.remark.startswith("not judged: ")


def test_an_export_passes_all_gates_and_says_what_is_missing(monkeypatch, needs):
    needs("gcc", "clang", "g++", "clang++")
    text = emit(quadrotor_kf, "float")
    options = Options(Precision("float"))
    found = measure_gates(quadrotor_kf, options, text, CrossCheck([], {}, []))
    assert [item.name for item in found.checks if not item.passed] == []
    assert {"no heap (host)", "no warnings (gcc)", "no warnings (clang)", "header as C++ (g++)", "gcc = clang"} <= {
        item.name for item in found.checks
    }
    assert found.facts["gates"]["missing"] == []
    which = shutil.which
    monkeypatch.setattr(shutil, "which", lambda name, *rest: None if "clang" in name else which(name, *rest))
    without = measure_gates(quadrotor_kf, options, text, CrossCheck([], {}, []))
    assert "gcc = clang" not in {item.name for item in without.checks}
    assert without.facts["gates"]["missing"] == [
        f"{name} is not installed: what it would say is not known" for name in ("clang", "clang++")
    ]


def test_an_object_that_is_not_elf_is_said_and_fails_nothing(monkeypatch, needs):
    needs("gcc")
    from plantc.codegen import host_gates
    from plantc.codegen.objects import Image

    monkeypatch.setattr(host_gates, "read_image", lambda path: Image(b"\xcf\xfa\xed\xfe" + bytes(60), path.name))
    found = measure_gates(pendulum_ekf, Options(), emit(pendulum_ekf, "double"), CrossCheck([], {}, []))
    assert found.facts["gates"]["object"].startswith("not looked into: host.o is not an ELF file")
    assert all(item.passed for item in found.checks)
