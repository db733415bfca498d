"""Composing Blocks: parts called in order of direct feed-through, along wires."""

from __future__ import annotations

import contextlib
import copy
import hashlib
from collections.abc import Generator, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from .block import Block, Design, Scenario
from .errors import ModelError, expect
from .names import check_name, name_of
from .program import Assign, Call, Entry, Place, Refuse, Statement
from .signals import Kind, Signal, Status, check_default, same_unit


@dataclass(frozen=True)
class Delay:
    """A wire that hands on what its source was one step before."""

    source: str
    initial: Any


def delay(source: str, initial: Any = 0.0) -> Delay:
    """Return a wire that is one step late: it breaks a loop.

    Parameters
    ----------
    source : str
        ``part.signal``.
    initial : number or sequence
        Its value in the first step; a run-time parameter.
    """
    return Delay(source, initial)


def wires(
    source: str, target: str, names: Iterable[Any], *, initial: Mapping[Any, Any] | None = None
) -> dict[str, str | Delay]:
    """Return the wires between two parts for signals that have the same name in both.

    Parameters
    ----------
    source, target : str
        Parts: the one that has the signals, and the one whose inputs they are.
    names : iterable of str or Symbol
        The signals, such as ``plant.states`` or ``plant.inputs``.
    initial : dict or OperatingPoint, optional
        Name -> value in the first step: each wire is then one step late, see `delay`.

    Returns
    -------
    dict
        ``"target.name"`` -> ``"source.name"``, or a `delay` of it, for `connect`.

    Raises
    ------
    ModelError
        If `initial` has no value for a name.

    Examples
    --------
    >>> from plantc.symbolic.composition import wires
    >>> wires("estimator", "feedback", ["x", "vx"])
    {'feedback.x': 'estimator.x', 'feedback.vx': 'estimator.vx'}
    """
    started = None if initial is None else {name_of(key): value for key, value in initial.items()}
    answer: dict[str, str | Delay] = {}
    for name in map(name_of, names):
        if started is not None and name not in started:
            raise ModelError(
                f"the wires {source} -> {target}: initial= has no value for {name!r}; it has {', '.join(started) or 'none'}"
            )
        start = f"{source}.{name}"
        answer[f"{target}.{name}"] = start if started is None else delay(start, started[name])
    return answer


def connect(
    blocks: Mapping[str, Block] | Sequence[Block],
    wires: Mapping[str, str | Delay],
    name: str,
    *,
    settled: bool = False,
    doc: str = "",
) -> Block:
    """Return one Block made of parts.

    Parameters
    ----------
    blocks : dict of str to Block, or sequence of Block
        Parts by name (or under their own names); each has an entry `step`.
    wires : dict
        ``"part.input"`` -> ``"part.signal"`` or ``delay("part.signal", initial)``. A signal is an output of the part's
        `step`, or a field of its memory after it.
    name : str
        Name of the composition.
    settled : bool
        Whether an input is not judged again that is wired, without delay, to a field of another part's memory whose range is
        within its own: that part has judged the field in the same call, and has refused the whole were it outside.
    doc : str
        Its meaning.

    Returns
    -------
    Block
        Entries `init` and `step`. Inputs without a wire become inputs, named ``<part>_<input>``; memory, parameters and
        outputs are nested by part. The oracle is composed along the same wires if every part has one, and so are designed
        numbers (`design`), their names prefixed by part.

    Raises
    ------
    ModelError
        If a wire names what does not exist, sizes, kinds or units differ, parts feed each other in a loop without a
        delay (the loop is named), or parts have different time steps.
    """
    if not isinstance(blocks, Mapping):
        for k, block in enumerate(blocks):
            expect(block, Block, f"{name}: part {k}", "a Block, such as an estimator made of a plant")
    parts = dict(blocks) if isinstance(blocks, Mapping) else {block.name: block for block in blocks}
    if len(parts) != len(blocks):
        raise ModelError(
            f"{name}: two parts have the same name; give them names: connect({{'first': ..., 'second': ...}}, ...)"
        )
    composer = _Composer(parts, dict(wires), name, doc)
    if settled:
        composer.settle()
    return composer.build()


