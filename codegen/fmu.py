"""The block as an FMI 2.0 co-simulation unit: model description, wrapper around the same C, binary, and a check of it."""

from __future__ import annotations

import importlib.util
import io
import os
import shutil
import tempfile
import uuid
import xml.etree.ElementTree as ElementTree
import zipfile
from collections.abc import Iterator
from dataclasses import dataclass, fields, is_dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ..symbolic.block import Block
from ..symbolic.program import Evaluate, Place, walk
from ..symbolic.signals import Kind, Signal
from .compiler import CompilerError, find_compiler
from .emit import CText, generator_version, templates
from .findings import CheckResult
from .layout import flatten
from .options import Options
from .style import Precision
from .views import View
from .writer import inputs_used

HEADERS = ("fmi2Functions.h", "fmi2FunctionTypes.h", "fmi2TypesPlatform.h")
STEP_TOLERANCE = 1e-6
"""By how much (relative) a communication step may differ from a constant time step: masters subtract times."""

_NAMESPACE = uuid.UUID("6c9f1f0c-50f2-5b0a-9d0b-3f1f6c1f0a11")
_KINDS = {Kind.REAL: "Real", Kind.FLAG: "Boolean", Kind.COUNT: "Integer", Kind.STATUS: "Integer"}


class FmuError(CompilerError):
    """A block that makes no FMU, or a missing tool. One sentence."""


@dataclass(frozen=True)
class Variable:
    """A scalar variable of the unit.

    Attributes
    ----------
    name : str
        Its name: the C argument, a dot, and the field; elements of a vector are counted from 1.
    path : str
        Where it lies in the wrapper's struct, as C.
    signal : Signal
        What it is.
    index : int
        Element of the signal.
    causality : {"input", "output", "parameter"}
        Who gives it.
    fixed : bool
        Whether it is a parameter that counts only during initialisation.
    """

    name: str
    path: str
    signal: Signal
    index: int
    causality: str
    fixed: bool = False

    @property
    def start(self) -> float:
        """The value before anyone sets it: a parameter's default, for an input zero or the nearest end of its range."""
        if self.causality == "parameter" and self.signal.default is not None:
            return self.signal.default[self.index]
        if self.causality == "input" and self.signal.kind is Kind.REAL:
            return float(np.clip(0.0, self.signal.low[self.index], self.signal.high[self.index]))
        return 0.0


def headers_folder() -> Path:
    """Return the folder of the FMI headers (2-clause BSD) that fmpy carries.

    Raises
    ------
    FmuError
        If fmpy is not installed.
    """
    found = importlib.util.find_spec("fmpy")
    if found is None or found.origin is None:
        raise FmuError(
            "--fmu: fmpy, which carries the FMI headers, is not installed; install it: pip install 'plantc[fmu]'"
        )
    folder = Path(found.origin).parent / "c-code"
    missing = [file for file in HEADERS if not (folder / file).is_file()]
    if missing:
        raise FmuError(
            f"--fmu: this fmpy has no {', '.join(missing)}; install a newer one: pip install -U 'plantc[fmu]'"
        )
    return folder


def check_fmu_is_possible(block: Block) -> None:
    """See that a block makes an FMU, before work is put into it.

    Raises
    ------
    FmuError
        If it has no entry `step`, or fmpy is missing.
    """
    if "step" not in block.entries:
        names = ", ".join(block.entries)
        raise FmuError(
            f"--fmu: {block.name} has no entry step to call at each communication step (it has {names}); add one"
        )
    headers_folder()


def sample_time(block: Block) -> float | None:
    """Return the constant time between calls of `step` in seconds; None where it is an input, or not known."""
    times = {block.sample_time, *(sample_time(part) for part in block.parts.values())} - {None}
    return times.pop() if len(times) == 1 else None


def _elements(signals: tuple[Signal, ...], prefix: str, causality: str) -> Iterator[Variable]:
    for signal in signals:
        name = f"{prefix}.{signal.name}"
        if signal.kind is Kind.GROUP:
            yield from _elements(signal.members, name, causality)
        elif signal.size == 1:
            yield Variable(name, name, signal, 0, causality)
        else:
            for index in range(signal.size):
                yield Variable(f"{name}[{index + 1}]", f"{name}[{index}]", signal, index, causality)


