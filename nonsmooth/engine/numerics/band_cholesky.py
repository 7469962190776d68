"""Symmetric positive definite systems within a band: Cholesky factor, solution, and the band of the inverse.

Only the lower triangle of the band is read. The factor has the same band, as no rows are exchanged. A matrix has ``n``
rows, and its entries are at most ``half`` columns from the diagonal.
"""

from __future__ import annotations

import math

from nonsmooth.engine.native.kernel import Floats, kernel
from nonsmooth.engine.numerics.linear import band_row


@kernel("void(F, i8, i8, i8, f8)")
def factorise_band(floats: Floats, a: int, n: int, half: int, least: float) -> None:
    """Overwrite the lower triangle of the band at ``a`` by its Cholesky factor L, with A = L L^T.

    A pivot, the square of a diagonal entry of L, is raised to ``least`` if it is smaller: round-off may make that of a
    nearly singular matrix negative. ``least`` has the unit of the entries, and must be positive.
    """
    for i in range(n):
        row = band_row(a, i, n, half)
        for j in range(max(0, i - half), i + 1):
            other = band_row(a, j, n, half)
            # A_ij less the products of the columns before j: L_ij L_jj, or the pivot if i is j
            total = floats[row + j]
            for c in range(max(0, i - half), j):
                total -= floats[row + c] * floats[other + c]
            floats[row + j] = math.sqrt(max(total, least)) if i == j else total / floats[other + j]


@kernel("void(F, i8, i8, i8, i8)")
def substitute_band(floats: Floats, a: int, n: int, half: int, x: int) -> None:
    """Overwrite the right-hand side at ``x`` by the solution of L L^T x = b, with the Cholesky factor L at ``a``."""
    # L y = b, downwards
    for i in range(n):
        row = band_row(a, i, n, half)
        for c in range(max(0, i - half), i):
            floats[x + i] -= floats[row + c] * floats[x + c]
        floats[x + i] /= floats[row + i]
    # L^T x = y, upwards. Row i of L is column i of L^T: as soon as x_i is known, its part is taken from those above
    for i in range(n - 1, -1, -1):
        row = band_row(a, i, n, half)
        floats[x + i] /= floats[row + i]
        for c in range(max(0, i - half), i):
            floats[x + c] -= floats[row + c] * floats[x + i]


@kernel("void(F, i8, i8, i8, i8)")
def invert_in_band(floats: Floats, a: int, n: int, half: int, out: int) -> None:
    """Write the entries of the inverse Z of A that lie in the band to ``out``, from the Cholesky factor L at ``a``.

    From the last row up, Z_ij = (delta_ij / L_ii - sum over c > i of L_ci Z_cj) / L_ii. The entries outside the band
    are not needed for those inside, so that the cost is that of the band.

    K. Takahashi, J. Fagan, M.-S. Chin, "Formation of a sparse bus impedance matrix and its application to short circuit
    study", Proc. 8th PICA Conf. (1973) 63-69.
    """
    for i in range(n - 1, -1, -1):
        end = min(n, i + half + 1)
        row_i = band_row(out, i, n, half)
        # L_ii, the root of pivot i
        root = floats[band_row(a, i, n, half) + i]
        for j in range(end - 1, i - 1, -1):
            total = 1.0 / root if j == i else 0.0
            row_j = band_row(out, j, n, half)
            for c in range(i + 1, end):
                total -= floats[band_row(a, c, n, half) + i] * floats[row_j + c]
            # the inverse is symmetric: rows above read it from row j
            floats[row_i + j] = floats[row_j + i] = total / root
