"""Corners over time, velocity ratio over slenderness, decay of the tilt, a block that rocks in space."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from nonsmooth import charts
from nonsmooth.engine.memory.modes import Cause
from nonsmooth.interfaces import Run
from nonsmooth.solution.solution import Solution

from . import housner

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from .scenario import RockingBlock
    from .spatial import RockingBlock3D

_HEIGHT = "height over the ground [m]"


def corners(scenario: RockingBlock, solution: Solution, title: str) -> Figure:
    """Draw the heights of both lower corners over time."""
    t, (left, right) = solution.t, scenario.corner_heights(solution).T[:2]
    curves = {"left corner, on the ground at the start": (t, left), "right corner": (t, right)}
    return charts.histories({_HEIGHT: curves}, title)


def velocity_ratios(kind: type[RockingBlock], run: Run) -> Figure:
    """Draw the velocity ratio of the first impact over the slenderness, with and without enough friction."""
    alphas = np.linspace(0.0, np.radians(60.0), 200)
    places = np.radians(np.arange(4.0, 60.0, 5.0))
    computed = {}
    for label, part in (("enough friction", 1.05), ("half as much as that", 0.5)):
        blocks = [_slender(kind, alpha, part * housner.least_friction(alpha)) for alpha in places.tolist()]
        computed[label] = np.degrees(places), [_ratio(run(block)) for block in blocks]
    curve = [housner.velocity_ratio(alpha) for alpha in alphas]
    return charts.comparison(
        {r"Housner, $1 - 1.5\,\sin^2\alpha$, then 0": (np.degrees(alphas), curve)},
        computed,
        r"$\alpha$ = arctan(base / height) [°]",
        "angular velocity after / before the impact",
        "Housner's ratio holds at every slenderness, if there is friction enough (e = 0)",
    )


def _slender(kind: type[RockingBlock], alpha: float, friction: float) -> RockingBlock:
    base = float(np.tan(alpha))
    return kind(base=base, height=1.0, tilt=0.1 * alpha, restitution=0.0, friction=friction, t_end=0.5)


def _ratio(solution: Solution) -> float:
    """Return the angular velocity after the first impact over that before it; nan if there was none."""
    events = solution.events
    first = np.flatnonzero(events.cause == Cause.IMPACT)[:1]
    ratio = events.u_after[first, 2] / events.u_before[first, 2]
    return float(ratio[0]) if len(first) > 0 else float("nan")


def rocking(scenario: RockingBlock, solution: Solution) -> Figure:
    """Draw the tilt over time and Housner's amplitudes."""
    alpha = housner.slenderness(scenario.base, scenario.height)
    events = solution.events
    landings = np.append(0.0, events.time[events.cause == Cause.IMPACT])
    peaks = housner.amplitudes(alpha, scenario.tilt, len(landings)) / alpha
    levels = np.where(np.arange(len(peaks)) % 2 == 0, peaks, -peaks)
    ends = np.append(landings[1:], solution.t_end)
    curves = {
        "tilt": (solution.t, scenario.coordinates(solution)["tilt"] / alpha),
        "amplitude by the velocity ratio": (_broken(landings, ends), _broken(levels, levels)),
    }
    words = f"base / height = {scenario.base / scenario.height:g}, e = 0, μ = {scenario.friction:g}"
    title = f"Every landing takes the same share of the energy\n({words})"
    return charts.histories({r"tilt / $\alpha$": curves}, title)


def _broken(begins: np.ndarray, ends: np.ndarray) -> np.ndarray:
    """Return begin and end of each segment in turn, followed by nan, which interrupts a drawn line."""
    return np.column_stack([begins, ends, np.full(len(begins), np.nan)]).ravel()


def spatial(scenario: RockingBlock3D, solution: Solution) -> Figure:
    """Draw where the upright axis leans, seen from above, and the heights of the lower corners."""
    words = f"e = {scenario.restitution:g}, μ = {scenario.friction:g}"
    title = f"A block released on a corner rocks from corner to corner ({words})"
    figure, (plan, time) = charts.panels(1, 2, title, (9.6, 4.4), width_ratios=(1.0, 1.5))
    lean = scenario.lean(solution)
    axis = {"from the start (dot)": (lean[:, 0], lean[:, 1])}
    charts.portrait(axis, "x component [1]", "y component [1]", ax=plan)
    plan.plot(*lean[-1], marker="s", color="tab:red", linestyle="none", label="end")
    plan.set_aspect("equal", adjustable="datalim")
    plan.set_title("upright axis, seen from above", fontsize=10)
    names = ("-x -y", "-x +y", "+x -y", "+x +y")
    heights = dict(zip(names, 1e3 * scenario.corner_heights(solution).T, strict=True))
    curves = {f"corner {name}": (solution.t, height) for name, height in heights.items()}
    charts.histories({"height over the ground [mm]": curves}, axes=[time])
    time.set_title("lower corners", fontsize=10)
    for ax in (plan, time):
        ax.legend(fontsize=8, frameon=False, ncols=2 if ax is time else 1)
    return figure
