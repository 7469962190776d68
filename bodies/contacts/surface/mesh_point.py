"""Contacts of a vertex with a patch of a triangle mesh; the vertex may belong to the first or the second body."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import ClassVar, final

from nonsmooth.compiled import block_at, compiled
from nonsmooth.engine.memory.blocks import FEATURE, GAP, NORMAL, PAST_END, POINT_A, POINT_B, SIDE_A, SIDE_B
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import SharedNumbers, Value
from nonsmooth.types import Floats

from ...meshes.features import Features
from ...meshes.patches import patches_for_ball
from ...shapes.point import Point
from ...shapes.triangle_mesh import TriangleMesh
from ...vectors import put, vector_at
from ..features.frames import point_in_world, vector_in_world, write_tangent
from ..features.writing import gap_at_distance, write_flat, write_round
from .surface_search import FAR
from .surface_tables import FACE, FACES, Numbers, star_of, surface_numbers
from .surface_vertex import face_under

Corner = tuple[tuple[float, float, float], Numbers, str]
"""Place of a vertex [m], unit vectors along its edges, one after the other, and its name."""


def _evaluate(
    a: Floats,
    b: Floats,
    out: Floats,
    surface: Floats,
    patch: float,
    vertex_x: float,
    vertex_y: float,
    vertex_z: float,
    n_star: float,
    star: Floats,
) -> None:
    write_over_first(a, b, out, surface, patch, vertex_x, vertex_y, vertex_z, n_star, star, 0, FAR)


@compiled
def write_over_first(
    a: Floats,
    b: Floats,
    out: Floats,
    surface: Floats,
    patch: float,
    vertex_x: float,
    vertex_y: float,
    vertex_z: float,
    n_star: float,
    star: Floats,
    begin: int,
    reach: float,
) -> None:
    """Write the geometry block of a vertex of the second body over a patch of the first.

    The arguments are those of :func:`bodies.contacts.surface.surface_vertex.face_under`.
    """
    face, gap, past = face_under(
        a, b, surface, patch, (vertex_x, vertex_y, vertex_z), n_star, block_at(star, begin), reach
    )
    f = int(surface[FACES]) + FACE * face
    out[GAP], out[FEATURE], out[PAST_END] = gap, float(face), past
    put(out, NORMAL, vector_in_world(a, vector_at(surface, f)))
    put(out, POINT_B, point_in_world(b, (vertex_x, vertex_y, vertex_z)))
    for i in range(3):
        out[POINT_A + i] = out[POINT_B + i] - gap * out[NORMAL + i]
    write_tangent(a, out)
    write_flat(out, SIDE_A)
    write_round(out, SIDE_B, 0.0)


def _evaluate_reversed(
    a: Floats,
    b: Floats,
    out: Floats,
    surface: Floats,
    patch: float,
    vertex_x: float,
    vertex_y: float,
    vertex_z: float,
    n_star: float,
    star: Floats,
    radius: float,
) -> None:
    write_over_second(a, b, out, surface, patch, vertex_x, vertex_y, vertex_z, n_star, star, 0, FAR, radius)


@compiled
def write_over_second(
    a: Floats,
    b: Floats,
    out: Floats,
    surface: Floats,
    patch: float,
    vertex_x: float,
    vertex_y: float,
    vertex_z: float,
    n_star: float,
    star: Floats,
    begin: int,
    reach: float,
    radius: float,
) -> None:
    """Write the geometry block of a vertex of the first body, rounded by ``radius`` [m], over a patch of the second."""
    face, gap, past = face_under(
        b, a, surface, patch, (vertex_x, vertex_y, vertex_z), n_star, block_at(star, begin), reach
    )
    f = int(surface[FACES]) + FACE * face
    gap = gap_at_distance(gap, past, radius)
    out[GAP], out[FEATURE], out[PAST_END] = gap, float(face), past
    put(out, NORMAL, vector_in_world(b, (-surface[f], -surface[f + 1], -surface[f + 2])))
    put(out, POINT_A, point_in_world(a, (vertex_x, vertex_y, vertex_z)))
    for i in range(3):
        out[POINT_A + i] += radius * out[NORMAL + i]
        out[POINT_B + i] = out[POINT_A + i] + gap * out[NORMAL + i]
    write_tangent(a, out)
    write_round(out, SIDE_A, radius)
    write_flat(out, SIDE_B)


@dataclass(frozen=True)
class _Vertex:
    """A vertex with its edges, and a patch of the surface of the other body.

    Attributes
    ----------
    surface : SharedNumbers
        The surface (:mod:`bodies.contacts.surface.surface_tables`).
    n_faces : int
        Number of faces of the surface.
    patch : int
        Number of the patch.
    place : tuple of float
        The vertex in its body frame [m].
    star : tuple of float
        Unit vectors along its edges.
    name : str
        Name of the vertex.
    """

    surface: SharedNumbers
    n_faces: int
    patch: int
    place: tuple[float, float, float]
    star: Numbers
    name: str

    def values(self) -> dict[str, Value]:
        x, y, z = self.place
        return {
            "surface": self.surface,
            "patch": float(self.patch),
            "vertex_x": x,
            "vertex_y": y,
            "vertex_z": z,
            "n_star": float(len(self.star) // 3),
            "star": self.star,
        }

    @property
    def features(self) -> tuple[str, ...]:
        return tuple(f"face {i} and {self.name}" for i in range(self.n_faces))


@final
@dataclass(frozen=True)
class MeshPoint(ContactKinematics):
    """A vertex of the second body against a patch of the surface of the first.

    A vertex in an inner corner touches two faces at once, which are in different patches.

    Attributes
    ----------
    vertex : _Vertex
        The vertex and the patch.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (TriangleMesh, Point)
    vertex: _Vertex

    def parameters(self) -> dict[str, Value]:
        """Return the surface and the vertex."""
        return self.vertex.values()

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[MeshPoint, ...]:
        """Return the contacts of a point with the patches of a mesh."""
        assert isinstance(first, TriangleMesh)
        assert isinstance(second, Point)
        own, patches = first.features, patches_for_ball(first.features, 0.0)
        surface, place = surface_numbers(own, patches), (second.x, second.y, second.z)
        n_faces = len(own.planes)
        return tuple(cls(_Vertex(surface, n_faces, i, place, (), "point")) for i in range(patches.count))

    @classmethod
    def of_corners(cls, first: Features, second: Features) -> tuple[MeshPoint, ...]:
        """Return the contacts of all corners of the second surface with the patches of the first."""
        return tuple(cls(vertex) for vertex in _all(first, _corners(second), 0.0))

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return _evaluate

    @property
    def features(self) -> tuple[str, ...]:
        """Names of the pairs of features in contact: each face of the patch with the vertex."""
        return self.vertex.features


