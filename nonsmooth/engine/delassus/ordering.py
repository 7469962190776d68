"""An order of the contacts of an island in which contacts that act on each other are near each other.

The matrix of the unknown forces then has a narrow band, and elimination within it needs far less than the cube of the
number of unknowns. The order is that of Cuthill and McKee, reversed: breadth first from an end of the island, and
neighbours with few neighbours first. To find an end, the search runs twice; the contact found last is the start of the
second search.

E. Cuthill, J. McKee, "Reducing the bandwidth of sparse symmetric matrices", Proc. 24th ACM Nat. Conf. (1969) 157-172;
A. George, J. W. H. Liu, Computer Solution of Large Sparse Positive Definite Systems, Prentice-Hall (1981).
"""

from __future__ import annotations

from nonsmooth.engine.delassus.blocks import link_active
from nonsmooth.engine.native.kernel import ActiveContact, Workspace, kernel

_UNRANKED = -1
"""Rank of a contact that the search has not met."""


@kernel("i8(ActiveContact)")
def _n_neighbours(active: ActiveContact) -> int:
    """Number of contacts that an active contact acts on, itself included."""
    return int(active.end_block - active.first_block)


@kernel("void(ws, i8)")
def _write_breadth_first_order(ws: Workspace, start: int) -> None:
    """Write the numbers of the active contacts to ``order``: breadth first from contact ``start``, for a narrow band.

    Of the new neighbours of a contact, those with few neighbours come first. ``rank`` only marks contacts that are met.
    All contacts are met, because those of an island are connected.
    """
    for active in ws.actives:
        active.rank = _UNRANKED
    ws.problem.order[0] = start
    ws.actives[start].rank = 0
    n_ordered = 1
    for i in range(ws.problem.n_active):
        # never in an island, which is connected: the contacts met so far act on no others
        if i >= n_ordered:
            return
        active = ws.actives[ws.problem.order[i]]
        first_new = n_ordered
        for block in range(active.first_block, active.end_block):
            neighbour = ws.actives[ws.island.block_column[block]]
            if neighbour.rank == _UNRANKED:
                neighbour.rank = i
                _insert(ws, neighbour, first_new, n_ordered)
                n_ordered += 1


@kernel("void(ws, ActiveContact, i8, i8)")
def _insert(ws: Workspace, active: ActiveContact, first: int, end: int) -> None:
    """Insert a contact into ``order`` between ``first`` and ``end``, where contacts are sorted by neighbour count.

    Contacts with more neighbours move on by one entry. ``end`` is the first free entry.
    """
    position = end
    while position > first and _n_neighbours(ws.actives[ws.problem.order[position - 1]]) > _n_neighbours(active):
        ws.problem.order[position] = ws.problem.order[position - 1]
        position -= 1
    ws.problem.order[position] = active.index


@kernel("i8(ws)")
def _bandwidth(ws: Workspace) -> int:
    """Largest difference of ``rank`` (position in an order) between contacts that act on each other."""
    bandwidth = 0
    for active in ws.actives:
        for block in range(active.first_block, active.end_block):
            # each pair comes twice, with both signs
            bandwidth = max(bandwidth, active.rank - ws.actives[ws.island.block_column[block]].rank)
    return bandwidth


@kernel()
def order_active(ws: Workspace) -> None:
    """Sort the active contacts (an island) for a narrow band of the matrix of forces, and write their block structure.

    The order is that of Cuthill and McKee, reversed. The contacts keep their order if the new one gives no narrower
    band, or if its band would fill the matrix.
    """
    n_active = ws.problem.n_active
    link_active(ws)
    n_blocks = ws.actives[n_active - 1].end_block - ws.actives[0].first_block
    # a matrix that is full has no better order
    if ws.run.has_too_many_blocks or n_blocks == n_active * n_active:
        return
    # a contact with few neighbours is near an end of the island
    first = 0
    for active in ws.actives:
        active.rank = active.index
        if _n_neighbours(active) < _n_neighbours(ws.actives[first]):
            first = active.index
    # band of the present order
    listed = _bandwidth(ws)
    _write_breadth_first_order(ws, first)
    # the contact found last is an end, and the start of the final search
    _write_breadth_first_order(ws, ws.problem.order[n_active - 1])
    for i in range(n_active):
        # the order is reversed
        ws.actives[ws.problem.order[i]].rank = n_active - 1 - i
    bandwidth = _bandwidth(ws)
    # of n = 3 n_active unknowns, a half band of 3 bandwidth + 2 is stored in rows of three times that length plus one
    if bandwidth >= listed or 9 * bandwidth + 7 >= 3 * n_active:
        return
    for i in range(n_active):
        # `active` still holds the contacts in the former order
        last = ws.problem.first_grouped + n_active - 1
        ws.island.grouped[last - i] = ws.problem.active[ws.problem.order[i]]
    for active in ws.actives:
        active.contact = ws.island.grouped[ws.problem.first_grouped + active.index]
    link_active(ws)
