"""The apex of a rounded cone, a sphere, against a triangle mesh, convex or not."""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import SIDE_A, SIDE_B
from nonsmooth.types import Floats

from ...shapes.frustum import HIGH, SWEEP
from ...vectors import dot, minus, opposite, plus_scaled, vector_at
from ..features.frames import point_in_body
from ..features.polytope_tables import ALONG, LENGTH
from ..features.swept_vertex import END, NEAR, OPEN
from ..features.writing import write_round
from ..frustum.apex_swept import past_apex
from ..frustum.frustum import axis_in_world, on_axis_in_world
from ..frustum.frustum_writing import gap_past_end, write_contact
from ..surface.surface_ball import out_of_surface, write_feature
from ..surface.surface_search import FAR, ON_CORNER, ON_EDGE, Found, edge_at, nearest_in_patch
from ..surface.surface_tables import N_PATCHES


@compiled
def _distance_from_ends(surface: Floats, found: Found) -> float:
    """Return the distance of a nearest point from the nearer end of its edge [m]: 0 at a corner, infinite on a face."""
    _, _, kind, number, x, y, z = found
    if kind == ON_CORNER:
        return 0.0
    if kind != ON_EDGE:
        return math.inf
    row = edge_at(surface, number)
    along = dot(minus((x, y, z), vector_at(surface, row)), vector_at(surface, row + ALONG))
    return float(min(along, surface[row + LENGTH] - along))


def evaluate_apex_over_patch(
    a: Floats, b: Floats, out: Floats, first: Floats, surface: Floats, patch: float, size: float
) -> None:
    """Write the geometry block of the round apex of a cone and the nearest face or edge of one patch of a mesh.

    A corner has a contact of its own.  The search has no limit, because each patch has one contact with the apex.

    Parameters
    ----------
    a, b, out : Floats
        Frame blocks of both bodies, and the geometry block.
    first : Floats
        Dimensions of the cone (:func:`bodies.shapes.frustum.frustum_numbers`).
    surface, patch : Floats, float
        Tables of the mesh (:mod:`bodies.contacts.surface.surface_tables`), and number of the patch.
    size : float
        Size of the bodies [m].
    """
    write_apex(a, b, out, first, surface, patch, size, FAR)


@compiled
def write_apex(
    a: Floats, b: Floats, out: Floats, first: Floats, surface: Floats, patch: float, size: float, reach: float
) -> None:
    """Write the geometry block of a round apex and a patch of the second body, searched up to ``reach`` [m]."""
    axis, apex = axis_in_world(a, first), on_axis_in_world(a, first, first[HIGH])
    place = point_in_body(b, apex)
    found = nearest_in_patch(surface, patch, place, reach)
    # one patch is the whole surface, which has no end
    past = found[1] if surface[N_PATCHES] > 1.0 else 0.0
    n = opposite(out_of_surface(b, surface, found, past, place))
    radius = first[SWEEP]
    gap = found[0] - radius
    side_nearer = past_apex(first, found[0], dot(n, axis), size)
    # the sphere of the apex is a part of the cone, so that a large gap is valid as a bound of the bodies' gap
    past = max(past, min(side_nearer, -END * size) if gap > NEAR * size else side_nearer)
    # a corner has a contact of its own
    shared = END * size - _distance_from_ends(surface, found)
    past = max(past, shared)
    if past > 0.0:
        # a large gap for a small distance past the end: the contact is open
        gap = gap_past_end(max(gap, 0.0), max(past, OPEN * shared))
    write_contact(a, out, gap, past, 0.0, n, plus_scaled(apex, radius, n), False)
    write_round(out, SIDE_A, radius)
    write_feature(b, out, SIDE_B, surface, found[2], found[3])
