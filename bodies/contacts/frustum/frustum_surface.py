"""Contacts of a cylinder, cone or disc with a surface: a search finds the pairs of features that are near."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from typing import Any, ClassVar, NamedTuple, final

from nonsmooth.compiled import block_at, compiled
from nonsmooth.interfaces import CandidateSearch, ContactKinematics, FeaturePair, Shape
from nonsmooth.parameters import SharedNumbers, Value
from nonsmooth.types import Floats

from ...meshes.patches import patches_for_ball, patches_of_faces
from ...meshes.triangles import Triangles
from ...shapes.cylinder import Cylinder
from ...shapes.frustum import HIGH, HIGH_RADIUS, SIDE, SIN, Frustum, without_feet
from ...shapes.frustum import SWEEP as FRUSTUM_SWEEP
from ...shapes.surface_shape import SurfaceShape
from ...shapes.triangle_mesh import TriangleMesh
from ...vectors import Vector3, cross, divided, dot, minus, norm, opposite, plus, plus_scaled, vector_at
from ..features.edge_crossing import CONE_MARGIN
from ..features.edge_vertex import ALONG, INTO_FIRST, INTO_SECOND, LENGTH, START, Edge, Vertex, steepest
from ..features.ends import CLOSED
from ..features.frames import tangent_of
from ..features.writing import NO_CANDIDATE, write_apart
from ..surface.surface_near import Near, patches_near, patches_under, room_ahead
from ..surface.surface_pairs import MOST_NEAR, limits
from ..surface.surface_search import distance_from_triangle
from ..surface.surface_tables import (
    FACE_NUMBER,
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
    normal_of,
    star_lengths,
    surface_numbers,
)
from ..surface.surface_tree import members_at, node_at
from .edges import write_across_rim, write_across_side
from .frustum import FLANK, HIGH_CAP, HIGH_RIM, LOW_CAP, LOW_RIM, nearest_part, normal_of_part, over_part, rim_of
from .frustum_features import part_names, rims_of, set_back, tips_of
from .frustum_placed import Placed, from_axis, from_core
from .frustum_sphere import write_frustum_vertex
from .over_faces import frustum_in_surface, lowest_on_rim, write_apex, write_corner, write_rim, write_tip

RIM, POINT, APEX, UNDER, ACROSS_FLANK, ACROSS_BACK, ACROSS_FRONT = 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0
"""Kinds of candidates, the first of a candidate's three numbers.

In this order: rim over a face, point over a patch, round apex over a patch, corner of the surface, edge of the surface
across the side, edge across the first half of a rim, edge across the second half.  The numbers of face, patch, corner
or edge, and of rim (0 or 1) or point, follow.
"""
_HALVINGS = 40
"""Largest number of halvings of an edge: the rest is shorter than round-off of its length."""
_PIECES = 16
"""Largest number of pieces of an edge, each of which is compared with a rim."""
_SHARP = 1e-3
"""Margin for round-off of angles [rad], and length of the sum of two unit normals below which it has no direction."""
POINT_ROW, N_DIRECTIONS = 4, 3
"""Floats in the row of a point (foot or apex) before its unit vectors: position (3) [m], number of unit vectors.

``N_DIRECTIONS`` is the offset of this number, which all points of a frustum have in common.
"""


@compiled
def _point_at(points: Floats, i: int) -> Vertex:
    """Return a point of the frustum, a foot or the apex, from its row."""
    row = block_at(points, (POINT_ROW + 3 * int(points[N_DIRECTIONS])) * i)
    return Vertex(vector_at(row, 0), row[N_DIRECTIONS], block_at(row, POINT_ROW))


class _Search(NamedTuple):
    """A search for features of a surface that may soon touch a frustum, in the axes of the surface."""

    surface: Floats
    """The surface (:mod:`bodies.contacts.surface.surface_tables`)."""
    frustum: Placed
    """The frustum."""
    reach: float
    """Distance from the frustum's core up to which features are near [m]."""
    turn: float
    """Largest relative rotation of the bodies until the next search [rad]."""
    size: float
    """Size of the bodies [m]."""


