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

COUNTS, N_EDGES, N_FACES, VERTICES, EDGES, FACES, LOOPS, STARS, LISTS = range(6, 15)
"""Indices in the head of a polytope's numbers.

At ``COUNTS`` is the number of vertices, at ``N_EDGES`` and ``N_FACES`` are those of edges and faces.  At the others is
the index at which the list of this name begins.  ``LISTS`` are the lists of the edges of each vertex.
"""
EDGE, END, LEFT = 4, 1, 2
"""Length of the row of an edge, and offsets in it: first vertex, second vertex, faces on its left and right or -1."""
FACE, OFFSET, LOOP, N_LOOP = 6, 3, 4, 5
"""Length of the row of a face, and offsets in it.

The row is: outward normal, distance of the plane from the origin [m], beginning of its loop, number of its vertices.
"""
_HEADER = 15


def polyhedron_numbers(polytope: Polytope, radius: float = 0.0) -> Numbers:
    """Return the numbers of a polyhedron, with a radius about it [m].

    They begin like the numbers of a point (:func:`bodies.shapes.smooth.core_numbers`), because searches treat a vertex
    as a point: three semi-axes 0, two powers, the radius.  Then come the numbers of vertices, edges and faces, and the
    offsets of the six lists.  The lists are, in the frame of the body: vertices, edges, faces, loops (the vertices of a
    face, each with the edge that leaves it), stars (for every vertex, beginning and length of its list of edges), and
    these lists of edges.
    """
    return _numbers(polytope.vertices, polytope.faces, polytope.planes, polytope.edges, radius)


def segment_numbers(ends: Sequence[tuple[float, float, float]], radius: float) -> Numbers:
    """Return the numbers of a capsule, a segment with a radius about it [m]; see :func:`polyhedron_numbers`."""
    return _numbers(ends, (), (), ((0, 1, -1, -1),), radius)


def _numbers(
    vertices: Sequence[tuple[float, float, float]],
    faces: Sequence[tuple[int, ...]],
    planes: Sequence[tuple[float, float, float, float]],
    edges: Sequence[tuple[int, int, int, int]],
    radius: float,
) -> Numbers:
    """Return the numbers described at :func:`polyhedron_numbers`, from attributes of a polytope and a radius [m]."""
    edge_between = {pair: i for i, (one, two, _, _) in enumerate(edges) for pair in ((one, two), (two, one))}
    loops = [
        (one, edge_between[one, two]) for face in faces for one, two in zip(face, (*face[1:], face[0]), strict=True)
    ]
    begins = itertools.accumulate((len(face) for face in faces), initial=0)
    rows = [(*plane, 2 * begin, len(face)) for plane, begin, face in zip(planes, begins, faces, strict=False)]
    edges_of: list[list[int]] = [[] for _ in vertices]
    for i, edge in enumerate(edges):
        for vertex in edge[:2]:
            edges_of[vertex].append(i)
    begins = itertools.accumulate((len(one) for one in edges_of), initial=0)
    stars = [(begin, len(one)) for begin, one in zip(begins, edges_of, strict=False)]
    lists = [list(itertools.chain(*part)) for part in (vertices, edges, rows, loops, stars, edges_of)]
    offsets = itertools.accumulate((len(part) for part in lists[:-1]), initial=_HEADER)
    head = (0, 0, 0, 2, 2, radius, len(vertices), len(edges), len(faces), *offsets)
    return tuple(float(x) for x in (*head, *itertools.chain(*lists)))


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
"""A stop: gap [m], normal, kind and number of the feature on which the walk continues, and a point.

The point [m] is one of the feature, if the walk ends, or the start on the next feature, if this is a face.
"""
Nearest: TypeAlias = tuple[float, Vector3, int, Vector3]
"""Gap of the cores [m], normal, number of the polytope's nearest feature and a point of this feature [m].

The number of the feature counts faces first, then edges, then vertices.  On an edge or a vertex, the point is the
polytope's nearest point.  Vectors are in the frame of the polytope.  The gap is nan if the search failed.
"""


