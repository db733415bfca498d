"""What a plant and an estimator are: expressions in, Blocks out."""

from casadi import acos, asin, atan, atan2, cos, exp, fabs, fmax, fmin, if_else, log, sin, sqrt, tan, tanh, vertcat

from .block import Block, Oracle, Scenario, Table
from .controllers import (
    low_pass,
    notch,
    pid,
    rate_limiter,
    saturation,
    state_feedback,
    state_space,
    transfer_function,
)
from .design import Gain, ackermann, lqr, place, place_chains
from .errors import ModelError
from .plant import Attitude, Plant, Symbol
from .signals import Status

__all__ = [
    "Attitude",
    "Block",
    "Gain",
    "ModelError",
    "Oracle",
    "Plant",
    "Scenario",
    "Status",
    "Symbol",
    "Table",
    "ackermann",
    "acos",
    "asin",
    "atan",
    "atan2",
    "cos",
    "exp",
    "fabs",
    "fmax",
    "fmin",
    "if_else",
    "log",
    "low_pass",
    "lqr",
    "notch",
    "pid",
    "place",
    "place_chains",
    "rate_limiter",
    "saturation",
    "sin",
    "sqrt",
    "state_feedback",
    "state_space",
    "tan",
    "tanh",
    "transfer_function",
    "vertcat",
]
