"""What may be chosen for an export, beside the model itself."""

from __future__ import annotations

from dataclasses import dataclass, field

from .style import Precision


@dataclass(frozen=True)
class Options:
    """The choices of an export.

    Attributes
    ----------
    precision : Precision
        Type of every real number in the C.
    targets : tuple of str
        Names of the machines the C is measured on, beside the host: ``cortex-m4``, ``cortex-m7``, ``rv32``.
    contract : bool
        Whether a product and a sum may become one fused operation.
    mathematics : {"own", "libm"}
        Whose ``sin``, ``exp`` ... the C calls: those that plantc emits (the same bits everywhere), or the C library's.
    flash, ram : int
        Bytes that the targets have; 0: as they stand in `TARGETS`.
    tables : bool
        Whether what the block brings to be measured on demand is measured: its ``tables``.
    """

    precision: Precision = field(default_factory=lambda: Precision("double"))
    targets: tuple[str, ...] = ("host",)
    contract: bool = False
    mathematics: str = "own"
    flash: int = 0
    ram: int = 0
    tables: bool = False
