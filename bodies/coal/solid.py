"""CoalSolid: a shape as an object of coal."""

from __future__ import annotations

import importlib.util
from typing import final

import numpy as np

from bodies.coal.geometry import MAKERS
from bodies.distances.placing import made
from bodies.distances.solid import Frame, Solid
from nonsmooth.errors import MissingPackagesError
from nonsmooth.interfaces import Shape
from nonsmooth.interfaces.body import Vector

_TOLERANCE = 1e-12
"""Of the distance [m]; the search for a depth fails with it, so that no depth is asked for."""


@final
class CoalSolid(Solid):
    """A shape of a body as an object of coal.

    Parameters
    ----------
    shape : Shape
        A bounded solid of a kind that coal has.

    Raises
    ------
    MissingPackagesError
        If coal is not installed.
    InvalidInput
        If coal has no such kind, or a triangle of it is degenerate.
    """

    def __init__(self, shape: Shape) -> None:
        if importlib.util.find_spec("coal") is None:
            raise MissingPackagesError('Distances by coal need it: pip install "nonsmooth[coal]"')
        super().__init__(shape, made("coal", MAKERS, shape))

    def distance(self, own: Frame, other: Solid, its: Frame) -> tuple[float, Vector, Vector]:
        """Return the unsigned distance [m] and nearest points."""
        import coal

        request, result = coal.DistanceRequest(), coal.DistanceResult()
        request.enable_signed_distance = False
        request.gjk_tolerance = _TOLERANCE
        frames = [coal.Transform3s(np.array(axes), np.array(place)) for place, axes in (own, its)]
        distance = coal.distance(self.geometry, frames[0], other.geometry, frames[1], request, result)
        return float(distance), np.array(result.getNearestPoint1()), np.array(result.getNearestPoint2())
