"""The gap of two smooth bodies of any kind, and the curvature of their surfaces.

Cores are of three kinds, by their powers (:mod:`bodies.shapes.support_function`): round cores have radii of curvature
everywhere, boxy cores have flat places, mixed cores have flat and sharp places.  The unknown of Newton's method is the
unit normal for round cores, and the surface point for a boxy core with a round one.  For other pairs it is the vector
of each body's chart (:mod:`bodies.contacts.smooth.chart`).
"""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...rotations import Axes, inverse, rotated, rotated_back
from ...shapes.support_function import Core, is_boxy, is_mixed, is_round, support_of
from ...vectors import Vector3, divided, dot, norm, opposite, plus, plus_scaled
from .boxy_line import Line, across_line
from .boxy_newton import gap_by_point, write_boxy
from .chart import write_chart
from .chart_newton import gap_by_chart
from .dual_newton import gap_by_normal
from .inscribed import is_least_overlap
from .overlap_proof import do_overlap
from .smooth_core import RADIUS, Cores, NearestPoint, semi_axes_of, spread, unit
from .smooth_starts import N_STARTS, Start, gap_along, largest_near, local_maximum, starts_of
from .tangent_plane import bends_in_plane, tangents_in, write_matrices

_DEEP = 1e-2
"""Overlap, relative to the least semi-axis, up to which a solution is accepted without a proof.

In a deeper overlap, a shorter translation could separate the bodies: see :mod:`bodies.contacts.smooth.inscribed`.
"""
_TOUCHING = 1e-12
"""Overlap, relative to the distance of the centres, up to which no proof is required.

So small an overlap is round-off of touching bodies, which may have no common point.
"""
_NEARBY = 0.05
"""Angle to a maximum of the gap at which Newton's method is restarted [rad]."""


@compiled
def largest_gap(cores: Cores) -> NearestPoint:
    """Return the largest gap of two cores over all directions [m], the second core's point [m] and the normal.

    If it is positive, it is the only maximum.  A negative gap is returned only if the bodies are proved to overlap
    (:mod:`bodies.contacts.smooth.overlap_proof`).  Overlapping bodies can have several maxima: each is a locally
    shortest translation that separates them.  If the first search fails, or its solution is not proved to be the
    shortest translation, the search also starts from directions with a large gap and from the axes of both bodies.  The
    gap is nan without a solution.
    """
    best = _from_ellipsoids(cores, cores.center) if _is_for_charts(cores) else _from_start(cores, cores.center)
    is_real = _is_real(cores, best[0])
    shallow = _DEEP * min(_thickness(cores.first), _thickness(cores.second))
    if best[0] >= 0.0 or (is_real and (best[0] >= -shallow or is_least_overlap(cores, best))):
        return best
    starts = starts_of(cores)
    for i in range(N_STARTS + 12):
        if i < N_STARTS:
            candidate = _near_start(cores, starts[i])
        else:
            candidate = _from_start(cores, _axis(cores.turn, i - N_STARTS))
        is_real = is_real or _is_real(cores, candidate[0])
        if candidate[0] == candidate[0] and not best[0] >= candidate[0]:
            best = candidate
            if best[0] >= 0.0 or (is_real and is_least_overlap(cores, best)):
                break
    return best[0] if is_real else math.nan, best[1], best[2]


@compiled
def _near_start(cores: Cores, start: Start) -> NearestPoint:
    """Return a maximum of the gap that is no less than the gap of a start, by searches ever closer to a maximum."""
    found = _from_start(cores, start[1])
    if not found[0] >= start[0]:
        # Newton's method went to a smaller maximum, or did not converge
        top = local_maximum(cores, start, _NEARBY)
        found = _from_start(cores, top[1])
        if not found[0] >= top[0]:
            found = _from_start(cores, largest_near(cores, top)[1])
    return found


@compiled
def _from_ellipsoids(cores: Cores, start: Vector3) -> NearestPoint:
    """Return the result of :func:`gap_by_chart` from the contact normal of ellipsoids with the cores' semi-axes.

    Their search starts in the direction ``start``, and converges from afar, because ellipsoids have neither flat nor
    sharp places.
    """
    (a, b, c, _, _), (u, v, w, _, _) = semi_axes_of(cores.first), semi_axes_of(cores.second)
    ellipsoids = Cores((a, b, c, 2.0, 2.0), (u, v, w, 2.0, 2.0), cores.turn, cores.center)
    return gap_by_chart(cores, gap_by_normal(ellipsoids, (0.0, 0.0, 0.0), start)[2])


@compiled
def _axis(turn: Axes, number: int) -> Vector3:
    """Return one of twelve directions, a unit vector in the axes of the first core.

    By ``number`` they are the axes of the first core, of the second, and the opposite directions of both.
    """
    i, sign = number % 3, 1.0 if number < 6 else -1.0
    e = sign if i == 0 else 0.0, sign if i == 1 else 0.0, sign if i == 2 else 0.0
    return rotated(turn, e) if number % 6 >= 3 else e


