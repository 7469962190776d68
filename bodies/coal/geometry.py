"""Shapes as geometries of coal."""

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


def _sphere(shape: Any) -> Made:
    import coal

    return coal.Sphere(shape.radius), centre(shape), np.eye(3)


def _box(shape: Any) -> Made:
    sharp("coal", shape)
    import coal

    return coal.Box(2.0 * np.array([shape.half_x, shape.half_y, shape.half_z])), centre(shape), turn(shape)


def _capsule(shape: Any) -> Made:
    import coal

    return coal.Capsule(shape.radius, 2.0 * shape.half_length), centre(shape), along(shape)


def _cylinder(shape: Any) -> Made:
    sharp("coal", shape)
    import coal

    return coal.Cylinder(shape.radius, 2.0 * shape.half_length), centre(shape), along(shape)


def _ellipsoid(shape: Any) -> Made:
    import coal

    return coal.Ellipsoid(shape.semi_x, shape.semi_y, shape.semi_z), centre(shape), turn(shape)


def _hull(shape: Any) -> Made:
    sharp("coal", shape)
    import coal

    return coal.Convex(*_lists(shape)), np.zeros(3), np.eye(3)


def _mesh(shape: Any) -> Made:
    import coal

    points, faces = _lists(shape)
    model = coal.BVHModelOBBRSS()
    model.beginModel(len(faces), len(points))
    model.addSubModel(points, faces)
    model.endModel()
    return model, np.zeros(3), np.eye(3)


def _lists(shape: Any) -> tuple[Any, Any]:
    """Return vertices and triangles as lists of the library."""
    import coal

    vertices, faces = triangles("coal", shape)
    points, numbers = coal.StdVec_Vec3s(), coal.StdVec_Triangle()
    for vertex in vertices:
        points.append(vertex)
    for face in faces.tolist():
        numbers.append(coal.Triangle(*face))
    return points, numbers


MAKERS: Makers = {
    Sphere: _sphere,
    Box: _box,
    Capsule: _capsule,
    Cylinder: _cylinder,
    Ellipsoid: _ellipsoid,
    ConvexHull: _hull,
    TriangleMesh: _mesh,
}
"""What coal has a kind for."""
