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

from ...shapes.frustum import SWEEP as FRUSTUM_SWEEP
from ...vectors import (
    Vector3,
    cross,
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
from ..features.edge_vertex import LENGTH, Edge, direction_of, start_of
from ..features.ends import CLOSED, gap_past_end
from ..features.frames import across, point_in_body
from ..features.writing import write_contact, write_principal
from ..surface.overlap_corners import FLUSH
from ..surface.surface_search import past_edge, signed_distance
from ..surface.surface_tables import IS_CONVEX, N_TRIANGLES, SWEEP, Solid, edge_at
from .circle import zero_of_slope
from .crossings import Side, cross_sides, side_of
from .frustum import FLANK, rim_of
from .frustum_placed import Placed, from_core, placed
from .frustum_writing import Spot, off_cone_of_rim, past_border, write_spot
from .over_faces import frustum_in_surface, past_faces

_STEEP = 0.5
"""Cosine of the angle between edge and axis, above which both contacts are searched on the half nearer to the edge.

The edge is then too steep to cross both halves of the rim.  Each contact is valid for its own directions of the edge.
"""
_CONE_MARGIN = 1e-6
"""Sine of the largest angle between a contact normal and the edge's normal cone; if it is larger, a face is nearer."""


class _Crossing(NamedTuple):
    """Crossing of an edge and a part of a frustum's core; vectors are in the world."""

    spot: Spot
    """Contact point on the core."""
    point: Vector3
    """The same point [m]."""
    normal: Vector3
    """Normal from the frustum to the edge."""
    distance: float
    """Distance of the edge from the core, along the normal [m]."""
    past_ends: float
    """Distance past the ends of the edge and of the side [m]."""
    off_cone: float
    """Sine of the angle between the normal and the normal cones of rim and edge; negative inside of both."""
    sine: float
    """Sine of the angle between both features."""


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
    foot with a local minimum of the distance, else positive, and the angle means nothing.  A point (x, y) in the lower
    half-plane has such a foot only if it lies within the evolute of the ellipse, the astroid (a |x|)^(2/3) +
    (b |y|)^(2/3) = (a^2 - b^2)^(2/3) with the semi-axes a and b.  The check [m^2] grows with the distance from the
    evolute.

    Half of the derivative of the squared distance by the angle is F = a x sin - b y cos - (a^2 - b^2) sin cos.  At the
    foot F is zero and rises.  It is searched for |x|, in the first quadrant.
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
        angle = zero_of_slope(_normal_of_ellipse, (p, q, focal_square), 0.5 * (low + high), low, high)
    c, s = math.cos(angle), math.sin(angle)
    return (c if x >= 0.0 else -c), s, past_evolute


@compiled
def _off_cones(of_rim: Spot, edge: Edge, n: Vector3) -> float:
    """Return the sine of the angle between a normal n and the normal cones of a rim and of an edge, the larger one.

    n leads from the rim to the edge; the sine is negative inside of both cones.
    """
    return max(off_cone_of_rim(of_rim, n), sine_off_cone(edge, -1.0, n))


@compiled
def _cross_rim(frustum: Placed, rim: float, half: float, edge: Edge, is_round: bool, size: float) -> _Crossing:
    """Return the crossing of an edge and one half of a rim; ``is_round`` if one of the bodies is rounded.

    In the view along the edge, the rim is an ellipse and the edge is a point.  The nearest point of the ellipse is the
    foot of a normal to the ellipse through that point.  The contact normal is perpendicular to the edge and to the rim.
    The other arguments are those of :func:`write_across_rim`.
    """
    (numbers, center, axis), d = frustum, direction_of(edge)
    radius, height, _ = rim_of(numbers, rim)
    middle = plus_scaled(center, height, axis)
    start = minus(start_of(edge), middle)
    # unit vectors f: along the edge's projection on the plane of the rim; g: perpendicular to the edge, in this plane;
    # h: perpendicular to g and the edge. In the view along the edge, g and h are the axes of the rim's ellipse
    _, _, f = across(d, axis)
    g = cross(axis, f)
    h = cross(d, g)
    # cosine of the angle between edge and axis: the ellipse's smaller semi-axis over the rim's radius
    axial = dot(h, f)
    if axial < 0.0:
        h, axial = opposite(h), -axial
    along_h = dot(start, h)
    # an edge nearly in the plane of the rim can cross both half circles: this contact takes the one given by ``half``
    side = half
    if axial > _STEEP:
        side = 1.0 if along_h >= 0.0 else -1.0
    cosine, sine, past_evolute = foot_on_ellipse(radius, radius * axial, dot(start, g), side * along_h)
    # outward unit vector of the rim at the crossing, and vector w [m] from this point to the nearest one of the edge
    e = plus_scaled(scaled(cosine, g), side * sine, f)
    p = scaled(radius, e)
    s = dot(minus(p, start), d)
    w = minus(plus_scaled(start, s, d), p)
    # the normal is perpendicular to the rim's tangent and to the edge
    n, apart = cross(cross(axis, e), d), norm(w)
    crossing_sine, spot = norm(n), Spot(frustum, int(rim), e, radius)
    are_cores_apart = is_round and apart > 1e-9 * size
    if are_cores_apart:
        # the line between both points, which round-off changes least
        n = divided(w, apart)
    elif crossing_sine > PARALLEL:
        n = divided(n, crossing_sine)
    else:
        n = e
    off_cone, off_reversed = _off_cones(spot, edge, n), _off_cones(spot, edge, opposite(n))
    if off_reversed <= off_cone and not are_cores_apart:
        # the sign for which the normal is nearer to the normal cones of rim and edge
        n, off_cone = opposite(n), off_reversed
    if is_round:
        # a rounded edge along the tangent touches the rim at a single point, so the crossing is well defined
        crossing_sine = 1.0
    past_ends = max(-s, s - edge.row[LENGTH])
    if axial > _STEEP:
        # a steep edge belongs to one half, by its component along the outward radius. At _STEEP the limit is between
        # the two halves, so that a contact keeps its crossing when the edge becomes steep. An edge along the axis is
        # far from the limit: its direction in the plane of the rim would be round-off
        past_ends = max(past_ends, -size * half * (dot(d, e) + axial - _STEEP))
    if past_evolute > 0.0 or crossing_sine <= PARALLEL:
        # the rim has no nearest point on this half, or the edge is along its tangent: no valid crossing
        past_ends = size
    return _Crossing(spot, plus(middle, p), n, dot(n, w), past_ends, off_cone, crossing_sine)


@compiled
def _past_bodies(out: Floats, frustum: Placed, solid: Solid, size: float) -> float:
    """Return by how far both contact points of a crossing are outside of the other body [m]; positive: no overlap.

    ``solid`` is the second body, and ``out`` the geometry block.  If flush faces are pressed into each other, the
    points lie on the surface of the other body: the margin is that of round-off, ``CLOSED``, and of the angle ``FLUSH``
    of such faces.
    """
    surface, margin = solid.surface, CLOSED * size - FLUSH * out[GAP]
    point = point_in_body(solid.frame, vector_at(out, POINT_A))
    if surface[N_TRIANGLES] == 0.0:
        _, nearest = past_edge(edge_at(surface, 0), point)
        outside = norm(minus(point, nearest))
    else:
        outside = signed_distance(surface, point)
    outside -= surface[SWEEP]
    if outside > margin:
        outside = min(outside, from_core(frustum, vector_at(out, POINT_B)) - frustum.numbers[FRUSTUM_SWEEP])
    return float(outside - margin)


@compiled
def _write_crossing(a: Floats, out: Floats, edge: Edge, surface: Floats, crossing: _Crossing, size: float) -> None:
    """Write the geometry block of the crossing of an edge with a part of a frustum.

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
    spot, normal, is_convex = crossing.spot, crossing.normal, surface[IS_CONVEX] == 1.0
    numbers, b = spot.frustum.numbers, edge.frame
    radius, sweep = surface[SWEEP], numbers[FRUSTUM_SWEEP]
    off_cone = sine_off_cone(edge, -1.0, normal)
    past = past_border(crossing.past_ends, max(crossing.off_cone, off_cone), size)
    # features that are parallel have no definite point of crossing
    past = max(past, size * (PARALLEL - crossing.sine))
    gap = gap_past_end(crossing.distance - radius - sweep, max(PARALLEL, crossing.sine) * past, is_convex)
    point = plus_scaled(crossing.point, sweep, normal)
    write_contact(a, out, gap, past, 0.0, normal, point, False)
    write_spot(out, SIDE_A, spot, normal)
    write_principal(out, SIDE_B, direction_of(edge), 0.0, 1.0, 1.0, radius)
    if past > 0.0:
        return
    if gap + sweep + radius >= -CLOSED * size:
        past = size * (off_cone - _CONE_MARGIN)
    else:
        past = max(
            _past_bodies(out, spot.frustum, Solid(b, surface), size),
            past_faces(surface, frustum_in_surface(a, b, numbers), -gap, point_in_body(b, point)),
        )
    if past > 0.0:
        out[GAP], out[PAST_END] = gap_past_end(gap, past, is_convex), past
        write_vector(out, POINT_B, plus_scaled(point, out[GAP], normal))


@compiled
def write_across_side(a: Floats, out: Floats, frustum: Floats, edge: Edge, surface: Floats, size: float) -> None:
    """Write the geometry block of an edge of a ``surface`` that crosses the side of a frustum of the body ``a``.

    ``size`` is the size of the bodies [m].
    """
    one = placed(a, frustum)
    line = Side(start_of(edge), direction_of(edge), 0.0, edge.row[LENGTH], 1.0, 0.0)
    found = cross_sides(side_of(one), line, PARALLEL, size)
    spot = Spot(one, FLANK, minus(found.point, one.center), found.away)
    # the normal is that of the side; the writer compares it with the normals of the edge
    crossing = _Crossing(spot, found.point, found.normal, found.gap, found.past_ends, -1.0, found.sine)
    _write_crossing(a, out, edge, surface, crossing, size)


@compiled
def write_across_rim(
    a: Floats, out: Floats, frustum: Floats, rim: float, half: float, edge: Edge, surface: Floats, size: float
) -> None:
    """Write the geometry block of an edge of a ``surface`` that crosses one half of a rim.

    An edge that lies across a cap crosses its rim twice, so that there are two contacts, one on either half.  ``rim``
    is 1 for the lower rim, 3 for the upper one.  ``half`` is 1 for the half circle towards which the edge points, seen
    along the axis; -1 for the opposite half circle.  For an edge at less than 60 degrees to the axis, both are the half
    circle nearer to the edge, and one of them has the contact.
    """
    is_round = surface[SWEEP] + frustum[FRUSTUM_SWEEP] > 0.0
    crossing = _cross_rim(placed(a, frustum), rim, half, edge, is_round, size)
    _write_crossing(a, out, edge, surface, crossing, size)
