"""Many short runs of one model: ``python -m tests.benchmarks.short_runs [RUNS]``.

The dumbbell runs for eight periods of its plate, again and again: from its own start, from other velocities, and on
from where it was; then by `simulate`.  Printed are, per run, the time [ms], that of it which the engine takes, and
their ratio, of the quickest of batches of 20 runs, as what else the machine does counts least there; last how many
times as many runs two threads make in the same time as one, each with a copy of the model, of 400 runs each.
"""

from __future__ import annotations

import dataclasses
import functools
import sys
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import nonsmooth as ns
import nonsmooth.model.laid_out
import nonsmooth.watch
from nonsmooth.plugins import registry

PERIODS = 8.0
BATCH = 20
THREADED = 400
REPETITIONS = 5


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


def threads(model: ns.Model, t_end: float, interval: float) -> float:
    """Return how many times as many runs two threads make as one, least times of both."""

    def runs(one: ns.Model) -> None:
        for _ in range(THREADED):
            one.run(t_end, sample_interval=interval)

    def seconds(models: list[ns.Model]) -> float:
        with ThreadPoolExecutor(len(models)) as pool:
            began = time.perf_counter()
            list(pool.map(runs, models))
            return time.perf_counter() - began

    models = [model.copy(), model.copy()]
    alone, both = (min(seconds(models[:n]) for _ in range(REPETITIONS)) for n in (1, 2))
    return 2.0 * alone / both


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
    print(f"two threads make {threads(model, t_end, scenario.sample_interval):.2f} times the runs of one")


if __name__ == "__main__":
    main()
