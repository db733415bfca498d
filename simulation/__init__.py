"""Closed loops, noise, Monte-Carlo and metrics, over any View."""

from .closed_loop import ClosedLoop, closed_loop, run_batch, simulate
from .cluster import ClusterError, connected
from .metrics import History, Judgement, judge, metrics_of
from .monte_carlo import Interrupted, Start, monte_carlo, replay
from .noise import Channel, channels, draw, stream
from .results import Mean, Result, ResultError
from .study import (
    Comparison,
    Picture,
    StudyResult,
    StudyTable,
    check_study_folder,
    compared,
    each,
    study_page,
    write_study,
)

__all__ = [
    "Channel",
    "ClosedLoop",
    "ClusterError",
    "Comparison",
    "History",
    "Interrupted",
    "Judgement",
    "Mean",
    "Picture",
    "Result",
    "ResultError",
    "Start",
    "StudyResult",
    "StudyTable",
    "channels",
    "check_study_folder",
    "closed_loop",
    "compared",
    "connected",
    "draw",
    "each",
    "judge",
    "metrics_of",
    "monte_carlo",
    "replay",
    "run_batch",
    "simulate",
    "stream",
    "study_page",
    "write_study",
]
