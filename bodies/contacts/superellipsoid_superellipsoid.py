"""Two superellipsoids."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import ClassVar, final

from bodies.contacts.smooth_smooth import evaluate_smooth_pair
from bodies.shapes.superellipsoid import Superellipsoid
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import Value


@final
@dataclass(frozen=True)
class SuperellipsoidSuperellipsoid(ContactKinematics):
    """One contact of two superellipsoids; its normal is the one that separates them most.

    Attributes
    ----------
    first : Superellipsoid
        The one.
    second : Superellipsoid
        The other.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Superellipsoid, Superellipsoid)

    first: Superellipsoid
    second: Superellipsoid

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[SuperellipsoidSuperellipsoid, ...]:
        """Return the single contact of two superellipsoids."""
        assert isinstance(first, Superellipsoid)
        assert isinstance(second, Superellipsoid)
        return (cls(first, second),)

    @classmethod
    def example(cls) -> Mapping[str, Superellipsoid]:
        """Return two of them."""
        return {"first": Superellipsoid(0.2, 0.3, 0.4, 1.5, 1.3), "second": Superellipsoid(0.2, 0.3, 0.4, 1.5, 1.3)}

    def parameters(self) -> Mapping[str, Value]:
        """Return the numbers of both support functions."""
        return {"first": self.first.core, "second": self.second.core}

    @property
    def evaluator(self) -> Callable[..., None]:
        """Newton's method on the support functions."""
        return evaluate_smooth_pair

    @property
    def features(self) -> tuple[str, ...]:
        """The only pair."""
        return ("superellipsoid-superellipsoid",)
