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

from nonsmooth.interfaces.body import Vector

CORNERS, FRUSTUM, NORM = 0, 1, 2
_STEPS = 120
SHRINK = 2e-5
"""Part by which cores are made smaller, so that solids in touch are apart: as much of the size is overlooked."""


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
def _nearest(points: Vector, n: int, v: Vector) -> int:
    """Write the point nearest to the origin of the simplex of the first n points; keep those that carry it.

    All faces are tried: of a few points that is as fast as any rule, and none is left out by round-off.
    """
    best, chosen = math.inf, 0
    weights, kept = np.zeros(4), np.zeros(4)
    index = np.zeros(4, dtype=np.int64)
    gram, right, trial = np.empty((3, 3)), np.empty(3), np.empty(3)
    for subset in range(1, 1 << n):
        m = 0
        for k in range(n):
            if subset >> k & 1:
                index[m] = k
                m += 1
        base = points[index[0]]
        for i in range(m - 1):
            e = points[index[i + 1]] - base
            right[i] = -(e[0] * base[0] + e[1] * base[1] + e[2] * base[2])
            for j in range(m - 1):
                f = points[index[j + 1]] - base
                gram[i, j] = e[0] * f[0] + e[1] * f[1] + e[2] * f[2]
        good = True
        # elimination; a face that is next to degenerate is left to its own faces
        for i in range(m - 1):
            if not gram[i, i] > 1e-13 * (abs(right[i]) + gram[i, i]) or gram[i, i] < 1e-26:
                good = False
                break
            for j in range(i + 1, m - 1):
                factor = gram[j, i] / gram[i, i]
                for k in range(i, m - 1):
                    gram[j, k] -= factor * gram[i, k]
                right[j] -= factor * right[i]
        if not good:
            continue
        rest = 1.0
        for i in range(m - 2, -1, -1):
            s = right[i]
            for k in range(i + 1, m - 1):
                s -= gram[i, k] * weights[k + 1]
            weights[i + 1] = s / gram[i, i]
            rest -= weights[i + 1]
            good = good and weights[i + 1] >= 0.0
        weights[0] = rest
        if not good or rest < 0.0:
            continue
        for i in range(3):
            trial[i] = 0.0
            for k in range(m):
                trial[i] += weights[k] * points[index[k], i]
        size = trial[0] * trial[0] + trial[1] * trial[1] + trial[2] * trial[2]
        if size < best:
            best, chosen = size, subset
            v[0], v[1], v[2] = trial[0], trial[1], trial[2]
            kept[:] = weights
    m = 0
    for k in range(n):
        if chosen >> k & 1:
            points[m] = points[k]
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
    v[:] = d
    for _ in range(_STEPS):
        size = math.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
        if size < 1e-14:
            return min(lower, 0.0), 0.0
        v /= size
        if n > 0:
            upper = min(upper, size)
        _difference(kinds, numbers, one, two, axes, between, shrink, v, w)
        proved = v[0] * w[0] + v[1] * w[1] + v[2] * w[2]
        if proved > lower:
            lower = proved
            d[:] = v
        if lower >= enough or upper - lower <= 1e-10 * upper + 1e-12:
            break
        for k in range(n):
            if points[k, 0] == w[0] and points[k, 1] == w[1] and points[k, 2] == w[2]:
                return lower, upper
        points[n] = w
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
) -> Vector:
    """Return which of the poses no plane proves to be apart, of solids made smaller by a little, shape [n]."""
    n = len(places)
    left = np.zeros(n, dtype=np.bool_)
    axes, d = np.empty((2, 3, 3)), np.array([0.0, 0.0, 1.0])
    for k in range(n):
        away = places[k]
        far = math.sqrt(away[0] * away[0] + away[1] * away[1] + away[2] * away[2])
        if far > reach:
            continue
        axes[0], axes[1] = first[k], second[k]
        lower, _ = bounds(kinds, numbers, one, two, axes, away, SHRINK, sweep * (1.0 - SHRINK) + 1e-12, d)
        left[k] = not lower >= sweep * (1.0 - SHRINK)
    return left


@numba.njit(cache=True)  # type: ignore[untyped-decorator]
def overlap(
    kinds: Vector, numbers: Vector, one: Vector, two: Vector, axes: Vector, between: Vector, ways: Vector, sweep: float
) -> float:
    """Return the gap of two solids along the best direction that a search from many finds [m]; negative inside."""
    n_best = 6
    values, best = np.full(n_best, -math.inf), np.zeros((n_best, 3))
    w = np.empty(3)
    for k in range(len(ways)):
        _difference(kinds, numbers, one, two, axes, between, 0.0, ways[k], w)
        value = ways[k, 0] * w[0] + ways[k, 1] * w[1] + ways[k, 2] * w[2]
        worst = int(np.argmin(values))
        if value > values[worst]:
            values[worst] = value
            best[worst] = ways[k]
    for k in range(n_best):
        d, step = best[k].copy(), 0.1
        side, other, trial = np.empty(3), np.empty(3), np.empty(3)
        for _ in range(10 * _STEPS):
            if step < 1e-9:
                break
            better = False
            least = int(np.argmin(np.abs(d)))
            e = np.zeros(3)
            e[least] = 1.0
            side[:] = np.cross(d, e)
            side /= np.linalg.norm(side)
            other[:] = np.cross(d, side)
            for turn in range(8):
                angle = turn * math.pi / 4.0
                trial[:] = d + step * (math.cos(angle) * side + math.sin(angle) * other)
                trial /= np.linalg.norm(trial)
                _difference(kinds, numbers, one, two, axes, between, 0.0, trial, w)
                value = trial[0] * w[0] + trial[1] * w[1] + trial[2] * w[2]
                if value > values[k] + 1e-12:
                    values[k] = value
                    d[:] = trial
                    better = True
                    break
            if not better:
                step *= 0.5
    return float(np.max(values)) - sweep
