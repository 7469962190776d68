"""Histories as datasets of xarray: every array with its unit and what it is, every axis with names."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import xarray

Told: TypeAlias = Mapping[str, tuple[tuple[str, ...], str, str]]
"""Of each array of a history its axes behind that of time, its unit, and what it is."""
_NAMES: Mapping[str, Sequence[str]] = {"axis": "xyz", "column": "xyz", "body": ("first", "second")}
_NONE: Mapping[str, Any] = MappingProxyType({})


def described(what: str, unit: str = "") -> dict[str, str]:
    """Return what is said of an array; no unit where its columns have units of their own, or nobody knows it."""
    return {"units": unit, "long_name": what} if unit else {"long_name": what}


def dataset(
    history: object, time: NDArray[Any], told: Told, names: Mapping[str, Sequence[str]] = _NONE, **attributes: str
) -> xarray.Dataset:
    """Return some arrays of a history as one dataset.

    Parameters
    ----------
    history : object
        What has the arrays; of a single time they lack the axis of time.
    time : array
        [s], shape [n] or [].
    told : mapping
        What is said of each of the arrays.
    names : mapping
        The names along further axes.
    **attributes : str
        What is said of the whole.
    """
    import xarray

    over = ("time",) * time.ndim
    used = {axis for axes, _, _ in told.values() for axis in axes}
    coordinates = {axis: (axis, list(words)) for axis, words in {**_NAMES, **names}.items() if axis in used}
    return xarray.Dataset(
        {
            name: ((*over, *axes), np.asarray(getattr(history, name)), described(words, unit))
            for name, (axes, unit, words) in told.items()
        },
        coords={"time": (over, time, {"units": "s", "long_name": "time"}), **coordinates},
        attrs=attributes,
    )
