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
_MAGNIFIED = ("flutter",)
"""Modes whose turns are too small to see on a true-to-scale path."""
_SPREADS = 3.0
"""Spreads of the mean velocity, from one period to the next, within which it is none."""
_NONE = 1e-9
"""Mean velocity over the peak speed of the plate that is none."""


def paths(runs: Mapping[str, Run], spans: Mapping[str, float], title: str) -> Figure:
    """Draw the path in the last ``spans`` [plate periods] of each run, with the mean velocity as arrows."""
    note = style.footnote(*(scenario for scenario, _ in runs.values()))
    figure, axes = style.new_figure(title, note, len(runs), width=max(7.2, 3.9 * len(runs)), height=5.2)
    for axis, (mode, run) in zip(axes, runs.items(), strict=True):
        t, path = _shown(run, spans[mode])
        times, velocities = _means(run, t, path)
        if mode in _MAGNIFIED:
            turn = 1e3 * _turn(path)
            path, velocities = (path - path[0]) @ turn, velocities @ turn
            axis.set_xlabel("along the mean path [mm]")
            axis.set_ylabel("across it [mm], magnified")
        else:
            _true_to_scale(axis, path)
            axis.set_xlabel("x [m]")
            axis.set_ylabel("y [m]")
        axis.plot(path[:, 0], path[:, 1], label="mass centre", **style.CURVE)
        axis.plot(*path[0], label="start of the part shown", **style.IMPACT)
        _arrows(axis, t, path, times, velocities)
        axis.set_title(f"{mode}, last {(t[-1] - t[0]):.3g} s", fontsize=10)
        axis.tick_params(labelsize=8)
        axis.locator_params(axis="x", nbins=5)
    style.legend(axes)
    return figure


def goes(run: Run) -> bool:
    """Tell whether the settled mass centre goes anywhere on the mean, beyond the error of its mean velocity."""
    settled, _ = run[0].settled(run[1])
    velocities = _means(run, settled.t, settled.centre)[1]
    if len(velocities) < 2:
        return bool(np.any(velocities != 0.0))
    speed = float(np.sqrt(np.mean(np.sum(velocities**2, axis=1))))
    spread = float(np.sqrt(np.mean(np.sum(np.diff(velocities, axis=0) ** 2, axis=1)) / 2.0))
    return speed > max(_SPREADS * spread, _NONE * settled.speed)


def _shown(run: Run, span: float) -> tuple[Floats, Floats]:
    scenario, solution = run
    motion = scenario.motion(solution)
    keep = motion.t >= motion.t[-1] - span / scenario.frequency - 1e-9
    return motion.t[keep], motion.centre[keep]


def _means(run: Run, t: Floats, path: Floats) -> tuple[Floats, Floats]:
    """Return mean velocities over one period of the motion after the other, and the times in their middles."""
    scenario, solution = run
    span = float(scenario.summarise(solution)["period"] or 1) / scenario.frequency
    edges = t[-1] - span * np.arange(int((t[-1] - t[0]) / span + 1e-9), -1.0, -1.0)
    places = np.column_stack([np.interp(edges, t, column) for column in path.T])
    return edges[:-1] + span / 2.0, np.diff(places, axis=0) / span


def _true_to_scale(axis: Axes, path: Floats) -> None:
    """Show a square around the path."""
    low, high = path.min(axis=0), path.max(axis=0)
    half = 0.58 * float((high - low).max())
    (x, y) = (low + high) / 2.0
    axis.set_xlim(x - half, x + half)
    axis.set_ylim(y - half, y + half)
    axis.set_aspect("equal")


def _turn(path: Floats) -> Floats:
    """Return the matrix that turns rows so that the path ends on the first axis."""
    c, s = (path[-1] - path[0]) / max(float(np.hypot(*(path[-1] - path[0]))), 1e-300)
    return np.array([[c, -s], [s, c]])


def _arrows(axis: Axes, t: Floats, path: Floats, times: Floats, velocities: Floats) -> None:
    """Draw some of the mean velocities where the mass centre is in the middle of each."""
    at = np.unique(((np.arange(_ARROWS) + 0.5) / _ARROWS * len(times)).astype(int))
    if len(times) == 0:
        return
    axis.quiver(
        *(np.interp(times[at], t, column) for column in path.T),
        *velocities[at].T,
        color="tab:blue",
        width=0.009,
        angles="xy",
        scale_units="width",
        scale=max(float(np.hypot(*velocities[at].T).max()), 1e-300) / 0.1,
        label="mean velocity",
        zorder=3,
    )
