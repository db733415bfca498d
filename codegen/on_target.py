"""What an export finds out on its targets: whether they agree with the host, and what the code costs there."""

from __future__ import annotations

import hashlib
import math
import re
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from ..symbolic.block import Block
from .bounds import Analysis, Bound, Unknown, source_loops
from .compiler import contraction_flag
from .costs import Cost, deepest, reasons, within, written
from .crosscheck import DOUBLE_BOUND, CrossCheck, FrozenStream, Probe, compare_answers, default_scenario
from .emit import CText
from .emulator import Call, TargetView
from .findings import CheckResult, Findings, Mismatch
from .gates import build_plain, object_gates
from .layout import flatten, inputs_dtype, memory_dtype, outputs_dtype, params_dtype
from .objects import ObjectError, read_image
from .options import Options
from .style import Precision
from .targets import Sizes, Target, TargetError, Toolchain, find_emulator, find_toolchain, linked_library, target_named
from .trace import Trace, TraceCall
from .views import Answer, NativeView, View

FREE_STEPS = 500
"""Length of the free run that is compared bit for bit."""

_LIBRARY_CALL = re.compile(
    r"\b(sin|cos|tan|asin|acos|atan|atan2|exp|log|pow|tanh|sinh|cosh|log1p|expm1|hypot|fmod)f?\("
)
"""Functions of the C library whose last bits differ from one library to the next; sqrt, fabs and floor are exact."""


def chosen_targets(options: Options) -> list[Target]:
    """Return the targets of an export, the host first.

    Raises
    ------
    TargetError
        If one is not known, or a tool it needs is not installed.
    """
    targets = [target_named("host")]
    for name in options.targets:
        target = target_named(name)
        if target.is_host:
            continue
        find_toolchain(target)
        find_emulator(target)
        targets.append(target.with_sizes(options.flash or None, options.ram or None))
    return targets


def agrees_bit_for_bit(text: CText, contract: bool) -> bool:
    """Whether the C promises the same bits everywhere: nothing is fused, and no function of the C library is inexact."""
    code = re.sub(r"/\*.*?\*/", " ", text.source, flags=re.DOTALL)
    return not contract and _LIBRARY_CALL.search(code) is None


def measure_targets(block: Block, options: Options, text: CText, check: CrossCheck) -> Findings:
    """Run the calls of a cross-check, and a free run, on every chosen target, and say what was found.

    Parameters
    ----------
    block : Block
        What is exported.
    options : Options
        The choices; ``targets`` are the machines.
    text : CText
        The C.
    check : CrossCheck
        The finished cross-check: its calls carry what the native view answered.

    Returns
    -------
    Findings
        Two checks for each target; facts under ``targets``, by name.

    Raises
    ------
    TargetError
        If a tool is missing, or the code does not fit a target.
    """
    precision = options.precision.name
    native = NativeView(block, precision, text=text, contract=options.contract)
    free = free_trace(block, FREE_STEPS)
    ours = native.run(free)
    checks: list[CheckResult] = []
    facts: dict[str, Any] = {}
    for target in chosen_targets(options):
        if target.is_host:
            facts[target.name] = {**_host_facts(block, target, text, options.contract), "free_run": _free_facts(ours)}
            continue
        view = TargetView(block, precision, target, text=text, contract=options.contract)
        found = run_on_target(view, native, check, ours)
        checks += found.checks
        facts[target.name] = found.facts
    return Findings(checks, {"targets": facts})


def run_on_target(view: TargetView, native: View, check: CrossCheck, ours: Trace) -> Findings:
    """Compare a target with the native view, in lockstep and in a free run, and state what its calls cost.

    Parameters
    ----------
    view : TargetView
        The target.
    native : View
        What it is compared with.
    check : CrossCheck
        Calls with the native view's answers.
    ours : Trace
        The native view's free run.
    """
    name, block = view.target.name, view.block
    probes = [probe for probe in check.calls if probe.answer is not None]
    answers = view.calls([Call(probe.entry, probe.inputs, probe.memory, probe.params) for probe in probes])
    label = f"{name} = native"
    theirs = view.run(ours)
    difference = first_difference(ours, theirs, "native", name)
    exact = agrees_bit_for_bit(view.text, view.contract)
    lockstep = equal_answers(label, probes, answers)
    if _may_misround(view) and not (lockstep.passed and difference is None):
        exact = False
    if not exact:
        limit = DOUBLE_BOUND if view.precision.name == "double" else block.float_bound
        lockstep = compare_answers(block, view.precision.name, native, label, probes, answers, limit)
        lockstep.note = lockstep.note or "within a tolerance: " + _why_not_exact(view)
    free = CheckResult(f"{name} = native, free run", not exact or difference is None, calls=len(ours))
    if exact:
        free.mismatch = difference
        free.note = "bit for bit"
    else:
        free.not_judged = f"up to {drift(block, ours, theirs):.1e} apart; {_why_not_exact(view)}"
    costs = _target_costs(view)
    facts = {**costs.facts, "free_run": {**_free_facts(theirs), "equal_to_host": difference is None}}
    if not exact:
        facts["free_run"]["worst"] = float(f"{drift(block, ours, theirs):.3g}")
    return Findings([lockstep, free, *costs.checks], facts)


