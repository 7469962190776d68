"""Start of the command: warm, and with an empty cache, when the engine is compiled.

    python -m tests.benchmarks.startup

prints the wall time [s] of ``nonsmooth run dumbbell --set t_end=0.1 --json`` in new processes, and the processor
time [s] of all of them, which depends less on what else the machine does.
"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import tempfile
import time

REPETITIONS = 9
_COMMAND = (sys.executable, "-m", "nonsmooth", "run", "dumbbell", "--set", "t_end=0.1", "--json")


def once(**environment: str) -> tuple[float, float]:
    """Return the wall time of one run [s] and the processor time of its processes [s]."""
    began, before = time.perf_counter(), os.times()
    subprocess.run(_COMMAND, env=os.environ | environment, check=True, capture_output=True)
    wall, after = time.perf_counter() - began, os.times()
    user, system = after.children_user - before.children_user, after.children_system - before.children_system
    return wall, user + system


def main() -> None:
    """Measure and print."""
    with tempfile.TemporaryDirectory() as empty:
        wall, processor = once(XDG_CACHE_HOME=empty)
        print(f"empty cache: {wall:.1f} s, processor {processor:.1f} s")
        warm = [once(XDG_CACHE_HOME=empty) for _ in range(REPETITIONS)]
    for name, times in zip(("wall", "processor"), zip(*warm, strict=True), strict=True):
        print(f"warm, {REPETITIONS} times, {name}: least {min(times):.2f} s, median {statistics.median(times):.2f} s")


if __name__ == "__main__":
    main()
