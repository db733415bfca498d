"""Monte-Carlo of a closed loop in compiled C: threads here, or a Dask cluster, with the same bits.

A run depends on (seed, run index) and on nothing else; rows are kept by run index, and sums are in that order.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Generator, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor, as_completed
from contextlib import contextmanager
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from threading import Lock
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..codegen.batch import Batch, BatchText
from ..codegen.emit import generator_version
from ..codegen.layout import why_refused
from ..codegen.views import NativeView
from ..reference import quaternions
from ..symbolic.block import Block
from ..symbolic.errors import ModelError, expect, whole
from .closed_loop import ClosedLoop, Layout, run_batch
from .cluster import on_cluster
from .metrics import History, Judgement, StatePlace, judge
from .noise import CONVENTION, Channel, channels, draw, stream
from .results import FORMAT, Result, ResultError, row_line

Array = NDArray[np.float64]
Progress = Callable[[int, int], None]
Done = Generator[tuple[int, Judgement], None, None]


class Interrupted(KeyboardInterrupt):
    """The user interrupted a Monte-Carlo; what was done is in `result`, and in the file if one was given."""

    def __init__(self, result: Result):
        super().__init__(f"interrupted after {len(result.judgements)} of {result.runs} runs")
        self.result = result


@dataclass(frozen=True)
class Start:
    """Where the runs start.

    Attributes
    ----------
    deviation : float or dict of str to float
        Half width of the uniform distribution of each state about the set point (for an attitude, of its small rotation,
        in rad); one number for all, or by state, the rest zero.
    known : bool
        Whether the estimate starts at the true state, and the first command is the controller's for it; else the estimate
        starts at the set point, and the first command is that of the set point.
    """

    deviation: float | Mapping[str, float] = 0.0
    known: bool = False


@dataclass(frozen=True, eq=False)
class Work:
    """All that a run needs, but for its index and its start; it can be pickled, and holds no library.

    Attributes
    ----------
    text : BatchText
        The C of the loop.
    layout : Layout
        Where everything lies.
    channels : tuple of Channel
        The noises.
    held : dict
        Constant inputs.
    params : dict
        Parameters, the same in all runs.
    steps, seed : int
        Length of a run; the key of the streams.
    limits : dict
        See `metrics.judge`.
    """

    text: BatchText
    layout: Layout
    channels: tuple[Channel, ...]
    held: dict[str, float]
    params: dict[str, Any]
    steps: int
    seed: int
    limits: dict[str, float]


_batches: dict[str, Batch] = {}
_compiling = Lock()


def _batch_of(text: BatchText) -> Batch:
    """Return the compiled batch of a text; each process compiles it once."""
    with _compiling:
        if text.digest not in _batches:
            if text.version != generator_version():
                raise ResultError(
                    f"the C was written by plantc {text.version}, this worker has {generator_version()}; install the same version "
                    "everywhere"
                )
            _batches[text.digest] = Batch(text)
        return _batches[text.digest]


def run_one(work: Work, run: int, start: Mapping[str, Array]) -> Judgement:
    """Return what becomes of a run.

    Parameters
    ----------
    work : Work
        What all runs share.
    run : int
        Its index: with the seed it is the key of its noise.
    start : dict
        Parameter -> value, of this run's start.

    Raises
    ------
    ResultError
        If the C was written by another plantc than the one that is to run it.
    """
    batch = _batch_of(work.text)
    given = batch.params({**work.params, **start})
    try:
        batch.init(given)
    except ValueError:  # the parameters were accepted without the start: it is the start that is out of range
        return Judgement("frozen", "BAD_PARAM", 0, 0)
    return judge(_history(work, run, start), work.limits)


def _history(work: Work, run: int, start: Mapping[str, Array]) -> History:
    noise = {channel.name: draw(channel, work.seed, run, work.steps) for channel in work.channels}
    params = {**work.params, **start}
    return run_batch(_batch_of(work.text), work.layout, noise, work.steps, params=params, held=work.held)


def replay(
    loop: ClosedLoop,
    run: int,
    *,
    steps: int = 2000,
    seed: int = 0,
    start: Start | None = None,
    std: Mapping[str, Any] | None = None,
    covariance: Mapping[str, Any] | None = None,
    params: Mapping[str, Any] | None = None,
) -> History:
    """Run one run of a Monte-Carlo again and return all that happened in it.

    Parameters
    ----------
    loop : ClosedLoop
        What `closed_loop` gave.
    run : int
        Its index.
    steps, seed, start, std, covariance, params
        As for `monte_carlo`.

    Raises
    ------
    ModelError, ValueError
        As by `monte_carlo`; ValueError also if the start of this run is out of range.
    """
    expect(loop, ClosedLoop, "replay: the loop", "what closed_loop(plant, controller, point) returns")
    run = whole(run, "replay: run", 0, 2**64 - 1)
    start = Start() if start is None else start
    work = _work(loop, steps, seed, start, std, covariance, params, None)
    _refuse_starts(loop, start, params or {})
    return _history(work, run, _start_of(loop, start, work.seed, run, work.params))


def monte_carlo(
    loop: ClosedLoop,
    *,
    runs: int = 100,
    steps: int = 2000,
    seed: int = 0,
    start: Start | None = None,
    std: Mapping[str, Any] | None = None,
    covariance: Mapping[str, Any] | None = None,
    params: Mapping[str, Any] | None = None,
    limits: Mapping[str, float] | None = None,
    on: str | None = None,
    jobs: int | None = None,
    progress: Progress | bool | None = None,
    file: Path | str | None = None,
) -> Result:
    """Run a closed loop many times and return what became of the runs.

    The result is the same bit for bit whatever the number of threads, and on a cluster of machines of the same kind. Two
    loops with the same noises, seed and start meet the same noise in the same run.

    Parameters
    ----------
    loop : ClosedLoop
        What `closed_loop` gave.
    runs, steps : int
        How many runs, of how many steps.
    seed : int
        Key of the streams, 0 .. 2^64 - 1.
    start : Start, optional
        Where the runs start; default at the set point.
    std, covariance : dict, optional
        Noise -> its strength per step in the simulated truth, instead of the plant's; see `noise.channels`. What an estimator
        believes of it is a parameter: ``params={"controller.estimator.variance_pose": ...}``.
    params : dict, optional
        Dotted parameter of the loop -> value; not those that `start` sets.
    limits : dict, optional
        State -> largest distance from the set point at which the plant counts as kept.
    on : str, optional
        ``dask://HOST:PORT``, a scheduler; default this process.
    jobs : int, optional
        Threads; default as many as there are cores for this process. On a cluster its workers decide.
    progress : callable or bool, optional
        Called with (runs done, runs asked); True shows a bar on standard error.
    file : Path or str, optional
        Where the result is written, run by run. If it is there already it must be of the same settings, only what is
        missing is run, and what it holds beyond the runs that are asked for stays in it.

    Returns
    -------
    Result
        With every run that was asked for.

    Raises
    ------
    ModelError
        If a name is not known, or a strength, a start, a limit or `jobs` is out of range.
    ValueError
        If `init` refuses the parameters.
    ResultError
        If the file is of other settings, or a worker has another plantc.
    ClusterError
        If the cluster cannot be reached, or Dask is not installed.
    Interrupted
        On an interrupt; what was done is in it, and in the file.
    """
    expect(loop, ClosedLoop, "monte_carlo: the loop", "what closed_loop(plant, controller, point) returns")
    runs, jobs = whole(runs, "monte_carlo: runs", 1), None if jobs is None else whole(jobs, "monte_carlo: jobs", 1)
    begin = Start() if start is None else start
    if file is not None and not Path(file).absolute().parent.is_dir():
        raise ModelError(
            f"monte_carlo: file is {str(file)!r}, and there is no folder {str(Path(file).parent)!r}; make it first"
        )
    work = _work(loop, steps, seed, begin, std, covariance, params, limits)
    _refuse_starts(loop, begin, params or {})
    result, stored = _so_far(_header(loop, work, runs, begin), file)
    starts = {run: _start_of(loop, begin, work.seed, run, work.params) for run in result.missing}
    with _shown(loop.block, progress) as report, _Writer(result, stored, file) as writer:
        report(runs - len(starts), runs)
        if on is None:
            done = _threads(work, starts, jobs)
        else:
            done = on_cluster(on, work, starts)
        try:
            for run, judgement in done:
                writer.add(run, judgement)
                report(len(result.judgements), runs)
        except KeyboardInterrupt:
            raise Interrupted(result) from None
        finally:
            done.close()
    return result


def _threads(work: Work, starts: Mapping[int, Any], jobs: int | None) -> Done:
    """Yield runs as they are done; the C releases the interpreter lock, so threads are enough."""
    _batch_of(work.text)
    count = jobs or cores()
    if count == 1:
        for run, start in starts.items():
            yield run, run_one(work, run, start)
        return
    with ThreadPoolExecutor(count) as pool:
        futures = {pool.submit(run_one, work, run, start): run for run, start in starts.items()}
        try:
            for future in as_completed(futures):
                yield futures[future], future.result()
        finally:
            pool.shutdown(cancel_futures=True)


def cores() -> int:
    """Return the number of cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _work(
    loop: ClosedLoop,
    steps: int,
    seed: int,
    start: Start,
    std: Mapping[str, Any] | None,
    covariance: Mapping[str, Any] | None,
    params: Mapping[str, Any] | None,
    limits: Mapping[str, float] | None,
) -> Work:
    steps, seed = whole(steps, "the number of steps", 1), whole(seed, "the seed", 0, 2**64 - 1)
    expect(start, Start, "start=", "Start(deviation), such as Start(0.2), or Start({state: 0.2})")
    for what, given in (("std", std), ("covariance", covariance), ("params", params), ("limits", limits)):
        expect({} if given is None else given, Mapping, f"{what}=", "a dict from names to values")
    known = {signal.name for signal in loop.block.param_signals_flat()}
    unknown = sorted(set(params or {}) - known)
    if unknown:
        raise ModelError(f"{unknown[0]!r} is no parameter of the loop; it has {', '.join(sorted(known))}")
    names = [state.name for state in loop.layout.states]
    strange = sorted(set(limits or {}) - set(names))
    if strange:
        raise ModelError(f"limits= names {strange[0]!r}, which is no state; the states are {', '.join(names)}")
    for name, limit in (limits or {}).items():
        if not limit >= 0:
            raise ModelError(
                f"limits= gives {limit} for {name!r}; give the largest distance from the set point, zero or more"
            )
    settled = loop.estimate_parameters(np.array(loop.layout.point))
    given = {name: np.asarray(value, dtype=float).ravel() for name, value in {**settled, **(params or {})}.items()}
    work = Work(
        loop.text, loop.layout, channels(loop.noises, std, covariance), loop.held, given, steps, seed, dict(limits or {})
    )  # fmt: skip
    batch = _batch_of(work.text)
    record = batch.params(given)
    try:
        batch.init(record)
    except ValueError as error:
        raise ValueError(f"{error}: {why_refused(loop.block, record)}") from None
    return work


