"""Signed gap of two bodies at a pose, and of their shadows, by support functions alone."""

from __future__ import annotations

import functools
import itertools
import math

import numpy as np

from nonsmooth.interfaces.body import Vector
from tests.benchmarks.random_systems import convex
from tests.benchmarks.random_systems.gaps import directions
from tests.benchmarks.random_systems.pieces import Piece

Pose = tuple[Vector, Vector]
"""Place [m] and axes as columns."""
FAR = 1e-3
"""Gap [m] from which the pieces are only bounded."""
_ANGLES = 720
_SPREAD = directions()


def _of(one: Piece, two: Piece, first: Pose, second: Pose) -> tuple[tuple[Vector, ...], float]:
    """Return what the support functions of two pieces need, and the sum of the radii of their sweeps [m]."""
    axes = np.stack([first[1] @ one.axes, second[1] @ two.axes])
    between = second[0] + second[1] @ two.place - first[0] - first[1] @ one.place
    kinds, numbers = np.array([one.kind, two.kind]), np.stack([one.numbers, two.numbers])
    return (kinds, numbers, one.corners, two.corners, axes, between), one.sweep + two.sweep


def _gap(one: Piece, two: Piece, first: Pose, second: Pose, enough: float) -> tuple[float, Vector]:
    told, sweep = _of(one, two, first, second)
    way = np.array([0.0, 0.0, 1.0])
    lower, _ = convex.bounds(*told, 0.0, sweep + FAR, way)
    if lower >= sweep + FAR:
        return lower - sweep, way
    # faces that are parallel to an axis of a body are found exactly
    likely = np.concatenate([np.concatenate([axes.T, -axes.T]) for axes in (*told[4], first[1], second[1])])
    value, found = max((float(convex._plane(*told, d)) - sweep, k) for k, d in enumerate(likely))
    if value >= enough:
        return value, likely[found]
    return float(convex.overlap(*told, np.concatenate([likely, _SPREAD]), sweep, way)), way


def separation(
    ones: list[Piece], twos: list[Piece], first: Pose, second: Pose, enough: float = FAR
) -> tuple[float, Vector]:
    """Return the gap of two bodies [m], negative if they overlap, and its direction from the first to the second.

    Of bodies that are ``enough`` apart it may be a lower bound [m], no less than that.
    """
    found = (_gap(one, two, first, second, enough) for one, two in itertools.product(ones, twos))
    return min(found, key=lambda row: row[0])


def gap(ones: list[Piece], twos: list[Piece], first: Pose, second: Pose, enough: float = FAR) -> float:
    """Return the gap of two bodies [m], as :func:`separation` does."""
    return separation(ones, twos, first, second, enough)[0]


TOUCHES = -1e-11
"""Gap of bodies that touch, but for round-off [m]."""


def _shadow(one: Piece, two: Piece, first: Pose, second: Pose, way: Vector) -> float:
    told, sweep = _of(one, two, first, second)
    x = np.cross(way, np.eye(3)[int(np.argmin(np.abs(way)))])
    x /= np.linalg.norm(x)
    y = np.cross(way, x)

    def apart(angle: float) -> float:
        return float(convex._plane(*told, math.cos(angle) * x + math.sin(angle) * y))

    step = 2.0 * math.pi / _ANGLES
    starts = [(apart(k * step), k * step) for k in range(_ANGLES)]
    for axes in told[4]:
        starts += [(apart(a), a) for i in range(3) for a in (math.atan2(axes[:, i] @ y, axes[:, i] @ x),)]
        starts += [(apart(a), a) for i in range(3) for a in (math.atan2(-axes[:, i] @ y, -axes[:, i] @ x),)]
    best, angle = max(starts)
    while step > 1e-12:
        step *= 0.5
        best, angle = max((best, angle), *((apart(angle + s), angle + s) for s in (-step, step)))
    return best - sweep


def shadow_gap(ones: list[Piece], twos: list[Piece], first: Pose, second: Pose, way: Vector) -> float:
    """Return the gap of the shadows of two bodies along a direction [m]: positive if they pass each other along it."""
    look = functools.partial(_shadow, first=first, second=second, way=way)
    return min(look(one, two) for one, two in itertools.product(ones, twos))
