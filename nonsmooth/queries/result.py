"""What a query answers."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING, final

import numpy as np

from nonsmooth.datasets import Told, dataset
from nonsmooth.interfaces.solid import Vector

if TYPE_CHECKING:
    import xarray

_TOLD: Told = {
    "gap": ((), "m", "distance, or minus a way that parts them"),
    "lower": ((), "m", "what the gap is not below"),
    "upper": ((), "m", "what the gap is not above"),
    "first": (("axis",), "m", "nearest point of the first body"),
    "second": (("axis",), "m", "nearest point of the second body"),
    "normal": (("axis",), "1", "from the first body to the second"),
    "how": ((), "1", "how it was found"),
}
EXACT, PLANES = "exact", "planes"
"""Ways in which a distance is found, beside the names of libraries."""


@final
@dataclass(frozen=True, eq=False)
class DistanceResult:
    """How far two bodies or shapes are from each other.

    Attributes
    ----------
    gap : float
        Their distance, or, if they overlap, minus a way that parts them [m].
    lower, upper : float
        What the gap is between [m]; of library answers to the error that the library states.
    first, second : Vector
        The point of either that is nearest to, or deepest in, the other one, in the world [m], shape [3].
    normal : Vector
        Unit vector from the first to the second, shape [3].
    how : str
        "exact" by the contact kinematics of the pair, whose least gap of features that face is proved by what stands in
        ``lower``; "planes" by solids, between planes that part them or show how far they overlap; or the name of the
        library that told it.
    shapes : tuple of int
        Number of the shape of either body that is meant, counted through all of its frames.
    """

    gap: float
    lower: float
    upper: float
    first: Vector
    second: Vector
    normal: Vector
    how: str
    shapes: tuple[int, int] = (0, 0)

    @property
    def error(self) -> float:
        """How far the gap may be off [m]."""
        return max(self.upper - self.gap, self.gap - self.lower)

    def exchanged(self) -> DistanceResult:
        """Return the same with the first in place of the second."""
        return DistanceResult(
            self.gap, self.lower, self.upper, self.second, self.first, -self.normal, self.how, self.shapes[::-1]
        )


@final
@dataclass(frozen=True, eq=False)
class DistanceHistory:
    """How far two bodies are from each other at times of a run; what its parts are says :class:`DistanceResult`.

    Attributes
    ----------
    t : Vector
        Times [s], shape [n].
    gap, lower, upper : Vector
        [m], shape [n].
    first, second, normal : Vector
        Points [m] and unit vectors, shape [n, 3].
    how : tuple of str
        How each was found.
    bodies : tuple of str
        Names of the two bodies.
    """

    t: Vector
    gap: Vector
    lower: Vector
    upper: Vector
    first: Vector
    second: Vector
    normal: Vector
    how: tuple[str, ...]
    bodies: tuple[str, str]

    def __repr__(self) -> str:
        """Return the least gap, when it is, and how often which way told."""
        if len(self.t) == 0:
            return "DistanceHistory(no samples)"
        least = int(np.argmin(self.gap))
        ways = ", ".join(f"{way} {n}" for way, n in Counter(self.how).most_common())
        return f"DistanceHistory(least gap {self.gap[least]:.6g} m at t = {self.t[least]:.6g} s; told by {ways})"

    def to_xarray(self) -> xarray.Dataset:
        """Return it as a dataset with units."""
        return dataset(self, self.t, _TOLD, first_body=self.bodies[0], second_body=self.bodies[1])

    @classmethod
    def of(cls, t: Vector, results: list[DistanceResult], bodies: tuple[str, str]) -> DistanceHistory:
        """Return the history of some results for two bodies of these names."""
        gap, lower, upper = np.array([(one.gap, one.lower, one.upper) for one in results]).reshape(-1, 3).T
        points = [(one.first, one.second, one.normal) for one in results]
        first, second, normal = np.moveaxis(np.array(points).reshape(-1, 3, 3), 1, 0)
        return cls(t, gap, lower, upper, first, second, normal, tuple(one.how for one in results), bodies)
