"""Gaps of contacts over time."""

from __future__ import annotations

from typing import TYPE_CHECKING

from numpy.typing import ArrayLike

from nonsmooth.plot.asked import Contacts, axes_of, contacts_of, times_of
from nonsmooth.plot.lines import draw_lines

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from nonsmooth.solution.solution import Solution

_WHERE = "nonsmooth.plot.gaps"
_SEEN = 1e-6
"""Part of the smallest shape that the axes show at least."""


def gaps(
    solution: Solution, contacts: Contacts | None = None, ax: Axes | None = None, *, times: ArrayLike | None = None
) -> Axes:
    """Draw gaps [m] over time [s], one line for each contact; there is none where its bodies are far apart.

    Parameters
    ----------
    solution : Solution
        The run.
    contacts : Contact, str, int or sequence of them, optional
        Which contacts; the busiest by default, eight at most.
    ax : Axes, optional
        Where to; axes of a new figure by default.
    times : array, optional
        Times of the run [s], shape [n]; by default those of its samples and both sides of its events, if there are no
        more than 2000 of these.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    InvalidInput, UnknownName
        If the system has no such contact, or none at all, or a time is not within the run.
    """
    numbers, row = contacts_of(_WHERE, solution, contacts), times_of(_WHERE, solution, times)
    ax, declared = axes_of(ax), solution.system.contacts
    draw_lines(ax, solution, numbers, row, solution.history("gap", times=row, of=numbers)["gap"])
    ax.axhline(0.0, color="0.4", linewidth=0.8)
    # what a closed contact is apart by round-off is no motion to be seen
    least, (low, high) = _SEEN * min(declared[number].size for number in numbers), ax.get_ylim()
    ax.set_ylim(min(low, -least), max(high, least))
    ax.set_ylabel("gap [m]")
    return ax
