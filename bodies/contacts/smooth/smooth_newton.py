"""The gap of two smooth bodies of any kind, and the curvature of their surfaces.

Cores are of three kinds, by their powers (:mod:`bodies.shapes.support_function`): round cores have radii of curvature
everywhere, boxy cores have flat places, mixed cores have flat and sharp places.  The unknown of Newton's method is the
unit normal for round cores, the surface point for boxy cores, and the chart's vector for mixed cores
(:mod:`bodies.contacts.smooth.chart`).
"""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import GAP, NORMAL, POINT_A, POINT_B, SIDE_B
from nonsmooth.types import Floats

from ...shapes.support_function import Core, is_boxy, is_mixed, is_round, support_of
from ...vectors import Vector3, divided, dot, minus, norm, opposite, plus, plus_scaled, scaled, write_vector
from ..features.frames import point_in_world, vector_in_world, write_tangent
from .boxy_line import across_line
from .boxy_newton import climb_boxy, write_boxy
from .boxy_pair import meet
from .chart import write_chart
from .chart_newton import meet_in_charts
from .dual_newton import climb
from .inscribed import gauge, no_shorter_way
from .overlap_proof import do_overlap
from .smooth_core import (
    POINT,
    RADIUS,
    Axes,
    NearestPoint,
    SemiAxes,
    facing_point,
    inverse,
    rotated,
    rotated_back,
    semi_axes_of,
    spread,
    unit,
)
from .smooth_starts import gap_along, settle, starts_of, uphill
from .tangent_plane import bends_in_plane, tangents_in, write_matrices

_DEEP = 1e-2
"""Overlap, relative to the least semi-axis, up to which a solution is accepted without a proof.

In a deeper overlap, a shorter translation could separate the bodies: see :mod:`bodies.contacts.smooth.inscribed`.
"""

_TOUCHING = 1e-12
"""Overlap, relative to the distance of the centres, up to which no proof is required.

So small an overlap is round-off of touching bodies, which may have no common point.
"""

_TOPS = 4
"""Directions with large gaps from which the search begins, before the twelve axes of both bodies."""
_THIN = 4.0
_BURIED = 0.5
"""Limits above which the search also starts along the axes of both bodies, to find a larger gap than the one found.

``_THIN``: ratio of the largest to the least semi-axis.  ``_BURIED``: ratio of the overlap to the least semi-axis.
"""
_NEARBY, _NEXT_TO = 0.05, 1e-6
"""Accuracy of the direction from which Newton's method is restarted, as its angle to a maximum of the gap [rad].

``_NEARBY``: first restart.  ``_NEXT_TO``: further restarts, for mixed cores only.
"""
_FEW_STEPS, _MANY_STEPS = 4, 24
"""Numbers of steps in which the powers of two cores are changed from 2 (ellipsoids) to their own values.

If a core is mixed (one power below 2, the other above) and the direct search fails, the gap is followed through these
steps: first through the few, which cost less, then through the many.
"""
_ON_AXIS, _SUNK = 1e-5, 0.2
"""A maximum of the gap on the axis of a circle is rejected: it belongs to the middle of the disc, not to its rim.

``_ON_AXIS``: angle to the axis up to which a maximum is on the axis [rad].  ``_SUNK``: largest overlap, relative to the
least semi-axis, in which maxima are tested.
"""
_SAMPLES = 8
"""Number of equal parts into which the line between both contact points is divided, to find a common point."""
_ON_SURFACE = 1e-12
"""Largest deviation of the gauge from 1 at a point of the surface: round-off."""


