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
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        active.block_mark = -1
        active.n_blocks = 0
        contact = ws.contacts[active.contact]
        ws.articulations[contact.articulation_a].first_linked = -1
        ws.articulations[contact.articulation_b].first_linked = -1
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        contact = ws.contacts[active.contact]
        for side in range(2):
            articulation = ws.articulations[contact.articulation_a if side == 0 else contact.articulation_b]
            if articulation.n_u > 0:
                entry = side * ws.problem.n_active + a
                ws.problem.link_next[entry] = articulation.first_linked
                articulation.first_linked = entry


@kernel("void(ws, i8, i8, i8)")
def _note(ws: Workspace, row: int, column: int, fill: int) -> None:
    """Count a block of a row or, with ``fill``, write it."""
    active = ws.actives[row]
    if fill == 1:
        block = active.first_block + active.n_blocks
        ws.island.block_column[block] = column
        if row == column:
            active.diagonal_block = block
    active.n_blocks += 1


@kernel("void(ws, i8)")
def _visit(ws: Workspace, fill: int) -> None:
    """Note every pair of active contacts that share a movable articulation, once for each of the two."""
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        contact = ws.contacts[active.contact]
        mark = fill * ws.problem.n_active + a
        active.block_mark = mark
        _note(ws, a, a, fill)
        for side in range(2):
            entry = ws.articulations[contact.articulation_a if side == 0 else contact.articulation_b].first_linked
            while entry >= 0 and not ws.run.has_too_many_blocks:
                other = entry if entry < ws.problem.n_active else entry - ws.problem.n_active
                neighbour = ws.actives[other]
                if neighbour.block_mark != mark:
                    neighbour.block_mark = mark
                    _note(ws, other, a, fill)
                entry = ws.problem.link_next[entry]


@kernel()
def _link_alone(ws: Workspace) -> None:
    """Write the structure of an island of one contact: a block of its own."""
    active = ws.actives[0]
    active.diagonal_block = active.first_block
    active.end_block = active.first_block + 1
    ws.island.block_column[active.first_block] = 0


@kernel()
def link_active(ws: Workspace) -> None:
    """Write the structure of the active contacts to the place that starts at ``first_grouped``.

    Without room for it ``crowded`` is set, and the run must stop.
    """
    start = ws.island.block_start.start + ws.problem.first_grouped
    if ws.problem.first_grouped == 0:
        ws.integers[start] = 0
    most = min(ws.model.n_slots * ws.model.n_slots, MOST_BLOCKS)
    if ws.problem.n_active == 1:
        _link_alone(ws)
        if ws.integers[start + 1] > most:
            ws.run.has_too_many_blocks = True
        return
    _hang(ws)
    _visit(ws, 0)
    total = ws.integers[start]
    for a in range(ws.problem.n_active):
        total += ws.actives[a].n_blocks
    if total > most:
        ws.run.has_too_many_blocks = True
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        active.end_block = active.first_block + (active.n_blocks if not ws.run.has_too_many_blocks else 1)
        active.n_blocks = 0
    _visit(ws, 1)
