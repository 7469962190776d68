"""Friction by bristles that bend before they slip."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import final

from nonsmooth.certificates import follows_traction
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import TractionLaw
from nonsmooth.notices import warn
from nonsmooth.parameters import UnusualValue, parameter


def _traction(
    normal_force: float,
    motion: list[float],
    state: list[float],
    out: list[float],
    friction: float,
    static_friction: float,
    stribeck_speed: float,
    stiffness: float,
    damping: float,
    viscosity: float,
) -> None:
    load = max(0.0, normal_force)
    speed = math.sqrt(motion[0] * motion[0] + motion[1] * motion[1])
    ratio = speed / stribeck_speed
    bound = friction + (static_friction - friction) * math.exp(-ratio * ratio)
    for i in range(2):
        rate = motion[i] - stiffness * speed / bound * state[i]
        out[i] = -load * (stiffness * state[i] + damping * rate + viscosity * motion[i])
        out[5 + i] = rate
    for i in range(2, 5):
        out[i] = 0.0


@final
@dataclass(frozen=True)
class Bristle(TractionLaw):
    """The LuGre law in the plane, T = -N (s_0 z + s_1 z' + s_2 v) with the bending z' = v - s_0 |v| z / g(|v|).

    g(v) = mu + (mu_s - mu) exp(-(v / v_s)^2) is the coefficient in steady slip, where z = g v / (s_0 |v|).  Before
    that the contact gives way like a spring of stiffness N s_0.  What the bristles store counts as lost to friction
    until they give it back.

    With s_1 > 0 and mu_s > mu the law is passive only if s_2 >= s_1 (mu_s - mu) / mu: otherwise bristles bent by slow
    slip push on a fast one, and give more than they stored above the speed mu_s^2 / (s_1 (mu_s - mu) - s_2 mu).

    References
    ----------
    C. Canudas de Wit, H. Olsson, K. J. Astrom, P. Lischinsky, "A new model for control of systems with friction",
    IEEE Transactions on Automatic Control 40 (1995) 419-425;
    N. E. Barabanov, R. Ortega, "Necessary and sufficient conditions for passivity of the LuGre friction model", IEEE
    Transactions on Automatic Control 45 (2000) 830-832.
    """

    friction: float = parameter(doc="coefficient mu of fast slip", above=0.0, usual=(0.01, 2.0))
    static_friction: float = parameter(doc="coefficient mu_s of slow slip", above=0.0, usual=(0.01, 2.0))
    stribeck_speed: float = parameter(1e-2, doc="speed v_s of the fall", unit="m/s", above=0.0, usual=(1e-5, 1.0))
    stiffness: float = parameter(1e4, doc="stiffness s_0 per load", unit="1/m", above=0.0, usual=(1e1, 1e8))
    damping: float = parameter(0.0, doc="damping s_1 per load", unit="s/m", minimum=0.0, usual=(1e-4, 1e3))
    viscosity: float = parameter(0.0, doc="viscosity s_2 per load", unit="s/m", minimum=0.0, usual=(1e-4, 1e2))

    def _check(self) -> None:
        if self.static_friction < self.friction:
            raise InvalidInput(
                "Bristle.static_friction",
                f"must be at least the coefficient of fast slip {self.friction:g}",
                self.static_friction,
                "Take both alike for a constant coefficient.",
            )
        least = self.damping * (self.static_friction - self.friction) / self.friction
        if self.viscosity < least:
            speed = self.static_friction**2 / (self.friction * (least - self.viscosity))
            warn(
                f"Bristle.viscosity = {self.viscosity:g} [s/m] is less than damping (mu_s - mu) / mu = {least:g}: "
                f"in slip faster than {speed:g} m/s bent bristles give more energy than they stored.",
                UnusualValue,
            )

    @property
    def traction(self) -> Callable[..., None]:
        """Force and rate of the bending."""
        return _traction

    @property
    def initial_state(self) -> tuple[float, ...]:
        """Bristles that stand upright, z = 0 [m]."""
        return (0.0, 0.0)

    @property
    def state_scale(self) -> tuple[float, ...]:
        """The bending in slow slip [m]."""
        return (self.static_friction / self.stiffness,) * 2

    def is_fulfilled(
        self,
        motion: tuple[float, float, float, float, float],
        state: tuple[float, ...],
        normal_force: float,
        traction: tuple[float, float, float, float, float],
        tolerance: float,
    ) -> bool:
        """Return True if the force is the force of this law, within the tolerance [N]."""
        return follows_traction(self, motion, state, normal_force, traction, tolerance)
