"""Contact of a polyhedron and a smooth body."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import ClassVar, final

from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import Value

from ...shapes.polyhedron import Polyhedron
from ...shapes.smooth import SmoothShape
from .polytope_smooth import evaluate_polytope_smooth, polyhedron_numbers


@final
@dataclass(frozen=True)
class PolyhedronSmooth(ContactKinematics):
    """One contact of a smooth body with the nearest face, edge or vertex of a polyhedron.

    Attributes
    ----------
    first : Polyhedron
        The polyhedron.
    second : SmoothShape
        The smooth body.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Polyhedron, SmoothShape)

    first: Polyhedron
    second: SmoothShape

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[PolyhedronSmooth, ...]:
        """Return the single contact of a polyhedron and a smooth shape."""
        assert isinstance(first, Polyhedron)
        assert isinstance(second, SmoothShape)
        return (cls(first, second),)

    def parameters(self) -> Mapping[str, Value]:
        """Return the parts of the polyhedron and the numbers of the support function."""
        return {"first": polyhedron_numbers(self.first.core, self.first.rounding), "second": self.second.core}

    @property
    def evaluator(self) -> Callable[..., None]:
        """A walk over the features, with Newton's method on the support function."""
        return evaluate_polytope_smooth

    @property
    def features(self) -> tuple[str, ...]:
        """Names of faces, edges and vertices of the polyhedron, each with the smooth body."""
        polytope = self.first.core
        parts = (("face", polytope.faces), ("edge", polytope.edges), ("vertex", polytope.vertices))
        return tuple(f"{kind} {i} and smooth" for kind, part in parts for i in range(len(part)))
