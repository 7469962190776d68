"""Contact points of frustums: where contacts end, and their geometry blocks."""

from __future__ import annotations

import math
from typing import NamedTuple

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import SIDE_A, SIDE_B
from nonsmooth.types import Floats

from ...shapes.frustum import COS, SIDE, SIN, SWEEP
from ...vectors import Vector3, cross, dot, opposite, plus_scaled, scaled
from ..features.edge_crossing import CONE_MARGIN, PARALLEL
from ..features.ends import END, REACH, gap_past_end
from ..features.frames import across
from ..features.writing import write_contact, write_flat, write_principal, write_round, write_sweep
from .frustum import FLANK, HIGH_CAP, HIGH_RIM, LOW_CAP
from .frustum_placed import Placed, separation_by_second

FLATTEST = 1e-9
"""Least sine of the angle between a rim and a face at which the rim has a lowest point over the face.

The speed of this point along the rim is inversely proportional to the sine.  A flatter rim rests on feet.
"""


class Spot(NamedTuple):
    """A contact point on the core of a frustum."""

    frustum: Placed
    """The frustum in the world."""
    part: int
    """Number of the part, such as ``FLANK``; an apex is a rim of radius 0."""
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
    are those of :func:`bodies.contacts.frustum.frustum_placed.separation_by_second` for either frustum.  ``gap`` is the
    gap of the cores [m].  If it is not negative, up to round-off, the result is negative.
    """
    if gap >= -REACH * size:
        return -size
    return float(max(separation_by_second(first, second), separation_by_second(second, first)) - gap - REACH * size)


@compiled
def past_of_rim(past: float, radius: float, sine: float) -> float:
    """Return a displacement [m] that bodies need before the lowest point of a rim is inside a face's border again.

    ``past`` is the distance of the point past the border [m]; if it is not positive, it is the result.  ``sine`` is the
    sine of the angle between the planes of rim and face, ``radius`` the radius of the rim [m].  If the bodies rotate by
    an angle, the point moves round the rim by up to this angle over the sine: far, while the bodies hardly move.

    Use this displacement for bodies that are apart.  If they touch, the contact ends at ``past`` itself.
    """
    # the least sine keeps the result positive past the border, also for a rim parallel to the face
    return past if past <= 0.0 or radius == 0.0 else max(sine, PARALLEL) * min(past, radius)


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
def off_side(of_rim: Spot, n: Vector3) -> float:
    """Return the sine of the angle from the side's normal to a contact normal n at a rim; 1 for a disc without a side.

    The contact normal points out of the frustum.  The sine is positive towards the normal of the cap.
    """
    (numbers, _, axis), part, outward, _ = of_rim
    if numbers[SIDE] == 0.0:
        return 1.0
    sine = numbers[COS] * dot(n, axis) - numbers[SIN] * dot(n, outward)
    return sine if part == HIGH_RIM else -sine


@compiled
def off_cone_of_rim(of_rim: Spot, n: Vector3) -> float:
    """Return the sine of the angle between a contact normal n and the normal cone of a rim; negative inside this cone.

    The cone lies between the normals of side and cap, or of both caps of a disc.  ``of_rim.offset`` must be a unit
    vector across the axis.
    """
    return float(max(-dot(n, of_rim.offset), -off_side(of_rim, n)))


@compiled
def write_spot(out: Floats, side: int, spot: Spot, normal: Vector3) -> None:
    """Write the curvature matrices of a rounded frustum at a contact point, with its outward unit ``normal`` there.

    ``side`` is ``SIDE_A`` or ``SIDE_B``.  ``out`` must already hold the contact's normal and first tangent; the
    matrices are explained in :func:`bodies.contacts.features.writing.write_principal`.
    """
    (numbers, _, axis), part, offset, away = spot
    if part == LOW_CAP or part == HIGH_CAP:
        write_flat(out, side)
    elif part != FLANK and away == 0.0:
        write_round(out, side, 0.0)
    else:
        # if the point moves round the axis by an angle, the normal turns by this angle times its component along
        # ``outward``. A normal along the axis does not turn; the least value keeps the matrices regular
        _, _, outward = across(offset, axis)
        radial = dot(normal, outward)
        flank, slide = 1.0 if part == FLANK else 0.0, radial if abs(radial) > FLATTEST else FLATTEST
        write_principal(out, side, cross(axis, outward), slide, away, 1.0 - flank, flank)
    write_sweep(out, side, numbers[SWEEP])


@compiled
def write_pair(
    a: Floats, out: Floats, swap: float, gap: float, past: float, normal: Vector3, p: Vector3, own: Spot, other: Spot
) -> None:
    """Write the geometry block of two frustums, with the contact points ``own`` and ``other``; the feature is 0.

    ``gap`` is the distance of the cores [m] along the unit vector ``normal``, from the point p on the core of ``own``
    to the core of ``other``; vectors are in the world.  If ``swap`` is 1, ``own`` belongs to the second body, so that
    the contact normal is opposite to ``normal``.  ``past`` is the distance past the boundary of the features [m].
    """
    sweep, is_swapped = own.frustum.numbers[SWEEP], swap == 1.0
    gap = gap_past_end(gap - sweep - other.frustum.numbers[SWEEP], past, True)
    write_contact(a, out, gap, past, 0.0, scaled(1.0 - 2.0 * swap, normal), plus_scaled(p, sweep, normal), is_swapped)
    write_spot(out, SIDE_B if is_swapped else SIDE_A, own, normal)
    write_spot(out, SIDE_A if is_swapped else SIDE_B, other, opposite(normal))
