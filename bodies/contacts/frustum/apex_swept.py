"""Contact of the apex of a cone with a polyhedron or a capsule, if one of the two is rounded."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from nonsmooth.compiled import compiled
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...shapes.frustum import COS, HIGH, SIDE, SIN, SWEEP, Frustum
from ...shapes.polyhedron import SweptPolytope
from ..features.frames import point_in_body, vector_in_world
from ..features.polytope_tables import EDGE, FACE, Numbers, edge_rows, end_table, face_table
from ..features.swept_vertex import END, write_vertex_over
from ..features.vertex_face import nearest_feature
from .frustum import axis_in_world, center_in_world
from .frustum_writing import size_of_both


@compiled
def past_apex(frustum: Floats, distance: float, axial: float, size: float) -> float:
    """Return the distance of the other body's nearest point past the apex [m], less the tolerance ``2 END size``.

    It is the coordinate of this point along a straight line on the cone's side, from the apex downwards.  If the result
    is positive, the side is nearer to the point than the apex.  The point lies at ``distance`` [m] from the apex;
    ``axial`` is the component, along the cone's axis, of the unit vector from the apex to the point.
    """
    radial = math.sqrt(max(1.0 - axial * axial, 0.0))
    return float(max(distance * (frustum[SIN] * radial - frustum[COS] * axial), -size) - 2.0 * END * size)


def _evaluate(
    a: Floats,
    b: Floats,
    out: Floats,
    first: Floats,
    n_faces: float,
    faces: Floats,
    n_edges: float,
    edges: Floats,
    ends: Floats,
    sweep: float,
    size: float,
) -> None:
    ax, ay, az = axis_in_world(a, first)
    px, py, pz = center_in_world(a, first)
    px, py, pz = px + first[HIGH] * ax, py + first[HIGH] * ay, pz + first[HIGH] * az
    x, y, z = point_in_body(b, (px, py, pz))
    found = nearest_feature(n_faces, faces, n_edges, edges, ends, x, y, z)
    nx, ny, nz = vector_in_world(b, (found[2], found[3], found[4]))
    past = past_apex(first, found[1], -nx * ax - ny * ay - nz * az, size)
    write_vertex_over(a, b, out, 1.0, (px, py, pz), first[SWEEP], found, past, n_faces, n_edges, edges, sweep, size)


@final
@dataclass(frozen=True)
class ApexSwept(ContactKinematics):
    """The apex of a cone against the nearest face or edge of the second body; a vertex has a contact of its own.

    Attributes
    ----------
    first : tuple of float
        The cone (:func:`bodies.shapes.frustum.frustum_numbers`).
    faces, edges, ends : tuple of float
        The core of the second body (:mod:`bodies.contacts.features.polytope_tables`).
    sweep : float
        Radius about the core of the second body [m].
    size : float
        Size of the bodies [m].
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Frustum, SweptPolytope)

    first: Numbers
    faces: Numbers
    edges: Numbers
    ends: Numbers
    sweep: float
    size: float

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[ApexSwept, ...]:
        """Return the single contact of a cone's apex; empty for other frustums, which have no apex."""
        assert isinstance(first, Frustum)
        assert isinstance(second, SweptPolytope)
        numbers, core = first.frustum, second.core
        if numbers[SIDE] == 0.0 or numbers[1] > 0.0:
            return ()
        edges = tuple(itertools.chain(*edge_rows(core)))
        return (cls(numbers, face_table(core), edges, end_table(core), second.sweep, size_of_both(first, second)),)

    def parameters(self) -> dict[str, Value]:
        """Return the numbers of both bodies by the names of the evaluator's arguments."""
        return {
            "first": self.first,
            "n_faces": float(len(self.faces) // FACE),
            "faces": self.faces or (0.0,),
            "n_edges": float(len(self.edges) // EDGE),
            "edges": self.edges,
            "ends": self.ends,
            "sweep": self.sweep,
            "size": self.size,
        }

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return _evaluate

    @property
    def features(self) -> tuple[str, ...]:
        """Names of the apex with each face, edge and vertex of the second body; two points have no contact here.

        Vertices have names only so that the numbers of the features agree with the tables.
        """
        counts = ("face", len(self.faces) // FACE), ("edge", len(self.ends) // 2), ("vertex", int(max(self.ends)) + 1)
        return tuple(f"apex and {name} {i}" for name, n in counts for i in range(n))
