"""Corrects the contact of a frustum with a crossing edge of a mesh, if the overlap is not real or a face is nearer."""

from __future__ import annotations

import math
from collections.abc import Iterator

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import GAP, NORMAL, PAST_END, POINT_A, POINT_B, POSITION
from nonsmooth.parameters import SharedNumbers
from nonsmooth.types import Floats

from ...meshes.features import Features
from ...meshes.patches import patches_for_body
from ...shapes.frustum import COS, HIGH, LOW, SIDE, SIN, SWEEP
from ..features.frames import across, vector_in_body
from ..features.polytope_tables import INTO_FIRST, INTO_SECOND, LENGTH
from ..features.vertex_face import DEEP
from ..frustum.frustum import center_in_world, nearest_part
from ..frustum.frustum_writing import edge_in_frustum
from ..smooth.smooth_core import Axes, axes_in_world
from ..surface.surface_search import THROUGH, depth_inside
from ..surface.surface_tables import Numbers, edge_row, surface_numbers

_ASTRAY = 1e-6
"""Sine of the largest angle between a contact normal and the edge's fan of normals.  If it is larger, a face is nearer.
"""


@compiled
def _pierced(
    b: Floats, frustum: Floats, edge: Floats, axes: Axes, cx: float, cy: float, cz: float, size: float
) -> float:
    """Return the depth of an edge inside of a frustum [m]; 0 if the edge does not go through the frustum.

    It is the depth of the point of the edge that is farthest inside of the frustum's side, between its two caps.  For a
    disc, which has no side, it is the distance of the crossing from the rim, or of an end of the edge from the disc's
    plane, if this is smaller.  ``axes`` and (cx, cy, cz) are the axes and the centre of the frustum in the world, b is
    the block of the edge's body.  A depth of less than ``THROUGH`` times ``size`` [m] counts as 0.
    """
    x, y, z, dx, dy, dz = edge_in_frustum(b, edge, axes, cx, cy, cz)
    least, low, high = THROUGH * size, 0.0, edge[LENGTH]
    if frustum[SIDE] > 0.0:
        under, over = frustum[LOW] + 2.0 * least - z, frustum[HIGH] - 2.0 * least - z
        if abs(dz) > 0.0:
            low, high = max(low, min(under / dz, over / dz)), min(high, max(under / dz, over / dz))
        square, slope = dx * dx + dy * dy, dz * frustum[SIN] / frustum[COS]
        s = 0.5 * edge[LENGTH]
        if square > slope * slope:
            # at the least gap, the distance from the axis and the radius of the side change at the same rate
            s = -(x * dx + y * dy) / square
            nearest = math.hypot(x + s * dx, y + s * dy)
            s -= slope * nearest / math.sqrt(square * (square - slope * slope))
        elif slope != 0.0:
            s = -math.copysign(size, slope)
        s = min(max(s, low), high)
        outside, _, _, _ = nearest_part(frustum, z + s * dz, math.hypot(x + s * dx, y + s * dy))
        return -outside if low <= high and outside < -least else 0.0
    under = frustum[LOW] - z
    ends = -under, -under + dz * edge[LENGTH]
    if ends[0] * ends[1] >= 0.0:
        return 0.0
    away = math.hypot(x + under / dz * dx, y + under / dz * dy)
    depth = min(frustum[0] - away, min(abs(ends[0]), abs(ends[1])))
    return depth if depth > least else 0.0


@compiled
def judge_crossing(
    a: Floats, b: Floats, out: Floats, frustum: Floats, edge: Floats, surface: Floats, size: float
) -> None:
    """Correct the geometry block of a frustum and a crossing edge of a mesh by three rules.

    First: if the contact normal is outside of the edge's fan of normals, a face is nearer, and has its own contact with
    the frustum.  The contact of the edge is then opened, except at a deep overlap.

    Second: if the gap is positive but the edge goes through the frustum, no contact reports this overlap.  The gap is
    then set to minus the depth of the edge.

    Third: if the gap shows a deep overlap but neither contact point is inside of the other body, the bodies do not
    overlap there.  This contact is then opened.
    """
    x, y, z = vector_in_body(b, out[NORMAL], out[NORMAL + 1], out[NORMAL + 2])
    astray = max(
        -x * edge[INTO_FIRST] - y * edge[INTO_FIRST + 1] - z * edge[INTO_FIRST + 2],
        -x * edge[INTO_SECOND] - y * edge[INTO_SECOND + 1] - z * edge[INTO_SECOND + 2],
    )
    beyond = size * (astray - _ASTRAY)
    if out[PAST_END] <= 0.0 < beyond and out[GAP] >= -DEEP * size:
        apart = math.sqrt(out[GAP] * out[GAP] + beyond * beyond)
        out[GAP], out[PAST_END] = apart, beyond
        for i in range(3):
            out[POINT_B + i] = out[POINT_A + i] + apart * out[NORMAL + i]
    gap, past = out[GAP], out[PAST_END]
    axes = axes_in_world(a, frustum)
    cx, cy, cz = center_in_world(a, frustum)
    if gap > 0.0:
        depth = _pierced(b, frustum, edge, axes, cx, cy, cz, size)
        if depth > 0.0:
            out[GAP], out[PAST_END] = -depth, max(past, DEEP * size)
            for i in range(3):
                out[POINT_B + i] = out[POINT_A + i] - depth * out[NORMAL + i]
        return
    if past > 0.0 or gap >= -DEEP * size:
        return
    x, y, z = vector_in_body(
        b, out[POINT_A] - b[POSITION], out[POINT_A + 1] - b[POSITION + 1], out[POINT_A + 2] - b[POSITION + 2]
    )
    if depth_inside(surface, x, y, z) > 0.0:
        return
    along, away, _, _, _ = across(
        out[POINT_B] - cx, out[POINT_B + 1] - cy, out[POINT_B + 2] - cz, axes[2], axes[5], axes[8]
    )
    outside, _, _, _ = nearest_part(frustum, along, away)
    if outside < frustum[SWEEP]:
        return
    apart = math.sqrt(2.0) * gap
    out[GAP], out[PAST_END] = -apart, -gap
    for i in range(3):
        out[POINT_B + i] = out[POINT_A + i] - apart * out[NORMAL + i]


def edges_of(second: Features) -> Iterator[tuple[Numbers, SharedNumbers, str]]:
    """Yield row, surface and name of each convex edge of a mesh."""
    surface = surface_numbers(second, patches_for_body(second, 0.0))
    for i in range(len(second.edges)):
        yield edge_row(second, i), surface, f"edge {i}"
