"""A vertex, sharp or rounded to a sphere, against a swept polyhedron or segment of another body."""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import FEATURE, GAP, NORMAL, PAST_END, SIDE_A, SIDE_B
from nonsmooth.types import Floats

from ...shapes.polytope import Point
from ...vectors import Vector3, dot, minus, scaled, vector_at, write_vector
from .frames import vector_in_body, vector_in_world, write_tangent
from .polytope_tables import (
    ALONG,
    EDGE,
)
from .vertex_face import Nearest
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
