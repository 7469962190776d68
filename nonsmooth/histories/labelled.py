"""LabelledArray: an array with its name, unit, and names of its axes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, final

from numpy.typing import NDArray

if TYPE_CHECKING:
    import xarray


@final
@dataclass(frozen=True, eq=False)
class LabelledArray:
    """An array with its name, unit, and names of its axes, in memory and on disk.

    Attributes
    ----------
    name : str
        Name of the array.
    dimensions : tuple of str
        Name of each axis.
    values : array
        Numbers or words.
    attributes : mapping
        What it is, ``long_name``, its unit, ``units``, and other attributes of the CF conventions.  Without ``units``
        another array has the unit of each column, or the unit depends on a law.
    """

    name: str
    dimensions: tuple[str, ...]
    values: NDArray[Any]
    attributes: Mapping[str, Any]

    @classmethod
    def of(
        cls, name: str, dimensions: tuple[str, ...], values: NDArray[Any], description: str, unit: str = "", **more: Any
    ) -> LabelledArray:
        """Labelled array from its description and unit."""
        return cls(name, dimensions, values, {**({"units": unit} if unit else {}), "long_name": description, **more})


def to_dataset(
    arrays: Iterable[LabelledArray], coordinates: Iterable[LabelledArray], attributes: Mapping[str, Any]
) -> xarray.Dataset:
    """Arrays as one dataset of xarray.

    Parameters
    ----------
    arrays, coordinates : iterable of LabelledArray
        Variables and coordinates of the dataset.
    attributes : mapping
        Attributes of the dataset.
    """
    import xarray

    variables, labels = (
        {one.name: (one.dimensions, one.values, dict(one.attributes)) for one in several}
        for several in (arrays, coordinates)
    )
    return xarray.Dataset(variables, coords=labels, attrs=dict(attributes))
