"""A convex edge of a mesh across a rim of a cylinder, a cone or a disc."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from nonsmooth.compiled import compiled
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import SharedNumbers, Value
from nonsmooth.types import Floats

from ...meshes.features import Features
from ...shapes.frustum import Frustum
from ...shapes.triangle_mesh import TriangleMesh
from ..features.polytope_tables import ConvexCore
from ..frustum.rim_edge import RimEdge, evaluate_rim_edge
from ..surface.surface_tables import Numbers
from .mesh_crossing import edges_of, judge_crossing

_cross = compiled(evaluate_rim_edge)


def _evaluate(
    a: Floats,
    b: Floats,
    out: Floats,
    frustum: Floats,
    rim: float,
    half: float,
    edge: Floats,
    surface: Floats,
    size: float,
) -> None:
    """Write the geometry block of an edge of a surface that crosses one half of a rim."""
    _cross(a, b, out, frustum, rim, half, edge, 0.0, 0.0, edge, 0.0, edge, size)
    judge_crossing(a, b, out, frustum, edge, surface, size)


write_half_rim = compiled(_evaluate)
"""Compiled function that writes the geometry block of an edge and one half of a rim; other contacts call it, too."""


@final
@dataclass(frozen=True)
class RimMesh(ContactKinematics):
    """Contact of a convex edge of the second body that crosses a rim of the first body, on one half of the rim.

    Attributes
    ----------
    crossing : RimEdge
        The contact of rim and edge alone, which does not know the rest of the surface.
    surface : SharedNumbers
        The surface of the second body (:mod:`bodies.contacts.surface.surface_tables`).
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Frustum, TriangleMesh)

    crossing: RimEdge
    surface: SharedNumbers

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[RimMesh, ...]:
        """Return the contacts of both halves of each rim with each convex edge."""
        assert isinstance(first, Frustum)
        assert isinstance(second, TriangleMesh)
        return cls.of_edges(first.frustum, second.features, max(second.features.size, 2.0 * first.extent))

    @classmethod
    def of_edges(cls, first: Numbers, second: Features, size: float) -> tuple[RimMesh, ...]:
        """Return one contact for each convex edge of a mesh and each half of each rim of a frustum.

        ``first`` are the numbers of the frustum, ``size`` is the size of the larger body [m].
        """
        return tuple(
            cls(crossing, surface)
            for row, surface, name in edges_of(second)
            for crossing in RimEdge.of_rims(first, row, 0.0, ConvexCore.of_point(), size, name)
        )

    def parameters(self) -> dict[str, Value]:
        """Return the numbers of the frustum, the half of its rim, the edge and the surface."""
        own = self.crossing.parameters()
        return {**{key: own[key] for key in ("frustum", "rim", "half", "edge", "size")}, "surface": self.surface}

    @property
    def evaluator(self) -> Callable[..., None]:
        """Newton's method for one angle, that of a rim and an edge."""
        return _evaluate

    @property
    def features(self) -> tuple[str, ...]:
        """Name of the only pair of features, a rim and an edge."""
        return self.crossing.features
