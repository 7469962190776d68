"""A box and an ellipsoid."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import ClassVar, final

from bodies.contacts.box_polytope import BOX_FEATURES, box_numbers
from bodies.contacts.polytope_smooth import evaluate_polytope_smooth
from bodies.shapes.box import Box
from bodies.shapes.ellipsoid import Ellipsoid
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import Value


@final
@dataclass(frozen=True)
class BoxEllipsoid(ContactKinematics):
    """One contact of an ellipsoid with the nearest face, edge or vertex of a box.

    Attributes
    ----------
    first : Box
        The box.
    second : Ellipsoid
        The ellipsoid.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Box, Ellipsoid)

    first: Box
    second: Ellipsoid

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[BoxEllipsoid, ...]:
        """Return the single contact of a box and an ellipsoid."""
        assert isinstance(first, Box)
        assert isinstance(second, Ellipsoid)
        return (cls(first, second),)

    @classmethod
    def example(cls) -> Mapping[str, Shape]:
        """Return two of them."""
        return {"first": Box(0.3, 0.2, 0.4), "second": Ellipsoid(0.2, 0.3, 0.4)}

    def parameters(self) -> Mapping[str, Value]:
        """Return the box as a polytope and the support function."""
        return {"first": box_numbers(self.first), "second": self.second.core}

    @property
    def evaluator(self) -> Callable[..., None]:
        """A walk over the features, with Newton's method on the support function."""
        return evaluate_polytope_smooth

    @property
    def features(self) -> tuple[str, ...]:
        """The 6 faces, 12 edges and 8 vertices."""
        return tuple(f"{name} and ellipsoid" for name in BOX_FEATURES)
