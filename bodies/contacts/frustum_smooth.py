"""A cylinder, a cone or a disc and a body with a smooth support function.

The nearest points are unique, and the part of the frustum that has one is found by trial: on a cap the normal is
given, on the side it has one angle, found by Newton's method on the support function, on a rim and at the apex it is
that of :func:`bodies.contacts.dual_newton.climb` with a circle or a point.  A stop whose point and normal belong to the
part is a proof that bodies apart have no other.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import ClassVar, TypeAlias, final

from bodies.contacts.curvature import SIDE_A, SIDE_B, write_sweep
from bodies.contacts.dual_newton import climb
from bodies.contacts.frames import point_in_world
from bodies.contacts.frustum import (
    FLANK,
    HIGH_CAP,
    HIGH_RIM,
    LOW_CAP,
    LOW_RIM,
    center_in_world,
    nearest_part,
    part_names,
    part_number,
    write_part,
)
from bodies.contacts.smooth_core import RADIUS, Axes, axes_in_world, back, bend, between_axes, forth, write_core
from bodies.contacts.tangents import write_tangent
from bodies.shapes.frustum import COS, HIGH, LOW, SIDE, SIN, SWEEP, Frustum
from bodies.shapes.smooth_shape import SmoothShape
from bodies.shapes.support_function import gauge_of, support_of
from nonsmooth.compiled import compiled
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

_ON_BORDER = 1e-14
"""How far a point may be over the end of a part, in units of the size, and a normal over that of its cone."""
_SHALLOW = 1e-6
"""Overlap, in units of the size, up to which the first stop is taken without a look at the others."""
_STEPS, _HALVINGS = 60, 40
_ROUND_OFF, _SEEN, _CLOSE, _RIGHT = 2e-16, 1e-14, 1e-12, 1e-13
"""As in :mod:`bodies.contacts.dual_newton`."""
_TURNS = 8
"""Directions round the axis from which every part is tried where none was found from that of the centre."""

Stop: TypeAlias = tuple[float, float, float, float]


@compiled
def _point_against(
    core: Floats, turn: Axes, x: float, y: float, z: float, nx: float, ny: float, nz: float
) -> tuple[float, float, float]:
    """Return the smooth body's farthest point against n, in the axes of the frustum."""
    mx, my, mz = back(turn, -nx, -ny, -nz)
    s = support_of(core, mx, my, mz)
    px, py, pz = forth(turn, s[1], s[2], s[3])
    return x + px, y + py, z + pz


@compiled
def _on_cap(frustum: Floats, core: Floats, turn: Axes, x: float, y: float, z: float, part: int, near: float) -> Stop:
    up = 1.0 if part == HIGH_CAP else -1.0
    radius = frustum[1] if part == HIGH_CAP else frustum[0]
    px, py, pz = _point_against(core, turn, x, y, z, 0.0, 0.0, up)
    if radius == 0.0 or px * px + py * py > (radius + near) * (radius + near):
        return math.nan, 0.0, 0.0, up
    return pz - frustum[HIGH] if part == HIGH_CAP else frustum[LOW] - pz, 0.0, 0.0, up


@compiled
def _on_flank(
    frustum: Floats, core: Floats, turn: Axes, x: float, y: float, z: float, sx: float, sy: float, near: float
) -> Stop:
    """Return gap and normal of the side, by Newton's method on the angle; begin at the direction (sx, sy)."""
    cosine, sine = frustum[COS], frustum[SIN]
    reach = cosine * frustum[0] + sine * frustum[LOW]
    size = near / _ON_BORDER
    length = math.sqrt(sx * sx + sy * sy)
    ex, ey = sx / length, sy / length
    lx, ly, step = ex, ey, 0.0
    g, before, halvings = -math.inf, math.inf, 0
    for _ in range(_STEPS):
        nx, ny = cosine * ex, cosine * ey
        mx, my, mz = back(turn, -nx, -ny, -sine)
        s = support_of(core, mx, my, mz)
        px, py, pz = forth(turn, s[1], s[2], s[3])
        px, py, pz = x + px, y + py, z + pz
        found = nx * px + ny * py + sine * pz - reach
        if found < g - _SEEN * size and halvings < _HALVINGS:
            halvings += 1
            step *= 0.5
        else:
            g, halvings = found, 0
            lx, ly = ex, ey
            rate = cosine * (ex * py - ey * px)
            tx, ty, tz = back(turn, -ey, ex, 0.0)
            second = -cosine * (ex * px + ey * py) - cosine * cosine * bend(s, tx, ty, tz, tx, ty, tz)
            residual = abs(rate)
            if residual <= _ROUND_OFF * size or (residual <= _CLOSE * size and residual >= 0.5 * before):
                away, up = ex * px + ey * py, cosine * (pz - frustum[LOW])
                up -= sine * (ex * px + ey * py - frustum[0])
                if residual > _RIGHT * size or second > 0.0 or away < g * cosine or up < -near:
                    break
                if up > frustum[SIDE] + near:
                    break
                return g, nx, ny, sine
            before = residual
            step = rate / max(abs(second), _ROUND_OFF * size)
            step = min(max(step, -1.0), 1.0)
        # the turn by an angle whose tangent is the step
        ex, ey = lx - step * ly, ly + step * lx
        length = math.sqrt(ex * ex + ey * ey)
        ex, ey = ex / length, ey / length
    return math.nan, cosine * lx, cosine * ly, sine


