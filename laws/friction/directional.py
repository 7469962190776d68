"""Friction with another coefficient one way along an axis of a body than the other way."""

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
class Directional(AnisotropicFrictionLaw):
    """Coulomb friction within two half ellipses, joined across the axis, as that of fur, skis or a snake's scales.

    The force takes as much energy out of the slip as any in the bound.  In an impact the half ellipse is that
    of the slip with which it begins.

    References
    ----------
    D. L. Hu, J. Nirody, T. Scott, M. J. Shelley, "The mechanics of slithering locomotion", Proceedings of the
    National Academy of Sciences 106 (2009) 10081-10085, for the three coefficients.
    """

    forward: float = parameter(doc="friction coefficient of forward slip", above=0.0, usual=(0.01, 2.0))
    backward: float = parameter(doc="friction coefficient of backward slip", above=0.0, usual=(0.01, 2.0))
    across: float = parameter(doc="friction coefficient of slip across the axis", above=0.0, usual=(0.01, 2.0))
    axis: tuple[float, float, float] = axis_parameter()
    body: Literal["first", "second"] = body_parameter()

    def _check(self) -> None:
        check_axis("Directional.axis", self.axis)

    def parameters(self) -> dict[str, Value]:
        """Return the coefficients, and the largest of them."""
        coefficients = {"forward": self.forward, "backward": self.backward, "across": self.across}
        return {**coefficients, "strongest": max(coefficients.values())}

    @property
    def ratios(self) -> tuple[float, float, float]:
        """The coefficients forward, backward and across, as parts of the largest."""
        largest = max(self.forward, self.backward, self.across)
        return self.forward / largest, self.backward / largest, self.across / largest

    @property
    def coefficient(self) -> Callable[..., float]:
        """The largest coefficient, for the slip that counts."""
        return _coefficient

    def is_fulfilled(
        self,
        slip: tuple[float, float],
        normal_force: float,
        tangential_force: tuple[float, float],
        tolerance: float,
    ) -> bool:
        """Return True if the tangential force obeys the law, within the tolerance [N].

        The force must lie within the friction bound, which consists of half ellipses in the tangent plane.  During slip
        it must be the point of the bound whose outward normal is opposite to the slip velocity.
        """
        return lies_in_half_ellipses(self, slip, normal_force, tangential_force, tolerance)
