"""A rigid body in the x-z plane as plain functions: coordinates x, z and the angle from x to z."""

from __future__ import annotations

import math
from typing import Any

from bodies import Coordinate, GeneralisedBody
from nonsmooth.types import Floats


def rigid_mass(q: Floats, out: Floats, weight: float, inertia: float) -> None:
    out[0] = out[4] = weight
    out[8] = inertia


def weight_force(t: float, q: Floats, u: Floats, out: Floats, weight: float, gravity_z: float) -> None:
    out[1] = weight * gravity_z


def weight_potential(q: Floats, weight: float, gravity_z: float) -> float:
    return -weight * gravity_z * q[1]


def part_pose(q: Floats, out: Floats) -> None:
    out[0], out[2] = q[0], q[1]
    c, s = math.cos(q[2]), math.sin(q[2])
    out[3], out[5], out[7], out[9], out[11] = c, -s, 1.0, s, c


def part_jacobian(q: Floats, out: Floats) -> None:
    out[0] = out[7] = 1.0
    out[14] = -1.0


def end_position(q: Floats, out: Floats, half: float) -> None:
    out[0], out[2] = q[0] + half * math.cos(q[2]), q[1] + half * math.sin(q[2])


def end_jacobian(q: Floats, out: Floats, half: float) -> None:
    out[0] = out[7] = 1.0
    out[2], out[8] = -half * math.sin(q[2]), half * math.cos(q[2])


def end_bias(q: Floats, u: Floats, out: Floats, half: float) -> None:
    out[0], out[2] = -half * math.cos(q[2]) * u[2] ** 2, -half * math.sin(q[2]) * u[2] ** 2


def no_bias(q: Floats, u: Floats, out: Floats) -> None:
    pass


def _coordinate(name: str, start: float, rate: float) -> Coordinate:
    return Coordinate(name, "rad" if name == "a" else "m", start, rate)


def planar(
    frames: Any, weight: float, inertia: float, q: Any = (0, 0, 0), u: Any = (0, 0, 0), **more: Any
) -> GeneralisedBody:
    coordinates = tuple(_coordinate(n, float(a), float(b)) for n, a, b in zip("xza", q, u, strict=True))
    constants = {"weight": weight, "inertia": inertia, **more}
    return GeneralisedBody(coordinates, rigid_mass, weight_force, weight_potential, tuple(frames), constants)


def gyroscopic(t: float, q: Floats, u: Floats, out: Floats, weight: float, gravity_z: float) -> None:
    out[0], out[1] = u[1], weight * gravity_z - u[0]


def no_power(t: float, q: Floats, u: Floats) -> float:
    return 0.0


END: dict[str, Any] = {"pose": end_position, "jacobian": end_jacobian, "bias": end_bias}
PART: dict[str, Any] = {"pose": part_pose, "jacobian": part_jacobian, "bias": no_bias}
