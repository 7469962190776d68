"""Contacts of a cylinder, cone or disc with a surface: a search finds the pairs of features that are near."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from typing import Any, ClassVar, final

from nonsmooth.compiled import block_at, compiled
from nonsmooth.interfaces import CandidateSearch, ContactKinematics, FeaturePair, Shape
from nonsmooth.parameters import SharedNumbers, Value
from nonsmooth.types import Floats

from ...meshes.patches import patches_for_ball, patches_of_faces
from ...meshes.triangles import Triangles
from ...shapes.cylinder import Cylinder
from ...shapes.frustum import HIGH, HIGH_RADIUS, SIDE, Frustum, without_feet
from ...shapes.frustum import SWEEP as FRUSTUM_SWEEP
from ...shapes.surface_shape import SurfaceShape
from ...shapes.triangle_mesh import TriangleMesh
from ...vectors import minus, norm, plus_scaled, vector_at
from ..features.edge_row import Edge
from ..features.vertex import Vertex
from ..features.writing import NO_CANDIDATE, write_apart
from ..surface.surface_near import Near, patches_near, patches_under, room_ahead
from ..surface.surface_pairs import MOST_NEAR, limits
from ..surface.surface_tables import (
    N_NODES,
    ON_EDGE,
    ON_FACE,
    SKIP,
    SWEEP,
    UPPER,
    Solid,
    corner_at,
    edge_at,
    feature_of,
    star_lengths,
    surface_numbers,
)
from ..surface.surface_tree import members_at, node_at
from .edges import write_across_rim, write_across_side
from .frustum import HIGH_RIM, LOW_RIM, apex_of, feet_of, from_core, part_names, rims_of, set_back
from .frustum_near import Search, corner_is_near, edge_is_near, rim_is_near
from .frustum_sphere import write_frustum_vertex
from .over_faces import frustum_in_surface, write_apex, write_corner, write_rim, write_tip

RIM, POINT, APEX, UNDER, ACROSS_FLANK, ACROSS_BACK, ACROSS_FRONT = 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0
"""Kinds of candidates, the first of a candidate's three numbers.

In this order: rim over a face, point over a patch, round apex over a patch, corner of the surface, edge of the surface
across the side, edge across the first half of a rim, edge across the second half.  The numbers of face, patch, corner
or edge, and of rim (0 or 1) or point, follow.
"""
POINT_ROW, N_DIRECTIONS = 4, 3
"""Floats in the row of a point (foot or apex) before its unit vectors: position (3) [m], number of unit vectors.

