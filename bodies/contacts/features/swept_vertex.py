"""A vertex, sharp or rounded to a sphere, against a swept polyhedron or segment of another body."""

from __future__ import annotations

import math
from collections.abc import Iterator

from nonsmooth.compiled import block_at, compiled
from nonsmooth.engine.memory.blocks import FEATURE, GAP, NORMAL, PAST_END, SIDE_A, SIDE_B
from nonsmooth.interfaces import FeaturePair
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...shapes.polyhedron import SweptPolytope
from ...shapes.polytope import Point
from ...vectors import Vector3, cross, dot, minus, scaled, vector_at, write_vector
from .edge_crossing import CONE_MARGIN
from .frames import point_in_body, point_in_world, vector_in_body, vector_in_world, write_tangent
from .overlap_corners import common_direction, part_of_overlap, vertex_past_corner
from .polytope_tables import (
    ALONG,
    EDGE,
    EDGES,
    N_FACES,
    N_STAR,
    STAR,
    SWEEP,
    core_numbers,
    edges_of,
    faces_of,
    part_names,
    vertex_at,
)
from .vertex_face import Nearest, nearest_of_core
from .writing import write_flat, write_principal, write_round

END = 3e-10
"""Distance from a vertex, along an edge, at which the contact of the edge ends; relative to the size of the bodies.

The contact of the vertex ends at twice this distance.  Both contacts are valid between the two distances, so that a
point that slides from the edge to the vertex always has a contact.  If two bodies are pressed into each other with
flush faces, the corners of their overlap replace this rule (:mod:`bodies.contacts.features.overlap_corners`).
"""
OPEN = 100.0
"""Gap of a contact that another contact replaces, over its distance past the end of an edge; large, so it is open."""
NEAR = 1e-6
"""Gap, relative to the size of the bodies, above which the contact of a vertex stays valid wherever its point is.

The sphere about the vertex is a part of its body, so that its gap is always an upper bound of the gap of the bodies.
"""


@compiled
def past_star(frame: Floats, star: Floats, n_star: float, distance: float, n: Vector3, size: float) -> float:
    """Return the distance of a contact past a vertex [m], less the tolerance ``2 END size``; negative if it is valid.

    The nearest point of the other body's core is at ``distance`` [m] from the vertex, against the normal n.
    The distance past the vertex is the largest coordinate of this point along an edge of the vertex, measured from
    the vertex.  If it is positive, this edge is nearer to the point than the vertex.  For a vertex inside of the other
    core the result is negative.
    """
    n, past = vector_in_body(frame, n), -size
    for i in range(int(n_star) if distance > 0.0 else 0):
        past = max(past, -distance * dot(n, vector_at(star, 3 * i)))
    return past - 2.0 * END * size


@compiled
def ended_gap(gap: float, past: float, size: float) -> tuple[float, float]:
    """Return gap and distance past the vertex [m], as the geometry block stores them.

    A contact with a gap above ``NEAR`` times the size is always valid.  If ``past`` is positive, a smaller gap that is
    not negative is replaced by hypot(gap, past).  A negative gap is kept: at this depth another contact takes over.
    """
    if gap > NEAR * size:
        return gap, min(past, -END * size)
    if past > 0.0 and gap >= 0.0:
        return math.sqrt(gap * gap + past * past), past
    return gap, past


@compiled
def write_vertex_over(
    a: Floats,
    b: Floats,
    out: Floats,
    swap: float,
    center: Point,
    radius: float,
    found: Nearest,
    past: float,
    n_faces: float,
    n_edges: float,
    edges: Floats,
    sweep: float,
    size: float,
) -> None:
    """Write the geometry block of a vertex, with its radius, against the nearest feature ``found`` of the other core.

    The vertex belongs to the first body if ``swap`` is 1, else to the second.  If the nearest feature is a vertex, too,
    the two bodies have two contacts for the same two vertices.  Only the contact of the second body's vertex can then
    close; the contact of the first body's vertex is written as open.  ``past`` is the result of :func:`past_star` [m].
    """
    other = b if swap == 1.0 else a
    number, distance, nx, ny, nz, within = found
    n = vector_in_world(other, (nx, ny, nz))
    shared = END * size - within if swap == 1.0 else -math.inf
    gap, past = ended_gap(distance - sweep - radius, max(past, shared), size)
    if shared > 0.0:
        # near the end of the other body's edge another contact takes over: open this one by a large gap
        gap, past = math.hypot(distance - sweep - radius, OPEN * shared), max(past, shared)
    sign = 1.0 - 2.0 * swap
    near, far = 10 - int(3.0 * swap), 7 + int(3.0 * swap)
    out[GAP], out[FEATURE], out[PAST_END] = gap, number, past
    write_vector(out, NORMAL, scaled(sign, n))
    write_vector(out, near, minus(center, scaled(radius, n)))
    write_vector(out, far, minus(vector_at(out, near), scaled(gap, n)))
    write_tangent(a, out)
    write_swept(other, out, SIDE_B if swap == 1.0 else SIDE_A, number, n_faces, n_edges, edges, sweep)
    write_round(out, SIDE_A if swap == 1.0 else SIDE_B, radius)


@compiled
def _is_along_side(own: Floats, other: Floats, core: Floats, number: int, n_star: float, star: Floats) -> bool:
    """Return whether the nearest feature of a core is the side of a capsule, nearly parallel to the vertex's own.

    The vertex is the end of a segment, with the single unit vector ``star`` in the frame ``own``.  The largest sine of
    the angle is ``CONE_MARGIN``.
    """
    if n_star != 1.0 or core[N_FACES] > 0.0 or number > 0:
        return False
    along = vector_in_world(other, vector_at(core, int(core[EDGES]) + ALONG))
    across = cross(along, vector_in_world(own, vector_at(star, 0)))
    return bool(dot(across, across) <= CONE_MARGIN * CONE_MARGIN)


