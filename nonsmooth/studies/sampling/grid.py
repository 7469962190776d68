"""All combinations of the values of some parameters."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nonsmooth.errors import InvalidInput
from nonsmooth.studies.sampling.points import Points, column
from nonsmooth.studies.sampling.sampling import Sampling


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

    def points(self) -> Points:
        """Return the combinations, the last parameter fastest."""
        sizes = [len(values) for values in self.axes.values()]
        places = np.unravel_index(np.arange(int(np.prod(sizes))), sizes)
        names = dict(zip(self.axes, places, strict=True))
        return Points(
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
