"""Coal: distances by coal, a fork of FCL with tolerances that can be set; needs nonsmooth[coal]."""

from __future__ import annotations

import importlib.util
from dataclasses import dataclass
from typing import Any, final

import numpy as np

from nonsmooth.interfaces.body import Vector
from nonsmooth.interfaces.distance_backend import Place

from ..meshes.topology import Integers
from .geometries import Made
from .library import Library

_TOLERANCE = 1e-12
"""Of the distance [m]; the search for a depth fails with it, so that no depth is asked for."""


@final
@dataclass(frozen=True)
class Coal(Library):
    """Distances by coal, where ``nonsmooth[coal]`` is installed, which Windows has no wheel of."""

    @property
    def rank(self) -> int:
        """After FCL, which all have: an answer does not depend on what else is installed."""
        return 1

    @property
    def installed(self) -> bool:
        """Whether coal is there."""
        return importlib.util.find_spec("coal") is not None

    @property
    def part(self) -> float:
        """Of ellipsoids beside boxes and cylinders 3e-8 m was met for bodies of a centimetre."""
        return 1e-5

    def ball(self, radius: float) -> Any:
        """Return a ball."""
        import coal

        return coal.Sphere(radius)

    def box(self, sides: tuple[float, float, float]) -> Any:
        """Return a box."""
        import coal

        return coal.Box(np.array(sides))

    def capsule(self, radius: float, length: float) -> Any:
        """Return a capsule."""
        import coal

        return coal.Capsule(radius, length)

    def cylinder(self, radius: float, length: float) -> Any:
        """Return a cylinder."""
        import coal

        return coal.Cylinder(radius, length)

    def cone(self, radius: float, height: float) -> Any:
        """Return a cone."""
        import coal

        return coal.Cone(radius, height)

    def ellipsoid(self, semi_axes: tuple[float, float, float]) -> Any:
        """Return an ellipsoid."""
        import coal

        return coal.Ellipsoid(*semi_axes)

    def hull(self, vertices: Vector, faces: Integers) -> Any:
        """Return a convex polyhedron."""
        import coal

        return coal.Convex(*_lists(vertices, faces))

    def mesh(self, vertices: Vector, faces: Integers) -> Any:
        """Return a tree of triangles."""
        import coal

        model = coal.BVHModelOBBRSS()
        model.beginModel(len(faces), len(vertices))
        model.addSubModel(*_lists(vertices, faces))
        model.endModel()
        return model

    def unsigned(self, first: Made, one: Place, second: Made, two: Place) -> tuple[float, Vector, Vector]:
        """Return the distance and nearest points."""
        import coal

        request, result = coal.DistanceRequest(), coal.DistanceResult()
        request.enable_signed_distance = False
        request.gjk_tolerance = _TOLERANCE
        frames = [coal.Transform3s(np.array(axes), np.array(place)) for place, axes in (one, two)]
        distance = coal.distance(first.geometry, frames[0], second.geometry, frames[1], request, result)
        return float(distance), np.array(result.getNearestPoint1()), np.array(result.getNearestPoint2())


def _lists(vertices: Vector, faces: Integers) -> tuple[Any, Any]:
    """Return vertices and triangles as lists of the library."""
    import coal

    points, numbers = coal.StdVec_Vec3s(), coal.StdVec_Triangle()
    for vertex in vertices:
        points.append(vertex)
    for face in faces.tolist():
        numbers.append(coal.Triangle(*face))
    return points, numbers
