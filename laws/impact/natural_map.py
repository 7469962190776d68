"""Impact problem with Coulomb's cone at velocity level, by Newton's method for a zero of its natural map.

G is the Delassus matrix, c are the given velocities, P the impulses, and xi = G P + c the velocities that result.
Impulses P are a solution if a step against xi, projected to the admissible impulses, returns P:

    P_N = max(least, P_N - xi_N / g_N),
    P_T = projection of P_T - xi_T / g_T on the disc of radius mu (P_N - base_N) about base_T,

``least`` is the lower bound of the normal impulse P_N, ``base`` the impulse about which the friction disc is centred.
g_N is the normal entry of the contact's diagonal block of G.  g_T is the trace of the tangential part of this block, or
g_N if the contact cannot move along the tangents.  The solutions do not depend on the values of g_N and g_T, which must
only be positive.
"""

from __future__ import annotations

import math

import numpy as np

from nonsmooth.compiled import compiled
from nonsmooth.types import Array

_EXACT = 1e-11
"""Largest residual of a solution, relative to the largest given velocity; ``_ROUND_OFF`` allows for round-off."""
_ROUND_OFF = 1e-15
"""Round-off of a residual for each unknown, which a solution's residual may also have.

It is relative to the largest velocity that an impulse causes at its own contact.
"""
_STEPS = 30
_HALVINGS = 10
_ROUNDS = 20
_UNBOUNDED = 1e5
"""Largest velocity that an impulse may cause at its own contact, relative to the largest given velocity.

If an impulse causes a larger one, the impulses count as unbounded: their round-off, 1e-10 of the given velocity,
exceeds the accuracy ``_EXACT`` required of a solution.
"""


@compiled
def _tangential_scale(matrix: Array, i: int) -> float:
    """Return the sum g_T of the two tangential diagonal entries of G [1/kg] for the contact whose normal row is i.

    If the sum is 0, return the normal entry: any positive scale serves a contact that cannot move along the tangents.
    """
    trace = matrix[i + 1, i + 1] + matrix[i + 2, i + 2]
    return trace if trace > 0.0 else matrix[i, i]  # type: ignore[no-any-return]


@compiled
def sweep(n: int, matrix: Array, free: Array, base: Array, least: Array, friction: Array, p: Array) -> None:
    """Improve the impulses ``p`` [N s] by one projected Gauss-Seidel sweep, as a start for Newton's method.

    The sweep updates the impulses of one contact after the other, with the other impulses fixed.  The arguments are
    those of :func:`find_zero`.
    """
    width = 3 * n
    for a in range(n):
        i = 3 * a
        x0 = free[i]
        for j in range(width):
            x0 += matrix[i, j] * p[j]
        p[i] = max(least[a], p[i] - x0 / matrix[i, i])
        x1, x2 = free[i + 1], free[i + 2]
        for j in range(width):
            x1 += matrix[i + 1, j] * p[j]
            x2 += matrix[i + 2, j] * p[j]
        across = _tangential_scale(matrix, i)
        q1, q2 = p[i + 1] - base[i + 1] - x1 / across, p[i + 2] - base[i + 2] - x2 / across
        size, radius = math.sqrt(q1 * q1 + q2 * q2), friction[a] * (p[i] - base[i])
        cut = radius / size if size > radius else 1.0
        p[i + 1], p[i + 2] = base[i + 1] + cut * q1, base[i + 2] + cut * q2


@compiled
def _miss(
    n: int,
    matrix: Array,
    free: Array,
    base: Array,
    least: Array,
    friction: Array,
    p: Array,
    missed: Array,
    slope: Array,
) -> float:
    """Write the residuals of the natural map at the impulses ``p``, and their derivatives; return the squared norm.

    The residuals ``missed`` are velocities [m/s], shape [3 n]; ``slope`` are their derivatives by the impulses [1/kg].
    The other arguments are those of :func:`find_zero`.
    """
    width = 3 * n
    square = 0.0
    for a in range(n):
        i = 3 * a
        own, across = matrix[i, i], _tangential_scale(matrix, i)
        x0, x1, x2 = free[i], free[i + 1], free[i + 2]
        for j in range(width):
            x0 += matrix[i, j] * p[j]
            x1 += matrix[i + 1, j] * p[j]
            x2 += matrix[i + 2, j] * p[j]
        normal = max(least[a], p[i] - x0 / own)
        pushed = normal > least[a]
        q1, q2 = p[i + 1] - base[i + 1] - x1 / across, p[i + 2] - base[i + 2] - x2 / across
        size, radius = math.sqrt(q1 * q1 + q2 * q2), friction[a] * max(0.0, normal - base[i])
        cut = radius / size if size > radius else 1.0
        missed[i] = own * (p[i] - normal)
        missed[i + 1] = across * (p[i + 1] - base[i + 1] - cut * q1)
        missed[i + 2] = across * (p[i + 2] - base[i + 2] - cut * q2)
        for r in range(i, i + 3):
            square += missed[r] ** 2
        c1, c2 = (q1 / size, q2 / size) if cut < 1.0 else (0.0, 0.0)
        turned = cut if cut < 1.0 else 0.0
        grown = friction[a] / own * across if pushed and cut < 1.0 else 0.0
        for j in range(width):
            g0, g1, g2 = matrix[i, j], matrix[i + 1, j], matrix[i + 2, j]
            z0 = (own if j == i else 0.0) - g0
            z1, z2 = (across if j == i + 1 else 0.0) - g1, (across if j == i + 2 else 0.0) - g2
            slope[i, j] = g0 if pushed else 0.0
            if cut < 1.0:
                round_ = turned * (c2 * z1 - c1 * z2)
                slope[i + 1, j] = -c2 * round_ - c1 * grown * z0
                slope[i + 2, j] = c1 * round_ - c2 * grown * z0
            else:
                slope[i + 1, j], slope[i + 2, j] = g1, g2
        if not pushed:
            slope[i, i] = own
        if cut < 1.0:
            slope[i + 1, i + 1] += across
            slope[i + 2, i + 2] += across
    return square