def _may_misround(view: TargetView) -> bool:
    """Whether the target's own arithmetic is not IEEE 754's.

    On a Cortex-M4F double is software: gcc 12's libgcc rounds 1 - b the wrong way for half of the b between 2^-33 and 2^-32,
    and the zig wheel's division is not rounded to nearest where its result is subnormal.
    """
    return view.precision.name == "double" and view.target.name == "cortex-m4"


def _why_not_exact(view: TargetView) -> str:
    if view.contract:
        return "products and sums may be fused"
    if agrees_bit_for_bit(view.text, view.contract):
        return "double is software on this target, and does not always round as IEEE 754 says"
    return "functions of two C libraries differ in their last bits"


# ---------------------------------------------------------------------------------------------------------------------
# Bit for bit


def _fields(answer: Answer) -> Iterator[tuple[str, Any]]:
    for where, record in (("memory", answer.memory), ("outputs", answer.outputs)):
        for name, value in flatten(record).items():
            yield f"{where} {name}", value


def equal_answers(label: str, probes: list[Probe], answers: list[Answer]) -> CheckResult:
    """Compare answers of the target with those of the native view: status and every bit of memory and outputs."""
    result = CheckResult(label, True, calls=len(probes), note="bit for bit")
    left, right = label.split(" = ")
    for probe, answer in zip(probes, answers, strict=True):
        assert probe.answer is not None
        rows = [("status", np.array([int(answer.status)]), np.array([int(probe.answer.status)]))]
        rows += [(name, a, b) for (name, a), (_, b) in zip(_fields(answer), _fields(probe.answer), strict=True)]
        found = _first_unequal(rows)
        if found is not None:
            name, a, b = found
            result.passed = False
            result.mismatch = _mismatch(probe.trace, probe.step, probe.entry, name, (left, a), (right, b))
            break
    return result


def _first_unequal(rows: list[tuple[str, Any, Any]]) -> tuple[str, Any, Any] | None:
    for name, a, b in rows:
        if a.tobytes() != b.tobytes():
            k = next(i for i in range(len(a)) if a[i].tobytes() != b[i].tobytes())
            return f"{name}[{k}]" if len(a) > 1 else name, a[k].item(), b[k].item()
    return None


def _mismatch(
    trace: str, step: int, entry: str, signal: str, left: tuple[str, Any], right: tuple[str, Any]
) -> Mismatch:
    difference = abs(float(left[1]) - float(right[1]))
    return Mismatch(trace, step, entry, signal, left[0], repr(left[1]), right[0], repr(right[1]), difference)


def first_difference(ours: Trace, theirs: Trace, left: str, right: str) -> Mismatch | None:
    """Return the first step and signal in which two runs of one trace differ by a bit, or None."""
    for step, (a, b) in enumerate(zip(ours.calls, theirs.calls, strict=True)):
        rows = [("status", np.array([_number(a)]), np.array([_number(b)]))]
        rows += [(f"memory {name}", a.memory[name], b.memory[name]) for name in a.memory]
        rows += [(f"outputs {name}", a.outputs[name], b.outputs[name]) for name in a.outputs]
        found = _first_unequal(rows)
        if found is not None:
            return _mismatch(ours.name, step, a.entry, found[0], (left, found[1]), (right, found[2]))
    return None


def _number(call: TraceCall) -> int:
    assert call.status is not None
    return int(call.status)


