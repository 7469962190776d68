"""Figures of the strike, and of velocities after it over the ratio of stiffnesses and over the offset."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from nonsmooth import charts
from nonsmooth.interfaces import Run
from nonsmooth.solution.solution import Solution

from .closed_forms import one_after_the_other, symmetric

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from .scenario import DiscBall

Floats = NDArray[np.float64]

_LONG = 2.0
"""End time of the runs over stiffness ratio and offset [s]: after an oblique strike the second ball may be hit late."""


def strike(scenario: DiscBall, solution: Solution) -> Figure:
    """Draw the bodies at the start and at the end, with arrows for their velocities."""
    after = scenario.velocities(solution)
    back = "bounces back" if float(after[0] @ scenario.direction) < 0.0 else "goes on"
    left, right = np.hypot(*after[1:].T)
    alike = "leave equally fast" if abs(left - right) < 1e-3 else "leave at different speeds"
    words = f"(e = {scenario.restitution:g}, stiffness ratio {scenario.stiffness_ratio:g})"
    figure, (ax,) = charts.panels(title=f"The balls {alike}, the disc {back}\n{words}", size=(5.0, 5.6))
    before = np.array([scenario.direction, (0.0, 0.0), (0.0, 0.0)])
    for i, (name, radius) in enumerate(zip(("disc", "left ball", "right ball"), scenario.radii, strict=True)):
        path, colour = 1e3 * scenario.positions(solution)[:, i], charts.COLOURS[i]
        ax.plot(*path.T, color=colour, linewidth=0.8, linestyle=":")
        _body(ax, path[0], 1e3 * radius, before[i], color=colour, linestyle="--")
        _body(ax, path[-1], 1e3 * radius, after[i], color=colour, linestyle="-")
        ax.plot([], [], color=colour, label=f"{name}: {float(np.hypot(*after[i])):.3f} of the disc's speed")
    ax.plot([], [], color="0.5", linestyle="--", label="before")
    ax.plot([], [], color="0.5", linestyle="-", label="after")
    ax.set(aspect="equal", xlabel="x [mm]", ylabel="y [mm]")
    charts.legend(figure, columns=2)
    return figure


def _body(ax: Axes, place: Floats, radius: float, velocity: Floats, color: str, linestyle: str) -> None:
    """Draw a body as a circle, and its velocity as an arrow, two radii long for the disc's speed before the strike."""
    from matplotlib.patches import Circle

    x, y = place.tolist()
    tip = place + 2.0 * radius * velocity
    ax.add_patch(Circle((x, y), radius, fill=False, edgecolor=color, linestyle=linestyle, linewidth=1.2))
    if np.hypot(*velocity) > 1e-3:
        arrow = {"arrowstyle": "-|>", "color": color, "linewidth": 1.2}
        ax.annotate("", xy=tuple(tip.tolist()), xytext=(x, y), arrowprops=arrow)
    ax.update_datalim([place - radius, place + radius, tip])


def over_stiffness(scenario: DiscBall, run: Run) -> Figure:
    """Draw velocities after the strike over the ratio of stiffnesses at the two contacts.

    Marks at both ends show the limit there: the disc hits one ball after the other.
    """
    ratios = np.logspace(-4.0, 4.0, 49)
    after = _after([dataclasses.replace(scenario, t_end=_LONG, stiffness_ratio=x) for x in ratios.tolist()], run)
    title = "The ball at the stiffer contact gets more; at either end one is struck after the other"
    figure, axes = _outcome(ratios, after, title, "stiffness at the right ball over that at the left ball")
    shape = scenario.mass_ratio, scenario.radius_ratio, scenario.restitution
    for place, first in ((ratios[0], 0), (ratios[-1], 1)):
        limit = one_after_the_other(*shape, scenario.direction, first)
        _mark(axes, place, limit, label="one collision after the other", marker="s", color="0.4", markersize=7)
    _mark(axes, 1.0, _symmetric(scenario), label="closed form, by symmetry", marker="o", color="black", markersize=8)
    axes[0].set_xscale("log")
    charts.legend(figure)
    return figure


def over_offset(scenario: DiscBall, run: Run) -> Figure:
    """Draw the velocities of disc and balls after the strike over the lateral offset of the disc's path.

    At offset zero, at which the disc hits both balls at once, the closed form is marked.
    """
    # an even number of offsets, symmetric about zero, has no offset zero, at which the disc hits both balls at once
    offsets = np.linspace(-1.95, 1.95, 118)
    cases = [dataclasses.replace(scenario, t_end=_LONG, offset=x * scenario.radius) for x in offsets.tolist()]
    middle = len(offsets) // 2  # nan in the middle interrupts the line between both sides
    places, after = np.insert(offsets, middle, np.nan), np.insert(_after(cases, run), middle, np.nan, axis=0)
    title = "Hitting both balls at once is no limit of hitting one a little earlier"
    figure, axes = _outcome(places, after, title, "offset of the disc's path over the radius of a ball")
    _mark(axes, 0.0, _symmetric(scenario), label="both balls at once", marker="o", color="black")
    charts.legend(figure)
    return figure


def _after(scenarios: list[DiscBall], run: Run) -> Floats:
    """Return the velocities of disc and balls at the end of each run, relative to the disc's speed at its start.

    The shape is [n, 3, 2].
    """
    return np.array([scenario.velocities(run(scenario)) for scenario in scenarios])


def _symmetric(scenario: DiscBall) -> Floats:
    """Return the closed-form velocities of disc and balls after a symmetric strike, shape [3, 2].

    They are relative to the speed of the disc before.  Each ball has the right speed, but along x instead of its own
    direction: :func:`_mark` draws only the speeds of the balls.
    """
    disc, ball = symmetric(scenario.mass_ratio, scenario.radius_ratio, scenario.restitution)
    return np.array([[0.0, disc], [ball, 0.0], [ball, 0.0]])


def _outcome(places: Floats, after: Floats, title: str, xlabel: str) -> tuple[Figure, list[Axes]]:
    """Draw the speeds of the balls, and below them the velocity of the disc."""
    figure, axes = charts.panels(2, 1, title, (7.2, 6.0), sharex=True)
    forwards, left, right, sideways = (charts.line(i) | {"linewidth": 1.4} for i in range(4))
    axes[0].plot(places, np.hypot(*after[:, 1].T), label="left ball", **left)
    axes[0].plot(places, np.hypot(*after[:, 2].T), label="right ball", **right)
    axes[1].plot(places, after[:, 0, 0], label="disc, sideways (x)", **sideways)
    axes[1].plot(places, after[:, 0, 1], label="disc, forwards (y)", **forwards)
    axes[0].set_ylabel("speed / speed of the disc before")
    axes[1].set(xlabel=xlabel, ylabel="velocity / speed of the disc before")
    return figure, axes


def _mark(axes: list[Axes], place: float, velocities: Floats, **style: Any) -> None:
    """Mark the speeds of the balls and both components of the disc's velocity at a place."""
    for ax, values in zip(axes, (np.hypot(*velocities[1:].T), velocities[0]), strict=True):
        ax.plot([place] * 2, values, linestyle="none", fillstyle="none", **style)
