"""The solver "gauss_seidel" of the contact problem: sweeps in stages (:mod:`nonsmooth.engine.contact.cone`).

Sweeps may settle slowly, but the forces show the modes of the contacts long before. So modes are guessed from the
forces and verified after each stage, and each stage has more sweeps than the one before. A single long run would spend
most of its sweeps on digits that the verification then finds exactly.
"""

from __future__ import annotations

from nonsmooth.engine.contact.cone import gauss_seidel
from nonsmooth.engine.native.kernel import Workspace, kernel
from nonsmooth.engine.numerics.integers import power

STAGES = 3
"""Number of stages, with 20, 200 and 2000 sweeps."""
SWEEPS = 20
"""Maximum number of sweeps of the first stage. Each further stage has ten times as many."""


@kernel("b1(ws, i8)")
def sweep(ws: Workspace, max_sweeps: int) -> bool:
    """Improve the forces of all active contacts by sweeps. True if they have settled within ``max_sweeps``.

    ``sticks`` and ``direction`` of contacts at rest become those of the forces found. If False, the forces are those of
    the last sweep.
    """
    for active in ws.actives:
        # those of compliant contacts are unknown, too: G and b make their forces the known ones
        active.is_normal_force_unknown = not active.has_given_force
        if active.has_given_force:
            active.normal_force = active.given_force
        active.sticks = False
    return gauss_seidel(ws, max_sweeps)


@kernel("b1(ws, i8)")
def search_by_sweeps(ws: Workspace, stage: int) -> bool:
    """Improve the forces of the contact problem by the sweeps of a stage, counted from 0. True if they have settled.

    If False, the next stage may continue from these forces.
    """
    # each stage has ten times as many sweeps as the one before
    return sweep(ws, SWEEPS * power(10, stage))
