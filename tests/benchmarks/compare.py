"""Speed on the drift mode against MuJoCo and PyBullet, all measured in one run.

    pip install '.[full]' mujoco pybullet && python -m tests.benchmarks.compare

Nothing else is needed.  Printed are milliseconds of wall time per simulated second (least and median of interleaved
repetitions), the ratio of the medians to this engine's, the deepest penetration relative to the amplitude of the
plate, and the drift velocity, which says whether the engine follows the same motion at all.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable

import numpy as np

from nonsmooth import simulate
from scenarios.dumbbell import DumbbellScenario
from tests.benchmarks.engines import Motion, MuJoCo, PyBullet, damping_ratio

T_END = 10.0
REPETITIONS = 9
MUJOCO_STEP, PYBULLET_STEP = 1e-4, 1e-3
MUJOCO_LONG_STEP = 1e-3
"""MuJoCo at the step of PyBullet: a tenth of the time, and less accurate."""


def own(scenario: DumbbellScenario) -> Motion:
    """Return the motion at 1000 samples per second."""
    solution = simulate(scenario.build(), scenario.t_end, sample_interval=1e-3)
    motion = scenario.motion(solution)
    centre = np.column_stack([motion.centre, np.zeros(len(motion.t))])
    return Motion(motion.t, centre, motion.gap.min(axis=1))


def rounds(tasks: dict[str, Callable[[], object]]) -> dict[str, list[float]]:
    """Return the wall times [s] of all tasks over interleaved repetitions, the first one left out."""
    times: dict[str, list[float]] = {name: [] for name in tasks}
    for repetition in range(REPETITIONS + 1):
        for name, task in tasks.items():
            began = time.perf_counter()
            task()
            if repetition > 0:
                times[name].append(time.perf_counter() - began)
    return times


def main() -> None:
    """Measure and print."""
    scenario = DumbbellScenario(mode="drift", t_end=T_END)
    soft = MuJoCo(scenario, MUJOCO_STEP, 0.02, 1.0)
    bouncing = MuJoCo(scenario, MUJOCO_STEP, 10.0 * MUJOCO_STEP, damping_ratio(scenario))
    bouncing_long = MuJoCo(scenario, MUJOCO_LONG_STEP, 10.0 * MUJOCO_LONG_STEP, damping_ratio(scenario))
    bullet = PyBullet(scenario, PYBULLET_STEP)

    def reset_and_run(engine: MuJoCo | PyBullet) -> Callable[[], None]:
        def task() -> None:
            engine.reset()
            engine.run(T_END)

        return task

    system = scenario.build()
    tasks: dict[str, Callable[[], object]] = {
        "nonsmooth, default tolerances": lambda: simulate(system, T_END, sample_interval=T_END),
        "MuJoCo 1e-4 s, bouncing contact": reset_and_run(bouncing),
        "MuJoCo 1e-4 s, default contact": reset_and_run(soft),
        "MuJoCo 1e-3 s, bouncing contact": reset_and_run(bouncing_long),
        "PyBullet 1e-3 s": reset_and_run(bullet),
    }
    times = rounds(tasks)
    others = (engine.watch(T_END) for engine in (bouncing, soft, bouncing_long, bullet))
    motions = dict(zip(tasks, (own(scenario), *others), strict=True))
    base = statistics.median(next(iter(times.values())))
    print(f"drift mode, {T_END:g} s, {REPETITIONS} interleaved repetitions")
    print(f"{'':33}{'ms per s: least':>16}{'median':>9}{'ratio':>8}{'penetration/A':>15}{'drift mm/s':>12}")
    for name, seconds in times.items():
        least, median = (1e3 * f(seconds) / T_END for f in (min, statistics.median))
        motion = motions[name]
        late = motion.t >= T_END / 2.0
        drift = np.polyfit(motion.t[late], motion.centre[late, 1], 1)[0]
        depth = max(0.0, -motion.gap.min()) / scenario.amplitude
        ratio = median * T_END / (1e3 * base)
        print(f"{name:33}{least:16.2f}{median:9.2f}{ratio:8.1f}{depth:15.2g}{1e3 * drift:12.2f}")


if __name__ == "__main__":
    main()
