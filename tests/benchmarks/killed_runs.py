"""Runs that are killed and go on: ``python -m tests.benchmarks.killed_runs [KILLS] [SCENARIO] [T_END]``.

A scenario runs once undisturbed.  Then it runs once more in a process that is killed (SIGKILL) at a random moment, and
again in every process that goes on with it, at so many moments (10 by default) of the time that the first run took.
For every kill are printed how long the process had run [s], the time that the file has reached [s], its events, and
how much of the run's wall time was lost [s]; then whether the end differs from that of the undisturbed run in any bit.
"""

from __future__ import annotations

import random
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

import numpy as np
import xarray

import nonsmooth as ns
from nonsmooth.interfaces import Scenario
from nonsmooth.plugins import registry
from tests.runs.continued import differences

_CHILD = "--child"


def _scenario(name: str) -> Scenario:
    made: Scenario = registry.load("scenarios", name)()
    return made


def _child(folder: str, name: str, t_end: float) -> None:
    """Run the scenario, or go on with it; print the time reached whenever it is told."""

    def report(t: float, end: float) -> None:
        print(repr(t), flush=True)

    scenario = _scenario(name)
    if Path(folder, "solution.zarr", ".zmetadata").exists():
        ns.resume(folder, system=scenario.build(), progress=report)
    else:
        ns.simulate(scenario.build(), t_end, progress=report, output=folder)


def _killed(words: list[str], after: float) -> list[tuple[float, float]]:
    """Kill a process so many seconds after it first tells where it is; return when it told what, the kill last."""
    process = subprocess.Popen([sys.executable, "-m", "tests.benchmarks.killed_runs", *words], stdout=subprocess.PIPE)
    told: list[tuple[float, float]] = []
    stdout = process.stdout
    assert stdout is not None

    def read() -> None:
        for line in stdout:
            told.append((time.perf_counter(), float(line)))

    reader = threading.Thread(target=read)
    reader.start()
    while not told and process.poll() is None:
        time.sleep(1e-3)
    time.sleep(after)
    process.kill()
    told.append((time.perf_counter(), np.inf))
    process.wait()
    reader.join()
    return sorted(told)


def look(kills: int, name: str, t_end: float, folder: str) -> None:
    """Print the table."""
    scenario, draw = _scenario(name), random.Random(17)
    began = time.perf_counter()
    whole = ns.simulate(scenario.build(), t_end)
    wall = time.perf_counter() - began
    print(f"undisturbed: {whole!r} in {wall:.1f} s")
    print(f"{'killed after':>14}{'time reached':>14}{'events':>10}{'lost':>8}")
    moments = sorted(draw.uniform(0.0, wall) for _ in range(kills))
    for after in np.diff(moments, prepend=0.0).tolist():
        told = _killed([_CHILD, folder, name, repr(t_end)], after)
        with xarray.open_zarr(Path(folder, "solution.zarr")) as saved:
            reached, status, events = saved.attrs["t_end"], saved.attrs["status"], saved.sizes["event"]
            np.testing.assert_array_equal(saved["event_time"], whole.events.time[:events])
        times, places = np.array(told).T
        # when it was there: between two times that it told of, or before the first
        behind = times[places <= reached].max(initial=times[0])
        print(
            f"{after:14.2f}{reached:14.6g}{events:10d}{times[places == np.inf][0] - behind:8.2f}  {status}", flush=True
        )
        if status != "unfinished":
            break
    end = ns.resume(folder, system=scenario.build()) if status == "unfinished" else ns.open_solution(folder)
    print(
        "differs in",
        differences(whole, end) or "nothing",
        "; counters equal:",
        whole.counters.steps == end.counters.steps,
    )


def main() -> None:
    """Print the table, or be one of the processes."""
    words = sys.argv[1:]
    if words[:1] == [_CHILD]:
        _child(words[1], words[2], float(words[3]))
        return
    kills = int(words[0]) if words else 10
    name = words[1] if len(words) > 1 else "ball_box"
    t_end = float(words[2]) if len(words) > 2 else _scenario(name).t_end
    with tempfile.TemporaryDirectory() as folder:
        look(kills, name, t_end, folder)


if __name__ == "__main__":
    main()
