"""Newton's method for a body with flat places (boxy, :func:`bodies.shapes.support_function.is_boxy`) and a smooth one.

At its flat points the second derivative of a boxy body's support function is infinite.  The second derivative of its
gauge f is finite.  So the unknown is not the normal, but the point p of the surface, with f(p) = 1.  At p, the normal
is n = f' / |f'|, with the gradient f'.  The shape operator is K = f'' / |f'| in the tangent plane; it is 0 at a flat
point.
"""

from __future__ import annotations

import math
from typing import TypeAlias

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import NORMAL, TANGENT
from nonsmooth.types import Floats

from ...shapes.support_function import boxy_gauge_of, support_of
from ...vectors import vector_at
from ..features.frames import tangent_of
from .smooth_core import RADIUS, Axes, back, bend, forth

_STEPS = 200
_HALVINGS = 40
_ROUND_OFF = 2e-16
_SEEN = 1e-14
"""Difference of two distances of the contact points that is round-off, relative to the size of the bodies."""
_CLOSE = 1e-12
"""Residual below which the iteration ends as soon as a step does not halve it, relative to the size of the bodies.

A step that does not halve such a small residual is limited by round-off.
"""
_RIGHT = 1e-13
"""Largest residual of Newton's method that is accepted for a result, relative to the size of the bodies."""
_ENOUGH = 1e-4
"""Least decrease of the merit function by a step, relative to the decrease predicted by its derivative."""
_LONGEST = 0.5
"""Longest Newton step of the contact point, relative to the size of the boxy body: its surface is linearised."""
_FLATTEST = 1e-12
"""Curvature that is added to the curvature of a boxy core, relative to 1 / size.

Without it the curvature is 0 at flat places, but the engine divides by it in a contact with a plane.
"""

Norm: TypeAlias = tuple[float, float, float, float, float]
"""Three semi-axes [m] and two powers of a core; a core whose semi-axes are 0 is a point."""
Point: TypeAlias = tuple[float, float, float]
Answer: TypeAlias = tuple[float, float, float, float, float, float, float]
"""Gap [m], point (3) [m] and unit normal (3), the result of a search."""
Place: TypeAlias = tuple[
    float, float, float, float, float, float, float, float, float, float, float, float, float, float, float
]
"""Point of a surface [m], unit normal, two unit tangents, and the shape operator along these: K11, K12, K22 [1/m]."""


@compiled
def place_on(core: Floats, x: float, y: float, z: float) -> Place:
    """Return the point of a boxy core's surface in the direction (x, y, z), with normal and shape operator."""
    f = boxy_gauge_of(core, x, y, z)
    length = math.sqrt(f[1] * f[1] + f[2] * f[2] + f[3] * f[3])
    nx, ny, nz = f[1] / length, f[2] / length, f[3] / length
    tx, ty, tz = tangent_of((nx, ny, nz))
    ux, uy, uz = ny * tz - nz * ty, nz * tx - nx * tz, nx * ty - ny * tx
    # the second derivative goes with 1 / f
    scale = f[0] / length
    tt = scale * bend(f, tx, ty, tz, tx, ty, tz)
    tu = scale * bend(f, tx, ty, tz, ux, uy, uz)
    uu = scale * bend(f, ux, uy, uz, ux, uy, uz)
    return x / f[0], y / f[0], z / f[0], nx, ny, nz, tx, ty, tz, ux, uy, uz, tt, tu, uu


