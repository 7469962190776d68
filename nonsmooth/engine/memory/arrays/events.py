"""The instant of an event, and what is recorded."""

from __future__ import annotations

import math

from nonsmooth.engine.memory.arrays.arrays import Arrays, fixed, per, real, whole
from nonsmooth.engine.memory.layout import BOOKED
from nonsmooth.engine.memory.limits import LIMITS

ARRAYS = Arrays(
    scalars={
        **whole(
            "event_floats",
            "event_integers",
            "sample_capacity",
            "n_events",
            "floats_used",
            "integers_used",
            "last_floats",
            "last_contact",
            "last_integers",
            "told",
            "n_samples",
            "started",
            "resumed",
            "steps",
            "rejected",
            "limit",
            "impacts",
            "policy",
            "halting",
            "recorded",
            "sample_index",
            "calls",
            "evaluated",
        ),
        **real(
            "t_end",
            "h_free",
            "h_listed",
            "h_first",
            "h_closing",
            "h_turn",
            "h_arrival",
            "h_closed",
            "h_valid",
            "end_of_valid",
            "time_resolution",
            "sample_start",
            "sample_interval",
            "next_sample",
            "crowd",
            "crowd_t",
        ),
        # in which samples fill half of their room
        "sample_span": math.inf,
    },
    floats={
        "event_head": fixed(5),
        "event_impulse": per(3, "n_slots"),
        "direction_agreed": per(2, "n_slots"),
        "u_before": per(1, "n_u"),
    },
    integers={
        "code_before": per(1, "n_slots"),
        "code_during": per(1, "n_slots"),
        "averaged_before": per(1, "n_slots"),
        "mode_agreed": per(1, "n_slots"),
        "closes": per(1, "n_slots"),
        "listed": per(1, "n_slots"),
        "limits": fixed(len(LIMITS)),
    },
    later_floats={
        "events": per(1, "event_floats"),
        "samples": lambda n: n["sample_capacity"] * (1 + n["n_y"] + BOOKED),
    },
    later_integers={
        "event_codes": per(1, "event_integers"),
    },
)
