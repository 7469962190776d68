"""Contact of an edge that crosses a rim of a cylinder, a cone or a disc.

In the view along the edge, the rim is an ellipse and the edge is a point.  The nearest point of the ellipse is the foot
of a normal to the ellipse through that point.
"""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import SIDE_A
from nonsmooth.types import Floats

from ...shapes.frustum import SIDE, SWEEP
from ...vectors import divided, dot, minus, norm, opposite, plus, plus_scaled, scaled
from ..features.edge_crossing import PARALLEL
from ..features.edge_row import LENGTH
from ..features.writing import write_sweep
from ..smooth.smooth_core import axes_in_world, rotated
from .frustum import center_in_world, rim_of, write_part
from .frustum_writing import edge_in_frustum, off_cone_of_edge, off_cone_of_rim, past_end, write_crossing

_STEEP = 0.5
"""Cosine of the angle between edge and axis, above which both contacts are searched on the half nearer to the edge.

The edge is then too steep to cross both halves of the rim.  Each contact is valid for its own directions of the edge
(:func:`_past_division`).
"""
_STEPS = 100
"""Largest number of Newton steps; each keeps or narrows the bounds of the angle."""


@compiled
def foot_on_ellipse(semi_x: float, semi_y: float, x: float, y: float) -> tuple[float, float, float]:
    """Return the foot of the normal from (x, y) to the upper half of an ellipse: its cosine and sine, and a check.

    The foot is the point (semi_x cosine, semi_y sine) [m]; semi_x is at least semi_y.  The check is 0 if there is a
    foot with a local minimum of the distance, else positive.  A point (x, y) in the lower half-plane has such a foot
    only if it lies within the evolute of the ellipse, the astroid (a |x|)^(2/3) + (b |y|)^(2/3) = (a^2 - b^2)^(2/3)
    with the semi-axes a and b.  The check [m^2] grows with the distance from the evolute.

    The angle of the foot is the zero of F = a x sin - b y cos - (a^2 - b^2) sin cos, between bounds of opposite sign,
    by Newton's method and halvings.  It is searched for |x|, in the first quadrant.
    """
    p, q = semi_x * abs(x), semi_y * y
    focal_square = max(semi_x * semi_x - semi_y * semi_y, 0.0)
    low, past_evolute = 0.0, 0.0
    if q < 0.0:
        third_p, third_q = p ** (1.0 / 3.0), (-q) ** (1.0 / 3.0)
        sum_of_squares = third_p * third_p + third_q * third_q
        past_evolute = max(math.sqrt(sum_of_squares * sum_of_squares * sum_of_squares) - focal_square, 0.0)
        # F / (sin cos) is least at this angle; if the least value is positive, F has no zero, else the zero is above it
        low = math.atan2(third_q, third_p)
    high = 0.5 * math.pi
    if past_evolute > 0.0:
        # F has no such zero: return the angle at which it is nearest to zero
        angle = low
    else:
        # start at the direction of the point; for y <= 0, at the foot for y = 0
        angle = math.atan2(max(q, 0.0) * semi_x, p * semi_y) if p + max(q, 0.0) > 0.0 else high
        if q <= 0.0:
            angle = math.acos(min(p / focal_square, 1.0)) if focal_square > 0.0 else high
        angle = min(max(angle, low), high)
        for _ in range(_STEPS):
            c, s = math.cos(angle), math.sin(angle)
            value = p * s - q * c - focal_square * s * c
            slope = p * c + q * s - focal_square * (c * c - s * s)
            if value > 0.0:
                high = angle
            else:
                low = angle
            # a zero slope gives an angle out of bounds, so that the step is a halving
            after = angle - value / slope if slope > 0.0 else 2.0 * math.pi
            if after < low or after > high:
                after = 0.5 * (low + high)
            if abs(after - angle) <= 2e-16 * abs(angle):
                break
            angle = after
    c, s = math.cos(angle), math.sin(angle)
    return (c if x >= 0.0 else -c), s, past_evolute


