"""Contacts of a cylinder, cone or disc and a polyhedron or capsule, sharp or rounded."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from typing import ClassVar, final

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import GAP, NORMAL, PAST_END
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import ContactKinematics, FeaturePair, Shape
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...shapes.frustum import HIGH_RADIUS, SIDE, SWEEP, Frustum
from ...shapes.polyhedron import SweptPolytope
from ...vectors import vector_at
from ..features.polytope_tables import core_numbers, star_lengths, star_of
from ..features.swept_vertex import ended_gap, past_star
from ..features.writing import place_sphere
from .apex_swept import evaluate_apex_over_core
from .flank_edge import evaluate_edge_across_side
from .frustum import HIGH_CAP, LOW_CAP, RIM_NAMES, part_names, rims_and_tips, rims_of, seen_by, size_of_both
from .frustum_polyhedron import evaluate_vertex_over_frustum
from .frustum_sphere import write_frustum_ball
from .rim_edge import evaluate_edge_across_rim
from .rim_face import evaluate_rim_over_faces

MOST_CONTACTS = 4000
"""Largest number of contacts of a frustum and a polyhedron."""


def evaluate_rounded_vertex(
    a: Floats,
    b: Floats,
    out: Floats,
    first: Floats,
    radius: float,
    place: Floats,
    n_star: float,
    star: Floats,
    size: float,
) -> None:
    """Write the geometry block of a vertex, with a radius [m], and a frustum's nearest cap, rim, side or apex.

    ``place`` is the vertex in the frame of the second body [m].  ``star`` holds ``n_star`` unit vectors along its
    edges.  ``size`` is the size of the bodies [m].
    """
    point, distance, part = write_frustum_ball(a, b, out, first, radius, vector_at(place, 0))
    # over a cap the contact does not end at the vertex: an edge over the cap touches with both ends, also if it tilts
    is_flat = part in (LOW_CAP, HIGH_CAP)
    past = past_star(b, star, 0.0 if is_flat else n_star, distance, vector_at(out, NORMAL), size)
    gap, out[PAST_END] = ended_gap(out[GAP], past, size)
    place_sphere(a, out, point, gap + radius, radius)


write_rounded_vertex = compiled(evaluate_rounded_vertex)
"""Compiled function that writes the geometry block of a frustum and a rounded vertex; other contacts call it, too."""


@final
class FrustumSwept(ContactKinematics):
    """Contacts of a cylinder, cone or disc and a polyhedron or capsule.

    They are contacts of vertices with the frustum, of edges with side and rims, and of rims and feet with faces.  The
    features of a contact never change.  A contact whose features do not face each other is open.  A body that lies on
    its side has contacts of its two rims, a standing body has contacts of its feet.

    If one of the bodies is rounded, a vertex and the apex are spheres, or points.  The two bodies touch if the distance
    of their cores is the sum of their radii.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Frustum, SweptPolytope)

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FeaturePair, ...]:
        """Return the contacts of all vertices, of all edges with side and rims, and of rims, feet and apex."""
        assert isinstance(first, Frustum)
        assert isinstance(second, SweptPolytope)
        _check_number(len(second.core.edges))
        edges, faces = _of_edges(first, second), _of_faces(first, second)
        if first.frustum[SWEEP] == 0.0 and second.sweep == 0.0:
            return tuple(itertools.chain(faces, _of_sharp_vertices(first, second), edges))
        return tuple(itertools.chain(_of_vertices(first, second), edges, faces, _of_apex(first, second)))


def _check_number(edges: int) -> None:
    """Raise InvalidInput if there are too many contacts: an edge has one with the side and four with halves of rims."""
    if 5 * edges > MOST_CONTACTS:
        raise InvalidInput(
            "contact of a polyhedron with a round body",
            f"must have at most {MOST_CONTACTS} pairs of features",
            f"{edges} edges make {5 * edges}",
            "Take a polyhedron with fewer edges, or a smooth shape.",
        )


