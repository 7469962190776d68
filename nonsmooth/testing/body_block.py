"""The output block of a body, read part by part, and the states at which a body is checked."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

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
"""Gravity of the checks [m/s^2]: oblique, because the properties must hold for gravity in any direction."""


class BodyBlock(NamedTuple):
    """The numbers that a body writes (:mod:`nonsmooth.engine.memory.blocks`); a driven body writes frames only.

    Attributes
    ----------
    frames : array
        Position, rotation, velocity, angular velocity and the two biases of each frame, shape [n, 24].
    jacobians : array
        Jacobians of (velocity, angular velocity) of each frame, shape [n, 6, n_u].
    rates, force : array
        Rates dq/dt, shape [n_q], and generalized forces h, shape [n_u].
    inverse : array
        Inverse mass matrix M^-1, shape [n_u, n_u].
    energy : array
        Kinetic and potential energy [J], shape [2].
    """

    frames: Array
    jacobians: Array
    rates: Array
    force: Array
    inverse: Array
    energy: Array


def block_size(body: Body) -> int:
    """Return how many numbers the evaluator of a body writes."""
    frames = len(body.frames) * (FRAME + 6 * body.n_u)
    return frames + body.n_q + body.n_u + body.n_u * body.n_u + 2 if body.n_u else frames


def offered(body: Body, gravity: Mapping[str, float] = OBLIQUE) -> dict[str, Any]:
    """Return the values that the evaluator may take by name: the body's parameters and gravity [m/s^2]."""
    return {**body.parameters(), **gravity}


def plain(body: Body) -> Caller:
    """Return the body's evaluator in plain Python, with its parameters filled in."""
    return plain_caller(body.evaluator, "body", offered(body))


def block_of(body: Body, at: State, gravity: Mapping[str, float] = OBLIQUE) -> BodyBlock:
    """Return the block that the compiled evaluator of a body writes at a state."""
    call = compiled_caller(body.evaluator, "body", offered(body, gravity), type(body).__name__)
    (t, q, u), n_q, n_u = at, body.n_q, body.n_u
    numbers = written(lambda out: call(t, np.array(q), np.array(u), out), block_size(body))[: block_size(body)]
    n, row = len(body.frames), FRAME + 6 * n_u
    frames, rest = np.split(numbers, [n * row])
    frames = frames.reshape(n, row)
    rates, force, inverse, energy = np.split(rest, np.cumsum([n_q, n_u, n_u * n_u]))
    jacobians = frames[:, FRAME:].reshape(n, 6, n_u)
    return BodyBlock(frames[:, :FRAME], jacobians, rates, force, inverse.reshape(n_u, n_u), energy)


def state_of(body: Body) -> Drawn:
    """Return the inputs of a body's checks: a time from 0 to 1 s and a state near the start."""
    numbers = [DrawnNumber("t", 0.0, 1.0)]
    numbers += [DrawnNumber(f"q{i + 1}", -0.3, 0.3) for i in range(body.n_q)]
    numbers += [DrawnNumber(f"u{i + 1}", -1.0, 1.0) for i in range(body.n_u)]
    return Drawn(tuple(numbers), lambda case: state_at(body, case))


def state_at(body: Body, case: Case) -> State:
    """Return the time and the state of an input.

    The numbers of the input are differences from the start, in units of the body's scales. A quaternion is turned by a
    rotation vector instead, so that it keeps its unit length.
    """
    q, u = (np.array(x, dtype=float) for x in body.state())
    q_scale, u_scale = body.scales
    moved = q + q_scale * np.array([case[f"q{i + 1}"] for i in range(body.n_q)])
    if body.quaternion >= 0:
        at = slice(body.quaternion, body.quaternion + 4)
        moved[at] = turned(q[at], 3.0 * np.array([case[f"q{body.quaternion + i}"] for i in (2, 3, 4)]))
    return case["t"], moved, u + u_scale * np.array([case[f"u{i + 1}"] for i in range(body.n_u)])


def stepped(body: Body, q: Array, rates: Array, dt: float) -> Array:
    """Return q + dt * rates, with the quaternion scaled to unit length."""
    moved = q + dt * rates
    if body.quaternion >= 0:
        at = slice(body.quaternion, body.quaternion + 4)
        moved[at] /= np.linalg.norm(moved[at])
    return np.asarray(moved)