@compiled
def widest(first: Core, second: Core, turn: Axes, center: Vector3) -> NearestPoint:
    """Return the gap of two cores [m], the second core's point [m] and the normal, in the axes of the first core.

    The gap is the largest one over all directions.  If it is positive, it is the only maximum.  A negative gap is
    returned only if the bodies are proved to overlap (:mod:`bodies.contacts.smooth.overlap_proof`).  Overlapping bodies
    can have several maxima: each is a locally shortest translation that separates them.  If the first search fails, or
    its solution is not proved to be the shortest translation, the search also starts from directions with a large gap.
    The gap is nan if no solution was found.

    Parameters
    ----------
    first, second, turn, center : Floats, Axes, Vector3
        See :mod:`bodies.contacts.smooth.smooth_core`; the radii of the cores are not used.
    """
    is_any_mixed = is_mixed(first) or is_mixed(second)
    best = _from_centers(first, second, turn, center)
    is_proved = _has_common_point(first, second, turn, center, best)
    if best[0] >= 0.0 or (best[0] >= -_DEEP * _thickness(first, second) and is_proved):
        return best
    if is_proved and no_shorter_way(first, second, turn, center, best):
        return best
    starts, is_thin = starts_of(first, second, turn, center), _is_thin(first, second)
    is_deep = best[0] < -_BURIED * _thickness(first, second)
    first_axis = 2 * _TOPS if is_any_mixed else _TOPS
    # attempts: directions with a large gap; for mixed cores the maxima next to them; from number ``first_axis`` on, the
    # twelve axes; for mixed cores a last search
    for attempt in range(first_axis + (13 if is_any_mixed else 12)):
        if is_proved and best[0] == best[0] and attempt >= _TOPS:
            # the overlap is proved: only a thin or deep body can have a larger gap, along one of the axes
            if attempt == first_axis + 12 or not (is_thin or is_deep):
                break
            if attempt < first_axis:
                continue
        if attempt == first_axis + 12:
            candidate = _in_charts(first, second, turn, center, center)
        elif attempt >= first_axis:
            candidate = _from_start(first, second, turn, center, _axis(turn, attempt - first_axis))
        elif attempt >= _TOPS:
            _, n = uphill(first, second, turn, center, starts[attempt - _TOPS], _NEXT_TO)
            candidate = _from_start(first, second, turn, center, n)
        else:
            start_gap, n = starts[attempt]
            candidate = _from_start(first, second, turn, center, n)
            if not candidate[0] >= start_gap:
                # Newton's method went to a smaller maximum, or did not converge
                _, n = uphill(first, second, turn, center, starts[attempt], _NEARBY)
                candidate = _from_start(first, second, turn, center, n)
        is_proved = is_proved or _has_common_point(first, second, turn, center, candidate)
        if candidate[0] == candidate[0] and not best[0] >= candidate[0]:
            best = candidate
            if best[0] >= 0.0 or (is_proved and no_shorter_way(first, second, turn, center, best)):
                return best
    is_proved = is_proved or (best[0] < 0.0 and do_overlap((first, 0.0, first, 0.0, second, turn, center)))
    return best[0] if is_proved else math.nan, best[1], best[2]


@compiled
def _axis(turn: Axes, number: int) -> Vector3:
    """Return one of twelve directions, a unit vector in the axes of the first core.

    By ``number`` they are the axes of the first core, of the second, and the opposite directions of both.
    """
    i, sign = number % 3, 1.0 if number < 6 else -1.0
    e = sign if i == 0 else 0.0, sign if i == 1 else 0.0, sign if i == 2 else 0.0
    return rotated(turn, e) if number % 6 >= 3 else e


@compiled
def _is_thin(first: Core, second: Core) -> bool:
    """Return whether the largest semi-axis of both cores exceeds the least one by more than the factor ``_THIN``."""
    longest = max(max(first[0], first[1], first[2]), max(second[0], second[1], second[2]))
    return bool(longest > _THIN * _thickness(first, second))


@compiled
def _has_common_point(first: Core, second: Core, turn: Axes, center: Vector3, solution: NearestPoint) -> bool:
    """Return whether a point between the two points of a solution belongs to both bodies.

    A gap above ``-_TOUCHING`` needs no such point.
    """
    g, q, n = solution
    if g >= -_TOUCHING * spread(center):
        return True
    for i in range(_SAMPLES + 1):
        # from the first body's point to the second's
        p = plus_scaled(q, -(g * (1.0 - i / _SAMPLES)), n)
        if (
            gauge(second, rotated_back(turn, minus(p, center))) <= 1.0 + _ON_SURFACE
            and gauge(first, p) <= 1.0 + _ON_SURFACE
        ):
            return True
    return False


