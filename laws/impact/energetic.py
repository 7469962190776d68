"""Energetic multiple impact after Liu, Zhao and Brogliato."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import final

from laws.impact.power import power_force
from nonsmooth.interfaces import ImpactProcess
from nonsmooth.parameters import parameter


def _efficiency(rate: float, restitution: float) -> float:
    return 1.0 if rate <= 0.0 else restitution * restitution


@final
@dataclass(frozen=True)
class EnergeticImpact(ImpactProcess):
    """The bi-stiffness law of Eqs. (19)-(28), with friction, for any number of coupled contacts.

    Only ratios of stiffness matter where all exponents are equal, so 1 will do for contacts of one material.

    References
    ----------
    C. Liu, Z. Zhao, B. Brogliato, "Frictionless multiple impacts in multibody systems. I. Theoretical
    framework", Proc. R. Soc. A 464 (2008) 3193-3211.
    """

    restitution: float = parameter(doc="energetic coefficient of restitution e", minimum=0.0, maximum=1.0)
    stiffness: float = parameter(
        1.0, doc="contact stiffness k of F = k x^eta, relative to the other contacts", unit="N/m^eta", above=0.0
    )
    exponent: float = parameter(1.5, doc="exponent eta of F = k x^eta (3/2 Hertz, 1 linear)", minimum=1.0, maximum=10.0)
    duration: float = parameter(
        2e-5, doc="contact time T_c of the accumulation rule (33)", unit="s", minimum=0.0, usual=(1e-12, 1e-2)
    )

    @property
    def force(self) -> Callable[..., float]:
        """K x^eta, Eq. (20)."""
        return power_force

    @property
    def efficiency(self) -> Callable[..., float]:
        """1 in compression, e^2 in expansion, Eq. (28)."""
        return _efficiency

    @property
    def contact_time(self) -> float:
        """The parameter ``duration`` [s]."""
        return self.duration

    def is_fulfilled(self, stored: float, returned: float, tolerance: float) -> bool:
        """Tell whether the share e^2 of the stored energy [J] came back."""
        return abs(returned - self.restitution**2 * stored) <= tolerance
