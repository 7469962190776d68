"""Distances of solids: unsigned, and bounded from below where both are convex."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import final

import numpy as np

from bodies.distances.aligned import aligned_boxes
from bodies.distances.pose import Pose
from bodies.distances.solid import Frame, Solid
from bodies.meshes.integrals import winding_number
from bodies.shapes.box import Box
from bodies.shapes.triangle_mesh import TriangleMesh
from nonsmooth.errors import InvalidInput, NonsmoothError
from nonsmooth.interfaces import ConvexShape
from nonsmooth.interfaces.body import Vector

_DOUBT = 1e-3
"""Part of distance and size by which an answer may exceed the lower bound, which is no better than the direction."""
_BELOW = 1e-7
"""The same by which it may be below: points of the bodies are not."""
_LEAST = 1e-12
"""Distance [m] at which a library does not tell any more whether bodies overlap."""


class DoubtfulDistance(NonsmoothError):
    """An answer of a library that contradicts a bound; neither answer nor guess is returned."""


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
        If the library contradicts support functions, as FCL does for some symmetric poses.
    InvalidInput
        If the solids are of two libraries.
    """
    if type(first) is not type(second):
        raise InvalidInput("separation", "needs solids of one library", type(second).__name__, "Make both alike.")
    if type(second.shape) is TriangleMesh and type(first.shape) is not TriangleMesh:
        # the other order gives points in swapped places
        back = separation(second, second_pose, first, first_pose)
        return Separation(back.distance, back.second, back.first, back.lower)
    origin = 0.5 * (first_pose.position + second_pose.position)
    frames = first.frame(first_pose, origin), second.frame(second_pose, origin)
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
    distance, one, two = first.distance(frames[0], second, frames[1])
    return _judged(first, first_pose, second, second_pose, distance, one + origin, two + origin)


def _judged(
    first: Solid, first_pose: Pose, second: Solid, second_pose: Pose, distance: float, one: Vector, two: Vector
) -> Separation:
    if not distance > _LEAST:
        return _overlapping()
    library = type(first).__name__
    names = f"{type(first.shape).__name__}-{type(second.shape).__name__}"
    apart = float(np.linalg.norm(two - one))
    if not abs(apart - distance) <= _DOUBT * distance + _LEAST:
        raise DoubtfulDistance(
            f"{library}: the distance of {names} is {distance:.6g} m, that of its points {apart:.6g} m."
        )
    lower = math.nan
    if isinstance(first.shape, ConvexShape) and isinstance(second.shape, ConvexShape):
        normal = (two - one) / apart
        low = second_pose.position + second_pose.rotation @ second.shape.support(second_pose.rotation.T @ -normal)
        high = first_pose.position + first_pose.rotation @ first.shape.support(first_pose.rotation.T @ normal)
        lower = float(normal @ (low - high))
        if lower <= 0.0:
            raise DoubtfulDistance(
                f"{library}: it says that {names} are {distance:.3g} m apart, but no plane across its line parts them: "
                "whether they overlap remains open."
            )
        size = min(first.shape.extent, second.shape.extent)
        if not -_BELOW * (distance + size) <= distance - lower <= _DOUBT * (distance + size):
            raise DoubtfulDistance(
                f"{library}: it says that {names} are {distance:.6g} m apart, but support functions along its line "
                f"give {lower:.6g} m at least, which is not what nearest points give."
            )
    return Separation(distance, one, two, lower)


def _overlapping() -> Separation:
    nowhere = np.full(3, math.nan)
    return Separation(0.0, nowhere, nowhere, math.nan)


def _inside(solid: Solid, pose: Pose, point: Vector) -> bool:
    """Return whether a point is inside of a mesh: for a library a mesh is a hollow surface."""
    if type(solid.shape) is not TriangleMesh:
        return False
    vertices, faces = solid.shape.drawing()
    return winding_number(vertices, faces, pose.rotation.T @ (point - pose.position)) > 0.5


def _some(solid: Solid, frame: Frame, origin: Vector) -> Vector:
    """Return a point of a solid in the world."""
    if type(solid.shape) is TriangleMesh:
        place, axes = frame
        return np.asarray(origin + place + axes @ solid.shape.drawing()[0][0])
    return np.asarray(origin + frame[0])
