"""Contacts of a vertex with a patch of a triangle mesh; the vertex may belong to the first or the second body."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import final

from nonsmooth.compiled import block_at, compiled
from nonsmooth.engine.memory.blocks import FEATURE, GAP, NORMAL, PAST_END, POINT_A, POINT_B, SIDE_A, SIDE_B
from nonsmooth.interfaces import ContactKinematics, FeaturePair, Shape
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...meshes.features import Features
from ...meshes.patches import patches_for_ball
from ...shapes.point import Point
from ...shapes.triangle_mesh import TriangleMesh
from ...vectors import Vector3, minus, scaled, vector_at, write_vector
from ..features.frames import point_in_world, vector_in_world, write_tangent
from ..features.writing import gap_at_distance, write_flat, write_round
from .surface_search import FAR, face_at
from .surface_tables import Numbers, surface_numbers
from .surface_vertex import face_under

Corner = tuple[tuple[float, float, float], Numbers, str]
"""Place of a vertex [m], unit vectors along its edges, one after the other, and its name."""


def evaluate_vertex_over_surface(
    a: Floats, b: Floats, out: Floats, swap: float, surface: Floats, patch: float, vertex: Floats, radius: float
) -> None:
    """Write the geometry block of a vertex: place [m], number of its edges, and the unit vectors along them.

    The other arguments are those of :func:`write_over`.
    """
    write_over(a, b, out, swap, surface, patch, vector_at(vertex, 0), vertex[3], block_at(vertex, 4), FAR, radius)


@compiled
def write_over(
    a: Floats,
    b: Floats,
    out: Floats,
    swap: float,
    surface: Floats,
    patch: float,
    place: Vector3,
    n_star: float,
    star: Floats,
    reach: float,
    radius: float,
) -> None:
    """Write the geometry block of a vertex, rounded by ``radius`` [m], over a patch of the other body's surface.

    The vertex belongs to the first body if ``swap`` is 1, else to the second.  The other arguments are those of
    :func:`bodies.contacts.surface.surface_vertex.face_under`.
    """
    own, other = (a, b) if swap == 1.0 else (b, a)
    near, far = (POINT_A, POINT_B) if swap == 1.0 else (POINT_B, POINT_A)
    face, gap, past = face_under(other, own, surface, patch, place, n_star, star, reach)
    if radius > 0.0:
        gap = gap_at_distance(gap, past, radius)
    sign = 1.0 - 2.0 * swap
    normal = vector_in_world(other, scaled(sign, vector_at(surface, face_at(surface, face))))
    out[GAP], out[FEATURE], out[PAST_END] = gap, float(face), past
    write_vector(out, NORMAL, normal)
    write_vector(out, near, minus(point_in_world(own, place), scaled(sign * radius, normal)))
    write_vector(out, far, minus(vector_at(out, near), scaled(sign * gap, normal)))
    write_tangent(a, out)
    write_round(out, SIDE_A if swap == 1.0 else SIDE_B, radius)
    write_flat(out, SIDE_B if swap == 1.0 else SIDE_A)


def vertices_over_surface(
    swap: float, vertices: Iterable[Corner], surface: Features, radius: float
) -> Iterator[FeaturePair]:
    """Yield the contacts of vertices, rounded by a radius [m], with all patches of the other body's surface.

    The vertices belong to the first body if ``swap`` is 1, else to the second.
    """
    patches = patches_for_ball(surface, radius)
    values: dict[str, Value] = {"swap": swap, "surface": surface_numbers(surface, patches, 0.0), "radius": radius}
    for place, star, name in vertices:
        names = tuple(f"face {i} and {name}" for i in range(len(surface.planes)))
        vertex = *place, float(len(star) // 3), *star
        for patch in range(patches.count):
            numbers = {**values, "patch": float(patch), "vertex": vertex}
            yield FeaturePair(evaluate_vertex_over_surface, numbers, names)


@final
class MeshPoint(ContactKinematics):
    """Contacts of a point with the patches of a mesh; in an inner corner, a point touches two faces at once."""

    pair = TriangleMesh, Point

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FeaturePair, ...]:
        """Return one contact for each patch."""
        assert isinstance(first, TriangleMesh)
        assert isinstance(second, Point)
        point = (second.x, second.y, second.z), (), "point"
        return tuple(vertices_over_surface(0.0, [point], first.features, 0.0))
