"""Plate: a driven body with a plane."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from nonsmooth.interfaces import Shape

from .prescribed import Driven
from .shapes.plane import Plane


@final
@dataclass(frozen=True)
class Plate(Driven):
    """An unbounded plate with the normal (0, 0, 1) in its own frame, moving as ``motion`` says."""

    @property
    def frames(self) -> tuple[tuple[Shape, ...], ...]:
        """One frame with the plane through its origin."""
        return ((Plane(),),)
