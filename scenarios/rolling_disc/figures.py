"""How the disc settles, and its paths on the table."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from nonsmooth.solution.solution import Solution
from scenarios.rolling_disc import steady
from scenarios.rolling_disc.scenario import RollingDisc

if TYPE_CHECKING:
    from matplotlib.figure import Figure
Floats = NDArray[np.float64]

_STYLES = (("black", "-"), ("tab:blue", "-."))
_MOST_TURNS, _TURNS, _POINTS = 8.0, 3.0, 1500
"""Turns of the lowest point that a picture of its path can hold, those that are drawn of more, by so many points."""


def settling(runs: Mapping[str, tuple[RollingDisc, Solution]], title: str) -> Figure:
    """Draw the tilt over time, and the precession rate over the tilt, with the closed forms of the first disc."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9.6, 4.4), layout="constrained")
    time, rate = figure.subplots(1, 2)
    for (colour, line), (name, (scenario, solution)) in zip(_STYLES, runs.items(), strict=False):
        tilts = scenario.tilts(solution)
        time.plot(solution.t, tilts, color=colour, linestyle=line, linewidth=1.4, label=name)
        rate.plot(tilts, scenario.precession(solution), color=colour, linestyle=line, linewidth=1.4, label=name)
    scenario, solution = next(iter(runs.values()))
    theory = steady.settling(solution.t, scenario.tilt, scenario.radius, scenario.mass, scenario.viscosity)
    time.plot(solution.t, theory, color="tab:red", linewidth=1.2, linestyle=":", label=r"$\sin^3\alpha$ falls linearly")
    time.set_ylim(0.0, 1.1 * scenario.tilt)
    time.set_xlabel("time [s]")
    time.set_ylabel(r"tilt $\alpha$ [rad]")
    places = np.linspace(scenario.end_tilt, scenario.tilt, 200)
    exact = steady.precession(places, scenario.radius)
    rate.plot(places, exact, color="tab:red", linewidth=1.2, linestyle=":", label=r"$\Omega^2 \sin\alpha = 4 g / a$")
    rate.set_ylim(0.0, None)
    rate.set_xlabel(r"tilt $\alpha$ [rad]")
    rate.set_ylabel(r"precession rate $\Omega$ [rad/s]")
    for axis in (time, rate):
        axis.grid(color="0.9", linewidth=0.6)
        axis.set_axisbelow(True)
        axis.legend(fontsize=8, frameon=False)
    figure.suptitle(title, fontsize=11)
    return figure


def _lowest(scenario: RollingDisc, solution: Solution) -> tuple[Floats, str]:
    """Return the path of the lowest point [m, 2], and which part of it, where all of it would be a grey disc."""
    rates = scenario.precession(solution)
    turns = float(np.sum(np.diff(solution.t) * (rates[1:] + rates[:-1]))) / (4.0 * np.pi)
    if turns <= _MOST_TURNS or rates[-1] <= 0.0:
        return scenario.contact_points(solution.q, solution.u), ""
    start = max(float(solution.t[0]), solution.t_end - _TURNS * 2.0 * np.pi / float(rates[-1]))
    states = solution.at(np.linspace(start, solution.t_end, _POINTS))
    return scenario.contact_points(states["q"], states["u"]), f", last {_TURNS:g} turns"


def paths(runs: Mapping[str, tuple[RollingDisc, Solution]], title: str) -> Figure:
    """Draw the paths of the lowest point and of the centre, seen from above."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(3.4 * max(len(runs), 2), 4.2), layout="constrained")
    axes = np.ravel(figure.subplots(1, len(runs), sharex=True, sharey=True))
    for axis, (name, (scenario, solution)) in zip(axes, runs.items(), strict=True):
        contact, words = _lowest(scenario, solution)
        centre = 1e3 * solution.q[:, :2]
        axis.plot(*(1e3 * contact).T, color="0.6", linewidth=0.9, linestyle="--", label=f"lowest point{words}")
        axis.plot(*centre.T, color="tab:red", linewidth=1.2, label="centre")
        axis.plot(*centre[0], color="tab:red", marker="o", markersize=4, linestyle="none")
        axis.set_aspect("equal")
        axis.set_title(name, fontsize=9)
        axis.set_xlabel("x [mm]")
        axis.grid(color="0.9", linewidth=0.6)
        axis.set_axisbelow(True)
    axes[0].set_ylabel("y [mm]")
    figure.legend(*axes[0].get_legend_handles_labels(), fontsize=8, frameon=False, ncols=2, loc="outside lower center")
    figure.suptitle(title, fontsize=11)
    return figure
