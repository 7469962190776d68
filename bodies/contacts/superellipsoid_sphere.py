"""A superellipsoid and a sphere."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import ClassVar, final

from bodies.contacts.smooth_smooth import evaluate_smooth_pair
from bodies.shapes.sphere import Sphere
from bodies.shapes.superellipsoid import Superellipsoid
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import Value


@final
@dataclass(frozen=True)
class SuperellipsoidSphere(ContactKinematics):
    """One contact of a superellipsoid and a sphere; its normal is the one that separates them most.

    Attributes
    ----------
    first : Superellipsoid
        The superellipsoid.
    second : Sphere
        The sphere.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Superellipsoid, Sphere)

    first: Superellipsoid
    second: Sphere

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[SuperellipsoidSphere, ...]:
        """Return the single contact of a superellipsoid and a sphere."""
        assert isinstance(first, Superellipsoid)
        assert isinstance(second, Sphere)
        return (cls(first, second),)

    @classmethod
    def example(cls) -> Mapping[str, Shape]:
        """Return two of them."""
        return {"first": Superellipsoid(0.2, 0.3, 0.4, 1.5, 1.3), "second": Sphere(0.2)}

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
        return ("superellipsoid-sphere",)
