"""Contact of a convex edge of a surface that crosses the side or a rim of a cylinder, a cone or a disc.

The crossing depends on the edge alone.  The rest of the surface decides whether the overlap is real and whether a face
is nearer.  The edge belongs to the second body: a sharp or rounded polyhedron, or a capsule.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import GAP, PAST_END, POINT_A, POINT_B, SIDE_A, SIDE_B
from nonsmooth.types import Floats

from ...shapes.frustum import COS, LOW, LOW_RADIUS, SIDE, SIN
from ...shapes.frustum import SWEEP as FRUSTUM_SWEEP
from ...vectors import (
    Vector3,
    divided,
    dot,
    minus,
    norm,
    opposite,
    plus,
    plus_scaled,
    scaled,
    vector_at,
    write_vector,
)
from ..features.edge_crossing import PARALLEL, sine_off_cone
from ..features.edge_row import ALONG, LENGTH, START, Edge
from ..features.ends import CLOSED, gap_past_end
from ..features.frames import across, point_in_body, point_in_world, vector_in_world
from ..features.writing import write_contact, write_principal, write_sweep
from ..smooth.smooth_core import Axes, axes_in_world, rotated, rotated_back
from ..surface.overlap_corners import FLUSH
from ..surface.surface_search import past_edge, signed_distance
from ..surface.surface_tables import IS_CONVEX, N_TRIANGLES, SWEEP, edge_at
from .circle import zero_of_slope
from .frustum import FLANK, center_in_world, nearest_part, rim_of, write_part
from .frustum_writing import off_cone_of_rim, past_border
from .over_faces import frustum_in_surface, past_faces

_STEEP = 0.5
"""Cosine of the angle between edge and axis, above which both contacts are searched on the half nearer to the edge.

The edge is then too steep to cross both halves of the rim.  Each contact is valid for its own directions of the edge.
"""
_CONE_MARGIN = 1e-6
"""Sine of the largest angle between a contact normal and the edge's normal cone; if it is larger, a face is nearer."""


class _Edge(NamedTuple):
    """An edge seen from a frustum: in the axes of the frustum, from its centre."""

    axes: Axes
    """Axes of the frustum in the world."""
    center: Vector3
    """Centre of the frustum in the world [m]."""
    start: Vector3
    """First end of the edge [m]."""
    along: Vector3
    """Unit vector along the edge."""


class _Crossing(NamedTuple):
    """Crossing of an edge and a frustum's core; vectors are in the axes of the frustum, from its centre."""

    distance: float
    """Distance of the edge from the core, along the normal [m]."""
    past_ends: float
    """Distance past the ends of the edge and of the side [m]."""
    off_cone: float
    """Sine of the angle between the normal and the normal cone of the rim or side."""
    sine: float
    """Sine of the angle between both features."""
    normal: Vector3
    """Normal from the frustum to the edge."""
    point: Vector3
    """Contact point on the core [m]."""
    outward: Vector3
    """Unit vector from the axis towards the point."""
    away: float
    """Distance of the point from the axis [m]."""


@compiled
def _seen_from(a: Floats, frustum: Floats, b: Floats, edge: Floats) -> _Edge:
    """Return an edge, by its row, seen from a frustum."""
    axes, center = axes_in_world(a, frustum), center_in_world(a, frustum)
    start = rotated_back(axes, minus(point_in_world(b, vector_at(edge, START)), center))
    return _Edge(axes, center, start, rotated_back(axes, vector_in_world(b, vector_at(edge, ALONG))))


