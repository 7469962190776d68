"""Shapes as geometries of FCL, enlarged, each with its place in its body."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np

from bodies.meshes.checks import flat_triangles
from bodies.meshes.topology import Integers
from bodies.shapes.box import Box
from bodies.shapes.capsule import Capsule
from bodies.shapes.cylinder import Cylinder
from bodies.shapes.ellipsoid import Ellipsoid
from bodies.shapes.hull import ConvexHull
from bodies.shapes.placement import with_axes
from bodies.shapes.sphere import Sphere
from bodies.shapes.triangle_mesh import TriangleMesh
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Shape
from nonsmooth.interfaces.body import Vector
from nonsmooth.vectors import perpendiculars

SCALE = 1e6
"""Factor by which everything is enlarged: the tolerance of FCL is 1e-6 whatever the size of the bodies."""

Made: TypeAlias = tuple[Any, Vector, Vector]
"""The geometry, its place [m] and its axes as columns in the body."""


def geometry_of(shape: Shape) -> Made:
    """Return the geometry of a shape.

    Raises
    ------
    InvalidInput
        If FCL has none of this kind that it handles: half-spaces and planes end the process in most of its functions,
        and smooth shapes without a kind of their own would be replaced by polyhedra.
    """
    make = _MAKERS.get(type(shape))
    if make is None:
        known = ", ".join(sorted(kind.__name__ for kind in _MAKERS))
        raise InvalidInput(
            "FCL",
            "must be given a bounded solid that it has a kind for",
            type(shape).__name__,
            f"Known: {known}. Distances to planes are closed forms: use the contact kinematics.",
        )
    return make(shape)


def _sphere(shape: Any) -> Made:
    import fcl

    return fcl.Sphere(SCALE * shape.radius), _centre(shape), np.eye(3)


def _box(shape: Any) -> Made:
    import fcl

    sides = (2.0 * SCALE * half for half in (shape.half_x, shape.half_y, shape.half_z))
    return fcl.Box(*sides), _centre(shape), _turn(shape)


def _capsule(shape: Any) -> Made:
    import fcl

    return fcl.Capsule(SCALE * shape.radius, 2.0 * SCALE * shape.half_length), _centre(shape), _along(shape)


def _cylinder(shape: Any) -> Made:
    import fcl

    return fcl.Cylinder(SCALE * shape.radius, 2.0 * SCALE * shape.half_length), _centre(shape), _along(shape)


def _ellipsoid(shape: Any) -> Made:
    import fcl

    semi = (SCALE * half for half in (shape.semi_x, shape.semi_y, shape.semi_z))
    return fcl.Ellipsoid(*semi), _centre(shape), _turn(shape)


def _hull(shape: Any) -> Made:
    import fcl

    vertices, faces = _checked(*shape.drawing())
    flat = np.concatenate([np.full((len(faces), 1), 3), faces], axis=1).ravel().astype(np.int32)
    return fcl.Convex(SCALE * vertices, len(faces), flat), np.zeros(3), np.eye(3)


def _mesh(shape: Any) -> Made:
    import fcl

    vertices, faces = _checked(*shape.drawing())
    model = fcl.BVHModel()
    model.beginModel(len(vertices), len(faces))
    model.addSubModel(SCALE * vertices, faces.astype(np.int32))
    model.endModel()
    return model, np.zeros(3), np.eye(3)


def _checked(vertices: Vector, faces: Integers) -> tuple[Vector, Integers]:
    """Return them; raise InvalidInput if FCL would read out of bounds, or build a tree of nothing."""
    if len(faces) == 0 or not np.all(np.isfinite(vertices)) or np.any((faces < 0) | (faces >= len(vertices))):
        raise InvalidInput(
            "FCL",
            "must be given triangles of finite vertices that exist",
            f"{len(faces)} triangles, {len(vertices)} vertices",
            "Check the mesh.",
        )
    flat = int(np.sum(flat_triangles(vertices, faces)))
    if flat:
        raise InvalidInput("FCL", "must be given no triangle of zero area", flat, "Repair the mesh with 'zero_area'.")
    return vertices, faces


def _centre(shape: Any) -> Vector:
    return np.array([shape.x, shape.y, shape.z])


def _turn(shape: Any) -> Vector:
    return with_axes(shape.orientation_w, shape.orientation_x, shape.orientation_y, shape.orientation_z)


def _along(shape: Any) -> Vector:
    axis = shape.axis_x, shape.axis_y, shape.axis_z
    return np.array([*perpendiculars(axis), axis]).T


_MAKERS: dict[type[Shape], Callable[[Any], Made]] = {
    Sphere: _sphere,
    Box: _box,
    Capsule: _capsule,
    Cylinder: _cylinder,
    Ellipsoid: _ellipsoid,
    ConvexHull: _hull,
    TriangleMesh: _mesh,
}
"""What FCL has a kind for.  A new kind needs the tests of every pair with the others."""
