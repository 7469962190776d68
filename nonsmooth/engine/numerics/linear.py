"""Linear systems on the float heap: elimination within a band, and minimum norm where the matrix is singular."""

from __future__ import annotations

import math

from nonsmooth.engine.native.kernel import Floats, kernel
from nonsmooth.engine.numerics.vectors import Vector

SINGULAR = 1e-10
"""A pivot or remaining column below this, relative to the largest, counts as zero."""


@kernel("i8(i8, i8)")
def band_width(n: int, half: int) -> int:
    """Return the length of a stored row: ``half`` to the left, twice that to the right, all of it if that is less."""
    return min(n, 3 * half + 1)


@kernel("i8(i8, i8, i8, i8)")
def band_row(a: int, i: int, n: int, half: int) -> int:
    """Return where row ``i`` of the band at ``a`` would start if it were stored in full: add the column to it."""
    width = band_width(n, half)
    return a + i * width - min(max(0, i - half), n - width)


@kernel("f8(F, f8, i8, i8, i8)")
def product(w: Floats, total: float, a: int, b: int, n: int) -> float:
    """Return ``total`` plus the scalar product of two vectors of ``n`` numbers; the six of a free body need no loop."""
    if n == 6:
        total += w[a] * w[b]
        total = total + w[a + 1] * w[b + 1] + w[a + 2] * w[b + 2]
        return total + w[a + 3] * w[b + 3] + w[a + 4] * w[b + 4] + w[a + 5] * w[b + 5]
    for i in range(n):
        total += w[a + i] * w[b + i]
    return total


@kernel("void(F, i8, i8, i8, i8)")
def multiply(w: Floats, a: int, n: int, x: int, out: int) -> None:
    """Write the symmetric matrix at ``a`` times the vector at ``x`` to ``out``, which is none of them."""
    if n == 6:
        x0, x1, x2, x3, x4, x5 = w[x], w[x + 1], w[x + 2], w[x + 3], w[x + 4], w[x + 5]
        for i in range(a, a + 6):
            first = w[i] * x0 + w[i + 6] * x1 + w[i + 12] * x2
            w[out - a + i] = first + w[i + 18] * x3 + w[i + 24] * x4 + w[i + 30] * x5
        return
    for i in range(n):
        w[out + i] = product(w, 0.0, a + i * n, x, n)


@kernel("b1(F, i8, i8, i8, i8, f8)")
def eliminate(w: Floats, a: int, n: int, half: int, x: int, least: float) -> bool:
    """Solve the banded system at ``a`` with right-hand side at ``x``, both overwritten; return 1, or 0 if singular.

    Entries farther than ``half`` off the diagonal are zero; exchanges of rows fill some of them.  A pivot below
    ``least``, relative to the largest entry, counts as zero.
    """
    width = band_width(n, half)
    largest = 0.0
    for i in range(n * width):
        largest = max(largest, abs(w[a + i]))
    for j in range(n):
        own = band_row(a, j, n, half)
        below, right = min(n, j + half + 1), min(n, j + 2 * half + 1)
        pivot, best = j, own
        for i in range(j + 1, below):
            row = band_row(a, i, n, half)
            if abs(w[row + j]) > abs(w[best + j]):
                pivot, best = i, row
        if not abs(w[best + j]) > least * largest:
            return False
        if pivot != j:
            for c in range(j, right):
                w[own + c], w[best + c] = w[best + c], w[own + c]
            w[x + j], w[x + pivot] = w[x + pivot], w[x + j]
        for i in range(j + 1, below):
            row = band_row(a, i, n, half)
            factor = w[row + j] / w[own + j]
            if factor != 0.0:
                for c in range(j + 1, right):
                    w[row + c] -= factor * w[own + c]
                w[x + i] -= factor * w[x + j]
    for j in range(n - 1, -1, -1):
        own = band_row(a, j, n, half)
        for c in range(j + 1, min(n, j + 2 * half + 1)):
            w[x + j] -= w[own + c] * w[x + c]
        w[x + j] /= w[own + j]
    return True


@kernel("v3(v3, v3, v3, v3, f8)")
def solve_three(row_0: Vector, row_1: Vector, row_2: Vector, right: Vector, least: float) -> Vector:
    """Solve a positive definite system of three, of which the lower triangle is read, by L D L^T.

    What is returned is no number if a pivot is below ``least``, relative to the largest entry.
    """
    g00, g10, g11 = row_0[0], row_1[0], row_1[1]
    g20, g21, g22 = row_2
    smallest = least * max(g00, max(g11, g22))
    if not g00 > smallest:
        return math.nan, math.nan, math.nan
    l10, l20 = g10 / g00, g20 / g00
    d1, e = g11 - l10 * g10, g21 - l20 * g10
    if not d1 > smallest:
        return math.nan, math.nan, math.nan
    l21 = e / d1
    d2 = g22 - l20 * g20 - l21 * e
    if not d2 > smallest:
        return math.nan, math.nan, math.nan
    y1 = right[1] - l10 * right[0]
    x2 = (right[2] - l20 * right[0] - l21 * y1) / d2
    x1 = y1 / d1 - l21 * x2
    return right[0] / g00 - l10 * x1 - l20 * x2, x1, x2


