"""Pictures of sensitivities over time, and of fits."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from nonsmooth.charts import COLOURS, line, verbatim
from nonsmooth.plot.arguments import axes_of, pyplot
from nonsmooth.studies.derivatives.coordinates import coordinate_number, unit
from nonsmooth.studies.derivatives.forward import Sensitivity
from nonsmooth.studies.derivatives.least_squares import Fit, observed
from nonsmooth.studies.plotting import VERMILION, finish

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_FINE = 400
"""Points of a fitted curve."""
_PAIRS = 3
"""Largest number of pairs of parameters whose covariance is drawn."""
_LEVELS = ((1.0, "-"), (-2.0 * math.log(0.05), ":"))
"""Squared radius and line of each ellipse: one standard error, and 95 % (chi-squared distribution of two numbers)."""


def sensitivities(found: Sensitivity, coordinate: str, ax: Axes | None = None) -> Axes:
    """Draw the derivatives of a coordinate by each parameter, times the parameter, over time [s].

    All lines have the unit of the coordinate: a parameter larger by 1 % changes the coordinate by 1 % of the line.
    Lines are broken at events, at which derivatives jump.

    Parameters
    ----------
    found : Sensitivity
        The derivatives.
    coordinate : str
        Name of a coordinate or velocity, "vz" or "ball.vz".
    ax : Axes, optional
        The axes; of a new figure by default.

    Raises
    ------
    UnknownName
        If the system has no coordinate or velocity of this name.
    """
    ax, system = axes_of(ax), found.family.model().system
    number = coordinate_number(system, coordinate)
    by = np.concatenate([found.q_by, found.u_by], axis=1)[:, number]
    times = np.concatenate([found.t, found.events])
    order = np.argsort(times, kind="stable")
    for place, (name, change) in enumerate(zip(found.parameters, by.T, strict=True)):
        value = found.family[name]
        broken = np.concatenate([change * (abs(value) or 1.0), np.full(len(found.events), np.nan)])
        word = f"{found.family.label(name)} of {value:.4g}" if value else f"{found.family.label(name)} of 0, by 1"
        ax.plot(times[order], broken[order], marker=".", markersize=3, label=word, **line(place))
    ax.vlines(found.events, 0.0, 1.0, transform=ax.get_xaxis_transform(), color="0.75", linewidth=0.7, zorder=0)
    ax.set_xlim(0.0, float(found.t[-1]))
    title = f"Change of {coordinate} per relative change of a parameter; grey: events"
    return finish(ax, "time [s]", verbatim(f"change of {coordinate} [{unit(system, number)}]"), title, grid="y")


def fitted(found: Fit, label: str, columns: Sequence[str] = ()) -> Figure:
    """Draw measurements and fitted motion, their difference, and the covariance of the parameters.

    Parameters
    ----------
    found : Fit
        The fit.
    label : str
        The observable, with its unit.
    columns : sequence of str
        Names of the observables, if there are several.
    """
    pairs = list(itertools.combinations(found.values, 2))[:_PAIRS]
    figure: Figure = pyplot().figure(figsize=(7.2 + 3.2 * bool(pairs), 5.0), layout="constrained")
    grid = figure.add_gridspec(1, 1 + bool(pairs), width_ratios=(2.2, 1.2)[: 1 + bool(pairs)])
    left = grid[0].subgridspec(2, 1, height_ratios=(2.5, 1.0))
    upper = figure.add_subplot(left[0])
    _curves(upper, figure.add_subplot(left[1], sharex=upper), found, label, columns)
    if pairs:
        right = grid[1].subgridspec(len(pairs), 1)
        for place, (one, two) in enumerate(pairs):
            _covariance(figure.add_subplot(right[place]), found, one, two)
    return figure


def _curves(upper: Axes, lower: Axes, found: Fit, label: str, columns: Sequence[str]) -> None:
    fine = np.linspace(0.0, float(found.t[-1]), _FINE + 1)[1:]
    curves = observed(found.family.model(), fine, found.observe)
    for i, (curve, points, rest) in enumerate(
        zip(curves.T, found.measured.T, (found.measured - found.modelled).T, strict=True)
    ):
        colour, name = COLOURS[(i + 1) % len(COLOURS)], f"{columns[i]}, " if columns else ""
        upper.plot(fine, curve, color=colour, linewidth=1.2, label=f"{name}fitted")
        upper.plot(found.t, points, "o", color=colour, markersize=4, markerfacecolor="none", label=f"{name}measured")
        lower.plot(found.t, rest, "o", color=colour, markersize=3)
    lower.axhline(0.0, color="0.5", linewidth=0.8)
    lower.axhspan(-found.deviation, found.deviation, color="0.92", zorder=0)
    lower.ticklabel_format(axis="y", scilimits=(-2, 3))
    upper.tick_params(labelbottom=False)
    upper.legend(fontsize=8, frameon=False, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=4)
    rest = "".join(["measured - fitted ", *label.partition("[")[1:]]).strip()
    finish(upper, "", label, legend=False)
    finish(lower, "time [s]", rest, f"Standard deviation {found.deviation:.3g} (grey band)", legend=False)
    lower.yaxis.label.set_fontsize(9)


def _covariance(ax: Axes, found: Fit, one: str, two: str) -> None:
    names = list(found.values)
    numbers = [names.index(one), names.index(two)]
    lengths, ways = np.linalg.eigh(found.covariance[np.ix_(numbers, numbers)])
    angle = np.linspace(0.0, 2.0 * np.pi, 200)
    circle = ways @ (np.sqrt(np.maximum(lengths, 0.0))[:, None] * np.array([np.cos(angle), np.sin(angle)]))
    x, y = found.values[one], found.values[two]
    for level, style in _LEVELS:
        ax.plot(x + np.sqrt(level) * circle[0], y + np.sqrt(level) * circle[1], style, color="black")
    ax.errorbar(
        x, y, found.standard_errors[two], found.standard_errors[one], fmt="o", color=VERMILION, markersize=4, capsize=3
    )
    # the title has only the last part of dotted keys: the labels of the axes show the full keys
    words = {name: name.rpartition(".")[2] for name in (one, two)}
    lines = [f"{word} = {found.values[name]:.6g} ± {found.standard_errors[name]:.1g}" for name, word in words.items()]
    ax.locator_params(nbins=4)
    ax.ticklabel_format(useOffset=False)
    title = "\n".join([*lines, "full: one standard error; dotted: 95 %"])
    finish(ax, found.family.label(one), found.family.label(two), title, legend=False)
