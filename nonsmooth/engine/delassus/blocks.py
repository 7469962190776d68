"""The structure of the Delassus matrix by blocks: which of the active contacts share a movable articulation.

Rows of 3 x 3 blocks are compressed: that of active contact a is entry ``first_grouped`` + a of ``block_start``, and
``block_column`` holds the active contacts that it couples with, in ascending order and itself among them.
"""

from __future__ import annotations

from nonsmooth.engine.memory.layout import MOST_BLOCKS
from nonsmooth.engine.native.kernel import (
    Workspace,
    kernel,
)


@kernel()
def _hang(ws: Workspace) -> None:
    """Hang the active contacts on their movable articulations: first entries of all contacts, then second ones."""
    for a in range(ws.n_active):
        active = ws.actives[a]
        active.block_mark = -1
        active.block_count = 0
        contact = ws.contacts[active.slot]
        ws.articulations[contact.articulation_a].link_head = -1
        ws.articulations[contact.articulation_b].link_head = -1
    for a in range(ws.n_active):
        active = ws.actives[a]
        contact = ws.contacts[active.slot]
        for side in range(2):
            articulation = ws.articulations[contact.articulation_a if side == 0 else contact.articulation_b]
            if articulation.nu > 0:
                entry = side * ws.n_active + a
                ws.link_next[entry] = articulation.link_head
                articulation.link_head = entry


@kernel("void(ws, i8, i8, i8)")
def _note(ws: Workspace, row: int, column: int, fill: int) -> None:
    """Count a block of a row or, with ``fill``, write it."""
    active = ws.actives[row]
    if fill == 1:
        block = active.first_block + active.block_count
        ws.block_column[block] = column
        if row == column:
            active.diagonal_block = block
    active.block_count += 1


@kernel("void(ws, i8)")
def _visit(ws: Workspace, fill: int) -> None:
    """Note every pair of active contacts that share a movable articulation, once for each of the two."""
    for a in range(ws.n_active):
        active = ws.actives[a]
        contact = ws.contacts[active.slot]
        mark = fill * ws.n_active + a
        active.block_mark = mark
        _note(ws, a, a, fill)
        for side in range(2):
            entry = ws.articulations[contact.articulation_a if side == 0 else contact.articulation_b].link_head
            while entry >= 0 and ws.crowded == 0:
                other = entry if entry < ws.n_active else entry - ws.n_active
                neighbour = ws.actives[other]
                if neighbour.block_mark != mark:
                    neighbour.block_mark = mark
                    _note(ws, other, a, fill)
                entry = ws.link_next[entry]


@kernel()
def _link_alone(ws: Workspace) -> None:
    """Write the structure of an island of one contact: a block of its own."""
    active = ws.actives[0]
    active.diagonal_block = active.first_block
    active.end_block = active.first_block + 1
    ws.block_column[active.first_block] = 0


@kernel()
def link_active(ws: Workspace) -> None:
    """Write the structure of the active contacts to the place that starts at ``first_grouped``.

    Without room for it ``crowded`` is set, and the run must stop.
    """
    start = ws.offsets.block_start + ws.first_grouped
    if ws.first_grouped == 0:
        ws.integers[start] = 0
    most = min(ws.n_slots * ws.n_slots, MOST_BLOCKS)
    if ws.n_active == 1:
        _link_alone(ws)
        if ws.integers[start + 1] > most:
            ws.crowded = 1
        return
    _hang(ws)
    _visit(ws, 0)
    total = ws.integers[start]
    for a in range(ws.n_active):
        total += ws.actives[a].block_count
    if total > most:
        ws.crowded = 1
    for a in range(ws.n_active):
        active = ws.actives[a]
        active.end_block = active.first_block + (active.block_count if ws.crowded == 0 else 1)
        active.block_count = 0
    _visit(ws, 1)
