"""FrictionLaw: the friction coefficient as a function of the slip speed."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable

from nonsmooth.parameters import Component


class FrictionLaw(Component, ABC):
    """Friction that opposes slip, bounded by a disc while sticking.

    The contract:

    1. ``coefficient`` is a plain function ``coefficient(speed, ...) >= 0`` of the slip speed [m/s]; its
       further arguments are parameters of the law.
    2. The value at speed 0 is the static limit; the limit from above is the coefficient of incipient slip.
    """

    @property
    @abstractmethod
    def coefficient(self) -> Callable[..., float]:
        """The function of point 1."""

    @abstractmethod
    def is_fulfilled(
        self,
        slip: tuple[float, float],
        normal_force: float,
        tangential_force: tuple[float, float],
        tolerance: float,
    ) -> bool:
        """Tell whether slip velocity [m/s], normal and tangential force [N] obey the law."""
