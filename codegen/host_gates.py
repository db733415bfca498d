"""An export's gates on the host: the object file, the warnings of compilers, and whether two of them give the same bits."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from ..symbolic.block import Block
from .compiler import BASE_FLAGS, Compiler, contraction_flag, find_compiler
from .crosscheck import CrossCheck, Probe
from .emit import CText
from .findings import CheckResult, Findings
from .gates import (
    addresses_gate,
    build_plain,
    header_gate,
    installed_compilers,
    loops_gate,
    object_gates,
    warnings_gate,
    write_library,
)
from .objects import ObjectError, read_image
from .on_target import agrees_bit_for_bit, equal_answers, first_difference, free_trace
from .options import Options
from .views import Answer, NativeView


def equal_bits_gate(
    block: Block,
    precision: str,
    libraries: Mapping[str, Path],
    texts: Mapping[str, CText],
    check: CrossCheck,
    *,
    steps: int = 500,
    judged: bool = True,
) -> CheckResult:
    """Run the libraries of two compilers on the same calls: freely, and from each memory of the cross-check.

    Parameters
    ----------
    block, precision
        What was compiled.
    libraries, texts : dict
        Compiler -> its shared library, and the C it was built from.
    check : CrossCheck
        Its calls are repeated.
    steps : int
        Length of the free run.
    judged : bool
        Whether a difference fails: not where products and sums may be fused, or the C library's functions are called.
    """
    left, right = libraries
    views = {name: NativeView(block, precision, text=texts[name], library=path) for name, path in libraries.items()}
    free = free_trace(block, steps)
    difference = first_difference(views[left].run(free), views[right].run(free), left, right)
    result = CheckResult(f"{left} = {right}", True, calls=steps, note="bit for bit")
    if difference is None:
        probes = [replace(item, answer=_call(views[left], item)) for item in check.calls]
        same = equal_answers(f"{right} = {left}", probes, [_call(views[right], item) for item in probes])
        result.calls += same.calls
        difference = same.mismatch
    if difference is not None:
        result.passed = not judged
        result.mismatch = difference if judged else None
        result.note = str(difference)
    if not judged and difference is not None:
        result.note, result.not_judged = "", result.note
    return result


def _call(view: NativeView, probe: Probe) -> Answer:
    return view.call(probe.entry, probe.memory, probe.inputs, probe.params)


# ---------------------------------------------------------------------------------------------------------------------
# An export


def measure_gates(block: Block, options: Options, text: CText, check: CrossCheck) -> Findings:
    """Pass an export through all gates of the host: object file, loops, compilers.

    Returns
    -------
    Findings
        One check for each gate; facts under ``gates``: which compilers were used, which are missing, which symbols are
        linked.
    """
    checks: list[CheckResult] = [loops_gate(text), addresses_gate(text)]
    facts: dict[str, Any] = {}
    with tempfile.TemporaryDirectory(prefix="plantc-") as name:
        folder = Path(name)
        found, facts["object"] = _host_object(text, options.contract, folder)
        checks += found
        compilers, missing = installed_compilers()
        libraries: dict[str, Path] = {}
        used = []
        for compiler in compilers:
            checks.append(warnings_gate(compiler, text, folder))
            used.append(compiler.version())
            if checks[-1].passed:
                libraries[compiler.label] = compiler.shared_library(
                    [folder / f"{text.name}.c"], folder / f"{compiler.label}.so", contract=options.contract
                )
        for label in ("g++", "clang++"):
            path = shutil.which(label)
            if path is None:
                missing.append(label)
                continue
            checks.append(header_gate(Compiler((path,), label), text, folder))
            used.append(checks[-1].name.removeprefix("header as C++ (").rstrip(")"))
        if len(libraries) == 2:
            judged = agrees_bit_for_bit(text, options.contract)
            texts = dict.fromkeys(libraries, text)
            checks.append(equal_bits_gate(block, options.precision.name, libraries, texts, check, judged=judged))
    facts["compilers"] = used
    facts["missing"] = [f"{item} is not installed: what it would say is not known" for item in missing]
    return Findings(checks, {"gates": facts})


def _host_object(text: CText, contract: bool, folder: Path) -> tuple[list[CheckResult], dict[str, Any] | str]:
    """Compile for the host as the cross-check does, and look at the object."""
    compiler = find_compiler()
    write_library(text, folder)
    flags = [*BASE_FLAGS, contraction_flag(contract)]
    compiler.run([*flags, "-c", f"{text.name}.c", "-o", "host.o"], folder)
    try:
        image = read_image(folder / "host.o")
        plain = build_plain(compiler.run, flags, text, folder)
    except ObjectError as error:
        return [], f"not looked into: {error}"
    return object_gates(image, text, plain=plain), {"machine": image.machine, "symbols": image.undefined}
