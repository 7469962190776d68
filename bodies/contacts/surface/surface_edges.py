"""Contact of convex edges of two bodies that cross each other; the bodies need not be convex."""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import FEATURE, GAP, NORMAL, PAST_END, POINT_A, POINT_B, POSITION, SIDE_A, SIDE_B
from nonsmooth.types import Floats

from ...blocks import put
from ..features.bounds import edges_bound
from ..features.frames import point_in_world, tangent_of, vector_in_body, vector_in_world, write_tangent
from ..features.vertex_face import CLOSED, DEEP
from ..features.writing import write_principal
from .surface_search import depth_inside
from .surface_vertex import ASTRAY

_PARALLEL_ROUNDED = 1e-5
"""Least sine of the angle between crossing edges if one is rounded.

Closer to parallel, the spheres about the ends of the edges hold the bodies.
"""
_NEAR_ENDS = 4.0
"""Least distance of overlapping edges' contact points from the ends of the edges, as a multiple of the overlap.

It applies if neither contact point is inside of the other body.  Closer to an end, the edges may pass each other
without an overlap of the bodies.
"""


@compiled
def edge_astray(frame: Floats, edge: Floats, at: int, sign: float, x: float, y: float, z: float) -> float:
    """Return the sine of the angle from the unit vector ``sign`` (x, y, z) to the range of normals of an edge.

    The normals of an edge lie between the normals of its two faces.  The result is not positive within this range.  The
    row of the edge begins at index ``at`` of ``edge``.
    """
    x, y, z = vector_in_body(frame, sign * x, sign * y, sign * z)
    one = x * edge[at + 7] + y * edge[at + 8] + z * edge[at + 9]
    return float(max(one, x * edge[at + 10] + y * edge[at + 11] + z * edge[at + 12]))


@compiled
def _depth(frame: Floats, surface: Floats, x: float, y: float, z: float) -> float:
    """Return the depth of a world point inside of a body [m]; 0 outside."""
    x, y, z = vector_in_body(frame, x - frame[POSITION], y - frame[POSITION + 1], z - frame[POSITION + 2])
    return float(depth_inside(surface, x, y, z))


def evaluate_edges(
    a: Floats,
    b: Floats,
    out: Floats,
    edge_a: Floats,
    edge_b: Floats,
    surface_a: Floats,
    surface_b: Floats,
    radius: float,
    size: float,
) -> None:
    """Write the geometry block of two edges, with their rows at index 0; other arguments as in :func:`write_edges`."""
    write_edges(a, b, out, edge_a, 0, edge_b, 0, surface_a, surface_b, radius, size)


def bound_of_edges(
    a: Floats,
    b: Floats,
    out: Floats,
    edge_a: Floats,
    edge_b: Floats,
    surface_a: Floats,
    surface_b: Floats,
    radius: float,
    size: float,
) -> None:
    """Write by how much the bodies must move before two edges touch [m]; arguments as in :func:`evaluate_edges`."""
    out[0] = edges_bound(a, b, edge_a, edge_b) - radius


