"""FclSolid: a shape as an object of FCL."""

from __future__ import annotations

from typing import Any, final

import numpy as np

from bodies.distances.placing import made
from bodies.distances.solid import Frame, Solid
from bodies.fcl.geometry import MAKERS, SCALE
from bodies.shapes.sphere import Sphere
from bodies.shapes.triangle_mesh import TriangleMesh
from nonsmooth.interfaces import Shape
from nonsmooth.interfaces.body import Vector


@final
class FclSolid(Solid):
    """A shape of a body as an object of FCL, enlarged.

    Parameters
    ----------
    shape : Shape
        A bounded solid of a kind that FCL has.

    Raises
    ------
    InvalidInput
        If FCL has no such kind, or a triangle of it is degenerate.
    """

    def __init__(self, shape: Shape) -> None:
        import fcl

        super().__init__(shape, made("FCL", MAKERS, shape))
        self._object = fcl.CollisionObject(self.geometry, fcl.Transform())

    def distance(self, own: Frame, other: Solid, its: Frame) -> tuple[float, Vector, Vector]:
        """Return the unsigned distance [m], of the bodies enlarged, and nearest points."""
        import fcl

        assert isinstance(other, FclSolid)
        two = FclSolid(other.shape) if other is self else other
        # a result keeps the least distance it ever held
        request, result = fcl.DistanceRequest(enable_nearest_points=True), fcl.DistanceResult()
        distance = fcl.distance(self._at(own), two._at(its), request, result) / SCALE
        points = [np.array(point, dtype=float) / SCALE for point in result.nearest_points]
        if type(self.shape) is TriangleMesh and type(other.shape) is Sphere:
            # these come in the frames of the bodies
            points = [place + axes @ point for point, (place, axes) in zip(points, (own, its), strict=True)]
        return distance, points[0], points[1]

    def _at(self, frame: Frame) -> Any:
        import fcl

        place, axes = frame
        self._object.setTransform(fcl.Transform(np.ascontiguousarray(axes), np.ascontiguousarray(SCALE * place)))
        return self._object
