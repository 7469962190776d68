"""What the contacts of a frustum with the edges of a mesh share: whether what seems to overlap does."""

from __future__ import annotations

import math
from collections.abc import Iterator

from bodies.contacts.across import across
from bodies.contacts.frames import vector_in_body
from bodies.contacts.frustum import axis_in_world, center_in_world, nearest_part
from bodies.contacts.surface_search import depth_inside
from bodies.contacts.surface_tables import Numbers, edge_row, surface_numbers
from bodies.contacts.vertex_face import DEEP
from bodies.meshes.features import Features
from bodies.meshes.patches import patches_for_body
from nonsmooth.compiled import compiled
from nonsmooth.types import Floats


@compiled
def judge_overlap(a: Floats, b: Floats, out: Floats, frustum: Floats, surface: Floats, size: float) -> None:
    """Open a crossing, whose block is written, that overlaps where neither of its points is inside of the other body.

    Seen from the crossing alone the bodies may as well lie on the far sides of each other.
    """
    gap, past = out[0], out[30]
    if past > 0.0 or gap >= -DEEP * size:
        return
    x, y, z = vector_in_body(b, out[7] - b[0], out[8] - b[1], out[9] - b[2])
    if depth_inside(surface, x, y, z) > 0.0:
        return
    ax, ay, az = axis_in_world(a, frustum)
    cx, cy, cz = center_in_world(a, frustum)
    along, away, _, _, _ = across(out[10] - cx, out[11] - cy, out[12] - cz, ax, ay, az)
    outside, _, _, _ = nearest_part(frustum, along, away)
    if outside < 0.0:
        return
    apart = math.sqrt(2.0) * gap
    out[0], out[30] = -apart, -gap
    for i in range(3):
        out[10 + i] = out[7 + i] - apart * out[1 + i]


def edges_of(second: Features) -> Iterator[tuple[Numbers, Numbers, str]]:
    """Yield row, surface and name of the convex edges of a mesh."""
    surface = surface_numbers(second, patches_for_body(second, 0.0))
    for i in range(len(second.edges)):
        yield edge_row(second, i), surface, f"edge {i}"
