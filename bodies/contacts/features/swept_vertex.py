"""A vertex, sharp or rounded to a sphere, against a swept polyhedron or segment of another body."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import ClassVar, final

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import FEATURE, GAP, NORMAL, PAST_END, SIDE_A, SIDE_B
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...shapes.polyhedron import SweptPolytope
from ...shapes.polytope import Point
from ...vectors import put, vector_at
from .frames import point_in_body, point_in_world, vector_in_body, vector_in_world, write_tangent
from .overlap_corners import common_direction, part_of_overlap, vertex_past_corner
from .polytope_tables import EDGE, FACE, Numbers, edge_rows, end_table, face_table, star_of
from .vertex_face import Nearest, nearest_feature
from .writing import write_flat, write_principal, write_round

END = 3e-10
"""Distance from a vertex, along an edge, at which the contact of the edge ends; relative to the size of the bodies.

The contact of the vertex ends at twice this distance.  Both contacts are valid between the two distances, so that a
point that slides from the edge to the vertex always has a contact.  If two bodies are pressed into each other with
flush faces, the corners of their overlap replace this rule (:mod:`bodies.contacts.features.overlap_corners`).
"""
OPEN = 100.0
"""Gap of a contact that another contact replaces, over its distance past the end of an edge; large, so it is open."""
NEAR = 1e-6
"""Gap, relative to the size of the bodies, above which the contact of a vertex stays valid wherever its point is.

