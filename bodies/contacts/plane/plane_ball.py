"""Points, spheres and the vertices of bodies over a plane: each a ball, whose contact has a closed form."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar, final

from nonsmooth.interfaces import ContactKinematics, FeaturePair, Shape
from nonsmooth.notices import warn
from nonsmooth.parameters import UnusualValue, Value

from ...shapes.ground import Ground
from ...shapes.point import Point
from ...shapes.sphere import Sphere
from ...shapes.surface_shape import SurfaceShape
from .plane_point import evaluate_ball_over_plane

MANY = 200
"""Number of corners of a surface above which a warning says what they cost."""


def ball_over_plane(plane: Shape, radius: float, center: Sequence[float], name: str) -> FeaturePair:
    """Return the contact of a plane and a ball, whose centre is in its body frame [m]; a point has radius 0."""
    assert isinstance(plane, Ground)
    x, y, z = center
    # three numbers, not a vector: this is the commonest contact, and a vector is one more reference to follow
    values: dict[str, Value] = {"radius": radius, "x": x, "y": y, "z": z, "height": plane.height}
    return FeaturePair(evaluate_ball_over_plane, values, (f"plane-{name}",))


@final
class PlaneSphere(ContactKinematics):
    """A sphere over a plane: one contact, Eqs. (8)-(13)."""

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Ground, Sphere)

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FeaturePair, ...]:
        """Return the single contact of a plane and a sphere."""
        assert isinstance(second, Sphere)
        return (ball_over_plane(first, second.radius, (second.x, second.y, second.z), "sphere"),)


@final
class PlaneVertex(ContactKinematics):
    """A point over a plane: one contact."""

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Ground, Point)

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FeaturePair, ...]:
        """Return the single contact of a plane and a point."""
        assert isinstance(second, Point)
        return (ball_over_plane(first, 0.0, (second.x, second.y, second.z), "vertex"),)


@final
class PlaneSurface(ContactKinematics):
    """A box, hull, capsule or mesh over a plane: a contact of each corner of its convex hull, with its radius.

    That is exact for any surface, convex or not: no other point of it is nearer to a plane.  A capsule has two corners,
    its ends, which hold it when it lies.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Ground, SurfaceShape)

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FeaturePair, ...]:
        """Return the contacts of the corners."""
        assert isinstance(second, SurfaceShape)
        corners = second.corners.tolist()
        if len(corners) > MANY:
            warn(
                f"{type(second).__name__}: its hull has {len(corners)} corners. Each is a contact of its own with a "
                "plane, and every step looks at all of them. Is it a rounded body? Take a coarser mesh, or a shape in "
                "closed form (Sphere, Ellipsoid, Cylinder, ...), which is exact and has one contact.",
                UnusualValue,
            )
        return tuple(ball_over_plane(first, second.sweep, corner, "vertex") for corner in corners)
