"""The output block of a body, read part by part."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.memory.blocks import FRAME
from nonsmooth.interfaces import Body
from nonsmooth.rotations import turned
from nonsmooth.testing.callers import Caller, compiled_caller, plain_caller
from nonsmooth.testing.draws import Case, Variable
from nonsmooth.testing.functions import OLD, ROOM

Array = NDArray[np.float64]
WEIGHTLESS = {"gravity_x": 0.0, "gravity_y": 0.0, "gravity_z": 0.0}
OBLIQUE = {"gravity_x": 1.1, "gravity_y": -2.3, "gravity_z": -9.7}
"""Gravity of the checks [m/s^2], which must hold with any."""


@final
@dataclass(frozen=True)
class Block:
    """What a body writes; shapes of the parts as in :mod:`nonsmooth.engine.memory.blocks`."""

    body: Body
    numbers: Array

    @property
    def _per_frame(self) -> int:
        return FRAME + 6 * self.body.n_u

    def frame(self, i: int) -> Array:
        """Return position, rotation, velocity, angular velocity and the two biases of a frame, shape [24]."""
        return self.numbers[i * self._per_frame :][:FRAME]

    def jacobian(self, i: int) -> Array:
        """Return the Jacobian of (velocity, angular velocity) of a frame, shape [6, n_u]."""
        start = i * self._per_frame + FRAME
        return self.numbers[start : start + 6 * self.body.n_u].reshape(6, self.body.n_u)

    def _tail(self, before: int, size: int) -> Array:
        start = len(self.body.frames) * self._per_frame + before
        return self.numbers[start : start + size]

    @property
    def rates(self) -> Array:
        """dq/dt, shape [n_q]."""
        return self._tail(0, self.body.n_q)

    @property
    def force(self) -> Array:
        """h, shape [n_u]."""
        return self._tail(self.body.n_q, self.body.n_u)

    @property
    def inverse(self) -> Array:
        """M^-1, shape [n_u, n_u]."""
        n = self.body.n_u
        return self._tail(self.body.n_q + n, n * n).reshape(n, n)

    @property
    def energy(self) -> Array:
        """Kinetic and potential energy [J]."""
        n = self.body.n_u
        return self._tail(self.body.n_q + n + n * n, 2)


def size_of(body: Body) -> int:
    """Return the length of the block of a body."""
    n = body.n_u
    per_frame = FRAME + 6 * n if n else FRAME
    return len(body.frames) * per_frame + (body.n_q + n + n * n + 2 if n else 0)


def offered(body: Body, gravity: Mapping[str, float] = OBLIQUE) -> dict[str, Any]:
    """Return what the evaluator may ask for."""
    return {**body.parameters(), **gravity}


def plain(body: Body, gravity: Mapping[str, float] = OBLIQUE) -> Caller:
    """Return the evaluator as it stands."""
    return plain_caller(body.evaluator, "body", offered(body, gravity))


def compiled(body: Body, gravity: Mapping[str, float] = OBLIQUE) -> Caller:
    """Return the evaluator, compiled."""
    return compiled_caller(body.evaluator, "body", offered(body, gravity), type(body).__name__)


def written(body: Body, call: Callable[..., Any], t: float, q: Array, u: Array, old: Array | None = None) -> Array:
    """Return what an evaluator writes into a block, with some room behind it."""
    out = np.full(size_of(body) + ROOM, OLD) if old is None else old.copy()
    if old is None:
        out[:-ROOM] = 0.0
    call(t, np.array(q), np.array(u), out)
    return out


def state_space(body: Body) -> list[Variable]:
    """Return numbers that make a state near the start."""
    space = [Variable("t", 0.0, 1.0)]
    space += [Variable(f"q{i + 1}", -0.3, 0.3) for i in range(body.n_q)]
    return space + [Variable(f"u{i + 1}", -1.0, 1.0) for i in range(body.n_u)]


def state(body: Body, case: Case) -> tuple[float, Array, Array]:
    """Return time and state of an input: differences to the start in units of the scales, a turn of the quaternion."""
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
