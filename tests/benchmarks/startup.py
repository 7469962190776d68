"""Start of the command: warm, and with an empty cache, when the engine is compiled.

    python -m tests.benchmarks.startup

prints the wall time [s] of ``nonsmooth run dumbbell --set t_end=0.1 --json`` in new processes.
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


def once(**environment: str) -> float:
    """Return the wall time of one process [s]."""
    began = time.perf_counter()
    subprocess.run(_COMMAND, env=os.environ | environment, check=True, capture_output=True)
    return time.perf_counter() - began


def main() -> None:
    """Measure and print."""
    with tempfile.TemporaryDirectory() as empty:
        print(f"empty cache: {once(XDG_CACHE_HOME=empty):.1f} s")
        warm = [once(XDG_CACHE_HOME=empty) for _ in range(REPETITIONS)]
    print(f"warm, {REPETITIONS} times: least {min(warm):.2f} s, median {statistics.median(warm):.2f} s")


if __name__ == "__main__":
    main()
