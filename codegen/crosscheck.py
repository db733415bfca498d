"""Lockstep: every view starts each call from the same memory and inputs, and the maps are compared.

What is measured is said; what differs is shown with the first step, entry and signal, and both values.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ..symbolic.block import Block, Scenario
from ..symbolic.program import Entry
from ..symbolic.signals import Kind, Signal, Status
from .findings import CheckResult, Mismatch
from .kinks import on_every_piece
from .layout import fill, flatten
from .views import Answer, InterpretView, NativeView, Record, ReferenceView, View

DOUBLE_BOUND = 1e-9
"""Largest accepted difference between views in double precision, in sigma (or relative)."""

RELATIVE_FLOAT_BOUND = 2e-3
"""Largest accepted difference of float from double where no sigma is known, relative to the largest value so far."""

SWITCH_MARGIN = {"double": 1e-9, "float": 1e-3}
"""Relative distance from a switch below which rounding may take either branch."""

LARGEST_SHARE_AT_SWITCHES = 0.05
ROUNDING_GROWTH = 100.0
"""Units in the last place by which a memory is moved to see whether rounding may turn one status into another."""

IMPLAUSIBLE = ("adversarial", "kinks", "crafted")
"""Traces of calls made as bad as they can be, among them candidates for vectors (which ship none near a switch)."""

ON_KINKS = "kinks"
"""Trace of calls with an argument of a piecewise function on a kink, where every view takes the same branch: no rounding
excuses a difference."""

LARGEST_GROWTH = 10.0
"""A difference is excused up to this many times what one unit in the last place of memory and inputs causes."""

LARGEST_AT_SWITCH = {False: 1.0, True: 10.0}
"""An implausible call that only rounding accepts may differ by this much, in sigma or of its own magnitude: between views on one
machine, and between machines, where fused products gave 6.7."""

LARGEST_SHARE_ILL_CONDITIONED = 0.05
LEAST_SHARE_ACCEPTED = {True: 0.95, False: 0.5}
"""Of the nominal calls: where the block says what is nominal, and where its inputs are drawn from their whole ranges."""

VERDICTS = (Status.BAD_INPUT, Status.BAD_PARAM)
"""What is said of what the caller gave, which every view knows to the last bit."""

DERIVATIVE_BOUND = 1e-9
DIFFERENCE_BOUND = 1e-4
LARGEST_COUNT = 2**32 - 1
NARROW_GATE = 1e-9
TRACES = ("nominal", "randomised", "adversarial")


@dataclass
class CrossCheck:
    """All checks of a block."""

    results: list[CheckResult]
    statuses: dict[str, int] = field(default_factory=dict)
    calls: list[Probe] = field(default_factory=list)

    @property
    def passed(self) -> bool:
        """Whether every check passed."""
        return all(result.passed for result in self.results)

    @property
    def failures(self) -> list[CheckResult]:
        """The checks that did not pass."""
        return [result for result in self.results if not result.passed]


@dataclass
class Probe:
    """One call of a lockstep: where it starts, and what the native view answered."""

    trace: str
    step: int
    entry: str
    memory: Record
    inputs: Record
    params: Record
    answer: Answer | None = None


@dataclass(frozen=True)
class Excuse:
    """A difference beyond its limit that rounding of the memory explains.

    Attributes
    ----------
    difference : float
        What it is, in sigma (or relative).
    explained : float
        What one unit in the last place of memory and inputs causes there; infinite where the call is refused then.
    probe : Probe
        Where.
    signal : str
        Of what.
    """

    difference: float
    explained: float
    probe: Probe
    signal: str

    def __str__(self) -> str:
        where = f"{self.difference:.3g} at {self.probe.trace} step {self.probe.step}, {self.probe.entry}, {self.signal}"
        if math.isinf(self.explained):
            return f"{where}, a call that is refused a rounding away"
        return f"{where}, where one unit in the last place causes {self.explained:.3g}"


@dataclass
class Views:
    """The views of one lockstep; tests replace one to plant a fault."""

    interpret: View
    native: View
    reference: View | None
    reference_same_precision: View | None
    interpret_same_limits: View | None = None


def make_views(block: Block, precision: str, native: View | None = None) -> Views:
    """Return every view there is."""
    has_oracle = block.oracle is not None
    return Views(
        InterpretView(block),
        native or NativeView(block, precision),
        ReferenceView(block) if has_oracle else None,
        ReferenceView(block, precision) if has_oracle else None,
        InterpretView(block, limits=precision),
    )


def cross_check(
    block: Block,
    precision: str = "double",
    *,
    views: Views | None = None,
    steps: int = 100,
    seed: int = 0,
    progress: Callable[[int, int], None] | None = None,
) -> CrossCheck:
    """Run all views in lockstep on a nominal, a randomised and an adversarial trace.

    Parameters
    ----------
    block : Block
        What to check.
    precision : {"double", "float"}
        Of the generated C. Float is also compared with double, from the same memory, within ``block.float_bound``.
    views : Views, optional
        Views to use instead of the standard ones.
    steps : int
        Length of the nominal trace; the others follow from it.
    seed : int
        Of the random generator.
    progress : callable, optional
        Called with (calls done, calls in all).

    Returns
    -------
    CrossCheck
        Named results; ``passed`` says whether all are good.
    """
    used = views or make_views(block, precision)
    lock = Lockstep(block, precision, used)
    probes = make_probes(block, precision, used, steps, seed)
    for done, probe in enumerate(probes, start=1):
        lock.compare(probe)
        if progress is not None:
            progress(done, len(probes))
    results = [*_derivative_results(block, probes), *lock.results()]
    results.append(_accepted(block, probes))
    counts: dict[str, int] = {}
    for probe in probes:
        if probe.answer is not None:
            counts[probe.answer.status.name] = counts.get(probe.answer.status.name, 0) + 1
    return CrossCheck(results, counts, probes)


def compare_answers(
    block: Block,
    precision: str,
    native: View,
    name: str,
    probes: list[Probe],
    answers: list[Answer],
    limit: float,
) -> CheckResult:
    """Compare what another machine answered to the calls of a lockstep with the native view, within a limit.

    Parameters
    ----------
    block : Block
        What was run.
    precision : {"double", "float"}
        Of the C.
    native : View
        Whose answers the probes carry.
    name : str
        Of the result: ``"<other> = native"``.
    probes : list of Probe
        The calls, with the native view's answers.
    answers : list of Answer
        The other machine's, in the same order.
    limit : float
        Largest accepted difference, in sigma (or relative).
    """
    lock = Lockstep(block, precision, make_views(block, precision, native))
    for probe, answer in zip(probes, answers, strict=True):
        if probe.answer is not None:
            lock.pair(name, probe, answer, probe.answer, limit)
    return next(result for result in lock.results() if result.name == name)


def _accepted(block: Block, probes: list[Probe]) -> CheckResult:
    """A trace on which calls are refused compares little."""
    answers = [probe.answer for probe in probes if probe.trace == "nominal" and probe.answer is not None]
    refused = Counter(answer.status.name for answer in answers if answer.status < 0)
    good = len(answers) - refused.total()
    least = LEAST_SHARE_ACCEPTED[block.scenario is not None]
    result = CheckResult("nominal calls are accepted", good >= least * len(answers), calls=len(answers))
    if refused:
        by_status = ", ".join(f"{count} {name}" for name, count in sorted(refused.items()))
        result.note = f"{refused.total()} of {len(answers)} nominal calls were refused ({by_status})"
    if not result.passed:
        result.note += (
            f", more than {100 * (1 - least):.0f} %; widen the ranges of what is refused, or mend the scenario"
        )
    return result


# ---------------------------------------------------------------------------------------------------------------------
# What is called


class FrozenStream:
    """Random numbers that are the same under any version of NumPy (its legacy stream, which is frozen)."""

    def __init__(self, seed: int):
        self._state = np.random.RandomState(seed)

    def normal(self, *args: Any, **kwargs: Any) -> Any:
        """Draw from a normal distribution."""
        return self._state.normal(*args, **kwargs)

    def uniform(self, *args: Any, **kwargs: Any) -> Any:
        """Draw from a uniform distribution."""
        return self._state.uniform(*args, **kwargs)

    def integers(self, low: int, high: int | None = None, size: Any = None) -> Any:
        """Draw integers below `high`."""
        return self._state.randint(low, high, size=size)


def make_probes(block: Block, precision: str, views: Views, steps: int, seed: int) -> list[Probe]:
    """Return the calls of the three traces, the same for the same seed."""
    scenario = block.scenario or default_scenario(block)
    native = views.native
    guide = views.reference or views.interpret
    rng: Any = FrozenStream(seed)
    params = native.params()
    nominal = list(_nominal(block, scenario, native, guide, params, steps, rng))
    randomised = []
    plausible = [probe for probe in nominal if probe.entry != "init"]
    for step in range(steps // 2):
        source = plausible[int(rng.integers(len(plausible)))]
        memory = fill(native.memory(), scenario.memory(rng)) if step % 2 else source.memory
        varied = _varied(block, params, rng)
        randomised.append(Probe("randomised", step, source.entry, memory, source.inputs, varied))
        if step % 10 == 0:
            randomised.append(Probe("randomised", step, "init", native.memory(), native.inputs("init", {}), varied))
    adversarial = list(_adversarial(block, scenario, native, plausible, params, rng))
    return [*nominal, *randomised, *adversarial]


def _varied(block: Block, params: Record, rng: Any) -> Record:
    """Return parameters near their defaults, within their ranges; one that is zero becomes of order one.

    A parameter that the C took for a constant, or a switch that is off by default, is seen so.
    """
    values: dict[str, Any] = {}
    for signal in block.param_signals_flat():
        default = np.array(signal.default if signal.default is not None else (0.0,) * signal.size)
        if signal.kind is Kind.COUNT:
            values[signal.name] = int(rng.integers(4))
        elif signal.kind is Kind.REAL:
            low, high = np.array(signal.low), np.array(signal.high)
            mixed = bool(np.any(low < 0)) and bool(np.any(low >= 0))  # a packed matrix: one factor keeps it definite
            factor = rng.uniform(0.7, 1.4, size=1 if mixed else signal.size)
            drawn = np.where(default == 0, 0.0 if mixed else 4.0 ** rng.uniform(-2, 2), default * factor)
            if signal.low[0] < 0 and not mixed:
                drawn = np.where(default == 0, 0.0, drawn)  # an initial value of zero is a good one
            values[signal.name] = np.clip(drawn, low, high)
    return fill(params.copy(), values)


def _nominal(
    block: Block, scenario: Scenario, native: View, guide: View, params: Record, steps: int, rng: np.random.Generator
) -> Iterator[Probe]:
    memory = native.memory()
    guide_params = fill(guide.params(), flatten(params))
    for step, (entry, values) in enumerate(scenario.calls(rng, steps)):
        inputs = native.inputs(entry, values)
        yield Probe("nominal", step, entry, memory, inputs, params)
        answer = guide.call(
            entry, fill(guide.memory(), flatten(memory)), fill(guide.inputs(entry, {}), flatten(inputs)), guide_params
        )
        if answer.status >= 0:
            memory = fill(native.memory(), flatten(answer.memory))


def _adversarial(
    block: Block,
    scenario: Scenario,
    native: View,
    plausible: list[Probe],
    params: Record,
    rng: np.random.Generator,
) -> Iterator[Probe]:
    """Yield calls with one thing made as bad as it can be."""
    step = 0

    def probe(entry: str, memory: Record, inputs: Record, used: Record) -> Probe:
        nonlocal step
        step += 1
        return Probe("adversarial", step - 1, entry, memory, inputs, used)

    for name, entry in block.entries.items():
        sources = [item for item in plausible if item.entry == name] or [
            Probe("adversarial", 0, name, fill(native.memory(), scenario.memory(rng)), _middle(native, entry), params)
        ]
        for signal in (item for item in entry.inputs if item.kind is Kind.REAL):
            # the entry that does everything meets every bad value, the others the worst of them
            values = _bad_values(signal, native.precision.dtype)
            for value in values if name == "step" else (values[0], values[3], values[5]):
                source = sources[int(rng.integers(len(sources)))]
                yield probe(name, source.memory, _with_element(source.inputs, signal, value, rng), params)
        if entry.checks_params:
            for signal in (item for item in block.param_signals_flat() if item.kind is Kind.REAL):
                for value in _bad_values(signal, native.precision.dtype)[3:6:2]:  # just outside on either side
                    yield probe(
                        name, native.memory(), native.inputs(name, {}), _with_element(params, signal, value, rng)
                    )
            for whole in _indefinite(block, params):
                yield probe(name, native.memory(), native.inputs(name, {}), whole)
            continue
        for signal in block.memory_signals_flat():
            for value in _memory_extremes(signal):
                source = sources[int(rng.integers(len(sources)))]
                yield probe(name, _with_element(source.memory, signal, value, rng), source.inputs, params)
        for signal in (
            item for item in block.param_signals_flat() if item.kind is Kind.REAL and "variance" in item.name
        ):
            # no noise at all, and negative noise: parameters that init would refuse
            for value in (0.0, -1.0e3):
                source = sources[int(rng.integers(len(sources)))]
                whole = fill(params.copy(), {signal.name: np.full(signal.size, value)})
                yield probe(name, source.memory, source.inputs, whole)
        for whole in _indefinite(block, params):
            source = sources[int(rng.integers(len(sources)))]
            yield probe(name, source.memory, source.inputs, whole)
        source = sources[0]
        for move in on_every_piece(block, entry, flatten(source.memory), flatten(source.inputs), flatten(params)):
            place = move.element.place
            moved = source.memory if place.space == "memory" else source.inputs
            elements = flatten(moved)[place.name].copy()
            elements[move.element.index] = move.number
            moved = fill(moved.copy(), {place.name: elements})
            given = (moved, source.inputs) if place.space == "memory" else (source.memory, moved)
            made = probe(name, *given, params)
            yield replace(made, trace=ON_KINKS) if move.on_kink else made
        for factor in (1.0e-12, 1.0e6, 1.0e12):
            source = sources[int(rng.integers(len(sources)))]
            yield probe(name, _scaled_arrays(source.memory, block, factor), source.inputs, params)
    yield from _recoveries(block, native, plausible, params, probe)
    yield from _long_gaps(block, scenario, native, plausible, params, probe)


def _recoveries(
    block: Block, native: View, plausible: list[Probe], params: Record, probe: Callable[..., Probe]
) -> Iterator[Probe]:
    """Yield calls with counters around a limit, and at the largest number.

    With gates as they are, and so narrow that all readings are refused, which counts.
    """
    counters = [signal.name for signal in block.memory_signals_flat() if signal.kind is Kind.COUNT]
    limits = [signal.name for signal in block.param_signals_flat() if signal.kind is Kind.COUNT]
    if not counters:
        return
    narrow = fill(params.copy(), {item.name: np.full(item.size, NARROW_GATE) for item in gates(block)})
    pairs = [(count, limit) for limit in (2,) for count in (1, 2, 3)] if limits else []
    pairs += [(LARGEST_COUNT + k, limit) for k in (-1, 0) for limit in ((0, LARGEST_COUNT) if limits else (0,))]
    for name, entry in block.entries.items():
        sources = [item for item in plausible if item.entry == name]
        flags = {signal.name: True for signal in entry.inputs if signal.kind is Kind.FLAG}
        for k, (count, limit) in enumerate(pairs * 3 if sources else []):
            source = sources[k % len(sources)]
            used = fill((params if k < len(pairs) else narrow).copy(), dict.fromkeys(limits, limit))
            inputs = fill(source.inputs.copy(), flags) if k % 2 else source.inputs
            yield probe(name, fill(source.memory.copy(), dict.fromkeys(counters, count)), inputs, used)


def gates(block: Block) -> list[Signal]:
    """Return the parameters beyond which what is read is refused: off by default, or set by the calls inside a block."""
    hidden = {place.name for entry in block.entries.values() for _, place in entry.hidden}
    for prefix, part in block.parts.items():
        hidden |= {f"{prefix}.{signal.name}" for signal in gates(part)}
    return [
        signal
        for signal in block.param_signals_flat()
        if signal.kind is Kind.REAL
        and signal.low[0] <= NARROW_GATE <= signal.high[0]
        and (signal.name in hidden or (signal.default is not None and not any(signal.default) and signal.low[0] == 0))
    ]


def _long_gaps(
    block: Block, scenario: Scenario, native: View, plausible: list[Probe], params: Record, probe: Callable[..., Probe]
) -> Iterator[Probe]:
    """Yield calls in a row at both ends of the time step's range."""
    if not scenario.gaps:
        return
    for source in plausible:
        if source.entry != "predict":
            continue
        signal = next(item for item in block.entries["predict"].inputs if item.name == scenario.gaps)
        for value in (signal.high[0], signal.low[0]):
            inputs = fill(source.inputs.copy(), {scenario.gaps: value})
            memory = source.memory
            for _ in range(8):
                yield probe("predict", memory, inputs, params)
                memory = native.call("predict", memory, inputs, params).memory
        return


