"""Bounds against what the emulator counts and paints, against -fstack-usage, and against planted faults."""

import re
import subprocess
from dataclasses import replace

import pytest
from plantc.codegen import bounds
from plantc.codegen.bounds import Analysis, Unknown, source_loops
from plantc.codegen.costs import Cost, within
from plantc.codegen.crosscheck import make_probes, make_views
from plantc.codegen.emit import emit
from plantc.codegen.emulator import Call, TargetView
from plantc.codegen.folder import write_files
from plantc.codegen.objects import read_image
from plantc.codegen.on_target import analysis_of
from plantc.codegen.package import build_files
from plantc.codegen.targets import TARGETS, find_toolchain, linked_library
from plantc.examples.attitude_ekf import attitude_ekf
from plantc.examples.pendulum import pendulum_ekf
from plantc.examples.quadrotor_ekf import quadrotor_ekf, quadrotor_kf
from plantc.symbolic import sqrt

from plantc import Block, NativeView

CROSS = ("cortex-m4", "cortex-m7", "rv32")


def loops_of(body):
    return source_loops(f"static void f(uint32_t n)\n{{\n{body}\n}}\n")


def trips(body):
    return [loop.trips for loop in loops_of(body)]


@pytest.mark.parametrize(
    ("head", "expected"),
    [
        ("for (uint32_t i = 0U; i < 12U; i++)", 12),
        ("for (uint32_t i = 2U; i < 12U; i++)", 10),
        ("for (uint32_t i = 0U; i <= 12U; i++)", 13),
        ("for (uint32_t i = 0U; i < 78U; i = i + 6U)", 13),
        ("for (uint32_t i = 0U; i < 79U; i = i + 6U)", 14),
        ("for (uint32_t i = 0U; (i < 12U) && (status >= X_OK); i++)", 12),
        ("for (uint32_t i = n; i < 12U; i++)", 12),
        ("for (uint32_t i = 5U; i > 0U; i--)", 5),
        ("for (uint32_t i = 0U; i < n; i++)", None),
        ("for (uint32_t i = 0U; i < 12U; i = i * 2U)", None),
        ("for (uint32_t i = 12U; i < 3U; i--)", None),
        ("for (;;)", None),
        ("while (n > 0U)", None),
    ],
)
def test_trips_are_read_off_the_head(head, expected):
    assert trips(f"    {head}\n    {{\n        x[i] = 0.0f;\n    }}") == [expected]


def test_a_counter_of_the_loop_around_bounds_and_a_written_counter_does_not():
    nest = "    for (uint32_t i = 0U; i < 7U; i++)\n    {\n        for (uint32_t j = 0U; j < i; j++)\n        {\n            y = j;\n        }\n    }"
    assert trips(nest) == [7, 7]
    assert trips(nest.replace("y = j", "i = 0U")) == [None, None]
    assert trips(nest.replace("y = j", "i--")) == [None, None]
    assert trips(nest.replace("y = j", "poke(&i)")) == [None, None]
    outer, inner = loops_of(nest)
    assert (outer.function, outer.first, outer.last, inner.first, inner.last) == ("f", 3, 9, 5, 8)


PROBED = {}


def probes_of(block):
    """The calls of a short cross-check, plausible and implausible, made once."""
    if block.name not in PROBED:
        native = NativeView(block, "float")
        PROBED[block.name] = make_probes(block, "float", make_views(block, "float", native), 8, 0)
    return PROBED[block.name]


def measured(block, target):
    """A view that made the calls of a cross-check."""
    view = TargetView(block, "float", TARGETS[target])
    view.calls([Call(probe.entry, probe.inputs, probe.memory, probe.params) for probe in probes_of(block)])
    return view


def analysed(block, text, target, folder):
    program = linked_library(find_toolchain(TARGETS[target]), text, list(block.entries), folder)
    return analysis_of(block, text, program)


@pytest.mark.slow
@pytest.mark.parametrize(
    "block", [pendulum_ekf, attitude_ekf, quadrotor_ekf, quadrotor_kf], ids=lambda block: block.name
)
def test_what_is_measured_is_not_above_the_bound(block, tmp_path, needs):
    for target in CROSS:
        needs(f"{TARGETS[target].prefix}gcc", TARGETS[target].emulator)
        view = measured(block, target)
        analysis = analysed(block, view.text, target, tmp_path)
        for name, cost in view.most.items():
            instructions, stack = (how(f"{block.name}_{name}") for how in (analysis.instructions, analysis.stack))
            assert cost.instructions <= instructions, (target, name)
            assert cost.stack <= stack < 2 * cost.stack, (target, name)
            assert instructions < 10 * cost.instructions, f"{target}, {name}: a bound that says nothing"


