"""From a Block to the text of its C library: header and source."""

from __future__ import annotations

import textwrap
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from importlib.metadata import PackageNotFoundError, version
from itertools import groupby
from typing import Any

import jinja2

from ..symbolic.block import Block
from ..symbolic.errors import ModelError
from ..symbolic.kernels import AllStatesUpdate
from ..symbolic.program import Call, Entry, HoldFactors, HoldVariances, walk
from ..symbolic.signals import STATUS_TEXT, Kind, Signal, Status
from .layout import default_text, struct_lines
from .mathematics import CHOICES, OWN, mathematics_note, mathematics_text
from .provenance import Genealogy, Parent, Provenance, TracedLines, marked, unmarked
from .rows import bounded_helper, certain_factors, pair_helpers
from .style import WIDTH, Precision, comment_lines, comment_safe, wrap_line
from .tables import Tables
from .writer import CoreWriter, Style, core_name, has_outputs, is_sequenced, needs_params, style_for, wrap_signature


def generator_version() -> str:
    """Return the version of plantc, for headers and manifests."""
    try:
        return version("plantc")
    except PackageNotFoundError:  # run from a checkout that was never installed
        return "0+unknown"


@lru_cache
def templates() -> jinja2.Environment:
    """Return the environment of the artefact templates."""
    return jinja2.Environment(
        loader=jinja2.PackageLoader("plantc.codegen", "templates"),
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        undefined=jinja2.StrictUndefined,
        autoescape=False,
    )


@dataclass(frozen=True)
class CText:
    """The emitted library.

    Attributes
    ----------
    name : str
        Block name: prefix of everything.
    precision : Precision
        Type of real numbers.
    header, source : str
        The two files.
    operations : dict
        Entry -> count of operations by kind.
    provenance : Provenance
        What each line of the source is there for.
    """

    name: str
    precision: Precision
    header: str
    source: str
    operations: dict[str, dict[str, int]]
    provenance: Provenance = field(default_factory=Provenance)


def emit(
    block: Block, precision: str | Precision = "double", style: Style | None = None, *, mathematics: str = "own"
) -> CText:
    """Return the C99 text of a block: the same bytes for the same model, anywhere.

    Parameters
    ----------
    block : Block
        What to write.
    precision : {"double", "float"}
        Type of every real number.
    style : Style, optional
        The emitter's choices; by default those for the precision.
    mathematics : {"own", "libm"}
        Whose `sin`, `exp` ... the C calls, where no style is given: plantc's own, or the C library's.

    Raises
    ------
    ModelError
        If a number does not fit into the precision, or a function has no counterpart in the C.
    ValueError
        If `mathematics` is neither.
    """
    if mathematics not in CHOICES:
        raise ValueError(f"the mathematics {mathematics!r} is not known; take 'own' or 'libm'")
    kind = precision if isinstance(precision, Precision) else Precision(precision)
    try:
        return _Emitter(block, kind, style or style_for(kind, mathematics)).text()
    except OverflowError as error:
        raise ModelError(f"{block.name}: {error}; rescale the units, or export in double") from None


