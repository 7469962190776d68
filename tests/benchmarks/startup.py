"""Start of a first simulation and of the command: warm, and with an empty cache, when the engine is compiled.

    python -m tests.benchmarks.startup

prints the wall time [s] of each in new processes, and the processor time [s] of all of these processes, which depends
less on what else the machine does.
"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import tempfile
import time

REPETITIONS = 9
_FIRST = """
import nonsmooth as ns
from bodies import Dumbbell, Harmonic, Plate
from laws import Coulomb, EnergeticImpact, Unilateral

plate, body = Plate(motion=Harmonic(amplitude=3.58e-4, frequency=25.0)), Dumbbell(radius=4.76e-3, aspect_ratio=3.9)
system = ns.System([plate, body], gravity=9.81)
system.contact(body, plate, normal=Unilateral(), friction=Coulomb(0.2), impact=EnergeticImpact(restitution=0.65))
system.place(body, position=(0.0, 0.0, 0.02))
ns.simulate(system, t_end=0.1)
"""
_COMMAND = (sys.executable, "-m", "nonsmooth")
STARTS = {
    "first simulation in Python": (sys.executable, "-c", _FIRST),
    "nonsmooth run dumbbell": (*_COMMAND, "run", "dumbbell", "--set", "t_end=0.1", "--json"),
    "nonsmooth --help": (*_COMMAND, "--help"),
}
"""Commands by what they start."""


def once(command: tuple[str, ...], **environment: str) -> tuple[float, float]:
    """Wall time of one command [s] and processor time of its processes [s]."""
    began, before = time.perf_counter(), os.times()
    subprocess.run(command, env=os.environ | environment, check=True, capture_output=True)
    wall, after = time.perf_counter() - began, os.times()
    user, system = after.children_user - before.children_user, after.children_system - before.children_system
    return wall, user + system


def main() -> None:
    """Measure and print. The first command compiles the engine."""
    with tempfile.TemporaryDirectory() as empty:
        for name, command in STARTS.items():
            wall, processor = once(command, XDG_CACHE_HOME=empty)
            print(f"{name}, first time: {wall:.2f} s, processor {processor:.2f} s")
            warm = [once(command, XDG_CACHE_HOME=empty) for _ in range(REPETITIONS)]
            for kind, times in zip(("wall", "processor"), zip(*warm, strict=True), strict=True):
                least, median = min(times), statistics.median(times)
                print(f"{name}, {REPETITIONS} times, {kind}: least {least:.2f} s, median {median:.2f} s")


if __name__ == "__main__":
    main()