The sphere about the vertex is a part of its body, so that its gap is always an upper bound of the gap of the bodies.
"""


@compiled
def past_star(
    frame: Floats, star: Floats, n_star: float, distance: float, nx: float, ny: float, nz: float, size: float
) -> float:
    """Return the distance of a contact past a vertex [m], less the tolerance ``2 END size``; negative if it is valid.

    The nearest point of the other body's core is at ``distance`` [m] from the vertex, against the normal (nx, ny, nz).
    The distance past the vertex is the largest coordinate of this point along an edge of the vertex, measured from
    the vertex.  If it is positive, this edge is nearer to the point than the vertex.  For a vertex inside of the other
    core the result is negative.
    """
    x, y, z = vector_in_body(frame, (nx, ny, nz))
    past = -size
    for i in range(int(n_star) if distance > 0.0 else 0):
        along = x * star[3 * i] + y * star[3 * i + 1] + z * star[3 * i + 2]
        past = max(past, -distance * along)
    return past - 2.0 * END * size


@compiled
def ended_gap(gap: float, past: float, size: float) -> tuple[float, float]:
    """Return gap and distance past the vertex [m], as the geometry block stores them.

    A contact with a gap above ``NEAR`` times the size is always valid.  If ``past`` is positive, a smaller gap that is
    not negative is replaced by hypot(gap, past).  A negative gap is kept: at this depth another contact takes over.
    """
    if gap > NEAR * size:
        return gap, min(past, -END * size)
    if past > 0.0 and gap >= 0.0:
        return math.sqrt(gap * gap + past * past), past
    return gap, past


@compiled
def write_vertex_over(
    a: Floats,
    b: Floats,
    out: Floats,
    swap: float,
    center: Point,
    radius: float,
    found: Nearest,
    past: float,
    n_faces: float,
    n_edges: float,
    edges: Floats,
    sweep: float,
    size: float,
) -> None:
    """Write the geometry block of a vertex, with its radius, against the nearest feature ``found`` of the other core.

    The vertex belongs to the first body if ``swap`` is 1, else to the second.  If the nearest feature is a vertex, too,
    the two bodies have two contacts for the same two vertices.  Only the contact of the second body's vertex can then
    close; the contact of the first body's vertex is written as open.  ``past`` is the result of :func:`past_star` [m].
    """
    other = b if swap == 1.0 else a
    number, distance, nx, ny, nz, within = found
    nx, ny, nz = vector_in_world(other, (nx, ny, nz))
    shared = END * size - within if swap == 1.0 else -math.inf
    gap, past = ended_gap(distance - sweep - radius, max(past, shared), size)
    if shared > 0.0:
        # near the end of the other body's edge another contact takes over: open this one by a large gap
        gap, past = math.hypot(distance - sweep - radius, OPEN * shared), max(past, shared)
    sign = 1.0 - 2.0 * swap
    near, far = 10 - int(3.0 * swap), 7 + int(3.0 * swap)
    out[GAP], out[FEATURE], out[PAST_END] = gap, number, past
    put(out, NORMAL, (sign * nx, sign * ny, sign * nz))
    put(out, near, (center[0] - radius * nx, center[1] - radius * ny, center[2] - radius * nz))
    put(out, far, (out[near] - gap * nx, out[near + 1] - gap * ny, out[near + 2] - gap * nz))
    write_tangent(a, out)
    write_swept(other, out, SIDE_B if swap == 1.0 else SIDE_A, number, n_faces, n_edges, edges, sweep)
    write_round(out, SIDE_A if swap == 1.0 else SIDE_B, radius)


def _evaluate(
    a: Floats,
    b: Floats,
    out: Floats,
    swap: float,
    n_faces: float,
    faces: Floats,
    n_edges: float,
    edges: Floats,
    ends: Floats,
    sweep: float,
    x_v: float,
    y_v: float,
    z_v: float,
    n_star: float,
    star: Floats,
    n_own_faces: float,
    own_faces: Floats,
    radius: float,
    size: float,
) -> None:
    """Write the geometry block of a vertex against a core; see the attributes of :class:`SweptVertex`."""
    own, other = (a, b) if swap == 1.0 else (b, a)
    px, py, pz = point_in_world(own, (x_v, y_v, z_v))
    x, y, z = point_in_body(other, (px, py, pz))
    found = nearest_feature(n_faces, faces, n_edges, edges, ends, x, y, z)
    nx, ny, nz = vector_in_world(other, (found[2], found[3], found[4]))
    number, distance, _, _, _, within = found
    # over a face the contact does not end at the vertex: an edge over the face touches with both ends, also if it tilts
    past = past_star(own, star, n_star if number >= int(n_faces) else 0.0, distance, nx, ny, nz, size)
    # bodies on springs overlap: then the corners of the overlap touch, else the nearest features
    part = part_of_overlap(radius + sweep - distance, size)
    if distance > 0.0 and part > 0.0:
        # the contact normal and the common direction u point from the first body to the second
        sign = 1.0 - 2.0 * swap
        if swap == 1.0:
            u = common_direction(a, b, n_own_faces, own_faces, n_faces, faces, -nx, -ny, -nz)
        else:
            u = common_direction(a, b, n_faces, faces, n_own_faces, own_faces, nx, ny, nz)
        if u[0] * u[0] + u[1] * u[1] + u[2] * u[2] > 0.0:
            u = sign * u[0], sign * u[1], sign * u[2]
            beyond, within = vertex_past_corner(
                own, other, swap == 1.0, u, n_faces, faces, n_edges, edges, ends, n_star, star, x, y, z, size
            )
            past = (1.0 - part) * past + part * beyond
    found = number, distance, found[2], found[3], found[4], within
    write_vertex_over(a, b, out, swap, (px, py, pz), radius, found, past, n_faces, n_edges, edges, sweep, size)


def _bound(
    a: Floats,
    b: Floats,
    out: Floats,
    swap: float,
    n_faces: float,
    faces: Floats,
    n_edges: float,
    edges: Floats,
    ends: Floats,
    sweep: float,
    x_v: float,
    y_v: float,
    z_v: float,
    n_star: float,
    star: Floats,
    n_own_faces: float,
    own_faces: Floats,
    radius: float,
    size: float,
) -> None:
    own, other = (a, b) if swap == 1.0 else (b, a)
    px, py, pz = point_in_world(own, (x_v, y_v, z_v))
    x, y, z = point_in_body(other, (px, py, pz))
    _, distance, _, _, _, _ = nearest_feature(n_faces, faces, n_edges, edges, ends, x, y, z)
    out[0] = distance - sweep - radius


write_vertex = compiled(_evaluate)
"""Compiled function that writes the geometry block of a vertex over a swept core; other contacts call it, too."""


def size_of(first: SweptPolytope, second: SweptPolytope) -> float:
    """Return the size of the larger of two shapes [m]."""
    return max(shape.core.size + 2.0 * shape.sweep for shape in (first, second))


@final
@dataclass(frozen=True)
class SweptVertex(ContactKinematics):
    """A vertex, with its radius, against the nearest face, edge or vertex of a swept core of the other body.

    If two vertices touch, only the contact of the second body's vertex closes; that of the first body's vertex is open.

    Attributes
    ----------
    swap : bool
        Whether the vertex belongs to the first body.
    faces, edges : tuple of float
        All faces and edges of the core (:mod:`bodies.contacts.features.polytope_tables`).
    ends : tuple of float
        Indices of the two vertices of each edge.
    sweep : float
        Radius of the sphere that sweeps the core [m].
    place : tuple of float
        The vertex in its body frame [m].
    star : tuple of float
        Unit vectors along the edges that begin at the vertex, in the body frame.
    own_faces : tuple of float
        All faces of the core to which the vertex belongs; empty if the body is not convex.
    radius : float
        Radius of the sphere about the vertex, the rounding of its body [m]; 0 if it is sharp.
    size : float
        Size of the larger body [m].
    name : str
        Name of the vertex.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (SweptPolytope, SweptPolytope)
    swap: bool
    faces: Numbers
    edges: Numbers
    ends: Numbers
    sweep: float
    place: tuple[float, float, float]
    star: Numbers
    own_faces: Numbers
    radius: float
    size: float
    name: str

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[SweptVertex, ...]:
        """Return the contacts of all vertices of the second shape, then those of the first."""
        assert isinstance(first, SweptPolytope)
        assert isinstance(second, SweptPolytope)
        size = size_of(first, second)
        return tuple(
            contact
            for swap, own, other in ((False, second, first), (True, first, second))
            for contact in cls.over(
                other,
                [(place, star_of(own.core, i), f"vertex {i}") for i, place in enumerate(own.core.vertices)],
                own.sweep,
                size,
                swap,
                face_table(own.core),
            )
        )

    @classmethod
    def over(
        cls,
        other: SweptPolytope,
        vertices: Iterable[tuple[tuple[float, float, float], Numbers, str]],
        radius: float,
        size: float,
        swap: bool,
        own_faces: Numbers = (),
    ) -> tuple[SweptVertex, ...]:
        """Return the contacts of vertices with the core of ``other``.

        Parameters
        ----------
        other : SweptPolytope
            The shape whose core the vertices touch.
        vertices : iterable of tuple
            Place in the body frame [m], unit vectors along the edges, and name of each vertex.
        radius : float
            Radius of the sphere about each vertex [m].
        size : float
            Size of the larger body [m].
        swap : bool
            Whether the vertices belong to the first body.
        own_faces : tuple of float
            All faces of the core of the vertices; empty if their body is not convex.
        """
        core = other.core
        tables = face_table(core), tuple(itertools.chain(*edge_rows(core))), end_table(core)
        return tuple(
            cls(swap, *tables, other.sweep, place, star, own_faces, radius, size, name)
            for place, star, name in vertices
        )

    def parameters(self) -> dict[str, Value]:
        """Return the parameters of the evaluator: the tables of the core, and the numbers of the vertex."""
        x, y, z = self.place
        return {
            "swap": float(self.swap),
            "n_faces": float(len(self.faces) // FACE),
            "faces": self.faces,
            "n_edges": float(len(self.edges) // EDGE),
            "edges": self.edges,
            "ends": self.ends,
            "sweep": self.sweep,
            "x_v": x,
            "y_v": y,
            "z_v": z,
            "n_star": float(len(self.star) // 3),
            "star": self.star,
            "n_own_faces": float(len(self.own_faces) // FACE),
            "own_faces": self.own_faces or (0.0,),
            "radius": self.radius,
            "size": self.size,
        }

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return _evaluate

    @property
    def bound(self) -> Callable[..., None]:
        """Distance of the vertex from the core, less both radii."""
        return _bound

    @property
    def features(self) -> tuple[str, ...]:
        """Names of the pairs of features: the vertex with each part of the core. The edge of a segment is its side."""
        edge = "edge" if self.faces else "side"
        counts = ("face", len(self.faces) // FACE), (edge, len(self.ends) // 2), ("vertex", int(max(self.ends)) + 1)
        parts = [f"{kind} {i}" for kind, n in counts for i in range(n)]
        return tuple(f"{self.name} and {part}" if self.swap else f"{part} and {self.name}" for part in parts)


@compiled
def write_swept(
    frame: Floats, out: Floats, side: int, number: int, n_faces: float, n_edges: float, edges: Floats, radius: float
) -> None:
    """Write the slide and turn matrices (curvature) of the swept surface at a feature of its core.

    Over a face the surface is flat, about an edge a cylinder, about a vertex a sphere.  ``number`` is the index of the
    feature: faces first, then edges, then vertices.  The caller has already written normal and first tangent to
    ``out``.
    """
    edge = number - int(n_faces)
    if edge < 0:
        write_flat(out, side)
    elif edge < int(n_edges):
        e = EDGE * edge
        x, y, z = vector_in_world(frame, vector_at(edges, e + 3))
        write_principal(out, side, x, y, z, 0.0, 1.0, 1.0, radius)
    else:
        write_round(out, side, radius)
