"""Many bodies: what one impact through a chain costs, and balls in a box against MuJoCo and PyBullet.

    pip install '.[full]' mujoco pybullet && python -m tests.benchmarks.many

Printed are, for chains of 10 to 1000 balls, the wall time of a run that ends just before the strike and that of the
impact (of a run that ends just after it, less the other), each per ball and with its slope in log-log; then, for 10 and
100 balls in a box, milliseconds of wall time per simulated second of interleaved repetitions, without setting up, the
ratio of the medians to this engine's, and the deepest overlap relative to the radius.
"""

from __future__ import annotations

import math
import statistics
import time
from collections.abc import Callable

from nonsmooth import simulate
from scenarios.ball_box import BallBox
from scenarios.newtons_cradle import NewtonsCradle
from tests.benchmarks.spheres import MuJoCoBox, PyBulletBox, own_depth

CHAINS = (10, 30, 100, 300, 1000)
BOXES = ((10, 0.15, 2.0), (100, 0.3, 0.2))
"""Number of balls, width of the box [m], end time [s]; the longer a box with many balls runs, the more of them lie."""
MUJOCO_STEPS, PYBULLET_STEP = (1e-4, 1e-3), 1e-3
REPETITIONS = 3


def chains() -> None:
    """Print what a row of balls costs before it is struck, and one impact through it."""
    columns = ("before ms", "per ball", "slope", "impact ms", "per ball", "slope")
    print(f"{'balls':>8}{'impact steps':>14}" + "".join(f"{name:>11}" for name in columns) + f"{'energy':>10}")
    last: tuple[float, ...] = ()
    for n in CHAINS:
        scenario = NewtonsCradle(n_balls=n)
        strike = scenario.distance / scenario.speed
        runs, seconds = [], []
        for t_end in (strike * (1.0 - 1e-6), strike * (1.0 + 1e-6)):
            runs = [simulate(scenario.build(), t_end, sample_interval=1.0) for _ in range(REPETITIONS)]
            seconds.append(min(run.counters.wall_seconds for run in runs))
        costs = seconds[0], seconds[1] - seconds[0]
        line = f"{n:8d}{runs[0].counters.impact_steps:14d}"
        for i, cost in enumerate(costs):
            slope = math.log(cost / last[i + 1]) / math.log(n / last[0]) if last else math.nan
            line += f"{1e3 * cost:11.3f}{1e3 * cost / n:11.4f}{slope:11.2f}"
        last = float(n), *costs
        print(line + f"{runs[0].energy.residual:10.1e}", flush=True)


def _timed(task: Callable[[], object]) -> float:
    began = time.perf_counter()
    task()
    return time.perf_counter() - began


def boxes() -> None:
    """Print balls in a box beside the other engines."""
    for n, width, t_end in BOXES:
        scenario = BallBox(n_balls=n, box_width=width, t_end=t_end)
        began = time.perf_counter()
        system = scenario.build()
        built = time.perf_counter() - began
        began = time.perf_counter()
        solution = simulate(system, t_end, sample_interval=scenario.sample_interval)
        assembled = time.perf_counter() - began - solution.counters.wall_seconds
        others: dict[str, MuJoCoBox | PyBulletBox] = {
            **{f"MuJoCo {step:.0e} s": MuJoCoBox(scenario, step) for step in MUJOCO_STEPS},
            "PyBullet 1e-3 s": PyBulletBox(scenario, PYBULLET_STEP),
        }
        depths = [own_depth(scenario, solution), *(other.deepest(t_end) for other in others.values())]
        times: dict[str, list[float]] = {"nonsmooth": [], **{name: [] for name in others}}
        for _ in range(REPETITIONS):
            run = simulate(system, t_end, sample_interval=t_end)
            times["nonsmooth"].append(run.counters.wall_seconds)
            for name, other in others.items():
                other.reset()
                times[name].append(_timed(lambda: other.run(t_end)))  # noqa: B023
        count = solution.counters
        print(
            f"\n{n} balls, {width:g} m, {t_end:g} s: {len(solution.events)} events, {count.impacts} impacts, "
            f"{count.steps} steps, {len(system.contacts)} declared contacts, "
            f"{scenario.closed_contacts(solution)[-1]} closed at the end; "
            f"declared in {built:.2f} s, assembled in {assembled:.2f} s, which is not in the times below"
        )
        print(f"{'':20}{'ms per s: least':>16}{'median':>10}{'ratio':>9}{'overlap/radius':>16}")
        base = statistics.median(times["nonsmooth"])
        for (name, seconds), deep in zip(times.items(), depths, strict=True):
            least, median = 1e3 * min(seconds) / t_end, statistics.median(seconds)
            print(
                f"{name:20}{least:16.1f}{1e3 * median / t_end:10.1f}{median / base:9.3f}{deep / scenario.radius:16.1e}"
            )


def main() -> None:
    """Measure and print."""
    chains()
    boxes()


if __name__ == "__main__":
    main()
