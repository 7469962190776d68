"""The problem of the active contacts, its solvers, and its linear algebra."""

from __future__ import annotations

import math

from nonsmooth.engine.memory.arrays.arrays import Arrays, ends, entries, per, real, whole

ARRAYS = Arrays(
    scalars={
        **whole(
            "n_unknown",
            "deficient",
            "held_rank",
            "null_banded",
            "n_pivoted",
            "solver",
            "singular",
            "turning",
            "guess",
            "unsettled",
            "evaluations",
            "stray",
        ),
        **real(
            "ahead",
            "effort",
            "acceleration_scale",
            "small_acceleration",
            "small_force",
            "strayed",
        ),
        # no forces are averaged
        "mean_until": math.inf,
    },
    floats={
        "active_forces": per(3, "n_slots"),
        "active_directions": per(2, "n_slots"),
        "mu": per(1, "n_slots"),
        "mu_static": per(1, "n_slots"),
        "mu_kept": per(1, "n_slots"),
        "static_kept": per(1, "n_slots"),
        "active_directions_found": per(2, "n_slots"),
        "active_directions_closed": per(2, "n_slots"),
        "active_forces_first": per(3, "n_slots"),
        "active_forces_kept": per(3, "n_slots"),
        "margin": per(1, "n_slots"),
        "acceleration": per(3, "n_slots"),
        "null_space_force": per(3, "n_slots"),
        "mean_force": per(3, "n_slots"),
        "mean_span": per(1, "n_slots"),
        "mean_way": per(1, "n_slots"),
        "mean_gap": per(1, "n_slots"),
        "mean_asked": per(1, "n_slots"),
        "mean_wait": per(1, "n_slots"),
        "gap_meant": per(1, "n_slots"),
        "slack": per(1, "n_slots"),
        "right": per(3, "n_slots"),
        "x": per(3, "n_slots"),
        "sigma": per(6, "n_slots"),
        "rigid_diagonal": per(3, "n_slots"),
    },
    integers={
        "mode_tried": per(1, "n_slots"),
        "normal_held": per(1, "n_slots"),
        "tangent_held": per(1, "n_slots"),
        "at_rest": per(1, "n_slots"),
        "redundant": per(1, "n_slots"),
        "freed": per(1, "n_slots"),
        "given": per(1, "n_slots"),
        "mode_past": per(1, "n_slots"),
        "mode_found": per(1, "n_slots"),
        "mode_closed": per(1, "n_slots"),
        "lemke_contact": per(6, "n_pivoted"),
        "lemke_corner": per(6, "n_pivoted"),
        "lemke_row": per(6, "n_pivoted"),
        "lemke_column": lambda n: 6 * n["n_pivoted"] + 1,
        "unknown_contact": per(3, "n_slots"),
        "unknown_direction": per(3, "n_slots"),
        "unknown_turn": per(3, "n_slots"),
        "first_unknown": ends("n_slots"),
    },
    later_floats={
        "reduced": entries,
        "basis": entries,
        "null": entries,
        "tableau": lambda n: 6 * n["n_pivoted"] * (6 * n["n_pivoted"] + 2),
    },
)
