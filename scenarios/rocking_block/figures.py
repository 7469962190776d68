"""Corners over time, velocity ratio over slenderness, decay of the tilt, a block that rocks in space."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from nonsmooth.engine.memory.modes import Cause
from nonsmooth.runs.simulate import Progress, simulate
from nonsmooth.solution.solution import Solution
from scenarios.rocking_block import housner
from scenarios.rocking_block.scenario import RockingBlock
from scenarios.rocking_block.spatial import RockingBlock3D

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_LOOKS: tuple[dict[str, Any], ...] = (
    {"color": "black", "linestyle": "-"},
    {"color": "tab:red", "linestyle": "--"},
    {"color": "tab:blue", "linestyle": "-."},
    {"color": "tab:orange", "linestyle": ":"},
)


def _clean(axis: Axes) -> None:
    axis.grid(color="0.9", linewidth=0.6)
    axis.set_axisbelow(True)


def corners(scenario: RockingBlock, solution: Solution, title: str) -> Figure:
    """Draw the heights of both lower corners over time and mark the impacts of each."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.2, 4.4), layout="constrained")
    axis = figure.subplots()
    heights = scenario.corner_heights(solution)
    for i, word in enumerate(("left corner, on the ground at the start", "right corner")):
        axis.plot(solution.t, heights[:, i], linewidth=1.2, label=word, **_LOOKS[i])
    axis.set_title(title, fontsize=11)
    axis.set_xlabel("time [s]")
    axis.set_ylabel("height over the ground [m]")
    axis.legend(fontsize=8, frameon=False)
    _clean(axis)
    return figure


def measured_ratio(scenario: RockingBlock, progress: Progress | None) -> float:
    """Return the angular velocity after the first impact over that before it; nan if there was none."""
    solution = simulate(scenario.build(), scenario.t_end, progress=progress)
    events = solution.events
    first = np.flatnonzero(events.cause == Cause.IMPACT)[:1]
    ratio = events.u_after[first, 2] / events.u_before[first, 2]
    return float(ratio[0]) if len(first) > 0 else float("nan")


def velocity_ratios(kind: type[RockingBlock], progress: Progress | None) -> Figure:
    """Draw the velocity ratio of the first impact over the slenderness, with and without enough friction."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.2, 4.4), layout="constrained")
    axis = figure.subplots()
    alphas = np.linspace(0.0, np.radians(60.0), 200)
    curve = [housner.velocity_ratio(a) for a in alphas]
    axis.plot(
        np.degrees(alphas), curve, color="black", linewidth=1.2, label=r"Housner, $1 - 1.5\,\sin^2\alpha$, then 0"
    )
    places = np.radians(np.arange(4.0, 60.0, 5.0))
    styles = (("enough friction", 1.05, "o", "black"), ("half as much as that", 0.5, "^", "tab:red"))
    for word, share, mark, colour in styles:
        ratios = []
        for alpha in places:
            friction = share * housner.least_friction(alpha)
            size = {"base": float(np.tan(alpha)), "height": 1.0, "tilt": 0.1 * float(alpha)}
            block = kind(**size, restitution=0.0, friction=friction, t_end=0.5)
            ratios.append(measured_ratio(block, progress))
        axis.plot(np.degrees(places), ratios, color=colour, marker=mark, fillstyle="none", linestyle="none", label=word)
    axis.set_title("Housner's ratio holds at every slenderness, if there is friction enough (e = 0)", fontsize=11)
    axis.set_xlabel(r"$\alpha$ = arctan(base / height) [°]")
    axis.set_ylabel("angular velocity after / before the impact")
    axis.legend(fontsize=8, frameon=False)
    _clean(axis)
    return figure


def rocking(scenario: RockingBlock, solution: Solution) -> Figure:
    """Draw the tilt over time and Housner's amplitudes."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.2, 4.4), layout="constrained")
    axis = figure.subplots()
    alpha = housner.slenderness(scenario.base, scenario.height)
    tilt = scenario.coordinates(solution)["tilt"]
    axis.plot(solution.t, tilt / alpha, color="black", linewidth=1.2, label="tilt")
    events = solution.events
    landings = np.append(0.0, events.time[events.cause == Cause.IMPACT])
    peaks = housner.amplitudes(alpha, scenario.tilt, len(landings)) / alpha
    ends = np.append(landings[1:], solution.t_end)
    for i, (start, end, peak) in enumerate(zip(landings, ends, peaks, strict=True)):
        label = "amplitude by the velocity ratio" if i == 0 else None
        level = peak if i % 2 == 0 else -peak
        axis.plot([start, end], [level, level], color="tab:red", linestyle="--", linewidth=1.0, label=label)
    words = f"base / height = {scenario.base / scenario.height:g}, e = 0, μ = {scenario.friction:g}"
    axis.set_title(f"Every landing takes the same share of the energy\n({words})", fontsize=11)
    axis.set_xlabel("time [s]")
    axis.set_ylabel(r"tilt / $\alpha$")
    axis.legend(fontsize=8, frameon=False)
    _clean(axis)
    return figure


def spatial(scenario: RockingBlock3D, solution: Solution) -> Figure:
    """Draw where the upright axis leans, seen from above, and the heights of the lower corners."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9.6, 4.4), layout="constrained")
    plan, time = figure.subplots(1, 2, width_ratios=(1.0, 1.5))
    lean = scenario.lean(solution)
    plan.plot(lean[:, 0], lean[:, 1], color="black", linewidth=1.0)
    plan.plot(*lean[0], marker="o", color="black", linestyle="none", label="start")
    plan.plot(*lean[-1], marker="s", color="tab:red", linestyle="none", label="end")
    plan.set_aspect("equal", adjustable="datalim")
    plan.set_title("upright axis, seen from above", fontsize=10)
    plan.set_xlabel("x component [1]")
    plan.set_ylabel("y component [1]")
    plan.legend(fontsize=8, frameon=False)
    names = ("-x -y", "-x +y", "+x -y", "+x +y")
    for height, name, look in zip(scenario.corner_heights(solution).T, names, _LOOKS, strict=True):
        time.plot(solution.t, 1e3 * height, linewidth=1.2, label=f"corner {name}", **look)
    time.set_title("lower corners", fontsize=10)
    time.set_xlabel("time [s]")
    time.set_ylabel("height over the ground [mm]")
    time.legend(fontsize=8, frameon=False, ncols=2)
    for axis in (plan, time):
        _clean(axis)
    words = f"e = {scenario.restitution:g}, μ = {scenario.friction:g}"
    figure.suptitle(f"A block released on a corner rocks from corner to corner ({words})", fontsize=11)
    return figure