@compiled
def _cross_side(frustum: Floats, seen: _Edge, length: float, size: float) -> _Crossing:
    """Return the crossing of an edge and the side of a frustum.

    The contact normal is a normal of the side and perpendicular to the edge.  Two such normals exist, mirror images in
    the plane along edge and axis; bodies apart are separated along the one with the larger gap.
    """
    (vx, vy, vz), (dx, dy, dz) = seen.start, seen.along
    cosine, sine = frustum[COS], frustum[SIN]
    # distance of the side's tangent planes from the centre
    support = cosine * frustum[LOW_RADIUS] + sine * frustum[LOW]
    # n = (cosine e, sine), with the direction e from the axis. It is perpendicular to the edge if
    # cosine (d . e) + sine d_z = 0: the cosine of the angle from f, the edge's direction seen along the axis, to e
    across_axis = math.sqrt(dx * dx + dy * dy)
    if across_axis > 0.0:
        fx, fy = dx / across_axis, dy / across_axis
        e_cosine = -sine * dz / (cosine * across_axis)
    else:
        # an edge parallel to the axis is perpendicular to all normals of a cylinder, to none of a cone
        fx, fy, e_cosine = 1.0, 0.0, 0.0 if sine == 0.0 else -math.copysign(2.0, sine * dz)
    e_f = min(max(e_cosine, -1.0), 1.0)
    e_g = math.sqrt(1.0 - e_f * e_f)
    gap, ex, ey = -math.inf, 1.0, 0.0
    for sign in (-1.0, 1.0):
        gx, gy = e_f * fx - sign * e_g * fy, e_f * fy + sign * e_g * fx
        height = cosine * (gx * vx + gy * vy) + sine * vz - support
        if height > gap:
            gap, ex, ey = height, gx, gy
    # s: distance along the edge of its point in the direction e from the axis; the middle if the edge lies in a plane
    # through the axis
    crossing = dy * ex - dx * ey
    s = 0.5 * length
    if abs(crossing) > PARALLEL:
        s = -(vy * ex - vx * ey) / crossing
    p, n = plus_scaled(seen.start, s, seen.along), (cosine * ex, cosine * ey, sine)
    # coordinates of the contact point on the side: distance from the axis, and along the side from the lower rim
    away = ex * p[0] + ey * p[1] - gap * cosine
    up = cosine * (p[2] - gap * n[2] - frustum[LOW]) - sine * (away - frustum[LOW_RADIUS])
    past_ends = max(max(-s, s - length), max(-up, up - frustum[SIDE]))
    if abs(e_cosine) > 1.0 or abs(crossing) <= PARALLEL:
        # no normal of the side is perpendicular to the edge, or the edge is parallel to the side: no valid crossing
        past_ends = size
    point = plus_scaled(p, -gap, n)
    return _Crossing(gap, past_ends, -1.0, abs(crossing), n, point, (ex, ey, 0.0), max(away, 0.0))


@compiled
def _normal_of_ellipse(given: tuple[float, float, float], angle: float) -> tuple[float, float, float]:
    """Return 0, the function F of :func:`foot_on_ellipse` and its derivative by the angle [m^2]."""
    p, q, focal_square = given
    c, s = math.cos(angle), math.sin(angle)
    return 0.0, p * s - q * c - focal_square * s * c, p * c + q * s - focal_square * (c * c - s * s)


