"""A triangle mesh over a plane, in closed form."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.notices import warn
from nonsmooth.parameters import UnusualValue, parameter

from ...shapes.ground import Ground
from ...shapes.triangle_mesh import TriangleMesh
from .plane_point import evaluate_ball_over_plane

MANY = 200
"""Number of corners above which a warning says what they cost."""


@final
@dataclass(frozen=True)
class PlaneMesh(ContactKinematics):
    """One corner of the convex hull of a mesh over a plane; a mesh has as many contacts as its hull has corners.

    That is exact for any mesh, convex or not: no other point of it comes nearer to a plane.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Ground, TriangleMesh)

    x: float = parameter(doc="corner in its body frame, first coordinate", unit="m")
    y: float = parameter(doc="corner in its body frame, second coordinate", unit="m")
    z: float = parameter(doc="corner in its body frame, third coordinate", unit="m")
    height: float = parameter(doc="height of the plane in its body frame", unit="m")

    def parameters(self) -> dict[str, float]:
        """Return the numbers given, and a radius of 0: a corner is the smallest ball."""
        return {"radius": 0.0, **self.numbers()}

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[PlaneMesh, ...]:
        """Return the contacts of the corners."""
        assert isinstance(second, TriangleMesh)
        height, corners = first.parameters()["height"], second.corners.tolist()
        if len(corners) > MANY:
            warn(
                f"mesh {second.surface.mesh.name}: its hull has {len(corners)} corners, each a contact of its own with "
                "a plane, and every step looks at all of them. Is it a rounded body? Take a coarser mesh, or a shape "
                "in closed form (Sphere, Ellipsoid, Cylinder, ...), which is exact and has one contact.",
                UnusualValue,
            )
        return tuple(cls(x, y, z, height) for x, y, z in corners)

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return evaluate_ball_over_plane

    @property
    def features(self) -> tuple[str, ...]:
        """Name of the only pair of features."""
        return ("plane-vertex",)
