"""Contact of an edge of the second body that crosses the side of a cylinder or a cone."""

from __future__ import annotations

import math

from nonsmooth.compiled import block_at, compiled
from nonsmooth.engine.memory.blocks import SIDE_A
from nonsmooth.types import Floats

from ...shapes.frustum import COS, LOW, SIDE, SIN, SWEEP
from ...vectors import plus, plus_scaled
from ..features.polytope_tables import LENGTH, edge_at
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
    core: Floats,
    is_convex: bool,
    size: float,
) -> None:
    """Write the geometry block of a frustum's side and an edge, rounded by ``radius`` [m], that crosses the side.

    ``edge`` is the row of the edge.  If the body with the edge is convex, it has a ``core``.
    """
    axes, center = axes_in_world(a, frustum), center_in_world(a, frustum)
    start, d = edge_in_frustum(b, edge, axes, center)
    (vx, vy, vz), (dx, dy, dz) = start, d
    cosine, sine = frustum[COS], frustum[SIN]
    reach = cosine * frustum[0] + sine * frustum[LOW]
    # e: direction from the axis, with a normal of the side perpendicular to the edge: cosine (d . e) + sine d_z = 0
    across = math.sqrt(dx * dx + dy * dy)
    if across > 0.0:
        fx, fy = dx / across, dy / across
        ratio = -sine * dz / (cosine * across)
    else:
        fx, fy, ratio = 1.0, 0.0, 0.0 if sine == 0.0 else -math.copysign(2.0, sine * dz)
    part = min(max(ratio, -1.0), 1.0)
    other = math.sqrt(1.0 - part * part)
    gap, ex, ey = -math.inf, 1.0, 0.0
    for sign in (-1.0, 1.0):
        gx, gy = part * fx - sign * other * fy, part * fy + sign * other * fx
        found = cosine * (gx * vx + gy * vy) + sine * vz - reach
        if found > gap:
            gap, ex, ey = found, gx, gy
    # place on the edge that lies in the direction e from the axis
    crossing = dy * ex - dx * ey
    s = 0.5 * edge[LENGTH]
    if abs(crossing) > 1e-6:
        s = -(vy * ex - vx * ey) / crossing
    p, n = plus_scaled(start, s, d), (cosine * ex, cosine * ey, sine)
    away = ex * p[0] + ey * p[1] - gap * cosine
    up = cosine * (p[2] - gap * n[2] - frustum[LOW]) - sine * (away - frustum[0])
    over = max(max(-s, s - edge[LENGTH]), max(-up, up - frustum[SIDE]))
    if abs(ratio) > 1.0 or abs(crossing) <= 1e-6:
        # no normal of the side is perpendicular to the edge, or the edge is parallel to the side: no valid crossing
        over = size
    steep, off_cone = abs(crossing), off_cone_of_edge(b, edge, axes, n)
    past = past_end(a, b, frustum, core, is_convex, gap, over, steep, off_cone, size)
    point = plus(center, rotated(axes, plus_scaled(p, -gap, n)))
    write_crossing(a, b, out, frustum, axes, edge, radius, is_convex, gap, past, steep, n, point)
    outward = rotated(axes, (ex, ey, 0.0))
    write_part(out, SIDE_A, FLANK, (axes[2], axes[5], axes[8]), outward, cosine, max(away, 0.0))
    write_sweep(out, SIDE_A, frustum[SWEEP])


def evaluate_edge_across_side(
    a: Floats, b: Floats, out: Floats, frustum: Floats, core: Floats, edge: float, radius: float, size: float
) -> None:
    """Write the geometry block of a frustum's side and an edge of a core, by number, that crosses the side.

    ``radius`` is the radius about the core [m].
    """
    row = block_at(core, edge_at(core, edge))
    write_edge_across_side(a, b, out, frustum, row, radius, core, True, size)