@compiled
def foot_on_ellipse(semi_x: float, semi_y: float, x: float, y: float) -> tuple[float, float, float]:
    """Return the foot of the normal from (x, y) to the upper half of an ellipse: its cosine and sine, and a check.

    The foot is the point (semi_x cosine, semi_y sine) [m]; semi_x is at least semi_y.  The check is 0 if there is a
    foot with a local minimum of the distance, else positive.  A point (x, y) in the lower half-plane has such a foot
    only if it lies within the evolute of the ellipse, the astroid (a |x|)^(2/3) + (b |y|)^(2/3) = (a^2 - b^2)^(2/3)
    with the semi-axes a and b.  The check [m^2] grows with the distance from the evolute.

    The angle of the foot is the zero of F = a x sin - b y cos - (a^2 - b^2) sin cos.  It is searched for |x|, in the
    first quadrant.
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
    angle, high = low, 0.5 * math.pi
    if past_evolute == 0.0:
        # start at the direction of the point; for y <= 0, at the foot for y = 0
        angle = math.atan2(max(q, 0.0) * semi_x, p * semi_y) if p + max(q, 0.0) > 0.0 else high
        if q <= 0.0:
            angle = math.acos(min(p / focal_square, 1.0)) if focal_square > 0.0 else high
        angle = min(max(angle, low), high)
        angle = zero_of_slope(_normal_of_ellipse, (p, q, focal_square), angle, low, high)
    c, s = math.cos(angle), math.sin(angle)
    return (c if x >= 0.0 else -c), s, past_evolute


@compiled
def _cross_rim(
    frustum: Floats, rim: float, half: float, b: Floats, edge: Floats, seen: _Edge, is_rounded: bool, size: float
) -> _Crossing:
    """Return the crossing of an edge and one half of a rim.

    In the view along the edge, the rim is an ellipse and the edge is a point.  The nearest point of the ellipse is the
    foot of a normal to the ellipse through that point.  The contact normal is perpendicular to the edge and to the rim.
    """
    start, d = seen.start, seen.along
    rim_radius, height, up = rim_of(frustum, rim)
    # unit vectors g: perpendicular to the edge, in the rim's plane; f: along the edge's projection on this plane; h:
    # perpendicular to g and the edge. In the view along the edge, g and h are the axes of the rim's ellipse
    across_axis = math.sqrt(d[0] * d[0] + d[1] * d[1])
    fx, fy = (d[0] / across_axis, d[1] / across_axis) if across_axis > 0.0 else (1.0, 0.0)
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
    if not is_rounded and crossing_sine > PARALLEL:
        n = divided(n, crossing_sine)
    else:
        # rounded bodies, or an edge along the rim's tangent: the normal is along the line between both points, which
        # round-off changes least, or radial if the points coincide
        apart = norm(w)
        n = divided(w, apart) if apart > 1e-9 * size else e
    if is_rounded:
        # a rounded edge along the tangent touches the rim at a single point, so the crossing is well defined
        crossing_sine = 1.0
    along_normal = dot(n, w)
    # take the sign of the normal that is nearer to the normal cones of rim and edge; 2 exceeds all sines
    least_off, off_cone, chosen_sign = 2.0, 2.0, 1.0
    for sign in (-1.0, 1.0):
        if is_rounded and sign * along_normal < 0.0:
            # rounded bodies: the normal must point from the rim to the edge, so skip the opposite sign
            continue
        off_rim = off_cone_of_rim(frustum, up, sign * (e[0] * n[0] + e[1] * n[1]), sign * n[2])
        off_both = max(off_rim, sine_off_cone(Edge(b, edge), -1.0, rotated(seen.axes, scaled(sign, n))))
        if off_both < least_off:
            least_off, off_cone, chosen_sign = off_both, off_rim, sign
    past_ends = max(-s, s - edge[LENGTH])
    if axial > _STEEP:
        # a steep edge belongs to one half, by its component along the outward radius. At _STEEP the limit is between
        # the two halves, so that a contact keeps its crossing when the edge becomes steep. An edge along the axis is
        # far from the limit: its direction in the plane of the rim would be round-off
        past_ends = max(past_ends, -size * half * (d[0] * e[0] + d[1] * e[1] + axial - _STEEP))
    if past_evolute > 0.0 or crossing_sine <= PARALLEL:
        # the rim has no nearest point on this half, or the edge is along its tangent: no valid crossing
        past_ends = size
    distance, n = chosen_sign * along_normal, scaled(chosen_sign, n)
    return _Crossing(distance, past_ends, off_cone, crossing_sine, n, p, e, rim_radius)


@compiled
def _past_bodies(b: Floats, out: Floats, frustum: Floats, seen: _Edge, surface: Floats, size: float) -> float:
    """Return by how far both contact points of a crossing are outside of the other body [m]; positive: no overlap.

    The frustum belongs to the first body, the surface to the second one; ``out`` is the geometry block.  If flush
    faces are pressed into each other, the points lie on the surface of the other body: the margin is that of round-off,
    ``CLOSED``, and of the angle ``FLUSH`` of such faces.
    """
    margin, point = CLOSED * size - FLUSH * out[GAP], point_in_body(b, vector_at(out, POINT_A))
    if surface[N_TRIANGLES] == 0.0:
        _, nearest = past_edge(edge_at(surface, 0), point)
        outside = norm(minus(point, nearest))
    else:
        outside = signed_distance(surface, point)
    outside -= surface[SWEEP]
    if outside > margin:
        axis = (seen.axes[2], seen.axes[5], seen.axes[8])
        along, away, _ = across(minus(vector_at(out, POINT_B), seen.center), axis)
        outside = min(outside, nearest_part(frustum, along, away)[0] - frustum[FRUSTUM_SWEEP])
    return float(outside - margin)


@compiled
def _write_crossing(
    a: Floats,
    b: Floats,
    out: Floats,
    frustum: Floats,
    part: int,
    edge: Floats,
    surface: Floats,
    seen: _Edge,
    crossing: _Crossing,
    size: float,
) -> None:
    """Write the geometry block of the crossing of an edge with a ``part`` of a frustum.

    The point of crossing moves up to 1 / sine times as fast as the bodies, with the sine of the angle between both
    features.  Past the boundary, the gap is therefore hypot(gap, sine * past): its rate stays of the order of the
    bodies' velocities.  A negative gap is kept if the surface is convex
    (:func:`bodies.contacts.features.ends.gap_past_end`).

    The contact is open in two more cases:

    - The cores are apart or overlap by less than the margin ``CLOSED``, and the contact normal is outside of the edge's
      normal cone: a face is nearer, and has its own contact with the frustum.
    - The cores overlap by more, but neither contact point is inside of the other body, so that they do not overlap
      there, or a face is less deep (:func:`bodies.contacts.frustum.over_faces.past_faces`).
    """
    axes, radius, sweep, is_convex = seen.axes, surface[SWEEP], frustum[FRUSTUM_SWEEP], surface[IS_CONVEX] == 1.0
    normal, outward = rotated(axes, crossing.normal), rotated(axes, crossing.outward)
    off_cone = sine_off_cone(Edge(b, edge), -1.0, normal)
    past = past_border(crossing.past_ends, max(crossing.off_cone, off_cone), size)
    # features that are parallel have no definite point of crossing
    past = max(past, size * (PARALLEL - crossing.sine))
    gap = gap_past_end(crossing.distance - radius - sweep, max(PARALLEL, crossing.sine) * past, is_convex)
    point = plus_scaled(plus(seen.center, rotated(axes, crossing.point)), sweep, normal)
    write_contact(a, out, gap, past, 0.0, normal, point, False)
    write_part(out, SIDE_A, part, (axes[2], axes[5], axes[8]), outward, dot(normal, outward), crossing.away)
    write_sweep(out, SIDE_A, sweep)
    write_principal(out, SIDE_B, vector_in_world(b, vector_at(edge, ALONG)), 0.0, 1.0, 1.0, radius)
    if past > 0.0:
        return
    if gap + sweep + radius >= -CLOSED * size:
        past = size * (off_cone - _CONE_MARGIN)
    else:
        past = max(
            _past_bodies(b, out, frustum, seen, surface, size),
            past_faces(surface, frustum_in_surface(a, b, frustum), -gap, point_in_body(b, point)),
        )
    if past > 0.0:
        out[GAP], out[PAST_END] = gap_past_end(gap, past, is_convex), past
        write_vector(out, POINT_B, plus_scaled(point, out[GAP], normal))


@compiled
def write_across_side(
    a: Floats, b: Floats, out: Floats, frustum: Floats, edge: Floats, surface: Floats, size: float
) -> None:
    """Write the geometry block of an edge of a surface, by its row ``edge``, that crosses the side of a frustum."""
    seen = _seen_from(a, frustum, b, edge)
    crossing = _cross_side(frustum, seen, edge[LENGTH], size)
    _write_crossing(a, b, out, frustum, FLANK, edge, surface, seen, crossing, size)


@compiled
def write_across_rim(
    a: Floats,
    b: Floats,
    out: Floats,
    frustum: Floats,
    rim: float,
    half: float,
    edge: Floats,
    surface: Floats,
    size: float,
) -> None:
    """Write the geometry block of an edge of a surface, by its row ``edge``, that crosses one half of a rim.

    An edge that lies across a cap crosses its rim twice, so that there are two contacts, one on either half.  The rims
    are set back by the feet (:func:`bodies.contacts.frustum.frustum.set_back`); ``rim`` is 1 for the lower rim, 3 for
    the upper one.  ``half`` is 1 for the half circle towards which the edge points, seen along the axis; -1 for the
    opposite half circle.  For an edge at less than 60 degrees to the axis, both are the half circle nearer to the edge,
    and one of them has the contact.
    """
    seen, is_rounded = _seen_from(a, frustum, b, edge), surface[SWEEP] + frustum[FRUSTUM_SWEEP] > 0.0
    crossing = _cross_rim(frustum, rim, half, b, edge, seen, is_rounded, size)
    _write_crossing(a, b, out, frustum, int(rim), edge, surface, seen, crossing, size)
