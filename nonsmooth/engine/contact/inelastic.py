"""The inelastic impact on Coulomb's cone: what one step of Moreau's rule asks for.

Wedged contacts and redundant ones pass impulses round for long, and from a start far away Newton's method finds none.
Contacts that give way a little do neither.  So impulses that are at hand, of the averaging before, lead to those of
contacts that give way next to not at all.  Others are followed from contacts that give way as much as the bodies do to
those that do not at all: every answer is the start of the next.
"""

from __future__ import annotations

from nonsmooth.engine.contact.gauss_seidel import SWEEPS, sweep
from nonsmooth.engine.contact.newton import STEPS, step_by_newton
from nonsmooth.engine.contact.problem import write_friction
from nonsmooth.engine.delassus.delassus import diagonal_block
from nonsmooth.engine.native.kernel import (
    Workspace,
    entry_point,
    kernel,
)
from nonsmooth.engine.numerics.vectors import length

_TRUE = 0.5
"""Contacts give way no more where that makes rates wrong by no more than this part of what counts as none."""
_LAST = 3
"""Newton steps from there to contacts that do not give way: where impulses are unique, one or two do."""
_RATIO = 0.01
"""Contacts give way by this part of what they did before,"""
_STUCK = 0.5
"""or by the root of it where that leads nowhere; above this it does not at all."""


@kernel()
def _keep_rigid(ws: Workspace) -> None:
    for a in range(ws.problem.n_active):
        for r in range(3):
            ws.actives[a].rigid[r] = diagonal_block(ws, a).entries[4 * r]


@kernel("void(ws, f8)")
def _soften(ws: Workspace, part: float) -> None:
    """Let the active contacts give way by a ``part`` of what the bodies do."""
    for a in range(ws.problem.n_active):
        active, own = ws.actives[a], diagonal_block(ws, a)
        # the normal impulse of a contact with a law of its own is given
        rigid = not ws.contacts[active.contact].is_compliant
        along = part * max(active.rigid[1], active.rigid[2])
        own.nn = active.rigid[0] * (1.0 + part if rigid else 1.0)
        own.t11, own.t22 = active.rigid[1] + along, active.rigid[2] + along


@kernel("f8(ws)")
def _fastest(ws: Workspace) -> float:
    """Return what rate the impulses would bring about at their own contacts at most."""
    fastest = 0.0
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        along = max(active.rigid[1], active.rigid[2]) * length(active.friction)
        fastest = max(fastest, active.rigid[0] * active.normal_force, along)
    return fastest


@kernel()
def _keep(ws: Workspace) -> None:
    for i in range(3 * ws.problem.n_active):
        ws.problem.forces_at_start[i] = ws.problem.forces[i]


@kernel("b1(ws, i8)")
def _step_or_stay(ws: Workspace, steps: int) -> bool:
    """Go to the next answer by Newton's method, or stay at the last (0)."""
    _keep(ws)
    if step_by_newton(ws, steps):
        return True
    for i in range(3 * ws.problem.n_active):
        ws.problem.forces[i] = ws.problem.forces_at_start[i]
    return False


@kernel("b1(ws, f8)")
def _next_to_rigid(ws: Workspace, part: float) -> bool:
    """Return 1 if contacts that give way by a ``part`` make no rates wrong by more than counts."""
    return part * _fastest(ws) <= _TRUE * ws.tolerance.velocity


@kernel("i8(ws)")
def _go_on(ws: Workspace) -> int:
    """Go from the impulses at hand to those of contacts that give way next to not at all, or stay (0)."""
    fastest = _fastest(ws)
    if fastest == 0.0:
        return 0
    # half of what may be, as the impulses to be found may be larger than those at hand
    part = min(1.0, 0.5 * _TRUE * ws.tolerance.velocity / fastest)
    _soften(ws, part)
    settled = _step_or_stay(ws, STEPS)
    _soften(ws, 0.0)
    return settled * _next_to_rigid(ws, part)


@kernel("b1(ws)")
def _follow(ws: Workspace) -> bool:
    """Follow impulses from contacts that give way to those that do next to not at all; return 1 if that leads there."""
    found, ratio = 1.0, _RATIO
    _soften(ws, found)
    sweep(ws, SWEEPS)
    if not step_by_newton(ws, STEPS):
        ratio = 1.0
    while ratio <= _STUCK and not _next_to_rigid(ws, found):
        _soften(ws, ratio * found)
        if _step_or_stay(ws, STEPS):
            found *= ratio
        else:
            ratio **= 0.5
    _soften(ws, 0.0)
    return _next_to_rigid(ws, found)


@entry_point("i8(ws, f8)")
def inelastic_impulses(ws: Workspace, moment: float) -> int:
    """Write to ``active_forces`` the impulses of the inelastic impact on Coulomb's cone, of which none pulls.

    The search starts from the impulses at hand.  The rates are those at hand and what the ``free_accelerations`` make
    of them in a ``moment`` [s]; those rates take the place of the accelerations.  Return 1 if the impulses settle.
    """
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        contact = ws.contacts[active.contact]
        write_friction(ws, active)
        active.static_coefficient = active.friction_coefficient = (
            active.friction_coefficient if not active.is_at_rest else active.static_coefficient
        )
        active.is_at_rest = active.is_normal_force_unknown = active.sticks = True
        for r in range(3):
            given = r == 0 and contact.is_compliant
            active.free[r] = moment * active.free[r] + (0.0 if given else contact.rate[r])
    _keep_rigid(ws)
    found = _go_on(ws)
    if found == 0:
        sweep(ws, SWEEPS)
        if step_by_newton(ws, STEPS):
            return 1
        for i in range(3 * ws.problem.n_active):
            ws.problem.forces[i] = 0.0
        found = _follow(ws)
    if found == 1:
        # where they are unique those of contacts that do not give way are next to them
        _step_or_stay(ws, _LAST)
    return found
