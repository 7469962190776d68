"""Impacts: processes in impulses, and maps."""

from __future__ import annotations

from nonsmooth.engine.memory.arrays.arrays import Arrays, per, real, whole
from nonsmooth.engine.memory.blocks import GUARD
from nonsmooth.engine.memory.layout import N_STAGES, TOTALS

ARRAYS = Arrays(
    scalars={
        **whole(
            "map_width",
            "phases",
            "impact_steps",
            "culprit",
            "impact_map",
            "map_past",
            "trigger",
            "aimed",
            "lone",
            "n_colliding",
            "may_be_lone",
            "phases_kept",
            "truncated",
            "slow_steps",
        ),
        **real(
            "impact_rtol",
            "speed_scale",
            "slow_speed",
            "impact_h",
            "faint",
            "guard_slope",
            "rest_speed",
        ),
    },
    floats={
        "map_block": lambda n: n["map_width"] * n["n_slots"],
        "impact_z0": per(3, "n_slots"),
        "impact_z": per(3, "n_slots"),
        "impact_guard": per(3, "n_slots"),
        "impact_guard_first": per(3, "n_slots"),
        "rest_slip": per(1, "n_slots"),
        "impact_x_scale": per(1, "n_slots"),
        "impact_f_scale": per(1, "n_slots"),
        "impact_energy_scale": per(1, "n_slots"),
        "impulse_scale": per(1, "n_slots"),
        "books_kept": per(5, "n_slots"),
        "impact_mark": per(1, "n_slots"),
        "stored": per(1, "n_slots"),
        "returned": per(1, "n_slots"),
        "rubbed": per(1, "n_slots"),
        "impulse": lambda n: 3 * n["n_slots"] + GUARD,
        "u_impact": per(1, "n_u"),
        "impact_total": per(TOTALS, "n_slots"),
    },
    integers={
        "impacting": per(1, "n_slots"),
        "released": per(1, "n_slots"),
        "phase": per(1, "n_slots"),
        "halted": per(1, "n_slots"),
        "lossless": per(1, "n_slots"),
        "phase_kept": per(1, "n_slots"),
        "held_kept": per(1, "n_slots"),
        "colliding": per(1, "n_slots"),
        "depth": per(1, "n_slots"),
        "rim": per(1, "n_slots"),
        "waves": per(1, "n_slots"),
        "chain": per(2, "n_slots"),
        "articulation_head": per(1, "n_articulations"),
        "kept": per(2, "n_slots"),
        "armed": per(3, "n_slots"),
    },
    later_floats={
        "impact_y": per(8, "n_slots"),
        "impact_new": per(8, "n_slots"),
        "impact_stage": per(8, "n_slots"),
        "impact_guess": per(8, "n_slots"),
        "impact_slopes": per(8 * N_STAGES, "n_slots"),
        "impact_kept": per(8, "n_slots"),
    },
)
