"""Rotations in functions that the engine compiles; they are tuples, which stay in registers."""

from __future__ import annotations

from typing import TypeAlias

from nonsmooth.compiled import compiled

from .vectors import Vector3

Axes: TypeAlias = tuple[float, float, float, float, float, float, float, float, float]
"""A rotation, row by row.  Its columns are the axes that it turns the coordinate axes to."""


@compiled
def by_columns(x: Vector3, y: Vector3, z: Vector3) -> Axes:
    """Return the rotation with the unit vectors x, y and z as columns."""
    return x[0], y[0], z[0], x[1], y[1], z[1], x[2], y[2], z[2]


@compiled
def inverse(turn: Axes) -> Axes:
    """Return the inverse of a rotation."""
    return turn[0], turn[3], turn[6], turn[1], turn[4], turn[7], turn[2], turn[5], turn[8]


@compiled
def rotated(axes: Axes, v: Vector3) -> Vector3:
    """Return a vector turned by a rotation."""
    x, y, z = v
    return (
        axes[0] * x + axes[1] * y + axes[2] * z,
        axes[3] * x + axes[4] * y + axes[5] * z,
        axes[6] * x + axes[7] * y + axes[8] * z,
    )


@compiled
def rotated_back(axes: Axes, v: Vector3) -> Vector3:
    """Return a vector turned by the inverse of a rotation."""
    x, y, z = v
    return (
        axes[0] * x + axes[3] * y + axes[6] * z,
        axes[1] * x + axes[4] * y + axes[7] * z,
        axes[2] * x + axes[5] * y + axes[8] * z,
    )


@compiled
def relative_rotation(a: Axes, b: Axes) -> Axes:
    """Return a^T b: it converts components along the axes b to components along the axes a.

    The columns of a and b are axes in the world.
    """
    x, y = rotated_back(a, (b[0], b[3], b[6])), rotated_back(a, (b[1], b[4], b[7]))
    return by_columns(x, y, rotated_back(a, (b[2], b[5], b[8])))
