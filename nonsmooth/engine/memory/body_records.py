"""Records of bodies, joints and loads, and of what they write."""

from __future__ import annotations

from nonsmooth.engine.memory.blocks import (
    ACCELERATION,
    AXIS,
    FORCE,
    JOINT_ROW,
    LOAD_MOMENT,
    LOAD_POINT,
    MOMENT,
    PART_AXES,
    PART_BALL,
    PART_COUNT,
    PART_FUNCTION,
    PART_PLACE,
    PART_POWERS,
    PART_RADIUS,
    PART_SEMI,
    POINT_A,
    POINT_B,
    POSITION,
    RESIDUAL,
    ROTATION,
    ROW_BIAS,
    SPIN,
    SPIN_ACCELERATION,
    VELOCITY,
)
from nonsmooth.engine.memory.fields import Field, Fields, one, packed, question, row, vector, without

BODY: Fields = {
    **without(
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
        "body_spin",
        "body_flight_function",
        "body_flight_parameters",
        "body_flight_out",
        "body_flies",
        "body_turns",
        "body_course",
        "body_course_t",
        "body_course_h",
        "body_closed",
        "body_version",
        "body_accelerated",
        "body_stood",
        "body_stood_t",
    ),
    "is_ballistic": question("body_flies"),
    "has_own_step": question("body_course"),
}
"""Of a body."""

ARTICULATION: Fields = {
    **without(
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
    "link_head": one("link_head"),
}
"""Of an articulation."""

JOINT = without(
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

LOAD = without(
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
    **without("unit_", "unit_radius", "unit_speed", "unit_way", "unit_axes", "unit_lever", "unit_frame"),
    "place": vector("unit_place", 0, 3),
    "places": row("unit_place"),
    "first_partner": Field("unit_partner", 1),
    "end_partner": Field("unit_partner", 1, 1),
}
"""Of a unit (:mod:`nonsmooth.engine.bodies.listing`)."""

WALL = without("wall_", "wall_contact", "wall_unit", "wall_frame", "wall_steady", "wall_ceiling")
"""Of an unbounded shape in a contact (:mod:`nonsmooth.engine.bodies.listing`)."""

POOL = without(
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

PAIR_OF_PARTS: Fields = {
    **without(
        "pair_",
        "pair_carrier_a",
        "pair_carrier_b",
        "pair_frame_a",
        "pair_frame_b",
        "pair_part_a",
        "pair_part_b",
        "pair_group",
        "pair_contact",
        "pair_flat",
        "pair_allowed",
        "pair_size",
        "pair_room",
        "pair_closed",
        "pair_deepest",
    ),
    "direction": vector("pair_direction", 0, 3),
    "normal": vector("pair_normal", 0, 3),
    "between": vector("pair_between", 0, 3),
}
"""Of a pair of convex parts (:mod:`nonsmooth.engine.pairs.look`)."""

CARRIER: Fields = {
    **without("carrier_", "carrier_frame", "carrier_lever", "carrier_way", "carrier_axes"),
    "place": vector("carrier_place", 0, 3),
}
"""Of a frame that carries convex parts (:mod:`nonsmooth.engine.pairs.look`)."""

CONVEX_PART: Fields = {
    "place": packed(PART_PLACE, 3),
    "axes": packed(PART_AXES, 9),
    "semi": packed(PART_SEMI, 3),
    "powers": packed(PART_POWERS, 2),
    "ball": packed(PART_BALL),
    "radius": packed(PART_RADIUS),
    "function": packed(PART_FUNCTION),
    "rings": packed(PART_COUNT),
}
"""Of a convex part."""

FRAME_OF_BODY: Fields = {
    "origin": packed(POSITION, 3),
    "rotation": packed(ROTATION, 9),
    "velocity": packed(VELOCITY, 3),
    "spin": packed(SPIN, 3),
    "acceleration": packed(ACCELERATION, 3),
    "spin_acceleration": packed(SPIN_ACCELERATION, 3),
}
"""Of a frame that a body writes (:mod:`nonsmooth.engine.memory.blocks`)."""

ROW_OF_JOINT: Fields = {
    "residual": packed(RESIDUAL, 1, JOINT_ROW),
    "axis": packed(AXIS, 3, JOINT_ROW),
    "moment": packed(MOMENT, 3, JOINT_ROW),
    "point_a": packed(POINT_A, 3, JOINT_ROW),
    "point_b": packed(POINT_B, 3, JOINT_ROW),
    "bias": packed(ROW_BIAS, 1, JOINT_ROW),
}
"""Of a row that a joint writes."""

WRENCH_OF_LOAD: Fields = {
    "force": packed(FORCE, 3),
    "point": packed(LOAD_POINT, 3),
    "moment": packed(LOAD_MOMENT, 3),
}
"""Of what a load writes."""
