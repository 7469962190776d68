"""A cart with a pendulum as plain functions: coordinates x of the cart and the angle of the pendulum from below."""

from __future__ import annotations

import math
from typing import Any

from nonsmooth.types import Floats

from ..shapes.sphere import Sphere
from .coordinate import Coordinate
from .frames import PointFrame


def _mass(q: Floats, out: Floats, cart: float, bob: float, length: float) -> None:
    out[0] = cart + bob
    out[1] = out[2] = bob * length * math.cos(q[1])
    out[3] = bob * length * length


def _force(
    t: float,
    q: Floats,
    u: Floats,
    out: Floats,
    cart: float,
    bob: float,
    length: float,
    gravity_x: float,
    gravity_z: float,
) -> None:
    out[0] = (cart + bob) * gravity_x + bob * length * math.sin(q[1]) * u[1] * u[1]
    out[1] = bob * length * (gravity_x * math.cos(q[1]) + gravity_z * math.sin(q[1]))


def _potential(q: Floats, cart: float, bob: float, length: float, gravity_x: float, gravity_z: float) -> float:
    x, z = length * math.sin(q[1]), -length * math.cos(q[1])
    return -(cart + bob) * gravity_x * q[0] - bob * (gravity_x * x + gravity_z * z)


def _pose(q: Floats, out: Floats, length: float) -> None:
    out[0], out[2] = q[0] + length * math.sin(q[1]), -length * math.cos(q[1])


def _jacobian(q: Floats, out: Floats, length: float) -> None:
    out[0] = 1.0
    out[1], out[5] = length * math.cos(q[1]), length * math.sin(q[1])


def _bias(q: Floats, u: Floats, out: Floats, length: float) -> None:
    square = length * u[1] * u[1]
    out[0], out[2] = -square * math.sin(q[1]), square * math.cos(q[1])


def cart_pendulum() -> dict[str, Any]:
    """Return the parts of the body."""
    return {
        "coordinates": (Coordinate("x", "m"), Coordinate("angle", "rad", start=0.4)),
        "mass": _mass,
        "force": _force,
        "potential": _potential,
        "moving_frames": (PointFrame(_pose, _jacobian, _bias, (Sphere(0.05),)),),
        "constants": {"cart": 2.0, "bob": 0.5, "length": 0.7},
    }
