"""Solids of about a centimetre and random poses, for the tests of the adapter."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from bodies import Box, Capsule, ConvexHull, Cylinder, Ellipsoid, Sphere, TriangleMesh, Triangles
from bodies.distances.pose import Pose
from nonsmooth.interfaces import Shape
from tests.bodies.meshes import parts

AXIS = {"axis_x": 0.6, "axis_z": 0.8}
SHAPES: dict[str, Shape] = {
    "sphere": Sphere(0.006, x=0.002),
    "box": Box(0.004, 0.006, 0.009, x=0.001),
    "capsule": Capsule(0.004, 0.006, **AXIS),
    "cylinder": Cylinder(0.005, 0.007, y=0.002, **AXIS),
    "ellipsoid": Ellipsoid(0.004, 0.006, 0.01),
    "hull": ConvexHull((0.01 * np.random.default_rng(1).uniform(-1.0, 1.0, (12, 3))).tolist()),
    "mesh": TriangleMesh(Triangles(*parts.bracket(), "bracket"), x=-0.01),
}


def poses(rng: Any, reach: float = 0.02) -> tuple[Pose, Pose]:
    """Return two random poses, origins within a box of twice ``reach`` [m]."""
    turns = Rotation.random(2, rng).as_matrix()
    return Pose(rng.uniform(-reach, reach, 3), turns[0]), Pose(rng.uniform(-reach, reach, 3), turns[1])
