"""Lines over time, one for each contact, told apart by their dashes as well as by their colours."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from nonsmooth.charts import line
from nonsmooth.histories.arrays import Floats

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

    from nonsmooth.solution.solution import Solution


def draw_lines(ax: Axes, solution: Solution, numbers: Sequence[int], times: Floats, values: Floats) -> None:
    """Draw values [n, one for each contact] over time, with a legend; what is not a number is left out."""
    for place, (number, value) in enumerate(zip(numbers, values.T, strict=True)):
        ax.plot(times, value, label=solution.system.contacts[number].name, **line(place))
    over_time(ax, solution)
    beside(ax, title_of(numbers, solution))


def over_time(ax: Axes, solution: Solution) -> None:
    """Let the axes be those of the time of a run."""
    ax.set_xlabel("time [s]")
    ax.set_xlim(float(solution.track.time[0]), solution.t_end)
    ax.grid(color="0.9", linewidth=0.6)
    ax.set_axisbelow(True)


def beside(ax: Axes, title: str = "", handles: Sequence[Artist] | None = None) -> None:
    """Put the legend beside the axes, where it covers no curve; within them where the figure makes no room for it."""
    outside = {"loc": "upper left", "bbox_to_anchor": (1.0, 1.0), "frameon": False}
    place: dict[str, Any] = outside if ax.figure.get_layout_engine() is not None else {"loc": "best"}
    ax.legend(handles=handles, fontsize=8, title=title or None, title_fontsize=8, **place)


def title_of(numbers: Sequence[int], solution: Solution) -> str:
    """Return what a legend says where it has not all contacts."""
    total = len(solution.system.contacts)
    return f"{len(numbers)} of {total} contacts" if len(numbers) < total else ""
