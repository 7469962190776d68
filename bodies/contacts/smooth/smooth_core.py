"""Rotations, tangent planes and second derivatives for contacts of smooth bodies; what their searches share.

A smooth body is a core with a smooth support function, rounded by a radius.  The core is the tuple of
:func:`bodies.shapes.smooth.core_numbers`.  Where a search takes two cores, ``turn`` is the rotation from the axes of
the second core to those of the first, and ``place`` is the second core's centre from the first's [m], in the axes of
the first.
"""

from __future__ import annotations

from typing import TypeAlias

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import NORMAL, ROTATION, TANGENT
from nonsmooth.types import Floats

from ...shapes.support_function import Bends, support_of
from ...vectors import Vector3, cross, dot, opposite, over, plus, size_of, times, vector_at
from ..features.frames import vector_in_world

Axes: TypeAlias = tuple[float, float, float, float, float, float, float, float, float]
"""A rotation, row by row."""
Norm: TypeAlias = tuple[float, float, float, float, float]
"""Three semi-axes [m] and two powers of a core; a core whose semi-axes are 0 is a point."""
Answer: TypeAlias = tuple[float, Vector3, Vector3]
"""Gap [m], point [m] and unit normal, the result of a search; the gap is nan if the search failed."""

RADIUS, CENTER = 5, 6
"""Indices of the radius and the centre in the numbers of a core."""
POINT = 0.0, 0.0, 0.0, 2.0, 2.0, 0.0
"""Core numbers of a point."""

ROUND_OFF, CLOSE, RIGHT = 2e-16, 1e-12, 1e-13
"""Residuals of Newton's method, relative to the size of the bodies.

Below ``ROUND_OFF`` it ends.  Below ``CLOSE`` it ends once a step no longer halves the residual, which round-off limits
there.  A result with a residual above ``RIGHT`` is rejected.
"""


@compiled
def has_ended(residual: float, before: float, size: float) -> bool:
    """Return whether Newton's method ends: ``before`` is the residual of the last step, ``size`` that of the bodies."""
    return bool(residual <= ROUND_OFF * size or (residual <= CLOSE * size and residual >= 0.5 * before))


@compiled
def unit(v: Vector3) -> Vector3:
    """Return a vector divided by its length."""
    found: Vector3 = over(v, size_of(v))
    return found


@compiled
def spread(v: Vector3) -> float:
    """Return the sum of the absolute components of a vector, a measure of its size that is cheap."""
    return abs(v[0]) + abs(v[1]) + abs(v[2])


@compiled
def longest(core: Floats) -> float:
    """Return the largest semi-axis of a core [m]."""
    return max(core[0], core[1], core[2])


@compiled
def bend(h: Bends, u: Vector3, v: Vector3) -> float:
    """Return u . H v with the second derivative H of a support function [m]."""
    return (
        u[0] * (h[0] * v[0] + h[5] * v[1] + h[4] * v[2])
        + u[1] * (h[5] * v[0] + h[1] * v[1] + h[3] * v[2])
        + u[2] * (h[4] * v[0] + h[3] * v[1] + h[2] * v[2])
    )


@compiled
def by_columns(x: Vector3, y: Vector3, z: Vector3) -> Axes:
    """Return the rotation with these columns."""
    return x[0], y[0], z[0], x[1], y[1], z[1], x[2], y[2], z[2]


@compiled
def axes_in_world(frame: Floats, core: Floats) -> Axes:
    """Return the axes of a smooth body's core in the world, as columns."""
    x = vector_in_world(frame, (core[9], core[12], core[15]))
    y = vector_in_world(frame, (core[10], core[13], core[16]))
    found: Axes = by_columns(x, y, vector_in_world(frame, (core[11], core[14], core[17])))
    return found


@compiled
def unit_axes_in_world(frame: Floats, core: Floats) -> Axes:
    """Return the axes of a smooth body's core in the world, as columns of length 1.

    Within a time step, a body's quaternion is not normalised.  If its length is L, the columns of its rotation matrix
    have the length L^2.
    """
    x, y, z, u, v, w, r, s, t = axes_in_world(frame, core)
    part = 1.0 / size_of((x, y, z))
    return part * x, part * y, part * z, part * u, part * v, part * w, part * r, part * s, part * t


@compiled
def axes_of(frame: Floats) -> Axes:
    """Return the axes of a body in the world, as columns."""
    x, y, z = vector_at(frame, ROTATION), vector_at(frame, ROTATION + 3), vector_at(frame, ROTATION + 6)
    return x[0], x[1], x[2], y[0], y[1], y[2], z[0], z[1], z[2]


@compiled
def between_axes(a: Axes, b: Axes) -> Axes:
    """Return the rotation from the axes b to the axes a."""
    x, y, z = back(a, (b[0], b[3], b[6])), back(a, (b[1], b[4], b[7])), back(a, (b[2], b[5], b[8]))
    found: Axes = by_columns(x, y, z)
    return found


