"""Runs stopped at random times that go on: ``python -m tests.benchmarks.continued_runs [TIMES] [SCENARIO ...]``.

Each scenario runs once through, then is stopped at so many random times (20 by default), every other time by way of a
file, and goes on.  Printed are the number of events, how many of the runs that went on differ in any bit of an event,
of the end or of the account of energy, the largest difference of a time [s], and the size of a state [kB].
"""

from __future__ import annotations

import pickle
import random
import sys

import numpy as np

import nonsmooth as ns
from nonsmooth.plugins import registry
from tests.runs.continued import lost_by_stopping

SCENARIOS = {"dumbbell": 4.0, "dice_throw": 0.3, "rolling_disc": 0.6, "woodpecker": 1.0, "ball_box": 0.3}
"""End times [s]."""


def look(name: str, times: int) -> str:
    """Return a line of the table."""
    scenario, draw = registry.load("scenarios", name)(), random.Random(20)
    t_end, interval = SCENARIOS.get(name, scenario.t_end), scenario.sample_interval
    model = ns.assemble(scenario.build())
    whole = model.run(t_end, sample_interval=interval)
    differ, late, size = 0, 0.0, 0
    for i in range(times):
        before = model.run(draw.uniform(0.0, t_end), sample_interval=interval)
        written = pickle.dumps(before.state)
        size = max(size, len(written))
        state = pickle.loads(written) if i % 2 else before.state
        after = model.run(t_end, start=state, sample_interval=interval)
        differ += bool(lost_by_stopping(whole, before, after))
        found = np.concatenate([before.events.time, after.events.time[1:]])
        same = len(found) == len(whole.events)
        late = max(late, float(np.max(np.abs(found - whole.events.time))) if same else np.inf)
    return f"{name:16s}{len(whole.events):8d}{times:8d}{differ:8d}{late:12.1e}{size / 1e3:10.1f}"


def main() -> None:
    """Print the table."""
    times = int(sys.argv[1]) if len(sys.argv) > 1 else 20
    print(f"{'scenario':16s}{'events':>8}{'stops':>8}{'differ':>8}{'time':>12}{'state':>10}")
    for name in sys.argv[2:] or SCENARIOS:
        print(look(name, times), flush=True)


if __name__ == "__main__":
    main()
