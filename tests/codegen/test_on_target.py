"""Targets against the host: the same bits, or within a tolerance that is said; and planted faults that are seen."""

import json
import re
from dataclasses import replace

import pytest
from plantc.codegen import on_target
from plantc.codegen.compiler import CompilerError
from plantc.codegen.costs import read
from plantc.codegen.crosscheck import CrossCheck, make_probes, make_views
from plantc.codegen.emit import emit
from plantc.codegen.emulator import TargetView
from plantc.codegen.on_target import (
    FREE_STEPS,
    agrees_bit_for_bit,
    chosen_targets,
    first_difference,
    free_trace,
    measure_targets,
    run_on_target,
    trace_hash,
)
from plantc.codegen.options import Options
from plantc.codegen.style import Precision
from plantc.codegen.targets import TARGETS, TargetError, find_toolchain
from plantc.examples.attitude_ekf import attitude_ekf
from plantc.examples.jump_systems import relay_estimator, spring_estimator
from plantc.examples.pendulum import pendulum_ekf
from plantc.examples.quadrotor_ekf import quadrotor_ekf, quadrotor_kf
from plantc.examples.quadrotor_regulator import quadrotor_together_regulator

from plantc import NativeView

CROSS = ("cortex-m4", "cortex-m7", "rv32")
TOOLS = ("arm-none-eabi-gcc", "riscv64-unknown-elf-gcc", "qemu-system-arm", "qemu-system-riscv32")


def checked(block, precision, steps=20, text=None):
    """The native view and the calls of a cross-check, answered by it and by nobody else."""
    native = NativeView(block, precision, text=text)
    probes = make_probes(block, precision, make_views(block, precision, native), steps, 0)
    for probe in probes:
        probe.answer = native.call(probe.entry, probe.memory, probe.inputs, probe.params)
    return native, CrossCheck([], {}, probes)


def on(name, block, precision, needs, steps=40, probed=20, against=None, **options):
    """Run a target against the native view: (lockstep, free run, facts)."""
    needs(f"{TARGETS[name].prefix}gcc", TARGETS[name].emulator)
    native, check = checked(block, precision, probed, against)
    view = TargetView(block, precision, TARGETS[name], **options)
    found = run_on_target(view, native, check, native.run(free_trace(block, steps)))
    return (*found.checks[:2], found.facts)


# -- the same bits ----------------------------------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.parametrize(
    ("block", "precision"),
    [
        *[(block, "float") for block in (pendulum_ekf, quadrotor_ekf, attitude_ekf)],
        *[(block, "double") for block in (quadrotor_ekf, pendulum_ekf)],
        *[(block, "float") for block in (quadrotor_together_regulator, spring_estimator, relay_estimator)],
    ],
    ids=lambda item: getattr(item, "name", item),
)
def test_host_and_targets_agree_bit_for_bit(block, precision, needs):
    needs(*TOOLS)
    text = emit(block, precision)
    assert agrees_bit_for_bit(text, contract=False)
    _, check = checked(block, precision, steps=30)
    found = measure_targets(block, Options(Precision(precision), CROSS), text, check)
    assert [(item.name, item.passed, str(item.mismatch)) for item in found.checks if not item.passed] == []
    compared = [item for item in found.checks if "= native" in item.name]
    assert len(compared) == 6
    assert all(item.note == "bit for bit" for item in compared)
    facts = found.facts["targets"]
    assert list(facts) == ["host", *CROSS]
    assert len({item["free_run"]["hash"] for item in facts.values()}) == 1
    assert {item["free_run"]["steps"] for item in facts.values()} == {len(free_trace(block, FREE_STEPS).calls)}


@pytest.mark.slow
@pytest.mark.parametrize("name", CROSS)
def test_the_zig_wheel_gives_the_same_bits(name, needs):
    needs("python:ziglang")
    toolchain = find_toolchain(TARGETS[name], kind="zig")
    lockstep, free, facts = on(name, quadrotor_ekf, "float", needs, toolchain=toolchain)
    assert lockstep.passed, lockstep.mismatch
    assert free.passed, free.mismatch
    assert facts["toolchain"]["label"] == "zig"


