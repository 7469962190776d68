"""The band of the matrix of the unknown forces, as narrow as the order of the contacts makes it.

An unknown acts on those of its own contact and of the contacts coupled with it only, ``half_band`` rows off at most.
A row holds that far to the left and, as exchanges of rows widen the band, twice that far to the right; where this is
all of the matrix, and of few contacts it is, it is stored in full.
"""

from __future__ import annotations

from nonsmooth.engine.memory.layout import MOST_ENTRIES
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, kernel
from nonsmooth.engine.numerics.linear import band_width


@kernel("i8(S, F, I)")
def _half_band(S: Scalars, w: Floats, k: Integers) -> int:
    """Return how far apart unknowns stand that act on one another; ``first_unknown`` says whose they are."""
    half = 0
    unknown = S.first_unknown
    for a in range(S.n_active):
        if k[unknown + a + 1] > k[unknown + a]:
            row = S.block_start + S.first_grouped + a
            lowest = k[unknown + k[S.block_column + k[row]]]
            half = max(half, k[unknown + a + 1] - 1 - lowest)
    return half


@kernel("i8(S, F, I, i8, i8)")
def open_band(S: Scalars, w: Floats, k: Integers, n: int, matrix: int) -> int:
    """Find the band of ``n`` unknowns and clear it at ``matrix``; return 1, or 0 where there is no room for it."""
    S.half_band = _half_band(S, w, k)
    size = n * band_width(n, S.half_band)
    if size > MOST_ENTRIES:
        S.crowded = 1
        return 0
    for i in range(size):
        w[matrix + i] = 0.0
    return 1
