"""A sphere against a box, sharp or rounded, in closed form."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import FEATURE, NORMAL, SIDE_A, SIDE_B
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import parameter
from nonsmooth.types import Floats

from ...shapes.box import Box
from ...shapes.sphere import Sphere
from ...vectors import put
from ..features.frames import point_in_body, point_in_world, turned_by, vector_in_world
from ..features.writing import by_side, place_sphere, write_flat, write_principal, write_round

_KINDS = "inside", "face", "edge", "vertex"
_FEATURES = tuple(
    f"{_KINDS[sum(s != 0 for s in sides)]} "
    + "".join(("-", "", "+")[s + 1] + axis for s, axis in zip(sides, "xyz", strict=True) if s != 0)
    + " and sphere"
    for sides in itertools.product((-1, 0, 1), repeat=3)
    if any(sides)
)


@compiled
def _side(coordinate: float, half: float) -> int:
    if coordinate > half:
        return 1
    return -1 if coordinate < -half else 0


def _evaluate(
    a: Floats,
    b: Floats,
    out: Floats,
    half_x_a: float,
    half_y_a: float,
    half_z_a: float,
    x_a: float,
    y_a: float,
    z_a: float,
    orientation_w_a: float,
    orientation_x_a: float,
    orientation_y_a: float,
    orientation_z_a: float,
    rounding_a: float,
    radius_b: float,
    x_b: float,
    y_b: float,
    z_b: float,
) -> None:
    # the sphere's centre in the axes of the box
    center_x, center_y, center_z = point_in_world(b, (x_b, y_b, z_b))
    x, y, z = point_in_body(a, (center_x, center_y, center_z))
    inverse_x, inverse_y, inverse_z = -orientation_x_a, -orientation_y_a, -orientation_z_a
    x, y, z = turned_by(orientation_w_a, inverse_x, inverse_y, inverse_z, x - x_a, y - y_a, z - z_a)
    side_x, side_y, side_z = _side(x, half_x_a), _side(y, half_y_a), _side(z, half_z_a)
    nx, ny, nz = 0.0, 0.0, 0.0
    if side_x == 0 and side_y == 0 and side_z == 0:
        # a centre inside leaves by the nearest face
        deep_x, deep_y, deep_z = half_x_a - abs(x), half_y_a - abs(y), half_z_a - abs(z)
        distance = -min(deep_x, deep_y, deep_z)
        if -distance == deep_x:
            side_x = 1 if x >= 0.0 else -1
        elif -distance == deep_y:
            side_y = 1 if y >= 0.0 else -1
        else:
            side_z = 1 if z >= 0.0 else -1
        nx, ny, nz = float(side_x), float(side_y), float(side_z)
    else:
        if side_x != 0:
            nx = x - side_x * half_x_a
        if side_y != 0:
            ny = y - side_y * half_y_a
        if side_z != 0:
            nz = z - side_z * half_z_a
        distance = math.sqrt(nx * nx + ny * ny + nz * nz)
        nx, ny, nz = nx / distance, ny / distance, nz / distance
    nx, ny, nz = turned_by(orientation_w_a, orientation_x_a, orientation_y_a, orientation_z_a, nx, ny, nz)
    put(out, NORMAL, vector_in_world(a, (nx, ny, nz)))
    place_sphere(a, out, center_x, center_y, center_z, distance - rounding_a, radius_b)
    sides = abs(side_x) + abs(side_y) + abs(side_z)
    if sides == 1:
        write_flat(out, SIDE_A)
    elif sides == 3:
        write_round(out, SIDE_A, rounding_a)
    else:
        # an edge lies along the axis that it does not bound
        ex, ey, ez = 1.0 - abs(side_x), 1.0 - abs(side_y), 1.0 - abs(side_z)
        ex, ey, ez = turned_by(orientation_w_a, orientation_x_a, orientation_y_a, orientation_z_a, ex, ey, ez)
        ex, ey, ez = vector_in_world(a, (ex, ey, ez))
        write_principal(out, SIDE_A, ex, ey, ez, 0.0, 1.0, 1.0, rounding_a)
    write_round(out, SIDE_B, radius_b)
    number = 9 * (side_x + 1) + 3 * (side_y + 1) + side_z + 1
    out[FEATURE] = number - 1 if number > 13 else number


@final
@dataclass(frozen=True)
class BoxSphere(ContactKinematics):
    """One contact of a sphere with the nearest face, edge or vertex of a box."""

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Box, Sphere)

    half_x_a: float = parameter(
        doc="half-length of the box without its rounding along its first axis", unit="m", above=0.0
    )
    half_y_a: float = parameter(doc="the same along its second axis", unit="m", above=0.0)
    half_z_a: float = parameter(doc="the same along its third axis", unit="m", above=0.0)
    x_a: float = parameter(doc="its centre in its body frame, first coordinate", unit="m")
    y_a: float = parameter(doc="its centre in its body frame, second coordinate", unit="m")
    z_a: float = parameter(doc="its centre in its body frame, third coordinate", unit="m")
    orientation_w_a: float = parameter(doc="quaternion from its axes to its body's, scalar part")
    orientation_x_a: float = parameter(doc="quaternion, first component")
    orientation_y_a: float = parameter(doc="quaternion, second component")
    orientation_z_a: float = parameter(doc="quaternion, third component")
    rounding_a: float = parameter(doc="its rounding", unit="m", minimum=0.0)
    radius_b: float = parameter(doc="radius of the sphere", unit="m", above=0.0)
    x_b: float = parameter(doc="its centre in its body frame, first coordinate", unit="m")
    y_b: float = parameter(doc="its centre in its body frame, second coordinate", unit="m")
    z_b: float = parameter(doc="its centre in its body frame, third coordinate", unit="m")

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[BoxSphere, ...]:
        """Return the single contact of a box and a sphere."""
        assert isinstance(first, Box)
        core = {f"half_{axis}_a": half for axis, half in zip("xyz", first.core_sizes, strict=True)}
        return (cls(**{**by_side(first, second), **core}),)

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return _evaluate

    @property
    def features(self) -> tuple[str, ...]:
        """The 26 faces, edges and vertices, each by the axes that it lies on."""
        return _FEATURES
