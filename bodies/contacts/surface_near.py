"""Which corners and edges of two surfaces are near each other and may touch, by the trees of both."""

from __future__ import annotations

import math

from bodies.contacts.frames import point_in_world, vector_in_body, vector_in_world
from bodies.contacts.surface_edges import edge_astray
from bodies.contacts.surface_search import box_square, in_triangle
from bodies.contacts.surface_tables import (
    CORNER,
    CORNERS,
    EDGE,
    EDGES,
    FACE,
    FACES,
    MEMBERS,
    N_EDGES,
    N_NODES,
    N_TRIANGLES,
    NODE,
    NODES,
    STARS,
    TRIANGLE,
    TRIANGLES,
)
from bodies.contacts.surface_vertex import ASTRAY, leaning
from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

OVER_FIRST, OVER_SECOND, EDGE_ACROSS = 1.0, 2.0, 3.0
"""A corner of the second body over a patch of the first, the other way round, and two edges: the first of the three
numbers of a candidate.  Patch and corner, or the edges of the first and the second body, follow."""
_ALONG = 1e-3
"""Sine of the angle between edges below which nothing is said of their normals."""


@compiled
def _seen_from(frame: Floats, other: Floats, x: float, y: float, z: float) -> tuple[float, float, float]:
    """Return a point of the other body in the axes of a frame [m]."""
    x, y, z = point_in_world(other, x, y, z)
    x, y, z = vector_in_body(frame, x - frame[0], y - frame[1], z - frame[2])
    return x, y, z


@compiled
def _is_near(surface: Floats, x: float, y: float, z: float, reach: float) -> bool:
    """Return whether some leaf of a surface may be nearer to a point than a reach [m]."""
    node = 0
    while node < int(surface[N_NODES]):
        at = int(surface[NODES]) + NODE * node
        if box_square(surface, at, x, y, z) > reach * reach:
            node = int(surface[at + 6])
        elif surface[at + 8] > 0.0:
            return True
        else:
            node += 1
    return False


@compiled
def _patch_of(surface: Floats, member: int) -> float:
    """Return the patch of a member of the tree."""
    n_triangles, n_edges = int(surface[N_TRIANGLES]), int(surface[N_EDGES])
    if member < n_triangles:
        t = int(surface[TRIANGLES]) + TRIANGLE * member
        return float(surface[int(surface[FACES]) + FACE * int(surface[t + 9]) + 4])
    if member < n_triangles + n_edges:
        return float(surface[int(surface[EDGES]) + EDGE * (member - n_triangles) + 13])
    return float(surface[int(surface[CORNERS]) + CORNER * (member - n_triangles - n_edges) + 3])


@compiled
def patches_near(surface: Floats, x: float, y: float, z: float, reach: float, out: Floats) -> int:
    """Write the patches with a leaf no farther from a point than a reach [m] as candidates; return their number."""
    members, n, node = int(surface[MEMBERS]), 0, 0
    while node < int(surface[N_NODES]):
        at = int(surface[NODES]) + NODE * node
        if box_square(surface, at, x, y, z) > reach * reach:
            node = int(surface[at + 6])
            continue
        for i in range(int(surface[at + 8])):
            patch, known = _patch_of(surface, int(surface[members + int(surface[at + 7]) + i])), 0
            while known < n and out[2 + 3 * known] != patch:
                known += 1
            if known == n:
                out[1 + 3 * n], out[2 + 3 * n], out[3 + 3 * n] = 1.0, patch, 0.0
                n += 1
        node += 1
    return n


@compiled
def _is_node_near(frame: Floats, other: Floats, surface: Floats, parts: Floats, at: int, reach: float) -> bool:
    """Return whether something in a node of the other body may be nearer to a surface than a reach [m]."""
    dx, dy, dz = parts[at + 3] - parts[at], parts[at + 4] - parts[at + 1], parts[at + 5] - parts[at + 2]
    x, y, z = _seen_from(frame, other, parts[at] + 0.5 * dx, parts[at + 1] + 0.5 * dy, parts[at + 2] + 0.5 * dz)
    return bool(_is_near(surface, x, y, z, 0.5 * math.sqrt(dx * dx + dy * dy + dz * dz) + reach))