@pytest.mark.parametrize("name", CROSS)
def test_a_fault_on_the_target_is_seen(name, needs):
    """One constant of the target's C is off by its last bit."""
    text = emit(quadrotor_kf, "float")
    assert "0.24525f" in text.source
    bent = replace(text, source=text.source.replace("0.24525f", "0.24525002f"))
    lockstep, free, _ = on(name, quadrotor_kf, "float", needs, text=bent)
    for check in (lockstep, free):
        assert not check.passed
        assert f"{name} gives" in str(check.mismatch)
        assert "native gives" in str(check.mismatch)
        assert check.mismatch.entry in ("predict", "step")


@pytest.mark.slow
@pytest.mark.parametrize("name", ["cortex-m4", "cortex-m7"])
def test_a_last_bit_of_software_double_is_judged_by_tolerance(name, needs):
    """A Cortex-M4F's software double does not always round as IEEE 754 says; a Cortex-M7 has no such excuse."""
    text = emit(quadrotor_kf, "double")
    assert "(0.24525 *" in text.source
    bent = replace(text, source=text.source.replace("(0.24525 *", "(0.2452500000000001 *"))
    lockstep, free, facts = on(name, quadrotor_kf, "double", needs, text=bent)
    assert not facts["free_run"]["equal_to_host"]
    if name == "cortex-m4":
        assert lockstep.passed
        assert 0 < lockstep.worst < 1e-9
        assert "does not always round as IEEE 754 says" in lockstep.note
        assert free.verdict == "not judged"
        assert "does not always round as IEEE 754 says" in free.remark
    else:
        assert not lockstep.passed
        assert not free.passed
    grossly = replace(text, source=text.source.replace("(0.24525 *", "(0.24526 *"))
    lockstep, _, _ = on(name, quadrotor_kf, "double", needs, text=grossly)
    assert not lockstep.passed


def test_a_status_that_differs_is_seen(needs):
    text = emit(quadrotor_kf, "float")
    bent = replace(text, source=text.source.replace("<= 10000.0f", "<= 9999.0f"))
    lockstep, _, _ = on("cortex-m4", quadrotor_kf, "float", needs, text=bent)
    assert not lockstep.passed
    assert lockstep.mismatch.signal == "status"


def test_the_first_difference_of_two_runs_is_named():
    trace = free_trace(quadrotor_kf, 8)
    ours = NativeView(quadrotor_kf, "float").run(trace)
    theirs = NativeView(quadrotor_kf, "float").run(trace)
    assert first_difference(ours, theirs, "a", "b") is None
    assert trace_hash(ours) == trace_hash(theirs)
    theirs.calls[5].memory["covariance"][3] = 7.0
    assert trace_hash(ours) != trace_hash(theirs)
    found = first_difference(ours, theirs, "a", "b")
    assert (found.step, found.signal, found.right_value) == (5, "memory covariance[3]", "7.0")
    # minus zero is another bit pattern, and so seen
    theirs.calls[2].memory["x"][0] = -0.0
    ours.calls[2].memory["x"][0] = 0.0
    assert first_difference(ours, theirs, "a", "b").signal == "memory x"


# -- within a tolerance -----------------------------------------------------------------------------------------------


def test_what_double_refuses_may_differ_between_machines(needs):
    """Singular noise on the adversarial trace: float accepts by rounding alone, and fused operations round otherwise."""
    lockstep, _, _ = on("cortex-m4", attitude_ekf, "float", needs, probed=60, contract=True)
    assert lockstep.passed, lockstep.mismatch
    assert lockstep.at_switches + lockstep.ill_conditioned > 0
    assert lockstep.at_switches + lockstep.ill_conditioned < 0.03 * lockstep.calls


@pytest.mark.parametrize("name", ["cortex-m4", "cortex-m7"])
def test_contracted_code_is_compared_within_a_tolerance(name, needs):
    lockstep, free, facts = on(name, quadrotor_kf, "float", needs, contract=True)
    assert lockstep.passed, lockstep.mismatch
    assert 0 < lockstep.worst < 1e-3  # it does differ, so bits could not be asked for
    assert lockstep.limit == quadrotor_kf.float_bound
    assert "may be fused" in lockstep.note
    assert free.passed
    assert not facts["free_run"]["equal_to_host"]
    assert facts["free_run"]["worst"] > 0
    assert "-ffp-contract=fast" in facts["toolchain"]["flags"]


