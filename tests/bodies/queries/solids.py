"""Solids of about a centimetre and random places, for the tests of libraries."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from bodies import Box, Capsule, Cone, ConvexHull, Cylinder, Ellipsoid, Sphere, TriangleMesh, Triangles
from nonsmooth.interfaces import Shape
from nonsmooth.interfaces.distance_backend import Place
from tests.bodies.meshes import parts

AXIS = {"axis_x": 0.6, "axis_z": 0.8}
_POINTS = (0.01 * np.random.default_rng(1).uniform(-1.0, 1.0, (12, 3))).tolist()
SHAPES: dict[str, Shape] = {
    "sphere": Sphere(0.006, x=0.002),
    "box": Box(0.004, 0.006, 0.009, x=0.001),
    "capsule": Capsule(0.004, 0.006, **AXIS),
    "cylinder": Cylinder(0.005, 0.007, y=0.002, **AXIS),
    "cone": Cone(0.006, 0.012, z=-0.004, **AXIS),
    "ellipsoid": Ellipsoid(0.004, 0.006, 0.01),
    "hull": ConvexHull(_POINTS),
    "mesh": TriangleMesh(Triangles(*parts.bracket(), "bracket"), x=-0.01),
}
ROUNDED: dict[str, Shape] = {
    "rounded box": Box(0.004, 0.006, 0.009, x=0.001, rounding=0.001),
    "rounded cylinder": Cylinder(0.005, 0.007, y=0.002, rounding=0.002, **AXIS),
    "rounded cone": Cone(0.006, 0.012, z=-0.004, rounding=0.001, **AXIS),
    "rounded hull": ConvexHull(_POINTS, rounding=0.001),
}
HERE: Place = (np.zeros(3), np.eye(3))


def at(*position: float) -> Place:
    """Return a place that is not turned."""
    return np.array(position), np.eye(3)


def places(rng: Any, reach: float = 0.02) -> tuple[Place, Place]:
    """Return two random places, origins within a box of twice ``reach`` [m]."""
    turns = Rotation.random(2, rng).as_matrix()
    return (rng.uniform(-reach, reach, 3), turns[0]), (rng.uniform(-reach, reach, 3), turns[1])