@final
@dataclass(frozen=True)
class PointMesh(ContactKinematics):
    """A sharp or rounded vertex of the first body against a patch of the surface of the second.

    Attributes
    ----------
    vertex : _Vertex
        The vertex and the patch.
    radius : float
        Radius of the sphere about the vertex [m]; 0 for a sharp vertex.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Point, TriangleMesh)
    vertex: _Vertex
    radius: float

    def parameters(self) -> dict[str, Value]:
        """Return the surface, the vertex and its radius."""
        return {**self.vertex.values(), "radius": self.radius}

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[PointMesh, ...]:
        """Return the contacts of a point with the patches of a mesh."""
        return tuple(cls(other.vertex, 0.0) for other in MeshPoint.between(second, first))

    @classmethod
    def of_corners(cls, first: Features, second: Features) -> tuple[PointMesh, ...]:
        """Return the contacts of all corners of the first surface with the patches of the second."""
        return cls.of_vertices(_corners(first), second, 0.0)

    @classmethod
    def of_vertices(cls, vertices: Iterable[Corner], second: Features, radius: float) -> tuple[PointMesh, ...]:
        """Return the contacts of vertices of the first body, with a radius [m], with the patches of the second."""
        return tuple(cls(vertex, radius) for vertex in _all(second, vertices, radius))

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return _evaluate_reversed

    @property
    def features(self) -> tuple[str, ...]:
        """Names of the pairs of features in contact: each face of the patch with the vertex."""
        return self.vertex.features


def _corners(features: Features) -> Iterator[Corner]:
    for i, (x, y, z) in enumerate(features.vertices[list(features.corners)].tolist()):
        yield (x, y, z), tuple(star_of(features, i)), f"vertex {i}"


def _all(surface: Features, vertices: Iterable[Corner], radius: float) -> Iterator[_Vertex]:
    patches = patches_for_ball(surface, radius)
    numbers, n_faces = surface_numbers(surface, patches), len(surface.planes)
    for place, star, name in vertices:
        for patch in range(patches.count):
            yield _Vertex(numbers, n_faces, patch, place, star, name)
