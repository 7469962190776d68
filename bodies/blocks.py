"""Functions that write poses into the blocks of numbers (:mod:`nonsmooth.engine.memory.blocks`)."""

from __future__ import annotations

from collections.abc import Sequence

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import FRAME, VELOCITY
from nonsmooth.rotations import rotation
from nonsmooth.types import Floats

from .vectors import Vector3, write_vector

POSE = VELOCITY
"""Length of a pose: position [m], then rotation matrix by rows.

It is the index of ``VELOCITY``, because the block of a frame begins with the pose and the velocity follows.
"""


def places_behind_frame(n_q: int, n_u: int) -> tuple[int, int, int, int]:
    """Indices of coordinate rates, force, inverse mass matrix and energies in the block of a body with one frame."""
    rates = FRAME + 6 * n_u
    return rates, rates + n_q, rates + n_q + n_u, rates + n_q + n_u + n_u * n_u


@compiled
def rotation_of(a: float, b: float, c: float, d: float) -> tuple[Vector3, Vector3, Vector3]:
    """Rows of the rotation matrix of a unit quaternion (scalar first).

    In a step of the integrator the length L of the quaternion drifts from 1, until it is normalised again.  Meanwhile
    the result is L^2 times a rotation.
    """
    x = a * a + b * b - c * c - d * d, 2.0 * (b * c - a * d), 2.0 * (b * d + a * c)
    y = 2.0 * (b * c + a * d), a * a - b * b + c * c - d * d, 2.0 * (c * d - a * b)
    return x, y, (2.0 * (b * d - a * c), 2.0 * (c * d + a * b), a * a - b * b - c * c + d * d)


@compiled
def put_rows(out: Floats, place: int, rows: tuple[Vector3, Vector3, Vector3], stride: int = 3) -> None:
    """Write the rows of a matrix into a block, each ``stride`` numbers behind the one before."""
    x, y, z = rows
    # written out: a loop over a tuple of tuples is not unrolled
    write_vector(out, place, x)
    write_vector(out, place + stride, y)
    write_vector(out, place + 2 * stride, z)


def pose_of(position: Sequence[float], orientation: Sequence[float]) -> tuple[float, ...]:
    """Pose for :func:`write_pose` from a position [m] and a unit quaternion: position, then rotation matrix."""
    return *map(float, position), *rotation(orientation).ravel().tolist()


@compiled
def write_pose(out: Floats, pose: Floats) -> None:
    """Write a pose into the block of a frame."""
    for i in range(POSE):
        out[i] = pose[i]


def stand_still(t: float, q: Floats, u: Floats, out: Floats, pose: Floats) -> None:
    """Write the block of a frame at rest."""
    write_pose(out, pose)
