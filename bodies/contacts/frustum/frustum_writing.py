"""Writes the geometry block of contacts in which a side or rim of a frustum crosses an edge or another frustum.

It also computes the distance of such a contact past the boundary of its features: the ends of an edge or of a side, and
the normal cone of an edge or a rim.  An edge belongs to the second body: a sharp or rounded polyhedron, or a
capsule.
"""

from __future__ import annotations

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import FEATURE, GAP, NORMAL, PAST_END, POINT_A, POINT_B, SIDE_A, SIDE_B
from nonsmooth.types import Floats

from ...shapes.frustum import COS, HIGH, LOW, LOW_RADIUS, SIN, SWEEP
from ...vectors import Vector3, divided, dot, minus, norm, plus_scaled, scaled, vector_at, write_vector
from ..features.edge_crossing import CONE_MARGIN, PARALLEL, sine_off_cone
from ..features.edge_row import ALONG, START
from ..features.ends import REACH, gap_past_end
from ..features.frames import across, point_in_world, vector_in_world, write_tangent
from ..features.writing import write_principal, write_sweep
from ..smooth.smooth_core import Axes, rotated, rotated_back
from .frustum import (
    axis_in_world,
    center_in_world,
    nearest_part,
    on_axis_in_world,
    separation_by_second,
    write_part,
)


@compiled
def past_border(past_ends: float, off_cone: float, size: float) -> float:
    """Return the distance of a contact of two frustums past the boundary of its features [m]; negative if it is valid.

    ``past_ends`` is the distance past the ends of both features [m].  ``off_cone`` is the sine of the angle between the
    contact normal and the normal cones of the features, negative inside of them.  Both have a margin, so that neither
    round-off nor a small rotation ends the contact.  ``size`` is the size of the bodies [m].
    """
    return max(past_ends - REACH * size, size * (off_cone - CONE_MARGIN))


@compiled
def past_depth(a: Floats, first: Floats, b: Floats, second: Floats, gap: float, size: float) -> float:
    """Return a length [m] that is positive if two cores overlap by less than -``gap`` along another direction.

    The contact is then not valid, because another one separates the bodies by a shorter translation.  The directions
    are those of :func:`bodies.contacts.frustum.frustum.separation_by_second` for either frustum.  ``gap`` is the gap of
    the cores [m].  If it is not negative, up to round-off, the result is negative.
    """
    if gap >= -REACH * size:
        return -size
    best = max(separation_by_second(a, first, b, second), separation_by_second(b, second, a, first))
    return float(best - gap - REACH * size)


@compiled
def past_disc(
    own: Floats,
    first: Floats,
    other: Floats,
    second: Floats,
    up: float,
    gap: float,
    p: Vector3,
    is_tip: bool,
    size: float,
) -> float:
    """Return the distance of a contact of a disc's face past its boundary [m]; negative if it is valid.

    The face is the upper one of the disc ``second`` if ``up`` is 1, the lower one if it is -1.  ``p`` is the point of
    the frustum ``first`` that is lowest over the face, or the tip of a foot or cone (``is_tip``), in the world [m];
    ``gap`` is its height over the face [m].  ``own`` and ``other`` are the frame blocks of both bodies.

    If p lies below the face, one of two conditions must hold:

    - the line from p to the middle of the frustum leads back through the disc, and the rim of the disc lies below it;
    - the point of the face above p is inside of the frustum, and no other direction separates the bodies better.

    The second one holds where p passes below the rim, so that the contact of both rims ends where this one begins.
    Discs in one plane touch with the faces of both sides; the engine takes the face on the side from which the other
    disc came.
    """
    axis, own_axis = axis_in_world(other, second), axis_in_world(own, first)
    center, middle = center_in_world(other, second), on_axis_in_world(own, first, 0.5 * (first[LOW] + first[HIGH]))
    height, to_middle = up * dot(axis, minus(middle, center)), minus(middle, p)
    # the end of a frustum with a tip must face the disc; a raised foot may be higher than the middle
    if is_tip and up * dot(to_middle, own_axis) * dot(own_axis, axis) < 0.0:
        return size
    if gap >= -REACH * size:
        return -size
    # a frustum with its middle below the face touches the other face, and so does a rounded one with its core below it
    if height <= REACH * size or first[SWEEP] + second[SWEEP] > 0.0:
        return size
    # first condition: distance from the disc's axis at which the line from p to the middle crosses the face, and
    # distance of the disc's rim from the line, negative if the line crosses the disc. The margin keeps a disc whose rim
    # only touches the frustum
    _, away, _ = across(minus(plus_scaled(p, gap / (gap - height), to_middle), center), axis)
    past_rim = REACH * size - (second[LOW_RADIUS] - away) * (height - gap) / norm(to_middle)
    # second condition: distance of the point of the face above p from the frustum
    along, away, _ = across(minus(plus_scaled(p, -up * gap, axis), center_in_world(own, first)), own_axis)
    outside = nearest_part(first, along, away)[0] - REACH * size
    return float(min(past_rim, max(outside, past_depth(own, first, other, second, gap, size))))