def _refuse_starts(loop: ClosedLoop, start: Start, params: Mapping[str, Any]) -> None:
    """Refuse parameters that the start sets in every run: they would be lost without a word."""
    own = set(loop.truth_parameters(np.array(loop.layout.point)))
    if start.known:
        own |= set(loop.estimate_parameters(np.array(loop.layout.point)))
        own |= set(loop.command_parameters(loop.point.u))
    both = sorted(own & set(params))
    if both:
        raise ModelError(
            f"params= gives {both[0]!r}, which start= sets in each run; move the set point, or say with start= how far "
            "from it the runs start"
        )


def _header(loop: ClosedLoop, work: Work, runs: int, start: Start) -> dict[str, Any]:
    """Return what made a result, in plain numbers and words."""
    deviation = start.deviation if isinstance(start.deviation, (int, float)) else dict(start.deviation)
    return {
        "format": FORMAT,
        "plantc": work.text.version,
        "block": loop.block.name,
        "model": work.text.model,
        "runs": runs,
        "steps": work.steps,
        "seed": work.seed,
        "start": {"deviation": deviation, "known": start.known},
        "noise": {item.name: (item.factor @ item.factor.T).tolist() for item in work.channels},
        "params": {name: value.tolist() for name, value in sorted(work.params.items())},
        "held": work.held,
        "limits": work.limits,
        "set_point": list(work.layout.point),
        "conventions": {
            "streams": CONVENTION,
            "noise": [item.convention for item in work.channels],
            "start": "uniform about the set point, from the stream named 'start', in the order of the states",
            "loop": "x(k) = f(x(k-1), u(k-1)) + noise, z(k) = h(x(k)) + noise, u(k) = controller(z(k)), k = 1 .. steps",
            "metrics": "means over k = 1 .. steps of sums over the states, and errors by state; see plantc.simulation.metrics_of",
        },
    }


