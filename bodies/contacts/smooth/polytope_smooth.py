"""Gap of a convex polyhedron or segment and a body with a smooth support function.

The signed distance of a point from a convex body is a convex function, so that it has one minimum over the polytope.
The search for it, the walk, goes from feature to feature: faces, edges, vertices.  On each feature, Newton's method on
the support function finds the minimum over the feature's plane or line.  This minimum is called a stop.

1. If the stop is outside of its feature, the walk continues on the edge or vertex of the border that it crossed.
2. If the distance decreases from the stop into a neighbouring feature, the walk continues on this neighbour.
3. Otherwise the stop is the minimum over the polytope.

Every stop has a smaller distance than the stop before, so that the walk ends.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from typing import ClassVar, TypeAlias, final

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import FEATURE, SIDE_A
from nonsmooth.interfaces import ContactKinematics, FeaturePair, Shape
from nonsmooth.types import Floats

from ...shapes.capsule import Capsule
from ...shapes.polyhedron import Polyhedron
from ...shapes.polytope import Polytope
from ...shapes.smooth import SmoothShape
from ...shapes.support_function import Core, is_round
from ...vectors import Vector3, cross, divided, dot, minus, norm, plus, plus_scaled, scaled, vector_at
from ..features.frames import point_in_body, point_in_world, tangent_of, vector_in_world
from ..features.writing import write_flat, write_principal, write_round
from .inscribed import gauge
from .round_search import along_segment, up_hills
from .smooth_core import (
    CENTER,
    POINT,
    RADIUS,
    Axes,
    NearestPoint,
    axes_in_world,
    axes_of,
    facing_point,
    largest_semi_axis,
    relative_rotation,
    rotated_back,
    spread,
)
from .smooth_newton import widest_from, write_smooth

Numbers = tuple[float, ...]

COUNTS, VERTICES, EDGES, FACES, LOOPS, STARS, LISTS = 6, 9, 10, 11, 12, 13, 14
"""Indices in the head of a polytope's numbers.

At ``COUNTS`` is the number of vertices; the numbers of edges and of faces follow.  At ``VERTICES``, ``EDGES``,
``FACES``, ``LOOPS``, ``STARS`` and ``LISTS`` is the index at which the list of this name begins.  ``LISTS`` are the
lists of the edges of each vertex.
"""
EDGE, FACE = 4, 6
"""Length of the row of an edge and of the row of a face, respectively.

An edge: both vertices, the face on its left, the face on its right (-1 for none).  A face: outward normal, distance of
its plane from the origin [m], beginning and length of its loop.
"""
_HEADER = 15


def polyhedron_numbers(polytope: Polytope, radius: float = 0.0) -> Numbers:
    """Numbers of a polyhedron, with a radius about it [m].

    They begin like the numbers of a point (:func:`bodies.shapes.smooth.core_numbers`), because searches treat a vertex
    as a point: three semi-axes 0, two powers, the radius.  Then come the numbers of vertices, edges and faces, and the
    offsets of the six lists.  The lists are, in the frame of the body: vertices, edges, faces, loops (the vertices of a
    face, each with the edge that leaves it), stars (for every vertex, beginning and length of its list of edges), and
    these lists of edges.
    """
    return _numbers(polytope.vertices, polytope.faces, polytope.planes, polytope.edges, radius)


def segment_numbers(ends: Sequence[tuple[float, float, float]], radius: float) -> Numbers:
    """Numbers of a capsule, a segment with a radius about it [m]; see :func:`polyhedron_numbers`."""
    return _numbers(ends, (), (), ((0, 1, -1, -1),), radius)


def _numbers(
    vertices: Sequence[tuple[float, float, float]],
    faces: Sequence[tuple[int, ...]],
    planes: Sequence[tuple[float, float, float, float]],
    edges: Sequence[tuple[int, int, int, int]],
    radius: float,
) -> Numbers:
    number = {pair: i for i, (one, two, _, _) in enumerate(edges) for pair in ((one, two), (two, one))}
    loops = [(one, number[one, two]) for face in faces for one, two in zip(face, (*face[1:], face[0]), strict=True)]
    begins = itertools.accumulate((len(face) for face in faces), initial=0)
    rows = [(*plane, 2 * begin, len(face)) for plane, begin, face in zip(planes, begins, faces, strict=False)]
    own: list[list[int]] = [[] for _ in vertices]
    for i, edge in enumerate(edges):
        for vertex in edge[:2]:
            own[vertex].append(i)
    begins = itertools.accumulate((len(one) for one in own), initial=0)
    stars = [(begin, len(one)) for begin, one in zip(begins, own, strict=False)]
    parts = [list(itertools.chain(*part)) for part in (vertices, edges, rows, loops, stars, own)]
    offsets = itertools.accumulate((len(part) for part in parts[:-1]), initial=_HEADER)
    head = (0, 0, 0, 2, 2, radius, len(vertices), len(edges), len(faces), *offsets)
    return tuple(float(x) for x in (*head, *itertools.chain(*parts)))


_HERE, _VERTEX, _EDGE, _FACE = -1, 0, 1, 2
"""Kind of the feature on which the walk continues; ``_HERE``: the walk ends, on the present feature."""
_ON_BORDER = 1e-14
"""Tolerance for round-off: a point or unit normal this far outside still belongs to a feature.

