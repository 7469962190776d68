"""Contact of an edge of the second body that crosses the side of a cylinder or a cone."""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import SIDE_A
from nonsmooth.types import Floats

from ...shapes.frustum import COS, LOW, LOW_RADIUS, SIDE, SIN, SWEEP
from ...vectors import plus, plus_scaled
from ..features.edge_crossing import PARALLEL
from ..features.edge_row import LENGTH
from ..features.writing import write_sweep
from ..smooth.smooth_core import axes_in_world, rotated
from .frustum import FLANK, center_in_world, write_part
from .frustum_writing import edge_in_frustum, off_cone_of_edge, past_end, write_crossing


@compiled
def write_edge_across_side(
    a: Floats,
    b: Floats,
    out: Floats,
    frustum: Floats,
    edge: Floats,
    radius: float,
    is_convex: bool,
    size: float,
) -> None:
    """Write the geometry block of a frustum's side and an edge, rounded by ``radius`` [m], that crosses the side.

    The contact normal is a normal of the side and perpendicular to the edge.  Two such normals exist, mirror images in
    the plane along edge and axis; bodies apart are separated along the one with the larger gap.  ``edge`` is the row of
    the edge (:data:`bodies.contacts.surface.surface_tables.EDGE`), ``is_convex`` tells whether its body is convex,
    and ``size`` is the size of the bodies [m].
    """
    axes, center = axes_in_world(a, frustum), center_in_world(a, frustum)
    start, d = edge_in_frustum(b, edge, axes, center)
    (vx, vy, vz), (dx, dy, dz) = start, d
    cosine, sine = frustum[COS], frustum[SIN]
    # distance of the side's tangent planes from the centre
    support = cosine * frustum[LOW_RADIUS] + sine * frustum[LOW]
    # n = (cosine e, sine), with the direction e from the axis. It is perpendicular to the edge if
    # cosine (d . e) + sine d_z = 0: the cosine of the angle from f, the edge's direction seen along the axis, to e
    across = math.sqrt(dx * dx + dy * dy)
    if across > 0.0:
        fx, fy = dx / across, dy / across
        e_cosine = -sine * dz / (cosine * across)
    else:
        # an edge parallel to the axis is perpendicular to all normals of a cylinder, to none of a cone
        fx, fy, e_cosine = 1.0, 0.0, 0.0 if sine == 0.0 else -math.copysign(2.0, sine * dz)
    e_f = min(max(e_cosine, -1.0), 1.0)
    e_g = math.sqrt(1.0 - e_f * e_f)
    gap, ex, ey = -math.inf, 1.0, 0.0
    for sign in (-1.0, 1.0):
        gx, gy = e_f * fx - sign * e_g * fy, e_f * fy + sign * e_g * fx
        height = cosine * (gx * vx + gy * vy) + sine * vz - support
        if height > gap:
            gap, ex, ey = height, gx, gy
    # s: distance along the edge of its point in the direction e from the axis; the middle if the edge lies in a plane
    # through the axis
    crossing = dy * ex - dx * ey
    s = 0.5 * edge[LENGTH]
    if abs(crossing) > PARALLEL:
        s = -(vy * ex - vx * ey) / crossing
    p, n = plus_scaled(start, s, d), (cosine * ex, cosine * ey, sine)
    # coordinates of the contact point on the side: distance from the axis, and along the side from the lower rim
    away = ex * p[0] + ey * p[1] - gap * cosine
    up = cosine * (p[2] - gap * n[2] - frustum[LOW]) - sine * (away - frustum[LOW_RADIUS])
    past_ends = max(max(-s, s - edge[LENGTH]), max(-up, up - frustum[SIDE]))
    if abs(e_cosine) > 1.0 or abs(crossing) <= PARALLEL:
        # no normal of the side is perpendicular to the edge, or the edge is parallel to the side: no valid crossing
        past_ends = size
    crossing_sine, off_cone = abs(crossing), off_cone_of_edge(b, edge, axes, n)
    past = past_end(past_ends, crossing_sine, off_cone, size)
    point = plus(center, rotated(axes, plus_scaled(p, -gap, n)))
    write_crossing(a, b, out, frustum, axes, edge, radius, is_convex, gap, past, crossing_sine, n, point)
    outward = rotated(axes, (ex, ey, 0.0))
    write_part(out, SIDE_A, FLANK, (axes[2], axes[5], axes[8]), outward, cosine, max(away, 0.0))
    write_sweep(out, SIDE_A, frustum[SWEEP])
