"""Bodies with one fault each: free ones of unit mass and moments, and driven ones."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from bodies import Sphere
from nonsmooth import InvalidInput
from nonsmooth.interfaces import Body, Look, Shape
from nonsmooth.interfaces.body import POSE_LABELS, TWIST_LABELS, NamesAndUnits, Vector
from nonsmooth.types import Floats

FAULTS = {
    "finite numbers": 1.0,
    "writes its block": 2.0,
    "rotation": 3.0,
    "velocity": 4.0,
    "acceleration": 5.0,
    "jacobian": 6.0,
    "mass matrix": 7.0,
    "kinetic energy": 8.0,
    "energy in free flight": 9.0,
    "free flight": 10.0,
    "unit quaternion": 11.0,
    "momentum": 12.0,
}
"""Faults of the equations, by the property made for them."""
BEYOND, INDEFINITE = 20.0, 21.0


def free(
    t: float, q: Floats, u: Floats, out: Floats, fault: float, gravity_x: float, gravity_y: float, gravity_z: float
) -> None:
    """Write the block of a ball of unit mass and moments, with world axes for the angular velocity."""
    a, b, c, d = q[3], q[4], q[5], q[6]
    out[3], out[4], out[5] = a * a + b * b - c * c - d * d, 2.0 * (b * c - a * d), 2.0 * (b * d + a * c)
    out[6], out[7], out[8] = 2.0 * (b * c + a * d), a * a - b * b + c * c - d * d, 2.0 * (c * d - a * b)
    out[9], out[10], out[11] = 2.0 * (b * d - a * c), 2.0 * (c * d + a * b), a * a - b * b - c * c + d * d
    for i in range(3):
        out[i] = q[i]
        out[12 + i], out[15 + i] = u[i], u[3 + i]
        out[60 + i] = u[i]
    for i in range(6):
        out[24 + 7 * i] = 1.0
        out[73 + 7 * i] = 1.0
    x, y, z = u[3], u[4], u[5]
    out[63] = 0.5 * (-b * x - c * y - d * z)
    out[64] = 0.5 * (a * x + d * y - c * z)
    out[65] = 0.5 * (a * y + b * z - d * x)
    out[66] = 0.5 * (a * z + c * x - b * y)
    out[67], out[68], out[69] = gravity_x, gravity_y, gravity_z
    out[109] = 0.5 * (u[0] ** 2 + u[1] ** 2 + u[2] ** 2 + x * x + y * y + z * z)
    out[110] = -(gravity_x * q[0] + gravity_y * q[1] + gravity_z * q[2])
    if fault == 1.0:
        out[110] = math.nan
    if fault == 2.0 and u[3] != 0.0:
        out[70] = 1e-9 * u[3]
    if fault == 3.0:
        out[3] = -out[3]
        out[6] = -out[6]
        out[9] = -out[9]
    if fault == 4.0:
        out[12] = 1.01 * u[0]
        out[24] = 1.01
    if fault == 5.0:
        out[18] = 0.1 * u[1]
    if fault == 6.0:
        out[25] = 0.1
    if fault == 7.0:
        out[74] = 0.1
    if fault == 8.0:
        out[109] = 1.1 * out[109]
    if fault == 9.0:
        out[110] = -out[110]
    if fault == 10.0:
        out[67] = out[67] - 0.1 * u[0]
    if fault == 11.0:
        out[63] = out[63] + 0.1 * a
    if fault == 12.0:
        out[67], out[68] = out[67] + u[1], out[68] - u[0]
    if fault == 20.0:
        out[111] = 0.0
    if fault == 21.0:
        out[73] = -1.0


def fly(
    t: float, q: Floats, u: Floats, out: Floats, slip: float, gravity_x: float, gravity_y: float, gravity_z: float
) -> None:
    """Write where that ball flies to, with a fault of its own."""
    for i in range(6):
        out[7 + i] = u[i]
    out[7], out[8], out[9] = u[0] + t * gravity_x, u[1] + t * gravity_y, u[2] + t * gravity_z
    out[0] = q[0] + 0.5 * t * (u[0] + out[7])
    out[1] = q[1] + 0.5 * t * (u[1] + out[8])
    out[2] = q[2] + 0.5 * t * (u[2] + out[9])
    x, y, z = 0.5 * t * u[3], 0.5 * t * u[4], 0.5 * t * u[5]
    angle = math.sqrt(x * x + y * y + z * z)
    k, s = math.cos(angle), math.sin(angle) / angle if angle > 0.0 else 1.0
    x, y, z = s * x, s * y, s * z
    a, b, c, d = q[3], q[4], q[5], q[6]
    out[3] = k * a - x * b - y * c - z * d
    out[4] = k * b + x * a + y * d - z * c
    out[5] = k * c + y * a + z * b - x * d
    out[6] = k * d + z * a + x * c - y * b
    if slip == 1.0:
        out[2] = out[2] + 0.01 * t * gravity_z
    if slip == 2.0:
        out[12] = out[12] + 0.01
    if slip == 3.0:
        out[13] = 0.0


def driven(t: float, q: Floats, u: Floats, out: Floats, fault: float) -> None:
    """Write the frame of a body that swings along x."""
    out[0] = math.sin(t)
    out[3] = out[7] = out[11] = 1.0
    out[12] = 1.1 * math.cos(t) if fault == FAULT_OF_SPEED else math.cos(t)
    out[18] = math.sin(t) if fault == FAULT_OF_ACCELERATION else -math.sin(t)


FAULT_OF_SPEED, FAULT_OF_ACCELERATION = 4.0, 5.0


@dataclass(frozen=True)
class Ball(Body):
    """A free body with a fault in its equations, 0 without."""

    fault: float = 0.0

    def parameters(self) -> Mapping[str, Any]:
        return {"fault": self.fault}

    @property
    def frames(self) -> tuple[tuple[Shape, ...], ...]:
        return ((Sphere(0.5),),)

    @property
    def q_labels(self) -> NamesAndUnits:
        return POSE_LABELS

    @property
    def u_labels(self) -> NamesAndUnits:
        return TWIST_LABELS

    @property
    def quaternion(self) -> int:
        return 3

    @property
    def evaluator(self) -> Callable[..., None]:
        return free

    @property
    def scales(self) -> tuple[Vector, Vector]:
        return np.ones(7), np.ones(6)

    @property
    def time_scale(self) -> float:
        return math.inf

    def state(self, **start: Any) -> tuple[Vector, Vector]:
        if start:
            raise InvalidInput("start", "must be empty", start, "")
        return np.array([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]), np.zeros(6)


@dataclass(frozen=True)
class Flying(Ball):
    """One that knows where it flies, wrongly so with a slip."""

    slip: float = 0.0

    def parameters(self) -> Mapping[str, Any]:
        return {"fault": self.fault, "slip": self.slip}

    @property
    def flight(self) -> Callable[..., None]:
        return fly


@dataclass(frozen=True)
class Lenient(Ball):
    """One that takes any word for its start."""

    def state(self, **start: Any) -> tuple[Vector, Vector]:
        return super().state()


@dataclass(frozen=True)
class Sizeless(Ball):
    """One with scales of another size."""

    @property
    def scales(self) -> tuple[Vector, Vector]:
        return np.ones(7), np.array([1.0, 1.0, 1.0, 1.0, 1.0, 0.0])


@dataclass(frozen=True)
class Crossed(Ball):
    """One whose sketch has lines between vertices that are not there."""

    @property
    def sketch(self) -> tuple[Look, ...]:
        return (Look(np.zeros((1, 3)), lines=np.array([[0, 1]])),)


@dataclass(frozen=True)
class Growing(Ball):
    """One that has the more lines the farther it is."""

    def strokes(self, q: Vector) -> Vector:
        return np.zeros((1 if q[0] > 0.0 else 2, 2, 3))


@dataclass(frozen=True)
class Swing(Ball):
    """A driven body."""

    @property
    def q_labels(self) -> NamesAndUnits:
        return ()

    @property
    def u_labels(self) -> NamesAndUnits:
        return ()

    @property
    def quaternion(self) -> int:
        return -1

    @property
    def evaluator(self) -> Callable[..., None]:
        return driven

    @property
    def scales(self) -> tuple[Vector, Vector]:
        return np.zeros(0), np.zeros(0)

    @property
    def time_scale(self) -> float:
        return 1.0

    def state(self, **start: Any) -> tuple[Vector, Vector]:
        if start:
            raise InvalidInput("start", "must be empty", start, "")
        return np.zeros(0), np.zeros(0)


DUMMIES: list[tuple[str, Body]] = [
    *((name, Ball(fault)) for name, fault in FAULTS.items()),
    ("writes its block", Ball(BEYOND)),
    ("mass matrix", Ball(INDEFINITE)),
    ("flight", Flying(slip=1.0)),
    ("flight", Flying(slip=2.0)),
    ("writes its block", Flying(slip=3.0)),
    ("start", Lenient()),
    ("start", Sizeless()),
    ("sketch", Crossed()),
    ("sketch", Growing()),
    ("velocity", Swing(FAULT_OF_SPEED)),
    ("acceleration", Swing(FAULT_OF_ACCELERATION)),
]