def test_with_the_c_librarys_functions_targets_are_compared_within_a_tolerance(needs):
    """newlib's cosf for a Cortex-M4 is another than glibc's."""
    text = emit(quadrotor_ekf, "float", mathematics="libm")
    lockstep, free, facts = on("cortex-m4", quadrotor_ekf, "float", needs, steps=FREE_STEPS, text=text, against=text)
    assert lockstep.passed, lockstep.mismatch
    assert lockstep.limit == quadrotor_ekf.float_bound
    assert "C libraries differ" in lockstep.note
    assert free.passed
    assert not facts["free_run"]["equal_to_host"]
    assert 0 < facts["free_run"]["worst"] < 0.01


def test_a_fault_beyond_the_tolerance_is_seen(needs):
    text = emit(quadrotor_kf, "float")
    bent = replace(text, source=text.source.replace("0.24525f", "0.3f"))
    lockstep, _, _ = on("cortex-m4", quadrotor_kf, "float", needs, text=bent, contract=True)
    assert not lockstep.passed
    assert lockstep.mismatch.left == "cortex-m4"


def test_code_that_calls_the_c_library_promises_no_bits():
    text = emit(quadrotor_kf, "float")
    assert agrees_bit_for_bit(text, contract=False)
    assert not agrees_bit_for_bit(text, contract=True)
    for call in ("sinf(x)", "pow(x, y)", "atan2f(y, x)"):
        assert not agrees_bit_for_bit(replace(text, source=f"{text.source}\nfloat f = {call};\n"), contract=False)
    for harmless in ("quadrotor_kf_sinf(x)", "sqrtf(x)", "fabs(x)", "/* sin(x) */"):
        assert agrees_bit_for_bit(replace(text, source=f"{text.source}\n{harmless};\n"), contract=False)


# -- what it costs ----------------------------------------------------------------------------------------------------


def test_the_evidence_of_a_target(needs):
    _, _, facts = on("cortex-m4", quadrotor_kf, "float", needs)
    json.dumps(facts)
    assert facts["toolchain"]["label"] == "arm-none-eabi-gcc"
    assert "-mfpu=fpv4-sp-d16" in facts["toolchain"]["flags"]
    assert "-ffp-contract=off" in facts["toolchain"]["flags"]
    assert "mps2-an386" in facts["emulator"]
    assert set(facts["instructions"]) == set(facts["stack"]) == set(quadrotor_kf.entries)
    assert facts["instructions"]["step"] > facts["instructions"]["predict"] > 100
    assert facts["stack"]["step"] > 4 * 78  # it holds a candidate of the covariance
    assert facts["object"]["data"] == facts["object"]["bss"] == 0
    assert facts["linked"]["text"] > facts["object"]["text"] > 1000
    assert facts["ram"]["needed"] > facts["stack"]["step"]
    assert facts["instructions"]["step"] <= facts["instruction_bound"]["step"] < 10 * facts["instructions"]["step"]


def test_the_evidence_of_the_host(needs):
    """Nothing is counted there, so nothing is said to be; bounds are read from its machine code."""
    needs("gcc")
    _, check = checked(quadrotor_kf, "float", 5)
    facts = measure_targets(quadrotor_kf, Options(Precision("float")), emit(quadrotor_kf, "float"), check).facts
    host = facts["targets"]["host"]
    json.dumps(host)
    for quantity, word in (("instructions", "not counted: "), ("stack", "not painted: ")):
        costs = read(quantity, host)
        assert set(costs) == set(quadrotor_kf.entries)
        assert all(str(cost.seen).startswith(word) for cost in costs.values())
        assert costs["step"].bound > costs["predict"].bound > 100
    assert read("stack", host)["step"].bound > 4 * 78  # it holds a candidate of the covariance


def test_the_host_has_no_bound_from_a_compiler_whose_code_is_not_followed(needs, monkeypatch):
    needs("clang")
    monkeypatch.setenv("CC", "clang")
    _, check = checked(pendulum_ekf, "float", 5)
    facts = measure_targets(pendulum_ekf, Options(Precision("float")), emit(pendulum_ekf, "float"), check).facts
    bound = read("instructions", facts["targets"]["host"])["step"].bound
    assert re.match(r"unknown because of the compiler: only code of gcc is bounded, this is of .*clang", bound)