def trace_hash(trace: Trace) -> str:
    """Return a hash of every status and every bit that a run left in memory and outputs."""
    digest = hashlib.sha256()
    for call in trace.calls:
        digest.update(f"{call.entry} {_number(call)}".encode())
        for values in (call.memory, call.outputs):
            for name, value in values.items():
                digest.update(name.encode() + value.tobytes())
    return digest.hexdigest()[:16]


def free_trace(block: Block, steps: int) -> Trace:
    """Return a plausible trace of a block, to be run freely: `init`, then the calls of its scenario."""
    scenario = block.scenario or default_scenario(block)
    rng: Any = FrozenStream(1)
    calls = [TraceCall(entry, values) for entry, values in scenario.calls(rng, steps)]
    return Trace("free", calls)


def drift(block: Block, ours: Trace, theirs: Trace) -> float:
    """Return how far two runs come apart: in sigma where it is known, else relative to the signal's largest value."""
    scales = None if block.scenario is None else block.scenario.scales
    largest: dict[str, float] = {}
    for call in ours.calls:
        for name, value in call.memory.items():
            largest[name] = max(largest.get(name, 1e-300), float(np.max(np.abs(value.astype(float)), initial=0.0)))
    angles = {signal.name for signal in block.memory_signals_flat() if signal.angle}
    worst = 0.0
    for a, b in zip(ours.calls, theirs.calls, strict=True):
        sigma = {} if scales is None else scales(a.memory)
        for name, value in a.memory.items():
            gap = np.abs(value.astype(float) - b.memory[name].astype(float))
            if name in angles:
                gap = np.abs(gap - 2 * math.pi * np.round(gap / (2 * math.pi)))
            size = np.maximum(np.asarray(sigma.get(name, largest[name]), dtype=float), 1e-300)
            worst = max(worst, float(np.max(gap / size, initial=0.0)))
    return worst


# ---------------------------------------------------------------------------------------------------------------------
# What it costs


def _host_facts(block: Block, target: Target, text: CText, contract: bool) -> dict[str, Any]:
    toolchain = find_toolchain(target)
    bounds: dict[str, tuple[Bound, Bound]]
    with tempfile.TemporaryDirectory(prefix="plantc-") as name:
        whole = toolchain.library_object(text, Path(name), contract=contract)
        sizes = Sizes.of(whole)
        try:
            bounds = _bounds(block, analysis_of(block, text, whole), toolchain)
        except ObjectError as error:
            bounds = dict.fromkeys(block.entries, (Unknown(str(error)), Unknown(str(error))))
    unseen = "the host runs no emulator; the bound is from its machine code"
    return {
        "description": target.description,
        "toolchain": toolchain.as_dict(contract),
        "object": sizes.as_dict() if sizes is not None else "not measured: the compiler's objects are not ELF",
        **written("instructions", {key: Cost.of(f"not counted: {unseen}", most) for key, (most, _) in bounds.items()}),
        **written("stack", {key: Cost.of(f"not painted: {unseen}", most) for key, (_, most) in bounds.items()}),
        "note": "an instruction that repeats itself (rep movs) counts once; stack in bytes, with the address to return to",
    }


def _bounds(block: Block, analysis: Analysis, toolchain: Toolchain) -> dict[str, tuple[Bound, Bound]]:
    """Return entry -> bounds on its instructions and its stack."""
    version = toolchain.compiler.version()
    if "gcc" not in f"{toolchain.compiler.label} {version}" or "clang" in version:
        # one was seen that is too low: clang's code is not followed rightly everywhere
        unknown = Unknown(f"the compiler: only code of gcc is bounded, this is of {version}")
        return dict.fromkeys(block.entries, (unknown, unknown))
    names = {entry: f"{block.name}_{entry}" for entry in block.entries}
    return {entry: (analysis.instructions(name), analysis.stack(name)) for entry, name in names.items()}


