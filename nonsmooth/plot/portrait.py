"""The phase portrait of a coordinate."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from nonsmooth.charts import verbatim
from nonsmooth.errors import UnknownName
from nonsmooth.histories.arrays import Floats, Integers
from nonsmooth.plot.arguments import axes_of, beside, times_of
from nonsmooth.system.names import labels

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from nonsmooth.solution.solution import Solution

_WHERE = "nonsmooth.plot.phase_portrait"


def phase_portrait(
    solution: Solution, coordinate: str, ax: Axes | None = None, *, times: ArrayLike | None = None
) -> Axes:
    """Draw the rate of a coordinate over the coordinate; jumps at events are dotted.

    Parameters
    ----------
    solution, ax, times
        As for :func:`nonsmooth.plot.gaps`.
    coordinate : str
        Name of body and coordinate, such as "ball z".  ``solution.history("q").labels["coordinate"]`` lists them.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    UnknownName, InvalidInput
        If the system has no such coordinate, or a time is not within the run.
    """
    known = {name: (number, unit) for number, (_, name, unit) in enumerate(labels(solution.system).coordinates)}
    if coordinate not in known:
        raise UnknownName(f"{_WHERE}: coordinate", coordinate, known)
    number, unit = known[coordinate]
    row = times_of(_WHERE, solution, times)
    x, y = (history[:, number] for history in solution.history("q", "coordinate_rate", times=row).values())
    ax = axes_of(ax)
    jumps = np.flatnonzero(np.isin(row[1:], solution.events.time) & (row[:-1] == np.nextafter(row[1:], -np.inf)))
    ax.plot(np.insert(x, jumps + 1, np.nan), np.insert(y, jumps + 1, np.nan), color="black", linewidth=1.2)
    if len(jumps) > 0:
        ax.plot(_ways(x, jumps), _ways(y, jumps), color="#d55e00", linewidth=1.0, linestyle=":", label="event")
    ax.plot(*_first(x, y), linestyle="none", marker="o", fillstyle="none", color="black", label="start")
    ax.set_xlabel(verbatim(f"{coordinate} [{unit}]"))
    ax.set_ylabel(f"its rate [{'1/s' if unit == '1' else f'{unit}/s'}]")
    ax.grid(color="0.9", linewidth=0.6)
    ax.set_axisbelow(True)
    beside(ax)
    return ax


def _ways(values: Floats, jumps: Integers) -> Floats:
    """Values before and after each jump, separated by NaN, so that each jump becomes a line of its own."""
    return np.column_stack([values[jumps], values[jumps + 1], np.full(len(jumps), np.nan)]).ravel()


def _first(x: Floats, y: Floats) -> tuple[Floats, Floats]:
    return x[:1], y[:1]
