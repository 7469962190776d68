"""What a query answers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from nonsmooth.interfaces.solid import Vector

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
