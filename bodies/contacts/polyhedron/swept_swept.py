"""Contacts of two rounded polyhedra or capsules: crossing edges, and the list of all contacts."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import FEATURE, GAP, NORMAL, PAST_END, POINT_A, POINT_B, SIDE_A, SIDE_B
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...blocks import put
from ...shapes.polyhedron import SweptPolytope
from ..features.bounds import edges_bound
from ..features.frames import point_in_world, tangent_of, vector_in_world, write_tangent
from ..features.polytope_tables import FACE, INTO_FIRST, INTO_SECOND, Numbers, edge_rows, face_table
from ..features.swept_vertex import END, SweptVertex, size_of
from ..features.vertex_face import height_over
from ..features.writing import write_principal

MOST_CONTACTS = 4000
"""Largest number of contacts of two shapes without a search.

Two sharp polyhedra with more pairs of features use a search for near pairs.  Rounded polyhedra and frustums with more
are refused.
"""
_PARALLEL = 1e-5
"""Least sine of the angle between two crossing edges; at a smaller angle, the rounded vertices at their ends touch."""
_ASTRAY = 0.25
"""Sine of the largest angle between the contact normal and the edges' fans of normals, if the cores overlap.

It is 14 degrees.  If the angle is larger after the normal was reversed for an overlap, the cores are not treated as
overlapping at these edges.
"""


@compiled
def _astray(frame: Floats, edge: Floats, x: float, y: float, z: float) -> float:
    """Return the sine of the angle between the vector (x, y, z) and an edge's fan of normals; at most 0 inside."""
    ux, uy, uz = vector_in_world(frame, edge[INTO_FIRST], edge[INTO_FIRST + 1], edge[INTO_FIRST + 2])
    vx, vy, vz = vector_in_world(frame, edge[INTO_SECOND], edge[INTO_SECOND + 1], edge[INTO_SECOND + 2])
    return float(max(x * ux + y * uy + z * uz, x * vx + y * vy + z * vz))


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
    radius_a: float,
    radius_b: float,
    size: float,
) -> None:
    ax, ay, az = point_in_world(a, edge_a[0], edge_a[1], edge_a[2])
    bx, by, bz = point_in_world(b, edge_b[0], edge_b[1], edge_b[2])
    ex, ey, ez = vector_in_world(a, edge_a[3], edge_a[4], edge_a[5])
    fx, fy, fz = vector_in_world(b, edge_b[3], edge_b[4], edge_b[5])
    wx, wy, wz = bx - ax, by - ay, bz - az
    cx, cy, cz = ey * fz - ez * fy, ez * fx - ex * fz, ex * fy - ey * fx
    sine = math.sqrt(cx * cx + cy * cy + cz * cz)
    s = t = 0.0
    if sine > 0.01 * _PARALLEL:
        cx, cy, cz = cx / sine, cy / sine, cz / sine
        # s, t: distances of the nearest points along both edges, s = (w x f) . c / sine, t = (w x e) . c / sine; e, f:
        # directions of the edges, w: from start to start, c: unit vector perpendicular to both
        s = (cx * (wy * fz - wz * fy) + cy * (wz * fx - wx * fz) + cz * (wx * fy - wy * fx)) / sine
        t = (cx * (wy * ez - wz * ey) + cy * (wz * ex - wx * ez) + cz * (wx * ey - wy * ex)) / sine
        over = max(max(-s, s - edge_a[6]), max(-t, t - edge_b[6])) + END * size
        past = max(over, size * (_PARALLEL - sine))
    else:
        s = wx * ex + wy * ey + wz * ez
        cx, cy, cz = tangent_of(ex, ey, ez)
        past = size * _PARALLEL
    px, py, pz = ax + s * ex, ay + s * ey, az + s * ez
    qx, qy, qz = bx + t * fx, by + t * fy, bz + t * fz
    nx, ny, nz = qx - px, qy - py, qz - pz
    distance = math.sqrt(nx * nx + ny * ny + nz * nz)
    if distance > 0.0:
        nx, ny, nz = nx / distance, ny / distance, nz / distance
    else:
        nx, ny, nz = cx, cy, cz
    if past <= 0.0:
        inside = 0.0
        if n_faces_b > 0.0:
            inside = height_over(b, n_faces_b, faces_b, px, py, pz)
        if n_faces_a > 0.0:
            inside = min(inside, height_over(a, n_faces_a, faces_a, qx, qy, qz))
        # the point of one edge lies in the other core: the cores overlap, and the normal is reversed
        if inside < 0.0 and max(_astray(a, edge_a, -nx, -ny, -nz), _astray(b, edge_b, nx, ny, nz)) <= _ASTRAY:
            distance, nx, ny, nz = -distance, -nx, -ny, -nz
    gap = distance - radius_a - radius_b
    if past > 0.0:
        gap = math.sqrt(gap * gap + past * past)
    out[GAP], out[FEATURE], out[PAST_END] = gap, 0.0, past
    put(out, NORMAL, nx, ny, nz)
    put(out, POINT_A, px + radius_a * nx, py + radius_a * ny, pz + radius_a * nz)
    for i in range(3):
        out[POINT_B + i] = out[POINT_A + i] + gap * out[NORMAL + i]
    write_tangent(a, out)
    write_principal(out, SIDE_A, ex, ey, ez, 0.0, 1.0, 1.0, radius_a)
    write_principal(out, SIDE_B, fx, fy, fz, 0.0, 1.0, 1.0, radius_b)


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
    radius_a: float,
    radius_b: float,
    size: float,
) -> None:
    out[0] = edges_bound(a, b, edge_a, edge_b) - radius_a - radius_b


