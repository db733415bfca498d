"""The forms in which a filter keeps its covariance: what its entries do with it, and how it is compared."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..reference import estimators as textbook
from .block import Block
from .errors import ModelError
from .factors import (
    FactoredCongruence,
    FactoredInnovationVariance,
    FactoredRowUpdate,
    ScaleFactors,
    covariance_of,
)
from .kernels import AllStatesUpdate, Congruence, InnovationVariance, JosephRowUpdate, Pattern, RowUpdate, Scale
from .program import (
    AllOf,
    Array,
    Assign,
    AssignElement,
    Compare,
    Element,
    HoldFactors,
    HoldVariances,
    Kernel,
    Packing,
    Place,
    Refuse,
    Statement,
    Within,
    walk,
)
from .signals import Signal, Status


@dataclass(frozen=True)
class Rows:
    """The rows of a reading, decorrelated: where they lie, and what they are called in the C."""

    count: int
    residual: Place
    h: Place
    h_pattern: Pattern
    r: Place
    single: tuple[bool, ...]
    h_names: tuple[str, ...]
    r_names: tuple[str, ...]
    residual_names: tuple[str, ...]

    def columns(self) -> list[list[int]]:
        """Return the states that each row reads."""
        return [[j for i, j in self.h_pattern if i == row] for row in range(self.count)]


class Conventional:
    """P itself, packed (upper triangle by rows); one scalar update for each row."""

    name = "conventional"
    field = "covariance"
    note = "Covariance packed (upper triangle by rows); one scalar update for each sensor row."
    row_kernel: type[Kernel] = RowUpdate

    def __init__(self, packing: Packing, floor: tuple[float, ...], ceiling: tuple[float, ...]):
        self.packing, self.size, self.floor, self.ceiling = packing, packing.size, floor, ceiling
        self.stored = packing if packing.blocks else None  # kernels are told only of what is no whole triangle
        self.before, self.after = Place("memory", self.field), Place("next", self.field)

    def signal(self) -> Signal:
        """Return the field of the memory."""
        lows, highs = [], []
        for i, j in self.packing.pairs:
            top = math.sqrt(self.ceiling[i] * self.ceiling[j])
            lows.append(self.floor[i] if i == j else -top)
            highs.append(self.ceiling[i] if i == j else top)
        doc = f"covariance of the error, {self.order()}"
        return Signal(self.field, self.packing.count, "", tuple(lows), tuple(highs), doc)

    def order(self) -> str:
        """Return in words in which order elements are stored."""
        if not self.packing.blocks:
            return "upper triangle by rows"
        told = " ".join(f"({' '.join(map(str, block))})" for block in self.packing.blocks)
        return f"upper triangles by rows of its blocks {told}; the rest is zero by structure"

    def start(self, variances: list[Element]) -> list[Statement]:
        """Return the statements of `init`: these variances, nothing beside the diagonal."""
        body: list[Statement] = [Assign(self.after, 0.0, self.packing.count)]
        for k, variance in enumerate(variances):
            body.append(AssignElement(Element(self.after, self.packing.at(k, k)), variance))
        return body

    def propagate(
        self,
        f: Place,
        f_pattern: Pattern,
        q: Place,
        q_pattern: Pattern,
        f_names: tuple[str, ...],
        q_names: tuple[str, ...],
    ) -> list[Statement]:
        """P = F P F' + Q."""
        return [
            Congruence(
                self.size, f, f_pattern, self.before, q, q_pattern, self.after, f_names, q_names, packing=self.stored
            )
        ]

    def innovation_variance(self, rows: Rows, r_pattern: Pattern, r_names: tuple[str, ...]) -> Kernel:
        """Diagonal of H P H' + R at the prior."""
        return InnovationVariance(
            self.size, rows.count, rows.h, rows.h_pattern, rows.r, r_pattern, self.before, Place("out", "variance"),
            rows.h_names, r_names, packing=self.stored,
        )  # fmt: skip

    def takes_all_states(self, rows: Rows) -> bool:
        """Whether the rows are taken by a kernel that serves them all, from the reported innovation."""
        return not self.stored and AllStatesUpdate.serves(self.size, rows.columns(), list(rows.single))

    def update(self, rows: Rows) -> list[Statement]:
        """One scalar update after another."""
        updates = [self.row_update(rows, row) for row in range(rows.count)]
        return [AllStatesUpdate(tuple(updates))] if self.takes_all_states(rows) else list(updates)  # type: ignore[arg-type]

    def row_update(self, rows: Rows, row: int) -> Kernel:
        """Return the kernel of one row."""
        text = f"row {row}: " if rows.count > 1 else ""
        tail = "; the measured row as r K" if rows.single[row] else ""
        return RowUpdate(
            self.size, row, rows.residual, rows.count, rows.h, rows.h_pattern, rows.r, rows.count,
            self.before if row == 0 else self.after, self.after, rows.single[row], rows.h_names, rows.r_names,
            rows.residual_names, (f"{text}d = d + K e, P = P - K s K'{tail}",), packing=self.stored,
        )  # fmt: skip

    def reset(self, g: Place, pattern: Pattern, names: tuple[str, ...]) -> Kernel:
        """P = G P G' for a corrected attitude."""
        return Congruence(
            self.size, g, pattern, self.after, None, (), self.after, names,
            comment=("P = G P G', G = I - [d]x / 2 for an attitude",), packing=self.stored,
        )  # fmt: skip

    def inflate(self, factor: Place) -> Kernel:
        """P = factor P."""
        return Scale(self.packing.count, factor, self.before, self.after, ("P = factor P",), self.size, self.stored)

    def hold(self) -> list[Statement]:
        """Keep the variances between floor and ceiling, refuse what cannot be."""
        return [HoldVariances(self.after, self.size, self.floor, self.ceiling, self.stored)]

    def judge_report(self, rows: int) -> list[Statement]:
        """Refuse a variance of the innovation that is no number: of a covariance within its ranges there is none."""
        return []

    def oracle(self, model: textbook.Model) -> Any:
        """Return the independent view."""
        return textbook.KalmanOracle(model)

    def memory(self, given: dict[str, Any]) -> dict[str, Any]:
        """Return a plausible memory that has a covariance as one in this form."""
        return given

    def covariance(self, memory: Mapping[str, Any]) -> Array:
        """Return P (n, n) of a memory."""
        return self.packing.unpack(np.asarray(memory[self.field], dtype=float))

    def scaled(self, memory: Mapping[str, Any], factor: float) -> dict[str, Any]:
        """Return the field of a memory whose covariance is multiplied by a factor."""
        return {self.field: np.asarray(memory[self.field], dtype=float) * factor}

    def sizes(self, memory: Mapping[str, Any], sigma: Array) -> Array:
        """Return the natural size of an error in each element of the field."""
        return self.packing.pack(np.outer(sigma, sigma))