def _of_faces(first: Frustum, second: SweptPolytope) -> Iterator[FeaturePair]:
    """Yield the contacts of all rims, feet and a sharp apex with the faces; a segment has no faces, and no contacts."""
    numbers, n_faces = seen_by(first, second.core), len(second.core.planes)
    values: dict[str, Value] = {"frustum": numbers, "sweep": second.sweep, **_core_of(first, second)}
    for radius, center, name in rims_and_tips(first, second.sweep + numbers[SWEEP] == 0.0) if n_faces else ():
        names = tuple(f"{name} and face {i}" for i in range(n_faces))
        yield FeaturePair(evaluate_rim_over_faces, {**values, "radius": radius, "center": center}, names)


def _of_edges(first: Frustum, second: SweptPolytope) -> Iterator[FeaturePair]:
    """Yield the contacts of each edge with the side, which a disc does not have, and with both halves of each rim."""
    numbers, edges = seen_by(first, second.core), range(len(second.core.edges))
    values: dict[str, Value] = {"frustum": numbers, "radius": second.sweep, **_core_of(first, second)}
    for i in edges if numbers[SIDE] > 0.0 else ():
        yield FeaturePair(evaluate_edge_across_side, {**values, "edge": float(i)}, (f"side and edge {i}",))
    for i, rim, half in itertools.product(edges, rims_of(numbers), (1.0, -1.0)):
        of_rim = {**values, "edge": float(i), "rim": float(rim), "half": half}
        names = (f"{RIM_NAMES[rim]} and edge {i}",)
        yield FeaturePair(evaluate_edge_across_rim, of_rim, names)


def _core_of(first: Frustum, second: SweptPolytope) -> dict[str, Value]:
    """Return the core of the second body, and the size of the larger body, by the parameter names of the evaluators."""
    return {"core": core_numbers(second.core), "size": size_of_both(first, second)}


def _of_sharp_vertices(first: Frustum, second: SweptPolytope) -> Iterator[FeaturePair]:
    """Yield the contacts of all vertices of a sharp polyhedron with the caps and the side of a sharp frustum.

    Rims have names only so that the numbers of the features agree with those of the parts.
    """
    numbers = seen_by(first, second.core)
    values: dict[str, Value] = {"frustum": numbers, **_core_of(first, second)}
    for i in range(len(second.core.vertices)):
        names = tuple(f"{part} and vertex {i}" for part in part_names(numbers))
        of_vertex = {**values, "vertex": float(i), "lengths": star_lengths(second.core, i)}
        yield FeaturePair(evaluate_vertex_over_frustum, of_vertex, names)


def _of_vertices(first: Frustum, second: SweptPolytope) -> Iterator[FeaturePair]:
    """Yield the contacts of all vertices of a core as spheres or points."""
    core, numbers, size = second.core, seen_by(first, second.core), size_of_both(first, second)
    for i, place in enumerate(core.vertices):
        yield rounded_vertex(numbers, second.sweep, place, star_of(core, i), size, f"vertex {i}")


def rounded_vertex(
    numbers: tuple[float, ...], radius: float, place: tuple[float, ...], star: tuple[float, ...], size: float, name: str
) -> FeaturePair:
    """Return the contact of a vertex with a frustum.

    ``numbers`` are those of the frustum, ``place`` is the vertex [m] and ``radius`` its radius [m]; ``star`` holds the
    unit vectors along its edges.  ``size`` is the size of the bodies [m].
    """
    values: dict[str, Value] = {"first": numbers, "radius": radius, "place": place, "star": star, "size": size}
    names = tuple(f"{part} and {name}" for part in part_names(numbers))
    return FeaturePair(evaluate_rounded_vertex, {**values, "n_star": float(len(star) // 3)}, names)


def _of_apex(first: Frustum, second: SweptPolytope) -> Iterator[FeaturePair]:
    """Yield the contact of a cone's apex with the nearest face or edge; a vertex has a contact of its own.

    Vertices have names only so that the numbers of the features agree with the tables.
    """
    numbers = first.frustum
    if numbers[SIDE] > 0.0 and numbers[HIGH_RADIUS] == 0.0:
        core, values = second.core, _core_of(first, second)
        counts = ("face", len(core.planes)), ("edge", len(core.edges)), ("vertex", len(core.vertices))
        names = tuple(f"apex and {kind} {i}" for kind, n in counts for i in range(n))
        yield FeaturePair(evaluate_apex_over_core, {"first": numbers, "sweep": second.sweep, **values}, names)
