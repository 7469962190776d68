"""Result of a query for the distance of two bodies or shapes: gap, bounds, nearest points, normal and method."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from nonsmooth.interfaces.solid import Vector

PAIR = "pair"
"""Name of the method that needs no library, for ``DistanceResult.how``."""


@final
@dataclass(frozen=True, eq=False)
class DistanceResult:
    """Distance of two bodies or shapes, with bounds, nearest points and normal.

    Attributes
    ----------
    gap : float
        Distance; if they overlap, minus the length of a translation along ``normal`` that separates them [m].
    lower, upper : float
        Bounds of the gap [m]. Two planes normal to ``normal`` prove the lower bound. The distance of ``first`` and
        ``second`` is the upper bound, or minus the depth of an overlap that is proved. If a library computed the gap,
        its error is subtracted and added.
    first, second : Vector
        Point of each body that is nearest to the other body, or deepest in it, in world axes [m], shape [3].
    normal : Vector
        Unit vector from the first to the second, shape [3].
    how : str
        Method: "pair" for the search with the convex parts or triangles of the pair, or the name of a library.
    shapes : tuple of int
        Number of the shape of each body, counted through all of its frames.
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
        """Largest possible error of the gap [m]."""
        return max(self.upper - self.gap, self.gap - self.lower)

    def exchanged(self) -> DistanceResult:
        """The same distance with first and second body exchanged."""
        return DistanceResult(
            self.gap, self.lower, self.upper, self.second, self.first, -self.normal, self.how, self.shapes[::-1]
        )
