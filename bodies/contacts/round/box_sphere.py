"""A sphere against a box, sharp or rounded, in closed form."""

from __future__ import annotations

import itertools
from typing import ClassVar, final

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import FEATURE, NORMAL, SIDE_A, SIDE_B
from nonsmooth.interfaces import ContactKinematics, FeaturePair, Shape
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...shapes.box import Box
from ...shapes.sphere import Sphere
from ...vectors import Vector3, divided, minus, norm, vector_at, write_vector
from ..features.frames import point_in_body, point_in_world, turned_by, vector_in_world
from ..features.writing import place_sphere, write_flat, write_principal, write_round

_KINDS = "inside", "face", "edge", "vertex"
_FEATURES = tuple(
    f"{_KINDS[sum(s != 0 for s in sides)]} "
    + "".join(("-", "", "+")[s + 1] + axis for s, axis in zip(sides, "xyz", strict=True) if s != 0)
    + " and sphere"
    for sides in itertools.product((-1, 0, 1), repeat=3)
    if any(sides)
)
"""Names of the 26 features, by their sides along the axes of the box: -1, 0 or 1."""


@compiled
def _side(coordinate: float, half: float) -> int:
    """Return the side of a box on which a coordinate is past its half-length: 1, -1, or 0 if it is within [m]."""
    if coordinate > half:
        return 1
    return -1 if coordinate < -half else 0


@compiled
def _past_side(coordinate: float, side: int, half: float) -> float:
    """Return the signed distance of a coordinate past a side of a box [m], 0 for the side 0."""
    return coordinate - side * half if side != 0 else 0.0


@compiled
def _in_body(quaternion: Floats, v: Vector3) -> Vector3:
    """Return the components of a vector along the axes of the body, from those along the axes of the box."""
    return turned_by(quaternion[0], quaternion[1], quaternion[2], quaternion[3], v[0], v[1], v[2])


@compiled
def _nearest_feature(half: Vector3, p: Vector3) -> tuple[tuple[int, int, int], float, Vector3]:
    """Return the sides of the feature of a box that is nearest to a point, the distance [m] and the unit normal.

    Sides are 1 or -1 along the axes on which the feature lies, else 0.  All vectors are in the axes of the box.
    """
    x, y, z = _side(p[0], half[0]), _side(p[1], half[1]), _side(p[2], half[2])
    if x == 0 and y == 0 and z == 0:
        # a point inside belongs to the nearest face
        deep_x, deep_y, deep_z = half[0] - abs(p[0]), half[1] - abs(p[1]), half[2] - abs(p[2])
        least = min(deep_x, deep_y, deep_z)
        if least == deep_x:
            x = 1 if p[0] >= 0.0 else -1
        elif least == deep_y:
            y = 1 if p[1] >= 0.0 else -1
        else:
            z = 1 if p[2] >= 0.0 else -1
        return (x, y, z), -least, (float(x), float(y), float(z))
    d = _past_side(p[0], x, half[0]), _past_side(p[1], y, half[1]), _past_side(p[2], z, half[2])
    distance = norm(d)
    return (x, y, z), distance, divided(d, distance)


def evaluate_box_sphere(
    a: Floats,
    b: Floats,
    out: Floats,
    half: Floats,
    center_a: Floats,
    orientation: Floats,
    rounding: float,
    radius: float,
    center_b: Floats,
) -> None:
    """Write the geometry block of a box and a sphere.

    Parameters
    ----------
    a, b, out : Floats
        Frame blocks of the bodies, and the geometry block.
    half, center_a, orientation, rounding : Floats, float
        Half-lengths of the box without its rounding [m], centre in its body frame [m], quaternion from its axes to
        those of its body, and radius of the rounding [m].
    radius, center_b : float, Floats
        Radius of the sphere [m], and its centre in its body frame [m].
    """
    w, x, y, z = orientation[0], orientation[1], orientation[2], orientation[3]
    center = point_in_world(b, vector_at(center_b, 0))
    p = minus(point_in_body(a, center), vector_at(center_a, 0))
    sides, distance, n = _nearest_feature(vector_at(half, 0), turned_by(w, -x, -y, -z, p[0], p[1], p[2]))
    write_vector(out, NORMAL, vector_in_world(a, _in_body(orientation, n)))
    place_sphere(a, out, (center[0], center[1], center[2]), distance - rounding, radius)
    on_x, on_y, on_z = abs(sides[0]), abs(sides[1]), abs(sides[2])
    if on_x + on_y + on_z == 1:
        write_flat(out, SIDE_A)
    elif on_x + on_y + on_z == 3:
        write_round(out, SIDE_A, rounding)
    else:
        # an edge lies along the axis that it does not bound
        x, y, z = vector_in_world(a, _in_body(orientation, (1.0 - on_x, 1.0 - on_y, 1.0 - on_z)))
        write_principal(out, SIDE_A, (x, y, z), 0.0, 1.0, 1.0, rounding)
    write_round(out, SIDE_B, radius)
    feature = 9 * (sides[0] + 1) + 3 * (sides[1] + 1) + sides[2] + 1
    # 13 is the number of the inside, which is no feature
    out[FEATURE] = feature - 1 if feature > 13 else feature


@final
class BoxSphere(ContactKinematics):
    """A box and a sphere: one contact, of the nearest face, edge or vertex of the box."""

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Box, Sphere)

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FeaturePair, ...]:
        """Return the single contact; its features are 26 faces, edges and vertices, by the axes that they lie on."""
        assert isinstance(first, Box)
        assert isinstance(second, Sphere)
        numbers = tuple(first.numbers().values())
        values: dict[str, Value] = {
            "half": first.core_sizes,
            "center_a": numbers[3:6],
            "orientation": numbers[6:10],
            "rounding": first.rounding,
            "radius": second.radius,
            "center_b": (second.x, second.y, second.z),
        }
        return (FeaturePair(evaluate_box_sphere, values, _FEATURES),)
