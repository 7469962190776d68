"""The engine's memory: one table of scalars, one of float arrays, one of integer arrays.

Everything that the engine knows stands in one record ``S`` of scalars and two heaps.  An entry of
``S`` named after an array holds the offset of that array in its heap, so ``w[S.gap + c]`` is the gap
of contact ``c`` and ``k[S.mode + c]`` its mode.  All sizes are run-time counts: another number of
bodies or contacts is another set of offsets, never another compilation.

Every body owns an output block, written by its ``evaluate`` function, with the parts below in this
order.  The parts down to the Jacobian belong to a frame and are repeated for every frame of the body; :data:`FRAME`
floats of frame motion are all that a driven body writes.

======================  ===============  =======================================================
part                    size             meaning
======================  ===============  =======================================================
position                3                origin of the body frame [m]
rotation                9                body axes as columns, row by row
velocity                3                of the origin [m/s]
angular velocity        3                in world axes [rad/s]
acceleration bias       3                of the origin while u' = 0 [m/s^2]
angular bias            3                in world axes while u' = 0 [rad/s^2]
jacobian                6 n_u            of (velocity, angular velocity) with respect to u
coordinate rates        n_q              dq/dt = B u
force                   n_u              h of M u' = h + W lambda_N + N lambda_T
inverse mass            n_u n_u          M^-1
energy                  2                kinetic and potential [J]
======================  ===============  =======================================================

The geometry block of a contact holds gap, normal (from the first body to the second), first
tangent, witness points on both bodies and, for either surface, the matrices ``slide`` and ``turn`` of
``slide @ u = turn @ nu``: the witness sliding at u over the body turns the normal by nu (both in the
tangent plane; they commute).  A sphere of radius r has slide 1, turn r; a plane slide 0, turn 1; a vertex slide 1,
turn 0.  A point contact needs a curved or sharp side: two planes have none.  Last comes the number of the pair of
features that are in contact, out of the kinematics' ``features``.

A joint writes :data:`JOINT_ROW` floats per row: residual [m or 1], axis and moment, a point on either body, bias.
The row's rate is axis . (velocity of the second body at its point - of the first at its own) + moment . (difference
of the angular velocities); the bias is its derivative while u' = 0.

A load writes force [N] on the second body, the point where it acts [m], and moment [N m]; the first body gets the
opposite.

Bodies tied by joints form a linkage, every other body is a linkage of its own; its bodies stand next to each other.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from nonsmooth.model import tableau

FRAME = 24
"""Floats of frame motion at the head of a body's output block."""
GEOMETRY = 30
"""Floats of a contact's geometry block."""
JOINT_ROW = 14
"""Floats of one row of a joint."""
LOAD = 9
"""Floats that a load writes."""
N_STAGES = len(tableau.NODES)
"""Stages of the Runge-Kutta pair."""

ROOMS = (
    "resolve",
    "gauss_seidel",
    "energetic_impact",
    "run_impact",
    "windowed_impact",
    "evaluate_impact_forces",
    "solve_contact",
    "solve_from_rates",
    "find_modes",
    "verify",
    "spread",
    "polish",
    "enumerate_modes",
    "search_by_pivots",
    "search_by_newton",
    "right_hand_side",
    "slope",
    "evaluate_contact",
    "evaluate_at",
    "guards_within",
    "settle",
    "advance",
    "try_step",
    "collide",
    "touch",
    "project_rates",
    "project_joints",
    "set_up",
    "first_crossing",
    "locate",
    "choose_friction",
    "locate_switch",
)
"""Engine functions that are compiled apart and called by address (:func:`nonsmooth.engine.kernel.room`)."""

INTEGER_SCALARS = (
    "n_bodies",
    "n_contacts",
    "n_own_guards",
    "n_loads",
    "n_joints",
    "n_linkages",
    "own",
    "n_q",
    "n_u",
    "n_y",
    "n_active",
    "n_unknown",
    "n_redundant",
    "deficient",
    "lenient",
    "n_pivoted",
    "solver",
    "map_width",
    "event_capacity",
    "sample_capacity",
    "n_events",
    "n_samples",
    "event_width",
    "status",
    "started",
    "steps",
    "rejected",
    "impacts",
    "phases",
    "impact_steps",
    "culprit",
    "impact_map",
    "painleve",
    "trigger",
    "aimed",
    "lone",
    "windowed",
    "n_colliding",
    "may_be_lone",
    "phases_kept",
    "truncated",
    "slow_steps",
    "fresh",
    "suspect",
    "repeated",
    "recorded",
    "approaching",
    "sample_index",
)
FLOAT_SCALARS = (
    "t",
    "t_end",
    "driven_t",
    "h",
    "step_error",
    "h_max",
    "h_free",
    "h_first",
    "h_closed",
    "rtol",
    "impact_rtol",
    "time_tolerance",
    "gap_tolerance",
    "velocity_tolerance",
    "sample_interval",
    "next_sample",
    "driven_work",
    "driven_power",
    "load_power",
    "friction_loss",
    "restitution_loss",
    "closing_loss",
    "speed_scale",
    "impact_seed",
    "impact_h",
    "faint",
    "last_event_t",
    "guard_slope",
    "rest_speed",
    "acceleration_scale",
    "small_acceleration",
    "small_force",
)