@compiled
def _thickness(first: Core, second: Core) -> float:
    """Return the least semi-axis of two cores [m]; a point or a circle, whose least semi-axis is 0, does not count."""
    a, b = min(first[0], first[1], first[2]), min(second[0], second[1], second[2])
    return a if b == 0.0 or (a > 0.0 and a < b) else b


@compiled
def _ellipsoid_of(core: Core) -> SemiAxes:
    """Return the ellipsoid with the semi-axes of a core."""
    return core[0], core[1], core[2], 2.0, 2.0


@compiled
def _from_centers(first: Core, second: Core, turn: Axes, center: Vector3) -> NearestPoint:
    """Return the largest gap over all directions [m], the second core's point [m] and the normal.

    The search starts along the line of centres.  For a mixed core it starts with the normal of two ellipsoids with the
    semi-axes of the cores, which is found first.
    """
    if not (is_mixed(first) or is_mixed(second)):
        return _from_start(first, second, turn, center, center)
    g, n = climb(_ellipsoid_of(first), _ellipsoid_of(second), turn, center, (0.0, 0.0, 0.0), center)
    solution = (g, center, n)
    if g == g:
        solution = _by_steps(first, second, turn, center, n, 0)
    return solution


@compiled
def _from_start(first: Core, second: Core, turn: Axes, center: Vector3, start: Vector3) -> NearestPoint:
    """Return the largest gap over all directions [m], the second core's point [m] and the normal.

    The search starts in the direction ``start``, of any length.  The kinds of the cores decide the unknown of Newton's
    method (see the module).
    """
    if is_mixed(first) or is_mixed(second):
        return _by_steps(first, second, turn, center, start, 0)
    if is_boxy(first):
        if is_boxy(second):
            g, p, n = _of_two_boxy(first, second, turn, center, start)
        else:
            g, p, n = climb_boxy(first, second, turn, center, start)
        # p is the point of the first core
        return g, plus_scaled(p, g, n), n
    return widest_of_round(first, second, turn, center, start)


@compiled
def _in_charts(first: Core, second: Core, turn: Axes, center: Vector3, start: Vector3) -> NearestPoint:
    """Return the largest gap over all directions [m], the second core's point [m] and the normal, if a core is mixed.

    A mixed core has one power below 2 and one above, so that it has flat and sharp places.  The search starts with the
    contact normal of two ellipsoids that have the semi-axes of the cores; this normal is searched from the direction
    ``start``.  If the first core is a circle (the rim of a frustum), a maximum along the circle's axis gives nan: it is
    the gap to the middle of the disc, not to the rim.  Each further search is made only if the one before fails.
    """
    solution = meet_in_charts(_ellipsoid_of(first), _ellipsoid_of(second), turn, center, start, 0)
    if solution[0] == solution[0]:
        solution = _by_steps(first, second, turn, center, solution[2], 0)
    # a circle: start from the maximum next to ``start``, unless it is on the axis
    if solution[0] != solution[0] and first[0] > 0.0 and first[2] == 0.0:
        n = unit(start)
        g, n = uphill(first, second, turn, center, (gap_along(first, second, turn, center, n), n), _NEXT_TO)
        is_shallow = g >= -_SUNK * _thickness(first, second)
        if is_shallow and max(abs(n[0]), abs(n[1])) < _ON_AXIS:
            return math.nan, center, n
        if is_shallow:
            solution = _by_steps(first, second, turn, center, n, 0)
    # change ellipsoids into the cores step by step
    if solution[0] != solution[0]:
        solution = _by_steps(first, second, turn, center, start, _FEW_STEPS)
    if solution[0] != solution[0] and dot(center, center) > 0.0:
        solution = _by_steps(first, second, turn, center, center, _MANY_STEPS)
    if solution[0] != solution[0]:
        for top in starts_of(first, second, turn, center):
            _, n = uphill(first, second, turn, center, top, _NEXT_TO)
            solution = _by_steps(first, second, turn, center, n, 0)
            if solution[0] >= 0.0:
                return solution
    return solution


