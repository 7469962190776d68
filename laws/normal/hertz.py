"""An elastic contact of curved surfaces."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import final

from nonsmooth.certificates import follows_compliance
from nonsmooth.interfaces import CompliantNormalLaw
from nonsmooth.parameters import parameter


def _force(indentation: float, rate: float, closing_rate: float, stiffness: float, exponent: float) -> float:
    return stiffness * indentation**exponent if indentation > 0.0 else 0.0


@final
@dataclass(frozen=True)
class HertzCompliant(CompliantNormalLaw):
    """The law of Hertz, F = k x^(3/2), or another power of the indentation.

    For two bodies k = 4/3 E* sqrt(R*), :func:`laws.hertz_stiffness`.

    References
    ----------
    K. L. Johnson, *Contact Mechanics*, Cambridge University Press (1985), section 4.2.
    """

    stiffness: float = parameter(doc="stiffness k", unit="N/m^exponent", above=0.0, usual=(1e4, 1e12))
    exponent: float = parameter(1.5, doc="exponent eta, 1.5 of Hertz, 1 linear", minimum=1.0, usual=(1.0, 3.0))

    @property
    def force(self) -> Callable[..., float]:
        """Function that computes the normal force [N] from the indentation x [m], by the formula of the class."""
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