@compiled
def write_edges(
    a: Floats,
    b: Floats,
    out: Floats,
    edge_a: Floats,
    at_a: int,
    edge_b: Floats,
    at_b: int,
    surface_a: Floats,
    surface_b: Floats,
    radius: float,
    size: float,
) -> None:
    """Write the geometry block of two edges at the nearest points of their lines; the second edge has a radius [m].

    The normal is perpendicular to both edges, with the sign for which it is nearer to the normals of the edges.  The
    contact is open if the normal is outside of the range of normals of an edge, or if a contact point is past the end
    of its edge.  An open contact has a positive gap, unless one of the points is inside of the other body.  The rows of
    the edges begin at the indices ``at_a`` and ``at_b``.
    """
    ax, ay, az = point_in_world(a, edge_a[at_a], edge_a[at_a + 1], edge_a[at_a + 2])
    bx, by, bz = point_in_world(b, edge_b[at_b], edge_b[at_b + 1], edge_b[at_b + 2])
    ex, ey, ez = vector_in_world(a, edge_a[at_a + 3], edge_a[at_a + 4], edge_a[at_a + 5])
    fx, fy, fz = vector_in_world(b, edge_b[at_b + 3], edge_b[at_b + 4], edge_b[at_b + 5])
    wx, wy, wz = bx - ax, by - ay, bz - az
    nx, ny, nz = ey * fz - ez * fy, ez * fx - ex * fz, ex * fy - ey * fx
    sine = math.sqrt(nx * nx + ny * ny + nz * nz)
    margin = CLOSED * size
    parallel = CLOSED if radius == 0.0 else _PARALLEL_ROUNDED
    s, t, over, past = 0.0, 0.0, 0.0, size * parallel
    if sine > 1e-3 * parallel:
        nx, ny, nz = nx / sine, ny / sine, nz / sine
        # s and t: distances of the nearest points along the lines, s = (w x f) . n / sine and t = (w x e) . n / sine,
        # with the unit vectors e and f of the lines and the vector w from the start of the first to that of the second
        s = (nx * (wy * fz - wz * fy) + ny * (wz * fx - wx * fz) + nz * (wx * fy - wy * fx)) / sine
        t = (nx * (wy * ez - wz * ey) + ny * (wz * ex - wx * ez) + nz * (wx * ey - wy * ex)) / sine
        over = max(max(-s, s - edge_a[at_a + 6]), max(-t, t - edge_b[at_b + 6]))
        past = max(over - margin, size * (parallel - sine))
    else:
        along = wx * ex + wy * ey + wz * ez
        nx, ny, nz = wx - along * ex, wy - along * ey, wz - along * ez
        apart = math.sqrt(nx * nx + ny * ny + nz * nz)
        if apart > 0.0:
            nx, ny, nz = nx / apart, ny / apart, nz / apart
        else:
            nx, ny, nz = tangent_of(ex, ey, ez)
    plus = max(edge_astray(a, edge_a, at_a, 1.0, nx, ny, nz), edge_astray(b, edge_b, at_b, -1.0, nx, ny, nz))
    minus = max(edge_astray(a, edge_a, at_a, -1.0, nx, ny, nz), edge_astray(b, edge_b, at_b, 1.0, nx, ny, nz))
    if minus < plus:
        nx, ny, nz, plus = -nx, -ny, -nz, minus
    # measured between the nearest points, so that the length of the edges does not multiply the error of the normal
    px, py, pz = wx + t * fx - s * ex, wy + t * fy - s * ey, wz + t * fz - s * ez
    gap = px * nx + py * ny + pz * nz
    depth = 0.0
    if past <= 0.0 and (gap < 0.0 or plus > ASTRAY):
        depth = _depth(b, surface_b, ax + s * ex, ay + s * ey, az + s * ez)
        depth = max(depth, _depth(a, surface_a, bx + t * fx, by + t * fy, bz + t * fz))
    past = max(past, size * (plus - ASTRAY))
    if gap < 0.0 and depth <= DEEP * size:
        past = max(past, over - _NEAR_ENDS * gap - margin)
    if past > 0.0:
        # the edges are not in contact; if one of the points is nevertheless deep inside of the other body, another
        # contact was missed, and the gap is the negative depth
        apart = abs(gap) - radius
        gap = -depth - radius if depth > DEEP * size else math.sqrt(apart * apart + past * past)
    else:
        gap -= radius
    out[GAP], out[FEATURE], out[PAST_END] = gap, 0.0, past
    put(out, NORMAL, nx, ny, nz)
    put(out, POINT_A, ax + s * ex, ay + s * ey, az + s * ez)
    for i in range(3):
        out[POINT_B + i] = out[POINT_A + i] + gap * out[NORMAL + i]
    write_tangent(a, out)
    write_principal(out, SIDE_A, ex, ey, ez, 0.0, 1.0, 1.0, 0.0)
    write_principal(out, SIDE_B, fx, fy, fz, 0.0, 1.0, 1.0, radius)
