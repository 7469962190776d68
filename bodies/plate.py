"""Plate: a driven body with a plane."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from bodies.prescribed import Driven
from bodies.shapes.plane import Plane
from nonsmooth.interfaces import Shape


@final
@dataclass(frozen=True)
class Plate(Driven):
    """An unbounded plate with the normal (0, 0, 1) in its own frame, moving as ``motion`` says."""

    @property
    def frames(self) -> tuple[tuple[Shape, ...], ...]:
        """One frame with the plane through its origin."""
        return ((Plane(),),)