For the point it is the distance past the feature's border, relative to the size.  For the normal it is the sine of the
angle past the range of the feature's normals.
"""
_SHALLOW = 1e-6
"""Overlap of the cores, relative to the size, up to which the walk's final stop is accepted without further tests.

A deeper overlap can have several locally shortest separations, so that its stop is tested and compared with others.
"""
_ROUND = 8
"""Number of directions about a segment from which Newton's method starts, if the segment is deep in the body."""

Stop: TypeAlias = tuple[float, Vector3, int, int, Vector3]
"""Gap [m] and normal at a stop of the walk, kind and number of the feature that follows, point where it starts [m]."""
Nearest: TypeAlias = tuple[float, Vector3, int, Vector3]
"""Gap of the cores [m], normal, number of the polytope's nearest feature and a point of this feature [m].

The number of the feature counts faces first, then edges, then vertices.  On an edge or a vertex, the point is the
polytope's nearest point.  Vectors are in the frame of the polytope.  The gap is nan if the search failed.
"""


@compiled
def _vertex(hull: Floats, i: int) -> Vector3:
    return vector_at(hull, int(hull[VERTICES]) + 3 * i)


@compiled
def _begin_of_edge(hull: Floats, i: int) -> Vector3:
    """Return the first vertex of an edge [m]."""
    return _vertex(hull, int(hull[int(hull[EDGES]) + EDGE * i]))


@compiled
def _edge(hull: Floats, i: int) -> tuple[Vector3, float]:
    """Return the unit vector from the first to the second vertex of an edge, and its length."""
    at = int(hull[EDGES]) + EDGE * i
    e = minus(_vertex(hull, int(hull[at + 1])), _vertex(hull, int(hull[at])))
    length = norm(e)
    return divided(e, length), length


@compiled
def _edge_from(hull: Floats, vertex: int, i: int) -> tuple[int, float, Vector3]:
    """Return the number of edge i of a vertex, 1 if the edge begins there, -1 if it ends there, its unit vector."""
    star = int(hull[STARS]) + 2 * vertex
    edge = int(hull[int(hull[LISTS]) + int(hull[star]) + i])
    e, _ = _edge(hull, edge)
    return edge, 1.0 if int(hull[int(hull[EDGES]) + EDGE * edge]) == vertex else -1.0, e


@compiled
def _exit(hull: Floats, face: int, near: float, here: Vector3, there: Vector3) -> int:
    """Return the number of the face's edge that the line between two points crosses first, or -1 if it crosses none.

    Both points are in the plane of the face, the first on the face.  A point up to ``near`` past an edge [m] is on it.
    """
    at = int(hull[FACES]) + FACE * face
    n = vector_at(hull, at)
    loop, count = int(hull[LOOPS]) + int(hull[at + 4]), int(hull[at + 5])
    found, least = -1, 2.0
    for i in range(count):
        v, w = _vertex(hull, int(hull[loop + 2 * i])), _vertex(hull, int(hull[loop + 2 * ((i + 1) % count)]))
        e = minus(w, v)
        outward = divided(cross(e, n), norm(e))
        before, after = dot(minus(here, v), outward), dot(minus(there, v), outward)
        if after > near and after > before:
            part = max(-before, 0.0) / (after - before)
            if part < least:
                found, least = int(hull[loop + 2 * i + 1]), part
    return found


