"""Whether two convex solids are apart, by support functions alone (Gilbert, Johnson and Keerthi).

References
----------
E. G. Gilbert, D. W. Johnson, S. S. Keerthi, "A fast procedure for computing the distance between complex objects in
three-dimensional space", IEEE Journal of Robotics and Automation 4 (1988) 193-203.
"""

from __future__ import annotations

import math

import numba
import numpy as np
from numpy.typing import NDArray

from nonsmooth.interfaces.body import Vector

CORNERS, FRUSTUM, NORM = 0, 1, 2
_STEPS = 120
SHRINK = 2e-5
"""Part by which cores are made smaller, so that solids in touch are apart: as much of the size is overlooked."""

_APART = 0.1
"""Part of their overlap by which solids are moved farther apart than they overlap."""


@numba.njit(cache=True)  # type: ignore[untyped-decorator]
def _core(kind: int, numbers: Vector, corners: Vector, d: Vector, out: Vector) -> None:
    """Write the farthest point of a core along a direction, in its own axes."""
    if kind == CORNERS:
        best, far = 0, -math.inf
        for k in range(len(corners)):
            s = corners[k, 0] * d[0] + corners[k, 1] * d[1] + corners[k, 2] * d[2]
            if s > far:
                best, far = k, s
        out[0], out[1], out[2] = corners[best, 0], corners[best, 1], corners[best, 2]
    elif kind == FRUSTUM:
        flat = math.sqrt(d[0] * d[0] + d[1] * d[1])
        upper = numbers[2] * flat + numbers[3] * d[2] > numbers[0] * flat + numbers[1] * d[2]
        radius, out[2] = (numbers[2], numbers[3]) if upper else (numbers[0], numbers[1])
        out[0] = radius * d[0] / flat if flat > 0.0 else 0.0
        out[1] = radius * d[1] / flat if flat > 0.0 else 0.0
    else:
        # gradient of ((|a x|^q + |b y|^q)^(p/q) + |c z|^p)^(1/p), each sum relative to its larger part
        p, q = numbers[3], numbers[4]
        x, y, z = numbers[0] * abs(d[0]), numbers[1] * abs(d[1]), numbers[2] * abs(d[2])
        top = max(x, y)
        r = top * ((x / top) ** q + (y / top) ** q) ** (1.0 / q) if top > 0.0 else 0.0
        top = max(r, z)
        h = top * ((r / top) ** p + (z / top) ** p) ** (1.0 / p) if top > 0.0 else 1.0
        inner = (r / h) ** (p - 1.0)
        out[0] = math.copysign(numbers[0] * inner * ((x / r) ** (q - 1.0) if r > 0.0 else 0.0), d[0])
        out[1] = math.copysign(numbers[1] * inner * ((y / r) ** (q - 1.0) if r > 0.0 else 0.0), d[1])
        out[2] = math.copysign(numbers[2] * (z / h) ** (p - 1.0), d[2])


@numba.njit(cache=True)  # type: ignore[untyped-decorator]
def _difference(
    kinds: Vector,
    numbers: Vector,
    one: Vector,
    two: Vector,
    axes: Vector,
    between: Vector,
    shrink: float,
    d: Vector,
    out: Vector,
) -> None:
    """Write the point of (second core - first core) that is farthest against a direction: where its plane would be."""
    local, point = np.empty(3), np.empty(3)
    out[0], out[1], out[2] = between[0], between[1], between[2]
    for side in range(2):
        sign = 1.0 if side == 0 else -1.0
        for i in range(3):
            local[i] = sign * (axes[side, 0, i] * d[0] + axes[side, 1, i] * d[1] + axes[side, 2, i] * d[2])
        _core(kinds[side], numbers[side], one if side == 0 else two, local, point)
        for i in range(3):
            turned = axes[side, i, 0] * point[0] + axes[side, i, 1] * point[1] + axes[side, i, 2] * point[2]
            out[i] -= sign * (1.0 - shrink) * turned


@numba.njit(cache=True)  # type: ignore[untyped-decorator]
def _dot(a: Vector, b: Vector) -> float:
    return float(a[0] * b[0] + a[1] * b[1] + a[2] * b[2])