@compiled
def _vertex(hull: Floats, i: int) -> Vector3:
    """Return vertex i, in the axes of the polytope [m]."""
    return vector_at(hull, int(hull[VERTICES]) + 3 * i)


@compiled
def _begin_of_edge(hull: Floats, i: int) -> Vector3:
    """Return the first vertex of edge i, in the axes of the polytope [m]."""
    return _vertex(hull, int(hull[int(hull[EDGES]) + EDGE * i]))


@compiled
def _edge(hull: Floats, i: int) -> tuple[Vector3, float]:
    """Return the unit vector from the first to the second vertex of edge i, and the length of the edge [m]."""
    row = int(hull[EDGES]) + EDGE * i
    e = minus(_vertex(hull, int(hull[row + END])), _vertex(hull, int(hull[row])))
    length = norm(e)
    return divided(e, length), length


@compiled
def _edge_from(hull: Floats, vertex: int, i: int) -> tuple[int, float, Vector3]:
    """Return the number of edge i of a vertex, 1 if it begins there, else -1, and the edge's own unit vector."""
    star = int(hull[STARS]) + 2 * vertex
    edge = int(hull[int(hull[LISTS]) + int(hull[star]) + i])
    e, _ = _edge(hull, edge)
    return edge, 1.0 if int(hull[int(hull[EDGES]) + EDGE * edge]) == vertex else -1.0, e


@compiled
def _first_crossed(hull: Floats, face: int, margin: float, begin: Vector3, end: Vector3) -> int:
    """Return the number of the face's edge that a segment crosses outward first, or -1 if it crosses none.

    The segment is in the plane of the face, from ``begin`` on the face to ``end``.  A point up to ``margin`` past an
    edge [m] is still on the face.
    """
    row = int(hull[FACES]) + FACE * face
    n = vector_at(hull, row)
    loop, count = int(hull[LOOPS]) + int(hull[row + LOOP]), int(hull[row + N_LOOP])
    crossed, least = -1, 2.0
    for i in range(count):
        v, w = _vertex(hull, int(hull[loop + 2 * i])), _vertex(hull, int(hull[loop + 2 * ((i + 1) % count)]))
        e = minus(w, v)
        outward = divided(cross(e, n), norm(e))
        # distances of both points past the line of the edge
        before, after = dot(minus(begin, v), outward), dot(minus(end, v), outward)
        if after > margin and after > before:
            fraction = max(-before, 0.0) / (after - before)
            if fraction < least:
                crossed, least = int(hull[loop + 2 * i + 1]), fraction
    return crossed


@compiled
def _over_face(hull: Floats, core: Core, turn: Axes, center: Vector3, number: int) -> NearestPoint:
    """Return the gap between the plane of a face and the smooth body [m], the body's point [m] and the normal."""
    row = int(hull[FACES]) + FACE * number
    n = vector_at(hull, row)
    p, _ = facing_point(core, turn, center, n)
    return dot(n, p) - hull[row + OFFSET], p, n


@compiled
def _farthest_face(hull: Floats, core: Core, turn: Axes, center: Vector3) -> int:
    """Return the face whose plane has the largest gap to the smooth body, or -1 if the polytope is a segment."""
    farthest, largest = -1, -math.inf
    for i in range(int(hull[N_FACES])):
        gap, _, _ = _over_face(hull, core, turn, center, i)
        if gap > largest:
            farthest, largest = i, gap
    return farthest


@compiled
def _stop_on_face(
    hull: Floats, core: Core, turn: Axes, center: Vector3, margin: float, number: int, begin: Vector3
) -> Stop:
    """Return the stop on a face, from its point ``begin`` [m]; the other arguments are those of :func:`_stop_on`.

    The gap is that of the plane of the face.  If the plane's point is past a border, the walk continues on the first
    edge between ``begin`` and this point.
    """
    g, p, n = _over_face(hull, core, turn, center, number)
    edge = _first_crossed(hull, number, margin, begin, plus_scaled(p, -g, n))
    return g, n, _HERE if edge < 0 else _EDGE, edge, begin


