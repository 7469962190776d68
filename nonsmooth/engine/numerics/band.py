"""The band of the matrix of the unknown forces: its width follows from the order of the contacts.

An unknown force acts on those of its own contact and of the coupled contacts only. These are at most ``half_band`` rows
away. A stored row has that length to the left of the diagonal and, because exchanges of rows widen the band, twice that
length to the right. If this is all of the matrix, as for few contacts, the matrix is stored in full.
"""

from __future__ import annotations

from nonsmooth.engine.memory.layout import MOST_ENTRIES
from nonsmooth.engine.native.kernel import Workspace, kernel
from nonsmooth.engine.numerics.arrays import clear
from nonsmooth.engine.numerics.linear import band_width


@kernel("i8(ws)")
def _half_band(ws: Workspace) -> int:
    """Half width of the band of the matrix of the unknown forces: largest distance between rows that are coupled.

    A row is an unknown. Forces are coupled if their contacts share a movable body, or bodies that joints connect. The
    blocks of a contact, from ``first_block``, are the pairs with its coupled contacts, listed in ``block_column``.
    """
    half = 0
    for active in ws.actives:
        # a contact without unknown forces has no rows
        if active.end_unknown > active.first_unknown:
            # coupled contacts are listed in ascending order: the first one has the lowest unknowns
            first_coupled = ws.actives[ws.island.block_column[active.first_block]]
            # from the last unknown of this contact to the first one of that. The other side is the same by symmetry
            half = max(half, active.end_unknown - 1 - first_coupled.first_unknown)
    return half


@kernel("b1(ws, i8, i8)")
def open_band(ws: Workspace, n: int, matrix: int) -> bool:
    """Find the half width of the band of ``n`` unknown forces, and set the matrix at ``matrix`` to zero.

    The half width is written to ``half_band``. False if the band has too many entries for the memory. The run then
    stops.
    """
    ws.problem.half_band = _half_band(ws)
    size = n * band_width(n, ws.problem.half_band)
    if size > MOST_ENTRIES:
        # the mark of too many pairs of contacts serves here, too: either of them ends the run with the same message
        ws.run.has_too_many_blocks = True
        return False
    clear(ws.floats, matrix, size)
    return True
