"""Linear systems: elimination within a band, small dense systems, and least norm if the matrix is singular.

Matrices and vectors are stored among the floats of the workspace. An argument named as a matrix or a vector is the
offset of its first entry.
"""

from __future__ import annotations

import math

from nonsmooth.engine.native.kernel import Floats, kernel
from nonsmooth.engine.numerics.arrays import clear, largest_size, subtract_part
from nonsmooth.engine.numerics.vectors import Vector

SINGULAR = 1e-10
"""Pivots and remaining columns below this, relative to the largest, count as zero."""


@kernel("f8(F, f8, i8, i8, i8)")
def product(floats: Floats, total: float, a: int, b: int, n: int) -> float:
    """Scalar product of two vectors of ``n`` numbers, added to ``total``. The six of a free body need no loop."""
    if n == 6:
        total += floats[a] * floats[b]
        total = total + floats[a + 1] * floats[b + 1] + floats[a + 2] * floats[b + 2]
        return total + floats[a + 3] * floats[b + 3] + floats[a + 4] * floats[b + 4] + floats[a + 5] * floats[b + 5]
    for i in range(n):
        total += floats[a + i] * floats[b + i]
    return total


@kernel("i8(i8, i8)")
def band_width(n: int, half: int) -> int:
    """Length of a stored row of ``n`` columns: ``half`` left of the diagonal, twice that right of it, at most n."""
    return min(n, 3 * half + 1)


@kernel("i8(i8, i8, i8, i8)")
def band_row(a: int, i: int, n: int, half: int) -> int:
    """Offset of the (possibly not stored) column 0 of row ``i`` in the band at ``a``.

    The entry of column j, which must lie within the band, is at this offset plus j.
    """
    width = band_width(n, half)
    return a + i * width - min(max(0, i - half), n - width)


@kernel("void(F, i8, i8, i8, i8)")
def multiply(floats: Floats, a: int, n: int, x: int, out: int) -> None:
    """Write the symmetric matrix at ``a`` times the vector at ``x`` to ``out``, which must overlap neither of them."""
    if n == 6:
        x0, x1, x2, x3, x4, x5 = floats[x], floats[x + 1], floats[x + 2], floats[x + 3], floats[x + 4], floats[x + 5]
        for i in range(a, a + 6):
            first = floats[i] * x0 + floats[i + 6] * x1 + floats[i + 12] * x2
            floats[out - a + i] = first + floats[i + 18] * x3 + floats[i + 24] * x4 + floats[i + 30] * x5
        return
    for i in range(n):
        floats[out + i] = product(floats, 0.0, a + i * n, x, n)


@kernel("b1(F, i8, i8, i8, i8, f8)")
def eliminate(floats: Floats, a: int, n: int, half: int, x: int, least: float) -> bool:
    """Solve the banded system at ``a`` for the right-hand side at ``x``. False if the matrix is singular.

    Gaussian elimination with exchange of rows. Entries more than ``half`` from the diagonal are zero, and exchanges
    fill some of them. A pivot below ``least``, relative to the largest entry, counts as zero. The matrix is
    overwritten, and ``x`` becomes the solution.
    """
    largest = largest_size(floats, a, n * band_width(n, half))
    for j in range(n):
        own = band_row(a, j, n, half)
        below, right = min(n, j + half + 1), min(n, j + 2 * half + 1)
        pivot, best = j, own
        for i in range(j + 1, below):
            row = band_row(a, i, n, half)
            if abs(floats[row + j]) > abs(floats[best + j]):
                pivot, best = i, row
        if not abs(floats[best + j]) > least * largest:
            return False
        if pivot != j:
            for c in range(j, right):
                floats[own + c], floats[best + c] = floats[best + c], floats[own + c]
            floats[x + j], floats[x + pivot] = floats[x + pivot], floats[x + j]
        for i in range(j + 1, below):
            row = band_row(a, i, n, half)
            factor = floats[row + j] / floats[own + j]
            if factor != 0.0:
                for c in range(j + 1, right):
                    floats[row + c] -= factor * floats[own + c]
                floats[x + i] -= factor * floats[x + j]
    for j in range(n - 1, -1, -1):
        own = band_row(a, j, n, half)
        for c in range(j + 1, min(n, j + 2 * half + 1)):
            floats[x + j] -= floats[own + c] * floats[x + c]
        floats[x + j] /= floats[own + j]
    return True


