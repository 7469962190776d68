"""One shape of every kind that is installed, sharp and rounded, of about a centimetre, for questions about pairs."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from bodies import (
    Box,
    Capsule,
    Cone,
    ConvexHull,
    Cylinder,
    Disc,
    Ellipsoid,
    HalfSpace,
    Plane,
    Point,
    Sphere,
    Superellipsoid,
    TriangleMesh,
    Triangles,
)
from nonsmooth.interfaces import Shape
from tests.bodies.meshes.parts import bracket

Array = np.ndarray
Pose = tuple[Array, Array]
"""Position [m] and unit quaternion, scalar first."""
_POINTS = (0.01 * np.random.default_rng(1).uniform(-1.0, 1.0, (12, 3))).tolist()
_TURNED = {"axis_x": 0.6, "axis_z": 0.8}
SHAPES: dict[str, Shape] = {
    "plane": Plane(0.001),
    "half-space": HalfSpace(-0.002),
    "point": Point(0.001, 0.002, -0.001),
    "sphere": Sphere(0.006, x=0.002),
    "box": Box(0.004, 0.006, 0.009, x=0.001),
    "rounded box": Box(0.004, 0.006, 0.009, y=0.001, rounding=0.001),
    "hull": ConvexHull(_POINTS),
    "rounded hull": ConvexHull(_POINTS, rounding=0.001),
    "capsule": Capsule(0.004, 0.006, **_TURNED),
    "cylinder": Cylinder(0.005, 0.007, y=0.002, **_TURNED),
    "rounded cylinder": Cylinder(0.005, 0.007, rounding=0.002, **_TURNED),
    "cylinder on feet": Cylinder(0.005, 0.007, foot_height=1e-6),
    "cone": Cone(0.006, 0.012, z=-0.004, **_TURNED),
    "rounded cone": Cone(0.006, 0.012, rounding=0.001),
    "disc": Disc(0.008, **_TURNED),
    "rounded disc": Disc(0.008, rounding=0.001),
    "ellipsoid": Ellipsoid(0.004, 0.006, 0.01),
    "superellipsoid": Superellipsoid(0.006, 0.005, 0.008, 1.3, 1.2),
    "boxy": Superellipsoid(0.006, 0.005, 0.008, 0.5, 0.6),
    "rounded boxy": Superellipsoid(0.006, 0.005, 0.008, 0.5, 0.6, 0.001),
    "mesh": TriangleMesh(Triangles(*bracket(), "bracket"), x=-0.01),
}
UNBOUNDED = "plane", "half-space"


def pose(rng: np.random.Generator, reach: float) -> Pose:
    """Return a pose in a box of twice ``reach`` [m]."""
    return rng.uniform(-reach, reach, 3), np.roll(Rotation.random(random_state=rng).as_quat(), 1)
