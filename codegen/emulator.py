"""The view of a target: the generated C, cross-compiled, called in an emulator by semihosting, many calls a run."""

from __future__ import annotations

import subprocess
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..symbolic.block import Block
from ..symbolic.program import Entry
from ..symbolic.signals import Status
from .emit import CText, emit, templates
from .layout import flatten, inputs_dtype, memory_dtype, outputs_dtype, params_dtype
from .targets import STACK, Target, TargetError, Toolchain, find_emulator, find_toolchain
from .trace import Trace, TraceCall
from .views import Answer, Record, View

TIMEOUT = 300.0
"""Seconds after which a run of the emulator is given up."""

_FAILURES = {
    70: "the processor met a fault (a memory access or instruction it refuses)",
    71: "the answers could not be written to the temporary folder",
    72: "a call used more than the {painted} bytes of stack that are painted",
    73: "the file of calls could not be opened",
}


@dataclass(frozen=True)
class Call:
    """One call of a run in the emulator. Without a memory it goes on from the call before; likewise parameters."""

    entry: str
    inputs: Record
    memory: Record | None = None
    params: Record | None = None


@dataclass(frozen=True)
class Measured:
    """What a call cost.

    Attributes
    ----------
    instructions : int
        Executed from the first of the entry to its return, callees included. Not cycles.
    stack : int
        Bytes overwritten below the caller's stack pointer.
    """

    instructions: int
    stack: int