def _bad_values(signal: Signal, real: Any) -> list[float]:
    """Return values at and beyond what a signal may be."""
    low, high = signal.low[0], signal.high[0]
    outside = float(np.nextafter(real(high), real(np.inf)))
    below = float(np.nextafter(real(low), real(-np.inf)))
    tiny = float(np.finfo(real).smallest_subnormal)
    span = max(abs(low), abs(high))
    return [
        math.nan, math.inf, high, outside, low, below, high + 1e-5 * span, low - 1e-5 * span, -math.inf, 10 * high + 1,
        0.0, -0.0, tiny, -tiny, math.pi, -math.pi,
    ]  # fmt: skip


def _memory_extremes(signal: Signal) -> list[float]:
    """Return values at the ends of what a memory field may be."""
    if signal.kind is Kind.COUNT:
        return [0, 2**32 - 1]
    if signal.kind is not Kind.REAL or signal.uniform_range is None:
        return []
    return [signal.low[0], signal.high[0], 0.0] + ([math.pi, -math.pi] if signal.angle else [])


def _with_element(record: Record, signal: Signal, value: float, rng: np.random.Generator) -> Record:
    """Return a copy of a record with one element of a field replaced."""
    array = flatten(record)[signal.name].copy()
    with np.errstate(all="ignore"):
        array[int(rng.integers(signal.size))] = value
    return fill(record.copy(), {signal.name: array})


