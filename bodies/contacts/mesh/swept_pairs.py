"""A rounded polyhedron or a capsule against a surface of many features: only features near each other are contacts."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from nonsmooth.compiled import block_at, compiled
from nonsmooth.engine.memory.blocks import NORMAL
from nonsmooth.interfaces import CandidateSearch, ContactKinematics, Shape
from nonsmooth.parameters import SharedNumbers, Value
from nonsmooth.types import Floats

from ...meshes.patches import patches_for_ball
from ...shapes.polyhedron import SweptPolytope
from ...shapes.polytope import Polytope
from ...shapes.triangle_mesh import TriangleMesh
from ..features.frames import vector_in_body, vector_in_world
from ..features.polytope_tables import EDGE as CORE_EDGE
from ..features.polytope_tables import edge_rows, end_table, face_table, star_of
from ..features.swept_vertex import write_vertex
from ..features.vertex_face import nearest_feature
from ..features.writing import NO_CANDIDATE, write_apart
from ..surface.edges_near import edges_across
from ..surface.surface_ball import write_ball
from ..surface.surface_edges import write_edges
from ..surface.surface_near import NARROW, patches_near, room_ahead, seen_from
from ..surface.surface_pairs import MOST_NEAR
from ..surface.surface_search import steepest as steepest
from ..surface.surface_tables import (
    CORNER,
    CORNERS,
    EDGE,
    EDGES,
    MEMBERS,
    N_EDGES,
    N_NODES,
    N_TRIANGLES,
    NODE,
    NODES,
    STARS,
    surface_numbers,
)


@compiled
def corners_over(
    a: Floats,
    b: Floats,
    surface: Floats,
    n_faces: float,
    faces: Floats,
    n_edges: float,
    edges: Floats,
    ends: Floats,
    sweep: float,
    reach: float,
    turn: float,
    kind: float,
    out: Floats,
    n: int,
    most: int,
) -> int:
    """Append the corners of the surface in ``a`` that may soon touch a core in ``b``; return the number of candidates.

    A corner touches if a face of the core is nearest to it, or if none of its edges leads towards the nearest point of
    the core.  A corner is a candidate if one of these may hold before the next search.  Until then it moves by at most
    ``reach`` [m], and the bodies turn by at most ``turn`` [rad].

    Parameters
    ----------
    a, b : Floats
        Frame blocks.
    surface : Floats
        Numbers of the surface.
    n_faces, faces, n_edges, edges, ends, sweep : float and Floats
        The core and the radius about it, as in :class:`bodies.contacts.features.swept_vertex.SweptVertex`.
    reach, turn, kind, out, n, most : float, Floats and int
        As in :func:`bodies.contacts.surface.surface_near.corners_near`.
    """
    first, members, node = int(surface[N_TRIANGLES]) + int(surface[N_EDGES]), int(surface[MEMBERS]), 0
    while node < int(surface[N_NODES]) and n <= most:
        at = int(surface[NODES]) + NODE * node
        dx, dy, dz = (
            0.5 * (surface[at + 3] - surface[at]),
            0.5 * (surface[at + 4] - surface[at + 1]),
            0.5 * (surface[at + 5] - surface[at + 2]),
        )
        x, y, z = seen_from(b, a, (surface[at] + dx, surface[at + 1] + dy, surface[at + 2] + dz))
        found = nearest_feature(n_faces, faces, n_edges, edges, ends, x, y, z)
        if found[1] > sweep + reach + math.sqrt(dx * dx + dy * dy + dz * dz):
            node = int(surface[at + 6])
            continue
        for i in range(int(surface[at + 8])):
            corner = int(surface[members + int(surface[at + 7]) + i]) - first
            if corner < 0 or n > most:
                continue
            c = int(surface[CORNERS]) + CORNER * corner
            x, y, z = seen_from(b, a, (surface[c], surface[c + 1], surface[c + 2]))
            number, distance, nx, ny, nz, _ = nearest_feature(n_faces, faces, n_edges, edges, ends, x, y, z)
            if distance > sweep + reach:
                continue
            nx, ny, nz = vector_in_world(b, (nx, ny, nz))
            nx, ny, nz = vector_in_body(a, (nx, ny, nz))
            is_over_face = number < int(n_faces) or distance <= 0.0
            if is_over_face or distance * steepest(surface, c, -nx, -ny, -nz) <= reach + turn * distance:
                out[NORMAL + 3 * n], out[NORMAL + 1 + 3 * n], out[NORMAL + 2 + 3 * n] = kind, float(corner), 0.0
                n += 1
        node += 1
    return n


BALL, UNDER, ACROSS = 1.0, 2.0, 3.0
"""Kinds of candidates, the first of a candidate's three numbers; the numbers of its features follow.

BALL: a vertex of the rounded body, with its radius, over a patch of the mesh.  UNDER: a corner of the mesh under the
rounded body.  ACROSS: an edge of the mesh and an edge of the rounded body.
"""
_ROW = 5
"""Floats in the row of a core's vertex: position (3) [m], number of its edges, index of the unit vectors along them."""