@numba.njit(cache=True)  # type: ignore[untyped-decorator]
def _weights(edges: Vector, right: Vector, m: int, weights: Vector) -> bool:
    """Write the weights of m + 1 points in the one nearest to the origin of their face, and whether it is inside."""
    gram = np.empty((3, 3))
    for i in range(m):
        for j in range(m):
            gram[i, j] = _dot(edges[i], edges[j])
    for i in range(m):
        # a face that is next to degenerate is left to its own faces
        if gram[i, i] <= 1e-13 * abs(right[i]) or gram[i, i] < 1e-26:
            return False
        for j in range(i + 1, m):
            factor = gram[j, i] / gram[i, i]
            for k in range(i, m):
                gram[j, k] -= factor * gram[i, k]
            right[j] -= factor * right[i]
    weights[0] = 1.0
    inside = True
    for i in range(m - 1, -1, -1):
        s = right[i]
        for k in range(i + 1, m):
            s -= gram[i, k] * weights[k + 1]
        weights[i + 1] = s / gram[i, i]
        weights[0] -= weights[i + 1]
        inside = inside and weights[i + 1] >= 0.0
    return inside and weights[0] >= 0.0


@numba.njit(cache=True)  # type: ignore[untyped-decorator]
def _nearest(points: Vector, n: int, v: Vector) -> int:
    """Write the point nearest to the origin of the simplex of the first n points; keep those that carry it.

    All faces are tried: of a few points that is as fast as any rule, and none is left out by round-off.
    """
    best, chosen = math.inf, 0
    weights, index = np.zeros(4), np.zeros(4, dtype=np.int64)
    edges, right, trial = np.empty((3, 3)), np.empty(3), np.empty(3)
    for subset in range(1, 1 << n):
        m = 0
        for k in range(n):
            if subset >> k & 1:
                index[m] = k
                m += 1
        for k in range(m - 1):
            for i in range(3):
                edges[k, i] = points[index[k + 1], i] - points[index[0], i]
            right[k] = -_dot(edges[k], points[index[0]])
        if not _weights(edges, right, m - 1, weights):
            continue
        for i in range(3):
            trial[i] = 0.0
            for k in range(m):
                trial[i] += weights[k] * points[index[k], i]
        if _dot(trial, trial) < best:
            best, chosen = _dot(trial, trial), subset
            for i in range(3):
                v[i] = trial[i]
    m = 0
    for k in range(n):
        if chosen >> k & 1:
            for i in range(3):
                points[m, i] = points[k, i]
            m += 1
    return m


@numba.njit(cache=True)  # type: ignore[untyped-decorator]
def bounds(
    kinds: Vector,
    numbers: Vector,
    one: Vector,
    two: Vector,
    axes: Vector,
    between: Vector,
    shrink: float,
    enough: float,
    d: Vector,
) -> tuple[float, float]:
    """Return bounds of the distance of two cores [m]: what a plane across ``d`` proves, and that of points in them.

    Ends as soon as the lower one is ``enough``; ``d`` is where the search begins, and then the best direction found
    from the first to the second.  A lower bound that is not positive proves nothing.
    """
    points, w, v = np.empty((4, 3)), np.empty(3), np.empty(3)
    lower, n = -math.inf, 0
    upper = math.inf
    for i in range(3):
        v[i] = d[i]
    for _ in range(_STEPS):
        size = math.sqrt(_dot(v, v))
        if size < 1e-14:
            return min(lower, 0.0), 0.0
        for i in range(3):
            v[i] /= size
        if n > 0:
            upper = min(upper, size)
        _difference(kinds, numbers, one, two, axes, between, shrink, v, w)
        proved = _dot(v, w)
        if proved > lower:
            lower = proved
            for i in range(3):
                d[i] = v[i]
        if lower >= enough or (n > 0 and upper - lower <= 1e-10 * upper + 1e-12):
            break
        for k in range(n):
            if points[k, 0] == w[0] and points[k, 1] == w[1] and points[k, 2] == w[2]:
                return lower, upper
        for i in range(3):
            points[n, i] = w[i]
        n = _nearest(points, n + 1, v)
        if n == 4:
            return min(lower, 0.0), 0.0
    return lower, upper


