"""Kalman filters as plain NumPy, written to be read next to a textbook: the oracle of `plantc.symbolic.estimators`.

Nothing here knows CasADi, C, or a derivative that somebody else made: f and h come as NumPy callables.
"""

from __future__ import annotations

from .exercise import Exercise
from .factors import FactoredOracle, factorised
from .kalman import KalmanOracle, Status, derivative
from .model import InputModel, Model, NoiseModel, SensorModel, StateModel

__all__ = [
    "Exercise",
    "FactoredOracle",
    "InputModel",
    "KalmanOracle",
    "Model",
    "NoiseModel",
    "SensorModel",
    "StateModel",
    "Status",
    "derivative",
    "factorised",
]