@pytest.mark.parametrize("target", CROSS)
def test_double_has_bounds_also_where_it_is_software(target, tmp_path, needs, monkeypatch):
    """Products, quotients and roots of subnormal numbers are the longest ways through double arithmetic in software."""
    needs(f"{TARGETS[target].prefix}gcc", TARGETS[target].emulator)
    block = Block("soft", doc="double arithmetic")
    a, b = block.input("a", range=(0, 1)), block.input("b", range=(0, 1))
    block.entry("times", inputs=[a, b], outputs={"product": a * b})
    block.entry("over", inputs=[a, b], outputs={"ratio": b / (a + 1)})
    block.entry("root", inputs=[a], outputs={"root": sqrt(a)})
    view = TargetView(block, "double", TARGETS[target])
    values = [0.0, 5e-324, 3e-310, 1e-200, 0.3, 1.0]
    calls = [(entry, {"a": x, "b": y}) for entry in ("times", "over") for x in values for y in values]
    calls += [("root", {"a": x}) for x in values]
    view.calls([Call(entry, view.inputs(entry, given), view.memory(), view.params()) for entry, given in calls])
    analysis = analysed(block, view.text, target, tmp_path)
    for name in ("times", "over", "root"):
        seen = view.most[name].instructions
        assert seen <= analysis.instructions(f"soft_{name}") < 8 * seen, name
    monkeypatch.setattr(bounds, "_BIT_LOOPS", {name: dict.fromkeys(row, 0) for name, row in bounds._BIT_LOOPS.items()})
    planted = analysed(block, view.text, target, tmp_path).instructions("soft_root")
    assert (planted < view.most["root"].instructions) == (target != "cortex-m7")  # there a root is one instruction


@pytest.mark.slow
@pytest.mark.parametrize("target", ["cortex-m4", "rv32"])
def test_a_filter_in_software_double_stays_within_its_bound(target, tmp_path, needs):
    needs(f"{TARGETS[target].prefix}gcc", TARGETS[target].emulator)
    native = NativeView(quadrotor_ekf, "double")
    probes = make_probes(quadrotor_ekf, "double", make_views(quadrotor_ekf, "double", native), 8, 0)
    view = TargetView(quadrotor_ekf, "double", TARGETS[target])
    view.calls([Call(probe.entry, probe.inputs, probe.memory, probe.params) for probe in probes])
    analysis = analysed(quadrotor_ekf, view.text, target, tmp_path)
    for name, cost in view.most.items():
        assert cost.instructions <= analysis.instructions(f"quadrotor_ekf_{name}"), name
        assert cost.stack <= analysis.stack(f"quadrotor_ekf_{name}"), name


def test_a_lower_loop_bound_is_caught(tmp_path, needs):
    needs("arm-none-eabi-gcc", "qemu-system-arm")
    view = measured(quadrotor_kf, "cortex-m4")
    honest = analysed(quadrotor_kf, view.text, "cortex-m4", tmp_path)
    seen = {name: view.most[name].instructions for name in view.most}

    def check(analysis):
        rows = {name: Cost.of(seen[name], analysis.instructions(f"quadrotor_kf_{name}")) for name in seen}
        return within("instructions", "cortex-m4", rows)

    assert check(honest).verdict == "passed"
    lower = [replace(loop, trips=0) for loop in honest.loops]
    for planted in (
        Analysis(honest.image, lower, honest.file, honest.largest),
        NeverOn(honest.image, honest.loops, honest.file, honest.largest),
    ):
        found = check(planted)
        assert found.verdict == "failed"
        assert re.search(r"\w+: \d+ seen, the bound is \d+", found.note)


class NeverOn(Analysis):
    """Follows every conditional jump to its target and never past it: half of the edges are gone."""

    def _follow(self, start, item, *rest):
        after = super()._follow(start, item, *rest)
        return after[1:] if item.kind == "jump" and item.conditional and len(after) > 1 else after