def _scaled_arrays(record: Record, block: Block, factor: float) -> Record:
    """Return a copy as uncertain times a factor: near the floors or the ceilings of its variances."""
    if block.scenario is not None and block.scenario.scaled is not None:
        return fill(record.copy(), block.scenario.scaled(flatten(record), factor))
    fields = flatten(record)
    names = [s.name for s in block.memory_signals_flat() if s.kind is Kind.REAL and s.uniform_range is None]
    return fill(record.copy(), {name: fields[name] * fields[name].dtype.type(factor) for name in names})


def _indefinite(block: Block, params: Record) -> Iterator[Record]:
    """Yield parameters in which a packed matrix (elements of either sign beside positive ones) is indefinite."""
    for signal in block.param_signals_flat():
        low = np.array(signal.low)
        if (
            signal.kind is not Kind.REAL
            or signal.uniform_range is not None
            or not (np.any(low < 0) and np.any(low >= 0))
        ):
            continue
        values = flatten(params)[signal.name].astype(float)
        for factor in (1.5, -1.5):
            yield fill(params.copy(), {signal.name: np.where(low < 0, factor * np.max(values[low >= 0]), values)})


def _middle(native: View, entry: Entry) -> Record:
    values = {s.name: np.clip(np.zeros(s.size), s.low, s.high) for s in entry.inputs if s.kind is Kind.REAL}
    flags = {s.name: True for s in entry.inputs if s.kind is Kind.FLAG}
    return native.inputs(entry.name, {**values, **flags})


