"""Fcl: distances by python-fcl, the Flexible Collision Library."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, final

import numpy as np

from nonsmooth.interfaces.body import Vector
from nonsmooth.interfaces.distance_backend import Place

from ..meshes.topology import Integers
from ..shapes.sphere import Sphere
from ..shapes.triangle_mesh import TriangleMesh
from .geometries import Made
from .library import Library

SCALE = 1e6
"""Factor by which everything is enlarged: the tolerance of FCL is 1e-6 whatever the size of the bodies."""


@final
@dataclass(frozen=True)
class Fcl(Library):
    """Distances by FCL, of bodies enlarged a million times; installed with the framework."""

    @property
    def rank(self) -> int:
        """First."""
        return 0

    @property
    def installed(self) -> bool:
        """Always: it is required."""
        return True

    @property
    def part(self) -> float:
        """Of cones beside hulls 6e-7 m was met for bodies of a centimetre."""
        return 1e-4

    def ball(self, radius: float) -> Any:
        """Return a ball."""
        import fcl

        return fcl.Sphere(SCALE * radius)

    def box(self, sides: tuple[float, float, float]) -> Any:
        """Return a box."""
        import fcl

        return fcl.Box(*(SCALE * side for side in sides))

    def capsule(self, radius: float, length: float) -> Any:
        """Return a capsule."""
        import fcl

        return fcl.Capsule(SCALE * radius, SCALE * length)

    def cylinder(self, radius: float, length: float) -> Any:
        """Return a cylinder."""
        import fcl

        return fcl.Cylinder(SCALE * radius, SCALE * length)

    def cone(self, radius: float, height: float) -> Any:
        """Return a cone."""
        import fcl

        return fcl.Cone(SCALE * radius, SCALE * height)

    def ellipsoid(self, semi_axes: tuple[float, float, float]) -> Any:
        """Return an ellipsoid."""
        import fcl

        return fcl.Ellipsoid(*(SCALE * axis for axis in semi_axes))

    def hull(self, vertices: Vector, faces: Integers) -> Any:
        """Return a convex polyhedron."""
        import fcl

        flat = np.concatenate([np.full((len(faces), 1), 3), faces], axis=1).ravel().astype(np.int32)
        return fcl.Convex(SCALE * vertices, len(faces), flat)

    def mesh(self, vertices: Vector, faces: Integers) -> Any:
        """Return a tree of triangles."""
        import fcl

        model = fcl.BVHModel()
        model.beginModel(len(vertices), len(faces))
        model.addSubModel(SCALE * vertices, faces.astype(np.int32))
        model.endModel()
        return model

    def unsigned(self, first: Made, one: Place, second: Made, two: Place) -> tuple[float, Vector, Vector]:
        """Return the distance, of the geometries enlarged, and nearest points."""
        import fcl

        objects = [
            fcl.CollisionObject(
                solid.geometry, fcl.Transform(np.ascontiguousarray(axes), np.ascontiguousarray(SCALE * place))
            )
            for solid, (place, axes) in ((first, one), (second, two))
        ]
        # a result keeps the least distance it ever held
        request, result = fcl.DistanceRequest(enable_nearest_points=True), fcl.DistanceResult()
        distance = fcl.distance(*objects, request, result) / SCALE
        points = [np.array(point, dtype=float) / SCALE for point in result.nearest_points]
        if isinstance(first.shape, TriangleMesh) and isinstance(second.shape, Sphere):
            # these come in the frames of the bodies
            points = [place + axes @ point for point, (place, axes) in zip(points, (one, two), strict=True)]
        return distance, points[0], points[1]
