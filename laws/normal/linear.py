"""A linear spring and damper between two bodies in contact."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import final

from nonsmooth.certificates import follows_compliance
from nonsmooth.interfaces import CompliantNormalLaw
from nonsmooth.parameters import parameter


def _force(indentation: float, rate: float, closing_rate: float, stiffness: float, damping: float) -> float:
    return max(0.0, stiffness * indentation + damping * rate)


@final
@dataclass(frozen=True)
class LinearCompliant(CompliantNormalLaw):
    """The law of Kelvin and Voigt without tension, F = max(0, k x + c x').

    With damping the force jumps to c x' where the contact closes, and vanishes before the bodies part.

    References
    ----------
    T. Schwager, T. Poeschel, "Coefficient of restitution and linear-dashpot model revisited", Granular Matter 9
    (2007) 465-469.
    """

    stiffness: float = parameter(doc="stiffness k", unit="N/m", above=0.0, usual=(1e2, 1e10))
    damping: float = parameter(0.0, doc="damping c", unit="N s/m", minimum=0.0, usual=(1e-6, 1e6))

    @property
    def force(self) -> Callable[..., float]:
        """Function that computes the normal force [N] from the indentation x [m] and its rate x' [m/s].

        Its formula is that of the class.
        """
        return _force

    @property
    def reach(self) -> float:
        """Largest gap at which this law gives a force [m]: 0, because the law has no adhesion."""
        return 0.0

    def is_fulfilled(
        self, indentation: float, rate: float, closing_rate: float, force: float, tolerance: float
    ) -> bool:
        """Return True if the force is the force of this law, within the tolerance [N]."""
        return follows_compliance(self, indentation, rate, closing_rate, force, tolerance)