@compiled
def _from_rim(frustum: Placed, rim: int, point: Vector3) -> float:
    """Return the distance of a point from a rim of the core [m]."""
    (radius, height, _), (along, away, _) = rim_of(frustum.numbers, rim), from_axis(frustum, point)
    return math.hypot(along - height, away - radius)


@compiled
def _swing(radial: float, turn: float) -> float:
    """Return a bound of the displacement of a rim's lowest point, relative to the rim's radius, if the normal turns.

    The normal has the component ``radial`` across the rim's axis and turns by at most ``turn`` [rad].  So its radial
    direction turns by at most asin(turn / radial) <= pi turn / (2 radial).  The bound is at most 2, a diameter.
    """
    return 2.0 if turn >= radial else min(2.0, 0.5 * math.pi * turn / radial)


@compiled
def _rim_is_near(search: _Search, row: Floats, rim: int) -> bool:
    """Return whether a rim's point that is lowest over a triangle, by its row, may touch it before the next search."""
    surface, frustum, reach, turn, _ = search
    lowest = lowest_on_rim(frustum, rim, opposite(normal_of(surface, int(row[FACE_NUMBER]))), tangent_of(frustum.axis))
    if lowest.off_cone > CONE_MARGIN + turn:
        return False
    # a cheap test first: the whole rim and a ball about the triangle
    p, q, r = vector_at(row, 0), vector_at(row, 3), vector_at(row, 6)
    middle = divided(plus(plus(p, q), r), 3.0)
    radius = max(norm(minus(p, middle)), norm(minus(q, middle)), norm(minus(r, middle)))
    if _from_rim(frustum, rim, middle) > reach + radius:
        return False
    # the lowest point moves along the rim, too, as the bodies turn
    return distance_from_triangle(row, lowest.point) <= reach + lowest.spot.away * _swing(lowest.radial, turn)


@compiled
def _edge_comes_near(frustum: Placed, edge: Floats, reach: float) -> bool:
    """Return whether a point of an edge, by its row, is within the signed distance ``reach`` [m] of the core.

    A negative ``reach`` is a depth inside the core.  The distance from a convex body is a convex function along a line,
    so that halvings find its minimum.
    """
    start, direction, low, high = vector_at(edge, START), vector_at(edge, ALONG), 0.0, edge[LENGTH]
    for _ in range(_HALVINGS):
        s, half = 0.5 * (low + high), 0.5 * (high - low)
        along, away, outward = from_axis(frustum, plus_scaled(start, s, direction))
        distance, radial, axial, _ = nearest_part(frustum.numbers, along, away)
        if distance <= reach:
            return True
        # the distance changes by at most the length of half of the interval
        if distance - half > reach:
            return False
        if radial * dot(outward, direction) + axial * dot(frustum.axis, direction) > 0.0:
            high = s
        else:
            low = s
    return True


@compiled
def _edge_normal(edge: Floats) -> tuple[Vector3, float]:
    """Return the inward unit vector opposite to the mean normal of an edge's faces, and half of their angle [rad].

    ``edge`` is the row of the edge.  If the outward normals of both faces are nearly opposite, they have no mean: the
    result is the first face's inward normal, and pi, which allows all normals.
    """
    along = vector_at(edge, ALONG)
    left = cross(along, vector_at(edge, INTO_FIRST))
    right = cross(vector_at(edge, INTO_SECOND), along)
    n = plus(left, right)
    length = norm(n)
    if length <= _SHARP:
        return opposite(left), math.pi
    return divided(opposite(n), length), math.acos(min(0.5 * length, 1.0))


