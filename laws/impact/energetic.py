"""Energetic multiple impact after Liu, Zhao and Brogliato."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import final

from nonsmooth.parameters import parameter

from .power import PowerProcess, duration_parameter, exponent_parameter, stiffness_parameter


def _efficiency(rate: float, restitution: float) -> float:
    return 1.0 if rate <= 0.0 else restitution * restitution


@final
@dataclass(frozen=True)
class EnergeticImpact(PowerProcess):
    """The bi-stiffness law of Eqs. (19)-(28), with friction, for any number of coupled contacts.

    Only ratios of stiffness matter where all exponents are equal, so 1 will do for contacts of one material.

    References
    ----------
    C. Liu, Z. Zhao, B. Brogliato, "Frictionless multiple impacts in multibody systems. I. Theoretical
    framework", Proc. R. Soc. A 464 (2008) 3193-3211.
    """

    restitution: float = parameter(doc="energetic coefficient of restitution e", minimum=0.0, maximum=1.0)
    stiffness: float = stiffness_parameter()
    exponent: float = exponent_parameter()
    duration: float = duration_parameter()

    @property
    def efficiency(self) -> Callable[..., float]:
        """1 in compression, e^2 in expansion, Eq. (28)."""
        return _efficiency

    def is_fulfilled(self, stored: float, returned: float, tolerance: float) -> bool:
        """Tell whether the share e^2 of the stored energy [J] came back."""
        return abs(returned - self.restitution**2 * stored) <= tolerance
