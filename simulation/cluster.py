"""The runs of a Monte-Carlo on a Dask cluster: the extra `plantc[cluster]`.

A worker gets the C as text and compiles it itself; what it sends back is what became of each run.
"""

from __future__ import annotations

import hashlib
import pickle
import re
import zlib
from collections.abc import Generator, Iterator, Mapping
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from .metrics import Judgement

if TYPE_CHECKING:
    from .monte_carlo import Work

Done = Generator[tuple[int, Judgement], None, None]

RETRIES = 3
PATIENCE = "20s"


class ClusterError(RuntimeError):
    """The cluster cannot be used. The message says what to do."""


def on_cluster(address: str, work: Work, starts: Mapping[int, Any]) -> Done:
    """Yield runs as a cluster has done them; those of a worker that dies are run by another.

    Parameters
    ----------
    address : str
        ``dask://HOST:PORT`` of the scheduler.
    work : Work
        What all runs share.
    starts : dict of int to dict
        Run -> its start.

    Raises
    ------
    ClusterError
        If the address is none, Dask is not installed, the scheduler does not answer, or workers keep dying.
    """
    with connected(address) as client:
        yield from _results(client, work, starts)


_held: dict[str, Any] = {}


@contextmanager
def connected(address: str | None) -> Iterator[Any]:
    """Hold a connection to a cluster; what runs there meanwhile uses it, in place of one of its own.

    Parameters
    ----------
    address : str or None
        ``dask://HOST:PORT``; None is this process, which needs no connection.

    Raises
    ------
    ClusterError
        As by `on_cluster`.
    """
    if address is None or address in _held:
        yield _held.get(address or "")
        return
    with _client(address) as client:
        _held[address] = client
        try:
            yield client
        finally:
            del _held[address]


def _client(address: str) -> Any:
    found = re.fullmatch(r"dask://([^/:\s]+|\[[0-9a-fA-F:]+\]):(\d+)/?", address)
    if found is None:
        raise ClusterError(f"{address!r} is no address of a cluster; give dask://HOST:PORT, that of the Dask scheduler")
    try:
        import distributed
    except ImportError:
        raise ClusterError(
            "dask is not installed here; pip install 'plantc[cluster]', here and on every worker"
        ) from None
    try:
        return distributed.Client(f"tcp://{found[1]}:{found[2]}", timeout=PATIENCE, set_as_default=False)
    except (OSError, TimeoutError) as error:
        raise ClusterError(
            f"no Dask scheduler answers at {address} ({type(error).__name__}); start one with 'dask scheduler'"
        ) from None


def _results(client: Any, work: Work, starts: Mapping[int, Any]) -> Done:
    import distributed

    packed = zlib.compress(pickle.dumps(work))
    workers = max(1, len(client.nthreads()))
    size = max(1, min(10, len(starts) // (8 * workers)))
    runs = list(starts)
    shares = [runs[at : at + size] for at in range(0, len(runs), size)]
    futures = [
        client.submit(run_share, packed, {run: starts[run] for run in share}, pure=False, retries=RETRIES)
        for share in shares
    ]
    try:
        for future in distributed.as_completed(futures, loop=client.loop):
            try:
                rows = future.result()
            except distributed.scheduler.KilledWorker:
                raise ClusterError(
                    "a share of the runs was given to several workers, and each died of it; look at the workers' logs (memory?)"
                ) from None
            yield from rows.items()
            future.release()
    finally:
        client.cancel([future for future in futures if not future.done()])


_unpacked: dict[str, Any] = {}


def run_share(packed: bytes, starts: Mapping[int, Any]) -> dict[int, Judgement]:
    """Run some runs, on a worker; see `monte_carlo.run_one`."""
    from .monte_carlo import run_one

    digest = hashlib.sha256(packed).hexdigest()
    if digest not in _unpacked:
        _unpacked.clear()
        _unpacked[digest] = pickle.loads(zlib.decompress(packed))
    work = _unpacked[digest]
    return {run: run_one(work, run, start) for run, start in starts.items()}
