"""The features of a cylinder, a cone or a disc and of a surface that are near each other, by the tree of the latter."""

from __future__ import annotations

import math

from bodies.contacts.frustum.frustum import HIGH_RIM, LOW_RIM
from bodies.contacts.mesh.frustum_near import (
    FrustumPose,
    corner_is_near,
    edge_is_near,
    from_core,
    frustum_in_surface,
    rim_is_near,
)
from bodies.contacts.surface.surface_near import patches_near, patches_under, room_ahead
from bodies.contacts.surface.surface_tables import (
    EDGE,
    EDGES,
    MEMBERS,
    N_EDGES,
    N_NODES,
    N_TRIANGLES,
    NODE,
    NODES,
    TRIANGLE,
    TRIANGLES,
)
from bodies.shapes.frustum import HIGH, SIDE, SWEEP
from nonsmooth.compiled import block_at, compiled
from nonsmooth.types import Floats

RIM, POINT, APEX, UNDER, ACROSS_FLANK, ACROSS_BACK, ACROSS_FRONT = 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0
"""A face and a rim over it, a patch and a point over it, a patch and the round apex, a corner of the surface, an edge
of it across the side, and one across the first or the second half of a rim: the first of the three numbers of a
candidate."""
POINT_ROW = 4
"""Numbers of a point, a foot or the apex: place, number of lines about it; the unit vectors along these follow."""


@compiled
def _add(kind: float, second: float, third: float, out: Floats, n: int, most: int) -> int:
    """Write a candidate behind ``n``, if there is room; return their number."""
    if n > most:
        return n
    out[1 + 3 * n], out[2 + 3 * n], out[3 + 3 * n] = kind, second, third
    return n + 1


@compiled
def _add_face(face: float, upper: float, out: Floats, n: int, most: int) -> int:
    """Write the candidate of a face and a rim, unless another triangle of the face has done so."""
    for i in range(n):
        if out[1 + 3 * i] == RIM and out[2 + 3 * i] == face and out[3 + 3 * i] == upper:
            return n
    return int(_add(RIM, face, upper, out, n, most))


@compiled
def _add_halves(edge: float, rim: int, out: Floats, n: int, most: int) -> int:
    """Write the candidates of an edge and both halves of a rim."""
    n = _add(ACROSS_BACK, edge, float(rim), out, n, most)
    return int(_add(ACROSS_FRONT, edge, float(rim), out, n, most))


@compiled
def _member_near(
    surface: Floats,
    member: int,
    frustum: Floats,
    pose: FrustumPose,
    reach: float,
    turn: float,
    size: float,
    out: Floats,
    n: int,
    most: int,
) -> int:
    """Write what may touch of a face, an edge or a corner; return how many candidates there are."""
    n_triangles, n_edges = int(surface[N_TRIANGLES]), int(surface[N_EDGES])
    if member < n_triangles:
        t = int(surface[TRIANGLES]) + TRIANGLE * member
        for upper in range(2 if frustum[SIDE] > 0.0 and frustum[1] > 0.0 else 1):
            if rim_is_near(surface, t, frustum, upper, pose, reach, turn):
                n = _add_face(surface[t + 9], float(upper), out, n, most)
        return n
    if member < n_triangles + n_edges:
        e = member - n_triangles
        flank, lower, upper_rim = edge_is_near(
            surface, int(surface[EDGES]) + EDGE * e, frustum, pose, reach, turn, size
        )
        if flank:
            n = _add(ACROSS_FLANK, float(e), 0.0, out, n, most)
        if lower:
            n = _add_halves(float(e), LOW_RIM, out, n, most)
        if upper_rim:
            n = _add_halves(float(e), HIGH_RIM, out, n, most)
        return n
    c = member - n_triangles - n_edges
    if corner_is_near(surface, c, frustum, pose, reach, turn, size):
        n = _add(UNDER, float(c), 0.0, out, n, most)
    return n


def find_near_frustum(
    a: Floats,
    b: Floats,
    out: Floats,
    frustum: Floats,
    n_points: float,
    points: Floats,
    surface: Floats,
    size: float,
    most: float,
    turning: float,
    narrow: float,
) -> None:
    """Find rims, points and apex over faces, corners, and edges across side and rims.

    A rim has a face for candidate, not a patch: patches of surfaces with triangles that are small beside the rim would
    be so many as the faces next to it.  ``turning`` is as of two surfaces, ``narrow`` of
    :func:`bodies.contacts.surface.surface_near.room_ahead`.
    """
    reach, limit, n, node = out[0], room_ahead(out[0], narrow, int(most)), 0, 0
    turn, sweep = turning * reach, frustum[SWEEP]
    pose = frustum_in_surface(a, b, frustum)
    while node < int(surface[N_NODES]) and n <= limit:
        at = int(surface[NODES]) + NODE * node
        dx, dy, dz = surface[at + 3] - surface[at], surface[at + 4] - surface[at + 1], surface[at + 5] - surface[at + 2]
        x, y, z = surface[at] + 0.5 * dx, surface[at + 1] + 0.5 * dy, surface[at + 2] + 0.5 * dz
        if from_core(frustum, pose, x, y, z) > sweep + reach + 0.5 * math.sqrt(dx * dx + dy * dy + dz * dz):
            node = int(surface[at + 6])
            continue
        members = int(surface[MEMBERS]) + int(surface[at + 7])
        for i in range(int(surface[at + 8])):
            n = _member_near(
                surface, int(surface[members + i]), frustum, pose, sweep + reach, turn, size, out, n, limit
            )
        node += 1
    for i in range(int(n_points)):
        v = (POINT_ROW + 3 * int(points[3])) * i
        place, star = (points[v], points[v + 1], points[v + 2]), block_at(points, v + POINT_ROW)
        n = patches_under(
            b, a, surface, place, points[v + 3], star, sweep + reach, turn, POINT, float(i), out, n, limit
        )
    if sweep > 0.0 and frustum[SIDE] > 0.0 and frustum[1] == 0.0:
        cx, cy, cz, ax, ay, az = pose
        x, y, z = cx + frustum[HIGH] * ax, cy + frustum[HIGH] * ay, cz + frustum[HIGH] * az
        n = patches_near(surface, x, y, z, sweep + reach, APEX, 0.0, out, n, limit)
    out[0] = float(n) if n <= limit else most + 1.0
