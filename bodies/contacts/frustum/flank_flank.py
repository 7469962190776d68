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
from ..features.edge_crossing import PARALLEL
from ..features.frames import tangent_of
from ..features.polytope_tables import Numbers
from .frustum import FLANK, axis_in_world, center_in_world, set_back
from .frustum_writing import past_border, past_depth, write_side, write_two


@compiled
def _cross(
    ax: float, ay: float, az: float, bx: float, by: float, bz: float
) -> tuple[tuple[float, float, float], float]:
    """Return the unit vector along the product of two unit vectors, and its length, the sine of their angle.

    Of parallel vectors, return any unit vector perpendicular to them.
    """
    x, y, z = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
    # the components of a small product along a are round-off
    along = x * ax + y * ay + z * az
    x, y, z = x - along * ax, y - along * ay, z - along * az
    size = math.sqrt(x * x + y * y + z * z)
    return ((x / size, y / size, z / size), size) if size > 0.0 else (tangent_of((ax, ay, az)), 0.0)


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
    # n = one a + two e + part c, with unit vectors c along a x b and e = c x a. The sines of the sides give n . a and
    # -n . b, and |n| = 1 gives the part
    (fx, fy, fz), sine = _cross(ax, ay, az, bx, by, bz)
    ex, ey, ez = fy * az - fz * ay, fz * ax - fx * az, fx * ay - fy * ax
    one = first[SIN]
    two = (-second[SIN] - (ax * bx + ay * by + az * bz) * one) / sine if sine > 0.0 else 0.0
    rest = 1.0 - one * one - two * two
    part = math.sqrt(max(rest, 0.0))
    gap, nx, ny, nz = -math.inf, 1.0, 0.0, 0.0
    reach_a = first[COS] * first[0] + first[SIN] * first[LOW]
    reach_b = second[COS] * second[0] + second[SIN] * second[LOW]
    for sign in (-1.0, 1.0):
        tx = one * ax + two * ex + sign * part * fx
        ty = one * ay + two * ey + sign * part * fy
        tz = one * az + two * ez + sign * part * fz
        length = math.sqrt(tx * tx + ty * ty + tz * tz)
        tx, ty, tz = tx / length, ty / length, tz / length
        found = tx * (kx - cx) + ty * (ky - cy) + tz * (kz - cz) - reach_a - reach_b
        if found > gap:
            gap, nx, ny, nz = found, tx, ty, tz
    px, py, pz, ux, uy, uz = _line(first, cx, cy, cz, ax, ay, az, nx, ny, nz)
    qx, qy, qz, vx, vy, vz = _line(second, kx, ky, kz, bx, by, bz, -nx, -ny, -nz)
    wx, wy, wz = qx - px, qy - py, qz - pz
    cross = nx * (uy * vz - uz * vy) + ny * (uz * vx - ux * vz) + nz * (ux * vy - uy * vx)
    s, t, over = 0.5 * first[SIDE], 0.5 * second[SIDE], size
    if rest >= 0.0 and abs(cross) > PARALLEL:
        s = (nx * (wy * vz - wz * vy) + ny * (wz * vx - wx * vz) + nz * (wx * vy - wy * vx)) / cross
        t = (nx * (wy * uz - wz * uy) + ny * (wz * ux - wx * uz) + nz * (wx * uy - wy * ux)) / cross
        over = max(max(-s, s - first[SIDE]), max(-t, t - second[SIDE]))
        # the distance along n of the points that cross: an error of n hardly changes it
        wx, wy, wz = wx + t * vx - s * ux, wy + t * vy - s * uy, wz + t * vz - s * uz
        gap = nx * wx + ny * wy + nz * wz
    px, py, pz = px + s * ux, py + s * uy, pz + s * uz
    qx, qy, qz = px + gap * nx, py + gap * ny, pz + gap * nz
    away_a = first[0] - first[SIN] * s
    away_b = second[0] - second[SIN] * t
    past = max(past_border(over, 0.0, size), past_depth(a, first, b, second, gap, size))
    write_two(a, out, 0.0, first, second, gap, past, (nx, ny, nz), (px, py, pz))
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
        one, two = set_back(first), set_back(second)
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
