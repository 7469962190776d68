"""The structure of the Delassus matrix by blocks: which of the active contacts share a movable linkage.

Rows of 3 x 3 blocks are compressed: that of active contact a is entry ``first_grouped`` + a of ``block_start``, and
``block_column`` holds the active contacts that it couples with, in ascending order and itself among them.
"""

from __future__ import annotations

from nonsmooth.engine.memory.layout import MOST_BLOCKS
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, kernel

_SIDES = 2
"""Entries of a contact in the lists of its linkages."""


@kernel()
def _hang(S: Scalars, w: Floats, k: Integers) -> None:
    """Hang the active contacts on their movable linkages."""
    for a in range(S.n_active):
        k[S.block_mark + a] = -1
        k[S.block_count + a] = 0
        for side in range(2):
            k[S.link_head + (k[S.linkage_a + k[S.active + a]] if side == 0 else k[S.linkage_b + k[S.active + a]])] = -1
    for a in range(S.n_active):
        c = k[S.active + a]
        for side in range(2):
            linkage = k[S.linkage_a + c] if side == 0 else k[S.linkage_b + c]
            if k[S.linkage_nu + linkage] > 0:
                k[S.link_next + _SIDES * a + side] = k[S.link_head + linkage]
                k[S.link_head + linkage] = _SIDES * a + side


@kernel("void(S, F, I, i8, i8, i8)")
def _note(S: Scalars, w: Floats, k: Integers, row: int, column: int, fill: int) -> None:
    """Count a block of a row or, with ``fill``, write it."""
    if fill == 1:
        block = k[S.block_start + S.first_grouped + row] + k[S.block_count + row]
        k[S.block_column + block] = column
        if row == column:
            k[S.own_block + S.first_grouped + row] = block
    k[S.block_count + row] += 1


@kernel("void(S, F, I, i8)")
def _visit(S: Scalars, w: Floats, k: Integers, fill: int) -> None:
    """Note every pair of active contacts that share a movable linkage, once for each of the two."""
    for a in range(S.n_active):
        c = k[S.active + a]
        mark = fill * S.n_active + a
        k[S.block_mark + a] = mark
        _note(S, w, k, a, a, fill)
        for side in range(2):
            linkage = k[S.linkage_a + c] if side == 0 else k[S.linkage_b + c]
            entry = k[S.link_head + linkage]
            while entry >= 0 and S.crowded == 0:
                other = entry // _SIDES
                if k[S.block_mark + other] != mark:
                    k[S.block_mark + other] = mark
                    _note(S, w, k, other, a, fill)
                entry = k[S.link_next + entry]


@kernel()
def link_active(S: Scalars, w: Floats, k: Integers) -> None:
    """Write the structure of the active contacts to the place that starts at ``first_grouped``.

    Without room for it ``crowded`` is set, and the run must stop.
    """
    start = S.block_start + S.first_grouped
    if S.first_grouped == 0:
        k[start] = 0
    _hang(S, w, k)
    _visit(S, w, k, 0)
    total = k[start]
    for a in range(S.n_active):
        total += k[S.block_count + a]
    if total > min(S.n_slots * S.n_slots, MOST_BLOCKS):
        S.crowded = 1
    for a in range(S.n_active):
        k[start + a + 1] = k[start + a] + (k[S.block_count + a] if S.crowded == 0 else 1)
        k[S.block_count + a] = 0
    _visit(S, w, k, 1)