class _Composer:
    def __init__(self, parts: dict[str, Block], wires: dict[str, str | Delay], name: str, doc: str):
        self.parts, self.name = parts, name
        if not parts:
            raise ModelError(f"{name}: there is nothing to connect; give at least one block")
        for part, block in parts.items():
            check_name("part", part, name)
            expect(block, Block, f"{name}: the part {part!r}", "a Block, such as an estimator made of a plant")
            if "step" not in block.entries:
                raise ModelError(f"{name}: the part {part!r} has no entry 'step'; a part is called by it")
        self.block = Block(name, doc=doc or f"composition of {', '.join(block.name for block in parts.values())}")
        self.wires: dict[tuple[str, str], tuple[tuple[str, str], Delay | None]] = {}
        for target, given in wires.items():
            source = given.source if isinstance(given, Delay) else given
            end, start = self._split(target), self._split(source)
            self._check_wire(end, start)
            self.wires[end] = (start, given if isinstance(given, Delay) else None)

    def _split(self, text: str) -> tuple[str, str]:
        part, _, signal = text.partition(".")
        if part not in self.parts or not signal:
            raise ModelError(
                f"{self.name}: the wire end {text!r} is not part.signal; the parts are {', '.join(self.parts)}"
            )
        return part, signal

    def _input(self, part: str, name: str) -> Signal:
        for signal in self.parts[part].entries["step"].inputs:
            if signal.name == name:
                return signal
        known = ", ".join(signal.name for signal in self.parts[part].entries["step"].inputs)
        raise ModelError(f"{self.name}: the part {part!r} has no input {name!r}; it has {known or 'none'}")

    def _output(self, part: str, name: str) -> tuple[Signal, Place]:
        block = self.parts[part]
        for signal in block.memory_signals_flat():
            if signal.name == name:
                return signal, Place("next", f"{part}.{name}")
        members = block.entries["step"].outputs
        found: Signal | None = None
        for piece in name.split("."):
            found = next((item for item in members if item.name == piece), None)
            members = found.members if found else ()
        if found is None or found.kind is Kind.GROUP:
            known = [signal.name for signal in (*block.entries["step"].outputs, *block.memory_signals_flat())]
            raise ModelError(f"{self.name}: the part {part!r} has no signal {name!r}; it has {', '.join(known)}")
        return found, Place("out", f"{part}.{name}")

    def _check_wire(self, end: tuple[str, str], start: tuple[str, str]) -> None:
        target, (source, _) = self._input(*end), self._output(*start)
        text = f"{self.name}: the wire {'.'.join(start)} -> {'.'.join(end)}"
        if target.size != source.size or target.kind is not source.kind:
            raise ModelError(
                f"{text} joins {source.size} {source.kind.value} element(s) to {target.size} {target.kind.value}; they must match"
            )
        if not same_unit(target.unit, source.unit):
            raise ModelError(f"{text} joins [{source.unit}] to [{target.unit}]; convert the unit, or mend the wire")

    def settle(self) -> None:
        """Leave judged once what another part has judged as its memory."""
        judged: dict[str, list[str]] = {}
        for (part, name), (start, wire) in self.wires.items():
            target, (source, place) = self._input(part, name), self._output(*start)
            ends = all(low <= own for low, own in zip(target.low, source.low, strict=True))
            ends = ends and all(high >= own for high, own in zip(target.high, source.high, strict=True))
            if wire is None and place.space == "next" and target.kind is Kind.REAL and ends:
                judged.setdefault(part, []).append(name)
        made: dict[tuple[int, tuple[str, ...]], Block] = {}  # parts that are the very same Block stay so
        for part, names in judged.items():
            inner, key = self.parts[part], (id(self.parts[part]), tuple(names))
            self.parts[part] = made.setdefault(key, _settled(inner, tuple(names)))

    def order(self) -> list[str]:
        """Return the parts in an order in which every undelayed source comes first."""
        needs: dict[str, set[str]] = {part: set() for part in self.parts}
        for (part, _), ((source, _), late) in self.wires.items():
            if late is None:
                needs[part].add(source)
        answer: list[str] = []
        while len(answer) < len(self.parts):
            ready = [part for part in self.parts if part not in answer and needs[part] <= set(answer)]
            if not ready:
                loop = self._loop(needs, set(self.parts) - set(answer))
                raise ModelError(
                    f"{self.name}: {' -> '.join(loop)} feed each other within one step; put a delay on one of these wires: "
                    "delay('part.signal', initial)"
                )
            answer.append(ready[0])
        return answer

    @staticmethod
    def _loop(needs: dict[str, set[str]], left: set[str]) -> list[str]:
        path = [sorted(left)[0]]
        while path.count(path[-1]) < 2:
            path.append(sorted(needs[path[-1]] & left)[0])
        return list(reversed(path[path.index(path[-1]) :]))

    def build(self) -> Block:
        """Assemble."""
        block = self.block
        block.parts = self.parts
        order = self.order()
        init: list[Statement] = [Call("init", (), None, part) for part in order]
        body: list[Statement] = []
        late: list[Statement] = []
        inputs: list[Signal] = []
        for part in order:
            arguments: list[tuple[str, Place | float]] = []
            for signal in self.parts[part].entries["step"].inputs:
                wire = self.wires.get((part, signal.name))
                if wire is None:
                    name = f"{part}_{signal.name}"
                    inputs.append(replace(signal, name=name))
                    arguments.append((signal.name, Place("in", name)))
                elif wire[1] is None:
                    arguments.append((signal.name, self._output(*wire[0])[1]))
                else:
                    field = self._add_delay(part, signal, wire[1])
                    arguments.append((signal.name, Place("memory", field)))
                    init.append(Assign(Place("next", field), Place("param", f"{field}_0"), signal.size))
                    late.append(Assign(Place("next", field), self._output(*wire[0])[1], signal.size))
            outputs = Place("out", part) if self.parts[part].entries["step"].outputs else None
            body.append(Call("step", tuple(arguments), outputs, part))
        body += late
        delays = [signal.name for signal in block.memory_signals]
        if delays:
            body.append(Refuse(Status.OVERFLOW, block.judge_memory(delays)))
        groups = tuple(
            Signal(part, kind=Kind.GROUP, members=self.parts[part].entries["step"].outputs, doc=f"what {part} gave")
            for part in order
            if self.parts[part].entries["step"].outputs
        )
        doc = "Start (or start again) from the parameters; every parameter is checked here."
        block.entries = {
            "init": Entry("init", (), (), tuple(init), doc, checks_params=True),
            "step": Entry("step", tuple(inputs), groups, tuple(body), f"Call {', then '.join(order)}."),
        }
        block.equations = [f"{part}: {line}" for part in order for line in self.parts[part].equations]
        block.notes = [
            f"{'.'.join(end)} = {'.'.join(start)}{', one step late' if late_ else ''}"
            for end, (start, late_) in self.wires.items()
        ]
        block.source_hash = _source_hash(block, order)
        block.sample_time = self._sample_time()
        block.float_bound = max(part.float_bound for part in self.parts.values())
        block.check()
        if all(part.oracle is not None for part in self.parts.values()):
            block.oracle = ComposedOracle(block, order)
        block.scenario = self._scenario()
        block.design = _composed_design(block, order)
        return block

    def _sample_time(self) -> float | None:
        """Return the time step that the parts share, None if none of them has one."""
        times = {part: block.sample_time for part, block in self.parts.items() if block.sample_time is not None}
        if len(set(times.values())) > 1:
            said = ", ".join(f"{part} {time:g} s" for part, time in times.items())
            raise ModelError(f"{self.name}: the parts have different time steps ({said}); a composition has one")
        return next(iter(times.values()), None)

    def _add_delay(self, part: str, signal: Signal, wire: Delay) -> str:
        field = f"delay_{part}_{signal.name}"
        values = check_default(
            self.name, f"the delay before {part}.{signal.name}", wire.initial, signal.low, signal.high
        )
        doc = f"{part}.{signal.name} of the next step"
        self.block.memory_signals.append(replace(signal, name=field, doc=doc))
        self.block.param_signals.append(
            replace(signal, name=f"{field}_0", default=values, doc=f"first {part}.{signal.name}")
        )
        return field

    def _scenario(self) -> Scenario | None:
        """Combine the scenarios of the parts, if they have any."""
        given = {part: block.scenario for part, block in self.parts.items() if block.scenario is not None}
        if not given:
            return None
        block, parts = self.block, self.parts
        late: dict[str, dict[str, str]] = {}
        for (part, name), (_, wire) in self.wires.items():
            if wire is not None:
                late.setdefault(part, {})[name] = f"delay_{part}_{name}"

        def calls(rng: Any, steps: int) -> Iterator[tuple[str, dict[str, Any]]]:
            if late and block.oracle is not None:
                yield from _closed_loop(block, given, late, rng, steps)
                return
            streams = {part: _steps_of(scenario, rng) for part, scenario in given.items()}
            yield "init", {}
            for _ in range(steps):
                values: dict[str, Any] = {}
                drawn = {part: next(stream) for part, stream in streams.items()}
                for signal in block.entries["step"].inputs:
                    part = next(item for item in parts if signal.name.startswith(f"{item}_"))
                    own = signal.name.removeprefix(f"{part}_")
                    known = drawn.get(part, {})
                    values[signal.name] = known[own] if own in known else _drawn(rng, signal)
                yield "step", values

        def memory(rng: Any) -> dict[str, Any]:
            starts = {signal.name: signal.default for signal in block.param_signals}
            values = {item.name: _drawn_near(rng, item, starts[f"{item.name}_0"]) for item in block.memory_signals}
            for part, inner in parts.items():
                own = (
                    given[part].memory(rng)
                    if part in given
                    else {s.name: _drawn(rng, s) for s in inner.memory_signals_flat()}
                )
                values |= {f"{part}.{key}": value for key, value in own.items()}
            return values

        def scales(values: Mapping[str, Any]) -> dict[str, Any]:
            answer: dict[str, Any] = {}
            for part, scenario in given.items():
                if scenario.scales is not None:
                    own = {
                        key.removeprefix(f"{part}."): item for key, item in values.items() if key.startswith(f"{part}.")
                    }
                    answer |= {f"{part}.{key}": item for key, item in scenario.scales(own).items()}
            return answer

        return Scenario(calls, memory, scales)