def variables_of(block: Block) -> list[Variable]:
    """Return the variables of a block's unit; the place in the list is the value reference.

    An input `dt` of `step` is none of them: it is the communication step size.
    """
    step = block.entries["step"]
    inputs = tuple(signal for signal in step.inputs if signal.name != "dt")
    status = Signal("status", kind=Kind.STATUS, doc="what the last call returned: negative refused, positive degraded")
    tunable = tunable_parameters(block)
    params = [
        replace(item, fixed=item.path.removeprefix("params.").partition("[")[0] not in tunable)
        for item in _elements(block.param_group().members, "params", "parameter")
    ]
    return [
        *params,
        *_elements(inputs, "in", "input"),
        *_elements(step.outputs, "out", "output"),
        *_elements(block.memory_group().members, "state", "output"),
        Variable("status", "status", status, 0, "output"),
    ]


def tunable_parameters(block: Block, prefix: str = "") -> set[str]:
    """Return the (dotted) names of the parameters that some call after `init` reads; the others only start the memory."""
    read: set[Place] = set()
    for entry in block.entries.values():
        if entry.checks_params:
            continue
        read |= {place for _, place in entry.hidden}
        for statement in walk(entry.body):
            read |= inputs_used(statement) if isinstance(statement, Evaluate) else set(_places(statement))
    names = {place.name for place in read if place.space == "param"}
    found = {
        f"{prefix}{signal.name}"
        for signal in block.param_signals_flat()
        if any(signal.name == name or signal.name.startswith(f"{name}.") for name in names)
    }
    return found.union(*(tunable_parameters(part, f"{prefix}{name}.") for name, part in block.parts.items()))


def _places(item: Any) -> Iterator[Place]:
    """Yield the places in a statement, but for those in statements inside it."""
    if isinstance(item, Place):
        yield item
    elif isinstance(item, (tuple, list)):
        for part in item:
            yield from _places(part)
    elif is_dataclass(item) and not isinstance(item, type):
        for part in fields(item):
            yield from _places(getattr(item, part.name))


def guid_of(block: Block, options: Options) -> str:
    """Return the unit's GUID: it follows from model, generator and the choices that change the C."""
    key = f"{block.name} {block.model_hash()} {generator_version()} {options.precision.name} {options.mathematics}"
    return f"{{{uuid.uuid5(_NAMESPACE, key)}}}"


# ---------------------------------------------------------------------------------------------------------------------
# Text


def model_description(block: Block, options: Options) -> str:
    """Return the text of modelDescription.xml."""
    variables = variables_of(block)
    time = sample_time(block)
    root = ElementTree.Element(
        "fmiModelDescription",
        fmiVersion="2.0",
        modelName=block.name,
        guid=guid_of(block, options),
        description=block.doc or block.name,
        generationTool=f"plantc {generator_version()}",
        version=block.model_hash(),
        variableNamingConvention="structured",
        numberOfEventIndicators="0",
    )
    unit = ElementTree.SubElement(
        root,
        "CoSimulation",
        modelIdentifier=block.name,
        canHandleVariableCommunicationStepSize="true" if _steps_by_input(block) else "false",
        canGetAndSetFMUstate="true",
        canSerializeFMUstate="true",
    )
    sources = ElementTree.SubElement(unit, "SourceFiles")
    for file in (f"{block.name}.c", f"{block.name}_fmu_main.c"):
        ElementTree.SubElement(sources, "File", name=file)
    units = sorted({item.signal.unit for item in variables if item.signal.unit and item.signal.kind is Kind.REAL})
    if units:
        definitions = ElementTree.SubElement(root, "UnitDefinitions")
        for name in units:
            ElementTree.SubElement(definitions, "Unit", name=name)
    categories = ElementTree.SubElement(root, "LogCategories")
    for name in ("logStatusWarning", "logStatusError"):
        ElementTree.SubElement(categories, "Category", name=name)
    if time is not None:
        ElementTree.SubElement(root, "DefaultExperiment", startTime="0", stepSize=repr(time))
    listed = ElementTree.SubElement(root, "ModelVariables")
    for reference, item in enumerate(variables):
        _describe(listed, reference, item, options.precision)
    _structure(root, variables)
    ElementTree.indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + ElementTree.tostring(root, encoding="unicode") + "\n"


