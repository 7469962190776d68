"""The point of a rim that touches a face, also if the rim is parallel to the face and has no lowest point.

A flat rim that turns touches at the point that goes down fastest. So it rocks with impacts, and comes to rest after
infinitely many. A flat rim that turns more slowly than after a fall from the tilt :data:`FLATTEST` has a crown: its
face is a cap of a sphere with this sine at the rim. The cap touches in its middle if the face lies flat. The point
moves with the tilt to where the load is. The cap does not protrude from the face, so no body is lifted to its crown.
"""

from __future__ import annotations

from typing import TypeAlias

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import SPIN
from nonsmooth.interfaces.scales import EARTH
from nonsmooth.types import Floats

from ...blocks import Vector3
from .frames import across
from .writing import write_principal, write_sweep

FLATTEST = 1e-9
"""Sine of the angle between rim and face below which the rim has no lowest point."""
_SLOWEST = 8.0 * FLATTEST * EARTH
"""Square of the angular velocity of a flat rim, times its radius [m/s^2]: of a thin disc on Earth that fell flat."""
Touching: TypeAlias = tuple[float, Vector3, float, float, float, float]
"""Distance of the touching point from the rim's centre [m], unit vector to it, and four numbers more.

They are: height of the point over the place at which the gap is measured [m]; sine of the angle between rim and face,
at least :data:`FLATTEST`; slide and turn of the surface across the rim
(:func:`bodies.contacts.features.writing.write_principal`).
"""


@compiled
def touching_point(own: Floats, other: Floats, normal: Vector3, axis: Vector3, radius: float) -> Touching:
    """Return the point of a rim that touches a face.

    ``own`` and ``other`` are the frame blocks of the bodies with the rim and with the face.  ``normal`` is the unit
    vector from the face towards the rim, ``axis`` the one of the rim, both in world axes.
    """
    (nx, ny, nz), (ax, ay, az) = normal, axis
    _, sine, x, y, z = across(-nx, -ny, -nz, ax, ay, az)
    if sine >= FLATTEST:
        return radius, (x, y, z), 0.0, sine, 1.0, 0.0
    wx, wy, wz = own[SPIN] - other[SPIN], own[SPIN + 1] - other[SPIN + 1], own[SPIN + 2] - other[SPIN + 2]
    # a point of the rim rises by the product of its offset and this vector
    rise_x, rise_y, rise_z = ny * wz - nz * wy, nz * wx - nx * wz, nx * wy - ny * wx
    _, turning, down_x, down_y, down_z = across(-rise_x, -rise_y, -rise_z, ax, ay, az)
    if radius * turning * turning > _SLOWEST:
        # the gap is that of the lowest point
        lift = radius * (sine + down_x * nx + down_y * ny + down_z * nz)
        return radius, (down_x, down_y, down_z), lift, FLATTEST, 1.0, 0.0
    reach = radius * sine / FLATTEST
    return reach, (x, y, z), -0.5 * reach * sine, FLATTEST, FLATTEST, radius


@compiled
def common_length(radius: float, wide: float, offset: float) -> tuple[float, float]:
    """Return the middle and half of the length that two coplanar discs have in common on the line of their centres [m].

    The middle is measured from the centre of the first disc towards that of the second, at the distance ``offset``.
    The half is negative if the discs are apart.
    """
    low, high = max(-radius, offset - wide), min(radius, offset + wide)
    return 0.5 * (low + high), 0.5 * (high - low)


@compiled
def write_rim(out: Floats, side: int, axis: Vector3, radius: float, at: Touching, sweep: float) -> None:
    """Write the curvature matrices of a rim, rounded by ``sweep`` [m], at its touching point.

    ``out`` must already hold the normal and the first tangent.  ``axis`` is the unit axis of the rim in world axes.
    """
    (ax, ay, az), (_, (x, y, z), _, sine, slide, turn) = axis, at
    write_principal(out, side, ay * z - az * y, az * x - ax * z, ax * y - ay * x, sine, radius, slide, turn)
    write_sweep(out, side, sweep)
