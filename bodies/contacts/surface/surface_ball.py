"""A ball of one body against the nearest feature of a patch of another body's surface, sharp or rounded."""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import FEATURE, GAP, NORMAL, PAST_END, POINT_A, POINT_B, SIDE_A, SIDE_B
from nonsmooth.types import Floats

from ...vectors import Vector3, cross, divided, dot, minus, scaled, vector_at, write_vector
from ..features.edge_crossing import CONE_MARGIN
from ..features.edge_row import ALONG
from ..features.ends import END, NEAR, OPEN, gap_past_end, past_star
from ..features.frames import point_in_body, point_in_world, tangent_of, vector_in_world, write_tangent
from ..features.writing import write_flat, write_principal, write_round
from .overlap_corners import corner_of_overlap, part_of_overlap
from .surface_search import ON_EDGE, ON_FACE, Found, distance_from_ends, edge_at, face_at, nearest_in_patch
from .surface_tables import IS_CONVEX, N_EDGES, N_FACES, N_PATCHES, SIZE, SWEEP


@compiled
def out_of_surface(frame: Floats, surface: Floats, found: Found, past: float, point: Vector3) -> Vector3:
    """Return the unit normal, in world axes, at a surface's nearest point to a point of the body frame.

    On a face it is the normal of the face; else it points from the nearest point to ``point``.  If both are one point
    of an edge or a corner, it is a vector across an edge.  ``found`` is the result of :func:`nearest_in_patch`, and
    ``past`` the distance past the end of the feature [m].
    """
    distance, _, kind, number, px, py, pz = found
    if kind == ON_FACE and (past <= 0.0 or distance == 0.0):
        n = vector_at(surface, face_at(surface, number))
    elif distance == 0.0:
        n = tangent_of(vector_at(surface, edge_at(surface, number if kind == ON_EDGE else 0) + ALONG))
    else:
        n = divided(minus(point, (px, py, pz)), distance)
    return vector_in_world(frame, n)


@compiled
def write_feature(frame: Floats, out: Floats, side: int, surface: Floats, kind: int, number: int) -> None:
    """Write the number of a face, an edge or a corner (faces first, then edges, corners), and its curvature matrices.

    About an edge, a rounded surface is a cylinder, about a corner a sphere.  The geometry block ``out`` must already
    hold the normal and the first tangent.
    """
    out[FEATURE] = float(number)
    if kind == ON_FACE:
        write_flat(out, side)
    elif kind == ON_EDGE:
        along = vector_in_world(frame, vector_at(surface, edge_at(surface, number) + ALONG))
        write_principal(out, side, along, 0.0, 1.0, 1.0, surface[SWEEP])
        out[FEATURE] += surface[N_FACES]
    else:
        write_round(out, side, surface[SWEEP])
        out[FEATURE] += surface[N_FACES] + surface[N_EDGES]


@compiled
def _is_along_side(own: Floats, other: Floats, surface: Floats, found: Found, n_star: float, star: Floats) -> bool:
    """Return whether the nearest feature of a surface is the side of a capsule, nearly parallel to the corner's own.

    The corner is the end of a segment, with the single unit vector ``star`` in the frame ``own``.  The largest sine of
    the angle is ``CONE_MARGIN``.
    """
    if n_star != 1.0 or surface[N_FACES] > 0.0 or found[2] != ON_EDGE:
        return False
    along = vector_in_world(other, vector_at(surface, edge_at(surface, 0) + ALONG))
    across = cross(along, vector_in_world(own, vector_at(star, 0)))
    return bool(dot(across, across) <= CONE_MARGIN * CONE_MARGIN)


