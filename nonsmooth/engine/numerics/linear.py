"""Linear systems: products, elimination within a band, and three equations.

Matrices and vectors are stored among the floats of the workspace. An argument named as a matrix or a vector is the
offset of its first entry.
"""

from __future__ import annotations

import math

from nonsmooth.engine.native.kernel import Floats, kernel
from nonsmooth.engine.numerics.arrays import largest_size
from nonsmooth.engine.numerics.vectors import Vector


@kernel("f8(F, f8, i8, i8, i8)")
def product(floats: Floats, total: float, a: int, b: int, n: int) -> float:
    """Sum of ``total`` and the scalar product of the vectors of ``n`` numbers at ``a`` and ``b``."""
    # the six velocities of a free body, the commonest case, are written out: the compiler unrolls no loops
    if n == 6:
        total += floats[a] * floats[b]
        total = total + floats[a + 1] * floats[b + 1] + floats[a + 2] * floats[b + 2]
        return total + floats[a + 3] * floats[b + 3] + floats[a + 4] * floats[b + 4] + floats[a + 5] * floats[b + 5]
    for i in range(n):
        total += floats[a + i] * floats[b + i]
    return total


@kernel("i8(i8, i8)")
def band_width(n: int, half: int) -> int:
    """Number of stored entries in each row of a band matrix of ``n`` columns and half width ``half``."""
    # ``half`` left of the diagonal and twice as many right of it, where exchanges of rows fill in; at most all columns
    return min(n, 3 * half + 1)


@kernel("i8(i8, i8, i8, i8)")
def band_row(a: int, i: int, n: int, half: int) -> int:
    """Offset of the (possibly not stored) column 0 of row ``i`` in the band at ``a``.

    The entry of column j, which must lie within the band, is at this offset plus j.
    """
    width = band_width(n, half)
    # the first stored column is ``half`` left of the diagonal, but the last rows end with the last column
    return a + i * width - min(max(0, i - half), n - width)


@kernel("void(F, i8, i8, i8, i8)")
def multiply(floats: Floats, a: int, n: int, x: int, out: int) -> None:
    """Write the symmetric matrix at ``a`` times the vector at ``x`` to ``out``, which must overlap neither of them.

    The matrix has ``n`` rows and is stored in full.
    """
    # the six velocities of a free body, written out: the compiler unrolls no loops. By symmetry the sums run down the
    # columns, which begin at i, in place of along the rows: entries of neighbouring columns follow each other in memory
    if n == 6:
        x0, x1, x2, x3, x4, x5 = floats[x], floats[x + 1], floats[x + 2], floats[x + 3], floats[x + 4], floats[x + 5]
        for i in range(a, a + 6):
            first = floats[i] * x0 + floats[i + 6] * x1 + floats[i + 12] * x2
            floats[out - a + i] = first + floats[i + 18] * x3 + floats[i + 24] * x4 + floats[i + 30] * x5
        return
    for i in range(n):
        floats[out + i] = product(floats, total=0.0, a=a + i * n, b=x, n=n)


@kernel("b1(F, i8, i8, i8, i8, f8)")
def eliminate(floats: Floats, a: int, n: int, half: int, x: int, least: float) -> bool:
    """Solve the banded system at ``a`` for the right-hand side at ``x``. False if the matrix is singular.

    Gaussian elimination with exchange of rows. Entries more than ``half`` from the diagonal are zero, and exchanges
    fill some of them. A pivot below ``least``, relative to the largest entry, counts as zero. The matrix is
    overwritten, and ``x`` becomes the solution. If singular, both are left half done.
    """
    largest = largest_size(floats, a, n * band_width(n, half))
    for j in range(n):
        own = band_row(a, j, n, half)
        # rows that have an entry in column j, and columns that row j has after exchanges
        below, right = min(n, j + half + 1), min(n, j + 2 * half + 1)
        pivot, best = j, own
        for i in range(j + 1, below):
            row = band_row(a, i, n, half)
            # the row with the largest entry, and its offset
            if abs(floats[row + j]) > abs(floats[best + j]):
                pivot, best = i, row
        # "not >", so that nan counts as singular
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
    # the upper triangle is left: solve from the last row up
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
    # the pivots, the entries of D, are g00, d1 and d2. "not >", so that nan counts as too small
    if not g00 > smallest:
        return math.nan, math.nan, math.nan
    l10, l20 = g10 / g00, g20 / g00
    # e is L_21 d1
    d1, e = g11 - l10 * g10, g21 - l20 * g10
    if not d1 > smallest:
        return math.nan, math.nan, math.nan
    l21 = e / d1
    d2 = g22 - l20 * g20 - l21 * e
    if not d2 > smallest:
        return math.nan, math.nan, math.nan
    # L y = right, whose first number is right[0], then D L^T x = y from the last row up
    y1 = right[1] - l10 * right[0]
    x2 = (right[2] - l20 * right[0] - l21 * y1) / d2
    x1 = y1 / d1 - l21 * x2
    return right[0] / g00 - l10 * x1 - l20 * x2, x1, x2
