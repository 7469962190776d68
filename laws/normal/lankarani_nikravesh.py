"""A contact whose damping is scaled to the speed of the impact."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import final

from nonsmooth.certificates import follows_compliance
from nonsmooth.interfaces import CompliantNormalLaw
from nonsmooth.parameters import parameter


def _force(
    indentation: float, rate: float, closing_rate: float, stiffness: float, exponent: float, restitution: float
) -> float:
    if indentation <= 0.0:
        return 0.0
    if closing_rate <= 0.0:
        return float(stiffness * indentation**exponent)
    damping = 0.75 * (1.0 - restitution * restitution) / closing_rate
    return float(stiffness * indentation**exponent) * max(0.0, 1.0 + damping * rate)


@final
@dataclass(frozen=True)
class LankaraniNikravesh(CompliantNormalLaw):
    """The law of Lankarani and Nikravesh, F = k x^eta (1 + 3 (1 - e^2) x' / (4 v)), the contact having closed at v.

    It was derived for restitution next to 1 and returns more energy than e says where e is small: e = 0.5 comes back
    as 0.725, e = 0 as 0.663.  A contact that was closed from the start is elastic.

    References
    ----------
    H. M. Lankarani, P. E. Nikravesh, "A contact force model with hysteresis damping for impact analysis of multibody
    systems", Journal of Mechanical Design 112 (1990) 369-376.
    """

    stiffness: float = parameter(doc="stiffness k", unit="N/m^exponent", above=0.0, usual=(1e4, 1e12))
    restitution: float = parameter(doc="restitution e", minimum=0.0, maximum=1.0, usual=(0.5, 1.0))
    exponent: float = parameter(1.5, doc="exponent eta, 1.5 of Hertz, 1 linear", minimum=1.0, usual=(1.0, 3.0))

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
