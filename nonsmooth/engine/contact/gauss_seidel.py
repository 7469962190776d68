"""Projected block Gauss-Seidel: contact after contact, each on its own cone, until the forces settle."""

from __future__ import annotations

from nonsmooth.engine.contact.cone import gauss_seidel
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, active_at, kernel

STAGES = 3
"""After each of which modes are guessed and verified: what settles slowly may tell them long before."""
SWEEPS = 20
"""Of the first stage; ten times more in each that follows."""


@kernel("i8(S, F, I, i8)")
def sweep(S: Scalars, w: Floats, k: Integers, sweeps: int) -> int:
    """Improve the forces by some sweeps; return 1 if they have settled."""
    for a in range(S.n_active):
        active = active_at(S, w, k, a)
        active.normal_held = 1
        active.tangent_held = 0
    return gauss_seidel(S, w, k, sweeps)


@kernel("i8(S, F, I, i8)")
def search_by_sweeps(S: Scalars, w: Floats, k: Integers, stage: int) -> int:
    """Improve the forces; return 1 if they have settled."""
    sweeps = SWEEPS
    for _stage in range(stage):
        sweeps *= 10
    return sweep(S, w, k, sweeps)
