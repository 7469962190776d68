"""One planar impact with friction and energetic restitution, in closed form."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from laws.impact.power import duration_parameter
from nonsmooth.certificates import follows_map
from nonsmooth.compiled import compiled
from nonsmooth.interfaces import ImpactMap
from nonsmooth.parameters import parameter
from nonsmooth.types import Array, Floats

_REST = 1e-9
"""A slip below this, relative to the approach, is none."""
_PLANAR = 1e-9
"""Couplings out of the plane below this, relative to the diagonal, are none."""


@compiled
def _phases(b: float, c: float, a: float, rate: float, slip: float, mu: float, restitution: float, out: Floats) -> None:
    """Write P_N and P_T of a contact with the rates (rate, slip) and the Delassus matrix [[b, c], [c, a]]."""
    normal = tangential = stored = 0.0
    compressed = 0
    # the slip ends at most once: then the contact sticks, or slips on the other way to the end
    for stretch in range(2):
        if slip > 0.0:
            ratio = -mu
        elif abs(c) <= mu * a:
            ratio = -c / a
        else:
            ratio = -mu if c > 0.0 else mu
        growth, slip_growth = b + ratio * c, c + ratio * a
        until = math.inf
        if stretch == 0 and slip > 0.0 and slip_growth < 0.0:
            until = -slip / slip_growth
        if compressed == 0:
            # without growth of the rate it is the end of slip that ends the approach, later
            step = min(until, -rate / growth) if growth > 0.0 else until
            stored -= step * (rate + 0.5 * growth * step)
            normal += step
            tangential += ratio * step
            if step == until:
                rate += growth * step
                slip = 0.0
                continue
            slip += slip_growth * step
            until -= step
            rate = 0.0
            compressed = 1
            stored *= restitution * restitution
        # the rest of the share e^2 of the stored energy: rate s + growth s^2 / 2
        square = math.sqrt(rate * rate + 2.0 * growth * stored)
        step = 2.0 * stored / (rate + square) if square > 0.0 else 0.0
        if step <= until:
            normal += step
            tangential += ratio * step
            break
        step = until
        stored -= step * (rate + 0.5 * growth * step)
        rate += growth * step
        normal += step
        tangential += ratio * step
        slip = 0.0
    out[0], out[1] = normal, tangential


def _impulses(
    n: int,
    delassus: Floats,
    rates: Floats,
    out: Floats,
    friction: Floats,
    restitution: Floats,
) -> None:
    """Follow slip, stick and reverse slip through compression and expansion."""
    if n != 1:
        raise ValueError("Stronge's closed form is that of one contact; take EnergeticImpact where several collide")
    out[0] = out[1] = out[2] = 0.0
    rate, v1, v2 = rates[0], rates[1], rates[2]
    if rate >= 0.0:
        return
    slip = math.sqrt(v1 * v1 + v2 * v2)
    none = _PLANAR * (delassus[0] + delassus[4] + delassus[8])
    if slip <= _REST * -rate:
        slip = 0.0
        # it can only start the way in which the normal impulse pushes, and not where that pushes no way
        v1, v2 = delassus[3], delassus[6]
        if math.sqrt(v1 * v1 + v2 * v2) <= none:
            out[0] = -(1.0 + restitution[0]) * rate / delassus[0]
            return
    size = math.sqrt(v1 * v1 + v2 * v2)
    d1, d2 = v1 / size, v2 / size
    across = abs(delassus[6] * d1 - delassus[3] * d2)
    twist = abs((delassus[8] - delassus[4]) * d1 * d2 + delassus[5] * (d1 * d1 - d2 * d2))
    if max(across, twist) > none:
        raise ValueError("Stronge's closed form is planar; take EnergeticImpact where the direction of the slip turns")
    along = delassus[3] * d1 + delassus[6] * d2
    own = delassus[4] * d1 * d1 + 2.0 * delassus[5] * d1 * d2 + delassus[8] * d2 * d2
    _phases(delassus[0], along, own, rate, slip, friction[0], restitution[0], out)
    out[1], out[2] = out[1] * d1, out[1] * d2


@final
@dataclass(frozen=True)
class StrongeImpact(ImpactMap):
    """Energetic restitution and Coulomb friction at one contact, slip and normal impulse in one plane.

    While the normal impulse grows, rate and slip change linearly: the slip ends, and then the contact sticks if
    friction can hold it, or slips back.  Expansion ends when the share e^2 of the work of compression has come back.
    It never gains energy and is :class:`~laws.impact.energetic.EnergeticImpact` on a contact by itself.

    A colliding set of more contacts, those that rest on each other included, is refused, and so is an impact in which
    the direction of the slip would turn: the run ends and says so.  One coefficient serves for stick and slip,
    that of the slip before the impact.

    References
    ----------
    W. J. Stronge, "Rigid body collisions with friction", Proc. R. Soc. Lond. A 431 (1990) 169-181.
    """

    one_planar_contact: ClassVar[bool] = True

    restitution: float = parameter(doc="energetic coefficient of restitution e", minimum=0.0, maximum=1.0)
    duration: float = duration_parameter()

    @property
    def impulses(self) -> Callable[..., None]:
        """The map from rates to impulses, of one contact."""
        return _impulses

    @property
    def contact_time(self) -> float:
        """The parameter ``duration`` [s]."""
        return self.duration

    def is_fulfilled(self, delassus: Array, before: Array, impulses: Array, friction: Array, tolerance: float) -> bool:
        """Tell whether the impulses give the velocities of the closed form."""
        return follows_map(self, delassus, before, impulses, friction, tolerance)
