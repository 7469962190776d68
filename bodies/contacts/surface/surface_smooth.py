"""Contacts of a smooth body with boxes, hulls, capsules and meshes."""

from __future__ import annotations

import math
from typing import final

from nonsmooth.engine.memory.blocks import SIDE_A, SIDE_B
from nonsmooth.interfaces import CandidateSearch, ContactKinematics, FeaturePair, Shape
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...meshes.patches import patches_for_body
from ...rotations import relative_rotation, rotated_back
from ...shapes.smooth import SmoothShape, extent
from ...shapes.support_function import is_round
from ...shapes.surface_shape import SurfaceShape
from ...vectors import minus, opposite, plus_scaled, vector_at
from ..features.edge_vertex import START
from ..features.frames import axes_of, point_in_world, point_seen_from, vector_in_world
from ..features.writing import NO_CANDIDATE, write_apart, write_contact
from ..smooth.smooth_core import CENTER, POINT, RADIUS, Cores, axes_in_world, facing_point, largest_semi_axis, spread
from ..smooth.smooth_newton import write_surface
from .convex_smooth import nearest_of_convex
from .patch_smooth import nearest_of_patch
from .smooth_stops import SmoothOver
from .surface_ball import write_feature
from .surface_near import Near, patches_near
from .surface_search import FAR
from .surface_tables import IS_CONVEX, N_PATCHES, ON_FACE, SWEEP, Solid, edge_at, part_names, surface_numbers

MOST_EACH = 8
"""Largest number of patches of a surface for which each patch is a contact of its own, without a search."""
NEAR = 1.0
"""Kind of a candidate: a patch near the body.

A candidate has four numbers: its kind, the number of the patch, 0, and the distance up to which it is valid [m].
"""


def find_near_patches(a: Floats, b: Floats, out: Floats, surface: Floats, extent: float, place: Floats) -> None:
    """Find the patches with a feature near the ball that encloses the second body, about a place in its frame [m]."""
    near = Near(out, NEAR, out[0], extent + surface[SWEEP] + out[0], 0.0, int(surface[N_PATCHES]))
    out[0] = float(patches_near(surface, point_seen_from(a, b, vector_at(place, 0)), near, 0.0, 0))


def evaluate_surface_smooth(
    a: Floats, b: Floats, out: Floats, candidate: Floats, surface: Floats, second: Floats, extent: float, size: float
) -> None:
    """Write the geometry block of a smooth body ``second`` and a patch of a surface, the present candidate.

    ``candidate`` is described at :data:`NEAR`; without one, the contact is written as wide open.  ``extent`` is the
    radius of a ball about the core's centre that encloses the smooth body [m].  The gap is nan if the search failed.
    """
    if candidate[0] == 0.0:
        write_apart(a, out, size)
        return
    axes_b, is_convex = axes_in_world(b, second), surface[IS_CONVEX] == 1.0
    center = point_seen_from(a, b, vector_at(second, CENTER))
    turn = relative_rotation(axes_of(a), axes_b)
    cores = Cores(POINT, second, turn, center)
    if is_convex:
        span = spread(center) + largest_semi_axis(second) + spread(vector_at(edge_at(surface, 0), START))
        (g, past, n, point), kind, number = nearest_of_convex(SmoothOver(surface, cores, span))
    else:
        body, reach = SmoothOver(surface, cores, extent), candidate[3] + surface[SWEEP]
        (g, past, n, point), kind, number = nearest_of_patch(body, candidate[1], reach)
    gap = g - surface[SWEEP] - second[RADIUS]
    gap = gap if is_convex or past <= 0.0 else math.hypot(gap, past)
    # if there is one patch only, it is the whole surface, which has no end
    past = past if surface[N_PATCHES] > 1.0 else 0.0
    p = facing_point(cores, n)[0]
    if kind != ON_FACE and not is_round(second):
        # on a flat place of the smooth body the normal does not determine the point: use the surface's point
        p = plus_scaled(point, g, n)
    normal = vector_in_world(a, n)
    point_b = plus_scaled(point_in_world(a, p), -second[RADIUS], normal)
    write_contact(a, out, gap, past, 0.0, normal, point_b, True)
    write_surface(out, SIDE_B, second, axes_b, rotated_back(turn, opposite(n)), rotated_back(turn, minus(p, center)))
    write_feature(out, SIDE_A, Solid(a, surface), kind, number)


@final
class SurfaceSmooth(ContactKinematics):
    """The contact of a smooth body with the nearest face, convex edge or corner of each patch of a surface.

    A surface is a box, a hull, a capsule or a mesh, convex or not.  A convex surface is one patch; others are divided
    for a body of this size (:mod:`bodies.meshes.patches`).  If there are many patches, a search assigns near ones to
    the contacts.
    """

    pair = SurfaceShape, SmoothShape

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FeaturePair, ...]:
        """Return as many contacts as there are patches, because all patches can be near."""
        assert isinstance(first, SurfaceShape)
        assert isinstance(second, SmoothShape)
        own, core = first.features, second.core
        radius = extent(core)
        patches = patches_for_body(own, 2.0 * radius)
        surface = surface_numbers(own, patches, first.sweep)
        names = tuple(f"{part} and smooth" for part in part_names(own))
        values: dict[str, Value] = {"surface": surface, "second": core, "extent": radius, "size": own.size}
        if patches.count <= MOST_EACH:
            given = [(NEAR, float(patch), 0.0, FAR) for patch in range(patches.count)]
            return tuple(FeaturePair(evaluate_surface_smooth, {**values, "candidate": one}, names) for one in given)
        sought: dict[str, Value] = {"surface": surface, "extent": radius, "place": core[CENTER : CENTER + 3]}
        search = CandidateSearch(find_near_patches, sought, {NEAR: (patches.count, 1)})
        values["candidate"] = NO_CANDIDATE
        return (FeaturePair(evaluate_surface_smooth, values, names, search),) * patches.count
