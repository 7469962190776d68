"""SmoothShape: what all shapes with a smooth support function or a smooth gauge have in common."""

from __future__ import annotations

from abc import abstractmethod

from nonsmooth.interfaces import ConvexShape


class SmoothShape(ConvexShape):
    """A convex shape without edges, known by the numbers of a core.

    Its radii of curvature are finite and do not jump, or, if it is boxy, its curvatures, which are 0 at flat points.
    """

    @property
    @abstractmethod
    def core(self) -> tuple[float, ...]:
        """Its support function in numbers (:func:`bodies.shapes.smooth.core_numbers`)."""

    @property
    def boxy(self) -> bool:
        """Whether it has flat points: a pair that divides by its curvatures cannot take it."""
        return self.core[0] > 0.0 and self.core[3] < 2.0 and self.core[4] <= 2.0

    @property
    def mixed(self) -> bool:
        """Whether it is flat along one of two ways and sharp along the other."""
        return self.core[0] > 0.0 and (self.core[3] - 2.0) * (self.core[4] - 2.0) < 0.0
