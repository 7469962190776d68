"""An order of the contacts of an island in which those that act on one another stand near each other.

Reverse Cuthill-McKee: breadth first from an end of the island, neighbours of few neighbours first.
E. Cuthill, J. McKee, "Reducing the bandwidth of sparse symmetric matrices", Proc. 24th ACM Nat. Conf. (1969) 157-172;
A. George, J. W. H. Liu, Computer Solution of Large Sparse Positive Definite Systems, Prentice-Hall (1981).
"""

from __future__ import annotations

from nonsmooth.engine.delassus.blocks import link_active
from nonsmooth.engine.native.kernel import Workspace, kernel


@kernel("i8(ws, i8)")
def _degree(ws: Workspace, a: int) -> int:
    active = ws.actives[a]
    return int(active.end_block - active.first_block)


@kernel("void(ws, i8)")
def _search(ws: Workspace, start: int) -> None:
    """Write the active contacts to ``order`` as met from ``start`` on, breadth first."""
    for a in range(ws.problem.n_active):
        ws.actives[a].rank = -1
    ws.problem.order[0] = start
    ws.actives[start].rank = 0
    end = 1
    for i in range(ws.problem.n_active):
        if i >= end:
            return
        active = ws.actives[ws.problem.order[i]]
        begin = end
        for block in range(active.first_block, active.end_block):
            other = ws.island.block_column[block]
            neighbour = ws.actives[other]
            if neighbour.rank >= 0:
                continue
            neighbour.rank = i
            place = end
            while place > begin and _degree(ws, ws.problem.order[place - 1]) > _degree(ws, other):
                ws.problem.order[place] = ws.problem.order[place - 1]
                place -= 1
            ws.problem.order[place] = other
            end += 1


@kernel("i8(ws)")
def _reach(ws: Workspace) -> int:
    """Return how far apart, by their ``rank``, contacts stand that act on one another."""
    reach = 0
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        for block in range(active.first_block, active.end_block):
            reach = max(reach, active.rank - ws.actives[ws.island.block_column[block]].rank)
    return reach


@kernel()
def order_active(ws: Workspace) -> None:
    """Bring the active island into an order that makes the band of its matrix narrow, and link it.

    It stays in the order of its contacts where no other is better, and where the band would fill the matrix.
    """
    m = ws.problem.n_active
    link_active(ws)
    start = ws.island.block_start.start + ws.problem.first_grouped
    if ws.run.has_too_many_blocks or ws.integers[start + m] - ws.integers[start] == m * m:
        return
    first = 0
    for a in range(m):
        ws.actives[a].rank = a
        if _degree(ws, a) < _degree(ws, first):
            first = a
    listed = _reach(ws)
    _search(ws, first)
    _search(ws, ws.problem.order[m - 1])
    for i in range(m):
        ws.actives[ws.problem.order[i]].rank = m - 1 - i
    reach = _reach(ws)
    # three unknowns for each contact, and room for exchanges of rows: see the band of forces
    if reach >= listed or 9 * reach + 7 >= 3 * m:
        return
    for i in range(m):
        ws.island.grouped[ws.problem.first_grouped + m - 1 - i] = ws.problem.active[ws.problem.order[i]]
    for a in range(m):
        ws.actives[a].contact = ws.island.grouped[ws.problem.first_grouped + a]
    link_active(ws)
