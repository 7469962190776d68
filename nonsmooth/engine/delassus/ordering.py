"""An order of the contacts of an island in which those that act on one another stand near each other.

Reverse Cuthill-McKee: breadth first from an end of the island, neighbours of few neighbours first.
E. Cuthill, J. McKee, "Reducing the bandwidth of sparse symmetric matrices", Proc. 24th ACM Nat. Conf. (1969) 157-172;
A. George, J. W. H. Liu, Computer Solution of Large Sparse Positive Definite Systems, Prentice-Hall (1981).
"""

from __future__ import annotations

from nonsmooth.engine.delassus.blocks import link_active
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, active_at, kernel


@kernel("i8(S, F, I, i8)")
def _degree(S: Scalars, w: Floats, k: Integers, a: int) -> int:
    active = active_at(S, w, k, a)
    return int(active.end_block - active.first_block)


@kernel("void(S, F, I, i8)")
def _search(S: Scalars, w: Floats, k: Integers, start: int) -> None:
    """Write the active contacts to ``order`` as met from ``start`` on, breadth first."""
    for a in range(S.n_active):
        active_at(S, w, k, a).rank = -1
    k[S.order] = start
    active_at(S, w, k, start).rank = 0
    end = 1
    for i in range(S.n_active):
        if i >= end:
            return
        active = active_at(S, w, k, k[S.order + i])
        begin = end
        for block in range(active.first_block, active.end_block):
            other = k[S.block_column + block]
            neighbour = active_at(S, w, k, other)
            if neighbour.rank >= 0:
                continue
            neighbour.rank = i
            place = end
            while place > begin and _degree(S, w, k, k[S.order + place - 1]) > _degree(S, w, k, other):
                k[S.order + place] = k[S.order + place - 1]
                place -= 1
            k[S.order + place] = other
            end += 1


@kernel("i8(S, F, I)")
def _reach(S: Scalars, w: Floats, k: Integers) -> int:
    """Return how far apart, by their ``rank``, contacts stand that act on one another."""
    reach = 0
    for a in range(S.n_active):
        active = active_at(S, w, k, a)
        for block in range(active.first_block, active.end_block):
            reach = max(reach, active.rank - active_at(S, w, k, k[S.block_column + block]).rank)
    return reach


@kernel()
def order_active(S: Scalars, w: Floats, k: Integers) -> None:
    """Bring the active island into an order that makes the band of its matrix narrow, and link it.

    It stays in the order of its contacts where no other is better, and where the band would fill the matrix.
    """
    m = S.n_active
    link_active(S, w, k)
    start = S.block_start + S.first_grouped
    if S.crowded == 1 or k[start + m] - k[start] == m * m:
        return
    first = 0
    for a in range(m):
        active_at(S, w, k, a).rank = a
        if _degree(S, w, k, a) < _degree(S, w, k, first):
            first = a
    listed = _reach(S, w, k)
    _search(S, w, k, first)
    _search(S, w, k, k[S.order + m - 1])
    for i in range(m):
        active_at(S, w, k, k[S.order + i]).rank = m - 1 - i
    reach = _reach(S, w, k)
    # three unknowns for each contact, and room for exchanges of rows: see the band of forces
    if reach >= listed or 9 * reach + 7 >= 3 * m:
        return
    for i in range(m):
        k[S.grouped + S.first_grouped + m - 1 - i] = k[S.active + k[S.order + i]]
    for a in range(m):
        active_at(S, w, k, a).slot = k[S.grouped + S.first_grouped + a]
    link_active(S, w, k)
