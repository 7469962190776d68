"""Friction that falls with the slip speed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import final

from nonsmooth.certificates import opposes_slip
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import FrictionLaw
from nonsmooth.parameters import parameter


def _coefficient(speed: float, static_friction: float, decay: float, fast_friction: float) -> float:
    return fast_friction + (static_friction - fast_friction) / (1.0 + decay * speed)


@final
@dataclass(frozen=True)
class Stribeck(FrictionLaw):
    """A hyperbolic fall from the static coefficient, mu(v) = mu_f + (mu_s - mu_f) / (1 + delta |v|).

    Slip starts where stick ends, without a jump of the force.

    References
    ----------
    R. I. Leine, D. H. van Campen, A. de Kraker, L. van den Steen, "Stick-slip vibrations induced by alternate friction
    models", Nonlinear Dynamics 16 (1998) 41-54, with mu_f = 0.
    """

    static_friction: float = parameter(doc="static friction coefficient mu_s", minimum=0.0, usual=(0.01, 2.0))
    decay: float = parameter(doc="fall per slip speed delta", unit="s/m", minimum=0.0, usual=(1e-3, 1e4))
    fast_friction: float = parameter(0.0, doc="coefficient of very fast slip mu_f", minimum=0.0, usual=(0.0, 2.0))

    def _check(self) -> None:
        if self.fast_friction > self.static_friction:
            raise InvalidInput(
                "Stribeck.fast_friction",
                f"must be at most the static coefficient {self.static_friction:g}",
                self.fast_friction,
                "Friction of this law falls with the slip speed.",
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