def _steps_by_input(block: Block) -> bool:
    """Whether the time step is an input of `step`: only then may a master change the communication step size."""
    return any(signal.name == "dt" for signal in block.entries["step"].inputs)


def _initial(item: Variable) -> str:
    return "calculated" if item.path.startswith(("state.", "status")) else "exact"


def _describe(listed: ElementTree.Element, reference: int, item: Variable, precision: Precision) -> None:
    """Add a ScalarVariable."""
    variability = ("fixed" if item.fixed else "tunable") if item.causality == "parameter" else "discrete"
    row = ElementTree.SubElement(
        listed,
        "ScalarVariable",
        name=item.name,
        valueReference=str(reference),
        causality=item.causality,
        variability=variability,
    )
    if item.causality != "input":
        row.set("initial", _initial(item))
    if item.signal.doc:
        row.set("description", item.signal.doc)
    kind = item.signal.kind
    typed = ElementTree.SubElement(row, _KINDS[kind])
    if kind is Kind.REAL:
        if item.signal.unit:
            typed.set("unit", item.signal.unit)
        if item.causality != "output":
            typed.set("min", _number(item.signal.low[item.index], precision))
            typed.set("max", _number(item.signal.high[item.index], precision))
    if kind is Kind.COUNT and item.causality != "output":
        typed.set("min", "0")
    if item.causality == "input" or _initial(item) == "exact":
        whole = "true" if item.start else "false" if kind is Kind.FLAG else str(int(item.start))
        typed.set("start", _number(item.start, precision) if kind is Kind.REAL else whole)


def _structure(root: ElementTree.Element, variables: list[Variable]) -> None:
    """Add the list of outputs; those that initialisation calculates, a second time."""
    structure = ElementTree.SubElement(root, "ModelStructure")
    outputs = [(index, item) for index, item in enumerate(variables, start=1) if item.causality == "output"]
    for tag, rows in (
        ("Outputs", outputs),
        ("InitialUnknowns", [row for row in outputs if _initial(row[1]) == "calculated"]),
    ):
        part = ElementTree.SubElement(structure, tag)
        for index, _ in rows:
            ElementTree.SubElement(part, "Unknown", index=str(index))


def _number(value: float, precision: Precision) -> str:
    """Return the value that the C holds, to the last digit."""
    return repr(float(np.dtype(precision.dtype).type(value)))


def _is_real_parameter(item: Variable) -> bool:
    return item.causality == "parameter" and item.signal.kind is Kind.REAL


def wrapper_source(block: Block, options: Options) -> str:
    """Return the C of the wrapper: the functions of FMI around the block's entries."""
    step = block.entries["step"]
    precision = options.precision
    variables = variables_of(block)
    time = sample_time(block)
    spellings = {Kind.REAL: "REAL", Kind.FLAG: "FLAG", Kind.COUNT: "COUNT", Kind.STATUS: "STATUS"}
    rows = [
        {
            "kind": spellings[item.signal.kind],
            "settable": "false" if item.causality == "output" else "true",
            "parameter": "true" if item.causality == "parameter" else "false",
            "fixed": "true" if item.fixed else "false",
            "low": _number(item.signal.low[item.index], precision) if _is_real_parameter(item) else "0.0",
            "high": _number(item.signal.high[item.index], precision) if _is_real_parameter(item) else "0.0",
            "path": item.path,
        }
        for item in variables
    ]
    starts = {
        item.path: precision.literal(item.start)
        for item in variables
        if item.causality == "input" and item.signal.kind is Kind.REAL and item.start != 0.0
    }
    return (
        templates()
        .get_template("fmu_main.c.j2")
        .render(
            name=block.name,
            upper=block.name.upper(),
            version=generator_version(),
            hash=block.model_hash(),
            guid=guid_of(block, options),
            real=precision.name,
            rows=rows,
            starts=starts,
            params=bool(block.param_group().members),
            inputs=bool(step.inputs),
            outputs=bool(step.outputs),
            constant_dt="" if time is None else repr(time),
            dt_low="" if time is None else repr(time * (1.0 - STEP_TOLERANCE)),
            dt_high="" if time is None else repr(time * (1.0 + STEP_TOLERANCE)),
            input_dt=_steps_by_input(block),
            tolerance=repr(STEP_TOLERANCE),
        )
    )