@compiled
def _rim_crosses(search: _Search, rim: int, normal: Vector3, most_angle: float, edge: Floats) -> bool:
    """Return whether an edge, by its row, may touch a rim at the rim's farthest point along a normal near ``normal``.

    All normals within ``most_angle`` [rad] of ``normal`` are considered.
    """
    frustum, reach = search.frustum, search.reach
    start, along, length = vector_at(edge, START), vector_at(edge, ALONG), edge[LENGTH]
    lowest = lowest_on_rim(frustum, rim, normal, tangent_of(frustum.axis))
    if lowest.off_cone > most_angle:
        return False
    # the edge must be near the lowest point, which moves round the rim as the normal turns
    radius = lowest.spot.away
    most = reach + radius * _swing(lowest.radial, most_angle)
    s = min(max(dot(minus(lowest.point, start), along), 0.0), length)
    apart = minus(plus_scaled(start, s, along), lowest.point)
    if dot(apart, apart) > most * most:
        return False
    # and a piece of the edge must be near the rim: pieces of a quarter of the rim's radius, if these are not too many
    pieces = min(_PIECES, 1 + int(4.0 * length / radius))
    half = 0.5 * length / pieces
    for i in range(pieces):
        if _from_rim(frustum, rim, plus_scaled(start, (2 * i + 1) * half, along)) <= reach + half:
            return True
    return False


@compiled
def _edge_is_near(search: _Search, edge: Floats) -> tuple[bool, bool, bool]:
    """Return whether an edge, by its row, may touch the side, the lower rim and the upper rim before the next search.

    An edge that passes through the frustum may touch each part that the frustum has, at any angle between the normals,
    because the bodies overlap.
    """
    frustum, numbers = search.frustum, search.frustum.numbers
    has_side = numbers[SIDE] > 0.0
    has_upper = has_side and numbers[HIGH_RADIUS] > 0.0
    if not _edge_comes_near(frustum, edge, search.reach):
        return False, False, False
    # a disc has no inside
    if _edge_comes_near(frustum, edge, -CLOSED * search.size if has_side else 0.0):
        return has_side, True, has_upper
    # an edge touches with the normals between those of its faces
    n, half = _edge_normal(edge)
    most_angle = half + search.turn + _SHARP
    flank = has_side and abs(dot(n, frustum.axis) - numbers[SIN]) <= most_angle
    upper = has_upper and _rim_crosses(search, HIGH_RIM, n, most_angle, edge)
    return flank, _rim_crosses(search, LOW_RIM, n, most_angle, edge), upper


@compiled
def _corner_is_near(search: _Search, corner: int) -> bool:
    """Return whether a corner may touch the frustum before the next search.

    If a body is rounded, a corner touches only if none of its edges leads towards the point of the frustum's core that
    is nearest to the corner.  The vector from the corner to this point changes by at most the displacement of the
    corner.  A sharp corner touches a cap or the side of a sharp frustum only if none of its edges leads into the
    frustum more steeply than ``CONE_MARGIN``.
    """
    surface, frustum, reach, turn, size = search
    numbers, _, axis = frustum
    vertex, sweep = corner_at(surface, corner), numbers[FRUSTUM_SWEEP] + surface[SWEEP]
    along, away, outward = from_axis(frustum, vertex.place)
    distance, radial, axial, _ = nearest_part(numbers, along, away)
    if distance > reach:
        return False
    if distance < -CLOSED * size:
        return True
    if sweep > 0.0:
        # the corner moves by at most the margin of the search
        inward, displacement = opposite(normal_of_part(axis, outward, radial, axial)), reach - sweep
        return bool(distance <= 0.0 or distance * steepest(vertex, inward) <= displacement + turn * distance)
    for part in (LOW_CAP, FLANK, HIGH_CAP):
        height, past, radial, axial = over_part(numbers, part, along, away)
        most_angle = turn
        if part == FLANK:
            # as the corner moves by up to ``reach``, the side's normal turns round the axis: add a bound of the angle
            most_angle += 2.0 if reach >= away else 0.5 * math.pi * reach / away
        inward = opposite(normal_of_part(axis, outward, radial, axial))
        if abs(height) <= reach and past <= reach and steepest(vertex, inward) <= CONE_MARGIN + most_angle:
            return True
    return False


