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
from nonsmooth.types import Floats

from ...rotations import Axes, rotated_back
from ...shapes.support_function import Core, boxy_gauge_of
from ...vectors import Vector3, cross, divided, dot, minus, norm, plus, scaled
from ..features.frames import tangent_of
from .newton import RIGHT, has_ended
from .smooth_core import RADIUS, Cores, NearestPoint, facing_point, largest_semi_axis, size_of
from .tangent_plane import (
    Symmetric,
    along,
    bends_in_plane,
    determinant,
    from_tangents,
    in_plane,
    solved,
    tangents_in,
    turned_matrix,
    write_matrices,
)

_STEPS, _HALVINGS = 200, 40
"""Largest number of evaluations, and of successive halvings of one step."""
_SEEN = 1e-14
"""Difference of two distances of the contact points that is round-off, relative to the size of the bodies."""
_ENOUGH = 1e-4
"""Least decrease of the merit function by a step, relative to the decrease predicted by its derivative."""
_LONGEST = 0.5
"""Longest Newton step of the contact point, relative to the size of the boxy body: its surface is linearised."""
_LAST = 1e-6
"""Residual, relative to the size, below which the predicted decrease of the merit function is below its round-off."""
_FLATTEST = 1e-12
"""Curvature that is added to the curvature of a boxy core, relative to 1 / size.

Without it the curvature is 0 at flat places, but the engine divides by it in a contact with a plane.
"""

SurfacePoint: TypeAlias = tuple[Vector3, Vector3, Vector3, Vector3, Symmetric]
"""Point of a surface [m], unit normal, two unit tangents, and the shape operator along these [1/m]."""


@compiled
def place_on(core: Core, p: Vector3) -> SurfacePoint:
    """Return the point of a boxy core's surface in the direction p from the centre, with normal and shape operator.

    ``p`` is a vector of any length; all vectors are in the axes of the core.
    """
    f, gradient, bends = boxy_gauge_of(core, p)
    length = norm(gradient)
    n = divided(gradient, length)
    t = tangent_of(n)
    u = cross(n, t)
    # f is homogeneous: its second derivative at p / f is f times that at p
    return divided(p, f), n, t, u, scaled(f / length, bends_in_plane(bends, t, u))


@compiled
def gap_by_point(cores: Cores, start: Vector3) -> NearestPoint:
    """Return the gap of a boxy core and a round one [m], the point on the boxy core [m], and the normal from it.

    The boxy core is the first one.  The search starts at its point in the direction ``start``, of any length.  The gap
    is nan if the search fails.

    The unknown is the point p of the boxy core, with the normal n and the shape operator K.  The point q of the other
    core is the farthest in the direction -n; H is the second derivative of this core's support function.  The residual
    is the part of d = q - p in the tangent plane.  Newton's step delta solves (1 + (H + g) K) delta = residual, with
    the gap g = n . d.  A step is shortened until it decreases |d|^2 / 2, which is least at the result if the bodies are
    apart.
    """
    extent, size = largest_semi_axis(cores.first), size_of(cores)
    p, last_p, step = start, start, (0.0, 0.0, 0.0)
    # ``decrease``: the part _ENOUGH of the decrease of the merit |d|^2 / 2 that its derivative predicts for the step
    merit, decrease, last_residual, halvings = math.inf, 0.0, math.inf, 0
    for _ in range(_STEPS):
        p, n, t, u, (k11, k12, k22) = place_on(cores.first, p)
        q, bends = facing_point(cores, n)
        d = minus(q, p)
        new_merit = 0.5 * dot(d, d)
        round_off = _SEEN * size * (_SEEN * size + math.sqrt(new_merit))
        if new_merit > merit - decrease + round_off and halvings < _HALVINGS:
            halvings, step, decrease = halvings + 1, scaled(0.5, step), 0.5 * decrease
        else:
            merit, halvings, last_p = new_merit, 0, p
            g, (r, s) = dot(n, d), in_plane(t, u, d)
            residual = math.sqrt(r * r + s * s)
            h11, h12, h22 = bends_in_plane(bends, rotated_back(cores.turn, t), rotated_back(cores.turn, u))
            m11, m12 = 1.0 + (h11 + g) * k11 + h12 * k12, (h11 + g) * k12 + h12 * k22
            m21, m22 = h12 * k11 + (h22 + g) * k12, 1.0 + h12 * k12 + (h22 + g) * k22
            m = m11, m12, m21, m22
            det = determinant(m)
            if has_ended(residual, last_residual, size):
                # a stationary point that is not a maximum of the gap is not the shortest separating translation
                is_wrong = residual > RIGHT * size or det <= 0.0 or m11 + m22 <= 0.0
                return math.nan if is_wrong else g, p, n
            last_residual = residual
            # the derivative of the merit by p is -(1 + K H) (r, s)
            v, w = h11 * r + h12 * s, h12 * r + h22 * s
            gradient = r + k11 * v + k12 * w, s + k12 * v + k22 * w
            x, y = solved(m, det, (r, s)) if det > 0.0 else (r, s)
            decrease = gradient[0] * x + gradient[1] * y
            # Newton's step does not decrease the merit: take the steepest descent
            if decrease <= 0.0:
                x, y = gradient
                decrease = x * x + y * y
            length = math.sqrt(x * x + y * y)
            if length > _LONGEST * extent:
                shorter = _LONGEST * extent / length
                x, y, decrease = x * shorter, y * shorter, decrease * shorter
            decrease = 0.0 if residual <= _LAST * size else decrease * _ENOUGH
            step = along((x, y), t, u)
        p = plus(last_p, step)
    return math.nan, p, (0.0, 0.0, 1.0)


@compiled
def write_boxy(out: Floats, side: int, core: Core, axes: Axes, p: Vector3) -> None:
    """Write the curvature matrices of a boxy body: slide [1/m] is K + k, turn [1] is 1 + radius slide.

    K is the shape operator of its core; k = ``_FLATTEST`` / size keeps slide from 0 at flat points.  The contact point
    of the core is p [m]; ``axes`` are the axes of the core, to which p refers, in the world.  The geometry block
    ``out`` must already hold normal and first tangent; ``side`` is the index of the matrices in it.
    """
    _, _, first, second, (k11, k12, k22) = place_on(core, p)
    least = _FLATTEST / largest_semi_axis(core)
    slide = turned_matrix(from_tangents(*tangents_in(axes, out), first, second), (k11 + least, k12, k22 + least))
    write_matrices(out, side, slide, plus((1.0, 0.0, 1.0), scaled(core[RADIUS], slide)))
