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
