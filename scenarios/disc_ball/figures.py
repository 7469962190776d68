"""The strike, and what comes out of it over the ratio of stiffnesses and over the offset."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from nonsmooth.interfaces import Run
from nonsmooth.solution.solution import Solution
from scenarios.disc_ball.closed_forms import one_after_the_other, symmetric
from scenarios.disc_ball.scenario import DiscBall

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Floats = NDArray[np.float64]

RATIOS, OFFSETS = 49, 118
"""Numbers of runs of the gallery; that of offsets is even, to leave out zero."""
_LONG = 2.0
"""End of the runs of the gallery [s]."""
_NAMES = ("disc", "left ball", "right ball")
_LOOKS: tuple[dict[str, Any], ...] = (
    {"color": "black", "linestyle": "-"},
    {"color": "tab:blue", "linestyle": "--"},
    {"color": "tab:red", "linestyle": "-."},
)


def strike(scenario: DiscBall, solution: Solution) -> Figure:
    """Draw the bodies at the start and at the end, with arrows for their velocities."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(5.0, 5.6), layout="constrained")
    axis = figure.subplots()
    places = scenario.positions(solution)
    before = np.array([scenario.direction, (0.0, 0.0), (0.0, 0.0)])
    after = scenario.velocities(solution)
    for i, (name, look) in enumerate(zip(_NAMES, _LOOKS, strict=True)):
        path = 1e3 * places[:, i]
        axis.plot(*path.T, color=look["color"], linewidth=0.8, linestyle=":")
        for place, velocity, line in ((path[0], before[i], "--"), (path[-1], after[i], "-")):
            _body(axis, place, 1e3 * scenario.radii[i], velocity, color=look["color"], linestyle=line)
        speed = float(np.hypot(*after[i]))
        axis.plot([], [], color=look["color"], label=f"{name}: {speed:.3f} of the disc's speed")
    axis.plot([], [], color="0.5", linestyle="--", label="before")
    axis.plot([], [], color="0.5", linestyle="-", label="after")
    axis.set_aspect("equal")
    axis.set_xlabel("x [mm]")
    axis.set_ylabel("y [mm]")
    back = "bounces back" if float(after[0] @ scenario.direction) < 0.0 else "goes on"
    left, right = np.hypot(*after[1:].T)
    alike = "leave equally fast" if abs(left - right) < 1e-3 else "leave at different speeds"
    words = f"(e = {scenario.restitution:g}, stiffness ratio {scenario.stiffness_ratio:g})"
    axis.set_title(f"The balls {alike}, the disc {back}\n{words}", fontsize=11)
    figure.legend(loc="outside lower center", ncols=2, fontsize=8, frameon=False)
    return figure


def _body(axis: Axes, place: Floats, radius: float, velocity: Floats, color: str, linestyle: str) -> None:
    from matplotlib.patches import Circle

    x, y = place.tolist()
    axis.add_patch(Circle((x, y), radius, fill=False, edgecolor=color, linestyle=linestyle, linewidth=1.2))
    if np.hypot(*velocity) > 1e-3:
        axis.annotate(
            "",
            xy=(x + 2.0 * radius * velocity[0], y + 2.0 * radius * velocity[1]),
            xytext=(x, y),
            arrowprops={"arrowstyle": "-|>", "color": color, "linewidth": 1.2},
        )
    axis.update_datalim([place - radius, place + radius, place + 2.0 * radius * velocity])


def gallery(owner: type[DiscBall], run: Run) -> Mapping[str, Any]:
    """Return all figures by name."""
    scenario = owner()
    solution = run(scenario)
    ratios = np.logspace(-4.0, 4.0, RATIOS)
    offsets = np.linspace(-1.95, 1.95, OFFSETS)
    # after a strike aside the disc may be slow on its way to the other ball
    slow = dataclasses.replace(scenario, t_end=_LONG)
    by_ratio = [dataclasses.replace(slow, stiffness_ratio=float(ratio)) for ratio in ratios]
    by_offset = [dataclasses.replace(slow, offset=float(offset) * scenario.radius) for offset in offsets]
    both = _outcomes([*by_ratio, *by_offset], run)
    return {
        "strike": strike(scenario, solution),
        "stiffness": over_stiffness(scenario, ratios, both[: len(ratios)]),
        "offset": over_offset(scenario, offsets, both[len(ratios) :]),
    }