# ---------------------------------------------------------------------------------------------------------------------
# The file


def build_fmu(block: Block, options: Options, text: CText) -> bytes:
    """Return the bytes of ``NAME.fmu``: sources, and a binary for this machine.

    Parameters
    ----------
    block : Block
        What is wrapped; it has an entry `step`.
    options : Options
        The choices.
    text : CText
        Its C: what the unit calls.

    Raises
    ------
    FmuError
        If fmpy is missing, or the block has no `step`.
    CompilerError
        If there is no C compiler.
    """
    check_fmu_is_possible(block)
    import fmpy

    folder = headers_folder()
    sources = {
        f"{block.name}.h": text.header,
        f"{block.name}.c": text.source,
        f"{block.name}_fmu_main.c": wrapper_source(block, options),
        **{file: (folder / file).read_text(encoding="utf-8") for file in HEADERS},
    }
    content: dict[str, bytes] = {
        "modelDescription.xml": model_description(block, options).encode(),
        **{f"sources/{file}": source.encode() for file, source in sources.items()},
    }
    with tempfile.TemporaryDirectory(prefix="plantc-") as name:
        place = Path(name)
        for file, source in sources.items():
            (place / file).write_text(source, encoding="utf-8")
        suffix = {"nt": ".dll"}.get(os.name, ".dylib" if fmpy.platform.startswith("darwin") else ".so")
        target = place / f"{block.name}{suffix}"
        compiled = [place / file for file in sources if file.endswith(".c")]
        find_compiler().shared_library(compiled, target, contract=options.contract)
        content[f"binaries/{fmpy.platform}/{target.name}"] = target.read_bytes()
    return _zipped(content)


def _zipped(content: dict[str, bytes]) -> bytes:
    """Return a zip file with the same bytes for the same content: times are fixed."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        for file, data in content.items():
            entry = zipfile.ZipInfo(file, date_time=(1980, 1, 1, 0, 0, 0))
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = 0o644 << 16
            archive.writestr(entry, data)
    return stream.getvalue()


# ---------------------------------------------------------------------------------------------------------------------
# Stepping it


class FmuRunner:
    """An instance of a unit, stepped through fmpy.

    Parameters
    ----------
    block : Block
        What the unit was made from.
    path : Path
        The unit, unpacked or packed.
    """

    def __init__(self, block: Block, path: Path):
        from fmpy import extract, read_model_description
        from fmpy.fmi2 import FMU2Slave

        self.block = block
        self.variables = variables_of(block)
        self.references = {item.name: index for index, item in enumerate(self.variables)}
        self._own = None if path.is_dir() else extract(str(path))
        folder = str(path) if self._own is None else self._own
        description = read_model_description(folder)
        self.slave = FMU2Slave(
            guid=description.guid,
            unzipDirectory=folder,
            modelIdentifier=description.coSimulation.modelIdentifier,
            instanceName="plantc",
        )
        self.slave.instantiate()

    def start(self) -> None:
        """Go through initialisation."""
        self.slave.setupExperiment(startTime=0.0)
        self.slave.enterInitializationMode()
        self.slave.exitInitializationMode()

    def set_inputs(self, values: dict[str, Any]) -> None:
        """Set inputs of `step` by field name; `dt` is left out."""
        for item_name, given in values.items():
            flat = np.atleast_1d(np.asarray(given)).ravel()
            for index, value in enumerate(flat):
                name = f"in.{item_name}" if flat.size == 1 else f"in.{item_name}[{index + 1}]"
                if name not in self.references:
                    continue
                reference = [self.references[name]]
                kind = self.variables[reference[0]].signal.kind
                if kind is Kind.REAL:
                    self.slave.setReal(reference, [float(value)])
                elif kind is Kind.FLAG:
                    self.slave.setBoolean(reference, [bool(value)])
                else:
                    self.slave.setInteger(reference, [int(value)])

    def values(self, prefix: str) -> np.ndarray[Any, Any]:
        """Return all variables whose name begins so, as doubles."""
        answer = []
        for reference, item in enumerate(self.variables):
            if item.name.startswith(prefix):
                kind = item.signal.kind
                get = {Kind.REAL: self.slave.getReal, Kind.FLAG: self.slave.getBoolean}.get(kind, self.slave.getInteger)
                answer.append(float(get([reference])[0]))
        return np.array(answer)

    def step(self, time: float, size: float) -> int:
        """Do a communication step and return the block's status."""
        self.slave.doStep(currentCommunicationPoint=time, communicationStepSize=size)
        return int(self.values("status")[0])

    def close(self) -> None:
        """Free the instance, and what was unpacked."""
        self.slave.terminate()
        self.slave.freeInstance()
        if self._own is not None:
            shutil.rmtree(self._own, ignore_errors=True)