@compiled
def _is_real(cores: Cores, gap: float) -> bool:
    """Return whether the bodies have a common point if a gap is negative; one above ``-_TOUCHING`` needs no proof."""
    return bool(gap >= -_TOUCHING * spread(cores.center)) or (
        gap < 0.0 and do_overlap(cores.first, 0.0, cores.first, 0.0, cores)
    )


@compiled
def _thickness(core: Core) -> float:
    """Return the least semi-axis of a core [m]; infinite for a point or a circle, whose least semi-axis is 0."""
    least = min(core[0], core[1], core[2])
    return least if least > 0.0 else math.inf


@compiled
def _is_for_charts(cores: Cores) -> bool:
    """Return whether Newton's method needs charts: a core is mixed, or both are boxy."""
    first, second = cores.first, cores.second
    return bool(is_mixed(first) or is_mixed(second) or (is_boxy(first) and is_boxy(second)))


@compiled
def _from_start(cores: Cores, start: Vector3) -> NearestPoint:
    """Return a maximum of the gap [m], the second core's point [m] and the normal, from a direction of any length.

    The kinds of the cores decide the unknown of Newton's method (see the module).
    """
    if _is_for_charts(cores):
        return gap_by_chart(cores, start)
    if is_boxy(cores.first):
        g, p, n = gap_by_point(cores, start)
        return g, plus_scaled(p, g, n), n
    return widest_of_round(cores, start)


@compiled
def widest_of_round(cores: Cores, start: Vector3) -> NearestPoint:
    """Return the largest gap over all directions [m], the second core's point [m] and the normal.

    The first core is round; it may be a point or a circle.  The second core is of any kind.  The search starts in the
    direction ``start``, of any length.
    """
    first, second, turn, center = cores
    if is_mixed(second):
        return _of_mixed(cores, start)
    if is_boxy(second):
        # the boxy core is the first one of the search, with the normal that points out of it
        swapped = Cores(second, first, inverse(turn), rotated_back(turn, opposite(center)))
        g, p, n = gap_by_point(swapped, rotated_back(turn, opposite(start)))
        return g, plus(center, rotated(turn, p)), rotated(turn, opposite(n))
    return gap_by_normal(cores, (0.0, 0.0, 0.0), start)


@compiled
def _of_mixed(cores: Cores, start: Vector3) -> NearestPoint:
    """Return the result of :func:`widest_of_round` for a mixed second core, by searches ever closer to a maximum."""
    solution, n = _from_ellipsoids(cores, start), unit(start)
    if solution[0] != solution[0]:
        top = local_maximum(cores, (gap_along(cores, n), n), _NEARBY)
        solution = gap_by_chart(cores, top[1])
        if solution[0] != solution[0]:
            solution = gap_by_chart(cores, largest_near(cores, top)[1])
    return solution


@compiled
def widest_from(cores: Cores, axis: Vector3, start: Vector3) -> NearestPoint:
    """Return the gap of a line or a point and a core of any kind [m], the core's point [m] and the normal.

    The first core is the point.  The line goes through it along the unit vector ``axis``; there is no line if ``axis``
    is zero.  The search starts in the direction ``start``, of any length.
    """
    if is_round(cores.second):
        return gap_by_normal(cores, axis, start)
    if axis[0] == 0.0 and axis[1] == 0.0 and axis[2] == 0.0:
        return widest_of_round(cores, start)
    n = plus_scaled(start, -dot(start, axis), axis)
    length = norm(n)
    if length == 0.0:
        # the start is along the line, so that it gives no normal
        return math.nan, cores.center, start
    return across_line(cores, Line(axis, 1.0, 0.0, 0.0), divided(n, length))


@compiled
def write_surface(out: Floats, side: int, core: Core, axes: Axes, normal: Vector3, p: Vector3) -> None:
    """Write the curvature matrices of a core of any kind at its surface point p with the outward normal ``normal``.

    Point [m] and normal are in the core's axes.  ``side`` is the index of the matrices in the geometry block ``out``,
    which must already hold normal and first tangent; ``axes`` are the core's axes in the world.  For a round core,
    slide is the identity, and turn the matrix of the radii of curvature [m].
    """
    if is_mixed(core):
        write_chart(out, side, core, axes, normal)
    elif is_boxy(core):
        write_boxy(out, side, core, axes, p)
    else:
        h11, h12, h22 = bends_in_plane(support_of(core, normal)[2], *tangents_in(axes, out))
        write_matrices(out, side, (1.0, 0.0, 1.0), (h11 + core[RADIUS], h12, h22 + core[RADIUS]))
