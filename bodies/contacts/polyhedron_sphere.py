"""A sphere against a polyhedron, in closed form."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from bodies.contacts.curvature import SIDE_A, SIDE_B, write_flat, write_principal, write_round
from bodies.contacts.frames import point_in_world, vector_in_body, vector_in_world
from bodies.contacts.offset import place_sphere
from bodies.contacts.polytope_tables import EDGE, FACE, Numbers, edge_rows, face_table
from bodies.contacts.vertex_face import past_face, plane_height
from bodies.shapes.polyhedron import Polyhedron
from bodies.shapes.sphere import Sphere
from nonsmooth.compiled import compiled
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import Value
from nonsmooth.types import Floats


@compiled
def _nearest_face(faces: Floats, n_faces: float, x: float, y: float, z: float) -> tuple[int, float]:
    """Return the face that is nearest to a point and its height over it, or -1 where an edge or a vertex is."""
    highest, best = -1e300, 0
    for i in range(int(n_faces)):
        height = plane_height(faces, FACE * i, x, y, z)
        if height > highest:
            best, highest = i, height
    if highest <= 0.0:
        return best, highest
    for i in range(int(n_faces)):
        height = plane_height(faces, FACE * i, x, y, z)
        if height > 0.0 and past_face(faces, n_faces, FACE * i, height, x, y, z) <= 0.0:
            return i, height
    return -1, 0.0


@compiled
def _nearest_edge(edges: Floats, n_edges: float, x: float, y: float, z: float) -> tuple[int, float]:
    """Return the edge that is nearest to a point, and where on it the nearest point is [m]."""
    least, best, place = 1e300, 0, 0.0
    for i in range(int(n_edges)):
        e = EDGE * i
        wx, wy, wz = x - edges[e], y - edges[e + 1], z - edges[e + 2]
        along = min(max(wx * edges[e + 3] + wy * edges[e + 4] + wz * edges[e + 5], 0.0), edges[e + 6])
        wx, wy, wz = wx - along * edges[e + 3], wy - along * edges[e + 4], wz - along * edges[e + 5]
        square = wx * wx + wy * wy + wz * wz
        if square < least:
            least, best, place = square, i, along
    return best, place


def _evaluate(
    a: Floats,
    b: Floats,
    out: Floats,
    n_faces: float,
    faces: Floats,
    n_edges: float,
    edges: Floats,
    ends: Floats,
    radius: float,
    x_b: float,
    y_b: float,
    z_b: float,
) -> None:
    center_x, center_y, center_z = point_in_world(b, x_b, y_b, z_b)
    x, y, z = vector_in_body(a, center_x - a[0], center_y - a[1], center_z - a[2])
    face, distance = _nearest_face(faces, n_faces, x, y, z)
    if face >= 0:
        f = FACE * face
        out[1], out[2], out[3] = vector_in_world(a, faces[f], faces[f + 1], faces[f + 2])
        place_sphere(a, out, center_x, center_y, center_z, distance, radius)
        write_flat(out, SIDE_A)
        out[29] = float(face)
    else:
        edge, along = _nearest_edge(edges, n_edges, x, y, z)
        e = EDGE * edge
        nx = x - edges[e] - along * edges[e + 3]
        ny = y - edges[e + 1] - along * edges[e + 4]
        nz = z - edges[e + 2] - along * edges[e + 5]
        distance = math.sqrt(nx * nx + ny * ny + nz * nz)
        out[1], out[2], out[3] = vector_in_world(a, nx / distance, ny / distance, nz / distance)
        place_sphere(a, out, center_x, center_y, center_z, distance, radius)
        if 0.0 < along < edges[e + 6]:
            ex, ey, ez = vector_in_world(a, edges[e + 3], edges[e + 4], edges[e + 5])
            write_principal(out, SIDE_A, ex, ey, ez, 0.0, 1.0, 1.0, 0.0)
            out[29] = n_faces + edge
        else:
            write_round(out, SIDE_A, 0.0)
            out[29] = n_faces + n_edges + (ends[2 * edge] if along == 0.0 else ends[2 * edge + 1])
    write_round(out, SIDE_B, radius)


@final
@dataclass(frozen=True)
class PolyhedronSphere(ContactKinematics):
    """One contact of a sphere with the nearest face, edge or vertex of a polyhedron.

    Attributes
    ----------
    faces, edges : tuple of float
        All faces and edges (:mod:`bodies.contacts.polytope_tables`).
    ends : tuple of float
        Numbers of the two vertices of every edge.
    center : tuple of float
        Centre of the sphere in its body frame [m].
    radius : float
        Its radius [m].
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Polyhedron, Sphere)
    faces: Numbers
    edges: Numbers
    ends: Numbers
    center: tuple[float, float, float]
    radius: float

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[PolyhedronSphere, ...]:
        """Return the single contact of a polyhedron and a sphere."""
        assert isinstance(first, Polyhedron)
        assert isinstance(second, Sphere)
        own = first.polytope
        edges = tuple(itertools.chain(*edge_rows(own)))
        ends = tuple(float(i) for one, two, *_ in own.edges for i in (one, two))
        return (cls(face_table(own), edges, ends, (second.x, second.y, second.z), second.radius),)

    def parameters(self) -> dict[str, Value]:
        """Return the tables and the sphere."""
        x, y, z = self.center
        return {
            "n_faces": float(len(self.faces) // FACE),
            "faces": self.faces,
            "n_edges": float(len(self.edges) // EDGE),
            "edges": self.edges,
            "ends": self.ends,
            "radius": self.radius,
            "x_b": x,
            "y_b": y,
            "z_b": z,
        }

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return _evaluate

    @property
    def features(self) -> tuple[str, ...]:
        """The faces, edges and vertices by number."""
        counts = ("face", len(self.faces) // FACE), ("edge", len(self.ends) // 2), ("vertex", int(max(self.ends)) + 1)
        return tuple(f"{name} {i} and sphere" for name, n in counts for i in range(n))