@compiled
def _patches_near(
    frame: Floats, other: Floats, surface: Floats, corners: Floats, corner: int, reach: float, turn: float
) -> int:
    """Return the patches, as bits, of the faces no farther from a corner that it may stand over after a small turn."""
    c = int(corners[CORNERS]) + CORNER * corner
    x, y, z = _seen_from(frame, other, corners[c], corners[c + 1], corners[c + 2])
    begin = int(corners[STARS]) + int(corners[c + 4])
    members, bits, node = int(surface[MEMBERS]), 0, 0
    while node < int(surface[N_NODES]):
        at = int(surface[NODES]) + NODE * node
        if box_square(surface, at, x, y, z) > reach * reach:
            node = int(surface[at + 6])
            continue
        for i in range(int(surface[at + 8])):
            member = int(surface[members + int(surface[at + 7]) + i])
            if member >= int(surface[N_TRIANGLES]):
                continue
            t = int(surface[TRIANGLES]) + TRIANGLE * member
            f = int(surface[FACES]) + FACE * int(surface[t + 9])
            bit = 1 << int(surface[f + 4])
            if bits & bit:
                continue
            px, py, pz, _ = in_triangle(surface, t, x, y, z)
            square = (x - px) * (x - px) + (y - py) * (y - py) + (z - pz) * (z - pz)
            if square <= reach * reach and (
                leaning(frame, other, surface, f, corners[c + 5], corners, begin) <= ASTRAY + turn
            ):
                bits |= bit
        node += 1
    return bits


@compiled
def corners_near(
    frame: Floats,
    other: Floats,
    surface: Floats,
    corners: Floats,
    reach: float,
    turn: float,
    kind: float,
    out: Floats,
    n: int,
    most: int,
) -> int:
    """Write the corners of the other body near patches of the surface in ``frame`` behind ``n``; return their number.

    Parameters
    ----------
    frame, other : Floats
        Frame blocks.
    surface, corners : Floats
        Numbers of either body's surface.
    reach : float
        How far from each other [m].
    turn : float
        How far the bodies may turn until they are looked for again [rad].
    kind : float
        The first number of these candidates.
    out : Floats
        Three numbers of each, from the second place on.
    n, most : int
        How many there are, and more of which are not counted.
    """
    first = int(corners[N_TRIANGLES]) + int(corners[N_EDGES])
    members, node = int(corners[MEMBERS]), 0
    while node < int(corners[N_NODES]) and n <= most:
        at = int(corners[NODES]) + NODE * node
        if not _is_node_near(frame, other, surface, corners, at, reach):
            node = int(corners[at + 6])
            continue
        for i in range(int(corners[at + 8])):
            corner = int(corners[members + int(corners[at + 7]) + i]) - first
            bits = _patches_near(frame, other, surface, corners, corner, reach, turn) if corner >= 0 else 0
            patch = 0
            while bits and n <= most:
                if bits & 1:
                    out[1 + 3 * n], out[2 + 3 * n], out[3 + 3 * n] = kind, float(patch), float(corner)
                    n += 1
                bits >>= 1
                patch += 1
        node += 1
    return n


@compiled
def _passes_box(
    surface: Floats, at: int, px: float, py: float, pz: float, dx: float, dy: float, dz: float, reach: float
) -> bool:
    """Return whether a line from p by d is nearer to the box of a node than a reach [m] along each axis."""
    low, high = 0.0, 1.0
    for i in range(3):
        p, d = (px, dx) if i == 0 else (py, dy) if i == 1 else (pz, dz)
        one, two = surface[at + i] - reach - p, surface[at + 3 + i] + reach - p
        if d < 0.0:
            one, two, d = -two, -one, -d
        if one > d or two < 0.0:
            return False
        if one > 0.0:
            low = max(low, one / d)
        if two < d:
            high = min(high, two / d)
    return low <= high


@compiled
def _square_of_lines(
    wx: float,
    wy: float,
    wz: float,
    ex: float,
    ey: float,
    ez: float,
    p: float,
    fx: float,
    fy: float,
    fz: float,
    q: float,
) -> float:
    """Return the square of the distance of two segments: along e by up to p, and from w along f by up to q."""
    across = ex * fx + ey * fy + ez * fz
    along_e, along_f = wx * ex + wy * ey + wz * ez, wx * fx + wy * fy + wz * fz
    sine = 1.0 - across * across
    s = min(max((along_e - across * along_f) / sine, 0.0), p) if sine > 0.0 else 0.0
    t = min(max(s * across - along_f, 0.0), q)
    s = min(max(along_e + t * across, 0.0), p)
    x, y, z = wx + t * fx - s * ex, wy + t * fy - s * ey, wz + t * fz - s * ez
    return x * x + y * y + z * z


