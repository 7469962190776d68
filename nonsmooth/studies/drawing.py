"""A picture of a study: its records over one parameter, maps over two, points where runs are in no order."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np

from nonsmooth.errors import InvalidInput
from nonsmooth.studies.status import VALUED

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_MOST = 12
"""Panels at most."""


def draw_study(study: xarray.Dataset) -> Figure:
    """Draw the records of a study that are one number, or one word, per run.

    Over one parameter they are points, over two a map with the runs hatched that did not come to their end; of more
    parameters, or of runs in no order, each record is drawn over each parameter.

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
    runs = study.status.dims
    names = [
        str(name) for name, one in study.data_vars.items() if one.dims == runs and name not in ("status", "reason")
    ]
    if not names:
        remedy = 'For example record=["impacts"].'
        raise InvalidInput("draw", "needs a record that is one number or one word", list(study.data_vars), remedy)
    is_map = len(runs) == 2 and all(study[name].dtype.kind != "U" and study.sizes[name] > 1 for name in runs)
    panels = [(name, "") for name in names] if is_map else [(name, over) for name in names for over in parameters]
    panels = panels[:_MOST]
    columns = 1 if is_map else min(len(parameters), 3)
    n_rows = -(-len(panels) // columns)
    figure = Figure(figsize=(2.0 + 4.0 * columns, 0.5 + 2.8 * n_rows), layout="constrained")
    axes = figure.subplots(n_rows, columns, squeeze=False).ravel()
    for (name, over), one in zip(panels, axes, strict=False):
        if is_map:
            _map(figure, one, study, name)
        else:
            _points(one, study, name, over)
    for one in axes[len(panels) :]:
        one.remove()
    return figure


def _label(one: xarray.DataArray) -> str:
    unit = one.attrs.get("units", "")
    return f"{one.name} [{unit}]" if unit not in ("", "1") else str(one.name)


def _points(axes: Axes, study: xarray.Dataset, name: str, over: str) -> None:
    along, record = study[over], study[name]
    x = along.broadcast_like(record).values.ravel()
    valued = np.isin(study.status.values.ravel(), VALUED)
    axes.plot(x[valued], record.values.ravel()[valued], "o", markersize=3)
    for missing in x[~valued] if along.dtype.kind != "U" else ():
        axes.axvline(missing, color="0.7", linewidth=0.8, linestyle=":")
    if words := record.attrs.get("flag_meanings"):
        axes.set_yticks(record.attrs["flag_values"], words.split(" "))
    axes.set_xlabel(_label(along))
    axes.set_ylabel(_label(record))


def _map(figure: Figure, axes: Axes, study: xarray.Dataset, name: str) -> None:
    from matplotlib import colormaps
    from matplotlib.colors import ListedColormap

    record = study[name]
    first, second = (study[dim] for dim in record.dims)
    valued = np.isin(study.status.values, VALUED)
    shown = np.ma.masked_where(~valued, record.values)
    told: dict[str, Any] = {"shading": "nearest"}
    words = record.attrs.get("flag_meanings", "").split()
    if words:
        told |= {"cmap": colormaps["viridis"].resampled(len(words)), "vmin": -0.5, "vmax": len(words) - 0.5}
    mesh = axes.pcolormesh(second.values, first.values, shown, **told)
    bar = figure.colorbar(mesh, ax=axes, label=_label(record))
    if words:
        bar.set_ticks(record.attrs["flag_values"], labels=words)
    failed = np.ma.masked_where(valued, np.ones(valued.shape))
    white = ListedColormap(["white"])
    axes.pcolor(
        second.values, first.values, failed, shading="nearest", cmap=white, hatch="xxx", edgecolor="0.6", linewidth=0.0
    )
    axes.set_xlabel(_label(second))
    axes.set_ylabel(_label(first))
