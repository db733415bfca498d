"""The law of every regulator, u = u* + gamma(w) - K (x - x* - pi(w)): one mechanism, whatever pi and gamma are."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from .block import Block
from .components import Calls, matrix_of
from .controllers import deviation_from, gain_range
from .design import Gain
from .errors import ModelError, yes_or_no
from .exosystems import Exosystem
from .plant import Plant, Symbol
from .signal_generators import signal_groups
from .signals import Signal

Array = NDArray[Any]
Places = tuple[tuple[int, int], ...]

LETTERS = {"state_map": "Pi", "input_map": "Gamma"}
"""Fields that hold the elements of the linear maps, and what the field calls these."""


@dataclass(frozen=True, eq=False)
class Aim:
    """Where a law has the plant go, as expressions.

    Attributes
    ----------
    states, inputs : dict
        x* and u*: name -> expression.
    moved : casadi.SX, shape (error_size, 1)
        pi(w): by how much the state has to be elsewhere.
    driven : casadi.SX, shape (acting inputs, 1)
        gamma(w): what keeps it there, beside u*.
    """

    states: Mapping[str, Any]
    inputs: Mapping[str, Any]
    moved: ca.SX
    driven: ca.SX


@dataclass(frozen=True, eq=False)
class FeedbackLaw:
    """What all laws for a plant have in common.

    Attributes
    ----------
    plant : Plant
        What is controlled; its states are read.
    acting : tuple of Signal
        Its inputs that act: the commands.
    saturate : bool
        Whether commands are held within their ranges (status CLAMPED); else such a call is refused.
    """

    plant: Plant
    acting: tuple[Signal, ...]
    saturate: bool

    def __post_init__(self) -> None:
        yes_or_no(self.saturate, f"{self.plant.name}: saturate=")

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns of K."""
        return sum(item.size for item in self.acting), self.plant.error_size

    @property
    def kinds(self) -> tuple[tuple[str, str], ...]:
        """Name and kind of each state, for the oracle."""
        return tuple(
            (state.signal.name, "attitude" if state.attitude else "angle" if state.signal.angle else "plain")
            for state in self.plant.states
        )

    @property
    def ends(self) -> tuple[tuple[str, int, Array, Array], ...]:
        """Name, size and range of each command, for the oracle."""
        return tuple((item.name, item.size, np.array(item.low), np.array(item.high)) for item in self.acting)

    def checked(self, owner: str, gain: Gain | Any) -> Array:
        """Return K as numbers, of 9 digits where it was designed; refuse another shape."""
        K = gain.rounded() if isinstance(gain, Gain) else matrix_of(owner, "gain", gain)
        rows, columns = self.shape
        if K.shape != (rows, columns):
            raise ModelError(
                f"{owner}: the gain has shape {K.shape}; give {rows} x {columns}, a row for each input that acts "
                f"({', '.join(item.name for item in self.acting)})"
            )
        return K

    def read_states(self, block: Block) -> dict[str, Symbol]:
        """Declare the states of the plant as inputs of a block."""
        answer = {}
        for signal in (state.signal for state in self.plant.states):
            ends = (signal.low, signal.high)
            answer[signal.name] = block.input(
                signal.name, size=signal.size, unit=signal.unit, range=ends, doc=signal.doc
            )
        return answer

    def declare_gain(self, block: Block, K: Array) -> ca.SX:
        """Declare K as the run-time parameter `gain`, by rows."""
        rows = ", ".join(item.name for item in self.acting)
        doc = f"K by rows ({rows}), columns in the order of the states"
        return ca.SX(block.parameter("gain", K.ravel(), range=gain_range(K), doc=doc))

    def step(
        self, block: Block, reads: Sequence[Symbol], taken: Mapping[str, Symbol], K: ca.SX, aim: Aim, doc: str
    ) -> None:
        """Give a block the entry `step`.

        Parameters
        ----------
        block : Block
            Whose inputs and parameters (or memory) are declared.
        reads : sequence of Symbol
            Its inputs, in their order.
        taken : dict
            Those of them that are states of the plant.
        K : casadi.SX
            The gain.
        aim : Aim
            Where the plant has to be.
        doc : str
            Meaning of the entry.
        """
        change = aim.driven - K @ deviation_from(self.plant, taken, aim.states, aim.moved)
        outputs, start = {}, 0
        for signal in self.acting:
            outputs[signal.name] = ca.SX(aim.inputs[signal.name]) + change[start : start + signal.size]
            start += signal.size
        block.entry(
            "step",
            inputs=reads,
            outputs=outputs,
            output_units={item.name: item.unit for item in self.acting},
            output_ranges={item.name: (item.low, item.high) for item in self.acting},
            output_docs={
                item.name: f"{item.doc or 'command'}; keeps its last value when a call is refused"
                for item in self.acting
            },
            limits={item.name: (item.low, item.high) for item in self.acting} if self.saturate else {},
            doc=doc,
        )

    def near(self, x: Array, hold: Array, K: Array, Pi: Array, Gamma: Array, generated: Sequence[Symbol]) -> Calls:
        """Return calls about x* + Pi w, so near that commands u* + Gamma w + .. stay within their ranges."""
        plant = self.plant
        low, high = (np.concatenate([getattr(item, end) for item in self.acting]) for end in ("low", "high"))
        reach = np.abs(K).sum(axis=1) + np.abs(Gamma).sum(axis=1)
        room = np.maximum(np.minimum(high - hold, hold - low), 0.0)
        factor = min(1.0, 0.2 * float(np.min(room / np.maximum(reach, 1e-300), initial=math.inf)))
        retract = ca.Function(
            "retract", [plant.x, error := ca.SX.sym("error", plant.error_size)], [plant.retract(plant.x, error)]
        )

        def calls(rng: Any, steps: int) -> Iterator[tuple[str, dict[str, Any]]]:
            yield "init", {}
            for _ in range(steps):
                w = factor * np.clip(rng.normal(size=Pi.shape[1]), -3, 3)
                away = factor * np.clip(rng.normal(size=len(Pi)), -3, 3)
                at = np.asarray(retract(x, Pi @ w + away), dtype=float).ravel()
                inputs: dict[str, Any] = {}
                for state in plant.states:
                    inputs[state.signal.name] = np.clip(at[state.at], state.signal.low, state.signal.high)
                start = 0
                for symbol in generated:
                    inputs[symbol.signal.name] = w[start : start + symbol.signal.size]
                    start += symbol.signal.size
                yield "step", inputs

        return calls


