"""Blocks among the floats with names for their numbers: those of plug-ins, of impacts and of steps."""

from __future__ import annotations

from collections.abc import Mapping

from nonsmooth.engine.memory import blocks, layout
from nonsmooth.engine.memory.fields import Field, Fields, packed

CONVEX_PART: Fields = {
    "place": packed(blocks.PART_PLACE, 3),
    "axes": packed(blocks.PART_AXES, 9),
    "semi": packed(blocks.PART_SEMI, 3),
    "powers": packed(blocks.PART_POWERS, 2),
    "ball": packed(blocks.PART_BALL),
    "radius": packed(blocks.PART_RADIUS),
    "function": packed(blocks.PART_FUNCTION),
    "rings": packed(blocks.PART_COUNT),
}
"""Numbers of a convex part."""

FRAME_OF_BODY: Fields = {
    "origin": packed(blocks.POSITION, 3),
    "rotation": packed(blocks.ROTATION, 9),
    "velocity": packed(blocks.VELOCITY, 3),
    "spin": packed(blocks.SPIN, 3),
    "acceleration": packed(blocks.ACCELERATION, 3),
    "spin_acceleration": packed(blocks.SPIN_ACCELERATION, 3),
}
"""Numbers of a frame that a body writes (:mod:`nonsmooth.engine.memory.blocks`)."""

ROW_OF_JOINT: Fields = {
    "residual": packed(blocks.RESIDUAL, 1, blocks.JOINT_ROW),
    "axis": packed(blocks.AXIS, 3, blocks.JOINT_ROW),
    "moment": packed(blocks.MOMENT, 3, blocks.JOINT_ROW),
    "point_a": packed(blocks.POINT_A, 3, blocks.JOINT_ROW),
    "point_b": packed(blocks.POINT_B, 3, blocks.JOINT_ROW),
    "bias": packed(blocks.ROW_BIAS, 1, blocks.JOINT_ROW),
}
"""Numbers of a row that a joint writes."""

WRENCH_OF_LOAD: Fields = {
    "force": packed(blocks.FORCE, 3),
    "point": packed(blocks.LOAD_POINT, 3),
    "moment": packed(blocks.LOAD_MOMENT, 3),
}
"""Numbers that a load writes."""

PART_OF_STEP: Fields = {
    "theta": packed(0, 1, layout.PART_END),
    "gap": packed(1, 1, layout.PART_END),
    "rate": packed(2, 1, layout.PART_END),
    "past": packed(3, 1, layout.PART_END),
    "offset": packed(4, 3, layout.PART_END),
}
"""Numbers of an end of a part of a step: fraction, gap, gap rate, distance past the features, offset of the witness."""

STATE_OF_IMPACT: Fields = {
    "impulse": Field("", layout.IMPACT_STATE, layout.IMPULSE, 3),
    "normal_force": Field("", layout.IMPACT_STATE, layout.IMPULSE),
    "friction": Field("", layout.IMPACT_STATE, layout.IMPULSE + 1, 2, is_vector=True),
    "deformation": Field("", layout.IMPACT_STATE, layout.DEFORMATION),
    "work": Field("", layout.IMPACT_STATE, layout.WORK),
    "dissipated": Field("", layout.IMPACT_STATE, layout.DISSIPATED),
    "energy": Field("", layout.IMPACT_STATE, layout.ENERGY),
    "lost": Field("", layout.IMPACT_STATE, layout.LOST),
}
"""Numbers of an active contact in the state of an impact, and in its slope (:mod:`nonsmooth.engine.impact.state`)."""

DELASSUS_BLOCK: Fields = {
    "entries": Field("", blocks.DELASSUS, 0, blocks.DELASSUS),
    "nn": Field("", blocks.DELASSUS, 0),
    "n1": Field("", blocks.DELASSUS, 1),
    "n2": Field("", blocks.DELASSUS, 2),
    "t11": Field("", blocks.DELASSUS, 4),
    "t12": Field("", blocks.DELASSUS, 5),
    "t22": Field("", blocks.DELASSUS, 8),
}
"""Numbers of a block on the diagonal of the Delassus matrix, which is symmetric; rows n, t1, t2."""

PACKED: Mapping[str, Fields] = {
    "impact_state": STATE_OF_IMPACT,
    "part_end": PART_OF_STEP,
    "delassus_block": DELASSUS_BLOCK,
    "joint_row": ROW_OF_JOINT,
    "frame_at": FRAME_OF_BODY,
    "part_at": CONVEX_PART,
    "load_wrench": WRENCH_OF_LOAD,
}
"""Fields of the packed blocks, by the names of the kernel functions that give access to these blocks.

Several blocks of one kind follow each other. A stride of 0 means that there is a single block.
"""