def _target_costs(view: TargetView) -> Findings:
    """Return sizes, instructions and stack of a target, with their bounds, and the gates of its object file.

    Raises
    ------
    TargetError
        If flash or RAM are too small.
    """
    target, block = view.target, view.block
    with tempfile.TemporaryDirectory(prefix="plantc-") as name:
        whole = linked_library(view.toolchain, view.text, list(block.entries), Path(name), contract=view.contract)
        linked, own = Sizes.of(whole), Sizes.of(Path(name) / f"{block.name}.o")
        image = read_image(Path(name) / f"{block.name}.o")
        flags = [*view.toolchain.flags, contraction_flag(view.contract)]
        plain = build_plain(view.toolchain.run, flags, view.text, Path(name))
        checks = object_gates(image, view.text, target.name, plain)
        analysis = analysis_of(block, view.text, whole)
    assert own is not None, "targets are ELF"
    assert linked is not None, "targets are ELF"
    entries = [name for name in block.entries if name in view.most]
    bounds = _bounds(block, analysis, view.toolchain)
    stacks = {name: Cost.of(view.most[name].stack, bounds[name][1]) for name in entries}
    flash = linked.text + linked.data
    ram = linked.data + linked.bss + _instance(block, view.precision) + deepest(stacks)
    _refuse_what_does_not_fit(block, target, flash, ram)
    instructions = {name: Cost.of(view.most[name].instructions, bounds[name][0]) for name in entries}
    checks.append(within("instructions", target.name, instructions))
    checks.append(within("stack", target.name, stacks, WORD))
    facts = {
        "description": target.description,
        "fpu": target.fpu,
        "toolchain": view.toolchain.as_dict(view.contract),
        "emulator": view.emulator_version(),
        "object": own.as_dict(),
        "linked": {**linked.as_dict(), "note": "the library with the functions it calls, without start-up code"},
        "flash": {"needed": flash, "available": target.flash},
        "ram": {
            "needed": f"unknown, at least {ram}" if reasons(stacks) else ram,
            "available": target.ram,
            "note": "data, one instance with parameters, largest inputs and outputs, the greatest bound on the stack"
            + ("" if not reasons(stacks) else ", which is not known of all: " + "; ".join(reasons(stacks))),
        },
        **written("instructions", instructions),
        **written("stack", stacks),
        "symbols": {
            "needed": image.undefined,
            "linked": sorted({item for name in entries for item in analysis.callees(f"{block.name}_{name}")}),
        },
        "note": "the most seen on the traces, and bounds from the disassembled control flow; instructions, not cycles; "
        "stack in bytes, callees included",
    }
    return Findings(checks, facts)


def analysis_of(block: Block, text: CText, program: Path) -> Analysis:
    """Return what can be said of a linked program of a block from its machine code."""
    largest = max(
        memory_dtype(block, text.precision).itemsize,
        *(outputs_dtype(entry, text.precision).itemsize for entry in block.entries.values() if entry.outputs),
        0,
    )
    return Analysis(read_image(program), source_loops(text.source), f"{block.name}.c", largest)


WORD = 4
"""Bytes: painted stack is read in words, so a function without a frame of its own may show one."""


def _instance(block: Block, precision: Precision) -> int:
    """Return the bytes of one memory, its parameters, and the largest inputs and outputs."""
    size = memory_dtype(block, precision).itemsize
    if block.param_group().members:
        size += params_dtype(block, precision).itemsize
    size += max(inputs_dtype(entry, precision).itemsize if entry.inputs else 0 for entry in block.entries.values())
    return size + max(
        outputs_dtype(entry, precision).itemsize if entry.outputs else 0 for entry in block.entries.values()
    )


def _refuse_what_does_not_fit(block: Block, target: Target, flash: int, ram: int) -> None:
    for what, need, has, option in (("flash", flash, target.flash, "flash"), ("RAM", ram, target.ram, "ram")):
        if need > has:
            raise TargetError(
                f"{block.name} does not fit {target.name}: it needs {need} bytes of {what}, there are {has}; make the "
                f"model smaller, take --precision float, or state a larger chip by --{option}"
            )


def check_it_fits(block: Block, options: Options, text: CText) -> None:
    """Compile for every chosen target and see that flash and RAM suffice, before work is put into checks.

    The RAM is a lower bound: the stack is known when the calls have run.

    Raises
    ------
    TargetError
        If they do not, or a tool is missing.
    """
    for target in chosen_targets(options):
        if target.is_host:
            continue
        ram = _instance(block, options.precision)
        _refuse_what_does_not_fit(block, target, 0, ram)  # known without compiling
        with tempfile.TemporaryDirectory(prefix="plantc-") as name:
            toolchain = find_toolchain(target)
            linked = Sizes.of(
                linked_library(toolchain, text, list(block.entries), Path(name), contract=options.contract)
            )
        assert linked is not None, "targets are ELF"
        _refuse_what_does_not_fit(block, target, linked.text + linked.data, linked.data + linked.bss + ram)


def _free_facts(trace: Trace) -> dict[str, Any]:
    return {"steps": len(trace), "hash": trace_hash(trace)}
