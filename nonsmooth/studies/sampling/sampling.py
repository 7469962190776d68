"""Sampling: the parameters of all runs of a study, drawn before any of them runs."""

from __future__ import annotations

import hashlib
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.errors import InvalidInput


class Sampling(ABC):
    """Chooses the parameters of all runs.

    The contract:

    1. ``points`` returns the same each time, and raises InvalidInput where there is nothing to choose from.
    2. ``described`` says how, in words and numbers that JSON has.
    """

    @abstractmethod
    def points(self) -> SamplePoints:
        """Return the parameters of all runs.

        Raises
        ------
        InvalidInput
            If an axis is empty, or a value is not finite.
        """

    @abstractmethod
    def described(self) -> Mapping[str, Any]:
        """Return what it is, for the record."""


Value: TypeAlias = float | str
_STORED = {"i": "int64", "u": "uint64", "f": "float64", "U": "U"}


@final
@dataclass(frozen=True, eq=False)
class SamplePoints:
    """The parameters of all runs.

    Attributes
    ----------
    columns : mapping
        Of each varied parameter its values, finite numbers or words, shape [n].
    dims : mapping
        Of a grid the length of each axis, in C order; empty where runs are in no order.
    """

    columns: Mapping[str, NDArray[Any]]
    dims: Mapping[str, int]

    def __len__(self) -> int:
        return len(next(iter(self.columns.values())))

    def at(self, run: int) -> dict[str, Value]:
        """Return the parameters of a run."""
        return {name: column[run].item() for name, column in self.columns.items()}

    @property
    def digest(self) -> str:
        """Of all values, to the last bit."""
        found = hashlib.sha256()
        for name, column in self.columns.items():
            found.update(f"{name} {column.dtype.str} ".encode() + np.ascontiguousarray(column).tobytes())
        return found.hexdigest()


def column(name: str, values: Any) -> NDArray[Any]:
    """Return the values of a parameter as a row of numbers or words; whole numbers, as seeds are, stay whole.

    Raises
    ------
    InvalidInput
        If there are none, or they are neither finite numbers nor words.
    """
    thing = f"study: {name}"
    try:
        found = np.asarray(values)
    except ValueError as error:
        raise InvalidInput(thing, "must be a row of numbers or of words", values, "Give a list of them.") from error
    if found.ndim != 1 or found.dtype.kind not in "iufU":
        raise InvalidInput(thing, "must be a row of numbers or of words", values, "Give a list of them.")
    if len(found) == 0:
        raise InvalidInput(thing, "must have a value at least", values, "Give one value or more.")
    if found.dtype.kind == "f" and not np.isfinite(found).all():
        bad = found[~np.isfinite(found)][0].item()
        raise InvalidInput(thing, "must have finite values", bad, "Leave out what is not a number.")
    return found.astype(_STORED[found.dtype.kind], copy=False)
