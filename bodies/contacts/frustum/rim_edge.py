"""Contact of an edge that crosses a rim of a cylinder, a cone or a disc.

In the view along the edge, the rim is an ellipse and the edge is a point.  The nearest point of the ellipse is the foot
of a normal to the ellipse through that point.
"""

from __future__ import annotations

import math

from nonsmooth.compiled import block_at, compiled
from nonsmooth.engine.memory.blocks import SIDE_A
from nonsmooth.types import Floats

from ...shapes.frustum import SIDE, SWEEP
from ...vectors import divided, dot, minus, norm, opposite, plus, plus_scaled, scaled
from ..features.polytope_tables import LENGTH, edge_at
from ..features.writing import write_sweep
from ..smooth.smooth_core import axes_in_world, rotated
from .frustum import center_in_world, rim_of, write_part
from .frustum_writing import edge_in_frustum, off_cone_of_edge, off_cone_of_rim, past_end, write_crossing

_STEEP = 0.5
"""Cosine of the angle between edge and axis, above which both contacts are sought on the half nearer to the edge.

The edge is then too steep to cross both halves of the rim.  The contacts divide the directions of the edge among
themselves (:func:`_past_division`).
"""
_STEPS = 100


@compiled
def foot_on_ellipse(semi_x: float, semi_y: float, x: float, y: float) -> tuple[float, float, float]:
    """Return the foot of the normal from (x, y) to the upper half of an ellipse: its cosine and sine, and a check.

    The foot is the point (semi_x cosine, semi_y sine); semi_x is at least semi_y.  The check is 0 if there is a foot
    with a local minimum of the distance, else positive.  A point (x, y) in the lower half-plane has such a foot only if
    it lies within the evolute of the ellipse; the check is then a measure of the distance from the evolute.  The foot
    is the zero of F = a x sin - b y cos - (a^2 - b^2) sin cos, with the semi-axes a and b, between bounds of opposite
    sign, by Newton's method and halvings.
    """
    p, q = semi_x * abs(x), semi_y * y
    focal = max(semi_x * semi_x - semi_y * semi_y, 0.0)
    low, none = 0.0, 0.0
    if q < 0.0:
        third_p, third_q = p ** (1.0 / 3.0), (-q) ** (1.0 / 3.0)
        reach = third_p * third_p + third_q * third_q
        none = max(math.sqrt(reach * reach * reach) - focal, 0.0)
        low = math.atan2(third_q, third_p)
    high = 0.5 * math.pi
    if none > 0.0:
        angle = low
    else:
        angle = math.atan2(max(q, 0.0) * semi_x, p * semi_y) if p + max(q, 0.0) > 0.0 else high
        if q <= 0.0:
            angle = math.acos(min(p / focal, 1.0)) if focal > 0.0 else high
        angle = min(max(angle, low), high)
        for _ in range(_STEPS):
            c, s = math.cos(angle), math.sin(angle)
            value = p * s - q * c - focal * s * c
            slope = p * c + q * s - focal * (c * c - s * s)
            if value > 0.0:
                high = angle
            else:
                low = angle
            after = angle - value / slope if slope > 0.0 else 2.0 * math.pi
            if after < low or after > high:
                after = 0.5 * (low + high)
            if abs(after - angle) <= 2e-16 * abs(angle):
                break
            angle = after
    c, s = math.cos(angle), math.sin(angle)
    return (c if x >= 0.0 else -c), s, none


@compiled
def _past_division(half: float, lean: float, short: float) -> float:
    """Return the sine past the directions of a steep edge that belong to the contact of one ``half``.

    ``lean`` is the component of the edge's unit vector along the outward radius at the crossing, ``short`` the cosine
    of the angle between edge and axis, above ``_STEEP``.  At ``_STEEP`` the limit is at a lean of zero, where the
    crossing is between the two halves, so that a contact keeps its crossing when the edge becomes steep.  An edge along
    the axis is far from the limit: its direction in the plane of the rim, and so its half, would be round-off.
    """
    return -half * (lean + short - _STEEP)


