"""Things that run a Block, all with one protocol: the program in Python, the oracle, the compiled C."""

from __future__ import annotations

import ctypes
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..symbolic.block import Block
from ..symbolic.errors import expect
from ..symbolic.program import Place, Visit, run_entry
from ..symbolic.signals import Status
from .compiler import library_for
from .emit import CText, emit
from .layout import (
    default_params,
    fill,
    flatten,
    inputs_dtype,
    memory_dtype,
    outputs_dtype,
    why_refused,
)
from .style import Precision
from .trace import Trace, TraceCall

Record = np.ndarray[Any, Any]


@dataclass
class Answer:
    """What a call gave.

    Attributes
    ----------
    status : Status
        Negative: refused, and memory and outputs are those before the call.
    memory, outputs : numpy record
        After the call.
    margin : float
        How near the call came to a switch (relative); infinite where the view does not tell.
    visits : tuple of Visit
        The statements that ran, where the view tells.
    """

    status: Status
    memory: Record
    outputs: Record
    margin: float = float("inf")
    visits: tuple[Visit, ...] = ()


class View:
    """Runs a Block. Memory, inputs, outputs and parameters are NumPy records laid out like the C structs.

    Parameters
    ----------
    block : Block
        What to run.
    precision : {"double", "float"}
        Of the records (and, where the view can, of the arithmetic).
    """

    name = "view"

    def __init__(self, block: Block, precision: str = "double"):
        expect(block, Block, f"{type(self).__name__}: what is to be run", "a Block")
        self.block = block
        self.precision = Precision(precision)
        self._blank: dict[str, Record] = {}

    # -- records ------------------------------------------------------------------------------------------------------

    def params(self, **values: Any) -> Record:
        """Return a parameter record: defaults, with the given fields replaced."""
        if "params" not in self._blank:
            self._blank["params"] = default_params(self.block, self.precision)
        return fill(self._blank["params"].copy(), _dotted(values))

    def memory(self, **values: Any) -> Record:
        """Return a memory record of zeros with the given fields set."""
        if "memory" not in self._blank:
            self._blank["memory"] = np.zeros((), dtype=memory_dtype(self.block, self.precision))
        return fill(self._blank["memory"].copy(), _dotted(values))

    def inputs(self, entry: str, values: Mapping[str, Any]) -> Record:
        """Return an input record of zeros with the given fields set."""
        key = f"{entry} in"
        if key not in self._blank:
            self._blank[key] = np.zeros((), dtype=inputs_dtype(self.block.entries[entry], self.precision))
        return fill(self._blank[key].copy(), values)

    def outputs(self, entry: str) -> Record:
        """Return an output record of zeros."""
        key = f"{entry} out"
        if key not in self._blank:
            self._blank[key] = np.zeros((), dtype=outputs_dtype(self.block.entries[entry], self.precision))
        return self._blank[key].copy()

    # -- running ------------------------------------------------------------------------------------------------------

    def call(self, entry: str, memory: Record, inputs: Record, params: Record) -> Answer:
        """Call an entry. The arguments are left as they are."""
        raise NotImplementedError

    def init(self, params: Record | None = None) -> Record:
        """Return the memory after `init`.

        Raises
        ------
        ValueError
            If a parameter is refused.
        """
        given = self.params() if params is None else params
        answer = self.call("init", self.memory(), self.inputs("init", {}), given)
        if answer.status < 0:
            raise ValueError(
                f"{self.block.name}: init refused the parameters ({answer.status.name}): {why_refused(self.block, given)}"
            )
        return answer.memory

    def run(self, trace: Trace, params: Record | None = None, memory: Record | None = None) -> Trace:
        """Replay a trace freely and return what this view answered.

        Parameters
        ----------
        trace : Trace
            Calls with their inputs.
        params : record, optional
            Parameters; default the block's.
        memory : record, optional
            Where to start; default what `init` gives.
        """
        given = self.params() if params is None else params
        state = self.init(given) if memory is None else memory
        calls = []
        for item in trace.calls:
            inputs = self.inputs(item.entry, item.inputs)
            answer = self.call(item.entry, state, inputs, given)
            state = answer.memory
            calls.append(
                TraceCall(
                    item.entry, item.inputs, answer.status, flatten(answer.memory), flatten(answer.outputs), item.time
                )
            )
        return Trace(trace.name, calls)


def _dotted(values: Mapping[str, Any]) -> dict[str, Any]:
    return {key.replace("__", "."): value for key, value in values.items()}