@compiled
def _by_steps(first: Core, second: Core, turn: Axes, center: Vector3, start: Vector3, steps: int) -> NearestPoint:
    """Return gap [m], second core's point [m] and normal by Newton's method in charts, from the direction ``start``.

    If it fails, it is repeated with ellipsoids whose powers are changed in a number of ``steps`` from 2 to those of the
    cores.  Without steps the gap is then nan.
    """
    g, p, n = meet_in_charts(semi_axes_of(first), semi_axes_of(second), turn, center, start, steps)
    return g, plus_scaled(p, g, n), n


@compiled
def widest_of_round(first: Core, second: Core, turn: Axes, center: Vector3, start: Vector3) -> NearestPoint:
    """Return the largest gap over all directions [m], the second core's point [m] and the normal.

    The first core is round; it may be a point or a circle.  The second core is of any kind.  The search starts in the
    direction ``start``, of any length.
    """
    if is_mixed(second) or is_boxy(second):
        if is_mixed(second):
            solution = _in_charts(first, second, turn, center, start)
        else:
            solution = _from_boxy(first, second, turn, center, start)
        # a point: the ellipsoid method needs no derivatives
        if solution[0] != solution[0] and first[0] == 0.0:
            solution = _by_ellipses(first, second, turn, center, start)
        return solution
    g, n = climb(first, second, turn, center, (0.0, 0.0, 0.0), start)
    p, _ = facing_point(second, turn, center, n)
    return g, p, n


@compiled
def _from_boxy(first: Core, second: Core, turn: Axes, center: Vector3, start: Vector3) -> NearestPoint:
    """Return the largest gap over all directions [m], the second core's point [m] and the normal.

    The second core is boxy: the unknown of Newton's method is the point of its surface.  The search starts in the
    direction ``start``.
    """
    # climb_boxy computes in the axes of the boxy core, with the normal that points out of it
    to_first, begin = rotated_back(turn, opposite(center)), rotated_back(turn, opposite(start))
    g, p, n = climb_boxy(second, first, inverse(turn), to_first, begin)
    return g, plus(center, rotated(turn, p)), rotated(turn, opposite(n))


@compiled
def _by_ellipses(point: Core, core: Core, turn: Axes, center: Vector3, start: Vector3) -> NearestPoint:
    """Return gap [m], point [m] and normal of a core and a point outside of it, by the ellipsoid method.

    Newton's method fails near a pole of a core with a power just under 2, where the curvatures fall to 0 over a very
    small distance.  The ellipsoid method needs no curvatures.  The gap is nan for a point inside, and if the result is
    not on the surface of the core.  The search starts in the direction ``start``, of any length.
    """
    n = unit(start)
    if gauge(core, rotated_back(turn, opposite(center))) <= 1.0:
        return math.nan, center, n
    top = uphill(point, core, turn, center, (gap_along(point, core, turn, center, n), n), _NEARBY)
    g, n = settle(point, core, turn, center, top)
    p = scaled(g, n)
    if not (g > 0.0 and abs(gauge(core, rotated_back(turn, minus(p, center))) - 1.0) <= _ON_SURFACE):
        g = math.nan
    return g, scaled(g, n), n


@compiled
def _of_two_boxy(first: Core, second: Core, turn: Axes, center: Vector3, start: Vector3) -> NearestPoint:
    """Return the gap of two boxy cores (with flat places) [m], the first core's point [m] and the normal.

    The search starts with the contact normal for which the second core is replaced by an ellipsoid.  If the search
    fails, it starts with the normal for which the first core is replaced instead.  The last searches start from the
    direction ``start``: from the support points along it, then from the surface points in this direction.
    """
    g, _, n = climb_boxy(first, _ellipsoid_of(second), turn, center, start)
    solution = _from_supports(first, second, turn, center, n)
    if g == g and solution[0] == solution[0]:
        return solution
    to_first, begin = rotated_back(turn, opposite(center)), rotated_back(turn, opposite(start))
    g, _, n = climb_boxy(second, _ellipsoid_of(first), inverse(turn), to_first, begin)
    solution = _from_supports(first, second, turn, center, rotated(turn, opposite(n)))
    if g == g and solution[0] == solution[0]:
        return solution
    solution = _from_supports(first, second, turn, center, start)
    if solution[0] != solution[0]:
        solution = meet(first, second, turn, center, start, opposite(start))
    return solution