@compiled
def climb_boxy(
    core: Floats, other: Floats, turn: Axes, x: float, y: float, z: float, sx: float, sy: float, sz: float
) -> Answer:
    """Return the gap of a boxy core and another core [m], the point on the boxy core [m], and the normal from it.

    Point and normal are in the axes of the boxy core.  The gap is nan if the search fails.  The other core must not be
    boxy.

    The unknown is the point p of the boxy core, with the normal n and the shape operator K.  The point q of the other
    core is the farthest in the direction -n; H is the second derivative of this core's support function.  The residual
    is the part of d = q - p in the tangent plane.  Newton's step delta solves (1 + (H + g) K) delta = residual, with
    the gap g = n . d.  A step is shortened until it decreases |d|^2 / 2, which is least at the result if the bodies are
    apart.

    Parameters
    ----------
    core : Floats
        The boxy core; its radius is not used.
    other : Floats
        The other core, or its semi-axes and powers (:data:`Norm`).
    turn : Axes
        Rotation from the axes of the other core to those of the boxy core.
    x, y, z : float
        Centre of the other core from the centre of the boxy core [m].
    sx, sy, sz : float
        Direction of the point to begin with, of any length.
    """
    extent = max(core[0], core[1], core[2])
    size = abs(x) + abs(y) + abs(z) + extent + max(other[0], other[1], other[2])
    px, py, pz = sx, sy, sz
    lx, ly, lz, step_x, step_y, step_z = px, py, pz, 0.0, 0.0, 0.0
    merit, promise, before = math.inf, 0.0, math.inf
    halvings = 0
    for _ in range(_STEPS):
        s = place_on(core, px, py, pz)
        px, py, pz, nx, ny, nz = s[0], s[1], s[2], s[3], s[4], s[5]
        tx, ty, tz, ux, uy, uz = s[6], s[7], s[8], s[9], s[10], s[11]
        mx, my, mz = back(turn, (-nx, -ny, -nz))
        b = support_of(other, (mx, my, mz))
        dx, dy, dz = forth(turn, (b[1], b[2], b[3]))
        dx, dy, dz = x + dx - px, y + dy - py, z + dz - pz
        found = 0.5 * (dx * dx + dy * dy + dz * dz)
        seen = _SEEN * size * (_SEEN * size + math.sqrt(found))
        if found > merit - promise + seen and halvings < _HALVINGS:
            halvings += 1
            step_x, step_y, step_z, promise = 0.5 * step_x, 0.5 * step_y, 0.5 * step_z, 0.5 * promise
        else:
            merit, halvings = found, 0
            lx, ly, lz = px, py, pz
            g = nx * dx + ny * dy + nz * dz
            r, t = tx * dx + ty * dy + tz * dz, ux * dx + uy * dy + uz * dz
            residual = math.sqrt(r * r + t * t)
            vx, vy, vz = back(turn, (tx, ty, tz))
            wx, wy, wz = back(turn, (ux, uy, uz))
            h11, h12, h22 = bend(b, vx, vy, vz, vx, vy, vz), bend(b, vx, vy, vz, wx, wy, wz), 0.0
            h22 = bend(b, wx, wy, wz, wx, wy, wz)
            k11, k12, k22 = s[12], s[13], s[14]
            m11, m12 = 1.0 + (h11 + g) * k11 + h12 * k12, (h11 + g) * k12 + h12 * k22
            m21, m22 = h12 * k11 + (h22 + g) * k12, 1.0 + h12 * k12 + (h22 + g) * k22
            determinant = m11 * m22 - m12 * m21
            if residual <= _ROUND_OFF * size or (residual <= _CLOSE * size and residual >= 0.5 * before):
                # a stationary point that is not a maximum of the gap is not the shortest separating translation
                if residual > _RIGHT * size or determinant <= 0.0 or m11 + m22 <= 0.0:
                    return math.nan, px, py, pz, nx, ny, nz
                return g, px, py, pz, nx, ny, nz
            before = residual
            # the derivative of the merit is -(1 + K H) (r, t)
            slope_r = r + k11 * (h11 * r + h12 * t) + k12 * (h12 * r + h22 * t)
            slope_t = t + k12 * (h11 * r + h12 * t) + k22 * (h12 * r + h22 * t)
            along, across = r, t
            if determinant > 0.0:
                along, across = (m22 * r - m12 * t) / determinant, (m11 * t - m21 * r) / determinant
            promise = slope_r * along + slope_t * across
            if promise <= 0.0:
                along, across = slope_r, slope_t
                promise = along * along + across * across
            length = math.sqrt(along * along + across * across)
            if length > _LONGEST * extent:
                shorter = _LONGEST * extent / length
                along, across, promise = along * shorter, across * shorter, promise * shorter
            promise *= _ENOUGH
            if residual <= 1e-6 * size:
                # the predicted decrease is below the round-off of the merit
                promise = 0.0
            step_x, step_y, step_z = along * tx + across * ux, along * ty + across * uy, along * tz + across * uz
        px, py, pz = lx + step_x, ly + step_y, lz + step_z
    return math.nan, px, py, pz, 0.0, 0.0, 1.0


@compiled
def write_boxy(out: Floats, side: int, core: Floats, axes: Axes, x: float, y: float, z: float) -> None:
    """Write the curvature matrices of a boxy body: slide is the shape operator K of its core, turn is 1 + radius K.

    The contact point of the core is (x, y, z), in the axes of the core [m].

    The geometry block ``out`` must already hold normal and first tangent; ``axes`` are the core's axes in the world.
    """
    s = place_on(core, x, y, z)
    tx, ty, tz = back(axes, vector_at(out, TANGENT))
    ux, uy, uz = back(
        axes,
        (
            out[NORMAL + 1] * out[TANGENT + 2] - out[NORMAL + 2] * out[TANGENT + 1],
            out[NORMAL + 2] * out[TANGENT] - out[NORMAL] * out[TANGENT + 2],
            out[NORMAL] * out[TANGENT + 1] - out[NORMAL + 1] * out[TANGENT],
        ),
    )
    c11, c12 = tx * s[6] + ty * s[7] + tz * s[8], tx * s[9] + ty * s[10] + tz * s[11]
    c21, c22 = ux * s[6] + uy * s[7] + uz * s[8], ux * s[9] + uy * s[10] + uz * s[11]
    least = _FLATTEST / max(core[0], core[1], core[2])
    k11, k12, k22 = s[12] + least, s[13], s[14] + least
    out[side] = c11 * (k11 * c11 + k12 * c12) + c12 * (k12 * c11 + k22 * c12)
    out[side + 1] = out[side + 2] = c11 * (k11 * c21 + k12 * c22) + c12 * (k12 * c21 + k22 * c22)
    out[side + 3] = c21 * (k11 * c21 + k12 * c22) + c22 * (k12 * c21 + k22 * c22)
    # with a radius r the turn grows by r times the slide
    out[side + 4], out[side + 7] = 1.0 + core[RADIUS] * out[side], 1.0 + core[RADIUS] * out[side + 3]
    out[side + 5] = out[side + 6] = core[RADIUS] * out[side + 1]
