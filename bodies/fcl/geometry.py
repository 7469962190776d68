"""Shapes as geometries of FCL, enlarged."""

from __future__ import annotations

from typing import Any

import numpy as np

from bodies.distances.placing import Made, Makers, along, centre, sharp, triangles, turn
from bodies.shapes.box import Box
from bodies.shapes.capsule import Capsule
from bodies.shapes.cylinder import Cylinder
from bodies.shapes.ellipsoid import Ellipsoid
from bodies.shapes.hull import ConvexHull
from bodies.shapes.sphere import Sphere
from bodies.shapes.triangle_mesh import TriangleMesh

SCALE = 1e6
"""Factor by which everything is enlarged: the tolerance of FCL is 1e-6 whatever the size of the bodies."""


def _sphere(shape: Any) -> Made:
    import fcl

    return fcl.Sphere(SCALE * shape.radius), centre(shape), np.eye(3)


def _box(shape: Any) -> Made:
    sharp("FCL", shape)
    import fcl

    sides = (2.0 * SCALE * half for half in (shape.half_x, shape.half_y, shape.half_z))
    return fcl.Box(*sides), centre(shape), turn(shape)


def _capsule(shape: Any) -> Made:
    import fcl

    return fcl.Capsule(SCALE * shape.radius, 2.0 * SCALE * shape.half_length), centre(shape), along(shape)


def _cylinder(shape: Any) -> Made:
    sharp("FCL", shape)
    import fcl

    return fcl.Cylinder(SCALE * shape.radius, 2.0 * SCALE * shape.half_length), centre(shape), along(shape)


def _ellipsoid(shape: Any) -> Made:
    import fcl

    semi = (SCALE * half for half in (shape.semi_x, shape.semi_y, shape.semi_z))
    return fcl.Ellipsoid(*semi), centre(shape), turn(shape)


def _hull(shape: Any) -> Made:
    sharp("FCL", shape)
    import fcl

    vertices, faces = triangles("FCL", shape)
    flat = np.concatenate([np.full((len(faces), 1), 3), faces], axis=1).ravel().astype(np.int32)
    return fcl.Convex(SCALE * vertices, len(faces), flat), np.zeros(3), np.eye(3)


def _mesh(shape: Any) -> Made:
    import fcl

    vertices, faces = triangles("FCL", shape)
    model = fcl.BVHModel()
    model.beginModel(len(vertices), len(faces))
    model.addSubModel(SCALE * vertices, faces.astype(np.int32))
    model.endModel()
    return model, np.zeros(3), np.eye(3)


MAKERS: Makers = {
    Sphere: _sphere,
    Box: _box,
    Capsule: _capsule,
    Cylinder: _cylinder,
    Ellipsoid: _ellipsoid,
    ConvexHull: _hull,
    TriangleMesh: _mesh,
}
"""What FCL has a kind for."""