_Size = Callable[[Mapping[str, int]], int]


def _per(stride: int, count: str) -> _Size:
    return lambda n: stride * n[count]


def _guards(n: Mapping[str, int]) -> int:
    return 2 * n["n_contacts"] + n["n_own_guards"]


_FLOAT_ARRAYS: dict[str, _Size] = {
    "stages": lambda n: 6 * N_STAGES,
    "error_weights": lambda n: N_STAGES,
    "dense": lambda n: 4 * N_STAGES,
    "y": _per(1, "n_y"),
    "y_new": _per(1, "n_y"),
    "y_stage": _per(1, "n_y"),
    "y_scale": _per(1, "n_y"),
    "slopes": _per(N_STAGES, "n_y"),
    "du": _per(1, "n_u"),
    "geometry": _per(GEOMETRY, "n_contacts"),
    "axes": _per(9, "n_contacts"),
    "small": lambda n: 4,
    "rate": _per(3, "n_contacts"),
    "prescribed_rate": _per(3, "n_contacts"),
    "bias": _per(3, "n_contacts"),
    "direction": _per(2, "n_contacts"),
    "guard": _guards,
    "least_force": _per(1, "n_contacts"),
    "guard_middle": _guards,
    "guard_first": _guards,
    "guard_start": _guards,
    "gap_rate": _per(1, "n_contacts"),
    "gap_rate_first": _per(1, "n_contacts"),
    "gap_rate_middle": _per(1, "n_contacts"),
    "gap_rate_end": _per(1, "n_contacts"),
    "gap_middle": _per(1, "n_contacts"),
    "gap_end": _per(1, "n_contacts"),
    "guard_end": _guards,
    "rate_end": _per(3, "n_contacts"),
    "map_block": lambda n: n["map_width"] * n["n_contacts"],
    "contact_time": _per(1, "n_contacts"),
    # the local problem of the active contacts
    "delassus": lambda n: (3 * n["n_contacts"]) ** 2,
    "b": _per(3, "n_contacts"),
    "f": _per(3, "n_contacts"),
    "d": _per(2, "n_contacts"),
    "mu": _per(1, "n_contacts"),
    "mu_static": _per(1, "n_contacts"),
    "mu_kept": _per(1, "n_contacts"),
    "static_kept": _per(1, "n_contacts"),
    "d_found": _per(2, "n_contacts"),
    "d_closed": _per(2, "n_contacts"),
    "f_raw": _per(3, "n_contacts"),
    "f_kept": _per(3, "n_contacts"),
    "tableau": lambda n: 6 * n["n_pivoted"] * (6 * n["n_pivoted"] + 2),
    "margin": _per(1, "n_contacts"),
    "acceleration": _per(3, "n_contacts"),
    "event_head": lambda n: 5,
    "event_impulse": _per(3, "n_contacts"),
    # linear algebra
    "reduced": lambda n: (3 * n["n_contacts"]) ** 2,
    "matrix": lambda n: (3 * n["n_contacts"]) ** 2,
    "basis": lambda n: (3 * n["n_contacts"]) ** 2,
    "null": lambda n: (3 * n["n_contacts"]) ** 2,
    "right": _per(3, "n_contacts"),
    "x": _per(3, "n_contacts"),
    "sigma": _per(3, "n_contacts"),
    # the impact
    "impact_y": _per(8, "n_contacts"),
    "impact_new": _per(8, "n_contacts"),
    "impact_stage": _per(8, "n_contacts"),
    "impact_slopes": _per(8 * N_STAGES, "n_contacts"),
    "impact_z0": _per(3, "n_contacts"),
    "impact_z": _per(3, "n_contacts"),
    "impact_guard": _per(3, "n_contacts"),
    "impact_guard_first": _per(3, "n_contacts"),
    "impact_x_scale": _per(1, "n_contacts"),
    "impact_f_scale": _per(1, "n_contacts"),
    "impact_energy_scale": _per(1, "n_contacts"),
    "impact_kept": _per(8, "n_contacts"),
    "books_kept": _per(5, "n_contacts"),
    "impact_mark": _per(1, "n_contacts"),
    "stored": _per(1, "n_contacts"),
    "returned": _per(1, "n_contacts"),
    "rubbed": _per(1, "n_contacts"),
    "impulse": _per(3, "n_contacts"),
    "u_before": _per(1, "n_u"),
    "u_own": _per(1, "n_u"),
    "u_impact": _per(1, "n_u"),
    "impact_total": _per(8, "n_contacts"),
    # output
    "events": lambda n: n["event_capacity"] * n["event_width"],
    "samples": lambda n: n["sample_capacity"] * (n["n_y"] + 1),
}
_INTEGER_ARRAYS: dict[str, _Size] = {
    "rooms": lambda n: len(ROOMS),
    "body_q": _per(1, "n_bodies"),
    "body_u": _per(1, "n_bodies"),
    "body_nq": _per(1, "n_bodies"),
    "body_nu": _per(1, "n_bodies"),
    "body_function": _per(1, "n_bodies"),
    "body_parameters": _per(1, "n_bodies"),
    "body_out": _per(1, "n_bodies"),
    "body_tail": _per(1, "n_bodies"),
    "body_quaternion": _per(1, "n_bodies"),
    "linkage_u": _per(1, "n_linkages"),
    "linkage_nu": _per(1, "n_linkages"),
    "linkage_body": _per(1, "n_linkages"),
    "linkage_bodies": _per(1, "n_linkages"),
    "linkage_inverse": _per(1, "n_linkages"),
    "linkage_joint": _per(1, "n_linkages"),
    "linkage_joints": _per(1, "n_linkages"),
    "linkage_rows": _per(1, "n_linkages"),
    "linkage_driven": _per(1, "n_linkages"),
    "linkage_jacobian": _per(1, "n_linkages"),
    "linkage_r": _per(1, "n_linkages"),
    "linkage_y": _per(1, "n_linkages"),
    "linkage_factor": _per(1, "n_linkages"),
    "linkage_residual": _per(1, "n_linkages"),
    "linkage_rate": _per(1, "n_linkages"),
    "linkage_bias": _per(1, "n_linkages"),
    "linkage_x": _per(1, "n_linkages"),
    "joint_function": _per(1, "n_joints"),
    "joint_parameters": _per(1, "n_joints"),
    "joint_frame_a": _per(1, "n_joints"),
    "joint_frame_b": _per(1, "n_joints"),
    "joint_nu_a": _per(1, "n_joints"),
    "joint_nu_b": _per(1, "n_joints"),
    "joint_shift_a": _per(1, "n_joints"),
    "joint_shift_b": _per(1, "n_joints"),
    "joint_first": _per(1, "n_joints"),
    "joint_rows": _per(1, "n_joints"),
    "joint_out": _per(1, "n_joints"),
    "load_function": _per(1, "n_loads"),
    "load_parameters": _per(1, "n_loads"),
    "load_frame_a": _per(1, "n_loads"),
    "load_frame_b": _per(1, "n_loads"),
    "load_body_a": _per(1, "n_loads"),
    "load_body_b": _per(1, "n_loads"),
    "load_out": _per(1, "n_loads"),
    "frame_a": _per(1, "n_contacts"),
    "frame_b": _per(1, "n_contacts"),
    "nu_a": _per(1, "n_contacts"),
    "nu_b": _per(1, "n_contacts"),
    "shift_a": _per(1, "n_contacts"),
    "shift_b": _per(1, "n_contacts"),
    "linkage_a": _per(1, "n_contacts"),
    "linkage_b": _per(1, "n_contacts"),
    "geometry_function": _per(1, "n_contacts"),
    "geometry_parameters": _per(1, "n_contacts"),
    "friction_function": _per(1, "n_contacts"),
    "friction_parameters": _per(1, "n_contacts"),
    "force_function": _per(1, "n_contacts"),
    "force_parameters": _per(1, "n_contacts"),
    "efficiency_function": _per(1, "n_contacts"),
    "efficiency_parameters": _per(1, "n_contacts"),
    "map_parameters": _per(1, "n_contacts"),
    "jacobian_a": _per(1, "n_contacts"),
    "jacobian_b": _per(1, "n_contacts"),
    "response_a": _per(1, "n_contacts"),
    "response_b": _per(1, "n_contacts"),
    "mode": _per(1, "n_contacts"),
    "code_before": _per(1, "n_contacts"),
    "code_during": _per(1, "n_contacts"),
    "mode_tried": _per(1, "n_contacts"),
    "touching": _per(1, "n_contacts"),
    "impacting": _per(1, "n_contacts"),
    "active": _per(1, "n_contacts"),
    "normal_held": _per(1, "n_contacts"),
    "tangent_held": _per(1, "n_contacts"),
    "at_rest": _per(1, "n_contacts"),
    "redundant": _per(1, "n_contacts"),
    "freed": _per(1, "n_contacts"),
    "mode_past": _per(1, "n_contacts"),
    "mode_found": _per(1, "n_contacts"),
    "mode_closed": _per(1, "n_contacts"),
    "lemke_contact": _per(6, "n_pivoted"),
    "lemke_corner": _per(6, "n_pivoted"),
    "lemke_row": _per(6, "n_pivoted"),
    "lemke_column": lambda n: 6 * n["n_pivoted"] + 1,
    "column": _per(3, "n_contacts"),
    "row_contact": _per(3, "n_contacts"),
    "row_index": _per(3, "n_contacts"),
    "phase": _per(1, "n_contacts"),
    "phase_kept": _per(1, "n_contacts"),
    "held_kept": _per(1, "n_contacts"),
    "colliding": _per(1, "n_contacts"),
    "depth": _per(1, "n_contacts"),
    "rim": _per(1, "n_contacts"),
    "waves": _per(1, "n_contacts"),
    "chain": _per(2, "n_contacts"),
    "linkage_head": _per(1, "n_linkages"),
    "kept": _per(2, "n_contacts"),
    "armed": _per(3, "n_contacts"),
    "guard_armed": _guards,
    "guard_deflated": _guards,
    "own_guard_function": _per(1, "n_own_guards"),
    "own_guard_parameters": _per(1, "n_own_guards"),
    "own_guard_ends": _per(1, "n_own_guards"),
    "own_guard_spent": _per(1, "n_own_guards"),
    "event_codes": lambda n: n["event_capacity"] * (4 + n["n_contacts"]),
}

