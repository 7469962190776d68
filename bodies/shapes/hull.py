"""ConvexHull, the smallest convex body that holds given points."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, final

import numpy as np

from nonsmooth.interfaces.body import Vector
from nonsmooth.parameters import parameter
from nonsmooth.vectors import UNIT_PART, unit_vector

from .drawing import solid_of
from .placement import with_axes
from .polyhedron import Polyhedron
from .polytope import Polytope, polytope_of, read_points
from .swept_solid import draw_swept, swept_solid


@final
@dataclass(frozen=True)
class ConvexHull(Polyhedron):
    """The convex hull of points, turned by a unit quaternion about the origin of the body frame, then shifted.

    With a radius ``rounding`` it is all points within that distance of the hull: the points are those of the core, and
    the faces stand out by the radius.

    Attributes
    ----------
    points : sequence
        At least four points that are not in one plane [m, shape (n, 3)].  Those inside, on a face or on an edge do not
        matter; facets in one plane are one face.

    Raises
    ------
    InvalidInput
        If a point is not finite, they have no volume, or their hull has too many vertices.
    """

    points: Sequence[Sequence[float]] = field()
    x: float = parameter(0.0, doc="shift, first coordinate", unit="m")
    y: float = parameter(0.0, doc="shift, second coordinate", unit="m")
    z: float = parameter(0.0, doc="shift, third coordinate", unit="m")
    orientation_w: float = parameter(1.0, doc="quaternion from its axes to the body's, scalar part", **UNIT_PART)
    orientation_x: float = parameter(0.0, doc="quaternion, first component", **UNIT_PART)
    orientation_y: float = parameter(0.0, doc="quaternion, second component", **UNIT_PART)
    orientation_z: float = parameter(0.0, doc="quaternion, third component", **UNIT_PART)
    rounding: float = parameter(0.0, doc="radius of the sphere that sweeps the hull", unit="m", minimum=0.0)

    @classmethod
    def example(cls) -> Mapping[str, Any]:
        """Return the points of a tetrahedron."""
        return {"points": ((0.0, 0.0, 0.0), (0.1, 0.0, 0.0), (0.0, 0.2, 0.0), (0.0, 0.0, 0.3))}

    def _check(self) -> None:
        orientation = self.orientation_w, self.orientation_x, self.orientation_y, self.orientation_z
        unit_vector("ConvexHull orientation", orientation, 4)
        object.__setattr__(self, "points", read_points("ConvexHull.points", self.points))
        assert self.core

    @property
    def core(self) -> Polytope:
        """Vertices, faces and edges of the hull of the points in the body frame."""
        axes = with_axes(self.orientation_w, self.orientation_x, self.orientation_y, self.orientation_z)
        placed = np.array(self.points) @ axes.T + [self.x, self.y, self.z]
        return polytope_of("ConvexHull.points", tuple((x, y, z) for x, y, z in placed.tolist()))

    @property
    def _solid(self) -> tuple[float, Vector, Vector]:
        if self.rounding > 0.0:
            return swept_solid(self.core, self.rounding)
        return solid_of(*self.drawing())

    @property
    def volume(self) -> float:
        """By the tetrahedra of its faces; of a rounded one, piece by piece [m^3]."""
        return self._solid[0]

    @property
    def centroid(self) -> Vector:
        """By the tetrahedra of its faces; of a rounded one, piece by piece [m]."""
        return self._solid[1]

    @property
    def inertia(self) -> Vector:
        """By the tetrahedra of its faces; of a rounded one, piece by piece [m^5]."""
        return self._solid[2]

    def drawing(self, fineness: int = 24) -> tuple[Vector, Vector]:
        """Return its vertices, and its faces as fans; of a rounded one strips at edges and caps at vertices, too."""
        if self.rounding > 0.0:
            return draw_swept(self.core, self.rounding, fineness)
        return np.array(self.core.vertices), np.array(self.core.triangles)