@compiled
def _stop_on_edge(
    hull: Floats, core: Core, turn: Axes, center: Vector3, margin: float, number: int, start: Vector3
) -> Stop:
    """Return the stop on an edge, from the normal ``start``; the other arguments are those of :func:`_stop_on`.

    If the point of its line is past an end, the walk continues on this vertex.  If the normal leads into a face of the
    edge, the distance decreases on this face, and the walk continues on it.
    """
    row = int(hull[EDGES]) + EDGE * number
    v, (e, length) = _begin_of_edge(hull, number), _edge(hull, number)
    g, p, n = widest_from(hull, core, turn, minus(center, v), e, start)
    # distance of the line's point from the first vertex
    s = dot(p, e)
    if s < -margin or s > length + margin:
        return g, n, _VERTEX, int(hull[row]) if s < 0.0 else int(hull[row + END]), start
    next_face, steepest = -1, _ON_BORDER
    for i in range(2):
        face = int(hull[row + LEFT + i])
        if face >= 0:
            # component of the normal into the face, which is on the left (i = 0) or right of the edge
            slope = dot(n, cross(vector_at(hull, int(hull[FACES]) + FACE * face), e))
            slope = slope if i == 0 else -slope
            if slope > steepest:
                next_face, steepest = face, slope
    return g, n, _HERE if next_face < 0 else _FACE, next_face, plus_scaled(v, s, e)


@compiled
def _stop_on_vertex(hull: Floats, core: Core, turn: Axes, center: Vector3, number: int, start: Vector3) -> Stop:
    """Return the stop on a vertex, from the normal ``start``; the other arguments are those of :func:`_stop_on`.

    If the normal leads along an edge, the distance decreases there: the walk continues on the steepest such edge.
    """
    v = _vertex(hull, number)
    g, _, n = widest_from(hull, core, turn, minus(center, v), (0.0, 0.0, 0.0), start)
    next_edge, steepest = -1, _ON_BORDER
    for i in range(int(hull[int(hull[STARS]) + 2 * number + 1])):
        edge, sign, e = _edge_from(hull, number, i)
        slope = sign * dot(n, e)
        if slope > steepest:
            next_edge, steepest = edge, slope
    return g, n, _HERE if next_edge < 0 else _EDGE, next_edge, v


@compiled
def _middle(hull: Floats, face: int) -> Vector3:
    """Return the mean of the vertices of a face [m]."""
    row = int(hull[FACES]) + FACE * face
    loop, count = int(hull[LOOPS]) + int(hull[row + LOOP]), int(hull[row + N_LOOP])
    middle = 0.0, 0.0, 0.0
    for i in range(count):
        middle = plus(middle, divided(_vertex(hull, int(hull[loop + 2 * i])), count))
    return middle


@compiled
def _stop_on(
    hull: Floats, core: Core, turn: Axes, center: Vector3, margin: float, kind: int, number: int, start: Vector3
) -> Stop:
    """Return the stop on the feature of a ``kind`` with a ``number``: the minimum over its plane or line, or its point.

    ``start`` is a point of a face [m], or the normal with which the search on an edge or a vertex starts, of any
    length.  ``margin`` is the distance past the border of a feature that is round-off [m].  All vectors are in the axes
    of the polytope ``hull``; ``turn`` and ``center`` are those of :mod:`bodies.contacts.smooth.smooth_core`.
    """
    if kind == _FACE:
        stop: Stop = _stop_on_face(hull, core, turn, center, margin, number, start)
    elif kind == _EDGE:
        stop = _stop_on_edge(hull, core, turn, center, margin, number, start)
    else:
        stop = _stop_on_vertex(hull, core, turn, center, number, start)
    return stop