@kernel("i8(F, i8, i8)")
def rank_of_semidefinite(w: Floats, a: int, n: int) -> int:
    """Return the rank of the positive semidefinite matrix at ``a``, which is overwritten; largest pivots come first."""
    largest = 0.0
    for rank in range(n):
        best = rank
        for i in range(rank + 1, n):
            if w[a + i * n + i] > w[a + best * n + best]:
                best = i
        pivot = w[a + best * n + best]
        largest = max(largest, pivot)
        if not pivot > SINGULAR * largest:
            return rank
        for c in range(n):
            w[a + rank * n + c], w[a + best * n + c] = w[a + best * n + c], w[a + rank * n + c]
        for i in range(n):
            w[a + i * n + rank], w[a + i * n + best] = w[a + i * n + best], w[a + i * n + rank]
        for i in range(rank + 1, n):
            factor = w[a + i * n + rank] / pivot
            if factor != 0.0:
                for c in range(rank + 1, n):
                    w[a + i * n + c] -= factor * w[a + rank * n + c]
    return n


@kernel("void(F, i8, i8, i8)")
def transpose(w: Floats, a: int, n: int, out: int) -> None:
    """Write the transpose of the matrix at ``a`` to ``out``."""
    for i in range(n):
        for j in range(n):
            w[out + j * n + i] = w[a + i * n + j]


@kernel("void(F, i8, f8, i8, i8)")
def subtract_part(w: Floats, out: int, part: float, a: int, n: int) -> None:
    """Subtract ``part`` of a vector of ``n`` numbers from another one."""
    for i in range(n):
        w[out + i] -= part * w[a + i]


@kernel("void(F, i8, i8, i8)")
def complete(w: Floats, v: int, n: int, rank: int) -> None:
    """Complete the ``rank`` orthonormal rows of ``n`` numbers at ``v`` to a basis of all vectors."""
    for done in range(rank, n):
        best, most = 0, -math.inf
        for i in range(n):
            left = 1.0
            for c in range(done):
                left -= w[v + c * n + i] ** 2
            if left > most:
                best, most = i, left
        row = v + done * n
        for i in range(n):
            w[row + i] = 1.0 if i == best else 0.0
        # twice is enough
        for _time in range(2):
            for c in range(done):
                subtract_part(w, row, product(w, 0.0, v + c * n, row, n), v + c * n, n)
        norm = math.sqrt(product(w, 0.0, row, row, n))
        for i in range(n):
            w[row + i] /= norm


@kernel("i8(F, i8, i8, i8, i8, i8, i8)")
def _triangulate(w: Floats, a: int, n: int, b: int, r: int, marks: int, most: int) -> int:
    """Write A = Q R with the largest remaining column first; return the rank, ``most`` at most.

    The columns of ``a``, of which each stands by itself, lose what the columns chosen so far explain of them, and so
    does ``b``; rows of R go to ``r``, and behind the n-th entry of ``marks`` the components Q^T b.
    """
    for j in range(n):
        w[marks + j] = 0.0
    largest = 0.0
    for rank in range(most):
        best, size = -1, 0.0
        for j in range(n):
            if w[marks + j] == 0.0:
                square = product(w, 0.0, a + j * n, a + j * n, n)
                if square > size:
                    best, size = j, square
        norm = math.sqrt(size)
        largest = max(largest, norm)
        if best < 0 or not norm > SINGULAR * largest:
            return rank
        w[marks + best] = 1.0
        chosen = a + best * n
        for i in range(n):
            w[chosen + i] /= norm
        for j in range(n):
            w[r + rank * n + j] = 0.0
            if w[marks + j] == 0.0:
                # twice is enough
                for _time in range(2):
                    part = product(w, 0.0, chosen, a + j * n, n)
                    w[r + rank * n + j] += part
                    subtract_part(w, a + j * n, part, chosen, n)
        w[r + rank * n + best] = norm
        total = product(w, 0.0, chosen, b, n)
        w[marks + n + rank] = total
        subtract_part(w, b, total, chosen, n)
    return most


@kernel("i8(F, i8, i8, i8, i8, i8, i8, i8)")
def minimum_norm(w: Floats, a: int, n: int, b: int, x: int, v: int, work: int, most: int) -> int:
    """Least-squares solution of least norm, by orthogonal decompositions; return the rank, ``most`` at most.

    The matrix at ``a`` is stored by columns; it and ``b`` are overwritten.  ``v`` receives an orthonormal basis of the
    row space in its first rows, ``x`` the solution; ``work`` holds 2 n floats.
    """
    rank = _triangulate(w, a, n, b, v, work, most)
    for i in range(n):
        w[x + i] = 0.0
    # rows R = L V: forward substitution goes along with the orthogonalisation of the rows
    for j in range(rank):
        row = v + j * n
        rest = w[work + n + j]
        for _time in range(2):
            for c in range(j):
                part = product(w, 0.0, v + c * n, row, n)
                rest -= part * w[work + n + c]
                subtract_part(w, row, part, v + c * n, n)
        norm = math.sqrt(product(w, 0.0, row, row, n))
        for i in range(n):
            w[row + i] /= norm
        w[work + n + j] = rest / norm
        for i in range(n):
            w[x + i] += w[work + n + j] * w[row + i]
    return rank