@compiled
def _on_rim(
    frustum: Floats,
    circle: Floats,
    core: Floats,
    turn: Axes,
    x: float,
    y: float,
    z: float,
    sx: float,
    sy: float,
    part: int,
    tilt: float,
) -> Stop:
    """Return gap and normal of a rim, or of the apex; begin on the side of the direction (sx, sy).

    Begin at the part ``tilt`` of the way from the normal of the side to that of the cap, if it is below 0 at the way
    from the rim to the centre, if that is between these normals.
    """
    up = 1.0 if part == HIGH_RIM else -1.0
    radius, height = (frustum[1], frustum[HIGH]) if part == HIGH_RIM else (frustum[0], frustum[LOW])
    if radius > 0.0:
        # where the centre of the cap is nearest, the normal of the circle is the axis
        for sign in (-1.0, 1.0):
            px, py, pz = _point_against(core, turn, x, y, z, 0.0, 0.0, sign)
            if sign * (pz - height) >= 0.0 and px * px + py * py <= radius * radius:
                return math.nan, 0.0, 0.0, sign
    length = math.sqrt(sx * sx + sy * sy)
    ex, ey = sx / length, sy / length
    flat = frustum[SIDE] == 0.0
    radial, axial = ex * x + ey * y - radius, z - height
    if tilt >= 0.0 or radial <= 0.0 or not (flat or up * (frustum[COS] * axial - frustum[SIN] * radial) > 0.0):
        tilt = abs(tilt)
        cap = math.copysign(1.0, axial) if flat else up
        radial, axial = (1.0 - tilt) * frustum[COS], (1.0 - tilt) * frustum[SIN] + tilt * cap
    g, nx, ny, nz = climb(circle, core, turn, x, y, z - height, 0.0, 0.0, 0.0, radial * ex, radial * ey, axial)
    lean = frustum[COS] * nz - frustum[SIN] * math.sqrt(nx * nx + ny * ny)
    if not flat and up * lean < -_ON_BORDER:
        return math.nan, nx, ny, nz
    return g, nx, ny, nz


@compiled
def _is_before(
    core: Floats, turn: Axes, x: float, y: float, z: float, g: float, nx: float, ny: float, nz: float
) -> bool:
    """Whether the frustum's point lies in the smooth body, whose centre is before the frustum."""
    px, py, pz = _point_against(core, turn, x, y, z, nx, ny, nz)
    px, py, pz = px - g * nx - x, py - g * ny - y, pz - g * nz - z
    if nx * px + ny * py + nz * pz >= 0.0:
        return False
    px, py, pz = back(turn, px, py, pz)
    return bool(gauge_of(core, px, py, pz) < 1.0)


