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
turn 0.  A point contact needs a curved or sharp side: two planes have none.  Then comes the number of the pair of
features that are in contact, out of the kinematics' ``features``, and last how far the witness points are past the
ends of features that end, such as edges and the faces of a polyhedron [m]: negative within, 0 where nothing ends.  Past
an end the gap is a number that no rate belongs to, positive unless the bodies overlap, and a closed contact opens.

A joint writes :data:`JOINT_ROW` floats per row: residual [m or 1], axis and moment, a point on either body, bias.
The row's rate is axis . (velocity of the second body at its point - of the first at its own) + moment . (difference
of the angular velocities); the bias is its derivative while u' = 0.

A load writes force [N] on the second body, the point where it acts [m], and moment [N m]; the first body gets the
opposite.

Bodies tied by joints form a linkage, every other body is a linkage of its own; its bodies stand next to each other.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from nonsmooth.engine.memory import tableau
from nonsmooth.engine.memory.rooms import ROOMS
from nonsmooth.engine.memory.scalars import FLOAT_SCALARS, INTEGER_SCALARS

FRAME = 24
"""Floats of frame motion at the head of a body's output block."""
GUARD = 8
"""Floats behind each block that a plug-in writes: one that writes past its block is found by them."""
UNTOUCHED = 1.2345678901234567e-89
"""What stands there."""
FEATURE, PAST_END = 29, 30
"""Where in a geometry block stand the number of the features in contact and how far the contact is past their end."""
PAIR = 31
"""Floats of a geometry block that a kinematics writes."""
GEOMETRY = PAIR + GUARD
"""Floats of a contact's geometry block."""
JOINT_ROW = 14
"""Floats of one row of a joint."""
LOAD = 9
"""Floats that a load writes."""
FORCE_AND_MOMENT = 5
"""Floats that a law of traction writes before the rates of its states."""
CATALOGUE = (
    "body_a",
    "body_b",
    "frame_a",
    "frame_b",
    "nu_a",
    "nu_b",
    "shift_a",
    "shift_b",
    "linkage_a",
    "linkage_b",
    "geometry_function",
    "geometry_parameters",
    "friction_function",
    "friction_parameters",
    "force_function",
    "force_parameters",
    "efficiency_function",
    "efficiency_parameters",
    "map_parameters",
    "normal_function",
    "normal_parameters",
    "traction_function",
    "traction_parameters",
    "traction_out",
    "rates_function",
    "rates_parameters",
    "rates_out",
    "state",
    "n_state",
    "state_start",
    "state_copy",
    "oriented",
    "axis",
    "candidate",
    "mode",
)
"""Integers of a declared contact; in a slot each of them is an array of its own."""
CANDIDATE = 3
"""Numbers of a pair of features in a pool; the first is not 0."""
CATALOGUE_FLOATS = 8
"""Floats of a contact: contact time, slip direction, reach, rate at which it closed, levers, size of the smaller."""
SECTORS = 48
"""Halvings of a step in search of a gap that closes: as many as its fractions can be told apart."""
SECTOR = 7
"""Floats of an end of a part of a step: fraction, gap, gap rate, how far past the end of the features, witness arm."""
FALL = 3
"""Floats of how fast the rate of a gap can fall: now, by how much more each second, and the turning [rad/s]."""
ORIENTED = 7
"""Numbers of an anisotropic law: side of the body, its axis, friction forward, backward and across."""
N_ACCOUNTS = 4
"""Energies integrated with the state: work of driven bodies, loss to friction, gross exchange, work of loads."""
BOOKED = 4
"""Energies booked at instants and projections: work of driven bodies, losses by restitution, friction and closing."""
MOST_BLOCKS = 2**22
"""Pairs of contacts that act on one another, of which a system has room for all up to so many."""
MOST_ENTRIES = 2**26
"""Entries of a matrix of the contacts' unknowns, of which there is room for all up to so many."""
STIFF = 8
"""Contacts of an impact, at most, whose stiff slips are integrated implicitly."""
N_STAGES = len(tableau.NODES)
"""Stages of the Runge-Kutta pair."""
TOTALS = 9
"""Floats of a contact that go from one window of a large impact to the next."""

