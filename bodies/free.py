"""Free rigid bodies: position and unit quaternion, velocity and body-fixed angular velocity."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Callable
from typing import Any

import numpy as np

from nonsmooth.errors import InvalidInput, UnknownName
from nonsmooth.interfaces import Body, Shape
from nonsmooth.interfaces.body import Vector
from nonsmooth.types import Floats

_WORDS = {
    "position": (3, (0.0, 0.0, 0.0), "m"),
    "orientation": (4, (1.0, 0.0, 0.0, 0.0), "1"),
    "velocity": (3, (0.0, 0.0, 0.0), "m/s"),
    "angular_velocity": (3, (0.0, 0.0, 0.0), "rad/s"),
}


def _evaluate(
    t: float,
    q: Floats,
    u: Floats,
    out: Floats,
    mass: float,
    inertia_x: float,
    inertia_y: float,
    inertia_z: float,
    gravity_x: float,
    gravity_y: float,
    gravity_z: float,
) -> None:
    a, b, c, d = q[3], q[4], q[5], q[6]
    ox, oy, oz = u[3], u[4], u[5]
    for i in range(3):
        out[i] = q[i]
        out[12 + i] = u[i]
    # homogeneous in the quaternion, so that its length does not matter between two normalisations
    out[3], out[4], out[5] = a * a + b * b - c * c - d * d, 2.0 * (b * c - a * d), 2.0 * (b * d + a * c)
    out[6], out[7], out[8] = 2.0 * (b * c + a * d), a * a - b * b + c * c - d * d, 2.0 * (c * d - a * b)
    out[9], out[10], out[11] = 2.0 * (b * d - a * c), 2.0 * (c * d + a * b), a * a - b * b - c * c + d * d
    for i in range(3):
        out[15 + i] = out[3 + 3 * i] * ox + out[4 + 3 * i] * oy + out[5 + 3 * i] * oz
        # Jacobian of (velocity, angular velocity): identity and rotation
        out[24 + 7 * i] = 1.0
        for j in range(3):
            out[24 + 18 + 6 * i + 3 + j] = out[3 + 3 * i + j]
    # coordinate rates: velocity and half the quaternion product q (0, omega)
    rates = 60
    for i in range(3):
        out[rates + i] = u[i]
    out[rates + 3] = 0.5 * (-b * ox - c * oy - d * oz)
    out[rates + 4] = 0.5 * (a * ox + c * oz - d * oy)
    out[rates + 5] = 0.5 * (a * oy + d * ox - b * oz)
    out[rates + 6] = 0.5 * (a * oz + b * oy - c * ox)
    # force and gyroscopic moment
    force = 67
    out[force], out[force + 1], out[force + 2] = mass * gravity_x, mass * gravity_y, mass * gravity_z
    out[force + 3] = (inertia_y - inertia_z) * oy * oz
    out[force + 4] = (inertia_z - inertia_x) * oz * ox
    out[force + 5] = (inertia_x - inertia_y) * ox * oy
    inverse = 73
    for i in range(3):
        out[inverse + 7 * i] = 1.0 / mass
    out[inverse + 21] = 1.0 / inertia_x
    out[inverse + 28] = 1.0 / inertia_y
    out[inverse + 35] = 1.0 / inertia_z
    energy = 109
    out[energy] = 0.5 * (
        mass * (u[0] * u[0] + u[1] * u[1] + u[2] * u[2])
        + inertia_x * ox * ox
        + inertia_y * oy * oy
        + inertia_z * oz * oz
    )
    out[energy + 1] = -mass * (gravity_x * q[0] + gravity_y * q[1] + gravity_z * q[2])


class FreeBody(Body):
    """A rigid body that moves freely; its frame is the principal frame at its mass centre.

    Subclasses are final and give ``total_mass`` [kg], ``inertia`` [kg m^2] (principal moments) and shapes.
    Coordinates: position of the mass centre [m], unit quaternion (scalar first) from body to world.
    Velocities: of the mass centre in world axes [m/s], angular velocity in body axes [rad/s].
    """

    @property
    @abstractmethod
    def total_mass(self) -> float:
        """Mass [kg]."""

    @property
    @abstractmethod
    def inertia(self) -> tuple[float, float, float]:
        """Principal moments of inertia [kg m^2]."""

    def parameters(self) -> dict[str, float]:
        """Return mass and principal moments."""
        x, y, z = self.inertia
        return {"mass": self.total_mass, "inertia_x": x, "inertia_y": y, "inertia_z": z}

    @property
    @abstractmethod
    def shapes(self) -> tuple[Shape, ...]:
        """The shapes that the body carries."""

    @property
    def frames(self) -> tuple[tuple[Shape, ...], ...]:
        """One frame with all shapes."""
        return (self.shapes,)

    @property
    def n_q(self) -> int:
        """Position and quaternion."""
        return 7

    @property
    def n_u(self) -> int:
        """Velocity and angular velocity."""
        return 6

    @property
    def quaternion(self) -> int:
        """Behind the position."""
        return 3

    @property
    def evaluator(self) -> Callable[..., None]:
        """Newton-Euler equations."""
        return _evaluate

    @property
    def time_scale(self) -> float:
        """Infinite [s]: nothing is prescribed."""
        return math.inf

    @property
    def scales(self) -> tuple[Vector, Vector]:
        """The length of the body and the speed of a fall through it."""
        length = max(shape.length for shape in self.shapes)
        speed = math.sqrt(9.81 * length)
        return np.array([length] * 3 + [1.0] * 4), np.array([speed] * 3 + [speed / length] * 3)

    def state(self, **start: Any) -> tuple[Vector, Vector]:
        """Return q and u from position [m], orientation (unit quaternion), velocity [m/s], angular_velocity [rad/s]."""
        name = type(self).__name__
        values = {}
        for word in start:
            if word not in _WORDS:
                raise UnknownName(f"start of {name}", word, _WORDS)
        for word, (size, default, unit) in _WORDS.items():
            value = np.asarray(start.get(word, default), dtype=float)
            if value.shape != (size,) or not np.all(np.isfinite(value)):
                raise InvalidInput(
                    f"{word} of {name}", f"must be {size} finite numbers", start.get(word), f"Give them in [{unit}]."
                )
            values[word] = value
        norm = float(np.linalg.norm(values["orientation"]))
        if abs(norm - 1.0) > 1e-9:
            raise InvalidInput(
                f"orientation of {name}",
                "must be a unit quaternion (scalar first)",
                values["orientation"].tolist(),
                f"Divide it by its length {norm:.6g}.",
            )
        q = np.concatenate([values["position"], values["orientation"] / norm])
        return q, np.concatenate([values["velocity"], values["angular_velocity"]])
