"""A Dask cluster of two processes gives the same bytes as this process, also when a worker is killed half way."""

import contextlib
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from plantc.simulation import ClusterError, Result, Start, closed_loop, connected, monte_carlo

from plantc import Block, Plant

ROOT = Path(__file__).resolve().parents[2]
SETTINGS = {"runs": 60, "steps": 30_000, "seed": 4, "start": Start(1.0)}


@pytest.fixture(scope="module")
def tank():
    plant = Plant("tank", dt=1.0)
    level = plant.state("level", unit="m", range=(-50, 50))
    flow = plant.input("flow", unit="m", range=(-100, 100))
    leak = plant.noise("leak", std=0.1, unit="m")
    plant.dynamics({level: level + flow + leak})
    plant.sensor("gauge", level, unit="m", variance=0.01)
    pilot = Block("pilot")
    gauge = pilot.input("gauge", unit="m", range=(-200, 200))
    pilot.entry("step", inputs=[gauge], outputs={"flow": -0.4 * gauge}, output_units={"flow": "m"})
    return closed_loop(plant, pilot, {"level": 0.0}, name="tank_loop")


def environment(cache):
    """Workers have a cache of their own, so that they compile the C themselves."""
    paths = os.pathsep.join(filter(None, [str(ROOT), os.environ.get("PYTHONPATH", "")]))
    return {**os.environ, "PYTHONPATH": paths, "XDG_CACHE_HOME": str(cache), "PYTHONWARNINGS": "default"}


@contextlib.contextmanager
def cluster(folder, workers=2):
    """A scheduler and workers, each a process; yields (address, worker processes)."""
    processes = []

    def start(*arguments):
        log = (folder / f"log{len(processes)}").open("w+")
        command = [sys.executable, "-m", "distributed.cli." + arguments[0], *arguments[1:]]
        processes.append(
            (subprocess.Popen(command, stdout=log, stderr=log, env=environment(folder / "cache"), cwd=folder), log)
        )
        return processes[-1]

    def wait_for(pattern, log):
        for _ in range(600):
            found = re.search(pattern, Path(log.name).read_text())
            if found:
                return found
            time.sleep(0.1)
        pytest.fail(f"nothing like {pattern!r} in {Path(log.name).read_text()[-1000:]}")

    try:
        _, log = start("dask_scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard")
        address = wait_for(r"Scheduler at:\s+tcp://(127\.0\.0\.1:\d+)", log)[1]
        made = [
            start("dask_worker", address, "--nthreads", "1", "--no-nanny", "--no-dashboard") for _ in range(workers)
        ]
        for _, log in made:
            wait_for(r"Registered to", log)
        yield f"dask://{address}", [process for process, _ in made]
    finally:
        for process, log in processes:
            with contextlib.suppress(ProcessLookupError):
                process.kill()
            process.wait()
            log.close()


@pytest.mark.slow
@pytest.mark.filterwarnings("default")
def test_a_cluster_gives_the_same_bytes_also_when_a_worker_is_killed_half_way(tank, tmp_path, monkeypatch, needs):
    needs("python:distributed")
    monte_carlo(tank, **SETTINGS, file=tmp_path / "here")
    with cluster(tmp_path) as (address, workers):
        with connected(address) as client, monkeypatch.context() as patch:
            patch.setattr("distributed.Client", None)  # none but the connection that is held
            monte_carlo(tank, **SETTINGS, on=address, file=tmp_path / "there")
            assert client.status == "running"
            monte_carlo(tank, **(SETTINGS | {"steps": 10}), on=address)
        assert client.status == "closed"
        killed = []

        def kill_one(done, total):
            if done and not killed:
                killed.append(done)
                workers[0].send_signal(signal.SIGKILL)
                workers[0].wait()

        monte_carlo(tank, **SETTINGS, on=address, file=tmp_path / "killed", progress=kill_one)
        assert workers[0].returncode == -signal.SIGKILL
        assert killed[0] < 30  # it had the greater part of its half before it
    assert not Result.load(tmp_path / "there").missing
    assert list((tmp_path / "cache" / "plantc").glob("*.so"))  # the workers compiled
    assert (tmp_path / "there").read_bytes() == (tmp_path / "here").read_bytes()
    assert (tmp_path / "killed").read_bytes() == (tmp_path / "here").read_bytes()


@pytest.mark.parametrize("address", ["dask:/x:1", "127.0.0.1:8786", "dask://host", "ssh://host:22"])
def test_what_is_no_address_is_said(tank, address):
    with pytest.raises(ClusterError, match="is no address of a cluster; give dask://HOST:PORT"):
        monte_carlo(tank, runs=1, steps=1, on=address)


def test_this_process_needs_no_connection(tank):
    with connected(None) as client:
        assert client is None
        assert not monte_carlo(tank, runs=2, steps=3).missing


def test_without_dask_a_sentence_says_what_to_install(tank, monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(ClusterError, match=r"dask is not installed here; pip install 'plantc\[cluster\]'"):
        monte_carlo(tank, runs=1, steps=1, on="dask://127.0.0.1:1")


@pytest.mark.filterwarnings("default")
def test_a_scheduler_that_does_not_answer_is_said(tank, monkeypatch, needs):
    needs("python:distributed")
    monkeypatch.setattr(sys.modules["plantc.simulation.cluster"], "PATIENCE", "1s")
    with pytest.raises(ClusterError, match=r"no Dask scheduler answers at dask://127\.0\.0\.1:9 "):
        monte_carlo(tank, runs=1, steps=1, on="dask://127.0.0.1:9")
