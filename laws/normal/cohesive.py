"""A contact that pulls back before it lets go."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import final

from nonsmooth.certificates import follows_compliance
from nonsmooth.interfaces import CompliantNormalLaw
from nonsmooth.parameters import parameter


def _force(indentation: float, rate: float, closing_rate: float, stiffness: float, damping: float) -> float:
    return stiffness * indentation + damping * rate


@final
@dataclass(frozen=True)
class Cohesive(CompliantNormalLaw):
    """A spring and damper that hold on up to a largest tension, F = k x + c x' down to x = -T / k.

    The bodies attract each other only once they have touched, and part when the spring pulls with T: a ball of mass m
    gets away iff it is faster than T / sqrt(m k) where the gap reopens, c being zero.  While the contact pulls it
    does not rub.  It is the simplest law of limited tension; that of Johnson, Kendall and Roberts has as well a reach
    and a hysteresis, but another shape.

    References
    ----------
    K. L. Johnson, K. Kendall, A. D. Roberts, "Surface energy and the contact of elastic solids", Proceedings of the
    Royal Society A 324 (1971) 301-313, for the hysteresis.
    """

    stiffness: float = parameter(doc="stiffness k", unit="N/m", above=0.0, usual=(1e2, 1e10))
    tension: float = parameter(doc="largest pull T of the spring", unit="N", minimum=0.0, usual=(1e-9, 1e3))
    damping: float = parameter(0.0, doc="damping c", unit="N s/m", minimum=0.0, usual=(1e-6, 1e6))

    @property
    def force(self) -> Callable[..., float]:
        """F(x, x') of the class."""
        return _force

    @property
    def reach(self) -> float:
        """The gap T / k at which it lets go [m]."""
        return self.tension / self.stiffness

    def is_fulfilled(
        self, indentation: float, rate: float, closing_rate: float, force: float, tolerance: float
    ) -> bool:
        """Return True if the force is the force of this law, within the tolerance [N]."""
        return follows_compliance(self, indentation, rate, closing_rate, force, tolerance)