def _start_of(
    loop: ClosedLoop, start: Start, seed: int, run: int, given: Mapping[str, Any] | None = None
) -> dict[str, Array]:
    """Return the parameters of a run's start."""
    states, point = loop.layout.states, np.array(loop.layout.point)
    widths = _widths(states, start.deviation)
    x = _moved(states, point, widths * stream(seed, run, "start").uniform(-1.0, 1.0, len(widths)))
    params = loop.truth_parameters(x)
    if start.known:
        params |= loop.estimate_parameters(x)
        params |= loop.command_parameters(first_command(loop, x, given))
    return params


def _widths(states: tuple[StatePlace, ...], given: float | Mapping[str, float]) -> Array:
    names = [state.name for state in states]
    unknown = sorted(set(given) - set(names)) if isinstance(given, Mapping) else []
    if unknown:
        raise ModelError(f"the start names {unknown[0]!r}, which is no state; the states are {', '.join(names)}")
    widths = []
    for state in states:
        width = float(given.get(state.name, 0.0)) if isinstance(given, Mapping) else float(given)
        if not 0 <= width < np.inf:
            raise ModelError(f"the deviation of {state.name!r} at the start is {width}; give a number, zero or more")
        widths += [width] * (3 if state.kind == "attitude" else state.size)
    return np.array(widths)


