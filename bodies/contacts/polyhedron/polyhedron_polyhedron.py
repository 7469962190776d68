"""Contacts of two polyhedra: an edge of one with an edge of the other, and a vertex with the other body's faces."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import ClassVar, final

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import FEATURE, GAP, NORMAL, PAST_END, POINT_A, POINT_B, SIDE_A, SIDE_B, TANGENT
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...blocks import put
from ...shapes.polyhedron import Polyhedron
from ..features.bounds import edges_bound
from ..features.frames import point_in_world, tangent_of, vector_in_world
from ..features.polytope_tables import FACE, INTO_FIRST, INTO_SECOND, Numbers, edge_rows, face_table
from ..features.vertex_face import CLOSED, DEEP, height_over
from ..features.writing import write_principal
from ..surface.surface_pairs import SurfacePairs, features_of_core
from .polyhedron_point import PointPolyhedron, PolyhedronPoint
from .swept_swept import MOST_CONTACTS, SweptSwept

_ASTRAY = 0.25
"""Sine of the largest angle between the contact normal and the fans of normals of both edges: 14 degrees.

The fan of normals of an edge lies between the normals of its two faces.  The margin lets a contact be followed before
it can close.
"""


_INSIDE = 4.0
"""Least distance of a crossing from the ends of two edges that overlap, relative to the depth of the overlap.

Closer to its end, an edge may pass the other body without an overlap.  The rule applies only if both contact points are
outside of the other body; otherwise the overlap is certain.
"""
_BLUNT = 8.0
"""Factor in a rule for edges of thin wedges, for which both signs of the contact normal are possible.

