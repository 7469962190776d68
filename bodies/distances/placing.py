"""Where shapes stand in their bodies, and triangles that a library may see."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, TypeAlias

import numpy as np

from bodies.meshes.checks import flat_triangles
from bodies.meshes.topology import Integers
from bodies.shapes.placement import with_axes
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Shape
from nonsmooth.interfaces.body import Vector
from nonsmooth.vectors import perpendiculars

Made: TypeAlias = tuple[Any, Vector, Vector]
"""A geometry, its place [m] and its axes as columns in the body."""
Makers: TypeAlias = Mapping[type[Shape], Callable[[Any], Made]]
"""What a library has a kind for.  A new kind needs the tests of every pair with the others."""


def made(library: str, makers: Makers, shape: Shape) -> Made:
    """Return the geometry of a shape.

    Raises
    ------
    InvalidInput
        If the library has none of this kind that it handles: half-spaces and planes end the process in most functions
        of FCL, and smooth shapes without a kind of their own would be replaced by polyhedra.
    """
    make = makers.get(type(shape))
    if make is None:
        known = ", ".join(sorted(kind.__name__ for kind in makers))
        raise InvalidInput(
            library,
            "must be given a bounded solid that it has a kind for",
            type(shape).__name__,
            f"Known: {known}. Distances to planes are closed forms: use the contact kinematics.",
        )
    return make(shape)


def sharp(library: str, shape: Any) -> None:
    """Raise InvalidInput if a shape is rounded: the library would be given another body."""
    if shape.rounding > 0.0:
        raise InvalidInput(
            library,
            "must be given polyhedra and cylinders without a rounding",
            shape.rounding,
            "Ask for the distance of the core, and take the rounding off.",
        )


def triangles(library: str, shape: Any) -> tuple[Vector, Integers]:
    """Return vertices and triangles of a shape.

    Raises
    ------
    InvalidInput
        If the library would read out of bounds, or build a tree of nothing.
    """
    vertices, faces = shape.drawing()
    if len(faces) == 0 or not np.all(np.isfinite(vertices)) or np.any((faces < 0) | (faces >= len(vertices))):
        raise InvalidInput(
            library,
            "must be given triangles of finite vertices that exist",
            f"{len(faces)} triangles, {len(vertices)} vertices",
            "Check the mesh.",
        )
    flat = int(np.sum(flat_triangles(vertices, faces)))
    if flat:
        raise InvalidInput(library, "must be given no triangle of zero area", flat, "Repair the mesh with 'zero_area'.")
    return vertices, faces


def centre(shape: Any) -> Vector:
    """Return the place of a shape with a centre [m], shape [3]."""
    return np.array([shape.x, shape.y, shape.z])


def turn(shape: Any) -> Vector:
    """Return the axes of a shape with a quaternion as columns, shape [3, 3]."""
    return with_axes(shape.orientation_w, shape.orientation_x, shape.orientation_y, shape.orientation_z)


def along(shape: Any) -> Vector:
    """Return axes as columns of which the third is that of the shape, shape [3, 3]."""
    axis = shape.axis_x, shape.axis_y, shape.axis_z
    return np.array([*perpendiculars(axis), axis]).T