def _settled(block: Block, names: tuple[str, ...]) -> Block:
    """Return a copy of a block whose `step` does not judge some of its inputs, whatever its numbers."""
    made = copy.copy(block)
    made.entries = {**block.entries, "step": replace(block.entries["step"], settled=names)}
    if block.design is not None:
        rebuild = block.design.rebuild
        made.design = replace(block.design, rebuild=lambda values: _settled(rebuild(values), names))
    return made


def _closed_loop(
    block: Block, given: dict[str, Scenario], late: dict[str, dict[str, str]], rng: Any, steps: int
) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield calls in which what a part reads answers to what the delayed wires bring back to it.

    A controller's readings would else come from a plant that it does not move: soon no command would suffice.
    """
    assert block.oracle is not None
    params = {signal.name: np.array(signal.default, dtype=float) for signal in block.param_signals_flat()}
    signals = block.entries["step"].inputs
    owners = {item.name: next(part for part in block.parts if item.name.startswith(f"{part}_")) for item in signals}
    streams: dict[str, _Stream] = {}
    memory: dict[str, Any] = {}
    drawn: dict[str, dict[str, Any] | None] = {"": None}
    for _ in range(steps + 1):
        if None in drawn.values():  # the beginning, or what a part follows has started anew
            streams = {part: _Stream(given[part], rng) for part in given if part in owners.values()}
            memory = dict(block.oracle.call("init", {}, {}, params, np.float64)[1])
            yield "init", {}
        else:
            inputs = {}
            for signal in signals:
                part = owners[signal.name]
                own, known = signal.name.removeprefix(f"{part}_"), drawn.get(part) or {}
                inputs[signal.name] = np.atleast_1d(known[own] if own in known else _drawn(rng, signal))
            status, after, _ = block.oracle.call("step", memory, inputs, params, np.float64)
            if status >= 0:
                memory |= after
            yield "step", inputs
        drawn = {
            part: stream.step({name: memory[field] for name, field in late.get(part, {}).items()})
            for part, stream in streams.items()
        }


class _Stream:
    """The steps of a part's scenario."""

    def __init__(self, scenario: Scenario, rng: Any):
        self.calls = scenario.calls(rng, 200)
        next(self.calls, None)  # init

    def step(self, told: Mapping[str, Any]) -> dict[str, Any] | None:
        """Return the inputs of the next step, told what some of them will be; None where the part starts anew."""
        with contextlib.suppress(StopIteration):
            while True:
                entry, inputs = self.calls.send(told) if isinstance(self.calls, Generator) else next(self.calls)
                if entry in ("init", "step"):
                    return inputs if entry == "step" else None
        return None