``N_DIRECTIONS`` is the offset of this number, which all points of a frustum have in common.
"""


@compiled
def _point_at(points: Floats, i: int) -> Vertex:
    """Return a point of the frustum, a foot or the apex, from its row."""
    row = block_at(points, (POINT_ROW + 3 * int(points[N_DIRECTIONS])) * i)
    return Vertex(vector_at(row, 0), row[N_DIRECTIONS], block_at(row, POINT_ROW))


@compiled
def _add(kind: float, second: float, third: float, out: Floats, n: int, most: int) -> int:
    """Append a candidate to the ``n`` candidates in ``out``, unless n exceeds ``most``; return the new number.

    ``kind``, ``second`` and ``third`` are the three numbers of the candidate: its kind and its two features.  One
    candidate more than ``most`` may be appended; it means that there are too many.  A face of several triangles is
    found once for each of them, and appended once.
    """
    for i in range(n if kind == RIM else 0):
        if out[1 + 3 * i] == RIM and out[2 + 3 * i] == second and out[3 + 3 * i] == third:
            return n
    if n > most:
        return n
    out[1 + 3 * n], out[2 + 3 * n], out[3 + 3 * n] = kind, second, third
    return n + 1


@compiled
def _member_near(search: Search, member: int, out: Floats, n: int, most: int) -> int:
    """Append the candidates of one triangle, edge or corner of the surface that may soon touch the frustum.

    ``member`` counts triangles first, then edges, then corners.  A feature may touch if it is within the reach of the
    core, the frustum without its rounding, and if its normals agree with those of the frustum after a rotation by up to
    the largest until the next search.  ``out`` holds ``n`` candidates.  Return the new number of candidates; a number
    above ``most`` means that there are too many.
    """
    surface, numbers = search.surface, search.frustum.numbers
    kind, number, row = feature_of(surface, member)
    if kind == ON_FACE:
        for upper in range(2 if numbers[SIDE] > 0.0 and numbers[HIGH_RADIUS] > 0.0 else 1):
            if rim_is_near(search, row, upper):
                n = _add(RIM, float(number), float(upper), out, n, most)
    elif kind == ON_EDGE:
        flank, lower, upper_rim = edge_is_near(search, row)
        if flank:
            n = _add(ACROSS_FLANK, float(number), 0.0, out, n, most)
        for upper in range(2):
            if upper_rim if upper == 1 else lower:
                n = _add(ACROSS_BACK, float(number), float(upper), out, n, most)
                n = _add(ACROSS_FRONT, float(number), float(upper), out, n, most)
    elif corner_is_near(search, number):
        n = _add(UNDER, float(number), 0.0, out, n, most)
    return n


def find_near_frustum(
    a: Floats,
    b: Floats,
    out: Floats,
    frustum: Floats,
    n_points: float,
    points: Floats,
    surface: Floats,
    size: float,
    most: float,
    turning: float,
    narrow: float,
) -> None:
    """Find near features: faces with rims, patches with points and apex, corners, edges with side and rims.

    On entry, ``out[0]`` is the distance up to which features are near [m]; on return, it is the number of candidates
    found, or ``most`` + 1 if there are too many.  A rim has candidates with faces, not with patches, because a patch
    for a body as large as the rim would hold a single face.  ``turning`` is the largest relative rotation of the bodies
    until the next search, per metre of ``out[0]`` [rad/m].  ``most`` is the largest number of candidates; if ``out[0]``
    exceeds ``narrow`` [m], the limit is smaller (:func:`bodies.contacts.surface.surface_near.room_ahead`).
    """
    limit, n, node = room_ahead(out[0], narrow, int(most)), 0, 0
    turn, sweep = turning * out[0], frustum[FRUSTUM_SWEEP] + surface[SWEEP]
    # distances are measured between the cores
    reach, placed = sweep + out[0], frustum_in_surface(a, b, frustum)
    search = Search(surface, placed, reach, turn, size)
    while node < int(surface[N_NODES]) and n <= limit:
        at = node_at(surface, node)
        corner = vector_at(surface, at)
        diagonal = minus(vector_at(surface, at + UPPER), corner)
        # a ball about the box of the node
        if from_core(placed, plus_scaled(corner, 0.5, diagonal)) > reach + 0.5 * norm(diagonal):
            node = int(surface[at + SKIP])
            continue
        leaf = members_at(surface, at, node + 1)
        for i in range(leaf.begin, leaf.end):
            n = _member_near(search, int(surface[i]), out, n, limit)
        node = leaf.after
    for i in range(int(n_points)):
        near = Near(out, POINT, out[0], reach, turn, limit)
        n = patches_under(Solid(b, surface), a, _point_at(points, i), near, float(i), n)
    # the apex is a sphere if a body is rounded
    if sweep > 0.0 and frustum[SIDE] > 0.0 and frustum[HIGH_RADIUS] == 0.0:
        near = Near(out, APEX, out[0], reach, turn, limit)
        n = patches_near(surface, plus_scaled(placed.center, frustum[HIGH], placed.axis), near, 0.0, n)
    out[0] = float(n) if n <= limit else most + 1.0


def evaluate_frustum_and_candidate(
    a: Floats,
    b: Floats,
    out: Floats,
    candidate: Floats,
    frustum: Floats,
    points: Floats,
    surface: Floats,
    lengths: Floats,
    size: float,
) -> None:
    """Write the geometry block of a feature of a frustum and a feature of a surface that is currently near it.

    ``candidate`` is the pair of features.  ``points`` are the rows of the feet and of a sharp apex (:data:`POINT_ROW`).
    For a disc, ``lengths`` are those of the edges of the surface's corners, one corner after the other [m]; else a
    single 0.  ``size`` is the size of the larger body [m].
    """
    kind, i, j = candidate[0], int(candidate[1]), int(candidate[2])
    sweep = frustum[FRUSTUM_SWEEP] + surface[SWEEP]
    # distance of the cores up to which the candidate is valid
    reach = sweep + candidate[3]
    if kind == RIM:
        write_rim(a, b, out, frustum, j, surface, i, reach)
    elif kind == POINT:
        write_tip(a, b, out, frustum, surface, float(i), _point_at(points, j), reach)
    elif kind == APEX:
        write_apex(a, b, out, frustum, surface, float(i), size, reach)
    elif kind == UNDER:
        if sweep > 0.0:
            write_frustum_vertex(a, b, out, frustum, surface[SWEEP], corner_at(surface, i), size)
        else:
            write_corner(a, b, out, frustum, surface, i, lengths, size)
    elif kind == ACROSS_FLANK:
        write_across_side(a, out, frustum, Edge(b, edge_at(surface, i)), surface, size)
    elif kind == ACROSS_BACK or kind == ACROSS_FRONT:
        rim, half = float(LOW_RIM + (HIGH_RIM - LOW_RIM) * j), -1.0 if kind == ACROSS_BACK else 1.0
        write_across_rim(a, out, frustum, rim, half, Edge(b, edge_at(surface, i)), surface, size)
    else:
        write_apart(a, out, size)


@final
class FrustumSurface(ContactKinematics):
    """Contacts of a cylinder, cone or disc with a box, a convex hull, a capsule or a triangle mesh.

    The surface need not be convex.  A pair of features can be:

    - a rim of the frustum, at its lowest point, and a face of the surface;
    - a foot or the apex, and a patch: a group of faces of which the body can touch only one at a time
      (:mod:`bodies.meshes.patches`);
    - a corner of the surface, and the nearest part of the frustum;
    - a convex edge of the surface that crosses the side or one half of a rim.

    Whether a contact exists depends only on the surface next to its points.  A rounded body is at a constant distance,
    the radius of rounding, from a smaller core.  If a body is rounded, the apex and the corners are spheres, or points.
    A search finds the pairs that are near each other; these are the contacts.

    A face of a surface rests on the feet, so the rims are set back by them.  A capsule has no faces: its contacts
    ignore the feet.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Frustum, SurfaceShape)

    @classmethod
    def example(cls) -> Mapping[str, Any]:
        """Return a cylinder, and a tetrahedron whose faces its rims meet."""
        corners = ((1.0, 1.0, 1.0), (1.0, -1.0, -1.0), (-1.0, 1.0, -1.0), (-1.0, -1.0, 1.0))
        tetrahedron = Triangles(corners, ((0, 1, 2), (0, 3, 1), (0, 2, 3), (1, 3, 2)), "of the example")
        return {"first": Cylinder(0.1, 0.2), "second": TriangleMesh(tetrahedron)}

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FeaturePair, ...]:
        """Return as many contacts as there are pairs of features, at most ``MOST_NEAR``; a search fills them."""
        assert isinstance(first, Frustum)
        assert isinstance(second, SurfaceShape)
        own, extents = second.features, (first.extent, second.extent)
        n_faces, n_edges, n_corners = len(own.planes), len(own.edges), len(own.corners)
        numbers = set_back(first) if n_faces else without_feet(first.frustum)
        is_sharp = numbers[FRUSTUM_SWEEP] + second.sweep == 0.0
        points = [*feet_of(first), *(apex_of(first) if is_sharp else ())] if n_faces else []
        rows = [(*place, len(star) // 3, *star) for place, star in points]
        patches = patches_of_faces(own) if is_sharp and own.is_convex else patches_for_ball(own, numbers[FRUSTUM_SWEEP])
        n_rims = len(rims_of(numbers))
        has_side, has_round_apex = numbers[SIDE] > 0.0, numbers[HIGH_RADIUS] == 0.0 and not is_sharp
        counts = {
            RIM: (n_faces, n_rims),
            POINT: (patches.count, len(rows)),
            APEX: (patches.count, int(has_round_apex)),
            UNDER: (n_corners, 1),
            ACROSS_FLANK: (n_edges, int(has_side)),
            ACROSS_BACK: (n_edges, n_rims),
            ACROSS_FRONT: (n_edges, n_rims),
        }
        n_contacts = min(MOST_NEAR, sum(m * n for m, n in counts.values()))
        values: dict[str, Value] = {
            "frustum": numbers,
            "points": SharedNumbers([*itertools.chain(*rows)] or [0.0]),
            "surface": surface_numbers(own, patches, second.sweep),
            "size": max(own.size + 2.0 * second.sweep, 2.0 * first.extent),
        }
        search_values: dict[str, Value] = {
            **values,
            "n_points": float(len(rows)),
            **limits(n_contacts, extents),
        }
        lengths = [] if has_side else [x for i in range(n_corners) for x in star_lengths(own, i)]
        own_values = {**values, "candidate": NO_CANDIDATE, "lengths": SharedNumbers(lengths or [0.0])}
        names = tuple(f"feature {i}" for i in range(max(n_faces + n_edges + n_corners, len(part_names(numbers)))))
        search = CandidateSearch(find_near_frustum, search_values, counts)
        return (FeaturePair(evaluate_frustum_and_candidate, own_values, names, search),) * n_contacts
