"""A picture of a study: its records over one parameter, maps over two, points where runs are in no order."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from nonsmooth.errors import InvalidInput
from nonsmooth.studies.colours import class_colours
from nonsmooth.studies.status import VALUED
from nonsmooth.studies.summary import ends, of_record, records_of

if TYPE_CHECKING:
    import xarray
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_MOST = 12
"""Panels at most."""
_NAMED = 20
"""Classes at most that have their names beside a map."""
_HATCHED: dict[str, Any] = {"edgecolor": "0.6", "hatch": "xxx", "linewidth": 0.0}
_DOTTED: dict[str, Any] = {"color": "0.5", "linewidth": 1.0, "linestyle": ":"}


def draw_study(study: xarray.Dataset) -> Figure:
    """Draw the records of a study that are one number, or one word, per run.

    Over one parameter they are points, over two a map with the runs hatched that did not come to their end; of more
    parameters, or of runs in no order, each record is drawn over each parameter.  Words come first; numbers that are
    the same in all runs are told in the title.

    Parameters
    ----------
    study : Dataset
        What :func:`open_study` returns.

    Raises
    ------
    InvalidInput
        If it has no such record.
    """
    from matplotlib.figure import Figure

    parameters = json.loads(str(study.attrs["layout"]))["parameters"]
    records, runs = records_of(study), study.status.dims
    if not records:
        remedy = 'For example record=["impacts"].'
        raise InvalidInput("draw", "needs a record that is one number or one word", list(study.data_vars), remedy)
    valued = np.isin(study.status.values, VALUED)
    # stable: among themselves they stay as they were asked for
    names = sorted(_told_apart(records, valued) or records, key=lambda name: not _words(records[name]))
    is_map = len(runs) == 2 and all(study[name].dtype.kind != "U" and study.sizes[name] > 1 for name in runs)
    panels = [(name, "") for name in names] if is_map else [(name, over) for name in names for over in parameters]
    panels = panels[:_MOST]
    columns = min(len(panels), 2) if is_map else min(len(parameters), 3)
    n_rows = -(-len(panels) // columns)
    figure = Figure(figsize=(2.0 + 4.0 * columns, 1.2 + 2.8 * n_rows), layout="constrained")
    axes = figure.subplots(n_rows, columns, squeeze=False).ravel()
    for (name, over), one in zip(panels, axes, strict=False):
        if is_map:
            _map(figure, one, records[name], valued)
        else:
            _points(one, records[name], study[over].broadcast_like(records[name]), valued)
    for one in axes[len(panels) :]:
        one.remove()
    same = ", ".join(f"{name} {of_record(one, valued)}" for name, one in records.items() if name not in names)
    figure.suptitle(f"{study.attrs['title']}{f', all with {same}' if same else ''}", fontsize=10, wrap=True)
    if not valued.all():
        figure.legend(handles=[_missing(is_map, ends(study.status.values[~valued]))], loc="outside lower center")
    return figure


def _told_apart(records: dict[str, xarray.DataArray], valued: NDArray[np.bool_]) -> list[str]:
    """Return the records that are words, or not the same number in all runs."""
    return [
        name for name, one in records.items() if _words(one) or len(np.unique(one.values[valued], equal_nan=True)) > 1
    ]


def _words(record: xarray.DataArray) -> list[str]:
    return str(record.attrs.get("flag_meanings", "")).split()


def label_of(one: xarray.DataArray) -> str:
    """Return the name of a record or parameter, with its unit."""
    unit = one.attrs.get("units", "")
    return f"{one.name} [{unit}]" if unit not in ("", "1") else str(one.name)


def _missing(is_map: bool, told: str) -> Artist:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    label = f"without records: {told}"
    return Patch(**_HATCHED, facecolor="white", label=label) if is_map else Line2D([], [], **_DOTTED, label=label)


def _points(axes: Axes, record: xarray.DataArray, along: xarray.DataArray, valued: NDArray[np.bool_]) -> None:
    axes.plot(along.values[valued], record.values[valued], "o", markersize=3)
    for missing in along.values[~valued] if along.dtype.kind != "U" else ():
        axes.axvline(missing, **_DOTTED)
    if words := _words(record):
        axes.set_yticks(record.attrs["flag_values"], words)
    if along.dtype.kind != "U":
        axes.locator_params(axis="x", nbins=6)  # labels of seven characters fit
    axes.set_xlabel(label_of(along))
    axes.set_ylabel(label_of(record))


def _map(figure: Figure, axes: Axes, record: xarray.DataArray, valued: NDArray[np.bool_]) -> None:
    from matplotlib.colors import ListedColormap

    first, second = (record[dim] for dim in record.dims)
    shown = np.ma.masked_where(~valued, record.values)
    told: dict[str, Any] = {"shading": "nearest"}
    words = _words(record)
    if words:
        told |= {"cmap": ListedColormap(class_colours(len(words))), "vmin": -0.5, "vmax": len(words) - 0.5}
    mesh = axes.pcolormesh(second.values, first.values, shown, **told)
    bar = figure.colorbar(mesh, ax=axes, label=label_of(record))
    if words:
        bar.set_ticks(record.attrs["flag_values"][:_NAMED], labels=words[:_NAMED])
    failed = np.ma.masked_where(valued, np.ones(valued.shape))
    axes.pcolor(second.values, first.values, failed, shading="nearest", cmap=ListedColormap(["white"]), **_HATCHED)
    axes.set_xlabel(label_of(second))
    axes.set_ylabel(label_of(first))
