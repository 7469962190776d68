"""Closed forms for the contact of the sliding rod, whose gap accelerates by g'' = A lambda_N + b in forward slip.

They give A (the reduced coefficient), the friction coefficient at which A vanishes, and b, the acceleration of the gap
without a normal force lambda_N.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import final


@final
@dataclass(frozen=True)
class RodContact:
    """Contact of a uniform thin rod, whose lower end touches the ground ahead of its mass centre.

    While that end slides forwards, its gap accelerates by g'' = A lambda_N + b, with the normal force lambda_N.  If
    A < 0 and b < 0, no normal force exists (Painleve's paradox).

    Attributes
    ----------
    mass : float
        Mass of the rod [kg].
    half_length : float
        Distance from the middle to the centre of an end [m].
    end_radius : float
        Radius of the ends [m].
    """

    mass: float
    half_length: float
    end_radius: float

    @property
    def inertia(self) -> float:
        """Moment of inertia about the middle, across the rod [kg m^2]."""
        return self.mass * self.half_length**2 / 3.0

    def arm(self, tilt: float) -> tuple[float, float]:
        """Return how far the contact point is ahead of the rod's middle, along the slip, and how far below it [m]."""
        return self.half_length * math.cos(tilt), self.half_length * math.sin(tilt) + self.end_radius

    def reduced_coefficient(self, tilt: float, friction: float) -> float:
        """Return A of g'' = A lambda_N + b in forward slip [1/kg]."""
        ahead, below = self.arm(tilt)
        return 1.0 / self.mass + ahead * (ahead - friction * below) / self.inertia

    def free_acceleration(self, tilt: float, rate: float, gravity: float) -> float:
        """Return b of g'' = A lambda_N + b [m/s^2]; if A and b are positive, the end lifts off."""
        return self.half_length * math.sin(tilt) * rate**2 - gravity

    def critical_friction(self, tilt: float) -> float:
        """Return the friction coefficient at which A vanishes."""
        ahead, below = self.arm(tilt)
        return (self.inertia / self.mass + ahead * ahead) / (ahead * below)
