"""The Kalman filter of several signals of one kind that are read together: one covariance serves them all.

With S = I (x) S_1, D = I (x) D_1, Q = I (x) q and the readings' noise M I, a covariance that starts as I (x) P_1 stays
I (x) P_1 for ever, as long as every reading is taken or none: Riccati's recursion is that of one signal.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from ..reference.shared_covariance import SharedCovarianceOracle
from .block import Block, Scenario
from .derivation import plant_equations
from .errors import ModelError
from .estimators import LARGEST_NIS, kalman_filter, step_entry
from .exosystems import Exosystem
from .forms import Conventional, Rows
from .kernels import SMALLEST_VARIANCE
from .plant import Plant
from .program import (
    AllOf,
    AnyOf,
    Assign,
    Compare,
    CountUp,
    Element,
    Entry,
    Evaluate,
    HoldVariances,
    Packing,
    Place,
    Raise,
    Refuse,
    Restore,
    Statement,
    When,
    Within,
    walk,
)
from .signals import Signal, Status

Array = NDArray[Any]
READINGS = "readings"
"""Name of the one sensor: a vector, an element for each signal."""


def build(
    plant: Plant, exosystem: Exosystem, initial_variance: float, name: str, doc: str, options: Mapping[str, Any]
) -> Block:
    """Return the block; see `kalman_exosystem` with ``together=True``.

    Parameters
    ----------
    plant : Plant
        The whole exosystem, with the one sensor ``readings``.
    exosystem : Exosystem
        A composition of parts with one signal each.
    initial_variance : float
        Of every state.
    name, doc : str
        Of the block.
    options : dict
        As for `kalman_filter`; the gate is a number, on the NIS of all readings together.
    """
    parts = exosystem.parts or (exosystem,)
    for part in parts:
        same = np.array_equal(part.matrix, parts[0].matrix) and np.array_equal(part.output, parts[0].output)
        if len(part.signals) != 1 or not same:
            raise ModelError(
                f"{name}: signals that share a covariance are of one kind, and {', '.join(part.signals)} is not as "
                f"{', '.join(parts[0].signals)}; leave out together=True"
            )
    unknown = sorted(set(options) - {"gate", "reject_limit", "inflation", "variance_floor", "variance_ceiling"})
    numbers = [what for what in options if not isinstance(options[what], int | float)]
    if unknown or numbers:
        raise ModelError(
            f"{name}: with together=True the options are gate, reject_limit, inflation, variance_floor and "
            f"variance_ceiling, one number each; leave out or mend {', '.join(unknown or numbers)}"
        )
    given = dict(options)
    if "gate" in given:
        given["gate"] = {READINGS: given["gate"]}
    variances = {state.signal.name: float(initial_variance) for state in plant.states}
    whole = kalman_filter(plant, initial_variance=variances, name=name, doc=doc, **given)
    return _Shared(plant, parts[0].matrix, parts[0].output, whole).block()


@dataclass(frozen=True)
class _Shared:
    """The derivation: S and Q of one signal, and the filter of all of them, whose names and ranges are taken over."""

    plant: Plant
    S: Array
    output: Array
    whole: Block

    @property
    def order(self) -> int:
        return len(self.S)

    @property
    def states(self) -> list[Signal]:
        return [state.signal for state in self.plant.states]

    @property
    def form(self) -> Conventional:
        """Return how the one covariance is kept."""
        (hold, *_) = [item for item in walk(self.whole.entries["init"].body) if isinstance(item, HoldVariances)]
        return Conventional(Packing(self.order), hold.floor[: self.order], hold.ceiling[: self.order])

    @property
    def shared(self) -> dict[str, str]:
        """Return parameters of one signal: name in the filter of all, of its first signal -> name here."""
        first = self.states[0].name
        return {f"variance_step_{first}": "variance_step", f"variance_{first}_0": "variance_0"}

    def block(self) -> Block:
        """Assemble it."""
        whole = self.whole
        block = Block(whole.name, doc=whole.doc)
        block.memory_signals = [*self.states, self.form.signal(), whole.memory_signals[-1]]
        block.param_signals = self._parameters()
        predict, update = self._predict(block), self._update(block)
        entries = [self._init(), predict, update, step_entry(predict, [(READINGS, update)]), self._inflate()]
        block.entries = {entry.name: entry for entry in entries}
        block.equations = plant_equations(self.plant)
        count = len(self.states)
        block.notes = [
            *[note for note in whole.notes if note.startswith(("dt", "Constants"))],
            self.form.note,
            f"The {count} signals are of one kind and read together, so that P is {count} times the same block: it is "
            "kept and computed once.",
            "The states start at zero: the readings find them.",
        ]
        block.source_hash = whole.source_hash + " shared covariance"
        block.float_bound, block.sample_time, block.source = whole.float_bound, whole.sample_time, whole.source
        block.check()
        assert whole.oracle is not None
        sizes = tuple((signal.name, signal.size) for signal in self.states)
        block.oracle = SharedCovarianceOracle(whole.oracle, sizes, READINGS)
        block.scenario = self._scenario()
        return block

    def _parameters(self) -> list[Signal]:
        """Return those of the filter of all signals, what each signal has alike once."""
        answer = []
        for signal in self.whole.param_signals:
            if signal.name in self.shared:
                doc = "noise per step of w" if "step" in signal.name else "variance of the error of every w_0"
                answer.append(replace(signal, name=self.shared[signal.name], doc=f"{doc}, of each signal alike"))
            elif signal.name == f"variance_{READINGS}":
                low, high, default = signal.low[:1], signal.high[:1], (signal.default or ())[:1]
                answer.append(replace(signal, size=1, low=low, high=high, default=default, doc="noise of each reading"))
            elif not signal.name.startswith(("variance_", "w_")):
                answer.append(signal)
        return answer

    def _reads(self) -> tuple[list[ca.SX], list[tuple[tuple[Place, int], ...]]]:
        """Return the states as arguments, and where they are read."""
        symbols = [ca.SX.sym(signal.name, signal.size) for signal in self.states]
        return symbols, [((Place("memory", signal.name), signal.size),) for signal in self.states]

    def _following(self) -> list[tuple[tuple[tuple[Place, int], ...], tuple[str, ...]]]:
        """Return where the next states go, and their names in the C."""
        return [
            (((Place("next", s.name), s.size),), tuple(f"next_{s.name}_{i}" for i in range(s.size)))
            for s in self.states
        ]

    def _judge(self, block: Block) -> list[Statement]:
        judged = block.judge_memory([signal.name for signal in self.states])
        return [*self.form.hold(), Refuse(Status.OVERFLOW, judged)]

    def _init(self) -> Entry:
        body: list[Statement] = [Assign(Place("next", signal.name), 0.0, signal.size) for signal in self.states]
        body += self.form.start([Element(Place("param", "variance_0"), i) for i in range(self.order)])
        body += [Assign(Place("next", f"rejected_{READINGS}"), 0.0, 1), *self.form.hold()]
        return replace(self.whole.entries["init"], body=tuple(body))

    def _predict(self, block: Block) -> Entry:
        """w+ = S w for each signal, P+ = S P S' + D once."""
        w, places = self._reads()
        noise = ca.SX.sym("variance_step", self.order)
        pattern = tuple((int(i), int(j)) for i, j in np.argwhere(self.S != 0))
        square = tuple((i, i) for i in range(self.order))
        S = ca.SX(ca.sparsify(ca.DM(self.S)))
        f, q = Place("local", "f"), Place("local", "q")
        f_names, q_names = (tuple(f"{word}_{i}_{j}" for i, j in at) for word, at in (("f", pattern), ("q", square)))
        values = ca.DM([self.S[i, j] for i, j in pattern])
        function = ca.Function(
            f"{block.name}_predict", [*w, noise], [*[ca.densify(S @ own) for own in w], ca.SX(values), noise]
        )
        following = self._following()
        move = Evaluate(
            function,
            (*places, ((Place("param", "variance_step"), self.order),)),
            (*[at for at, _ in following], ((f, len(pattern)),), ((q, self.order),)),
            (*[names for _, names in following], f_names, q_names),
            ("w = S w, for each signal",),
        )
        moved = self.form.propagate(f, pattern, q, square, f_names, q_names)
        return replace(self.whole.entries["predict"], body=(move, *moved, *self._judge(block)))

    def _update(self, block: Block) -> Entry:
        """One gain for all signals, one transaction: K = P q' / s, w_i = w_i + K e_i, P = P - K s K'."""
        count, q = len(self.states), self.order
        residual, gain, total = Place("local", "residual"), Place("local", "delta"), Place("local", "total")
        columns = np.flatnonzero(self.output[0])
        h_pattern = tuple((0, int(j)) for j in columns)
        h_names = tuple(f"h_0_{j}" for j in columns)
        single = len(columns) == 1 and float(self.output[0, columns[0]]) == 1.0
        # the kernel is told of an innovation of 1: its correction is the gain, its NIS 1 / s
        rows = Rows(1, Place("local", "unit"), Place("local", "h"), h_pattern, Place("local", "r"), (single,),
                    h_names, ("r_0",), ("unit",))  # fmt: skip
        (kernel,) = self.form.update(rows)
        kernel = replace(kernel, comment=("gain K = P h' / s, of each signal alike; P = P - K s K'",))  # type: ignore[type-var]
        s = Element(Place("local", "row_variance"))
        gate, nis = Element(Place("in", "gate")), Element(Place("local", "total"))
        accepted = AnyOf((Compare(gate, "<=", 0.0), Compare(nis, "<=", gate)))
        body: list[Statement] = [
            self._measure(block, rows),
            self.form.innovation_variance(rows, ((0, 0),), ("r_0",)),
            Assign(Place("out", "innovation"), residual, count),
            kernel,
            Refuse(
                Status.NOT_POSITIVE,
                AllOf((Compare(s, ">=", SMALLEST_VARIANCE, Element(Place("out", "variance"))),)),
            ),
            self._total(block, residual, total),
            Refuse(Status.OVERFLOW, Within(total, (0.0,), (LARGEST_NIS,))),
            Assign(Place("out", "nis"), total, 1),
            When(
                accepted,
                (
                    self._correct(block, residual, gain),
                    Assign(Place("next", f"rejected_{READINGS}"), 0.0, 1),
                    *self._judge(block),
                ),
                (Restore(), CountUp(Place("next", f"rejected_{READINGS}")), Raise(Status.GATED)),
                "accepted?",
            ),
        ]
        own = self.whole.entries[f"update_{READINGS}"]
        innovation, variance, nis_signal = own.outputs
        variance = replace(
            variance, size=1, low=variance.low[:1], high=variance.high[:1], doc="of the innovation, of each reading"
        )
        assert q == self.states[0].size
        return replace(own, outputs=(innovation, variance, nis_signal), body=tuple(body))

    def _measure(self, block: Block, rows: Rows) -> Evaluate:
        """Return the residuals of all readings, and what the kernel takes."""
        w, places = self._reads()
        count = len(self.states)
        z, r = ca.SX.sym(READINGS, count), ca.SX.sym("r")
        expected = ca.vertcat(*[ca.SX(ca.sparsify(ca.DM(self.output))) @ own for own in w])
        h = ca.DM([self.output[at] for at in rows.h_pattern])
        one = ca.SX(ca.DM(1.0))
        function = ca.Function(f"{block.name}_measure", [*w, z, r], [ca.densify(z - expected), one, ca.SX(h), r])
        return Evaluate(
            function,
            (*places, ((Place("in", READINGS), count),), ((Place("param", f"variance_{READINGS}"), 1),)),
            (
                ((Place("local", "residual"), count),), ((rows.residual, 1),), ((rows.h, len(rows.h_pattern)),),
                ((rows.r, 1),),
            ),
            (tuple(f"residual_{i}" for i in range(count)), ("unit",), rows.h_names, rows.r_names),
            ("residual = reading - Q w, for each signal",),
        )  # fmt: skip

    def _total(self, block: Block, residual: Place, total: Place) -> Evaluate:
        """Return the NIS of all readings."""
        count = len(self.states)
        e, per_s = ca.SX.sym("e", count), ca.SX.sym("per_s")
        squares = sum(((e[i] * (e[i] * per_s)) for i in range(1, count)), e[0] * (e[0] * per_s))
        return Evaluate(
            ca.Function(f"{block.name}_nis", [e, per_s], [squares]),
            (((residual, count),), ((Place("local", "nis"), 1),)),
            (((total, 1),),),
            (("total",),),
            ("NIS of all readings",),
        )

    def _correct(self, block: Block, residual: Place, gain: Place) -> Evaluate:
        """w_i = w_i + K e_i."""
        w, places = self._reads()
        count = len(self.states)
        e, K = ca.SX.sym("e", count), ca.SX.sym("gain", self.order)
        following = self._following()
        return Evaluate(
            ca.Function(f"{block.name}_correct", [*w, K, e], [own + K * e[i] for i, own in enumerate(w)]),
            (*places, ((gain, self.order),), ((residual, count),)),
            tuple(at for at, _ in following),
            tuple(names for _, names in following),
            ("w = w + K e, for each signal",),
        )

    def _inflate(self) -> Entry:
        body = (self.form.inflate(Place("in", "factor")), *self.form.hold())
        return replace(self.whole.entries["inflate"], body=body)

    def _scenario(self) -> Scenario:
        """Return that of the filter of all signals, with a covariance that is the same for each."""
        own = self.whole.scenario
        assert own is not None
        form, size = self.form, self.form.packing.count

        def calls(rng: Any, steps: int) -> Iterator[tuple[str, dict[str, Any]]]:
            return own.calls(rng, steps)

        def memory(rng: Any) -> dict[str, Any]:
            found = own.memory(rng)
            return {**found, "covariance": np.asarray(found["covariance"])[:size]}

        def scales(fields: Mapping[str, Any]) -> dict[str, Any]:
            sigma = np.sqrt(np.maximum(np.diag(form.covariance(fields)), 1e-300))
            return {**{signal.name: sigma for signal in self.states}, form.field: form.sizes(fields, sigma)}

        return Scenario(calls, memory, scales, "", form.scaled)
