"""Base class for distance libraries: how the libraries are called, and how their results are checked."""

from __future__ import annotations

import math
from abc import abstractmethod
from typing import final

import numpy as np

from nonsmooth.errors import DoubtfulDistance
from nonsmooth.interfaces import ConvexShape, Shape
from nonsmooth.interfaces.body import Vector
from nonsmooth.interfaces.distance_backend import Place, Separation

from ..meshes.integrals import winding_number
from ..shapes.box import Box
from ..shapes.hull import ConvexHull
from ..shapes.sphere import Sphere
from ..shapes.triangle_mesh import TriangleMesh
from .geometries import MAKERS, GeometryMaker, Made

_DOUBT = 1e-3
"""Largest excess of a library's distance over its lower bound, relative to the sum of distance and size.

The lower bound is the width of the gap between two planes across the line of the library's nearest points.  It equals
the distance for exact points; a larger excess means wrong points, and raises `DoubtfulDistance`.
"""
_BELOW = 1e-7
"""Largest amount by which a library's distance may be below that lower bound, relative to distance plus size."""
_FLAT = TriangleMesh, ConvexHull, Box, Sphere
"""Classes of shapes for which libraries give distances to round-off, if both shapes are among them."""
_LEAST = 1e-12
"""Distance [m] up to which bodies are reported as overlapping.

A library returns a distance of 0, within round-off, for touching and for overlapping bodies alike.
"""


class Library(GeometryMaker):
    """A library that computes unsigned distances; each library has its final subclass.

    Errors of distances of centimetres are mostly below 1e-11 m.  The ``error`` of a result is an upper bound.  For
    convex solids it is the distance minus a lower bound from support functions.  For meshes it is ``part``, which is
    larger than the worst error found in many poses.  The relative error of nearest points may be the square root of the
    relative error of the distance.
    """

    @property
    @abstractmethod
    def part(self) -> float:
        """Largest error of a distance from a mesh or a round solid, divided by the sum of distance and size.

        The size is the extent of the smaller solid.
        """

    @abstractmethod
    def unsigned(self, first: Made, one: Place, second: Made, two: Place) -> tuple[float, Vector, Vector]:
        """Return the distance of two geometries at two places [m], and nearest points in the same axes.

        A distance that is not positive means an overlap.  If one of the two is a mesh, it is the first.
        """

    @final
    def solid(self, shape: Shape) -> Made | None:
        """Return the shape as an object of the library; None if the library has no such shape."""
        make = MAKERS.get(type(shape))
        return None if make is None else make(self, shape)

    @final
    def separation(self, first: Made, one: Place, second: Made, two: Place) -> Separation:
        """Return distance, error, nearest points and normal of two solids, or that they overlap."""
        if _is_mesh(second) and not _is_mesh(first):
            # a mesh must be the first argument: swap the solids, and swap the result back
            back = self.separation(second, two, first, one)
            return Separation(back.overlap, back.distance, back.error, back.second, back.first, -back.normal)
        origin = 0.5 * (one[0] + two[0])
        places = _stands(first, one, origin), _stands(second, two, origin)
        if _inside(first, one, _some(second, two)) or _inside(second, two, _some(first, one)):
            return _OVERLAP
        distance, p, q = self._found(first, places[0], second, places[1])
        if not distance > _LEAST:
            return _OVERLAP
        normal, above = self._judged(first, one, second, two, distance, q - p)
        whole = distance - first.sweep - second.sweep
        flat = isinstance(first.shape, _FLAT) and isinstance(second.shape, _FLAT)
        part = max(self.part, _BELOW) if above is None and not flat else _BELOW
        error = max(above or 0.0, part * (distance + _size(first, second)))
        p, q = p + origin + first.sweep * normal, q + origin - second.sweep * normal
        return Separation(False, whole, error, p, q, normal)

    def _found(self, first: Made, one: Place, second: Made, two: Place) -> tuple[float, Vector, Vector]:
        if isinstance(first.shape, Box) and isinstance(second.shape, Box):
            found = aligned_boxes(one, np.array(first.shape.core_sizes), two, np.array(second.shape.core_sizes))
            if found is not None:
                return found
        return self.unsigned(first, one, second, two)

    def _judged(
        self, first: Made, one: Place, second: Made, two: Place, distance: float, way: Vector
    ) -> tuple[Vector, float | None]:
        """Check a library's distance of two solids; return the unit normal and a bound of the distance's error [m].

        The bound is the distance minus its lower bound from support functions.  It is None unless both solids are
        convex.  ``way`` leads from the first nearest point to the second [m].

        Raises
        ------
        DoubtfulDistance
            The distance contradicts the distance of the nearest points, or the lower bound by support functions.
        """
        library = type(self).__name__
        names = f"{type(first.shape).__name__}-{type(second.shape).__name__}"
        apart = float(np.linalg.norm(way))
        if not abs(apart - distance) <= _DOUBT * distance + _LEAST:
            raise DoubtfulDistance(
                f"{library}: the distance of {names} is {distance:.6g} m, that of its points {apart:.6g} m."
            )
        normal = way / apart
        if not (isinstance(first.shape, ConvexShape) and isinstance(second.shape, ConvexShape)):
            return normal, None
        lower = _between(first, one, second, two, normal)
        if lower <= 0.0:
            raise DoubtfulDistance(
                f"{library}: it says that {names} are {distance:.3g} m apart, but no plane across its line parts them: "
                "whether they overlap remains open."
            )
        scale = distance + _size(first, second)
        if not -_BELOW * scale <= distance - lower <= _DOUBT * scale:
            raise DoubtfulDistance(
                f"{library}: it says that {names} are {distance:.6g} m apart, but support functions along its line "
                f"give {lower:.6g} m at least, which is not what nearest points give."
            )
        return normal, max(distance - lower, 0.0)


