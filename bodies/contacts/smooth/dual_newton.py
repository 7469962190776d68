"""Newton's method on the support functions of two bodies, of which one at least is smooth.

The gap is the largest value of g(n) = n . X - h_A(n) - h_B(-n) over the unit vectors n.  X is the vector from the
centre of body A to that of body B; h_A and h_B are the support functions, H_A and H_B their second derivatives.  Let d
be the vector from the support point of A to that of B.  On the unit sphere the gradient of g is r = d - g n, and the
second derivative is -(H_A + H_B + g).  A Newton step delta of n solves (H_A + H_B + g) delta = r.

If the bodies are apart, g has one maximum.  If they overlap a little, the gap is the maximum near the line of centres.
"""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...shapes.support_function import support_of
from ...vectors import Vector3
from ..features.frames import tangent_of
from .smooth_core import Axes, back, bend, forth

_STEPS = 100
_HALVINGS = 40
_WIDEST = 1.0
"""Longest step in the tangent plane of the unit sphere, before it is projected back to the sphere."""
_ROUND_OFF = 2e-16
_SEEN = 1e-14
"""Difference of two evaluations of g that is round-off, relative to the size of the bodies."""
_CLOSE = 1e-12
"""Residual, relative to the size of the bodies, below which Newton's method ends once a step no longer halves it.

Below this bound, round-off limits the residual.
"""
_RIGHT = 1e-13
"""Residual, relative to the size of the bodies, above which a result of Newton's method is rejected."""
_SADDLE = 0.3
"""Angle by which the search leaves a stationary direction that is not a maximum of g [rad]."""


@compiled
def climb(
    first: Floats, second: Floats, turn: Axes, place: Vector3, axis: Vector3, start: Vector3
) -> tuple[float, float, float, float]:
    """Return the largest gap g(n) [m] and its direction n, in the axes of the first core; nan if none was found.

    Parameters
    ----------
    first, second : Floats
        The cores; their radii are not used.
    turn : Axes
        Rotation from the axes of the second core to those of the first.
    place : Vector3
        The second core's centre from the first's [m].
    axis : Vector3
        A unit vector to which n stays perpendicular, such as an edge; zero if n is free.
    start : Vector3
        Start of n, of any length; as a rule along the line of centres.
    """
    (x, y, z), (along_x, along_y, along_z), (start_x, start_y, start_z) = place, axis, start
    free = along_x == 0.0 and along_y == 0.0 and along_z == 0.0
    along = start_x * along_x + start_y * along_y + start_z * along_z
    nx, ny, nz = start_x - along * along_x, start_y - along * along_y, start_z - along * along_z
    length = math.sqrt(nx * nx + ny * ny + nz * nz)
    if length <= _CLOSE * (abs(start_x) + abs(start_y) + abs(start_z)):
        nx, ny, nz = tangent_of((along_x, along_y, along_z))
        length = math.sqrt(nx * nx + ny * ny + nz * nz)
    nx, ny, nz = nx / length, ny / length, nz / length
    size = abs(x) + abs(y) + abs(z) + max(first[0], first[1], first[2]) + max(second[0], second[1], second[2])
    g, before = -math.inf, math.inf
    # direction and step of the last iteration
    lx, ly, lz, sx, sy, sz = nx, ny, nz, 0.0, 0.0, 0.0
    halvings = 0
    for _ in range(_STEPS):
        a = support_of(first, (nx, ny, nz))
        mx, my, mz = back(turn, (-nx, -ny, -nz))
        b = support_of(second, (mx, my, mz))
        dx, dy, dz = forth(turn, (b[1], b[2], b[3]))
        dx, dy, dz = x + dx - a[1], y + dy - a[2], z + dz - a[3]
        found = nx * dx + ny * dy + nz * dz
        if found < g - _SEEN * size and halvings < _HALVINGS:
            halvings += 1
            sx, sy, sz = 0.5 * sx, 0.5 * sy, 0.5 * sz
        else:
            g, halvings = found, 0
            lx, ly, lz = nx, ny, nz
            if free:
                tx, ty, tz = tangent_of((nx, ny, nz))
                ux, uy, uz = ny * tz - nz * ty, nz * tx - nx * tz, nx * ty - ny * tx
            else:
                ux, uy, uz = along_x, along_y, along_z
                tx, ty, tz = uy * nz - uz * ny, uz * nx - ux * nz, ux * ny - uy * nx
            r, s = tx * dx + ty * dy + tz * dz, ux * dx + uy * dy + uz * dz
            px, py, pz = back(turn, (tx, ty, tz))
            tt = bend(a, tx, ty, tz, tx, ty, tz) + bend(b, px, py, pz, px, py, pz) + g
            tu, uu = 0.0, size
            if free:
                qx, qy, qz = back(turn, (ux, uy, uz))
                tu = bend(a, tx, ty, tz, ux, uy, uz) + bend(b, px, py, pz, qx, qy, qz)
                uu = bend(a, ux, uy, uz, ux, uy, uz) + bend(b, qx, qy, qz, qx, qy, qz) + g
            else:
                s = 0.0
            residual = math.sqrt(r * r + s * s)
            # the eigenvalues, low <= high, and the angle of the latter's vector
            middle, half = 0.5 * (tt + uu), 0.5 * (tt - uu)
            spread = math.sqrt(half * half + tu * tu)
            low, high = middle - spread, middle + spread
            angle = 0.5 * math.atan2(tu, half)
            cosine, sine = math.cos(angle), math.sin(angle)
            over, under = cosine * r + sine * s, cosine * s - sine * r
            least = _ROUND_OFF * size
            if residual <= _ROUND_OFF * size or (residual <= _CLOSE * size and residual >= 0.5 * before):
                if residual > _RIGHT * size:
                    return math.nan, nx, ny, nz
                if low >= -_CLOSE * size:
                    return g, nx, ny, nz
                # a stationary point that is not a maximum: leave it along the direction in which g grows most
                over, under = 0.0, _SADDLE
                before = math.inf
            else:
                over, under = over / max(abs(high), least), under / max(abs(low), least)
                before = residual
            r, s = cosine * over - sine * under, sine * over + cosine * under
            length = math.sqrt(r * r + s * s)
            if length > _WIDEST:
                r, s = r * _WIDEST / length, s * _WIDEST / length
            sx, sy, sz = r * tx + s * ux, r * ty + s * uy, r * tz + s * uz
        nx, ny, nz = lx + sx, ly + sy, lz + sz
        length = math.sqrt(nx * nx + ny * ny + nz * nz)
        nx, ny, nz = nx / length, ny / length, nz / length
    return math.nan, nx, ny, nz
