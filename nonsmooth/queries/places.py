"""Places (origin and axes) of the frames of bodies, from a pose that a user gives or from the body's coordinates."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, final

import numpy as np

from nonsmooth.binding.call import body_caller
from nonsmooth.engine.memory.blocks import FRAME
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Body
from nonsmooth.interfaces.distance_backend import Place
from nonsmooth.interfaces.solid import Vector
from nonsmooth.rotations import rotation
from nonsmooth.vectors import unit_vector, vector

HERE: Place = (np.zeros(3), np.eye(3))


def read_place(thing: str, pose: Any) -> Place:
    """Place (origin [m] and axes) from a position [m], or from a position and a unit quaternion (scalar first).

    Raises
    ------
    InvalidInput
        The pose has another form, a number is not finite, or the quaternion has no unit length.
    """
    try:
        parts = tuple(pose)
    except TypeError:
        parts = ()
    if len(parts) == 3 and all(np.ndim(part) == 0 for part in parts):
        parts = (parts, (1.0, 0.0, 0.0, 0.0))
    if len(parts) != 2:
        raise InvalidInput(
            thing,
            "must be a position, or a position and a unit quaternion (scalar first)",
            pose,
            "For example (0.0, 0.0, 0.1) or ((0.0, 0.0, 0.1), (1.0, 0.0, 0.0, 0.0)), in [m].",
        )
    place = np.array(vector(f"{thing}: position", parts[0], 3, "m"))
    return place, rotation(unit_vector(f"{thing}: quaternion", parts[1], 4))


@final
class BodyFrames:
    """The frames of a body as functions of its coordinates.

    Parameters
    ----------
    body : Body
        The body.
    gravity : sequence of float
        Gravity vector of its system [m/s^2], which a body may use.
    """

    def __init__(self, body: Body, gravity: Sequence[float] = (0.0, 0.0, -9.81)) -> None:
        offered = {**body.parameters(), **dict(zip(("gravity_x", "gravity_y", "gravity_z"), gravity, strict=True))}
        self._call = body_caller(body.evaluator, offered, type(body).__name__)
        self._n, self._width = len(body.frames), FRAME + 6 * body.n_u
        self._out = np.zeros(self._n * self._width + body.n_q + body.n_u + body.n_u**2 + 2)

    def motion(self, t: float, q: Vector, u: Vector) -> Vector:
        """Motion of all frames at time ``t`` [s], for coordinates ``q`` and velocities ``u``; shape [n_frames, FRAME].

        A row has position, rotation matrix, velocity, angular velocity, acceleration and angular acceleration while
        u' = 0, with the offsets and units of :mod:`nonsmooth.engine.memory.blocks`.
        """
        self._out[:] = 0.0
        # the compiled function takes the addresses of the arrays: a zero is appended because the empty array of a
        # driven body, which has no coordinates, has no valid address
        self._call(t, np.append(q, 0.0), np.append(u, 0.0), self._out)
        return self._out[: self._n * self._width].reshape(self._n, self._width)[:, :FRAME].copy()

    def at(self, t: float, q: Vector, u: Vector) -> list[Place]:
        """Places (origin [m] and axes) of all frames at time ``t`` [s], for coordinates ``q`` and velocities ``u``."""
        return [(frame[:3], frame[3:12].reshape(3, 3)) for frame in self.motion(t, q, u)]
