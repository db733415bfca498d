"""The same estimators as plain NumPy, written to be read next to a textbook: the oracle.

It knows no CasADi and imports no other package of plantc: it is told f and h as NumPy callables, and derives
everything else by itself, by complex step. Whoever builds a Block hands it over; see "The oracle" in the design.
"""

from __future__ import annotations

from .estimators import (
    Exercise,
    InputModel,
    KalmanOracle,
    Model,
    NoiseModel,
    SensorModel,
    StateModel,
    Status,
    derivative,
)

__all__ = [
    "Exercise",
    "InputModel",
    "KalmanOracle",
    "Model",
    "NoiseModel",
    "SensorModel",
    "StateModel",
    "Status",
    "derivative",
]
