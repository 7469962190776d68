"""Steps between events, guards, and the search for the first event."""

from __future__ import annotations

from nonsmooth.engine.memory.arrays.arrays import Arrays, fixed, guards, per
from nonsmooth.engine.memory.layout import N_STAGES, PART_END, PARTS

ARRAYS = Arrays(
    floats={
        "y_new": per(1, "n_y"),
        "y_stage": per(1, "n_y"),
        "y_scale": per(1, "n_y"),
        "slopes": per(N_STAGES, "n_y"),
        "y_guess": per(1, "n_y"),
        "slope_kept": per(1, "n_y"),
        "guard": guards,
        "least_force": per(1, "n_slots"),
        "guard_middle": guards,
        "guard_first": guards,
        "guard_start": guards,
        "gap_rate": per(1, "n_slots"),
        "gap_rate_first": per(1, "n_slots"),
        "gap_rate_end": per(1, "n_slots"),
        "gap_first": per(1, "n_slots"),
        "gap_end": per(1, "n_slots"),
        "past_end": per(1, "n_slots"),
        "past_first": per(1, "n_slots"),
        "speed_end": per(1, "n_slots"),
        "speed_first": per(1, "n_slots"),
        "fall_end": per(3, "n_slots"),
        "fall_first": per(3, "n_slots"),
        "arm_end": per(3, "n_slots"),
        "arm_first": per(3, "n_slots"),
        "leap_start": per(6, "n_slots"),
        "leap_way": per(6, "n_slots"),
        "small_force_of": per(1, "n_slots"),
        "mobility": per(1, "n_slots"),
        "part_ends": fixed(PART_END * (PARTS + 1)),
        "guard_end": guards,
        "rate_end": per(3, "n_slots"),
        "static_margin": per(1, "n_slots"),
        "crowd_start": per(1, "n_slots"),
    },
    integers={
        "feature": per(1, "n_slots"),
        "guard_armed": guards,
        "guard_deflated": guards,
        "doubtful": per(1, "n_slots"),
        "astray": per(1, "n_slots"),
        "redundant_contact": per(1, "n_slots"),
        "holds": per(1, "n_slots"),
        "crowd_events": per(1, "n_slots"),
    },
)
