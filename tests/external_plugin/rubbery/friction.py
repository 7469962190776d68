"""Friction that grows with the slip speed and levels off, as that of rubber."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import final

from nonsmooth.certificates import opposes_slip
from nonsmooth.interfaces import FrictionLaw
from nonsmooth.parameters import parameter


def _coefficient(speed: float, slow: float, fast: float, growth_speed: float) -> float:
    return slow + (fast - slow) * speed / (speed + growth_speed)


@final
@dataclass(frozen=True)
class Rubber(FrictionLaw):
    """A coefficient that grows from slow to fast slip."""

    slow: float = parameter(0.2, doc="coefficient at rest", above=0.0, usual=(0.01, 3.0))
    fast: float = parameter(0.5, doc="coefficient of fast slip", minimum=0.0, usual=(0.01, 3.0))
    growth_speed: float = parameter(0.1, doc="speed of half the growth", unit="m/s", above=0.0)

    @property
    def coefficient(self) -> Callable[..., float]:
        """The function above."""
        return _coefficient

    def is_fulfilled(
        self, slip: tuple[float, float], normal_force: float, tangential_force: tuple[float, float], tolerance: float
    ) -> bool:
        """Tell whether the force lies in the disc and, under slip, on its edge against the slip."""
        return opposes_slip(self, slip, normal_force, tangential_force, tolerance)
