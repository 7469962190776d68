"""Prescribed bodies: their motion does not depend on contacts."""

from __future__ import annotations

from abc import ABC
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Body, Motion
from nonsmooth.interfaces.body import Vector
from nonsmooth.parameters import Value

from .motions.rest import Rest


@dataclass(frozen=True)
class Prescribed(Body, ABC):
    """A body without coordinates: its motion does not depend on contacts."""

    def state(self, **start: Any) -> tuple[Vector, Vector]:
        """Return empty vectors q and u: a driven body has no coordinates and cannot be placed."""
        if start:
            raise InvalidInput(
                f"start of a {type(self).__name__}",
                "must not be given",
                sorted(start),
                "Its motion, or its position, says where it is at t = 0.",
            )
        return np.zeros(0), np.zeros(0)


@dataclass(frozen=True)
class Driven(Prescribed, ABC):
    """A body without coordinates whose frame follows a given ``motion``; subclasses are final and give shapes."""

    motion: Motion = field(default_factory=Rest)

    def __post_init__(self) -> None:
        if not isinstance(self.motion, Motion):
            raise InvalidInput(
                f"{type(self).__name__}.motion",
                "must be a Motion",
                self.motion,
                "For example Harmonic(...) or Rest().",
            )
        super().__post_init__()

    def parameters(self) -> Mapping[str, Value]:
        """Return the motion's parameters."""
        return self.motion.parameters()

    @property
    def evaluator(self) -> Callable[..., None]:
        """Function ``evaluate(t, q, u, out, ...)``, with empty q and u, that writes the motion of the frame at t."""
        return self.motion.evaluator

    @property
    def time_scale(self) -> float:
        """Time scale of the motion [s]."""
        return self.motion.time_scale
