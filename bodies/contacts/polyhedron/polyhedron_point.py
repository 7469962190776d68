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
from ...vectors import put, vector_at
from ..features.frames import point_in_world, tangent_of, vector_in_world
from ..features.polytope_tables import FACE, ConvexCore
from ..features.vertex_face import height_over, nearest_face
from ..features.writing import write_flat, write_round
from .polyhedron_sphere import PolyhedronSphere


@compiled
def _write_face_tangent(frame: Floats, out: Floats, faces: Floats, f: int) -> None:
    """Write the first tangent of a face, fixed to its body."""
    x, y, z = tangent_of(vector_at(faces, f))
    put(out, TANGENT, vector_in_world(frame, (x, y, z)))


def _evaluate(
    a: Floats,
    b: Floats,
    out: Floats,
    n_faces_a: float,
    faces_a: Floats,
    n_faces_b: float,
    faces_b: Floats,
    n_vertices_a: float,
    vertices_a: Floats,
    n_vertices_b: float,
    vertices_b: Floats,
    vertex: float,
    size: float,
) -> None:
    face, gap, past = nearest_face(
        a, b, n_faces_a, faces_a, n_vertices_b, vertices_b, vertex, n_faces_b, faces_b, n_vertices_a, vertices_a, size
    )
    f, v = FACE * int(face), 3 * int(vertex)
    out[GAP], out[FEATURE], out[PAST_END] = gap, face, past
    put(out, NORMAL, vector_in_world(a, vector_at(faces_a, f)))
    put(out, POINT_B, point_in_world(b, vector_at(vertices_b, v)))
    for i in range(3):
        out[POINT_A + i] = out[POINT_B + i] - gap * out[NORMAL + i]
    _write_face_tangent(a, out, faces_a, f)
    write_flat(out, SIDE_A)
    write_round(out, SIDE_B, 0.0)


def _evaluate_reversed(
    a: Floats,
    b: Floats,
    out: Floats,
    n_faces_a: float,
    faces_a: Floats,
    n_faces_b: float,
    faces_b: Floats,
    n_vertices_a: float,
    vertices_a: Floats,
    n_vertices_b: float,
    vertices_b: Floats,
    vertex: float,
    size: float,
) -> None:
    face, gap, past = nearest_face(
        b, a, n_faces_b, faces_b, n_vertices_a, vertices_a, vertex, n_faces_a, faces_a, n_vertices_b, vertices_b, size
    )
    f, v = FACE * int(face), 3 * int(vertex)
    out[GAP], out[FEATURE], out[PAST_END] = gap, face, past
    put(out, NORMAL, vector_in_world(b, (-faces_b[f], -faces_b[f + 1], -faces_b[f + 2])))
    put(out, POINT_A, point_in_world(a, vector_at(vertices_a, v)))
    for i in range(3):
        out[POINT_B + i] = out[POINT_A + i] + gap * out[NORMAL + i]
    _write_face_tangent(b, out, faces_b, f)
    write_round(out, SIDE_A, 0.0)
    write_flat(out, SIDE_B)


def _bound(
    a: Floats,
    b: Floats,
    out: Floats,
    n_faces_a: float,
    faces_a: Floats,
    n_faces_b: float,
    faces_b: Floats,
    n_vertices_a: float,
    vertices_a: Floats,
    n_vertices_b: float,
    vertices_b: Floats,
    vertex: float,
    size: float,
) -> None:
    v = 3 * int(vertex)
    out[0] = height_over(a, n_faces_a, faces_a, *point_in_world(b, vector_at(vertices_b, v)))


def _bound_reversed(
    a: Floats,
    b: Floats,
    out: Floats,
    n_faces_a: float,
    faces_a: Floats,
    n_faces_b: float,
    faces_b: Floats,
    n_vertices_a: float,
    vertices_a: Floats,
    n_vertices_b: float,
    vertices_b: Floats,
    vertex: float,
    size: float,
) -> None:
    v = 3 * int(vertex)
    out[0] = height_over(b, n_faces_b, faces_b, *point_in_world(a, vector_at(vertices_a, v)))


@dataclass(frozen=True)
class _Tables:
    """Faces and vertices of both bodies, with the number of one vertex of the body that does not have the faces."""

    cores: tuple[ConvexCore, ConvexCore]
    face_body: int
    vertex: int
    size: float

    def values(self) -> dict[str, Value]:
        one, two = self.cores
        return {**one.values("_a"), **two.values("_b"), "vertex": float(self.vertex), "size": self.size}

    @property
    def features(self) -> tuple[str, ...]:
        return tuple(f"face {i} and vertex {self.vertex}" for i in range(self.cores[self.face_body].n_faces))


@final
@dataclass(frozen=True)
class PolyhedronPoint(ContactKinematics):
    """A vertex of the second body against the faces of the first.

    Attributes
    ----------
    tables : _Tables
        Both bodies, and the vertex.
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
        cores = ConvexCore.of(own), ConvexCore.of_point(second.x, second.y, second.z)
        return (cls(_Tables(cores, 0, 0, own.size)),)

    @classmethod
    def of_vertices(cls, cores: tuple[ConvexCore, ConvexCore], size: float) -> tuple[PolyhedronPoint, ...]:
        """Return the contacts of all vertices of the second polyhedron; ``size`` is that of the larger body [m]."""
        return tuple(cls(_Tables(cores, 0, i, size)) for i in range(cores[1].n_vertices))

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
        Both bodies, and the vertex.
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
        cores = ConvexCore.of_point(first.x, first.y, first.z), ConvexCore.of(own)
        return (cls(_Tables(cores, 1, 0, own.size)),)

    @classmethod
    def of_vertices(cls, cores: tuple[ConvexCore, ConvexCore], size: float) -> tuple[PointPolyhedron, ...]:
        """Return the contacts of all vertices of the first polyhedron; ``size`` is that of the larger body [m]."""
        return tuple(cls(_Tables(cores, 1, i, size)) for i in range(cores[0].n_vertices))

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
