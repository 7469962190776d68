"""How the disc settles, and its paths on the table."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from nonsmooth import charts
from nonsmooth.solution.solution import Solution

from . import steady

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from .scenario import RollingDisc

Floats = NDArray[np.float64]

_MOST_TURNS = 8.0
"""Turns of the lowest point up to which its whole path is drawn; more turns would fill the figure with grey."""
_TURNS, _POINTS = 3.0, 1500
"""Number of turns at the end of a longer path that are drawn, and number of points of these turns, respectively."""
_THEORY: dict[str, Any] = charts.line(2) | {"linestyle": ":"}


def settling(runs: Mapping[str, tuple[RollingDisc, Solution]], title: str) -> Figure:
    """Draw the tilt over time, and the precession rate over the tilt, with the closed forms of the first disc."""
    figure, (time, rate) = charts.panels(1, 2, title, (9.6, 4.6))
    tilts = {name: (run.t, disc.tilts(run)) for name, (disc, run) in runs.items()}
    rates = {name: (disc.tilts(run), disc.precession(run)) for name, (disc, run) in runs.items()}
    charts.histories({r"tilt $\alpha$ [rad]": tilts}, axes=[time])
    charts.comparison(rates, {}, r"tilt $\alpha$ [rad]", r"precession rate $\Omega$ [rad/s]", ax=rate)
    disc, run = next(iter(runs.values()))
    theory = steady.settling(run.t, disc.tilt, disc.radius, disc.mass, disc.viscosity)
    time.plot(run.t, theory, label=r"$\sin^3\alpha$ falls linearly", **_THEORY)
    time.set_ylim(0.0, 1.1 * disc.tilt)
    places = np.linspace(disc.end_tilt, disc.tilt, 200)
    rate.plot(places, steady.precession(places, disc.radius), label=r"$\Omega^2 \sin\alpha = 4 g / a$", **_THEORY)
    rate.set_ylim(0.0, None)
    for ax in (time, rate):
        ax.legend(fontsize=8, frameon=False)
    return figure


def paths(runs: Mapping[str, tuple[RollingDisc, Solution]], title: str) -> Figure:
    """Draw the paths of the lowest point and of the centre, seen from above."""
    size = (3.4 * max(len(runs), 2), 4.2)
    figure, axes = charts.panels(1, len(runs), title, size, sharex=True, sharey=True)
    for ax, (name, (disc, run)) in zip(axes, runs.items(), strict=True):
        lowest, words = _lowest(disc, run)
        ax.plot(*(1e3 * lowest).T, color="0.6", linewidth=0.9, linestyle="--", label=f"lowest point{words}")
        x, y = 1e3 * run.q[:, :2].T
        charts.portrait({"centre": (x, y)}, "x [mm]", "y [mm]" if ax is axes[0] else "", ax=ax)
        ax.set_aspect("equal")
        ax.set_title(name, fontsize=9)
    charts.legend(figure)
    return figure


def _lowest(disc: RollingDisc, run: Solution) -> tuple[Floats, str]:
    """Return the path of the lowest point [m], shape [n, 2], and the text that ends its label.

    Of a path with many turns only the last turns are returned; the text gives their number.
    """
    rates = disc.precession(run)
    turns = float(np.sum(np.diff(run.t) * (rates[1:] + rates[:-1]))) / (4.0 * np.pi)
    if turns <= _MOST_TURNS or rates[-1] <= 0.0:
        return disc.contact_points(run.q, run.u), ""
    start = max(float(run.t[0]), run.t_end - _TURNS * 2.0 * np.pi / float(rates[-1]))
    states = run.at(np.linspace(start, run.t_end, _POINTS))
    return disc.contact_points(states["q"], states["u"]), f", last {_TURNS:g} turns"
