"""Shapes of about a centimetre, and a point on a given part of each with a normal there."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from bodies import Box, Capsule, Cone, ConvexHull, Cylinder, Disc, Ellipsoid, Frustum, Plane, Sphere, Superellipsoid
from bodies.shapes.polyhedron import Polyhedron
from nonsmooth.interfaces import ConvexShape, Shape

Array = NDArray[np.float64]
Touch = tuple[Shape, Array, Array]
"""A shape, a point of its surface and an outward normal there, in the frame of its body."""
_SMALL, _LARGE = 4e-3, 10e-3


def quaternion(rng: Generator) -> Array:
    q = rng.normal(size=4)
    return np.asarray(q / np.linalg.norm(q))


def _place(rng: Generator) -> dict[str, float]:
    q = quaternion(rng)
    place = dict(zip("xyz", rng.uniform(-2e-3, 2e-3, 3).tolist(), strict=True))
    return place | {f"orientation_{name}": float(value) for name, value in zip("wxyz", q, strict=True)}


def _sizes(rng: Generator) -> list[float]:
    return [float(x) for x in rng.uniform(_SMALL, _LARGE, 3)]


def ellipsoid(rng: Generator) -> ConvexShape:
    """Return an ellipsoid of any size and place."""
    return Ellipsoid(*_sizes(rng), **_place(rng))


def superellipsoid(rng: Generator) -> ConvexShape:
    """Return a superellipsoid, in half of the cases a rounded one."""
    (a, b, c), (along, across) = _sizes(rng), rng.uniform(1.1, 1.5, 2).tolist()
    return Superellipsoid(a, b, c, along, across, float(rng.choice([0.0, 1e-3])), **_place(rng))


def boxy(rng: Generator) -> ConvexShape:
    """Return a boxy superellipsoid, in half of the cases a rounded one."""
    (a, b, c), (along, across) = _sizes(rng), rng.uniform(0.2, 0.9, 2).tolist()
    return Superellipsoid(a, b, c, along, across, float(rng.choice([0.0, 1e-3])), **_place(rng))


def mixed(rng: Generator) -> ConvexShape:
    """Return a superellipsoid with flat places along its third axis and sharp ones across, or the other way round.

    In half of the cases it is a rounded one.
    """
    exponents = [float(rng.uniform(0.2, 0.9)), float(rng.uniform(1.1, 1.5))]
    (a, b, c), (along, across) = _sizes(rng), exponents if rng.uniform() < 0.5 else exponents[::-1]
    return Superellipsoid(a, b, c, along, across, float(rng.choice([0.0, 1e-3])), **_place(rng))


def sphere(rng: Generator) -> ConvexShape:
    """Return a sphere."""
    return Sphere(float(rng.uniform(_SMALL, _LARGE)), *rng.uniform(-2e-3, 2e-3, 3).tolist())


def anywhere(draw: Callable[[Generator], ConvexShape]) -> Callable[[Generator], Touch]:
    """Return a way to touch a smooth shape: at any normal."""

    def touch(rng: Generator) -> Touch:
        shape, n = draw(rng), rng.normal(size=3)
        n /= np.linalg.norm(n)
        return shape, shape.support(n), n

    return touch


def on_plane(rng: Generator) -> Touch:
    """Touch a plane."""
    plane = Plane(float(rng.uniform(-0.01, 0.01)))
    return plane, np.array([*rng.uniform(-0.1, 0.1, 2), plane.height]), np.array([0.0, 0.0, 1.0])


def box(rng: Generator) -> Polyhedron:
    """Return a box."""
    return Box(*_sizes(rng), **_place(rng))


def hull(rng: Generator) -> Polyhedron:
    """Return the hull of twelve points on an ellipsoid."""
    points = rng.normal(size=(12, 3))
    points *= np.array(_sizes(rng)) / np.linalg.norm(points, axis=1)[:, None]
    return ConvexHull(points.tolist(), **_place(rng))


def rounded(draw: Callable[[Generator], Polyhedron]) -> Callable[[Generator], Polyhedron]:
    """Return a way to draw polyhedra with a rounding of 0.5 to 2 mm."""
    return lambda rng: replace(draw(rng), rounding=float(rng.uniform(5e-4, 2e-3)))  # type: ignore[type-var]


def on(draw: Callable[[Generator], Polyhedron], part: str) -> Callable[[Generator], Touch]:
    """Return a way to touch a polyhedron on a face, an edge or a vertex, with any normal that belongs to it."""

    def touch(rng: Generator) -> Touch:
        shape = draw(rng)
        vertices, normals = np.array(shape.core.vertices), np.array(shape.core.planes)[:, :3]
        counts = {"face": len(normals), "edge": len(shape.core.edges), "vertex": len(vertices)}
        number = int(rng.integers(counts[part]))
        if part == "face":
            corners, faces = list(shape.core.faces[number]), [number]
        elif part == "edge":
            corners, faces = list(shape.core.edges[number][:2]), list(shape.core.edges[number][2:])
        else:
            corners, faces = [number], [i for i, loop in enumerate(shape.core.faces) if number in loop]
        shares, weights = rng.uniform(0.1, 1.0, len(corners)), rng.uniform(0.1, 1.0, len(faces))
        n = weights @ normals[faces]
        n /= np.linalg.norm(n)
        return shape, shares @ vertices[corners] / np.sum(shares) + shape.rounding * n, n

    return touch


def on_capsule(rng: Generator) -> Touch:
    """Touch a capsule, on its side in half of the cases."""
    axis = rng.normal(size=3)
    axis /= np.linalg.norm(axis)
    center = rng.uniform(-2e-3, 2e-3, 3)
    shape = Capsule(float(rng.uniform(1e-3, _SMALL)), float(rng.uniform(_SMALL, _LARGE)), *center, *axis.tolist())
    n = rng.normal(size=3)
    along = 1.0 if n @ axis > 0.0 else -1.0
    if rng.uniform() < 0.5:
        n -= n @ axis * axis
        along = float(rng.uniform(-0.95, 0.95))
    n /= np.linalg.norm(n)
    return shape, center + along * shape.half_length * axis + shape.radius * n, n


def _along(rng: Generator) -> dict[str, float]:
    names = [f"{kind}{c}" for kind in ("", "axis_") for c in "xyz"]
    axis = rng.normal(size=3)
    numbers = [*rng.uniform(-2e-3, 2e-3, 3), *axis / np.linalg.norm(axis)]
    return dict(zip(names, map(float, numbers), strict=True))


def cylinder(rng: Generator) -> Frustum:
    """Return a cylinder."""
    return Cylinder(*_sizes(rng)[:2], **_along(rng))


def cone(rng: Generator) -> Frustum:
    """Return a cone."""
    radius, half, _ = _sizes(rng)
    return Cone(radius, 2.0 * half, **_along(rng))


def disc(rng: Generator) -> Frustum:
    """Return a disc."""
    return Disc(_sizes(rng)[0], **_along(rng))


def on_round(draw: Callable[[Generator], Frustum], part: str, is_on_feet: bool = False) -> Callable[[Generator], Touch]:
    """Return a way to touch a cylinder, a cone or a disc on a cap, a rim, the side or the apex.

    Bodies with faces touch one ``is_on_feet`` at rims and caps that are set back by its feet.
    """

    def touch(rng: Generator) -> Touch:
        shape = draw(rng)
        low, high, below, above, feet, _, *rest = shape.frustum
        if is_on_feet and above > below:
            back = feet / (above - below)
            low, below = low + back * (high - low), below + feet
            if high > 0.0:
                above -= feet
        center, axes, (cos, sin) = np.array(rest[:3]), np.array(rest[3:12]).reshape(3, 3), rest[12:14]
        angle, upper = rng.uniform(0.0, 2.0 * np.pi), bool(rng.integers(2)) and high > 0.0
        if part == "apex":
            upper = True
        radius, height, up = (high, above, 1.0) if upper else (low, below, -1.0)
        share = float(rng.uniform(0.05, 0.95))
        if part == "cap":
            away, along, radial, axial = share * radius, height, 0.0, up
        elif part == "side":
            away, along, radial, axial = low + share * (high - low), below + share * (above - below), cos, sin
        else:
            # between the normals of cap and side; a disc has no side, but another face
            flat = above == below
            start = -0.5 * np.pi if flat else float(np.arctan2(sin, cos))
            turn = start + share * (0.5 * np.pi if flat or upper else -0.5 * np.pi - start) * (2.0 if flat else 1.0)
            if upper and not flat:
                turn = start + share * (0.5 * np.pi - start)
            away, along, radial, axial = radius, height, float(np.cos(turn)), float(np.sin(turn))
        outward = np.array([np.cos(angle), np.sin(angle), 0.0])
        point = away * outward + np.array([0.0, 0.0, along])
        normal = axes @ (radial * outward + np.array([0.0, 0.0, axial]))
        return shape, center + axes @ point + shape.rounding * normal, normal

    return touch


def rounded_round(draw: Callable[[Generator], Frustum]) -> Callable[[Generator], Frustum]:
    """Return a way to draw cylinders, cones and discs with a rounding of 0.2 to 1 mm."""
    return lambda rng: replace(draw(rng), rounding=float(rng.uniform(2e-4, 1e-3)))  # type: ignore[type-var]


ROUND: dict[str, tuple[Callable[[Generator], Frustum], tuple[str, ...]]] = {
    "cylinder": (cylinder, ("cap", "rim", "side")),
    "cone": (cone, ("cap", "rim", "side", "apex")),
    "disc": (disc, ("cap", "rim")),
}
ROUNDED_ROUND = {f"rounded {name}": (rounded_round(draw), parts) for name, (draw, parts) in ROUND.items()}