def default_scenario(block: Block) -> Scenario:
    """Return a scenario that draws everything from its range: for blocks that bring none."""

    def draw(rng: np.random.Generator, signal: Signal) -> Any:
        if signal.kind is Kind.FLAG:
            return bool(rng.integers(2))
        if signal.kind is Kind.COUNT:
            return int(rng.integers(5))
        return rng.uniform(signal.low, signal.high)

    def calls(rng: np.random.Generator, steps: int) -> Iterator[tuple[str, dict[str, Any]]]:
        yield "init", {}
        names = [name for name in block.entries if name != "init"]
        for k in range(steps):
            entry = block.entries[names[k % len(names)]]
            yield entry.name, {signal.name: draw(rng, signal) for signal in entry.inputs}

    def memory(rng: np.random.Generator) -> dict[str, Any]:
        return {signal.name: draw(rng, signal) for signal in block.memory_signals_flat()}

    return Scenario(calls, memory)


# ---------------------------------------------------------------------------------------------------------------------
# How it is compared


class Lockstep:
    """Runs probes in all views and keeps the worst difference of each pair."""

    def __init__(self, block: Block, precision: str, views: Views):
        self.block, self.precision, self.views = block, precision, views
        self.single = precision == "float"
        self.exact = views.interpret_same_limits or InterpretView(block, limits=precision)
        self.pairs: dict[str, CheckResult] = {}
        self.angles = {signal.name for signal in block.memory_signals_flat() if signal.angle}
        for entry in block.entries.values():
            self.angles |= {name for name, signal in _leaves(entry.outputs) if signal.angle}
        self.status_fields = {
            name: [field_name for field_name, signal in _leaves(entry.outputs) if signal.kind is Kind.STATUS]
            for name, entry in block.entries.items()
        }
        self.largest: dict[tuple[str, str, str], Any] = {}
        self.excused: dict[str, list[Excuse]] = {}
        self.scales = None if block.scenario is None else block.scenario.scales
        self.between_machines = False
        self.compared = 0

    def compare(self, probe: Probe) -> None:
        """Run one call everywhere."""
        self.compared += 1
        native = self.views.native.call(probe.entry, probe.memory, probe.inputs, probe.params)
        probe.answer = native
        self._untouched(probe, native)
        interpret = self._converted(self.views.interpret, probe)
        margin = interpret.margin
        exact = self._converted(self.exact, probe) if self.single else interpret
        self._verdicts(probe, native, exact)
        reference = None if self.views.reference is None else self._converted(self.views.reference, probe)
        if reference is not None:
            self._pair("interpret = reference", probe, interpret, reference, margin, 1e-9)
        if not self.single:
            if reference is not None:
                self._pair("native = reference", probe, native, reference, margin, 1e-9)
            self._pair("native = interpret", probe, native, interpret, margin, 1e-9)
            return
        other = self.views.reference_same_precision
        if other is not None:
            same = self._converted(other, probe)
            self._statuses("float statuses = reference in float", probe, native, same, margin, other)
        self._statuses("float statuses = interpret", probe, native, exact, exact.margin)
        best = interpret if reference is None else reference
        self._pair("float = double", probe, native, best, margin, self.block.float_bound, statuses=False)

    def agreement(self, name: str) -> CheckResult:
        """Return whether the views agreed on all calls so far, as one result; the calls are too few for shares."""
        found = list(self.pairs.values())
        worst = max(found, key=lambda item: (item.mismatch is not None, item.worst), default=None)
        result = CheckResult(name, all(item.passed for item in found), calls=self.compared)
        if worst is not None:
            result.worst, result.limit, result.mismatch = worst.worst, worst.limit, worst.mismatch
        near = sum(item.at_switches for item in found)
        excuses = [item for items in self.excused.values() for item in items]
        notes = [f"{near} comparison(s) near a switch"] if near else []
        if excuses:
            notes.append(f"the largest of {len(excuses)} excused {max(excuses, key=lambda item: item.difference)}")
        result.note = "; ".join(notes)
        return result

    def pair(self, name: str, probe: Probe, left: Answer, right: Answer, limit: float) -> None:
        """Compare two answers that were already given."""
        self.between_machines = True
        witness = self.views.reference_same_precision if self.single else None
        self._pair(name, probe, left, right, math.inf, limit, witness=witness)

    def _converted(self, view: View, probe: Probe) -> Answer:
        """Call a view of another precision with the same numbers."""
        return view.call(
            probe.entry,
            fill(view.memory(), flatten(probe.memory)),
            fill(view.inputs(probe.entry, {}), flatten(probe.inputs)),
            fill(view.params(), flatten(probe.params)),
        )

    def _result(self, name: str, limit: float) -> CheckResult:
        return self.pairs.setdefault(name, CheckResult(name, True, limit=limit))

    def _fail(self, result: CheckResult, mismatch: Mismatch) -> None:
        result.passed = False
        if result.mismatch is None:
            result.mismatch = mismatch

    def _untouched(self, probe: Probe, native: Answer) -> None:
        """A refused call leaves the memory as it was, bit for bit, and the outputs too."""
        result = self._result("a refused call changes nothing", 0.0)
        result.calls += 1
        if native.status >= 0:
            return
        for what, before, after in (
            ("memory", flatten(probe.memory), flatten(native.memory)),
            ("outputs", flatten(self.views.native.outputs(probe.entry)), flatten(native.outputs)),
        ):
            for name, value in before.items():
                if value.tobytes() != after[name].tobytes():
                    self._fail(
                        result,
                        Mismatch(
                            probe.trace, probe.step, probe.entry, f"{what} {name}", "before", str(value), "after",
                            str(after[name]), math.inf,
                        ),
                    )  # fmt: skip

    def _verdicts(self, probe: Probe, native: Answer, right: Answer) -> None:
        """What a caller gave is refused by the C where the program refuses it, to the last bit: no margin excuses it.

        Only where an entry inside judges what was computed may a change as large as rounding tip the verdict.
        """
        result = self._result("verdicts on inputs and parameters", 0.0)
        ours, theirs = self._all_statuses(probe.entry, native), self._all_statuses(probe.entry, right)
        pairs = [(a, b) for a, b in zip(ours, theirs, strict=True) if a[1] in VERDICTS or b[1] in VERDICTS]
        result.calls += bool(pairs)
        if any(a != b for a, b in pairs) and not self._either_status(probe, {ours, theirs}, None):
            signal, first, second = next((a[0], a[1], b[1]) for a, b in pairs if a != b)
            self._fail(result, self._status_mismatch(probe, signal, ("native", first), ("interpret", second)))

    def _status_mismatch(self, probe: Probe, signal: str, left: tuple[str, int], right: tuple[str, int]) -> Mismatch:
        """Return two statuses that differ, by their names."""
        return Mismatch(
            probe.trace, probe.step, probe.entry, signal, left[0], Status(left[1]).name, right[0], Status(right[1]).name,
            abs(left[1] - right[1]),
        )  # fmt: skip

    def _all_statuses(self, entry: str, answer: Answer) -> tuple[tuple[str, int], ...]:
        """Return the status of a call and those its outputs report."""
        outputs = flatten(answer.outputs)
        told = [(name, int(outputs[name][0])) for name in self.status_fields[entry]]
        return (("status", int(answer.status)), *told)

    def _statuses(
        self, name: str, probe: Probe, left: Answer, right: Answer, margin: float, witness: View | None = None
    ) -> bool:
        """Compare statuses; return whether the numbers may be compared too."""
        result = self._result(name, 0.0)
        result.calls += 1
        ours, theirs = self._all_statuses(probe.entry, left), self._all_statuses(probe.entry, right)
        if ours == theirs:
            return left.status >= 0
        if result.mismatch is None and (
            margin < SWITCH_MARGIN[self.precision] or self._either_status(probe, {ours, theirs}, witness)
        ):
            result.at_switches += 1
            return False
        views = name.replace("statuses ", "").split(" = ")
        signal, first, second = next((a[0], a[1], b[1]) for a, b in zip(ours, theirs, strict=True) if a != b)
        self._fail(result, self._status_mismatch(probe, signal, (views[0], first), (views[-1], second)))
        return False

    def _pair(
        self,
        name: str,
        probe: Probe,
        left: Answer,
        right: Answer,
        margin: float,
        limit: float,
        *,
        statuses: bool = True,
        witness: View | None = None,
    ) -> None:
        result = self._result(name, limit)
        if statuses:
            if not self._statuses(name, probe, left, right, margin, witness):
                return
        else:
            if left.status < 0 or self._all_statuses(probe.entry, left) != self._all_statuses(probe.entry, right):
                return  # statuses are compared within one precision
            result.calls += 1
        after = flatten(right.memory)
        scales = self._scales(probe, after)
        for where, first, second in (
            ("memory", flatten(left.memory), after),
            ("outputs", flatten(left.outputs), flatten(right.outputs)),
        ):
            for field_name, value in second.items():
                of_sigma = statuses or (where == "memory" and field_name in scales)
                allowed = limit if of_sigma else min(limit, RELATIVE_FLOAT_BOUND)
                self._field(result, probe, name, where, field_name, first[field_name], value, scales, allowed)

    def _scales(self, probe: Probe, after: Mapping[str, Any]) -> dict[str, Any]:
        """Return sigma of each field where it is known: the larger of before and after the call."""
        if self.scales is None:
            return {}
        answer = dict(self.scales(after))
        if probe.entry != "init":
            before = self.scales(flatten(probe.memory))
            answer = {name: np.maximum(value, before[name]) for name, value in answer.items()}
        return answer

    def _field(
        self,
        result: CheckResult,
        probe: Probe,
        check: str,
        where: str,
        name: str,
        first: Any,
        second: Any,
        scales: Mapping[str, Any],
        limit: float,
    ) -> None:
        if second.dtype.kind in "biu":
            difference = np.where(first == second, 0.0, np.inf)
        else:
            a, b = first.astype(float), second.astype(float)
            with np.errstate(all="ignore"):
                gap = np.abs(a - b)
                if name in self.angles:
                    gap = np.abs(gap - 2 * np.pi * np.round(gap / (2 * np.pi)))
                difference = gap / self._size(probe, where, name, b, scales)
            same = (a == b) | (np.isnan(a) & np.isnan(b))
            difference = np.where(same, 0.0, np.where(np.isnan(difference), np.inf, difference))
        worst = int(np.argmax(difference))
        result.worst = max(result.worst, float(difference[worst]))
        excuse = None
        if difference[worst] > limit and result.mismatch is None:
            excuse = self._excuse(probe, where, name, float(difference[worst]), scales)
        if excuse is not None:
            self.excused.setdefault(result.name, []).append(excuse)
        elif difference[worst] > limit:
            left, right = check.split(" = ")
            element = f"[{worst}]" if len(difference) > 1 else ""
            self._fail(
                result,
                Mismatch(
                    probe.trace, probe.step, probe.entry, f"{where} {name}{element}", left, repr(first[worst].item()), right,
                    repr(second[worst].item()), float(difference[worst]),
                ),
            )  # fmt: skip

    def _nearby(self, probe: Probe, view: View, growth: float = 1.0, *, inputs_too: bool = True) -> Iterator[Answer]:
        """Yield answers from memories (and inputs) that differ in the last places of the checked precision."""
        rng = np.random.default_rng(probe.step)
        unit = growth * float(np.finfo(self.views.native.precision.dtype).eps)

        def moved(record: Record, choices: tuple[float, float]) -> dict[str, Any]:
            return {
                name: value.astype(float) * (1 + unit * rng.choice(choices, size=value.shape))
                for name, value in flatten(record).items()
                if value.dtype.kind == "f"
            }

        params = fill(view.params(), flatten(probe.params))
        given = fill(view.memory(), flatten(probe.memory))
        inputs = fill(view.inputs(probe.entry, {}), flatten(probe.inputs))
        for _ in range(6):
            # towards zero where the other way leaves a range: a refusal would say nothing of rounding
            for choices in ((-1.0, 1.0), (-1.0, 0.0)):
                memory = fill(given.copy(), moved(probe.memory, choices))
                shifted = fill(inputs.copy(), moved(probe.inputs, choices)) if inputs_too else inputs
                answer = view.call(probe.entry, memory, shifted, params)
                told = self._all_statuses(probe.entry, answer)
                if answer.status >= 0 and all(status not in VERDICTS for _, status in told):
                    break
            yield answer

    def _either_status(self, probe: Probe, statuses: set[Any], witness: View | None) -> bool:
        """Whether a change as large as rounding may grow turns one of two statuses into the other, in any view."""
        views = [item for item in (witness, self.views.reference, self.views.interpret) if item is not None]
        for view in views:
            # the inputs stay: whether they are in range is compared exactly
            near = self._nearby(probe, view, ROUNDING_GROWTH, inputs_too=False)
            met = {self._all_statuses(probe.entry, answer) for answer in near}
            if statuses <= met | {self._all_statuses(probe.entry, self._converted(view, probe))}:
                return True
        return False

    def _excuse(
        self, probe: Probe, where: str, name: str, difference: float, scales: Mapping[str, Any]
    ) -> Excuse | None:
        """Return an excuse if a difference is no larger than rounding of the memory itself causes, times a factor."""
        if probe.trace == ON_KINKS:
            return None
        explained = self._explained(probe, where, name, scales)
        largest = LARGEST_GROWTH * explained
        if math.isinf(explained):  # that a call is nearly refused bounds nothing, and no plausible call may be
            largest = LARGEST_AT_SWITCH[self.between_machines] if probe.trace in IMPLAUSIBLE else 0.0
        return Excuse(difference, explained, probe, f"{where} {name}") if difference <= largest else None

    def _explained(self, probe: Probe, where: str, name: str, scales: Mapping[str, Any]) -> float:
        """Return what one unit in the last place of memory and inputs causes; infinite where it has the call refused."""
        views = [view for view in (self.views.reference, self.views.interpret) if view is not None]
        found = [(view, answer) for view in views if (answer := self._converted(view, probe)).status >= 0]
        if self.between_machines and probe.answer is not None:
            ours = self._all_statuses(probe.entry, probe.answer)
            if any(ours != self._all_statuses(probe.entry, self._converted(view, probe)) for view in views):
                return math.inf  # in double it is refused, or a sensor is: that it was accepted is rounding's doing
        if not found:
            return 0.0
        view, base = found[0]
        same = self._all_statuses(probe.entry, base)
        near = [item for item in self._nearby(probe, view) if self._all_statuses(probe.entry, item) == same]
        if not near:
            return math.inf  # whichever way, a rounding away it has another status: this is a switch
        # a call is ill-conditioned as a whole: one gain moves the estimate and its covariance
        fields = {(where, name)} | {
            ("memory", key) for key, value in flatten(base.memory).items() if value.dtype.kind == "f"
        }
        largest = 0.0
        for place, field_name in sorted(fields):
            center = flatten(base.memory if place == "memory" else base.outputs)[field_name].astype(float)
            size = self._size(probe, place, field_name, center, scales)
            for answer in near:
                value = flatten(answer.memory if place == "memory" else answer.outputs)[field_name].astype(float)
                with np.errstate(all="ignore"):
                    gap = np.abs(value - center)
                    if field_name in self.angles:
                        gap = np.abs(gap - 2 * np.pi * np.round(gap / (2 * np.pi)))
                    gap = gap / size
                largest = max(largest, float(np.max(np.where(np.isfinite(gap), gap, 0.0))))
        return largest

    def _size(self, probe: Probe, where: str, name: str, value: Any, scales: Mapping[str, Any]) -> Any:
        """Return what a difference is relative to: sigma, else the largest magnitude so far on the trace."""
        if where == "memory" and name in scales:
            return np.maximum(scales[name], 1e-300)
        key = (probe.trace, probe.entry, name)
        finite = np.where(np.isfinite(value), np.abs(value), 0.0)
        self.largest[key] = max(self.largest.get(key, 1e-300), float(np.max(finite, initial=0.0)))
        return max(self.largest[key], float(np.finfo(np.float32).tiny) if self.single else 1e-300)

    def _say_excuses(self, result: CheckResult, excuses: list[Excuse]) -> None:
        """Count the calls whose differences were excused, show the largest, and fail where they are too many."""
        if not excuses or result.note:
            return
        calls = {(item.probe.trace, item.probe.step) for item in excuses}
        result.ill_conditioned = len(calls)
        largest = max(excuses, key=lambda item: item.difference)
        result.note = f"{len(calls)} ill-conditioned of {result.calls} calls; the largest differs by {largest}"
        if len(calls) > LARGEST_SHARE_ILL_CONDITIONED * result.calls:
            result.passed = False
            result.note += f"; that is more than {100 * LARGEST_SHARE_ILL_CONDITIONED:.0f} % of the calls"

    def results(self) -> list[CheckResult]:
        """Return all results; too many calls at switches is a failure too."""
        for result in self.pairs.values():
            if result.calls and result.at_switches > LARGEST_SHARE_AT_SWITCHES * result.calls:
                result.passed = False
                result.note = (
                    f"{result.at_switches} of {result.calls} calls differ in status near a switch, more than 5 %"
                )
            self._say_excuses(result, self.excused.get(result.name, []))
        names = list(self.pairs.values())
        if self.views.reference is None:
            names.append(
                CheckResult("independent reference", True, not_judged="the block brings no independent reference")
            )
        return names


