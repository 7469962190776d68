"""Contact of a capsule and a smooth body."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import ClassVar, final

from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import Value

from ...shapes.capsule import Capsule
from ...shapes.smooth import SmoothShape
from .polytope_smooth import evaluate_polytope_smooth, segment_numbers


@final
@dataclass(frozen=True)
class CapsuleSmooth(ContactKinematics):
    """One contact of a smooth body with the side or an end of a capsule.

    Attributes
    ----------
    first : Capsule
        The capsule.
    second : SmoothShape
        The smooth body.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Capsule, SmoothShape)

    first: Capsule
    second: SmoothShape

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[CapsuleSmooth, ...]:
        """Return the single contact of a capsule and a smooth shape."""
        assert isinstance(first, Capsule)
        assert isinstance(second, SmoothShape)
        return (cls(first, second),)

    def parameters(self) -> Mapping[str, Value]:
        """Return the segment with its radius and the numbers of the support function."""
        return {"first": segment_numbers(self.first.ends, self.first.radius), "second": self.second.core}

    @property
    def evaluator(self) -> Callable[..., None]:
        """A walk over the features, with Newton's method on the support function."""
        return evaluate_polytope_smooth

    @property
    def features(self) -> tuple[str, ...]:
        """Names of the side and the ends of the capsule, each with the smooth body."""
        return "side and smooth", "low end and smooth", "high end and smooth"
