"""A frustum in the world or in the axes of another body: distances from points, and separations of two frustums."""

from __future__ import annotations

from typing import NamedTuple

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...shapes.frustum import AXIS, CENTER, COS, HIGH, HIGH_RADIUS, LOW, LOW_RADIUS, SIN
from ...vectors import Vector3, cross, dot, minus, norm, opposite, plus_scaled, scaled, vector_at
from ..features.frames import across, point_in_world, vector_in_world
from .frustum import nearest_part


class Placed(NamedTuple):
    """A frustum in the axes of the world or of a body: its numbers, its centre [m] and its unit axis."""

    numbers: Floats
    center: Vector3
    axis: Vector3


@compiled
def placed(frame: Floats, frustum: Floats) -> Placed:
    """Return a frustum in the world."""
    axis = vector_in_world(frame, (frustum[AXIS], frustum[AXIS + 3], frustum[AXIS + 6]))
    return Placed(frustum, point_in_world(frame, vector_at(frustum, CENTER)), axis)


@compiled
def from_axis(frustum: Placed, point: Vector3) -> tuple[float, float, Vector3]:
    """Return a point's coordinate along the axis from the centre, its distance from the axis [m], and its direction.

    The direction is the unit vector from the axis towards the point, across the axis.
    """
    return across(minus(point, frustum.center), frustum.axis)


@compiled
def from_core(frustum: Placed, point: Vector3) -> float:
    """Return the signed distance of a point from the frustum's core [m]; negative inside."""
    along, away, _ = from_axis(frustum, point)
    return float(nearest_part(frustum.numbers, along, away)[0])


@compiled
def least_height(frustum: Floats, height: float, axis: Vector3, normal: Vector3) -> float:
    """Return the least height of a frustum over a plane [m], that of the lowest point of one of its rims.

    ``height`` is the height of the frustum's centre [m], ``axis`` its unit axis, ``normal`` the unit normal of the
    plane.  Axis and normal are in the same axes, those of the world or of a body.
    """
    # the root of 1 - cosine^2 would be wrong by up to 1e-8 for an axis along the normal
    cosine, sine = dot(axis, normal), norm(cross(axis, normal))
    low, high = cosine * frustum[LOW], cosine * frustum[HIGH]
    return float(height + min(low - sine * frustum[LOW_RADIUS], high - sine * frustum[HIGH_RADIUS]))


@compiled
def separation_along(first: Placed, second: Placed, n: Vector3) -> float:
    """Return the separation of two frustums along the unit vector ``n`` from the first to the second [m].

    It is the width of the gap between two planes with the normal n, each of which touches one frustum.  It is negative
    if the frustums overlap along n.
    """
    height = dot(n, minus(second.center, first.center))
    height = least_height(first.numbers, height, first.axis, opposite(n))
    return float(least_height(second.numbers, height, second.axis, n))


@compiled
def separation_by_second(first: Placed, second: Placed) -> float:
    """Return the largest separation of two frustums along normals of the second one's surface [m].

    It is a lower bound of their separation, which may be larger along another direction.  The normals are those of both
    caps, and that of the side where the side faces the first centre.  All directions lead from the first frustum to the
    second, so they point into the second one.
    """
    axis, numbers = second.axis, second.numbers
    _, _, radial = across(minus(second.center, first.center), axis)
    best = max(separation_along(first, second, axis), separation_along(first, second, opposite(axis)))
    best = max(best, separation_along(first, second, radial))
    # the radial direction is the normal of a cylinder's side, not of a cone's
    if numbers[SIN] != 0.0:
        best = max(
            best, separation_along(first, second, plus_scaled(scaled(numbers[COS], radial), -numbers[SIN], axis))
        )
    return float(best)
