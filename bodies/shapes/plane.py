"""Plane, the boundary of a half-space."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import final

from nonsmooth.interfaces import Shape
from nonsmooth.parameters import parameter


@final
@dataclass(frozen=True)
class Plane(Shape):
    """The plane z = height of the body frame; the body lies below, its normal is the frame's third axis."""

    height: float = parameter(0.0, doc="height over the origin of the body frame", unit="m")

    @property
    def length(self) -> float:
        """0: a plane is unbounded."""
        return 0.0

    @property
    def extent(self) -> float:
        """Infinite [m]."""
        return math.inf