SCALARS = np.dtype(
    [(name, "i8") for name in INTEGER_SCALARS]
    + [(name, "f8") for name in FLOAT_SCALARS]
    + [(name, "i8") for name in (*_FLOAT_ARRAYS, *_INTEGER_ARRAYS)],
    align=True,
)
"""The record ``S``."""
COUNTS = (
    "n_bodies",
    "n_contacts",
    "n_own_guards",
    "n_loads",
    "n_joints",
    "n_linkages",
    "n_q",
    "n_u",
    "n_y",
    "n_pivoted",
    "map_width",
    "event_capacity",
    "event_width",
    "sample_capacity",
)
"""The run-time sizes that :func:`allocate` takes."""
CONSTANT_SCALARS = frozenset((*COUNTS, *_FLOAT_ARRAYS, *_INTEGER_ARRAYS))
"""What never changes once the memory is laid out."""


class Heap:
    """The blocks that come behind the fixed arrays: output blocks, Jacobians, parameters."""

    def __init__(self, memory: Memory) -> None:
        self._memory = memory
        self._blocks: list[np.ndarray] = []
        self._next = len(memory.floats)

    def block(self, size: int) -> int:
        """Reserve floats; return their offset."""
        return self.store(np.zeros(size))

    def store(self, values: Sequence[float] | np.ndarray) -> int:
        """Append values; return their offset."""
        start = self._next
        self._blocks.append(np.asarray(values, dtype=float))
        self._next += len(values)
        return start

    def close(self) -> Memory:
        """Return the memory with all blocks in it."""
        old = self._memory
        return Memory(old.scalars, np.concatenate([old.floats, *self._blocks, np.zeros(1)]), old.integers)


