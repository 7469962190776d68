"""Pictures of orbits: multipliers and the unit circle, branches along a parameter."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from nonsmooth.charts import verbatim
from nonsmooth.plot.arguments import axes_of
from nonsmooth.studies.orbits.branch import Branch
from nonsmooth.studies.orbits.periodic import Orbit
from nonsmooth.studies.plotting import BLUE, MARKS, VERMILION, few_ticks, finish

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def multipliers(orbit: Orbit, ax: Axes | None = None) -> Axes:
    """Draw the Floquet multipliers of an orbit and the unit circle.

    Parameters
    ----------
    orbit : Orbit
        The orbit.
    ax : Axes, optional
        The axes; of a new figure by default.
    """
    ax, values = axes_of(ax), orbit.multipliers
    angle = np.linspace(0.0, 2.0 * np.pi, 200)
    ax.plot(np.cos(angle), np.sin(angle), color="0.5", linewidth=0.8)
    inside = np.abs(values) < 1.0
    for which, mark, colour, word in (
        (inside, "o", BLUE, "inside: dies out"),
        (~inside, "X", VERMILION, "outside: grows"),
    ):
        if np.any(which):
            ax.plot(values.real[which], values.imag[which], mark, color=colour, label=word)
    ax.set_aspect("equal")
    title = f"The largest multiplier is {np.max(np.abs(values), initial=0.0):.4g}"
    return finish(ax, "real part [1]", "imaginary part [1]", title)


def branch(found: Branch, shown: Callable[[Orbit], float], label: str, ax: Axes | None = None) -> Axes:
    """Draw a quantity of the orbits of a branch over its parameter: stable orbits in full, unstable ones dashed.

    Parameters
    ----------
    found : Branch
        The branch.
    shown : callable
        ``shown(orbit)`` returns the quantity.
    label : str
        Name of the quantity with its unit.
    ax : Axes, optional
        The axes; of a new figure by default.
    """
    ax = axes_of(ax)
    heights = np.array([shown(orbit) for orbit in found.orbits])
    stable = np.array([orbit.stable for orbit in found.orbits])
    # draw a segment dashed if at least one of its ends is an unstable orbit: `wide` also marks the stable neighbours
    for which, style, word in ((stable, "-", "stable"), (~stable, "--", "unstable")):
        wide = which if style == "-" else which | np.roll(which, 1) | np.roll(which, -1)
        if np.any(which):
            ax.plot(found.values, np.where(wide, heights, np.nan), style, color="black", linewidth=1.3, label=word)
    for kind, mark in MARKS.items():
        points = [one for one in found.special if one.kind == kind]
        if points:
            word = f"{kind} at {', '.join(f'{one.value:.6g}' for one in points)}"
            places = [one.value for one in points], [shown(one.orbit) for one in points]
            ax.plot(*places, mark, color=VERMILION, label=word)
    few_ticks(ax)
    return finish(ax, found.orbits[0].family.label(found.name), verbatim(label))
