"""Contacts of a vertex with the faces of a polyhedron; the vertex may belong to the first or the second body."""

from __future__ import annotations

from typing import final

from nonsmooth.engine.memory.blocks import FEATURE, GAP, NORMAL, PAST_END, POINT_A, POINT_B, SIDE_A, SIDE_B, TANGENT
from nonsmooth.interfaces import ContactKinematics, FeaturePair, Shape
from nonsmooth.parameters import SharedNumbers, Value
from nonsmooth.types import Floats

from ...shapes.point import Point
from ...shapes.polyhedron import Polyhedron
from ...vectors import minus, scaled, vector_at, write_vector
from ..features.frames import point_in_world, tangent_of, vector_in_world
from ..features.polytope_tables import FACE, FACES, core_numbers, faces_of, point_numbers, vertex_at
from ..features.vertex_face import height_over, nearest_face
from ..features.writing import write_flat, write_round
from .polyhedron_sphere import ball_over_polyhedron


def evaluate_vertex_over_faces(
    a: Floats, b: Floats, out: Floats, swap: float, core: Floats, own: Floats, vertex: float, size: float
) -> None:
    """Write the geometry block of a vertex of the core ``own`` over the faces of another core.

    The vertex belongs to the first body if ``swap`` is 1, else to the second.  ``size`` is the size of the larger body
    [m].  The cores are those of :func:`bodies.contacts.features.polytope_tables.core_numbers`.
    """
    own_frame, other = (a, b) if swap == 1.0 else (b, a)
    near, far = (POINT_A, POINT_B) if swap == 1.0 else (POINT_B, POINT_A)
    place, sign = point_in_world(own_frame, vector_at(own, vertex_at(own, vertex))), 1.0 - 2.0 * swap
    face, gap, past = nearest_face(other, own_frame, core, own, place, size)
    normal = vector_at(core, int(core[FACES]) + FACE * int(face))
    out[GAP], out[FEATURE], out[PAST_END] = gap, face, past
    write_vector(out, NORMAL, vector_in_world(other, scaled(sign, normal)))
    write_vector(out, near, place)
    write_vector(out, far, minus(place, scaled(sign * gap, vector_at(out, NORMAL))))
    # the tangent, like the normal, is fixed to the body of the face
    write_vector(out, TANGENT, vector_in_world(other, tangent_of(normal)))
    write_flat(out, SIDE_B if swap == 1.0 else SIDE_A)
    write_round(out, SIDE_A if swap == 1.0 else SIDE_B, 0.0)


def bound_of_vertex_over_faces(
    a: Floats, b: Floats, out: Floats, swap: float, core: Floats, own: Floats, vertex: float, size: float
) -> None:
    """Write the largest height of a vertex over the planes of the faces [m], a lower bound of its distance."""
    own_frame, other = (a, b) if swap == 1.0 else (b, a)
    place = point_in_world(own_frame, vector_at(own, vertex_at(own, vertex)))
    out[0] = height_over(other, *faces_of(core), place)


def vertex_over_faces(
    swap: int, core: SharedNumbers, n_faces: int, own: SharedNumbers, vertex: int, size: float
) -> FeaturePair:
    """Return the contact of a vertex with faces; arguments as in :func:`evaluate_vertex_over_faces`."""
    values: dict[str, Value] = {"swap": float(swap), "core": core, "own": own}
    values |= {"vertex": float(vertex), "size": size}
    names = tuple(f"face {i} and vertex {vertex}" for i in range(n_faces))
    return FeaturePair(evaluate_vertex_over_faces, values, names, bound=bound_of_vertex_over_faces)


@final
class PolyhedronPoint(ContactKinematics):
    """The contact of a polyhedron and a point; over a rounded polyhedron, the point is a ball of radius 0."""

    pair = Polyhedron, Point

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FeaturePair, ...]:
        """Return the single contact of a polyhedron and a point."""
        assert isinstance(first, Polyhedron)
        assert isinstance(second, Point)
        place, core = (second.x, second.y, second.z), first.core
        if first.rounding > 0.0:
            return (ball_over_polyhedron(first, place, 0.0),)
        return (vertex_over_faces(0, core_numbers(core), len(core.planes), point_numbers(place), 0, core.size),)
