"""Friction law of a small contact disc that spins: the spin lowers the friction force below mu N.

For slow slip the force is proportional to the slip speed, so there is no static friction.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import final

from nonsmooth.interfaces import FrictionLaw
from nonsmooth.parameters import parameter


def _coefficient(speed: float, friction: float, drilling_speed: float) -> float:
    return friction * speed / (speed + drilling_speed)


@final
@dataclass(frozen=True)
class SpinningCoulomb(FrictionLaw):
    """Friction coefficient mu v / (v + v_d) of a contact disc that spins.

    For a Hertzian disc of radius R that spins at omega, v_d = 8 R omega / (3 pi).  At every point of the disc, friction
    acts against the velocity of that point.  For a small slip speed v the resultant is proportional to v, so that there
    is no static friction.  The formula has the exact slope at v = 0 and the exact limit mu for fast slip.  Here omega
    is a constant, and the moment against the spin is neglected.

    References
    ----------
    V. Ph. Zhuravlev, "The model of dry friction in the problem of the rolling of rigid bodies", J. Appl. Math. Mech.
    62 (1998) 705-710.
    """

    friction: float = parameter(doc="friction coefficient mu of fast slip", minimum=0.0, usual=(0.01, 2.0))
    drilling_speed: float = parameter(doc="slip speed v_d of half that coefficient", unit="m/s", above=0.0)

    @property
    def coefficient(self) -> Callable[..., float]:
        """The friction coefficient as a function of the slip speed: 0 at rest, mu for fast slip."""
        return _coefficient

    def is_fulfilled(
        self,
        slip: tuple[float, float],
        normal_force: float,
        tangential_force: tuple[float, float],
        tolerance: float,
    ) -> bool:
        """Return True if the tangential force is the law's force at this slip velocity, within the tolerance [N]."""
        per_speed = self.friction * normal_force / (math.hypot(*slip) + self.drilling_speed)
        return all(abs(t + per_speed * v) <= tolerance for t, v in zip(tangential_force, slip, strict=True))
