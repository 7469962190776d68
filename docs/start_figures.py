"""Draw the figures of the tutorial and of the notation: ``python docs/start_figures.py docs/pages/figures``."""

from __future__ import annotations

import sys
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Polygon

import nonsmooth as ns
from nonsmooth.bodies import Ball, Plate
from nonsmooth.charts import COLOURS, panels
from nonsmooth.laws import Coulomb, EnergeticImpact, Unilateral

_DPI = 110
_SEEN = (0.274, 0.149, 0.083)
"""Peaks that the camera of the tutorial has seen [m]."""


def tutorial_fit() -> Figure:
    """Heights of the ball of the tutorial with three restitutions, and the peaks that the camera has seen."""
    figure, (axis,) = panels(size=(7.2, 3.4))
    for restitution, style, colour in ((0.6, ":", COLOURS[7]), (0.74, "-", COLOURS[2]), (0.9, "--", COLOURS[7])):
        table, ball = Plate(), Ball(0.02)
        system = ns.System([table, ball])
        law = EnergeticImpact(restitution)
        system.contact(table, ball, normal=Unilateral(), friction=Coulomb(0.2), impact=law)
        system.place(ball, position=(0.0, 0.0, 0.52))
        solution = ns.simulate(system, 1.6)
        times = np.linspace(0.0, 1.6, 2001)
        heights = solution.history("position", times=times, of=ball)["position"][:, 0, 2] - 0.02
        axis.plot(times, heights, style, color=colour, label=f"e = {restitution:g}")
        if style == "-":
            tops = np.flatnonzero((heights[1:-1] > heights[:-2]) & (heights[1:-1] >= heights[2:]))[:3] + 1
            axis.plot(times[tops], _SEEN, "o", color=COLOURS[1], markersize=7, label="peaks seen by the camera")
    axis.set(xlabel="time [s]", ylabel="height above the table [m]", xlim=(0.0, 1.6), ylim=(0.0, 0.52))
    axis.legend(loc="upper right", ncols=2, frameon=False)
    return figure


def _arrow(axis: Axes, start: tuple[float, float], end: tuple[float, float], colour: str) -> None:
    style = {"arrowstyle": "-|>", "color": colour, "lw": 2.0, "mutation_scale": 16, "shrinkA": 0, "shrinkB": 0}
    axis.annotate("", end, start, arrowprops=style, zorder=5)


def contact_frame() -> Figure:
    """Two bodies that are apart, their witness points, the gap, and the axes of the contact frame."""
    figure = Figure(figsize=(6.0, 4.2), layout="constrained")
    axis = figure.add_subplot()
    x = np.linspace(-3.0, 3.0, 121)
    surface = -0.35 - 0.06 * x**2
    outline = [*zip(x, surface, strict=True), (3.0, -2.0), (-3.0, -2.0)]
    axis.add_patch(Polygon(outline, facecolor="#d9dee3", edgecolor="black", linewidth=1.3))
    axis.add_patch(Circle((0.0, 1.95), 1.6, facecolor="#cfe3f5", edgecolor="black", linewidth=1.3))
    low, high = (0.0, -0.35), (0.0, 0.35)
    for point, place, name in ((low, (0.16, -0.75), "witness point 1"), (high, (0.16, 0.02), "witness point 2")):
        axis.plot(*point, "o", color="black", markersize=6, zorder=6)
        axis.text(*place, name, fontsize=10)
    _arrow(axis, low, (0.0, 1.35), COLOURS[1])
    axis.text(-0.42, 1.08, "$n$", color=COLOURS[1], fontsize=16)
    _arrow(axis, low, (1.7, -0.35), COLOURS[2])
    axis.text(1.75, -0.27, "$t_1$", color=COLOURS[2], fontsize=16)
    axis.plot(*low, "o", color=COLOURS[3], markersize=17, fillstyle="none", markeredgewidth=2.0, zorder=6)
    axis.plot(*low, "x", color=COLOURS[3], markersize=11, markeredgewidth=2.0, zorder=6)
    axis.text(0.0, -1.22, "$t_2 = n \\times t_1$, into the page", color=COLOURS[3], fontsize=12, ha="center")
    axis.plot([-0.62, -0.62], [low[1], high[1]], color="black", linewidth=1.2)
    for _, y in (low, high):
        axis.plot([-0.76, 0.0], [y, y], color="black", linewidth=0.8, linestyle=":")
    axis.text(-0.72, 0.0, "gap $g > 0$", fontsize=13, ha="right", va="center")
    axis.text(-2.75, -1.72, "first body", fontsize=12)
    axis.text(0.0, 2.55, "second body", fontsize=12, ha="center")
    axis.set(xlim=(-3.0, 3.0), ylim=(-2.0, 3.6), aspect="equal")
    axis.axis("off")
    return figure


FIGURES = {"tutorial_fit": tutorial_fit, "contact_frame": contact_frame}


def main() -> None:
    """Save the figures in the folder given."""
    mpl.use("Agg")
    for name, draw in FIGURES.items():
        draw().savefig(Path(sys.argv[1]) / f"{name}.png", dpi=_DPI, facecolor="white")


if __name__ == "__main__":
    main()