_NOWHERE = np.full(3, math.nan)
_OVERLAP = Separation(True, math.nan, math.nan, _NOWHERE, _NOWHERE, _NOWHERE)


def _is_mesh(solid: Made) -> bool:
    return isinstance(solid.shape, TriangleMesh)


def _size(first: Made, second: Made) -> float:
    return min(first.extent, second.extent)


def _between(first: Made, one: Place, second: Made, two: Place, normal: Vector) -> float:
    """Return the width along ``normal`` of the gap between the cores of two convex solids [m].

    It is the distance of the cores' supporting planes across the normal, and negative if the cores overlap along it.
    """
    assert isinstance(first.shape, ConvexShape)
    assert isinstance(second.shape, ConvexShape)
    low = two[0] + two[1] @ second.shape.support(two[1].T @ -normal)
    high = one[0] + one[1] @ first.shape.support(one[1].T @ normal)
    return float(normal @ (low - high)) + first.sweep + second.sweep


def _stands(solid: Made, place: Place, origin: Vector) -> Place:
    """Return the pose of a solid's geometry: its position in the world relative to ``origin`` [m], and its axes."""
    return place[0] - origin + place[1] @ solid.place, place[1] @ solid.axes


def _inside(solid: Made, place: Place, point: Vector) -> bool:
    """Return True if the solid is a mesh with the point inside of it, because libraries treat meshes as hollow."""
    if not isinstance(solid.shape, TriangleMesh):
        return False
    own, (low, high) = place[1].T @ (point - place[0]), solid.box
    if np.any(own < low) or np.any(own > high):
        return False
    return winding_number(*solid.shape.drawing(), own) > 0.5


def _some(solid: Made, place: Place) -> Vector:
    """Return a point of a solid in the world."""
    return np.asarray(place[0] + place[1] @ solid.point)


_ALIGNED = 1e-9


def aligned_boxes(one: Place, half: Vector, two: Place, other: Vector) -> tuple[float, Vector, Vector] | None:
    """Return distance [m] and nearest points of two boxes whose edges are parallel to 1e-9 rad; else None.

    Parameters
    ----------
    one, two : tuple
        Centre [m], shape [3], and axes as columns, shape [3, 3].
    half, other : Vector
        Half-lengths of the boxes along their axes [m], shape [3].
    """
    (place, axes), (second_place, second_axes) = one, two
    relative = axes.T @ second_axes
    signs = np.round(relative)
    if np.max(np.abs(relative - signs)) > _ALIGNED:
        return None
    reach = np.abs(signs) @ other
    way = axes.T @ (second_place - place)
    # along every axis of the first box, the interval that both boxes share
    low, high = np.maximum(-half, way - reach), np.minimum(half, way + reach)
    middle = 0.5 * (low + high)
    # if the boxes share no interval along an axis, their nearest points lie at the ends that face each other
    apart = low > high
    first = np.where(apart, np.where(way > 0.0, half, -half), middle)
    second = np.where(apart, np.where(way > 0.0, way - reach, way + reach), middle)
    distance = float(np.linalg.norm(second - first))
    return distance, place + axes @ first, place + axes @ second
