"""Calls in the emulator: answers, instruction counts and stack, each against an independent witness; and what goes wrong."""

import re
import subprocess
from dataclasses import replace

import numpy as np
import pytest
from elftools.elf.elffile import ELFFile
from plantc.codegen import emulator
from plantc.codegen.compiler import CompilerError
from plantc.codegen.emit import emit
from plantc.codegen.emulator import Call, TargetView
from plantc.codegen.layout import flatten
from plantc.codegen.on_target import first_difference, free_trace
from plantc.codegen.targets import TARGETS, TargetError
from plantc.examples.quadrotor_ekf import quadrotor_kf
from plantc.symbolic import controllers

from plantc import Block, NativeView, Status

CROSS = ["cortex-m4", "cortex-m7", "rv32"]


def low_pass(**options):
    block = Block("low_pass", doc="first-order low-pass filter")
    raw = block.input("raw", unit="V", range=(-10, 10))
    weight = block.parameter("weight", 0.1, range=(0, 1)) if options.get("tunable", True) else 0.25
    smooth = block.memory("smooth", unit="V", range=(-10, 10))
    following = smooth + weight * (raw - smooth)
    block.entry("step", inputs=[raw], following={smooth: following}, outputs={"filtered": following})
    return block


@pytest.fixture
def view(needs):
    """Make a view of a target, or skip where its tools are missing."""

    def make(name, block=None, precision="float", **options):
        target = TARGETS[name]
        needs(f"{target.prefix}gcc", target.emulator)
        return TargetView(block or low_pass(), precision, target, **options)

    return make


def edited(block, precision, old, new):
    """The C of a block with one piece replaced."""
    text = emit(block, precision)
    assert old in text.source
    return replace(text, source=text.source.replace(old, new, 1))


# -- answers ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("tunable", [True, False])
@pytest.mark.parametrize("precision", ["float", "double"])
@pytest.mark.parametrize("name", CROSS)
def test_calls_answer_like_the_native_view(view, name, precision, tunable):
    block = low_pass(tunable=tunable)
    native, target = NativeView(block, precision), view(name, block, precision)
    params = native.params()
    calls = [
        Call("step", native.inputs("step", {"raw": value}), native.memory(smooth=start), params)
        for value, start in ((1.0, 0.5), (11.0, 0.5), (np.nan, -2.0), (-3.0, 0.1), (1e-40, 0.0))
    ]
    answers = target.calls(calls)
    for call, ours in zip(calls, answers, strict=True):
        theirs = native.call("step", call.memory, call.inputs, params)
        assert ours.status == theirs.status
        assert ours.memory.tobytes() == theirs.memory.tobytes()
        assert ours.outputs.tobytes() == theirs.outputs.tobytes()
    assert {item.status for item in answers} == {Status.OK, Status.BAD_INPUT}
    one = target.call("step", calls[0].memory, calls[0].inputs, params)
    assert one.memory.tobytes() == answers[0].memory.tobytes()


def test_parameters_and_memory_travel(view):
    native, target = NativeView(low_pass(), "float"), view("cortex-m4")
    for weight in (0.25, 0.75):
        params = native.params(weight=weight)
        answer = target.call("step", native.memory(smooth=2.0), native.inputs("step", {"raw": 4.0}), params)
        assert answer.memory["smooth"] == 2.0 + weight * 2.0


@pytest.mark.parametrize("name", CROSS)
def test_a_free_run_is_one_run_of_the_emulator(view, name, monkeypatch):
    target = view(name, quadrotor_kf)
    runs = []
    whole = TargetView._emulate
    monkeypatch.setattr(TargetView, "_emulate", lambda self, folder: (runs.append(1), whole(self, folder)))
    trace = free_trace(quadrotor_kf, 60)
    answered = target.run(trace)
    assert len(runs) == 1
    assert first_difference(NativeView(quadrotor_kf, "float").run(trace), answered, "native", name) is None
    again = target.run(trace, memory=target.memory())
    assert again.calls[0].entry == trace.calls[0].entry


def test_a_refused_init_is_a_sentence(view):
    target = view("cortex-m4")
    with pytest.raises(ValueError, match=r"init refused the parameters .BAD_PARAM."):
        target.run(free_trace(low_pass(), 5), params=target.params(weight=2.0))


# -- costs ------------------------------------------------------------------------------------------------------------


def executed(target, entry, folder):
    """Instructions from an entry's first to its return, from QEMU's own log of every instruction, for each call."""
    with target.path.open("rb") as stream:
        table = ELFFile(stream).get_section_by_name(".symtab")
        places = {item.name: item["st_value"] & ~1 for item in table.iter_symbols()}
        spans = {item.name: (item["st_value"] & ~1, item["st_size"]) for item in table.iter_symbols()}
    start, (caller, size) = places[f"{target.block.name}_{entry}"], spans["measured_call"]
    command = [target.emulator, *target.target.machine, "-nographic", "-monitor", "none", "-serial", "none"]
    command += ["-semihosting-config", "enable=on,target=native", "-kernel", str(target.path)]
    log = folder / "log"
    subprocess.run([*command, "-singlestep", "-d", "exec,nochain", "-D", str(log)], cwd=folder, check=True, timeout=60)
    counts, inside = [], None
    for line in log.read_text().splitlines():
        found = re.search(r"\[[0-9a-f]+/([0-9a-f]+)/", line)
        if line.startswith("Stopped execution") and inside is not None:
            inside -= 1  # the line before was not executed after all
        if found is None:
            continue
        address = int(found[1], 16)
        if address == start and inside is None:
            inside = 0
        elif inside is not None and caller <= address < caller + size:
            counts.append(inside)
            inside = None
        if inside is not None:
            inside += 1
    return counts


