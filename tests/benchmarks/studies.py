"""Studies: runs per second of each executor beside a plain loop over the engine.

    pip install '.[studies]' && python -m tests.benchmarks.studies

Printed are, for starts of the dumbbell and of the bouncing ball, the runs per second of wall time and per second of
processor time, all processes counted: of a loop that builds, runs and summarises one run after the other and keeps
nothing, and of studies of the same runs in a store, in chunks of 50.  The processes of dask have run a few before.
All studies give the same bits, which is checked.  The share of the engine in the loop's time is what threads can do
at once: the rest holds the lock of Python.
"""

from __future__ import annotations

import dataclasses
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import psutil
from distributed import LocalCluster

from nonsmooth import simulate, studies
from nonsmooth.interfaces import Scenario
from scenarios.bouncing_ball import BouncingBall
from scenarios.dumbbell import DumbbellScenario

RUNS, CHUNK = 400, 50
Ranges = dict[str, tuple[float, float]]
CASES: tuple[tuple[Scenario, Ranges, str], ...] = (
    (DumbbellScenario(mode="free", t_end=2.0), {"beta0": (0.02, 0.4), "phase": (0.0, 6.2)}, "attractor"),
    (BouncingBall(t_end=1.0), {"gamma": (0.5, 2.0), "restitution": (0.5, 0.9)}, "last_flight"),
)


def _processor() -> float:
    """Return the processor time of this process and of those that it started [s]."""
    here = psutil.Process()
    times = [one.cpu_times() for one in (here, *here.children(recursive=True))]
    return float(sum(one.user + one.system for one in times))


def _loop(scenario: Scenario, sampling: studies.Sampling) -> float:
    """Run all; return the wall time of the engine [s]."""
    engine = 0.0
    for run in range(len(sampling)):
        one = dataclasses.replace(scenario, **sampling.at(run))  # type: ignore[type-var]
        solution = simulate(one.build(), one.t_end, sample_interval=one.sample_interval)
        one.summarise(solution)
        engine += solution.counters.wall_seconds
    return engine


def _row(name: str, task: Callable[[], object]) -> None:
    wall, processor = time.perf_counter(), _processor()
    task()
    wall, processor = time.perf_counter() - wall, _processor() - processor
    print(f"{name:<40}{RUNS / wall:>12.1f}{RUNS / processor:>16.1f}", flush=True)


def compare(scenario: Scenario, ranges: Ranges, record: str, folder: Path, address: str) -> None:
    """Print the rows of one scenario."""
    few, sampling = (studies.random(n, 1, **ranges) for n in (8, RUNS))
    name = type(scenario).__name__
    warm = studies.Study(scenario, few, [record])
    warm.run(folder / "warm.zarr", executor=studies.Dask(address), chunk=1)
    began = time.perf_counter()
    engine = _loop(scenario, few)
    print(f"{name}: {engine / (time.perf_counter() - began):.0%} of a loop's time is the engine's", flush=True)
    _row("  plain loop", lambda: _loop(scenario, sampling))
    study = studies.Study(scenario, sampling, [record, "t_end", "impacts", "u_end"])
    ends = set()
    executors = {
        "study, one after another": studies.Serial(),
        "study, 1 thread": studies.Threads(1),
        "study, 2 threads": studies.Threads(2),
        "study, 2 processes of dask": studies.Dask(address),
    }
    for label, executor in executors.items():
        path = folder / f"{label}.zarr"
        _row(f"  {label}", lambda by=executor, to=path: study.run(to, executor=by, chunk=CHUNK))  # type: ignore[misc]
        ends.add(studies.open_study(path).u_end.values.tobytes())
    print(f"  same bits: {len(ends) == 1}", flush=True)


def main() -> None:
    """Print the table."""
    print(f"{'':<40}{'runs per s':>12}{'per CPU second':>16}", flush=True)
    for case in CASES:
        with (
            tempfile.TemporaryDirectory() as folder,
            LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0", silence_logs=50) as cluster,
        ):
            compare(*case, Path(folder), cluster.scheduler_address)


if __name__ == "__main__":
    main()
