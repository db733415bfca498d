"""Export: derive, write C, compile, cross-check, package; and check what lies in a folder."""

from __future__ import annotations

import hashlib
import json
import os
import platform
import subprocess
import tempfile
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..symbolic.block import Block
from ..symbolic.errors import ModelError
from ..symbolic.signals import Kind, Signal
from .cache import Kept, keep, kept, key_of
from .compiler import CompilerError, contraction_flag, find_compiler
from .coverage import measure_coverage
from .crosscheck import CrossCheck, cross_check, make_probes, make_views
from .emit import CText, emit, generator_version, templates
from .exported import MissingTool
from .findings import CheckResult, Findings, Mismatch
from .fmu import build_fmu, check_fmu, check_fmu_is_possible
from .folder import MEASURED, FolderError, check_folder_is_free, read_manifest, write_file, write_files, write_folder
from .fuzz import fuzz_source
from .host_gates import measure_gates
from .layout import default_params
from .on_target import check_it_fits, chosen_targets, measure_targets
from .options import Options
from .packages import package_files
from .report import report_html
from .style import Precision
from .traceability import trace_text
from .vectors import choose_vectors, vectors_source, wrapped
from .views import NativeView, View

VECTOR_STEPS = 100
"""Length of the nominal trace from which vectors are chosen, however long that of the cross-check is."""

NOT_CHECKED = [
    "whether the user's dynamics and sensors describe the real plant",
    "whether the caller passes values in the stated units",
    "whether sensors are sampled when the caller says they are",
]


class DesignError(ModelError):
    """A design.json that does not belong to the model as it is now."""


class ExportError(RuntimeError):
    """A check failed: nothing was written. `check` has the results."""

    def __init__(self, message: str, check: CrossCheck):
        super().__init__(message)
        self.check = check


@dataclass
class Export:
    """What an export produced."""

    block: Block
    options: Options
    folder: Path
    files: dict[str, str]
    check: CrossCheck
    evidence: dict[str, Any]
    from_cache: bool = False

    @property
    def precision(self) -> str:
        """Type of real numbers in the C."""
        return self.options.precision.name

    @property
    def passed(self) -> bool:
        """Whether every check passed."""
        return self.check.passed


@dataclass
class Draft:
    """An export before it is written: what the measurements look at.

    Attributes
    ----------
    block : Block
        What is exported.
    options : Options
        The choices.
    text : CText
        Its C.
    files : dict
        Path in the folder -> text: all that follows from model and generator alone.
    check : CrossCheck
        The finished cross-check; its `calls` are the traces.
    """

    block: Block
    options: Options
    text: CText
    files: dict[str, str]
    check: CrossCheck


Measurement = Callable[[Draft], Findings]

MEASUREMENTS: list[tuple[str, Measurement]] = [
    ("vectors", lambda draft: Findings([run_vectors(draft.block.name, draft.files)])),
    ("gates", lambda draft: measure_gates(draft.block, draft.options, draft.text, draft.check)),
    ("coverage", lambda draft: _coverage(draft)),
    ("targets", lambda draft: measure_targets(draft.block, draft.options, draft.text, draft.check)),
    ("tables", lambda draft: measure_tables(draft.block) if draft.options.tables else Findings()),
]
"""What every export that passed its cross-check is measured by, in this order: (what is being done, how)."""


def build_files(
    block: Block, options: Options | str = "double", checks: list[CheckResult] | None = None
) -> dict[str, str]:
    """Return path in the folder -> text of everything that follows from model and generator alone.

    Nothing is checked and nothing measured: this is what `export` writes, and what `plantc check` compares with.

    Parameters
    ----------
    block : Block
        What is written.
    options : Options, or {"double", "float"}
        The choices.
    checks : list of CheckResult, optional
        Takes what was found on the way: whether C and model agree on what might have become a vector.
    """
    chosen = options if isinstance(options, Options) else Options(Precision(options))
    precision = chosen.precision.name
    text = emit(block, precision, mathematics=chosen.mathematics)
    native = NativeView(block, precision, text=text if chosen.mathematics == "own" else None)
    vectors = choose_vectors(block, precision, _rare_calls(block, precision, native), native)
    if checks is not None:
        checks.append(vectors.agreement)
    name = block.name
    context: dict[str, Any] = {
        "name": name,
        "upper": name.upper(),
        "version": generator_version(),
        "hash": block.model_hash(),
        "params": bool(block.param_group().members),
    }
    entry = block.entries["step"] if "step" in block.entries else list(block.entries.values())[-1]
    inputs = _middle_text(entry.inputs, chosen.precision)
    context |= {"entry": entry.name, "inputs": inputs, "outputs": bool(entry.outputs)}
    main = templates().get_template("example_main.c.j2").render(**context)
    files = {
        f"src/{name}.h": text.header,
        f"src/{name}.c": text.source,
        "test/test_vectors.c": vectors_source(block, precision, vectors, native),
        "examples/example_main.c": wrapped(main),
        "verify/fuzz_main.c": fuzz_source(block, chosen.precision),
        **package_files(block, chosen, context),
    }
    files["trace.json"] = trace_text(block, text, vectors.vectors)
    manifest = _manifest(block, chosen, text, files, len(vectors.vectors))
    files["manifest.json"] = json.dumps(manifest, indent=2) + "\n"
    return files


