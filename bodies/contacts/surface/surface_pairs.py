"""Contacts of two surfaces with very many features.

As the bodies move, a search finds the near pairs of features and assigns each pair to a contact.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

import numpy as np

from nonsmooth.interfaces import CandidateSearch, ContactKinematics, Shape
from nonsmooth.parameters import SharedNumbers, Value
from nonsmooth.types import Floats

from ...meshes.features import Features, features_of
from ...meshes.patches import patches_for_ball
from ...shapes.polytope import Polytope
from ...shapes.triangle_mesh import TriangleMesh
from ..features.writing import NO_CANDIDATE, write_apart
from .edges_near import edges_near
from .mesh_point import write_over_first, write_over_second
from .surface_edges import write_edges
from .surface_near import EDGE_ACROSS, OVER_FIRST, OVER_SECOND, corners_near
from .surface_tables import CORNER, CORNERS, EDGE, EDGES, STARS, surface_numbers

MOST_NEAR = 256
"""Largest number of pairs of features of two bodies that may be near each other at a time."""


def _find(a: Floats, b: Floats, out: Floats, surface_a: Floats, surface_b: Floats, most: float, turning: float) -> None:
    """Write the near pairs of corners and patches, and of edges, to ``out`` as candidates.

    On entry ``out[0]`` is the largest distance of a pair [m], on return the number of candidates.  The largest relative
    rotation of the bodies until the next search is ``turning`` [rad/m] times this distance.
    """
    reach, limit, n = out[0], int(most), 0
    turn = turning * reach
    n = corners_near(a, b, surface_a, surface_b, reach, turn, OVER_FIRST, out, n, limit)
    n = corners_near(b, a, surface_b, surface_a, reach, turn, OVER_SECOND, out, n, limit)
    n = edges_near(a, b, surface_a, surface_b, reach, turn, EDGE_ACROSS, out, n, limit)
    out[0] = float(n)


def _evaluate(
    a: Floats, b: Floats, out: Floats, candidate: Floats, surface_a: Floats, surface_b: Floats, size: float
) -> None:
    kind, i, j = candidate[0], int(candidate[1]), int(candidate[2])
    if kind == OVER_FIRST:
        c = int(surface_b[CORNERS]) + CORNER * j
        x, y, z, length = surface_b[c], surface_b[c + 1], surface_b[c + 2], surface_b[c + 5]
        star = int(surface_b[STARS]) + int(surface_b[c + 4])
        write_over_first(a, b, out, surface_a, float(i), x, y, z, length, surface_b, star, candidate[3])
    elif kind == OVER_SECOND:
        c = int(surface_a[CORNERS]) + CORNER * j
        x, y, z, length = surface_a[c], surface_a[c + 1], surface_a[c + 2], surface_a[c + 5]
        star = int(surface_a[STARS]) + int(surface_a[c + 4])
        write_over_second(a, b, out, surface_b, float(i), x, y, z, length, surface_a, star, candidate[3], 0.0)
    elif kind == EDGE_ACROSS:
        one, two = int(surface_a[EDGES]) + EDGE * i, int(surface_b[EDGES]) + EDGE * j
        write_edges(a, b, out, surface_a, one, surface_b, two, 0.0, size)
    else:
        write_apart(a, out, size)


@final
@dataclass(frozen=True)
class SurfacePairs(ContactKinematics):
    """One contact of two surfaces: a corner of one over a face of the other, or two edges that cross.

    A search chooses the pair of features anew as the bodies move.

    Attributes
    ----------
    search : CandidateSearch
        Search for pairs of features near each other.
    surfaces : tuple of SharedNumbers
        The surfaces (:mod:`bodies.contacts.surface.surface_tables`).
    size : float
        Size of the larger body [m].
    n_faces : int
        Number of faces of the surface with more faces.
    number : int
        Number of this contact among the contacts of both surfaces.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (TriangleMesh, TriangleMesh)
    search: CandidateSearch
    surfaces: tuple[SharedNumbers, SharedNumbers]
    size: float
    n_faces: int
    number: int

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[ContactKinematics, ...]:
        """Return the contacts of two meshes."""
        assert isinstance(first, TriangleMesh)
        assert isinstance(second, TriangleMesh)
        return cls.of_surfaces(first.features, second.features, (first.extent, second.extent))

    @classmethod
    def of_surfaces(cls, one: Features, two: Features, extents: tuple[float, float]) -> tuple[SurfacePairs, ...]:
        """Return the contacts of two surfaces, whose extents are radii about the bodies' frames [m]."""
        divided = [patches_for_ball(features, 0.0) for features in (one, two)]
        surfaces = surface_numbers(one, divided[0]), surface_numbers(two, divided[1])
        turning = 0.5 / extents[0] + 0.5 / extents[1]
        values: dict[str, Value] = {
            "surface_a": surfaces[0],
            "surface_b": surfaces[1],
            "most": float(MOST_NEAR),
            "turning": turning,
        }
        counts = {
            OVER_FIRST: (divided[0].count, len(two.corners)),
            OVER_SECOND: (divided[1].count, len(one.corners)),
            EDGE_ACROSS: (len(one.edges), len(two.edges)),
        }
        search, size = CandidateSearch(_find, values, counts), max(one.size, two.size)
        n_faces = max(len(one.planes), len(two.planes))
        return tuple(cls(search, surfaces, size, n_faces, number) for number in range(MOST_NEAR))

    @property
    def candidates(self) -> CandidateSearch:
        """Search for pairs of features near each other."""
        return self.search

    def parameters(self) -> dict[str, Value]:
        """Return the surfaces, the size, and a candidate without features."""
        first, second = self.surfaces
        return {"candidate": NO_CANDIDATE, "surface_a": first, "surface_b": second, "size": self.size}

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed forms of all kinds of features."""
        return _evaluate

    @property
    def features(self) -> tuple[str, ...]:
        """A face under a corner, by its number in either surface, or two edges."""
        return tuple(f"face {i}" for i in range(self.n_faces))


def features_of_core(core: Polytope) -> Features:
    """Return the surface of a polyhedron."""
    return features_of(np.array(core.vertices), np.array(core.triangles))
