"""The chart of modes: a lane for each contact, open, slip or stick."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from nonsmooth.charts import verbatim
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.histories.arrays import Floats, Integers
from nonsmooth.histories.replay import check_recorded
from nonsmooth.plot.arguments import Contacts, axes_of, beside, contacts_of, over_time, title_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from nonsmooth.solution.solution import Solution

_MOST = 24
_HIGH, _LANE = 0.76, 0.25
"""Height of a bar in its lane, and of a lane [inches]."""
_LOOKS = (("stick", Mode.STICK, "#0072b2", "////"), ("slip", Mode.SLIDE, "#e69f00", ""))
"""Words, mode, colour and hatch: they differ in lightness, too."""


def modes(solution: Solution, contacts: Contacts | None = None, ax: Axes | None = None) -> Axes:
    """Draw when which contact sticks, slips or is open, and strokes for its impacts, over time [s].

    Parameters
    ----------
    solution, ax
        As for :func:`nonsmooth.plot.gaps`.
    contacts : Contact, str, int or sequence of them, optional
        Which contacts; the busiest by default, twenty-four at most.

    Returns
    -------
    Axes
        The axes, with the first contact at the top.

    Raises
    ------
    InvalidInput, UnknownName
        If the system has no such contact, or none at all, or the engine records no modes.
    """
    check_recorded("nonsmooth.plot.modes", "modes", solution.system, solution.recorded.engine)
    numbers = contacts_of("nonsmooth.plot.modes", solution, contacts, _MOST)
    ax, events = axes_of(ax, 1.2 + _LANE * len(numbers)), solution.events
    edges = np.concatenate([solution.track.time[:1], events.time, [solution.t_end]])
    after = events.codes_after(np.arange(-1, len(events)))[:, numbers]
    found = np.where(after & 1 == 0, Mode.OPEN, np.where(after >> 2 & 1, Mode.SLIDE, Mode.STICK))
    times = np.repeat(events.time, np.diff(events.first))
    for lane, number in enumerate(numbers):
        ax.axhline(lane, color="0.8", linewidth=0.8, zorder=1)
        for _, mode, colour, hatch in _LOOKS:
            ax.broken_barh(
                _spans(edges, found[:, lane] == mode), (lane - _HIGH / 2, _HIGH), facecolor=colour, hatch=hatch,
                edgecolor="white", linewidth=0.0, zorder=2,
            )  # fmt: skip
        struck = times[(events.listed == number) & (events.listed_impulse[:, 0] > 0.0)]
        ax.vlines(struck, lane - 0.5, lane + 0.5, color="black", linewidth=0.7, zorder=3)
    names = [verbatim(solution.system.contacts[number].name) for number in numbers]
    ax.set_yticks(range(len(numbers)), names, fontsize=8)
    ax.set_ylim(len(numbers) - 0.4, -0.6)
    over_time(ax, solution)
    ax.grid(visible=False, axis="y")
    _explain(ax, title_of(numbers, solution))
    return ax


def _spans(edges: Floats, holds: Integers) -> list[tuple[float, float]]:
    """Begin and length [s] of each span in which a mode holds; adjoining spans are merged."""
    turns = np.flatnonzero(np.diff(np.concatenate([[False], holds, [False]]).astype(np.int64)))
    begins, ends = edges[turns[::2]], edges[turns[1::2]]
    return [(float(begin), float(end - begin)) for begin, end in zip(begins, ends, strict=True) if end > begin]


def _explain(ax: Axes, title: str) -> None:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    known = [Patch(facecolor=c, hatch=h, edgecolor="white", linewidth=0.0, label=word) for word, _, c, h in _LOOKS]
    open_ = Line2D([], [], color="0.8", linewidth=0.8, label="open")
    impact = Line2D([], [], color="black", linestyle="none", marker="|", markersize=9, label="impact")
    beside(ax, title, [*known, open_, impact])