@compiled
def write_vertex(
    a: Floats,
    b: Floats,
    out: Floats,
    swap: float,
    core: Floats,
    own_faces: tuple[float, Floats],
    place: Vector3,
    n_star: float,
    star: Floats,
    radius: float,
    size: float,
) -> None:
    """Write the geometry block of a vertex, with its radius, against the nearest feature of a swept core.

    If two vertices touch, only the contact of the second body's vertex closes; that of the first body's vertex is open.

    Parameters
    ----------
    a, b, out : Floats
        Frame blocks and geometry block.
    swap : float
        1 if the vertex belongs to the first body, else 0.
    core : Floats
        Core of the other body (:func:`bodies.contacts.features.polytope_tables.core_numbers`).
    own_faces : tuple
        Number and rows of the faces of the core to which the vertex belongs; none if its body is not convex.
    place : tuple of float
        The vertex in its body frame [m].
    n_star, star : float and Floats
        Unit vectors along the edges that begin at the vertex, in the body frame.
    radius : float
        Radius about the vertex [m].
    size : float
        Size of the larger body [m].
    """
    own_frame, other, sweep = (a, b, core[SWEEP]) if swap == 1.0 else (b, a, core[SWEEP])
    p = point_in_world(own_frame, place)
    point = point_in_body(other, p)
    number, distance, x, y, z, within = nearest_of_core(core, point)
    n = vector_in_world(other, (x, y, z))
    # over a face the contact does not end at the vertex: an edge over the face touches with both ends, also if it tilts
    past = past_star(own_frame, star, n_star if number >= int(core[N_FACES]) else 0.0, distance, n, size)
    # bodies on springs overlap: then the corners of the overlap touch, else the nearest features
    part = part_of_overlap(radius + sweep - distance, size)
    if distance > 0.0 and part > 0.0:
        # the contact normal and the common direction u point from the first body to the second
        sign = 1.0 - 2.0 * swap
        first, second = (own_faces, faces_of(core)) if swap == 1.0 else (faces_of(core), own_faces)
        u = common_direction(a, b, *first, *second, scaled(sign, n))
        if dot(u, u) > 0.0:
            past_corner, within = vertex_past_corner(
                own_frame, other, swap == 1.0, scaled(sign, u), core, n_star, star, point, size
            )
            past = (1.0 - part) * past + part * past_corner
        elif _is_along_side(own_frame, other, core, number, n_star, star):
            # a side along a side touches with both ends, also if it tilts
            past = (1.0 - part) * past - part * size
    found = number, distance, x, y, z, within
    write_vertex_over(a, b, out, swap, p, radius, found, past, core[N_FACES], *edges_of(core), sweep, size)


def evaluate_vertex_over_swept(
    a: Floats, b: Floats, out: Floats, swap: float, core: Floats, own: Floats, vertex: float, size: float
) -> None:
    """Write the geometry block of a vertex of a core over another core; arguments as in :func:`write_vertex`."""
    v = vertex_at(own, vertex)
    place, star = vector_at(own, v), block_at(own, int(own[v + STAR]))
    write_vertex(a, b, out, swap, core, faces_of(own), place, own[v + N_STAR], star, own[SWEEP], size)


def bound_of_vertex(
    a: Floats, b: Floats, out: Floats, swap: float, core: Floats, own: Floats, vertex: float, size: float
) -> None:
    """Write the distance of a vertex from a core, less both radii [m]."""
    own_frame, other = (a, b) if swap == 1.0 else (b, a)
    place = point_in_world(own_frame, vector_at(own, vertex_at(own, vertex)))
    out[0] = nearest_of_core(core, point_in_body(other, place))[1] - core[SWEEP] - own[SWEEP]


def size_of_both(first: SweptPolytope, second: SweptPolytope) -> float:
    """Return the size of the larger of two shapes [m]."""
    return max(shape.core.size + 2.0 * shape.sweep for shape in (first, second))


def vertices_over_swept(first: SweptPolytope, second: SweptPolytope) -> Iterator[FeaturePair]:
    """Yield the contacts of all vertices of the second shape, then those of the first, with the other's core."""
    size = size_of_both(first, second)
    cores = core_numbers(first.core, first.sweep), core_numbers(second.core, second.sweep)
    for swap, own, other in ((0, second, first), (1, first, second)):
        values: dict[str, Value] = {"swap": float(swap), "core": cores[swap], "own": cores[1 - swap], "size": size}
        for i in range(len(own.core.vertices)):
            pairs = ((f"vertex {i}", part) if swap else (part, f"vertex {i}") for part in part_names(other.core))
            names = tuple(f"{one} and {two}" for one, two in pairs)
            numbers = {**values, "vertex": float(i)}
            yield FeaturePair(evaluate_vertex_over_swept, numbers, names, bound=bound_of_vertex)


@compiled
def write_swept(
    frame: Floats, out: Floats, side: int, number: int, n_faces: float, n_edges: float, edges: Floats, radius: float
) -> None:
    """Write the slide and turn matrices (curvature) of the swept surface at a feature of its core.

    Over a face the surface is flat, about an edge a cylinder, about a vertex a sphere.  ``number`` is the index of the
    feature: faces first, then edges, then vertices.  The caller has already written normal and first tangent to
    ``out``.
    """
    edge = number - int(n_faces)
    if edge < 0:
        write_flat(out, side)
    elif edge < int(n_edges):
        along = vector_in_world(frame, vector_at(edges, EDGE * edge + ALONG))
        write_principal(out, side, along, 0.0, 1.0, 1.0, radius)
    else:
        write_round(out, side, radius)
