"""The row at some instants, and the speed of the wave along it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from nonsmooth.solution.solution import Solution
from scenarios.dominoes.scenario import Dominoes

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_COLOURS = ("black", "tab:red", "tab:blue", "tab:orange")
_MARKS = ("o", "s", "^", "v")


def row(scenario: Dominoes, solution: Solution) -> Figure:
    """Draw the dominoes from the side at four instants."""
    from matplotlib.figure import Figure
    from matplotlib.patches import Polygon

    figure = Figure(figsize=(7.2, 5.6), layout="constrained")
    axes = figure.subplots(4, 1, sharex=True, sharey=True)
    h, height = 1e3 * scenario.thickness, 1e3 * scenario.height
    corners = 0.5 * np.array([(-h, -height), (h, -height), (h, height), (-h, height)])
    right = 1e3 * scenario.pitch * (scenario.number - 1.0) + height
    for axis, share in zip(axes, (0.3, 0.55, 0.8, 1.0), strict=True):
        sample = min(int(share * len(solution.t)), len(solution.t) - 1)
        for x, z, tilt in solution.q[sample].reshape(-1, 3):
            c, s = np.cos(tilt), np.sin(tilt)
            turned = corners @ np.array([[c, -s], [s, c]]) + 1e3 * np.array([x, z])
            axis.add_patch(Polygon(turned, facecolor="0.85", edgecolor="black", linewidth=0.8))
        axis.axhline(0.0, color="black", linewidth=0.8)
        axis.set_xlim(-2.0 * h, right + h)
        axis.set_ylim(-0.05 * height, 1.15 * height)
        axis.set_aspect("equal")
        axis.set_ylabel("z [mm]")
        axis.set_title(f"t = {1e3 * solution.t[sample]:.0f} ms", fontsize=9, loc="right")
    axes[-1].set_xlabel("x [mm]")
    figure.suptitle("Those that have fallen lean on the next and push on", fontsize=11)
    return figure


def wave(runs: Mapping[str, tuple[Dominoes, Solution]]) -> Figure:
    """Draw the speed of the wave over the number of the domino."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.2, 4.4), layout="constrained")
    axis = figure.subplots()
    for (name, (scenario, solution)), colour, mark in zip(runs.items(), _COLOURS, _MARKS, strict=False):
        speeds = scenario.speeds(solution)
        numbers = np.arange(len(speeds)) + 2
        axis.plot(numbers, speeds, color=colour, marker=mark, fillstyle="none", linewidth=1.0, label=name or None)
    axis.set_title("The wave grows to a steady speed", fontsize=11)
    axis.set_xlabel("domino")
    axis.set_ylabel("speed from it to the next [m/s]")
    axis.set_ylim(bottom=0.0)
    axis.grid(color="0.9", linewidth=0.6)
    if any(runs):
        axis.legend(fontsize=8, frameon=False)
    return figure
