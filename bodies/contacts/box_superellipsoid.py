"""A box and a superellipsoid."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import ClassVar, final

from bodies.contacts.box_polytope import BOX_FEATURES, box_numbers
from bodies.contacts.polytope_smooth import evaluate_polytope_smooth
from bodies.shapes.box import Box
from bodies.shapes.superellipsoid import Superellipsoid
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import Value


@final
@dataclass(frozen=True)
class BoxSuperellipsoid(ContactKinematics):
    """One contact of a superellipsoid with the nearest face, edge or vertex of a box.

    Attributes
    ----------
    first : Box
        The box.
    second : Superellipsoid
        The superellipsoid.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Box, Superellipsoid)

    first: Box
    second: Superellipsoid

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[BoxSuperellipsoid, ...]:
        """Return the single contact of a box and a superellipsoid."""
        assert isinstance(first, Box)
        assert isinstance(second, Superellipsoid)
        return (cls(first, second),)

    @classmethod
    def example(cls) -> Mapping[str, Shape]:
        """Return two of them."""
        return {"first": Box(0.3, 0.2, 0.4), "second": Superellipsoid(0.2, 0.3, 0.4, 1.5, 1.3)}

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
        return tuple(f"{name} and superellipsoid" for name in BOX_FEATURES)
