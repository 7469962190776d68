"""Forces that are not unique, spread so that every contact keeps Coulomb's bound, the motion left as it is."""

from __future__ import annotations

import math

from nonsmooth.engine.kernel import Floats, Integers, Scalars, kernel, room
from nonsmooth.engine.linear import eliminate

_STEPS = 60
_FLOOR = 1e-9
"""Added to the Hessian, whose largest eigenvalue is 1, so that it can be inverted."""


@kernel("f8(S, F, I, i8, f8)")
def _excess(S: Scalars, w: Floats, k: Integers, n: int, inset: float) -> float:
    """Write f less its projection on the cones to ``right``; return half its square."""
    square = 0.0
    for i in range(n):
        line = k[S.column + i]
        a = line // 3
        if line != 3 * a:
            continue
        normal = w[S.f + line] - inset * k[S.redundant + a]
        w[S.right + i] = min(0.0, normal)
        if k[S.tangent_held + a] == 1:
            t1, t2 = w[S.f + line + 1], w[S.f + line + 2]
            mu, length = w[S.mu_static + a], math.sqrt(t1 * t1 + t2 * t2)
            w[S.right + i + 1] = w[S.right + i + 2] = 0.0
            if mu * length <= -normal:
                w[S.right + i + 1], w[S.right + i + 2] = t1, t2
            elif length > mu * normal:
                out = (length - mu * normal) / (1.0 + mu * mu)
                w[S.right + i] = -mu * out
                w[S.right + i + 1], w[S.right + i + 2] = out * t1 / length, out * t2 / length
            else:
                w[S.right + i] = 0.0
            square += w[S.right + i + 1] ** 2 + w[S.right + i + 2] ** 2
        square += w[S.right + i] ** 2
    return 0.5 * square


@kernel("void(S, F, I, i8, f8)")
def _curve(S: Scalars, w: Floats, k: Integers, n: int, inset: float) -> None:
    """Write the Hessian of the half square, block by block, to ``basis``."""
    for i in range(n * n):
        w[S.basis + i] = 0.0
    for i in range(n):
        line = k[S.column + i]
        a = line // 3
        if line != 3 * a:
            continue
        normal, h = w[S.f + line] - inset * k[S.redundant + a], S.basis + i * n + i
        if k[S.tangent_held + a] == 0:
            w[h] = 1.0 if normal < 0.0 else 0.0
            continue
        t1, t2 = w[S.f + line + 1], w[S.f + line + 2]
        mu, length = w[S.mu_static + a], math.sqrt(t1 * t1 + t2 * t2)
        if mu * length <= -normal:
            w[h] = w[h + n + 1] = w[h + 2 * n + 2] = 1.0
        elif length > mu * normal:
            s = 1.0 + mu * mu
            c1, c2 = t1 / length, t2 / length
            round_ = (length - mu * normal) / (s * length)
            w[h] = mu * mu / s
            w[h + 1] = w[h + n] = -mu * c1 / s
            w[h + 2] = w[h + 2 * n] = -mu * c2 / s
            w[h + n + 1] = c1 * c1 / s + round_ * c2 * c2
            w[h + 2 * n + 2] = c2 * c2 / s + round_ * c1 * c1
            w[h + n + 2] = w[h + 2 * n + 1] = c1 * c2 / s - round_ * c1 * c2


@kernel("void(F, i8, i8, i8, i8)")
def _multiply(w: Floats, left: int, right: int, out: int, n: int) -> None:
    for i in range(n):
        for j in range(n):
            total = 0.0
            for c in range(n):
                total += w[left + i * n + c] * w[right + c * n + j]
            w[out + i * n + j] = total


@room("i8(S, F, I, f8, f8)")
def spread(S: Scalars, w: Floats, k: Integers, inset: float, arrived: float) -> int:
    """Move the forces along the null space into the cones; return 1 if they arrive.

    ``f`` is the answer of least norm, ``null`` the projector on what may be added to it.  The half square of the
    distance to the cones, moved up by ``inset`` [N] where forces are not unique, is convex along the null space, and
    its smallest value is sought by Newton's method until no force is out by more than ``arrived`` [N].
    """
    n = S.n_unknown
    square = _excess(S, w, k, n, inset)
    for _step in range(_STEPS):
        worst = 0.0
        for i in range(n):
            worst = max(worst, abs(w[S.right + i]))
        if worst <= arrived:
            return 1
        _curve(S, w, k, n, inset)
        _multiply(w, S.basis, S.null, S.matrix, n)
        _multiply(w, S.null, S.matrix, S.basis, n)
        slope = 0.0
        for i in range(n):
            total = 0.0
            for j in range(n):
                total -= w[S.null + i * n + j] * w[S.right + j]
                w[S.matrix + i * n + j] = w[S.basis + i * n + j]
            w[S.matrix + i * n + i] += _FLOOR
            w[S.x + i] = total
            w[S.sigma + i] = total
        if eliminate(w, S.matrix, n, S.x) == 0:
            return 0
        # the elimination leaks out of the null space by round-off over the floor
        for i in range(n):
            w[S.matrix + i] = w[S.x + i]
        for i in range(n):
            w[S.x + i] = 0.0
            for j in range(n):
                w[S.x + i] += w[S.null + i * n + j] * w[S.matrix + j]
            slope -= w[S.sigma + i] * w[S.x + i]
        if not slope < 0.0:
            return 0
        share, moved = 1.0, 0
        for i in range(n):
            w[S.sigma + i] = w[S.f + k[S.column + i]]
        for _halving in range(30):
            for i in range(n):
                w[S.f + k[S.column + i]] = w[S.sigma + i] + share * w[S.x + i]
            new = _excess(S, w, k, n, inset)
            if new <= square + 1e-4 * share * slope:
                square, moved = new, 1
                break
            share *= 0.5
        if moved == 0:
            return 0
    return 0
