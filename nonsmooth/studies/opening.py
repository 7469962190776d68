"""A stored study as a dataset of xarray: over its parameters if they form a grid."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from nonsmooth.checks import path_of
from nonsmooth.studies.extras import require_store
from nonsmooth.studies.study_folder import StudyFolder

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
        If there is none, another version wrote it, or it is damaged.
    """
    import xarray

    require_store()
    folder = StudyFolder(path_of("study", path))

    def read(name: str) -> tuple[tuple[str, ...], Any, dict[str, Any]]:
        layout = folder.layout(name)
        return layout.dimensions, folder.read(name), dict(layout.attributes)

    variables, coordinates = ({name: read(name) for name in names} for names in (folder.variables, folder.coordinates))
    flat, dims = xarray.Dataset(variables, coordinates, dict(folder.attributes)), folder.parts["dims"]
    return _on_grid(flat, dims) if dims else flat


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
