"""Small dense linear systems on the float heap: elimination, and minimum norm where it is singular."""

from __future__ import annotations

import math

from nonsmooth.engine.kernel import Floats, kernel

SINGULAR = 1e-10
"""A pivot or singular value below this, relative to the largest, counts as zero."""


@kernel("i8(F, i8, i8, i8)")
def eliminate(w: Floats, a: int, n: int, x: int) -> int:
    """Solve the n x n system at ``a`` with right-hand side at ``x``, both overwritten; return 1, or 0 if singular."""
    largest = 0.0
    for i in range(n * n):
        largest = max(largest, abs(w[a + i]))
    for j in range(n):
        pivot = j
        for i in range(j + 1, n):
            if abs(w[a + i * n + j]) > abs(w[a + pivot * n + j]):
                pivot = i
        if not abs(w[a + pivot * n + j]) > SINGULAR * largest:
            return 0
        if pivot != j:
            for i in range(j, n):
                w[a + j * n + i], w[a + pivot * n + i] = w[a + pivot * n + i], w[a + j * n + i]
            w[x + j], w[x + pivot] = w[x + pivot], w[x + j]
        for i in range(j + 1, n):
            factor = w[a + i * n + j] / w[a + j * n + j]
            if factor != 0.0:
                for c in range(j + 1, n):
                    w[a + i * n + c] -= factor * w[a + j * n + c]
                w[x + i] -= factor * w[x + j]
    for j in range(n - 1, -1, -1):
        for c in range(j + 1, n):
            w[x + j] -= w[a + j * n + c] * w[x + c]
        w[x + j] /= w[a + j * n + j]
    return 1


@kernel("void(F, i8, i8, i8)")
def _orthogonalise(w: Floats, a: int, n: int, v: int) -> None:
    """Turn the columns of ``a`` orthogonal by plane rotations, collected in ``v`` (one-sided Jacobi)."""
    for i in range(n):
        for j in range(n):
            w[v + i * n + j] = 1.0 if i == j else 0.0
    for _sweep in range(60):
        rotated = 0
        for p in range(n - 1):
            for q in range(p + 1, n):
                alpha = beta = gamma = 0.0
                for i in range(n):
                    alpha += w[a + i * n + p] * w[a + i * n + p]
                    beta += w[a + i * n + q] * w[a + i * n + q]
                    gamma += w[a + i * n + p] * w[a + i * n + q]
                if abs(gamma) <= 1e-15 * math.sqrt(alpha * beta) or gamma == 0.0:
                    continue
                rotated = 1
                zeta = (beta - alpha) / (2.0 * gamma)
                t = 1.0 / (abs(zeta) + math.sqrt(1.0 + zeta * zeta))
                if zeta < 0.0:
                    t = -t
                c = 1.0 / math.sqrt(1.0 + t * t)
                s = c * t
                for block in (a, v):
                    for i in range(n):
                        left, right = w[block + i * n + p], w[block + i * n + q]
                        w[block + i * n + p] = c * left - s * right
                        w[block + i * n + q] = s * left + c * right
        if rotated == 0:
            return


@kernel("i8(F, i8, i8, i8, i8, i8, i8)")
def minimum_norm(w: Floats, a: int, n: int, b: int, x: int, v: int, sigma: int) -> int:
    """Least-squares solution of least norm by singular values; return the rank.

    ``a`` is overwritten; ``v`` receives the right singular vectors as columns, ``sigma`` the singular
    values with those that count as zero set to zero, ``x`` the solution.
    """
    _orthogonalise(w, a, n, v)
    largest = 0.0
    for j in range(n):
        square = 0.0
        for i in range(n):
            square += w[a + i * n + j] * w[a + i * n + j]
        w[sigma + j] = math.sqrt(square)
        largest = max(largest, w[sigma + j])
        w[x + j] = 0.0
    rank = 0
    for j in range(n):
        if not w[sigma + j] > SINGULAR * largest:
            w[sigma + j] = 0.0
            continue
        rank += 1
        projection = 0.0
        for i in range(n):
            projection += w[a + i * n + j] * w[b + i]
        projection /= w[sigma + j] * w[sigma + j]
        for i in range(n):
            w[x + i] += w[v + i * n + j] * projection
    return rank