def _coverage(draft: Draft) -> Findings:
    return measure_coverage(
        draft.block, draft.options.precision.name, draft.files, draft.text.provenance, draft.check.calls
    )


def measure_tables(block: Block) -> Findings:
    """Measure what a block brings to be measured on demand.

    Raises
    ------
    MissingTool
        If that needs a Python module which is not installed.
    """
    rows = []
    for title, measure in block.tables.items():
        try:
            rows.append({"title": title, **asdict(measure())})
        except ModuleNotFoundError as error:
            raise MissingTool(
                f"{block.name}: the table {title!r} needs the Python module {error.name}; install it (pip install {error.name})"
            ) from None
    return Findings([], {"tables": rows})


def _rare_calls(block: Block, precision: str, native: NativeView | None = None) -> CrossCheck:
    """Return calls from which the vectors are chosen, answered by the model's own C: those of a default cross-check."""
    native = native or NativeView(block, precision)
    probes = make_probes(block, precision, make_views(block, precision, native), VECTOR_STEPS, 0)
    for probe in probes:
        probe.answer = native.call(probe.entry, probe.memory, probe.inputs, probe.params)
    return CrossCheck([], {}, probes)


def export(
    block: Block,
    out: Path | str,
    *,
    precision: str = "double",
    mathematics: str = "own",
    options: Options | None = None,
    steps: int = 100,
    progress: Callable[[str, int, int], None] | None = None,
    native: NativeView | None = None,
    fmu: bool = False,
    cached: bool = False,
    force: bool = False,
) -> Export:
    """Write a block's C library to ``out/<name>/``, after every check passed.

    Parameters
    ----------
    block : Block
        What to export.
    out : Path or str
        Folder that gets a folder named after the block.
    precision : {"double", "float"}
        Type of real numbers in the C.
    mathematics : {"own", "libm"}
        Whose `sin`, `exp` ... the C calls: plantc's own (the same bits everywhere), or the C library's.
    options : Options, optional
        All choices; then `precision` and `mathematics` are not looked at.
    steps : int
        Length of the nominal trace of the cross-check.
    progress : callable, optional
        Called with (what is being done, done, in all).
    native : NativeView, optional
        Compiled C to check instead of the emitter's: for tests that plant a fault.
    cached : bool
        Whether an export that was done before, with the same C, choices, tools and plantc, may answer from the cache.
    fmu : bool
        Whether an FMI 2.0 co-simulation unit of the same C is written too, ``<name>.fmu``.
    force : bool
        Whether files of an earlier export may be replaced that someone changed since.

    Returns
    -------
    Export
        Files and evidence.

    Raises
    ------
    CompilerError
        If there is no C compiler.
    TargetError
        If a target is not known, its tools are missing, or the code does not fit it.
    ModelError
        If the block, or a part of it, is for simulation only.
    FolderError
        If the folder cannot be written, or holds someone else's files.
    ExportError
        If a check failed. Nothing is written; what was there stays.
    """
    report = progress or (lambda what, done, total: None)
    chosen = options or Options(Precision(precision), mathematics=mathematics)
    precision = chosen.precision.name
    _refuse_simulation_only(block)
    folder = Path(out) / block.name
    check_folder_is_free(folder, force=force)
    chosen_targets(chosen)  # a missing tool is told before the work
    if fmu:
        check_fmu_is_possible(block)
    report("write the C", 0, 1)
    text = native.text if native is not None else emit(block, precision, mathematics=chosen.mathematics)
    key = ""
    if cached and native is None and not (fmu or chosen.tables):
        key = key_of(block, text, chosen, steps)
        before = kept(key, block, text) if key else None
        if before is not None:
            write_folder(folder, dict(before.files), force=force)
            return Export(
                block, chosen, folder, before.files, CrossCheck(before.results, before.statuses), before.evidence, True
            )
    report("compile for the targets", 0, 1)
    check_it_fits(block, chosen, text)
    report("compile", 0, 1)
    compiled = native or NativeView(block, precision, text=text, contract=chosen.contract)
    views = make_views(block, precision, compiled)
    check = cross_check(
        block, precision, views=views, steps=steps, progress=lambda done, total: report("cross-check", done, total)
    )
    if not check.passed:
        raise ExportError(failure_text(block, check), check)
    files = build_files(block, chosen, check.results)
    draft = Draft(block, chosen, compiled.text, files, check)
    facts: dict[str, Any] = {}
    for done, (what, measure) in enumerate(MEASUREMENTS):
        report(what, done, len(MEASUREMENTS))
        found = measure(draft)
        check.results += found.checks
        facts.update(found.facts)
        if not check.passed:
            raise ExportError(failure_text(block, check), check)
    binary: dict[str, str | bytes] = {}
    if fmu:
        report("FMU", 0, 1)
        binary[f"{block.name}.fmu"] = unit = build_fmu(block, chosen, compiled.text)
        check.results.append(check_fmu(block, unit, compiled, steps=steps))
        if not check.passed:
            raise ExportError(failure_text(block, check), check)
    evidence = {**_evidence(block, chosen, check, compiled), **facts}
    files["evidence.json"] = json.dumps(evidence, indent=2) + "\n"
    report("report", 0, 1)
    files["report.html"] = report_html(block, json.loads(files["manifest.json"]), evidence, check.calls)
    write_folder(folder, {**files, **binary}, force=force)
    if key:
        keep(key, Kept(files, check.results, check.statuses, evidence))
    return Export(block, chosen, folder, files, check, evidence)