class TargetView(View):
    """The generated C on a target, in an emulator. One run of the emulator executes any number of calls.

    Parameters
    ----------
    block : Block
        What to run.
    precision : {"double", "float"}
        Precision of the C.
    target : Target
        Not the host.
    text : CText, optional
        C to use instead of what `emit` gives: for tests that plant a fault.
    contract : bool
        Whether a product and a sum may be fused.
    toolchain : Toolchain, optional
        Instead of the one that `find_toolchain` gives.

    Attributes
    ----------
    most : dict
        Entry -> the most instructions and the deepest stack of its calls so far.
    last : list of Measured
        What each call of the last run cost.

    Raises
    ------
    TargetError
        If compiler or emulator are missing, in a sentence.
    """

    def __init__(
        self,
        block: Block,
        precision: str,
        target: Target,
        *,
        text: CText | None = None,
        contract: bool = False,
        toolchain: Toolchain | None = None,
    ):
        super().__init__(block, precision)
        self.name = target.name
        self.target = target
        self.emulator = find_emulator(target)
        self.toolchain = toolchain or find_toolchain(target)
        self.contract = contract
        self.text = text or emit(block, precision)
        # a call holds a few copies of memory and outputs: more is painted where these are large
        largest = max(outputs_dtype(entry, self.precision).itemsize for entry in block.entries.values())
        self.painted = STACK + 16 * (memory_dtype(block, self.precision).itemsize + largest) // 1024 * 1024
        self.most: dict[str, Measured] = {}
        self.last: list[Measured] = []
        self.path = self.toolchain.program(
            {
                f"{block.name}.h": self.text.header,
                f"{block.name}.c": self.text.source,
                "machine_main.h": templates().get_template("machine_main.h").render(),
                "machine_main.c": templates().get_template("machine_main.c").render(),
                "runner_main.c": self.runner(),
            },
            contract=contract,
            stack=self.painted,
        )

    def runner(self) -> str:
        """Return the C of the program that reads calls and writes answers."""
        block, name = self.block, self.block.name
        has_params = bool(block.param_group().members)
        types = [(f"{name}_state_t", memory_dtype(block, self.precision))]
        if has_params:
            types.append((f"{name}_params_t", params_dtype(block, self.precision)))
        entries = []
        for entry in block.entries.values():
            if entry.inputs:
                types.append((f"{name}_{entry.name}_in_t", inputs_dtype(entry, self.precision)))
            if entry.outputs:
                types.append((f"{name}_{entry.name}_out_t", outputs_dtype(entry, self.precision)))
            entries.append({"name": entry.name, "inputs": bool(entry.inputs), "outputs": bool(entry.outputs),
                            "arguments": _arguments(entry, has_params)})  # fmt: skip
        offsets = [
            (label, field, dtype.fields[field][1])
            for label, dtype in types
            for field in (dtype.names or ())
            if dtype.fields is not None and field != "unused"
        ]
        sizes = [(label, dtype.itemsize) for label, dtype in types]
        context = {"name": name, "params": has_params, "entries": entries, "sizes": sizes, "offsets": offsets}
        return templates().get_template("runner_main.c.j2").render(**context)

    # -- running ------------------------------------------------------------------------------------------------------

    def call(self, entry: str, memory: Record, inputs: Record, params: Record) -> Answer:
        """Call an entry: a whole run of the emulator; `calls` takes many at once."""
        return self.calls([Call(entry, inputs, memory, params)])[0]

    def calls(self, calls: Sequence[Call]) -> list[Answer]:
        """Execute calls, in one run of the emulator, and return what each gave.

        Raises
        ------
        TargetError
            If the program does not come to its end: a fault of the processor, a stack larger than what is painted, or
            a run that takes too long.
        """
        with tempfile.TemporaryDirectory(prefix="plantc-") as name:
            folder = Path(name)
            (folder / "calls.bin").write_bytes(self._packed(calls))
            self._emulate(folder)
            return self._unpacked((folder / "answers.bin").read_bytes(), calls)

    def run(self, trace: Trace, params: Record | None = None, memory: Record | None = None) -> Trace:
        """Replay a trace freely, in one run of the emulator; see `View.run`."""
        given = self.params() if params is None else params
        calls = [Call(item.entry, self.inputs(item.entry, item.inputs)) for item in trace.calls]
        if memory is None:
            first = Call("init", self.inputs("init", {}), self.memory(), given)
            answers = self.calls([first, *calls])
            if answers[0].status < 0:
                raise ValueError(f"{self.block.name}: init refused the parameters ({answers[0].status.name})")
            answers = answers[1:]
        elif calls:
            answers = self.calls([Call(calls[0].entry, calls[0].inputs, memory, given), *calls[1:]])
        else:
            answers = []
        rows = [
            TraceCall(
                item.entry, item.inputs, answer.status, flatten(answer.memory), flatten(answer.outputs), item.time
            )
            for item, answer in zip(trace.calls, answers, strict=True)
        ]
        return Trace(trace.name, rows)

    def _packed(self, calls: Sequence[Call]) -> bytes:
        number = {entry: k for k, entry in enumerate(self.block.entries)}
        has_params = bool(self.block.param_group().members)
        pieces = []
        for call in calls:
            with_params = has_params and call.params is not None
            flags = (1 if call.memory is not None else 0) | (2 if with_params else 0)
            pieces.append(np.array([number[call.entry], flags], "<u4").tobytes())
            if call.memory is not None:
                pieces.append(call.memory.tobytes())
            if with_params and call.params is not None:
                pieces.append(call.params.tobytes())
            if self.block.entries[call.entry].inputs:
                pieces.append(call.inputs.tobytes())
        return b"".join(pieces)

    def _unpacked(self, data: bytes, calls: Sequence[Call]) -> list[Answer]:
        head = np.dtype([("status", "<i4"), ("ticks", "<u4"), ("stack", "<u4")])
        memory = memory_dtype(self.block, self.precision)
        outputs = {
            name: outputs_dtype(entry, self.precision) if entry.outputs else None
            for name, entry in self.block.entries.items()
        }
        base = np.frombuffer(data, head, 1)[0]
        at = head.itemsize
        answers: list[Answer] = []
        self.last = []
        for call in calls:
            told = np.frombuffer(data, head, 1, at)[0]
            at += head.itemsize
            after = np.frombuffer(data, memory, 1, at)[0].copy()
            at += memory.itemsize
            out = self.outputs(call.entry)
            kind = outputs[call.entry]
            if kind is not None:
                out = np.frombuffer(data, kind, 1, at)[0].copy()
                at += kind.itemsize
            answers.append(Answer(Status(int(told["status"])), _record(after), _record(out)))
            ticks = (int(told["ticks"]) - int(base["ticks"])) / self.target.ticks_of_instruction
            self._note(call.entry, Measured(round(ticks) + 1, int(told["stack"])))
        return answers

    def emulator_version(self) -> str:
        """Return program, machine and version of the emulator."""
        done = subprocess.run([self.emulator, "--version"], capture_output=True, text=True, check=False)
        said = done.stdout.strip().split("\n")[0]
        return f"{self.target.emulator} {' '.join(self.target.machine)} ({said})"

    def _note(self, entry: str, cost: Measured) -> None:
        self.last.append(cost)
        known = self.most.get(entry, cost)
        self.most[entry] = Measured(max(known.instructions, cost.instructions), max(known.stack, cost.stack))

    def _emulate(self, folder: Path) -> None:
        command = [self.emulator, *self.target.machine, "-nographic", "-monitor", "none", "-serial", "none"]
        command += ["-semihosting-config", "enable=on,target=native", "-kernel", str(self.path)]
        try:
            done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False, timeout=TIMEOUT)
        except subprocess.TimeoutExpired:
            raise TargetError(
                f"{self.block.name} on {self.name}: the emulator did not end within {TIMEOUT:g} s; take fewer --steps"
            ) from None
        if done.returncode != 0:
            other = f"{self.target.emulator} ended with {done.returncode}"
            what = _FAILURES.get(done.returncode, other).format(painted=self.painted)
            said = done.stderr.strip()[:500]
            raise TargetError(f"{self.block.name} on {self.name}: {what}{': ' + said if said else ''}")


def _record(value: Any) -> Record:
    """Return a record scalar as a writable array without dimensions, as `View` makes them."""
    return np.array(value, dtype=value.dtype)


def _arguments(entry: Entry, has_params: bool) -> list[str]:
    """Return what the runner passes: pointers, padded to four."""
    given = ["&memory"]
    if has_params:
        given.append("&params")
    if entry.inputs:
        given.append(f"&in_{entry.name}")
    if entry.outputs:
        given.append(f"&out_{entry.name}")
    return [*given, *["&memory"] * (4 - len(given))]