@compiled
def _nearest(hull: Floats, core: Core, turn: Axes, center: Vector3) -> Nearest:
    """Return gap, normal, nearest feature and point of a polytope and a smooth body.

    It is the final stop of the walk, if its overlap is below ``_SHALLOW`` or proved.  Otherwise it is the stop with the
    largest gap, of this one and those of all features.  If a search along a segment finds a gap that is not negative,
    this is the result.  ``center`` is the centre of the smooth body's core in the axes of the polytope [m].
    """
    n_edges, n_faces = int(hull[N_EDGES]), int(hull[N_FACES])
    start = _vertex(hull, 0)
    size = spread(center) + largest_semi_axis(core) + abs(start[0]) + abs(start[1]) + abs(start[2])
    margin = _ON_BORDER * size
    kind, number = _EDGE, 0
    if n_faces > 0:
        kind, number = _FACE, _farthest_face(hull, core, turn, center)
        start = _middle(hull, number)
    best: Nearest = (math.nan, (0.0, 0.0, 1.0), 0, start)
    for _ in range(n_edges + 4):
        # on an edge or a vertex, Newton's method starts with the direction to the smooth body's centre
        if kind != _FACE:
            start = minus(center, _begin_of_edge(hull, number) if kind == _EDGE else _vertex(hull, number))
        g, n, next_kind, next_number, start = _stop_on(hull, core, turn, center, margin, kind, number, start)
        stop = g, n, _feature(hull, kind, number), start
        if next_kind == _HERE and g >= -_SHALLOW * size:
            return stop
        # a final stop is valid only if the smooth body's centre is on the outer side of the feature
        if next_kind == _HERE and dot(n, minus(center, start)) > 0.0:
            # if the polytope's point lies in the smooth body (gauge below 1), the overlap is proved
            p, _ = facing_point(core, turn, center, n)
            if gauge(core, rotated_back(turn, minus(plus_scaled(p, -g, n), center))) < 1.0:
                return stop
            best = stop
        if g != g or next_kind == _HERE:
            break
        kind, number = next_kind, next_number
    on_segment: Nearest = (math.nan, (0.0, 0.0, 1.0), 0, start)
    if n_faces == 0:
        # a segment: its number is that of its side, first or second end
        v, (e, length) = _vertex(hull, 0), _edge(hull, 0)
        result, s = along_segment(core, turn, minus(center, v), e, length)
        number = n_edges if s == 0.0 else n_edges + 1 if s == length else 0
        on_segment = result[0], result[2], number, plus_scaled(v, s, e)
        if result[0] >= 0.0:
            return on_segment
    of_all: Nearest = _best_of_all(hull, core, turn, center, margin)
    if best[0] == best[0] and not of_all[0] > best[0]:
        return best
    if of_all[0] != of_all[0] and on_segment[0] == on_segment[0]:
        # no feature has a final stop: return the overlap that the search along the segment found
        return on_segment
    if of_all[0] != of_all[0] and n_faces == 0:
        of_all = _deep_segment(hull, core, turn, center, size)
    return of_all


@compiled
def _deep_segment(hull: Floats, core: Core, turn: Axes, center: Vector3, size: float) -> Nearest:
    """Return the result of :func:`_nearest` for a segment deep in the smooth body: the largest gap of ends and side.

    At an end the search starts from directions with a large gap, on the side from ``_ROUND`` directions round it.
    """
    best: Nearest = (math.nan, (0.0, 0.0, 1.0), 0, (0.0, 0.0, 0.0))
    e, _ = _edge(hull, 0)
    for end in range(2):
        v = _vertex(hull, end)
        g, _, n = up_hills(POINT, core, turn, minus(center, v), 0.0, (1.0, 0.0, size))
        slope = dot(n, e)
        # a normal that leads into the segment is not a normal of its end
        if (slope <= 0.0 if end == 0 else slope >= 0.0) and g == g and not g <= best[0]:
            best = g, n, _feature(hull, _VERTEX, end), v
    t = tangent_of(e)
    u = cross(e, t)
    for i in range(_ROUND):
        c, s = math.cos(2.0 * math.pi * i / _ROUND), math.sin(2.0 * math.pi * i / _ROUND)
        start = plus(scaled(c, t), scaled(s, u))
        g, n, next_kind, _, point = _stop_on_edge(hull, core, turn, center, _ON_BORDER * size, 0, start)
        if next_kind == _HERE and g == g and not g <= best[0]:
            best = g, n, _feature(hull, _EDGE, 0), point
    return best


