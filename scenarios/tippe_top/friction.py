"""Coulomb friction of a small contact disc that spins: the friction force is below mu N, and nothing sticks."""

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

    For a Hertzian disc of radius R that spins at omega, v_d = 8 R omega / (3 pi).  At every point of the disc friction
    acts against the velocity of that point.  The resultant against the slip v of the disc is proportional to v if v is
    small, so that there is no static friction.  The coefficient is exact in slope at v = 0 and in its limit mu; omega
    is a constant here.  The moment against the spin is left out.

    References
    ----------
    V. Ph. Zhuravlev, "The model of dry friction in the problem of the rolling of rigid bodies", J. Appl. Math. Mech.
    62 (1998) 705-710.
    """

    friction: float = parameter(doc="friction coefficient mu of fast slip", minimum=0.0, usual=(0.01, 2.0))
    drilling_speed: float = parameter(doc="slip speed v_d of half that coefficient", unit="m/s", above=0.0)

    @property
    def coefficient(self) -> Callable[..., float]:
        """0 at rest, mu for fast slip."""
        return _coefficient

    def is_fulfilled(
        self,
        slip: tuple[float, float],
        normal_force: float,
        tangential_force: tuple[float, float],
        tolerance: float,
    ) -> bool:
        """Return True if the force is that of this slip."""
        per_speed = self.friction * normal_force / (math.hypot(*slip) + self.drilling_speed)
        return all(abs(t + per_speed * v) <= tolerance for t, v in zip(tangential_force, slip, strict=True))
