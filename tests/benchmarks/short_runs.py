"""Many short runs of one model: ``python -m tests.benchmarks.short_runs [RUNS]``.

The dumbbell runs for eight periods of its plate, again and again: from its own start, from other velocities, and on
from where it was; then by `simulate`.  Printed are, per run, the time [ms], that of it which the engine takes, and
their ratio, of the quickest of batches of 20 runs, as what else the machine does counts least there; last how many
times as many runs two threads make in the same time as one, each with a copy of the model, of 400 runs each, and how
many times as many two processes make, which share no interpreter: what the machine gives.
"""

from __future__ import annotations

import dataclasses
import functools
import multiprocessing
import sys
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from multiprocessing.connection import Connection
from typing import Any

import nonsmooth as ns
import nonsmooth.model.laid_out
import nonsmooth.watch
from nonsmooth.plugins import registry

PERIODS = 8.0
BATCH = 20
THREADED = 400
REPETITIONS = 10


def timed(runs: int, way: Callable[[int], object]) -> tuple[float, float]:
    """Return the time of a run and the engine's part of it [ms], each the least of all batches."""
    inside, callers = [0.0], (vars(nonsmooth.watch), vars(nonsmooth.model.laid_out))
    engine = callers[0]["call_entry"]

    def clocked(*arguments: Any) -> Any:
        began = time.perf_counter()
        result = engine(*arguments)
        inside[0] += time.perf_counter() - began
        return result

    least = [float("inf"), float("inf")]
    for calls in callers:
        calls["call_entry"] = clocked
    try:
        for batch in range(max(1, runs // BATCH)):
            inside[0] = 0.0
            began = time.perf_counter()
            for i in range(BATCH):
                way(BATCH * batch + i)
            took = time.perf_counter() - began
            if took < least[0]:
                least = [took, inside[0]]
    finally:
        for calls in callers:
            calls["call_entry"] = engine
    return 1e3 * least[0] / BATCH, 1e3 * least[1] / BATCH


def _worker(pipe: Connection, t_end: float, interval: float) -> None:
    """Assemble the dumbbell; make the runs whenever told to, and tell when they are made."""
    model = ns.assemble(registry.load("scenarios", "dumbbell")().build())
    while pipe.recv():
        _runs(model, t_end, interval)
        pipe.send(True)


def _runs(model: ns.Model, t_end: float, interval: float) -> None:
    for _ in range(THREADED):
        model.run(t_end, sample_interval=interval)


def at_once(model: ns.Model, t_end: float, interval: float) -> tuple[float, float]:
    """Return how many times as many runs two threads and two processes make as one thread, least times of all."""
    spawning = multiprocessing.get_context("spawn")
    pipes, processes = [], []
    for _ in range(2):
        ours, theirs = spawning.Pipe()
        pipes.append(ours)
        processes.append(spawning.Process(target=_worker, args=(theirs, t_end, interval)))
        processes[-1].start()

    def in_threads(models: list[ns.Model]) -> None:
        with ThreadPoolExecutor(len(models)) as pool:
            list(pool.map(lambda one: _runs(one, t_end, interval), models))

    def in_processes() -> None:
        for pipe in pipes:
            pipe.send(True)
        for pipe in pipes:
            pipe.recv()

    models = [model.copy(), model.copy()]
    ways: tuple[Callable[[], object], ...] = (
        lambda: in_threads(models[:1]),
        lambda: in_threads(models),
        in_processes,
    )
    least = [float("inf")] * len(ways)
    for _ in range(REPETITIONS):
        for i, way in enumerate(ways):
            began = time.perf_counter()
            way()
            least[i] = min(least[i], time.perf_counter() - began)
    for pipe, process in zip(pipes, processes, strict=True):
        pipe.send(False)
        process.join()
    return 2.0 * least[0] / least[1], 2.0 * least[0] / least[2]


def main() -> None:
    """Print the table."""
    runs = int(sys.argv[1]) if len(sys.argv) > 1 else 2000
    scenario = registry.load("scenarios", "dumbbell")()
    system, t_end = scenario.build(), PERIODS / scenario.frequency
    model = ns.assemble(system)
    run = functools.partial(model.run, sample_interval=scenario.sample_interval)
    begin = ns.State.at(system)
    state = [run(t_end).state]

    def other(i: int) -> None:
        u = begin.u.copy()
        u[0] += 1e-4 * i
        run(t_end, start=dataclasses.replace(begin, u=u))

    def on(i: int) -> None:
        state[0] = run(state[0].time + t_end, start=state[0]).state

    ways: dict[str, Callable[[int], object]] = {
        "its own start": lambda i: run(t_end),
        "another start": other,
        "on from a state": on,
        "simulate": lambda i: ns.simulate(system, t_end, sample_interval=scenario.sample_interval),
    }
    print(f"{'ms per run':18s}{'all':>9}{'engine':>9}{'ratio':>9}")
    for name, way in ways.items():
        whole, engine = timed(runs, way)
        print(f"{name:18s}{whole:9.3f}{engine:9.3f}{whole / engine:9.3f}", flush=True)
    by_threads, by_processes = at_once(model, t_end, scenario.sample_interval)
    print(f"two threads make {by_threads:.2f} times the runs of one, two processes {by_processes:.2f}")


if __name__ == "__main__":
    main()
