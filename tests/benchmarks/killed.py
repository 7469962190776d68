"""Studies: one that is killed four times and goes on is equal in every bit to those that nothing happened to.

    pip install '.[studies]' && python -m tests.benchmarks.killed [RUNS]

Starts of the dumbbell, 20 000 by default, are run one after another, in two threads, and by two processes of dask;
then once more with kill -9 of the client in threads, kill -9 of a worker, Ctrl-C to the client of dask and kill -9 of
that client.  Printed are the sha256 of all arrays of each, the time, and the most memory that a process held.
"""

from __future__ import annotations

import argparse
import os
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import psutil

from nonsmooth import studies
from nonsmooth.studies.executors import Executor
from scenarios.dumbbell.scenario import DumbbellScenario
from tests.studies.ball import digest

CHUNK = 250
EXECUTORS: dict[str, Executor] = {
    "serial": studies.Serial(),
    "threads": studies.Threads(2),
    "processes": studies.Dask(n=2),
}
_KILLS = (("threads", "client", "KILL"), ("processes", "worker", "KILL"), ("processes", "client", "INT"))
_LAST = ("processes", "client", "KILL")


def study(runs: int) -> studies.Study:
    """Return the study."""
    draws = studies.random(runs, 1, beta0=(0.02, 0.4), phase=(0.0, 6.2))
    record = ["attractor", "t_end", "impacts", "events", "steps", "q_end", "u_end", "energy_residual"]
    return studies.Study(DumbbellScenario(mode="free", t_end=0.6), draws, record)


def _begun(path: Path, name: str, runs: int) -> subprocess.Popen[bytes]:
    words = [sys.executable, "-m", "tests.benchmarks.killed", str(runs), "--client", name, "--path", str(path)]
    return subprocess.Popen(words, stderr=subprocess.DEVNULL)


def _undisturbed(path: Path, name: str, runs: int) -> str:
    began, client, most = time.perf_counter(), _begun(path, name, runs), 0
    while client.poll() is None:
        most = max([most, *map(_held, _family(client))])
        time.sleep(0.5)
    seconds, found = time.perf_counter() - began, digest(studies.open_study(path))
    print(f"{name:<12}{found[:16]}  {runs} runs in {seconds:.0f} s, at most {most / 2**20:.0f} MB each", flush=True)
    return found


def _family(client: subprocess.Popen[bytes]) -> list[psutil.Process]:
    """Return a client and the processes that it has started."""
    try:
        one = psutil.Process(client.pid)
        return [one, *one.children(recursive=True)]
    except psutil.NoSuchProcess:
        return []


def _held(process: psutil.Process) -> int:
    """Return the memory of a process [bytes]."""
    try:
        return int(process.memory_info().rss)
    except psutil.NoSuchProcess:
        return 0


def _wait_for(path: Path, chunks: int, client: subprocess.Popen[bytes]) -> None:
    while len(list(path.glob("status/c/*"))) < chunks:
        if client.poll() is not None:
            raise RuntimeError("the client came to its end too early")
        time.sleep(0.02)


def _worker(client: subprocess.Popen[bytes]) -> psutil.Process:
    """Return a process of dask that runs something now."""
    busy = [one for one in psutil.Process(client.pid).children(recursive=True) if one.cpu_percent(0.2) > 10.0]
    return max(busy, key=lambda one: one.cpu_times().user)


def _killed(path: Path, runs: int) -> str:
    """Return the digest of a study that is killed at each fifth."""
    step = max(1, -(-runs // CHUNK) // 5)
    client, at = None, 0
    for name, whom, how in (*_KILLS, _LAST):
        at += step
        if client is None:
            client = _begun(path, name, runs)
        _wait_for(path, at, client)
        there = _family(client)[1:]
        victim = client.pid if whom == "client" else _worker(client).pid
        os.kill(victim, getattr(signal, f"SIG{how}"))
        print(f"  {how} to the {whom} ({name}) with {at} chunks stored", flush=True)
        if whom == "client":
            client.wait()
            client = None
            _, alive = psutil.wait_procs(there, timeout=60.0)
            if alive:
                raise RuntimeError(f"orphans: {alive}")
    return _undisturbed(path, "processes", runs)


def main(runs: int) -> bool:
    """Do all; tell whether all bits are the same."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        _undisturbed(folder / "small", "threads", runs // 10)
        found = {_undisturbed(folder / name, name, runs) for name in EXECUTORS}
        found.add(_killed(folder / "killed", runs))
    print("equal in every bit" if len(found) == 1 else "NOT equal")
    return len(found) == 1


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("runs", type=int, nargs="?", default=20_000)
    parser.add_argument("--client", choices=EXECUTORS)
    parser.add_argument("--path", type=Path)
    given = parser.parse_args()
    if given.client is None:
        sys.exit(not main(given.runs))
    study(given.runs).run(given.path, executor=EXECUTORS[given.client], chunk=CHUNK)
