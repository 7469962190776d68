"""An ellipsoid over a plane, in closed form."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from nonsmooth.engine.memory.blocks import ROTATION, SIDE_B
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import parameter
from nonsmooth.types import Floats

from ...shapes.ellipsoid import Ellipsoid
from ...shapes.ground import Ground
from ..features.frames import point_in_world, turned_by, vector_in_body
from .plane_point import place_over_plane


def _evaluate(
    a: Floats,
    b: Floats,
    out: Floats,
    semi_x: float,
    semi_y: float,
    semi_z: float,
    x: float,
    y: float,
    z: float,
    orientation_w: float,
    orientation_x: float,
    orientation_y: float,
    orientation_z: float,
    height: float,
) -> None:
    # the outward normal of the ellipsoid at the point sought, in its own axes, and the plane's tangents there
    inverse_x, inverse_y, inverse_z = -orientation_x, -orientation_y, -orientation_z
    nx, ny, nz = vector_in_body(b, (-a[ROTATION + 2], -a[ROTATION + 5], -a[ROTATION + 8]))
    nx, ny, nz = turned_by(orientation_w, inverse_x, inverse_y, inverse_z, nx, ny, nz)
    sx, sy, sz = vector_in_body(b, (a[ROTATION], a[ROTATION + 3], a[ROTATION + 6]))
    sx, sy, sz = turned_by(orientation_w, inverse_x, inverse_y, inverse_z, sx, sy, sz)
    tx, ty, tz = sy * nz - sz * ny, sz * nx - sx * nz, sx * ny - sy * nx
    # support function h and its derivative, the point
    ax, ay, az = semi_x * semi_x, semi_y * semi_y, semi_z * semi_z
    reach = math.sqrt(ax * nx * nx + ay * ny * ny + az * nz * nz)
    px, py, pz = ax * nx / reach, ay * ny / reach, az * nz / reach
    low_x, low_y, low_z = turned_by(orientation_w, orientation_x, orientation_y, orientation_z, px, py, pz)
    low_x, low_y, low_z = point_in_world(b, (x + low_x, y + low_y, z + low_z))
    place_over_plane(a, out, low_x, low_y, low_z, height)
    # slide 1, turn the second derivative of h in the tangent plane: the inverse of the shape operator
    ps, pt = px * sx + py * sy + pz * sz, px * tx + py * ty + pz * tz
    out[SIDE_B] = out[SIDE_B + 3] = 1.0
    out[SIDE_B + 4] = (ax * sx * sx + ay * sy * sy + az * sz * sz - ps * ps) / reach
    out[SIDE_B + 5] = out[SIDE_B + 6] = (ax * sx * tx + ay * sy * ty + az * sz * tz - ps * pt) / reach
    out[SIDE_B + 7] = (ax * tx * tx + ay * ty * ty + az * tz * tz - pt * pt) / reach


@final
@dataclass(frozen=True)
class PlaneEllipsoid(ContactKinematics):
    """The point of an ellipsoid that a plane supports."""

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Ground, Ellipsoid)

    semi_x: float = parameter(doc="first semi-axis", unit="m", above=0.0)
    semi_y: float = parameter(doc="second semi-axis", unit="m", above=0.0)
    semi_z: float = parameter(doc="third semi-axis", unit="m", above=0.0)
    x: float = parameter(doc="centre in its body frame, first coordinate", unit="m")
    y: float = parameter(doc="centre in its body frame, second coordinate", unit="m")
    z: float = parameter(doc="centre in its body frame, third coordinate", unit="m")
    orientation_w: float = parameter(doc="quaternion from its axes to its body's, scalar part")
    orientation_x: float = parameter(doc="quaternion, first component")
    orientation_y: float = parameter(doc="quaternion, second component")
    orientation_z: float = parameter(doc="quaternion, third component")
    height: float = parameter(doc="height of the plane in its body frame", unit="m")

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[PlaneEllipsoid, ...]:
        """Return the single contact of a plane and an ellipsoid."""
        return (cls(**second.parameters(), **first.parameters()),)

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return _evaluate

    @property
    def features(self) -> tuple[str, ...]:
        """Name of the only pair of features."""
        return ("plane-ellipsoid",)