THUMB = """
    .syntax unified
    .thumb
    .text
    .global early, popped, either, start
    .type early, %function
early:
    cmp r0, #0
    it eq
    bxeq lr
    movs r1, #1
    movs r2, #2
    movs r3, #3
    bx lr
    .size early, . - early
    .type popped, %function
popped:
    push {r4, lr}
    cmp r0, #0
    it ne
    popne {r4, pc}
    sub sp, sp, #16
    movs r1, #1
    add sp, sp, #16
    pop {r4, pc}
    .size popped, . - popped
    .type either, %function
either:
    cmp r0, #0
    ite eq
    moveq r0, #1
    bxne lr
    movs r1, #1
    bx lr
    .size either, . - either
    .type start, %function
start:
    bx lr
    .size start, . - start
"""


def test_a_conditional_return_in_an_it_block_may_go_on(tmp_path, needs):
    """The long way is the one past the return; taken for an unconditional one, the bound would be too low."""
    needs("arm-none-eabi-gcc")
    toolchain = find_toolchain(TARGETS["cortex-m4"])
    (tmp_path / "it.s").write_text(THUMB)
    flags = [*TARGETS["cortex-m4"].flags, "-nostdlib", "-Wl,-e,start", "it.s", "-o", "it.elf"]
    toolchain.compiler.run(flags, tmp_path)
    analysis = Analysis(read_image(tmp_path / "it.elf"))
    assert {name: analysis.instructions(name) for name in ("early", "popped", "either")} == {
        "early": 7, "popped": 8, "either": 6,
    }  # fmt: skip
    assert analysis.stack("popped") == 8 + 16
    assert [analysis.stack(name) for name in ("early", "either")] == [0, 0]


RISCV = """
    .option norvc
    .text
    .globl start
    .type start, %function
start:
    lui t3, %hi(elsewhere)
    .insn 4, 0x00055463
    j far
    addi a0, a0, 1
far:
    ret
    .size start, . - start
    .section .rodata
    .zero 64
elsewhere:
    .word 0
"""


def test_what_is_to_be_linked_before_a_branch_is_not_where_the_branch_goes(tmp_path, needs):
    """A conditional branch over a jump, as an assembler writes a long one (bgez a0, .+8, not relocated), right after an address of data (rv32)."""
    needs("riscv64-unknown-elf-gcc")
    toolchain = find_toolchain(TARGETS["rv32"])
    (tmp_path / "long.s").write_text(RISCV)
    toolchain.compiler.run([*TARGETS["rv32"].flags, "-c", "long.s", "-o", "long.o"], tmp_path)
    image = read_image(tmp_path / "long.o")
    start = image.function_named("start").address
    assert [image.at(start + 4 * k).target for k in (1, 2)] == [start + 12, start + 16]
    assert Analysis(image).instructions("start") == 4


@pytest.mark.slow
def test_the_bound_of_the_host_is_not_below_what_callgrind_counts(tmp_path, needs):
    """Each call of the shipped vectors, counted by itself; and the planted fault of a loop that never turns is seen."""
    needs("gcc", "valgrind")
    toolchain, text = find_toolchain(TARGETS["host"]), emit(quadrotor_kf, "float")
    write_files(tmp_path, build_files(quadrotor_kf, "float"))
    analysis = analysis_of(quadrotor_kf, text, toolchain.library_object(text, tmp_path))
    toolchain.compiler.run(
        [*toolchain.flags, "-I.", "test/test_vectors.c", "quadrotor_kf.o", "-o", "vectors", "-lm"], tmp_path
    )
    lower = Analysis(analysis.image, [replace(loop, trips=0) for loop in analysis.loops], analysis.file, 0)
    caught = 0
    for entry in ("predict", "update_pose", "inflate"):
        name = f"quadrotor_kf_{entry}"
        options = [f"--toggle-collect={name}", f"--dump-after={name}", f"--callgrind-out-file={entry}"]
        subprocess.run(
            ["valgrind", "--tool=callgrind", *options, "./vectors"], cwd=tmp_path, check=True, capture_output=True
        )
        found = [re.search(r"^totals: (\d+)", path.read_text(), re.MULTILINE) for path in tmp_path.glob(f"{entry}*")]
        counts = [int(item[1]) for item in found if item]
        assert len(counts) > 3
        assert max(counts) <= analysis.instructions(name) < 10 * max(counts)
        caught += max(counts) > lower.instructions(name)
    assert caught > 0