@compiled
def _over_face(hull: Floats, core: Core, turn: Axes, place: Vector3, number: int) -> NearestPoint:
    """Return the gap between the plane of a face and the smooth body [m], the body's point [m] and the normal."""
    at = int(hull[FACES]) + FACE * number
    n = vector_at(hull, at)
    p, _ = facing_point(core, turn, place, n)
    return dot(n, p) - hull[at + 3], p, n


@compiled
def _best_face(hull: Floats, core: Core, turn: Axes, place: Vector3) -> int:
    """Return the face whose plane has the largest gap to the smooth body, or -1 if the polytope is a segment."""
    best, widest = -1, -math.inf
    for i in range(int(hull[COUNTS + 2])):
        wide, _, _ = _over_face(hull, core, turn, place, i)
        if wide > widest:
            best, widest = i, wide
    return best


@compiled
def _look_at_face(hull: Floats, core: Core, turn: Axes, place: Vector3, near: float, number: int, way: Vector3) -> Stop:
    g, p, n = _over_face(hull, core, turn, place, number)
    edge = _exit(hull, number, near, way, plus_scaled(p, -g, n))
    return g, n, _HERE if edge < 0 else _EDGE, edge, way


@compiled
def _look_at_edge(
    hull: Floats, core: Core, turn: Axes, place: Vector3, near: float, number: int, begin: Vector3
) -> Stop:
    at = int(hull[EDGES]) + EDGE * number
    v, (e, length) = _begin_of_edge(hull, number), _edge(hull, number)
    g, p, n = widest_from(hull, core, turn, minus(place, v), e, begin)
    s = dot(p, e)
    if s < -near or s > length + near:
        return g, n, _VERTEX, int(hull[at]) if s < 0.0 else int(hull[at + 1]), begin
    side, most = -1, _ON_BORDER
    for i in range(2):
        face = int(hull[at + 2 + i])
        if face >= 0:
            # into the face, whose loop runs along the edge on its left, against it on its right
            into = dot(n, cross(vector_at(hull, int(hull[FACES]) + FACE * face), e))
            into = into if i == 0 else -into
            if into > most:
                side, most = face, into
    return g, n, _HERE if side < 0 else _FACE, side, plus_scaled(v, s, e)


@compiled
def _look_at_vertex(hull: Floats, core: Core, turn: Axes, place: Vector3, number: int, begin: Vector3) -> Stop:
    v = _vertex(hull, number)
    g, _, n = widest_from(hull, core, turn, minus(place, v), (0.0, 0.0, 0.0), begin)
    steepest, most = -1, _ON_BORDER
    for i in range(int(hull[int(hull[STARS]) + 2 * number + 1])):
        edge, sign, e = _edge_from(hull, number, i)
        away = sign * dot(n, e)
        if away > most:
            steepest, most = edge, away
    return g, n, _HERE if steepest < 0 else _EDGE, steepest, v


@compiled
def _middle(hull: Floats, face: int) -> Vector3:
    at = int(hull[FACES]) + FACE * face
    loop, count = int(hull[LOOPS]) + int(hull[at + 4]), int(hull[at + 5])
    middle = 0.0, 0.0, 0.0
    for i in range(count):
        middle = plus(middle, divided(_vertex(hull, int(hull[loop + 2 * i])), count))
    return middle


@compiled
def _look(
    hull: Floats, core: Core, turn: Axes, place: Vector3, near: float, kind: int, number: int, begin: Vector3
) -> Stop:
    """Return the stop of a feature; ``begin`` is a point of a face [m], or the first normal at an edge or vertex."""
    if kind == _FACE:
        found: Stop = _look_at_face(hull, core, turn, place, near, number, begin)
    elif kind == _EDGE:
        found = _look_at_edge(hull, core, turn, place, near, number, begin)
    else:
        found = _look_at_vertex(hull, core, turn, place, number, begin)
    return found


