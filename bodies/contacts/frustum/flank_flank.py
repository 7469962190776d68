"""Contact of the sides of two cylinders or cones that cross each other, in closed form."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from nonsmooth.compiled import compiled
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...shapes.frustum import COS, LOW, SIDE, SIN, Frustum
from ..features.frames import tangent_of
from ..features.polytope_tables import Numbers
from .frustum import FLANK, axis_in_world, center_in_world
from .frustum_writing import overlap_of, past_border, write_side, write_two

PARALLEL = 0.01
"""Least sine of the angle between the straight lines of two crossing sides through their contact points.

Sides at a smaller angle touch at their rims, which have contacts of their own.
"""


@compiled
def _line(
    frustum: Floats, cx: float, cy: float, cz: float, ax: float, ay: float, az: float, nx: float, ny: float, nz: float
) -> tuple[float, float, float, float, float, float]:
    """Return the straight line of the side with the outward normal (nx, ny, nz): its lower end [m] and unit vector."""
    cosine, sine = frustum[COS], frustum[SIN]
    ex, ey, ez = (nx - sine * ax) / cosine, (ny - sine * ay) / cosine, (nz - sine * az) / cosine
    wide, low = frustum[0], frustum[LOW]
    return (
        cx + low * ax + wide * ex,
        cy + low * ay + wide * ey,
        cz + low * az + wide * ez,
        cosine * ax - sine * ex,
        cosine * ay - sine * ey,
        cosine * az - sine * ez,
    )


def _evaluate(a: Floats, b: Floats, out: Floats, first: Floats, second: Floats, size: float) -> None:
    ax, ay, az = axis_in_world(a, first)
    bx, by, bz = axis_in_world(b, second)
    cx, cy, cz = center_in_world(a, first)
    kx, ky, kz = center_in_world(b, second)
    # n = p a + q b + r (a x b): n . a = sine of the first side, n . b = -sine of the second side, r from |n| = 1
    cross_x, cross_y, cross_z = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
    square = cross_x * cross_x + cross_y * cross_y + cross_z * cross_z
    dot = ax * bx + ay * by + az * bz
    none = square < 1e-12
    one, two = first[SIN], -second[SIN]
    if none:
        # parallel axes: any direction perpendicular to both
        cross_x, cross_y, cross_z = tangent_of(ax, ay, az)
        square, dot, one, two = 1.0, 0.0, 0.0, 0.0
    p, q = (one - dot * two) / square, (two - dot * one) / square
    rest = 1.0 - (p * one + q * two)
    none = none or rest < 0.0
    part = math.sqrt(max(rest, 0.0) / square)
    gap, nx, ny, nz = -math.inf, 1.0, 0.0, 0.0
    reach_a = first[COS] * first[0] + first[SIN] * first[LOW]
    reach_b = second[COS] * second[0] + second[SIN] * second[LOW]
    for sign in (-1.0, 1.0):
        tx = p * ax + q * bx + sign * part * cross_x
        ty = p * ay + q * by + sign * part * cross_y
        tz = p * az + q * bz + sign * part * cross_z
        length = math.sqrt(tx * tx + ty * ty + tz * tz)
        tx, ty, tz = tx / length, ty / length, tz / length
        found = tx * (kx - cx) + ty * (ky - cy) + tz * (kz - cz) - reach_a - reach_b
        if found > gap:
            gap, nx, ny, nz = found, tx, ty, tz
    px, py, pz, ux, uy, uz = _line(first, cx, cy, cz, ax, ay, az, nx, ny, nz)
    qx, qy, qz, vx, vy, vz = _line(second, kx, ky, kz, bx, by, bz, -nx, -ny, -nz)
    wx, wy, wz = qx - px, qy - py, qz - pz
    cross = nx * (uy * vz - uz * vy) + ny * (uz * vx - ux * vz) + nz * (ux * vy - uy * vx)
    s, t = 0.5 * first[SIDE], 0.5 * second[SIDE]
    if abs(cross) > 1e-6:
        s = (nx * (wy * vz - wz * vy) + ny * (wz * vx - wx * vz) + nz * (wx * vy - wy * vx)) / cross
        t = (nx * (wy * uz - wz * uy) + ny * (wz * ux - wx * uz) + nz * (wx * uy - wy * ux)) / cross
    over = max(max(-s, s - first[SIDE]), max(-t, t - second[SIDE]))
    if none or abs(cross) <= 1e-6:
        over = size
    px, py, pz = px + s * ux, py + s * uy, pz + s * uz
    qx, qy, qz = px + gap * nx, py + gap * ny, pz + gap * nz
    away_a = first[0] - first[SIN] * s
    away_b = second[0] - second[SIN] * t
    overlap = 0.0
    if over <= 0.0:
        overlap = overlap_of(a, first, b, second, gap, size, (px, py, pz), (nx, ny, nz))
    past = max(past_border(gap, over, 0.0, overlap, size), size * (PARALLEL - abs(cross)))
    write_two(a, out, 0.0, first, second, gap, past, (nx, ny, nz), (px, py, pz), overlap)
    write_side(out, 0.0, first, FLANK, (ax, ay, az), (px - cx, py - cy, pz - cz), (nx, ny, nz), max(away_a, 0.0))
    write_side(out, 1.0, second, FLANK, (bx, by, bz), (qx - kx, qy - ky, qz - kz), (-nx, -ny, -nz), max(away_b, 0.0))


@final
@dataclass(frozen=True)
class FlankFlank(ContactKinematics):
    """Contact of the sides of two cylinders or cones that cross.

    Attributes
    ----------
    first, second : tuple of float
        The bodies (:func:`bodies.shapes.frustum.frustum_numbers`).
    size : float
        Size of the bodies [m].
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Frustum, Frustum)

    first: Numbers
    second: Numbers
    size: float

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[ContactKinematics, ...]:
        """Return the contact of the sides; empty for a disc, which has no side."""
        assert isinstance(first, Frustum)
        assert isinstance(second, Frustum)
        one, two = first.frustum, second.frustum
        if one[SIDE] == 0.0 or two[SIDE] == 0.0:
            return ()
        return (cls(one, two, 2.0 * max(first.extent, second.extent)),)

    def parameters(self) -> dict[str, Value]:
        """Return the numbers of both bodies by the names of the evaluator's arguments."""
        return {"first": self.first, "second": self.second, "size": self.size}

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return _evaluate

    @property
    def features(self) -> tuple[str, ...]:
        """Name of the only pair of features."""
        return ("side and side",)
