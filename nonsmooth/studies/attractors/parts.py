"""The runs of a study by the values of one parameter."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.errors import InvalidInput, UnknownName

if TYPE_CHECKING:
    import xarray


@final
@dataclass(frozen=True, eq=False)
class Parts:
    """The runs of a study by the values of one parameter.

    Attributes
    ----------
    values : array
        Of each part the value, or the middle of its values, shape [n_parts].
    of_runs : array
        To which part each run belongs, shape [n_runs].
    """

    values: NDArray[Any]
    of_runs: NDArray[np.int64]


def parts(runs: xarray.DataArray, parameter: str, bins: int) -> Parts:
    """Return the runs by the values of a parameter: each value of a grid, or as many parts of equal width of draws.

    Raises
    ------
    UnknownName
        If it is none of the parameters that are varied.
    InvalidInput
        If there are no parts.
    """
    known = [str(name) for name, one in runs.coords.items() if set(one.dims) <= set(runs.dims)]
    if parameter not in known:
        raise UnknownName("varied parameter", parameter, known)
    if not isinstance(bins, int) or bins < 1:
        raise InvalidInput("bins", "must be a positive whole number", bins, "Leave it out.")
    values = runs[parameter].broadcast_like(runs).transpose(*runs.dims).values.ravel()
    if parameter in runs.dims or values.dtype.kind == "U":
        one, of_runs = np.unique(values, return_inverse=True)
        return Parts(one, of_runs.reshape(-1))
    edges = np.linspace(values.min(), values.max(), bins + 1)
    return Parts(0.5 * (edges[1:] + edges[:-1]), np.clip(np.searchsorted(edges, values, "right") - 1, 0, bins - 1))
