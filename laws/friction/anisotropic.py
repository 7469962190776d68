"""Friction with another coefficient along an axis of a body than across it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, final

from nonsmooth.certificates import lies_in_half_ellipses
from nonsmooth.interfaces import AnisotropicFrictionLaw
from nonsmooth.parameters import Value, parameter

from .axis import axis_parameter, body_parameter, check_axis


def _coefficient(speed: float, strongest: float) -> float:
    return strongest


@final
@dataclass(frozen=True)
class Anisotropic(AnisotropicFrictionLaw):
    """Coulomb friction within an ellipse, whose axes are fixed to one of the bodies.

    The force takes as much energy out of the slip as any in the ellipse: it does not oppose the slip, but for slip
    along or across the axis.

    References
    ----------
    A. Zmitrowicz, "A theoretical model of anisotropic dry friction", Wear 73 (1981) 9-39;
    S. V. Walker, R. I. Leine, "Set-valued anisotropic dry friction laws: formulation, experimental verification and
    instability phenomenon", Nonlinear Dynamics 96 (2019) 885-920.
    """

    along: float = parameter(doc="friction coefficient along the axis", above=0.0, usual=(0.01, 2.0))
    across: float = parameter(doc="friction coefficient across the axis", above=0.0, usual=(0.01, 2.0))
    axis: tuple[float, float, float] = axis_parameter()
    body: Literal["first", "second"] = body_parameter()

    def _check(self) -> None:
        check_axis("Anisotropic.axis", self.axis)

    def parameters(self) -> dict[str, Value]:
        """Return the coefficients, and the larger of them."""
        return {"along": self.along, "across": self.across, "strongest": max(self.along, self.across)}

    @property
    def ratios(self) -> tuple[float, float, float]:
        """The coefficients along, backward too, and across, as parts of the largest."""
        largest = max(self.along, self.across)
        return self.along / largest, self.along / largest, self.across / largest

    @property
    def coefficient(self) -> Callable[..., float]:
        """The larger coefficient, for the slip that counts."""
        return _coefficient

    def is_fulfilled(
        self,
        slip: tuple[float, float],
        normal_force: float,
        tangential_force: tuple[float, float],
        tolerance: float,
    ) -> bool:
        """Return True if the tangential force obeys the law, within the tolerance [N].

        The force must lie within the friction ellipse.  During slip it must be the point of the ellipse whose outward
        normal is opposite to the slip velocity.
        """
        return lies_in_half_ellipses(self, slip, normal_force, tangential_force, tolerance)
