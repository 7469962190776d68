"""SmoothShape: what all shapes with a smooth support function have in common."""

from __future__ import annotations

from abc import abstractmethod

from nonsmooth.interfaces import ConvexShape


class SmoothShape(ConvexShape):
    """A convex shape without flat places, whose radii of curvature are finite and do not jump."""

    @property
    @abstractmethod
    def core(self) -> tuple[float, ...]:
        """Its support function in numbers (:func:`bodies.shapes.smooth.core_numbers`)."""