@compiled
def _may_cross(a: Floats, b: Floats, surface_a: Floats, one: int, surface_b: Floats, two: int, turn: float) -> bool:
    """Return whether the normals of two edges face each other, or may after a small turn."""
    ex, ey, ez = vector_in_world(a, surface_a[one + 3], surface_a[one + 4], surface_a[one + 5])
    fx, fy, fz = vector_in_world(b, surface_b[two + 3], surface_b[two + 4], surface_b[two + 5])
    x, y, z = ey * fz - ez * fy, ez * fx - ex * fz, ex * fy - ey * fx
    sine = math.sqrt(x * x + y * y + z * z)
    if sine <= _ALONG:
        return True
    x, y, z = x / sine, y / sine, z / sine
    plus = max(edge_astray(a, surface_a, one, 1.0, x, y, z), edge_astray(b, surface_b, two, -1.0, x, y, z))
    minus = max(edge_astray(a, surface_a, one, -1.0, x, y, z), edge_astray(b, surface_b, two, 1.0, x, y, z))
    # the normal turns with either edge, the faster the less they cross
    return bool(min(plus, minus) <= ASTRAY + turn * (1.0 + 2.0 / sine))


@compiled
def edges_near(
    a: Floats,
    b: Floats,
    surface_a: Floats,
    surface_b: Floats,
    reach: float,
    turn: float,
    out: Floats,
    n: int,
    most: int,
) -> int:
    """Write the edges of both bodies that are near each other behind ``n``; return how many candidates there are.

    Arguments as of :func:`corners_near`.
    """
    first_a, first_b = int(surface_a[N_TRIANGLES]), int(surface_b[N_TRIANGLES])
    members_a, members_b, node_b = int(surface_a[MEMBERS]), int(surface_b[MEMBERS]), 0
    while node_b < int(surface_b[N_NODES]) and n <= most:
        at = int(surface_b[NODES]) + NODE * node_b
        if not _is_node_near(a, b, surface_a, surface_b, at, reach):
            node_b = int(surface_b[at + 6])
            continue
        for i in range(int(surface_b[at + 8])):
            j = int(surface_b[members_b + int(surface_b[at + 7]) + i]) - first_b
            if j < 0 or j >= int(surface_b[N_EDGES]):
                continue
            two = int(surface_b[EDGES]) + EDGE * j
            px, py, pz = _seen_from(a, b, surface_b[two], surface_b[two + 1], surface_b[two + 2])
            fx, fy, fz = vector_in_world(b, surface_b[two + 3], surface_b[two + 4], surface_b[two + 5])
            fx, fy, fz = vector_in_body(a, fx, fy, fz)
            q = surface_b[two + 6]
            node = 0
            while node < int(surface_a[N_NODES]) and n <= most:
                at_a = int(surface_a[NODES]) + NODE * node
                if not _passes_box(surface_a, at_a, px, py, pz, q * fx, q * fy, q * fz, reach):
                    node = int(surface_a[at_a + 6])
                    continue
                for m in range(int(surface_a[at_a + 8])):
                    e = int(surface_a[members_a + int(surface_a[at_a + 7]) + m]) - first_a
                    if e < 0 or e >= int(surface_a[N_EDGES]) or n > most:
                        continue
                    one = int(surface_a[EDGES]) + EDGE * e
                    square = _square_of_lines(
                        px - surface_a[one],
                        py - surface_a[one + 1],
                        pz - surface_a[one + 2],
                        surface_a[one + 3],
                        surface_a[one + 4],
                        surface_a[one + 5],
                        surface_a[one + 6],
                        fx,
                        fy,
                        fz,
                        q,
                    )
                    if square <= reach * reach and _may_cross(a, b, surface_a, one, surface_b, two, turn):
                        out[1 + 3 * n], out[2 + 3 * n], out[3 + 3 * n] = EDGE_ACROSS, float(e), float(j)
                        n += 1
                node += 1
        node_b += 1
    return n
