"""The output block of a body, read part by part, and the states at which a body is checked."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, final

import numpy as np

from nonsmooth.engine.memory.blocks import FRAME
from nonsmooth.interfaces import Body
from nonsmooth.rotations import turned
from nonsmooth.testing.functions import Caller, compiled_caller, plain_caller, written
from nonsmooth.testing.inputs import Case, Drawn, DrawnNumber
from nonsmooth.types import Array

State = tuple[float, Array, Array]
"""Time [s], coordinates and velocities."""
WEIGHTLESS = {"gravity_x": 0.0, "gravity_y": 0.0, "gravity_z": 0.0}
OBLIQUE = {"gravity_x": 1.1, "gravity_y": -2.3, "gravity_z": -9.7}
"""Gravity of the checks [m/s^2]; the properties must hold with any."""


@final
@dataclass(frozen=True)
class BlockPlaces:
    """First places of the parts of a body's block (:mod:`nonsmooth.engine.memory.blocks`)."""

    n_frames: int
    n_q: int
    n_u: int

    def frame(self, i: int) -> int:
        """Motion of a frame, 24 numbers."""
        return i * (FRAME + 6 * self.n_u)

    def jacobian(self, i: int) -> int:
        """Jacobian of a frame, 6 n_u numbers."""
        return self.frame(i) + FRAME

    @property
    def rates(self) -> int:
        """Coordinate rates, n_q numbers."""
        return self.frame(self.n_frames)

    @property
    def force(self) -> int:
        """Forces, n_u numbers."""
        return self.rates + self.n_q

    @property
    def inverse_mass(self) -> int:
        """Inverse mass matrix, row by row."""
        return self.force + self.n_u

    @property
    def energy(self) -> int:
        """Kinetic and potential energy."""
        return self.inverse_mass + self.n_u * self.n_u

    @property
    def size(self) -> int:
        """Length of the block; a driven body writes its frames only."""
        return self.energy + 2 if self.n_u else self.rates


def places_of(body: Body) -> BlockPlaces:
    """Return the places in the block of a body."""
    return BlockPlaces(len(body.frames), body.n_q, body.n_u)


@final
@dataclass(frozen=True)
class BodyBlock:
    """The numbers that a body writes."""

    places: BlockPlaces
    numbers: Array

    def _part(self, start: int, *shape: int) -> Array:
        return self.numbers[start : start + int(np.prod(shape))].reshape(shape)

    def frame(self, i: int) -> Array:
        """Position, rotation, velocity, angular velocity and the two biases of a frame, shape [24]."""
        return self._part(self.places.frame(i), FRAME)

    def jacobian(self, i: int) -> Array:
        """Jacobian of (velocity, angular velocity) of a frame, shape [6, n_u]."""
        return self._part(self.places.jacobian(i), 6, self.places.n_u)

    @property
    def rates(self) -> Array:
        """dq/dt, shape [n_q]."""
        return self._part(self.places.rates, self.places.n_q)

    @property
    def force(self) -> Array:
        """h, shape [n_u]."""
        return self._part(self.places.force, self.places.n_u)

    @property
    def inverse(self) -> Array:
        """M^-1, shape [n_u, n_u]."""
        return self._part(self.places.inverse_mass, self.places.n_u, self.places.n_u)

    @property
    def energy(self) -> Array:
        """Kinetic and potential energy [J]."""
        return self._part(self.places.energy, 2)


def offered(body: Body, gravity: Mapping[str, float] = OBLIQUE) -> dict[str, Any]:
    """Return what the evaluator may ask for."""
    return {**body.parameters(), **gravity}


def plain(body: Body) -> Caller:
    """Return the evaluator in plain Python."""
    return plain_caller(body.evaluator, "body", offered(body))


def block_of(body: Body, at: State, gravity: Mapping[str, float] = OBLIQUE) -> BodyBlock:
    """Return the block that the compiled evaluator of a body writes at a state."""
    call, places = compiled_caller(body.evaluator, "body", offered(body, gravity), type(body).__name__), places_of(body)
    t, q, u = at
    return BodyBlock(places, written(lambda out: call(t, np.array(q), np.array(u), out), places.size))


def state_of(body: Body) -> Drawn:
    """Return a drawn state near the start of a body."""
    numbers = [DrawnNumber("t", 0.0, 1.0)]
    numbers += [DrawnNumber(f"q{i + 1}", -0.3, 0.3) for i in range(body.n_q)]
    numbers += [DrawnNumber(f"u{i + 1}", -1.0, 1.0) for i in range(body.n_u)]
    return Drawn(tuple(numbers), lambda case: state_at(body, case))


def state_at(body: Body, case: Case) -> State:
    """Return the state of an input: differences to the start in units of the scales, a turn of the quaternion."""
    q, u = (np.array(x, dtype=float) for x in body.state())
    q_scale, u_scale = body.scales
    moved = q + q_scale * np.array([case[f"q{i + 1}"] for i in range(body.n_q)])
    if body.quaternion >= 0:
        at = slice(body.quaternion, body.quaternion + 4)
        moved[at] = turned(q[at], 3.0 * np.array([case[f"q{body.quaternion + i}"] for i in (2, 3, 4)]))
    return case["t"], moved, u + u_scale * np.array([case[f"u{i + 1}"] for i in range(body.n_u)])


def stepped(body: Body, q: Array, rates: Array, dt: float) -> Array:
    """Return q after a straight step; a quaternion is kept at unit length."""
    moved = q + dt * rates
    if body.quaternion >= 0:
        at = slice(body.quaternion, body.quaternion + 4)
        moved[at] /= np.linalg.norm(moved[at])
    return np.asarray(moved)
