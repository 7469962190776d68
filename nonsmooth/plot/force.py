"""Forces that closed contacts bear over time, between events."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from nonsmooth.plot.asked import Contacts, axes_of, contacts_of, part_of, times_of
from nonsmooth.plot.lines import draw_lines

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from nonsmooth.solution.solution import Solution

_WHERE = "nonsmooth.plot.forces"


def forces(
    solution: Solution,
    contacts: Contacts | None = None,
    ax: Axes | None = None,
    *,
    part: str = "normal",
    times: ArrayLike | None = None,
) -> Axes:
    """Draw forces of contacts [N] over time [s], where they are closed; impacts have none, but impulses.

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
        As for :func:`nonsmooth.plot.gaps`, or if there is no such part.
    """
    which = part_of(_WHERE, part, ("normal", "friction"))
    numbers = contacts_of(_WHERE, solution, contacts)
    # at the end of a mode forces that are not unique may be off their bounds, which is why it ends
    row = times_of(_WHERE, solution, times, before=False)
    name = ("normal_force", "friction_force")[which]
    history, ax = solution.history("mode", name, times=row, of=numbers), axes_of(ax)
    size = np.linalg.norm(history[name], axis=2) if which else history[name]
    draw_lines(ax, solution, numbers, row, np.where(history["mode"] > 0, size, np.nan))
    ax.set_ylim(bottom=min(0.0, ax.get_ylim()[0]))
    ax.set_ylabel(("normal force [N]", "friction [N]")[which])
    return ax
