"""Height and angles of the woodpecker over time, and its limit cycles in the phase plane of the bird."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from nonsmooth.solution.solution import Solution
from scenarios.woodpecker.scenario import Woodpecker

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_SHOWN = 3
"""Cycles that are drawn."""


def _last_cycles(scenario: Woodpecker, solution: Solution) -> np.ndarray:
    """Return which samples lie in the last cycles; all of them in a shorter run."""
    times, _ = scenario.pecks(solution)
    start = times[-_SHOWN - 1] if len(times) > _SHOWN else 0.0
    stop = times[-1] if len(times) > _SHOWN else solution.t_end
    return np.asarray((solution.t >= start) & (solution.t <= stop))


def cycles(scenario: Woodpecker, solution: Solution) -> Figure:
    """Draw the height, and below the angles of sleeve and bird, over the last cycles; lines mark the pecks."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.2, 5.4), layout="constrained")
    height, angle = figure.subplots(2, sharex=True)
    shown = _last_cycles(scenario, solution)
    t, q = 1e3 * (solution.t[shown] - solution.t[shown][0]), solution.q[shown]
    height.plot(t, 1e3 * (q[:, 0] - q[0, 0]), color="black", linewidth=1.4)
    height.set_ylabel("height of the sleeve [mm]")
    angle.plot(t, q[:, 2], color="tab:red", linewidth=1.4, label="bird")
    angle.plot(t, q[:, 1], color="black", linewidth=1.4, linestyle="--", label="sleeve")
    angle.set_ylabel("angle [rad]")
    angle.set_xlabel("time [ms]")
    figure.legend(fontsize=8, frameon=False, loc="outside lower center", ncols=2)
    for axis in (height, angle):
        for peck in 1e3 * (scenario.pecks(solution)[0] - solution.t[shown][0]):
            if -1.0 <= peck <= t[-1] + 1.0:
                axis.axvline(peck, color="0.6", linewidth=0.8, linestyle=":")
        axis.grid(color="0.9", linewidth=0.6)
        axis.set_axisbelow(True)
    duration, descent = scenario.cycle(solution)
    title = f"The woodpecker on its way down, with the law {scenario.law!r}"
    if np.isfinite(duration):
        title = f"From peck to peck (dotted) {1e3 * duration:.1f} ms and {1e3 * descent:.2f} mm, law {scenario.law!r}"
    figure.suptitle(title, fontsize=11)
    return figure


def limit_cycles(runs: Mapping[str, tuple[Woodpecker, Solution]]) -> Figure:
    """Draw the bird's angle and rate over the last cycles, one panel per law."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.2, 4.2), layout="constrained")
    axes = figure.subplots(1, len(runs), sharex=True, sharey=True, squeeze=False)[0]
    for axis, (law, (scenario, solution)) in zip(axes, runs.items(), strict=True):
        shown = _last_cycles(scenario, solution)
        axis.plot(solution.q[shown, 2], solution.u[shown, 2], color="black", linewidth=1.0)
        duration, descent = scenario.cycle(solution)
        axis.set_title(f"{law}: {1e3 * duration:.1f} ms, {1e3 * descent:.2f} mm per cycle", fontsize=9)
        axis.set_xlabel("angle of the bird [rad]")
        axis.grid(color="0.9", linewidth=0.6)
        axis.set_axisbelow(True)
    axes[0].set_ylabel("its rate [rad/s]")
    figure.suptitle("The impact law decides how far the bird swings, and how fast it comes down", fontsize=11)
    return figure
