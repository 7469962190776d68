"""Ground: what all shapes bounded by a single plane have in common."""

from __future__ import annotations

import math
from abc import abstractmethod
from typing import final

import numpy as np

from nonsmooth.interfaces import ConvexPart, Shape
from nonsmooth.interfaces.look import Look


class Ground(Shape):
    """All that lies below the plane z = height of the body frame, whose third axis is the normal."""

    @property
    @abstractmethod
    def height(self) -> float:
        """Height of the plane over the origin of the body frame [m]."""

    @property
    @final
    def length(self) -> float:
        """0: a plane is unbounded."""
        return 0.0

    @property
    @final
    def extent(self) -> float:
        """Infinite [m]."""
        return math.inf

    @property
    @final
    def ceiling(self) -> float:
        """The height [m]."""
        return self.height

    @property
    @final
    def parts(self) -> tuple[ConvexPart, ...]:
        """The half-space below."""
        return (ConvexPart.below(self.height),)

    @property
    @final
    def look(self) -> Look:
        """A plane without end."""
        return Look(np.array([[0.0, 0.0, self.height]]), sheet=True)
