"""Checks the arguments of plots (axes, times, contacts), and draws the parts that all plots over time share."""

from __future__ import annotations

from collections.abc import Sequence
from types import ModuleType
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from nonsmooth.charts import line, verbatim
from nonsmooth.errors import InvalidInput, MissingPackagesError
from nonsmooth.histories.arrays import Floats
from nonsmooth.histories.request import numbers_of, read_times
from nonsmooth.system.contact import Contact

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

    from nonsmooth.solution.solution import Solution

OneContact: TypeAlias = Contact | str | int
Contacts: TypeAlias = OneContact | Sequence[OneContact]
"""One or several contacts, each given as an object, by its name or by its number."""

MOST = 8
"""Largest number of contacts of a picture by default, so that their lines can be distinguished."""
_MOST_EVENTS = 2000
"""Largest number of events at which values just before and just after are drawn: more could not be distinguished."""


def pyplot() -> ModuleType:
    """Matplotlib's pyplot.

    Raises
    ------
    MissingPackagesError
        If matplotlib is not installed.
    """
    try:
        import matplotlib.pyplot
    except ImportError as error:
        raise MissingPackagesError('Pictures need matplotlib: pip install "nonsmooth[full]"') from error
    return matplotlib.pyplot


def axes_of(ax: Axes | None, height: float = 3.6) -> Axes:
    """The given axes, or the axes of a new figure of this height [inches]."""
    if ax is not None:
        return ax
    made: Axes = pyplot().subplots(layout="constrained", figsize=(7.2, height))[1]
    return made


def times_of(where: str, solution: Solution, times: ArrayLike | None, *, before: bool = True) -> Floats:
    """Times to draw [s], shape [n]: the given times, or the times of all samples and events in order.

    With ``before``, the last time before each event is added, so that jumps are drawn. With more than 2000 events, the
    times are only those of the samples.

    Raises
    ------
    InvalidInput
        If a given time is outside of the run.
    """
    if times is not None:
        return np.atleast_1d(read_times(where, solution, times))
    events = solution.events.time
    if len(events) > _MOST_EVENTS:
        return solution.t
    found = np.unique(np.concatenate([solution.t, events, [solution.t_end]]))
    if before:
        last = np.nextafter(events, -np.inf)
        found = np.union1d(found, last[last >= solution.track.time[0]])
    return found


def contacts_of(where: str, solution: Solution, contacts: Contacts | None, most: int = MOST) -> list[int]:
    """Numbers of the contacts to draw; by default the ``most`` contacts with the most events, in the system's order.

    Raises
    ------
    InvalidInput, UnknownName
        If there is no contact to draw, or the system does not have a given contact.
    """
    declared = solution.system.contacts
    if contacts is None:
        events = np.bincount(solution.events.listed, minlength=len(declared))
        found = sorted(np.argsort(-events, kind="stable")[:most].tolist())
    else:
        found = [*numbers_of(where, solution.system, ["contact"], contacts)["contact"]]
    if not found:
        raise InvalidInput(f"{where}: contacts", "must be some", found, "Take a system and a run that have contacts.")
    return found


def part_of(where: str, part: str, parts: Sequence[str]) -> int:
    """Index of ``part``, the quantity that the user wants to draw, in ``parts``.

    Raises
    ------
    InvalidInput
        If ``part`` is not in ``parts``.
    """
    if part not in parts:
        rule = f"must be {' or '.join(map(repr, parts))}"
        raise InvalidInput(f"{where}: part", rule, part, "One call draws one of them.")
    return parts.index(part)


def draw_lines(ax: Axes, solution: Solution, numbers: Sequence[int], times: Floats, values: Floats) -> None:
    """Draw values, shape [n, number of contacts], over times [s], with a legend; NaN interrupts a line."""
    for place, (number, value) in enumerate(zip(numbers, values.T, strict=True)):
        ax.plot(times, value, label=verbatim(solution.system.contacts[number].name), **line(place))
    over_time(ax, solution)
    beside(ax, title_of(numbers, solution))


def over_time(ax: Axes, solution: Solution) -> None:
    """Make the time of a run the horizontal axis."""
    ax.set_xlabel("time [s]")
    ax.set_xlim(float(solution.track.time[0]), solution.t_end)
    ax.grid(color="0.9", linewidth=0.6)
    ax.set_axisbelow(True)


def beside(ax: Axes, title: str = "", handles: Sequence[Artist] | None = None) -> None:
    """Put a legend to the right of the axes, or within the axes if the figure has no layout engine.

    A layout engine reserves space for a legend outside of the axes. ``handles`` are the artists that the legend lists;
    by default all artists with a label.
    """
    outside = {"loc": "upper left", "bbox_to_anchor": (1.0, 1.0), "frameon": False}
    place: dict[str, Any] = outside if ax.figure.get_layout_engine() is not None else {"loc": "best"}
    ax.legend(handles=handles, fontsize=8, title=title or None, title_fontsize=8, **place)


def title_of(numbers: Sequence[int], solution: Solution) -> str:
    """Title of a legend that does not list all contacts, such as "8 of 12 contacts"; "" if it lists all."""
    total = len(solution.system.contacts)
    return f"{len(numbers)} of {total} contacts" if len(numbers) < total else ""
