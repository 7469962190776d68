"""The matrices ``slide`` and ``turn`` of a surface (:mod:`nonsmooth.engine.memory.blocks`), along principal lines."""

from __future__ import annotations

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import NORMAL, SLIDE_MATRIX, TANGENT, TURN_MATRIX
from nonsmooth.types import Floats


@compiled
def write_round(out: Floats, side: int, radius: float) -> None:
    """Write a sphere: slide 1, turn its radius; a vertex with radius 0."""
    slide, turn = side + SLIDE_MATRIX, side + TURN_MATRIX
    out[slide] = out[slide + 3] = 1.0
    out[turn] = out[turn + 3] = radius
    out[slide + 1] = out[slide + 2] = out[turn + 1] = out[turn + 2] = 0.0


@compiled
def write_flat(out: Floats, side: int) -> None:
    """Write a plane: slide 0, turn 1."""
    slide, turn = side + SLIDE_MATRIX, side + TURN_MATRIX
    out[slide] = out[slide + 3] = 0.0
    out[turn] = out[turn + 3] = 1.0
    out[slide + 1] = out[slide + 2] = out[turn + 1] = out[turn + 2] = 0.0


@compiled
def write_sweep(out: Floats, side: int, radius: float) -> None:
    """Turn the matrices of a core into those of the surface at a distance from it, which has the same normals.

    As the point of the core slides by u and the normal turns by nu, that of the surface slides by u + radius nu.
    """
    for i in range(side + SLIDE_MATRIX, side + TURN_MATRIX):
        out[i + TURN_MATRIX - SLIDE_MATRIX] += radius * out[i]


@compiled
def write_principal(
    out: Floats,
    side: int,
    x: float,
    y: float,
    z: float,
    slide_along: float,
    turn_along: float,
    slide_across: float,
    turn_across: float,
) -> None:
    """Write the matrices that are diagonal along and across the unit tangent (x, y, z).

    Normal and first tangent stand in ``out`` already.

    - the side of a cylinder, along its axis: slide 0, turn 1 along; slide 1, turn its radius across;
    - an edge, along itself: 0, 1; 1, 0;
    - a rim of radius R whose normal stands at the angle psi to its disc: as the point goes round by an angle, it slides
      by R and the normal turns by cos psi of it, so cos psi, R along the rim; across the normal turns alone: 1, 0.
    """
    c = x * out[TANGENT] + y * out[TANGENT + 1] + z * out[TANGENT + 2]
    # the second tangent is n x t1
    s = (
        x * (out[NORMAL + 1] * out[TANGENT + 2] - out[NORMAL + 2] * out[TANGENT + 1])
        + y * (out[NORMAL + 2] * out[TANGENT] - out[NORMAL] * out[TANGENT + 2])
        + z * (out[NORMAL] * out[TANGENT + 1] - out[NORMAL + 1] * out[TANGENT])
    )
    slide, turn = side + SLIDE_MATRIX, side + TURN_MATRIX
    out[slide] = c * c * slide_along + s * s * slide_across
    out[slide + 1] = out[slide + 2] = c * s * (slide_along - slide_across)
    out[slide + 3] = s * s * slide_along + c * c * slide_across
    out[turn] = c * c * turn_along + s * s * turn_across
    out[turn + 1] = out[turn + 2] = c * s * (turn_along - turn_across)
    out[turn + 3] = s * s * turn_along + c * c * turn_across
