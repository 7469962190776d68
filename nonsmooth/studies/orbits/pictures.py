"""Pictures of orbits: multipliers and the unit circle, branches along a parameter."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from nonsmooth.plot.arguments import axes_of
from nonsmooth.plot.lines import beside
from nonsmooth.studies.orbits.branch import Branch
from nonsmooth.studies.orbits.periodic import Orbit

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_MARKS = {"fold": "s", "period doubling": "D", "Neimark-Sacker": "^", "grazing": "v", "corner": "*", "sequence": "X"}


def multipliers(orbit: Orbit, ax: Axes | None = None) -> Axes:
    """Draw the Floquet multipliers of an orbit and the unit circle.

    Parameters
    ----------
    orbit : Orbit
        The orbit.
    ax : Axes, optional
        Where; a new figure by default.

    Returns
    -------
    Axes
        The axes.
    """
    ax = axes_of(ax)
    angle = np.linspace(0.0, 2.0 * np.pi, 200)
    ax.plot(np.cos(angle), np.sin(angle), color="0.5", linewidth=0.8)
    values = orbit.multipliers
    inside = np.abs(values) < 1.0
    for which, mark, colour, word in (
        (inside, "o", "#0072b2", "inside: dies out"),
        (~inside, "X", "#d55e00", "outside: grows"),
    ):
        if np.any(which):
            ax.plot(values.real[which], values.imag[which], mark, color=colour, label=word)
    ax.set_aspect("equal")
    ax.set_xlabel("real part [1]")
    ax.set_ylabel("imaginary part [1]")
    ax.set_title(f"The largest multiplier is {np.max(np.abs(values), initial=0.0):.4g}", fontsize=10)
    ax.grid(color="0.9", linewidth=0.6)
    ax.set_axisbelow(True)
    beside(ax)
    return ax


def branch(found: Branch, shown: Callable[[Orbit], float], label: str, ax: Axes | None = None) -> Axes:
    """Draw a number of the orbits of a branch over its parameter, what is stable in full, the rest dashed.

    Parameters
    ----------
    found : Branch
        The branch.
    shown : callable
        ``shown(orbit)`` returns the number.
    label : str
        What it is, with its unit.
    ax : Axes, optional
        Where; a new figure by default.

    Returns
    -------
    Axes
        The axes.
    """
    ax = axes_of(ax)
    heights = np.array([shown(orbit) for orbit in found.orbits])
    stable = np.array([orbit.stable for orbit in found.orbits])
    # a piece belongs to both of its ends: what joins a stable orbit and an unstable one is dashed
    for which, style, word in ((stable, "-", "stable"), (~stable, "--", "unstable")):
        wide = which if style == "-" else which | np.roll(which, 1) | np.roll(which, -1)
        if np.any(which):
            ax.plot(found.values, np.where(wide, heights, np.nan), style, color="black", linewidth=1.3, label=word)
    for kind, mark in _MARKS.items():
        points = [one for one in found.special if one.kind == kind]
        if points:
            values = [f"{one.value:.6g}" for one in points]
            ax.plot(
                [one.value for one in points],
                [shown(one.orbit) for one in points],
                mark,
                color="#d55e00",
                label=f"{kind} at {', '.join(values)}",
            )
    ax.set_xlabel(found.orbits[0].family.label(found.name))
    ax.locator_params(axis="x", nbins=6)  # labels of eight characters fit
    ax.set_ylabel(label)
    ax.grid(color="0.9", linewidth=0.6)
    ax.set_axisbelow(True)
    beside(ax)
    return ax
