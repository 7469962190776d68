"""SmoothShape: what all shapes with a smooth support function or a smooth gauge have in common."""

from __future__ import annotations

from abc import abstractmethod

import numpy as np

from bodies.shapes.support_function import FUNCTION, OF_FUNCTION
from nonsmooth.interfaces import ConvexPart, ConvexShape


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

    @property
    def parts(self) -> tuple[ConvexPart, ...]:
        """The core with its radius."""
        core = self.core
        a, b, c, p, q, radius = core[:6]
        place, axes = np.array(core[6:9]), np.array(core[9:18]).reshape(3, 3)
        if p == OF_FUNCTION:
            reach = self.length + float(np.linalg.norm(place))
            return (ConvexPart(ball=radius, place=place, axes=axes, function=core[FUNCTION:], reach=reach),)
        return (ConvexPart(semi=(a, b, c), powers=(p, q), ball=radius, place=place, axes=axes),)
