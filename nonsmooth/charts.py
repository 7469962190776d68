"""Charts of arrays, as scenarios and papers show them: histories, phase portraits, comparisons, tables.

A curve is a pair (x, y) of arrays.  Charts take curves by their label in the legend, and return a figure whose
``axes`` can be drawn on further.  Pictures of a :class:`nonsmooth.Solution` itself are in :mod:`nonsmooth.plot`.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Curves: TypeAlias = Mapping[str, tuple[ArrayLike, ArrayLike]]
"""Curves by their label in the legend; an empty label has no entry there."""

COLOURS = ("#000000", "#d55e00", "#0072b2", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#7f7f7f")
"""Colours that colour-blind readers can distinguish (Okabe and Ito, 2008)."""
_DASHES = ("-", "--", "-.", ":", (0, (6, 1)), (0, (3, 1, 1, 1)), (0, (1, 1)), (0, (8, 3)))
_MARKERS = "osD^v<>p"


def verbatim(text: str) -> str:
    """Text for a label of matplotlib that shows it as it is: two dollar signs would make a formula of it."""
    return text.replace("$", r"\$")


def line(place: int) -> dict[str, Any]:
    """Line style of entry number ``place`` of a legend; styles differ in dashes as well as in colour."""
    turn, which = divmod(place, len(COLOURS))
    return {"color": COLOURS[which], "linestyle": _DASHES[which], "linewidth": 1.3 + 0.9 * turn}


def marker(place: int) -> dict[str, Any]:
    """Style of the open markers of entry number ``place`` of a legend; styles differ in shape as well as in colour."""
    which = place % len(COLOURS)
    return {"color": COLOURS[which], "marker": _MARKERS[which], "linestyle": "none", "fillstyle": "none"}


def panels(
    rows: int = 1, columns: int = 1, title: str = "", size: tuple[float, float] = (7.2, 4.4), **subplots: Any
) -> tuple[Figure, list[Axes]]:
    """Figure and its empty panels with a grid, row by row.

    Parameters
    ----------
    rows, columns : int
        Number of panels.
    title : str
        Statement that the figure shows, above all panels.
    size : tuple of float
        Width and height [inches].
    subplots
        Further arguments of ``Figure.subplots``, for example ``sharex=True``.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=size, layout="constrained")
    axes = figure.subplots(rows, columns, squeeze=False, **subplots).ravel().tolist()
    for ax in axes:
        ax.grid(color="0.9", linewidth=0.6)
        ax.set_axisbelow(True)
    if title:
        figure.suptitle(title, fontsize=11)
    return figure, axes


def legend(figure: Figure, columns: int = 3, note: str = "") -> None:
    """Put one legend, with each label once and a note above, below all panels. Without labels there is no legend.

    It replaces the legends of the panels.  It has at most ``columns`` columns, and rows of about equal length.
    """
    entries: dict[str, Any] = {}
    for ax in figure.axes:
        if (own := ax.get_legend()) is not None:
            own.remove()
        for handle, label in zip(*ax.get_legend_handles_labels(), strict=True):
            entries.setdefault(label, handle)
    if entries:
        n_rows = math.ceil(len(entries) / columns)
        n_columns = math.ceil(len(entries) / n_rows)
        place: dict[str, Any] = {"loc": "outside lower center", "ncols": n_columns, "fontsize": 8, "frameon": False}
        found = figure.legend(list(entries.values()), list(entries), title=note or None, title_fontsize=7, **place)
        found.get_title().set_color("0.25")


def histories(
    quantities: Mapping[str, Curves], title: str = "", *, xlabel: str = "time [s]", axes: Sequence[Axes] | None = None
) -> Figure:
    """Draw quantities over time, with a panel for each quantity.

    Parameters
    ----------
    quantities : mapping
        Curves (times, values) of each panel, by the panel's label with its unit, "height [m]".
    title : str
        Statement that the figure shows.
    xlabel : str
        Label of the times.
    axes : sequence of Axes, optional
        Panels to draw on; by default those of a new figure, one above the other.

    Returns
    -------
    Figure
        The figure.
    """
    n = len(quantities)
    drawn = list(axes) if axes is not None else panels(n, 1, title, (7.2, 2.4 + 1.6 * n), sharex=True)[1]
    for ax, (ylabel, curves) in zip(drawn, quantities.items(), strict=True):
        for place, (label, (t, y)) in enumerate(curves.items()):
            ax.plot(t, y, label=label or None, **line(place))
        ax.set_ylabel(ylabel)
    drawn[-1].set_xlabel(xlabel)
    return _finish(drawn, axes is None, [set(curves) for curves in quantities.values()])


def portrait(curves: Curves, xlabel: str, ylabel: str, title: str = "", *, ax: Axes | None = None) -> Figure:
    """Draw a phase portrait: rates over coordinates, each curve with a dot at its start.

    Parameters
    ----------
    curves : mapping
        Curves (coordinate, rate) by label.  Values that are not a number interrupt a curve.
    xlabel, ylabel : str
        Coordinate and rate with their units.
    title : str
        Statement that the figure shows.
    ax : Axes, optional
        Panel to draw on; that of a new figure by default.

    Returns
    -------
    Figure
        The figure.
    """
    drawn = [ax] if ax is not None else panels(title=title)[1]
    for place, (label, (x, rate)) in enumerate(curves.items()):
        drawn[0].plot(x, rate, label=label or None, **line(place))
        start = {"marker": "o", "markersize": 4, "linestyle": "none", "color": line(place)["color"]}
        drawn[0].plot(np.asarray(x)[:1], np.asarray(rate)[:1], **start)
    drawn[0].set(xlabel=xlabel, ylabel=ylabel)
    drawn[0].locator_params(axis="x", nbins=6)
    return _finish(drawn, ax is None, [set(curves)])


def comparison(
    expected: Curves, computed: Curves, xlabel: str, ylabel: str, title: str = "", *, ax: Axes | None = None
) -> Figure:
    """Draw computed values as markers over closed forms or published values, which are lines.

    Parameters
    ----------
    expected, computed : mapping
        Curves by label; there may be none.
    xlabel, ylabel : str
        Both axes with their units.
    title : str
        Statement that the figure shows.
    ax : Axes, optional
        Panel to draw on; that of a new figure by default.

    Returns
    -------
    Figure
        The figure.
    """
    drawn = [ax] if ax is not None else panels(title=title)[1]
    for place, (label, (x, y)) in enumerate(expected.items()):
        drawn[0].plot(x, y, label=label or None, **line(place))
    for place, (label, (x, y)) in enumerate(computed.items(), len(expected)):
        drawn[0].plot(x, y, label=label or None, **marker(place))
    drawn[0].set(xlabel=xlabel, ylabel=ylabel)
    return _finish(drawn, ax is None, [{*expected, *computed}])


def _finish(drawn: Sequence[Axes], is_new: bool, labels: Sequence[set[str]]) -> Figure:
    """Add the legends to a new figure: one for all panels if they have the same labels, else one a panel."""
    figure: Any = drawn[0].figure
    if is_new and all(one == labels[0] for one in labels):
        legend(figure)
    elif is_new:
        for ax, own in zip(drawn, labels, strict=True):
            if own != {""}:
                ax.legend(fontsize=8, frameon=False)
    return figure  # type: ignore[no-any-return]
