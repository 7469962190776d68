"""Feet and apex of a cylinder, cone or disc over a patch of a surface; the apex of a rounded body is a sphere."""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import SIDE_A, SIDE_B
from nonsmooth.types import Floats

from ...shapes.frustum import HIGH
from ...shapes.frustum import SWEEP as FRUSTUM_SWEEP
from ...vectors import Vector3, dot, opposite, plus_scaled, vector_at
from ..features.ends import END, NEAR, OPEN, gap_at_distance, gap_past_end
from ..features.frames import point_in_body, point_in_world, vector_in_world
from ..features.writing import write_flat, write_round
from ..surface.surface_ball import out_of_surface, write_feature
from ..surface.surface_search import FAR, distance_from_ends, face_at, face_height, nearest_in_patch
from ..surface.surface_tables import IS_CONVEX, N_FACES, N_PATCHES, SWEEP
from ..surface.surface_vertex import face_under
from .apex_frustum import past_apex
from .frustum import axis_in_world, on_axis_in_world
from .frustum_writing import write_contact


@compiled
def write_tip(
    a: Floats,
    b: Floats,
    out: Floats,
    frustum: Floats,
    surface: Floats,
    patch: float,
    place: Vector3,
    n_star: float,
    star: Floats,
    reach: float,
) -> None:
    """Write the geometry block of a foot or a sharp apex of the first body over a patch of the second body.

    Parameters
    ----------
    a, b, out : Floats
        Frame blocks of both bodies, and the geometry block.
    frustum : Floats
        The first body (:func:`bodies.shapes.frustum.frustum_numbers`).
    surface, patch : Floats, float
        The second body (:mod:`bodies.contacts.surface.surface_tables`), and the number of the patch.
    place, n_star, star : tuple of float, float, Floats
        The tip in its body frame [m], and unit vectors along its ``n_star`` edges.
    reach : float
        Distance of the cores up to which faces are searched [m].
    """
    face, gap, past = face_under(b, a, surface, patch, place, n_star, star, reach, False)
    n = vector_in_world(b, opposite(vector_at(surface, face_at(surface, face))))
    tip, sweep = point_in_world(a, place), frustum[FRUSTUM_SWEEP] + surface[SWEEP]
    height = face_height(surface, face_at(surface, face), point_in_body(b, tip)) - sweep
    gap = gap_at_distance(gap, past, sweep)
    if past > 0.0 and height < 0.0 and surface[IS_CONVEX] == 1.0:
        # the depth of a spring at which another contact takes over
        gap = height
    point = plus_scaled(tip, frustum[FRUSTUM_SWEEP], n)
    write_contact(a, out, gap, past, float(face), n, point, False)
    write_round(out, SIDE_A, frustum[FRUSTUM_SWEEP])
    write_flat(out, SIDE_B)


@compiled
def write_apex(
    a: Floats, b: Floats, out: Floats, frustum: Floats, surface: Floats, patch: float, size: float, reach: float
) -> None:
    """Write the geometry block of the apex of a cone and the nearest face or edge of one patch of the second body.

    One of the two bodies is rounded.  A corner of the surface has a contact of its own.

    Parameters
    ----------
    a, b, out : Floats
        Frame blocks of both bodies, and the geometry block.
    frustum : Floats
        The cone (:func:`bodies.shapes.frustum.frustum_numbers`).
    surface, patch : Floats, float
        The second body (:mod:`bodies.contacts.surface.surface_tables`), and the number of the patch.
    size : float
        Size of the bodies [m].
    reach : float
        Distance of the cores up to which features are searched [m].
    """
    axis, apex = axis_in_world(a, frustum), on_axis_in_world(a, frustum, frustum[HIGH])
    place = point_in_body(b, apex)
    # a segment has no face that could stand for features out of reach
    found = nearest_in_patch(surface, patch, place, reach if surface[N_FACES] > 0.0 else FAR)
    # one patch is the whole surface, which has no end
    past = found[1] if surface[N_PATCHES] > 1.0 else 0.0
    n = opposite(out_of_surface(b, surface, found, past, place))
    radius = frustum[FRUSTUM_SWEEP]
    gap = found[0] - radius - surface[SWEEP]
    side_nearer = past_apex(frustum, found[0], dot(n, axis), size)
    # the sphere of the apex is a part of the cone, so that a large gap is valid as a bound of the bodies' gap
    past = max(past, min(side_nearer, -END * size) if gap > NEAR * size else side_nearer)
    # a corner has a contact of its own
    shared = END * size - distance_from_ends(surface, found)
    past = max(past, shared)
    if shared > 0.0:
        # a large gap for a small distance past the end: the contact is open
        gap = math.hypot(max(gap, 0.0), max(past, OPEN * shared))
    else:
        gap = gap_past_end(gap, past, surface[IS_CONVEX] == 1.0)
    write_contact(a, out, gap, past, 0.0, n, plus_scaled(apex, radius, n), False)
    write_round(out, SIDE_A, radius)
    write_feature(b, out, SIDE_B, surface, found[2], found[3])