@compiled
def off_cone_of_rim(frustum: Floats, up: float, radial: float, axial: float, is_disc: bool) -> float:
    """Return the sine of the angle between a contact normal and the normal cone of a rim; negative inside this cone.

    The contact normal points out of the frustum; ``radial`` and ``axial`` are its components away from the axis and
    along it.  The cone lies between the normals of side and cap.  ``up`` is 1 for the upper rim and -1 for the lower
    one.  ``is_disc``: the frustum has no side, and the cone reaches from one cap's normal to the other's.
    """
    if is_disc:
        return -radial
    return float(max(-radial, -up * (frustum[COS] * axial - frustum[SIN] * radial)))


@compiled
def write_contact(
    a: Floats, out: Floats, gap: float, past: float, feature: float, normal: Vector3, point: Vector3, of_second: bool
) -> None:
    """Write the geometry block of a contact, except the curvature matrices.

    Parameters
    ----------
    a, out : Floats
        Frame block of the first body, and the geometry block.
    gap, past : float
        Gap (:func:`gap_past_end`), and distance past the end of the features [m].
    feature : float
        Number of the pair of features.
    normal, point : Vector3
        Normal from the first to the second body, and the contact point of one of them, in the world [m].
    of_second : bool
        Whether the contact point is that of the second body.
    """
    out[GAP], out[FEATURE], out[PAST_END] = gap, feature, past
    write_vector(out, NORMAL, normal)
    write_vector(out, POINT_B if of_second else POINT_A, point)
    write_vector(out, POINT_A if of_second else POINT_B, plus_scaled(point, -gap if of_second else gap, normal))
    write_tangent(a, out)


@compiled
def write_two(
    a: Floats,
    out: Floats,
    swap: float,
    first: Floats,
    second: Floats,
    distance: float,
    past: float,
    normal: Vector3,
    p: Vector3,
) -> None:
    """Write the geometry block of two frustums, except the curvature matrices.

    ``distance`` is the distance of the cores [m] along the unit vector ``normal``, from the point p on the core of the
    frustum ``first`` to the core of ``second``; vectors are in the world.  If ``swap`` is 1, ``first`` belongs to the
    second body, so that the contact normal is opposite to ``normal``.  ``past`` is the distance past the boundary of
    the features [m].  The feature number is 0.
    """
    sweep = first[SWEEP]
    gap, point = gap_past_end(distance - sweep - second[SWEEP], past, True), plus_scaled(p, sweep, normal)
    write_contact(a, out, gap, past, 0.0, scaled(1.0 - 2.0 * swap, normal), point, swap == 1.0)