@final
@dataclass(frozen=True)
class SweptSwept(ContactKinematics):
    """Contact of a rounded edge of the first shape that crosses a rounded edge of the second.

    Rounded shapes touch if the distance of their cores is the sum of their radii.  The nearest points belong to a
    vertex and a face, a vertex and an edge, two vertices, or two edges that cross.  So every vertex and every pair of
    edges is a contact of its own, whose features never change.  A face on a face, or an edge on a face, has several
    contacts at once.  A contact whose features are not the nearest ones is open: its distance past the feature's
    boundary is positive.

    Attributes
    ----------
    edge_a, edge_b : tuple of float
        Rows of the edges (:data:`bodies.contacts.features.polytope_tables.EDGE`).
    faces_a, faces_b : tuple of float
        Rows of all faces of each core; empty for a segment.
    number_a, number_b : int
        Numbers of the edges in their shapes.
    radius_a, radius_b : float
        Radii about the edges [m].
    size : float
        Size of the bodies [m].
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (SweptPolytope, SweptPolytope)
    edge_a: Numbers
    edge_b: Numbers
    faces_a: Numbers
    faces_b: Numbers
    number_a: int
    number_b: int
    radius_a: float
    radius_b: float
    size: float

    def parameters(self) -> dict[str, Value]:
        """Return edges, faces, radii and size."""
        return {
            "edge_a": self.edge_a,
            "edge_b": self.edge_b,
            "n_faces_a": float(len(self.faces_a) // FACE),
            "faces_a": self.faces_a,
            "n_faces_b": float(len(self.faces_b) // FACE),
            "faces_b": self.faces_b,
            "radius_a": self.radius_a,
            "radius_b": self.radius_b,
            "size": self.size,
        }

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[ContactKinematics, ...]:
        """Return the contacts of pairs of edges, then of the second body's vertices, then of the first's vertices."""
        assert isinstance(first, SweptPolytope)
        assert isinstance(second, SweptPolytope)
        one, two = first.core, second.core
        n = len(one.edges) * len(two.edges) + len(one.vertices) + len(two.vertices)
        if n > MOST_CONTACTS:
            raise InvalidInput(
                "contact of two polyhedra",
                f"must have at most {MOST_CONTACTS} pairs of features",
                f"{len(one.edges)} edges against {len(two.edges)} make {n}",
                "Take polyhedra with fewer edges, or a smooth shape.",
            )
        faces, radii, size = (face_table(one), face_table(two)), (first.sweep, second.sweep), size_of(first, second)
        crossings = (
            cls(row_a, row_b, *faces, i, j, *radii, size)
            for i, row_a in enumerate(edge_rows(one))
            for j, row_b in enumerate(edge_rows(two))
        )
        return *crossings, *SweptVertex.between(first, second)

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
        """Name of the only pair of features."""
        return (f"edge {self.number_a} and edge {self.number_b}",)
