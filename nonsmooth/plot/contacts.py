"""Plots of the gaps, velocities, forces and impulses of contacts over time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from nonsmooth.charts import marker, verbatim
from nonsmooth.plot.arguments import (
    Contacts,
    axes_of,
    beside,
    contacts_of,
    draw_lines,
    over_time,
    part_of,
    times_of,
    title_of,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from nonsmooth.solution.solution import Solution

_SEEN = 1e-6
"""Least extent of the gap axis above and below zero, relative to the smallest contact, so that round-off stays hidden.
"""


def gaps(
    solution: Solution, contacts: Contacts | None = None, ax: Axes | None = None, *, times: ArrayLike | None = None
) -> Axes:
    """Draw gaps [m] over time [s], one line for each contact; lines are interrupted while bodies are far apart.

    Parameters
    ----------
    solution : Solution
        The run.
    contacts : Contact, str, int or sequence of them, optional
        Contacts to draw; by default the eight contacts with most events.
    ax : Axes, optional
        Axes to draw on; by default the axes of a new figure.
    times : array, optional
        Times of the run [s], shape [n]; by default the times of samples and both sides of events.  Events are omitted
        if there are more than 2000.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    InvalidInput, UnknownName
        If the system has no contact, or not a given one, or a time is not within the run.
    """
    where, declared = "nonsmooth.plot.gaps", solution.system.contacts
    numbers, row = contacts_of(where, solution, contacts), times_of(where, solution, times)
    ax = axes_of(ax)
    draw_lines(ax, solution, numbers, row, solution.history("gap", times=row, of=numbers)["gap"])
    ax.axhline(0.0, color="0.4", linewidth=0.8)
    least, (low, high) = _SEEN * min(declared[number].size for number in numbers), ax.get_ylim()
    ax.set_ylim(min(low, -least), max(high, least))
    ax.set_ylabel("gap [m]")
    return ax


def velocities(
    solution: Solution,
    contacts: Contacts | None = None,
    ax: Axes | None = None,
    *,
    part: str = "normal",
    times: ArrayLike | None = None,
) -> Axes:
    """Draw velocities of contacts [m/s] over time [s].

    Parameters
    ----------
    solution, contacts, ax, times
        As for :func:`nonsmooth.plot.gaps`.
    part : str
        "normal" for the rate of the gap, "slip" for the slip speed.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    InvalidInput, UnknownName
        As for :func:`nonsmooth.plot.gaps`, or if ``part`` is another word.
    """
    where = "nonsmooth.plot.velocities"
    which = part_of(where, part, ("normal", "slip"))
    numbers, row = contacts_of(where, solution, contacts), times_of(where, solution, times)
    name, ax = ("normal_velocity", "slip_speed")[which], axes_of(ax)
    draw_lines(ax, solution, numbers, row, solution.history(name, times=row, of=numbers)[name])
    ax.axhline(0.0, color="0.4", linewidth=0.8)
    ax.set_ylabel(("normal velocity [m/s]", "slip speed [m/s]")[which])
    return ax


def forces(
    solution: Solution,
    contacts: Contacts | None = None,
    ax: Axes | None = None,
    *,
    part: str = "normal",
    times: ArrayLike | None = None,
) -> Axes:
    """Draw forces of closed contacts [N] over time [s]; impacts have impulses instead.

    Parameters
    ----------
    solution, contacts, ax
        As for :func:`nonsmooth.plot.gaps`.
    part : str
        "normal", or "friction" for the magnitude of friction.
    times : array, optional
        Times of the run [s], shape [n]; those of its samples and events by default.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    InvalidInput, UnknownName
        As for :func:`nonsmooth.plot.gaps`, or if ``part`` is another word.
    """
    where = "nonsmooth.plot.forces"
    which = part_of(where, part, ("normal", "friction"))
    numbers = contacts_of(where, solution, contacts)
    # take forces after each event: before an event that ends a mode, forces that are not unique may exceed their bounds
    row = times_of(where, solution, times, before=False)
    name = ("normal_force", "friction_force")[which]
    history, ax = solution.history("mode", name, times=row, of=numbers), axes_of(ax)
    size = np.linalg.norm(history[name], axis=2) if which else history[name]
    draw_lines(ax, solution, numbers, row, np.where(history["mode"] > 0, size, np.nan))
    ax.set_ylim(bottom=min(0.0, ax.get_ylim()[0]))
    ax.set_ylabel(("normal force [N]", "friction [N]")[which])
    return ax


def impulses(
    solution: Solution, contacts: Contacts | None = None, ax: Axes | None = None, *, part: str = "normal"
) -> Axes:
    """Draw the impulses of impacts [N s] as stems at their times [s].

    Parameters
    ----------
    solution, contacts, ax
        As for :func:`nonsmooth.plot.gaps`.
    part : str
        "normal", or "friction" for the magnitude of the tangential impulse.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    InvalidInput, UnknownName
        As for :func:`nonsmooth.plot.gaps`, or if ``part`` is another word.
    """
    where = "nonsmooth.plot.impulses"
    which = part_of(where, part, ("normal", "friction"))
    numbers, events = contacts_of(where, solution, contacts), solution.events
    ax, times = axes_of(ax), np.repeat(events.time, np.diff(events.first))
    size = (events.listed_impulse[:, 0], np.hypot(*events.listed_impulse[:, 1:].T))[which]
    for place, number in enumerate(numbers):
        struck = (events.listed == number) & (size > 0.0)
        style, name = marker(place), verbatim(solution.system.contacts[number].name)
        ax.vlines(times[struck], 0.0, size[struck], color=style["color"], linewidth=0.9)
        ax.plot(times[struck], size[struck], markersize=4, label=name, **style)
    over_time(ax, solution)
    ax.set_ylim(bottom=0.0)
    ax.set_ylabel(f"{part} impulse [N s]")
    beside(ax, title_of(numbers, solution))
    return ax
