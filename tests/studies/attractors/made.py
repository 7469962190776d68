"""Studies that are made of numbers, without runs."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from nonsmooth.studies.status import CaseStatus

if TYPE_CHECKING:
    import xarray

Floats = NDArray[np.float64]


def study(coordinates: dict[str, Any], failed: tuple[int, ...] = (), **records: Any) -> xarray.Dataset:
    """Return one over `run`, with records over the runs and further axes; numbers of failed runs are nan."""
    import xarray

    n = len(next(iter(records.values())))
    variables: dict[str, Any] = {}
    for name, values in records.items():
        found = np.array(values, float)
        found[list(failed)] = np.nan
        axes = ("section", "within")[: found.ndim - 1]
        attributes = {"scales": [1.0] * found.shape[-1]} if axes else {}
        variables[name] = (("run", *axes), found, attributes)
    status = np.full(n, CaseStatus.DONE.code, "int8")
    status[list(failed)] = CaseStatus.FAILED.code
    variables["status"] = ("run", status)
    along = {name: ("run", values) for name, values in coordinates.items()}
    return xarray.Dataset(variables, along, {"layout": json.dumps({"parameters": list(coordinates)})})


def labels(values: Any, **coordinates: Any) -> xarray.DataArray:
    """Return attractors over a grid whose axes are from 0 to 1, or as they are given."""
    import xarray

    found = np.asarray(values, "int16")
    along = coordinates or {f"x{i}": np.linspace(0.0, 1.0, n) for i, n in enumerate(found.shape)}
    words = [f"A{i + 1}" for i in range(int(found.max(initial=0)) + 1)]
    told = {"flag_values": list(range(len(words))), "flag_meanings": " ".join(words)}
    return xarray.DataArray(found, along, list(along), "attractor", told)


def logistic(r: float | Floats, starts: Floats, settle: int = 2000, keep: int = 64) -> Floats:
    """Return the last values of x -> r x (1 - x), shape [n_starts, keep, 1]."""
    x, found = starts.copy(), []
    for i in range(settle + keep):
        x = r * x * (1.0 - x)
        if i >= settle:
            found.append(x)
    return np.stack(found, axis=1)[:, :, np.newaxis]
