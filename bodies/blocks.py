"""Three numbers at a time, for the evaluators that write blocks (:mod:`nonsmooth.engine.memory.blocks`)."""

from __future__ import annotations

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats


@compiled
def put(out: Floats, place: int, x: float, y: float, z: float) -> None:
    """Write a vector, or a row of a matrix, from a place of a block on."""
    out[place], out[place + 1], out[place + 2] = x, y, z
