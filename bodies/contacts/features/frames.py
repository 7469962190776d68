"""Vector functions of contacts: world and body axes, a tangent to a normal, components along and across an axis."""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import NORMAL, POSITION, ROTATION, TANGENT
from nonsmooth.types import Floats

from ...rotations import Axes, rotated, rotated_back
from ...shapes.placement import turned
from ...vectors import Vector3, divided, dot, minus, norm, scaled, vector_at, write_vector


@compiled
def point_in_world(frame: Floats, point: Vector3) -> Vector3:
    """Return a point of a body frame in world coordinates [m]."""
    x, y, z = point
    return (
        frame[POSITION] + frame[ROTATION] * x + frame[ROTATION + 1] * y + frame[ROTATION + 2] * z,
        frame[POSITION + 1] + frame[ROTATION + 3] * x + frame[ROTATION + 4] * y + frame[ROTATION + 5] * z,
        frame[POSITION + 2] + frame[ROTATION + 6] * x + frame[ROTATION + 7] * y + frame[ROTATION + 8] * z,
    )


@compiled
def axes_of(frame: Floats) -> Axes:
    """Return the axes of a body in the world, as columns."""
    x, y, z = vector_at(frame, ROTATION), vector_at(frame, ROTATION + 3), vector_at(frame, ROTATION + 6)
    return x[0], x[1], x[2], y[0], y[1], y[2], z[0], z[1], z[2]


@compiled
def vector_in_world(frame: Floats, vector: Vector3) -> Vector3:
    """Return the components in world axes of a vector given in body axes."""
    return rotated(axes_of(frame), vector)


@compiled
def vector_in_body(frame: Floats, vector: Vector3) -> Vector3:
    """Return the components in body axes of a vector given in world axes."""
    return rotated_back(axes_of(frame), vector)


@compiled
def point_in_body(frame: Floats, point: Vector3) -> Vector3:
    """Return a point of the world in the coordinates of a body frame [m]."""
    return vector_in_body(frame, minus(point, vector_at(frame, POSITION)))


@compiled
def point_seen_from(frame: Floats, other: Floats, point: Vector3) -> Vector3:
    """Return a point of the body ``other`` in the coordinates of the body ``frame`` [m]."""
    return point_in_body(frame, point_in_world(other, point))


@compiled
def vector_seen_from(frame: Floats, other: Floats, vector: Vector3) -> Vector3:
    """Return the components in the axes of the body ``frame`` of a vector given in those of the body ``other``."""
    return vector_in_body(frame, vector_in_world(other, vector))


turned_by = compiled(turned)
"""``turned_by(w, x, y, z, a, b, c)``: the vector (a, b, c) turned by a unit quaternion."""


@compiled
def across(vector: Vector3, axis: Vector3) -> tuple[float, float, Vector3]:
    """Split a vector by a unit axis: component along the axis, length of the part across it, unit vector of this part.

    The unit vector is perpendicular to the axis even if the part across the axis is zero.
    """
    along = dot(vector, axis)
    part = minus(vector, scaled(along, axis))
    size = norm(part)
    if size > 0.0:
        part = divided(part, size)
        # if the vector is nearly parallel to the axis, its part across is round-off and may lean: project again
        part = minus(part, scaled(dot(part, axis), axis))
        length = norm(part)
        if length > 0.5:
            return along, size, divided(part, length)
    return along, size, tangent_of(axis)


_ROUND_OFF = 1e-16
"""Squared sine of the angle to (0, 0, -1) below which a normal differs from (0, 0, -1) by round-off only."""


@compiled
def tangent_of(normal: Vector3) -> Vector3:
    """Return a unit tangent for a unit normal, continuous except at the normal (0, 0, -1).

    No tangent field is continuous everywhere.  This one applies to (1, 0, 0) the shortest rotation from (0, 0, 1) to
    the normal: J. R. Frisvad, "Building an orthonormal basis from a 3D unit vector without normalization", J. Graphics
    Tools 16 (2012) 151-159.
    """
    x, y, z = normal
    if z >= 0.0:
        return 1.0 - x * x / (1.0 + z), -x * y / (1.0 + z), -x
    # 1 + z = (x^2 + y^2) / (1 - z) keeps its digits if the normal points down
    square = x * x + y * y
    if square < _ROUND_OFF:
        # x and y are round-off: project (1, 0, 0) instead, or the tangent of flat faces on each other would jump
        length = math.sqrt(1.0 - x * x)
        return length, -x * y / length, -x * z / length
    grow = (1.0 - z) / square
    return 1.0 - grow * x * x, -grow * x * y, -x


@compiled
def write_tangent(a: Floats, out: Floats) -> None:
    """Write the first tangent for the normal in ``out`` [world axes].

    The tangent depends only on the direction of the normal in the axes of the first body, whose frame block is ``a``.
    """
    write_vector(out, TANGENT, vector_in_world(a, tangent_of(vector_in_body(a, vector_at(out, NORMAL)))))
