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
    target : str
        Name of the machine the C is measured on: ``host``, ``cortex-m4``, ``cortex-m7`` or ``rv32``.
    contract : bool
        Whether a product and a sum may become one fused operation.
    mathematics : {"own", "libm"}
        Whose ``sin``, ``exp`` ... the C calls: those that plantc emits (the same bits everywhere), or the C library's.
    """

    precision: Precision = field(default_factory=lambda: Precision("double"))
    target: str = "host"
    contract: bool = False
    mathematics: str = "own"