@compiled
def _add(kind: float, second: float, third: float, out: Floats, n: int, most: int) -> int:
    """Append a candidate to the ``n`` candidates in ``out``, unless n exceeds ``most``; return the new number.

    ``kind``, ``second`` and ``third`` are the three numbers of the candidate, its kind and its two features; those of
    candidate i begin at ``1 + 3 i``.  One candidate more than ``most`` may be appended: there are too many.  A face of
    several triangles, which is found with each of them, is appended once.
    """
    for i in range(n if kind == RIM else 0):
        if out[1 + 3 * i] == RIM and out[2 + 3 * i] == second and out[3 + 3 * i] == third:
            return n
    if n > most:
        return n
    out[1 + 3 * n], out[2 + 3 * n], out[3 + 3 * n] = kind, second, third
    return n + 1


@compiled
def _member_near(search: _Search, member: int, out: Floats, n: int, most: int) -> int:
    """Append the candidates of one triangle, edge or corner of the surface that may soon touch the frustum.

    ``member`` counts triangles first, then edges, then corners.  A feature may touch if two conditions hold: its
    distance from the core, the frustum without its rounding, is at most the reach of the search; a rotation by at most
    the turn of the search makes one of its normals opposite to a normal of the frustum.  ``out`` holds ``n``
    candidates.  Return the new number of candidates; a number above ``most`` means that there are too many.
    """
    surface, numbers = search.surface, search.frustum.numbers
    kind, number, row = feature_of(surface, member)
    if kind == ON_FACE:
        # a cone and a disc have the lower rim only
        for upper in range(2 if numbers[SIDE] > 0.0 and numbers[HIGH_RADIUS] > 0.0 else 1):
            if _rim_is_near(search, row, HIGH_RIM if upper == 1 else LOW_RIM):
                n = _add(RIM, float(number), float(upper), out, n, most)
    elif kind == ON_EDGE:
        flank, lower, upper_rim = _edge_is_near(search, row)
        if flank:
            n = _add(ACROSS_FLANK, float(number), 0.0, out, n, most)
        for upper, is_near in enumerate((lower, upper_rim)):
            if is_near:
                n = _add(ACROSS_BACK, float(number), float(upper), out, n, most)
                n = _add(ACROSS_FRONT, float(number), float(upper), out, n, most)
    elif _corner_is_near(search, number):
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
    search = _Search(surface, placed, reach, turn, size)
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
    solid, rim = Solid(b, surface), LOW_RIM + (HIGH_RIM - LOW_RIM) * j
    sweep = frustum[FRUSTUM_SWEEP] + surface[SWEEP]
    # distance of the cores up to which the candidate is valid
    reach = sweep + candidate[3]
    if kind == RIM:
        write_rim(a, out, frustum, rim, solid, i, reach)
    elif kind == POINT:
        write_tip(a, out, frustum, _point_at(points, j), solid, float(i), reach)
    elif kind == APEX:
        write_apex(a, out, frustum, solid, float(i), size, reach)
    elif kind == UNDER:
        if sweep > 0.0:
            write_frustum_vertex(a, b, out, frustum, surface[SWEEP], corner_at(surface, i), size)
        else:
            write_corner(a, out, frustum, solid, i, lengths, size)
    elif kind == ACROSS_FLANK:
        write_across_side(a, out, frustum, Edge(b, edge_at(surface, i)), surface, size)
    elif kind == ACROSS_BACK or kind == ACROSS_FRONT:
        half = -1.0 if kind == ACROSS_BACK else 1.0
        write_across_rim(a, out, frustum, float(rim), half, Edge(b, edge_at(surface, i)), surface, size)
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
        rows = [(*place, len(star) // 3, *star) for place, star in tips_of(first, is_sharp)] if n_faces else []
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
