"""DrivenBody: any shapes on a prescribed motion."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, final

from nonsmooth.interfaces import Shape

from .motions.harmonic import Harmonic
from .prescribed import Driven
from .shapes.sphere import Sphere
from .values import keep_carried


@final
@dataclass(frozen=True)
class DrivenBody(Driven):
    """A body that moves as ``motion`` says, whatever touches it, and carries any shapes.

    Attributes
    ----------
    motion : Motion
        The motion of its frame.
    carried : tuple of Shape
        Its shapes in the axes of the frame; without any it is a place to hang joints, springs and dampers on.
    """

    carried: tuple[Shape, ...] = ()

    @classmethod
    def example(cls) -> Mapping[str, Any]:
        """Return a sphere that vibrates."""
        return {"motion": Harmonic(1e-3, 25.0), "carried": (Sphere(0.1),)}

    def _check(self) -> None:
        keep_carried(self)

    @property
    def frames(self) -> tuple[tuple[Shape, ...], ...]:
        """One frame with the shapes as given."""
        return (self.carried,)
