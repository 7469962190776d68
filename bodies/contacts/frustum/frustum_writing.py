"""What the contacts of two frustums share: both of them seen in the world, and the geometry block."""

from __future__ import annotations

import math
from typing import TypeAlias

from bodies.blocks import put
from bodies.contacts.features.across import across
from bodies.contacts.features.curvature import write_sweep
from bodies.contacts.features.tangents import write_tangent
from bodies.contacts.features.vertex_face import DEEP, REACH
from bodies.contacts.frustum.frustum import axis_in_world, center_in_world, nearest_part, write_part
from bodies.shapes.frustum import COS, FEET, SIN, SWEEP
from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import FEATURE, GAP, NORMAL, PAST_END, SIDE_A, SIDE_B
from nonsmooth.types import Floats

Point: TypeAlias = tuple[float, float, float]
ASTRAY = 0.25
"""Sine of the angle by which the normal may leave the normals of a rim: what may soon close is followed."""
_INSIDE = 4.0
"""Where no point is found inside, what overlaps does so only where it is so many depths away from its ends."""


@compiled
def past_border(gap: float, over: float, astray: float, overlap: float, size: float) -> float:
    """Return how far features are past their ends, by the way over them and the sine by which the normal leaves.

    The gap is that of the cores: without a radius, what overlaps is so deep as wide where it crosses.  Where a point of
    either is inside of the other, by a negative ``overlap``, the features hold up to their ends.
    """
    past = max(over - REACH * size, size * (astray - ASTRAY))
    if gap < 0.0 and overlap == 0.0:
        past = max(past, over - _INSIDE * gap - REACH * size)
    return past


@compiled
def astray_of_rim(frustum: Floats, up: float, radial: float, axial: float, flat: bool) -> float:
    """Return the sine by which an outward normal leaves those of a rim, the upper one if ``up`` is 1, else -1."""
    if flat:
        return -radial
    return float(max(-radial, -up * (frustum[COS] * axial - frustum[SIN] * radial)))


@compiled
def overlap_of(
    one: Floats, first: Floats, other: Floats, second: Floats, gap: float, size: float, p: Point, n: Point
) -> float:
    """Return how deep a point of the one body is in the other, or the other's in the one: negative, or 0.

    The point p and the other's, at the gap along n, are those of the cores.
    """
    ax, ay, az = axis_in_world(one, first)
    x, y, z = center_in_world(one, first)
    along, away, _, _, _ = across(p[0] + gap * n[0] - x, p[1] + gap * n[1] - y, p[2] + gap * n[2] - z, ax, ay, az)
    outside, _, _, _ = nearest_part(first, along, away)
    ax, ay, az = axis_in_world(other, second)
    x, y, z = center_in_world(other, second)
    along, away, _, _, _ = across(p[0] - x, p[1] - y, p[2] - z, ax, ay, az)
    found, _, _, _ = nearest_part(second, along, away)
    outside = min(outside, found) - first[SWEEP] - second[SWEEP]
    # rims are set back by the height of the feet over caps only
    return outside if outside < -DEEP * size - 2.0 * (first[FEET] + second[FEET]) else 0.0


@compiled
def write_two(
    a: Floats,
    out: Floats,
    swap: float,
    one: Floats,
    two: Floats,
    distance: float,
    past: float,
    nx: float,
    ny: float,
    nz: float,
    px: float,
    py: float,
    pz: float,
    overlap: float,
) -> None:
    """Write all but the matrices; n goes from the core of the one frustum, on which p lies, to the other's.

    The one is the first body, or the second if ``swap`` is 1.  What overlaps, by a negative number, where the features
    are past their ends is no contact of theirs, but a sign that another one was passed.
    """
    sweep = one[SWEEP]
    gap = distance - sweep - two[SWEEP]
    if past > 0.0:
        gap = max(-abs(gap), overlap) if overlap < 0.0 else math.sqrt(gap * gap + past * past)
    px, py, pz = px + sweep * nx, py + sweep * ny, pz + sweep * nz
    sign = 1.0 - 2.0 * swap
    own, other = 7 + int(3.0 * swap), 10 - int(3.0 * swap)
    out[GAP], out[FEATURE], out[PAST_END] = gap, 0.0, past
    put(out, NORMAL, sign * nx, sign * ny, sign * nz)
    out[own], out[own + 1], out[own + 2] = px, py, pz
    out[other], out[other + 1], out[other + 2] = px + gap * nx, py + gap * ny, pz + gap * nz
    write_tangent(a, out)


@compiled
def write_side(
    out: Floats,
    second: float,
    frustum: Floats,
    part: int,
    ax: float,
    ay: float,
    az: float,
    x: float,
    y: float,
    z: float,
    nx: float,
    ny: float,
    nz: float,
    away: float,
) -> None:
    """Write the matrices of a part of the second body if ``second`` is 1, else of the first.

    (x, y, z) is the way from its axis to the point, of any length, n its outward normal.
    """
    along = x * ax + y * ay + z * az
    x, y, z = x - along * ax, y - along * ay, z - along * az
    length = math.sqrt(x * x + y * y + z * z)
    radial = 0.0
    if length > 0.0:
        x, y, z = x / length, y / length, z / length
        radial = nx * x + ny * y + nz * z
    side = SIDE_B if second == 1.0 else SIDE_A
    write_part(out, side, part, ax, ay, az, x, y, z, radial, away)
    write_sweep(out, side, frustum[SWEEP])
