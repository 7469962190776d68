"""A top, for what has a closed form."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from bodies import FreeBody, Sphere
from nonsmooth.interfaces import Shape


@final
@dataclass(frozen=True)
class Top(FreeBody):
    """A symmetric top of 1 kg, with a ball on its axis that touches things."""

    moments: tuple[float, float, float] = (0.01, 0.01, 0.02)
    arm: float = 0.1
    radius: float = 0.03

    @property
    def total_mass(self) -> float:
        """1 kg."""
        return 1.0

    @property
    def inertia(self) -> tuple[float, float, float]:
        """As given."""
        return self.moments

    @property
    def shapes(self) -> tuple[Shape, ...]:
        """The ball."""
        return (Sphere(self.radius, z=self.arm),)