@compiled
def _past_division(half: float, radial: float, axial: float) -> float:
    """Return a sine that is positive if a steep edge belongs to the contact of the other half, not to that of ``half``.

    ``radial`` is the component of the edge's unit vector along the outward radius at the crossing.  ``axial`` is the
    cosine of the angle between edge and axis, above ``_STEEP``.  At ``_STEEP`` the limit is at ``radial`` = 0, where
    the crossing is between the two halves, so that a contact keeps its crossing when the edge becomes steep.  An edge
    along the axis is far from the limit: its direction in the plane of the rim, and so its half, would be round-off.
    """
    return -half * (radial + axial - _STEEP)


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
    is_convex: bool,
    size: float,
) -> None:
    """Write the geometry block of an edge, rounded by ``radius`` [m], that crosses one half of a rim.

    An edge that lies across a cap crosses its rim twice, so that there are two contacts, one on either half.  The
    contact normal is perpendicular to the edge and to the rim.

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
        Row of the edge (:data:`bodies.contacts.surface.surface_tables.EDGE`).
    radius : float
        Radius about the edge [m].
    is_convex : bool
        Whether the body with the edge is convex.
    size : float
        Size of the bodies [m].
    """
    axes, center = axes_in_world(a, frustum), center_in_world(a, frustum)
    start, d = edge_in_frustum(b, edge, axes, center)
    rim_radius, height, up = rim_of(frustum, rim)
    # unit vectors g: perpendicular to the edge, in the rim's plane; f: along the edge's projection on this plane; h:
    # perpendicular to g and the edge. In the view along the edge, g and h are the axes of the rim's ellipse
    across = math.sqrt(d[0] * d[0] + d[1] * d[1])
    fx, fy = (d[0] / across, d[1] / across) if across > 0.0 else (1.0, 0.0)
    gx, gy = -fy, fx
    h = (-d[2] * gy, d[2] * gx, d[0] * gy - d[1] * gx)
    # cosine of the angle between edge and axis: the ellipse's smaller semi-axis over the rim's radius
    axial = h[0] * fx + h[1] * fy
    if axial < 0.0:
        h, axial = opposite(h), -axial
    # the edge in this view: a point with two coordinates from the centre of the ellipse
    along_g = start[0] * gx + start[1] * gy
    along_h = start[0] * h[0] + start[1] * h[1] + (start[2] - height) * h[2]
    # an edge nearly in the plane of the rim can cross both half circles: this contact takes the one given by ``half``
    side = half
    if axial > _STEEP:
        side = 1.0 if along_h >= 0.0 else -1.0
    cosine, sine, past_evolute = foot_on_ellipse(rim_radius, rim_radius * axial, along_g, side * along_h)
    sine *= side
    # e: outward radius of the rim at the crossing
    e = (cosine * gx + sine * fx, cosine * gy + sine * fy, 0.0)
    # the normal is perpendicular to the rim's tangent and to the edge
    n = (e[0] * d[2], e[1] * d[2], -e[1] * d[1] - e[0] * d[0])
    crossing_sine, p = norm(n), (rim_radius * e[0], rim_radius * e[1], height)
    # s: distance of the nearest point along the edge; w: vector from the rim's point to it
    s = dot(minus(p, start), d)
    w = minus(plus_scaled(start, s, d), p)
    total = radius + frustum[SWEEP]
    if total == 0.0 and crossing_sine > PARALLEL:
        n = divided(n, crossing_sine)
    else:
        # rounded bodies, or an edge along the rim's tangent: the normal is along the line between both points, which
        # round-off changes least, or radial if the points coincide
        apart = norm(w)
        n = divided(w, apart) if apart > 1e-9 * size else e
    if total > 0.0:
        # a rounded edge along the tangent touches the rim at a single point, so the crossing is well defined
        crossing_sine = 1.0
    along_normal = dot(n, w)
    # take the sign of the normal that is nearer to the normal cones of rim and edge; 2 exceeds all sines
    off_cone, chosen_sign = 2.0, 1.0
    for sign in (-1.0, 1.0):
        if total > 0.0 and sign * along_normal < 0.0:
            # rounded bodies: the normal must point from the rim to the edge, so skip the opposite sign
            continue
        radial = sign * (e[0] * n[0] + e[1] * n[1])
        off_rim = off_cone_of_rim(frustum, up, radial, sign * n[2], frustum[SIDE] == 0.0)
        off_both = max(off_rim, off_cone_of_edge(b, edge, axes, scaled(sign, n)))
        if off_both < off_cone:
            off_cone, chosen_sign = off_both, sign
    n, gap = scaled(chosen_sign, n), chosen_sign * along_normal
    past_ends = max(-s, s - edge[LENGTH])
    if axial > _STEEP:
        past_ends = max(past_ends, size * _past_division(half, d[0] * e[0] + d[1] * e[1], axial))
    if past_evolute > 0.0 or crossing_sine <= PARALLEL:
        # the rim has no nearest point on this half, or the edge is along its tangent: no valid crossing
        past_ends = size
    past = past_end(past_ends, crossing_sine, off_cone, size)
    point = plus(center, rotated(axes, p))
    write_crossing(a, b, out, frustum, axes, edge, radius, is_convex, gap, past, crossing_sine, n, point)
    axis, radial = (axes[2], axes[5], axes[8]), e[0] * n[0] + e[1] * n[1]
    write_part(out, SIDE_A, int(rim), axis, rotated(axes, e), radial, rim_radius)
    write_sweep(out, SIDE_A, frustum[SWEEP])
