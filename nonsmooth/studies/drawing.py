"""Picture of a study: records over one parameter, maps over two, points if the runs form no grid."""

from __future__ import annotations

import json
import re
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from nonsmooth.errors import InvalidInput
from nonsmooth.studies.plotting import DOTTED, HATCHED, class_colours, dotted, few_ticks, finish, with_unit
from nonsmooth.studies.status import ALWAYS, VALUED, ends, of_record, scalars_of

if TYPE_CHECKING:
    import xarray
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_MOST = 12
"""Largest number of panels in the figure."""
_NAMED = 20
"""Largest number of classes that are named at the colour bar of a map."""
_GREY = "0.5"


def draw_study(study: xarray.Dataset) -> Figure:
    """Draw the records of a study: numbers, words, and each component of a short vector.

    Over one parameter they are points, over two a map with failed runs hatched.  With more parameters, or without a
    grid, each record is drawn over each parameter.  Words come first; numbers equal in all runs are in the title.

    Parameters
    ----------
    study : Dataset
        The result of :func:`open_study`.

    Raises
    ------
    InvalidInput
        If the study has only trajectories and long vectors, or no record at all.
    """
    from matplotlib.figure import Figure

    parameters = json.loads(str(study.attrs["layout"]))["parameters"]
    records, runs = scalars_of(study), study.status.dims
    if not records:
        remedy = 'Store another record as well, for example record=["impacts"] or --record impacts.'
        raise InvalidInput("draw", "needs a record that is a number, a word or a short vector", _stored(study), remedy)
    valued = np.isin(study.status.values, VALUED)
    # records of words come before records of numbers; the sort is stable, so each kind keeps its order
    names = sorted(_varying(records, valued) or records, key=lambda name: not _words(records[name]))
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
    figure.suptitle(_title(study, records, names, valued), fontsize=10, wrap=True)
    if not valued.all():
        figure.legend(handles=[_missing(is_map, ends(study.status.values[~valued]))], loc="outside lower center")
    return figure


def _title(
    study: xarray.Dataset, records: dict[str, xarray.DataArray], panels: list[str], valued: NDArray[np.bool_]
) -> str:
    """Return the title: the runs, the records that are equal in all runs, and the records that cannot be drawn."""
    same = ", ".join(f"{name} {of_record(one, valued)}" for name, one in records.items() if name not in panels)
    listed = {re.split(r"[ \[]", name)[0] for name in records}
    others = ", ".join(name for name in _stored(study) if name not in listed)
    return f"{study.attrs['title']}{f', all with {same}' if same else ''}{f'; not drawn: {others}' if others else ''}"


def _stored(study: xarray.Dataset) -> list[str]:
    """Return the names of the records that the user requested."""
    return [str(name) for name in study.data_vars if name not in ALWAYS]


def _varying(records: dict[str, xarray.DataArray], valued: NDArray[np.bool_]) -> list[str]:
    """Return the names of the records to draw: all records with texts, and records whose numbers differ between runs.

    ``valued`` is True for each completed run, which has values.
    """
    return [
        name for name, one in records.items() if _words(one) or len(np.unique(one.values[valued], equal_nan=True)) > 1
    ]


def _words(record: xarray.DataArray) -> list[str]:
    return str(record.attrs.get("flag_meanings", "")).split()


def label_of(one: xarray.DataArray) -> str:
    """Return the name of a record or parameter, with its unit."""
    return with_unit(str(one.name), one.attrs.get("units", ""))


def _missing(is_map: bool, counts: str) -> Artist:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    label = f"without records: {counts}"
    if is_map:
        return Patch(**HATCHED, facecolor="white", label=label)
    return Line2D([], [], color=_GREY, **DOTTED, label=label)


def _points(axes: Axes, record: xarray.DataArray, along: xarray.DataArray, valued: NDArray[np.bool_]) -> None:
    axes.plot(along.values[valued], record.values[valued], "o", markersize=3)
    if words := _words(record):
        axes.set_yticks(record.attrs["flag_values"], words)
    if along.dtype.kind != "U":
        dotted(axes, along.values[~valued], _GREY)
        few_ticks(axes)
    finish(axes, label_of(along), label_of(record), grid="", legend=False)


def _map(figure: Figure, axes: Axes, record: xarray.DataArray, valued: NDArray[np.bool_]) -> None:
    from matplotlib.colors import ListedColormap

    first, second = (record[dim] for dim in record.dims)
    shown = np.ma.masked_where(~valued, record.values)
    scale: dict[str, Any] = {"shading": "nearest"}
    words = _words(record)
    if words:
        scale |= {"cmap": ListedColormap(class_colours(len(words))), "vmin": -0.5, "vmax": len(words) - 0.5}
    mesh = axes.pcolormesh(second.values, first.values, shown, **scale)
    bar = figure.colorbar(mesh, ax=axes, label=label_of(record))
    if words:
        bar.set_ticks(record.attrs["flag_values"][:_NAMED], labels=words[:_NAMED])
    failed = np.ma.masked_where(valued, np.ones(valued.shape))
    axes.pcolor(second.values, first.values, failed, shading="nearest", cmap=ListedColormap(["white"]), **HATCHED)
    finish(axes, label_of(second), label_of(first), grid="", legend=False)