def _outcomes(scenarios: list[DiscBall], run: Run) -> Floats:
    """Return the velocities after the strike, shape [n, 3, 2]."""
    found = []
    for scenario in scenarios:
        solution = run(scenario)
        found.append(scenario.velocities(solution))
    return np.array(found)


def over_stiffness(scenario: DiscBall, ratios: Floats, after: Floats) -> Figure:
    """Draw the outcome over the ratio of stiffnesses, between the limits of collisions one after the other."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.2, 6.0), layout="constrained")
    axes = figure.subplots(2, 1, sharex=True)
    _draw(axes, ratios, after)
    shape = scenario.mass_ratio, scenario.radius_ratio, scenario.restitution
    for place, first in ((ratios[0], 0), (ratios[-1], 1)):
        limit = one_after_the_other(*shape, scenario.direction, first)
        _mark(axes, place, limit, "s")
    disc, ball = symmetric(*shape)
    for axis, values in ((axes[0], [ball, ball]), (axes[1], [0.0, disc])):
        axis.plot([1.0] * 2, values, linestyle="none", marker="o", fillstyle="none", color="black", markersize=8)
    axes[0].plot(
        [], [], linestyle="none", marker="s", fillstyle="none", color="0.4", label="one collision after the other"
    )
    axes[0].plot(
        [], [], linestyle="none", marker="o", fillstyle="none", color="black", label="closed form, by symmetry"
    )
    axes[0].set_xscale("log")
    axes[1].set_xlabel("stiffness at the right ball over that at the left ball")
    figure.suptitle(
        "The ball at the stiffer contact gets more; at either end one is struck after the other", fontsize=11
    )
    figure.legend(loc="outside lower center", ncols=4, fontsize=8, frameon=False)
    return figure


def over_offset(scenario: DiscBall, offsets: Floats, after: Floats) -> Figure:
    """Draw the outcome over the offset, and the closed form of the symmetric strike."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.2, 6.0), layout="constrained")
    axes = figure.subplots(2, 1, sharex=True)
    for side in (offsets < 0.0, offsets > 0.0):
        _draw(axes, offsets[side], after[side], labels=bool(offsets[side][0] < 0.0))
    disc, ball = symmetric(scenario.mass_ratio, scenario.radius_ratio, scenario.restitution)
    axes[0].plot(
        [0.0], [ball], linestyle="none", marker="o", fillstyle="none", color="black", label="both balls at once"
    )
    axes[1].plot([0.0] * 2, [0.0, disc], linestyle="none", marker="o", fillstyle="none", color="black")
    axes[1].set_xlabel("offset of the disc's path over the radius of a ball")
    figure.suptitle("Hitting both balls at once is no limit of hitting one a little earlier", fontsize=11)
    figure.legend(loc="outside lower center", ncols=4, fontsize=8, frameon=False)
    return figure


def _draw(axes: Any, places: Floats, after: Floats, labels: bool = True) -> None:
    for i, (name, look) in enumerate(zip(_NAMES[1:], _LOOKS[1:], strict=True)):
        axes[0].plot(places, np.hypot(*after[:, 1 + i].T), linewidth=1.4, label=name if labels else None, **look)
    axes[1].plot(places, after[:, 0, 0], color="0.5", linewidth=1.4, label="disc, sideways (x)" if labels else None)
    axes[1].plot(places, after[:, 0, 1], linewidth=1.4, label="disc, forwards (y)" if labels else None, **_LOOKS[0])
    axes[0].set_ylabel("speed / speed of the disc before")
    axes[1].set_ylabel("velocity / speed of the disc before")
    for axis in axes:
        axis.grid(color="0.9", linewidth=0.6)
        axis.set_axisbelow(True)


def _mark(axes: Any, place: float, velocities: Floats, marker: str) -> None:
    for axis, values in ((axes[0], np.hypot(*velocities[1:].T)), (axes[1], velocities[0])):
        axis.plot([place] * 2, values, linestyle="none", marker=marker, fillstyle="none", color="0.4", markersize=7)
