"""Delassus matrices, islands, and the order of their rows."""

from __future__ import annotations

from nonsmooth.engine.memory.arrays.arrays import Arrays, ends, entries, per, whole

ARRAYS = Arrays(
    scalars={
        **whole(
            "n_groups",
        ),
    },
    floats={},
    integers={
        "active": per(1, "n_slots"),
        "link_head": per(1, "n_articulations"),
        "link_next": per(2, "n_slots"),
        "articulation_root": per(1, "n_articulations"),
        "articulation_group": per(1, "n_articulations"),
        "member": per(1, "n_slots"),
        "grouped": per(1, "n_slots"),
        "group_of": per(1, "n_slots"),
        "group_next": per(1, "n_slots"),
        "group_start": ends("n_slots"),
        "block_count": per(1, "n_slots"),
        "block_mark": per(1, "n_slots"),
        "diagonal_block": per(1, "n_slots"),
        "order": per(1, "n_slots"),
        "rank": per(1, "n_slots"),
    },
    later_floats={
        "matrix": entries,
    },
)
