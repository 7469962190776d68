"""Pictures of basins: shares of attractors, the shares along a parameter, the uncertainty of the boundary."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from nonsmooth.plot.arguments import axes_of
from nonsmooth.studies.attractors.basins import Boundary, basin_stability
from nonsmooth.studies.drawing import draw_study, label_of
from nonsmooth.studies.plotting import BLUE, MOST_CLASSES, class_colours, finish

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_LINE = 72
"""Characters of a title that fit above the axes."""


def shares(attractor: xarray.DataArray, ax: Axes | None = None) -> Axes:
    """Draw the basin stability of each attractor, with its standard error.

    Parameters
    ----------
    attractor : DataArray
        The attractors of a study.
    ax : Axes, optional
        The axes; of a new figure by default.

    Raises
    ------
    InvalidInput
        If the array has no names of attractors (``flag_meanings``), or no run reached its end.
    """
    stability = basin_stability(attractor)
    colours = dict(zip(stability, class_colours(len(stability)), strict=True))
    found = {word: stability[word] for word in largest(stability)}
    ax = axes_of(ax, 1.2 + 0.32 * len(found))
    width, error = np.array(list(found.values())).T
    ax.barh(list(found), width, xerr=error, color=[colours[word] for word in found], capsize=3.0)
    ax.invert_yaxis()
    ax.set_xlim(0.0, 1.0)
    x, title = "basin stability [1], with its standard error", _largest_share(attractor)
    return finish(ax, x, "", title, grid="", legend=False)


def basins(study: xarray.Dataset) -> Figure:
    """Draw the attractors of a study over its starts, with failed runs hatched.

    Parameters
    ----------
    study : Dataset
        A study with the variable ``attractor``.

    Returns
    -------
    Figure
        The figure of :func:`draw_study`.
    """
    figure = draw_study(study[["attractor", "status"]])
    figure.suptitle(_largest_share(study.attractor), fontsize=10)
    return figure


def largest(stability: Mapping[str, tuple[float, float]]) -> list[str]:
    """Return the names of the attractors with the largest shares, the largest first, at most ``MOST_CLASSES``."""
    found = [word for word, (share, _) in stability.items() if share > 0.0]
    return sorted(found, key=lambda word: -stability[word][0])[:MOST_CLASSES]


def _largest_share(attractor: xarray.DataArray) -> str:
    found, n_failed = basin_stability(attractor), int((attractor < 0).sum())
    most = largest(found)[0]
    failed = f"; {n_failed} failed" if n_failed else ""
    return f"{100.0 * found[most][0]:.1f} % of {attractor.size - n_failed} starts lead to {most}{failed}"


def fractions(found: xarray.Dataset, ax: Axes | None = None) -> Axes:
    """Draw basin fractions along a parameter, with bands of one standard error on either side.

    Parameters
    ----------
    found : Dataset
        The result of :func:`basin_fractions`.
    ax : Axes, optional
        The axes; of a new figure by default.
    """
    ax, parameter = axes_of(ax), str(found.runs.dims[0])
    along, colours = found[parameter], class_colours(found.sizes["attractor"])
    peaks = np.nan_to_num(found.share.values).max(axis=1)
    for place in np.argsort(-peaks, kind="stable")[: min(MOST_CLASSES, np.count_nonzero(peaks))].tolist():
        one, colour = found.isel(attractor=place), colours[place]
        low, high = one.share - one.error, one.share + one.error
        ax.plot(along, one.share, "o-", markersize=3.0, linewidth=1.3, color=colour, label=one.attractor.item())
        ax.fill_between(along, low, high, color=colour, alpha=0.2, linewidth=0.0)
    ax.set_ylim(-0.02, 1.02)
    title = textwrap.fill(_largest_change(found, parameter), _LINE)
    return finish(ax, label_of(along), "share of the starts [1]", title)


def _largest_change(found: xarray.Dataset, parameter: str) -> str:
    known = found.share.dropna(parameter, how="all")
    change = np.ptp(known.values, axis=1)
    word, share = known.attractor.values[change.argmax()], known.values[change.argmax()]
    ends = sorted((int(share.argmin()), int(share.argmax())))
    places = [f"{share[i]:.2f} at {parameter} = {_value(known[parameter].values[i])}" for i in ends]
    return f"{word}: {places[0]}, {places[1]}" if change.max() > 0.0 else "The shares do not change"


def _value(value: object) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def uncertainty(found: Boundary, ax: Axes | None = None) -> Axes:
    """Draw the share of uncertain starts over the distance between neighbouring starts, and the fit of its slope.

    A start is uncertain if a neighbour at this distance leads to another attractor.  The slope is the uncertainty
    exponent.

    Parameters
    ----------
    found : Boundary
        The result of :func:`uncertainty_exponent`.
    ax : Axes, optional
        The axes; of a new figure by default.
    """
    ax, share = axes_of(ax), found.uncertain
    ax.plot(found.steps, np.exp(found.offset) * found.steps**found.exponent, "-", color="0.4", label="fit")
    ax.plot(found.steps[share > 0.0], share[share > 0.0], "o", color=BLUE, label="starts")
    for axis, scale in (ax.xaxis, ax.set_xscale), (ax.yaxis, ax.set_yscale):
        scale("log", base=2)
        axis.set_major_formatter("{x:g}")
    ax.set_ylim(2.0 ** np.floor(np.log2(share[share > 0.0].min())), 1.0)
    exponent = f"{found.exponent:.3f} ± {found.error:.3f}"
    title = f"Uncertainty exponent {exponent}: a boundary of dimension {found.dimension:.2f}"
    return finish(ax, "distance [steps of the grid]", "share with another\nattractor that far away [1]", title)
