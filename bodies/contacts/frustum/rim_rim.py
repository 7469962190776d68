"""Contact of two frustums where their rims cross each other.

The line from a point of the first circle to the nearest point of the second circle is perpendicular to the second.  If
it is perpendicular to the first as well, its ends are the nearest points.  Samples of the first circle bracket such a
point, then Newton's method between bounds finds it.
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
from ..features.edge_crossing import PARALLEL
from ..features.flat_rim import FLATTEST
from ..features.frames import across
from ..features.polytope_tables import Numbers
from ..features.vertex_face import CLOSED, REACH
from ..smooth.smooth_core import axes_in_world, back, forth
from .frustum import FLANK, HIGH_RIM, LOW_RIM, RIM_NAMES, center_in_world, set_back
from .frustum_writing import astray_of_rim, past_border, past_depth, write_side, write_two

_BOTH = 1e-9
"""Overlap of the two halves of the first rim at the line of centres [rad]; no crossing is missed between the halves."""
_ASIDE = 1e-11
"""Least offset of the common normal of two rounded rims from a side's normal, relative to the size of the bodies.

The offset [m] is the distance of the rims' cores, times the sine of the angle between their common normal and the
normal of a side, the smaller one of both sides.  At a smaller offset, the contact of a rim with a side replaces this
contact.
"""
_SAMPLES, _LEVELS, _STEPS = 16, 3, 60
"""Intervals into which half of a rim is sampled, most rounds of sampling, most Newton steps."""


@compiled
def _slope(
    wide: float, radius: float, middle: Vector3, g: Vector3, h: Vector3, angle: float
) -> tuple[float, float, float]:
    """Return the squared distance of a point of one circle from another circle [m^2], its slope and its curvature.

    The first circle has the centre ``middle``; its point at ``angle`` is middle + radius (g cos(angle) + h sin(angle)),
    with the perpendicular unit vectors ``g`` and ``h``.  The other circle lies round the origin in the plane z = 0,
    with the radius ``wide`` [m].  The slope [m] is the derivative of the squared distance by the angle, over 2
    ``radius``.  The curvature [m] is the derivative of the slope by the angle.
    """
    (cx, cy, cz), (gx, gy, gz), (hx, hy, hz) = middle, g, h
    c, s = math.cos(angle), math.sin(angle)
    ux, uy, uz = c * gx + s * hx, c * gy + s * hy, c * gz + s * hz
    tx, ty, tz = c * hx - s * gx, c * hy - s * gy, c * hz - s * gz
    x, y, z = cx + radius * ux, cy + radius * uy, cz + radius * uz
    away = max(math.sqrt(x * x + y * y), 1e-300)
    square = (away - wide) * (away - wide) + z * z
    part = 1.0 - wide / away
    around = x * tx + y * ty
    slope = part * around + z * tz
    bend = part * (radius * (tx * tx + ty * ty) - x * ux - y * uy) + radius * tz * tz - z * uz
    return square, slope, bend + wide / (away * away * away) * radius * around * around


@compiled
def _link_depth(wide: float, radius: float, center: Vector3, g: Vector3, h: Vector3) -> float:
    """Return how deep one circle lies inside of another one with which it is linked like the links of a chain [m].

    The first circle then crosses the plane of the second at two points, and exactly one of them is inside the second.
    The result is the distance of this point from the second circle, or 0 if the circles are not linked.  The second
    circle has the radius ``wide`` [m], about the origin in the plane z = 0.  The first has the given centre [m] and
    ``radius`` [m] in the plane of the perpendicular unit vectors g and h.
    """
    (cx, cy, cz), (gx, gy, gz), (hx, hy, hz) = center, g, h
    size = radius * math.sqrt(gz * gz + hz * hz)
    if abs(cz) >= size:
        return 0.0
    middle, turn = math.atan2(hz, gz), math.acos(-cz / size)
    least, most = math.inf, -math.inf
    for sign in (-1.0, 1.0):
        c, s = radius * math.cos(middle + sign * turn), radius * math.sin(middle + sign * turn)
        depth = wide - math.hypot(cx + c * gx + s * hx, cy + c * gy + s * hy)
        least, most = min(least, depth), max(most, depth)
    return most if least < 0.0 < most else 0.0


def _evaluate(
    a: Floats,
    b: Floats,
    out: Floats,
    first: Floats,
    rim_a: float,
    second: Floats,
    rim_b: float,
    half: float,
    size: float,
) -> None:
    own_axes, axes = axes_in_world(a, first), axes_in_world(b, second)
    ox, oy, oz = center_in_world(a, first)
    kx, ky, kz = center_in_world(b, second)
    up_a, up_b = (1.0 if rim_a > 2.0 else -1.0), (1.0 if rim_b > 2.0 else -1.0)
    radius, height = (first[1], first[HIGH]) if rim_a > 2.0 else (first[0], first[LOW])
    wide, level = (second[1], second[HIGH]) if rim_b > 2.0 else (second[0], second[LOW])
    # centre of the first rim, from the centre of the second, and axis of the first, in the axes of the second body
    cx, cy, cz = back(axes, (ox - kx, oy - ky, oz - kz))
    ax, ay, az = back(axes, (own_axes[2], own_axes[5], own_axes[8]))
    cx, cy, cz = cx + height * ax, cy + height * ay, cz + height * az - level
    # g: unit vector in the plane of the first rim, towards the second rim's centre; h: perpendicular to it
    _, _, (gx, gy, gz) = across((-cx, -cy, -cz), (ax, ay, az))
    hx, hy, hz = half * (ay * gz - az * gy), half * (az * gx - ax * gz), half * (ax * gy - ay * gx)
    low, high = -_BOTH, math.pi + _BOTH
    begin, step, angle = low, (high - low) / _SAMPLES, low
    for _ in range(_LEVELS):
        best, curved, chosen = math.inf, 0.0, 0
        for i in range(_SAMPLES + 1):
            square, _, bend = _slope(wide, radius, (cx, cy, cz), (gx, gy, gz), (hx, hy, hz), begin + i * step)
            if square < best:
                best, curved, chosen = square, bend, i
        angle = begin + chosen * step
        if curved > 0.0 or low + 0.5 * step < angle < high - 0.5 * step:
            break
        # circles that cross close to the line of centres have a maximal distance on this line: refine next to it
        begin = low if angle < 1.0 else high - step
        step /= _SAMPLES
    least, most = angle - step, angle + step
    for _ in range(_STEPS):
        _, slope, bend = _slope(wide, radius, (cx, cy, cz), (gx, gy, gz), (hx, hy, hz), angle)
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
    total = first[SWEEP] + second[SWEEP]
    are_discs = total == 0.0 and first[SIDE] == 0.0 and second[SIDE] == 0.0
    # discs in one plane touch on the line of centres, where their rims are parallel; other discs cross or pass by
    is_edge_to_edge = are_discs and ax * ax + ay * ay <= CLOSED and abs(cz + radius * gz) <= CLOSED * size
    if is_edge_to_edge:
        angle = 0.0
    c, s = math.cos(angle), math.sin(angle)
    ux, uy, uz = c * gx + s * hx, c * gy + s * hy, c * gz + s * hz
    tx, ty, tz = c * hx - s * gx, c * hy - s * gy, c * hz - s * gz
    x, y, z = cx + radius * ux, cy + radius * uy, cz + radius * uz
    away = math.sqrt(x * x + y * y)
    ex, ey = (x / away, y / away) if away > 0.0 else (1.0, 0.0)
    wx, wy, wz = wide * ex - x, wide * ey - y, -z
    # normal: cross product of both tangents; the tangent of the second circle is (-ey, ex, 0)
    nx, ny, nz = -tz * ex, -tz * ey, tx * ex + ty * ey
    crossing = math.sqrt(nx * nx + ny * ny + nz * nz)
    apart = math.sqrt(wx * wx + wy * wy + wz * wz)
    # rounded rims that lie on each other along the whole circle are left to the contacts of rims over caps
    is_ring = total > 0.0 and crossing <= PARALLEL and math.sqrt(wx * wx + wy * wy) < FLATTEST * apart
    if total > 0.0 and apart > 1e-9 * size:
        # the normal of cores that are apart is the line between their points, also for parallel tangents
        nx, ny, nz, crossing = wx / apart, wy / apart, wz / apart, 1.0
    elif is_edge_to_edge or crossing <= PARALLEL:
        nx, ny, nz, crossing = ux, uy, uz, 1.0 if is_edge_to_edge else 0.0
    else:
        nx, ny, nz = nx / crossing, ny / crossing, nz / crossing
    astray, flip = 3.0, 1.0
    for sign in (-1.0, 1.0):
        if total > 0.0 and sign * (nx * wx + ny * wy + nz * wz) < 0.0:
            continue
        radial, axial = sign * (nx * ux + ny * uy + nz * uz), sign * (nx * ax + ny * ay + nz * az)
        off = astray_of_rim(first, up_a, radial, axial, first[SIDE] == 0.0)
        radial = -sign * (nx * ex + ny * ey)
        off = max(off, astray_of_rim(second, up_b, radial, -sign * nz, second[SIDE] == 0.0))
        if off < astray:
            astray, flip = off, sign
    nx, ny, nz = flip * nx, flip * ny, flip * nz
    gap = nx * wx + ny * wy + nz * wz
    past = past_border(-size, astray, size)
    # sines of the angles between the contact normal and the normals of the two sides; a disc has no side
    radial, axial = nx * ux + ny * uy + nz * uz, nx * ax + ny * ay + nz * az
    lean = up_a * (first[COS] * axial - first[SIN] * radial) if first[SIDE] > 0.0 else 1.0
    other = -up_b * (second[COS] * nz - second[SIN] * (nx * ex + ny * ey)) if second[SIDE] > 0.0 else 1.0
    if total > 0.0:
        # if the normal is close to a side's normal, the contact of a rim over the side applies
        past = max(past, _ASIDE * size - apart * min(lean, other))
    elif crossing * crossing <= REACH and crossing * max(abs(lean), abs(other)) <= PARALLEL:
        # the normal of nearly parallel rims has an error; if it may be the normal of both sides, the sides touch
        past = max(past, size)
    # there is no minimum within this half of the rim, or Newton's method did not find it
    none = angle < low or angle > high or abs(wx * tx + wy * ty + wz * tz) > 1e-12 * size or crossing <= PARALLEL
    none = none or is_ring
    if none or (is_edge_to_edge and half < 0.0):
        past = max(past, size)
    if gap < 0.0:
        past = max(past, size * (astray - PARALLEL))
    if not is_edge_to_edge:
        past = max(past, past_depth(a, first, b, second, gap, size))
    if are_discs and gap < 0.0 and not is_edge_to_edge:
        # discs overlap at a crossing only if they are linked there; one lies at least so deep inside of the other
        linked = _link_depth(wide, radius, (cx, cy, cz), (gx, gy, gz), (hx, hy, hz))
        past = max(past, crossing * (-0.5 * gap - REACH * size) - linked)
    wx, wy, wz = forth(axes, (nx, ny, nz))
    px, py, pz = forth(axes, (x, y, z + level))
    ux, uy, uz = forth(axes, (ux, uy, uz))
    vx, vy, vz = forth(axes, (ex, ey, 0.0))
    px, py, pz = kx + px, ky + py, kz + pz
    write_two(a, out, 0.0, first, second, gap, past, (wx, wy, wz), (px, py, pz))
    write_side(out, 0.0, first, LOW_RIM, (own_axes[2], own_axes[5], own_axes[8]), (ux, uy, uz), (wx, wy, wz), radius)
    # of two discs edge to edge, the second rim has the curvature of a cylinder's side: so the normal stays radial while
    # one edge slips over the other
    part = FLANK if is_edge_to_edge else LOW_RIM
    write_side(out, 1.0, second, part, (axes[2], axes[5], axes[8]), (vx, vy, vz), (-wx, -wy, -wz), wide)


@final
@dataclass(frozen=True)
class RimRim(ContactKinematics):
    """Contact at the crossing of a rim of each body, on one side of the line of the rims' centres.

    Attributes
    ----------
    first, second : tuple of float
        The bodies (:func:`bodies.shapes.frustum.frustum_numbers`).
    rim_a, rim_b : int
        1 for the lower rim, 3 for the upper one.
    half : float
        1 or -1, for the half circle of the first rim on one side or the other of the line of centres.
    size : float
        Size of the bodies [m].
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Frustum, Frustum)

    first: Numbers
    rim_a: int
    second: Numbers
    rim_b: int
    half: float
    size: float

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[ContactKinematics, ...]:
        """Return the contacts of all rims of one body with all rims of the other; an apex is not a rim."""
        assert isinstance(first, Frustum)
        assert isinstance(second, Frustum)
        # flat faces stand on their feet, not on rims in the same plane
        one, two = set_back(first), set_back(second)
        rims = [
            [LOW_RIM, HIGH_RIM] if numbers[SIDE] > 0.0 and numbers[1] > 0.0 else [LOW_RIM] for numbers in (one, two)
        ]
        size = 2.0 * max(first.extent, second.extent)
        return tuple(cls(one, i, two, j, half, size) for i in rims[0] for j in rims[1] for half in (1.0, -1.0))

    def parameters(self) -> dict[str, Value]:
        """Return the numbers of both frustums, the rim of each, and the half circle of the first rim to search."""
        return {
            "first": self.first,
            "rim_a": float(self.rim_a),
            "second": self.second,
            "rim_b": float(self.rim_b),
            "half": self.half,
            "size": self.size,
        }

    @property
    def evaluator(self) -> Callable[..., None]:
        """Newton's method for one angle, between bounds."""
        return _evaluate

    @property
    def features(self) -> tuple[str, ...]:
        """Name of the only pair of features, a rim of each body."""
        return (f"{RIM_NAMES[self.rim_a]} and {RIM_NAMES[self.rim_b]}",)
