"""Energetic multiple impact with one stiffness for compression and expansion."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import final

from nonsmooth.parameters import parameter

from .power import PowerProcess, duration_parameter, exponent_parameter, stiffness_parameter


def _efficiency(rate: float, restitution: float) -> float:
    # at the turn: the share that comes back before the contact opens
    return restitution * restitution if rate == 0.0 else 1.0


@final
@dataclass(frozen=True)
class MonoStiffnessImpact(PowerProcess):
    """The mono-stiffness law: expansion goes back along the curve of compression and ends under load.

    A contact opens when the share e^2 of the energy that it held at the end of its last compression has come
    back; what it still holds is lost then.  In the bi-stiffness law
    (:class:`~laws.impact.energetic.EnergeticImpact`) it is lost all along the expansion, on a steeper curve.  On a
    contact by itself both do the same; where contacts act on each other they differ.

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
        """1 in both phases; e^2 of the energy at the turn comes back."""
        return _efficiency

    def is_fulfilled(self, stored: float, returned: float, tolerance: float) -> bool:
        """Tell whether at least the share e^2 of the stored energy [J] came back, and no more than all.

        A contact that is compressed again before it opens gives back more than that share.
        """
        return self.restitution**2 * stored - tolerance <= returned <= stored + tolerance
