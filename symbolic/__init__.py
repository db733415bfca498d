"""What a plant and an estimator are: expressions in, Blocks out."""

from casadi import acos, asin, atan, atan2, cos, exp, fabs, fmax, fmin, if_else, log, sin, sqrt, tan, tanh, vertcat

from .block import Block, Oracle, Scenario, Table
from .errors import ModelError
from .plant import Attitude, Plant, Symbol
from .signals import Status

__all__ = [
    "Attitude",
    "Block",
    "ModelError",
    "Oracle",
    "Plant",
    "Scenario",
    "Status",
    "Symbol",
    "Table",
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
    "sin",
    "sqrt",
    "tan",
    "tanh",
    "vertcat",
]
