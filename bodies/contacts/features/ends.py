"""Where the contact of a feature ends: tolerances, distances past the end, and the gap there."""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...vectors import Vector3, opposite
from .edge_vertex import Vertex, steepest
from .frames import vector_in_body

REACH = 1e-9
"""Length by which features are extended at their ends, relative to the size of the bodies.

So round-off does not open the contact of features that are aligned.
"""
CLOSED = 1e-7
"""Distance beyond a face's border up to which a vertex touches the face, relative to the size of the bodies.

Equal faces that are almost aligned then have contacts of their vertices.  Edges that cross touch up to the same
distance past their ends.
"""
END = 3e-10
"""Distance from a corner, along an edge, at which the contact of the edge ends; relative to the size of the bodies.

The contact of the corner ends at twice this distance.  Both contacts are valid between the two distances, so that a
point that slides from the edge to the corner always has a contact.  If two bodies are pressed into each other with
flush faces, the corners of their overlap replace this rule (:mod:`bodies.contacts.surface.overlap_corners`).
"""
OPEN = 100.0
"""Gap of a contact that another contact replaces, over its distance past the end of an edge; large, so it is open."""
NEAR = 1e-6
"""Gap, relative to the size of the bodies, above which the contact of a corner stays valid wherever its point is.

The ball about the corner is a part of its body, so that its gap is always an upper bound of the gap of the bodies.
"""


@compiled
def past_vertex(frame: Floats, vertex: Vertex, distance: float, n: Vector3, size: float) -> float:
    """Return the distance of a contact past a vertex [m], less the tolerance ``2 END size``; negative if it is valid.

    The nearest point of the other body's core is at ``distance`` [m] from the vertex, against the normal n [world
    axes].  The distance past the vertex is the largest coordinate of this point along an edge of the vertex, measured
    from the vertex.  If it is positive, this edge is nearer to the point than the vertex.  For a vertex inside of the
    other core the result is negative.
    """
    past = -size
    if distance > 0.0:
        past = max(past, distance * steepest(vertex, opposite(vector_in_body(frame, n))))
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
def gap_past_end(gap: float, past: float, is_convex: bool) -> float:
    """Return the gap of a contact, which ends at ``past`` = 0 [m].

    A contact past its end is not valid, so that it must be open: a gap that is not negative becomes hypot(gap, past).
    A negative gap of convex bodies is kept.  It is the depth of a spring at which another contact of the bodies takes
    over.  For other bodies it would be an overlap: the separation of the bodies does not decide whether they touch.
    """
    return math.hypot(gap, past) if past > 0.0 and (gap >= 0.0 or not is_convex) else gap


@compiled
def gap_at_distance(gap: float, past: float, radius: float) -> float:
    """Return the gap of a rounded surface [m], at the distance ``radius`` from its core, from the gap of the core.

    ``gap`` is the gap of the core, ``past`` the distance past the boundary of its feature [m].  Past the boundary, a
    ``gap`` that is not negative is hypot(gap along the normal, past).  The radius is subtracted from the gap along the
    normal only.  The result does not approach 0 with ``past`` if the surfaces overlap along the normal: a foot that
    comes over the border of a face below its height would else strike the face.
    """
    if past <= 0.0 or gap < 0.0:
        return gap - radius
    apart = math.sqrt(max(gap * gap - past * past, 0.0))
    return math.hypot(apart - radius, past)
