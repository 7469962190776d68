"""A cylinder, a cone or a disc and a surface of so many features that those near each other are contacts."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from bodies.contacts.features.apart import NO_CANDIDATE, write_apart
from bodies.contacts.frustum.frustum import HIGH_RIM
from bodies.contacts.frustum.frustum_parts import apex_of, feet_of, set_back
from bodies.contacts.frustum.frustum_swept import write_vertex_ball
from bodies.contacts.mesh.apex_mesh import write_apex
from bodies.contacts.mesh.flank_mesh import write_flank
from bodies.contacts.mesh.frustum_corner import write_corner
from bodies.contacts.mesh.frustum_find import (
    ACROSS_BACK,
    ACROSS_FLANK,
    ACROSS_FRONT,
    APEX,
    POINT,
    POINT_ROW,
    RIM,
    UNDER,
    find_near_frustum,
)
from bodies.contacts.mesh.rim_mesh import write_half_rim
from bodies.contacts.mesh.surface_rim import rim_in_surface, rim_over, write_rim
from bodies.contacts.surface.mesh_point import write_over_second
from bodies.contacts.surface.surface_near import NARROW
from bodies.contacts.surface.surface_pairs import MOST_NEAR
from bodies.contacts.surface.surface_tables import (
    CORNER,
    CORNERS,
    EDGE,
    EDGES,
    STARS,
    Numbers,
    star_lengths,
    surface_numbers,
)
from bodies.meshes.patches import patches_for_ball
from bodies.shapes.frustum import SIDE, SWEEP, Frustum
from bodies.shapes.triangle_mesh import TriangleMesh
from nonsmooth.compiled import block_at
from nonsmooth.interfaces import CandidateSearch, ContactKinematics, Shape
from nonsmooth.parameters import Table, Value
from nonsmooth.types import Floats


def _evaluate(
    a: Floats,
    b: Floats,
    out: Floats,
    candidate: Floats,
    frustum: Floats,
    rims: Floats,
    points: Floats,
    surface: Floats,
    lengths: Floats,
    size: float,
) -> None:
    kind, i, j, reach = candidate[0], int(candidate[1]), int(candidate[2]), frustum[SWEEP] + candidate[3]
    if kind == RIM:
        radius, x, y, z = rims[4 * j], rims[4 * j + 1], rims[4 * j + 2], rims[4 * j + 3]
        pose = rim_in_surface(a, b, frustum, x, y, z)
        gap, past = rim_over(surface, i, frustum, radius, 2.0 * j - 1.0, pose, reach)
        write_rim(a, b, out, frustum, radius, x, y, z, surface, i, gap, past)
    elif kind == POINT:
        v = (POINT_ROW + 3 * int(points[3])) * j
        x, y, z, n = points[v], points[v + 1], points[v + 2], points[v + 3]
        star = block_at(points, v + POINT_ROW)
        write_over_second(a, b, out, surface, float(i), x, y, z, n, star, 0, reach, frustum[SWEEP])
    elif kind == APEX:
        write_apex(a, b, out, frustum, surface, float(i), size, reach)
    elif kind == UNDER:
        c = int(surface[CORNERS]) + CORNER * i
        x, y, z, n = surface[c], surface[c + 1], surface[c + 2], surface[c + 5]
        star = block_at(surface, int(surface[STARS]) + int(surface[c + 4]))
        if frustum[SWEEP] > 0.0:
            write_vertex_ball(a, b, out, frustum, 0.0, x, y, z, n, star, size)
        else:
            # only those of a disc's corners are read, and there are no others
            own = block_at(lengths, int(surface[c + 4]) // 3 if frustum[SIDE] == 0.0 else 0)
            write_corner(a, b, out, frustum, x, y, z, n, star, own, surface, size)
    elif kind == ACROSS_FLANK:
        write_flank(a, b, out, frustum, block_at(surface, int(surface[EDGES]) + EDGE * i), surface, size)
    elif kind == ACROSS_BACK or kind == ACROSS_FRONT:
        edge, half = block_at(surface, int(surface[EDGES]) + EDGE * i), -1.0 if kind == ACROSS_BACK else 1.0
        write_half_rim(a, b, out, frustum, float(j), half, edge, surface, size)
    else:
        write_apart(a, out, size)


@final
@dataclass(frozen=True)
class FrustumPairs(ContactKinematics):
    """A pair of features of a cylinder, a cone or a disc and of a surface that are near each other at present.

    Attributes
    ----------
    search : CandidateSearch
        What finds them.
    rims : tuple of float
        Radius and centre of each rim in the body frame [m].
    lengths : Table
        Lengths of the edges of the surface's corners, one corner after the other [m]; one number but for discs.
    n_features : int
        How many features the surface has.
    number : int
        Which of the contacts of the two bodies it is.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Frustum, TriangleMesh)
    search: CandidateSearch
    rims: Numbers
    lengths: Table
    n_features: int
    number: int

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FrustumPairs, ...]:
        """Return the contacts of a frustum and a mesh."""
        assert isinstance(first, Frustum)
        assert isinstance(second, TriangleMesh)
        numbers, own, extents = set_back(first), second.features, (first.extent, second.extent)
        points = [*feet_of(first), *(apex_of(first) if numbers[SWEEP] == 0.0 else ())]
        patches = patches_for_ball(own, numbers[SWEEP])
        rows = [(*place, len(star) // 3, *star) for place, star, _ in points]
        lengths = [x for i in range(len(own.corners)) for x in star_lengths(own, i)] if not numbers[SIDE] else []
        values: dict[str, Value] = {
            "frustum": numbers,
            "n_points": float(len(rows)),
            "points": Table([*itertools.chain(*rows)] or [0.0]),
            "surface": surface_numbers(own, patches),
            "size": max(own.size, 2.0 * first.extent),
            "most": float(MOST_NEAR),
            "turning": 0.5 / extents[0] + 0.5 / extents[1],
            "narrow": NARROW * min(extents),
        }
        n_edges = len(own.edges)
        counts = {
            RIM: (len(own.planes), len(first.standing_rims)),
            POINT: (patches.count, len(rows)),
            APEX: (patches.count, 1),
            UNDER: (len(own.corners), 1),
            ACROSS_FLANK: (n_edges, 1),
            ACROSS_BACK: (n_edges, HIGH_RIM + 1),
            ACROSS_FRONT: (n_edges, HIGH_RIM + 1),
        }
        search = CandidateSearch(find_near_frustum, values, counts)
        rims = tuple(x for radius, center in first.standing_rims for x in (radius, *center))
        n, table = len(own.planes) + n_edges + len(own.corners), Table(lengths or [0.0])
        return tuple(cls(search, rims, table, n, number) for number in range(MOST_NEAR))

    @property
    def candidates(self) -> CandidateSearch:
        """What finds the features."""
        return self.search

    def parameters(self) -> dict[str, Value]:
        """Return both shapes, and no features."""
        return {**self.search.values, "candidate": NO_CANDIDATE, "rims": self.rims, "lengths": self.lengths}

    @property
    def evaluator(self) -> Callable[..., None]:
        """What is called for each kind of features."""
        return _evaluate

    @property
    def features(self) -> tuple[str, ...]:
        """The features of the surface, by number."""
        return tuple(f"feature {i}" for i in range(self.n_features))