class _Emitter:
    def __init__(self, block: Block, precision: Precision, style: Style):
        self.block, self.precision, self.style = block, precision, style
        self.name = block.name
        self.operations: dict[str, dict[str, int]] = {}
        self.used: set[str] = set()
        self.own: set[str] = set()
        self.tables = Tables()

    def text(self) -> CText:
        """Write both files."""
        cores = self._cores(self.block, self.name)
        parents: list[Parent] = []
        publics = [line for entry in self.block.entries.values() for line in ["", *self._public(entry)]]
        context = {
            "name": self.name,
            "upper": self.name.upper(),
            "version": generator_version(),
            "hash": self.block.model_hash(),
            "real": self.precision.name,
            "statuses": [(status.name, int(status), STATUS_TEXT[status]) for status in _header_order()],
            "higher": "higher" in self.used,
            "math": any(item not in ("higher", "hold_variances") for item in self.used),
        }
        header = (
            templates()
            .get_template("header.h.j2")
            .render(
                **context,
                title=self._title(),
                equations=self._equation_lines(),
                notes=[line for note in self._notes() for line in textwrap.wrap(comment_safe(note), WIDTH - 3)],
                structs=self._structs(self.block, self.name),
                default=self._default_macro(),
                prototypes=self._prototypes(),
            )
        )
        source = (
            templates()
            .get_template("source.c.j2")
            .render(
                **context,
                mathematics=mathematics_text(self.name, self.precision, self.own),
                tables=self.tables.text(self.name, self.precision),
                cores=marked(cores, parents),
                publics=marked(publics, parents),
            )
        )
        clean, provenance = unmarked(_tidy(source), parents)
        return CText(self.name, self.precision, _tidy(header), clean, self.operations, provenance)

    # -- header -------------------------------------------------------------------------------------------------------

    def _title(self) -> str:
        kind = "single" if self.precision.is_float else "double"
        return f"{self.name}: {comment_safe(self.block.doc).rstrip('.') or 'a block'}, in {kind} precision."

    def _notes(self) -> list[str]:
        """Return the block's notes, and whose mathematics the C calls."""
        names = {name.removesuffix("f") if self.precision.is_float else name for name in self.used} & OWN
        note = mathematics_note(self.precision, names, self.style.mathematics)
        return [*self.block.notes, *([note] if note else [])]

    def _equation_lines(self) -> list[str]:
        return [
            line
            for equation in self.block.equations
            for line in wrap_line(comment_safe(equation), " *   ", hanging="      ")
        ]

    def _structs(self, block: Block, prefix: str) -> str:
        """Return all struct definitions, those of parts first."""
        texts = [
            self._structs(part, f"{prefix}_{name}") if block.twin(name) == name else self._aliases(block, name, prefix)
            for name, part in block.parts.items()
        ]
        types = {part: f"{prefix}_{part}" for part in block.parts}
        params = block.param_group().members
        if params:
            texts.append(
                self._struct(
                    f"{prefix}_params_t",
                    params,
                    {name: f"{value}_params_t" for name, value in types.items()},
                    "What may be tuned without exporting again."
                    + (f" Start from {self.name.upper()}_PARAMS_DEFAULT." if prefix == self.name else ""),
                )
            )
        texts.append(
            self._struct(
                f"{prefix}_state_t",
                block.memory_group().members,
                {name: f"{value}_state_t" for name, value in types.items()},
                "The memory. Copy it, save it, put it where you like.",
            )
        )
        for entry in self._written(block):
            if entry.inputs and block is self.block:  # cores of parts take single arguments
                texts.append(self._struct(f"{prefix}_{entry.name}_in_t", entry.inputs, {}, ""))
            if entry.outputs:
                texts.append(
                    self._struct(
                        f"{prefix}_{entry.name}_out_t", entry.outputs, self._out_types(block, entry, prefix), ""
                    )
                )
        return "\n".join(texts)

    def _aliases(self, block: Block, part: str, prefix: str) -> str:
        """Return names for the structs of a part that is the same Block as one before it."""
        own, first, inner = f"{prefix}_{part}", f"{prefix}_{block.twin(part)}", block.parts[part]
        ends = ["params_t"] if inner.param_group().members else []
        ends += ["state_t"] + (["step_out_t"] if inner.entries["step"].outputs else [])
        lines = comment_lines(
            f"{part} is the same block as {block.twin(part)}, with a memory and parameters of its own.", ""
        )
        return "\n".join([*lines, *[f"typedef {first}_{end} {own}_{end};" for end in ends], ""])

    def _out_types(self, block: Block, entry: Entry, prefix: str) -> dict[str, str]:
        types = {}
        for signal in entry.outputs:
            if signal.kind is Kind.STATUS:
                types[signal.name] = f"{self.name}_status_t"
            elif signal.kind is Kind.GROUP:
                types[signal.name] = self._group_type(block, signal, prefix)
        return types

    def _group_type(self, block: Block, signal: Signal, prefix: str) -> str:
        if signal.name in block.parts:
            return f"{prefix}_{signal.name}_step_out_t"
        for name in (f"update_{signal.name}", signal.name):
            if name in block.entries and block.entries[name].outputs == signal.members:
                return f"{prefix}_{name}_out_t"
        raise ValueError(f"no entry gives the group {signal.name!r}")

    def _struct(self, name: str, signals: Sequence[Signal], types: dict[str, str], comment: str) -> str:
        lines = [*(comment_lines(comment, "") if comment else []), "typedef struct", "{"]
        lines += struct_lines(list(signals), self.precision, types) or [
            "    uint8_t unused;  /* nothing to remember */"
        ]
        lines += [f"}} {name};", ""]
        return "\n".join(lines)

    def _default_macro(self) -> str:
        if not self.block.param_group().members:
            return ""
        head = f"#define {self.name.upper()}_PARAMS_DEFAULT"
        words = default_text(self.block.param_group().members, self.precision).split(" ")
        lines, current = [], head
        for word in words:
            if len(current) + len(word) + 3 > WIDTH:
                lines.append(current + " \\")
                current = "    " + word
            else:
                current += " " + word
        return "\n".join([*lines, current])

    def _public_signature(self, entry: Entry) -> str:
        p = self.name
        parts = [f"{p}_state_t *state"]
        if self.block.param_group().members:
            parts.append(f"const {p}_params_t *params")
        if entry.inputs:
            parts.append(f"const {p}_{entry.name}_in_t *in")
        if has_outputs(entry):
            parts.append(f"{p}_{entry.name}_out_t *out")
        return f"{p}_status_t {p}_{entry.name}({', '.join(parts)})"

    def _prototypes(self) -> str:
        lines: list[str] = []
        for entry in self.block.entries.values():
            note = entry.doc + (" `out` is written when the status is not negative." if has_outputs(entry) else "")
            lines += comment_lines(note.strip(), "") if note.strip() else []
            lines += [*wrap_signature(self._public_signature(entry) + ";"), ""]
        return "\n".join(lines)

    # -- source -------------------------------------------------------------------------------------------------------

    def _written(self, block: Block) -> list[Entry]:
        """Return the entries of which there is C: all of the block's own, and of a part what its `step` needs."""
        if block is self.block:
            return list(block.entries.values())
        needed = {"init", "step"} | {item.entry for item in walk(block.entries["step"].body) if isinstance(item, Call)}
        return [entry for entry in block.entries.values() if entry.name in needed]

    def _cores(self, block: Block, prefix: str) -> list[str]:
        lines: list[str] = []
        for name, part in block.parts.items():
            if block.twin(name) == name:
                lines += self._cores(part, f"{prefix}_{name}")
                continue
            path, first = (f"{prefix}_{item}".removeprefix(f"{self.name}_") for item in (name, block.twin(name)))
            for key in [key for key in self.operations if key.startswith(f"{first}.")]:
                self.operations[path + key.removeprefix(first)] = self.operations[key]
        hold = next(
            (item for entry in block.entries.values() for item in walk(entry.body) if isinstance(item, HoldVariances)),
            None,
        )
        if hold is not None:
            lines += self._hold_variances(hold, prefix)
        whole = next(
            (
                item
                for entry in block.entries.values()
                for item in walk(entry.body)
                if isinstance(item, AllStatesUpdate)
            ),
            None,
        )
        if whole is not None:
            lines += pair_helpers(prefix, self.precision, whole.rows[0].size)
        for entry in _calls_first(self._written(block)):
            written = CoreWriter(block, entry, prefix, self.style, self.name, self.tables).write()
            self.used |= written.functions
            self.own |= written.own
            key = entry.name if prefix == self.name else f"{prefix.removeprefix(self.name + '_')}.{entry.name}"
            self.operations[key] = dict(sorted(written.operations.items()))
            counted = _operations_text(written.operations)
            lines += ["", *(comment_lines(counted, "") if counted else []), *written.lines]
        return lines

    def _public(self, entry: Entry) -> list[str]:
        p, u = self.name, self.name.upper()
        commit = Genealogy(self.block, entry).parent(
            "commit", "memory and outputs are written where the status is not negative"
        )
        lines = TracedLines([*wrap_signature(self._public_signature(entry)), "{"], commit)
        sequenced = is_sequenced(entry)
        target = "state" if sequenced else "&after"
        arguments = [] if entry.checks_params else ["state"]
        arguments.append(target)
        if needs_params(self.block, entry):
            arguments.append("params")
        arguments += [f"in->{signal.name}" for signal in entry.inputs]
        arguments += [f"params->{place.name}" for _, place in entry.hidden]
        if has_outputs(entry):
            arguments.append("&answer")
        if not sequenced:
            lines.append(f"    {p}_state_t after;")
        if has_outputs(entry):
            lines.append(f"    {p}_{entry.name}_out_t answer;")
        call = f"    const {p}_status_t status = {core_name(p, entry)}({', '.join(arguments)});"
        lines += wrap_line(call.strip(), "    ")
        if self.block.param_group().members and not needs_params(self.block, entry) and not entry.hidden:
            lines += ["", "    (void)params;"]
        commits = ([] if sequenced else ["        *state = after;"]) + (
            ["        *out = answer;"] if has_outputs(entry) else []
        )
        if commits:
            lines += ["", f"    if (status >= {u}_OK)", "    {", *commits, "    }"]
        lines += ["    return status;", "}"]
        return lines

    def _hold_variances(self, hold: HoldVariances, prefix: str) -> list[str]:
        """Write the rare path of `HoldVariances`: compact loops, called only when a variance left its bounds."""
        self.used |= {"hold_variances", self.precision.function("sqrt")}
        size = hold.size
        limits = hold.limits()
        same = len(set(hold.floor)) == 1 and len(set(hold.ceiling)) == 1 and len(set(limits)) == 1
        context: dict[str, Any] = {
            "prefix": prefix,
            "root": self.name,
            "upper": self.name.upper(),
            "real": self.precision.name,
            "n": size,
            "packed": hold.layout.count,
            "blocks": bool(hold.layout.blocks),
            "runs": [
                {"size": size, "count": len(list(group))}
                for size, group in groupby(len(block) for block in hold.layout.blocks)
            ],
            "zero": self.precision.literal(0.0),
            "sqrt": self.precision.function("sqrt"),
            "same": same,
            "limits": [self.precision.literal(item) for item in limits],
            "floored": any(
                item > 0 for item in hold.floor
            ),  # no variance is below a floor of zero: it was refused before
            "floors": [self.precision.literal(hold.floor[i]) for block in hold.layout.parts for i in block],
            "ceilings": [self.precision.literal(hold.ceiling[i]) for block in hold.layout.parts for i in block],
            "diagonal": [
                (at, self.precision.literal(item)) for at, item in zip(hold.layout.diagonal, hold.floor, strict=True)
            ],
        }
        if isinstance(hold, HoldFactors):
            text = templates().get_template("hold_factors.c.j2").render(**context, one=self.precision.literal(1.0))
            return [
                *text.rstrip("\n").split("\n"),
                *bounded_helper(prefix, self.precision, hold.layout, hold.floor, certain_factors(hold), "factors"),
            ]
        text = templates().get_template("hold_variances.c.j2").render(**context)
        return [
            *text.rstrip("\n").split("\n"), *bounded_helper(prefix, self.precision, hold.layout, hold.floor, limits)
        ]  # fmt: skip


def _calls_first(entries: list[Entry]) -> list[Entry]:
    """Order entries so that those called come before their callers."""
    return sorted(entries, key=lambda entry: is_sequenced(entry))


def _header_order() -> list[Status]:
    return sorted(Status, key=lambda status: (status < 0, abs(int(status))))


def _operations_text(operations: Counter[str]) -> str:
    words = ("addition", "multiplication", "division", "negation", "selection")
    counted = [f"{operations[w]} {w}{'' if operations[w] == 1 else 's'}" for w in words if operations[w]]
    functions = [
        name if count == 1 else f"{name} {count} times"
        for name, count in sorted(operations.items())
        if name not in words
    ]
    return ", ".join(counted + functions) + "." if counted or functions else ""


def _tidy(text: str) -> str:
    """Strip trailing blanks and repeated empty lines."""
    lines: list[str] = []
    for line in text.split("\n"):
        stripped = line.rstrip()
        if stripped or (lines and lines[-1]):
            lines.append(stripped)
    return "\n".join(lines).rstrip("\n") + "\n"