@compiled
def _from_supports(first: Core, second: Core, turn: Axes, center: Vector3, start: Vector3) -> NearestPoint:
    """Return the gap of two boxy cores [m], the first core's point [m] and the normal.

    Newton's method starts at the support point of the first core along ``start``, and of the second core against it.
    """
    n = unit(start)
    _, p, _ = support_of(first, n)
    _, q, _ = support_of(second, rotated_back(turn, opposite(n)))
    return meet(first, second, turn, center, p, rotated(turn, q))


@compiled
def widest_from(core: Core, turn: Axes, center: Vector3, axis: Vector3, start: Vector3) -> NearestPoint:
    """Return the gap of a line or the origin and a core of any kind [m], the core's point [m] and the normal.

    The gap is measured from the line through the origin along the unit vector ``axis``, or from the origin if ``axis``
    is zero.  All vectors are in the axes of the line's body.  ``center`` is the centre of the core [m],
    ``turn`` the rotation from the core's axes.  The search starts in the direction ``start``, of any length.
    """
    if is_round(core):
        g, n = climb(POINT, core, turn, center, axis, start)
        p, _ = facing_point(core, turn, center, n)
        return g, p, n
    if axis[0] == 0.0 and axis[1] == 0.0 and axis[2] == 0.0:
        return widest_of_round(POINT, core, turn, center, start)
    n = plus_scaled(start, -dot(start, axis), axis)
    length = norm(n)
    if length == 0.0:
        # the start is along the line, so that it gives no normal
        return math.nan, center, start
    return across_line(core, turn, center, axis, divided(n, length), 1.0, 0.0, 0.0)


@compiled
def write_core(out: Floats, side: int, core: Core, axes: Axes, normal: Vector3) -> None:
    """Write the curvature matrices slide and turn of a smooth body, along both tangents of the contact.

    ``normal`` is the body's outward normal in the axes of the core.  Slide is the identity.  Turn is the matrix of the
    radii of curvature [m]: the second derivative of the support function at the normal, plus the core's radius.  The
    geometry block ``out`` must already hold normal and first tangent; ``axes`` are the core's axes in the world.
    """
    _, _, h = support_of(core, normal)
    t, u = tangents_in(axes, out)
    h11, h12, h22 = bends_in_plane(h, t, u)
    write_matrices(out, side, (1.0, 0.0, 1.0), (h11 + core[RADIUS], h12, h22 + core[RADIUS]))


@compiled
def write_surface(out: Floats, side: int, core: Core, axes: Axes, normal: Vector3, p: Vector3) -> None:
    """Write the curvature matrices of a core of any kind at its surface point p with the outward normal ``normal``.

    Point [m] and normal are in the core's axes.  ``side`` is the index of the matrices in the geometry block ``out``,
    which must already hold normal and first tangent; ``axes`` are the core's axes in the world.
    """
    if is_mixed(core):
        write_chart(out, side, core, axes, normal)
    elif is_boxy(core):
        write_boxy(out, side, core, axes, p)
    else:
        write_core(out, side, core, axes, normal)


@compiled
def write_smooth(
    a: Floats, out: Floats, gap: float, core: Floats, axes: Axes, turn: Axes, center: Vector3, n: Vector3, p: Vector3
) -> None:
    """Write the geometry block of body ``a`` and a smooth body, except for the curvature of the surface of ``a``.

    ``gap`` is the gap of the surfaces [m], ``n`` the normal and ``p`` the point of the smooth body's core [m], both in
    the axes of the first body.  ``axes`` are the core's axes in the world, ``turn`` and ``center`` its rotation and
    centre as in :mod:`bodies.contacts.smooth.smooth_core`.
    """
    normal = vector_in_world(a, n)
    point = plus_scaled(point_in_world(a, p), -core[RADIUS], normal)
    out[GAP] = gap
    write_vector(out, NORMAL, normal)
    write_vector(out, POINT_B, point)
    write_vector(out, POINT_A, plus_scaled(point, -gap, normal))
    write_tangent(a, out)
    write_surface(out, SIDE_B, core, axes, rotated_back(turn, opposite(n)), rotated_back(turn, minus(p, center)))