The sign with a positive gap is taken if the normal then has a small angle to the fans of normals of both edges.  The
sine of this angle may be at most this factor times the depth of the overlap with the other sign, over the length of the
shorter edge.
"""


@compiled
def _astray(frame: Floats, edge: Floats, sign: float, x: float, y: float, z: float) -> float:
    """Return the sine of the angle between the vector ``sign`` * (x, y, z) and the fan of normals of an edge.

    It is not positive if the vector lies inside of the fan, between the normals of both faces of the edge.
    """
    ux, uy, uz = vector_in_world(frame, edge[INTO_FIRST], edge[INTO_FIRST + 1], edge[INTO_FIRST + 2])
    vx, vy, vz = vector_in_world(frame, edge[INTO_SECOND], edge[INTO_SECOND + 1], edge[INTO_SECOND + 2])
    one, other = x * ux + y * uy + z * uz, x * vx + y * vy + z * vz
    return float(max(sign * one, sign * other))


def _evaluate(
    a: Floats,
    b: Floats,
    out: Floats,
    edge_a: Floats,
    edge_b: Floats,
    n_faces_a: float,
    faces_a: Floats,
    n_faces_b: float,
    faces_b: Floats,
    size: float,
) -> None:
    ax, ay, az = point_in_world(a, edge_a[0], edge_a[1], edge_a[2])
    bx, by, bz = point_in_world(b, edge_b[0], edge_b[1], edge_b[2])
    ex, ey, ez = vector_in_world(a, edge_a[3], edge_a[4], edge_a[5])
    fx, fy, fz = vector_in_world(b, edge_b[3], edge_b[4], edge_b[5])
    wx, wy, wz = bx - ax, by - ay, bz - az
    nx, ny, nz = ey * fz - ez * fy, ez * fx - ex * fz, ex * fy - ey * fx
    sine = math.sqrt(nx * nx + ny * ny + nz * nz)
    margin = CLOSED * size
    if sine > 1e-3 * CLOSED:
        nx, ny, nz = nx / sine, ny / sine, nz / sine
        # places of the nearest points: (w x f) . n / sine along the first line, (w x e) . n / sine along the second
        s = (nx * (wy * fz - wz * fy) + ny * (wz * fx - wx * fz) + nz * (wx * fy - wy * fx)) / sine
        t = (nx * (wy * ez - wz * ey) + ny * (wz * ex - wx * ez) + nz * (wx * ey - wy * ex)) / sine
        over = max(max(-s, s - edge_a[6]), max(-t, t - edge_b[6]))
        past = max(over - margin, size * (CLOSED - sine))
    else:
        along = wx * ex + wy * ey + wz * ez
        nx, ny, nz = wx - along * ex, wy - along * ey, wz - along * ez
        apart = math.sqrt(nx * nx + ny * ny + nz * nz)
        if apart > 0.0:
            nx, ny, nz = nx / apart, ny / apart, nz / apart
        else:
            nx, ny, nz = tangent_of(ex, ey, ez)
        s, t, over, past = 0.0, 0.0, 0.0, 2.0 * margin
    # between the nearest points: the starts of the lines are far apart along edges that are almost parallel
    wx, wy, wz = wx + t * fx - s * ex, wy + t * fy - s * ey, wz + t * fz - s * ez
    gap = wx * nx + wy * ny + wz * nz
    overlap = 0.0
    # a contact may close up to the margin past the end of an edge, so its normal is checked there, too
    if past <= margin:
        plus = max(_astray(a, edge_a, 1.0, nx, ny, nz), _astray(b, edge_b, -1.0, nx, ny, nz))
        minus = max(_astray(a, edge_a, -1.0, nx, ny, nz), _astray(b, edge_b, 1.0, nx, ny, nz))
        if minus < plus:
            nx, ny, nz, gap = -nx, -ny, -nz, -gap
            plus, minus = minus, plus
        outside = 0.0
        if gap < 0.0 or plus > _ASTRAY:
            # the overlap is certain if the closest point of one edge lies inside of the other body
            px, py, pz = ax + s * ex, ay + s * ey, az + s * ez
            outside = height_over(b, n_faces_b, faces_b, px, py, pz)
            px, py, pz = bx + t * fx, by + t * fy, bz + t * fz
            outside = min(outside, height_over(a, n_faces_a, faces_a, px, py, pz))
        deep = outside < -DEEP * size
        if not deep and gap < 0.0 and minus <= min(_ASTRAY, -_BLUNT * gap / min(edge_a[6], edge_b[6])):
            # for edges of thin wedges, both signs of the normal are possible: take the sign with a positive gap
            nx, ny, nz, gap = -nx, -ny, -nz, -gap
            past = max(past, size * (minus - _ASTRAY))
        else:
            past = max(past, size * (plus - _ASTRAY))
            if gap < 0.0 and not deep:
                past = max(past, over - _INSIDE * gap - margin)
        if deep and past > 0.0:
            # the bodies overlap away from these edges: another contact was missed, so write the depth
            overlap = max(-abs(gap), outside)
    if past > 0.0:
        gap = overlap if overlap < 0.0 else math.sqrt(gap * gap + past * past)
    out[GAP], out[FEATURE], out[PAST_END] = gap, 0.0, past
    put(out, NORMAL, nx, ny, nz)
    put(out, POINT_A, ax + s * ex, ay + s * ey, az + s * ez)
    for i in range(3):
        out[POINT_B + i] = out[POINT_A + i] + gap * out[NORMAL + i]
    # take the edge as tangent: it is fixed to a body. If both edges lie in a face, round-off turns the normal, and a
    # tangent that is computed from the normal would turn with it
    put(out, TANGENT, ex, ey, ez)
    write_principal(out, SIDE_A, ex, ey, ez, 0.0, 1.0, 1.0, 0.0)
    write_principal(out, SIDE_B, fx, fy, fz, 0.0, 1.0, 1.0, 0.0)


def _bound(
    a: Floats,
    b: Floats,
    out: Floats,
    edge_a: Floats,
    edge_b: Floats,
    n_faces_a: float,
    faces_a: Floats,
    n_faces_b: float,
    faces_b: Floats,
    size: float,
) -> None:
    out[0] = edges_bound(a, b, edge_a, edge_b)


@final
@dataclass(frozen=True)
class PolyhedronPolyhedron(ContactKinematics):
    """Contact of an edge of the first polyhedron that crosses an edge of the second.

    Two polyhedra touch with a vertex on a face or with crossing edges; a face on a face is several such contacts at
    once.  So every vertex over the other body's faces, and every pair of edges, is a contact of its own.  Its features
    never change.  A contact whose features do not face each other is open.

    Attributes
    ----------
    edge_a, edge_b : tuple of float
        Rows of the edges (:data:`bodies.contacts.features.polytope_tables.EDGE`).
    faces_a, faces_b : tuple of float
        Rows of all faces of each body (:data:`bodies.contacts.features.polytope_tables.FACE`).
    number_a, number_b : int
        Numbers of the edges in their bodies.
    size : float
        Size of the larger body [m].
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Polyhedron, Polyhedron)
    departures: ClassVar[Mapping[str, str]] = MappingProxyType(
        dict.fromkeys(
            ("gap rate", "second-order terms"),
            "two given edges face each other in hardly any random pose; the tests make poses from edges that cross",
        )
    )
    edge_a: Numbers
    edge_b: Numbers
    faces_a: Numbers
    faces_b: Numbers
    number_a: int
    number_b: int
    size: float

    def parameters(self) -> dict[str, Value]:
        """Return edges, faces and size."""
        return {
            "edge_a": self.edge_a,
            "edge_b": self.edge_b,
            "n_faces_a": float(len(self.faces_a) // FACE),
            "faces_a": self.faces_a,
            "n_faces_b": float(len(self.faces_b) // FACE),
            "faces_b": self.faces_b,
            "size": self.size,
        }

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[ContactKinematics, ...]:
        """Return the contacts of pairs of edges, then of the second body's vertices, then of the first body's vertices.

        If one of the two is rounded, return the contacts of :class:`bodies.SweptSwept`.  If there are thousands of
        pairs, return contacts that a search assigns to near pairs
        (:class:`bodies.contacts.surface.surface_pairs.SurfacePairs`).
        """
        assert isinstance(first, Polyhedron)
        assert isinstance(second, Polyhedron)
        if first.rounding > 0.0 or second.rounding > 0.0:
            return SweptSwept.between(first, second)
        one, two = first.core, second.core
        size = max(one.size, two.size)
        n = len(one.edges) * len(two.edges) + len(one.vertices) + len(two.vertices)
        if n > MOST_CONTACTS:
            return SurfacePairs.of_surfaces(features_of_core(one), features_of_core(two), (first.extent, second.extent))
        faces = face_table(one), face_table(two)
        crossings = (
            cls(row_a, row_b, *faces, i, j, size)
            for i, row_a in enumerate(edge_rows(one))
            for j, row_b in enumerate(edge_rows(two))
        )
        return *crossings, *PolyhedronPoint.of_vertices(one, two), *PointPolyhedron.of_vertices(one, two)

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return _evaluate

    @property
    def bound(self) -> Callable[..., None]:
        """Distance of the edges, and of their normals."""
        return _bound

    @property
    def features(self) -> tuple[str, ...]:
        """Name of the only pair of features, an edge of each body."""
        return (f"edge {self.number_a} and edge {self.number_b}",)