@dataclass(frozen=True)
class Memory:
    """Scalars and heaps of one trajectory.

    Attributes
    ----------
    scalars : numpy.ndarray
        The record ``S``, shape [1].
    floats : numpy.ndarray
        The heap ``w``: the arrays of the table, then the blocks that the assembly appended.
    integers : numpy.ndarray
        The heap ``k``.
    """

    scalars: np.ndarray
    floats: np.ndarray
    integers: np.ndarray

    def array(self, name: str, size: int) -> np.ndarray:
        """Return a view of ``size`` entries of the named array."""
        heap = self.floats if name in _FLOAT_ARRAYS else self.integers
        start = int(self.scalars[0][name])
        return heap[start : start + size]


def allocate(counts: Mapping[str, int]) -> Memory:
    """Lay out the arrays for the given counts, all of ``COUNTS``; blocks are appended by :class:`Heap`."""
    scalars = np.zeros(1, SCALARS)
    totals: list[int] = []
    for table in (_FLOAT_ARRAYS, _INTEGER_ARRAYS):
        total = 0
        for name, size in table.items():
            scalars[name] = total
            total += size(counts)
        totals.append(total)
    for name, value in counts.items():
        scalars[name] = value
    memory = Memory(scalars, np.zeros(totals[0]), np.zeros(max(totals[1], 1), np.int64))
    memory.array("stages", 6 * N_STAGES)[:] = np.ravel(tableau.STAGES)
    memory.array("error_weights", N_STAGES)[:] = tableau.ERROR
    memory.array("dense", 4 * N_STAGES)[:] = np.ravel(tableau.DENSE)
    return memory
