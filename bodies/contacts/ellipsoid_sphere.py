"""An ellipsoid and a sphere."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import ClassVar, final

from bodies.contacts.smooth_smooth import evaluate_smooth_pair
from bodies.shapes.ellipsoid import Ellipsoid
from bodies.shapes.sphere import Sphere
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import Value


@final
@dataclass(frozen=True)
class EllipsoidSphere(ContactKinematics):
    """One contact of an ellipsoid and a sphere; its normal is the one that separates them most.

    Attributes
    ----------
    first : Ellipsoid
        The ellipsoid.
    second : Sphere
        The sphere.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Ellipsoid, Sphere)

    first: Ellipsoid
    second: Sphere

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[EllipsoidSphere, ...]:
        """Return the single contact of an ellipsoid and a sphere."""
        assert isinstance(first, Ellipsoid)
        assert isinstance(second, Sphere)
        return (cls(first, second),)

    @classmethod
    def example(cls) -> Mapping[str, Shape]:
        """Return two of them."""
        return {"first": Ellipsoid(0.2, 0.3, 0.4), "second": Sphere(0.2)}

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
        return ("ellipsoid-sphere",)
