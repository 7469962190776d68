"""Blocks among the floats that functions of plug-ins write or read, and those of impacts and steps, by name."""

from __future__ import annotations

from collections.abc import Mapping

from nonsmooth.engine.memory.blocks import (
    ACCELERATION,
    AXIS,
    DELASSUS,
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
from nonsmooth.engine.memory.fields import Field, Fields, packed
from nonsmooth.engine.memory.layout import DEFORMATION, DISSIPATED, ENERGY, IMPACT_STATE, IMPULSE, LOST, PART_END, WORK

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

WRENCH_OF_LOAD: Fields = {"force": packed(FORCE, 3), "point": packed(LOAD_POINT, 3), "moment": packed(LOAD_MOMENT, 3)}
"""Of what a load writes."""

PART_OF_STEP: Fields = {
    "theta": packed(0, 1, PART_END),
    "gap": packed(1, 1, PART_END),
    "rate": packed(2, 1, PART_END),
    "past": packed(3, 1, PART_END),
    "offset": packed(4, 3, PART_END),
}
"""Of an end of a part of a step: fraction, gap, gap rate, distance past the features, offset of the witness."""

STATE_OF_IMPACT: Fields = {
    "impulse": Field("", IMPACT_STATE, IMPULSE, 3),
    "normal_force": Field("", IMPACT_STATE, IMPULSE),
    "friction": Field("", IMPACT_STATE, IMPULSE + 1, 2, is_vector=True),
    "deformation": Field("", IMPACT_STATE, DEFORMATION),
    "work": Field("", IMPACT_STATE, WORK),
    "dissipated": Field("", IMPACT_STATE, DISSIPATED),
    "energy": Field("", IMPACT_STATE, ENERGY),
    "lost": Field("", IMPACT_STATE, LOST),
}
"""Of an active contact in a state of an impact, and in the slope of one (:mod:`nonsmooth.engine.impact.state`)."""

DELASSUS_BLOCK: Fields = {
    "entries": Field("", DELASSUS, 0, DELASSUS),
    "nn": Field("", DELASSUS, 0),
    "n1": Field("", DELASSUS, 1),
    "n2": Field("", DELASSUS, 2),
    "t11": Field("", DELASSUS, 4),
    "t12": Field("", DELASSUS, 5),
    "t22": Field("", DELASSUS, 8),
}
"""Of a block on the diagonal of the Delassus matrix, which is symmetric."""

PACKED: Mapping[str, Fields] = {
    "impact_state": STATE_OF_IMPACT,
    "part_end": PART_OF_STEP,
    "delassus_block": DELASSUS_BLOCK,
    "joint_row": ROW_OF_JOINT,
    "frame": FRAME_OF_BODY,
    "part": CONVEX_PART,
    "load_wrench": WRENCH_OF_LOAD,
}
"""Blocks by kind: one behind another, or with stride 0 each by itself."""