def _find(
    a: Floats,
    b: Floats,
    out: Floats,
    surface: Floats,
    n_vertices: float,
    vertices: Floats,
    n_faces: float,
    faces: Floats,
    n_edges: float,
    edges: Floats,
    ends: Floats,
    sweep: float,
    most: float,
    turning: float,
    narrow: float,
) -> None:
    """Find pairs that may soon touch: patch and vertex, corner and core, edge and edge, of the mesh and of the core.

    On entry, ``out[0]`` is the distance up to which features are near [m]; on return, it is the number of pairs found,
    or ``most`` + 1 if there are too many.  ``turning`` is the largest relative rotation of the bodies until the next
    search, per metre of ``out[0]`` [rad/m].  ``most`` is the largest number of pairs; if ``out[0]`` exceeds ``narrow``
    [m], the limit is smaller (:func:`bodies.contacts.surface.surface_near.room_ahead`).
    """
    reach, limit, n = out[0], room_ahead(out[0], narrow, int(most)), 0
    turn = turning * reach
    for i in range(int(n_vertices)):
        v = _ROW * i
        x, y, z = seen_from(a, b, (vertices[v], vertices[v + 1], vertices[v + 2]))
        n = patches_near(surface, x, y, z, sweep + reach, BALL, float(i), out, n, limit)
    n = corners_over(a, b, surface, n_faces, faces, n_edges, edges, ends, sweep, reach, turn, UNDER, out, n, limit)
    for j in range(int(n_edges)):
        n = edges_across(a, b, surface, edges, CORE_EDGE * j, float(j), sweep + reach, turn, ACROSS, out, n, limit)
    out[0] = float(n) if n <= limit else most + 1.0


def _evaluate(
    a: Floats,
    b: Floats,
    out: Floats,
    candidate: Floats,
    surface: Floats,
    vertices: Floats,
    n_faces: float,
    faces: Floats,
    n_edges: float,
    edges: Floats,
    ends: Floats,
    sweep: float,
    size: float,
) -> None:
    kind, i, j = candidate[0], int(candidate[1]), int(candidate[2])
    if kind == BALL:
        v = _ROW * j
        x, y, z, length = vertices[v], vertices[v + 1], vertices[v + 2], vertices[v + 3]
        star = block_at(vertices, int(vertices[v + 4]))
        write_ball(a, b, out, surface, float(i), sweep, (x, y, z), length, star, size, sweep + candidate[3])
    elif kind == UNDER:
        c = int(surface[CORNERS]) + CORNER * i
        x, y, z, length = surface[c], surface[c + 1], surface[c + 2], surface[c + 5]
        star = block_at(surface, int(surface[STARS]) + int(surface[c + 4]))
        write_vertex(
            a, b, out, 1.0, n_faces, faces, n_edges, edges, ends, sweep, x, y, z, length, star, 0.0, faces, 0.0, size
        )
    elif kind == ACROSS:
        one, two = int(surface[EDGES]) + EDGE * i, CORE_EDGE * j
        write_edges(a, b, out, surface, one, edges, two, sweep, size)
    else:
        write_apart(a, out, size)


@final
@dataclass(frozen=True)
class SweptPairs(ContactKinematics):
    """Contact of a feature of a mesh with a feature of a rounded body, a pair that a search found near at present.

    Attributes
    ----------
    search : CandidateSearch
        Search for pairs of features near each other.
    size : float
        Size of the larger body [m].
    n_features : int
        Number of features of the surface or of the core, whichever has more.
    number : int
        Number of this contact among the contacts of both bodies.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (TriangleMesh, SweptPolytope)
    search: CandidateSearch
    size: float
    n_features: int
    number: int

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[SweptPairs, ...]:
        """Return the contacts of a mesh and a shape with a radius."""
        assert isinstance(first, TriangleMesh)
        assert isinstance(second, SweptPolytope)
        own, extents = first.features, (first.extent, second.extent)
        core, sweep = second.core, second.sweep
        patches = patches_for_ball(own, sweep)
        values: dict[str, Value] = {
            "surface": surface_numbers(own, patches),
            "n_vertices": float(len(core.vertices)),
            "vertices": _vertices(core),
            "n_faces": float(len(core.planes)),
            "faces": SharedNumbers(face_table(core) or (0.0,)),
            "n_edges": float(len(core.edges)),
            "edges": SharedNumbers(tuple(itertools.chain(*edge_rows(core)))),
            "ends": SharedNumbers(end_table(core)),
            "sweep": sweep,
            "most": float(MOST_NEAR),
            "turning": 0.5 / extents[0] + 0.5 / extents[1],
            "narrow": NARROW * min(extents),
        }
        counts = {
            BALL: (patches.count, len(core.vertices)),
            UNDER: (len(own.corners), 1),
            ACROSS: (len(own.edges), len(core.edges)),
        }
        search = CandidateSearch(_find, values, counts)
        n_own = len(own.planes) + len(own.edges) + len(own.corners)
        n_features = max(n_own, len(core.planes) + len(core.edges) + len(core.vertices))
        size = max(own.size, core.size + 2.0 * sweep)
        return tuple(cls(search, size, n_features, number) for number in range(MOST_NEAR))

    @property
    def candidates(self) -> CandidateSearch:
        """Search for pairs of features near each other."""
        return self.search

    def parameters(self) -> dict[str, Value]:
        """Return the numbers of both shapes, and a candidate without features."""
        return {**self.search.values, "candidate": NO_CANDIDATE, "size": self.size}

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed forms of all kinds of features."""
        return _evaluate

    @property
    def features(self) -> tuple[str, ...]:
        """Names by number, "feature 0" and so on, as many as mesh or core has features, whichever has more."""
        return tuple(f"feature {i}" for i in range(self.n_features))


def _vertices(core: Polytope) -> SharedNumbers:
    """Return the row of each vertex of a core (:data:`_ROW`), then the unit vectors along the edges of all vertices."""
    stars = [star_of(core, i) for i in range(len(core.vertices))]
    begins = itertools.accumulate((len(star) for star in stars), initial=_ROW * len(stars))
    rows = [(*place, len(star) // 3, begin) for place, star, begin in zip(core.vertices, stars, begins, strict=False)]
    return SharedNumbers([*itertools.chain(*rows), *itertools.chain(*stars)])