@compiled
def write_rounded_part(
    out: Floats, swap: float, frustum: Floats, part: int, axis: Vector3, offset: Vector3, normal: Vector3, away: float
) -> None:
    """Write the curvature matrices of a part of a frustum, with its rounding: of the second body if ``swap`` is 1.

    ``part`` is the number of the part, such as ``FLANK``.  ``axis`` is the unit axis of the frustum, ``offset`` a
    vector of any length from a point of the axis towards the contact point, and ``normal`` the frustum's outward normal
    there, all in the world.  ``away`` is the distance of the point of the core, without rounding, from the axis [m].
    The geometry block ``out`` must already hold the normal and the first tangent.
    """
    outward = plus_scaled(offset, -dot(offset, axis), axis)
    length = norm(outward)
    # a point on the axis has no radial direction: its normal is along the axis
    radial = 0.0
    if length > 0.0:
        outward = divided(outward, length)
        radial = dot(normal, outward)
    side = SIDE_B if swap == 1.0 else SIDE_A
    write_part(out, side, part, axis, outward, radial, away)
    write_sweep(out, side, frustum[SWEEP])


@compiled
def edge_in_frustum(b: Floats, edge: Floats, axes: Axes, center: Vector3) -> tuple[Vector3, Vector3]:
    """Return the first end of an edge [m] and its unit vector, in the axes of the frustum and from its centre.

    ``edge`` is the row of the edge in the frame ``b`` (:data:`bodies.contacts.surface.surface_tables.EDGE`).
    ``axes`` and ``center`` [m] are those of the frustum in the world.
    """
    start = minus(point_in_world(b, vector_at(edge, START)), center)
    return rotated_back(axes, start), rotated_back(axes, vector_in_world(b, vector_at(edge, ALONG)))


@compiled
def off_cone_of_edge(b: Floats, edge: Floats, axes: Axes, normal: Vector3) -> float:
    """Return the sine of the angle between a contact normal and an edge's normal cone; negative inside the cone.

    The contact normal, in the axes of the frustum, points from the frustum to the edge: against the outward normals of
    the edge.  The cone lies between the normals of the two faces of the edge.  ``edge`` is the row of the edge.
    """
    return float(sine_off_cone(b, edge, 0, -1.0, rotated(axes, normal)))


@compiled
def past_end(past_ends: float, sine: float, off_cone: float, size: float) -> float:
    """Return the distance of a crossing past the boundary of its two features [m]; negative if the crossing is valid.

    The features are an edge of the second body, and a rim or a side of the first.  A crossing has no definite point if
    both features are parallel.

    ``past_ends`` is the distance past the ends of the edge and of the rim or side [m].  ``sine`` is the sine of the
    angle between the two features, ``off_cone`` that between the contact normal and the normal cones of the features.
    """
    return max(past_ends - REACH * size, size * max(PARALLEL - sine, off_cone - CONE_MARGIN))


@compiled
def write_crossing(
    a: Floats,
    b: Floats,
    out: Floats,
    frustum: Floats,
    axes: Axes,
    edge: Floats,
    radius: float,
    is_convex: bool,
    distance: float,
    past: float,
    sine: float,
    normal: Vector3,
    p: Vector3,
) -> None:
    """Write the geometry block of an edge that crosses a rim or a side, except the curvature matrices of the frustum.

    The point of crossing moves up to 1 / sine times as fast as the bodies, with the sine of the angle between both
    features.  Past the boundary, the gap is therefore hypot(gap, sine * past): its rate stays of the order of the
    bodies' velocities.  A negative gap is kept if the second body ``is_convex`` (:func:`gap_past_end`).

    ``edge`` is the row of the edge of the second body, ``radius`` its rounding radius [m].  ``axes`` are the axes of
    the frustum in the world.  ``distance`` is the distance of the cores, ``past`` the distance past the boundary of
    both features [m].  ``normal`` is the unit normal from the frustum to the edge, in the axes of the frustum.  ``p``
    is the contact point on the core of the frustum, in the world [m].
    """
    sweep, outward = frustum[SWEEP], rotated(axes, normal)
    gap = gap_past_end(distance - radius - sweep, max(PARALLEL, sine) * past, is_convex)
    write_contact(a, out, gap, past, 0.0, outward, plus_scaled(p, sweep, outward), False)
    write_principal(out, SIDE_B, vector_in_world(b, vector_at(edge, ALONG)), 0.0, 1.0, 1.0, radius)
