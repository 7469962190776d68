"""Velocities of all balls after the strike."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from nonsmooth.solution.solution import Solution
from scenarios.newtons_cradle.scenario import NewtonsCradle

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_MARKS = (("o", "black"), ("s", "tab:red"), ("^", "tab:blue"))


def velocities(runs: Mapping[str, tuple[NewtonsCradle, Solution]], title: str) -> Figure:
    """Draw the velocity of every ball, counted from the far end, relative to that of the strikers."""
    from matplotlib.figure import Figure
    from matplotlib.ticker import MaxNLocator

    figure = Figure(figsize=(7.2, 4.8), layout="constrained")
    axis = figure.subplots()
    axis.axhline(0.0, color="0.6", linewidth=0.8)
    for (mark, colour), (name, (scenario, solution)) in zip(_MARKS, runs.items(), strict=False):
        values = scenario.velocities(solution) / scenario.speed
        places = range(len(values) - 1, -1, -1)
        axis.plot(places, values, marker=mark, color=colour, linestyle=":", linewidth=1.0, fillstyle="none", label=name)
    axis.set_title(title, fontsize=11)
    axis.set_xlabel("ball, counted back from the far end of the row")
    axis.set_ylabel("velocity after the strike / velocity of the strikers")
    axis.xaxis.set_major_locator(MaxNLocator(integer=True))
    axis.invert_xaxis()
    axis.grid(color="0.9", linewidth=0.6)
    axis.set_axisbelow(True)
    axis.legend(fontsize=8, frameon=False)
    return figure