class InterpretView(View):
    """The program in Python: CasADi's virtual machine for functions, NumPy matrix algebra for kernels. Double only.

    Parameters
    ----------
    block : Block
        What to run.
    patches : dict, optional
        CasADi functions to use instead of those of the same name: for tests that plant a fault.
    limits : {"double", "float"}
        Precision in which ends of ranges and other numbers that values are compared with are held, as in the C.
    """

    name = "interpret"

    def __init__(self, block: Block, patches: dict[str, Any] | None = None, limits: str = "double"):
        super().__init__(block, "double")
        self.patches = patches or {}
        self.limits = Precision(limits).dtype

    def call(self, entry: str, memory: Record, inputs: Record, params: Record) -> Answer:
        """Run the entry's program."""
        values: dict[Place, Any] = {}
        program = self.block.entries[entry]
        if not program.checks_params:
            for name, value in flatten(memory).items():
                values[Place("memory", name)] = value.astype(float) if value.dtype.kind == "f" else value
        for name, value in flatten(inputs).items():
            values[Place("in", name)] = value
        visits: list[Visit] = []
        outcome = run_entry(self.block, program, values, flatten(params), self.patches, visits, real=self.limits)
        if outcome.status < 0:
            return Answer(outcome.status, memory.copy(), self.outputs(entry), outcome.margin, tuple(visits))
        answer = self.memory() if program.checks_params else memory.copy()
        outputs = self.outputs(entry)
        fill(answer, {place.name: value for place, value in outcome.values.items() if place.space == "next"})
        fill(outputs, {place.name: value for place, value in outcome.values.items() if place.space == "out"})
        return Answer(outcome.status, answer, outputs, outcome.margin, tuple(visits))


class ReferenceView(View):
    """The block's oracle: plain NumPy, in either precision.

    Raises
    ------
    ValueError
        If the block has none.
    """

    name = "reference"

    def __init__(self, block: Block, precision: str = "double"):
        super().__init__(block, precision)
        if block.oracle is None:
            raise ValueError(f"{block.name}: it has no oracle, so there is no reference view")
        self.oracle = block.oracle

    def call(self, entry: str, memory: Record, inputs: Record, params: Record) -> Answer:
        """Ask the oracle."""
        status, after, outputs = self.oracle.call(
            entry, flatten(memory), flatten(inputs), flatten(params), self.precision.dtype
        )
        if status < 0:
            return Answer(Status(status), memory.copy(), self.outputs(entry))
        return Answer(Status(status), fill(memory.copy(), after), fill(self.outputs(entry), outputs))


class NativeView(View):
    """The generated C, compiled for this machine and loaded.

    Parameters
    ----------
    block : Block
        What to run.
    precision : {"double", "float"}
        Precision of the C.
    text : CText, optional
        C to use instead of what `emit` gives: for tests that plant a fault.
    contract : bool
        Whether a product and a sum may be fused.
    library : Path, optional
        A library that was built already; then nothing is compiled.
    mathematics : {"own", "libm"}
        Whose `sin`, `exp` ... the emitted C calls.

    Raises
    ------
    CompilerError
        If there is no compiler.
    """

    name = "native"

    def __init__(
        self,
        block: Block,
        precision: str = "double",
        *,
        text: CText | None = None,
        contract: bool = False,
        library: Path | None = None,
        mathematics: str = "own",
    ):
        super().__init__(block, precision)
        self.text = text or emit(block, precision, mathematics=mathematics)
        name = block.name
        sources = {f"{name}.h": self.text.header, f"{name}.c": self.text.source}
        self.path: Path = library or library_for(sources, contract=contract)
        self.library = ctypes.CDLL(str(self.path))
        self._has_params = bool(block.param_group().members)
        self._functions: dict[str, Any] = {}
        for entry in block.entries.values():
            function = getattr(self.library, f"{name}_{entry.name}")
            function.restype = ctypes.c_int
            self._functions[entry.name] = function

    def model(self) -> str:
        """Return the model hash that the library reports."""
        function = getattr(self.library, f"{self.block.name}_model")
        function.restype = ctypes.c_char_p
        return str(function().decode())

    def call(self, entry: str, memory: Record, inputs: Record, params: Record) -> Answer:
        """Call the C function."""
        program = self.block.entries[entry]
        state = memory.copy()
        outputs = self.outputs(entry)
        arguments = [state.ctypes.data_as(ctypes.c_void_p)]
        if self._has_params:
            arguments.append(params.ctypes.data_as(ctypes.c_void_p))
        if program.inputs:
            arguments.append(inputs.ctypes.data_as(ctypes.c_void_p))
        if program.outputs:
            arguments.append(outputs.ctypes.data_as(ctypes.c_void_p))
        status = self._functions[entry](*arguments)
        return Answer(Status(status), state, outputs)
