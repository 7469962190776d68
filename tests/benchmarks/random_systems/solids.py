"""Random bodies of all kinds, free or held."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np

from bodies import (
    Ball,
    Box,
    BoxBody,
    Capsule,
    CapsuleBody,
    Cone,
    ConeBody,
    ConvexHull,
    Cylinder,
    CylinderBody,
    Disc,
    DiscBody,
    Dumbbell,
    Ellipsoid,
    EllipsoidBody,
    HullBody,
    MeshBody,
    Rod,
    Sphere,
    Superellipsoid,
    SuperellipsoidBody,
    TriangleMesh,
    Triangles,
)
from nonsmooth.interfaces import Body, Shape
from nonsmooth.interfaces.body import Vector

Random: TypeAlias = np.random.Generator
PRISMS = {
    "L": ((0.0, 0.0), (1.0, 0.0), (1.0, 0.3), (0.3, 0.3), (0.3, 1.0), (0.0, 1.0)),
    "dart": ((0.0, 0.0), (1.0, -0.3), (0.35, 0.35), (-0.3, 1.0)),
    "U": ((0.0, 0.0), (1.2, 0.0), (1.2, 0.8), (1.0, 0.8), (1.0, 0.2), (0.2, 0.2), (0.2, 0.8), (0.0, 0.8)),
}
"""Outlines of the meshes that are not convex."""
_CUTS = {
    "L": ((0, 1, 3), (1, 2, 3), (0, 3, 5), (3, 4, 5)),
    "dart": ((0, 1, 2), (0, 2, 3)),
    "U": ((0, 1, 4), (0, 4, 5), (1, 2, 3), (1, 3, 4), (0, 5, 7), (5, 6, 7)),
}
PIECES = {
    "L": ((0, 1, 2, 3), (0, 3, 4, 5)),
    "dart": ((0, 1, 2), (0, 2, 3)),
    "U": ((0, 1, 4, 5), (1, 2, 3, 4), (0, 5, 6, 7)),
}
"""Corners of the outline of each convex piece of the meshes that are not convex, by their names."""
KINDS = (
    *("ball", "dumbbell", "rod", "capsule", "cylinder", "cone", "disc"),
    *("box", "hull", "ellipsoid", "superellipsoid", "mesh"),
)


def number(random: Random, low: float, high: float) -> float:
    """Return a number between bounds, with four digits, so that scripts stay short."""
    return float(f"{random.uniform(low, high):.4g}")


def prism(name: str, corners: Vector) -> Triangles:
    """Return the surface of a prism over a named outline by its corners [m]: those of the base, then of the top."""
    n = len(PRISMS[name])
    faces = [(a, c, b) for a, b, c in _CUTS[name]] + [(a + n, b + n, c + n) for a, b, c in _CUTS[name]]
    faces += [face for i in range(n) for j in ((i + 1) % n,) for face in ((i, j, j + n), (i, j + n, i + n))]
    return Triangles(corners.tolist(), faces, name)


def upright(name: str, height: float) -> Vector:
    """Return the corners of the prism of a height over a named outline, shape [2 n, 3]."""
    outline = np.array(PRISMS[name])
    flat = np.column_stack([outline, np.zeros(len(outline))])
    return np.vstack([flat, flat + np.array([0.0, 0.0, height])])


def triangles(random: Random, size: float) -> Triangles:
    """Return the surface of a prism over an outline that is not convex, stretched and sheared."""
    name = ("L", "dart")[int(random.integers(2))]
    solid = upright(name, number(random, 0.3, 1.0))
    shear = np.diag(random.uniform(0.7, 1.3, 3)) + (random.random() < 0.5) * random.uniform(-0.2, 0.2, (3, 3))
    # not rounded: the faces stay flat, so that the convex pieces are the body
    return prism(name, 1.5 * size * solid @ np.round(shear, 2).T)


def _points(random: Random, size: float) -> list[list[float]]:
    n = int(random.integers(4, 10))
    while True:
        points = np.round(random.uniform(-size, size, (n, 3)), 6)
        spread = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
        if spread[2] > 0.15 * spread[0]:
            return list(points.tolist())


def _exponents(random: Random) -> tuple[float, float]:
    choice = int(random.integers(4))
    low, high = ((0.4, 0.9), (1.05, 1.6))[choice % 2]
    one = number(random, low, high)
    other = number(random, 0.4, 0.9) if choice == 2 else number(random, low, high)
    return one, other


def numbers_of(kind: str, random: Random, size: float) -> dict[str, object]:
    """Return the sizes of a solid, by the names that body and shape share."""

    def some() -> float:
        return number(random, 0.35 * size, size)

    if kind in ("ball", "sphere"):
        return {"radius": some()}
    if kind in ("capsule", "cylinder"):
        found: dict[str, object] = {"radius": some(), "half_length": some()}
    elif kind == "cone":
        found = {"radius": some(), "height": some() + some()}
    elif kind == "disc":
        found = {"radius": some()}
    elif kind == "box":
        found = {"half_x": some(), "half_y": some(), "half_z": some()}
    elif kind == "hull":
        found = {"points": _points(random, size)}
    else:
        found = {"semi_x": some(), "semi_y": some(), "semi_z": some()}
        if kind == "superellipsoid":
            found["exponent_along"], found["exponent_across"] = _exponents(random)
    rounds = kind not in ("ball", "capsule", "ellipsoid")
    if rounds and random.random() < 0.35:
        found["rounding"] = number(random, 0.03 * size, 0.12 * size)
    if kind in ("cylinder", "cone", "disc") and random.random() < 0.2:
        found["foot_height"] = 0.0
    return found


def free_body(random: Random, kind: str, size: float) -> Body:
    """Return a free body."""
    density = float(random.choice([1200.0, 2700.0, 7800.0]))
    if kind == "ball":
        return Ball(number(random, 0.35 * size, size), density)
    if kind == "dumbbell":
        return Dumbbell(number(random, 0.25 * size, 0.5 * size), number(random, 2.2, 5.0))
    if kind == "rod":
        return Rod(number(random, size, 3.0 * size), number(random, 0.05 * size, 0.3 * size), density)
    if kind == "mesh":
        return MeshBody(triangles(random, size), density)
    made = {
        "capsule": CapsuleBody,
        "cylinder": CylinderBody,
        "cone": ConeBody,
        "disc": DiscBody,
        "box": BoxBody,
        "hull": HullBody,
        "ellipsoid": EllipsoidBody,
        "superellipsoid": SuperellipsoidBody,
    }[kind]
    weight = {"surface_density": float(random.choice([1.0, 10.0]))} if kind == "disc" else {"density": density}
    body: Body = made(**numbers_of(kind, random, size), **weight)
    return body


def held_shape(random: Random, kind: str, size: float) -> Shape:
    """Return a shape for a held body; a dumbbell or a rod gives a capsule."""
    if kind == "mesh":
        return TriangleMesh(triangles(random, size))
    kind = {"ball": "sphere", "dumbbell": "capsule", "rod": "capsule"}.get(kind, kind)
    made = {
        "sphere": Sphere,
        "capsule": Capsule,
        "cylinder": Cylinder,
        "cone": Cone,
        "disc": Disc,
        "box": Box,
        "hull": ConvexHull,
        "ellipsoid": Ellipsoid,
        "superellipsoid": Superellipsoid,
    }[kind]
    shape: Shape = made(**numbers_of(kind, random, size))
    return shape
