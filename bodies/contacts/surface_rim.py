"""A rim of a cylinder, a cone or a disc against a patch of the surface of another body, which need not be convex."""

from __future__ import annotations

import math

from bodies.contacts.across import across
from bodies.contacts.frustum_writing import astray_of_rim
from bodies.contacts.surface_search import box_square, face_height, has_patch, pierced
from bodies.contacts.surface_tables import (
    FACE,
    FACES,
    MEMBERS,
    N_NODES,
    N_TRIANGLES,
    NODE,
    NODES,
    SIZE,
    TRIANGLE,
    TRIANGLES,
)
from bodies.contacts.surface_vertex import ASTRAY, over_face, touched_face
from bodies.contacts.vertex_face import REACH
from bodies.shapes.frustum import HIGH, LOW, SIDE
from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

_FLAT = 1e-12
"""Sine of the angle between rim and face below which the lowest point of the rim is round-off."""


@compiled
def lowest_on_rim(
    nx: float, ny: float, nz: float, ax: float, ay: float, az: float, fx: float, fy: float, fz: float
) -> tuple[float, float, float, float, float]:
    """Return the parts along and across the axis a of a normal, and its direction across: f where it has none."""
    axial, radial, ex, ey, ez = across(nx, ny, nz, ax, ay, az)
    if radial < _FLAT:
        return axial, radial, fx, fy, fz
    return axial, radial, ex, ey, ez


@compiled
def rim_under(
    surface: Floats,
    patch: float,
    frustum: Floats,
    radius: float,
    up: float,
    cx: float,
    cy: float,
    cz: float,
    ax: float,
    ay: float,
    az: float,
    fx: float,
    fy: float,
    fz: float,
) -> tuple[int, float, float]:
    """Return face, gap and way past the end of a rim against a patch of a surface, as of a vertex.

    Over every face it is another point of the rim that counts, the lowest.  Past the end a body that goes through the
    surface has a negative gap.

    Parameters
    ----------
    surface, patch : Floats, float
        The surface, and the number of the patch.
    frustum : Floats
        The body with the rim.
    radius : float
        Of the rim [m].
    up : float
        1 for the upper rim, else -1.
    cx, cy, cz, ax, ay, az, fx, fy, fz : float
        Centre of the rim [m], its axis, and the direction across it that counts for a face along it, in the axes of the
        surface.
    """
    nodes, members, n_triangles = int(surface[NODES]), int(surface[MEMBERS]), int(surface[N_TRIANGLES])
    size = surface[SIZE]
    margin = REACH * size
    best, height_best, apart, past, found = 1e300, 0.0, 0.0, 1e300, 0
    under, under_past, under_face = 1e300, 0.0, -1
    x, y, z, u, v, w = cx, cy, cz, cx, cy, cz
    node = 0
    while node < int(surface[N_NODES]):
        at = nodes + NODE * node
        apart_at_least = math.sqrt(box_square(surface, at, cx, cy, cz)) - radius
        if apart_at_least > math.sqrt(best) or not has_patch(surface, at, patch):
            node = int(surface[at + 6])
            continue
        for i in range(int(surface[at + 8])):
            member = int(surface[members + int(surface[at + 7]) + i])
            if member >= n_triangles:
                continue
            t = int(surface[TRIANGLES]) + TRIANGLE * member
            face = int(surface[t + 9])
            f = int(surface[FACES]) + FACE * face
            if surface[f + 4] != patch:
                continue
            axial, radial, ex, ey, ez = lowest_on_rim(
                -surface[f], -surface[f + 1], -surface[f + 2], ax, ay, az, fx, fy, fz
            )
            px, py, pz = cx + radius * ex, cy + radius * ey, cz + radius * ez
            height = face_height(surface, f, px, py, pz)
            if height * height > best:
                continue
            lean = size * (astray_of_rim(frustum, up, radial, axial, frustum[SIDE] == 0.0) - ASTRAY)
            over, inside, ends, square = over_face(surface, t, height, lean, margin, px, py, pz)
            if over <= 0.0 and height < 0.0 and -height < under:
                under, under_past, under_face = -height, inside, face
                u, v, w = px, py, pz
            key = square + max(ends, 0.0) * max(ends, 0.0)
            if key < best:
                best, height_best, apart, past, found = key, height, math.sqrt(square), ends, face
                x, y, z = px, py, pz
        node += 1
    if under * under < best:
        x, y, z = u, v, w
    face, gap, past = touched_face(
        surface, found, best, height_best, apart, past, under_face, under, under_past, x, y, z
    )
    if past > 0.0 and gap > 0.0:
        # to the other side of the core, or of the disc
        onward, far = up * (frustum[LOW] - frustum[HIGH]), frustum[0] + frustum[1] - radius
        ex, ey, ez = (cx - x) / radius, (cy - y) / radius, (cz - z) / radius
        ex, ey, ez = cx + onward * ax + far * ex, cy + onward * ay + far * ey, cz + onward * az + far * ez
        depth = pierced(surface, x, y, z, ex, ey, ez)
        if depth > 0.0:
            gap = -depth
    return face, gap, past
