"""A capsule and a superellipsoid."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import ClassVar, final

from bodies.contacts.box_polytope import CAPSULE_FEATURES, capsule_numbers
from bodies.contacts.polytope_smooth import evaluate_polytope_smooth
from bodies.shapes.capsule import Capsule
from bodies.shapes.superellipsoid import Superellipsoid
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import Value


@final
@dataclass(frozen=True)
class CapsuleSuperellipsoid(ContactKinematics):
    """One contact of a superellipsoid with the side or an end of a capsule.

    Attributes
    ----------
    first : Capsule
        The capsule.
    second : Superellipsoid
        The superellipsoid.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Capsule, Superellipsoid)

    first: Capsule
    second: Superellipsoid

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[CapsuleSuperellipsoid, ...]:
        """Return the single contact of a capsule and a superellipsoid."""
        assert isinstance(first, Capsule)
        assert isinstance(second, Superellipsoid)
        return (cls(first, second),)

    @classmethod
    def example(cls) -> Mapping[str, Shape]:
        """Return two of them."""
        return {"first": Capsule(0.1, 0.3), "second": Superellipsoid(0.2, 0.3, 0.4, 1.5, 1.3)}

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
        return tuple(f"{name} and superellipsoid" for name in CAPSULE_FEATURES)
