"""What a law of a plug-in costs: against the same law built in, to prepare, and in compilations.

    python -m tests.benchmarks.plugin

prints the processor time [ms] per simulated second of the drift mode with Coulomb's law built in and with a copy of it
in a single file, interleaved in one process; the wall time [s] until a law that was never seen is ready, first in a
new process and later in the same; and which functions numba compiled for them.
"""

from __future__ import annotations

import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from numba.core import event

from nonsmooth import System, simulate, with_laws
from nonsmooth.binding.compile import bind
from nonsmooth.engine.native.kernel import entry_addresses
from nonsmooth.interfaces import FrictionLaw
from nonsmooth.plugins.file import load
from scenarios.dumbbell.scenario import DumbbellScenario

T_END = 20.0
REPETITIONS = 25
NEW_LAWS = 9

_COPY = """
from dataclasses import dataclass
from nonsmooth.interfaces import FrictionLaw
from nonsmooth.parameters import parameter

def _coefficient(speed, friction, static_friction):
    return friction if speed > 0.0 else static_friction

@dataclass(frozen=True)
class Copy(FrictionLaw):
    friction: float = parameter(0.2, doc="kinetic coefficient")
    static_friction: float = parameter(0.2, doc="static coefficient")

    @property
    def coefficient(self):
        return _coefficient

    def is_fulfilled(self, slip, normal_force, tangential_force, tolerance):
        return True
"""
_NEW = """
import math
from dataclasses import dataclass
from nonsmooth.interfaces import FrictionLaw
from nonsmooth.parameters import parameter

def _coefficient(speed, static, kinetic, fall_speed):
    return kinetic + (static - kinetic) * math.exp(-{number} * speed / fall_speed)

@dataclass(frozen=True)
class Law(FrictionLaw):
    static: float = parameter(0.3, doc="coefficient at rest")
    kinetic: float = parameter(0.2, doc="coefficient of fast slip")
    fall_speed: float = parameter(0.01, doc="speed scale of the fall", unit="m/s")

    @property
    def coefficient(self):
        return _coefficient

    def is_fulfilled(self, slip, normal_force, tangential_force, tolerance):
        return True
"""


def law_of(text: str, name: str, folder: Path) -> FrictionLaw:
    """Return an object of a class whose file has that text."""
    path = folder / f"law_{abs(hash(text))}.py"
    path.write_text(text, encoding="utf-8")
    law: FrictionLaw = load("benchmark", (FrictionLaw,), f"{path}:{name}")()
    return law


def preparation(folder: Path) -> tuple[list[float], list[str]]:
    """Return how long some new laws take from file to address [s], and the names of what numba compiled for them."""
    entry_addresses()
    seconds = []
    with event.install_recorder("numba:run_pass") as recorder:
        for _ in range(NEW_LAWS):
            text = _NEW.format(number=1.0 + time.time_ns() % 10**9 * 1e-9)  # so that no cache has it
            began = time.perf_counter()
            law = law_of(text, "Law", folder)
            bind(law.coefficient, "scalar", law.parameters(), "Law")
            seconds.append(time.perf_counter() - began)
    lowered = [e.data for _, e in recorder.buffer if e.is_start and "native_lowering" in str(e.data.get("name"))]
    return seconds, [str(data["qualname"]) for data in lowered]


def ratio(folder: Path) -> dict[str, list[float]]:
    """Return processor times [ms per simulated second], interleaved, and check that the motions are the same."""
    system = DumbbellScenario(mode="drift", t_end=T_END).build()
    systems = {"built in": system, "plug-in": with_laws(system, friction=law_of(_COPY, "Copy", folder))}

    def task(one: System) -> Callable[[], list[float]]:
        return lambda: simulate(one, T_END, sample_interval=T_END).q_end.tolist()

    times: dict[str, list[float]] = {name: [] for name in systems}
    for repetition in range(REPETITIONS + 1):
        ends = []
        for name, one in systems.items():
            run = task(one)
            began = time.process_time()
            ends.append(run())
            if repetition > 0:
                times[name].append(1e3 * (time.process_time() - began) / T_END)
        assert ends[0] == ends[1], "the copy moves the dumbbell in another way"
    return times


def main() -> None:
    """Measure and print."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        if sys.argv[1:] == ["first"]:
            seconds, lowered = preparation(folder)
            print(" ".join(f"{s:.3f}" for s in seconds), "|", " ".join(lowered))
            return
        times = ratio(folder)
        for which, values in times.items():
            print(f"{which:9} least {min(values):.3f}, median {statistics.median(values):.3f} ms per simulated second")
        pairs = [b / a for a, b in zip(*times.values(), strict=True)]
        least = min(times["plug-in"]) / min(times["built in"])
        print(f"plug-in over built in: least {least:.3f}, median of the pairs {statistics.median(pairs):.3f}")
    words = [sys.executable, "-m", "tests.benchmarks.plugin", "first"]
    for _ in range(3):
        done = subprocess.run(words, check=True, capture_output=True, text=True).stdout
        seconds_, _, lowered_ = done.partition("|")
        numbers = [float(s) for s in seconds_.split()]
        compiled = lowered_.split()
        others = [one for one in compiled if one not in ("_coefficient", "shim")]
        print(
            f"a new law is ready in {numbers[0]:.3f} s as the first of a process, later in "
            f"{statistics.median(numbers[1:]):.3f} s; {len(compiled) / NEW_LAWS:g} functions compiled per law "
            f"({', '.join(sorted(set(compiled)))}), {len(others)} of the engine"
        )


if __name__ == "__main__":
    main()
