"""The tower before and after, and how the uppermost prism slides."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from bodies import Polyhedron
from nonsmooth.solution.solution import Solution
from scenarios.polyhedron_stack.scenario import PolyhedronStack
from scenarios.solids import draw_solids

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_COLOURS = ("#0072b2", "#009e73", "#e69f00", "#cc79a7")


def tower(scenario: PolyhedronStack, solution: Solution) -> Figure:
    """Draw the tower at the start and at the end, and the way of the uppermost prism with the events."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9.6, 4.2), layout="constrained")
    axes = figure.subplots(1, 3, width_ratios=(1.0, 1.0, 1.6))
    solids = [shape for prism in scenario.prisms() for shape in prism.shapes if isinstance(shape, Polyhedron)]
    for axis, sample, name in ((axes[0], 0, "start"), (axes[1], -1, f"t = {solution.t[-1]:.2g} s")):
        draw_solids(axis, solids, solution.q[sample].reshape(-1, 7), -1.1, 0.4, _COLOURS)
        axis.set_title(name, fontsize=9)
        axis.set_xticks([])
        axis.set_yticks([])
    axis = axes[2]
    way = scenario.positions(solution)[:, -1, 0]
    axis.plot(1e3 * solution.t, 1e3 * way, color=_COLOURS[-1], linewidth=1.5, label="uppermost prism")
    axis.axhline(1e3 * scenario.way, color="0.5", linestyle="--", linewidth=0.8, label="v² / (2 μ g)")
    causes = solution.events.causes()
    times = np.array([t for t, cause in zip(solution.events.time, causes, strict=True) if cause == "end of a feature"])
    if len(times) > 0:
        places = np.interp(times, solution.t, way)
        axis.plot(1e3 * times, 1e3 * places, "o", color="black", fillstyle="none", label="a corner leaves the face")
    axis.set_xlabel("time [ms]")
    axis.set_ylabel("way [mm]")
    axis.set_ylim(bottom=0.0)
    axis.grid(color="0.9", linewidth=0.6)
    axis.legend(fontsize=8, frameon=False)
    figure.suptitle("Pushed, the uppermost prism slides to rest; the tower below stays", fontsize=11)
    return figure