C = """
#include <stdint.h>
extern uint32_t sink[8];
uint32_t sink[8];
uint32_t down(uint32_t k);
uint32_t down(uint32_t k)
{
    return (k > 1U) ? (k * down(k - 1U)) + sink[k & 7U] + down(k / 2U) : 1U;
}
void through(void (*how)(void));
void through(void (*how)(void))
{
    how();
    sink[0] = 1U;
}
void endless(uint32_t n);
void endless(uint32_t n)
{
    for (uint32_t i = 0U; i < n; i++)
    {
        sink[i & 7U] = sink[(i * 3U) & 7U] + i;
    }
}
void fixed(uint32_t n);
void fixed(uint32_t n)
{
    for (uint32_t i = 0U; i < 100U; i++)
    {
        sink[(i * n) & 7U] = sink[(i * 3U) & 7U] + i;
    }
}
void grows(uint32_t n);
void grows(uint32_t n)
{
    volatile uint32_t room[n];
    room[n - 1U] = 1U;
    sink[0] = room[n - 1U];
}
"""


def test_behind_a_smashed_stack_stands_another_function(tmp_path, needs):
    # a hardened compiler's call does not return: read on, it would give a function the loops of the next
    needs("gcc")
    source = (
        "int guarded(const volatile int *x) { volatile int y[8]; y[*x & 7] = *x; return y[0]; }\n"
        "int turning(const volatile int *x)\n{\n    int y = 0;\n"
        "    for (int i = 0; i < 9; i++)\n    {\n        y += *x;\n    }\n    return y;\n}\n"
    )
    (tmp_path / "two.c").write_text(source)
    command = ["gcc", "-O1", "-fstack-protector-all", "-fcf-protection=none", "-c", "two.c", "-o", "two.o"]
    subprocess.run(command, cwd=tmp_path, check=True)
    image = read_image(tmp_path / "two.o")
    assert "__stack_chk_fail" in image.undefined
    analysis = Analysis(image)
    assert (analysis.cycles("guarded"), analysis.cycles("turning")) == (0, 1)


@pytest.mark.parametrize("target", ["host", *CROSS])
def test_what_cannot_be_bounded_says_why(target, tmp_path, needs):
    toolchain = find_toolchain(TARGETS[target])
    needs(toolchain.compiler.label)
    (tmp_path / "faults.c").write_text(C)
    flags = [item for item in toolchain.flags if item != "-ffunction-sections"]
    toolchain.compiler.run([*flags, "-c", "faults.c", "-o", "faults.o"], tmp_path)
    if target != "host":
        toolchain.compiler.run([*flags, "-nostartfiles", "-Wl,-e,down", "faults.o", "-o", "faults.elf"], tmp_path)
    name = "faults.o" if target == "host" else "faults.elf"
    analysis = Analysis(read_image(tmp_path / name), source_loops(C), "faults.c")
    told = {name: str(analysis.instructions(name)) for name in ("down", "through", "endless", "fixed", "absent")}
    assert re.fullmatch(r"unknown because of recursion through down(\.\w+)?", told["down"]), told
    assert told["through"] == "unknown because of an indirect call in through"
    line = C.split("\n").index("    for (uint32_t i = 0U; i < n; i++)") + 1
    assert told["endless"] == f"unknown because of the loop in line {line} of faults.c, whose trips are not fixed"
    assert 300 < int(told["fixed"]) < 3000
    assert told["absent"] == f"unknown because of no function 'absent' in {name}"
    assert isinstance(analysis.stack("grows"), Unknown)
    assert isinstance(analysis.stack("fixed"), int)


@pytest.mark.slow
@pytest.mark.parametrize("precision", ["double", "float"])
@pytest.mark.parametrize("target", ["host", *CROSS])
def test_frames_are_those_that_the_compiler_states(target, precision, tmp_path, needs):
    """-fstack-usage of gcc, function by function: the deepest of an own frame, callees left out."""
    toolchain = find_toolchain(TARGETS[target])
    needs(toolchain.compiler.label)
    text = emit(attitude_ekf, precision)
    toolchain.compile({f"{text.name}.h": text.header, f"{text.name}.c": text.source}, tmp_path)
    flags = [*toolchain.flags, "-ffp-contract=off", "-fstack-usage", "-c", f"{text.name}.c"]
    toolchain.compiler.run(flags, tmp_path)
    analysis = Analysis(read_image(tmp_path / f"{text.name}.o"))
    rows = [line.split("\t") for line in (tmp_path / f"{text.name}.su").read_text().strip().split("\n")]
    compared = 0
    for place, size, kind in rows:
        name = place.split(":")[-1]
        assert kind == "static"
        if analysis.image.function_named(name) is not None and not name.endswith("_status_text"):
            assert analysis.frame(name) == int(size), name
            compared += 1
    assert compared > 8
