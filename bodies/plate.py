"""Plate: a driven body with a plane."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, final

import numpy as np

from bodies.motions.rest import Rest
from bodies.shapes.plane import Plane
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Body, Motion, Shape
from nonsmooth.interfaces.body import Vector
from nonsmooth.parameters import Value


@final
@dataclass(frozen=True)
class Plate(Body):
    """An unbounded plate with the normal (0, 0, 1) in its own frame, moving as ``motion`` says."""

    motion: Motion = field(default_factory=Rest)

    def _check(self) -> None:
        if not isinstance(self.motion, Motion):
            raise InvalidInput("Plate.motion", "must be a Motion", self.motion, "For example Harmonic(...) or Rest().")

    def parameters(self) -> Mapping[str, Value]:
        """Return the motion's parameters."""
        return self.motion.parameters()

    @property
    def frames(self) -> tuple[tuple[Shape, ...], ...]:
        """One frame with the plane through its origin."""
        return ((Plane(),),)

    @property
    def n_q(self) -> int:
        """0: driven."""
        return 0

    @property
    def n_u(self) -> int:
        """0: driven."""
        return 0

    @property
    def quaternion(self) -> int:
        """None."""
        return -1

    @property
    def evaluator(self) -> Callable[..., None]:
        """The motion's."""
        return self.motion.evaluator

    @property
    def scales(self) -> tuple[Vector, Vector]:
        """Empty."""
        return np.zeros(0), np.zeros(0)

    @property
    def time_scale(self) -> float:
        """The motion's [s]."""
        return self.motion.time_scale

    def state(self, **start: Any) -> tuple[Vector, Vector]:
        """Return empty vectors; a driven body cannot be placed."""
        if start:
            raise InvalidInput(
                "start of a Plate", "must not be given", sorted(start), "Its motion says where it is at t = 0."
            )
        return np.zeros(0), np.zeros(0)
