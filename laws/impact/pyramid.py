"""The contact problem with pyramids in place of Coulomb's cones, solved by Lemke's method.

With pyramids it is a linear complementarity problem (Stewart and Trinkle, Anitescu and Potra).  Lemke's method ends at
a solution, or on a ray if there is none.  The problem of an inelastic impact has a solution, unless driven bodies
squeeze a free one.
"""

from __future__ import annotations

import math

import numpy as np

from nonsmooth.compiled import compiled
from nonsmooth.types import Array

_FACETS = 8
_PARTS = _FACETS + 2
"""Number of unknowns of a contact: normal impulse, friction impulse along each facet, slip speed."""
_PIVOTS = 50
"""Largest number of pivots of Lemke's method, per unknown of the complementarity problem; it stops cycles."""
_ZERO = 1e-11
_APART = (1e-9, 1e-7, 1e-5, 1e-3)
"""Perturbations of the complementarity problem in successive trials, relative to its largest right-hand side.

A trial increases every right-hand side by a different amount of this order.  Otherwise equal ratios and round-off would
mislead the choice of pivots.
"""


@compiled
def _angle(facet: int, a: int, narrow: float, p1: float, p2: float) -> float:
    """Return the direction of a facet of a pyramid in the tangent plane [rad].

    If ``narrow`` is 0, the facets are evenly spaced, and turned by a small angle that depends on the contact's number
    ``a``.  Else five facets form a fan about the direction of the friction impulse (p1, p2), at the angles 0, +-narrow
    and +-4 narrow [rad].  Three further facets at 90, 180 and 270 degrees from this direction complete the pyramid.
    """
    if narrow == 0.0:
        return 2.0 * math.pi * facet / _FACETS + 0.1 * a
    towards = math.atan2(p2, p1)
    if facet < 5:
        return towards + (facet - 2) * abs(facet - 2) * narrow
    return towards + 0.5 * math.pi * (facet - 4)


@compiled
def solve_on_pyramids(
    n: int, matrix: Array, free: Array, base: Array, least: Array, friction: Array, narrow: float, p: Array
) -> int:
    """Solve the impact problem on pyramids inside the friction cones; return 1 for a solution, 0 for none.

    If Lemke's method ends on a ray, the problem has no solution.

    ``p`` holds an estimate of the impulses on entry, and the solution on return [N s].  ``narrow`` is the angle between
    the facets about the direction of the estimated friction impulse [rad], or 0 for evenly spaced facets.  The other
    arguments are those of :func:`laws.impact.natural_map.find_zero`.
    """
    width, m = 3 * n, _PARTS * n
    ways, weights, offsets, z = np.zeros((width, m)), np.zeros((m, m)), np.zeros(m), np.zeros(m)
    start = base.copy()
    for a in range(n):
        i, first = 3 * a, _PARTS * a
        # the unknown impulses of a contact are scaled by 1 / sqrt(G_NN), so that their coefficients are of order 1
        unit = 1.0 / math.sqrt(matrix[i, i])
        ways[i, first] = unit
        for facet in range(_FACETS):
            angle = _angle(facet, a, narrow, p[i + 1] - base[i + 1], p[i + 2] - base[i + 2])
            ways[i + 1, first + 1 + facet] = unit * math.cos(angle)
            ways[i + 2, first + 1 + facet] = unit * math.sin(angle)
        start[i] = least[a]
    rates, made = free.copy(), np.zeros((width, m))
    for i in range(width):
        for j in range(width):
            rates[i] += matrix[i, j] * start[j]
            for c in range(m):
                made[i, c] += matrix[i, j] * ways[j, c]
    largest = 0.0
    for r in range(m):
        for i in range(width):
            if ways[i, r] != 0.0:
                offsets[r] += ways[i, r] * rates[i]
                for c in range(m):
                    weights[r, c] += ways[i, r] * made[i, c]
        largest = max(largest, abs(offsets[r]))
    for a in range(n):
        first = _PARTS * a
        last = first + _PARTS - 1
        for r in range(first + 1, last):
            weights[r, last], weights[last, r] = 1.0, -1.0
        weights[last, first] = friction[a]
        offsets[last] = friction[a] * (least[a] - base[3 * a]) / ways[3 * a, first]
    for apart in _APART:
        for r in range(m):
            offsets[r] += apart * largest * (1.0 + math.sin(7.0 * r))
        if _lemke(m, weights, offsets, z) == 1:
            for i in range(width):
                p[i] = start[i]
                for c in range(m):
                    p[i] += ways[i, c] * z[c]
            return 1
    return 0


@compiled
def _lemke(m: int, weights: Array, offsets: Array, z: Array) -> int:
    """Find z >= 0 with w = weights z + offsets >= 0 and z w = 0 by Lemke's pivots; return 1 if it is found, else 0.

    The columns of the tableau are w, z, the artificial unknown and the right-hand side.
    """
    artificial, right = 2 * m, 2 * m + 1
    table, basis = np.zeros((m, 2 * m + 2)), np.zeros(m, np.int64)
    leaves, least = -1, 0.0
    for r in range(m):
        basis[r] = r
        table[r, r] = 1.0
        for c in range(m):
            table[r, m + c] = -weights[r, c]
        table[r, artificial], table[r, right] = -1.0 - 0.3 * math.sin(1.0 + r), offsets[r]
        if -offsets[r] / table[r, artificial] < least:
            leaves, least = r, -offsets[r] / table[r, artificial]
    enters = artificial
    if leaves < 0:
        return 1
    for _pivot in range(_PIVOTS * m):
        pivot = table[leaves, enters]
        for c in range(2 * m + 2):
            table[leaves, c] /= pivot
        for r in range(m):
            factor = table[r, enters]
            if r != leaves and factor != 0.0:
                for c in range(2 * m + 2):
                    table[r, c] -= factor * table[leaves, c]
        left, basis[leaves] = basis[leaves], enters
        if left == artificial:
            for r in range(m):
                if basis[r] >= m:
                    z[basis[r] - m] = max(0.0, table[r, right])
            return 1
        enters = left + m if left < m else left - m
        leaves = -1
        for r in range(m):
            if table[r, enters] <= _ZERO:
                continue
            ratio = max(0.0, table[r, right]) / table[r, enters]
            if leaves < 0 or ratio < least or (ratio == least and basis[r] == artificial):
                leaves, least = r, ratio
        if leaves < 0:
            return 0
    return 0