@compiled
def _nearest(
    frustum: Floats, low: Floats, high: Floats, core: Floats, turn: Axes, x: float, y: float, z: float
) -> tuple[float, float, float, float, int]:
    """Return gap of the cores, normal in the frustum's axes, and part; the gap is nan where none was found."""
    size = abs(x) + abs(y) + abs(z) + max(core[0], core[1], core[2]) + frustum[0] + frustum[HIGH] - frustum[LOW]
    near = _ON_BORDER * size
    away = math.sqrt(x * x + y * y)
    sx, sy = (x, y) if away > _CLOSE * size else (1.0, 0.0)
    _, _, _, guess = nearest_part(frustum, z, away)
    best, bx, by, bz, where = math.nan, 0.0, 0.0, 1.0, LOW_CAP
    for start in range(_TURNS + 3):
        # at first by the centre, then steep, flat, and last all round
        tilt = -0.5 if start == 0 else 0.05 if start == 1 else 0.95 if start == 2 else 0.5
        if start > 2:
            # a stop on the far side is none of bodies that are apart
            sx, sy = math.cos(2.0 * math.pi * start / _TURNS), math.sin(2.0 * math.pi * start / _TURNS)
        for i in range(9):
            # the part before which the centre is, and others the nearer first
            part = guess + ((i + 1) // 2 if i % 2 == 1 else -(i // 2))
            rim = part == LOW_RIM or part == HIGH_RIM
            if part < LOW_CAP or part > HIGH_CAP or (frustum[SIDE] == 0.0 and (part == FLANK or part == HIGH_RIM)):
                continue
            if not rim and (start == 1 or start == 2):
                continue
            if part == LOW_CAP or part == HIGH_CAP:
                g, nx, ny, nz = _on_cap(frustum, core, turn, x, y, z, part, near)
            elif part == FLANK:
                g, nx, ny, nz = _on_flank(frustum, core, turn, x, y, z, sx, sy, near)
            else:
                circle = low if part == LOW_RIM else high
                g, nx, ny, nz = _on_rim(frustum, circle, core, turn, x, y, z, sx, sy, part, tilt)
            if g == g and not g <= best:
                best, bx, by, bz, where = g, nx, ny, nz, part
                if g >= -_SHALLOW * size or _is_before(core, turn, x, y, z, g, nx, ny, nz):
                    return best, bx, by, bz, where
    return best, bx, by, bz, where


def _evaluate(a: Floats, b: Floats, out: Floats, first: Floats, low: Floats, high: Floats, second: Floats) -> None:
    """Write the geometry block of a frustum, whose rims are the cores ``low`` and ``high``, and a core.

    The gap is nan where no part can be proved to be the nearest.
    """
    axes_a, axes_b = axes_in_world(a, first), axes_in_world(b, second)
    ax, ay, az = center_in_world(a, first)
    bx, by, bz = point_in_world(b, second[6], second[7], second[8])
    x, y, z = back(axes_a, bx - ax, by - ay, bz - az)
    turn = between_axes(axes_a, axes_b)
    g, nx, ny, nz, part = _nearest(first, low, high, second, turn, x, y, z)
    px, py, pz = _point_against(second, turn, x, y, z, nx, ny, nz)
    out[0] = g - second[RADIUS] - first[SWEEP]
    out[1], out[2], out[3] = forth(axes_a, nx, ny, nz)
    qx, qy, qz = forth(axes_a, px, py, pz)
    out[10], out[11], out[12] = ax + qx, ay + qy, az + qz
    for i in range(3):
        out[10 + i] -= second[RADIUS] * out[1 + i]
        out[7 + i] = out[10 + i] - out[0] * out[1 + i]
    out[29] = part_number(first, part)
    write_tangent(a, out)
    mx, my, mz = back(turn, -nx, -ny, -nz)
    write_core(out, SIDE_B, second, axes_b, mx, my, mz)
    radial = math.sqrt(nx * nx + ny * ny)
    ex, ey = (nx / radial, ny / radial) if radial > 0.0 else (1.0, 0.0)
    ux, uy, uz = forth(axes_a, ex, ey, 0.0)
    away = max(ex * px + ey * py - g * radial, 0.0)
    if part == LOW_RIM or part == HIGH_RIM:
        away = first[0] if part == LOW_RIM else first[1]
    write_part(out, SIDE_A, part, axes_a[2], axes_a[5], axes_a[8], ux, uy, uz, radial, away)
    write_sweep(out, SIDE_A, first[SWEEP])


@final
@dataclass(frozen=True)
class FrustumSmooth(ContactKinematics):
    """One contact of a smooth body with a cap, a rim or the side of a cylinder, a cone or a disc, not with the feet.

    Attributes
    ----------
    first : Frustum
        The cylinder, cone or disc.
    second : SmoothShape
        The smooth body.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Frustum, SmoothShape)

    first: Frustum
    second: SmoothShape

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FrustumSmooth, ...]:
        """Return the single contact of the two.

        Raises
        ------
        InvalidInput
            If the smooth body is boxy.
        """
        assert isinstance(first, Frustum)
        assert isinstance(second, SmoothShape)
        if second.boxy:
            raise InvalidInput(
                f"contact of a {type(first).__name__}",
                "must be with a body whose radii of curvature are finite",
                type(second).__name__,
                "Give the superellipsoid exponents from 1, or a box with a rounding in its place.",
            )
        return (cls(first, second),)

    def parameters(self) -> Mapping[str, Value]:
        """Return the numbers of the frustum, of its rims as flat cores, and of the support function."""
        frustum = self.first.frustum
        # a flat ellipsoid, or a point
        low, high = ((radius, radius, 0.0, 2.0, 2.0, 0.0) for radius in frustum[:2])
        return {"first": frustum, "low": low, "high": high, "second": self.second.core}

    @property
    def evaluator(self) -> Callable[..., None]:
        """A trial of the parts, with Newton's method on the support function."""
        return _evaluate

    @property
    def features(self) -> tuple[str, ...]:
        """From the cap against the axis to the one along it."""
        return tuple(f"{part} and smooth" for part in part_names(self.first.frustum))
