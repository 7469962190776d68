"""The structure of the Delassus matrix by blocks: which of the active contacts share a movable articulation.

Rows of 3 x 3 blocks are compressed: that of active contact a is entry ``first_grouped`` + a of ``block_start``, and
``block_column`` holds the active contacts that it couples with, in ascending order and itself among them.
"""

from __future__ import annotations

from nonsmooth.engine.memory.layout import MOST_BLOCKS
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, active_at, articulation_at, contact_at, kernel


@kernel()
def _hang(S: Scalars, w: Floats, k: Integers) -> None:
    """Hang the active contacts on their movable articulations: first entries of all contacts, then second ones."""
    for a in range(S.n_active):
        active = active_at(S, w, k, a)
        active.block_mark = -1
        active.block_count = 0
        contact = contact_at(S, w, k, active.slot)
        articulation_at(S, w, k, contact.articulation_a).link_head = -1
        articulation_at(S, w, k, contact.articulation_b).link_head = -1
    for a in range(S.n_active):
        active = active_at(S, w, k, a)
        contact = contact_at(S, w, k, active.slot)
        for side in range(2):
            articulation = articulation_at(S, w, k, contact.articulation_a if side == 0 else contact.articulation_b)
            if articulation.nu > 0:
                entry = side * S.n_active + a
                k[S.link_next + entry] = articulation.link_head
                articulation.link_head = entry


@kernel("void(S, F, I, i8, i8, i8)")
def _note(S: Scalars, w: Floats, k: Integers, row: int, column: int, fill: int) -> None:
    """Count a block of a row or, with ``fill``, write it."""
    active = active_at(S, w, k, row)
    if fill == 1:
        block = active.first_block + active.block_count
        k[S.block_column + block] = column
        if row == column:
            active.diagonal_block = block
    active.block_count += 1


@kernel("void(S, F, I, i8)")
def _visit(S: Scalars, w: Floats, k: Integers, fill: int) -> None:
    """Note every pair of active contacts that share a movable articulation, once for each of the two."""
    for a in range(S.n_active):
        active = active_at(S, w, k, a)
        contact = contact_at(S, w, k, active.slot)
        mark = fill * S.n_active + a
        active.block_mark = mark
        _note(S, w, k, a, a, fill)
        for side in range(2):
            entry = articulation_at(S, w, k, contact.articulation_a if side == 0 else contact.articulation_b).link_head
            while entry >= 0 and S.crowded == 0:
                other = entry if entry < S.n_active else entry - S.n_active
                neighbour = active_at(S, w, k, other)
                if neighbour.block_mark != mark:
                    neighbour.block_mark = mark
                    _note(S, w, k, other, a, fill)
                entry = k[S.link_next + entry]


@kernel()
def _link_alone(S: Scalars, w: Floats, k: Integers) -> None:
    """Write the structure of an island of one contact: a block of its own."""
    active = active_at(S, w, k, 0)
    active.diagonal_block = active.first_block
    active.end_block = active.first_block + 1
    k[S.block_column + active.first_block] = 0


@kernel()
def link_active(S: Scalars, w: Floats, k: Integers) -> None:
    """Write the structure of the active contacts to the place that starts at ``first_grouped``.

    Without room for it ``crowded`` is set, and the run must stop.
    """
    start = S.block_start + S.first_grouped
    if S.first_grouped == 0:
        k[start] = 0
    most = min(S.n_slots * S.n_slots, MOST_BLOCKS)
    if S.n_active == 1:
        _link_alone(S, w, k)
        if k[start + 1] > most:
            S.crowded = 1
        return
    _hang(S, w, k)
    _visit(S, w, k, 0)
    total = k[start]
    for a in range(S.n_active):
        total += active_at(S, w, k, a).block_count
    if total > most:
        S.crowded = 1
    for a in range(S.n_active):
        active = active_at(S, w, k, a)
        active.end_block = active.first_block + (active.block_count if S.crowded == 0 else 1)
        active.block_count = 0
    _visit(S, w, k, 1)