def _refuse_simulation_only(block: Block) -> None:
    """Raise a ModelError if a block, or a part of it, has no place on a target."""
    if block.simulation_only:
        raise ModelError(f"{block.name}: it is for simulation only and is not exported: {block.simulation_only}")
    for part in block.parts.values():
        _refuse_simulation_only(part)


def failure_text(block: Block, check: CrossCheck) -> str:
    """Return a sentence for the first failed check."""
    first = check.failures[0]
    why = str(first.mismatch) if first.mismatch is not None else first.note
    return f"{block.name}: the check {first.name!r} failed: {why}"


def run_vectors(name: str, files: dict[str, str]) -> CheckResult:
    """Compile the shipped vectors and the example, as a user would, and run them."""
    compiler = find_compiler()
    result = CheckResult("shipped vectors", True)
    with tempfile.TemporaryDirectory(prefix="plantc-") as folder_name:
        folder = Path(folder_name)
        write_files(folder, files)
        for main in ("test/test_vectors.c", "examples/example_main.c"):
            program = compiler.program([folder / f"src/{name}.c", folder / main], folder / Path(main).stem)
            done = subprocess.run([str(program)], capture_output=True, text=True, check=False, timeout=60)
            if main == "test/test_vectors.c":
                result.calls = int(done.stdout.strip().split("\n")[-1].split(" ")[0]) if done.stdout.strip() else 0
            if done.returncode != 0 and main == "test/test_vectors.c":
                result.passed = False
                result.note = done.stdout.strip()[:500] or f"{main} ended with {done.returncode}"
    return result


@dataclass
class FolderCheck:
    """What `check_folder` found: files that differ from what the model gives, and the results of the checks."""

    folder: Path
    changed: list[str]
    missing: list[str]
    check: CrossCheck

    @property
    def passed(self) -> bool:
        """Whether the folder holds what the model gives, and it passes."""
        return not self.changed and not self.missing and self.check.passed


def text_in(folder: Path, manifest: dict[str, Any]) -> CText:
    """Return the C that lies in a folder."""
    name = manifest["name"]
    header, source = (folder / f"src/{name}.{end}" for end in ("h", "c"))
    return CText(name, Precision(manifest["precision"]), header.read_text(), source.read_text(), {})


