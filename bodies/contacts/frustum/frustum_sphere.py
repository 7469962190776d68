"""A sphere, or a rounded vertex, against a cylinder, a cone or a disc, in closed form."""

from __future__ import annotations

from typing import ClassVar, final

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import FEATURE, GAP, NORMAL, PAST_END, SIDE_A, SIDE_B
from nonsmooth.interfaces import ContactKinematics, FeaturePair, Shape
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...shapes.frustum import SWEEP, Frustum, without_feet
from ...shapes.sphere import Sphere
from ...vectors import Vector3, vector_at, write_vector
from ..features.edge_vertex import Vertex
from ..features.ends import ended_gap, past_vertex
from ..features.frames import point_in_world
from ..features.writing import place_sphere, write_round
from .frustum import HIGH_CAP, LOW_CAP, nearest_part, normal_of_part, part_number
from .frustum_features import part_names
from .frustum_placed import from_axis, placed
from .frustum_writing import Spot, write_spot


@compiled
def write_frustum_ball(
    a: Floats, b: Floats, out: Floats, first: Floats, radius: float, place: Vector3
) -> tuple[Vector3, float, int]:
    """Write the geometry block of a frustum and a ball about a point of the second body; return three results.

    ``place`` is the point in the frame of the second body [m], ``radius`` the radius of the ball [m].  The results are
    the point in the world [m], its signed distance from the frustum's core [m], and the nearest part, such as
    ``FLANK``.
    """
    frustum, point = placed(a, first), point_in_world(b, place)
    along, away, outward = from_axis(frustum, point)
    distance, radial, axial, part = nearest_part(first, along, away)
    normal = normal_of_part(frustum.axis, outward, radial, axial)
    write_vector(out, NORMAL, normal)
    out[FEATURE] = part_number(first, part)
    place_sphere(a, out, point, distance - first[SWEEP], radius)
    write_spot(out, SIDE_A, Spot(frustum, part, outward, away - distance * radial), normal)
    write_round(out, SIDE_B, radius)
    return point, distance, part


@compiled
def write_frustum_vertex(
    a: Floats,
    b: Floats,
    out: Floats,
    first: Floats,
    radius: float,
    vertex: Vertex,
    size: float,
) -> None:
    """Write the geometry block of a vertex, with a radius [m], and a frustum's nearest cap, rim, side or apex.

    The vertex is one of the second body.  ``size`` is the size of the bodies [m].
    """
    point, distance, part = write_frustum_ball(a, b, out, first, radius, vertex.place)
    # over a cap the contact does not end at the vertex: an edge over the cap touches with both ends, also if it tilts
    is_flat = part in (LOW_CAP, HIGH_CAP)
    past = past_vertex(b, vertex, 0.0 if is_flat else distance, vector_at(out, NORMAL), size)
    gap, out[PAST_END] = ended_gap(out[GAP], past, size)
    place_sphere(a, out, point, gap + radius, radius)


def evaluate_frustum_sphere(
    a: Floats, b: Floats, out: Floats, first: Floats, radius: float, x: float, y: float, z: float
) -> None:
    """Write the geometry block of a frustum and a sphere with the centre (x, y, z) [m] in the frame of its body."""
    write_frustum_ball(a, b, out, first, radius, (x, y, z))


@final
class FrustumSphere(ContactKinematics):
    """One contact of a sphere with a cap, a rim or the side of a cylinder, a cone or a disc; feet are ignored."""

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Frustum, Sphere)

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FeaturePair, ...]:
        """Return the single contact: each part of the frustum, from the lower cap upwards, with the sphere."""
        assert isinstance(first, Frustum)
        assert isinstance(second, Sphere)
        values: dict[str, Value] = {"first": without_feet(first.frustum), **second.parameters()}
        names = tuple(f"{part} and sphere" for part in part_names(first.frustum))
        return (FeaturePair(evaluate_frustum_sphere, values, names),)
