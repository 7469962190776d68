"""History: quantities of a run over time, as arrays with names, units and labels."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.datasets import described
from nonsmooth.errors import UnknownName
from nonsmooth.histories.arrays import Floats

if TYPE_CHECKING:
    import xarray

_N_NAMED = 6
"""Largest number of labels of an axis that a printed history lists."""
FIXED_LABELS: Mapping[str, tuple[str, ...]] = {"axis": (*"xyz",), "column": (*"xyz",), "side": ("first", "second")}
"""Labels of axes that are the same in every system."""


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
        Description (``long_name``), unit (``units``), and other attributes of the CF conventions.  ``units`` is missing
        if another array has the unit of each column, or if the unit depends on a law.
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
        return cls(name, dimensions, values, {**described(description, unit), **more})


@final
@dataclass(frozen=True, eq=False, repr=False)
class History(Mapping[str, NDArray[Any]]):
    """Quantities of a run over time: ``history["gap"]`` is an array, ``history.units["gap"]`` its unit.

    :meth:`nonsmooth.Solution.history` makes it.  It is a mapping from names to arrays.  The first axis of each array is
    time; a history at a single time has arrays without that axis.

    Attributes
    ----------
    time : array
        Times [s], shape [n], or [] at a single time.
    arrays : tuple of LabelledArray
        The arrays with their descriptions.
    labels : mapping of str to tuple of str
        Names along each axis except time, such as those of contacts; without an entry the axis is numbered.
    along : tuple of LabelledArray
        Units and other properties of the entries along an axis, such as ``coordinate_units``.
    over : str
        Name of the first axis, "time", or "impulse" if each entry is the impulse of a contact in an event.
    attributes : mapping of str to str
        Properties of the whole history.
    """

    time: Floats
    arrays: tuple[LabelledArray, ...]
    labels: Mapping[str, tuple[str, ...]]
    along: tuple[LabelledArray, ...] = ()
    over: str = "time"
    attributes: Mapping[str, str] = field(default_factory=dict)

    @classmethod
    def of(
        cls, time: Floats, arrays: tuple[LabelledArray, ...], labels: Mapping[str, tuple[str, ...]], **more: Any
    ) -> History:
        """Make a history of arrays whose first axis is time; their ``dimensions`` name the other axes.

        ``labels`` has the labels of the entries along each axis, by the name of the axis; those of axes that no array
        has are dropped. ``more`` are further attributes of the history.
        """
        used = dict.fromkeys(axis for one in arrays for axis in one.dimensions)
        known = {**FIXED_LABELS, **labels}
        return cls(time, arrays, {axis: known[axis] for axis in used if axis in known}, **more)

    def __getitem__(self, name: str) -> NDArray[Any]:
        """Array of a quantity.

        Raises
        ------
        UnknownName
            The history has no quantity of this name.
        """
        for one in self.arrays:
            if one.name == name:
                return one.values
        raise UnknownName("variable of this history", name, list(self), remedy="Name it in Solution.history(...).")

    def __contains__(self, name: object) -> bool:
        return any(one.name == name for one in self.arrays)

    def __iter__(self) -> Iterator[str]:
        return (one.name for one in self.arrays)

    def __len__(self) -> int:
        return len(self.arrays)

    @property
    def units(self) -> dict[str, str]:
        """Unit of each quantity; "" if its columns have units of their own, as ``history.along`` lists them."""
        return {one.name: one.attributes.get("units", "") for one in self.arrays}

    @property
    def axes(self) -> dict[str, tuple[str, ...]]:
        """Names of the axes of each quantity."""
        return {one.name: (*self._first, *one.dimensions) for one in self.arrays}

    @property
    def _first(self) -> tuple[str, ...]:
        """Name of the first axis as a tuple, empty at a single time."""
        return (self.over,) * self.time.ndim

    def __repr__(self) -> str:
        """Times, a line for each quantity with its unit, axes, least and greatest value, and the labels of the axes."""
        name, unit, axes = (
            max((len(text) for text in texts), default=0)
            for texts in (self, map(_bracketed, self.units.values()), map(_joined, self.axes.values()))
        )
        lines = [
            f"  {one.name:{name}}  {_bracketed(self.units[one.name]):{unit}}  {_joined(self.axes[one.name]):{axes}}"
            f"  {_range(one.values)}".rstrip()
            for one in self.arrays
        ]
        lines += [f"  {axis}: {_listed(names)}" for axis, names in self.labels.items() if axis not in FIXED_LABELS]
        return "\n".join([f"History({spoken(self.time, self.over)})", *lines])

    def to_xarray(self) -> xarray.Dataset:
        """Dataset of xarray with the same names, units and labels."""
        time = LabelledArray.of("time", self._first, self.time, "time", "s")
        labels = [LabelledArray(axis, (axis,), np.array(names, dtype=str), {}) for axis, names in self.labels.items()]
        arrays = [LabelledArray(one.name, self.axes[one.name], one.values, one.attributes) for one in self.arrays]
        return to_dataset(arrays, [time, *labels, *self.along], self.attributes)


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


def spoken(time: Floats, over: str) -> str:
    """Text on times: "t = 0.5 s" for a single time, and number and range of several times, "200 times, 0 to 1 s".

    ``over`` is the noun for an entry, "time" or "impulse".
    """
    if time.ndim == 0:
        return f"t = {time:.9g} s"
    return f"{len(time)} {over}s, {time.min():.9g} to {time.max():.9g} s" if len(time) > 0 else f"no {over}s"


def _bracketed(unit: str) -> str:
    return f"[{unit}]" if unit else ""


def _joined(axes: tuple[str, ...]) -> str:
    return f"({', '.join(axes)})" if axes else ""


def _range(values: NDArray[Any]) -> str:
    """Least and greatest value of an array of numbers, or the different words of an array of text; as text."""
    if values.dtype.kind not in "if":
        return _listed(tuple(str(word) for word in dict.fromkeys(values.ravel().tolist())))
    known = values[np.isfinite(values)]
    if known.size == 0:
        return "no numbers"
    least, greatest = known.min(), known.max()
    return f"{least:.6g}" if least == greatest else f"{least:.6g} to {greatest:.6g}"


def _listed(names: tuple[str, ...]) -> str:
    more = f" and {len(names) - _N_NAMED} more" if len(names) > _N_NAMED else ""
    return ", ".join(names[:_N_NAMED]) + more
