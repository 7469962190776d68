"""Regimes and speeds over Gamma, the path on the plate, and the last bounces."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, TypeAlias, cast

import numpy as np
from numpy.typing import NDArray

from nonsmooth import charts
from nonsmooth.errors import RunFailed
from nonsmooth.interfaces import Run
from nonsmooth.solution.solution import Solution

from .motion import GRAVITY

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from .scenario import BouncingTrimer

Floats = NDArray[np.float64]
Ran: TypeAlias = "tuple[BouncingTrimer, Solution]"

_SHOWN = 10.0
"""Plate periods of a motion that are drawn."""
_LINEAR = 1e-2
"""Value below which the logarithmic axes are linear, in the unit of the axis: a trimer at rest gives zeros."""


def survey(
    scenario: BouncingTrimer, gammas: Iterable[float], frequencies: Iterable[float], periods: float, run: Run
) -> list[Ran]:
    """Run a scenario over ``periods`` plate periods at every pair of frequency [Hz] and Gamma.

    A run that fails gives the solution up to its failure.
    """
    shaken = [dataclasses.replace(scenario, frequency=f, t_end=periods / f) for f in frequencies]
    cases = [dataclasses.replace(one, gamma=gamma) for one in shaken for gamma in gammas]
    return [(one, _finished(one, run)) for one in cases]


def _finished(scenario: BouncingTrimer, run: Run) -> Solution:
    """Return the solution of a run, up to its failure if it fails, so that one failure does not stop the survey."""
    try:
        return run(scenario)
    except RunFailed as error:
        return cast("Solution", error.solution)


def regimes(runs: list[Ran]) -> Figure:
    """Draw gap, speed and turning rate over Gamma, with a marker for each run, and a circle if the trimer tumbles.

    Gamma is the peak acceleration of the plate over gravity.
    """
    title = "It rests, bounces level, wanders and turns, and at last tumbles, as Γ grows"
    figure, axes = charts.panels(3, 1, title, (7.2, 7.2), sharex=True)
    circle: dict[str, Any] = {"marker": "o", "markersize": 9, "fillstyle": "none", "linestyle": "none", "color": "0.4"}
    for place, frequency in enumerate(sorted({one.frequency for one, _ in runs})):
        mine = [ran for ran in runs if ran[0].frequency == frequency]
        gammas, values = np.array([one.gamma for one, _ in mine]), np.array([_scaled(*ran) for ran in mine])
        tumbling = np.array([one.summarise(run)["attractor"] == "tumbling" for one, run in mine])
        style = charts.marker(place) | {"markersize": 4, "linestyle": "-", "linewidth": 0.8, "fillstyle": "full"}
        for ax, column in zip(axes, values.T, strict=True):
            ax.plot(gammas, column, label=f"{frequency:g} Hz", **style)
            ax.plot(gammas[tumbling], column[tumbling], **circle)
    axes[0].plot([], [], label="turns over", **circle)
    ended = [one.gamma for one, run in runs if run.status != "done"]
    if ended:
        axes[0].plot(ended, [0.0] * len(ended), "x", color="0.4", label="run ended early")
    labels = "largest gap · (f / 50 Hz)² [mm]", "speed along the path\n/ (g / f)", "turning rate · spacing\n/ (g / f)"
    for ax, label in zip(axes, labels, strict=True):
        ax.set_ylabel(label)
        ax.set_yscale("symlog", linthresh=_LINEAR)
        ax.set_ylim(0.0, 2.0 * max(_LINEAR, ax.dataLim.y1))
    axes[-1].set_xlabel("peak acceleration of the plate over gravity Γ")
    charts.legend(figure, columns=4)
    return figure


def _scaled(scenario: BouncingTrimer, solution: Solution) -> tuple[float, float, float]:
    """Return the largest gap [mm at 50 Hz], speed / (g / f) and turning rate * spacing / (g / f).

    Scaled in this way, results at different frequencies f can be compared.
    """
    numbers, frequency = scenario.summarise(solution), scenario.frequency
    speed, gap = GRAVITY / frequency, 1e3 * numbers["largest_gap"] * (frequency / 50.0) ** 2
    return gap, numbers["wandering"] / speed, numbers["turning"] * scenario.spacing / speed


def path(scenario: BouncingTrimer, solution: Solution) -> Figure:
    """Draw the path of the mass centre over the plate, and the triangle at the start and at the end."""
    place = 1e3 * scenario.motion(solution).place
    apart, length = np.hypot(*(place[-1] - place[0])), np.sum(np.hypot(*np.diff(place, axis=0).T))
    words = f"Γ = {scenario.gamma:g}, {scenario.frequency:g} Hz"
    title = f"A path of {length:.0f} mm in {solution.t_end:g} s leads {apart:.0f} mm away ({words})"
    figure, (ax,) = charts.panels(title=title, size=(6.0, 6.0))
    ax.plot(*place.T, color="black", linewidth=0.8, label="mass centre")
    for i, (q, label) in enumerate(((solution.q[0], "start"), (solution.q_end, "end")), 1):
        style = charts.line(i) | {"linewidth": 1.0}
        _triangle(ax, 1e3 * scenario.centres(q)[:, :2], 1e3 * scenario.radius, style, label)
    ax.set(aspect="equal", xlabel="x [mm]", ylabel="y [mm]")
    charts.legend(figure)
    return figure


def _triangle(ax: Axes, corners: Floats, radius: float, style: dict[str, Any], label: str) -> None:
    """Draw the balls and the lines between their centres."""
    from matplotlib.patches import Circle

    ax.plot(*np.vstack([corners, corners[:1]]).T, label=label, **style)
    for corner in corners:
        ax.add_patch(Circle((float(corner[0]), float(corner[1])), radius, fill=False, **style))
        ax.update_datalim([corner - radius, corner + radius])


def last_bounces(scenario: BouncingTrimer, solution: Solution) -> Figure:
    """Draw the three gaps over the last plate periods, at samples and events."""
    begin, events = max(0.0, solution.t_end - _SHOWN / scenario.frequency), solution.events
    t, q = np.concatenate([solution.t, events.time]), np.vstack([solution.q, events.q])
    order = np.argsort(t, kind="stable")
    order = order[t[order] >= begin]
    periods, gaps = (t[order] - begin) * scenario.frequency, 1e3 * scenario.gaps(t[order], q[order])
    curves = {f"ball {i + 1}": (periods, gap) for i, gap in enumerate(gaps.T)}
    attractor = scenario.summarise(solution)["attractor"]
    claim = {"irregular": "The balls meet the plate one by one"}.get(attractor, f"Attractor: {attractor}")
    title = f"{claim} (Γ = {scenario.gamma:g}, {scenario.frequency:g} Hz)"
    return charts.histories({"gap between ball and plate [mm]": curves}, title, xlabel="time [plate periods]")