@pytest.mark.parametrize(("what", "sizes"), [("flash", {"flash": 8192}), ("RAM", {"ram": 2048})])
def test_code_that_does_not_fit_is_told(what, sizes, needs):
    needs("arm-none-eabi-gcc", "qemu-system-arm")
    native, check = checked(quadrotor_kf, "float")
    view = TargetView(quadrotor_kf, "float", TARGETS["cortex-m4"].with_sizes(**sizes))
    words = (
        rf"quadrotor_kf does not fit cortex-m4: it needs \d+ bytes of {what}, there are {next(iter(sizes.values()))};"
    )
    with pytest.raises(TargetError, match=words):
        run_on_target(view, native, check, native.run(free_trace(quadrotor_kf, 5)))


def test_the_ram_that_is_needed_holds_the_bound_on_the_stack(needs, monkeypatch):
    """A chip with room for the stack that was seen, and not for its bound, is refused; without a bound none is claimed."""
    needs("riscv64-unknown-elf-gcc", "qemu-system-riscv32")
    native, check = checked(pendulum_ekf, "float", 5)
    view = TargetView(pendulum_ekf, "float", TARGETS["rv32"])
    ours = native.run(free_trace(pendulum_ekf, 5))
    facts = run_on_target(view, native, check, ours).facts
    costs, needed = read("stack", facts), facts["ram"]["needed"]
    bound, seen = (max(getattr(cost, what) for cost in costs.values()) for what in ("bound", "seen"))
    assert seen < bound
    view.target = view.target.with_sizes(ram=needed - 1)
    with pytest.raises(TargetError, match=rf"needs {needed} bytes of RAM, there are {needed - 1};"):
        run_on_target(view, native, check, ours)
    unknown = dict.fromkeys(costs, (on_target.Unknown("planting"), on_target.Unknown("planting")))
    monkeypatch.setattr(on_target, "_bounds", lambda *_: unknown)
    facts = run_on_target(view, native, check, ours).facts
    assert facts["ram"]["needed"] == f"unknown, at least {needed - bound + seen}"
    assert "unknown because of planting" in facts["ram"]["note"]


def test_an_unknown_target_is_refused_before_any_work():
    with pytest.raises(TargetError, match="no target 'avr'"):
        chosen_targets(Options(targets=("avr",)))


def test_a_missing_tool_is_told_before_any_work(monkeypatch, needs):
    needs("arm-none-eabi-gcc")
    monkeypatch.setattr(on_target, "find_emulator", lambda target: (_ for _ in ()).throw(TargetError("no emulator")))
    with pytest.raises(TargetError, match="no emulator"):
        chosen_targets(Options(targets=("host", "cortex-m4")))
    assert [target.name for target in chosen_targets(Options())] == ["host"]
    assert issubclass(TargetError, CompilerError)


@pytest.mark.slow
def test_the_figures_of_the_page_are_what_is_measured(needs, checkout):
    """Another compiler or a better emitter moves them a little; a page that is a tenth off is out of date."""
    needs(*TOOLS)
    rows = re.findall(
        r"^\| (float|double) \| ([a-z0-9-]+) \| (\d+) \| (\d+) \| (\d+) % \|$",
        (checkout / "docs/targets.md").read_text(),
        re.MULTILINE,
    )
    assert {(precision, name) for precision, name, *_ in rows} == {(p, n) for p in ("float", "double") for n in CROSS}
    for precision, name, *told in rows:
        counts = []
        for contract in (False, True):
            view = TargetView(quadrotor_ekf, precision, TARGETS[name], contract=contract)
            view.run(free_trace(quadrotor_ekf, FREE_STEPS))
            counts.append(view.most["step"].instructions)
        for said, seen in zip(told, counts, strict=False):
            assert abs(int(said) - seen) < 0.1 * seen, (precision, name, told, counts)
        assert abs(int(told[2]) - 100 * (1 - counts[1] / counts[0])) < 3, (precision, name, told, counts)