@compiled
def _nearest(hull: Floats, core: Core, turn: Axes, place: Vector3) -> Nearest:
    """Return gap, normal, nearest feature and point of a polytope and a smooth body.

    ``place`` is the centre of the smooth body's core in the frame of the polytope [m].
    """
    n_edges, n_faces = int(hull[COUNTS + 1]), int(hull[COUNTS + 2])
    way = _vertex(hull, 0)
    size = spread(place) + largest_semi_axis(core) + abs(way[0]) + abs(way[1]) + abs(way[2])
    near = _ON_BORDER * size
    kind, number = _EDGE, 0
    if n_faces > 0:
        kind, number = _FACE, _best_face(hull, core, turn, place)
        way = _middle(hull, number)
    best: Nearest = (math.nan, (0.0, 0.0, 1.0), 0, way)
    # on edges and vertices Newton's method starts with the direction to the smooth body's centre
    for _ in range(n_edges + 4):
        if kind != _FACE:
            way = minus(place, _begin_of_edge(hull, number) if kind == _EDGE else _vertex(hull, number))
        g, n, after, where, way = _look(hull, core, turn, place, near, kind, number, way)
        stop = g, n, _feature(hull, kind, number), way
        if after == _HERE and g >= -_SHALLOW * size:
            return stop
        # a final stop is valid only if the smooth body's centre is on the outer side of the feature
        if after == _HERE and dot(n, minus(place, way)) > 0.0:
            # if the polytope's point lies in the smooth body (gauge below 1), the overlap is proved
            p, _ = facing_point(core, turn, place, n)
            if gauge(core, rotated_back(turn, minus(plus_scaled(p, -g, n), place))) < 1.0:
                return stop
            best = stop
        if g != g or after == _HERE:
            break
        kind, number = after, where
    on_segment: Nearest = (math.nan, (0.0, 0.0, 1.0), 0, way)
    if n_faces == 0:
        # a segment: search along it
        v, (e, length) = _vertex(hull, 0), _edge(hull, 0)
        found, s = along_segment(core, turn, minus(place, v), e, length)
        number = n_edges if s == 0.0 else n_edges + 1 if s == length else 0
        on_segment = found[0], found[2], number, plus_scaled(v, s, e)
        if found[0] >= 0.0:
            return on_segment
    of_all: Nearest = _best_of_all(hull, core, turn, place, near)
    if best[0] == best[0] and not of_all[0] > best[0]:
        return best
    if of_all[0] != of_all[0] and on_segment[0] == on_segment[0]:
        # the trial of all features found nothing: return the overlap that the search along the segment found
        return on_segment
    if of_all[0] != of_all[0] and n_faces == 0:
        of_all = _deep_segment(hull, core, turn, place, size)
    return of_all


@compiled
def _deep_segment(hull: Floats, core: Core, turn: Axes, place: Vector3, size: float) -> Nearest:
    """Return the result of :func:`_nearest` for a segment deep in the smooth body.

    Searches start uphill from both ends, and from ``_ROUND`` directions round the segment.
    """
    best: Nearest = (math.nan, (0.0, 0.0, 1.0), 0, (0.0, 0.0, 0.0))
    e, _ = _edge(hull, 0)
    for end in range(2):
        v = _vertex(hull, end)
        g, _, n = up_hills(POINT, core, turn, minus(place, v), 0.0, (1.0, 0.0, size))
        rise = dot(n, e)
        if (rise <= 0.0 if end == 0 else rise >= 0.0) and g == g and not g <= best[0]:
            best = g, n, _feature(hull, _VERTEX, end), v
    t = tangent_of(e)
    u = cross(e, t)
    for i in range(_ROUND):
        c, s = math.cos(2.0 * math.pi * i / _ROUND), math.sin(2.0 * math.pi * i / _ROUND)
        begin = plus(scaled(c, t), scaled(s, u))
        g, n, after, _, way = _look_at_edge(hull, core, turn, place, _ON_BORDER * size, 0, begin)
        if after == _HERE and g == g and not g <= best[0]:
            best = g, n, _feature(hull, _EDGE, 0), way
    return best


@compiled
def _best_of_all(hull: Floats, core: Core, turn: Axes, place: Vector3, near: float) -> Nearest:
    """Return the result of :func:`_nearest` by Newton's method on every feature of the polytope.

    It is used for overlaps in which the walk does not lead to a proved solution.  The result is the final stop with the
    largest gap.  Newton's method starts from an outward direction.  At an edge it is the sum of the normals of its
    faces, at a vertex the sum of the unit vectors opposite to its edges.
    """
    best: Nearest = (math.nan, (0.0, 0.0, 1.0), 0, (0.0, 0.0, 0.0))
    for kind in (_FACE, _EDGE, _VERTEX):
        for number in range(int(hull[COUNTS + kind])):
            begin = _begin(hull, kind, number, place)
            g, n, after, _, way = _look(hull, core, turn, place, near, kind, number, begin)
            if after == _HERE and g == g and not g <= best[0]:
                best = g, n, _feature(hull, kind, number), way
    return best


