"""The matrices ``slide`` and ``turn`` of a surface (:mod:`nonsmooth.engine.memory.blocks`), along principal lines."""

from __future__ import annotations

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

SIDE_A = 13
"""Where the matrices of the first body's surface stand in the geometry block."""
SIDE_B = 21
"""Where those of the second body's stand."""


@compiled
def write_round(out: Floats, side: int, radius: float) -> None:
    """Write a sphere: slide 1, turn its radius; a vertex with radius 0."""
    out[side] = out[side + 3] = 1.0
    out[side + 4] = out[side + 7] = radius
    out[side + 1] = out[side + 2] = out[side + 5] = out[side + 6] = 0.0


@compiled
def write_flat(out: Floats, side: int) -> None:
    """Write a plane: slide 0, turn 1."""
    out[side] = out[side + 3] = 0.0
    out[side + 4] = out[side + 7] = 1.0
    out[side + 1] = out[side + 2] = out[side + 5] = out[side + 6] = 0.0


@compiled
def write_sweep(out: Floats, side: int, radius: float) -> None:
    """Turn the matrices of a core into those of the surface at a distance from it, which has the same normals.

    As the point of the core slides by u and the normal turns by nu, that of the surface slides by u + radius nu.
    """
    for i in range(side, side + 4):
        out[i + 4] += radius * out[i]


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
    c = x * out[4] + y * out[5] + z * out[6]
    # the second tangent is n x t1
    s = (
        x * (out[2] * out[6] - out[3] * out[5])
        + y * (out[3] * out[4] - out[1] * out[6])
        + z * (out[1] * out[5] - out[2] * out[4])
    )
    out[side] = c * c * slide_along + s * s * slide_across
    out[side + 1] = out[side + 2] = c * s * (slide_along - slide_across)
    out[side + 3] = s * s * slide_along + c * c * slide_across
    out[side + 4] = c * c * turn_along + s * s * turn_across
    out[side + 5] = out[side + 6] = c * s * (turn_along - turn_across)
    out[side + 7] = s * s * turn_along + c * c * turn_across
