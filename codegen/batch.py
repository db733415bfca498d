"""An entry run many times in one C call: inputs of every step in, memory and outputs of every step out."""

from __future__ import annotations

import ctypes
import hashlib
import time
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..symbolic.block import Block
from ..symbolic.signals import Status
from .compiler import library_for
from .emit import emit, generator_version, templates
from .layout import default_params, fill, inputs_dtype, memory_dtype, outputs_dtype
from .style import Precision

Record = np.ndarray[Any, Any]


@dataclass(frozen=True, eq=False)
class BatchText:
    """All that another process, or another machine, needs to run a batch: C text and layouts. It can be pickled.

    Attributes
    ----------
    name, entry : str
        The block, and the entry that is run.
    model : str
        Hash of the model.
    version : str
        The plantc that wrote the C.
    sources : dict
        File name -> text.
    params : numpy record
        Every parameter at its default.
    memory, inputs, outputs : numpy.dtype
        Layout of the C structs.
    takes_params, takes_inputs, gives_outputs : bool
        Which arguments the entry has.
    """

    name: str
    entry: str
    model: str
    version: str
    sources: dict[str, str]
    params: Record
    memory: np.dtype[Any]
    inputs: np.dtype[Any]
    outputs: np.dtype[Any]
    takes_params: bool
    takes_inputs: bool
    gives_outputs: bool

    @cached_property
    def digest(self) -> str:
        """Hash of the C: the same for the same text."""
        return hashlib.sha256(repr(sorted(self.sources.items())).encode()).hexdigest()