@compiled
def write_ball(
    a: Floats,
    b: Floats,
    out: Floats,
    swap: float,
    surface: Floats,
    found: Found,
    n: Vector3,
    past: float,
    shared: float,
    center: Vector3,
    radius: float,
    is_convex: bool,
) -> None:
    """Write the geometry block of a ball of one body and the nearest feature of the other body's surface.

    Parameters
    ----------
    a, b, out : Floats
        Frame blocks of both bodies, and the geometry block.
    swap : float
        1 if the ball belongs to the first body, else 0.
    surface, found : Floats, tuple
        Surface of the other body, and its nearest feature (:func:`nearest_in_patch`).
    n : Vector3
        Unit normal out of the surface, in the world.
    past : float
        Distance past the end of the contact [m].
    shared : float
        If positive, another contact has the same two corners: length by which this one is past its end [m].
    center, radius : Vector3, float
        Centre of the ball in the world, and its radius [m].
    is_convex : bool
        Whether both bodies are convex.
    """
    gap = found[0] - surface[SWEEP] - radius
    gap = math.hypot(gap, OPEN * shared) if shared > 0.0 else gap_past_end(gap, past, is_convex)
    sign = 1.0 - 2.0 * swap
    near, far = (POINT_A, POINT_B) if swap == 1.0 else (POINT_B, POINT_A)
    out[GAP], out[PAST_END] = gap, past
    write_vector(out, NORMAL, scaled(sign, n))
    write_vector(out, near, minus(center, scaled(radius, n)))
    write_vector(out, far, minus(vector_at(out, near), scaled(gap, n)))
    write_tangent(a, out)
    write_feature(b if swap == 1.0 else a, out, SIDE_B if swap == 1.0 else SIDE_A, surface, found[2], found[3])
    write_round(out, SIDE_A if swap == 1.0 else SIDE_B, radius)


@compiled
def past_patch(surface: Floats, found: Found) -> float:
    """Return the distance past the end of a patch's nearest feature [m]; one patch is all, and has no end."""
    return found[1] if surface[N_PATCHES] > 1.0 else -surface[SIZE]


@compiled
def write_round_corner(
    a: Floats,
    b: Floats,
    out: Floats,
    swap: float,
    surface: Floats,
    patch: float,
    own: Floats,
    place: Vector3,
    n_star: float,
    star: Floats,
    size: float,
    reach: float,
) -> None:
    """Write the geometry block of a corner, with its radius, against the nearest feature of a patch.

    If two corners touch, only the contact of the second body's corner closes; that of the first body's corner is open.

    Parameters
    ----------
    a, b, out : Floats
        Frame blocks and geometry block.
    swap : float
        1 if the corner belongs to the first body, else 0.
    surface, patch : Floats, float
        Surface of the other body, and number of the patch.
    own : Floats
        Surface of the body with the corner.
    place, n_star, star : Vector3, float, Floats
        The corner [m], the number of its edges, and unit vectors along them, in the axes of its body.
    size : float
        Size of the larger body [m].
    reach : float
        Distance of the cores up to which features are searched [m].
    """
    own_frame, other = (a, b) if swap == 1.0 else (b, a)
    radius, center = own[SWEEP], point_in_world(own_frame, place)
    point = point_in_body(other, center)
    found = nearest_in_patch(surface, patch, point, reach)
    distance, past = found[0], past_patch(surface, found)
    n, within = out_of_surface(other, surface, found, past, point), distance_from_ends(surface, found)
    gap = distance - surface[SWEEP] - radius
    # over a face the contact does not end at the corner: an edge over the face touches with both ends, also if it tilts
    past_own = past_star(own_frame, star, n_star if found[2] != ON_FACE else 0.0, distance, n, size)
    # bodies on springs overlap: then the corners of the overlap touch, else the nearest features
    part = part_of_overlap(-gap, size)
    if distance > 0.0 and part > 0.0:
        normal = scaled(1.0 - 2.0 * swap, n)
        are_flush, past_corner, ends = corner_of_overlap(a, b, swap, surface, own, place, n_star, star, normal, size)
        if are_flush:
            past_own, within = (1.0 - part) * past_own + part * past_corner, ends
        elif _is_along_side(own_frame, other, surface, found, n_star, star):
            # a side along a side touches with both ends, also if it tilts
            past_own = (1.0 - part) * past_own - part * size
    if gap > NEAR * size:
        past_own = min(past_own, -END * size)
    shared = END * size - within if swap == 1.0 else -math.inf
    past, is_convex = max(max(past, past_own), shared), surface[IS_CONVEX] * own[IS_CONVEX] > 0.0
    write_ball(a, b, out, swap, surface, found, n, past, shared, center, radius, is_convex)
