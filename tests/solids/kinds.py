"""Bodies of a centimetre of all kinds, drawn at random, and a mesh that is not convex."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.spatial.transform import Rotation

from bodies import (
    Ball,
    BoxBody,
    CapsuleBody,
    CylinderBody,
    EllipsoidBody,
    HullBody,
    MeshBody,
    Triangles,
)
from nonsmooth.interfaces import Body
from nonsmooth.interfaces.body import Vector

_OUTLINE = ((0, 0), (3, 0), (3, 1), (1, 1), (1, 3), (0, 3))
_TOP = ((0, 1, 3), (0, 3, 5), (1, 2, 3), (3, 4, 5))


def angle(size: float) -> MeshBody:
    """Return an L of a square's width ``size`` [m], thrice as long along either side."""
    n = len(_OUTLINE)
    corners = tuple((size * (x - 1.25), size * (y - 1.25), z * size) for z in (-0.5, 0.5) for x, y in _OUTLINE)
    faces = [(n + a, n + b, n + c) for a, b, c in _TOP] + [(c, b, a) for a, b, c in _TOP]
    for i in range(n):
        j = (i + 1) % n
        faces += [(i, j, n + j), (i, n + j, n + i)]
    return MeshBody(Triangles(corners, tuple(faces)), density=2700.0)


def _length(rng: np.random.Generator) -> float:
    return float(rng.uniform(4e-3, 1.2e-2))


def _box(rng: np.random.Generator, rounding: float) -> BoxBody:
    return BoxBody(_length(rng), _length(rng), _length(rng), rounding=rounding)


KINDS: dict[str, Callable[[np.random.Generator], Body]] = {
    "box": lambda rng: _box(rng, 0.0),
    "rounded box": lambda rng: _box(rng, 2e-3),
    "angle": lambda rng: angle(8e-3),
    "hull": lambda rng: HullBody(tuple(map(tuple, rng.normal(0.0, 8e-3, (8, 3)).tolist()))),
    "cylinder": lambda rng: CylinderBody(_length(rng), _length(rng), foot_height=0.0),
    "ball": lambda rng: Ball(_length(rng)),
    "ellipsoid": lambda rng: EllipsoidBody(*rng.uniform(5e-3, 1.2e-2, 3).tolist()),
    "capsule": lambda rng: CapsuleBody(*rng.uniform(4e-3, 1e-2, 2).tolist()),
}


def random_turn(rng: np.random.Generator) -> Vector:
    """Return a unit quaternion, scalar first."""
    return np.roll(Rotation.random(random_state=rng).as_quat(), 1)
