"""Records: what belongs to one contact, one body or one joint, by name.

The memory holds arrays with one number, or a few, for every contact.  A record is a view of one contact's:
``contact_at(S, w, k, c)`` (:mod:`nonsmooth.engine.native.kernel`) gives contact ``c``, whose ``contact.mode`` is
``k[S.mode + c]``.  A few numbers are a vector, read and written as a tuple, ``contact.direction = 1.0, 0.0``, or a row
to be indexed, ``contact.rate[1]`` for ``w[S.rate + 3 * c + 1]``.  The memory is the same.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeAlias, final

from nonsmooth.engine.memory.blocks import (
    ACCELERATION,
    AXIS,
    FEATURE,
    FORCE,
    GAP,
    GEOMETRY,
    JOINT_ROW,
    LOAD_MOMENT,
    LOAD_POINT,
    MOMENT,
    NORMAL,
    PAST_END,
    POINT_A,
    POINT_B,
    POSITION,
    RESIDUAL,
    ROTATION,
    ROW_BIAS,
    SIDE_A,
    SIDE_B,
    SLIDE_MATRIX,
    SPIN,
    SPIN_ACCELERATION,
    TANGENT,
    TURN_MATRIX,
    VELOCITY,
)
from nonsmooth.engine.memory.tables import COUNTS, FLOAT_ARRAYS, INTEGER_ARRAYS


@final
@dataclass(frozen=True)
class Field:
    """Where a field of a record stands.

    Attributes
    ----------
    array : str
        The array; without a name the record stands in the heap of floats, with no other between.
    stride : int
        Numbers from that of one record to that of the next.
    first, numbers : int
        Which of them the field is.
    vector : bool
        Whether they are a tuple.
    behind : str
        A scalar that tells how far into the array the first record is.
    """

    array: str
    stride: int
    first: int = 0
    numbers: int = 1
    vector: bool = False
    behind: str = ""

    @property
    def is_float(self) -> bool:
        """Whether it stands in the heap of floats."""
        return not self.array or self.array in FLOAT_ARRAYS


Fields: TypeAlias = Mapping[str, Field]


def _stride(array: str) -> int:
    size = (FLOAT_ARRAYS | INTEGER_ARRAYS)[array]
    empty = size(dict.fromkeys(COUNTS, 0))
    return max(size({**dict.fromkeys(COUNTS, 0), name: 1}) for name in COUNTS) - empty


def _row(array: str) -> Field:
    return Field(array, _stride(array), 0, _stride(array))


def _rows(*arrays: str) -> Fields:
    return {array: _row(array) for array in arrays}


def _vector(array: str, first: int = 0, numbers: int = 2) -> Field:
    return Field(array, _stride(array), first, numbers, vector=True)


def _one(array: str, first: int = 0) -> Field:
    return Field(array, _stride(array), first)


def _geometry(first: int, numbers: int = 1, vector: bool = True) -> Field:
    return Field("geometry", GEOMETRY, first, numbers, vector and numbers > 1)


def _without(prefix: str, *arrays: str) -> Fields:
    return {array.removeprefix(prefix): _row(array) for array in arrays}


def _packed(first: int, numbers: int = 1, stride: int = 0) -> Field:
    return Field("", stride, first, numbers, vector=numbers == 3)


CONTACT: Fields = {
    **_rows(
        # what it is
        "normal_function",
        "traction_function",
        "friction_function",
        "friction_parameters",
        "force_function",
        "force_parameters",
        "efficiency_function",
        "efficiency_parameters",
        "map_parameters",
        "frame_a",
        "frame_b",
        "body_a",
        "body_b",
        "articulation_a",
        "articulation_b",
        "lever_a",
        "lever_b",
        "size",
        "reach",
        "contact_time",
        "identity",
        "geometry_function",
        "geometry_parameters",
        "normal_parameters",
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
        "facing",
        "candidate",
        "nu_a",
        "nu_b",
        "shift_a",
        "shift_b",
        "closing_rate",
        # where it stands
        "geometry",
        "axes",
        "rate",
        "bias",
        "turned",
        "touching",
        "compliant_force",
        "jacobian_a",
        "jacobian_b",
        "response_a",
        "response_b",
        # its mode, and the forces that it holds by
        "mode",
        "mode_agreed",
        "force",
        "null_space_force",
        "slack",
        "holds",
        "static_margin",
        "small_force_of",
        "least_force",
        # its gap at both ends of a step, and how it can change
        "gap_rate",
        "gap_rate_first",
        "gap_rate_end",
        "gap_end",
        "rate_end",
        "past_first",
        "past_end",
        "speed_first",
        "speed_end",
        "fall_first",
        "fall_end",
        "arm_first",
        "arm_end",
        "feature",
        # what an event does to it
        "code_before",
        "code_during",
        "event_impulse",
        "prescribed_rate",
        "closes",
        "member",
        "group_of",
        "impacting",
        # what it takes from one window of a large impact to the next
        "phase_kept",
        "held_kept",
        "waves",
        "depth",
        "rim",
    ),
    "redundant": _one("redundant_contact"),
    "gap": _geometry(GAP),
    "normal": _geometry(NORMAL, 3),
    "tangent": _geometry(TANGENT, 3),
    "point_a": _geometry(POINT_A, 3),
    "point_b": _geometry(POINT_B, 3),
    "slide_a": _geometry(SIDE_A + SLIDE_MATRIX, 4),
    "turn_a": _geometry(SIDE_A + TURN_MATRIX, 4),
    "slide_b": _geometry(SIDE_B + SLIDE_MATRIX, 4),
    "turn_b": _geometry(SIDE_B + TURN_MATRIX, 4),
    "feature_now": _geometry(FEATURE),
    "beyond": _geometry(PAST_END),
    "axis_n": _vector("axes", 0, 3),
    "axis_1": _vector("axes", 3, 3),
    "axis_2": _vector("axes", 6, 3),
    "velocity": _vector("rate", 0, 3),
    "slip": _vector("rate", 1),
    "slip_of_tangents": _vector("slip"),
    "skew_1": _vector("skew", 0),
    "skew_2": _vector("skew", 2),
    "direction": _vector("direction"),
    "direction_agreed": _vector("direction_agreed"),
    "total": _row("impact_total"),
    "total_impulse": Field("impact_total", _stride("impact_total"), 0, 3),
    "total_stored": _one("impact_total", 3),
    "total_returned": _one("impact_total", 4),
    "total_rubbed": _one("impact_total", 5),
    "deformation_kept": _one("impact_total", 6),
    "energy_kept": _one("impact_total", 7),
    "lost_kept": _one("impact_total", 8),
}
"""Of a contact, in its slot."""

ACTIVE: Fields = {
    "slot": _one("active"),
    # what the solvers of the contact problem know of it
    **_rows(
        "mu",
        "mu_static",
        "mu_kept",
        "static_kept",
        "margin",
        "mode_tried",
        "mode_past",
        "mode_found",
        "mode_closed",
        "normal_held",
        "tangent_held",
        "at_rest",
        "redundant",
        "freed",
        "acceleration",
    ),
    "force": _row("f"),
    "normal_force": _one("f"),
    "friction": _vector("f", 1),
    "free": _row("b"),
    "normal_acceleration": _one("acceleration"),
    "slip_acceleration": _vector("acceleration", 1),
    "direction": _vector("d"),
    "direction_found": _vector("d_found"),
    "direction_closed": _vector("d_closed"),
    # its rows of the matrices: unknowns, and blocks of the Delassus matrix
    "first_unknown": Field("first_unknown", 1),
    "end_unknown": Field("first_unknown", 1, 1),
    "first_block": Field("block_start", 1, behind="first_grouped"),
    "end_block": Field("block_start", 1, 1, behind="first_grouped"),
    "own_block": Field("own_block", 1, behind="first_grouped"),
    "block_count": _one("block_count"),
    "block_mark": _one("block_mark"),
    "rank": _one("rank"),
    # an impact
    **_rows("phase", "rest_slip", "impulse_scale", "stored", "returned", "rubbed", "impulse"),
    "rate": _row("impact_z"),
    "gap_rate": _one("impact_z"),
    "slip": _vector("impact_z", 1),
    "rate_before": _row("impact_z0"),
    "gap_rate_before": _one("impact_z0"),
    "deformation_scale": _one("impact_x_scale"),
    "force_scale": _one("impact_f_scale"),
    "energy_scale": _one("impact_energy_scale"),
    "booked": _one("impact_mark"),
    "rate_guard": _one("impact_guard", 0),
    "energy_guard": _one("impact_guard", 1),
    "friction_guard": _one("impact_guard", 2),
    "phase_kept": _one("kept", 0),
    "held_kept": _one("kept", 1),
    "stored_kept": _one("books_kept", 0),
    "returned_kept": _one("books_kept", 1),
    "booked_kept": _one("books_kept", 2),
    "direction_kept": _vector("books_kept", 3),
}
"""Of an active contact, by its number among those of the island at hand; ``slot`` is that of the contact."""

BODY = _without(
    "body_",
    "body_q",
    "body_u",
    "body_nq",
    "body_nu",
    "body_function",
    "body_parameters",
    "body_out",
    "body_tail",
    "body_quaternion",
)
"""Of a body."""

LINKAGE: Fields = {
    **_without(
        "articulation_",
        "articulation_u",
        "articulation_nu",
        "articulation_body",
        "articulation_bodies",
        "articulation_inverse",
        "articulation_joint",
        "articulation_joints",
        "articulation_rows",
        "articulation_driven",
        "articulation_jacobian",
        "articulation_r",
        "articulation_y",
        "articulation_factor",
        "articulation_residual",
        "articulation_rate",
        "articulation_bias",
        "articulation_x",
        "articulation_root",
        "articulation_group",
        "articulation_head",
    ),
    "link_head": _one("link_head"),
}
"""Of an articulation."""

JOINT = _without(
    "joint_",
    "joint_function",
    "joint_parameters",
    "joint_frame_a",
    "joint_frame_b",
    "joint_nu_a",
    "joint_nu_b",
    "joint_shift_a",
    "joint_shift_b",
    "joint_first",
    "joint_rows",
    "joint_out",
)
"""Of a joint."""

LOAD = _without(
    "load_",
    "load_function",
    "load_parameters",
    "load_frame_a",
    "load_frame_b",
    "load_body_a",
    "load_body_b",
    "load_out",
)
"""Of a load."""

UNIT: Fields = {
    **_without("unit_", "unit_radius", "unit_speed", "unit_way", "unit_axes", "unit_lever", "unit_frame"),
    "place": _vector("unit_place", 0, 3),
    "places": _row("unit_place"),
    "first_partner": Field("unit_partner", 1),
    "end_partner": Field("unit_partner", 1, 1),
}
"""Of a unit (:mod:`nonsmooth.engine.bodies.listing`)."""

POOL = _without(
    "pool_",
    "pool_function",
    "pool_parameters",
    "pool_out",
    "pool_first",
    "pool_contacts",
    "pool_unit_a",
    "pool_unit_b",
)
"""Of a pool of features (:mod:`nonsmooth.engine.bodies.pools`)."""

OWN_GUARD = _without("own_guard_", "own_guard_function", "own_guard_parameters", "own_guard_spent", "own_guard_ends")
"""Of a guard of the scenario."""

GUARD: Fields = {
    "value": Field("guard", 1),
    "middle": Field("guard_middle", 1),
    "first": Field("guard_first", 1),
    "start": Field("guard_start", 1),
    "end": Field("guard_end", 1),
    "armed": Field("guard_armed", 1),
    "deflated": Field("guard_deflated", 1),
}
"""Of a guard of the flow, three of each contact, then those of the scenario."""

FRAME_OF_BODY: Fields = {
    "origin": _packed(POSITION, 3),
    "rotation": _packed(ROTATION, 9),
    "velocity": _packed(VELOCITY, 3),
    "spin": _packed(SPIN, 3),
    "acceleration": _packed(ACCELERATION, 3),
    "spin_acceleration": _packed(SPIN_ACCELERATION, 3),
}
"""Of a frame that a body writes (:mod:`nonsmooth.engine.memory.blocks`)."""

ROW_OF_JOINT: Fields = {
    "residual": _packed(RESIDUAL, 1, JOINT_ROW),
    "axis": _packed(AXIS, 3, JOINT_ROW),
    "moment": _packed(MOMENT, 3, JOINT_ROW),
    "point_a": _packed(POINT_A, 3, JOINT_ROW),
    "point_b": _packed(POINT_B, 3, JOINT_ROW),
    "bias": _packed(ROW_BIAS, 1, JOINT_ROW),
}
"""Of a row that a joint writes."""

WRENCH_OF_LOAD: Fields = {
    "force": _packed(FORCE, 3),
    "point": _packed(LOAD_POINT, 3),
    "moment": _packed(LOAD_MOMENT, 3),
}
"""Of what a load writes."""

IMPACT_STATE: Fields = {
    "impulse": Field("", 8, 0, 3),
    "friction": Field("", 8, 1, 2, vector=True),
    "deformation": Field("", 8, 3),
    "work": Field("", 8, 4),
    "rubbed": Field("", 8, 5),
    "energy": Field("", 8, 6),
    "lost": Field("", 8, 7),
}
"""Of an active contact in a state of an impact, and in the slope of one (:mod:`nonsmooth.engine.impact.rates`)."""

DELASSUS_BLOCK: Fields = {
    "entries": Field("", 9, 0, 9),
    "nn": Field("", 9, 0),
    "n1": Field("", 9, 1),
    "n2": Field("", 9, 2),
    "t11": Field("", 9, 4),
    "t12": Field("", 9, 5),
    "t22": Field("", 9, 8),
}
"""Of a block on the diagonal of the Delassus matrix, which is symmetric."""

RECORDS: Mapping[str, Fields] = {
    "contact": CONTACT,
    "active": ACTIVE,
    "body": BODY,
    "articulation": LINKAGE,
    "joint": JOINT,
    "load": LOAD,
    "unit": UNIT,
    "pool": POOL,
    "own_guard": OWN_GUARD,
    "guard": GUARD,
}
"""Records whose fields stand in arrays, by kind."""
PACKED: Mapping[str, Fields] = {
    "impact_state": IMPACT_STATE,
    "delassus_block": DELASSUS_BLOCK,
    "joint_row": ROW_OF_JOINT,
    "frame": FRAME_OF_BODY,
    "load_wrench": WRENCH_OF_LOAD,
}
"""Records in the heap of floats, by kind: one behind another, or with stride 0 each by itself."""
