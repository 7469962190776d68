"""Friction of slip, drilling and rolling of a contact patch of some size."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import final

from nonsmooth.certificates import follows_traction
from nonsmooth.interfaces import TractionLaw
from nonsmooth.parameters import parameter


def _traction(
    normal_force: float,
    motion: list[float],
    state: list[float],
    out: list[float],
    friction: float,
    drilling_radius: float,
    rolling_length: float,
    presliding: float,
    prerolling: float,
    relaxation: float,
) -> None:
    load = max(0.0, normal_force)
    drilling = drilling_radius * motion[4]
    speed = math.sqrt(motion[0] * motion[0] + motion[1] * motion[1] + drilling * drilling)
    turning = math.sqrt(motion[2] * motion[2] + motion[3] * motion[3])
    for i in range(2):
        rate = motion[i] - speed / presliding * state[i]
        out[i] = -friction * load / presliding * (state[i] + relaxation * rate)
        out[5 + i] = rate
        rate = motion[2 + i] - turning / prerolling * state[2 + i]
        out[2 + i] = -rolling_length * load / prerolling * (state[2 + i] + relaxation * rate)
        out[7 + i] = rate
    rate = drilling - speed / presliding * state[4]
    out[4] = -friction * drilling_radius * load / presliding * (state[4] + relaxation * rate)
    out[9] = rate


@final
@dataclass(frozen=True)
class CoulombContensou(TractionLaw):
    """Coulomb's law over a patch: slip and drilling share one bound, rolling has its own.

    In steady motion T = -mu N v / w and M_3 = -mu N c^2 omega_3 / w with w^2 = |v|^2 + (c omega_3)^2, the ellipsoid
    that approximates the bound of Contensou: what drills rubs against a slow slip as a viscous fluid does.
    The drilling radius c is 2 R / 3 for a disc of radius R under even pressure and 3 pi a / 16 for a Hertzian contact
    of radius a.  Rolling is resisted by the moment rho N against its angular velocity, rho being the rolling length.

    Both bounds are reached through bristles, so that the contact comes to rest: they bend by ``presliding`` and
    ``prerolling`` before they give way, and what they store counts as lost until they give it back.

    References
    ----------
    R. I. Leine, Ch. Glocker, "A set-valued force law for spatial Coulomb-Contensou friction", European Journal of
    Mechanics A/Solids 22 (2003) 193-216;
    R. D. Howe, M. R. Cutkosky, "Practical force-motion models for sliding manipulation", International Journal of
    Robotics Research 15 (1996) 557-572, for the ellipsoid;
    J. Ai, J.-F. Chen, J. M. Rotter, J. Y. Ooi, "Assessment of rolling resistance models in discrete element
    simulations", Powder Technology 206 (2011) 269-282, for rolling.
    """

    friction: float = parameter(doc="friction coefficient mu", minimum=0.0, usual=(0.01, 2.0))
    drilling_radius: float = parameter(0.0, doc="drilling radius c", unit="m", minimum=0.0, usual=(1e-6, 0.1))
    rolling_length: float = parameter(0.0, doc="rolling length rho", unit="m", minimum=0.0, usual=(1e-7, 1e-2))
    presliding: float = parameter(1e-6, doc="slip that bends the bristles", unit="m", above=0.0, usual=(1e-8, 1e-3))
    prerolling: float = parameter(1e-3, doc="the same of rolling", unit="rad", above=0.0, usual=(1e-6, 0.1))
    relaxation: float = parameter(0.0, doc="damping time of the bristles", unit="s", minimum=0.0, usual=(1e-7, 1e-1))

    @property
    def traction(self) -> Callable[..., None]:
        """Force, moment and rates of the bending."""
        return _traction

    @property
    def initial_state(self) -> tuple[float, ...]:
        """Bristles that stand upright: slip along both tangents [m], rolling [rad], drilling [m]."""
        return (0.0, 0.0, 0.0, 0.0, 0.0)

    @property
    def state_scale(self) -> tuple[float, ...]:
        """The bending in steady motion, in the order of the states."""
        return (self.presliding, self.presliding, self.prerolling, self.prerolling, self.presliding)

    def is_fulfilled(
        self,
        motion: tuple[float, float, float, float, float],
        state: tuple[float, ...],
        normal_force: float,
        traction: tuple[float, float, float, float, float],
        tolerance: float,
    ) -> bool:
        """Return True if force and moment are those of this law, within the tolerance."""
        return follows_traction(self, motion, state, normal_force, traction, tolerance)
