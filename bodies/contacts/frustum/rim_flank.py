"""Contact of a rim of one frustum, or of its apex, with the side of another frustum.

The height of a point over a side is a convex function of the point, which has up to two minima round a rim.  Samples of
the rim bracket a minimum, then Newton's method between bounds finds it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from nonsmooth.compiled import compiled
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...shapes.frustum import COS, HIGH, LOW, SIDE, SIN, SWEEP, Frustum
from ...vectors import Vector3
from ..features.frames import across
from ..features.polytope_tables import Numbers
from ..smooth.smooth_core import axes_in_world, back, forth
from .frustum import FLANK, HIGH_RIM, LOW_RIM, RIM_NAMES, center_in_world, set_back
from .frustum_writing import astray_of_rim, past_border, past_depth, write_side, write_two

_STEEP = math.pi / 6.0
"""Angle between the plane of the rim and the side [rad], above which the rim has one minimum of the height only."""
_SAMPLES, _STEPS = 12, 60
_BEYOND = 3e-8
"""Length by which the contact of a rim extends past the end of a side if a body is rounded, relative to the size.

On this length the contact of both rims begins, so that one of the two contacts always exists.
"""
_BENT = 1e-6
"""Least second derivative of the height by the angle at a minimum, over the rim's radius; if less, there is none."""


@compiled
def _height(second: Floats, middle: Vector3, g: Vector3, h: Vector3, angle: float) -> tuple[float, float, float]:
    """Return the height of a rim's point over the side, and its first and second derivative by ``angle`` [m].

    The point is middle + g cos(angle) + h sin(angle), with the rim's centre ``middle``.  All vectors are in the axes of
    the side's body ``second``.
    """
    (cx, cy, cz), (gx, gy, gz), (hx, hy, hz) = middle, g, h
    c, s = math.cos(angle), math.sin(angle)
    x, y = cx + c * gx + s * hx, cy + c * gy + s * hy
    dx, dy, dz = c * hx - s * gx, c * hy - s * gy, c * hz - s * gz
    away = max(math.sqrt(x * x + y * y), 1e-300)
    slope = (x * dx + y * dy) / away
    bend = (dx * dx + dy * dy - x * (x - cx) - y * (y - cy) - slope * slope) / away
    wide = cz + c * gz + s * hz
    cosine, sine = second[COS], second[SIN]
    value = cosine * (away - second[0]) + sine * (wide - second[LOW])
    return value, cosine * slope + sine * dz, cosine * bend - sine * (wide - cz)


@compiled
def least_round(second: Floats, middle: Vector3, g: Vector3, h: Vector3, low: float, high: float) -> tuple[float, bool]:
    """Return the angle round a rim [rad] at its lowest point over the side of ``second``, and a check.

    The angle lies between ``low`` and ``high``.  The check is True if the height has a minimum there, inside of the
    interval.  ``middle``, ``g`` and ``h`` give the point of the rim at an angle, as in :func:`_height`.
    """
    gx, gy, gz = g
    step = (high - low) / _SAMPLES
    best, angle = math.inf, low
    for i in range(_SAMPLES + 1):
        value, _, _ = _height(second, middle, g, h, low + i * step)
        if value < best:
            best, angle = value, low + i * step
    least, most = angle - step, angle + step
    for _ in range(_STEPS):
        _, slope, bend = _height(second, middle, g, h, angle)
        if slope > 0.0:
            most = angle
        else:
            least = angle
        after = angle - slope / bend if bend > 0.0 else math.inf
        if after < least or after > most:
            after = 0.5 * (least + most)
        if abs(after - angle) <= 2e-16 * max(abs(angle), 0.1):
            break
        angle = after
    _, _, bend = _height(second, middle, g, h, angle)
    size = math.sqrt(gx * gx + gy * gy + gz * gz)
    # if the interval covers the whole rim, it has no ends, so that any minimum is inside of it
    within = low <= angle <= high or high - low > 1.5 * math.pi
    return angle, within and bend > _BENT * size


