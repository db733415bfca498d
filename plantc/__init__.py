"""plantc, the compiler for plants.

Write a plant once, symbolically; get its Kalman filter as standalone C99 that was compiled and shown to compute what the
Python says.

>>> from plantc import Plant, extended_kalman_filter
>>> cart = Plant("cart")
>>> position, speed = cart.state("position", unit="m"), cart.state("speed", unit="m/s")
>>> gust = cart.noise("gust", density=0.01, unit="m/s^2")
>>> cart.dynamics({position: speed, speed: gust})
>>> cart.sensor("gps", position, unit="m", variance=4.0)
>>> cart_ekf = extended_kalman_filter(cart.discretise("exact", dt=0.1), initial_variance={position: 100, speed: 1})
>>> list(cart_ekf.entries)
['init', 'predict', 'update_gps', 'step', 'inflate']
"""

from pathlib import Path as _Path

# In a checkout the sub-packages lie beside this folder; so it also works where `python -m` puts the checkout first.
_checkout = _Path(__file__).resolve().parent.parent
if (_checkout / "pyproject.toml").is_file() and not (_Path(__file__).parent / "symbolic").exists():
    __path__.append(str(_checkout))

from .codegen import InterpretView, NativeView, ReferenceView, Trace, cross_check, emit, export
from .symbolic import Attitude, Block, ModelError, Plant, Status
from .symbolic.analysis import OperatingPoint, linearise, trim
from .symbolic.command_filter import command_filter
from .symbolic.composition import connect, delay, wires
from .symbolic.controllers import (
    low_pass,
    notch,
    pid,
    rate_limiter,
    saturation,
    state_feedback,
    state_space,
    transfer_function,
)
from .symbolic.design import Gain, ackermann, lqr, place, place_chains
from .symbolic.estimators import extended_kalman_filter, kalman_filter, steady_state_kalman_filter
from .symbolic.fuzzy import FuzzyInput, FuzzyOutput, FuzzySet, FuzzySystem
from .symbolic.james_stein import james_stein_estimator
from .symbolic.jump_matrix import JumpModel, jump_matrix_estimator, jump_model, jump_simulation
from .symbolic.output_regulator import output_regulator
from .symbolic.power_series import regulator_series
from .symbolic.regulator_equations import francis
from .symbolic.sliding_mode import reaching_time, sliding_mode, switching_gain

__all__ = [
    "Attitude",
    "Block",
    "FuzzyInput",
    "FuzzyOutput",
    "FuzzySet",
    "FuzzySystem",
    "Gain",
    "InterpretView",
    "JumpModel",
    "ModelError",
    "NativeView",
    "OperatingPoint",
    "Plant",
    "ReferenceView",
    "Status",
    "Trace",
    "ackermann",
    "command_filter",
    "connect",
    "cross_check",
    "delay",
    "emit",
    "export",
    "extended_kalman_filter",
    "francis",
    "james_stein_estimator",
    "jump_matrix_estimator",
    "jump_model",
    "jump_simulation",
    "kalman_filter",
    "linearise",
    "low_pass",
    "lqr",
    "notch",
    "output_regulator",
    "pid",
    "place",
    "place_chains",
    "rate_limiter",
    "reaching_time",
    "regulator_series",
    "saturation",
    "sliding_mode",
    "state_feedback",
    "state_space",
    "steady_state_kalman_filter",
    "switching_gain",
    "transfer_function",
    "trim",
    "wires",
]