def _steps_of(scenario: Scenario, rng: Any) -> Iterator[dict[str, Any]]:
    while True:
        for entry, inputs in scenario.calls(rng, 200):
            if entry == "step":
                yield inputs


def _drawn(rng: Any, signal: Signal) -> Any:
    if signal.kind is Kind.FLAG:
        return True
    if signal.kind is Kind.COUNT:
        return 0
    return rng.uniform(np.array(signal.low), np.array(signal.high))


def _drawn_near(rng: Any, signal: Signal, start: Any) -> Any:
    """Return a value of a delay near its first one: far from it the parts may refuse it."""
    if signal.kind is not Kind.REAL or start is None:
        return _drawn(rng, signal)
    centre, low, high = np.array(start), np.array(signal.low), np.array(signal.high)
    size = np.minimum(0.1 * (1 + np.abs(centre)), 0.1 * (high - low))
    return np.clip(centre + size * rng.normal(size=signal.size), low, high)


def _source_hash(block: Block, order: list[str]) -> str:
    return "|".join(block.parts[part].source_hash for part in order) + repr(sorted(block.notes))


def _composed_design(block: Block, order: list[str]) -> Design | None:
    """Return the designed numbers of all parts as those of the whole, or None if there are none."""
    designs = {part: inner.design for part, inner in block.parts.items() if inner.design is not None}
    if not designs:
        return None
    source = hashlib.sha256(repr([(part, item.source) for part, item in sorted(designs.items())]).encode())

    def own(values: dict[str, Any], part: str) -> dict[str, Any]:
        answer = {name: values[f"{part}.{name}"] for name in designs[part].values if f"{part}.{name}" in values}
        missing = sorted(set(designs[part].values) - set(answer))
        if missing:
            raise ModelError(f"{block.name}: design.json has no {part}.{missing[0]}; export with --redesign")
        return answer

    def rebuild(values: dict[str, Any]) -> Block:
        made = copy.copy(block)
        rebuilt: dict[tuple[int, str], Block] = {}  # parts that are the same Block, with the same numbers, stay so
        made.parts = {}
        for part, inner in block.parts.items():
            if part in designs:
                given = own(values, part)
                key = id(inner), repr(sorted((name, np.asarray(item).tolist()) for name, item in given.items()))
                if key not in rebuilt:
                    rebuilt[key] = designs[part].rebuild(given)
                inner = rebuilt[key]
            made.parts[part] = inner
        made.source_hash = _source_hash(made, order)
        if isinstance(block.oracle, ComposedOracle):
            made.oracle = ComposedOracle(made, order)
        made.design = _composed_design(made, order)
        return made

    def properties(values: dict[str, Any]) -> dict[str, tuple[float, float]]:
        return {
            f"{part}: {name}": pair
            for part, item in designs.items()
            for name, pair in item.properties(own(values, part)).items()
        }

    values = {f"{part}.{name}": value for part, item in designs.items() for name, value in item.values.items()}
    return Design(values, source.hexdigest()[:16], rebuild, properties)