def batch_text(block: Block, entry: str = "step", precision: str = "double", *, mathematics: str = "own") -> BatchText:
    """Return the C of a block with a driver that runs an entry many times.

    Parameters
    ----------
    block : Block
        What is run.
    entry : str
        Its entry.
    precision : {"double", "float"}
        Of the C.
    mathematics : {"own", "libm"}
        See `emit`.

    Raises
    ------
    ValueError
        If the block has no such entry, or the entry is `init`.
    """
    if entry == "init" or entry not in block.entries:
        raise ValueError(
            f"{block.name}: {entry!r} is no entry that can be run in a batch; it has {', '.join(list(block.entries)[1:])}"
        )
    kind, program, name = Precision(precision), block.entries[entry], block.name
    text = emit(block, kind, mathematics=mathematics)
    takes_params = bool(block.param_group().members)
    flags = {
        "takes_params": takes_params,
        "takes_inputs": bool(program.inputs),
        "gives_outputs": bool(program.outputs),
    }
    driver = templates().get_template("batch.c.j2").render(name=name, entry=entry, **flags)
    return BatchText(
        name, entry, block.model_hash(), generator_version(),
        {f"{name}.h": text.header, f"{name}.c": text.source, f"{name}_batch.c": driver},
        default_params(block, kind),
        memory_dtype(block, kind), inputs_dtype(program, kind), outputs_dtype(program, kind),
        **flags,
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class BatchAnswer:
    """What a batch gave.

    Attributes
    ----------
    steps : int
        Steps that were accepted; fewer than asked for where one was refused.
    status : Status
        Of the last call; negative where it was refused, and the run stopped before it.
    statuses : int array (steps,)
        Of the accepted steps: zero, or positive where one was degraded.
    memory, outputs : numpy record array (steps,)
        After each accepted step.
    """

    steps: int
    status: Status
    statuses: NDArray[np.int32]
    memory: Record
    outputs: Record


@dataclass(frozen=True, eq=False)
class Room:
    """Arrays for runs of some steps, one run after the other: to ask the system for them anew takes as long as the C.

    Attributes
    ----------
    inputs, memory, outputs : numpy record array (steps,)
        What goes in, and what comes out.
    statuses : int array (steps + 1,)
        Of each step.
    """

    inputs: Record
    memory: Record
    outputs: Record
    statuses: NDArray[np.int32]


class Batch:
    """The compiled batch. A run is one C call, in which the interpreter lock is released.

    Parameters
    ----------
    text : BatchText
        What `batch_text` gave; it is compiled here, once for each text and compiler.

    Raises
    ------
    CompilerError
        If there is no compiler.
    """

    def __init__(self, text: BatchText):
        self.text = text
        self.library = ctypes.CDLL(str(library_for(text.sources)))
        self._init = getattr(self.library, f"{text.name}_init")
        self._init.restype = ctypes.c_int
        self._run = getattr(self.library, f"{text.name}_batch_{text.entry}")
        self._run.restype = ctypes.c_int32

    def params(self, values: dict[str, Any] | None = None) -> Record:
        """Return a parameter record: defaults, with fields replaced, nested ones by dotted names."""
        return fill(self.text.params.copy(), values or {})

    def inputs(self, steps: int) -> Record:
        """Return input records of zeros, one for each step."""
        return np.zeros(steps, dtype=self.text.inputs)

    def room(self, steps: int) -> Room:
        """Return arrays for runs of some steps; the inputs are zero."""
        memory, outputs = np.empty(steps, dtype=self.text.memory), np.zeros(steps, dtype=self.text.outputs)
        return Room(self.inputs(steps), memory, outputs, np.zeros(steps + 1, dtype=np.int32))

    def init(self, params: Record | None = None) -> Record:
        """Return the memory after `init`.

        Raises
        ------
        ValueError
            If a parameter is refused.
        """
        memory = np.zeros((), dtype=self.text.memory)
        given = self.text.params if params is None else params
        arguments = [memory, *([given] if self.text.takes_params else [])]
        status = Status(self._init(*[item.ctypes.data_as(ctypes.c_void_p) for item in arguments]))
        if status < 0:
            raise ValueError(f"{self.text.name}: init refused the parameters ({status.name})")
        return memory

    def run(
        self,
        inputs: Record,
        params: Record | None = None,
        memory: Record | None = None,
        *,
        room: Room | None = None,
    ) -> BatchAnswer:
        """Run the entry once for each record of inputs, until one is refused.

        Parameters
        ----------
        inputs : numpy record array (steps,)
            See `inputs`.
        params : numpy record, optional
            See `params`; default the block's.
        memory : numpy record, optional
            Where to start; default what `init` gives. It is left as it is.
        room : Room, optional
            Where the answer is put, of as many steps; it lasts until the next run there. Default new arrays.

        Raises
        ------
        ValueError
            If inputs, parameters or memory have another layout than the C, or the room is not of this batch and length.
        """
        state, given = self._accepted(inputs, params, memory)
        count = len(inputs)
        place = room or self.room(count)
        steps = self._call(state, given, inputs, place)
        last = Status(int(place.statuses[steps if steps < count else count - 1])) if count else Status.OK
        return BatchAnswer(steps, last, place.statuses[:steps], place.memory[:steps], place.outputs[:steps])

    def seconds(self, inputs: Record, params: Record | None = None, *, repeats: int = 5) -> list[float]:
        """Return how long the C call takes, each time from the same start: nothing is allocated while the clock runs.

        Parameters
        ----------
        inputs, params : numpy record
            As for `run`.
        repeats : int
            How many times; one more goes before them.

        Raises
        ------
        ValueError
            As for `run`; or if a step is refused.
        """
        state, given = self._accepted(inputs, params, None)
        room = self.room(len(inputs))
        times = []
        for _ in range(repeats + 1):
            own = state.copy()
            started = time.perf_counter()
            steps = self._call(own, given, inputs, room)
            times.append(time.perf_counter() - started)
            if steps < len(inputs):
                raise ValueError(f"{self.text.name}: step {steps + 1} was refused; time inputs that are accepted")
        return times[1:]

    def _accepted(self, inputs: Record, params: Record | None, memory: Record | None) -> tuple[Record, Record]:
        """Return memory to start from, and parameters, if all is laid out as the C takes it."""
        text = self.text
        given = text.params if params is None else params
        state = (self.init(given) if memory is None else memory).copy()
        for what, record, layout in (
            ("inputs", inputs, text.inputs), ("parameters", given, text.params.dtype), ("memory", state, text.memory),
        ):  # fmt: skip
            if record.dtype != layout or not record.flags.c_contiguous:
                raise ValueError(
                    f"{text.name}: the {what} are not laid out as the C takes them; make them with this batch"
                )
        return state, given

    def _call(self, state: Record, given: Record, inputs: Record, room: Room) -> int:
        """Call the C; return the steps that were accepted."""
        text = self.text
        if len(room.memory) != len(inputs) or room.memory.dtype != text.memory or room.outputs.dtype != text.outputs:
            raise ValueError(f"{text.name}: the room is not for these steps of this batch; make it with this batch")
        arguments = [
            state,
            *([given] if text.takes_params else []),
            *([inputs] if text.takes_inputs else []),
            *([room.outputs] if text.gives_outputs else []),
            room.memory,
            room.statuses,
        ]
        pointers = [item.ctypes.data_as(ctypes.c_void_p) for item in arguments]
        return int(self._run(*pointers, ctypes.c_int32(len(inputs))))
