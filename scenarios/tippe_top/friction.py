"""Coulomb friction of a small contact disc that spins: slip meets less than mu N, and nothing sticks."""

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
    """mu v / (v + v_d), with v_d = 8 R omega / (3 pi) for a Hertzian disc of radius R that spins at omega.

    Every point of the disc rubs, each against its own velocity; what is left against the slip v of the whole disc is
    proportional to v where that is slow, so that there is no static friction.  The fraction is exact in slope at
    v = 0 and in its limit mu, and omega is a constant here.  The moment against the spin is left out.

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
        """Tell whether the force is the one of this slip."""
        per_speed = self.friction * normal_force / (math.hypot(*slip) + self.drilling_speed)
        return all(abs(t + per_speed * v) <= tolerance for t, v in zip(tangential_force, slip, strict=True))
