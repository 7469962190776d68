"""What the contacts of a frustum with an edge share: the edge's row, how it faces the frustum, and what is written.

The edge belongs to the second body, a polyhedron or, with a radius about it, a rounded one or a capsule.
"""

from __future__ import annotations

import math

from bodies.blocks import put
from bodies.contacts.features.curvature import write_principal
from bodies.contacts.features.frames import point_in_world, vector_in_world
from bodies.contacts.features.polytope_tables import ALONG, INTO_FIRST, INTO_SECOND, START
from bodies.contacts.features.tangents import write_tangent
from bodies.contacts.features.vertex_face import DEEP, REACH, height_over
from bodies.contacts.frustum.frustum import nearest_part
from bodies.contacts.smooth.smooth_core import Axes, back, forth
from bodies.shapes.frustum import FEET, SWEEP, Frustum
from bodies.shapes.swept import SweptPolytope
from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import FEATURE, GAP, NORMAL, PAST_END, POINT_A, POINT_B, SIDE_B
from nonsmooth.types import Floats

PARALLEL = 0.01
"""Sine of the angle between an edge and what it crosses below which it does not; then ends and vertices hold."""
_ASTRAY = 0.25
"""Sine of the angle by which the normal may leave the normals of a body: what may soon close is followed."""
_INSIDE = 4.0
"""Where no point is found inside, what overlaps does so only where it crosses so many depths away from its ends."""


def size_of_both(first: Frustum, second: SweptPolytope) -> float:
    """Return the size of the larger of the two [m]."""
    return max(second.core.size + 2.0 * second.sweep, 2.0 * first.extent)


@compiled
def edge_in_frustum(
    b: Floats, edge: Floats, axes: Axes, cx: float, cy: float, cz: float
) -> tuple[float, float, float, float, float, float]:
    """Return the first end from the frustum's centre and the direction of an edge, in the axes of the frustum."""
    x, y, z = point_in_world(b, edge[START], edge[START + 1], edge[START + 2])
    x, y, z = back(axes, x - cx, y - cy, z - cz)
    dx, dy, dz = vector_in_world(b, edge[ALONG], edge[ALONG + 1], edge[ALONG + 2])
    dx, dy, dz = back(axes, dx, dy, dz)
    return x, y, z, dx, dy, dz


@compiled
def astray_of_edge(b: Floats, edge: Floats, axes: Axes, nx: float, ny: float, nz: float) -> float:
    """Return the sine of the angle by which a normal, in the axes of the frustum, leaves those against the edge."""
    ux, uy, uz = vector_in_world(b, edge[INTO_FIRST], edge[INTO_FIRST + 1], edge[INTO_FIRST + 2])
    vx, vy, vz = vector_in_world(b, edge[INTO_SECOND], edge[INTO_SECOND + 1], edge[INTO_SECOND + 2])
    nx, ny, nz = forth(axes, nx, ny, nz)
    return float(max(-nx * ux - ny * uy - nz * uz, -nx * vx - ny * vy - nz * vz))


@compiled
def past_end(gap: float, over: float, sine: float, astray: float, overlap: float, size: float) -> float:
    """Return how far a crossing is past its ends, by the way over them, the sine of the crossing and the normal.

    The gap is that of the cores: without a radius, what overlaps is so deep as wide where it crosses.  Where a point of
    either is inside of the other, by a negative ``overlap``, it holds up to its ends.
    """
    past = max(over - REACH * size, size * max(PARALLEL - sine, astray - _ASTRAY))
    if gap < 0.0 and overlap >= -DEEP * size:
        past = max(past, over - _INSIDE * gap - REACH * size)
    return past


@compiled
def overlap_at(
    b: Floats,
    frustum: Floats,
    axes: Axes,
    n_faces: float,
    faces: Floats,
    radius: float,
    over: float,
    px: float,
    py: float,
    pz: float,
    qx: float,
    qy: float,
    qz: float,
    x: float,
    y: float,
    z: float,
) -> float:
    """Return how deep the points of a crossing are in the other bodies, negative, or 0 if they are past an end.

    p is the frustum's point, in the world, q the edge's in the axes of the frustum, whose centre is (x, y, z).
    """
    if over > 0.0:
        return 0.0
    outside, _, _, _ = nearest_part(frustum, qz, math.sqrt(qx * qx + qy * qy))
    outside -= radius + frustum[SWEEP]
    if n_faces > 0.0:
        outside = min(outside, height_over(b, n_faces, faces, px + x, py + y, pz + z))
    # rims are set back by the height of the feet over faces only
    return float(min(outside + 2.0 * frustum[FEET], 0.0))


@compiled
def write_crossing(
    a: Floats,
    b: Floats,
    out: Floats,
    frustum: Floats,
    axes: Axes,
    edge: Floats,
    radius: float,
    distance: float,
    past: float,
    sine: float,
    nx: float,
    ny: float,
    nz: float,
    px: float,
    py: float,
    pz: float,
    overlap: float,
    size: float,
) -> None:
    """Write all but the matrices of the frustum, by the distance of the cores; p is the frustum's, in the world.

    Past its ends a crossing runs faster than the bodies, by the sine of its angle: so much less counts of its way.
    """
    sweep = frustum[SWEEP]
    gap = distance - radius - sweep
    if past > 0.0:
        # what overlaps is no contact of this crossing, but a sign that another one was passed
        gap = max(-abs(gap), overlap) if overlap < -DEEP * size else math.hypot(gap, max(PARALLEL, sine) * past)
    out[GAP], out[FEATURE], out[PAST_END] = gap, 0.0, past
    out[NORMAL], out[NORMAL + 1], out[NORMAL + 2] = forth(axes, nx, ny, nz)
    put(out, POINT_A, px + sweep * out[NORMAL], py + sweep * out[NORMAL + 1], pz + sweep * out[NORMAL + 2])
    for i in range(3):
        out[POINT_B + i] = out[POINT_A + i] + gap * out[NORMAL + i]
    write_tangent(a, out)
    ex, ey, ez = vector_in_world(b, edge[ALONG], edge[ALONG + 1], edge[ALONG + 2])
    write_principal(out, SIDE_B, ex, ey, ez, 0.0, 1.0, 1.0, radius)
