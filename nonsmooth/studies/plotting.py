"""Set-up of the pictures of studies: figure, axes, colours, marks, legends, labels."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any, Literal

from nonsmooth.charts import COLOURS
from nonsmooth.plot.arguments import beside

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

_, VERMILION, BLUE, GREEN = COLOURS[:4]
MARKS = {
    "fold": "s",
    "period doubling": "D",
    "Neimark-Sacker": "^",
    "grazing": "v",
    "simultaneous impacts": "*",
    "sequence": "X",
}
"""Mark of matplotlib for each kind of special point of a branch."""
HATCHED: dict[str, Any] = {"edgecolor": "0.6", "hatch": "xxx", "linewidth": 0.0}
"""Style of the areas of a map that show runs without records, such as failed runs."""
DOTTED: dict[str, Any] = {"linewidth": 0.9, "linestyle": ":"}
"""Style of the vertical lines at parameter values of runs without records, such as failed runs."""
MOST_CLASSES = 12
"""Largest number of classes that one picture distinguishes."""
_TITLE, _TICKS = 10, 6
"""Size of a title [pt], and largest number of ticks of an axis: labels of eight characters then fit."""


def finish(
    ax: Axes,
    x: str,
    y: str,
    title: str = "",
    *,
    grid: Literal["both", "y", ""] = "both",
    legend: bool | Sequence[Artist] = True,
) -> Axes:
    """Label axes, and add grid and legend.

    Parameters
    ----------
    ax : Axes
        The axes.
    x, y : str
        Labels with units; an empty label changes nothing.
    title : str
        Title: the result that the picture shows.
    grid : str
        Axes with grid lines behind all else: "both", "y" or "".
    legend : bool or sequence of Artist
        True for a legend beside the axes, False for none, or its entries.
    """
    if x:
        ax.set_xlabel(x)
    if y:
        ax.set_ylabel(y)
    ax.set_title(title, fontsize=_TITLE)
    if grid:
        ax.grid(color="0.9", linewidth=0.6, axis=grid)
        ax.set_axisbelow(True)
    if legend:
        beside(ax, handles=None if legend is True else legend)
    return ax


def few_ticks(ax: Axes) -> None:
    """Limit the number of ticks along x, so that their labels fit."""
    ax.locator_params(axis="x", nbins=_TICKS)


def dotted(ax: Axes, values: Iterable[float], colour: str = VERMILION) -> None:
    """Draw vertical lines at values of runs that failed."""
    for value in values:
        ax.axvline(value, color=colour, **DOTTED)


def with_unit(name: str, unit: str) -> str:
    """Return a label: the name with its unit, if it has one."""
    return f"{name} [{unit}]" if unit not in ("", "1") else name


def class_colours(n: int) -> list[str]:
    """Return a colour for each of n classes: first the colours used for lines, then hues of a colour map."""
    # black comes last: black areas would dominate the others
    first, more = (*COLOURS[1:], COLOURS[0]), n - len(COLOURS)
    if more <= 0:
        return list(first[:n])
    from matplotlib import colormaps
    from matplotlib.colors import to_hex

    return [*first, *(to_hex(colour) for colour in colormaps["turbo"].resampled(more)(range(more)))]
