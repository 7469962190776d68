"""Pairs of convex parts of bodies between which contacts are declared, and the search for their separation."""

from __future__ import annotations

from nonsmooth.engine.memory.arrays.arrays import Arrays, fixed, per, real, whole

ARRAYS = Arrays(
    scalars={
        **whole(
            "n_pairs",
            "n_carriers",
        ),
        **real(
            "passed_depth",
            "passed_explained",
        ),
        # no pair of bodies has passed into each other
        "passed": -1,
    },
    floats={
        "pair_allowed": per(1, "n_pairs"),
        "pair_size": per(1, "n_pairs"),
        "carrier_lever": per(1, "n_carriers"),
    },
    integers={
        "carrier_frame": per(1, "n_carriers"),
        "pair_carrier_a": per(1, "n_pairs"),
        "pair_carrier_b": per(1, "n_pairs"),
        "pair_frame_a": per(1, "n_pairs"),
        "pair_frame_b": per(1, "n_pairs"),
        "pair_part_a": per(1, "n_pairs"),
        "pair_part_b": per(1, "n_pairs"),
        "pair_group": per(1, "n_pairs"),
        "pair_contact": per(1, "n_pairs"),
        "pair_flat": per(1, "n_pairs"),
    },
    # renewed by every look: no step finds in them what changes a motion
    later_floats={
        "carrier_place": per(3, "n_carriers"),
        "carrier_axes": per(9, "n_carriers"),
        "carrier_way": per(1, "n_carriers"),
        "pair_room": per(1, "n_pairs"),
        "pair_direction": per(3, "n_pairs"),
        "pair_normal": per(3, "n_pairs"),
        "pair_between": per(3, "n_pairs"),
        "pair_deepest": per(1, "n_pairs"),
        "simplex": fixed(16),
    },
    later_integers={
        "pair_closed": per(1, "n_pairs"),
    },
)