def check_folder(
    folder: Path,
    block: Block,
    *,
    targets: tuple[str, ...] = ("host",),
    steps: int = 100,
    progress: Callable[[str, int, int], None] | None = None,
) -> FolderCheck:
    """Compare a folder with what its model gives now, and run the checks on the C that lies there.

    Parameters
    ----------
    folder : Path
        What `export` wrote.
    block : Block
        What it was written from.
    targets : tuple of str
        Machines on which the C is run as well.
    steps : int
        Length of the nominal trace.
    progress : callable, optional
        Called with (what is being done, done, in all).

    Raises
    ------
    CompilerError
        If there is no C compiler, or a target's tools are missing.
    """
    report = progress or (lambda what, done, total: None)
    manifest = read_manifest(folder)
    precision = manifest["precision"]
    contract, mathematics = manifest.get("contract") == "on", manifest.get("mathematics", "own")
    options = Options(Precision(precision), targets, contract, mathematics)
    chosen_targets(options)
    name = block.name
    present = {file: (folder / file).read_text() for file in manifest["files"] if (folder / file).is_file()}
    missing = [file for file in manifest["files"] if file not in present]
    native = NativeView(block, precision, contract=contract, mathematics=mathematics)
    header, source = present.get(f"src/{name}.h"), present.get(f"src/{name}.c")
    refused = []
    if header is not None and source is not None and manifest["model"] == block.model_hash():
        lying = text_in(folder, manifest)
        try:
            native = NativeView(block, precision, text=lying, contract=contract)
        except CompilerError as error:
            if (lying.header, lying.source) == (native.text.header, native.text.source):
                raise
            said = str(error).split(": ", 1)[-1].split("\n")[0]
            refused = [CheckResult("the C that lies there compiles", False, note=f"it was changed by hand: {said}")]
    views = make_views(block, precision, native)
    check = cross_check(
        block, precision, views=views, steps=steps, progress=lambda done, total: report("cross-check", done, total)
    )
    if set(targets) - {"host"}:
        report("targets", 0, 1)
        check.results += measure_targets(block, options, native.text, check).checks
    check.results += refused
    expected = build_files(block, options, check.results)
    changed = [file for file, text in expected.items() if file in present and present[file] != text]
    stored = folder / "manifest.json"
    if stored.is_file() and stored.read_text() != expected["manifest.json"] and "manifest.json" not in changed:
        changed.append("manifest.json")
    return FolderCheck(folder, changed, missing, check)


# ---------------------------------------------------------------------------------------------------------------------
# Manifest and evidence


def _fields(signals: tuple[Signal, ...]) -> list[dict[str, Any]]:
    answer = []
    for signal in signals:
        row: dict[str, Any] = {"name": signal.name, "kind": signal.kind.value, "size": signal.size}
        if signal.unit:
            row["unit"] = signal.unit
        if signal.doc:
            row["doc"] = signal.doc
        if signal.kind is Kind.REAL:
            row["range"] = list(signal.uniform_range) if signal.uniform_range else "by element"
        if signal.kind is Kind.GROUP:
            row["fields"] = _fields(signal.members)
        answer.append(row)
    return answer


def _manifest(block: Block, options: Options, text: CText, files: dict[str, str], vectors: int) -> dict[str, Any]:
    return {
        "name": block.name,
        "doc": block.doc,
        "model": block.model_hash(),
        "generator": f"plantc {generator_version()}",
        "precision": options.precision.name,
        "contract": "on" if options.contract else "off",
        "mathematics": options.mathematics,
        "equations": block.equations,
        "memory": _fields(block.memory_group().members),
        "parameters": _fields(block.param_group().members),
        "entries": {
            entry.name: {
                "doc": entry.doc,
                "inputs": _fields(entry.inputs),
                "outputs": _fields(entry.outputs),
                "operations": text.operations[entry.name],
            }
            for entry in block.entries.values()
        },
        "reference": "independent NumPy reference" if block.oracle is not None else "no independent reference",
        "vectors": vectors,
        "not_checked": NOT_CHECKED,
        "files": {file: hashlib.sha256(content.encode()).hexdigest() for file, content in files.items()},
    }


def _evidence(block: Block, options: Options, check: CrossCheck, native: View) -> dict[str, Any]:
    compiler = find_compiler()
    precision = options.precision.name
    types = {
        "memory_bytes": native.memory().nbytes,
        "parameter_bytes": default_params(block, Precision(precision)).nbytes,
    }
    return {
        "name": block.name,
        "model": block.model_hash(),
        "precision": precision,
        "passed": check.passed,
        "compiler": {
            "label": compiler.label,
            "version": compiler.version(),
            "contraction": contraction_flag(options.contract),
        },
        "machine": platform.machine(),
        **types,
        "checks": [result.as_dict() for result in check.results],
        "statuses_reached": dict(sorted(check.statuses.items())),
    }


def _middle_text(signals: tuple[Signal, ...], precision: Precision) -> str:
    """Return an initialiser with every input at zero or the nearest end of its range, flags down."""
    items = []
    for signal in signals:
        if signal.kind is Kind.FLAG:
            items.append("false")
        elif signal.kind is Kind.COUNT:
            items.append("0U")
        else:
            values = [
                precision.literal(float(item)) for item in np.clip(np.zeros(signal.size), signal.low, signal.high)
            ]
            items.append(values[0] if signal.size == 1 else "{" + ", ".join(values) + "}")
    return "{" + ", ".join(items) + "}" if items else ""


