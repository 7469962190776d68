"""A vertex of a polyhedron or segment as a sphere against another swept polyhedron or segment."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from bodies.contacts.curvature import SIDE_A, SIDE_B, write_round
from bodies.contacts.frames import point_in_world, vector_in_body, vector_in_world
from bodies.contacts.nearest import nearest_feature
from bodies.contacts.polytope_tables import EDGE, FACE, Numbers, edge_rows, end_table, face_table, star_of
from bodies.contacts.swept_side import write_swept
from bodies.contacts.tangents import write_tangent
from bodies.shapes.swept import SweptPolytope
from nonsmooth.compiled import compiled
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

END = 3e-10
"""So far before its end, in units of the size of the bodies, an edge gives its contact to the vertex, and the vertex
gives it back after twice that way: neither none of them is closed nor both of them for long."""
NEAR = 1e-6
"""A wider gap, in units of the size, ends nowhere: it is that of a sphere that is part of the body."""


@compiled
def _past(
    frame: Floats, star: Floats, n_star: float, distance: float, nx: float, ny: float, nz: float, size: float
) -> float:
    """Return how far the nearest point of the other core, along -n from the vertex, is past it along one of its edges.

    Then that edge is nearer than the vertex.
    """
    x, y, z = vector_in_body(frame, nx, ny, nz)
    past = -size
    for i in range(int(n_star)):
        along = x * star[3 * i] + y * star[3 * i + 1] + z * star[3 * i + 2]
        past = max(past, -distance * along)
    return past - 2.0 * END * size


@compiled
def _gap(gap: float, past: float, size: float) -> tuple[float, float]:
    """Return gap and way past the end as they are written."""
    if gap > NEAR * size:
        return gap, min(past, -END * size)
    if past > 0.0:
        return math.sqrt(gap * gap + past * past), past
    return gap, past


def _evaluate(
    a: Floats,
    b: Floats,
    out: Floats,
    n_faces: float,
    faces: Floats,
    n_edges: float,
    edges: Floats,
    ends: Floats,
    sweep: float,
    x_v: float,
    y_v: float,
    z_v: float,
    n_star: float,
    star: Floats,
    radius: float,
    size: float,
) -> None:
    center_x, center_y, center_z = point_in_world(b, x_v, y_v, z_v)
    x, y, z = vector_in_body(a, center_x - a[0], center_y - a[1], center_z - a[2])
    number, distance, nx, ny, nz, _ = nearest_feature(n_faces, faces, n_edges, edges, ends, x, y, z)
    nx, ny, nz = vector_in_world(a, nx, ny, nz)
    past = _past(b, star, n_star, distance, nx, ny, nz, size)
    gap, past = _gap(distance - sweep - radius, past, size)
    out[0], out[29], out[30] = gap, number, past
    out[1], out[2], out[3] = nx, ny, nz
    out[10], out[11], out[12] = center_x - radius * nx, center_y - radius * ny, center_z - radius * nz
    for i in range(3):
        out[7 + i] = out[10 + i] - gap * out[1 + i]
    write_tangent(a, out)
    write_swept(a, out, SIDE_A, number, n_faces, n_edges, edges, sweep)
    write_round(out, SIDE_B, radius)


def _evaluate_reversed(
    a: Floats,
    b: Floats,
    out: Floats,
    n_faces: float,
    faces: Floats,
    n_edges: float,
    edges: Floats,
    ends: Floats,
    sweep: float,
    x_v: float,
    y_v: float,
    z_v: float,
    n_star: float,
    star: Floats,
    radius: float,
    size: float,
) -> None:
    center_x, center_y, center_z = point_in_world(a, x_v, y_v, z_v)
    x, y, z = vector_in_body(b, center_x - b[0], center_y - b[1], center_z - b[2])
    number, distance, nx, ny, nz, within = nearest_feature(n_faces, faces, n_edges, edges, ends, x, y, z)
    nx, ny, nz = vector_in_world(b, nx, ny, nz)
    past = _past(a, star, n_star, distance, nx, ny, nz, size)
    # two vertices are the contact of the second body's
    shared = END * size - within
    gap, past = _gap(distance - sweep - radius, max(past, shared), size)
    if shared > 0.0:
        gap, past = math.sqrt((distance - sweep - radius) ** 2 + shared * shared), max(past, shared)
    out[0], out[29], out[30] = gap, number, past
    out[1], out[2], out[3] = -nx, -ny, -nz
    out[7], out[8], out[9] = center_x - radius * nx, center_y - radius * ny, center_z - radius * nz
    for i in range(3):
        out[10 + i] = out[7 + i] + gap * out[1 + i]
    write_tangent(a, out)
    write_round(out, SIDE_A, radius)
    write_swept(b, out, SIDE_B, number, n_faces, n_edges, edges, sweep)


@dataclass(frozen=True)
class _Tables:
    """The numbers of a core with its radius, and of a vertex of the other with its own."""

    faces: Numbers
    edges: Numbers
    ends: Numbers
    sweep: float
    vertex: int
    place: tuple[float, float, float]
    star: Numbers
    radius: float
    size: float

    def values(self) -> dict[str, Value]:
        x, y, z = self.place
        return {
            "n_faces": float(len(self.faces) // FACE),
            "faces": self.faces,
            "n_edges": float(len(self.edges) // EDGE),
            "edges": self.edges,
            "ends": self.ends,
            "sweep": self.sweep,
            "x_v": x,
            "y_v": y,
            "z_v": z,
            "n_star": float(len(self.star) // 3),
            "star": self.star,
            "radius": self.radius,
            "size": self.size,
        }

    @property
    def features(self) -> tuple[str, ...]:
        counts = ("face", len(self.faces) // FACE), ("edge", len(self.ends) // 2), ("vertex", int(max(self.ends)) + 1)
        return tuple(f"{name} {i} and vertex {self.vertex}" for name, n in counts for i in range(n))


def _all_tables(first: SweptPolytope, second: SweptPolytope, size: float) -> list[_Tables]:
    core, other = first.core, second.core
    faces, edges, ends = face_table(core), tuple(itertools.chain(*edge_rows(core))), end_table(core)
    return [
        _Tables(faces, edges, ends, first.sweep, i, place, star_of(other, i), second.sweep, size)
        for i, place in enumerate(other.vertices)
    ]


def size_of(first: SweptPolytope, second: SweptPolytope) -> float:
    """Return the size of the larger of two shapes [m]."""
    return max(shape.core.size + 2.0 * shape.sweep for shape in (first, second))


@final
@dataclass(frozen=True)
class SweptVertex(ContactKinematics):
    """A vertex of the second shape, with its radius, against the nearest face, edge or vertex of the first.

    Attributes
    ----------
    tables : _Tables
        The first shape, and the vertex.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (SweptPolytope, SweptPolytope)
    tables: _Tables

    def parameters(self) -> dict[str, Value]:
        """Return the tables."""
        return self.tables.values()

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[SweptVertex, ...]:
        """Return the contacts of all vertices of the second."""
        assert isinstance(first, SweptPolytope)
        assert isinstance(second, SweptPolytope)
        return tuple(cls(tables) for tables in _all_tables(first, second, size_of(first, second)))

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return _evaluate

    @property
    def features(self) -> tuple[str, ...]:
        """Faces, edges and vertices of the first."""
        return self.tables.features


@final
@dataclass(frozen=True)
class VertexSwept(ContactKinematics):
    """A vertex of the first shape, with its radius, against the nearest face or edge of the second.

    Attributes
    ----------
    tables : _Tables
        The second shape, and the vertex.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (SweptPolytope, SweptPolytope)
    tables: _Tables

    def parameters(self) -> dict[str, Value]:
        """Return the tables."""
        return self.tables.values()

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[VertexSwept, ...]:
        """Return the contacts of all vertices of the first."""
        assert isinstance(first, SweptPolytope)
        assert isinstance(second, SweptPolytope)
        return tuple(cls(tables) for tables in _all_tables(second, first, size_of(first, second)))

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return _evaluate_reversed

    @property
    def features(self) -> tuple[str, ...]:
        """Faces, edges and vertices of the second; the last never closed."""
        return self.tables.features
