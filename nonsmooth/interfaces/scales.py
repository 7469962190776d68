"""Sizes of a system: of its smallest body, its accelerations and its prescribed motions."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import final

EARTH = 9.81
"""Acceleration of a fall on Earth [m/s^2]."""


@final
@dataclass(frozen=True)
class Scales:
    """Sizes of a system, from which an engine chooses its tolerances.

    Attributes
    ----------
    length : float
        Size of the smallest free body [m].
    acceleration : float
        Acceleration that is typical of the bodies [m/s^2], at most :data:`EARTH`.
    period : float
        Shortest time over which a prescribed motion changes [s]; infinite without one.
    """

    length: float
    acceleration: float
    period: float

    @property
    def speed(self) -> float:
        """Speed of the smallest body after a fall through its own size [m/s], without the factor sqrt(2)."""
        return math.sqrt(self.acceleration * self.length)

    @property
    def time(self) -> float:
        """Time of this fall [s], without the factor sqrt(2)."""
        return math.sqrt(self.length / self.acceleration)