class ComposedOracle:
    """The oracles of the parts, called in the same order along the same wires."""

    def __init__(self, block: Block, order: list[str]):
        self.block, self.order = block, order

    def call(
        self,
        entry: str,
        memory: Mapping[str, Any],
        inputs: Mapping[str, Any],
        params: Mapping[str, Any],
        precision: type,
    ) -> tuple[int, dict[str, Any], dict[str, Any]]:
        """Run the statements of the composition on the parts' oracles."""
        block = self.block
        values: dict[Place, Any] = {Place("memory", key): value for key, value in memory.items()}
        values |= {Place("in", key): value for key, value in inputs.items()}
        values |= {Place("param", key): value for key, value in params.items()}
        status = 0
        if entry == "init":
            for signal in block.param_signals:
                given = np.asarray(params[signal.name])
                if not np.all((given >= precision(signal.low)) & (given <= precision(signal.high))):
                    return int(Status.BAD_PARAM), {}, {}
        for statement in block.entries[entry].body:
            if isinstance(statement, Call):
                prefix = f"{statement.part}."
                oracle = block.parts[statement.part].oracle
                assert oracle is not None
                own, after, outputs = oracle.call(
                    statement.entry,
                    {key.removeprefix(prefix): value for key, value in memory.items() if key.startswith(prefix)},
                    {
                        key: values[item] if isinstance(item, Place) else np.array([item])
                        for key, item in statement.arguments
                    },
                    {key.removeprefix(prefix): value for key, value in params.items() if key.startswith(prefix)},
                    precision,
                )
                if own < 0:
                    return own, {}, {}
                status = max(status, own)
                values |= {Place("next", prefix + key): value for key, value in after.items()}
                values |= {Place("out", prefix + key): value for key, value in outputs.items()}
            elif isinstance(statement, Assign) and isinstance(statement.source, Place):
                values[statement.target] = np.atleast_1d(values[statement.source])
        for signal in block.memory_signals:
            given = np.asarray(values[Place("next", signal.name)])
            if not np.all((given >= precision(signal.low)) & (given <= precision(signal.high))):
                return int(Status.OVERFLOW), {}, {}
        after = {place.name: value for place, value in values.items() if place.space == "next"}
        return status, after, {place.name: value for place, value in values.items() if place.space == "out"}
