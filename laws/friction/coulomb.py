"""Coulomb friction with a static and a kinetic coefficient."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import final

from nonsmooth.certificates import opposes_slip
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import FrictionLaw
from nonsmooth.parameters import parameter


def _coefficient(speed: float, friction: float, static_friction: float) -> float:
    return friction if speed > 0.0 else static_friction


@final
@dataclass(frozen=True)
class Coulomb(FrictionLaw):
    """Coulomb's law, Eq. (17).

    ``Coulomb(0.2)`` takes the same coefficient for stick and slip.
    """

    friction: float = parameter(doc="kinetic friction coefficient mu", minimum=0.0, usual=(0.01, 2.0))
    static_friction: float | None = parameter(
        None, doc="static friction coefficient mu_s, by default mu", minimum=0.0, usual=(0.01, 2.0)
    )

    def _check(self) -> None:
        if self.static_friction is not None and self.static_friction < self.friction:
            raise InvalidInput(
                "Coulomb.static_friction",
                f"must be at least the kinetic coefficient {self.friction:g}",
                self.static_friction,
                "Raise it, or leave it out to take the kinetic one.",
            )

    def parameters(self) -> dict[str, float]:
        """Return both coefficients."""
        static = self.friction if self.static_friction is None else self.static_friction
        return {"friction": float(self.friction), "static_friction": float(static)}

    @property
    def coefficient(self) -> Callable[..., float]:
        """Mu for any slip, mu_s at rest."""
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
