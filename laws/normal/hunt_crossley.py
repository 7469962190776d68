"""A contact whose damping grows with the indentation."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import final

from nonsmooth.certificates import follows_compliance
from nonsmooth.interfaces import CompliantNormalLaw
from nonsmooth.parameters import parameter


def _force(
    indentation: float, rate: float, closing_rate: float, stiffness: float, exponent: float, dissipation: float
) -> float:
    return stiffness * indentation**exponent * max(0.0, 1.0 + dissipation * rate) if indentation > 0.0 else 0.0


@final
@dataclass(frozen=True)
class HuntCrossley(CompliantNormalLaw):
    """The law of Hunt and Crossley, F = k x^eta (1 + d x').

    The force is continuous where the contact closes and opens, and does not pull.  The restitution e of an impact at
    the speed v fulfils (1 + e) d v = ln((1 + d v) / (1 - e d v)) for every k and eta, next to e = 1 - 2 d v / 3
    for slow ones; the original paper has d = 3 a / 2 for restitution 1 - a v.

    References
    ----------
    K. H. Hunt, F. R. E. Crossley, "Coefficient of restitution interpreted as damping in vibroimpact", Journal of
    Applied Mechanics 42 (1975) 440-445.
    """

    stiffness: float = parameter(doc="stiffness k", unit="N/m^exponent", above=0.0, usual=(1e4, 1e12))
    dissipation: float = parameter(doc="damping d", unit="s/m", minimum=0.0, usual=(1e-3, 1e2))
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
