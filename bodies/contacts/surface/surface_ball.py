"""A corner of one body, a vertex or a ball, against a patch of another body's surface, sharp or rounded."""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import FEATURE, SIDE_A, SIDE_B
from nonsmooth.types import Floats

from ...vectors import Vector3, cross, divided, dot, minus, opposite, plus_scaled, vector_at
from ..features.edge_crossing import CONE_MARGIN
from ..features.edge_vertex import ALONG, Edge, direction_of
from ..features.ends import END, NEAR, OPEN, gap_past_end, past_vertex
from ..features.frames import (
    point_in_world,
    point_seen_from,
    tangent_of,
    vector_in_world,
)
from ..features.writing import write_contact, write_flat, write_principal, write_round
from .overlap_corners import Over, corner_of_overlap, part_of_overlap
from .surface_search import Found, distance_from_ends, nearest_in_patch
from .surface_tables import (
    N_EDGES,
    N_FACES,
    N_PATCHES,
    ON_EDGE,
    ON_FACE,
    SIZE,
    SWEEP,
    Solid,
    are_convex,
    edge_at,
    normal_of,
)
from .surface_vertex import face_under, past_depth


@compiled
def out_of_surface(solid: Solid, found: Found, past: float, point: Vector3) -> Vector3:
    """Return the unit normal, in world axes, at a surface's nearest point to a point of the body frame.

    On a face it is the normal of the face; else it points from the nearest point to ``point``.  If both are one point
    of an edge or a corner, it is a vector across an edge.  ``past`` is the distance past the end of the feature [m].
    """
    if found.kind == ON_FACE and (past <= 0.0 or found.distance == 0.0):
        n = normal_of(solid.surface, found.number)
    elif found.distance == 0.0:
        n = tangent_of(vector_at(edge_at(solid.surface, found.number if found.kind == ON_EDGE else 0), ALONG))
    else:
        n = divided(minus(point, found.nearest), found.distance)
    return vector_in_world(solid.frame, n)


@compiled
def write_feature(out: Floats, side: int, solid: Solid, kind: int, number: int) -> None:
    """Write the number of a face, an edge or a corner (faces first, then edges, corners), and its curvature matrices.

    About an edge, a rounded surface is a cylinder, about a corner a sphere.  The geometry block ``out`` must already
    hold the normal and the first tangent.
    """
    surface = solid.surface
    out[FEATURE] = float(number)
    if kind == ON_FACE:
        write_flat(out, side)
    elif kind == ON_EDGE:
        along = direction_of(Edge(solid.frame, edge_at(surface, number)))
        write_principal(out, side, along, 0.0, 1.0, 1.0, surface[SWEEP])
        out[FEATURE] += surface[N_FACES]
    else:
        write_round(out, side, surface[SWEEP])
        out[FEATURE] += surface[N_FACES] + surface[N_EDGES]


@compiled
def _is_along_side(over: Over, found: Found) -> bool:
    """Return whether the nearest feature of a patch is the side of a capsule, nearly parallel to the corner's own side.

    The corner is the end of a segment.  The largest sine of the angle is ``CONE_MARGIN``.
    """
    solid, vertex = over.solid, over.vertex
    if vertex.n_star != 1.0 or solid.surface[N_FACES] > 0.0 or found.kind != ON_EDGE:
        return False
    along = direction_of(Edge(solid.frame, edge_at(solid.surface, 0)))
    across = cross(along, vector_in_world(over.other.frame, vector_at(vertex.star, 0)))
    return bool(dot(across, across) <= CONE_MARGIN * CONE_MARGIN)


@compiled
def _write_over(out: Floats, over: Over, n: Vector3, gap: float, past: float, kind: int, number: int) -> None:
    """Write the geometry block of a corner, with its radius, over a feature of the other body.

    Parameters
    ----------
    out, over : Floats, Over
        The geometry block, and the corner.
    n : Vector3
        Unit normal out of the surface, in world axes.
    gap, past : float
        Gap and distance past the end of the contact [m].
    kind, number : int
        Feature of the surface.
    """
    frame, own_frame, radius = over.solid.frame, over.other.frame, over.other.surface[SWEEP]
    point = plus_scaled(point_in_world(own_frame, over.vertex.place), -radius, n)
    a, normal = (own_frame, opposite(n)) if over.is_first else (frame, n)
    write_contact(a, out, gap, past, 0.0, normal, point, not over.is_first)
    write_feature(out, SIDE_B if over.is_first else SIDE_A, over.solid, kind, number)
    write_round(out, SIDE_A if over.is_first else SIDE_B, radius)


@compiled
def write_sharp_corner(out: Floats, over: Over, reach: float) -> None:
    """Write the geometry block of a corner over a patch of sharp bodies; it touches faces only.

    Bodies on springs overlap: then the corners of the overlap touch, unless another face is less deep.  ``reach`` is
    the distance up to which faces are searched [m].
    """
    solid, frame, vertex = over.solid, over.other.frame, over.vertex
    face, gap, past = face_under(solid, frame, over.patch, vertex, reach, are_convex(solid, over.other))
    n, part = vector_in_world(solid.frame, normal_of(solid.surface, face)), part_of_overlap(-gap, over.size)
    if part > 0.0:
        point = point_seen_from(solid.frame, frame, vertex.place)
        is_known, past_corner, _ = corner_of_overlap(over, n)
        is_real = past <= 0.0 or past_depth(solid, frame, vertex, (point, point), -gap, point) <= 0.0
        if is_known and is_real:
            past = (1.0 - part) * past + part * past_corner
    _write_over(out, over, n, gap, past, ON_FACE, face)


@compiled
def write_round_corner(out: Floats, over: Over, reach: float) -> None:
    """Write the geometry block of a corner against the nearest feature of a patch, if one of the bodies is rounded.

    If two corners touch, only the contact of the second body's corner closes; that of the first body's corner is open.
    ``reach`` is the distance of the cores up to which features are searched [m].
    """
    solid, other, vertex, size = over.solid, over.other, over.vertex, over.size
    surface, point = solid.surface, point_seen_from(solid.frame, other.frame, vertex.place)
    found = nearest_in_patch(surface, over.patch, point, reach)
    # one patch is the whole surface, which has no end
    past = found.past if surface[N_PATCHES] > 1.0 else -surface[SIZE]
    n, within = out_of_surface(solid, found, past, point), distance_from_ends(surface, found)
    gap = found.distance - surface[SWEEP] - other.surface[SWEEP]
    # over a face the contact does not end at the corner: an edge over the face touches with both ends, also if it tilts
    past_own = past_vertex(other.frame, vertex, found.distance if found.kind != ON_FACE else 0.0, n, size)
    # bodies on springs overlap: then the corners of the overlap touch, else the nearest features
    part = part_of_overlap(-gap, size)
    if found.distance > 0.0 and part > 0.0:
        are_flush, past_corner, ends = corner_of_overlap(over, n)
        if are_flush:
            past_own, within = (1.0 - part) * past_own + part * past_corner, ends
        elif _is_along_side(over, found):
            # a side along a side touches with both ends, also if it tilts
            past_own = (1.0 - part) * past_own - part * size
    if gap > NEAR * size:
        past_own = min(past_own, -END * size)
    # if positive, the contact of the second body's corner has the same two corners
    shared = END * size - within if over.is_first else -math.inf
    past = max(max(past, past_own), shared)
    gap = math.hypot(gap, OPEN * shared) if shared > 0.0 else gap_past_end(gap, past, are_convex(solid, other))
    _write_over(out, over, n, gap, past, found.kind, found.number)