@compiled
def inverse(turn: Axes) -> Axes:
    """Return the inverse of a rotation."""
    return turn[0], turn[3], turn[6], turn[1], turn[4], turn[7], turn[2], turn[5], turn[8]


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
def facing_point(core: Floats, turn: Axes, place: Vector3, n: Vector3) -> tuple[Vector3, Bends]:
    """Return the farthest point of a second core in the direction -n [m], and the second derivative of its support.

    Point and n are in the axes of the first core; the second derivative is in those of the second [m].
    """
    _, p, h = support_of(core, back(turn, opposite(n)))
    return plus(place, forth(turn, p)), h


Pair: TypeAlias = tuple[float, float]
"""Components of a vector of a tangent plane along its two tangents."""
Symmetric: TypeAlias = tuple[float, float, float]
"""Elements 11, 12 and 22 of a symmetric matrix of a tangent plane."""
Matrix: TypeAlias = tuple[float, float, float, float]
"""Elements 11, 12, 21 and 22 of a matrix of a tangent plane."""


@compiled
def in_plane(t: Vector3, u: Vector3, v: Vector3) -> Pair:
    """Return the components of a vector along two tangents."""
    return dot(t, v), dot(u, v)


@compiled
def along(v: Pair, t: Vector3, u: Vector3) -> Vector3:
    """Return the vector with these components along two tangents."""
    found: Vector3 = plus(times(v[0], t), times(v[1], u))
    return found


@compiled
def bends_in_plane(h: Bends, t: Vector3, u: Vector3) -> Symmetric:
    """Return the second derivative of a support function along two tangents [m]."""
    return bend(h, t, t), bend(h, t, u), bend(h, u, u)


@compiled
def from_tangents(t: Vector3, u: Vector3, first: Vector3, second: Vector3) -> Matrix:
    """Return the matrix from components along the tangents ``first`` and ``second`` to those along t and u."""
    return dot(t, first), dot(t, second), dot(u, first), dot(u, second)


@compiled
def determinant(m: Matrix) -> float:
    """Return the determinant of a matrix."""
    return m[0] * m[3] - m[1] * m[2]


@compiled
def solved(m: Matrix, det: float, right: Pair) -> Pair:
    """Return x with m x = right, for a matrix m with the determinant ``det``."""
    return (m[3] * right[0] - m[1] * right[1]) / det, (m[0] * right[1] - m[2] * right[0]) / det


@compiled
def by_symmetric(c: Matrix, s: Symmetric) -> Matrix:
    """Return the product C S."""
    return c[0] * s[0] + c[1] * s[1], c[0] * s[1] + c[1] * s[2], c[2] * s[0] + c[3] * s[1], c[2] * s[1] + c[3] * s[2]


@compiled
def turned_matrix(c: Matrix, s: Symmetric) -> Symmetric:
    """Return C S C^T."""
    e = by_symmetric(c, s)
    return e[0] * c[0] + e[1] * c[1], e[0] * c[2] + e[1] * c[3], e[2] * c[2] + e[3] * c[3]


@compiled
def tangents_in(axes: Axes, out: Floats) -> tuple[Vector3, Vector3]:
    """Return both tangents of a geometry block, which holds normal and first tangent, in the axes of a core."""
    t = vector_at(out, TANGENT)
    return back(axes, t), back(axes, cross(vector_at(out, NORMAL), t))


@compiled
def write_matrices(out: Floats, side: int, slide: Symmetric, turn: Symmetric) -> None:
    """Write the curvature matrices of a surface, which satisfy slide u = turn nu.

    If the contact point moves by u along the surface [m], the normal turns by nu.
    """
    out[side], out[side + 3], out[side + 4], out[side + 7] = slide[0], slide[2], turn[0], turn[2]
    out[side + 1] = out[side + 2] = slide[1]
    out[side + 5] = out[side + 6] = turn[1]


@compiled
def write_core(out: Floats, side: int, core: Floats, axes: Axes, normal: Vector3) -> None:
    """Write the curvature matrices slide and turn of a smooth body at its outward normal, in the axes of the core.

    Slide is the identity.  Turn is the matrix of the radii of curvature [m]: the second derivative of the support
    function at the normal, plus the core's radius.  The geometry block ``out`` must already hold normal and first
    tangent; ``axes`` are the core's axes in the world.
    """
    _, _, h = support_of(core, normal)
    t, u = tangents_in(axes, out)
    h11, h12, h22 = bends_in_plane(h, t, u)
    write_matrices(out, side, (1.0, 0.0, 1.0), (h11 + core[RADIUS], h12, h22 + core[RADIUS]))
