"""Corrects the contact of a frustum with a crossing edge of a mesh, if the overlap is not real or a face is nearer."""

from __future__ import annotations

import math
from collections.abc import Iterator

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import GAP, NORMAL, PAST_END, POINT_A, POINT_B
from nonsmooth.parameters import SharedNumbers
from nonsmooth.types import Floats

from ...meshes.features import Features
from ...meshes.patches import patches_for_body
from ...shapes.frustum import SWEEP
from ...vectors import Vector3
from ..features.edge_crossing import edge_astray
from ..features.frames import across, point_in_body
from ..features.vertex_face import CLOSED
from ..frustum.frustum import center_in_world, nearest_part
from ..smooth.smooth_core import Axes, axes_in_world
from ..surface.surface_search import depth_inside
from ..surface.surface_tables import Numbers, edge_row, surface_numbers

_ASTRAY = 1e-6
"""Sine of the largest angle between a contact normal and the edge's fan of normals.  If it is larger, a face is nearer.
"""


@compiled
def _is_aside(b: Floats, out: Floats, frustum: Floats, axes: Axes, place: Vector3, surface: Floats) -> bool:
    """Return whether both contact points of a crossing are outside of the other body.

    ``place`` is the centre of the frustum in the world, ``axes`` are its axes.
    """
    x, y, z = point_in_body(b, (out[POINT_A], out[POINT_A + 1], out[POINT_A + 2]))
    if depth_inside(surface, x, y, z) > 0.0:
        return False
    x, y, z = out[POINT_B] - place[0], out[POINT_B + 1] - place[1], out[POINT_B + 2] - place[2]
    along, away, _ = across((x, y, z), (axes[2], axes[5], axes[8]))
    outside, _, _, _ = nearest_part(frustum, along, away)
    return bool(outside >= frustum[SWEEP])


@compiled
def judge_crossing(
    a: Floats, b: Floats, out: Floats, frustum: Floats, edge: Floats, surface: Floats, size: float
) -> None:
    """Open the contact of a frustum and a crossing edge of a mesh in two cases.

    If the contact normal is outside of the edge's fan of normals, a face is nearer, and has its own contact with the
    frustum.  If the gap shows an overlap but neither contact point is inside of the other body, the bodies do not
    overlap there.  Overlaps within the margin ``CLOSED`` are judged by the normal, deeper ones by the points.
    """
    gap, beyond = out[GAP], 0.0
    if out[PAST_END] > 0.0:
        return
    if gap >= -CLOSED * size:
        astray = edge_astray(b, edge, 0, -1.0, out[NORMAL], out[NORMAL + 1], out[NORMAL + 2])
        beyond = size * (astray - _ASTRAY)
    elif _is_aside(b, out, frustum, axes_in_world(a, frustum), center_in_world(a, frustum), surface):
        beyond = -gap
    if beyond > 0.0:
        gap = math.hypot(gap, beyond)
        out[GAP], out[PAST_END] = gap, beyond
        for i in range(3):
            out[POINT_B + i] = out[POINT_A + i] + gap * out[NORMAL + i]


def edges_of(second: Features) -> Iterator[tuple[Numbers, SharedNumbers, str]]:
    """Yield row, surface and name of each convex edge of a mesh."""
    surface = surface_numbers(second, patches_for_body(second, 0.0))
    for i in range(len(second.edges)):
        yield edge_row(second, i), surface, f"edge {i}"