@compiled
def write_edge_across_rim(
    a: Floats,
    b: Floats,
    out: Floats,
    frustum: Floats,
    rim: float,
    half: float,
    edge: Floats,
    radius: float,
    core: Floats,
    is_convex: bool,
    size: float,
) -> None:
    """Write the geometry block of an edge, rounded by ``radius`` [m], that crosses one half of a rim.

    An edge that lies across a cap crosses its rim twice, so that there are two contacts, one on either half.

    Parameters
    ----------
    a, b, out : Floats
        Frame blocks of both bodies, and the geometry block.
    frustum : Floats
        The first body, with its rims set back by its feet (:func:`bodies.contacts.frustum.frustum.set_back`).
    rim : float
        1 for the lower rim, 3 for the upper one.
    half : float
        1 for the half circle towards which the edge points, seen along the axis; -1 for the opposite half circle.  For
        an edge at less than 60 degrees to the axis, both are the half circle nearer to the edge, and one of them has
        the contact.
    edge : Floats
        Row of the edge (:data:`bodies.contacts.features.polytope_tables.EDGE`).
    radius : float
        Radius about the edge [m].
    core, is_convex : Floats, bool
        The core with the edge, which is used if the body is convex.
    size : float
        Size of the bodies [m].
    """
    axes, center = axes_in_world(a, frustum), center_in_world(a, frustum)
    start, d = edge_in_frustum(b, edge, axes, center)
    wide, height, up = rim_of(frustum, rim)
    # g: perpendicular to the edge, in the rim's plane; f: the edge's projection; h: perpendicular to g and the edge
    across = math.sqrt(d[0] * d[0] + d[1] * d[1])
    fx, fy = (d[0] / across, d[1] / across) if across > 0.0 else (1.0, 0.0)
    gx, gy = -fy, fx
    h = (-d[2] * gy, d[2] * gx, d[0] * gy - d[1] * gx)
    short = h[0] * fx + h[1] * fy
    if short < 0.0:
        h, short = opposite(h), -short
    along = start[0] * gx + start[1] * gy
    over_rim = start[0] * h[0] + start[1] * h[1] + (start[2] - height) * h[2]
    # an edge nearly in the plane of the rim can cross both half circles: this contact takes the one given by ``half``
    side = half
    if short > _STEEP:
        side = 1.0 if over_rim >= 0.0 else -1.0
    cosine, sine, none = foot_on_ellipse(wide, wide * short, along, side * over_rim)
    sine *= side
    e = (cosine * gx + sine * fx, cosine * gy + sine * fy, 0.0)
    # the normal is perpendicular to the rim's tangent and to the edge
    n = (e[0] * d[2], e[1] * d[2], -e[1] * d[1] - e[0] * d[0])
    crossing, p = norm(n), (wide * e[0], wide * e[1], height)
    s = dot(minus(p, start), d)
    w = minus(plus_scaled(start, s, d), p)
    total = radius + frustum[SWEEP]
    if total == 0.0 and crossing > 1e-6:
        n = divided(n, crossing)
    else:
        # rounded bodies, or an edge along the rim's tangent: the normal is along the line between both points, or
        # radial if the points coincide
        apart = norm(w)
        n = divided(w, apart) if apart > 1e-9 * size else e
    if total > 0.0:
        # a rounded edge along the tangent touches the rim at a single point, so the crossing is well defined
        crossing = 1.0
    height_over = dot(n, w)
    off_cone, flip = 2.0, 1.0
    for sign in (-1.0, 1.0):
        if total > 0.0 and sign * height_over < 0.0:
            # rounded bodies: the normal must point from the rim to the edge, so skip the opposite sign
            continue
        radial = sign * (e[0] * n[0] + e[1] * n[1])
        off = off_cone_of_rim(frustum, up, radial, sign * n[2], frustum[SIDE] == 0.0)
        off = max(off, off_cone_of_edge(b, edge, axes, scaled(sign, n)))
        if off < off_cone:
            off_cone, flip = off, sign
    n, gap = scaled(flip, n), flip * height_over
    over_end = max(-s, s - edge[LENGTH])
    if short > _STEEP:
        over_end = max(over_end, size * _past_division(half, d[0] * e[0] + d[1] * e[1], short))
    if none > 0.0 or crossing <= 1e-6:
        over_end = size
    past = past_end(a, b, frustum, core, is_convex, gap, over_end, crossing, off_cone, size)
    point = plus(center, rotated(axes, p))
    write_crossing(a, b, out, frustum, axes, edge, radius, is_convex, gap, past, crossing, n, point)
    axis, radial = (axes[2], axes[5], axes[8]), e[0] * n[0] + e[1] * n[1]
    write_part(out, SIDE_A, int(rim), axis, rotated(axes, e), radial, wide)
    write_sweep(out, SIDE_A, frustum[SWEEP])


def evaluate_edge_across_rim(
    a: Floats,
    b: Floats,
    out: Floats,
    frustum: Floats,
    rim: float,
    half: float,
    core: Floats,
    edge: float,
    radius: float,
    size: float,
) -> None:
    """Write the geometry block of an edge of a core, by number, that crosses one half of a rim.

    The other parameters are those of :func:`write_edge_across_rim`.
    """
    row = block_at(core, edge_at(core, edge))
    write_edge_across_rim(a, b, out, frustum, rim, half, row, radius, core, True, size)
