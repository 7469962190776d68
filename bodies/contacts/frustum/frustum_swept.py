"""Contacts of a cylinder, cone or disc and a polyhedron or capsule, if at least one of the two is rounded."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import GAP, NORMAL, PAST_END
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...shapes.frustum import Frustum
from ...shapes.polyhedron import SweptPolytope
from ..features.polytope_tables import Numbers, star_of
from ..features.swept_vertex import ended_gap, past_star
from ..features.writing import place_sphere
from ..polyhedron.swept_swept import MOST_CONTACTS
from .apex_swept import ApexSwept
from .flank_edge import FlankEdge
from .frustum import HIGH_CAP, LOW_CAP, part_names, seen_by
from .frustum_sphere import write_frustum_ball
from .frustum_writing import size_of_both
from .rim_edge import RimEdge
from .rim_face import RimFace


def _evaluate(
    a: Floats,
    b: Floats,
    out: Floats,
    first: Floats,
    radius: float,
    x: float,
    y: float,
    z: float,
    n_star: float,
    star: Floats,
    size: float,
) -> None:
    """Write the geometry block of a vertex, with a radius; parameters as the attributes of :class:`FrustumSwept`."""
    x, y, z, distance, part = write_frustum_ball(a, b, out, first, radius, x, y, z)
    # over a cap the contact does not end at the vertex: an edge over the cap touches with both ends, also if it tilts
    is_flat = part in (LOW_CAP, HIGH_CAP)
    past = past_star(b, star, 0.0 if is_flat else n_star, distance, out[NORMAL], out[NORMAL + 1], out[NORMAL + 2], size)
    gap, out[PAST_END] = ended_gap(out[GAP], past, size)
    place_sphere(a, out, x, y, z, gap + radius, radius)


write_vertex_ball = compiled(_evaluate)
"""Compiled function that writes the geometry block of a frustum and a rounded vertex; other contacts call it, too."""


def check_number(edges: int) -> None:
    """Raise InvalidInput if there are too many contacts."""
    if 5 * edges > MOST_CONTACTS:
        raise InvalidInput(
            "contact of a polyhedron with a round body",
            f"must have at most {MOST_CONTACTS} pairs of features",
            f"{edges} edges make {5 * edges}",
            "Take a polyhedron with fewer edges, or a smooth shape.",
        )


@final
@dataclass(frozen=True)
class FrustumSwept(ContactKinematics):
    """Contact of a vertex of a polyhedron, or an end of a capsule, with a frustum's nearest cap, rim, side or apex.

    The vertex is a sphere with the radius of rounding, or a point.  The two bodies touch if the distance of their cores
    is the sum of their radii.  :meth:`between` also returns the other contacts of the two bodies: edges with side and
    rims, rims and feet with faces, and the apex, as a sphere.  The features of a contact never change.  A contact whose
    features are not the nearest ones is open: its distance past the feature's boundary is positive.  Corners of meshes
    have these contacts, too (:class:`bodies.FrustumMesh`).

    Attributes
    ----------
    first : tuple of float
        The first body (:func:`bodies.shapes.frustum.frustum_numbers`).
    radius : float
        Radius about the core of the second body [m].
    place : tuple of float
        The vertex of its core in the body frame [m].
    star : tuple of float
        Unit vectors along the edges of the vertex.
    size : float
        Size of the bodies [m].
    name : str
        Name of the vertex.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Frustum, SweptPolytope)

    first: Numbers
    radius: float
    place: tuple[float, float, float]
    star: Numbers
    size: float
    name: str

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[ContactKinematics, ...]:
        """Return the contacts of all vertices, of all edges with side and rims, and of rims, feet and apex."""
        assert isinstance(first, Frustum)
        assert isinstance(second, SweptPolytope)
        core, size, numbers = second.core, size_of_both(first, second), seen_by(first, second.core)
        check_number(len(core.edges))
        vertices = (
            cls(numbers, second.sweep, place, star_of(core, i), size, f"vertex {i}")
            for i, place in enumerate(core.vertices)
        )
        others = (kind.between(first, second) for kind in (FlankEdge, RimEdge, RimFace, ApexSwept))
        return tuple(itertools.chain(vertices, *others))

    def parameters(self) -> dict[str, Value]:
        """Return the numbers of both bodies by the names of the evaluator's arguments."""
        x, y, z = self.place
        return {
            "first": self.first,
            "radius": self.radius,
            "x": x,
            "y": y,
            "z": z,
            "n_star": float(len(self.star) // 3),
            "star": self.star,
            "size": self.size,
        }

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return _evaluate

    @property
    def features(self) -> tuple[str, ...]:
        """Names of the frustum's parts, from the lower cap to the upper one, with the other feature."""
        return tuple(f"{part} and {self.name}" for part in part_names(self.first))