@compiled
def _largest_given(n: int, matrix: Array, free: Array, least: Array) -> float:
    """Return the scale of velocities [m/s]: the largest component of the given velocities, in two states.

    The states are: without impulses, and with the least normal impulses.
    """
    largest = 0.0
    for i in range(3 * n):
        given = free[i]
        for a in range(n):
            given += matrix[i, 3 * a] * least[a]
        largest = max(largest, abs(free[i]), abs(given))
    return largest


@compiled
def is_unbounded(n: int, matrix: Array, free: Array, least: Array, p: Array) -> bool:
    """Return True if the impulses ``p`` exceed the bound ``_UNBOUNDED``: no accurate solution has so large impulses.

    Their round-off exceeds the accuracy required by :func:`find_zero`, whose arguments these are.
    """
    bound = _UNBOUNDED * _largest_given(n, matrix, free, least)
    made = 0.0
    for i in range(3 * n):
        made = max(made, matrix[i, i] * abs(p[i]))
    return bool(made > bound)


@compiled
def find_zero(
    n: int,
    matrix: Array,
    free: Array,
    base: Array,
    least: Array,
    friction: Array,
    compliance: float,
    from_none: bool,
    p: Array,
) -> int:
    """Solve the equations of the natural map by Newton's method; return 1 if a solution was found, else 0.

    Impulses need not be unique.  Therefore Newton's method solves a regularised problem in each round, in which every
    contact has a small compliance: the velocities are G P + c + C (P - P_0).  C is a diagonal matrix, and P_0 are the
    impulses of the round before.  As the rounds converge, P - P_0 becomes 0, and the compliance has no effect.  If P_0
    is 0 in the first round, the solution has nearly the least norm.

    Parameters
    ----------
    n : int
        Number of contacts.
    matrix : array
        G [1/kg], shape [3 n, 3 n].
    free, base : array
        Given velocities c [m/s], and the impulses that are subtracted before the friction condition [N s], shape [3 n].
    least, friction : array
        Least normal impulses [N s], and coefficients mu, shape [n].
    compliance : float
        Entries of C, relative to g_N and g_T of the contact.
    from_none : bool
        True if P_0 is 0 in the first round, False if it is ``p``; Newton's method always starts from ``p``.
    p : array
        Impulses P: a start, then the solution [N s], shape [3 n].
    """
    width = 3 * n
    missed, slope, step, old = np.zeros(width), np.zeros((width, width)), np.zeros(width), np.zeros(width)
    soft, shifted, own = matrix.copy(), free.copy(), np.zeros(width)
    largest = _largest_given(n, matrix, free, least)
    for i in range(width):
        r = i - i % 3
        own[i] = matrix[i, i] if i == r else _tangential_scale(matrix, r)
        soft[i, i] += compliance * own[i]
    for rounds in range(_ROUNDS):
        kept = 0.0 if from_none and rounds == 0 else 1.0
        square = _miss(n, matrix, free, base, least, friction, p, missed, slope)
        size = largest
        for i in range(width):
            size = max(size, matrix[i, i] * abs(p[i]))
            shifted[i] = free[i] - kept * compliance * own[i] * p[i]
        if not size < _UNBOUNDED * largest and not (from_none and rounds == 0):
            return 0
        exact = (_EXACT * largest + _ROUND_OFF * width * size) ** 2
        if square <= exact and kept == 1.0:
            return 1
        square = _miss(n, soft, shifted, base, least, friction, p, missed, slope)
        for _step in range(_STEPS):
            if square <= 1e-4 * exact:
                break
            for i in range(width):
                step[i], old[i] = -missed[i], p[i]
            if _eliminate(width, slope, step) == 0:
                return 0
            share, new = 1.0, square
            for _halving in range(_HALVINGS):
                for i in range(width):
                    p[i] = old[i] + share * step[i]
                new = _miss(n, soft, shifted, base, least, friction, p, missed, slope)
                if new < (1.0 - 1e-4 * share) * square:
                    break
                share *= 0.5
            if not new < square:
                for i in range(width):
                    p[i] = old[i]
                if square > 1e4 * exact:
                    return 0
                break
            square = new
    return 0


@compiled
def _eliminate(n: int, a: Array, b: Array) -> int:
    """Solve a x = b into ``b`` by elimination with pivots; return 0 if ``a`` is singular."""
    for c in range(n):
        pivot = c
        for i in range(c + 1, n):
            if abs(a[i, c]) > abs(a[pivot, c]):
                pivot = i
        if a[pivot, c] == 0.0:
            return 0
        if pivot != c:
            for j in range(c, n):
                a[c, j], a[pivot, j] = a[pivot, j], a[c, j]
            b[c], b[pivot] = b[pivot], b[c]
        for i in range(c + 1, n):
            factor = a[i, c] / a[c, c]
            if factor != 0.0:
                for j in range(c, n):
                    a[i, j] -= factor * a[c, j]
                b[i] -= factor * b[c]
    for c in range(n - 1, -1, -1):
        for j in range(c + 1, n):
            b[c] -= a[c, j] * b[j]
        b[c] /= a[c, c]
    return 1