def _leaves(signals: tuple[Signal, ...], prefix: str = "") -> Iterator[tuple[str, Signal]]:
    for signal in signals:
        if signal.kind is Kind.GROUP:
            yield from _leaves(signal.members, f"{prefix}{signal.name}.")
        else:
            yield prefix + signal.name, signal


def _derivative_results(block: Block, probes: list[Probe]) -> list[CheckResult]:
    """Compare the block's Jacobians with complex step and central differences of f and h, along the nominal trace."""
    results = []
    for check in block.derivative_checks:
        entry = "predict" if check.name == "F" else f"update_{check.name.removeprefix('H_')}"
        chosen = [item for item in probes if item.trace in ("nominal", "randomised") and item.entry == entry][:25]
        exact = CheckResult(f"{check.name} = complex step", True, limit=DERIVATIVE_BOUND)
        rough = CheckResult(f"{check.name} = central differences", True, limit=DIFFERENCE_BOUND)
        if check.kinks:
            exact.note = rough.note = f"kinks declared: {', '.join(check.kinks)}"
        for probe in chosen:
            values = {**flatten(probe.params), **flatten(probe.inputs), **flatten(probe.memory)}
            values = {name: np.asarray(value, dtype=float) for name, value in values.items()}
            ours = check.ours(values)
            for result, witness in ((exact, check.complex_step), (rough, check.differences)):
                expected = witness(values)
                size = 1.0 + np.abs(expected)
                gap = np.abs(ours - expected) / size
                result.calls += 1
                worst = np.unravel_index(int(np.argmax(gap)), gap.shape)
                result.worst = max(result.worst, float(gap[worst]))
                if not gap[worst] <= result.limit:
                    result.passed = False
                    result.mismatch = result.mismatch or Mismatch(
                        probe.trace, probe.step, entry, f"{check.name}[{worst[0]}, {worst[1]}]", "CasADi",
                        repr(float(ours[worst])), result.name.split(" = ")[1], repr(float(expected[worst])),
                        float(gap[worst]),
                    )  # fmt: skip
        results += [exact, rough]
    return results
