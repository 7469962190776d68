"""The matrices of a surface at a distance from a polyhedron or a segment."""

from __future__ import annotations

from bodies.contacts.features.curvature import write_flat, write_principal, write_round
from bodies.contacts.features.frames import vector_in_world
from bodies.contacts.features.polytope_tables import EDGE
from nonsmooth.compiled import compiled
from nonsmooth.types import Floats


@compiled
def write_swept(
    frame: Floats, out: Floats, side: int, number: int, n_faces: float, n_edges: float, edges: Floats, radius: float
) -> None:
    """Write a flat face, the side of a cylinder about an edge, or a sphere about a vertex, by the feature's number.

    Normal and first tangent stand in ``out`` already.
    """
    edge = number - int(n_faces)
    if edge < 0:
        write_flat(out, side)
    elif edge < int(n_edges):
        e = EDGE * edge
        x, y, z = vector_in_world(frame, edges[e + 3], edges[e + 4], edges[e + 5])
        write_principal(out, side, x, y, z, 0.0, 1.0, 1.0, radius)
    else:
        write_round(out, side, radius)
