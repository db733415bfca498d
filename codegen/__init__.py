"""Blocks in, C out: emit, compile, inspect, cross-check, package."""

from .compiler import CompilerError, find_compiler
from .crosscheck import CrossCheck, cross_check
from .emit import CText, emit
from .emulator import TargetView
from .package import DesignError, Export, ExportError, check_folder, export
from .targets import TARGETS, Target, TargetError
from .trace import Trace, TraceCall, TraceError
from .views import Answer, InterpretView, NativeView, ReferenceView, View

__all__ = [
    "TARGETS",
    "Answer",
    "CText",
    "CompilerError",
    "CrossCheck",
    "DesignError",
    "Export",
    "ExportError",
    "InterpretView",
    "NativeView",
    "ReferenceView",
    "Target",
    "TargetError",
    "TargetView",
    "Trace",
    "TraceCall",
    "TraceError",
    "View",
    "check_folder",
    "cross_check",
    "emit",
    "export",
    "find_compiler",
]
