"""Where contacts of a frustum end, and their geometry blocks."""

from __future__ import annotations

import math
from typing import NamedTuple

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import SIDE_A, SIDE_B
from nonsmooth.types import Floats

from ...shapes.frustum import COS, SIDE, SIN, SWEEP
from ...vectors import Vector3, divided, dot, norm, opposite, plus_scaled, scaled
from ..features.edge_crossing import CONE_MARGIN
from ..features.ends import END, REACH, gap_past_end
from ..features.writing import write_contact, write_sweep
from .frustum import Placed, separation_by_second, write_part


class Spot(NamedTuple):
    """A contact point on a part of a frustum's core."""

    part: int
    """Number of the part, such as ``FLANK``."""
    offset: Vector3
    """Vector of any length from a point of the axis towards the contact point, in the world."""
    away: float
    """Distance of the point from the axis [m]."""


@compiled
def past_border(past_ends: float, off_cone: float, size: float) -> float:
    """Return the distance of a contact past the boundary of its features [m]; negative if it is valid.

    ``past_ends`` is the distance past the ends of both features [m].  ``off_cone`` is the sine of the angle between the
    contact normal and the normal cones of the features, negative inside of them.  Both have a margin, so that neither
    round-off nor a small rotation ends the contact.  ``size`` is the size of the bodies [m].
    """
    return max(past_ends - REACH * size, size * (off_cone - CONE_MARGIN))


@compiled
def past_depth(first: Placed, second: Placed, gap: float, size: float) -> float:
    """Return a length [m] that is positive if two cores overlap by less than -``gap`` along another direction.

    The contact is then not valid, because another one separates the bodies by a shorter translation.  The directions
    are those of :func:`bodies.contacts.frustum.frustum.separation_by_second` for either frustum.  ``gap`` is the gap of
    the cores [m].  If it is not negative, up to round-off, the result is negative.
    """
    if gap >= -REACH * size:
        return -size
    return float(max(separation_by_second(first, second), separation_by_second(second, first)) - gap - REACH * size)


@compiled
def past_apex(frustum: Floats, distance: float, axial: float, size: float) -> float:
    """Return the distance of the other body's nearest point past the apex [m], less the tolerance ``2 END size``.

    It is the coordinate of this point along a straight line on the cone's side, from the apex downwards.  If the result
    is positive, the side is nearer to the point than the apex.  The point lies at ``distance`` [m] from the apex;
    ``axial`` is the component, along the cone's axis, of the unit vector from the apex to the point.  ``size`` is the
    size of the bodies [m].
    """
    radial = math.sqrt(max(1.0 - axial * axial, 0.0))
    return float(max(distance * (frustum[SIN] * radial - frustum[COS] * axial), -size) - 2.0 * END * size)


@compiled
def off_side(frustum: Floats, up: float, radial: float, axial: float) -> float:
    """Return the sine of the angle from the side's normal to a contact normal at a rim; 1 for a disc without a side.

    The arguments are those of :func:`off_cone_of_rim`.  The sine is positive towards the normal of the cap.
    """
    return up * (frustum[COS] * axial - frustum[SIN] * radial) if frustum[SIDE] > 0.0 else 1.0


@compiled
def off_cone_of_rim(frustum: Floats, up: float, radial: float, axial: float) -> float:
    """Return the sine of the angle between a contact normal and the normal cone of a rim; negative inside this cone.

    The contact normal points out of the frustum; ``radial`` and ``axial`` are its components away from the axis and
    along it.  The cone lies between the normals of side and cap, or of both caps of a disc.  ``up`` is 1 for the upper
    rim and -1 for the lower one.
    """
    return float(max(-radial, -off_side(frustum, up, radial, axial)))


@compiled
def _write_spot(out: Floats, side: int, frustum: Placed, spot: Spot, normal: Vector3) -> None:
    """Write the curvature matrices of a rounded frustum at a contact point, with its outward ``normal`` there."""
    outward = plus_scaled(spot.offset, -dot(spot.offset, frustum.axis), frustum.axis)
    length = norm(outward)
    # a point on the axis has no radial direction: its normal is along the axis
    radial = 0.0
    if length > 0.0:
        outward = divided(outward, length)
        radial = dot(normal, outward)
    write_part(out, side, spot.part, frustum.axis, outward, radial, spot.away)
    write_sweep(out, side, frustum.numbers[SWEEP])


@compiled
def write_pair(
    a: Floats,
    out: Floats,
    swap: float,
    first: Placed,
    second: Placed,
    distance: float,
    past: float,
    normal: Vector3,
    p: Vector3,
    own: Spot,
    other: Spot,
) -> None:
    """Write the geometry block of two frustums, with the contact points ``own`` and ``other``; the feature is 0.

    ``distance`` is the distance of the cores [m] along the unit vector ``normal``, from the point p on the core of the
    frustum ``first`` to the core of ``second``; vectors are in the world.  If ``swap`` is 1, ``first`` belongs to the
    second body, so that the contact normal is opposite to ``normal``.  ``past`` is the distance past the boundary of
    the features [m].
    """
    sweep, is_swapped = first.numbers[SWEEP], swap == 1.0
    gap, point = gap_past_end(distance - sweep - second.numbers[SWEEP], past, True), plus_scaled(p, sweep, normal)
    write_contact(a, out, gap, past, 0.0, scaled(1.0 - 2.0 * swap, normal), point, is_swapped)
    _write_spot(out, SIDE_B if is_swapped else SIDE_A, first, own, normal)
    _write_spot(out, SIDE_A if is_swapped else SIDE_B, second, other, opposite(normal))
