"""Contacts of a vertex with the faces of a polyhedron; the vertex may belong to the first or the second body."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import FEATURE, GAP, NORMAL, PAST_END, POINT_A, POINT_B, SIDE_A, SIDE_B, TANGENT
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...shapes.point import Point
from ...shapes.polyhedron import Polyhedron
from ...shapes.polytope import Polytope
from ..features.frames import point_in_world, tangent_of, vector_in_world
from ..features.polytope_tables import FACE, Numbers, face_table, vertex_table
from ..features.vertex_face import height_over, nearest_face
from ..features.writing import write_flat, write_round
from .polyhedron_sphere import PolyhedronSphere


@compiled
def _write_face_tangent(frame: Floats, out: Floats, faces: Floats, f: int) -> None:
    """Write the first tangent of a face, fixed to its body."""
    x, y, z = tangent_of(faces[f], faces[f + 1], faces[f + 2])
    out[TANGENT], out[TANGENT + 1], out[TANGENT + 2] = vector_in_world(frame, x, y, z)


def _evaluate(
    a: Floats,
    b: Floats,
    out: Floats,
    n_faces: float,
    faces: Floats,
    n_vertices: float,
    vertices: Floats,
    vertex: float,
    size: float,
) -> None:
    face, gap, past = nearest_face(a, b, n_faces, faces, n_vertices, vertices, vertex, size)
    f, v = FACE * int(face), 3 * int(vertex)
    out[GAP], out[FEATURE], out[PAST_END] = gap, face, past
    out[NORMAL], out[NORMAL + 1], out[NORMAL + 2] = vector_in_world(a, faces[f], faces[f + 1], faces[f + 2])
    out[POINT_B], out[POINT_B + 1], out[POINT_B + 2] = point_in_world(b, vertices[v], vertices[v + 1], vertices[v + 2])
    for i in range(3):
        out[POINT_A + i] = out[POINT_B + i] - gap * out[NORMAL + i]
    _write_face_tangent(a, out, faces, f)
    write_flat(out, SIDE_A)
    write_round(out, SIDE_B, 0.0)


def _evaluate_reversed(
    a: Floats,
    b: Floats,
    out: Floats,
    n_faces: float,
    faces: Floats,
    n_vertices: float,
    vertices: Floats,
    vertex: float,
    size: float,
) -> None:
    face, gap, past = nearest_face(b, a, n_faces, faces, n_vertices, vertices, vertex, size)
    f, v = FACE * int(face), 3 * int(vertex)
    out[GAP], out[FEATURE], out[PAST_END] = gap, face, past
    out[NORMAL], out[NORMAL + 1], out[NORMAL + 2] = vector_in_world(b, -faces[f], -faces[f + 1], -faces[f + 2])
    out[POINT_A], out[POINT_A + 1], out[POINT_A + 2] = point_in_world(a, vertices[v], vertices[v + 1], vertices[v + 2])
    for i in range(3):
        out[POINT_B + i] = out[POINT_A + i] + gap * out[NORMAL + i]
    _write_face_tangent(b, out, faces, f)
    write_round(out, SIDE_A, 0.0)
    write_flat(out, SIDE_B)


def _bound(
    a: Floats,
    b: Floats,
    out: Floats,
    n_faces: float,
    faces: Floats,
    n_vertices: float,
    vertices: Floats,
    vertex: float,
    size: float,
) -> None:
    v = 3 * int(vertex)
    px, py, pz = point_in_world(b, vertices[v], vertices[v + 1], vertices[v + 2])
    out[0] = height_over(a, n_faces, faces, px, py, pz)


def _bound_reversed(
    a: Floats,
    b: Floats,
    out: Floats,
    n_faces: float,
    faces: Floats,
    n_vertices: float,
    vertices: Floats,
    vertex: float,
    size: float,
) -> None:
    v = 3 * int(vertex)
    px, py, pz = point_in_world(a, vertices[v], vertices[v + 1], vertices[v + 2])
    out[0] = height_over(b, n_faces, faces, px, py, pz)


@dataclass(frozen=True)
class _Tables:
    """Tables of a polyhedron's faces and of the vertices of the other body, with the number of one vertex."""

    faces: Numbers
    vertices: Numbers
    vertex: int
    size: float

    def values(self) -> dict[str, Value]:
        return {
            "n_faces": float(len(self.faces) // FACE),
            "faces": self.faces,
            "n_vertices": float(len(self.vertices) // 3),
            "vertices": self.vertices,
            "vertex": float(self.vertex),
            "size": self.size,
        }

    @property
    def features(self) -> tuple[str, ...]:
        return tuple(f"face {i} and vertex {self.vertex}" for i in range(len(self.faces) // FACE))


@final
@dataclass(frozen=True)
class PolyhedronPoint(ContactKinematics):
    """A vertex of the second body against the faces of the first.

    Attributes
    ----------
    tables : _Tables
        The polyhedron, and the vertices of the second body.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Polyhedron, Point)
    tables: _Tables

    def parameters(self) -> dict[str, Value]:
        """Return the tables."""
        return self.tables.values()

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[ContactKinematics, ...]:
        """Return the single contact of a polyhedron and a point.

        If the polyhedron is rounded, the point is treated as a ball of radius 0.
        """
        assert isinstance(first, Polyhedron)
        assert isinstance(second, Point)
        if first.rounding > 0.0:
            return (PolyhedronSphere.of_ball(first, (second.x, second.y, second.z), 0.0),)
        own = first.core
        return (cls(_Tables(face_table(own), (second.x, second.y, second.z), 0, own.size)),)

    @classmethod
    def of_vertices(cls, first: Polytope, second: Polytope) -> tuple[PolyhedronPoint, ...]:
        """Return the contacts of all vertices of the second polyhedron."""
        return tuple(cls(tables) for tables in _all_tables(first, second))

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return _evaluate

    @property
    def bound(self) -> Callable[..., None]:
        """The height of the vertex over the faces."""
        return _bound

    @property
    def features(self) -> tuple[str, ...]:
        """Names of the pairs of features: each face of the polyhedron with the vertex of the other body."""
        return self.tables.features


@final
@dataclass(frozen=True)
class PointPolyhedron(ContactKinematics):
    """A vertex of the first body against the faces of the second.

    Attributes
    ----------
    tables : _Tables
        The polyhedron, and the vertices of the first body.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Point, Polyhedron)
    tables: _Tables

    def parameters(self) -> dict[str, Value]:
        """Return the tables."""
        return self.tables.values()

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[PointPolyhedron, ...]:
        """Return the single contact of a point and a sharp polyhedron."""
        assert isinstance(first, Point)
        assert isinstance(second, Polyhedron)
        own = second.polytope
        return (cls(_Tables(face_table(own), (first.x, first.y, first.z), 0, own.size)),)

    @classmethod
    def of_vertices(cls, first: Polytope, second: Polytope) -> tuple[PointPolyhedron, ...]:
        """Return the contacts of all vertices of the first polyhedron."""
        return tuple(cls(tables) for tables in _all_tables(second, first))

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return _evaluate_reversed

    @property
    def bound(self) -> Callable[..., None]:
        """The height of the vertex over the faces."""
        return _bound_reversed

    @property
    def features(self) -> tuple[str, ...]:
        """Names of the pairs of features: each face of the polyhedron with the vertex of the other body."""
        return self.tables.features


def _all_tables(polytope: Polytope, other: Polytope) -> list[_Tables]:
    faces, vertices = face_table(polytope), vertex_table(other)
    size = max(polytope.size, other.size)
    return [_Tables(faces, vertices, i, size) for i in range(len(other.vertices))]
