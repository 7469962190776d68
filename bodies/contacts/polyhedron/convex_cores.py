"""Two edges of convex cores that cross, and the numbers that their contacts need."""

from __future__ import annotations

from dataclasses import dataclass

from nonsmooth.compiled import compiled
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...shapes.polytope import Polytope
from ..features.edge_crossing import Crossing, cross_edges
from ..features.polytope_tables import FACE, Numbers, face_table, vertex_table
from ..features.vertex_face import separation_of_faces


@compiled
def cross_convex_edges(
    a: Floats,
    b: Floats,
    edge_a: Floats,
    edge_b: Floats,
    n_faces_a: float,
    faces_a: Floats,
    n_faces_b: float,
    faces_b: Floats,
    n_vertices_a: float,
    vertices_a: Floats,
    n_vertices_b: float,
    vertices_b: Floats,
    parallel: float,
    margin: float,
    size: float,
) -> Crossing:
    """Return the crossing of two edges (:func:`bodies.contacts.features.edge_crossing.cross_edges`) of convex cores.

    Edges whose gap is below zero do not face each other if the cores overlap less along the normal of a face of one of
    them.  The arguments are those of :class:`Cores`.
    """
    p, e, f, n, gap, over, past = cross_edges(a, b, edge_a, 0, edge_b, 0, parallel, margin, size)
    if past <= 0.0 and gap < -abs(margin):
        best = separation_of_faces(a, b, n_faces_a, faces_a, n_vertices_b, vertices_b)
        best = max(best, separation_of_faces(b, a, n_faces_b, faces_b, n_vertices_a, vertices_a))
        past = max(past, best - gap - abs(margin))
    return p, e, f, n, gap, over, past


@dataclass(frozen=True)
class Cores:
    """Faces and vertices of two convex cores.

    Attributes
    ----------
    faces : tuple of tuple
        Rows of all faces of each core (:data:`bodies.contacts.features.polytope_tables.FACE`); empty for a segment.
    vertices : tuple of tuple
        All vertices of each core [m].
    """

    faces: tuple[Numbers, Numbers]
    vertices: tuple[Numbers, Numbers]

    @classmethod
    def of(cls, one: Polytope, two: Polytope) -> Cores:
        """Return the numbers of two cores."""
        return cls((face_table(one), face_table(two)), (vertex_table(one), vertex_table(two)))

    def values(self) -> dict[str, Value]:
        """Return the numbers by the names of the evaluators' arguments."""
        (faces_a, faces_b), (vertices_a, vertices_b) = self.faces, self.vertices
        return {
            "n_faces_a": float(len(faces_a) // FACE),
            "faces_a": faces_a,
            "n_faces_b": float(len(faces_b) // FACE),
            "faces_b": faces_b,
            "n_vertices_a": float(len(vertices_a) // 3),
            "vertices_a": vertices_a,
            "n_vertices_b": float(len(vertices_b) // 3),
            "vertices_b": vertices_b,
        }
