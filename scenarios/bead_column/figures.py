"""The beads' paths."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from nonsmooth.solution.solution import Solution
from scenarios.bead_column.scenario import BeadColumn

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def heights(scenario: BeadColumn, solution: Solution) -> Figure:
    """Draw how far every bead is above its place in a column at rest."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.2, 4.8), layout="constrained")
    axis = figure.subplots()
    z = scenario.heights(solution)
    n = z.shape[1]
    for i in range(n):
        lift = z[:, i] - (2 * i + 1) * scenario.radius
        label = {0: "lowest bead", n - 1: "highest bead"}.get(i)
        axis.plot(1e3 * solution.t, 1e3 * lift, color=str(0.75 * np.sqrt(i / n)), linewidth=1.2, label=label)
    axis.set_title(
        f"The column falls as one and comes apart in its first impact (e = {scenario.restitution:g})", fontsize=11
    )
    axis.set_xlabel("time [ms]")
    axis.set_ylabel("height above the place in a column at rest [mm]")
    axis.grid(color="0.9", linewidth=0.6)
    axis.set_axisbelow(True)
    axis.legend(fontsize=8, frameon=False)
    return figure
