"""The fuzz harness that ships with the C, and its runs: random calls, or libFuzzer's search for new paths."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ..symbolic.block import Block
from ..symbolic.program import Entry, HoldVariances, Refuse, Within, walk
from ..symbolic.signals import Kind, Signal, Status
from .emit import generator_version, templates
from .style import Precision
from .vectors import wrapped


@dataclass(frozen=True)
class Field:
    """A row of the harness's table: a field of a struct, and where in the table of ranges its own begin."""

    path: str
    size: int
    kind: str
    first: int
    stride: int
    order: int


class _Tables:
    """Collects fields of structs and their ranges, each range once where it is uniform."""

    def __init__(self, precision: Precision, orders: dict[str, int]):
        self.precision, self.orders = precision, orders
        self.ranges: list[tuple[str, str]] = []

    def fields(
        self, signals: Sequence[Signal], path: str = "", *, memory: bool = False, finite: bool = False
    ) -> list[Field]:
        """Return the fields of a struct, nested ones with dotted paths; `finite`: their ranges are not judged."""
        found: list[Field] = []
        for signal in signals:
            own = path + signal.name
            if signal.kind is Kind.GROUP:
                found += self.fields(signal.members, f"{own}.", memory=memory, finite=finite)
                continue
            first, stride = self._ranges_of(signal, finite) if signal.kind is Kind.REAL else (0, 0)
            order = self.orders.get(own, 0) if memory else 0
            found.append(Field(own, signal.size, f"KIND_{signal.kind.name}", first, stride, order))
        return found

    def _ranges_of(self, signal: Signal, finite: bool) -> tuple[int, int]:
        pairs = [
            (self.precision.literal(low), self.precision.literal(high))
            for low, high in zip(signal.low, signal.high, strict=True)
        ]
        if finite:
            largest = f"{'FLT' if self.precision.is_float else 'DBL'}_MAX"
            pairs = [(f"-{largest}", largest)]
        if len(set(pairs)) == 1:
            if pairs[0] not in self.ranges:
                self.ranges.append(pairs[0])
            return self.ranges.index(pairs[0]), 0
        self.ranges += pairs
        return len(self.ranges) - len(pairs), 1


def _orders(block: Block, path: str = "") -> dict[str, int]:
    """Return memory field -> order, of the packed symmetric matrices whose diagonal is held."""
    found = {
        path + statement.target.name: 0 if statement.layout.blocks else statement.size
        for entry in block.entries.values()
        for statement in walk(entry.body)
        if isinstance(statement, HoldVariances)
    }
    for name, part in block.parts.items():
        found.update(_orders(part, f"{path}{name}."))
    return found


def _judged_outputs(entry: Entry) -> set[str]:
    """Return the outputs whose ranges the entry itself enforces."""
    return {
        statement.unless.place.name
        for statement in walk(entry.body)
        if isinstance(statement, Refuse)
        and isinstance(statement.unless, Within)
        and statement.unless.place.space == "out"
    }


def fuzz_source(block: Block, precision: Precision) -> str:
    """Return the C text of the fuzz harness of a block.

    Parameters
    ----------
    block : Block
        Whose entries are called.
    precision : Precision
        Of the C.
    """
    tables = _Tables(precision, _orders(block))
    name = block.name
    params = tables.fields(block.param_group().members)
    state = tables.fields(block.memory_group().members, memory=True)
    structs = [("state_fields", f"{name}_state_t", state), ("params_fields", f"{name}_params_t", params)]
    entries = []
    for entry in sorted(block.entries.values(), key=lambda entry: entry.name != "init"):
        inputs = tables.fields(entry.inputs)
        outputs = [
            field
            for signal in entry.outputs
            for field in tables.fields([signal], finite=signal.name not in _judged_outputs(entry))
        ]
        structs.append((f"{entry.name}_in_fields", f"{name}_{entry.name}_in_t", inputs))
        structs.append((f"{entry.name}_out_fields", f"{name}_{entry.name}_out_t", outputs))
        entries.append({"name": entry.name, "inputs": len(inputs), "outputs": len(outputs)})
    outs = [f"sizeof({name}_{item['name']}_out_t)" for item in entries if item["outputs"]]
    functions = ("ldexp", "fabs", "fmax", "sqrt", "nextafter")
    text = (
        templates()
        .get_template("fuzz_main.c.j2")
        .render(
            name=name,
            upper=name.upper(),
            version=generator_version(),
            hash=block.model_hash(),
            real=precision.name,
            limit="FLT" if precision.is_float else "DBL",
            zero=precision.literal(0.0),
            one=precision.literal(1.0),
            two=precision.literal(2.0),
            half=precision.literal(0.5),
            **{function: precision.function(function) for function in functions},
            ranges=tables.ranges or [(precision.literal(0.0),) * 2],
            tables=[item for item in structs if item[2]],
            state_count=len(state),
            state_reals=max(1, sum(field.size for field in state if field.kind == "KIND_REAL")),
            params_count=len(params),
            entries=entries,
            outs=outs,
            statuses=[status.name for status in Status],
        )
    )
    return wrapped(text)