@kernel("v3(v3, v3, v3, v3, f8)")
def solve_three(row_0: Vector, row_1: Vector, row_2: Vector, right: Vector, least: float) -> Vector:
    """Solution of a positive definite system of three equations, by L D L^T. Only its lower triangle is read.

    All three numbers are nan if a pivot is below ``least``, relative to the largest entry of the diagonal.
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
def rank_of_semidefinite(floats: Floats, a: int, n: int) -> int:
    """Rank of the positive semidefinite matrix at ``a``, which is overwritten: the number of nonzero pivots.

    Each pivot is the largest entry left on the diagonal. It counts as zero below ``SINGULAR`` times the largest pivot.
    """
    largest = 0.0
    for rank in range(n):
        best = rank
        for i in range(rank + 1, n):
            if floats[a + i * n + i] > floats[a + best * n + best]:
                best = i
        pivot = floats[a + best * n + best]
        largest = max(largest, pivot)
        if not pivot > SINGULAR * largest:
            return rank
        for c in range(n):
            floats[a + rank * n + c], floats[a + best * n + c] = floats[a + best * n + c], floats[a + rank * n + c]
        for i in range(n):
            floats[a + i * n + rank], floats[a + i * n + best] = floats[a + i * n + best], floats[a + i * n + rank]
        for i in range(rank + 1, n):
            factor = floats[a + i * n + rank] / pivot
            if factor != 0.0:
                for c in range(rank + 1, n):
                    floats[a + i * n + c] -= factor * floats[a + rank * n + c]
    return n


@kernel("void(F, i8, i8, i8)")
def transpose(floats: Floats, a: int, n: int, out: int) -> None:
    """Write the transpose of the matrix at ``a`` to ``out``."""
    for i in range(n):
        for j in range(n):
            floats[out + j * n + i] = floats[a + i * n + j]


@kernel("void(F, i8, i8, i8)")
def complete(floats: Floats, v: int, n: int, rank: int) -> None:
    """Complete the ``rank`` orthonormal rows of ``n`` numbers at ``v`` to a basis of all vectors.

    Each new row starts from the unit vector that the rows so far represent least.
    """
    for done in range(rank, n):
        best, most = 0, -math.inf
        for i in range(n):
            left = 1.0
            for c in range(done):
                left -= floats[v + c * n + i] ** 2
            if left > most:
                best, most = i, left
        row = v + done * n
        for i in range(n):
            floats[row + i] = 1.0 if i == best else 0.0
        # a second pass of Gram-Schmidt removes the round-off that the first leaves
        for _ in range(2):
            for c in range(done):
                subtract_part(floats, row, product(floats, 0.0, v + c * n, row, n), v + c * n, n)
        norm = math.sqrt(product(floats, 0.0, row, row, n))
        for i in range(n):
            floats[row + i] /= norm


@kernel("i8(F, i8, i8, i8, i8, i8, i8)")
def _triangulate(floats: Floats, a: int, n: int, b: int, r: int, marks: int, most: int) -> int:
    """Factorise A = Q R with the largest remaining column first. Returns the rank, at most ``most``.

    The matrix at ``a`` is stored by columns, ``n`` by n. The columns and the vector ``b`` lose their components along
    the columns chosen so far. Rows of R are written to ``r``. The first n numbers at ``marks`` become 1 for the chosen
    columns, 0 for the others; Q^T b follows them.
    """
    for j in range(n):
        floats[marks + j] = 0.0
    largest = 0.0
    for rank in range(most):
        best, size = -1, 0.0
        for j in range(n):
            if floats[marks + j] == 0.0:
                square = product(floats, 0.0, a + j * n, a + j * n, n)
                if square > size:
                    best, size = j, square
        norm = math.sqrt(size)
        largest = max(largest, norm)
        if best < 0 or not norm > SINGULAR * largest:
            return rank
        floats[marks + best] = 1.0
        chosen = a + best * n
        for i in range(n):
            floats[chosen + i] /= norm
        for j in range(n):
            floats[r + rank * n + j] = 0.0
            if floats[marks + j] == 0.0:
                # a second pass of Gram-Schmidt removes the round-off that the first leaves
                for _ in range(2):
                    part = product(floats, 0.0, chosen, a + j * n, n)
                    floats[r + rank * n + j] += part
                    subtract_part(floats, a + j * n, part, chosen, n)
        floats[r + rank * n + best] = norm
        total = product(floats, 0.0, chosen, b, n)
        floats[marks + n + rank] = total
        subtract_part(floats, b, total, chosen, n)
    return most


@kernel("i8(F, i8, i8, i8, i8, i8, i8, i8)")
def minimum_norm(floats: Floats, a: int, n: int, b: int, x: int, v: int, work: int, most: int) -> int:
    """Write the least-squares solution of A x = b of least norm to ``x``. Returns the rank of A, at most ``most``.

    A = Q R gives the components Q^T b, and R = L V the solution V^T L^-1 Q^T b. Both are orthogonal decompositions, so
    that the condition of A is not squared. The matrix at ``a`` is stored by columns; it and ``b`` are overwritten. The
    first rows at ``v`` become an orthonormal basis of the row space. ``work`` has 2 n numbers.
    """
    rank = _triangulate(floats, a, n, b, v, work, most)
    clear(floats, x, n)
    # R = L V: the rows are orthogonalised, and the forward substitution is done along with it
    for j in range(rank):
        row = v + j * n
        rest = floats[work + n + j]
        for _ in range(2):
            for c in range(j):
                part = product(floats, 0.0, v + c * n, row, n)
                rest -= part * floats[work + n + c]
                subtract_part(floats, row, part, v + c * n, n)
        norm = math.sqrt(product(floats, 0.0, row, row, n))
        for i in range(n):
            floats[row + i] /= norm
        floats[work + n + j] = rest / norm
        for i in range(n):
            floats[x + i] += floats[work + n + j] * floats[row + i]
    return rank