def _evaluate(
    a: Floats, b: Floats, out: Floats, swap: float, first: Floats, rim: float, half: float, second: Floats, size: float
) -> None:
    own, other = (b, a) if swap == 1.0 else (a, b)
    own_axes, axes = axes_in_world(own, first), axes_in_world(other, second)
    cx, cy, cz = center_in_world(own, first)
    kx, ky, kz = center_in_world(other, second)
    part = int(rim)
    radius, height, up = first[0], first[LOW], -1.0
    if part == HIGH_RIM:
        radius, height, up = first[1], first[HIGH], 1.0
    # the centre of the rim and its axis, in the axes of the side
    mx, my, mz = back(axes, (cx - kx, cy - ky, cz - kz))
    ax, ay, az = back(axes, (own_axes[2], own_axes[5], own_axes[8]))
    mx, my, mz = mx + height * ax, my + height * ay, mz + height * az
    # h: projection of the side's axis on the plane of the rim; g: perpendicular to h in this plane
    _, _, (hx, hy, hz) = across((0.0, 0.0, 1.0), (ax, ay, az))
    # the height can have two minima round the rim only if a straight line of the side is nearly parallel to the plane
    # of the rim; then each half is searched. Each half is also searched if the axes are nearly perpendicular, even if
    # it has no minimum. In other poses, called steep, the whole rim is searched for its single minimum
    lean = math.asin(min(abs(az), 1.0))
    steep = lean > _STEEP and abs(lean - math.asin(second[SIN])) > _STEEP
    gx, gy, gz = hy * az - hz * ay, hz * ax - hx * az, hx * ay - hy * ax
    gx, gy, gz, hx, hy, hz = (
        radius * gx,
        radius * gy,
        radius * gz,
        radius * half * hx,
        radius * half * hy,
        radius * half * hz,
    )
    angle, found = 0.0, True
    if radius > 0.0:
        low, high = 0.0, math.pi
        if steep:
            # search the whole rim; the interval begins at the point farthest from the side's axis
            low = math.atan2(mx * hx + my * hy, mx * gx + my * gy)
            high = low + 2.0 * math.pi
        angle, found = least_round(second, (mx, my, mz), (gx, gy, gz), (hx, hy, hz), low, high)
    c, s = math.cos(angle), math.sin(angle)
    ox, oy, oz = c * gx + s * hx, c * gy + s * hy, c * gz + s * hz
    x, y, z = mx + ox, my + oy, mz + oz
    away = math.sqrt(x * x + y * y)
    ex, ey = (x / away, y / away) if away > 0.0 else (1.0, 0.0)
    cosine, sine = second[COS], second[SIN]
    gap = cosine * (away - second[0]) + sine * (z - second[LOW])
    along = cosine * (z - second[LOW]) - sine * (away - second[0])
    nx, ny, nz = -cosine * ex, -cosine * ey, -sine
    # check that the contact normal is a normal of the rim
    axial = nx * ax + ny * ay + nz * az
    radial = (nx * ox + ny * oy + nz * oz) / radius if radius > 0.0 else math.sqrt(max(1.0 - axial * axial, 0.0))
    astray = astray_of_rim(first, up, radial, axial, first[SIDE] == 0.0)
    over = max(-along, along - second[SIDE])
    if first[SWEEP] + second[SWEEP] > 0.0:
        # extend the side past its end, until the contact of both rims is valid
        over -= _BEYOND * size
    if not found or (steep and half < 0.0):
        over = size
    wx, wy, wz = forth(axes, (nx, ny, nz))
    px, py, pz = forth(axes, (x, y, z))
    ux, uy, uz = forth(axes, (ox, oy, oz))
    past = max(past_border(over, astray, size), past_depth(own, first, other, second, gap, size))
    write_two(a, out, swap, first, second, gap, past, (wx, wy, wz), (kx + px, ky + py, kz + pz))
    write_side(out, swap, first, part, (own_axes[2], own_axes[5], own_axes[8]), (ux, uy, uz), (wx, wy, wz), radius)
    away = max(away - gap * cosine, 0.0)
    write_side(out, 1.0 - swap, second, FLANK, (axes[2], axes[5], axes[8]), (px, py, pz), (-wx, -wy, -wz), away)


@final
@dataclass(frozen=True)
class RimFlank(ContactKinematics):
    """Contact of one half of a rim, or of the apex, of one body with the side of the other.

    A side that lies across a cap crosses its rim twice, so that there are two contacts, one on either half.

    Attributes
    ----------
    swap : bool
        Whether the rim belongs to the second body.
    first : tuple of float
        The body with the rim (:func:`bodies.shapes.frustum.frustum_numbers`).
    rim : int
        1 for the lower rim, 3 for the upper one or the apex.
    half : float
        1 for the half of the rim to which the other body's axis points, -1 for the other.
    second : tuple of float
        The body with the side.
    size : float
        Size of the bodies [m].
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Frustum, Frustum)

    swap: bool
    first: Numbers
    rim: int
    half: float
    second: Numbers
    size: float

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[ContactKinematics, ...]:
        """Return the contacts of each body's rims, and of the apices of sharp bodies, with the other body's side."""
        assert isinstance(first, Frustum)
        assert isinstance(second, Frustum)
        size = 2.0 * max(first.extent, second.extent)
        one, two = set_back(first), set_back(second)
        pointed = one[SWEEP] + two[SWEEP] == 0.0
        return *cls._of(one, two, size, False, pointed), *cls._of(two, one, size, True, pointed)

    @classmethod
    def _of(cls, own: Numbers, other: Numbers, size: float, swap: bool, pointed: bool) -> tuple[RimFlank, ...]:
        if other[SIDE] == 0.0:
            return ()
        rims = [(LOW_RIM, 1.0), (LOW_RIM, -1.0)]
        if own[SIDE] > 0.0:
            rims += [(HIGH_RIM, 1.0), (HIGH_RIM, -1.0)] if own[1] > 0.0 else [(HIGH_RIM, 1.0)] * pointed
        return tuple(cls(swap, own, rim, half, other, size) for rim, half in rims)

    def parameters(self) -> dict[str, Value]:
        """Return the numbers of both bodies by the names of the evaluator's arguments."""
        return {
            "swap": float(self.swap),
            "first": self.first,
            "rim": float(self.rim),
            "half": self.half,
            "second": self.second,
            "size": self.size,
        }

    @property
    def evaluator(self) -> Callable[..., None]:
        """Newton's method for one angle, between bounds."""
        return _evaluate

    @property
    def features(self) -> tuple[str, ...]:
        """Name of the only pair of features."""
        rim = RIM_NAMES[self.rim]
        return (f"side and {rim}" if self.swap else f"{rim} and side",)
