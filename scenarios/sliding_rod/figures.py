"""Figures of Painleve's rod: the region of the paradox, and angle, slip and gap of runs over time."""

from __future__ import annotations

import dataclasses
import itertools
import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from nonsmooth import charts
from nonsmooth.engine.memory.modes import Cause
from nonsmooth.interfaces import Run
from nonsmooth.solution.solution import Solution

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from .scenario import SlidingRod

Floats = NDArray[np.float64]

_ANGLES, _COEFFICIENTS = 17, 11
"""Numbers of angles and friction coefficients at which runs are tested for Painleve's paradox, respectively."""
_MARKED: dict[int, str] = {
    Cause.PAINLEVE: "impact without collision",
    Cause.JAM: "jamming of the slip",
    Cause.LIFT_OFF: "lift-off",
    Cause.SLIP_TO_STICK: "slip to stick",
}


def histories(runs: Mapping[str, tuple[SlidingRod, Solution]], title: str) -> Figure:
    """Draw angle, slip and gap of the lower end over time with their events, a column for each run."""
    size = (9.6, 6.8) if len(runs) > 1 else (6.0, 6.4)
    figure, axes = charts.panels(3, len(runs), title, size, sharex="col")
    for column, (name, (rod, solution)) in enumerate(runs.items()):
        own = axes[column :: len(runs)]
        _history(own, rod, solution)
        for ax in own if column else ():
            ax.set_ylabel("")
        if name:
            critical = rod.rod.critical_friction(rod.tilt)
            own[0].set_title(f"{name}\nµ = {rod.friction:g}, critical at the start {critical:.3f}", fontsize=10)
    charts.legend(figure, columns=4)
    return figure


def _history(axes: Sequence[Axes], rod: SlidingRod, solution: Solution) -> None:
    """Draw angle, slip velocity and gap of one run, with the values before and after each event."""
    events = solution.events
    apart = ~np.isin(solution.t, events.time)
    t = np.concatenate([solution.t[apart], np.repeat(events.time, 2)])
    q = np.concatenate([solution.q[apart], np.repeat(events.q, 2, axis=0)])
    jumps = np.stack([events.u_before, events.u_after], axis=1).reshape(-1, q.shape[1] - 1)
    u, order = np.concatenate([solution.u[apart], jumps]), np.argsort(t, kind="stable")
    curves, marks = _quantities(rod, q[order], u[order]), _quantities(rod, events.q, events.u_before)
    charts.histories({label: {"": (1e3 * t[order], y)} for label, y in curves.items()}, xlabel="time [ms]", axes=axes)
    for ax, values in zip(axes, marks.values(), strict=True):
        for place, (cause, name) in enumerate(_MARKED.items(), 1):
            hit = events.cause == cause
            if np.any(hit):
                ax.plot(1e3 * events.time[hit], values[hit], label=name, **charts.marker(place))
    axes[2].set_ylim(bottom=-0.1, top=max(1.0, axes[2].get_ylim()[1]))


def _quantities(rod: SlidingRod, q: Floats, u: Floats) -> dict[str, Floats]:
    """Return angle, slip velocity and gap by the labels of their axes, shape [n] each."""
    tilt = rod.tilts(q)
    gap = q[:, 2] - rod.half_length * np.sin(tilt) - rod.end_radius
    slip = rod.slips(q, u)
    return {"angle φ [deg]": np.degrees(tilt), "slip velocity [m/s]": slip, "gap of the lower end [mm]": 1e3 * gap}


def paradox(base: SlidingRod, run: Run) -> Figure:
    """Draw at which angles and friction coefficients a start has no contact force, and the bound in closed form."""
    angles = np.linspace(math.radians(25.0), math.radians(85.0), _ANGLES)
    starts = itertools.product(angles.tolist(), np.linspace(1.0, 2.0, _COEFFICIENTS).tolist())
    rods = [dataclasses.replace(base, tilt=tilt, friction=friction) for tilt, friction in starts]
    struck = np.array([run(rod).events.count(Cause.PAINLEVE) > 0 for rod in rods])
    places = np.array([(math.degrees(rod.tilt), rod.friction) for rod in rods])
    fine = np.linspace(angles[0], angles[-1], 400)
    bound = (3.0 * np.cos(fine) ** 2 + 1.0) / (3.0 * np.cos(fine) * np.sin(fine))
    figure, (ax,) = charts.panels(title="Sliding ahead, the rod has no contact force above the curve", size=(7.2, 4.8))
    closed_form = {"(1 + a cos²φ) / (a sinφ cosφ), a = 3": (np.degrees(fine), bound)}
    charts.comparison(closed_form, {}, "angle φ of the rod from the ground [deg]", "friction coefficient µ", ax=ax)
    squares = charts.marker(1) | {"markersize": 4}
    ax.plot(*places[struck].T, label="run: impact without collision", **squares)
    ax.plot(*places[~struck].T, ".", color="0.6", markersize=3, label="run: slides on")
    lowest = math.degrees(math.atan(2.0))
    arrow, text = {"arrowstyle": "->", "color": "black"}, (lowest - 8.0, 1.13)
    ax.annotate("4/3 at tan φ = 2", (lowest, 4.0 / 3.0), text, arrowprops=arrow, backgroundcolor="white", fontsize=9)
    ax.set_ylim(0.92, 2.05)
    charts.legend(figure)
    return figure
