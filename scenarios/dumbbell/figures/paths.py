"""Fig. 11: paths of the mass centre on the horizontal plane."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from nonsmooth.solution.solution import Solution
from scenarios.dumbbell.figures import style
from scenarios.dumbbell.scenario import DumbbellScenario

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Floats = NDArray[np.float64]
Run = tuple[DumbbellScenario, Solution]
_ARROWS = 6
_SMALLEST = 1e-4
"""Half of the smallest square shown [m]."""
_MAGNIFIED = ("flutter",)
"""Modes whose turns are too small to see on a true-to-scale path."""


def paths(runs: Mapping[str, Run], spans: Mapping[str, float], title: str) -> Figure:
    """Draw the path in the last ``spans`` [plate periods] of each run, with the velocity as arrows."""
    note = style.footnote(*(scenario for scenario, _ in runs.values()))
    figure, axes = style.new_figure(title, note, len(runs), width=max(7.2, 3.9 * len(runs)), height=5.2)
    for axis, (mode, (scenario, solution)) in zip(axes, runs.items(), strict=True):
        motion = scenario.motion(solution)
        keep = motion.t >= motion.t[-1] - spans[mode] / scenario.frequency - 1e-9
        t, path = motion.t[keep], motion.centre[keep]
        if mode in _MAGNIFIED:
            path = 1e3 * _along(path)
            axis.set_xlabel("along the mean path [mm]")
            axis.set_ylabel("across it [mm], magnified")
        else:
            _true_to_scale(axis, path)
            axis.set_xlabel("x [m]")
            axis.set_ylabel("y [m]")
        axis.plot(path[:, 0], path[:, 1], label="mass centre", **style.CURVE)
        axis.plot(*path[0], label="start of the part shown", **style.IMPACT)
        _arrows(axis, t, path)
        axis.set_title(f"{mode}, last {(t[-1] - t[0]):.3g} s", fontsize=10)
        axis.tick_params(labelsize=8)
        axis.locator_params(axis="x", nbins=5)
    style.legend(axes)
    return figure


def _true_to_scale(axis: Axes, path: Floats) -> None:
    """Show a square around the path, of some size even where nothing moves."""
    low, high = path.min(axis=0), path.max(axis=0)
    half = max(0.58 * float((high - low).max()), _SMALLEST)
    (x, y) = (low + high) / 2.0
    axis.set_xlim(x - half, x + half)
    axis.set_ylim(y - half, y + half)
    axis.set_aspect("equal")


def _along(path: Floats) -> Floats:
    """Turn a path so that it starts at the origin and ends on the first axis."""
    moved = path - path[0]
    length = float(np.hypot(*moved[-1]))
    if length == 0.0:
        return np.asarray(moved)
    c, s = moved[-1] / length
    return np.asarray(moved @ np.array([[c, -s], [s, c]]))


def _arrows(axis: Axes, t: Floats, path: Floats) -> None:
    if len(t) < 2:
        return
    at = np.unique(((np.arange(_ARROWS) + 0.5) / _ARROWS * (len(t) - 1)).astype(int))
    speed = (path[at + 1] - path[at]) / (t[at + 1] - t[at])[:, None]
    axis.quiver(
        path[at, 0],
        path[at, 1],
        speed[:, 0],
        speed[:, 1],
        color="tab:blue",
        width=0.009,
        angles="xy",
        scale_units="width",
        scale=max(float(np.hypot(*speed.T).max()), 1e-300) / 0.1,
        label="velocity",
        zorder=3,
    )
