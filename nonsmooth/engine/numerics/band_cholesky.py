"""Symmetric positive definite systems within a band: Cholesky factor, solution, and the band of the inverse."""

from __future__ import annotations

import math

from nonsmooth.engine.native.kernel import Floats, kernel
from nonsmooth.engine.numerics.linear import band_row


@kernel("void(F, i8, i8, i8, f8)")
def factorise_band(w: Floats, a: int, n: int, half: int, least: float) -> None:
    """Overwrite the lower triangle of the band at ``a`` by its Cholesky factor, pivots being ``least`` at least."""
    for i in range(n):
        row = band_row(a, i, n, half)
        for j in range(max(0, i - half), i + 1):
            other = band_row(a, j, n, half)
            total = w[row + j]
            for c in range(max(0, i - half), j):
                total -= w[row + c] * w[other + c]
            w[row + j] = math.sqrt(max(total, least)) if i == j else total / w[other + j]


@kernel("void(F, i8, i8, i8, i8)")
def substitute_band(w: Floats, a: int, n: int, half: int, x: int) -> None:
    """Solve with the factor at ``a`` in place."""
    for i in range(n):
        row = band_row(a, i, n, half)
        for c in range(max(0, i - half), i):
            w[x + i] -= w[row + c] * w[x + c]
        w[x + i] /= w[row + i]
    for i in range(n - 1, -1, -1):
        row = band_row(a, i, n, half)
        w[x + i] /= w[row + i]
        for c in range(max(0, i - half), i):
            w[x + c] -= w[row + c] * w[x + i]


@kernel("void(F, i8, i8, i8, i8)")
def invert_in_band(w: Floats, a: int, n: int, half: int, out: int) -> None:
    """Write the entries of the inverse that lie in the band to ``out``, from the factor at ``a``.

    K. Takahashi, J. Fagan, M.-S. Chin, "Formation of a sparse bus impedance matrix and its application to short circuit
    study", Proc. 8th PICA Conf. (1973) 63-69.
    """
    for i in range(n - 1, -1, -1):
        end = min(n, i + half + 1)
        own = band_row(out, i, n, half)
        root = w[band_row(a, i, n, half) + i]
        for j in range(end - 1, i - 1, -1):
            total = 1.0 / root if j == i else 0.0
            line = band_row(out, j, n, half)
            for c in range(i + 1, end):
                total -= w[band_row(a, c, n, half) + i] * w[line + c]
            w[own + j] = w[line + i] = total / root
