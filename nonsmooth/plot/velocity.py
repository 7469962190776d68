"""Velocities of contacts over time: along the normal, or of slip."""

from __future__ import annotations

from typing import TYPE_CHECKING

from numpy.typing import ArrayLike

from nonsmooth.plot.asked import Contacts, axes_of, contacts_of, part_of, times_of
from nonsmooth.plot.lines import draw_lines

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from nonsmooth.solution.solution import Solution

_WHERE = "nonsmooth.plot.velocities"


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
        "normal" for the rate of the gap, "slip" for the speed across the normal.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    InvalidInput, UnknownName
        As for :func:`nonsmooth.plot.gaps`, or if there is no such part.
    """
    which = part_of(_WHERE, part, ("normal", "slip"))
    numbers, row = contacts_of(_WHERE, solution, contacts), times_of(_WHERE, solution, times)
    name, ax = ("normal_velocity", "slip_speed")[which], axes_of(ax)
    draw_lines(ax, solution, numbers, row, solution.history(name, times=row, of=numbers)[name])
    ax.axhline(0.0, color="0.4", linewidth=0.8)
    ax.set_ylabel(("normal velocity [m/s]", "slip speed [m/s]")[which])
    return ax
