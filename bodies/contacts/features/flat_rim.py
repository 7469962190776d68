"""The point at which a circular rim touches a face, also for a rim that is parallel to the face.

A rim touches a face at its lowest point.  A flat rim is parallel to the face within :data:`FLATTEST`.  All its points
are equally low, so its angular velocity relative to the face decides:

1. If it turns fast, it touches at the point that descends fastest.  The body then rocks with impacts and comes to rest
   at the end of a Zeno sequence.
2. If it turns slowly, the disc within the rim is treated as a crown: a cap of a sphere that is tilted by the angle
   :data:`FLATTEST` at the rim.  A crown that lies level touches in its middle.  If it tilts, its contact point moves
   towards the lower side, so that the contact force can balance the load.

The limit is the speed that a thin disc gains if it falls on Earth from the tilt :data:`FLATTEST`.  The middle of the
crown lies in the plane of the rim, so the crown lifts no body.
"""

from __future__ import annotations

from typing import TypeAlias

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import SPIN
from nonsmooth.interfaces.scales import EARTH
from nonsmooth.types import Floats

from ...vectors import Vector3
from .frames import across
from .writing import write_principal, write_sweep

FLATTEST = 1e-9
"""Sine of the angle between a rim and a face below which the rim is flat.

The speed of the lowest point along the rim is inversely proportional to this sine: at a smaller one it is too fast.
"""
_SLOWEST = 8.0 * FLATTEST * EARTH
"""Largest square of the angular velocity of a flat rim with a crown, times the radius r of the rim [m/s^2].

A thin disc of mass m has the moment of inertia m r^2 / 4 about a diameter.  It turns so fast if its potential energy
m g r ``FLATTEST`` on Earth, at the tilt ``FLATTEST``, becomes rotation.
"""
Touching: TypeAlias = tuple[float, Vector3, float, float, float, float]
"""The touching point of a rim, as six numbers or vectors:

1. distance of the point from the centre of the rim [m];
2. unit vector from the centre to the point, in world axes;
3. height of the point over the point at which the gap is measured [m];
4. sine of the angle between rim and face, at least :data:`FLATTEST`;
5. slide of the surface across the rim (``slide_across`` of :func:`bodies.contacts.features.writing.write_principal`);
6. turn of the surface across the rim [m] (``turn_across``).
"""


@compiled
def touching_point(own: Floats, other: Floats, normal: Vector3, axis: Vector3, radius: float) -> Touching:
    """Return the point at which a rim touches a face: its lowest point, or that of a flat rim.

    Parameters
    ----------
    own, other : Floats
        Frame blocks of the body with the rim, and of the body with the face.
    normal : tuple of float
        Unit normal of the face, towards the rim, in world axes.
    axis : tuple of float
        Unit axis of the rim in world axes.
    radius : float
        Radius of the rim [m].
    """
    (nx, ny, nz), (ax, ay, az) = normal, axis
    _, sine, (x, y, z) = across((-nx, -ny, -nz), (ax, ay, az))
    if sine >= FLATTEST:
        return radius, (x, y, z), 0.0, sine, 1.0, 0.0
    wx, wy, wz = own[SPIN] - other[SPIN], own[SPIN + 1] - other[SPIN + 1], own[SPIN + 2] - other[SPIN + 2]
    # relative to the centre, a point of the rim rises at the rate offset . (normal x angular velocity)
    rise_x, rise_y, rise_z = ny * wz - nz * wy, nz * wx - nx * wz, nx * wy - ny * wx
    _, turning, (down_x, down_y, down_z) = across((-rise_x, -rise_y, -rise_z), (ax, ay, az))
    if radius * turning * turning > _SLOWEST:
        # the gap of the rim is the gap of its lowest point
        lift = radius * (sine + down_x * nx + down_y * ny + down_z * nz)
        return radius, (down_x, down_y, down_z), lift, FLATTEST, 1.0, 0.0
    # the crown touches at the distance at which its tangent plane is parallel to the face
    reach = radius * sine / FLATTEST
    return reach, (x, y, z), -0.5 * reach * sine, FLATTEST, FLATTEST, radius


@compiled
def common_length(radius: float, wide: float, offset: float) -> tuple[float, float]:
    """Return the middle and the half-length of the segment that two coplanar discs share on the line of centres [m].

    The middle is measured from the centre of the first disc towards the centre of the second.  The half-length is
    negative if the discs are apart.

    Parameters
    ----------
    radius, wide : float
        Radii of the first and of the second disc [m].
    offset : float
        Distance of the centres [m].
    """
    low, high = max(-radius, offset - wide), min(radius, offset + wide)
    return 0.5 * (low + high), 0.5 * (high - low)


@compiled
def write_rim(out: Floats, side: int, axis: Vector3, radius: float, at: Touching, sweep: float) -> None:
    """Write the curvature matrices of a rim at its touching point.

    They are explained in :func:`bodies.contacts.features.writing.write_principal`.  The geometry block ``out`` must
    already hold the normal and the first tangent.

    Parameters
    ----------
    out, side : Floats, int
        The geometry block, and the index at which the matrices begin.
    axis : tuple of float
        Unit axis of the rim in world axes.
    radius : float
        Radius of the rim [m].
    at : Touching
        The touching point.
    sweep : float
        Radius of the rounding about the rim [m].
    """
    (ax, ay, az), (_, (x, y, z), _, sine, slide, turn) = axis, at
    write_principal(out, side, (ay * z - az * y, az * x - ax * z, ax * y - ay * x), sine, radius, slide, turn)
    write_sweep(out, side, sweep)
