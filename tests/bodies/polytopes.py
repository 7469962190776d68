"""Polyhedra of about a centimetre, and poses whose nearest features are known because they are made from them."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from bodies import Box, ConvexHull, Polyhedron

Array = NDArray[np.float64]


def dodecahedron(radius: float) -> tuple[tuple[float, float, float], ...]:
    """Return its twenty vertices [m]."""
    golden = 0.5 * (1.0 + np.sqrt(5.0))
    points = list(itertools.product((-1.0, 1.0), repeat=3))
    for a, b in itertools.product((-1.0, 1.0), repeat=2):
        points += [(0.0, a / golden, b * golden), (a / golden, b * golden, 0.0), (b * golden, 0.0, a / golden)]
    x = np.array(points) * radius / np.sqrt(3.0)
    return tuple(map(tuple, x.tolist()))


def random_hull(rng: np.random.Generator, n: int, size: float) -> ConvexHull:
    """Return the hull of random points next to a ball."""
    points = rng.normal(size=(n, 3))
    points *= size * rng.uniform(0.8, 1.0, (n, 1)) / np.linalg.norm(points, axis=1)[:, None]
    return ConvexHull(points.tolist())


SLIVER = ((-6e-3, 0.0, 0.0), (6e-3, 1e-3, 0.0), (0.0, -5e-3, 2e-4), (1e-3, 5e-3, 3e-4))
"""A tetrahedron of a fraction of a millimetre's thickness, with edges like knives."""


def tetrahedron(rng: np.random.Generator, size: float) -> ConvexHull:
    """Return a tetrahedron, nearly regular."""
    corners = np.array([(1.0, 1.0, 1.0), (1.0, -1.0, -1.0), (-1.0, 1.0, -1.0), (-1.0, -1.0, 1.0)])
    return ConvexHull((size / np.sqrt(3.0) * (corners + rng.uniform(-0.2, 0.2, (4, 3)))).tolist())


def random_shapes(rng: np.random.Generator) -> dict[str, tuple[Polyhedron, Polyhedron]]:
    """Return pairs of shapes, half-sizes 4 to 10 mm."""
    one, two = (Box(*rng.uniform(4e-3, 1e-2, 3).tolist(), **_axes(rng)) for _ in range(2))
    return {
        "box-box": (one, two),
        "box-hull": (one, random_hull(rng, 12, 8e-3)),
        "hull-hull": (random_hull(rng, 6, 7e-3), random_hull(rng, 10, 9e-3)),
        "tetrahedra": (tetrahedron(rng, 7e-3), tetrahedron(rng, 9e-3)),
        "slivers": (ConvexHull(SLIVER), random_hull(rng, 4, 9e-3)),
        "dodecahedra": (ConvexHull(dodecahedron(8e-3)), ConvexHull(dodecahedron(6e-3))),
    }


def _axes(rng: np.random.Generator) -> Any:
    q = rng.normal(size=4)
    return dict(zip([f"orientation_{c}" for c in "wxyz"], (q / np.linalg.norm(q)).tolist(), strict=True))


def _turn(start: Array, end: Array, spin: float) -> Rotation:
    """Return a rotation that turns one unit vector into another, and then by an angle about it."""
    axis = np.cross(start, end)
    angle = np.arctan2(np.linalg.norm(axis), start @ end)
    return Rotation.from_rotvec(spin * end) * Rotation.from_rotvec(angle * axis / np.linalg.norm(axis))


def _blend(rng: np.random.Generator, normals: Array) -> Array:
    """Return a unit vector well inside the cone of some."""
    n = rng.dirichlet(4.0 * np.ones(len(normals))) @ normals
    return np.asarray(n / np.linalg.norm(n))


class Posed:
    """Two bodies whose nearest points are known: gap, normal, witness points, and the contact's place in the list."""

    def __init__(self, rng: np.random.Generator, shapes: tuple[Polyhedron, Polyhedron], kind: str, gap: float) -> None:
        one, two = (shape.polytope for shape in shapes)
        turn = Rotation.random(random_state=rng)
        place = rng.uniform(-0.1, 0.1, 3)
        n_edges, n_two = len(one.edges) * len(two.edges), len(two.vertices)
        self.gap = gap
        if kind == "edge-edge":
            i, j = int(rng.integers(len(one.edges))), int(rng.integers(len(two.edges)))
            (own, n), (other, out) = self._edge(rng, one, i), self._edge(rng, two, j)
            # edges that are nearly parallel cross nowhere
            while True:
                facing = _turn(out, -n, rng.uniform(0.0, 2.0 * np.pi))
                ways = [np.diff([p.vertices[v] for v in p.edges[e][:2]], axis=0)[0] for p, e in ((one, i), (two, j))]
                way = facing.apply(ways[1])
                if np.linalg.norm(np.cross(ways[0], way)) > 0.1 * np.linalg.norm(ways[0]) * np.linalg.norm(way):
                    break
            self.number = i * len(two.edges) + j
        elif kind == "face-vertex":
            own, n, face = self._face(rng, one)
            other, out, v = self._vertex(rng, two)
            facing = _turn(out, -n, rng.uniform(0.0, 2.0 * np.pi))
            self.number = n_edges + face * n_two + v
        else:
            own, n, v = self._vertex(rng, one)
            other, out, face = self._face(rng, two)
            facing = _turn(out, -n, rng.uniform(0.0, 2.0 * np.pi))
            self.number = n_edges + len(one.faces) * n_two + face * len(one.vertices) + v
        self.normal = turn.apply(n)
        self.witness = turn.apply(own) + place, turn.apply(own + gap * n) + place
        second = turn * facing
        self.poses = [
            (place, np.roll(turn.as_quat(), 1)),
            (self.witness[1] - second.apply(other), np.roll(second.as_quat(), 1)),
        ]

    @staticmethod
    def _edge(rng: np.random.Generator, polytope: Any, number: int) -> tuple[Array, Array]:
        one, two, left, right = polytope.edges[number]
        s = rng.uniform(0.3, 0.7)
        normals = np.array(polytope.planes)[[left, right], :3]
        return (1.0 - s) * np.array(polytope.vertices[one]) + s * np.array(polytope.vertices[two]), _blend(rng, normals)

    @staticmethod
    def _face(rng: np.random.Generator, polytope: Any) -> tuple[Array, Array, int]:
        f = int(rng.integers(len(polytope.faces)))
        corners = np.array(polytope.vertices)[list(polytope.faces[f])]
        return rng.dirichlet(8.0 * np.ones(len(corners))) @ corners, np.array(polytope.planes[f][:3]), f

    @staticmethod
    def _vertex(rng: np.random.Generator, polytope: Any) -> tuple[Array, Array, int]:
        v = int(rng.integers(len(polytope.vertices)))
        normals = [plane[:3] for plane, face in zip(polytope.planes, polytope.faces, strict=True) if v in face]
        return np.array(polytope.vertices[v]), _blend(rng, np.array(normals)), v