Size = Callable[[Mapping[str, int]], int]


def _per(stride: int, count: str) -> Size:
    return lambda n: stride * n[count]


def _entries(n: Mapping[str, int]) -> int:
    return int(min((3 * n["n_slots"]) ** 2, MOST_ENTRIES))


def _blocks(n: Mapping[str, int]) -> int:
    return int(min(n["n_slots"] ** 2, MOST_BLOCKS))


def _guards(n: Mapping[str, int]) -> int:
    return 3 * n["n_slots"] + n["n_own_guards"]


FLOAT_ARRAYS: dict[str, Size] = {
    "stages": lambda n: 6 * N_STAGES,
    "error_weights": lambda n: N_STAGES,
    "dense": lambda n: 4 * N_STAGES,
    "y": _per(1, "n_y"),
    "y_new": _per(1, "n_y"),
    "y_stage": _per(1, "n_y"),
    "y_scale": _per(1, "n_y"),
    "slopes": _per(N_STAGES, "n_y"),
    "du": _per(1, "n_u"),
    "geometry": _per(GEOMETRY, "n_slots"),
    "axes": _per(9, "n_slots"),
    "small": lambda n: 4,
    "rate": _per(3, "n_slots"),
    "slip": _per(2, "n_slots"),
    "skew": _per(4, "n_slots"),
    "tangents": lambda n: 6,
    "motion": lambda n: 5,
    "wrench": lambda n: 6,
    "given": _per(1, "n_slots"),
    "reach": _per(1, "n_slots"),
    "closing_rate": _per(1, "n_slots"),
    "turned": _per(1, "n_slots"),
    "prescribed_rate": _per(3, "n_slots"),
    "bias": _per(3, "n_slots"),
    "direction": _per(2, "n_slots"),
    "guard": _guards,
    "least_force": _per(1, "n_slots"),
    "guard_middle": _guards,
    "guard_first": _guards,
    "guard_start": _guards,
    "gap_rate": _per(1, "n_slots"),
    "gap_rate_first": _per(1, "n_slots"),
    "gap_rate_end": _per(1, "n_slots"),
    "gap_end": _per(1, "n_slots"),
    "past_end": _per(1, "n_slots"),
    "past_first": _per(1, "n_slots"),
    "speed_end": _per(1, "n_slots"),
    "speed_first": _per(1, "n_slots"),
    "fall_end": _per(FALL, "n_slots"),
    "fall_first": _per(FALL, "n_slots"),
    "arm_end": _per(3, "n_slots"),
    "arm_first": _per(3, "n_slots"),
    "small_force_of": _per(1, "n_slots"),
    "lever_a": _per(1, "n_slots"),
    "lever_b": _per(1, "n_slots"),
    "size": _per(1, "n_slots"),
    "relative": lambda n: 24,
    "sectors": lambda n: SECTOR * (SECTORS + 1),
    "guard_end": _guards,
    "rate_end": _per(3, "n_slots"),
    "map_block": lambda n: n["map_width"] * n["n_slots"],
    "contact_time": _per(1, "n_slots"),
    # the local problem of the active contacts
    "b": _per(3, "n_slots"),
    "f": _per(3, "n_slots"),
    "d": _per(2, "n_slots"),
    "mu": _per(1, "n_slots"),
    "mu_static": _per(1, "n_slots"),
    "mu_kept": _per(1, "n_slots"),
    "static_kept": _per(1, "n_slots"),
    "d_found": _per(2, "n_slots"),
    "d_closed": _per(2, "n_slots"),
    "f_raw": _per(3, "n_slots"),
    "f_kept": _per(3, "n_slots"),
    "margin": _per(1, "n_slots"),
    "acceleration": _per(3, "n_slots"),
    "event_head": lambda n: 5,
    "catalogue_floats": _per(CATALOGUE_FLOATS, "n_declared"),
    "unit_radius": _per(1, "n_units"),
    "unit_speed": _per(1, "n_units"),
    "unit_way": _per(1, "n_units"),
    "unit_place": _per(3, "n_units"),
    "unit_axes": _per(9, "n_units"),
    "unit_lever": _per(1, "n_units"),
    "event_impulse": _per(3, "n_slots"),
    "force": _per(3, "n_slots"),
    "share": _per(3, "n_slots"),
    "slack": _per(1, "n_slots"),
    "static_margin": _per(1, "n_slots"),
    "direction_agreed": _per(2, "n_slots"),
    # linear algebra
    "right": _per(3, "n_slots"),
    "x": _per(3, "n_slots"),
    "sigma": _per(6, "n_slots"),
    # the impact
    "impact_y": _per(8, "n_slots"),
    "impact_new": _per(8, "n_slots"),
    "impact_stage": _per(8, "n_slots"),
    "impact_slopes": _per(8 * N_STAGES, "n_slots"),
    "impact_z0": _per(3, "n_slots"),
    "impact_z": _per(3, "n_slots"),
    "impact_guard": _per(3, "n_slots"),
    "impact_guard_first": _per(3, "n_slots"),
    "rest_slip": _per(1, "n_slots"),
    "impact_x_scale": _per(1, "n_slots"),
    "impact_f_scale": _per(1, "n_slots"),
    "impact_energy_scale": _per(1, "n_slots"),
    "impulse_scale": _per(1, "n_slots"),
    "stiff_rates": lambda n: 4 * STIFF**2,
    "stiff_matrix": lambda n: 4 * STIFF**2,
    "stiff_slip": lambda n: 2 * STIFF,
    "impact_kept": _per(8, "n_slots"),
    "books_kept": _per(5, "n_slots"),
    "impact_mark": _per(1, "n_slots"),
    "stored": _per(1, "n_slots"),
    "returned": _per(1, "n_slots"),
    "rubbed": _per(1, "n_slots"),
    "impulse": lambda n: 3 * n["n_slots"] + GUARD,
    "u_before": _per(1, "n_u"),
    "u_own": _per(1, "n_u"),
    "u_impact": _per(1, "n_u"),
    "impact_total": _per(TOTALS, "n_slots"),
    # output
    "events": _per(1, "event_floats"),
    "samples": lambda n: n["sample_capacity"] * (1 + n["n_y"] + BOOKED),
    # room for the worst case and mostly unused: they come last and cost no memory before they are written
    "delassus": lambda n: 9 * _blocks(n),
    "reduced": _entries,
    "matrix": _entries,
    "basis": _entries,
    "null": _entries,
    "stiff_slopes": _per(8 * 2 * STIFF, "n_slots"),
    "tableau": lambda n: 6 * n["n_pivoted"] * (6 * n["n_pivoted"] + 2),
}
INTEGER_ARRAYS: dict[str, Size] = {
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
    "facing": _per(1, "n_slots"),
    **dict.fromkeys(CATALOGUE, _per(1, "n_slots")),
    "jacobian_a": _per(1, "n_slots"),
    "jacobian_b": _per(1, "n_slots"),
    "response_a": _per(1, "n_slots"),
    "response_b": _per(1, "n_slots"),
    "code_before": _per(1, "n_slots"),
    "code_during": _per(1, "n_slots"),
    "mode_tried": _per(1, "n_slots"),
    "touching": _per(1, "n_slots"),
    "impacting": _per(1, "n_slots"),
    "active": _per(1, "n_slots"),
    "normal_held": _per(1, "n_slots"),
    "tangent_held": _per(1, "n_slots"),
    "at_rest": _per(1, "n_slots"),
    "redundant": _per(1, "n_slots"),
    "freed": _per(1, "n_slots"),
    "mode_past": _per(1, "n_slots"),
    "mode_found": _per(1, "n_slots"),
    "mode_closed": _per(1, "n_slots"),
    "lemke_contact": _per(6, "n_pivoted"),
    "lemke_corner": _per(6, "n_pivoted"),
    "lemke_row": _per(6, "n_pivoted"),
    "lemke_column": lambda n: 6 * n["n_pivoted"] + 1,
    "column": _per(3, "n_slots"),
    "turn": _per(3, "n_slots"),
    "first_unknown": lambda n: n["n_slots"] + 1,
    "phase": _per(1, "n_slots"),
    "stiff": lambda n: STIFF,
    "phase_kept": _per(1, "n_slots"),
    "held_kept": _per(1, "n_slots"),
    "colliding": _per(1, "n_slots"),
    "depth": _per(1, "n_slots"),
    "rim": _per(1, "n_slots"),
    "waves": _per(1, "n_slots"),
    "chain": _per(2, "n_slots"),
    "linkage_head": _per(1, "n_linkages"),
    "link_head": _per(1, "n_linkages"),
    "link_next": _per(2, "n_slots"),
    "linkage_root": _per(1, "n_linkages"),
    "linkage_group": _per(1, "n_linkages"),
    "kept": _per(2, "n_slots"),
    "armed": _per(3, "n_slots"),
    "feature": _per(1, "n_slots"),
    "guard_armed": _guards,
    "guard_deflated": _guards,
    "own_guard_function": _per(1, "n_own_guards"),
    "own_guard_parameters": _per(1, "n_own_guards"),
    "own_guard_ends": _per(1, "n_own_guards"),
    "own_guard_spent": _per(1, "n_own_guards"),
    "identity": _per(1, "n_slots"),
    "doubtful": _per(1, "n_slots"),
    "astray": _per(1, "n_slots"),
    "member": _per(1, "n_slots"),
    "grouped": _per(1, "n_slots"),
    "group_of": _per(1, "n_slots"),
    "group_next": _per(1, "n_slots"),
    "group_start": lambda n: n["n_slots"] + 1,
    "block_start": lambda n: n["n_slots"] + 1,
    "block_count": _per(1, "n_slots"),
    "block_mark": _per(1, "n_slots"),
    "own_block": _per(1, "n_slots"),
    "order": _per(1, "n_slots"),
    "rank": _per(1, "n_slots"),
    "mode_agreed": _per(1, "n_slots"),
    "closes": _per(1, "n_slots"),
    "tied": _per(1, "n_slots"),
    "holds": _per(1, "n_slots"),
    "listed": _per(1, "n_slots"),
    # what the contacts of a system are, whether in a slot or not, and which of them may come near each other
    "catalogue": _per(len(CATALOGUE), "n_declared"),
    "unit_frame": _per(1, "n_units"),
    "unit_partner": lambda n: n["n_units"] + 1,
    "unit_order": _per(1, "n_units"),
    "partner_unit": _per(1, "n_partners"),
    "partner_contact": lambda n: n["n_partners"] + 1,
    "paired_contact": _per(1, "n_paired"),
    "pool_function": _per(1, "n_pools"),
    "pool_parameters": _per(1, "n_pools"),
    "pool_out": _per(1, "n_pools"),
    "pool_first": _per(1, "n_pools"),
    "pool_contacts": _per(1, "n_pools"),
    "pool_unit_a": _per(1, "n_pools"),
    "pool_unit_b": _per(1, "n_pools"),
    # what no step reads of those before: that of the table of floats begins with ``events``
    "event_codes": _per(1, "event_integers"),
    "block_column": _blocks,
}

SCALARS = np.dtype(
    [(name, "i8") for name in INTEGER_SCALARS]
    + [(name, "f8") for name in FLOAT_SCALARS]
    + [(name, "i8") for name in (*FLOAT_ARRAYS, *INTEGER_ARRAYS)],
    align=True,
)
"""The record ``S``."""
COUNTS = (
    "n_bodies",
    "n_slots",
    "n_declared",
    "n_units",
    "n_partners",
    "n_paired",
    "n_pools",
    "n_own_guards",
    "n_loads",
    "n_joints",
    "n_linkages",
    "n_q",
    "n_u",
    "n_y",
    "n_states",
    "n_pivoted",
    "map_width",
    "event_floats",
    "event_integers",
    "sample_capacity",
)
"""The run-time sizes that :func:`allocate` takes."""
CONSTANT_SCALARS = frozenset((*COUNTS, *FLOAT_ARRAYS, *INTEGER_ARRAYS))
"""What never changes once the memory is laid out."""
