"""Tables: what is known over time, as text with a column for each number."""

from __future__ import annotations

import csv
import io
import itertools
import math
from typing import TYPE_CHECKING, Protocol, runtime_checkable

from nonsmooth.errors import InvalidInput

if TYPE_CHECKING:
    import xarray


@runtime_checkable
class Series(Protocol):
    """Anything over time that has a dataset: states, poses, energies, contact forces, one contact, and so on."""

    def to_xarray(self) -> xarray.Dataset:
        """Return it as a dataset with the time, in [s], as an axis, or as a number."""


def table(series: Series) -> str:
    """Return a table with a row for each time; over each column stand name, labels and unit.

    Raises
    ------
    InvalidInput
        If the series has no times.
    """
    data = series.to_xarray()
    if "time" not in data.coords or "event" in data.sizes:
        rule = "must be over time, with one row for each"
        raise InvalidInput("export: series", rule, series, 'For example solution.history("gap"), or "states".')
    if "time" not in data.dims:
        data = data.expand_dims("time")
    heads, columns = ["time [s]"], [data["time"].to_numpy()]
    for name, variable in data.data_vars.items():
        axes = [str(axis) for axis in variable.dims if axis != "time"]
        values = variable.transpose("time", *axes).to_numpy()
        places = itertools.product(*(range(data.sizes[axis]) for axis in axes))
        # a run that was cut off at once has no rows
        for column, place in zip(values.reshape(len(values), math.prod(values.shape[1:])).T, places, strict=True):
            labels = [_label(data, axis, i) for axis, i in zip(axes, place, strict=True)]
            units = [str(data[f"{axis}_units"].to_numpy()[i]) for axis, i in zip(axes, place, strict=True)
                     if f"{axis}_units" in data.coords]  # fmt: skip
            unit = variable.attrs.get("units", units[0] if units else "")
            heads.append(" ".join([str(name), *labels]) + (f" [{unit}]" if unit else ""))
            columns.append(column)
    file = io.StringIO(newline="")
    rows = csv.writer(file)
    rows.writerow(heads)
    # repr has all digits of a number
    rows.writerows(zip(*([repr(x) for x in column.tolist()] for column in columns), strict=True))
    return file.getvalue()


def _label(data: xarray.Dataset, axis: str, i: int) -> str:
    return str(data[axis].to_numpy()[i]) if axis in data.coords else str(i)
