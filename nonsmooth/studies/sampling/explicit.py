"""Parameters given value by value: grids and lists."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nonsmooth.errors import InvalidInput
from nonsmooth.studies.sampling.sampling import SamplePoints, Sampling, Value, column


@final
@dataclass(frozen=True, eq=False)
class Grid(Sampling):
    """All combinations; :func:`grid` makes it.

    Attributes
    ----------
    axes : mapping
        Of each parameter its values, shape [n].
    """

    axes: Mapping[str, NDArray[Any]]

    def points(self) -> SamplePoints:
        """Return the combinations, the last parameter fastest."""
        sizes = [len(values) for values in self.axes.values()]
        places = np.unravel_index(np.arange(int(np.prod(sizes))), sizes)
        names = dict(zip(self.axes, places, strict=True))
        return SamplePoints(
            {name: self.axes[name][at] for name, at in names.items()}, dict(zip(self.axes, sizes, strict=True))
        )

    def described(self) -> Mapping[str, Any]:
        """Return the number of values of each parameter."""
        return {"kind": "grid", "axes": {name: len(values) for name, values in self.axes.items()}}


def grid(**axes: ArrayLike) -> Grid:
    """Return all combinations of values, the last parameter fastest.

    Parameters
    ----------
    **axes : array
        Values of each parameter, numbers or words, shape [n].

    Raises
    ------
    InvalidInput
        If there is no parameter, or one has no value, the same one twice, or one that is not finite.
    """
    if not axes:
        raise InvalidInput("grid", "must vary a parameter at least", axes, "For example grid(restitution=[0.5, 0.9]).")
    found = {name: column(name, values) for name, values in axes.items()}
    for name, values in found.items():
        unique, counts = np.unique(values, return_counts=True)
        if len(unique) < len(values):
            twice = unique[counts > 1][0].item()
            raise InvalidInput(f"study: {name}", "must have each value once", twice, "Leave out the others.")
    return Grid(found)


@final
@dataclass(frozen=True, eq=False)
class Listed(Sampling):
    """Runs one by one; :func:`listed` and :func:`columns` make it.

    Attributes
    ----------
    values : mapping
        Of each parameter its values, shape [n].
    """

    values: Mapping[str, NDArray[Any]]

    def points(self) -> SamplePoints:
        """Return them as they are."""
        return SamplePoints(self.values, {})

    def described(self) -> Mapping[str, Any]:
        """Return the names."""
        return {"kind": "listed", "names": list(self.values)}


def listed(rows: Iterable[Mapping[str, Value]]) -> Listed:
    """Return runs that are listed one by one.

    Parameters
    ----------
    rows : iterable of dict
        Of each run its parameters; the same names in each.

    Raises
    ------
    InvalidInput
        If there is none, one lacks a name, or a value is not finite.
    """
    all_rows = [dict(row) for row in rows]
    names = list(all_rows[0]) if all_rows else []
    for number, row in enumerate(all_rows):
        if set(row) != set(names):
            thing = f"listed: row {number}"
            raise InvalidInput(thing, f"must have the names {', '.join(names)}", sorted(row), "Complete it.")
    return columns({name: [row[name] for row in all_rows] for name in names})


def columns(table: Any) -> Listed:
    """Return runs out of the columns of a table.

    Parameters
    ----------
    table : mapping, or DataFrame
        Whatever gives names when it is iterated over, and the column of a name in brackets: all of one length.

    Raises
    ------
    InvalidInput
        If there is no column, lengths differ, or a value is not finite.
    """
    found = {str(name): column(str(name), table[name]) for name in table}
    lengths = {name: len(values) for name, values in found.items()}
    if len(set(lengths.values())) != 1:
        rule = "must have columns, all of one length"
        raise InvalidInput("study: table", rule, lengths, 'For example listed([{"restitution": 0.5}]).')
    return Listed(found)
