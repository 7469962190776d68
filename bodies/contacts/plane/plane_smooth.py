"""A smooth body over a plane, in closed form."""

from __future__ import annotations

import math
from typing import ClassVar, final

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import SIDE_B
from nonsmooth.interfaces import ContactKinematics, FeaturePair, Shape
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...rotations import rotated, rotated_back
from ...shapes.ellipsoid import Ellipsoid
from ...shapes.ground import Ground
from ...shapes.smooth import SmoothShape
from ...shapes.support_function import support_of
from ...vectors import Vector3, cross, divided, dot, opposite, plus, plus_scaled, vector_at
from ..features.frames import point_in_world, turned_by, vector_in_body
from ..smooth.smooth_core import CENTER, RADIUS, axes_in_world
from ..smooth.smooth_newton import write_surface
from ..smooth.tangent_plane import write_matrices
from .plane_point import axis_of, place_over_plane


@compiled
def scaled(factors: Vector3, v: Vector3) -> Vector3:
    """Return the products of the components of two vectors, as a vector."""
    return factors[0] * v[0], factors[1] * v[1], factors[2] * v[2]


def evaluate_smooth_over_plane(a: Floats, b: Floats, out: Floats, second: Floats, height: float) -> None:
    """Write the geometry block of a smooth body, given as a core, over a plane at a ``height`` along its axis [m]."""
    axes, n = axes_in_world(b, second), axis_of(a, 2)
    normal = rotated_back(axes, opposite(n))
    _, point, _ = support_of(second, normal)
    lowest = plus(point_in_world(b, vector_at(second, CENTER)), rotated(axes, point))
    place_over_plane(a, out, plus_scaled(lowest, -second[RADIUS], n), height)
    write_surface(out, SIDE_B, second, axes, normal, point)


def evaluate_ellipsoid_over_plane(
    a: Floats, b: Floats, out: Floats, semi: Floats, center: Floats, orientation: Floats, height: float
) -> None:
    """Write the geometry block of an ellipsoid over a plane.

    The ellipsoid has the semi-axes ``semi`` [m], the ``center`` in its body frame [m], and the quaternion
    ``orientation`` from its axes to those of the body.  ``height`` is that of the plane in its body frame [m].
    """
    # the outward normal of the ellipsoid at the point sought, in its own axes, and the plane's tangents there
    w, x, y, z = orientation[0], orientation[1], orientation[2], orientation[3]
    n, s = vector_in_body(b, opposite(axis_of(a, 2))), vector_in_body(b, axis_of(a, 0))
    n, s = turned_by(w, -x, -y, -z, n[0], n[1], n[2]), turned_by(w, -x, -y, -z, s[0], s[1], s[2])
    t = cross(s, n)
    # the support function h [m], and its gradient, which is the lowest point [m]
    squares = semi[0] * semi[0], semi[1] * semi[1], semi[2] * semi[2]
    h = math.sqrt(dot(scaled(squares, n), n))
    p = divided(scaled(squares, n), h)
    lowest = plus(vector_at(center, 0), turned_by(w, x, y, z, p[0], p[1], p[2]))
    place_over_plane(a, out, point_in_world(b, lowest), height)
    # slide 1, turn the second derivative of h in the tangent plane: the inverse of the shape operator
    along_s, along_t, across_s, across_t = dot(p, s), dot(p, t), scaled(squares, s), scaled(squares, t)
    turn = (
        (dot(across_s, s) - along_s * along_s) / h,
        (dot(across_s, t) - along_s * along_t) / h,
        (dot(across_t, t) - along_t * along_t) / h,
    )
    write_matrices(out, SIDE_B, (1.0, 0.0, 1.0), turn)


@final
class PlaneSmooth(ContactKinematics):
    """A smooth body over a plane: one contact, of its lowest point."""

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Ground, SmoothShape)

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FeaturePair, ...]:
        """Return the single contact of a plane and a smooth shape."""
        assert isinstance(first, Ground)
        assert isinstance(second, SmoothShape)
        values: dict[str, Value] = {"second": second.core, "height": first.height}
        return (FeaturePair(evaluate_smooth_over_plane, values, ("plane-smooth",)),)


@final
class PlaneEllipsoid(ContactKinematics):
    """An ellipsoid over a plane: one contact, of its lowest point."""

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Ground, Ellipsoid)

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FeaturePair, ...]:
        """Return the single contact of a plane and an ellipsoid."""
        assert isinstance(first, Ground)
        assert isinstance(second, Ellipsoid)
        numbers = tuple(second.numbers().values())
        values: dict[str, Value] = {"semi": numbers[:3], "center": numbers[3:6], "orientation": numbers[6:10]}
        values["height"] = first.height
        return (FeaturePair(evaluate_ellipsoid_over_plane, values, ("plane-ellipsoid",)),)
