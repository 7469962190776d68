"""Projected block Gauss-Seidel: contact after contact, each on its own cone, until the forces settle."""

from __future__ import annotations

from nonsmooth.engine.contact.cone import gauss_seidel
from nonsmooth.engine.native.kernel import Workspace, kernel

STAGES = 3
"""After each of which modes are guessed and verified: what settles slowly may tell them long before."""
SWEEPS = 20
"""Of the first stage; ten times more in each that follows."""


@kernel("b1(ws, i8)")
def sweep(ws: Workspace, sweeps: int) -> bool:
    """Improve the forces by some sweeps; return 1 if they have settled."""
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        active.is_normal_force_unknown = True
        active.sticks = False
    return gauss_seidel(ws, sweeps)


@kernel("b1(ws, i8)")
def search_by_sweeps(ws: Workspace, stage: int) -> bool:
    """Improve the forces; return 1 if they have settled."""
    sweeps = SWEEPS
    for _stage in range(stage):
        sweeps *= 10
    return sweep(ws, sweeps)
