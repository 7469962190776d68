"""A contact that holds no features at present."""

from __future__ import annotations

from bodies.contacts.features.curvature import write_flat, write_round
from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import GAP, NORMAL, PAIR, PAST_END, POINT_A, POINT_B, SIDE_A, SIDE_B, TANGENT
from nonsmooth.types import Floats

NO_CANDIDATE = (0.0, 0.0, 0.0, 0.0)
"""What such a contact holds (:class:`nonsmooth.interfaces.CandidateSearch`)."""
_APART = 1e3
"""Its gap, in sizes of the larger body."""


@compiled
def write_apart(a: Floats, out: Floats, size: float) -> None:
    """Write the geometry block of bodies that are far apart, in sizes of the larger one [m]."""
    for i in range(PAIR):
        out[i] = 0.0
    out[GAP] = out[PAST_END] = _APART * size
    out[NORMAL + 2], out[TANGENT] = 1.0, 1.0
    for i in range(3):
        out[POINT_A + i] = a[i]
        out[POINT_B + i] = a[i] + out[GAP] * out[NORMAL + i]
    write_flat(out, SIDE_A)
    write_round(out, SIDE_B, 0.0)