# ---------------------------------------------------------------------------------------------------------------------
# Designed numbers


def with_design(
    block: Block, path: Path, *, redesign: bool = False, write: bool = True
) -> tuple[Block, dict[str, Any] | None]:
    """Return the block with the numbers of a design.json, and what is to be written there.

    Parameters
    ----------
    block : Block
        A block; if it has no designed numbers it is returned as it is.
    path : Path
        The design.json beside the model.
    redesign : bool
        Design the numbers anew even where they are there.
    write : bool
        Whether numbers that are not there yet are written at once; else it is the caller's, see `write_design`.

    Returns
    -------
    (Block, dict or None)
        The block, and its numbers where the file lacks them.

    Raises
    ------
    DesignError
        If the file cannot be read, or was made from another model; it names ``--redesign``.
    FolderError
        If the file cannot be written.
    """
    design = block.design
    if design is None:
        return block, None
    own = _stored_designs(path, redesign=redesign).get(block.name)
    if own is None or redesign:
        values = {name: np.asarray(value).tolist() for name, value in design.values.items()}
        fresh = {"source": design.source, "values": values}
        if write:
            write_design(path, {block.name: fresh})
        return block, fresh
    if own["source"] != design.source:
        raise DesignError(
            f"{path}: the numbers of {block.name!r} were designed for another model; export with --redesign to design them anew"
        )
    absent = [name for name in design.values if name not in own["values"]]
    if absent:
        raise DesignError(f"{path} has no {absent[0]}; export with --redesign")
    strange = [name for name in own["values"] if name not in design.values or not _are_numbers(own["values"][name])]
    if strange:
        raise DesignError(
            f"{path}: {strange[0]!r} of {block.name!r} is no designed number; mend it, or export with --redesign"
        )
    return design.rebuild({name: np.asarray(value) for name, value in own["values"].items()}), None


def _are_numbers(value: Any) -> bool:
    try:
        array = np.asarray(value)
    except ValueError:
        return False
    return array.dtype.kind in "if" and bool(np.all(np.isfinite(array)))


def _stored_designs(path: Path, *, redesign: bool = False) -> dict[str, Any]:
    """Return block -> its designed numbers, as a file has them; nothing where there is none.

    Raises
    ------
    DesignError
        If the file cannot be read, or does not hold that; where all is designed anew that is left out.
    """
    if not os.path.lexists(path):
        return {}
    mend = "mend it, or export with --redesign"
    try:
        stored = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise DesignError(f"{path}: cannot be read ({error.strerror}); make it readable, or move it") from None
    except ValueError as error:
        if redesign:
            return {}
        raise DesignError(f"{path}: not readable as JSON ({error}); {mend}") from None
    if not isinstance(stored, dict):
        if redesign:
            return {}
        raise DesignError(f"{path}: it holds no object of blocks and their designed numbers; {mend}")
    sound = {
        name: own
        for name, own in stored.items()
        if isinstance(own, dict) and isinstance(own.get("source"), str) and isinstance(own.get("values"), dict)
    }
    strange = [name for name in stored if name not in sound]
    if strange and not redesign:
        raise DesignError(f"{path}: the entry {strange[0]!r} has no source and values of designed numbers; {mend}")
    return sound


def write_design(path: Path, designed: dict[str, Any]) -> None:
    """Write designed numbers into a design.json, beside those of other blocks; the file is replaced in one step.

    Parameters
    ----------
    path : Path
        The file.
    designed : dict
        Block -> its numbers, as `with_design` returned them.

    Raises
    ------
    FolderError
        If it cannot be written.
    """
    write_file(
        path, json.dumps(dict(sorted({**_stored_designs(path, redesign=True), **designed}.items())), indent=2) + "\n"
    )


def design_residuals(block: Block) -> list[CheckResult]:
    """Derive designed numbers' properties (not digits) again."""
    if block.design is None:
        return []
    results = []
    for name, (value, limit) in block.design.properties(block.design.values).items():
        results.append(CheckResult(f"design: {name}", value <= limit, worst=value, limit=limit))
    return results


__all__ = [
    "MEASURED",
    "CheckResult",
    "DesignError",
    "Export",
    "ExportError",
    "FolderCheck",
    "FolderError",
    "Mismatch",
    "build_files",
    "check_folder",
    "design_residuals",
    "export",
    "read_manifest",
    "run_vectors",
    "with_design",
    "write_design",
]
