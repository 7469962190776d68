"""The instant of an event, and what is recorded."""

from __future__ import annotations

from nonsmooth.engine.memory.arrays.arrays import Arrays, fixed, per
from nonsmooth.engine.memory.limits import LIMITS

ARRAYS = Arrays(
    floats={
        "event_head": fixed(5),
        "event_impulse": per(3, "n_slots"),
        "direction_agreed": per(2, "n_slots"),
        "u_before": per(1, "n_u"),
    },
    integers={
        "code_before": per(1, "n_slots"),
        "code_during": per(1, "n_slots"),
        "mode_agreed": per(1, "n_slots"),
        "closes": per(1, "n_slots"),
        "listed": per(1, "n_slots"),
        "limits": fixed(len(LIMITS)),
    },
    later_floats={
        "events": per(1, "event_floats"),
        "samples": lambda n: n["sample_capacity"] * (n["n_y"] + 1),
    },
    later_integers={
        "event_codes": per(1, "event_integers"),
    },
)