@compiled
def _best_of_all(hull: Floats, core: Core, turn: Axes, center: Vector3, margin: float) -> Nearest:
    """Return the result of :func:`_nearest` by Newton's method on every feature of the polytope.

    It is used for overlaps in which the walk does not lead to a proved solution.  The result is the final stop with the
    largest gap.  Newton's method starts from an outward direction (:func:`_start_of`).
    """
    best: Nearest = (math.nan, (0.0, 0.0, 1.0), 0, (0.0, 0.0, 0.0))
    for kind in (_FACE, _EDGE, _VERTEX):
        for number in range(int(hull[COUNTS + kind])):
            start = _start_of(hull, kind, number, center)
            g, n, next_kind, _, point = _stop_on(hull, core, turn, center, margin, kind, number, start)
            if next_kind == _HERE and g == g and not g <= best[0]:
                best = g, n, _feature(hull, kind, number), point
    return best


@compiled
def _start_of(hull: Floats, kind: int, number: int, center: Vector3) -> Vector3:
    """Return the middle of a face [m], or a direction out of the polytope at an edge or a vertex, of any length.

    At an edge it is the sum of the normals of its two faces; at a vertex, of the unit vectors opposite to its edges.  A
    segment has no faces: there it is the vector from its first end to the smooth body's centre [m].
    """
    row, start = int(hull[EDGES]) + EDGE * number, (0.0, 0.0, 0.0)
    if kind == _FACE:
        start = _middle(hull, number)
    elif kind == _EDGE and hull[row + LEFT] < 0.0:
        start = minus(center, _begin_of_edge(hull, number))
    elif kind == _EDGE:
        for i in range(2):
            if hull[row + LEFT + i] >= 0.0:
                start = plus(start, vector_at(hull, int(hull[FACES]) + FACE * int(hull[row + LEFT + i])))
    else:
        for i in range(int(hull[int(hull[STARS]) + 2 * number + 1])):
            _, sign, e = _edge_from(hull, number, i)
            start = plus_scaled(start, -sign, e)
    return start


@compiled
def _feature(hull: Floats, kind: int, number: int) -> int:
    """Return the number of a feature among all features: faces first, then edges, then vertices."""
    if kind == _FACE:
        return number
    return number + int(hull[N_FACES]) + (int(hull[N_EDGES]) if kind == _VERTEX else 0)


def evaluate_polytope_smooth(a: Floats, b: Floats, out: Floats, first: Floats, second: Floats) -> None:
    """Write the geometry block of the contact between a polytope and a smooth body.

    ``first`` holds the numbers of the polytope (:func:`polyhedron_numbers`), ``second`` the numbers of the smooth body
    (:func:`bodies.shapes.smooth.core_numbers`).  The gap is nan if no nearest feature was found.
    """
    axes_b = axes_in_world(b, second)
    center, turn = point_in_body(a, point_in_world(b, vector_at(second, CENTER))), relative_rotation(axes_of(a), axes_b)
    g, n, feature, point = _nearest(first, second, turn, center)
    p, _ = facing_point(second, turn, center, n)
    n_faces, n_edges = int(first[N_FACES]), int(first[N_EDGES])
    if feature >= n_faces and not is_round(second):
        # on a flat place of the smooth body the normal does not determine the point: use the polytope's point
        p = plus_scaled(point, g, n)
    write_smooth(a, out, g - first[RADIUS] - second[RADIUS], second, axes_b, turn, center, n, p)
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
