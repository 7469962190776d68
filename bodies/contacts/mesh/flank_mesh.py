"""Contact of a convex edge of a mesh that crosses the side of a cylinder or a cone."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from nonsmooth.compiled import compiled
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import SharedNumbers, Value
from nonsmooth.types import Floats

from ...meshes.features import Features
from ...shapes.frustum import SIDE, Frustum
from ...shapes.triangle_mesh import TriangleMesh
from ..features.polytope_tables import ConvexCore
from ..frustum.flank_edge import FlankEdge, evaluate_flank_edge
from ..surface.surface_tables import Numbers
from .mesh_crossing import edges_of, judge_crossing

_cross = compiled(evaluate_flank_edge)


def _evaluate(a: Floats, b: Floats, out: Floats, frustum: Floats, edge: Floats, surface: Floats, size: float) -> None:
    """Write the geometry block of an edge of a surface that crosses the side of a frustum."""
    _cross(a, b, out, frustum, edge, 0.0, 0.0, edge, 0.0, edge, size)
    judge_crossing(a, b, out, frustum, edge, surface, size)


write_flank = compiled(_evaluate)
"""Compiled function that writes the geometry block of an edge and the side; other contacts call it, too."""


@final
@dataclass(frozen=True)
class FlankMesh(ContactKinematics):
    """Contact of a convex edge of the second body that crosses the side of the first.

    Attributes
    ----------
    crossing : FlankEdge
        The contact of side and edge alone, which does not know the rest of the surface.
    surface : SharedNumbers
        The surface of the second body (:mod:`bodies.contacts.surface.surface_tables`).
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Frustum, TriangleMesh)

    crossing: FlankEdge
    surface: SharedNumbers

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FlankMesh, ...]:
        """Return one contact for each convex edge of the mesh."""
        assert isinstance(first, Frustum)
        assert isinstance(second, TriangleMesh)
        return cls.of_edges(first.frustum, second.features, max(second.features.size, 2.0 * first.extent))

    @classmethod
    def of_edges(cls, first: Numbers, second: Features, size: float) -> tuple[FlankMesh, ...]:
        """Return one contact of the side of a frustum with each convex edge of a mesh; empty for a disc (no side).

        ``first`` are the numbers of the frustum, ``size`` is the size of the larger body [m].
        """
        if first[SIDE] == 0.0:
            return ()
        crossings = (
            (FlankEdge(first, row, 0.0, ConvexCore.of_point(), size, name), at) for row, at, name in edges_of(second)
        )
        return tuple(cls(crossing, surface) for crossing, surface in crossings)

    def parameters(self) -> dict[str, Value]:
        """Return the numbers of both bodies by the names of the evaluator's arguments."""
        own = self.crossing.parameters()
        return {**{key: own[key] for key in ("frustum", "edge", "size")}, "surface": self.surface}

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form of a side and an edge."""
        return _evaluate

    @property
    def features(self) -> tuple[str, ...]:
        """Name of the only pair of features."""
        return self.crossing.features
