"""Parameters that are listed run by run."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, final

from numpy.typing import NDArray

from nonsmooth.errors import InvalidInput
from nonsmooth.studies.sampling.points import Points, Value, column
from nonsmooth.studies.sampling.sampling import Sampling


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

    def points(self) -> Points:
        """Return them as they are."""
        return Points(self.values, {})

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
