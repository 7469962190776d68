"""Least norm: the rank, the null space and the shortest solution of a singular system whose matrix is stored in full.

Matrices and vectors are stored among the floats of the workspace. An argument named as a matrix or a vector is the
offset of its first entry.
"""

from __future__ import annotations

import math

from nonsmooth.engine.memory.layout import SINGULAR
from nonsmooth.engine.native.kernel import Floats, kernel
from nonsmooth.engine.numerics.arrays import clear, subtract_part
from nonsmooth.engine.numerics.linear import product


@kernel("i8(F, i8, i8)")
def rank_of_semidefinite(floats: Floats, a: int, n: int) -> int:
    """Rank of the positive semidefinite matrix of ``n`` rows at ``a``, which is overwritten: number of nonzero pivots.

    It is found by elimination. Each pivot is the largest entry left on the diagonal, as in such a matrix no other entry
    is larger. It counts as zero if it is at most ``SINGULAR`` times the largest pivot; then all that follow do.
    """
    largest = 0.0
    for rank in range(n):
        best = rank
        for i in range(rank + 1, n):
            if floats[a + i * n + i] > floats[a + best * n + best]:
                best = i
        pivot = floats[a + best * n + best]
        largest = max(largest, pivot)
        # "not >", so that nan counts as zero
        if not pivot > SINGULAR * largest:
            return rank
        # bring the pivot to its place: exchange rows, then columns, so that the matrix stays symmetric
        for c in range(n):
            floats[a + rank * n + c], floats[a + best * n + c] = floats[a + best * n + c], floats[a + rank * n + c]
        for i in range(n):
            floats[a + i * n + rank], floats[a + i * n + best] = floats[a + i * n + best], floats[a + i * n + rank]
        # eliminate: only the part below and right of the pivot is read again
        for i in range(rank + 1, n):
            factor = floats[a + i * n + rank] / pivot
            if factor != 0.0:
                for c in range(rank + 1, n):
                    floats[a + i * n + c] -= factor * floats[a + rank * n + c]
    return n


@kernel("void(F, i8, i8, i8)")
def transpose(floats: Floats, a: int, n: int, out: int) -> None:
    """Write the transpose of the matrix of ``n`` rows and columns at ``a`` to ``out``, which must not overlap it."""
    for i in range(n):
        for j in range(n):
            floats[out + j * n + i] = floats[a + i * n + j]


@kernel("void(F, i8, i8, i8)")
def complete(floats: Floats, v: int, n: int, rank: int) -> None:
    """Complete the ``rank`` orthonormal rows of ``n`` numbers at ``v`` to a basis of all vectors.

    Each of the n - ``rank`` new rows, written behind them, starts from the unit vector that is farthest from the span
    of the rows so far, loses its components along them, and is scaled to length 1.
    """
    for done in range(rank, n):
        best, most = 0, -math.inf
        for i in range(n):
            # squared distance of unit vector i from the span of the rows
            outside = 1.0
            for c in range(done):
                outside -= floats[v + c * n + i] ** 2
            if outside > most:
                best, most = i, outside
        row = v + done * n
        for i in range(n):
            floats[row + i] = 1.0 if i == best else 0.0
        # a second pass of Gram-Schmidt removes the round-off that the first leaves
        for _ in range(2):
            for c in range(done):
                component = product(floats, total=0.0, a=v + c * n, b=row, n=n)
                subtract_part(floats, row, component, v + c * n, n)
        norm = math.sqrt(product(floats, total=0.0, a=row, b=row, n=n))
        for i in range(n):
            floats[row + i] /= norm


@kernel("i8(F, i8, i8, i8, i8, i8, i8)")
def _triangulate(floats: Floats, a: int, n: int, b: int, r: int, marks: int, most: int) -> int:
    """Factorise A = Q R with the largest remaining column first. Returns the rank of A, at most ``most``.

    The matrix at ``a`` is stored by columns, ``n`` by n. Its columns and the vector ``b`` lose their components along
    the columns chosen so far; a chosen column becomes one of Q. Rows of R are written to ``r``. The first n numbers at
    ``marks`` become 1 for the chosen columns, 0 for the others. Q^T b, one number for each chosen column, follows them.
    Columns beyond ``most``, or shorter than ``SINGULAR`` times the longest one chosen, count as zero.
    """
    for j in range(n):
        floats[marks + j] = 0.0
    largest = 0.0
    for rank in range(most):
        # the longest column that is left, and the square of its length; -1 if all are zero
        best, size = -1, 0.0
        for j in range(n):
            if floats[marks + j] == 0.0:
                square = product(floats, total=0.0, a=a + j * n, b=a + j * n, n=n)
                if square > size:
                    best, size = j, square
        norm = math.sqrt(size)
        largest = max(largest, norm)
        # all columns left are zero, up to round-off. A column with nan is never the longest, and counts as zero, too
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
                    part = product(floats, total=0.0, a=chosen, b=a + j * n, n=n)
                    floats[r + rank * n + j] += part
                    subtract_part(floats, a + j * n, part, chosen, n)
        floats[r + rank * n + best] = norm
        component = product(floats, total=0.0, a=chosen, b=b, n=n)
        floats[marks + n + rank] = component
        subtract_part(floats, b, component, chosen, n)
    return most


@kernel("i8(F, i8, i8, i8, i8, i8, i8, i8)")
def minimum_norm(floats: Floats, a: int, n: int, b: int, x: int, v: int, work: int, most: int) -> int:
    """Write the least-squares solution of A x = b of least norm to ``x``. Returns the rank of A, at most ``most``.

    A = Q R gives the components Q^T b, and R = L V the solution V^T L^-1 Q^T b. Both are orthogonal decompositions, so
    that the condition of A is not squared. The matrix at ``a`` has ``n`` rows and is stored by columns; it and ``b``
    are overwritten. The first rows at ``v`` become an orthonormal basis of the row space. ``work`` has 2 n numbers.
    ``most`` is for a caller that knows a smaller rank by other means; n means no limit.
    """
    # Q replaces A, and R is written to v
    rank = _triangulate(floats, a, n, b, v, work, most)
    clear(floats, x, n)
    # Q^T b, whose numbers become those of L^-1 Q^T b one by one. They follow the marks of the chosen columns
    components = work + n
    # R = L V: the rows of R are orthogonalised, and the forward substitution with L is done along with it
    for j in range(rank):
        row = v + j * n
        rest = floats[components + j]
        # a second pass of Gram-Schmidt removes the round-off that the first leaves. The entry of L is the sum of both
        for _ in range(2):
            for c in range(j):
                part = product(floats, total=0.0, a=v + c * n, b=row, n=n)
                rest -= part * floats[components + c]
                subtract_part(floats, row, part, v + c * n, n)
        norm = math.sqrt(product(floats, total=0.0, a=row, b=row, n=n))
        for i in range(n):
            floats[row + i] /= norm
        # the norm is the entry of L on the diagonal
        floats[components + j] = rest / norm
        for i in range(n):
            floats[x + i] += floats[components + j] * floats[row + i]
    return rank
