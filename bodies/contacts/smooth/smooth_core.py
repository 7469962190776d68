"""Rotations and second derivatives for contacts of smooth bodies.

A smooth body is a core with a smooth support function, rounded by a radius.  The core is the tuple of
:func:`bodies.shapes.smooth.core_numbers`.
"""

from __future__ import annotations

import math
from typing import TypeAlias

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import NORMAL, ROTATION, TANGENT
from nonsmooth.types import Floats

from ...shapes.support_function import Support, support_of
from ...vectors import Vector3, vector_at

Axes: TypeAlias = tuple[float, float, float, float, float, float, float, float, float]
"""A rotation, row by row."""

RADIUS = 5
"""Index of the radius in the numbers of a core."""


@compiled
def bend(s: Support, x: float, y: float, z: float, u: float, v: float, w: float) -> float:
    """Return (x, y, z) . H (u, v, w) with the second derivative H of a support function [m]."""
    return (
        x * (s[4] * u + s[9] * v + s[8] * w)
        + y * (s[9] * u + s[5] * v + s[7] * w)
        + z * (s[8] * u + s[7] * v + s[6] * w)
    )


@compiled
def axes_in_world(frame: Floats, core: Floats) -> Axes:
    """Return the axes of a smooth body's core in the world, as columns."""
    f, c = frame, core
    return (
        f[3] * c[9] + f[4] * c[12] + f[5] * c[15],
        f[3] * c[10] + f[4] * c[13] + f[5] * c[16],
        f[3] * c[11] + f[4] * c[14] + f[5] * c[17],
        f[6] * c[9] + f[7] * c[12] + f[8] * c[15],
        f[6] * c[10] + f[7] * c[13] + f[8] * c[16],
        f[6] * c[11] + f[7] * c[14] + f[8] * c[17],
        f[9] * c[9] + f[10] * c[12] + f[11] * c[15],
        f[9] * c[10] + f[10] * c[13] + f[11] * c[16],
        f[9] * c[11] + f[10] * c[14] + f[11] * c[17],
    )


@compiled
def unit_axes_in_world(frame: Floats, core: Floats) -> Axes:
    """Return the axes of a smooth body's core in the world, as columns of length 1.

    Within a time step, a body's quaternion is not normalised.  If its length is L, the columns of its rotation matrix
    have the length L^2.
    """
    found = axes_in_world(frame, core)
    x, y, z = found[0], found[1], found[2]
    part = 1.0 / math.sqrt(x * x + y * y + z * z)
    return (
        part * x,
        part * y,
        part * z,
        part * found[3],
        part * found[4],
        part * found[5],
        part * found[6],
        part * found[7],
        part * found[8],
    )


@compiled
def axes_of(frame: Floats) -> Axes:
    """Return the axes of a body in the world, as columns."""
    x, y, z = ROTATION, ROTATION + 3, ROTATION + 6
    return (
        frame[x],
        frame[x + 1],
        frame[x + 2],
        frame[y],
        frame[y + 1],
        frame[y + 2],
        frame[z],
        frame[z + 1],
        frame[z + 2],
    )


@compiled
def between_axes(a: Axes, b: Axes) -> Axes:
    """Return the rotation from the axes b to the axes a."""
    return (
        a[0] * b[0] + a[3] * b[3] + a[6] * b[6],
        a[0] * b[1] + a[3] * b[4] + a[6] * b[7],
        a[0] * b[2] + a[3] * b[5] + a[6] * b[8],
        a[1] * b[0] + a[4] * b[3] + a[7] * b[6],
        a[1] * b[1] + a[4] * b[4] + a[7] * b[7],
        a[1] * b[2] + a[4] * b[5] + a[7] * b[8],
        a[2] * b[0] + a[5] * b[3] + a[8] * b[6],
        a[2] * b[1] + a[5] * b[4] + a[8] * b[7],
        a[2] * b[2] + a[5] * b[5] + a[8] * b[8],
    )


@compiled
def forth(axes: Axes, v: Vector3) -> Vector3:
    """Return a vector turned by a rotation."""
    x, y, z = v
    return (
        axes[0] * x + axes[1] * y + axes[2] * z,
        axes[3] * x + axes[4] * y + axes[5] * z,
        axes[6] * x + axes[7] * y + axes[8] * z,
    )


@compiled
def back(axes: Axes, v: Vector3) -> Vector3:
    """Return a vector turned by the inverse of a rotation."""
    x, y, z = v
    return (
        axes[0] * x + axes[3] * y + axes[6] * z,
        axes[1] * x + axes[4] * y + axes[7] * z,
        axes[2] * x + axes[5] * y + axes[8] * z,
    )


@compiled
def write_core(out: Floats, side: int, core: Floats, axes: Axes, x: float, y: float, z: float) -> None:
    """Write the curvature matrices slide and turn of a smooth body at its outward normal (x, y, z).

    The normal is in the axes of the core.  The matrices satisfy slide u = turn nu: if the contact point moves by u
    along the surface [m], the normal turns by nu.  Slide is the identity.  Turn is the matrix of the radii of curvature
    [m]: the second derivative of the support function at the normal, plus the core's radius.  The geometry block
    ``out`` must already hold normal and first tangent; ``axes`` are the core's axes in the world.
    """
    s = support_of(core, (x, y, z))
    tx, ty, tz = back(axes, vector_at(out, TANGENT))
    ux, uy, uz = back(
        axes,
        (
            out[NORMAL + 1] * out[TANGENT + 2] - out[NORMAL + 2] * out[TANGENT + 1],
            out[NORMAL + 2] * out[TANGENT] - out[NORMAL] * out[TANGENT + 2],
            out[NORMAL] * out[TANGENT + 1] - out[NORMAL + 1] * out[TANGENT],
        ),
    )
    out[side] = out[side + 3] = 1.0
    out[side + 1] = out[side + 2] = 0.0
    out[side + 4] = bend(s, tx, ty, tz, tx, ty, tz) + core[RADIUS]
    out[side + 5] = out[side + 6] = bend(s, tx, ty, tz, ux, uy, uz)
    out[side + 7] = bend(s, ux, uy, uz, ux, uy, uz) + core[RADIUS]
