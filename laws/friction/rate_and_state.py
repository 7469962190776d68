"""Friction that depends on the slip speed and on how long the surfaces have been in contact."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import final

from nonsmooth.certificates import opposes_slip
from nonsmooth.interfaces import StatefulFrictionLaw
from nonsmooth.parameters import parameter


def _coefficient(
    speed: float,
    state: tuple[float, ...],
    friction: float,
    direct: float,
    evolution: float,
    reference_speed: float,
    length: float,
) -> float:
    aged = math.log(1.0 + reference_speed * max(0.0, state[0]) / length)
    return max(0.0, friction + direct * math.log(1.0 + speed / reference_speed) + evolution * aged)


def _rates(speed: float, state: list[float], out: list[float], length: float) -> None:
    out[0] = 1.0 - speed * state[0] / length


@final
@dataclass(frozen=True)
class RateAndState(StatefulFrictionLaw):
    """The law of Dieterich and Ruina with ageing, mu = mu_0 + a ln(1 + |v| / v_0) + b ln(1 + v_0 theta / L).

    The age theta of the contacts starts from zero, grows with time at rest, theta' = 1 - |v| theta / L, and comes to
    L / |v| in steady slip.  The ones under the logarithms, which rate-and-state friction of rocks goes without, let it
    come to rest: the contact sticks as long as mu at speed 0 and the present age can hold it, and the longer it has
    stuck the more it takes to get it going.

    References
    ----------
    J. H. Dieterich, "Modeling of rock friction: 1. Experimental results and constitutive equations", Journal of
    Geophysical Research 84 (1979) 2161-2168;
    A. Ruina, "Slip instability and state variable friction laws", Journal of Geophysical Research 88 (1983)
    10359-10370.
    """

    friction: float = parameter(doc="coefficient mu_0 at rest and fresh", minimum=0.0, usual=(0.01, 2.0))
    direct: float = parameter(doc="direct effect a of the speed", minimum=0.0, usual=(1e-4, 0.1))
    evolution: float = parameter(doc="effect b of the age", minimum=0.0, usual=(1e-4, 0.1))
    reference_speed: float = parameter(doc="speed v_0", unit="m/s", above=0.0, usual=(1e-9, 1e-1))
    length: float = parameter(doc="slip L that renews the contacts", unit="m", above=0.0, usual=(1e-7, 1e-2))

    @property
    def coefficient(self) -> Callable[..., float]:
        """Mu of speed and age."""
        return _coefficient

    @property
    def rates(self) -> Callable[..., None]:
        """The rate of the age."""
        return _rates

    @property
    def initial_state(self) -> tuple[float, ...]:
        """A fresh contact."""
        return (0.0,)

    @property
    def state_scale(self) -> tuple[float, ...]:
        """The age after which the logarithm begins to count."""
        return (self.length / self.reference_speed,)

    def is_fulfilled(
        self,
        slip: tuple[float, float],
        normal_force: float,
        tangential_force: tuple[float, float],
        tolerance: float,
        state: tuple[float, ...] | None = None,
    ) -> bool:
        """Return True if the force obeys the law at the contact's age theta [s], by default that of a fresh contact."""
        return opposes_slip(self, slip, normal_force, tangential_force, tolerance, state)