def check_fmu(block: Block, content: bytes, view: View, *, steps: int = 100, dt: float | None = None) -> CheckResult:
    """Step a unit by fmpy next to direct calls: every bit of status, state and outputs has to be the same.

    Parameters
    ----------
    block : Block
        What the unit was made from.
    content : bytes
        The unit.
    view : View
        What calls the C directly.
    steps : int
        How many nominal calls of `step`.
    dt : float, optional
        Communication step size; default the block's, or that of each call.

    Returns
    -------
    CheckResult
        Also failed where fmpy's validation has a finding.
    """
    from fmpy.validation import validate_fmu

    result = CheckResult("FMU = direct call", True)
    with tempfile.TemporaryDirectory(prefix="plantc-") as name:
        path = Path(name) / f"{block.name}.fmu"
        path.write_bytes(content)
        problems = validate_fmu(str(path))
        if problems:
            result.passed, result.note = False, f"fmpy: {'; '.join(problems)[:500]}"
            return result
        runner = FmuRunner(block, path)
        try:
            runner.start()
            memory, params, time = view.init(), view.params(), 0.0
            for inputs in _nominal_inputs(block, steps):
                size = np.asarray(inputs["dt"]).item() if "dt" in inputs else dt or sample_time(block) or 1.0
                runner.set_inputs(inputs)
                status = runner.step(time, size)
                answer = view.call("step", memory, view.inputs("step", inputs), params)
                memory, time = answer.memory, time + size
                result.calls += 1
                same = status == int(answer.status) and _same(runner.values("state."), flatten(memory))
                if same and answer.status >= 0:
                    same = _same(runner.values("out."), flatten(answer.outputs))
                if not same:
                    result.passed = False
                    result.note = f"call {result.calls}: the FMU gives other bits than the direct call"
                    return result
        finally:
            runner.close()
    return result


def _same(found: np.ndarray[Any, Any], wanted: dict[str, np.ndarray[Any, Any]]) -> bool:
    values = [piece.astype(float) for piece in wanted.values()]
    return np.array_equal(found, np.concatenate(values) if values else np.array([]))


def _nominal_inputs(block: Block, steps: int) -> Iterator[dict[str, Any]]:
    """Yield inputs of `step`: the scenario's, where it has any, else zeros or the nearest ends of the ranges."""
    entry = block.entries["step"]
    made = 0
    if block.scenario is not None:
        for name, values in block.scenario.calls(np.random.default_rng(1), 20 * steps):
            if name == "step" and made < steps:
                made += 1
                yield values
    while made < steps:
        made += 1
        yield {
            signal.name: np.clip(np.zeros(signal.size), signal.low, signal.high)
            if signal.kind is Kind.REAL
            else np.zeros(signal.size, dtype=int)
            for signal in entry.inputs
        }
