"""PlanarBody: moves in a plane, as in drawings."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar, final

import numpy as np

from nonsmooth.engine.memory.blocks import JACOBIAN, POSITION, ROTATION, SPIN, VELOCITY
from nonsmooth.interfaces import Body, Shape
from nonsmooth.interfaces.body import Vector
from nonsmooth.parameters import parameter
from nonsmooth.types import Floats

from .blocks import places_behind_frame
from .values import Word, keep_carried, read_start
from .vectors import vector_at, write_vector

_WORDS: dict[str, Word] = {
    "position": (2, (0.0, 0.0), "m"),
    "angle": (0, 0.0, "rad"),
    "velocity": (2, (0.0, 0.0), "m/s"),
    "angular_velocity": (0, 0.0, "rad/s"),
}
_RATES, _FORCE, _INVERSE, _ENERGY = places_behind_frame(n_q=3, n_u=3)
"""Indices of coordinate rates, force, inverse mass matrix and energies in the output block, in this order."""


def _evaluate(
    t: float,
    q: Floats,
    u: Floats,
    out: Floats,
    mass: float,
    moment: float,
    y: float,
    gravity_x: float,
    gravity_y: float,
    gravity_z: float,
) -> None:
    c, s = math.cos(q[2]), math.sin(q[2])
    write_vector(out, POSITION, (q[0], y, q[1]))
    out[ROTATION], out[ROTATION + 2] = c, s
    out[ROTATION + 4] = 1.0
    out[ROTATION + 6], out[ROTATION + 8] = -s, c
    out[VELOCITY], out[VELOCITY + 2], out[SPIN + 1] = vector_at(u, 0)
    # Jacobian: x, z and the turn about y
    out[JACOBIAN] = out[JACOBIAN + 7] = out[JACOBIAN + 14] = 1.0
    for i in range(3):
        out[_RATES + i] = u[i]
    out[_FORCE], out[_FORCE + 1] = mass * gravity_x, mass * gravity_z
    out[_INVERSE] = out[_INVERSE + 4] = 1.0 / mass
    out[_INVERSE + 8] = 1.0 / moment
    out[_ENERGY] = 0.5 * (mass * (u[0] * u[0] + u[1] * u[1]) + moment * u[2] * u[2])
    out[_ENERGY + 1] = -mass * (gravity_x * q[0] + gravity_y * y + gravity_z * q[1])


@final
@dataclass(frozen=True)
class PlanarBody(Body):
    """A rigid body that moves in the plane of x and z and turns about y.

    Coordinates: x and z of the mass centre [m], angle about the y axis [rad], which at a small positive angle points
    the first body axis downwards.  Velocities: their rates.

    Attributes
    ----------
    mass : float
        Mass [kg].
    moment : float
        Moment of inertia about the y axis through the mass centre [kg m^2].
    carried : tuple of Shape
        Its shapes, in axes with the origin at the mass centre.
    y : float
        Where its plane is [m].
    """

    mass: float = parameter(doc="mass", unit="kg", above=0.0)
    moment: float = parameter(
        doc="moment of inertia about the y axis, of a point mass 1e-8 m l^2 with a length l of the system",
        unit="kg m^2",
        above=0.0,
    )
    carried: tuple[Shape, ...] = ()
    y: float = parameter(0.0, doc="second coordinate of its plane", unit="m")
    q_labels = ("x", "m"), ("z", "m"), ("angle", "rad")
    u_labels = ("vx", "m/s"), ("vz", "m/s"), ("w", "rad/s")
    evaluator: ClassVar[Callable[..., None]] = staticmethod(_evaluate)

    def _check(self) -> None:
        keep_carried(self)

    @property
    def frames(self) -> tuple[tuple[Shape, ...], ...]:
        """One frame with the shapes as given."""
        return (self.carried,)

    @property
    def length_scale(self) -> float:
        """Length scale of the body [m]: the larger of its radius of gyration and the length of its longest shape."""
        return max([math.sqrt(self.moment / self.mass), *(shape.length for shape in self.carried)])

    def state(self, **start: Any) -> tuple[Vector, Vector]:
        """Return q and u from position (x, z) [m], angle [rad], velocity [m/s], angular_velocity [rad/s]."""
        values = read_start("PlanarBody", _WORDS, start)
        q = np.append(values["position"], values["angle"])
        return q, np.append(values["velocity"], values["angular_velocity"])
