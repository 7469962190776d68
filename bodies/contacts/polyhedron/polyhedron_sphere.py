"""A sphere against a polyhedron, sharp or rounded, in closed form."""

from __future__ import annotations

from typing import final

from nonsmooth.engine.memory.blocks import FEATURE, GAP, NORMAL, POINT_A, POINT_B, SIDE_A, SIDE_B
from nonsmooth.interfaces import ContactKinematics, FeaturePair, Shape
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...shapes.polyhedron import Polyhedron
from ...shapes.polytope import Point
from ...shapes.sphere import Sphere
from ...vectors import minus, scaled, vector_at, write_vector
from ..features.frames import point_in_body, point_in_world, vector_in_world, write_tangent
from ..features.polytope_tables import N_FACES, SWEEP, core_numbers, edges_of, part_names
from ..features.swept_vertex import write_swept
from ..features.vertex_face import nearest_of_core
from ..features.writing import write_round


def evaluate_ball_over_polyhedron(
    a: Floats, b: Floats, out: Floats, core: Floats, radius: float, place: Floats
) -> None:
    """Write the geometry block of a ball of the second body and a core of the first, sharp or rounded.

    ``radius`` and ``place`` are the radius of the ball [m] and its centre in its body frame [m].
    """
    center = point_in_world(b, vector_at(place, 0))
    feature, distance, x, y, z, _ = nearest_of_core(core, point_in_body(a, center))
    n = vector_in_world(a, (x, y, z))
    height = distance - core[SWEEP]
    out[GAP], out[FEATURE] = height - radius, feature
    write_vector(out, NORMAL, n)
    write_vector(out, POINT_A, minus(center, scaled(height, n)))
    write_vector(out, POINT_B, minus(center, scaled(radius, n)))
    write_tangent(a, out)
    write_swept(a, out, SIDE_A, feature, core[N_FACES], *edges_of(core), core[SWEEP])
    write_round(out, SIDE_B, radius)


def ball_over_polyhedron(first: Polyhedron, center: Point, radius: float) -> FeaturePair:
    """Return the contact of a polyhedron with a ball, or a point, of another body [m]."""
    values: dict[str, Value] = {"core": core_numbers(first.core, first.rounding), "radius": radius, "place": center}
    names = tuple(f"{part} and sphere" for part in part_names(first.core))
    return FeaturePair(evaluate_ball_over_polyhedron, values, names)


@final
class PolyhedronSphere(ContactKinematics):
    """One contact of a sphere with the nearest face, edge or vertex of a polyhedron."""

    pair = Polyhedron, Sphere

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FeaturePair, ...]:
        """Return the single contact of a polyhedron and a sphere."""
        assert isinstance(first, Polyhedron)
        assert isinstance(second, Sphere)
        return (ball_over_polyhedron(first, (second.x, second.y, second.z), second.radius),)