@pytest.mark.parametrize("name", CROSS)
def test_instructions_are_those_of_the_emulators_log(view, name, tmp_path):
    target = view(name, quadrotor_kf, "float")
    trace = free_trace(quadrotor_kf, 4)
    params = target.params()
    calls = [Call("init", target.inputs("init", {}), target.memory(), params)]
    calls += [Call(item.entry, target.inputs(item.entry, item.inputs)) for item in trace.calls]
    target.calls(calls)
    (tmp_path / "calls.bin").write_bytes(target._packed(calls))
    for entry in ("init", "step"):
        ours = [cost.instructions for cost, call in zip(target.last, calls, strict=True) if call.entry == entry]
        assert ours == executed(target, entry, tmp_path)
        assert ours
        assert min(ours) > 20


@pytest.mark.parametrize("name", CROSS)
def test_the_painted_stack_sees_what_a_call_uses(view, name):
    plain = view(name)
    params, memory, inputs = plain.params(), plain.memory(), plain.inputs("step", {"raw": 1.0})
    plain.call("step", memory, inputs, params)
    opening = "low_pass_step(low_pass_state_t *state, const low_pass_params_t *params, const low_pass_step_in_t *in"
    source = emit(low_pass(), "float").source
    body = source.index("{", source.index(opening)) + 1
    hungry = "\n    volatile unsigned char pit[1024];\n    for (int k = 0; k < 1024; k++) { pit[k] = pit[0]; }\n"
    text = replace(emit(low_pass(), "float"), source=source[:body] + hungry + source[body:])
    deep = view(name, text=text)
    deep.call("step", memory, inputs, params)
    assert 1024 <= deep.most["step"].stack - plain.most["step"].stack + 64 <= 1200
    assert deep.most["step"].instructions > plain.most["step"].instructions + 1024


def test_the_most_of_all_calls_is_kept(view):
    target = view("cortex-m4")
    params, memory = target.params(), target.memory()
    good, bad = (target.inputs("step", {"raw": value}) for value in (1.0, np.nan))
    target.calls([Call("step", bad, memory, params), Call("step", good, memory, params), Call("step", bad)])
    refused, accepted, again = (item.instructions for item in target.last)
    assert refused == again < accepted == target.most["step"].instructions


# -- what goes wrong --------------------------------------------------------------------------------------------------


def broken(statement):
    """A low-pass whose `step` begins with a statement."""
    text = emit(low_pass(), "float")
    start = text.source.index("{", text.source.index("low_pass_step(")) + 1
    return replace(text, source=text.source[:start] + f"\n    {statement}\n" + text.source[start:])


@pytest.mark.parametrize(
    ("statement", "words"),
    [
        ("__builtin_trap();", "the processor met a fault"),
        (
            "volatile unsigned char pit[40000]; for (int k = 0; k < 40000; k++) { pit[k] = pit[0]; }",
            "a call used more than the 32768 bytes of stack",
        ),
        ("volatile int k = 0; while (k == 0) { }", "did not end within 2 s"),
    ],
)
@pytest.mark.parametrize("name", ["cortex-m4", "rv32"])
def test_a_program_that_does_not_end_well_is_a_sentence(view, name, statement, words, monkeypatch):
    monkeypatch.setattr(emulator, "TIMEOUT", 2.0)
    target = view(name, text=broken(statement))
    with pytest.raises(TargetError, match=f"low_pass on {name}: .*{words}"):
        target.call("step", target.memory(), target.inputs("step", {"raw": 1.0}), target.params())


def test_structs_laid_out_otherwise_do_not_compile(view):
    """The runner checks sizes and offsets that Python assumes: short enums would shift them."""
    text = emit(low_pass(), "float")
    header = text.header.replace("} low_pass_state_t;", "    float more;\n} low_pass_state_t;")
    assert header != text.header
    with pytest.raises(CompilerError, match="size_of_low_pass_state_t"):
        view("cortex-m4", text=replace(text, header=header))
    header = text.header.replace("float smooth;", "float more;\n    float smooth;")
    with pytest.raises(CompilerError, match="low_pass_state_t_1"):
        view("cortex-m4", text=replace(text, header=header))


def test_every_field_comes_back(view):
    target = view("cortex-m4", quadrotor_kf)
    memory = target.memory()
    for k, name in enumerate(flatten(memory)):
        memory[name] = k + 1
    answer = target.call("predict", memory, target.inputs("predict", {"rotor_1": np.nan}), target.params())
    assert answer.status == Status.BAD_INPUT
    assert answer.memory.tobytes() == memory.tobytes()


@pytest.mark.parametrize("name", ["rv32", "cortex-m4"])
def test_what_the_program_itself_uses_between_calls_is_not_told_of_a_call(name, needs):
    """So many calls that they are read in pieces: a call without a frame, right after a piece, shows none."""
    needs("arm-none-eabi-gcc", "riscv64-unknown-elf-gcc", "qemu-system-arm", "qemu-system-riscv32")
    block = controllers.low_pass(1.0, dt=0.01)
    target, native = TargetView(block, "float", TARGETS[name]), NativeView(block, "float")
    params = native.params()
    target.calls([Call("init", None, native.init(params), params)] * 3000)
    assert target.most["init"].stack == 0
