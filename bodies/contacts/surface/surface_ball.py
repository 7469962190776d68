"""A ball against one patch of a surface."""

from __future__ import annotations

import math

from bodies.blocks import put
from bodies.contacts.features.curvature import write_round
from bodies.contacts.features.frames import point_in_world, vector_in_body
from bodies.contacts.features.offset import place_sphere
from bodies.contacts.features.swept_vertex import END, NEAR, past_star
from bodies.contacts.surface.surface_feature import out_of_surface, write_feature
from bodies.contacts.surface.surface_search import nearest_in_patch
from bodies.contacts.surface.surface_tables import N_PATCHES
from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import NORMAL, PAST_END, POSITION, SIDE_A, SIDE_B
from nonsmooth.types import Floats


@compiled
def write_ball(
    a: Floats,
    b: Floats,
    out: Floats,
    surface: Floats,
    patch: float,
    radius: float,
    x_b: float,
    y_b: float,
    z_b: float,
    n_star: float,
    star: Floats,
    size: float,
    reach: float,
) -> None:
    """Write the geometry block of a ball of the second body and a patch of the first, looked for up to a reach [m]."""
    center_x, center_y, center_z = point_in_world(b, x_b, y_b, z_b)
    x, y, z = vector_in_body(a, center_x - a[POSITION], center_y - a[POSITION + 1], center_z - a[POSITION + 2])
    found = nearest_in_patch(surface, patch, x, y, z, reach)
    distance, kind, number = found[0], found[2], found[3]
    # the patch of a surface that has one only does not end
    past = found[1] if surface[N_PATCHES] > 1.0 else 0.0
    nx, ny, nz = out_of_surface(a, surface, found, past, x, y, z)
    if n_star > 0.0:
        beyond = past_star(b, star, n_star, distance, nx, ny, nz, size)
        past = max(past, min(beyond, -END * size) if distance - radius > NEAR * size else beyond)
    put(out, NORMAL, nx, ny, nz)
    if past > 0.0:
        apart = max(distance - radius, 0.0)
        distance = math.sqrt(apart * apart + past * past) + radius
    place_sphere(a, out, center_x, center_y, center_z, distance, radius)
    out[PAST_END] = past
    write_feature(a, out, SIDE_A, surface, kind, number)
    write_round(out, SIDE_B, radius)