@compiled
def _begin(hull: Floats, kind: int, number: int, place: Vector3) -> Vector3:
    """Return the middle of a face [m], or a direction out of the polytope at an edge or a vertex, of any length.

    At an edge it is the sum of the normals of its two faces.  A segment has no faces: there it is the vector from its
    start to the smooth body's centre [m].
    """
    at, outward = int(hull[EDGES]) + EDGE * number, (0.0, 0.0, 0.0)
    if kind == _FACE:
        outward = _middle(hull, number)
    elif kind == _EDGE and hull[at + 2] < 0.0:
        outward = minus(place, _begin_of_edge(hull, number))
    elif kind == _EDGE:
        for i in range(2):
            if hull[at + 2 + i] >= 0.0:
                outward = plus(outward, vector_at(hull, int(hull[FACES]) + FACE * int(hull[at + 2 + i])))
    else:
        for i in range(int(hull[int(hull[STARS]) + 2 * number + 1])):
            _, sign, e = _edge_from(hull, number, i)
            outward = plus_scaled(outward, -sign, e)
    return outward


@compiled
def _feature(hull: Floats, kind: int, number: int) -> int:
    if kind == _FACE:
        return number
    return number + int(hull[COUNTS + 2]) + (int(hull[COUNTS + 1]) if kind == _VERTEX else 0)


def evaluate_polytope_smooth(a: Floats, b: Floats, out: Floats, first: Floats, second: Floats) -> None:
    """Write the geometry block of the contact between a polytope and a smooth body.

    ``first`` holds the numbers of the polytope (:func:`polyhedron_numbers`), ``second`` the numbers of the smooth body
    (:func:`bodies.shapes.smooth.core_numbers`).  The gap is nan if no nearest feature was found.
    """
    axes_b = axes_in_world(b, second)
    place, turn = point_in_body(a, point_in_world(b, vector_at(second, CENTER))), relative_rotation(axes_of(a), axes_b)
    g, n, feature, base = _nearest(first, second, turn, place)
    p, _ = facing_point(second, turn, place, n)
    n_faces, n_edges = int(first[COUNTS + 2]), int(first[COUNTS + 1])
    if feature >= n_faces and not is_round(second):
        # on a flat place of the smooth body the normal does not determine the point: use the polytope's point
        p = plus_scaled(base, g, n)
    write_smooth(a, out, g - first[RADIUS] - second[RADIUS], second, axes_b, turn, place, n, p)
    out[FEATURE] = feature
    if feature < n_faces:
        write_flat(out, SIDE_A)
    elif feature < n_faces + n_edges:
        x, y, z = vector_in_world(a, _edge(first, feature - n_faces)[0])
        write_principal(out, SIDE_A, (x, y, z), 0.0, 1.0, 1.0, first[RADIUS])
    else:
        write_round(out, SIDE_A, first[RADIUS])


@final
class PolyhedronSmooth(ContactKinematics):
    """A polyhedron and a smooth body: one contact, of the nearest face, edge or vertex."""

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Polyhedron, SmoothShape)

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FeaturePair, ...]:
        """Return the single contact; its features are the faces, edges and vertices of the polyhedron."""
        assert isinstance(first, Polyhedron)
        assert isinstance(second, SmoothShape)
        polytope = first.core
        parts = (("face", polytope.faces), ("edge", polytope.edges), ("vertex", polytope.vertices))
        names = tuple(f"{kind} {i} and smooth" for kind, part in parts for i in range(len(part)))
        values = {"first": polyhedron_numbers(polytope, first.rounding), "second": second.core}
        return (FeaturePair(evaluate_polytope_smooth, values, names),)


@final
class CapsuleSmooth(ContactKinematics):
    """A capsule and a smooth body: one contact, of the side or an end of the capsule."""

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Capsule, SmoothShape)

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FeaturePair, ...]:
        """Return the single contact; its features are the side and the ends of the capsule."""
        assert isinstance(first, Capsule)
        assert isinstance(second, SmoothShape)
        names = tuple(f"{part} and smooth" for part in ("side", "low end", "high end"))
        values = {"first": segment_numbers(first.ends, first.radius), "second": second.core}
        return (FeaturePair(evaluate_polytope_smooth, values, names),)
