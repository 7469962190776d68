"""A stored study as a dataset of xarray: over its parameters where they form a grid."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from nonsmooth.checks import path_of
from nonsmooth.studies.inputs import require_store
from nonsmooth.studies.store import Store

if TYPE_CHECKING:
    import xarray


def open_study(path: Path | str) -> xarray.Dataset:
    """Open a study, finished or not.

    Parameters
    ----------
    path : Path or str
        Its folder.

    Returns
    -------
    xarray.Dataset
        The records: of a grid over its axes, else over ``run`` with the parameters as coordinates.  Runs that have
        not come to their end have NaN, or -1 in place of a count or a word; ``status`` and ``reason`` tell why.

    Raises
    ------
    InvalidInput
        If there is none.
    """
    import xarray

    require_store()
    store = Store(path_of("study", path))
    with xarray.open_zarr(
        str(store.path), chunks=None, consolidated=False, mask_and_scale=False, zarr_format=3
    ) as opened:
        flat = opened.load()
    said = json.loads(str(store.attributes["layout"]))
    flat = flat.set_coords(said["parameters"])[said["variables"]]
    for name, labels in said["labels"].items():
        # words are stored as numbers, which all readers of the format know
        told = {"long_name": flat[name].attrs["long_name"]}
        flat = flat.assign_coords({name: (flat[name].dims, np.array(labels)[flat[name].values], told)})
    return _on_grid(flat, said["dims"]) if said["dims"] else flat


def _on_grid(flat: xarray.Dataset, dims: dict[str, int]) -> xarray.Dataset:
    import xarray

    sizes = tuple(dims.values())
    variables: dict[str, Any] = {}
    for name, one in flat.data_vars.items():
        if "run" in one.dims:
            values = one.values.reshape(sizes + one.shape[1:])
            variables[str(name)] = ((*dims, *one.dims[1:]), values, one.attrs)
    coordinates: dict[str, Any] = {str(name): one for name, one in flat.coords.items() if "run" not in one.dims}
    for place, name in enumerate(dims):
        at = tuple(slice(None) if i == place else 0 for i in range(len(sizes)))
        coordinates[name] = (name, flat[name].values.reshape(sizes)[at], flat[name].attrs)
    return xarray.Dataset(variables, coordinates, flat.attrs)
