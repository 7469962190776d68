"""Phase portrait and path of the block."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from nonsmooth.solution.solution import Solution
from scenarios.block_on_belt.scenario import BlockOnBelt

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_STYLES = (("black", "-"), ("tab:red", "--"))


def portrait(runs: Mapping[str, tuple[BlockOnBelt, Solution]], title: str) -> Figure:
    """Draw velocity over elongation, and elongation over time."""
    from matplotlib.figure import Figure
    from matplotlib.ticker import MaxNLocator

    figure = Figure(figsize=(9.6, 4.4), layout="constrained")
    phase, time = figure.subplots(1, 2, width_ratios=(1.0, 1.3))
    for (colour, line), (name, (scenario, solution)) in zip(_STYLES, runs.items(), strict=False):
        q, velocity = scenario.coordinates(solution).values()
        phase.plot(q, velocity, color=colour, linestyle=line, linewidth=1.2, label=name)
        phase.plot(q[0], velocity[0], color=colour, marker="o", linestyle="none", markersize=4)
        time.plot(solution.t, q, color=colour, linestyle=line, linewidth=1.2)
    for scenario, _ in list(runs.values())[:1]:
        phase.axhline(scenario.belt_speed, color="0.6", linewidth=0.8, zorder=0)
        time.axhline(scenario.static_force / scenario.stiffness, color="0.6", linewidth=0.8, zorder=0)
    phase.set_xlabel("elongation of the spring q [m]")
    phase.set_ylabel("velocity of the block [m/s]")
    phase.set_title("grey: speed of the belt", fontsize=9)
    phase.xaxis.set_major_locator(MaxNLocator(5))
    if len(runs) > 1:
        found = phase.get_legend_handles_labels()
        figure.legend(*found, fontsize=8, frameon=False, ncols=2, loc="outside lower center")
    time.set_xlabel("time [s]")
    time.set_ylabel("elongation of the spring q [m]")
    time.set_title("grey: where static friction ends, q = F_s / k", fontsize=9)
    for axis in (phase, time):
        axis.grid(color="0.9", linewidth=0.6)
        axis.set_axisbelow(True)
    figure.suptitle(title, fontsize=11)
    return figure
