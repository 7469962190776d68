"""Driven bodies: a motion carries shapes."""

from __future__ import annotations

from abc import ABC
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from bodies.motions.rest import Rest
from bodies.prescribed import Prescribed
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Motion
from nonsmooth.parameters import Value


@dataclass(frozen=True)
class Driven(Prescribed, ABC):
    """A body without coordinates whose frame moves as ``motion`` says; subclasses are final and give shapes."""

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
        """The motion's."""
        return self.motion.evaluator

    @property
    def time_scale(self) -> float:
        """The motion's [s]."""
        return self.motion.time_scale