# -- linear maps, by their elements that are not zero -----------------------------------------------------------------


def columns_of(exosystem: Exosystem) -> list[int]:
    """Return the states of an exosystem in the order in which w comes, signal by signal."""
    return [k for _, columns in signal_groups(exosystem) for k in columns]


def read_generators(block: Block, exosystem: Exosystem) -> list[Symbol]:
    """Declare w as inputs of a block, ``w_<signal>`` for each signal."""
    return [
        block.input(f"w_{signal}", size=len(columns), doc=f"state of the generator of {signal}")
        for signal, columns in signal_groups(exosystem)
    ]


def linear_aim(
    law: FeedbackLaw, states: Mapping[str, Any], inputs: Mapping[str, Any], generated: Sequence[Symbol],
    elements: Mapping[str, Any], places: Mapping[str, Places],
) -> Aim:  # fmt: skip
    """Return the aim of pi(w) = Pi w and gamma(w) = Gamma w, of which there are the elements at some places."""
    w, (inputs_size, n) = ca.vertcat(ca.SX(0, 1), *generated), law.shape
    maps = {}
    for what, rows in (("state_map", n), ("input_map", inputs_size)):
        maps[what] = ca.SX(rows, w.numel())
        for k, (i, j) in enumerate(places[what]):
            maps[what][i, j] = ca.SX(elements[what])[k]
    return Aim(states, inputs, maps["state_map"] @ w, maps["input_map"] @ w)


def elements_of(matrix: Any, places: Places) -> Array:
    """Return the elements of a matrix at some places."""
    return np.array([matrix[i, j] for i, j in places])


def told_places(what: str, places: Places) -> str:
    """Return what a field of elements is, in words."""
    listed = " ".join(f"({i} {j})" for i, j in places)
    return f"{LETTERS[what]}, its elements {listed}; the rest is zero"
