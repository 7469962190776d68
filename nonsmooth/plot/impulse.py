"""Impulses of contacts, at the instants of their impacts."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from nonsmooth.charts import marker
from nonsmooth.plot.asked import Contacts, axes_of, contacts_of, part_of
from nonsmooth.plot.lines import beside, over_time, title_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from nonsmooth.solution.solution import Solution

_WHERE = "nonsmooth.plot.impulses"


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
        As for :func:`nonsmooth.plot.gaps`, or if there is no such part.
    """
    which = part_of(_WHERE, part, ("normal", "friction"))
    numbers, events = contacts_of(_WHERE, solution, contacts), solution.events
    ax, times = axes_of(ax), np.repeat(events.time, np.diff(events.first))
    size = (events.listed_impulse[:, 0], np.hypot(*events.listed_impulse[:, 1:].T))[which]
    for place, number in enumerate(numbers):
        struck = (events.listed == number) & (size > 0.0)
        style, name = marker(place), solution.system.contacts[number].name
        ax.vlines(times[struck], 0.0, size[struck], color=style["color"], linewidth=0.9)
        ax.plot(times[struck], size[struck], markersize=4, label=name, **style)
    over_time(ax, solution)
    ax.set_ylim(bottom=0.0)
    ax.set_ylabel(f"{part} impulse [N s]")
    beside(ax, title_of(numbers, solution))
    return ax
