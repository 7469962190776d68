"""A contact that holds no features at present."""

from __future__ import annotations

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

NO_CANDIDATE = (0.0, 0.0, 0.0, 0.0)
"""What such a contact holds (:class:`nonsmooth.interfaces.CandidateSearch`)."""
_APART = 1e3
"""Its gap, in sizes of the larger body."""


@compiled
def write_apart(a: Floats, out: Floats, size: float) -> None:
    """Write the geometry block of bodies that are far apart, in sizes of the larger one [m]."""
    for i in range(31):
        out[i] = 0.0
    out[0] = out[30] = _APART * size
    out[3], out[4] = 1.0, 1.0
    for i in range(3):
        out[7 + i] = a[i]
        out[10 + i] = a[i] + out[0] * out[1 + i]
    out[17] = out[20] = out[21] = out[24] = 1.0
