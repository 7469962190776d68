"""Distances of solids by FCL: unsigned, of enlarged bodies, and bounded from below where both are convex."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import final

import numpy as np

from bodies.fcl.aligned import aligned_boxes
from bodies.fcl.geometry import SCALE
from bodies.fcl.solid import Pose, Solid
from bodies.meshes.integrals import winding_number
from bodies.shapes.box import Box
from bodies.shapes.sphere import Sphere
from bodies.shapes.triangle_mesh import TriangleMesh
from nonsmooth.errors import NonsmoothError
from nonsmooth.interfaces import ConvexShape
from nonsmooth.interfaces.body import Vector

_DOUBT = 1e-3
"""Part of distance and size by which an answer may exceed the lower bound, which is no better than the direction."""
_BELOW = 1e-7
"""The same by which it may be below: points of the bodies are not."""
_LEAST = 1e-12
"""Distance [m] at which FCL does not tell any more whether bodies overlap, after enlargement."""


class DoubtfulDistance(NonsmoothError):
    """An answer of FCL that contradicts a bound of its own; neither answer nor guess is returned."""


@final
@dataclass(frozen=True)
class Separation:
    """How far two solids are from each other.

    Attributes
    ----------
    distance : float
        The distance [m]; 0 where they overlap or nearly touch (below 1e-12 m), how deep is not told.
    first, second : Vector
        A nearest point on either, in the world [m], shape [3]; not numbers where they overlap.
    lower : float
        What the distance is at least, by support functions along the line of the two points [m]; not a number where
        one is not convex.
    """

    distance: float
    first: Vector
    second: Vector
    lower: float

    @property
    def overlap(self) -> bool:
        """Whether they overlap or nearly touch."""
        return self.distance == 0.0


def separation(first: Solid, first_pose: Pose, second: Solid, second_pose: Pose) -> Separation:
    """Return the distance of two solids and where they are nearest.

    Errors of the distance are below about 1e-9 m for bodies of centimetres, those of the points the square root of
    that relative to the size: a seed, and a check, no gap.

    Raises
    ------
    DoubtfulDistance
        If FCL says more than support functions allow, as it does for some symmetric poses.
    """
    if type(second.shape) is TriangleMesh and type(first.shape) is not TriangleMesh:
        # the other order gives points in swapped places
        back = separation(second, second_pose, first, first_pose)
        return Separation(back.distance, back.second, back.first, back.lower)
    origin = 0.5 * (first_pose.position + second_pose.position)
    frames = first.own_frame(first_pose, origin), second.own_frame(second_pose, origin)
    if type(first.shape) is Box and type(second.shape) is Box:
        halves = [np.array([b.half_x, b.half_y, b.half_z]) for b in (first.shape, second.shape)]
        found = aligned_boxes(frames[0], halves[0], frames[1], halves[1])
        if found is not None:
            distance, one, two = found
            return _judged(first, first_pose, second, second_pose, distance, one + origin, two + origin)
    if _inside(first, first_pose, frames[1][0] + origin) or _inside(
        second, second_pose, _some(first, frames[0], origin)
    ):
        return _overlapping()
    other = second if second is not first else Solid(second.shape)
    distance, one, two = _asked(first, frames[0], other, frames[1])
    return _judged(first, first_pose, second, second_pose, distance, one + origin, two + origin)


def _asked(
    first: Solid, one: tuple[Vector, Vector], second: Solid, two: tuple[Vector, Vector]
) -> tuple[float, Vector, Vector]:
    """Return distance [m] and nearest points from the origin of the frames."""
    import fcl

    # a result keeps the least distance it ever held
    request, result = fcl.DistanceRequest(enable_nearest_points=True), fcl.DistanceResult()
    distance = fcl.distance(first.at(*one), second.at(*two), request, result) / SCALE
    points = [np.array(point, dtype=float) / SCALE for point in result.nearest_points]
    if type(first.shape) is TriangleMesh and type(second.shape) is Sphere:
        # these come in the frames of the bodies
        points = [place + axes @ point for point, (place, axes) in zip(points, (one, two), strict=True)]
    return distance, points[0], points[1]


def _judged(
    first: Solid, first_pose: Pose, second: Solid, second_pose: Pose, distance: float, one: Vector, two: Vector
) -> Separation:
    if not distance > _LEAST:
        return _overlapping()
    names = f"{type(first.shape).__name__}-{type(second.shape).__name__}"
    apart = float(np.linalg.norm(two - one))
    if not abs(apart - distance) <= _DOUBT * distance + _LEAST:
        raise DoubtfulDistance(f"FCL: the distance of {names} is {distance:.6g} m, that of its points {apart:.6g} m.")
    lower = math.nan
    if isinstance(first.shape, ConvexShape) and isinstance(second.shape, ConvexShape):
        normal = (two - one) / apart
        low = second_pose.position + second_pose.rotation @ second.shape.support(second_pose.rotation.T @ -normal)
        high = first_pose.position + first_pose.rotation @ first.shape.support(first_pose.rotation.T @ normal)
        lower = float(normal @ (low - high))
        size = min(first.shape.extent, second.shape.extent)
        if not -_BELOW * (distance + size) <= distance - lower <= _DOUBT * (distance + size):
            raise DoubtfulDistance(
                f"FCL: it says that {names} are {distance:.6g} m apart, but support functions along its line give "
                f"{lower:.6g} m at least, which is not what nearest points give."
            )
    return Separation(distance, one, two, lower)


def _overlapping() -> Separation:
    nowhere = np.full(3, math.nan)
    return Separation(0.0, nowhere, nowhere, math.nan)


def _inside(solid: Solid, pose: Pose, point: Vector) -> bool:
    """Return whether a point is inside of a mesh: for FCL a mesh is a hollow surface."""
    if type(solid.shape) is not TriangleMesh:
        return False
    vertices, faces = solid.shape.drawing()
    return winding_number(vertices, faces, pose.rotation.T @ (point - pose.position)) > 0.5


def _some(solid: Solid, frame: tuple[Vector, Vector], origin: Vector) -> Vector:
    """Return a point of a solid in the world."""
    if type(solid.shape) is TriangleMesh:
        place, axes = frame
        return np.asarray(origin + place + axes @ solid.shape.drawing()[0][0])
    return np.asarray(origin + frame[0])
