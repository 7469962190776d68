"""Sparsity of the Delassus matrix G: which pairs of active contacts have a block of 3 x 3 that is not zero.

Two contacts act on each other only if they share a movable articulation, which is a set of bodies that joints connect.
G is stored in compressed rows of blocks. Active contact a owns the blocks ``first_block`` to ``end_block`` - 1, and
``block_column`` holds the active contact that each of them couples with, in ascending order, a itself among them.

Each articulation gets a linked list of its contacts, and each contact goes through the lists of its two articulations.
So the effort grows with the number of blocks; a comparison of all pairs of contacts would grow with the square of
their number. The outer loop runs over columns: the columns of each row then ascend without being sorted. It runs twice,
first to count the blocks of each row, then to write them.
"""

from __future__ import annotations

from nonsmooth.engine.memory.layout import MOST_BLOCKS
from nonsmooth.engine.native.kernel import ActiveContact, Workspace, kernel


@kernel()
def _link_contacts(ws: Workspace) -> None:
    """List the active contacts at each movable articulation of their two bodies: these contacts act on each other.

    The lists are linked: ``first_linked`` of the articulation is the first entry, and ``link_next`` leads from each
    entry to the next. Entry a is the first side of contact a, entry ``n_active`` + a the second, and -1 ends a list.
    Counts and marks of the rows of the Delassus matrix are cleared.
    """
    for active in ws.actives:
        active.block_mark = -1
        active.n_blocks = 0
        contact = ws.contacts[active.contact]
        ws.articulations[contact.articulation_a].first_linked = -1
        ws.articulations[contact.articulation_b].first_linked = -1
    for active in ws.actives:
        contact = ws.contacts[active.contact]
        for side in range(2):
            articulation = ws.articulations[contact.articulation_a if side == 0 else contact.articulation_b]
            # without velocities it is fixed or driven: no force moves it, so it couples no contacts
            if articulation.n_u > 0:
                entry = side * ws.problem.n_active + active.index
                ws.problem.link_next[entry] = articulation.first_linked
                articulation.first_linked = entry


@kernel("void(ws, ActiveContact, i8, b1)")
def _add_block(ws: Workspace, active: ActiveContact, column: int, is_written: bool) -> None:
    """Count one more block in the row of a contact of the Delassus matrix. Write its column only if ``is_written``.

    The ``column`` is the contact that the block couples with. The number of the block on the diagonal is stored apart,
    for a quick access.
    """
    if is_written:
        block = active.first_block + active.n_blocks
        ws.island.block_column[block] = column
        if active.index == column:
            active.diagonal_block = block
    active.n_blocks += 1


@kernel("void(ws, b1)")
def _add_blocks(ws: Workspace, are_written: bool) -> None:
    """Count the blocks in all rows of the Delassus matrix, or write their columns if ``are_written``.

    Each pair of contacts that shares a movable articulation has two blocks. The blocks (b, a) of column a are added for
    one contact a after the other, so the columns of each row ascend.
    """
    for active in ws.actives:
        # each neighbour is marked, as it may be in both lists and counts once; the two passes have different marks
        mark = active.index + (ws.problem.n_active if are_written else 0)
        active.block_mark = mark
        _add_block(ws, active, active.index, are_written)
        contact = ws.contacts[active.contact]
        for side in range(2):
            entry = ws.articulations[contact.articulation_a if side == 0 else contact.articulation_b].first_linked
            # if the blocks are too many, the block on the diagonal stays the only one of each row
            while entry >= 0 and not ws.run.has_too_many_blocks:
                neighbour = ws.actives[entry if entry < ws.problem.n_active else entry - ws.problem.n_active]
                if neighbour.block_mark != mark:
                    neighbour.block_mark = mark
                    _add_block(ws, neighbour, active.index, are_written)
                entry = ws.problem.link_next[entry]


@kernel()
def link_active(ws: Workspace) -> None:
    """Write which blocks of 3 x 3 of the Delassus matrix are stored for the active contacts, those of one island.

    They follow the blocks of the islands before. If the workspace has too few, each row gets one block only, and
    ``has_too_many_blocks`` is set: the run stops.
    """
    # the first island: its blocks begin at 0. Of others, `first_block` is `end_block` of the contact before
    if ws.problem.first_grouped == 0:
        ws.island.block_start[0] = 0
    _link_contacts(ws)
    # the first pass counts the blocks of each row, so that the second knows where a row begins
    _add_blocks(ws, are_written=False)
    # blocks of the islands before and of this one
    total = ws.island.block_start[ws.problem.first_grouped]
    for active in ws.actives:
        total += active.n_blocks
    # the number of blocks that the workspace has
    if total > min(ws.model.n_slots * ws.model.n_slots, MOST_BLOCKS):
        ws.run.has_too_many_blocks = True
    for active in ws.actives:
        active.end_block = active.first_block + (active.n_blocks if not ws.run.has_too_many_blocks else 1)
        # the second pass counts again
        active.n_blocks = 0
    _add_blocks(ws, are_written=True)
