"""A sphere against a polyhedron, sharp or rounded, in closed form."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from nonsmooth.engine.memory.blocks import FEATURE, GAP, NORMAL, POINT_A, POINT_B, SIDE_A, SIDE_B
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...shapes.polyhedron import Polyhedron
from ...shapes.sphere import Sphere
from ...vectors import put
from ..features.frames import point_in_body, point_in_world, vector_in_world, write_tangent
from ..features.polytope_tables import EDGE, FACE, Numbers, edge_rows, end_table, face_table
from ..features.swept_vertex import write_swept
from ..features.vertex_face import nearest_feature
from ..features.writing import write_round


def _evaluate(
    a: Floats,
    b: Floats,
    out: Floats,
    n_faces: float,
    faces: Floats,
    n_edges: float,
    edges: Floats,
    ends: Floats,
    rounding: float,
    radius: float,
    x_b: float,
    y_b: float,
    z_b: float,
) -> None:
    center_x, center_y, center_z = point_in_world(b, (x_b, y_b, z_b))
    x, y, z = point_in_body(a, (center_x, center_y, center_z))
    number, distance, nx, ny, nz, _ = nearest_feature(n_faces, faces, n_edges, edges, ends, x, y, z)
    nx, ny, nz = vector_in_world(a, (nx, ny, nz))
    off = distance - rounding
    out[GAP], out[FEATURE] = off - radius, number
    put(out, NORMAL, (nx, ny, nz))
    put(out, POINT_A, (center_x - off * nx, center_y - off * ny, center_z - off * nz))
    put(out, POINT_B, (center_x - radius * nx, center_y - radius * ny, center_z - radius * nz))
    write_tangent(a, out)
    write_swept(a, out, SIDE_A, number, n_faces, n_edges, edges, rounding)
    write_round(out, SIDE_B, radius)


@final
@dataclass(frozen=True)
class PolyhedronSphere(ContactKinematics):
    """One contact of a sphere with the nearest face, edge or vertex of a polyhedron.

    Attributes
    ----------
    faces, edges : tuple of float
        All faces and edges of the polyhedron without its rounding (:mod:`bodies.contacts.features.polytope_tables`).
    ends : tuple of float
        Numbers of the two vertices of every edge.
    rounding : float
        Radius about the polyhedron [m].
    center : tuple of float
        Centre of the sphere in its body frame [m].
    radius : float
        Its radius [m]; 0 for a point.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Polyhedron, Sphere)
    faces: Numbers
    edges: Numbers
    ends: Numbers
    rounding: float
    center: tuple[float, float, float]
    radius: float

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[PolyhedronSphere, ...]:
        """Return the single contact of a polyhedron and a sphere."""
        assert isinstance(first, Polyhedron)
        assert isinstance(second, Sphere)
        return (cls.of_ball(first, (second.x, second.y, second.z), second.radius),)

    @classmethod
    def of_ball(cls, first: Polyhedron, center: tuple[float, float, float], radius: float) -> PolyhedronSphere:
        """Return the contact of a polyhedron and a ball, or a point, of another body [m]."""
        core = first.core
        edges = tuple(itertools.chain(*edge_rows(core)))
        return cls(face_table(core), edges, end_table(core), first.rounding, center, radius)

    def parameters(self) -> dict[str, Value]:
        """Return the tables and the sphere."""
        x, y, z = self.center
        return {
            "n_faces": float(len(self.faces) // FACE),
            "faces": self.faces,
            "n_edges": float(len(self.edges) // EDGE),
            "edges": self.edges,
            "ends": self.ends,
            "rounding": self.rounding,
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
