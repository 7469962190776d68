"""Rounded polyhedra and capsules of about a centimetre, and poses made from their nearest features."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from bodies import Box, Capsule, ConvexHull, SweptPolytope
from tests.bodies.polytopes import random_hull, tetrahedron

Array = NDArray[np.float64]

KINDS = ("face-vertex", "vertex-face", "edge-edge", "edge-vertex", "vertex-edge", "vertex-vertex")


def random_shapes(rng: np.random.Generator) -> dict[str, tuple[SweptPolytope, SweptPolytope]]:
    """Return pairs of shapes, half-sizes 4 to 10 mm, roundings 0.2 to 3 mm."""

    def box(rounding: float) -> Box:
        q = rng.normal(size=4)
        axes: Any = dict(zip([f"orientation_{c}" for c in "wxyz"], (q / np.linalg.norm(q)).tolist(), strict=True))
        return replace(Box(*rng.uniform(4e-3, 1e-2, 3).tolist(), **axes), rounding=rounding)

    def rounded(hull: ConvexHull, rounding: float) -> ConvexHull:
        return ConvexHull(hull.points, rounding=rounding)

    def capsule_of(radius: float, half_length: float) -> Capsule:
        axis = rng.normal(size=3)
        along = (axis / np.linalg.norm(axis)).tolist()
        return Capsule(radius, half_length, *rng.uniform(-2e-3, 2e-3, 3).tolist(), *along)

    capsule = capsule_of(2e-3, 7e-3)
    return {
        "rounded boxes": (box(1e-3), box(3e-3)),
        "rounded box-box": (box(2e-4), box(0.0)),
        "box-rounded hull": (box(0.0), rounded(random_hull(rng, 9, 8e-3), 5e-4)),
        "rounded hulls": (rounded(random_hull(rng, 6, 7e-3), 2e-3), rounded(tetrahedron(rng, 7e-3), 1e-3)),
        "capsule-box": (capsule, box(0.0)),
        "rounded box-capsule": (box(1e-3), capsule),
        "hull-capsule": (random_hull(rng, 9, 8e-3), capsule),
        "capsules": (capsule, capsule_of(3e-3, 4e-3)),
    }


def _normals(core: Any) -> Array:
    return np.array(core.planes).reshape(-1, 4)[:, :3]


def _blend(rng: np.random.Generator, normals: Array) -> Array:
    n = rng.dirichlet(4.0 * np.ones(len(normals))) @ normals
    return np.asarray(n / np.linalg.norm(n))


def _direction(core: Any) -> Array:
    way = np.subtract(core.vertices[1], core.vertices[0])
    return np.asarray(way / np.linalg.norm(way))


def feature(rng: np.random.Generator, shape: SweptPolytope, kind: str) -> tuple[Array, Array, int]:
    """Return a point inside a feature of the core, a normal well inside of those that it has, and its number."""
    core = shape.core
    vertices = np.array(core.vertices)
    if kind == "face":
        number = int(rng.integers(len(core.faces)))
        corners = vertices[list(core.faces[number])]
        return rng.dirichlet(8.0 * np.ones(len(corners))) @ corners, _normals(core)[number], number
    if kind == "edge":
        number = int(rng.integers(len(core.edges)))
        one, two, left, right = core.edges[number]
        s = rng.uniform(0.3, 0.7)
        if left >= 0:
            n = _blend(rng, _normals(core)[[left, right]])
        else:
            n = np.cross(_direction(core), rng.normal(size=3))
            n /= np.linalg.norm(n)
        return (1.0 - s) * vertices[one] + s * vertices[two], n, number
    number = int(rng.integers(len(vertices)))
    if core.faces:
        own = [i for i, face in enumerate(core.faces) if number in face]
        return vertices[number], _blend(rng, _normals(core)[own]), number
    n = rng.normal(size=3)
    outward = (1.0 if number == 1 else -1.0) * _direction(core)
    n += (rng.uniform(0.5, 2.0) - n @ outward) * outward
    return vertices[number], n / np.linalg.norm(n), number


def _turn(start: Array, end: Array, spin: float) -> Rotation:
    axis = np.cross(start, end)
    angle = np.arctan2(np.linalg.norm(axis), start @ end)
    return Rotation.from_rotvec(spin * end) * Rotation.from_rotvec(angle * axis / np.linalg.norm(axis))


class Posed:
    """Two bodies whose nearest points are known: gap, normal, witness points, and the contact's place in the list."""

    def __init__(
        self, rng: np.random.Generator, shapes: tuple[SweptPolytope, SweptPolytope], kind: str, gap: float
    ) -> None:
        one, two = shapes
        own, n, i = feature(rng, one, kind.split("-")[0])
        other, out, j = feature(rng, two, kind.split("-")[1])
        while True:
            facing = _turn(out, -n, rng.uniform(0.0, 2.0 * np.pi))
            if kind != "edge-edge":
                break
            # edges that are nearly parallel cross nowhere
            ways = [
                np.diff([s.core.vertices[v] for v in s.core.edges[e][:2]], axis=0)[0] for s, e in ((one, i), (two, j))
            ]
            ways = [way / np.linalg.norm(way) for way in ways]
            if np.linalg.norm(np.cross(ways[0], facing.apply(ways[1]))) > 0.1:
                break
        n_edges = len(one.core.edges) * len(two.core.edges)
        self.number = i * len(two.core.edges) + j
        if kind.endswith("vertex"):
            # sharp corners have a contact with each face
            is_sharp = one.sweep + two.sweep == 0.0
            self.number = n_edges + (i * len(two.core.vertices) if is_sharp else 0) + j
        elif kind.startswith("vertex"):
            self.number = n_edges + len(two.core.vertices) + i
        turn, place = Rotation.random(random_state=rng), rng.uniform(-0.1, 0.1, 3)
        self.gap, self.normal = gap, turn.apply(n)
        surface = own + one.sweep * n
        self.witness = turn.apply(surface) + place, turn.apply(surface + gap * n) + place
        second = turn * facing
        self.poses = [
            (place, np.roll(turn.as_quat(), 1)),
            (self.witness[1] - second.apply(other + two.sweep * out), np.roll(second.as_quat(), 1)),
        ]
