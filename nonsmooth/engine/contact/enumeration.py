"""Enumeration: every combination of modes is tried, and the first that fulfils the laws is taken."""

from __future__ import annotations

from nonsmooth.engine.contact.cone import gauss_seidel
from nonsmooth.engine.contact.polish import polish
from nonsmooth.engine.contact.trial import hold_tried, verify
from nonsmooth.engine.delassus.delassus import add_product
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.memory.solvers import MOST_ENUMERATED
from nonsmooth.engine.native.kernel import Workspace, entry_point, kernel
from nonsmooth.engine.native.watch import interrupted
from nonsmooth.engine.numerics.vectors import length

_SWEEPS = 100
"""Sweeps that point slips which start, from where Newton's method goes on."""
_ENDLESS = 1e30
"""Static coefficient of what is held whatever the friction: no ratio of forces is as large."""


@kernel("b1(ws, i8)")
def _write_modes(ws: Workspace, number: int) -> bool:
    """Write the modes that the digits of ``number`` to base 3 mean; return 1 if they make sense."""
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        choice = number % 3
        number //= 3
        mode = Mode.STICK if choice == 0 else (Mode.SLIDE if choice == 1 else Mode.OPEN)
        active.mode_tried = mode
        if mode == Mode.STICK and not active.is_at_rest:
            return False
    return True


@kernel("i8(ws)")
def _start_slips(ws: Workspace) -> int:
    """Point the incipient slips along the accelerations without their friction; return how many there are."""
    count = 0
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        if active.is_at_rest and active.mode_tried == Mode.SLIDE:
            count += 1
    if count == 0:
        return 0
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        active.coefficient_kept = active.friction_coefficient
        if active.is_at_rest:
            active.friction_coefficient = 0.0
    hold_tried(ws)
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        active.friction_coefficient = active.coefficient_kept
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        if not active.is_at_rest or active.mode_tried != Mode.SLIDE:
            continue
        a1 = add_product(ws, active.free[1], a, 1, ws.problem.forces.start)
        a2 = add_product(ws, active.free[2], a, 2, ws.problem.forces.start)
        norm = length((a1, a2))
        active.direction = a1 / norm if norm > 0.0 else 1.0, a2 / norm if norm > 0.0 else 0.0
    return count


@kernel()
def _sweep_slips(ws: Workspace) -> None:
    """Point the incipient slips by sweeps with the modes held: Newton's method may have gone to a slip backwards."""
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        mode = active.mode_tried
        active.is_normal_force_unknown = not (mode == Mode.OPEN)
        active.static_kept = active.static_coefficient
        active.static_coefficient = _ENDLESS if mode == Mode.STICK else 0.0
        for r in range(3):
            active.force[r] = 0.0
    gauss_seidel(ws, _SWEEPS)
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        active.static_coefficient = active.static_kept


@entry_point("i8(ws, i8)")
def enumerate_modes(ws: Workspace, first: int) -> int:
    """Try every combination of modes from number ``first`` on; return the number behind the first verified, or 0.

    The directions of incipient slip start from those without friction and, where Newton's method leads astray from
    there, from sweeps.
    """
    if ws.problem.n_active > MOST_ENUMERATED:
        return 0
    combinations = 1
    for _a in range(ws.problem.n_active):
        combinations *= 3
    for number in range(first, combinations):
        if interrupted(ws, ws.problem.n_active):
            return 0
        if not _write_modes(ws, number):
            continue
        slips = _start_slips(ws)
        if slips > 0:
            polish(ws)
        if verify(ws, is_lenient=False):
            return number + 1
        if slips > 0:
            _sweep_slips(ws)
            polish(ws)
            if verify(ws, is_lenient=False):
                return number + 1
    return 0
