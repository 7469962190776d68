"""Time and memory per event over a long, event-rich run: neither may grow.

    python -m tests.benchmarks.endurance [SECONDS]

runs the drift mode for so many simulated seconds (600 by default; an hour makes about a million events) with one
sample per second, and prints for every third of the run the wall and CPU time and the growth of the process per event.
An event is a row of so many bytes, which are kept; anything beyond would be a leak.  Linux only: it reads /proc.
"""

from __future__ import annotations

import itertools
import os
import resource
import sys
import time
from pathlib import Path

import numpy as np

from nonsmooth import simulate
from nonsmooth.engine.memory.event_rows import CODE_HEAD, EVENT_HEAD, LISTED
from nonsmooth.engine.memory.layout import BOOKED
from scenarios.dumbbell import DumbbellScenario


def resident() -> int:
    """Return the resident memory of this process [bytes]."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE")


def main() -> None:
    """Run and print."""
    t_end = float(sys.argv[1]) if len(sys.argv) > 1 else 600.0
    scenario = DumbbellScenario(mode="drift", t_end=t_end)
    simulate(DumbbellScenario(mode="drift", t_end=1.0).build(), 1.0)  # what is loaded once belongs to no third
    marks = [(0.0, time.perf_counter(), time.process_time(), resident())]

    def note(t: float, _: float) -> None:
        marks.append((t, time.perf_counter(), time.process_time(), resident()))

    solution = simulate(scenario.build(), t_end, sample_interval=1.0, progress=note)
    t, wall, busy, memory = np.array(marks).T
    events = solution.events
    numbers = EVENT_HEAD + events.q.shape[1] + 2 * events.u_before.shape[1] + events.integrated.shape[1] + BOOKED
    row = 8 * (numbers + LISTED * events.n_contacts + CODE_HEAD + 2 * events.n_contacts)
    residual = solution.energy.residual
    print(f"drift mode, {t_end:g} s: {len(events)} events, a row of {row} bytes each; energy residual {residual:.1e}")
    edges = np.linspace(0.0, t_end, 4)
    for start, end in itertools.pairwise(edges):
        count = np.count_nonzero((events.time > start) & (events.time <= end))
        spent, used, grown = (np.diff(np.interp((start, end), t, what))[0] for what in (wall, busy, memory))
        print(
            f"{start:7.0f} to {end:5.0f} s: {count:7d} events, {1e6 * spent / count:6.2f} us, "
            f"{1e6 * used / count:6.2f} us of CPU and {grown / count:6.1f} bytes per event"
        )
    peak = 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    print(f"peak of the process, with the solution put together at the end: {peak / 2**20:.0f} MiB")


if __name__ == "__main__":
    main()
