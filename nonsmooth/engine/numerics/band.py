"""The band of the matrix of the unknown forces, as narrow as the order of the contacts makes it.

An unknown acts on those of its own contact and of the contacts coupled with it only, ``half_band`` rows off at most.
A row holds that far to the left and, as exchanges of rows widen the band, twice that far to the right; where this is
all of the matrix, and of few contacts it is, it is stored in full.
"""

from __future__ import annotations

from nonsmooth.engine.memory.layout import MOST_ENTRIES
from nonsmooth.engine.native.kernel import Workspace, kernel
from nonsmooth.engine.numerics.linear import band_width


@kernel("i8(ws)")
def _half_band(ws: Workspace) -> int:
    """Return how far apart unknowns stand that act on one another; ``first_unknown`` says whose they are."""
    half = 0
    unknown = ws.problem.first_unknown.start
    for a in range(ws.problem.n_active):
        if ws.integers[unknown + a + 1] > ws.integers[unknown + a]:
            row = ws.island.block_start.start + ws.problem.first_grouped + a
            lowest = ws.integers[unknown + ws.island.block_column[ws.integers[row]]]
            half = max(half, ws.integers[unknown + a + 1] - 1 - lowest)
    return half


@kernel("b1(ws, i8, i8)")
def open_band(ws: Workspace, n: int, matrix: int) -> bool:
    """Find the band of ``n`` unknowns and clear it at ``matrix``; return 1, or 0 where there is no room for it."""
    ws.problem.half_band = _half_band(ws)
    size = n * band_width(n, ws.problem.half_band)
    if size > MOST_ENTRIES:
        ws.run.has_too_many_blocks = True
        return False
    for i in range(size):
        ws.floats[matrix + i] = 0.0
    return True
