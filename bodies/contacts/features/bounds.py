"""How far two bodies must move before a vertex and a face, or two edges, can touch.

A contact that cannot close before the bodies have moved by the margin of its pair needs no place among the active ones.
A bound is at most the sum of the largest displacements of a point of either body until the features touch:

1. The distance of two features decreases by no more than their points move.
2. Two convex edges touch only along a common normal. The normals of an edge are an arc between those of its faces. If
   the arcs of both edges are an angle apart, the bodies must turn by that angle first. A body that turns by an angle
   displaces one of its points by at least half of the length of any of its edges times the angle, about any centre.
"""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled

from ...vectors import Vector3, cross, dot, minus, norm, plus_scaled, scaled, vector_at
from .edge_vertex import INTO_FIRST, INTO_SECOND, LENGTH, Edge, direction_of, start_of
from .frames import vector_in_world


@compiled
def squared_distance_of_segments(w: Vector3, e: Vector3, p: float, f: Vector3, q: float) -> float:
    """Return the squared distance of two segments [m^2]: from 0 along e, length p, and from w along f, length q.

    e and f are unit vectors; w, p, q are in m.  The place s at which the lines are nearest is clamped to its segment,
    then the nearest t to it, then the nearest s to this t: C. Ericson, Real-Time Collision Detection (2005), 5.1.9.
    """
    across, along_e, along_f = dot(e, f), dot(w, e), dot(w, f)
    square = 1.0 - across * across
    s = min(max((along_e - across * along_f) / square, 0.0), p) if square > 0.0 else 0.0
    t = min(max(s * across - along_f, 0.0), q)
    s = min(max(along_e + t * across, 0.0), p)
    apart = minus(plus_scaled(w, t, f), scaled(s, e))
    return float(dot(apart, apart))


@compiled
def _from_arc(n: Vector3, along: Vector3, inward: tuple[Vector3, Vector3], ends: tuple[Vector3, Vector3]) -> float:
    """Return a lower bound of the angle between the unit vector ``n`` and the normals of an edge [rad].

    ``along`` is the unit vector of the edge. ``inward`` are the unit vectors into its faces, ``ends`` the normals of
    these.
    """
    if max(dot(n, inward[0]), dot(n, inward[1])) <= 0.0:
        # n is above the arc: the sine of its angle with the plane of the arc
        return float(abs(dot(n, along)))
    # a chord is shorter than the angle
    return float(min(norm(minus(n, ends[0])), norm(minus(n, ends[1]))))


@compiled
def _inward(edge: Edge, sign: float) -> tuple[Vector3, Vector3]:
    """Return ``sign`` times the unit vectors from an edge into its two faces, in world axes."""
    first, second = scaled(sign, vector_at(edge.row, INTO_FIRST)), scaled(sign, vector_at(edge.row, INTO_SECOND))
    return vector_in_world(edge.frame, first), vector_in_world(edge.frame, second)


@compiled
def _between_arcs(a: Edge, b: Edge) -> float:
    """Return a lower bound of the angle between the normals of one edge and the opposite normals of the other [rad]."""
    # the vectors into the faces of the second body are reversed, for its opposite normals
    e, f, into_a, into_b = direction_of(a), direction_of(b), _inward(a, 1.0), _inward(b, -1.0)
    ends_a = cross(e, into_a[0]), cross(into_a[1], e)
    ends_b = cross(f, into_b[0]), cross(into_b[1], f)
    for sign in (1.0, -1.0):
        n = scaled(sign, cross(e, f))
        # the arcs cross: the common normal belongs to both
        if max(max(dot(n, into_a[0]), dot(n, into_a[1])), max(dot(n, into_b[0]), dot(n, into_b[1]))) <= 0.0:
            return 0.0
    found = min(
        min(_from_arc(ends_a[0], f, into_b, ends_b), _from_arc(ends_a[1], f, into_b, ends_b)),
        min(_from_arc(ends_b[0], e, into_a, ends_a), _from_arc(ends_b[1], e, into_a, ends_a)),
    )
    return float(found)


@compiled
def edges_bound(a: Edge, b: Edge) -> float:
    """Return by how much the bodies must move before two edges touch [m].

    Of an edge without faces, the segment of a capsule, only the distance counts.
    """
    w, p, q = minus(start_of(b), start_of(a)), a.row[LENGTH], b.row[LENGTH]
    distance = math.sqrt(squared_distance_of_segments(w, direction_of(a), p, direction_of(b), q))
    return float(max(distance, 0.5 * min(p, q) * _between_arcs(a, b)))
