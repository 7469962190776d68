"""A capsule and an ellipsoid."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import ClassVar, final

from bodies.contacts.box_polytope import CAPSULE_FEATURES, capsule_numbers
from bodies.contacts.polytope_smooth import evaluate_polytope_smooth
from bodies.shapes.capsule import Capsule
from bodies.shapes.ellipsoid import Ellipsoid
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import Value


@final
@dataclass(frozen=True)
class CapsuleEllipsoid(ContactKinematics):
    """One contact of an ellipsoid with the side or an end of a capsule.

    Attributes
    ----------
    first : Capsule
        The capsule.
    second : Ellipsoid
        The ellipsoid.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Capsule, Ellipsoid)

    first: Capsule
    second: Ellipsoid

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[CapsuleEllipsoid, ...]:
        """Return the single contact of a capsule and an ellipsoid."""
        assert isinstance(first, Capsule)
        assert isinstance(second, Ellipsoid)
        return (cls(first, second),)

    @classmethod
    def example(cls) -> Mapping[str, Shape]:
        """Return two of them."""
        return {"first": Capsule(0.1, 0.3), "second": Ellipsoid(0.2, 0.3, 0.4)}

    def parameters(self) -> Mapping[str, Value]:
        """Return the capsule as a polytope and the support function."""
        return {"first": capsule_numbers(self.first), "second": self.second.core}

    @property
    def evaluator(self) -> Callable[..., None]:
        """A walk over the features, with Newton's method on the support function."""
        return evaluate_polytope_smooth

    @property
    def features(self) -> tuple[str, ...]:
        """Side and ends."""
        return tuple(f"{name} and ellipsoid" for name in CAPSULE_FEATURES)