def _moved(states: tuple[StatePlace, ...], x: Array, error: Array) -> Array:
    pieces, start, error_start = [], 0, 0
    for state in states:
        size = 3 if state.kind == "attitude" else state.size
        value, change = x[start : start + state.size], error[error_start : error_start + size]
        if state.kind == "attitude":
            value = quaternions.product(value, quaternions.exponential(change))
            value = value / np.sqrt(np.sum(value * value))
        else:
            value = value + change
        if state.kind == "angle":
            value = value - 2 * np.pi * np.floor(value / (2 * np.pi) + 0.5)
        pieces.append(value)
        start, error_start = start + state.size, error_start + size
    return np.concatenate(pieces)


def first_command(loop: ClosedLoop, x: Array, params: Mapping[str, Any] | None = None) -> Array:
    """Return what the controller commands for an estimate x: the output of its part that maps states to commands.

    Parameters
    ----------
    loop : ClosedLoop
        The loop.
    x : array (n,)
        The estimate.
    params : dict, optional
        Dotted parameter of the loop -> value, where it is not the default.

    Raises
    ------
    ModelError
        If no part takes every state and gives every command.
    """
    plant = loop.point.plant
    states = [state.signal.name for state in plant.states]
    commands = [symbol.signal.name for symbol in plant.inputs]
    if not commands:
        return np.zeros(0)
    parts = {f"controller.{name}.": part for name, part in loop.controller.parts.items()}
    for prefix, part in {**parts, "controller.": loop.controller}.items():
        entry = part.entries["step"]
        if {s.name for s in entry.inputs} == set(states) and {s.name for s in entry.outputs} >= set(commands):
            view = _view_of(part)
            own = {key.removeprefix(prefix): value for key, value in (params or {}).items() if key.startswith(prefix)}
            given = view.params(**{key.replace(".", "__"): value for key, value in own.items()})
            inputs = view.inputs("step", dict(zip(states, loop.pieces(x), strict=True)))
            answer = view.call("step", view.init(given), inputs, given)
            return np.concatenate([np.zeros(0), *[np.ravel(answer.outputs[name]) for name in commands]])
    raise ModelError(
        f"{loop.controller.name}: no part of it takes every state and gives every command, so that the first command for a known "
        "start is not known; start with known=False"
    )


@lru_cache(maxsize=16)
def _view_of(part: Block) -> NativeView:
    """Return the compiled part; it is emitted once for all runs."""
    return NativeView(part)


def _so_far(header: dict[str, Any], file: Path | str | None) -> tuple[Result, Result]:
    """Return what is done of the runs that are asked for, and all that the file is to hold: it may have more."""
    if file is None or not Path(file).exists():
        return Result(header), Result(header)
    before = Result.load(file)
    differs = before.same_settings(header)
    if differs:
        raise ResultError(
            f"{file} was made with another {differs} ({before.header.get(differs)!r}, now {header.get(differs)!r}); give another "
            "file, or remove it"
        )
    kept = {run: item for run, item in before.judgements.items() if run < header["runs"]}
    stored = Result({**header, "runs": max(header["runs"], before.runs)}, dict(before.judgements))
    return Result(header, kept), stored


class _Writer:
    """Adds runs to a result, and to its file as they come; at the end the file is written in the order of the runs."""

    def __init__(self, result: Result, stored: Result, file: Path | str | None):
        self.result, self.stored, self.path = result, stored, None if file is None else Path(file)
        self.stream: Any = None

    def __enter__(self) -> _Writer:
        if self.path is not None:
            self.stored.save(self.path)
            self.stream = self.path.open("a")
        return self

    def add(self, run: int, judgement: Judgement) -> None:
        self.result.judgements[run] = self.stored.judgements[run] = judgement
        if self.stream is not None:
            self.stream.write(row_line(run, judgement))
            self.stream.flush()

    def __exit__(self, *_: object) -> None:
        if self.stream is not None and self.path is not None:
            self.stream.close()
            self.stored.save(self.path)


@contextmanager
def _shown(block: Block, progress: Progress | bool | None) -> Iterator[Progress]:
    """Yield what is told of progress."""
    if callable(progress):
        yield progress
        return
    if not progress:
        yield lambda done, total: None
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeElapsedColumn
    from rich.progress import Progress as Bar

    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    console = Console(stderr=True)
    with Bar(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task(block.name)
        yield lambda done, total: bar.update(task, completed=done, total=total)