@numba.njit(cache=True)  # type: ignore[untyped-decorator]
def unproven(
    kinds: Vector,
    numbers: Vector,
    one: Vector,
    two: Vector,
    first: Vector,
    second: Vector,
    places: Vector,
    sweep: float,
    reach: float,
) -> NDArray[np.bool_]:
    """Return which of the poses no plane proves to be apart, of solids made smaller by a little, shape [n]."""
    n = len(places)
    left = np.zeros(n, dtype=np.bool_)
    axes, d, away = np.empty((2, 3, 3)), np.array([0.0, 0.0, 1.0]), np.empty(3)
    for k in range(n):
        for i in range(3):
            away[i] = places[k, i]
            for j in range(3):
                axes[0, i, j], axes[1, i, j] = first[k, i, j], second[k, i, j]
        if _dot(away, away) > reach * reach:
            continue
        enough = sweep * (1.0 - SHRINK) + 1e-12
        lower, _ = bounds(kinds, numbers, one, two, axes, away, SHRINK, enough, d)
        left[k] = not lower >= sweep * (1.0 - SHRINK)
    return left


@numba.njit(cache=True)  # type: ignore[untyped-decorator]
def _plane(kinds: Vector, numbers: Vector, one: Vector, two: Vector, axes: Vector, between: Vector, d: Vector) -> float:
    """Return the gap of two cores along a direction [m]."""
    w = np.empty(3)
    _difference(kinds, numbers, one, two, axes, between, 0.0, d, w)
    return float(_dot(d, w))


@numba.njit(cache=True)  # type: ignore[untyped-decorator]
def tangent(d: Vector, angle: float, step: float, out: Vector) -> None:
    """Write a unit vector that is off another one by about a step, to the side that an angle tells."""
    flat = math.sqrt(d[0] * d[0] + d[1] * d[1])
    x, y = (d[0] / flat, d[1] / flat) if flat > 1e-9 else (1.0, 0.0)
    along, across = step * math.cos(angle), step * math.sin(angle)
    out[0] = d[0] - along * y - across * x * d[2]
    out[1] = d[1] + along * x - across * y * d[2]
    out[2] = d[2] + across * flat
    size = math.sqrt(_dot(out, out))
    for i in range(3):
        out[i] /= size


@numba.njit(cache=True)  # type: ignore[untyped-decorator]
def _climbed(
    kinds: Vector, numbers: Vector, one: Vector, two: Vector, axes: Vector, between: Vector, d: Vector, value: float
) -> float:
    """Return the gap of two cores that overlap, from the direction ``d``, where it is the largest there is nearby.

    Moved apart along a direction by a little more than they overlap in it, solids have a distance; along its direction
    the gap is no less than along the one before.
    """
    apart, trial = np.empty(3), np.empty(3)
    for _ in range(_STEPS):
        way = max(-value, 0.0) + _APART * max(abs(value), 1e-6)
        for i in range(3):
            apart[i] = between[i] + way * d[i]
            trial[i] = d[i]
        bounds(kinds, numbers, one, two, axes, apart, 0.0, math.inf, trial)
        after = _plane(kinds, numbers, one, two, axes, between, trial)
        if not after > value + 1e-13:
            break
        value = after
        for i in range(3):
            d[i] = trial[i]
    return value


@numba.njit(cache=True)  # type: ignore[untyped-decorator]
def overlap(
    kinds: Vector,
    numbers: Vector,
    one: Vector,
    two: Vector,
    axes: Vector,
    between: Vector,
    ways: Vector,
    sweep: float,
    d: Vector,
) -> float:
    """Return the gap of two solids along the best direction that a search from many finds [m]; negative inside.

    Writes the direction, from the first to the second.

    The gap by direction has ridges where features change, along which small steps find no way up; so the ends of the
    search are climbed from by distances.
    """
    n_best = 6
    values, best = np.full(n_best, -math.inf), np.zeros((n_best, 3))
    for k in range(len(ways)):
        value = _plane(kinds, numbers, one, two, axes, between, ways[k])
        worst = 0
        for j in range(n_best):
            if values[j] < values[worst]:
                worst = j
        if value > values[worst]:
            values[worst] = value
            for i in range(3):
                best[worst, i] = ways[k, i]
    found, trial = -math.inf, np.empty(3)
    for k in range(n_best):
        step = 0.1
        for _ in range(10 * _STEPS):
            if step < 1e-9:
                break
            step *= 0.5
            # along two tangents and between them, there and back
            for turn in range(8):
                tangent(best[k], turn * math.pi / 4.0, step, trial)
                value = _plane(kinds, numbers, one, two, axes, between, trial)
                if value > values[k] + 1e-12:
                    values[k] = value
                    for i in range(3):
                        best[k, i] = trial[i]
                    step *= 2.0
                    break
        value = _climbed(kinds, numbers, one, two, axes, between, best[k], values[k])
        if value > found:
            found = value
            for i in range(3):
                d[i] = best[k, i]
    return float(found) - sweep