class Joseph(Conventional):
    """P itself; each row by Joseph's form, which is positive semidefinite whatever gain rounding leaves."""

    name = "joseph"
    note = "Covariance packed (upper triangle by rows); one scalar update in Joseph's form for each sensor row."

    def takes_all_states(self, rows: Rows) -> bool:
        """Never."""
        return False

    def row_update(self, rows: Rows, row: int) -> Kernel:
        """Return the kernel of one row."""
        text = f"row {row}: " if rows.count > 1 else ""
        return JosephRowUpdate(
            self.size, row, rows.residual, rows.count, rows.h, rows.h_pattern, rows.r, rows.count,
            self.before if row == 0 else self.after, self.after, False, rows.h_names, rows.r_names, rows.residual_names,
            (f"{text}d = d + K e, P = (I - K H) P (I - K H)' + K r K'",), packing=self.stored,
        )  # fmt: skip


class Factored(Conventional):
    """U and D of P = U D U' (Bierman and Thornton): positive definite by construction, in single precision too."""

    name = "ud"
    field = "factors"
    note = "Covariance as factors U D U' (Bierman and Thornton), packed: D on the diagonal, U beside it."

    def signal(self) -> Signal:
        """Return the field of the memory."""
        lows, highs = [], []
        for i, j in self.packing.pairs:
            top = math.sqrt(self.ceiling[i] / self.floor[j])
            lows.append(self.floor[i] if i == j else -top)
            highs.append(self.ceiling[i] if i == j else top)
        doc = f"factors of the covariance U D U' of the error, {self.order()}: D on the diagonal, U beside it"
        return Signal(self.field, self.packing.count, "", tuple(lows), tuple(highs), doc)

    def propagate(
        self,
        f: Place,
        f_pattern: Pattern,
        q: Place,
        q_pattern: Pattern,
        f_names: tuple[str, ...],
        q_names: tuple[str, ...],
    ) -> list[Statement]:
        """Time update of the factors; negative noise is refused."""
        diagonal = [Element(q, k) for k, (i, j) in enumerate(q_pattern) if i == j]
        return [
            FactoredCongruence(
                self.size, f, f_pattern, self.before, q, q_pattern, self.after, f_names, q_names, packing=self.stored
            ),
            # after it: an analyser goes through what a judgement guards once for each of its comparisons
            Refuse(Status.NOT_POSITIVE, AllOf(tuple(Compare(item, ">=", 0.0) for item in diagonal))),
        ]

    def innovation_variance(self, rows: Rows, r_pattern: Pattern, r_names: tuple[str, ...]) -> Kernel:
        """Diagonal of H U D U' H' + R at the prior."""
        return FactoredInnovationVariance(
            self.size, rows.count, rows.h, rows.h_pattern, rows.r, r_pattern, self.before, Place("out", "variance"),
            rows.h_names, r_names, packing=self.stored,
        )  # fmt: skip

    def takes_all_states(self, rows: Rows) -> bool:
        """Never."""
        return False

    def row_update(self, rows: Rows, row: int) -> Kernel:
        """Return Bierman's update by one row."""
        text = f"row {row}: " if rows.count > 1 else ""
        return FactoredRowUpdate(
            self.size, row, rows.residual, rows.count, rows.h, rows.h_pattern, rows.r, rows.count,
            self.before if row == 0 else self.after, self.after, rows.h_names, rows.r_names, rows.residual_names,
            (f"{text}d = d + K e, Bierman's update of U and D",), packing=self.stored,
        )  # fmt: skip

    def reset(self, g: Place, pattern: Pattern, names: tuple[str, ...]) -> Kernel:
        """P = G P G' for a corrected attitude."""
        return FactoredCongruence(
            self.size, g, pattern, self.after, None, (), self.after, names,
            comment=("U D U' = G U D U' G', G = I - [d]x / 2 for an attitude",), packing=self.stored,
        )  # fmt: skip

    def inflate(self, factor: Place) -> Kernel:
        """P = factor P."""
        return ScaleFactors(self.size, factor, self.before, self.after, packing=self.stored)

    def hold(self) -> list[Statement]:
        """Keep variances below their ceilings and D above its floors, refuse what cannot be."""
        return [HoldFactors(self.after, self.size, self.floor, self.ceiling, self.stored)]

    def judge_report(self, rows: int) -> list[Statement]:
        """Refuse a variance of the innovation beyond 1e30: factors within their ranges may make one."""
        return [Refuse(Status.OVERFLOW, Within(Place("out", "variance"), (0.0,) * rows, (1e30,) * rows))]

    def oracle(self, model: textbook.Model) -> Any:
        """Return the independent view."""
        return textbook.FactoredOracle(model)

    def memory(self, given: dict[str, Any]) -> dict[str, Any]:
        """Return a plausible memory that has a covariance as one in this form."""
        rest = {name: value for name, value in given.items() if name != "covariance"}
        return {**rest, self.field: textbook.factorised(given["covariance"], self.packing.blocks)}

    def covariance(self, memory: Mapping[str, Any]) -> Array:
        """Return P (n, n) of a memory."""
        return covariance_of(np.asarray(memory[self.field], dtype=float), self.packing)

    def scaled(self, memory: Mapping[str, Any], factor: float) -> dict[str, Any]:
        """Return the field of a memory whose covariance is multiplied by a factor, as far as D may go."""
        answer = np.array(memory[self.field], dtype=float)
        places = list(self.packing.diagonal)
        answer[places] = np.clip(answer[places] * factor, self.floor, self.ceiling)
        return {self.field: answer}

    def sizes(self, memory: Mapping[str, Any], sigma: Array) -> Array:
        """Return for each element the change that moves some element of P by its sigma_i sigma_j."""
        n = self.size
        table = self.packing.upper(np.asarray(memory[self.field], dtype=float))
        weights = np.maximum(np.diag(table), 1e-300)
        upper = np.triu(table, 1) + np.eye(n)
        seen = np.max(np.abs(upper) / sigma[:, None], axis=0)  # of each column of U, in sigma
        answer = sigma[:, None] / (weights * seen)[None, :]
        answer[np.diag_indices(n)] = 1.0 / seen**2
        return self.packing.pack(answer)


FORMS: dict[str, type[Conventional]] = {form.name: form for form in (Conventional, Joseph, Factored)}


def form_named(name: str, owner: str) -> type[Conventional]:
    """Return a form by its name.

    Raises
    ------
    ModelError
        If there is none of that name.
    """
    if name not in FORMS:
        raise ModelError(f"{owner}: the form {name!r} is not known; take one of {', '.join(map(repr, FORMS))}")
    return FORMS[name]


def packing_of(block: Block, field: str) -> Packing | None:
    """Return which elements of a symmetric matrix a field of the memory holds, or None if it holds none.

    Parameters
    ----------
    block : Block
        A filter, or a composition.
    field : str
        Dotted name, such as ``filter.covariance``.
    """
    part, _, rest = field.partition(".")
    if rest:
        return packing_of(block.parts[part], rest) if part in block.parts else None
    for entry in block.entries.values():
        for statement in walk(entry.body):
            if isinstance(statement, HoldVariances) and statement.target.name == field:
                return statement.layout
    return None
