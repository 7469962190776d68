"""Lens: what two equal balls have in common."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.bodies import SupportShape
from nonsmooth.parameters import parameter


@final
@dataclass(frozen=True)
class Lens(SupportShape):
    """What two equal balls have in common; its rim, in the plane z = 0, is sharp."""

    radius: float = parameter(0.02, doc="radius of the balls", unit="m", above=0.0)
    rim: float = parameter(0.01, doc="radius of the rim, below that of the balls", unit="m", above=0.0)

    def support(self, direction: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return a point of a cap or of the rim [m]."""
        n = direction / math.sqrt(np.sum(direction * direction))
        across = math.sqrt(n[0] ** 2 + n[1] ** 2)
        if across * self.radius <= self.rim:
            depth = math.sqrt(self.radius**2 - self.rim**2)
            return np.asarray(self.radius * n - np.array([0.0, 0.0, math.copysign(depth, n[2])]))
        return np.asarray(self.rim / across * np.array([n[0], n[1], 0.0]))
