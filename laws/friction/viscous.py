"""Friction that rises with the slip speed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import final

from nonsmooth.certificates import opposes_slip
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import FrictionLaw
from nonsmooth.parameters import parameter


def _coefficient(speed: float, friction: float, growth: float, largest: float) -> float:
    return min(friction + growth * speed, largest)


@final
@dataclass(frozen=True)
class Viscous(FrictionLaw):
    """Coulomb friction with a viscous part, mu(v) = mu + c |v|, up to a bound; with c = 0 it is Coulomb's law.

    Slip starts where stick ends, without a jump of the force.  Both parts are proportional to the normal force.
    The bound is there because a large coefficient leads into Painlevé's paradox.

    References
    ----------
    B. Armstrong-Hélouvry, P. Dupont, C. Canudas de Wit, "A survey of models, analysis tools and compensation methods
    for the control of machines with friction", Automatica 30 (1994) 1083-1138.
    """

    friction: float = parameter(doc="friction coefficient mu at rest", minimum=0.0, usual=(0.01, 2.0))
    growth: float = parameter(doc="rise per slip speed c", unit="s/m", minimum=0.0, usual=(1e-4, 1e3))
    largest: float = parameter(1.0, doc="bound of the coefficient", minimum=0.0, usual=(0.01, 10.0))

    def _check(self) -> None:
        if self.largest < self.friction:
            raise InvalidInput(
                "Viscous.largest",
                f"must be at least the coefficient at rest {self.friction:g}",
                self.largest,
                "Friction of this law rises with the slip speed.",
            )

    @property
    def coefficient(self) -> Callable[..., float]:
        """Mu(v) of the class."""
        return _coefficient

    def is_fulfilled(
        self,
        slip: tuple[float, float],
        normal_force: float,
        tangential_force: tuple[float, float],
        tolerance: float,
    ) -> bool:
        """Tell whether the force lies in the disc and, under slip, on its edge against the slip."""
        return opposes_slip(self, slip, normal_force, tangential_force, tolerance)
