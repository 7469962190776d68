"""Records: what belongs to one contact, one body or one joint, by name.

The memory holds arrays with one number, or a few, for every contact.  A record is a view of one contact's:
``contact_at(S, w, k, c)`` (:mod:`nonsmooth.engine.native.kernel`) gives contact ``c``, whose ``contact.mode`` is
``k[S.mode + c]``.  A few numbers are a vector, read and written as a tuple, ``contact.direction = 1.0, 0.0``, or a row
to be indexed, ``contact.rate[1]`` for ``w[S.rate + 3 * c + 1]``.  The memory is the same.
"""

from __future__ import annotations

from collections.abc import Mapping

from nonsmooth.engine.memory.body_records import (
    ARTICULATION,
    BODY,
    CARRIER,
    CONVEX_PART,
    FRAME_OF_BODY,
    JOINT,
    LOAD,
    PAIR_OF_PARTS,
    POOL,
    ROW_OF_JOINT,
    UNIT,
    WALL,
    WRENCH_OF_LOAD,
)
from nonsmooth.engine.memory.contact_records import (
    ACTIVE,
    CONTACT,
    DELASSUS_BLOCK,
    GUARD,
    IMPACT_STATE,
    OWN_GUARD,
    PART_OF_STEP,
    UNKNOWN,
)
from nonsmooth.engine.memory.fields import Fields

RECORDS: Mapping[str, Fields] = {
    "contact": CONTACT,
    "active": ACTIVE,
    "body": BODY,
    "articulation": ARTICULATION,
    "joint": JOINT,
    "load": LOAD,
    "unit": UNIT,
    "wall": WALL,
    "pool": POOL,
    "pair": PAIR_OF_PARTS,
    "carrier": CARRIER,
    "own_guard": OWN_GUARD,
    "guard": GUARD,
    "unknown": UNKNOWN,
}
"""Records whose fields stand in arrays, by kind."""
SEQUENCES: Mapping[str, tuple[str, str]] = {
    "contacts": ("contact", "n_contacts"),
    "actives": ("active", "n_active"),
    "bodies": ("body", "n_bodies"),
    "articulations": ("articulation", "n_articulations"),
    "joints": ("joint", "n_joints"),
    "loads": ("load", "n_loads"),
    "units": ("unit", "n_units"),
    "walls": ("wall", "n_walls"),
    "pools": ("pool", "n_pools"),
    "pairs": ("pair", "n_pairs"),
    "carriers": ("carrier", "n_carriers"),
    "own_guards": ("own_guard", "n_own_guards"),
    "guards": ("guard", "n_contacts"),
    "unknowns": ("unknown", "n_unknown"),
}
"""Sequences of the workspace by name: the kind of their records, and the scalar that counts them."""

PARTS: Mapping[str, Mapping[str, str]] = {
    "tolerance": {"time": "time_tolerance", "gap": "gap_tolerance", "velocity": "velocity_tolerance"},
    "island": {
        "time": "t",
        "follows_a_step": "fresh",
        "averaged_until": "mean_until",
        "last_feature_change": "feature_t",
    },
    "run": {"is_interrupted": "stopped", "painleve_policy": "policy", "impact_map": "impact_map"},
    "totals": {
        "driven_work": "driven_work",
        "restitution_loss": "restitution_loss",
        "friction_loss": "friction_loss",
        "closing_loss": "closing_loss",
        "impacts": "impacts",
    },
    "event": {"n_recorded": "recorded", "n_phases": "phases", "truncation": "truncated"},
    "impact": {
        "lone_contact": "lone",
        "last_guard": "trigger",
        "speed_scale": "speed_scale",
        "acceleration_scale": "acceleration_scale",
        "slow_speed": "slow_speed",
    },
}
"""Scalars of the workspace by owner or life: the name in the part, and the scalar."""
QUESTIONS = frozenset({"follows_a_step", "is_interrupted"})
"""Scalars of parts that are true or false."""
PACKED: Mapping[str, Fields] = {
    "impact_state": IMPACT_STATE,
    "part_end": PART_OF_STEP,
    "delassus_block": DELASSUS_BLOCK,
    "joint_row": ROW_OF_JOINT,
    "frame": FRAME_OF_BODY,
    "part": CONVEX_PART,
    "load_wrench": WRENCH_OF_LOAD,
}
"""Records in the heap of floats, by kind: one behind another, or with stride 0 each by itself."""
