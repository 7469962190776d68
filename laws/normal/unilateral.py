"""Unilateral contact: no penetration, no tension."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from nonsmooth.interfaces import RigidNormalLaw


@final
@dataclass(frozen=True)
class Unilateral(RigidNormalLaw):
    """Signorini's law at acceleration level, Eq. (16): g'' >= 0, lambda_N >= 0, one of them zero."""

    def is_fulfilled(self, acceleration: float, force: float, tolerance: float) -> bool:
        """Tell whether the pair is complementary within the tolerance."""
        return acceleration >= -tolerance and force >= -tolerance and min(abs(acceleration), abs(force)) <= tolerance
