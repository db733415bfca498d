"""Closed loops, noise, Monte-Carlo and metrics, over any View."""

from .closed_loop import ClosedLoop, closed_loop, run_batch, simulate
from .cluster import ClusterError
from .metrics import History, Judgement, judge, metrics_of
from .monte_carlo import Interrupted, Start, monte_carlo
from .noise import Channel, channels, draw, stream
from .results import Mean, Result, ResultError

__all__ = [
    "Channel",
    "ClosedLoop",
    "ClusterError",
    "History",
    "Interrupted",
    "Judgement",
    "Mean",
    "Result",
    "ResultError",
    "Start",
    "channels",
    "closed_loop",
    "draw",
    "judge",
    "metrics_of",
    "monte_carlo",
    "run_batch",
    "simulate",
    "stream",
]
