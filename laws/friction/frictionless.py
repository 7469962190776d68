"""The null object of friction."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import final

from nonsmooth.interfaces import FrictionLaw


def _coefficient(speed: float) -> float:
    return 0.0


@final
@dataclass(frozen=True)
class Frictionless(FrictionLaw):
    """No tangential force."""

    @property
    def coefficient(self) -> Callable[..., float]:
        """Zero at every speed."""
        return _coefficient

    def is_fulfilled(
        self,
        slip: tuple[float, float],
        normal_force: float,
        tangential_force: tuple[float, float],
        tolerance: float,
    ) -> bool:
        """Tell whether the tangential force vanishes."""
        return math.hypot(*tangential_force) <= tolerance
